"""Work against size: no reader takes more than its share of work for a larger input.

A reader that looks at everything again for every part does 64 times the work for 8 times as much;
one that does not does 8 times the work, or less where starting costs something. The bound lies
between the two, far from both. Work is counted in calls of functions, which no other program on the
machine can change; `IMPACT88_SWEEP` measures processor time too, which also sees what one call of a
library does.
"""

from __future__ import annotations

import io
import json
import os
import sys
import time
import zipfile
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import numpy as np
import pytest
from longer import long_but

from impact88.collision.casescene import sample
from impact88.errors import UserError
from impact88.interface.commands.cli import main
from impact88.names import SCENE
from impact88.tables.budget import MAX_DECODED, Budget
from impact88.tables.lines import Lines

TIMES = 8
MOST = 28.0
"""Half way from 8 to 64, in ratios."""
TRIES = 3
VALUES = dict(sample(1))
HEADER, ROW = ",".join(SCENE), ",".join(VALUES[name] for name in SCENE)
OBJECT = json.dumps(VALUES)
PRINTOUT = (Path(__file__).parents[2] / "legacy" / "run1-as-printed.txt").read_text("utf-8")

Input = tuple[list[str], bytes]


def npz(count: int) -> bytes:
    file = io.BytesIO()
    arrays = {name: np.array(float(text)) for name, text in VALUES.items()}
    arrays |= {f"note{n}": np.zeros(1) for n in range(count)}
    with zipfile.ZipFile(file, "w") as archive:
        for name, array in arrays.items():
            with archive.open(f"{name}.npy", "w") as member:
                np.lib.format.write_array(member, array)
    return file.getvalue()


def table(*lines: str) -> bytes:
    return "\n".join(lines).encode()


READERS: dict[str, tuple[int, Callable[[int], Input]]] = {
    "rows of a CSV": (250, lambda n: (["solve", "t.csv"], table(HEADER, *[ROW] * n))),
    "columns of a CSV": (
        1000,
        lambda n: (
            ["solve", "t.csv"],
            table(HEADER + "".join(f",n{i}" for i in range(n)), ROW + ",1" * n),
        ),
    ),
    "unusable rows of a CSV": (600, lambda n: (["solve", "t.csv"], table(HEADER, *["1,,"] * n))),
    "a long field of a CSV": (
        30_000,
        lambda n: (["solve", "t.csv"], table(f"{HEADER},x", f"{ROW},{'z' * (n // 3)}")),
    ),
    "lines in quotes of a CSV": (
        4000,
        lambda n: (["solve", "t.csv"], table(f"{HEADER},x", f'{ROW},"' + "\n" * n + '"')),
    ),
    "rows of JSON Lines": (250, lambda n: (["solve", "t.jsonl"], table(*[OBJECT] * n))),
    "keys of a JSON line": (
        1000,
        lambda n: (
            ["solve", "t.jsonl"],
            table(json.dumps({**VALUES, **{f"n{i}": i for i in range(n)}})),
        ),
    ),
    "nesting of a JSON line": (
        4000,
        lambda n: (["solve", "t.jsonl"], table(f'{OBJECT[:-1]}, "x": {"[" * n}{"]" * n}}}')),
    ),
    "rows to compare": (
        400,
        lambda n: (["compare", "t.csv"], table(f"{HEADER},VAX", *[f"{ROW},-13.26"] * n)),
    ),
    "arrays of an .npz": (80, lambda n: (["solve", "t.npz", "-o", "o.npz"], npz(n))),
    "questions to the oracle": (
        3,
        lambda n: (
            ["oracle", "t.jsonl", "--no-reference"],
            table(*[json.dumps({"id": i, "scene": VALUES}) for i in range(n)]),
        ),
    ),
    "lines of a scene file": (
        900,
        lambda n: (["run", "t.toml"], table(*[f"n{i} = {i}" for i in range(n)])),
    ),
    "nesting of a scene file": (
        8000,
        lambda n: (["run", "t.toml"], table("title = " + "[" * n)),
    ),
    "a dotted key of a scene file": (
        4000,
        lambda n: (["run", "t.toml"], table("a" + ".a" * n + " = 1")),
    ),
    "lines of a program": (
        100,
        lambda n: (["basic", "t.bas"], table(*[f"{i} A={i}" for i in range(1, n + 1)])),
    ),
    "a long line typed": (5000, lambda n: (["basic", "t.bas"], table("10 " + "A" * n))),
    "printouts": (1, lambda n: (["verify", "--brief", "t.txt"], table(*[PRINTOUT] * n))),
    "one letter to verify": (5000, lambda n: (["verify", "t.txt"], b"x" * n)),
}
LONG = (
    "columns of a CSV",
    "rows of JSON Lines",
    "questions to the oracle",
    "lines of a scene file",
    "printouts",
    "one letter to verify",
)
"""Readers that take half a second."""
TIMED = bool(os.environ.get("IMPACT88_SWEEP"))
if TIMED:  # seconds for any number of rows
    READERS["unlike rows to compare"] = (
        20,
        lambda n: (
            ["compare", "t.csv"],
            table(f"{HEADER},VAX", *[f"{ROW},{i}" for i in range(n)]),
        ),
    )


def work(case: Input) -> tuple[int, float]:
    """Calls of functions, and seconds of processor time, of one command."""
    arguments, data = case
    name = next(word for word in arguments if word.startswith("t."))
    Path(name).write_bytes(data)
    count = 0

    def profile(frame: object, event: str, argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
        began = time.process_time()
        sys.setprofile(None if TIMED else profile)
        try:
            status = main(arguments)
        finally:
            sys.setprofile(None)
    assert status in (0, 1, 2)
    return count, time.process_time() - began


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "stdin", io.StringIO())


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    "reader", long_but(READERS, kept=[i for i, name in enumerate(READERS) if name not in LONG])
)
def test_work_grows_with_size_and_not_faster(reader: str) -> None:
    size, make = READERS[reader]
    if TIMED:
        small, large = (min(work(make(n))[1] for _ in range(TRIES)) for n in (size, TIMES * size))
    else:
        work(make(1))  # imports and caches
        small, large = (work(make(n))[0] for n in (size, TIMES * size))
    assert large < MOST * small, f"{small}, and {TIMES} times the size {large}"


@pytest.mark.usefixtures("folder")
def test_a_reader_that_begins_again_for_every_line_is_noticed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The bound lies below what a quadratic reader takes."""
    _, make = READERS["rows of JSON Lines"]
    size = 30
    next_line = Lines.__next__

    def next_line_again(lines: Lines) -> str:
        for _ in range(40 * lines.number):  # a line again costs more
            len("")
        return next_line(lines)

    monkeypatch.setattr(Lines, "__next__", next_line_again)
    small, large = (work(make(count))[0] for count in (size, TIMES * size))
    assert large >= MOST * small


def test_what_a_table_decodes_to_is_added_up() -> None:
    budget = Budget("-")
    for part in (MAX_DECODED // 2, MAX_DECODED - MAX_DECODED // 2):
        budget.take(part)
    with pytest.raises(UserError, match=f"unpack to {MAX_DECODED + 1:,}"):
        budget.take(1)
