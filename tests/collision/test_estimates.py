"""Estimated yaw inertias, against the chapter's own vehicles and geometry worked out here."""

from __future__ import annotations

import statistics

import pytest

from impact88.casework.chapter.staged import collisions
from impact88.collision.case import Case, remark_lines
from impact88.collision.casescene import Scene, sample
from impact88.collision.estimates import CARS, with_estimates
from impact88.errors import UserError
from impact88.interface.commands.cli import main

G = 9.80665 / 0.3048
"""ft/s²"""


def scene_text(**changes):
    values = {**sample(1), **changes}
    return "\n".join(f'{name} = "{text}"' for name, text in values.items() if text is not None)


def estimated(**changes):
    return Scene.from_toml_text(scene_text(**changes), "s.toml")


class TestFromTheWeight:
    def test_table_1_is_met_within_what_the_documentation_says(self):
        errors = []
        for collision in collisions():
            for vehicle in "AB":
                mass, inertia = (float(collision.scene[key + vehicle]) for key in "MI")
                text = f"{mass * G} lb"
                found = estimated(units="us", MA=text, IA="estimate")
                errors.append(float(found["IA"]) / inertia - 1)
        assert len(errors) == 22
        assert -0.135 < min(errors) < -0.125
        assert 0.365 < max(errors) < 0.375
        assert abs(statistics.fmean(errors)) < 0.02

    def test_the_same_car_in_either_system(self):
        feet = estimated(units="us", MA="3100", IA="estimate")
        metres = estimated(units="metric", MA="3100 lb", IA="estimate")
        assert feet["IA"] == "1987"  # 1.03 x 3100 - 1206
        assert float(metres["IA"]) == pytest.approx(1987 * 4.4482216152605 * 0.3048, rel=5e-4)

    @pytest.mark.parametrize("weight", [CARS[0] - 1, CARS[1] + 1])
    def test_what_is_no_car_is_refused(self, weight):
        with pytest.raises(UserError, match="passenger car's, 1,500 to 6,000 lb"):
            estimated(units="us", MA=str(weight), IA="estimate")

    @pytest.mark.parametrize("weight", CARS)
    def test_the_lightest_and_the_heaviest_car(self, weight):
        found = estimated(units="us", MA=str(weight), IA="estimate")
        assert float(found["IA"]) == pytest.approx(1.03 * weight - 1206, rel=5e-4)

    def test_without_units_a_mass_has_no_weight(self):
        with pytest.raises(UserError, match=r's.toml: IA is to be estimated .* units = "us"'):
            estimated(IA="estimate")


class TestFromTheSize:
    def test_a_rectangle_in_any_units(self):
        for ia in ("estimate", None):
            found = estimated(MA="100", IA=ia, LA="15", BA="6")
            assert found["IA"] == "2175"  # 100 (225 + 36) / 12
            assert "LA" not in found
            assert found["IB"] == sample(1)["IB"]
        found = estimated(units="metric", MB="1500", IB="estimate", LB="450 cm", BB="1.8")
        assert float(found["IB"]) == pytest.approx(1500 * (4.5**2 + 1.8**2) / 12, rel=5e-4)

    def test_beside_a_known_inertia_it_is_an_outline(self):
        found = estimated(MA="100", LA="15", BA="6")
        assert found["IA"] == sample(1)["IA"]
        assert found.case.outlines == {"LA": 15.0, "BA": 6.0}
        assert not found.estimated

    @pytest.mark.parametrize(
        ("changes", "message"),
        [
            ({"LA": "15", "IA": None}, "BA is missing beside LA"),
            ({"BB": "6", "IB": None}, "LB is missing beside BB"),
            ({"IA": "estimate", "LA": "15", "BA": "0"}, "a number above 0 for BA"),
            ({"IA": "estimate", "LA": "15", "BA": "6", "MA": "much"}, "a number above 0 for MA"),
            ({"IA": "estimates"}, "IA = 'estimates' is n"),
        ],
    )
    def test_what_is_refused(self, changes, message):
        changes.setdefault("MA", "100")
        with pytest.raises(UserError, match=message):
            estimated(**changes)


