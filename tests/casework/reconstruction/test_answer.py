"""Answers: exact values as measurements of no tolerance, NO IMPACT on both sides of its threshold,
first lines that are the same at every door. Numbers are worked by hand."""

from __future__ import annotations

import html
import json
import math
import re

import pytest
from longer import long_but

from impact88.casework.reconstruction.answer import answers
from impact88.casework.reconstruction.answerremarks import ILL_POSED, remarks_on
from impact88.casework.reconstruction.answertable import first_lines
from impact88.collision.geometry import clock
from impact88.collision.uncertain import skid_remarks
from impact88.errors import UserError
from impact88.interface.commands.cli import main

ALONG = {"M": "4", "MA": "100", "MB": "80", "HA": "0", "SB": "0", "SA": "10", "HAF": "0"}
SECTION_7 = {
    **{"MA": "96", "MB": "145", "IA": "1970", "IB": "3770", "DA": "4.5", "DB": "4", "GA": "0"},
    **{"PA": "0", "PB": "-40", "TA": "0", "TB": "90", "UY": "0", "VX": "0"},
    **{"VAX": "-10 +- 2", "VAY": "20 +- 2", "VBX": "-20 +- .01", "VBY": "45 +- 2"},
}


def struck(speed_after):
    """Return a car that strikes a standing one: by momentum A keeps 10 - .8 of B's speed after."""
    after = {"SAF": repr(10 - 0.8 * speed_after), "SBF": repr(speed_after), "HBF": "0"}
    return {**ALONG, **after}


def written(folder, known):
    path = folder / "known.toml"
    path.write_text("".join(f'{name} = "{text}"\n' for name, text in known.items()))
    return str(path)


