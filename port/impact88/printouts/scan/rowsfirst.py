"""Rows before characters: which line of print stands on each line of the grid.

The layout takes the program's order for granted. Here each line is named for itself, by its blanks
and by the letters of its labels; what `find_rows` says of such a page's text, as of any other, is
which rows stand in each other's place or are printed twice.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..reading.alignment import ANGLE_ROW, HEADING, LINES
from ..reading.glyphs import Page
from ..reading.pagerows import find_rows
from .grid import Grid
from .layout import Layout, LineFit, Place, Row, Sheet
from .scenes import Read
from .typeface import BLANK, Typeface, distances, read_numbers, sample_of, typeface_of

_WRONG_LETTER = 3.0  # log odds that a label's cell loses which is more like another letter
_MIN_SHARE = 0.7  # smallest gain of a line of print, relative to that of its ink if all were its


class Order(NamedTuple):
    """A grid with its lines in the program's order, and what is said of those that were not.

    Attributes
    ----------
    grid : Grid
        Rows that are printed a second time come last.
    repeated, exchanged : list of (int, str)
        Number of a line on the paper and a sentence, on rows printed twice and rows out of order.
    """

    grid: Grid
    repeated: list[tuple[int, str]]
    exchanged: list[tuple[int, str]]


def order_lines(grid: Grid, layout: Layout) -> Order | None:
    """Return the grid in the program's order, None where its rows are in that order."""
    as_laid_out = {
        row.start: LineFit(0.0, line, row)
        for sheet in layout.sheets
        for line, row in sheet.rows.items()
    }
    lines = _name_lines(grid, layout, as_laid_out)
    if _prints(lines) == _prints(as_laid_out):
        return None
    # once more by the letters of the rows' right names
    lines = _name_lines(grid, layout, lines)
    if not lines:
        return None
    page = Page(_text(grid, lines))
    rows = find_rows(page)
    if not (rows.exchanged or rows.repeated) or len(page.lines) != len(lines):
        return None
    doubled = {at for at, line in enumerate(page.lines) if line.start in rows.doubled}
    named = [[*_grid_lines(lines[start].row)] for start in sorted(lines)]
    taken = {line for group in named for line in group}
    firsts = {group[0] for group in named}
    in_order = iter(rows.order)
    order: list[int] = []
    last: list[int] = []
    for line in range(len(grid.pictures)):
        if line in firsts:
            at = next(in_order)
            (last if at in doubled else order).extend(named[at])
        elif line not in taken:
            order.append(line)
    return Order(
        grid.in_order([*order, *last]),
        [(page.place(offset)[0], sentence) for offset, sentence in rows.repeated],
        [(page.place(offset)[0], sentence) for offset, sentence in rows.exchanged],
    )


def _prints(lines: Mapping[int, LineFit]) -> dict[int, str]:
    """Return the line of print on each line of the grid."""
    return {start: LINES[fit.line] for start, fit in lines.items()}


def _grid_lines(row: Row) -> range:
    """Return the lines of the grid that a row takes."""
    return range(row.start, row.start + row.used)


def _label_cells(row: Row) -> tuple[list[str], list[Place]]:
    """Return the letters and signs of a row's labels, and their places."""
    cells = [
        (character, place)
        for name, text, places in row.pieces
        if not name and len(text) == len(places)
        for character, place in zip(text, places, strict=True)
        if character != BLANK
    ]
    return [character for character, _ in cells], [place for _, place in cells]


def _name_lines(grid: Grid, layout: Layout, lines: Mapping[int, LineFit]) -> dict[int, LineFit]:
    """Return the line of print that stands on each line of the grid, by its first line.

    It has the largest gain after `_WRONG_LETTER` for each letter that is more like another;
    ``lines``, named before, show the letters.
    """
    names: list[str] = []
    places: list[Place] = []
    for fit in lines.values():
        row_names, row_places = _label_cells(fit.row)
        names += row_names
        places += row_places
    if not names:
        return {}
    typeface = typeface_of(sample_of(grid, places), names)
    line_ink = [float(np.clip(row, 0, None).sum()) / 2 for row in grid.odds()]
    named: dict[int, LineFit] = {}
    taken: set[int] = set()
    for start in range(len(grid.pictures)):
        before = named.get(start - 1)
        fits = [
            fit
            for used in (1, 2)
            for fit in layout.candidates(start, used)
            # numbers without labels are the angles' if they stand below their heading
            if fit.line != ANGLE_ROW or (before and before.line == HEADING)
            if fit.gain > _MIN_SHARE * sum(line_ink[line] for line in _grid_lines(fit.row))
        ]
        if start not in taken and fits:
            # of one no letter need be read
            wrong = [len(fits) > 1 and _wrong_letters(grid, typeface, fit) for fit in fits]
            scores = [
                fit.gain - _WRONG_LETTER * count for fit, count in zip(fits, wrong, strict=True)
            ]
            named[start] = fits[int(np.argmax(scores))]
            taken.update(_grid_lines(named[start].row))
    return named


def _wrong_letters(grid: Grid, typeface: Typeface, fit: LineFit) -> int:
    """Return how many letters of a row's labels are more like another letter of the page."""
    names, places = _label_cells(fit.row)
    if not names:
        return 0
    to_means, _ = distances(sample_of(grid, places), typeface.means)
    nearest = [typeface.characters[at] for at in to_means.argmin(axis=1).tolist()]
    return sum(
        name in typeface.characters and name != other
        for name, other in zip(names, nearest, strict=True)
    )


def _text(grid: Grid, lines: Mapping[int, LineFit]) -> str:
    """Return the named lines as text, each on the line that it has on the paper."""
    sheets = [Sheet({fit.line: fit.row}) for fit in lines.values()]
    texts = [Read(*pair).page()[0] for pair in zip(sheets, read_numbers(grid, sheets), strict=True)]
    by_line = dict(zip(lines, texts, strict=True))
    # a blank at the end of each: lines of one length are not broken ones
    return " \n".join(by_line.get(line, "") for line in range(len(grid.pictures)))
