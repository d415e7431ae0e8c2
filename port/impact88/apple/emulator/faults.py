"""Errors with the 6502's stack pointer at which the ROM detects them, where ONERR leaves it.

``sp - n`` in the statements: the ROM has n more bytes on the stack there than before the statement,
2 for the return to NEWSTT and 2 for each JSR, and what it pushed; PEEK (223) shows it."""

from collections.abc import Callable
from typing import Any, TypeVar

from ..applesoft.errorcodes import ApplesoftError

T = TypeVar("T")


class Fault(ApplesoftError):
    """An error of a program. ``stack``: the stack pointer at the ROM's jump to ERROR; ``code``: for
    ONERR, by default that of the kind."""

    def __init__(self, kind: str, stack: int, code: int = 0) -> None:
        super().__init__(kind)
        self.stack = stack
        self.code = code or self.code


def fault_if(wrong: object, kind: str, stack: int, code: int = 0) -> None:
    """Raise a `Fault` if ``wrong``."""
    if wrong:
        raise Fault(kind, stack, code)


def with_stack(error: ApplesoftError, stack: int) -> Fault:
    """Return the error with a stack pointer; a `Fault` keeps its own."""
    return error if isinstance(error, Fault) else Fault(error.kind, stack)


def call_at(stack: int, does: Callable[..., T], *arguments: Any) -> T:
    """Call a routine and return its result; errors get the stack pointer ``stack``."""
    try:
        return does(*arguments)
    except ApplesoftError as error:
        raise with_stack(error, stack) from None


class TooManyStatements(Exception):
    """The program reached its limit of statements."""


class Restart(Exception):
    """RESTART: the machine goes back to the prompt."""
