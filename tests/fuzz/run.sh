#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Runs each reader of files under libFuzzer for its share of the given time, from the corpus in
# tests/data/corpus, on one core: tests/fuzz/run.sh SECONDS [PROGRAM] [FOLDER] [READER...]. What it
# finds lies in FOLDER: READER/ holds files of new paths, READER-crash-* those that show faults.
# The reader of .glb files begins with files of mesh_seeds, which lies beside PROGRAM, too.
set -u
here=$(cd "$(dirname "$0")/../.." && pwd)
seconds=$1 program=${2:-$here/build-fuzz/bin/decoder_fuzz} out=${3:-$here/out/fuzz}
readers=("${@:4}")
[ ${#readers[@]} -gt 0 ] || readers=($(ls "$here/tests/data/corpus"))
# Leaks are not counted: OpenImageIO keeps its messages.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1
# One thread: starting threads for each small picture takes most of the time.
export OPENIMAGEIO_OPTIONS=threads=1,exr_threads=-1
for reader in "${readers[@]}"; do
    mkdir -p "$out/$reader"
    seeds=("$here/tests/data/corpus/$reader")
    if [ "$reader" = glb ]; then
        "$(dirname "$program")/mesh_seeds" "$out/seeds" 300 && seeds+=("$out/seeds")
    fi
    echo "== $reader"
    FUZZ_READER=$reader nice -n 5 "$program" "$out/$reader" "${seeds[@]}" -fork=1 \
        -ignore_crashes=1 -ignore_ooms=1 -ignore_timeouts=1 -max_len=65536 -timeout=20 \
        -rss_limit_mb=4096 -max_total_time=$((seconds / ${#readers[@]})) \
        -artifact_prefix="$out/$reader-" > "$out/$reader.log" 2>&1
    grep -E '^#[0-9]+' "$out/$reader.log" | tail -1
    grep -hE 'ERROR: |runtime error' "$out/$reader.log" | sort | uniq -c
done
