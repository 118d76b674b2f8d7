#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Packs the add-on for Blender: pack.sh FILE.zip
set -euo pipefail
zip=$(realpath -m "$1")
cd "$(dirname "$0")"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/petzval_blender" "$(dirname "$zip")"
install -m 644 ./*.py blender_manifest.toml "$folder/petzval_blender/"
rm -f "$zip"
cd "$folder"
python3 -m zipfile -c "$zip" petzval_blender
