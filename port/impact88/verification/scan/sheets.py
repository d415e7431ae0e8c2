"""A page's picture from ink to verdict."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import product
from typing import NamedTuple

import numpy as np

from ...collision.fields import FIELDS, INPUTS
from ..judging.judgement import Verdict
from ..reading.alignment import MAY_BE_MISSING
from .claims import claims, is_of_a_printout
from .grid import FEWEST_POINTS, Grid, grids_of
from .holding import Added, Cell, Judged, compare_cells, judge, state
from .ink import Floats, Image, Points, ink_of, points_of, without_pen
from .layout import Sheet, sheets_of
from .residue import Explained, Kind, Mark, Residue, residue_of
from .scenes import Candidate, Copy, Read, borne_out, scene_of
from .typeface import BLANK, read_numbers

_UPRIGHT = 600.0
"""Gain of a printout that is found the right way up: those of 445 pages have 740 and more, upside
down the best had 410."""
_LEGIBLE = 300.0
"""Gain from which a scene is searched for; with less, noise was taken for lines."""
_REGULAR = 0.7
"""Clarity of the columns from which printouts are told apart and scenes searched for: of 1,302
printouts that got a verdict the least had .85."""

MOST_CLAIMING = 2
"""Typed lines that give numbers of the page other values, at most: more are another printout's."""
_SETTLED = (Verdict.IDENTICAL, Verdict.IDENTICAL_AS_READ)
_LEAST_SIDE = 100
"""Pixels of the shorter side of a picture that is looked at; 13 lines of 5 pixels have as many."""


@dataclass
class Leaf:
    """One printout of a page: the grid it stands on, what was read and where, the verdict, the
    scene found, its cells held against the program's page, and the marks in and near it that the
    program's page does not explain."""

    grid: Grid
    read: Read
    judged: Judged
    found: Candidate | None = None
    cells: list[Cell] = field(default_factory=list)
    marks: list[Mark] = field(default_factory=list)

    @cached_property
    def by_name(self) -> dict[str, list[Cell]]:
        """The cells of each number and reply, in order."""
        by_name: dict[str, list[Cell]] = {}
        for cell in self.cells:
            if cell.name:
                by_name.setdefault(cell.name, []).append(cell)
        return by_name

    @property
    def certain(self) -> dict[str, str | None]:
        """The numbers, None of one with a cell that is not certainly what the program prints."""
        return {
            name: "".join(cell.predicted for cell in cells if cell.predicted != BLANK)
            if all(state(cell) == "holds" for cell in cells)
            else None
            for name, cells in self.by_name.items()
            if name in FIELDS
        }

    @cached_property
    def lines(self) -> set[int]:
        """The lines of the grid that it takes."""
        rows = self.read.sheet.rows.values()
        return {line for row in rows for line in range(row.start, row.start + row.used)}

    def apart(self, corners: Floats) -> float:
        """How far a region of the sheet is from its lines, in pixels."""
        own = np.concatenate([self.grid.corners[line].reshape(-1, 2) for line in self.lines])
        gaps = np.maximum(own.min(axis=0) - corners.max(axis=0), 0)
        gaps += np.maximum(corners.min(axis=0) - own.max(axis=0), 0)
        return float(np.hypot(*gaps))


@dataclass
class Looked:
    """A sheet that was looked at: its printouts, and what else is on it."""

    leaves: list[Leaf] = field(default_factory=list)
    residue: Residue = field(default_factory=Residue)


def looked(
    grey: Image,
    seeds: Sequence[dict[str, str]] = (),
    coloured: Image | None = None,
    copy: Copy | None = None,
) -> Looked:
    """All printouts of a page, upright or turned by quarters, and all else that is on it.
    ``seeds``: scenes that another reader found; they are tried beside those of the picture;
    ``coloured``: ink that is not in ``grey``; ``copy``: what prints the pages, in place of the
    restored listing."""
    if min(grey.shape) < _LEAST_SIDE:
        return Looked()
    ink = ink_of(grey)
    best = _Laid([])
    for laid in _tried(ink):
        if laid.gain > best.gain:
            best = laid
        if laid.upright:
            break
    leaves = [leaf for pair in best.grids for leaf in _leaves(*pair, seeds, copy)]
    return Looked(leaves, _rest(ink, coloured, leaves, copy))


class _Laid(NamedTuple):
    """Grids of a page, and the printouts on each."""

    grids: list[tuple[Grid, list[Sheet]]]

    @property
    def gain(self) -> float:
        return sum(sheet.gain for _, sheets in self.grids for sheet in sheets)

    @property
    def upright(self) -> bool:
        """Whether a whole printout is there, the right way up."""
        sheets = [sheet for _, some in self.grids for sheet in some]
        return any(sheet.whole and sheet.gain > _UPRIGHT for sheet in sheets)


def _tried(ink: Image) -> Iterator[_Laid]:
    """Yield what is on a page as it is looked at in one way after the other: as it lies, without
    what pen joins, turned, and with the grain of bad paper taken together."""
    order = _turns(ink)
    certain: int | None = None  # a turn in which so much is read that it is the right one
    for fold, turns in product((1, 2), order):
        if turns == order[0]:
            points = points_of(ink, fold)
            if len(points.x) < FEWEST_POINTS:
                return
        if certain not in (None, turns):
            continue
        laid = _laid(ink, points, turns)
        yield laid
        if any(sheet.gain > _UPRIGHT for _, sheets in laid.grids for sheet in sheets):
            certain = turns
        if (fold, turns) == (1, order[0]) and laid.grids:
            plain = points_of(without_pen(ink, laid.grids[0][0].pitch, turns))
            if len(plain.x) >= FEWEST_POINTS:
                yield _laid(ink, plain, turns)


