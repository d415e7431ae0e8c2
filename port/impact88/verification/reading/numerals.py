"""One number's glyphs against what the program prints there.

`compare` says how well the glyphs are explained by a printed text, and where they are not: a clean
digit that is another digit contradicts, whatever it looks like; a glyph that stands in no number
(a letter, a speck, a blank) is doubt. `candidates` are the texts that glyphs may have been, those
that need least believing first. `cut_in_five` and `cut_as` do the same for the row of angles, which
only blanks part.
"""

import re
from collections.abc import Callable, Iterable
from decimal import Decimal
from enum import StrEnum
from functools import cache, lru_cache
from itertools import product
from typing import NamedTuple

from ...applesoft.decimaltext import lay_out
from .glyphs import (
    COSTS,
    GAP_COSTS,
    ILLEGIBLE,
    NUMERIC,
    Gap,
    Region,
    letters,
    printed_for,
)


class Doubt(StrEnum):
    """How a glyph differs from what the program prints there."""

    LOOK_ALIKE = "look-alike"
    ILLEGIBLE = "illegible"
    BLANK = "blank inside"
    LEFT_OVER = "left over"
    RETYPED = "never printed so"
    CUT = "cut off"
    CONTRADICTS = "contradicts"


class Spot(NamedTuple):
    """One place where glyphs and printed text part: the glyph's place in the region (its length
    when nothing stands there), what was read, what the program prints, and how they differ."""

    at: int
    read: str
    printed: str
    doubt: Doubt


class Match(NamedTuple):
    """Glyphs explained by a text: the cost (0: read exactly so), every spot of doubt, and how many
    glyphs are what is printed."""

    cost: float
    spots: tuple[Spot, ...]
    exact: int

    @property
    def contradicts(self) -> bool:
        """Whether some glyph, cleanly read, is not what the program prints."""
        return any(spot.doubt is Doubt.CONTRADICTS for spot in self.spots)


Glyphs = tuple[tuple[str, Gap], ...]
"""Glyphs and the gaps before them."""

_PRINTABLE = re.compile(r"-?(?:0|[1-9][0-9]*|(?=[.]))(?:[.][0-9]*[1-9])?(?:E[+-][0-9]{2})?")
_NUMBER = re.compile(r"[+-]?(?=[.]?[0-9])[0-9]*(?:[.][0-9]*)?(?:E[+-]?[0-9]{1,2})?")

_CONTRADICTION, _FOREIGN, _MARK, _SPECK, _SLIGHT = (
    COSTS[name] / 100 for name in ("contradiction", "foreign", "mark", "speck", "slight")
)
LONGEST = 64
"""Glyphs of a number's place that are looked at, or of the row of angles; what follows is left
over."""
_SPECKS = frozenset(".,:;'`|_~-\"“”’‘·•!*°^«»<>=/\\")
_FULL = frozenset("@©®ØOQDCUZSBGRPYAH$&")
"""Look-alikes of digits that are as large as one."""


def printable(text: str) -> bool:
    """Whether Applesoft could have written ``text``, by its form."""
    return _PRINTABLE.fullmatch(text) is not None and text not in ("", "-", "-0")


def is_number(text: str) -> bool:
    """Whether a text is a number as people write them."""
    return _NUMBER.fullmatch(text) is not None


def value_of(text: str) -> Decimal | None:
    """The number a text is; None when it is none, or so long that no later step could add it to
    another."""
    value = Decimal(text) if len(text) <= LONGEST and is_number(text) else None
    return None if value is None or len(value.as_tuple().digits) > 28 else value


def as_printed(text: str) -> str | None:
    """A number in another form (``0.911``, ``+3.449``, ``143.50``, ``0.005``) as Applesoft writes
    it; None when it needs more digits than Applesoft prints."""
    value = value_of(text)
    if not value:
        return None if value is None else "0"
    sign, figures, _ = value.normalize().as_tuple()
    digits = "".join(map(str, figures)).ljust(9, "0")
    return lay_out("-" * sign, digits, value.adjusted() - 8) if len(digits) == 9 else None


