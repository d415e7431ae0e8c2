"""Hearing the witness: what the ROM does, held against the captures and against this project.

Of a scene every character displayed, every variable's five bytes and the array are held against
capture, port, emulator and replay; a program against its capture and the emulator, a calculation
against its capture and the arithmetic here.
"""

import difflib
import gzip
import json
import os
from collections import Counter
from collections.abc import Iterable, Mapping
from importlib import metadata
from typing import Any, NamedTuple

from ..applesoft.console import Console
from ..checking import captured
from ..checking.captured import ARITHMETIC, ENDINGS, FUZZ, PROGRAMS, SCENES
from ..checking.selfcheck import GOLDEN_RUNS
from ..emulator.faults import TooManyStatements
from ..fields import FIELDS, outcome_fields
from ..files import packaged_bytes, write_folder
from ..names import SCENE
from ..program import emulated
from ..program.run import Run, run
from ..report import frame
from ..scene import Scene, sample
from .apple import Image, Lost
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


Sides = dict[str, tuple[Mapping[str, str], Mapping[str, str]]]
"""Whom the ROM is held against -> what it did and what they did, by name."""


def _held(kind: str, name: str, sides: Sides, capture: Any) -> Heard:
    """Where the ROM and others differ; an array of another size is one difference."""
    differences = []
    for who, (rom, other) in sides.items():
        apart = [each for each in dict.fromkeys([*rom, *other]) if rom.get(each) != other.get(each)]
        if "DIM A" in apart:
            apart = [each for each in apart if not each.startswith("A(")]
        differences += [
            Difference(who, each, rom.get(each, "absent"), other.get(each, "absent"))
            for each in apart
        ]
    return Heard(kind, name, tuple(sides), differences, capture)


def hear_scene(
    session: Session,
    name: str,
    scene: Scene,
    capture: dict[str, Any] | None = None,
    published: str = "",
) -> Heard:
    """A scene run on the ROM, by port, emulator and replay, and held against its capture, or what
    was published: without the lines that a disk system takes, which the Apple of 1988 had and this
    one has not."""
    from ..replay import replay

    rom = session.run_scene(scene)
    mine = _left_behind(rom)
    sides: Sides = {}
    if capture:
        captured_run = Finished(capture["printout"], capture["reals"], capture["A"])
        sides[CAPTURE] = mine, _left_behind(captured_run)
    sides[PORT] = mine, _left_behind(run(scene, dos=False))
    sides[EMULATOR] = mine, _left_behind(emulated.run(scene, dos=False))
    alone = replay({each: [scene[each]] for each in SCENE})
    replayed = {each: text for each in FIELDS if (text := alone.printed(each).tolist()[0])}
    sides[REPLAY] = outcome_fields(rom.printout), replayed
    if published:
        pieces: list[str] = []
        Console(lambda: None, pieces.append, dos=True).put(rom.printout)
        sides[PUBLISHED] = {"printout": "".join(pieces)}, {"printout": published}
    row = {
        "id": name,
        "scene": dict(scene),
        "typed_lines": scene.typed_lines(),
        "keyboard": scene.keyboard(),
        **rom._asdict(),
    }
    return _held(SCENES, name, sides, row)


def hear_sample(session: Session, number: int) -> Heard:
    """A published run, held against what was published too."""
    published = packaged_bytes("impact88.golden", f"printouts/{GOLDEN_RUNS[number]}.txt").decode()
    return hear_scene(session, f"sample {number}", sample(number), published=published)


def _left_behind(run: Finished | Run) -> dict[str, str]:
    """What a run printed and left in its variables and its array, by name."""
    reals, array = captured.left_behind(run.reals, run.A)
    whole = {"printout": run.printout, **dict(sorted(reals.items()))}
    if array:
        (rows, columns), cells = array
        whole["DIM A"] = f"{[rows, columns]}"
        whole |= {f"A({at % rows},{at // rows})": text for at, text in enumerate(cells)}
    return whole


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
        others = {EMULATOR: {}}
        differences.append(Difference(EMULATOR, "the ROM", str(lost), "not compared"))
    except TooManyStatements:
        allowed = f"no end after {captured.PLENTY:,} statements"
        differences.append(Difference(EMULATOR, "the emulator", "came to an end", allowed))
    done = {**data, "output" if fuzz else "out": rom["displayed"]}
    if not fuzz:
        done["instructions"] = session.apple.instructions - before
    if case.kind == OWN or "scr" in data:
        done["scr"] = rom["screen"]
    sides: Sides = {who: ({what: rom[what] for what in o}, o) for who, o in others.items()}
    heard = _held(case.kind, case.name, sides, done)
    return heard._replace(differences=differences + heard.differences)


def _hear_call(session: Session, case: Case) -> Heard:
    *asked, expected = case.data
    rom, what = session.calculate(*asked), " ".join(filter(None, asked))
    others = {CAPTURE: captured.result(expected), HERE: captured.call(*asked)}
    mine = {what: captured.result(rom)}
    sides: Sides = {who: (mine, {what: text}) for who, text in others.items()}
    return _held(ARITHMETIC, case.name, sides, [*asked, rom])


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
        "versions": {**frame.versions(), "py65": metadata.version("py65")},
        "hashes": {"rom_sha1": image.sha1, **frame.hashes()},
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


def save(folder: str, heard: Iterable[Heard]) -> None:
    """Write captures into a folder, which is made; each file holds those of this call only. Raises
    UserError when a place cannot be written to."""
    files: dict[str, list[str]] = {}
    index: dict[str, str] = {}
    for one in heard:
        if one.kind in (SCENES, FUZZ):
            files.setdefault(f"{one.kind}.jsonl.gz", []).append(json.dumps(one.capture))
        elif one.kind == ARITHMETIC:
            name = os.path.join(ARITHMETIC, f"{one.capture[0]}.tsv.gz")
            files.setdefault(name, []).append("\t".join(one.capture))
        else:
            for ending in ENDINGS:
                if one.capture.get(ending):
                    name = os.path.join(PROGRAMS, f"{one.name}.{ending}")
                    files[name] = [one.capture[ending]]
            if one.kind != OWN:
                index[one.name] = str(one.capture["instructions"])
    if index:
        text = captured.golden().joinpath(PROGRAMS, "index.tsv").read_text("utf-8")
        heading, *rows = (line.split("\t") for line in text.splitlines())
        kept = [[*row[:-1], index[row[0]]] for row in rows if row[0] in index]
        files[os.path.join(PROGRAMS, "index.tsv")] = ["\t".join(r) + "\n" for r in (heading, *kept)]
    packed = {  # the same lines give the same bytes on every day
        name: gzip.compress("".join(f"{line}\n" for line in lines).encode(), mtime=0)
        if name.endswith(".gz")
        else "".join(lines).encode("latin-1")
        for name, lines in files.items()
    }
    write_folder(folder, packed)
