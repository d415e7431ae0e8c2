"""The text screen: 40 columns and 24 rows in memory, the cursor, and the text window.

Characters arrive without their high bit and are passed to a device. Columns that the cursor skipped
(comma zones, HTAB) may be passed as blanks if a character follows on the line; there is no newline
at column 40. The monitor computes a row's address when the cursor enters it, for any row number and
left edge: a change of the window takes effect only then, and may point outside the rows.
"""

import re
from collections.abc import Callable
from functools import lru_cache
from itertools import pairwise

from ..applesoft.console import Editor

WIDTH = 40
HEIGHT = 24
BASE = 0x400  # addresses of the screen
END = 0x800
# masks of the monitor
NORMAL = 0xFF
INVERSE = 0x3F
FLASHING = 0x7F
# codes on the screen
_BLANK = 0xA0
_SMALL_LETTERS = 0xE0
_CONTROLS = range(0x80, 0xA0)  # not shown; RETURN, control-J and control-H move the cursor
_BACKSPACE = 0x88
_LINE_FEED = 0x8A
_RETURN = 0x8D
_USUAL_MASKS = (NORMAL, INVERSE, FLASHING)  # under which all characters are visible
_SHOWS = re.compile("[^\0-\x09\x0b-\x1f]")
"""A visible character, or the end of the line."""
_TITLE = bytes(code | 0x80 for code in b"APPLE ][")  # in the first row after power-on
_TITLE_COLUMN = 15
_ESCAPES = {
    "@": 0xFC58,
    "A": 0xFBF4,
    "B": 0xFC10,
    "C": 0xFC66,
    "D": 0xFC1A,
    "E": 0xFC9C,
    "F": 0xFC42,
}
"""Keys after ESC, and the addresses of the monitor's routines that they call."""


@lru_cache
def _codes(mask: int) -> bytes:
    """Return the screen codes of all characters under a mask, which does not affect controls."""
    codes = (code | 0x80 for code in range(256))
    return bytes(code & mask if code >= _BLANK else code for code in codes)


