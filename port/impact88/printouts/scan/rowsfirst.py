"""Rows before characters: which line of print stands on each line of the grid, and in which
typeface.

The layout takes the program's order for granted. Here each line is named for itself, by its blanks
and by the letters of its labels; what `find_rows` says of such a page's text, as of any other, is
which rows stand in each other's place or are printed twice.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..reading.alignment import ANGLE_ROW, HEADING, LINES
from ..reading.glyphs import Page
from ..reading.pagerows import find_rows
from .grid import Grid
from .ink import Floats, Mask
from .layout import Layout, LineFit, Place, Row, Sheet
from .scenes import Read
from .typeface import (
    BLANK,
    NUMERIC,
    READABLE,
    Typeface,
    Vectors,
    distances,
    read_numbers,
    sample_of,
    typeface_of,
)

_WRONG_LETTER = 3.0  # log odds that a label's cell loses which is more like another letter
_MAX_WRONG = 0.5  # largest fraction of such letters in a line of print: a foot of the page has more
_MIN_SHARE = 0.7  # smallest gain of a line of print, relative to that of its ink if all were its

_SMOOTHING = 1.5
"""Standard deviation of the smoothing of glyphs before their differences are taken, pixels."""
_FOREIGN = 0.01
"""Smallest fraction of a row's ink that the page's glyphs leave unexplained in another typeface:
rows in the same one have up to 0.006 on pages whose other rows have hardly any."""
_FOREIGN_RATIO = 3.0
"""Smallest ratio of it to that of the row that is next: genuine pages have up to 2.8, those with a
row in another typeface mostly 6 to 1,000, and up to 2 if the two can hardly be told apart."""
_OWN_RATIO = 0.5
"""Largest ratio to it of what the row's own glyphs leave unexplained: a row that is only worn is
as unlike itself as it is unlike the others."""
_MAX_RISE = 1.5
"""Pixels by which such a row may be misplaced beyond the shifts of its cells: of one farther off,
these were chosen on other parts of the glyphs."""
_MIN_CELLS = 6  # cells of a row that are compared


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
    named = [[*lines[start].row.lines] for start in sorted(lines)]
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
        [(page.place(row.offset)[0], row.sentence) for row in rows.repeated],
        [(page.place(offset)[0], sentence) for offset, sentence in rows.exchanged],
    )


def _prints(lines: Mapping[int, LineFit]) -> dict[int, str]:
    """Return the line of print on each line of the grid."""
    return {start: LINES[fit.line] for start, fit in lines.items()}


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

    It has the largest gain after `_WRONG_LETTER` for each letter that is more like another, of
    which a foot of the page, as long as a line of print, has too many; ``lines``, named before,
    show the letters, and begin where no other is continued.
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
        scores: dict[float, LineFit] = {}
        widths = (1,) if start + 1 in lines else (1, 2)  # a row may be broken over two lines
        for fit in (fit for used in widths for fit in layout.candidates(start, used)):
            # numbers without labels are the angles' if they stand below their heading
            may_be_line = fit.line != ANGLE_ROW or (before and before.line == HEADING)
            least = _MIN_SHARE * sum(line_ink[line] for line in fit.row.lines)
            if start in taken or not may_be_line or fit.gain <= least:
                continue
            wrong, letters = _wrong_letters(grid, typeface, fit)
            if wrong <= _MAX_WRONG * letters:
                scores[fit.gain - _WRONG_LETTER * wrong] = fit
        if scores:
            named[start] = scores[max(scores)]
            taken.update(named[start].row.lines)
    return named


def _wrong_letters(grid: Grid, typeface: Typeface, fit: LineFit) -> tuple[int, int]:
    """Return how many letters of a row's labels are more like another letter of the page, and how
    many there are."""
    names, places = _label_cells(fit.row)
    if not names:
        return 0, 0
    to_means, _ = distances(sample_of(grid, places), typeface.means)
    nearest = [typeface.characters[at] for at in to_means.argmin(axis=1).tolist()]
    wrong = sum(
        name in typeface.characters and name != other
        for name, other in zip(names, nearest, strict=True)
    )
    return wrong, len(names)


def _text(grid: Grid, lines: Mapping[int, LineFit]) -> str:
    """Return the named lines as text, each on the line that it has on the paper."""
    sheets = [Sheet({fit.line: fit.row}) for fit in lines.values()]
    texts = [Read(*pair).page()[0] for pair in zip(sheets, read_numbers(grid, sheets), strict=True)]
    by_line = dict(zip(lines, texts, strict=True))
    # a blank at the end of each: lines of one length are not broken ones
    return " \n".join(by_line.get(line, "") for line in range(len(grid.pictures)))


class _RowCells(NamedTuple):
    """Inked cells of the rows of a grid's printouts.

    Attributes
    ----------
    glyphs : ndarray, shape (cells, height, width)
        The cells, smoothed, each shifted onto the mean of its character.
    names : ndarray, shape (cells,)
        Index of each cell's character; those of numbers are named as they were read.
    row : ndarray, shape (cells,)
        Index of each cell's row.
    may_be : ndarray of bool, shape (cells, characters)
        Characters with which each cell is compared.
    rises : list of float, one a row
        Pixels by which its ink stood higher than that of other rows, before it was moved.
    """

    glyphs: Vectors
    names: NDArray[np.intp]
    row: NDArray[np.intp]
    may_be: Mask
    rises: list[float]

    def residue(self, row: int, other_rows: Mask) -> float:
        """Return the median fraction of the ink of a row's cells that the mean glyphs of some other
        rows leave unexplained; 0 where few cells have such a glyph.

        A mean of n cells has 1/n of a cell's variance, which adds to it.
        """
        at, others = self.row == row, other_rows[self.row]
        members = self.names[others] == np.arange(self.may_be.shape[1])[:, None]
        is_compared = self.may_be[at] & members.any(axis=1)
        used = is_compared.any(axis=0)
        counts = members[used].sum(axis=1)
        is_compared = is_compared[:, used]
        if np.sum(is_compared.any(axis=1)) < _MIN_CELLS:
            return 0.0
        means = np.tensordot(members[used].astype(np.float32), self.glyphs[others], 1)
        fractions = _residues(self.glyphs[at], means) / (1 + 1 / counts)
        least = np.where(is_compared, fractions, np.inf).min(axis=1)
        return float(np.median(least[is_compared.any(axis=1)]))

    def unexplained_within(self, row: int) -> float:
        """Return the same by each other: of each cell by the mean of those in its row that have its
        character; infinite where none has another's."""
        glyphs, names = self.glyphs[self.row == row], self.names[self.row == row]
        fractions = []
        for cell, name in enumerate(names):
            is_like = (names == name) & (np.arange(len(names)) != cell)
            if is_like.any():
                mean = glyphs[is_like].mean(axis=0, keepdims=True)
                fractions.append(float(_residues(glyphs[[cell]], mean)[0, 0]))
        return float(np.median(fractions)) if fractions else np.inf


