"""The paper's model identified from one loop: by smam, by PySwarms' swarm over NumPy, and by SciPy's least squares. One core each.

The loop: `smam run muscle_printed_model` (30 s, 100 Hz, 3 mm), with 0.027 mm of white noise. The rival has the same
swarm (64 particles, 400 iterations, the same inertia and pulls), the same bounds and the same free parameters. Its model steps
all particles at once, one explicit Euler step per sample: the least that NumPy can do, and less exact than smam's.
`scipy.optimize.least_squares` (trust region, the same bounds) goes down from as many starts as `smam identify` does, drawn within the
bounds; the same step of the model gives residual and forward differences of all six parameters at once.
Times are CPU times: of the whole process for smam, of the search alone for the rivals (no imports, no reading).
"""

import csv
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from pyswarms.single import GlobalBestPSO
from scipy.optimize import least_squares

PARTICLES, ITERATIONS = 64, 400
STARTS = 3
FREE = ["alpha_x1", "alpha_x2", "alpha_z", "n", "nu", "rho"]


def make_loop(folder: Path) -> tuple[Path, np.ndarray, np.ndarray]:
    clean = folder / "clean.csv"
    subprocess.run([os.environ["SMAM"], "run", "muscle_printed_model", "--output", clean], check=True, capture_output=True)
    with open(clean, newline="") as file:
        rows = list(csv.DictReader(file))
    time_s, plunger, elongation = (
        np.array([float(row[name]) for row in rows]) for name in ("time_s", "plunger_mm", "elongation_mm")
    )
    elongation = elongation + 0.027 * np.random.default_rng(1).standard_normal(elongation.size)
    path = folder / "loop.csv"
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["time_s", "plunger_mm", "elongation_mm"])
        writer.writerows(zip(time_s.tolist(), plunger.tolist(), elongation.tolist()))
    return path, plunger, elongation


def smam(path: Path, folder: Path, *options: str) -> tuple[float, dict]:
    out = folder / "out"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        [os.environ["SMAM"], "identify", path, "--model", "paper", "--out", out, *options], check=True, capture_output=True
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return seconds, json.loads((out / "identify.json").read_text())["identified"][0]


def follow(sets: np.ndarray, plunger: np.ndarray) -> np.ndarray:
    """Elongation of every set (rows of `sets`) at every sample: shape (samples, sets), mm."""
    curve, line, of_z, n, nu, rho = sets.T
    power = n - 1.0
    z = np.zeros((len(plunger), len(sets)))
    for i, step in enumerate(np.diff(plunger), start=1):
        z[i] = z[i - 1] + abs(step) * (np.sign(step) - nu * np.abs(z[i - 1]) ** power * z[i - 1] + rho)
    x = plunger[:, None]
    return curve * x**2 + line * x + of_z * np.tanh(x) * z


def pyswarms(plunger: np.ndarray, elongation: np.ndarray, bounds: tuple[np.ndarray, np.ndarray]) -> tuple[float, float]:
    def mean_squares(sets: np.ndarray) -> np.ndarray:
        total = np.mean((follow(sets, plunger) - elongation[:, None]) ** 2, axis=0)
        return np.where(np.isfinite(total), total, 1e9)

    options = {"c1": 1.49618, "c2": 1.49618, "w": 0.7298}
    np.random.seed(1)
    swarm = GlobalBestPSO(n_particles=PARTICLES, dimensions=len(FREE), options=options, bounds=bounds)
    begun = time.process_time()
    least, _ = swarm.optimize(mean_squares, iters=ITERATIONS, verbose=False)
    return time.process_time() - begun, float(least)


def scipy(
    plunger: np.ndarray, elongation: np.ndarray, bounds: tuple[np.ndarray, np.ndarray]
) -> tuple[float, float, int]:
    low, high = bounds
    evaluations = 0

    def residual(x: np.ndarray) -> np.ndarray:
        nonlocal evaluations
        evaluations += 1
        shown = follow(x[None], plunger)[:, 0]
        return np.where(np.isfinite(shown), shown, 1e3) - elongation

    def slopes(x: np.ndarray) -> np.ndarray:
        nonlocal evaluations
        evaluations += len(x)
        steps = np.where(x + 1e-7 * (high - low) < high, 1.0, -1.0) * 1e-7 * (high - low)
        shown = follow(np.vstack([x, x + np.diag(steps)]), plunger)
        return np.nan_to_num((shown[:, 1:] - shown[:, :1]) / steps)

    random = np.random.default_rng(1)
    begun = time.process_time()
    starts = low + (high - low) * random.uniform(0.05, 0.95, (STARTS, len(low)))
    ends = [least_squares(residual, start, jac=slopes, bounds=bounds, x_scale=high - low) for start in starts]
    least = min(2.0 * end.cost / len(plunger) for end in ends)
    return time.process_time() - begun, float(least), evaluations


def main() -> None:
    np.seterr(all="ignore")
    repetitions = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        path, plunger, elongation = make_loop(folder)
        rows = []
        for _ in range(repetitions):
            hybrid_s, hybrid = smam(path, folder)
            swarm_s, swarm = smam(path, folder, "--method", "pso", "--starts", "1")
            spec = {p["name"]: p for p in hybrid["parameters"]}
            bounds = tuple(np.array([spec[p][edge] for p in FREE]) for edge in ("min", "max"))
            rival_s, rival = pyswarms(plunger, elongation, bounds)
            descent_s, descent, descents = scipy(plunger, elongation, bounds)
            rows.append((hybrid_s, swarm_s, rival_s, descent_s))
            print(
                f"smam hybrid {hybrid_s:.3f} s F {hybrid['f_mm2']:.6f} ({hybrid['evaluations']} evaluations)   "
                f"smam swarm {swarm_s:.2f} s F {swarm['f_mm2']:.6f} ({swarm['evaluations']})   "
                f"PySwarms {rival_s:.1f} s F {rival:.6f} ({PARTICLES * ITERATIONS})   "
                f"SciPy {descent_s:.2f} s F {descent:.6f} ({descents})",
                flush=True,
            )
        hybrid_s, swarm_s, rival_s, descent_s = np.median(np.array(rows), axis=0)
        print(
            f"medians: PySwarms / smam hybrid = {rival_s / hybrid_s:.0f}, PySwarms / smam swarm = {rival_s / swarm_s:.1f}, "
            f"SciPy / smam hybrid = {descent_s / hybrid_s:.1f}"
        )


if __name__ == "__main__":
    main()
