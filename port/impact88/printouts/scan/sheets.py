"""A page's picture, from ink to verdict. `read_page` is the entry of this package: it takes the
steps of the other modules in their order."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import product
from typing import NamedTuple

import numpy as np

from ..fields import FIELDS, INPUTS
from ..judging.judgement import Verdict
from ..reading.alignment import MAY_BE_MISSING
from .claims import claims, is_of_a_printout
from .cleaning import Paper
from .grid import Grid, grids_of
from .holding import (
    Added,
    Cell,
    CellJudgement,
    Objection,
    cells_text,
    compare_cells,
    judge_cells,
    state,
)
from .ink import (
    FEWEST_POINTS,
    MIN_SIDE,
    Floats,
    Image,
    Points,
    ink_of,
    points_of,
    without_pen,
)
from .layout import AS_GOOD, Row, Sheet, layout_of
from .residue import Explained, Kind, Mark, residue_of
from .rowsfirst import Order, foreign_row, order_lines
from .scenes import Candidate, Copy, Read, confirm_inputs, scene_of, unread_inputs
from .typeface import BLANK, read_numbers

_LEGIBLE_GAIN = 600.0
"""Gain from which lines are a printout's, the right way up: those of 400 pages that got a verdict
have 740 and more, upside down the best had 410."""
_MIN_CLARITY = 0.7
"""Clarity of the columns from which scenes are searched for: of 1,302 printouts that got a verdict
the smallest was .85."""

MAX_CLAIMING = 2
"""Largest number of typed lines that give numbers of the page other values: more of them belong to
another printout."""
_IDENTICAL = (Verdict.IDENTICAL, Verdict.IDENTICAL_AS_READ)
_FORM = frozenset({0, 1, 10, 14})
"""Lines that only a page of the program's own form has: its prompts and rows of asterisks."""


@dataclass
class Leaf:
    """One printout of a page.

    Attributes
    ----------
    grid : Grid
        The grid that it stands on.
    read : Read
        Its lines and numbers.
    judged : CellJudgement
        The verdict with its reasons.
    found : Candidate, optional
        The scene that was found.
    cells : list of Cell
        Its cells, compared with the program's page for that scene.
    marks : list of Mark
        Marks in and near it that the program's page does not explain.
    exchanged : list of str
        Sentences on rows out of order.
    hurt : list of str
        Sentences on rows printed twice, in another typeface, and cut through.
    cut_lines : set of int
        Lines of the grid that its rows take which are cut through.
    repeated_lines : set of int
        Numbers of the lines on the paper in which a row of it is printed a second time.
    """

    grid: Grid
    read: Read
    judged: CellJudgement
    found: Candidate | None = None
    cells: list[Cell] = field(default_factory=list)
    marks: list[Mark] = field(default_factory=list)
    exchanged: list[str] = field(default_factory=list)
    hurt: list[str] = field(default_factory=list)
    cut_lines: set[int] = field(default_factory=set)
    repeated_lines: set[int] = field(default_factory=set)

    @property
    def by_name(self) -> dict[str, list[Cell]]:
        """Cells of each number and reply, in order."""
        by_name: dict[str, list[Cell]] = {}
        for cell in self.cells:
            if cell.name:
                by_name.setdefault(cell.name, []).append(cell)
        return by_name

    @property
    def certain(self) -> dict[str, str | None]:
        """Numbers by name, None for one with a cell that is not certainly as predicted."""
        return {
            name: "".join(cell.predicted for cell in cells if cell.predicted != BLANK)
            if all(state(cell) == "holds" for cell in cells)
            else None
            for name, cells in self.by_name.items()
            if name in FIELDS
        }

    @cached_property
    def lines(self) -> set[int]:
        """Lines of the grid that it takes."""
        rows = self.read.sheet.rows.values()
        return {line for row in rows for line in row.lines}

    def distance_to(self, corners: Floats) -> float:
        """Return the distance of a region of the sheet from its lines, in pixels."""
        points = np.concatenate([self.grid.corners[line].reshape(-1, 2) for line in self.lines])
        gaps = np.maximum(points.min(axis=0) - corners.max(axis=0), 0)
        gaps += np.maximum(corners.min(axis=0) - points.max(axis=0), 0)
        return float(np.hypot(*gaps))


