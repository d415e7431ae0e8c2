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

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError
from ..names import missing

Array = NDArray[np.float64]

AS_USED = 2 / 3
"""The factor with which the chapter computed Table 2 and Section VII; the default."""
AS_PRINTED = 1.0
"""The factor of Equation 19 as printed: none."""


GIVEN = ("MA", "MB", "SA", "SB", "LOSS")
"""What Equation 19 asks for."""


def delta_v(known: Mapping[str, Any], factor: float = AS_USED) -> dict[str, Array]:
    """DVA and DVB by Equation 19, by default with the factor 2/3 that Table 2 has.

    ``known``: masses MA MB, sizes of the initial velocities SA SB, and LOSS, the kinetic energy
    lost in percent of the initial (the chapter's 100 ΔT); numbers or arrays, which broadcast. A
    negative loss gives NaN. Raises UserError for a name that is missing.
    """
    absent = [name for name in GIVEN if name not in known]
    if absent:
        raise UserError(missing(absent))
    a, b, speed_a, speed_b, loss = (np.asarray(known[name], np.float64) for name in GIVEN)
    momentum = np.hypot(a * speed_a, b * speed_b)
    with np.errstate(invalid="ignore"):
        change = factor * np.sqrt(loss / 100) * momentum
    return {"DVA": change / a, "DVB": change / b}


def described(factor: float) -> str:
    """One line for printouts: which Equation 19 this is."""
    if factor == AS_PRINTED:
        return "Equation 19 as printed, without the factor 2/3 that Table 2 was computed with"
    if factor == AS_USED:
        return "Equation 19 with the factor 2/3 (not printed, but all of Table 2 has it)"
    return f"Equation 19 with the factor {factor:.6g}"
