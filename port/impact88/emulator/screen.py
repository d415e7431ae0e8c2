"""The text screen: 40 columns and 24 rows in memory, the cursor, and the text window.

Characters come with their high bit dropped. The screen passes them on to a device in the same form;
columns that the cursor skipped (comma zones, HTAB) can be passed on as blanks when a character
follows on the line. Rows have no newline at column 40.

Rows lie in memory in three groups, 128 bytes from one to the next, with eight bytes between the
groups that no row shows. The monitor works out a row's address when the cursor comes to it, from
any row number and with the window's left edge added: so a window set while the cursor stands
outside has its effect only then, and odd ones write where no row is.
"""

from __future__ import annotations

from collections.abc import Callable

from ..applesoft.console import Editor

WIDTH = 40
HEIGHT = 24
BASE, END = 0x400, 0x800
NORMAL, INVERSE, FLASHING = 0xFF, 0x3F, 0x7F
_BLANK = 0xA0
_SMALL_LETTERS = 0xE0
_TITLE, _TITLE_COLUMN = bytes(code | 0x80 for code in b"APPLE ]["), 15
"""What switching on shows in the first row."""
_PENDING_LIMIT = 20_000
_ESCAPES = {
    **{"@": 0xFC58, "A": 0xFBF4, "B": 0xFC10, "C": 0xFC66},
    **{"D": 0xFC1A, "E": 0xFC9C, "F": 0xFC42},
}
"""Keys after ESC, and the routines of the monitor that they call."""


