#!/usr/bin/env python3
"""Answers the benchmark with `smam diagnose`: the row that other tools compare with.

    python3 answer_smam.py BENCHMARK ANSWERS [--smam PROGRAM]

What is there already is kept, so that a run that was stopped goes on.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import time
from pathlib import Path

# What laws may depend on, by the units that their names end in.
VARIABLE = re.compile(r"\b[a-z][a-z0-9_]*_(?:m|m_s|pa|pa_s|m3|m3_s|n|n_s|rad|rad_s|s)\b")
# The part of an address that names the element, where it is not the element itself.
ELEMENTS = {"joint": "mechanism", "plunger": "syringe"}


def cause(effect: dict) -> dict:
    """A named effect, in the words of an answer."""
    place = {"element": effect.get("channel") or effect["element"]}
    if effect.get("hypothetical"):
        return {**place, "effect": None, **{key: effect[key] for key in ("port", "variables", "law")}}
    return {**place, "effect": effect["name"]}


def form(own: dict) -> dict:
    """Another port or shape that explains as much."""
    first, _, rest = own["port"].partition(".")
    word, _, number = first.partition("_")
    element = rest if first == "sensor" else ELEMENTS.get(word, word) + (f"_{number}" if number else "")
    variables = sorted(set(VARIABLE.findall(own["law"])))
    return {"element": element, "effect": None, "port": own["port"], "variables": variables, "law": own["law"]}


def causes(diagnosis: dict) -> list[dict]:
    """The effects of a diagnosis with their alternatives: rivals among them first, then other forms."""
    by_title = {title(effect): effect for effect in diagnosis["effects"]}
    answer, taken = [], set()
    for effect in sorted(diagnosis["effects"], key=lambda effect: -effect["probability"]):
        if title(effect) not in taken:
            rivals = [rival for rival in effect["rivals"] if rival in by_title]
            taken.update(rivals)
            others = [cause(by_title[rival]) for rival in rivals] + [form(own) for own in effect.get("forms", [])]
            answer.append({**cause(effect), "probability": effect["probability"], "alternatives": others})
    return answer


def title(effect: dict) -> str:
    """As a diagnosis names it among the rivals of another."""
    place = f"on {effect['channel']}" if effect.get("channel") else f"in {effect['element']}"
    return f"{effect['name']} {place}"


def answer(program: str, case: Path, out: Path) -> None:
    begun = time.monotonic()
    own = out / "diagnoses" / case.name
    subprocess.run([program, "diagnose", case, "--out", own], check=True, stdout=subprocess.DEVNULL)
    seconds = time.monotonic() - begun
    play = [program, "run", own / "scene.toml", "--input", case / "next" / "inputs.csv"]
    subprocess.run([*play, "--output", out / f"{case.name}.csv"], check=True, stdout=subprocess.DEVNULL)
    diagnosis = json.loads((own / "diagnosis.json").read_text(encoding="utf-8"))
    words = {"format": 1, "case": case.name, "causes": causes(diagnosis), "seconds": round(seconds, 1)}
    (out / f"{case.name}.json").write_text(json.dumps(words, indent=2), encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("benchmark", type=Path)
    parser.add_argument("answers", type=Path)
    parser.add_argument("--smam", default="smam")
    arguments = parser.parse_args()
    arguments.answers.mkdir(parents=True, exist_ok=True)
    for case in sorted((arguments.benchmark / "cases").iterdir()):
        if not (arguments.answers / f"{case.name}.json").exists():
            answer(arguments.smam, case, arguments.answers)


if __name__ == "__main__":
    main()
