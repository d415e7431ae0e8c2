"""In words: what is asked, how sure it is, what was assumed, what would help."""

import pytest
from collisions import INTERSECTION, REAR_END, RECORDER, SECTION_VII, section_vii

import impact88
from impact88.cases.case import Case
from impact88.cases.units import View
from impact88.errors import UserError
from impact88.reconstruction.answer import reconstruct
from impact88.reconstruction.words import (
    advice,
    assumptions,
    check,
    evidence,
    question,
    refusal,
    remarks,
)

SKID = """
units = "si"
M = 4
MA = 1000
MB = 2200
HA = 0
SB = 0
E = 0
SAF = "skid 2.8 m at 0.40"
HAF = 0
"""


def test_intersection_of_the_guide():
    result = reconstruct(INTERSECTION, samples=0)[0]
    assert question(result) == "SA and SB, from 8 exact values"
    assert evidence(result) == "not checked: no more is known than needed"
    assert assumptions(result) == ("A faces the way it travels", "B faces the way it travels")
    assert remarks(result)[-1].startswith("E, MUP, PN, PT, VC, VS and MUC need GA (angle of the")
    values = {name: round(result.values[name], 2) for name in ("SA", "SB", "DVA", "PDOFA", "PDOFB")}
    assert values == {"SA": 55.62, "SB": 63.21, "DVA": 36.51, "PDOFA": -61.68, "PDOFB": 28.32}
    assert not refusal(result)


def test_rear_end_and_skids_of_the_guide():
    result = reconstruct(REAR_END, samples=0)[0]
    assert (round(result.values["DVA"], 2), round(result.values["DVB"], 2)) == (2.95, 3.65)
    assert (result.values["PDOFA"], abs(result.values["PDOFB"])) == (0, 180)
    assert remarks(result)[0].startswith("the motion is along one line")
    case = Case.loads(SKID)
    values = reconstruct(case.entries, samples=0)[0].values
    assert (round(values["SA"], 1), round(values["SBF"], 2)) == (15.0, 4.69)


def test_section_vii_in_words():
    result = section_vii()
    assert question(result) == (
        "SA, SB, E, MUP and EM, from VAX, VAY, VBX and VBY within limits and 13 exact values"
    )
    assert advice(result)[0].startswith("give WAF, WBF and WA: that would determine WA, WB")
    assert "know VBX more closely: it makes 70 % of the variance of SA" in advice(result)
    assert "E 0 to 1 (the interval reaches 0 and 1)" in assumptions(result)
    assert [*result.drivers["UX"]] == ["VBX", "VAX"]
    assert "1 impact; others that no start reached, by estimate: 0.0" in " ".join(remarks(result))


def test_units_of_the_view():
    metric = {"SA": "20 +- 1 km/h", "DVA": "11 +- .5 km/h", "DVB": "12 +- .5 km/h"}
    case = Case.of({**RECORDER, "MA": "950 kg", "MB": "770 kg", **metric}, view=View("metric"))
    result = reconstruct(case.entries, samples=0)[0]
    assert "DVA 11 km/h given, " in check(result, "DVA", case.view)


def test_messages_name_the_entries_behind_a_value():
    crush = {"M": 4, "MA": 95, "MB": 110, "HA": 0, "SB": 0, "E": 0, "EBSA": "14 +- 2"}
    result = reconstruct({**crush, "EBSB": "normal 12 2", "SAF": "12 +- 3", "HAF": 0}, samples=0)[0]
    assert check(result, "EL").startswith("EL (EBSA, EBSB) 17,")
    assert "know EL (EBSA, EBSB) more closely" in advice(result)[0]
    share = {n: x for n, x in SECTION_VII.items() if n != "UY"} | {"UY": 0, "WA": 0, "WB": 0}
    result = reconstruct({**share, "E": 0.1, "EM": -0.5, "MU": "60 .. 90 %"}, samples=0)[0]
    assert check(result, "MU").startswith("MU/MUC 0.75 given, ")


def test_a_heading_follows_an_unknown_course():
    case = Case.of({**SECTION_VII, "TA": "course", "TB": "course"})
    result = reconstruct(case.entries, samples=0)[0]
    assert result.verdict == "agrees"
    assert result.values["TA"] % 360 == pytest.approx((result.values["HA"] + 180) % 360)
    assert result.values["SA"] == pytest.approx(40.2083, abs=1e-3)


