#!/usr/bin/env bash
# A sweep as a Slurm job array, one task per shard, and its merge as a job that waits for them.
# Again with the same arguments: only the shards that are not complete are submitted.
set -euo pipefail

usage="usage: submit.sh SWEEP.toml --shards N [--out DIR] [--smam PATH] [--at-once K] [-- OPTIONS OF SBATCH...]
  --shards N    tasks of the array; each gets every N-th point
  --out DIR     shards, logs and the merged table [default: out/sweep_STEM, of the sweep file]
  --smam PATH   the program, on a disk that all nodes see [default: smam, from PATH]
  --at-once K   run at most K tasks at a time
  -- OPTIONS    for array and merge, such as --partition=... --account=... --time=... ; --cpus-per-task=C gives each shard C threads"
refuse() { echo "error: $1" >&2; shift; printf '%s\n' "$@" >&2; exit 2; }

cluster=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
sweep='' shards='' out='' smam=smam at_once=''
while [ $# -gt 0 ]; do
    case $1 in
        --shards | --out | --smam | --at-once)
            [ $# -gt 1 ] || refuse "$1 needs a value" "$usage"
            option=${1#--}
            printf -v "${option/-/_}" '%s' "$2"
            shift
            ;;
        -h | --help) echo "$usage" && exit ;;
        --) shift && break ;;
        -*) refuse "$1 is no option" "$usage" ;;
        *) [ -z "$sweep" ] || refuse "$1: one sweep file at a time" "$usage"; sweep=$1 ;;
    esac
    shift
done
[ -f "$sweep" ] || refuse "'$sweep' is no sweep file" "$usage"
[[ $shards =~ ^[1-9][0-9]*$ ]] || refuse "--shards '$shards': give a whole number, at least 1" "$usage"
[[ $at_once =~ ^([1-9][0-9]*)?$ ]] || refuse "--at-once '$at_once': give a whole number, at least 1" "$usage"
program=$(command -v "$smam") || refuse "$smam: no such program" "  remedy: --smam /path/to/smam"

# Slurm's own limit on the numbers of an array's tasks.
settings=$(scontrol show config) || refuse "Slurm does not answer" "  remedy: submit from a machine where squeue works"
largest=$(awk '$1 == "MaxArraySize" { print $3 - 1 }' <<<"$settings")
[ "$shards" -le "${largest:-1000}" ] || refuse "--shards $shards: this cluster's MaxArraySize allows $largest" "  remedy: fewer shards"

out=${out:-out/sweep_$(basename "$sweep" .toml)}
mkdir -p "$out/log"
sweep=$(realpath "$sweep") smam=$(realpath "$program") out=$(realpath "$out")
# Two runs of a shard would do no harm, and its work twice.
queued=$(squeue --me --noheader --format=%Z)
! grep -qFx "$out" <<<"$queued" ||
    refuse "$out: jobs of this folder are still in the queue" "  remedy: wait for them, or end them with scancel (squeue --me)"

undone=$("$cluster/undone.sh" "$shards" "$out" | paste -sd,)
name=$(basename "$out")
after=()
if [ -n "$undone" ]; then
    [ "$("$cluster/undone.sh" "$shards" "$out" | wc -l)" -lt "$shards" ] || undone=1-$shards
    array=$(sbatch --parsable --job-name="$name" --chdir="$out" --array="$undone${at_once:+%$at_once}" --output="$out/log/shard_%a.txt" \
        --open-mode=append --requeue --signal=B:USR1@60 "$@" \
        "$cluster/slurm/shard_job.sh" "$cluster" "$shards" "$out" "$smam" sweep "$sweep")
    echo "job ${array%%;*}: shards $undone of $shards, logs in $out/log"
    # Not afterok, which would leave the merge waiting for ever when a shard fails: merge.sh says which.
    after=(--dependency="afterany:${array%%;*}")
fi
merge=$(sbatch --parsable --job-name="$name.merge" --chdir="$out" --output="$out/log/merge.txt" "${after[@]}" "$@" --cpus-per-task=1 \
    --wrap "$(printf '%q ' exec "$cluster/merge.sh" "$shards" "$out" "$smam" "$sweep")")
echo "job ${merge%%;*}: merge into $out/table.csv, log in $out/log/merge.txt"
