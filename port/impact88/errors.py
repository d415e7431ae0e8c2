"""The error shown to users, notes on standard error, and the display of untrusted text in both."""

import sys
from contextlib import suppress
from importlib import import_module
from types import ModuleType

# lengths in characters
LONGEST_MESSAGE = 500  # six lines of a terminal
LONGEST_PLACE = 200  # a path and a line number
LONGEST_QUOTE = 60  # a cell, or a number with its unit


def one_line(text: str, longest: int = LONGEST_MESSAGE) -> str:
    """Return ``text`` on one line of at most ``longest`` characters, safe for a terminal.

    Characters that do not print (controls, terminal escapes, line ends, marks of writing direction,
    lone surrogates) are written as in a Python literal; the middle of a longer text is left out."""
    if len(text) > longest:
        text = f"{text[: longest // 2]} ... {text[-(longest // 3) :]}"
    text = printable(text)
    # escapes are longer than the characters they replace
    return text if len(text) <= longest else one_line(text, longest)


def printable(text: str, kept: str = "") -> str:
    """Return ``text`` with escapes for characters that do not print, except those in ``kept``."""
    if text.isprintable():
        return text
    return "".join(
        c if c.isprintable() or c in kept else c.encode("unicode_escape").decode() for c in text
    )


def quoted(value: object) -> str:
    """Return a value for a message: shortened, and in quotes if it is text."""
    return one_line(repr(value), LONGEST_QUOTE)


class UserError(ValueError):
    """Input that cannot be used: one line on what is wrong, where, and what is expected.

    The command line prints the message on stderr and exits with status 2, without a traceback.

    Parameters
    ----------
    message : str
        The problem, and what is expected.
    where : str, optional
        The place (file, row, field), which begins the message.

    Examples
    --------
    >>> try:
    ...     impact88.sample(1).replaced({"MU": "much"})
    ... except impact88.UserError as error:
    ...     print(str(error)[:21])
    sample 1: MU = 'much'
    """

    def __init__(self, message: str, where: str | None = None) -> None:
        message = one_line(message)
        super().__init__(f"{one_line(where, LONGEST_PLACE)}: {message}" if where else message)
        self.where = where


def note(command: str | None, text: str) -> None:
    """Write the line "impact88 COMMAND: text" to stderr, if that accepts it."""
    name = f"impact88 {command}" if command else "impact88"
    with suppress(OSError, ValueError):  # closed, or full
        print(f"{name}: {one_line(text)}", file=sys.stderr, flush=True)


def library(name: str, extra: str, what: str) -> ModuleType:
    """Import and return an optional module that ``what`` needs. Raises UserError, naming the extra
    that installs it, if it is missing."""
    try:
        return import_module(name)
    except ImportError:
        raise UserError(
            f"{what} needs the extra {extra}: pip install '.[{extra}]' in the checkout"
        ) from None
