"""Anchors: the labels that were read exactly, in the order of the program's page."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np

from .costs import ALIKE, SLIGHT, WRONG
from .glyphs import LINE_GAP, WIDE_GAP, Glyph, chars_of
from .page import CELLS, ROWS


class Label(NamedTuple):
    """A label of the program's page.

    Parameters
    ----------
    text : str
        Its characters, up to the equals sign.
    name : str
        The number, or numbers, after it, "" for asterisks.
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
        owned = [cell.name for cell in CELLS[end + 1 : end + 2] if cell.kind == "slot"]
        yield Label(text, "".join(owned), row, start, end + 1)


def _cost(label: Label, read: str) -> float:
    """Return the cost of a text in a label's place: less for one of the same row, as exchanged."""
    if label.text == read:
        return 0.0
    if label.text[-1] != read[-1]:
        return np.inf
    return WRONG / 2 if any(other.text == read for other in _labels_of(label.row)) else WRONG


LABELS = tuple(label for row in range(len(ROWS)) for label in _labels_of(row))
"""The labels of each row."""
ROW_SIZES = {label.text: len([*_labels_of(label.row)]) for label in LABELS}
"""Number of labels in the last row of each."""
_TEXTS = sorted({label.text for label in LABELS}, key=len, reverse=True)
_COSTS = {text: np.array([np.inf, *(_cost(label, text) for label in LABELS)]) for text in _TEXTS}
"""Cost of each text in each label's place."""
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
    out costs less: as much as one out of order, or half of that for all of a line that lacks some
    of its row. Of equal ways that which leaves out the last. One beside such a note with the same
    label is not read exactly: either may be the note.
    """
    labels = find_labels(glyphs)
    sums = np.append(0.0, np.full(len(LABELS), np.inf))
    ways: list[list[int]] = [[]] * len(sums)  # the place of each label up to one, 0 for a note's
    for (text, *_), note_cost in zip(labels, _note_costs(labels, glyphs), strict=True):
        steps = sums[:, None] + _STEPS
        placed = steps.min(axis=0) + _COSTS[text]
        noted = sums + (note_cost if text.endswith("=") else np.inf)
        ways = [
            [*ways[at], 0] if is_note else [*ways[before], at]
            for at, (is_note, before) in enumerate(
                zip((noted <= placed).tolist(), steps.argmin(axis=0).tolist(), strict=True)
            )
        ]
        sums = np.minimum(noted, placed)
    places = ways[int((sums - SLIGHT * np.arange(len(sums))).argmin())]  # passing over the rest
    notes = ["", *("" if at else text for at, (text, *_) in zip(places, labels, strict=True)), ""]
    return [
        Anchor(LABELS[at - 1], "" if text in (notes[k], notes[k + 2]) else text, start, stop)
        for k, (at, (text, start, stop)) in enumerate(zip(places, labels, strict=True))
        if at
    ]


def _note_costs(labels: Sequence[tuple[str, int, int]], glyphs: Sequence[Glyph]) -> Iterator[float]:
    """Yield the cost that each label is a note's: less where its line lacks some of a row."""
    lines = np.cumsum([glyph.gap == LINE_GAP for glyph in glyphs]).tolist()
    for _, line in groupby(labels, lambda label: lines[label[1]]):
        texts = [text for text, *_ in line]
        is_part = len(texts) < min(ROW_SIZES[text] for text in texts)
        yield from [WRONG / (2 * len(texts)) if is_part else WRONG] * len(texts)
