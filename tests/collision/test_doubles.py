"""`doubles`: which texts are numbers, and the same ones for every command."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from impact88.apple.applesoft import decimaltext
from impact88.collision import uncertain
from impact88.collision.case import check_value
from impact88.collision.doubles import double, doubles, is_number
from impact88.errors import UserError
from impact88.interface.commands.cli import main
from impact88.tables.cells import TableUnits, numbers
from impact88.tables.rows import Rows

ODD = {".": 0.0, "1E": 1.0, "+": 0.0, "-": 0.0, "1 0": 10.0, " 7": 7.0, "E": 0.0, "1e2": 100.0}
NO_NUMBERS = ("", " ", "1_0", "nan", "inf", "infinity", "0x1", "１", "1.5.5", "1,5", "--1", "1E1.5")


@pytest.mark.parametrize(("text", "value"), ODD.items())
def test_what_INPUT_takes_is_a_number(text: str, value: float) -> None:
    assert double(text) == value
    assert doubles([text, "2"]) == [value, 2.0]


@pytest.mark.parametrize("text", NO_NUMBERS)
def test_what_INPUT_refuses_is_none(text: str) -> None:
    assert not is_number(text)
    with pytest.raises(ValueError, match="not a number"):
        double(text)
    with pytest.raises(ValueError, match="not a number"):
        doubles(["1", text])


@pytest.mark.parametrize("text", [*ODD, *NO_NUMBERS])
def test_every_room_takes_the_same_texts(text: str) -> None:
    taken = is_number(text)
    assert decimaltext.is_number(text.upper()) == taken
    for reads in (
        lambda: check_value("MA", text, "here"),
        lambda: uncertain.read(text, "MA"),
    ):
        if taken:
            reads()
        else:
            with pytest.raises(UserError):
                reads()
    rows = Rows(1, {"E": [text]})
    numbers(rows, TableUnits())
    assert (not rows.bad) == (taken or text == "inf")


@pytest.mark.parametrize("command", ["run --sample 1", "figure scene --sample 1 -o x.svg"])
@pytest.mark.parametrize("text", ["E=.", "mu=1 0", "e=1E"])
def test_commands_take_them(command: str, text: str, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main([*command.split(), "--set", text]) == 0


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_double_written_in_full_is_read_back(x: float) -> None:
    assert double(repr(x)) == x
    assert doubles([repr(x)]) == [x]


@given(st.text(alphabet="0123456789.+-eE _", max_size=12))
def test_one_text_is_the_same_number_alone_and_among_others(text: str) -> None:
    if is_number(text):
        assert doubles([text, "1"])[0] == double(text)


def test_past_the_range_is_infinite() -> None:
    assert double("1E400") == math.inf
    assert double("-1E400") == -math.inf
    assert double("1e-" + "9" * 400) == 0
