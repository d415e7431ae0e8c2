"""The machine's memory: 64K of bytes, page 0 by name, PEEK and POKE, and the program's text.

All that a program can inspect is in ``ram`` at the ROM's addresses. The pointers of page 0 are
attributes, named as in the ROM's listing in small letters (`POINTERS`); the ROM itself is not
readable. Names, constants and line numbers read in the program are cached by address until a byte
of the program changes; page 2 is never cached.
"""

import re
from collections.abc import Callable, Iterator

from ..applesoft import decimaltext
from ..applesoft.console import Console, Device, Keyboard
from ..applesoft.real import Number, from_stored, to_stored
from .faults import Fault, TooManyStatements
from .screen import BASE, END, Screen
from .tokens import BLANK, COLON, OPEN, QUOTE, TOKENS

TEXT_START = 0x801  # TXTTAB
ROM = 0xC000  # HIMEM without a disk system
STACK = 0xF8  # the stack pointer of an empty stack
DIRECT = 0xFF00  # CURLIN from here on means a line typed without a number
INPUT_BUFFER = 0x200  # page 2, where typed lines are read and replaced by their tokens
BUFFER_END = 0x300
TEMPORARIES = 0x55  # TEMPST, the descriptors of three temporary strings
TEMPORARIES_END = 0x5E
EMPTY = 0xE09A  # a zero in ROM, the value of a variable never assigned
APPLE_II_PLUS = {0xFBB3: 0xEA}
"""The byte of the monitor that identifies the model."""
PAGE_ZERO = bytes.fromhex("4C3CD4 4C3ADB 000000 00 4C99E1")
"""Start of page 0 after power-on: jumps to the prompt, to print a text, and USR's."""
FIRST_SEED = from_stored("804FC75200")
"""RND's seed after power-on: of the ROM's five bytes, which end in 58, four are copied."""
AFTER_TYPING = (0xD0, 0xD0 << 32, 0)
"""The accumulator after the ROM's parser: an address."""
SEED = range(201, 206)  # addresses of RND's seed
SCREEN = range(BASE, END)
ADDRESSES = 0x10000
MAX_NOTES = 8  # different requests for missing features that are noted
MORE_NOTES = "more of the kind"
_PADDING = 0x200  # zeros after the last address, where text running to the end of memory stops

_PAGE_ZERO = """14 subflg 20 screen.left 21 screen.width 22 screen.top 23 screen.bottom
24 screen.column 25 screen.row 28 screen.address+ 32 screen.mask 52 temppt 53 lastpt 67 txttab+
69 vartab+ 6B arytab+ 6D strend+ 6F fretop+ 73 memsiz+ 75 curlin+ 77 oldlin+ 79 oldtext+
7B datlin+ 7D datptr+ 83 varpnt+ 85 forpnt+ AF prgend+ B8 txtptr+ D6 lock D8 errflg DA errlin+
DC errpos+ DE errnum DF errstk F2 trcflg F3 flash F4 txtpsv+ F6 cursv+ F8 remstk"""
POINTERS: dict[int, tuple[str, str, int, int]] = {}
"""Address on page 0 -> ``screen.`` for an attribute of the screen, its name, shift of its byte, and
mask of its other byte."""
for _address, _owner, _name, _word in re.findall(r"(\w+) (screen\.)?(\w+)(\+?)", _PAGE_ZERO):
    POINTERS[int(_address, 16)] = _owner, _name, 0, 0xFF00 if _word else 0
    if _word:
        POINTERS[int(_address, 16) + 1] = _owner, _name, 8, 0x00FF
KEYBOARD = range(0xC000, 0xC010)  # addresses at which the last key is read
STROBE = range(0xC010, 0xC020)  # and cleared
PROMPT = 0x33  # address of the prompt that the monitor shows
KEPT_IN_RAM = {*range(6), 10, 11, 12, PROMPT, *range(TEMPORARIES, TEMPORARIES_END)}
KEPT_IN_RAM |= {0x30, 0xE4, 0xE7, 0xF1, 0xF9}
"""Bytes of page 0 that ``ram`` holds like the machine, those of COLOR=, HCOLOR=, SCALE=, SPEED= and
ROT= included."""
UNKEPT = range(0x200)
"""Pages 0 and 1, most of whose bytes are internal to the ROM and not modelled."""

