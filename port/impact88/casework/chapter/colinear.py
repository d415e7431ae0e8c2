"""Direct colinear impact: Equations 1-12 (chapter, Section III), forward and inverse.

Two vehicles that do not turn, velocities along n (crush) and t (sliding). Equations 5-8 (momentum
along n and t, restitution e, friction μ = P_t/P_n) solved for the final velocities are Equations
9-12; the inverse is the same four lines with 1/e for e and initial and final exchanged, μ
unchanged. There is no inverse at e = 0. μ is the *signed* P_t/P_n: no sign rule is applied here.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.mappings import columns
from ...errors import UserError
from ...mechanics.closedform.statusbits import Evidence, bits, findings, forward_friction
from ...messages.arguments import explains_arguments
from ...names import missing

Array = NDArray[np.float64]

INITIAL = ("UN", "UT", "VN", "VT")
FINAL = ("VAN", "VAT", "VBN", "VBT")


@np.errstate(all="ignore")  # what is not finite is said in words
@explains_arguments
def colinear(known: Mapping[str, Any]) -> dict[str, Array]:
    """Return the final velocities of a colinear impact.

    Parameters
    ----------
    known : mapping of str to float or array_like
        Masses MA and MB, coefficients E and MUP (signed P_t/P_n), and the velocities before along n
        and t: UN, UT of A and VN, VT of B. They broadcast; units are any consistent set.

    Returns
    -------
    dict of str to ndarray
        VAN, VAT, VBN, VBT, the velocities after, and what `report` adds: impulses, velocity
        changes, energies.

    Raises
    ------
    UserError
        For a name that is missing.

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
    ma, mb, e, mu, *initial = _floats(known, INITIAL)
    final = _equations_9_to_12(ma, mb, e, mu, *initial)
    return report(ma, mb, e, mu, initial, final)


@np.errstate(all="ignore")  # what is not finite is said in words
@explains_arguments
def colinear_inverse(known: Mapping[str, Any]) -> dict[str, Array]:
    """Return the initial velocities of a colinear impact from its final ones.

    Parameters
    ----------
    known : mapping of str to float or array_like
        As for `colinear`, with the final velocities VAN, VAT, VBN, VBT in place of the initial
        ones.

    Returns
    -------
    dict of str to ndarray
        UN, UT, VN, VT, the velocities before, and what `report` adds. Elements with E = 0 are NaN.

    Raises
    ------
    UserError
        For a name that is missing, and where E is 0 throughout: there is no inverse then.

    Notes
    -----
    Equations 9 to 12 with 1/e in place of e: errors of the final normal velocities grow as 1/e.

    Examples
    --------
    >>> known = {"MA": 154.7, "MB": 99.1, "E": 0.071, "MUP": 0, "VAN": -33, "VBN": -37}
    >>> round(float(impact88.colinear_inverse({**known, "VAT": 0, "VBT": 0})["UN"]), 3)
    -56.56
    """
    ma, mb, e, mu, *final = _floats(known, FINAL)
    if not e.any():
        raise UserError(
            "E = 0: the vehicles move on together however fast they approached (Equation 7), and "
            "the final velocities do not determine the initial ones; expected E above 0"
        )
    initial = _equations_9_to_12(ma, mb, 1 / np.where(e == 0, np.nan, e), mu, *final)
    return report(ma, mb, e, mu, initial, final)


def _equations_9_to_12(
    ma: Array, mb: Array, e: Array, mu: Array, van: Array, vat: Array, vbn: Array, vbt: Array
) -> list[Array]:
    # eight arguments: the symbols of Equations 9 to 12
    share = (1 + e) * (vbn - van) / (ma + mb)
    return [van + mb * share, vat + mu * mb * share, vbn - ma * share, vbt - mu * ma * share]


def report(
    ma: Array, mb: Array, e: Array, mu: Array, initial: list[Array], final: list[Array]
) -> dict[str, Array]:
    """Return the velocities by name, and PN PT (Equations 1 and 2), DVA DVB, KI KF, LOSS in
    percent, MUP, MUC (the P_t/P_n that just ends the sliding), and STATUS."""
    van, vat, vbn, vbt = initial
    Van, Vat, Vbn, Vbt = final
    ki = 0.5 * (ma * (van**2 + vat**2) + mb * (vbn**2 + vbt**2))
    kf = 0.5 * (ma * (Van**2 + Vat**2) + mb * (Vbn**2 + Vbt**2))
    pn, critical = ma * (Van - van), (vat - vbt) / ((1 + e) * (van - vbn))
    change_a, change_b = np.hypot(Van - van, Vat - vat), np.hypot(Vbn - vbn, Vbt - vbt)
    values = (
        *initial,
        *final,
        pn,
        ma * (Vat - vat),
        change_a,
        change_b,
        ki,
        kf,
        100 * (ki - kf) / ki,
        mu,
        critical,
    )
    names = (*INITIAL, *FINAL, "PN", "PT", "DVA", "DVB", "KI", "KF", "LOSS", "MUP", "MUC")
    shape = np.broadcast_shapes(*(np.shape(value) for value in values))
    zero, total = np.zeros(()), final[0] + final[1] + final[2] + final[3]
    # A is on the side that it approaches from, whichever way n points
    side = np.where(van > vbn, -1.0, 1.0)
    impulse = side * pn
    # no arms, no moment; mu is signed here, and -10 does not stand for the pivot
    conditions = findings(
        Evidence(
            gn=side * (van - vbn),
            pn=impulse,
            arm_a=zero,
            arm_b=zero,
            da=zero,
            db=zero,
            twice_lost=2 * (ki - kf),
            initial=ki,
            e=e,
            em=zero,
            mu=mu,
            forward=forward_friction(mu, critical * impulse),
            pivot_pn=impulse,
            limit=abs(critical * pn),
            # without arms the normal impulse does not reverse the sliding
            gt=zero,
            turning=zero,
            yielding=zero,
            condition=zero,
            sum_of_velocities=total,
        )
    )
    results = dict(zip(names, values, strict=True)) | {"STATUS": bits(conditions)}
    return {name: np.broadcast_to(value, shape) for name, value in results.items()}


def _floats(known: Mapping[str, Any], velocities: Sequence[str]) -> list[Array]:
    names = ("MA", "MB", "E", "MUP", *velocities)
    known = columns(known)
    absent = [name for name in names if name not in known]
    if absent:
        raise UserError(missing(absent))
    return [np.asarray(known[name], np.float64) for name in names]
