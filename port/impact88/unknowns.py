"""Equations 13-18 solved for any unknowns: reconstruction and its relatives (chapter, IV-C).

Twelve velocities (six before, six after the impact) and three coefficients stand in six
equations. Whatever is not given is unknown; `solve_for` finds what the equations determine:

- six final velocities (what the 1988 program solves);
- six initial velocities (reconstruction);
- three initial velocities of one vehicle and three final ones of the other;
- three velocities and e, e_m, μ;
- any other solvable set, of six unknowns or fewer. Fewer than six leave equations over: they are
  then fitted by least squares (each equation written as a velocity, spins times the radius
  `gyration`, all with equal weight) and the mismatch is told.

How: the impulses P_n, P_t, M are unknowns too, which makes Equations 13, 14 and 17 six statements
"velocity after = velocity before + impulse over inertia", linear for known coefficients. An unknown
coefficient stands in one equation alone (e in 15, μ in 16, e_m in 18), so that equation is set
aside and gives the coefficient at the end: the set stays linear. Rank and condition come from
a singular value decomposition; a set that is not determined is refused with the reason.

Friction: ``MUP`` is the signed P_t/P_n as printed; ``MU`` is what line 280 would hold, whose sign
line 400 chooses so that friction opposes the sliding. The rule needs the initial velocities; where
they are unknown both signs are tried, and each solution that agrees with its own sign is returned.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import UserError
from .geometry import NAMES as GEOMETRY
from .geometry import Geometry
from .names import RESULTS, SCENE, VELOCITIES

Array = NDArray[np.float64]

INITIAL = VELOCITIES
FINAL = ("VAX", "VAY", "WAF", "VBX", "VBY", "WBF")
"""The final velocities in the order of the initial ones."""
COEFFICIENTS = ("E", "MUP", "EM")
"""The coefficients as they may be asked for: friction as the signed P_t/P_n."""
UNKNOWNS = (*INITIAL, *FINAL, *COEFFICIENTS)

PIVOT = -10.0
RANK_TOLERANCE = 1e-12
"""Singular values below this share of the largest count as zero."""
BADLY_CONDITIONED = 10.0
"""From this amplification on a solution is flagged: an error of the known velocities is found
tenfold, or worse, in some unknown."""
CHUNK = 1 << 14
SPINS = (2, 5)


class UnsolvableError(UserError):
    """The unknowns asked for are not determined; the message is the reason."""


@dataclass(frozen=True)
class Solution:
    """One solution: every quantity it has, by name, in the shape of the given values.

    ``values``: the velocities, E, EM, MUP, MU (to be typed into the listing) and the impulses PN
    PT PM, as far as they are given or determined. ``unknown``: what was solved for.
    ``amplification``: for each of them, the error it takes when every known velocity is in error,
    independently, by one unit (root of the sum of squares; a spin's unit is one unit of velocity
    over ``gyration``; a coefficient's error is multiplied by the closing speed, so that it is
    a pure number like the others). ``agrees``: whether the sign of MUP is the one line 400 gives.
    ``mismatch``: for unknowns fewer than the equations, the equations' root-mean-square mismatch,
    a velocity; 0 otherwise.
    """

    values: dict[str, Array]
    unknown: tuple[str, ...]
    amplification: dict[str, Array]
    agrees: NDArray[np.bool_]
    mismatch: Array
    gyration: Array

    def __getitem__(self, name: str) -> Array:
        return self.values[name]

    @property
    def found(self) -> NDArray[np.bool_]:
        """Where all unknowns have a value."""
        return np.all([np.isfinite(self.values[n]) for n in self.unknown], axis=0)

    @property
    def worst(self) -> Array:
        """The largest amplification of any unknown."""
        zero = np.zeros(np.shape(self.agrees))
        return np.max([zero, *self.amplification.values()], axis=0)

    @property
    def badly_conditioned(self) -> NDArray[np.bool_]:
        """Whether some unknown's amplification reaches `BADLY_CONDITIONED`."""
        return ~(self.worst < BADLY_CONDITIONED)

    @property
    def contradictory(self) -> NDArray[np.bool_]:
        """Whether the known values contradict one another beyond rounding."""
        speeds = [np.abs(self.values[n]) for n in (*INITIAL, *FINAL) if n in self.values]
        return self.mismatch > 1e-9 * np.max(speeds, axis=0)


