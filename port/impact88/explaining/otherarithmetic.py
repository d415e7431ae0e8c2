"""The program on other machines: single precision, decimal arithmetic, another pi.

These are hypotheses about who printed a page. Each is an `Arithmetic` for the same listing, printed
in the same layout; they need not agree with any one machine to the last digit.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import (
    ROUND_DOWN,
    ROUND_FLOOR,
    ROUND_HALF_UP,
    Context,
    Decimal,
    DecimalException,
    localcontext,
)
from functools import lru_cache
from typing import Any

from ..applesoft import decimaltext
from ..applesoft.errorcodes import ApplesoftError, division_by_zero, overflow
from ..program.arithmetics import FLOAT64, Arithmetic

PI = "3.14159265"
SINGLE_DIGITS, DECIMAL_DIGITS = 7, (10, 12, 14)
"""Digits that single-precision BASICs print; digits that decimal ones compute with."""


def _text(value: float, digits: int) -> str:
    """A number in Applesoft's layout, to so many digits."""
    if not math.isfinite(value):
        raise overflow()
    if value == 0:
        return "0"
    mantissa, exponent = f"{abs(value):.{digits - 1}E}".split("E")
    nine = mantissa.replace(".", "").ljust(9, "0")[:9]
    return decimaltext.lay_out("-" if value < 0 else "", nine, int(exponent) - 8)


class _Other(Arithmetic):
    """An arithmetic whose pi is another constant."""

    pi: Any = None

    def constant(self, text: str) -> Any:
        """A constant of the program; for pi, this machine's."""
        return self.pi if text == PI and self.pi is not None else super().constant(text)


def _error(error: Exception) -> ApplesoftError | None:
    if isinstance(error, ApplesoftError):
        return error
    if isinstance(error, (ZeroDivisionError, FloatingPointError, DecimalException)):
        return division_by_zero()
    return overflow() if isinstance(error, (OverflowError, ValueError)) else None


def _reader(make: Callable[[str], Any]) -> Callable[[str, int], tuple[Any, int]]:
    def read(text: str, start: int) -> tuple[Any, int]:
        sign, whole, decimals, exponent_sign, exponent, end = decimaltext.scan(text, start)
        number = f"{sign}{whole or '0'}.{decimals or '0'}E{exponent_sign}{exponent or '0'}"
        return make(number), end

    return read


@lru_cache(maxsize=1)
def single() -> Arithmetic:
    """24 bits, as the single-precision BASICs of other machines compute (GW-BASIC, BASICA)."""
    import numpy as np

    single_ = np.float32

    def of(function: Callable[[float], float]) -> Callable[[Any], Any]:
        return lambda x: single_(function(float(x)))

    return _Other(
        "single",
        read=_reader(single_),
        LET=single_,
        NEXT=lambda x: x + single_(1),
        INT=of(math.floor),
        ABS=abs,
        SIN=of(math.sin),
        COS=of(math.cos),
        write=lambda x: _text(float(x), SINGLE_DIGITS),
        error=_error,
        unset=single_(0),
        zero=single_(0.0),
    )


def shaken(seed: int) -> Arithmetic:
    """The same, each number that is stored moved by up to one unit of its last bit: what machines
    of 24 bits may differ in. Whole numbers stay what they are."""
    import random

    import numpy as np

    rng = random.Random(seed)
    plain = single()

    def store(x: Any) -> Any:
        value = float(x)
        if value.is_integer() or not math.isfinite(value):
            return np.float32(value)
        return np.float32(value * (1 + rng.choice((-1, 0, 1)) * 2.0**-23))

    return _Other(
        "single",
        read=plain.read,
        LET=store,
        NEXT=plain.NEXT,
        INT=plain.INT,
        ABS=plain.ABS,
        SIN=lambda x: store(plain.SIN(x)),
        COS=lambda x: store(plain.COS(x)),
        write=plain.write,
        error=plain.error,
        unset=plain.unset,
        zero=plain.zero,
    )


@lru_cache(maxsize=1)
def decimal() -> Arithmetic:
    """The decimal digits of the context, as the HP-85's and other BCD machines compute."""

    def of(function: Callable[[float], float]) -> Callable[[Any], Any]:
        return lambda x: +Decimal(repr(function(float(x))))

    made = _Other(
        "decimal",
        read=_reader(lambda text: +Decimal(text)),
        LET=lambda x: +x,
        NEXT=lambda x: x + 1,
        INT=lambda x: x.to_integral_value(rounding=ROUND_FLOOR),
        ABS=abs,
        SIN=of(math.sin),
        COS=of(math.cos),
        write=lambda x: _text(float(x), 9),
        error=_error,
        unset=Decimal("0"),
        zero=Decimal("0.0"),
    )
    return made


def with_pi(text: str) -> Arithmetic:
    """Double precision with another pi."""
    made = _Other(
        "float64",
        read=FLOAT64.read,
        LET=FLOAT64.LET,
        NEXT=FLOAT64.NEXT,
        INT=FLOAT64.INT,
        ABS=FLOAT64.ABS,
        SIN=FLOAT64.SIN,
        COS=FLOAT64.COS,
        write=FLOAT64.write,
        error=FLOAT64.error,
        unset=FLOAT64.unset,
        zero=FLOAT64.zero,
    )
    made.pi = math.pi if text == "exact" else float(text)
    return made


DECIMAL_CONTEXTS = tuple(
    Context(prec=digits, rounding=rounding)
    for digits in DECIMAL_DIGITS
    for rounding in (ROUND_HALF_UP, ROUND_DOWN)
)
"""Decimal machines: so many digits, rounded or cut off."""

__all__ = ["DECIMAL_CONTEXTS", "decimal", "localcontext", "shaken", "single", "with_pi"]
