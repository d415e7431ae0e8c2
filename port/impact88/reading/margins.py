"""Margins: whether the edge of the paper, or of the scan, cut lines off.

Labels are known to the letter, so lines that begin or end within one tell where an edge is; a
number at that edge may have lost digits, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import count, takewhile

from .glyphs import Gap, Page
from .template import template

_LINES, _ENDS = 3, 2
"""So many lines begin, or end, within a label, and there is an edge."""
_RAGGED = 2
"""Columns by which the ends of lines differ at one edge: readers lose blanks."""


def begun_within(page: Page, start: int, states: Sequence[int]) -> list[bool]:
    """For every line that begins with a label, whether letters of it that nobody leaves out are
    missing there. ``states``: the template's state of each glyph of the page from ``start`` on."""
    return list(_begins(page, start, states))


def cut_before(begun: Sequence[bool]) -> bool:
    """Whether most lines begin within their labels (`begun_within`)."""
    return sum(begun) >= _LINES and 2 * sum(begun) > len(begun)


def cut_after(page: Page, start: int, states: Sequence[int]) -> int:
    """The column at which lines end within their labels; 0 where they do not."""
    ends = list(_ends(page, start, states))
    return min(ends) - _RAGGED if len(ends) >= _ENDS and max(ends) - min(ends) <= _RAGGED else 0


def _begins(page: Page, start: int, states: Sequence[int]) -> Iterator[bool]:
    letters, lines, between = template().letters, template().line, template().between.tolist()
    always = template().always
    before = 0
    for index, state in enumerate(states):
        new = page.glyphs[start + index].gap is Gap.LINE and lines[state] != lines[before]
        if state and new and state not in between:
            first = between[lines[state]] + 1
            if first in letters and letters[first] != "*":
                yield any(missed in always for missed in range(first, state))
        before = state


def _ends(page: Page, start: int, states: Sequence[int]) -> Iterator[int]:
    """The columns at which lines end within their labels."""
    letters, lines = template().letters, template().line
    label: list[int] = []
    for index, state in enumerate(states):
        glyph = page.glyphs[start + index]
        if glyph.gap is Gap.LINE or state not in letters:
            label = []
        if state in letters:
            label.append(state)
        following = states[index + 1] if index + 1 < len(states) else 0
        ends = _ends_line(page, start + index) and lines[following] != lines[state]
        if label and ends and _unfinished(label):
            yield page.place(glyph.offset)[1]


def _unfinished(label: Sequence[int]) -> bool:
    """Whether letters are missing at the end of a label; which of its own two A is read as the
    last, nobody knows."""
    letters = template().letters
    last = label[0] + len(set(label)) - 1
    rest = takewhile(letters.__contains__, count(last + 1))
    return any(letters[missed].isalpha() for missed in rest)


def _ends_line(page: Page, place: int) -> bool:
    return place + 1 == len(page.glyphs) or page.glyphs[place + 1].gap is Gap.LINE
