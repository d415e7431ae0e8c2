"""Decimal texts to arrays of reals and back, as Applesoft reads numbers and PRINT writes them.

The scalar form of these rules is `impact88.apple.applesoft.decimaltext`; here all numbers of a
column are read and written together, step by step.
"""

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from ...apple.applesoft import decimaltext as scalar
from ...errors import UserError
from ...mechanics import native
from .blockerrors import BlockErrors, Ints
from .reals import OVERFLOW, ZERO, Reals, compare, constant, from_number, select

Strings = npt.NDArray[np.str_]

_TEN = constant(10)
_HALF = from_number(scalar.HALF)
_BILLION = from_number(scalar.BILLION)
_NINE_DIGITS = from_number(scalar.NINE_DIGITS)
_EIGHT_DIGITS = from_number(scalar.EIGHT_DIGITS)

_EXACT_DIGITS = 9  # a whole number with so many digits is below 2^32, where MUL10 is exact

TEXT = np.dtype("<U15")
"""The longest field: sign, point, nine digits, exponent."""
MAX_TEXTS = 32768  # read or written at a time, or one column: bounds the memory, stays in the cache

_QUARTER_LIMIT = 2.0**125  # four times this is exponent byte 256
_ROUNDS_TO_OVERFLOW = 2.0**127 - 2.0**94  # exponent byte 255, mantissa FFFFFFFF, extension 80


def times_ten(x: Reals) -> Reals:
    """Return 10 x of x rounded: MUL10, (4x + x) doubled, which is exact. Records OVERFLOW."""
    x = x.rounded()
    overflows = np.abs(x.v) >= _QUARTER_LIMIT
    if overflows.any():
        x.record_error(overflows, OVERFLOW)
        x = select(overflows, ZERO, x)
    return Reals(x.v * 10, x.errors)._check_exponents()


def over_ten(x: Reals) -> Reals:
    """Return |x| / 10 of x rounded: DIV10."""
    return abs(x) / _TEN


def read(texts: Sequence[str], errors: BlockErrors, where: Callable[[int], str]) -> Reals:
    """Return the numbers of ``texts``, one for each scene of the block, extension included.

    Records OVERFLOW. Raises UserError for a text that is not a number; ``where`` returns the name
    of its place, given its index."""
    try:
        data = ("\n".join(texts) + "\n").encode("ascii")
    except (TypeError, UnicodeEncodeError):
        data = b""
    v, unread = np.zeros(len(texts)), np.ones(len(texts), np.bool_)
    if native.library is not None and data.count(b"\n") == len(texts):
        native.library.read_numbers(data, len(texts), v.ctypes.data, unread.ctypes.data)
    x, rows = Reals(v, errors), np.flatnonzero(unread)
    if rows.size:
        numbered_texts = [(texts[row], row) for row in rows.tolist()]
        _apply(
            x,
            rows,
            lambda part: _read_with_arrays(numbered_texts, part.errors or BlockErrors(1), where),
        )
    return x


def _read_with_arrays(
    texts: Sequence[tuple[str, int]], errors: BlockErrors, where: Callable[[int], str]
) -> Reals:
    """Return `read` of texts with their indices, without the compiled kernel."""
    numerals = []
    for text, place in texts:
        plain = text.replace(" ", "").upper() if isinstance(text, str) else ""
        match = scalar.NUMERAL.fullmatch(plain)
        if not plain or not match:
            raise UserError(f"{text!r} is not a number; expected decimal text", where(place))
        sign, integer, decimals, power_sign, power = match.groups("")
        exponent = min(max(int(power_sign + (power.lstrip("0")[:3] or "0")), -100), 100)
        count = (exponent - len(decimals) + 128 & 0xFF) - 128  # the ROM keeps it in one signed byte
        numerals.append((integer + decimals, count, exponent == 100, sign == "-"))
    digits, counts, overflow, negative = zip(*numerals, strict=True)
    x = Reals(np.array([int(text[:_EXACT_DIGITS] or 0) for text in digits], float), errors, True)
    for place in range(_EXACT_DIGITS, max(map(len, digits))):
        rows = np.array([row for row, text in enumerate(digits) if len(text) > place])
        digit = Reals(np.array([float(digits[i][place]) for i in rows]), None, True)
        _apply(x, rows, times_ten)
        _apply(x, rows, digit.__radd__)
    errors.record_error(np.array(overflow), OVERFLOW)
    for step, steps in ((times_ten, np.array(counts)), (over_ten, -np.array(counts))):
        for steps_done in range(max(steps)):
            _apply(x, np.flatnonzero(steps > steps_done), step)
    np.negative(x.v, out=x.v, where=negative)
    return x


def _apply(x: Reals, rows: Ints, operation: Callable[[Reals], Reals]) -> None:
    """Apply an operation to the given rows of ``x`` in place, recording its errors there."""
    assert x.errors is not None
    part = x.errors.part(rows)
    result = operation(Reals(x.v[rows], part))
    x.v[rows] = result.v
    x.stored = False
    x.errors.join(part, rows)


def write(x: Reals, texts: Strings | None = None) -> Strings:
    """Return the numbers as PRINT writes them, with at most nine digits, extension included.

    Written into ``texts``, if given. Records OVERFLOW for the very largest numbers, which the ROM
    fails to round."""
    v = np.ascontiguousarray(x.v)
    texts = np.empty(v.shape, TEXT) if texts is None else texts
    errors = x.errors or BlockErrors(v.size)
    unwritten = np.ones(v.shape, np.bool_)
    if native.library is not None:
        native.library.write_numbers(
            v.ctypes.data, v.size, texts.ctypes.data, unwritten.ctypes.data
        )
    rows = np.flatnonzero(unwritten)
    for at in range(0, rows.size, MAX_TEXTS):
        block = rows[at : at + MAX_TEXTS]
        part = errors.part(block)
        texts.reshape(-1)[block] = _write_with_arrays(Reals(v.reshape(-1)[block], part))
        errors.join(part, block)
    return texts


def _write_with_arrays(x: Reals) -> Strings:
    """Return `write` without the compiled kernel: find nine digits N and d of |x| = N * 10^d."""
    v = np.abs(x.v)
    overflows = v >= _ROUNDS_TO_OVERFLOW  # in DIV10, which rounds first
    x.record_error(overflows, OVERFLOW)
    v[overflows] = 0.0
    nonzero, small = v != 0, (v != 0) & (v < 1)
    errors = BlockErrors(v.size)
    v = np.where(small, (_BILLION * Reals(v, errors)).v, v)
    d = np.where(small, -9, 0)
    while (too_large := compare(_NINE_DIGITS, Reals(v, errors)) > 0).any():
        v = np.where(too_large, over_ten(Reals(v, errors)).v, v)
        d += too_large
    while (too_small := nonzero & (compare(_EIGHT_DIGITS, Reals(v, errors)) <= 0)).any():
        v = np.where(too_small, times_ten(Reals(v, errors)).v, v)
        d -= too_small
    v = np.where(nonzero, (_HALF + Reals(v, errors)).v, v)
    signs = np.where(x.v < 0, "-", "").tolist()
    texts = [
        scalar.lay_out(sign, str(int(nine)), power) if nine else "0"
        for sign, nine, power in zip(signs, np.floor(v).tolist(), d.tolist(), strict=True)
    ]
    return np.where(overflows, "", np.array(texts, TEXT))
