#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Renders the ten crops of docs/design/denoise.md, each with 16, 64 and 256 samples, without and with
# denoising. Prints the rows of its table: what each render says of its errors.
#
#   tests/make/denoise_crops.sh [OUT [PETZVAL]]
#
# OUT      where the pictures go (out/denoise); the page has denoise_crops_1.jpg and _2.jpg of it
# PETZVAL  the program (build/bin/petzval)
set -euo pipefail
cd "$(dirname "$0")/../.."
out=${1:-out/denoise}
petzval=${2:-build/bin/petzval}
scenes=assets/scenes
mkdir -p "$out"
rows=()

# crop NAME X,Y RENDER_ARGUMENTS... of 160 x 120 pixels of a frame of 480 x 320
crop() {
    local name=$1 at=$2 samples said row=()
    shift 2
    printf '| %s |' "$name"
    for way in noisy denoised; do
        for samples in 16 64 256; do
            local file="$out/${name}_${way}_$samples"
            row+=("$file.png")
            said=$("$petzval" render "$@" --size 480x320 --crop "$at,160,120" --spp "$samples" --progress none \
                $([[ $way == noisy ]] || echo --denoise) -o "$file.png" 2>&1) || { echo "$said" >&2; return 1; }
            [[ $way == noisy ]] ||
                sed -nE 's/.*denoised: error (at most )?([0-9.]+ %).* and ([0-9.]+ %).*/ \3, \1\2 |/p' <<< "$said" | tr -d '\n'
        done
    done
    echo
    oiiotool "${row[@]}" --mosaic:pad=2 6x1 -o "$out/$name.png"
    rows+=("$out/$name.png")
}

crop bokeh 120,100 $scenes/ornaments.glb --lens takumar-50mm-f1.2 --focus 0.6m --look-at 0,0,-0.4,0,0,-1
crop fringes 70,170 $scenes/ornaments.glb --lens singlet:schott:N-SF11,0.7 --fov 16 --look-at 0,-0.1,0,0,-0.1,-1 \
    --focal-length 200 --fstop 4 --focus 2m
crop foreground 0,0 $scenes/first_light.glb --lens kodak-petzval-100mm-f2 --look-at 0,1.303,2.484,0,1.09,0 --focus 3.5m
crop texture 150,140 $scenes/first_light.glb
crop wheels 80,70 $scenes/wheels.glb --at 0.1s --shutter 180deg
crop moving_lamp 310,60 $scenes/flying_lamp.glb --camera moving --at 0.55s --shutter 1/24
crop face 150,20 $scenes/face.glb --at 0.979s --shutter 180deg
crop glass 130,110 $scenes/glass.glb --camera ice --exposure -0.5
crop frosted 250,70 $scenes/glass.glb --camera room
crop gem 220,100 $scenes/gem.glb

oiiotool "${rows[@]:0:5}" --mosaic:pad=2 1x5 --ch R,G,B --compression jpeg:82 -o "$out/denoise_crops_1.jpg"
oiiotool "${rows[@]:5}" --mosaic:pad=2 1x5 --ch R,G,B --compression jpeg:82 -o "$out/denoise_crops_2.jpg"
