"""Texts that are amounts, and texts that are refused."""

import math

import pytest

from impact88.cases import PLAIN, Amount, View
from impact88.cases.amounts import read
from impact88.errors import UserError

US = View("us")


@pytest.mark.parametrize(
    ("name", "text", "value", "low", "high"),
    [
        ("MA", "1,234 lb", 38.35389251171399, 38.35389251171399, 38.35389251171399),
        ("UX", "3 .. 5", 5.866666666666666, 4.4, 7.333333333333333),
        ("UX", "-31..-29 mph", -44, -45.46666666666667, -42.53333333333333),
        ("DA", "-6 ft 6 in", -6.5, -6.5, -6.5),
        ("DA", "1 ft +- 6 in", 1, 0.5, 1.5),
        ("UX", "−30 mph", -44, -44, -44),
        ("GA", "8°", 8, 8, 8),
        ("E", "20 %", 0.2, 0.2, 0.2),
        ("SB", "0 .. 1", 22 / 30, 0, 22 / 15),
        ("MU", "0.7 +- 10 %", 0.7, 0.63, 0.77),
        ("MU", "80 .. 90 %", 0.85, 0.8, 0.9),
        ("LOSS", "37 % +- 2", 37, 35, 39),
        ("DA", "6 ft 6 in +- 6", 6.5, 6, 7),
        ("UX", "1E-999999999", 0, 0, 0),
        ("MB", "inf", math.inf, math.inf, math.inf),
        ("IA", "3 lbf-ft-s²", 3, 3, 3),
        ("IA", "3 LB ft s2", 3, 3, 3),
        ("MA", "4000 N", 27.949102234419197, 27.949102234419197, 27.949102234419197),
        ("UX", "5 +- 0", 7.333333333333333, 7.333333333333333, 7.333333333333333),
    ],
)
def test_accepted(name: str, text: str, value: float, low: float, high: float) -> None:
    amount = read(name, text, US)
    assert (amount.value, amount.low, amount.high) == (value, low, high)
    assert amount.varies == (low < high)
    assert amount.share == (name == "MU" and "10" not in text)


@pytest.mark.parametrize(
    ("name", "text", "reason"),
    [
        ("UX", "1,234 km/h", "comma may be a decimal one; expected 1234 km/h, or a decimal"),
        ("MA", "3 .. 1,234 kg", "expected 3 .. 1234 kg, or"),
        ("UX", "٣ .. ٥", "is not an amount"),
        ("UX", "5 .. 3", "lower limit first"),
        ("UX", "30 +- -2", "no negative tolerance"),
        ("UX", "1 .. 2 .. 3", "is not an amount"),
        ("SAF", "-30", "a speed is not negative; expected 0 or more, or HAF turned by 180"),
        ("SB", "1 +- 1.01", "a speed is not negative"),
        ("UX", "3...5", "is not an amount"),
        ("DA", "6'6\"", "is not an amount"),
        ("DA", "6 ft -6 in", "ft -6 in is not a unit"),
        ("UX", "1e999", "beyond the range of doubles"),
        ("UX", "9" * 300, "longer than 70 characters"),
        ("UX", "25 lb", "lb is not a unit of length/time; expected mph"),
        ("IA", "2000 lb", "expected lb-ft-s2, lb-in-s2, lb-ft2, kg-m2"),
        ("LOSS", "37 +- 5 %", "a percentage of a percentage"),
        ("MUP", "85 %", "MU takes shares"),
        ("SA", "skid 62 ft at 0.7", "a speed after the impact; expected SAF or SBF"),
        ("SAF", "skid -62 ft at 0.7", "above 0"),
        ("SAF", "skid 62 ft at 1.9 +- .11", "above 0, and at most 2"),
        ("UX", ".", "is not an amount"),
        ("MA", "0,123 lb", "is not an amount"),
    ],
)
def test_refused(name: str, text: str, reason: str) -> None:
    with pytest.raises(UserError, match=f"^{name} = ") as error:
        read(name, text, US)
    assert reason in str(error.value)


def test_percentage_of_a_compass_heading_is_of_the_heading() -> None:
    view = View(headings="compass")
    amount = read("TA", "271 +- 1 %", view)
    ends = [view.shown("TA", end, one_turn=False) for end in (amount.high, amount.low)]
    assert ends == pytest.approx((268.29, 273.71))


def test_digits_are_kept_where_nothing_converts_them() -> None:
    assert read("MA", "143.50", PLAIN).typed == "143.50"
    assert read("MA", "143.50 slug", US).typed == "143.50"
    assert read("UY", "2.50", View(axes="sae")).typed == "-2.50"
    assert read("UY", "0.0", View(axes="sae")).typed == "0.0"
    assert read("UX", "0", US).typed == "0"
    assert read("UX", "1e1", PLAIN).typed == "1E1"
    assert read("UX", "triangular 1.0 2.50 3", PLAIN).typed == "2.50"
    assert read("TA", "0.1", View(headings="compass")).typed == "269.9"


def test_skid_is_a_speed() -> None:
    amount = read("SAF", "skid 62 ft at 0.7 +- 0.05", US)
    speed = math.sqrt(2 * 9.80665 / 0.3048 * 62 * 0.7)
    assert (amount.kind, amount.value) == ("uniform", pytest.approx(speed, rel=1e-15))
    assert amount.high == pytest.approx(speed * math.sqrt(0.75 / 0.7), rel=1e-15)
    fast = read("SAF", "skid 62 ft at 1.9 +- .1", US).high
    assert fast == pytest.approx(math.sqrt(4 * 32.174 * 62), rel=1e-4)
    both = read("SAF", "skid 60 .. 64 ft at 0.7 +- 0.05", US)
    assert both.kind == "normal"
    assert both.low < both.value - both.sd < both.value + both.sd < both.high


def test_pivot_keeps_its_sign() -> None:
    sae = View(axes="sae")
    assert (read("MUP", "-10", sae).value, read("MUP", "0.5", sae).value) == (-10, -0.5)
    assert (sae.shown("MUP", -10.0), sae.shown("MUP", -0.5)) == (-10, 0.5)


def test_amounts_are_checked() -> None:
    for fields in ((1, 2, 0), (1, -math.inf, math.inf, "normal", -1)):
        with pytest.raises(UserError, match="lower limit first"):
            Amount(*fields)
