"""A cause that would make a page agree: what it is called, and what it says of the page.

The kinds are the words a reader sees; `otherinputs`, `otherprints` and `otherruns` make hypotheses
of them.
"""

from __future__ import annotations

from typing import NamedTuple

from ..recovery import replays
from ..recovery.rereading import Change

SWAPPED = "two numbers in each other's place"
SIDES_SWAPPED = "A and B exchanged"
AXES_SWAPPED = "x and y exchanged"
RESULTS_SWAPPED = "results in each other's place"
RADIANS = "angle in radians"
AS_RADIANS = "degrees taken for radians"
UNITS = "another unit"
RESULT_UNITS = "results in another unit"
MU_SIGN = "sign of MU"
POINT_MASS = "M = 4 with DA, DB left"
OTHER_M = "M misjudged"
DOUBLE = "IEEE double arithmetic"
DOUBLE_PI = "IEEE double arithmetic with exact pi"
OTHER_PI = "IEEE double arithmetic with pi = 3.1416"
DOUBLE_ROUNDED = "IEEE double arithmetic, rounded, not floored"
DOUBLE_TRUNCATED = "IEEE double arithmetic, truncated, not floored"
SINGLE = "single-precision arithmetic"
SINGLE_ROUNDED = "single-precision arithmetic, rounded, not floored"
SINGLE_TRUNCATED = "single-precision arithmetic, truncated, not floored"
DECIMAL = "decimal (BCD) arithmetic"
ROUNDED = "rounded, not floored"
TRUNCATED = "truncated, not floored"
OTHER_DECIMALS = "printed with other decimals"

NATURAL, ODD = 1.35, 2.4
"""What it asks to believe that two numbers that belong together, or any two, were exchanged."""
UNIT, ARITHMETIC, PROGRAM = 1.45, 1.4, 1.3
NOT_APPLESOFT = "then this program on an Apple II did not print it"


class Hypothesis(NamedTuple):
    """A cause: its kind, what to add, how much it asks to be believed, the printed numbers it puts
    right, the scene it means, and its outcome where that is no replay's; ``spared``: names that
    are not held against it; ``assumed``: the texts it takes to have been printed for its scene;
    ``within``: by input, how far what was typed may be from what the scene has."""

    kind: str
    note: str
    weight: float
    changes: tuple[Change, ...]
    scene: dict[str, str]
    outcome: replays.Outcome | None = None
    spared: frozenset[str] = frozenset()
    assumed: dict[str, str] | None = None
    within: dict[str, float] | None = None
