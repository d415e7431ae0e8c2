"""Verdicts on the cells of a page and on each printout: does the page hold what the program prints?

`compare_cells` compares each cell with the character that the program prints there, `state` says
whether the cell holds it, differs or is doubtful, and `judge_cells` gives the printout's verdict.

The mean glyphs are made under the *predicted* names, each cell left out of its own mean. With d the
squared distance of a cell from a mean glyph and D that of two means, the cell's margin is

    (d(predicted) - d(other)) / D(predicted, other),    the largest over the other characters:

-1 is the predicted glyph itself, +1 the other.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from enum import Enum
from itertools import product
from operator import attrgetter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.fields import REPLIES
from ..judging.judgement import Verdict
from .grid import Grid
from .ink import Floats
from .layout import SPACED, Place, Sheet
from .scenes import MAX_CELL_COST, Candidate, Read
from .typeface import (
    BLANK,
    READABLE,
    Sample,
    Typeface,
    distances,
    foreign_digits,
    sample_of,
    typeface_of,
)

_MIN_STEP = 3.0
"""Smallest separation of two means in a margin's denominator, in usual distances. Doubling it
changes none of 5 verdicts."""
_MIN_NOISE = 0.1
"""Smallest usual distance of a cell from its mean, in units of the root of its energy: that of an
excellent scan. Pages drawn by a program have 0.01 to 0.04, and there any other typeface is a
hundred times as far as is usual."""
_FAR = 10.0
"""Distance, in usual distances, from which a cell is compared with all known typefaces: digits
drawn in another font are farther."""
_EVEN = 0.8
"""Strength of ink, 1 for the page's usual, that 99 % of the cells exceed on evenly inked paper:
0.82 and more on seven pages of which a digit was erased, 0.4 to 0.75 on those that lost some."""
INKED = 0.35  # margin of a blank cell from which it holds a character
INKED_SMALL = 0.5  # margin from which it holds a point, a comma or a dash, as light as specks
ERASED = 2.0  # margin from which a sign is not faint but gone; no genuine page exceeds 1
SPECK = 0.25  # margin of a blank from which a speck is seen in it
MAX_SPECKS = 2  # specks in a printout, above which a mark as small as a point may be one, too
FIT = 0.6  # smallest fraction of the ink in a blank that the character explains
_SMALL = frozenset(".,-:'`*")
# The next five were chosen on 314 pages that were settled: 160 scans and photographs, and 154 drawn
# afterwards. Of 42,572 digits none has a margin above -0.23; of 427,482 trials of a digit as
# another of its page two, of one photograph, are below +0.30 (+0.27).
HOLDS = -0.12  # margin of a number's cell below which it is the predicted character
DIFFERS = 0.3  # margin of a number's cell from which it is another character
LABEL = 0.1  # margin of a label's cell below which it holds
FOREIGN = 20.0  # usual distances from a mean beyond which no cell is of that type
KIND = 15.0  # usual distances from another letter's mean within which a label's cell is that letter
MAX_DOUBTFUL = 4
"""Most doubtful cells with which a printout can be identical as read. More suggest a misreading."""
MAX_DIFFERING = 4
"""Most differing cells with which a printout can differ. More suggest a misreading."""
MAX_MISREAD_COST = 2 * MAX_CELL_COST
"""Largest cost of the first reading that the differing cells do not explain, with which a printout
can differ: 240 of 245 altered pages stay within; three genuine pages, wrongly found to differ
before this limit, had 20 to 36."""
_MARKS = frozenset(".,-")
"""Characters of so little ink that a speck, or a faint pin, makes or unmakes them."""


class Added(Enum):
    """Kinds of ink where the program prints a blank."""

    NOTHING = 0
    CHARACTER = 1
    """In a line, or at its end: it changes a number or a label."""
    BESIDE = 2
    """Typed text beside a line, or at a reply."""
    MARK = 3
    """Ink like no character of the page."""


@dataclass
class Cell:
    """One cell compared with the character that the program prints there.

    Attributes
    ----------
    place : Place
        Line and cell of the grid.
    name : str
        Its field, "" for labels and blanks.
    predicted, other : str
        The character that the program prints, and the nearest other one.
    margin : float
        (distance from the predicted mean - distance from the other) / separation of the two means;
        of a blank cell the ink that the other explains, relative to that character's ink.
    distance, other_distance : float
        Squared distances from the two means, 1 for what is usual on this page.
    count, other_count : int
        Cells of which each mean was made; ``other_count`` is 0 where ``other`` is a digit in
        another typeface of which this page has no mean.
    foreign_digit : str
        The digit that the cell is in another known typeface, "" for none. Asked only of cells that
        are far from the predicted mean, or alone with their character.
    cut : bool
        True for a cell beyond an edge of the picture.
    lost : bool
        True for a cell that is blank on a page whose ink comes and goes.
    fit : float
        Fraction of the ink in a blank cell that the other character explains.
    added : Added
        What stands in a blank cell.
    """

    place: Place
    name: str
    predicted: str
    margin: float
    other: str
    distance: float
    other_distance: float
    count: int
    other_count: int
    foreign_digit: str = ""
    cut: bool = False
    lost: bool = False
    fit: float = 0.0
    added: Added = Added.NOTHING


def predicted_characters(read: Read, candidate: Candidate) -> Iterator[tuple[str, str, Place]]:
    """Yield field, character and place of what the program prints for a scene."""
    for line, row in read.sheet.rows.items():
        column = 0
        for name, text, places in row.pieces:
            printed = candidate.outcome.fields.get(name, "") if name else text
            if name.startswith("REPLY"):
                printed = reply_of(read, name, candidate.scene)
            if line in SPACED:  # this line's spacing is not fixed
                column = row.column(places[0]) if places else column
                column += read.shift(name, printed) if name else 0
            if not name and not text.strip():
                printed = BLANK * len(places)
            for character in printed:
                yield name, character, row.place(column)
                column += 1


def _blanks(grid: Grid, sheet: Sheet, inked: set[Place]) -> Iterator[tuple[str, str, Place]]:
    """Yield the cells of a printout's lines in which the program prints nothing."""
    for row in sheet.rows.values():
        for line in range(row.start, row.start + row.used):
            for cell in range(len(grid.corners[line]) - 1):
                if (place := Place(line, cell)) not in inked:
                    yield "", BLANK, place


