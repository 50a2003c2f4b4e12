#!/usr/bin/env python3
"""Checks what the program is built from, and what it opens to the network.

    tests/dependencies/check.py [--smam target/release/smam]

Licences   Those of all packages in Cargo.lock can be kept with the licences in licences.py.
Sources    Everything comes from crates.io; nothing from git, nothing from a folder but our own.
Page       docs/dependencies.md has every direct dependency and no other, with the licence, the folders and the counts that are true.
Vendored   Files of others in the tree are unchanged, by their hashes, and have their licence beside them.
Pins       Crates whose format or numerics change between minor releases are pinned exactly; the viewer's version is the same everywhere.
Unsafe     None in our own code, and Cargo.toml forbids it.
Advisories By cargo-audit or cargo-deny with a database, where they are installed.
Network    With --smam: the viewer's server listens on loopback, other commands open no socket (by strace), nothing can report usage. Linux only.
"""

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import licences
import network
import tree
import vendored

TOP = tree.TOP
PAGE = TOP / "docs" / "dependencies.md"
CRATES_IO = "registry+https://github.com/rust-lang/crates.io-index"
PINNED = {"rapier3d-f64", "rerun", "mcap"}
# Advisories that do not reach us, and why; to be looked at again with each new version of the crate.
ACCEPTED = {
    "RUSTSEC-2026-0194": "quick-xml: urdf-rs only writes with it, and we only read",
    "RUSTSEC-2026-0195": "quick-xml: likewise",
}
VIEWER_VERSION = re.compile(r"(?:rerun-sdk==|rerun_version=)(\d[\d.]*\d)")
# What is no code in Rust: comments, strings, characters.
NO_CODE = re.compile(r"//[^\n]*|/\*.*?\*/|(?<!\w)b?r(#*)\".*?\"\1|\"(?:\\.|[^\"\\])*\"|'(?:\\[^\n]{1,9}?|[^\\'\n])'", re.DOTALL)


def check_sources(packages):
    """Nothing but crates.io and ourselves."""
    faults = []
    for package in packages:
        own = Path(package["manifest_path"]).parent == TOP
        if package["source"] != CRATES_IO and not (own and package["source"] is None):
            faults.append(f"{package['name']} {package['version']} comes from {package['source'] or package['manifest_path']}, not from crates.io")
    return faults


def tables(text, first):
    """Rows of the tables whose first column is called so, as lists of cells."""
    rows, inside = [], False
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")] if line.startswith("|") else None
        if cells is None or cells[0] == first:
            inside = cells is not None
        elif inside and set(cells[0]) - set("-:"):
            rows.append(cells)
    return rows


def check_page(root, resolved, counts, page, fuzz):
    """The page against Cargo.toml. A row: crate, what for, where, why not our own, licence, packages, note."""
    rows = {cells[0].strip("`"): cells for cells in tables(page, "crate")}
    direct = {d["name"]: d for d in root["dependencies"]}
    faults = [f"docs/dependencies.md: no row for {name}; remedy: add what it is for" for name in (direct.keys() | fuzz) - rows.keys()]
    faults += [f"docs/dependencies.md: {name} is no dependency any more; remedy: delete its row" for name in rows.keys() - direct.keys() - fuzz]
    for name in direct.keys() & rows.keys():
        licence = " OR ".join(re.split(r" OR |\s*/\s*", resolved[name]["license"]))
        brings = str(counts.brings(name, direct[name]["kind"]))
        for column, says, true in (("licence", rows[name][4], licence), ("packages", rows[name][5], brings)):
            if says != true:
                faults.append(f"docs/dependencies.md, {name}, {column}: '{says}' should be '{true}'")
        faults += check_folders(name, rows[name][2])
    sums = {cells[0]: cells[1] for cells in tables(page, "built")}
    for what, number in counts.sums().items():
        if sums.get(what) != str(number):
            faults.append(f"docs/dependencies.md, {what}: '{sums.get(what)}' should be '{number}'")
    return faults


def check_folders(name, cell):
    """Every place that a row names does use the crate."""
    faults = []
    for place in re.findall(r"`([^`]+)`", cell):
        path = TOP / place
        files = path.rglob("*.rs") if path.is_dir() else [path]
        word = re.compile(rf"\b{name.replace('-', '_')}\b")
        if not any(word.search(f.read_text()) for f in files if f.is_file()):
            faults.append(f"docs/dependencies.md, {name}: {place} does not use it")
    return faults


def check_pins(root, packages):
    """Exact versions, and the viewer's wherever it is named."""
    faults, exact = [], {d["name"]: d["req"][1:] for d in root["dependencies"] if d["req"].startswith("=")}
    faults += [f"Cargo.toml: {name} must be pinned exactly (=): its format or numerics change between releases" for name in PINNED - exact.keys()]
    locked = {(p["name"], p["version"]) for p in packages}
    faults += [f"Cargo.lock: {name} is not {version}, as Cargo.toml pins it" for name, version in exact.items() if (name, version) not in locked]
    places = [TOP / "README.md", TOP / "check.sh", *TOP.glob("docs/**/*.md"), *TOP.glob("src/**/*.rs")]
    for file in places:
        for version in VIEWER_VERSION.findall(file.read_text()):
            if version != exact.get("rerun"):
                faults.append(f"{file.relative_to(TOP)}: the viewer's version {version} is not {exact.get('rerun')}, that of Cargo.toml")
    return faults


