#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Installs a build into a folder whose name has a blank and an umlaut, and uses it from there: the
# program, its manual, its completions, and what other programs link:
#
#   installed.sh BUILD_FOLDER
set -euo pipefail
build=$(realpath "$1")
source=$(cd "$(dirname "$0")/../../.." && pwd)
out=$(mktemp -d)
trap 'chmod -R u+w "$out"; rm -r "$out"' EXIT
there="$out/mein Gerät"
cmake --install "$build" --prefix "$there" > "$out/log"
fail() {
    echo "$*"
    exit 1
}

chmod -R a-w "$there" # as a package manager's files are
cd /
scene="$there/share/petzval/scenes/first_light.glb"
"$there/bin/petzval" render "$scene" --size 96x64 --spp 16 --lens double-gauss-100mm-f2 --quiet \
    -o "$out/program.exr"
"$build/bin/petzval" render "$scene" --size 96x64 --spp 16 --lens double-gauss-100mm-f2 --quiet \
    -o "$out/build.exr"
cmp "$out/program.exr" "$out/build.exr"

# The manual has every option of --help, and nothing that a formatter does not understand.
page="$out/render.1"
zcat "$there/share/man/man1/petzval-render.1.gz" > "$page"
"$there/bin/petzval" render --help all | grep -oE '^ +(-o,)?--[a-z-]+' | tr -d ' ' | sed 's/^-o,//' |
    while read -r option; do
        grep -qF -- "${option//-/\\-}" "$page" || fail "$page has no $option"
    done
if command -v groff > /dev/null; then
    for page in "$there"/share/man/man1/*.1.gz; do
        said=$(zcat "$page" | groff -man -Tutf8 -ww -z 2>&1)
        [[ -z $said ]] || fail "$page: $said"
    done
fi

# Completions: what is completed after the words that are typed.
complete_in_bash() {
    # shellcheck disable=SC2016
    bash -c 'source "$0"; COMP_WORDS=(petzval "$@"); COMP_CWORD=$#; _petzval; echo "${COMPREPLY[*]}"' \
        "$there/share/bash-completion/completions/petzval" "$@"
}
expect() { [[ $1 == "$2" ]] || fail "completed as \"$1\", not \"$2\""; }
expect "$(complete_in_bash le)" "lens"
expect "$(complete_in_bash lens sp)" "spot"
expect "$(complete_in_bash render --de)" "--denoise"
expect "$(complete_in_bash render x.glb --fst)" "--fstop"
expect "$(complete_in_bash lens render --spp)" ""
expect "$(complete_in_bash render "")" ""
bash -n "$there/share/bash-completion/completions/petzval"
if command -v zsh > /dev/null; then zsh -n "$there/share/zsh/site-functions/_petzval"; fi

# Nothing of its own stays after it is removed.
DESTDIR="$out/root" cmake --install "$build" --prefix /opt > "$out/log"
DESTDIR="$out/root" "$source/apps/package/uninstall.sh" "$build/install_manifest.txt"
left=$(find "$out/root" -iname '*petzval*' -o -type f)
[[ -z $left ]] || fail "left after it was removed: $left"

if [[ -f $build/python/petzval/_fields.py ]]; then
    python=$(sed -n 's/^_Python3_EXECUTABLE:INTERNAL=//p' "$build/CMakeCache.txt")
    PYTHONPATH=$(echo "$there"/lib/python3*/dist-packages) PYTHONDONTWRITEBYTECODE=1 "$python" -c "
import petzval
scene = petzval.Scene('$scene')
petzval.render(scene, lens='double-gauss-100mm-f2', size=(96, 64), samples=16).save('$out/python.exr')"
    cmp "$out/python.exr" "$out/build.exr"
fi

# Programs of others. What is linked is as it was built, with sanitizers or without.
flags=$(sed -n 's/^CMAKE_CXX_FLAGS:STRING=//p' "$build/CMakeCache.txt")
cmake -S "$source/tests/examples/outside" -B "$out/outside" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_FLAGS="$flags" -DCMAKE_PREFIX_PATH="$there" > "$out/log" || fail "$(cat "$out/log")"
cmake --build "$out/outside" > "$out/log" || fail "$(cat "$out/log")"
"$out/outside/spot" double-gauss-100mm-f2 10 > "$out/spot"
"$out/outside/spot_shared" double-gauss-100mm-f2 10 | cmp - "$out/spot"
echo "linked: $(ldd "$out/outside/spot" | grep -cE 'libembree|libtbb|OpenImageIO|OpenColorIO' || true)" |
    grep -qx 'linked: 0' || fail "the lens alone links what only scenes need"
"$out/outside/photograph" "$scene" "$out/photograph.exr"
cmp "$out/photograph.exr" "$out/build.exr"
