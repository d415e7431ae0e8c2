"""Hearing the witness: what the ROM does, held against the captures and against this project.

Of a scene every character, every variable's five bytes and the array; of a program all that is
displayed; of a calculation the result."""

import difflib
import gzip
import json
import os
from collections import Counter
from collections.abc import Iterable, Mapping
from functools import cache
from importlib import metadata
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

from ...applesoft.console import Console
from ...collision.fields import FIELDS, outcome_fields
from ...emulator.faults import TooManyStatements
from ...errors import UserError
from ...files import files_of, packaged_bytes, read_bytes, write_folder
from ...names import SCENE
from ...program import emulated
from ...program.run import run
from ...program.scene import Scene, sample
from ...report import frame
from .. import captured
from ..captured import ARITHMETIC, ENDINGS, FUZZ, PROGRAMS, SCENES
from ..selfcheck import GOLDEN_RUNS
from .apple import Image, Lost
from .session import LONGEST_TYPED, Session

OWN = "own programs"
CAPTURE, PORT, EMULATOR, REPLAY, PUBLISHED = "capture", "port", "emulator", "replay", "published"
HERE = "this arithmetic"
TOLD = 100
"""Cases with differences that a record holds in full."""


class Case(NamedTuple):
    """One capture, or a program of the user's own: which kind, its name, and what it holds (a row
    of scenes, a program's texts by ending, or an arithmetic file's five columns)."""

    kind: str
    name: str
    data: Any


