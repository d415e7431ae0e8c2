"""Explanations of printouts that differ."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

import numpy as np
import pytest

import printouts
from impact88.collision.casescene import Scene, sample
from impact88.collision.doubles import double, opposite
from impact88.printouts.explaining.causes import Cause
from impact88.printouts.explaining.explanations import MORE_DIGITS
from impact88.printouts.explaining.machines import cut
from impact88.printouts.reading.numerals import as_printed
from impact88.printouts.reading.printout import FIELDS, read_printouts
from impact88.printouts.recovery import replays
from impact88.printouts.recovery.recovered import recover
from impact88.printouts.recovery.rereading import Rereading
from impact88.printouts.recovery.search import Expected, printed_in_doubles
from impact88.printouts.recovery.slips import BITS, Change, slip
from impact88.printouts.reporting.examination import Verdict, verify
from impact88.program.replay import replay
from impact88.program.run import run
from printouts import SAMPLE


def explanations(text: str) -> list[Cause]:
    (shown,) = read_printouts(text)
    return verify(shown).explanations


def first(text: str) -> Cause:
    return explanations(text)[0]


SLIPS = [
    ("MA= 143.5", "MA= 148.5", "digit misread", "MA"),
    ("KE= 100904.929", "KE= 100094.929", "digits swapped", "KI"),
    ("MU= .911", "MU= -.911", "sign misread", "MUP"),
    ("IA= 3728", "IA= 372", "digit lost or added", "IA"),
    ("MA= 143.5", "MA= 14.35", "decimal point misread", "MA"),
    ("UX= -29.04", "UX= 29.04", "sign misread", "UX"),
    ("UX= -29.04", "UX= -92.04", "digits swapped", "UX"),
    ("VAX= -13.263", "VAX= -13.268", "digit misread", "VAX"),
]


@pytest.mark.parametrize(("old", "new", "kind", "field"), printouts.first(SLIPS, 3))
def test_each_slip_is_named(old: str, new: str, kind: str, field: str) -> None:
    """MU too, where the scene can print either sign."""
    found = first(SAMPLE.replace(old, new))
    assert (found.kind, found.field, found.remaining) == (kind, field, 0)
    assert f"{found.would_be}" in old


def _printed(scene: Scene, fields: dict[str, Any]) -> str:
    """A printout of a scene with some of its numbers replaced."""
    text = run(scene).printout
    for place in reversed(printouts.places(text)):
        if place.name in fields:
            text = text[: place.start] + fields[place.name] + text[place.stop :]
    return text


def _scene(text: str) -> Scene:
    return Scene.from_mapping(dict(part.split("=") for part in text.split()))


SLIDING_BACK = _scene(
    "MA=163.69 MB=189 IA=5124 IB=7606.7 DA=7 DB=7 PA=90 PB=81.3 TA=14 TB=0 GA=14.1 UX=-24.5 UY=0 "
    "WA=0 VX=35.3 VY=48 WB=-2.83 E=.6 MU=.149 EM=-.145 M=6"
)
"""With VY = -48 line 400 leaves MU the other sign."""
SPINNING = _scene(
    "MA=399 MB=174.73 IA=825 IB=3241.1 DA=2.39 DB=1 PA=0 PB=-3 TA=58 TB=180 GA=-1.4 UX=10.59 "
    "UY=-39.246 WA=0 VX=78 VY=0 WB=0 E=.31 MU=1 EM=-.91 M=6"
)
"""Most slips in masses and speeds explain no more of its energy than none."""
TURNED = _scene(
    "MA=278 MB=102 IA=7819 IB=6580 DA=9.37 DB=8.81 PA=-169.7 PB=157 TA=60 TB=3.6 GA=30 UX=-60 "
    "UY=64.11 WA=0 VX=-17.677 VY=-40 WB=0 E=.66 MU=1.113 EM=.5 M=6"
)
"""Its final velocities do not depend on PA and DA."""


TWO_SLIPS = [
    (SLIDING_BACK, {"VY": "-48", "GA": "14.2"}),
    (SPINNING, {"UX": "105.9", "WA": "4"}),
    (sample(1), {"MUP": "-.911", "MA": "148.5"}),
    (sample(1), {"MUP": "-.911", "UX": "29.04"}),
    (TURNED, {"DA": "7.37", "PA": "-1697"}),
]


@pytest.mark.parametrize(("scene", "new"), printouts.first(TWO_SLIPS, 1))
def test_two_slips_of_two_kinds(scene: Scene, new: dict[str, str]) -> None:
    true = replays.run_once(scene).fields
    found = first(_printed(scene, new))
    assert {one["field"]: one["would_be"] for one in found.changes} == {
        name: true[name] for name in new
    }
    assert found.remaining == 0


IN_THE_LAST_PLACE = _scene(
    "MA=289.8 MB=218.7 IA=1628 IB=2309 DA=2.79 DB=7.1 PA=180 PB=128 TA=168 TB=-104.3 GA=-155.2 "
    "UX=-28.7 UY=97.921 WA=0 VX=-4.65 VY=82.598 WB=0 E=.4 MU=1.15 EM=-.19 M=6"
)
"""Double precision prints XA = -28.7 for the Apple's -28.71."""


