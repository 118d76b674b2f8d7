#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Renders the pictures of docs/gallery.md: all, or those that are named.
#
#   assets/gallery.sh [NAME...]
#
# GALLERY_SPP   samples of each pixel (256)
# GALLERY_OUT   where NAME.exr, .png and .jpg go (out/gallery)
# GALLERY_DOCS  where the JPEGs are copied to as well; nowhere unless set
# PETZVAL       the program (build/bin/petzval)
set -euo pipefail
cd "$(dirname "$0")/.."
out=${GALLERY_OUT:-out/gallery}
spp=${GALLERY_SPP:-256}
petzval=${PETZVAL:-build/bin/petzval}
ornaments=assets/scenes/ornaments.glb
dusk=assets/scenes/first_light.glb
wanted=("$@")
known=()
mkdir -p "$out" ${GALLERY_DOCS:+"$GALLERY_DOCS"}

# picture NAME WIDTHxHEIGHT RENDER_ARGUMENTS...: shape is what the JPEG is resized to.
shape=
picture() {
    local name=$1 size=$2
    shift 2
    known+=("$name")
    [[ ${#wanted[@]} -eq 0 || " ${wanted[*]} " == *" $name "* ]] || return 0
    echo "$name: petzval render $* --size $size --spp $spp"
    "$petzval" render "$@" --size "$size" --spp "$spp" --progress none \
        -o "$out/$name.exr" -o "$out/$name.png"
    oiiotool "$out/$name.png" --ch R,G,B ${shape:+--resize "$shape"} --compression jpeg:78 \
        -o "$out/$name.jpg"
    [[ -z ${GALLERY_DOCS:-} ]] || cp "$out/$name.jpg" "$GALLERY_DOCS/"
}

# What is sharp, and how deep: ornaments at 1 m and 2 m through a thin lens that is 2 cm or 10 cm
# wide. The report's apertures, 0.1 and 0.5, are radii in the units of its scene; these keep their
# ratio of five.
picture focus_1_aperture_0.1 480x320 $ornaments --lens-radius 0.01 --focus 1m
picture focus_2_aperture_0.1 480x320 $ornaments --lens-radius 0.01 --focus 2m
picture focus_1_aperture_0.5 480x320 $ornaments --lens-radius 0.05 --focus 1m
picture focus_2_aperture_0.5 480x320 $ornaments --lens-radius 0.05 --focus 2m

# The four shapes, in the round iris's area: every lamp becomes one.
for iris in triangle rhomboid star:5 frame; do
    picture "iris_${iris%:*}" 480x320 $ornaments --lens thin --lens-radius 0.03 --focus 1m \
        --aperture "$iris"
done

# One lens of N-BK7, curved alike on both sides (bending 0): a haze about all that is sharp, and
# discs with a bright rim or a bright middle. Shared wavelengths leave its colours out.
picture spherical_aberration 480x320 $ornaments --lens singlet:schott:N-BK7,0 --focal-length 33 \
    --fstop 2 --focus 1m --chroma shared
# One lens of dense flint, small enough that colour is what is left to see.
picture chromatic_aberration 480x320 $ornaments --lens singlet:schott:N-SF11,0.7 --focal-length 33 \
    --fstop 5.6 --focus 1m

# The built-in scene through six cameras. Those of longer focal length stand farther back, on the
# axis of the file's camera, so that all but the fisheye see the same table.
back_1m=0,1.133,0.994,0,1.02,0
back_2_5m=0,1.303,2.484,0,1.02,0
picture pinhole 480x320 $dusk
picture thin 480x320 $dusk --fstop 2 --focus 1m
picture double_gauss 480x320 $dusk --lens double-gauss-100mm-f2 --look-at $back_1m --focus 2m
picture petzval 480x320 $dusk --lens kodak-petzval-100mm-f2 --look-at $back_2_5m --focus 3.5m
picture fisheye 480x320 $dusk --lens minolta-fisheye-16mm-f2.8 --look-at 0,1.15,-0.45,0,1,-1.5 \
    --focus 0.6m
# The film holds everything half as wide as it is; the JPEG is stretched.
shape=640x320
picture anamorphic 320x320 $dusk --lens schneider-anamorphic-31mm --look-at $back_1m --focus 2m
shape=

# What a real lens does to lamps and edges. The fringes are a piece of a large frame, near its corner.
picture cats_eyes 480x320 $ornaments --lens takumar-50mm-f1.2 --focus 0.6m \
    --look-at -0.12,-0.06,-0.4,-0.12,-0.06,-1
picture star 480x320 $ornaments --lens double-gauss-100mm-f2 --focus 1m --aperture star:5 \
    --aperture-scale inscribed --look-at -0.1,-0.06,0,-0.1,-0.06,-1
picture fringes 1920x1280 $ornaments --lens petzval-portrait-100mm-f3.6 --crop 0,905,420,280 \
    --look-at -0.12,0,1,-0.12,0,-1 --focus 2m

for name in "${wanted[@]}"; do
    [[ " ${known[*]} " == *" $name "* ]] || {
        echo "gallery: there is no picture $name; there are: ${known[*]}" >&2
        exit 2
    }
done
