"""Programs as paper and disks hold them: text as it is typed, what LIST prints, tokenised files.

LIST ends rows where a printer or a screen ends them, and its blanks are not those that were typed:
behind REM and DATA one is LIST's own. A text is LIST's output if LIST prints the same rows again
for the program that they decode to (`Layout`); any other text is taken as typed. A row that could
be a line of its own or the rest of the line before is refused.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from ..errors import UserError
from .tokens import (
    COLON,
    COMMA,
    DATA,
    FIRST,
    LAST_LINE,
    LAST_STATEMENT,
    LINE_LIMIT,
    QUOTE,
    REM,
    TOKENS,
    listed,
    split_number,
    tokenise,
    untokenised,
)

WRAP_COLUMN = 33
"""From this column on LIST goes on in the next row after a character or a keyword."""
INDENT = 5
"""Columns by which LIST indents a row that continues a line."""
SCREEN_WIDTH = 40
WIDTHS = (WRAP_COLUMN, SCREEN_WIDTH, 80)
"""Columns at which rows usually end where LIST does not end them: POKE 33,33, screen, printer."""
LOST_BLANKS = 2
"""Blanks that may be lost at the end of a full row: two keywords leave so many."""
LONGEST_LISTED = 255
"""Tokens of the longest line that LIST's output is searched for; none so long can be typed."""
PARTIAL_KEYWORD = 12
"""Characters at the end of a text in which a keyword may be cut off."""
LINE_HEADER = 4
"""Bytes of a line in memory before its text: the next line's address, and its number."""
LENGTH_HEADER = 2
"""Bytes in front of a program on a DOS 3.3 disk: its length."""

_PROMPT = re.compile(r"\] *(?:LIST[-, 0-9]*)?$", re.I)
"""Rows of a session around a listing."""
_NUMBER = re.compile(r"([0-9]{1,5}) ")
_LINE_START = re.compile("([0-9]{1,5}) *(.+)")
_KEYWORD = re.compile(f" ({'|'.join(map(re.escape, sorted(TOKENS, key=len)[::-1]))})(?: |(?=\n)|$)")
_TEXT = bytes((*range(0x20, 0x7F), *b"\t\n\f\r"))
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")

Line = tuple[int, bytes]
"""A line's number and tokens."""


class Program(NamedTuple):
    """The lines of a program in the order in which they lie in memory, and what a user should
    know of how they were read, a sentence each."""

    lines: list[Line]
    remarks: list[str]


class Row(NamedTuple):
    """A row of a text: its number from 1, and its characters."""

    number: int
    text: str


