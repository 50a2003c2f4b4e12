#!/usr/bin/env bash
# Everything that must hold before a change goes in; CI runs the same. From anywhere: ./check.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

target=${CARGO_TARGET_DIR:-target}
smam=$target/release/smam
rerun_version=0.36.3 # that of Cargo.toml: the file format changes between minor releases

say() { printf '\n== %s (after %d s)\n' "$*" "$SECONDS"; }

# where_it_can VARIABLE COMMAND...: runs a check whose exit code 77 says that something it needs is not here. That is no failure
# at a desk; where it must be here (in CI, which sets VARIABLE), it is.
where_it_can() {
    local must=$1 status=0
    shift
    "$@" || status=$?
    if [ "$status" -eq 77 ] && [ -z "${!must:-}" ]; then return; fi
    [ "$status" -eq 0 ] || { echo "$* failed (exit code $status)" >&2; exit 1; }
}

# venv FOLDER PACKAGE...: a Python environment, unless it is there. None where there is no python3 venv, or no network.
venv() {
    local folder=$1
    shift
    if [ -e "$folder/complete" ]; then return; fi
    rm -rf "$folder"
    if python3 -m venv "$folder" && "$folder/bin/python" -m pip install --quiet --disable-pip-version-check "$@"; then
        touch "$folder/complete"
    else
        rm -rf "$folder"
    fi
}

# Programs and libraries of others to hold this one against. They come from PyPI while Rust works.
tools=$target/book-tools
peers=$target/peers
viewer=$target/rerun-$rerun_version
browser=$target/browser
mkdir -p "$target"
{
    venv "$tools" --require-hashes -r docs/requirements.txt
    venv "$peers" mcap==1.6.0 mcap-ros2-support==0.6.0 jsonschema==4.26.0
    venv "$viewer" "rerun-sdk==$rerun_version" pillow
    venv "$browser" playwright==1.65.2
} &
environments=$!

say "format"
cargo fmt --check

