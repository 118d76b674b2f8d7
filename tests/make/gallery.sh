#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Renders the pictures of docs/guide/gallery.md: all, or those that are named.
#
#   tests/make/gallery.sh [NAME...]
#
# GALLERY_SPP   samples of each pixel (256)
# GALLERY_OUT   where NAME.exr, .png and .jpg go (out/gallery)
# GALLERY_DOCS  where the JPEGs are copied to as well; nowhere unless set
# PETZVAL       the program (build/bin/petzval)
set -euo pipefail
cd "$(dirname "$0")/../.."
out=${GALLERY_OUT:-out/gallery}
spp=${GALLERY_SPP:-256}
petzval=${PETZVAL:-build/bin/petzval}
scenes=assets/scenes
ornaments=assets/scenes/ornaments.glb
dusk=assets/scenes/first_light.glb
glass=assets/scenes/glass.glb
wanted=("$@")
known=()
mkdir -p "$out" ${GALLERY_DOCS:+"$GALLERY_DOCS"}

# is_wanted NAME: whether to render it; every picture asks, and so is known.
is_wanted() {
    known+=("$1")
    [[ ${#wanted[@]} -eq 0 || " ${wanted[*]} " == *" $1 "* ]]
}

# render NAME WIDTHxHEIGHT RENDER_ARGUMENTS... of one frame; more: how often GALLERY_SPP.
more=1
render() {
    local name=$1 size=$2
    shift 2
    echo "$name: petzval render $* --size $size --spp $((spp * more))"
    "$petzval" render "$@" --size "$size" --spp $((spp * more)) --progress none \
        -o "$out/$name.exr" -o "$out/$name.png"
}

# jpeg NAME OIIOTOOL_ARGUMENTS... of what those arguments leave
jpeg() {
    local name=$1
    shift
    oiiotool "$@" --ch R,G,B --compression jpeg:78 -o "$out/$name.jpg"
    [[ -z ${GALLERY_DOCS:-} ]] || cp "$out/$name.jpg" "$GALLERY_DOCS/"
}

picture() {
    is_wanted "$1" || return 0
    render "$@"
    jpeg "$1" "$out/$1.png"
}

# large NAME RENDER_ARGUMENTS... of four times the pixels and half the samples of each.
large() {
    local name=$1
    shift
    spp=$((spp / 2)) picture "$name" 960x640 "$@"
}

# The sun in four lenses, bare and coated.
suns=()
if is_wanted suns; then
    for coating in uncoated broadband; do
        ev=-11.2
        [[ $coating == broadband ]] || ev=-12.7
        for lens in takumar-50mm-f1.2 canon-14mm-f2.8-asph petzval-portrait-100mm-f3.6 noct-nikkor-58mm-f0.95; do
            render "sun_${lens}_$coating" 300x200 $scenes/low_sun.glb --background 900,1100,1500 --lens $lens --fstop 8 \
                --aperture polygon:8 --focus 9m --method coating=$coating --exposure $ev
            suns+=("$out/sun_${lens}_$coating.png")
        done
    done
    jpeg suns "${suns[@]}" --mosaic:pad=4 4x2
fi

# Stars of a sun by the iris, and of a street's lamps by iris and f-number.
stars=()
if is_wanted stars; then
    for iris in circle polygon:5 polygon:6 polygon:8; do
        render "star_$iris" 300x200 $scenes/low_sun.glb --background 900,1100,1500 --lens takumar-50mm-f1.2 --fstop 16 \
            --aperture $iris --focus 9m --diffraction auto --exposure -11.2
        stars+=("$out/star_$iris.png")
    done
    jpeg stars "${stars[@]}" --mosaic:pad=4 2x2
fi
street=()
if is_wanted street; then
    for stop in 1.4 8 22; do
        for iris in circle polygon:5 polygon:6 polygon:7 polygon:8; do
            render "street_${stop}_$iris" 210x140 $scenes/night_street.glb --background 0.01,0.014,0.03 \
                --lens takumar-50mm-f1.2 --fstop $stop --aperture $iris --focus 20m --diffraction auto --exposure -3.2
            street+=("$out/street_${stop}_$iris.png")
        done
    done
    jpeg street "${street[@]}" --mosaic:pad=4 5x3
fi

# What is sharp, and how deep: ornaments at 1 m and 2 m through a thin lens that is 2 cm or 10 cm
# wide. Names say radii of 0.1 and 0.5, as in the units of another scene; these keep their ratio of
# five.
picture focus_1_aperture_0.1 480x320 $ornaments --method lens-radius=0.01 --focus 1m
picture focus_2_aperture_0.1 480x320 $ornaments --method lens-radius=0.01 --focus 2m
more=2 # discs whose noise shows
large focus_1_aperture_0.5 $ornaments --method lens-radius=0.05 --focus 1m
large focus_2_aperture_0.5 $ornaments --method lens-radius=0.05 --focus 2m

# The four shapes, in the round iris's area: every lamp becomes one. The narrow view has large ones.
more=1
for iris in triangle rhomboid star:5 frame; do
    large "iris_${iris%:*}" $ornaments --lens thin --fov 26 --method lens-radius=0.045 \
        --focus 1m --aperture "$iris"
done

# An ideal lens on the left, one of N-BK7 on the right; shared wavelengths leave its colours out.
# First what is sharp; then lamps behind and before the sharp plane, from between ornaments and
# lamps, through a lens so wide that their discs are larger than they are.
if is_wanted spherical_aberration; then
    among_lamps=(--look-at 0,0,-2.2,0,0,-4 --fov 22 --focal-length 800 --method lens-radius=0.15)
    panels=()
    for row in sharp behind before; do
        case $row in
            sharp) view=(--look-at -0.1,-0.04,0,-0.1,-0.04,-1 --fov 24 --focal-length 60 --fstop 3.5
                         --focus 1m) ;;
            behind) view=("${among_lamps[@]}" --focus 2m --exposure -0.5) ;;
            before) view=("${among_lamps[@]}" --focus 100m --exposure -0.5) ;;
        esac
        for lens in thin singlet:schott:N-BK7,0; do
            panels+=("$out/spherical_${row}_${lens%%:*}.png")
            render "spherical_${row}_${lens%%:*}" 360x240 $ornaments --lens $lens --method dispersion=shared \
                "${view[@]}"
        done
    done
    jpeg spherical_aberration "${panels[@]}" --mosaic:pad=4 2x3
