"""STATUS over arrays: the operation that plans use to set `impact88.status.Status` bits."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..status import Status
from .passes import register

Array = NDArray[Any]

SINGULAR_FROM = 2.0**26
"""COND from which SINGULAR is set: 1/sqrt(unit roundoff). Half of a double's digits may be lost
there, and of the 32 bits of the 1988 program's numbers a handful at most are left."""
ENERGY_TOLERANCE = 1e-12
"""What may be gained, of the initial kinetic energy, before ENERGY_GAINED is set."""
LISTING_MISREADS = -10.0
"""Line 510 takes any MU not above this for a pivot."""


def _status(
    gn: Array,
    pn: Array,
    size_of_mu: Array,
    critical: Array,
    twice_lost: Array,
    initial: Array,
    e: Array,
    em: Array,
    friction_mu: Array,
    condition: Array,
    sum_of_velocities: Array,
    out: Array,
) -> None:
    """Sets every bit by its own rule; one that cannot be decided (NaN) stays clear."""

    def set_where(bit: Status, *conditions: Array) -> None:
        for condition in conditions:
            np.bitwise_or(out, condition.view(np.uint8) * np.uint8(bit), out=out)

    out.fill(0)
    set_where(Status.SEPARATING, gn >= 0)
    set_where(Status.PULLING, pn < 0)
    set_where(Status.SLIDING_REVERSED, size_of_mu > np.abs(critical))
    set_where(Status.ENERGY_GAINED, -twice_lost > (2 * ENERGY_TOLERANCE) * initial)
    set_where(Status.COEFFICIENT_OUT_OF_RANGE, e < 0, e > 1, em < -1, em > 0)
    set_where(Status.COEFFICIENT_OUT_OF_RANGE, friction_mu <= LISTING_MISREADS)
    # NaN: 0/0 in the condition itself, as singular as can be
    set_where(Status.SINGULAR, ~(condition < SINGULAR_FROM))
    set_where(Status.NOT_FINITE, ~np.isfinite(sum_of_velocities))


register("status", _status)