class TestMarks:
    def test_a_scene_tells_its_estimates_and_a_change_ends_one(self):
        found = estimated(LA="15", BA="6", IA=None)
        assert list(found.estimated) == ["IA"]
        (line,) = (line for line in found.to_toml().splitlines() if line.startswith("IA = "))
        assert line.endswith("[mass·length²], estimated")
        assert not found.replaced({"IA": "2000"}).estimated
        assert found.replaced({"MU": ".5"}).estimated
        assert not sample(1).estimated

    @pytest.mark.parametrize(
        "command",
        ["run FILE", "solve FILE --sweep MU=0:1:3", "figure scene FILE -o x.svg", "bounds FILE"],
    )
    def test_every_command_says_so_and_the_result_stays_clean(
        self, command, tmp_path, monkeypatch, capsys
    ):
        monkeypatch.chdir(tmp_path)
        (tmp_path / "s.toml").write_text(scene_text(MA="100", IA=None, LA="15", BA="6"))
        words = command.replace("FILE", "s.toml").split()
        extra = ["--range", "MU=.5 .. .6"] if words[0] == "bounds" else []
        assert main([*words, *extra]) == 0
        shown = capsys.readouterr()
        assert "IA = 2175 is estimated: MA (LA² + BA²)/12, a uniform rectangle" in shown.err
        assert "estimated" not in shown.out

    @pytest.mark.usefixtures("brief_search")
    def test_a_reconstruction_takes_an_estimate_with_its_tolerance(self, tmp_path, capsys):
        known = [line for line in scene_text().splitlines() if line[:2] not in ("UX", "VX", "M ")]
        known += ['VAX = "-12.33"', 'VBX = "-6.8"', "LA = 16.5", "BA = 6.4"]
        text = "\n".join(line for line in known if line[:3] != "IA ") + '\nIA = "estimate +- 15%"\n'
        (tmp_path / "r.toml").write_text(text)
        assert main(["reconstruct", str(tmp_path / "r.toml"), "--outputs", "UX,VX", "--json"]) == 0
        shown = capsys.readouterr()
        assert "impact88: IA = 3745 +- 15% is estimated" in shown.err
        again = [
            "reconstruct",
            str(tmp_path / "r.toml"),
            "--set",
            "IA=estimate",
            "--outputs",
            "UX,VX",
        ]
        assert main(again) == 0
        assert "impact88: IA = 3745 is estimated" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("units", "mass", "inertia"), [("us", "lb", "lb-ft-s2"), ("metric", "kg", "kg-m2")]
)
def test_remarks_are_one_a_line_and_in_the_users_units(units, mass, inertia):
    weight = "3000 lb" if units == "us" else "1400"
    values = {**sample(1), "units": units, "MA": weight, "IA": "estimate", "UX": "4000"}
    values["TA"] = "77"
    remarks = remark_lines(Case(values).at_nominal().remarks)
    assert len(remarks) == len(set(remarks)) >= 3
    assert all("\n" not in remark and len(remark) < 200 for remark in remarks)
    (estimate,) = [remark for remark in remarks if "is estimated" in remark]
    assert f" {inertia} is estimated: " in estimate
    assert f"the mass in {mass}, less " in estimate


@pytest.mark.parametrize(("mass", "is_car"), [("100", True), ("1000", False)])
def test_of_a_vehicle_that_is_no_passenger_car_the_size_is_asked_and_the_tests_are_told(
    mass: str, is_car: bool
) -> None:
    """100 slug are 3,217 lb."""
    texts = {"MA": mass, "IA": "estimate"}
    if not is_car:
        with pytest.raises(UserError, match="6,000 lb, or LA and BA"):
            with_estimates(texts, "x", "chapter")
    _, rules, _ = with_estimates({**texts, "LA": "20", "BA": "8"}, "x", "chapter")
    assert ("this is none" in rules["IA"]) is not is_car
