"""The grammar of amounts, against sizes and sums written out here."""

from __future__ import annotations

import os
import random
import re
from fractions import Fraction
from math import pi

import pytest

from impact88.collision.case import Case
from impact88.collision.case import in_base_units as in_base
from impact88.errors import UserError

FOOT, POUND = Fraction("0.3048"), Fraction("0.45359237")
SLUG = POUND * Fraction("9.80665") / FOOT
MPH = Fraction(5280, 3600)
"""ft/s"""


def based(name: str, text: str, units: str | None = None) -> str:
    texts = {name: text} | ({"units": units} if units else {})
    return in_base(texts, "file")[0][name]


def read(name: str, text: str, units: str | None = None) -> float | None:
    """The number, or None where it is refused."""
    try:
        found = based(name, text, units)
    except UserError:
        return None
    return None if "+-" in found else float(found)


RIGHT: list[tuple[str, str, float | Fraction]] = [
    ("DA", "7 ft 7 in", Fraction(91, 12)),
    ("DA", "5 ft 10 in", Fraction(70, 12)),
    ("DA", "6'6\"", 6.5),
    ("DA", "6' 6\"", 6.5),
    ("DA", "6′ 6″", 6.5),
    ("DA", "6ft6in", 6.5),
    ("DA", "6 feet 6 inches", 6.5),
    ("DA", "6 ft. 6 in.", 6.5),
    ("DA", "5 ft 10 1/2 in", Fraction(141, 24)),
    ("DA", "5 1/2 ft", 5.5),
    ("DA", "5½ ft", 5.5),
    ("DA", "1/2 ft", 0.5),
    ("DA", "42 in", 3.5),
    ("DA", '42"', 3.5),
    ("DA", "2 yd", 6),
    ("DA", "350 mm", 0.35),
    ("DA", "1 m 20 cm", 1.2),
    ("DA", "-6 ft 6 in", -6.5),
    ("UX", "-25 mph", -25 * MPH),
    ("UX", "-25 MPH", -25 * MPH),
    ("UX", "-25mph", -25 * MPH),
    ("UX", "−25 mph", -25 * MPH),
    ("UX", "25 miles per hour", 25 * MPH),
    ("UX", "25 mi/h", 25 * MPH),
    ("UX", "36.667 ft/s", 36.667),
    ("UX", "36.667 fps", 36.667),
    ("UX", "36.667 ft/sec", 36.667),
    ("UX", "-90 km/h", -25),
    ("UX", "90 kph", 25),
    ("UX", "90 km/hr", 25),
    ("UX", "25 m/s", 25),
    ("UX", "20 knots", 20 * Fraction("1852") / 3600 / FOOT),
    ("MA", "3340 lb", 3340 * POUND / SLUG),
    ("MA", "3,340 lb", 3340 * POUND / SLUG),
    ("MA", "3,340 lbs", 3340 * POUND / SLUG),
    ("MA", "3340 lbs.", 3340 * POUND / SLUG),
    ("MA", "3,340.5 lb", Fraction("3340.5") * POUND / SLUG),
    ("MA", "96 slugs", 96),
    ("MA", "96 lb-s²/ft", 96),
    ("MA", "1515 kg", 1515),
    ("MA", "1.515 t", 1515),
    ("IA", "2000 slug ft2", 2000),
    ("IA", "2000 slug*ft^2", 2000),
    ("IA", "2000 slug-ft²", 2000),
    ("IA", "2000 lb-ft-s2", 2000),
    ("IA", "2000 lb ft s^2", 2000),
    ("IA", "24000 lb·in·s²", 2000),
    ("IA", "64348 lb ft2", 64348 * POUND / SLUG),
    ("IA", "2700 kg m2", 2700),
    ("IA", "2700 kg·m²", 2700),
    ("GA", "8°", 8),
    ("GA", "8 deg", 8),
    ("GA", "8° 30'", 8.5),
    ("GA", "-8 deg 30 min", -8.5),
    ("GA", "0.5 rad", 90 / pi),
    ("WA", "90 deg/s", pi / 2),
    ("WA", "90 °/s", pi / 2),
    ("WA", "15 rpm", pi / 2),
    ("WA", "1.5 rad/s", 1.5),
    ("E", "5 %", 0.05),
    ("LOSS", "37.4 %", 37.4),
    ("EL", "12 kJ", 12000),
    ("EL", "10,000 ft-lb", 10000),
    ("EL", "500 N m", 500),
    # as others write them, added later
    ("DA", "5ft. 11in.", Fraction(71, 12)),
    ("DA", "3' 4 1/2\"", Fraction(81, 24)),
    ("DA", "1.2 metres", 1.2),
    ("DA", "0.75 yards", 2.25),
    ("UX", "45 mi/hr", 45 * MPH),
    ("UX", "45 miles/hour", 45 * MPH),
    ("UX", "72 KMH", 20),
    ("UX", "72 km·h⁻¹", 20),
    ("UX", "20 m s^-1", 20),
    ("UX", "66 feet per second", 66),
    ("UX", "+30 mph", 44),
    ("MA", "1500 kilograms", 1500),
    ("MA", "1.500 kg", 1.5),
    ("MA", "3340 pounds", 3340 * POUND / SLUG),
    ("IA", "1900 ft-lb-sec²", 1900),
    ("IA", "1900 lbf ft s2", 1900),
    ("IA", "2600 kg-m2", 2600),
    ("IA", "1900 slugs ft²", 1900),
    ("GA", "12°15'30\"", 12 + 15 / 60 + 30 / 3600),
    ("WA", "120 degrees/second", 2 * pi / 3),
    ("WA", "0.2 rev/s", 0.4 * pi),
    ("E", "12%", 0.12),
]
REFUSED = [
    ("UX", "30 mph+2 mph"),
    ("UX", "30 mph 2 mph"),
    ("UX", "30 mph 2"),
    ("UX", "3 0 mph"),
    ("UX", "30 - 35 mph"),
    ("UX", "30 mph, 35 mph"),
    ("UX", "30...35 mph"),
    ("UX", "30 lb"),
    ("GA", "8 deg 30"),
    ("GA", "8 30 deg"),
    ("DA", "6-1/2 ft"),
    ("DA", "6'-6\""),
    ("DA", "6 ft -6 in"),
    ("DA", "6 in 6 ft"),
    ("DA", "5'10"),
    ("DA", "3 ft 2 cm"),
    ("DA", "5 ft2"),
    ("MA", "3,340 kg"),
    ("MA", "3,34 lb"),
    ("MA", "1,234,56 lb"),
    ("MA", "1 234 lb"),
    ("MA", "1.5 tons"),
    ("IA", "2000 slug ft"),
    ("LOSS", "37 % +- 2 %"),
    ("DA", "8 foot 2"),
    ("DA", "5′-11″"),
    ("DA", "2,15 m"),
    ("DA", "6 ft, 6 in"),
    ("UX", "45 M.P.H."),
    ("UX", "13,9 m/s"),
    ("MA", "1 500 kg"),
    ("MA", "3340#"),
    ("MA", "3,340 lbf"),
    ("IA", "2600 kgm2"),
    ("GA", "30 Grad"),
]


