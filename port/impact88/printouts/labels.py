"""Anchors: the labels that were read exactly, in the order of the program's page."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from .costs import ALIKE, SLIGHT, UNPAIRED, WRONG
from .glyphs import LINE_GAP, LOOKALIKES, WIDE_GAP, Glyph, chars_of, split_at_gaps
from .page import ASTERISKS, CELLS, ROWS


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
        The label that was read, which may be another.
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
_TEXTS = sorted({label.text for label in LABELS}, key=len, reverse=True)
LABEL = re.compile("|".join(map(re.escape, _TEXTS)))
CLOSED = re.compile(r"[-+.E0-9]{1,14}\)")
"""The number of a label in brackets."""
WORDS = re.compile("[A-Z]{3}")
_BACK = -np.subtract.outer(np.arange(len(LABELS)), np.arange(len(LABELS)))
_STEPS = np.where(_BACK > 0, SLIGHT * (_BACK - 1), WRONG - SLIGHT * _BACK + ALIKE * (_BACK == 0))
"""Cost of each label (column) after each other (row)."""


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
    """Return the anchors of a page, without the labels of notes.

    Without the label of a note the others are in better order: by a label out of order, or by half
    of that for the single one in a line with words. One in another's place leaves that one lost.
    """
    labels = find_labels(glyphs)
    cost, anchors = _order(glyphs, labels)
    start = 0
    for line in split_at_gaps(glyphs, LINE_GAP):
        stop = start + len(line)
        limit = WRONG / 2 if is_note(line) else WRONG
        for note in [label for label in reversed(labels) if start <= label[1] < stop]:
            further = [label for label in labels if label != note]
            if cost > limit and note[0].endswith("=") and _order(glyphs, further)[0] < cost - limit:
                labels = further
                cost, anchors = _order(glyphs, labels)
        start = stop
    return anchors


def _order(
    glyphs: Sequence[Glyph], labels: Sequence[tuple[str, int, int]]
) -> tuple[float, list[Anchor]]:
    """Return the cheapest way to place labels on the page, and its cost (Viterbi, 1967).

    A label that two rows have is that of the row in order; one in another's place is that one. Two
    labels beside each other that were exchanged are each in the other's place.
    """
    costs = SLIGHT * np.arange(len(LABELS))
    ways = []
    sums = costs
    chars = chars_of(glyphs)
    for text, start, stop in labels:
        is_bracketed = chars[:start].endswith("(") or bool(CLOSED.match(chars, stop))
        sums = costs + [_label_cost(label, text, is_bracketed) for label in LABELS]
        steps = sums[:, None] + _STEPS
        ways.append(steps.argmin(axis=0))
        costs = steps.min(axis=0)
    at = int(sums.argmin())
    order: list[int] = []
    for k in range(len(labels) - 1, -1, -1):
        order.insert(0, at)
        at = int(ways[k - 1][at]) if k else 0
    cost = float(sums.min())
    for k, (first, second) in enumerate(pairwise([*order])):
        is_single = order.count(first) == order.count(second) == 1
        is_exchanged = first == second + 1 and LABELS[first].row == LABELS[second].row
        if is_single and is_exchanged:
            order[k : k + 2] = second, first
            cost -= WRONG
    return cost, [Anchor(LABELS[at], *label) for at, label in zip(order, labels, strict=True)]


@lru_cache(maxsize=10_000)
def _label_cost(label: Label, read: str, is_bracketed: bool) -> float:
    """Return the cost that a label was read as another, or with a bracket too many or few."""
    cost = 0.0
    if label.name[:1] in ("X", "Y") and is_bracketed != (label.row > ASTERISKS[0]):
        cost = UNPAIRED / 3
    if label.text == read:
        return cost
    if not (label.text[-1] == read[-1] == "="):
        return 99.0
    changes = [(a, b) for a, b in zip(label.text, read, strict=False) if a != b]
    is_alike = len(label.text) == len(read) and all(b in LOOKALIKES.get(a, "") for a, b in changes)
    return cost + (ALIKE + UNPAIRED / 3 if is_alike and len(changes) == 1 else WRONG)
