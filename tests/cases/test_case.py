"""Files and mappings as cases: what is read, assumed, remarked and refused."""

import math
from pathlib import Path

import pytest

import impact88
from impact88.cases import TEMPLATES, Case, View, template
from impact88.cases.motion import line_of_motion
from impact88.errors import UserError

REAR_END = {"units": "us", "M": 4, "MA": 3000, "MB": 2000, "E": 0.2}
REAR_END |= {"UX": -30, "UY": 0, "VX": 10, "VY": 0}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("MA = 1\nMUU = 3", "line 2: 'MUU' is not an entry of a scene; did you mean MU?"),
        ('MA = 1\n\nUX = "25 lb"', "crash.toml, line 3: UX = '25 lb': lb is not a unit"),
        ("MA = .9", "a number with a digit first (0.9)"),
        ("MA = 1\nMA = 2\n", "Cannot overwrite a value (at line 2, column 7)"),
        ("MA = true", "crash.toml, line 1: MA = True: expected a number or a text"),
        ("[MA]\nvalues = 1", "crash.toml, line 1: MA = {'values': 1}: expected"),
        ("x=" + "[" * 1500, "expected NAME = VALUE"),
        ("x=" + "9" * 20_000, "is longer than 20,000 characters"),
        ('units = "imperial"', "units = 'imperial'; expected us, chapter, metric, si"),
        ('MB = 4\nMA = "3 lb"', "line 2: MA = '3 lb': MA is in lb; expected units = \"us\""),
        ("CAF = 3", "expected CAF and CAL, or DA and PA in their place"),
        ("CAF = 3\nCAL = 4\nPA = 3", "CAL, or DA and PA in their place"),
        ('UXX_source = "EDR"', "line 1: 'UXX_source' is not an entry of a scene"),
        ("SFA = 30", "'SFA' is not an entry of a scene; did you mean SAF?"),
        ('TA = "corse"', "course of TA TB"),
        ('SAF = "skid 60 ft at f=.7"', "friction, such as skid 60 ft at 0.7"),
        ('SAF = "skid 60 ft"', "expected distance, unit and friction, such as skid 60 ft at 0.7"),
        ('IA = "estimate"', "IA = estimate needs MA"),
        ('MA = 9\nLA = 15\nIA = "estimate"', "expected IA, or MA and LA and BA"),
        ('MA = 90\nIA = "estimate"', 'with units = "us"'),
    ],
)
def test_refused(text: str, message: str) -> None:
    with pytest.raises(UserError) as error:
        Case.loads(text, "crash.toml")
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_files(tmp_path: Path) -> None:
    path = tmp_path / "crash.toml"
    path.write_bytes("\ufefftitle = 'é'\r\nMU = 0.911\r\ndate = 1988-02-29".encode())
    case = Case.load(str(path))
    assert case.date == "1988-02-29"
    assert (case.title, case.texts) == ("é", {"MU": "0.911", "M": "6"})
    path.write_bytes(b"\xff\xfe\xff")
    with pytest.raises(UserError, match=r"crash\.toml"):
        Case.load(str(path))


def test_options_name_the_view_of_a_file_that_names_none() -> None:
    text = "UX = 30\nUY = 1"
    assert Case.loads(text, view=View("us", "sae")).view == View("us", "sae")
    assert Case.loads('units = "si"\n' + text, view=View("us")).view == View("si")
    with pytest.raises(UserError, match="axes = 'listingsae'; expected listing, sae"):
        Case.loads('axes = "listingsae"')
    assert Case.loads('axes = "listing"\n' + text, view=View(axes="sae")).view == View()
    assert Case.loads('TA = "0.5 rad"\nMB = "inf"').view == View()


def test_with_is_the_edited_file() -> None:
    case = Case.loads('units = "us"\nUX = 30\nDA = "5 ft"\nUX_source = "EDR"')
    changed = Case.of({"units": "us", "UX": "30 +- 2", "DA": "5 ft"})
    assert case.with_(UX="+- 2").entries == changed.entries
    assert case.with_(UX="+- 2").entries["UX"].high == pytest.approx(32 * 22 / 15)
    in_feet = Case.of({"units": "chapter", "UX": 44}).with_(UX="+- 2 mph")
    assert in_feet.entries["UX"].low == pytest.approx(44 - 2 * 22 / 15)
    assert case.with_(DA="+- 10 %").entries["DA"].low == 4.5
    with pytest.raises(UserError, match=r"UX = '28 .. 36 \+- 1' is not an amount"):
        case.with_(UX="28 .. 36").with_(UX="+- 1")
    assert "UX" not in case.with_(UX="").entries
    assert "UX_source" not in case.with_(UX="3").written
    with pytest.raises(UserError, match=r"^--set: UX = 'much' is not an amount"):
        case.with_("--set", UX="much")
    with pytest.raises(UserError, match=r"MB = '\+- 2' is not an amount"):
        case.with_(MB="+- 2")


@pytest.mark.parametrize("number", [1, 2, 3])
def test_published_scenes_reach_the_program_as_typed(number: int) -> None:
    scene = impact88.sample(number)
    case = Case.of(dict(scene))
    in_chapter = Case.of({**scene, "units": "chapter"})
    assert case.texts == in_chapter.texts == dict(scene)
    assert Case.loads(case.toml()).texts == case.texts


