"""Decimal texts to arrays of reals and back, as Applesoft reads numbers and PRINT writes them.

The scalar text of these rules is `impact88.applesoft.decimaltext`; here all numbers of a column are
read and written together, a step at a time.
"""

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from ...applesoft import decimaltext as scalar
from ...errors import UserError
from ...mechanics import native
from .reals import OVERFLOW, ZERO, Reals, compare, constant, from_number, select
from .unit import Ints, Unit

Strings = npt.NDArray[np.str_]

_TEN = constant(10)
_HALF = from_number(scalar.HALF)
_BILLION = from_number(scalar.BILLION)
_NINE_DIGITS = from_number(scalar.NINE_DIGITS)
_EIGHT_DIGITS = from_number(scalar.EIGHT_DIGITS)

_EXACT_DIGITS = 9
"""So many digits make a whole number below 2^32, which MUL10 and adding a digit leave exact."""

TEXT = np.dtype("<U15")
"""The longest field: sign, point, nine digits, exponent."""
AT_A_TIME = 32768
"""Numbers that are written together, by arrays."""

_QUARTER_LIMIT = 2.0**125
"""Four times this is exponent byte 256."""
_ROUNDS_TO_OVERFLOW = 2.0**127 - 2.0**94
"""From exponent byte 255, mantissa FFFFFFFF and extension 80 on."""


def times_ten(x: Reals) -> Reals:
    """MUL10: x rounded, as (4x + x) doubled, of which nothing is cut off. Records OVERFLOW."""
    x = x.rounded()
    failed = np.abs(x.v) >= _QUARTER_LIMIT
    if failed.any():
        x.fails(failed, OVERFLOW)
        x = select(failed, ZERO, x)
    return Reals(x.v * 10, x.unit)._settled()


def over_ten(x: Reals) -> Reals:
    """DIV10: |x| rounded, divided by ten."""
    return abs(x) / _TEN


def read(texts: Sequence[str], unit: Unit, where: Callable[[int], str]) -> Reals:
    """The numbers that texts are, extension included: as many texts as ``unit`` has scenes.

    Records OVERFLOW. Raises UserError for a text that is not a number; ``where`` names its place.
    """
    try:
        data = ("\n".join(texts) + "\n").encode("ascii")
    except (TypeError, UnicodeEncodeError):
        data = b""
    v, odd = np.zeros(len(texts)), np.ones(len(texts), np.bool_)
    if native.library is not None and data.count(b"\n") == len(texts):
        native.library.read_numbers(data, len(texts), v.ctypes.data, odd.ctypes.data)
    x, rows = Reals(v, unit), np.flatnonzero(odd)
    if rows.size:
        some = [(texts[row], row) for row in rows.tolist()]
        _treat(x, rows, lambda part: _read_together(some, part.unit or Unit(1), where))
    return x


def _read_together(
    texts: Sequence[tuple[str, int]], unit: Unit, where: Callable[[int], str]
) -> Reals:
    """`read`, of texts and their places, without the compiled machine."""
    numerals = []
    for text, place in texts:
        plain = text.replace(" ", "").upper() if isinstance(text, str) else ""
        found = scalar.NUMERAL.fullmatch(plain)
        if not plain or not found:
            raise UserError(f"{text!r} is not a number; expected decimal text", where(place))
        sign, whole, decimals, power_sign, power = found.groups("")
        exponent = min(max(int(power_sign + (power.lstrip("0")[:3] or "0")), -100), 100)
        count = (exponent - len(decimals) + 128 & 0xFF) - 128  # kept in one byte
        numerals.append((whole + decimals, count, exponent == 100, sign == "-"))
    digits, counts, overflow, negative = zip(*numerals, strict=True)
    x = Reals(np.array([int(text[:_EXACT_DIGITS] or 0) for text in digits], float), unit, True)
    for place in range(_EXACT_DIGITS, max(map(len, digits))):
        rows = np.array([row for row, text in enumerate(digits) if len(text) > place])
        digit = Reals(np.array([float(digits[i][place]) for i in rows]), None, True)
        _treat(x, rows, times_ten)
        _treat(x, rows, digit.__radd__)
    unit.fails(np.array(overflow), OVERFLOW)
    for step, steps in ((times_ten, np.array(counts)), (over_ten, -np.array(counts))):
        for finished in range(max(steps)):
            _treat(x, np.flatnonzero(steps > finished), step)
    np.negative(x.v, out=x.v, where=negative)
    return x


def _treat(x: Reals, rows: Ints, operation: Callable[[Reals], Reals]) -> None:
    """Apply an operation to some rows of ``x`` in place, recording its errors with them."""
    assert x.unit is not None
    part = x.unit.part(rows)
    result = operation(Reals(x.v[rows], part))
    x.v[rows] = result.v
    x.stored = False
    x.unit.join(part, rows)


def write(x: Reals, texts: Strings | None = None) -> Strings:
    """The characters PRINT makes of each: at most nine digits, the extension counted; into
    ``texts``, if given. Records OVERFLOW where rounding the very largest numbers fails."""
    v = np.ascontiguousarray(x.v)
    texts = np.empty(v.shape, TEXT) if texts is None else texts
    unit = x.unit or Unit(v.size)
    odd = np.ones(v.shape, np.bool_)
    if native.library is not None:
        native.library.write_numbers(v.ctypes.data, v.size, texts.ctypes.data, odd.ctypes.data)
    rows = np.flatnonzero(odd)
    for at in range(0, rows.size, AT_A_TIME):
        some = rows[at : at + AT_A_TIME]
        part = unit.part(some)
        texts.reshape(-1)[some] = _written_together(Reals(v.reshape(-1)[some], part))
        unit.join(part, some)
    return texts


def _written_together(x: Reals) -> Strings:
    """`write`, without the compiled machine: of |x| = N * 10^d the nine digits N, and d."""
    v = np.abs(x.v)
    failed = v >= _ROUNDS_TO_OVERFLOW  # when DIV10 rounds it, which it does first of all
    x.fails(failed, OVERFLOW)
    v[failed] = 0.0
    nonzero, small = v != 0, (v != 0) & (v < 1)
    unit = Unit(v.size)
    v = np.where(small, (_BILLION * Reals(v, unit)).v, v)
    d = np.where(small, -9, 0)
    while (above := (order := compare(_NINE_DIGITS, Reals(v, unit))) > 0).any():
        v = np.where(above, over_ten(Reals(v, unit)).v, v)
        d += above
    rounds = nonzero & (order != 0)
    while (below := rounds & (compare(_EIGHT_DIGITS, Reals(v, unit)) <= 0)).any():
        v = np.where(below, times_ten(Reals(v, unit)).v, v)
        d -= below
    v = np.where(rounds, (_HALF + Reals(v, unit)).v, v)
    signs = np.where(x.v < 0, "-", "").tolist()
    texts = [
        scalar.lay_out(sign, str(int(nine)), power) if nine else "0"
        for sign, nine, power in zip(signs, np.floor(v).tolist(), d.tolist(), strict=True)
    ]
    return np.where(failed, "", np.array(texts, TEXT))
