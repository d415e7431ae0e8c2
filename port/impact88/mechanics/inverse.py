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

from collections.abc import Mapping, Sequence
from itertools import compress
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import UserError
from ..names import FINAL_STATE, IMPULSES, PIVOT, VELOCITIES
from .solve import BODIES, POINT, evaluate

Floats = NDArray[np.float64]
Row = list[Any]  # over Pn, Pt and M

LAWS = (("E", "PN"), ("MUP", "PT"), ("EM", "PM"))
"""Coefficient and impulse of Equations 15, 16 and 18."""
GEOMETRY = ("s", "c", "an", "at", "bn", "bt", "ma", "mb", "ia", "ib")
COLUMNS = ("MA", "MB", "IA", "IB", "DA", "DB", "PA", "PB", "TA", "TB", "GA", "M")
ROW = [0.0] * 3


class Completed(NamedTuple):
    """Impacts of which everything is known.

    Parameters
    ----------
    values : dict of str to ndarray
        What was given, and all of UX UY WA VX VY WB, VAX VAY WAF VBX VBY WBF, PN PT PM, E MUP EM,
        MU (as typed: line 400 makes MUP of it) and mu, which is MUP. `evaluate` gives all else.
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
        are given, the velocity before and the coefficient count. Point masses need no EM.

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
    known = {name: np.asarray(value, np.float64) for name, value in known.items()}
    m = known.setdefault("M", np.array(BODIES))
    is_point = np.asarray(m == POINT)
    if is_point.all():
        known.update(EM=np.array(0.0))
    geometry, lacking = evaluate({n: known[n] for n in COLUMNS if n in known}, GEOMETRY)
    missing = dict.fromkeys(name for names in lacking.values() for name in names)
    pairs = list(zip(VELOCITIES, FINAL_STATE, strict=True))
    missing.update({f"{a} or {b}": None for a, b in (*pairs, *LAWS) if not {a, b} & known.keys()})
    if missing:
        raise UserError(f"missing {', '.join(missing)}")
    late = [early not in known for early in VELOCITIES]
    given = [known[b if is_late else a] for (a, b), is_late in zip(pairs, late, strict=True)]
    contact = _Contact(geometry, is_point)
    delayed = contact.compliance(late)
    rows, right = contact.laws(contact.relative(given), delayed, known)
    impulse = _solve_three(rows, right)
    values = {**known, **dict(zip(IMPULSES, impulse, strict=True))}
    for (before, after), is_late, row in zip(pairs, late, contact.by_impulse, strict=True):
        if is_late:
            values[before] = known[after] - _dot(row, impulse)
        else:
            values[after] = known[before] + _dot(row, impulse)
    g = contact.relative([values[name] for name in VELOCITIES])
    separation = contact.relative([values[name] for name in FINAL_STATE])
    twist = separation[2] + impulse[2] * contact.by_moment
    quotients = ((-separation[0], g[0]), (impulse[1], impulse[0]), (separation[2], twist))
    volume = -np.log(np.abs(_determinant(rows)))
    for (name, _), (dividend, divisor) in zip(LAWS, quotients, strict=True):
        if name not in known:
            values[name] = dividend / divisor
            volume = volume - np.log(np.abs(divisor))
    values["mu"] = mu = values["MUP"]
    values["MU"] = np.where((g[1] > 0.0) & (mu != PIVOT), -mu, mu)
    forward, _ = contact.laws(g, [ROW, ROW, ROW], values)
    return Completed(values, volume + np.log(np.abs(_determinant(forward))))


class _Contact:
    """Two bodies in contact: how velocities and impulses act on each other."""

    def __init__(self, geometry: Mapping[str, Any], is_point: NDArray[np.bool_]) -> None:
        s, c, an, at, bn, bt, ma, mb, ia, ib = (geometry[name] for name in GEOMETRY)
        self.is_point = is_point
        if is_point.any():  # their spins pass through
            ia, ib = (np.where(is_point, 0.0, x) for x in (ia, ib))
        # relative velocities along n and t, and of the spins, by unit velocities
        self.by_velocity: list[Row] = [
            [c, s, an, -c, -s, bn],
            [-s, c, at, s, -c, bt],
            [0.0, 0.0, 1.0, 0.0, 0.0, -1.0],
        ]
        # changes of velocities by unit impulses
        self.by_impulse: list[Row] = [
            [x if type(x) is float and x == 0.0 else x * inverse for x in column]
            for *column, inverse in zip(*self.by_velocity, (ma, ma, ia, mb, mb, ib), strict=True)
        ]
        self.full = self.compliance([True] * 6)
        self.by_moment = ia + ib

    def relative(self, velocities: Sequence[Any]) -> Row:
        """Return the relative velocities along n and t, and of the spins."""
        return [_dot(row, velocities) for row in self.by_velocity]

    def compliance(self, chosen: Sequence[bool]) -> list[Row]:
        """Return the changes of the relative velocities by unit impulses, through the chosen
        velocities."""
        rows = [list(compress(row, chosen)) for row in self.by_velocity]
        columns = [*zip(*compress(self.by_impulse, chosen), strict=True)] or [(), (), ()]
        return [[_dot(row, column) for column in columns] for row in rows]

    def laws(self, g: Row, delayed: list[Row], known: Mapping[str, Any]) -> tuple[list[Row], Row]:
        """Return Equations 15, 16 and 18 as rows over the impulses, and their right sides.

        ``g``: the relative velocities of those given; ``delayed``: the compliance through those
        that are given after the impact."""
        rows: list[Row] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        right: Row = [known.get(name, 0.0) for name in IMPULSES]
        later = [
            [k - d for k, d in zip(*pair, strict=True)]
            for pair in zip(self.full, delayed, strict=True)
        ]
        if "E" in known:
            e = known["E"]
            rows[0] = [k + e * -d for k, d in zip(later[0], delayed[0], strict=True)]
            right[0] = -(1.0 + e) * g[0]
        if "MUP" in known:
            mu = known["MUP"]
            ends = mu == PIVOT
            slides = [-mu, 1.0, 0.0]
            rows[1] = [np.where(ends, k, x) for k, x in zip(later[1], slides, strict=True)]
            right[1] = np.where(ends, -g[1], 0.0)
        if "EM" in known:
            em = known["EM"]
            rows[2] = [(1.0 - em) * k for k in later[2]]
            rows[2][2] = rows[2][2] - em * self.by_moment
            right[2] = -(1.0 - em) * g[2]
        if self.is_point.any():
            no_moment = [0.0, 0.0, 1.0]
            rows[2] = [
                np.where(self.is_point, x, k) for k, x in zip(rows[2], no_moment, strict=True)
            ]
            right[2] = np.where(self.is_point, 0.0, right[2])
        return rows, right


def _dot(row: Sequence[Any], column: Sequence[Any]) -> Any:
    """Return the sum of products, without the terms that are the number 0."""
    return sum(a * b for a, b in zip(row, column, strict=True) if not (type(a) is float and a == 0))


def _determinant(m: Sequence[Sequence[Any]]) -> Any:
    """Return the determinant of three rows."""
    a, b, c = m
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def _solve_three(rows: Sequence[Sequence[Any]], right: Sequence[Any]) -> Row:
    """Return the solution of three linear equations by Cramer's rule."""
    columns = list(zip(*rows, strict=True))
    total = _determinant(columns)
    return [
        _determinant([right if j == k else columns[j] for j in range(3)]) / total for k in range(3)
    ]
