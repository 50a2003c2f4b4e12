"""Files of others that lie in the tree: unchanged, with their licence, and written down in docs/dependencies.md."""

import hashlib
from pathlib import Path

# Of the package as npm has it: https://registry.npmjs.org/uplot/-/uplot-1.6.32.tgz,
# sha512-KIMVnG68zvu5XXUbC4LQEPnhwOxBuLyW1AHtpm6IKTXImkbLgkMy+jabjLgSLMasNuGGzQm/ep3tOkyTxpiQIw==
UPLOT = "src/report/kit/uplot"
VERSION = "1.6.32"
SHA256 = {
    "LICENSE": "8f989229699b4fe2f1a0432d0e9edc338a8a911e250e2d1b01ecd770a5f5b1bd",
    "uPlot.iife.min.js": "19c8d4c6ad88929a79f4ae49d6f7161566dfd0ba3d15cc495e974f787eb78f1f",
    "uPlot.min.css": "df630c6a8d6f8eeaff264b50f73ce5b114f646ffd9a0bb74f049b0a00135fa04",
}


def check(top: Path, page: str):
    """Faults of the vendored files, and of what the page says of them."""
    folder = top / UPLOT
    there = {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in folder.iterdir()}
    faults = [f"{UPLOT}/{name}: is no file of uPlot {VERSION}; remedy: delete it" for name in there.keys() - SHA256.keys()]
    for name, digest in SHA256.items():
        if there.get(name) != digest:
            faults.append(f"{UPLOT}/{name}: is not that of uPlot {VERSION}; remedy: take it from the package again, unchanged")
    if f"uPlot {VERSION}" not in page or UPLOT not in page:
        faults.append(f"docs/dependencies.md: does not name uPlot {VERSION} and {UPLOT}")
    return faults


def self_test(top: Path):
    assert check(top, f"uPlot {VERSION} {UPLOT}") == []
    assert len(check(top, "")) == 1
