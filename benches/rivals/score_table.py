"""The figures of several methods side by side, as Markdown."""

import math
from statistics import median

from methods import TOLD

OWN = "smam"
# Methods that name no effect, and the figures that are about names: without names these have no value.
NAMES_NOTHING = ("narx", "latent", "operon", "refit", "ude")
ABOUT_NAMES = (
    "probability",
    "element",
    "effect",
    "effect_altered",
    "exact_set",
    "coverage",
    "set_size",
    "confidently_wrong",
)
# Those that give an element nevertheless, and the figures of drawn laws that only `smam diagnose` gives anything for.
TELLS_ELEMENT = ("latent", "operon")
ABOUT_LAWS = ("law_port", "law_first", "law_set", "law_curve", "law_curve_beyond", "law_gap_larger")
# How keys begin of figures that only `smam diagnose` has, and of its time, for which stands the median of each.
LEFT_OUT = ("settled", "size_coverage", "time", "law_time")


def page(figures, rows_of, left_out, is_noise_true):
    """Both tables as Markdown."""
    cases = len(rows_of[OWN])
    head = f"{cases} cases that all have answered; {left_out} left out that some have not. In brackets: cases.\n"
    other = "" if is_noise_true else ", but for the rivals by their own estimate of it (--sealed mends that)"
    head += f"Gap closed is by the noise that was put in{other}.\n"
    keys = [k for k in figures[OWN] if not k.startswith(LEFT_OUT)]
    table = [["figure", "target", *map(title, figures)]]
    for key in keys:
        own = figures[OWN][key]
        table.append([own["what"], own["target"], *(cell(m, figures[m].get(key)) for m in figures)])
    table.append(["median time per case, s", "-", *(time_cell(rows) for rows in rows_of.values())])
    return f"{head}\n{markdown(table)}\n{better_page(figures, keys)}"


def better_page(figures, keys):
    """Where a rival does better, or that none does."""
    table = [["where a rival does better", "target", "rival", "its figure", title(OWN)]]
    for key in keys:
        own = figures[OWN][key]
        for method in figures:
            if is_better(own["target"], value(method, figures[method].get(key)), value(OWN, own)):
                cells = [cell(method, figures[method][key]), cell(OWN, own)]
                table.append([own["what"], own["target"], method, *cells])
    return markdown(table) if len(table) > 1 else "No rival does better than `smam diagnose` in any of these figures.\n"


def title(method):
    """Head of a column."""
    return "smam diagnose" if method == OWN else method


def value(method, figure):
    """A figure's value; None where it has no cases or a method has no such thing."""
    if figure is None or figure["cases"] == 0 or is_silent(method, figure["key"]):
        return None
    number = figure["value"]
    return number if number is not None and math.isfinite(number) else None


def is_silent(method, key):
    """Whether a method says nothing that a figure is about."""
    if key in ABOUT_LAWS:
        return method != OWN
    if method in TOLD and key in ("law_detection", "detection"):
        return True
    if method in TELLS_ELEMENT and key in ("element", "law_element"):
        return False
    return method in NAMES_NOTHING and key in (*ABOUT_NAMES, "law_element", "law_certain")


def cell(method, figure):
    """A figure with its number of cases; shares in per cent, as the target is."""
    number = value(method, figure)
    if number is None:
        return "-"
    words = f"{100.0 * number:.1f} %" if "%" in figure["target"] else f"{number:.2f}"
    return f"{words} ({figure['cases']})"


def time_cell(rows):
    """Median of the times that are known."""
    seconds = [row["seconds"] for row in rows if row.get("seconds") is not None]
    return f"{median(seconds):.1f} ({len(seconds)})" if seconds else "-"


def is_better(target, rival, own):
    """Whether a value is nearer to where the target points."""
    if rival is None or own is None:
        return False
    return rival < own if target.startswith("<=") else rival > own


def markdown(table):
    """Rows of cells, the first as head."""
    lines = [f"| {' | '.join(cells)} |" for cells in table]
    return "\n".join([lines[0], "|" + "---|" * len(table[0]), *lines[1:]]) + "\n"
