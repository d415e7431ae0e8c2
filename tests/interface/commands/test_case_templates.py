"""Files by the field's names of a collision: each holds what its command needs, and solves."""

import tomllib

import pytest

from impact88.collision.scenefile import CASES
from impact88.interface.commands.cli import main

FILLED_IN = {
    "intersection": "MA=3000 MB=2000 HA=0 HB=-90 SAF=31 HAF=-40 SBF=19 HBF=-30",
    "rear-end": "MA=3000 MB=2000 SA=30 E=.2",
    "head-on": "MA=3000 MB=2000 SA=30 SB=20",
    "barrier": "MA=3000 IA=1900 DA=6 PA=0 E=.1 MU=.3 UX=-30",
    "planar": "E=.1 MU=locked DA=6 DB=6 GA=0 PA=0 PB=0 TA=0 TB=0 MA=3000 MB=2000 IA=1900 IB=1200 "
    "UX=-30 UY=1 VX=0 VY=0",
    "crush": "MA=3000 MB=2000 SA=30 SB=20 EL=90000",
}


@pytest.mark.parametrize("case", CASES)
def test_a_template_needs_what_is_filled_in_and_nothing_else(case, tmp_path, capsys):
    path = tmp_path / "crash.toml"
    assert main(["scene", "--template", case, "-o", str(path)]) == 0
    entries = tomllib.loads(path.read_text())
    to_fill_in = {name for name, value in entries.items() if value == ""}
    assert to_fill_in == {pair.partition("=")[0] for pair in FILLED_IN[case].split()}
    words = [word for pair in FILLED_IN[case].split() for word in ("--set", pair)]
    command = CASES[case].command.split()
    capsys.readouterr()
    assert main([*command, str(path), *words]) == 0
    told = capsys.readouterr()
    assert "IMPOSSIBLE" not in told.out
    assert "need" not in told.err
    assert "A unknown" not in told.out


def test_the_kinds_are_listed_and_units_chosen(capsys):
    assert main(["scene", "--template"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == [*CASES]
    assert main(["scene", "--template", "rear-end", "--units", "si"]) == 0
    assert "[m/s]" in capsys.readouterr().out