def clean(region: Region) -> str | None:
    """The number that the glyphs are beyond doubt: nothing but a number, no blank in it."""
    text = letters(region)
    return text if is_number(text) and not any(glyph.gap for glyph in region[1:]) else None


_OPENING = frozenset("([{<")
_CLASSIC = frozenset("OQILSZB")
"""Letters that stand for figures often: two of them make no word."""


def note_start(region: Region) -> int:
    """Return where a note typed beside a clean number begins, the region's length if none does.

    A note follows a gap and opens with a bracket or a word: ``-13.263 (WRONG: 31.2)``. A figure
    right after a blank may be the number's own.
    """
    at = next((at for at, glyph in enumerate(region[:LONGEST]) if at and glyph.gap), 0)
    noted = at and clean(region[:at]) and _is_note(region[at:])
    return at if noted else len(region)


def _is_note(rest: Region) -> bool:
    end = next((at for at, glyph in enumerate(rest) if at and glyph.gap), len(rest))
    word = [char for char in letters(rest[:end]) if char.isalpha()]
    if not rest[0].char.isalpha():
        return rest[0].char in _OPENING and len(rest) >= 3
    return len(word) >= 3 or sum(char not in _CLASSIC for char in word) >= 2


def compare(region: Region, printed: str, cut: bool = False, sign_free: bool = False) -> Match:
    """How the glyphs are explained by what the program prints.

    ``cut``: whether the text ends at the region. ``sign_free``: whether a minus before the number
    may belong to the label."""
    text = letters(region)
    other = clean(region)
    if other == printed:
        return Match(0.0, (), len(printed))
    if printed == "0" and _in_pieces(text):
        return Match(_SPECK, (Spot(0, text, printed, Doubt.LOOK_ALIKE),), 0)
    if other is not None and value_of(other) == value_of(printed):
        return Match(_SLIGHT, (Spot(0, text, printed, Doubt.RETYPED),), len(printed))
    return _compared(tuple(glyph[:2] for glyph in region[:LONGEST]), printed, cut, sign_free)


@lru_cache(maxsize=20000)
def _compared(region: Glyphs, printed: str, cut: bool, sign_free: bool) -> Match:
    """The cheapest explanation, by dynamic programming over glyphs and printed characters: a glyph
    for a character, a glyph too many, a character lost."""
    rows, columns = len(region), len(printed)
    least: dict[tuple[int, int], float] = {(0, 0): 0.0}
    back: dict[tuple[int, int], tuple[int, int, Doubt | None]] = {}
    for i, j in product(range(rows + 1), range(columns + 1)):
        steps: list[tuple[int, int, float, Doubt | None]] = []
        if i < rows and j < columns:
            cost, doubt = _substitution(region, i, printed[j])
            blank = j > 0 and region[i][1]
            steps.append(
                (1, 1, cost + _SLIGHT * bool(blank), doubt or (Doubt.BLANK if blank else None))
            )
        if i < rows:
            steps.append((1, 0, *_extra(region, i, printed, j, sign_free)))
        if j < columns:
            steps.append((0, 1, *_lost(region, i, printed, j, cut)))
        for di, dj, cost, doubt in steps:
            place = i + di, j + dj
            if place not in least or least[i, j] + cost < least[place]:
                least[place], back[place] = least[i, j] + cost, (di, dj, doubt)
    spots, exact = list[Spot](), 0
    i, j = rows, columns
    while i or j:
        di, dj, doubt = back[i, j]
        i, j = i - di, j - dj
        read, there = region[i][0] if di else "", printed[j] if dj else ""
        exact += read == there
        if doubt is not None:
            spots.append(Spot(i, read, there, doubt))
    return Match(least[rows, columns], tuple(reversed(spots)), exact)