class Screen(Editor):
    """Where characters appear, in ``ram``, and where the next one will.

    ``column`` and ``row`` are the cursor's, from 0; ``left``, ``width``, ``top`` and ``bottom`` the
    window's. ``blanks``: whether skipped columns are passed on as blanks; the machine sends none.
    """

    def __init__(
        self, ram: bytearray, device: Callable[[str], object], *, blanks: bool = True
    ) -> None:
        self._ram = ram
        self._device = device
        self._blanks = blanks
        self.column = 0
        self._expected = 0
        self.left, self.width, self.top, self.bottom = 0, WIDTH, 0, HEIGHT
        self.mask = self._mask_between = NORMAL
        self._row = 0
        self._address = BASE
        self._pending: list[tuple[int, str]] = []
        self._pending_size = 0
        ram[BASE:END] = bytes([_BLANK]) * (END - BASE)
        ram[BASE + _TITLE_COLUMN : BASE + _TITLE_COLUMN + len(_TITLE)] = _TITLE
        self.move_to_row(1)

    # --- characters ---------------------------------------------------------------------------

    def write(self, text: str) -> None:
        """Show characters, and pass them on."""
        gap = self.column - self._expected
        if gap > 0 and self._blanks:
            shown, gap = _filled(text, gap)
            self._device(shown)
        else:
            gap = 0
            self._device(text)
        self._draw_later(text)
        if text.isprintable() and self.column + len(text) < self.width:
            self.column += len(text)
        else:
            self._move(text)
        self._expected = self.column - gap

    def _move(self, text: str) -> None:
        """Where the cursor's column goes."""
        for character in text:
            if character >= " ":
                self.column += 1
                if self.column >= self.width:
                    self.column = 0
            elif character in "\n\r":
                self.column = 0
            elif character == "\b":
                self.column -= 1
                if self.column < 0:
                    self.column = self.width - 1 & 0xFF

    # --- the picture, drawn only when somebody looks ------------------------------------------

    def _draw_later(self, text: str) -> None:
        if self._pending_size > _PENDING_LIMIT:
            self._draw()
        self._pending.append((self.column, text))
        self._pending_size += len(text) + 8

    def _draw(self) -> None:
        pending, self._pending = self._pending, []
        self._pending_size = 0
        for column, text in pending:
            for character in text:
                if character >= " ":
                    code = ord(character) | 0x80
                    self._put(self._address + column, code & self.mask if code >= _BLANK else code)
                    column += 1
                    if column >= self.width:
                        column = 0
                        self._line_feed()
                elif character in "\n\r":
                    column = 0
                    self._line_feed()
                elif character == "\b":
                    column -= 1
                    if column < 0:
                        column = self.width - 1 & 0xFF
                        self._step_up()

    def _put(self, address: int, code: int) -> None:
        """A byte on the screen; behind its end there is the program, which nothing here writes."""
        if address < END:
            self._ram[address] = code

    def _fill(self, address: int, codes: bytes | bytearray) -> None:
        """Bytes from an address on, those behind the screen's end dropped as by ``_put``."""
        codes = codes[: max(END - address, 0)]
        self._ram[address : address + len(codes)] = codes

    def _go_to_row(self, row: int) -> None:
        """The cursor's address in a row, whether the screen has such a row or not."""
        page = BASE + (row >> 1 & 3) * 0x100
        low = (row & 0x18) * 5 + (row & 1) * 0x80 + self.left
        self._address = page + (low & 0xFF)

    def _line_feed(self) -> None:
        self._row = self._row + 1 & 0xFF
        if self._row < self.bottom:
            self._go_to_row(self._row)
        else:
            self._row = self._row - 1 & 0xFF
            self._scroll()

    def _step_up(self) -> None:
        if self._row > self.top:
            self._row -= 1
            self._go_to_row(self._row)

    def _scroll(self) -> None:
        row = self.top
        self._go_to_row(row)
        while row + 1 < self.bottom:
            row += 1
            upper = self._address
            self._go_to_row(row)
            # the monitor counts columns down while they look positive
            columns = self.width if 1 <= self.width <= 0x80 else 1
            first = self.width - columns & 0xFF
            # rows are 128 bytes apart at least, so none of these is read after it is written
            source = self._address + first
            self._fill(upper + first, self._ram[source : source + columns])
        self._clear_from(0)
        self._go_to_row(self._row)

    def _clear_from(self, column: int) -> None:
        """Blanks to the end of the window's row; one at least."""
        columns = max(self.width - column, 1)
        self._fill(self._address + column, bytes([_BLANK]) * columns)

    def _clear_rows(self, row: int, column: int) -> None:
        while True:
            self._go_to_row(row)
            self._clear_from(column)
            row, column = row + 1, 0
            if row >= self.bottom:
                break
        self._go_to_row(self._row)

    @property
    def row(self) -> int:
        """The cursor's row."""
        self._draw()
        return self._row

    def rows(self) -> list[bytes]:
        """The 24 rows as they lie in memory, 40 bytes each."""
        self._draw()
        starts = (BASE + row % 8 * 0x80 + row // 8 * WIDTH for row in range(HEIGHT))
        return [bytes(self._ram[start : start + WIDTH]) for start in starts]

    def text(self) -> str:
        """The 24 rows as text, blanks at the end of each cut; inverse and flashing characters as
        normal ones."""
        return "".join("".join(map(shown_character, row)).rstrip(" ") + "\n" for row in self.rows())

    def byte_at(self, address: int) -> int:
        """What screen memory holds."""
        self._draw()
        return self._ram[address]

    def put_byte(self, address: int, value: int) -> None:
        """POKE into screen memory."""
        self._draw()
        self._ram[address] = value

    # --- the cursor -------------------------------------------------------------------------

    def _home(self) -> None:
        self._row = self.top
        self.column = 0
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

    def call(self, address: int) -> bool:
        """CALL of a routine of the monitor that moves or clears; whether it is one."""
        routine = {
            0xFC58: self._home,
            0xFC9C: lambda: self._clear_from(self.column),
            0xFC42: lambda: self._clear_rows(self._row, self.column),
            0xFC70: self._scroll,
            0xFC66: self._line_feed,
            0xFC1A: self._step_up,
            0xFC10: self._step_back,
            0xFBF4: self._advance,
            0xFC62: lambda: self.write("\n"),
            0xFB2F: self.full_window,
        }.get(address)
        if routine:
            self._draw()
            routine()
        return routine is not None

    def home(self) -> None:
        """HOME: clear the window; the cursor at its top left."""
        self._draw()
        self._home()

    def full_window(self) -> None:
        """TEXT: the whole screen, the cursor in the last row."""
        self._draw()
        self.left, self.width, self.top, self.bottom = 0, WIDTH, 0, HEIGHT
        self.move_to_row(HEIGHT - 1)

    def move_to_row(self, row: int) -> None:
        """VTAB."""
        self._draw()
        self._row = row
        self._go_to_row(row)

    def stay_at(self, column: int) -> None:
        """After a line feed: the column is what it was, and nothing has been skipped."""
        self.column = self._expected = column

    def set_mode(self, mask: int) -> None:
        """NORMAL, INVERSE or FLASHING, for characters from now on."""
        self._draw()
        self.mask = mask

    def poke(self, field: str, value: int) -> None:
        """POKE of what page 0 holds of the screen. A row's number alone does not move the cursor,
        an edge of the window acts when it moves."""
        self._draw()
        setattr(self, "_row" if field == "row" else field, value)

    # --- typing -------------------------------------------------------------------------------

    def under_cursor(self) -> str:
        """The character that control-U takes."""
        self._draw()
        address = self._address + self.column
        code = self._ram[address] if address < END else 0
        return chr((code & 0xDF if code >= _SMALL_LETTERS else code) & 0x7F)

    def escape(self, key: str) -> None:
        """ESC and @ and A to F: clear the screen, move, clear to the end of the row or window."""
        if self.call(_ESCAPES.get(key, 0)):
            self._expected = self.column

    def end_line(self) -> None:
        """RETURN: what stands behind the cursor in its row is cleared."""
        self._draw()
        self._clear_from(self.column)

    def begin_echo(self) -> None:
        """A key is shown, which is never inverse."""
        self._mask_between = self.mask
        if self.mask != NORMAL:
            self.set_mode(NORMAL)

    def end_echo(self) -> None:
        """The key is shown."""
        if self._mask_between != NORMAL:
            self.set_mode(self._mask_between)

    def typed(self) -> None:
        """A line was typed on a terminal, which has shown it: the cursor is at the left."""
        self._draw_later("\n")
        self.column = self._expected = 0


def _filled(text: str, gap: int) -> tuple[str, int]:
    """``text`` with blanks before the first character that shows on this line, and how many are
    still to come."""
    for n, character in enumerate(text):
        if character >= " ":
            return text[:n] + " " * gap + text[n:], 0
        if character == "\n":
            return text, 0
    return text, gap


def shown_character(code: int) -> str:
    """The character a byte of the screen shows, inverse and flashing ones as normal ones."""
    if code < 0x20:
        code += 0x40
    elif 0x40 <= code < 0x60:
        pass
    elif 0x60 <= code < 0x80:
        code -= 0x40
    elif code >= 0x80:
        code &= 0x7F
        if code < 0x20:
            code += 0x40
    return chr(code)
