"""What the reference needs of mpmath, on Python's own decimal: for where mpmath is not installed.

The names and meanings are mpmath's. Numbers are `decimal.Decimal`, rounded to the digits of the
innermost `workdps`; sine and cosine come from their series after the angle is reduced.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from decimal import Decimal, InvalidOperation, getcontext, localcontext
from functools import cache

mpf = Decimal
_EXPONENTS = 999_999
_MORE = 10
"""Digits beside those asked for while a series is summed."""


@contextmanager
def workdps(digits: int) -> Iterator[None]:
    """Arithmetic of so many digits. Raises ZeroDivisionError for what has no value, such as 0/0."""
    with localcontext() as context:
        context.prec = digits
        context.Emax, context.Emin = _EXPONENTS, -_EXPONENTS
        try:
            yield
        except InvalidOperation as error:
            raise ZeroDivisionError(str(error)) from None


class _Precision:
    """mpmath's context, as far as ``mp.dps`` goes."""

    @property
    def dps(self) -> int:
        """The digits of the innermost `workdps`."""
        return getcontext().prec


mp = _Precision()


def fsum(terms: Iterable[Decimal]) -> Decimal:
    """The sum of some numbers."""
    return sum(terms, Decimal(0))


def isfinite(x: Decimal) -> bool:
    """Whether a number is neither infinite nor none."""
    return x.is_finite()


def isinf(x: Decimal) -> bool:
    """Whether a number is infinite."""
    return x.is_infinite()


def log10(x: Decimal) -> Decimal:
    """The decimal logarithm."""
    return x.log10()


def hypot(x: Decimal, y: Decimal) -> Decimal:
    """The length of a vector."""
    return (x * x + y * y).sqrt()


def sinpi(x: Decimal) -> Decimal:
    """sin(pi x), exact where it is 0, 1 or -1."""
    with localcontext() as context:
        # the remainder is exact: it has no more digits than the number
        context.prec = max(context.prec, len(x.as_tuple().digits) + abs(x.adjusted())) + _MORE
        turn = x % 2
        quarter = int((turn * 2).to_integral_value())
        rest = turn - Decimal(quarter) / 2
        angle = rest * _pi(context.prec)
        pair = (_sine(angle), _cosine(angle))[quarter % 2]
    return +(-pair if quarter % 4 in (2, 3) else pair)


def cospi(x: Decimal) -> Decimal:
    """cos(pi x), exact where it is 0, 1 or -1."""
    with localcontext() as context:
        context.prec += len(x.as_tuple().digits) + abs(x.adjusted())
        shifted = x + Decimal("0.5")
    return sinpi(shifted)


def sin(x: Decimal) -> Decimal:
    """The sine of an angle in radians."""
    return sinpi(_in_pis(x))


def cos(x: Decimal) -> Decimal:
    """The cosine of an angle in radians."""
    return cospi(_in_pis(x))


def _in_pis(x: Decimal) -> Decimal:
    with localcontext() as context:
        context.prec += _MORE + max(x.adjusted(), 0)
        return x / _pi(context.prec)


def _sine(x: Decimal) -> Decimal:
    return _series(x, x, 1)


def _cosine(x: Decimal) -> Decimal:
    return _series(x, Decimal(1), 0)


def _series(x: Decimal, term: Decimal, last: int) -> Decimal:
    """The sum of a term, and of those after it, each -x² / ((n + 1)(n + 2)) of the one before."""
    total, before, n, square = term, None, last, x * x
    while total != before:
        before = total
        term *= -square / ((n + 1) * (n + 2))
        n += 2
        total += term
    return total


@cache
def _pi(digits: int) -> Decimal:
    """Pi, by Machin's formula."""
    with localcontext() as context:
        context.prec = digits + _MORE
        quarter = 4 * _arc_cotangent(5) - _arc_cotangent(239)
        return 4 * quarter


def _arc_cotangent(n: int) -> Decimal:
    power = Decimal(1) / n
    total, before, k = power, None, 1
    while total != before:
        before = total
        power /= -n * n
        k += 2
        total += power / k
    return total


def nstr(x: Decimal, digits: int) -> str:
    """A number with so many digits, as mpmath writes it: without trailing zeros but the first, with
    an exponent where there would be more than ten zeros in front, or more digits than asked for."""
    with localcontext() as context:
        context.prec = digits
        rounded = +x
    sign = "-" if rounded.is_signed() else ""
    text = "".join(map(str, rounded.as_tuple().digits)).lstrip("0") or "0"
    power = rounded.adjusted() if rounded else 0
    if not -max(digits // 3, 5) < power < digits:
        text = text.rstrip("0") or "0"
        return f"{sign}{text[0]}.{text[1:] or '0'}e{power:+d}"
    if power < 0:
        text, whole = "0" * (-power - 1) + text, "0"
    else:
        text = text.ljust(power + 1, "0")
        whole, text = text[: power + 1], text[power + 1 :]
    return f"{sign}{whole}.{text.rstrip('0') or '0'}"
