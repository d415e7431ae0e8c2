"""The machine's memory: 64K of bytes, page 0 by name, PEEK and POKE.

Everything a program can look at lies in ``ram`` where the ROM puts it: the program from TXTTAB,
variables from VARTAB, arrays from ARYTAB, strings down from MEMSIZ, a typed line on page 2, the
text screen on pages 4 to 7. The pointers of page 0 are attributes here, by the names of the ROM's
listing in small letters; `POINTERS` says where they lie. Other RAM keeps what is put there
and reads as 0 before. Of the ROM there is nothing to read.
"""

from __future__ import annotations

from collections.abc import Callable

from ..applesoft.console import Console, Device, Keyboard
from ..applesoft.real import from_stored, to_stored
from .faults import Fault, TooManyStatements
from .screen import BASE, END, Screen

TEXT_START = 0x801
"""TXTTAB: where programs begin."""
TOP_OF_MEMORY = 0xC000
"""48K: HIMEM without a disk system."""
INPUT_BUFFER = 0x200
"""Page 2, where typed lines are read in and their tokens put in their place."""
BUFFER_END = 0x300
STACK = 0xF8
"""The stack pointer when nothing is on the stack."""
DIRECT = 0xFF00
"""CURLIN from here on means: typed without a line number."""
TEMPORARIES, TEMPORARIES_END = 0x55, 0x5E
"""TEMPST: the descriptors of three temporary strings."""
EMPTY = 0xE09A
"""A zero in ROM, where a variable is found that was never made."""
ROM = 0xC000
RTS = 0x60
APPLE_II_PLUS = {0xFBB3: 0xEA}
"""The byte of the monitor by which programs tell the machines apart."""
PAGE_ZERO = bytes.fromhex("4C3CD4 4C3ADB 000000 00 4C99E1")
"""The jumps with which switching on begins page 0: to the prompt, to print a text, and USR's."""
FIRST_SEED = from_stored("804FC75200")
"""RND's seed after switching on: of the ROM's five bytes, which end in 58, four are copied."""
SPEED = 241
SEED = range(201, 206)
SCREEN = range(BASE, END)
ADDRESSES = 0x10000
REFUSALS = 8
MORE_REFUSED = "more of the kind"
"""What is not done here is remembered up to a number of different ones."""
_BEYOND = 0x200
"""Zeros behind the last address, so that text that runs on to the end of memory ends there."""


WORDS = (
    "67 txttab 69 vartab 6B arytab 6D strend 6F fretop 73 memsiz 75 curlin 77 oldlin 79 oldtext "
    "7B datlin 7D datptr 83 varpnt 85 forpnt AF prgend B8 txtptr DA errlin DC errpos F4 txtpsv "
    "F6 cursv"
)
BYTES = (
    "14 subflg 52 temppt 53 lastpt D6 lock D8 errflg DE errnum DF errstk F2 trcflg F3 flash "
    "F8 remstk"
)
POINTERS: dict[int, tuple[str, int, int]] = {}
"""What page 0 holds at an address: an attribute, its shift, and the bits of it that stand
elsewhere."""
for _address, _name in zip(BYTES.split()[::2], BYTES.split()[1::2], strict=True):
    POINTERS[int(_address, 16)] = _name, 0, 0
for _address, _name in zip(WORDS.split()[::2], WORDS.split()[1::2], strict=True):
    POINTERS[int(_address, 16)] = _name, 0, 0xFF00
    POINTERS[int(_address, 16) + 1] = _name, 8, 0x00FF
OF_SCREEN = {32: "left", 33: "width", 34: "top", 35: "bottom", 36: "column", 37: "row", 50: "mask"}


class Memory:
    """``ram``, the pointers, and the devices.

    ``statements_left`` limits what a program may do; ``interrupted`` is control-C; ``refused``
    holds what was asked for and is not done here: drawing, tape, machine code. ``text_changed`` and
    ``variables_changed`` make the classes above forget what they remember of the program's bytes,
    of names and sizes among the variables.
    """

    text_changed: Callable[[], None]
    variables_changed: Callable[[], None]

    def __init__(
        self,
        keyboard: Keyboard,
        screen: Device,
        printer: Device | None = None,
        *,
        dos: bool = False,
        echo: bool = True,
        blanks: bool = True,
    ) -> None:
        self.ram = bytearray(ADDRESSES + _BEYOND)
        self.ram[: len(PAGE_ZERO)] = PAGE_ZERO
        self.ram[SPEED] = 1
        self.screen = Screen(self.ram, screen, blanks=blanks)
        self.console = Console(keyboard, self.screen.write, printer, dos=dos, echo=echo)
        self.console.editor = self.screen
        self.seed = FIRST_SEED
        self.sp = STACK
        self.txttab = TEXT_START
        self.vartab = self.arytab = self.strend = self.prgend = TEXT_START + 2
        self.fretop = self.memsiz = TOP_OF_MEMORY
        self.curlin = DIRECT
        self.oldlin = self.oldtext = self.datlin = 0
        self.datptr = self.txtptr = TEXT_START - 1
        self.varpnt = self.forpnt = 0
        self.errflg = self.errlin = self.errpos = self.errnum = self.errstk = 0
        self.txtpsv = self.cursv = self.remstk = 0
        self.subflg = self.trcflg = self.flash = self.lock = 0
        self.temppt, self.lastpt = TEMPORARIES, 0
        self.interrupted = False
        self.statements_left: int | None = None
        self.refused: list[str] = []

    def pause(self) -> None:
        """ISCNTC: control-C, or no more statements. Raises KeyboardInterrupt and
        TooManyStatements."""
        if self.interrupted:
            raise KeyboardInterrupt
        if self.statements_left is not None:
            if self.statements_left <= 0:
                raise TooManyStatements
            self.statements_left -= 1

    def refuse(self, what: str) -> None:
        """What is not done here is a SYNTAX error, and remembered."""
        if what not in self.refused and len(self.refused) <= REFUSALS:
            self.refused.append(what if len(self.refused) < REFUSALS else MORE_REFUSED)
        raise Fault("SYNTAX", self.sp - 4)

    def peek(self, address: int) -> int:
        """The byte at an address."""
        if address in POINTERS:
            name, shift, _ = POINTERS[address]
            return int(getattr(self, name)) >> shift & 0xFF
        if address in OF_SCREEN:
            return int(getattr(self.screen, OF_SCREEN[address])) & 0xFF
        if address in SEED:
            return to_stored(self.seed)[address - SEED.start]
        return APPLE_II_PLUS.get(address, 0) if address >= ROM else self.ram[address]

    def poke(self, address: int, value: int) -> None:
        """Put a byte at an address. A pointer poked may move the program or its variables."""
        if address in POINTERS:
            name, shift, kept = POINTERS[address]
            setattr(self, name, getattr(self, name) & kept | value << shift)
            if kept:
                self.text_changed()
                self.variables_changed()
        elif address in OF_SCREEN:
            setattr(self.screen, OF_SCREEN[address], value)
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

    def word(self, address: int) -> int:
        """Two bytes, the low one first."""
        return self.ram[address] | self.ram[address + 1] << 8

    def put_word(self, address: int, value: int) -> None:
        """Two bytes, the low one first."""
        self.ram[address] = value & 0xFF
        self.ram[address + 1] = value >> 8 & 0xFF
