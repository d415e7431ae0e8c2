"""Ink outside what the program prints: every mark of a page that no predicted character explains.

Cells of the printouts' lines come first (`holding` says which blank cell holds a character), then
lines of type that belong to no printout, then whatever ink is left, in connected regions.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import NamedTuple

import numpy as np
import PIL.Image
import PIL.ImageDraw
from numpy.typing import NDArray
from scipy import ndimage

from .claims import Claim
from .grid import CELL_WIDTH, Grid
from .holding import DIFFERS, FIT, INKED, Added, Cell
from .ink import Floats, Image, resized
from .layout import Place
from .typeface import BLANK, Typeface, distances, sample_of, typeface_of

Mask = NDArray[np.bool_]

_DARK = 0.3  # darkness, of full ink, from which a pixel is a mark's; a shadow or show-through less
_SPILL = 3  # pixels, of a cell's 16, by which a glyph may reach over the edge of its cell
_SPECK = 0.12  # of a cell's area: smaller is speckle, unless it is seen in a cell of a line
_NEAR = 10  # pixels between parts of one mark
_FEWEST_TYPED = 3  # characters of a line of type
_TYPED = 0.5  # the least part of its cells that are like a character of the page
_LONG = 0.4  # of the sheet's side: a straight line
_TYPED_CELLS = (Added.CHARACTER, Added.TYPE)
_MAX_MARKS = 40  # listed of a page; more are counted


class Kind(StrEnum):
    """What a mark is."""

    CHARACTER = "character"
    """A character of the page's type in a cell where the program prints a blank."""
    TYPE = "type"
    """Typed text outside the program's page."""
    MARK = "mark"
    """A mark no larger than a character, like none of them."""
    STROKE = "stroke"
    """Pen, stamp, ring: a mark larger than a character."""
    COLOURED = "coloured ink"
    LINE = "straight line"
    HOLE = "hole"
    EDGE = "edge of the sheet"


_TEXT = frozenset({Kind.CHARACTER, Kind.TYPE})
"""Kinds that bear on the page wherever they stand."""
_PEN = frozenset({Kind.MARK, Kind.STROKE, Kind.COLOURED})
"""Kinds that bear on it in or beside a line."""


@dataclass
class Mark:
    """A mark: its kind, its corners in the upright sheet, clockwise, shape (4, 2); what it reads,
    or is most like; its line on the grid and the cell it begins in; the fields whose cells it
    touches; whether it stands in or beside a line of a printout; of type, what it reads with
    certainty, ``?`` for other characters, and what it says of the page's numbers."""

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
        """Whether a page with this mark is identical only as far as it was read."""
        return self.kind in _TEXT or (self.beside and self.kind in _PEN)


@dataclass
class Residue:
    """What is on a sheet besides its printouts: ``marks``, how many ``more`` there are that are not
    listed, and the number of ``specks``."""

    marks: list[Mark] = field(default_factory=list)
    more: int = 0
    specks: int = 0


@dataclass
class Explained:
    """What a grid's printouts explain: their cells, and the lines they take."""

    grid: Grid
    cells: Sequence[Cell]
    lines: set[int]

    def typeface(self) -> Typeface:
        """Return the type of the page."""
        sample = sample_of(self.grid, [cell.place for cell in self.cells])
        return typeface_of(sample, ["" if cell.cut else cell.predicted for cell in self.cells])


def residue_of(ink: Image, coloured: Image | None, explained: Sequence[Explained]) -> Residue:
    """Return the marks of an upright sheet that its printouts do not explain.

    ``coloured``: ink of another colour than the page's, which is not in ``ink``.
    """
    typed = [mark for part in explained for mark in _typed(part)]
    pitch = min(part.grid.pitch for part in explained)
    scale = min(1.0, CELL_WIDTH / pitch)
    small = resized(np.ascontiguousarray(ink), scale)
    dark = small > _DARK
    cells = [
        (cell, part.grid.around(*cell.place))
        for part in explained
        for cell in part.cells
        if not cell.cut and (cell.predicted != BLANK or cell.added in _TYPED_CELLS)
    ]
    outlines = [around for _, around in cells] + [mark.corners for mark in typed]
    known = ndimage.binary_dilation(_filled(outlines, scale, dark.shape), iterations=_SPILL)
    bands = _filled([*_bands(explained)], scale, dark.shape)
    residue = Residue([*_added(explained), *typed])
    regions = [(dark & ~known, Kind.STROKE)]
    if coloured is not None:
        regions.append((resized(np.ascontiguousarray(coloured), scale) > _DARK, Kind.COLOURED))
    for left, kind in regions:
        for mark, area in _marks(left, kind, bands):
            if area < _SPECK * CELL_WIDTH**2:
                residue.specks += 1
                continue
            reach = dark | left if kind is Kind.STROKE else left
            mark.touches = _touched(mark, reach, left, cells, scale)
            mark.corners = mark.corners / scale
            residue.marks.append(mark)
    residue.marks += _unseen(explained, residue.marks)
    _find_holes(residue.marks, pitch)
    residue.marks.sort(key=lambda mark: (not mark.bears, float(mark.corners[0, 1])))
    residue.more = max(0, len(residue.marks) - _MAX_MARKS)
    del residue.marks[_MAX_MARKS:]
    return residue


