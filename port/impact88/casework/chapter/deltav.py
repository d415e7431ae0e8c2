"""ΔV without solving the impact: Equation 19 (chapter, Section VI), an empirical estimate.

As printed,  ΔV_i = (ΔT)^(1/2) [(m_a v_a)² + (m_b v_b)²]^(1/2) / m_i,  with ΔT the *fraction* of
kinetic energy lost and v the initial speeds. All 22 predicted values of Table 2 and both of Section
VII carry a further factor 2/3. The default here is the equation
*with the factor 2/3*, which reproduces Table 2; ``factor=AS_PRINTED`` gives the printed equation.

The chapter's own caution: fitted to eleven staged collisions up to about 40 mph and compared with
no other data; expect an error of a few ft/s.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ...collision.mappings import columns
from ...errors import UserError
from ...messages.arguments import explains_arguments
from ...names import missing

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

# factors of Equation 19
AS_USED = 2 / 3  # in Table 2 and Section VII
AS_PRINTED = 1.0

GIVEN = ("MA", "MB", "SA", "SB", "LOSS")
"""Names of the values that Equation 19 needs."""


@explains_arguments
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
    dict of str to float or ndarray
        DVA and DVB: floats where every value given is a float above 0, else arrays. A negative loss
        gives NaN.

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
    if type(known) is not dict or not set(map(type, known.values())) <= {float}:
        known = columns(known)  # which takes numpy
    absent = [name for name in GIVEN if name not in known]
    if absent:
        raise UserError(missing(absent))
    values = [known[name] for name in GIVEN]
    if all(type(x) is float and x > 0 for x in values):
        return _changes(factor, math, *values)
    import numpy as np

    with np.errstate(all="ignore"):  # callers report what is not finite
        return _changes(factor, np, *(np.asarray(x, np.float64) for x in values))


def _changes(factor: float, module: Any, *values: Any) -> dict[str, Any]:
    """Return DVA and DVB by Equation 19 from the values `GIVEN`; ``module``: math or numpy."""
    a, b, speed_a, speed_b, loss = values
    change = factor * module.sqrt(loss / 100) * module.hypot(a * speed_a, b * speed_b)
    return {"DVA": change / a, "DVB": change / b}


ERROR = "rms 3.8, largest 8.2 ft/s over the 22 velocity changes of Table 2"
"""Error of Equation 19 against the measured velocity changes; a test checks the numbers."""


def loss_of(known: Mapping[str, float], factor: float = AS_USED) -> float:
    """Return the LOSS, in percent, that a velocity change implies (Equation 19 inverted).

    ``known``: MA MB SA SB and DVA or DVB. Raises UserError for a name that is missing.
    """
    absent = [name for name in GIVEN[:4] if name not in known]
    vehicle = next((v for v in "AB" if f"DV{v}" in known), None)
    if absent or vehicle is None:
        raise UserError(missing(absent or ["DVA"]))
    unit = delta_v({**known, "LOSS": 100.0}, factor)[f"DV{vehicle}"]
    share = float(known[f"DV{vehicle}"] / unit) if unit else math.nan
    return 100 * share * share


def loss_of_energy(known: Mapping[str, float]) -> float:
    """Return LOSS in percent for an energy loss EL, through crush or otherwise: relative to the
    kinetic energy of MA and MB at speeds SA and SB, without spins."""
    a, b = known["SA"], known["SB"]
    initial = (known["MA"] * a * a + known["MB"] * b * b) / 2
    return 100 * known["EL"] / initial if initial else math.inf


def initial_velocity(change: float, along: float, across: float) -> float:
    """Return the initial velocity of a vehicle that did not swerve, from the size of its velocity
    change and its final velocity along and across its direction of approach.

    Equations 20 and 21 have two roots; this is the faster. Raises UserError where the final
    velocity across is larger than the velocity change.
    """
    square = (change - across) * (change + across)
    if square < 0:
        raise UserError(
            f"a velocity change of {change:.4g} is less than the final velocity {abs(across):.4g} "
            "across its direction of approach"
        )
    root = math.sqrt(square)
    return max((along - root, along + root), key=abs)


_MAX_ITERATIONS = 500
_SPEED_RTOL = 1e-12


def speeds_before(
    known: Mapping[str, float], loss: float, factor: float = AS_USED, repeat: bool = False
) -> dict[str, float]:
    """Return UX and VY of vehicles that approached along x and along y, with the DVA and DVB used,
    from their final velocities and the loss in percent (Section VII; Equations 19 to 21).

    ``known``: MA MB VAX VAY VBX VBY, and SA SB if known; by default Equations 13 and 14 give them.
    ``repeat``: iterate with the new speeds to convergence, which can lead far away. Raises
    UserError where there is no solution.
    """
    ratio = known["MB"] / known["MA"]
    speed_a = known.get("SA", abs(known["VAX"] + ratio * known["VBX"]))
    speed_b = known.get("SB", abs(known["VBY"] + known["VAY"] / ratio))
    masses = {"MA": known["MA"], "MB": known["MB"], "LOSS": loss}
    for _ in range(_MAX_ITERATIONS if repeat else 1):
        change = delta_v({**masses, "SA": speed_a, "SB": speed_b}, factor)
        a, b = float(change["DVA"]), float(change["DVB"])
        ux = initial_velocity(a, known["VAX"], known["VAY"])
        vy = initial_velocity(b, known["VBY"], known["VBX"])
        step = max(abs(abs(ux) - speed_a), abs(abs(vy) - speed_b))
        speed_a, speed_b = abs(ux), abs(vy)
        if not repeat or step <= _SPEED_RTOL * max(speed_a, speed_b):
            return {"UX": ux, "VY": vy, "DVA": a, "DVB": b}
    raise UserError(f"no speeds agree with a loss of {loss:g} percent and these final velocities")


def describe(factor: float) -> str:
    """Return one line for printouts that says which Equation 19 this is."""
    if factor == AS_PRINTED:
        return "Equation 19 as printed, without the factor 2/3 that Table 2 was computed with"
    if factor == AS_USED:
        return "Equation 19 with the factor 2/3 (not printed, but Table 2 was computed with it)"
    return f"Equation 19 with the factor {factor:.6g}"
