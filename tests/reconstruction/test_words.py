"""The page: what is asked, found, how sure it is, what was assumed, what would help."""

import pytest
from collisions import INTERSECTION, REAR_END, RECORDER, SECTION_VII

from impact88.cases.case import Case
from impact88.cases.units import View
from impact88.errors import UserError
from impact88.reconstruction.answer import reconstruct
from impact88.reconstruction.words import (
    advice,
    question,
    remarks,
    text,
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
    page = text(reconstruct(INTERSECTION))
    for line in (
        "ASKED      SA and SB, from 8 exact values",
        "BEFORE A   55.62; course 0",
        "BEFORE B   63.21; course -90",
        "DELTA-V A  36.51; force from 10 o'clock (-61.68)",
        "DELTA-V B  54.76; force from 1 o'clock (28.32)",
        "EVIDENCE   not checked: no more is known than needed",
        "ASSUMED    A faces the way it travels; B faces the way it travels",
        "!          E, MUP, PN, PT, VC, VS and MUC need GA (angle of the impact surface",
    ):
        assert line in page


def test_rear_end_and_skids_of_the_guide():
    page = text(reconstruct(REAR_END))
    assert "DELTA-V A  2.955; force from 12 o'clock (0)" in page
    assert "DELTA-V B  3.645; force from 6 o'clock (180)" in page
    assert "the motion is along one line" in page
    case = Case.loads(SKID)
    page = text(reconstruct(case.entries), case.view)
    assert "BEFORE A   15 m/s; course 0 deg" in page
    assert "AFTER B    4.687 m/s; course 0 deg" in page


def test_first_lines_and_the_rest():
    results = reconstruct(SECTION_VII)
    page = text(results).splitlines()
    titles = list(dict.fromkeys(line[:10].strip() for line in page if line[:1].strip()))
    assert titles[:3] == ["ASKED", "BEFORE A", "BEFORE B"]
    assert titles[-4:] == ["EVIDENCE", "ASSUMED", "HELPS", "!"]
    assert max(map(len, page)) <= 96
    assert advice(results[0])[0].startswith("give WAF, WBF and WA: that would determine WA, WB")
    assert "know VBX more closely: it makes 70 % of the variance of SA" in advice(results[0])
    full = text(results, full=True)
    assert "through VBX 70 %, VAX 30 %" in full
    assert "correlations, to first order" in full
    assert "DVB DVA +1.00" in full
    assert (
        "SA, SB, E, MUP and EM, from VAX, VAY, VBX and VBY within limits and 13 exact"
        in question(results[0])
    )
    assert "1 impact; expected number not seen 0.0" in " ".join(remarks(results[0]))


def test_units_of_the_view():
    metric = Case.of(INTERSECTION, view=View("metric"))
    page = text(reconstruct(metric.entries), View("metric"))
    assert "BEFORE A   55.62 km/h; course 0 deg" in page
    assert "DVA 3.1 measured, 2.837 by the others (1.5 sd)" in text(
        reconstruct(RECORDER), full=True
    )


def test_a_scene_for_the_1988_program():
    known = {**SECTION_VII, "VAX": -10, "VAY": 20, "VBX": -20, "VBY": 45, "WAF": -2.9, "WBF": -1}
    with pytest.raises(UserError, match="leaves"):
        reconstruct(SECTION_VII, samples=0)[0].scene()
    scene = reconstruct({**known, "WA": 0}, samples=0)[0].scene()
    assert scene["UX"] == pytest.approx(-40.2083, abs=1e-3)
    assert scene["MU"] == pytest.approx(0.662, abs=1e-3)
    assert scene["M"] == 6
    again = reconstruct(scene, samples=0)[0]
    assert again.values["VAY"] == pytest.approx(20, abs=1e-6)


def test_forces_over_a_contact_time():
    values = reconstruct(REAR_END, samples=0, contact_time=0.1)[0].values
    assert values["FA"] == pytest.approx(950 * values["DVA"] / 0.1)
    assert values["FM3"] == pytest.approx(3 * values["FA"])
    with pytest.raises(UserError, match="contact time"):
        reconstruct(REAR_END, contact_time=0)


def test_a_plane_on_the_other_side_is_turned():
    known = {**SECTION_VII, "GA": 180}
    result = reconstruct(known, samples=0)[0]
    assert result.values["MUP"] == pytest.approx(0.662, abs=1e-3)
    assert "GA = 180 has each vehicle on the other's side" in result.remarks[0]


def test_friction_as_a_percentage_of_what_ends_the_sliding():
    scene = {n: x for n, x in SECTION_VII.items() if n[0] != "V" or n in ("VX", "VY")}
    scene |= {"UX": -36.667, "WA": 0, "VY": 58.667, "WB": 0, "E": 0.25, "EM": -0.9, "MU": "80 %"}
    values = reconstruct(scene, samples=0)[0].values
    assert values["MUP"] / values["MUC"] == pytest.approx(0.8)


def test_momentum_of_bodies_whose_dimensions_are_not_given():
    known = {n: x for n, x in SECTION_VII.items() if n[0] not in "IDP" or n == "DT"}
    result = reconstruct(known, samples=0)[0]
    assert result.values["UX"] == pytest.approx(-40.2083, abs=1e-3)
    assert "E" not in result.values
    with pytest.raises(UserError, match="E needs more"):
        reconstruct({**known, "E": 0.2})


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"MA": None}, "missing MA"),
        ({"XX": 3}, "XX"),
        ({"MU": 0.5}, "MU needs more: missing GA"),
        ({"ELA": 5}, "expected both, or EL"),
        ({"SAF": float("inf")}, "SAF is inf"),
    ],
)
def test_what_cannot_be_used(change, words):
    with pytest.raises(UserError, match=words):
        reconstruct({**INTERSECTION, **change})
