"""Anchors: the labels that were read exactly, in the order of the program's page."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .costs import ALIKE, SLIGHT, WRONG
from .glyphs import LINE_GAP, LOOKALIKES, WIDE_GAP, Glyph, chars_of, split_at_gaps
from .page import CELLS, ROWS


class Label(NamedTuple):
    """A label of the program's page.

    Parameters
    ----------
    text : str
        Its characters, up to the equals sign.
    name : str
        The number after it, "" for asterisks.
    row : int
        Its row.
    start, stop : int
        Its cells.
    """

    text: str
    name: str
    row: int
    start: int
    stop: int


class Anchor(NamedTuple):
    """A label of the page where it was read.

    Parameters
    ----------
    label : Label
        The label of the page.
    read : str
        The label that was read, which may be another; "" if a note beside it has the same.
    start, stop : int
        Its glyphs.
    """

    label: Label
    read: str
    start: int
    stop: int


def _labels_of(row: int) -> Iterator[Label]:
    """Yield the labels of a row: each up to an equals sign, or all that is printed."""
    cells = [j for j, cell in enumerate(CELLS) if cell.row == row and cell.char]
    ends = [j for j in cells if CELLS[j].char == "="]
    for end in ends or cells[-1:]:
        start = max(j for j in cells if j < end and CELLS[j].first) if ends else cells[0]
        text = "".join(cell.char for cell in CELLS[start : end + 1])
        yield Label(text, CELLS[end].name, row, start, end + 1)


LABELS = tuple(label for row in range(len(ROWS)) for label in _labels_of(row))
"""The labels of each row."""
ROW_SIZES = Counter(label.row for label in LABELS)
_TEXTS = sorted({label.text for label in LABELS}, key=len, reverse=True)
LABEL = re.compile("|".join(map(re.escape, _TEXTS)))
WORDS = re.compile("[A-Z]{3}")
_AHEAD = np.subtract.outer(np.arange(len(LABELS) + 1), np.arange(len(LABELS) + 1)).T
_STEPS = np.where(
    _AHEAD > 0, SLIGHT * (_AHEAD - 1), WRONG - SLIGHT * _AHEAD + ALIKE * (_AHEAD == 0)
)
"""Cost of each label (column) after each other (row); the first is none, before the page."""


def find_labels(glyphs: Sequence[Glyph]) -> list[tuple[str, int, int]]:
    """Return the labels that were read exactly: text, first glyph, end.

    No letter is right before one, and no blank in it; a prompt or the heading of the angles may be
    broken anywhere.
    """
    text = chars_of(glyphs)
    labels = []
    for match in LABEL.finditer(text):
        a, b = match.span()
        is_free = not a or glyphs[a].gap or not text[a - 1].isalpha()
        inner = [glyph.gap for glyph in glyphs[a + 1 : b]]
        is_whole = not match[0].endswith("=") or not (any(inner[:-1]) or inner[-1] >= WIDE_GAP)
        if is_free and is_whole:
            labels.append((match[0], a, b))
    return labels


def is_note(line: Sequence[Glyph]) -> bool:
    """Return True for a line with words and a single label."""
    labels = find_labels(line)
    is_single = len(labels) == 1 and labels[0][0].endswith("=")
    return is_single and bool(WORDS.search(LABEL.sub(" ", chars_of(line))))


def find_anchors(glyphs: Sequence[Glyph]) -> list[Anchor]:
    """Return the labels that were read where they are on the page, without those of notes.

    The cheapest way to place labels on the page (Viterbi, 1967). A label that two rows have is that
    of the row in order; one in another's place is that one. A label is a note's where leaving it
    out costs less: as much as one out of order, or half of that for the single one of a line. Of
    equal ways that which leaves out the last. One beside such a note with the same label is not
    read exactly: either may be the note.
    """
    labels = find_labels(glyphs)
    limits: list[float] = []
    for line in split_at_gaps(glyphs, LINE_GAP):
        limits += [_note_cost(line)] * len(line)
    sums = np.append(0.0, np.full(len(LABELS), np.inf))
    ways = []
    for (text, start, _), costs in zip(labels, _costs_of(labels), strict=True):
        steps = sums[:, None] + _STEPS
        placed = steps.min(axis=0) + costs
        noted = sums + (limits[start] if text.endswith("=") else np.inf)
        ways.append(np.where(noted <= placed, -1, steps.argmin(axis=0)).tolist())
        sums = np.minimum(noted, placed)
    places = []
    at = int((sums - SLIGHT * np.arange(len(sums))).argmin())  # passing over those after it
    for way in reversed(ways):
        is_placed = way[at] >= 0
        places.append(at * is_placed)
        at = way[at] if is_placed else at
    places.reverse()
    notes = ["", *("" if at else text for at, (text, *_) in zip(places, labels, strict=True)), ""]
    return [
        Anchor(LABELS[at - 1], "" if text in (notes[k], notes[k + 2]) else text, start, stop)
        for k, (at, (text, start, stop)) in enumerate(zip(places, labels, strict=True))
        if at
    ]


def _note_cost(line: Sequence[Glyph]) -> float:
    """Return the cost that a label of a line is a note's: less where the line lacks labels."""
    texts = [label[0] for label in find_labels(line)]
    rows = Counter(label.row for label in LABELS if label.text in texts)
    best = [row for row, count in rows.items() if count == max(rows.values())]
    size = min((ROW_SIZES[row] for row in best), default=0)
    return WRONG / (2 * len(texts)) if len(texts) < size else WRONG


def _costs_of(labels: Sequence[tuple[str, int, int]]) -> NDArray[np.float64]:
    """Return the cost of each label that was read in each label's place, after that of none.

    Two of a row that were exchanged cost as much as one.
    """
    texts = [label[0] for label in labels]
    costs = np.array(
        [[np.inf, *(_label_cost(label.text, text) for label in LABELS)] for text in texts]
    )
    for k, pair in enumerate(pairwise(texts)):
        for j, (first, second) in enumerate(pairwise(LABELS), 1):
            if first.row == second.row and (second.text, first.text) == pair:
                costs[k, j] = costs[k + 1, j + 1] = WRONG / 2
    return costs


@lru_cache(maxsize=10_000)
def _label_cost(label: str, read: str) -> float:
    """Return the cost that a label was read as another."""
    if label == read:
        return 0.0
    if not (label[-1] == read[-1] == "="):
        return 99.0
    changes = [(a, b) for a, b in zip(label, read, strict=False) if a != b]
    is_alike = len(label) == len(read) and all(b in LOOKALIKES.get(a, "") for a, b in changes)
    return ALIKE if is_alike and len(changes) == 1 else WRONG
