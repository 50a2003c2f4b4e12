"""A rig that the tests make: the bench with something hidden, and sensors with noise."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

import smam

NOISE = {"elongation_mm": 0.02, "pressure_kpa": 5.0}


def plunger_mm(run: str, time_s: np.ndarray[Any, np.dtype[np.float64]]) -> Any:
    if run == "steps":
        levels_mm = np.array([0.0, 2.4, 0.9, 2.7, 1.5, 0.6])
        corners_s = np.arange(0.0, 30.0, 5.0).repeat(2) + np.tile([0.0, 1.0], 6)
        return np.interp(time_s, corners_s, np.concatenate([[0.0], levels_mm.repeat(2)[:-1]]))
    rise_hz_s = {"sine": 0.0, "chirp": 0.006}[run]
    return 1.5 - 1.5 * np.cos(2.0 * np.pi * (0.1 + rise_hz_s * time_s) * time_s)


def record(hidden: Mapping[str, Any], seed: int = 7) -> dict[str, pd.DataFrame]:
    random = np.random.default_rng(seed)
    time_s = np.arange(0.0, 30.0, 0.02)
    runs = {}
    for name in ("sine", "steps", "chirp"):
        shown = smam.run("muscle_bench", set=hidden, input={"time_s": time_s, "plunger_mm": plunger_mm(name, time_s)})
        noisy = {column: shown[column] + random.normal(0.0, sd, len(shown)) for column, sd in NOISE.items()}
        runs[name] = shown[["plunger_mm"]].assign(**noisy)
    return runs


def write(hidden: Mapping[str, Any], folder: str) -> None:
    smam.write_recordings(folder, "muscle_bench", record(hidden), inputs=["plunger_mm"], outputs=NOISE, holdout=["chirp"])
