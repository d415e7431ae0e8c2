"""Equations 13-18 solved for any unknowns: reconstruction and its relatives (chapter, IV-C).

Twelve velocities (six before, six after the impact) and three coefficients stand in six equations.
Whatever is not given is unknown: six final velocities (what the 1988 program solves), six initial
ones, three velocities and e, e_m, μ, or any other set. A coefficient that is unknown stands in one
equation alone (e in 15, μ in 16, e_m in 18), which gives it at the end; the others are linear
(`system.System`), so that one step of Newton's solves them. Equations left over are fitted by least
squares and the mismatch is given. Singular values decide; a set that is not determined is refused
with the reason.

Friction: ``MUP`` is the signed P_t/P_n as printed; ``MU`` is what line 280 would hold, whose sign
line 400 chooses so that friction opposes the sliding. Where the initial velocities are unknown both
signs are tried, and each solution that agrees with its own sign is returned.
"""

from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from functools import reduce
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..collision.geometry import GEOMETRY, with_point_masses, within_doubles
from ..collision.mappings import columns
from ..collision.uncertain import fixed_value
from ..errors import UserError
from ..mechanics.closedform.solve import solve
from ..mechanics.state import State
from ..messages.arguments import explains_arguments
from ..names import (
    COEFFICIENTS,
    FINAL_STATE,
    IMPULSES,
    PIVOT,
    RESULTS,
    SCENE,
    VELOCITIES,
    check_names,
    missing,
    quantity,
)
from .system import COMPLEX_STEP, SPINS, System

Array = NDArray[np.float64]

UNKNOWNS = (*VELOCITIES, *FINAL_STATE, *COEFFICIENTS)

BADLY_CONDITIONED = 10.0
"""From this amplification on a solution is flagged: an error of the known velocities is found
tenfold, or worse, in some unknown."""
ORDINARY = {"E": 0.37, "EM": -0.61, "MUP": 0.43}
"""Coefficients at which nothing special happens."""
CHUNK = 1 << 12
"""Scenes solved at a time: bounds the memory."""
# of these twice or a hundredth as much changes none of 260 problems
TIE = 1e-14
"""Sliding below this share of the largest speed is rounding, and counts as line 400's tie."""
_NOTHING, _OPEN = 1e-12, 1e-9
"""Smaller shares of the largest are rounding: of singular values and denominators of coefficients;
of what is left open in a quantity, and equations' mismatch."""


def _disagreement(values: Mapping[str, Any]) -> str:
    """Return by how much values of which nothing is unknown miss a law, "" where they miss none."""
    from .laws import describe_laws, missed_laws

    if any(np.ndim(value) for value in values.values()):
        return ""
    laws = describe_laws(missed_laws({n: float(v) for n, v in values.items()}))
    return f", and the values contradict one another: {laws}" if laws else ""


class UnsolvableError(UserError):
    """The unknowns asked for are not determined; the message is the reason."""