def has_unsafe(text):
    return re.search(r"\bunsafe\b", NO_CODE.sub(" ", text)) is not None


def check_unsafe():
    """No unsafe code of our own; the compiler says so too."""
    faults = []
    for folder in ("src", "tests", "examples", "benches"):
        files = sorted((TOP / folder).rglob("*.rs"))
        faults += [f"{f.relative_to(TOP)}: unsafe code; remedy: do it in safe Rust" for f in files if has_unsafe(f.read_text())]
    lint = tomllib.loads((TOP / "Cargo.toml").read_text()).get("lints", {}).get("rust", {}).get("unsafe_code")
    if lint != "forbid":
        faults.append('Cargo.toml: [lints.rust] must say unsafe_code = "forbid"')
    return faults


def check_advisories():
    """Faults by a tool that is installed with its database; none of both: a reason instead."""
    home = Path.home() / ".cargo"
    ignored = [word for identity in ACCEPTED for word in ("--ignore", identity)]
    if shutil.which("cargo-audit") and (home / "advisory-db").is_dir():
        command = ["cargo", "audit", "--no-fetch", *ignored]
    elif shutil.which("cargo-deny") and list(home.glob("advisory-dbs/*")):
        command = ["cargo", "deny", "--offline", "check", "advisories"]
    else:
        return None, "no advisory data here (cargo-audit or cargo-deny with a database)"
    done = subprocess.run(command, cwd=TOP, capture_output=True, text=True)
    return ([] if done.returncode == 0 else [f"{' '.join(command)}: {done.stdout}{done.stderr}"]), " ".join(command[:2])


def self_test():
    licences.self_test()
    tree.self_test()
    network.self_test()
    vendored.self_test(TOP)
    assert has_unsafe("fn f() { unsafe { g() } }") and has_unsafe("let c = '\"'; unsafe { g() } // \"") and has_unsafe("unsafe impl A for B {}")
    assert not has_unsafe('// unsafe\n/* unsafe */ let a = "unsafe"; let b = r#"a "unsafe" b"#; unsafe_code(&\'a x)')
    elsewhere = {"name": "x", "version": "1", "manifest_path": "/x/Cargo.toml"}
    assert all(check_sources([elsewhere | {"source": s}]) for s in (None, "git+https://example.org/x", "registry+https://example.org/index"))
    assert not check_sources([elsewhere | {"source": CRATES_IO}, {"source": None, "manifest_path": str(TOP / "Cargo.toml")}])
    assert tables("| crate | b |\n|---|---|\n| `x` | 1 |\n\n| other | b |\n|---|---|\n| `y` | 2 |\n", "crate") == [["`x`", "1"]]
    assert VIEWER_VERSION.findall("rerun-sdk==0.36.3`, rerun_version=0.1.0 # x") == ["0.36.3", "0.1.0"]
    print("ok    self-test")


class Report:
    """One line for each check; the faults at the end."""

    def __init__(self):
        self.faults = []

    def add(self, name, faults, what=""):
        if faults is None:
            print(f"skipped: {name}: {what}")
            return
        print(f"{'FAIL' if faults else 'ok  '}  {name}{': ' + what if what and not faults else ''}")
        self.faults += faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--smam", help="the program, to look at what it opens")
    parser.add_argument("--self-test", action="store_true", help="test this script alone")
    arguments = parser.parse_args()
    self_test()
    if arguments.self_test:
        return 0
    try:
        (root, packages, resolved), counts = tree.metadata(), tree.Counts()
    except tree.Unavailable as error:
        print(error, file=sys.stderr)
        return 1
    fuzz = set(tomllib.loads((TOP / "fuzz" / "Cargo.toml").read_text())["dependencies"]) - {"smam"}
    report = Report()
    report.add("licences", licences.check(packages), f"{len(packages)} packages, all platforms")
    report.add("sources", check_sources(packages), "crates.io alone")
    sums = ", ".join(f"{number} {what}" for what, number in counts.sums().items())
    report.add("docs/dependencies.md", check_page(root, resolved, counts, PAGE.read_text(), fuzz), sums)
    report.add("vendored", vendored.check(TOP, PAGE.read_text()), f"uPlot {vendored.VERSION}")
    report.add("pins", check_pins(root, packages), ", ".join(sorted(PINNED)))
    report.add("unsafe", check_unsafe(), "none, and forbidden")
    report.add("advisories", *check_advisories())
    if arguments.smam:
        smam = str(Path(arguments.smam).resolve())
        report.add("reports of usage", network.reporting(smam), "no address for them in the program")
        with tempfile.TemporaryDirectory() as folder:
            report.add("server", *network.serve(smam, Path(folder)))
            report.add("other commands", *network.silent(smam, Path(folder)))
    print("\n".join(report.faults), file=sys.stderr, end="\n" if report.faults else "")
    return 1 if report.faults else 0


if __name__ == "__main__":
    sys.exit(main())
