#!/usr/bin/env bash
# Shards of a sweep that are not complete, one number per line.
#   undone.sh N OUT
set -euo pipefail

for ((shard = 1; shard <= $1; shard++)); do
    [ -f "$2/shard_${shard}_of_$1/done" ] || echo "$shard"
done
