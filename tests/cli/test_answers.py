"""The record of an answer, and the same digits of its numbers everywhere."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import pytest
from commands import command

import impact88
from cases import CRASH, FILES, IMPOSSIBLE, INTERSECTION, REAR_END, RECORDER
from impact88.cases.case import Case
from impact88.cases.units import View
from impact88.errors import UserError
from impact88.report.answers import ALL, ask
from impact88.report.rounding import decimals_in, round_number


def test_a_complete_scene_is_solved_forward() -> None:
    answer = ask(Case.loads(CRASH).with_(UX="-25", VY="40", E=".2"))
    assert answer.asked == "forward"
    assert answer.intervals == {}
    results = impact88.solve(answer.case.numbers, ["DVA", "LOSS"])
    assert answer.found["DVA"].value == pytest.approx(results["DVA"] / 88 * 60, rel=1e-12)
    assert answer.found["DVA"].text == "18.56"
    assert answer.found["LOSS"].unit == "%"


def test_tolerances_of_a_complete_scene_give_intervals() -> None:
    answer = ask(Case.loads(CRASH))
    assert answer.asked == "bounds"
    low, high = answer.intervals["DVA"]
    assert (low, high) == pytest.approx((16.55, 20.67), abs=0.1)  # quantiles that 0.3 published
    assert answer.found["DVA"].interval == f"{low:.1f} .. {high:.1f}"
    assert any(re.match(r"DVA .*: E 5\d %", text) for text in answer.sections["depends"])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (INTERSECTION, {"SA": "55.62", "SB": "63.21", "PDOFA": "-61.7", "DVB": "54.76"}),
        (REAR_END, {"DVA": "2.955", "DVB": "3.645", "SBF": "3.645"}),
        (RECORDER, {"DVA": "2.94", "DVB": "3.63", "E": "0.195"}),
    ],
)
def test_what_a_file_leaves_open_is_reconstructed(text: str, expected: dict[str, str]) -> None:
    answer = ask(Case.loads(text))
    assert answer.asked == "reconstruct"
    assert answer.possible
    assert {name: answer.found[name].text for name in expected} == expected


def test_meaning_of_a_heading_has_its_zero() -> None:
    meaning = "heading angle of A from the x axis; A faces TA + 180"
    assert View().meaning("TA") == View(axes="sae").meaning("TA") == meaning
    assert View(headings="compass").meaning("TA") == "heading angle of A clockwise from north"


@pytest.mark.parametrize("text", [INTERSECTION, CRASH])
def test_correlations_that_nothing_uses_are_refused(text: str) -> None:
    exact = {"UX": "-25", "VY": "40", "E": ".2"} if text == CRASH else {}
    case = Case.loads(text + '\ncorrelations = "XX,YY 0.5"').with_(**exact)
    with pytest.raises(UserError, match="correlations are those of a complete scene"):
        ask(case)


def test_what_contradicts_physics_is_not_possible() -> None:
    answer = ask(Case.loads(IMPOSSIBLE))
    assert not answer.possible
    assert "NO IMPACT" in answer.warnings[0]


def test_values_that_contradict_one_another_have_no_results() -> None:
    answer = ask(Case.loads(RECORDER).with_(DVB="6 +- .3"), ["DVA"])
    assert (answer.possible, answer.found, answer.scene) == (False, {}, {})
    assert "DVB 6 mph given" in answer.evidence


def test_a_result_of_a_reconstruction_is_given_or_refused() -> None:
    assert ask(Case.loads(REAR_END), ["COND"]).found["COND"].text == "3.000"
    answer = ask(Case.loads(INTERSECTION), ["SA", "COND"])  # the contact plane is not known
    assert any(remark.startswith("COND left out") for remark in answer.remarks)
    with pytest.raises(impact88.UserError, match="COND left out: not defined for this impact"):
        ask(Case.loads(INTERSECTION), ["COND"])


def test_exact_entries_are_given_not_found() -> None:
    answer = ask(Case.loads(REAR_END))
    assert "SA" not in answer.found
    assert (answer.given["SA"], answer.given["MA"]) == ("5.5", "950 kg")
    assert "SA" in ask(Case.loads(REAR_END), ALL).found


def test_tolerances_are_checked_against_each_other() -> None:
    sentences = ask(Case.loads(RECORDER)).sections["checked"]
    # the masses tie both changes of velocity; nothing checks SA, since E is open
    assert {text.split()[0] for text in sentences} == {"DVA", "DVB"}
    assert any(text.startswith("DVA 3.1 mph given, 2.8") for text in sentences)


def test_a_result_that_needs_more_is_left_out_and_says_why() -> None:
    scene = Case.loads("M = 4\nMA = 3\nMB = 2\nUX = -4\nUY = 3\nVX = 1\nVY = 2\nE = 0\nMU = -10")
    answer = ask(scene, ("DVA", "PN"))
    assert set(answer.found) == {"DVA"}
    assert any("PN" in remark and "GA" in remark for remark in answer.remarks)


@pytest.mark.parametrize("text", [CRASH, REAR_END])
def test_another_number_of_equations_is_named(text: str) -> None:
    with pytest.raises(impact88.UserError, match="6 for bodies or 4 for point masses"):
        ask(Case.loads(text).with_(M="5"))


def test_no_number_found_is_nan() -> None:
    for text in (CRASH, REAR_END, RECORDER, INTERSECTION):
        answer = ask(Case.loads(text), ALL)
        numbers = answer.found.values()
        assert all(math.isfinite(n.value) if n.ends is None else n.interval for n in numbers)


@pytest.mark.parametrize(
    ("value", "width", "text"),
    [
        (36.5141, 0.0, "36.51"),
        (36.5141, 6.6, "36.5"),  # half width 3.3: two digits
        (36.5141, 0.0062, "36.5141"),
        (36.5141, 2e-9, "36.5141"),  # two more decimals at most
        (-0.0004, 0.0, "-0.0004000"),
        (123456.0, 0.0, "123500"),
        (2.5e-12, 0.0, "2.500e-12"),
        (math.inf, 0.0, "inf"),
    ],
)
def test_one_rule_of_rounding(value: float, width: float, text: str) -> None:
    assert round_number(value, decimals_in("length", [value], width)) == text


@pytest.mark.parametrize("name", ["crash.toml", "rear.toml", "recorder.toml", "intersection.toml"])
def test_a_number_has_the_same_digits_everywhere(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(FILES[name], "utf-8")
    answer = ask(Case.load(str(tmp_path / name)), ALL)
    assert set(answer.found) <= set(ALL)
    text = command("solve", name, "--full", folder=tmp_path).out
    record = json.loads(command("solve", name, "--full", "--json", folder=tmp_path).out)
    command("report", name, "-o", "case.html", folder=tmp_path)
    page = (tmp_path / "case.html").read_text("utf-8")
    table = text.partition("\n\nCHECKED")[0].splitlines()
    rows = {line.split()[0]: line.split() for line in table if line[:1].isupper()}
    in_json = {number["name"]: number for number in record["found"]}
    assert page.count('<td class="n">') > 5
    for number in answer.found.values():
        assert number.text in rows[number.name][1:2] or not number.text
        assert in_json[number.name]["text"] == number.text
        assert in_json[number.name]["interval"] == number.interval
        cell = f'<b>{number.name}</b></td><td class="n">'
        assert f"{cell}{number.text}</td>" in page or cell not in page
