"""Programs compiled to a Python function of one scene's values. Python's floats are the same
doubles, so the bits are those of the arrays; numpy is not needed."""

import math
from collections.abc import Callable
from typing import Any

from ...collision.fields import ANGLES
from ...collision.sinetable import sine_and_cosine
from ...names import SCENE
from ..native.schedule import Schedule

NAMES = tuple(SCENE)
LARGE_ANGLE = 720.0
"""Angles beyond this, in degrees, are taken modulo 360 (which is exact) before they are added up:
the sums are then rounded no more coarsely than the angles people give are."""
_FORMULAS = {
    "ADD": "{0} + {1}",
    "SUBTRACT": "{0} - {1}",
    "MULTIPLY": "{0} * {1}",
    "DIVIDE": "{0} / {1}",
    "NEGATIVE": "-{0}",
    "ABSOLUTE": "abs({0})",
    "SQRT": "sqrt({0})",
    "MINIMUM": "min({0}, {1})",
    "EQUAL": "{0} == {1}",
    "LESS": "{0} < {1}",
    "LESS_OR_EQUAL": "{0} <= {1}",
    "BOTH": "{0} and {1}",
    "EITHER": "{0} or {1}",
    "NOT": "not {0}",
    "AGAINST": "-{0} if {1} > 0.0 else {0}",
    "CHOOSE": "{1} if {0} else {2}",
    "PRODUCT_PLUS": "{0} * {1} + {2}",
    "PRODUCT_MINUS": "{0} * {1} - {2}",
    "MINUS_PRODUCT": "{2} - {0} * {1}",
    "PRODUCTS_PLUS": "{0} * {1} + {2} * {3}",
    "PRODUCTS_MINUS": "{0} * {1} - {2} * {3}",
    "SINE_AND_COSINE": "sine_and_cosine({0})",
    # adding 0.0 clears the sign of a zero, as in arrays
    "RESULT": "{0} + 0.0",
    "RESULT_OR_INFINITE": "{0} + 0.0",
    "BITS": "int({0})",
}


def compile_function(schedule: Schedule, unless: str = "") -> Callable[..., tuple[float, ...]]:
    """Return a function of a scene's values, in the table's order, that returns the results. It
    raises ArithmeticError for a division by zero, an overflow, or where ``unless``, a Python
    condition on the values, holds."""
    lines = [f"def results({', '.join(NAMES)}):"]
    if unless:
        lines.append(f"    if {unless}: raise ArithmeticError")
    for name in ANGLES:
        if name in schedule.columns:
            lines.append(f"    if not -{LARGE_ANGLE} <= {name} <= {LARGE_ANGLE}:")
            lines.append(f"        {name} = fmod({name}, 360.0)")
    value = dict(enumerate(schedule.columns))
    for place, scalar in enumerate(schedule.scalars, schedule.moving):
        value[place] = scalar if isinstance(scalar, str) else f"({scalar!r})"
    for name, places in schedule.steps:
        outputs = 2 if name == "SINE_AND_COSINE" else 1
        formula = _FORMULAS[name].format(*(value[place] for place in places[:-outputs]))
        value |= {place: f"v{place}" for place in places[-outputs:]}
        lines.append(f"    {', '.join(value[place] for place in places[-outputs:])} = {formula}")
    first = len(schedule.columns)
    lines.append(f"    return {''.join(f'v{first + i}, ' for i in range(len(schedule.results)))}")
    functions = {"fmod": math.fmod, "isfinite": math.isfinite, "inf": math.inf, "sqrt": math.sqrt}
    names: dict[str, Any] = {**functions, "sine_and_cosine": sine_and_cosine}
    exec(compile("\n".join(lines), "<the formulas of one scene>", "exec"), names)
    function: Callable[..., tuple[float, ...]] = names["results"]
    return function
