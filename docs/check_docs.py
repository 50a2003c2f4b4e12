#!/usr/bin/env python3
"""Checks that the documentation is true: links, data, commands, spelling.

Looks at README.md, ARCHITECTURE.md, CHANGELOG.md, proof/README.md, benches/**/README.md and docs/**/*.md.

Links     Every relative link and picture exists, anchors included. A page of the book links to no file outside docs/,
          and docs/SUMMARY.md lists all pages.
Length    README.md and the book's user guide together are short enough to be read: 15,000 words.
Data      Every fenced block of toml or json can be read.
Commands  Every fenced block of sh in README.md and docs/ is run, line by line, in one scratch folder per page which holds
          scenes/ and models/ as a clone does. `smam` and `cargo run --release --` both mean the program of --smam.
Spelling  British English by `typos`, with the exceptions in docs/spelling.toml.

Words after a fence's language, with commas between:
  sh,exit=2                the lines must end with this exit code (else 0)
  sh,norun(takes 4 min)    not run, for this reason
  text,output              each of its lines but `...` was printed by the block of sh before it
  toml,file=NAME           written to NAME (any language) before later commands run
"""

import argparse
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path
from urllib.parse import unquote

from doc_pages import Block, Fault, Page, pages_of, read_page

LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(\s*<?([^)\s>]*)>?(?:\s+\"[^\"]*\")?\s*\)")
HTML_LINK = re.compile(r"<(?:a|img)\b[^>]*?(?:href|src)=\"([^\"]+)\"")
DEFINITION = re.compile(r"^ {0,3}\[[^\]^][^\]]*\]:\s+(\S+)", re.MULTILINE)
LIMIT_S = 600
CARGO = """#!/bin/sh
# On a page, `cargo run --release --` is the program itself.
if [ "$1 $2" = "run --release" ]; then
    shift 2
    [ "$1" = --no-default-features ] && shift
    [ "$1 $2" = "--features validation" ] && shift 2
    [ "$1" = -- ] && shift && exec smam "$@"
fi
echo "check_docs: of cargo's commands only 'cargo run --release -- ...' can be tried here" >&2
exit 127
"""


# Links


def slug(heading: str) -> str:
    """The anchor that GitHub and mdBook give to a heading."""
    words = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").strip().lower()
    return re.sub(r"\s", "-", re.sub(r"[^\w\s-]", "", words))


def anchors(page: Page) -> set[str]:
    """All anchors of a page; a heading that comes twice has -1 at its second place."""
    found: dict[str, int] = {}
    for line in page.prose:
        if match := re.match(r"#{1,6}\s+(.*?)\s*#*$", line):
            name = slug(match[1])
            found[name] = found.get(name, -1) + 1
    explicit = {a for line in page.prose for a in re.findall(r"<a (?:id|name)=\"([^\"]+)\"", line)}
    return explicit | {f"{name}-{i}" if i else name for name, times in found.items() for i in range(times + 1)}


def links(page: Page) -> list[tuple[int, str]]:
    """Lines and targets of all links that lead to files."""
    text = "\n".join(page.prose)
    # What stands in backticks is no link. Its length stays, so that lines can be counted.
    plain = re.sub(r"(`+)(?:(?!\n\n).)+?\1", lambda m: re.sub(r"[^\n]", "x", m[0]), text, flags=re.DOTALL)
    found = [m for pattern in (LINK, HTML_LINK, DEFINITION) for m in pattern.finditer(plain)]
    return [(text.count("\n", 0, m.start()) + 1, m[1]) for m in found if not re.match(r"[a-z][a-z0-9+.-]*:", m[1])]


def check_link(root: Path, page: Page, target: str, cache: dict[str, set[str]], later: set[str]) -> str | None:
    """What is wrong with a link, if anything."""
    path, _, anchor = unquote(target).partition("#")
    file = (root / page.name).parent / path if path else root / page.name
    try:
        name = file.resolve().relative_to(root.resolve()).as_posix()
    except ValueError:
        return f"{target} leads out of the repository"
    if page.name.startswith("docs/") and not name.startswith("docs/"):
        return f"{target} is outside docs/, so the book does not hold it: name the file without a link"
    if not file.exists():
        return None if name in later else f"{target} does not exist"
    if anchor and file.suffix == ".md":
        if name not in cache:
            cache[name] = anchors(read_page(name, file.read_text()))
        if anchor not in cache[name]:
            return f"{target}: there is no heading #{anchor} (there are: {', '.join(sorted(cache[name]))})"
    return None