def _substitution(region: Glyphs, i: int, printed: str) -> tuple[float, Doubt | None]:
    """Reading one printed character as a glyph."""
    char = region[i][0]
    likely = {} if char == "E" else printed_for(char)
    if char == printed:
        return 0.0, None
    if char == ILLEGIBLE:
        return _MARK, Doubt.ILLEGIBLE
    if char + printed == "+-" or (char + printed == "-." and _between_digits(region, i)):
        return _MARK, Doubt.LOOK_ALIKE
    if char in NUMERIC and char != "E":
        return _CONTRADICTION, Doubt.CONTRADICTS
    if printed in likely:
        return likely[printed], Doubt.LOOK_ALIKE
    if printed in "-." and char in _SPECKS:
        return _MARK, Doubt.LOOK_ALIKE
    if char in "OQØ©®@IL|!ZSB$&":  # the look-alike of another digit
        return _CONTRADICTION, Doubt.CONTRADICTS
    return _FOREIGN, Doubt.ILLEGIBLE


def _extra(region: Glyphs, i: int, printed: str, j: int, sign_free: bool) -> tuple[float, Doubt]:
    """A glyph for which the program prints nothing."""
    char, gap = region[i]
    after, gap_after = region[i + 1] if i + 1 < len(region) else ("", Gap.NONE)
    if (char == "+" and after and j == 0) or (
        char == "0" and j < 2 and printed[j : j + 1] == "." == after and not gap_after
    ):
        return _SLIGHT, Doubt.RETYPED
    if char.isdigit():
        noted = j == len(printed) and _in_a_note(region, i)
        return (_SPECK, Doubt.LEFT_OVER) if noted else (_CONTRADICTION, Doubt.CONTRADICTS)
    if char == "-":
        if i == j == 0 and sign_free:
            return _SLIGHT, Doubt.LEFT_OVER
        if j == len(printed) or "-" in (after, region[i - 1][0] if i else ""):
            return _SPECK, Doubt.LEFT_OVER
        if (i and gap) or gap_after:
            return _FOREIGN, Doubt.LEFT_OVER
    inside = 0 < j < len(printed)
    full = char in _FULL and inside and not gap and after and not gap_after
    if char == "-" or full or (char == "." and _between_digits(region, i)):
        return _CONTRADICTION - _FOREIGN / 2, Doubt.CONTRADICTS
    speck = char == "." or (char in _SPECKS and not inside)
    return _SPECK if speck else _MARK, Doubt.LEFT_OVER


def _lost(region: Glyphs, i: int, printed: str, j: int, cut: bool) -> tuple[float, Doubt]:
    """A printed character for which there is no glyph."""
    if cut and i == len(region) and j:
        return _SLIGHT, Doubt.CUT
    parted = printed[j] == "." and 0 < i < len(region) and region[i][1] is Gap.BLANK
    beside = region[max(i - 1, 0) : i + 1]
    if parted or any(char not in NUMERIC or char == "E" for char, _ in beside):
        # a glyph beside it is foreign, and may be more than one character run together
        return _FOREIGN, Doubt.ILLEGIBLE
    return _CONTRADICTION - _SPECK * (not printed[j].isdigit()), Doubt.CONTRADICTS


def _between_digits(region: Glyphs, i: int) -> bool:
    """Whether a glyph stands within figures, where no sign stands."""
    if not 0 < i < len(region) - 1 or region[i][1] or region[i + 1][1]:
        return False
    return region[i - 1][0].isdigit() and region[i + 1][0].isdigit()


def _in_a_note(region: Glyphs, i: int) -> bool:
    """Whether a digit after the number stands well apart from it: after a wide gap or a line's end,
    or after a word that is not a number."""
    words = [place for place in range(1, i + 1) if region[place][1]]
    if any(region[place][1] is not Gap.BLANK for place in words):
        return True
    noted = region[words[0] : words[-1]] if words else ()
    return any(char.isalpha() and char != "E" for char, _ in noted)