def read_page(
    paper: Paper, seeds: Sequence[dict[str, str]] = (), copy: Copy | None = None
) -> tuple[list[Leaf], str]:
    """Return all printouts of a page, upright or turned by quarters, each with what else is there,
    and what was tried to find them.

    Parameters
    ----------
    paper : Paper
        The page.
    seeds : sequence of dict
        Scenes that another reader found, tried beside those of the picture.
    copy : Copy, optional
        The program that printed the page, if not the restored listing.
    """
    if min(paper.grey.shape) < MIN_SIDE:
        return [], f"it is less than {MIN_SIDE} pixels wide or high"
    ink = ink_of(paper.grey)
    best = _Layout([], "")
    tried: dict[str, None] = {}
    for layout in _layouts(ink, paper.is_on_side):
        tried[layout.way] = None
        if layout.gain > best.gain:
            best = layout
        if layout.upright:
            break
    leaves = [leaf for on_grid in best.grids for leaf in _judge_with_order(on_grid, seeds, copy)]
    _add_marks(ink, paper.coloured, leaves, copy)
    return leaves, "tried dark type " + ", ".join(tried) if tried else "it has hardly any ink"


_WITHOUT_GRAIN = "all of these without the grain of the paper"


class _OnGrid(NamedTuple):
    """A grid with its printouts; ``order``: what was done to bring its rows into order."""

    grid: Grid
    sheets: list[Sheet]
    order: Order | None


class _Layout(NamedTuple):
    """Grids of a page with the printouts on each; ``way``: how the page was looked at."""

    grids: list[_OnGrid]
    way: str

    @property
    def sheets(self) -> list[Sheet]:
        return [sheet for on_grid in self.grids for sheet in on_grid.sheets]

    @property
    def gain(self) -> float:
        return _gain(self.sheets)

    @property
    def upright(self) -> bool:
        """True if there is a whole printout, the right way up."""
        return any(sheet.whole and sheet.gain > _LEGIBLE_GAIN for sheet in self.sheets)


def _layouts(ink: Image, is_on_side: bool) -> Iterator[_Layout]:
    """Yield the layouts of a page that are tried one after the other.

    They are: as it lies, without strokes of a pen, turned by quarters, and then all of these with
    pixels averaged two by two, which removes the grain of bad paper.
    """
    order = [1, 3, 0, 2] if is_on_side else [0, 2, 1, 3]
    right_turn: int | None = None  # a turn in which so much is read that it is the right one
    for fold, turns in product((1, 2), order):
        if turns == order[0]:
            points = points_of(ink, fold)
            if len(points.x) < FEWEST_POINTS:
                return
        if right_turn not in (None, turns):
            continue
        way = f"turned by {90 * turns} degrees" if turns else "as it lies"
        layout = _lay_out(ink, points, turns, way if fold == 1 else _WITHOUT_GRAIN)
        yield layout
        if any(sheet.gain > _LEGIBLE_GAIN for sheet in layout.sheets):
            right_turn = turns
        if (fold, turns) == (1, order[0]) and layout.grids:
            plain = points_of(without_pen(ink, layout.grids[0].grid.pitch, turns))
            if len(plain.x) >= FEWEST_POINTS:
                yield _lay_out(ink, plain, turns, "without strokes of a pen")


def _lay_out(ink: Image, points: Points, turns: int, way: str) -> _Layout:
    """Return the printouts of a page after quarter ``turns`` to the left."""
    return _Layout([_lay_on_grid(grid) for grid in grids_of(ink, points, turns)], way)


def _lay_on_grid(grid: Grid) -> _OnGrid:
    """Return the printouts of a grid, its rows in the program's order."""
    layout = layout_of(grid.odds(), grid.tops)
    gain = _gain(layout.sheets)
    if (
        gain > _LEGIBLE_GAIN
        and grid.clarity >= _MIN_CLARITY
        and (order := order_lines(grid, layout))
    ):
        in_order = layout_of(order.grid.odds(), order.grid.tops)
        # rows that were exchanged fit at least as well where the program prints them
        if not order.exchanged or _gain(in_order.sheets) > gain - AS_GOOD:
            return _OnGrid(order.grid, in_order.sheets, order)
    return _OnGrid(grid, layout.sheets, None)


