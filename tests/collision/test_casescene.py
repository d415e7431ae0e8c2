"""Scenes: the digits as typed, and files whose errors say where and what."""

from __future__ import annotations

import pytest
from guide import guide

from impact88.casework.figures.scenegeometry import plan
from impact88.collision.casescene import Scene, published_data, sample
from impact88.collision.scenefile import SIGNS, template
from impact88.errors import UserError
from impact88.interface.commands.cli import main
from impact88.mechanics.closedform.solve import solve
from impact88.names import SCENE

COMPLETE = sample(1).to_toml()


def read(text: str) -> Scene:
    return Scene.from_toml_text(text, "crash.toml")


def with_line(name: str, line: str) -> str:
    """The complete file with one entry's line replaced."""
    return "\n".join(line if row.startswith(f"{name} =") else row for row in COMPLETE.splitlines())


def test_the_listings_own_data():
    assert published_data() == {
        "E": "0.005",
        "MU": "0.911",
        "EM": "-0.715",
        "DA": "7.59",
        "DB": "3.44",
        "GA": "-30.0",
        "PA": "-19.8",
        "PB": "-38.7",
        "TA": "0.0",
        "TB": "60.0",
        "MA": "143.5",
        "MB": "95.8",
        "IA": "3728",
        "IB": "1961",
        "M": "6",
    }


@pytest.mark.parametrize("number", [1, 2, 3])
def test_a_sample_survives_its_file(number):
    scene = sample(number)
    assert dict(read(scene.to_toml())) == dict(scene)
    assert read(scene.to_toml()).title == scene.title


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("UX = 90315.88170", "90315.88170"),
        ("UX = 90315.8817 # typed", "90315.8817"),
        ('UX = ".911"', ".911"),
        ('UX = "5."', "5."),
        ("UX = 1e5", "1e5"),
        ("UX = +7", "+7"),
        ("'UX' = 3", "3"),
        ("UX = 1E39", "1E39"),
    ],
)
def test_digits_are_kept_as_typed(line, text):
    assert read(with_line("UX", line))["UX"] == text


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("UX = .911", ["line", "UX = .911", '0.911 or ".911"']),
        ("UX = 5.", ["line", '5.0 or "5."']),
        ("UX = 1 2", ["line", 'write "1 2"']),
        ("UX =", ["line", "UX has no value"]),
        ("UX = true", ["line", "UX is a truth value", "number"]),
        ("UX = [1]", ["UX is a list"]),
        ("UX = {a = 1}", ["UX is a table"]),
        ("UX = 2020-01-01", ["UX is a date"]),
        ("UX = inf", ["UX = inf"]),
        ("UX = nan", ["UX = nan"]),
        ("UX = 1_000.5", ["UX = 1_000.5"]),
        ("UX = 1_000", ["UX = 1_000"]),
        ("UX = 0x10", ["UX = 0x10"]),
        ('UX = "12X"', ["UX", "12X", "not a unit of length/time"]),
        ('UX = ""', ["UX"]),
        ("", ["missing UX", "initial x velocity of A"]),
        ("UX = 1\nUX = 2", ["UX is given twice", "line"]),
        ("UX = 1\nspeed = 2", ["'speed' is not a value of a scene"]),
        ("UX = 1\nux = 2", ["did you mean UX"]),
        ("UX = 1\n[part]", ["part is a table"]),
        ("UX = 1\nwhat is this", ["line"]),
        ('UX = 1\ntitle2 = """', ["several lines"]),
        ("UX = 1\n[UX]\nvalue = 2", ["UX is given twice", "line"]),
        ("UX = {value = 0x1F, source = 'a, b'}", ["UX = 0x1F", "INPUT"]),
        ("UX = 1\na.b = 3", ["line", "NAME = VALUE"]),
        ("10 PRINT 1", ["is a BASIC program"]),
    ],
)
def test_what_a_file_gets_wrong_is_said(line, words):
    with pytest.raises(UserError) as caught:
        read(with_line("UX", line))
    message = str(caught.value)
    assert message.startswith("crash.toml")
    assert "\n" not in message
    for word in words:
        assert word in message


