"""Keywords and tokens: conversion of a typed line to the bytes of a program, and back.

A keyword becomes one byte from 0x80 on; everything else stays as typed, without blanks except in
strings, REM and DATA. Keywords are found anywhere, with or without blanks inside, the first match
in the order of the table: TOTAL begins with TO, SCORE contains OR. AT directly followed by N or O
is not AT, so that ATN and A TO are found instead."""

from functools import lru_cache

from ..applesoft.console import keyboard_codes
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
DATA = TOKENS["DATA"]
REM = TOKENS["REM"]
AT = TOKENS["AT"]
PRINT = TOKENS["PRINT"]
LAST_STATEMENT = TOKENS["NEW"]
BLANK = ord(" ")
QUOTE = ord('"')
COLON = ord(":")
COMMA = ord(",")
SEMICOLON = ord(";")
OPEN = ord("(")
CLOSE = ord(")")
LAST_LINE = 63999  # the ROM's largest line number

_LISTED = (*KEYWORDS, "", *[*CODES][1:], " ERROR\a", "", "", "")
"""LIST's words for the bytes from `FIRST` on: after the keywords the ROM's table continues with a
zero, which is an empty word, and the error messages."""
_BY_LETTER: dict[str, list[tuple[str, int]]] = {}
for _word, _token in TOKENS.items():
    _BY_LETTER.setdefault(_word[0], []).append((_word, _token))


def _keyword(text: str, start: int) -> tuple[int, int] | None:
    """Return token and end of the keyword at ``start``, ignoring blanks, or None. ``text`` ends
    with a zero. (A single regular expression for all keywords takes three times as long.)"""
    for word, token in _BY_LETTER.get(text[start], ()):
        position = start
        for letter in word:
            while text[position] == " ":
                position += 1
            if text[position] != letter:
                break
            position += 1
        else:
            if token != AT or text[position] not in ("N", "O"):
                return token, position
    return None


@lru_cache(maxsize=4096)
def tokenise(line: str, *, folded: bool = False) -> bytes:
    """Return the bytes of a line's statements as the ROM's parser makes them, without the final
    zero. ``folded``: small letters outside quotes and remarks count as capitals."""
    line = keyboard_codes(line)
    text = (line.upper() if folded else line) + "\0"
    out = bytearray()
    position = 0
    in_data = False
    while position < len(line):
        character = text[position]
        if character == " " and not in_data:
            position += 1
        elif character == '"':
            end = text.find('"', position + 1) + 1 or len(line)
            out += line[position:end].encode("ascii")
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
                out += line[position:].encode("ascii")
                break
        else:
            out.append(ord(character))
            position += 1
    return bytes(out)


def split_number(text: str) -> tuple[int, str] | None:
    """Return the line number at the start of a typed line and the text after it; None without a
    number. Blanks before and within the number are ignored. Raises ValueError past 63999."""
    statements = text.lstrip(" 0123456789")
    digits = text[: len(text) - len(statements)].replace(" ", "")
    if len(digits.lstrip("0")) > 5 or int(digits or 0) > LAST_LINE:
        raise ValueError("a line number goes up to 63999")
    return (int(digits), statements) if digits else None


def detokenise(tokens: bytes) -> str:
    """Return a text that tokenises into ``tokens``.

    There are blanks around keywords, except after REM and DATA, whose text is kept, and before
    them, so that the line is not mistaken for LIST's, which adds a blank there.
    PRINT is written as a question mark if its letters would form another word with the preceding
    ones: ``PO?``."""
    for print_word in ("PRINT", "?"):
        text, keyword = "", False
        for place, byte in enumerate(tokens):
            keyword = byte >= FIRST and byte not in (REM, DATA)
            if byte < FIRST:
                text += chr(byte)
                continue
            word = print_word if byte == PRINT else _LISTED[byte - FIRST]
            has_remark = not keyword and place < len(tokens) - 1
            is_apart = text and not (has_remark or text.endswith((" ", "(")))
            text += f" {word}" if is_apart else word
            if keyword and not word.endswith("("):
                text += " "
        text = text.rstrip(" ") if keyword else text
        if tokenise(text) == tokens:
            break
    return text


def list_text(byte: int) -> str:
    """Return LIST's text for a byte of a line."""
    return chr(byte) if byte < FIRST else f" {_LISTED[byte - FIRST]} "


def following_line(text: bytes | bytearray, line: int) -> int:
    """Return the address after the line that begins at ``line``, as $D4F2 finds it; 0 where the
    ROM would search without end.

    The search for the line's zero begins at its second token, and an index of one byte counts: a
    line longer than 255 bytes ends with the first zero of its own beginning.
    """
    place = text.find(0, line + 5, line + 256)
    if place < 0:
        place = text.find(0, line, line + 5)
    return place + 1 if place >= 0 else 0