def _gain(sheets: Sequence[Sheet]) -> float:
    return sum(sheet.gain for sheet in sheets)


def _judge_with_order(
    on_grid: _OnGrid, seeds: Sequence[dict[str, str]], copy: Copy | None
) -> list[Leaf]:
    """Return the printouts of a grid with their verdicts, and what the order of their rows says.

    A page of the program's form whose rows are out of order differs; one without prompts and rows
    of asterisks was retyped, in an order of its own.
    """
    leaves = _judge_printouts(on_grid.grid, on_grid.sheets, seeds, copy)
    if not on_grid.order or not leaves:
        return leaves
    for is_exchange, sentences in (
        (False, on_grid.order.repeated),
        (True, on_grid.order.exchanged),
    ):
        for number, sentence in sentences:
            owners = [
                leaf for leaf in leaves if min(map(on_grid.grid.number, leaf.lines)) <= number
            ]
            leaf = (owners or leaves[:1])[-1]
            if is_exchange and not leaf.judged.legible:
                continue  # its rows were named by other things than their letters
            (leaf.exchanged if is_exchange else leaf.hurt).append(sentence)
            leaf.repeated_lines |= set() if is_exchange else {number}
            is_program = is_exchange and not _FORM.isdisjoint(leaf.read.sheet.rows)
            leaf.judged.overrule(Objection.OTHERWISE if is_program else Objection.MORE)
    return leaves


def _add_marks(
    ink: Image, coloured: Image | None, leaves: Sequence[Leaf], copy: Copy | None
) -> None:
    """Add what the printouts of a page do not explain to ``marks`` of the nearest one."""
    if not any(leaf.cells and leaf.judged.legible for leaf in leaves):
        return
    turns = leaves[0].grid.turns
    grids = {id(leaf.grid): leaf.grid for leaf in leaves}
    explained = []
    for key, grid in grids.items():
        on_grid = [leaf for leaf in leaves if id(leaf.grid) == key]
        cells = [cell for leaf in on_grid for cell in leaf.cells]
        lines = {line for leaf in on_grid for line in leaf.lines}
        cut_lines = {line for leaf in on_grid for line in leaf.cut_lines}
        explained.append(Explained(grid, cells, lines, cut_lines))
    upright = None if coloured is None else np.rot90(coloured, turns)
    for mark in residue_of(np.rot90(ink, turns), upright, explained):
        leaf = min(leaves, key=lambda leaf: leaf.distance_to(mark.corners))
        scene = leaf.found.scene if leaf.found else {}
        if copy and mark.kind is Kind.TYPE and copy.prints(mark.sure, scene):
            continue  # a line that only the copy prints
        leaf.marks.append(mark)
        if mark.bears:
            leaf.judged.overrule(Objection.MORE)
    _find_claims(leaves)


def _repeats(leaf: Leaf, mark: Mark) -> bool:
    """Return True for the type of a row that is printed a second time."""
    return mark.place is not None and leaf.grid.number(mark.place.line) in leaf.repeated_lines


def _find_claims(leaves: Sequence[Leaf]) -> None:
    """Set ``claims`` of typed lines that give a number of the page another value.

    A printout that was identical but for such a line differs. Nothing is set where the sheet has
    lines of another printout of which the rest is missing or was not read: the text may be its. A
    row printed a second time is none of these.
    """
    if any(leaf.judged.verdict not in _IDENTICAL for leaf in leaves):
        return
    lines = [(leaf, mark) for leaf in leaves for mark in leaf.marks if mark.kind is Kind.TYPE]
    if any(is_of_a_printout(mark.reads) for leaf, mark in lines if not _repeats(leaf, mark)):
        return
    numbers = [leaf.certain for leaf in leaves]
    contradictions = [
        (leaf, mark, [*claims(mark.reads, numbers, mark.sure)]) for leaf, mark in lines
    ]
    contradictions = [entry for entry in contradictions if entry[2]]
    if len(contradictions) > MAX_CLAIMING:
        return
    for leaf, mark, contradicted in contradictions:
        mark.claims = contradicted
        leaf.judged.overrule(Objection.OTHERWISE)