def _in_pieces(chars: str) -> bool:
    """Whether glyphs may be a lone 0 taken to pieces: ``C)``, ``()``, ``0)``, ``ie}``, ``(2)``."""
    if len(chars) == 3 and chars[0] in "([{" and chars[-1] in ")}]":
        return True
    if not 2 <= len(chars) <= 3 or any(char.isdigit() and char not in "0169" for char in chars):
        return chars in (")", "}")
    return chars[-1] in ")}]" or chars[0] in "([{"


_BEAM = 48
"""Ways to read a number that are followed up; ten times as many where glyphs may be anything."""
_MOST_ILLEGIBLE = 4  # glyphs that may be any; doubled, none of 47 texts is read otherwise
Ways = tuple[tuple[str, float], ...]


def candidates(region: Region, most: int = 40, sign_free: bool = False) -> Ways:
    """The printable texts that glyphs may have been, with what each costs, cheapest first."""
    noted = note_start(region)
    ways = _candidates(tuple(glyph[:2] for glyph in region[:LONGEST]), most, sign_free)
    if noted == len(region):
        return ways
    costs = dict(_candidates(tuple(glyph[:2] for glyph in region[:noted]), most, sign_free))
    costs = {text: cost + _SPECK for text, cost in costs.items()}
    costs |= {text: min(cost, costs.get(text, cost)) for text, cost in ways}
    return tuple(sorted(costs.items(), key=lambda way: way[1])[:most])


def taken_for(region: Region, sign_free: bool) -> str | None:
    """The number that glyphs are read as, ``?`` for what is illegible; None when nothing of one is
    there."""
    if text := clean(region):
        return text
    ways = candidates(region, 1, sign_free)
    # a glyph that looks like no figure within a number is illegible
    strange = [
        not (glyph.char in NUMERIC or printed_for(glyph.char) or glyph.gap) for glyph in region
    ]
    figures = [at for at, glyph in enumerate(region) if glyph.char.isdigit()] or [0]
    if ways and not any(strange[figures[0] + 1 : figures[-1]]):
        return ways[0][0]
    text = "".join(glyph.char if glyph.char in NUMERIC else ILLEGIBLE for glyph in region)[:LONGEST]
    return text if any(map(str.isdigit, text)) or text in ("?", "??", "???") else None


@lru_cache(maxsize=20000)
def _candidates(region: Glyphs, most: int, sign_free: bool) -> Ways:
    chars = "".join(char for char, _ in region)
    strange = sum(char not in "0123456789OIL.-" for char in chars)
    if 3 < len(chars) < 2 * strange and not any(map(str.isdigit, chars)):
        return ()  # a word
    ways: dict[str, float] = {"": 0.0}
    costs: dict[str, float] = {}
    wild = 0
    for index, (char, gap) in enumerate(region):
        foreign = (char not in NUMERIC and not printed_for(char)) or char == ILLEGIBLE
        wild += foreign
        may_be = _may_be(region, index, foreign and wild <= _MOST_ILLEGIBLE)
        following: dict[str, float] = {}
        for text, cost in ways.items():
            parted = gap and text
            blank = _SLIGHT if parted else 0.0
            some = [(text + reading, cost + blank + price) for reading, price in may_be.items()]
            if parted and gap is Gap.BLANK and char.isdigit() and "." not in text:
                some.append((f"{text}.{char}", cost + _FOREIGN))
            if char in "-.+" or (char == "0" and text in ("", "-")):
                free = char == "-" and sign_free and index == 0
                some.append((text, cost + (_SLIGHT if free else _MARK)))
            elif char not in NUMERIC and char != ILLEGIBLE:
                last = index + 1 == len(region) or not text
                some.append((text, cost + (_SPECK if last else _MARK)))
            for longer, price in some:
                following[longer] = min(price, following.get(longer, price))
            if parted:  # what follows is left over
                figures = sum(part[0].isdigit() for part in region[index:])
                stop = cost + _SPECK * (len(region) - index) / 2 + _FOREIGN * figures
                costs[text] = min(stop, costs.get(text, stop))
        beam = 10 * _BEAM if wild else _BEAM
        ways = dict(sorted(following.items(), key=lambda way: way[1])[:beam])
    printed: dict[str, float] = {"0": _SPECK} if _in_pieces(chars) else {}
    for text, cost in [*ways.items(), *costs.items()]:
        shown = text if printable(text) else as_printed(text)
        if shown and is_number(text):
            price = cost + _SLIGHT * (shown != text)
            printed[shown] = min(price, printed.get(shown, price))
    return tuple(sorted(printed.items(), key=lambda way: way[1])[:most])


