"""Recordings beside their simulation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from ._answers import answer_folder, read_json
from ._frames import PathLike
from ._laws import Law, law_arguments
from ._process import Word, call
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


def compare(
    folder: PathLike,
    *,
    scene: PathLike | None = None,
    set: Mapping[str, Any] | None = None,
    laws: Sequence[Law] | None = None,
    out: PathLike | None = None,
) -> Comparison:
    """Simulates what was recorded and lays both over each other.

    ``folder``: with a recordings.toml. ``scene``: instead of the one named there. ``set``: keys of the scene with other
    values. ``laws``: as in :func:`run`. ``out``: where to write, ``out/compare_NAME`` if left out.
    """
    written = answer_folder(out, "compare", folder)
    words: list[Word] = ["compare", folder, "--out", written, *law_arguments(laws), *set_arguments(set)]
    if scene is not None:
        words += ["--scene", scene]
    call(words)
    raw = read_json(written / "compare.json")
    rows = {(run, channel): fit for run, fits in raw["runs"].items() for channel, fit in fits.items()}
    channels = pd.DataFrame(list(rows.values()), columns=["rmse", "noise_sd", "range", "samples"])
    channels.index = pd.MultiIndex.from_tuples(list(rows), names=["run", "channel"])
    return Comparison(channels, dict(raw.get("fitted", {})), written / "compare.html", raw)
