"""Collisions as their sources pose them: only what a result needs is asked, assumed or judged."""

import json
import math
import tomllib

import pytest
from captures import ROOT

import impact88
from impact88.interface.commands.cli import main
from impact88.status import IMPOSSIBLE

PUBLISHED = ROOT / "golden" / "published"
TEN = json.loads((PUBLISHED / "public-collisions.json").read_text())
SHEETS = json.loads((PUBLISHED / "planar-spreadsheets.json").read_text())
ALONG_THE_CAR = {"A": {"PDOFA", "DVAF", "DVAR"}, "B": {"PDOFB", "DVBF", "DVBR"}}


@pytest.fixture
def solved(tmp_path, capsys):
    """The first solution that the command prints for the text of a file."""

    def solve(text, *options):
        path = tmp_path / "crash.toml"
        path.write_text(text)
        assert main(["reconstruct", str(path), "--json", "--samples", "0", *options]) in (0, None)
        return json.loads(capsys.readouterr().out)["solutions"][0]

    return solve


def agrees(name, value, published, tolerance):
    apart = value - published
    if name.startswith("H"):
        apart = math.remainder(apart, 360)
    return abs(apart) <= tolerance


@pytest.mark.parametrize("example", TEN, ids=lambda x: x["source"])
class TestPublicExamples:
    def test_is_solved_as_it_stands(self, example, solved):
        found = solved(example["scene"])
        for name, published in example["published"].items():
            value = found["values"][name]
            assert agrees(name, value, published, example["tolerance"][name]), (name, value)
        assert bool(found["status"] & IMPOSSIBLE) == example["impossible"]

    def test_nothing_along_a_car_whose_heading_is_not_given(self, example, solved):
        found = solved(example["scene"])
        for vehicle, names in ALONG_THE_CAR.items():
            assert names.isdisjoint(found["values"])
            assert all(found["absent"][name] == [f"T{vehicle}"] for name in names)
            assert (
                sum(f"needs T{vehicle}" in w or f"need T{vehicle}" in w for w in found["warnings"])
                == 1
            )

    def test_the_force_comes_from_where_the_source_has_it(self, example, solved):
        found = solved(example["scene"] + 'TA = "course"\nTB = "course"\n')
        for name, degrees in example["force_comes_from_clockwise_of_the_way_it_travels"].items():
            assert abs(math.remainder(found["values"][name] - degrees, 360)) < 0.05
        assert ALONG_THE_CAR["A"] | ALONG_THE_CAR["B"] <= {*found["values"]}

    def test_locked_is_a_word(self, example, solved):
        if "MU = -10" in example["scene"]:
            with_word = example["scene"].replace("MU = -10", 'MU = "locked"')
            assert solved(with_word)["values"] == solved(example["scene"])["values"]

    def test_a_vehicle_at_rest_has_no_course(self, example, solved):
        values = solved(example["scene"])["values"]
        for speed, course in (("SA", "HA"), ("SB", "HB"), ("SAF", "HAF"), ("SBF", "HBF")):
            if values[speed] == 0 and course not in example["scene"]:
                assert values.get(course) is None

    def test_python_has_the_same(self, example, solved):
        texts = {name: str(value) for name, value in tomllib.loads(example["scene"]).items()}
        found = impact88.reconstruct(texts)[0]
        units = solved(example["scene"])
        speed = {"mph": 5280 / 3600, "km/h": 1 / 3.6, "m/s": 1, "ft/s": 1}
        for name in ("SA", "SB", "SAF", "SBF"):
            expected = units["values"][name] * speed[units["units"][name]]
            assert found.values[name] == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("turn", [0, 180])
@pytest.mark.parametrize("sheet", SHEETS, ids=lambda x: x["source"][-40:])
def test_a_spreadsheet_is_met_to_12_digits_with_ga_either_way_round(sheet, turn, solved):
    scene = {**sheet["scene"], "GA": sheet["scene"]["GA"] + turn}
    found = solved("\n".join(f"{name} = {value!r}" for name, value in scene.items()))
    values = found["values"]
    values |= {
        "DVAX": values["VAX"] - scene["UX"],
        "DVAY": values["VAY"] - scene["UY"],
        "PN_size": abs(values["PN"]),
        "PT_size": abs(values["PT"]),
        "KI_minus_KF": values["KI"] - values["KF"],
        "P_t_over_P_n_size": abs(values["PT"] / values["PN"]),
        "critical_size": abs(values["MUC"]),
    }
    for name, published in sheet["published"].items():
        if name != "PDOFA":  # that sheet measures it otherwise
            assert values[name] == pytest.approx(published, rel=1e-12), name
    assert not found["status"] & IMPOSSIBLE
