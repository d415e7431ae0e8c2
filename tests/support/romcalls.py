"""Single operations of the ROM by the compiled library, in the form of the captures."""

from __future__ import annotations

import ctypes

import numpy as np

from impact88.apple.applesoft import decimaltext, real
from impact88.program import kernel
from impact88.program.compiler import CODES

OPERATIONS = {
    "add": "ADD",
    "sub": "SUBTRACT",
    "mul": "MULTIPLY",
    "div": "DIVIDE",
    "pow": "POWER",
    "neg": "NEGATE",
    "abs": "ABS",
    "sgn": "SGN",
    "int": "INT",
    "sqr": "SQR",
    "exp": "EXP",
    "log": "LOG",
    "sin": "SIN",
    "cos": "COS",
    "tan": "TAN",
    "atn": "ATN",
    "fin": "READ",
    "fout": "PRINT",
    "cmp": "COMPARE",
}
LESS = 4
MORE = 1


def call(operation: str, first: str, second: str, extension: str) -> str | None:
    """Return the result of a captured call as `captured.call` does; None for a text that is not
    wholly a number, which the library refuses."""
    low = int(extension or "0", 16)
    if operation == "fin":
        if not decimaltext.is_number(first):
            return None
        return _run([("READ", 0)], [], first)
    operands = [real.from_stored(first, 0 if second else low)]
    if second:
        operands.append(real.from_stored(second, low))
    loads = [("CONSTANT", k) for k in range(len(operands))]
    if operation == "cmp":
        less = _run([*loads, ("COMPARE", LESS)], operands) != "zero"
        more = _run([*loads, ("COMPARE", MORE)], operands) != "zero"
        return "01" if less else "ff" if more else "00"
    return _run([*loads, (OPERATIONS[operation], 0)], operands)


def _run(steps: list[tuple[str, int]], operands: list[real.Number], text: str = "") -> str:
    code = np.array([*((CODES[name], k) for name, k in steps), (CODES["END"], 0)], np.int32)
    constants = kernel.real_array(*operands)
    source = kernel.Source(code.ctypes.data, ctypes.addressof(constants), b"", None)
    stack = (kernel.Real * 16)()
    field = ctypes.create_string_buffer(kernel.FIELD)
    texts = (ctypes.c_char_p * 1)(text.encode("ascii") + b"\n")
    error = kernel.compiled_library().applesoft_steps(ctypes.byref(source), texts, stack, field)
    if error:
        return f"E{error}"
    if steps[-1][0] == "PRINT":
        return field.value.decode("ascii")
    e, m, s = stack[0].e, stack[0].m, stack[0].s
    if not e:
        return "zero"
    return f"{real.to_stored((e, m, s)).hex()}:{e:02x}{m >> 8:08x}{s}:{m & 0xFF:02x}"
