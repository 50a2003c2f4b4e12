#!/usr/bin/env bash
# Puts the shards of a sweep together in OUT, once all are complete: a table that lacks points must not look like one.
#   merge.sh N OUT SMAM SWEEP.toml
set -euo pipefail

of=$1 out=$2 smam=$3 sweep=$4
undone=$("$(dirname "${BASH_SOURCE[0]}")/undone.sh" "$of" "$out")
if [ -n "$undone" ]; then
    echo "not merged: of $of shards these are not complete:" "$(paste -sd" " <<<"$undone")" >&2
    echo "  remedy: see $out/log, then submit again with the same arguments; what is done is kept" >&2
    exit 1
fi
folders=()
for ((shard = 1; shard <= of; shard++)); do folders+=("$out/shard_${shard}_of_$of"); done
exec "$smam" sweep merge "$sweep" "${folders[@]}" --out "$out"
