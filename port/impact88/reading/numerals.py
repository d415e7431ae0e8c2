"""One number's glyphs against what the program prints there.

`compare` says how well the glyphs are explained by a printed text, and where they are not: a clean
digit that is another digit contradicts, whatever it looks like; a glyph that stands in no number
(a letter, a speck, a blank) is doubt. `candidates` are the texts that glyphs may have been, those
that need least believing first.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from decimal import Decimal, InvalidOperation
from enum import Flag, StrEnum, auto
from functools import lru_cache
from typing import NamedTuple

from ..applesoft.decimaltext import lay_out
from .glyphs import ILLEGIBLE, LOOK_ALIKES, NUMERIC, Gap, Glyph

LONGEST = 64
"""Glyphs of a number's place that are looked at; what follows is left over."""


class Doubt(StrEnum):
    """How a glyph differs from what the program prints there."""

    LOOK_ALIKE = "look-alike"
    ILLEGIBLE = "illegible"
    BLANK = "blank inside"
    LEFT_OVER = "left over"
    RETYPED = "never printed so"
    CUT = "cut off"
    CONTRADICTS = "contradicts"


class Cut(Flag):
    """Where the text ends at a number, so that more of it may have stood there."""

    NONE = 0
    BEFORE = auto()
    AFTER = auto()


class Spot(NamedTuple):
    """One place where glyphs and printed text part: the glyph's place in the region (its length
    when nothing stands there), what was read, what the program prints, and how they differ."""

    at: int
    read: str
    printed: str
    doubt: Doubt


class Match(NamedTuple):
    """Glyphs explained by a text: the cost (0: read exactly so), and every spot of doubt."""

    cost: float
    spots: tuple[Spot, ...]
    exact: int

    @property
    def contradicts(self) -> bool:
        """Whether some glyph, cleanly read, is not what the program prints."""
        return any(spot.doubt is Doubt.CONTRADICTS for spot in self.spots)


Region = tuple[Glyph, ...]

_PRINTABLE = re.compile(r"-?(?:0|[1-9][0-9]*|(?=[.]))(?:[.][0-9]*[1-9])?(?:E[+-][0-9]{2})?")
_NUMBER = re.compile(r"[+-]?(?=[.]?[0-9])[0-9]*(?:[.][0-9]*)?(?:E[+-]?[0-9]{1,2})?")

_CONTRADICTION = 3.0
SIMILAR = {frozenset(pair) for pair in "08 06 09 89 86 56 58 53 32 38 17 14 93 27 95 28".split()}
"""Digits that readers take for one another."""
_LOOK_ALIKE, _ILLEGIBLE_MARK, _FOREIGN = 0.5, 0.7, 1.0
_LESS_ALIKE = 0.1
_COMMA, _DASH_FOR_POINT = 0.3, 0.6
_SPECK, _SPECK_INSIDE, _BLANK_INSIDE = 0.4, 0.7, 0.3
_BLANK_FOR_POINT = 1.0
_RETYPED = 0.2
_WIDEST = 400
"""Powers of ten, either way, of the numbers that are taken for some."""
_DIGITS = 28
"""Their digits at most; so many the arithmetic of decimals keeps."""
_IN_PIECES = 0.45
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
    """The number a text is; None when it is none, or one that no computer of the time could print
    and no later step could add to another."""
    try:
        value = Decimal(text) if len(text) <= LONGEST and is_number(text) else None
    except InvalidOperation:
        return None
    if value is None or abs(value.adjusted()) > _WIDEST or len(value.as_tuple().digits) > _DIGITS:
        return None
    return value


def plain(region: Sequence[Glyph]) -> str:
    """The glyphs as one string."""
    return "".join(glyph.char for glyph in region)


def clean(region: Sequence[Glyph]) -> str | None:
    """The number that the glyphs are beyond doubt: nothing but a number, no blank in it."""
    text = plain(region)
    joined = all(glyph.joined for glyph in region[1:])
    return text if joined and is_number(text) else None


