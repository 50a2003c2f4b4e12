"""From the arrays of a rig to the physics that its model lacks: diagnosis, before and after.

    python examples/python/diagnose_my_csv.py [FIGURE.png]

The cells (# %%) run one by one in Jupyter, VS Code or Spyder. Takes about half a minute.
"""

# %% Your rig: arrays over time, in the units of the column's name
# There is no rig here. `play` stands for it: a bench that leaks, and sensors with noise. With a rig, fill `runs` with what
# your data acquisition gave: numpy.loadtxt("mine.csv", delimiter=",", skiprows=1), one dictionary for each run.
import sys

import numpy as np

import smam

random = np.random.default_rng(7)
ELONGATION_NOISE_MM, PRESSURE_NOISE_KPA = 0.02, 5.0


def play(plunger_mm, time_s):
    leak = {"name": "leak", "element": "line", "conductance_m3_s_pa": 5e-18}
    shown = smam.run("muscle_bench", set={"effect": [leak]}, input={"time_s": time_s, "plunger_mm": plunger_mm})
    return {
        "time_s": time_s,
        "plunger_mm": plunger_mm,
        "elongation_mm": shown["elongation_mm"].to_numpy() + random.normal(0.0, ELONGATION_NOISE_MM, len(time_s)),
        "pressure_kpa": shown["pressure_kpa"].to_numpy() + random.normal(0.0, PRESSURE_NOISE_KPA, len(time_s)),
    }


time_s = np.arange(0.0, 40.0, 0.02)
levels_mm = np.array([0.0, 2.4, 0.9, 2.7, 1.5, 0.6, 2.1, 1.2])  # each held for four seconds after one of moving
corners_s = np.arange(0.0, 40.0, 5.0).repeat(2) + np.tile([0.0, 1.0], 8)
corners_mm = np.concatenate([[0.0], levels_mm.repeat(2)[:-1]])
phase_rad = 2.0 * np.pi * (0.05 + 0.005 * time_s) * time_s  # a sine that becomes faster, to 0.45 Hz
runs = {
    "sine": play(1.5 - 1.5 * np.cos(2.0 * np.pi * 0.1 * time_s), time_s),
    "steps": play(np.interp(time_s, corners_s, corners_mm), time_s),
    "chirp": play(1.5 - 1.5 * np.cos(phase_rad), time_s),
}

# %% The diagnosis: which run is held back, and what is known of the noise
noise = {"elongation_mm": ELONGATION_NOISE_MM, "pressure_kpa": PRESSURE_NOISE_KPA}  # what is left out is estimated
diagnosis = smam.diagnose(runs, scene="muscle_bench", noise=noise, holdout=["chirp"], out="my_rig")
print(diagnosis.verdict)
print(diagnosis.summary)
found = diagnosis.effects[["name", "element", "probability", "parameter", "value", "ci95_low", "ci95_high"]]
print(found.to_string(float_format="%.4g"))
print(diagnosis.channels.to_string(float_format="%.4g"))
print("the page:", diagnosis.report)

# %% Before and after, on the run that had no part in finding it
diagnosis.plot("chirp").savefig(sys.argv[1] if len(sys.argv) > 1 else "diagnosis.png", dpi=150)