class Screen(Editor):
    """The text screen in ``ram``.

    ``column``, ``row``: the cursor, from 0; ``left``, ``width``, ``top``, ``bottom``: the window;
    ``blanks``: pass skipped columns to the device as blanks, which the real machine does not;
    ``routines``: those of the monitor that move the cursor or clear, by address."""

    def __init__(self, ram: bytearray, device: Callable[[str], object], blanks: bool) -> None:
        self._ram, self._device, self._blanks = ram, device, blanks
        self.column = self._expected = 0
        self.mask = NORMAL
        self.full_window()
        ram[BASE:END] = bytes([_BLANK]) * (END - BASE)
        ram[BASE + _TITLE_COLUMN : BASE + _TITLE_COLUMN + len(_TITLE)] = _TITLE
        self.move_to_row(1)
        self.routines: dict[int, Callable[[], None]] = {
            0xFC58: self.home,
            0xFC56: self.home,  # a branch on the carry, which CALL clears, in front of it
            0xFC22: lambda: self.move_to_row(self.row),
            0xFC70: self._scroll,
            0xFC66: self._line_feed,
            0xFC1A: self._step_up,
            0xFC10: self._step_back,
            0xFBF4: self._advance,
            0xFC9C: lambda: self._clear_from(self.column),
            0xFC42: lambda: self._clear_rows(self.row, self.column),
            0xFC62: lambda: self.write("\n"),
            0xFB2F: self.full_window,
        }

    def write(self, text: str) -> None:
        gap = max(self.column - self._expected, 0) if self._blanks else 0
        sent = text
        if gap and (first := _SHOWS.search(text)):
            if first[0] != "\n":
                sent = text[: first.start()] + " " * gap + text[first.start() :]
            gap = 0
        self._device(sent)
        self._draw(text)
        self._expected = self.column - gap

    def _draw(self, text: str) -> None:
        if (
            self.mask in _USUAL_MASKS
            and text.isprintable()
            and self.column + len(text) < self.width
        ):
            codes = text.encode("latin-1").translate(_codes(self.mask))
            self._fill(self.address + self.column, codes)
            self.column += len(text)
            return
        for character in text:
            code = character.encode("latin-1").translate(_codes(self.mask))
            if code[0] not in _CONTROLS:
                self._fill(self.address + self.column, code)
                self._advance()
            elif code[0] == _BACKSPACE:
                self._step_back()
            elif code[0] in (_LINE_FEED, _RETURN):  # which a mask such as 128 may make of a letter
                if character == "\n" or code[0] == _RETURN:
                    self.column = 0
                self._line_feed()

    def _fill(self, address: int, codes: bytes | bytearray) -> None:
        """Store bytes from an address on, but none after the screen, where the program is."""
        codes = codes[: max(END - address, 0)]
        self._ram[address : address + len(codes)] = codes

    def _line_feed(self) -> None:
        row = self.row + 1 & 0xFF
        if row < self.bottom:
            self.move_to_row(row)
        else:
            self._scroll()

    def _step_up(self) -> None:
        if self.row > self.top:
            self.move_to_row(self.row - 1)

    def _scroll(self) -> None:
        ram, bottom = self._ram, max(self.bottom, self.top + 1)
        for upper, lower in row_moves(self.top, bottom, self.left, self.width):
            ram[upper] = ram[lower]
        self.address = row_address(bottom - 1, self.left)
        self._clear_from(0)
        self.move_to_row(self.row)

    def _clear_from(self, column: int) -> None:
        """Clear to the end of the window's row, one column at least."""
        columns = max(self.width - column, 1)
        self._fill(self.address + column, bytes([_BLANK]) * columns)

    def _clear_rows(self, row: int, column: int) -> None:
        for place in range(row, max(row + 1, self.bottom)):
            self.address = row_address(place, self.left)
            self._clear_from(column if place == row else 0)
        self.move_to_row(self.row)

    def rows(self) -> list[bytes]:
        starts = (row_address(row, 0) for row in range(HEIGHT))
        return [bytes(self._ram[start : start + WIDTH]) for start in starts]

    def text(self) -> str:
        """Return the 24 rows as text, without blanks at their ends."""
        return "".join("".join(map(shown_character, row)).rstrip(" ") + "\n" for row in self.rows())

    def home(self) -> None:
        self.row, self.column = self.top, 0
        self._clear_rows(self.top, 0)

    def _step_back(self) -> None:
        self.column -= 1
        if self.column < 0:
            self.column = self.width - 1 & 0xFF
            self._step_up()

    def _advance(self) -> None:
        self.column += 1
        if self.column >= self.width:
            self.column = 0
            self._line_feed()

    def full_window(self) -> None:
        """TEXT: set the window to the whole screen, the cursor to the last row."""
        self.left, self.width, self.top, self.bottom = 0, WIDTH, 0, HEIGHT
        self.move_to_row(HEIGHT - 1)

    def move_to_row(self, row: int) -> None:
        """VTAB: move the cursor to a row. After a POKE of ``row`` alone it moves with the next
        one."""
        self.row = row
        self.address = row_address(row, self.left)

    def stay_at(self, column: int) -> None:
        """Restore the column after a line feed, without skipped columns."""
        self.column = self._expected = column

    def under_cursor(self) -> str:
        address = self.address + self.column
        code = self._ram[address] if address < END else 0
        return chr((code & 0xDF if code >= _SMALL_LETTERS else code) & 0x7F)

    def escape(self, key: str) -> None:
        if key in _ESCAPES:
            self.routines[_ESCAPES[key]]()
            self._expected = self.column

    def end_line(self, shown: bool) -> None:
        self._clear_from(self.column)
        if shown:
            self._draw("\n")
            self._expected = 0

    def echo(self, keys: str, put: Callable[[str], object]) -> None:
        mask, self.mask = self.mask, NORMAL
        put(keys)
        self.mask = mask


def row_address(row: int, left: int) -> int:
    """Return the address of a row in a window with this left edge; of any row number."""
    low = (row & 0x18) * 5 + (row & 1) * 0x80 + left
    return BASE + (row >> 1 & 3) * 0x100 + (low & 0xFF)


@lru_cache(maxsize=64)
def row_moves(top: int, bottom: int, left: int, width: int) -> list[tuple[slice, slice]]:
    """Return target and source of each row that scrolling a window copies."""
    columns = width if 1 <= width <= 0x80 else 1  # the monitor counts down while they look positive
    first = width - columns & 0xFF
    starts = [row_address(row, left) + first for row in range(top, bottom)]
    # rows are 128 bytes apart at least, so none of these is read after it is written
    return [
        (slice(upper, min(upper + columns, END)), slice(lower, lower + min(columns, END - upper)))
        for upper, lower in pairwise(starts)
        if upper < END
    ]


def shown_character(code: int) -> str:
    """Return the character of a screen byte, inverse and flashing ones as normal ones."""
    code &= 0x3F if 0x60 <= code < 0x80 else 0x7F
    return chr(code + 0x40 if code < 0x20 else code)