def compare(
    region: Region,
    printed: str,
    cut: Cut = Cut.NONE,
    sign_free: bool = False,
    closing: str = "",
) -> Match:
    """How the glyphs are explained by what the program prints.

    ``cut``: where the text ends at the region. ``sign_free``: a minus before the number may belong
    to the label. ``closing``: digits that the glyph printed after the number is read as, where that
    glyph itself was not read."""
    text = plain(region)
    if text == printed and clean(region) is not None:
        return Match(0.0, (), len(printed))
    region = region[:LONGEST]
    if printed == "0" and _round(list(text)):
        return Match(_IN_PIECES, (Spot(0, text, printed, Doubt.LOOK_ALIKE),), 0)
    other = clean(region)
    if other is not None and other != printed and value_of(other) == value_of(printed):
        spot = Spot(0, text, printed, Doubt.RETYPED)
        return Match(_RETYPED, (spot,), len(printed))
    if closing and len(region) > 1 and region[-1].char in closing:
        shorter = compare(region[:-1], printed)
        if not shorter.contradicts:
            last = Spot(len(region) - 1, region[-1].char, "", Doubt.LOOK_ALIKE)
            return Match(shorter.cost + _LOOK_ALIKE, (*shorter.spots, last), shorter.exact)
    key = tuple((glyph.char, glyph.gap, glyph.joined) for glyph in region)
    return _compared(key, printed, cut, sign_free)


@lru_cache(maxsize=20000)
def _compared(
    region: tuple[tuple[str, Gap, bool], ...], printed: str, cut: Cut, sign_free: bool
) -> Match:
    """The cheapest explanation, by dynamic programming over glyphs and printed characters."""
    rows, columns = len(region), len(printed)
    best = [[1e9] * (columns + 1) for _ in range(rows + 1)]
    back: list[list[tuple[int, int, Doubt | None]]] = [
        [(0, 0, None)] * (columns + 1) for _ in range(rows + 1)
    ]
    best[0][0] = 0.0
    for i in range(rows + 1):
        for j in range(columns + 1):
            least = best[i][j]
            if least >= 1e9:
                continue
            if i < rows:
                char, _, joined = region[i]
                inside = 0 < j < columns
                blank = 0.0 if joined or not inside else _BLANK_INSIDE
                if j < columns:
                    cost, doubt = _substitution(char, printed[j])
                    if char == "-" and printed[j] == "." and _between_digits(region, i):
                        cost, doubt = _DASH_FOR_POINT, Doubt.LOOK_ALIKE
                    if blank and doubt is None:
                        doubt = Doubt.BLANK
                    _step(best, back, i, j, 1, 1, least + cost + blank, doubt)
                cost, doubt = _extra(region, i, j, printed, sign_free)
                _step(best, back, i, j, 1, 0, least + cost, doubt)
            if j < columns:
                cost, doubt = _lost(region, i, j, printed, cut)
                _step(best, back, i, j, 0, 1, least + cost, doubt)
    spots = []
    exact = 0
    i, j = rows, columns
    while i or j:
        di, dj, doubt = back[i][j]
        i, j = i - di, j - dj
        if doubt is not None:
            read = region[i][0] if di else ""
            spots.append(Spot(i, read, printed[j] if dj else "", doubt))
        if di and dj and region[i][0] == printed[j]:
            exact += 1
    return Match(best[rows][columns], tuple(reversed(spots)), exact)


def _step(best, back, i, j, di, dj, cost, doubt) -> None:  # type: ignore[no-untyped-def]
    if cost < best[i + di][j + dj]:
        best[i + di][j + dj] = cost
        back[i + di][j + dj] = (di, dj, doubt)


def _round(chars: Sequence[str]) -> bool:
    """Whether glyphs may be a lone 0 taken to pieces: ``C)``, ``()``, ``0)``, ``ie}``, ``(2)``."""
    if len(chars) == 3 and chars[0] in "([{" and chars[-1] in ")}]":
        return True
    if not 2 <= len(chars) <= 3 or any(char.isdigit() and char not in "0169" for char in chars):
        return len(chars) == 1 and chars[0] in ")}"
    return chars[-1] in ")}]" or chars[0] in "([{"


def _substitution(char: str, printed: str) -> tuple[float, Doubt | None]:
    """Reading one printed character as a glyph."""
    if char == printed:
        return 0.0, None
    if char == ILLEGIBLE:
        return _ILLEGIBLE_MARK, Doubt.ILLEGIBLE
    if char == "E":
        return _FOREIGN, Doubt.ILLEGIBLE
    if char == "+" and printed == "-":
        return _LOOK_ALIKE + 0.1, Doubt.LOOK_ALIKE
    if char in NUMERIC:
        if frozenset((char, printed)) in SIMILAR:
            return _CONTRADICTION - 0.4, Doubt.CONTRADICTS
        return _CONTRADICTION, Doubt.CONTRADICTS
    if printed in LOOK_ALIKES.get(char, ""):
        return _alike(char, printed), Doubt.LOOK_ALIKE
    if printed in "-." and char in _SPECKS:
        return _LOOK_ALIKE + 0.1, Doubt.LOOK_ALIKE
    if len(LOOK_ALIKES.get(char, "")) and char in "OQØ©®@IL|!ZSB$&":
        # the look-alike of another digit
        return _CONTRADICTION, Doubt.CONTRADICTS
    return _FOREIGN, Doubt.ILLEGIBLE