def solve_for(known: Mapping[str, Any], unknown: Iterable[str] | None = None) -> list[Solution]:
    """Solve Equations 13-18 for what ``known`` leaves out.

    ``known``: numbers or arrays that broadcast, by name: the vehicles and their geometry (DA DB GA
    PA PB TA TB MA MB IA IB; M, 6 where left out, 4 for point masses; MB and IB may be infinite),
    and whichever are known of the velocities before (UX UY WA VX VY WB) and after (VAX VAY WAF VBX
    VBY WBF) and the coefficients E, EM, and MUP or MU (-10: pivot). ``unknown``: the quantities
    wanted; by default all that is left out. Ask for fewer to get those that are determined though
    the rest is not (Section VII finds UX and VY from Equations 13 and 14, no coefficient known).

    Returns one `Solution`, or two where MU is known in size only and both signs agree with the
    sliding they lead to. For single scenes only agreeing solutions are returned; for arrays,
    solutions that agree anywhere, with their mask. An element of an array that is not determined
    is NaN; a single scene, or an array without any determined element, raises `UnsolvableError`
    with the reason. Raises UserError for names or numbers that cannot be used.
    """
    problem = _Problem.of(known, unknown)
    solutions = [problem.solved(mu) for mu in problem.signed_friction()]
    if problem.shape == ():
        kept = [s for s in solutions if s.agrees]
    else:
        kept = [s for s in solutions if s.agrees.any()]
    if not kept:
        if any(s.found.any() for s in solutions):
            raise UnsolvableError(
                "neither sign of MU agrees with the sliding it leads to (line 400): no friction "
                "that opposes the sliding joins these velocities"
            )
        raise UnsolvableError(problem.reason())
    return kept


def generically_solvable(unknown: Sequence[str], *, seed: int = 1988) -> bool:
    """Whether Equations 13-18 determine ``unknown`` for almost every scene: the rank of a random
    scene's equations. All of the names must be among `UNKNOWNS`, the rest counts as known.

    A set that passes can still be undetermined for special values (e = 0, e_m = 0, the pivot).
    """
    problem = _Problem.of(_random_scene(unknown, seed), unknown)
    return problem.finds(problem.solved(problem.mu))


def solvable_sets() -> list[tuple[str, ...]]:
    """The sets of six of the twelve velocities that are generically solvable."""
    return [s for s in combinations((*INITIAL, *FINAL), 6) if generically_solvable(s)]


def _random_scene(unknown: Sequence[str], seed: int) -> dict[str, float]:
    rng = np.random.default_rng(seed)
    scene = {n: rng.uniform(0.5, 2.0) for n in ("DA", "DB", "MA", "MB", "IA", "IB")}
    scene |= {n: rng.uniform(-90.0, 90.0) for n in ("GA", "PA", "PB", "TA", "TB")}
    scene |= {"E": 0.37, "EM": -0.61, "MUP": 0.43}
    scene |= {n: rng.uniform(-2.0, 2.0) for n in (*INITIAL, *FINAL)}
    return {name: value for name, value in scene.items() if name not in unknown}


