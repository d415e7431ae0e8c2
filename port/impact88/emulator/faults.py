"""Errors as the ROM finds them: with the 6502's stack pointer, which ONERR leaves where it is."""

from collections.abc import Callable
from typing import Any, TypeVar

from ..applesoft.errorcodes import ApplesoftError

T = TypeVar("T")


class Fault(ApplesoftError):
    """An error of a program. ``stack``: the stack pointer where the ROM jumps to ERROR; ``code``:
    where it is not the kind's."""

    def __init__(self, kind: str, stack: int, code: int = 0) -> None:
        super().__init__(kind)
        self.stack = stack
        self.code = code or self.code


def fault_if(wrong: object, kind: str, stack: int, code: int = 0) -> None:
    """Raises the `Fault` if something is wrong."""
    if wrong:
        raise Fault(kind, stack, code)


def placed(error: ApplesoftError, stack: int) -> Fault:
    """The error with a stack pointer, unless it has one already."""
    return error if isinstance(error, Fault) else Fault(error.kind, stack)


def located(stack: int, does: Callable[..., T], *arguments: Any) -> T:
    """What a routine returns; its errors are `placed`."""
    try:
        return does(*arguments)
    except ApplesoftError as error:
        raise placed(error, stack) from None


class TooManyStatements(Exception):
    """The program has done as many statements as it was allowed."""


class Restart(Exception):
    """RESTART: the machine goes back to the prompt."""
