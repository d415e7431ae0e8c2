"""The arithmetics the port can use: `APPLESOFT`, and `FLOAT64`, Python's float and math printed in
Applesoft's layout. Both offer the same operations to the same statements, so that any difference
between two printouts is due to the arithmetic."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from .. import decimals
from ..apple.applesoft import decimaltext, functions
from ..apple.applesoft.errorcodes import (
    ApplesoftError,
    division_by_zero,
    illegal_quantity,
    overflow,
)
from ..apple.applesoft.operators import Real
from ..apple.applesoft.real import ZERO, Number, absolute, floor

Function = Callable[[Any], Any]


class Arithmetic(NamedTuple):
    """The operations on numbers that the listing uses.

    ``read(text, start)``: the number that begins at ``start`` and the index after it; ``LET``:
    rounding of an assignment; ``NEXT``: the increment of a loop's variable; ``INT`` ... ``COS``:
    BASIC's functions; ``write``: the text PRINT shows; ``errors``: Python's exceptions and the
    Applesoft errors they stand for; ``unset``: the value of a variable never assigned, a zero that
    ``is`` distinguishes from ``zero``."""

    name: str
    read: Callable[[str, int], tuple[Any, int]]
    LET: Function
    NEXT: Function
    INT: Function
    ABS: Function
    SIN: Function
    COS: Function
    write: Callable[[Any], str]
    errors: Mapping[type[Exception], Callable[[], ApplesoftError]]
    unset: Any
    zero: Any

    def error(self, exception: Exception) -> ApplesoftError | None:
        """Return an exception as an Applesoft error; None if it is not one of this arithmetic's."""
        if isinstance(exception, ApplesoftError):
            return exception
        make_error = self.errors.get(type(exception))
        return make_error() if make_error else None

    def number(self, text: str) -> Any:
        """Return the number of a text, not yet rounded. Raises ApplesoftError OVERFLOW."""
        return self.read(text.upper(), 0)[0]


def _read_real(text: str, start: int) -> tuple[Real, int]:
    number, end = decimaltext.read(text, start)
    return Real(number), end


def _of_reals(function: Callable[[Number], Number]) -> Callable[[Real], Real]:
    """Return a function of numbers as one of `Real`."""
    return lambda x: Real(function(x.number))


def _finite(x: float) -> float:
    """Return ``x``. Raises OVERFLOW if it is not finite."""
    if not math.isfinite(x):
        raise overflow()
    return x


def _read_float(text: str, start: int) -> tuple[float, int]:
    end = decimaltext.scan(text, start)[-1]
    return _finite(decimals.to_double(text[start:end] or "0")), end


def _write_float(x: float) -> str:
    if _finite(x) == 0:
        return "0"
    mantissa, exponent = f"{abs(x):.8E}".split("E")
    return decimaltext.lay_out("-" if x < 0 else "", mantissa.replace(".", ""), int(exponent) - 8)


APPLESOFT = Arithmetic(
    name="applesoft",
    read=_read_real,
    LET=Real.rounded,
    NEXT=lambda x: (x + 1).rounded(),
    INT=_of_reals(floor),
    ABS=_of_reals(absolute),
    SIN=_of_reals(lambda x: functions.sine(x)[0]),
    COS=_of_reals(lambda x: functions.cosine(x)[0]),
    write=lambda x: decimaltext.write(x.number),
    errors={},
    unset=Real(ZERO),
    zero=Real(ZERO),
)
FLOAT64 = Arithmetic(
    name="float64",
    read=_read_float,
    LET=lambda x: x,
    NEXT=lambda x: x + 1,
    INT=lambda x: float(math.floor(_finite(x))),
    ABS=abs,
    SIN=math.sin,
    COS=math.cos,
    write=_write_float,
    errors={
        ZeroDivisionError: division_by_zero,
        OverflowError: overflow,
        ValueError: illegal_quantity,
    },
    unset=float("0"),
    zero=float("0"),
)
ARITHMETICS = {arithmetic.name: arithmetic for arithmetic in (APPLESOFT, FLOAT64)}