def _residues(glyphs: Vectors, means: Vectors) -> Floats:
    """Return the fractions of glyphs' energies that means leave unexplained, whatever the strength
    of the ink and wherever between the pixels a glyph stands: type differs in both from stroke to
    stroke.

    To first order these are a mean's multiples and its derivatives', which are projected out.
    """
    down, across = np.gradient(means, axis=(1, 2))
    tangents = np.stack([means, down, across], axis=-1).reshape(len(means), -1, 3)
    bases, _ = np.linalg.qr(tangents)
    vectors = glyphs.reshape(len(glyphs), -1)
    energies = np.maximum(np.einsum("np,np->n", vectors, vectors), 1e-6)
    explained = np.sum(np.tensordot(vectors, bases, axes=(1, 1)) ** 2, axis=2)
    fractions: Floats = np.maximum(1 - explained / energies[:, None], 0).astype(float)
    return fractions


def _row_cells(grid: Grid, rows: Sequence[tuple[Read, Row]]) -> _RowCells:
    """Return the inked cells of some rows."""
    characters: list[str] = []
    places: list[Place] = []
    sizes: list[tuple[int, int]] = []
    for read, row in rows:
        names, label_places = _label_cells(row)
        numbers = [
            (READABLE[k], place)
            for name, _, cells in row.pieces
            if name in read.costs
            for k, place in zip(read.costs[name].argmin(axis=1), cells, strict=True)
            if READABLE[k] != BLANK
        ]
        sizes.append((len(names), len(numbers)))
        characters += [*names, *(character for character, _ in numbers)]
        places += [*label_places, *(place for _, place in numbers)]
    typeface = typeface_of(sample_of(grid, places), characters)
    pictures = typeface.members.reshape(-1, *typeface.shape)
    glyphs = ndimage.gaussian_filter(pictures, (0, _SMOOTHING, _SMOOTHING))
    is_numeric = np.array([character in NUMERIC for character in typeface.characters])
    is_same = np.arange(len(is_numeric)) == typeface.names[:, None]
    of_number = np.repeat([False, True] * len(rows), np.ravel(sizes))
    row_of_cell = np.repeat(np.arange(len(rows)), np.sum(sizes, axis=1))
    rises = []
    for number in range(len(rows)):
        at = row_of_cell == number
        rises.append(_rise(glyphs, typeface.names, at))
        glyphs[at] = ndimage.shift(glyphs[at], (0, rises[-1], 0), order=1)
    may_be = np.where(of_number[:, None], is_numeric, is_same)
    return _RowCells(glyphs, typeface.names, row_of_cell, may_be, rises)