def reply_of(read: Read, name: str, scene: dict[str, str]) -> str:
    """Return what was typed at a prompt to give the scene's velocities.

    It is the spelling with the least cost of its characters in the cells, plus 1 for each character
    that it has more or less than the reply on the page.
    """
    spellings = [_spellings(scene[symbol]) for symbol in REPLIES[name[-1]]]
    replies = [comma.join(three) for three in product(*spellings) for comma in (",", ", ")]
    length = len(read.costs[name])
    return min(replies, key=lambda reply: read.cost(name, reply) + abs(len(reply) - length))


def _spellings(text: str) -> list[str]:
    """Return the spellings of a number, ``text`` first: with and without the 0 before the point and
    zeros at the end."""
    if "E" in text:
        return [text, *_spellings(format(Decimal(text), "f"))]
    sign, digits = ("-", text[1:]) if text.startswith("-") else ("", text)
    whole, point, part = digits.partition(".")
    if not point:
        return [text, f"{text}.0"]
    wholes, short = {whole, whole.lstrip("0"), whole or "0"}, part.rstrip("0")
    spellings = {
        f"{sign}{w}.{p}" if p else f"{sign}{w or '0'}"
        for w in wholes
        for p in (part, short, f"{short}0")
    }
    return sorted(spellings, key=lambda spelling: (spelling != text, spelling))


class _Target(NamedTuple):
    """A character that the program prints: number of its printout, field, character, place."""

    printout: int
    name: str
    character: str
    place: Place