PLUS = TOKENS["+"]
MINUS = TOKENS["-"]
SUBFLG_SIMPLE = 0x80  # SUBFLG in FOR and DEF FN: neither arrays nor integers are allowed
DIGITS = range(48, 58)  # the codes of digits
LETTERS = range(65, 91)  # of capital letters
HEADER = 4  # bytes of a line before its tokens: the next line's address and the number
MAX_LINE_HIGH_BYTE = 0x19  # from this high byte on LINGET refuses a further digit: past 63999
# top bits of a name's two bytes in memory mark its type; a real has none
INTEGER = 0x8080
STRING = 0x0080
FUNCTION = 0x8000

_NUMERAL = re.compile(rb" *[-+]?[ 0-9]*(?:\.[ 0-9]*)?(?:E *[-+%c%c]?[ 0-9]*)?" % (PLUS, MINUS))
_NAME = re.compile(rb" *([A-Z]) *([A-Z0-9]?)[A-Z0-9 ]*([$%]?) *")
MARKS = {b"": 0, b"$": STRING, b"%": INTEGER}
_SIGNS = bytes.maketrans(bytes((PLUS, MINUS)), b"+-")

Name = tuple[int, int, bool]
"""A name's two bytes as a number, the address after it, and True if subscripts follow."""


def _add_note(notes: list[str], note: str) -> None:
    """Add a new note, up to `MAX_NOTES`."""
    if note not in notes and len(notes) <= MAX_NOTES:
        notes.append(note if len(notes) < MAX_NOTES else MORE_NOTES)


