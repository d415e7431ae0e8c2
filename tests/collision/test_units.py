"""Values with units, against conversions written out here."""

from __future__ import annotations

import json
import math
from collections import Counter

import numpy as np
import pytest

from impact88 import solve
from impact88.casework.uncertainty.bounds import bounds
from impact88.collision.casescene import Scene, sample
from impact88.collision.uncertain import correlation_root, read
from impact88.collision.units import (
    SYSTEMS,
    UNITS,
    in_base,
    middle_of,
    reorient_text,
    size_of,
    system_of,
)
from impact88.errors import UserError
from impact88.interface.commands.cli import main

G = 9.80665 / 0.3048
"""ft/s²"""
RUN_1 = {name: float(text) for name, text in sample(1).items()}


def based(**texts):
    return in_base(texts, "file")[0]


DEGREE = math.pi / 180
SIZES = {
    "s": ("time", 1),
    "ms": ("time", 1e-3),
    "h": ("time", 3600),
    "ft": ("length", 0.3048),
    "in": ("length", 0.0254),
    "yd": ("length", 0.9144),
    "mi": ("length", 1609.344),
    "m": ("length", 1),
    "cm": ("length", 0.01),
    "mm": ("length", 0.001),
    "km": ("length", 1000),
    "mph": ("length/time", 0.44704),
    "fps": ("length/time", 0.3048),
    "kph": ("length/time", 1 / 3.6),
    "kn": ("length/time", 1852 / 3600),
    "lb": ("mass", 0.45359237),
    "lbf": ("mass·length/time²", 4.4482216152605),
    "slug": ("mass", 14.593902937206365),
    "oz": ("mass", 0.028349523125),
    "kg": ("mass", 1),
    "t": ("mass", 1000),
    "n": ("mass·length/time²", 1),
    "j": ("mass·length²/time²", 1),
    "kj": ("mass·length²/time²", 1000),
    "rad": ("degree", 1),
    "deg": ("degree", DEGREE),
    "rev": ("degree", 360 * DEGREE),
    "rpm": ("rad/time", 6 * DEGREE),
    "%": ("1", 0.01),
}
"""First symbol of a unit -> what it measures and its size in m, kg, s and radians, NIST SP 811."""


@pytest.mark.parametrize("unit", UNITS, ids=[unit.symbols.split()[0] for unit in UNITS])
def test_every_unit_has_the_size_of_its_definition(unit):
    first = unit.symbols.split()[0]
    assert first in SIZES, (
        f"{first} has a row in UNITS of collision/units.py and none here; next step: what it "
        "measures and its size, from its definition, in SIZES of tests/collision/test_units.py"
    )
    rule, size = SIZES[first]
    for symbol in unit.symbols.split():
        if symbol == "percent":  # it names what results are in
            continue
        known = size_of(symbol, rule)
        assert known, f"{symbol} is no unit of {rule}; next step: its row in collision/units.py"
        assert float(known[0]) == pytest.approx(size, rel=1e-15), (
            f"{symbol} has another size than SIZES says; next step: its row in UNITS of "
            "collision/units.py"
        )


@pytest.mark.parametrize(
    ("name", "rule"), [("DA", "length"), ("MA", "mass"), ("UX", "length/time")]
)
def test_what_is_measured_is_no_unit(name, rule):
    assert size_of(rule, rule) is None
    with pytest.raises(UserError, match="is not a unit"):
        based(units="us", **{name: f"4.5 {rule}"})


def test_every_definition_is_a_unit():
    for first in SIZES:
        known = any(first == unit.symbols.split()[0] for unit in UNITS)
        assert known, f"next step: a row for {first} in UNITS of collision/units.py"


def test_no_symbol_stands_for_two_units():
    symbols = Counter(symbol for unit in UNITS for symbol in unit.symbols.split())
    assert not [symbol for symbol, count in symbols.items() if count > 1]
    assert not [symbol for symbol in symbols if symbol != symbol.lower()]


