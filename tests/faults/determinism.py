"""The same bytes every time, on any number of threads, and from a build of another kind."""

import shutil

from commands import COMMANDS, prepare
from common import CHECKS, compare, files, run


def check(smam, place, recordings, is_long, other=None):
    """Twice as it is, then on one thread and on two; what takes seconds on one and on two alone. Then the other build, if there is one."""
    for command in (c for c in COMMANDS if is_long or c.name != "trial"):
        own = place / command.name.replace(" ", "_").replace(",", "")
        expected, faults = None, []
        runs = (None, None, "1", "2") if is_long or command.share == 1.0 else ("1", "2")
        for threads in runs:
            found, said = play(smam, command.arguments, own / "run", recordings, threads)
            expected = expected or found
            said += compare(found, expected) + [f"{name} is missing" for name in expected.keys() - found.keys()]
            faults += [f"threads {threads or 'as they come'}: {fault}" for fault in said]
        CHECKS.add(f"same bytes, {command.name}", faults, f"{len(expected)} files, {len(runs)} runs on as many threads as there are, 1 and 2")
        if other:
            check_other(other, command, own / "other", recordings, expected)


def check_other(other, command, folder, recordings, expected):
    """A build with other optimisation writes the same. It may lack the viewer: streams are left out."""
    arguments = [a for a in command.arguments if a != "--rrd"]
    found, faults = play(other, arguments, folder, recordings, None)
    found, expected = ({n: c for n, c in some.items() if not n.endswith(".rrd")} for some in (found, expected))
    faults += compare(found, expected) + [f"{name} is missing" for name in expected.keys() - found.keys()]
    CHECKS.add(f"same bytes of the other build, {command.name}", faults, f"{len(expected)} files")


def play(program, arguments, folder, recordings, threads):
    """What a command writes, and what is wrong with how it ended."""
    prepare(folder, recordings)
    done = run([program, *arguments], folder, env={"RAYON_NUM_THREADS": threads} if threads else {})
    found = files(folder / "out")
    shutil.rmtree(folder)
    return found, [] if done.code == 0 and found else [f"exit code {done.code}: {done.err[-200:]!r}"]
