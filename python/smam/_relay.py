"""Passing on what the program says while it works, all but its error, which becomes an exception."""

from __future__ import annotations

import codecs
import os
import re
import sys

_ESCAPES = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
_LEADING_ESCAPES = re.compile(rf"^({_ESCAPES.pattern})+")
_UNFINISHED_ESCAPE = re.compile(r"\x1b(\[[0-9;?]*)?$")
_ERROR = "error: "


class Relay:
    """Takes standard error piece by piece. Whole lines that name ``private``, a folder soon gone, are not passed on."""

    def __init__(self, private: str | None = None) -> None:
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")
        self._private = private
        self._line = ""  # what the present line holds so far
        self._shown = 0  # how much of it was passed on
        self._kept: list[str] = []  # the error and all after it
        self._said: list[str] = []

    def read(self, source: int) -> None:
        """Until the other side is closed."""
        try:
            while data := os.read(source, 65536):
                self.take(self._decoder.decode(data))
        except OSError:
            pass  # how a terminal says that the other side was closed
        self.take(self._decoder.decode(b"", final=True))
        if not self._kept:
            self._pass_on()

    def take(self, text: str) -> None:
        for piece in re.split(r"(?<=[\r\n])", text):
            if self._kept:
                self._kept.append(piece)
                continue
            self._line += piece
            plain = _ESCAPES.sub("", self._line)
            ended = piece.endswith(("\r", "\n"))
            if plain.startswith(_ERROR):
                # What stands before it clears a progress bar.
                begins = len(self._line) - len(_LEADING_ESCAPES.sub("", self._line))
                self._pass_on(begins)
                self._kept.append(self._line[begins:])
            elif ended and self._private and self._private in plain:
                self._line, self._shown = "", 0
            elif ended or self._is_drawing(plain):
                self._pass_on()
                if ended:
                    self._line, self._shown = "", 0

    def _is_drawing(self, plain: str) -> bool:
        """Progress bars are drawn without an end of line; a line of words is passed on when it is whole."""
        return "\x1b" in self._line and not _ERROR.startswith(_UNFINISHED_ESCAPE.sub("", plain))

    def _pass_on(self, to: int | None = None) -> None:
        text = self._line[self._shown : to]
        self._shown = len(self._line) if to is None else to
        self._said.append(text)
        if text and sys.stderr is not None:
            sys.stderr.write(text)
            sys.stderr.flush()

    def error(self) -> str:
        """The error without the word; empty if there is none."""
        return _ESCAPES.sub("", "".join(self._kept)).strip().removeprefix(_ERROR)

    def last_words(self) -> str:
        """The last lines passed on."""
        said = re.split(r"[\r\n]+", _ESCAPES.sub("", "".join(self._said)).strip())
        return "\n".join(said[-5:])

    @property
    def has_error(self) -> bool:
        return bool(self._kept)