def _between_digits(region: tuple[tuple[str, Gap, bool], ...], i: int) -> bool:
    """Whether a glyph stands within figures, where no sign stands."""
    return (
        0 < i < len(region) - 1
        and region[i - 1][0].isdigit()
        and region[i + 1][0].isdigit()
        and region[i][2]
        and region[i + 1][2]
    )


def _alike(char: str, printed: str) -> float:
    """What it costs that a digit or sign was read as its look-alike: more, the less it is alike."""
    cost = _COMMA if char in ",~\u00adOIL" else _LOOK_ALIKE
    return cost + _LESS_ALIKE * LOOK_ALIKES[char].index(printed)


def _extra(
    region: tuple[tuple[str, Gap, bool], ...], i: int, j: int, printed: str, sign_free: bool
) -> tuple[float, Doubt]:
    """A glyph for which the program prints nothing."""
    char, _, joined = region[i]
    last = i + 1 >= len(region)
    parted = (i > 0 and not joined) or (not last and not region[i + 1][2])
    before_point = not last and region[i + 1][0] == "." and region[i + 1][2]
    if char == "0" and j in (0, 1) and printed[j : j + 1] == "." and before_point:
        return _RETYPED, Doubt.RETYPED
    if char == "+" and not last and j == 0:
        return _RETYPED, Doubt.RETYPED
    if char.isdigit():
        if j == len(printed) and _in_a_note(region, i):
            return _SPECK + 0.2, Doubt.LEFT_OVER
        return _CONTRADICTION - (0.3 if parted else 0.0), Doubt.CONTRADICTS
    if char == "-":
        if j == 0 and sign_free and i == 0:
            return 0.2, Doubt.LEFT_OVER
        twice = (not last and region[i + 1][0] in "-~") or (i and region[i - 1][0] in "-~")
        if twice or j == len(printed):
            return _SPECK, Doubt.LEFT_OVER
        if parted:
            return _SPECK_INSIDE + 0.3, Doubt.LEFT_OVER
        return _CONTRADICTION - 0.5, Doubt.CONTRADICTS
    if char == ".":
        if _between_digits(region, i):
            return _CONTRADICTION - 0.5, Doubt.CONTRADICTS
        return _SPECK, Doubt.LEFT_OVER
    inside = 0 < j < len(printed)
    if char in _FULL and inside and joined and not last and region[i + 1][2]:
        return _CONTRADICTION - 0.5, Doubt.CONTRADICTS
    cost = _SPECK if char in _SPECKS else _SPECK + 0.2
    return (cost + 0.3 if inside else cost), Doubt.LEFT_OVER


def _in_a_note(region: tuple[tuple[str, Gap, bool], ...], i: int) -> bool:
    """Whether a digit after the number stands well apart from it: after a wide gap or a line's end,
    or after a word that is not a number."""
    words = [place for place in range(1, i + 1) if not region[place][2]]
    if not words:
        return False
    if any(region[place][1] is not Gap.BLANK for place in words):
        return True
    return any(part[0].isalpha() and part[0] != "E" for part in region[words[0] : words[-1]])


def _lost(
    region: tuple[tuple[str, Gap, bool], ...], i: int, j: int, printed: str, cut: Cut
) -> tuple[float, Doubt]:
    """A printed character for which there is no glyph."""
    if (Cut.AFTER in cut and i == len(region) and j) or (Cut.BEFORE in cut and not i):
        return 0.3, Doubt.CUT
    if printed[j] == "." and i < len(region) and i and region[i][1] is Gap.BLANK:
        return _BLANK_FOR_POINT, Doubt.ILLEGIBLE
    if any(
        region[k][0] not in NUMERIC or region[k][0] == "E"
        for k in (i - 1, i)
        if 0 <= k < len(region)
    ):
        # a glyph beside it is foreign, and may be more than one character run together
        return _FOREIGN, Doubt.ILLEGIBLE
    return _CONTRADICTION - (0.0 if printed[j].isdigit() else 0.4), Doubt.CONTRADICTS


