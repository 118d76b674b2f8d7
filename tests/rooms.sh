#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Fails where a folder of the project holds over 40 files, or where one of its top-level folders
# holds over 37 % of the product's lines.
set -euo pipefail
cd "$(dirname "$0")/.."
most_files=40 most_percent=37 status=0

while read -r count folder; do
    if ((count > most_files)); then
        echo "$folder holds $count files, over $most_files"
        status=1
    fi
done < <(find core camera integrator io apps tests assets docs -type f -printf '%h\n' |
    grep -v __pycache__ | sort | uniq -c)

lines() { find "$@" -name '*.h' -o -name '*.cpp' | xargs cat | wc -l; }
all=$(lines core camera integrator io apps)
for top in core camera integrator io apps; do
    some=$(lines $top)
    echo "$top: $some of $all lines, $((100 * some / all)) %"
    if ((100 * some > most_percent * all)); then
        echo "$top holds over $most_percent % of the product's lines"
        status=1
    fi
done
exit $status
