#!/usr/bin/env python3
"""Writes docs/effects/likeness.md: how alike the effects of the catalogue look on the stock rigs.

    docs/effects/look_alike.py SMAM > docs/effects/likeness.md     (in the project's folder; needs numpy)

Plays each rig without and with every effect at its typical size, in units of the noise assumed below; takes off each
change what the scene's own calibrated numbers could imitate; prints how large the change is, how much of it the
calibration leaves, and the cosine of the angle to the most alike others: 1 is "the same up to size".
"""
import csv
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

NOISE = {"mm": 0.02, "kpa": 5.0, "deg": 0.1}
CALIBRATED = {
    "muscles.tube.material.c1_pa": 0.255e6,
    "hydraulics.upstream_compliance_m3_pa": 8.0e-15,
    "muscles.friction.m0_n": 0.106,
    "muscles.friction.m1_n_pa": 0.222e-6,
    "muscles.friction.presliding_length_m": 5.2e-3,
}
STEP = 0.01  # of each calibrated number, for its slope
# Second numbers that a scene must give; the angle is reached by every rig.
SECOND = {"relaxation_time_s": 4.0, "threshold_m": 0.018, "angle_rad": 0.15}

BENCH = ["elongation_mm", "pressure_kpa"]
PULLEY = ["angle_deg", "pressure_1_kpa", "pressure_2_kpa"]
CATHETER = ["bend_deg", "jaw_deg", "pressure_1_kpa", "pressure_2_kpa"]
RUNS = [
    ("muscle_bench", "sine", "sine of 3 mm at 0.1 Hz, 40 s", BENCH),
    ("muscle_bench", "holds", "staircase 1, 2, 3, 2, 1, 0 mm, 18.5 s on each step", BENCH),
    ("muscle_bench", "chirp", "sine of 3 mm, 0.05 to 2 Hz in 40 s", BENCH),
    ("antagonistic_pulley", "stock", "the scene's own programme, 20 s", PULLEY),
    ("bending_catheter", "stock", "the scene's own programme, 24 s", CATHETER),
]


def programme(kind):
    """Times (s) and plunger (mm) of a bench programme."""
    if kind == "sine":
        return [(0.02 * i, 1.5 * (1 - math.cos(0.2 * math.pi * 0.02 * i))) for i in range(2001)]
    if kind == "chirp":
        rows, phase = [], 0.0
        for i in range(4001):
            phase += 2 * math.pi * (0.05 + 1.95 * i / 4000) * 0.01
            rows.append((0.01 * i, 1.5 * (1 - math.cos(phase))))
        return rows
    corners, level = [(0.0, 0.0)], 0.0
    for step, level in enumerate([1, 2, 3, 2, 1, 0]):
        corners += [(20.0 * step + 1.5, level), (20.0 * step + 20.0, level)]
    t, x = zip(*corners)
    return [(0.05 * i, float(np.interp(0.05 * i, t, x))) for i in range(2401)]


def run(smam, scene, kind, recorded, settings):
    """Recorded outputs of one run, each in units of its noise; None where the scene is refused."""
    out = scene.parent / "run.csv"
    out.unlink(missing_ok=True)
    command = [smam, "run", str(scene), "--output", str(out)] + [f"--set={s}" for s in settings]
    if kind != "stock":
        rows = "".join(f"{t:.6g},{x:.6g}\n" for t, x in programme(kind))
        (scene.parent / "programme.csv").write_text("time_s,plunger_mm\n" + rows)
        command += ["--input", str(scene.parent / "programme.csv")]
    if subprocess.run(command, capture_output=True).returncode != 0:
        return None
    with open(out, newline="") as file:
        rows = list(csv.reader(file))
    shown = [rows[0].index(name) for name in recorded]
    return np.array([[float(row[i]) for i in shown] for row in rows[1:]]) / [NOISE[n.rsplit("_", 1)[1]] for n in recorded]


def tables(smam, is_double, recorded):
    """Every effect as an `[[effect]]` table to try: on the first element of its kind, or on each channel."""
    listed = subprocess.run([smam, "effects"], capture_output=True, text=True, check=True).stdout
    for law in sorted({line.split()[0] for line in listed.split("\n\n")[0].splitlines()}):
        with tempfile.TemporaryDirectory() as out:
            said = subprocess.run([smam, "effects", law, "--out", out], capture_output=True, text=True, check=True).stdout
        for table in re.findall(r"\[\[effect\]\](?:\n .*\S)+", said):
            table = re.sub(r"(?m)^ +", "", table)
            key = re.findall(r"(\w+) = [-\d.e+]+$", table, re.M)[0]
            table += "".join(f"\n{k} = {v}" for k, v in SECOND.items() if k != key and f"    {k} " in said)
            name = f"{law} ({key})" if law == "sensor_lag" else law
            if 'element = "sensor"' in table:
                for channel in recorded:
                    yield f"{name} on {channel}", re.sub(r'channel = "\w+"', f'channel = "{channel}"', table)
            else:
                number = r'element = "\1_1"' if is_double else r'element = "\1"'
                yield name, re.sub(r'element = "(syringe|line|muscle|cable)"', number, table)


def likeness(smam, name, kind, recorded):
    text = (pathlib.Path("scenes") / f"{name}.toml").read_text()
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        (folder / "scenes").mkdir()
        (folder / "models").symlink_to(pathlib.Path("models").resolve())
        scene = folder / "scenes" / f"{name}.toml"

        def play(more="", settings=()):
            scene.write_text(text + more)
            return run(smam, scene, kind, recorded, settings)

        plain = play()
        slopes = [(play(settings=[f"{k}={v * (1 + STEP)}"]) - plain).ravel() for k, v in CALIBRATED.items()]
        played = {law: play(f"\n{table}\n") for law, table in tables(smam, text.count("[[muscle]]") > 1, recorded)}
    changes = {law: (y - plain).ravel() for law, y in played.items() if y is not None and not np.array_equal(y, plain)}
    basis = np.linalg.qr(np.array(slopes).T)[0]
    left = {law: c - basis @ (basis.T @ c) for law, c in changes.items()}
    size = {law: np.linalg.norm(c) for law, c in left.items()}
    print("| effect | change, RMS in noise | left by the calibration | most alike (cosine) |\n|---|---|---|---|")
    for law, change in changes.items():
        cosine = {o: abs(left[law] @ left[o]) / size[law] / size[o] for o in left if o != law}
        near = ", ".join(f"{o} {cosine[o]:.2f}" for o in sorted(cosine, key=cosine.get, reverse=True)[:3])
        rms, share = np.sqrt(np.mean(change**2)), size[law] / np.linalg.norm(change)
        print(f"| {law} | {rms:.2g} | {100 * share:.0f} % | {near} |")


if len(sys.argv) != 2:
    sys.exit(__doc__)
print("# Which effects look alike\n\n" + "Written by `docs/effects/look_alike.py`, which says how it counts. "
      "Noise: 0.02 mm, 0.1°, 5 kPa. With two of an element the first one has the effect.")
for name, kind, what, recorded in RUNS:
    print(f"\n## {name}: {what}\n\nRecorded: {', '.join(recorded)}.\n")
    likeness(sys.argv[1], name, kind, recorded)