@dataclass(frozen=True)
class Solution:
    """One solution: every quantity it has, by name, in the shape of the given values.

    Parameters
    ----------
    values : dict of str to ndarray
        Velocities, E, EM, MUP, MU (to be typed into the listing), PN, PT, PM, as far as they are
        determined.
    unknown : tuple of str
        The quantities solved for.
    amplification : dict of str to ndarray
        The error of each unknown when every known velocity errs, independently, by one unit (a
        spin's unit is one of velocity over ``gyration``, a coefficient's error is multiplied by the
        closing speed).
    agrees : ndarray of bool
        True where the sign of MUP is the one line 400 gives.
    mismatch : ndarray
        Root mean square of the residuals of the equations, a velocity.
    gyration : ndarray
        The radius of gyration that makes spins of velocities.

    Examples
    --------
    >>> solution, *others = impact88.solve_for({**impact88.sample(1)})
    >>> float(solution.values["VAX"].round(3))
    -13.263
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
        """Mask of the scenes in which all unknowns have a value."""
        return np.asarray(np.all([np.isfinite(self.values[n]) for n in self.unknown], axis=0))

    @property
    def worst(self) -> Array:
        """Largest amplification of any unknown."""
        return np.asarray(np.max([*self.amplification.values()], axis=0))

    @property
    def badly_conditioned(self) -> NDArray[np.bool_]:
        """Mask of the scenes in which some amplification reaches `BADLY_CONDITIONED`."""
        return ~(self.worst < BADLY_CONDITIONED)

    @property
    def contradictory(self) -> NDArray[np.bool_]:
        """Mask of the scenes whose known values contradict one another beyond rounding."""
        speeds = [np.abs(self.values[n]) for n in (*VELOCITIES, *FINAL_STATE) if n in self.values]
        return np.asarray(self.mismatch > _OPEN * np.max(speeds, axis=0))


@within_doubles
@explains_arguments
def solve_for(known: Mapping[str, Any], unknown: Iterable[str] | None = None) -> list[Solution]:
    """Solve Equations 13-18 for the quantities that ``known`` leaves out.

    Parameters
    ----------
    known : mapping of str to float or array_like
        The vehicles and their geometry (M is 6 where left out, 4 for point masses; MB and IB may be
        infinite), velocities before (UX ... WB) and after (VAX ... WBF), coefficients E, EM, and
        MUP or MU (-10: pivot), by name. They broadcast.
    unknown : iterable of str, optional
        The quantities wanted, by default all that is left out; fewer may be determined though the
        rest is not (Section VII finds UX and VY from Equations 13 and 14, no coefficient known).

    Returns
    -------
    list of Solution
        One, or two where MU is known in size only and both signs agree with the sliding they lead
        to: of single scenes those that agree, least-squares fits of contradictory values only where
        nothing else is; of arrays those that agree anywhere. An element that is not determined is
        NaN.

    Raises
    ------
    UnsolvableError
        With the reason, where no element is determined.
    UserError
        For names or numbers that cannot be used.

    Notes
    -----
    Equations 13 to 18.

    Examples
    --------
    >>> known = {**impact88.sample(1)}
    >>> after = impact88.solve(known, impact88.names.FINAL_VELOCITIES)
    >>> for name in impact88.names.VELOCITIES:
    ...     del known[name]
    >>> solution, *others = impact88.solve_for({**known, **after})
    >>> float(solution.values["UX"].round(2))
    -29.04
    """
    problem = _Problem(known, unknown)
    solutions = problem.solutions()
    if problem.shape == ():
        kept = [s for s in solutions if s.agrees]
        kept = [s for s in kept if not s.contradictory] or kept
    else:
        kept = [s for s in solutions if s.agrees.any()]
    if kept or 0 in problem.shape:
        return kept
    if any(s.found.any() for s in solutions):
        raise UnsolvableError(
            "neither sign of MU agrees with the sliding it leads to (line 400): no friction "
            "that opposes the sliding joins these velocities"
        )
    raise UnsolvableError(problem.reason())


class _Problem:
    """What is known and wanted, checked; every number an array of one ``shape``; ``names``: what
    can be unknown; ``absent``: what is."""

    def __init__(self, known: Mapping[str, Any], unknown: Iterable[str] | None) -> None:
        allowed = {*GEOMETRY, "M", *VELOCITIES, *FINAL_STATE, "E", "EM", "MU", "MUP"}
        values = columns(known)
        check_names(values, [n for n in (*SCENE, *RESULTS) if n in allowed], "value of an impact")
        given = {n: np.asarray(v, np.float64) for n, v in with_point_masses(values).items()}
        check_physical(given)
        m = given.get("M", np.asarray(6.0))
        self.point = point = bool(m.size) and bool((m == 4).all())
        self.names = tuple(n for n in UNKNOWNS if not (point and n in (*SPINS, "EM")))
        settled = {*given} | ({"MUP"} if "MU" in given else set())
        self.absent = tuple(name for name in self.names if name not in settled)
        self.wanted = self.absent if unknown is None else tuple(dict.fromkeys(unknown))
        check_names(self.wanted, self.names, "quantity that may be unknown")
        for name in self.wanted:
            if name not in self.absent:
                raise UserError(f"{name} is both known and wanted; leave it out of one")
        if not self.wanted:
            raise UserError(
                f"nothing is unknown{_disagreement(given)}; leave out values to solve for"
            )
        try:
            self.shape = np.broadcast_shapes(*(value.shape for value in given.values()))
        except ValueError:
            shapes = ", ".join(f"{name} {v.shape}" for name, v in given.items() if v.ndim)
            raise UserError(f"the arrays do not broadcast together: {shapes}") from None
        self.known = {name: np.broadcast_to(v, self.shape) for name, v in given.items()}

    @property
    def friction(self) -> Array | None:
        """MUP, or MU with its sign still open."""
        return self.known.get("MUP", self.known.get("MU"))

    def solutions(self) -> list[Solution]:
        """One solution, or one for each sign of MU where line 400 needs what is unknown."""
        if "MU" not in self.known:
            return [self._solved(self.friction)]
        mu = self.known["MU"]
        if (mu == PIVOT).any() or not mu.any():
            return [self._solved(mu)]
        if all(name in self.known for name in VELOCITIES if not (self.point and name in SPINS)):
            # solve's own line 400; what else a scene has does not matter to it
            scene = {"WA": 0.0, "WB": 0.0, "E": 0.0, "EM": 0.0, **self.known}
            signed = solve({name: scene[name] for name in SCENE if name in scene}, ("MUP",))
            return [self._solved(np.where(signed["MUP"] == mu, mu, -mu))]
        return [self._solved(mu, must_agree=True), self._solved(-mu, must_agree=True)]

    def _solved(self, mu: Array | None, must_agree: bool = False) -> Solution:
        """The solution for a signed friction coefficient."""
        count = int(np.prod(self.shape))
        flat = {name: value.reshape(count) for name, value in self.known.items()}
        if mu is not None:
            flat["MUP"] = np.broadcast_to(mu, self.shape).reshape(count)
        parts = [
            _determined({n: v[at : at + CHUNK] for n, v in flat.items()}, self.wanted, self.point)
            for at in range(0, max(count, 1), CHUNK)
        ]

        def whole(name: str) -> Array:
            return np.concatenate([part[name] for part in parts]).reshape(self.shape)

        values = {name: whole(name) for name in (*UNKNOWNS, *IMPULSES) if name in parts[0]}
        values = {n: v for n, v in values.items() if n in self.wanted or not np.isnan(v).all()}
        sliding = whole("sliding")
        agrees = np.all([np.isfinite(values[n]) for n in self.wanted], axis=0)
        if "MUP" in values:
            speeds = [values[n] for n in (*VELOCITIES, *FINAL_STATE) if n in values]
            values["MU"] = mu_to_type(values["MUP"], sliding, speeds)
            if must_agree:
                agrees = agrees & ((values["MU"] == self.known["MU"]) | np.isnan(sliding))
        return Solution(
            values=values,
            unknown=self.wanted,
            amplification={name: whole(f"error of {name}") for name in self.wanted},
            agrees=agrees,
            mismatch=whole("mismatch"),
            gyration=whole("gyration"),
        )

    # -- why a set is refused

    def _first(self, wanted: Sequence[str], **changes: float) -> "_Problem":
        """The first scene's problem with other unknowns wanted and some values changed."""
        given = {name: value.reshape(-1)[:1] for name, value in self.known.items()}
        if "MU" in given:
            given["MUP"] = given.pop("MU")
        return _Problem(given | changes, wanted)

    def _determines(self, wanted: Sequence[str], **changes: float) -> bool:
        """Whether all of ``wanted`` is determined in the first scene."""
        return all(s.found.all() for s in self._first(wanted, **changes).solutions())

    def reason(self) -> str:
        """One line saying why the wanted unknowns are not determined in the first scene."""
        if blame := self._coefficient_to_blame() or self._nothing_over_nothing():
            return blame
        alone = [name for name in self.absent if self._determines([name])]
        hint = f"; {' '.join(alone)} could be found alone" if alone else ""
        count, few = (4, "four") if self.point else (6, "six")
        if len(self.absent) > count:
            return (
                f"{len(self.absent)} quantities are unknown ({' '.join(self.absent)}) and the "
                f"{few} equations do not determine {' '.join(self.wanted)}{hint}; give at least "
                f"{len(self.absent) - count} more"
            )
        for vehicle, at in (("A", 0), ("B", 3)):
            its = {*VELOCITIES[at : at + 3], *FINAL_STATE[at : at + 3]} & {*self.names}
            if its <= {*self.absent}:
                return (
                    f"all velocities of {vehicle} are unknown: those of the other determine the "
                    "whole impulse, which leaves Equation 16 nothing to determine and the common "
                    f"part of {vehicle}'s velocities before and after open{hint}"
                )
        return (
            f"the equations do not determine {' '.join(self.wanted)} together: some of them are "
            f"left open while other equations hold nothing unknown{hint}"
        )

    def _coefficient_to_blame(self) -> str | None:
        """The coefficient whose value makes the set undetermined, found by changing it."""
        given: dict[str, float] = {n: self.known[n].flat[0] for n in ("E", "EM") if n in self.known}
        if self.friction is not None:
            given["MUP"] = self.friction.flat[0]
        for size in range(1, len(given) + 1):
            for names in combinations(given, size):
                if self._determines(self.wanted, **{n: ORDINARY[n] for n in names}):
                    return "; and ".join(_blame(n, float(given[n])) for n in names)
        return None

    def _nothing_over_nothing(self) -> str | None:
        """A wanted coefficient whose parts are determined but give no quotient."""
        bad = []
        for name in self.wanted:
            alone = name in COEFFICIENTS and not self._determines([name])
            if alone and _determined(self._first([name]).known, [name], self.point)["parts"].all():
                bad.append(_NO_VALUE[name])
        return "; and ".join(bad) or None


