"""Impacts from velocities before *or* after: Equations 13 to 18 solved for what is not known.

"If the final velocities are known, these equations are linear and can be solved for the initial
velocities, as done in an accident reconstruction" (chapter, Section IV-C). They stay linear in the
impulses where each of the six velocities is known before or after the impact, and each of the three
laws by its coefficient or its impulse: with g the relative velocities of the contact points along n
and t and of the spins, as the known velocities give them, K the change of the relative velocities
by unit impulses and D the part of K that acts through the velocities known after the impact,

    before:  g - D P        after:  g + (K - D) P        P = (Pn, Pt, M)

and each law is one linear equation in P.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import UserError
from ..names import FINAL_STATE, IMPULSES, PIVOT, VELOCITIES
from .consequences import typed_friction
from .solve import BODIES, POINT, evaluate

Floats = NDArray[np.float64]

LAWS = (("E", "PN"), ("MUP", "PT"), ("EM", "PM"))
"""Coefficient and impulse of Equations 15, 16 and 18."""
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
    known = arrays = {name: np.asarray(value, np.float64) for name, value in known.items()}
    if (known.setdefault("M", np.array(BODIES)) == POINT).all():
        known.update(EM=np.array(0.0), PM=np.array(0.0))
    geometry, lacking = evaluate({n: known[n] for n in COLUMNS if n in known}, GEOMETRY)
    missing = [*dict.fromkeys(name for names in lacking.values() for name in names)]
    pairs = list(zip(VELOCITIES, FINAL_STATE, strict=True))
    missing += [f"{a} or {b}" for a, b in (*pairs, *LAWS) if not {a, b} & known.keys()]
    if missing:
        raise UserError(f"missing {', '.join(missing)}")
    shape = np.broadcast_shapes(*(x.shape for x in arrays.values()))
    s, c, an, at, bn, bt, ma, mb, ia, ib = geometry.values()
    # relative velocities along n and t, and of the spins, by unit velocities
    relative = _stack([[c, s, an, -c, -s, bn], [-s, c, at, s, -c, bt], [0, 0, 1, 0, 0, -1]], shape)
    # changes of velocities by unit impulses
    changes = relative * _stack([[ma, ma, ia, mb, mb, ib]], shape)
    late = np.array([early not in known for early in VELOCITIES])
    full, delayed = _products(relative, changes), _products(relative[:, late], changes[:, late])
    given = _stack([[known[a if a in known else b] for a, b in pairs]], shape)
    rows, right = _laws(known, _products(relative, given)[:, 0], full - delayed, delayed)
    crosses = [_cross(rows[k - 2], rows[k - 1]) for k in range(3)]
    determinant = _dot(rows[0], crosses[0])
    impulse = [_dot(right, column) / determinant for column in zip(*crosses, strict=True)]
    values = {**known, **dict(zip(IMPULSES, impulse, strict=True))}
    for (before, after), change in zip(pairs, _dot(impulse, changes), strict=True):
        if before in known:
            values[after] = known[before] + change
        else:
            values[before] = known[after] - change
    velocities = _stack([[values[x] for x in VELOCITIES], [values[x] for x in FINAL_STATE]], shape)
    g, separation = np.moveaxis(_products(relative, velocities), 1, 0)
    twist = separation[2] + impulse[2] * full[2, 2]
    quotients = ((-separation[0], g[0]), (impulse[1], impulse[0]), (separation[2], twist))
    volume = -np.log(np.abs(determinant))
    for (name, _), (dividend, divisor) in zip(LAWS, quotients, strict=True):
        if name not in known:
            values[name] = dividend / divisor
            volume = volume - np.log(np.abs(divisor))
    (values["MU"],) = typed_friction(values["MUP"], g[1])
    (a, b, c), _ = _laws(values, g, full, np.zeros((3, 1)))
    return Completed(values, volume + np.log(np.abs(_dot(a, _cross(b, c)))))


def _stack(rows: Sequence[Sequence[ArrayLike]], shape: tuple[int, ...]) -> Floats:
    """Return rows of numbers and arrays as one array, with the shape of the impacts last."""
    stack = np.empty((len(rows), len(rows[0]), *shape))
    for k, row in enumerate(rows):
        for j, x in enumerate(row):
            stack[k, j] = x
    return stack


def _products(rows: Floats, columns: Floats) -> Floats:
    """Return the products of each row with each of ``columns``."""
    products: Floats = np.einsum("ik...,jk...->ij...", rows, columns)
    return products


def _dot(first: Iterable[Any], second: Iterable[Any]) -> Any:
    """Return the sum of the products of pairs."""
    return sum(x * y for x, y in zip(first, second, strict=True))


def _laws(
    known: Mapping[str, Any], g: Any, later: Floats, delayed: Floats
) -> tuple[list[Any], list[Any]]:
    """Return Equations 15, 16 and 18 as rows over the impulses, and their right sides.

    ``g``: the relative velocities of those given; ``later``, ``delayed``: the changes of relative
    velocities by unit impulses, through those given before and those given after the impact."""
    rows: list[Any] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    right = [known.get(name, 0.0) for name in IMPULSES]
    if "E" in known:
        rows[0] = later[0] - known["E"] * delayed[0]
        right[0] = -(1.0 + known["E"]) * g[0]
    if "MUP" in known:
        ends = known["MUP"] == PIVOT
        rows[1], right[1] = [-known["MUP"], 1.0, 0.0], 0.0
        if ends.any():
            rows[1] = [np.where(ends, k, x) for k, x in zip(later[1], rows[1], strict=True)]
            right[1] = np.where(ends, -g[1], 0.0)
    if "EM" in known and (known["M"] != POINT).any():
        rows[2] = (1.0 - known["EM"]) * later[2]
        rows[2][2] -= known["EM"] * (later[2, 2] + delayed[2, -1])
        right[2] = -(1.0 - known["EM"]) * g[2]
    return rows, right


def _cross(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    """Return the cross product of two rows."""
    x, y, z = a
    u, v, w = b
    return [y * w - z * v, z * u - x * w, x * v - y * u]
