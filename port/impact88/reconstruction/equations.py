"""Equations 13-18 as linear equations in what is unknown of an impact, over arrays.

The impulses P_n, P_t and M are unknowns of their own, which turns Equations 13, 14 and 17 into six
statements "velocity after = velocity before + impulse / inertia" (three for each vehicle, so that
a barrier is nothing special). Eliminating the velocities of which one of the pair (before, after)
is known leaves at most 3 + 6 unknowns z. A coefficient that is unknown stands in one equation alone
(e in 15, μ in 16, e_m in 18): that equation is left out and gives the coefficient at the end.

Rank is decided by singular values; everything is scaled to velocities, impulses by the reduced
mass and spins by the radius of gyration, so that they are pure numbers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..names import COEFFICIENTS, FINAL_STATE, IMPULSES, VELOCITIES
from .geometry import Geometry

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Rows = tuple[Array, Array]
"""A velocity, or an impulse as one: its rows over z and over the known velocities k."""

INITIAL, FINAL = VELOCITIES, FINAL_STATE
SPINS = ("WA", "WB", "WAF", "WBF")

RANK_TOLERANCE = 1e-12
"""Singular values below this share of the largest count as zero."""
_OPEN = 1e-9
"""From this share of what is left open in a quantity, the quantity is not determined."""
_MISMATCH = 1e-9
"""What equations leave over below this share of the largest speed is rounding."""
_NOTHING = 1e-12
"""Denominators of coefficients below this share of the largest speed count as zero."""


@dataclass(frozen=True)
class Found:
    """What the equations of a block of scenes determine; one row a scene.

    ``values``: by name, NaN where not determined. ``amplification``: of each wanted quantity, see
    `unknowns.Solution`. ``sliding``: the tangential relative velocity before the impact,
    NaN where not determined. ``mismatch``: root mean square, 0 when the equations hold.
    ``made_of_something``: where both parts of every wanted coefficient's quotient are determined.
    """

    values: dict[str, Array]
    amplification: dict[str, Array]
    sliding: Array
    mismatch: Array
    gyration: Array
    made_of_something: Flags


class Equations:
    """The equations A·z = B·k of a block of scenes.

    z: the impulses, then the initial velocities of those pairs (before, after) of which both are
    unknown; k: the known velocities, in the order of ``known``.
    """

    def __init__(self, given: Mapping[str, Array], *, point: bool, pivot: bool) -> None:
        """``given``: 1-d arrays of one length by name; ``point``: point masses (M = 4), whose spins
        and EM play no part; ``pivot``: no tangential relative velocity after the impact."""
        self.given, self.point, self.pivot = given, point, pivot
        self.geometry = geometry = Geometry.of(given)
        self.count = len(given["MA"])
        self.reduced_mass = 1 / geometry.inverse_mass
        self.gyration = np.sqrt(geometry.inverse_mass / geometry.inverse_spin_inertia)
        self.impulses = 2 if point else 3
        pairs = [pair for pair in zip(INITIAL, FINAL, strict=True) if not self._leaves_out(pair[0])]
        self.known = [n for n in (*INITIAL, *FINAL) if n in given and not self._leaves_out(n)]
        self.free = [before for before, after in pairs if not {before, after} & set(self.known)]
        self.unknowns = self.impulses + len(self.free)
        self.nothing = np.zeros((self.count, len(self.known)))
        changes = self._changes()
        self.velocity: dict[str, Rows] = {}
        self.both: dict[str, Array] = {}
        for before, after in pairs:
            self._relate(before, after, changes[:, INITIAL.index(before)])
        self.normal_before, self.normal_after = (self._relative(0, n) for n in (INITIAL, FINAL))
        self.tangential_before = self._relative(1, INITIAL)

    def _leaves_out(self, name: str) -> bool:
        return self.point and name in SPINS

    def _changes(self) -> Array:
        """Velocity changes (second axis) by scaled impulses (third axis)."""
        directions, inverses = self.geometry.directions(), self.geometry.inverses()
        changes = np.zeros((self.count, 6, self.impulses))
        for i, name in enumerate(INITIAL):
            scale = self.reduced_mass * (self.gyration if name in SPINS else 1.0)
            for j in range(self.impulses):
                changes[:, i, j] = directions[j][i] * inverses[i] * scale
        if not self.point:
            changes[:, :, 2] *= self.gyration[:, None]
        return changes

    def _relate(self, before: str, after: str, changes: Array) -> None:
        """The velocities before and after of one component, as rows over z and k."""
        z = np.zeros((2, self.count, self.unknowns))
        k = np.zeros((2, self.count, len(self.known)))
        for at, name in enumerate((before, after)):
            if name in self.known:
                k[at, :, self.known.index(name)] = 1.0
        if before in self.known and after in self.known:
            self.both[before] = changes
        elif before in self.known:
            k[1] = k[0]
            z[1, :, : self.impulses] = changes
        elif after in self.known:
            k[0] = k[1]
            z[0, :, : self.impulses] = -changes
        else:
            z[:, :, self.impulses + self.free.index(before)] = 1.0
            z[1, :, : self.impulses] += changes
        self.velocity[before], self.velocity[after] = (z[0], k[0]), (z[1], k[1])

    def _relative(self, direction: int, names: Sequence[str]) -> Rows:
        """Normal, tangential or (times the radius of gyration) angular relative velocity."""
        z, k = np.zeros((self.count, self.unknowns)), self.nothing.copy()
        for name, weight in zip(names, self.geometry.directions()[direction], strict=True):
            if name in self.velocity:
                scaled = weight / self.gyration if name in SPINS else weight
                factor = np.broadcast_to(scaled, (self.count,))[:, None]
                z += factor * self.velocity[name][0]
                k += factor * self.velocity[name][1]
        if direction == 2:
            return z * self.gyration[:, None], k * self.gyration[:, None]
        return z, k

    def _impulse(self, j: int) -> Rows:
        z = np.zeros((self.count, self.unknowns))
        z[:, j] = 1.0
        return z, self.nothing

    # -- the equations, each a row of A and a row of B

    def _restitution(self) -> Rows:
        """Equation 15."""
        e = self.given["E"][:, None]
        (z0, k0), (z1, k1) = self.normal_before, self.normal_after
        return z1 + e * z0, -k1 - e * k0

    def _friction(self) -> Rows:
        """Equation 16, or the pivot's condition (lines 430 and 440)."""
        if self.pivot:
            z, k = self._relative(1, FINAL)
            return z, -k
        return self._impulse(1)[0] - self.given["MUP"][:, None] * self._impulse(0)[0], self.nothing

    def _moment(self) -> Rows:
        """Equation 18; the scaled M is already the moment impulse over the reduced inertia."""
        em = self.given["EM"][:, None]
        z, k = self._relative(2, FINAL)
        return (1 - em) * z - em * self._impulse(2)[0], -(1 - em) * k

    def _momentum(self) -> list[Rows]:
        """Equations 13, 14 and 17 for the components known before and after."""
        rows = []
        for before, changes in self.both.items():
            after = FINAL[INITIAL.index(before)]
            if not changes.any() and (self.given[before] == self.given[after]).all():
                continue  # a barrier: it holds still, and its momentum is nobody's equation
            z = np.zeros((self.count, self.unknowns))
            z[:, : self.impulses] = changes
            rows.append((z, self.velocity[after][1] - self.velocity[before][1]))
        return rows

    def _assembled(self) -> Rows:
        rows = self._momentum()
        if "E" in self.given:
            rows.append(self._restitution())
        if "MUP" in self.given:
            rows.append(self._friction())
        if "EM" in self.given and not self.point:
            rows.append(self._moment())
        if not rows:
            rows.append((np.zeros((self.count, self.unknowns)), self.nothing))
        return np.stack([z for z, _ in rows], 1), np.stack([k for _, k in rows], 1)

    # -- the solution

    def solve(self, wanted: Sequence[str]) -> Found:
        """What the equations determine, ``wanted`` above all."""
        left, right = self._assembled()
        over = left.shape[1] > self.unknowns
        scale = np.ones((1, 1, 1))
        if not over:
            # the solution is the same however the equations are scaled; this is best for rounding
            largest = np.abs(left).max(axis=2, initial=0.0)
            scale = np.where(largest > 0, largest, 1.0)[:, :, None]
            left, right = left / scale, right / scale
        inverse, self.open = _pseudo_inverse(left)
        self.slopes = inverse @ right
        self.k = self.nothing.copy()
        for at, name in enumerate(self.known):
            self.k[:, at] = self.given[name] * (self.gyration if name in SPINS else 1.0)
        self.z = _times(self.slopes, self.k)
        rest = _times(left, self.z) - _times(right, self.k)
        values, slopes, made = self._values(wanted)
        sliding, _, determined = self._evaluated(self.tangential_before)
        return Found(
            values=values,
            amplification={n: np.sqrt((slopes[n] ** 2).sum(axis=1)) for n in wanted},
            sliding=np.where(determined, sliding, np.nan),
            mismatch=self._mismatch(rest if over else rest * scale[:, :, 0]),
            gyration=self.gyration,
            made_of_something=made,
        )

    def _mismatch(self, rest: Array) -> Array:
        """Root mean square of what the equations leave over, 0 where that is rounding. Even fewer
        equations than unknowns contradict one another where some hold nothing unknown."""
        mismatch = np.sqrt((rest**2).mean(axis=1))
        largest = np.abs(self.k).max(axis=1, initial=0.0)
        return np.where(mismatch > _MISMATCH * largest, mismatch, 0.0)

    def _evaluated(self, rows: Rows) -> tuple[Array, Array, Flags]:
        """Value, slopes over the known velocities, and whether it is determined."""
        z, k = rows
        value = np.einsum("nj,nj->n", z, self.z) + np.einsum("nj,nj->n", k, self.k)
        slopes = np.einsum("ni,nij->nj", z, self.slopes) + k
        left_open = np.abs(np.einsum("ni,nij->nj", z, self.open)).max(axis=1)
        determined: Flags = left_open <= _OPEN * np.abs(z).max(axis=1)
        return value, slopes, determined

    def _values(self, wanted: Sequence[str]) -> tuple[dict[str, Array], dict[str, Array], Flags]:
        """Values and slopes by name, and `Found.made_of_something`."""
        values: dict[str, Array] = {}
        slopes: dict[str, Array] = {}
        made = np.ones(self.count, bool)
        for name, rows in self.velocity.items():
            value, slope, determined = self._evaluated(rows)
            scaled = value / self.gyration if name in SPINS else value
            values[name] = np.where(determined, scaled, np.nan)
            slopes[name] = np.where(determined[:, None], slope, np.nan)
        for j, name in enumerate(IMPULSES[: self.impulses]):
            value, _, determined = self._evaluated(self._impulse(j))
            scale = self.reduced_mass * (self.gyration if name == "PM" else 1.0)
            values[name] = np.where(determined, value * scale, np.nan)
        for name in COEFFICIENTS[: self.impulses]:
            if name not in self.given:
                values[name], slopes[name], parts = self._coefficient(name)
                made &= parts | (name not in wanted)
        if self.point:
            values |= self._untouched()
        quantities = (*INITIAL, *FINAL, *COEFFICIENTS)
        values |= {name: self.given[name] for name in quantities if name in self.given}
        kept = {n: v for n, v in values.items() if n in wanted or not np.isnan(v).all()}
        return kept, slopes, made

    def _coefficient(self, name: str) -> tuple[Array, Array, Flags]:
        """A coefficient as a quotient, its slopes times the closing speed, and where numerator and
        denominator are determined (it has no value where the denominator is nothing)."""
        above, below = {
            "E": (self.normal_after, self.normal_before),
            "MUP": (self._impulse(1), self._impulse(0)),
            "EM": (self._relative(2, FINAL), self._impulse(self.impulses - 1)),
        }[name]
        a, da, a_determined = self._evaluated(above)
        b, db, b_determined = self._evaluated(below)
        if name == "E":
            a, da = -a, -da
        if name == "EM":
            b, db = a + b, da + db
        value = a / b
        slope = (da - value[:, None] * db) / b[:, None]
        parts = a_determined & b_determined
        something = np.abs(b) > _NOTHING * np.abs(self.k).max(axis=1, initial=0.0)
        closing = np.hypot(
            self._evaluated(self.normal_before)[0], self._evaluated(self.tangential_before)[0]
        )
        exists = parts & something
        slope = np.where(exists[:, None], slope * closing[:, None], np.nan)
        return np.where(exists, value, np.nan), slope, parts

    def _untouched(self) -> dict[str, Array]:
        """Nothing turns a point mass: no moment, and a spin passes through."""
        values = {"PM": np.zeros(self.count)}
        for pair in (("WA", "WAF"), ("WB", "WBF")):
            spins = [self.given[name] for name in pair if name in self.given]
            if spins:
                values |= dict.fromkeys(pair, spins[0])
        return values


def _times(matrices: Array, vectors: Array) -> Array:
    product: Array = np.einsum("nij,nj->ni", matrices, vectors)
    return product


def _pseudo_inverse(matrix: Array) -> tuple[Array, Array]:
    """The Moore-Penrose inverse of each matrix, and a projector on what it leaves open.

    A matrix with a number that is not finite (masses beyond all bounds) leaves everything open.
    """
    finite = np.asarray(np.isfinite(matrix).all(axis=(1, 2)))
    u, s, vt = np.linalg.svd(np.where(finite[:, None, None], matrix, 0.0), full_matrices=True)
    rank = s.shape[1]
    kept = s > RANK_TOLERANCE * s.max(axis=1, initial=0.0)[:, None]
    inverse = np.where(kept, 1 / s, 0.0)
    v = np.swapaxes(vt, 1, 2)
    pseudo = (v[:, :, :rank] * inverse[:, None, :]) @ np.swapaxes(u[:, :, :rank], 1, 2)
    free = np.ones((len(matrix), v.shape[2]), bool)
    free[:, :rank] = ~kept
    return pseudo, (v * free[:, None, :]) @ vt
