"""Series over time: from what a caller has to a file, and back."""

from __future__ import annotations

import csv
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

TIME = "time_s"
Series = pd.DataFrame | Mapping[str, Any]
PathLike = str | os.PathLike[str]


def over_time(series: Series) -> pd.DataFrame:
    """A frame whose index is ``time_s``, from such a frame, one with a column of that name, or arrays by name."""
    frame = series if isinstance(series, pd.DataFrame) else pd.DataFrame(dict(series))
    if TIME in frame.columns:
        frame = frame.set_index(TIME)
    if frame.index.name != TIME:
        names = ", ".join(str(name) for name in frame.columns)
        raise ValueError(f'there is no "{TIME}" among {names}\n  remedy: give the times in seconds under that name')
    return frame


def write_csv(series: Series, path: Path) -> None:
    # A missing sample is an empty cell.
    over_time(series).to_csv(path)


def read_csv(path: PathLike) -> pd.DataFrame:
    """A recording of the program, numbers exactly as it wrote them."""
    with open(path, encoding="utf-8", newline="") as file:
        columns = next(csv.reader([file.readline()]))
        values = np.loadtxt(file, delimiter=",", ndmin=2).reshape(-1, len(columns))
    return pd.DataFrame(values, columns=columns).set_index(TIME)
