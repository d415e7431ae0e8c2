"""Collisions as their sources pose them: only what a result needs is asked, assumed or judged."""

import json
import math
import os
import re
import tomllib

import numpy as np
import pytest
from captures import ROOT
from longer import long_but

import impact88
from impact88.interface.commands.cli import main
from impact88.status import IMPOSSIBLE, Status

PROBLEMS = int(os.environ.get("IMPACT88_EXAMPLES") or 6)  # .ci/run takes more
SPEED_NAMES = ("UX", "UY", "VX", "VY", "SA", "SB", "SAF", "SBF")
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
        status = main(["reconstruct", str(path), "--json", "--samples", "0", *options])
        first = json.loads(capsys.readouterr().out)["solutions"][0]
        assert status == (first["no_impact"] is not None)
        return first

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


@pytest.mark.parametrize("turn", [0, 180])
@pytest.mark.parametrize("sheet", SHEETS, ids=lambda x: x["source"][-40:])
def test_solve_and_bounds_have_a_spreadsheet_with_ga_either_way_round(
    sheet, turn, tmp_path, capsys
):
    scene = {**sheet["scene"], "GA": sheet["scene"]["GA"] + turn}
    path = tmp_path / "sheet.toml"
    path.write_text("\n".join(f"{name} = {value!r}" for name, value in scene.items()))
    outputs = "WAF,DVA,STATUS"
    assert main(["solve", str(path), "--outputs", outputs, "--results-only"]) == 0
    told = capsys.readouterr()
    spin, change, status = map(float, told.out.splitlines()[-1].split(","))
    assert status == 0
    assert spin == pytest.approx(sheet["published"]["WAF"], rel=1e-12)
    assert change == pytest.approx(sheet["published"]["DVA"], rel=1e-12)
    is_turned = "is taken as" in told.err
    options = ["--set", "UX=+- .1", "--outputs", "DVA", "--samples", "50", "--json"]
    assert main(["bounds", str(path), *options]) == 0
    told = capsys.readouterr()
    assert ("is taken as" in told.err) == is_turned
    nominal = json.loads(told.out)["outputs"]["DVA"]["nominal"]
    assert nominal == pytest.approx(sheet["published"]["DVA"], rel=1e-12)


POINTS = "M = 4\nMA = 100\nMB = 50\nUX = 10\nUY = 0\nVX = 0\nVY = 0\nMU = 0"


@pytest.mark.parametrize("e", [0.3, -2])
@pytest.mark.parametrize(
    ("ga", "is_turned"),
    [(-180, False), (180, False), (0, True), (89, True), (91, False), (90, False)],
)
def test_every_command_has_the_same_side_of_a_plane_of_which_nothing_else_is_known(
    ga, e, is_turned, tmp_path, capsys
):
    path = tmp_path / "points.toml"
    path.write_text(f"{POINTS}\nE = {e}\nGA = {ga}")
    main(["solve", str(path), "--outputs", "STATUS", "--results-only"])
    told = capsys.readouterr()
    assert ("is taken as" in told.err) == is_turned
    assert bool(int(told.out.split()[-1]) & Status.SEPARATING) == (ga == 90)
    main(["bounds", str(path), "--range", "UX=9..11", "--outputs", "DVA", "--samples", "0"])
    assert ("is taken as" in capsys.readouterr().err) == is_turned
    main(["reconstruct", str(path), "--samples", "0"])
    assert ("is taken as" in capsys.readouterr().out) == is_turned


# -- random problems, with what is known removed entry by entry


def momentum(rng):
    """Point masses: masses, courses, speeds after; and what follows by momentum alone."""
    ma, mb = rng.uniform(800, 3000, 2)
    u, v = (complex(*rng.normal(0, 15, 2)) for _ in "AB")
    push = complex(*rng.normal(0, 10, 2)) * 1000
    after = u + push / ma, v - push / mb
    known = {"M": 4, "MA": ma, "MB": mb, "TA": "course", "TB": "course"}
    for name, velocity in zip(("A", "B"), (u, v), strict=True):
        known[f"H{name}"] = math.degrees(math.atan2(velocity.imag, velocity.real))
    for name, velocity in zip(("A", "B"), after, strict=True):
        known[f"S{name}F"] = abs(velocity)
        known[f"H{name}F"] = math.degrees(math.atan2(velocity.imag, velocity.real))
    return known, {"SA": abs(u), "SB": abs(v), "DVA": abs(push) / ma, "DVB": abs(push) / mb}


