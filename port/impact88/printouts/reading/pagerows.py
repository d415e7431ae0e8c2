"""Rows of a page that are exchanged or printed twice, before characters within rows are read.

A line whose letters are those of one of the program's labelled rows is that row. Where the rows of
one page are the program's but for two in each other's place, or one elsewhere, they are read in the
program's order; a row that is printed a second time is none of the page's.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from ...collision.fields import ANGLES
from .alignment import ANGLE_ROW, HEADING, LINES, PROMPTS
from .glyphs import Page, letters

_MIN_ROWS = 6
"""Rows of a page from which one that is out of order was exchanged; fewer are a fragment, and what
follows may be another printout."""
_EXPONENT = re.compile("(?<=[0-9.])E(?=[-+][0-9])")


def _letters_of(text: str) -> str:
    return "".join(filter(str.isalpha, text.upper()))


_ROWS = {
    _letters_of(re.sub("{.*?}", "", line)): number
    for number, line in enumerate(LINES)
    if number >= PROMPTS and number != ANGLE_ROW and "*" not in line
}
"""The labelled rows by their letters."""


class _Row(NamedTuple):
    """One of the program's rows on a page: its number in `LINES`, its line of the page's, and the
    lines that belong to it (the row of angles to its heading)."""

    number: int
    line: int
    lines: range

    @property
    def name(self) -> str:
        """The first field of the row."""
        if self.number == HEADING:
            return ANGLES[0]
        return LINES[self.number].partition("{")[2].partition("}")[0]


class Rows(NamedTuple):
    """Rows of a page that are not where the program prints them.

    Attributes
    ----------
    order : list of int
        The page's lines in the program's order.
    doubled : set of int
        Glyphs of rows that are printed a second time.
    repeated, exchanged : list of (int, str)
        What is said of rows that are printed twice and of those out of order, with the offset in
        the text of one of their characters.
    """

    order: list[int]
    doubled: set[int]
    repeated: list[tuple[int, str]]
    exchanged: list[tuple[int, str]]


def find_rows(page: Page) -> Rows:
    """Return the rows of a page that are exchanged or printed twice."""
    doubled: set[int] = set()
    repeated: list[tuple[int, str]] = []
    exchanged: list[tuple[int, str]] = []

    def told(row: _Row) -> str:
        return f"line {page.place(start_of(row))[0]}, the row of {row.name},"

    def start_of(row: _Row) -> int:
        return page.glyphs[page.lines[row.line].start].offset

    rows = [*_labelled_rows(page)]
    groups: list[list[_Row]] = [[]]
    for row, following in pairwise([*rows, None]):
        assert row is not None
        earlier = next((one for one in groups[-1] if one.number == row.number), None)
        if earlier and _is_repeated(page, groups[-1], earlier, row, following):
            doubled |= {at for line in row.lines for at in page.lines[line]}
            place, _ = page.place(start_of(earlier))
            sentence = f"{told(row)} is printed a second time: line {place} has it already"
            repeated.append((start_of(row), sentence))
            continue
        if earlier:
            groups.append([])
        groups[-1].append(row)
    order = [*range(len(page.lines))]
    for group in groups:
        moved = _moved(group)
        if len(moved) == 2:
            first, second = moved
            sentence = f"{told(first)} and {told(second)} stand in each other's place"
            exchanged.append((start_of(first), sentence))
        elif moved:
            sentence = f"{told(moved[0])} stands elsewhere than the program prints it"
            exchanged.append((start_of(moved[0]), sentence))
        if moved:
            order = _reordered(order, group)
    return Rows(order, doubled, repeated, exchanged)


def _labelled_rows(page: Page) -> Iterator[_Row]:
    for number, line in enumerate(page.lines):
        text = letters(page.glyphs[line.start : line.stop])
        row = _ROWS.get(_letters_of(_EXPONENT.sub("", text)))
        if row is not None:
            stop = number + 1
            if row == HEADING and stop < len(page.lines):
                angles = letters(page.glyphs[page.lines[stop].start : page.lines[stop].stop])
                stop += not _letters_of(_EXPONENT.sub("", angles))
            yield _Row(row, number, range(number, stop))


def _is_repeated(
    page: Page, group: Sequence[_Row], earlier: _Row, row: _Row, following: _Row | None
) -> bool:
    """Return True for a row that is printed twice on one page, rather than first on another."""
    texts = [
        "".join(
            letters(page.glyphs[page.lines[at].start : page.lines[at].stop]) for at in one.lines
        )
        for one in (earlier, row)
    ]
    goes_on = following is None or following.number not in {one.number for one in group}
    return texts[0] == texts[1] and goes_on


def _moved(group: Sequence[_Row]) -> list[_Row]:
    """Return the two rows of a page that are in each other's place, or the one that is elsewhere;
    none for a page whose rows are in order, or in another altogether."""
    in_order = sorted(group)
    if len(group) < _MIN_ROWS or [*group] == in_order:
        return []
    numbers = [row.number for row in in_order]
    if numbers != [*filter(set(_ROWS.values()).__contains__, range(numbers[0], numbers[-1] + 1))]:
        return []
    apart = [at for at, row in enumerate(group) if row is not in_order[at]]
    if len(apart) == 2:
        return [group[at] for at in apart]
    for at, row in enumerate(group):
        rest = [*group[:at], *group[at + 1 :]]
        if rest == sorted(rest):
            return [row]
    return []


def _reordered(order: Sequence[int], group: Sequence[_Row]) -> list[int]:
    """Return the lines with those of a page's rows in the program's order."""
    by_line = {row.line: row for row in group}
    taken = {line for row in group for line in row.lines}
    sorted_rows = iter(sorted(group))
    lines: list[int] = []
    for line in order:
        if line in by_line:
            lines += next(sorted_rows).lines
        elif line not in taken:
            lines.append(line)
    return lines