def test_one_in_the_last_place_is_another_arithmetic_or_a_digit_lost() -> None:
    """That it is another machine is said first, and that it may be a misreading beside it."""
    apple = replays.run_once(IN_THE_LAST_PLACE).fields
    double = run(IN_THE_LAST_PLACE, "float64").printout
    fields = {place.name: double[place.start : place.stop] for place in printouts.places(double)}
    differ = {name: text for name, text in fields.items() if text != apple[name]}
    assert differ
    (shown,) = read_printouts(double)
    best, *others = verify(shown).explanations
    assert best.kind == "IEEE double arithmetic"
    assert any(
        {one["field"]: one["printed"] for one in other.changes} == differ for other in others
    )


def test_a_digit_far_from_the_last_place_is_misread_and_no_other_machine_is_named() -> None:
    (shown,) = read_printouts(_printed(IN_THE_LAST_PLACE, {"XA": "-23.71"}))
    (found, *others) = verify(shown).explanations
    assert (found.kind, found.field, found.would_be) == ("digit misread", "XA", "-28.71")
    assert all(one.rank > 1 for one in others)


def test_rounded_instead_of_floored() -> None:
    scene = sample(1)
    rounded = {
        name: as_printed(f"{made[0]:f}") or ""
        for name, value in replays.run_whole(scene)[1].items()
        if name != "KI" and (made := cut(value, FIELDS[name].places or 0, "rounded"))
    }
    assert rounded["XB"] == "14.52"
    found = first(_printed(scene, rounded))
    assert (found.kind, found.remaining) == ("rounded, not floored", 0)


def test_inputs_exchanged_and_a_slip_in_another() -> None:
    """The slip is looked for in the page as it is with the inputs in their places."""
    true = replays.run_once(sample(1)).fields
    changed = {"MA": true["MB"], "MB": true["MA"], "GA": "-33"}
    cause = first(_printed(sample(1), changed))
    assert {change["field"]: change["would_be"] for change in cause.changes} == {
        name: true[name] for name in changed
    }
    assert (cause.kind, cause.remaining) == ("A and B exchanged and digit misread", 0)


def test_point_mass_with_arms_left() -> None:
    scene = sample(1).replaced({"M": "4"})
    proper = replays.run_once(scene.replaced({"DA": "0", "DB": "0"})).fields
    fields = {name: text for name, text in proper.items() if name not in ("DA", "DB")}
    found = first(_printed(scene, fields))
    assert (found.kind, found.remaining) == ("M = 4 with DA, DB left", 0)


def test_a_slip_is_put_right_to_what_the_program_prints() -> None:
    """Never to .25 with a zero before it, which it prints otherwise."""
    text = run(sample(3)).page.replace("VY= 58.667", "EY= 58.667").replace("314066", "314166")
    assert "would be 0." not in "; ".join(map(str, explanations(text)))


def test_another_m() -> None:
    """A point-mass printout whose results are those of the full solution."""
    full = replays.run_once(sample(1)).fields
    (shown,) = read_printouts(_printed(sample(1).replaced({"M": "4"}), full))
    result = verify(shown)
    assert result.verdict is Verdict.INCOMPLETE
    assert result.not_read == ["WAF", "WBF"]
    assert result.scene["M"] == "6"


@pytest.mark.long
@pytest.mark.captures
def test_another_arithmetic_is_offered_only_where_no_machine_explains_the_page() -> None:
    """All results one in the last place: no machine does that, and none is blamed beside one."""
    fields = {
        name: as_printed(f"{Decimal(text) + Decimal(1).scaleb(-(FIELDS[name].places or 0))}") or ""
        for name, text in replays.run_once(sample(1)).fields.items()
        if FIELDS[name].places
    }
    kinds = {one.kind for one in explanations(_printed(sample(1), fields))}
    assert "another arithmetic" in kinds
    assert "rounded, not floored" not in kinds


@pytest.mark.parametrize(
    ("other", "kind"),
    [
        ("-14.57", "digit misread"),
        ("14.52", "sign misread"),
        ("-1.452", "decimal point misread"),
        ("-41.52", "digits swapped"),
        ("-114.52", "digit lost or added"),
        ("-19.57", "two digits misread"),
        ("-14.52", None),
        ("-25.15", None),
    ],
)
def test_slips_are_told_apart(other: str, kind: str | None) -> None:
    assert slip("-14.52", other) == kind
    assert slip(other, "-14.52") == kind


