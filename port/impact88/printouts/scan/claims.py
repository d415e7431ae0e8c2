"""Claims: typed text outside the program's page that gives one of its numbers another value."""

import re
from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from typing import NamedTuple

from ..fields import ANGLES, FIELDS, label
from ..reading.alignment import LINES

_MAX_WORDS = 18  # characters between a label and its number, where no equals sign stands
_MIN_LABEL = 3  # letters of a label that needs no equals sign; shorter labels are also words
_NUMBER = re.compile(r"(?<![A-Z0-9.?-])-?(?:\d+\.?\d*|\.\d+)(?:E-?\d+)?(?![A-Z0-9.?])")


class Claim(NamedTuple):
    """A number that typed text gives: its label, what is typed, and what the page prints there."""

    label: str
    typed: str
    printed: str


def _fields_by_label() -> dict[str, list[str]]:
    """Return the fields that each label stands before."""
    names: dict[str, list[str]] = {}
    for name in FIELDS:
        if name not in ANGLES:
            names.setdefault(label(name).rstrip("="), []).append(name)
    return names


_NAMES = _fields_by_label()
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
"""Patterns of the lines in which the program prints numbers with labels, each number a ``#``."""


def claims(
    text: str, printed: Sequence[Mapping[str, str | None]], sure: str = ""
) -> Iterator[Claim]:
    """Yield the numbers of a typed text that differ from those the page has under their labels.

    Parameters
    ----------
    text : str
        The typed text, with ``?`` for a character that was not read.
    printed : sequence of mapping of str to str or None
        For each printout on the page its numbers by field, None for one that was not read with
        certainty: text with its label may be right.
    sure : str, optional
        The text with ``?`` for each character that may well be another. Numbers are taken from it;
        labels are not, since a word stays what it is if its O is like a 0.
    """
    end = 0
    for number in _NUMBER.finditer(sure or text):
        words, end = text[end : number.start()], number.end()
        labels = [*_LABEL.finditer(words)]
        if not labels:
            continue
        name, between = labels[-1][1], words[labels[-1].end() :]
        is_labelled = len(name) >= _MIN_LABEL and "=" not in between and len(between) <= _MAX_WORDS
        if not is_labelled and between.strip() != "=":
            continue
        fields = _NAMES[name]
        values = [numbers[field] for numbers in printed for field in fields if field in numbers]
        certain = [value for value in values if value is not None]
        if len(certain) < len(values) or not values:
            continue
        if Decimal(number[0]) not in map(Decimal, certain):
            yield Claim(name, number[0], " or ".join(dict.fromkeys(certain)))


def is_of_a_printout(text: str) -> bool:
    """Return True for a whole line as the program prints it.

    It belongs to another printout, of which the sheet shows no more.
    """
    line = re.sub(r"(?<=[=\s])-?[0-9.?]+(?:E-?[0-9?]+)?", "#", text)
    return any(form.search(line) for form in _PROGRAM)
