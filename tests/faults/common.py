"""What all checks share: running the program, and knowing which files it left."""

import hashlib
import os
import re
import resource
import signal
import subprocess
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

# How the program calls what has no name yet.
PARTIAL = re.compile(r"\.smam-\w+\.partial$")
# The only files that grow under their name: a line for each point or case.
JOURNALS = ("journal.jsonl", "trial.jsonl")
MOST_MEMORY_KB = 1 << 20
LIMIT_S = 300


@dataclass
class Done:
    """How a run of the program ended."""

    code: int
    out: str
    err: str
    seconds: float
    memory_kb: int
    cpu_s: float
    timed_out: bool


@dataclass
class Checks:
    """What was checked: one line each, and the faults."""

    faults: list[str] = field(default_factory=list)
    cpu_s: float = 0.0

    def add(self, name, faults, what=""):
        """Prints a check's line; `faults` says what is wrong, and is empty if nothing is."""
        print(f"{'FAIL' if faults else 'ok  '}  {name}{': ' + what if what else ''}", flush=True)
        self.faults += [f"{name}: {fault}" for fault in faults]

    def skip(self, name, why):
        print(f"skip  {name}: {why}", flush=True)


CHECKS = Checks()


def limits(file_bytes, memory_bytes):
    """Limits that the program is started under. A file that becomes too long is an error, as on a full disk, and no signal."""

    def apply():
        if file_bytes is not None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (file_bytes, file_bytes))
        if memory_bytes is not None:
            resource.setrlimit(resource.RLIMIT_AS, (memory_bytes, memory_bytes))

    return apply if file_bytes is not None or memory_bytes is not None else None


def start(command, cwd, env=None, file_bytes=None, memory_bytes=None, **more):
    """Starts the program; what it says goes to files beside `cwd`, so that no pipe can fill up."""
    said = {"stdout": open(f"{cwd}.out", "w+"), "stderr": open(f"{cwd}.err", "w+"), "stdin": subprocess.DEVNULL}
    told = {name: more.pop(name, file) for name, file in said.items()}
    environment = {**os.environ, **(env or {})}
    process = subprocess.Popen(
        [str(part) for part in command], cwd=cwd, env=environment, preexec_fn=limits(file_bytes, memory_bytes), **told, **more
    )
    process.said, process.begun = said, time.monotonic()
    return process


def has_ended(process):
    """Whether a process has ended, without taking its exit code from `end`."""
    return os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None


def end(process, limit_s=LIMIT_S):
    """Waits for a process; one that takes too long is killed."""
    late = threading.Event()

    def kill():
        late.set()
        os.kill(process.pid, signal.SIGKILL)

    timer = threading.Timer(limit_s, kill)
    timer.start()
    _, status, used = os.wait4(process.pid, 0)
    timer.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    texts = []
    for file in (process.said["stdout"], process.said["stderr"]):
        file.seek(0)
        texts.append(file.read())
        file.close()
    cpu_s = used.ru_utime + used.ru_stime
    CHECKS.cpu_s += cpu_s
    return Done(process.returncode, *texts, time.monotonic() - process.begun, used.ru_maxrss, cpu_s, late.is_set())


def run(command, cwd, limit_s=LIMIT_S, **how):
    """Runs the program to its end."""
    return end(start(command, cwd, **how), limit_s)


def content(path):
    """What must be the same whenever a file is written: its bytes, but for what it says of how long something took."""
    data = path.read_bytes()
    if path.suffix == ".rrd":
        # Streams hold the time of day and random names: whole or not is all that can be asked.
        return "whole stream" if data[:4] == b"RRF2" and data[-12:-4] == b"RRF2FOOT" else f"half a stream, {len(data)} bytes"
    if path.name == "seconds.txt":
        return "seconds" if re.fullmatch(rb"\d+\.\d+\n", data) else repr(data)
    if path.name in ("rows.jsonl", "trial.jsonl"):
        data = re.sub(rb'"seconds":[\d.e-]+', b'"seconds":0', data)
    if path.name in ("table.md", "score.json"):
        # How many cases were answered within 30 s, as a row of the table and as an object.
        data = re.sub(rb'\| bench cases answered within.*\n|\{[^{}]*"bench cases answered within[^{}]*\}', b"", data)
    if path.name in JOURNALS:
        # Points end in any order.
        data = b"".join(sorted(data.splitlines(keepends=True)))
    return hashlib.sha256(data).hexdigest()


def files(folder):
    """Content of every file that has its name, by its path from `folder`."""
    found = [p for p in Path(folder).rglob("*") if p.is_file() and not p.is_symlink() and not PARTIAL.search(p.name)]
    return {p.relative_to(folder).as_posix(): content(p) for p in found}


def partials(folder):
    """Files without a name yet."""
    return [p for p in Path(folder).rglob("*") if PARTIAL.search(p.name)]


def compare(found, expected):
    """Files that are not as expected; one that is missing is none."""
    return [
        f"{name} is {'not that of an undisturbed run' if name in expected else 'no file of an undisturbed run'} ({value[:40]})"
        for name, value in found.items()
        if value != expected.get(name)
    ]


def check_journals(folder, whole):
    """Every whole line of a journal is one of the undisturbed run."""
    faults = []
    for path in (p for name in JOURNALS for p in Path(folder).rglob(name)):
        known = lines(whole / path.relative_to(folder))
        odd = [line for line in lines(path)[: path.read_bytes().count(b"\n")] if line not in known]
        faults += [f"{path.name} holds a line that an undisturbed run does not write: {line[:80]}" for line in odd]
    return faults


def lines(path):
    return [re.sub(r'"seconds":[\d.e-]+', "", line) for line in path.read_text().splitlines()] if path.exists() else []


def complaint(done, names):
    """What is wrong with how the program refused: exit code, a message that names one of the files and a way out, no panic."""
    faults = sane(done)
    if done.code not in (1, 2):
        faults.append(f"exit code {done.code} instead of 1 or 2; it said: {done.err[-200:]!r}")
    message = done.err[done.err.find("error:") :] if "error:" in done.err else ""
    if not any(str(name) in message for name in names):
        faults.append(f"its message names none of {', '.join(map(str, names))}: {done.err[-300:]!r}")
    if not re.search(r"remedy:|check the folder|see .--help|; name the", message):
        faults.append(f"its message says no way out: {done.err[-300:]!r}")
    return faults


def sane(done):
    """What must hold however a run ends."""
    faults = []
    if "panicked at" in done.err or done.code < 0 and not done.timed_out:
        faults.append(f"ended by a panic or signal (code {done.code}): {done.err[-300:]!r}")
    if done.timed_out:
        faults.append(f"hung: killed after {done.seconds:.0f} s")
    if done.memory_kb > MOST_MEMORY_KB:
        faults.append(f"took {done.memory_kb >> 10} MiB of memory")
    return faults

