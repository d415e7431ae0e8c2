"""Cases for the ROM: the packaged captures, to be done again, and a folder of programs."""

from functools import cache
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

from ..checking import captured
from ..checking.captured import ARITHMETIC, FUZZ, PROGRAMS, SCENES
from ..errors import UserError
from ..files import read_bytes

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
    scenes = [Case(SCENES, row["id"], row) for row in captured.rows(golden, SCENES)]
    programs = [Case(PROGRAMS, *one) for one in captured.programs(golden).items()]
    programs += [Case(FUZZ, row["name"], row) for row in captured.rows(golden, FUZZ)]
    calls = [
        [Case(ARITHMETIC, f"{operation}-{place:04d}", row) for place, row in enumerate(rows)]
        for operation, rows in captured.calls(golden).items()
    ]
    return [scenes, programs, *calls]


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
    text = read_bytes(str(path), limit=PROGRAM_LIMIT).decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")