def check_links(root: Path, pages: list[Page], later: set[str]) -> list[Fault]:
    """Faults of all links."""
    cache: dict[str, set[str]] = {}
    wrong = [(page.name, line, check_link(root, page, t, cache, later)) for page in pages for line, t in links(page)]
    return [Fault(name, line, text) for name, line, text in wrong if text]


def check_contents(root: Path) -> list[Fault]:
    """Pages of docs/ that the book's table of contents does not list: mdBook would leave them out without a word."""
    table = root / "docs" / "SUMMARY.md"
    if not table.exists():
        return [Fault("docs/SUMMARY.md", 0, "does not exist; it lists the pages of the book")]
    listed = {(table.parent / target).resolve() for _, target in links(read_page("docs/SUMMARY.md", table.read_text()))}
    missing = [p for p in sorted(table.parent.rglob("*.md")) if p != table and p.resolve() not in listed]
    return [Fault("docs/SUMMARY.md", 0, f"does not list {p.relative_to(table.parent).as_posix()}: add a line for it") for p in missing]


# Length

GUIDE = "# User guide"
GUIDE_WORDS = 15_000


def check_length(root: Path) -> list[Fault]:
    """The user guide, if it has grown beyond what somebody reads."""
    name = "docs/SUMMARY.md"
    parts = re.split(r"^(?=# )", (root / name).read_text(), flags=re.MULTILINE)
    guide = [part for part in parts if part.startswith(GUIDE)]
    if not guide:
        return [Fault(name, 0, f"has no part '{GUIDE}'")]
    files = [root / "README.md", *(root / "docs" / target for _, target in links(read_page(name, guide[0])))]
    words = sum(len(file.read_text().split()) for file in files if file.exists())
    if words <= GUIDE_WORDS:
        return []
    return [Fault(name, 0, f"the user guide has {words} words, more than {GUIDE_WORDS}: what is looked up belongs to the reference")]


# Data


def check_data(pages: list[Page]) -> list[Fault]:
    """Faults of fences' words, and of blocks of toml and json."""
    faults = []
    for page in pages:
        for block in page.blocks:
            faults += [Fault(page.name, block.line, f"'{w}' after the fence is not known (--help lists what is)") for w in block.unknown]
            try:
                {"toml": tomllib.loads, "json": json.loads}.get(block.language, str)(block.text)
            except ValueError as error:
                faults.append(Fault(page.name, block.line, f"{block.language} cannot be read: {error}"))
    return faults


# Commands


def commands(block: Block) -> list[tuple[int, str]]:
    """The commands of a block with their lines: comments left out, lines that end in a backslash joined with the next."""
    found, held, begun = [], "", 0
    for number, line in enumerate(block.lines, block.line + 1):
        if not held and (not line.strip() or line.lstrip().startswith("#")):
            continue
        begun = begun if held else number
        held += (line.strip() if held else line).removesuffix("\\")
        if not line.endswith("\\"):
            found.append((begun, held.strip()))
            held = ""
    return found + ([(begun, held.strip())] if held else [])


def lay_out(folder: Path, root: Path, smam: Path) -> dict[str, str]:
    """Fills a scratch folder like a clone and gives the environment in which `smam` and `cargo` are found."""
    for name in ("scenes", "models"):
        if (root / name).is_dir():
            shutil.copytree(root / name, folder / name)
    tools = folder / ".tools"
    tools.mkdir()
    (tools / "smam").symlink_to(smam.resolve())
    (tools / "cargo").write_text(CARGO)
    (tools / "cargo").chmod(0o755)
    return {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "COLUMNS": "120"}


