"""Hard operands by construction through both texts of the arithmetic: the array engine and the
scalar one must agree bit for bit, error for error.

Mantissas at edges, with zero bytes in every pattern, all ones, one unit apart; extensions that do
and do not round; exponents equal, one apart, a mantissa's length apart, and at both ends.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Callable

import numpy as np
import pytest

from impact88.apple.applesoft import decimaltext as scalar_text
from impact88.apple.applesoft import functions as scalar_functions
from impact88.apple.applesoft import real
from impact88.apple.applesoft.errorcodes import ApplesoftError
from impact88.apple.applesoft.real import Number
from impact88.program.vectorized import polynomials, textcolumns
from impact88.program.vectorized.blockerrors import BlockErrors
from impact88.program.vectorized.reals import Reals, compare, from_floats

BYTES = (0x00, 0x01, 0x7F, 0x80, 0xFE, 0xFF)
EXPONENTS = (
    1,
    2,
    40,
    64,
    65,
    89,
    96,
    97,
    127,
    128,
    129,
    130,
    135,
    136,
    160,
    161,
    168,
    192,
    254,
    255,
)


def numbers(count: int, seed: int, extended: bool) -> list[Number]:
    """Operands as triples: patterns of awkward bytes, a few random ones among them."""
    choose = random.Random(seed)
    made = []
    for _ in range(count):
        parts = [
            choose.choice(BYTES) if choose.random() < 0.8 else choose.randrange(256) for _ in "1234"
        ]
        extension = choose.choice((0, 0, 1, 0x7F, 0x80, 0xFF)) if extended else 0
        m = int.from_bytes((parts[0] | 0x80, *parts[1:], extension), "big")
        e = choose.choice(EXPONENTS) if choose.random() < 0.7 else choose.randint(120, 140)
        made.append((e, m, choose.randrange(2)) if choose.random() < 0.97 else real.ZERO)
    return made


def neighbours(numbers: list[Number], seed: int) -> list[Number]:
    """For each operand one that nearly cancels, or doubles, it."""
    choose = random.Random(seed)
    made = []
    for e, m, s in numbers:
        if not e:
            made.append((e, m, s))
            continue
        m += choose.choice((0, 0, 1, -1, 0x80, -0x80, 0x100, -0x100, 0x1000))
        m = min(max(m, real.TOP), real.LIMIT - 1)
        e = min(max(e + choose.choice((0, 0, 0, 1, -1, 2, 39, 40, -40)), 1), 255)
        made.append((e, m, choose.randrange(2)))
    return made


def as_floats(numbers: list[Number]) -> np.ndarray:
    return np.array([(-1.0) ** s * m * 2.0 ** (e - 168) if e else 0.0 for e, m, s in numbers])


def outcome(operation: Callable[..., Number], *operands: Number) -> float | str:
    try:
        e, m, s = operation(*operands)
    except ApplesoftError as error:
        return error.kind
    return (-1.0) ** s * m * 2.0 ** (e - 168) if e else 0.0


KIND = {0: "", 53: "ILLEGAL QUANTITY", 69: "OVERFLOW", 133: "DIVISION BY ZERO"}


def outcomes(result: Reals, errors: BlockErrors) -> list[float | str]:
    pairs = zip(
        errors.code().tolist(), np.broadcast_to(result.v, errors.count).tolist(), strict=True
    )
    return [KIND[code] or value for code, value in pairs]


BINARY = {
    "add": (real.add, Reals.__add__),
    "subtract": (real.subtract, Reals.__sub__),
    "multiply": (real.multiply, Reals.__mul__),
    "divide": (real.divide, Reals.__truediv__),
}
UNARY = {
    "rounded": (real.rounded, Reals.rounded),
    "floor": (real.floor, Reals.floor),
    "logarithm": (scalar_functions.logarithm, polynomials.log),
    "exponential": (scalar_functions.exponential, polynomials.exp),
    "sine": (scalar_functions.sine, polynomials.sin),
    "cosine": (scalar_functions.cosine, polynomials.cos),
    "times ten": (scalar_text.times_ten, textcolumns.times_ten),
    "over ten": (scalar_text.over_ten, textcolumns.over_ten),
}


def differing(
    operands: list[tuple[Number, ...]], expected: list[float | str], got: list[float | str]
) -> list[tuple[object, ...]]:
    return [
        (*operand, e, g) for operand, e, g in zip(operands, expected, got, strict=True) if e != g
    ]


@pytest.mark.parametrize("name", BINARY)
@pytest.mark.parametrize("near", [False, True])
@pytest.mark.parametrize("extended", [False, True])
def test_binary(name: str, near: bool, extended: bool) -> None:
    scalar, array = BINARY[name]
    left = numbers(3000, 1, extended)
    right = neighbours(left, 2) if near else numbers(3000, 3, extended)
    if not extended:
        right = [(e, m & ~0xFF, s) for e, m, s in right]
    errors = BlockErrors(len(left))
    stored = not extended
    result = array(
        from_floats(as_floats(left), errors, stored), from_floats(as_floats(right), errors, stored)
    )
    pairs = list(zip(left, right, strict=True))
    expected = [outcome(scalar, *pair) for pair in pairs]
    wrong = differing(pairs, expected, outcomes(result, errors))
    assert not wrong, (len(wrong), wrong[:5])


@pytest.mark.parametrize("name", UNARY)
def test_unary(name: str) -> None:
    scalar, array = UNARY[name]
    operands = numbers(3000, 4, True)
    errors = BlockErrors(len(operands))
    result = array(from_floats(as_floats(operands), errors))
    expected = [outcome(scalar, x) for x in operands]
    wrong = differing([(x,) for x in operands], expected, outcomes(result, errors))
    assert not wrong, (len(wrong), wrong[:5])


@pytest.mark.parametrize("near", [False, True])
def test_compare(near: bool) -> None:
    stored = [(e, m & ~0xFF, s) for e, m, s in numbers(3000, 5, False)]
    right = neighbours(stored, 6) if near else numbers(3000, 7, True)
    errors = BlockErrors(len(stored))
    order = compare(
        from_floats(as_floats(stored), errors, True), from_floats(as_floats(right), errors)
    )
    assert order.tolist() == [real.compare(*pair) for pair in zip(stored, right, strict=True)]


def test_compare_rounds_without_a_carry() -> None:
    """A last byte of FF with a half unit is 256: equal to 00, above all else, and no carry."""
    pairs = [
        ((130, last << 8 | 0x80AABB << 16, s), (130, 0x80AABBFF80, s2))
        for last, s, s2 in itertools.product((0, 1, 0xFE, 0xFF), (0, 1), (0, 1))
    ]
    pairs += [((130, 0x80AABC0000, s), (130, 0x80AABBFF80, s)) for s in (0, 1)]
    errors = BlockErrors(len(pairs))
    left, right = (from_floats(as_floats(list(side)), errors) for side in zip(*pairs, strict=True))
    expected = [real.compare(*pair) for pair in pairs]
    assert compare(left, right).tolist() == expected
    assert 0 in expected


def test_shared_operands_meet_the_same_defect() -> None:
    """An operand that all scenes share, and a right one with a double zero byte."""
    left = numbers(20, 8, False)
    right = [(130, 0x8100000500 | i << 8, i % 2) for i in range(20)]
    errors = BlockErrors(20)
    for lefts, rights in ((left[:1], right), (left, right[:1])):
        result = from_floats(as_floats(lefts), errors, True) * from_floats(
            as_floats(rights), errors
        )
        expected = [outcome(real.multiply, x, y) for x in lefts for y in rights]
        assert outcomes(result, errors) == expected


@pytest.mark.usefixtures("both_machines")
def test_written_numbers() -> None:
    operands = [x for x in numbers(4000, 9, True) if 60 < x[0] < 200]
    operands += [
        (e, m + off, 0)
        for e, m in ((0x9E, 0xEE6B27FD00), (0x9B, 0xBEBC1FFD00), (0x9E, 0xEE6B280000))
        for off in range(-0x300, 0x300, 0x20)
    ]
    errors = BlockErrors(len(operands))
    written = textcolumns.write(from_floats(as_floats(operands), errors)).tolist()
    assert written == [scalar_text.write(x) for x in operands]


@pytest.mark.usefixtures("both_machines")
def test_read_numbers() -> None:
    choose = random.Random(10)
    texts = [
        "0",
        "-0",
        ".",
        "-",
        "+",
        "E",
        "1E",
        "1E-",
        "1.5.".rstrip("."),
        " 1 2 . 5 E - 3 ",
        "1e2",
    ]
    for _ in range(3000):
        digits = "".join(choose.choice("0123456789") for _ in range(choose.randint(1, 14)))
        at = choose.randint(0, len(digits))
        text = (
            choose.choice(("", "-", "+", " -"))
            + digits[:at]
            + choose.choice((".", ""))
            + digits[at:]
        )
        if choose.random() < 0.3:
            text += choose.choice("Ee") + choose.choice(("", "-", "+")) + str(choose.randint(0, 45))
        if choose.random() < 0.1:
            at = choose.randint(0, len(text))
            text = text[:at] + " " + text[at:]
        texts.append(text)
    texts += ["1E100", "1E-100", "1E999", "1E-999", "9" * 39, "9" * 38, "0" * 45 + "1", "1E039"]
    errors = BlockErrors(len(texts))
    x = textcolumns.read(texts, errors, str)
    expected = [outcome(lambda t: scalar_text.read(t.upper())[0], t) for t in texts]  # type: ignore[arg-type]
    assert not differing([(t,) for t in texts], expected, outcomes(x, errors))  # type: ignore[misc]
