"""One number's glyphs, compared with what the program prints there.

`compare` returns how well a printed text explains the glyphs, and where it does not: a clean digit
that is another digit contradicts, whatever it looks like, and so does a letter that is usually read
for another digit; another glyph that stands in no number (a speck, a blank) is a doubt.
`candidates` returns the texts that the glyphs may have been, the likeliest first. `cut_in_five` and `cut_as` do the same for the row of angles, which is divided
by blanks only. Costs are in units of one wrong letter (`glyphs.COSTS` in hundredths of it).
"""

import re
from collections.abc import Callable, Iterable, Iterator
from decimal import Decimal
from functools import cache, lru_cache
from typing import NamedTuple

from ...apple.applesoft.decimaltext import lay_out
from .differences import Kind
from .editpath import Step, cheapest_path
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


class Match(NamedTuple):
    """An explanation of glyphs by a printed text.

    Attributes
    ----------
    cost : float
        0 for glyphs that are the text.
    path : tuple of Step
        The steps from the glyphs to the text, each with its kind of difference, None for none.
    """

    cost: float
    path: tuple[Step, ...]

    @property
    def contradicts(self) -> bool:
        """True if some glyph, cleanly read, is not what the program prints."""
        return any(kind is Kind.CONTRADICTS for _, _, kind in self.path)


Glyphs = tuple[tuple[str, Gap], ...]
"""Glyphs and the gaps before them."""

_PRINTABLE = re.compile(r"-?(?:0|[1-9][0-9]*|(?=[.]))(?:[.][0-9]*[1-9])?(?:E[+-][0-9]{2})?")
_NUMBER = re.compile(r"[+-]?(?=[.]?[0-9])[0-9]*(?:[.][0-9]*)?(?:E[+-]?[0-9]{1,2})?")

_CONTRADICTION = COSTS["contradiction"] / 100  # a figure for another figure, or for none
_FOREIGN = COSTS["foreign"] / 100  # a glyph that no figure looks like
_MARK = COSTS["mark"] / 100  # an illegible glyph, or a mark within a number
_SPECK = COSTS["speck"] / 100  # a mark at the end of a number
_SLIGHT = COSTS["slight"] / 100  # a blank, or another way to write the number
LONGEST = 64
"""Glyphs of a number, or of the row of angles, that are read; the rest is left over."""
_SPECKS = frozenset(".,:;'`|_~-\"“”’‘·•!*°^«»<>=/\\")
_FULL = frozenset("@©®ØOQDCUZSBGRPYAH$&")
"""Look-alikes of digits that are as large as one."""


def printable(text: str) -> bool:
    """Return True for a text that has the form of a number as Applesoft writes it."""
    return _PRINTABLE.fullmatch(text) is not None and text not in ("", "-", "-0")


def is_number(text: str) -> bool:
    """Return True for a text that is a number as people write them."""
    return _NUMBER.fullmatch(text) is not None


def value_of(text: str) -> Decimal | None:
    """Return the number that a text is, None if it is none or has more than 28 digits.

    28 digits are what `decimal` adds without rounding.
    """
    value = Decimal(text) if len(text) <= LONGEST and is_number(text) else None
    return None if value is None or len(value.as_tuple().digits) > 28 else value


def as_printed(text: str) -> str | None:
    """Return a number in another form (``0.911``, ``+3.449``, ``143.50``) as Applesoft writes it.

    None for a text that is no number or has more digits than Applesoft prints.
    """
    value = value_of(text)
    if not value:
        return None if value is None else "0"
    sign, figures, _ = value.normalize().as_tuple()
    digits = "".join(map(str, figures)).ljust(9, "0")
    return lay_out("-" * sign, digits, value.adjusted() - 8) if len(digits) == 9 else None


def clean(region: Region) -> str | None:
    """Return the text of glyphs that are a number without a blank, None for others."""
    text = letters(region)
    return text if is_number(text) and not any(glyph.gap for glyph in region[1:]) else None


