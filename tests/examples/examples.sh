#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Runs the examples, and compares their pictures with those of the command line:
#
#   examples.sh FOLDER_OF_PROGRAMS SCENE.glb
set -eu
bin=$1 scene=$2
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
petzval() { "$bin/petzval" render "$scene" --quiet "$@"; }
same() {
    if ! cmp "$1" "$2"; then
        echo "$1 has not the bytes of the command line's picture"
        exit 1
    fi
}

"$bin/example_in_memory" "$scene"

"$bin/example_cancel" "$scene" "$out/cancelled.exr" | tee "$out/log"
petzval --size 320x180 --spp 64 -o "$out/whole.exr"
same "$out/cancelled.exr" "$out/whole.exr"

"$bin/example_change" "$scene" "$out" | tee "$out/log"
# One scene for all, and samples that are kept for another exposure alone.
[ "$(grep -o 'scene 0x[0-9a-f]*' "$out/log" | sort -u | wc -l)" = 1 ]
grep -q 'first.*before 0$' "$out/log"
grep -q "brighter.*before $((96 * 64 * 8))\$" "$out/log"
grep -q 'nearer.*before 0$' "$out/log"
for picture in first: brighter:--exposure=1 "nearer:--exposure=1 --fov=30"; do
    name=${picture%%:*}
    # shellcheck disable=SC2086
    petzval --size 96x64 --spp 8 ${picture#*:} -o "$out/$name-typed.png"
    same "$out/$name.png" "$out/$name-typed.png"
done
