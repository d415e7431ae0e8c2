"""The page held against the grid: every cell against the character the program prints there.

The mean glyphs are made under the *predicted* names, each cell left out of its own mean. A cell's
margin is how far it is from its predicted mean beyond its distance from the nearest other,
relative to how far those two means are apart: -1 is the predicted glyph itself, +1 the other.
What verdicts come of margins is counted in `rates`.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from enum import Enum
from itertools import product
from operator import attrgetter

import numpy as np

from ...collision.fields import REPLIES
from ..judging.judgement import Verdict
from .grid import Grid
from .layout import SPACED, Place, Sheet
from .scenes import WORST, Candidate, Read
from .typeface import BLANK, READABLE, distances, hands_of, sample_of, typeface_of

_NOISE = 3.0  # usual distances that means are apart at least; doubled, 5 verdicts of 5 stay
_LEAST_NOISE = 0.1
"""The usual distance of a cell from its mean on an excellent scan, in units of the root of its
energy; pages drawn by a program have 0.01 to 0.04, and there any other hand is a hundred times as
far as is usual."""
_FAR = 10.0
"""From how many times the usual distance a cell is compared with all known styles: digits drawn in
another font are farther."""
_EVEN = 0.8
"""The strength of ink, 1 for the page's usual, that 99 % of the cells have on evenly inked paper:
0.82 and more on seven pages of which a digit was erased, 0.4 to 0.75 on those that lost some."""


class Added(Enum):
    """What stands where the program prints a blank."""

    NOTHING = 0
    CHARACTER = 1
    """In a line, or at its end: it changes a number or a label."""
    TYPE = 2
    """Typed text beside a line, or at a reply."""
    MARK = 3
    """Ink like no character of the page."""


@dataclass
class Cell:
    """One cell held against the page. ``name``: its field, "" for labels; ``other``: the nearest
    other character; ``distance``, ``other_distance``: from the two means, 1 for what is usual on
    this page; ``count``, ``other_count``: on how many cells those rest; ``hand``: what a cell far
    from the predicted mean, or alone with it, is in a known style of type, if another digit;
    ``cut``: beyond an edge of the picture; ``lost``: blank on a page whose ink comes and goes."""

    place: Place
    name: str
    predicted: str
    margin: float
    other: str
    distance: float
    other_distance: float
    count: int
    other_count: int
    hand: str = ""
    cut: bool = False
    lost: bool = False
    fit: float = 0.0
    added: Added = Added.NOTHING


def predicted(read: Read, candidate: Candidate) -> Iterator[tuple[str, str, Place]]:
    """The characters of the program's page for a scene: field, character, place."""
    for line, row in read.sheet.rows.items():
        column = 0
        for name, text, places in row.pieces:
            shown = candidate.outcome.fields.get(name, "") if name else text
            if name.startswith("REPLY"):
                shown = reply_of(read, name, candidate.scene)
            if line in SPACED:  # its gaps are what they are
                column = row.column(places[0]) if places else column
                column += read.shift(name, shown) if name else 0
            if not name and not text.strip():
                shown = BLANK * len(places)
            for character in shown:
                yield name, character, row.place(column)
                column += 1


def _blanks(grid: Grid, sheet: Sheet, inked: set[Place]) -> Iterator[tuple[str, str, Place]]:
    """The cells of a printout's lines in which the program prints nothing."""
    for row in sheet.rows.values():
        for line in range(row.start, row.start + row.used):
            for cell in range(len(grid.corners[line]) - 1):
                if (place := Place(line, cell)) not in inked:
                    yield "", BLANK, place


def reply_of(read: Read, name: str, scene: dict[str, str]) -> str:
    """What was typed at a prompt to give the scene's velocities: of the ways to write them as many
    characters as stand there, the one that fits best."""
    written = [_written(scene[symbol]) for symbol in REPLIES[name[-1]]]
    ways = [comma.join(three) for three in product(*written) for comma in (",", ", ")]
    length = len(read.costs[name])
    return min(ways, key=lambda way: read.cost(name, way) + abs(len(way) - length))