def test_a_scene_for_the_1988_program():
    entries = {**SECTION_VII, "VAX": -10, "VAY": 20, "VBX": -20, "VBY": 45, "WAF": -2.9, "WBF": -1}
    with pytest.raises(UserError, match="leaves"):
        reconstruct(SECTION_VII, samples=0)[0].scene()
    scene = reconstruct({**entries, "WA": 0}, samples=0)[0].scene()
    assert scene["UX"] == pytest.approx(-40.2083, abs=1e-3)
    assert scene["MU"] == pytest.approx(0.662, abs=1e-3)
    assert scene["M"] == 6
    assert impact88.solve(scene, "VAY")["VAY"] == pytest.approx(20, abs=1e-6)


def test_forces_over_a_contact_time():
    values = reconstruct(REAR_END, samples=0, contact_time=0.1)[0].values
    assert values["FA"] == pytest.approx(950 * values["DVA"] / 0.1)
    assert values["FM3"] == pytest.approx(3 * values["FA"])
    with pytest.raises(UserError, match="contact time"):
        reconstruct(REAR_END, contact_time=0)


def test_a_plane_on_the_other_side_is_turned():
    entries = {**SECTION_VII, "GA": 180}
    result = reconstruct(entries, samples=0)[0]
    assert result.values["MUP"] == pytest.approx(0.662, abs=1e-3)
    assert "GA = 180 has each vehicle on the other's side" in result.remarks[0]


def test_friction_as_a_percentage_of_what_ends_the_sliding():
    scene = {n: x for n, x in SECTION_VII.items() if n[0] != "V" or n in ("VX", "VY")}
    scene |= {"UX": -36.667, "WA": 0, "VY": 58.667, "WB": 0, "E": 0.25, "EM": -0.9, "MU": "80 %"}
    values = reconstruct(scene, samples=0)[0].values
    assert values["MUP"] / values["MUC"] == pytest.approx(0.8)


def test_momentum_of_bodies_whose_dimensions_are_not_given():
    entries = {n: x for n, x in SECTION_VII.items() if n[0] not in "IDP" or n == "DT"}
    result = reconstruct(entries, samples=0)[0]
    assert result.values["UX"] == pytest.approx(-40.2083, abs=1e-3)
    assert "E" not in result.values
    with pytest.raises(UserError, match=r"EM is 0\.5; expected -1 to 0, or 1 for no moment"):
        reconstruct({**SECTION_VII, "EM": 0.5})
    with pytest.raises(UserError, match="E cannot be used"):
        reconstruct({**entries, "E": 0.2})


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"MA": None}, "missing MA"),
        ({"XX": 3}, "XX"),
        ({"MU": 0.5}, "MU cannot be used: missing GA"),
        ({"ELA": 5}, "ELA given; expected ELA or EBSA together with"),
        ({"EBSA": 5, "EBSB": 6, "EL": 30}, "EBSA, EBSB given; expected"),
        ({"SAF": float("inf")}, "SAF = 'INF' is not an amount"),
        ({"M": 5}, "M is 5; expected 6 for bodies or 4 for point masses"),
    ],
)
def test_what_cannot_be_used(change, words):
    with pytest.raises(UserError, match=words):
        reconstruct({**INTERSECTION, **change})


@pytest.mark.parametrize(("angle", "follows"), [(0, False), (5, True)])
def test_a_central_collision_without_em(angle: float, follows: bool) -> None:
    entries = dict.fromkeys(("MU", "TA", "TB", "GA", "PB", "WA", "WB", "VAY", "VBY"), 0)
    entries |= {"E": 0.1, "PA": angle, "DA": 6, "DB": 6, "MA": 95, "MB": 110, "IA": 1900}
    entries |= {"IB": 2400, "VAX": "-5 +- 1", "VBX": "-6 +- 1"}
    result = reconstruct(entries, samples=0)[0]
    assert result.verdict == "agrees"
    assert ("EM" in (*result.values, *result.undetermined)) is follows
    assert any("EM does not follow" in text for text in result.remarks) is not follows
