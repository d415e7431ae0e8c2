"""Verdicts on the cells of a page and on each printout: does the page hold what the program prints?

`compare_cells` compares each cell with the character that the program prints there, `state` says
whether the cell holds it, differs or is doubtful, and `judge_cells` gives the printout's verdict.

The mean glyphs are made under the *predicted* names, each cell left out of its own mean. The
squared distance of a cell from a mean glyph, in units of what is usual on the page, is the
logarithm of how unlikely its ink is under that glyph, up to a factor; a blot may have any ink, at
the price of `FOREIGN`, and is left unexplained. The margin of a cell is the logarithm of the
likelihood of the nearest other character over that of the predicted one,

    min(distance from the predicted, FOREIGN) - distance from the other.

`judging.judgement` judges texts, whose characters were named by a reader before; here a cell has a
likelihood under every character, and none is named but by the page that is tested. Both give a
`Verdict`, and numbers are told by the same `FieldCheck`.
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

from ..fields import REPLIES
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

_MIN_NOISE = 0.1
"""Smallest usual distance of a cell from its mean, in units of the root of its energy: that of an
excellent scan. Pages drawn by a program have 0.01 to 0.04, and there any other typeface is a
hundred times as far as is usual."""
FOREIGN = 20.0
"""Distance, in usual distances, beyond which a cell is like no character of the page: it may be a
digit in another typeface."""
_EVEN = 0.8
"""Strength of ink, 1 for the page's usual, that 99 % of the cells exceed on evenly inked paper:
0.82 and more on seven pages of which a digit was erased, 0.4 to 0.75 on those that lost some."""
INKED = 0.35  # margin of a blank cell from which it holds a character, or a speck is seen in it
INKED_SMALL = 0.5  # margin from which it holds a point, a comma or a dash, as light as specks
MAX_SPECKS = 2  # specks in a printout, above which a mark as small as a point may be one, too
FIT = 0.6  # smallest fraction of the ink in a blank that the character explains
_SMALL = frozenset(".,-:'`*")
# The next two were chosen on 400 given pages: on genuine ones that were read no cell has a margin
# above 0.7, but points on pages that lost some; no altered digit, letter or sign has one below 7.
HOLDS = 0.0  # margin of a cell below which it is the predicted character
DIFFERS = 4.0  # margin of a cell from which it is another character
MAX_DIFFERING = 4
"""Most differing cells of a printout of which anything is said, and most that no character explains
or that cannot be seen. More suggest a misreading."""
MAX_BLOTS = 1  # most cells of the second kind in a printout that can differ
MAX_MISREAD = 2.0
"""Most cells that were read otherwise at first and do not differ, of a printout that can differ:
240 of 245 altered pages stay within; three genuine pages, wrongly found to differ before this
limit, had 3 to 6."""
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
        Log-likelihood of the other character over the predicted one, in usual distances; of a
        blank cell the ink that the other explains, relative to that character's ink.
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
        for line in row.lines:
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
    energy: Floats
    own: NDArray[np.intp]
    to_own: Floats
    to_all: Floats
    is_alone: NDArray[np.bool_]
    scale: Floats
    relative: Floats
    level: float
    is_uneven: bool

    def nearest_other(self, cell: int, allowed: NDArray[np.bool_]) -> int:
        """Return the index of the nearest of the ``allowed`` characters but the predicted one."""
        is_other = allowed & (np.arange(len(allowed)) != self.own[cell])
        return int(np.argmin(np.where(is_other, self.to_all[cell], np.inf)))

    def nearest_in_blank(self, cell: int) -> tuple[int, float, float]:
        """Return the character that explains most of the ink in a blank cell.

        Its fraction counts, not its likelihood: without ink, a small mark is hardly less likely
        than blank paper.

        Returns
        -------
        other : int
            Its index.
        margin : float
            Energy that it explains, relative to its own.
        fit : float
            Energy that it explains, as a fraction of the cell's.
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
        unit = measured.scale[at] * measured.level
        distance = float(measured.to_own[at] / unit)
        if target.character == BLANK:
            other, margin, fit = measured.nearest_in_blank(at)
            beyond = float(measured.to_all[at, other] / unit)
        else:
            allowed = is_numeric if target.name else is_letter
            other, fit = measured.nearest_other(at, allowed), 0.0
            beyond = float(measured.to_all[at, other] / unit)
            if digit and not measured.is_alone[at]:
                beyond = 1.0  # as far from that digit as is usual
            margin = min(distance, FOREIGN) - beyond
        name = characters[other]
        if digit and not measured.is_alone[at]:
            name = digit
            other = characters.index(digit) if digit in characters else other
        cell = Cell(
            target.place,
            target.name,
            target.character,
            margin,
            name,
            distance=distance,
            other_distance=beyond,
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
    is_far = of_number & ~measured.is_alone & (measured.relative > FOREIGN * measured.level)
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
    specks = sum(cell.other in _SMALL and cell.margin > INKED for cell in blanks)
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


_IDENTICAL = (Verdict.IDENTICAL, Verdict.IDENTICAL_AS_READ)


class Objection(Enum):
    """What stands against the verdict of a printout's cells: the verdicts that it overrules, and
    the one in their place. Others stay."""

    MORE = ((Verdict.IDENTICAL,), Verdict.IDENTICAL_AS_READ)
    """The page shows more than the program prints: a mark, a row twice or in another typeface, or
    an order of its own."""
    OTHERWISE = (_IDENTICAL, Verdict.DIFFERS)
    """It shows otherwise: rows in each other's place, typed text with another number."""
    MISREAD = ((Verdict.DIFFERS,), Verdict.INCOMPLETE)
    """What differs may be misread: it is in another typeface, or beside what was not read."""
    DISAGREEING = (_IDENTICAL, Verdict.INCOMPLETE)
    """The text in the file is not that of its picture."""

    def overrule(self, verdict: Verdict) -> Verdict:
        """Return the verdict that is left of one."""
        overruled, left = self.value
        return left if verdict in overruled else verdict


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

    def overrule(self, objection: Objection, reason: str = "") -> None:
        """Replace the verdict if the objection overrules it, with a reason."""
        left = objection.overrule(self.verdict)
        if left is not self.verdict:
            self.verdict, self.reason = left, reason or self.reason


def judge_cells(sheet: Sheet, candidate: Candidate, cells: Sequence[Cell]) -> CellJudgement:
    """Return the verdict on one printout, from its cells as compared with the scene's page.

    It differs where other characters than the predicted ones explain a few cells, and hardly any
    are left unexplained.
    """
    differing = [cell for cell in cells if state(cell) == "differs"]
    doubtful = [cell for cell in cells if state(cell) == "doubtful"]
    spins = "WAF" in candidate.outcome.fields
    unexplained = sum(cell.cut or cell.distance > FOREIGN for cell in doubtful)
    misread = candidate.cost / MAX_CELL_COST - len(differing)
    is_legible = len(differing) <= MAX_DIFFERING and unexplained <= MAX_DIFFERING
    reason = ""
    if not sheet.whole:
        reason = "lines of the printout were not found"
    elif not is_legible:
        reason = "too few characters could be read with certainty"
    elif candidate.outcome.ending is not None or spins is not (13 in sheet.rows):
        reason = "the final spins were not found"
    elif differing and all(_may_be_spelling(cell, [*differing, *doubtful]) for cell in differing):
        reason = "a reply was typed differently than expected"
    if reason:
        differing = differing if is_legible else []
        return CellJudgement(Verdict.INCOMPLETE, differing, doubtful, reason, is_legible)
    verdict = Verdict.IDENTICAL
    if differing:
        is_sure = misread <= MAX_MISREAD and unexplained <= MAX_BLOTS
        verdict = Verdict.DIFFERS if is_sure else Verdict.INCOMPLETE
    elif doubtful:
        is_settled = all(map(_is_slight, doubtful))
        verdict = Verdict.IDENTICAL_AS_READ if is_settled else Verdict.INCOMPLETE
    return CellJudgement(verdict, differing, doubtful)


def state(cell: Cell) -> str:
    """Return the state of a cell: ``holds``, ``doubtful`` or ``differs``."""
    if cell.cut:
        return "doubtful" if cell.name and cell.predicted != BLANK else "holds"
    if cell.predicted == BLANK:
        if cell.added is Added.CHARACTER:
            return "differs"
        return "doubtful" if cell.name and cell.margin > INKED else "holds"
    # a letter beyond all characters is in doubt only where another is nearer still
    is_near = cell.distance < (FOREIGN if cell.name else max(FOREIGN, cell.other_distance))
    if cell.margin < HOLDS and is_near:
        return "holds"
    # another letter of a label, and a digit in another typeface, only where the page has both or
    # the predicted one elsewhere; a mark of little ink may come and go
    is_known = min(cell.count, cell.other_count) > 2 and cell.other != BLANK
    is_seen = cell.count > 1 if cell.foreign_digit else bool(cell.name) or is_known
    is_mark = cell.predicted in _MARKS and cell.other in f"{BLANK}.,-"
    if cell.margin < DIFFERS or cell.lost or is_mark or not is_seen:
        return "doubtful"
    return "differs"


def appearance(cell: Cell) -> str:
    """Return how a cell that does not hold looks, beside what the program prints there."""
    printed, other = (
        "a blank" if character == BLANK else repr(character)
        for character in (cell.predicted, cell.other)
    )
    if cell.cut:
        seen = "is beyond the edge of the page"
    elif cell.predicted == BLANK or state(cell) == "differs":
        seen = f"shows {other}"
    elif cell.margin < HOLDS:
        seen = "is like no character of the page"
    elif cell.other == BLANK:
        seen = "is blank" if cell.margin > DIFFERS else "is hardly inked"
    else:
        seen = f"is {'more' if cell.margin > DIFFERS else 'nearly as much'} like {other}"
        if cell.margin <= DIFFERS:
            return f"{seen} as {printed}, which the program prints there"
    return f"{seen} where the program prints {printed}"


def cells_text(cells: Sequence[Cell]) -> str:
    """Return the text in cells that were compared with the page."""
    return "".join(cell.other if state(cell) == "differs" else cell.predicted for cell in cells)


def _may_be_spelling(cell: Cell, questioned: Sequence[Cell]) -> bool:
    """Return True for a cell of a reply that differs in several cells, or in a mark.

    A reply without a point may have one, blanks or a sign: that moves what follows, and the page is
    left open. What was typed never outranks what was printed.
    ``questioned``: the printout's cells that differ or are in doubt.
    """
    is_one_of_several = sum(other.name == cell.name for other in questioned) > 1
    of_digits = cell.predicted.isdigit() and cell.other.isdigit()
    return cell.name.startswith("REPLY") and (is_one_of_several or not of_digits)


def _is_slight(cell: Cell) -> bool:
    """Return True for a doubt about a mark, a speck or a label, which leaves every digit certain.

    A digit is not certain that may be another, or is like nothing on the page; nor is a sign or
    point that is gone, but where the page's ink comes and goes.
    """
    is_mark = cell.predicted in _MARKS
    if cell.name and cell.predicted == "-" and cell.margin > DIFFERS:
        return False
    if cell.lost and (not cell.name or is_mark):
        return True
    if cell.predicted == BLANK:
        return cell.margin < INKED_SMALL
    if not cell.name or (is_mark and cell.other in _MARKS):
        return cell.margin < DIFFERS
    # A digit beyond an edge of the picture, or a mark far from its mean: slight
    return (is_mark or cell.distance < FOREIGN) and not cell.foreign_digit and cell.margin < HOLDS