def _laid(ink: Image, points: Points, turns: int) -> _Laid:
    """Return the printouts of a page turned by quarters to the left."""
    grids = grids_of(ink, points, turns)
    return _Laid([(grid, sheets_of(grid.odds(), grid.tops)) for grid in grids])


def _rest(ink: Image, coloured: Image | None, leaves: Sequence[Leaf], copy: Copy | None) -> Residue:
    """What the printouts of a page do not explain; each mark is put down to one of them, too."""
    if not any(leaf.cells for leaf in leaves):
        return Residue()
    turns = leaves[0].grid.turns
    grids = {id(leaf.grid): leaf.grid for leaf in leaves}
    explained = []
    for key, grid in grids.items():
        own = [leaf for leaf in leaves if id(leaf.grid) == key]
        cells = [cell for leaf in own for cell in leaf.cells]
        explained.append(Explained(grid, cells, {line for leaf in own for line in leaf.lines}))
    upright = None if coloured is None else np.rot90(coloured, turns)
    residue = residue_of(np.rot90(ink, turns), upright, explained)
    for mark in residue.marks:
        leaf = min(leaves, key=lambda leaf: leaf.apart(mark.corners))
        scene = leaf.found.scene if leaf.found else {}
        if copy and mark.kind is Kind.TYPE and copy.prints(mark.sure, scene):
            continue  # a line that only the copy prints
        leaf.marks.append(mark)
        if mark.bears and leaf.judged.verdict is Verdict.IDENTICAL:
            leaf.judged.verdict = Verdict.IDENTICAL_AS_READ
    _contradict(leaves)
    return residue


def _contradict(leaves: Sequence[Leaf]) -> None:
    """Say which typed lines give a number of the page another value; a printout whose page was
    settled but for such a line differs. Where the sheet has lines of another printout, of which the
    rest is not there or was not read, none of its text is about the page's own."""
    if any(leaf.judged.verdict not in _SETTLED for leaf in leaves):
        return
    typed = [(leaf, mark) for leaf in leaves for mark in leaf.marks if mark.kind is Kind.TYPE]
    if any(is_of_a_printout(mark.reads) for _, mark in typed):
        return
    shown = [leaf.certain for leaf in leaves]
    said = [(leaf, mark, [*claims(mark.reads, shown, mark.sure)]) for leaf, mark in typed]
    said = [each for each in said if each[2]]
    if len(said) > MOST_CLAIMING:
        return
    for leaf, mark, found in said:
        mark.claims = found
        leaf.judged.verdict = Verdict.DIFFERS


def _turns(ink: Image) -> list[int]:
    """Quarter turns in the order in which they are tried: as the page lies, upside down, and on
    its sides; lines of text make rows of ink and gaps, seen from the right side."""
    small = ink[::4, ::4]
    steps = (np.abs(np.diff(small.mean(axis=axis))) for axis in (0, 1))
    across, down = (float(np.percentile(step, 95)) for step in steps)  # beyond edges of the paper
    return [0, 2, 1, 3] if down >= across else [1, 3, 0, 2]


def _leaves(
    grid: Grid, sheets: list[Sheet], seeds: Sequence[dict[str, str]], copy: Copy | None = None
) -> list[Leaf]:
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
        leaf.found = scene_of(leaf.read, seeds, copy)
    known = [leaf for leaf in legible if leaf.found]
    _hold(grid, known)
    if sum(map(_mistaken, known)):
        _hold(grid, known)
    before = [leaf.found for leaf in known]
    for leaf in known:
        leaf.found = leaf.found and borne_out(leaf.found, _shown(leaf.cells), copy)
    if any(leaf.found is not earlier for leaf, earlier in zip(known, before, strict=True)):
        _hold(grid, known)
    for leaf in known:
        if leaf.found:
            found = leaf.found
            if wrongly := _divided_wrongly(leaf):
                found = found._replace(cost=found.cost - wrongly)
            leaf.judged = judge(leaf.read.sheet, found, leaf.cells)
    # the printouts of a page share their mean characters: one misplaced spoils them for all
    if any(leaf.judged.verdict is Verdict.INCOMPLETE for leaf in leaves):
        for leaf in leaves:
            if leaf.judged.verdict is Verdict.DIFFERS:
                leaf.judged.verdict = Verdict.INCOMPLETE
                leaf.judged.reason = "another printout on the page was not read"
    return leaves


def _hold(grid: Grid, known: Sequence[Leaf]) -> None:
    """Holds the cells of all printouts against the pages of their scenes."""
    cells = compare_cells(grid, [(leaf.read, leaf.found) for leaf in known if leaf.found])
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


def _divided_wrongly(leaf: Leaf) -> float:
    """What the first reading cost numbers that hold, on lines to which a character was added: where
    it fills the blank after a number the line is divided elsewhere."""
    assert leaf.found
    added = {cell.place.line for cell in leaf.cells if cell.added is Added.CHARACTER}
    cost = 0.0
    for name, cells in leaf.by_name.items():
        printed = [cell for cell in cells if cell.predicted != BLANK]
        beside = any(cell.place.line in added for cell in printed)
        reply = name.startswith("REPLY") or name not in leaf.read.costs
        if beside and not reply and all(state(cell) == "holds" for cell in printed):
            cost += leaf.read.cost(name, leaf.found.outcome.fields.get(name))
    return cost


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
