"""Keyboard and screen: the character stream, INPUT and the disk system.

Characters are sent without the high bit and with RETURN as newline. A line that starts with
control-D is a command to the disk system and is not shown; of these ``PR#n`` switches the output to
slot n: a printer's is the screen here, of other slots nothing is seen. A keyboard is a function
that returns the next line typed, None at the end.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Iterator
from typing import Any

CONTROL_C = "\x03"
CONTROL_D = "\x04"
CONTROL_H = "\x08"
CONTROL_U = "\x15"
CONTROL_X = "\x18"
ESCAPE = "\x1b"
BELL = "\a"
RETURN = "\r"
PROMPT = "\0"  # passed by Applesoft to the monitor's line reader; sent, but not visible

# lengths of an input line, as in the ROM
MAX_INPUT = 239  # characters that INPUT keeps
BELL_LENGTH = 248  # from here on each key rings the bell
BUFFER_LENGTH = 256  # a line of this length is abandoned

SHOWN_SLOTS = (0, 1)  # the screen, and the usual slot of a printer, as line 180 of the listing says
_SURROGATES = range(0xDC80, 0xDD00)  # undecodable bytes, as Python's "surrogateescape" has them
_CAPITALS = {n: n & 0x5F for n in range(0x60, 0x80)}
_CURSOR_KEYS = {"I": "D", "J": "B", "K": "A", "M": "C"}
"""Keys after ESC that may be repeated -> the key with the same effect that ends the sequence."""

Keyboard = Callable[[], "str | None"]
Device = Callable[[str], object]
Read = Callable[[str, int], "tuple[Any, int]"]

_SLOT_COMMAND = r"\x04 *[Pp][Rr] *# *([0-7])"
_COMMAND_WORD = r"\x04 *([A-Za-z]+#?)"
_REPLY_ENDS = ("", ":")  # a colon ends a reply as it ends a statement


class Keys(str):
    """Keys without RETURN, which a keyboard may return for GET."""

    __slots__ = ()


class EndOfInput(Exception):
    """The program asks for input, and the keyboard has no more lines."""


class Editor:
    """The screen's part in typing a line; this one is for a console without a screen."""

    def under_cursor(self) -> str:
        """Return the character under the cursor, which control-U enters."""
        return " "

    def escape(self, key: str) -> None:
        """Move the cursor or clear text, as the monitor does for ESC and ``key``."""

    def end_line(self, shown: bool) -> None:
        """Clear the rest of the line at RETURN. ``shown``: a terminal has already moved on."""

    def echo(self, keys: str, put: Device) -> None:
        """Show typed keys, which are never inverse."""
        put(keys)


