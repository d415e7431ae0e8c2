"""Ink outside what the program prints: the marks of a page that no predicted character explains.

Cells of the printouts' lines come first (`holding` says which blank cell holds a character), then
lines of type that belong to no printout, then whatever ink is left, in connected regions.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property
from typing import NamedTuple

import numpy as np
import PIL.Image
import PIL.ImageDraw
from scipy import ndimage

from .claims import Claim
from .grid import CELL_WIDTH, Grid
from .holding import FIT, INKED, Added, Cell
from .ink import Floats, Image, Mask, Spot, hole_columns, resize
from .layout import Place
from .typeface import BLANK, Typeface, distances, sample_of, typeface_of

# Pixels are those of the sheet scaled to cells of `CELL_WIDTH`.
_DARK = 0.3  # ink, 1 for full, from which a pixel is a mark's; shadows and show-through have less
_SPILL = 3  # pixels by which a glyph may reach over the edge of its cell
_SPECK = 0.12  # fraction of a cell's area below which ink is speckle, unless in a cell of a line
_NEAR = 10  # pixels between parts of one mark
_MIN_TYPED = 3  # characters of a line of type
_MIN_LEAD = 0.3  # of a certain character over the next, relative to their distance
_MIN_ALIKE = 0.5  # fraction of a typed line's cells that are like a character of the page
_LONG = 0.4  # fraction of the sheet's side from which a thin mark is a straight line
_TYPED_CELLS = (Added.CHARACTER, Added.BESIDE)
_MAX_MARKS = 40  # listed on a page, those that bear on the verdict first


class Kind(StrEnum):
    """Kinds of marks."""

    CHARACTER = "character"
    """A character of the page's type in a cell where the program prints a blank."""
    TYPE = "type"
    """Typed text outside the program's page."""
    MARK = "mark"
    """A mark no larger than a character, like none of them."""
    STROKE = "stroke"
    """Pen, stamp, ring: a mark larger than a character."""
    COLOURED = "coloured ink"
    PAPER = "straight line, hole or edge of the sheet"
    """It belongs to the paper, not to the page, and is not listed."""


_TEXT = frozenset({Kind.CHARACTER, Kind.TYPE})
"""Kinds that bear on the verdict wherever they stand."""
_PEN = frozenset({Kind.MARK, Kind.STROKE, Kind.COLOURED})
"""Kinds that bear on the verdict in or beside a line."""


@dataclass
class Mark:
    """A mark that no printout explains.

    Attributes
    ----------
    kind : Kind
    corners : ndarray, shape (4, 2)
        Its corners in the upright sheet, clockwise.
    reads : str
        The text that it reads, or is most like.
    place : Place, optional
        The cell in which it begins.
    touches : list of str
        The fields whose cells it touches.
    beside : bool
        True if it stands in or beside a line of a printout.
    sure : str
        The text of type with ``?`` for characters that are not certain.
    claims : list of Claim
        Other values that the text gives for the page's numbers.
    """

    kind: Kind
    corners: Floats
    reads: str = ""
    place: Place | None = None
    touches: list[str] = field(default_factory=list)
    beside: bool = False
    sure: str = ""
    claims: list[Claim] = field(default_factory=list)

    @property
    def bears(self) -> bool:
        """True if a page with this mark is identical only as far as it was read."""
        return self.kind in _TEXT or (self.beside and self.kind in _PEN)


@dataclass
class Explained:
    """Ink that a grid's printouts explain: their cells, the lines of the grid they take, and those
    of their rows that are cut through and were not read."""

    grid: Grid
    cells: Sequence[Cell]
    lines: set[int]
    cut_lines: set[int]

    @cached_property
    def typeface(self) -> Typeface:
        """Return the page's typeface under the predicted names."""
        sample = sample_of(self.grid, [cell.place for cell in self.cells])
        return typeface_of(sample, ["" if cell.cut else cell.predicted for cell in self.cells])


