"""Markdown pages taken apart: fenced blocks with the words after their language, and the prose between them."""

import re
from dataclasses import dataclass, field
from pathlib import Path

FENCE = re.compile(r"^(\s*)(`{3,}|~{3,})\s*(.*?)\s*$")
WORD = re.compile(r"(norun)\((.+)\)|(file|exit)=((?<=file=)[^,\s]+|(?<=exit=)\d+)|(output)$")


@dataclass(frozen=True)
class Fault:
    """Something that is not as the page says."""

    page: str
    line: int
    text: str

    def __str__(self) -> str:
        return f"{self.page}:{self.line}: {self.text}"


@dataclass
class Block:
    """A fenced block: where it begins, its language, the words after it, its text."""

    line: int
    language: str
    words: dict[str, str]
    unknown: list[str]
    lines: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        return "\n".join(self.lines) + "\n"


@dataclass
class Page:
    """A Markdown file, taken apart: fenced blocks, and the prose between them (blocks are empty lines there)."""

    name: str
    blocks: list[Block]
    prose: list[str]


def read_info(info: str) -> tuple[str, dict[str, str], list[str]]:
    """The language of a fence and the words after it; words that nobody knows are handed back too."""
    language, *rest = re.split(r",(?![^(]*\))", info)
    words, unknown = {}, []
    for word in (w.strip() for w in rest):
        if match := WORD.fullmatch(word):
            a, reason, b, value, c = match.groups()
            words[a or b or c] = reason or value or ""
        else:
            unknown.append(word)
    return language.strip(), words, unknown


def read_page(name: str, text: str) -> Page:
    """Takes a page apart."""
    blocks, prose, block, closing = [], [], None, ""
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if block is not None:
            if fence and fence[2].startswith(closing) and not fence[3]:
                block = None
            else:
                block.lines.append(line.removeprefix(indent))
        elif fence:
            indent, closing = fence[1], fence[2]
            block = Block(number, *read_info(fence[3]))
            blocks.append(block)
        else:
            prose.append(line)
            continue
        prose.append("")
    return Page(name, blocks, prose)


def pages_of(root: Path) -> list[str]:
    """Names of all pages, from the root."""
    patterns = ["README.md", "ARCHITECTURE.md", "CHANGELOG.md", "proof/README.md", "benches/**/README.md", "docs/**/*.md"]
    return [p.relative_to(root).as_posix() for pattern in patterns for p in sorted(root.glob(pattern))]
