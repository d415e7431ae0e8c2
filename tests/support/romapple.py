"""Run a ROM image on a minimal Apple II Plus: RAM, a keyboard, and the output captured at COUT.

The processor is py65's. Output is captured where the monitor's character output routine is called;
the ROM also draws its text screen in RAM. A key is pressed when the ROM waits for one, that is,
when it polls the keyboard several times at intervals of a few cycles. Nothing here is specific to
Applesoft.
"""

import hashlib
from collections import deque
from collections.abc import Callable
from typing import Any

from impact88.errors import UserError, library
from impact88.files import read_bytes

START = 0xD000  # address of the ROM in the Apple II Plus and all earlier models
SIZE = 0x10000 - START
APPLE_II_PLUS = "33a24f5489ba9195b44be77d9afb2252594cb5c7"
"""SHA-1 of the Apple II Plus set: Applesoft in ROM and the autostart monitor."""


def read_image(path: str) -> bytes:
    """Return an image from a file; UserError for one that is not an Apple II Plus's."""
    data = read_bytes(path, limit=1_000_000)
    sha1 = hashlib.sha1(data).hexdigest()
    if sha1 != APPLE_II_PLUS:
        expected = f"{SIZE:,} bytes from ${START:X}, SHA-1 {APPLE_II_PLUS}"
        raise UserError(f"has {len(data):,} bytes, SHA-1 {sha1}; expected {expected}", path)
    return data


IO_START = 0xC000  # no memory from here to the ROM
KEYBOARD = range(0xC000, 0xC010)  # reads the key
STROBE = range(0xC010, 0xC020)  # clears the key
COUT = 0xFDED
"""The monitor's character output; every character displayed passes through it, in the
accumulator."""
CURSOR_COLUMN = 0x24  # address of the cursor's column
RETURN = "\r"
# The ROM waits for a key if it polls so many times in a row, at most so many cycles apart: the
# monitor polls about every 16 cycles, a running program at most once a statement.
_MIN_POLLS = 4
_MAX_POLL_CYCLES = 60
_NOT_WAITING = "the machine does not wait for a key"
MAX_INSTRUCTIONS = 80_000_000  # more than any capture needs
MAX_BOOT_INSTRUCTIONS = 4_000_000  # more than switching on needs


class Lost(UserError):
    """The machine does not come to wait for a key: it loops, or has run off the program."""


State = tuple[bytes, dict[str, int], int]
"""State of a machine waiting for a key: memory, the processor's registers, the cursor's column."""
_REGISTERS = ("pc", "a", "x", "y", "sp", "p")


class Memory(bytearray):
    """64K of memory: RAM, the keyboard's addresses, and the ROM. ``cpu``: its processor."""

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
        self._polls = self._polls + 1 if now - self._last_poll < _MAX_POLL_CYCLES else 0
        self._last_poll = now
        if self._polls >= _MIN_POLLS and self.key < 0x80:
            self._polls = 0
            self.waiting = not self.keys
            self.key = self.keys.popleft() | 0x80 if self.keys else self.key
        return self.key


class Apple:
    """An Apple II Plus with a ROM, switched off at first.

    ``instructions``: number executed so far. Raises UserError when py65 is missing.
    """

    def __init__(self, rom: bytes) -> None:
        processor = library("py65.devices.mpu6502", "test", "a ROM image")
        self.memory = Memory(rom)
        self.cpu = self.memory.cpu = processor.MPU(self.memory, pc=None)
        self.instructions = 0
        self._output: list[str] = []
        self._column = 0

    def boot(self, limit: int = MAX_BOOT_INSTRUCTIONS) -> str:
        """Switch on, and run until the ROM waits for a key. Returns the output."""
        self.cpu.reset()
        self._column = 0
        self._wait(limit)
        return self.take_output()

    def type_keys(self, keys: str) -> None:
        """Type keys, newlines as RETURN, and run until the machine waits for more."""
        self.memory.keys.extend(ord(key) & 0x7F for key in keys.replace("\n", RETURN))
        self._wait(MAX_INSTRUCTIONS)

    def call(self, address: int, stops: tuple[int, ...]) -> int:
        """Run from an address until the processor reaches one of ``stops``; return which one."""
        cpu, says = self.cpu, f"the routine at ${address:04X} does not return"
        cpu.pc = address
        self._step(lambda: cpu.pc in stops, MAX_INSTRUCTIONS, says)
        return int(cpu.pc)

    def _wait(self, limit: int) -> None:
        cpu, memory = self.cpu, self.memory
        memory.waiting = False
        last = self.instructions + limit
        while not memory.waiting:
            if cpu.pc == COUT:
                self._display(last - self.instructions)
            remaining = last - self.instructions
            self._step(lambda: memory.waiting or cpu.pc == COUT, remaining, _NOT_WAITING)

    def _step(self, condition: Callable[[], bool], limit: int, says: str) -> None:
        """Run until a condition holds. Raises Lost, with ``says``, after ``limit`` instructions,
        and off the end of memory."""
        cpu, count = self.cpu, 0
        try:
            while not condition():
                cpu.step()
                count += 1
                if count > limit:
                    place = f"(program counter ${cpu.pc:04X})"
                    raise Lost(f"{says} after {count:,} instructions {place}")
        except IndexError:  # an address past $FFFF
            raise Lost(f"the machine ran off the end of memory (${cpu.pc:04X})") from None
        self.instructions += count

    def _display(self, limit: int) -> None:
        """Run the monitor's output routine and record its character."""
        cpu, memory = self.cpu, self.memory
        character = chr(cpu.a & 0x7F)
        gap = 0 if character >= " " else max(memory[CURSOR_COLUMN] - self._column, 0)
        self._output.append("\n" if character == RETURN else character)
        top = cpu.sp + 2 & 0xFF  # RTS leaves the stack two bytes shorter than at the call
        self._step(lambda: cpu.sp == top, limit, _NOT_WAITING)
        self._column = 0 if character == RETURN else memory[CURSOR_COLUMN] - gap

    def take_output(self) -> str:
        """Return the output since the last call, without high bits and with RETURN as newline."""
        text = "".join(self._output)
        self._output.clear()
        return text

    def word(self, address: int) -> int:
        """Return the 16-bit number at an address, low byte first."""
        return int(self.memory[address] + 256 * self.memory[address + 1])

    def state(self) -> State:
        """Return the machine's state; it must be waiting for a key."""
        registers = {name: getattr(self.cpu, name) for name in _REGISTERS}
        return bytes(self.memory), registers, self._column

    def restore(self, state: State) -> None:
        """Restore a state, with no keys typed and no output."""
        memory, registers, self._column = state
        bytearray.__setitem__(self.memory, slice(0, 0x10000), memory)
        vars(self.cpu).update(registers)
        self.memory.keys.clear()
        self.memory.key = 0
        self._output.clear()
