#!/usr/bin/env bash
# Writes two cases of the bench, answers them with the toy, holds the answers against the schema and scores them.
#     check.sh EXAMPLE PYTHON [PEER]
# EXAMPLE: the built example `benchmark`; PYTHON: one with numpy and pandas; PEER: one with jsonschema, may be left out.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$(dirname "$(dirname "$here")")
example=$1 python=$2 peer=${3:-}

out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$example" "$out" case_20261201 case_20261202
"$python" -B "$top/examples/python/benchmark_toy.py" "$out" "$out/answers"
if [ -n "$peer" ]; then
    "$peer" -B - "$here/answer.schema.json" "$out"/answers/*.json <<'P'
import json, sys
import jsonschema
schema, *answers = [json.load(open(name)) for name in sys.argv[1:]]
for answer in answers:
    jsonschema.validate(answer, schema)
print(f"ok    {len(answers)} answers keep to the schema")
P
fi
rows=$(python3 -B "$here/score.py" "$out" "$out/answers")
echo "$rows"
# One hides nothing, the other a sensor's lag, which the toy knows.
grep -q 'detected 1 of 1, false alarms 0 of 1; of 1 causes the element 1, named first 1' <<<"$rows" || { echo "the toy failed" >&2; exit 1; }
grep -q 'worse than calibrated 0$' <<<"$rows" || { echo "it predicts worse than the calibrated scene" >&2; exit 1; }
