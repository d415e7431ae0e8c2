"""Keyboard and screen: the character stream, INPUT's manners, the disk system and the printer.

Characters go out with the high bit dropped and RETURN as newline. A line that starts with control-D
is a command to the disk system, not shown; ``PR#n`` among them switches the output to slot n, 0
being the screen. A keyboard is a function that returns the next line typed (None at the end).
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Iterator

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

CONTROL_C, CONTROL_D, CONTROL_H, CONTROL_U, CONTROL_X = "\x03\x04\x08\x15\x18"
ESCAPE, BELL, RETURN = "\x1b\a\r"
PROMPT = "\0"
"""The prompt character Applesoft gives the monitor's line reader: it is sent, and shows nothing."""
LINE_LIMIT, WARNING, BUFFER = 239, 248, 256
"""What INPUT keeps of a line; where the bell begins; where a line is abandoned: the ROM's."""
PRINTER_SLOT = 1
"""Where a printer's card is by custom; the listing's line 180 says so."""
_ESCAPED = range(0xDC80, 0xDD00)
"""What Python makes of the bytes from 80 on that it cannot decode."""
_MOVES = {"I": "D", "J": "B", "K": "A", "M": "C"}
"""Keys after ESC that may be repeated, and what they do once."""

Keyboard = Callable[[], "str | None"]
Device = Callable[[str], object]
Read = Callable[[str, int], "tuple[Any, int]"]

_SLOT_COMMAND = r" *[Pp][Rr] *# *([0-7])"
_COMMAND_WORD = r" *([A-Za-z]+#?)"
_END = ("", ":")
"""Of a reply: a colon ends it as it ends a statement."""


class Keys(str):
    """Keys with no RETURN after them: what a keyboard may return for GET to read."""

    __slots__ = ()


class EndOfInput(Exception):
    """The keyboard has no more lines and the program asks for one."""


class Editor:
    """What typing a line asks of a screen; this one is of a console that has none."""

    def under_cursor(self) -> str:
        """The character that control-U takes."""
        return " "

    def escape(self, key: str) -> None:
        """ESC and this key: the monitor's movements of the cursor."""

    def end_line(self, shown: bool) -> None:
        """RETURN: what stands behind the cursor is cleared. ``shown``: a terminal has shown it."""

    def echo(self, keys: str, put: Device) -> None:
        """Show keys, which are never inverse."""
        put(keys)


