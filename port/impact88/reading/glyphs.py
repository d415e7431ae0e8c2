"""Glyphs: what typists and optical readers put where the printer struck a digit or a sign.

A page is a row of glyphs, blanks and control characters left out, each with the kind of gap before
it and the place where it stood. Capitals and small letters, the many minus signs and the full-width
forms are one glyph each; a soft hyphen, a superscript or a stroke through a digit stay what they
are, for they mean something else.
"""

import re
import unicodedata
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from enum import IntEnum
from functools import lru_cache
from itertools import repeat
from math import log10
from typing import NamedTuple

ILLEGIBLE = "?"
"""Stands for a character that cannot be read."""

_MINUS = "−‐‑‒–—―﹣－⁻"
_GLYPHS = {
    **dict.fromkeys(_MINUS, "-"),
    **dict.fromkeys("＝﹦≡", "="),
    **dict.fromkeys("∗✱＊⁎", "*"),
    "？": ILLEGIBLE,
    "μ": "M",
    "µ": "M",
}

NUMERIC = frozenset("0123456789.-+E")
"""The glyphs numbers are made of."""


class Gap(IntEnum):
    """What stands before a glyph: nothing, a blank, more of them, the end of a line. The break of
    a full line parts nothing."""

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
    """A text as glyphs. ``text``: the original; ``glyphs``: its glyphs in order; ``width``: where
    its lines were broken or cut off, 0 where they were not."""

    def __init__(self, text: str) -> None:
        self.text = text
        self._lines = [0, *(match.end() for match in re.finditer("\n", text))]
        self.width = _wrapping_width(text)
        self.glyphs = tuple(self._read())

    def _read(self) -> Iterator[Glyph]:
        last = 0  # where the glyph before ended
        for word in re.finditer(r"\S+", self.text):
            start, text = word.start(), word.group()
            if text.isascii() and text.isprintable():
                yield Glyph(text[0].upper(), self._gap(last, start), start)
                last = word.end()
                yield from map(Glyph, text[1:].upper(), repeat(Gap.NONE), range(start + 1, last))
                continue
            for offset, character in enumerate(text, start):
                for plain in plain_glyphs(character):
                    yield Glyph(plain, self._gap(last, offset), offset)
                    last = offset + 1

    def _gap(self, last: int, offset: int) -> Gap:
        """What lies between where a glyph ended and where the next begins."""
        between = self.text[last:offset]
        if "\n" in between or not last:
            full = between == "\n" and self.place(last)[1] == self.width + 1
            return Gap.NONE if full else Gap.LINE
        blanks = sum(map(str.isspace, between))
        return Gap.WIDE if blanks > 1 or "\t" in between else Gap.BLANK if blanks else Gap.NONE

    def place(self, offset: int) -> tuple[int, int]:
        """Line and column, counted from 1, of an offset in the text."""
        line = bisect_right(self._lines, offset)
        return line, offset - self._lines[line - 1] + 1

    def span(self, start: int, stop: int) -> tuple[int, int]:
        """Offsets of the text from glyph ``start`` up to before glyph ``stop``, without the blanks
        after it."""
        if start >= stop:
            end = self.glyphs[start].offset if start < len(self.glyphs) else len(self.text)
            return end, end
        return self.glyphs[start].offset, self.glyphs[stop - 1].offset + 1

    def shown(self, start: int, stop: int) -> str:
        """The text from glyph ``start`` up to before glyph ``stop``, blanks as one."""
        return " ".join(self.text[slice(*self.span(start, stop))].split())


def _wrapping_width(text: str) -> int:
    """The width at which a screen broke the lines of a text (40 columns as a rule); 0: nowhere.

    A screen that wraps fills its lines: the longest lines are all of one length, and there are
    several of them."""
    lengths = [len(line.rstrip("\r")) for line in text.split("\n")]
    longest = max(lengths, default=0)
    return longest if 0 < longest <= 80 and lengths.count(longest) >= 3 else 0