class TestConversion:
    @pytest.mark.parametrize(
        ("name", "text", "expected"),
        [
            ("UX", "-25 mph", -25 * 5280 / 3600),
            ("MA", "3091 lb", 3091 / G),
            ("DA", "42 in", 3.5),
            ("IA", "2000 slug-ft2", 2000),
            ("WA", "90 deg/s", math.pi / 2),
            ("UX", "-90 km/h", -25),
            ("MA", "1.4 t", 1400),
            ("DA", "350 mm", 0.35),
            ("GA", "0.5 rad", math.degrees(0.5)),
        ],
    )
    def test_to_the_system_s_base(self, name, text, expected):
        assert float(based(**{name: text})[name]) == pytest.approx(expected, rel=1e-15)

    def test_a_number_that_needs_no_factor_keeps_its_digits(self):
        texts = based(UX="-36.66700 ft/s", DA="3.50 ft", E=".250")
        assert texts == {"UX": "-36.66700", "DA": "3.50", "E": ".250"}

    def test_an_exponent_of_nine_digits_is_not_worked_out(self):
        assert based(UX="1e-999999999 mph")["UX"] == "0"

    def test_a_named_system_gives_bare_numbers_their_unit(self):
        values, system = in_base({"units": "us", "UX": "-30", "MA": "3217.4048556", "E": ".1"}, "f")
        assert float(values["UX"]) == pytest.approx(-44)
        assert float(values["MA"]) == pytest.approx(100, rel=1e-9)
        assert values["E"] == ".1"
        assert system == "us"
        assert based(units="chapter", UX="-30", MA="100") == {"UX": "-30", "MA": "100"}
        assert float(based(units="metric", UX="36")["UX"]) == pytest.approx(10)
        assert float(based(units="us", DA="1 m")["DA"]) == pytest.approx(1 / 0.3048)

    def test_ranges_are_converted_as_a_whole(self):
        assert based(UX="-30 +- 3 mph")["UX"].split() == ["-44", "+-", "4.4"]
        texts = based(MA="3217.4048556 lb +- 5%", UX="normal 15 1.5 mph within 10 .. 20 mph")
        assert texts["MA"].endswith("+- 5%")
        assert [float(x) for x in texts["UX"].split() if x[0].isdigit()] == pytest.approx(
            [22, 2.2, 44 / 3, 88 / 3]
        )
        assert based(UX="normal 15 1.5 mph")["UX"].split() == ["normal", "22", "2.2"]

    @pytest.mark.parametrize(
        ("texts", "message"),
        [
            ({"UX": "-25 mph", "MA": "96"}, "some values have units and MA = 96 does not"),
            ({"UX": "-25 mph", "MA": "960 kg"}, "units of two systems"),
            (
                {"UX": "-25 lb"},
                "lb is not a unit of length/time; expected mph, ft/s, km/h, m/s",
            ),
            ({"units": "imperial", "UX": "1"}, "'imperial' is not a system of units"),
            (
                {"UX": "1.7e308 km/h", "MA": "1.7e308 t"},
                r"MA = 1\.7e308 t: too large for a double",
            ),
            ({"UX": "1e999999999 mph"}, "UX = 1e999999999 mph: too large for a double"),
        ],
    )
    def test_what_is_refused(self, texts, message):
        with pytest.raises(UserError, match=message):
            in_base(texts, "file")

    def test_shown_and_read_are_inverse(self):
        for system in SYSTEMS.values():
            for rule, name in _NAMES.items():
                value, _ = in_base({"units": system.name, name: f"12.5 {system.usual[rule]}"}, "f")
                assert system.display_value(rule, float(value[name])) == pytest.approx(12.5)
                assert size_of(system.usual[rule], rule)


_NAMES = {
    **{"length": "DA", "length/time": "UX", "mass": "MA", "mass·length²": "IA"},
    **{"mass·length²/time²": "EL", "rad/time": "WA", "degree": "GA"},
}