class _Distances(NamedTuple):
    """Squared distances of a page's cells from the mean glyphs of its own characters.

    A distance is divided by the squared strength of the cell's ink: what is weakly inked is as far
    from every mean as its ink allows. The last character is blank paper.

    Attributes
    ----------
    characters : list of str
    counts : list of int
        Cells of which each mean was made.
    between : ndarray, shape (characters, characters)
        Squared distances of the means from each other.
    energy : ndarray, shape (characters,)
        Squared norms of the means.
    own : ndarray, shape (cells,)
        Index of the character that is predicted in each cell.
    to_own : ndarray, shape (cells,)
        Distance from the predicted mean, the cell itself left out of it.
    to_all : ndarray, shape (cells, characters)
        Distance from each mean.
    is_alone : ndarray, shape (cells,)
        True for a cell that is the only one with its character, so that no mean is left.
    scale : ndarray, shape (cells,)
        Root of the predicted mean's energy, at least 1.
    relative : ndarray, shape (cells,)
        ``to_own / scale``.
    level : float
        Median of ``relative``: the usual distance on this page.
    is_uneven : bool
        True for a page some of whose characters are pale.
    """

    characters: list[str]
    counts: list[int]
    between: Floats
    energy: Floats
    own: NDArray[np.intp]
    to_own: Floats
    to_all: Floats
    is_alone: NDArray[np.bool_]
    scale: Floats
    relative: Floats
    level: float
    is_uneven: bool

    def nearest_other(self, cell: int, allowed: NDArray[np.bool_]) -> tuple[int, float]:
        """Return the index of the ``allowed`` character with the largest margin, and the margin."""
        # means as near each other as the cells are to their own distinguish nothing
        step = np.maximum(self.between[self.own[cell]], _MIN_STEP * self.level * self.scale[cell])
        if self.is_alone[cell]:
            step = np.maximum(step, self.to_all[cell])
        is_other = allowed & (np.arange(len(allowed)) != self.own[cell])
        margins = np.where(is_other, (self.to_own[cell] - self.to_all[cell]) / step, -np.inf)
        other = int(np.argmax(margins))
        return other, float(margins[other])

    def nearest_in_blank(self, cell: int) -> tuple[int, float, float]:
        """Return the character that explains most of the ink in a blank cell.

        Returns
        -------
        other : int
            Its index.
        margin : float
            Energy that it explains, relative to its own.
        fit : float
            Energy that it explains, as a fraction of the cell's.

        Notes
        -----
        Small marks are near each other and near blank paper, so that margins by separation, as
        `nearest_other` has them, would always favour them.
        """
        other = int(np.argmin(self.to_all[cell, :-1]))
        gain = float(self.to_own[cell] - self.to_all[cell, other])
        fit = gain / max(float(self.to_own[cell]), 1e-6)
        return other, gain / max(float(self.energy[other]), 1e-6), fit


def compare_cells(grid: Grid, known: Sequence[tuple[Read, Candidate]]) -> list[list[Cell]]:
    """Return every cell of each printout's page, compared with the mean glyphs of all.

    Parameters
    ----------
    grid : Grid
    known : sequence of (Read, Candidate)
        The printouts on the grid, each with the scene whose page is compared.

    Returns
    -------
    list of list of Cell
        For each printout its cells by place.
    """
    if not known:
        return []
    targets = _targets(grid, known)
    names = np.array([target.character for target in targets])
    is_cut = [_is_cut(grid, known[target.printout][0], target) for target in targets]
    sample = sample_of(grid, [target.place for target in targets])
    typeface = typeface_of(sample, np.where(is_cut, "", names).tolist())
    measured = _measure(sample, typeface, names)
    digits = _foreign_digits(sample, typeface, measured, targets)
    characters = measured.characters
    is_numeric = np.array([character in READABLE for character in characters])
    is_letter = np.array([character.isalpha() or character == BLANK for character in characters])
    cells: list[list[Cell]] = [[] for _ in known]
    for at, (target, digit) in enumerate(zip(targets, digits, strict=True)):
        if target.character == BLANK:
            other, margin, fit = measured.nearest_in_blank(at)
        else:
            allowed = is_numeric if target.name else is_letter
            (other, margin), fit = measured.nearest_other(at, allowed), 0.0
        name = characters[other]
        if digit and not measured.is_alone[at]:
            name = digit
            other = characters.index(digit) if digit in characters else other
        beyond = measured.to_all[at, other] / max(measured.scale[at], 1e-6) / measured.level
        cell = Cell(
            target.place,
            target.name,
            target.character,
            margin,
            name,
            distance=float(measured.relative[at] / measured.level),
            other_distance=float(beyond),
            count=measured.counts[measured.own[at]],
            other_count=measured.counts[other] if name == characters[other] else 0,
            foreign_digit=digit,
            cut=is_cut[at],
            lost=measured.is_uneven and characters[other] == BLANK,
            fit=fit,
        )
        cells[target.printout].append(cell)
    for own_cells in cells:
        own_cells.sort(key=attrgetter("place"))
        _find_added(own_cells)
    return cells


