"""Helpers for tests of the emulator: the captured programs, and lockstep with the port."""

from __future__ import annotations

from typing import Any

import captures

from impact88.apple.captured import memory_contents, normalize_zero
from impact88.apple.emulator.emulator import Applesoft
from impact88.files import packaged_text
from impact88.program.copies import run_machine
from impact88.program.run import Run
from impact88.program.run import run as run_port
from impact88.program.scene import LISTING, Scene

NOT_FOLLOWED = {
    "fresh_list_451": "graphics",
    "fresh_list_489": "graphics",
    "fresh_list_491": "tape and shapes",
    "fresh_list_495": "graphics",
    "known_PEEK_ROM": "the bytes of the ROM, which are not ours to give",
    "known__U": "the key came to that ROM behind its cursor's blink: control-U took the cursor",
}
"""Captured corners that are not done here, and why."""

PROGRAMS = [
    path
    for part in ("programs", "corners/programs")
    for path in sorted((captures.folder() / part).glob("*.bas"))
    if path.stem not in NOT_FOLLOWED
]
FUZZ = [
    case
    for name in ("fuzz", "corners/fuzz", "corners/keys")
    if (captures.folder() / f"{name}.jsonl.gz").exists()
    for case in captures.jsonl(name)
]

Report = tuple[int, dict[str, str], list[str] | None]


def load_machine(scene: Scene, *, dos: bool = True, text: str | None = None) -> Applesoft:
    """An emulator with the listing or ``text``, a scene's lines typed in, its replies queued."""
    machine = Applesoft(dos=dos, blanks=False)  # characters sent, as the port's printouts
    machine.load(text or packaged_text("impact88.legacy", LISTING))
    for line in scene.typed_lines():
        machine.type_line(line)
    machine.feed(*scene.keyboard())
    return machine


def run_emulated(scene: Scene, *, dos: bool = True) -> Run:
    """The record of the listing's run on a scene in the emulator."""
    return run_machine(load_machine(scene, dos=dos))


def changes(reports: list[Report]) -> list[Report]:
    """The reports whose variables differ from the report before: a line that only decides or prints
    is left by port and emulator at different moments, but every value is assigned in one line."""
    kept: list[Report] = []
    state: tuple[Any, Any] = ({}, None)
    for line, reals, data in reports:
        if (reals, data) != state:
            state = (reals, data)
            kept.append((line, reals, data))
    return kept


def port_reports(scene: Scene) -> tuple[list[Report], Any]:
    """The port's variables after every line, and its run."""
    reports: list[Report] = []

    def after(line: int, variables: Any) -> None:
        reals = {name: normalize_zero(x.to_bytes().hex()) for name, x in variables.reals.items()}
        data = variables.A and [normalize_zero(x.to_bytes().hex()) for x in variables.A.data]
        reports.append((line, reals, data))

    return reports, run_port(scene, dos=False, after_line=after)


def emulator_reports(scene: Scene, text: str | None = None) -> tuple[list[Report], Any]:
    """The emulator's variables after every line of the listing, and its run."""
    reports: list[Report] = []

    machine = load_machine(scene, dos=False, text=text)

    def after(line: int) -> None:
        a = machine.array("A")
        reals = {name: normalize_zero(value) for name, value in machine.reals().items()}
        reports.append((line, reals, a and [normalize_zero(value) for value in a["data"]]))

    machine.machine.after_line = after
    return reports, run_machine(machine)


def first_difference(scene: Scene, text: str | None = None) -> Any:
    """Return the first difference of port and emulator on a scene: the two reports, or None if
    they agree on every bit after every line."""
    port, port_run = port_reports(scene)
    emulator, emulator_run = emulator_reports(scene, text)
    mine, theirs = changes(port), changes(emulator)
    if emulator_run.error and len(theirs) == len(mine) + 1:
        # the variable that the failing line has made, not filled yet; the port adds it at the end
        theirs.pop()
    for one, other in zip(mine, theirs, strict=False):
        if one != other:
            return one, other
    if len(mine) != len(theirs):
        return len(mine), len(theirs)
    whole = (port_run._replace(reals={}, A=None), memory_contents(port_run.reals, port_run.A))
    other = (
        emulator_run._replace(reals={}, A=None),
        memory_contents(emulator_run.reals, emulator_run.A),
    )
    return None if whole == other else (whole, other)
