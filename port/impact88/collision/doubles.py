"""Decimal text to double precision: the one place where a text becomes a float.

What is a number is INPUT's rule (`applesoft.decimaltext.scan`): blanks anywhere, a lone sign, a
lone point and a bare E count as zeros, letters in either case. Its value is the double nearest to
the decimal.
"""

from collections.abc import Mapping, Sequence

from ..applesoft import decimaltext

_PLAIN = frozenset("0123456789+-.eE")
"""Characters of which Python's float makes a number only where INPUT makes the same one."""
BARE = _PLAIN | {" "}
"""Characters of a number without a unit."""


def read(text: str, start: int = 0) -> tuple[float, int]:
    """The number that begins at ``start`` and where it ends, as `decimaltext.read` does it for
    reals; infinite past the range of doubles. No number at all reads as zero."""
    numeral = decimaltext.scan(text.upper(), start)
    sign, whole, decimals, exponent_sign, exponent_digits, end = numeral
    exponent = exponent_sign + (exponent_digits or "0")
    value = float(f"{whole or '0'}.{decimals or '0'}E{exponent}")
    return (-value if sign == "-" else value), end


def is_number(text: str) -> bool:
    """Whether INPUT takes the whole of ``text`` for one number."""
    return decimaltext.is_number(text.upper())


def double(text: str) -> float:
    """The double that the whole of ``text`` is; infinite past the range of doubles. Raises
    ValueError for a text that INPUT would not take for one number."""
    if _PLAIN.issuperset(text):
        try:
            return float(text)
        except ValueError:
            pass
    if not is_number(text):
        raise ValueError(f"{text!r} is not a number")
    return read(text)[0]


def doubles_of(texts: Mapping[str, str]) -> dict[str, float]:
    """`double` of each text, by name."""
    return {name: double(text) for name, text in texts.items()}


def doubles(texts: Sequence[str]) -> list[float]:
    """`double` of each of many texts. Raises ValueError if any is not a number, TypeError if any is
    not text."""
    if _PLAIN.issuperset("".join(texts)):
        try:
            return list(map(float, texts))
        except ValueError:
            pass
    return list(map(double, texts))


def digits(value: float) -> str:
    """The fewest digits that read back to a float, as INPUT takes them."""
    return repr(value).removesuffix(".0").upper()