class TestFiles:
    def scene(self, tmp_path, **changes):
        """Run 1 with weights in lb and speeds in mph."""
        texts = {**sample(1), **changes}
        for name in ("UX", "UY", "VX", "VY"):
            texts[name] = repr(float(texts[name]) * 3600 / 5280)
        for name in ("MA", "MB"):
            texts[name] = repr(float(texts[name]) * G)
        lines = ['units = "us"', 'title = "at 25 mph"']
        path = tmp_path / "us.toml"
        path.write_text("\n".join([*lines, *(f'{n} = "{t}"' for n, t in texts.items())]))
        return str(path)

    def test_a_scene_in_mph_is_the_same_collision(self, tmp_path):
        scene = Scene.from_toml(self.scene(tmp_path))
        assert scene.units == "us"
        found = solve({n: float(t) for n, t in scene.items()})
        expected = solve(RUN_1)
        for name in ("VAX", "VBY", "WAF", "LOSS", "DVA"):
            assert float(found[name]) == pytest.approx(float(expected[name]), rel=1e-12)

    def test_the_program_gets_base_units(self, tmp_path, capsys):
        assert main(["run", self.scene(tmp_path), "--set", "UX=-19.8 mph"]) == 0
        assert "UX= -29.04 " in capsys.readouterr().out
        # a bare number is in the file's units
        assert main(["run", self.scene(tmp_path), "--set", "UX=-19.8"]) == 0
        assert "UX= -29.04 " in capsys.readouterr().out

    def test_results_come_in_the_units_that_went_in(self, tmp_path, capsys):
        path = self.scene(tmp_path)
        assert main(["reconstruct", path, "--json"]) == 0
        (us,) = json.loads(capsys.readouterr().out)["solutions"]
        expected = solve(RUN_1)
        assert us["values"]["VAX"] == pytest.approx(float(expected["VAX"]) * 3600 / 5280)
        assert us["units"]["VAX"] == "mph"
        assert us["values"]["MA"] == pytest.approx(143.5 * G)
        assert us["units"]["KI"] == "ft-lb"
        assert us["values"]["KI"] == pytest.approx(float(expected["KI"]))
        assert main(["reconstruct", path, "--set", "UX=-19.8 +- 1", "--samples", "200"]) == 0
        out = capsys.readouterr().out
        assert "mph" in out
        assert "length/time" not in out

    def test_units_option(self, tmp_path, capsys):
        car = "MA=3217.4 IA=2000 DA=4 PA=0 TA=0 GA=0 E=.1 MU=0 EM=-.5 UX=-30 UY=0 WA=0".split()
        settings = [part for pair in car for part in ("--set", pair)]
        assert main(["barrier", *settings, "--units", "us", "--json"]) == 0
        (found,) = json.loads(capsys.readouterr().out)["solutions"]
        assert found["values"]["VAX"] == pytest.approx(3.0)
        assert found["units"]["VAX"] == "mph"
        assert main(["barrier", *settings, "--units", "foot"]) == 2
        assert "not a system of units" in capsys.readouterr().err


