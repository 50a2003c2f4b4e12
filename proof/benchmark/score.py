#!/usr/bin/env python3
"""Scores answers to the benchmark. Needs Python 3.10 and nothing else.

    python3 score.py BENCHMARK ANSWERS            a table, a row for each case
    python3 score.py BENCHMARK ANSWERS --json     the same for programs

BENCHMARK holds `truth/`. ANSWERS holds NAME.json (answer.schema.json) and, for a prediction of the next recording,
NAME.csv with the columns of `next/calibrated.csv`. A case without an answer counts as answered with nothing.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import sys
from pathlib import Path

CERTAIN = 0.9
# Causes that count as named beside each other: the first and two alternatives.
SET = 3
# Below a few hundredths of the noise there is no gap to close.
LEAST_GAP = 0.02


class Refused(Exception):
    """An answer that cannot be scored."""


def says_the_same(true: dict, said: dict) -> bool:
    """Whether a cause names the hidden one: a listed effect by name and element, a law by port and variables."""
    if true["effect"] is not None:
        return said.get("effect") == true["effect"] and said.get("element") == true["element"]
    is_there = said.get("port") == true["port"]
    return is_there and sorted(said.get("variables") or []) == sorted(true["variables"])


def is_on_element(true: dict, said: dict) -> bool:
    return said.get("element") == true["element"]


def named(cause: dict) -> list[dict]:
    """A cause with its alternatives, as many as count."""
    return [cause, *cause.get("alternatives", [])][:SET]


def read_answer(folder: Path, name: str) -> dict:
    path = folder / f"{name}.json"
    if not path.exists():
        return {"causes": []}
    try:
        answer = json.loads(path.read_text(encoding="utf-8"))
        for cause in answer["causes"]:
            for each in [cause, *cause.get("alternatives", [])]:
                if not isinstance(each["element"], str):
                    raise TypeError("element is no text")
            if not 0 <= cause["probability"] <= 1:
                raise ValueError(f"probability {cause['probability']} lies outside 0 to 1")
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise Refused(f"{path}: is no answer: {error!r}\n  remedy: hold it against answer.schema.json") from error
    if answer.get("case") != name:
        raise Refused(f"{path}: case = {answer.get('case')!r}\n  remedy: the file's name and its case must agree")
    return answer


def read_columns(path: Path) -> dict[str, list[float]]:
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    try:
        values = [[float(text) if text else math.nan for text in row] for row in rows[1:]]
        return {name: [row[i] for row in values] for i, name in enumerate(rows[0])}
    except (ValueError, IndexError) as error:
        raise Refused(f"{path}: is no table of numbers: {error}\n  remedy: a header and rows of equal length") from error


def misfit(measured: dict, predicted: dict, noise_sd: dict, path: Path) -> float:
    """Mean over the channels of the mean squared residual in noise variances: 1 is a perfect prediction."""
    channels = [name for name in noise_sd if name in measured]
    means = []
    for name in channels:
        if name not in predicted or len(predicted[name]) != len(measured[name]):
            raise Refused(
                f"{path}: needs {len(measured[name])} rows of {name}\n  remedy: a row for each row of next/inputs.csv"
            )
        pairs = zip(measured[name], predicted[name])
        squares = [((m - p) / noise_sd[name]) ** 2 for m, p in pairs if math.isfinite(m)]
        means.append(sum(squares) / len(squares))
    value = sum(means) / len(means)
    return value if math.isfinite(value) else math.inf


def gap_closed(benchmark: Path, answers: Path, truth: dict) -> float | None:
    """Share of the gap between calibrated scene and noise that a prediction closes; None without a prediction."""
    name, path = truth["case"], answers / f"{truth['case']}.csv"
    if not path.exists():
        return None
    measured = read_columns(benchmark / "truth" / f"{name}.csv")
    of_scene = benchmark / "cases" / name / "next" / "calibrated.csv"
    calibrated = misfit(measured, read_columns(of_scene), truth["noise_sd"], of_scene)
    predicted = misfit(measured, read_columns(path), truth["noise_sd"], path)
    return (calibrated - predicted) / max(calibrated - 1.0, LEAST_GAP)


def score_case(benchmark: Path, answers: Path, truth: dict) -> dict:
    answer = read_answer(answers, truth["case"])
    hidden, said = truth["causes"], answer["causes"]
    in_sets = [each for cause in said for each in named(cause)]
    wrong = [c for c in said if c["probability"] > CERTAIN and not any(says_the_same(true, c) for true in hidden)]
    return {
        "case": truth["case"],
        "rig": truth["rig"],
        "hidden": len(hidden),
        "said": len(said),
        "detected": bool(hidden) == bool(said),
        "element": sum(any(is_on_element(true, each) for each in in_sets) for true in hidden),
        "first": sum(any(says_the_same(true, cause) for cause in said) for true in hidden),
        "in_set": sum(any(says_the_same(true, each) for each in in_sets) for true in hidden),
        "certain_and_wrong": len(wrong),
        "gap_closed": gap_closed(benchmark, answers, truth) if hidden else None,
        "seconds": answer.get("seconds"),
    }


def totals(rows: list[dict]) -> dict:
    hidden = sum(row["hidden"] for row in rows)
    gaps = sorted(row["gap_closed"] for row in rows if row["gap_closed"] is not None)
    return {
        "cases": len(rows),
        "detected": sum(row["detected"] for row in rows if row["hidden"]),
        "with_causes": sum(bool(row["hidden"]) for row in rows),
        "false_alarms": sum(not row["detected"] for row in rows if not row["hidden"]),
        "without_causes": sum(not row["hidden"] for row in rows),
        "causes": hidden,
        **{key: sum(row[key] for row in rows) for key in ("element", "first", "in_set", "certain_and_wrong")},
        "gap_closed_median": gaps[len(gaps) // 2] if gaps else None,
        "worse_than_calibrated": sum(gap < -LEAST_GAP for gap in gaps),
    }


def table(rows: list[dict], of_all: dict) -> str:
    def share(value: float | None) -> str:
        return "-" if value is None else f"{100 * value:.1f} %"

    lines = ["| case | rig | hidden | said | element | first | set of three | certain and wrong | gap closed |"]
    lines.append("|---|---|---|---|---|---|---|---|---|")
    for row in rows:
        cells = [row[key] for key in ("case", "rig", "hidden", "said", "element", "first", "in_set", "certain_and_wrong")]
        lines.append("| " + " | ".join(map(str, [*cells, share(row["gap_closed"])])) + " |")
    lines.append("")
    lines.append(
        f"detected {of_all['detected']} of {of_all['with_causes']}, false alarms {of_all['false_alarms']} of "
        f"{of_all['without_causes']}; of {of_all['causes']} causes the element {of_all['element']}, named first "
        f"{of_all['first']}, in a set of three {of_all['in_set']}; certain and wrong {of_all['certain_and_wrong']}; "
        f"gap closed, median {share(of_all['gap_closed_median'])}, worse than calibrated {of_all['worse_than_calibrated']}"
    )
    return "\n".join(lines)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("benchmark", type=Path)
    parser.add_argument("answers", type=Path)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    files = sorted((arguments.benchmark / "truth").glob("*.json"))
    try:
        if not files:
            raise Refused(f"{arguments.benchmark}/truth: no truth there\n  remedy: give the benchmark's folder first")
        truths = [json.loads(file.read_text(encoding="utf-8")) for file in files]
        rows = [score_case(arguments.benchmark, arguments.answers, truth) for truth in truths]
    except Refused as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    of_all = totals(rows)
    print(json.dumps({"cases": rows, "all": of_all}, indent=2) if arguments.json else table(rows, of_all))
    return 0


if __name__ == "__main__":
    sys.exit(main())
