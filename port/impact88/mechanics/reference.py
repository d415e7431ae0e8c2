"""The reference: every result of a scene to 50 digits, by mpmath's intervals (extra ``oracle``).

It shares nothing with `formulas`. `equations` gives impulse and velocities, everything else follows
from these, with so many digits that nothing is lost. Each number is an interval that holds the
exact one; one that holds 0 is 0. Without mpmath the import of this module is a UserError. To add a
result, add its line where `_results` says so.
"""

from collections.abc import Mapping
from math import inf
from typing import Any

from ..decimals import exact
from ..errors import UserError, library
from ..names import FINAL_STATE, IMPULSES, PIVOT, VELOCITIES
from . import equations
from .equations import dot

DIGITS = 50  # correct digits: three times a double's
WRITTEN = 30  # digits of a text; the chapter's worked cases have as many
GUARD = 15  # further working digits, to which those for the spread of a scene's numbers are added
UNUSED = ("DA", "DB", "PA", "PB", "TA", "TB", "EM", "WA", "WB")  # by point masses

mpmath: Any = library("mpmath", "oracle", "the reference in 50 digits")
intervals = mpmath.ctx_iv.MPIntervalContext()
Number = Any  # mpmath.mpf, or an interval; neither has a usable type


def thirty_digits(scene: Mapping[str, str | float]) -> dict[str, str]:
    """Return results as decimal texts of 30 digits.

    Parameters
    ----------
    scene : mapping of str to str or float
        Scene names -> decimal texts, or floats with their exact values.

    Returns
    -------
    dict of str to str
        Results that have a value: none where the equations are singular or a number cannot be used.

    Raises
    ------
    UserError
        For a text that is no number.

    Examples
    --------
    >>> thirty_digits(impact88.sample(1))["VAX"]
    '-13.262655683532704239235175342'
    """
    values = results(scene)
    return {name: mpmath.nstr(x, WRITTEN) if x else "0" for name, x in values.items()}


def results(scene: Mapping[str, str | float]) -> dict[str, Number]:
    """Return every result but COND and STATUS as a number of 50 digits.

    Parameters
    ----------
    scene : mapping of str to str or float
        Scene names -> decimal texts, or floats with their exact values. M is 6 where it is not
        given.

    Returns
    -------
    dict of str to mpf
        Results that have a value: none where the equations are singular.
    """
    numbers = {name: _number(x) for name, x in scene.items()}
    powers = [int(mpmath.log10(abs(x))) for x in numbers.values() if 0 < abs(x) < inf]
    intervals.dps = DIGITS + GUARD + 3 * (max(powers, default=0) - min(powers, default=0))
    enclosures = _results(
        {n: intervals.mpf(x if isinstance(x, float) else str(x)) for n, x in numbers.items()}
    )
    with mpmath.workdps(DIGITS):  # the middle of an interval that holds everything is NaN
        values = {name: mpmath.mpf(x.mid) * (0 not in x) for name, x in enclosures.items()}
        values |= {n: mpmath.sqrt(values[n]) for n in values if n in ("EESA", "EESB")}
    return {name: x for name, x in values.items() if mpmath.isfinite(x)}


def _number(value: str | float) -> Any:
    """Return an exact number. Raises UserError for a text that is none."""
    try:
        return exact(value) if isinstance(value, str) else value
    except ValueError as error:
        raise UserError(f"{error}; expected a number") from None


def _results(scene: dict[str, Number]) -> dict[str, Number]:
    """Return the results of a scene's numbers."""
    g = scene
    zero = intervals.mpf(0)
    is_point = g.get("M", 6) == 4
    if is_point:
        g = {**g, **dict.fromkeys(UNUSED, zero), "IA": 1 + zero, "IB": 1 + zero}
    c, s = _vector(1, g["GA"])
    # from the centers to the contact point
    xa, ya = _vector(-g["DA"], g["TA"] + g["PA"])
    xb, yb = _vector(g["DB"], g["TB"] + g["PB"])
    contact = {  # velocities of the contact points along x and y by the six velocities
        "XA": (1, 0, -ya, 0, 0, 0),
        "YA": (0, 1, xa, 0, 0, 0),
        "XB": (0, 0, 0, 1, 0, -yb),
        "YB": (0, 0, 0, 0, 1, xb),
    }
    # A's minus B's along n and t, and of the spins
    sides = [*zip(*contact.values(), strict=True)]
    relative = [[dot(x, side) for side in sides] for x in ((c, s, -c, -s), (-s, c, s, -c))]
    relative.append([0, 0, 1, 0, 0, -1])
    masses = [g[name] for name in ("MA", "MA", "IA", "MB", "MB", "IB")]
    inverse = [1 / m for m in masses]
    before = [g[name] for name in VELOCITIES]
    gn, gt, _ = (dot(row, before) for row in relative)
    is_pivot = g["MU"] == PIVOT
    mu = -g["MU"] if gt.a > 0 and not is_pivot else g["MU"]
    known = {**g, "MUP": mu}
    no_slip, _ = equations.impact(known, True, relative, inverse)
    f, _ = equations.impact(known, is_pivot, relative, inverse)
    if not mpmath.isfinite(f["PT"].mid):  # the determinant's interval holds 0
        return {}
    after = [f[name] for name in FINAL_STATE]
    sums = [u + v for u, v in zip(before, after, strict=True)]
    P = [f[name] for name in IMPULSES]
    works = [-p * dot(row, sums) / 2 for p, row in zip(P, relative, strict=True)]
    f |= zip(("ELN", "ELT", "ELM"), works, strict=True)
    for suffix, energy, six in (("", "KI", before), ("F", "KF", after)):
        f |= {name + suffix: dot(row, six) for name, row in contact.items()}
        squares = (m * x * x for m, x in zip(masses, six, strict=True) if x != 0)
        f[energy] = sum(squares, zero) / 2
    if is_point:
        f |= {"WAF": scene["WA"], "WBF": scene["WB"]}
    lost, size = sum(works), intervals.sqrt(P[0] ** 2 + P[1] ** 2)
    ma, mb = inverse[0], inverse[3]
    part = (lost if lost.a > 0 else 0) * (2 if inf in (g["MA"], g["MB"]) else 1)
    # one line a result
    f["VC"] = -gn
    f["VS"] = -g["E"] * gn
    f["EESA"] = part * ma  # squared
    f["EESB"] = part * mb
    f["DVA"] = ma * size
    f["DVB"] = mb * size
    f["LOSS"] = 100 * lost / f["KI"]
    f["MUP"] = mu
    f["MUC"] = no_slip["PT"] / no_slip["PN"]
    return f


def _vector(length: Number, degrees: Number) -> tuple[Number, Number]:
    """Return the vector of a length and a direction."""
    angle = degrees * intervals.pi / 180
    return length * intervals.cos(angle), length * intervals.sin(angle)
