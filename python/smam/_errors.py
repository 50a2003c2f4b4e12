"""What goes wrong."""

from __future__ import annotations


class SmamError(Exception):
    """What the program said when it stopped: place, cause and remedy.

    ``exit_code`` is 2 for wrong usage or input, 1 for what failed on the way (a run that diverged, a file that cannot
    be written), 127 when the program itself was not found.
    """

    def __init__(self, message: str, exit_code: int) -> None:
        super().__init__(message)
        self.message = message
        self.exit_code = exit_code

    @property
    def remedy(self) -> str | None:
        """What to do about it, if the program knows."""
        _, found, remedy = self.message.partition("remedy: ")
        return remedy.strip() if found else None

    def __reduce__(self) -> tuple[type[SmamError], tuple[str, int]]:
        return type(self), (self.message, self.exit_code)


SmamError.__module__ = "smam"  # the name that users know, in tracebacks too
