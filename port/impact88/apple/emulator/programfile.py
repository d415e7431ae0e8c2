"""Programs from paper and disks: text as typed, LIST's output, tokenised files.

LIST breaks lines after column 33, and its blanks are not those typed: it adds one after REM and
DATA. A text is LIST's output if LIST would print the same rows for the decoded program (`Layout`);
any other text is read as typed. Rows cut at the edge of the paper are refused.
"""

import re
from collections.abc import Sequence
from itertools import pairwise
from operator import itemgetter
from typing import NamedTuple

from ...errors import UserError
from ..applesoft.console import MAX_INPUT
from .tokens import (
    DATA,
    FIRST,
    LAST_LINE,
    LAST_STATEMENT,
    REM,
    TOKENS,
    detokenise,
    following_line,
    list_text,
    split_number,
    tokenise,
)

WRAP_COLUMN = 33  # LIST continues in the next row after a character or keyword past this column
INDENT = 5  # columns by which LIST indents a continued line
SCREEN_WIDTH = 40
MAX_LISTED_TOKENS = 255  # in a line of LIST's output; no line so long can be typed
LINE_HEADER = 4  # bytes of a line before its tokens: the next line's address, and its number
LONGEST_LINE = 256  # bytes within which the ROM finds a line's end
MIN_BEGUN = 0.5  # of a program's lines are begun by a statement
LENGTH_HEADER = 2  # bytes before a program on a DOS 3.3 disk: its length

_PROMPT = re.compile(r"\] *(?:LIST[-, 0-9]*)?$", re.I)
"""Rows of a session around a listing."""
_NUMBER = re.compile(r"([0-9]{1,5}) ")
_KEYWORD = re.compile(f" ({'|'.join(map(re.escape, sorted(TOKENS, key=len)[::-1]))})(?: |(?=\n)|$)")
_TEXT = bytes((*range(0x20, 0x7F), *b"\t\n\f\r"))
_NO_KEY = re.compile(r"[\t\0]|[^\0-~]")  # a character that no key types
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")

Line = tuple[int, bytes]
"""Number and tokens of a line."""


class Row(NamedTuple):
    """A row of a text: its number from 1, and its characters."""

    number: int
    text: str


def read_program(program: object) -> list[Line]:
    """Read a program from the text or the bytes of a file.

    Parameters
    ----------
    program : str or bytes
        Numbered lines as typed, small letters outside quotes and remarks as capitals; LIST's
        output, its lines in one row or broken by LIST itself; or the bytes of such a text, in ASCII
        or with Apple's high bits, or of a tokenised program as disk tools extract it, with or
        without the length that DOS 3.3 puts in front.

    Returns
    -------
    list of (int, bytes)
        Number and tokens of each line, in memory order.

    Raises
    ------
    UserError
        For a row that is no line, a line number past 63999, a line longer than can be typed, a tab,
        or a character not on an Apple's keyboard; names the row and, if possible, the column.
    """
    if isinstance(program, bytes):
        body = program.rstrip(b"\0")
        if body and min(body) >= 0x80:
            program = bytes(byte & 0x7F for byte in body).decode("ascii")
        elif body[:2] in _UTF_16:
            program = program.decode("utf-16", "replace")
        elif body.translate(None, _TEXT) and (image := _read_image(program)):
            return image
        elif 0 in body:
            raise UserError("holds zero bytes and is no tokenised Applesoft program")
        else:
            program = body.decode("utf-8-sig", "surrogateescape")
    if not isinstance(program, str):
        kind = type(program).__name__
        raise UserError(f"expected a program's text, or the bytes of a file, not {kind}")
    rows = _rows(program)
    return _listed_lines(rows) or _typed_lines(rows)


def _rows(text: str) -> list[Row]:
    """Return the rows that are not blank, without surrounding prompts and common indentation."""
    texts = text.replace("\r\n", "\n").replace("\r", "\n").rstrip("\x1a").split("\n")
    rows = []
    for number, row in enumerate(texts, 1):
        row = row.strip("\f")
        if wrong := _NO_KEY.search(row):
            name = "a tab" if wrong[0] == "\t" else f"character {_code(wrong[0])}"
            place = f"row {number}, column {wrong.end()}"
            raise UserError(f"{place}: {name}; expected characters that an Apple's keys type")
        if row.strip(" "):
            rows.append(Row(number, row))
    while rows and _PROMPT.match(rows[0].text):
        rows.pop(0)
    while rows and _PROMPT.match(rows[-1].text):
        rows.pop()
    if {len(row.text) for row in rows} == {SCREEN_WIDTH}:  # padded, as screens are saved
        rows = [Row(row.number, row.text.rstrip(" ")) for row in rows]
    edge = min((len(row.text) - len(row.text.lstrip(" ")) for row in rows), default=0)
    return [Row(row.number, row.text[edge:]) for row in rows]


def _code(character: str) -> str:
    """Return a character for a message; an undecodable byte by its number."""
    code = ord(character)
    if 0xDC80 <= code < 0xDD00:
        return f"${code & 0xFF:02X}"
    return repr(character) if character.isprintable() else f"${code:02X}"


# --- LIST's output ----------------------------------------------------------------------------


class Layout(NamedTuple):
    """The line breaks of a listing.

    ``breaks``: LIST breaks lines from column 33 on and indents the next row; ``width``: columns of
    the screen, after which LIST counts anew and sends no newline, 0 for a device without an edge.
    """

    breaks: bool
    width: int = 0

    def rows(self, number: int, tokens: bytes) -> list[str]:
        """Return the rows that LIST prints for a line, without blanks at their ends."""
        rows, row, column = [], "", 0
        for piece in (str(number), " ", *map(list_text, tokens)):
            row += piece
            column += len(piece)
            if self.width:
                column %= self.width
            if self.breaks and column >= WRAP_COLUMN:
                rows.append(row)
                row, column = " " * INDENT, INDENT
        return [text for row in (*rows, row) if (text := row.rstrip(" "))]

    def join(self, rows: Sequence[str]) -> str:
        """Return the rows of a line as one text, with a newline and the blanks lost before it at
        each break."""
        text = rows[0]
        for row, following in pairwise(rows):
            column = len(row) % self.width if self.width else len(row)
            text += " " * (WRAP_COLUMN - column) + "\n" + following[INDENT:]
        return text