def _targets(grid: Grid, known: Sequence[tuple[Read, Candidate]]) -> list[_Target]:
    """Return all that the program prints for some scenes, blanks of its lines included."""
    targets: list[_Target] = []
    for number, pair in enumerate(known):
        printed = [*predicted_characters(*pair)]
        blanks = _blanks(grid, pair[0].sheet, {place for *_, place in printed})
        targets += [_Target(number, *row) for row in (*printed, *blanks)]
    return targets


def _is_cut(grid: Grid, read: Read, target: _Target) -> bool:
    """Return True for a cell beyond an edge of the picture or, if inked, beyond a line's break."""
    is_beyond = target.character != BLANK and read.sheet.beyond(target.place)
    return not grid.shows(*target.place) or is_beyond


def _measure(sample: Sample, typeface: Typeface, names: NDArray[np.str_]) -> _Distances:
    """Return the distances of cells from the means, ``names`` the predicted characters."""
    characters = [*typeface.characters, BLANK]
    index = {character: k for k, character in enumerate(characters[:-1])}
    own = np.array([index.get(name, len(characters) - 1) for name in names])
    cells = np.arange(len(names))
    to_all, strength = distances(sample, typeface.means)
    to_all = np.column_stack([to_all, sample.norms.min(axis=1).astype(float)])
    ink = np.column_stack([strength, np.ones(len(names))])[cells, own]
    energy = np.r_[np.einsum("mp,mp->m", typeface.means, typeface.means), 0.0]
    to_own = to_all[cells, own].copy()
    is_alone = np.zeros(len(names), bool)
    is_inked = names != BLANK
    for cell in np.flatnonzero(is_inked).tolist():
        mean = typeface.without(cell)
        if mean is None:
            is_alone[cell] = True
        else:
            to_mean, weight = distances(sample.at(np.array([cell])), mean[None])
            to_own[cell], ink[cell] = to_mean[0, 0], weight[0, 0]
    is_uneven = bool(np.percentile(ink[~np.isin(names, list(" .,-"))], 1) < _EVEN)
    to_own, to_all = to_own / ink**2, to_all / ink[:, None] ** 2
    scale = np.sqrt(np.maximum(energy[own], 1.0))
    relative = to_own / scale
    of_means = relative[is_inked & ~is_alone]
    level = max(float(np.median(of_means)), _MIN_NOISE)
    # a cell without a mean of its own is assumed as far from its mean as a poor cell on this page
    to_own[is_alone] = float(np.percentile(of_means, 75)) * scale[is_alone]
    return _Distances(
        characters,
        [*typeface.counts.tolist(), 0],
        typeface.between(),
        energy,
        own,
        to_own,
        to_all,
        is_alone,
        scale,
        relative,
        level,
        is_uneven,
    )


def _foreign_digits(
    sample: Sample, typeface: Typeface, measured: _Distances, targets: Sequence[_Target]
) -> list[str]:
    """Return the digit that each cell is in another known typeface, "" for none.

    Asked of numbers' cells that are far from their mean, or that have none.
    """
    of_number = np.array([bool(target.name) for target in targets])
    is_alone = measured.is_alone & of_number
    is_far = of_number & ~measured.is_alone & (measured.relative > _FAR * measured.level)
    names = [target.character for target in targets]
    return foreign_digits(sample, typeface, names, is_alone, is_far)


