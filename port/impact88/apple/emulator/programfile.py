"""Programs from paper and disks: text as typed, LIST's output, tokenised files.

Rows of LIST end where a printer or a screen ends them, and its blanks are not those typed: it adds
one after REM and DATA. A text is LIST's output if LIST would print the same rows for the decoded
program (`Layout`); any other text is read as typed. A row that could be either a new line or the
continuation of the previous one is refused.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from ...errors import UserError
from .tokens import (
    COLON,
    COMMA,
    DATA,
    FIRST,
    LAST_LINE,
    LAST_STATEMENT,
    MAX_INPUT,
    QUOTE,
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
WIDTHS = (WRAP_COLUMN, SCREEN_WIDTH, 80)
"""Usual row lengths if LIST does not wrap lines: POKE 33,33, screen, printer."""
MAX_LOST_BLANKS = 2  # at the end of a full row; two keywords leave two
MAX_LISTED_TOKENS = 255  # in a line of LIST's output; no line so long can be typed
MAX_KEYWORD_PIECE = 12  # characters at the end of a text in which a keyword may be cut off
LINE_HEADER = 4  # bytes of a line before its tokens: the next line's address, and its number
LONGEST_LINE = 256  # bytes within which the ROM finds a line's end
MIN_BEGUN = 0.5  # of a program's lines are begun by a statement
LENGTH_HEADER = 2  # bytes before a program on a DOS 3.3 disk: its length

_PROMPT = re.compile(r"\] *(?:LIST[-, 0-9]*)?$", re.I)
"""Rows of a session around a listing."""
_NUMBER = re.compile(r"([0-9]{1,5}) ")
_LINE_START = re.compile("([0-9]{1,5}) *(.+)")
_KEYWORD = re.compile(f" ({'|'.join(map(re.escape, sorted(TOKENS, key=len)[::-1]))})(?: |(?=\n)|$)")
_TEXT = bytes((*range(0x20, 0x7F), *b"\t\n\f\r"))
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")

Line = tuple[int, bytes]
"""Number and tokens of a line."""


class Program(NamedTuple):
    """A program: its lines in memory order, and remarks for the user on how it was read."""

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
        Numbered lines as typed, small letters outside quotes and remarks as capitals; LIST's
        output, its rows wrapped by LIST itself or at the edge of a screen or printer; or the bytes
        of such a text, in ASCII or with Apple's high bits, or of a tokenised program as disk tools
        extract it, with or without the length that DOS 3.3 puts in front.

    Returns
    -------
    Program
        Lines and remarks.

    Raises
    ------
    UserError
        For a row that is not a line and continues none, a row that may be either, a line number
        past 63999, a line longer than can be typed, a tab, or a character not on an Apple's
        keyboard; names the row and, if possible, the column.
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
    """Return the rows that are not blank, without surrounding prompts and common indentation."""
    texts = text.replace("\r\n", "\n").replace("\r", "\n").rstrip("\x1a").split("\n")
    rows = []
    for number, row in enumerate(texts, 1):
        row = row.strip("\f")
        for column, character in enumerate(row, 1):
            if not " " <= character <= "~" and (character > "~" or character in "\t\0"):
                name = "a tab" if character == "\t" else f"character {_code(character)}"
                place = f"row {number}, column {column}"
                raise UserError(f"{place}: {name}; expected characters that an Apple's keys type")
        if row.strip(" "):
            rows.append(Row(number, row))
    while rows and _PROMPT.match(rows[0].text):
        rows.pop(0)
    while rows and _PROMPT.match(rows[-1].text):
        rows.pop()
    if {len(row.text) for row in rows} == {SCREEN_WIDTH}:  # padded, as screens are saved
        rows = [Row(row.number, row.text.rstrip(" ")) for row in rows]
    edge = min((_indentation(row.text) for row in rows), default=0)
    return [Row(row.number, row.text[edge:]) for row in rows]


def _indentation(text: str) -> int:
    return len(text) - len(text.lstrip(" "))


def _code(character: str) -> str:
    """Return a character for a message; an undecodable byte by its number."""
    code = ord(character)
    if 0xDC80 <= code < 0xDD00:
        return f"${code & 0xFF:02X}"
    return repr(character) if character.isprintable() else f"${code:02X}"


# --- LIST's output ----------------------------------------------------------------------------


class Layout(NamedTuple):
    """The line breaks of a listing.

    ``width``: columns of a row, 0 for no limit; ``breaks``: LIST itself breaks lines from column 33
    on and indents the next row; ``silent``: at ``width`` columns only the cursor moves to the next
    row, and no newline is sent."""

    width: int
    breaks: bool
    silent: bool = False

    def rows(self, number: int, tokens: bytes) -> list[str]:
        """Return the rows that LIST prints for a line, without blanks at their ends."""
        rows, row, column = [], "", 0
        for piece in (str(number), " ", *map(list_text, tokens)):
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

    def append_row(self, text: str, row: str, following: str) -> str | None:
        """Return the ``text`` of a line, which ends with ``row``, with its next row ``following``.

        LIST's own break becomes a newline, and blanks lost at the end of a row are restored. None
        if no line continues like this."""
        if self.breaks and following.startswith(" " * INDENT):
            column = len(row) % self.width if self.silent and self.width else len(row)
            return text + " " * (WRAP_COLUMN - column) + "\n" + following[INDENT:]
        if self.silent or len(row) > self.width:
            return None
        if len(row) < self.width - MAX_LOST_BLANKS and _beginning_line(following) is not None:
            return None
        return text + " " * (self.width - len(row)) + following


UNBROKEN = Layout(0, breaks=False, silent=True)  # one line a row
TO_FILE = Layout(SCREEN_WIDTH, breaks=True, silent=True)  # the screen having its usual width
TO_PRINTER = Layout(0, breaks=True, silent=True)  # a printer wider than the lines


def _decode(text: str) -> tuple[bytes | None, int]:
    """Return the tokens of a line's text in LIST's output, None if it is not, and the index up to
    which it was read."""
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
            return None, place
        else:
            break
    return bytes(tokens), place


def _listed_lines(rows: Sequence[Row]) -> list[Line] | None:
    """Return the program that LIST prints as these rows, None if there is none. Raises UserError if
    there are two."""
    numbers = [number for row in rows if (number := _beginning_line(row.text)) is not None]
    all_numbered = len(numbers) == len(rows)
    unbroken = _lines_by(UNBROKEN, rows)
    if unbroken or (all_numbered and all(a < b for a, b in pairwise(numbers))):
        return unbroken
    longest = max(len(row.text.rstrip(" ")) for row in rows)
    usual_layouts = [TO_FILE, TO_PRINTER, Layout(SCREEN_WIDTH, breaks=True)]
    usual_layouts += [
        Layout(width, breaks=False) for width in WIDTHS if 0 <= width - longest <= MAX_LOST_BLANKS
    ]
    for layout in usual_layouts:
        if lines := _lines_by(layout, rows):
            return lines
    if longest < WRAP_COLUMN:  # too short for a screen or printer: typed lines
        return None
    layouts = [Layout(longest + blanks, breaks=False) for blanks in range(MAX_LOST_BLANKS + 1)]
    programs = [lines for layout in layouts if (lines := _lines_by(layout, rows))]
    if programs and (all_numbered or any(program != programs[0] for program in programs)):
        raise UserError(
            f"rows end at {longest} columns or a little later, and where lines begin and how many "
            "blanks stood there cannot be seen; expected every line in one row"
        )
    return programs[0] if programs else None


def _beginning_line(text: str) -> int | None:
    """Return the number of the line that a row may begin, None if it cannot."""
    match = _LINE_START.match(text)
    return int(match[1]) if match and _begins_line(tokenise(match[2], folded=True)) else None


def _begins_line(tokens: bytes) -> bool:
    """Return True if a statement may begin with these tokens."""
    if not tokens:
        return False
    first = tokens[0]
    return FIRST <= first <= LAST_STATEMENT or (chr(first).isascii() and chr(first).isalpha())


class _Reading(NamedTuple):
    """A reading of the rows from one on.

    ``doubts``: oddities, see `_doubts`; ``fewer``: minus the number of lines; ``following``: the
    row after the first line; ``line``: that line; ``rival``: a row at which an equally good reading
    begins a line, 0 without one."""

    doubts: int
    fewer: int
    following: int
    line: Line
    rival: int


def _lines_by(layout: Layout, rows: Sequence[Row]) -> list[Line] | None:
    """Return the program whose LIST in this layout is these rows, None without one: the reading
    with the fewest doubts, then the most lines. Raises UserError if two are equally good.

    Readings are found from the last row to the first, each from the best one of the rows after its
    first line."""
    texts = [row.text.rstrip(" ") for row in rows]
    readings: list[_Reading | None] = [None] * len(rows)
    for start in range(len(rows) - 1, -1, -1):
        best = None
        for end, line in _lines_from(layout, rows, start):
            remainder = readings[end] if end < len(rows) else None
            if end < len(rows) and (remainder is None or remainder.line[0] <= line[0]):
                continue
            if layout.rows(*line) != texts[start:end]:
                continue
            doubts, fewer = _doubts(line[1]), -1
            if remainder:
                doubts, fewer = doubts + remainder.doubts, fewer + remainder.fewer
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
    """Yield the lines that may begin in a row, each with the index of the row after it."""
    match = _NUMBER.match(rows[start].text)
    if not match or int(match[1]) > LAST_LINE:
        return
    text: str | None = rows[start].text
    for end in range(start + 1, len(rows) + 1):
        if text is None:
            return
        place = match.end()
        tokens, end_read = _decode(text[place:])
        if tokens is None and end_read < len(text) - place - MAX_KEYWORD_PIECE:
            return
        if tokens and len(tokens) > MAX_LISTED_TOKENS:
            return
        if tokens and tokenise(detokenise(tokens), folded=True) == tokens:
            yield end, (int(match[1]), tokens)
        if end < len(rows):
            text = layout.append_row(text, rows[end - 1].text, rows[end].text)


def _doubts(tokens: bytes) -> int:
    """Return the number of oddities of a line: it ends within quotes, no statement begins it."""
    return _ends_in_text(tokens, data=False) + (not _begins_line(tokens))


def _ends_in_text(tokens: bytes, *, data: bool = True) -> bool:
    """Return True if a line ends within quotes or an item of DATA, where blanks matter."""
    in_quotes = in_data = False
    for token in tokens:
        if token == REM and not in_quotes and not in_data:
            return False
        if token == QUOTE:
            in_quotes = not in_quotes
        elif not in_quotes and token in (DATA, COLON):
            in_data = token == DATA
    return in_quotes or (data and in_data and tokens[-1] != COMMA)


# --- typed text -------------------------------------------------------------------------------


def _typed_lines(rows: Sequence[Row]) -> list[Line]:
    """Return the lines of a typed text by number; of lines with the same number the last counts. An
    indented row without a number continues the previous line. Raises UserError."""
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
        if len(tokens) > MAX_INPUT:
            raise UserError(
                f"row {first_row} has {len(tokens)} characters and keywords; "
                f"a line that can be typed has {MAX_INPUT}"
            )
        lines[number] = tokens
    return sorted((number, tokens) for number, tokens in lines.items() if tokens)


# --- tokenised files --------------------------------------------------------------------------


class _Image(NamedTuple):
    """A tokenised file as the ROM walks it: its lines, the number of links that were wrong,
    whether it ends with two zeros, and what follows the program."""

    lines: list[Line]
    wrong_links: int
    is_ended: bool
    extra: bytes

    @property
    def likelihood(self) -> float:
        """1 for a program as SAVE writes it, else the share of lines that a statement may begin."""
        if self.lines and self.is_ended and not self.wrong_links:
            return 1.0
        lines_begun = sum(_begins_line(tokens.lstrip(b" :")) for _, tokens in self.lines)
        return lines_begun / max(1, len(self.lines))


def _read_image(data: bytes) -> Program | None:
    """Return the program in a tokenised file, None for any other file."""
    length = int.from_bytes(data[:LENGTH_HEADER], "little")
    images = [_walk(data)]
    if LENGTH_HEADER <= length <= len(data) - LENGTH_HEADER:
        images.append(_walk(data[LENGTH_HEADER : LENGTH_HEADER + length]))
    best = max(images, key=lambda image: image.likelihood)
    if 0 not in data or best.likelihood < MIN_BEGUN:
        return None
    remarks = []
    if best.wrong_links:
        remarks.append(
            f"{best.wrong_links} of {len(best.lines)} links between lines led elsewhere; they are "
            "made anew, as the Apple does"
        )
    if best.extra:
        remarks.append(
            f"{len(best.extra)} bytes after the program's last line, such as machine code, "
            "are left out"
        )
    return Program(best.lines, remarks)


def _walk(image: bytes) -> _Image:
    """Walk a program as $D4F2 does: links are not looked at but for a zero high byte, which ends
    it, as does the memory after the file, which holds zeros."""
    memory = image + bytes(LONGEST_LINE)
    lines: list[Line] = []
    links: list[int] = []
    line = 0
    while line < len(image) and memory[line + 1]:
        following = following_line(memory, line)
        if following <= line + LINE_HEADER:
            return _Image([], 0, False, b"")
        links.append(int.from_bytes(memory[line : line + 2], "little") - following)
        number = int.from_bytes(memory[line + 2 : line + LINE_HEADER], "little")
        lines.append((number, memory[line + LINE_HEADER : following - 1]))
        line = following
    # a link minus its line's place in the file is the address of the program when it was saved
    usual = max(links, key=links.count, default=0)
    wrong = len(links) - links.count(usual)
    is_ended = image[line : line + 2] == b"\0\0"
    return _Image(lines, wrong, is_ended, image[line + 2 :].strip(b"\0"))
