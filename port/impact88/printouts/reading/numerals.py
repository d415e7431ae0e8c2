"""One number's glyphs, compared with what the program prints there.

`compare` returns how well a printed text explains the glyphs, and where it does not: a digit that
is another digit contradicts, and so does a letter that is the usual look-alike of another digit (an
O for a 3); any other letter, a speck and a blank are doubts. `candidates` returns the texts that
the glyphs may have been, the likeliest first; `rows` those of a row of numbers that only blanks
divide. Costs are in units of one wrong letter (`glyphs.COSTS` in hundredths of it).
"""

import re
from collections import Counter
from collections.abc import Iterator
from decimal import Decimal
from functools import lru_cache
from typing import Any, NamedTuple

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


Glyphs = tuple[tuple[str, Gap], ...]
"""Glyphs and the gaps before them."""

_PRINTABLE = re.compile(r"-?(?:0(?![.])|[1-9][0-9]*|(?=[.]))(?:[.][0-9]*[1-9])?(?:E[+-][0-9]{2})?")
NUMBER = re.compile(r"[+-]?(?=[.]?[0-9])[0-9]*(?:[.][0-9]*)?(?:E[+-]?[0-9]{1,2})?")

_CONTRADICTION = COSTS["contradiction"] / 100  # a figure for another figure, or for none
_FOREIGN = COSTS["foreign"] / 100  # a glyph that no figure looks like
_MARK = COSTS["mark"] / 100  # an illegible glyph, or a mark within a number
_SPECK = COSTS["speck"] / 100  # a mark at the end of a number
_SLIGHT = COSTS["slight"] / 100  # a blank, or another way to write the number
LONGEST = 64
"""Glyphs of a number, or of the row of angles, that are read; the rest is left over."""
POINTS = frozenset(".,")
"""Decimal points, as people write them."""
SPECKS = frozenset(".,:;'`|_~-\"“”’‘·•!*°^«»<>=/\\")
_FULL = frozenset("@©®ØOQDCUZSBGRPYAH$&")
"""Look-alikes of digits that are as large as one."""


def printable(text: str) -> bool:
    """Return True for a text that has the form of a number as Applesoft writes it."""
    return _PRINTABLE.fullmatch(text) is not None and text not in ("", "-", "-0")


def is_number(text: str) -> bool:
    """Return True for a text that is a number as people write them."""
    return NUMBER.fullmatch(text) is not None


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

    A note follows a gap and opens with a bracket or a word, ``-13.263 (WRONG: 31.2)``, or stands
    below. A figure right after a blank may be the number's own.
    """
    at = next((at for at, glyph in enumerate(region[:LONGEST]) if at and glyph.gap), 0)
    is_below = region[at].gap is Gap.LINE and not NUMERIC.issuperset(letters(region[at:]))
    has_note = at and clean(region[:at]) and (is_below or _is_note(region[at:]))
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
    if printed in "-." and char in SPECKS:
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
        char == "0" and j < 2 and printed[j : j + 1] == "." and after in POINTS and not gap_after
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
    is_speck = char == "." or (char in SPECKS and not inside)
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
glyph on, and in a row that has fewer gaps than cuts."""
_MAX_ILLEGIBLE = 4  # glyphs that may be any; doubled, none of 47 texts is read otherwise
_MAX_ROWS = 400  # readings of the row of angles; doubled, 4 of 47 texts have more of them
Ways = tuple[tuple[str, float], ...]
"""Texts with their costs, the cheapest first."""


class Row(NamedTuple):
    """A reading of glyphs as a row of numbers: their texts, its cost, and the glyph at which each
    number begins."""

    texts: tuple[str, ...]
    cost: float
    starts: tuple[int, ...]


_CLOSED = " "
"""Stands at the end of a number of which the glyphs behind a gap are no part."""
_Beam = dict[tuple[str, ...], tuple[float, tuple[int, ...]]]
"""Costs of rows and the glyphs at which their numbers begin, by their texts."""


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
    glyphs = tuple(glyph[:2] for glyph in region[:LONGEST])
    return tuple((text, cost) for (text,), cost, _ in _readings(glyphs, 1, most, sign_free))


