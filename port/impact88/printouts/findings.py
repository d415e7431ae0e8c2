"""Findings on a page and the verification of a printout: the types that readers of text and
pictures share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum


class FindingKind(Enum):
    """Kinds of findings; the verdict follows from the kinds that a page has."""

    CONTRADICTION = "contradiction"
    DOUBT = "doubt"
    MISSING_NUMBER = "missing number"
    MISSING_LABEL = "missing label"
    FOREIGN_TEXT = "foreign text"


class PageVerdict(Enum):
    """Verdicts on a printout."""

    IDENTICAL = "IDENTICAL"
    AS_FAR_AS_READ = "IDENTICAL AS FAR AS READ"
    INCOMPLETE = "INCOMPLETE"
    DIFFERS = "DIFFERS"


@dataclass(frozen=True, slots=True)
class Finding:
    """One finding on a page.

    Parameters
    ----------
    kind : FindingKind
        Its kind.
    name : str
        The quantity or row concerned.
    start, stop : int
        Its place in the text.
    read : str
        The text at that place.
    printed : str
        The text that the program prints there.
    """

    kind: FindingKind
    name: str
    start: int
    stop: int
    read: str
    printed: str


@dataclass(frozen=True)
class PageVerification:
    """The result of checking one printout.

    Parameters
    ----------
    verdict : PageVerdict
        IDENTICAL, AS_FAR_AS_READ, INCOMPLETE or DIFFERS.
    scene : mapping of str to str or None
        The inputs recovered, as typed; None if they are not beyond doubt.
    numbers : mapping of str to str
        Printed numbers that were read, by name.
    findings : tuple of Finding
        In the order of the text.
    unseen : tuple of str
        Errors that this page could not reveal.
    explanation : str
        The change that makes a differing page agree; "" if there is none.
    page : str
        The page that the program prints for the scene.
    """

    verdict: PageVerdict
    scene: Mapping[str, str] | None
    numbers: Mapping[str, str]
    findings: tuple[Finding, ...] = ()
    unseen: tuple[str, ...] = ()
    explanation: str = ""
    page: str = ""
