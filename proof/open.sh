#!/usr/bin/env bash
# Opens the run that is kept here and scores it again: proof/open.sh OUT [PROGRAM]
#
# Unpacks sealed and given answers into OUT, holds every sealed answer against its seal, and computes the figures from the rows once
# more: they must come out byte for byte.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [ $# -lt 1 ]; then
    echo "usage: proof/open.sh OUT [PROGRAM, else smam]" >&2
    exit 2
fi
out=$1 smam=${2:-smam}

mkdir -p "$out"
python3 -m zipfile -e "$here"/seed*.zip "$out"
while read -r name seal; do
    echo "$seal  $out/sealed/$name.json"
done <"$here/seals.txt" | sha256sum --check --quiet
"$smam" score --rows "$here/rows.jsonl" --out "$out/score" >/dev/null
cmp "$out/score/score.json" "$here/score.json"
echo "$(wc -l <"$here/seals.txt") seals hold, the figures are those of proof/score.json; sealed and given answers: $out"
