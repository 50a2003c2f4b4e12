#!/usr/bin/env python3
"""The rivals' answers beside those of `smam diagnose`, on the same cases, by `smam score`."""

import argparse
import json
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

from methods import METHODS, TOLD
from score_table import OWN, page

# Stands for a forecast of the holdout that is not finite: JSON has no infinity, and leaving the case out would flatter.
NO_FORECAST = -1.0e6
# Outputs of the rigs in the order in which a sealed answer lists their noise.
OUTPUTS = {
    "muscle_bench": ("elongation_mm", "pressure_kpa"),
    "antagonistic_pulley": ("angle_deg", "pressure_1_kpa", "pressure_2_kpa"),
    "bending_catheter": ("bend_deg", "jaw_deg", "pressure_1_kpa", "pressure_2_kpa"),
}
# Least gap between baseline and noise, in the noise's variance per sample, as `smam score` has it.
LEAST_GAP = 0.02
# What a rival says of a drawn law, but for the element: nothing that could be compared.
NO_LAW = {"set_size": 0}
REBUILD = "if smam is older than this script, build it (cargo build --release) and give --smam PATH"


class ScoreError(Exception):
    """Something about rows, answers or the program that its user can mend."""


def main():
    """Command line."""
    try:
        table = score(parse())
    except (ScoreError, OSError) as error:
        sys.exit(f"score: {error}")
    print(table, end="")


def parse():
    """Arguments."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rows", type=Path, metavar="PROOF_ROWS", help="rows.jsonl of `smam proof` or `smam score`")
    parser.add_argument("--answers", type=Path, required=True, metavar="OUT", help="folder that run.sh wrote")
    parser.add_argument("--methods", default=",".join(METHODS), help="comma-separated, of %(default)s")
    parser.add_argument("--out", type=Path, help="table.md and METHOD/ go here (default: OUT/score)")
    parser.add_argument(
        "--sealed", type=Path, help="sealed answers NAME.json, opened: the rivals' gap closed is then by the true noise"
    )
    parser.add_argument("--smam", default=OWN, help="the program")
    return parser.parse_args()


def score(arguments):
    """Scores all on the cases that all have answered. Returns the table."""
    methods = chosen_methods(arguments.methods)
    smam = program(arguments.smam)
    rows = read_rows(arguments.rows)
    answered = {m: answered_cases(arguments.answers, m) for m in methods}
    names, left_out = common_cases(rows, answered, arguments)
    print(f"{len(names)} cases to score, {left_out} left out that some have not answered", file=sys.stderr)
    rows_of = {OWN: [own_row(rows[n]) for n in names]}
    for method in methods:
        folder = arguments.answers / method
        rows_of[method] = [rival_row(rows[n], folder / f"{n}.json", arguments.sealed) for n in names]
    out = arguments.out or arguments.answers / "score"
    figures = {method: scored(rows_of[method], out / method, smam) for method in rows_of}
    table = page(figures, rows_of, left_out, arguments.sealed is not None)
    write_whole(out / "table.md", table)
    return table


def chosen_methods(words):
    """The methods asked for, in the order of METHODS."""
    asked = [m for m in words.split(",") if m]
    if not asked or not set(asked) <= {*METHODS, *TOLD}:
        raise ScoreError(f"--methods {words}: give some of {', '.join((*METHODS, *TOLD))}")
    return [m for m in (*METHODS, *TOLD) if m in asked]


def program(name):
    """Where the program is."""
    smam = shutil.which(name)
    if smam is None:
        raise ScoreError(f"no program {name}: build it (cargo build --release) and give --smam PATH")
    return str(Path(smam).resolve())


def read_rows(path):
    """Rows of a proof by name of case."""
    rows, remedy = {}, "write the file anew with `smam score`"
    for number, line in enumerate(read_text(path, remedy).split("\n"), 1):
        if not line.strip():
            continue
        row = parse_json(line, f"{path}, line {number}", remedy)
        missing = [k for k in ("name", "hiding") if not isinstance(row.get(k), str)]
        if missing:
            raise ScoreError(f"{path}, line {number}: not the row of a case, no {', '.join(missing)}: {remedy}")
        if row["name"] in rows:
            raise ScoreError(f"{path}, line {number}: name {row['name']} stands in an earlier line too: {remedy}")
        rows[row["name"]] = row
    return rows


def read_text(path, remedy):
    """Contents of a file, or a word about why there are none."""
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise ScoreError(f"{path}: cannot be read ({error.strerror}): {remedy}") from error
    except UnicodeDecodeError as error:
        raise ScoreError(f"{path}: not text ({error.reason} at byte {error.start}): {remedy}") from error


def parse_json(text, where, remedy):
    """A JSON object, or a word about what is wrong with it."""
    try:
        value = json.loads(text)
    except json.JSONDecodeError as error:
        raise ScoreError(f"{where}: not JSON ({error}): {remedy}") from error
    if not isinstance(value, dict):
        raise ScoreError(f"{where}: not a JSON object: {remedy}")
    return value


def answered_cases(answers, method):
    """Names of the cases that a method has answered."""
    folder = answers / method
    if not folder.is_dir():
        run = f"./benches/rivals/run.sh CASES --diagnoses DIAGNOSES --out {answers} --methods {method}"
        raise ScoreError(f"{folder} is missing: write it with `{run}`, or leave {method} out with --methods")
    return {p.stem for p in folder.glob("*.json")}


def common_cases(rows, answered, arguments):
    """Cases that all have answered, sorted, and how many only some have."""
    common = set(rows).intersection(*answered.values())
    if not common:
        counts = ", ".join(f"{m} {len(names)}" for m, names in answered.items())
        raise ScoreError(
            f"{arguments.answers}: no case of {arguments.rows} ({len(rows)} rows) is answered by all "
            f"({counts}): give the rows of the same cases, or let run.sh finish"
        )
    return sorted(common), len(set(rows).union(*answered.values())) - len(common)


def own_row(row):
    """The proof's row without what no rival was asked: the further run."""
    return {k: v for k, v in row.items() if k != "settled"}


