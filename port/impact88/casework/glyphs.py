"""Glyphs: what typists and optical readers put where the printer struck a digit or a sign.

A text is looked at without its blanks, line ends, form feeds and control characters (`squeezed`),
each remaining character remembering where it stood, so that a number broken by a line end is one
number and an error still points at the spot.
"""

from __future__ import annotations

import re
import unicodedata
from array import array
from bisect import bisect_right

ILLEGIBLE = "?"
"""Stands for a character nobody can read."""

_MINUS = "−‐‑‒–—―﹣－⁻¯"
_POINT = "·•‧∙․．,，"
_EQUALS = "＝﹦≡"
_GLYPHS = {
    **dict.fromkeys(map(ord, _MINUS), "-"),
    **dict.fromkeys(map(ord, _POINT), "."),
    **dict.fromkeys(map(ord, _EQUALS), "="),
    **dict.fromkeys(map(ord, "∗✱＊⁎"), "*"),
    ord("？"): "?",
}
_AS_DIGIT = str.maketrans({"O": "0", "Q": "0", "Ø": "0", "I": "1", "L": "1", "|": "1", "!": "1"})
"""Capital letters and strokes that are a digit wherever a number must stand."""

_NUMBER = re.compile(r"[+-]?(?=[.]?[0-9?])[0-9?]*(?:[.][0-9?]*)?(?:E[+-]?[0-9?]{1,2})?")


class Squeezed:
    """A text without blanks and control characters, in capitals, usual glyphs for unusual ones.

    ``text``: what remains; ``position(i)``: the line and column (from 1) in the original where
    character ``i`` stood; ``original(i, j)``: the original's text from character ``i`` up to ``j``,
    blanks and all.
    """

    def __init__(self, original: str) -> None:
        kept: list[str] = []
        self._offsets = array("Q")
        for offset, character in enumerate(original):
            if character <= " " or character.isspace():
                continue
            for plain in _plain(character):
                kept.append(plain)
                self._offsets.append(offset)
        self._offsets.append(len(original))
        self.text = "".join(kept)
        self._original = original
        self._lines = array("Q", [0])
        self._lines.extend(match.end() for match in re.finditer("\n", original))

    def position(self, index: int) -> tuple[int, int]:
        """Line and column, counted from 1, of character ``index``."""
        offset = self._offsets[index]
        line = bisect_right(self._lines, offset)
        return line, offset - self._lines[line - 1] + 1

    def ends_at(self, index: int) -> bool:
        """Whether the original ends with the character before ``index``, no blank after it."""
        return index == len(self.text) and self._offsets[index - 1] == len(self._original) - 1

    def original(self, start: int, stop: int) -> str:
        """The original's text from character ``start`` up to character ``stop``."""
        if start >= stop:
            return ""
        return self._original[self._offsets[start] : self._offsets[stop]]


def _plain(character: str) -> str:
    """The usual glyphs for a character: nothing for what does not show, else capitals."""
    if character < "\x7f":
        return character.upper()
    plain = _GLYPHS.get(ord(character))
    if plain is not None:
        return plain
    if unicodedata.category(character) in ("Cf", "Cc", "Mn"):
        return ""
    return unicodedata.normalize("NFKC", character).upper()


def squeeze(text: str) -> str:
    """``text`` as `Squeezed` sees it, for a text whose places do not matter."""
    return Squeezed(text).text


def as_number(text: str) -> str | None:
    """``text`` (squeezed) as the number it must be, letters read as the digits they look like and
    commas as points; ``?`` may stand in it. None when it is no number."""
    plain = text.translate(_AS_DIGIT)
    return plain if _NUMBER.fullmatch(plain) else None


def leading_number(text: str) -> str | None:
    """The longest beginning of ``text`` (squeezed) that is a number, as `as_number` reads it."""
    match = _NUMBER.match(text.translate(_AS_DIGIT))
    return match.group() if match else None


def canonical(number: str) -> str:
    """A number without what Applesoft never prints and typists add: ``+`` and a leading zero."""
    sign = "-" if number.startswith("-") else ""
    size = number.lstrip("+-")
    if size.startswith("0.") and len(size) > 2 and size[2].isdigit():
        size = size[1:]
    return sign + size
