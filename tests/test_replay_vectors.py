"""The captured arithmetic vectors through the array engine: every value bit for bit, with the raw
mantissa and extension before rounding, and every error code."""

from __future__ import annotations

import operator
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import captures
from impact88.applesoft.decimaltext import scan
from impact88.replay import polynomials, textcolumns
from impact88.replay.reals import Reals, compare, floor, from_floats
from impact88.replay.unit import Unit

pytestmark = [pytest.mark.captures, pytest.mark.usefixtures("both_machines")]

BINARY: dict[str, Callable[[Reals, Reals], Reals]] = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "pow": polynomials.power,
}
UNARY: dict[str, Callable[[Reals], Reals]] = {
    "neg": operator.neg,
    "abs": abs,
    "sgn": polynomials.sgn,
    "int": floor,
    "sqr": polynomials.sqr,
    "exp": polynomials.exp,
    "log": polynomials.log,
    "sin": polynomials.sin,
    "cos": polynomials.cos,
    "tan": polynomials.tan,
    "atn": polynomials.atn,
}


def values(stored: list[str], extensions: list[str], unit: Unit) -> Reals:
    """Operands from stored bytes and extension bytes, in hexadecimal, independently of the engine's
    own reader of stored reals."""
    v = []
    for text, extension in zip(stored, extensions, strict=True):
        e, mantissa = int(text[:2], 16), int(text[2:], 16)
        size = ((mantissa | 0x80000000) << 8 | int(extension or "0", 16)) * 2.0 ** (e - 168)
        v.append(0.0 if e == 0 else -size if mantissa >> 31 else size)
    return from_floats(np.array(v), unit, not any(int(x or "0", 16) for x in extensions))


def shown(result: Reals, unit: Unit) -> list[str]:
    """Results as the files write them, the sign byte cut to its top bit; "zero" for any zero."""
    packed = result.packed()  # rounds, and so may overflow
    mantissas = (result.bits & (1 << 52) - 1 | 1 << 52) >> 13
    exponents = (result.bits >> 52 & 0x7FF) - 894
    return [
        f"E{code}"
        if code
        else "zero"
        if v == 0
        else f"{stored:010x}:{e:02x}{m >> 8:08x}{0x80 if v < 0 else 0:02x}:{m & 0xFF:02x}"
        for code, v, stored, e, m in zip(
            unit.code().tolist(),
            result.v.tolist(),
            packed.tolist(),
            exponents.tolist(),
            mantissas.tolist(),
            strict=True,
        )
    ]


def expected(text: str) -> str:
    """A result of the files likewise: a zero is zero whatever its other bytes, and of the sign byte
    only the top bit is a sign."""
    if text.startswith("E"):
        return text
    stored, raw, extension = text.split(":")
    if raw.startswith("00"):
        return "zero"
    return f"{stored}:{raw[:-2]}{int(raw[-2:], 16) & 0x80:02x}:{extension}"


def rows(path: Path) -> tuple[list[str], list[str], list[str], list[str]]:
    columns = list(zip(*captures.vectors(path), strict=True))
    return list(columns[1]), list(columns[2]), list(columns[3]), list(columns[4])


def test_a_zero_does_not_look_at_its_power() -> None:
    """FF7FFFFFFF with an extension of 80 overflows when rounded; to the power of it, 0 is 0."""
    unit = Unit(2)
    base = values(["0000000000", "8100000000"], ["00", "00"], unit)
    result = polynomials.power(base, values(["ff7fffffff"] * 2, ["80"] * 2, unit))
    assert result.v[0] == 0
    assert unit.code().tolist() == [0, 69]


@pytest.mark.parametrize("path", captures.arithmetic_files(), ids=captures.vector_file_id)
def test_vectors(path: Path) -> None:
    name = path.name.split(".")[0]
    first, second, extensions, results = rows(path)
    unit = Unit(len(first))
    none = ["00"] * len(first)
    if name in BINARY:
        left = values(first, none, unit)
        result = BINARY[name](left, values(second, extensions, unit))
    elif name in UNARY:
        result = UNARY[name](values(first, extensions, unit))
    elif name == "cmp":
        order = compare(values(first, none, unit), values(second, extensions, unit))
        assert [f"{int(x) & 0xFF:02x}" for x in order] == results
        return
    elif name == "fout":
        written = textcolumns.write(values(first, extensions, unit)).tolist()
        codes = unit.code().tolist()
        assert [f"E{e}" if e else text for e, text in zip(codes, written, strict=True)] == results
        return
    elif name == "fin":
        # the engine takes whole texts only; where a number ends inside one is the scanner's affair
        numbers = [text[: scan(text)[-1]].strip() or "0" for text in first]
        result = textcolumns.read(numbers, unit, str)
    else:
        pytest.fail(f"no array operation for {name}")
    got = shown(result, unit)
    wrong = [
        (a, b, x, e, g)
        for a, b, x, e, g in zip(first, second, extensions, results, got, strict=True)
        if expected(e) != g
    ]
    assert not wrong, (len(wrong), wrong[:5])
