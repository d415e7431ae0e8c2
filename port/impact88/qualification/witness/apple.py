"""A ROM image, and the smallest Apple II Plus that it will run on: RAM, a keyboard, an ear at COUT.

The processor is py65's. What is displayed is taken where the monitor's character output is called;
the ROM draws its text screen besides, in RAM. A key is pressed when the ROM waits for one: when it
reads the keyboard several times in a few cycles each. Nothing of Applesoft is known here.
"""

import hashlib
from collections import deque
from collections.abc import Callable
from typing import Any, NamedTuple

from ...emulator.screen import BASE, HEIGHT, WIDTH, shown_character
from ...errors import UserError, library
from ...files import read_bytes

START = 0xD000
"""Where the ROM begins, of the Apple II Plus as of all before it."""
SIZE = 0x10000 - START
APPLE_II_PLUS = "33a24f5489ba9195b44be77d9afb2252594cb5c7"
"""SHA-1 of the Apple II Plus set: Applesoft in ROM and the autostart monitor."""

_OTHER_SIZES = {
    2048: "one chip of the six that make the set; join $D000 to $F800 in order",
    16384: "an Apple IIe's or IIc's, which begins at $C000",
    20480: "an Apple II Plus set with 8,192 bytes in front that no Apple has there",
    32768: "an Apple IIc's",
}


class Image(NamedTuple):
    """A ROM image: its bytes from $D000 on, their SHA-1, and whether that is the known one."""

    data: bytes
    sha1: str
    known: bool


def read_image(path: str, any_rom: bool = False) -> Image:
    """The image in a file. ``any_rom``: take one that is not known, too. Raises UserError for a
    file that cannot be read, of another size, or not known."""
    data = read_bytes(path, limit=1_000_000)
    if len(data) != SIZE:
        hint = _OTHER_SIZES.get(len(data))
        raise UserError(
            f"has {len(data):,} bytes{f' ({hint})' if hint else ''}; expected an Apple II Plus ROM "
            f"of {SIZE:,} bytes, ${START:X} to $FFFF",
            path,
        )
    sha1 = hashlib.sha1(data).hexdigest()
    known = sha1 == APPLE_II_PLUS
    if not known and not any_rom:
        raise UserError(
            f"SHA-1 {sha1} is not the Apple II Plus set's, {APPLE_II_PLUS}; "
            "--any-rom tries it all the same",
            path,
        )
    return Image(data, sha1, known)


IO_START, KEYBOARD, STROBE = 0xC000, range(0xC000, 0xC010), range(0xC010, 0xC020)
"""Addresses of what is no memory, of the keyboard, and of what clears it."""
COUT, CURSOR_COLUMN = 0xFDED, 0x24
"""The monitor's character output: every character displayed goes through it, in the accumulator;
and where the monitor keeps the cursor's column."""
RETURN = "\r"
_WAITING_POLLS, _POLL_CYCLES = 4, 60
"""Polls in a row, and cycles between two at most, while the ROM waits: the monitor asks every 16
cycles or so, a running program at most once a statement."""
_NOT_WAITING = "the machine does not wait for a key"
PLENTY, BOOT_PLENTY = 80_000_000, 4_000_000
"""Instructions that nothing captured needs, and that switching on does not need."""


class Lost(UserError):
    """The machine does not come to wait for a key: it loops, or has run off into the wild."""


State = tuple[bytes, dict[str, int], int]
"""All of a machine at rest: its memory, the processor's registers, the cursor's column."""
_REGISTERS = ("pc", "a", "x", "y", "sp", "p")


class Memory(bytearray):
    """64K: RAM, the keyboard's two addresses, and the ROM. ``cpu``: what reads it."""

    cpu: Any

    def __init__(self, rom: bytes) -> None:
        super().__init__(bytes(START) + rom)
        self.keys: deque[int] = deque()
        self.key = 0
        self.waiting = False
        self._last_poll = self._polls = 0

    def __getitem__(self, address: Any) -> Any:
        if address.__class__ is int and IO_START <= address < START:
            return self._read_io(address)
        return super().__getitem__(address)

    def __setitem__(self, address: Any, value: Any) -> None:
        if address < IO_START:
            super().__setitem__(address, value)
        elif address in STROBE:
            self.key &= 0x7F

    def _read_io(self, address: int) -> int:
        if address in STROBE:
            self.key &= 0x7F
        if address not in KEYBOARD:
            return 0
        now = self.cpu.processorCycles
        self._polls = self._polls + 1 if now - self._last_poll < _POLL_CYCLES else 0
        self._last_poll = now
        if self._polls >= _WAITING_POLLS and self.key < 0x80:
            self._polls = 0
            self.waiting = not self.keys
            self.key = self.keys.popleft() | 0x80 if self.keys else self.key
        return self.key


