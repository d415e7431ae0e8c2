"""Errors as the ROM finds them: with the 6502's stack pointer, which ONERR leaves where it is."""

from ..applesoft.errorcodes import ApplesoftError


class Fault(ApplesoftError):
    """An error of a program. ``stack``: the stack pointer where the ROM jumps to ERROR; ``code``:
    what ``PEEK (222)`` shows, the kind's unless given."""

    def __init__(self, kind: str, stack: int, code: int | None = None) -> None:
        super().__init__(kind)
        self.stack = stack
        self._code = code

    @property
    def code(self) -> int:
        """What ``PEEK (222)`` shows after ONERR."""
        return super().code if self._code is None else self._code


def placed(error: ApplesoftError, stack: int) -> Fault:
    """The error with a stack pointer, unless it has one already."""
    return error if isinstance(error, Fault) else Fault(error.kind, stack)


class TooManyStatements(Exception):
    """The program has done as many statements as it was allowed."""


class Restart(Exception):
    """RESTART: the machine goes back to the prompt."""
