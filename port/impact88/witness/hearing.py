"""Hearing the witness: what the ROM does, held against the captures and against this project.

A scene is run on the ROM, by the port, by the emulator and by the replay over arrays; a captured
one is also held against its capture. Compared are every character displayed, every variable's five
bytes, and the array. A program is held against its capture and the emulator, a calculation against
its capture and the arithmetic here.
"""

from __future__ import annotations

import difflib
from collections import Counter
from collections.abc import Iterator
from importlib import metadata
from typing import Any, NamedTuple

from ..applesoft.console import Console
from ..checking import captured
from ..checking.captured import ARITHMETIC, FUZZ, SCENES
from ..checking.selfcheck import GOLDEN_RUNS
from ..emulator.machine import TooManyStatements
from ..fields import FIELDS, outcome_fields
from ..files import packaged_bytes
from ..names import SCENE
from ..program import emulated
from ..program.run import run
from ..reporting import provenance
from ..scene import Scene, sample
from .apple import Lost
from .image import Image
from .packaged import OWN, Case
from .session import Finished, Session

CAPTURE, PORT, EMULATOR, REPLAY, PUBLISHED = "capture", "port", "emulator", "replay", "published"
HERE = "this arithmetic"


class Difference(NamedTuple):
    """A point on which the ROM and another differ: who, on what (``printout``, a variable's name,
    ``result``), and both values."""

    who: str
    what: str
    rom: str
    other: str

    def lines(self) -> list[str]:
        """The difference as text, a printout's as a unified diff."""
        if "\n" not in self.rom + self.other:
            return [f"{self.what}: ROM {self.rom}, {self.who} {self.other}"]
        marks = {code: f"^{chr(code + 64)}" for code in range(32) if code != 10}  # ^D, ^G
        rom, other = (text.translate(marks).split("\n") for text in (self.rom, self.other))
        return list(difflib.unified_diff(rom, other, "ROM", self.who, lineterm="", n=2))


class Heard(NamedTuple):
    """A case heard: its kind and name, what it was compared with, where they differ, and what the
    ROM did, in the captures' form, for `saving`."""

    kind: str
    name: str
    compared: tuple[str, ...]
    differences: list[Difference]
    capture: Any


def hear(session: Session, case: Case) -> Heard:
    """A packaged capture done again on the ROM, or a program of the user's own."""
    if case.kind == SCENES:
        return hear_scene(session, case.name, Scene(case.data["scene"]), case.data)
    if case.kind == ARITHMETIC:
        return _hear_call(session, case)
    return _hear_program(session, case)


# --- scenes --------------------------------------------------------------------------------------


def hear_scene(
    session: Session, name: str, scene: Scene, capture: dict[str, Any] | None = None
) -> Heard:
    """A scene run on the ROM, by port, emulator and replay, and held against its capture."""
    rom = session.run_scene(scene)
    others: dict[str, Finished] = {}
    if capture:
        others[CAPTURE] = Finished(capture["printout"], capture["reals"], capture["A"])
    for who, its_run in ((PORT, run), (EMULATOR, emulated.run)):
        ported = its_run(scene, dos=False)
        others[who] = Finished(ported.printout, ported.reals, ported.A)
    differences = [one for who, other in others.items() for one in _apart(rom, who, other)]
    differences += _replayed_apart(rom, scene)
    capture = {
        "id": name,
        "scene": dict(scene),
        "typed_lines": scene.typed_lines(),
        "keyboard": scene.keyboard(),
        **rom._asdict(),
    }
    return Heard(SCENES, name, (*others, REPLAY), differences, capture)


def hear_sample(session: Session, number: int) -> Heard:
    """A published run, held against what was published too: without the lines that a disk system
    takes, which the Apple of 1988 had and this one has not."""
    heard = hear_scene(session, f"sample {number}", sample(number))
    pieces: list[str] = []
    Console(lambda: None, pieces.append, dos=True).put(heard.capture["printout"])
    name = f"printouts/{GOLDEN_RUNS[number]}.txt"
    published, shown = packaged_bytes("impact88.golden", name).decode(), "".join(pieces)
    differences = list(heard.differences)
    if shown != published:
        differences.append(Difference(PUBLISHED, "printout", shown, published))
    return heard._replace(compared=(*heard.compared, PUBLISHED), differences=differences)


def _apart(rom: Finished, who: str, other: Finished) -> Iterator[Difference]:
    if rom.printout != other.printout:
        yield Difference(who, "printout", rom.printout, other.printout)
    mine, my_array = captured.left_behind(rom.reals, rom.A)
    theirs, their_array = captured.left_behind(other.reals, other.A)
    for name in sorted({*mine, *theirs}):
        if mine.get(name) != theirs.get(name):
            yield Difference(who, name, mine.get(name, "absent"), theirs.get(name, "absent"))
    if not my_array or not their_array or my_array[0] != their_array[0]:
        sizes = [str(one and one[0]) for one in (my_array, their_array)]
        if my_array != their_array:
            yield Difference(who, "DIM A", *sizes)
        return
    rows = my_array[0][0]
    for place, (one, another) in enumerate(zip(my_array[1], their_array[1], strict=True)):
        if one != another:
            yield Difference(who, f"A({place % rows},{place // rows})", one, another)