def read_program(program: object) -> Program:
    """Read a program from the text or the bytes of a file.

    Parameters
    ----------
    program : str or bytes
        Numbered lines as they are typed, small letters as capitals outside quotes and remarks; what
        LIST prints, its rows ended by LIST itself or at the edge of a screen or a printer; or the
        bytes of such a text, in ASCII or with Apple's high bits, or of a tokenised program as disk
        tools extract it, with or without the length that DOS 3.3 puts in front.

    Raises
    ------
    UserError
        For a row that is no line and continues none, one that may be either, a line number past
        63999, a line longer than can be typed, a tab, or a character that no key of an Apple types;
        names the row, and where it can the column.
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
    return Program(_listed_lines(rows) or _typed_lines(rows), [])


def _rows(text: str) -> list[Row]:
    """The rows that are not blank, without the prompts around them and a common indentation."""
    texts = text.replace("\r\n", "\n").replace("\r", "\n").rstrip("\x1a").split("\n")
    rows = []
    for number, row in enumerate(texts, 1):
        row = row.strip("\f")
        for column, character in enumerate(row, 1):
            if not " " <= character <= "~" and (character > "~" or character in "\t\0"):
                what = "a tab" if character == "\t" else f"character {_code(character)}"
                place = f"row {number}, column {column}"
                raise UserError(f"{place}: {what}; expected characters that an Apple's keys type")
        if row.strip(" "):
            rows.append(Row(number, row))
    while rows and _PROMPT.match(rows[0].text):
        rows.pop(0)
    while rows and _PROMPT.match(rows[-1].text):
        rows.pop()
    if {len(row.text) for row in rows} == {SCREEN_WIDTH}:  # filled up, as screens are saved
        rows = [Row(row.number, row.text.rstrip(" ")) for row in rows]
    edge = min((_indentation(row.text) for row in rows), default=0)
    return [Row(row.number, row.text[edge:]) for row in rows]


def _indentation(text: str) -> int:
    return len(text) - len(text.lstrip(" "))


def _code(character: str) -> str:
    """A character as a message names it; a byte that is no text by its number."""
    code = ord(character)
    if 0xDC80 <= code < 0xDD00:
        return f"${code & 0xFF:02X}"
    return repr(character) if character.isprintable() else f"${code:02X}"


# --- what LIST prints -------------------------------------------------------------------------


class Layout(NamedTuple):
    """How the rows of a listing end: at ``width`` columns (0: nowhere), and, if LIST ``breaks``
    lines itself, from column 33 on, where it goes on with an indentation. ``silent``: nothing is
    sent at ``width`` columns, only the cursor goes on in the next row of the screen."""

    width: int
    breaks: bool
    silent: bool = False

    def rows(self, number: int, tokens: bytes) -> list[str]:
        """The rows that LIST prints for a line, without blanks at their ends."""
        rows, row, column = [], "", 0
        for piece in (str(number), " ", *map(listed, tokens)):
            for character in piece:
                row += character
                column += 1
                if column == self.width:
                    column = 0
                    if not self.silent:
                        rows.append(row)
                        row = ""
            if self.breaks and column >= WRAP_COLUMN:
                rows.append(row)
                row, column = " " * INDENT, INDENT
        return [text for row in (*rows, row) if (text := row.rstrip(" "))]

    def appended(self, text: str, row: str, following: str) -> str | None:
        """The text of a line so far, which ends with ``row``, and its next row: LIST's own break
        stands in it as a newline, and blanks lost at the end of a row are put back. None if no line
        goes on like this."""
        if self.breaks and following.startswith(" " * INDENT):
            column = len(row) % self.width if self.silent and self.width else len(row)
            return text + " " * (WRAP_COLUMN - column) + "\n" + following[INDENT:]
        if self.silent or len(row) > self.width:
            return None
        if len(row) < self.width - LOST_BLANKS and _beginning_line(following) is not None:
            return None
        return text + " " * (self.width - len(row)) + following


WHOLE = Layout(0, breaks=False, silent=True)
"""A line a row."""
SENT = Layout(SCREEN_WIDTH, breaks=True, silent=True)
"""What LIST sends to a file while the screen has its usual width."""
PRINTED = Layout(0, breaks=True, silent=True)
"""What it sends to a printer wider than its lines."""


def _decoded(text: str) -> tuple[bytes | None, int]:
    """The tokens of a line's text as LIST prints it, and how far it was read; None for the tokens
    where it is not LIST's."""
    tokens = bytearray()
    quoted = in_remark = in_data = False
    place = 0
    while place < len(text):
        character = text[place]
        if character == "\n":
            place += 1
        elif character != " " or quoted or in_remark or in_data:
            tokens.append(ord(character))
            place += 1
            if in_remark:
                continue
            if character == '"':
                quoted = not quoted
            elif character == ":" and not quoted:
                in_data = False
        elif match := _KEYWORD.match(text, place):
            token = TOKENS[match[1]]
            tokens.append(token)
            place = match.end()
            in_remark, in_data = token == REM, token == DATA
        elif text[place:].strip(" \n"):
            return None, place
        else:
            break
    return bytes(tokens), place


