"""Cases for the ROM: the packaged captures, to be done again, and a folder of programs."""

from __future__ import annotations

import gzip
import json
from collections.abc import Iterator
from functools import cache
from importlib import resources
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

from ..errors import UserError
from ..files import read_bytes
from .routines import OPERATIONS

SCENES, PROGRAMS, FUZZ, ARITHMETIC = "scenes", "programs", "fuzz", "arithmetic"
ALL = "all"
OWN = "own programs"
PROGRAM_LIMIT = 1_000_000
LONGEST_TYPED = 239
"""Characters of the longest line the monitor's line reader keeps."""


class Case(NamedTuple):
    """One capture: which kind, its name, and what it holds (a row of scenes or fuzz, a program's
    texts by ending, or an arithmetic file's five columns)."""

    kind: str
    name: str
    data: Any


def cases(count: int | None, seed: int = 0) -> list[Case]:
    """Captures, drawn evenly from scenes, programs and the routines of the arithmetic, none twice;
    all of them for ``count`` None."""
    if count is None:
        return [*_scenes(), *_programs(), *_fuzz()] + [
            case for operation in OPERATIONS for case in _calls(operation)
        ]
    rng = Random(seed)
    programs = [*_programs(), *_fuzz()]
    decks = [rng.sample(_scenes(), len(_scenes())), rng.sample(programs, len(programs))]
    routines = rng.sample(OPERATIONS, len(OPERATIONS))
    drawn: list[Case] = []
    used: set[tuple[str, int]] = set()
    for turn in range(count):
        deck = turn % 3
        if deck < 2 and decks[deck]:
            drawn.append(decks[deck].pop())
            continue
        calls = _calls(operation := routines[turn // 3 % len(routines)])
        place = rng.randrange(len(calls))
        if (operation, place) not in used:
            used.add((operation, place))
            drawn.append(calls[place])
    return drawn


def own_programs(folder: str) -> list[Case]:
    """Every ``.bas`` in a folder, with the replies in the ``.in`` beside it if there is one.

    Raises UserError when there is none, one cannot be read, or a line is too long to be typed.
    """
    try:
        paths = sorted(path for path in Path(folder).iterdir() if path.suffix.lower() == ".bas")
    except OSError as error:
        raise UserError(f"cannot be read: {error.strerror or error}", folder) from None
    if not paths:
        raise UserError("holds no .bas", folder)
    return [_own_program(path) for path in paths]


def _own_program(path: Path) -> Case:
    program, replies = _text(path), path.with_suffix(".in")
    for row, line in enumerate(program.split("\n"), 1):
        if len(line) > LONGEST_TYPED:
            raise UserError(
                f"row {row} has {len(line)} characters; {LONGEST_TYPED} can be typed on a line",
                str(path),
            )
    return Case(OWN, path.stem, {"bas": program, "in": _text(replies) if replies.exists() else ""})


def _text(path: Path) -> str:
    text = read_bytes(str(path), limit=PROGRAM_LIMIT).decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _golden() -> Any:
    return resources.files("impact88.golden")


def _rows(name: str) -> list[Case]:
    text = gzip.decompress(_golden().joinpath(f"{name}.jsonl.gz").read_bytes()).decode()
    rows = map(json.loads, text.splitlines())
    return [Case(name, row.get("id") or row["name"], row) for row in rows]


@cache
def _scenes() -> list[Case]:
    return _rows(SCENES)


@cache
def _fuzz() -> list[Case]:
    return _rows(FUZZ)


@cache
def _programs() -> list[Case]:
    files = {file.name: file for file in _golden().joinpath(PROGRAMS).iterdir()}
    programs = []
    for name in sorted(name.removesuffix(".bas") for name in files if name.endswith(".bas")):
        texts = {
            ending: files[f"{name}.{ending}"].read_bytes().decode("latin-1")
            for ending in ("bas", "in", "out", "scr")
            if f"{name}.{ending}" in files
        }
        programs.append(Case(PROGRAMS, name, texts))
    return programs


@cache
def _calls(operation: str) -> list[Case]:
    data = _golden().joinpath(ARITHMETIC, f"{operation}.tsv.gz").read_bytes()
    rows = gzip.decompress(data).decode().splitlines()
    return [
        Case(ARITHMETIC, f"{operation}-{place:04d}", row.split("\t"))
        for place, row in enumerate(rows)
    ]


def program_index() -> Iterator[list[str]]:
    """The rows of programs/index.tsv, its heading first."""
    for line in _golden().joinpath(PROGRAMS, "index.tsv").read_text("utf-8").splitlines():
        yield line.split("\t")
