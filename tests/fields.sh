#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Fails where code below apps/cli spells an option of the command line, or where a message names a
# field, as ⟨focus⟩, that no command takes:  tests/fields.sh PETZVAL
set -u
cd "$(dirname "$0")/.."
petzval=$1
status=0

# Options of other programs, which a message tells to run, stand after "cmake" or "npx".
if grep -rnP '"[^"]*(?<![\w-])--[a-z]' core camera integrator io apps/{request,setup,plan,render,state,chart} \
        --include='*.cpp' --include='*.h' | grep -vE '^\S+\s*//|cmake --|npx |io/plot/|option_text\.cpp'; then
    echo "these spell options: write ⟨name⟩ in place of --name"
    status=1
fi

known=$(for command in render chart "lens spot" "image view"; do "$petzval" help $command all; done |
    grep -oP '((?<=--)|(?<=^  ))[a-z][a-z-]*' | sort -u)
for name in $(grep -rhoP '⟨\K[a-z-]+(?=⟩)' core camera integrator io apps --include='*.cpp' | sort -u); do
    if ! grep -qx -- "$name" <<< "$known"; then
        echo "⟨$name⟩ is the name of no field"
        status=1
    fi
done
exit $status
