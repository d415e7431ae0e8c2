"""One file has one answer at every door: generated files with every kind of entry, taken by each
command, by the desk, by Python and by frames, in any units and directions."""

from __future__ import annotations

import csv
import io
import json
import math
import os
import random
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
from longer import long_but

import impact88
from impact88.collision.case import Case
from impact88.collision.scenefile import toml_texts
from impact88.interface.commands.cli import main
from impact88.interface.desk import collision
from impact88.interface.desk.formview import filled_in
from impact88.names import SCENE

FILES = int(os.environ.get("IMPACT88_CASES", "4"))
"""Generated files; 200 take some minutes."""
RESULTS = ("VAX", "VAY", "WAF", "VBX", "VBY", "WBF", "DVA", "DVB", "LOSS")

# sizes in m, kg and s, written down here once more: the test shares no code with `units`
METERS = {"ft": 0.3048, "in": 0.0254, "m": 1.0, "cm": 0.01, "mm": 0.001}
SPEEDS = {"mph": 0.44704, "ft/s": 0.3048, "km/h": 1 / 3.6, "m/s": 1.0}
POUND = 0.45359237
SLUG = POUND * 9.80665 / 0.3048
KILOGRAMS = {"lb": POUND, "slug": SLUG, "kg": 1.0, "t": 1000.0}
INERTIAS = {"lb-ft-s2": SLUG * 0.3048**2, "slug ft2": SLUG * 0.3048**2, "kg m2": 1.0}
SYSTEMS = {
    "us": ("ft", "mph", "lb", "lb-ft-s2"),
    "chapter": ("ft", "ft/s", "slug", "lb-ft-s2"),
    "metric": ("m", "km/h", "kg", "kg m2"),
    "si": ("m", "m/s", "kg", "kg m2"),
}
SIDES = {"us": ("ft in", "mph ft/s", "lb slug", "lb-ft-s2|slug ft2")}
SIDES |= {"chapter": SIDES["us"], "metric": ("m cm mm", "km/h m/s", "kg t", "kg m2")}
SIDES["si"] = SIDES["metric"]
KINDS = {
    "length": ("DA", "DB", "CAF", "CAL", "CBF", "CBL", "LA", "BA", "LB", "BB"),
    "speed": ("UX", "UY", "VX", "VY", "VAX", "VAY", "VBX", "VBY", "DVA", "DVB"),
    "mass": ("MA", "MB"),
    "inertia": ("IA", "IB"),
}
MIRRORED = ("UY", "WA", "VY", "WB", "GA", "PA", "PB", "TA", "TB", "VAY", "WAF", "VBY", "WBF")


def kind_of(name: str) -> int | None:
    """The place of what a value measures in the tables above."""
    return next((i for i, names in enumerate(KINDS.values()) if name in names), None)


def size(unit: str) -> float:
    return {**METERS, **SPEEDS, **KILOGRAMS, **INERTIAS}[unit]


