"""The same bytes every time, on any number of threads."""

import shutil

from commands import COMMANDS, prepare
from common import CHECKS, compare, files, run


def check(smam, place, recordings):
    """Twice as it is, then on one thread and on two."""
    for command in COMMANDS:
        own = place / command.name.replace(" ", "_").replace(",", "")
        expected, faults = None, []
        for threads in (None, None, "1", "2"):
            folder = prepare(own / "run", recordings)
            done = run([smam, *command.arguments], folder, env={"RAYON_NUM_THREADS": threads} if threads else {})
            found = files(folder / "out")
            expected = expected or found
            said = [] if done.code == 0 and found else [f"exit code {done.code}: {done.err[-200:]!r}"]
            said += compare(found, expected) + [f"{name} is missing" for name in expected.keys() - found.keys()]
            faults += [f"threads {threads or 'as they come'}: {fault}" for fault in said]
            shutil.rmtree(folder)
        CHECKS.add(f"same bytes, {command.name}", faults, f"{len(expected)} files, 4 runs: 2 as they come, 1 thread, 2 threads")
