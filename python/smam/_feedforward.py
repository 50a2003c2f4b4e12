"""What the plunger has to do for a wanted motion."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from ._frames import PathLike, Series, read_csv, write_csv
from ._process import Word, call


def feedforward(
    model: PathLike,
    wanted: PathLike | Series,
    *,
    column: str = "elongation_mm",
    input: str = "plunger_mm",
    least_mm: float = 0.0,
    most_mm: float = 3.0,
    speed_mm_s: float = 20.0,
    least_slope: float = 0.15,
    output: PathLike | None = None,
) -> pd.DataFrame:
    """The plunger's programme over ``time_s`` for which an identified model moves as is wanted.

    ``model``: one of the ``tables`` that :func:`identify` finds. ``wanted``: the motion, a length, in ``column`` of a file, a frame
    over ``time_s`` or arrays by name. ``least_mm``, ``most_mm``, ``speed_mm_s``: where the plunger may go, and how fast.
    ``least_slope``: slopes of the model below this share of its mean slope are taken to be this large.
    ``input``: what the programme's column is called. ``output``: keep it as this CSV file.
    """
    with tempfile.TemporaryDirectory(prefix="smam_") as scratch:
        given = Path(scratch, "wanted.csv")
        if isinstance(wanted, (pd.DataFrame, Mapping)):
            write_csv(wanted, given)
        else:
            given = Path(wanted)
        csv = Path(output) if output is not None else Path(scratch, "programme.csv")
        limits = {"least": least_mm, "most": most_mm, "speed": speed_mm_s, "least-slope": least_slope}
        words: list[Word] = ["feedforward", model, given, "--column", column, "--input", input, "--out", csv]
        call([*words, *(f"--{name}={float(value)!r}" for name, value in limits.items())], private=scratch)
        return read_csv(csv)