@dataclass(frozen=True)
class _Problem:
    """What is known and wanted, checked; every number an array of one ``shape``."""

    known: dict[str, Array]
    wanted: tuple[str, ...]
    shape: tuple[int, ...]
    point: bool
    mu: Array | None
    sign_open: bool

    @classmethod
    def of(cls, known: Mapping[str, Any], unknown: Iterable[str] | None) -> _Problem:
        given = _numbers(known)
        point = _is_point_mass(given)
        names = [n for n in UNKNOWNS if not (point and n in ("WA", "WB", "WAF", "WBF", "EM"))]
        left_out = [n for n in names if n not in given and not (n == "MUP" and "MU" in given)]
        wanted = tuple(left_out if unknown is None else dict.fromkeys(unknown))
        for name in wanted:
            if name not in names:
                raise UserError(f"{name!r} is no unknown; expected some of {' '.join(names)}")
            if name not in left_out:
                raise UserError(f"{name} is both known and wanted; leave it out of one")
        if not wanted:
            raise UserError("nothing is unknown; leave out the values to solve for")
        shape = np.broadcast_shapes(*(value.shape for value in given.values()))
        given = {name: np.broadcast_to(value, shape) for name, value in given.items()}
        _check_physical(given)
        mu = given.get("MUP", given.get("MU"))
        sign_open = "MU" in given
        if mu is not None and ((mu == PIVOT) != (mu.flat[0] == PIVOT)).any():
            raise UserError("MU is a pivot's -10 in some scenes only; solve pivots apart")
        return cls(given, wanted, shape, point, mu, sign_open)

    def signed_friction(self) -> list[Array | None]:
        """The values of MUP to try: one, or both signs of MU where line 400 cannot be applied."""
        if self.mu is None or not self.sign_open or self._is_pivot or not self.mu.any():
            return [self.mu]
        if all(name in self.known for name in INITIAL if name not in self._dropped):
            flip = self._relative([self.known.get(n, 0.0) for n in INITIAL])[1] > 0
            return [np.where(flip, -self.mu, self.mu)]
        return [self.mu, -self.mu]

    @property
    def _is_pivot(self) -> bool:
        return self.mu is not None and bool(self.mu.size) and bool(self.mu.flat[0] == PIVOT)

    @property
    def _dropped(self) -> tuple[str, ...]:
        return ("WA", "WB") if self.point else ()

    def _relative(self, velocities: Sequence[Any]) -> tuple[Array, Array, Array]:
        return Geometry.of(self.known).relative(velocities)

    def solved(self, mu: Array | None) -> Solution:
        """The solution for a signed friction coefficient; NaN where it is not determined."""
        count = int(np.prod(self.shape))
        flat = {name: value.reshape(count) for name, value in self.known.items()}
        if mu is not None:
            flat["MUP"] = np.broadcast_to(mu, self.shape).reshape(count)
        parts = [
            _solve_block({n: v[first : first + CHUNK] for n, v in flat.items()}, self)
            for first in range(0, max(count, 1), CHUNK)
        ]
        values, amplification, extra = (
            {
                name: np.concatenate([p[i][name] for p in parts]).reshape(self.shape)
                for name in group
            }
            for i, group in enumerate(parts[0])
        )
        return Solution(
            values=values,
            unknown=self.wanted,
            amplification=amplification,
            agrees=extra["agrees"].astype(bool),
            mismatch=extra["mismatch"],
            gyration=extra["gyration"],
        )

    def determined(self, **changes: float) -> bool:
        """Whether the first scene is determined, with some of its values changed."""
        given = {n: v.reshape(-1)[:1] for n, v in self.known.items()} | {
            n: np.array([v]) for n, v in changes.items()
        }
        given.pop("MU", None)
        if self.mu is not None:
            given.setdefault("MUP", self.mu.reshape(-1)[:1])
        problem = _Problem.of(given, self.wanted)
        return problem.finds(problem.solved(given.get("MUP")))

    def finds(self, solution: Solution) -> bool:
        """Whether a solution has a value for all that is wanted, in every scene."""
        return all(bool(np.isfinite(solution.values[n]).all()) for n in self.wanted)

    # -- why a set is refused

    def reason(self) -> str:
        """One line saying why the wanted unknowns are not determined."""
        equations = 4 if self.point else 6
        absent = [
            name
            for name in UNKNOWNS
            if name not in self.known
            and not (name == "MUP" and self.mu is not None)
            and not (self.point and name in ("WA", "WB", "WAF", "WBF", "EM"))
        ]
        if blame := self._coefficient_to_blame():
            return blame
        if zero := self._zero_over_zero():
            return zero
        alone = [n for n in absent if self._alone(n)]
        hint = f"; {' '.join(alone)} could be found alone" if alone else ""
        if len(absent) > equations:
            few = "four" if self.point else "six"
            return (
                f"{len(absent)} quantities are unknown ({' '.join(absent)}) and the {few} "
                f"equations do not determine {' '.join(self.wanted)}{hint}; give at least "
                f"{len(absent) - equations} more"
            )
        for vehicle, names in (("A", "UX UY WA VAX VAY WAF"), ("B", "VX VY WB VBX VBY WBF")):
            if set(names.split()) - set(self._spins_if_point()) <= set(absent):
                return (
                    f"all velocities of {vehicle} are unknown: the equations contain the known "
                    "vehicle's impulse, which leaves Equation 16 nothing to determine and the "
                    f"common part of {vehicle}'s velocities open{hint}"
                )
        return (
            f"the equations do not determine {' '.join(self.wanted)} together: among them some "
            f"are left open while other equations hold nothing unknown{hint}"
        )

    def _spins_if_point(self) -> tuple[str, ...]:
        return ("WA", "WB", "WAF", "WBF") if self.point else ()

    def _alone(self, name: str) -> bool:
        given = {n: v.reshape(-1)[:1] for n, v in self.known.items()}
        problem = _Problem.of(given, [name])
        mu = None if self.mu is None else self.mu.reshape(-1)[:1]
        return problem.finds(problem.solved(mu))

    def _coefficient_to_blame(self) -> str | None:
        """The coefficient whose value makes the set undetermined, found by changing it."""
        usual = {"E": 0.37, "EM": -0.61, "MUP": 0.43}
        given: dict[str, float] = {n: self.known[n].flat[0] for n in ("E", "EM") if n in self.known}
        if self.mu is not None:
            given["MUP"] = self.mu.flat[0]
        for size in range(1, len(given) + 1):
            for names in combinations(given, size):
                if self.determined(**{n: usual[n] for n in names}):
                    return "; and ".join(_blame(n, float(given[n])) for n in names)
        return None

    def _zero_over_zero(self) -> str | None:
        """A wanted coefficient that comes out as nothing over nothing."""
        others = [n for n in self.wanted if n not in COEFFICIENTS]
        if len(others) == len(self.wanted) or (others and not all(map(self._alone, others))):
            return None
        texts = {
            "E": "the contact points do not approach (gn = 0), so E (Equation 15) has no value",
            "MUP": "there is no normal impulse (Pn = 0), so MU (Equation 16) has no value",
            "EM": "the spins neither differ after the impact nor is there a moment impulse, so EM "
            "(Equation 18) has no value",
        }
        bad = [n for n in self.wanted if n in COEFFICIENTS and not self._alone(n)]
        return "; and ".join(texts[n] for n in bad if self._velocities_determined(n)) or None

    def _velocities_determined(self, coefficient: str) -> bool:
        """Whether what the coefficient is made of is determined: then its value is 0/0."""
        given = {n: v.reshape(-1)[:1] for n, v in self.known.items()}
        problem = _Problem.of(given, [coefficient])
        flat = dict(given)
        if self.mu is not None:
            flat["MUP"] = self.mu.reshape(-1)[:1]
        return bool(_solve_block(flat, problem)[2]["base_determined"].all())


