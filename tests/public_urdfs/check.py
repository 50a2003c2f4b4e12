#!/usr/bin/env python3
"""Loads other people's URDFs and runs them for a tenth of a second: what is claimed to be read is read, the rest refused by name.

    tests/public_urdfs/check.py --smam target/release/smam

The robots come from the package example-robot-data on PyPI (each under its own licence; nothing of it is part of this project). Exit code 77:
it could not be had.
"""

import argparse
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path

PACKAGE = "example-robot-data==6.0.0"
SKIPPED = 77

# Below cmeel.prefix/share/example-robot-data/robots/: what is in it that must be read.
LOADED = {
    "finger_edu_description/robots/finger_edu.urdf": "three hinges, STL meshes of a package",
    "allegro_hand_description/urdf/allegro_left_hand.urdf": "sixteen hinges, meshes below the package, friction that is named in a note",
    "double_pendulum_description/urdf/double_pendulum_continuous.urdf": "continuous joints",
    "panda_description/urdf/panda.urdf": "prismatic fingers, one mimics the other, a flange without mass",
    "ur_description/urdf/ur5_robot.urdf": "transmissions and gazebo tags",
    "baxter_description/urdf/baxter.urdf": "nineteen links that are fixed to others",
    "xarm_description/urdf/xarm7.urdf": "materials by name",
    "kinova_description/robots/kinova.urdf": "an empty <inertial> on the base",
}
# And what is refused, with the words that say why.
REFUSED = {
    "human_description/robots/human.urdf": "has no mass of its own",
    "alex_description/urdf/alex_psyonic_hands.urdf": "does not exist",
}

SCENE = """format = 1
name = "public"
title = "somebody else's robot"
input = []

[simulation]
duration_s = 0.1
step_s = 1e-3
substeps = 1
output_interval_s = 0.01

[mechanism]
urdf = "{urdf}"
gravity_m_s2 = [0.0, 0.0, -9.81]
links_have_weight = true

[[output]]
channel = "{channel}"
quantity = "joint_position"
of = ["{joint}"]
"""


def download(folder):
    """The package's wheel, or none."""
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--disable-pip-version-check", "--dest", str(folder), PACKAGE]
    done = subprocess.run(command, capture_output=True, text=True)
    return next(iter(folder.glob("example_robot_data-*.whl")), None) if done.returncode == 0 else None


def unpack(wheel, folder):
    """The robots' folder."""
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return next(folder.glob("**/example-robot-data/robots"))


def free_joint(urdf):
    """Name of a joint that moves by itself, and whether it slides."""
    for joint in ElementTree.parse(urdf).getroot().findall("joint"):
        if joint.get("type") in ("revolute", "continuous", "prismatic") and joint.find("mimic") is None:
            return joint.get("name"), joint.get("type") == "prismatic"
    raise ValueError(f"{urdf}: no joint moves")


def run(smam, urdf, folder):
    """Exit code and words of a run."""
    joint, slides = free_joint(urdf)
    scene = folder / "scene.toml"
    scene.write_text(SCENE.format(urdf=urdf, joint=joint, channel="q_mm" if slides else "q_deg"))
    done = subprocess.run([smam, "run", str(scene), "--output", str(folder / "run.csv")], capture_output=True, text=True, timeout=120)
    return done.returncode, done.stderr


def check(smam, robots, folder):
    """Lines that say what went wrong."""
    faults = []
    for name, what in LOADED.items():
        code, words = run(smam, robots / name, folder)
        notes = [line for line in words.splitlines() if line.startswith("note:")]
        print(f"{'ok  ' if code == 0 else 'FAIL'}  {name}: {what} ({len(notes)} notes)")
        if code != 0 or "panicked" in words:
            faults.append(f"{name}: {words}")
    for name, why in REFUSED.items():
        code, words = run(smam, robots / name, folder)
        print(f"{'ok  ' if code == 2 and why in words else 'FAIL'}  {name}: refused, {why}")
        if code != 2 or why not in words:
            faults.append(f"{name}: should be refused with '{why}': {words}")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--smam", required=True, help="the program")
    parser.add_argument("--robots", type=Path, help="folder robots/ of an unpacked package, instead of downloading it")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        robots = arguments.robots
        if robots is None:
            wheel = download(folder)
            if wheel is None:
                print(f"skipped: {PACKAGE} could not be had from PyPI")
                return SKIPPED
            robots = unpack(wheel, folder)
        faults = check(arguments.smam, robots, folder)
    print("\n".join(faults), file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
