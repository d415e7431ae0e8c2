"""The page held against the grid: every cell against the character the program prints there.

The mean glyphs are made under the *predicted* names, each cell left out of its own mean. A cell's
margin is how far it is from its predicted mean beyond its distance from the nearest other,
relative to how far those two means are apart: -1 is the predicted glyph itself, +1 the other.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import product

import numpy as np

from ..fields import REPLIES
from .grid import Grid
from .layout import SPACED, Place, parts
from .scenes import Candidate, Read
from .typeface import BLANK, READABLE, distances, hands_of, sample_of, typeface_of

_NOISE = 3.0
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
_BESIDE = 2
"""Blank cells that are looked at after the last character of a line."""


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


def predicted(read: Read, candidate: Candidate) -> Iterator[tuple[str, str, Place]]:
    """The characters of the program's page for a scene: field, character, place."""
    for line, row in read.sheet.rows.items():
        column = 0
        for piece, (name, text) in zip(read.sheet.pieces[line], parts(row.text), strict=True):
            shown = candidate.outcome.fields.get(name, "") if name else text
            if name.startswith("REPLY"):
                shown = reply_of(read, name, candidate.scene)
            if line in SPACED:  # its gaps are what they are
                column = row.column(piece.places[0]) if piece.places else column
                longer = bool(name) and len(shown) == len(piece.places) + 1
                if longer and read.cost(name, shown[1:]) < read.cost(name, shown[:-1]):
                    column -= 1  # its sign was taken for a blank
            if not name and not text.strip():
                shown = BLANK * len(piece.places)
            for character in shown:
                yield name, character, row.place(column)
                column += 1
        for beyond in range(column, column + _BESIDE):
            yield "", BLANK, row.place(beyond)


def reply_of(read: Read, name: str, scene: dict[str, str]) -> str:
    """What was typed at a prompt to give the scene's velocities: of the ways to write them as many
    characters as stand there, the one that fits best."""
    written = [_written(scene[one]) for one in REPLIES[name[-1]]]
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
    rows = [(which, *one) for which, pair in enumerate(known) for one in predicted(*pair)]
    every = np.arange(len(rows))
    names = np.array([character for _, _, character, _ in rows])
    of_number = np.array([bool(field) for _, field, _, _ in rows])
    cut = [
        not grid.shows(*place) or known[which][0].sheet.beyond(place) for which, *_, place in rows
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
            one, weight = distances(sample.at(np.array([cell])), mean[None])
            distance[cell], ink[cell] = one[0, 0], weight[0, 0]
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
        margin, seen = float(margins[other]), characters[other]
        if hands[cell] and not alone[cell]:
            seen = hands[cell]
            other = index.get(seen, other)
        beyond = float(apart[cell, other] / max(usual[cell], 1e-6) / level)
        count = counts[own[cell]], counts[other] if seen == characters[other] else 0
        lost = pale and characters[other] == BLANK
        compared = margin, seen, float(relative[cell] / level), beyond, *count
        measured = Cell(place, name, character, *compared, hands[cell], cut[cell], lost)
        cells[which].append(measured)
    return cells
