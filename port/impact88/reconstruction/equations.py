"""Equations 13-18 as linear equations in what is unknown of an impact, over arrays.

A `State` obeys Equations 13, 14 and 17 by the way it is written; for a given geometry and given
coefficients its velocities and laws are linear in the impulses, the velocities before the impact of
those components that are known neither before nor after, and the known velocities. Their
coefficients are the values they take at unit vectors. A coefficient that is unknown stands in one
equation alone (e in 15, μ in 16, e_m in 18): that equation is left out and gives the coefficient at
the end.

Rank is decided by singular values; everything is scaled to velocities, impulses by the reduced
mass and spins by the radius of gyration, so that they are pure numbers.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..names import COEFFICIENTS, FINAL_STATE, IMPULSES, PIVOT, VELOCITIES
from .geometry import Geometry
from .state import State

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

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
    """The equations of a block of scenes.

    z: the impulses, then the velocities before the impact of those components of which neither is
    known; k: the known velocities, in the order of ``known``. Rows are n x (z and k).
    """

    def __init__(self, given: Mapping[str, Array], *, point: bool) -> None:
        """``given``: 1-d arrays of one length by name; ``point``: point masses (M = 4), whose spins
        and EM play no part."""
        self.given = given
        self.point = point
        left_out = SPINS if point else ()
        pairs = [pair for pair in zip(INITIAL, FINAL, strict=True) if pair[0] not in left_out]
        self.names = [name for pair in pairs for name in pair]
        self.known = [n for n in (*INITIAL, *FINAL) if n in given and n not in left_out]
        free = [early for early, late in pairs if not {early, late} & {*self.known}]
        self.impulses = IMPULSES[: 2 if point else 3]
        self.unknowns = len(self.impulses) + len(free)
        geometry = Geometry.of(given)
        self.reduced_mass = 1 / geometry.inverse_mass
        self.gyration = np.sqrt(geometry.inverse_mass / geometry.inverse_spin_inertia)
        self.laws = [n for n in COEFFICIENTS[: len(self.impulses)] if n in given]
        self.twice = [(e, late) for e, late in pairs if {e, late} <= {*self.known}]
        columns = (*self.impulses, *free, *self.known)
        units = dict.fromkeys(
            (*INITIAL, *FINAL, *IMPULSES), np.zeros((len(columns), len(given["MA"])))
        )
        for at, name in enumerate(columns):
            units[name] = units[name].copy()
            units[name][at] = self._scale(name)
        from_after = [e for e, late in pairs if e not in self.known and late in self.known]
        self.units = units
        self.state = State({**given, **units}, geometry, from_after)
        # a velocity known after the impact is that, whatever its momentum equation leaves over
        self.followed = self.state.after
        self.state.after = [
            units[late] if late in self.known else after
            for late, after in zip(FINAL, self.followed, strict=True)
        ]

    def _scale(self, name: str) -> Any:
        """What a quantity that is 1 in scaled numbers measures."""
        if name in IMPULSES:
            return self.reduced_mass * (self.gyration if name == "PM" else 1.0)
        return 1 / self.gyration if name in SPINS else 1.0

    def _rows(self, values: Any, scale: Any = 1.0) -> Array:
        """A quantity at the unit vectors as rows: n x (z and k)."""
        return np.ascontiguousarray(np.broadcast_to(values / scale, self.units["UX"].shape).T)

    def _assembled(self) -> Array:
        """The equations, n x rows x (z and k): laws, and momentum of the components known before
        and after. A barrier's holds still, and is nobody's equation."""
        size = len(self.reduced_mass), 0, len(self.units["UX"])
        rows = []
        for early, late in self.twice:
            at = INITIAL.index(early)
            if self.state.changes[at].any() or (self.given[early] != self.given[late]).any():
                left_over = self.followed[at] - self.units[late]
                rows.append(self._rows(left_over, self._scale(early)))
        for name in self.laws:
            scale: Any = {"MUP": self.reduced_mass, "EM": 1 / self.gyration}.get(name, 1.0)
            if name == "MUP" and (self.given["MUP"] == PIVOT).all():
                scale = 1.0
            rows.append(self._rows(self.state.law(name), scale))
        return np.stack(rows, 1) if rows else np.zeros(size)

    # -- the solution

    def solve(self, wanted: Sequence[str]) -> Found:
        """What the equations determine, ``wanted`` above all."""
        whole = self._assembled()
        left, right = whole[:, :, : self.unknowns], -whole[:, :, self.unknowns :]
        over = left.shape[1] > self.unknowns
        scale = np.ones((1, 1, 1))
        if not over:
            # the solution is the same however the equations are scaled; this is best for rounding
            largest = np.abs(left).max(axis=2, initial=0.0)
            scale = np.where(largest > 0, largest, 1.0)[:, :, None]
            left, right = left / scale, right / scale
        inverse, self.open = _pseudo_inverse(left)
        self.slopes = inverse @ right
        self.k = np.empty((len(left), len(self.known)))
        for at, name in enumerate(self.known):
            self.k[:, at] = self.given[name] / self._scale(name)
        self.z = _times(self.slopes, self.k)
        rest = _times(left, self.z) - _times(right, self.k)
        values, slopes, made = self._values(wanted)
        sliding, _, determined = self._evaluated(self._rows(self.state.relative_before[1]))
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
        mismatch = np.sqrt((rest**2).sum(axis=1) / max(rest.shape[1], 1))
        largest = np.abs(self.k).max(axis=1, initial=0.0)
        return np.where(mismatch > _MISMATCH * largest, mismatch, 0.0)

    def _evaluated(self, rows: Array) -> tuple[Array, Array, Flags]:
        """Value, slopes over the known velocities, and whether it is determined."""
        z, k = rows[:, : self.unknowns], rows[:, self.unknowns :]
        value = np.einsum("nj,nj->n", z, self.z) + np.einsum("nj,nj->n", k, self.k)
        slopes = np.einsum("ni,nij->nj", z, self.slopes) + k
        left_open = np.abs(np.einsum("ni,nij->nj", z, self.open)).max(axis=1)
        determined: Flags = left_open <= _OPEN * np.abs(z).max(axis=1)
        return value, slopes, determined

    def _values(self, wanted: Sequence[str]) -> tuple[dict[str, Array], dict[str, Array], Flags]:
        """Values and slopes by name, and `Found.made_of_something`."""
        values: dict[str, Array] = {}
        slopes: dict[str, Array] = {}
        made = np.ones(len(self.k), bool)
        for name in (*self.names, *self.impulses):
            scale = self._scale(name)
            value, slope, determined = self._evaluated(self._rows(self.state[name], scale))
            values[name] = np.where(determined, value * scale, np.nan)
            slopes[name] = np.where(determined[:, None], slope, np.nan)
        for name in COEFFICIENTS[: len(self.impulses)]:
            if name not in self.given:
                values[name], slopes[name], parts = self._coefficient(name)
                made &= parts | (name not in wanted)
        if self.point:  # nothing turns a point mass: no moment, and a spin passes through
            values["PM"] = np.zeros(len(self.k))
            for pair in (("WA", "WAF"), ("WB", "WBF")):
                spins = [self.given[name] for name in pair if name in self.given]
                values |= dict.fromkeys(pair, spins[0]) if spins else {}
        quantities = (*INITIAL, *FINAL, *COEFFICIENTS)
        values |= {n: self.given[n] for n in quantities if n in self.given}
        kept = {n: v for n, v in values.items() if n in wanted or not np.isnan(v).all()}
        return kept, slopes, made

    def _coefficient(self, name: str) -> tuple[Array, Array, Flags]:
        """A coefficient as a quotient, its slopes times the closing speed, and where numerator and
        denominator are determined (it has no value where the denominator is nothing)."""
        state, unit = self.state, {"E": 1.0, "MUP": self.reduced_mass, "EM": 1 / self.gyration}
        above, below = state.quotient(name)
        a, da, a_determined = self._evaluated(self._rows(above, unit[name]))
        b, db, b_determined = self._evaluated(self._rows(below, unit[name]))
        value = a / b
        slope = (da - value[:, None] * db) / b[:, None]
        parts = a_determined & b_determined
        something = np.abs(b) > _NOTHING * np.abs(self.k).max(axis=1, initial=0.0)
        normal, tangential = (self._evaluated(self._rows(v))[0] for v in state.relative_before[:2])
        exists = parts & something
        slope = np.where(exists[:, None], slope * np.hypot(normal, tangential)[:, None], np.nan)
        return np.where(exists, value, np.nan), slope, parts


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