_OPENING = frozenset("([{<")
_CLASSIC = frozenset("OQILSZB")
"""Letters that often stand for figures: two of them make no word."""


def note_start(region: Region) -> int:
    """Return where a note typed beside a clean number begins, the region's length if none does.

    A note follows a gap and opens with a bracket or a word: ``-13.263 (WRONG: 31.2)``. A figure
    right after a blank may be the number's own.
    """
    at = next((at for at, glyph in enumerate(region[:LONGEST]) if at and glyph.gap), 0)
    has_note = at and clean(region[:at]) and _is_note(region[at:])
    return at if has_note else len(region)


def _is_note(rest: Region) -> bool:
    """Return True for glyphs that open with a bracket or a word."""
    end = next((at for at, glyph in enumerate(rest) if at and glyph.gap), len(rest))
    word = [char for char in letters(rest[:end]) if char.isalpha()]
    if not rest[0].char.isalpha():
        return rest[0].char in _OPENING and len(rest) >= 3
    return len(word) >= 3 or sum(char not in _CLASSIC for char in word) >= 2


def compare(region: Region, printed: str, cut: bool = False, sign_free: bool = False) -> Match:
    """Return the cheapest explanation of glyphs by a printed text.

    Parameters
    ----------
    region : tuple of Glyph
    printed : str
        What the program prints there.
    cut : bool
        True if the text ends at the region.
    sign_free : bool
        True if a minus before the number may belong to the label.
    """
    text = letters(region)
    number = clean(region)
    whole = len(region), len(printed)
    if number == printed:
        return Match(0.0, ((*whole, None),))
    if printed == "0" and _is_broken_zero(text):
        return Match(_SPECK, ((*whole, Kind.LOOK_ALIKE),))
    if number is not None and value_of(number) == value_of(printed):
        return Match(_SLIGHT, ((*whole, Kind.OTHER_FORM),))
    return _explain(tuple(glyph[:2] for glyph in region[:LONGEST]), printed, cut, sign_free)


@lru_cache(maxsize=20000)
def _explain(region: Glyphs, printed: str, cut: bool, sign_free: bool) -> Match:
    """Return the cheapest explanation: a glyph for a printed character, an extra glyph, and a lost
    character are its steps."""

    def replaced(i: int, j: int) -> tuple[float, Kind | None]:
        cost, kind = _substitution_cost(region, i, printed[j])
        blank = j > 0 and region[i][1]
        return cost + _SLIGHT * bool(blank), kind or (Kind.BLANK if blank else None)

    cost, path = cheapest_path(
        len(region),
        len(printed),
        replaced,
        lambda i, j: _extra_cost(region, i, printed, j, sign_free),
        lambda i, j: _lost_cost(region, i, printed, j, cut),
    )
    return Match(cost, tuple(path))


def _substitution_cost(region: Glyphs, i: int, printed: str) -> tuple[float, Kind | None]:
    """Return cost and kind of reading a printed character as glyph i."""
    char = region[i][0]
    likely = {} if char == "E" else printed_for(char)
    if char == printed:
        return 0.0, None
    if char == ILLEGIBLE:
        return _MARK, Kind.ILLEGIBLE
    if char + printed == "+-" or (char + printed == "-." and _between_digits(region, i)):
        return _MARK, Kind.LOOK_ALIKE
    if char in NUMERIC and char != "E":
        return _CONTRADICTION, Kind.CONTRADICTS
    if printed in likely:
        return likely[printed], Kind.LOOK_ALIKE
    if printed in "-." and char in _SPECKS:
        return _MARK, Kind.LOOK_ALIKE
    if char in "OQØ©®@IL|!ZSB$&":  # the look-alike of another digit
        return _CONTRADICTION, Kind.CONTRADICTS
    return _FOREIGN, Kind.ILLEGIBLE


