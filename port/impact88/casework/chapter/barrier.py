"""A vehicle against a rigid barrier (chapter, Section IV-C).

"Let all velocity components of one vehicle approach zero and its mass and moment of inertia become
infinitely large": vehicle B is the barrier, at rest, with infinite MB and IB. Equations 13, 14 and
17 then no longer hold (the ground takes the momentum); 15, 16 and 18 give the vehicle's three
final velocities, once B's impulse in them is A's reversed: as printed, Equation 16 has MB times B's
change of velocity, infinity times 0, and 18 the quotient MB/IB. In inverse masses that is
`impact88.solve` with two zeros.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...collision.mappings import in_base
from ...errors import UserError
from ...mechanics.closedform.solve import solve
from ...messages.arguments import explains_arguments

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
"""The values of the scene that make B a barrier; where on it the vehicle hits is of no matter."""
BARRIER_AFTER = {"VBX": 0.0, "VBY": 0.0, "WBF": 0.0}
"""Its velocities after the impact, for `impact88.solve_for`: rebound -> approach."""
VEHICLE = ("E", "MU", "EM", "DA", "GA", "PA", "TA", "MA", "IA", "UX", "UY", "WA")
"""The values of the scene that are the vehicle's and the contact's."""
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
"""The results a barrier leaves: B's stay as they were."""


@np.errstate(all="ignore")  # what is not finite is said in words
@explains_arguments
def barrier(columns: Mapping[str, Any], outputs: Sequence[str] | None = None) -> dict[str, Any]:
    """Return the impact of vehicle A on a rigid barrier.

    The barrier's surface makes the angle GA with the y axis. An approach has the vehicle on the +n
    side of the barrier moving towards -n.

    Parameters
    ----------
    columns : mapping of str to float or array_like
        The values of `VEHICLE` by the listing's names: mass, inertia, contact point, velocities
        before, GA, E, MU, EM. They broadcast. Angles in degrees, spins in rad per unit of time, all
        other units any consistent set. M is 6 where left out, 4 for a point mass.
    outputs : sequence of str, optional
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
    Equations 13 to 18 with MB and IB infinite and B at rest.

    Examples
    --------
    >>> car = {"DA": 7.59, "GA": -30, "PA": -19.8, "TA": 0, "MA": 143.5, "IA": 3728}
    >>> car |= {"E": 0.1, "MU": 0.4, "EM": -1, "UX": -29, "UY": 0, "WA": 0}
    >>> found = impact88.barrier(car)
    >>> round(float(found["DVA"]), 2)
    30.62
    """
    columns = in_base(columns)
    for name in columns:
        if name not in (*VEHICLE, "M"):
            raise UserError(
                f"{name!r} does not belong to a barrier impact; expected {' '.join(VEHICLE)}"
            )
    for name in outputs or ():
        if name not in RESULTS:
            raise UserError(
                f"{name!r} is not a barrier result; expected some of {' '.join(RESULTS)}"
            )
    return solve({**BARRIER, **columns}, RESULTS if outputs is None else tuple(outputs))
