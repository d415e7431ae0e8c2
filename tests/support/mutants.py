"""Mutants: one rule changed in one line, and the tests that should notice.

    python tests/support/mutants.py make SEED [ROOM]   draws them anew into mutants.patches, of all
                                                       rooms or of one
    python tests/support/mutants.py run [WORD ...]     runs each (those whose file has a WORD)

Each mutant is a patch: a file, the line as it is, the line as it is changed. Those of the core are
drawn, one token each; those of the rooms around it were written by hand, before a look at the tests
(a sign, a comparison, a term left out, a wrong unit). A line that is no longer there is reported as
gone. A run takes a copy of the tree, so the checkout is not touched,
and tells of each mutant whether a test failed (killed), all passed (SURVIVED), or none of them
ended in time (killed, too: the mutant never ends). A survivor is a missing test, dead code, or a
change that means the same.
"""

from __future__ import annotations

import io
import keyword
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import tokenize
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
STORED = Path(__file__).with_suffix(".patches")
PACKAGE = "port/impact88"
TIMEOUT = 600
"""Seconds that a room's tests may take."""
DOORS = "tests/doors"
"""Tests that every room's are followed by."""

ROOMS: dict[str, tuple[str, int]] = {
    "apple/applesoft": ("tests/apple/applesoft", 18),
    "apple/emulator": ("tests/apple/emulator", 18),
    "program": ("tests/program", 18),
    "collision": ("tests/collision", 18),
    "mechanics/closedform": ("tests/mechanics", 20),
    "mechanics": ("tests/mechanics", 0),
    "casework/reconstruction": ("tests/casework/reconstruction", 0),
    "casework/optimization": ("tests/casework/optimization tests/casework/uncertainty", 0),
    "casework/uncertainty": ("tests/casework/uncertainty", 0),
    "conformance": ("tests/conformance", 0),
    "printouts": ("tests/printouts", 0),
    "tables": ("tests/tables", 0),
}
"""Room -> its tests, and how many mutants are drawn; 0 where they are written by hand."""

SWAPS = {
    "+": "-",
    "-": "+",
    "*": "/",
    "/": "*",
    "//": "%",
    "%": "//",
    "<": "<=",
    "<=": "<",
    ">": ">=",
    ">=": ">",
    "==": "!=",
    "!=": "==",
    "<<": ">>",
    ">>": "<<",
    "&": "|",
    "|": "&",
    "and": "or",
    "or": "and",
    "True": "False",
    "False": "True",
    "continue": "break",
    "break": "continue",
    "min": "max",
    "max": "min",
    "any": "all",
    "all": "any",
}
"""Token -> what stands in its place; a whole number becomes the next one."""


class Mutant(NamedTuple):
    path: str
    number: int
    old: str
    new: str


def room_of(path: str) -> str:
    return next(room for room in ROOMS if path.startswith(f"{PACKAGE}/{room}/"))


def mutants_of(path: str) -> Iterator[Mutant]:
    """Every mutant of a file."""
    text = (ROOT / path).read_text(encoding="utf-8")
    lines = text.split("\n")
    before = ""
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        row, start = token.start
        new = SWAPS.get(token.string)
        if token.type == tokenize.NUMBER and token.string.isdecimal():
            new = str(int(token.string) + 1)
        is_sign = not before or before in "([{,=:" or keyword.iskeyword(before)
        if token.type not in (tokenize.NL, tokenize.COMMENT):
            before = token.string
        if new is None or (is_sign and token.string in ("*", "-", "+", "/")):
            continue  # a sign, or what unpacks
        if token.string in ("|", "*", "/") and re.search(r"\bdef \w|\w: ", lines[row - 1]):
            continue  # an annotation
        line = lines[row - 1]
        changed = line[:start] + new + line[start + len(token.string) :]
        yield Mutant(path, row, line, changed)


def make(seed: int, only: str) -> list[Mutant]:
    """Draw the mutants of every room, or of one beside those stored; not more than one a line."""
    rng = random.Random(seed)
    drawn = [
        mutant
        for mutant in stored()
        if not ROOMS[room := room_of(mutant.path)][1] or (only and room != only)
    ]
    for room, (_, count) in ROOMS.items():
        if only not in ("", room):
            continue
        files = sorted((ROOT / PACKAGE / room).rglob("*.py"))
        all_ = [m for file in files for m in mutants_of(file.relative_to(ROOT).as_posix())]
        by_line = {(mutant.path, mutant.number): mutant for mutant in rng.sample(all_, len(all_))}
        drawn += rng.sample(sorted(by_line.values()), count)
    return drawn


def written(mutants: list[Mutant]) -> str:
    return "".join(f"@ {m.path}:{m.number}\n- {m.old}\n+ {m.new}\n" for m in mutants)


def stored() -> list[Mutant]:
    lines = STORED.read_text(encoding="utf-8").splitlines()
    found = []
    for head, old, new in zip(lines[::3], lines[1::3], lines[2::3], strict=True):
        path, _, number = head.removeprefix("@ ").rpartition(":")
        found.append(Mutant(path, int(number), old[2:], new[2:]))
    return found


def outcome(mutant: Mutant, tree: Path) -> str:
    """Return how a mutant fares in a copy of the tree, which is left as it was."""
    file = tree / mutant.path
    text = file.read_text(encoding="utf-8") if file.exists() else ""
    lines = text.split("\n")
    places = [number for number, line in enumerate(lines, 1) if line == mutant.old]
    if not places:
        return "gone"
    number = min(places, key=lambda place: abs(place - mutant.number))
    lines[number - 1] = mutant.new
    file.write_text("\n".join(lines), encoding="utf-8")
    try:
        for tests in (ROOMS[room_of(mutant.path)][0].split(), [DOORS]):
            done = subprocess.run(
                [sys.executable, "-m", "pytest", *"-n 0 -x -q -p no:cacheprovider".split(), *tests],
                cwd=tree,
                env={**os.environ, "PYTHONPATH": str(tree / "port")},
                capture_output=True,
                timeout=TIMEOUT,
                text=True,
            )
            failed = [x for x in done.stdout.splitlines() if x.startswith(("FAILED", "ERROR"))]
            if done.returncode:
                by = failed[0].split(" - ")[0].split(maxsplit=1)[1] if failed else "a crash"
                return f"killed by {by}"
    except subprocess.TimeoutExpired:
        return "killed (never ends)"
    finally:
        file.write_text(text, encoding="utf-8")
    return "SURVIVED"


def run(words: list[str]) -> None:
    with tempfile.TemporaryDirectory() as work:
        tree = Path(work) / "tree"
        ignored = shutil.ignore_patterns(".git", ".venv", "build", "*.egg-info", "__pycache__")
        shutil.copytree(ROOT, tree, ignore=ignored)
        counts: dict[str, int] = {}
        for mutant in stored():
            if words and not any(word in mutant.path for word in words):
                continue
            found = outcome(mutant, tree)
            kind = found.split()[0]
            counts[kind] = counts.get(kind, 0) + 1
            print(f"{mutant.path}:{mutant.number}: {found}", flush=True)
            if kind == "SURVIVED":
                print(f"  - {mutant.old.strip()}\n  + {mutant.new.strip()}", flush=True)
        print(", ".join(f"{count} {kind}" for kind, count in counts.items()))


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["make", seed, *room] if len(room) < 2:
            STORED.write_text(written(make(int(seed), *room or [""])), encoding="utf-8")
        case ["run", *words]:
            run(words)
        case _:
            sys.exit(__doc__)