@lru_cache(maxsize=4096)
def plain_glyphs(character: str) -> str:
    """The glyphs of one character: none for what does not show, else capitals."""
    if " " < character < "\x7f":
        return character.upper()
    plain = _GLYPHS.get(character)
    if plain is None and character != "\u00ad":
        if unicodedata.category(character) in ("Cf", "Cc"):
            return ""
        if "\uff01" <= character <= "\uff5e":
            return chr(ord(character) - 0xFEE0).upper()
    upper = plain or character.upper()
    return upper if len(upper) == 1 else character


def letters(region: Iterable[Glyph]) -> str:
    """The glyphs as one string."""
    return "".join(glyph.char for glyph in region)


# --- the noisy channel ----------------------------------------------------------------------------

_NUMBERS = """
. 12854 ,70 A8 :5 I5 E4 W3 U3
1 9012 T10 L9 I9 E5 F4 H4 ]3 A3 G2 |2 D2 O2
2 7101 E24 B5 Z4 C4 A3 £3 N3 R2 H2 S2 F2 @2
- 6499 ~124 =21 “20 +7 S5 E4 O3 )3 <2 N2 |2 W2 M2 A2
3 6379 S8 G4 E4 O3
4 6059 D7 A3 |2 E2
0 5695 @168 ©54 )32 O30 A20 G10 B6 S5 &5 U4 E3 K3 Q3 F3 L2 “2 I2 ]2
5 5662 S24 E4 O3 B3 L2 $2
6 5242 B5 É4 E4 O3 S2 G2
8 5083 S13 E6 A4 B3 O3 G2 ©2
7 5041 F12 P11 °7 A6 V3 R3 O3 T2 >2 |2 S2 D2 E2 Y2 /2
9 4751 G8 U3 A3 $3 S3
"""
"""Glyph of a number, how often it was printed, what it was read as and how often; other figures
left out, for a figure read for a figure contradicts, and the mark for the illegible."""
_LABELS = """
= 13242 S274 E92 :17 214 O11 Z8 R8 A8 L7 >4 T4 #4 F4 73 W3 B3
A 8625 E23 H13 O8 S8 F5 N5 R5 I3 B3 D3 P3 22 >2 M2 °2
B 6960 E110 O23 R17 S8 H8 I7 85 P4 A4 62 L2 T2 &2 #2
E 5448 B14 S9 €8 R5 H4 T3 M3 =2 G2 Z2 C2 _2 62
I 5086 [22 T22 E11 |8 L6 D5 O4 14 H4 Y2 :2 !2 S2 R2 A2 U2 F2
T 4965 E7 S4 P4 O3 D3 °3 V3 ?2 22 W2 R2 -2
Y 4893 ¥30 V25 E16 S12 G7 T6 R4 U4 O3 W2 ~2 D2
V 4696 U319 W15 ¥7 Y5 I5 E4 S3 -2 M2 L2 O2
X 4144 H97 K85 M31 S22 E18 N11 R10 D7 A7 O5 W3 %2 G2 “2
O 3372 G9 C6 R3 U3 E3 L2 T2
N 3357 M18 H13 O4 S4 W3 -2 G2 R2 P2 A2 T2
M 3188 N10 E7 W7 L4 H4 S2 Y2 R2 A2 :2 72
, 2805 .32 S24 L20 -17 512 812 U10 »7 I6 )6 +5 ;4 P4 73 W3 A2 E2 Y2
L 2351 S2 R2 N2
W 2317 L40 I6 U5 H4 T3 B3 ¥2 82
S 1621 E3 G2 :2
P 1596 S4 F4 E2
C 1469 S3 O2 D2
U 1292 I4 O3 L3 S2 J2 R2
K 879 E6 R4
( 864 /38 C31 ¢28 E2
D 856 O28 R2
) 852 /36 312 >6 24 93 }2 %2 A2
* 812 K265 E65 R33 O27 A15 S14 H9 T9 C8 I6 45 .4 P4 B4 W4 :4 U3 D3 #2
R 735 S4 M3 :3 P2
H 732 E2 T2
F 732 E3 P2
: 725 ‘9 U6 -5 C4 I3 Z2 (2 +2 E2
? 690 759 246 P12 96 S3
G 430 S2
% 407 ¥2 72 S2
"""
"""The same of labels."""
_SHAPES = (
    "0OQDCUØ©®°@(){ 1I|![]LJ/\\T(){}<> 2ZR 4AH 5S$ 6GB&@ 7TYF 8B&S 9PGY@ "
    "-~_=\u00ad¬«^\"“” .,·•‧∙․:;'`´’‘ "
)
_LABEL_SHAPES = "=: %#$&984 IL1|! EF"
"""Glyphs that people type for others, or that have their shape: `_TYPED` readings each."""
_TYPED = 8
_DECADES = 4.0
UNSEEN = 110
"""What a confusion costs that was never seen."""
COSTS = {
    "outside": 45,
    "between": 50,
    "figure between": 40,
    "inserted": 100,
    "inserted figure": 150,
    "letter lost": 65,
    "= lost": 45,
    "mark lost": 25,
    "number lost": 90,
    "reply lost": 20,
    "line": 200,
    "line may be missing": 30,
    "begins": 300,
    "begins with angles": 600,
    "ends": 80,
    "angle without gap": 220,
    "E in number": 20,
    "mark in number": 8,
    "look-alike in number": 30,
    "letter in number": 55,
    "other in number": 90,
    "= in number": 160,
}
GAP_COSTS = {
    "number": (0, 45, 80, 60),
    "reply": (0, 2, 10, 50),
    "angle": (0, 90, 180, 80),
    "before a number without label": (10, 10, 0, 0),
}
LOOK_ALIKE = 0.3
"""What the likeliest figure costs for a glyph that is none: less than that the glyph is a speck."""
_AS_OFTEN = 0.2
"""A glyph may be every one for which it is read so often, next to the likeliest."""


