"""Force from impulse (chapter, Section III), and the direction a vehicle feels it from.

An impulse P over the contact time t_f is an average force F_A = P/t_f; the largest force F_M is
"typically two to three times the average".

Principal direction of force (PDOF), as the field states it: the direction *from* which the force
comes, seen from the vehicle, clockwise from its front: 0 a frontal, 90 a blow from the right, 180
from behind. B's contact point lies at the angle θ_b + φ_b from its center of gravity, so B faces
θ_b; A's lies at θ_a + φ_a + 180°, so A faces θ_a + 180°.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UserError

Array = NDArray[np.float64]


def forces(impulse: Any, contact_time: Any) -> dict[str, Array]:
    """Average force FA and the range FM2 ... FM3 of the peak force of an impulse over a contact
    time. Raises UserError unless every contact time is positive."""
    time = np.asarray(contact_time, np.float64)
    if not (time > 0).all() or not np.isfinite(time).all():
        raise UserError(f"contact time {contact_time} is not positive; expected a duration")
    average = np.abs(np.asarray(impulse, np.float64)) / time
    return {"FA": average, "FM2": 2.0 * average, "FM3": 3.0 * average}


def facing(vehicle: str, theta: Any) -> Array:
    """The direction (degrees from the x axis) a vehicle's front points to; see above."""
    return np.asarray(theta) + (180.0 if vehicle == "A" else 0.0)


def clock(pdof: float) -> str:
    """A PDOF as the nearest hour of the clock: 12 o'clock is the front, 3 o'clock the right."""
    return f"{round(pdof / 30) % 12 or 12} o'clock"
