"""Decimal text to double precision: the rule by which a bare number becomes a float. An amount with
a unit is computed exactly by `units` first; a column of Arrow's is cast where the rule allows
(`tables.rows.ArrowTexts`).

A text is a number if Applesoft's INPUT reads it as one (`applesoft.decimaltext.scan`): blanks are
allowed anywhere; a lone sign, a lone point and a bare E count as zero; E may be in either case. The
value is the double nearest to the decimal.
"""

from collections.abc import Mapping, Sequence

from ..apple.applesoft import decimaltext

_PLAIN = frozenset("0123456789+-.eE")
"""In texts of these characters alone, whatever Python's float accepts INPUT reads the same."""
BARE = _PLAIN | {" "}
"""Characters of a number without a unit."""


def read(text: str, start: int = 0) -> tuple[float, int]:
    """Return the number that begins at ``start`` and the index after it, like `decimaltext.read`.

    Infinite past the range of doubles; without any number the result is 0."""
    numeral = decimaltext.scan(text.upper(), start)
    sign, integer, decimals, exponent_sign, exponent_digits, end = numeral
    exponent = exponent_sign + (exponent_digits or "0")
    value = float(f"{integer or '0'}.{decimals or '0'}E{exponent}")
    return (-value if sign == "-" else value), end


def is_number(text: str) -> bool:
    """Return True if INPUT reads the whole of ``text`` as one number."""
    return decimaltext.is_number(text.upper())


def double(text: str) -> float:
    """Return the value of ``text``, infinite past the range of doubles. Raises ValueError if INPUT
    would not read the whole text as one number."""
    if _PLAIN.issuperset(text):
        try:
            return float(text)
        except ValueError:
            pass
    if not is_number(text):
        raise ValueError(f"{text!r} is not a number")
    return read(text)[0]


def double_or_none(text: str) -> float | None:
    """Return the number that a text is, None for another."""
    return double(text) if is_number(text) else None


def doubles_of(texts: Mapping[str, str]) -> dict[str, float]:
    """Return the `double` of each text, by name."""
    return {name: double(text) for name, text in texts.items()}


def doubles(texts: Sequence[str]) -> list[float]:
    """Return the `double` of each text, fast for many. Raises ValueError if one is not a number and
    TypeError if one is not text."""
    if _PLAIN.issuperset("".join(texts)):
        try:
            return list(map(float, texts))
        except ValueError:
            pass
    return list(map(double, texts))


def digits(value: float) -> str:
    """Return the shortest text that INPUT reads back as ``value``."""
    return repr(value).removesuffix(".0").upper()


def opposite(text: str) -> str:
    """Return a number with the other sign; it may be written with a plus sign and blanks."""
    size = text.strip()
    return size[1:] if size.startswith("-") else "-" + size.removeprefix("+")
