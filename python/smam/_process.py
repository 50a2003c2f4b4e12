"""Running the program: its progress passes through, Ctrl-C stops it, its errors become exceptions."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from typing import IO, Union

from ._errors import SmamError
from ._program import find_program
from ._relay import Relay

Word = Union[str, "os.PathLike[str]"]


@dataclass(frozen=True)
class Finished:
    """What a program that has ended leaves."""

    exit_code: int
    stdout: str


def call(words: Sequence[Word], also_fine: Sequence[int] = (), private: str | None = None) -> Finished:
    """Runs ``smam WORDS`` to its end. Exit codes other than 0 are errors, but those in ``also_fine`` only with a message.

    Lines that name the folder ``private`` are not passed on.
    """
    command = [str(find_program()), *(os.fspath(word) for word in words)]
    relay = Relay(private)
    stdout: list[bytes] = []
    ours, theirs = _error_channel()
    try:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=theirs)
    except OSError as error:
        os.close(ours)
        raise SmamError(f"{command[0]}: cannot be started: {error}\n  remedy: set SMAM to the path of smam", 127) from error
    finally:
        os.close(theirs)
    assert process.stdout is not None
    readers = [
        threading.Thread(target=relay.read, args=(ours,), daemon=True),
        threading.Thread(target=_collect, args=(process.stdout, stdout), daemon=True),
    ]
    for reader in readers:
        reader.start()
    try:
        exit_code = process.wait()
    except BaseException:
        _stop(process)
        raise
    finally:
        # A viewer that the program has opened keeps these open: do not wait for its window to close.
        for reader in readers:
            reader.join(timeout=2.0)
        if not readers[0].is_alive():
            os.close(ours)
    if exit_code != 0 and (relay.has_error or exit_code not in also_fine):
        raise SmamError(relay.error() or f"smam {words[0]} ended with exit code {exit_code}\n{relay.last_words()}", exit_code)
    if relay.has_error and sys.stderr is not None:  # kept for an exception that is none
        print(f"error: {relay.error()}", file=sys.stderr)
    return Finished(exit_code, b"".join(stdout).decode("utf-8", "replace"))


def _collect(source: IO[bytes], into: list[bytes]) -> None:
    with source:
        for chunk in source:
            into.append(chunk)


def _stop(process: subprocess.Popen[bytes]) -> None:
    """Ctrl-C at a terminal reaches the program too: leave it time to write what it has. A notebook's does not: tell it."""
    try:
        for tell, patience_s in ((None, 2.0), (process.terminate, 3.0)):
            if tell is not None:
                tell()
            try:
                process.wait(patience_s)
                return
            except subprocess.TimeoutExpired:
                pass
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()


def _error_channel() -> tuple[int, int]:
    """Our end and the program's of its standard error: a terminal if ours is one, so that it draws its progress bars."""
    if os.name == "posix" and sys.stderr is not None and sys.stderr.isatty():
        try:
            return _terminal()
        except OSError:
            pass  # none to be had: a pipe will do
    return os.pipe()


def _terminal() -> tuple[int, int]:
    import fcntl
    import pty
    import struct
    import termios

    ours, theirs = pty.openpty()
    attributes = termios.tcgetattr(theirs)
    attributes[1] &= ~termios.OPOST  # the real terminal turns line ends into what it needs
    termios.tcsetattr(theirs, termios.TCSANOW, attributes)
    try:
        size = os.get_terminal_size(sys.stderr.fileno())
    except (OSError, ValueError):
        size = os.terminal_size((80, 24))
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", size.lines, size.columns, 0, 0))
    return ours, theirs