def _blame(name: str, value: float) -> str:
    if name == "E" and value == 0:
        return (
            "E = 0: Equation 15 then only says that the contact points stay together, so final "
            "velocities do not tell how fast they approached"
        )
    if name == "EM" and value == 0:
        return (
            "EM = 0: Equation 18 then only says that the final spins are equal, so nothing tells "
            "the moment impulse"
        )
    if name == "MUP" and value == PIVOT:
        return (
            "MU = -10 (pivot): its condition holds for final velocities only, so nothing tells "
            "the tangential impulse"
        )
    label = "MU (signed)" if name == "MUP" else name
    return f"{label} = {value:.6g}: at this very value the unknowns cannot be told apart"


def _numbers(known: Mapping[str, Any]) -> dict[str, Array]:
    allowed = {*GEOMETRY, "M", *INITIAL, *FINAL, "E", "EM", "MU", "MUP"}
    given = {}
    for name, value in known.items():
        if name not in allowed:
            hint = f"; did you mean {name.upper()}?" if name.upper() in allowed else ""
            raise UserError(
                f"{name!r} is no value of an impact{hint} "
                f"(expected {' '.join(n for n in (*SCENE, *RESULTS) if n in allowed)})"
            )
        try:
            given[name] = np.asarray(value, np.float64)
        except (TypeError, ValueError):
            raise UserError(f"{name} = {value!r} is no number") from None
    missing = [name for name in GEOMETRY if name not in given]
    if _is_point_mass(given):
        missing = [name for name in missing if name in ("GA", "MA", "MB")]
        given = {n: np.zeros(()) for n in GEOMETRY} | {"IA": np.ones(()), "IB": np.ones(())} | given
    if missing:
        wanted = "; ".join(f"{name} ({SCENE[name].meaning})" for name in missing)
        raise UserError(f"missing {wanted}: the vehicles and their geometry must be known")
    if "MU" in given and "MUP" in given:
        raise UserError("MU and MUP are both given; give MUP (signed Pt/Pn) or MU, not both")
    return given


