#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Tries README's commands in a bare root of a Debian release, as a newcomer would: a fresh system, a
# fresh clone, nothing installed by hand. Then what it packs: the packages in a second bare root, where a
# program of others is built too, and, of Debian 12, the folder with its libraries in a third one. For
# root, with Debian's debootstrap.
#
#   tests/measure/roots.sh 12|13 [FOLDER]
#
# The systems are taken from the same mirror as this machine's and lie in FOLDER (a temporary one, removed
# at the end, if none is named). What is committed is tried.
set -euo pipefail
case ${1:-} in
12) suite=bookworm ;;
13) suite=trixie ;;
*)
    echo "usage: roots.sh 12|13 [FOLDER]" >&2
    exit 2
    ;;
esac
source=$(cd "$(dirname "$0")/../.." && pwd)
folder=${2:-$(mktemp -d)}
mkdir -p "$folder"
folder=$(realpath "$folder")
mirror=$("$source/.ci/debian_mirror")

leave() {
    umount "$folder"/*/proc "$folder"/*/dev 2> /dev/null || true
    if [[ $# -gt 0 ]]; then rm -rf --one-file-system "$folder"; fi
}
if [[ $# -lt 2 ]]; then trap 'leave remove' EXIT; else trap leave EXIT; fi

debootstrap --variant=minbase "$suite" "$folder/bare" "$mirror"
cp -r /etc/apt/apt.conf.d "$folder/bare/etc/apt/"
echo "deb $mirror $suite main" > "$folder/bare/etc/apt/sources.list"
cp /etc/resolv.conf "$folder/bare/etc/" 2> /dev/null || true
chroot "$folder/bare" apt-get update
cp -a "$folder/bare" "$folder/build"
for root in bare build; do
    mount -t proc proc "$folder/$root/proc"
    mount --bind /dev "$folder/$root/dev"
done
export DEBIAN_FRONTEND=noninteractive

git clone --quiet "$source" "$folder/build/petzval"
chroot "$folder/build" bash -ec '
    apt-get install --yes --no-install-recommends git make g++
    cd /petzval
    git config --global --add safe.directory /petzval
    make render
    ls -l out/first_light.png
    make test
    make deb
    apt-get install --yes --no-install-recommends lintian || true  # its hooks want a running system
    lintian --fail-on error build/packages/*.deb'

# Another program's author: the packages, a compiler and CMake.
cp "$folder"/build/petzval/build/packages/*.deb "$folder/bare/tmp/"
cp -r "$source/tests/examples/outside" "$folder/bare/tmp/"
chroot "$folder/bare" bash -ec '
    cd /tmp
    apt-get install --yes --no-install-recommends ./petzval_*.deb
    petzval render /usr/share/petzval/scenes/first_light.glb --fstop 2 --focus 1m --size 192x108 -o picture.png
    ls -l picture.png
    apt-get install --yes --no-install-recommends ./libpetzval-dev_*.deb cmake make g++
    cmake -S outside -B outside/build
    cmake --build outside/build
    outside/build/spot double-gauss-100mm-f2 10
    outside/build/photograph /usr/share/petzval/scenes/first_light.glb photograph.png
    ls -l photograph.png
    apt-get install --yes --no-install-recommends ./python3-petzval_*.deb
    python3 -c "import petzval as p
print(p.render(p.Scene(\"/usr/share/petzval/scenes/first_light.glb\"), samples=4, size=(96, 54)))"'

if [[ $suite == bookworm ]]; then
    chroot "$folder/build" make -C /petzval tarball
    debootstrap --variant=minbase trixie "$folder/newer" "$mirror"
    mount -t proc proc "$folder/newer/proc"
    tar xf "$folder"/build/petzval/build-tarball/petzval-*.tar.xz -C "$folder/newer/tmp"
    chroot "$folder/newer" bash -ec '
        cd /tmp/petzval-*/
        time bin/petzval render share/petzval/scenes/first_light.glb --fstop 2 --focus 1m --size 192x108 \
            -o /tmp/picture.png
        ls -l /tmp/picture.png'
fi