class Generated:
    """A file, and what it says in m, kg, s and the listing's axes."""

    def __init__(self, seed: int) -> None:
        self.random = pick = random.Random(seed)
        self.system = pick.choice([*SYSTEMS])
        self.named = pick.random() < 0.7
        self.sae, self.compass = pick.random() < 0.3, pick.random() < 0.3
        heading = pick.choice([60.0, 85.0, 120.0])
        speed = pick.uniform(8, 25)
        self.values: dict[str, float] = {
            **{"E": pick.uniform(0.01, 0.3), "MU": pick.uniform(0.3, 0.7)},
            **{"EM": -pick.uniform(0.3, 0.9), "M": 6.0},
            **{"GA": pick.uniform(-20, 20), "PA": pick.uniform(-15, 15)},
            **{"PB": pick.uniform(-50, -30), "TA": pick.uniform(-5, 5), "TB": heading},
            **{"DA": pick.uniform(1, 2.4), "DB": pick.uniform(1, 2.4)},
            **{"MA": pick.uniform(1000, 2000), "MB": pick.uniform(1000, 2000)},
            **{"IA": pick.uniform(1500, 3000), "IB": pick.uniform(1500, 3000)},
            **{
                "UX": -pick.uniform(8, 25),
                "UY": pick.uniform(-1, 1),
                "WA": pick.uniform(-0.2, 0.2),
            },
            **{"VX": speed * math.cos(math.radians(heading)), "WB": pick.uniform(-0.2, 0.2)},
            "VY": speed * math.sin(math.radians(heading)),
        }
        self.texts: dict[str, str] = {"title": f"Case {seed}", "case": f"24-{seed}"}
        if self.named:
            self.texts["units"] = self.system
        if self.sae:
            self.texts["axes"] = "sae"
        if self.compass:
            self.texts["headings"] = "compass"
        for name in [*SCENE]:
            if name != "M" or pick.random() < 0.5:
                self.values[name], self.texts[name] = self.written(name, self.values[name])
        self._special(pick)
        for name in ("UX", "MA"):
            if pick.random() < 0.5:
                self.texts[f"{name}_source"] = 'data recorder, "page" 3'

    def shown(self, name: str, value: float) -> float:
        """A value in the listing's axes in the file's directions."""
        if self.compass and name in ("TA", "TB"):
            north = 0.0 if self.sae else 90.0
            return (north - value - (180.0 if name == "TA" else 0.0)) % 360.0
        return -value if self.sae and name in MIRRORED else value

    def meant(self, name: str, value: float) -> float:
        """The same the other way."""
        if self.compass and name in ("TA", "TB"):
            return (0.0 if self.sae else 90.0) - value - (180.0 if name == "TA" else 0.0)
        return -value if self.sae and name in MIRRORED else value

    def unit(self, name: str) -> str:
        """The unit of a bare number."""
        place = kind_of(name)
        return "" if place is None else SYSTEMS[self.system][place]

    def written(
        self, name: str, value: float, exact: bool = False, tolerance: float = 0.02
    ) -> tuple[float, str]:
        """A value with six digits as the file may have it, and what that text says."""
        pick, place = self.random, kind_of(name)
        unit = self.unit(name)
        amount = place is not None and (not self.named or pick.random() < 0.5)
        if amount:
            assert place is not None
            choices = SIDES[self.system][place]
            unit = pick.choice(
                choices.split("|") if "|" in choices or place == 3 else choices.split()
            )
        factor = size(unit) if unit else 1.0
        digits = float(f"{self.shown(name, value) / factor:.6g}")
        if name in ("M",):
            return value, "6"
        text = repr(digits)
        ending = f" {unit}" if amount else ""
        kind = (
            "exact"
            if exact or name in ("MU", "EM")
            else pick.choice(["exact", "exact", "range", "+-"])
        )
        meant = self.meant(name, digits * factor)
        if kind == "exact" or not digits:
            return meant, text + ending
        half = abs(float(f"{digits * tolerance:.3g}")) or 0.01
        if kind == "+-":
            return meant, f"{text}{ending} +- {half!r}{ending}"
        low, high = digits - half, digits + half
        return self.meant(name, (low + high) / 2 * factor), f"{low!r} .. {high!r}{ending}"

    def _special(self, pick: random.Random) -> None:
        """A share of the critical friction, an estimate, a contact point in a vehicle's axes."""
        self.share = 0.85 if pick.random() < 0.4 else None
        if self.share:
            self.texts["MU"] = "85 %"
        self.rectangle = pick.random() < 0.4
        if self.rectangle:
            for name, length in (("LA", 4.6), ("BA", 1.8)):
                self.values[name], self.texts[name] = self.written(name, length, exact=True)
            self.texts["IA"] = "estimate"
        if pick.random() < 0.4:
            for name, length in (("CBF", 1.1), ("CBL", -0.6)):
                self.values[name], self.texts[name] = self.written(name, length, exact=True)
            del self.texts["DB"], self.texts["PB"]

    def scene(self) -> dict[str, float]:
        """What is said, as `impact88.solve` takes it: m, kg, s and the listing's axes."""
        values = dict(self.values)
        if "CBF" in self.texts:
            values["DB"] = math.hypot(values["CBF"], values["CBL"])
            values["PB"] = math.degrees(math.atan2(values["CBL"], values["CBF"]))
        if self.rectangle:
            inertia = values["MA"] * (values["LA"] ** 2 + values["BA"] ** 2) / 12
            base = 1.0 if self.system in ("metric", "si") else INERTIAS["slug ft2"]
            values["IA"] = float(f"{inertia / base:.4g}") * base
        scene = {name: values[name] for name in SCENE}
        if self.share:
            scene["MU"] = 0.0
            critical = float(impact88.solve({**scene, "MU": -10.0}, "MUC")["MUC"])
            # line 400 gives MU its sign: of both the one whose P_t/P_n is the share
            wanted = self.share * critical
            scene["MU"] = min(
                (wanted, -wanted),
                key=lambda mu: abs(
                    float(impact88.solve({**scene, "MU": mu}, "MUP")["MUP"]) - wanted
                ),
            )
        return scene

    def file(self) -> str:
        quoted = {name: text.replace('"', '\\"') for name, text in self.texts.items()}
        return "".join(f'{name} = "{text}"\n' for name, text in quoted.items())

    def base(self, name: str, value: float, unit: str) -> float:
        """A shown value with the unit it is headed with, in m, kg, s and the listing's axes."""
        names = {"lb": "lb", "slug": "slug", "kg-m2": "kg m2"}
        factor = size(names.get(unit, unit)) if kind_of(name) is not None else 1.0
        return self.meant(name, value * factor)


