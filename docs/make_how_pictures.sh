#!/bin/sh
# Makes the figures of docs/how-it-works.md again, in docs/images/how/.
#
#   docs/make_how_pictures.sh SMAM        SMAM: the program, for instance target/release/smam
set -eu
[ $# -eq 1 ] || { echo "usage: $0 SMAM (the program, for instance target/release/smam)" >&2; exit 2; }
smam="$1"
out="$(dirname "$0")/images/how"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"

"$smam" reproduce 4b --out "$work/blocked"
cp "$work/blocked/4b.svg" "$out/blocked.svg"

width='width_mm=loop_width(plunger_mm, elongation_mm)'
range='range_mm=range(elongation_mm)'
"$smam" sweep muscle_bench --vary hydraulics.upstream_compliance_m3_pa=2e-15:16e-15:8 --measure "$width" \
  --measure "$range" --duration 10 --out "$work/compliance"
"$smam" sweep muscle_bench --vary muscles.friction.m1_n_pa=0:4e-7:9 --measure "$width" \
  --measure 'lost_mj=1000 * loss(muscle)' --duration 10 --out "$work/friction"
"$smam" sweep muscle_bench --vary input.0.program.frequency_hz=0.1,0.5,1,1.5,2,2.5,3 \
  --vary hydraulics.line.bore_m=0.3e-3,0.4e-3,0.8e-3 --measure "$range" --measure 'peak_kpa=max(pressure_kpa)' \
  --duration 10 --out "$work/frequency"
"$smam" sweep bending_catheter --vary mechanism.joint.0.stiffness_n_m_rad=2e-3:20e-3:10 \
  --measure 'bend_deg=max(bend_deg)' --measure 'least_pressure_kpa=min(pressure_1_kpa)' --duration 19 --out "$work/tube"
for name in compliance friction frequency tube; do
  cp "$work/$name/sweep.svg" "$out/$name.svg"
done
