"""Decimal text to real and back, as Applesoft reads constants, INPUT and VAL, and writes for PRINT.

Reading proceeds digit by digit in the machine's own arithmetic, so the digits typed matter beyond
their value: 90315.8817 and 90315.88170 differ in their last bit. Writing includes the extension of
an unstored value, so PRINT can show more than a variable holds.
"""

import re
from functools import lru_cache

from .errorcodes import overflow
from .real import (
    BIAS,
    ZERO,
    Number,
    absolute,
    add,
    compare,
    divide,
    from_stored,
    integer,
    multiply,
    negate,
    rounded,
    to_integer,
)

TEN = integer(10)
HALF = from_stored("8000000000")
BILLION = from_stored("9E6E6B2800")
NINE_DIGITS = from_stored("9E6E6B27FD")
"""999,999,999: a larger number is divided by ten before its nine digits are taken."""
EIGHT_DIGITS = from_stored("9B3EBC1FFD")
"""99,999,999.9: a number not above it is multiplied by ten."""


def times_ten(x: Number) -> Number:
    """Return 10 x of x rounded: MUL10, (4x + x) doubled. Raises OVERFLOW."""
    e, m, s = rounded(x)
    if not e:
        return ZERO
    if e + 2 > 255:
        raise overflow()
    e, m, s = add((e + 2, m, s), (e, m, s))
    if e == 255:
        raise overflow()
    return e + 1, m, s


def over_ten(x: Number) -> Number:
    """Return |x| / 10 of x rounded: DIV10."""
    return divide(absolute(x), TEN)


Numeral = tuple[str, str, str, str, str, int]
"""The parts of a number's text without blanks: sign, digits before and after the point, sign and
digits of the exponent; and the index after it."""
NUMERAL = re.compile(r" *([+-]?)([0-9 ]*)(?:\.([0-9 ]*))?(?:E *([+-]?)([0-9 ]*))?")


def scan(text: str, start: int = 0) -> Numeral:
    """Return the parts of the number that begins at ``start``, empty if there is none."""
    match = NUMERAL.match(text, start)
    assert match is not None  # the pattern also matches nothing
    sign, *numbers = (part.replace(" ", "") for part in match.groups(""))
    whole, decimals, exponent_sign, exponent = numbers
    return sign, whole, decimals, exponent_sign, exponent, start + len(match[0].rstrip(" "))


@lru_cache(maxsize=512)  # scenes and programs repeat their numbers
def read(text: str, start: int = 0) -> tuple[Number, int]:
    """FIN $EC4A: the number that begins at ``start``, zero if there is none, and the index
    after it.

    The power of ten, exponent minus decimals, is kept in one signed byte and wraps. Raises
    OVERFLOW, also for any exponent of three digits, whatever the number."""
    sign, whole, decimals, exponent_sign, exponent, end = scan(text, start)
    value = ZERO
    for digit in whole + decimals:
        value = add(times_ten(value), integer(int(digit)))
    power = int(exponent.lstrip("0")[:3] or "0")
    if power >= 100:
        if exponent_sign != "-":
            raise overflow()
        power = 100
    power = (-power if exponent_sign == "-" else power) - len(decimals)
    steps = (power + 128 & 0xFF) - 128
    for _ in range(steps):
        value = times_ten(value)
    for _ in range(-steps):
        value = over_ten(value)
    return (negate(value) if sign == "-" else value), end


def is_number(text: str) -> bool:
    """Return True if INPUT reads the whole of ``text`` as one number."""
    text = text.rstrip(" ")
    return bool(text) and scan(text)[-1] == len(text)


def number(text: str) -> Number:
    """Return the real of ``text``. Raises ValueError if it is not one number."""
    if not is_number(text):
        raise ValueError(f"{text!r} is not a number that Applesoft reads")
    return read(text)[0]


def write(x: Number) -> str:
    """FOUT $ED34: the text of ``x`` as PRINT and STR$ write it: at most nine digits, by the
    extension too."""
    if not x[0]:
        return "0"
    sign, x, d = "-" if x[2] else "", absolute(x), 0
    if x[0] <= BIAS:
        x = multiply(BILLION, x)
        d = -9
    while (order := compare(NINE_DIGITS, x)) > 0:
        x = over_ten(x)
        d += 1
    if order:
        while compare(EIGHT_DIGITS, x) <= 0:
            x = times_ten(x)
            d -= 1
        x = add(HALF, x)
    return lay_out(sign, str(to_integer(x)), d)


def lay_out(sign: str, text: str, d: int) -> str:
    """Return nine digits times ten to the power d in PRINT's layout: no leading zero before the
    point, no trailing zeros after it, with exponent below .01 and from 1E+09 on."""
    # d + 9 digits stand before the point; an exponent from 10 on, and below -1
    if 0 <= d + 10 < 11:
        point = d + 9
        text = text[:point] + "." + text[point:] if point >= 0 else ".0" + text
        exponent = ""
    else:
        text = text[0] + "." + text[1:]
        exponent = f"E{'-' if d + 8 < 0 else '+'}{abs(d + 8):02d}"
    return sign + text.rstrip("0").rstrip(".") + exponent
