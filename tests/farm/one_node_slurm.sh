#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Starts and stops a Slurm of one node, this machine, for tests of the farm scripts:
#   one_node_slurm.sh start DIR    DIR is made, or is empty; prints the line that tells clients of it
#   one_node_slurm.sh stop DIR     cancels its jobs, ends its daemons and removes DIR
# It needs no systemd, no cgroups and no account of its own, and leaves a Slurm of the machine alone:
# keys, sockets, ports, states and logs are its own. The daemons and all jobs run as who calls it.
# Exit code 77: packages are missing.
set -euo pipefail
PATH=$PATH:/usr/sbin:/sbin  # where the daemons are, which an ordinary user's PATH leaves out

fail() {
    echo "one_node_slurm.sh: $1" >&2
    exit "${2:-1}"
}

require_packages() {
    local missing=() program
    for program in munge:munged slurmctld:slurmctld slurmd:slurmd slurm-client:sbatch; do
        command -v "${program#*:}" > /dev/null || missing+=("${program%:*}")
    done
    ((${#missing[@]} == 0)) ||
        fail "packages are missing: install them with apt-get install ${missing[*]}" 77
}

# Two ports in a row that nobody listens on. They are drawn, so that two Slurms that start at once
# do not meet, and lie below those that the kernel lends to clients.
find_port() {
    for ((tries = 0; tries < 100; tries++)); do
        port=$((10000 + (RANDOM << 15 | RANDOM) % 20000))
        if ! (exec 3<> "/dev/tcp/127.0.0.1/$port") 2> /dev/null &&
            ! (exec 3<> "/dev/tcp/127.0.0.1/$((port + 1))") 2> /dev/null; then
            return
        fi
    done
    fail "no free port was found between 10000 and 30000"
}

write_configuration() {
    local host port
    host=$(hostname -s)
    find_port
    mkdir "$dir/state" "$dir/spool"
    # Why these lines:
    # - cred_expire: Slurm starts a requeued job no sooner than its credential has expired, by default
    #   after two minutes.
    # - sched_interval, batch_sched_delay: the queue is looked at every second, not every minute.
    # - CR_CPU: memory is not shared out, or a job that asks for none would get all of it.
    # - linuxproc, task/none, jobacct_gather/none: nothing asks for cgroups, which a container may lack.
    # - SlurmdParameters: the node has the CPUs that we say, though its sockets may be odd.
    cat > "$dir/slurm.conf" << CONF
ClusterName=onenode
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket,cred_expire=5
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
SlurmSchedLogLevel=0
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
MailProg=/bin/true
SlurmdParameters=config_overrides
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,batch_sched_delay=0,bf_interval=1
ReturnToService=2
JobRequeue=1
KillWait=5
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$(($(awk '/^MemTotal/ {print $2}' /proc/meminfo) / 1024)) State=UNKNOWN
PartitionName=low Nodes=$host Default=YES MaxTime=INFINITE State=UP PriorityTier=1 PreemptMode=REQUEUE
PartitionName=high Nodes=$host MaxTime=INFINITE State=UP PriorityTier=10 PreemptMode=OFF
CONF
}

start() {
    require_packages
    dir=$(realpath -m "$dir")
    ((${#dir} < 80)) || fail "the path of $dir is too long for a socket: name one of under 80 letters"
    [[ $dir != *[[:space:],]* ]] || fail "$dir has spaces or commas, which slurm.conf cannot hold: name another"
    mkdir -p "$dir"
    [[ -z $(ls -A "$dir") ]] || fail "$dir is not empty: name a new folder"
    chmod 700 "$dir"
    touch "$dir/.one_node_slurm"  # stop removes no folder without it
    trap 'stop || true' EXIT      # of a start that fails

    # Processes of this Slurm are known by this variable, whatever became of their parents.
    export PETZVAL_ONE_NODE_SLURM=$dir SLURM_CONF=$dir/slurm.conf
    (umask 077 && head -c 1024 /dev/urandom > "$dir/munge.key")
    # --force: munged objects to a socket that not everybody can reach. Here only one user shall.
    munged --force --key-file="$dir/munge.key" --socket="$dir/munge.socket" --pid-file="$dir/munged.pid" \
        --log-file="$dir/munged.log" --seed-file="$dir/munge.seed" --num-threads=2 > "$dir/munged.out" 2>&1 ||
        fail "munged did not start: $(tail -n 5 "$dir/munged.out" "$dir/munged.log")"
    write_configuration
    slurmctld > "$dir/slurmctld.out" 2>&1 ||
        fail "slurmctld did not start: $(tail -n 5 "$dir/slurmctld.out" "$dir/slurmctld.log")"
    slurmd > "$dir/slurmd.out" 2>&1 ||
        fail "slurmd did not start: $(tail -n 5 "$dir/slurmd.out" "$dir/slurmd.log")"
    for ((tries = 0; tries < 150; tries++)); do
        if [[ $(sinfo --noheader --partition=low --format=%T 2> /dev/null) == idle ]]; then
            trap - EXIT
            echo "export SLURM_CONF=$SLURM_CONF"
            return
        fi
        sleep 0.2
    done
    fail "the node did not become idle within 30 s: $(tail -n 5 "$dir/slurmctld.log" "$dir/slurmd.log")"
}

# The processes that belong to this Slurm: its daemons and those that watch its jobs.
processes() {
    { grep -lszxF "PETZVAL_ONE_NODE_SLURM=$dir" /proc/[0-9]*/environ || true; } | cut -d / -f 3
}

stop() {
    unset PETZVAL_ONE_NODE_SLURM  # or what stop calls itself would belong to it
    [[ -e $dir/.one_node_slurm ]] || fail "$dir holds no Slurm that start has made"
    dir=$(realpath "$dir")
    export SLURM_CONF=$dir/slurm.conf
    # Jobs first, by Slurm's own means: nobody else ends what they have started.
    if [[ -e $dir/slurmctld.pid ]] && timeout 5 scontrol ping > /dev/null 2>&1; then
        timeout 10 scancel --quiet --full --signal=KILL --user="$(id -un)" || true
        timeout 10 scancel --quiet --user="$(id -un)" || true
        for ((tries = 0; tries < 100; tries++)); do
            [[ $(timeout 5 squeue --noheader --format=%A) ]] || break
            sleep 0.2
        done
    fi
    local pids signal
    for signal in TERM KILL; do
        for ((tries = 0; tries < 50; tries++)); do
            mapfile -t pids < <(processes)
            ((${#pids[@]})) || break 2
            ((tries)) || kill -s $signal "${pids[@]}" 2> /dev/null || true
            sleep 0.2
        done
    done
    rm -r "$dir"
}

(($# == 2)) || fail "say one_node_slurm.sh start DIR, or stop DIR" 2
dir=$2
case $1 in
    start) start ;;
    stop) stop ;;
    *) fail "'$1' is neither start nor stop" 2 ;;
esac
