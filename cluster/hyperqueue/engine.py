#!/usr/bin/env python3
"""HyperQueue's server, or a worker of one core, as a process of its own: for the test.

    engine.py server DIR            the server; DIR is its folder, as with `hq server start --server-dir DIR`
    engine.py worker DIR OWN_DIR    a worker that joins it

PyPI's package holds server and worker, but not the program `hq`. Its worker starts in the process of a server only, and joins the one whose
access file it finds in the folder of that server; so a worker here has a server of its own, idle, and finds the other's access file.
"""

import os
import signal
import sys
from pathlib import Path

from hyperqueue.cluster import LocalCluster, WorkerConfig

ACCESS = "hq-current"  # a link in a server's folder, to the folder of the access file


def server(folder):
    return LocalCluster(folder)


def worker(folder, own):
    cluster = LocalCluster(own)
    link = Path(own) / ACCESS
    link.unlink()
    link.symlink_to((Path(folder) / ACCESS).resolve(), target_is_directory=True)
    cluster.start_worker(WorkerConfig(cores=1))
    return cluster


def main():
    kind, *folders = sys.argv[1:]
    for folder in folders:
        os.makedirs(folder, exist_ok=True)
    kept = {"server": server, "worker": worker}[kind](*folders)
    print("ready", flush=True)
    signal.pause()
    del kept


if __name__ == "__main__":
    main()
