"""The reference: every result of a scene to 50 digits, those of mpmath (extra ``oracle``).

It shares nothing with `formulas`. The impulse (Pn, Pt, M) solves Equations 15, 16 (or no slip at
separation) and 18 by Cramer's rule with so many digits that nothing is lost; everything else
follows from the impulse, and what cancels to less than 50 digits is 0. Without mpmath the import of
this module is a UserError. To add a result, add its line where `_results` says so.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from ..decimals import exact
from ..errors import UserError, library
from ..names import FINAL_STATE, IMPULSES, PIVOT, VELOCITIES

DIGITS = 50  # correct digits: three times a double's
WRITTEN = 30  # digits of a text; the chapter's worked cases have as many
GUARD = 15  # further working digits, to which those for the spread of a scene's numbers are added
UNUSED = ("DA", "DB", "PA", "PB", "TA", "TB", "EM", "WA", "WB")  # by point masses

mpmath: Any = library("mpmath", "oracle", "the reference in 50 digits")
Number = Any  # mpmath.mpf, which has no usable type


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
    try:
        values = results(scene)
    except ZeroDivisionError:  # a mass of 0
        return {}
    with mpmath.workdps(DIGITS):
        return {
            name: mpmath.nstr(value, WRITTEN) if value else "0"
            for name, value in values.items()
            if mpmath.isfinite(value)
        }


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
    with mpmath.workdps(GUARD):
        sizes = [abs(_number(x)) for name, x in scene.items() if name not in ("MU", "M")]
        powers = [int(mpmath.log10(x)) for x in sizes if x and mpmath.isfinite(x)]
    spread = max(powers, default=0) - min(powers, default=0)
    with mpmath.workdps(DIGITS + GUARD + 3 * spread):
        return _results({name: _number(x) for name, x in scene.items()})


def _number(value: str | float) -> Number:
    """Return a number at the working precision. Raises UserError for a text that is none."""
    if not isinstance(value, str):
        return mpmath.mpf(value)
    try:
        fraction = exact(value)
    except ValueError as error:
        raise UserError(f"{error}; expected a number") from None
    return mpmath.mpf(fraction.numerator) / fraction.denominator


def _total(*terms: Number) -> Number:
    """Return a sum; 0 where it is nothing but rounding."""
    total = mpmath.fsum(terms)
    noise = max(map(abs, terms)) * mpmath.mpf(10) ** -DIGITS
    return total if abs(total) > noise else mpmath.mpf(0)


def _products(rows: Iterable[Iterable[Number]], column: Sequence[Number]) -> list[Number]:
    """Return the product of each row with a column, sums as `_total`."""
    return [_total(*(a * b for a, b in zip(row, column, strict=True))) for row in rows]


def _cross(first: Sequence[Number], second: Sequence[Number]) -> list[Number]:
    """Return the cross product of two columns."""
    x, y, z = first
    u, v, w = second
    return [_total(y * w, -z * v), _total(z * u, -x * w), _total(x * v, -y * u)]


def _solve_three(rows: Sequence[Sequence[Number]], right: Sequence[Number]) -> list[Number] | None:
    """Return the solution of three equations by Cramer's rule, None where they are singular."""
    columns = list(zip(*rows, strict=True))
    crosses = [_cross(columns[k - 2], columns[k - 1]) for k in range(3)]
    (divisor,) = _products(crosses[:1], columns[0])
    return [x / divisor for x in _products(crosses, right)] if divisor else None


def _results(scene: dict[str, Number]) -> dict[str, Number]:
    """Return the results of a scene's numbers."""
    g = scene
    is_point, is_pivot = g.get("M", 6) == 4, g["MU"] == PIVOT
    if is_point:
        g = {**g, **dict.fromkeys(UNUSED, mpmath.mpf(0)), "IA": mpmath.mpf(1), "IB": mpmath.mpf(1)}
    c, s = _vector(1, g["GA"])
    # from the centers to the contact point
    xa, ya = _vector(-g["DA"], g["TA"] + g["PA"])
    xb, yb = _vector(g["DB"], g["TB"] + g["PB"])
    # by the six velocities: those of the contact points along x and y; A's minus B's along n and t
    # and of the spins
    contact = [
        [1, 0, -ya, 0, 0, 0],
        [0, 1, xa, 0, 0, 0],
        [0, 0, 0, 1, 0, -yb],
        [0, 0, 0, 0, 1, xb],
    ]
    relative = [_products(zip(*contact, strict=True), x) for x in ((c, s, -c, -s), (-s, c, s, -c))]
    relative.append([0, 0, 1, 0, 0, -1])
    masses = [g[name] for name in ("MA", "MA", "IA", "MB", "MB", "IB")]
    changes = [[x / m for x, m in zip(row, masses, strict=True)] for row in relative]
    before = [g[name] for name in VELOCITIES]
    gn, gt, gw = _products(relative, before)
    mu = g["MU"] if is_pivot or gt <= 0 else -g["MU"]

    # Equations 15, 16 (or no slip at separation) and 18 for Pn, Pt and the moment
    normal, tangential, turning = (_products(changes, row) for row in relative)
    e, em = g["E"], g["EM"]
    moment = [(1 - em) * x for x in turning[:2]] + [(1 - 2 * em) * turning[2]]
    right = [-(1 + e) * gn, -gt, (em - 1) * gw]
    no_slip = _solve_three([normal, tangential, moment], right)
    sliding = _solve_three([normal, [-mu, 1, 0], moment], [right[0], 0, right[2]])
    P = no_slip if is_pivot else sliding
    if P is None:
        return {}
    after = _products(zip(before, *changes, strict=True), (1, *P))
    sums = [_total(u, v) for u, v in zip(before, after, strict=True)]
    works = [-p * v / 2 for p, v in zip(P, _products(relative, sums), strict=True)]
    lost, size = _total(*works), mpmath.hypot(*P[:2])
    ma, mb = 1 / g["MA"], 1 / g["MB"]
    part = max(lost, 0) * (1 if ma and mb else 2)
    names = (*FINAL_STATE, *IMPULSES, "ELN", "ELT", "ELM")
    f: dict[str, Number] = dict(zip(names, (*after, *P, *works), strict=True))
    for contacts, energy, v in (
        (("XA", "YA", "XB", "YB"), "KI", before),
        (("XAF", "YAF", "XBF", "YBF"), "KF", after),
    ):
        f |= zip(contacts, _products(contact, v), strict=True)
        f[energy] = mpmath.fsum(m * x * x for m, x in zip(masses, v, strict=True) if x) / 2
    if is_point:
        f |= {"WAF": scene["WA"], "WBF": scene["WB"]}
    if f["KI"]:
        f["LOSS"] = 100 * lost / f["KI"]
    if no_slip and no_slip[0]:
        f["MUC"] = no_slip[1] / no_slip[0]
    # one line a result
    f["VC"] = -gn
    f["VS"] = -e * gn
    f["EESA"] = mpmath.sqrt(part * ma)
    f["EESB"] = mpmath.sqrt(part * mb)
    f["DVA"] = ma * size
    f["DVB"] = mb * size
    f["MUP"] = mu
    return f


def _vector(length: Number, degrees: Number) -> tuple[Number, Number]:
    """Return the vector of a length and a direction."""
    return length * mpmath.cospi(degrees / 180), length * mpmath.sinpi(degrees / 180)
