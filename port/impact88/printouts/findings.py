"""Findings on a printout, and the verdict that follows from them by one table."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from types import MappingProxyType
from typing import NamedTuple

from .page import PrintedChar


class Verdict(Enum):
    """The verdicts, the gravest first."""

    DIFFERS = "differs"
    INCOMPLETE = "incomplete"
    AS_READ = "identical as far as read"
    IDENTICAL = "identical"


class Kind(Enum):
    """Kinds of findings, the gravest first."""

    NUMBER = "another number"
    EITHER = "one of several numbers, each of which alone explains the page"
    LABEL = "another word in a label's place"
    OPEN = "another number, on a page or for inputs read with doubt"
    UNREAD = "number not read"
    DOUBT = "number read with doubt"
    MISREAD = "word or mark read otherwise"
    LOST = "word or mark not read"
    FOREIGN = "text that the program does not print"
    ROW_LOST = "row not read"
    ROW_TWICE = "row printed twice"
    DISORDER = "row out of order"


VERDICTS = MappingProxyType(
    {
        Kind.NUMBER: Verdict.DIFFERS,
        Kind.EITHER: Verdict.DIFFERS,
        Kind.LABEL: Verdict.DIFFERS,
        Kind.OPEN: Verdict.INCOMPLETE,
        Kind.UNREAD: Verdict.INCOMPLETE,
        Kind.DOUBT: Verdict.AS_READ,
        Kind.MISREAD: Verdict.AS_READ,
        Kind.LOST: Verdict.AS_READ,
        Kind.FOREIGN: Verdict.AS_READ,
        Kind.ROW_LOST: Verdict.AS_READ,
        Kind.ROW_TWICE: Verdict.AS_READ,
        Kind.DISORDER: Verdict.AS_READ,
    }
)
"""The verdict of each kind of finding. A page has the gravest one, IDENTICAL without findings."""


class Finding(NamedTuple):
    """Something that was not read as the program prints it.

    Parameters
    ----------
    kind : Kind
        What it is.
    name : str
        The number, or the row's labels, "" for other text.
    start, stop : int
        Its place in the text; of something lost, the place where it would be.
    read : str
        What the text has there.
    printed : str
        What the program prints.
    """

    kind: Kind
    name: str
    start: int
    stop: int
    read: str
    printed: str


class Number(NamedTuple):
    """A number of the page: as the program prints it, as read ("" if lost), and its place."""

    printed: str
    read: str
    start: int
    stop: int


@dataclass(frozen=True)
class Verification:
    """A printout with its verdict.

    Parameters
    ----------
    verdict : Verdict
        What its findings give by `VERDICTS`.
    scene : mapping of str to str
        The scene as typed; empty if it was not recovered.
    numbers : mapping of str to Number
        Each number as printed and as read.
    findings : tuple of Finding
        All that was not read as the program prints it.
    unseen : mapping of str to int
        Digits of inputs that no other number of the page confirms, by input.
    explanation : str
        What explains a page that differs, "" if nothing of the list does.
    page : tuple of PrintedChar
        The page that the program prints for the scene, each character with its place.
    text : str
        The whole text, to which places refer.
    span : tuple of int
        First offset of the printout in it, and the end.

    Examples
    --------
    >>> (result,) = impact88.verify(impact88.run(impact88.sample(1)).page)
    >>> result.verdict.name, result.numbers["LOSS"].read
    ('IDENTICAL', '57.47')
    """

    verdict: Verdict
    scene: Mapping[str, str] = field(default_factory=dict)
    numbers: Mapping[str, Number] = field(default_factory=dict)
    findings: tuple[Finding, ...] = ()
    unseen: Mapping[str, int] = field(default_factory=dict)
    explanation: str = ""
    page: tuple[PrintedChar, ...] = ()
    text: str = field(default="", repr=False)
    span: tuple[int, int] = (0, 0)

    def __repr__(self) -> str:
        return (
            f"<Verification: {self.verdict.value}, {len(self.numbers)} numbers, "
            f"{len(self.findings)} findings>"
        )

    def line_of(self, offset: int) -> int:
        """Return the number of the line of an offset, from 1."""
        return len(re.findall("\r\n?|\n", self.text[:offset])) + 1


def verdict_of(findings: Sequence[Finding]) -> Verdict:
    """Return the gravest verdict of some findings."""
    verdicts = {VERDICTS[finding.kind] for finding in findings}
    return next((verdict for verdict in Verdict if verdict in verdicts), Verdict.IDENTICAL)
