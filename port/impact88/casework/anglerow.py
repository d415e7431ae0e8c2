"""Cutting the row of five angles, which only blanks part, where the blanks do not tell."""

from __future__ import annotations

from functools import cache

from .glyphs import Gap
from .numerals import Region, candidates

_LONGEST = 60
_CUTS = 400
_FEW_GAPS = 4
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
    places = [
        place for place in range(1, count) if not region[place].joined or region[place].char in "-~"
    ]
    if len(places) < _FEW_GAPS or count <= 16:
        places = list(range(1, count))
    bounds = [0, *places, count]

    @cache
    def piece(i: int, j: int) -> tuple[tuple[str, float], ...]:
        part = region[i:j]
        uncut = sum(_UNCUT[glyph.gap] for glyph in part[1:] if not glyph.wrapped)
        if uncut > 4 or len(part) > 24:
            return ()
        return tuple((text, cost + uncut) for text, cost in candidates(part, 14) if cost < 4)

    def price(place: int) -> float:
        if place == 0 or not region[place].joined:
            return 0.0
        return _JOINED_SIGN if region[place].char in "-~" else _JOINED

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
                        way = (before + cost + price(i), (*texts, text))
                        following.setdefault(j, []).append(way)
        ways = {place: sorted(set(some))[:most] for place, some in following.items()}
    return [(texts, cost) for cost, texts in ways.get(count, [])]
