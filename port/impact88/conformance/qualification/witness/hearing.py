"""Compare what the ROM does with the captures and with this project's own implementations.

For a scene: every character of the printout, every variable's five bytes and the array. For a
program: its whole output. For a calculation: the result.
"""

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

from ....apple import captured
from ....apple.applesoft.console import Console
from ....apple.captured import ARITHMETIC, ENDINGS, FUZZ, PROGRAMS, SCENES
from ....apple.emulator.faults import TooManyStatements
from ....casework.report import frame
from ....collision.casescene import Scene, sample
from ....collision.fields import FIELDS, outcome_fields
from ....errors import UserError
from ....files import files_of, packaged_bytes, read_bytes, write_folder
from ....names import SCENE
from ....program import copies
from ....program.run import run
from ..selfcheck import GOLDEN_RUNS
from .apple import Image, Lost
from .session import LONGEST_TYPED, Session

OWN = "own programs"  # a kind of case, besides those of the captures

# sources that the ROM is compared with
CAPTURE = "capture"
PORT = "port"
EMULATOR = "emulator"
REPLAY = "replay"
PUBLISHED = "published"
HERE = "this arithmetic"

MAX_CASES_LISTED = 100  # cases with differences that a record holds in full


class WitnessCase(NamedTuple):
    """A capture, or a program of the user's own: its kind, its name, and its data (a row of scenes,
    a program's texts by ending, or the five columns of an arithmetic file)."""

    kind: str
    name: str
    data: Any


