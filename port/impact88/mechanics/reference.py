"""The reference: every result of a scene to 50 digits, those of mpmath (extra ``oracle``).

It shares nothing with `formulas`. The impulse (Pn, Pt, M) solves Equations 15, 16 (or no slip at
separation) and 18 by Cramer's rule with so many digits that nothing is lost; everything else
follows from the impulse, and what cancels to less than 50 digits is 0. To add a result, add its
line where `results` says so.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from .. import errors
from ..decimals import exact
from ..errors import UserError
from ..names import FINAL_STATE, PIVOT, VELOCITIES

DIGITS = 50  # correct digits: three times a double's
WRITTEN = 30  # digits of a text; the chapter's worked cases have as many
GUARD = 15  # further working digits, to which those for the spread of a scene's numbers are added
UNUSED = ("DA", "DB", "PA", "PB", "TA", "TB", "EM", "WA", "WB")  # by point masses

Number = Any  # mpmath.mpf, which has no usable type


def _mpmath() -> Any:
    """Return mpmath. Raises UserError where it is not installed."""
    return errors.library("mpmath", "oracle", "the reference in 50 digits")


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
        For a text that is no number, and where mpmath is not installed.

    Examples
    --------
    >>> thirty_digits(impact88.sample(1))["VAX"]
    '-13.262655683532704239235175342'
    """
    mpmath = _mpmath()
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
    mpmath = _mpmath()
    with mpmath.workdps(GUARD):
        sizes = [abs(_number(x)) for name, x in scene.items() if name not in ("MU", "M")]
        powers = [int(mpmath.log10(x)) for x in sizes if x and mpmath.isfinite(x)]
    spread = max(powers, default=0) - min(powers, default=0)
    with mpmath.workdps(DIGITS + GUARD + 3 * spread):
        return _results({name: _number(x) for name, x in scene.items()})


def _number(value: str | float) -> Number:
    """Return a number at the working precision. Raises UserError for a text that is none."""
    mpmath = _mpmath()
    if not isinstance(value, str):
        return mpmath.mpf(value)
    try:
        fraction = exact(value)
    except ValueError as error:
        raise UserError(f"{error}; expected a number") from None
    return mpmath.mpf(fraction.numerator) / fraction.denominator


def _total(*terms: Number) -> Number:
    """Return a sum; 0 where it is nothing but rounding."""
    mpmath = _mpmath()
    total = mpmath.fsum(terms)
    noise = max(map(abs, terms)) * mpmath.mpf(10) ** -DIGITS
    return total if abs(total) > noise else mpmath.mpf(0)


def _dot(row: Iterable[Number], column: Iterable[Number]) -> Number:
    """Return a sum of products, as `_total`."""
    return _total(*(a * b for a, b in zip(row, column, strict=True)))


def _cross(first: Sequence[Number], second: Sequence[Number]) -> list[Number]:
    """Return the cross product of two columns."""
    x, y, z = first
    u, v, w = second
    return [_total(y * w, -z * v), _total(z * u, -x * w), _total(x * v, -y * u)]


def _solve_three(rows: Sequence[Sequence[Number]], right: Sequence[Number]) -> list[Number] | None:
    """Return the solution of three equations by Cramer's rule, None where they are singular."""
    columns = list(zip(*rows, strict=True))
    crosses = [_cross(columns[k - 2], columns[k - 1]) for k in range(3)]
    divisor = _dot(columns[0], crosses[0])
    return [_dot(right, cross) / divisor for cross in crosses] if divisor else None


def _results(scene: dict[str, Number]) -> dict[str, Number]:
    """Return the results of a scene's numbers."""
    mpmath = _mpmath()
    g = scene
    is_point, is_pivot = g.get("M", 6) == 4, g["MU"] == PIVOT
    if is_point:
        g = {**g, **dict.fromkeys(UNUSED, mpmath.mpf(0)), "IA": mpmath.mpf(1), "IB": mpmath.mpf(1)}
    s, c = _direction(g["GA"])
    sine_a, cosine_a = _direction(g["TA"] + g["PA"])
    sine_b, cosine_b = _direction(g["TB"] + g["PB"])
    # from the centers to the contact point
    arm_a = -g["DA"] * cosine_a, -g["DA"] * sine_a
    arm_b = g["DB"] * cosine_b, g["DB"] * sine_b
    # relative velocities of the contact points along n and t, and of the spins, A's minus B's
    relative = [
        [x, y, _moment(arm_a, x, y), -x, -y, -_moment(arm_b, x, y)] for x, y in ((c, s), (-s, c))
    ]
    relative.append([0, 0, 1, 0, 0, -1])
    masses = [g[name] for name in ("MA", "MA", "IA", "MB", "MB", "IB")]
    changes = [[x / m for x, m in zip(row, masses, strict=True)] for row in relative]
    before = [g[name] for name in VELOCITIES]
    gn, gt, gw = (_dot(row, before) for row in relative)
    mu = g["MU"] if is_pivot or gt <= 0 else -g["MU"]

    # Equations 15, 16 (or no slip at separation) and 18 for Pn, Pt and the moment
    K = [[_dot(row, column) for column in changes] for row in relative]
    e, em = g["E"], g["EM"]
    moment = [(1 - em) * K[2][0], (1 - em) * K[2][1], (1 - 2 * em) * K[2][2]]
    right = [-(1 + e) * gn, -gt, (em - 1) * gw]
    no_slip = _solve_three([K[0], K[1], moment], right)
    sliding = _solve_three([K[0], [-mu, 1, 0], moment], [right[0], 0, right[2]])
    P = no_slip if is_pivot else sliding
    if P is None:
        return {}
    after = [
        _total(v, *(x * p for x, p in zip(column, P, strict=True)))
        for v, column in zip(before, zip(*changes, strict=True), strict=True)
    ]
    sums = [_total(u, v) for u, v in zip(before, after, strict=True)]
    works = [-p * _dot(row, sums) / 2 for p, row in zip(P, relative, strict=True)]
    lost, size = _total(*works), mpmath.hypot(P[0], P[1])
    ma, mb = 1 / g["MA"], 1 / g["MB"]
    part = max(lost, 0) * (1 if ma and mb else 2)
    f: dict[str, Number] = dict(zip(FINAL_STATE, after, strict=True))
    f |= dict(zip(("ELN", "ELT", "ELM"), works, strict=True))
    f |= dict(zip(("PN", "PT", "PM"), P, strict=True))
    for suffix, energy, v in (("", "KI", before), ("F", "KF", after)):
        for body, (x, y), (vx, vy, w) in (("A", arm_a, v[:3]), ("B", arm_b, v[3:])):
            f[f"X{body}{suffix}"] = _total(vx, -y * w)
            f[f"Y{body}{suffix}"] = _total(vy, x * w)
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


def _moment(arm: Sequence[Number], x: Number, y: Number) -> Number:
    """Return the moment of (x, y) at an arm: what a unit of spin moves its end along (x, y)."""
    return _total(arm[0] * y, -arm[1] * x)


def _direction(degrees: Number) -> tuple[Number, Number]:
    """Return sine and cosine of an angle."""
    return _mpmath().sinpi(degrees / 180), _mpmath().cospi(degrees / 180)
