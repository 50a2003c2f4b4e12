#!/usr/bin/env bash
# What each task of the array runs: one shard. Slurm runs a copy of this file, so the folder of shard.sh is told.
#   shard_job.sh CLUSTER N OUT COMMAND...
# USR1, sent before the time limit, reaches shard.sh, which takes this shell's place; the shard then goes back into the queue.
set -euo pipefail

export SMAM_AGAIN="scontrol requeue $SLURM_JOB_ID"
cluster=$1
shift
exec "$cluster/shard.sh" "$SLURM_ARRAY_TASK_ID" "$@" --threads "${SLURM_CPUS_PER_TASK:-1}"
