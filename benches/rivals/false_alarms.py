#!/usr/bin/env python3
"""How often each rival calls noise missing physics: the calibrated scene's own output plus drawn noise, many times."""

import argparse
import copy
import importlib
import math
import os
import sys
from pathlib import Path

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")
sys.path.insert(0, str(Path(__file__).resolve().parent))

import numpy as np  # noqa: E402

from case import load_case  # noqa: E402
from noise import Noise  # noqa: E402

# Deviation of the draws where a case states none, in the channel's unit.
DEFAULT_SD = 0.02


def main():
    """Prints, by slow share and method, how many of the draws were called anything but adequate."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", type=Path)
    parser.add_argument("name", help="the case whose inputs and calibrated scene are used")
    parser.add_argument("--diagnoses", type=Path, required=True)
    parser.add_argument("--smam", default="smam")
    parser.add_argument("--methods", default="sindy,gp,narx,refit")
    parser.add_argument("--slow-shares", default="0,0.3,0.7", help="of the noise's variance")
    parser.add_argument("--correlation-s", type=float, default=0.05, help="time in which the slow part forgets")
    parser.add_argument("--draws", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    case = load_case(arguments.cases, arguments.name, arguments.diagnoses, arguments.smam)
    methods = arguments.methods.split(",")
    kept = math.exp(-case.runs[0].interval_s / arguments.correlation_s)
    for share in (float(s) for s in arguments.slow_shares.split(",")):
        alarms = dict.fromkeys(methods, 0)
        for draw in range(arguments.draws):
            null = null_case(case, share, kept, np.random.default_rng([arguments.seed, draw]))
            for method in methods:
                verdict = importlib.import_module(method).answer(null, arguments.seed).verdict
                alarms[method] += verdict != "adequate"
            print(f"slow share {share}, draw {draw + 1}: {alarms}", file=sys.stderr, flush=True)
        found = ", ".join(f"{m} {n}" for m, n in alarms.items())
        print(f"slow share {share}, {arguments.draws} draws: {found}", flush=True)


def null_case(case, slow_share, kept, random):
    """The case with its own simulation and drawn noise in place of what was measured."""
    null = copy.copy(case)
    null.runs = []
    for run in case.runs:
        other = copy.copy(run)
        other.measured = {}
        for column in case.outputs:
            noise = Noise(case.stated_sd[column] or DEFAULT_SD, slow_share, kept)
            other.measured[column] = run.simulated[column] + noise.draw(len(run.time_s), random)
        null.runs.append(other)
    return null


if __name__ == "__main__":
    main()
