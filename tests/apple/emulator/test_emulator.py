"""The emulator against the ROM: every captured program and every captured scene."""

from __future__ import annotations

import os
from functools import partial

import captures
import pytest
from emulation import FUZZ, PROGRAMS, run_emulated

from impact88.apple.captured import memory_contents, session
from impact88.apple.emulator.emulator import Applesoft
from impact88.apple.emulator.machine import Machine
from impact88.apple.emulator.programfile import read_program
from impact88.apple.emulator.tokens import FIRST, KEYWORDS, LAST_STATEMENT, TOKENS
from impact88.program.scene import Scene

SCENES = captures.scenes()[:: 1 if "IMPACT88_CAPTURES" in os.environ else 6]
"""The port replays the others, and is compared with the emulator line by line."""

pytestmark = pytest.mark.captures


STATEMENTS = KEYWORDS[: LAST_STATEMENT - FIRST + 1]
TYPED_ONLY = {"CONT", "DEL", "LIST"}
"""Statements of the prompt, which `test_emulator_language` types."""


def test_every_statement_s_method_is_named_for_a_keyword():
    names = {f"{word.lower().rstrip(':')}_" for word in STATEMENTS} | {"break_"}
    methods = [name for name in dir(Machine) if name.endswith("_") and name[0] != "_"]
    for name in methods:
        assert name in names, (
            f"{name} is called by no statement; next step: name the method for its keyword in "
            "apple/emulator/tokens.py, in small letters with an underscore behind it, or give the "
            "keyword an entry in `statements` of `Machine.__init__` (apple/emulator/machine.py)"
        )


def test_every_statement_is_in_a_captured_program():
    """All behaviour is compared with the ROM: no statement is there on trust. That is said
    of the project's own captures, whatever others a folder holds."""
    machine = session("", "")[0].machine
    tokens_in_programs = {
        token
        for part in ("programs", "corners/programs")
        for path in sorted((captures.ROOT / "golden" / part).glob("*.bas"))
        for _, tokens in read_program(path.read_bytes())
        for token in tokens
    }
    for word, does in zip(STATEMENTS, machine.statements, strict=True):
        is_refused = isinstance(does, partial) and does.func == machine.refuse
        assert is_refused or word in TYPED_ONLY or TOKENS[word] in tokens_in_programs, (
            f"{word} is done, and no captured program has it; next step: a program with the ROM's "
            "own output in golden/programs/"
        )


@pytest.mark.parametrize("path", PROGRAMS, ids=[path.stem for path in PROGRAMS])
def test_captured_program(path):
    keys = path.with_suffix(".in")
    machine, output = session(
        captures.printed(path.read_bytes()),
        captures.printed(keys.read_bytes()) if keys.exists() else "",
    )
    answer = captures.printed(path.with_suffix(".out").read_bytes())
    if output != answer and (refusals := machine.machine.refused):
        word = next(iter(refusals))
        pytest.fail(
            f"{path.name} has {word}, which is not done; next step: the statement's method in the "
            "module of its kind in emulator/"
        )
    assert output == answer
    screen = path.with_suffix(".scr")
    if screen.exists():
        assert machine.screen_text() == captures.printed(screen.read_bytes())


def test_captured_random_programs():
    for case in FUZZ:
        # these hold what the machine sent, without blanks for the columns that commas skip
        _, output = session(case["program"], case["keyboard"], blanks=False)
        assert output == case["output"], case["name"]


def test_captured_scenes():
    for case in SCENES:
        run = run_emulated(Scene(case["scene"]), dos=False)
        assert run.printout == case["printout"], case["id"]
        assert memory_contents(run.reals, run.A) == memory_contents(case["reals"], case["A"])


def test_the_scene_types_what_the_captures_typed():
    for case in SCENES[:50]:
        scene = Scene(case["scene"])
        assert scene.typed_lines() == case["typed_lines"]
        assert scene.keyboard() == case["keyboard"]


def test_a_changed_bit_in_a_capture_is_seen():
    case = SCENES[0]
    run = run_emulated(Scene(case["scene"]), dos=False)
    name, value = next((n, v) for n, v in case["reals"].items() if not v.startswith("00"))
    alteration = {**case["reals"], name: f"{int(value, 16) ^ 1:010x}"}
    assert memory_contents(run.reals, run.A) != memory_contents(alteration, case["A"])


def test_the_monitors_vtab_and_the_branch_before_home_return() -> None:
    """POKE 37 and CALL -990 move to a row as VTAB does; -938 clears the screen as -936 does."""
    machine = Applesoft()
    machine.type_line("VTAB 7: A = PEEK(40) + 256 * PEEK(41)")
    machine.type_line("POKE 37,6: CALL -990: PRINT A = PEEK(40) + 256 * PEEK(41)")
    assert machine.take_output() == "1\n"
    machine.type_line("CALL -938: PRINT PEEK(37)")
    assert machine.take_output() == "0\n"
    assert machine.screen_text().startswith("0\n")


def test_a_byte_255_is_listed_with_a_note() -> None:
    machine = Applesoft()
    machine.load("10 PRINT 1")
    machine.type_line("POKE 2053,255: LIST")
    assert any("byte 255" in note for note in machine.machine.ignored)