fi
# One lens of dense flint, bent for the least spherical aberration, so that colour is what is seen.
large chromatic_aberration $ornaments --lens singlet:schott:N-SF11,0.7 --fov 16 \
    --look-at 0,-0.1,0,0,-0.1,-1 --focal-length 200 --fstop 4 --focus 2m

# The built-in scene through six cameras. Those of longer focal length stand farther back, the
# Petzval looks a little higher, at the lamps, and the fisheye stands nearer.
picture pinhole 480x320 $dusk
large thin $dusk --fstop 2 --focus 1m
large double_gauss $dusk --lens double-gauss-100mm-f2 \
    --look-at 0,1.133,0.994,0,1.02,0 --focus 2m
large petzval $dusk --lens kodak-petzval-100mm-f2 \
    --look-at 0,1.303,2.484,0,1.09,0 --focus 3.5m
large fisheye $dusk --lens minolta-fisheye-16mm-f2.8 \
    --look-at 0,1.15,-0.45,0,1,-1.5 --focus 0.6m
# The film holds everything half as wide as it is; the JPEG is stretched.
if is_wanted anamorphic; then
    render anamorphic 480x480 $dusk --lens schneider-anamorphic-31mm \
        --look-at 0,1.133,0.994,0,1.02,0 --focus 2m
    jpeg anamorphic "$out/anamorphic.png" --resize 960x480
fi

# What a real lens does to lamps and edges. The fringes are a piece of a large frame.
more=2
large cats_eyes $ornaments --lens takumar-50mm-f1.2 --focus 0.6m \
    --look-at 0,0,-0.4,0,0,-1
more=1
large star $ornaments --lens double-gauss-100mm-f2 --focus 1m --aperture star:5 \
    --method aperture-scale=inscribed --look-at -0.1,-0.06,0,-0.1,-0.06,-1
picture fringes 1920x1280 $ornaments --lens petzval-portrait-100mm-f3.6 --crop 754,520,480,320 \
    --look-at 0,-0.17,3,0,-0.17,-1 --focus 4.6m

# A room lit through its window alone, what stands on its table, and panes that blur.
more=2
picture glass_room 480x320 $glass --camera room
picture glass_ice 480x320 $glass --camera ice --exposure -0.5
picture glass_frosted 480x320 $glass --camera frosted

# What moves while the shutter is open.
more=1
picture wheels 480x320 $scenes/wheels.glb --at 0.1s --shutter 180deg
picture wheels_follow 480x320 $scenes/wheels.glb --camera follow --at 0.3s --shutter 180deg
picture face 480x320 $scenes/face.glb --at 0.979s --shutter 180deg
more=4
picture flying_lamp 480x320 $scenes/flying_lamp.glb --camera moving --at 0.55s --shutter 1/24
# Two seconds of a walk, frame by frame. The model is another's, and is not shipped.
fox=../shared/scenes/open/fox/Fox.glb
if is_wanted fox; then
    if [[ -e $fox ]]; then
        echo "fox: petzval render $fox --animation Walk --frames 1:48 --loop --shutter 180deg"
        "$petzval" render $fox --animation Walk --frames 1:48 --loop --shutter 180deg --size 120x80 \
            --spp "$spp" --look-at 200,80,60,0,40,-10 --progress none --quiet -o "$out/fox_##.png"
        jpeg fox "$out"/fox_??.png --mosaic 8x6
    else
        echo "fox: skipped, as there is no $fox" >&2
    fi
fi

for name in "${wanted[@]}"; do
    [[ " ${known[*]} " == *" $name "* ]] || {
        echo "gallery: there is no picture $name; there are: ${known[*]}" >&2
        exit 2
    }
done