def _extra_cost(
    region: Glyphs, i: int, printed: str, j: int, sign_free: bool
) -> tuple[float, Kind]:
    """Return cost and kind of glyph i, for which the program prints nothing."""
    char, gap = region[i]
    after, gap_after = region[i + 1] if i + 1 < len(region) else ("", Gap.NONE)
    if (char == "+" and after and j == 0) or (
        char == "0" and j < 2 and printed[j : j + 1] == "." == after and not gap_after
    ):
        return _SLIGHT, Kind.OTHER_FORM
    if char.isdigit():
        is_note = j == len(printed) and _in_a_note(region, i)
        return (_SPECK, Kind.LEFT_OVER) if is_note else (_CONTRADICTION, Kind.CONTRADICTS)
    if char == "-":
        if i == j == 0 and sign_free:
            return _SLIGHT, Kind.LEFT_OVER
        if j == len(printed) or "-" in (after, region[i - 1][0] if i else ""):
            return _SPECK, Kind.LEFT_OVER
        if (i and gap) or gap_after:
            return _FOREIGN, Kind.LEFT_OVER
    inside = 0 < j < len(printed)
    is_full = char in _FULL and inside and not gap and after and not gap_after
    if char == "-" or is_full or (char == "." and _between_digits(region, i)):
        return _CONTRADICTION - _FOREIGN / 2, Kind.CONTRADICTS
    is_speck = char == "." or (char in _SPECKS and not inside)
    return _SPECK if is_speck else _MARK, Kind.LEFT_OVER


def _lost_cost(region: Glyphs, i: int, printed: str, j: int, cut: bool) -> tuple[float, Kind]:
    """Return cost and kind of printed character j, for which there is no glyph."""
    if cut and i == len(region) and j:
        return _SLIGHT, Kind.CUT
    is_parted = printed[j] == "." and 0 < i < len(region) and region[i][1] is Gap.BLANK
    neighbours = region[max(i - 1, 0) : i + 1]
    if is_parted or any(char not in NUMERIC or char == "E" for char, _ in neighbours):
        # a glyph beside it is foreign, and may be more than one character run together
        return _FOREIGN, Kind.ILLEGIBLE
    return _CONTRADICTION - _SPECK * (not printed[j].isdigit()), Kind.CONTRADICTS


def _between_digits(region: Glyphs, i: int) -> bool:
    """Return True for a glyph between two digits without gaps, where no sign stands."""
    if not 0 < i < len(region) - 1 or region[i][1] or region[i + 1][1]:
        return False
    return region[i - 1][0].isdigit() and region[i + 1][0].isdigit()


def _in_a_note(region: Glyphs, i: int) -> bool:
    """Return True for a digit that is separated from the number before it.

    A wide gap, a line's end, or a word that is not a number stands between.
    """
    words = [place for place in range(1, i + 1) if region[place][1]]
    if any(region[place][1] is not Gap.BLANK for place in words):
        return True
    between = region[words[0] : words[-1]] if words else ()
    return any(char.isalpha() and char != "E" for char, _ in between)


def _is_broken_zero(chars: str) -> bool:
    """Return True for glyphs that may be a single 0: ``C)``, ``()``, ``0)``, ``ie}``, ``(2)``."""
    if len(chars) == 3 and chars[0] in "([{" and chars[-1] in ")}]":
        return True
    if not 2 <= len(chars) <= 3 or any(char.isdigit() and char not in "0169" for char in chars):
        return chars in (")", "}")
    return chars[-1] in ")}]" or chars[0] in "([{"


_BEAM = 48
"""Readings of a number's first glyphs that are extended; ten times as many from the first foreign
glyph on."""
_MAX_ILLEGIBLE = 4  # glyphs that may be any; doubled, none of 47 texts is read otherwise
Ways = tuple[tuple[str, float], ...]
"""Texts with their costs, the cheapest first."""


