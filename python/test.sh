#!/usr/bin/env bash
# Builds the wheel, installs it with what it needs into a new Python environment, and runs python/tests on it from an empty folder.
# Arguments go to `maturin build`: --no-default-features for a wheel without the viewer. After `cargo build --release` with the same
# features nothing is compiled again. Exit codes: 0 all held, 1 something did not, 77 no python3 venv or no network.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
top=$(dirname "$here")
target=$(realpath -m "${CARGO_TARGET_DIR:-$top/target}")
export CARGO_TARGET_DIR=$target
maturin_version=1.16.0 # within the range of pyproject.toml
pytest_version=9.2.0
mypy_version=2.4.1
pandas_stubs_version=3.1.0.261029

ok() { printf 'ok    %s\n' "$*"; }
fail() { printf 'FAIL  %s\n' "$*" >&2; exit 1; }
skip() { printf 'skipped: %s\n' "$*" >&2; exit 77; }
limited() { timeout --kill-after=30 "$@" || fail "$* (exit code $?)"; }

command -v python3 >/dev/null || skip "python3 is not installed"
python3 -c 'import sys; sys.exit(sys.version_info < (3, 10))' || skip "Python 3.10 or newer is needed"

# What the tests need and the wheel does not bring. Kept; without it, with the network gone, nothing can be tested.
venv=$target/python-maturin-$maturin_version-pytest-$pytest_version-mypy-$mypy_version
python=$venv/bin/python
tools=("maturin==$maturin_version" "pytest==$pytest_version" matplotlib)
types=("mypy==$mypy_version" "pandas-stubs==$pandas_stubs_version")
if [ ! -e "$venv/complete" ]; then
    rm -rf "$venv"
    { python3 -m venv "$venv" && "$python" -m pip install --quiet --disable-pip-version-check "${tools[@]}"; } ||
        { rm -rf "$venv"; skip "maturin and pytest could not be installed (no python3 venv, or no network)"; }
    # Type hints are checked where these versions exist for the Python here.
    "$python" -m pip install --quiet --disable-pip-version-check "${types[@]}" || true
    touch "$venv/complete"
fi

# One wheel only: pip is to install this one.
wheels=$target/wheels
rm -f "$wheels"/smam-*.whl
(cd "$top" && "$venv/bin/maturin" build --release --quiet --out "$wheels" "$@") || fail "the wheel could not be built"
wheel=$(echo "$wheels"/smam-*.whl)
[ -s "$wheel" ] || fail "there is no wheel in $wheels"
ok "$(basename "$wheel"), $(($(stat -c %s "$wheel") / 1000000)) MB"

# Only what its metadata ask for is installed beside it.
"$python" -m pip uninstall --quiet --yes smam
"$python" -m pip install --quiet --disable-pip-version-check "$wheel" || fail "pip could not install $wheel"

# Nothing of the source tree, and no other program, may be in reach.
unset SMAM PYTHONPATH
empty=$(mktemp -d "${TMPDIR:-/tmp}/smam_python.XXXXXX")
trap 'rm -rf "$empty"' EXIT
cd "$empty"
place=$("$python" -c 'import smam; print(smam.__file__)')
[[ $place == "$venv"/* ]] || fail "the module is imported from $place"
program=$("$python" -c 'from smam._program import find_program; print(find_program())')
[ "$program" = "$venv/bin/smam" ] || fail "the program taken is $program"
ok "$("$program" --version), found beside the module"

if [ -x "$venv/bin/mypy" ]; then
    "$venv/bin/mypy" --strict --no-error-summary --cache-dir="$empty/mypy" -p smam || fail "type hints"
    ok "type hints"
else
    echo "skipped: type hints (mypy $mypy_version could not be installed)"
fi
SMAM_EXAMPLES=$top/examples/python limited 600 "$python" -m pytest -q -p no:cacheprovider --durations=3 --basetemp="$empty/tests" "$here/tests"
