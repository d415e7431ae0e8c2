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
from ..names import FINAL_STATE, VELOCITIES

DIGITS = 50  # correct digits: three times a double's
WRITTEN = 30  # digits of a text; the chapter's worked cases have as many
GUARD = 15  # working digits beyond, besides those for the spread of a scene's numbers
UNUSED = ("DA", "DB", "PA", "PB", "TA", "TB", "EM")  # by point masses

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
        return _Scene({name: _number(x) for name, x in scene.items()}).results()


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


def _determinant(rows: Sequence[Sequence[Number]]) -> Number:
    """Return the determinant of three rows, as `_total`: 0 where nothing but rounding remains."""
    a, b, c = rows
    even = [a[i] * b[j] * c[k] for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))]
    odd = [-a[i] * b[j] * c[k] for i, j, k in ((0, 2, 1), (1, 0, 2), (2, 1, 0))]
    return _total(*even, *odd)


class _Scene:
    """The numbers of a scene, and the relative velocities that they lead to."""

    def __init__(self, g: dict[str, Number]) -> None:
        self.mpmath = mpmath = _mpmath()
        self.g = g
        self.zero = mpmath.mpf(0)
        self.is_point = g.get("M", 6) == 4
        if self.is_point:
            g.update(dict.fromkeys(UNUSED, self.zero), IA=mpmath.inf, IB=mpmath.inf)
        self.is_pivot = g["MU"] == -10
        self.s, self.c = self._direction(g["GA"])
        sine_a, cosine_a = self._direction(g["TA"] + g["PA"])
        sine_b, cosine_b = self._direction(g["TB"] + g["PB"])
        self.d1, self.d2 = g["DB"] * sine_b, g["DB"] * cosine_b
        self.d3, self.d4 = g["DA"] * sine_a, g["DA"] * cosine_a
        s, c = self.s, self.c
        # relative velocities of the contact points along n and t, and of the spins, A's minus B's
        one = mpmath.mpf(1)
        d1, d2, d3, d4 = self.d1, self.d2, self.d3, self.d4
        self.relative = [
            [c, s, _total(d3 * c, -d4 * s), -c, -s, _total(d1 * c, -d2 * s)],
            [-s, c, _total(-d4 * c, -d3 * s), s, -c, _total(-d2 * c, -d1 * s)],
            [self.zero, self.zero, one, self.zero, self.zero, -one],
        ]
        self.inertias = [g[name] for name in ("MA", "MA", "IA", "MB", "MB", "IB")]
        self.inverse = [self.zero if mpmath.isinf(x) else 1 / x for x in self.inertias]
        self.before = [g[name] for name in VELOCITIES]
        if self.is_point:
            self.before[2] = self.before[5] = self.zero
        self.gn, self.gt, self.gw = (_dot(row, self.before) for row in self.relative)
        opposes = self.is_pivot or self.gt <= 0
        self.mu = g["MU"] if opposes else -g["MU"]

    def _direction(self, degrees: Number) -> tuple[Number, Number]:
        """Return sine and cosine."""
        return self.mpmath.sinpi(degrees / 180), self.mpmath.cospi(degrees / 180)

    def impulse(self, is_pivot: bool) -> list[Number] | None:
        """Return Pn, Pt and the moment; None where the equations are singular."""
        e, em = self.g["E"], self.g["EM"]
        K = [
            [
                _total(*map(self.mpmath.fprod, zip(x, self.inverse, y, strict=True)))
                for y in self.relative
            ]
            for x in self.relative
        ]
        rows = [K[0], K[1] if is_pivot else [-self.mu, self.mpmath.mpf(1), self.zero]]
        right = [-(1 + e) * self.gn, -self.gt if is_pivot else self.zero]
        if not self.is_point:
            rows.append([(1 - em) * K[2][0], (1 - em) * K[2][1], (1 - 2 * em) * K[2][2]])
            right.append((em - 1) * self.gw)
        else:
            rows.append([self.zero, self.zero, self.mpmath.mpf(1)])
            right.append(self.zero)
        columns = list(zip(*rows, strict=True))
        divisor = _determinant(columns)
        if not divisor:
            return None
        replaced = ([*columns[:k], right, *columns[k + 1 :]] for k in range(3))
        return [_determinant(three) / divisor for three in replaced]

    def after(self, P: Sequence[Number]) -> list[Number]:
        """Return the final velocities, in the order of `VELOCITIES`."""
        columns = zip(*self.relative, strict=True)
        return [
            _total(v, *(j * m * p for j, p in zip(column, P, strict=True)))
            for v, column, m in zip(self.before, columns, self.inverse, strict=True)
        ]

    def results(self) -> dict[str, Number]:
        """Return the results."""
        g, mpmath = self.g, self.mpmath
        no_slip = self.impulse(True)
        P = no_slip if self.is_pivot else self.impulse(False)
        if P is None:
            return {}
        after = self.after(P)
        both = [_total(u, v) for u, v in zip(self.before, after, strict=True)]
        works = [-p * _dot(row, both) / 2 for p, row in zip(P, self.relative, strict=True)]
        lost, size = _total(*works), mpmath.hypot(P[0], P[1])
        initial, final = self.energy(self.before), self.energy(after)
        ma, mb = self.inverse[0], self.inverse[3]
        shared = max(lost, self.zero) * (1 if ma and mb else 2)
        f: dict[str, Number] = dict(zip(FINAL_STATE, after, strict=True))
        f |= self.contact_velocities(self.before, "") | self.contact_velocities(after, "F")
        f |= dict(zip(("ELN", "ELT", "ELM"), works, strict=True))
        f |= dict(zip(("PN", "PT", "PM"), P, strict=True))
        if self.is_point:
            f |= {"WAF": g["WA"], "WBF": g["WB"]}
        if initial:
            f["LOSS"] = 100 * lost / initial
        if no_slip and no_slip[0]:
            f["MUC"] = no_slip[1] / no_slip[0]
        # one line a result
        f["VC"] = -self.gn
        f["VS"] = -g["E"] * self.gn
        f["KI"] = initial
        f["KF"] = final
        f["EESA"] = mpmath.sqrt(shared * ma)
        f["EESB"] = mpmath.sqrt(shared * mb)
        f["DVA"] = ma * size
        f["DVB"] = mb * size
        f["MUP"] = self.mu
        return f

    def contact_velocities(self, six: Sequence[Number], suffix: str) -> dict[str, Number]:
        """Return XA YA XB YB of lines 340, 700 and 710."""
        ax, ay, wa, bx, by, wb = six
        return {
            f"XA{suffix}": _total(ax, self.d3 * wa),
            f"YA{suffix}": _total(ay, -self.d4 * wa),
            f"XB{suffix}": _total(bx, -self.d1 * wb),
            f"YB{suffix}": _total(by, self.d2 * wb),
        }

    def energy(self, six: Sequence[Number]) -> Number:
        """Return the kinetic energy; an infinite body is at rest."""
        pairs = zip(self.inertias, six, strict=True)
        return self.mpmath.fsum(m * v * v for m, v in pairs if not self.mpmath.isinf(m)) / 2
