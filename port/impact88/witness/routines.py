"""Single calls of the ROM's arithmetic, by the entry points published for machine-code programs:
John Crossley, "Applesoft Internal Entry Points" (Apple Orchard, March 1980)."""

from .apple import Apple

FAC, FAC_SIGN, FAC_EXTENSION = 0x9D, 0xA2, 0xAC
"""The accumulator: exponent, four mantissa bytes; its sign byte; the eight bits below."""
TEXT_POINTER, CHRGOT, LOAD_ARGUMENT, STORE_ROUNDED = 0xB8, 0xB7, 0xE9E3, 0xEB2B
ERROR = 0xD412
"""Where every error goes, with its code in X."""

WITH_MEMORY = {"add": 0xE7BE, "sub": 0xE7A7, "mul": 0xE97F, "div": 0xEA66, "cmp": 0xEBB2}
"""Memory and accumulator: the first operand is the one in memory."""
POWER = 0xEE97
"""Argument to the power of the accumulator."""
OF_ACCUMULATOR = {
    **{"neg": 0xEED0, "abs": 0xEBAF, "sgn": 0xEB90, "int": 0xEC23, "sqr": 0xEE8D, "exp": 0xEF09},
    **{"log": 0xE941, "sin": 0xEFF1, "cos": 0xEFEA, "tan": 0xF03A, "atn": 0xF09E, "fout": 0xED34},
}
READ_NUMBER = 0xEC4A

_OPERAND, _STUB, _BACK, _BUFFER = 0x0300, 0x0310, 0x0340, 0x0200
"""Page 3 is the user's; a number to be read stands in the input buffer."""
_LDA, _LDY, _LDX, _LDA_ZERO, _JSR, _JMP = 0xA9, 0xA0, 0xA2, 0xA5, 0x20, 0x4C
"""Opcodes; the first three take the number behind them."""


def call(apple: Apple, operation: str, first: str, second: str, extension: str) -> str:
    """The result of a call in the captures' form: ``stored:raw:extension``, ``E`` and an error's
    code, the answer of a comparison, or the text written. The arguments are a captured row's."""
    operand = [_LDA, _OPERAND & 0xFF, _LDY, _OPERAND >> 8]
    if operation == "fin":
        _put(apple, _BUFFER, first.encode("ascii") + b"\0")
        _put(apple, TEXT_POINTER, _BUFFER.to_bytes(2, "little"))
        code = [*_jsr(CHRGOT), *_jsr(READ_NUMBER)]
    else:
        accumulator = bytes.fromhex(second or first)
        _put(apple, FAC, bytes([accumulator[0], accumulator[1] | 0x80, *accumulator[2:]]))
        _put(apple, FAC_SIGN, accumulator[1:2])
        _put(apple, FAC_EXTENSION, bytes.fromhex(extension))
        _put(apple, _OPERAND, bytes.fromhex(first))
        if operation in WITH_MEMORY:
            code = [*operand, *_jsr(WITH_MEMORY[operation])]
        elif operation == "pow":  # A and the flags must show the accumulator's exponent
            code = [*operand, *_jsr(LOAD_ARGUMENT), _LDA_ZERO, FAC, *_jsr(POWER)]
        else:
            code = _jsr(OF_ACCUMULATOR[operation])
    error = _execute(apple, code)
    if error:
        return error
    if operation == "cmp":
        return f"{apple.cpu.a:02x}"
    if operation == "fout":
        start = apple.cpu.a + 256 * apple.cpu.y
        return bytes(apple.memory[start : start + 20]).partition(b"\0")[0].decode("ascii")
    raw = bytes(apple.memory[FAC : FAC_SIGN + 1]).hex()
    low = f"{apple.memory[FAC_EXTENSION]:02x}"
    error = _execute(apple, [_LDX, *operand[1:], *_jsr(STORE_ROUNDED)])
    return error or f"{bytes(apple.memory[_OPERAND : _OPERAND + 5]).hex()}:{raw}:{low}"


def _jsr(address: int) -> list[int]:
    return [_JSR, address & 0xFF, address >> 8]


def _put(apple: Apple, address: int, data: bytes) -> None:
    for place, byte in enumerate(data, address):
        apple.memory[place] = byte


def _execute(apple: Apple, code: list[int]) -> str:
    """Run machine code; the error it ended in, in the captures' form."""
    _put(apple, _STUB, bytes([*code, _JMP, _BACK & 0xFF, _BACK >> 8]))
    apple.cpu.sp = 0xF8
    return f"E{apple.cpu.x}" if apple.call(_STUB, (_BACK, ERROR)) == ERROR else ""
