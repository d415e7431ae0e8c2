"""Decimal text and numbers: the one rule for which texts are numbers, and their exact values.

A text is a number if Applesoft's INPUT reads all of it as one: blanks are allowed anywhere, a lone
sign, point or E counts as zero, and E may be in either case. How the 1988 program rounds it is the
business of `apple.applesoft.decimaltext`; here its value becomes a double or an exact fraction.
"""

from fractions import Fraction

from .apple.applesoft import decimaltext

MAX_EXPONENT = 400
"""Largest power of ten that `exact` expands: beyond doubles (1E308), short of exhausting memory."""
_PLAIN = frozenset("0123456789+-.eE")
"""Python's float and INPUT accept the same texts of these characters, with the same value."""


def is_number(text: str) -> bool:
    """Return True if INPUT reads the whole of ``text`` as one number.

    Examples
    --------
    >>> [is_number(text) for text in ("1 234.5", "-", "1E5", "1,5", "")]
    [True, True, True, False, False]
    """
    return decimaltext.is_number(text.upper())


def to_double(text: str) -> float:
    """Return the double nearest to a decimal text.

    Parameters
    ----------
    text : str
        A number as typed at INPUT.

    Returns
    -------
    float
        Infinite beyond the range of doubles.

    Raises
    ------
    ValueError
        If ``text`` is not a number.

    Examples
    --------
    >>> to_double("1 234.5e-1")
    123.45
    """
    if _PLAIN.issuperset(text):
        try:
            return float(text)
        except ValueError:
            pass
    return float(_numeral(text))


def to_text(value: float) -> str:
    """Return the shortest decimal text, as Applesoft takes it, that reads back as ``value``.

    Examples
    --------
    >>> to_text(25.0), to_text(1e-7)
    ('25', '1E-07')
    """
    return repr(value).removesuffix(".0").upper()


def exact(text: str) -> Fraction:
    """Return the exact value of a decimal text.

    Parameters
    ----------
    text : str
        A number as typed at INPUT.

    Returns
    -------
    Fraction

    Raises
    ------
    ValueError
        If ``text`` is not a number, or its exponent is larger than `MAX_EXPONENT`.

    Examples
    --------
    >>> exact("2.5E-1")
    Fraction(1, 4)
    """
    numeral = _numeral(text)
    exponent = numeral.partition("E")[2]
    if abs(int(exponent)) > MAX_EXPONENT:
        raise ValueError(f"{text!r} is beyond the range of numbers")
    return Fraction(numeral)


def negated(text: str) -> str:
    """Return a number's text with the other sign.

    Examples
    --------
    >>> negated("-2.50"), negated("+3")
    ('2.50', '-3')
    """
    digits = text.strip()
    return digits[1:].lstrip() or "0" if digits.startswith("-") else "-" + digits.removeprefix("+")


def _numeral(text: str) -> str:
    """Return a number's text in the form that float and Fraction accept, with an exponent."""
    if not is_number(text):
        raise ValueError(f"{text!r} is not a number")
    sign, integer, decimals, exponent_sign, exponent, _ = decimaltext.scan(text.upper())
    return f"{sign}{integer or '0'}.{decimals or '0'}E{exponent_sign}{exponent or '0'}"
