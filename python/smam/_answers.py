"""Folders that the program writes its answers to."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, cast

from ._frames import PathLike


def answer_folder(out: PathLike | None, command: str, recordings: PathLike) -> Path:
    """``out``, or what the program takes by itself: ``out/diagnose_NAME``. Absolute, so that it stays right."""
    name = Path(recordings).resolve().stem if Path(recordings).is_file() else Path(recordings).resolve().name
    chosen: Path | PathLike = out if out is not None else Path("out", f"{command}_{name}")
    return Path(chosen).absolute()


def read_json(path: Path) -> dict[str, Any]:
    return cast("dict[str, Any]", json.loads(path.read_text(encoding="utf-8")))
