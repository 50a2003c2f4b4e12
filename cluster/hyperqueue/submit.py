#!/usr/bin/env python3
"""A sweep as a HyperQueue job: one task per shard, and a last one that merges them.

Again with the same arguments: only the shards that are not complete are submitted. Needs `pip install hyperqueue`, of the version of the
server that it submits to.
"""

import argparse
import shutil
import sys
from pathlib import Path

from hyperqueue import Job
from hyperqueue.client import Client
from hyperqueue.ffi.protocol import ResourceRequest

# Workers that may be lost under a shard before it is taken for the cause, and fails.
LOST_WORKERS = 5

CLUSTER = Path(__file__).resolve().parent.parent


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sweep", type=Path, metavar="SWEEP.toml")
    parser.add_argument("--shards", type=positive, required=True, metavar="N", help="tasks; each gets every N-th point")
    parser.add_argument("--out", type=Path, metavar="DIR", help="shards, logs and the merged table [default: out/sweep_STEM]")
    parser.add_argument("--cpus", type=positive, default=1, metavar="C", help="cores and threads of each shard [default: 1]")
    parser.add_argument("--smam", default="smam", help="the program, on a disk that all workers see [default: smam, from PATH]")
    parser.add_argument("--server-dir", type=Path, metavar="DIR", help="as told to `hq server start` [default: ~/.hq-server]")
    parser.add_argument("--wait", action="store_true", help="stay until all is done; exit code 1 if something failed")
    return parser.parse_args()


def positive(text):
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError("must be at least 1")
    return number


def undone(shards, out):
    return [i for i in range(1, shards + 1) if not (out / f"shard_{i}_of_{shards}" / "done").exists()]


def sweep_job(sweep, smam, out, shards, cpus):
    """The shards that are not complete, and the merge, which waits for them."""
    # No limit on failures: a shard that fails does not take the others with it.
    job = Job(name=out.name, default_workdir=out, max_fails=None)
    tasks = [
        job.program(
            logged(out / "log" / f"shard_{i}.txt", CLUSTER / "shard.sh", i, shards, out, smam, "sweep", sweep, "--threads", cpus),
            name=f"shard {i}/{shards}",
            resources=ResourceRequest(cpus=cpus),
            crash_limit=LOST_WORKERS,
            stdout=None,
            stderr=None,
        )
        for i in undone(shards, out)
    ]
    merge = logged(out / "log" / "merge.txt", CLUSTER / "merge.sh", shards, out, smam, sweep)
    job.program(merge, name="merge", deps=tasks, stdout=None, stderr=None)
    return job


def logged(log, *command):
    """The command, what it says appended to a log: HyperQueue's own begin anew with each attempt."""
    return ["bash", "-c", 'exec "$@" >>"$0" 2>&1', str(log), *map(str, command)]


def connected(server_dir):
    try:
        return Client(server_dir)
    except Exception as error:
        reason = str(error).splitlines()[0]
        sys.exit(f"error: no HyperQueue server: {reason}\n  remedy: hq server start, or --server-dir; server and package of one version")


def main():
    asked = arguments()
    smam = shutil.which(asked.smam)
    if smam is None:
        sys.exit(f"error: {asked.smam}: no such program\n  remedy: --smam /path/to/smam")
    if not asked.sweep.is_file():
        sys.exit(f"error: {asked.sweep}: no such sweep file")
    out = (asked.out or Path("out") / f"sweep_{asked.sweep.stem}").resolve()
    (out / "log").mkdir(parents=True, exist_ok=True)

    client = connected(asked.server_dir)
    job = sweep_job(asked.sweep.resolve(), str(Path(smam).resolve()), out, asked.shards, asked.cpus)
    submitted = client.submit(job)
    shards = [task.name for task in job.tasks[:-1]]
    print(f"job {submitted.id}: {len(shards)} of {asked.shards} shards, then the merge into {out}/table.csv; logs in {out}/log", flush=True)
    if not asked.wait:
        return
    if client.wait_for_jobs([submitted], raise_on_error=False):
        return
    for task, failure in sorted(client.get_failed_tasks(submitted).items()):
        print(f"{job.task_by_id(task).label} failed: {failure.error}", file=sys.stderr)
    sys.exit("not merged\n  remedy: see the logs, then submit again with the same arguments; what is done is kept")


if __name__ == "__main__":
    main()
