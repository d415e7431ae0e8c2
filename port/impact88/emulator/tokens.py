"""Keywords and tokens: how a typed line becomes the bytes a program is made of.

A keyword is one byte from 0x80 on; all else stays as typed, without its blanks, and with them in
strings, REM and DATA. Keywords are found anywhere, with or without blanks inside, the first in the
table's order that fits: TOTAL begins with TO, SCORE holds OR. AT followed at once by N or O is not
AT, so that ATN and A TO are found instead.
"""

from functools import lru_cache

from ..applesoft.console import keyed
from ..applesoft.errorcodes import CODES

KEYWORDS = (
    *"END FOR NEXT DATA INPUT DEL DIM READ GR TEXT PR# IN# CALL PLOT HLIN VLIN".split(),
    *"HGR2 HGR HCOLOR= HPLOT DRAW XDRAW HTAB HOME ROT= SCALE= SHLOAD TRACE".split(),
    *"NOTRACE NORMAL INVERSE FLASH COLOR= POP VTAB HIMEM: LOMEM: ONERR RESUME".split(),
    *"RECALL STORE SPEED= LET GOTO RUN IF RESTORE & GOSUB RETURN REM STOP ON".split(),
    *"WAIT LOAD SAVE DEF POKE PRINT CONT LIST CLEAR GET NEW TAB( TO FN SPC(".split(),
    *"THEN AT NOT STEP + - * / ^ AND OR > = < SGN INT ABS USR FRE SCRN( PDL".split(),
    *"POS SQR RND LOG EXP COS SIN TAN ATN PEEK LEN STR$ VAL ASC CHR$ LEFT$".split(),
    *"RIGHT$ MID$".split(),
)
FIRST = 0x80
"""The ROM's keywords in its order, and the token of the first."""
TOKENS = {word: FIRST + n for n, word in enumerate(KEYWORDS)}
DATA, REM, AT, PRINT, LAST_STATEMENT = (TOKENS[word] for word in "DATA REM AT PRINT NEW".split())
BLANK, QUOTE, COLON, COMMA, SEMICOLON, OPEN, CLOSE = map(ord, ' ":,;()')
LAST_LINE, LINE_LIMIT = 63999, 239
"""The ROM's largest number of a line, and what the monitor hands over of one that is typed."""

_LISTED = (*KEYWORDS, "", *[*CODES][1:], " ERROR\a")
_BY_LETTER: dict[str, list[tuple[str, int]]] = {}
for _word, _token in TOKENS.items():
    _BY_LETTER.setdefault(_word[0], []).append((_word, _token))


def _keyword(text: str, start: int) -> tuple[int, int] | None:
    """Token and end of the keyword at ``start``, blanks passed over, or None. (One regular
    expression of all keywords takes three times as long.)"""
    for word, token in _BY_LETTER.get(text[start], ()):
        position = start
        for letter in word:
            while text[position : position + 1] == " ":
                position += 1
            if text[position : position + 1] != letter:
                break
            position += 1
        else:
            if token != AT or text[position : position + 1] not in ("N", "O"):
                return token, position
    return None


@lru_cache(maxsize=4096)
def tokenise(kept: str, *, folded: bool = False) -> bytes:
    """The bytes of a line's statements as the ROM's parser leaves them, without the final zero.
    ``folded``: small letters become capitals outside quotes and remarks."""
    kept = keyed(kept)
    text = kept.upper() if folded else kept
    out = bytearray()
    position = 0
    in_data = False
    while position < len(text):
        character = text[position]
        if character == " " and not in_data:
            position += 1
        elif character == '"':
            end = text.find('"', position + 1) + 1 or len(text)
            out += kept[position:end].encode("ascii")
            position = end
        elif in_data or "0" <= character <= ";":
            out.append(ord(character))
            position += 1
            if character == ":":
                in_data = False
        elif character == "?":
            out.append(PRINT)
            position += 1
        elif keyword := _keyword(text, position):
            token, position = keyword
            out.append(token)
            in_data = token == DATA
            if token == REM:
                out += kept[position:].encode("ascii")
                break
        else:
            out.append(ord(character))
            position += 1
    return bytes(out)


def split_number(text: str) -> tuple[int, str] | None:
    """The line number a typed line begins with and its rest; None if it begins with no digit.
    Blanks before and within the number do not count. Raises ValueError past 63999."""
    rest = text.lstrip(" 0123456789")
    digits = text[: len(text) - len(rest)].replace(" ", "")
    if len(digits.lstrip("0")) > 5 or int(digits or 0) > LAST_LINE:
        raise ValueError("a line number goes up to 63999")
    return (int(digits), rest) if digits else None


def untokenised(tokens: bytes) -> str:
    """Return statement text that tokenises into ``tokens``: blanks stand around keywords, except
    after REM and DATA, whose text is kept. PRINT is written as a question mark where its letters
    would make another word with those before: ``PO?``. Between a colon and REM or DATA stands no
    blank, so that a line is not taken for LIST's, which puts one of its own before their text."""
    for print_word in ("PRINT", "?"):
        text, keyword = "", False
        for place, byte in enumerate(tokens):
            keyword = byte >= FIRST and byte not in (REM, DATA)
            if byte < FIRST:
                text += chr(byte)
                continue
            word = print_word if byte == PRINT else spelling(byte)
            apart = text and not text.endswith((" ", "("))
            if not keyword and text.endswith(":") and place < len(tokens) - 1:
                apart = False
            text += f" {word}" if apart else word
            if keyword and not word.endswith("("):
                text += " "
        text = text.rstrip(" ") if keyword else text
        if tokenise(text) == tokens:
            break
    return text


def spelling(token: int) -> str:
    """What LIST writes for a token. Behind the keywords stand the error messages, the first one
    after a zero that ends the table and the word."""
    index = token - FIRST
    return _LISTED[index] if index < len(_LISTED) else ""


def listed(byte: int) -> str:
    """What LIST writes for a byte of a line."""
    return chr(byte) if byte < FIRST else f" {spelling(byte)} "