def _added(explained: Sequence[Explained]) -> Iterator[Mark]:
    """The blanks of printed lines in which type stands: a mark for each run of cells."""
    for part in explained:
        run: list[Cell] = []
        for cell in [*part.cells, None]:
            if run and (cell is None or _apart(run[-1], cell)):
                yield _run_mark(part, run)
                run = []
            if cell and cell.added in _TYPED_CELLS:
                run.append(cell)


def _unseen(explained: Sequence[Explained], marks: Sequence[Mark]) -> list[Mark]:
    """Marks in blanks that are no characters, and of which no region of ink was listed."""
    boxes = [(mark.corners.min(axis=0), mark.corners.max(axis=0)) for mark in marks]
    unseen = []
    for part in explained:
        for cell in part.cells:
            if cell.added is Added.MARK:
                corners = part.grid.around(*cell.place)
                middle = corners.mean(axis=0)
                if not any(np.all((low <= middle) & (middle <= high)) for low, high in boxes):
                    unseen.append(Mark(Kind.MARK, corners, "", cell.place, [], True))
    return unseen


def _apart(before: Cell, cell: Cell) -> bool:
    """Whether a cell continues no run: text has blanks of one cell."""
    if cell.added not in _TYPED_CELLS:
        return cell.predicted != BLANK or cell.place.cell > before.place.cell + 2
    near = cell.place.line == before.place.line and cell.place.cell <= before.place.cell + 3
    return cell.added is not before.added or not near


def _run_mark(part: Explained, run: Sequence[Cell]) -> Mark:
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
        read = _type_at(part, part.typeface(), first.place.line, [cell.place.cell for cell in run])
        mark.sure = read.sure
    return mark


class _Type(NamedTuple):
    """What stands in some cells of a line by the page's own type: ``?`` in ``text`` for a character
    that it lacks, in ``sure`` for one that is not certain, too; ``alike``: which are of the type.
    """

    text: str
    sure: str
    alike: Mask


def _type_at(part: Explained, typeface: Typeface, line: int, cells: Sequence[int]) -> _Type:
    """Read cells of a line by the means of the page's own characters."""
    energy = np.maximum(np.einsum("mp,mp->m", typeface.means, typeface.means), 1e-6)
    sample = sample_of(part.grid, [Place(line, cell) for cell in cells])
    apart, _ = distances(sample, typeface.means)
    every = np.arange(len(cells))
    nearest = apart.argmin(axis=1)
    least = apart[every, nearest]
    norms = sample.norms.min(axis=1)
    gain = norms - least
    alike = (gain > INKED * energy[nearest]) & (gain > FIT * norms)
    # as certain as of a cell that differs: no other character is nearly as near
    apart[every, nearest] = np.inf
    second = apart.argmin(axis=1)
    step = np.maximum(typeface.between()[nearest, second], 1e-6)
    certain = alike & (apart[every, second] - least > DIFFERS * step)
    certain &= typeface.counts[nearest] > 1
    text = sure = ""
    names = [typeface.characters[at] for at in nearest.tolist()]
    for cell, name, like, clear in zip(cells, names, alike.tolist(), certain.tolist(), strict=True):
        text = text.ljust(cell - cells[0]) + (name if like else "?")
        sure = sure.ljust(cell - cells[0]) + (name if clear else "?")
    return _Type(text, sure, alike)


def _typed(part: Explained) -> Iterator[Mark]:
    """Lines of type that no printout takes, each with what it reads by the page's own type."""
    grid, odds = part.grid, part.grid.odds()
    rest = [line for line in range(len(grid.pictures)) if line not in part.lines]
    inked_cells = {line: np.flatnonzero(odds[line] > 0) for line in rest}
    lines = {line: at for line, at in inked_cells.items() if len(at) >= _FEWEST_TYPED}
    if not lines or not part.cells:
        return
    typeface = part.typeface()
    for line, inked in lines.items():
        read = _type_at(part, typeface, line, inked.tolist())
        if read.alike.mean() < _TYPED or read.alike.sum() < _FEWEST_TYPED:
            continue
        start, stop = (grid.around(line, int(cell)) for cell in inked[[0, -1]])
        corners = np.stack([start[0], stop[1], stop[2], start[3]])
        place = Place(line, int(inked[0]))
        yield Mark(Kind.TYPE, corners, read.text, place, sure=read.sure)