def _replayed_apart(rom: Finished, scene: Scene) -> Iterator[Difference]:
    from ..replay import replay

    alone = replay({name: [scene[name]] for name in SCENE})
    printed = outcome_fields(rom.printout)
    for name in FIELDS:
        replayed = alone.printed(name).tolist()[0]
        if replayed != printed.get(name, ""):
            yield Difference(REPLAY, name, printed.get(name, "nothing"), replayed or "nothing")


# --- programs and calculations -------------------------------------------------------------------


def _hear_program(session: Session, case: Case) -> Heard:
    """A program, held against its capture, if it has one, and the emulator: all that is displayed,
    and the screen at the end. One that does not come to an end is a difference."""
    data, fuzz = case.data, case.kind == FUZZ
    program, keys = data["program" if fuzz else "bas"], data.get("keyboard" if fuzz else "in", "")
    before = session.apple.instructions
    rom, differences = {"displayed": "", "screen": ""}, []
    others: dict[str, dict[str, str]] = {}
    if case.kind != OWN:
        others[CAPTURE] = {"displayed": data.get("output" if fuzz else "out", "")}
        others[CAPTURE] |= {"screen": data["scr"]} if "scr" in data else {}
    others[EMULATOR] = {}
    try:
        rom["displayed"] = session.run_program(program, keys, blanks=not fuzz)
        rom["screen"] = session.apple.screen_text()
        machine, shown = captured.session(program, keys, blanks=not fuzz)
        others[EMULATOR]["displayed"] = shown.replace("\0", "")
        if case.kind == OWN:
            others[EMULATOR]["screen"] = machine.screen_text()
    except Lost as lost:
        rom["displayed"] = session.apple.take_output()
        others.clear()
        differences.append(Difference(EMULATOR, "the ROM", str(lost), "not compared"))
    except TooManyStatements:
        allowed = f"no end after {captured.PLENTY:,} statements"
        differences.append(Difference(EMULATOR, "the emulator", "came to an end", allowed))
    differences += [
        Difference(who, what, rom[what], text)
        for who, other in others.items()
        for what, text in other.items()
        if text != rom[what]
    ]
    done = {**data, "output" if fuzz else "out": rom["displayed"]}
    if not fuzz:
        done["instructions"] = session.apple.instructions - before
    if case.kind == OWN or "scr" in data:
        done["scr"] = rom["screen"]
    return Heard(case.kind, case.name, tuple(others or (EMULATOR,)), differences, done)


def _hear_call(session: Session, case: Case) -> Heard:
    operation, first, second, extension, expected = case.data
    rom = session.calculate(operation, first, second, extension)
    mine = captured.result(rom)
    others = {
        CAPTURE: captured.result(expected),
        HERE: captured.call(operation, first, second, extension),
    }
    asked = " ".join(filter(None, case.data[:4]))
    differences = [Difference(who, asked, mine, one) for who, one in others.items() if one != mine]
    return Heard(ARITHMETIC, case.name, tuple(others), differences, [*case.data[:4], rom])


# --- the record -----------------------------------------------------------------------------------

TOLD = 100
"""Cases with differences that a record holds in full."""


def record(image: Image, heard: list[Heard], seconds: float) -> dict[str, Any]:
    """The object `impact88 witness --json` prints."""
    comparisons, failing = Counter[str](), Counter[str]()
    for one in heard:
        comparisons.update(f"{one.kind}, {who}" for who in one.compared)
        failing.update({f"{one.kind}, {difference.who}" for difference in one.differences})
    wrong = [one for one in heard if one.differences]
    return {
        "passed": bool(heard) and not wrong,
        "versions": {**provenance.versions(), "py65": metadata.version("py65")},
        "hashes": {
            "rom_sha1": image.sha1,
            "listing": provenance.listing_hash(),
            "captures": provenance.captures_hash(),
        },
        "rom": "Apple II Plus" if image.known else "unknown",
        "cases": Counter(one.kind for one in heard),
        "comparisons": {
            name: {"total": total, "right": total - failing[name]}
            for name, total in comparisons.items()
        },
        "differing_cases": len(wrong),
        "differences": [
            {
                "kind": one.kind,
                "name": one.name,
                "differences": [difference._asdict() for difference in one.differences],
            }
            for one in wrong[:TOLD]
        ],
        "seconds": round(seconds, 1),
    }
