#!/usr/bin/env python3
"""Opens the program's pages in a browser and explores them as a reader would.

    VENV/bin/python tests/pages/check.py --smam target/release/smam [--keep FOLDER]

VENV holds playwright; the browser is Debian's `chromium`, or playwright's own. Where either is missing the exit code is 77.

Made        One page of each kind: diagnosis, comparison, sweeps over one key, two and four, identification, reproduction; and a comparison
            of a run whose file name is made of HTML.
Looked at   At 390, 1280 and 1920 px, light and dark: nothing reaches beyond the window, no error, no request, every figure is drawn. On paper too.
Explored    Cursor, zoom and the way back, lines off and on, another run and channel, marked stretches, CSV against what was recorded; of a
            sweep sorting, filters, stretches on parallel axes, and a point's command, which is run.

--keep FOLDER keeps the pages and a picture of each.
"""

import argparse
import shutil
import sys
import tempfile
from pathlib import Path

import explore
import made

try:
    from playwright.sync_api import Error as BrowserError
    from playwright.sync_api import sync_playwright
except ImportError:
    print("skipped: playwright is not installed")
    sys.exit(77)

WIDTHS = (390, 1280, 1920)
SCHEMES = ("light", "dark")


class Watched:
    """A page in the browser, with what it did that it should not have done."""

    def __init__(self, browser, file, width, scheme):
        self.name = f"{file.parent.name}/{file.name} at {width} px, {scheme}"
        self.faults = []
        self.page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme, accept_downloads=True)
        self.page.on("console", lambda m: m.type in ("error", "warning") and self.faults.append(f"{self.name}: console: {m.text}"))
        self.page.on("pageerror", lambda e: self.faults.append(f"{self.name}: error: {e}"))
        self.page.on("request", self.requested)
        self.page.goto(file.as_uri())

    def requested(self, request):
        if not request.url.startswith(("file:", "blob:")):
            self.faults.append(f"{self.name}: asks for {request.url}")

    def expect(self, holds, what):
        if not holds:
            self.faults.append(f"{self.name}: {what}")


def scroll_through(page):
    """Figures are drawn when they come into view."""
    height = page.evaluate("document.documentElement.scrollHeight")
    for y in range(0, height, 600):
        page.evaluate(f"scrollTo(0, {y})")
        page.wait_for_timeout(40)
    page.evaluate("scrollTo(0, 0)")
    page.wait_for_timeout(60)


def look(watched, picture=None):
    """What holds of every page at every width."""
    page = watched.page
    scroll_through(page)
    width = page.evaluate("document.documentElement.scrollWidth")
    watched.expect(width <= page.viewport_size["width"], f"is {width} px wide")
    blank = page.evaluate(explore.BLANK_FIGURES)
    watched.expect(not blank, f"figures that are blank: {blank}")
    watched.expect(not page.evaluate(explore.CUT_TABLES), "a table is cut, and nothing shows it")
    watched.expect(page.evaluate("window.broken === undefined"), "a name was read as script")
    if picture:
        page.screenshot(path=picture, full_page=True)


def print_it(watched):
    """On paper: all figures are drawn, and none is wider than the sheet."""
    sheets = watched.page.pdf(format="A4")
    watched.expect(len(sheets) > 10_000, "prints nothing")
    watched.expect(watched.page.evaluate("document.documentElement.className") == "", "stays as on paper after it was printed")


def check_page(browser, file, explorations, keep):
    faults = []
    for width in WIDTHS:
        for scheme in SCHEMES:
            watched = Watched(browser, file, width, scheme)
            look(watched, keep / f"{file.parent.name}_{width}_{scheme}.png" if keep else None)
            if (width, scheme) == (WIDTHS[-1], SCHEMES[0]):
                for exploration in explorations:
                    exploration(watched)
                print_it(watched)
            faults += watched.faults
            watched.page.close()
    print(f"{'FAIL' if faults else 'ok  '}  {file.parent.name}/{file.name}: {file.stat().st_size // 1024} kB")
    return faults


def launch(playwright):
    """Debian's browser, else playwright's own; none: None."""
    for path in [shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome")] + [None]:
        try:
            return playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        except BrowserError:
            continue
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--smam", required=True)
    parser.add_argument("--keep", type=Path, help="keep pages and pictures in this folder")
    arguments = parser.parse_args()
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as scratch:
        browser = launch(playwright)
        if browser is None:
            print("skipped: there is no chromium")
            return 77
        folder = arguments.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        pages = made.pages(Path(arguments.smam).resolve(), folder.resolve())
        faults = [fault for file, explorations in pages for fault in check_page(browser, file, explorations, arguments.keep)]
        browser.close()
    print("\n".join(faults), file=sys.stderr, end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
