"""The text of a page: what is in every cell, read by the page's own typeface.

Labels are known text in known rows, so they name the page's letters. Figures get first names by
likeness to known typefaces. The text that results gives, through `printouts.judge`, a scene and the
page that the program prints for it; each cell is then measured against the mean of its predicted
character and of all others.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from ..printouts import Verification, judge
from ..printouts.page import REPLIES, ROWS, PrintedChar
from .align import BESIDE, NUMBER, OPTIONAL, REPLY, Alignment, align, costs_of
from .cells import (
    BLANK,
    CHARACTERS,
    NUMERIC,
    WIDEST_SAMPLE,
    Cells,
    Typeface,
    cells_of,
    distances,
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
MIN_GAIN = 0.5  # gain of a row for each of its characters from which a line is taken for it
MIN_INKED = 50  # cells with type of a page
MAX_OFF = 0.1  # fraction of the cells that contradict a page, from which it is of another scene
MAX_UNLIKE = 0.45  # distance of type from its mean, as a fraction of the mean's energy
ROUNDS = 3  # readings by the page's own means
UNREAD = "?"
IN_NUMBERS = NUMERIC + "E"
TEMPLATES = [
    re.sub(
        "(?<=[:,])|(?=:)",
        OPTIONAL,
        re.sub(r"{(\w+)}", lambda match: REPLY if match[1] in REPLIES else NUMBER, row),
    )
    for row in ROWS
]
"""The program's rows, numbers and replies as wildcards."""


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

        A cell without ink never differs: dropped ink looks like erasure.
        """
        if self.predicted == BLANK:
            is_known = self.other_members >= MIN_MEMBERS
            return "holds" if self.margin < DIFFERS else "differs" if is_known else "doubt"
        if self.margin < HOLDS and self.distance < MAX_FOREIGN:
            return "holds"
        is_known = self.other != BLANK and self.other_members >= MIN_MEMBERS
        if not self.name:
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
        A line for each line of the grid, a character for each cell: the character of line l and
        cell c has the offset l (count + 1) + c. `UNREAD` is what was not read.
    cells : list of Cell
        The predicted cells.
    gain : float
        How well the program's rows explain the page.
    sheets : list of Verification
        The printouts by which cells were predicted.
    """

    grid: Grid
    text: str = ""
    cells: list[Cell] = field(default_factory=list)
    gain: float = 0.0
    sheets: list[Verification] = field(default_factory=list)

    def line_cell(self, offset: int) -> tuple[int, int]:
        """Return line and cell of an offset of the text."""
        return divmod(offset, self.grid.count + 1)