def _listed_lines(rows: Sequence[Row]) -> list[Line] | None:
    """The program that LIST prints as these rows; None if there is none. Raises UserError where
    there are two."""
    numbers = [number for row in rows if (number := _beginning_line(row.text)) is not None]
    every = len(numbers) == len(rows)
    whole = _lines_by(WHOLE, rows)
    if whole or (every and all(a < b for a, b in pairwise(numbers))):
        return whole
    longest = max(len(row.text.rstrip(" ")) for row in rows)
    usual = [SENT, PRINTED, Layout(SCREEN_WIDTH, breaks=True)]
    usual += [
        Layout(width, breaks=False) for width in WIDTHS if 0 <= width - longest <= LOST_BLANKS
    ]
    for layout in usual:
        if lines := _lines_by(layout, rows):
            return lines
    if longest < WRAP_COLUMN:  # no screen or printer has rows so short: these are typed lines
        return None
    others = [Layout(longest + blanks, breaks=False) for blanks in range(LOST_BLANKS + 1)]
    programs = [lines for layout in others if (lines := _lines_by(layout, rows))]
    if programs and (every or any(program != programs[0] for program in programs)):
        raise UserError(
            f"rows end at {longest} columns or a little later, and where lines begin and how many "
            "blanks stood there cannot be seen; expected every line in one row"
        )
    return programs[0] if programs else None


def _beginning_line(text: str) -> int | None:
    """The number of the line that a row may begin, None where it cannot."""
    match = _LINE_START.match(text)
    return int(match[1]) if match and _begins_line(tokenise(match[2], folded=True)) else None


def _begins_line(tokens: bytes) -> bool:
    """Return whether a statement may begin with these tokens."""
    if not tokens:
        return False
    first = tokens[0]
    return FIRST <= first <= LAST_STATEMENT or (chr(first).isascii() and chr(first).isalpha())


class _Reading(NamedTuple):
    """A way to read the rows from one on: its doubts, less its lines; the row behind the first
    line, the line, and a row at which another way, as good, begins a line."""

    doubts: int
    fewer: int
    following: int
    line: Line
    rival: int


def _lines_by(layout: Layout, rows: Sequence[Row]) -> list[Line] | None:
    """The program whose LIST in this layout is these rows: the way to read them with the fewest
    doubts, then the most lines. Raises UserError where two are as good."""
    texts = [row.text.rstrip(" ") for row in rows]
    readings: list[_Reading | None] = [None] * len(rows)
    for start in range(len(rows) - 1, -1, -1):
        best = None
        for end, line in _lines_from(layout, rows, start):
            rest = readings[end] if end < len(rows) else None
            if end < len(rows) and (rest is None or rest.line[0] <= line[0]):
                continue
            if layout.rows(*line) != texts[start:end]:
                continue
            doubts, fewer = _doubts(line[1]), -1
            if rest:
                doubts, fewer = doubts + rest.doubts, fewer + rest.fewer
            if best is None or (doubts, fewer) < best[:2]:
                best = _Reading(doubts, fewer, end, line, 0)
            elif (doubts, fewer) == best[:2]:
                best = best._replace(rival=rows[min(end, len(rows) - 1)].number)
        readings[start] = best
    lines = []
    place = 0
    while place < len(rows):
        reading = readings[place]
        if reading is None:
            return None
        if reading.rival:
            raise UserError(
                f"row {reading.rival} may begin a line or continue line {reading.line[0]}; "
                "expected every line in one row"
            )
        lines.append(reading.line)
        place = reading.following
    return lines


def _lines_from(layout: Layout, rows: Sequence[Row], start: int) -> Iterator[tuple[int, Line]]:
    """The lines that may begin in a row, each with the row behind it."""
    match = _NUMBER.match(rows[start].text)
    if not match or int(match[1]) > LAST_LINE:
        return
    text: str | None = rows[start].text
    for end in range(start + 1, len(rows) + 1):
        if text is None:
            return
        place = match.end()
        tokens, reached = _decoded(text[place:])
        if tokens is None and reached < len(text) - place - PARTIAL_KEYWORD:
            return
        if tokens and len(tokens) > LONGEST_LISTED:
            return
        if tokens and tokenise(untokenised(tokens), folded=True) == tokens:
            yield end, (int(match[1]), tokens)
        if end < len(rows):
            text = layout.appended(text, rows[end - 1].text, rows[end].text)


