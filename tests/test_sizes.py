"""Time against size: no reader takes more than its share of time for a larger input.

A reader that looks at everything again for every part takes 64 times as long for 8 times as much;
one that does not takes 8 times as long, or less where starting costs something. The bound lies
between the two, far from both; processor time is measured, and the best of some tries.
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

from impact88.cli import main
from impact88.names import SCENE
from impact88.scene import sample

TIMES = 8
MOST = 28.0
"""Half way from 8 to 64, in ratios."""
TRIES = 2
LONG_ENOUGH = 0.5
"""Seconds of one try that another one need not confirm."""
VALUES = dict(sample(1))
HEADER, ROW = ",".join(SCENE), ",".join(VALUES[name] for name in SCENE)
OBJECT = json.dumps(VALUES)
PRINTOUT = (Path(__file__).parents[1] / "legacy" / "run1-as-printed.txt").read_text("utf-8")

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
        2000,
        lambda n: (
            ["solve", "t.csv"],
            table(HEADER + "".join(f",n{i}" for i in range(n)), ROW + ",1" * n),
        ),
    ),
    "unusable rows of a CSV": (600, lambda n: (["solve", "t.csv"], table(HEADER, *[",,"] * n))),
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
        2000,
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
    "a long line typed": (20_000, lambda n: (["basic", "t.bas"], table("10 " + "A" * n))),
    "printouts": (1, lambda n: (["verify", "--brief", "t.txt"], table(*[PRINTOUT] * n))),
    "one letter to verify": (60_000, lambda n: (["verify", "t.txt"], b"x" * n)),
}
if os.environ.get("IMPACT88_SWEEP"):  # seconds for any number of rows
    READERS["unlike rows to compare"] = (
        20,
        lambda n: (
            ["compare", "t.csv"],
            table(f"{HEADER},VAX", *[f"{ROW},{i}" for i in range(n)]),
        ),
    )


def seconds(case: Input, tries: int = 1) -> float:
    arguments, data = case
    name = next(word for word in arguments if word.startswith("t."))
    Path(name).write_bytes(data)
    best = float("inf")
    for _ in range(tries):
        began = time.process_time()
        with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
            status = main(arguments)
        best = min(best, time.process_time() - began)
        assert status in (0, 1, 2)
        if best > LONG_ENOUGH:
            break
    return best


@pytest.mark.parametrize("reader", READERS)
def test_time_grows_with_size_and_not_faster(
    reader: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "stdin", io.StringIO())
    size, make = READERS[reader]
    small, large = seconds(make(size), TRIES), seconds(make(TIMES * size))
    if large >= MOST * small:  # once more: something else may have run
        large = min(large, seconds(make(TIMES * size), TRIES - 1))
    assert large < MOST * small, f"{small:.4f} s, and {TIMES} times the size {large:.4f} s"
