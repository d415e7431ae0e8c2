"""PRINT, LIST and the messages; READ, INPUT and GET.

READ, INPUT and GET take values by the same routine: TXTPTR changes places between the variables and
the values. Each variable is found, its value read and stored, then what follows the value judged:
values before a bad one stay. Only a comma, a colon or the end may follow.
"""

from ..applesoft.console import CONTROL_C, RETURN
from ..applesoft.real import Number, integer
from .expressions import Expressions, byte_of
from .faults import Fault, fault_if, located
from .memory import ADDRESSES, DIGITS, DIRECT, HEADER, INPUT_BUFFER, MINUS, PROMPT
from .programfile import INDENT, WRAP_COLUMN
from .screen import HEIGHT, WIDTH
from .tokens import CLOSE, COLON, COMMA, DATA, FIRST, QUOTE, SEMICOLON, TOKENS, listed
from .variables import IS_STRING, descriptor

TAB, SPC = TOKENS["TAB("], TOKENS["SPC("]
ZONE = 16
"""Columns from one of a comma's zones to the next."""
LAST_ZONE_FROM = 24
"""The column from which on a comma begins a new row."""
LAST_NUMBER = 0xFFFF
"""The last line that LIST looks for."""
NUMBER_AT = 0x100
"""Where FOUT puts the digits of a number."""
FROM_REPLY, FROM_KEY, FROM_DATA, BAD_REPLY, BREAK_CODE, AFTER_GET = 0, 0x40, 0x98, 254, 255, 0xFF40
"""INPFLG; codes of ONERR; what a bad GET puts in place of the line number: the machine believes it
is at the prompt."""
NO_PROMPT = 0x80
"""The prompt while INPUT reads, which shows nothing."""
REENTER, EXTRA_IGNORED = b"?REENTER\r", b"?EXTRA IGNORED\r"
ERROR, IN, BREAK = b" ERROR\a", b" IN ", b"\rBREAK\a"
MESSAGES_AT = {ERROR: 0xD350, IN: 0xD358, BREAK: 0xD35D, REENTER: 0xDCEF, EXTRA_IGNORED: 0xDCDF}
"""Where the ROM's messages stand: a temporary string's descriptor shows it."""


class InputOutput(Expressions):
    """Output and input. ``flash`` is set in every printing character sent."""

    def put(self, text: str) -> None:
        """OUTDO: characters, high bit dropped, RETURN as newline."""
        if self.flash or not text.isascii() or "\r" in text:
            bit = self.flash & 0x7F
            codes = (ord(character) & 0x7F for character in text)
            text = "".join(chr(n | bit if n >= 32 else n) for n in codes).replace("\r", "\n")
        self.console.put(text)

    def show(self, text: bytes) -> None:
        """STRPRT: a string's characters. A line feed moves down and leaves the column as it is."""
        first, *others = text.decode("latin-1").split("\n")
        self.put(first)
        for other in others:
            column = self.screen.column
            self.put("\n")
            self.screen.stay_at(column)
            self.put(other)

    def show_message(self, text: bytes, address: int = 0) -> None:
        """STROUT: a text that is no variable's, as a temporary string: a message of the ROM, or
        what stands at an address."""
        address = address or MESSAGES_AT[text]
        self.used(descriptor(self.temporary(len(text), address, address >> 8)))
        self.fac = len(text), self.fac[1], 0
        self.show(text)

    def show_number(self, x: Number) -> None:
        """FOUT and STROUT. Raises FORMULA TOO COMPLEX."""
        self.charac = 0
        self.show_message(self.digits(x), NUMBER_AT)

    def print_(self) -> None:
        sp, newline = self.sp - 2, True
        while (byte := self.character()) and byte != COLON:
            if newline := byte not in (TAB, SPC, COMMA, SEMICOLON):
                fac = self.formula(sp - 2)
                if self.valtyp:
                    self.show(self.used(descriptor(fac)))
                else:
                    self.show_number(fac)
                continue
            self.txtptr += 1
            if byte == COMMA and self.screen.column >= LAST_ZONE_FROM:
                self.put("\n")
            elif byte == COMMA:
                self.screen.column = self.screen.column + ZONE & 0xF0
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
        sp, ram = self.sp - 2, self.ram
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
        for _ in range(ADDRESSES):  # addresses poked may lead in a circle
            if not ram[line + 1]:
                break
            self.pause()
            self.put("\n")
            number = self.word(line + 2)
            if number > (last or LAST_NUMBER):
                break
            self._keep_place(HEADER - 1)
            self.show_number(integer(number))
            self.put(" ")
            for place, byte in enumerate(ram[line + HEADER : ram.index(0, line + HEADER)], HEADER):
                if byte >= FIRST:
                    self._keep_place(place)
                self.put(listed(byte) if self.screen.shows else self._masked(listed(byte)))
                if self.screen.column >= WRAP_COLUMN:
                    self.put("\n")
                    self.screen.column = INDENT
            line = self.word(line)
        self.put("\n")

    def _keep_place(self, place: int) -> None:
        """LIST keeps its place in a line in the low byte of FORPNT."""
        self.forpnt = self.forpnt & 0xFF00 | place & 0xFF

    def _masked(self, piece: str) -> str:
        """What LIST sends of a piece under an unusual mask: a letter of which the mask leaves
        nothing ends a keyword."""
        for place, letter in enumerate(piece[1:-1], 1):
            if not (ord(letter) | self.flash) & self.screen.mask & 0x7F:
                return piece[: place + 1] + "\0 "
        return piece

    def refuse_direct(self, sp: int) -> None:
        """ERRDIR. Raises ILLEGAL DIRECT at the prompt."""
        fault_if(self.curlin >= DIRECT, "ILLEGAL DIRECT", sp)

    def _put_in_buffer(self, text: str) -> None:
        data = text.encode("latin-1") + b"\0"
        self.ram[INPUT_BUFFER : INPUT_BUFFER + len(data)] = data

    def get_line(self, start: int = 0, before: str | None = None) -> None:
        """GETLN: a line into page 2, high bits set, from a place of it on; ``before``: what stands
        before the prompt, if there is to be one."""
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
            self.show(self.used(descriptor(prompt)))
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
        """PROCESS_INPUT_LIST: TXTPTR stands at the variables, ``values`` before the values."""
        ram = self.ram
        while True:
            self.forpnt = self.variable(sp - 2)
            variables, self.txtptr = self.txtptr, values
            if self.at_end():
                self._more_values(source, sp)
            self.txtptr += 1
            self.character()
            refused = located(sp - 4, self._take_item, source, sp)
            if refused or not (self.at_end() or ram[self.txtptr] == COMMA):
                if source != FROM_REPLY:
                    self.curlin = self.datlin if source == FROM_DATA else AFTER_GET
                    raise Fault("SYNTAX", sp)
                fault_if(self.errflg & 0x80, "SYNTAX", sp, BAD_REPLY)
                # asked again, from where the ROM noted last that a statement begins
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
        """Where the values are used up: the next DATA's text, a key, or another reply. Raises OUT
        OF DATA."""
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
        """Read one value and store it; whether it is refused before it is read."""
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
