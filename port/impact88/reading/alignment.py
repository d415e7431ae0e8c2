"""Aligning a text with the program's page by dynamic programming.

The page is a known template seen through noise, so the text is read as the cheapest way through its
states: a glyph opens the next state or stays in one, states may be missed, whole lines may be
missing, and text outside costs little. One forward pass over the text (numpy rows over the states),
one trace back; memory is bounded by reading long texts in windows, so time grows as the text does.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from .glyphs import Glyph
from .template import ANGLE_ROW, RESULTS, WITHIN, code, template

WINDOW = 9000
"""Glyphs aligned at a time: a dozen printouts."""
_BEGIN, _END = 2.2, 0.8
"""What it costs that a printout begins or ends."""
_WITHIN = 6.0
"""What it costs more that one begins with the angles, which numbers in a note look like."""
_BIG = 1e6
_FIGURES = frozenset("0123456789.")


@dataclass
class Budget:
    """How much text is read: ``left`` glyphs more, as many again for every page found;
    ``stopped``: the glyph at which it was spent, none where it was not."""

    left: int = 25_000
    stopped: int | None = None

    @property
    def spent(self) -> bool:
        """Whether reading stopped."""
        return self.stopped is not None

    def spend(self, count: int, found: bool) -> None:
        """Read so many glyphs more."""
        self.left = Budget.left if found else self.left - count


_PAGE = 150
"""Glyphs that are a page; the shortest run has 320, and labels without end are none."""
_LABELS = re.compile("=|VAX|VAY|VBX|VBY|LOSS|M[AB]|[IDPTWXY][AB]|[UV][XY]")
_FEW_LABELS = 4
"""Fewer labels and equals signs in a window than these, and no printout is in it."""


@dataclass
class Aligned:
    """One printout's part of the text: ``slots``, field -> glyphs ``(start, stop)`` in its place;
    ``states``, the template's state of every glyph from ``start`` on."""

    start: int
    stop: int
    states: list[int]
    slots: dict[str, tuple[int, int]]


def align(glyphs: Sequence[Glyph], budget: Budget | None = None) -> Iterator[Aligned]:
    """The printouts in a row of glyphs, in order, each with what its glyphs are taken for; as many
    as the budget allows."""
    start = 0
    budget = budget or Budget()
    while start < len(glyphs):
        window = glyphs[start : start + WINDOW]
        last = start + len(window) >= len(glyphs)
        if len(_LABELS.findall("".join(glyph.char for glyph in window))) < _FEW_LABELS:
            start += len(window)
            continue
        if budget.left <= 0:
            budget.stopped = start
            return
        parts = _merged(_parts(_states(window)))
        taken = parts if last else parts[:-1] or parts[:1]
        budget.spend(len(window), any(stop - begin >= _PAGE for begin, stop, _ in taken))
        for part in taken:
            yield _described(*part, start)
        if last:
            return
        if not parts:
            start += len(window)
        elif len(parts) == 1:
            start += max(parts[0][1], 1)
        else:
            start += parts[-1][0]


def _described(start: int, stop: int, states: list[int], offset: int) -> Aligned:
    """A part of the states as one printout's."""
    page = template()
    slots: dict[str, tuple[int, int]] = {}
    for index, state in enumerate(states, offset + start):
        if (name := page.slots.get(state)) is not None:
            slots[name] = (slots.get(name, (index, 0))[0], index + 1)
    return Aligned(offset + start, offset + stop, states, slots)


def _parts(states: Sequence[int]) -> list[tuple[int, int, list[int]]]:
    """The stretches of glyphs inside printouts: start, stop, states. The template only goes
    forward, so a state below the one before it begins another printout."""
    parts: list[tuple[int, int, list[int]]] = []
    start = -1
    for index, state in enumerate([*states, 0]):
        inside = state > 0
        if start >= 0 and (not inside or state < states[index - 1]):
            parts.append((start, index, list(states[start:index])))
            start = -1
        if inside and start < 0:
            start = index
    return parts


def _merged(parts: list[tuple[int, int, list[int]]]) -> list[tuple[int, int, list[int]]]:
    """Parts that go on where the one before left off are one printout, with something between."""
    line = template().line
    merged: list[tuple[int, int, list[int]]] = []
    for start, stop, states in parts:
        if merged:
            before = merged[-1]
            ends, begins = line[before[2][-1]], line[states[0]]
            goes_on = ends < begins and not (ends < RESULTS <= begins and start - before[1] > 600)
            if goes_on and start - before[1] < 1500:
                between = [0] * (start - before[1])
                merged[-1] = (before[0], stop, [*before[2], *between, *states])
                continue
        merged.append((start, stop, states))
    return merged


def _gaps(glyphs: Sequence[Glyph]) -> list[int]:
    """The gap before every glyph, and whether it stands within figures."""
    gaps = []
    before = ""
    for place, glyph in enumerate(glyphs):
        gap = 0 if glyph.wrapped else int(glyph.gap)
        figures = glyph.char in _FIGURES or _exponent(glyphs[place : place + 3])
        gaps.append(WITHIN if figures and before in _FIGURES and not gap else gap)
        before = glyph.char
    return gaps