def _doubts(tokens: bytes) -> int:
    """Count what is odd about a line: that it ends within quotes, that no statement begins it."""
    return _ends_in_text(tokens, data=False) + (not _begins_line(tokens))


def _ends_in_text(tokens: bytes, *, data: bool = True) -> bool:
    """Return whether a line ends within quotes or an item of DATA, where a blank counts."""
    quoted = in_data = False
    for token in tokens:
        if token == REM and not quoted and not in_data:
            return False
        if token == QUOTE:
            quoted = not quoted
        elif not quoted and token in (DATA, COLON):
            in_data = token == DATA
    return quoted or (data and in_data and tokens[-1] != COMMA)


# --- what is typed ----------------------------------------------------------------------------


def _typed_lines(rows: Sequence[Row]) -> list[Line]:
    """The lines of a text as it is typed, in the order of their numbers, the last of equal ones; an
    indented row without a number continues the line before. Raises UserError."""
    lines: dict[int, bytes] = {}
    number, text, first_row = -1, "", 0
    for row in rows:
        indentation = _indentation(row.text)
        try:
            numbered = split_number(row.text)
        except ValueError as error:
            raise UserError(f"row {row.number}: {error}") from None
        if (
            numbered
            and indentation
            and number >= 0
            and (indentation >= INDENT or numbered[0] <= number)
        ):
            raise UserError(
                f"row {row.number} begins with blanks and a number: it may be line {numbered[0]} "
                f"or continue line {number}; expected line numbers at the left edge"
            )
        if numbered:
            number, text = numbered
            first_row = row.number
        elif number < 0:
            raise UserError(f"row {row.number} has no line number")
        elif not indentation:
            raise UserError(
                f"row {row.number} has no line number; a row that continues line {number} is "
                "indented"
            )
        elif _ends_in_text(tokenise(text, folded=True)):
            raise UserError(
                f"row {row.number} continues a text of line {number}, and how many blanks stood "
                "between them cannot be seen; expected the whole text in one row"
            )
        else:
            text += " " + row.text.lstrip(" ")
        tokens = tokenise(text, folded=True)
        if len(tokens) > LINE_LIMIT:
            raise UserError(
                f"row {first_row} has {len(tokens)} characters and keywords; "
                f"a line that can be typed has {LINE_LIMIT}"
            )
        lines[number] = tokens
    return sorted((number, tokens) for number, tokens in lines.items() if tokens)


# --- tokenised files --------------------------------------------------------------------------


def _read_image(data: bytes) -> Program | None:
    """The program in a tokenised file, None if that is something else."""
    length = int.from_bytes(data[:LENGTH_HEADER], "little")
    images = [data]
    if LENGTH_HEADER <= length <= len(data) - LENGTH_HEADER:
        images.append(data[LENGTH_HEADER : LENGTH_HEADER + length])
    for image in images:
        lines, end, links = [], 0, []
        while end + LINE_HEADER <= len(image) and image[end + 1]:
            close = image.find(0, end + LINE_HEADER)
            if close < 0:
                break
            links.append(int.from_bytes(image[end : end + 2], "little") - close - 1)
            lines.append(
                (
                    int.from_bytes(image[end + 2 : end + LINE_HEADER], "little"),
                    image[end + LINE_HEADER : close],
                )
            )
            end = close + 1
        # an address less its place in the file is where the program was when it was saved
        if lines and image[end : end + 2] == b"\0\0" and len(set(links)) == 1:
            left = image[end + 2 :].strip(b"\0")
            remarks = []
            if left:
                remarks.append(
                    f"{len(left)} bytes behind the program's last line, such as machine code, "
                    "are left out"
                )
            return Program(lines, remarks)
    return None