class TestNoImpact:
    @pytest.mark.parametrize(("speed", "is_one"), [(11.1, True), (11.2, False)])
    def test_of_exact_values_what_gains_energy_is_none(self, speed, is_one, tmp_path, capsys):
        """The struck car leaves with 100/9 if nothing is lost."""
        path = written(tmp_path, struck(speed))
        assert main(["reconstruct", path]) == (not is_one)
        label, *words = capsys.readouterr().out.partition("ASKED")[0].split()[1:] or [""]
        assert (label == "IMPACT") != is_one
        gained = 50 * (10 - 0.8 * speed) ** 2 + 40 * speed**2 - 50 * 100
        assert (f"energy of {gained:.3g} is gained" in f"{label} {' '.join(words)}") != is_one
        (answer,) = answers(struck(speed), 0)
        assert (answer.solution.nearest is None) == is_one
        if not is_one:
            nearest = answer.solution.nearest.values
            assert nearest["LOSS"] == pytest.approx(0, abs=1e-3)
            assert f"SAF at {nearest['SAF']:.4g}, not 1.04" in answer.refusal()

    def test_every_exact_value_that_moves_is_named(self):
        """Equal cars that exchange momentum across: the nearest impact gains nothing, and courses
        turn as velocities do."""
        known = {"M": "4", "MA": "100", "MB": "100", "SA": "30", "HA": "0", "SB": "30", "HB": "90"}
        after = {"VAX": "-10", "VAY": "40", "VBX": "40", "VBY": "-10"}
        (answer,) = answers({**known, **after}, 0)
        nearest, told = answer.solution.nearest.values, answer.refusal()
        assert nearest["LOSS"] == pytest.approx(0, abs=1e-3)
        for name in ("SA", "SB", "HA", "HB", "VAX", "VAY", "VBX", "VBY"):
            given = {**known, **after}[name]
            assert f"{name} at {nearest[name]:.4g}, not {given}" in told

    @pytest.mark.parametrize("side", long_but(["-140", "220"]))
    def test_the_nearest_impact_is_the_same_from_either_side_of_the_plane(self, side):
        """An angle of the contact plane and the opposite one are the same plane."""
        known = {"M": "4", "MA": "100", "MB": "100", "HA": "0", "HB": "90", "GA": "40"}
        known |= {"SAF": "40", "HAF": "50", "SBF": "30", "HBF": "35"}
        (answer,), (other,) = answers(known, 0), answers({**known, "GA": side}, 0)
        assert answer.refusal() is not None
        assert other.refusal() == answer.refusal()

    def test_locked_vehicles_that_leave_on_two_courses_contradict_one_another(
        self, tmp_path, capsys
    ):
        """Equal cars whose common speed is 30 along 45 degrees, the middle of both courses."""
        known = {"M": "4", "MA": "100", "MB": "100", "HA": "0", "HB": "90", "E": "0"}
        after = {"MU": "locked", "SAF": "30", "HAF": "40", "SBF": "30", "HBF": "50"}
        assert main(["reconstruct", written(tmp_path, {**known, **after})]) == 1
        told = " ".join(capsys.readouterr().out.split())
        assert "these exact values contradict one another" in told
        assert "HAF (40 given, 50 by the others)" in told
        (answer,) = answers({**known, **after}, 0)
        assert answer.values["SA"] == pytest.approx(2 * 30 / math.sqrt(2), rel=1e-6)

    @pytest.mark.parametrize(
        ("digits", "verdict"), [(5, "agree poorly"), (3, "agree poorly"), (2, "contradict")]
    )
    def test_exact_values_that_were_rounded_agree(self, digits, verdict):
        """The speed before of a car that strikes a standing one, by momentum."""
        known = {"M": "4", "MA": "3000", "MB": "4000", "HA": "0", "SB": "0", "TB": "course"}
        after = {"SAF": "12", "SBF": "20", "HAF": "0", "HBF": "0"}
        speed = 12 + 20 * 4000 / 3000
        (answer,) = answers({**known, **after, "SA": f"{speed:.{digits}g}"}, 0)
        assert answer.evidence.verdict == verdict
        assert answer.is_adverse == (verdict == "contradict")
        assert answer.values["DVBF"] > 0  # struck from behind

    @pytest.mark.parametrize(("deviation", "is_beyond"), [("0.2", True), ("0.6", False)])
    def test_a_best_fit_beyond_a_limit_is_said(self, deviation, is_beyond):
        """Momentum gives A 38.67 with 4/3 of B's deviation, its own limits 36.2 to 38.2: the mean
        weighted by inverse variances lies beyond these or within, other impacts within both."""
        known = {"M": "4", "MA": "3000", "MB": "4000", "HA": "0", "SB": "0", "SA": "37.2 +- 1"}
        known |= {"SAF": "12", "HAF": "0", "HBF": "0", "SBF": f"normal 20 {deviation}"}
        weights = 3.0, (0.75 / float(deviation)) ** 2
        mean = (37.2 * weights[0] + (12 + 80 / 3) * weights[1]) / sum(weights)
        assert (mean > 38.2) == is_beyond
        (answer,) = answers(known, 2000)
        assert answer.draws is not None
        told = dict(first_lines(answer))["EVIDENCE"]
        assert (f"lies beyond limits: SA {mean:.4g}, not from 36.2 to 38.2" in told) == is_beyond

    def test_what_is_not_used_is_not_counted(self):
        known = {"M": "4", "MA": "3000", "MB": "4000", "HA": "0", "HB": "90"}
        known |= {"SAF": "30", "HAF": "40", "SBF": "30", "HBF": "50"}
        for extra, count in (({}, 8), ({"MU": "0.7"}, 8), ({"TA": "0"}, 9)):
            lines = dict(first_lines(answers({**known, **extra}, 0)[0]))
            assert lines["ASKED"] == f"SA and SB, from {count} exact values"

    def test_exact_values_that_test_one_another_agree(self):
        """All velocities are given: momentum tests them, and holds."""
        known = {"M": "4", "MA": "100", "MB": "50", "UX": "30", "UY": "0", "VX": "0", "VY": "20"}
        after = {"VAX": "20", "VAY": "5", "VBX": "20", "VBY": "10"}
        (answer,) = answers({**known, **after}, 0)
        assert "agree: momentum along x and momentum along y hold" in answer.evidence.text()
        free = {n: text for n, text in {**known, **after}.items() if n not in ("UX", "VY")}
        assert "not checked" in answers(free, 0)[0].evidence.text()

    def test_a_best_fit_beyond_given_limits_contradicts(self, tmp_path, capsys):
        """A standing car is struck: nothing lost, DVA is 2 MB SA / (MA + MB) = 34.29 at most."""
        known = {"M": "4", "MA": "3000", "MB": "4000", "SA": "30", "HA": "0", "SB": "0"}
        for speed, status in (("36 +- 1", 1), ("36 +- 2", 0)):
            path = written(tmp_path, {**known, "DVA": speed})
            assert main(["reconstruct", path, "--samples", "200"]) == status
            told = " ".join(capsys.readouterr().out.split())
            assert ("no impact lies within all limits" in told.lower()) == bool(status)
            assert ("DVA (36 measured, 34.29 by the others" in told) == bool(status)

    def test_a_coefficient_given_outside_its_range_is_the_users(self, tmp_path, capsys):
        known = {n: text for n, text in ALONG.items() if n not in ("SAF", "HAF")}
        path = written(tmp_path, known)
        assert main(["reconstruct", path, "--set", "E=1.5"]) == 1  # energy is gained, too
        assert main(["reconstruct", path, "--set", "E=.5"]) == 0
        assert main(["reconstruct", path, "--set", "E=-.5"]) == 0
        assert "IMPOSSIBLE" in capsys.readouterr().out.rpartition("AFTER")[0]

    @pytest.mark.parametrize(("speed", "status"), long_but([("9 +- .2", 0), ("13 +- .2", 1)]))
    def test_a_report_leads_with_it_and_has_its_status(self, speed, status, tmp_path, capsys):
        pytest.importorskip("jinja2")
        page = tmp_path / "x.html"
        known = {**struck(9.0), "SAF": "2.8 +- .2", "SBF": speed}
        path = written(tmp_path, known)
        assert main(["reconstruct", path, "--samples", "100", "--json"]) == status
        told = json.loads(capsys.readouterr().out)["solutions"][0]["no_impact"]
        assert (told is None) == (status == 0)
        assert main(["report", path, "-o", str(page), "--samples", "100"]) == status
        first = re.search("<dt.*?>(.*?)</dt>", page.read_text("utf-8"))[1]
        assert first == ("NO IMPACT" if status else "ASKED")


