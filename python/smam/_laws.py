"""Laws of your own: expressions that act at ports of the chain."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Union

from ._toml import value

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

Law = Union[str, Mapping[str, Any]]
"""``"PORT adds EXPRESSION"``, ``"PORT scales EXPRESSION"``, or a ``[[law]]`` table with ``name``, ``port``, ``adds`` or ``scales``,
``parameter``, ``state``, ``when``."""

_REMEDY = "\n  remedy: write 'PORT adds EXPRESSION' or 'PORT scales EXPRESSION', or a table with name, port, adds or scales"


def law_overrides(laws: Iterable[Law] | None) -> list[str]:
    """``law.NAME={...}``, as ``--set`` and sweeps take them. Short ones are called law_1, law_2 and so on."""
    if isinstance(laws, (str, Mapping)):
        raise TypeError("laws is one law, not a list of laws\n  remedy: write laws=[...]")
    given = list(laws or [])
    short = [law for law in given if isinstance(law, str)]
    named = [(f"law_{i}", _short(law)) for i, law in enumerate(short, 1)]
    tables = [_named(law) for law in given if not isinstance(law, str)]
    return [f"law.{name}={value(table)}" for name, table in [*named, *tables]]


def law_arguments(laws: Iterable[Law] | None) -> list[str]:
    """``--set law.NAME={...}`` for each."""
    return [word for text in law_overrides(laws) for word in ("--set", text)]


def laws_of_scene(path: Path) -> list[dict[str, Any]]:
    """The ``[[law]]`` tables of a scene file."""
    with path.open("rb") as file:
        return list(tomllib.load(file).get("law", []))


def _short(text: str) -> dict[str, str]:
    words = text.split(None, 2)
    if len(words) != 3 or words[1] not in ("adds", "scales"):
        raise ValueError(f"{text!r} is no law{_REMEDY}")
    port, acts, expression = words
    return {"port": port, acts: expression}


def _named(law: Mapping[str, Any]) -> tuple[str, dict[str, Any]]:
    table = dict(law)
    name = table.pop("name", None)
    if not isinstance(name, str):
        raise ValueError(f"a law has no name: {table}{_REMEDY}")
    return name, table
