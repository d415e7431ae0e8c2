"""PRINT, LIST and the messages; READ, INPUT and GET.

READ, INPUT and GET share a routine, in which TXTPTR alternates between variables and values. Each
variable is found, its value read and stored, and only then the character after the value checked: a
comma, a colon or the end. So values before a bad one stay.
"""

from ..applesoft.console import CONTROL_C, RETURN
from ..applesoft.real import Number, integer
from .expressions import Expressions, byte_of
from .faults import Fault, call_at, fault_if
from .memory import DIGITS, DIRECT, HEADER, INPUT_BUFFER, MINUS, PROMPT
from .programfile import INDENT, WRAP_COLUMN
from .screen import HEIGHT, WIDTH
from .tokens import CLOSE, COLON, COMMA, DATA, FIRST, QUOTE, SEMICOLON, TOKENS, list_text
from .variables import IS_STRING, descriptor

TAB = TOKENS["TAB("]
SPC = TOKENS["SPC("]
ZONE_WIDTH = 16  # columns of a comma's zone
LAST_ZONE_COLUMN = 24  # from this column on a comma begins a new row
LAST_NUMBER = 0xFFFF  # the last line number that LIST searches for
DIGITS_ADDRESS = 0x100  # where FOUT puts the digits of a number
# INPFLG
FROM_REPLY = 0
FROM_KEY = 0x40
FROM_DATA = 0x98
# codes of ONERR
BAD_REPLY = 254
BREAK_CODE = 255
AFTER_GET = 0xFF40  # CURLIN after a bad GET: the machine seems to be at the prompt
NO_PROMPT = 0x80  # the invisible prompt of INPUT
REENTER = b"?REENTER\r"
EXTRA_IGNORED = b"?EXTRA IGNORED\r"
ERROR = b" ERROR\a"
IN = b" IN "
BREAK = b"\rBREAK\a"
MESSAGES_AT = {ERROR: 0xD350, IN: 0xD358, BREAK: 0xD35D, REENTER: 0xDCEF, EXTRA_IGNORED: 0xDCDF}
"""Addresses of the ROM's messages, which appear in a temporary string's descriptor."""