def _written(text: str) -> list[str]:
    """A number as people type it: with or without the nought before the point, noughts after."""
    if "E" in text:
        return [text, *_written(format(Decimal(text), "f"))]
    sign, digits = ("-", text[1:]) if text.startswith("-") else ("", text)
    whole, point, part = digits.partition(".")
    if not point:
        return [text, f"{text}.0"]
    wholes, short = {whole, whole.lstrip("0"), whole or "0"}, part.rstrip("0")
    ways = {
        f"{sign}{w}.{p}" if p else f"{sign}{w or '0'}"
        for w in wholes
        for p in (part, short, f"{short}0")
    }
    return sorted(ways, key=lambda way: (way != text, way))


def held(grid: Grid, known: Sequence[tuple[Read, Candidate]]) -> list[list[Cell]]:
    """Every cell of each printout's predicted page, with its margin."""
    if not known:
        return []
    rows: list[tuple[int, str, str, Place]] = []
    for which, pair in enumerate(known):
        printed = [*predicted(*pair)]
        places = {place for *_, place in printed}
        blanks = _blanks(grid, pair[0].sheet, places)
        rows += [(which, *row) for row in (*printed, *blanks)]
    every = np.arange(len(rows))
    names = np.array([character for _, _, character, _ in rows])
    of_number = np.array([bool(name) for _, name, _, _ in rows])
    cut = [
        not grid.shows(*place) or (character != BLANK and known[which][0].sheet.beyond(place))
        for which, _, character, place in rows
    ]
    sample = sample_of(grid, [place for *_, place in rows])
    typeface = typeface_of(sample, np.where(cut, "", names).tolist())
    characters, counts = [*typeface.characters, BLANK], [*typeface.counts.tolist(), 0]
    index = {character: k for k, character in enumerate(characters)}
    own = np.array([index.get(name, len(characters) - 1) for name in names])
    apart, strength = distances(sample, typeface.means)
    apart = np.column_stack([apart, sample.norms.min(axis=1).astype(float)])
    ink = np.column_stack([strength, np.ones(len(rows))])[every, own]
    energy = np.r_[np.einsum("mp,mp->m", typeface.means, typeface.means), 0.0]
    between = typeface.between()
    distance = apart[every, own].copy()
    alone = np.zeros(len(rows), bool)
    for cell in np.flatnonzero(names != BLANK).tolist():
        mean = typeface.without(cell)
        if mean is None:
            alone[cell] = True
        else:
            far, weight = distances(sample.at(np.array([cell])), mean[None])
            distance[cell], ink[cell] = far[0, 0], weight[0, 0]
    pale = bool(np.percentile(ink[~np.isin(names, list(" .,-"))], 1) < _EVEN)
    # what is weakly inked is as far from every mean as its ink allows
    distance, apart = distance / ink**2, apart / ink[:, None] ** 2
    usual = np.sqrt(np.maximum(energy[own], 1.0))
    relative = distance / usual
    others = relative[(names != BLANK) & ~alone]
    level = max(float(np.median(others)), _LEAST_NOISE)
    distance[alone] = float(np.percentile(others, 75)) * usual[alone]
    numeric = np.array([character in READABLE for character in characters])
    letters = np.array([character.isalpha() or character == BLANK for character in characters])
    far = of_number & ~alone & (relative > _FAR * level)
    hands = hands_of(sample, typeface, names.tolist(), alone & of_number, far)
    cells: list[list[Cell]] = [[] for _ in known]
    for cell, (which, name, character, place) in enumerate(rows):
        allowed = (numeric if name or character == BLANK else letters).copy()
        allowed[own[cell]] = False
        # means as near each other as the cells are to their own say nothing
        step = np.maximum(between[own[cell]], _NOISE * level * usual[cell])
        if alone[cell]:
            step = np.maximum(step, apart[cell])
        margins = np.where(allowed, (distance[cell] - apart[cell]) / step, -np.inf)
        other = int(np.argmax(margins))
        fit = 0.0
        if character == BLANK:
            # of little marks each is near in its own small step: the nearest in ink counts
            other = int(np.argmin(apart[cell, :-1]))
            gain = float(distance[cell] - apart[cell, other])
            margins[other] = gain / max(float(energy[other]), 1e-6)
            fit = gain / max(float(distance[cell]), 1e-6)
        margin, seen = float(margins[other]), characters[other]
        if hands[cell] and not alone[cell]:
            seen = hands[cell]
            other = index.get(seen, other)
        beyond = float(apart[cell, other] / max(usual[cell], 1e-6) / level)
        count = counts[own[cell]], counts[other] if seen == characters[other] else 0
        lost = pale and characters[other] == BLANK
        compared = margin, seen, float(relative[cell] / level), beyond, *count
        measured = Cell(place, name, character, *compared, hands[cell], cut[cell], lost, fit)
        cells[which].append(measured)
    for own_cells in cells:
        own_cells.sort(key=attrgetter("place"))
        _find_added(own_cells)
    return cells