LAYOUTS = (Layout(breaks=False), Layout(breaks=True, width=SCREEN_WIDTH), Layout(breaks=True))
"""One line a row; LIST to a screen of the usual width or to a file; to a printer."""


def _listed_lines(rows: Sequence[Row]) -> list[Line] | None:
    """Return the program that LIST prints as these rows, None if there is none."""
    texts = [row.text for row in rows]
    return next((lines for layout in LAYOUTS if (lines := _lines_by(layout, texts))), None)


def _lines_by(layout: Layout, texts: Sequence[str]) -> list[Line] | None:
    """Return the program whose LIST in this layout is these rows, None without one."""
    starts = [at for at, text in enumerate(texts) if not (layout.breaks and text.startswith(" "))]
    lines: list[Line] = []
    for start, stop in pairwise((*starts, len(texts))):
        text = layout.join(texts[start:stop])
        match = _NUMBER.match(text)
        tokens = _decode(text[match.end() :]) if match else None
        if match is None or not tokens or len(tokens) > MAX_LISTED_TOKENS:
            return None
        line = int(match[1]), tokens
        is_next = (lines[-1][0] if lines else -1) < line[0] <= LAST_LINE
        can_be_typed = tokenise(detokenise(tokens), folded=True) == tokens
        listed = [text.rstrip(" ") for text in texts[start:stop]]
        if not (is_next and can_be_typed and layout.rows(*line) == listed):
            return None
        lines.append(line)
    return lines


def _decode(text: str) -> bytes | None:
    """Return the tokens of a line's text in LIST's output, None if it is not."""
    tokens = bytearray()
    in_quotes = in_remark = in_data = False
    place = 0
    while place < len(text):
        character = text[place]
        if character == "\n":
            place += 1
        elif character != " " or in_quotes or in_remark or in_data:
            tokens.append(ord(character))
            place += 1
            if in_remark:
                continue
            if character == '"':
                in_quotes = not in_quotes
            elif character == ":" and not in_quotes:
                in_data = False
        elif match := _KEYWORD.match(text, place):
            token = TOKENS[match[1]]
            tokens.append(token)
            place = match.end()
            in_remark, in_data = token == REM, token == DATA
        elif text[place:].strip(" \n"):
            return None
        else:
            break
    return bytes(tokens)


def _begins_line(tokens: bytes) -> bool:
    """Return True if a statement may begin with these tokens."""
    first = tokens[:1]
    return first.isalpha() or bytes([FIRST]) <= first <= bytes([LAST_STATEMENT])


# --- typed text -------------------------------------------------------------------------------


def _typed_lines(rows: Sequence[Row]) -> list[Line]:
    """Return the lines of a typed text by number; of lines with the same number the last counts.
    Raises UserError."""
    lines: dict[int, bytes] = {}
    for row in rows:
        try:
            numbered = split_number(row.text)
        except ValueError as error:
            raise UserError(f"row {row.number}: {error}") from None
        if numbered is None or row.text.startswith(" " * INDENT):
            fault = "has no line number at its left edge; expected each line in one row"
            raise UserError(f"row {row.number} {fault}")
        number, text = numbered
        tokens = tokenise(text, folded=True)
        if len(tokens) > MAX_INPUT:
            raise UserError(
                f"row {row.number} has {len(tokens)} characters and keywords; "
                f"a line that can be typed has {MAX_INPUT}"
            )
        lines[number] = tokens
    return sorted((number, tokens) for number, tokens in lines.items() if tokens)


# --- tokenised files --------------------------------------------------------------------------


def _read_image(data: bytes) -> list[Line] | None:
    """Return the program in a tokenised file, None for any other file."""
    length = int.from_bytes(data[:LENGTH_HEADER], "little")
    images = [_walk(data)]
    if LENGTH_HEADER <= length <= len(data) - LENGTH_HEADER:
        images.append(_walk(data[LENGTH_HEADER : LENGTH_HEADER + length]))
    lines, likelihood = max(images, key=itemgetter(1))
    return lines if 0 in data and likelihood >= MIN_BEGUN else None


def _walk(image: bytes) -> tuple[list[Line], float]:
    """Walk a program as $D4F2 does: links are not looked at but for a zero high byte, which ends
    it, as does the memory after the file, which holds zeros.

    Return its lines, and the likelihood that they are a program: 1 for one as SAVE writes it, else
    the share of lines that a statement may begin."""
    memory = image + bytes(LONGEST_LINE)
    lines: list[Line] = []
    starts: set[int] = set()  # a link minus its line's place in the file
    line = 0
    while line < len(image) and memory[line + 1]:
        following = following_line(memory, line)
        if following <= line + LINE_HEADER:
            return [], 0.0
        starts.add(int.from_bytes(memory[line : line + 2], "little") - following)
        number = int.from_bytes(memory[line + 2 : line + LINE_HEADER], "little")
        lines.append((number, memory[line + LINE_HEADER : following - 1]))
        line = following
    if len(starts) == 1 and image[line : line + 2] == b"\0\0":
        return lines, 1.0
    lines_begun = sum(_begins_line(tokens.lstrip(b" :")) for _, tokens in lines)
    return lines, lines_begun / max(1, len(lines))
