#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Writes checksums of 23 small renders and of what other commands print, to compare two builds:
#
#   same_bytes.sh BEFORE/build/bin/petzval before
#   same_bytes.sh AFTER/build/bin/petzval after && diff -r before after
#
# OUT/pixels: a hash of the pixels of each picture and of all its layers. OUT/metadata: what else an
# EXR says, but of its build. OUT/text: what commands print, seconds left out. as_called() has the names
# that options had in builds without --method. Scenes outside the project are left out where they are absent.
set -euo pipefail

program=$(realpath "$1") out=$2
cd "$(dirname "$0")/../.."
mkdir -p "$out/metadata" "$out/text"
out=$(realpath "$out")
: > "$out/pixels"
light=assets/scenes/first_light.glb gem=assets/scenes/gem.glb ornaments=assets/scenes/ornaments.glb
open=../shared/scenes/open takumar=takumar-50mm-f1.2

has_method=$("$program" render --help all | grep -c -- --method || true)
# Sets `words` to options as the program calls them.
as_called() {
    words=()
    while [ $# -gt 0 ]; do
        if [ "$has_method" -eq 0 ] && [ "$1" = --method ]; then
            words+=("--${2%%=*}" "${2#*=}")
            shift 2
            continue
        fi
        words+=("$1")
        shift
    done
}
render() {
    local name=$1
    shift
    as_called "$@"
    "$program" render "${words[@]}" --quiet -o "$out/$name.exr"
    oiiotool --hash -a --info "$out/$name.exr" | grep SHA | sed "s/^ */$name /" >> "$out/pixels"
    oiiotool --info -v -a "$out/$name.exr" | grep -v '^Reading\|SHA\|Software\|petzval:lightHash\|petzval:fileHash' | sed "s|^$out/||" > "$out/metadata/$name"
    rm "$out/$name.exr"
}
says() {
    local name=$1
    shift
    as_called "$@"
    "$program" "${words[@]}" > "$out/text/$name" 2>&1 || echo "exit $?" >> "$out/text/$name"
    sed -i -E "s#$out#OUT#g; s/[0-9.e+-]+ (s|min|h) of CPU/N s of CPU/; s/(\"predicted_cpu_s\":) .*/\1 N,/" \
        "$out/text/$name"
}

small=(--size 96x64 --spp 8)
render rgb_pinhole $light "${small[@]}" --spectral rgb
render rgb_thin $light "${small[@]}" --spectral rgb --fstop 2 --focus 1.5m --aperture star:5
render thin_sobol $light "${small[@]}" --fstop 2 --focus auto --method sampler=sobol --method filter=gauss
render hero_gem $gem "${small[@]}" --spectral wavelengths
render auto_gem $gem "${small[@]}"
render bins_gem $gem "${small[@]}" --bins 380:730:10
render singlet $light "${small[@]}" --lens singlet:N-BK7 --fstop 2 --focus 1m --spectral wavelengths
render singlet_hero $light "${small[@]}" --lens singlet:N-SF11 --fstop 2 --focus 1m --spectral wavelengths --method dispersion=hero
for chroma in shared split hero; do
    render takumar_$chroma $light "${small[@]}" --lens $takumar --focus 1m --spectral wavelengths --method dispersion=$chroma
done
render takumar_auto $light "${small[@]}" --lens $takumar --focus 1m
render double_gauss_double $light "${small[@]}" --lens double-gauss-100mm-f2 --focus 2m --method lens-precision=double --method coating=mgf2
render fisheye $light "${small[@]}" --lens minolta-fisheye-16mm-f2.8 --focus 1m --fstop 4 --method focus-by=traced
render anamorphic $light --spp 8 --lens schneider-anamorphic-31mm --focus 200,30 --size 300x100 --crop 100,20,64,48
render petzval_photographic $ornaments "${small[@]}" --lens petzval-portrait-100mm-f3.6 --method fit=fov --fov 12 \
    --exposure-mode photographic --iso 400 --shutter 1/50
render crop_aovs $light --size 200x120 --crop 60,30,80,60 --spp 8 --aov albedo,normal,depth,position,uv,emission
render transparent $ornaments "${small[@]}" --transparent --fstop 4 --focus 1m
render white_balance $ornaments "${small[@]}" --spectral wavelengths --illuminant a --method white-balance=illuminant
render background $ornaments "${small[@]}" --background 0.2,0.3,0.9 --method light-choice=power --method traversal=fast
if [[ -d $open ]]; then
    render many_lights "$open"/many-lights/*.gl* "${small[@]}"
    render sky "$open"/damaged-helmet/*.gl* "${small[@]}" --env "$(ls "$open"/env/*.hdr | head -1)"
    render cutouts "$open"/house-foliage/*.gl* "${small[@]}" --env "$(ls "$open"/env/*.hdr | tail -1)" --seed 3
fi

for scene in $light $gem $ornaments; do says info_$(basename $scene) info $scene; done
says lens_list lens list
plot=(--csv "$out/text/plot.csv" -o "$out/text/plot.svg")
for lens in $takumar canon-14mm-f2.8-asph nikkor-400mm-f2.8-fl; do
    says show_$lens lens show $lens
    says check_$lens lens check $lens
    for analysis in spot fan mtf distortion vignetting; do
        says ${analysis}_$lens lens $analysis $lens --focus 10 --film-shift 0.1 "${plot[@]}"
        mv "$out/text/plot.csv" "$out/text/${analysis}_$lens.csv"
    done
done
says mtf_best lens mtf $takumar --focus infinity --focus-by traced --film-shift best "${plot[@]}"
mv "$out/text/plot.csv" "$out/text/mtf_best.csv"
rm "$out/text/plot.svg"
printf 'x,y,z,dx,dy,dz,nm\n0,1,-10,0,0.1,0.995,550\n3,-2,-10,0.01,0.05,0.998,450\n' > "$out/text/rays.csv"
says trace lens trace $takumar --rays "$out/text/rays.csv" -o "$out/text/traced.csv"
says draw lens draw $takumar -o "$out/text/takumar.svg"
says plan_takumar plan $light --lens $takumar --focus 1m --size 160x90 --tolerance 5% --json
says plan_gem plan $gem --size 160x90 --tolerance 5% --json
says plan_text plan $light --fstop 2 --focus 1m --size 160x90 --tolerance 5%
echo "$(wc -l < "$out/pixels") lines of pixels, $(ls "$out/text" | wc -l) texts in $out"
