#!/usr/bin/env python3
"""Makes docs/images/pages/*.webp again: the top of each HTML page at every width, light and dark, on one sheet.

    VENV/bin/python tests/pages/check.py --smam target/release/smam --keep SHOTS
    VENV/bin/python docs/make_page_sheets.py SHOTS

SHOTS: a new folder. Needs playwright and pillow.
"""

import re
import sys
from pathlib import Path

from PIL import Image

OUT = Path(__file__).resolve().parent / "images" / "pages"
SCHEMES = ("light", "dark")
# A page of recordings with an evil name: it looks like the other comparison.
LEFT_OUT = {"evil_comparison"}
# What is shown of a page, px, and how large.
TOP = 1500
SCALE = 0.45
GAP = 8
PAPER = "#9a9a9a"


def shots(folder: Path) -> dict[str, dict[tuple[int, str], Path]]:
    """Pictures by page, then by width and scheme."""
    found: dict[str, dict[tuple[int, str], Path]] = {}
    for file in sorted(folder.glob("*.png")):
        if match := re.fullmatch(r"(.+)_(\d+)_(light|dark)", file.stem):
            name, width, scheme = match.groups()
            found.setdefault(name, {})[int(width), scheme] = file
    return found


def top_of(file: Path) -> Image.Image:
    with Image.open(file) as picture:
        cut = picture.convert("RGB").crop((0, 0, picture.width, min(TOP, picture.height)))
    return cut.resize((round(SCALE * cut.width), round(SCALE * cut.height)), Image.Resampling.LANCZOS)


def sheet(pictures: dict[tuple[int, str], Path]) -> Image.Image:
    """One row for each scheme, the widest first."""
    widths = sorted({width for width, _ in pictures}, reverse=True)
    rows = [[top_of(pictures[width, scheme]) for width in widths] for scheme in SCHEMES]
    heights = [max(picture.height for picture in row) for row in rows]
    whole = sum(picture.width for picture in rows[0]) + GAP * (len(widths) + 1)
    drawn = Image.new("RGB", (whole, sum(heights) + GAP * (len(rows) + 1)), PAPER)
    y = GAP
    for row, height in zip(rows, heights, strict=True):
        x = GAP
        for picture in row:
            drawn.paste(picture, (x, y))
            x += picture.width + GAP
        y += height + GAP
    return drawn


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    found = shots(Path(sys.argv[1]))
    if not found:
        print(f"{sys.argv[1]}: no pictures of pages; tests/pages/check.py --keep makes them", file=sys.stderr)
        return 1
    OUT.mkdir(parents=True, exist_ok=True)
    for name, pictures in found.items():
        if name in LEFT_OUT:
            continue
        sheet(pictures).save(OUT / f"{name}.webp", quality=60, method=6)
        print(f"{name}: {len(pictures)} pictures")
    return 0


if __name__ == "__main__":
    sys.exit(main())