def _determined(given: Mapping[str, Any], wanted: Sequence[str], point: bool) -> dict[str, Array]:
    """What the equations of n scenes determine, n each, NaN elsewhere: quantities by name, the
    ``error of`` each wanted one (`Solution.amplification`), ``sliding`` before the impact,
    ``mismatch``, ``gyration``, and whether the ``parts`` of all wanted coefficients are."""
    count, ignored = len(given["MA"]), (*SPINS, "EM", "PM") if point else ()
    system = System(
        {n: fixed_value(v) for n, v in given.items() if n not in ignored},
        adjusted=False,
        barrier=False,
    )

    def held(state: State) -> State:
        """A velocity known after the impact is that, whatever its momentum equation leaves over."""
        after = zip(FINAL_STATE, state.after, strict=True)
        state.after = [state.values.get(late, value) for late, value in after]
        return state

    def left(state: State, _: Any = None) -> Array:
        laws, momentum = copy(state), system.residuals(state, state.values)[len(system.laws) :]
        rows = system.residuals(held(laws), state.values)[: len(system.laws)]
        return np.concatenate([rows, momentum])

    start = np.zeros((len(system.variables), count))
    residual, jacobian = system.linearize(start, left)
    # a barrier's momentum is nobody's equation
    said = jacobian.any(axis=(1, 2)) | residual.any(axis=1)
    residual, jacobian = residual[said], jacobian[said]
    inverse, left_open = _pseudo_inverse(jacobian.transpose(2, 0, 1))
    x = -np.einsum("nvr,rn->vn", inverse, residual)
    rest = residual + np.einsum("rvn,vn->rn", jacobian, x)
    # each known velocity in error by one unit
    known = [n for n in (*VELOCITIES, *FINAL_STATE) if n in system.nominal]
    sizes = np.max([np.zeros(count), *(np.abs(given[n] / system.scale(n)) for n in known)], axis=0)
    moved = {
        name: given[name] + 1j * COMPLEX_STEP * system.scale(name) * unit[:, None]
        for name, unit in zip(known, np.eye(len(known)), strict=True)
    }
    missed = np.imag(left(system.state(x[:, None].astype(complex), moved))) / COMPLEX_STEP
    errors = -np.einsum("nvr,rkn->vkn", inverse, missed[said])

    names = [n for n in (*VELOCITIES, *FINAL_STATE, *IMPULSES) if n not in ignored]
    unknown = [n for n in COEFFICIENTS if n not in given and n not in ignored]

    def scaled(state: State, _: Any = None) -> Array:
        rows = [held(state)[name] / system.scale(name) for name in names]
        for name in unknown:
            unit = {"MUP": system.mass, "EM": 1 / system.gyration}.get(name, 1.0) * system.speed
            rows += [part / unit for part in state.quotient(name)]
        rows += [velocity / system.speed for velocity in state.relative_before[:2]]
        return np.stack(np.broadcast_arrays(*rows))

    rows, slopes = system.linearize(x, scaled)
    unsure = np.abs(np.einsum("qvn,nvw->qwn", slopes, left_open)).max(axis=1)
    sure = unsure <= _OPEN * np.abs(slopes).max(axis=1)
    growth = (
        np.imag(scaled(system.state(x[:, None] + 1j * COMPLEX_STEP * errors, moved))) / COMPLEX_STEP
    )
    closing = np.hypot(*rows[-2:])
    rows, growth = np.where(sure, rows, np.nan), np.where(sure[:, None], growth, np.nan)
    result = {n: row * system.scale(n) for n, row in zip(names, rows, strict=False)}
    error = dict(zip(names, growth, strict=False))
    parts = np.ones(count, bool)
    for at, name in enumerate(unknown, len(names)):
        two = slice(2 * at - len(names), 2 * at - len(names) + 2)
        (above, below), (da, db) = rows[two], growth[two]
        value = np.where(np.abs(below) > _NOTHING * sizes, above / below, np.nan)
        result[name], error[name] = value, (da - value * db) / below * closing
        parts &= sure[two].all(axis=0) | (name not in wanted)
    if point:  # nothing turns a point mass: no moment, and a spin passes through
        result["PM"] = np.zeros(count)
        for pair in (("WA", "WAF"), ("WB", "WBF")):
            spins = [given[name] for name in pair if name in given]
            result |= dict.fromkeys(pair, spins[0]) if spins else {}
    mismatch = np.sqrt((rest**2).sum(axis=0) / max(len(rest), 1))
    return {
        **result,
        **{n: given[n] for n in UNKNOWNS if n in given and not (point and n == "EM")},
        **{f"error of {name}": np.sqrt((error[name] ** 2).sum(axis=0)) for name in wanted},
        "sliding": rows[-1] * system.speed,
        "mismatch": np.where(mismatch > _OPEN * sizes, mismatch * system.speed, 0.0),
        "gyration": np.broadcast_to(system.gyration, count),
        "parts": parts,
    }


