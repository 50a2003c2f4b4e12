"""Recordings beside their simulation."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from ._answers import read_json
from ._frames import PathLike
from ._given import Given, Told, recorded
from ._laws import Law, law_arguments
from ._process import Word, call
from ._shown import framed
from ._toml import set_arguments


@dataclass(frozen=True)
class Comparison:
    """The answer of :func:`compare`."""

    channels: pd.DataFrame
    """By run and channel, in the channel's unit: ``rmse``, ``noise_sd``, ``range``, and the number of ``samples``."""
    fitted: dict[str, float]
    """Numbers of the scene that were fitted to the runs, SI."""
    page: Path
    """Measured over simulated with what is left, as a page for a browser."""
    raw: dict[str, Any] = field(repr=False)
    """All of compare.json."""

    def _repr_html_(self) -> str | None:
        return framed(self.page)


def compare(
    recordings: Given,
    *,
    scene: PathLike | None = None,
    noise: Mapping[str, float | None] | None = None,
    inputs: Collection[str] | None = None,
    conditions: Mapping[str, Mapping[str, float]] | None = None,
    set: Mapping[str, Any] | None = None,
    laws: Sequence[Law] | None = None,
    out: PathLike | None = None,
) -> Comparison:
    """Simulates what was recorded and lays both over each other.

    ``recordings``, ``scene``, ``noise``, ``inputs``, ``conditions``: as in :func:`diagnose`; one folder. ``set``: keys of the scene
    with other values. ``laws``: as in :func:`run`. ``out``: where to write. Left out, ``out/compare_NAME`` for a folder; what
    arrays come to is kept as long as the answer.
    """
    given = recorded(recordings, scene, Told(noise, inputs, (), conditions), "compare", out)
    words: list[Word] = ["compare", *given.paths, "--out", given.answer, *law_arguments(laws), *set_arguments(set)]
    if scene is not None and not given.runs:
        words += ["--scene", scene]
    with given:
        call(words, private=given.private)
        raw = read_json(given.answer / "compare.json")
        rows = {(run, channel): fit for run, fits in raw["runs"].items() for channel, fit in fits.items()}
        channels = pd.DataFrame(list(rows.values()), columns=["rmse", "noise_sd", "range", "samples"])
        channels.index = pd.MultiIndex.from_tuples(list(rows), names=["run", "channel"])
        return given.goes_with(Comparison(channels, dict(raw.get("fitted", {})), given.answer / "compare.html", raw))