# --- what glyphs may have been -------------------------------------------------------------------

_BEAM = 48
_MOST_ILLEGIBLE = 4


@lru_cache(maxsize=20000)
def _candidates(
    region: tuple[tuple[str, Gap, bool], ...], most: int, sign_free: bool
) -> tuple[tuple[str, float], ...]:
    figures = sum(part[0].isdigit() for part in region)
    if len(region) > 3 and not figures and 2 * sum(p[0] in "OIL.-" for p in region) < len(region):
        return ()
    ways: dict[str, float] = {"": 0.0}
    stopped: dict[str, float] = {}
    wild = 0
    for index, (char, gap, joined) in enumerate(region):
        following: dict[str, float] = {}

        def keep(text: str, cost: float, into: dict[str, float] = following) -> None:
            if cost < into.get(text, 1e9):
                into[text] = cost

        foreign = char not in NUMERIC and (char == ILLEGIBLE or not LOOK_ALIKES.get(char))
        wild += foreign
        for text, cost in ways.items():
            blank = 0.0 if joined or not text else _BLANK_INSIDE
            if blank and gap is Gap.BLANK and char.isdigit() and "." not in text:
                keep(text + "." + char, cost + _BLANK_FOR_POINT)
            if text and not joined:
                rest = sum(part[0].isdigit() for part in region[index:])
                apart = 0.25 if gap is Gap.LINE else 0.5 if gap is Gap.WIDE else 1.0
                keep(text, cost + _SPECK * (len(region) - index) * 0.5 + apart * rest, stopped)
            if char in NUMERIC:
                keep(text + char, cost + blank)
                if char == "+":
                    keep(text + "-", cost + blank + _LOOK_ALIKE + 0.1)
                if char == "-" and "." not in text and _between_digits(region, index):
                    keep(text + ".", cost + _DASH_FOR_POINT)
                if char in "-.+" or (char == "0" and text in ("", "-")):
                    free = char == "-" and sign_free and index == 0
                    keep(text, cost + (0.2 if free else _SPECK_INSIDE))
            else:
                for alike in LOOK_ALIKES.get(char, ""):
                    keep(text + alike, cost + blank + _alike(char, alike))
                if foreign and wild <= _MOST_ILLEGIBLE:
                    price = _ILLEGIBLE_MARK if char == ILLEGIBLE else _FOREIGN
                    for digit in "0123456789" + ("-" if not text else "."):
                        keep(text + digit, cost + blank + price)
                inside = text and index + 1 < len(region)
                if char != ILLEGIBLE:
                    keep(text, cost + (_SPECK_INSIDE if inside else _SPECK))
        width = _BEAM * (10 if wild else 1)
        ways = dict(sorted(following.items(), key=lambda way: way[1])[:width])
    for text, cost in stopped.items():
        if cost < ways.get(text, 1e9):
            ways[text] = cost
    costs: dict[str, float] = {}
    if _round([part[0] for part in region]):
        costs["0"] = _IN_PIECES
    for text, cost in ways.items():
        if not is_number(text):
            continue
        if not printable(text):
            retyped = as_printed(text)
            if retyped is None:
                continue
            text, cost = retyped, cost + _RETYPED
        if cost < costs.get(text, 1e9):
            costs[text] = cost
    return tuple(sorted(costs.items(), key=lambda way: way[1])[:most])


def candidates(region: Region, most: int = 40, sign_free: bool = False) -> list[tuple[str, float]]:
    """The printable texts that glyphs may have been, with what each costs, cheapest first."""
    key = tuple((glyph.char, glyph.gap, glyph.joined) for glyph in region[:LONGEST])
    return list(_candidates(key, most, sign_free))


def as_printed(text: str) -> str | None:
    """A number in another form (``0.911``, ``+3.449``, ``143.50``, ``0.005``) as Applesoft writes
    it; None when it needs more digits than Applesoft prints."""
    value = value_of(text)
    if value is None or len(value.as_tuple().digits) > 24:
        return None
    if not value:
        return "0"
    value = value.normalize()
    digits = "".join(map(str, value.as_tuple().digits))
    if len(digits) > 9:
        return None
    sign = "-" if value < 0 else ""
    return lay_out(sign, digits.ljust(9, "0"), value.adjusted() - 8)


__all__ = ["Doubt", "Match", "Region", "Spot", "candidates", "clean", "compare", "printable"]
