"""``impact88 run``: scenes, prompts and INPUT's manners, the printer, JSON, exit statuses."""

from __future__ import annotations

import json

import pytest
from installed import impact88

from impact88.apple.applesoft.console import Console, keyboard_codes
from impact88.collision.casescene import sample
from impact88.errors import UserError
from impact88.program import copies
from impact88.program.arithmetics import APPLESOFT
from impact88.program.run import run, start

REPLIES = "-29.04,0,0\n14.52,25.15,0\n"
ASK_A = "ENTER THE INITIAL VELOCITY COMPONENTS OF MA :Vax,Vay,Wa ?\0"


def after_ask(stdout: str) -> str:
    """What follows the first prompt."""
    return stdout.split(ASK_A)[1]


def test_with_no_scene_it_is_the_1988_program():
    done = impact88("run", "--raw", input=REPLIES)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == run(sample(1)).printout


@pytest.mark.parametrize(
    ("typed", "shown"),
    [
        ("-29.04\n0,0\n14.52,25.15,0\n", "-29.04\n??\x000,0\n\nENTER"),
        ("-29.04,X,0\n-29.04,0,0\n14.52,25.15,0\n", "-29.04,X,0\n?REENTER\n?\x00-29.04,0,0\n\n"),
        ("-29.04,0,0,7\n14.52,25.15,0\n", "-29.04,0,0,7\n?EXTRA IGNORED\n\nENTER"),
        ("-29.04,,\n14.52,25.15,0\n", "-29.04,,\n\nENTER"),
        ("-29.04,0,0:9\n14.52,25.15,0\n", "-29.04,0,0:9\n?EXTRA IGNORED\n\nENTER"),
        (" -29 . 04 , 0 , 0 \n14.52,25.15,0\n", " -29 . 04 , 0 , 0 \n\nENTER"),
        ("-2.904e1,0,0\n14.52,25.15,0\n", "-2.904E1,0,0\n\nENTER"),
        ("9\x08-29.04,0,0\n14.52,25.15,0\n", "9\x08-29.04,0,0\n\nENTER"),
        ("1,2\x18-29.04,0,0\n14.52,25.15,0\n", "1,2\x18\\\n\0-29.04,0,0\n\nENTER"),
    ],
)
def test_inputs_manners(typed, shown):
    done = impact88("run", "--raw", input=typed)
    assert done.returncode == 0
    assert after_ask(done.stdout).startswith(shown)
    assert "VAX= -13.263" in done.stdout or "2.904E1" in shown


def test_input_that_ends_at_a_prompt():
    done = impact88("run", input="-29.04,0,0\n")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "VX,VY,WB" in done.stderr


def test_a_scene_file_and_changes(tmp_path):
    path = tmp_path / "crash.toml"
    path.write_text(sample(3).to_toml())
    assert impact88("run", str(path), "--raw").stdout == run(sample(3)).printout
    done = impact88("run", str(path), "--set", "MU=-10", "--set", "E = .5", "--raw")
    assert done.stdout == run(sample(3).replaced({"MU": "-10", "E": ".5"})).printout
    with open(path) as file:
        assert impact88("run", "-", "--raw", input=file.read()).stdout == run(sample(3)).printout


def test_changed_data_with_prompts():
    done = impact88("run", "--set", "MU=.5", "--raw", input=REPLIES)
    assert done.stdout == run(sample(1).replaced({"MU": ".5"})).printout


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("nowhere.toml",), ["nowhere.toml", "cannot be read"]),
        (("--sample", "4"), ["--sample", "1, 2, 3"]),
        (("--sample", "1", "x.toml"), ["expected one"]),
        (("--sample", "1", "--set", "MU"), ["NAME=VALUE"]),
        (("--sample", "1", "--set", "MOO=1"), ["'MOO'"]),
        (("--sample", "1", "--set", "MU=x"), ["MU", "'x'", "friction"]),
        (("--sample", "1", "--set", "MU=1", "--set", "mu=2"), ["twice"]),
        (("--set", "UX=1"), ["UY WA VX VY WB"]),
        (("--sample", "1", "--slot", "3"), ["slot 3 is empty"]),
        (("--sample", "1", "--slot", "9"), ["--slot"]),
        (("--sample", "1", "--printer", "/nowhere/at/all"), ["/nowhere/at/all"]),
        (("--sample", "1", "--arithmetic", "decimal"), ["applesoft", "float64"]),
    ],
)
def test_unusable_input_is_one_line(arguments, words):
    done = impact88("run", *arguments)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    for word in words:
        assert word in done.stderr


@pytest.mark.parametrize(
    ("setting", "status", "ending"),
    [
        ("MA=0", 0, "\nZERO DETERMINANT\n"),
        ("IA=0", 1, "\n?DIVISION BY ZERO ERROR\a IN 480"),
        ("UX=-1E39", 1, "\n?OVERFLOW ERROR\a IN 210"),
    ],
)
def test_exit_status(setting, status, ending):
    done = impact88("run", "--sample", "1", "--set", setting, "--raw")
    fast = "impact88: UX = -1E39: no vehicle is as fast (500 km/h); is its unit as meant?\n"
    assert (done.returncode, done.stderr) == (status, fast if "UX" in setting else "")
    assert done.stdout.endswith(ending)


