"""Typed text outside the program's page that gives one of the page's numbers another value."""

import re
from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from typing import NamedTuple

from ...collision.fields import ANGLES, FIELDS, label
from ..reading.alignment import LINES

_FAR = 18
"""Characters of words between a label of three letters or more and its number; shorter labels are
also words, and need their equals sign."""
_LONG = 3
_NUMBER = re.compile(r"(?<![A-Z0-9.?-])-?(?:\d+\.?\d*|\.\d+)(?:E-?\d+)?(?![A-Z0-9.?])")


class Claim(NamedTuple):
    """A number that typed text gives: its label, what is typed, and what the page prints there."""

    label: str
    typed: str
    printed: str


def _of_labels() -> dict[str, list[str]]:
    """Return the fields that each label stands before."""
    names: dict[str, list[str]] = {}
    for name in FIELDS:
        if name not in ANGLES:
            names.setdefault(label(name).rstrip("="), []).append(name)
    return names


_NAMES = _of_labels()
_LABEL = re.compile(
    "(?<![A-Z0-9?])("
    + "|".join(re.escape(text) for text in sorted(_NAMES, key=len, reverse=True))
    + ")(?![A-Z0-9?])"
)
_PROGRAM = [
    re.compile(r"\s*".join(map(re.escape, re.sub(r"\{\w+\}", "#", line).replace(" ", ""))))
    for line in LINES
    if "={" in line.replace(" ", "")
]
"""The lines in which the program prints numbers with labels, each number a ``#``."""


def claims(
    text: str, printed: Sequence[Mapping[str, str | None]], sure: str = ""
) -> Iterator[Claim]:
    """Yield the numbers of a typed text that are none of those the page has under their labels.

    Parameters
    ----------
    text : str
        What is typed, ``?`` for a character that was not read.
    printed : sequence of mapping of str to str or None
        Of each printout on the page its numbers by field, None of one that was not read with
        certainty: text under its label may be right.
    sure : str, optional
        The same text with ``?`` for each character that another is nearly as like. Numbers are
        taken from it; a label is a word, and an O like a 0 leaves it what it is.
    """
    before = 0
    for number in _NUMBER.finditer(sure or text):
        left, before = text[before : number.start()], number.end()
        labels = [*_LABEL.finditer(left)]
        if not labels:
            continue
        name, rest = labels[-1][1], left[labels[-1].end() :]
        told = len(name) >= _LONG and "=" not in rest and len(rest) <= _FAR
        if not told and rest.strip() != "=":
            continue
        fields = _NAMES[name]
        shown = [numbers[field] for numbers in printed for field in fields if field in numbers]
        certain = [each for each in shown if each is not None]
        if len(certain) < len(shown) or not shown:
            continue
        if Decimal(number[0]) not in map(Decimal, certain):
            yield Claim(name, number[0], " or ".join(dict.fromkeys(certain)))


def is_of_a_printout(text: str) -> bool:
    """Whether a typed text is a whole line as the program prints it: of another printout, of which
    the sheet shows no more."""
    line = re.sub(r"(?<=[=\s])-?[0-9.?]+(?:E-?[0-9?]+)?", "#", text)
    return any(form.search(line) for form in _PROGRAM)