class Apple:
    """An Apple II Plus with a ROM in it, switched off. ``instructions`` counts what the processor
    has done. ``blanks``: whether columns skipped on a line come out as blanks when a character
    follows. Raises UserError when py65 is missing."""

    def __init__(self, rom: bytes) -> None:
        processor = library("py65.devices.mpu6502", "witness", "the witness")
        self.memory = Memory(rom)
        self.cpu = self.memory.cpu = processor.MPU(self.memory, pc=None)
        self.instructions = 0
        self.blanks = True
        self._output: list[str] = []
        self._column = 0

    def boot(self, limit: int = BOOT_PLENTY) -> str:
        """Switch on, and wait until the ROM waits for a key. Returns what was displayed."""
        self.cpu.reset()
        self._column = 0
        self._wait(limit)
        return self.take_output()

    def type_keys(self, keys: str) -> None:
        """Type, newlines as RETURN, and wait until the machine waits for more."""
        self.memory.keys.extend(ord(key) & 0x7F for key in keys.replace("\n", RETURN))
        self._wait(PLENTY)

    def call(self, address: int, stops: tuple[int, ...]) -> int:
        """Run from an address until the processor comes to one of ``stops``; returns which one."""
        cpu, says = self.cpu, f"the routine at ${address:04X} does not return"
        cpu.pc = address
        self._step(lambda: cpu.pc in stops, PLENTY, says)
        return int(cpu.pc)

    def _wait(self, limit: int) -> None:
        cpu, memory = self.cpu, self.memory
        memory.waiting = False
        last = self.instructions + limit
        while not memory.waiting:
            if cpu.pc == COUT:
                self._display(last - self.instructions)
            left = last - self.instructions
            self._step(lambda: memory.waiting or cpu.pc == COUT, left, _NOT_WAITING)

    def _step(self, done: Callable[[], bool], limit: int, says: str) -> None:
        """Run until something is so. Raises Lost, with what is not so, and off the memory's end."""
        cpu, count = self.cpu, 0
        try:
            while not done():
                cpu.step()
                count += 1
                if count > limit:
                    place = f"(program counter ${cpu.pc:04X})"
                    raise Lost(f"{says} after {count:,} instructions {place}")
        except IndexError:  # an address past $FFFF
            raise Lost(f"the machine ran off the end of memory (${cpu.pc:04X})") from None
        self.instructions += count

    def _display(self, limit: int) -> None:
        """Let the monitor display a character and take it."""
        cpu, memory = self.cpu, self.memory
        character = chr(cpu.a & 0x7F)
        gap = max(memory[CURSOR_COLUMN] - self._column, 0)
        if character >= " ":
            self._output.append(" " * gap * self.blanks)
            gap = 0
        self._output.append("\n" if character == RETURN else character)
        top = cpu.sp + 2 & 0xFF  # RTS leaves the stack two bytes shorter than at the call
        self._step(lambda: cpu.sp == top, limit, _NOT_WAITING)
        self._column = 0 if character == RETURN else memory[CURSOR_COLUMN] - gap

    def take_output(self) -> str:
        """What was displayed since the last call: high bit dropped, RETURN as newline."""
        text = "".join(self._output)
        self._output.clear()
        return text

    def word(self, address: int) -> int:
        """Two bytes, the low one first."""
        return int(self.memory[address] + 256 * self.memory[address + 1])

    def screen_text(self) -> str:
        """The 24 rows of the text screen, blanks at the ends of rows left out."""
        starts = (BASE + row % 8 * 0x80 + row // 8 * WIDTH for row in range(HEIGHT))
        rows = (self.memory[start : start + WIDTH] for start in starts)
        return "".join("".join(map(shown_character, row)).rstrip(" ") + "\n" for row in rows)

    def state(self) -> State:
        """The machine as it stands; it must be waiting for a key."""
        registers = {name: getattr(self.cpu, name) for name in _REGISTERS}
        return bytes(self.memory), registers, self._column

    def restore(self, state: State) -> None:
        """Make the machine what it was, with no keys typed and nothing displayed."""
        memory, registers, self._column = state
        bytearray.__setitem__(self.memory, slice(0, 0x10000), memory)
        vars(self.cpu).update(registers)
        self.memory.keys.clear()
        self.memory.key = 0
        self._output.clear()