def candidates(region: Region, most: int = 40, sign_free: bool = False) -> Ways:
    """Return the printable texts that glyphs may have been.

    Parameters
    ----------
    region : tuple of Glyph
    most : int
        Largest number of texts.
    sign_free : bool
        True if a minus before the number may belong to the label.

    Returns
    -------
    tuple of (str, float)
        Texts with their costs, the cheapest first.
    """
    note = note_start(region)
    ways = _candidates(tuple(glyph[:2] for glyph in region[:LONGEST]), most, sign_free)
    if note == len(region):
        return ways
    costs = dict(_candidates(tuple(glyph[:2] for glyph in region[:note]), most, sign_free))
    costs = {text: cost + _SPECK for text, cost in costs.items()}
    costs |= {text: min(cost, costs.get(text, cost)) for text, cost in ways}
    return tuple(sorted(costs.items(), key=lambda way: way[1])[:most])


def taken_for(region: Region, sign_free: bool) -> str | None:
    """Return the number that glyphs are read as, with ``?`` for illegible ones.

    None if the glyphs hold nothing of a number.
    """
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
    """Return the printable texts that glyphs may have been, by a beam search glyph by glyph."""
    chars = "".join(char for char, _ in region)
    strange = sum(char not in "0123456789OIL.-" for char in chars)
    if 3 < len(chars) < 2 * strange and not any(map(str.isdigit, chars)):
        return ()  # a word
    beam: dict[str, float] = {"": 0.0}
    endings: dict[str, float] = {}  # texts of which the glyphs behind a gap are no part
    foreign_count = 0
    for index, (char, gap) in enumerate(region):
        is_foreign = (char not in NUMERIC and not printed_for(char)) or char == ILLEGIBLE
        foreign_count += is_foreign
        any_char = is_foreign and foreign_count <= _MAX_ILLEGIBLE
        figures = sum(part[0].isdigit() for part in region[index:])
        next_beam: dict[str, float] = {}
        for text, cost in beam.items():
            for longer, price in _extensions(text, cost, region, index, any_char, sign_free):
                next_beam[longer] = min(price, next_beam.get(longer, price))
            if gap and text:
                stop = cost + _SPECK * (len(region) - index) / 2 + _FOREIGN * figures
                endings[text] = min(stop, endings.get(text, stop))
        width = 10 * _BEAM if foreign_count else _BEAM
        beam = dict(sorted(next_beam.items(), key=lambda way: way[1])[:width])
    costs: dict[str, float] = {"0": _SPECK} if _is_broken_zero(chars) else {}
    for text, cost in [*beam.items(), *endings.items()]:
        as_written = text if printable(text) else as_printed(text)
        if as_written and is_number(text):
            price = cost + _SLIGHT * (as_written != text)
            costs[as_written] = min(price, costs.get(as_written, price))
    return tuple(sorted(costs.items(), key=lambda way: way[1])[:most])


def _extensions(
    text: str, cost: float, region: Glyphs, index: int, any_char: bool, sign_free: bool
) -> Iterator[tuple[str, float]]:
    """Yield the readings that a text and one more glyph may be, with their costs.

    The glyph is read as a character, or passed over as a mark; a gap before it may be a point.
    """
    char, gap = region[index]
    after_gap = gap and text
    blank = _SLIGHT if after_gap else 0.0
    for character, price in _possible_characters(region, index, any_char).items():
        yield text + character, cost + blank + price
    if after_gap and gap is Gap.BLANK and char.isdigit() and "." not in text:
        yield f"{text}.{char}", cost + _FOREIGN
    if char in "-.+" or (char == "0" and text in ("", "-")):
        is_free = char == "-" and sign_free and index == 0
        yield text, cost + (_SLIGHT if is_free else _MARK)
    elif char not in NUMERIC and char != ILLEGIBLE:
        is_last = index + 1 == len(region) or not text
        yield text, cost + (_SPECK if is_last else _MARK)


def _possible_characters(region: Glyphs, index: int, any_char: bool) -> dict[str, float]:
    """Return the characters that a glyph may be, with what it costs to read them so.

    ``any_char``: True for a foreign glyph that may be any character.
    """
    char = region[index][0]
    if any_char:
        possible = ".0123456789" if index else "-0123456789"
    else:
        possible = char + "-." * (char in "+-") if char in NUMERIC else "".join(printed_for(char))
    costs = {other: _substitution_cost(region, index, other) for other in possible}
    return {other: cost for other, (cost, kind) in costs.items() if kind is not Kind.CONTRADICTS}