say "lints"
if command -v shellcheck >/dev/null; then
    shellcheck check.sh .ci/run cluster/*.sh cluster/*/*.sh python/*.sh docs/*.sh docs/examples/*.sh proof/*.sh proof/benchmark/*.sh fuzz/*.sh
else
    echo "skipped: shellcheck is not installed"
fi
# In the profile of the tests: what generates code is built once.
cargo clippy --release --no-default-features --features validation --all-targets -- -D warnings
# What others embed, alone.
cargo clippy --release --no-default-features -- -D warnings
RUSTDOCFLAGS=-Dwarnings cargo doc --release --no-deps --no-default-features --features validation

say "what it is built from: licences, sources, pins, no unsafe code"
python3 -B tests/dependencies/check.py

wait "$environments"

say "the book's links, data and spelling"
# Its commands are run at the end, when there is a program.
if [ -x "$tools/bin/typos" ]; then
    python3 -B docs/check_docs.py --typos "$tools/bin/typos"
else
    echo "later: mdbook and typos could not be installed (no python3 venv, or no network)"
fi

say "libraries of others, to hold bags and schemas against"
if [ -x "$peers/bin/python" ]; then
    SMAM_PEER_PYTHON=$(realpath "$peers/bin")/python
    export SMAM_PEER_PYTHON
    echo "ok    $SMAM_PEER_PYTHON"
else
    echo "skipped: they could not be installed (no python3 venv, or no network); bags and schemas are tested without them"
fi

# What is tested is what is shipped: one build, with checks of overflow. All tests are run, so that one look shows all that fails.
say "tests: library, contracts, documentation"
cargo test --release --no-fail-fast
cargo build --release

say "stock scenes against their expectations"
# Names as the program lists them: one per line, up to the empty line.
scenes=$("$smam" scenes | awk 'NF == 0 { exit } { print $1 }')
[ -n "$scenes" ] || { echo "no stock scenes listed" >&2; exit 1; }
failed=()
for scene in $scenes; do
    if output=$("$smam" run "$scene" --check 2>&1); then
        echo "ok    $scene: $(tail -n 1 <<<"$output" | sed "s/^$scene: //")"
    else
        printf 'FAIL  %s\n%s\n' "$scene" "$output"
        failed+=("$scene")
    fi
done
if [ "${#failed[@]}" -gt 0 ]; then
    echo "scenes that failed: ${failed[*]}" >&2
    exit 1
fi

say "the run of the proof that is kept: seals and figures"
proof/open.sh "$(mktemp -d)" "$smam"

say "sweeps on Slurm and HyperQueue, killed on the way"
for test in cluster/slurm/test.sh cluster/hyperqueue/test.sh; do
    where_it_can SMAM_REQUIRE_CLUSTER env "SMAM=$smam" "$test"
done

say "kills, full disks, pipes, two at once: nothing lost"
where_it_can SMAM_REQUIRE_FAULTS python3 tests/faults/check.py --smam "$smam"

say "what it opens: a server on loopback, nothing else"
python3 -B tests/dependencies/check.py --smam "$smam"

say "the README's first command"
rm -f out/bending_catheter.csv out/bending_catheter.rrd
cargo run --release -- run scenes/bending_catheter.toml
for file in out/bending_catheter.csv out/bending_catheter.rrd; do
    [ -s "$file" ] || { echo "$file was not written" >&2; exit 1; }
    echo "ok    $file"
done

say "what it wrote, read by the viewer's own program"
if [ -x "$viewer/bin/rerun" ]; then
    "$viewer/bin/rerun" rrd verify out/bending_catheter.rrd
    echo "ok    rerun $rerun_version reads it"
    say "and as a picture"
    "$viewer/bin/python" tests/viewer/check.py --rrd out/bending_catheter.rrd --csv out/bending_catheter.csv ${SMAM_REQUIRE_PICTURE:+--require-picture}
elif [ -n "${SMAM_REQUIRE_PICTURE:-}" ]; then
    echo "rerun-sdk $rerun_version could not be installed" >&2
    exit 1
else
    echo "skipped: rerun-sdk $rerun_version could not be installed (no python3 venv, or no network)"
fi

say "the HTML pages, explored in a browser"
if [ -x "$browser/bin/python" ]; then
    where_it_can SMAM_REQUIRE_BROWSER "$browser/bin/python" -B tests/pages/check.py --smam "$smam"
elif [ -n "${SMAM_REQUIRE_BROWSER:-}" ]; then
    echo "playwright could not be installed" >&2
    exit 1
else
    echo "skipped: playwright could not be installed (no python3 venv, or no network)"
fi

say "the Python wheel"
where_it_can SMAM_REQUIRE_PYTHON python/test.sh

say "the benchmark for other tools: written, answered by a toy, scored"
python3 -B -m unittest discover proof/benchmark
pandas=$(find "$target" -maxdepth 3 -path "$target/python-maturin-*/bin/python" | head -n 1)
if [ -n "$pandas" ]; then
    proof/benchmark/check.sh "$target/release/examples/benchmark" "$pandas" "${SMAM_PEER_PYTHON:-}"
else
    echo "skipped: the toy needs pandas, which comes with the wheel's tests"
fi

say "other people's URDFs"
where_it_can SMAM_REQUIRE_URDFS python3 tests/public_urdfs/check.py --smam "$smam"

say "the book: its commands, and as a whole"
docs/examples/check.sh
if [ -x "$tools/bin/mdbook" ]; then
    TYPOS=$tools/bin/typos python3 -B -m unittest discover docs
    python3 -B docs/check_docs.py --smam "$smam"
    "$tools/bin/mdbook" build docs
elif [ -n "${SMAM_REQUIRE_BOOK:-}" ]; then
    echo "mdbook and typos could not be installed" >&2
    exit 1
else
    echo "skipped: mdbook and typos could not be installed (no python3 venv, or no network)"
fi

say "all is well"
