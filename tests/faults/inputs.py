"""Recordings that are none: pipes, devices, folders, a file of one line, one that changes while it is read."""

import os
import shutil
import time
from pathlib import Path

from commands import RECORDINGS, prepare
from common import CHECKS, complaint, content, end, run, sane, start

LONG_BYTES = 1 << 30
LIMIT_S = 10
# An attack is not to take the machine with it, should the program read on and on.
MOST_BYTES = 6 << 30


def refused(smam, folder, name, arguments, names):
    """Exit code, message, memory and time of a run on what is no recording."""
    done = run([smam, *arguments], folder, limit_s=LIMIT_S, memory_bytes=MOST_BYTES)
    CHECKS.add(name, complaint(done, names), f"exit code {done.code} after {done.seconds:.1f} s, {done.memory_kb >> 10} MiB")


def recordings_with(folder, name, run_file):
    """A folder of recordings whose one run is a link to what is no recording."""
    own = folder / name
    own.mkdir()
    ending = Path(run_file).suffix or ".csv"
    (own / f"a{ending}").symlink_to(run_file)
    (own / "recordings.toml").write_text(RECORDINGS.replace("a.csv", f"a{ending}").split('\n[[run]]\nfile = "b.csv"')[0])
    return f"a{ending}"


def no_files(smam, folder):
    """Pipes, devices and folders in every place where a file is read."""
    for ending in (".csv", ".parquet", ".mcap"):
        os.mkfifo(folder / f"pipe{ending}")
        (folder / f"folder{ending}").mkdir()
        (folder / f"zero{ending}").symlink_to("/dev/zero")
        for kind in ("pipe", "folder", "zero"):
            file = f"{kind}{ending}"
            refused(smam, folder, f"run --input {file}", ["run", "muscle_bench", "--input", file, "--output", "x.csv"], [file])
            own = recordings_with(folder, f"set_{kind}{ending[1:]}", folder / file)
            refused(smam, folder, f"diagnose, a run is {file}", ["diagnose", f"set_{kind}{ending[1:]}", "--out", "out"], [own])
    refused(smam, folder, "run --input /dev/full", ["run", "muscle_bench", "--input", "/dev/full", "--output", "x.csv"], ["/dev/full"])
    refused(smam, folder, "identify a device", ["identify", "/dev/zero", "--out", "out"], ["/dev/zero"])
    for kind in ("pipe", "zero"):
        own = folder / f"toml_{kind}"
        own.mkdir()
        (own / "recordings.toml").symlink_to(folder / f"{kind}.csv")
        refused(smam, folder, f"recordings.toml is a {kind}", ["diagnose", own.name, "--out", "out"], ["recordings.toml"])
        (folder / f"{kind}.toml").symlink_to(folder / f"{kind}.csv")
        refused(smam, folder, f"the scene is a {kind}", ["run", f"{kind}.toml", "--output", "x.csv"], [f"{kind}.toml"])
        refused(smam, folder, f"the sweep is a {kind}", ["sweep", f"{kind}.toml", "--out", "out"], [f"{kind}.toml"])


def one_line(smam, folder):
    """A gigabyte without a line end, as the header and as the second line."""
    for name, head in (("header", b""), ("second line", b"time_s,plunger_mm\n0,0")):
        with open(folder / "long.csv", "wb") as file:
            file.write(head)
            for _ in range(LONG_BYTES >> 20):
                file.write(b"1" * (1 << 20))
        refused(smam, folder, f"1 GiB in one line, the {name}", ["run", "muscle_bench", "--input", "long.csv", "--output", "x.csv"], ["long.csv"])
    (folder / "long.toml").symlink_to("long.csv")
    refused(smam, folder, "a scene of 1 GiB", ["run", "long.toml", "--output", "x.csv"], ["long.toml"])
    (folder / "long.csv").unlink()


def changing(smam, folder):
    """A recording that is cut, or grows, while it is read: used as it was, or refused; half a number is never taken for one."""
    if shutil.which("strace") is None:
        return CHECKS.skip("a recording that changes while it is read", "strace is not installed")
    path = folder / "live.csv"
    text = "time_s,plunger_mm\n" + "".join(f"{n / 100},{n / 1000 + 0.0001234:.7f}\n" for n in range(1000))
    command = [smam, "run", "muscle_bench", "--input", "live.csv", "--output", "x.csv"]
    path.write_text(text)
    run(command, folder)
    expected = content(folder / "x.csv")
    # The read waits until the file is another one than the one that was opened.
    slowly = ["strace", "-f", "-qq", "-o", "/dev/null", "-P", path.resolve(), "-e", "trace=read", "-e", "inject=read:delay_enter=700000:when=1"]
    for name, after in (("cut within a number", text[:-6]), ("that has grown by a row", text + "10.0,1.0\n"), ("that has grown by half a row", text + "10.0,1")):
        path.write_text(text)
        (folder / "x.csv").unlink(missing_ok=True)
        process = start([*slowly, *command], folder)
        time.sleep(0.35)
        os.truncate(path, min(len(after), len(text)))
        with open(path, "a") as file:
            file.write(after[len(text) :])
        done = end(process, LIMIT_S)
        if done.code == 0:
            faults = sane(done) + ([] if content(folder / "x.csv") == expected else ["its result is another one, without a word"])
        else:
            faults = complaint(done, ["live.csv"]) + (["a result was written"] if (folder / "x.csv").exists() else [])
        CHECKS.add(f"a recording {name} while it is read", faults, "used as it was" if done.code == 0 else "refused")


def check(smam, place, recordings, is_long):
    """Everything about what is read."""
    folder = prepare(place, recordings)
    no_files(smam, folder)
    one_line(smam, folder)
    changing(smam, folder)