def test_a_point_moves_within_the_figures_and_leaves_the_exponent() -> None:
    assert slip("1.452E-05", "14.52E-05") == "decimal point misread"
    assert slip("1.452E-05", "1452E-05") == "decimal point misread"


def test_a_digit_that_looks_like_the_other_takes_less_to_believe() -> None:
    bits = [Change("digit misread", "MA", "143.5", f"14{other}.5").bits for other in "8592017"]
    assert bits == sorted(bits)
    assert bits[0] < bits[-1]


def test_an_angle_beyond_a_full_turn_takes_as_much_as_a_digit_more() -> None:
    def bits(field: str, would_be: str) -> float:
        return Change("digit lost or added", field, "36", would_be).bits

    assert bits("PA", "360") == bits("PA", "-360") == bits("MA", "361")
    assert bits("PA", "361") == bits("PA", "-361") == bits("PA", "360") + BITS["digit misread"]
    assert Change("no slip", "PA", "36", "361").bits == 0


@pytest.mark.long
def test_two_slips_are_put_right_together() -> None:
    (shown,) = read_printouts(_printed(sample(1), {"MUP": "-.911", "MA": "148.5"}))
    rereading = Rereading(recover(shown))
    assert {len(reread.changes) for reread in rereading.best} <= {0, 1, 2}
    assert [change.would_be for change in rereading.best[0].changes] == ["143.5", ".911"]


def test_a_sign_is_that_of_the_number_or_of_its_exponent() -> None:
    assert slip("-1.452E-05", "1.452E-05") == "sign misread"
    assert slip("-1.452E-05", "-1.452E+05") == "sign misread"
    assert slip("-1.452E+05", "-1.452E-05") == "sign misread"


def test_a_rarer_kind_of_slip_takes_more_to_believe() -> None:
    """From a sign, which is easily lost, to two digits of one number."""
    ascending = ["14.52", "-14.57", "-1.452", "-41.52", "-114.52", "-19.57"]
    kinds = [slip("-14.52", other) for other in ascending]
    assert kinds == [
        "sign misread",
        "digit misread",
        "decimal point misread",
        "digits swapped",
        "digit lost or added",
        "two digits misread",
    ]
    bits = [
        Change(kind or "", "XA", "-14.52", other).bits
        for kind, other in zip(kinds, ascending, strict=True)
    ]
    assert bits == sorted(set(bits))


@pytest.mark.parametrize(
    ("value", "places", "number"), [(-0.004, 2, 0), (-13.2626, 3, "-13.263"), (0.5, 0, 1)]
)
def test_halves_are_rounded_upward(value: float, places: int, number: str) -> None:
    found = cut(value, places, "rounded")
    assert found
    assert found[1] == float(number)


@pytest.mark.parametrize(
    "typed", [".911", "+.911", " + .911 ", "-.911", " - .911", "9.11E-1", "5E-01"]
)
def test_the_other_sign_of_what_may_be_typed(typed: str) -> None:
    assert double(opposite(typed)) == -double(typed)
    assert double(opposite(opposite(typed))) == double(typed)


@pytest.mark.parametrize("typed", ["-10.00000001", "-10.00000002"])
def test_an_input_typed_with_more_digits_than_are_printed_is_named(typed: str) -> None:
    """-10 is printed, and line 510 turns on the digit that is not."""
    page = run(sample(1).replaced({"MU": typed})).page
    assert "MU= -10 " in page
    cause = first(page)
    assert (cause.kind, cause.field, cause.remaining) == (MORE_DIGITS, "MUP", 0)


@pytest.mark.parametrize(("text", "number"), [("5.123", 5.123), ("-5.123", -5.123), (".5", 0.5)])
def test_a_printed_result_is_any_number_that_is_floored_to_it(text: str, number: float) -> None:
    expected = Expected("VAX", {text: 0.2}, 3.0)
    values = number + np.array([-0.0005, 0.0, 0.0005, 0.00099, 0.0015])
    assert expected.mismatch(values).tolist() == [3.0, 0.2, 0.2, 0.2, 3.0]


def test_point_masses_lose_the_energy_that_the_listing_counts() -> None:
    """It counts the initial spins' and none after."""
    scene = {**sample(1), "M": "4", "DA": "0", "DB": "0", "WA": "1", "WB": "-2"}
    texts = {name: [text] for name, text in scene.items()}
    numbers = {name: np.array([float(column[0])]) for name, column in texts.items()}
    printed = replay(texts)
    found = printed_in_doubles(numbers, ["KI", "LOSS"])
    assert found["KI"] == pytest.approx(float(printed.printed("KI")[0]), rel=1e-8)
    assert 0 <= found["LOSS"][0] - float(printed.printed("LOSS")[0]) < 0.01