def _find_added(cells: Sequence[Cell]) -> None:
    """Say of the blanks of a printout which hold characters: those within a line or at its end are
    added to it, others are text beside it."""
    blanks = [cell for cell in cells if cell.predicted == BLANK and not (cell.name or cell.cut)]
    typed = {cell.place: cell for cell in blanks if _is_typed(cell)}
    # where several blanks hold a little ink, a mark as small may be a speck
    specks = sum(cell.other in _SMALL and cell.margin > SPECK for cell in blanks)
    for cell in blanks:
        if cell.place not in typed and cell.margin > INKED_SMALL:
            cell.added = Added.MARK
    printed = {cell.place: cell for cell in cells if cell.predicted != BLANK}
    for (line, at), run in _runs(typed):
        inked = [place.cell for place in printed if place.line == line]
        sides = [printed.get(Place(line, side)) for side in (at - 1, at + len(run))]
        names = [side.name for side in sides if side and side.name]
        within = bool(inked) and min(inked) < at < max(inked)
        changed = (within or any(sides)) and len(run) <= MOST_DIFFERING
        small = all(cell.other in _SMALL for cell in run)
        changed = changed and not (small and specks > MOST_SPECKS)
        reply = any(name.startswith("REPLY") for name in names)
        if changed and not reply and (within or names or at > min(inked)):
            for cell in run:
                cell.added = Added.CHARACTER
                cell.name = names[0] if names else ""
        else:
            for cell in run:
                cell.added = Added.TYPE


def _is_typed(cell: Cell) -> bool:
    """Whether a blank holds ink like a character of the page."""
    least = INKED_SMALL if cell.other in _SMALL else INKED
    return cell.margin > least and cell.fit > FIT and cell.other_count > 1


def _runs(cells: Mapping[Place, Cell]) -> Iterator[tuple[Place, list[Cell]]]:
    """Cells next to each other on a line, with the place of the first."""
    for place in sorted(cells):
        if Place(place.line, place.cell - 1) in cells:
            continue
        run, at = [cells[place]], place.cell + 1
        while Place(place.line, at) in cells:
            run.append(cells[Place(place.line, at)])
            at += 1
        yield place, run


INKED = 0.35  # margin of a blank cell from which it holds a character
INKED_SMALL = 0.5  # the same of a point, a comma, a dash, which are as light as specks
ERASED = 2.0  # margin from which a sign is not faint but gone; of genuine pages none exceeds 1
SPECK = 0.25  # margin of a blank from which a speck is seen in it
MOST_SPECKS = 2  # of a page on which a mark as small as a point is taken for one
FIT = 0.6  # the least part of the ink in a blank that the character explains
_SMALL = frozenset(".,-:'`*")
HOLDS, DIFFERS, LABEL, FOREIGN, KIND = -0.12, 0.3, 0.1, 20.0, 15.0
"""A cell with a smaller margin is the character predicted; one with a larger is another; a label
with a smaller margin holds; a cell this many times as
far from a mean as is usual was not made by that type; a label that is nearer than this to another
letter's mean is that letter. Chosen on 314 pages that were settled (160 scans and photographs, 154
drawn afterwards): of 42,572 digits none exceeds -0.23, of 427,482 trials of a digit as another of
its page two, of one photograph, are below +0.30 (+0.27). How pages fare that are offered, settled
or not, is counted in `rates`."""
MOST_DOUBTFUL, MOST_DIFFERING = 4, 4
"""Cells that may be doubtful on a page that is settled, or differ on one that is accused: with more
it was the reading that went wrong."""
MOST_MISREAD = 2 * WORST
"""What the first reading may contradict the scene beyond the cells that differ: 240 of 245 pages
that were altered stay within, three genuine ones that had been accused had 20 to 36."""
_MARKS = frozenset(".,-")
"""Characters of so little ink that a speck, or a faint pin, makes or unmakes them."""


