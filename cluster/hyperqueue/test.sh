#!/usr/bin/env bash
# shellcheck disable=SC1091,SC2154 # names of testing.sh and engine.sh
# Runs a sweep on a HyperQueue server with two workers on this machine, and kills: the program, a worker, then server and workers all.
# Starts them anew, submits what is missing, and compares the merged table with that of one run. SMAM: the program. HYPERQUEUE_VENV: where
# the package is, or is to be installed. Exit code 77: it cannot be.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
target=${CARGO_TARGET_DIR:-$here/../../target}
version=0.27.0
. "$here/../testing.sh"
needs "apt-get install python3-venv procps" python3 pgrep
smam=$(realpath "${SMAM:-$target/release/smam}")
[ -x "$smam" ] || fail "$smam is no program: cargo build --release, or SMAM=..."

venv=${HYPERQUEUE_VENV:-$target/hyperqueue-$version}
python=$venv/bin/python
if ! "$python" -c 'import hyperqueue' 2>/dev/null; then
    { python3 -m venv "$venv" && "$python" -m pip install --quiet --disable-pip-version-check "hyperqueue==$version"; } ||
        { rm -rf "$venv"; skip "hyperqueue $version could not be installed (no python3 venv, or no network)"; }
fi
limited 300 "$here/test.sh"

server='' workers=()
# One process of the engine, ready; its id in `started`.
start() { # NAME ARGUMENTS...
    local log=$scratch/log/$1.txt
    shift
    "$python" "$here/engine.py" "$@" >"$log" 2>&1 &
    started=$!
    wait_until 30 "$* ready" grep -qx ready "$log"
}
engine_up() { # RUN
    start "server$1" server "$scratch/server$1" && server=$started
    for i in 0 1; do
        start "worker$1.$i" worker "$scratch/server$1" "$scratch/worker$1.$i" && workers[i]=$started
    done
}
engine_down() {
    for id in $server "${workers[@]}"; do
        kill -KILL "$id" 2>/dev/null || true
        wait "$id" 2>/dev/null || true # says nothing of the kill
    done
    server='' workers=()
}
submit() { # RUN
    "$python" "$here/submit.py" "$sweep" --shards "$SHARDS" --out "$out" --smam "$smam" --server-dir "$scratch/server$1" --wait 2>&1 |
        tr '\r' '\n' | sed '/task\/s/d'
}
# Shards whose program runs under a worker.
running_on() { # WORKER
    local task
    for task in $(pgrep -P "$1"); do
        { tr '\0' '\n' <"/proc/$task/cmdline"; } 2>/dev/null | grep -A1 -x '.*/shard.sh' | tail -n 1
    done
}
hit_none() { running_on "$1" | grep -vxE "${killed:-no}|${lost:-no}" || true; }
log_of() { echo "$out/log/shard_$1.txt"; }
begun_again() { [ "$(grep -c 'of them to do' "$(log_of "$1")")" -ge 2 ]; }

scratch
mkdir "$scratch/log"
reference
engine_up 1
ok "HyperQueue $version: a server, ${#workers[@]} workers of one core"
submit 1 >"$scratch/log/submit1.txt" &
waiting=$!

killed='' lost=''
midway hit_none "${workers[0]}"
killed=$shard
kill_program
say "program of shard $killed killed at $had of $PER_SHARD points"

midway hit_none "${workers[1]}"
lost=$shard
orphan=$(program_of "$lost")
kill -KILL "${workers[1]}"
wait "${workers[1]}" 2>/dev/null || true
say "worker lost, with shard $lost at $had of $PER_SHARD points; its program $(kill -0 "$orphan" 2>/dev/null && echo "runs on alone" || echo "went with it")"

wait_until 60 "shard $lost begun again by HyperQueue" begun_again "$lost"
ok "HyperQueue began the shard of the lost worker again"

midway hit_none "${workers[0]}"
engine_down
say "server and workers lost, with shard $shard at $had of $PER_SHARD points"
wait "$waiting" && fail "submit.py --wait ended well although the server was lost"
ok "submit.py --wait ends with an error"
[ ! -e "$out/table.csv" ] || fail "a table was written with shards missing"
# Programs whose engine is gone run to the end of their shard, or not: neither may change the table.
cut=$shard
missing=$("$here/../undone.sh" "$SHARDS" "$out" | wc -l)

engine_up 2
submit 2 >"$scratch/log/submit2.txt" || fail "submitted again: $(cat "$scratch/log/submit2.txt")"
grep -q "$missing of $SHARDS shards" "$scratch/log/submit2.txt" || fail "not $missing shards: $(cat "$scratch/log/submit2.txt")"
say "again: $(head -n 1 "$scratch/log/submit2.txt")"
for shard in "$killed" "$lost" "$cut"; do went_on "$shard" "$(log_of "$shard")"; done
same_table
ok "HyperQueue: all held, $SECONDS s"
