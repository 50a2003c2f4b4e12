"""What the program opens to the network: looked at while it runs."""

import os
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import time
from pathlib import Path

# Recordings to diagnose: more friction than the scene says.
SET = """format = 1
scene = "muscle_bench"
[[channel]]
column = "plunger_mm"
role = "input"
[[channel]]
column = "elongation_mm"
role = "output"
noise_sd = 0.02
[[run]]
file = "a.csv"
[[run]]
file = "b.csv"
"""
MAKE = ["run", "muscle_bench", "--duration", "6", "--set", "simulation.output_interval_s=0.05", "--set", "muscles.friction.m0_n=0.2"]
SWEEP = ["sweep", "muscle_bench", "--vary", "muscles.friction.m0_n=0.1:0.3:2", "--measure", "range_mm=range(elongation_mm)", "--duration", "2"]
# None of them has anything to say to another machine, or to another program on this one.
SILENT = [["run", "muscle_bench", "--duration", "2"], ["diagnose", "rec", "--rrd", "--out", "found"], [*SWEEP, "--out", "swept"]]
# Where the viewer's library would report its use to: in its sources, and to be in no program of ours.
REPORTED_TO = b"tel.rerun.io"
CALL = re.compile(r"\b(?:socket|connect|bind|listen|sendto)\(.*")
LIMIT_S = 120


def reporting(smam):
    """Faults of a program that could report its use."""
    found = REPORTED_TO in Path(smam).read_bytes()
    return [f"{smam} contains {REPORTED_TO.decode()}: the viewer's library could report usage"] if found else []


def address(field):
    """`0100007F:2694` of /proc/net/tcp as (127.0.0.1, 9876)."""
    host, port = field.split(":")
    words = [struct.pack("=I", int(host[i : i + 8], 16)) for i in range(0, len(host), 8)]
    return socket.inet_ntop(socket.AF_INET6 if len(words) == 4 else socket.AF_INET, b"".join(words)), int(port, 16)


def sockets(pid):
    """Protocol and local address of every internet socket of a process."""
    own = set()
    try:
        for fd in Path(f"/proc/{pid}/fd").iterdir():
            own.add(os.readlink(fd))
    except OSError:
        return []  # closed, or ended, meanwhile: the caller looks again
    found = []
    for protocol in ("tcp", "tcp6", "udp", "udp6", "raw", "raw6"):
        table = Path(f"/proc/{pid}/net/{protocol}")
        for line in table.read_text().splitlines()[1:] if table.exists() else []:
            fields = line.split()
            if f"socket:[{fields[9]}]" in own:
                found.append((protocol, *address(fields[1])))
    return found


def loopback(host):
    return host.startswith("127.") or host == "::1"


def serve(smam, folder):
    """Faults of the viewer's server, and what it listened on; a reason to leave it out instead."""
    if not Path("/proc/self/net/tcp").exists():
        return None, "no /proc/net here"
    log = folder / "serve.log"
    with log.open("w") as out:
        process = subprocess.Popen([smam, "run", "muscle_bench", "--serve"], cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=out)
    try:
        until, found = time.monotonic() + LIMIT_S, []
        while process.poll() is None and not found and time.monotonic() < until:
            time.sleep(0.1)
            found = sockets(process.pid) if "serving until" in log.read_text() else []
        ended = process.poll()
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
    words = log.read_text()
    if ended is not None and ("leaves out" in words or "is not free" in words):
        return None, words.splitlines()[0]
    faults = [f"smam run --serve listens on {h}:{p} ({k}), not on loopback alone" for k, h, p in found if not loopback(h)]
    if not found:
        faults.append(f"smam run --serve opened no socket: {words}")
    return faults, ", ".join(f"{k} {h}:{p}" for k, h, p in found)


def traced(command, folder):
    """Exit code, words, and the calls that concern sockets."""
    trace = folder / "trace.txt"
    done = subprocess.run(
        ["strace", "-f", "-e", "trace=%network", "-o", str(trace), *command], cwd=folder, capture_output=True, text=True, timeout=LIMIT_S
    )
    calls = [m[0] for m in map(CALL.search, trace.read_text().splitlines() if trace.exists() else []) if m]
    return done.returncode, done.stderr, calls


def silent(smam, folder):
    """Faults of commands that have no business with the network; a reason to leave it out instead."""
    if shutil.which("strace") is None:
        return None, "strace is not installed"
    # That a socket would be seen.
    if not traced([sys.executable, "-c", "import socket; socket.socket()"], folder)[2]:
        return None, "strace cannot look into programs here"
    for name in ("a", "b"):
        subprocess.run([smam, *MAKE, "--output", f"rec/{name}.csv"], cwd=folder, capture_output=True, check=True, timeout=LIMIT_S)
    (folder / "rec" / "recordings.toml").write_text(SET)
    faults = []
    for command in SILENT:
        code, words, calls = traced([smam, *command], folder)
        if code != 0:
            faults.append(f"smam {command[0]} ended with exit code {code}: {words}")
        faults += [f"smam {command[0]}: {call}" for call in calls]
    return faults, f"no socket in {', '.join(c[0] for c in SILENT)}"


def self_test():
    assert address("0100007F:2694") == ("127.0.0.1", 9876) and address("00000000:0050") == ("0.0.0.0", 80)
    assert address("00000000000000000000000001000000:0050") == ("::1", 80)
    assert loopback("127.0.0.1") and loopback("::1") and not loopback("0.0.0.0") and not loopback("::")
    assert CALL.search("7 socket(AF_INET, SOCK_STREAM, 0) = 3") and not CALL.search("7 +++ exited with 0 +++")
