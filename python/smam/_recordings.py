"""Folders of recordings, from arrays."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from ._frames import PathLike, Series, over_time
from ._toml import document


def write_recordings(
    folder: PathLike,
    scene: PathLike,
    runs: Mapping[str, Series],
    *,
    inputs: Collection[str],
    outputs: Collection[str] | Mapping[str, float | None],
    holdout: Collection[str] = (),
    conditions: Mapping[str, Mapping[str, float]] | None = None,
) -> Path:
    """Writes a folder that :func:`diagnose`, :func:`compare` and :func:`identify` read, and returns its path.

    ``runs``: each run by its name, as a frame over ``time_s`` or as arrays by column. Columns end in their unit.
    ``inputs``: columns that drive the simulation; ``outputs``: columns compared with it, with the standard deviation of
    their noise in the column's unit where it is known (``{"elongation_mm": 0.02, "pressure_kpa": None}``).
    An output that some runs lack is written as not recorded there.
    ``holdout``: runs to which nothing is fitted. ``conditions``: known numbers of a run,
    ``{"hang": {"hanging_mass_kg": 0.2}}``.
    """
    path = Path(folder)
    path.mkdir(parents=True, exist_ok=True)
    noise = dict(outputs) if isinstance(outputs, Mapping) else {column: None for column in outputs}
    columns = [*inputs, *noise]
    _known("holdout", holdout, runs)
    _known("conditions", conditions or {}, runs)
    frames = {name: over_time(series) for name, series in runs.items()}
    somewhere = {column for frame in frames.values() for column in frame.columns}
    listed = []
    for name in runs:
        frame = frames[name]
        missing = [column for column in columns if column not in frame.columns]
        if any(column in inputs or column not in somewhere for column in missing):
            raise ValueError(f"run {name}: there is no column {', '.join(missing)}; found: {', '.join(frame.columns)}")
        frame[[column for column in columns if column not in missing]].to_csv(path / f"{name}.csv")
        run: dict[str, Any] = {"file": f"{name}.csv"}
        if missing:
            run["not_recorded"] = missing
        if holdout:
            run["use"] = "holdout" if name in holdout else "fit"
        listed.append({**run, **(conditions or {}).get(name, {})})
    channels = [{"column": column, "role": "input"} for column in inputs]
    channels += [_output(column, sd) for column, sd in noise.items()]
    stands_at = Path(scene)
    text = document(
        {
            "format": 1,
            "scene": str(stands_at.resolve()) if stands_at.is_file() else str(scene),
            "channel": channels,
            "run": listed,
        }
    )
    (path / "recordings.toml").write_text(text, encoding="utf-8")
    return path


def _output(column: str, noise_sd: float | None) -> dict[str, Any]:
    stated = {} if noise_sd is None else {"noise_sd": float(noise_sd)}
    return {"column": column, "role": "output", **stated}


def _known(argument: str, names: Collection[str], runs: Mapping[str, Series]) -> None:
    unknown = [name for name in names if name not in runs]
    if unknown:
        raise ValueError(f"{argument}: there is no run {', '.join(unknown)}; the runs are {', '.join(runs)}")
