"""Impacts from velocities before *or* after: Equations 13 to 18 solved for what is not known.

"If the final velocities are known, these equations are linear and can be solved for the initial
velocities, as done in an accident reconstruction" (chapter, Section IV-C).
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import UserError
from ..names import PIVOT, SCENE
from . import equations
from .equations import LAWS, PAIRS
from .formulas import NO_MOMENT
from .solve import BODIES, POINT, evaluate

Floats = NDArray[np.float64]

COLUMNS = "MA MB IA IB DA DB PA PB TA TB GA M".split()
GEOMETRY = "s c an at bn bt ma mb ia ib"


class Completed(NamedTuple):
    """Impacts of which everything is known.

    Parameters
    ----------
    values : dict of str to ndarray
        What was given, and all of UX UY WA VX VY WB, VAX VAY WAF VBX VBY WBF, PN PT PM, E MUP EM,
        MU (as typed: line 400 makes MUP of it). `evaluate` gives all else.
    log_volume : ndarray
        Logarithm of the volume of velocities before and coefficients per unit of the velocities and
        of the laws' values that were given.
    """

    values: dict[str, Any]
    log_volume: Floats


@np.errstate(all="ignore")
def complete(known: Mapping[str, ArrayLike]) -> Completed:
    """Return impacts of which six velocities and three laws are known.

    Parameters
    ----------
    known : mapping of str to float or array_like
        Numbers or arrays of one shape: the bodies (MA MB IA IB DA DB PA PB TA TB GA, and M, 6 by
        default; of point masses MA MB GA), each velocity before the impact or after it (UX or VAX,
        UY or VAY, WA or WAF, VX or VBX, VY or VBY, WB or WBF), and of each law the coefficient or
        the impulse (E or PN; MUP, the signed Pt/Pn, -10 for the pivot, or PT; EM or PM). Where both
        are given, the velocity before and the coefficient count. M is the same in all impacts.

    Returns
    -------
    Completed
        Values that are NaN or infinite where the equations have no solution: for the inverse at E
        = 0, at EM = 0 (which the chapter omits) and for the pivot.

    Raises
    ------
    UserError
        For a body, velocity or law that is not known.

    Examples
    --------
    >>> scene = impact88.sample(1).numbers()
    >>> results = impact88.solve(scene)
    >>> known = {name: scene[name] for name in scene if name not in ("UX", "UY", "VX", "VY")}
    >>> known |= {name: results[name] for name in ("VAX", "VAY", "VBX", "VBY", "MUP")}
    >>> print(complete(known).values["UX"].round(9), scene["UX"])
    -29.04 -29.04
    """
    values: dict[str, Any] = {n: np.asarray(x, np.float64) for n, x in known.items() if n != "MU"}
    if (values.setdefault("M", np.array(BODIES)) == POINT).all():
        values["EM"] = np.array(NO_MOMENT)
    geometry, lacking = evaluate({n: values[n] for n in COLUMNS if n in values}, GEOMETRY)
    missing = [*dict.fromkeys(name for names in lacking.values() for name in names)]
    missing += [f"{a} or {b}" for a, b in (*PAIRS, *LAWS) if not {a, b} & values.keys()]
    if missing:
        raise UserError(f"missing {', '.join(missing)}")
    s, c, an, at, bn, bt, ma, mb, ia, ib = geometry.values()
    relative: list[list[Any]] = [
        [c, s, an, -c, -s, bn],
        [-s, c, at, s, -c, bt],
        [0.0, 0.0, 1.0, 0.0, 0.0, -1.0],
    ]
    is_pivot = np.equal(values.get("MUP", 0.0), PIVOT)
    found, given = equations.impact(values, is_pivot, relative, [ma, ma, ia, mb, mb, ib])
    open_laws = [name for name, _ in LAWS if name not in values]
    values |= found
    *more, gn, waf, wbf = evaluate(values, (*open_laws, "MU", "gn", "waf", "wbf"))[0].values()
    values |= zip((*open_laws, "MU"), more, strict=True)
    divisors = {"E": gn, "MUP": values["PN"], "EM": waf - wbf + values["PM"] * (ia + ib)}
    forward, _ = evaluate({name: values[name] for name in SCENE if name in values}, "D")
    ratio = forward["D"] * (ia + ib) / given
    for name in open_laws:
        ratio = ratio / divisors[name]
    return Completed(values, np.broadcast_to(np.log(np.abs(ratio)), np.shape(found["PN"])))
