"""ΔV without solving the impact: Equation 19 (chapter, Section VI), an empirical estimate.

As printed,  ΔV_i = (ΔT)^(1/2) [(m_a v_a)² + (m_b v_b)²]^(1/2) / m_i,  with ΔT the *fraction* of
kinetic energy lost and v the initial speeds. That is not what the chapter computed: all 22
predicted values of Table 2 and both of Section VII carry a further factor 2/3. The default here
is the equation *with the factor 2/3*, which reproduces Table 2; ``factor=AS_PRINTED`` gives the
printed equation, half as much again.

The chapter's own caution: fitted to eleven staged collisions up to about 40 mph and compared with
no other data; expect an error of a few ft/s.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

AS_USED = 2 / 3
"""The factor with which the chapter computed Table 2 and Section VII; the default."""
AS_PRINTED = 1.0
"""The factor of Equation 19 as printed: none."""


def delta_v(
    mass_a: Any, mass_b: Any, speed_a: Any, speed_b: Any, loss: Any, factor: float = AS_USED
) -> dict[str, Array]:
    """DVA and DVB by Equation 19, by default with the factor 2/3 that Table 2 has.

    ``speed_a``, ``speed_b``: sizes of the initial velocities; ``loss``: kinetic energy lost in
    percent of the initial (LOSS; the chapter's 100 ΔT). All broadcast. A negative loss gives NaN.
    """
    a, b = np.asarray(mass_a, np.float64), np.asarray(mass_b, np.float64)
    momentum = np.hypot(a * np.asarray(speed_a), b * np.asarray(speed_b))
    with np.errstate(invalid="ignore"):
        change = factor * np.sqrt(np.asarray(loss, np.float64) / 100) * momentum
    return {"DVA": change / a, "DVB": change / b}


def described(factor: float) -> str:
    """One line for printouts: which Equation 19 this is."""
    if factor == AS_PRINTED:
        return "Equation 19 as printed, without the factor 2/3 that Table 2 was computed with"
    if factor == AS_USED:
        return "Equation 19 with the factor 2/3 (not printed, but all of Table 2 has it)"
    return f"Equation 19 with the factor {factor:.6g}"