def cases(count: int | None, seed: int = 0) -> list[WitnessCase]:
    """Draw captures evenly from scenes, programs and the routines of the arithmetic, none twice;
    return all of them if ``count`` is None."""
    if count is None:
        return [case for group in _case_groups() for case in group]
    rng = Random(seed)
    scenes, programs, *calls = (rng.sample(group, len(group)) for group in _case_groups())
    rng.shuffle(calls)
    cases_drawn: list[WitnessCase] = []
    for turn in range(count):
        arithmetic = calls[turn // 3 % len(calls)]
        group = (scenes, programs, arithmetic)[turn % 3] or arithmetic
        cases_drawn += [group.pop()] if group else []
    return cases_drawn


@cache
def _case_groups() -> list[list[WitnessCase]]:
    """Return the captured scenes, the programs, and the calls of each routine."""
    golden = captured.golden()
    return [
        [WitnessCase(SCENES, row["id"], row) for row in captured.rows(golden, SCENES)],
        [WitnessCase(*program) for program in captured.programs(golden)],
        *(
            [
                WitnessCase(ARITHMETIC, f"{operation}-{place:04d}", row)
                for place, row in enumerate(rows)
            ]
            for operation, rows in captured.calls(golden).items()
        ),
    ]


def own_programs(folder: str) -> list[WitnessCase]:
    """Read every ``.bas`` file in a folder, with the replies in the ``.in`` file of the same name.

    Raises UserError if there is none, one cannot be read, or a line is too long to be typed.
    """
    try:
        paths = sorted(path for path in Path(folder).iterdir() if path.suffix.lower() == ".bas")
    except OSError as error:
        raise UserError(f"cannot be read: {error.strerror or error}", folder) from None
    if not paths:
        raise UserError("holds no .bas", folder)
    programs = []
    for path in paths:
        program, replies = _text(path), path.with_suffix(".in")
        for row, line in enumerate(program.split("\n"), 1):
            if len(line) > LONGEST_TYPED:
                reason = f"{len(line)} characters; {LONGEST_TYPED} can be typed on a line"
                raise UserError(f"row {row} has {reason}", str(path))
        keys = _text(replies) if replies.exists() else ""
        programs.append(WitnessCase(OWN, path.stem, {"bas": program, "in": keys}))
    return programs


def _text(path: Path) -> str:
    text = read_bytes(str(path), limit=1_000_000).decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


class Difference(NamedTuple):
    """A difference between the ROM and another source (``who``) in one item (``what``: printout, a
    variable's name, result), with both values."""

    who: str
    what: str
    rom: str
    other: str

    def lines(self) -> list[str]:
        """Return the difference as text, that of a printout as a unified diff."""
        if "\n" not in self.rom + self.other:
            return [f"{self.what}: ROM {self.rom}, {self.who} {self.other}"]
        marks = {code: f"^{chr(code + 64)}" for code in range(32) if code != 10}  # ^D, ^G
        rom, other = (text.translate(marks).split("\n") for text in (self.rom, self.other))
        return list(difflib.unified_diff(rom, other, "ROM", self.who, lineterm="", n=2))


class Outcome(NamedTuple):
    """A case run on the ROM: its kind and name, the sources it was compared with, the differences,
    and what the ROM did, in the captures' form."""

    kind: str
    name: str
    compared: tuple[str, ...]
    differences: list[Difference]
    capture: Any


Sides = dict[str, tuple[Mapping[str, str], Mapping[str, str]]]
"""Source -> items of the ROM and of the source, by name."""


def _compare(kind: str, name: str, sides: Sides, capture: Any) -> Outcome:
    """Return the outcome of a case; an array of another size is one difference."""
    differences = []
    for side, (rom, source) in sides.items():
        items = [x for x in dict.fromkeys([*rom, *source]) if rom.get(x) != source.get(x)]
        if "DIM A" in items:
            items = [item for item in items if not item.startswith("A(")]
        differences += [
            Difference(side, item, rom.get(item, "absent"), source.get(item, "absent"))
            for item in items
        ]
    return Outcome(kind, name, tuple(sides), differences, capture)


def hear(session: Session, case: WitnessCase) -> Outcome:
    """Run a packaged capture, or a program of the user's own, on the ROM, and compare."""
    if case.kind == SCENES:
        return hear_scene(session, case.name, Scene(case.data["scene"]), case.data)
    if case.kind != ARITHMETIC:
        return _hear_program(session, case)
    *arguments, expected = case.data
    result, call = session.calculate(*arguments), " ".join(filter(None, arguments))
    rom = {call: captured.result(result)}
    sides: Sides = {
        CAPTURE: (rom, {call: captured.result(expected)}),
        HERE: (rom, {call: captured.call(*arguments)}),
    }
    return _compare(ARITHMETIC, case.name, sides, [*arguments, result])


def hear_scene(
    session: Session,
    name: str,
    scene: Scene,
    capture: dict[str, Any] | None = None,
    published: str = "",
) -> Outcome:
    """Run a scene on the ROM, and compare with port, emulator and replay, and with its capture or
    what was published.

    The Apple here has no disk system, which takes some lines of a printout as commands; the one of
    1988 had, so those lines are taken out before comparing with what was published.
    """
    from ....program.replay import replay

    rom = session.run_scene(scene)
    mine = _contents(rom)
    sides: Sides = {}
    if capture:
        sides[CAPTURE] = mine, _contents(capture)
    sides[PORT] = mine, _contents(run(scene, dos=False)._asdict())
    sides[EMULATOR] = mine, _contents(copies.run_emulated(scene, dos=False)._asdict())
    replay_result = replay({column: [scene[column]] for column in SCENE})
    fields = {name: text for name in FIELDS if (text := replay_result.printed(name).tolist()[0])}
    sides[REPLAY] = outcome_fields(rom["printout"]), fields
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
    return _compare(SCENES, name, sides, row)


def hear_sample(session: Session, number: int) -> Outcome:
    """Run a published sample on the ROM, and compare with the published printout, too."""
    published = packaged_bytes("impact88.golden", f"printouts/{GOLDEN_RUNS[number]}.txt").decode()
    return hear_scene(session, f"sample {number}", sample(number), published=published)


def _contents(run: Mapping[str, Any]) -> dict[str, str]:
    """Return a run's printout, variables and array elements by name."""
    return {"printout": run["printout"], **captured.memory_contents(run["reals"], run["A"])}


def _hear_program(session: Session, case: WitnessCase) -> Outcome:
    """Run a program on the ROM, and compare its output and final screen with the emulator and with
    its capture, if it has one. A program that does not end is a difference."""
    data, apple, blanks = case.data, session.apple, case.kind != FUZZ
    program, keys = data["bas"], data.get("in", "")
    start = apple.instructions
    rom, sources = {}, {}
    if case.kind != OWN:
        sources[CAPTURE] = {"displayed": data.get("out", "")}
        sources[CAPTURE] |= {"screen": data["scr"]} if "scr" in data else {}
    try:
        rom["displayed"] = session.run_program(program, keys, blanks=blanks)
        rom["screen"] = apple.screen_text()
        machine, screen_text = captured.session(program, keys, blanks=blanks)
        sources[EMULATOR] = {"displayed": screen_text}
        if case.kind == OWN:
            sources[EMULATOR]["screen"] = machine.screen_text()
    except Lost as lost:
        rom = {"displayed": apple.take_output(), "screen": "", "the ROM": str(lost)}
        sources = {EMULATOR: {"the ROM": "not compared"}}
    except TooManyStatements:
        rom["the emulator"] = "came to an end"
        message = f"no end after {captured.MAX_STATEMENTS:,} statements"
        sources[EMULATOR] = {"the emulator": message}
    capture = {**data, "out": rom["displayed"], "instructions": apple.instructions - start}
    if case.kind == OWN or "scr" in data:
        capture["scr"] = rom["screen"]
    sides: Sides = {
        side: ({item: rom[item] for item in items}, items) for side, items in sources.items()
    }
    return _compare(case.kind, case.name, sides, capture)


def record(image: Image, outcomes: list[Outcome], seconds: float) -> dict[str, Any]:
    """Return the object that `impact88 witness --json` prints."""
    comparisons, failing = Counter[str](), Counter[str]()
    for case in outcomes:
        comparisons.update(f"{case.kind}, {side}" for side in case.compared)
        failing.update({f"{case.kind}, {difference.who}" for difference in case.differences})
    wrong = [case for case in outcomes if case.differences]
    return {
        "passed": bool(outcomes) and not wrong,
        "versions": {**frame.versions(), "py65": metadata.version("py65")},
        "hashes": {"rom_sha1": image.sha1, **frame.hashes()},
        "rom": "Apple II Plus" if image.known else "unknown",
        "cases": Counter(case.kind for case in outcomes),
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
            for case in wrong[:MAX_CASES_LISTED]
        ],
        "seconds": round(seconds, 1),
    }


