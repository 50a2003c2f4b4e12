"""A clock that is wrong, and one that jumps while the program runs."""

import shutil
import time
from pathlib import Path

from commands import named, prepare
from common import CHECKS, compare, end, files, run, sane, start


def library():
    """libfaketime, where Debian puts it."""
    return next(iter(sorted(Path("/usr/lib").glob("*/faketime/libfaketimeMT.so.1"))), None)


def check(smam, place, recordings, is_long):
    """Results do not depend on the time of day, nor on one that goes backwards."""
    if (found := library()) is None:
        return CHECKS.skip("a clock that jumps", "libfaketime is not installed")
    for name in ("run, csv", "sweep", "diagnose", *(["proof"] if is_long else [])):
        command = named(name)
        own = place / name.replace(" ", "_").replace(",", "")
        whole = prepare(own / "whole", recordings)
        run([smam, *command.arguments], whole)
        expected = files(whole / "out")
        for what, before, after, monotonic in (
            ("in 1999", "-27y", None, False),
            ("back by a year on the way", "+0", "-1y", False),
            ("back by a year on the way, the monotonic one too", "+0", "-1y", True),
        ):
            folder = prepare(own / "moved", recordings)
            control = own / "faketime"
            control.write_text(before)
            env = {"LD_PRELOAD": str(found), "FAKETIME_TIMESTAMP_FILE": str(control), "FAKETIME_NO_CACHE": "1"}
            if not monotonic:
                env["FAKETIME_DONT_FAKE_MONOTONIC"] = "1"
            process = start([smam, *command.arguments], folder, env=env)
            time.sleep(0.05)
            if after:
                control.write_text(after)
            done = end(process, 120)
            left = files(folder / "out")
            missing = [f"{n} is missing" for n in expected.keys() - left.keys()]
            faults = sane(done) + compare(left, expected) + missing + ([] if done.code == 0 else [f"exit code {done.code}: {done.err[-200:]!r}"])
            CHECKS.add(f"clock {what}, {name}", faults)
            shutil.rmtree(folder)