def rows(region: Region, count: int) -> list[Row]:
    """Return the rows of ``count`` numbers that glyphs may have been, the likeliest first."""
    return [*_readings(tuple(glyph[:2] for glyph in region[:LONGEST]), count, _MAX_ROWS, False)]


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
def _readings(region: Glyphs, count: int, most: int, sign_free: bool) -> tuple[Row, ...]:
    """Return the rows of printable texts that glyphs may have been, by a beam search glyph by
    glyph."""
    chars = "".join(char for char, _ in region)
    strange = sum(char not in "0123456789OIL.-" for char in chars)
    if 3 < len(chars) < 2 * strange and not any(map(str.isdigit, chars)):
        return ()  # a word
    beams: list[_Beam] = [{} for _ in range(len(region) + 1)]
    beams[0][("",)] = 0.0, (0,)
    are_joined = sum(gap is not Gap.NONE for _, gap in region[1:]) < count - 1
    foreign_count = 0
    for index, (char, gap) in enumerate(region):
        width = 10 * _BEAM if foreign_count or are_joined else _BEAM
        is_foreign = (char not in NUMERIC and not printed_for(char)) or char == ILLEGIBLE
        foreign_count += is_foreign
        any_char = is_foreign and foreign_count <= _MAX_ILLEGIBLE * count
        for texts, (cost, starts) in _likeliest(beams[index], width):
            *head, text = texts
            number = text.rstrip(_CLOSED)
            uncut = GAP_COSTS["uncut"][gap] / 100 if count > 1 and index > starts[-1] else 0.0
            open_texts = [((*head,), text, cost + uncut, starts)]
            if text and (gap or text != number):
                price = cost + uncut + _SPECK / 2 + _FOREIGN * char.isdigit()
                _keep(beams[index + 1], (*head, number + _CLOSED), price, starts)
            if text != number:
                open_texts = []
            if len(texts) < count and is_number(number):
                joint = 0.0 if gap else COSTS["joined sign" if char in "-~" else "joined"] / 100
                open_texts.append(((*head, number), "", cost + joint, (*starts, index)))
            for numbers_before, tail, price, places in open_texts:
                for longer, total in _extensions(tail, price, region, index, any_char, sign_free):
                    _keep(beams[index + 1], (*numbers_before, longer), total, places)
                for end in () if tail else _broken_zeros(region, index):
                    _keep(beams[end], (*numbers_before, "0"), price + _SPECK, places)
    found: _Beam = {}
    for texts, (cost, starts) in beams[-1].items():
        numbers = [text.rstrip(_CLOSED) for text in texts]
        if len(texts) == count and all(map(is_number, numbers)):
            row = [text if printable(text) else as_printed(text) or "" for text in numbers]
            if all(row):
                rewritten = sum(map(str.__ne__, numbers, row))
                _keep(found, tuple(row), cost + _SLIGHT * rewritten, starts)
    ways = sorted(found.items(), key=_cost_of)[:most]
    return tuple(Row(texts, cost, starts) for texts, (cost, starts) in ways)


def _likeliest(ways: _Beam, width: int) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield the rows of least cost, ``width`` of each number of numbers."""
    sizes: Counter[int] = Counter()
    for texts, way in sorted(ways.items(), key=_cost_of):
        sizes[len(texts)] += 1
        if sizes[len(texts)] <= width:
            yield texts, way


def _cost_of(way: tuple[Any, tuple[float, Any]]) -> float:
    return way[1][0]


def _keep(ways: _Beam, texts: tuple[str, ...], cost: float, starts: tuple[int, ...]) -> None:
    """Add a row, if it is none of the ways yet or costs less so."""
    if texts not in ways or cost < ways[texts][0]:
        ways[texts] = cost, starts


def _broken_zeros(region: Glyphs, start: int) -> Iterator[int]:
    """Yield where glyphs that may be a single 0 end, if a gap or nothing follows."""
    for end in range(start + 1, min(start + 3, len(region)) + 1):
        is_whole = end == len(region) or region[end][1]
        if is_whole and _is_broken_zero("".join(char for char, _ in region[start:end])):
            yield end


def _extensions(
    text: str, cost: float, region: Glyphs, index: int, any_char: bool, sign_free: bool
) -> Iterator[tuple[str, float]]:
    """Yield the readings that a text and one more glyph may be, with their costs.

    The glyph is read as a character, or passed over as a mark; a gap before it may be a point.
    """
    char, gap = region[index]
    after_gap = gap and text
    blank = _SLIGHT if after_gap else 0.0
    for character, price in _possible_characters(region, index, any_char, not text).items():
        yield text + character, cost + blank + price
    if after_gap and gap is Gap.BLANK and char.isdigit() and "." not in text:
        yield f"{text}.{char}", cost + _FOREIGN
    if char in "-.+" or (char == "0" and text in ("", "-")):
        is_free = char == "-" and sign_free and index == 0
        yield text, cost + (_SLIGHT if is_free else _MARK)
    elif char not in NUMERIC and char != ILLEGIBLE:
        is_last = index + 1 == len(region) or not text
        yield text, cost + (_SPECK if is_last else _MARK)


def _possible_characters(
    region: Glyphs, index: int, any_char: bool, first: bool
) -> dict[str, float]:
    """Return the characters that a glyph may be, with what it costs to read them so.

    ``any_char``: True for a foreign glyph that may be any character; ``first``: of its number.
    """
    char = region[index][0]
    if any_char:
        possible = "-0123456789" if first else ".0123456789"
    else:
        possible = char + "-." * (char in "+-") if char in NUMERIC else "".join(printed_for(char))
    costs = {other: _substitution_cost(region, index, other) for other in possible}
    return {other: cost for other, (cost, kind) in costs.items() if kind is not Kind.CONTRADICTS}
