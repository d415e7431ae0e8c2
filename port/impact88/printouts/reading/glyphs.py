"""Glyphs: the characters of a text, and those that typists and optical readers put for others.

A page is a row of glyphs, blanks and characters without width left out, each with the kind of gap
before it and the place where it stood. Capitals and small letters, the many minus signs, other
widths and typefaces are one glyph each; a soft hyphen, a superscript, a stroke through a digit or
what controls how others are shown stay what they are, for they mean something else.
"""

import re
import unicodedata
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from enum import IntEnum
from functools import lru_cache
from itertools import accumulate, pairwise, repeat
from math import log10
from typing import NamedTuple

from ...files import packaged_text

ILLEGIBLE = "?"
"""Stands for a character that cannot be read."""

_GLYPHS = {
    **dict.fromkeys("−‐‑‒–—―﹣⁻", "-"),
    **dict.fromkeys("﹦≡", "="),
    **dict.fromkeys("∗✱⁎", "*"),
    **dict.fromkeys("μµ", "M"),
}

_INVISIBLE = frozenset("\0\x04\a\u200b\u200c\u200d\u200e\u2060\ufeff")
"""Characters that are not shown, and change nothing in how others are."""
_OVERSTRUCK = re.compile(r"(?<=(\S))\x08\1")
"""A backspace, and the character before it once more: bold type."""

NUMERIC = frozenset("0123456789.-+E")
"""The glyphs numbers are made of."""


class Gap(IntEnum):
    """Kinds of gaps before a glyph; the break of a full line is none."""

    NONE = 0
    BLANK = 1
    WIDE = 2
    LINE = 3


class Glyph(NamedTuple):
    """One glyph: the character it is taken for, the gap before it, and its offset in the text."""

    char: str
    gap: Gap
    offset: int


Region = tuple[Glyph, ...]


class Page:
    """A text as glyphs.

    Attributes
    ----------
    text : str
        The original.
    glyphs : tuple of Glyph
        Its glyphs in order.
    lines : list of range
        Indices of the glyphs of each line.
    width : int
        Column at which lines were broken or cut off, 0 if they were not.
    converted : dict of int to str
        Characters read as plain ones or passed over, by their offsets.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self._lines = [0, *(match.end() for match in re.finditer("\n", text))]
        # a screen that wraps fills its lines (40 columns as a rule), several to one length
        lengths = [len(line.rstrip("\r")) for line in text.split("\n")]
        full = 0 < max(lengths) <= 80 and lengths.count(max(lengths)) >= 3
        self.width = max(lengths) if full else 0
        self.converted: dict[int, str] = {}
        self.glyphs = tuple(self._read())
        starts = [at for at, glyph in enumerate(self.glyphs) if glyph.gap is Gap.LINE or not at]
        self.lines = [range(*ends) for ends in pairwise([*starts, len(self.glyphs)])]

    def _read(self) -> Iterator[Glyph]:
        last = 0  # where the glyph before ended
        for word in re.finditer(r"\S+", self.text):
            start, text = word.start(), word.group()
            if text.isascii() and text.isprintable():
                yield Glyph(text[0].upper(), self._gap(last, start), start)
                last = word.end()
                yield from map(Glyph, text[1:].upper(), repeat(Gap.NONE), range(start + 1, last))
                continue
            overstruck = {start + match.start() for match in _OVERSTRUCK.finditer(text)}
            for offset, character in enumerate(text, start):
                if offset - 1 in overstruck:
                    continue
                plain = "" if offset in overstruck else plain_glyphs(character)
                if plain != character.upper():
                    self.converted[offset] = character
                if plain:
                    yield Glyph(plain, self._gap(last, offset), offset)
                    last = offset + 1

    def _gap(self, last: int, offset: int) -> Gap:
        """Return the gap between the end of a glyph and the beginning of the next."""
        between = self.text[last:offset]
        if "\n" in between or not last:
            full = between == "\n" and self.place(last)[1] == self.width + 1
            return Gap.NONE if full else Gap.LINE
        blanks = sum(map(str.isspace, between))
        return Gap.WIDE if blanks > 1 or "\t" in between else Gap.BLANK if blanks else Gap.NONE

    def reorder(self, order: Sequence[int]) -> None:
        """Put the lines of glyphs in another order; their offsets in the text stay."""
        self.glyphs = tuple(self.glyphs[at] for line in order for at in self.lines[line])
        stops = [*accumulate((len(self.lines[line]) for line in order), initial=0)]
        self.lines = [range(*ends) for ends in pairwise(stops)]

    def place(self, offset: int) -> tuple[int, int]:
        """Return line and column, counted from 1, of an offset in the text."""
        line = bisect_right(self._lines, offset)
        return line, offset - self._lines[line - 1] + 1

    def lines_of(self, glyphs: Iterable[int]) -> set[int]:
        """Return all glyphs of the lines on which some glyphs stand."""
        starts = [line.start for line in self.lines]
        return {at for glyph in glyphs for at in self.lines[bisect_right(starts, glyph) - 1]}

    def span(self, start: int, stop: int) -> tuple[int, int]:
        """Return the offsets in the text of glyphs ``start`` to ``stop``, without blanks behind."""
        return self.glyphs[start].offset, self.glyphs[stop - 1].offset + 1

    def shown(self, start: int, stop: int) -> str:
        """Return the text of glyphs ``start`` to ``stop``, with runs of blanks as one."""
        return " ".join(self.text[slice(*self.span(start, stop))].split())


@lru_cache(maxsize=4096)
def plain_glyphs(character: str) -> str:
    """Return the glyph of a character in capitals, "" for one that does not show."""
    if " " < character < "\x7f":
        return character.upper()
    if character in _INVISIBLE:
        return ""
    form, _, code = unicodedata.decomposition(character).partition(" ")
    if form in ("<wide>", "<narrow>", "<font>"):  # the same in another width or typeface
        character = chr(int(code, 16))
    upper = _GLYPHS.get(character) or character.upper()
    return upper if len(upper) == 1 else character


def is_plain(character: str) -> bool:
    """Return True for a character that is read as one of ASCII's that show."""
    return " " < plain_glyphs(character) < "\x7f"


