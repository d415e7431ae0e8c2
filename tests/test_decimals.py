"""Decimal text to doubles and fractions, against Applesoft's own rule of what a number is."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from impact88 import decimals
from impact88.apple.applesoft import decimaltext

NUMERALS = st.text("0123456789.eE+- ", max_size=14)


@given(NUMERALS)
def test_numbers_are_the_texts_that_input_reads(text: str) -> None:
    if not decimaltext.is_number(text.upper()):
        with pytest.raises(ValueError, match="is not a number"):
            decimals.to_double(text)
        return
    value = decimals.to_double(text)
    try:
        fraction = decimals.exact(text)
    except ValueError:
        assert abs(int(text.upper().replace(" ", "").partition("E")[2])) > decimals.MAX_EXPONENT
        return
    try:
        assert float(fraction) == value
    except OverflowError:
        assert math.isinf(value)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_shortest_text_reads_back_exactly(value: float) -> None:
    assert decimals.to_double(decimals.to_text(value)) == value


def test_exact_keeps_every_digit_and_refuses_huge_exponents() -> None:
    assert decimals.exact("0.1") == Fraction(1, 10)
    assert decimals.exact(f"1E{decimals.MAX_EXPONENT}") == 10**decimals.MAX_EXPONENT
    with pytest.raises(ValueError, match="beyond the range"):
        decimals.exact("1E-999999999")


@given(NUMERALS.filter(decimaltext.is_number))
def test_negated_text_has_the_negated_value(text: str) -> None:
    assert decimals.to_double(decimals.negated(text)) == -decimals.to_double(text)