@pytest.mark.parametrize(("name", "text", "expected"), RIGHT)
def test_notations(name: str, text: str, expected: float | Fraction) -> None:
    assert read(name, text) == pytest.approx(float(expected), rel=1e-15)


@pytest.mark.parametrize(("name", "text"), REFUSED)
def test_what_is_refused_says_what_is_taken(name: str, text: str) -> None:
    with pytest.raises(UserError, match=r"expected|write|is not a unit of|units of two systems"):
        based(name, text)


def suggested(name: str, text: str) -> list[str]:
    """The texts that the message of a refusal says to write; fails where the text is read."""
    with pytest.raises(UserError) as caught:
        based(name, text)
    _, _, advice = str(caught.value).partition("; write ")
    forms = re.findall(r"""'((?:[^'\\]|\\.)*)'|"([^"]*)\"""", advice)
    return [single.replace("\\'", "'") or double for single, double in forms]


SPEEDS = {"mph": MPH, " mph": MPH, " km/h": Fraction(1, 36) * 10 / FOOT, " ft/s": 1}
RANGES = (
    "{} - {}{u}",
    "{}-{}{u}",
    "{}–{}{u}",
    "{} to {}{u}",
    "from {} to {}{u}",
    "between {} and {}{u}",
    "{} … {}{u}",
    "{}...{}{u}",
    "{}{u} - {}{u}",
    "{}{u} to {}{u}",
)


