#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Runs the checks that take too long for each merge, all of them or those that are named:
#
#   tests/long.sh [files] [address] [thread] [tidy] [fuzz] [coverage] [mutants] [noise] [root]
#
#   files     each file of the product compiles by itself
#   address   all tests under the address and undefined-behaviour sanitizers
#   thread    the tile loop and the search for ghosts under the thread sanitizer
#   tidy      clang-tidy over the product, by the checks of .clang-tidy
#   fuzz      the readers of files, and random lenses, FUZZ_SECONDS each (600)
#   coverage  the share of the product's lines that the tests reach
#   mutants   small faults on purpose: do the tests notice? MUTANTS of them (20)
#   noise     200 scenes that are made to fool plans, rendered to a noise
#   root      README's commands and packages in bare Debians 12 and 13 (root only)
#
# Goes on after a failure. Ends with a line for each part, and fails where one failed.
set -u
cd "$(dirname "$0")/.."
parts=("$@")
[ ${#parts[@]} -gt 0 ] || parts=(files address thread tidy fuzz coverage mutants noise root)

files() { cmake --preset files -DPETZVAL_TESTS=OFF -DPETZVAL_BENCH=OFF && cmake --build --preset files; }
# The leak checker itself crashes at the end of 1 program in 1,000; a fault of a test fails twice.
address() {
    cmake --preset asan && cmake --build --preset asan &&
        ctest --preset asan --parallel "$(nproc)" --repeat until-pass:2
}
thread() { cmake --preset tsan && cmake --build --preset tsan --target camera_test integrator_test apps_state_test && ctest --preset tsan; }
# The build writes the compile commands, and a header that some files include.
tidy() {
    cmake --preset files && cmake --build --preset files --target petzval_io_build || return 1
    git ls-files core camera integrator io apps | grep '[.]cpp$' |
        xargs --max-args=1 --max-procs="$(nproc)" clang-tidy -p build-files --quiet
}
fuzz() {
    local seconds=${FUZZ_SECONDS:-600}
    cmake --preset fuzz && cmake --build --preset fuzz || return 1
    local found=out/fuzz
    tests/fuzz/run.sh "$seconds" build-fuzz/bin/decoder_fuzz "$found"
    build-fuzz/bin/lens_fuzz 1000000000 --seconds "$seconds" || return 1
    if compgen -G "$found/*-crash-*" > /dev/null; then
        echo "The files that show faults: $found/*-crash-*"
        return 1
    fi
}
coverage() {
    cmake --preset coverage && cmake --build --preset coverage && ctest --preset coverage --parallel "$(nproc)" &&
        gcovr --root . --filter '(core|camera|integrator|io|apps)/' --sort-percentage --print-summary build-coverage
}
mutants() { python3 tests/measure/mutants.py --count "${MUTANTS:-20}"; }
noise() {
    cmake --preset release && cmake --build --preset release --target apps_render_test &&
        PETZVAL_NOISE_SCENES=200 build/bin/apps_render_test --gtest_filter='NoiseAdversary.*'
}
root() { tests/measure/roots.sh 12 && tests/measure/roots.sh 13; }

status=0 results=()
for part in "${parts[@]}"; do
    echo "== $part"
    SECONDS=0
    if "$part"; then result=passed; else result=FAILED status=1; fi
    results+=("$part: $result, $((SECONDS / 60)) min")
done
printf '%s\n' "${results[@]}"
exit $status
