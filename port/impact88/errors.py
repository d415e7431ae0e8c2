"""The one error a user of this package is shown, what is said on standard error beside the result,
and how foreign text stands in either."""

import sys
from contextlib import suppress
from importlib import import_module
from types import ModuleType

LONGEST_MESSAGE, LONGEST_PLACE, LONGEST_QUOTE = 500, 200, 60
"""Characters: six lines of a terminal; a path and a line of it; a cell, or a number with its unit.
"""
BEYOND_DOUBLES = "the values known lead beyond the range of doubles"


def shown(text: str, longest: int = LONGEST_MESSAGE) -> str:
    """``text`` on one line of at most ``longest`` characters, fit for a terminal. Whatever does not
    print (control characters, terminal escapes, line ends, marks that turn the writing direction,
    lone surrogates) is shown as Python would write it in a literal; of a longer text the middle is
    left out."""
    if len(text) > longest:
        kept = longest - 5
        text = f"{text[: kept - kept // 3]} ... {text[-(kept // 3) :]}"
    text = printable(text)
    # escapes are longer than what they show
    return text if len(text) <= longest else shown(text, longest)


def printable(text: str, kept: str = "") -> str:
    """``text`` with escapes for the characters that do not print, but for those ``kept``."""
    if text.isprintable():
        return text
    return "".join(
        c if c.isprintable() or c in kept else c.encode("unicode_escape").decode() for c in text
    )


def quoted(value: object) -> str:
    """A value as it was given, in quotes if it is text, short enough to stand in a message."""
    if isinstance(value, str):
        value = value[: 2 * LONGEST_QUOTE]
    return shown(repr(value), LONGEST_QUOTE)


class UserError(ValueError):
    """Input that cannot be used: one line saying what is wrong, where, and what is expected.

    The command line prints the message on stderr and ends with status 2, without a traceback.

    Parameters
    ----------
    message : str
        What is wrong, and what is expected.
    where : str, optional
        The place (file, row, field), put in front.

    Examples
    --------
    >>> try:
    ...     impact88.sample(1).replaced({"MU": "much"})
    ... except impact88.UserError as error:
    ...     print(str(error)[:21])
    sample 1: MU = 'much'
    """

    def __init__(self, message: str, where: str | None = None) -> None:
        message = shown(message)
        super().__init__(f"{shown(where, LONGEST_PLACE)}: {message}" if where else message)
        self.where = where


class PlausibilityWarning(UserWarning):
    """Values of a frame that are hardly meant: a mass, speed, arm or inertia that no vehicle has,
    velocities and headings in two conventions, EM = 0.

    Notes
    -----
    Nothing is refused. ``warnings.filterwarnings("ignore", category=impact88.PlausibilityWarning)``
    silences it.

    Examples
    --------
    >>> import warnings
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     frame = {"MA": [3091.0, 3.091]}
    ...     scene = impact88.sample(1).numbers()
    ...     results = impact88.solve_frame(frame, "LOSS", scene=scene, units="us")
    >>> print(str(caught[0].message)[:32])
    1 row, at position 1: MA = 3.091
    """


def note(command: str | None, text: str) -> None:
    """A line on stderr, where there is one that takes it: "impact88 COMMAND: text"."""
    name = f"impact88 {command}" if command else "impact88"
    with suppress(OSError, ValueError):  # closed, or full
        print(f"{name}: {shown(text)}", file=sys.stderr, flush=True)


def library(name: str, extra: str, what: str) -> ModuleType:
    """The module of that name, which ``what`` needs. Raises UserError, naming the extra that
    installs it, where it is missing."""
    try:
        return import_module(name)
    except ImportError:
        package = name.partition(".")[0]
        raise UserError(f"{what} needs {package}; pip install 'impact88[{extra}]'") from None
