"""LIST: a program's tokens as text, laid out as the ROM lays it out.

Every keyword gets a blank on both sides. When the cursor has reached column 33 after a character of
the line or the blank that ends a keyword, the rest goes on in the next row, five columns in.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from .tokens import DATA, FIRST, KEYWORDS, REM

WRAP_COLUMN = 33
INDENT = 5


def pieces(number: int, tokens: bytes) -> Iterator[str]:
    """What the ROM writes before it asks where the cursor is: the number, then each character, and
    each keyword with its blanks."""
    yield f"{number} "
    for byte in tokens:
        if byte < FIRST:
            yield chr(byte)
        else:
            index = byte - FIRST
            yield f" {KEYWORDS[index] if index < len(KEYWORDS) else ''} "


def source(lines: Iterable[tuple[int, bytes]]) -> str:
    """A program as text that loads into the same tokens, one line a line: what SAVE writes."""
    return "".join(f"{number} {untokenised(tokens)}\n" for number, tokens in lines)


def untokenised(tokens: bytes) -> str:
    """Statement text that tokenises into ``tokens``.

    Blanks stand around keywords, except after REM and DATA, whose text is kept as it is. The blank
    after AT keeps a following N or O from becoming ATN or TO.
    """
    out = ""
    for byte in tokens:
        if byte < FIRST:
            out += chr(byte)
            continue
        index = byte - FIRST
        word = KEYWORDS[index] if index < len(KEYWORDS) else ""
        out += word if not out or out.endswith((" ", "(")) else f" {word}"
        if byte not in (REM, DATA) and not word.endswith("("):
            out += " "
    return out.rstrip(" ") if REM not in tokens and DATA not in tokens else out