def _may_be(region: Glyphs, index: int, wild: bool) -> dict[str, float]:
    """The characters a glyph may be, with what each costs."""
    char = region[index][0]
    if char in NUMERIC:
        dash = char == "-" and _between_digits(region, index)
        return {char: 0.0} | ({"-": _MARK} if char == "+" else {".": _MARK} if dash else {})
    if wild:
        price = _MARK if char == ILLEGIBLE else _FOREIGN
        return dict.fromkeys(".0123456789" if index else "-0123456789", price)
    return printed_for(char)


_CUTS = 400  # ways to cut the row that are kept; doubled, 4 of 47 texts have more of them
_SURPLUS = 12
"""Glyphs that a number's part of the row may hold beyond its own."""
_NOT_THERE = COSTS["not there"] / 100


def cut_in_five(region: Region) -> list[tuple[tuple[str, ...], float]]:
    """The ways to cut glyphs into five numbers, the likeliest first, with what each costs."""

    @cache
    def piece(i: int, j: int) -> list[tuple[str, float]]:
        part = region[i:j]
        uncut = sum(GAP_COSTS["uncut"][glyph.gap] for glyph in part[1:]) / 100
        if uncut > _NOT_THERE or not 0 < len(part) <= 2 * _SURPLUS:
            return []
        return [(text, cost + uncut) for text, cost in candidates(part, 14) if cost < _NOT_THERE]

    found = _cut(region[:LONGEST], 5, lambda _, i, j: piece(i, j), _CUTS)
    return [(tuple(text for text, _, _ in way), cost) for cost, way in found]


def cut_as(region: Region, printed: tuple[str, ...]) -> list[tuple[int, int]]:
    """Where each of the printed texts stands among the glyphs of a row, as ``(start, stop)``; both
    the same where nothing is read of it. Nothing where the row cannot be cut so."""

    def piece(number: int, i: int, j: int) -> list[tuple[str, float]]:
        text = printed[number]
        if j - i > len(text) + _SURPLUS:
            return []
        return [(text, _NOT_THERE if i == j else compare(region[i:j], text).cost)]

    found = _cut(region[:LONGEST], len(printed), piece, 1)
    return [(i, j) for _, i, j in found[0][1]] if found else []


_Way = tuple[float, tuple[tuple[str, int, int], ...]]


def _cut(
    region: Region,
    count: int,
    piece: Callable[[int, int, int], Iterable[tuple[str, float]]],
    most: int,
) -> list[_Way]:
    """The cheapest ways to cut a row into so many numbers: cost, and each number with its place.
    ``piece``: what the n-th number may be from glyph to glyph, with what each costs."""
    length = len(region)
    places = [at for at in range(1, length) if region[at].gap or region[at].char in "-~"]
    if len(places) < count - 1 or length <= 16:  # five numbers of three glyphs
        places = [*range(1, length)]
    ways: dict[int, list[_Way]] = {0: [(0.0, ())]}
    for number in range(count):
        following: dict[int, list[_Way]] = {}
        for i, so_far in ways.items():
            price = 0.0
            if 0 < i < length and not region[i].gap:
                price = COSTS["joined sign" if region[i].char in "-~" else "joined"] / 100
            for j in (length,) if number == count - 1 else (0, *places, length):
                for text, cost in piece(number, i, j) if i <= j else ():
                    paid = cost + (price if i < j else 0.0)
                    following.setdefault(j, []).extend(
                        (before + paid, (*parts, (text, i, j))) for before, parts in so_far
                    )
        ways = {place: sorted(set(some))[:most] for place, some in following.items()}
    return ways.get(length, [])