class TestContactPoint:
    def test_in_a_vehicle_s_own_axes(self, tmp_path):
        lines = [f'{n} = "{t}"' for n, t in sample(1).items() if n not in ("DA", "PA", "DB", "PB")]
        lines += ["CAF = 7.0", "CAL = -2.5", "CBF = 2.5", "CBL = -2.0"]
        path = tmp_path / "own.toml"
        path.write_text("\n".join(lines))
        scene = {n: float(t) for n, t in Scene.from_toml(str(path)).items()}
        assert scene["DA"] * math.cos(math.radians(scene["PA"])) == pytest.approx(7.0)
        assert scene["DB"] * math.sin(math.radians(scene["PB"])) == pytest.approx(-2.0)
        path.write_text("\n".join([*lines, "DA = 3"]))
        with pytest.raises(UserError, match="DA and CAF are both given"):
            Scene.from_toml(str(path))
        path.write_text("\n".join(lines[:-1]))
        with pytest.raises(UserError, match="CBL is missing"):
            Scene.from_toml(str(path))
        # numbers as INPUT takes them: a bare E is a zero exponent
        path.write_text("\n".join([*lines[:-2], 'CBF = "3E"', 'CBL = "4."']))
        assert float(dict(Scene.from_toml(str(path)).items())["DB"]) == 5
        path.write_text("\n".join([*lines[:-2], 'CBF = "1e308"', 'CBL = "1.7e308"']))
        with pytest.raises(UserError, match="CBF CBL: the values known lead beyond"):
            Scene.from_toml(str(path))

    def contact(self, scene):
        """From A's and B's center of gravity, along x and y (line 330)."""
        a, b = (math.radians(scene["T" + v] + scene["P" + v]) for v in "AB")
        return (
            (-scene["DA"] * math.cos(a), -scene["DA"] * math.sin(a)),
            (scene["DB"] * math.cos(b), scene["DB"] * math.sin(b)),
        )

    def test_a_move_is_the_same_in_both_vehicles(self, capsys):
        assert main(["run", "--sample", "1", "--move-contact", "1,-.5", "--json"]) == 0
        printout = json.loads(capsys.readouterr().out)["printout"]
        words = printout.replace("=", "= ").split()
        values = {n: float(words[words.index(f"{n}=") + 1]) for n in ("DA", "DB")}
        angles = printout.split("GA\n")[1].split()
        moved = RUN_1 | values | {"PA": float(angles[0]), "PB": float(angles[1])}
        for before, after in zip(self.contact(RUN_1), self.contact(moved), strict=True):
            assert after == pytest.approx((before[0] + 1, before[1] - 0.5), abs=1e-6)
        assert main(["run", "--sample", "1", "--move-contact", "1,1", "--set", "TA=1E999"]) == 2
        assert "DA would be nan" in capsys.readouterr().err
        assert main(["run", "--sample", "1", "--move-contact", "1"]) == 2

    def test_bounds_of_a_real_move(self):
        """A foot in any direction: the issue's 15.0 to 16.8, not what four torn ranges give."""
        turn = np.linspace(0, 2 * np.pi, 721)
        (ax, ay), (bx, by) = self.contact(RUN_1)
        x, y = np.cos(turn), np.sin(turn)
        circle = RUN_1 | {
            "DA": np.hypot(ax + x, ay + y),
            "PA": np.degrees(np.arctan2(-(ay + y), -(ax + x))) - RUN_1["TA"],
            "DB": np.hypot(bx + x, by + y),
            "PB": np.degrees(np.arctan2(by + y, bx + x)) - RUN_1["TB"],
        }
        changes = solve(circle, "DVA")["DVA"]
        assert (changes.min(), changes.max()) == pytest.approx((15.0, 16.8), abs=0.1)
        box = {**RUN_1, "CX": read("0 +- 1", "CX"), "CY": read("0 +- 1", "CY")}
        found = bounds(box, ["DVA"], samples=200).bounds["DVA"]
        assert found.lower < changes.min() < changes.max() < found.upper
        assert found.upper - found.lower < 2.5
        corner = RUN_1 | {n: found.at_lower[n] for n in ()}
        dx, dy = found.at_lower["CX"], found.at_lower["CY"]
        corner |= {
            "DA": math.hypot(ax + dx, ay + dy),
            "PA": math.degrees(math.atan2(-(ay + dy), -(ax + dx))),
            "DB": math.hypot(bx + dx, by + dy),
            "PB": math.degrees(math.atan2(by + dy, bx + dx)) - 60,
        }
        assert float(solve(corner, "DVA")["DVA"]) == pytest.approx(found.lower, rel=1e-12)