def transcribe(grid: Grid, given: Mapping[str, str] | None = None) -> Transcript:
    """Return the transcript of a page.

    Parameters
    ----------
    grid : Grid
        Its cells.
    given : mapping of str to str, optional
        Inputs known from elsewhere, for a page with results only.
    """
    reader = Reader(grid, cells_of(grid))
    if reader.inked.sum() < MIN_INKED:
        return Transcript(grid)
    rows = reader.align(TEMPLATES)
    gain = float(rows.gains.max(axis=1).sum())
    if not reader.name_labels(rows):
        return Transcript(grid, gain=gain)
    grid = reader.registered()
    reader = Reader(grid, cells_of(grid))
    reader.name_labels(reader.align(TEMPLATES))
    reader.name_numbers()
    for _ in range(ROUNDS):
        reader.read()
    transcript = Transcript(grid, gain=gain, text=reader.text())
    for _ in range(ROUNDS):
        sheets = judge(transcript.text, given)
        if [s.page for s in sheets] == [s.page for s in transcript.sheets]:
            break
        if not reader.predict(sheets):
            break
        transcript.sheets = sheets
        reader.read(reader.trusted())
        transcript.cells = reader.measure()
        transcript.text = reader.final_text(transcript.cells)
    return transcript


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

    def align(self, rows: Sequence[str]) -> Alignment:
        """Return the best of some rows for each line."""
        odds = self.cells.odds.reshape(self.shape)
        return align(costs_of(odds, self.unlike.reshape(*self.shape, -1)), rows)

    def name_labels(self, rows: Alignment) -> bool:
        """Name the cells of labels, and mark those of numbers. Return False without any."""
        states = np.array(rows.states)[rows.paths]
        is_row = _is_explained(rows, TEMPLATES)[:, None]
        is_number = is_row & ((states == NUMBER) | (states == REPLY))
        is_label = is_row & ~is_number & (states != BESIDE)
        is_label &= (states != BLANK) & (states != OPTIONAL)
        self.is_number = is_number.ravel() & self.inked
        self.is_label = is_label.ravel() & self.inked
        self.names = np.where(self.is_label, states.ravel(), BLANK).astype("<U1")
        return bool(self.is_label.any())

    def registered(self) -> Grid:
        """Return the grid with each line moved onto the means of the page's labels and figures."""
        chosen = np.flatnonzero(self.is_label)
        face = typeface_of(self.cells.at(chosen), self.names[chosen].tolist())
        lines, columns = np.divmod(chosen, self.shape[1])
        unit = self.grid.pitch / CELL_WIDTH
        own = np.zeros((self.shape[0], 4))
        is_sure = face.counts[face.index] >= MIN_MEMBERS
        for line in range(self.shape[0]):
            at = (lines == line) & is_sure
            if at.sum() < 3:
                continue
            for part, off in ((0, face.shifts[at, 1]), (2, face.shifts[at, 0])):
                rise, level = 0.0, float(off.mean())
                if np.ptp(columns[at]) > 20:
                    rise, level = np.polyfit(columns[at], off, 1)
                own[line, part : part + 2] = unit * level, unit * rise
        return self.grid.moved(own)

    def name_numbers(self) -> None:
        """Give the cells of numbers their first names."""
        numbers, labels = np.flatnonzero(self.is_number), np.flatnonzero(self.is_label)
        if not len(numbers):
            return
        letters = self.names[labels]
        is_same = np.triu(letters[:, None] == letters, 1)
        apart = pair_distances(self.cells.at(labels))[is_same]
        usual = float(np.quantile(apart, WIDEST_SAMPLE)) if len(apart) else 0.0
        sample = self.cells.at(numbers)
        self.names[numbers] = name_groups(sample, self.unlike[numbers, : len(NUMERIC)], usual)

    def read(self, names: NDArray[np.str_] | None = None) -> None:
        """Read each inked cell but labels by the means of the cells under the names."""
        names = self.names if names is None else names
        inked = np.flatnonzero(self.inked)
        sample = self.cells.at(inked)
        face = typeface_of(sample, names[inked].tolist())
        to = self._leave_one_out(sample, face, distances(sample, face.means))
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
        is_type = to.min(axis=1) < MAX_UNLIKE * face.energy[best]
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

    def _leave_one_out(self, sample: Cells, face: Typeface, to: Floats) -> Floats:
        """Return distances with each cell left out of its own character's mean."""
        for cell in np.flatnonzero(face.index >= 0).tolist():
            mean = face.without(cell)
            if mean is not None:
                part = sample.at(np.array([cell]))
                to[cell, face.index[cell]] = distances(part, mean[None])[0, 0]
        return to

    def text(self) -> str:
        """Return the names as text."""
        return "\n".join("".join(row) for row in self.names.reshape(self.shape))

    def predict(self, sheets: Sequence[Verification]) -> bool:
        """Predict cells by the pages of printouts. Return False without any."""
        self.predicted[:] = ""
        self.fields[:] = ""
        rows: list[list[PrintedChar]] = []
        ends: list[tuple[int, int]] = []
        for sheet in sheets:
            by_row: dict[int, list[PrintedChar]] = {}
            for printed in sheet.page:
                by_row.setdefault(printed.row, []).append(printed)
            lines = [offset // (self.shape[1] + 1) for offset in sheet.span]
            rows += by_row.values()
            ends += [(lines[0], lines[1])] * len(by_row)
        if not rows:
            return False
        texts = [*map(_row_text, rows)]
        for number, line, offsets in self._place_rows(texts, ends):
            self._predict_row(rows[number], texts[number], line, offsets)
        return True

    def _place_rows(
        self, texts: Sequence[str], ends: Sequence[tuple[int, int]]
    ) -> list[tuple[int, int, dict[int, int]]]:
        """Return which line each row is, and the cells of its characters."""
        rows = self.align(texts)
        lines = np.arange(self.shape[0])
        gains = rows.gains.T.copy()
        for number, (first, last) in enumerate(ends):
            gains[number, (lines < first) | (lines > last)] = -1e3
        order = np.abs(np.linspace(0, 1, len(texts))[:, None] - np.linspace(0, 1, len(lines)))
        taken = linear_sum_assignment(-(gains - 0.5 * order))  # rows that are alike, in order
        placed = []
        for number, line in zip(*taken, strict=True):
            size = len(re.sub(f"[{OPTIONAL} ]", "", texts[number]))
            if gains[number, line] < MIN_GAIN * size:
                continue
            path = self.align_line(int(line), texts[number])
            placed.append((int(number), int(line), path))
        return placed

    def align_line(self, line: int, text: str) -> dict[int, int]:
        """Return the cell of each character of a row on a line, by its index in the row."""
        part = slice(line * self.shape[1], (line + 1) * self.shape[1])
        odds, unlike = self.cells.odds[None, part], self.unlike[None, part]
        rows = align(costs_of(odds, unlike), [text])
        sources = rows.sources[rows.paths[0]]
        return {int(source): cell for cell, source in enumerate(sources) if source >= 0}

    def _predict_row(
        self, row: Sequence[PrintedChar], text: str, line: int, cells: Mapping[int, int]
    ) -> None:
        start = line * self.shape[1]
        text = text.replace(OPTIONAL, "")
        names = {printed.column: printed.name for printed in row}
        for column, cell in cells.items():
            if text[column] in (REPLY, BLANK):
                continue
            self.predicted[start + cell] = text[column]
            self.fields[start + cell] = names[column]
            for beside, near in ((column - 1, cell - 1), (column + 1, cell + 1)):
                is_gap = beside not in names or beside >= len(text)
                is_free = 0 <= near < self.shape[1] and not self.predicted[start + near]
                if (is_gap and is_free and near not in cells.values()) or (
                    is_gap and is_free and text[beside : beside + 1] == BLANK
                ):
                    self.predicted[start + near] = BLANK
                if is_gap and is_free and names[column] not in ("", *REPLIES):
                    self.fields[start + near] = names[column]

    def trusted(self) -> NDArray[np.str_]:
        """Return the names with those of the predicted page, unless many cells contradict it."""
        is_known = (self.predicted != "") & (self.predicted != BLANK) & self.inked
        is_off = is_known & (self.predicted != self.names)
        if is_off.sum() > MAX_OFF * self.inked.sum():
            return self.names
        return np.where(is_known, self.predicted, self.names)

    def measure(self) -> list[Cell]:
        """Return the predicted cells with what each is like."""
        asked = np.flatnonzero(self.predicted != "")
        sample = self.cells.at(asked)
        want = self.predicted[asked]
        face = typeface_of(sample, want.tolist())
        blank = len(face.names)
        kinds = [*face.names, BLANK]
        counts = np.r_[face.counts, 99]
        to = distances(sample, face.means)
        own = np.where(face.index < 0, blank, face.index)
        to = self._leave_one_out(sample, face, to)
        to = np.column_stack([to, sample.norms.min(axis=1)])
        energy = np.r_[face.energy, 1e-3]
        between = face.between()
        to_own = to[np.arange(len(asked)), own]
        is_usual = (own != blank) & (counts[own] > 1)
        usual = max(float(np.median((to_own / energy[own])[is_usual])), 0.05)
        is_alone = (own != blank) & (counts[own] < 2)
        to_own[is_alone] = 2 * usual * energy[own[is_alone]]
        is_numeric = np.array([kind in IN_NUMBERS + BLANK for kind in kinds])
        cells = []
        for i, at in enumerate(asked.tolist()):
            in_number = self.fields[at] != ""
            others = np.flatnonzero(
                (is_numeric | (not in_number)) & (np.arange(blank + 1) != own[i])
            )
            if own[i] == blank:  # how much of a character's energy is there
                best = others[np.argmin(to[i, others])]
                margin = (to[i, blank] - to[i, best]) / energy[best] if self.inked[at] else -1.0
                far = 0.0
            else:
                steps = to_own[i] - to[i, others]
                scales = np.where(steps > 0, between[others, own[i]], between[own[i], others])
                best = others[np.argmax(steps / scales)]
                margin = (steps / scales).max()
                far = to_own[i] / energy[own[i]] / usual
            line, cell = divmod(at, self.shape[1])
            cells.append(
                Cell(
                    line,
                    cell,
                    str(want[i]),
                    str(self.fields[at]),
                    kinds[best],
                    float(margin),
                    float(far),
                    int(counts[own[i]]),
                    int(counts[best]),
                )
            )
        return cells

    def final_text(self, cells: Sequence[Cell]) -> str:
        """Return the text by the measured cells, with `UNREAD` where they leave a doubt."""
        final = np.where(self.is_clear | (self.names == BLANK), self.names, UNREAD)
        for cell in cells:
            at = cell.line * self.shape[1] + cell.cell
            if cell.state == "doubt" and cell.name and cell.predicted != BLANK:
                final[at] = UNREAD
            else:  # a label that is not clearly another is what it must be
                final[at] = cell.other if cell.state == "differs" else cell.predicted
        return "\n".join("".join(row) for row in final.reshape(self.shape))


def _is_explained(rows: Alignment, texts: Sequence[str]) -> NDArray[np.bool_]:
    """Return which lines one of the rows explains."""
    sizes = np.array([len(re.sub(f"[{NUMBER}{REPLY}{OPTIONAL} ]", "", text)) for text in texts])
    best = rows.gains.argmax(axis=1)
    return np.asarray(rows.gains.max(axis=1) > MIN_GAIN * np.maximum(sizes[best], 5))


def _row_text(row: Sequence[PrintedChar]) -> str:
    """Return a predicted row as text, its reply as a wildcard."""
    columns = {
        printed.column: REPLY if printed.name in REPLIES else printed.char for printed in row
    }
    text = "".join(columns.get(column, BLANK) for column in range(max(columns) + 1))
    return re.sub("(?<=[:,])|(?=:)", OPTIONAL, re.sub(f"{REPLY}+", REPLY, text))