class Console:
    """A screen and a keyboard, connected to a program.

    ``dos``: True if a disk system handles lines that begin with control-D; ``echo``: True if typed
    lines are part of the output; ``editor``: the screen's part in typing; ``reply``: the last reply
    to INPUT; ``on_ignored_command``: called with the word of each disk command without effect."""

    def __init__(
        self,
        keyboard: Keyboard,
        screen: Device,
        *,
        dos: bool = True,
        echo: bool = True,
    ) -> None:
        self.keyboard = keyboard
        self.screen = screen
        self.dos = dos
        self.echo = echo
        self.slot = 0
        self._line_begins = True
        self._command: str | None = None
        self._keys = ""
        self._code = ord(RETURN)
        self._pressed = False
        self.on_ignored_command: Callable[[str], object] = lambda word: None
        self.editor = Editor()
        self.reply: Reply | None = None

    def put(self, text: str) -> None:
        """Send characters to the disk system, or to the selected slot."""
        if not self.dos:
            self._show(text)
            return
        for piece in text.splitlines(keepends=True):
            if self._command is None and self._line_begins and piece[0] == CONTROL_D:
                self._command = ""
            self._line_begins = piece.endswith("\n")
            if self._command is None:
                self._show(piece)
                continue
            self._command += piece
            if self._line_begins:  # of the disk's commands only PR# affects a program's output
                if match := re.match(_SLOT_COMMAND, self._command):
                    self.select(int(match[1]))
                elif match := re.match(_COMMAND_WORD, self._command):
                    self.on_ignored_command(match[1].upper())
                self._command = None

    def select(self, slot: int) -> None:
        """PR#: send further output to a slot."""
        self.slot = slot & 7

    def _show(self, text: str) -> None:
        if text and self.slot in SHOWN_SLOTS:
            self.screen(text)

    def read_key(self) -> str:
        """Return one key for GET: not echoed, not converted to upper case; RETURN after each line.
        Raises EndOfInput."""
        self._take_keys()
        key, self._keys = self._keys[0], self._keys[1:]
        self._code, self._pressed = ord(key), False
        return key

    def _take_keys(self, needed: bool = True) -> None:
        """Take the keyboard's next line as keys, if none is left of the last one. Raises EndOfInput
        if there is none that is needed."""
        if not self._keys:
            line = self.keyboard()
            if line is not None:
                self._keys = keyboard_codes(line) + RETURN * (not isinstance(line, Keys))
            elif needed:
                raise EndOfInput

    def key_code(self, *, wait: bool = False) -> int:
        """Return the byte at $C000: the code of the last key, its top bit set until it is read or
        cleared.

        The keyboard's next key counts as pressed now. ``wait``: raise EndOfInput if there is
        none."""
        if not self._pressed:
            self._take_keys(needed=wait)
            if self._keys:
                self._code, self._pressed = ord(self._keys[0]), True
        return self._code | 0x80 if self._pressed else self._code

    def clear_key(self) -> None:
        """$C010: clear the key that $C000 shows."""
        if self._pressed:
            self._keys = self._keys[1:]
            self._pressed = False

    def _typed_line(self) -> str:
        """Return the rest of a line that GET began, or the next one. Raises EndOfInput."""
        self._code, self._pressed = ord(RETURN), False
        self._take_keys()
        typed, self._keys = self._keys.removesuffix(RETURN), ""
        return typed

    def read_line(self, prompt: str = PROMPT) -> str:
        """Read a line from the keyboard, cut to the length that INPUT keeps. Raises EndOfInput."""
        self.put(prompt)
        return "".join(self.line_buffer(prompt))[:MAX_INPUT]

    def line_buffer(self, prompt: str, start: int = 0) -> list[str]:
        """GETLN1: read a line, convert it to upper case, edit and echo it, and return the monitor's
        buffer, one character an element; those before ``start`` are "". ``prompt``: shown again
        after an abandoned line. Raises EndOfInput."""
        line = capitals(self._typed_line())
        if line.isprintable() and start + len(line) <= BELL_LENGTH:
            self.editor.echo(line, self._echo)
            buffer = [""] * start + [*line]
        else:
            buffer = self._edit_line(prompt, line, start)
        self.editor.end_line(not self.echo)
        self._echo("\n")
        self._line_begins = True
        return buffer

    def _edit_line(self, prompt: str, typed: str, start: int) -> list[str]:
        """Return the buffer after the keys ``typed``.

        Control-H deletes a character, control-X the line, control-U enters the character under the
        cursor, ESC and a key move the cursor. The bell rings when the line is nearly full; a full
        line is abandoned, as by control-X."""
        keys = deque(typed)
        buffer = [""] * start
        while keys:
            key = keys.popleft()
            if key == ESCAPE:
                self._escape(keys)
                continue
            if key == CONTROL_U:
                key = self.editor.under_cursor()
            self.editor.echo(key, self._echo)
            if key == CONTROL_H:
                if not buffer:
                    self._echo("\n" + prompt)
                del buffer[-1:]
                continue
            if key != CONTROL_X:
                if len(buffer) >= BELL_LENGTH:
                    self._echo(BELL)
                buffer.append(key)
            if key == CONTROL_X or len(buffer) == BUFFER_LENGTH:
                buffer.clear()
                self._echo("\\\n" + prompt)
        return buffer

    def _escape(self, keys: deque[str]) -> None:
        """ESC: the keys I, J, K and M move the cursor and wait for another; any other key ends
        it."""
        key = "I"
        while key in _CURSOR_KEYS:
            if not keys:  # RETURN ends it, and input continues with the next line
                keys.extend(capitals(self._typed_line()))
                return
            key = keys.popleft()
            self.editor.escape(_CURSOR_KEYS.get(key, key))

    def _echo(self, text: str) -> None:
        if self.echo:
            self.put(text)

    def input(self, read: Read) -> Iterator[Reply]:
        """INPUT of numbers: yield a Reply for each attempt, to be called once for each variable.

        Missing values are requested with ``??``; after text that is not a number comes
        ``?REENTER``, and values before it stay stored, as in the ROM. Raises EndOfInput, and
        KeyboardInterrupt for control-C at the start of a reply."""
        while True:
            self.put("?")
            line = self.read_line()
            if line.startswith(CONTROL_C):
                raise KeyboardInterrupt
            self.reply = reply = Reply(self, read, line)
            yield reply
            if not reply.refused:
                break
            self.put("?REENTER\n")
        if reply.left:
            self.put("?EXTRA IGNORED\n")


class Reply:
    """The values of one reply to INPUT, one per call.

    ``begun``: the number of values requested so far, which is the number of variables that the ROM
    has created; ``refused``: True after text that is not a number."""

    def __init__(self, console: Console, read: Read, line: str) -> None:
        self._console = console
        self._read = read
        self._line = line
        self._position = 0
        self.begun = 0
        self.refused = False

    def __call__(self, old: Any) -> Any:
        """Return the next value, or ``old``, the variable's present value, if the reply is refused.

        A text that only begins with a number is refused after that number has been stored; an empty
        line is refused before. Raises ApplesoftError OVERFLOW and EndOfInput."""
        if not self.refused:
            self.begun += 1
            if self.begun > 1 and self.left[:1] not in _REPLY_ENDS:
                self._position += 1  # the comma
            elif self.begun > 1:
                self._console.put("??")
                self._line, self._position = self._console.read_line(), 0
            self.refused = not self._line
        if self.refused:
            return old
        value, self._position = self._read(self._line, self._position)
        while self._line.startswith(" ", self._position):
            self._position += 1
        self.refused = self.left[:1] not in (*_REPLY_ENDS, ",")
        return value

    @property
    def left(self) -> str:
        """The text after the values read so far."""
        return self._line[self._position :]


def keyboard_codes(text: str) -> str:
    """Return a text in the seven-bit codes of the Apple's keyboard.

    An undecodable byte keeps its low seven bits; other characters become ``?``, so that a
    typographic minus is refused where a number is expected."""
    if text.isascii():
        return text
    codes = map(ord, text)
    return "".join(chr(n & 0x7F) if n < 0x80 or n in _SURROGATES else "?" for n in codes)


def capitals(typed: str) -> str:
    """Return a text in capital letters, as the monitor converts it: ``{`` becomes ``[``."""
    return keyboard_codes(typed).translate(_CAPITALS)
