"""The machine's memory: 64K of bytes, page 0 by name, PEEK and POKE, and the program's text.

All that a program can look at lies in ``ram`` where the ROM puts it. The pointers of page 0 are
attributes, by the names of the ROM's listing in small letters (`POINTERS`); there is no ROM to
read. What has been read at an address of the program (a name, a constant, a line number) is
remembered until a byte of the program changes; page 2 is read anew each time.
"""

import re
from collections.abc import Callable

from ..applesoft import decimaltext
from ..applesoft.console import Console, Device, Keyboard
from ..applesoft.real import Number, from_stored, to_stored
from .faults import Fault, TooManyStatements
from .screen import BASE, END, Screen
from .tokens import BLANK, COLON, OPEN, QUOTE, TOKENS

TEXT_START, ROM, STACK, DIRECT = 0x801, 0xC000, 0xF8, 0xFF00
"""The machine's TXTTAB and, without a disk system, HIMEM; the stack pointer when nothing is on the
stack; CURLIN from here on: typed without a line number."""
INPUT_BUFFER, BUFFER_END = 0x200, 0x300
"""Page 2, where typed lines are read in and their tokens put in their place."""
TEMPORARIES, TEMPORARIES_END, EMPTY = 0x55, 0x5E, 0xE09A
"""TEMPST: the descriptors of three temporary strings; a zero in ROM, where a variable is found
that was never made."""
APPLE_II_PLUS = {0xFBB3: 0xEA}
"""The byte of the monitor by which programs identify the model."""
PAGE_ZERO = bytes.fromhex("4C3CD4 4C3ADB 000000 00 4C99E1")
"""The jumps with which switching on begins page 0: to the prompt, to print a text, and USR's."""
FIRST_SEED = from_stored("804FC75200")
"""RND's seed after switching on: of the ROM's five bytes, which end in 58, four are copied."""
AFTER_TYPING = (0xD0, 0xD0 << 32, 0)
"""What the ROM's parser leaves in the accumulator: an address."""
SEED, SCREEN, ADDRESSES = range(201, 206), range(BASE, END), 0x10000
REFUSALS, MORE_REFUSED = 8, "more of the kind"
"""How many different requests for what is not done here are remembered; a program makes few."""
_BEYOND = 0x200
"""Zeros behind the last address, so that text that runs on to the end of memory ends there."""

_PAGE_ZERO = """14 subflg 52 temppt 53 lastpt 67 txttab+ 69 vartab+ 6B arytab+ 6D strend+ 6F fretop+
73 memsiz+ 75 curlin+ 77 oldlin+ 79 oldtext+ 7B datlin+ 7D datptr+ 83 varpnt+ 85 forpnt+ AF prgend+
B8 txtptr+ D6 lock D8 errflg DA errlin+ DC errpos+ DE errnum DF errstk F2 trcflg F3 flash
F4 txtpsv+ F6 cursv+ F8 remstk"""
POINTERS: dict[int, tuple[str, int, int]] = {}
"""By address of page 0: an attribute, its shift, and the bits of it that stand elsewhere."""
for _address, _name, _word in re.findall(r"(\w+) (\w+)(\+?)", _PAGE_ZERO):
    POINTERS[int(_address, 16)] = _name, 0, 0xFF00 if _word else 0
    if _word:
        POINTERS[int(_address, 16) + 1] = _name, 8, 0x00FF
OF_SCREEN = {
    32: ("left", 0, 0),
    33: ("width", 0, 0),
    34: ("top", 0, 0),
    35: ("bottom", 0, 0),
    36: ("column", 0, 0),
    37: ("row", 0, 0),
    40: ("address", 0, 0xFF00),
    41: ("address", 8, 0x00FF),
    50: ("mask", 0, 0),
}
"""The same for what `Screen` keeps."""
KEYBOARD = range(0xC000, 0xC010)
STROBE = range(0xC010, 0xC020)
"""Where the last key is read, and cleared."""
PROMPT = 0x33
"""Where the monitor keeps the prompt that it shows when a line is read."""
KEPT_IN_RAM = {*range(6), 10, 11, 12, PROMPT, *range(TEMPORARIES, TEMPORARIES_END)}
KEPT_IN_RAM |= {0x30, 0xE4, 0xE7, 0xF1, 0xF9}
"""Bytes of page 0 that are in ``ram`` as the ROM has them: with COLOR=, HCOLOR=, SCALE=, SPEED= and
ROT=."""
UNKEPT = range(0x200)
"""Pages 0 and 1, of which most bytes are the ROM's own and are not kept here."""

PLUS, MINUS = TOKENS["+"], TOKENS["-"]
SUBFLG_SIMPLE = 0x80
"""SUBFLG: no array and no integer may come, because of FOR or DEF FN."""
DIGITS, HEADER, LINE_LIMIT = range(48, 58), 4, 0x19
"""Characters; a line's bytes before its text: the next line's address and the number; the number's
high byte from which LINGET refuses a further digit: past 63999."""
INTEGER, STRING, FUNCTION = 0x8080, 0x0080, 0x8000
"""Top bits of a name's two bytes in memory: its kind; a real has none."""

