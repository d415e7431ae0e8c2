"""Run programs in C, JavaScript and awk (``foreign/``), as they are and with mistakes put in.

Each reads a CSV of scenes on standard input and writes a CSV of results.
"""

from __future__ import annotations

import csv
import hashlib
import io
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

from impact88.names import SCENE

FOLDER = Path(__file__).with_suffix("")
PROGRAMS = (
    "trial.c",
    "phases.c",
    "columns.c",
    "bodies.js",
    "shooting.js",
    "gyration.awk",
    "momentum.awk",
)
TOOLS = {".c": "gcc", ".js": "node", ".awk": "awk"}

Change = tuple[str, str]
"""What stands in the correct program, and what stands there in this one."""


def is_available(program: str) -> bool:
    """Whether the language's compiler or interpreter is on this machine."""
    return shutil.which(TOOLS[Path(program).suffix]) is not None


def source(program: str, changes: Sequence[Change] = ()) -> str:
    """The text of a program with changes; each must be in it exactly once."""
    text = (FOLDER / program).read_text(encoding="utf-8")
    for old, new in changes:
        assert text.count(old) == 1, (program, old, text.count(old))
        text = text.replace(old, new)
    return text


@cache
def _folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory()


def _command(program: str, text: str, flags: tuple[str, ...]) -> list[str]:
    """Write the program, compile it where that is needed, and return the command that runs it."""
    name = hashlib.sha256((text + repr(flags)).encode()).hexdigest()[:16]
    path = Path(_folder().name) / f"{name}{Path(program).suffix}"
    path.write_text(text, encoding="utf-8")
    if path.suffix == ".c":
        binary = path.with_suffix("")
        subprocess.run(["gcc", "-O1", *flags, "-w", "-o", binary, path, "-lm"], check=True)
        return [str(binary)]
    return ["node", str(path)] if path.suffix == ".js" else ["awk", "-f", str(path)]


def answers(
    scenes: Sequence[Mapping[str, str]],
    program: str,
    changes: Sequence[Change] = (),
    flags: tuple[str, ...] = (),
    throughout: Sequence[Change] = (),
) -> dict[str, list[str]]:
    """What a program answers: the texts it writes, by result. ``throughout``: changes of what may
    be in it many times."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(SCENE)
    writer.writerows([scene[name] for name in SCENE] for scene in scenes)
    text = source(program, changes)
    for old, new in throughout:
        assert old in text, (program, old)
        text = text.replace(old, new)
    command = _command(program, text, flags)
    done = subprocess.run(
        command, input=out.getvalue(), capture_output=True, text=True, check=True, timeout=60
    )
    names, *rows = csv.reader(io.StringIO(done.stdout))
    assert len(rows) == len(scenes), (program, changes, len(rows))
    return {name: [row[place] for row in rows] for place, name in enumerate(names)}
