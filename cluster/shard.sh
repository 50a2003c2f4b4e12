#!/usr/bin/env bash
# One shard of a sweep, wherever an engine puts it.
#   shard.sh I N OUT COMMAND...     COMMAND: smam sweep SWEEP.toml, with what else it needs (--threads)
# Goes on where the shard stands, begins again when the program was killed, and marks a shard that is complete. Of that the journal stays;
# tables and pages are those of the merge, which reads journals alone.
# Asked to stop (TERM, INT, USR1), the points that run are finished and the exit code is 75: start it again later.
# After USR1, an engine's warning of the time limit, SMAM_AGAIN is run: the command that has the engine do so.
set -euo pipefail

shard=$1 of=$2 out=$3
shift 3
folder=$out/shard_${shard}_of_${of}
journal=$folder/journal.jsonl
program='' stopped='' again='' trapped=''

say() { echo "shard $shard/$of: $*" >&2; }
lines() { if [ -f "$journal" ]; then wc -l <"$journal"; else echo 0; fi; }
# shellcheck disable=SC2317 # called by the traps
stop() {
    stopped=yes trapped=yes
    [ -z "$program" ] || kill -TERM "$program" 2>/dev/null || true
}
trap stop TERM INT
trap 'again=${SMAM_AGAIN:-}; stop' USR1

# Runs the command to its end and leaves its exit code in `status`. A trapped signal ends `wait` early, so it is called again;
# 127 then means that the first call had seen the end.
attempt() {
    local code
    "$@" --shard "$shard/$of" --out "$folder" --resume &
    program=$! trapped='' status=0
    wait "$program" || status=$?
    while [ -n "$trapped" ]; do
        trapped='' code=0
        wait "$program" || code=$?
        [ "$code" -eq 127 ] || status=$code
    done
    program=
}

while [ -z "$stopped" ]; do
    before=$(lines)
    attempt "$@"
    if [ "$status" -eq 0 ]; then
        touch "$folder/done"
        rm -f "$folder"/{table,best,sensitivity}.csv "$folder"/table.parquet "$folder"/sensitivity.json \
            "$folder"/sweep.{html,svg} "$folder"/front.svg
        exit 0
    fi
    # Another attempt must have gained a point, or one that always dies, or outlasts the time limit, would be tried for ever.
    [ "$(lines)" -gt "$before" ] || { say "exit code $status, and no point gained"; exit "$status"; }
    [ -z "$stopped" ] || break
    [ "$status" -gt 128 ] || exit "$status"
    say "killed (exit code $status), going on"
done
say "stopped before its end${again:+: $again}"
$again
exit 75
