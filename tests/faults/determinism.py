"""The same bytes every time, on any number of threads."""

import shutil

from commands import COMMANDS, prepare
from common import CHECKS, compare, files, run


def check(smam, place, recordings, is_long):
    """Twice as it is, then on one thread and on two; what takes seconds on one and on two alone."""
    for command in (c for c in COMMANDS if is_long or c.name != "trial"):
        own = place / command.name.replace(" ", "_").replace(",", "")
        expected, faults = None, []
        runs = (None, None, "1", "2") if is_long or command.share == 1.0 else ("1", "2")
        for threads in runs:
            folder = prepare(own / "run", recordings)
            done = run([smam, *command.arguments], folder, env={"RAYON_NUM_THREADS": threads} if threads else {})
            found = files(folder / "out")
            expected = expected or found
            said = [] if done.code == 0 and found else [f"exit code {done.code}: {done.err[-200:]!r}"]
            said += compare(found, expected) + [f"{name} is missing" for name in expected.keys() - found.keys()]
            faults += [f"threads {threads or 'as they come'}: {fault}" for fault in said]
            shutil.rmtree(folder)
        CHECKS.add(f"same bytes, {command.name}", faults, f"{len(expected)} files, {len(runs)} runs on as many threads as there are, 1 and 2")
