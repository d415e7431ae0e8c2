"""Decimal text: what is a number, and reading back what PRINT wrote."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from impact88.apple.applesoft import decimaltext, real
from impact88.apple.applesoft.errorcodes import ApplesoftError
from impact88.apple.applesoft.operators import Real

stored_numbers = st.tuples(
    st.integers(1, 255), st.integers(1 << 31, (1 << 32) - 1), st.integers(0, 1)
).map(lambda n: (n[0], n[1] << 8, n[2]))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("5.", "5"),
        (".5", ".5"),
        ("-.5", "-.5"),
        ("1.5E", "1.5"),
        ("1E-3", "1E-03"),
        (" 1 2 . 5 E 1 ", "125"),
        (".", "0"),
        ("-", "0"),
        ("00012", "12"),
        ("1E9", "1E+09"),
        ("999999999", "999999999"),
        (".01", ".01"),
        (".005", "5E-03"),
        ("1E-50", "0"),
    ],
)
def test_reading_and_writing(text, value):
    assert decimaltext.write(decimaltext.number(text)) == value


@pytest.mark.parametrize("text", ["", " ", "X", "1.2.3", "1,2", "1e5", "inf", "0x10", "1_0", "١"])
def test_what_is_no_number(text):
    assert not decimaltext.is_number(text)
    with pytest.raises(ValueError, match="not a number"):
        decimaltext.number(text)


@pytest.mark.parametrize("text", ["1E39", "1E100", "9" * 40])
def test_too_large_to_read(text):
    assert decimaltext.is_number(text)
    with pytest.raises(ApplesoftError, match="OVERFLOW"):
        decimaltext.number(text)


def test_a_number_ends_where_it_no_longer_is_one():
    assert decimaltext.read("12X", 0)[1] == 2
    assert decimaltext.read("1.2.3", 0)[1] == 3
    assert decimaltext.read("AB12", 2)[1] == 4


STEP = 2.0**-30
"""Bound on the relative error of MUL10 or DIV10: two units of 32 bits. One was exceeded near
1.88E-37, where 36 steps were off by 1.35 units on the average."""
WRITING = 41 * STEP + 0.5e-8 + 1e-9
"""Up to 39 steps bring a number to nine digits, after a multiplication by a billion and before the
addition of a half, which round as well; half a unit of the ninth; 999,999,999 is cut."""
READING = 47 * STEP
"""Nine digits are exact; up to 47 steps, for E-39 and eight decimals, make the number of them."""


@example((7, 549755842048, 0))
@given(stored_numbers)
def test_printing_is_as_accurate_as_its_steps(number):
    text = decimaltext.write(number)
    assert len(text.split("E")[0].replace(".", "").lstrip("-0")) <= 9
    exact = float(Real(number))
    if abs(exact) > 1e-37:
        assert abs(float(text) - exact) <= abs(exact) * WRITING


@given(stored_numbers)
def test_what_print_wrote_reads_back_and_prints_alike(number):
    """Not the same bits always, but no further off than reading and writing may be."""
    text = decimaltext.write(number)
    try:
        number = decimaltext.number(text)
    except ApplesoftError:
        assert text.endswith("E+38")
        return
    if real.from_stored(real.to_stored(number))[0]:
        assert abs(float(decimaltext.write(real.rounded(number))) - float(text)) <= abs(
            float(text)
        ) * (READING + WRITING) * (1 + STEP)