def test_estimate_is_for_passenger_cars() -> None:
    def of(weight: str, **more: str) -> Case:
        return Case.of({"units": "us", "MA": weight, "IA": "estimate", **more})

    assert of("1,500 lb").entries["IA"].value == 339
    assert of("6000").entries["IA"].value == 4974
    for weight in ("1,499 lb", "6001"):
        with pytest.raises(UserError, match="passenger cars of 1,500 to 6,000 lb"):
            of(weight)
    case = of("800", LA="10", BA="5")
    assert case.entries["IA"].value == float(f"{800 / 32.17405 * 125 / 12:.4g}")
    assert (case.derived, "a uniform rectangle" in case.remarks[0]) == (("IA",), True)
    amount = of("3000").with_(IA="+- 20 %").entries["IA"]
    assert (amount.low, amount.high) == (1507.2, 2260.8)


def test_course_and_contact_point() -> None:
    case = Case.of({"UX": 3, "UY": 3, "TA": "course", "TB": "course", "VX": 0, "VY": 0})
    assert case.texts["TA"] == "-135"
    assert math.isnan(case.entries["TB"].value)
    assert "TB" not in case.texts
    uncertain = Case.of({"UX": "3 +- 1", "UY": 3, "TA": "course"})
    assert math.isnan(uncertain.entries["TA"].value)
    assert uncertain.texts["TA"] == "-135"
    polar = Case.of({"CAF": 3, "CAL": -4})
    assert (polar.texts["DA"], polar.texts["PA"]) == ("5", "-53.13010235415598")
    polar = Case.of({"CAF": "3 +- 1", "CAL": 4})
    assert (polar.entries["CAF"].low, polar.texts["DA"]) == (2, "5")


def test_point_masses_need_no_dimensions_and_have_a_plane_across_their_line() -> None:
    case = Case.of(REAR_END)
    assert (case.texts["DA"], case.texts["IA"], "GA" in case.texts) == ("0", "1", False)
    assert "DA" not in case.numbers

    def plane(**changes: str) -> float | None:
        return line_of_motion(Case.of({**REAR_END, **changes}).entries)

    assert (plane(), plane(VX="20", UX="5"), plane(UX="20", VX="5")) == (0, 0, 180)
    courses = {"UX": "", "VX": "", "HA": "0", "HB": "0", "SB": "10"}
    after = {"SAF": "3", "HAF": "0"}
    assert plane(**courses, **after) == 180
    assert (plane(**courses, SA="5"), plane(**courses, **after, SA="0")) == (0, 0)
    assert (plane(UY="1"), plane(UY="0 +- 1"), plane(PDOFA="5")) == (None, None, None)


def test_friction_as_a_share_of_the_critical() -> None:
    scene = dict(impact88.sample(1))
    critical = float(impact88.solve({n: float(t) for n, t in scene.items()}, "MUC")["MUC"])
    case = Case.of({**scene, "MU": "85 %"})
    assert case.entries["MU"].share
    assert float(case.texts["MU"]) == pytest.approx(0.85 * abs(critical), rel=1e-12)
    assert any("85 % of the critical friction" in remark for remark in case.remarks)
    assert "MU" not in case.with_(GA="").texts


@pytest.mark.parametrize(
    ("changes", "remark"),
    [
        ({"MA": "199 kg"}, "no vehicle has that mass"),
        ({"MA": "61 t"}, "no vehicle has that mass"),
        ({"UX": "501 km/h"}, "no vehicle is as fast"),
        ({"WA": "-21"}, "WA = -21: no vehicle spins as fast"),
        ({"WA": "191 rpm"}, "no vehicle spins as fast"),
        ({"DA": "15.1 m"}, "more than 15 m"),
        ({"EM": "0"}, "no moment is EM = 1"),
        ({"TB": "46"}, "TB = 46: B moves more than 45° off the way it faces"),
        ({"IA": "374"}, "IA = 374: no vehicle has that radius of gyration"),
        ({"MA": "5 t", "IA": "180001"}, "IA = 180001: no vehicle has that radius of gyration"),
        ({"MA": "3,000 lb", "IA": "60616 lb-ft-s2"}, "radius of gyration"),  # lb-ft²
    ],
)
def test_plausibility(changes: dict[str, str], remark: str) -> None:
    plain = {"MA": "1500 kg", "UX": "499 km/h", "UY": "0", "DA": "14.9 m", "EM": "1", "WA": "-20"}
    angles = {"VX": "9", "VY": "0", "TB": "45", "TA": "180"}
    case = Case.of({"units": "metric", **plain, **angles, "IA": "2000"})
    assert not case.remarks
    assert not case.with_(IA="376").remarks
    assert not case.with_(MA="5 t", IA="179999").remarks
    assert any(remark in text for text in case.with_(**changes).remarks)


def test_correlations() -> None:
    case = Case.of({"correlations": "UX,VX 0.5; MA,IA 0.9"})
    assert case.correlations == {("UX", "VX"): 0.5, ("MA", "IA"): 0.9}
    with pytest.raises(UserError, match='expected such as "UX,VX 0'):
        _ = Case.of({"correlations": "UX 0.5"}).correlations


@pytest.mark.parametrize("kind", TEMPLATES)
def test_templates_are_read(kind: str) -> None:
    case = Case.loads(template(kind, "metric"))
    assert case.view.units == "metric"
    assert {*case.written} <= {*TEMPLATES[kind].entries, "units"}


def test_files_are_written_back() -> None:
    text = 'title = "a \\"b\\" \\\\ c"\nunits = "us"\nUX = "30 +- 2"\nUX_source = "EDR"\nSA = 31'
    case = Case.loads(text)
    assert Case.loads(case.toml()) == case
