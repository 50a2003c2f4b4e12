"""A disk that is full, a folder that may not be written, one that goes away."""

import os
import shutil
import subprocess
import time
from contextlib import contextmanager

from commands import COMMANDS, named, prepare
from common import CHECKS, check_journals, compare, complaint, content, end, files, has_ended, run, sane, start

NOBODY = 65534
# Of what an undisturbed run writes, there is room for so much.
SHARES = (0.05, 0.5, 0.9)
QUICK = [c for c in COMMANDS if c.share == 1.0]


@contextmanager
def small_disk(folder, size_bytes, options=""):
    """A file system of a size in the place of `folder`; false if this may not be done here."""
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size_bytes}{options}", "tmpfs", folder], capture_output=True).returncode == 0
    try:
        yield mounted
    finally:
        if mounted:
            subprocess.run(["umount", folder], check=True)


def size_of(folder):
    return sum(p.stat().st_size for p in folder.rglob("*") if p.is_file())


def whole_of(smam, command, place, recordings):
    """Folder and files of an undisturbed run."""
    folder = prepare(place / "whole", recordings)
    run([smam, *command.arguments], folder)
    return folder / "out", files(folder / "out")


def refused(done, folder, whole):
    """What is wrong where a result could not be written."""
    whole_out, expected = whole
    found = {n: c for n, c in files(folder / "out").items() if n not in ("journal.jsonl", "trial.jsonl")}
    return complaint(done, ["out", "standard output"]) + compare(found, expected) + check_journals(folder / "out", whole_out)


