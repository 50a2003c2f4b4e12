"""What a rival answers, in the keys of diagnosis.json, and its error on the holdout."""

import json
import os
from dataclasses import dataclass, field

import numpy as np


@dataclass
class Answer:
    """An answer before the holdout is opened. `correction` is what it adds to the calibrated simulation there."""

    verdict: str
    element: str | None = None
    effects: list = field(default_factory=list)
    correction: dict = field(default_factory=dict)
    notes: dict = field(default_factory=dict)


def effect(name, element, probability, channel=None):
    """One entry of `effects`."""
    entry = {"name": name, "element": element, "probability": round(float(probability), 4)}
    return entry | ({"channel": channel} if channel else {})


def holdout_figures(case, answer, measured, noise):
    """Errors on the holdout, and the share of the gap to the noise that is closed."""
    channels, before, after, samples = {}, 0.0, 0.0, 0
    for column in case.outputs:
        simulated = case.holdout.simulated[column]
        corrected = simulated + answer.correction.get(column, 0.0)
        finite = np.isfinite(measured[column])
        sd = noise[column].sd
        squares = [((measured[column] - y)[finite] / sd) ** 2 for y in (simulated, corrected)]
        rmse = [float(sd * np.sqrt(s.mean())) for s in squares]
        channels[column] = {"rmse_baseline": rmse[0], "rmse_corrected": rmse[1], "noise_sd": float(sd)}
        before, after, samples = before + squares[0].sum(), after + squares[1].sum(), samples + finite.sum()
    gap = float((before - after) / (before - samples)) if before > samples else 0.0
    return {"channels": channels, "gap_closed": gap, "excess_chi2_per_sample_baseline": float(before / samples - 1.0)}


def as_json(method, answer, holdout, seconds, preparation):
    """The file's contents."""
    return {
        "format": 1,
        "method": method,
        "verdict": answer.verdict,
        "location": {"element": answer.element},
        "effects": answer.effects,
        "holdout": holdout,
        "seconds": round(seconds + preparation, 3),
        "seconds_playing_the_scene": round(preparation, 3),
        "notes": answer.notes,
    }


def write_whole(path, content):
    """Writes a JSON file whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    part.write_text(json.dumps(content, indent=1) + "\n")
    part.replace(path)
