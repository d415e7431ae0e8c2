"""Other programs for the planar impact, right or with a mistake, and their answers to scenes.

``programs/`` holds correct ones; one without ``run`` of its own is put into ``frame.txt``. The
package has no part in any of them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

FOLDER = Path(__file__).with_name("programs")
BODY = "    # here the program\n"
Edit = tuple[str, str]
"""Text of the correct program, and the text that replaces it."""


def source(program: str, edits: Sequence[Edit] = ()) -> str:
    """Return the text of a program with edits; what each changes must be in it exactly once."""
    text = (FOLDER / f"{program}.txt").read_text(encoding="utf-8")
    if "def run(" not in text:
        text = (FOLDER / "frame.txt").read_text(encoding="utf-8").replace(BODY, text)
    for old, new in edits:
        assert text.count(old) == 1, (program, old, text.count(old))
        text = text.replace(old, new)
    return text


def answers(
    scenes: Sequence[Mapping[str, str]], program: str, edits: Sequence[Edit] = ()
) -> dict[str, list[str]]:
    """Return the answers of a program as it writes them, by result; "" where it refuses."""
    run = _function(source(program, edits))
    rows = [_row(run, {name: float(x) for name, x in scene.items()}) for scene in scenes]
    names = max(rows, key=len)
    return {name: [_cell(row.get(name)) for row in rows] for name in names}


@cache
def _function(text: str) -> Any:
    names: dict[str, Any] = {"np": np, **vars(math)}
    exec(text, names)
    return names["run"]


def _row(run: Any, scene: Mapping[str, float]) -> Mapping[str, float]:
    bodies = ("MA", "MB") if scene["M"] == 4 else ("MA", "MB", "IA", "IB")
    if min(scene[name] for name in bodies) <= 0:
        return {}
    try:
        with np.errstate(all="ignore"):
            return run(scene)
    except (ArithmeticError, np.linalg.LinAlgError):
        return {}


def _cell(value: float | None) -> str:
    return "" if value is None or not math.isfinite(value) else repr(float(value))
