"""The conditions that every impact obeys: laws and limits of physics.

The contact points approach, the normal impulse pushes, no kinetic energy is gained, E lies from 0
to 1 and EM from -1 to 0 (+1 stands for no moment impulse), and friction does no more than end the
sliding: P_t/P_n lies between 0 and the critical friction MUC. `solve` reports the first five in
STATUS, with friction's bits as remarks. `margins` says how far impacts lie within each condition;
there friction has an allowance, because six of the chapter's own eleven staged collisions have more
friction than what ends their sliding.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .formulas import E_MAX, E_MIN, EM_MAX, EM_MIN
from .solve import POINT, evaluate

Floats = NDArray[np.float64]

FRICTION_ALLOWANCE = 0.2  # on either side of friction's range, as a fraction of the range
FRICTION_OFFSET = 0.1  # and this much more; Table 2 needs both
MAX_FRICTION = 10.0  # where nothing ends the sliding; MU = -10 is the listing's pivot


BROKEN = {
    "approach": "the vehicles would not approach",
    "push": "the vehicles would pull",
    "energy": "energy would be gained",
    "E": f"E would leave {E_MIN:g} ... {E_MAX:g}",
    "EM": f"EM would leave {EM_MIN:g} ... {EM_MAX:g}",
    "friction": "friction would reverse the sliding",
}
"""Condition -> what would be the case where it is violated: an interval may end there."""


class Scale(NamedTuple):
    """Typical sizes of a problem's speeds, masses and radii of gyration, which make margins pure
    numbers."""

    speed: float = 1.0
    mass: float = 1.0
    length: float = 1.0


UNIT_SCALE = Scale()


@np.errstate(all="ignore")
def margins(
    known: Mapping[str, ArrayLike], scale: Scale = UNIT_SCALE
) -> dict[str, tuple[Any, ...]]:
    """Return how far impacts lie within each condition.

    Parameters
    ----------
    known : mapping of str to float or array_like
        What is known of the impacts, as in `evaluate`; `inverse.complete` gives all of it.
    scale : Scale, optional
        Typical sizes.

    Returns
    -------
    dict of str to tuple of ndarray
        Name in `BROKEN` -> one margin, or those of the lower and the upper end: 0 at the end,
        negative where the condition is violated, in units of ``scale``. They are differences
        without a quotient, so that they are smooth where an impulse or an approach vanishes. A
        condition that cannot be decided for lack of a value is absent; so is EM for point masses.
    """
    speed, mass, length = scale
    names = ("gn", "PN", "PT", "EL", "VS", "waf", "wbf", "PM", "ia", "ib", "MUC")
    v = evaluate(known, names)[0]
    rows: dict[str, tuple[Any, ...]] = {}
    if "EL" in v:
        rows["energy"] = (v["EL"] / (mass * speed * speed),)
    if "PN" in v:
        rows["push"] = (v["PN"] / (mass * speed),)
    if "gn" in v:
        closing = -v["gn"] / speed
        rows["approach"] = (closing,)
        if "VS" in v:
            separation = v["VS"] / speed
            sign = np.where(closing < 0.0, -1.0, 1.0)
            rows["E"] = (
                sign * (separation - E_MIN * closing),
                sign * (E_MAX * closing - separation),
            )
    is_point = (np.asarray(known.get("M", 6.0)) == POINT).all()
    if {"waf", "PM", "ia"} <= v.keys() and not is_point:
        spin = (v["waf"] - v["wbf"]) * (length / speed)
        total = spin + v["PM"] * (v["ia"] + v["ib"]) * (length / speed)
        sign = np.where(total < 0.0, -1.0, 1.0)
        rows["EM"] = (sign * (spin - EM_MIN * total), sign * (EM_MAX * total - spin))
    if {"PN", "PT", "MUC"} <= v.keys():
        low, high = friction_range(v["MUC"])
        pn, pt = v["PN"] / (mass * speed), v["PT"] / (mass * speed)
        rows["friction"] = (pt - low * pn, high * pn - pt)
    return rows


def friction_range(critical: ArrayLike) -> tuple[Floats, Floats]:
    """Return the least and the largest P_t/P_n, with the allowance.

    Parameters
    ----------
    critical : array_like
        MUC, the P_t/P_n that just ends the sliding; NaN where nothing does.

    Examples
    --------
    >>> low, high = friction_range(0.5)
    >>> print(low.round(3), high.round(3))
    -0.2 0.7
    """
    ends = np.nan_to_num(np.asarray(critical, np.float64), nan=MAX_FRICTION)
    ends = np.clip(ends, -MAX_FRICTION, MAX_FRICTION)
    low, high = np.minimum(ends, 0.0), np.maximum(ends, 0.0)
    allowance = FRICTION_ALLOWANCE * (high - low) + FRICTION_OFFSET
    return (
        np.maximum(low - allowance, -MAX_FRICTION),
        np.minimum(high + allowance, MAX_FRICTION),
    )
