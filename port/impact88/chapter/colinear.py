"""Direct colinear impact: Equations 1 to 12 (chapter, Section III), forward and inverse.

Two vehicles that do not turn, with velocities along n (crush) and t (sliding). The inverse is the
same four lines with 1/e in place of e, and initial and final velocities exchanged. There is none at
e = 0. μ is the *signed* P_t/P_n: no rule of sign is applied here.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import UserError
from ..mechanics.solve import evaluate
from .columns import Array, read_columns

INITIAL = ("UN", "UT", "VN", "VT")
FINAL = ("VAN", "VAT", "VBN", "VBT")
RESULTS = ("PN", "PT", "DVA", "DVB", "KI", "KF", "LOSS", "MUC", "STATUS")
TURN = 180.0  # of the contact plane: A is on the side that it approaches from


def colinear(known: Mapping[str, Any]) -> dict[str, Array]:
    """Return the final velocities of a colinear impact.

    Parameters
    ----------
    known : mapping of str to float or array_like
        Masses MA and MB, coefficients E and MUP (signed P_t/P_n), and the velocities before along n
        and t: UN and UT of A, VN and VT of B. They broadcast; units are any consistent set.

    Returns
    -------
    dict of str to ndarray
        The velocities before and after (VAN, VAT, VBN, VBT), impulses PN and PT, velocity changes
        DVA and DVB, energies KI and KF, LOSS in percent, MUP, MUC (the P_t/P_n that just ends the
        sliding), and STATUS.

    Raises
    ------
    UserError
        For a name that is missing, and values that are not numbers.

    Notes
    -----
    Equations 9 to 12.

    Examples
    --------
    >>> known = {"MA": 154.7, "MB": 99.1, "E": 0.071, "MUP": 0, "UN": -56.76}
    >>> found = impact88.colinear({**known, "UT": 0, "VN": 0, "VT": 0})
    >>> round(float(found["VAN"]), 3)
    -33.024
    """
    ma, mb, e, mu, *initial = read_columns(known, ("MA", "MB", "E", "MUP", *INITIAL))
    with np.errstate(all="ignore"):
        final = _equations_9_to_12(ma, mb, e, mu, initial)
        return _results(ma, mb, e, mu, initial, final)


def colinear_inverse(known: Mapping[str, Any]) -> dict[str, Array]:
    """Return the initial velocities of a colinear impact from its final ones.

    Parameters
    ----------
    known : mapping of str to float or array_like
        As for `colinear`, with the final velocities VAN, VAT, VBN, VBT in place of the initial.

    Returns
    -------
    dict of str to ndarray
        As for `colinear`. Elements with E = 0 are NaN.

    Raises
    ------
    UserError
        For a name that is missing, and where E is 0 throughout: there is no inverse.

    Notes
    -----
    Equations 9 to 12 with 1/e in place of e: errors of the final normal velocities grow as 1/e.

    Examples
    --------
    >>> known = {"MA": 154.7, "MB": 99.1, "E": 0.071, "MUP": 0, "VAN": -33, "VBN": -37}
    >>> round(float(impact88.colinear_inverse({**known, "VAT": 0, "VBT": 0})["UN"]), 3)
    -56.56
    """
    ma, mb, e, mu, *final = read_columns(known, ("MA", "MB", "E", "MUP", *FINAL))
    if not e.any():
        raise UserError(
            "E = 0: the vehicles move on together however fast they approached (Equation 7), so "
            "the final velocities do not determine the initial ones; expected E above 0"
        )
    with np.errstate(all="ignore"):
        initial = _equations_9_to_12(ma, mb, 1.0 / np.where(e == 0, np.nan, e), mu, final)
        return _results(ma, mb, e, mu, initial, final)


def _equations_9_to_12(ma: Array, mb: Array, e: Array, mu: Array, v: Sequence[Any]) -> list[Any]:
    """Return velocities after from velocities before: A along n and t, B along n and t."""
    van, vat, vbn, vbt = v
    rebound = (1.0 + e) * (vbn - van) / (ma + mb)
    return [
        van + mb * rebound,
        vat + mu * mb * rebound,
        vbn - ma * rebound,
        vbt - mu * ma * rebound,
    ]


def _results(
    ma: Array, mb: Array, e: Array, mu: Array, initial: Sequence[Any], final: Sequence[Any]
) -> dict[str, Array]:
    """Return all results of point masses with these velocities, n along x and t along y."""
    side = np.where(initial[0] > initial[2], -1.0, 1.0)
    impact: dict[str, Any] = {"M": 4.0, "MA": ma, "MB": mb, "E": e, "EM": 0.0, "MUP": mu}
    impact |= {"GA": np.where(side < 0, TURN, 0.0), "WA": 0.0, "WB": 0.0, "WAF": 0.0, "WBF": 0.0}
    impact |= dict(zip(("UX", "UY", "VX", "VY"), initial, strict=True))
    impact |= dict(zip(("VAX", "VAY", "VBX", "VBY"), final, strict=True))
    results, _ = evaluate(impact, RESULTS)
    for name in ("PN", "PT"):
        results[name] = side * results[name]
    results["STATUS"] = np.nan_to_num(results["STATUS"]).astype(np.uint16)
    velocities = zip((*INITIAL, *FINAL), (*initial, *final), strict=True)
    shape = results["LOSS"].shape
    return {
        name: np.broadcast_to(x, shape) for name, x in (*velocities, *results.items(), ("MUP", mu))
    }
