#!/usr/bin/env bash
# Stands before rustc (RUSTC_WRAPPER): the crates that read files are compiled so that libFuzzer sees which branches an input
# takes. The physics engine and the other libraries are left as they are: they would only slow it down.
set -euo pipefail

rustc=$1
shift
crate=
for ((i = 1; i <= $#; i++)); do
    if [ "${!i}" = --crate-name ]; then
        next=$((i + 1))
        crate=${!next}
    fi
done

coverage=()
case $crate in
smam | csv | csv_core | toml | toml_parser | toml_datetime | serde_path_to_error | mcap | lz4_flex | ruzstd | urdf_rs | \
    serde_xml_rs | xml | quick_xml | tobj | parquet | snap | calamine)
    coverage=(-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4
        -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table
        -Cllvm-args=-sanitizer-coverage-trace-compares)
    ;;
esac
exec "$rustc" "$@" "${coverage[@]}"