class Memory:
    """``ram``, the pointers, the devices, and the program's bytes from ``txtptr`` on.

    ``statements_left`` limits what a program may do; ``interrupted`` is control-C; ``refused``:
    missing features that were used and ended in an error (drawing, tape, machine code);
    ``ignored``: what is not done either, and ended in no error (a sentence each); ``poked``:
    addresses of pages 0 and 1 that the program has filled itself; ``fac``: what the accumulator
    held last, ``valtyp``: `IS_STRING` when it is a string; ``cprtyp``: what a formula left of its
    last relation, which the next string's + takes for a relation's signs; ``charac``: CHARAC, in
    which INT leaves a byte, too."""

    variables_changed: Callable[[], None]

    def __init__(self, keyboard: Keyboard, screen: Device, blanks: bool, **dos: bool) -> None:
        self.ram = bytearray(ADDRESSES + _PADDING)
        self.ram[: len(PAGE_ZERO)] = PAGE_ZERO
        self.ram[0xF1] = 1  # SPEED= 255
        self.screen = Screen(self.ram, screen, blanks)
        self.console = Console(keyboard, self.screen.write, **dos)
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
        self.ignored: list[str] = []
        self.poked: set[int] = set()
        self.console.on_ignored_command = self._pass_over_command

    def pause(self) -> None:
        """ISCNTC: raise KeyboardInterrupt after control-C; or TooManyStatements."""
        if self.interrupted:
            raise KeyboardInterrupt
        if self.statements_left is not None:
            if self.statements_left <= 0:
                raise TooManyStatements
            self.statements_left -= 1

    def refuse(self, what: str) -> None:
        """Note the use of a missing feature and raise SYNTAX."""
        _add_note(self.refused, what)
        raise Fault("SYNTAX", self.sp - 4)

    def ignore(self, what: str) -> None:
        """Note what is not done here and ends in no error."""
        _add_note(self.ignored, what)

    def _pass_over_command(self, word: str) -> None:
        self.ignore(f"the disk command {word} was passed over: there is no disk")

    def peek(self, address: int) -> int:
        """Return the byte at an address."""
        if address in POINTERS:
            of_screen, name, shift, _ = POINTERS[address]
            return int(getattr(self.screen if of_screen else self, name)) >> shift & 0xFF
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
            self.ignore(f"PEEK ({address}) gave 0: that byte is not modelled")
        return 0 if address >= ROM else self.ram[address]

    def poke(self, address: int, value: int) -> None:
        """Store a byte at an address. A new pointer may move the program or its variables."""
        if address in POINTERS:
            of_screen, name, shift, other_byte = POINTERS[address]
            owner = self.screen if of_screen else self
            setattr(owner, name, getattr(owner, name) & other_byte | value << shift)
            if other_byte and not of_screen:
                self.text_changed()
                self.variables_changed()
        elif address in SEED:
            seed_bytes = bytearray(to_stored(self.seed))
            seed_bytes[address - SEED.start] = value
            self.seed = from_stored(bytes(seed_bytes))
        elif address < ROM:
            differs = self.ram[address] != value
            self.ram[address] = value
            if differs and 0xFF < address < self.vartab and address not in SCREEN:
                self.text_changed()
            elif differs and self.vartab <= address < self.strend:
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
        """Clear the caches of the program's text: ``names``; ``atoms``, simple reals and constants
        as (address after it, name, value); ``targets`` of GOTO."""
        self.names: dict[int, Name] = {}
        self.atoms: dict[int, tuple[int, int, Number | None]] = {}
        self.targets: dict[int, int] = {}

    def character(self) -> int:
        """CHRGOT: skip blanks and return the byte at TXTPTR."""
        ram = self.ram
        while (byte := ram[self.txtptr]) == BLANK:
            self.txtptr += 1
        return byte

    def at_end(self) -> bool:
        return self.character() in (0, COLON)

    def expect(self, byte: int, sp: int) -> int:
        """SYNCHR: skip a required byte and return the next one. Raises SYNTAX."""
        ram = self.ram
        if ram[self.txtptr] != byte and self.character() != byte:
            raise Fault("SYNTAX", sp)
        self.txtptr += 1
        following = ram[self.txtptr]
        return following if following != BLANK else self.character()

    def data_(self) -> None:
        """DATA: skip to the next colon outside quotes, or to the line's end."""
        ram, pos, in_quotes = self.ram, self.txtptr, False
        while (byte := ram[pos]) and (in_quotes or byte != COLON):
            in_quotes ^= byte == QUOTE
            pos += 1
        self.txtptr = pos
        self.charac = 0

    def rem_(self) -> None:
        self.txtptr = self.ram.index(0, self.txtptr)
        self.charac = 0

    def name_at(self, sp: int) -> Name:
        """Return the name at TXTPTR, of which two characters count. Raises SYNTAX if there is none:
        a small letter begins no name."""
        pos = self.txtptr
        match = _NAME.match(self.ram, pos)
        if match is None:
            raise Fault("SYNTAX", sp)
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
        """FIN: read the number at TXTPTR, zero if there is none. After an E the signs are tokens.
        Raises OVERFLOW."""
        match = _NUMERAL.match(self.ram, self.txtptr)
        assert match is not None  # the pattern also matches nothing
        self.txtptr = match.end()
        text = match[0].translate(_SIGNS, b" ").decode("ascii")
        return decimaltext.read(text)[0]

    def constant(self) -> Number:
        """FIN: read a number in the program and cache it. Raises OVERFLOW."""
        pos = self.txtptr
        value = self.numeral()
        if BUFFER_END <= pos < self.prgend:
            self.atoms[pos] = self.txtptr, 0, value
        return value

    def line_number(self, sp: int) -> int:
        """LINGET: read a line number, 0 without digits. Raises SYNTAX."""
        number = 0
        while (byte := self.character()) in DIGITS:
            if number >> 8 >= MAX_LINE_HIGH_BYTE:
                raise Fault("SYNTAX", sp)
            self.charac = byte - 48
            number = 10 * number + byte - 48
            self.txtptr += 1
        return number

    def lines(self, address: int = 0) -> Iterator[tuple[int, bytes]]:
        """Yield number and tokens of each line, following the addresses: of all, or from one on."""
        ram, address = self.ram, address or self.txttab
        addresses: set[int] = set()  # after POKEs links may form a circle
        while ram[address + 1] and address not in addresses:
            addresses.add(address)
            text = address + HEADER
            yield self.word(address + 2), bytes(ram[text : ram.index(0, text)])
            address = self.word(address)

    def find_line(self, number: int, address: int) -> tuple[bool, int]:
        """FNDLIN: search a line from an address on. Return True if it exists, and its address, else
        that of the next larger one or the program's end."""
        ram = self.ram
        for _ in range(ADDRESSES):  # in a circle of links the ROM hangs
            if not ram[address + 1]:
                return False, address
            line = ram[address + 2] | ram[address + 3] << 8
            if line >= number:
                return line == number, address
            address = ram[address] | ram[address + 1] << 8
        return False, address
