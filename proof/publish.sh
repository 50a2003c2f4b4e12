#!/usr/bin/env bash
# Puts what `smam proof --out OUT` has made so far into this folder: proof/publish.sh OUT
#
# The other way round, a run is continued from here on any machine, without the recordings of the cases that are done:
#   mkdir -p OUT/cases && cp proof/seals.txt OUT/cases/ && cp proof/rows.jsonl OUT/
#   smam proof --cases N --nothing N --seed 2029 --out OUT
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [ $# -ne 1 ] || [ ! -s "$1/rows.jsonl" ]; then
    echo "usage: proof/publish.sh OUT, the folder of a run of smam proof" >&2
    exit 2
fi
out=${1%/}

open=$(mktemp -d)
trap 'rm -rf "$open"' EXIT
mkdir -p "$open/sealed" "$open/answers"
# Cases of an earlier part are here already.
for archive in "$here"/seed*.zip; do
    [ ! -s "$archive" ] || python3 -m zipfile -e "$archive" "$open"
done
cp "$out/cases/seals.txt" "$out/rows.jsonl" "$here/"
for file in score.json table.md proof.svg ceiling.jsonl settling.jsonl; do
    if [ -s "$out/$file" ]; then cp "$out/$file" "$here/"; fi
done
sed 's/^{"name":"\([^"]*\)".*/\1/' "$out/rows.jsonl" | while read -r name; do
    if [ -s "$out/cases/sealed/$name.json" ]; then cp "$out/cases/sealed/$name.json" "$open/sealed/"; fi
    if [ -s "$out/answers/$name/diagnosis.json" ]; then
        # Where it was run is nobody's business.
        sed "s#\"$out/cases/#\"cases/#" "$out/answers/$name/diagnosis.json" >"$open/answers/$name.json"
    fi
    [ -s "$open/sealed/$name.json" ] || { echo "$name: its sealed answer is neither here nor in $out" >&2; exit 1; }
done
# What a run with another seed has left here.
for file in "$open"/sealed/*.json "$open"/answers/*.json; do
    grep -q "^{\"name\":\"$(basename "$file" .json)\"" "$here/rows.jsonl" || rm "$file"
done
seed=$(sed -n '1s/^{"name":"s\([0-9]*\)_.*/\1/p' "$here/rows.jsonl")
rm -f "$here"/seed*.zip
python3 "$here/../fuzz/pack.py" "$here/seed$seed.zip" "$open/answers" "$open/sealed"
echo "$(wc -l <"$here/rows.jsonl") cases"
