"""`impact88 bounds` as a user meets it."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest
from installed import impact88

from impact88.collision.casescene import sample
from impact88.interface.commands import bounds_command as command
from impact88.interface.commands.cli import main
from impact88.mechanics.closedform.solve import solve

RANGES = ["--range", "MU=0.7 .. 1", "--range", "UX=+- 10%"]
DVA = ["--outputs", "DVA"]


@pytest.fixture
def scene_file(tmp_path):
    """Sample 1 as a file with ranges and a correlation in it."""
    text = sample(1).to_toml()
    text = re.sub(r"(?m)^MU = .*$", 'MU = "0.7 .. 1"', text)
    text = re.sub(r"(?m)^UX = .*$", 'UX = "normal -29.04 1.5"', text)
    path = tmp_path / "crash.toml"
    path.write_text(text + '\ncorrelations = "MU,UX 0.5"\n', encoding="utf-8")
    return str(path)


def answer(capsys, *arguments):
    """Status, stdout and stderr of a command."""
    status = main(["bounds", *arguments])
    out, err = capsys.readouterr()
    return status, out, err


def test_table(capsys):
    status, out, err = answer(
        capsys, "--sample", "1", *RANGES, "--outputs", "DVA,LOSS", "--samples", "2000"
    )
    assert (status, err) == (0, "")
    assert re.search(r"MU +0\.7 +1 +0\.85 +uniform", out)
    bounds_part = out[out.index("Bounds, and") : out.index("What drives")]
    row = next(line for line in bounds_part.splitlines() if line.startswith("DVA"))
    numbers = [float(cell.rstrip("*")) for cell in row.split()[1:-1]]
    nominal, lower, upper, *quantiles = numbers
    middle = solve({**sample(1).numbers(), "MU": 0.85}, "DVA")["DVA"]
    assert nominal == pytest.approx(middle, abs=0.005)
    assert lower < quantiles[0] < quantiles[-1] < upper
    assert quantiles == sorted(quantiles)
    assert row.endswith("ft/s")
    assert "percent" in out
    assert "attained" in out
    assert "not proven" in out
    assert max(map(len, out.splitlines())) <= 100


def test_json(capsys):
    status, out, _ = answer(
        capsys, "--sample", "1", *RANGES, "--samples", "2000", "--outputs", "dva,LOSS", "--json"
    )
    found = json.loads(out)
    assert status == 0
    assert list(found["outputs"]) == ["DVA", "LOSS"]
    loss = found["outputs"]["LOSS"]
    assert loss["unit"] == "percent"
    assert set(loss["at_lower"]) == set(loss["drives"]) == {"MU", "UX"}
    assert loss["lower"] <= loss["quantiles"]["0.05"] <= loss["quantiles"]["0.95"] <= loss["upper"]
    assert found["inputs"]["UX"]["limits"] == pytest.approx([-31.944, -26.136])
    assert found["samples"] == 2000


def test_json_has_no_nan(capsys):
    """MUP does not vary for a pivot: its rank correlation does not exist, JSON has null."""
    status, out, _ = answer(
        capsys, "--sample", "1", "--range", "MU=-10", "--range", "UX=+- 1", "--samples", "100",
        "--outputs", "MUP", "--json",
    )  # fmt: skip
    assert status == 0
    assert json.loads(out)["outputs"]["MUP"]["drives"]["UX"]["rank_correlation"] is None


def test_file_with_ranges(capsys, scene_file):
    status, out, _ = answer(capsys, scene_file, *DVA, "--sigmas", "2", "--json")
    found = json.loads(out)
    assert status == 0
    assert found["inputs"]["UX"]["kind"] == "normal"
    assert found["inputs"]["UX"]["limits"] == pytest.approx([-32.04, -26.04])
    assert found["correlations"] == [{"names": ["MU", "UX"], "correlation": 0.5}]


def test_file_from_standard_input(scene_file):
    text = Path(scene_file).read_text(encoding="utf-8")
    done = impact88("bounds", "-", *DVA, "--samples", "100", input=text)
    assert done.returncode == 0
    assert "normal" in done.stdout


def test_reconstruction_says_where_the_finals_come_from(capsys):
    status, out, err = answer(
        capsys, "--sample", "3", "--reconstruct", "--range", "VAX=+- 1", "--samples", "1000"
    )
    assert status == 0
    assert err == "impact88: from the forward solution: VAY VBX VBY WAF WBF MUP\n"
    row = next(line for line in out.splitlines() if line.startswith("SB"))
    assert float(row.split()[1]) == pytest.approx(58.667, abs=0.005)
    assert re.search(r"(?m)^WA +0 ", out)  # not -4E-17


def test_seed_decides(capsys):
    outs = [
        answer(capsys, "--sample", "1", *RANGES, *DVA, "--samples", "500", "--seed", seed)[1]
        for seed in ("4", "4", "5")
    ]
    assert outs[0] == outs[1] != outs[2]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ([], "expected one scene"),
        (["x.toml", "--sample", "1"], "expected one scene"),
        (["nowhere.toml"], "nowhere.toml: cannot be read"),
        (["--sample", "1"], "nothing varies"),
        (["--sample", "1", "--range", "UX"], "expected NAME=RANGE"),
        (["--sample", "1", "--range", "UX=1 .. x"], "UX = '1 .. x' is not an amount"),
        (["--sample", "1", "--range", "UX=2 .. 1"], "out of order"),
        (["--sample", "1", "--range", "UX=+-1", "--range", "ux=+-2"], "given twice"),
        (
            ["--sample", "1", "--range", "VAX=1 .. 2"],
            "'VAX' is not a value of the forward problem",
        ),
        (["--sample", "1", *RANGES, "--correlation", "UX,MU"], "expected A,B=R"),
        (["--sample", "1", *RANGES, "--correlation", "UX,VX=0.5"], "VX does not vary"),
        (["--sample", "1", *RANGES, "--correlation", "UX,MU=2"], "not a correlation"),
        (["--sample", "1", *RANGES, "--outputs", "XX"], "'XX' is not a result"),
        (["--sample", "1", *RANGES, "--samples", "0"], "too few"),
        (["--sample", "1", *RANGES, "--samples", "many"], "not a whole number"),
        (["--sample", "1", *RANGES, "--seed", "-1"], "--seed: '-1'"),
        (["--sample", "1", *RANGES, "--exclude", "NONSENSE"], "not a warning"),
        (["--sample", "1", "--range", "MA=-5 .. 0"], "no finite value at the nominal"),
        (["--sample", "3", "--reconstruct", "--range", "UX=+-1"], "reconstruction problem"),
    ],
)
def test_one_line_and_status_2(capsys, arguments, says):
    status, out, err = answer(capsys, *arguments)
    assert status == 2
    assert out == ""
    assert says in err
    assert err.count("\n") == 1
    assert err.startswith("impact88 bounds: ")


def test_unknown_key_names_the_file(capsys, scene_file):
    with open(scene_file, "a", encoding="utf-8") as file:
        file.write("WEIGHT = 3\n")
    status, _, err = answer(capsys, scene_file)
    assert status == 2
    assert scene_file in err
    assert "'WEIGHT' is not a name used here" in err


def test_an_entry_of_a_reconstruction_names_the_command_that_takes_it(capsys, scene_file):
    with open(scene_file, "a", encoding="utf-8") as file:
        file.write("SA = 3\n")
    status, _, err = answer(capsys, scene_file)
    assert status == 2
    assert "'SA' is not a name used here; reconstruct takes it" in err


def examples():
    """The commands under "examples" in the help, those that name no file of the user's."""
    text = (command.__doc__ or "").partition("examples:")[2]
    return [line.strip() for line in text.splitlines() if "--sample " in line]


def test_help_shows_the_notation(capsys):
    assert main(["bounds", "--help"]) == 0
    out = capsys.readouterr().out
    for form in ("0.7 .. 0.9", "+- 5%", "triangular", "normal 0.8 0.05 within", "correlations ="):
        assert form in out


@pytest.mark.parametrize("line", examples())
def test_examples_of_the_help_run(capsys, line):
    words = shlex.split(line)
    assert words[:2] == ["impact88", "bounds"]
    assert main([*words[1:], "--samples", "300"]) == 0
    assert "Bounds" in capsys.readouterr().out


def test_a_reconstruction_takes_friction_within_limits(capsys):
    """MUP "+- D" is around the forward solution's signed value."""
    options = ["--sample", "3", "--reconstruct", "--range", "MUP=+- .05", "--outputs", "UX"]
    assert main(["bounds", *options, "--samples", "200"]) == 0
    (line,) = [x for x in capsys.readouterr().out.splitlines() if x.startswith("MUP")]
    assert line.split()[1:4] == ["0.84", "0.94", "0.89"]