def save(folder: str, outcomes: Iterable[Outcome]) -> None:
    """Write what the ROM did as captures into a folder, which is created if needed.

    Each file holds the captures of this call only. Raises UserError when a place cannot be written
    to.
    """
    files: dict[str, list[str]] = {}
    index: dict[str, str] = {}
    for kind, name, _, _, capture in outcomes:
        if kind == ARITHMETIC:
            place, line = os.path.join(ARITHMETIC, f"{capture[0]}.tsv.gz"), "\t".join(capture)
            files.setdefault(place, []).append(line)
        elif kind == SCENES:
            files.setdefault(f"{SCENES}.jsonl.gz", []).append(json.dumps(capture))
        elif kind == FUZZ:
            row = {"name": name, "program": capture["bas"], "keyboard": capture["in"]}
            line = json.dumps({**row, "output": capture["out"]})
            files.setdefault(f"{FUZZ}.jsonl.gz", []).append(line)
        else:
            for ending in filter(capture.get, ENDINGS):
                files[os.path.join(PROGRAMS, f"{name}.{ending}")] = [capture[ending]]
            if kind != OWN:
                index[name] = str(capture["instructions"])
    if index:
        programs = {file.name: file for file in files_of(captured.golden(), PROGRAMS)}
        text = programs["index.tsv"].read_text("utf-8")
        heading, *rows = (line.split("\t") for line in text.splitlines())
        rows = [[*row[:-1], index[row[0]]] for row in rows if row[0] in index]
        files[os.path.join(PROGRAMS, "index.tsv")] = ["\t".join(r) + "\n" for r in (heading, *rows)]
    packed = {  # mtime 0: the same lines always give the same bytes
        name: gzip.compress("".join(f"{line}\n" for line in lines).encode(), mtime=0)
        if name.endswith(".gz")
        else "".join(lines).encode("latin-1")
        for name, lines in files.items()
    }
    write_folder(folder, packed)
