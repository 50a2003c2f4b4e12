"""One case as a rival sees it: recordings, stated noise, the calibrated scene played over every run."""

import csv
import json
import os
import subprocess
import tempfile
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator

from rig import COORDINATES

# Keys of [[calibrate]] as `smam run --set` writes them.
CALIBRATION_KEYS = {
    "tube_c1_pa": "muscles.tube.material.c1_pa",
    "upstream_compliance_m3_pa": "hydraulics.upstream_compliance_m3_pa",
    "friction_m0_n": "muscles.friction.m0_n",
    "friction_m1_n_pa": "muscles.friction.m1_n_pa",
    "presliding_length_m": "muscles.friction.presliding_length_m",
}
# Share by which a calibrated number is moved to see what it does.
TANGENT_STEP = 0.01
# Samples left out on either side of slack cables.
AROUND_SLACK = 10
# An interval so many times the median one has lost samples.
LOST = 1.5


class CaseError(Exception):
    """Something about a case that its user can mend."""


class NotForThisCase(CaseError):
    """A method that has no answer to a case of this kind."""


@dataclass
class Run:
    """One recording and what the calibrated scene makes of its inputs; columns by name, in their own units."""

    file: str
    time_s: np.ndarray
    inputs: dict
    measured: dict
    simulated: dict = field(default_factory=dict)
    tangents: dict = field(default_factory=dict)

    @property
    def interval_s(self):
        """Median sampling interval."""
        return float(np.median(np.diff(self.time_s)))


@dataclass
class Case:
    """All that a rival may use. The holdout's outputs are not in here."""

    name: str
    scene: str
    outputs: list
    stated_sd: dict
    runs: list
    holdout: Run
    numbers: dict
    # Where the hidden law stands: only for a method that is told.
    given_port: str | None = None


def load_case(cases, name, diagnoses, smam):
    """Reads a case and plays the calibrated scene over its runs and over the inputs of its holdout."""
    folder = cases / name
    head = read_toml(folder / "recordings.toml")
    scene = Path(head.get("scene", "")).stem
    if scene not in COORDINATES:
        raise CaseError(f"{folder}: scene {scene!r} is not among {', '.join(COORDINATES)}: the rivals know no other")
    outputs = {c["column"]: c.get("noise_sd") for c in head["channel"] if c["role"] == "output"}
    inputs = [c["column"] for c in head["channel"] if c["role"] == "input"]
    baseline = diagnoses / name / "baseline.toml"
    if not baseline.is_file():
        raise CaseError(f"{baseline} is missing: run `smam diagnose {folder} --out {baseline.parent}` first")
    numbers = read_toml(baseline)
    runs = [read_run(folder / r["file"], inputs, list(outputs)) for r in head["run"]]
    holdout = read_run(cases / f"{name}.holdout.csv", inputs, [])
    for run in [*runs, holdout]:
        play(run, baseline, numbers, list(outputs), smam)
    return Case(name, scene, list(outputs), outputs, runs, holdout, numbers)


def hidden_port(sealed, name):
    """The port of the drawn law of a case, from its sealed answer."""
    try:
        secrets = json.loads((sealed / f"{name}.json").read_text())["secrets"]
        return next(secret["law"]["place"] for secret in secrets if secret.get("law"))
    except (OSError, ValueError, LookupError, StopIteration) as error:
        message = f"{sealed / name}.json holds no drawn law ({type(error).__name__}): `ude` is told its port"
        raise CaseError(message) from error


def sealed_outputs(cases, name, outputs):
    """What the holdout measured: asked for once, after every answer of a method is fixed."""
    return read_run(cases / f"{name}.holdout.csv", [], outputs).measured


def read_toml(path):
    """A TOML file, or a word about what is wrong with it."""
    try:
        with open(path, "rb") as file:
            return tomllib.load(file)
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise CaseError(f"{path}: {error}") from error