_NUMERAL = re.compile(rb" *[-+]?[ 0-9]*(?:\.[ 0-9]*)?(?:E *[-+%c%c]?[ 0-9]*)?" % (PLUS, MINUS))
_NAME = re.compile(rb"([A-Z]) *([A-Z0-9]?)[A-Z0-9 ]*([$%]?) *")
MARKS = {b"": 0, b"$": STRING, b"%": INTEGER}
_SIGNS = bytes.maketrans(bytes((PLUS, MINUS)), b"+-")

Name = tuple[int, int, bool]
"""A name's two bytes as a number, the address behind it, and whether subscripts follow."""


def _remember(things: list[str], thing: str) -> None:
    """Add what is not there yet, up to a number of things."""
    if thing not in things and len(things) <= REFUSALS:
        things.append(thing if len(things) < REFUSALS else MORE_REFUSED)


class Memory:
    """``ram``, the pointers, the devices, and the program's bytes from ``txtptr`` on.

    ``statements_left`` limits what a program may do; ``interrupted`` is control-C; ``refused``:
    what was asked for and is not done here (drawing, tape, machine code); ``passed_over``: what is
    not done either, and ended in no error (a sentence each); ``poked``: addresses of pages 0 and 1
    that the program has filled itself; ``fac``: what the
    accumulator held last, ``valtyp``: `IS_STRING` when it is a string; ``cprtyp``: what a formula
    left of its last relation, which the next string's + takes for a relation's signs; ``charac``:
    CHARAC, in which INT leaves a byte, too.
    """

    variables_changed: Callable[[], None]

    def __init__(
        self, keyboard: Keyboard, screen: Device, printer: Device | None, blanks: bool, **dos: bool
    ) -> None:
        self.ram = bytearray(ADDRESSES + _BEYOND)
        self.ram[: len(PAGE_ZERO)] = PAGE_ZERO
        self.ram[0xF1] = 1  # SPEED= 255
        self.screen = Screen(self.ram, screen, blanks)
        self.console = Console(keyboard, self.screen.write, printer, **dos)
        self.console.editor = self.screen
        self.seed, self.fac = FIRST_SEED, AFTER_TYPING
        self.sp = STACK
        self.txttab = TEXT_START
        self.vartab = self.arytab = self.strend = self.prgend = TEXT_START + 2
        self.fretop = self.memsiz = ROM
        self.curlin = DIRECT
        self.datptr = self.txtptr = TEXT_START - 1
        self.oldlin = self.oldtext = self.datlin = self.varpnt = self.forpnt = self.remstk = 0
        self.errflg = self.errlin = self.errpos = self.errnum = self.errstk = self.lastpt = 0
        self.txtpsv = self.cursv = self.subflg = self.trcflg = self.flash = self.lock = 0
        self.temppt, self.charac = TEMPORARIES, 0
        self.valtyp = self.cprtyp = 0
        self.interrupted = self.inttyp = self.broken = False
        self.statements_left: int | None = None
        self.refused: list[str] = []
        self.passed_over: list[str] = []
        self.poked: set[int] = set()
        self.console.passed_over = self._pass_over_command

    def pause(self) -> None:
        """ISCNTC. Raises KeyboardInterrupt and TooManyStatements."""
        if self.interrupted:
            raise KeyboardInterrupt
        if self.statements_left is not None:
            if self.statements_left <= 0:
                raise TooManyStatements
            self.statements_left -= 1

    def refuse(self, what: str) -> None:
        _remember(self.refused, what)
        raise Fault("SYNTAX", self.sp - 4)

    def _pass_over_command(self, word: str) -> None:
        _remember(self.passed_over, f"the disk command {word} was passed over: there is no disk")

    def peek(self, address: int) -> int:
        """The byte at an address."""
        if address in POINTERS:
            name, shift, _ = POINTERS[address]
            return int(getattr(self, name)) >> shift & 0xFF
        if address in OF_SCREEN:
            name, shift, _ = OF_SCREEN[address]
            return int(getattr(self.screen, name)) >> shift & 0xFF
        if address in SEED:
            return to_stored(self.seed)[address - SEED.start]
        if address in KEYBOARD:
            return self.console.key_code()
        if address in STROBE:
            self.console.clear_key()
            return 0
        if address in APPLE_II_PLUS:
            return APPLE_II_PLUS[address]
        unkept = address in UNKEPT and address not in self.poked and address not in KEPT_IN_RAM
        if unkept or address >= ROM:
            _remember(self.passed_over, f"PEEK ({address}) gave 0: that byte is not modelled")
        return 0 if address >= ROM else self.ram[address]

    def poke(self, address: int, value: int) -> None:
        """Put a byte at an address. A pointer poked may move the program or its variables."""
        if address in POINTERS:
            name, shift, kept = POINTERS[address]
            setattr(self, name, getattr(self, name) & kept | value << shift)
            if kept:
                self.text_changed()
                self.variables_changed()
        elif address in OF_SCREEN:
            name, shift, kept = OF_SCREEN[address]
            setattr(self.screen, name, getattr(self.screen, name) & kept | value << shift)
        elif address in SEED:
            stored = bytearray(to_stored(self.seed))
            stored[address - SEED.start] = value
            self.seed = from_stored(bytes(stored))
        elif address < ROM:
            changed = self.ram[address] != value
            self.ram[address] = value
            if changed and 0xFF < address < self.vartab and address not in SCREEN:
                self.text_changed()
            elif changed and self.vartab <= address < self.strend:
                self.variables_changed()
            if address in UNKEPT:
                self.poked.add(address)
        elif address in STROBE:
            self.console.clear_key()

    def word(self, address: int) -> int:
        return self.ram[address] | self.ram[address + 1] << 8

    def put_word(self, address: int, value: int) -> None:
        self.ram[address] = value & 0xFF
        self.ram[address + 1] = value >> 8 & 0xFF

    def text_changed(self) -> None:
        """Forget what stands at addresses of the program: names; reals and constants, each with
        the address behind it and its name or value; where GOTO leads."""
        self.names: dict[int, Name] = {}
        self.atoms: dict[int, tuple[int, int, Number | None]] = {}
        self.targets: dict[int, int] = {}

    def character(self) -> int:
        """CHRGOT: the byte at TXTPTR, or the next one that is no blank."""
        ram = self.ram
        while (byte := ram[self.txtptr]) == BLANK:
            self.txtptr += 1
        return byte

    def at_end(self) -> bool:
        return self.character() in (0, COLON)

    def expect(self, byte: int, sp: int) -> int:
        """SYNCHR: past a byte that has to come next; the one after it. Raises SYNTAX."""
        ram = self.ram
        if ram[self.txtptr] != byte and self.character() != byte:
            raise Fault("SYNTAX", sp)
        self.txtptr += 1
        following = ram[self.txtptr]
        return following if following != BLANK else self.character()

    def data_(self) -> None:
        """DATA: to the next colon outside quotes, or the line's end."""
        ram, pos, quoted = self.ram, self.txtptr, False
        while (byte := ram[pos]) and (quoted or byte != COLON):
            quoted ^= byte == QUOTE
            pos += 1
        self.txtptr = pos
        self.charac = 0

    def rem_(self) -> None:
        self.txtptr = self.ram.index(0, self.txtptr)
        self.charac = 0

    def name_at(self, pos: int) -> Name:
        """The name that begins with the letter at an address: two characters count."""
        match = _NAME.match(self.ram, pos)
        assert match is not None
        first, second, mark = match.groups()
        key = ord(first) << 8 | ord(second or b"\0") | MARKS[mark]
        end = match.end()
        subscripts = self.ram[end] == OPEN
        if BUFFER_END <= pos < self.prgend:
            self.names[pos] = key, end, subscripts
            if not subscripts and not mark:
                self.atoms[pos] = end, key, None
        return key, end, subscripts

    def numeral(self) -> Number:
        """FIN: the number that begins at TXTPTR, and past it; zero if none does. Tokens stand for
        the signs behind an E. Raises OVERFLOW."""
        match = _NUMERAL.match(self.ram, self.txtptr)
        assert match is not None  # it matches nothing, too
        self.txtptr = match.end()
        text = match[0].translate(_SIGNS, b" ").decode("ascii")
        return decimaltext.read(text)[0]

    def constant(self) -> Number:
        """FIN on a number in the program. Raises OVERFLOW."""
        pos = self.txtptr
        value = self.numeral()
        if BUFFER_END <= pos < self.prgend:
            self.atoms[pos] = self.txtptr, 0, value
        return value

    def line_number(self, sp: int) -> int:
        """LINGET: the digits that come next; 0 if there are none. Raises SYNTAX."""
        number = 0
        while (byte := self.character()) in DIGITS:
            if number >> 8 >= LINE_LIMIT:
                raise Fault("SYNTAX", sp)
            self.charac = byte - 48
            number = 10 * number + byte - 48
            self.txtptr += 1
        return number

    def find_line(self, number: int, address: int) -> tuple[bool, int]:
        """FNDLIN: whether a line has this number, from an address on; where it lies, or the next
        larger one, or the end."""
        ram = self.ram
        for _ in range(ADDRESSES):  # addresses poked may lead in a circle, where the ROM stays
            if not ram[address + 1]:
                return False, address
            found = ram[address + 2] | ram[address + 3] << 8
            if found >= number:
                return found == number, address
            address = ram[address] | ram[address + 1] << 8
        return False, address