def locked(rng):
    ma, mb = rng.uniform(800, 3000, 2)
    u, v = (complex(*rng.normal(0, 15, 2)) for _ in "AB")
    common = (ma * u + mb * v) / (ma + mb)
    known = {"M": 4, "MA": ma, "MB": mb, "E": 0, "MU": "locked", "TA": "course", "TB": "course"}
    known |= {"UX": u.real, "UY": u.imag, "VX": v.real, "VY": v.imag}
    found = {"SAF": abs(common), "SBF": abs(common), "DVA": abs(common - u), "DVB": abs(common - v)}
    return known, found


def along_a_line(rng):
    ma, mb = rng.uniform(800, 3000, 2)
    speed, restitution, course = rng.uniform(5, 30), rng.uniform(0, 0.5), rng.uniform(-180, 180)
    known = {"M": 4, "MA": ma, "MB": mb, "SA": speed, "HA": course, "SB": 0, "E": restitution}
    known |= {"TA": "course", "TB": "course"}
    change = (1 + restitution) * speed / (ma + mb)
    found = {"DVA": mb * change, "DVB": ma * change, "SBF": ma * change, "PDOFA": 0, "PDOFB": 180}
    return known, found


def turned(known, found, degrees):
    """The same collision in axes turned by an angle."""
    new = dict(known)
    for name in ("HA", "HB", "HAF", "HBF", "GA"):
        if name in new:
            new[name] = math.remainder(new[name] + degrees, 360)
    turn = complex(math.cos(math.radians(degrees)), math.sin(math.radians(degrees)))
    for x, y in (("UX", "UY"), ("VX", "VY")):
        if x in new:
            velocity = complex(known[x], known[y]) * turn
            new |= {x: velocity.real, y: velocity.imag}
    return new, found


def mirrored(known, found):
    new = {n: -x if n[0] == "H" or n in ("UY", "VY") else x for n, x in known.items()}
    return new, found


EXCHANGED = {"UX": "VX", "UY": "VY", "VX": "UX", "VY": "UY"}


def exchanged(known, found):
    """A and B exchanged."""

    def other(name):
        letters = {"A": "B", "B": "A"}
        return EXCHANGED.get(name) or "".join(letters.get(letter, letter) for letter in name)

    return {other(n): x for n, x in known.items()}, {other(n): x for n, x in found.items()}


def best(known):
    return impact88.reconstruct({name: str(value) for name, value in known.items()})[0]


def assert_has(solution, found):
    for name, value in found.items():
        if name.startswith("PDOF"):
            assert abs(math.remainder(solution.values[name] - value, 360)) < 1e-6, name
        else:
            assert solution.values[name] == pytest.approx(value, rel=1e-7, abs=1e-7), name


@pytest.mark.parametrize("kind", long_but([momentum, locked, along_a_line], kept=(1,)))
def test_random_problems_in_any_axes_and_units(kind):
    rng = np.random.default_rng(88)
    for _ in range(PROBLEMS):
        known, found = kind(rng)
        assert_has(best(known), found)
        assert_has(best(turned(known, found, rng.uniform(-180, 180))[0]), found)
        assert_has(best(mirrored(known, found)[0]), found)
        assert_has(best(exchanged(known, found)[0]), exchanged(known, found)[1])
        speed = 3600 / 1000
        metric = {n: x * speed if n in SPEED_NAMES else x for n, x in known.items()}
        assert_has(best({**metric, "units": "metric"}), found)


@pytest.mark.parametrize("kind", long_but([momentum, locked, along_a_line], kept=(1,)))
def test_a_result_changes_only_if_it_uses_what_is_removed(kind):
    rng = np.random.default_rng(89)
    for _ in range(PROBLEMS):
        known, _ = kind(rng)
        whole = best(known)
        for name in known:
            less = {other: value for other, value in known.items() if other != name}
            try:
                solution = best(less)
            except impact88.UserError as error:
                text = str(error)  # too little is left, or no mass
                assert name in ("MA", "MB", "M") or re.search("determined|nothing", text), text
                continue
            for result, value in solution.values.items():
                if result in whole.values and result not in ("M", "TA", "TB"):
                    assert value == pytest.approx(whole.values[result], rel=1e-6, abs=1e-6), (
                        name,
                        result,
                    )
            if name in ("TA", "TB"):
                assert all(name in solution.absent[result] for result in ALONG_THE_CAR[name[1]])


@pytest.mark.parametrize("way", [0, 90, 180])
def test_what_is_left_open_is_shown_at_an_impact_that_physics_allows(way):
    """A of unknown speed runs into a standing B whose change of speed alone is known: of the two
    ways that B may have gone, one is an impact."""
    known = {"M": "4", "MA": "2500", "MB": "112", "HA": str(way), "SB": "0", "DVB": "44"}
    first = impact88.reconstruct(known)[0]
    assert not first.impossible
    along = {0: ("VBX", 44), 90: ("VBY", 44), 180: ("VBX", -44)}[way]
    assert first.values[along[0]] == pytest.approx(along[1])
