"""Makes a page of each kind with the program, and says what is to be explored on each."""

import functools
import shutil
import subprocess
from pathlib import Path

import explore

# A page of three one-minute runs stays below this.
MOST_BYTES = 3_000_000
# Rows of the run of the proof that is kept.
PROOF = Path(__file__).resolve().parents[2] / "proof"
# No "/" can be in a file's name; the rest of what ends a script, an attribute or a tag can.
EVIL = "\"'><img src=x onerror=broken=1><script>broken=1<!--.csv"


def run(smam, folder, *words):
    done = subprocess.run([smam, *map(str, words)], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"smam {' '.join(map(str, words))}: exit code {done.returncode}\n{done.stderr}")


def evil_recordings(folder, of):
    """A copy of recordings with one run, of an evil name."""
    target = folder / "evil"
    shutil.rmtree(target, ignore_errors=True)
    target.mkdir()
    shutil.copy(of / "sine.csv", target / EVIL)
    lines = (of / "recordings.toml").read_text().splitlines()
    head = lines[: lines.index("[[run]]")]
    # A TOML text in single quotes, three of them, takes everything but three of them.
    (target / "recordings.toml").write_text("\n".join([*head, "[[run]]", f"file = '''{EVIL}'''", ""]))
    return target


def pages(smam, folder):
    """File and explorations of each page."""
    here = functools.partial(run, smam, folder)
    here("conceal", "--seed", 7, "--hiding", "one", "--out", "hidden")
    inside = Path("hidden", "case_7")
    case = folder / inside
    here("diagnose", inside, "--out", "diagnosis")
    here("compare", inside, "--out", "comparison")
    here("compare", evil_recordings(folder, case), "--out", "evil_comparison")
    short = ["--duration", 2, "--measure", "range_mm=range(elongation_mm)", "--measure", "peak_kpa=max(pressure_kpa)"]
    keys = ["muscles.friction.m0_n=0.05:0.3:6", "hydraulics.line.bore_m=0.3e-3,0.5e-3,0.8e-3", "tube_c1_pa=0.2e6,0.3e6"]
    for count in (1, 2, 3):
        varied = [word for key in keys[:count] for word in ("--vary", key)]
        here("sweep", "muscle_bench", *varied, *short, "--out", f"sweep_{count}")
    here("run", "muscle_bench", "--duration", 20, "--output", "loop.csv")
    here("identify", "loop.csv", "--model", "symmetric", "--out", "identification")
    here("reproduce", "4b", "4cd", "--out", "reproduction")
    here("score", "--rows", PROOF / "rows.jsonl", "--out", "score")
    here("trial", "--scene", "driven_axis", "--effect", "seal_friction", "--out", "trial")
    (file,) = folder.glob("diagnosis/report.html")
    if file.stat().st_size > MOST_BYTES:
        raise SystemExit(f"{file}: {file.stat().st_size} bytes, more than {MOST_BYTES}")
    recorded = functools.partial(explore.csv_is_what_was_recorded, recorded=case / "sine.csv")
    curves = [explore.cursor_reads, explore.zoom_and_back, explore.lines_off_and_on, explore.chooser, recorded]
    points = [explore.sorting_and_filters, explore.parallel_axes, functools.partial(explore.command_runs, smam=smam, folder=folder)]
    return [
        (file, [*curves, explore.marked_stretches, explore.folds]),
        (folder / "comparison" / "compare.html", curves),
        (folder / "evil_comparison" / "compare.html", [explore.cursor_reads, explore.zoom_and_back]),
        (folder / "sweep_1" / "sweep.html", [explore.cursor_reads, *points]),
        (folder / "sweep_2" / "sweep.html", [explore.cursor_reads, explore.map_reads, *points]),
        (folder / "sweep_3" / "sweep.html", [explore.cursor_reads, explore.keys_change, *points]),
        (folder / "identification" / "identify.html", [explore.cursor_reads, functools.partial(explore.zoom_and_back, which=1), explore.lines_off_and_on]),
        (folder / "reproduction" / "reproduce.html", [explore.cursor_reads, explore.zoom_and_back, explore.lines_off_and_on]),
        (folder / "score" / "score.html", [explore.cursor_reads]),
        (folder / "trial" / "trial.html", []),
    ]