def test_a_byte_order_mark_and_windows_line_ends(tmp_path):
    path = tmp_path / "crash.toml"
    path.write_bytes(b"\xef\xbb\xbf" + COMPLETE.replace("\n", "\r\n").encode())
    assert dict(Scene.from_toml(str(path))) == dict(sample(1))


def test_m_defaults_to_six():
    rows = [row for row in COMPLETE.splitlines() if not row.startswith("M ")]
    assert read("\n".join(rows))["M"] == "6"


def test_the_template_names_everything_once_and_must_be_filled_in():
    text = template()
    for quantity in SCENE.values():
        assert sum(row.startswith(f"{quantity.name} =") for row in text.splitlines()) == 1
        assert quantity.meaning in text
        assert quantity.unit in text
    with pytest.raises(UserError, match="missing E"):
        read(text)


def test_typed_lines_and_keyboard_are_what_one_would_type():
    scene = sample(2)
    assert scene.typed_lines() == [
        "280 E = 0.005:MU = 0.911:EM = -0.715",
        "290 DA = 0:DB = 0:GA = -30.0:PA = -19.8:PB = -38.7:TA = 0.0:TB = 60.0",
        "310 MA = 143.5:MB = 95.8:IA = 3728:IB = 1961",
        "350 N = 6:M = 4",
    ]
    assert scene.keyboard() == ["-29.04,0,0", "14.52,25.15,0"]


def test_a_scene_refuses_numbers_that_are_not_text():
    with pytest.raises(UserError, match="text"):
        Scene.from_mapping({**sample(1), "UX": 1.5})


def test_signs_are_told_where_a_scene_is_filled_in(capsys, monkeypatch):
    """In the template, in the command's help and in the guide, one text."""
    monkeypatch.setenv("COLUMNS", "100")
    commented = "".join(f"# {line}".rstrip() + "\n" for line in SIGNS.splitlines())
    assert commented in template()
    assert main(["scene", "--help"]) == 0
    out = capsys.readouterr().out
    assert all(line in out for line in SIGNS.splitlines() if line.startswith(" "))
    assert SIGNS in guide()


def test_signs_are_those_of_the_mechanics():
    """The drawing's scene: GA = 0, A on the +n side facing -x, B facing +x, an approach."""
    scene = {"GA": 0, "TA": 0, "TB": 0, "PA": 0, "PB": 0, "DA": 6, "DB": 6, "MU": 0.05, "E": 0.1}
    scene |= {"EM": -0.5, "MA": 1, "MB": 1, "IA": 9, "IB": 9, "WA": 0, "WB": 0}
    scene |= {"UX": -3, "UY": 4, "VX": 2, "VY": 0}
    found = solve(scene)
    assert int(found["STATUS"]) == 0
    assert found["PN"] > 0  # along n, on A
    assert found["PT"] < 0  # A slides along t, friction on it against t
    shapes = plan(scene)
    a, b = shapes.vehicles
    assert shapes.normal == 1
    assert a.front == pytest.approx(-1, abs=1e-12)
    assert b.front == pytest.approx(1, abs=1e-12)
    assert a.center.real > 0 > b.center.real
    # the contact point is in front of either, at the angle PA from the front
    left = plan({**scene, "PA": 90})
    assert (-left.vehicles[0].center / left.vehicles[0].front).imag > 0


def test_a_value_and_where_it_comes_from_stand_in_a_table_of_either_form() -> None:
    lines = COMPLETE.replace("UX = -29.04", "").rstrip()
    for entry in (
        'UX = {value = -29.04, source = "a, b # c"}',
        "[UX]\nvalue = -29.04\nsource = 'a, b # c'",
    ):
        scene = read(f"{lines}\n{entry}\n")
        assert (scene["UX"], scene.case.sources) == ("-29.04", {"UX": "a, b # c"})
    with pytest.raises(UserError, match=r"line \d+: UX is a table; expected a number"):
        read(f"{lines}\n[UX]\n")