_NEXT_STEP = "expected a straight scan at 200 to 300 dpi, or the page typed in as text"


def _judge_printouts(
    grid: Grid, sheets: list[Sheet], seeds: Sequence[dict[str, str]], copy: Copy | None = None
) -> list[Leaf]:
    """Return the printouts of a grid with their verdicts: first their rows and numbers, then their
    scenes, their cells, and what the cells give.

    What is said of the rows and of the other printouts overrules that, see `Objection`.
    """
    if sheets and grid.clarity < _MIN_CLARITY:
        likeliest = max(sheets, key=lambda sheet: sheet.gain)
        unread = CellJudgement(
            Verdict.INCOMPLETE, reason=f"its type stands in no clear columns; {_NEXT_STEP}"
        )
        return [Leaf(grid, Read(likeliest, {}), unread)]
    reason = f"too little of it is like the program's lines; {_NEXT_STEP}"
    unread = CellJudgement(Verdict.INCOMPLETE, reason=reason)
    leaves = [Leaf(grid, Read(sheet, {}), unread) for sheet in sheets]
    legible = [leaf for leaf in leaves if leaf.read.sheet.gain > _LEGIBLE_GAIN]
    foreign = _read_rows(grid, leaves, legible)
    for leaf in legible:
        leaf.found = scene_of(leaf.read, seeds, copy)
        if not leaf.found:
            leaf.judged = CellJudgement(Verdict.INCOMPLETE, reason=_reason_unread(leaf))
    with_scene = [leaf for leaf in legible if leaf.found]
    _set_cells(grid, with_scene)
    for correct in (_drop_wrong_lines, partial(_confirm_scene, copy=copy)):
        if sum(map(correct, with_scene)):
            _set_cells(grid, with_scene)
    for leaf in with_scene:
        _judge(leaf)
    for leaf in legible:
        if foreign and foreign in leaf.read.sheet.rows.values():
            _name_foreign_row(leaf, foreign)
    # the printouts of a page share their mean characters: one misplaced spoils them for all
    if any(leaf.judged.verdict is Verdict.INCOMPLETE for leaf in leaves):
        for leaf in leaves:
            leaf.judged.overrule(Objection.MISREAD, "another printout on the page was not read")
    return leaves


def _reason_unread(leaf: Leaf) -> str:
    """Return why no scene was found: of one input that was not read its row may be altered."""
    names = unread_inputs(leaf.read)
    if not names:
        return f"no scene was found; {_NEXT_STEP}"
    if len(names) > 1:
        are_missing = leaf.read.costs.keys().isdisjoint(names)
        problem = "were not found" if are_missing else "could not be read"
        return f"{', '.join(names)} {problem}; {_NEXT_STEP}"
    for row in leaf.read.sheet.rows.values():
        row_names = [piece.name for piece in row.pieces if piece.name]
        if names[0] in row_names:
            return (
                f"{_row_name(leaf.grid, row, row_names)} has no number for {names[0]}: look there "
                "for a character that is erased or altered, or type the page in as text"
            )
    return f"the row of {names[0]} was not found; {_NEXT_STEP}"


def _read_rows(grid: Grid, leaves: Sequence[Leaf], legible: Sequence[Leaf]) -> Row | None:
    """Read the numbers of the legible printouts; return the row in another typeface, if any.

    Rows that an edge of the page cuts through are removed before, and one that only looks like
    another typeface for it after.
    """
    for leaf in leaves:
        for row in [*leaf.read.sheet.rows.values()]:
            if not grid.cut.isdisjoint(row.lines):
                _drop_cut_row(leaf, row)
    costs = read_numbers(grid, [leaf.read.sheet for leaf in legible])
    for leaf, number_costs in zip(legible, costs, strict=True):
        leaf.read.costs = number_costs
    foreign = foreign_row(grid, [leaf.read for leaf in legible])
    if foreign and grid.is_at_edge(foreign.start):
        for leaf in legible:
            _drop_cut_row(leaf, foreign)
    return foreign


