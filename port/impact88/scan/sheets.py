"""A page's picture from ink to verdict."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby, product
from operator import attrgetter

import numpy as np

from ..fields import INPUTS
from ..judging.judgement import Verdict
from ..reading.alignment import MAY_BE_MISSING
from .grid import FEWEST_POINTS, Grid, grids_of
from .holding import Cell, Judged, held, judged, state
from .ink import Image, ink_of, points_of
from .layout import Sheet, sheets_of
from .scenes import Candidate, Read, borne_out, scene_of
from .typeface import BLANK, read_numbers

_UPRIGHT = 600.0
"""Gain of a printout that is found the right way up: those of 445 pages have 740 and more, upside
down the best had 410."""
_LEGIBLE = 300.0
"""Gain from which a scene is searched for; with less, noise was taken for lines."""
_REGULAR = 0.7
"""Clarity of the columns from which printouts are told apart and scenes searched for: of 1,302
printouts that got a verdict the least had .85."""

_LEAST_SIDE = 100
"""Pixels of the shorter side of a picture that is looked at; 13 lines of 5 pixels have as many."""


@dataclass
class Leaf:
    """One printout of a page: the grid it stands on, what was read and where, the verdict, the
    scene found, and its cells held against the program's page."""

    grid: Grid
    read: Read
    judged: Judged
    found: Candidate | None = None
    cells: list[Cell] = field(default_factory=list)

    @cached_property
    def by_name(self) -> dict[str, list[Cell]]:
        """The cells of each number and reply, in order."""
        by_name = groupby(self.cells, attrgetter("name"))
        return {name: [*cells] for name, cells in by_name if name}


def looked(grey: Image, seeds: Sequence[dict[str, str]] = ()) -> list[Leaf]:
    """All printouts of a page, upright or turned by quarters. ``seeds``: scenes that another reader
    found; they are tried beside those of the picture."""
    if min(grey.shape) < _LEAST_SIDE:
        return []
    ink = ink_of(grey)
    most, found = 0.0, list[tuple[Grid, list[Sheet]]]()
    order = _turns(ink)
    for fold, turns in product((1, 2), order):
        if turns == order[0]:
            points = points_of(ink, fold)
            if len(points.x) < FEWEST_POINTS:
                break
        grids = grids_of(ink, points, turns)
        laid = [(grid, sheets_of(grid.odds(), grid.tops)) for grid in grids]
        sheets = [sheet for _, some in laid for sheet in some]
        gain = sum(sheet.gain for sheet in sheets)
        if gain > most:
            most, found = gain, laid
        if any(sheet.whole and sheet.gain > _UPRIGHT for sheet in sheets):
            break
    return [leaf for pair in found for leaf in _leaves(*pair, seeds)]


def _turns(ink: Image) -> list[int]:
    """Quarter turns in the order in which they are tried: as the page lies, upside down, and on
    its sides; lines of text make rows of ink and gaps, seen from the right side."""
    small = ink[::4, ::4]
    steps = (np.abs(np.diff(small.mean(axis=axis))) for axis in (0, 1))
    across, down = (float(np.percentile(step, 95)) for step in steps)  # beyond edges of the paper
    return [0, 2, 1, 3] if down >= across else [1, 3, 0, 2]


def _leaves(grid: Grid, sheets: list[Sheet], seeds: Sequence[dict[str, str]]) -> list[Leaf]:
    if sheets and grid.clarity < _REGULAR:
        likeliest = max(sheets, key=lambda sheet: sheet.gain)
        unread = Judged(Verdict.INCOMPLETE, reason="its type stands in no clear columns")
        return [Leaf(grid, Read(likeliest, {}), unread)]
    unread = Judged(Verdict.INCOMPLETE, reason="no scene was found")
    leaves = [Leaf(grid, Read(sheet, {}), unread) for sheet in sheets]
    legible = [leaf for leaf in leaves if leaf.read.sheet.gain > _LEGIBLE]
    costs = read_numbers(grid, [leaf.read.sheet for leaf in legible])
    for leaf, own in zip(legible, costs, strict=True):
        leaf.read.costs = own
        leaf.found = scene_of(leaf.read, seeds)
    known = [leaf for leaf in legible if leaf.found]
    _hold(grid, known)
    if sum(map(_mistaken, known)):
        _hold(grid, known)
    before = [leaf.found for leaf in known]
    for leaf in known:
        leaf.found = leaf.found and borne_out(leaf.found, _shown(leaf.cells))
    if any(leaf.found is not earlier for leaf, earlier in zip(known, before, strict=True)):
        _hold(grid, known)
    for leaf in known:
        if leaf.found:
            leaf.judged = judged(leaf.read.sheet, leaf.found, leaf.cells)
    # the printouts of a page share their mean characters: one misplaced spoils them for all
    if any(leaf.judged.verdict is Verdict.INCOMPLETE for leaf in leaves):
        for leaf in leaves:
            if leaf.judged.verdict is Verdict.DIFFERS:
                leaf.judged.verdict = Verdict.INCOMPLETE
                leaf.judged.reason = "another printout on the page was not read"
    return leaves


def _hold(grid: Grid, known: Sequence[Leaf]) -> None:
    """Holds the cells of all printouts against the pages of their scenes."""
    cells = held(grid, [(leaf.read, leaf.found) for leaf in known if leaf.found])
    for leaf, own in zip(known, cells, strict=True):
        leaf.cells = own


def _shown(cells: Sequence[Cell]) -> dict[str, str]:
    """The inputs of a printout in which a cell differs, as the paper shows them."""
    differing = {cell.name for cell in cells if state(cell) == "differs"}
    texts = dict.fromkeys(differing & set(INPUTS), "")
    for cell in cells:
        if cell.name in texts:
            texts[cell.name] += cell.other if state(cell) == "differs" else cell.predicted
    return {name: text.strip() for name, text in texts.items()}


def _mistaken(leaf: Leaf) -> bool:
    """Takes from a printout the lines it may lack whose labels are not what stands there: a foot of
    the page may be as long as a line of the print."""
    found, sheet = False, leaf.read.sheet
    for line in [line for line in MAY_BE_MISSING if line in sheet.rows]:
        row = sheet.rows[line]
        states = [
            state(cell)
            for cell in leaf.cells
            if not cell.name and cell.predicted != BLANK
            if row.start <= cell.place.line < row.start + row.used
        ]
        if states.count("holds") < 0.5 * len(states):
            del sheet.rows[line]
            found = True
    return found