def test_what_a_message_says_to_write_is_what_was_typed() -> None:
    """Amounts of which the meaning is known, written in habits that are not accepted."""
    rng = random.Random(41)
    for _ in range(int(os.environ.get("IMPACT88_SWEEP", 1)) * 300):
        unit = rng.choice(list(SPEEDS))
        low, high = sorted(Fraction(rng.randint(10, 990), 10) for _ in range(2))
        comma = rng.choice([False, True])
        numbers = [f"{float(n):.{rng.choice([1, 2])}f}" for n in (low, high)]
        if comma:
            numbers = [number.replace(".", ",") for number in numbers]
        text = rng.choice(RANGES).format(*numbers, u=unit)
        forms = suggested("UX", text)
        assert len(forms) == 1, text
        lower, upper = map(float, _base(forms[0]).split(" .. "))
        scale = _scale(unit)
        assert (lower, upper) == pytest.approx((low * scale, high * scale), rel=1e-15), text


def test_feet_and_inches_with_dashes() -> None:
    rng = random.Random(42)
    for _ in range(int(os.environ.get("IMPACT88_SWEEP", 1)) * 100):
        feet, inches, eighths = rng.randint(1, 9), rng.randint(1, 11), rng.randint(1, 7)
        whole = Fraction(feet) + Fraction(inches, 12)
        text, expected = rng.choice(
            [
                (f"{feet}'-{inches}\"", whole),
                (f"{feet}′–{inches}″", whole),
                (f"{feet} ft - {inches} in", whole),
                (f"{feet} ft, {inches} in", whole),
                (f"{feet}'{inches}", whole),
                (f"{feet}'-{inches} {eighths}/8\"", whole + Fraction(eighths, 96)),
                (f"{feet} ft {inches}-{eighths}/8 in", whole + Fraction(eighths, 96)),
            ]
        )
        forms = suggested("DA", text)
        assert [read("DA", form) for form in forms] == pytest.approx([float(expected)]), text


@pytest.mark.parametrize(
    ("name", "text", "values"),
    [
        ("MA", "1,548 kg", (1548, 1.548)),
        ("MA", "1,548 .. 1,600 kg", ((1548, 1600), (1.548, 1.6))),
        ("MA", "1.548,5 kg", (1548.5,)),
        ("MA", "3 000 lb", (3000 * POUND / SLUG,)),
        ("DA", "1,78 m", (1.78,)),
        ("E", "0,5", (0.5,)),
        ("UX", "–30 mph", (-44,)),
        ("UX", "approx. 30 mph", (44,)),
        ("UX", "-35 – -30 mph", ((-35 * MPH, -44),)),
        ("IA", "2600 kgm2", (2600,)),
        ("UX", "30 mph 2 mph", ()),
        ("UX", "30 lb", ()),
        ("UX", "30 mph, 35 mph", ()),
    ],
)
def test_what_may_be_two_things_is_asked(name: str, text: str, values: tuple[object, ...]) -> None:
    found = [tuple(map(float, _base(form, name).split(" .. "))) for form in suggested(name, text)]
    expected = [value if isinstance(value, tuple) else (value,) for value in values]
    assert found == [pytest.approx(tuple(map(float, value))) for value in expected]  # type: ignore[arg-type]


def _base(text: str, name: str = "UX") -> str:
    return based(name, text)


def _scale(unit: str) -> Fraction:
    """Of a unit of speed, what its numbers are multiplied with in its own system's base."""
    return Fraction(10, 36) if "km" in unit else Fraction(SPEEDS[unit])


SIZES = {
    "DA": {"ft": FOOT, "in": FOOT / 12, "'": FOOT, '"': FOOT / 12, "m": 1, "cm": Fraction(1, 100)},
    "UX": {"mph": MPH * FOOT, "ft/s": FOOT, "km/h": Fraction(1, 3) / Fraction("1.2"), "m/s": 1},
    "MA": {"lb": POUND, "slug": SLUG, "kg": 1, "t": 1000},
}
METRIC = ("m", "cm", "km/h", "m/s", "kg", "t")
JOINTS = ("", " ", "  ", "+", "-", " + ", " - ", ", ", " and ")


