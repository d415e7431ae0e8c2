"""The emulator against the ROM: every captured program and every captured scene."""

from __future__ import annotations

import os

import captures
import pytest
from emulation import FUZZ, PROGRAMS

from impact88.program import emulated
from impact88.qualification.captured import left_behind, session

SCENES = captures.scenes()[:: 1 if "IMPACT88_CAPTURES" in os.environ else 3]
"""The port replays the others, and is compared with the emulator line by line."""

pytestmark = pytest.mark.captures


@pytest.mark.parametrize("path", PROGRAMS, ids=[path.stem for path in PROGRAMS])
def test_captured_program(path):
    keys = path.with_suffix(".in")
    machine, displayed = session(
        captures.printed(path.read_bytes()),
        captures.printed(keys.read_bytes()) if keys.exists() else "",
    )
    assert displayed == captures.printed(path.with_suffix(".out").read_bytes())
    screen = path.with_suffix(".scr")
    if screen.exists():
        assert machine.screen_text() == captures.printed(screen.read_bytes())


@pytest.mark.parametrize("case", FUZZ, ids=[case["name"] for case in FUZZ])
def test_captured_random_program(case):
    # these hold what the machine sent, without blanks for the columns that commas skip
    _, displayed = session(case["program"], case["keyboard"], blanks=False)
    assert displayed == case["output"]


@pytest.mark.parametrize("case", SCENES, ids=[case["id"] for case in SCENES])
def test_captured_scene(case):
    run = emulated.run(case["scene"], dos=False)
    assert run.printout == case["printout"]
    assert left_behind(run.reals, run.A) == left_behind(case["reals"], case["A"])


def test_the_scene_types_what_the_captures_typed():
    for case in SCENES[:50]:
        scene = emulated.Scene(case["scene"])
        assert scene.typed_lines() == case["typed_lines"]
        assert scene.keyboard() == case["keyboard"]


def test_a_changed_bit_in_a_capture_is_seen():
    case = SCENES[0]
    run = emulated.run(case["scene"], dos=False)
    name, value = next((n, v) for n, v in case["reals"].items() if not v.startswith("00"))
    changed = {**case["reals"], name: f"{int(value, 16) ^ 1:010x}"}
    assert left_behind(run.reals, run.A) != left_behind(changed, case["A"])
