"""A page's picture from ink to verdict."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from ..fields import INPUTS
from ..judging.judgement import Verdict
from ..reading.alignment import MAY_BE_MISSING
from .evidence import Judged, judged, state
from .grid import Grid, grids_of
from .holding import Cell, held
from .ink import Image, ink_of
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


@dataclass
class Leaf:
    """One printout of a page: the grid it stands on and where, what was read, the scene found, its
    cells held against the program's page, and the verdict."""

    grid: Grid
    sheet: Sheet
    read: Read
    found: Candidate | None
    cells: list[Cell]
    judged: Judged

    @cached_property
    def by_name(self) -> dict[str, list[Cell]]:
        """The cells of each number and reply, in order."""
        cells: dict[str, list[Cell]] = {}
        for cell in self.cells:
            if cell.name:
                cells.setdefault(cell.name, []).append(cell)
        return cells


def looked(grey: Image, seeds: Sequence[dict[str, str]] = ()) -> list[Leaf]:
    """All printouts of a page, upright or turned by quarters. ``seeds``: scenes that another reader
    found; they are tried beside those of the picture."""
    ink = ink_of(grey)
    most, found = 0.0, list[tuple[Grid, list[Sheet]]]()
    for fold, turns in product((1, 2), _turns(ink)):
        grids = grids_of(ink, turns, fold)
        laid = [(grid, sheets_of(grid.odds(), grid.tops)) for grid in grids]
        sheets = [sheet for _, some in laid for sheet in some]
        gain = sum(sheet.gain for sheet in sheets)
        if gain > most:
            most, found = gain, laid
        if any(sheet.whole and sheet.gain > _UPRIGHT for sheet in sheets):
            break
    return [leaf for one in found for leaf in _leaves(*one, seeds)]


def _turns(ink: Image) -> list[int]:
    """Quarter turns in the order in which they are tried: as the page lies, upside down, and on
    its sides; lines of text make rows of ink and gaps, seen from the right side."""
    small = ink[::4, ::4]
    steps = (np.abs(np.diff(small.mean(axis=axis))) for axis in (0, 1))
    across, down = (float(np.percentile(one, 95)) for one in steps)  # beyond edges of the paper
    return [0, 2, 1, 3] if down >= across else [1, 3, 0, 2]


def _leaves(grid: Grid, sheets: list[Sheet], seeds: Sequence[dict[str, str]]) -> list[Leaf]:
    if not sheets:
        return []
    if grid.clarity < _REGULAR:
        likeliest = max(sheets, key=lambda sheet: sheet.gain)
        unread = Judged(Verdict.INCOMPLETE, reason="its type stands in no clear columns")
        return [Leaf(grid, likeliest, Read(likeliest, {}), None, [], unread)]
    leaves = _judged(grid, sheets, seeds)
    # the printouts of a page share their mean characters: one misplaced spoils them for all
    if any(leaf.judged.verdict is Verdict.INCOMPLETE for leaf in leaves):
        for leaf in leaves:
            if leaf.judged.verdict is Verdict.DIFFERS:
                leaf.judged.verdict = Verdict.INCOMPLETE
                leaf.judged.reason = "another printout on the page was not read"
    return leaves


def _judged(grid: Grid, sheets: list[Sheet], seeds: Sequence[dict[str, str]]) -> list[Leaf]:
    costs = iter(read_numbers(grid, [sheet for sheet in sheets if sheet.gain > _LEGIBLE]))
    reads = [Read(sheet, next(costs) if sheet.gain > _LEGIBLE else {}) for sheet in sheets]
    found = [scene_of(read, seeds) if read.costs else None for read in reads]
    known = [
        (sheet, read, one) for sheet, read, one in zip(sheets, reads, found, strict=True) if one
    ]
    cells = held(grid, *zip(*known, strict=True)) if known else []
    if _mistaken(cells, [sheet for sheet, *_ in known]):
        cells = held(grid, *zip(*known, strict=True))
    as_shown = [borne_out(one, _shown(cells, which)) for which, (*_, one) in enumerate(known)]
    if any(one is not before for one, (*_, before) in zip(as_shown, known, strict=True)):
        known = [(sheet, read, one) for (sheet, read, _), one in zip(known, as_shown, strict=True)]
        cells = held(grid, *zip(*known, strict=True))
    leaves, left = [], enumerate(known)
    for sheet, read, first in zip(sheets, reads, found, strict=True):
        if first is None:
            unread = Judged(Verdict.INCOMPLETE, reason="no scene was found")
            leaves.append(Leaf(grid, sheet, read, None, [], unread))
            continue
        which, (*_, one) = next(left)
        own = [cell for cell in cells if cell.sheet == which]
        leaves.append(Leaf(grid, sheet, read, one, own, judged(sheet, one, own)))
    return leaves


def _shown(cells: Sequence[Cell], sheet: int) -> dict[str, str]:
    """The inputs of a printout in which a cell differs, as the paper shows them."""
    differing = {cell.name for cell in cells if cell.sheet == sheet and state(cell) == "differs"}
    texts = dict.fromkeys(differing & set(INPUTS), "")
    for cell in cells:
        if cell.sheet == sheet and cell.name in texts:
            texts[cell.name] += cell.other if state(cell) == "differs" else cell.predicted
    return {name: text.strip() for name, text in texts.items()}


def _mistaken(cells: Sequence[Cell], sheets: Sequence[Sheet]) -> bool:
    """Takes from the printouts the lines they may lack whose labels are not what stands there: a
    foot of the page may be as long as a line of the print."""
    found = False
    for which, sheet in enumerate(sheets):
        own = [cell for cell in cells if cell.sheet == which and not cell.name]
        for line in [line for line in MAY_BE_MISSING if line in sheet.rows]:
            row = sheet.rows[line]
            of_line = range(row.start, row.start + row.used)
            labels = [state(c) for c in own if c.place.line in of_line and c.predicted != BLANK]
            if labels.count("holds") < 0.5 * len(labels):
                del sheet.rows[line], sheet.pieces[line]
                found = True
    return found
