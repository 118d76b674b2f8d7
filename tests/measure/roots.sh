#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Tries README's two commands in a bare root of a Debian release, as a newcomer would: a fresh system, a
# fresh clone, nothing installed by hand. For root, with Debian's debootstrap.
#
#   tests/measure/roots.sh 12 [FOLDER]
#
# The system is taken from the same mirror as this machine's and lies in FOLDER (a temporary one, removed
# at the end, if none is named). What is committed is tried.
set -euo pipefail
case ${1:-} in
12) suite=bookworm ;;
*)
    echo "usage: roots.sh 12 [FOLDER]" >&2
    exit 2
    ;;
esac
source=$(cd "$(dirname "$0")/../.." && pwd)
root=${2:-$(mktemp -d)}
mirror=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/* 2> /dev/null |
    grep -oE 'https?://[^ ]+' | grep -v security | head -1)

leave() {
    umount "$root/proc" "$root/dev" 2> /dev/null || true
    if [[ $# -gt 0 ]]; then rm -rf --one-file-system "$root"; fi
}
if [[ $# -lt 2 ]]; then trap 'leave remove' EXIT; else trap leave EXIT; fi

debootstrap --variant=minbase "$suite" "$root" "$mirror"
cp -r /etc/apt/apt.conf.d "$root/etc/apt/"
cp -r /etc/apt/sources.list* "$root/etc/apt/"
cp /etc/resolv.conf "$root/etc/" 2> /dev/null || true
mount -t proc proc "$root/proc"
mount --bind /dev "$root/dev"
git clone --quiet "$source" "$root/petzval"
chroot "$root" bash -ec '
    apt-get update
    DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends git make g++
    cd /petzval
    git config --global --add safe.directory /petzval
    make render
    ls -l out/first_light.png
    make test'
