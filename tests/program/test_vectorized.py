"""The captured arithmetic vectors through the array engine: every value bit for bit, with the raw
mantissa and extension before rounding, and every error code."""

from __future__ import annotations

import operator
from collections.abc import Callable
from pathlib import Path

import captures
import numpy as np
import pytest

from impact88.apple.applesoft.decimaltext import scan
from impact88.mechanics import native
from impact88.program.vectorized import compiled, polynomials, textcolumns
from impact88.program.vectorized.blockerrors import BlockErrors
from impact88.program.vectorized.reals import Reals, compare, constant, from_floats

pytestmark = pytest.mark.captures

ONE = constant(1)
BINARY: dict[str, Callable[[Reals, Reals], Reals]] = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
}
UNARY: dict[str, Callable[[Reals], Reals]] = {
    "neg": operator.neg,
    "abs": abs,
    "int": lambda x: x.floor(),
    "exp": polynomials.exp,
    "log": polynomials.log,
    "sin": polynomials.sin,
    "cos": polynomials.cos,
}


def values(stored: list[str], extensions: list[str], errors: BlockErrors) -> Reals:
    """Operands from stored bytes and extension bytes, in hexadecimal, independently of the engine's
    own reader of stored reals."""
    v = []
    for text, extension in zip(stored, extensions, strict=True):
        e, mantissa = int(text[:2], 16), int(text[2:], 16)
        size = ((mantissa | 0x80000000) << 8 | int(extension or "0", 16)) * 2.0 ** (e - 168)
        v.append(0.0 if e == 0 else -size if mantissa >> 31 else size)
    return from_floats(np.array(v), errors, not any(int(x or "0", 16) for x in extensions))


def shown(result: Reals, errors: BlockErrors) -> list[str]:
    """Results as the files write them, the sign byte cut to its top bit; "zero" for any zero."""
    packed = result.pack()  # rounds, and so may overflow
    mantissas = (result.bits & (1 << 52) - 1 | 1 << 52) >> 13
    exponents = (result.bits >> 52 & 0x7FF) - 894
    return [
        f"E{code}"
        if code
        else "zero"
        if v == 0
        else f"{stored:010x}:{e:02x}{m >> 8:08x}{0x80 if v < 0 else 0:02x}:{m & 0xFF:02x}"
        for code, v, stored, e, m in zip(
            errors.code().tolist(),
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


def by_machine(operation: Callable[..., Reals], operands: list[Reals]) -> tuple[Reals, list[bool]]:
    """The operation as a program of the compiled machine, and which results it leaves to others."""
    names = ("left", "right")[: len(operands)]
    program = compiled.trace(
        lambda _, given: {"result": operation(*given.values())}, names, frozenset(names)
    )
    columns = {name: operand.v for name, operand in zip(names, operands, strict=True)}
    results, odd = compiled.run_program(program, columns, operands[0].v.size)
    return from_floats(results["result"], BlockErrors(odd.size)), odd.tolist()


FILES = [
    path
    for path in captures.arithmetic_files()
    if path.name.split(".")[0] in {*BINARY, *UNARY, "pow", "cmp", "fin", "fout"}
]


@pytest.mark.parametrize("path", FILES, ids=captures.vector_file_id)
def test_vectors(path: Path, both_machines: None) -> None:
    name = path.name.split(".")[0]
    first, second, extensions, results = rows(path)
    if name == "pow":  # the listing has squares only
        some = [i for i, two in enumerate(second) if two == "8200000000" and extensions[i] == "00"]
        first, results = [first[i] for i in some], [results[i] for i in some]
        extensions = ["00"] * len(some)
    errors = BlockErrors(len(first))
    none = ["00"] * len(first)
    if name == "cmp":
        left, right = values(first, none, errors), values(second, extensions, errors)
        order = compare(left, right)
        assert [f"{int(x) & 0xFF:02x}" for x in order] == results
        if native.library is not None:
            below, odd = by_machine(lambda a, b: compiled.SymbolicReals(a < b, None), [left, right])
            less = [result == "01" for result in results]
            wrong = zip(below.v.tolist(), less, odd, strict=True)
            assert all(odd or got == expected for got, expected, odd in wrong)
        return
    if name == "fout":
        written = textcolumns.write(values(first, extensions, errors)).tolist()
        codes = errors.code().tolist()
        assert [f"E{e}" if e else text for e, text in zip(codes, written, strict=True)] == results
        return
    if name == "fin":
        # the engine takes whole texts only; where a number ends inside one is the scanner's affair
        numbers = [text[: scan(text)[-1]].strip() or "0" for text in first]
        result, odd = textcolumns.read(numbers, errors, str), [False] * len(first)
    else:
        operands = [values(first, none if name in BINARY else extensions, errors)]
        if name in BINARY:
            operands.append(values(second, extensions, errors))
        operation = BINARY.get(name) or UNARY.get(name, polynomials.square)
        if native.library is None:
            result, odd = operation(*operands), [False] * len(first)
        else:
            result, odd = by_machine(operation, operands)
    wrong = [
        (a, b, x, e, g)
        for a, b, x, e, g, left in zip(
            first, second, extensions, results, shown(result, errors), odd, strict=False
        )
        if expected(e) != g and not left
    ]
    assert not wrong, (len(wrong), wrong[:5])
