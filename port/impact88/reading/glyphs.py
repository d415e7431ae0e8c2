"""Glyphs: what typists and optical readers put where the printer struck a digit or a sign.

A page is a row of glyphs, blanks and control characters left out, each with the kind of gap before
it and the place where it stood. Capitals and small letters, the many minus signs and the full-width
forms are one glyph each; a soft hyphen, a superscript or a stroke through a digit stay what they
are, for they mean something else.
"""

from __future__ import annotations

import re
import unicodedata
from bisect import bisect_right
from enum import IntEnum
from functools import lru_cache
from typing import NamedTuple

ILLEGIBLE = "?"
"""Stands for a character nobody can read."""

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
    """What stands before a glyph: nothing, a blank, more of them, the end of a line."""

    NONE = 0
    BLANK = 1
    WIDE = 2
    LINE = 3


class Glyph(NamedTuple):
    """One glyph: the character it is taken for, the gap before it, its offset in the text, and
    whether the line before it was full, so that a break there parts nothing."""

    char: str
    gap: Gap
    offset: int
    wrapped: bool = False

    @property
    def joined(self) -> bool:
        """Whether nothing parts it from the glyph before."""
        return self.gap is Gap.NONE or self.wrapped


class Page:
    """A text as glyphs. ``text``: the original; ``glyphs``: its glyphs in order; ``width``: where
    its lines were broken or cut off, 0 where they were not."""

    def __init__(self, text: str) -> None:
        self.text = text
        self._lines = [0, *(match.end() for match in re.finditer("\n", text))]
        self.width = _wrapping_width(text)
        self.glyphs = self._read(text)

    def _read(self, text: str) -> list[Glyph]:
        glyphs: list[Glyph] = []
        gap = Gap.LINE
        start, length = 0, 0
        wrapped = False
        for offset, character in enumerate(text):
            if character == "\n":
                wrapped = bool(self.width) and length == self.width and gap is Gap.NONE
                gap, start = Gap.LINE, offset + 1
                length = 0
                continue
            length = offset - start + 1
            if character == " " or character.isspace():
                if gap is not Gap.LINE:
                    gap = Gap.WIDE if gap or character == "\t" else Gap.BLANK
                wrapped = False
                continue
            for plain in plain_glyphs(character):
                glyphs.append(Glyph(plain, gap, offset, wrapped and gap is Gap.LINE))
                gap = Gap.NONE
        return glyphs

    def place(self, offset: int) -> tuple[int, int]:
        """Line and column, counted from 1, of an offset in the text."""
        line = bisect_right(self._lines, offset)
        return line, offset - self._lines[line - 1] + 1

    def glyphs_on(self, index: int) -> int:
        """How many glyphs the line has on which one stands."""
        line, _ = self.place(self.glyphs[index].offset)
        return len(squeeze(self.text[self._lines[line - 1] :].partition("\n")[0]))

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
    if plain is not None:
        return plain
    if character == "\u00ad":
        return character
    if unicodedata.category(character) in ("Cf", "Cc"):
        return ""
    if "\uff01" <= character <= "\uff5e":
        return chr(ord(character) - 0xFEE0).upper()
    upper = character.upper()
    return upper if len(upper) == 1 else character


def squeeze(text: str) -> str:
    """The glyphs of a text as one string."""
    return "".join(
        plain for character in text if not character.isspace() for plain in plain_glyphs(character)
    )