def cases(count: int | None, seed: int = 0) -> list[Case]:
    """Captures, drawn evenly from scenes, programs and the routines of the arithmetic, none twice;
    all of them for ``count`` None."""
    if count is None:
        return [case for deck in _decks() for case in deck]
    rng = Random(seed)
    scenes, programs, *calls = (rng.sample(deck, len(deck)) for deck in _decks())
    rng.shuffle(calls)
    drawn: list[Case] = []
    for turn in range(count):
        arithmetic = calls[turn // 3 % len(calls)]
        deck = (scenes, programs, arithmetic)[turn % 3] or arithmetic
        drawn += [deck.pop()] if deck else []
    return drawn


@cache
def _decks() -> list[list[Case]]:
    golden = captured.golden()
    return [
        [Case(SCENES, row["id"], row) for row in captured.rows(golden, SCENES)],
        [Case(*program) for program in captured.programs(golden)],
        *(
            [Case(ARITHMETIC, f"{operation}-{place:04d}", row) for place, row in enumerate(rows)]
            for operation, rows in captured.calls(golden).items()
        ),
    ]


def own_programs(folder: str) -> list[Case]:
    """Every ``.bas`` in a folder, with the replies in the ``.in`` beside it. Raises UserError when
    there is none, one cannot be read, or a line is too long to be typed."""
    try:
        paths = sorted(path for path in Path(folder).iterdir() if path.suffix.lower() == ".bas")
    except OSError as error:
        raise UserError(f"cannot be read: {error.strerror or error}", folder) from None
    if not paths:
        raise UserError("holds no .bas", folder)
    found = []
    for path in paths:
        program, replies = _text(path), path.with_suffix(".in")
        for row, line in enumerate(program.split("\n"), 1):
            if len(line) > LONGEST_TYPED:
                reason = f"{len(line)} characters; {LONGEST_TYPED} can be typed on a line"
                raise UserError(f"row {row} has {reason}", str(path))
        typed = _text(replies) if replies.exists() else ""
        found.append(Case(OWN, path.stem, {"bas": program, "in": typed}))
    return found


def _text(path: Path) -> str:
    text = read_bytes(str(path), limit=1_000_000).decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


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
    ROM did, in the captures' form."""

    kind: str
    name: str
    compared: tuple[str, ...]
    differences: list[Difference]
    capture: Any


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


def hear(session: Session, case: Case) -> Heard:
    """A packaged capture done again on the ROM, or a program of the user's own."""
    if case.kind == SCENES:
        return hear_scene(session, case.name, Scene(case.data["scene"]), case.data)
    if case.kind != ARITHMETIC:
        return _hear_program(session, case)
    *asked, expected = case.data
    rom, what = session.calculate(*asked), " ".join(filter(None, asked))
    mine = {what: captured.result(rom)}
    sides: Sides = {
        CAPTURE: (mine, {what: captured.result(expected)}),
        HERE: (mine, {what: captured.call(*asked)}),
    }
    return _held(ARITHMETIC, case.name, sides, [*asked, rom])


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
    from ...program.vectorized import replay

    rom = session.run_scene(scene)
    mine = _left_behind(rom)
    sides: Sides = {}
    if capture:
        sides[CAPTURE] = mine, _left_behind(capture)
    sides[PORT] = mine, _left_behind(run(scene, dos=False)._asdict())
    sides[EMULATOR] = mine, _left_behind(emulated.run(scene, dos=False)._asdict())
    alone = replay({each: [scene[each]] for each in SCENE})
    replayed = {each: text for each in FIELDS if (text := alone.printed(each).tolist()[0])}
    sides[REPLAY] = outcome_fields(rom["printout"]), replayed
    if published:
        pieces: list[str] = []
        Console(lambda: None, pieces.append, dos=True).put(rom["printout"])
        sides[PUBLISHED] = {"printout": "".join(pieces)}, {"printout": published}
    row = {
        "id": name,
        "scene": dict(scene),
        "typed_lines": scene.typed_lines(),
        "keyboard": scene.keyboard(),
        **rom,
    }
    return _held(SCENES, name, sides, row)


def hear_sample(session: Session, number: int) -> Heard:
    """A published run, held against what was published too."""
    published = packaged_bytes("impact88.golden", f"printouts/{GOLDEN_RUNS[number]}.txt").decode()
    return hear_scene(session, f"sample {number}", sample(number), published=published)


def _left_behind(run: Mapping[str, Any]) -> dict[str, str]:
    return {"printout": run["printout"], **captured.left_behind(run["reals"], run["A"])}


def _hear_program(session: Session, case: Case) -> Heard:
    """A program, held against its capture, if it has one, and the emulator: all that is displayed,
    and the screen at the end. One that does not come to an end is a difference."""
    data, apple, blanks = case.data, session.apple, case.kind != FUZZ
    program, keys = data["bas"], data.get("in", "")
    before = apple.instructions
    rom, others = {}, {}
    if case.kind != OWN:
        others[CAPTURE] = {"displayed": data.get("out", "")}
        others[CAPTURE] |= {"screen": data["scr"]} if "scr" in data else {}
    try:
        rom["displayed"] = session.run_program(program, keys, blanks=blanks)
        rom["screen"] = apple.screen_text()
        machine, displayed = captured.session(program, keys, blanks=blanks)
        others[EMULATOR] = {"displayed": displayed}
        if case.kind == OWN:
            others[EMULATOR]["screen"] = machine.screen_text()
    except Lost as lost:
        rom = {"displayed": apple.take_output(), "screen": "", "the ROM": str(lost)}
        others = {EMULATOR: {"the ROM": "not compared"}}
    except TooManyStatements:
        rom["the emulator"] = "came to an end"
        others[EMULATOR] = {"the emulator": f"no end after {captured.PLENTY:,} statements"}
    done = {**data, "out": rom["displayed"], "instructions": apple.instructions - before}
    if case.kind == OWN or "scr" in data:
        done["scr"] = rom["screen"]
    sides: Sides = {who: ({what: rom[what] for what in o}, o) for who, o in others.items()}
    return _held(case.kind, case.name, sides, done)


def record(image: Image, heard: list[Heard], seconds: float) -> dict[str, Any]:
    """The object `impact88 witness --json` prints."""
    comparisons, failing = Counter[str](), Counter[str]()
    for case in heard:
        comparisons.update(f"{case.kind}, {who}" for who in case.compared)
        failing.update({f"{case.kind}, {difference.who}" for difference in case.differences})
    wrong = [case for case in heard if case.differences]
    return {
        "passed": bool(heard) and not wrong,
        "versions": {**frame.versions(), "py65": metadata.version("py65")},
        "hashes": {"rom_sha1": image.sha1, **frame.hashes()},
        "rom": "Apple II Plus" if image.known else "unknown",
        "cases": Counter(case.kind for case in heard),
        "comparisons": {
            name: {"total": total, "right": total - failing[name]}
            for name, total in comparisons.items()
        },
        "differing_cases": len(wrong),
        "differences": [
            {
                "kind": case.kind,
                "name": case.name,
                "differences": [difference._asdict() for difference in case.differences],
            }
            for case in wrong[:TOLD]
        ],
        "seconds": round(seconds, 1),
    }


def save(folder: str, heard: Iterable[Heard]) -> None:
    """Write captures into a folder, which is made; each file holds those of this call only. Raises
    UserError when a place cannot be written to."""
    files: dict[str, list[str]] = {}
    index: dict[str, str] = {}
    for kind, name, _, _, done in heard:
        if kind == ARITHMETIC:
            place, line = os.path.join(ARITHMETIC, f"{done[0]}.tsv.gz"), "\t".join(done)
            files.setdefault(place, []).append(line)
        elif kind == SCENES:
            files.setdefault(f"{SCENES}.jsonl.gz", []).append(json.dumps(done))
        elif kind == FUZZ:
            row = {"name": name, "program": done["bas"], "keyboard": done["in"]}
            line = json.dumps({**row, "output": done["out"]})
            files.setdefault(f"{FUZZ}.jsonl.gz", []).append(line)
        else:
            for ending in filter(done.get, ENDINGS):
                files[os.path.join(PROGRAMS, f"{name}.{ending}")] = [done[ending]]
            if kind != OWN:
                index[name] = str(done["instructions"])
    if index:
        programs = {file.name: file for file in files_of(captured.golden(), PROGRAMS)}
        text = programs["index.tsv"].read_text("utf-8")
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
