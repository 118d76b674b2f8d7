#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Renders one picture on a Slurm farm. Each task of an array job renders a range of the samples of
# every pixel to a state file; a last job adds the states up and writes the picture.
#
#   SCENE=room.glb OUT=out/room SPP=4096 PARTS=16 bash submit_ranges.sh --size 1920x1080 --fstop 2
#
# With NOISE=2% each task renders a band of the picture until each part of it has at most that noise,
# or SPP samples. The words at the end are options of `petzval render`. The same line again goes on
# where it was: finished states are kept, others are resumed. Delete $OUT.parts before you render
# something else under the same name. All nodes must see the folder of the states.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

# What to change, here or in the environment.
export SCENE=${SCENE:-scene.glb}
export OUT=${OUT:-picture}            # pictures are $OUT.exr and $OUT.png, states $OUT.parts/part_0.state ...
export NOISE=${NOISE:-}               # noise to reach, as 2%; empty: the number of samples counts
usual_spp=1024
[[ -z $NOISE ]] || usual_spp=4096
export SPP=${SPP:-$usual_spp}         # samples per pixel of all parts together; with NOISE at most
export PARTS=${PARTS:-16}             # number of tasks; each reads the scene once, so let each take minutes
export PETZVAL=${PETZVAL:-petzval}    # the program, as the nodes find it
export CHECKPOINT=${CHECKPOINT:-10m}  # how much work is lost at most when a node dies
export RETRIES=${RETRIES:-3}          # how often a task starts again that something other than Slurm ended
CPUS=${CPUS:-4}                       # per task
MEMORY=${MEMORY:-}                    # per task, as 8G; empty: what the farm gives
TIME_LIMIT=${TIME_LIMIT:-}                        # per start of a task, as 4:00:00; a task that needs more goes on in another

fail() {
    echo "submit_ranges.sh: $1" >&2
    exit 2
}

[[ $SPP =~ ^[1-9][0-9]*$ ]] || fail "SPP is '$SPP': give a whole number of samples, 1 or more"
[[ $PARTS =~ ^[1-9][0-9]*$ ]] || fail "PARTS is '$PARTS': give a whole number of tasks, 1 or more"
[[ -n $NOISE ]] || ((PARTS <= SPP)) || fail "PARTS is $PARTS, but there are $SPP samples: give at most $SPP"
[[ -r $SCENE ]] || fail "SCENE is '$SCENE', which cannot be read: name a scene file"
command -v sbatch > /dev/null || fail "there is no sbatch: run this on a machine of the farm that has slurm-client"
mkdir -p "$OUT.parts"

# --export=ALL: a site may say otherwise, and the settings above travel by the environment.
options=(--parsable --export=ALL)
task=("${options[@]}" --array="0-$((PARTS - 1))" --cpus-per-task="$CPUS")
[[ -z $MEMORY ]] || task+=(--mem="$MEMORY")
[[ -z $TIME_LIMIT ]] || task+=(--time="$TIME_LIMIT")
array=$(sbatch "${task[@]}" "$here/ranges.sbatch" "$@")
array=${array%%;*}  # of several clusters sbatch names the one
# afterok: the merge starts when every task has ended well. When one fails for good, it cannot any
# more, and Slurm takes it out of the queue instead of keeping it there forever.
merge=$(sbatch "${options[@]}" --dependency="afterok:$array" --kill-on-invalid-dep=yes "$here/merge.sbatch")
what="$SPP samples"
[[ -z $NOISE ]] || what="to a noise of $NOISE"
echo "$array renders $what in $PARTS tasks; ${merge%%;*} merges them to $OUT.exr and $OUT.png"
