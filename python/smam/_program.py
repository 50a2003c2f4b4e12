"""Where the program is."""

from __future__ import annotations

import os
import shutil
import sys
import sysconfig
from collections.abc import Iterator
from pathlib import Path

from ._errors import SmamError

_NAME = "smam.exe" if os.name == "nt" else "smam"


def find_program() -> Path:
    """The program that ``SMAM`` names, else the one installed with this module, else the first on ``PATH``."""
    named = os.environ.get("SMAM")
    if named:
        # Absolute: the caller may change its folder.
        path = Path(shutil.which(named) or named).absolute()
        if not path.is_file():
            raise SmamError(f"SMAM={named}: there is no such program\n  remedy: give its path, or unset SMAM", 127)
        return path
    for folder in _folders():
        if (folder / _NAME).is_file():
            return folder / _NAME
    on_path = shutil.which(_NAME)
    if on_path:
        return Path(on_path).absolute()
    looked = ", ".join(str(folder) for folder in _folders())
    raise SmamError(
        f"the program smam was not found in {looked}, nor on PATH\n"
        "  remedy: install the wheel (pip install smam-*.whl) into this Python, "
        "or set the environment variable SMAM to the path of the program",
        127,
    )


def _folders() -> Iterator[Path]:
    """Where installers put the scripts of a wheel."""
    yield Path(sysconfig.get_path("scripts"))
    yield Path(sysconfig.get_path("scripts", sysconfig.get_preferred_scheme("user")))
    # pip install --target DIR: scripts in DIR/bin.
    yield Path(__file__).parents[1] / ("Scripts" if sys.platform == "win32" else "bin")
