#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Fails where a file of the product is not in the namespace of its wing: petzval for core, petzval::WING for
# the others. Types of another wing may be declared. Fails where two headers define a type of one name: in one
# namespace no compiler tells it, and in two a reader takes one for the other.
set -euo pipefail
cd "$(dirname "$0")/.."

astray=$(for wing in core camera integrator io apps; do
    namespace=petzval
    [ $wing = core ] || namespace+="::$wing"
    grep -rEn --include='*.h' --include='*.cpp' '^namespace petzval' $wing |
        grep -vE ":namespace $namespace(::[a-z_]+)? \{" |
        while IFS=: read -r file line text; do
            sed -n "$((line + 2))p" "$file" | grep -qE '^(class|struct) [A-Za-z]+;$' || echo "$file:$line: $text"
        done || true
done)

types=$(grep -rEo --include='*.h' '^(struct|class|enum class|union) [A-Za-z0-9_]+ (final )?[:{]' \
    core camera integrator io apps | sed -E 's/ (final )?[:{]$//; s/:(struct|class|enum class|union) / /')
if [ -n "$astray" ]; then
    echo "not in the namespace of its wing:"
    echo "$astray"
    exit 1
fi
[ "$(wc -l <<< "$types")" -gt 300 ] || { echo "the search finds too few types"; exit 1; }
doubled=$(awk '{print $2}' <<< "$types" | sort | uniq -d)
[ -z "$doubled" ] && exit 0
while read -r name; do
    echo "$name is defined in $(awk -v n="$name" '$2 == n {print $1}' <<< "$types" | xargs)"
done <<< "$doubled"
exit 1
