"""Many runs of one scene."""

from __future__ import annotations

import csv
import math
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from shutil import copyfile
from typing import Any, Union

import numpy as np
import numpy.typing as npt
import pandas as pd

from ._frames import PathLike
from ._laws import Law, law_overrides
from ._process import Word, call
from ._toml import document, overrides

Range = Union[Sequence[float], "npt.NDArray[Any]", "pd.Series[Any]", Mapping[str, Any]]


def sweep(
    scene: PathLike,
    vary: Mapping[str, Range] | None = None,
    measure: Mapping[str, str] | None = None,
    *,
    sampling: Mapping[str, Any] | None = None,
    set: Mapping[str, Any] | None = None,
    laws: Sequence[Law] | None = None,
    duration_s: float | None = None,
    out: PathLike | None = None,
    resume: bool = False,
    threads: int | None = None,
) -> pd.DataFrame:
    """Runs a scene at many points of its keys: one row per point, a column for each key and each measure.

    ``vary``: the values of each key, all combined: ``{"muscles.pre_elongation_ratio": np.linspace(0.2, 1, 17)}``; or what
    ``[[vary]]`` takes, ``{"from": 0.05, "to": 0.3}`` or ``{"mean": 0.1, "sd": 0.01}``, for a ``sampling`` such as
    ``{"method": "sobol", "count": 128, "seed": 1}``.
    ``measure``: figures of each run by the name of their column: ``{"range_deg": "range(angle_deg)"}``.
    ``laws``: as in :func:`run`; a parameter can be varied, ``{"law.NAME.PARAMETER": [0.1, 0.2]}``.
    ``out``: keep tables, page and journal in this folder; ``resume`` goes on with what is there.
    Columns ``warning_slack_s``, ``warning_cavitation_s``, ``warning_yield_s``, ``warning_penetration_s`` and
    ``warning_joint_limit_s`` say for how long a run was where the rig, or the model, ends.
    Without ``vary`` and ``measure``, ``scene`` is a sweep file. A point that failed has NaN for its measures and the
    reason in the column ``error``.
    """
    with tempfile.TemporaryDirectory(prefix="smam_") as scratch:
        folder = Path(out) if out is not None else Path(scratch, "sweep")
        given = vary is not None or measure is not None
        file = Path(scratch, "sweep.toml") if given else Path(scene)
        if given:
            text = document(_sweep_file(scene, vary or {}, measure or {}, sampling, [*law_overrides(laws), *overrides(set)], duration_s))
            file.write_text(text, encoding="utf-8")
        elif any(of is not None for of in (sampling, set, laws, duration_s)):
            raise ValueError("sampling, set, laws and duration_s need vary and measure\n  remedy: a sweep file holds its own")
        words: list[Word] = ["sweep", file, "--out", folder]
        if resume:
            words.append("--resume")
        if threads is not None:
            words += ["--threads", str(threads)]
        call(words, private=scratch)
        if given and out is not None:
            copyfile(file, folder / "sweep.toml")  # for `smam sweep plot`
        return _table(folder / "table.csv")


def _sweep_file(
    scene: PathLike,
    vary: Mapping[str, Range],
    measure: Mapping[str, str],
    sampling: Mapping[str, Any] | None,
    changes: list[str],
    duration_s: float | None,
) -> dict[str, Any]:
    path = Path(scene)
    file: dict[str, Any] = {
        "format": 1,
        "name": path.stem,
        # The sweep file stands elsewhere: a path must not be relative to it.
        "scene": str(path.resolve()) if path.is_file() else str(scene),
    }
    if duration_s is not None:
        file["duration_s"] = float(duration_s)
    if changes:
        file["set"] = changes
    if sampling is not None:
        file["sampling"] = dict(sampling)
    file["vary"] = [{"key": key, **_range(over)} for key, over in vary.items()]
    file["measure"] = [{"name": name, "of": of} for name, of in measure.items()]
    return file


def _range(over: Range) -> dict[str, Any]:
    return dict(over) if isinstance(over, Mapping) else {"values": np.asarray(over, dtype=float)}


def _table(path: Path) -> pd.DataFrame:
    with path.open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    index, *columns, error = header
    # Python reads numbers exactly as they were written; an empty cell is the measure of a point that failed.
    numbers = [[float(cell) if cell else math.nan for cell in row[1:-1]] for row in rows]
    table = pd.DataFrame(numbers, columns=columns, index=pd.Index([int(row[0]) for row in rows], name=index), dtype=float)
    table[error] = [row[-1] for row in rows]
    return table
