"""A case: the entries of one collision, as immutable amounts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from .amounts import Amount


class View(NamedTuple):
    """How a file shows its numbers.

    Parameters
    ----------
    units : {"", "us", "chapter", "metric", "si"}, default ""
        System of units; "" for consistent units without names.
    axes : {"", "listing", "sae"}, default ""
        Axes; "" is the listing's.
    headings : {"", "listing", "compass"}, default ""
        Headings; "" is the listing's.
    """

    units: str = ""
    axes: str = ""
    headings: str = ""


@dataclass(frozen=True)
class Case:
    """One collision.

    Parameters
    ----------
    entries : mapping of str to Amount
        Amounts by name, in base units along the listing's axes.
    view : View
        Units, axes and headings in which the case is written and its results are shown.
    texts : mapping of str to str
        The digits typed into the 1988 program.
    remarks : tuple of str
        Assumptions, and values that are implausible.
    title, case, examiner, date : str
        Headings of a report.
    """

    entries: Mapping[str, Amount]
    view: View
    texts: Mapping[str, str] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    title: str = ""
    case: str = ""
    examiner: str = ""
    date: str = ""
