"""ΔV without solving the impact: Equation 19 (chapter, Section VI), an empirical estimate.

As printed, ΔV_i = (ΔT)^(1/2) [(m_a v_a)² + (m_b v_b)²]^(1/2) / m_i, with ΔT the *fraction* of
kinetic energy lost and v the initial speeds. All 22 predicted values of Table 2 and both of Section
VII have a further factor 2/3, which is the default here.

The chapter's own caution: fitted to eleven staged collisions up to about 40 mph, and compared with
no other data. Against the 22 measured velocity changes of Table 2 its error is 3.8 ft/s (rms), at
most 8.2.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..errors import UserError
from .columns import Array, read_columns

AS_USED = 2 / 3  # factor of Equation 19 in Table 2 and Section VII
AS_PRINTED = 1.0
GIVEN = ("MA", "MB", "SA", "SB", "LOSS")


def delta_v(known: Mapping[str, Any], factor: float = AS_USED) -> dict[str, Array]:
    """Return the velocity changes DVA and DVB that follow from a loss of energy.

    Parameters
    ----------
    known : mapping of str to float or array_like
        Masses MA and MB, speeds before SA and SB, and LOSS, the kinetic energy lost in percent of
        the initial (the chapter's 100 ΔT). They broadcast; units are any consistent set.
    factor : float, default 2/3
        The factor of Equation 19; Table 2 was made with the default.

    Returns
    -------
    dict of str to ndarray
        DVA and DVB. A negative loss gives NaN.

    Raises
    ------
    UserError
        For a name that is missing.

    Notes
    -----
    Equation 19.

    Examples
    --------
    >>> found = impact88.delta_v({"MA": 96, "MB": 145, "SA": 36.667, "SB": 58.667, "LOSS": 37.4})
    >>> {name: round(float(value), 2) for name, value in found.items()}
    {'DVA': 39.1, 'DVB': 25.89}
    """
    a, b, speed_a, speed_b, loss = read_columns(known, GIVEN)
    with np.errstate(all="ignore"):
        change = factor * np.sqrt(loss / 100.0) * np.hypot(a * speed_a, b * speed_b)
        return {"DVA": change / a, "DVB": change / b}


def loss_of_energy(known: Mapping[str, float]) -> float:
    """Return the LOSS in percent for an energy loss EL of MA and MB at speeds SA and SB, without
    spins."""
    a, b, speed_a, speed_b, lost = (float(x) for x in read_columns(known, (*GIVEN[:4], "EL")))
    initial = (a * speed_a**2 + b * speed_b**2) / 2
    return 100.0 * lost / initial if initial else math.inf


def initial_velocity(change: float, along: float, across: float) -> float:
    """Return the initial velocity of a vehicle that did not swerve (Equations 20 and 21 solved).

    Parameters
    ----------
    change : float
        Size of its velocity change.
    along, across : float
        Its final velocity along and across its direction of approach.

    Returns
    -------
    float
        The faster of the two roots.

    Raises
    ------
    UserError
        If the final velocity across is larger than the velocity change.
    """
    square = (change - across) * (change + across)
    if square < 0:
        raise UserError(
            f"a velocity change of {change:.4g} is less than the final velocity {abs(across):.4g} "
            "across the direction of approach; expected more"
        )
    root = math.sqrt(square)
    return max((along - root, along + root), key=abs)
