"""MU as a share of the critical friction, at every door that takes a scene."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

import impact88
from impact88 import solve
from impact88.casework.reconstruction.answer import Answer
from impact88.casework.uncertainty.bounds import bounds
from impact88.casework.uncertainty.ranges import read_inputs
from impact88.collision.casescene import Scene, sample
from impact88.errors import UserError
from impact88.interface.commands.cli import main

CF11002 = {
    **{"DA": "4.14", "PA": "29", "TA": "0", "GA": "74.6", "MA": "3574.2", "IA": "2336.3"},
    **{"E": "0", "EM": "1", "MU": "85.18 %", "UX": "-39.95", "UY": "0", "WA": "0"},
}
"""Small overlap test of the IIHS in US units, as published with pycrash's validation."""


def json_of(capsys: pytest.CaptureFixture[str], *arguments: str) -> Any:
    assert main([*arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_the_small_overlap_test(capsys: pytest.CaptureFixture[str]) -> None:
    """Measured: 26.24 mph back, 7.29 lateral, spin 1.793."""
    given = [f"--set={name}={text}" for name, text in CF11002.items()]
    (solution,) = json_of(capsys, "chapter", "barrier", "--units", "us", *given)["solutions"]
    values = solution["values"]
    scale = 3600 / 5280 if solution["units"]["VAX"] == "ft/s" else 1.0
    assert (values["VAX"] - values["UX"]) * scale == pytest.approx(26.25, abs=0.005)
    assert (values["VAY"] - values["UY"]) * scale == pytest.approx(7.50, abs=0.005)
    assert values["WAF"] == pytest.approx(1.781, abs=0.0005)


@pytest.mark.parametrize("number", [1, 2, 3])
@pytest.mark.parametrize("share", [0, 85, 100, 120, -10])
def test_a_scene_has_the_share(number: int, share: int) -> None:
    scene = sample(number).replaced({"MU": f"{share} %"})
    found = {name: float(x) for name, x in solve(scene.numbers(), ("MUP", "MUC", "STATUS")).items()}
    assert found["MUP"] == pytest.approx(share / 100 * found["MUC"], rel=1e-12)
    assert found["STATUS"] == {120: 4096, -10: 8192}.get(share, 0)
    assert f"is {share} % of the critical friction" in scene.remarks["MU"]


def test_it_stays_the_share_when_the_scene_changes() -> None:
    lines = sample(1).to_toml().split("\n")
    lines = ['MU = "85 %"' if line.startswith("MU ") else line for line in lines]
    scene = Scene.from_toml_text("\n".join(lines), "scene.toml")
    faster = scene.replaced({"UX": "-60", "DA": "5"})
    assert faster["MU"] != scene["MU"]
    found = solve(faster.numbers(), ("MUP", "MUC"))
    assert float(found["MUP"]) == pytest.approx(0.85 * float(found["MUC"]), rel=1e-12)


def test_run_types_the_number(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "--sample", "1", "--set", "MU=85 %"]) == 0
    out, err = capsys.readouterr()
    assert " MU= .791869351 " in out
    assert "MU = 0.7918693504646898 is 85 % of the critical friction" in err


def test_a_table_has_shares_beside_numbers(tmp_path: Path) -> None:
    table, out = tmp_path / "in.csv", tmp_path / "out.npz"
    table.write_text("MU,UX\n85 %,-29\n.3,-29\n-10,-29\n40%,-60\n", encoding="utf-8")
    (tmp_path / "s.toml").write_text(sample(1).to_toml(), encoding="utf-8")
    arguments = ["--scene", str(tmp_path / "s.toml"), "--outputs", "MUP,MUC"]
    assert main(["solve", str(table), "-o", str(out), *arguments]) == 0
    with np.load(out) as loaded:
        found = dict(loaded)
        shares = found["MUP"] / found["MUC"]
        assert shares[[0, 3]] == pytest.approx([0.85, 0.4], rel=1e-12)
        assert found["MUP"][1:3].tolist() == [0.3, -10]
    # the listing types the number, too
    assert (
        main(["solve", str(table), "-o", str(out), *arguments[:2], "--arithmetic=applesoft"]) == 0
    )
    with np.load(out) as applesoft:
        assert applesoft["MUP"] == pytest.approx(found["MUP"], rel=1e-8)


def test_a_python_column_has_shares_beside_numbers() -> None:
    scene = sample(1).numbers()
    found = solve({**scene, "MU": ["85 %", ".3", -10, "85 %"], "UX": [-29, -29, -29, -60]})
    alone = solve({**scene, "MU": "85 %", "UX": -60.0})
    assert found["MUP"][1:3].tolist() == [0.3, -10]
    assert (found["MUP"] / found["MUC"])[[0, 3]] == pytest.approx(0.85, rel=1e-12)
    assert all(found[name][3] == alone[name] for name in found)
    assert float(alone["MUP"]) == abs(float(sample(1).replaced({"MU": "85 %", "UX": "-60"})["MU"]))


def test_a_share_of_scenes_that_lack_inputs() -> None:
    """What stands without an input is what the complete scene has, whatever the input is."""
    scene = {**sample(1).numbers(), "MU": ["85 %", 0.5]}
    for lacking in ("IA", "TB", "EM"):
        found = solve({name: value for name, value in scene.items() if name != lacking})
        assert found["MUP"][1] == 0.5
        assert np.isnan(found.pop("MUP")[0])
        complete = solve(scene)
        assert {"YA", "VC", "VS"} <= found.keys()
        assert "VAX" in found.absent
        assert all(complete[name] == pytest.approx(found[name]) for name in found)
    points = {name: scene[name] for name in ("MA", "MB", "UX", "UY", "VX", "VY", "E", "GA", "MU")}
    complete = solve({**scene, "M": 4}, ["DVA", "MUP"])
    for name, values in solve({**points, "M": 4}, ["DVA", "MUP"]).items():
        assert values.tolist() == complete[name].tolist()


def test_bounds_of_a_share() -> None:
    inputs = read_inputs({**sample(1), "MU": "80 .. 90 %"}, {"DA": "+- 1"}).values
    found = bounds(inputs, ["MUP"], samples=2000)
    nominal = float(solve(sample(1).numbers(), "MUC")["MUC"])
    assert found.bounds["MUP"].nominal == pytest.approx(0.85 * nominal)
    assert found.warnings == {}


def test_a_reconstruction_with_a_share(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = sample(3).replaced({"MU": "85 %"}).numbers()
    found = {name: float(value) for name, value in solve(scene).items()}
    initial = ("UX", "UY", "WA", "VX", "VY", "WB")
    known = {n: v for n, v in scene.items() if n not in (*initial, "MU", "M")}
    known |= {name: found[name] for name in ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF")}
    path = tmp_path / "after.toml"
    lines = [f"{name} = {value!r}" for name, value in known.items()]
    path.write_text("\n".join(['MU = "85 %"', *lines]) + "\n", encoding="utf-8")
    values = json_of(capsys, "reconstruct", str(path))["solutions"][0]["values"]
    for name in initial:
        assert values[name] == pytest.approx(scene[name], abs=1e-7)


def test_no_friction_to_have_a_share_of() -> None:
    rng = np.random.default_rng(3)
    for _ in range(300):
        change = {name: repr(float(rng.uniform(-80, 80))) for name in ("PA", "PB", "UX", "UY")}
        scene = sample(1).replaced(change)
        if float(solve({**scene.numbers(), "MU": -10.0}, "PN")["PN"]) < 0:
            with pytest.raises(UserError, match="no friction ends the sliding here"):
                scene.replaced({"MU": "85 %"})
            return
    pytest.fail("no such scene")


class TestInAReconstruction:
    """A share is a condition of each impact, with that impact's own critical friction."""

    RANGES: ClassVar[dict[str, str]] = {"GA": "-30 +- 5", "DA": "7.59 +- .5", "E": "0.005 .. .2"}

    def test_bounds_of_a_whole_scene_are_those_of_the_forward_problem(self):
        values = {**sample(1), **self.RANGES, "MU": "85 %"}
        forward = bounds(values, ["VAX", "WAF", "DVA"], samples=4000)
        (inverse,) = impact88.reconstruct(values)
        drawn = Answer(inverse, 4000, 0, ["VAX", "WAF", "DVA"])
        for name, bound in forward.bounds.items():
            width = bound.upper - bound.lower
            assert drawn.ranges[name].lower == pytest.approx(bound.lower, abs=1e-3 * width)
            assert drawn.ranges[name].upper == pytest.approx(bound.upper, abs=1e-3 * width)
            deviation = forward.spreads[name].deviation
            assert drawn.draws.spread(name, ()).deviation == pytest.approx(deviation, rel=0.1)
            assert drawn.deviations[name] == pytest.approx(deviation, rel=0.1)
