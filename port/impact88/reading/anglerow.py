"""Cutting the row of five angles, which only blanks part, where the blanks do not tell.

`cut_in_five` says what the angles may have been, `cut_as` where each of five known ones stands.
"""

from __future__ import annotations

from functools import cache, lru_cache

from .glyphs import Gap
from .numerals import Region, candidates, compare

_LONGEST = 60
_CUTS = 400
_FEW_GAPS, _SHORT = 4, 16
_SURPLUS = 12
"""Glyphs that a number's part of the row may hold beyond its own."""
_NOT_THERE = 4.0
"""What it costs that nothing is read of a number."""
_JOINED, _JOINED_SIGN = 2.0, 0.7
_UNCUT = {Gap.NONE: 0.0, Gap.BLANK: 0.8, Gap.WIDE: 1.6, Gap.LINE: 1.2}


def cut_in_five(region: Region, most: int = _CUTS) -> list[tuple[tuple[str, ...], float]]:
    """The ways to cut glyphs into five numbers, the likeliest first, with what each costs.

    A cut costs less where a gap is, and a number costs what its reading costs (`candidates`);
    a gap inside a number costs more the wider it is. Glyphs beyond the fifth are not looked at.
    """
    region = region[:_LONGEST]
    count = len(region)
    if count < 5:
        return []
    bounds = _bounds(region)

    @cache
    def piece(i: int, j: int) -> tuple[tuple[str, float], ...]:
        part = region[i:j]
        uncut = sum(_UNCUT[glyph.gap] for glyph in part[1:] if not glyph.wrapped)
        if uncut > 4 or len(part) > 24:
            return ()
        return tuple((text, cost + uncut) for text, cost in candidates(part, 14) if cost < 4)

    # ways[place]: the cheapest ways to have cut so many numbers up to the place
    ways: dict[int, list[tuple[float, tuple[str, ...]]]] = {0: [(0.0, ())]}
    for number in range(5):
        following: dict[int, list[tuple[float, tuple[str, ...]]]] = {}
        for i, so_far in ways.items():
            for j in bounds:
                if j <= i or (number == 4) != (j == count):
                    continue
                for text, cost in piece(i, j):
                    for before, texts in so_far:
                        way = (before + cost + _price(region, i), (*texts, text))
                        following.setdefault(j, []).append(way)
        ways = {place: sorted(set(some))[:most] for place, some in following.items()}
    return [(texts, cost) for cost, texts in ways.get(count, [])]


@lru_cache(maxsize=4096)
def cut_as(region: Region, printed: tuple[str, ...]) -> list[tuple[int, int]]:
    """Where each of the printed texts stands among the glyphs of a row, as ``(start, stop)``; both
    the same where nothing is read of it.

    The cuts whose parts explain their texts best (`compare`), at the prices of `cut_in_five`."""
    region = region[:_LONGEST]
    bounds = _bounds(region)
    ways: dict[int, tuple[float, list[tuple[int, int]]]] = {0: (0.0, [])}
    for number, text in enumerate(printed):
        last = number == len(printed) - 1
        following: dict[int, tuple[float, list[tuple[int, int]]]] = {}
        for i, (before, cuts) in ways.items():
            for j in bounds:
                if j < i or (last and j != len(region)) or j - i > len(text) + _SURPLUS:
                    continue
                cost = before + (_NOT_THERE if i == j else compare(region[i:j], text).cost)
                if 0 < i < j:
                    cost += _price(region, i)
                if j not in following or cost < following[j][0]:
                    following[j] = (cost, [*cuts, (i, j)])
        ways = following
    return ways[len(region)][1] if len(region) in ways else []


def _bounds(region: Region) -> list[int]:
    """Where a row may be cut: at blanks and signs, or anywhere when these are too few."""
    count = len(region)
    places = [
        place for place in range(1, count) if not region[place].joined or region[place].char in "-~"
    ]
    if len(places) < _FEW_GAPS or count <= _SHORT:
        places = list(range(1, count))
    return [0, *places, count]


def _price(region: Region, place: int) -> float:
    """What it costs to cut before a glyph."""
    if place == 0 or not region[place].joined:
        return 0.0
    return _JOINED_SIGN if region[place].char in "-~" else _JOINED
