#!/usr/bin/env python3
"""Other methods on the cases of `smam diagnose`: same recordings, same holdout, same score."""

import argparse
import importlib
import multiprocessing
import os
import shutil
import sys
import time
from pathlib import Path

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")
sys.path.insert(0, str(Path(__file__).resolve().parent))

from answer import as_json, holdout_figures, write_whole  # noqa: E402
from case import CaseError, NotForThisCase, hidden_port, load_case, sealed_outputs  # noqa: E402
from methods import METHODS, TOLD  # noqa: E402
from rows import channel_noise  # noqa: E402

# What may go wrong with one case and leaves the others alone.
MENDABLE = (CaseError, ValueError, LookupError, ArithmeticError, OSError)


def main():
    """Command line."""
    arguments = parse()
    try:
        jobs = open_jobs(arguments)
    except CaseError as error:
        sys.exit(f"rivals: {error}")
    print(f"{len(jobs)} cases to do", file=sys.stderr)
    with multiprocessing.get_context("spawn").Pool(arguments.jobs) as pool:
        failed = [f for f in pool.imap_unordered(run_case, jobs) if f]
    if failed:
        sys.exit(f"rivals: {len(failed)} of {len(jobs)} cases without all answers: {', '.join(sorted(failed))}")


def parse():
    """Arguments."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", type=Path, help="folder of NAME/recordings.toml and NAME.holdout.csv")
    parser.add_argument("--diagnoses", type=Path, required=True, help="folder of NAME/baseline.toml from smam diagnose")
    parser.add_argument("--methods", default=",".join(METHODS), help="comma-separated, of %(default)s")
    parser.add_argument(
        "--out", type=Path, default=Path("out/rivals"), help="METHOD/NAME.json go here; existing ones stay"
    )
    parser.add_argument("--jobs", type=int, default=1, help="cases at a time")
    parser.add_argument("--sealed", type=Path, help="opened sealed answers NAME.json: `ude` reads the law's port there")
    parser.add_argument("--smam", default="smam", help="the program")
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def open_jobs(arguments):
    """Cases and methods that have no answer yet."""
    methods = [m for m in arguments.methods.split(",") if m]
    unknown = [m for m in methods if m not in (*METHODS, *TOLD)]
    if unknown or not methods:
        raise CaseError(f"no method {', '.join(unknown)}: there are {', '.join((*METHODS, *TOLD))}")
    told = [m for m in methods if m in TOLD]
    if told and arguments.sealed is None:
        raise CaseError(f"{told[0]} is told where the law is: give the folder of opened answers with --sealed")
    smam = shutil.which(arguments.smam)
    if smam is None:
        raise CaseError(f"no program {arguments.smam}: build it (cargo build --release) and give --smam PATH")
    names = sorted(p.parent.name for p in arguments.cases.glob("*/recordings.toml"))
    if not names:
        raise CaseError(f"{arguments.cases} holds no NAME/recordings.toml")
    smam, jobs = str(Path(smam).resolve()), []
    for name in names:
        missing = [m for m in methods if not (arguments.out / m / f"{name}.json").exists()]
        if missing:
            folders = (arguments.cases, arguments.diagnoses, arguments.out, arguments.sealed)
            jobs.append((folders, name, missing, smam, arguments.seed))
    return jobs


def run_case(job):
    """All open methods of a case. Returns what failed, as text, or None."""
    (cases, diagnoses, _, sealed), name, methods, smam, _ = job
    begun = time.perf_counter()
    try:
        case = load_case(cases, name, diagnoses, smam)
    except MENDABLE as error:
        return complain(name, error)
    preparation = time.perf_counter() - begun
    failed = []
    for method in methods:
        try:
            case.given_port = hidden_port(sealed, name) if method in TOLD else None
            run_method(case, method, job, preparation)
        except NotForThisCase as error:
            complain(f"{name} {method}", error)
        except MENDABLE as error:
            failed.append(complain(f"{name} {method}", error))
    return ", ".join(failed) or None


def run_method(case, method, job, preparation):
    """One answer, and its errors on the holdout that is opened only then."""
    (cases, _, out, _), name, _, _, seed = job
    module = importlib.import_module(method)
    begun, begun_cpu = time.perf_counter(), time.process_time()
    answer = module.answer(case, seed)
    answer.notes["seconds_cpu"] = round(time.process_time() - begun_cpu, 3)
    seconds = time.perf_counter() - begun
    figures = holdout_figures(case, answer, sealed_outputs(cases, name, case.outputs), channel_noise(case))
    write_whole(out / method / f"{name}.json", as_json(method, answer, figures, seconds, preparation))
    print(f"{name} {method}: {summary(answer, figures)} {seconds:.1f} s", file=sys.stderr, flush=True)


def complain(what, error):
    """Says what went wrong; returns with what."""
    text = str(error) if isinstance(error, CaseError) else f"{type(error).__name__}: {error}"
    print(f"{what}: {text}", file=sys.stderr, flush=True)
    return what


def summary(answer, figures):
    """An answer in a line."""
    named = ", ".join(f"{e['name']}@{e['element']} {e['probability']:.2f}" for e in answer.effects)
    return f"{answer.verdict} [{named}] gap closed {figures['gap_closed']:.2f},"


if __name__ == "__main__":
    main()
