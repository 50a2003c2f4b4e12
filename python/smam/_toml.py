"""Values as TOML takes them."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np


def value(of: Any) -> str:
    """A number, word, list or table on one line."""
    if isinstance(of, np.ndarray):
        of = of.tolist()
    elif isinstance(of, np.generic):
        of = of.item()
    if isinstance(of, bool):
        return "true" if of else "false"
    if isinstance(of, (int, float)):
        return repr(of)
    if isinstance(of, (str, os.PathLike)):
        return json.dumps(os.fspath(of), ensure_ascii=False)
    if isinstance(of, Mapping):
        return "{ " + ", ".join(f"{_key(k)} = {value(v)}" for k, v in of.items()) + " }"
    if isinstance(of, Iterable):
        return "[" + ", ".join(value(item) for item in of) + "]"
    raise TypeError(f"{of!r} is a {type(of).__name__}; a scene holds numbers, words, lists and tables of these")


def document(tables: Mapping[str, Any]) -> str:
    """Plain keys first, then each table, and each list of tables, under its heading."""
    plain = {k: v for k, v in tables.items() if not _is_table(v) and not _is_tables(v)}
    lines = _lines(plain)
    for name, content in tables.items():
        if _is_table(content):
            lines += ["", f"[{_key(name)}]", *_lines(content)]
        elif _is_tables(content):
            for table in content:
                lines += ["", f"[[{_key(name)}]]", *_lines(table)]
    return "\n".join(lines) + "\n"


def overrides(changes: Mapping[str, Any] | None) -> list[str]:
    """``KEY=VALUE``, as ``--set`` and sweeps take them."""
    return [f"{key}={value(changed)}" for key, changed in (changes or {}).items()]


def set_arguments(changes: Mapping[str, Any] | None) -> list[str]:
    """``--set KEY=VALUE`` for each."""
    return [word for text in overrides(changes) for word in ("--set", text)]


def _lines(table: Mapping[str, Any]) -> list[str]:
    return [f"{_key(k)} = {value(v)}" for k, v in table.items()]


def _key(name: str) -> str:
    bare = name.replace("_", "").replace("-", "")
    return name if bare.isascii() and bare.isalnum() else value(name)


def _is_table(of: Any) -> bool:
    return isinstance(of, Mapping)


def _is_tables(of: Any) -> bool:
    return isinstance(of, list) and bool(of) and all(isinstance(item, Mapping) for item in of)
