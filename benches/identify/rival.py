"""The paper's model identified twice from one loop: by smam, and by PySwarms' swarm over NumPy. Both on one core.

The loop: `smam run muscle_printed_model` (30 s, 100 Hz, 3 mm), with 0.027 mm of white noise. The rival has the same
swarm (64 particles, 400 iterations, the same inertia and pulls), the same bounds and the same free parameters. Its model steps
all particles at once, one explicit Euler step per sample: the least that NumPy can do, and less exact than smam's.
Times are CPU times: of the whole process for smam, of the swarm alone for the rival (no imports, no reading).
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

PARTICLES, ITERATIONS = 64, 400
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


def pyswarms(plunger: np.ndarray, elongation: np.ndarray, bounds: tuple[np.ndarray, np.ndarray]) -> tuple[float, float]:
    steps = np.diff(plunger)
    squares, gates = plunger**2, np.tanh(plunger)

    def mean_squares(sets: np.ndarray) -> np.ndarray:
        curve, line, of_z, n, nu, rho = sets.T
        power = n - 1.0
        z = np.zeros(len(sets))
        total = (curve * squares[0] + line * plunger[0] - elongation[0]) ** 2
        for i, step in enumerate(steps, start=1):
            z = z + abs(step) * (np.sign(step) - nu * np.abs(z) ** power * z + rho)
            error = curve * squares[i] + line * plunger[i] + of_z * gates[i] * z - elongation[i]
            total += error * error
        return np.where(np.isfinite(total), total, 1e9) / len(plunger)

    options = {"c1": 1.49618, "c2": 1.49618, "w": 0.7298}
    np.random.seed(1)
    np.seterr(all="ignore")
    swarm = GlobalBestPSO(n_particles=PARTICLES, dimensions=len(FREE), options=options, bounds=bounds)
    begun = time.process_time()
    least, _ = swarm.optimize(mean_squares, iters=ITERATIONS, verbose=False)
    return time.process_time() - begun, float(least)


def main() -> None:
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
            rows.append((hybrid_s, swarm_s, rival_s))
            print(
                f"smam hybrid {hybrid_s:.3f} s F {hybrid['f_mm2']:.6f} ({hybrid['evaluations']} evaluations)   "
                f"smam swarm {swarm_s:.2f} s F {swarm['f_mm2']:.6f} ({swarm['evaluations']})   "
                f"PySwarms {rival_s:.1f} s F {rival:.6f} ({PARTICLES * ITERATIONS})",
                flush=True,
            )
        hybrid_s, swarm_s, rival_s = np.median(np.array(rows), axis=0)
        print(f"medians: PySwarms / smam hybrid = {rival_s / hybrid_s:.0f}, PySwarms / smam swarm = {rival_s / swarm_s:.1f}")


if __name__ == "__main__":
    main()
