#!/bin/sh
# Makes docs/images/effects/*.svg again, one for each law of the catalogue.
#
#   docs/make_effect_pictures.sh SMAM        SMAM: the program, for instance target/release/smam
set -eu
[ $# -eq 1 ] || { echo "usage: $0 SMAM (the program, for instance target/release/smam)" >&2; exit 2; }
out="$(dirname "$0")/images/effects"
mkdir -p "$out"
# The list: name, element, title; after an empty line a hint.
"$1" effects | awk '/^$/ { exit } { print $1 }' | sort -u | while read -r name; do
  "$1" effects "$name" --out "$out" > /dev/null
done
