#!/usr/bin/env python3
"""Reads a Rerun stream back with the viewer's own library and looks at the picture that the viewer makes of it.

    VENV/bin/python tests/viewer/check.py --rrd out/bending_catheter.rrd --csv out/bending_catheter.csv

VENV holds rerun-sdk of the version that Cargo.toml pins, and pillow. Compared: every channel of the CSV with the values in the stream; and of
the headless viewer's picture what it shows, region by region (colours that must be there), never its bytes. Without a software
renderer for Vulkan the picture is left out, and that is said; --require-picture makes it a failure.
"""

import argparse
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import rerun.experimental as rerun
from PIL import Image

SIZE = (1600, 900)
# Regions as shares of the window (left, top, right, bottom), and colours that must be in them on so many pixels of 1600 x 900:
# lines of plots, the tube, its jaws, cables, loop, colour scales, large type.
LOOKS = [
    ("the catheter's tube", (0.0, 0.05, 0.46, 0.65), (200, 197, 186), 40, 1500),
    ("the jaws", (0.0, 0.05, 0.46, 0.65), (51, 115, 178), 45, 150),
    ("the tip's trace", (0.0, 0.05, 0.46, 0.65), (120, 200, 255), 25, 60),
    ("cables", (0.0, 0.05, 0.46, 0.65), (80, 120, 250), 60, 150),
    ("the loop", (0.0, 0.66, 0.26, 0.97), (70, 150, 160), 60, 100),
    ("the angle in large type", (0.26, 0.66, 0.46, 0.78), (250, 250, 250), 20, 60),
    ("colour scale of tension", (0.26, 0.82, 0.46, 0.97), (200, 80, 210), 40, 200),
    ("colour scale of pressure", (0.26, 0.82, 0.46, 0.97), (50, 200, 200), 40, 200),
    ("plunger 1", (0.46, 0.05, 0.73, 0.34), (90, 170, 255), 20, 200),
    ("plunger 2", (0.46, 0.05, 0.73, 0.34), (255, 160, 60), 20, 200),
    ("bend over time", (0.46, 0.36, 0.73, 0.65), (90, 170, 255), 20, 200),
    ("jaw over time", (0.73, 0.40, 1.0, 0.65), (90, 170, 255), 20, 200),
    ("joints over time", (0.46, 0.68, 1.0, 0.97), (240, 150, 210), 20, 300),
]


def channels_of(csv_file):
    """Column name -> values."""
    with open(csv_file, newline="") as lines:
        rows = list(csv.reader(lines))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def scalars_of(rrd_file):
    """Last part of an entity's path -> (times in s, values), of everything below /plots."""
    found = {}
    for chunk in rerun.RrdReader(rrd_file).stream():
        path = str(chunk.entity_path)
        if not path.startswith("/plots/") or chunk.is_static:
            continue
        batch = chunk.to_record_batch()
        times, values = found.setdefault(path.rsplit("/", 1)[-1], ([], []))
        time_column = next(name for name in batch.schema.names if name == "time")
        value_column = next(name for name in batch.schema.names if name.endswith("Scalars:scalars"))
        times += [t.total_seconds() for t in batch.column(time_column).to_pylist()]
        values += [v[0] for v in batch.column(value_column).to_pylist()]
    return found


def compare(csv_file, rrd_file):
    """Lines that say where the stream holds something else than the CSV."""
    wanted, found = channels_of(csv_file), scalars_of(rrd_file)
    times = wanted.pop("time_s")
    faults = []
    for name, values in wanted.items():
        if name not in found:
            faults.append(f"{name}: not in the stream")
            continue
        shown = sorted(zip(*found[name]))
        worst = max((abs(v - w) for (_, v), w in zip(shown, values)), default=float("inf"))
        late = max((abs(t - w) for (t, _), w in zip(shown, times)), default=float("inf"))
        scale = max(map(abs, values)) or 1.0
        if len(shown) != len(values) or worst > 1e-9 * scale or late > 1e-6:
            faults.append(f"{name}: {len(shown)} of {len(values)} values, off by {worst:g}, {late:g} s")
    print(f"{'FAIL' if faults else 'ok  '}  {len(wanted)} channels of {len(times)} values, as in the CSV")
    return faults


def screenshot(rrd_file, picture):
    """Whether the headless viewer could draw."""
    command = [Path(sys.executable).parent / "rerun", rrd_file, "--headless", "--screenshot-to", picture]
    command += ["--window-size", f"{SIZE[0]}x{SIZE[1]}", "--port", "9733"]
    try:
        subprocess.run(list(map(str, command)), capture_output=True, timeout=180, check=False)
    except subprocess.TimeoutExpired:
        return False
    return Path(picture).is_file()


def near(pixel, colour, tolerance):
    return all(abs(a - b) <= tolerance for a, b in zip(pixel, colour))


def look(picture):
    """Lines that say what the picture does not show."""
    image = Image.open(picture).convert("RGB").resize(SIZE)
    faults = []
    for what, (left, top, right, bottom), colour, tolerance, least in LOOKS:
        box = (int(left * SIZE[0]), int(top * SIZE[1]), int(right * SIZE[0]), int(bottom * SIZE[1]))
        data = image.crop(box).tobytes()
        pixels = zip(data[0::3], data[1::3], data[2::3])
        count = sum(near(pixel, colour, tolerance) for pixel in pixels)
        print(f"{'ok  ' if count >= least else 'FAIL'}  {what}: {count} pixels, at least {least}")
        if count < least:
            faults.append(f"the picture lacks {what}")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rrd", required=True)
    parser.add_argument("--csv", required=True)
    parser.add_argument("--keep", help="keep the picture under this name")
    parser.add_argument("--require-picture", action="store_true")
    arguments = parser.parse_args()
    faults = compare(arguments.csv, arguments.rrd)
    with tempfile.TemporaryDirectory() as scratch:
        picture = arguments.keep or str(Path(scratch) / "picture.png")
        if screenshot(arguments.rrd, picture):
            faults += look(picture)
        elif arguments.require_picture:
            faults.append("the headless viewer drew nothing: is mesa-vulkan-drivers installed?")
        else:
            print("skipped: the picture (no software renderer for Vulkan, see mesa-vulkan-drivers)")
    print("\n".join(faults), file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
