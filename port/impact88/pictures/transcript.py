"""The text of a page: what is in every cell, read by the page's own typeface.

Labels are known text in known rows, so they name the page's letters. Figures get first names by
likeness to known typefaces. The text that results gives, through `printouts.judge`, a scene and the
page that the program prints for it; each cell is then measured against the mean of its predicted
character and of all others.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..printouts import Verification, judge
from ..printouts.glyphs import SCREEN_WIDTHS
from ..printouts.page import NAMES, REPLIES, PrintedChar, print_page
from .align import BESIDE, IRREGULAR_COST, NUMBER, OPTIONAL, REPLY, align, costs_of
from .cells import (
    BLANK,
    CHARACTERS,
    NUMERIC,
    Cells,
    cells_of,
    name_groups,
    pair_distances,
    typeface_of,
    unlikeness,
)
from .grid import CELL_WIDTH, Grid
from .picture import Floats

HOLDS = -0.1  # measure of a cell below which it is the predicted character
DIFFERS = 0.35  # measure above which it is another
MAX_FOREIGN = 8.0  # distance of a cell from its character's mean, in the page's usual distances
MIN_MEMBERS = 3  # cells of which a mean is made that a cell is found to be like
MIN_DENSITY = 0.7  # gain of a row for each of its inked cells: a line of other text has 0.4
UNREAD = "?"
IN_NUMBERS = NUMERIC + "E+"


class Cell(NamedTuple):
    """A predicted cell, measured.

    Parameters
    ----------
    line, cell : int
        Its place on the grid.
    predicted : str
        The character that the program prints.
    name : str
        The number to which it belongs, "" for labels.
    other : str
        The character that it is most like instead.
    margin : float
        -1 for the mean of the predicted character, 1 for that of the other.
    distance : float
        Distance from the predicted character's mean, in the page's usual distances.
    members, other_members : int
        Cells of which the two means were made.
    """

    line: int
    cell: int
    predicted: str
    name: str
    other: str
    margin: float
    distance: float
    members: int
    other_members: int

    @property
    def state(self) -> str:
        """``holds``, ``differs`` or ``doubt``.

        A cell without ink never differs: dropped ink looks like erasure. Nor does a bracket after
        a number that is there once or twice: what is unlike may be the mean.
        """
        if self.margin < (DIFFERS if self.predicted == BLANK else HOLDS):
            return "holds" if self.distance < MAX_FOREIGN else "doubt"
        is_known = self.other != BLANK and self.other_members >= MIN_MEMBERS
        if self.name and self.predicted not in IN_NUMBERS:
            is_known &= self.members >= MIN_MEMBERS
        return "differs" if self.margin > DIFFERS and is_known else "doubt"


@dataclass
class Transcript:
    """The text of a page with its cells.

    Parameters
    ----------
    grid : Grid
        Its grid.
    text : str
        A line for each line of the grid, or for lines that a narrow screen broke; a character for
        each cell. `UNREAD` is what was not read.
    places : ndarray
        The index of each character's cell, line by line; that of the cell before for a newline.
    cells : list of Cell
        The predicted cells.
    gain : float
        How well the program's rows explain the page, for each cell with type.
    sheets : list of Verification
        The printouts by which cells were predicted.
    """

    grid: Grid
    text: str = ""
    places: NDArray[np.intp] = field(default_factory=lambda: np.zeros(1, int))
    cells: list[Cell] = field(default_factory=list)
    gain: float = 0.0
    sheets: list[Verification] = field(default_factory=list)

    def count_held(self) -> int:
        """Return the number of cells that hold what is predicted."""
        return sum(cell.state == "holds" for cell in self.cells)

    def line_cell(self, offset: int) -> tuple[int, int]:
        """Return line and cell of an offset of the text."""
        place = self.places[min(offset, len(self.places) - 1)]
        return divmod(int(place), self.grid.count)

    def filled_cells(self) -> NDArray[np.bool_]:
        """Return which cells hold type, shape (lines, cells)."""
        filled = np.zeros(len(self.grid.middles) * self.grid.count, bool)
        is_type = np.array([char not in " \n" for char in self.text + "\n"])
        filled[self.places[is_type]] = True
        return filled.reshape(-1, self.grid.count)


def transcribe(grid: Grid, given: Mapping[str, str] | None = None) -> Transcript:
    """Return the transcript of a page.

    Parameters
    ----------
    grid : Grid
        Its cells.
    given : mapping of str to str, optional
        Inputs known from elsewhere, for a page with results only.
    """
    fields = dict.fromkeys(NAMES, NUMBER)
    templates = [*map(_row_text, _rows_of(print_page(fields, dict.fromkeys(REPLIES, REPLY))))]
    reader = Reader(grid, cells_of(grid))
    rows = reader.place_rows(templates)
    gain = sum(placed.gain for placed in rows) / max(1, int(reader.inked.sum()))
    if not reader.name_labels(rows):
        return Transcript(grid, gain=gain)
    reader.register_lines()
    reader.name_numbers()
    before, changes = len(reader.names), reader.read()
    while 0 < changes < before:
        before, changes = changes, reader.read()
    grid = reader.grid
    best = Transcript(grid, reader.text(reader.names), reader.places(), gain=gain)
    while True:
        sheets = judge(best.text, given)
        if not reader.predict(sheets):
            return replace(best, sheets=sheets)
        cells = reader.measure()
        text = reader.final_text(cells)
        transcript = Transcript(grid, text, reader.places(), cells, gain, sheets)
        if transcript.count_held() <= best.count_held():
            return best
        best = transcript


class Placement(NamedTuple):
    """A row of type on the page.

    Parameters
    ----------
    row : int
        Its index.
    gain : float
        By how much it explains its line better than nothing does.
    cells : ndarray
        Indices of the line's cells.
    states : list of str
        What each holds (`align.Alignment`).
    sources : ndarray
        Index of each in the row's text, -1 beside it.
    """

    row: int
    gain: float
    cells: NDArray[np.intp]
    states: list[str]
    sources: NDArray[np.intp]


class Reader:
    """The names of a page's cells while it is read.

    Parameters
    ----------
    grid : Grid
        The cells' places.
    cells : Cells
        All cells, line by line.
    """

    def __init__(self, grid: Grid, cells: Cells) -> None:
        self.grid = grid
        self.cells = cells
        self.shape = (len(grid.middles), grid.count)
        self.inked = cells.odds > 0
        self.unlike = np.ones((len(cells.odds), len(CHARACTERS)))
        if self.inked.any():
            self.unlike[self.inked] = unlikeness(cells.at(np.flatnonzero(self.inked)))
        self.names = np.full(len(cells.odds), BLANK, dtype="<U1")
        self.is_label = np.zeros(len(cells.odds), bool)
        self.is_number = np.zeros(len(cells.odds), bool)
        self.predicted = np.full(len(cells.odds), "", dtype="<U1")
        self.fields = np.full(len(cells.odds), "", dtype="<U8")
        self.units = _units(self.inked.reshape(self.shape))
        self.layout = [*np.arange(len(cells.odds)).reshape(self.shape)]

    def place_rows(
        self, texts: Sequence[str], ends: Sequence[tuple[int, int]] = ()
    ) -> list[Placement]:
        """Return where rows are on the page, each line taken once.

        Parameters
        ----------
        texts : sequence of str
            The rows (`align.align`).
        ends : sequence of (int, int), optional
            First and last line of the printout of each row.
        """
        wide = max(map(len, self.units))
        flat = np.array(
            [np.pad(unit, (0, wide - len(unit)), constant_values=-1) for unit in self.units]
        )
        odds = np.where(flat < 0, -6.0, self.cells.odds[flat])
        unlike = np.where(flat[:, :, None] < 0, 1.0, self.unlike[flat])
        costs = costs_of(odds, unlike)
        rows = align(costs, texts)
        gains = rows.gains.copy()
        lines = [{*np.unique(unit // self.shape[1]).tolist()} for unit in self.units]
        first = np.array([min(part) for part in lines])
        last = np.array([max(part) for part in lines])
        for row, (start, stop) in enumerate(ends):
            gains[(first < start) | (last > stop), row] = -np.inf
        gains[gains < IRREGULAR_COST] = -np.inf
        placements: list[Placement] = []
        for unit, row in _best_units(gains, first, last):
            part = align({name: cost[[unit]] for name, cost in costs.items()}, [texts[row]])
            inside = flat[unit] >= 0
            path = part.paths[0, inside]
            states = [part.states[state] for state in path]
            cells = flat[unit][inside]
            gain = float(gains[unit, row])
            is_row = self.inked[cells] & np.array([state != BESIDE for state in states])
            if gain > MIN_DENSITY * is_row.sum():
                placements.append(Placement(row, gain, cells, states, part.sources[path]))
        return placements

    def name_labels(self, placements: Sequence[Placement]) -> bool:
        """Name the cells of labels, and mark those of numbers. Return False without any."""
        joined = [placed.cells for placed in placements if len(placed.cells) > self.shape[1]]
        is_joined = np.zeros(self.shape[0], bool)
        is_joined[
            [cell // self.shape[1] for unit in joined for cell in unit[:: SCREEN_WIDTHS[0]]]
        ] = True
        lines = [unit for unit, taken in zip(self.layout, is_joined, strict=True) if not taken]
        self.layout = sorted([*lines, *joined], key=lambda unit: int(unit[0]))
        for placed in placements:
            states = np.array(placed.states)
            is_wild = (states == NUMBER) | (states == REPLY)
            is_label = ~is_wild & ~np.isin(states, [BESIDE, BLANK, OPTIONAL])
            self.is_number[placed.cells] |= is_wild & self.inked[placed.cells]
            self.is_label[placed.cells] |= is_label & self.inked[placed.cells]
            chosen = placed.cells[is_label & self.inked[placed.cells]]
            self.names[chosen] = states[is_label & self.inked[placed.cells]]
        return bool(self.is_label.any())

    def register_lines(self) -> None:
        """Move each line of the grid onto the means of the page's labels."""
        chosen = np.flatnonzero(self.is_label)
        face = typeface_of(self.cells.at(chosen), self.names[chosen].tolist())
        lines, columns = np.divmod(chosen, self.shape[1])
        unit = self.grid.pitch / CELL_WIDTH
        own = np.zeros((self.shape[0], 4))
        is_sure = face.counts[face.owners] >= MIN_MEMBERS
        for line in range(self.shape[0]):
            at = (lines == line) & is_sure
            if at.sum() < 3:
                continue
            for part, off in ((0, face.shifts[at, 1]), (2, face.shifts[at, 0])):
                rise, level = 0.0, float(off.mean())
                if np.ptp(columns[at]) > 20:
                    rise, level = np.polyfit(columns[at], off, 1)
                own[line, part : part + 2] = unit * level, unit * rise
        self.grid = self.grid.move_lines(own)
        self.cells = cells_of(self.grid)
        self.inked = self.cells.odds > 0

    def name_numbers(self) -> None:
        """Give the cells of numbers their first names."""
        numbers, labels = np.flatnonzero(self.is_number), np.flatnonzero(self.is_label)
        if not len(numbers):
            return
        letters = self.names[labels]
        is_same = np.triu(letters[:, None] == letters, 1)
        apart = pair_distances(self.cells.at(labels))[is_same]
        usual = float(np.median(apart)) if len(apart) else 0.0
        sample = self.cells.at(numbers)
        self.names[numbers] = name_groups(sample, self.unlike[numbers, : len(NUMERIC)], usual)

    def read(self) -> int:
        """Read each inked cell but labels by the means of the names. Return how many change."""
        names = self.names
        inked = np.flatnonzero(self.inked)
        sample = self.cells.at(inked)
        face = typeface_of(sample, names[inked].tolist())
        to = face.distances(sample)
        usual = face.usual_distance(to)
        to[:, face.counts < MIN_MEMBERS] *= 4  # what was read once or twice may be misread
        is_numeric = np.array([name in IN_NUMBERS + "," for name in face.names])
        in_numbers = np.where(is_numeric, to, np.inf)
        for name, distance in zip(face.names, to.T, strict=True):
            if name in CHARACTERS:
                off = distance / face.energy[face.names.index(name)]
                self.unlike[inked, CHARACTERS.index(name)] = np.minimum(off / 2, 1.0)
        to = np.where(self.is_number[inked][:, None], in_numbers, to)
        best = to.argmin(axis=1)
        nearest = np.array([*face.names])[best]
        is_type = to.min(axis=1) < MAX_FOREIGN * usual * face.energy[best]
        steps = to - to.min(axis=1)[:, None]
        steps[np.arange(len(best)), best] = np.inf
        is_clear = (steps / face.between()[best, :-1]).min(axis=1) > DIFFERS
        self.names = np.full(len(names), BLANK, dtype="<U1")
        self.names[inked] = np.where(is_type | self.is_number[inked], nearest, BLANK)
        self.names[self.is_label] = names[self.is_label]
        self.is_clear = np.zeros(len(names), bool)
        self.is_clear[inked] = is_clear & is_type
        # type in lines that are not the program's comes in words, specks do not
        lines = np.arange(len(names)) // self.shape[1]
        is_beside = (self.names != BLANK) & ~self.is_number & ~self.is_label
        crowd = np.bincount(lines[is_beside & self.is_clear], minlength=self.shape[0])
        self.names[is_beside & (crowd[lines] < MIN_MEMBERS)] = BLANK
        return int((self.names != names).sum())

    def text(self, names: NDArray[np.str_]) -> str:
        """Return names as text, lines that a screen broke in one."""
        return "\n".join("".join(names[unit]) for unit in self.layout)

    def places(self) -> NDArray[np.intp]:
        """Return the index of the cell of each character of `text`."""
        return np.concatenate([np.append(unit, unit[-1]) for unit in self.layout])

    def predict(self, sheets: Sequence[Verification]) -> bool:
        """Predict cells by the pages of printouts. Return False without any."""
        self.predicted[:] = ""
        self.fields[:] = ""
        rows: list[list[PrintedChar]] = []
        ends: list[tuple[int, int]] = []
        for sheet in sheets:
            parts = _rows_of(sheet.page)
            places = self.places()[[sheet.span[0], sheet.span[1] - 1]]
            lines = (places // self.shape[1]).tolist()
            rows += parts
            ends += [(lines[0], lines[1])] * len(parts)
        if not rows:
            return False
        texts = [*map(_row_text, rows)]
        placements = sorted(self.place_rows(texts, ends), key=lambda placed: placed.gain)
        for placed in {placed.row: placed for placed in placements}.values():  # the best of a row
            self._predict_row(rows[placed.row], texts[placed.row].replace(OPTIONAL, ""), placed)
        return bool((self.predicted != "").any())

    def _predict_row(self, row: Sequence[PrintedChar], text: str, placed: Placement) -> None:
        """Predict the cells of a row, and blanks beside its words."""
        names = {printed.column: printed.name for printed in row}
        sources = placed.sources.tolist()
        for at, column in enumerate(sources):
            if column not in names or text[column] == REPLY:
                continue
            self.predicted[placed.cells[at]] = text[column]
            # a digit added to a number is where the bracket after it was
            self.fields[placed.cells[at]] = names[column] or names.get(column - 1, "")
            for step in (-1, 1):
                if not 0 <= at + step < len(sources) or sources[at + step] in names:
                    continue
                near = placed.cells[at + step]
                if text[column + step : column + step + 1] != REPLY:
                    self.predicted[near] = BLANK
                    self.fields[near] = self.fields[near] or names[column]

    def measure(self) -> list[Cell]:
        """Return the predicted cells with what each is like.

        Cells that differ are left out of the means, and all are measured again.
        """
        cells = self._measure(np.zeros(len(self.predicted), bool))
        dropped = np.zeros(len(self.predicted), bool)
        for cell in cells:
            if cell.state == "differs" and cell.members > 1:
                dropped[cell.line * self.shape[1] + cell.cell] = True
        return self._measure(dropped) if dropped.any() else cells

    def _measure(self, dropped: NDArray[np.bool_]) -> list[Cell]:
        """Return the predicted cells, measured by means without some cells."""
        asked = np.flatnonzero(self.predicted != "")
        sample = self.cells.at(asked)
        want = self.predicted[asked]
        lost = {*want.tolist()} - {*want[~dropped[asked]].tolist()}
        is_member = ~dropped[asked] | np.isin(want, [*lost])
        face = typeface_of(sample, np.where(is_member, want, "").tolist())
        kinds = [*face.names, BLANK]
        own = np.array([kinds.index(name) for name in want])
        blank = len(face.names)
        counts = np.r_[face.counts, len(want)]
        to = face.distances(sample)
        to = np.column_stack([to, sample.norms.min(axis=1)])
        energy = np.r_[face.energy, 1e-3]
        to_own = to[np.arange(len(asked)), own]
        usual = face.usual_distance(to)
        is_alone = (own != blank) & (counts[own] < 2)
        to_own[is_alone] = 2 * usual * energy[own[is_alone]]
        steps = to_own[:, None] - to
        between = face.between()
        margins = steps / np.where(steps > 0, between[:, own].T, between[own])
        on_blank = own == blank  # how much of a character's energy is there
        margins[on_blank] = (to[on_blank, blank][:, None] - to[on_blank]) / energy
        in_number = self.fields[asked] != ""
        is_numeric = np.array([kind in IN_NUMBERS + BLANK for kind in kinds])
        margins[in_number[:, None] & ~is_numeric] = -np.inf
        margins[np.arange(len(asked)), own] = -np.inf
        largest = margins.max(axis=1)
        largest[on_blank & ~self.inked[asked]] = -1.0
        best = np.where(np.isinf(margins), np.inf, to).argmin(axis=1)
        far = np.where(on_blank, 0.0, to_own / energy[own] / usual)
        return [
            Cell(
                *divmod(at, self.shape[1]),
                predicted=str(want[i]),
                name=str(self.fields[at]),
                other=kinds[best[i]],
                margin=float(largest[i]),
                distance=float(far[i]),
                members=int(counts[own[i]]),
                other_members=int(counts[best[i]]),
            )
            for i, at in enumerate(asked.tolist())
        ]

    def final_text(self, cells: Sequence[Cell]) -> str:
        """Return the text by the measured cells, with `UNREAD` where they leave a doubt."""
        final = np.where(self.is_clear | (self.names == BLANK), self.names, UNREAD)
        unread = unread_cells(cells)
        altered = altered_numbers(cells)
        for cell in cells:
            at = cell.line * self.shape[1] + cell.cell
            if cell in unread and cell.predicted != BLANK:
                final[at] = UNREAD
            else:  # a label that is not clearly another is what it must be
                is_other = cell.state == "differs" or (cell.name in altered and cell.margin > 0)
                final[at] = cell.other if is_other else cell.predicted
        return self.text(final)


def altered_numbers(cells: Sequence[Cell]) -> set[str]:
    """Return the names of numbers with a cell that differs."""
    return {cell.name for cell in cells if cell.name and cell.state == "differs"}


def unread_cells(cells: Sequence[Cell]) -> list[Cell]:
    """Return the cells in doubt of numbers of which no cell differs. Others are read as they look:
    that a number is another one is known then."""
    altered = {*altered_numbers(cells), ""}
    return [cell for cell in cells if cell.state == "doubt" and cell.name not in altered]


def _units(inked: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
    """Return the runs of cells that may hold a row: each line, and lines joined where a page is as
    narrow as an Apple's screen, which breaks rows."""
    lines, count = inked.shape
    cells = np.arange(lines * count).reshape(lines, count)
    units = [*cells]
    margin = _left_margin(inked)
    stop = margin + SCREEN_WIDTHS[0]
    beyond = inked[:, stop:].sum(axis=1)
    if (beyond >= MIN_MEMBERS).sum() > 1:  # one line may have a mark
        return units
    screen = cells[:, margin:stop]
    for joined in (2, 3):
        units += [np.concatenate(screen[k : k + joined]) for k in range(lines - joined + 1)]
    return units


def _best_units(
    gains: Floats, first: NDArray[np.intp], last: NDArray[np.intp]
) -> list[tuple[int, int]]:
    """Return the units and their rows with the largest sum of gains, no line in two units.

    A row that does not follow the one before it on the program's page costs `IRREGULAR_COST`.
    """
    count = gains.shape[1]
    follows = np.arange(count)[:, None] < np.arange(count)  # row before, row
    step = np.where(follows, 0.0, IRREGULAR_COST)
    best = [np.zeros(count)]  # by line: the largest sum, by the last row that was placed
    chosen: list[list[list[tuple[int, int]]]] = [[[] for _ in range(count)]]
    for line in range(int(last.max()) + 1):
        totals, paths = best[line].copy(), [*chosen[line]]
        for unit in np.flatnonzero(last == line).tolist():
            before = best[first[unit]][:, None] - step
            sums = before.max(axis=0) + gains[unit]
            for row in np.flatnonzero(sums > totals).tolist():
                totals[row] = sums[row]
                paths[row] = [*chosen[first[unit]][int(before[:, row].argmax())], (unit, row)]
        best.append(totals)
        chosen.append(paths)
    return chosen[-1][int(best[-1].argmax())]


def _left_margin(inked: NDArray[np.bool_]) -> int:
    """Return the column in which most lines begin."""
    starts = inked[inked.sum(axis=1) > 8].argmax(axis=1)
    return int(np.bincount(starts).argmax()) if len(starts) else 0


def _rows_of(page: Sequence[PrintedChar]) -> list[list[PrintedChar]]:
    """Return the rows of a page."""
    return [[*row] for _, row in groupby(page, key=lambda printed: printed.row)]


def _row_text(row: Sequence[PrintedChar]) -> str:
    """Return a predicted row as text, its reply as a wildcard."""
    columns = {
        printed.column: REPLY if printed.name in REPLIES else printed.char for printed in row
    }
    text = "".join(columns.get(column, BLANK) for column in range(max(columns) + 1))
    return re.sub("(?<=[:,])", OPTIONAL, re.sub(f"{REPLY}+", REPLY, text))