class TestWhatIsExplored:
    """Bounds, sweeps and their figures: in the units that came in."""

    @pytest.fixture
    def us(self, tmp_path):
        """The first sample with its speeds in mph."""
        texts = dict(sample(1))
        for name in ("UX", "UY", "VX", "VY"):
            texts[name] = repr(float(texts[name]) * 3600 / 5280)
        path = tmp_path / "us.toml"
        chapter = {"MA": "slug", "MB": "slug"}
        lines = [
            f'{name} = "{t} {chapter.get(name, "")}"'.replace(' "', '"')
            for name, t in texts.items()
        ]
        path.write_text('units = "us"\n' + "\n".join(lines))
        return str(path)

    def test_bounds(self, us, capsys):
        assert main(["bounds", us, "--range", "UX=+- 2", "--outputs", "VAX", "--json"]) == 0
        shown = json.loads(capsys.readouterr().out)
        ux, vax = shown["inputs"]["UX"], shown["outputs"]["VAX"]
        assert ux["unit"] == vax["unit"] == "mph"
        assert ux["limits"] == pytest.approx([-21.8, -17.8])
        base = {**RUN_1, "UX": np.array([-21.8, -17.8]) * 5280 / 3600}
        low, high = sorted(solve(base, ["VAX"])["VAX"] * 3600 / 5280)
        assert (vax["lower"], vax["upper"]) == (pytest.approx(low), pytest.approx(high))
        assert vax["corner_lower"] == pytest.approx(low)
        assert vax["drives"]["UX"]["at_low"] == pytest.approx(low)
        assert low < vax["quantiles"]["0.5"] < high
        assert vax["at_lower"]["UX"] == pytest.approx(-21.8)
        assert main(["bounds", us, "--range", "UX=+- 2", "--outputs", "VAX"]) == 0
        assert "mph" in capsys.readouterr().out

    def test_a_sweep_takes_the_file_s_units_and_its_table_names_them(self, us, capsys):
        line = ["solve", us, "--outputs", "VAX", "--sweep"]
        for sweep in ("UX=-30:-15:2", "UX=-30 mph:-22 ft/s:2"):
            assert main([*line, sweep]) == 0
            shown = capsys.readouterr()
            rows = [float(row.split(",")[0]) for row in shown.out.splitlines()[1:]]
            assert rows == pytest.approx([-30, -15])
            assert shown.out.startswith("UX [mph],VAX [mph]\n")
            assert shown.err.startswith("impact88: IA and IB without a unit: read as slug ft2")
        assert main([*line, "UX=-30 lb:-15:2"]) == 2
        assert "lb is not a unit of length/time" in capsys.readouterr().err


@pytest.mark.parametrize("system", ["us", "chapter", "metric", "si"])
@pytest.mark.parametrize("number", [1, 2, 3])
def test_a_published_run_shown_in_other_units_is_the_same_collision(number, system):
    """Feet are not metres: what is without a unit comes out the same, speeds by their ratio."""
    case = sample(number).case
    shown = Scene.of(case.shown_in(system))
    one, two = (solve(scene.numbers(), ["LOSS", "DVA", "KI"]) for scene in (sample(number), shown))
    feet = system in ("us", "chapter")
    assert two["LOSS"] == pytest.approx(one["LOSS"], rel=1e-12)
    assert two["DVA"] == pytest.approx(one["DVA"] * (1 if feet else 0.3048), rel=1e-12)
    assert two["KI"] == pytest.approx(one["KI"] * (1 if feet else 1.3558179483314), rel=1e-12)


@pytest.mark.parametrize(
    ("text", "sign", "offset", "expected"),
    [("30", 1, 180, "210"), ("10", -1, 90, "80"), ("-.5", -1, 0, ".5"), ("0", -1, 90, "90")],
)
def test_an_angle_is_turned_and_offset(text, sign, offset, expected):
    assert reorient_text("TA", text, sign, offset) == expected


@pytest.mark.parametrize(
    ("text", "middle"), [("-30 .. -20", "-25"), ("-10 .. 20 deg", "5 deg"), ("-10 +- 2", "-10")]
)
def test_the_middle_of_limits_keeps_their_signs(text, middle):
    assert middle_of("TA", text, system_of("us"), "file") == middle


def test_a_normal_ends_so_many_deviations_from_its_mean_or_at_its_limits():
    assert read("normal 1 .1", "E").limits(3.0) == pytest.approx((0.7, 1.3))
    assert read("normal 1 .1 within .9 .. 2", "E").limits(3.0) == pytest.approx((0.9, 1.3))


def test_a_chain_of_correlations_names_all_three():
    inputs = {name: read("1 +- .1", name) for name in ("E", "MU", "UX", "UY")}
    names, root = correlation_root({("E", "MU"): 0.5, ("MU", "UX"): 0.25}, inputs)
    assert names == ["E", "MU", "UX"]
    assert root.T @ root == pytest.approx(np.array([[1, 0.5, 0], [0.5, 1, 0.25], [0, 0.25, 1]]))