def _find_added(cells: Sequence[Cell]) -> None:
    """Set ``added`` of the blanks of a printout that hold ink.

    A run of blanks with ink like characters of the page is an addition to its line
    (`Added.CHARACTER`) if all of these hold, otherwise text beside the line (`Added.BESIDE`):

    - it lies between printed characters of its line or next to one;
    - it has at most `MAX_DIFFERING` cells;
    - it is more than small marks, or the printout has at most `MAX_SPECKS` specks;
    - it does not touch a reply, which was typed, not printed;
    - it does not lie just before a line that begins with a label.
    """
    blanks = [cell for cell in cells if cell.predicted == BLANK and not (cell.name or cell.cut)]
    characters = {cell.place: cell for cell in blanks if _is_typed(cell)}
    # where several blanks hold a little ink, a mark as small may be a speck
    specks = sum(cell.other in _SMALL and cell.margin > SPECK for cell in blanks)
    for cell in blanks:
        if cell.place not in characters and cell.margin > INKED_SMALL:
            cell.added = Added.MARK
    inked = {cell.place: cell for cell in cells if cell.predicted != BLANK}
    for (line, at), run in _runs(characters):
        columns = [place.cell for place in inked if place.line == line]
        sides = [inked.get(Place(line, side)) for side in (at - 1, at + len(run))]
        names = [side.name for side in sides if side and side.name]
        is_within = bool(columns) and min(columns) < at < max(columns)
        touches_line = is_within or any(sides)
        is_short = len(run) <= MAX_DIFFERING
        may_be_specks = specks > MAX_SPECKS and all(cell.other in _SMALL for cell in run)
        touches_reply = any(name.startswith("REPLY") for name in names)
        is_added = touches_line and is_short and not may_be_specks and not touches_reply
        if is_added and (is_within or names or at > min(columns)):
            for cell in run:
                cell.added = Added.CHARACTER
                cell.name = names[0] if names else ""
        else:
            for cell in run:
                cell.added = Added.BESIDE


def _is_typed(cell: Cell) -> bool:
    """Return True for a blank that holds ink like a character of the page."""
    least = INKED_SMALL if cell.other in _SMALL else INKED
    return cell.margin > least and cell.fit > FIT and cell.other_count > 1


def _runs(cells: Mapping[Place, Cell]) -> Iterator[tuple[Place, list[Cell]]]:
    """Yield runs of cells next to each other on a line, with the place of the first."""
    for place in sorted(cells):
        if Place(place.line, place.cell - 1) in cells:
            continue
        run, at = [cells[place]], place.cell + 1
        while Place(place.line, at) in cells:
            run.append(cells[Place(place.line, at)])
            at += 1
        yield place, run


@dataclass
class CellJudgement:
    """Verdict on a printout from its cells, with its reasons.

    Attributes
    ----------
    verdict : Verdict
    differing, doubtful : list of Cell
        Cells that differ, and cells in doubt.
    reason : str
        A clause on a page that was not read as a whole, "" for others.
    legible : bool
        False for a page so many of whose cells are open that nothing is said of any.
    """

    verdict: Verdict
    differing: list[Cell] = field(default_factory=list)
    doubtful: list[Cell] = field(default_factory=list)
    reason: str = ""
    legible: bool = True


