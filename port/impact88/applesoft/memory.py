"""PEEK and POKE: the machine's memory as far as it is modelled.

Modelled: Applesoft's pointers and flags on page 0, the text screen, the program, the variables and
arrays. Other RAM keeps what is put there and reads as 0 before. There is no 6502: CALL knows the
monitor's routines for the screen, ONERR's cleaning-up and a bare RTS.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .program import START
from .real import from_stored, integer, to_integer, to_stored
from .screen import BASE
from .strings import Literal
from .symbols import ARRAYS, FUNCTION, INTEGER, REAL, SIMPLE
from .variables import ARRAY_HEADER, ELEMENT_SIZES, VARIABLE_SIZE

if TYPE_CHECKING:
    from .machine import Machine

WINDOW = {32: "left", 33: "width", 34: "top", 35: "bottom"}
COLUMN, ROW, MASK = 36, 37, 50
ERROR_FLAG, ERROR_CODE = 216, 222
FLASH_BIT, SPEED, TRACE_FLAG = 243, 241, 242
SCREEN = range(BASE, 0x800)
APPLE_II_PLUS = {0xFBB3: 0xEA}
"""The byte of the monitor by which programs tell the machines apart."""
RTS = 0x60
ROM = 0xC000


def _words(machine: Machine) -> dict[int, int]:
    """The two-byte pointers on page 0."""
    variables, inputs = machine.variables, machine.inputs
    return {
        103: START,
        105: variables.start,
        107: variables.end_of_variables(),
        109: variables.end_of_arrays(),
        111: variables.strings.bottom,
        115: variables.strings.top,
        117: machine.line_now(),
        123: inputs.data_line,
        125: inputs.pointer,
        175: machine.program.end,
        218: machine.errors.line,
    }


def peek(machine: Machine, address: int) -> int:
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
    if START - 1 <= address < machine.program.end:
        offset = address - START
        image = machine.program.image
        return image[offset] if 0 <= offset < len(image) else 0
    cell = _cell(machine, address)
    if cell is not None:
        bytes_, offset, _ = cell
        return bytes_()[offset]
    return machine.ram.get(address, APPLE_II_PLUS.get(address, 0))


def _page_zero(machine: Machine, address: int) -> int:
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
        FLASH_BIT: lambda: machine.flash_bit,
        TRACE_FLAG: lambda: 0x80 if machine.tracing else 0,
    }
    return known[address]() & 0xFF if address in known else machine.ram.get(address, 0)


def poke(machine: Machine, address: int, value: int) -> None:
    """Put a byte at an address."""
    screen = machine.screen
    if address in SCREEN:
        screen.put_byte(address, value)
    elif address in WINDOW:
        screen.set_window(WINDOW[address], value)
    elif address == COLUMN:
        screen.move_to_column(value)
    elif address == ROW:
        screen.move_to_row(min(value, 23))
    elif address == MASK:
        screen.set_mode(value)
    elif address == ERROR_FLAG:
        machine.errors.flag = value
    elif address == ERROR_CODE:
        machine.errors.code = value
    elif address == FLASH_BIT:
        machine.flash_bit = value
    elif 201 <= address <= 205:
        stored = bytearray(to_stored(machine.seed))
        stored[address - 201] = value
        machine.seed = from_stored(bytes(stored))
    elif START <= address < machine.program.end:
        machine.poke_program(address, value)
    else:
        cell = _cell(machine, address)
        if cell is not None:
            bytes_, offset, put = cell
            changed = bytearray(bytes_())
            changed[offset] = value
            put(bytes(changed))
        elif address < ROM:
            machine.ram[address] = value


Cell = tuple[Callable[[], bytes], int, Callable[[bytes], None]]


def _cell(machine: Machine, address: int) -> Cell | None:
    """What stands at an address among the variables: its bytes, the offset in them, and a function
    that stores changed ones."""
    variables = machine.variables
    if not variables.start <= address < variables.end_of_arrays():
        return None
    offset = address - variables.start
    index, offset = divmod(offset, VARIABLE_SIZE)
    if index < len(variables.order):
        slot = variables.order[index]
        name = SIMPLE.names[slot]
        values = variables.values

        def simple() -> bytes:
            return name.stored() + _bytes(values[slot], name.kind).ljust(5, b"\0")

        def put(changed: bytes) -> None:
            values[slot] = _value(values[slot], name.kind, changed[2:])

        return simple, offset, put
    return _array_cell(machine, address)


def _array_cell(machine: Machine, address: int) -> Cell | None:
    variables = machine.variables
    offset = address - variables.end_of_variables()
    for slot in variables.array_order:
        array = variables.arrays[slot]
        assert array is not None
        size = ELEMENT_SIZES[array.kind]
        header = ARRAY_HEADER + 2 * len(array.sizes)
        total = header + size * len(array.data)
        if offset < header:
            head = ARRAYS.names[slot].stored() + total.to_bytes(2, "little")
            head += bytes((len(array.sizes),))
            head += b"".join(n.to_bytes(2, "big") for n in reversed(array.sizes))
            return (lambda: head), offset, lambda changed: None
        if offset < total:
            index, offset = divmod(offset - header, size)
            data, kind = array.data, array.kind

            def put(changed: bytes) -> None:
                data[index] = _value(data[index], kind, changed)

            return (lambda: _bytes(data[index], kind)), offset, put
        offset -= total
    return None


def _bytes(value: Any, kind: str) -> bytes:
    """A value as it lies in memory; where a string lies is not modelled."""
    if kind == REAL:
        return to_stored(value)
    if kind == INTEGER:
        return (to_integer(value) & 0xFFFF).to_bytes(2, "big")
    if kind == FUNCTION:
        return b"\0" * 5
    return bytes((len(value), 0, 0))


def _value(old: Any, kind: str, changed: bytes) -> Any:
    """The value that changed bytes stand for."""
    if kind == REAL:
        return from_stored(changed[:5])
    if kind == INTEGER:
        return integer(int.from_bytes(changed[:2], "big", signed=True))
    if kind == FUNCTION:
        return old
    return Literal(old[: changed[0]].ljust(changed[0], "\0"))


def call(machine: Machine, address: int) -> bool:
    """CALL: whether the routine is known."""
    screen = machine.screen
    routines: dict[int, Callable[[], object]] = {
        0xFC58: screen.home,
        0xFC9C: screen.clear_to_end_of_line,
        0xFC42: screen.clear_to_end,
        0xFC70: screen.scroll,
        0xFC66: screen.line_feed,
        0xFC62: lambda: screen.write("\n"),
        0xFD8E: lambda: machine.out("\n"),
        0xFF3A: lambda: machine.out("\a"),
        0xFBDD: lambda: machine.out("\a"),
        0xFB2F: screen.full_window,
        0xFE80: machine.inverse,
        0xFE84: machine.normal,
        0xF328: machine.forget_error,
        0xF273: machine.normal,
        0xD683: machine.control.clear,
        0xD66C: machine.clear_variables,
        0xFCA8: lambda: None,
    }
    if address in routines:
        routines[address]()
    elif machine.ram.get(address) != RTS:
        return False
    return True
