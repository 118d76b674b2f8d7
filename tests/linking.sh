#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Checks that a program takes tinygltf from its shared library, not from libdraco, which holds one of
# another version: tests/linking.sh PROGRAM
set -euo pipefail
symbols=$(nm --dynamic "$1")
grep -q ' U .*TinyGLTF' <<< "$symbols"
! grep -q ' [TWV] .*TinyGLTF' <<< "$symbols"
