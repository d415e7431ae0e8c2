"""A slip: a mistake or a convention that a program of the impact equations may have.

It changes how the program reads a scene (`slipsreading`), what stands in its equations
(`slipsfilling`), or how it shows results (`slipsshowing`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Columns = dict[str, Floats]
Reads = Callable[[Columns], Columns]
"""The scene's columns -> those that are read otherwise."""
Fills = Callable[[Floats, Floats, Columns], object]
"""Changes matrices (n, 6, 6) and right-hand sides (n, 6) of scenes in place."""
Shows = Callable[[Columns, Columns], Columns]
"""Results, and the scene as it is -> the results that are shown otherwise."""


def _as_it_is(scene: Columns) -> Columns:
    return {}


def _shown_as_found(results: Columns, scene: Columns) -> Columns:
    return {}


class Slip(NamedTuple):
    """A mistake or a convention. ``says`` names it; ``late``: it is applied after the others (what
    hangs on the sign of sliding); ``common``: it is tried together with others, too."""

    says: str
    scene: Reads = _as_it_is
    equations: Fills | None = None
    results: Shows = _shown_as_found
    late: bool = False
    common: bool = True
