"""Simulate soft microtubule artificial muscles, and find the physics that recordings show and a model lacks.

A thin layer over the program ``smam``: every function starts it and turns what it writes into pandas frames.
Columns carry their unit in their name (``elongation_mm``, ``pressure_kpa``).
"""

from importlib.metadata import PackageNotFoundError, version

from ._compare import Comparison, compare
from ._diagnose import Diagnosis, diagnose
from ._errors import SmamError
from ._feedforward import feedforward
from ._identify import Identification, identify
from ._laws import Law
from ._lists import effects, keys, scenes
from ._recordings import write_recordings
from ._run import run
from ._sweep import sweep

try:
    __version__ = version("smam")
except PackageNotFoundError:  # imported from the source tree
    __version__ = "0"

__all__ = [
    "Comparison",
    "Diagnosis",
    "Identification",
    "Law",
    "SmamError",
    "compare",
    "diagnose",
    "effects",
    "feedforward",
    "identify",
    "keys",
    "run",
    "scenes",
    "sweep",
    "write_recordings",
]
