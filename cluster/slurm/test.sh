#!/usr/bin/env bash
# shellcheck disable=SC1091,SC2154 # names of testing.sh and engine.sh
# Runs a sweep on a Slurm cluster of two nodes on this machine, and kills: the program, a node, a task; one is cancelled. Then submits
# what is missing again, and compares the merged table with that of one run. SMAM: the program. Exit code 77: no Slurm here.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
PATH=$PATH:/usr/sbin:/sbin
. "$here/../testing.sh"
. "$here/engine.sh"
limited 300 "$here/test.sh"
needs "apt-get install slurm-wlm munge procps" slurmctld slurmd sbatch munged pgrep
smam=$(realpath "${SMAM:-$here/../../target/release/smam}")
[ -x "$smam" ] || fail "$smam is no program: cargo build --release, or SMAM=..."

scratch
reference
engine_up
ok "$(slurmctld -V): ${#NODES[@]} nodes of one core"

submit() { "$here/submit.sh" "$sweep" --smam "$smam" --shards "$SHARDS" --out "$out" "$@"; }
running() { squeue --noheader --name=out --states=running --format=%K "$@"; }
# Those of them that nothing has befallen yet.
killed='' lost='' warned=''
hit_none() { running "$@" | grep -vxE "${killed:-no}|${lost:-no}|${warned:-no}" || true; }
# A field of what Slurm knows of a job.
job_says() { scontrol show job "$1" --oneliner | tr ' ' '\n' | sed -n "s/^$2=//p" | head -n 1; }
ended() { [ -z "$(squeue --noheader)" ]; }
log_of() { echo "$out/log/shard_$1.txt"; }

submitted=$(submit -- --time=10)
say "$(head -n 1 <<<"$submitted")"
array=$(awk '/shards/ { print $2 }' <<<"$submitted") array=${array%:}
merge=$(awk '/merge/ { print $2 }' <<<"$submitted") merge=${merge%:}
if submit -- --time=10 2>"$scratch/twice.txt"; then fail "submitted twice at a time"; fi
grep -q "still in the queue" "$scratch/twice.txt" || fail "no reason told: $(cat "$scratch/twice.txt")"
ok "while it runs, a second submission is refused"

midway hit_none --nodes=node2
killed=$shard
kill_program
say "program of shard $killed killed at $had of $PER_SHARD points"

midway hit_none --nodes=node1
lost=$shard
node_lost node1
say "node1 lost, with shard $lost at $(points_of "$lost") of $PER_SHARD points"

midway hit_none --nodes=node2
warned=$shard
# As --signal does before the time limit. scancel repeats itself, as the shard is soon back in the queue; once is enough.
timeout 3 scancel --batch --signal=USR1 "$(job_says "${array}_$warned" JobId)" 2>/dev/null &
say "shard $warned warned of its time limit at $had of $PER_SHARD points"

midway hit_none --nodes=node2
cancelled=$shard
scancel "${array}_$cancelled"
say "shard $cancelled cancelled at $had of $PER_SHARD points"

wait_until 60 "node1 seen as down" node_is node1 down
say "node1 is seen as down; it comes back"
node_up node1

wait_until 120 "the queue empty" ended
went_on "$killed" "$(log_of "$killed")"
went_on "$lost" "$(log_of "$lost")"
[ "$(job_says "${array}_$lost" Restarts)" -ge 1 ] || fail "Slurm did not start shard $lost again"
ok "Slurm put the shard of the lost node back into the queue"
went_on "$warned" "$(log_of "$warned")"
grep -q "scontrol requeue" "$(log_of "$warned")" || fail "shard $warned did not put itself back into the queue"
ok "the warned shard put itself back into the queue"
[ "$("$here/../undone.sh" "$SHARDS" "$out")" = "$cancelled" ] || fail "undone is not shard $cancelled alone"
[ "$(job_says "$merge" JobState)" = FAILED ] || fail "the merge is $(job_says "$merge" JobState), with a shard missing"
grep -q "not complete: $cancelled\$" "$out/log/merge.txt" || fail "the merge does not name shard $cancelled"
[ ! -e "$out/table.csv" ] || fail "a table was written with a shard missing"
ok "the merge refused, and named shard $cancelled"

submitted=$(submit)
grep -q "shards $cancelled of" <<<"$submitted" || fail "submitted again: $submitted"
say "again: $(head -n 1 <<<"$submitted")"
wait_until 60 "the queue empty" ended
went_on "$cancelled" "$(log_of "$cancelled")"
same_table
ok "Slurm: all held, $SECONDS s"
