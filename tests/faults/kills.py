"""kill -9: at random moments, and at every single call that brings a file to the disk or gives it a name."""

import os
import random
import shutil
import signal
import time

from commands import COMMANDS, prepare
from common import CHECKS, JOURNALS, check_journals, compare, end, files, partials, run, sane, start

# What a file goes through on its way to its name.
CALLS = ("fsync", "renameat", "rename", "unlink", "unlinkat", "mkdir")
FORMER = {"diagnosis.json": "former", "scene.toml": "former", "baseline.toml": "former", "report.html": "former", "next_experiment.csv": "former"}


def undisturbed(smam, command, place, recordings):
    """Folder, files and duration (s) of a run that nothing disturbs; the shortest of three, for other work may delay one."""
    seconds = []
    for number in range(3 if command.share == 1.0 else 1):
        folder = prepare(place / f"whole{number}", recordings)
        done = run([smam, *command.arguments], folder)
        if done.code != 0:
            raise SystemExit(f"smam {' '.join(command.arguments)} fails undisturbed: {done.err}")
        seconds.append(done.seconds)
    return folder / "out", files(folder / "out"), min(seconds)


def after_kill(smam, command, folder, whole):
    """What is wrong after a kill: before and after the command is started again."""
    out, (whole_out, expected) = folder / "out", whole
    named = {name: value for name, value in files(out).items() if name not in JOURNALS}
    faults = compare(named, expected) + check_journals(out, whole_out)
    left = partials(out)
    again = run([smam, *command.arguments, *command.again], folder)
    if again.code != 0:
        faults.append(f"started again it ended with {again.code}: {again.err[-300:]!r}")
    faults += sane(again)
    found = files(out)
    faults += compare(found, expected) + [f"{name} is missing after it was started again" for name in expected.keys() - found.keys()]
    if len(partials(out)) > len(left):
        faults.append("started again it left files without a name")
    return faults, len(left)


def at_random(smam, command, place, recordings, kills, draw):
    """Kills at moments that are spread over the run's duration."""
    whole_out, expected, seconds = undisturbed(smam, command, place, recordings)
    faults, died, without_name = [], 0, 0
    for number in range(kills):
        folder = prepare(place / "killed", recordings)
        moment_s = draw.uniform(0, 1.05) * seconds
        process = start([smam, *command.arguments], folder)
        time.sleep(moment_s)
        os.kill(process.pid, signal.SIGKILL)
        died += end(process).code == -signal.SIGKILL
        found, left = after_kill(smam, command, folder, (whole_out, expected))
        without_name += left
        faults += [f"kill {number + 1} at {moment_s:.3f} s of {seconds:.3f} s: {f}" for f in found]
        shutil.rmtree(folder)
    what = f"{kills} kills, {died} before it had ended, {without_name} files without a name left"
    CHECKS.add(f"kill -9 at a random moment, {command.name}", faults, what)
    return whole_out, expected


def killed_at_call(smam, command, folder, call, number):
    """Ends the command in its `number`th call of a kind; whether it got that far."""
    trace = ["strace", "-f", "-qq", "-o", "/dev/null", "-e", f"trace={call}", "-e", f"inject={call}:signal=SIGKILL:when={number}"]
    return run([*trace, smam, *command.arguments], folder).code in (137, -signal.SIGKILL)


def at_every_call(smam, command, place, recordings, whole, most):
    """Kills in every call that writes to the disk or gives a name."""
    faults, count = [], 0
    for call in CALLS:
        for number in range(1, most + 1):
            folder = prepare(place / "killed", recordings)
            if killed := killed_at_call(smam, command, folder, call, number):
                count += 1
                faults += [f"in {call} {number}: {f}" for f in after_kill(smam, command, folder, whole)[0]]
            shutil.rmtree(folder)
            if not killed:
                break
    CHECKS.add(f"kill -9 in every call that saves or names a file, {command.name}", faults, f"{count} kills")
    return count


def whole_answers(smam, command, place, recordings, expected):
    """A new answer in the place of a former one: after a kill there is one of them, or no diagnosis.json, but no mixture."""
    faults, count = [], 0
    for call in CALLS:
        for number in range(1, 30):
            folder = prepare(place / "killed", recordings)
            (folder / "out").mkdir()
            for name, text in FORMER.items():
                (folder / "out" / name).write_text(text)
            former = files(folder / "out")
            killed = killed_at_call(smam, command, folder, call, number)
            found = files(folder / "out")
            shutil.rmtree(folder)
            if not killed:
                faults += [f"undisturbed: {name} of the former answer is left" for name in found.keys() - expected.keys()]
                break
            count += 1
            if "diagnosis.json" in found:
                one = former if found["diagnosis.json"] == former["diagnosis.json"] else expected
                mixed = sorted(n for n in one if n != "diagnosis.rrd" and found.get(n) != one[n])
                faults += [f"in {call} {number}: diagnosis.json stands beside {', '.join(mixed)} of another answer or without"] if mixed else []
    CHECKS.add("kill -9 while a diagnosis replaces a former one", sorted(set(faults)), f"{count} kills")


def check(smam, place, recordings, kills, seed, only, is_long):
    """All kills."""
    draw = random.Random(seed)
    has_strace = shutil.which("strace") is not None
    for command in (c for c in COMMANDS if only in c.name and (is_long or c.name != "trial")):
        own = place / command.name.replace(" ", "_").replace(",", "")
        own.mkdir(parents=True)
        whole = at_random(smam, command, own, recordings, round(kills * command.share) or 1, draw)
        # Commands that take long have many such calls: all of them only in the long check.
        if has_strace and (is_long or command.share == 1.0 and command.name != "diagnose"):
            at_every_call(smam, command, own, recordings, whole, 40)
        if has_strace and command.name == "diagnose":
            whole_answers(smam, command, own, recordings, whole[1])
    if not has_strace:
        CHECKS.skip("kill -9 in every call that saves or names a file", "strace is not installed")
