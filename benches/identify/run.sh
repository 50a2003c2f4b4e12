#!/usr/bin/env bash
# Identification beside the same swarm in PySwarms and NumPy, on one core: ./benches/identify/run.sh [REPETITIONS]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
target=${CARGO_TARGET_DIR:-$root/target}
venv=$target/identify-rival

if ! cmp -s "$here/requirements.txt" "$venv/requirements.txt"; then
    rm -rf "$venv"
    python3 -m venv "$venv"
    "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --requirement "$here/requirements.txt"
    cp "$here/requirements.txt" "$venv/requirements.txt"
fi
(cd "$root" && cargo build --release --no-default-features --quiet)
cd "$root"
export SMAM=$target/release/smam OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 RAYON_NUM_THREADS=1
exec "$venv/bin/python" "$here/rival.py" "$@"