def _filled(outlines: Sequence[Floats], scale: float, shape: tuple[int, ...]) -> Mask:
    """Return where any of some outlines is, on the sheet made smaller."""
    picture = PIL.Image.new("1", (shape[1], shape[0]))
    pen = PIL.ImageDraw.Draw(picture)
    for around in outlines:
        pen.polygon([(float(x), float(y)) for x, y in around * scale], fill=1)
    return np.asarray(picture, bool)


def _bands(explained: Sequence[Explained]) -> Iterator[Floats]:
    """The lines that printouts take, from edge to edge of their grids."""
    for part in explained:
        for line in part.lines:
            corners = part.grid.corners[line]
            yield np.concatenate([corners[:, 0], corners[::-1, 1]])


def _marks(left: Mask, kind: Kind, bands: Mask) -> Iterator[tuple[Mark, int]]:
    """Connected regions of ink that is left, with their areas; parts near each other are one."""
    joined = ndimage.binary_closing(np.pad(left, _NEAR), iterations=_NEAR // 2)
    joined = joined[_NEAR:-_NEAR, _NEAR:-_NEAR] | left
    labels, count = ndimage.label(joined, np.ones((3, 3)))
    areas = ndimage.sum_labels(left, labels, range(1, count + 1)).astype(int)
    within = ndimage.sum_labels(left & bands, labels, range(1, count + 1)).astype(int)
    height, width = left.shape
    for which, box in enumerate(ndimage.find_objects(labels)):
        (top, foot), (start, stop) = ((part.start, part.stop) for part in box)
        corners = np.array([[start, top], [stop, top], [stop, foot], [start, foot]], float)
        area, beside = int(areas[which]), bool(within[which] > _SPECK * CELL_WIDTH**2)
        mark = Mark(kind, corners, beside=beside)
        down, across = foot - top, stop - start
        at_edge = min(top, start, height - foot, width - stop) <= 2
        if kind is not Kind.COLOURED:
            long = across > _LONG * width or down > _LONG * height
            if at_edge and not (beside and area < CELL_WIDTH**2):
                mark.kind = Kind.EDGE
            elif long and min(across, down) < 2 * CELL_WIDTH:
                mark.kind = Kind.LINE
            elif max(across, down) < 2 * CELL_WIDTH:
                mark.kind = Kind.MARK
        yield mark, area


def _find_holes(marks: Sequence[Mark], pitch: float) -> None:
    """Say of marks which are holes: alike, round, and below each other."""
    sizes = np.array([np.ptp(mark.corners, axis=0) for mark in marks]).reshape(-1, 2)
    middles = np.array([mark.corners.mean(axis=0) for mark in marks]).reshape(-1, 2)
    for mark, size, middle in zip(marks, sizes, middles, strict=True):
        round_ = 0.6 < size[0] / max(size[1], 1.0) < 1.7 and size.max() < 4 * pitch
        alike = np.abs(sizes - size).max(axis=1) < 0.4 * size.max()
        column = alike & (np.abs(middles[:, 0] - middle[0]) < 1.5 * pitch)
        if round_ and column.sum() > 3 and mark.kind in (Kind.MARK, Kind.STROKE, Kind.EDGE):
            mark.kind = Kind.HOLE


def _touched(
    mark: Mark, reach: Mask, left: Mask, cells: Sequence[tuple[Cell, Floats]], scale: float
) -> list[str]:
    """The fields, or labels, of the cells into which a mark's ink runs on."""
    (start, top), (stop, foot) = mark.corners.min(axis=0), mark.corners.max(axis=0)
    margin = 2 * _SPILL
    top, start = max(int(top) - margin, 0), max(int(start) - margin, 0)
    window = slice(top, int(foot) + margin), slice(start, int(stop) + margin)
    labels, _ = ndimage.label(reach[window], np.ones((3, 3)))
    of_mark = np.unique(labels[left[window]])
    touched: dict[str, None] = {}
    for cell, around in cells:
        (x0, y0), (x1, y1) = around.min(axis=0) * scale, around.max(axis=0) * scale
        inner = labels[
            max(int(y0) + 1 - top, 0) : max(int(y1) - top, 0),
            max(int(x0) + 1 - start, 0) : max(int(x1) - start, 0),
        ]
        if inner.size and np.isin(inner, of_mark[of_mark > 0]).mean() > 0.05:
            touched[cell.name or "a label"] = None
    return list(touched)
