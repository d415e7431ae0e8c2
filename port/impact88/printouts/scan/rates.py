"""Verdicts on pages with known truth: the counts, and the sentences that a report says of them.

Every page that was offered counts, whatever became of it. `tests/support/scanrates.py` counts them.
"""

from collections.abc import Iterator
from typing import NamedTuple


class Count(NamedTuple):
    """Number of pages of one kind by verdict.

    The worst of several printouts on a page counts; a page that was refused was left open.

    Attributes
    ----------
    alteration : str
        ``"none"``, ``"replaced"``, ``"added"``, ``"erased"`` or ``"moved"``.
    quality : str
        Kind and quality of the picture.
    identical, as_read, open, differs : int
        Number of pages with each verdict.
    """

    alteration: str
    quality: str
    identical: int
    as_read: int
    open: int
    differs: int

    @property
    def pages(self) -> int:
        """Number of pages that were offered."""
        return self.identical + self.as_read + self.open + self.differs


NONE = "none"
COUNTS: tuple[Count, ...] = (
    Count("none", "not graded", 34, 6, 22, 0),
    Count("none", "photograph, good", 8, 0, 0, 0),
    Count("none", "photograph, medium", 6, 2, 0, 0),
    Count("none", "scan, bad", 5, 0, 6, 0),
    Count("none", "scan, good", 50, 11, 2, 0),
    Count("none", "scan, medium", 22, 16, 2, 0),
    Count("replaced", "not graded", 0, 0, 6, 9),
    Count("replaced", "photograph, good", 0, 0, 0, 5),
    Count("replaced", "photograph, medium", 0, 0, 1, 3),
    Count("replaced", "scan, good", 0, 0, 0, 23),
    Count("replaced", "scan, medium", 0, 0, 0, 25),
    Count("added", "not graded", 0, 3, 8, 8),
    Count("erased", "not graded", 0, 0, 6, 0),
    Count("erased", "scan, good", 0, 0, 0, 2),
    Count("erased", "scan, medium", 0, 0, 0, 2),
    Count("moved", "not graded", 0, 0, 8, 4),
    Count("moved", "scan, good", 0, 0, 1, 6),
    Count("moved", "scan, medium", 0, 0, 0, 2),
)
"""Pages of two sets, 280 and 120, in an order shuffled beforehand; the run was cut short by the
clock, whatever had come out, so that these are a sample of the first set, and most of the second.
Most were counted before typed lines were read and strips of holes left out; of 97 that were counted
again afterwards three are told better and none otherwise."""
HEADINGS = (
    "alteration",
    "quality",
    "offered",
    "IDENTICAL",
    "AS FAR AS READ",
    "left open",
    "DIFFERS",
)
_BOUND_95 = 3
"""0 events in N cases bound the rate at this over N (95 % confidence; the "rule of three")."""


def table(counts: tuple[Count, ...] = COUNTS) -> Iterator[tuple[str | int, ...]]:
    """Yield the rows under `HEADINGS`, by alteration and quality."""
    for count in counts:
        yield (
            count.alteration,
            count.quality,
            count.pages,
            count.identical,
            count.as_read,
            count.open,
            count.differs,
        )


def sentences(counts: tuple[Count, ...] = COUNTS) -> str:
    """Return the two sentences of a report on these rates."""
    genuine = _sum(count for count in counts if count.alteration == NONE)
    altered = _sum(count for count in counts if count.alteration != NONE)
    return (
        f"Of {genuine.pages} genuine pages offered to this program, {genuine.identical} were found "
        f"IDENTICAL, {genuine.as_read} IDENTICAL AS FAR AS READ, {genuine.open} were left open and "
        f"{genuine.differs} were wrongly said to differ; of {altered.pages} altered pages, "
        f"{altered.differs} were found to differ, {altered.open} were left open, {altered.as_read} "
        f"passed AS FAR AS READ and {altered.identical} passed as IDENTICAL. "
        "All these pages, and the alterations, were drawn by a computer, and limits of this "
        "program were chosen on some of them: the figures are no probability that the page at hand "
        "is genuine or altered. "
        f"{_bound(genuine.differs, 'wrongly said to differ', genuine.pages, 'genuine')}; "
        f"{_bound(altered.identical, 'passed as IDENTICAL', altered.pages, 'altered')}."
    )


def _bound(failures: int, kind: str, pages: int, pages_kind: str) -> str:
    """Return a rate of failures in words, with the bound that none in so many pages gives it."""
    text = f"{failures} failures ({kind}) in {pages} {pages_kind} pages"
    if failures:
        return text
    return f"{text} bound the failure rate at 1 in {pages // _BOUND_95} (95 % confidence)"


def _sum(counts: Iterator[Count]) -> Count:
    """Return the total of some counts."""
    identical = as_read = open_ = differs = 0
    for count in counts:
        identical += count.identical
        as_read += count.as_read
        open_ += count.open
        differs += count.differs
    return Count("", "", identical, as_read, open_, differs)
