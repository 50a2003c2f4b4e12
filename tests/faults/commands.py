"""The commands that are attacked: small, each with all its files below `out/`."""

from dataclasses import dataclass
from pathlib import Path

RECORDINGS = """format = 1
scene = "muscle_bench"

[[channel]]
column = "plunger_mm"
role = "input"

[[channel]]
column = "elongation_mm"
role = "output"
noise_sd = 0.02

[[run]]
file = "a.csv"

[[run]]
file = "b.csv"
"""


@dataclass
class Command:
    """One command."""

    name: str
    arguments: list[str]
    # Added when it is started again.
    again: tuple[str, ...] = ()
    # Of 100 kills, how many it gets: some take seconds.
    share: float = 1.0


SWEEP = ["sweep", "muscle_bench", "--vary", "muscles.friction.m0_n=0.1:0.3:12", "--measure", "range_mm=range(elongation_mm)"]
COMMANDS = [
    Command("run, csv and rrd", ["run", "muscle_bench"]),
    Command("run, csv", ["run", "bending_catheter", "--duration", "4", "--output", "out/run.csv"]),
    Command("run, parquet", ["run", "muscle_bench", "--output", "out/run.parquet"]),
    Command("run, mcap", ["run", "muscle_bench", "--output", "out/run.mcap"]),
    Command("sweep", [*SWEEP, "--duration", "10", "--out", "out"], again=("--resume",)),
    Command("diagnose", ["diagnose", "rec", "--rrd", "--out", "out"]),
    Command("identify", ["identify", "rec/a.csv", "--starts", "1", "--out", "out"]),
    Command("reproduce", ["reproduce", "4a", "--out", "out"], share=0.2),
    Command("proof", ["proof", "--cases", "0", "--nothing", "1", "--seed", "2", "--out", "out"], share=0.2),
    Command("trial", ["trial", "--scene", "muscle_bench", "--only-nulls", "--nulls", "1", "--out", "out"], share=0.1),
]


def named(name):
    return next(c for c in COMMANDS if c.name == name)


def prepare(folder, recordings):
    """A folder to work in, with the recordings beside."""
    folder = Path(folder)
    folder.mkdir(parents=True)
    (folder / "rec").symlink_to(recordings, target_is_directory=True)
    return folder


def make_recordings(run, smam, folder):
    """Two short runs of the bench, with more friction than the scene says."""
    rec = Path(folder) / "rec"
    rec.mkdir(parents=True)
    for name in ("a", "b"):
        keys = ["--set", "simulation.output_interval_s=0.05", "--set", "muscles.friction.m0_n=0.2"]
        done = run([smam, "run", "muscle_bench", "--duration", "6", *keys, "--output", rec / f"{name}.csv"], folder)
        if done.code != 0:
            raise SystemExit(f"the recordings could not be made: {done.err}")
    (rec / "recordings.toml").write_text(RECORDINGS)
    return rec
