"""The text screen: 40 columns and 24 rows, the cursor, and the text window.

Characters come with their high bit dropped. The screen passes them on to a device in the same form;
columns that the cursor skipped (comma zones, HTAB) can be passed on as blanks when a character
follows on the line. Rows have no newline at column 40.
"""

from __future__ import annotations

from collections.abc import Callable

WIDTH = 40
HEIGHT = 24
BASE = 0x400
NORMAL, INVERSE, FLASHING = 0xFF, 0x3F, 0x7F
_BLANK = 0xA0
_PENDING_LIMIT = 20_000


class Screen:
    """Where characters appear, and where the next one will.

    ``blanks``: whether skipped columns are passed on as blanks; the machine sends none.
    """

    def __init__(self, device: Callable[[str], object], *, blanks: bool = True) -> None:
        self._device = device
        self._blanks = blanks
        self.column = 0
        self._expected = 0
        self.left, self.width, self.top, self.bottom = 0, WIDTH, 0, HEIGHT
        self.mask = NORMAL
        self._row = 0
        self._cells = [bytearray([_BLANK] * WIDTH) for _ in range(HEIGHT)]
        self._pending: list[tuple[int, str]] = []
        self._pending_size = 0

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
        if text.isprintable() and self.left + self.column + len(text) < self.left + self.width:
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
                self.column = self.column - 1 if self.column else self.width - 1

    def typed(self) -> None:
        """A line was typed on a terminal, which has shown it: the cursor is at the left."""
        self._draw_later("\n")
        self.column = self._expected = 0

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
                    self._poke_cell(column, ord(character) | 0x80)
                    column += 1
                    if column >= self.width:
                        column = 0
                        self._line_feed()
                elif character == "\n":
                    column = 0
                    self._line_feed()
                elif character == "\b":
                    column -= 1
                    if column < 0:
                        column = self.width - 1
                        self._row = max(self._row - 1, self.top)

    def _poke_cell(self, column: int, code: int) -> None:
        at = self.left + column
        if at < WIDTH:
            self._cells[self._row][at] = code & self.mask if code >= _BLANK else code

    def _line_feed(self) -> None:
        self._row += 1
        if self._row >= self.bottom:
            self._row = self.bottom - 1
            self._scroll()

    def _scroll(self) -> None:
        span = slice(self.left, min(self.left + self.width, WIDTH))
        for row in range(self.top, self.bottom - 1):
            self._cells[row][span] = self._cells[row + 1][span]
        self._clear_from(self.bottom - 1, 0)

    def _clear_from(self, row: int, column: int) -> None:
        for at in range(self.left + column, min(self.left + self.width, WIDTH)):
            self._cells[row][at] = _BLANK

    @property
    def row(self) -> int:
        """The cursor's row, from 0."""
        self._draw()
        return self._row

    def text(self) -> str:
        """The 24 rows as text, blanks at the end of each cut; inverse and flashing characters as
        normal ones."""
        self._draw()
        return "".join("".join(map(_shown, row)).rstrip(" ") + "\n" for row in self._cells)

    def byte_at(self, address: int) -> int:
        """What screen memory holds: rows in eights, 128 bytes apart."""
        self._draw()
        row, column = _cell(address)
        return self._cells[row][column] if column < WIDTH else 0

    def put_byte(self, address: int, value: int) -> None:
        """POKE into screen memory."""
        self._draw()
        row, column = _cell(address)
        if column < WIDTH:
            self._cells[row][column] = value

    # --- statements ---------------------------------------------------------------------------

    def home(self) -> None:
        """Clear the window; the cursor at its top left."""
        self._draw()
        for row in range(self.top, self.bottom):
            self._clear_from(row, 0)
        self._row = self.top
        self.column = 0

    def clear_to_end_of_line(self) -> None:
        """CALL -868."""
        self._draw()
        self._clear_from(self._row, self.column)

    def clear_to_end(self) -> None:
        """CALL -958."""
        self.clear_to_end_of_line()
        for row in range(self._row + 1, self.bottom):
            self._clear_from(row, 0)

    def scroll(self) -> None:
        """CALL -912."""
        self._draw()
        self._scroll()

    def line_feed(self) -> None:
        """CALL -922."""
        self._draw()
        self._line_feed()

    def step_back(self) -> None:
        """CALL -1008: the cursor one column to the left."""
        self._draw()
        self.column -= 1
        if self.column < 0:
            self.column = self.width - 1
            self.step_up()

    def step_up(self) -> None:
        """CALL -998: the cursor one row up, not past the window's top."""
        self._draw()
        self._row = max(self._row - 1, self.top)

    def move_to_row(self, row: int) -> None:
        """VTAB."""
        self._draw()
        self._row = row

    def stay_at(self, column: int) -> None:
        """After a line feed: the column is what it was, and nothing has been skipped."""
        self.column = self._expected = column

    def move_to_column(self, column: int) -> None:
        """The cursor's column within the window, without showing anything."""
        self.column = column

    def set_mode(self, mask: int) -> None:
        """NORMAL, INVERSE or FLASHING, for characters from now on."""
        self._draw()
        self.mask = mask

    def full_window(self) -> None:
        """TEXT: the whole screen, the cursor in the last row."""
        self._draw()
        self.left, self.width, self.top, self.bottom = 0, WIDTH, 0, HEIGHT
        self._row = HEIGHT - 1

    def set_window(self, edge: str, value: int) -> None:
        """POKE 32 to 35: ``left``, ``width``, ``top`` or ``bottom``."""
        self._draw()
        if edge == "width":
            value = value or 256
        elif edge in ("top", "bottom"):
            value = min(value, HEIGHT)
        setattr(self, edge, value)
        self.bottom = max(self.bottom, self.top + 1)
        self._row = min(self._row, HEIGHT - 1)


def _filled(text: str, gap: int) -> tuple[str, int]:
    """``text`` with blanks before the first character that shows on this line, and how many are
    still to come."""
    for n, character in enumerate(text):
        if character >= " ":
            return text[:n] + " " * gap + text[n:], 0
        if character == "\n":
            return text, 0
    return text, gap


def _cell(address: int) -> tuple[int, int]:
    offset = address - BASE
    third, column = divmod(offset % 128, WIDTH)
    return third * 8 + offset // 128 if third < 3 else 0, column if third < 3 else WIDTH


def _shown(code: int) -> str:
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
