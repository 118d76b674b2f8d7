#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Renders a picture with the scripts of assets/farm/slurm on a Slurm of one node, of its own:
#   slurm_test.sh PETZVAL_BINARY SCENE
# One task is killed, one is requeued by hand while it renders, and the merged picture must have the
# bytes of one render that nobody disturbed. Then a state gets lost, and a task fails for good: both
# must be told, and neither may give a picture. Exit code 77: Slurm's packages are missing.
set -euo pipefail
(($# == 2)) || { echo "say slurm_test.sh PETZVAL_BINARY SCENE" >&2; exit 2; }
program=$(realpath "$1") scene=$(realpath "$2")
tests=$(cd "$(dirname "$0")" && pwd)
scripts=$(realpath "$tests/../../assets/farm/slurm")
size=(--size 96x54 --seed 7)  # words of every render
parts=4

# Where this runs as a job of a farm, or with settings for one, they are not ours.
while read -r name; do unset "$name"; done < <(compgen -v | grep -E '^(SLURM|SBATCH|SQUEUE|SCANCEL|SCONTROL)_' || true)
unset SCENE OUT SPP NOISE PARTS CHECKPOINT RETRIES CPUS MEMORY TIME_LIMIT

# Not below TMPDIR: the path of a socket is short.
folder=$(mktemp -d /tmp/petzval_farm.XXXXXX)
clean_up() {
    trap '' INT TERM HUP  # a second signal must not stop the cleaning
    [[ ! -e $folder/slurm/.one_node_slurm ]] || "$tests/one_node_slurm.sh" stop "$folder/slurm" || true
    rm -rf "$folder"
}
trap clean_up EXIT
trap 'exit 130' INT TERM HUP

started=$("$tests/one_node_slurm.sh" start "$folder/slurm") || exit $?
eval "$started"

cd "$folder"
failed() {
    echo "FAILED: $1" >&2
    local log
    for log in slurm-*.out; do
        [[ -e $log ]] || continue
        echo "--- $log" >&2
        tr '\r' '\n' < "$log" | grep -v '^PROGRESS' | tail -n 20 >&2 || true
    done
    squeue >&2 || true
    exit 1
}
step() { echo "$(date +%T) $1"; }
# until_true SECONDS WHAT COMMAND...: waits for it, and fails where it does not become true.
until_true() {
    local seconds=$1 what=$2 end=$((SECONDS + $1))
    shift 2
    until "$@"; do
        ((SECONDS < end)) || failed "within $seconds s it did not come to this: $what"
        sleep 0.2
    done
}
state_of() { scontrol --oneliner show job "$1" | grep -o 'JobState=[A-Z]*' | cut -d = -f 2 | sort -u | paste -sd ' '; }
is() { [[ $(state_of "$1") == "$2" ]]; }
is_over() { [[ -z $(squeue --noheader --jobs="$1" 2> /dev/null) ]]; }
# The process that renders a part: the one that has the state's name among its words.
renderer_of() { { grep -lszxF -- "$OUT.parts/part_$1.state" /proc/[0-9]*/cmdline || true; } | cut -d / -f 3; }
is_under_way() { [[ -e $OUT.parts/part_$1.state && $(renderer_of "$1") ]]; }

# So many samples that all parts together take one thread about 20 s, on any machine: parts must be
# caught half-way, and the whole must not take long. Not a multiple of the parts.
begin=${EPOCHREALTIME/[.,]/}
timeout 60 "$program" render "$scene" "${size[@]}" --spp 64 --threads 1 --quiet -o trial.exr ||
    failed "a first render did not end well within 60 s"
took=$((${EPOCHREALTIME/[.,]/} - begin))
spp=$((64 * 20000000 / took / parts * parts + 1))
((spp > 8 * parts)) || spp=$((8 * parts + 1))
# Farm scripts have their settings by the environment. Names with spaces must do.
export PETZVAL=$program SCENE=$folder/'the scene.glb' OUT=$folder/'states of it'/picture
export SPP=$spp PARTS=$parts CPUS=1 CHECKPOINT=1s
mkdir "$(dirname "$OUT")"
cp "$scene" "$SCENE"

step "one render of $spp samples that nobody disturbs"
timeout 60 "$program" render "$SCENE" "${size[@]}" --spp "$spp" --quiet -o whole.exr -o whole.png ||
    failed "the whole render did not end well within 60 s"

step "the same in $parts tasks"
line=$(bash "$scripts/submit_ranges.sh" "${size[@]}")
array=${line%% *}
merge=${line#*; }
merge=${merge%% *}
echo "$line"
until_true 30 "part 0 has written a checkpoint and goes on" is_under_way 0
kill -KILL "$(renderer_of 0)" || failed "part 0 was over before it could be killed"
step "part 0 killed"
until_true 30 "part 1 has written a checkpoint and goes on" is_under_way 1
scontrol requeue "${array}_1" || failed "part 1 was over before it could be requeued"
step "part 1 requeued"
until_true 90 "the merge is over" is_over "$merge"
step "merged"
is "$merge" COMPLETED || failed "the merge ended as $(state_of "$merge")"
grep -q 'part 0: exit code 137' "slurm-${array}_0.out" || failed "part 0 was not seen to be killed"
for part in 0 1; do
    grep -q ' resume ' "slurm-${array}_$part.out" || failed "part $part was not resumed"
done
grep -q 'part 1: exit code 130' "slurm-${array}_1.out" || failed "part 1 did not stop by Slurm's signal with exit code 130"
for ending in exr png; do
    cmp "whole.$ending" "$OUT.$ending" || failed "the merged $ending is not that of one render"
done

step "one render to a noise, and the same in bands"
timeout 60 "$program" render "$SCENE" "${size[@]}" --noise 20% --quiet -o noise.exr || failed "the render to a noise did not end well within 60 s"
line=$(NOISE=20% SPP=4096 PARTS=2 OUT="$OUT.noise" bash "$scripts/submit_ranges.sh" "${size[@]}")
echo "$line"
merge=${line#*; }
merge=${merge%% *}
until_true 90 "the merge of the bands is over" is_over "$merge"
is "$merge" COMPLETED || failed "the merge of the bands ended as $(state_of "$merge")"
cmp noise.exr "$OUT.noise.exr" || failed "the merged bands are not the picture of one render"

step "a state gets lost"
rm "$OUT.parts/part_2.state" "$OUT.exr" "$OUT.png"
from=$((spp * 2 / parts)) to=$((spp * 3 / parts))
status=0
"$program" merge "$OUT".parts/part_{0,1,3}.state -o "$OUT.exr" > lost.txt 2>&1 || status=$?
cat lost.txt
((status == 1)) || failed "merge without part 2 has exit code $status, not 1"
grep -qE "(^|[^0-9])$from([^0-9].*)?[^0-9]($to|$((to - 1)))([^0-9]|$)" lost.txt ||
    failed "merge without part 2 does not name the missing samples $from:$to"
job=$(sbatch --parsable "$scripts/merge.sbatch")
until_true 20 "the merge without part 2 is over" is_over "$job"
is "$job" FAILED || failed "merge.sbatch without part 2 ended as $(state_of "$job")"
grep -q "$from:$to" "slurm-$job.out" || failed "merge.sbatch does not name the missing samples $from:$to"
[[ ! -e $OUT.exr ]] || failed "there is a picture without part 2"

step "a task fails for good"
export OUT=$folder/never PETZVAL=/bin/false
line=$(bash "$scripts/submit_ranges.sh" "${size[@]}")
merge=${line#*; }
merge=${merge%% *}
until_true 30 "the merge is taken out of the queue" is_over "$merge"
is "$merge" CANCELLED || failed "the merge after a task that failed ended as $(state_of "$merge")"
[[ ! -e $OUT.exr ]] || failed "there is a picture after a task that failed"
step "all as it should be"
