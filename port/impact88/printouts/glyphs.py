"""A text as glyphs: characters that the program could print, each with the gap before it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

NO_GAP = 0
BLANK_GAP = 1
WIDE_GAP = 2
LINE_GAP = 3
"""Kinds of gaps before a character: none, a blank, several, the end of a line."""
SCREEN_WIDTHS = (40, 80)
"""Columns of an Apple's screen and of the usual printer: a full line goes on in the next."""
DASHES = dict.fromkeys("−‐‑‒–—―﹣⁻", "-")
INVISIBLE = frozenset("\0\x04\a\u200b\u200c\u200d\u200e\u2060\ufeff\x1a")
ENCODINGS = ("utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252", "mac_roman", "cp037")
LINE_ENDS = re.compile("\r\n?|[\v\x85\u2028\u2029\f]")
PREFIX = re.compile(
    r"(?m)^[ \t]*(?:(?:>[ \t]?)+"
    r"|\[?(?:[0-9]{4}-[0-9]{2}-[0-9]{2}[ T])?[0-9]{1,2}:[0-9]{2}(?::[0-9]{2}(?:[.,][0-9]+)?)?\]?"
    r"|[0-9]{1,4}(?:[:.)|](?!\S)|[ \t]|$))"
)
"""Text before every line: quotation marks of mails, time stamps, line numbers."""
SLOT_ECHO = re.compile(r"(?m)^[ \t]*\x04?PR# ?[0-9][ \t]*$")
"""Line 610 or 780 as it shows where no disk system takes it."""
LOOKALIKES = {
    "0": "OQDCU©®Ø@°(){}",
    "1": "ILTJ|!/\\",
    "2": "ZRE",
    "3": "SEG",
    "4": "AHD",
    "5": "S$E",
    "6": "GBÉ&",
    "7": "TYFPV°?",
    "8": "BS&",
    "9": "PGU$",
    "-": '\xad~_=“”"«¬',
    ".": ",:;'`´’‘·•",
    "=": "SE:217-~_ZROAL>#F4W3B",
    "A": "EHOSFRINÅ4",
    "B": "EORSHI8P6",
    "E": "BS€RHFGC",
    "I": "[TE|L1DOH!",
    "T": "ESPI°?7",
    "Y": "¥VES",
    "V": "UYW¥",
    "X": "HKMSENR%",
    "O": "GC0QD@",
    "N": "MHW",
    "M": "NEWH",
    ",": ".SL;15I+»",
    "L": "I1",
    "W": "LUHN",
    "U": "IOVL",
    "S": "5E$",
    "P": "FR",
    "K": "ER",
    "(": "/C¢[{<",
    ")": "/3>]}9J",
    "*": "KERXSHAO%#+",
    ":": ";.,",
    "?": "7279P",
    "%": "X7#$9842&",
}
"""Characters that optical readers and typists put for a printed one."""


class Glyph(NamedTuple):
    """A character of a text.

    Parameters
    ----------
    char : str
        The character in capitals.
    gap : int
        The gap before it: `NO_GAP`, `BLANK_GAP`, `WIDE_GAP` or `LINE_GAP`.
    offset : int
        Its index in the text.
    """

    char: str
    gap: int
    offset: int


def decode(data: bytes) -> str:
    """Return the text of a file in the encoding that leaves the fewest foreign characters.

    Parameters
    ----------
    data : bytes
        The file.

    Returns
    -------
    str
        The text.
    """
    texts = [data.decode(encoding, "replace") for encoding in ENCODINGS]
    if sum(byte >= 0x80 for byte in data) > len(data) / 2:  # an Apple's characters: high bit set
        texts.append(bytes(byte & 0x7F for byte in data).decode("ascii"))
    return min(texts, key=_count_foreign)


def _count_foreign(text: str) -> int:
    plain = (char.isspace() or " " <= plain_char(char)[:1] < "\x7f" for char in text)
    return len(text) - sum(plain) + text.count("\ufffd")


def plain_char(char: str) -> str:
    """Return a character in capitals as the program prints it, "" for one without width."""
    if char in INVISIBLE:
        return ""
    capital = DASHES.get(char) or char.upper()
    return capital if len(capital) == 1 else char


def glyphs_of(text: str) -> list[Glyph]:
    """Return the glyphs of a text.

    Parameters
    ----------
    text : str
        Any text; offsets refer to it.

    Returns
    -------
    list of Glyph
        All characters but blanks and what precedes every line.
    """
    for pattern in (LINE_ENDS, SLOT_ECHO):
        text = pattern.sub(lambda match: "\n".rjust(len(match.group())), text)
    text = _without_prefixes(text)
    lengths = [len(line.rstrip()) for line in text.split("\n")]
    longest = max(lengths)
    is_wrapped = longest in SCREEN_WIDTHS or (
        longest < max(SCREEN_WIDTHS) and lengths.count(longest) > 2
    )
    glyphs = []
    gap, start = LINE_GAP, 0
    for offset, char in enumerate(text):
        if char == "\n":
            is_full = is_wrapped and len(text[start:offset].rstrip()) == longest
            gap = gap if is_full else LINE_GAP
            start = offset + 1
        elif char.isspace():
            gap = max(gap, WIDE_GAP if gap or char == "\t" else BLANK_GAP)
        elif capital := plain_char(char):
            glyphs.append(Glyph(capital, gap, offset))
            gap = NO_GAP
    return glyphs


def _without_prefixes(text: str) -> str:
    """Return a text with blanks for what precedes its lines, if all lines have it."""
    count = sum(bool(line.strip()) for line in text.split("\n"))
    prefixes = PREFIX.findall(text)
    numbers = [int("0" + re.sub(r"\D", "", prefix)) for prefix in prefixes]
    if len(prefixes) < max(count, 6) or numbers != sorted(numbers):
        return text
    return PREFIX.sub(lambda match: " " * len(match.group()), text)


def chars_of(glyphs: Sequence[Glyph]) -> str:
    """Return the characters of glyphs."""
    return "".join(glyph.char for glyph in glyphs)


def split_at_gaps(glyphs: Sequence[Glyph], gap: int = BLANK_GAP) -> Iterator[list[Glyph]]:
    """Yield the pieces of glyphs between gaps of at least a width."""
    cuts = [0, *(k for k, glyph in enumerate(glyphs) if k and glyph.gap >= gap), len(glyphs)]
    yield from ([*glyphs[a:b]] for a, b in pairwise(cuts) if a < b)