def called(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """What a command prints."""
    status = main([*arguments])
    printed = capsys.readouterr()
    assert status == 0, (arguments, printed.err)
    return printed.out


def rows_of(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text)))


def in_base(made: Generated, row: Mapping[str, str]) -> dict[str, float]:
    """Results of a row of a table, by their headings."""
    values = {}
    for heading, cell in row.items():
        name, _, unit = heading.partition(" [")
        if name in RESULTS:
            values[name] = made.base(name, float(cell), unit.rstrip("]"))
    return values


def assert_same(found: Mapping[str, float], expected: Mapping[str, float], door: str) -> None:
    largest = max(abs(value) for value in expected.values())
    for name, value in expected.items():
        if name in found:
            assert found[name] == pytest.approx(value, rel=1e-9, abs=1e-9 * largest), (door, name)


@pytest.mark.parametrize("seed", long_but(range(FILES), kept=(0, 1)))
def test_one_file_has_one_answer(
    seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    made = Generated(seed)
    Path("case.toml").write_text(made.file(), encoding="utf-8")
    solved = impact88.solve(made.scene(), RESULTS)
    expected = {name: float(value) for name, value in solved.items()}

    (row,) = rows_of(called(capsys, "solve", "case.toml"))
    assert_same(in_base(made, row), expected, "solve")

    # Python: texts of the file; results in base units of its system
    scene = impact88.Scene.from_toml("case.toml")
    feet = 1.0 if made.system in ("metric", "si") else 0.3048
    for values in (scene, {n: t for n, t in made.texts.items() if n in (*SCENE, "units")}):
        if values is not scene and ("IA" not in values or made.rectangle or made.sae):
            continue
        if values is not scene and ("CBF" in made.texts or made.compass or is_uncertain(values)):
            continue
        python = impact88.solve(values, ["VAX", "DVA", "DVB"])
        found = {name: float(value) * feet for name, value in python.items()}
        assert_same(found, {name: expected[name] for name in found}, "Python")

    (frame,) = impact88.solve_frame([dict(scene)], scene=None, units=base_of(made))
    kept = {n: v for n, v in frame.items() if n.split(" ")[0] in ("VAX", "DVA", "DVB")}
    assert_same(in_base(plain(made), {n: str(v) for n, v in kept.items()}), expected, "frame")

    for option in ("--sweep", "--scene"):
        name = made.random.choice(["UX", "E", "DA"])
        bare = made.unit(name)
        low = float(f"{made.shown(name, made.values[name]) / (size(bare) if bare else 1):.3g}")
        edited = {**made.texts, name: f"{low!r} {bare}".strip()}
        Path("edited.toml").write_text(file_of(edited), encoding="utf-8")
        (one,) = rows_of(called(capsys, "solve", "edited.toml"))
        if option == "--sweep":
            unit = f" {bare}" if bare else ""
            sweep = f"{name}={low!r}{unit}:{low * 1.1!r}{unit}:2"
            other = rows_of(called(capsys, "solve", "case.toml", "--sweep", sweep))[0]
        else:
            heading = f"{name} [{bare}]" if bare else name
            Path("table.csv").write_text(f"{heading}\n{low!r}\n", encoding="utf-8")
            (other,) = rows_of(called(capsys, "solve", "table.csv", "--scene", "case.toml"))
        assert_same(in_base(made, other), in_base(made, one), option)

    if is_uncertain(made.texts):
        shown = ("bounds", "case.toml", "--samples", "20", "--json", "--outputs", "DVA,VAY")
        whole = json.loads(called(capsys, *shown))
        for name, part in whole["outputs"].items():
            found = {name: made.base(name, part["nominal"], part["unit"])}
            assert_same(found, {name: expected[name]}, "bounds")
    known = json.loads(called(capsys, "reconstruct", "case.toml", "--json", "--samples", "0"))
    record = known["solutions"][0]
    found = {n: made.base(n, v, record["units"][n]) for n, v in record["values"].items() if v}
    assert_same(found, {n: expected[n] for n in ("VAX", "VAY", "WAF", "DVA")}, "reconstruct")

    # the desk: opened, answered, saved and opened again
    opened = filled_in(made.file().encode(), "case.toml", SCENE)
    form = {**opened.get("extra", {}), **opened["values"]}
    told = collision.answer(form, opened["units"])
    assert not told["problems"], told["problems"]
    assert not told["missing"]
    answers = {r["name"]: made.base(r["name"], r["value"], r["label"]) for r in told["results"]}
    assert_same({n: answers[n] for n in expected}, expected, "desk")
    saved = collision.scene_file(form, opened["title"], opened["units"])
    again = filled_in(saved.encode(), "case.toml", SCENE)
    assert again == opened
    assert {n: t for n, t in toml_texts(saved, "").items() if n != "M" and t} == {
        n: t for n, t in made.texts.items() if n != "M"
    }


def file_of(texts: Mapping[str, str]) -> str:
    lines = {name: text.replace('"', '\\"') for name, text in texts.items()}
    return "".join(f'{name} = "{text}"\n' for name, text in lines.items())


def is_uncertain(texts: Mapping[str, str]) -> bool:
    return any(".." in text or "+-" in text for text in texts.values())


def base_of(made: Generated) -> str:
    return "si" if made.system in ("metric", "si") else "chapter"


def plain(made: Generated) -> Generated:
    """The same in the listing's axes."""
    other = Generated(0)
    other.sae = other.compass = False
    other.system = base_of(made)
    return other


KINDS_OF_CHANGE: dict[str, Callable[[Generated], tuple[str, str]]] = {
    "bare or amount": lambda made: ("UX", made.written("UX", -14.0, exact=True)[1]),
    "tolerance": lambda made: ("E", "0.2 +- 0.05"),
    "range": lambda made: ("GA", "1 .. 5"),
    "share": lambda made: ("MU", "75 %"),
    "mass of an estimate": lambda made: ("MA", made.written("MA", 1400.0, exact=True)[1]),
    "estimate": lambda made: ("IB", "estimate"),
}
COMMANDS = (
    "run {file}",
    "solve {file}",
    "bounds {file} --samples 20 --outputs DVA",
    "reconstruct {file} --samples 0 --json",  # draws take most of the time; `bounds` has some
    "figure scene {file} -o drawn.svg",
    "chapter delta-v {file} --like front --json",
    "report {file} --samples 20 -o page.html",
)


@pytest.mark.parametrize("seed", long_but(range(FILES), kept=(1,)))
def test_an_option_is_the_edited_file(
    seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    made = Generated(1000 + seed)
    if not is_uncertain(made.texts):
        made.texts["E"] = ".1 +- .02"
    change = [*KINDS_OF_CHANGE][seed % len(KINDS_OF_CHANGE)]
    name, text = KINDS_OF_CHANGE[change](made)
    for command in COMMANDS:
        said: list[Any] = []
        for texts, option in (
            (made.texts, ["--set", f"{name}={text}"]),
            ({n: t for n, t in {**made.texts, name: text}.items() if n != f"{name}_source"}, []),
        ):
            Path("case.toml").write_text(file_of(texts), encoding="utf-8")
            status = main([*command.format(file="case.toml").split(), *option])
            printed = capsys.readouterr()
            path = Path(command.split()[-1])
            drawn = path.read_text("utf-8") if path.exists() else ""
            drawn = drawn.partition("Inputs as given")[0]  # which names --set as the source
            said.append((status, printed.out, printed.err.replace("--set", "case.toml"), drawn))
        assert said[0] == said[1], (command, name, text)
        assert said[0][0] == 0 or command.startswith(("bounds", "reconstruct", "run")), said[0]


MIRROR = ("UY", "WA", "VY", "WB", "GA", "PA", "PB", "TA", "TB")


def turned(case: Case, names: tuple[str, ...], by: Callable[[float], float]) -> Case:
    return case.replaced({name: repr(by(float(case.texts[name]))) for name in names})


WRONG: dict[str, tuple[Callable[[Case], Case], str]] = {
    "velocities with y to the right": (lambda c: turned(c, ("UY", "VY"), lambda x: -x), "TB"),
    "angles clockwise": (lambda c: turned(c, MIRROR[4:], lambda x: -x), "TB"),
    "TA is where A faces": (lambda c: turned(c, ("TA",), lambda x: x + 180), "TA"),
    "headings in radians": (lambda c: turned(c, ("TA", "TB"), math.radians), "TB"),
    "compass bearings": (
        lambda c: turned(turned(c, ("TA",), lambda x: 270 - x), ("TB",), lambda x: 90 - x),
        "TA",
    ),
    "EM = 0 for no moment": (lambda c: c.replaced({"EM": "0"}), "EM"),
    "pounds as slugs": (lambda c: turned(c, ("MA", "MB"), lambda x: 32.174 * x), "MA MB"),
    "a European thousand": (lambda c: c.replaced({"MA": "1.548 kg"}), "MA"),
    "lb ft2 as slug ft2": (lambda c: turned(c, ("IA",), lambda x: 32.174 * x), "IA"),
    "inches as feet": (lambda c: turned(c, ("DA",), lambda x: 12 * x), "DA"),
}


@pytest.mark.parametrize("number", [1, 3])
@pytest.mark.parametrize("wrong", WRONG)
def test_a_wrong_convention_is_remarked(wrong: str, number: int) -> None:
    case = impact88.sample(number).case
    assert not impact88.Scene.of(case).remarks
    edit, name = WRONG[wrong]
    assert not {*name.split()}.isdisjoint(impact88.Scene.of(edit(case)).remarks)


def test_remarks_keep_to_their_thresholds() -> None:
    case = impact88.sample(1).case
    for name, inside, outside in (
        ("MA", "201 kg", "199 kg"),
        ("MA", "59.9 t", "60.1 t"),
        ("DA", "14.9 m", "15.1 m"),
        ("UX", "-499 km/h", "-501 km/h"),
        ("TB", "104.9", "105.1"),
        ("TB", "15.1", "14.9"),
        ("EM", "0.01", "0"),
    ):
        assert name not in impact88.Scene.of(case.replaced({name: inside})).remarks, inside
        assert name in impact88.Scene.of(case.replaced({name: outside})).remarks, outside
