"""Python's operators on a Real: what rounds when, and what is refused."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from impact88.apple.applesoft import decimaltext, functions, real
from impact88.apple.applesoft.errorcodes import CODES, ApplesoftError
from impact88.apple.applesoft.operators import Real

numbers = st.one_of(
    st.just(real.ZERO),
    st.tuples(st.integers(1, 255), st.integers(real.TOP, real.LIMIT - 1), st.integers(0, 1)),
)
middling = st.tuples(
    st.integers(100, 156), st.integers(real.TOP, real.LIMIT - 1), st.integers(0, 1)
)


def exact(number: real.Number) -> Fraction:
    return Fraction(float(Real(number)))


def of(text: str) -> Real:
    return Real(decimaltext.number(text))


def test_left_rounds_and_right_keeps_its_extension():
    third = of("1") / of("3")
    assert third.number != third.rounded().number
    assert (third + of("0")).number == third.rounded().number
    assert (of("0") + third).number == third.number


def test_storing_rounds():
    third = of("1") / of("3")
    assert third.rounded().number[1] & 0xFF == 0
    assert third.to_bytes() == third.rounded().to_bytes()


def test_the_published_floor():
    """Run 1 prints XB= 14.51 for 14.52, because the product is not stored before INT."""
    xb = of("14.52").rounded()
    assert decimaltext.write((Real(real.floor((100 * xb).number)) / 100).number) == "14.51"
    contents = (100 * xb).rounded()
    assert decimaltext.write((Real(real.floor(contents.number)) / 100).number) == "14.52"


def test_the_digits_typed_matter():
    assert of("90315.8817").to_bytes() != of("90315.88170").to_bytes()


@pytest.mark.parametrize(
    ("exponent", "left", "sign"),
    [
        ("3", 0, 1),
        ("4", 3, 0),
        ("2147483647", 0, 1),
        ("2147483646", 3, 0),
        ("2147483649", 0, 0),
        ("2147483648", 3, 1),
        ("4294967297", 0, 0),
        ("4294967297", 3, 1),
    ],
)
def test_the_sign_of_a_huge_power_hangs_on_what_int_left(exponent, left, sign):
    """INT does not look at numbers from 2^31 on; an earlier one's byte is still there."""
    minus_one, exponent = decimaltext.number("-1"), decimaltext.number(exponent)
    assert functions.power(minus_one, exponent, left)[0][2] == sign
    if not left:
        assert functions.power(minus_one, exponent)[0][2] == sign


@pytest.mark.parametrize(
    ("does", "argument", "byte"),
    [
        (functions.integer_part, "3.7", 3),
        (functions.integer_part, "-.5", 255),
        (functions.integer_part, "259", 3),
        (functions.integer_part, "2147483647", 255),
        (functions.integer_part, "2147483648", 77),
        (functions.exponential, "2", 2),
        (functions.exponential, "-87.9", 129),
        (functions.exponential, "-89", 77),
        (functions.square_root, "9", 1),
        (functions.square_root, "0", 77),
        (functions.sine, "13", 2),
        (functions.sine, "1E20", 77),
        (functions.cosine, "-1", 0),
        (functions.cosine, "-2", 255),
        (functions.tangent, "-1", 255),
    ],
)
def test_the_byte_that_int_leaves(does, argument, byte):
    """Whole turns of an angle, doublings of a power, or what was there before."""
    assert does(decimaltext.number(argument), 77)[1] == byte


def test_a_power_is_no_product():
    x = of("3")
    assert (x**2).number != (x * x).number


def test_equal_exponents_add_a_unit_of_the_extension():
    x = of("1.5").number
    e, m, _ = real.add(x, x)
    assert (e, m) == (x[0] + 1, (2 * x[1] + real.EQUAL_CARRY) >> 1)


def test_double_zero_byte_shifts_once_too_often():
    m1, m2 = 0xFFFFFFFF00, 0x8000004001
    assert real.multiply((128, m1, 0), (128, m2, 0))[1] != m1 * m2 >> 39


@pytest.mark.parametrize(
    ("expression", "kind"),
    [
        (lambda x: x / 0, "DIVISION BY ZERO"),
        (lambda x: (x - x) / 0, "DIVISION BY ZERO"),
        (lambda x: x * of("1E38") * of("10"), "OVERFLOW"),
        (lambda x: -(x ** of(".5")), None),
        (lambda x: (-x) ** of(".5"), "ILLEGAL QUANTITY"),
    ],
)
def test_errors_are_applesofts(expression, kind):
    if kind is None:
        expression(of("2"))
        return
    with pytest.raises(ApplesoftError) as caught:
        expression(of("2"))
    assert caught.value.message == f"?{kind} ERROR"
    assert caught.value.code == CODES[kind]


@pytest.mark.parametrize("other", [1.5, "2", None])
def test_only_reals_and_whole_numbers_combine(other):
    with pytest.raises(TypeError):
        of("2") * other


def test_comparisons_take_reals_only():
    with pytest.raises(TypeError):
        assert of("2") == 2
    assert of("2") == of("2.0")
    assert of("2") != of("3")
    assert of("2") < of("3") <= of("3")
    assert of("-2") > of("-3") >= of("-3")


@given(middling, middling)
def test_sum_is_near_the_exact_sum(a, b):
    """A unit of the last of 32 bits of the larger operand, in which the left one's rounding, bits
    shifted out and a sum lost in the extension are all included."""
    total = exact(real.add(a, b))
    true = exact(a) + exact(b)
    size = max(abs(exact(a)), abs(exact(b)))
    assert abs(total - true) <= size * Fraction(1, 2**31)


@given(middling, middling)
def test_quotient_times_divisor(a, b):
    quotient = Real(a) / Real(b)
    assert abs(float(quotient) / (float(Real(a)) / float(Real(b))) - 1) < 2**-30


@given(numbers)
def test_negating_twice_and_storing_is_storing(a):
    assert real.negate(real.negate(a)) == a
    try:
        contents = real.to_stored(a)
    except ApplesoftError:
        return
    assert real.from_stored(contents) == real.rounded(a)
    assert real.to_stored(real.from_stored(contents)) == contents


@given(numbers, numbers)
def test_comparison_is_the_order_but_for_the_last_byte(a, b):
    contents = real.from_stored(real.to_stored(a)) if a[1] < real.LIMIT - 0x80 else a
    difference = exact(b) - exact(contents)
    coarse = abs(difference) <= abs(exact(b)) * Fraction(1, 2**22)
    if not coarse:
        assert real.compare(contents, b) == (1 if difference > 0 else -1)


@given(st.integers(2**31, 2**32 - 1), st.integers(2**31, 2**32 - 1))
def test_the_rom_s_loop_of_division_gives_the_quotient(dividend: int, divisor: int) -> None:
    assert real.quotient_by_loop(dividend, divisor) == (dividend << 33) // divisor