def _exponent(glyphs: Sequence[Glyph]) -> bool:
    """Whether glyphs are the E of an exponent, its sign and a digit, in one piece."""
    mark, *rest = glyphs
    if mark.char != "E" or len(rest) < 2 or any(glyph.gap for glyph in rest):
        return False
    return rest[0].char in "+-" and rest[1].char.isdigit()


def _states(glyphs: Sequence[Glyph]) -> list[int]:
    """The state of every glyph on the cheapest way."""
    page = template()
    size = page.miss.size
    count = len(glyphs)
    codes = [code(glyph.char) for glyph in glyphs]
    gaps = _gaps(glyphs)
    enter = {
        key: page.enter[key[0]] + page.gap_enter[key[1]]
        for key in set(zip(codes, gaps, strict=True))
    }
    stay = {key: page.stay[key[0]] + page.gap_stay[key[1]] for key in enter}
    missed = np.cumsum(page.miss)
    missed_line = np.concatenate([[0], np.cumsum(page.absent[:-1])])
    between = page.between
    index = np.arange(size, dtype=np.int16)
    lines = np.arange(between.size, dtype=np.int16)
    exits = np.flatnonzero(page.closes)
    labelled = page.unlabelled[0, 1:] > 0
    numbered = np.zeros(size, bool)
    numbered[list(page.slots)] = True
    begin = np.full(between.size, _BEGIN)
    begin[ANGLE_ROW - 1 : ANGLE_ROW + 1] += _WITHIN
    # what is needed to find the way back
    moved = np.empty((count, size), bool)
    straight = np.zeros((count, size), bool)
    first = np.empty((count, size), np.int16)
    second = np.empty((count, size), np.int16)
    ended = np.empty(count, np.int16)
    begun = np.empty((count, between.size), bool)
    skipped = np.empty((count, between.size), np.int16)

    def passed(costs: np.ndarray, sources: np.ndarray) -> np.ndarray:
        """States may be missed: the least cost to be after each, and from which state."""
        relative = costs - missed
        least = np.minimum.accumulate(relative)
        np.maximum.accumulate(np.where(relative == least, index, 0), out=sources)
        return least + missed

    def opened(costs: np.ndarray, row: int | None) -> np.ndarray:
        """A printout may begin before any line, and lines may be missing."""
        waiting = costs[between]
        start = costs[0] + begin
        begins = start < waiting
        waiting = np.where(begins, start, waiting)
        relative = waiting - missed_line
        least = np.minimum.accumulate(relative)
        if row is not None:
            begun[row] = begins
            np.maximum.accumulate(np.where(relative == least, lines, 0), out=skipped[row])
        costs = costs.copy()
        costs[between] = least + missed_line
        return costs

    costs = np.full(size, _BIG)
    costs[0] = 0
    scratch = np.empty(size, np.int16)
    emitted = np.full(size, _BIG)
    origin = passed(opened(costs, None), scratch)
    for row in range(count):
        key = codes[row], gaps[row]
        advance = np.empty_like(origin)
        advance[0] = _BIG
        advance[1:] = origin[:-1]
        advance += page.unlabelled[gaps[row]]
        # a number right after the glyph of its label costs nothing more
        advance[1:][labelled] = np.minimum(advance[1:], emitted[:-1])[labelled]
        straight[row, 1:] = labelled & (advance[1:] == emitted[:-1])
        advance[1] = _BIG  # a printout begins at a price: `opened`
        advance += enter[key]
        remain = np.where(numbered, emitted, origin) + stay[key]
        np.less(advance, remain, out=moved[row])
        costs = np.where(moved[row], advance, remain)
        emitted = costs.copy()
        closing = exits[np.argmin(costs[exits])]
        end = costs[closing] + _END
        ended[row] = closing if end < costs[0] else 0
        if end < costs[0]:
            costs[0] = end
        costs = passed(costs, first[row])
        costs = opened(costs, row)
        origin = passed(costs, second[row])
        least = origin.min()
        origin -= least
        emitted -= least
    states = [0] * count
    line_of = {int(state): number for number, state in enumerate(between)}
    state = int(np.argmin(np.where(page.closes | (index == 0), origin, _BIG)))
    direct = False
    for row in range(count - 1, -1, -1):
        if not direct:
            state = int(second[row, state])
            number = line_of.get(state)
            if number is not None:
                number = int(skipped[row, number])
                state = 0 if begun[row, number] else int(between[number])
            state = int(first[row, state]) if state else 0
            if state == 0 and ended[row]:
                state = int(ended[row])
        states[row] = state
        # one more glyph of a number follows a glyph of it, not a place passed over
        direct = bool(straight[row, state]) if moved[row, state] else bool(numbered[state])
        if moved[row, state]:
            state -= 1
    return states