class Console:
    """A screen, a keyboard, and what stands between them and a program. ``dos``: whether a disk
    system takes its commands; ``echo``: whether typed lines go into the output; ``editor``: the
    screen's side of typing; ``reply``: the last one that INPUT got; ``ready``: whether the keyboard
    has a line now, for a program that looks at it without waiting; ``passed_over``: is told the
    word of each disk command that is not done."""

    def __init__(
        self,
        keyboard: Keyboard,
        screen: Device,
        printer: Device | None = None,
        *,
        dos: bool = True,
        echo: bool = True,
    ) -> None:
        self.keyboard = keyboard
        self.screen = screen
        self.printer = printer or screen
        self.dos = dos
        self.echo = echo
        self.slot = 0
        self._line_begins = True
        self._command: str | None = None
        self._keys = ""
        self._code = ord(RETURN)
        self._pressed = False
        self.ready: Callable[[], bool] = lambda: True
        self.passed_over: Callable[[str], object] = lambda word: None
        self.editor = Editor()
        self.reply: Reply | None = None

    def put(self, text: str) -> None:
        """Send characters on their way: to the disk system, or to the selected slot's device."""
        if not self.dos:
            self._show(text)
            return
        for piece in text.splitlines(keepends=True):
            if self._command is None and self._line_begins and piece[0] == CONTROL_D:
                self._command, piece = "", piece[1:]
            self._line_begins = piece.endswith("\n")
            if self._command is None:
                self._show(piece)
                continue
            self._command += piece
            if self._line_begins:  # of a disk's commands only PR# concerns a program's output
                if match := re.match(_SLOT_COMMAND, self._command):
                    self.select(int(match[1]))
                elif match := re.match(_COMMAND_WORD, self._command):
                    self.passed_over(match[1].upper())
                self._command = None

    def select(self, slot: int) -> None:
        """PR#: output goes to a slot from now on."""
        self.slot = slot & 7

    def _show(self, text: str) -> None:
        device = {0: self.screen, PRINTER_SLOT: self.printer}.get(self.slot)
        if device and text:
            device(text)

    def read_key(self) -> str:
        """One key, as GET reads it: not shown, not made upper case; RETURN after a line's last.
        Raises EndOfInput."""
        if not (self._keys or self._take_keys()):
            raise EndOfInput
        key, self._keys = self._keys[0], self._keys[1:]
        self._code, self._pressed = ord(key), False
        return key

    def _take_keys(self) -> bool:
        """Take the keyboard's next line as keys; False if there is none."""
        typed = self.keyboard()
        if typed is not None:
            self._keys = keyed(typed) if isinstance(typed, Keys) else keyed(typed) + RETURN
        return typed is not None

    def key_code(self, *, wait: bool = False) -> int:
        """The byte at $C000: the code of the key pressed last, with its top bit until that key is
        read or cleared. One that waits is pressed now. ``wait``: for one that does not yet. Raises
        EndOfInput, if it is to wait."""
        if not self._pressed:
            waiting = self._keys or ((wait or self.ready()) and self._take_keys())
            if wait and not waiting:
                raise EndOfInput
            if waiting:
                self._code, self._pressed = ord(self._keys[0]), True
        return self._code | 0x80 if self._pressed else self._code

    def clear_key(self) -> None:
        """$C010: the key that $C000 shows is done with."""
        if self._pressed:
            self._keys = self._keys[1:]
            self._pressed = False

    def _typed_line(self) -> str:
        """What is left of a line that GET began, or the next one."""
        self._code, self._pressed = ord(RETURN), False
        if self._keys:
            typed, self._keys = self._keys.rstrip(RETURN), ""
            return typed
        line = self.keyboard()
        if line is None:
            raise EndOfInput
        return line

    def read_line(self, prompt: str = PROMPT) -> str:
        """One line from the keyboard as Applesoft takes it from the monitor. Raises EndOfInput."""
        self.put(prompt)
        return "".join(self.line_buffer(prompt))[:LINE_LIMIT]

    def line_buffer(self, prompt: str, start: int = 0) -> list[str]:
        """GETLN1: a line from the keyboard, upper case, edited, echoed, as the characters of the
        monitor's buffer; those before ``start`` are passed over, and empty here. ``prompt``: what
        an abandoned line begins anew with. Raises EndOfInput."""
        typed = capitals(self._typed_line())
        if typed.isprintable() and start + len(typed) <= WARNING:
            self.editor.echo(typed, self._echo)
            kept = [""] * start + [*typed]
        else:
            kept = self._edited(prompt, typed, start)
        self.editor.end_line(not self.echo)
        self._echo("\n")
        self._line_begins = True
        return kept

    def _edited(self, prompt: str, typed: str, start: int) -> list[str]:
        """The line that the keys make. Control-H takes back a character, control-X the line,
        control-U takes the character under the cursor, ESC and a key move the cursor. The bell
        rings when the line is nearly full; a full one is abandoned, as if by control-X."""
        keys = deque(typed)
        kept = [""] * start
        while keys:
            key = keys.popleft()
            if key == ESCAPE:
                self._escape(keys)
                continue
            if key == CONTROL_U:
                key = self.editor.under_cursor()
            self.editor.echo(key, self._echo)
            if key == CONTROL_H:
                if not kept:
                    self._echo("\n" + prompt)
                del kept[-1:]
                continue
            if key != CONTROL_X:
                if len(kept) >= WARNING:
                    self._echo(BELL)
                kept.append(key)
            if key == CONTROL_X or len(kept) == BUFFER:
                kept.clear()
                self._echo("\\\n" + prompt)
        return kept

    def _escape(self, keys: deque[str]) -> None:
        """ESC: the keys I, J, K and M move the cursor and wait for more, any other is the last."""
        key = "I"
        while key in _MOVES:
            if not keys:  # RETURN ends it, and the line goes on with the next one
                keys.extend(capitals(self._typed_line()))
                return
            key = keys.popleft()
            self.editor.escape(_MOVES.get(key, key))

    def _echo(self, text: str) -> None:
        if self.echo:
            self.put(text)

    def input(self, read: Read, zero: Any) -> Iterator[Reply]:
        """INPUT of numbers: one Reply per attempt, to be called once for each variable.

        Too few values are asked for with ``??``, what is not a number with ``?REENTER``; values
        stored before a bad one stay stored, as in the ROM. Raises EndOfInput, and KeyboardInterrupt
        for control-C at the start of a reply.
        """
        while True:
            self.put("?")
            line = self.read_line()
            if line.startswith(CONTROL_C):
                raise KeyboardInterrupt
            reply = Reply(self, read, zero, line)
            self.reply = reply
            yield reply
            if not reply.refused:
                break
            self.put("?REENTER\n")
        if reply.left:
            self.put("?EXTRA IGNORED\n")


class Reply:
    """The values of one reply to INPUT, one a call. ``begun`` counts the values looked for: the ROM
    has made so many variables."""

    def __init__(self, console: Console, read: Read, zero: Any, line: str) -> None:
        self._console = console
        self._read = read
        self._zero = zero
        self._line = line
        self._position = 0
        self.begun = 0
        self.refused = False

    def __call__(self, old: Any) -> Any:
        """The next value; ``old``, the variable's value so far, once this reply has been refused.
        A text that only begins as a number is refused after its beginning has been stored, an empty
        line before. Raises ApplesoftError OVERFLOW and EndOfInput."""
        if not self.refused:
            self.begun += 1
            if self.begun > 1 and self.left[:1] not in _END:
                self._position += 1  # the comma
            elif self.begun > 1:
                self._console.put("??")
                self._line, self._position = self._console.read_line(), 0
            self.refused = not self._line
        if self.refused:
            return self._zero if old is None else old
        value, self._position = self._read(self._line, self._position)
        while self._line.startswith(" ", self._position):
            self._position += 1
        self.refused = self.left[:1] not in (*_END, ",")
        return value

    @property
    def left(self) -> str:
        """What was typed beyond the values read."""
        return self._line[self._position :]


def keyed(text: str) -> str:
    """A text in the codes of the Apple's keyboard, which has seven bits. A byte that is not text
    counts for its seven bits; for other characters ``?`` stands, so that a typographic minus is
    refused where a number is expected."""
    codes = map(ord, text)
    return "".join(chr(n & 0x7F) if n < 0x80 or n in _ESCAPED else "?" for n in codes)


def capitals(typed: str) -> str:
    """What the monitor makes of the codes above capital letters: those, and ``{`` becomes ``[``."""
    return "".join(chr(n & 0x5F) if n >= 0x60 else chr(n) for n in map(ord, keyed(typed)))