def _rise(glyphs: Vectors, names: NDArray[np.intp], at: Mask) -> float:
    """Return by how many pixels the ink of some cells stands higher than that of the same
    characters elsewhere, to half a pixel: their line was not found at its place."""
    height = glyphs.shape[1]
    profiles = glyphs.sum(axis=2)
    drawn, expected = np.zeros(height), np.zeros(height)
    for name in np.unique(names[at & np.isin(names, names[~at])]):
        is_name = names == name
        drawn += profiles[is_name & at].sum(axis=0)
        expected += np.sum(is_name & at) * profiles[is_name & ~at].mean(axis=0)
    halves = np.arange(0, height - 0.9, 0.5)
    drawn, expected = (
        np.interp(halves, np.arange(height), profile) for profile in (drawn, expected)
    )
    steps = range(-height // 2, height // 2)
    return max(steps, key=lambda step: float(np.roll(drawn, step) @ expected)) / 2


def foreign_row(grid: Grid, reads: Sequence[Read]) -> Row | None:
    """Return the row of a grid's printouts, one with numbers, that is in another typeface than the
    others, None if there is none.

    The glyphs of all other rows leave much of its ink unexplained, much more than of any other
    row's, and its own do not. Letters of labels are compared with the same letters, characters of
    numbers with the nearest one, so that it does not matter as what they were read.
    """
    rows = [(read, row) for read in reads for row in read.sheet.rows.values()]
    has_numbers = [any(piece.name for piece in row.pieces) for _, row in rows]
    if sum(has_numbers) < 2:
        return None
    cells = _row_cells(grid, rows)
    is_other = ~np.eye(len(rows), dtype=bool)

    def residues(allowed: Mask) -> list[float]:
        """Return what the other rows that are allowed leave unexplained of each with numbers."""
        return [
            cells.residue(row, is_other[row] & allowed) if has_numbers[row] else 0.0
            for row in range(len(rows))
        ]

    by_all = residues(np.ones(len(rows), bool))
    first = int(np.argmax(by_all))
    # what is said of a row must not be due to the first one's part in the glyphs
    by_rest = residues(is_other[first])
    second = max(fraction for row, fraction in enumerate(by_rest) if row != first)
    is_foreign = (
        by_all[first] > max(_FOREIGN, _FOREIGN_RATIO * second)
        and abs(cells.rises[first]) <= _MAX_RISE
        and cells.unexplained_within(first) < _OWN_RATIO * by_all[first]
    )
    return rows[first][1] if is_foreign else None
