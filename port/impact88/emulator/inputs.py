"""READ, INPUT and GET: values from DATA, from a reply and from a key, by the same rules.

Each variable is found, its value read and stored, then what follows the value is judged; so values
before a bad one stay stored. A string ends at a comma or colon unless it began with a quote; a
number is whatever reads as one, and after it only a comma, a colon or the end will do.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..applesoft import decimaltext
from ..applesoft.console import CONTROL_C, Console
from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import rounded
from .programtext import START, ProgramText
from .strings import StringArea
from .symbols import INTEGER, STRING
from .tokens import DATA
from .variables import whole

Place = tuple[list[Any], int]
Items = tuple[tuple[str, Callable[[], Place]], ...]
"""Kind and place of each variable; a place is looked up when its turn comes."""

_ENDS = ("", ":", "\0")
_DATA = chr(DATA)
BAD_REPLY = 254
DIRECT_AFTER_GET = 0xFF40
"""What a bad GET puts in place of the line number: the machine believes it is at the prompt."""


class InputBreak(KeyboardInterrupt):
    """Control-C as a reply: CONT will not find the beginning of a statement."""


class BadReply(ApplesoftError):
    """A reply that is no number, while ONERR is on: no message, only a code."""

    def __init__(self) -> None:
        super().__init__("SYNTAX")

    @property
    def code(self) -> int:
        """What ``PEEK (222)`` shows."""
        return BAD_REPLY


def _blanks(text: str, position: int) -> int:
    while text[position : position + 1] == " ":
        position += 1
    return position


def _string(text: str, position: int) -> tuple[int, int, int]:
    """Where the string at ``position`` begins and ends, and where what follows it does."""
    if text[position : position + 1] == '"':
        start = end = position + 1
        while text[end : end + 1] not in ('"', "", "\0"):
            end += 1
        return start, end, end + 1 if text[end : end + 1] == '"' else end
    end = position
    while text[end : end + 1] not in (*_ENDS, ","):
        end += 1
    return position, end, end


class Inputs:
    """DATA's pointer and the three statements.

    ``put`` shows a message; ``onerr`` tells whether ONERR is on.
    """

    def __init__(
        self,
        program: ProgramText,
        console: Console,
        put: Callable[[str], object],
        strings: StringArea,
        onerr: Callable[[], bool],
    ) -> None:
        self._program = program
        self._console = console
        self._put = put
        self._strings = strings
        self._onerr = onerr
        self._image: bytes | None = None
        self._text = ""
        self.pointer = START - 1
        self.data_line = 0

    def restore(self) -> None:
        """RESTORE: READ begins with the first DATA again."""
        self.pointer = START - 1

    def _take(
        self, kind: str, place: Place, text: str, position: int, *, literal: bool = False
    ) -> int:
        """Read a value of a kind and store it; return where it ends, blanks passed."""
        values, index = place
        if kind == STRING:
            start, end, position = _string(text, position)
            strings = self._strings
            if literal:
                string = strings.temporary(end - start, START - 1 + start)
            else:
                string = strings.made(text[start:end])
            values[index] = strings.kept(string)
        else:
            number, position = decimaltext.read(text, position)
            values[index] = whole(number) if kind == INTEGER else rounded(number)
        return _blanks(text, position)

    # --- READ ---------------------------------------------------------------------------------

    def read(self, items: Items) -> None:
        """READ. Raises OUT OF DATA, and SYNTAX in the line of the DATA for what is no number."""
        if self._image is not self._program.image:
            self._image = self._program.image
            self._text = "\0" + self._image.decode("latin-1")
        text = self._text
        position = self.pointer - (START - 1)
        for kind, where in items:
            place = where()
            position = _blanks(text, position)
            if text[position] in _ENDS:
                position = self._next_data(position)
            position = self._take(kind, place, text, _blanks(text, position + 1), literal=True)
            if text[position] not in (*_ENDS, ","):
                raise ApplesoftError("SYNTAX", self.data_line)
        self.pointer = position + START - 1

    def _next_data(self, position: int) -> int:
        """Where the next DATA stands."""
        text = self._text
        while True:
            quoted = False
            while text[position] != "\0" and (quoted or text[position] != ":"):
                quoted ^= text[position] == '"'
                position += 1
            if text[position] == "\0":
                if text[position + 2 : position + 3] in ("", "\0"):
                    raise ApplesoftError("OUT OF DATA")
                self.data_line = ord(text[position + 3]) + 256 * ord(text[position + 4])
                position += 4
            position += 1
            if text[position] == _DATA:
                return position

    # --- INPUT --------------------------------------------------------------------------------

    def input_(self, pc: int, items: Items) -> bool:
        """INPUT after its prompt; True if the statement has to be done again."""
        console = self._console
        try:
            text = console.read_line()
        except KeyboardInterrupt:
            raise InputBreak from None
        if text.startswith(CONTROL_C):
            raise InputBreak
        position = -1
        for kind, where in items:
            place = where()
            if position >= 0 and text[position : position + 1] in _ENDS:
                self._put("??")
                text = console.read_line()
                position = -1
            refused = kind != STRING and not text
            if not refused:
                position = self._take(kind, place, text, _blanks(text, position + 1))
                refused = text[position : position + 1] not in (*_ENDS, ",")
            if refused:
                if self._onerr():
                    raise BadReply
                self._put("?REENTER\n")
                return True
        if position < len(text):
            self._put("?EXTRA IGNORED\n")
        return False

    # --- GET ----------------------------------------------------------------------------------

    def get(self, items: Items) -> None:
        """GET. Raises SYNTAX, as if at the prompt, for a key that begins no number."""
        position = 0
        key = ""
        for kind, where in items:
            values, index = where()
            key = self._console.read_key().rstrip("\0")
            if kind == STRING:
                values[index] = self._strings.kept(self._strings.made(key))
                position = len(key)
                continue
            position = self._take(kind, (values, index), key, _blanks(key, 0))
            if key[position : position + 1] not in (*_ENDS, ","):
                raise ApplesoftError("SYNTAX", DIRECT_AFTER_GET)
        if position < len(key):
            self._put("?EXTRA IGNORED\n")