@pytest.mark.parametrize(("before", "hour"), [("0 +- 1", 6), ("0", 6), ("3 +- .5", 12)])
def test_a_car_that_may_have_stood_is_turned_by_no_adjustment(before, hour):
    """B is struck from behind; only one that drives against A at some speed is struck in front."""
    known = {"M": "4", "MA": "3000", "MB": "4000", "SA": "40 +- 1", "HA": "0", "SB": before}
    after = {"SAF": "12 +- 1", "HAF": "0", "SBF": "20 +- 1", "HBF": "0", "TB": "course"}
    if hour == 12:  # momentum: 3000 x 42.7 less 4000 x 3 is 3000 x 12 and 4000 x 20
        after["SA"] = "42.7 +- 1"
    (answer, *_) = answers({**known, **after}, 0)
    assert clock(answer.values["PDOFB"]) == f"{hour} o'clock"


@pytest.mark.parametrize(("speed", "spread"), [(1.5, 0.5), (0.4, 0.5), (6.0, 0.5)])
def test_a_course_known_within_limits_says_which_way_a_slow_car_faces(speed, spread):
    """B creeps along y and is struck from its left, 9 o'clock, however slow it is."""
    known = {"M": "4", "MA": "3000", "MB": "4000", "SA": "40 +- 1", "HA": "0"}
    known |= {"SB": f"{speed} +- {spread}", "HB": "90 +- 5", "TB": "course"}
    after = {"SAF": "17.1 +- 1", "HAF": "0 +- 2", "SBF": "17.3 +- 1", "HBF": "6 +- 20"}
    (answer, *_) = answers({**known, **after}, 0)
    assert clock(answer.values["PDOFB"]) == "9 o'clock"


