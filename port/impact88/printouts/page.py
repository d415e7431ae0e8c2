"""The program's page: its rows as a template, and the cells that a text is aligned with."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import accumulate, groupby
from typing import NamedTuple

ROWS = (
    "ENTER THE INITIAL VELOCITY COMPONENTS OF MA :Vax,Vay,Wa ?{REPLY_A}",
    "ENTER THE INITIAL VELOCITY COMPONENTS OF MB :Vbx,Vby,Wb ?{REPLY_B}",
    "MA= {MA} MB= {MB} IA= {IA} IB= {IB}",
    "DA= {DA} DB= {DB}",
    " PA PB TA TB GA",
    " {PA}      {PB}      {TA}      {TB}      {GA}",
    "UX= {UX} UY= {UY} WA= {WA} XA= {XA} YA= {YA}",
    "VX= {VX} VY= {VY} WB= {WB} XB= {XB} YB= {YB}",
    " E= {E} MU= {MUP} EM= {EM}",
    "INITIAL KE= {KI} KE LOSS= {LOSS} %",
    "*****",
    "VAX= {VAX} VAY= {VAY} (XA={XAF} YA= {YAF})",
    "VBX= {VBX} VBY= {VBY} (XB={XBF} YB= {YBF})",
    " WA= {WAF} WB= {WBF}",
    "*****",
)
"""Text of lines 200 to 770, numbers in braces; blank lines are left out."""
PROMPTS = (0, 1)
HEADING = 4
ANGLE_ROW = 5
ASTERISKS = (10, 14)
ANGLES = ("PA", "PB", "TA", "TB", "GA")
PARTNERS = {"PA": "TA", "TA": "PA", "PB": "TB", "TB": "PB"}
"""Angles that enter only as a sum."""
REPLIES = {"REPLY_A": ("UX", "UY", "WA"), "REPLY_B": ("VX", "VY", "WB")}
MANY = ("ANGLES", *REPLIES)
"""Places of several numbers."""
NAMES = tuple(re.findall(r"{(\w+)}", " ".join(ROWS[2:])))
"""The printed numbers, in order."""
INPUTS = tuple("MA MB IA IB DA DB PA PB TA TB GA UX UY WA VX VY WB E MUP EM".split())
RESULTS = tuple(name for name in NAMES if name not in INPUTS)
ROW_OF = {name: row for row, text in enumerate(ROWS) for name in re.findall(r"{(\w+)}", text)} | {
    "ANGLES": ANGLE_ROW
}
"""Row of each number."""
TITLES = tuple(
    "asterisks"
    if row in ASTERISKS
    else " ".join(re.findall(r"[A-Za-z]+", re.sub("{.*?}", "", text)))[:24] or "five angles"
    for row, text in enumerate(ROWS)
)
"""Names of the rows in words: its labels."""

BLANKS = {
    match[1]: (len(text[: match.start()]) - len(text[: match.start()].rstrip()), len(match[2]))
    for text in ROWS
    for match in re.finditer(r"{(\w+)}( *)", text)
}
"""Blanks before and after each number."""


class Cell(NamedTuple):
    """A place of the page.

    Parameters
    ----------
    char : str
        The printed character in capitals, "" for a slot and for what precedes a row.
    kind : str
        "between" (before a row), "slot" (a number) or "word" (a printed character).
    name : str
        The number to which it belongs.
    row : int
        Index in `ROWS`.
    first : bool
        True at the beginning of a word.
    """

    char: str
    kind: str
    name: str
    row: int
    first: bool = False


def _cells_of(row: int, text: str) -> Iterator[Cell]:
    """Yield the cells of a row: words, the number after them, and the mark after it."""
    if row != ANGLE_ROW:
        yield Cell("", "between", "", row)
    for words, name, mark in re.findall(r"([^{]+)(?:{(\w+)} ?([)%]?))?", text):
        for word in re.findall("[A-Z]+|[^A-Z ]", words):
            yield from (Cell(char, "word", name, row, not k) for k, char in enumerate(word))
        if name:
            yield Cell("", "slot", name, row, True)
        if mark:
            yield Cell(mark, "word", name, row, True)


CELLS = tuple(
    cell
    for row, text in enumerate(ROWS)
    for cell in _cells_of(row, re.sub("{PA}.*", "{ANGLES}", text.upper()))
)
"""The page with each number as one slot; the five angles share one."""
SLOT_CELLS = {cell.name: j for j, cell in enumerate(CELLS) if cell.kind == "slot"}
SLOT_CELLS |= dict.fromkeys(ANGLES, SLOT_CELLS["ANGLES"])
"""The cell of each number; the five angles share one."""
_STARTS = [*accumulate(cell.first for cell in CELLS)]
_CELLS_OF_WORDS = (j for j, cell in enumerate(CELLS) if cell.kind == "word")
WORD_CELLS = [[*word] for _, word in groupby(_CELLS_OF_WORDS, _STARTS.__getitem__)]
"""The cells of each word or mark of the page."""


class PrintedChar(NamedTuple):
    """A character of a predicted page: its place, and the number it belongs to ("" for words)."""

    row: int
    column: int
    char: str
    name: str


def print_page(fields: Mapping[str, str], replies: Mapping[str, str]) -> list[PrintedChar]:
    """Return the characters of the page that has some numbers.

    Parameters
    ----------
    fields : mapping of str to str
        The printed numbers by name; rows without any are left out.
    replies : mapping of str to str
        The replies typed at the prompts, by name (`REPLIES`).

    Returns
    -------
    list of PrintedChar
        All characters but blanks, row by row (`ROWS`).
    """
    texts = {**fields, **replies}
    chars = []
    for row in printed_rows(texts):
        column = 0
        for part in re.split(r"({\w+})", ROWS[row]):
            name = part[1:-1] if part.startswith("{") else ""
            text = texts.get(name, "") if name else part
            at = enumerate(text, column)
            chars += [PrintedChar(row, k, char, name) for k, char in at if char != " "]
            column += len(text)
    return chars


def printed_rows(shown: Mapping[str, str]) -> list[int]:
    """Return the rows that a page with some numbers has."""
    rows = {ROW_OF[name] for name in shown if name in ROW_OF}
    rows |= {HEADING} if ANGLE_ROW in rows else set()
    rows |= {ASTERISKS[0]} if "VAX" in shown else set()
    rows |= {ASTERISKS[1]} if "YBF" in shown else set()
    return sorted(rows)
