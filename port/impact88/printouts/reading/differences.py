"""Differences between a text and the program's page, whatever they belong to.

A number, a word or a mark of the page is read as some glyphs; an edit path (`editpath`) from these
to what the program prints there is a list of differences. Text that belongs to nothing is one, too.
"""

from collections.abc import Iterator, Sequence
from enum import StrEnum
from typing import NamedTuple

from ..fields import FIELDS
from .editpath import Step
from .glyphs import Page, Region, letters


class Kind(StrEnum):
    """Kinds of differences between what is read and what the program prints there."""

    LOOK_ALIKE = "look-alike"
    ILLEGIBLE = "illegible"
    BLANK = "blank inside"
    OTHER_FORM = "never printed so"
    CUT = "cut off"
    MISSING = "missing"
    MOVED = "moved"
    LEFT_OVER = "left over"
    FOREIGN_LINE = "line of another text"
    PICTURE = "picture"
    CONTRADICTS = "contradicts"


class Difference(NamedTuple):
    """One place where the paper is not read as the program prints it.

    Parameters
    ----------
    kind : Kind
        Kind of the difference.
    name : str
        The field whose number, label or mark it is, or that it stands beside; a prompt's reply, or
        empty.
    read, printed : str
        What was read and what the program prints; either may be empty.
    line, column, start, stop : int
        Its place in the text: line and column from 1, and offsets; where nothing was read, the
        place where it would stand.
    bears : bool
        False if it leaves the page all that the program prints: a letter that the page's reader
        misread, or text around the page.
    """

    kind: Kind
    name: str
    read: str
    printed: str
    line: int
    column: int
    start: int
    stop: int
    bears: bool = True

    @property
    def is_mark(self) -> bool:
        """True for a mark beside a label, and for a word of a prompt (`labels`)."""
        return not self.printed.isalpha() or self.name not in FIELDS

    @property
    def question(self) -> str:
        """Say what to look for on the paper, and where."""
        printed = f"{'an' if self.printed[:1] == '8' else 'a'} {self.printed}"
        question = f"is {printed} missing here"
        if self.read:
            part = printed if self.printed else "part of the number"
            question = f"is this {self.read} {part}"
        return f"line {self.line}, column {self.column}: {question}?"


def difference_at(
    page: Page, kind: Kind, name: str, printed: str, span: tuple[int, int], read: str | None = None
) -> Difference:
    """Return a difference at a span of a text, of which by default all was read."""
    shown = " ".join(page.text[slice(*span)].split()) if read is None else read
    return Difference(kind, name, shown, printed, *page.place(span[0]), *span)


def differences_along(
    page: Page, name: str, region: Region, printed: str, path: Sequence[Step]
) -> Iterator[Difference]:
    """Yield the differences along an edit path from a token's glyphs to its printed text; glyphs
    behind its end are left over."""
    starts = [*(glyph.offset for glyph in region), region[-1].offset + 1]
    i = j = 0
    for di, dj, kind in [*path, (len(region), 0, Kind.LEFT_OVER)]:
        if kind is not None and (di == 0 or i < len(region)):
            read = letters(region[i : i + di])
            span = starts[i], starts[min(i + di, len(region)) - 1] + 1 if di else starts[i]
            # glyphs are capitals; the page may have a small letter here
            typed = page.text[span[0] : span[0] + len(read)]
            read = typed if typed.upper() == read else read
            yield difference_at(page, kind, name, printed[j : j + dj], span, read)
        i, j = i + di, j + dj