def residue_of(ink: Image, coloured: Image | None, explained: Sequence[Explained]) -> list[Mark]:
    """Return the marks of an upright sheet that its printouts do not explain, up to `_MAX_MARKS`.

    Parameters
    ----------
    ink : ndarray, shape (rows, columns)
    coloured : ndarray, optional
        Ink of another colour than the page's, which is not in ``ink``.
    explained : sequence of Explained
        The printouts of each grid.
    """
    lines_of_type = [mark for part in explained for mark in _typed_lines(part)]
    scale = min(1.0, CELL_WIDTH / min(part.grid.pitch for part in explained))
    small = resize(np.ascontiguousarray(ink), scale)
    is_dark = small > _DARK
    cells = [
        (cell, part.grid.around(*cell.place))
        for part in explained
        for cell in part.cells
        if not cell.cut and (cell.predicted != BLANK or cell.added in _TYPED_CELLS)
    ]
    outlines = [around for _, around in cells] + [mark.corners for mark in lines_of_type]
    outlines += [_outline(part.grid, line) for part in explained for line in part.cut_lines]
    is_explained = ndimage.binary_dilation(
        _mask_of(outlines, scale, is_dark.shape), iterations=_SPILL
    )
    in_bands = _mask_of([*_line_outlines(explained)], scale, is_dark.shape)
    marks = [*_added_marks(explained), *lines_of_type]
    regions = [(is_dark & ~is_explained, Kind.STROKE)]
    if coloured is not None:
        regions.append((resize(np.ascontiguousarray(coloured), scale) > _DARK, Kind.COLOURED))
    for is_left, kind in regions:
        regions_of_kind = [*_regions(is_left, kind, in_bands)]
        spots = [_spot(mark, area) for mark, area in regions_of_kind]
        holes = {spot for column in hole_columns(spots, is_left.shape[1]) for spot in column}
        for (mark, area), spot in zip(regions_of_kind, spots, strict=True):
            if area < _SPECK * CELL_WIDTH**2 or (kind is Kind.STROKE and spot in holes):
                continue
            reach = is_dark | is_left if kind is Kind.STROKE else is_left
            mark.touches = _touched_fields(mark, reach, is_left, cells, scale)
            mark.corners = mark.corners / scale
            marks.append(mark)
    marks += _small_marks(explained, marks)
    marks = [mark for mark in marks if mark.kind is not Kind.PAPER]
    marks.sort(key=lambda mark: (not mark.bears, float(mark.corners[0, 1])))
    return marks[:_MAX_MARKS]


def _added_marks(explained: Sequence[Explained]) -> Iterator[Mark]:
    """Yield a mark for each run of blanks of printed lines in which type stands."""
    for part in explained:
        run: list[Cell] = []
        for cell in [*part.cells, None]:
            if run and (cell is None or _starts_run(run[-1], cell)):
                yield _run_mark(part, run)
                run = []
            if cell and cell.added in _TYPED_CELLS:
                run.append(cell)


def _small_marks(explained: Sequence[Explained], marks: Sequence[Mark]) -> list[Mark]:
    """Return marks in blanks that are no characters and lie in no region of ink in ``marks``."""
    boxes = [(mark.corners.min(axis=0), mark.corners.max(axis=0)) for mark in marks]
    unlisted = []
    for part in explained:
        for cell in part.cells:
            if cell.added is Added.MARK:
                corners = part.grid.around(*cell.place)
                middle = corners.mean(axis=0)
                if not any(np.all((low <= middle) & (middle <= high)) for low, high in boxes):
                    unlisted.append(Mark(Kind.MARK, corners, "", cell.place, [], True))
    return unlisted


def _starts_run(before: Cell, cell: Cell) -> bool:
    """Return True for a cell that does not continue a run; a run may have blanks of one cell."""
    if cell.added not in _TYPED_CELLS:
        return cell.predicted != BLANK or cell.place.cell > before.place.cell + 2
    is_near = cell.place.line == before.place.line and cell.place.cell <= before.place.cell + 3
    return cell.added is not before.added or not is_near


