#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Fails where two headers of the product define a type of one name: C++ demands that both are the
# same, and no compiler tells where they are not.
set -euo pipefail
cd "$(dirname "$0")/.."

types=$(grep -rEo --include='*.h' '^(struct|class|enum class|union) [A-Za-z0-9_]+ (final )?[:{]' \
    core camera integrator io apps | sed -E 's/ (final )?[:{]$//; s/:(struct|class|enum class|union) / /')
[ "$(wc -l <<< "$types")" -gt 300 ] || { echo "the search finds too few types"; exit 1; }
doubled=$(awk '{print $2}' <<< "$types" | sort | uniq -d)
[ -z "$doubled" ] && exit 0
while read -r name; do
    echo "$name is defined in $(awk -v n="$name" '$2 == n {print $1}' <<< "$types" | xargs)"
done <<< "$doubled"
exit 1