def _counted(table: str, shapes: str) -> dict[str, tuple[int, dict[str, int]]]:
    """By printed glyph: how often it was printed, and how often it was read as what."""
    rows = (line.split() for line in table.strip().splitlines())
    counts = {row[0]: (int(row[1]), {one[0]: int(one[1:]) for one in row[2:]}) for row in rows}
    for shape in shapes.split():
        seen = counts[shape[0]][1]
        seen.update({read: seen.get(read, 0) + _TYPED for read in shape[1:]})
    return counts


_OF_NUMBERS, _OF_LABELS = _counted(_NUMBERS, _SHAPES), _counted(_LABELS, _LABEL_SHAPES)


@lru_cache(maxsize=8192)
def label_cost(printed: str, read: str) -> int:
    """The cost of reading a glyph of a label, an asterisk or a prompt as another."""
    if printed == read:
        return 0
    total, seen = _OF_LABELS.get(printed, (1, {}))
    cost = round(-100 * log10(seen[read] / total) / _DECADES) if read in seen else UNSEEN
    if printed == "=" and read in "-~_":
        return 65  # rather the number's sign, the label's own glyph missing
    if printed == "*" and not read.isdigit():
        return min(cost, 50)
    if not read.isdigit():
        return cost
    return cost + (125 if printed == "=" and cost < UNSEEN else 40 * (cost == UNSEEN))


@lru_cache(maxsize=1024)
def printed_for(read: str) -> dict[str, float]:
    """What a glyph that stands in no number was read for, with what each costs, likeliest first."""
    every = _OF_NUMBERS.items()
    shares = {printed: seen[read] / total for printed, (total, seen) in every if read in seen}
    best = max(shares.values(), default=0.0)
    likely = sorted(shares.items(), key=lambda one: -one[1])
    return {
        printed: LOOK_ALIKE + log10(best / share) / _DECADES
        for printed, share in likely
        if share >= _AS_OFTEN * best
    }