def test_the_first_lines_are_the_same_at_every_door(tmp_path, capsys):
    pytest.importorskip("jinja2")
    pytest.importorskip("flask")
    from impact88.interface.desk import reconstruction

    known = {**SECTION_7, "VBX": "-20 +- 2"}
    (answer,) = answers(known, 0)
    lines = first_lines(answer)
    path, page = written(tmp_path, known), tmp_path / "x.html"
    assert main(["reconstruct", path, "--samples", "0"]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert main(["report", path, "-o", str(page), "--samples", "0"]) == 0
    reported = re.findall("<dd.*?>(.*?)</dd>", page.read_text("utf-8"))
    desk = reconstruction.answer(known, draws=0)["solutions"][0]["lines"]
    assert [text for _, text in lines] == [html.unescape(text) for text in reported]
    assert [text for _, text in lines] == [text for _, text, _ in desk]
    assert all(text in printed for _, text in lines)


def test_a_sure_value_is_named_last_among_those_at_odds():
    """Momentum along x: UX = VAX + 145/96 VBX. Any of the three may be wrong; VBX is sure."""
    (answer, *_) = answers({**SECTION_7, "UX": "normal -60 1"}, 0)
    at_odds = answer.evidence.at_odds
    assert [item.name for item in at_odds] == ["VAX", "UX", "VBX"]
    expected = {"UX": -10 - 145 / 96 * 20, "VAX": -60 + 145 / 96 * 20, "VBX": -50 * 96 / 145}
    for item in at_odds:
        assert item.expected == pytest.approx(expected[item.name], abs=0.01)
    deviations = {"VAX": 2 / 3**0.5, "UX": 1.0, "VBX": 0.01 / 3**0.5}
    moves = [abs(item.expected - item.measured) / deviations[item.name] for item in at_odds]
    assert moves == pytest.approx([abs(item.move) for item in at_odds])
    assert moves == sorted(moves)


def test_a_refusal_names_what_would_make_it_answerable():
    known = {"M": "4", "MA": "3000", "MB": "3500", "SAF": "20", "SBF": "25", "SB": "0"}
    with pytest.raises(UserError, match="give HAF and HBF"):
        answers(known, 0)
    (answer,) = answers({**known, "HAF": "0", "HBF": "0", "HA": "0"}, 0)
    assert answer.values["SA"] == pytest.approx(20 + 25 * 3500 / 3000)


@pytest.mark.parametrize(("tolerance", "is_poor"), [("2", False), ("5", True)])
def test_a_speed_is_poorly_determined_beside_the_largest_that_is_found(tolerance, is_poor):
    """Courses that nearly agree: 80 mph before, where no known speed is above 33."""
    known = {"M": "4", "MA": "3000", "MB": "4000", "HA": "0", "HB": "175", "SAF": "29", "SBF": "32"}
    known |= {"HAF": f"-3 +- {tolerance}", "HBF": f"3 +- {tolerance}"}
    (answer, *_) = answers(known, 0)
    largest = max(answer.values[name] for name in ("SA", "SB", "SAF", "SBF"))
    assert largest > 2 * 32
    said = [remark for remark in remarks_on(answer) if remark.startswith("poorly determined")]
    assert bool(said) == is_poor == (answer.deviations["UX"] > ILL_POSED * largest)


def test_what_would_do_as_well_as_a_coefficient_is_named():
    """A strikes a standing B along one line: E, or one speed after, leaves nothing open."""
    known = {name: text for name, text in ALONG.items() if name != "HAF"}
    (answer,) = answers(known, 0)
    assert dict(first_lines(answer))["NOT FOUND"] == "VAX, VBX, E: give E, SAF or SBF"
    for name, text in {"E": ".2", "SAF": "3", "SBF": "5"}.items():
        determined, *_ = answers({**known, name: text}, 0)
        assert not determined.undetermined


@pytest.mark.parametrize(
    ("other", "count"),
    [("skid 40 ft at .7 +- .1", 1), ("skid 40 ft at .7", 0), ("40 +- 5", 0), ("", 0)],
)
def test_two_skids_with_ranges_of_friction_are_said_to_be_independent(other, count):
    assert len(skid_remarks({"SAF": "skid 30 ft at .6 .. .8", "SBF": other})) == count


@pytest.mark.parametrize(("friction", "is_odd"), [("1.2", False), ("1.3", True), ("7 +- 1", True)])
def test_friction_that_no_road_has_is_remarked_upon(friction, is_odd):
    """A point left out of .7 makes the speed sqrt(10) times as high."""
    remarks = skid_remarks({"SAF": f"skid 30 ft at {friction}"})
    assert bool(remarks) == is_odd
    assert all(remark.startswith("SAF: ") for remark in remarks)