def _pseudo_inverse(matrix: Array) -> tuple[Array, Array]:
    """The Moore-Penrose inverse of each matrix, and a projector on what it leaves open.

    A matrix with a number that is not finite (masses beyond all bounds) leaves everything open.
    """
    finite = np.asarray(np.isfinite(matrix).all(axis=(1, 2)))
    u, s, vt = np.linalg.svd(np.where(finite[:, None, None], matrix, 0.0), full_matrices=False)
    kept, v = s > _NOTHING * s.max(axis=1, initial=0.0)[:, None], vt.swapaxes(1, 2)
    pseudo = (v * np.where(kept, 1 / s, 0.0)[:, None]) @ u.swapaxes(1, 2)
    return pseudo, np.eye(matrix.shape[2]) - (v * kept[:, None]) @ vt


def mu_to_type(mup: Any, sliding: Any, velocities: Iterable[Any]) -> Array:
    """The MU that line 400 turns into MUP: changed where the sliding is positive. Where the sliding
    is not known the sign stays as it is."""
    mu, speed = np.asarray(mup), reduce(np.maximum, map(np.abs, velocities))
    changed = (sliding > TIE * speed) & (mu != PIVOT) & (mu != 0)
    return np.where(changed, -mu, mu)


_NO_VALUE = {
    "E": "the contact points do not approach (gn = 0), so E (Equation 15) has no value",
    "MUP": "there is no normal impulse (Pn = 0), so MU (Equation 16) has no value",
    "EM": "the spins neither differ after the impact nor is there a moment impulse, so EM "
    "(Equation 18) has no value",
}