def judge_cells(sheet: Sheet, candidate: Candidate, cells: Sequence[Cell]) -> CellJudgement:
    """Return the verdict on one printout, from its cells as compared with the scene's page."""
    differing = [cell for cell in cells if state(cell) == "differs"]
    doubtful = [cell for cell in cells if state(cell) == "doubtful"]
    spins = "WAF" in candidate.outcome.fields
    is_legible = len(differing) + len(doubtful) <= MAX_DIFFERING + MAX_DOUBTFUL
    reason = ""
    if not sheet.whole:
        reason = "lines of the printout were not found"
    elif not is_legible:
        reason = "too few characters could be read with certainty"
    elif candidate.outcome.ending is not None or spins is not (13 in sheet.rows):
        reason = "the final spins were not found"
    elif differing and all(_is_retyped(cell, [*differing, *doubtful]) for cell in differing):
        reason = "a reply was typed differently than expected"
    if reason:
        differing = differing if is_legible else []
        return CellJudgement(Verdict.INCOMPLETE, differing, doubtful, reason, is_legible)
    verdict, only_slight = Verdict.IDENTICAL, all(map(_is_slight, doubtful))
    if differing:
        misread = candidate.cost - MAX_CELL_COST * len(differing)
        sure = only_slight and len(differing) <= MAX_DIFFERING and misread <= MAX_MISREAD_COST
        verdict = Verdict.DIFFERS if sure else Verdict.INCOMPLETE
    elif doubtful:
        only_slight = only_slight and len(doubtful) <= MAX_DOUBTFUL
        verdict = Verdict.IDENTICAL_AS_READ if only_slight else Verdict.INCOMPLETE
    return CellJudgement(verdict, differing, doubtful)


def state(cell: Cell) -> str:
    """Return the state of a cell: ``holds``, ``doubtful`` or ``differs``."""
    if cell.cut:
        return "doubtful" if cell.name and cell.predicted != BLANK else "holds"
    if cell.predicted == BLANK:
        if cell.added is Added.CHARACTER:
            return "differs"
        return "doubtful" if cell.name and cell.margin > INKED else "holds"
    # a digit in another typeface is in doubt where no other cell has the predicted character
    if (cell.foreign_digit and cell.count < 2) or (cell.lost and cell.margin > HOLDS):
        return "doubtful"
    if not cell.name:
        if cell.margin < LABEL:
            return "holds"
        # another letter only where the page has it elsewhere and the cell is of its kind
        is_known = min(cell.count, cell.other_count) > 2 and cell.other != BLANK
        is_near = cell.other_distance < KIND and cell.distance > 2 * cell.other_distance
        return "differs" if is_known and is_near and cell.margin > 2 * DIFFERS else "doubtful"
    if cell.margin < HOLDS:
        return "holds" if cell.distance < FOREIGN else "doubtful"
    if cell.margin < DIFFERS or (cell.predicted in _MARKS and cell.other in f"{BLANK}.,-"):
        return "doubtful"
    # a blot is like nothing, a digit in another typeface like that of a known one
    return "differs" if cell.other_distance < FOREIGN or cell.foreign_digit else "doubtful"


def _is_retyped(cell: Cell, questioned: Sequence[Cell]) -> bool:
    """Return True for a cell of a reply that differs in several cells, or in a mark.

    One number can be typed in many ways, and what was typed never outranks what was printed.
    ``questioned``: the printout's cells that differ or are in doubt.
    """
    is_one_of_several = sum(other.name == cell.name for other in questioned) > 1
    of_digits = cell.predicted.isdigit() and cell.other.isdigit()
    return cell.name.startswith("REPLY") and (is_one_of_several or not of_digits)


def _is_slight(cell: Cell) -> bool:
    """Return True for a doubt about a mark, a speck or a label, which leaves every digit certain.

    A digit that is like nothing on the page is in doubt, whatever it is least unlike.
    """
    is_mark = cell.predicted in _MARKS
    if cell.name and cell.predicted == "-" and cell.margin > ERASED:
        return False
    if cell.lost and (not cell.name or is_mark):
        return True
    if not cell.name or cell.predicted == BLANK or (is_mark and cell.other in _MARKS):
        return cell.margin < 0.5
    # Digits are left, and marks that may be digits. With a margin below HOLDS, `state` doubts them
    # because they are beyond an edge of the picture, which is slight, or far from their mean, which
    # is slight for a mark only.
    return (is_mark or cell.distance < FOREIGN) and not cell.foreign_digit and cell.margin < HOLDS
