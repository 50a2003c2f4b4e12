"""The examples run as they stand, and draw. SMAM_EXAMPLES: the folder that they are in."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(os.environ.get("SMAM_EXAMPLES", Path(__file__).resolve().parents[2] / "examples" / "python"))


@pytest.mark.parametrize(
    ("name", "expected"),
    [("pre_elongation", "best: 55% with 13"), ("diagnose_my_csv", "missing_physics\nThe scene lacks leak in line.")],
)
def test_an_example_runs(name: str, expected: str) -> None:
    pytest.importorskip("matplotlib")
    done = subprocess.run(
        [sys.executable, EXAMPLES / f"{name}.py", "figure.png"],
        env={**os.environ, "MPLBACKEND": "Agg"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert expected in done.stdout
    assert Path("figure.png").read_bytes().startswith(b"\x89PNG")
