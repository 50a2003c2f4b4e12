"""A toy answer to the benchmark (docs/benchmark.md): errors of sensors alone, by linear regression.

    python examples/python/benchmark_toy.py BENCHMARK ANSWERS
    python proof/benchmark/score.py BENCHMARK ANSWERS

It knows three things that can be wrong with a sensor: a gain, a drift, a lag. Each output's residual against the
calibrated scene is regressed on each of them; the one that explains most is named. What is missing in the rig itself it
cannot find. Put your method in the place of `fit`.
"""

import json
import sys
from pathlib import Path

import numpy as np
import pandas as pd

EFFECTS = ["sensor_gain", "sensor_drift", "sensor_lag"]
LEAST_SHARE = 0.25  # of the residual's variance that an effect must explain


def signatures(simulated, time_s):
    """What a gain, a drift and a lag of a sensor add to what it shows, a column each."""
    return np.column_stack([simulated, time_s, np.gradient(simulated, time_s)])


def fit(runs, column):
    """Least squares over all runs, one effect at a time: its size, and the share of the residual that it explains."""
    left = [run[column] - run[f"{column}_calibrated"] for run in runs]
    residual = np.concatenate([part - part.mean() for part in left])
    parts = [signatures(run[f"{column}_calibrated"], run["time_s"]) for run in runs]
    matrix = np.concatenate([part - part.mean(axis=0) for part in parts])
    there = np.isfinite(residual)
    residual, matrix = residual[there], matrix[there]
    sizes = matrix.T @ residual / (matrix**2).sum(axis=0)
    return sizes, sizes**2 * (matrix**2).sum(axis=0) / (residual**2).sum()


def read(case):
    """The case's recordings, each beside the calibrated scene's simulation of it."""
    for path in sorted(case.glob("*.csv")):
        simulated = pd.read_csv(case / "calibrated" / path.name).add_suffix("_calibrated")
        yield pd.concat([pd.read_csv(path), simulated], axis=1).interpolate(limit_area="inside")


def answer(case, out):
    runs = list(read(case))
    predicted = pd.read_csv(case / "next" / "calibrated.csv")
    causes = []
    for column in predicted.columns.drop("time_s"):
        if column not in runs[0]:
            continue  # not recorded in this case
        sizes, shares = fit(runs, column)
        best = int(shares.argmax())
        if shares[best] > LEAST_SHARE:
            causes.append({"element": column, "effect": EFFECTS[best], "probability": float(min(shares[best], 0.9))})
            predicted[column] += signatures(predicted[column], predicted["time_s"])[:, best] * sizes[best]
    words = {"format": 1, "case": case.name, "causes": causes}
    (out / f"{case.name}.json").write_text(json.dumps(words, indent=2))
    predicted.to_csv(out / f"{case.name}.csv", index=False)


if __name__ == "__main__":
    benchmark, out = Path(sys.argv[1]), Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    for case in sorted((benchmark / "cases").iterdir()):
        answer(case, out)
