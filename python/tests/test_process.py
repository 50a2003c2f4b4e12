"""The program as a process: found, interrupted, started as a module; what it says on the way."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import smam
from smam._program import find_program
from smam._relay import Relay

LONG = "import smam; print('begun', flush=True); smam.run('muscle_bench', duration_s=2e4, output='long.csv')"
posix = pytest.mark.skipif(os.name != "posix", reason="signals and terminals of POSIX")


def start_long_run() -> subprocess.Popen[str]:
    """Python that runs a scene for minutes, with all its children in a process group of their own."""
    process = subprocess.Popen(
        [sys.executable, "-c", LONG], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "begun\n"
    # Rows are on their way once there is a file for them, under another name until it is whole.
    for _ in range(200):
        if any(Path.cwd().iterdir()):
            break
        time.sleep(0.05)
    time.sleep(0.3)
    assert process.poll() is None
    return process


def nobody_is_left(group: int) -> bool:
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return True
    return False


@posix
@pytest.mark.parametrize("everybody", [True, False], ids=["at a terminal", "in a notebook"])
def test_ctrl_c_stops_the_program(everybody: bool) -> None:
    process = start_long_run()
    # A terminal interrupts the whole group, a notebook Python alone.
    (os.killpg if everybody else os.kill)(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=15)
    assert process.returncode != 0
    assert "KeyboardInterrupt" in said
    assert nobody_is_left(process.pid)
    # It was told, not killed: what was computed is there.
    assert Path("long.csv").read_text(encoding="utf-8").startswith("time_s,plunger_mm")


@posix
def test_a_program_that_is_killed_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    killed = tmp_path / "smam"
    killed.write_text("#!/bin/sh\necho 'note: half way' >&2\nkill -KILL $$\n", encoding="utf-8")
    killed.chmod(0o755)
    monkeypatch.setenv("SMAM", str(killed))
    with pytest.raises(smam.SmamError) as raised:
        smam.diagnose("rig")
    assert str(raised.value) == "smam diagnose ended with exit code -9\nnote: half way"


def test_as_a_module_it_is_the_program() -> None:
    version = subprocess.run([sys.executable, "-m", "smam", "--version"], capture_output=True, text=True, check=True)
    assert version.stdout.startswith("smam ")
    wrong = subprocess.run([sys.executable, "-m", "smam", "run", "no_such_scene"], capture_output=True, text=True)
    assert wrong.returncode == 2
    assert "no scene named" in wrong.stderr


def test_versions_of_module_and_program_agree() -> None:
    if smam.__version__ == "0":
        pytest.skip("imported from the source tree")
    version = subprocess.run([find_program(), "--version"], capture_output=True, text=True, check=True).stdout
    assert version.split() == ["smam", smam.__version__]


def test_what_to_do_when_there_is_no_program(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SMAM", "/no/such/smam")
    with pytest.raises(smam.SmamError, match="SMAM=/no/such/smam") as raised:
        smam.scenes()
    assert raised.value.exit_code == 127
    monkeypatch.delenv("SMAM")
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr("smam._program._folders", lambda: iter([Path("empty")]))
    with pytest.raises(smam.SmamError, match="was not found in empty, nor on PATH") as raised:
        smam.scenes()
    assert raised.value.remedy is not None and "SMAM" in raised.value.remedy


@posix
def test_at_a_terminal_the_program_draws_its_progress() -> None:
    import pty

    ours, theirs = pty.openpty()
    code = "import smam; smam.sweep('muscle_bench', {'muscles.friction.m0_n': [0.1, 0.2]}, {'a_mm': 'max(elongation_mm)'})"
    process = subprocess.Popen([sys.executable, "-c", code], stderr=theirs)
    os.close(theirs)
    said = b""
    try:
        while chunk := os.read(ours, 4096):
            said += chunk
    except OSError:
        pass  # the terminal is closed
    os.close(ours)
    assert process.wait() == 0
    assert b"/2 points" in said


@pytest.mark.parametrize("size", [1, 3, 1000])
def test_the_error_is_kept_and_the_rest_passed_on(size: int, capsys: pytest.CaptureFixture[str]) -> None:
    relay = Relay(private="/tmp/smam_x")
    text = "baseline\nrecording: /tmp/smam_x/run.csv\n\x1b[2K[==>  ]\r\x1b[2Kerror: a: b\n  remedy: error: c\n"
    for at in range(0, len(text), size):
        relay.take(text[at : at + size])
    assert capsys.readouterr().err == "baseline\n\x1b[2K[==>  ]\r\x1b[2K"
    assert relay.error() == "a: b\n  remedy: error: c"
