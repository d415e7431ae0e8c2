"""Programs written apart from the package, as text, with bugs put in: what they answer.

A bug is a text in a program and what stands there instead. The programs are those of `heldout` and
`strangers`; the package has no part in any of them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np

PROGRAMS: dict[str, str] = {}
"""Name -> text, which defines ``run``."""

Bug = tuple[str, str]
"""What stands in the correct program, and what stands there in this one."""


def results(program: str) -> tuple[str, ...]:
    """The results that a program gives."""
    return tuple(compiled(program)(_SOME))


_SOME = {
    name: 0.1 * place
    for place, name in enumerate(
        "E MU EM DA DB GA PA PB TA TB MA MB IA IB UX UY WA VX VY WB M".split(), 1
    )
}


def source(program: str, *bugs: Bug) -> str:
    """The text of a program with bugs; each must be in it exactly once."""
    text = PROGRAMS[program]
    for old, new in bugs:
        assert text.count(old) == 1, (program, old, text.count(old))
        text = text.replace(old, new)
    return text


@lru_cache(None)
def compiled(program: str, *bugs: Bug) -> Any:
    import cmath

    names: dict[str, Any] = {"np": np, "cmath": cmath, **vars(math)}
    exec(source(program, *bugs), names)
    return names["run"]


def answers(
    scenes: list[Mapping[str, str]], program: str, *bugs: Bug
) -> list[dict[str, float | None]]:
    """What a program answers; None for each result where it refuses."""
    found = []
    for scene in scenes:
        g = {name: float(text) for name, text in scene.items()}
        row: Mapping[str, Any] = {}
        bodies = ("MA", "MB") if g["M"] == 4 else ("MA", "MB", "IA", "IB")
        if min(g[name] for name in bodies) > 0:
            try:
                with np.errstate(all="ignore"):
                    row = compiled(program, *bugs)(g)
            except (ArithmeticError, np.linalg.LinAlgError):
                row = {}
        values = {name: row.get(name) for name in results(program)}
        found.append(
            {n: None if x is None or not math.isfinite(x) else float(x) for n, x in values.items()}
        )
    return found
