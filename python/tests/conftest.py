"""Every test runs in an empty folder of its own, whose path has what breaks careless programs."""

from pathlib import Path

import pytest


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    path = tmp_path / "Rübe & Söhne, Prüfstand 1"
    path.mkdir()
    monkeypatch.chdir(path)
    return path