_MAX_CUTS = 400  # ways to cut the row; doubled, 4 of 47 texts have more of them
_MAX_SURPLUS = 12  # glyphs that a number's part of the row may hold beyond its own
_NOT_THERE = COSTS["not there"] / 100


def has_clean_numbers(region: Region, count: int) -> bool:
    """Return True if blanks divide glyphs into ``count`` numbers, each read beyond doubt."""
    starts = [0, *(at for at in range(1, len(region)) if region[at].gap)]
    parts = [region[start:stop] for start, stop in zip(starts, [*starts[1:], None], strict=True)]
    return len(parts) == count and all(map(clean, parts))


def cut_in_five(region: Region) -> list[tuple[tuple[str, ...], float]]:
    """Return the ways to cut glyphs into five numbers with their costs, the cheapest first."""

    @cache
    def piece(i: int, j: int) -> list[tuple[str, float]]:
        part = region[i:j]
        gap_cost = sum(GAP_COSTS["uncut"][glyph.gap] for glyph in part[1:]) / 100
        if gap_cost > _NOT_THERE or not 0 < len(part) <= 2 * _MAX_SURPLUS:
            return []
        return [(text, cost + gap_cost) for text, cost in candidates(part, 14) if cost < _NOT_THERE]

    cuts = _cut(region[:LONGEST], 5, lambda _, i, j: piece(i, j), _MAX_CUTS)
    return [(tuple(text for text, _, _ in cut), cost) for cost, cut in cuts]


def cut_as(region: Region, printed: tuple[str, ...]) -> list[tuple[int, int]]:
    """Return the range of glyphs of a row that stands for each of the printed texts.

    Each is ``(start, stop)``, the two equal for a text of which nothing was read; [] if the row
    cannot be cut so.
    """

    def piece(number: int, i: int, j: int) -> list[tuple[str, float]]:
        text = printed[number]
        if j - i > len(text) + _MAX_SURPLUS:
            return []
        return [(text, _NOT_THERE if i == j else compare(region[i:j], text).cost)]

    cuts = _cut(region[:LONGEST], len(printed), piece, 1)
    return [(i, j) for _, i, j in cuts[0][1]] if cuts else []


_Way = tuple[float, tuple[tuple[str, int, int], ...]]


def _cut(
    region: Region,
    count: int,
    piece: Callable[[int, int, int], Iterable[tuple[str, float]]],
    most: int,
) -> list[_Way]:
    """Return the cheapest ways to cut a row into numbers.

    Parameters
    ----------
    region : tuple of Glyph
        The row.
    count : int
        Number of numbers.
    piece : callable
        Maps n, i, j to the texts that the n-th number may be in glyphs i to j, with their costs.
    most : int
        Largest number of ways for each place of the last cut.

    Returns
    -------
    list of (float, tuple of (str, int, int))
        Cost, and each number with its range of glyphs.
    """
    length = len(region)
    places = [at for at in range(1, length) if region[at].gap or region[at].char in "-~"]
    if len(places) < count - 1 or length <= 16:  # five numbers of three glyphs
        places = [*range(1, length)]
    cuts: dict[int, list[_Way]] = {0: [(0.0, ())]}
    for number in range(count):
        extended: dict[int, list[_Way]] = {}
        for i, so_far in cuts.items():
            price = 0.0
            if 0 < i < length and not region[i].gap:
                price = COSTS["joined sign" if region[i].char in "-~" else "joined"] / 100
            for j in (length,) if number == count - 1 else (0, *places, length):
                for text, cost in piece(number, i, j) if i <= j else ():
                    total = cost + (price if i < j else 0.0)
                    extended.setdefault(j, []).extend(
                        (before + total, (*parts, (text, i, j))) for before, parts in so_far
                    )
        cuts = {place: sorted(set(partial_cuts))[:most] for place, partial_cuts in extended.items()}
    return cuts.get(length, [])