def _is_point_mass(given: Mapping[str, Array]) -> bool:
    m = given.get("M", np.asarray(6.0))
    if not ((m == 6).all() or (m == 4).all()):
        raise UserError("M must be 6, or 4 for point masses, the same in all scenes")
    return bool(m.size) and bool((m == 4).all())


def _check_physical(given: Mapping[str, Array]) -> None:
    for name, value in given.items():
        infinite_allowed = name in ("MA", "MB", "IA", "IB")
        if np.isnan(value).any() or (np.isinf(value).any() and not infinite_allowed):
            raise UserError(f"{name} is not finite; expected {_meaning(name)}")
        if infinite_allowed and not (value > 0).all():
            raise UserError(f"{name} is not positive; expected {_meaning(name)}")


def _meaning(name: str) -> str:
    quantity = SCENE.get(name) or RESULTS[name]
    return f"{quantity.meaning} [{quantity.unit}]"


# -- the equations


def _solve_block(
    given: Mapping[str, Array], problem: _Problem
) -> tuple[dict[str, Array], dict[str, Array], dict[str, Array]]:
    """Values, amplifications, and (agrees, mismatch, gyration, base_determined) of a block."""
    with np.errstate(all="ignore"):
        return _Equations(given, problem).solve()


class _Equations:
    """The linear equations of a block of scenes (first axis), A·z = B·k.

    z: the impulses P_n, P_t, M, then the initial velocities of those pairs (before, after) of
    which both are unknown. k: the known velocities. Any velocity is ``rows_z``·z + ``rows_k``·k.
    Everything is scaled to velocities: impulses by the reduced mass, spins by the radius of
    gyration, so that singular values and amplifications are pure numbers.
    """

    def __init__(self, given: Mapping[str, Array], problem: _Problem) -> None:
        self.given, self.problem = given, problem
        self.geometry = here = Geometry.of(given)
        self.count = len(given["MA"])
        self.reduced_mass = 1 / here.inverse_mass
        self.gyration = np.sqrt(here.inverse_mass / here.inverse_spin_inertia)
        used = [i for i in range(6) if not (problem.point and i in SPINS)]
        self.impulses = 2 if problem.point else 3
        self.known = [n for n in (*INITIAL, *FINAL) if n in given and self._used(n, used)]
        free = [i for i in used if INITIAL[i] not in given and FINAL[i] not in given]
        self.unknowns = self.impulses + len(free)
        self.rows_z: dict[str, Array] = {}
        self.rows_k: dict[str, Array] = {}
        jacobian = self._jacobian()
        self.both: list[int] = []
        for i in used:
            self._velocity_pair(i, free, jacobian[:, i])
        self.jacobian = jacobian

    @staticmethod
    def _used(name: str, used: Sequence[int]) -> bool:
        names = INITIAL if name in INITIAL else FINAL
        return names.index(name) in used

    def _jacobian(self) -> Array:
        """Velocity changes per scaled impulse component: (count, 6, impulses)."""
        directions, inverses = self.geometry.directions(), self.geometry.inverses()
        jacobian = np.zeros((self.count, 6, self.impulses))
        for i in range(6):
            for j in range(self.impulses):
                jacobian[:, i, j] = directions[j][i] * inverses[i] * self.reduced_mass
        for i in SPINS:
            jacobian[:, i, :] *= self.gyration[:, None]
        if self.impulses == 3:
            jacobian[:, :, 2] *= self.gyration[:, None]
        return jacobian

    def _velocity_pair(self, i: int, free: Sequence[int], changes: Array) -> None:
        """How the velocities before and after of one component depend on z and k."""
        before, after = INITIAL[i], FINAL[i]
        z = np.zeros((2, self.count, self.unknowns))
        k = np.zeros((2, self.count, len(self.known)))
        if before in self.known:
            k[0, :, self.known.index(before)] = 1.0
        if after in self.known:
            k[1, :, self.known.index(after)] = 1.0
        if before in self.known and after in self.known:
            self.both.append(i)
        elif before in self.known:
            k[1] = k[0]
            z[1, :, : self.impulses] = changes
        elif after in self.known:
            k[0] = k[1]
            z[0, :, : self.impulses] = -changes
        else:
            z[:, :, self.impulses + free.index(i)] = 1.0
            z[1, :, : self.impulses] += changes
        self.rows_z[before], self.rows_z[after] = z
        self.rows_k[before], self.rows_k[after] = k

    def _relative(self, direction: int, names: Sequence[str]) -> tuple[Array, Array]:
        """A relative velocity at the contact point as rows over z and k, scaled to a velocity."""
        z = np.zeros((self.count, self.unknowns))
        k = np.zeros((self.count, len(self.known)))
        for i, weight in enumerate(self.geometry.directions()[direction]):
            if names[i] not in self.rows_z:
                continue
            scaled = weight / self.gyration if i in SPINS else weight
            factor = np.broadcast_to(scaled, (self.count,))[:, None]
            z += factor * self.rows_z[names[i]]
            k += factor * self.rows_k[names[i]]
        if direction == 2:
            z, k = z * self.gyration[:, None], k * self.gyration[:, None]
        return z, k

    def _impulse_row(self, j: int) -> Array:
        row = np.zeros((self.count, self.unknowns))
        row[:, j] = 1.0
        return row

    def _assemble(self) -> tuple[Array, Array]:
        """A and B: Equations 15, 16 and 18 as far as their coefficient is known, then Equations 13,
        14 and 17 for the velocities of which both values are known."""
        given = self.given
        nothing = np.zeros((self.count, len(self.known)))
        rows: list[tuple[Array, Array]] = []
        if "E" in given:
            e = given["E"][:, None]
            (z0, k0), (z1, k1) = self.normal_before, self.normal_after
            rows.append((z1 + e * z0, -k1 - e * k0))
        if "MUP" in given:
            mu = given["MUP"][:, None]
            if self.problem._is_pivot:
                z1, k1 = self._relative(1, FINAL)
                rows.append((z1, -k1))
            else:
                rows.append((self._impulse_row(1) - mu * self._impulse_row(0), nothing))
        if "EM" in given and self.impulses == 3:
            em = given["EM"][:, None]
            z1, k1 = self.spin_after
            rows.append(((1 - em) * z1 - em * self.moment, -(1 - em) * k1))
        for i in self.both:
            if not self.jacobian[:, i].any() and (given[INITIAL[i]] == given[FINAL[i]]).all():
                continue  # a barrier: it holds still, and its momentum is nobody's equation
            z = np.zeros((self.count, self.unknowns))
            z[:, : self.impulses] = self.jacobian[:, i]
            rows.append((z, self.rows_k[FINAL[i]] - self.rows_k[INITIAL[i]]))
        if not rows:
            empty = np.zeros((self.count, 1, self.unknowns))
            return empty, np.zeros((self.count, 1, len(self.known)))
        return np.stack([z for z, _ in rows], 1), np.stack([k for _, k in rows], 1)

    def solve(self) -> tuple[dict[str, Array], dict[str, Array], dict[str, Array]]:
        self.normal_before = self._relative(0, INITIAL)
        self.normal_after = self._relative(0, FINAL)
        if self.impulses == 3:
            self.spin_after = self._relative(2, FINAL)
            # M over the reduced inertia, as a velocity: (1/Ia + 1/Ib)·gyration = 1/(mass·gyration)
            self.moment = self._impulse_row(2)
        left, right = self._assemble()
        if left.shape[1] <= self.unknowns:
            # square sets have one solution however the equations are scaled; best for rounding
            largest = np.abs(left).max(axis=2, initial=0.0)
            scale = np.where(largest > 0, largest, 1.0)[:, :, None]
            left, right = left / scale, right / scale
        self.inverse, self.open = _pseudo_inverse(left)
        self.slopes = self.inverse @ right
        self.k = (
            np.stack(
                [self.given[n] * (self.gyration if _is_spin(n) else 1.0) for n in self.known], 1
            )
            if self.known
            else np.zeros((self.count, 0))
        )
        self.z = np.einsum("nij,nj->ni", self.slopes, self.k)
        over = left.shape[1] > self.unknowns
        rest = np.einsum("nij,nj->ni", left, self.z) - np.einsum("nij,nj->ni", right, self.k)
        mismatch = np.sqrt((rest**2).mean(axis=1)) if over else np.zeros(self.count)
        return self._results(mismatch)

    def _quantity(self, rows: tuple[Array, Array]) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Value, slopes over the known velocities, and whether it is determined."""
        z, k = rows
        value = np.einsum("nj,nj->n", z, self.z) + np.einsum("nj,nj->n", k, self.k)
        slopes = np.einsum("ni,nij->nj", z, self.slopes) + k
        left_open = np.einsum("ni,nij->nj", z, self.open)
        size = np.abs(z).max(axis=1, initial=0.0) if z.shape[1] else np.zeros(self.count)
        determined = ~(np.abs(left_open).max(axis=1, initial=0.0) > 1e-9 * size)
        return value, slopes, determined

    def _results(
        self, mismatch: Array
    ) -> tuple[dict[str, Array], dict[str, Array], dict[str, Array]]:
        given, wanted = self.given, self.problem.wanted
        values: dict[str, Array] = {}
        slopes: dict[str, Array] = {}
        base = np.ones(self.count, bool)
        for name in self.rows_z:
            value, slope, determined = self._quantity((self.rows_z[name], self.rows_k[name]))
            scale = 1 / self.gyration if _is_spin(name) else np.ones(self.count)
            if name in given:
                values[name] = given[name]
            elif name in wanted or determined.any():
                values[name] = np.where(determined, value * scale, np.nan)
                slopes[name] = np.where(determined[:, None], slope, np.nan)
        for j, name in enumerate(("PN", "PT", "PM")[: self.impulses]):
            value, _, determined = self._quantity(
                (self._impulse_row(j), np.zeros((self.count, len(self.known))))
            )
            scale = self.reduced_mass * (self.gyration if name == "PM" else 1.0)
            values[name] = np.where(determined, value * scale, np.nan)
        if self.problem.point:
            values["PM"] = np.zeros(self.count)
            for before, after in (("WA", "WAF"), ("WB", "WBF")):
                # nothing turns a point mass: a spin passes through
                for name, other in ((before, after), (after, before)):
                    if name in given or other in given:
                        values[name] = given.get(name, given.get(other))
        nothing = np.zeros((self.count, len(self.known)))
        approach = self._quantity(self.normal_before)
        sliding = self._quantity(self._relative(1, INITIAL))
        closing = np.hypot(approach[0], sliding[0])
        quotients = {
            "E": (self.normal_after, self.normal_before, -1.0, False),
            "MUP": ((self._impulse_row(1), nothing), (self._impulse_row(0), nothing), 1.0, False),
        }
        if self.impulses == 3:
            quotients["EM"] = (self.spin_after, (self.moment, nothing), 1.0, True)
        for name, (above, below, sign, add) in quotients.items():
            if name in given:
                values[name] = given[name]
                continue
            a, da, known_a = self._quantity(above)
            b, db, known_b = self._quantity(below)
            if add:
                b, db = a + b, da + db
            value = sign * a / b
            slope = (sign * da - value[:, None] * db) / b[:, None]
            speed = np.abs(self.k).max(axis=1, initial=0.0)
            determined = known_a & known_b
            if name in wanted:
                base &= determined
            determined = determined & (np.abs(b) > 1e-12 * speed)
            if name in wanted or determined.any():
                values[name] = np.where(determined, value, np.nan)
                slopes[name] = np.where(determined[:, None], slope * closing[:, None], np.nan)
        agrees = np.ones(self.count, bool)
        if "MUP" in values:
            mu, flipped = values["MUP"], sliding[0] > 0
            open_sign = ~sliding[2] | (mu == PIVOT) | (mu == 0)
            values["MU"] = np.where(open_sign | ~flipped, mu, -mu)
            if self.problem.sign_open and "MU" in given:
                agrees = open_sign | (values["MU"] == given["MU"])
        found = np.all([np.isfinite(values[n]) for n in wanted], axis=0)
        amplification = {n: np.sqrt((slopes[n] ** 2).sum(axis=1)) for n in wanted}
        values = {
            n: v for n, v in values.items() if n in given or n in wanted or ~np.isnan(v).all()
        }
        extra = {
            "agrees": agrees & found,
            "mismatch": mismatch,
            "gyration": self.gyration,
            "base_determined": base,
        }
        return values, amplification, extra


def _is_spin(name: str) -> bool:
    return name in ("WA", "WB", "WAF", "WBF")


def _pseudo_inverse(matrix: Array) -> tuple[Array, Array]:
    """The Moore-Penrose inverse of each matrix, and a projector on what it leaves open."""
    u, s, vt = np.linalg.svd(matrix, full_matrices=True)
    rank = s.shape[1]
    kept = s > RANK_TOLERANCE * s.max(axis=1, initial=0.0)[:, None]
    inverse = np.where(kept, 1 / s, 0.0)
    v = np.swapaxes(vt, 1, 2)
    pseudo = (v[:, :, :rank] * inverse[:, None, :]) @ np.swapaxes(u[:, :, :rank], 1, 2)
    free = np.ones((len(matrix), v.shape[2]), bool)
    free[:, :rank] = ~kept
    return pseudo, (v * free[:, None, :]) @ vt
