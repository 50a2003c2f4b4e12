"""What there is: scenes, effects, keys."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pandas as pd

from ._frames import PathLike
from ._process import call
from ._toml import set_arguments


def scenes() -> pd.DataFrame:
    """The scenes that come with the program: ``name`` and ``title``."""
    return _table("scenes", ["name", "title"])


def effects() -> pd.DataFrame:
    """The physics that a scene may leave out: ``name``, ``element`` and ``title``. Two laws may share a name."""
    return _table("effects", ["name", "element", "title"])


def keys(scene: PathLike, *, set: Mapping[str, Any] | None = None) -> pd.Series[str]:
    """Every key of a scene that ``set`` and ``vary`` take, with its value as the scene file writes it."""
    lines = call(["check", scene, "--keys", *set_arguments(set)]).stdout.splitlines()
    pairs = [line.split(" = ", 1) for line in lines]
    return pd.Series([value for _, value in pairs], index=[key for key, _ in pairs], name="value")


def _table(command: str, columns: list[str]) -> pd.DataFrame:
    """Lines of words apart by blanks, up to the empty line; the last column takes the rest of the line."""
    listed = call([command]).stdout.split("\n\n", 1)[0]
    rows = [line.split(None, len(columns) - 1) for line in listed.splitlines()]
    return pd.DataFrame(rows, columns=columns)
