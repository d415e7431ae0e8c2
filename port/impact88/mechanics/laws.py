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
from .solve import evaluate

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
        The impacts, of which everything is known (`inverse.complete`).
    scale : Scale, optional
        Typical sizes.

    Returns
    -------
    dict of str to tuple of ndarray
        Name in `BROKEN` -> one margin, or those of the lower and the upper end: 0 at the end,
        negative where the condition is violated, in units of ``scale``. They are differences
        without a quotient, so that they are smooth where an impulse or an approach vanishes.
    """
    speed, mass, length = scale
    impulse, spin = mass * speed, speed / length
    values, _ = evaluate(known, "VC PN PT EL VS waf wbf PM ia ib MUC")
    vc, pn, pt, lost, vs, waf, wbf, moment, ia, ib, critical = values.values()
    pn, pt = pn / impulse, pt / impulse
    closing, separation = vc / speed, vs / speed
    turning = (waf - wbf) / spin
    low, high = friction_range(critical)
    return {
        "approach": (closing,),
        "push": (pn,),
        "energy": (lost / (impulse * speed),),
        "E": _between(E_MIN, separation, E_MAX, closing),
        "EM": _between(EM_MIN, turning, EM_MAX, turning + moment * (ia + ib) / spin),
        "friction": (pt - low * pn, high * pn - pt),
    }


def _between(low: float, part: Any, high: float, total: Any) -> tuple[Any, Any]:
    """Return how far a part lies between two fractions of a total."""
    sign = np.where(total < 0.0, -1.0, 1.0)
    return sign * (part - low * total), sign * (high * total - part)


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
    ends = np.clip(np.nan_to_num(critical, nan=MAX_FRICTION), -MAX_FRICTION, MAX_FRICTION)
    low, high = np.minimum(ends, 0.0), np.maximum(ends, 0.0)
    allowance = FRICTION_ALLOWANCE * (high - low) + FRICTION_OFFSET
    low, high = np.clip((low - allowance, high + allowance), -MAX_FRICTION, MAX_FRICTION)
    return low, high
