#!/bin/sh
# Whether the worked example of docs/extending.md still fits the code.
#
#   docs/examples/check.sh            the patch applies (a second)
#   docs/examples/check.sh compile    and compiles, and its own test passes: in a copy of the tree, with this target folder
set -eu
cd "$(dirname "$0")/../.."
patch="$PWD/docs/examples/add_an_effect.patch"
git apply --check "$patch"
[ "${1:-}" = compile ] || exit 0

copy="$(mktemp -d)"
trap 'git worktree remove --force "$copy"' EXIT
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$PWD/target}"
git worktree add --quiet --detach "$copy" HEAD
git -C "$copy" apply "$patch"
cd "$copy"
cargo test --no-default-features --lib effects
