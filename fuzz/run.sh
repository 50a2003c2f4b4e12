#!/usr/bin/env bash
# Feeds a reader inputs made by libFuzzer: fuzz/run.sh TARGET RUNS [OPTION OF LIBFUZZER...]
# Needs what the program needs and a C++ compiler; neither a nightly Rust nor cargo-fuzz. An input that panics, takes more than
# 5 s or more than 1 GiB ends the run and is kept as fuzz/artifacts/TARGET/KIND-HASH. To see it fail again:
#   fuzz/run.sh TARGET 1 "$PWD"/fuzz/artifacts/TARGET/KIND-HASH
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

if [ $# -lt 2 ] || [ ! -e "fuzz_targets/$1.rs" ]; then
    echo "usage: fuzz/run.sh TARGET RUNS [OPTION...]; targets:" fuzz_targets/*.rs >&2
    exit 2
fi
target=$1 runs=$2
shift 2

case $target in
scene_*) length=8192 dictionary=scene ;;
bag | parquet | workbook) length=4096 dictionary=$target ;;
*) length=2048 dictionary=$target ;;
esac
options=(-runs="$runs" -max_len="$length" -rss_limit_mb=1024 -timeout=5 -artifact_prefix="artifacts/$target/"
    -dict="dictionaries/$dictionary.dict" -print_final_stats=1)

RUSTC_WRAPPER=$PWD/instrument.sh cargo build --release --quiet --bin "$target"
mkdir -p "artifacts/$target" "work/$target"
# What is found goes into the first folder; the second is the committed corpus. To keep more of it: copy it there, then
#   python3 pack.py corpus.zip work/corpus
if [ corpus.zip -nt work/corpus ]; then
    rm -rf work/corpus
    python3 -m zipfile -e corpus.zip work
    touch work/corpus
fi
folders=("work/$target" "work/corpus/$target")
for option in "$@"; do
    [ ! -e "$option" ] || folders=()
done
exec "${CARGO_TARGET_DIR:-target}/release/$target" "${options[@]}" "$@" "${folders[@]}"
