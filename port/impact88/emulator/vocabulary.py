"""The names that compiled steps use, and what each means for a machine.

`expressions` and the statement compilers write these names; nothing else may depend on them.
"""

from __future__ import annotations

from typing import Any

from ..applesoft import functions
from ..applesoft.errorcodes import ApplesoftError
from ..applesoft.real import (
    ZERO,
    absolute,
    add,
    compare,
    divide,
    integer,
    multiply,
    negate,
    rounded,
    subtract,
)
from . import memory
from .accumulator import wrapped
from .hardware import Hardware
from .variables import Function, address, byte, subscript, whole


def bad(kind: str) -> None:
    """The error that a piece of the program runs into."""
    raise ApplesoftError(kind)


_NUMBERS: dict[str, Any] = {
    "add": add,
    "subtract": subtract,
    "multiply": multiply,
    "divide": divide,
    "negate": negate,
    "rounded": rounded,
    "compare": compare,
    "ONE": integer(1),
    "TRUTH": (ZERO, integer(1)),
    "SGN": functions.sign,
    "ABS": absolute,
    "LOG": functions.logarithm,
    "SIN": functions.sine,
    "COS": functions.cosine,
    "TAN": functions.tangent,
    "ATN": functions.arc_tangent,
    "byte": byte,
    "address": address,
    "subscript": subscript,
    "whole": whole,
    "Function": Function,
    "bad": bad,
}


def names(hardware: Hardware) -> dict[str, Any]:
    """The names for a machine of these hardware, but for those of its own methods."""
    return {**_NUMBERS, **_values(hardware), **_flow(hardware), **_outside(hardware)}


def _values(hardware: Hardware) -> dict[str, Any]:
    variables, strings = hardware.variables, hardware.variables.strings
    accumulator = hardware.accumulator
    return {
        "V": variables.values,
        "made_": variables.made,
        "make": variables.make,
        "place": variables.place,
        "element1": variables.element1,
        "element2": variables.element2,
        "element": variables.element,
        "value1": variables.value1,
        "value2": variables.value2,
        "value": variables.value,
        "dimension": variables.dimension,
        "joined": strings.joined,
        "joined_": accumulator.joined,
        "byte_": accumulator.byte,
        "CHR_": accumulator.character,
        "literal_": accumulator.literal,
        "left_operand": accumulator.left_operand,
        "load": accumulator.load,
        "scan": accumulator.scan,
        "scanned": accumulator.scanned,
        "keep": accumulator.keep,
        "residue": accumulator.residue,
        "left_over": accumulator.left_over,
        "INT": accumulator.floor,
        "EXP": accumulator.exponential,
        "SQR": accumulator.square_root,
        "power": accumulator.power,
        "left": strings.left,
        "right": strings.right,
        "mid": strings.mid,
        "made": strings.made,
        "literal": lambda address, length: strings.temporary(length, address),
        "copied": strings.copied,
        "kept": strings.kept,
        "strcmp": strings.compare,
        "CHR": lambda x: strings.made(chr(byte(x))),
        "STR": accumulator.digits,
        "LEN": lambda string: integer(strings.free(string).length),
        "ASC": lambda string: integer(strings.code(string)),
        "FRE": lambda number: variables.free(),
        "FREE": lambda string: (strings.free(string), variables.free())[1],
    }


def _flow(hardware: Hardware) -> dict[str, Any]:
    control, variables = hardware.control, hardware.variables
    return {
        "begin_for": control.begin_for,
        "push_for": control.push_for,
        "next_": control.next_,
        "pop": control.pop,
        "room": control.room,
        "assign": control.assign,
        "find": variables.find,
        **wrapped(hardware.accumulator, control.enter),
    }


def _outside(hardware: Hardware) -> dict[str, Any]:
    output, inputs, strings = hardware.output, hardware.inputs, hardware.variables.strings
    return {
        "out": output.out,
        "out_literal": lambda text: output.out(strings.shown(text)),
        "out_string": lambda string: output.out(strings.used(string)),
        "out_number": lambda x: output.out(hardware.accumulator.printed(x)),
        "newline": output.newline,
        "zone": output.zone,
        "tab": output.tab,
        "spc": output.spc,
        "POS": output.position,
        "htab": output.htab,
        "vtab": output.vtab,
        "home": hardware.screen.home,
        "text": hardware.screen.full_window,
        "normal": output.normal,
        "inverse": output.inverse,
        "flash": output.flash,
        "pr": hardware.console.select,
        "in_": lambda slot: None,  # nothing but the keyboard is plugged in
        "read": inputs.read,
        "restore": inputs.restore,
        "input_": inputs.input_,
        "get": inputs.get,
        "PEEK": lambda x: integer(memory.peek(hardware, address(x))),
        "WAIT": lambda place, mask, flip=0: bool((memory.peek(hardware, place) ^ flip) & mask),
    }
