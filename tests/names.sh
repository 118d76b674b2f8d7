#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Fails where a file of the product is not in the namespace of its wing: petzval for core, petzval::WING for
# the others. Types of another wing may be declared. Fails where two headers define a type of one name: in one
# namespace no compiler tells it, and in two a reader takes one for the other.
set -euo pipefail
cd "$(dirname "$0")/.."

# By file: namespaces of its own, and blocks of another wing's that hold more than declarations of types.
astray=$(for wing in core camera integrator io apps; do
    own="petzval::$wing(::[a-z0-9_]+)?"
    [ $wing = core ] && own='petzval(::(embree|material_reading))?'
    find $wing -name '*.h' -o -name '*.cpp' | sort | xargs awk -v own="^namespace $own [{]" '
        function close_file() { if (file && !found) print file ": no namespace of its wing" }
        FNR == 1 { close_file(); file = FILENAME; found = other = 0 }
        other && /^[}]/ { other = 0 }
        other && NF && !/^(class|struct|enum class) [A-Za-z]+( : [a-z0-9_]+)?;/ { print file ":" FNR ": " $0; other = 0 }
        $0 ~ own { found = 1; next }
        /^namespace petzval/ { other = 1 }
        END { close_file() }'
done | grep -vE '^(apps/main|apps/package/main|apps/python/main|apps/processor)[.]cpp: no namespace' || true)

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
