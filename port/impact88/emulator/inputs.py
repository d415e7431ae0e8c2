"""READ, INPUT and GET: values from DATA, from a reply and from a key, by the same routine.

TXTPTR changes places between the statement's variables and the values. Each variable is found, its
value read and stored, then what follows the value is judged; so values before a bad one stay. A
string ends at a comma or colon unless it began with a quote; a number is whatever reads as one, and
after it only a comma, a colon or the end will do.
"""

from __future__ import annotations

from ..applesoft.console import CONTROL_C
from ..applesoft.errorcodes import ApplesoftError
from .faults import Fault, placed
from .memory import DIRECT, INPUT_BUFFER
from .printing import Printing
from .strings import IS_STRING
from .text import COLON, COMMA, HEADER, QUOTE, SEMICOLON
from .tokens import DATA

FROM_REPLY, FROM_KEY, FROM_DATA = 0, 0x40, 0x98
"""INPFLG."""
BAD_REPLY = 254
BREAK_CODE = 255
AFTER_GET = 0xFF40
"""What a bad GET puts in place of the line number: the machine believes it is at the prompt."""
REENTER, EXTRA_IGNORED = b"?REENTER\r", b"?EXTRA IGNORED\r"


class Inputs(Printing):
    """The three statements."""

    def refuse_direct(self, sp: int) -> None:
        """ERRDIR. Raises ILLEGAL DIRECT at the prompt."""
        if self.curlin >= DIRECT:
            raise Fault("ILLEGAL DIRECT", sp)

    def put_in_buffer(self, text: str) -> None:
        """INLIN's bytes, on page 2."""
        data = text.encode("latin-1") + b"\0"
        self.ram[INPUT_BUFFER : INPUT_BUFFER + len(data)] = data

    def read_(self) -> None:
        """READ. Raises OUT OF DATA, and SYNTAX in the line of the DATA for what is not a number."""
        self._take_items(FROM_DATA, self.datptr, self.sp - 2)

    def restore_(self) -> None:
        """RESTORE: READ begins with the first DATA again."""
        self.datptr = self.txttab - 1

    def _next_data(self, sp: int) -> None:
        """Put TXTPTR where the next DATA's text begins. Raises OUT OF DATA."""
        ram = self.ram
        while True:
            self.data_()
            if not ram[self.txtptr]:
                if not ram[self.txtptr + 2]:
                    raise Fault("OUT OF DATA", sp)
                self.datlin = self.word(self.txtptr + 3)
                self.txtptr += HEADER
            self.txtptr += 1
            if ram[self.txtptr] == DATA:
                return

    def input_(self) -> None:
        """INPUT. Raises ILLEGAL DIRECT, and what a bad reply does."""
        sp = self.sp - 2
        if self.character() == QUOTE:
            prompt = self.literal(self.txtptr + 1)
            self.txtptr = self.strng2
            self.expect(SEMICOLON, sp - 2)
            self.show(self.used(prompt))
        else:
            self.put("?")
        self.refuse_direct(sp - 2)
        try:
            reply = self.console.read_line()
        except KeyboardInterrupt:
            reply = CONTROL_C
        self.ram[INPUT_BUFFER - 1] = COMMA
        self.put_in_buffer(reply)
        if reply.startswith(CONTROL_C):
            raise KeyboardInterrupt
        self._take_items(FROM_REPLY, INPUT_BUFFER - 1, sp)

    def get_(self) -> None:
        """GET. Raises ILLEGAL DIRECT, and SYNTAX, as if at the prompt, for a key that begins no
        number."""
        self.refuse_direct(self.sp - 4)
        self.ram[INPUT_BUFFER + 1] = 0
        self._take_items(FROM_KEY, INPUT_BUFFER + 1, self.sp - 4)

    def _take_items(self, source: int, values: int, sp: int) -> None:
        """PROCESS_INPUT_LIST: TXTPTR stands at the variables, ``values`` before the values."""
        ram = self.ram
        while True:
            self.forpnt = self.variable(sp - 2)
            variables, self.txtptr = self.txtptr, values
            if self.at_end():
                self._more_values(source, sp)
            self.next_character()
            try:
                refused = self._take_item(source, sp)
            except ApplesoftError as error:
                raise placed(error, sp - 4) from None
            if not refused and not self.at_end() and ram[self.txtptr] != COMMA:
                refused = True
            if refused:
                self._refuse_value(source, sp)
                return
            values, self.txtptr = self.txtptr, variables
            if self.at_end():
                break
            self.expect(COMMA, sp - 2)
        if source == FROM_DATA:
            self.datptr = values
        elif ram[values]:
            self.show_message(EXTRA_IGNORED)

    def _more_values(self, source: int, sp: int) -> None:
        """Where the values are used up: the next DATA, a key, or another reply."""
        if source == FROM_DATA:
            self._next_data(sp)
            return
        if source == FROM_KEY:
            self.ram[INPUT_BUFFER] = ord(self.console.read_key()) & 0x7F
        else:
            self.put("??")
            self.put_in_buffer(self.console.read_line())
        self.txtptr = INPUT_BUFFER - 1

    def _take_item(self, source: int, sp: int) -> bool:
        """Read one value and store it; whether it is refused before it is read."""
        if not self.valtyp:
            if source == FROM_REPLY and not self.ram[INPUT_BUFFER]:
                return True
            integer_ = self.inttyp
            value = self.numeral()
            if integer_:
                self.assign_integer(self.forpnt, value, sp - 2)
                self.fac = value
            else:
                self.assign(self.forpnt, value)
            return False
        start = self.txtptr
        if source == FROM_KEY:
            string = self.literal(INPUT_BUFFER, 0)
        elif self.ram[start] == QUOTE:
            string = self.literal(start + 1)
        else:
            string = self.literal(start, COLON, COMMA)
        self.txtptr = self.strng2
        self.assign_string(self.forpnt, string)
        self.valtyp = IS_STRING
        return False

    def _refuse_value(self, source: int, sp: int) -> None:
        """INPUTERR. Raises SYNTAX for DATA and keys; a reply is asked for again, from where the ROM
        noted last that a statement begins, unless ONERR is on."""
        if source == FROM_REPLY:
            if self.errflg & 0x80:
                raise Fault("SYNTAX", sp, BAD_REPLY)
            self.show_message(REENTER)
            self.txtptr = self.oldtext
            return
        self.curlin = self.datlin if source == FROM_DATA else AFTER_GET
        raise Fault("SYNTAX", sp)