class InputOutput(Expressions):
    """Output and input. The bits of ``flash`` are set in every printing character sent."""

    def put(self, text: str) -> None:
        """OUTDO: send characters, without the high bit and with RETURN as newline."""
        if self.flash or not text.isascii() or "\r" in text:
            bit = self.flash & 0x7F
            codes = (ord(character) & 0x7F for character in text)
            text = "".join(chr(n | bit if n >= 32 else n) for n in codes).replace("\r", "\n")
        self.console.put(text)

    def show(self, text: bytes) -> None:
        """STRPRT: send a string's characters. A line feed moves down and keeps the column."""
        first, *further = text.decode("latin-1").split("\n")
        self.put(first)
        for text_part in further:
            column = self.screen.column
            self.put("\n")
            self.screen.stay_at(column)
            self.put(text_part)

    def show_message(self, text: bytes, address: int = 0) -> None:
        """STROUT: send a text by way of a temporary string: a message of the ROM, or the text at an
        address."""
        address = address or MESSAGES_AT[text]
        self.release_text(descriptor(self.temporary(len(text), address, address >> 8)))
        self.fac = len(text), self.fac[1], 0
        self.show(text)

    def show_number(self, x: Number) -> None:
        """FOUT and STROUT: send a number. Raises FORMULA TOO COMPLEX."""
        self.charac = 0
        self.show_message(self.digits(x), DIGITS_ADDRESS)

    def print_(self) -> None:
        sp, newline = self.sp - 2, True
        while (byte := self.character()) and byte != COLON:
            if newline := byte not in (TAB, SPC, COMMA, SEMICOLON):
                fac = self.formula(sp - 2)
                if self.valtyp:
                    self.show(self.release_text(descriptor(fac)))
                else:
                    self.show_number(fac)
                continue
            self.txtptr += 1
            if byte == COMMA and self.screen.column >= LAST_ZONE_COLUMN:
                self.put("\n")
            elif byte == COMMA:
                self.screen.column = self.screen.column + ZONE_WIDTH & 0xF0
            elif byte != SEMICOLON:  # TAB counts from 1, 0 is 256
                columns = self.byte(sp - 3)
                fault_if(self.character() != CLOSE, "SYNTAX", sp - 1)
                self.txtptr += 1
                self.put(
                    " " * (columns if byte == SPC else (columns - 1 & 0xFF) - self.screen.column)
                )
        if newline:
            self.console.put("\n")

    def byte(self, sp: int) -> int:
        return byte_of(self.number(sp - 2), sp)

    def htab_(self) -> None:
        column = self.byte(self.sp - 4) - 1 & 0xFF
        while column >= WIDTH:
            self.put("\n")
            column -= WIDTH
        self.screen.column = column

    def vtab_(self) -> None:
        row = self.byte(self.sp - 4)
        fault_if(not 1 <= row <= HEIGHT, "ILLEGAL QUANTITY", self.sp - 2)
        self.screen.move_to_row(row - 1)

    def set_mode(self, mask: int, flash: int = 0) -> None:
        self.flash = flash
        self.screen.mask = mask

    def list_(self) -> None:
        sp = self.sp - 2
        if self.character() not in (*DIGITS, 0, COLON, MINUS, COMMA):
            return
        last = self.line_number(sp - 2)
        _, line = self.find_line(last, self.txttab)
        if not self.at_end():
            if self.character() not in (MINUS, COMMA):
                return
            self.txtptr += 1
            last = self.line_number(sp - 2)
            if not self.at_end():
                return
        for number, tokens in self.lines(line):
            self.pause()
            self.put("\n")
            if number > (last or LAST_NUMBER):
                break
            self._keep_place(HEADER - 1)
            self.show_number(integer(number))
            self.put(" ")
            for place, byte in enumerate(tokens, HEADER):
                if byte >= FIRST:
                    self._keep_place(place)
                if byte == BREAK_CODE:
                    self.ignore("LIST of the byte 255 prints text of the ROM there, nothing here")
                self.put(self._apply_mask(list_text(byte)))
                if self.screen.column >= WRAP_COLUMN:
                    self.put("\n")
                    self.screen.column = INDENT
        self.put("\n")

    def _keep_place(self, place: int) -> None:
        """Store LIST's place in a line in the low byte of FORPNT, as the ROM does."""
        self.forpnt = self.forpnt & 0xFF00 | place & 0xFF

    def _apply_mask(self, piece: str) -> str:
        """Return what LIST sends of a keyword under an unusual mask: a letter that the mask clears
        ends it."""
        for place, letter in enumerate(piece[1:-1], 1):
            if not (ord(letter) | self.flash) & self.screen.mask & 0x7F:
                return piece[: place + 1] + "\0 "
        return piece

    def refuse_direct(self, sp: int) -> None:
        """ERRDIR: raise ILLEGAL DIRECT at the prompt."""
        fault_if(self.curlin >= DIRECT, "ILLEGAL DIRECT", sp)

    def _put_in_buffer(self, text: str) -> None:
        data = text.encode("latin-1") + b"\0"
        self.ram[INPUT_BUFFER : INPUT_BUFFER + len(data)] = data

    def get_line(self, start: int = 0, before: str | None = None) -> None:
        """GETLN: read a line into page 2, high bits set, from index ``start`` on; ``before``: text
        before the prompt, None for no prompt."""
        prompt = chr(self.ram[PROMPT] & 0x7F)
        if before is not None:
            self.put(before + prompt)
        for place, key in enumerate([*self.console.line_buffer(prompt, start), RETURN]):
            if key:
                self.ram[INPUT_BUFFER + place] = ord(key) | 0x80

    def restore_(self) -> None:
        self.datptr = self.txttab - 1

    def input_(self) -> None:
        sp = self.sp - 2
        if self.character() == QUOTE:
            prompt = self.literal(self.txtptr + 1)
            self.expect(SEMICOLON, sp - 2)
            self.show(self.release_text(descriptor(prompt)))
        else:
            self.put("?")
        self.refuse_direct(sp - 2)
        self.ram[PROMPT] = NO_PROMPT
        try:
            reply = self.console.read_line()
        except KeyboardInterrupt:
            reply = CONTROL_C
        self.ram[INPUT_BUFFER - 1] = COMMA
        self._put_in_buffer(reply)
        if reply.startswith(CONTROL_C):
            raise KeyboardInterrupt
        self.take_items(FROM_REPLY, INPUT_BUFFER - 1, sp)

    def get_(self) -> None:
        self.refuse_direct(self.sp - 4)
        self.ram[INPUT_BUFFER + 1] = 0
        self.take_items(FROM_KEY, INPUT_BUFFER + 1, self.sp - 4)

    def take_items(self, source: int, values: int, sp: int) -> None:
        """PROCESS_INPUT_LIST: assign values. TXTPTR is at the variables; ``values``: address before
        the values; ``source``: INPFLG."""
        ram = self.ram
        while True:
            self.forpnt = self.variable(sp - 2)
            variables, self.txtptr = self.txtptr, values
            if self.at_end():
                self._more_values(source, sp)
            self.txtptr += 1
            self.character()
            is_refused = call_at(sp - 4, self._take_item, source, sp)
            if is_refused or not (self.at_end() or ram[self.txtptr] == COMMA):
                if source != FROM_REPLY:
                    self.curlin = self.datlin if source == FROM_DATA else AFTER_GET
                    raise Fault("SYNTAX", sp)
                fault_if(self.errflg & 0x80, "SYNTAX", sp, BAD_REPLY)
                # ask again, from the last statement whose start the ROM stored
                self.show_message(REENTER)
                self.txtptr = self.oldtext
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
        """Move TXTPTR to further values: the next DATA, a key, or another reply. Raises OUT OF
        DATA."""
        ram = self.ram
        while source == FROM_DATA:
            self.data_()
            if not ram[self.txtptr]:
                fault_if(not ram[self.txtptr + 2], "OUT OF DATA", sp)
                self.datlin = self.word(self.txtptr + 3)
                self.txtptr += HEADER
            self.txtptr += 1
            if ram[self.txtptr] == DATA:
                return
        if source == FROM_KEY:
            ram[INPUT_BUFFER] = ord(self.console.read_key()) & 0x7F
        else:
            self.put("??")
            self._put_in_buffer(self.console.read_line())
        self.txtptr = INPUT_BUFFER - 1

    def _take_item(self, source: int, sp: int) -> bool:
        """Read one value and store it. Return True if it is refused before it is read."""
        if not self.valtyp:
            if source == FROM_REPLY and not self.ram[INPUT_BUFFER]:
                return True
            value = self.numeral()
            if self.inttyp:
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
        self.assign_string(self.forpnt, string)
        self.valtyp = IS_STRING
        return False