def test_two_numbers_and_two_units_are_their_sum_or_refused() -> None:
    """Number, unit, number, unit, in every order and with anything between them."""
    rng = random.Random(28)
    taken = 0
    for _ in range(int(os.environ.get("IMPACT88_SWEEP", 1)) * 3000):
        name = rng.choice(list(SIZES))
        sizes = SIZES[name]
        first, second = rng.choice(list(sizes)), rng.choice([*sizes, ""])
        numbers = [f"{rng.randint(0, 40)}{rng.choice(['', '.5', '.25'])}" for _ in range(2)]
        tidy = rng.random() < 0.5
        order = (0, 1, 2, 3) if tidy else tuple(rng.sample(range(4), 4))
        pieces = [numbers[0], first, numbers[1], second]
        joints = [rng.choice(JOINTS[:2] if tidy else JOINTS) for _ in order]
        text = "".join(pieces[at] + joint for at, joint in zip(order, joints, strict=True))
        said = [pieces[at] for at in order if pieces[at]]
        kinds = "".join("n" if piece[0].isdigit() else "u" for piece in said)
        found = read(name, text)
        if found is None or "nn" in kinds:
            continue
        taken += 1
        assert kinds == "nunu", text
        assert not set("+,") & set(text), text
        base = 1 if said[1] in METRIC else FOOT if name != "MA" else SLUG
        total = sum(Fraction(said[at]) * sizes[said[at + 1]] for at in (0, 2))
        assert found == pytest.approx(float(total / base), rel=1e-15), text
    assert taken > 70


class TestLimits:
    @pytest.mark.parametrize(
        ("text", "expected"),
        [
            ("-31..-29 mph", "-45.46666666666667 .. -42.53333333333333"),
            ("-31 mph .. -29 mph", "-45.46666666666667 .. -42.53333333333333"),
            ("30 mph +- 2 mph", "44 +- 2.933333333333333"),
            ("30 ± 2 mph", "44 +- 2.933333333333333"),
            ("30 mph +/- 5 %", "44 +- 5%"),
            ("+- 3 mph", "+- 4.4"),
            ("uniform 15 30 mph", "uniform 22 44"),
            ("normal 15 1.5 mph within 0 .. 30 mph", "normal 22 2.2 within 0 .. 44"),
            ("triangular 15 mph 22 ft/s 30 mph", "triangular 22 22 44"),
        ],
    )
    def test_each_number_is_converted(self, text: str, expected: str) -> None:
        assert based("UX", text) == expected

    def test_feet_and_inches_too(self) -> None:
        assert based("DA", "6 ft 6 in .. 7 ft") == "6.5 .. 7"
        assert based("DA", "uniform 6 ft 6 in 7 ft") == "uniform 6.5 7"
        assert based("DA", "uniform 6 ft 7 ft 6 in") == "uniform 6 7.5"

    def test_what_others_know_more_of_is_left_to_them(self) -> None:
        assert based("IA", "estimate +- 20 %") == "estimate +- 20%"
        assert based("MU", "85 %") == "85 %"
        assert based("SAF", "skid 62 ft at 0.7") == "skid 62 at 0.7"
        assert based("SAF", "skid 62 +- 3 ft at 0.7 .. 0.8") == "skid 62 +- 3 at 0.7 .. 0.8"


class TestDigits:
    @pytest.mark.parametrize("text", ["-36.66700", ".250", "3.50", "1E", ".", "1 0", "-.5E+1"])
    def test_a_number_without_unit_stays_text(self, text: str) -> None:
        assert based("UX", text) == text

    def test_a_unit_without_factor_keeps_them(self) -> None:
        assert based("UX", "-36.66700 ft/s") == "-36.66700"
        assert based("UX", "-36.66700", "chapter") == "-36.66700"
        assert based("MA", "3,340.50 slug") == "3340.50"

    def test_in_a_system_two_numbers_are_refused_too(self) -> None:
        assert read("DA", "5 10", "us") is None
        assert read("DA", "5 1/2", "us") == 5.5
        assert read("UX", "1E", "us") == pytest.approx(22 / 15)
        assert read("MA", "3,340", "us") == pytest.approx(float(3340 * POUND / SLUG), rel=1e-15)
        assert read("MA", "3,340", "metric") is None


@pytest.mark.parametrize("vehicle", "AB")
def test_a_vehicle_that_faces_its_course(vehicle: str) -> None:
    """In the listing's axes A, seen from behind its contact point, faces TA + 180."""
    x, y, course, heading = ("UX", "UY", "HA", "TA") if vehicle == "A" else ("VX", "VY", "HB", "TB")
    facing = 180 if vehicle == "A" else 0
    for known in ({x: "-3", y: "3"}, {course: "135"}):
        values = Case({**known, heading: "course"}).values
        assert (float(values[heading]) + facing - 135) % 360 == 0
    still = {course: "135", f"S{vehicle}": "0"}
    for unknown in ({}, {x: "0", y: "0"}, still):
        assert Case({**unknown, heading: "course"}).values[heading] == "course"
