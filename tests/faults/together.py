"""Two programs that write into one folder at once."""

import shutil

from commands import COMMANDS, prepare
from common import CHECKS, compare, end, files, run, sane, start


def check(smam, place, recordings, is_long):
    """One of them may be turned away; the folder holds the results of an undisturbed run."""
    for command in (c for c in COMMANDS if is_long or c.share == 1.0):
        own = place / command.name.replace(" ", "_").replace(",", "")
        whole = prepare(own / "whole", recordings)
        run([smam, *command.arguments], whole)
        expected = files(whole / "out")
        faults, turned_away = [], 0
        for _ in range(3 if command.share == 1.0 else 1):
            folder = prepare(own / "both", recordings)
            first = start([smam, *command.arguments], folder)
            second = start([smam, *command.arguments], own / "both", stdout=open(own / "second.out", "w"), stderr=open(own / "second.err", "w"))
            both = [end(second), end(first)]
            said = (own / "second.err").read_text() + both[1].err
            turned_away += sum(d.code == 2 for d in both)
            if 0 not in (d.code for d in both):
                faults.append(f"neither came to its end: {said[-300:]!r}")
            if any(d.code == 2 for d in both) and not ("writing here" in said or "was begun here" in said):
                faults.append(f"it does not say that another one writes there: {said[-300:]!r}")
            found = files(folder / "out")
            faults += [f for d in both for f in sane(d)] + compare(found, expected)
            faults += [f"{name} is missing" for name in expected.keys() - found.keys()]
            shutil.rmtree(folder)
        CHECKS.add(f"two at once, {command.name}", sorted(set(faults)), f"{turned_away} turned away")
