"""Hysteresis models from recorded loops."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from ._answers import read_json
from ._frames import PathLike, Series
from ._given import single
from ._process import Word, call
from ._shown import framed


@dataclass(frozen=True)
class Identification:
    """The answer of :func:`identify`."""

    models: pd.DataFrame
    """By model: ``f_mm2``, the mean squared error, ``f_holdout_mm2`` on the runs held out, and ``samples``."""
    parameters: pd.DataFrame = field(repr=False)
    """By model and name: ``value``, ``half_width_95`` of its interval (NaN: fixed), ``on_bound``."""
    tables: dict[str, Path] = field(repr=False)
    """Each model as a table for a scene."""
    page: Path
    raw: dict[str, Any] = field(repr=False)
    """All of identify.json."""

    def _repr_html_(self) -> str | None:
        return framed(self.page)


def identify(
    recordings: PathLike | Series,
    model: str | Sequence[str] = "paper",
    *,
    method: str = "hybrid",
    seed: int = 1,
    input: str | None = None,
    output: str | None = None,
    skip_s: float = 0.0,
    out: PathLike | None = None,
) -> Identification:
    """Fits hysteresis models to recorded loops.

    ``recordings``: a loop as a frame over ``time_s`` or arrays by column, a CSV or Parquet file, or a folder with a
    recordings.toml. ``model``: one name or several, such as
    ``"paper"``, ``"asymmetric"``, ``"prandtl-ishlinskii"``. ``method``: pso, cma, lm or hybrid. ``input``, ``output``:
    columns, both lengths. ``skip_s``: seconds at the start of each run that do not count. ``out``: where to write. Left out,
    ``out/identify_NAME`` for files; what arrays come to is kept as long as the answer.
    """
    given = single(recordings, "identify", out)
    written = given.answer
    words: list[Word] = ["identify", *given.paths, "--out", written, "--method", method, "--seed", str(seed)]
    for name in [model] if isinstance(model, str) else model:
        words += ["--model", name]
    for option, column in (("--input", input), ("--output", output)):
        if column is not None:
            words += [option, column]
    with given:
        call([*words, f"--skip={float(skip_s)!r}"], private=given.private)
        raw = read_json(written / "identify.json")
        found = raw["identified"]
        return given.goes_with(
            Identification(
                models=pd.DataFrame(found, columns=["model", "f_mm2", "f_holdout_mm2", "samples"]).set_index("model"),
                parameters=_parameters(found),
                tables={one["model"]: written / f"{one['model']}.toml" for one in found},
                page=written / "identify.html",
                raw=raw,
            )
        )


def _parameters(found: Sequence[dict[str, Any]]) -> pd.DataFrame:
    rows = [{"model": one["model"], **number} for one in found for number in one["parameters"]]
    columns = ["model", "name", "value", "half_width_95", "on_bound"]
    return pd.DataFrame(rows, columns=columns).set_index(["model", "name"])