def full_disk(smam, command, place, recordings, whole):
    """A disk on which there is room for a part; the smallest and the largest parts are tried too."""
    total = size_of(whole[0])
    faults, count = [], 0
    last = [total - n * 4096 for n in (1, 2, 3)] if "rrd" in command.name else []
    for size in [4096, *(int(total * share) for share in SHARES), *last]:
        folder = prepare(place / "full", recordings)
        (folder / "out").mkdir()
        with small_disk(folder / "out", size // 4096 * 4096 + 4096) as mounted:
            if not mounted:
                shutil.rmtree(folder)
                return CHECKS.skip(f"full disk, {command.name}", "a small disk cannot be mounted: not root")
            done = run([smam, *command.arguments], folder)
            said = refused(done, folder, whole) if done.code != 0 else sane(done) + complete(folder, whole)
            count += done.code != 0
            faults += [f"{size} of {total} bytes: {fault}" for fault in said]
        shutil.rmtree(folder)
    CHECKS.add(f"full disk, {command.name}", faults, f"{count} disks were too small")


def complete(folder, whole):
    """A run that says it is done has written everything."""
    found = files(folder / "out")
    return compare(found, whole[1]) + [f"it says nothing, but {name} is missing" for name in whole[1].keys() - found.keys()]


def short_files(smam, command, place, recordings, whole):
    """Files that may not become longer than half of the largest one: a full disk for whoever is not root."""
    largest = max(p.stat().st_size for p in whole[0].rglob("*") if p.is_file())
    folder = prepare(place / "short", recordings)
    done = run([smam, *command.arguments], folder, file_bytes=largest // 2)
    CHECKS.add(f"files that cannot grow, {command.name}", refused(done, folder, whole))
    shutil.rmtree(folder)


def no_rights(smam, command, place, recordings, whole):
    """A folder that may be read and not written."""
    folder = prepare(place / "closed", recordings)
    (folder / "out").mkdir()
    (folder / "out").chmod(0o555)
    who = {"user": NOBODY, "group": NOBODY, "extra_groups": []} if os.geteuid() == 0 else {}
    try:
        done = run([smam, *command.arguments], folder, **who)
    except PermissionError:
        shutil.rmtree(folder)
        return CHECKS.skip(f"read-only folder, {command.name}", "another user cannot reach the program")
    (folder / "out").chmod(0o755)
    CHECKS.add(f"read-only folder, {command.name}", refused(done, folder, whole))
    shutil.rmtree(folder)


# Holds the program after every file that it names, so that the folder goes between two of them.
SLOWLY = ["strace", "-f", "-qq", "-o", "/dev/null", "-e", "trace=/^rename", "-e", "inject=/^rename:delay_exit=20000"]


def gone(smam, command, place, recordings, whole):
    """The folder goes away while the program works, or while it names its files: it comes back complete, or there is a complaint."""
    ways = [((), 0.0, False), ((), 0.02, False), ((), 0.05, False), ((), 0.1, False)]
    if shutil.which("strace"):
        ways += [(SLOWLY, 0.0, True), (SLOWLY, 0.01, True), (SLOWLY, 0.03, True)]
    faults, count = [], 0
    for traced, wait_s, is_named in ways:
        folder = prepare(place / "gone", recordings)
        process = start([*traced, smam, *command.arguments], folder)
        while not (any_result(folder) if is_named else (folder / "out").exists()) and not has_ended(process):
            time.sleep(0.001)
        time.sleep(wait_s)
        shutil.rmtree(folder / "out", ignore_errors=True)
        done = end(process)
        if done.code != 0:
            count += 1
            faults += refused(done, folder, whole)
        else:
            # It may have ended before the folder went.
            faults += sane(done) + (complete(folder, whole) if any((folder / "out").glob("*")) else [])
        shutil.rmtree(folder)
    CHECKS.add(f"folder that goes away, {command.name}", faults, f"{count} of {len(ways)} complained, the others had ended or made it again")


def any_result(folder):
    """Whether a file has its name by now (what is half written begins with a dot; made_from.txt comes before the work)."""
    return any(not p.name.startswith((".", "made_from")) for p in (folder / "out").glob("*"))


def in_the_way(smam, place, recordings):
    """A folder has the name of the file that shall be written, or a file that of the folder."""
    folder = prepare(place / "way", recordings)
    for name in ("a.csv", "a.parquet", "a.mcap", "a.rrd"):
        (folder / name).mkdir()
        option = "--rrd" if name.endswith("rrd") else "--output"
        done = run([smam, "run", "muscle_bench", option, name], folder)
        CHECKS.add(f"a folder has the name of {name}", complaint(done, [name]))
    (folder / "out").write_text("a file")
    for command in QUICK:
        done = run([smam, *command.arguments], folder)
        CHECKS.add(f"a file has the name of the folder, {command.name}", complaint(done, ["out"]))


def streams(smam, place, recordings):
    """Standard output, error and input that are closed, full, or read by somebody who goes."""
    folder = prepare(place / "streams", recordings)
    run([smam, "run", "muscle_bench", "--output", "whole.csv"], folder)
    whole = content(folder / "whole.csv")
    listing = f"'{smam}' check muscle_bench --keys"
    for name, line, codes in (
        ("reader that goes after a line", f"{listing} | head -n 1 >/dev/null; exit ${{PIPESTATUS[0]}}", (0,)),
        ("reader that is gone", f"{listing} | true; exit ${{PIPESTATUS[0]}}", (0,)),
        ("closed standard output", f"{listing} >&-", (0,)),
        ("full standard output", f"{listing} >/dev/full", (1,)),
        ("full standard output, diagnose", f"'{smam}' diagnose rec --out out >/dev/full", (1,)),
        ("reader that is gone, diagnose", f"'{smam}' diagnose rec --out out | true; exit ${{PIPESTATUS[0]}}", (0,)),
    ):
        done = run(["bash", "-c", line], folder)
        faults = sane(done) + ([] if done.code in codes else [f"exit code {done.code}: {done.err[-200:]!r}"])
        CHECKS.add(name, faults + ([] if 0 in codes else complaint(done, ["standard output"])))
    for name, to in (("closed standard error", "2>&-"), ("full standard error", "2>/dev/full"), ("reader of errors that is gone", "2>&1 >/dev/null | true")):
        done = run(["bash", "-c", f"'{smam}' run muscle_bench --output run.csv {to}; exit ${{PIPESTATUS[0]}}"], folder)
        same = (folder / "run.csv").exists() and content(folder / "run.csv") == whole
        CHECKS.add(name, sane(done) + ([] if done.code == 0 and same else [f"exit code {done.code}, result {'whole' if same else 'not there'}"]))
        (folder / "run.csv").unlink(missing_ok=True)
    done = run(["bash", "-c", f"'{smam}' run muscle_bench --output run.csv <&-"], folder)
    CHECKS.add("closed standard input", [] if done.code == 0 and content(folder / "run.csv") == whole else [f"exit code {done.code}: {done.err!r}"])


def check(smam, place, recordings, is_long):
    """Everything about where results go."""
    for command in [*QUICK, *([named("proof")] if is_long else [])]:
        own = place / command.name.replace(" ", "_").replace(",", "")
        whole = whole_of(smam, command, own, recordings)
        if command.share == 1.0:
            full_disk(smam, command, own, recordings, whole)
            gone(smam, command, own, recordings, whole)
        short_files(smam, command, own, recordings, whole)
        no_rights(smam, command, own, recordings, whole)
    in_the_way(smam, place, recordings)
    streams(smam, place, recordings)