def read_run(path, inputs, outputs):
    """One recording."""
    table = read_csv(path)
    missing = [c for c in ["time_s", *inputs, *outputs] if c not in table]
    if missing:
        raise CaseError(f"{path}: no column {', '.join(missing)}; there are {', '.join(table)}")
    if len(table["time_s"]) < 100:
        raise CaseError(f"{path}: {len(table['time_s'])} samples are too few")
    return Run(path.name, table["time_s"], {c: table[c] for c in inputs}, {c: table[c] for c in outputs})


def read_csv(path):
    """Columns of a CSV file; empty cells are NaN."""
    try:
        with open(path, newline="") as file:
            rows = list(csv.reader(file))
    except OSError as error:
        raise CaseError(f"{path}: {error}") from error
    if len(rows) < 2:
        raise CaseError(f"{path}: no samples")
    try:
        values = np.array([[float(cell) if cell.strip() else np.nan for cell in row] for row in rows[1:] if row])
    except ValueError as error:
        raise CaseError(f"{path}: {error}") from error
    return {name.strip(): values[:, i] for i, name in enumerate(rows[0])}


def play(run, baseline, numbers, outputs, smam):
    """Plays the calibrated scene over the inputs of a run, as it is and with each calibrated number moved a little."""
    run.simulated = simulate(run, baseline, {}, smam)
    missing = [c for c in outputs if c not in run.simulated]
    if missing:
        raise CaseError(f"{baseline}: the scene shows no {', '.join(missing)}")
    for spec in numbers.get("calibrate", []):
        key = CALIBRATION_KEYS.get(spec["key"], spec["key"])
        value = number(numbers, key)
        moved = simulate(run, baseline, {key: value * (1.0 + TANGENT_STEP)}, smam)
        run.tangents[spec["key"]] = {c: (moved[c] - run.simulated[c]) / TANGENT_STEP for c in outputs}
    leave_out_unheld(run)


def leave_out_unheld(run):
    """Blanks what is measured while no cable is taut: the joint lies where its last swing left it."""
    tensions = [v for c, v in run.simulated.items() if c.startswith("tension_")]
    if not tensions:
        return
    slack = np.max(tensions, axis=0) <= 0.0
    near = np.convolve(slack, np.ones(2 * AROUND_SLACK + 1), mode="same") > 0.5
    if near.mean() < 0.5:
        for values in run.measured.values():
            values[near] = np.nan


def number(numbers, key):
    """A number of a scene by its dotted key."""
    value = numbers
    for part in key.split("."):
        value = value[part]
    return float(value)


def simulate(run, baseline, changes, smam):
    """Every channel of the scene at the sample times of a run. The program sees the inputs only."""
    with tempfile.TemporaryDirectory() as folder:
        drive, shown = Path(folder) / "inputs.csv", Path(folder) / "shown.csv"
        time_s, inputs, own = evenly_driven(run)
        table = np.column_stack([time_s, *inputs])
        header = ",".join(["time_s", *run.inputs])
        np.savetxt(drive, table, delimiter=",", header=header, comments="", fmt="%.9g")
        command = [smam, "run", str(baseline.resolve()), "--input", str(drive), "--output", str(shown)]
        for key, value in changes.items():
            command += ["--set", f"{key}={value!r}"]
        result = subprocess.run(command, capture_output=True, text=True, check=False, env=os.environ)
        if result.returncode != 0:
            raise CaseError(f"`{' '.join(command)}` ended with {result.returncode}: {result.stderr.strip()}")
        return {column: values[own] for column, values in read_csv(shown).items()}


def evenly_driven(run):
    """Times and inputs of a run with what is lost between its samples put in, and which times are its own.

    On a smooth curve, as plungers move: straight lines bend the motion by more than the noise of what it drives.
    """
    steps = np.diff(run.time_s)
    counts = np.where(steps > LOST * run.interval_s, np.round(steps / run.interval_s), 1).astype(int)
    own = np.append(0, np.cumsum(counts))
    if own[-1] == len(steps):
        return run.time_s, list(run.inputs.values()), own
    time_s = np.interp(np.arange(own[-1] + 1), own, run.time_s)
    return time_s, [PchipInterpolator(run.time_s, values)(time_s) for values in run.inputs.values()], own
