"""The smallest Apple II Plus that a ROM will run on: RAM, the ROM, a keyboard, and an ear at COUT.

The processor is py65's. What is displayed is taken where the monitor's character output is called;
the ROM draws its text screen besides, in RAM. A key is pressed when the ROM waits for one: when it
reads the keyboard several times in a few cycles each. Nothing of Applesoft is known here.
"""

from collections import deque
from collections.abc import Callable
from typing import Any

from ..emulator.screen import BASE, HEIGHT, WIDTH, shown_character
from ..errors import UserError
from .image import START

IO_START = 0xC000
KEYBOARD, STROBE = range(0xC000, 0xC010), range(0xC010, 0xC020)
COUT = 0xFDED
"""The monitor's character output: every character displayed goes through it, in the accumulator."""
CURSOR_COLUMN = 0x24
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
        try:
            from py65.devices.mpu6502 import MPU  # type: ignore[import-untyped]
        except ImportError:
            raise UserError(
                "the witness needs py65, which is not installed; pip install 'impact88[witness]'"
            ) from None
        self.memory = Memory(rom)
        self.cpu = self.memory.cpu = MPU(self.memory, pc=None)
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
        cpu = self.cpu
        cpu.pc = address
        self._step(
            lambda: cpu.pc in stops, PLENTY, f"the routine at ${address:04X} does not return"
        )
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
                    raise Lost(
                        f"{says} after {count:,} instructions (program counter ${cpu.pc:04X})"
                    )
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
