"""Margins: whether the edge of the paper, or of the scan, cut lines off.

Labels are known to the letter, so lines that begin or end within one tell where an edge is; a
number at that edge may have lost digits, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from .glyphs import Gap, Page
from .template import template

_LINES, _ENDS = 3, 2
"""So many lines begin, or end, within a label, and there is an edge."""
_RAGGED = 2
"""Columns by which the ends of lines differ at one edge: readers lose blanks."""


def cut_before(page: Page, start: int, states: Sequence[int]) -> bool:
    """Whether most lines begin within their labels. ``states``: the template's state of each glyph
    of the page from ``start`` on."""
    begins = list(_begins(page, start, states))
    return sum(begins) >= _LINES and 2 * sum(begins) > len(begins)


def cut_after(page: Page, start: int, states: Sequence[int]) -> int:
    """The column at which lines end within their labels; 0 where they do not."""
    ends = list(_ends(page, start, states))
    return min(ends) - _RAGGED if len(ends) >= _ENDS and max(ends) - min(ends) <= _RAGGED else 0


def _begins(page: Page, start: int, states: Sequence[int]) -> Iterator[bool]:
    """For every line that begins with a label, whether letters of it are missing there."""
    letters, lines, between = template().letters, template().line, template().between.tolist()
    before = 0
    for index, state in enumerate(states):
        new = page.glyphs[start + index].gap is Gap.LINE and lines[state] != lines[before]
        if state and new and state not in between:
            first = between[lines[state]] + 1
            if first in letters and letters[first] != "*":
                yield any(letters.get(missed, "").isalpha() for missed in range(first, state))
        before = state


def _ends(page: Page, start: int, states: Sequence[int]) -> Iterator[int]:
    """The columns at which lines end within their labels."""
    letters, lines = template().letters, template().line
    for index, state in enumerate(states):
        following = states[index + 1] if index + 1 < len(states) else 0
        within = state in letters and letters.get(state + 1, "").isalpha()
        within = within and lines[state + 1] == lines[state] != lines[following]
        if within and _ends_line(page, start + index):
            yield page.place(page.glyphs[start + index].offset)[1]


def _ends_line(page: Page, place: int) -> bool:
    return place + 1 == len(page.glyphs) or page.glyphs[place + 1].gap is Gap.LINE
