#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Compares Petzval with Cycles on scenes that Blender exports, then uses the add-on from its zip:
#
#   run.sh PETZVAL
#
# Skipped without Blender.
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "$0")"
if ! command -v blender > /dev/null; then
    echo "skipped: Blender is not installed; the package blender has it"
    exit 77
fi
HOME=$(mktemp -d) # where Blender installs add-ons
export HOME
trap 'rm -rf "$HOME"' EXIT
../../../apps/blender/pack.sh "$HOME/petzval_blender.zip"
in_blender() {
    # Without a line for each tile that Cycles renders, and what Debian's build says of itself.
    blender -b --factory-startup -noaudio --python-exit-code 1 -P "$@" | grep -vE '^(Fra:|Saved| Time:|$)|INFO|Draco'
}
in_blender scenes.py -- "$program"
in_blender addon.py -- "$program" "$HOME/petzval_blender.zip"
