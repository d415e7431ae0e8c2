"""A vehicle against a rigid barrier (chapter, Section IV-C).

"Let all velocity components of one vehicle approach zero and its mass and moment of inertia become
infinitely large": vehicle B is the barrier. Equations 13, 14 and 17 then no longer hold (the ground
takes the momentum); 15, 16 and 18 give the vehicle's three final velocities. In inverse masses that
is `impact88.solve` with two zeros.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..mechanics.solve import solve
from ..names import check_names, split_names
from .columns import check_columns

BARRIER = {
    "MB": np.inf,
    "IB": np.inf,
    "VX": 0.0,
    "VY": 0.0,
    "WB": 0.0,
    "DB": 0.0,
    "PB": 0.0,
    "TB": 0.0,
}
"""The values of a scene that make B a barrier; the place of the contact on it does not matter."""
VEHICLE = ("E", "MU", "EM", "DA", "GA", "PA", "TA", "MA", "IA", "UX", "UY", "WA", "M")
"""The values of a scene that are the vehicle's and the contact's."""
RESULTS = (
    "VAX",
    "VAY",
    "WAF",
    "XA",
    "YA",
    "XAF",
    "YAF",
    "KI",
    "KF",
    "LOSS",
    "DVA",
    "PN",
    "PT",
    "PM",
    "MUP",
    "MUC",
    "STATUS",
)
"""The results of an impact on a barrier: B's velocities stay 0."""


def barrier(
    columns: Mapping[str, Any], results: Sequence[str] | str | None = None
) -> dict[str, Any]:
    """Return the impact of vehicle A on a rigid barrier.

    The barrier's surface makes the angle GA with the y axis. An approach has the vehicle on the +n
    side of the barrier, moving towards -n.

    Parameters
    ----------
    columns : mapping of str to float or array_like
        The values of `VEHICLE` by the listing's names: mass, inertia, contact point, velocities
        before, GA, E, MU, EM. They broadcast. Angles in degrees, spins in rad per unit of time, all
        other units any consistent set. M is 6 by default, 4 for a point mass.
    results : sequence of str, or str, optional
        Results wanted, some of `RESULTS`; all by default.

    Returns
    -------
    dict of str to ndarray
        The results by name.

    Raises
    ------
    UserError
        For unknown or missing names.

    Notes
    -----
    Equations 15, 16 and 18 with MB and IB infinite and B at rest.

    Examples
    --------
    >>> car = {"DA": 7.59, "GA": -30, "PA": -19.8, "TA": 0, "MA": 143.5, "IA": 3728}
    >>> car |= {"E": 0.1, "MU": 0.4, "EM": -1, "UX": -29, "UY": 0, "WA": 0}
    >>> results = impact88.barrier(car)
    >>> round(float(results["DVA"]), 2)
    30.62
    """
    check_columns(columns, VEHICLE, "a barrier impact")
    names = RESULTS if results is None else tuple(split_names(results))
    check_names(names, RESULTS, "barrier result")
    return solve({**BARRIER, **columns}, names)
