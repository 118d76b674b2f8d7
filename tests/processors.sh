#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Renders the same small pictures on processors that are made to look different, and fails where a
# byte of a picture differs: without AVX-512 in the C library, with other numbers of threads, and,
# where qemu-user is installed, on processors that it emulates. Those have reciprocals of their own,
# as processors of other makers have.
set -euo pipefail

program=$1
cd "$(dirname "$0")/.."
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT
no_avx512=glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX512BW,-AVX512DQ,-AVX512CD

# Glass, wavelengths, a lens, lamps under a sky, whose shares a pilot learns, and motion; a sky
# through alpha-tested leaves has no scene that ships.
renders=("gem.glb --size 32x18 --spp 2"
    "glass.glb --camera ice --size 24x16 --spp 4"
    "ornaments.glb --size 24x16 --spp 2 --lens takumar-50mm-f1.2 --focus 1m"
    "first_light.glb --size 24x16 --spp 1 --env studio --lens pinhole"
    "wheels.glb --size 24x16 --spp 4 --at 0.1 --shutter 180deg"
    "face.glb --size 16x16 --spp 2 --at 0.98 --shutter 180deg")

compare() {
    local name=$1
    shift
    for i in "${!renders[@]}"; do
        # shellcheck disable=SC2086
        "$@" render assets/scenes/${renders[i]} --quiet -o "$out/$name-$i.exr" -o "$out/$name-$i.png"
        for ending in exr png; do
            cmp "$out/here-$i.$ending" "$out/$name-$i.$ending" || failed=1
        done
    done
    echo "$name: compared"
}

failed=0
compare here "$program"
GLIBC_TUNABLES=$no_avx512 compare no-avx512 "$program"
compare threads bash -c '"$0" "$@" --threads 5' "$program"
if ldd "$program" | grep -q libasan; then
    echo "qemu-user does not run the address sanitizer: no other processors"
elif command -v qemu-x86_64 > /dev/null; then
    for cpu in Haswell EPYC; do compare "$cpu" qemu-x86_64 -cpu "$cpu" "$program" 2> /dev/null; done
    # Older ones are told what they lack, and by no signal.
    for cpu in Nehalem SandyBridge Haswell,-bmi2; do
        qemu-x86_64 -cpu "$cpu" "$program" --version > "$out/said" 2>&1 && failed=1
        grep -q '^petzval: this processor lacks .*BMI2.*; Petzval needs x86-64-v3' "$out/said" || failed=1
        cat "$out/said"
    done
else
    echo "qemu-user is not installed: no other processors"
fi
exit $failed
