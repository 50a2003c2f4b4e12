"""Recordings as a caller has them: a folder, a file, a frame or arrays of one run, or several of these by name."""

from __future__ import annotations

import shutil
import tempfile
import weakref
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike as OsPathLike
from pathlib import Path
from typing import Any, TypeVar, Union, cast

import pandas as pd

from ._answers import answer_folder
from ._frames import PathLike, Series, over_time
from ._lists import keys
from ._recordings import write_recordings

Runs = Union[Series, Mapping[str, Series]]
Given = Union[PathLike, Sequence[PathLike], Runs]
Answer = TypeVar("Answer")


@dataclass(frozen=True)
class Told:
    """What is said about arrays; of a folder its recordings.toml says it."""

    noise: Mapping[str, float | None] | None = None
    inputs: Collection[str] | None = None
    holdout: Collection[str] = ()
    conditions: Mapping[str, Mapping[str, float]] | None = None

    def refuse(self) -> None:
        """Refuses what stands in the folder's recordings.toml."""
        said = [name for name in ("noise", "inputs", "holdout", "conditions") if getattr(self, name)]
        if said:
            raise ValueError(f"{', '.join(said)}: is for arrays\n  remedy: of a folder of recordings its recordings.toml says that")


@dataclass(frozen=True)
class Recorded:
    """Recordings that the program can read."""

    paths: list[PathLike]
    """Folders or files."""
    runs: dict[str, pd.DataFrame]
    """Each run by its name, if arrays were given."""
    answer: Path
    """Where the answer goes."""
    scratch: Path | None
    """A folder that goes with the answer; none if the caller has chosen where that goes."""

    @property
    def private(self) -> str | None:
        """The folder that messages need not name."""
        return str(self.scratch) if self.scratch is not None else None

    def goes_with(self, answer: Answer) -> Answer:
        """The answer, with which the scratch folder goes."""
        if self.scratch is not None:
            weakref.finalize(answer, shutil.rmtree, self.scratch, ignore_errors=True)
        return answer

    def __enter__(self) -> Recorded:
        return self

    def __exit__(self, error: object, *_: object) -> None:
        """Without an answer the scratch folder goes at once."""
        if error is not None and self.scratch is not None:
            shutil.rmtree(self.scratch, ignore_errors=True)


def recorded(given: Given, scene: PathLike | None, told: Told, command: str, out: PathLike | None) -> Recorded:
    """Folders and files as they stand; frames and arrays written down, in ``out`` or where nobody need look."""
    if not is_arrays(given):
        told.refuse()
        paths = _paths(cast("PathLike | Sequence[PathLike]", given))
        return Recorded(paths, {}, answer_folder(out, command, paths[0]), None)
    if scene is None:
        raise ValueError("scene: arrays do not name theirs\n  remedy: scene=NAME, one of smam.scenes(), or the path of yours")
    runs = frames(cast("Runs", given))
    inputs, outputs = channels(scene, runs, told)
    scratch = None if out is not None else Path(tempfile.mkdtemp(prefix="smam_"))
    folder = Path(out).absolute() if out is not None else cast("Path", scratch)
    try:
        path = write_recordings(
            folder / "recordings", scene, runs, inputs=inputs, outputs=outputs, holdout=told.holdout, conditions=told.conditions
        )
    except BaseException:
        if scratch is not None:
            shutil.rmtree(scratch, ignore_errors=True)
        raise
    return Recorded([path], runs, folder, scratch)


def single(given: PathLike | Series, command: str, out: PathLike | None) -> Recorded:
    """One file or folder as it stands; a frame or arrays as a file, in ``out`` or where nobody need look."""
    if not isinstance(given, (pd.DataFrame, Mapping)):
        return Recorded([given], {}, answer_folder(out, command, given), None)
    run = over_time(given)
    scratch = None if out is not None else Path(tempfile.mkdtemp(prefix="smam_"))
    folder = Path(out).absolute() if out is not None else cast("Path", scratch)
    folder.mkdir(parents=True, exist_ok=True)
    run.to_csv(folder / "run.csv")
    return Recorded([folder / "run.csv"], {"run": run}, folder, scratch)


def is_arrays(given: object) -> bool:
    return isinstance(given, (pd.DataFrame, Mapping))


def frames(given: Runs) -> dict[str, pd.DataFrame]:
    """Each run by its name; a single one is called ``run``."""
    several = isinstance(given, Mapping) and all(is_arrays(one) for one in given.values())
    if several and not given:
        raise ValueError("no runs given")
    runs = cast("Mapping[str, Series]", given) if several else {"run": cast("Series", given)}
    return {str(name): over_time(run) for name, run in runs.items()}


def channels(scene: PathLike, runs: Mapping[str, pd.DataFrame], told: Told) -> tuple[list[str], dict[str, float | None]]:
    """The columns that drive the scene, and those that are compared with it, with their noise.

    Without a word, those that the scene has; columns that it does not have are left out.
    """
    there = list(dict.fromkeys(column for run in runs.values() for column in run.columns))
    own = keys(scene)
    of = {kind: [name.strip('"') for key, name in own.items() if str(key).startswith(f"{kind}.") and str(key).endswith(".channel")]
          for kind in ("input", "output")}  # fmt: skip
    inputs = list(told.inputs) if told.inputs is not None else [column for column in of["input"] if column in there]
    if not inputs:
        raise ValueError(f"no column drives the scene: its inputs are {', '.join(of['input'])}; found: {', '.join(there)}")
    stated = dict(told.noise or {})
    unknown = [column for column in stated if column not in there]
    if unknown:
        raise ValueError(f"noise: there is no column {', '.join(unknown)}; found: {', '.join(there)}")
    outputs = [column for column in of["output"] if column in there and column not in inputs]
    outputs += [column for column in stated if column not in outputs]
    if not outputs:
        raise ValueError(f"no column is compared: the scene shows {', '.join(of['output'])}; found: {', '.join(there)}")
    return inputs, {column: stated.get(column) for column in outputs}


def _paths(given: PathLike | Sequence[PathLike]) -> list[PathLike]:
    paths = [given] if isinstance(given, (str, OsPathLike)) else list(given)
    if not paths:
        raise ValueError("no folder of recordings given")
    return paths