def letters(region: Iterable[Glyph]) -> str:
    """Return the glyphs as one string."""
    return "".join(glyph.char for glyph in region)


_CHANNEL: dict[str, list[list[str]]] = {}
"""The rows of `channel.txt`, by section."""
for _line in packaged_text(__package__, "channel.txt").splitlines():
    if _line.startswith("["):
        _rows = _CHANNEL.setdefault(_line.strip("[]"), [])
    elif _line and not _line.startswith("# "):
        _rows.append(_line.split())
COSTS = {" ".join(name): int(cost) for *name, cost in _CHANNEL["costs"]}
"""Costs of differences from the page, in hundredths of one wrong letter."""
GAP_COSTS = {name: [int(cost) for cost in costs] for name, *costs in _CHANNEL["gaps"]}
"""Costs of a glyph by the gap before it."""
_SHAPE_COUNT = 8  # readings that a shape counts for; doubled, 4 of 47 texts get other costs


def _channel_counts(kind: str) -> dict[str, tuple[int, dict[str, int]]]:
    """Return for each printed glyph its count, and the counts of what it was read as."""
    counts = {}
    for glyph, total, *readings in _CHANNEL[f"{kind}s"]:
        without_count = [reading for reading in readings if not reading[1:].isdecimal()]
        if without_count:
            raise ValueError(
                f"channel.txt, [{kind}s], {glyph}: {without_count[0]} has no count; expected the "
                "glyph that was read and how often, such as €3"
            )
        counts[glyph] = (int(total), {reading[0]: int(reading[1:]) for reading in readings})
    for glyph, *shapes in _CHANNEL[f"{kind} shapes"]:
        if glyph not in counts:
            raise ValueError(
                f"channel.txt, [{kind} shapes]: {glyph} is no row of [{kind}s]; expected a "
                "glyph that the program prints, and then those that stand for it"
            )
        readings_of = counts[glyph][1]
        readings_of.update(
            {read: readings_of.get(read, 0) + _SHAPE_COUNT for read in "".join(shapes)}
        )
    return counts


_OF_NUMBERS = _channel_counts("number")
_OF_LABELS = _channel_counts("label")


@lru_cache(maxsize=8192)
def label_cost(printed: str, read: str) -> int:
    """Return the cost of reading a glyph of a label, an asterisk or a prompt as another.

    It is -25 log10 of the fraction of readings, in hundredths of one wrong letter.
    """
    if printed == read:
        return 0
    total, counts = _OF_LABELS.get(printed, (1, {}))
    cost = COSTS["unseen"]
    if read in counts:
        cost = round(-25 * log10(counts[read] / total))
    if printed == "=" and read in "-~_":  # rather the number's
        return COSTS["dash for ="]
    if printed == "*" and not read.isdigit():
        return min(cost, COSTS["any for *"])
    if not read.isdigit() or (read in counts and printed != "="):
        return cost
    return cost + COSTS["figure for =" if printed == "=" else "figure unseen"]


def is_look_alike(printed: str, read: str) -> bool:
    """Return True if readers or typists take a glyph of a label for another, or if both are one."""
    return printed == read or read in _OF_LABELS.get(printed, (0, {}))[1]


@lru_cache(maxsize=1024)
def printed_for(read: str) -> dict[str, float]:
    """Return the printed glyphs that a foreign glyph may stand for, with their costs.

    The likeliest comes first; those less than a fifth as frequent are left out. Costs are in units
    of one wrong letter.
    """
    rows = _OF_NUMBERS.items()
    fractions = {glyph: counts[read] / total for glyph, (total, counts) in rows if read in counts}
    best = max(fractions.values(), default=0.0)
    likely = sorted(fractions.items(), key=lambda item: -item[1])
    return {
        glyph: COSTS["look-alike"] / 100 + log10(best / fraction) / 4
        for glyph, fraction in likely
        if fraction >= best / 5
    }