def _run_mark(part: Explained, run: Sequence[Cell]) -> Mark:
    """Return the mark of a run of cells with what it reads."""
    first, last = run[0], run[-1]
    start, stop = part.grid.around(*first.place), part.grid.around(*last.place)
    corners = np.stack([start[0], stop[1], stop[2], start[3]])
    text = ""
    for cell in run:
        text = text.ljust(cell.place.cell - first.place.cell) + cell.other
    kind = Kind.CHARACTER if first.added is Added.CHARACTER else Kind.TYPE
    names = [first.name] if first.name else []
    mark = Mark(kind, corners, text, first.place, names, True)
    if kind is Kind.TYPE:
        read = _type_at(part, first.place.line, [cell.place.cell for cell in run])
        mark.sure = read.sure
    return mark


class _Type(NamedTuple):
    """Text of some cells of a line, read by the page's own typeface.

    Attributes
    ----------
    text : str
        The text, ``?`` for a character that the typeface lacks.
    sure : str
        The text, ``?`` also for a character that is not certain.
    alike : ndarray of bool, shape (cells,)
        True for cells that are like a character of the typeface.
    """

    text: str
    sure: str
    alike: Mask


def _type_at(part: Explained, line: int, cells: Sequence[int]) -> _Type:
    """Read cells of a line by the means of the page's own characters."""
    typeface = part.typeface
    energy = np.maximum(np.einsum("mp,mp->m", typeface.means, typeface.means), 1e-6)
    sample = sample_of(part.grid, [Place(line, cell) for cell in cells])
    to_means, _ = distances(sample, typeface.means)
    rows = np.arange(len(cells))
    nearest = to_means.argmin(axis=1)
    least = to_means[rows, nearest]
    norms = sample.norms.min(axis=1)
    gain = norms - least
    is_alike = (gain > INKED * energy[nearest]) & (gain > FIT * norms)
    # certain where no other character is nearly as near
    to_means[rows, nearest] = np.inf
    second = to_means.argmin(axis=1)
    step = np.maximum(typeface.between()[nearest, second], 1e-6)
    is_certain = is_alike & (to_means[rows, second] - least > _MIN_LEAD * step)
    is_certain &= typeface.counts[nearest] > 1
    text = sure = ""
    names = [typeface.characters[at] for at in nearest.tolist()]
    for cell, name, alike, certain in zip(
        cells, names, is_alike.tolist(), is_certain.tolist(), strict=True
    ):
        text = text.ljust(cell - cells[0]) + (name if alike else "?")
        sure = sure.ljust(cell - cells[0]) + (name if certain else "?")
    return _Type(text, sure, is_alike)


def _typed_lines(part: Explained) -> Iterator[Mark]:
    """Yield the lines of type that no printout takes, read by the page's own typeface."""
    grid, odds = part.grid, part.grid.odds()
    free_lines = {*range(len(grid.pictures))} - part.lines - part.cut_lines
    inked_cells = {line: np.flatnonzero(odds[line] > 0) for line in sorted(free_lines)}
    lines = {line: at for line, at in inked_cells.items() if len(at) >= _MIN_TYPED}
    if not lines or not part.cells:
        return
    for line, inked in lines.items():
        read = _type_at(part, line, inked.tolist())
        if read.alike.mean() < _MIN_ALIKE or read.alike.sum() < _MIN_TYPED:
            continue
        start, stop = (grid.around(line, int(cell)) for cell in inked[[0, -1]])
        corners = np.stack([start[0], stop[1], stop[2], start[3]])
        place = Place(line, int(inked[0]))
        yield Mark(Kind.TYPE, corners, read.text, place, sure=read.sure)


def _spot(mark: Mark, area: int) -> Spot:
    """Return a mark as a region of ink."""
    (x, y), (width, height) = mark.corners.mean(axis=0), np.ptp(mark.corners, axis=0)
    return Spot(float(x), float(y), float(width), float(height), float(area / width / height))


