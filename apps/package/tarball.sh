#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Makes a folder that runs on any Linux with this one's glibc or newer, without packages, and packs it:
#
#   apps/package/tarball.sh        build-tarball/petzval-VERSION-linux-x86_64.tar.xz
#
# OpenImageIO is built from the source that Debian 13 has, with the formats alone that Petzval reads and
# writes: as Debian builds it, it needs 220 packages, some of them under the GPL.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$PWD/build-tarball
if [[ $build == *[[:space:]]* ]]; then
    echo "$build: compilers take a name with blanks for two; copy the sources to a folder without" >&2
    exit 1
fi
mkdir -p "$build"
.ci/install_packages "$@" libopenexr-dev libpng-dev libjpeg-dev libtiff-dev libwebp-dev zlib1g-dev \
    robin-map-dev libboost-dev libboost-filesystem-dev libboost-thread-dev dpkg-dev xz-utils
export SOURCE_DATE_EPOCH
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)

oiio=$build/oiio
if [[ ! -f $oiio/lib/libOpenImageIO.so ]]; then
    mkdir -p "$build/apt/lists/partial"
    signed='[signed-by=/usr/share/keyrings/debian-archive-keyring.gpg]'
    echo "deb-src $signed $(.ci/debian_mirror) trixie main" > "$build/apt/sources.list"
    (
        cd "$build/apt"
        from=(-o "Dir::Etc::SourceList=$PWD/sources.list" -o Dir::Etc::SourceParts=/dev/null
            -o "Dir::State::Lists=$PWD/lists" -o APT::Sandbox::User=root)
        apt-get "${from[@]}" update
        apt-get "${from[@]}" source --tar-only --download-only openimageio
        mkdir -p source
        tar xf openimageio_*.orig.tar.xz -C source --strip-components=1
    )
    off=()
    for format in bmp cineon dds dpx fits ico iff null pnm psd rla sgi softimage targa term tiff zfile; do
        off+=("-DENABLE_${format^^}=OFF")
    done
    for package in PYTHON QT OPENCOLORIO FREETYPE OPENCV TBB GIF LIBHEIF LIBRAW OPENJPEG OPENVDB PTEX DCMTK \
        FFMPEG NUKE R3DSDK; do
        off+=("-DUSE_$package=OFF")
    done
    cmake -S "$build/apt/source" -B "$build/oiio-build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_CXX_FLAGS="-ffile-prefix-map=$build=." -DCMAKE_CXX_STANDARD=17 \
        -DCMAKE_INSTALL_PREFIX="$oiio" -DCMAKE_INSTALL_LIBDIR=lib -DEMBEDPLUGINS=ON \
        -DOIIO_BUILD_TOOLS=OFF -DOIIO_BUILD_TESTS=OFF -DINSTALL_DOCS=OFF -DINSTALL_FONTS=OFF \
        -DSTOP_ON_WARNING=OFF -DCMAKE_SKIP_RPATH=ON -DCMAKE_BUILD_WITH_INSTALL_RPATH=ON \
        -DCMAKE_SHARED_LINKER_FLAGS=-Wl,--build-id=none "${off[@]}"
    cmake --build "$build/oiio-build"
    cmake --install "$build/oiio-build" --strip
fi

cmake --preset tarball
cmake --build --preset tarball
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/program/CMakeCache.txt")
name=petzval-$version-linux-x86_64
folder=$build/$name
rm -rf "$folder"
cmake --install "$build/program" --prefix "$folder" --strip --component program
install -m 644 LICENSE "$folder/"

# Libraries that it needs, but for those of the C library; and what each of them is licensed under.
mkdir -p "$folder/lib" "$folder/share/doc/petzval/licenses"
needed() { ldd "$1" | sed -nE 's/.* => (\/.*) \(0x[0-9a-f]+\)$/\1/p'; }
{
    needed "$folder/bin/petzval"
    LD_LIBRARY_PATH=$oiio/lib needed "$folder/lib/petzval/petzval_io_codec.so"
} | sort -u | while read -r library; do
    case ${library##*/} in libc.so.* | libm.so.* | libdl.so.* | libpthread.so.* | librt.so.*) continue ;; esac
    install -m 644 "$library" "$folder/lib/"
    if [[ $library == "$oiio"/* ]]; then
        install -m 644 "$build/apt/source/LICENSE.md" "$folder/share/doc/petzval/licenses/openimageio"
        continue
    fi
    # Debian 12 knows some of them by their place before /lib became a link.
    real=$(realpath "$library")
    package=$({ dpkg-query --search "$real" "${real#/usr}" 2> /dev/null || true; } | sed -n '1s/:.*//p')
    install -m 644 "/usr/share/doc/$package/copyright" "$folder/share/doc/petzval/licenses/$package"
done
for package in libdraco-dev libmeshoptimizer-dev libfmt-dev libcli11-dev nlohmann-json3-dev libtinygltf-dev \
    libkissfft-dev; do
    install -m 644 "/usr/share/doc/$package/copyright" "$folder/share/doc/petzval/licenses/$package"
done

promised="glibc 2.36" # of Debian 12
if [[ $(getconf GNU_LIBC_VERSION) != "$promised" ]]; then
    echo "made here, it needs $(getconf GNU_LIBC_VERSION); made on Debian 12, $promised is enough" >&2
fi
tar --create --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$SOURCE_DATE_EPOCH" \
    --mode=u+rwX,go+rX,go-w --directory "$build" "$name" | xz -6 --threads=1 > "$folder.tar.xz"
ls -l "$folder.tar.xz"