def rival_row(row, path, sealed):
    """The proof's row with a rival's answer in place. `excess` stays, so that the same cases are visible for all."""
    noise = true_noise(row, sealed) if sealed else None
    remedy = "delete it and run run.sh again"
    answer = parse_json(read_text(path, remedy), path, remedy)
    try:
        place = {
            "verdict": answer["verdict"],
            "element": answer["location"]["element"],
            "effects": [named(effect) for effect in answer["effects"]],
            "gap_closed": None if row["hiding"] == "nothing" else gap_closed(answer["holdout"], noise),
            "seconds": float(answer["seconds"]),
        }
    except KeyError as error:
        raise ScoreError(f"{path}: no key {error}: {remedy}") from error
    except (TypeError, ValueError, ZeroDivisionError) as error:
        raise ScoreError(f"{path}: not the answer of a rival ({error}): {remedy}") from error
    if row.get("law"):
        place["law"] = {k: v if k == "hidden" else NO_LAW.get(k) for k, v in row["law"].items()}
    return own_row(row) | place


def named(effect):
    """What is scored of one entry of `effects`."""
    entry = {"name": effect["name"], "element": effect["element"], "probability": float(effect["probability"])}
    return entry | ({"channel": effect["channel"]} if effect.get("channel") else {})


def gap_closed(holdout, noise):
    """The share of the gap that is closed: by the true noise where it is known, otherwise as the rival has it."""
    value = gap_by_noise(holdout["channels"], noise) if noise else holdout["gap_closed"]
    return float(value) if math.isfinite(value) else NO_FORECAST


def gap_by_noise(channels, noise):
    """What `smam score` computes of a scene: means over the channels of squared errors in the noise's variance."""

    def mean_square(key):
        ratios = [c[key] / noise[name] for name, c in channels.items()]
        return sum(r * r for r in ratios) / len(ratios)

    before, after = mean_square("rmse_baseline"), mean_square("rmse_corrected")
    return (before - after) / max(before - 1.0, LEAST_GAP)


def true_noise(row, sealed):
    """Deviation of the noise that was put into each channel, by the sealed answer."""
    path, remedy = sealed / f"{row['name']}.json", "give the --sealed of the same cases"
    truth = parse_json(read_text(path, remedy), path, remedy)
    try:
        outputs = OUTPUTS[truth["rig"]]
        return dict(zip(outputs, (float(channel["sd"]) for channel in truth["noise"]), strict=True))
    except (KeyError, TypeError, ValueError) as error:
        raise ScoreError(f"{path}: not the sealed answer of a rig that is known here ({error}): {remedy}") from error


def scored(rows, folder, smam):
    """Figures by key, as `smam score` computes them from rows."""
    path = folder / "rows.jsonl"
    write_whole(path, "".join(json.dumps(row, ensure_ascii=False) + "\n" for row in rows))
    command = [smam, "score", "--rows", str(path), "--out", str(folder)]
    (folder / "score.json").unlink(missing_ok=True)
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        said = " ".join(result.stderr.split())
        raise ScoreError(f"`{' '.join(command)}` ended with {result.returncode}: {said}; {REBUILD}")
    return read_figures(folder / "score.json")


def read_figures(path):
    """Figures of a score.json by key, in its order."""
    try:
        return {f["key"]: f for f in json.loads(read_text(path, REBUILD))}
    except (json.JSONDecodeError, KeyError, TypeError) as error:
        raise ScoreError(f"{path}: not a list of figures ({error}): {REBUILD}") from error


def write_whole(path, text):
    """Writes a file whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    part.write_text(text, encoding="utf-8")
    part.replace(path)


if __name__ == "__main__":
    main()