def _mask_of(outlines: Sequence[Floats], scale: float, shape: tuple[int, ...]) -> Mask:
    """Return a mask of the insides of some outlines, on the sheet made smaller by ``scale``."""
    picture = PIL.Image.new("1", (shape[1], shape[0]))
    pen = PIL.ImageDraw.Draw(picture)
    for around in outlines:
        pen.polygon([(float(x), float(y)) for x, y in around * scale], fill=1)
    return np.asarray(picture, bool)


def _line_outlines(explained: Sequence[Explained]) -> Iterator[Floats]:
    """Yield the outlines of the lines that printouts take, from edge to edge of their grids."""
    for part in explained:
        for line in part.lines:
            yield _outline(part.grid, line)


def _outline(grid: Grid, line: int) -> Floats:
    corners = grid.corners[line]
    return np.concatenate([corners[:, 0], corners[::-1, 1]])


def _regions(is_left: Mask, kind: Kind, bands: Mask) -> Iterator[tuple[Mark, int]]:
    """Yield connected regions of ink with their areas; parts within `_NEAR` are one region."""
    closed = ndimage.binary_closing(np.pad(is_left, _NEAR), iterations=_NEAR // 2)
    closed = closed[_NEAR:-_NEAR, _NEAR:-_NEAR] | is_left
    labels, count = ndimage.label(closed, np.ones((3, 3)))
    areas = ndimage.sum_labels(is_left, labels, range(1, count + 1)).astype(int)
    inside = ndimage.sum_labels(is_left & bands, labels, range(1, count + 1)).astype(int)
    height, width = is_left.shape
    for number, box in enumerate(ndimage.find_objects(labels)):
        (top, foot), (start, stop) = ((part.start, part.stop) for part in box)
        corners = np.array([[start, top], [stop, top], [stop, foot], [start, foot]], float)
        area, is_beside = int(areas[number]), bool(inside[number] > _SPECK * CELL_WIDTH**2)
        mark = Mark(kind, corners, beside=is_beside)
        down, across = foot - top, stop - start
        is_at_edge = min(top, start, height - foot, width - stop) <= 2
        if kind is not Kind.COLOURED:
            is_long = across > _LONG * width or down > _LONG * height
            is_edge = is_at_edge and not (is_beside and area < CELL_WIDTH**2)
            if is_edge or (is_long and min(across, down) < 2 * CELL_WIDTH):
                mark.kind = Kind.PAPER
            elif max(across, down) < 2 * CELL_WIDTH:
                mark.kind = Kind.MARK
        yield mark, area


def _touched_fields(
    mark: Mark, reach: Mask, is_left: Mask, cells: Sequence[tuple[Cell, Floats]], scale: float
) -> list[str]:
    """Return the fields (or "a label") of the cells into which a mark's ink runs on.

    ``reach``: ink through which it may run; ``is_left``: ink that no cell explains.
    """
    (start, top), (stop, foot) = mark.corners.min(axis=0), mark.corners.max(axis=0)
    margin = 2 * _SPILL
    top, start = max(int(top) - margin, 0), max(int(start) - margin, 0)
    window = slice(top, int(foot) + margin), slice(start, int(stop) + margin)
    labels, _ = ndimage.label(reach[window], np.ones((3, 3)))
    of_mark = np.unique(labels[is_left[window]])
    fields: dict[str, None] = {}
    for cell, around in cells:
        (x0, y0), (x1, y1) = around.min(axis=0) * scale, around.max(axis=0) * scale
        inner = labels[
            max(int(y0) + 1 - top, 0) : max(int(y1) - top, 0),
            max(int(x0) + 1 - start, 0) : max(int(x1) - start, 0),
        ]
        if inner.size and np.isin(inner, of_mark[of_mark > 0]).mean() > 0.05:
            fields[cell.name or "a label"] = None
    return list(fields)
