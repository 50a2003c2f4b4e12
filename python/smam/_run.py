"""One run of a scene."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from ._frames import PathLike, Series, read_csv, write_csv
from ._laws import Law, law_arguments
from ._process import Word, call
from ._toml import set_arguments


def run(
    scene: PathLike,
    *,
    set: Mapping[str, Any] | None = None,
    laws: Sequence[Law] | None = None,
    input: PathLike | Series | None = None,
    duration_s: float | None = None,
    output: PathLike | None = None,
    rrd: PathLike | None = None,
    view: bool = False,
) -> pd.DataFrame:
    """Runs a scene and returns its channels over ``time_s``.

    ``scene``: path of a scene file, or a name that :func:`scenes` lists.
    ``set``: keys of the scene with other values, ``{"muscles.friction.m0_n": 0.2}``; :func:`keys` lists them.
    ``laws``: physics of your own, ``["muscle.damping adds 0.05*tanh(speed_m_s/2e-3)"]`` or ``[[law]]`` tables
    (``smam laws`` lists the ports).
    ``input``: drives the scene's inputs at its sample times: a CSV or Parquet file, or a frame, or arrays by name with
    ``time_s`` among them. Left out, the scene's own programme is played.
    ``duration_s``: length of the run instead of the scene's.
    ``output``: keep the recording as this CSV file. ``rrd``: write a stream for the Rerun viewer. ``view``: open it.
    """
    with tempfile.TemporaryDirectory(prefix="smam_") as scratch:
        csv = Path(output) if output is not None else Path(scratch, "run.csv")
        words: list[Word] = ["run", scene, "--output", csv, *law_arguments(laws), *set_arguments(set)]
        if input is not None:
            words += ["--input", _input_file(input, Path(scratch))]
        if duration_s is not None:
            words.append(f"--duration={float(duration_s)!r}")
        if rrd is not None:
            words += ["--rrd", rrd]
        if view:
            words.append("--view")
        call(words, private=scratch)
        return read_csv(csv)


def _input_file(given: PathLike | Series, scratch: Path) -> PathLike:
    if isinstance(given, (pd.DataFrame, Mapping)):
        write_csv(given, scratch / "input.csv")
        return scratch / "input.csv"
    return given
