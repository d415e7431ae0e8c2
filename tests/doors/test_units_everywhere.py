"""One collision in four systems of units where `test_one_case` does not look: the same after
conversion."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
from installed import impact88
from unitscenes import SCENE, texts

from impact88.collision.casescene import sample
from impact88.collision.units import SYSTEMS, size_of
from impact88.interface.commands.cli import main
from impact88.mechanics.closedform.solve import solve
from impact88.names import quantity

Amounts = dict[str, float]
"""By what it is called: values in m, kg, s, degrees and rad/s."""


def si(name: str, value: float, unit: str) -> float:
    rule = quantity(name).unit
    if rule in ("1", "percent", "degree", "rad/time", "bits"):
        return value
    size = size_of(unit, rule) or size_of(unit.replace("-", " "), rule)
    assert size is not None, (name, unit)
    return value * float(size[0])


def toml(system: str, **more: str) -> str:
    entries = {**texts(system), **more}
    return f'units = "{system}"\n' + "".join(f'{n} = "{t}"\n' for n, t in entries.items() if t)


def headed(text: str) -> Amounts:
    """The first row of a CSV table."""
    head, row = list(csv.reader(io.StringIO(text)))[:2]
    found = {}
    for heading, cell in zip(head, row, strict=True):
        name, _, unit = heading.partition(" [")
        found[name] = si(name, float(cell), unit.rstrip("]"))
    return found


def named(values: Mapping[str, Any], units: Mapping[str, str]) -> Amounts:
    return {n: si(n, v, units.get(n, "")) for n, v in values.items() if isinstance(v, int | float)}


Door = Callable[[str, Path, Any], Amounts]


def _printed(capsys: Any, *words: str) -> str:
    assert main(list(words)) == 0
    return str(capsys.readouterr().out)


def solve_a_bare_table(system: str, path: Path, capsys: Any) -> Amounts:
    table, entries = path.with_suffix(".csv"), texts(system)
    table.write_text(",".join(entries) + "\n" + ",".join(entries.values()) + "\n")
    found = headed(_printed(capsys, "solve", str(table), "--units", system, "--results-only"))
    return found


def solve_json_lines(system: str, path: Path, capsys: Any) -> Amounts:
    out = path.with_suffix(".jsonl")
    assert main(["solve", str(path), "-o", str(out)]) == 0
    row = json.loads(out.read_text())
    pairs = [(*key.rstrip("]").partition(" [")[::2], value) for key, value in row.items()]
    return {name: si(name, value, unit) for name, unit, value in pairs}


def bounds(system: str, path: Path, capsys: Any) -> Amounts:
    ranges = [
        "--range",
        "UX=+- 5%",
        "--range",
        "MA=+- 2%",
        "--samples",
        "200",
        "--outputs",
        "DVA,LOSS",
    ]
    shown = json.loads(_printed(capsys, "bounds", str(path), *ranges, "--json"))
    found = {}
    for name, one in shown["outputs"].items():
        for key in ("nominal", "lower", "upper", "mean", "deviation"):
            found[f"{name} {key}"] = si(name, one[key], one["unit"])
        found |= {f"{name} at {n}": v for n, v in named(one["at_lower"], labels(system)).items()}
    return found


def labels(system: str) -> dict[str, str]:
    return {name: SYSTEMS[system].label(quantity(name).unit) for name in SCENE}


def reconstruct(system: str, path: Path, capsys: Any) -> Amounts:
    shown = json.loads(
        _printed(
            capsys, "reconstruct", str(path), "--set", "UX=+- 5%", "--samples", "200", "--json"
        )
    )
    (one,) = shown["solutions"]
    found = named(one["values"], one["units"])
    for name, spread in one["uncertainty"].items():
        for key in ("first_order", "mean", "lower", "upper"):
            found[f"{name} {key}"] = si(name, spread[key], one["units"][name])
    return found


def write_scene(system: str, path: Path, capsys: Any) -> Amounts:
    out = path.with_name("found.toml")
    assert main(["reconstruct", str(path), "--write-scene", str(out)]) == 0
    assert f'units = "{system}"' in out.read_text("utf-8")
    capsys.readouterr()
    return headed(_printed(capsys, "solve", str(out)))


def delta_v(system: str, path: Path, capsys: Any) -> Amounts:
    chosen = {name: texts(system)[name] for name in ("MA", "MB", "UX", "UY", "VX", "VY")}
    words = [word for n, t in chosen.items() for word in ("--set", f"{n}={t}")]
    shown = json.loads(
        _printed(capsys, "delta-v", *words, "--set", "LOSS=40", "--units", system, "--json")
    )
    return named(shown["given"], shown["units"]) | named(shown["estimates"][0], shown["units"])


def colinear(system: str, path: Path, capsys: Any) -> Amounts:
    speeds = {"MA": "UX", "UN": "UX", "UT": "UY", "VN": "VX", "VT": "VY"}
    entries = texts(system)
    chosen = {name: entries[like] for name, like in speeds.items() if name != "MA"}
    chosen |= {"MA": entries["MA"], "MB": entries["MB"], "E": ".1", "MUP": ".3"}
    words = [word for n, t in chosen.items() for word in ("--set", f"{n}={t}")]
    shown = json.loads(_printed(capsys, "colinear", *words, "--units", system, "--json"))
    return named(shown["values"], shown["units"])


def barrier(system: str, path: Path, capsys: Any) -> Amounts:
    names = ("MA", "IA", "DA", "PA", "TA", "GA", "E", "MU", "EM", "UX", "UY", "WA")
    words = [word for n in names for word in ("--set", f"{n}={texts(system)[n]}")]
    shown = json.loads(_printed(capsys, "barrier", *words, "--units", system, "--json"))
    return named(shown["solutions"][0]["values"], shown["solutions"][0]["units"])


def desk_bounds(system: str, path: Path, capsys: Any) -> Amounts:
    from impact88.interface.desk import collision

    values = {**texts(system), "MU": ".3 .. .5"}
    shown = collision.bounds_answer(values, system, draws=200)["outputs"]
    return {n: si(n, one["upper"], one["unit"]) for n, one in shown.items()}


DOORS: list[Door] = [
    solve_a_bare_table,
    solve_json_lines,
    bounds,
    reconstruct,
    write_scene,
    delta_v,
    colinear,
    barrier,
    desk_bounds,
]


@pytest.mark.usefixtures("brief_search")
@pytest.mark.parametrize("door", DOORS, ids=lambda door: door.__name__)
def test_every_system_gives_the_same(door: Door, tmp_path: Path, capsys: Any) -> None:
    answers = {}
    for system in SYSTEMS:
        path = tmp_path / f"{system}.toml"
        path.write_text(toml(system), encoding="utf-8")
        answers[system] = door(system, path, capsys)
    expected = answers.pop("si")
    assert len(expected) >= 5
    for found in answers.values():
        for name, value in expected.items():
            if name.split()[0] in ("COND", "STATUS"):
                continue
            close = 1e-9 if " " in name else 1e-12  # searched bounds end where searching ends
            assert found[name] == pytest.approx(value, rel=close, abs=1e-11), name


def test_a_contact_point_within_limits_is_refused_by_reconstruct(
    tmp_path: Path, capsys: Any
) -> None:
    path = tmp_path / "case.toml"
    path.write_text(toml("us", DA="", PA="", CAF="6.5..7.5 ft", CAL="-2.5 ft"), encoding="utf-8")
    assert main(["reconstruct", str(path)]) == 2  # as scene --help has it
    assert "limits for DA and PA" in capsys.readouterr().err


def test_the_oracle_takes_units_and_says_its_own() -> None:
    """The program is given base units; the answer names them."""
    given = {**sample(1), **{"units": "us", "UX": "-19.8 mph"}}
    done = impact88("oracle", "--no-reference", input=json.dumps({"scene": given}))
    assert done.returncode == 0
    answer = json.loads(done.stdout)
    assert answer["units"] == "ft, slug, s"
    assert float(answer["scene"]["UX"]) == pytest.approx(-29.04)
    assert float(answer["scene"]["MA"]) == pytest.approx(143.5 / 32.17404855643)
    expected = solve({name: float(text) for name, text in answer["scene"].items()}, ["VAX"])
    assert answer["results"]["VAX"]["double"] == pytest.approx(float(expected["VAX"]))