def _drop_cut_row(leaf: Leaf, row: Row) -> None:
    """Remove a row that an edge of the page cuts through, if it is the printout's, and say so: half
    a character is like others."""
    rows = leaf.read.sheet.rows
    names = [piece.name for piece in row.pieces if piece.name]
    if row not in rows.values():
        return
    leaf.read.sheet.rows = {line: other for line, other in rows.items() if other is not row}
    leaf.read.absent.update(names)
    leaf.cut_lines.update(row.lines)
    for name in names:
        leaf.read.costs.pop(name, None)
    if names:
        leaf.hurt.append(
            f"{_row_name(leaf.grid, row, names)} is cut through by the edge of the page: "
            "it was not read"
        )


def _name_foreign_row(leaf: Leaf, row: Row) -> None:
    """Say that a row is in another typeface than the page: a character of it may be like another
    one of the page, so that the page does not differ where it does in that row alone."""
    names = [piece.name for piece in row.pieces if piece.name]
    name = _row_name(leaf.grid, row, names)
    leaf.hurt.append(f"{name} is in another typeface than the rest of the page")
    leaf.judged.overrule(Objection.MORE)
    if all(cell.place.line in row.lines for cell in leaf.judged.differing):
        reason = "what differs is in another typeface, and may be another character there"
        leaf.judged.overrule(Objection.MISREAD, reason)


def _row_name(grid: Grid, row: Row, names: Sequence[str]) -> str:
    return f"line {grid.number(row.start)}, the row of {names[0]},"


def _set_cells(grid: Grid, leaves: Sequence[Leaf]) -> None:
    """Set the cells of all printouts, compared with the pages of their scenes."""
    cells = compare_cells(grid, [(leaf.read, leaf.found) for leaf in leaves if leaf.found])
    for leaf, leaf_cells in zip(leaves, cells, strict=True):
        leaf.cells = leaf_cells


def _confirm_scene(leaf: Leaf, copy: Copy | None) -> bool:
    """Set inputs that no result depends on as the paper shows them; return True if any changes."""
    assert leaf.found
    differing = {cell.name for cell in leaf.cells if state(cell) == "differs"} & set(INPUTS)
    on_paper = {name: cells_text(leaf.by_name[name]).strip() for name in differing}
    confirmed = confirm_inputs(leaf.found, on_paper, copy)
    has_changed = confirmed is not leaf.found
    leaf.found = confirmed
    return has_changed


def _judge(leaf: Leaf) -> None:
    """Set the verdict that a printout's cells give.

    The cost of first readings that was due to lines divided at a wrong place does not count: a
    character added in the blank after a number shifts the division of its line. It is that of the
    numbers on such lines all of whose cells hold now.
    """
    assert leaf.found
    changed_lines = {cell.place.line for cell in leaf.cells if cell.added is Added.CHARACTER}
    cost = leaf.found.cost
    for name, cells in leaf.by_name.items():
        inked = [cell for cell in cells if cell.predicted != BLANK]
        is_beside = any(cell.place.line in changed_lines for cell in inked)
        is_excluded = name.startswith("REPLY") or name not in leaf.read.costs
        if is_beside and not is_excluded and all(state(cell) == "holds" for cell in inked):
            cost -= leaf.read.cost(name, leaf.found.outcome.fields.get(name))
    leaf.judged = judge_cells(leaf.read.sheet, leaf.found._replace(cost=cost), leaf.cells)


def _drop_wrong_lines(leaf: Leaf) -> bool:
    """Remove optional lines whose labels are not on the paper; return True if there were any.

    A footer of the page may be as long as such a line.
    """
    has_changed, sheet = False, leaf.read.sheet
    for line in [line for line in MAY_BE_MISSING if line in sheet.rows]:
        row = sheet.rows[line]
        states = [
            state(cell)
            for cell in leaf.cells
            if not cell.name and cell.predicted != BLANK
            if cell.place.line in row.lines
        ]
        if states.count("holds") < 0.5 * len(states):
            del sheet.rows[line]
            has_changed = True
    return has_changed
