#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Fails where README or a page names a path, a link, an option, a method or a command that is not there,
# or a page is not what its program prints:
#
#   tests/docs.sh PETZVAL
#
# docs/measured keeps the commands of older programs, and is read for links and paths alone.
set -u
cd "$(dirname "$0")/.."
petzval=$1
pages=(README.md SECURITY.md CONTRIBUTING.md docs/*/*.md)
current=(README.md SECURITY.md CONTRIBUTING.md docs/{guide,design,develop}/*.md)
status=0
missing() {
    echo "$1: $2 is not there"
    status=1
}

# Paths of the tree, as `core/film/film.h` or tests/measure/noise.py.
for page in "${pages[@]}"; do
    for path in $(grep -oP '(?<![\w/.-])(core|camera|integrator|io|apps|tests|assets|docs)/[\w/.-]*\w(?![\w*{<-])' "$page" | sort -u); do
        [ -e "$path" ] || compgen -G "$path.*" > /dev/null || compgen -G "$path*" > /dev/null || missing "$page" "$path"
    done
    for link in $(grep -oP '\]\(\K[^)#]+(?=[)#])' "$page" | grep -v '^http' | sort -u); do
        [ -e "$(dirname "$page")/$link" ] || missing "$page" "$link"
    done
done

python3 tests/make/learn_page.py | cmp -s - docs/guide/learn.md ||
    missing docs/guide/learn.md "what tests/make/learn_page.py prints"

# Options and methods of every command.
mapfile -t commands < <(for c in "" image lens; do
    "$petzval" $c --help | sed -n '/^Subcommands:/,$p' | grep -oP "^  \K[a-z-]+(?=  )" | sed "s/^/$c /"; done |
    grep -vxE " (image|lens)")
known=$(for c in "${commands[@]}"; do "$petzval" help $c all; done |
    grep -oP '((?<=--)|(?<=^  ))[a-z][a-z-]*' | sort -u)
[ "$(wc -l <<< "$known")" -gt 80 ] || missing "$petzval" "its help"
names=$(printf '%s\n' "${commands[@]##* }" image lens)
foreign='build|install|prefix|preset|target|gtest_filter|tool|parallel|array|cpus-per-task|axis|scenes|peer|rows|seeds|timed-seeds|petzval|reference-spp|factory-startup|size|help|version|list-presets|formats|crop|out|printstats|mosaic'
for page in "${current[@]}"; do
    for option in $(grep -oP '(?<![\w-])--\K[a-z][a-z_-]*\w|--method \K[a-z-]+' "$page" | sort -u |
        grep -vxF -- "$known" | grep -vxE -- "$foreign"); do
        missing "$page" "--$option"
    done
    for command in $(grep -oP '\bpetzval \K(?!help\b)[a-z-]+(?= )' "$page" | sort -u | grep -vxF -- "$names"); do
        missing "$page" "petzval $command"
    done
done
exit $status
