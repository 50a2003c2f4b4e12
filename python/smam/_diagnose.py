"""What physics recordings show and their scene lacks."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from ._answers import read_json
from ._frames import PathLike
from ._given import Given, Told, recorded
from ._laws import Law, law_arguments, laws_of_scene
from ._process import Word, call
from ._run import run
from ._shown import framed, overlay
from ._toml import set_arguments

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_EFFECT_COLUMNS = [
    "name", "element", "channel", "probability", "parameter", "value", "ci95_low", "ci95_high", "rivals", "law", "hypothetical",
    "port", "acts", "known_as",
]  # fmt: skip
_FORM_COLUMNS = ["of", "port", "acts", "law", "known_as", "score_difference"]
_SPECIMEN_COLUMNS = ["number", "specimen", "value", "ci95_low", "ci95_high", "differs"]


@dataclass(frozen=True)
class Diagnosis:
    """The answer of :func:`diagnose`."""

    verdict: str
    """adequate, missing_physics, ambiguous, unknown_physics or unusable_data."""
    summary: str
    """The verdict in plain words."""
    effects: pd.DataFrame = field(repr=False)
    """One row per effect and number of it: size in SI units with its 95 % interval, probability, rivals, law, where it acts."""
    forms: pd.DataFrame = field(repr=False)
    """Other laws that explain the recordings as well: of which effect, port, law, what the field calls it."""
    specimens: pd.DataFrame = field(repr=False)
    """Calibrated numbers of each specimen, and whether they differ between specimens."""
    channels: pd.DataFrame = field(repr=False)
    """Errors on the held-out runs by channel, in its unit: ``rmse_baseline``, ``rmse_corrected``, ``noise_sd``."""
    gap_closed: float
    """Share of the gap between calibrated scene and noise that the effects close on the held-out runs."""
    warnings: list[str] = field(repr=False)
    folder: Path
    """Where everything was written."""
    raw: dict[str, Any] = field(repr=False)
    """All of diagnosis.json."""
    runs: dict[str, pd.DataFrame] = field(repr=False, default_factory=dict)
    """The runs by name, where frames or arrays were given."""
    conditions: Mapping[str, Mapping[str, float]] = field(repr=False, default_factory=dict)
    """What was said of them."""

    @property
    def laws(self) -> list[dict[str, Any]]:
        """The laws of the corrected scene as ``[[law]]`` tables: what ``laws`` of :func:`run` and :func:`sweep` takes."""
        return laws_of_scene(self.scene) if self.scene is not None else []

    def plot(self, run_name: str | None = None) -> Figure:
        """Measured, calibrated and corrected over each other for one run, with what is left (matplotlib).

        For arrays, of runs without conditions of their own; ``run_name`` left out: the first that was held out, else the last.
        """
        if not self.runs or self.baseline is None:
            raise ValueError("there are no arrays to draw\n  remedy: look at the page, `report`")
        held_out = [name for name in self.runs if f"{name}.csv" in self.raw.get("fit", {}).get("holdout", [])]
        name = run_name if run_name is not None else next(iter(held_out), list(self.runs)[-1])
        if name not in self.runs:
            raise ValueError(f"run_name: there is no run {name}; the runs are {', '.join(self.runs)}")
        if self.conditions.get(name):
            raise ValueError(f"run_name: {name} has conditions, which are not played here\n  remedy: look at the page, `report`")
        measured = self.runs[name]
        scenes = {"calibrated": self.baseline, "corrected": self.scene}
        simulated = {label: run(scene, input=measured) for label, scene in scenes.items() if scene is not None}
        columns = [column for column in self.channels.index if column in measured.columns]
        noise_sd = {str(channel): float(sd) for channel, sd in self.channels["noise_sd"].items()}
        return overlay(measured, simulated, columns, noise_sd, name)

    def _repr_html_(self) -> str | None:
        return framed(self.report)

    @property
    def report(self) -> Path | None:
        """The answer as one page."""
        return self._file("report.html")

    @property
    def scene(self) -> Path | None:
        """The corrected scene: :func:`run` and :func:`sweep` take it."""
        return self._file("scene.toml")

    @property
    def baseline(self) -> Path | None:
        """The same scene calibrated alone, nothing added."""
        return self._file("baseline.toml")

    @property
    def next_experiment(self) -> Path | None:
        """Inputs that would tell best what stays open."""
        return self._file("next_experiment.csv")

    def _file(self, name: str) -> Path | None:
        path = self.folder / name
        return path if path.is_file() else None


def diagnose(
    recordings: Given,
    *,
    scene: PathLike | None = None,
    noise: Mapping[str, float | None] | None = None,
    inputs: Collection[str] | None = None,
    holdout: Collection[str] = (),
    conditions: Mapping[str, Mapping[str, float]] | None = None,
    set: Mapping[str, Any] | None = None,
    laws: Sequence[Law] | None = None,
    out: PathLike | None = None,
    seed: int = 1,
    threads: int | None = None,
    rrd: bool = False,
    transfer: str | None = None,
    thorough: bool = False,
) -> Diagnosis:
    """Finds what physics the scene of some recordings lacks.

    ``recordings``: a frame over ``time_s`` or arrays by column (one run), several of these by the run's name, or folders with a
    recordings.toml. Columns end in their unit and are called as the scene's channels.
    ``scene``: the scene of arrays; of folders, instead of the one that recordings.toml names.
    Of arrays alone: ``noise``, standard deviations in the column's unit where they are known; ``inputs``, the columns that drive, else
    those of the scene; ``holdout``, runs that are held back; ``conditions``, known numbers of a run
    (:func:`write_recordings`).
    ``set``: keys of the scene with other values. ``laws``: as in :func:`run`.
    ``out``: where to write. Left out, ``out/diagnose_NAME`` for a folder; what arrays come to is kept as long as the answer.
    ``rrd``: also a stream for the Rerun viewer.
    ``transfer``: a specimen that is predicted from the others with its stated conditions alone.
    ``thorough``: begin every step of the search; otherwise those that it can do without do not begin after some two minutes, and
    ``warnings`` names them.
    Recordings that cannot be diagnosed give the verdict ``unusable_data``, not an error.
    """
    given = recorded(recordings, scene, Told(noise, inputs, holdout, conditions), "diagnose", out)
    words: list[Word] = ["diagnose", *given.paths, "--out", given.answer, "--seed", str(seed)]
    words += [*law_arguments(laws), *set_arguments(set)]
    if scene is not None and not given.runs:
        words += ["--scene", scene]
    if threads is not None:
        words += ["--threads", str(threads)]
    if rrd:
        words.append("--rrd")
    if transfer is not None:
        words += ["--transfer", transfer]
    if thorough:
        words.append("--thorough")
    with given:
        call(words, also_fine=[1], private=given.private)
        return given.goes_with(_read(given.answer, given.runs, conditions))


def _read(
    folder: Path,
    runs: dict[str, pd.DataFrame] | None = None,
    conditions: Mapping[str, Mapping[str, float]] | None = None,
) -> Diagnosis:
    raw = read_json(folder / "diagnosis.json")
    fit = raw.get("fit", {})
    channels = pd.DataFrame.from_dict(
        fit.get("channels", {}), orient="index", columns=["rmse_baseline", "rmse_corrected", "noise_sd"]
    )
    return Diagnosis(
        verdict=raw["verdict"],
        summary=raw.get("summary", ""),
        effects=_effects(raw.get("effects", [])),
        forms=_forms(raw.get("effects", [])),
        specimens=_specimens(raw.get("specimens", {})),
        channels=channels.rename_axis("channel"),
        gap_closed=float(fit.get("gap_closed", 0.0)),
        warnings=list(raw.get("warnings", [])),
        folder=folder,
        raw=raw,
        runs=runs or {},
        conditions=conditions or {},
    )


def _effects(found: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    rows = []
    for effect in found:
        for key, number in effect["parameters"].items():
            low, high = number["ci95"]
            rows.append(
                {
                    "name": effect["name"],
                    "element": effect["element"],
                    "channel": effect.get("channel", ""),
                    "probability": effect["probability"],
                    "parameter": key,
                    "value": number["value"],
                    "ci95_low": low,
                    "ci95_high": high,
                    "rivals": ", ".join(effect.get("rivals", [])),
                    "law": effect.get("law", ""),
                    "hypothetical": effect.get("hypothetical", False),
                    "port": effect.get("port", ""),
                    "acts": effect.get("acts", ""),
                    "known_as": effect.get("known_as", ""),
                }
            )
    return pd.DataFrame(rows, columns=_EFFECT_COLUMNS)


def _forms(found: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    rows = [{"of": effect["name"], "known_as": "", **form} for effect in found for form in effect.get("forms", [])]
    return pd.DataFrame(rows, columns=_FORM_COLUMNS)


def _specimens(numbers: Mapping[str, Mapping[str, Any]]) -> pd.DataFrame:
    rows = []
    for number, own in numbers.items():
        for specimen, estimate in own["values"].items():
            low, high = estimate["ci95"]
            value = estimate["value"]
            row = [number, specimen, value, low, high, own["differs"]]
            rows.append(dict(zip(_SPECIMEN_COLUMNS, row, strict=True)))
    return pd.DataFrame(rows, columns=_SPECIMEN_COLUMNS)
