"""Every captured call of the ROM's arithmetic, bit for bit: stored, raw and extension."""

from __future__ import annotations

from collections.abc import Callable

import pytest

import captures
from impact88.applesoft import decimaltext, functions, real
from impact88.applesoft.errors import ApplesoftError

BINARY: dict[str, Callable[..., real.Number]] = {
    "add": real.add,
    "sub": real.subtract,
    "mul": real.multiply,
    "div": real.divide,
    "pow": functions.power,
}
UNARY: dict[str, Callable[[real.Number], real.Number]] = {
    "neg": real.negate,
    "abs": real.absolute,
    "sgn": functions.sign,
    "int": real.floor,
    "sqr": functions.square_root,
    "exp": functions.exponential,
    "log": functions.logarithm,
    "sin": functions.sine,
    "cos": functions.cosine,
    "tan": functions.tangent,
    "atn": functions.arc_tangent,
}


def shown(x: real.Number) -> str:
    """A result as the captures write it; all zeros alike."""
    e, m, s = x
    if not e:
        return "zero"
    return f"{real.to_stored(x).hex()}:{e:02x}{m >> 8:08x}{'-' if s else '+'}:{m & 0xFF:02x}"


def expected(result: str) -> str:
    """The captured result in the form of `shown`; the raw sign is the top bit of its byte."""
    if result.count(":") != 2:
        return result
    stored, raw, extension = result.split(":")
    if raw.startswith("00"):
        return "zero"
    return f"{stored}:{raw[:10]}{'-' if int(raw[10:], 16) >> 7 else '+'}:{extension}"


def computed(operation: str, first: str, second: str, extension: str) -> str:
    """What this implementation makes of a captured call."""
    low = int(extension or "0", 16)
    try:
        if operation == "fin":
            return shown(decimaltext.read(first)[0])
        x = real.from_stored(first, 0 if second else low)
        if operation == "fout":
            return decimaltext.write(x)
        if operation == "cmp":
            order = real.compare(x, real.from_stored(second, low))
            return {1: "01", 0: "00", -1: "ff"}[order]
        if operation in BINARY:
            return shown(BINARY[operation](x, real.from_stored(second, low)))
        return shown(UNARY[operation](x))
    except ApplesoftError as error:
        return f"E{error.code}"


@pytest.mark.captures
@pytest.mark.parametrize("path", captures.arithmetic_files(), ids=lambda path: path.name)
def test_every_vector(path):
    checked = 0
    wrong = []
    for operation, first, second, extension, result in captures.vectors(path):
        checked += 1
        got = computed(operation, first, second, extension)
        if got != expected(result):
            wrong.append((operation, first, second, extension, result, got))
    assert checked
    assert not wrong, f"{len(wrong)} of {checked}, first {wrong[0]}"


@pytest.mark.captures
def test_a_changed_digit_is_seen():
    for path in captures.arithmetic_files():
        *call, result = next(row for row in captures.vectors(path) if expected(row[-1]) != "zero")
        other = result[:-1] + ("1" if result[-1] != "1" else "2")
        assert computed(*call) != expected(other)
