#!/usr/bin/env python3
"""Kills the program, fills its disk, takes its folders away, feeds it what is no recording: nothing may be lost, cut or mixed.

    tests/faults/check.py --smam target/release/smam                  what CI runs
    tests/faults/check.py --smam target/release/smam --kills 100      what docs/reliability.md reports
    tests/faults/check.py --smam target/release/smam --part kills --only diagnose
    tests/faults/check.py --smam target/release/smam --part determinism --other PATH   another build, the same bytes

A check that needs what is not here (root for a small disk, strace, libfaketime) says that it is skipped. Exit code 77: nothing can be checked
here, because this is no Linux.
"""

import argparse
import sys
import tempfile
from pathlib import Path

import clock
import determinism
import disk
import inputs
import kills
import together
from commands import make_recordings
from common import CHECKS, run

SKIPPED = 77
PARTS = ("kills", "disk", "inputs", "together", "clock", "determinism")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--smam", required=True, help="the program")
    parser.add_argument("--kills", type=int, default=5, help="kills at random moments, of each quick command; slow ones get a part of it")
    parser.add_argument("--seed", type=int, default=1, help="of the moments")
    parser.add_argument("--part", choices=PARTS, action="append", help="only this part; may be given several times")
    parser.add_argument("--other", help="another build of the same program, which must write the same bytes")
    parser.add_argument("--only", default="", help="of the kills, only commands with this in their name")
    arguments = parser.parse_args()
    if not sys.platform.startswith("linux"):
        print("skipped: these checks need Linux")
        return SKIPPED
    smam = str(Path(arguments.smam).resolve())
    parts = arguments.part or PARTS
    # As thorough as docs/reliability.md reports: commands that take seconds as well.
    is_long = arguments.kills >= 50
    with tempfile.TemporaryDirectory(prefix="smam-faults-") as scratch:
        folder = Path(scratch)
        folder.chmod(0o755)
        recordings = make_recordings(run, smam, folder)
        if "kills" in parts:
            kills.check(smam, folder / "kills", recordings, arguments.kills, arguments.seed, arguments.only, is_long)
        for name, module in (("disk", disk), ("inputs", inputs), ("together", together), ("clock", clock)):
            if name in parts:
                module.check(smam, folder / name, recordings, is_long)
        if "determinism" in parts:
            other = arguments.other and str(Path(arguments.other).resolve())
            determinism.check(smam, folder / "determinism", recordings, is_long, other)
    print(f"{len(CHECKS.faults)} faults; {CHECKS.cpu_s:.0f} s of the program's CPU time")
    print("\n".join(CHECKS.faults), file=sys.stderr)
    return 1 if CHECKS.faults else 0


if __name__ == "__main__":
    sys.exit(main())