@dataclass
class Judged:
    """A verdict with its reasons: the cells that differ and those in doubt, and a sentence where
    the page as a whole was not read."""

    verdict: Verdict
    differing: list[Cell] = field(default_factory=list)
    doubtful: list[Cell] = field(default_factory=list)
    reason: str = ""


def judged(sheet: Sheet, candidate: Candidate, cells: Sequence[Cell]) -> Judged:
    """The verdict on one printout of a page, whose cells were held against its scene."""
    differing = [cell for cell in cells if state(cell) == "differs"]
    doubtful = [cell for cell in cells if state(cell) == "doubtful"]
    spins = "WAF" in candidate.outcome.fields
    reason = ""
    if not sheet.whole:
        reason = "lines of the printout were not found"
    elif len(differing) + len(doubtful) > MOST_DIFFERING + MOST_DOUBTFUL:
        reason = "too little was read for certain"
    elif candidate.outcome.ending is not None or spins is not (13 in sheet.rows):
        reason = "the final spins were not found"
    elif differing and all(_retyped(cell, [*differing, *doubtful]) for cell in differing):
        reason = "a reply is typed otherwise than was expected"
    if reason:
        return Judged(Verdict.INCOMPLETE, differing, doubtful, reason)
    verdict, slight = Verdict.IDENTICAL, all(map(_slight, doubtful))
    if differing:
        misread = candidate.cost - WORST * len(differing)
        sure = slight and len(differing) <= MOST_DIFFERING and misread <= MOST_MISREAD
        verdict = Verdict.DIFFERS if sure else Verdict.INCOMPLETE
    elif doubtful:
        slight = slight and len(doubtful) <= MOST_DOUBTFUL
        verdict = Verdict.IDENTICAL_AS_READ if slight else Verdict.INCOMPLETE
    return Judged(verdict, differing, doubtful)


def state(cell: Cell) -> str:
    """``holds``, ``doubtful`` or ``differs``."""
    if cell.cut:
        return "doubtful" if cell.name and cell.predicted != BLANK else "holds"
    if cell.predicted == BLANK:
        if cell.added is Added.CHARACTER:
            return "differs"
        return "doubtful" if cell.name and cell.margin > INKED else "holds"
    if (cell.hand and cell.count < 2) or (cell.lost and cell.margin > HOLDS):
        return "doubtful"
    if not cell.name:
        if cell.margin < LABEL:
            return "holds"
        # another letter only where the page has it elsewhere and the cell is of its kind
        known = min(cell.count, cell.other_count) > 2 and cell.other != BLANK
        near = cell.other_distance < KIND and cell.distance > 2 * cell.other_distance
        return "differs" if known and near and cell.margin > 2 * DIFFERS else "doubtful"
    if cell.margin < HOLDS:
        return "holds" if cell.distance < FOREIGN else "doubtful"
    if cell.margin < DIFFERS or (cell.predicted in _MARKS and cell.other in f"{BLANK}.,-"):
        return "doubtful"
    # a blot is like nothing, another hand's digit like that of a known style
    return "differs" if cell.other_distance < FOREIGN or cell.hand else "doubtful"


def _retyped(cell: Cell, others: Sequence[Cell]) -> bool:
    """Whether a cell belongs to a reply that is another in several cells, or in a mark: one number
    can be typed in many ways, and what was typed never outranks what was printed."""
    several = sum(other.name == cell.name for other in others) > 1
    digits = cell.predicted.isdigit() and cell.other.isdigit()
    return cell.name.startswith("REPLY") and (several or not digits)


def _slight(cell: Cell) -> bool:
    """Whether a doubt leaves every digit beyond doubt: it is about a mark, a speck or a label. A
    digit that is like nothing on the page is in doubt, whatever it is least unlike."""
    mark = cell.predicted in _MARKS
    if cell.name and cell.predicted == "-" and cell.margin > ERASED:
        return False
    if cell.lost and (not cell.name or mark):
        return True
    if not cell.name or cell.predicted == BLANK or (mark and cell.other in _MARKS):
        return cell.margin < 0.5
    return (mark or cell.distance < FOREIGN) and not cell.hand and cell.margin < HOLDS
