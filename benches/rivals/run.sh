#!/usr/bin/env bash
# Makes an environment of its own under target/ and runs the rivals in it: ./benches/rivals/run.sh CASES_DIR --diagnoses DIR ...
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
target=${CARGO_TARGET_DIR:-$root/target}
venv=$target/rivals

if ! cmp -s "$here/requirements.txt" "$venv/requirements.txt"; then
    rm -rf "$venv"
    python3 -m venv "$venv"
    "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --requirement "$here/requirements.txt"
    cp "$here/requirements.txt" "$venv/requirements.txt"
fi
if [ -x "$target/release/smam" ]; then
    PATH="$target/release:$PATH"
fi
exec "$venv/bin/python" "$here/rivals.py" "$@"
