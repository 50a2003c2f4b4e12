"""What cargo says of the packages in the tree."""

import json
import re
import subprocess
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
# Counted for this one, wherever the check runs.
TARGET = "x86_64-unknown-linux-gnu"
WITHOUT_VIEWER = ("--no-default-features", "--features", "validation")
EMBEDDED = ("--no-default-features",)
LINE = re.compile(r"^(\d+)(\S+) v(\S+)")


class Unavailable(RuntimeError):
    """Cargo could not tell."""


def cargo(*arguments):
    """Cargo's output, from what is on the disk; only where that is not complete, with the network."""
    for offline in (["--offline"], []):
        done = subprocess.run(["cargo", *arguments, "--locked", *offline], cwd=TOP, capture_output=True, text=True)
        if done.returncode == 0:
            return done.stdout
    raise Unavailable(f"cargo {' '.join(arguments)}: {done.stderr.strip()}\n  remedy: cargo fetch --locked, once, with the network")


def metadata():
    """All packages of the lock, for every platform and feature: our own, all, and by name those that ours asks for."""
    told = json.loads(cargo("metadata", "--format-version", "1"))
    by_id = {p["id"]: p for p in told["packages"]}
    root = told["resolve"]["root"]
    node = next(n for n in told["resolve"]["nodes"] if n["id"] == root)
    return by_id[root], told["packages"], {by_id[i]["name"]: by_id[i] for i in node["dependencies"]}


def graph(kinds, features=()):
    """What is built on Linux: packages, each with those it needs. `kinds`: normal, build, dev."""
    return read_graph(cargo("tree", "--edges", kinds, "--prefix", "depth", "--target", TARGET, *features))


def read_graph(text):
    """Of lines that begin with their depth. Cargo spreads a package out once, so a later mention has nothing below it."""
    needs, above = {}, []
    for match in filter(None, map(LINE.match, text.splitlines())):
        package = match[2], match[3]
        del above[int(match[1]) :]
        needs.setdefault(package, set())
        if above:
            needs[above[-1]].add(package)
        above.append(package)
    return needs


def reached(needs, without=None):
    """Packages below the first one, with one of its own dependencies left out."""
    root = next(iter(needs))
    seen, todo = {root}, [root]
    while todo:
        package = todo.pop()
        below = {p for p in needs[package] if package != root or p[0] != without}
        todo += below - seen
        seen |= below
    return seen - {root}


class Counts:
    """How many packages there are, and how many a direct dependency brings."""

    def __init__(self):
        self.embedded = graph("normal,build", EMBEDDED)
        self.without_viewer = graph("normal,build", WITHOUT_VIEWER)
        self.with_viewer = graph("normal,build")
        self.tests = graph("normal,build,dev", WITHOUT_VIEWER)

    def sums(self):
        """The rows of the page's table of sums."""
        return {
            "what others embed": len(reached(self.embedded)),
            "the program without the viewer": len(reached(self.without_viewer)),
            "the program with the viewer": len(reached(self.with_viewer)),
            "without the viewer, with tests and benchmarks": len(reached(self.tests)),
        }

    def brings(self, name, kind):
        """Packages that are there for its sake alone, itself among them: 0 if others bring it anyway."""
        needs = self.tests if kind == "dev" else self.with_viewer if name == "rerun" else self.without_viewer
        return len(reached(needs)) - len(reached(needs, name))


def self_test():
    """A tree of five."""
    needs = read_graph("0top v1.0.0 (/x)\n1a v1.0.0\n2c v1.0.0\n3d v2.0.0\n1b v1.0.0\n2c v1.0.0 (*)\n1e v1.0.0 (proc-macro)\n")
    assert needs["c", "1.0.0"] == {("d", "2.0.0")} and needs["b", "1.0.0"] == {("c", "1.0.0")}
    assert len(reached(needs)) == 5 and len(reached(needs, "a")) == 4 and len(reached(needs, "b")) == 4