def _blame(name: str, value: float) -> str:
    why = {
        ("E", 0.0): "E = 0: Equation 15 then only says that the contact points stay together, so "
        "the final velocities do not determine how fast they approached",
        ("EM", 0.0): "EM = 0: Equation 18 then only says that the final spins are equal, and the "
        "moment impulse is not determined",
        ("MUP", PIVOT): "MU = -10 (pivot): its condition holds for final velocities only, and the "
        "tangential impulse is not determined",
    }
    label = "MU (signed)" if name == "MUP" else name
    usual = f"{label} = {value:.6g}: at exactly this value the unknowns cannot be separated"
    return why.get((name, value), usual)


def check_physical(given: Mapping[str, Any]) -> None:
    """Raises UserError where vehicles or geometry are missing, for M other than 6 or 4, values that
    are not finite, masses that are not positive, two infinite ones."""
    if absent := [name for name in GEOMETRY if name not in given]:
        raise UserError(f"{missing(absent)}: the vehicles and their geometry must be known")
    if "MU" in given and "MUP" in given:
        raise UserError("MU and MUP are both given; give MUP (signed Pt/Pn) or MU, not both")
    m, mu = given.get("M", 6.0), given.get("MUP", given.get("MU", 0.0))
    if not (np.all(m == 6) or np.all(m == 4)):
        raise UserError("M must be 6, or 4 for point masses, the same in all scenes")
    if np.any(mu == PIVOT) and not np.all(mu == PIVOT):
        raise UserError("MU is the pivot's -10 in some scenes only; solve pivots apart")
    for name, value in given.items():
        meaning = f"{quantity(name).meaning} [{quantity(name).unit}]"
        infinite_allowed = name in ("MA", "MB", "IA", "IB")
        if np.isnan(value).any() or (np.isinf(value).any() and not infinite_allowed):
            raise UserError(f"{name} is not finite; expected {meaning}")
        if infinite_allowed and not np.all(value > 0):
            raise UserError(f"{name} is not positive; expected {meaning}")
    for kind, names in (("mass", ("MA", "MB")), ("moment of inertia", ("IA", "IB"))):
        if all(np.isinf(given[name]).any() for name in names):
            raise UserError(f"{' and '.join(names)} are both infinite; expected one {kind} at most")
