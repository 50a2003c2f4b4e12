# shellcheck shell=bash disable=SC2154
# What the tests of the engines share; sourced by slurm/test.sh and hyperqueue/test.sh, which define `engine_down`.
# Exit codes: 0 all held, 1 something did not, 77 skipped.

readonly POINTS=120 SHARDS=6
readonly PER_SHARD=$((POINTS / SHARDS))

say() { printf '   %s\n' "$*"; }
ok() { printf 'ok    %s\n' "$*"; }
fail() { printf 'FAIL  %s\n' "$*" >&2; exit 1; }
skip() { printf 'skipped: %s\n' "$*" >&2; exit 77; }
needs() { # REMEDY PROGRAMS...
    local program
    for program in "${@:2}"; do
        command -v "$program" >/dev/null || skip "$program is not installed (Debian: $1)"
    done
}

# The test again under a time limit, which ends it as Ctrl-C would: it cleans up.
limited() { # SECONDS SCRIPT
    [ -n "${SMAM_TEST_LIMITED:-}" ] || exec env SMAM_TEST_LIMITED=1 timeout --kill-after=30 "$1" bash "$2"
}

# A scratch folder, gone at the end whatever happens, and all processes with it.
scratch() {
    scratch=$(mktemp -d "${TMPDIR:-/tmp}/smam_sweep.XXXXXX")
    trap 'clean $?' EXIT
    trap 'exit 1' INT TERM
}

clean() { # EXIT_CODE
    trap - EXIT
    trap '' INT TERM PIPE # whoever reads along may be gone: clean up all the same
    set +e
    engine_down
    [ "$1" -eq 0 ] || show_logs
    # Whatever still names the folder: programs that a kill has made orphans.
    pgrep -f -- "$scratch/" | while read -r id; do kill -KILL "$id" 2>/dev/null; done
    rm -rf "$scratch" || { sleep 2; rm -rf "$scratch"; }
    case $1 in 0 | 77) exit "$1" ;; *) exit 1 ;; esac
}

show_logs() {
    for log in "$out"/log/* "$scratch"/log/*; do
        [ ! -s "$log" ] || { echo "--- $log" && tail -n 15 "$log"; } >&2
    done
}

# The sweep, and its table as one machine makes it in one go.
reference() {
    sweep=$scratch/sweep.toml out=$scratch/out
    cat >"$sweep" <<END
format = 1
name = "cluster_test"
scene = "muscle_bench"
duration_s = 15.0

[sampling]
method = "sobol"
count = $POINTS
seed = 7

[[vary]]
key = "muscles.friction.m0_n"
from = 0.05
to = 0.3

[[vary]]
key = "tube_c1_pa"
from = 0.2e6
to = 0.3e6

[[measure]]
name = "range_mm"
of = "range(elongation_mm)"
END
    "$smam" sweep "$sweep" --out "$scratch/whole" 2>"$scratch/whole.txt" || fail "the reference sweep: $(cat "$scratch/whole.txt")"
    [ "$(wc -l <"$scratch/whole/table.csv")" -eq $((POINTS + 1)) ] || fail "the reference lacks points"
    ok "$POINTS points on one machine: the reference"
}

folder() { echo "$out/shard_$1_of_$SHARDS"; }

# Points that a shard's journal holds.
points_of() {
    local lines=0
    [ ! -f "$(folder "$1")/journal.jsonl" ] || lines=$(wc -l <"$(folder "$1")/journal.jsonl")
    echo $((lines > 0 ? lines - 1 : 0))
}

# Waits until one of the shards that COMMAND lists has begun and is far from its end: leaves it in `shard`, its points in `had`.
midway() { # COMMAND...
    local candidate
    for ((i = 0; i < 600; i++)); do
        for candidate in $("$@"); do
            had=$(points_of "$candidate")
            if [ "$had" -ge 3 ] && [ "$had" -le $((PER_SHARD * 3 / 5)) ]; then
                shard=$candidate
                return
            fi
        done
        sleep 0.05
    done
    fail "no shard was found midway ($*)"
}

wait_until() { # SECONDS WHAT COMMAND...
    local what=$2 end=$((SECONDS + $1))
    shift 2
    until "$@" 2>/dev/null; do
        [ "$SECONDS" -lt "$end" ] || fail "waited in vain: $what"
        sleep 0.2
    done
}

program_of() { pgrep -f -- "--shard $1/$SHARDS --out $(folder "$1") " || true; }

# kill -9 of the program alone, as the kernel does when memory is short.
kill_program() {
    local ids
    ids=$(program_of "$shard")
    [ -n "$ids" ] || fail "shard $shard has no program to kill"
    # shellcheck disable=SC2086 # one or more numbers
    kill -KILL $ids
}

# A shard that was killed went on: its attempts had ever fewer points to do.
went_on() { # SHARD LOG
    local to_do
    to_do=$(sed -n 's/.* points, \([0-9]*\) of them to do$/\1/p' "$2" | paste -sd' ')
    [ "$(wc -w <<<"$to_do")" -ge 2 ] || fail "shard $1 was begun once only ($to_do to do)"
    [ "$(tr ' ' '\n' <<<"$to_do" | sort -rnu | paste -sd' ')" = "$to_do" ] || fail "shard $1 did points again: $to_do to do"
    ok "shard $1 went on where it stood: $to_do points to do"
}

same_table() {
    for file in table.csv table.parquet; do
        cmp "$scratch/whole/$file" "$out/$file" || fail "$file differs from the reference"
    done
    ok "merged table.csv and table.parquet: the same bytes as the reference"
}