def cpu_s() -> float:
    """Seconds of CPU time of all commands so far: on a busy machine the clock says little."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run_line(line: str, folder: Path, env: dict[str, str]) -> tuple[int, str]:
    """Exit code and output of one line."""
    try:
        done = subprocess.run(["bash", "-uo", "pipefail", "-c", line], cwd=folder, env=env, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LIMIT_S)
        return done.returncode, done.stdout
    except subprocess.TimeoutExpired:
        return 124, f"not done after {LIMIT_S} s"


def run_block(page: str, block: Block, folder: Path, env: dict[str, str], times: bool) -> tuple[list[Fault], str]:
    """Runs a block; what it printed serves for the output shown after it."""
    faults, printed, wanted = [], "", int(block.words.get("exit", "0"))
    for number, line in commands(block):
        begun = time.monotonic(), cpu_s()
        code, output = run_line(line, folder, env)
        printed += output
        if times:
            print(f"{time.monotonic() - begun[0]:7.2f} s, CPU {cpu_s() - begun[1]:6.2f} s  {page}:{number}  {line}", flush=True)
        if code != wanted:
            faults.append(Fault(page, number, f"exit code {code} instead of {wanted}: {line}\n    " + "\n    ".join(output.splitlines()[-8:])))
    return faults, printed


def missing_output(block: Block, printed: str) -> list[tuple[int, str]]:
    """Lines that a page shows and the commands before did not print. Spacing does not count, nor do lines of dots."""
    there = " ".join(printed.split())
    shown = [(n, " ".join(line.split())) for n, line in enumerate(block.lines, block.line + 1)]
    # A line may be shortened: what stands before and after each `...` must have been printed.
    return [(n, line) for n, line in shown if not all(part.strip() in there for part in line.split("..."))]


def run_page(page: Page, folder: Path, env: dict[str, str], times: bool) -> list[Fault]:
    """Writes the files of a page and runs its commands, in the page's order."""
    faults, printed = [], ""
    for block in page.blocks:
        if name := block.words.get("file"):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(block.text)
        elif block.language == "sh" and "norun" in block.words:
            printed = None
            print(f"not run    {page.name}:{block.line}: {block.words['norun']}", flush=True)
        elif block.language == "sh":
            found, printed = run_block(page.name, block, folder, env, times)
            faults += found
        elif "output" in block.words and printed is not None:
            faults += [Fault(page.name, n, f"was not printed: {line}") for n, line in missing_output(block, printed)]
    return faults


def check_commands(root: Path, pages: list[Page], smam: Path, times: bool) -> list[Fault]:
    """Faults of all commands of README.md and the book."""
    faults = []
    for page in pages:
        if page.name != "README.md" and not page.name.startswith("docs/"):
            continue
        if any(b.language == "sh" or b.words for b in page.blocks):
            with tempfile.TemporaryDirectory(prefix="check_docs_") as scratch:
                faults += run_page(page, Path(scratch), lay_out(Path(scratch), root, smam), times)
    return faults


# Spelling


def check_spelling(root: Path, names: list[str], typos: str) -> list[Fault]:
    """Faults that `typos` finds."""
    config = Path(__file__).resolve().parent / "spelling.toml"
    program = str(Path(typos).resolve()) if "/" in typos else typos
    done = subprocess.run([program, "--config", str(config), "--format", "json", *names], cwd=root, capture_output=True, text=True)
    if done.returncode not in (0, 2):
        return [Fault("typos", 0, done.stderr.strip())]
    found = [json.loads(line) for line in done.stdout.splitlines()]
    return [Fault(f["path"], f["line_num"], f"'{f['typo']}' should be '{' or '.join(f['corrections'])}'") for f in found if f["type"] == "typo"]


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pages", nargs="*", metavar="PAGE", help="only these pages (links into others are followed all the same)")
    parser.add_argument("--root", type=Path, default=Path(__file__).resolve().parent.parent, help="the repository")
    parser.add_argument("--smam", type=Path, help="the program; without it no command is run")
    parser.add_argument("--typos", metavar="PROGRAM", help="typos; without it spelling is not looked at")
    parser.add_argument("--times", action="store_true", help="print each command with the seconds that it took")
    parser.add_argument("--later", action="append", default=[], metavar="FILE", help="links to this file are right though it is missing")
    return parser.parse_args()


def main() -> int:
    arguments = parse_arguments()
    for file in [arguments.smam or arguments.root, *(arguments.root / name for name in arguments.pages)]:
        if not file.exists():
            print(f"{file}: does not exist; give the path from where you are (pages: from the root)", file=sys.stderr)
            return 2
    names = arguments.pages or pages_of(arguments.root)
    pages = [read_page(name, (arguments.root / name).read_text()) for name in names]
    faults = check_links(arguments.root, pages, set(arguments.later)) + check_data(pages) + check_contents(arguments.root)
    faults += check_length(arguments.root)
    if arguments.typos:
        faults += check_spelling(arguments.root, names, arguments.typos)
    if arguments.smam:
        faults += check_commands(arguments.root, pages, arguments.smam, arguments.times)
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"{len(pages)} pages, {sum(len(links(p)) for p in pages)} links, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