def test_json_is_the_captures_form():
    done = impact88("run", "--sample", "1", "--no-dos", "--json")
    shown = json.loads(done.stdout)
    expected = run(sample(1), dos=False)
    assert list(shown) == ["schema", "version", *expected._fields, "floats"]
    assert shown["floats"] == expected.floats
    assert shown["printout"] == expected.printout
    assert shown["reals"] == expected.reals
    assert shown["A"] == expected.A
    done = impact88("run", "--sample", "1", "--set", "IA=0", "--json")
    shown = json.loads(done.stdout)
    assert (done.returncode, shown["error"], shown["line"]) == (
        1,
        "?DIVISION BY ZERO ERROR IN 480",
        480,
    )


def test_the_printer_gets_what_goes_to_slot_1(tmp_path):
    paper = tmp_path / "paper.txt"
    done = impact88("run", "--sample", "1", "--slot", "1", "--printer", str(paper), "--raw")
    whole = run(sample(1)).printout
    assert paper.read_text().startswith("\n\nMA= 143.5")
    assert done.stdout + paper.read_text() == whole
    assert impact88("run", "--sample", "1", "--slot", "1", "--raw").stdout == whole


def test_nothing_half_written_when_the_input_ends(tmp_path):
    paper = tmp_path / "paper.txt"
    done = impact88("run", "--slot", "1", "--printer", str(paper), input="1,2,3\n")
    assert done.returncode == 2
    assert list(tmp_path.iterdir()) == []


def test_without_dos_its_lines_show():
    done = impact88("run", "--sample", "1", "--no-dos", "--slot", "3", "--raw")
    assert "\n\x04PR# 3\n" in done.stdout
    assert done.stdout.endswith("\n\x04PR#0\n")


def test_a_refused_value_has_been_stored_as_far_as_it_is_a_number():
    """12X leaves 12 in the variable and asks again; the values behind it are not looked at."""
    replies = iter(["1,12X,3"])
    console = Console(lambda: next(replies, None), lambda text: None)
    reply = next(iter(console.input(APPLESOFT.read, APPLESOFT.zero)))
    assert [APPLESOFT.write(reply(None)) for _ in range(3)] == ["1", "12", "0"]
    assert reply.refused


def test_the_page_is_for_a_person():
    """No control character but line ends, and nothing else is missing."""
    done = impact88("run", "--sample", "1", "--set", "IA=0", "--no-dos")
    whole = run(sample(1).replaced({"IA": "0"}), dos=False)
    assert "\a" in whole.printout
    assert done.stdout == whole.page
    assert all(character == "\n" or character.isprintable() for character in done.stdout)
    assert done.stdout == "".join(c for c in whole.printout if c == "\n" or c.isprintable())


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"E": "E"}, ["E = 'E'", "line 280"]),
        ({"MU": "-"}, ["MU = '-'"]),
        ({"IA": "E5"}, ["IA", "line 310"]),
        (
            dict.fromkeys(("DA", "DB", "GA", "PA", "PB", "TA", "TB"), "1." + "0" * 28),
            ["290", "239"],
        ),
    ],
)
def test_values_that_cannot_be_typed_into_the_program(changes, words):
    settings = [f"--set={name}={text}" for name, text in changes.items()]
    done = impact88("run", "--sample", "1", *settings)
    assert (done.returncode, done.stdout) == (2, "")
    assert all(word in done.stderr for word in words)
    with pytest.raises(UserError):
        run(sample(1).replaced(changes))
    with pytest.raises(UserError):
        copies.run_emulated(sample(1).replaced(changes))


def test_an_empty_reply_is_asked_again():
    done = impact88("run", input="\n" + REPLIES)
    assert "?\n?REENTER\n?-29.04,0,0\n" in done.stdout


@pytest.mark.parametrize(
    "typed", ["\N{MINUS SIGN}5", "\N{MICRO SIGN}5", "\N{FULLWIDTH DIGIT ONE}", "\u7903"]
)
def test_a_character_the_keyboard_has_no_key_for_is_no_part_of_a_number(typed):
    """The last seven bits of a micro sign are those of 5, of U+7903 those of control-C."""
    done = impact88("run", input=f"{typed},0,0\n" + REPLIES)
    assert (done.returncode, done.stderr) == (0, "")
    assert ",0,0\n?REENTER\n" in done.stdout


def test_a_reply_in_apple_text_with_its_high_bits():
    assert keyboard_codes("\udcb1\udcac\udcad2") == "1,-2"


def test_what_a_refused_reply_has_made():
    """The ROM makes a variable when it looks for its value: UX and UY, then OVERFLOW."""
    replies = iter(["54.79,$1,-52", "1E100"])
    console = Console(lambda: next(replies, None), lambda text: None)
    left = start(sample(1), console)
    assert left.error == "?OVERFLOW ERROR IN 210"
    assert set(left.reals) == {"UX", "UY"}
