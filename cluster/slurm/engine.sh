# shellcheck shell=bash disable=SC2154
# A Slurm cluster of two nodes on this machine, in the folder `scratch`: munged, slurmctld, one slurmd per node. No systemd, no cgroups, any user.

NODES=(node1 node2)
daemons=()

engine_up() {
    local host first_port
    host=$(uname -n) host=${host%%.*}
    first_port=$(free_ports)
    mkdir -p "$scratch"/{munge,state,log,node1,node2}
    chmod 700 "$scratch/munge"
    head -c 1024 /dev/urandom >"$scratch/munge/key"
    chmod 600 "$scratch/munge/key"
    configuration "$host" "$first_port" >"$scratch/slurm.conf"
    export SLURM_CONF=$scratch/slurm.conf

    # --force: the folder above is open to all (/tmp).
    munged --foreground --force --key-file="$scratch/munge/key" --socket="$scratch/munge/socket" --pid-file="$scratch/munge/pid" \
        --log-file="$scratch/log/munge.txt" --seed-file="$scratch/munge/seed" >"$scratch/log/munged.txt" 2>&1 &
    daemons+=($!)
    wait_until 10 "munged's socket" test -S "$scratch/munge/socket"
    slurmctld -D >"$scratch/log/slurmctld.txt" 2>&1 &
    daemons+=($!)
    for node in "${NODES[@]}"; do node_up "$node"; done
}

node_up() { # NODE
    slurmd -D -N "$1" >>"$scratch/log/$1.txt" 2>&1 &
    daemons+=($!)
    echo $! >"$scratch/$1/id"
    wait_until 60 "$1 at work" node_is "$1" 'idle|mixed|allocated|completing'
}

node_is() { # NODE STATES
    sinfo --noheader --nodes="$1" --format=%T | grep -qE "^($2)"
}

# kill -9 of all that runs on a node: slurmd, the keepers of its jobs, the jobs. As when its plug is pulled.
node_lost() { # NODE
    local id job ids
    read -r id <"$scratch/$1/id"
    kill -KILL "$id"
    wait "$id" 2>/dev/null || true # says nothing of the kill
    for job in $(squeue --noheader --nodes="$1" --states=running --format=%A); do
        for id in $(pgrep -f -- "slurmstepd: \[$job\."); do
            grep -qzFx "SLURM_CONF=$SLURM_CONF" "/proc/$id/environ" || continue
            mapfile -t ids < <(descendants "$id")
            kill -KILL "$id" "${ids[@]}"
        done
    done
}

descendants() { # PROCESS
    local child
    for child in $(pgrep -P "$1"); do
        descendants "$child"
        echo "$child"
    done
}

engine_down() {
    # Before the engine is up, scancel would speak to the machine's own Slurm.
    [ "${SLURM_CONF:-}" = "$scratch/slurm.conf" ] || return 0
    scancel --quiet --user="$(id -u)" 2>/dev/null
    sleep 1
    for id in "${daemons[@]}"; do kill -TERM "$id" 2>/dev/null; done
    sleep 1
    for id in "${daemons[@]}"; do kill -KILL "$id" 2>/dev/null; done
}

# The first of three ports in a row that nobody listens on.
free_ports() {
    local port
    while :; do
        port=$((20000 + RANDOM % 30000))
        listening "$port" || listening $((port + 1)) || listening $((port + 2)) || break
    done
    echo "$port"
}

listening() { (: </dev/tcp/127.0.0.1/"$1") 2>/dev/null; }

configuration() { # HOST PORT
    cat <<END
ClusterName=sweep_test
SlurmctldHost=$1(127.0.0.1)
SlurmctldPort=$2
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
CredType=cred/munge
# cred_expire is also how long a job waits that was put back into the queue (120 s unless told).
AuthInfo=socket=$scratch/munge/socket,cred_expire=5
StateSaveLocation=$scratch/state
SlurmdSpoolDir=$scratch/%n
SlurmctldPidFile=$scratch/state/id
SlurmdPidFile=$scratch/%n/pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=2
SlurmdTimeout=5
ReturnToService=2
KillWait=2
NodeName=node1 NodeHostname=$1 NodeAddr=127.0.0.1 Port=$(($2 + 1)) CPUs=1
NodeName=node2 NodeHostname=$1 NodeAddr=127.0.0.1 Port=$(($2 + 2)) CPUs=1
PartitionName=main Nodes=node1,node2 Default=YES MaxTime=INFINITE State=UP
END
}
