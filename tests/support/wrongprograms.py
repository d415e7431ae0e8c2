"""Other programs for the planar impact, right and wrong, and their answers to scenes.

``programs/`` holds correct ones, in C, JavaScript, awk and Python (``.txt``; one without ``run`` of
its own is put into ``frame.txt``). A wrong one is a correct one with edits of its text, as
``wrongprograms.txt`` lists them. The package has no part in any of them.
"""

from __future__ import annotations

import cmath
import csv
import hashlib
import io
import math
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from impact88.names import SCENE

FOLDER = Path(__file__).with_name("programs")
FOREIGN = sorted(path.name for path in FOLDER.iterdir() if path.suffix != ".txt")
CORRECT = sorted(path.stem for path in FOLDER.glob("*.txt") if path.stem != "frame")
TOOLS = {".c": "gcc", ".js": "node", ".awk": "awk"}
BODY = "    # here the program\n"

Edit = tuple[str, str]
"""Text of the correct program, and the text that replaces it."""
Numbers = dict[str, float]
Columns = dict[str, list[str]]


class Wrong(NamedTuple):
    """A wrong program: the correct one, its edits, the cause to be named, and the
    condition under which it is wrong ("" where it always is)."""

    program: str
    edits: tuple[Edit, ...] = ()
    says: str = ""
    where: str = ""


def _read() -> dict[str, list[Wrong]]:
    """Return `CATALOGUE`."""
    catalogue: dict[str, list[Wrong]] = {}
    text = FOLDER.with_name("wrongprograms.txt").read_text(encoding="utf-8")
    for line in text.splitlines():
        if line.startswith("## "):
            cases = catalogue.setdefault(line[3:].partition(":")[0], [])
        elif line.startswith("    "):
            says, _, where = line.strip().rstrip("]").partition("[")
            cases[-1] = cases[-1]._replace(says=says.strip(), where=where)
        elif line and not line.startswith("# "):
            program, *texts = (part.replace("\\n", "\n") for part in line.split(" | "))
            edits = zip(texts[::2], texts[1::2], strict=True)
            cases.append(Wrong(program, tuple(edits)))
    return catalogue


CATALOGUE = _read()
"""Section of the list -> its wrong programs."""
CONVENTIONS = {case.says: case for case in CATALOGUE["conventions"]}
"""Cause to be named -> the program."""


def is_available(program: str) -> bool:
    """Return True if the program's compiler or interpreter is installed."""
    tool = TOOLS.get(Path(program).suffix)
    return tool is None or shutil.which(tool) is not None


def source(program: str, edits: Sequence[Edit] = ()) -> str:
    """Return the text of a program with edits; what each changes must be in it exactly once."""
    path = FOLDER / (program if program in FOREIGN else f"{program}.txt")
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".txt" and "def run(" not in text:
        text = (FOLDER / "frame.txt").read_text(encoding="utf-8").replace(BODY, text)
    for old, new in edits:
        assert text.count(old) == 1, (program, old, text.count(old))
        text = text.replace(old, new)
    return text


def answers(
    scenes: Sequence[Mapping[str, str]],
    program: str,
    edits: Sequence[Edit] = (),
    flags: tuple[str, ...] = (),
    throughout: Sequence[Edit] = (),
) -> Columns:
    """Return the answers of a program: the texts it writes, by result, "" where it
    refuses. ``flags``: the compiler's; ``throughout``: edits of what may be in it many times."""
    text = source(program, edits)
    for old, new in throughout:
        assert old in text, (program, old)
        text = text.replace(old, new)
    if program in FOREIGN:
        return _written(scenes, _command(program, text, flags))
    run = _python(text)
    rows = [_row(run, {name: float(x) for name, x in scene.items()}) for scene in scenes]
    return {name: [_cell(row.get(name)) for row in rows] for name in run(SOME)}


SOME = {name: 0.1 * place for place, name in enumerate(SCENE, 1)}
"""A scene that every program answers."""


@cache
def _python(text: str) -> Any:
    names: dict[str, Any] = {"np": np, "cmath": cmath, **vars(math)}
    names |= {"exchanged": exchanged, "scaled": scaled}
    exec(text, names)
    return names["run"]


def _row(run: Any, scene: Numbers) -> Mapping[str, Any]:
    bodies = ("MA", "MB") if scene["M"] == 4 else ("MA", "MB", "IA", "IB")
    if min(scene[name] for name in bodies) <= 0:
        return {}
    try:
        with np.errstate(all="ignore"):
            return run(scene)
    except (ArithmeticError, np.linalg.LinAlgError):
        return {}


def _cell(value: Any) -> str:
    return "" if value is None or not math.isfinite(value) else repr(float(value))


def exchanged(values: Numbers, pairs: str) -> Numbers:
    """Values with those of each pair of names exchanged, as far as they are there."""
    result = dict(values)
    for first, second in map(str.split, pairs.split(",")):
        if first in values:
            result[first], result[second] = values[second], values[first]
    return result


def scaled(values: Numbers, names: str, factor: float) -> Numbers:
    """Values with those of some names multiplied."""
    return {name: x * factor if name in names.split() else x for name, x in values.items()}


# --- in other languages: each reads a CSV of scenes and writes one of results ---


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


def _written(scenes: Sequence[Mapping[str, str]], command: list[str]) -> Columns:
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(SCENE)
    writer.writerows([scene[name] for name in SCENE] for scene in scenes)
    done = subprocess.run(
        command, input=out.getvalue(), capture_output=True, text=True, check=True, timeout=60
    )
    names, *rows = csv.reader(io.StringIO(done.stdout))
    assert len(rows) == len(scenes), (command, len(rows))
    return {name: [row[place] for row in rows] for place, name in enumerate(names)}
