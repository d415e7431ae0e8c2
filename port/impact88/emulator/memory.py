"""PEEK and POKE: the machine's memory as far as it is modelled.

Modelled: Applesoft's pointers and flags on page 0, the text screen, the program, the variables and
arrays. Other RAM keeps what is put there and reads as 0 before. There is no 6502: CALL knows the
monitor's routines for the screen, ONERR's cleaning-up and a bare RTS.
"""

from __future__ import annotations

from collections.abc import Callable

from ..applesoft.real import from_stored, to_stored
from . import layout
from .hardware import Hardware
from .programtext import START
from .screen import BASE, END

WINDOW = {32: "left", 33: "width", 34: "top", 35: "bottom"}
COLUMN, ROW, MASK = 36, 37, 50
ERROR_FLAG, ERROR_CODE = 216, 222
FLASH_BIT, SPEED, TRACE_FLAG = 243, 241, 242
LOCK = 214
COLOR, HIGH_COLOR, SCALE, ROTATION = 0x30, 0xE4, 0xE7, 0xF9
HIGH_COLORS = bytes.fromhex("00 2A 55 7F 80 AA D5 FF")
SCREEN = range(BASE, END)
APPLE_II_PLUS = {0xFBB3: 0xEA}
"""The byte of the monitor by which programs tell the machines apart."""
RTS = 0x60
ROM = 0xC000


def _words(machine: Hardware) -> dict[int, int]:
    """The two-byte pointers on page 0."""
    variables, inputs = machine.variables, machine.inputs
    return {
        103: START,
        105: variables.start,
        107: variables.end_of_variables(),
        109: variables.end_of_arrays(),
        111: variables.strings.bottom,
        115: variables.strings.top,
        117: machine.line,
        121: machine.statement,
        131: variables.found_address(),
        123: inputs.data_line,
        125: inputs.pointer,
        175: machine.program.end,
        218: machine.errors.line,
    }


def peek(machine: Hardware, address: int) -> int:
    """The byte at an address."""
    if address < 256:
        words = _words(machine)
        if address in words:
            return words[address] & 0xFF
        if address - 1 in words:
            return words[address - 1] >> 8 & 0xFF
        return _page_zero(machine, address)
    if address in SCREEN:
        return machine.screen.byte_at(address)
    field = layout.field_at(machine.variables, address)
    if field is not None:
        return field.read(address)
    return APPLE_II_PLUS.get(address, 0) if address >= ROM else machine.ram[address]


def _page_zero(machine: Hardware, address: int) -> int:
    screen, errors = machine.screen, machine.errors
    if address in WINDOW:
        return int(getattr(screen, WINDOW[address])) & 0xFF
    if 201 <= address <= 205:
        return to_stored(machine.seed)[address - 201]
    known: dict[int, Callable[[], int]] = {
        COLUMN: lambda: screen.column,
        ROW: lambda: screen.row,
        MASK: lambda: screen.mask,
        ERROR_FLAG: lambda: errors.flag,
        ERROR_CODE: lambda: errors.code,
        FLASH_BIT: lambda: machine.output.flash_bit,
        TRACE_FLAG: lambda: machine.trace_flag,
    }
    return known[address]() & 0xFF if address in known else machine.ram[address]


def poke(machine: Hardware, address: int, value: int) -> None:
    """Put a byte at an address, other than in the program's text."""
    screen = machine.screen
    if address in SCREEN:
        screen.put_byte(address, value)
    elif address in WINDOW:
        screen.set_window(WINDOW[address], value)
    elif address == COLUMN:
        screen.move_to_column(value)
    elif address == ROW:
        screen.put_row(value)
    elif address == MASK:
        screen.set_mode(value)
    elif address == ERROR_FLAG:
        machine.errors.flag = value
    elif address == ERROR_CODE:
        machine.errors.code = value
    elif address == FLASH_BIT:
        machine.output.flash_bit = value
    elif 201 <= address <= 205:
        stored = bytearray(to_stored(machine.seed))
        stored[address - 201] = value
        machine.seed = from_stored(bytes(stored))
    else:
        field = layout.field_at(machine.variables, address)
        if field is not None:
            field.write(address, value)
        elif address < ROM:
            machine.ram[address] = value


def call(machine: Hardware, address: int) -> bool:
    """CALL: whether the routine is known."""
    screen = machine.screen
    routines: dict[int, Callable[[], object]] = {
        0xFC58: screen.home,
        0xFC9C: screen.clear_to_end_of_line,
        0xFC42: screen.clear_to_end,
        0xFC70: screen.scroll,
        0xFC66: screen.line_feed,
        0xFC1A: screen.step_up,
        0xFC10: screen.step_back,
        0xFBF4: screen.advance,
        0xFC62: lambda: screen.write("\n"),
        0xFD8E: lambda: machine.output.put("\n"),
        0xFF3A: lambda: machine.output.put("\a"),
        0xFBDD: lambda: machine.output.put("\a"),
        0xFB2F: screen.full_window,
        0xFE80: machine.output.inverse,
        0xFE84: machine.output.normal,
        0xF273: machine.output.normal,
        0xD683: machine.control.clear,
        0xFCA8: lambda: None,
    }
    if address in routines:
        routines[address]()
    elif peek(machine, address) != RTS:
        return False
    return True
