"""Equations 13-18 solved for any unknowns: reconstruction and its relatives (chapter, IV-C).

Twelve velocities (six before, six after the impact) and three coefficients appear in six equations.
Whatever is not given is unknown: six final velocities (as in the 1988 program), six initial ones,
three velocities and e, e_m, μ, or any other set. An unknown coefficient appears in one equation
alone (e in 15, μ in 16, e_m in 18), which determines it at the end; the remaining equations are
linear (`system.System`) and are solved at once. Redundant equations are fitted by least squares,
and the mismatch is reported. The rank is decided by singular values; a set that is not determined
is refused with the reason.

Friction: ``MUP`` is the signed P_t/P_n as printed; ``MU`` is what line 280 would hold, whose sign
line 400 chooses so that friction opposes the sliding. Where the initial velocities are unknown both
signs are tried, and each solution that agrees with its own sign is returned."""

from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import GEOMETRY, within_doubles
from ...collision.mappings import columns
from ...collision.uncertain import fixed_value
from ...errors import UserError
from ...mechanics.closedform.general import opposing, typed_friction
from ...mechanics.posed import absent_results, pose
from ...mechanics.state import State, without_rounding
from ...messages.arguments import explains_arguments
from ...names import (
    COEFFICIENTS,
    FINAL_STATE,
    IMPULSES,
    PIVOT,
    RESULTS,
    SCENE,
    SPINS,
    UNKNOWNS,
    VELOCITIES,
    check_names,
    missing,
    quantity,
)
from .system import COMPLEX_STEP, System

Array = NDArray[np.float64]

BADLY_CONDITIONED = 10.0  # error amplification at which a solution is flagged
# at which nothing special happens
ORDINARY_COEFFICIENTS = {"E": 0.37, "EM": -0.61, "MUP": 0.43}
CHUNK = 1 << 12  # scenes solved at a time, bounds the memory
# Twice or a hundredth of these changes none of 260 problems.
RANK_TOL = 1e-12  # relative singular values and denominators of coefficients below count as zero
NULL_TOL = 1e-9  # relative part of a gradient in the null space, or mismatch, that counts as zero


def _disagreement(values: Mapping[str, Any]) -> str:
    """Return a phrase with the law that the exact values violate, "" if none."""
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
        relative speed at C).
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
        return np.asarray(self.mismatch > NULL_TOL * np.max(speeds, axis=0))


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
    Equations 13 to 18. `reconstruct` gives the same values of one impact, and also takes speeds,
    courses, energies and values with a tolerance. This function solves arrays of impacts, each in a
    thousandth of the time, finds chosen quantities where the rest is not determined, and says why a
    set of unknowns is not.

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
        agreeing = [s for s in solutions if s.agrees]
        agreeing = [s for s in agreeing if not s.contradictory] or agreeing
    else:
        agreeing = [s for s in solutions if s.agrees.any()]
    if agreeing or 0 in problem.shape:
        return agreeing
    if any(s.found.any() for s in solutions):
        raise UnsolvableError(
            "neither sign of MU agrees with the sliding it leads to (line 400): no friction "
            "that opposes the sliding joins these velocities"
        )
    raise UnsolvableError(problem.reason())


class _Problem:
    """The known values and unknowns of a call, checked. Every number is an array of one ``shape``;
    ``names``: quantities that can be unknown; ``absent``: those that are."""

    def __init__(self, known: Mapping[str, Any], unknown: Iterable[str] | None) -> None:
        allowed = {*GEOMETRY, "M", *VELOCITIES, *FINAL_STATE, "E", "EM", "MU", "MUP"}
        values = columns(known)
        check_names(values, [n for n in (*SCENE, *RESULTS) if n in allowed], "value of an impact")
        values = {n: np.asarray(v, np.float64) for n, v in values.items()}
        check_physical(values)
        values, _ = pose(values, np.float64)
        m = values.get("M", np.asarray(6.0))
        self.point = point = bool(m.size) and bool((m == 4).all())
        self.inapplicable = {*absent_results(values), *((*SPINS, "EM") if point else ())}
        self.names = tuple(n for n in UNKNOWNS if n not in self.inapplicable)
        given = {*values} | ({"MUP"} if "MU" in values else set())
        self.absent = tuple(name for name in self.names if name not in given)
        self.wanted = self.absent if unknown is None else tuple(dict.fromkeys(unknown))
        check_names(self.wanted, self.names, "quantity that may be unknown")
        for name in self.wanted:
            if name not in self.absent:
                raise UserError(f"{name} is both known and wanted; leave it out of one")
        if not self.wanted:
            raise UserError(
                f"nothing is unknown{_disagreement(values)}; leave out values to solve for"
            )
        try:
            self.shape = np.broadcast_shapes(*(value.shape for value in values.values()))
        except ValueError:
            shapes = ", ".join(f"{name} {v.shape}" for name, v in values.items() if v.ndim)
            raise UserError(f"the arrays do not broadcast together: {shapes}") from None
        self.known = {name: np.broadcast_to(v, self.shape) for name, v in values.items()}

    @property
    def friction(self) -> Array | None:
        """MUP, or MU with its sign undecided."""
        return self.known.get("MUP", self.known.get("MU"))

    def solutions(self) -> list[Solution]:
        """Return one solution, or one for each sign of MU where the sign that line 400 gives
        depends on unknowns."""
        if "MU" not in self.known:
            return [self._solve(self.friction)]
        mu = self.known["MU"]
        if (mu == PIVOT).any() or not mu.any():
            return [self._solve(mu)]
        if all(name in self.known for name in VELOCITIES if not (self.point and name in SPINS)):
            # point masses need no spins
            return [self._solve(typed_friction({"WA": 0.0, "WB": 0.0, **self.known}, mu))]
        return [self._solve(mu, must_agree=True), self._solve(-mu, must_agree=True)]

    def _solve(self, mu: Array | None, must_agree: bool = False) -> Solution:
        """Return the solution for a signed friction coefficient."""
        count = int(np.prod(self.shape))
        flat = {name: value.reshape(count) for name, value in self.known.items()}
        if mu is not None:
            flat["MUP"] = np.broadcast_to(mu, self.shape).reshape(count)
        parts = [
            _solve_block({n: v[at : at + CHUNK] for n, v in flat.items()}, self.wanted, self.point)
            for at in range(0, max(count, 1), CHUNK)
        ]

        def join_blocks(name: str) -> Array:
            return np.concatenate([part[name] for part in parts]).reshape(self.shape)

        values = {name: join_blocks(name) for name in (*UNKNOWNS, *IMPULSES) if name in parts[0]}
        values = {n: v for n, v in values.items() if n in self.wanted or not np.isnan(v).all()}
        sliding = join_blocks("sliding")
        agrees = np.all([np.isfinite(values[n]) for n in self.wanted], axis=0)
        if "MUP" in values:
            if must_agree:
                speeds = [values[n] for n in (*VELOCITIES, *FINAL_STATE) if n in values]
                sliding = without_rounding(sliding, speeds)
            values["MU"] = opposing(values["MUP"], sliding)
            if must_agree:
                agrees = agrees & ((values["MU"] == self.known["MU"]) | np.isnan(sliding))
        return Solution(
            values=values,
            unknown=self.wanted,
            amplification={name: join_blocks(f"error of {name}") for name in self.wanted},
            agrees=agrees,
            mismatch=join_blocks("mismatch"),
            gyration=join_blocks("gyration"),
        )

    # -- the reason for refusing a set of unknowns

    def _first_scene(self, wanted: Sequence[str], **changes: float) -> "_Problem":
        """Return the first scene's problem, with other unknowns and some values changed."""
        values = {name: value.reshape(-1)[:1] for name, value in self.known.items()}
        if "MU" in values:
            values["MUP"] = values.pop("MU")
        return _Problem(values | changes, wanted)

    def _determines(self, wanted: Sequence[str], **changes: float) -> bool:
        """Return True if all of ``wanted`` is determined in the first scene."""
        return all(s.found.all() for s in self._first_scene(wanted, **changes).solutions())

    def reason(self) -> str:
        """Return one line: why the wanted unknowns are not determined in the first scene."""
        if blame := self._coefficient_to_blame() or self._coefficient_without_value():
            return blame
        findable = [name for name in self.absent if self._determines([name])]
        hint = f"; {' '.join(findable)} could be found alone" if findable else ""
        count, count_in_words = (4, "four") if self.point else (6, "six")
        if len(self.absent) > count:
            return (
                f"{len(self.absent)} quantities are unknown ({' '.join(self.absent)}) and the "
                f"{count_in_words} equations do not determine {' '.join(self.wanted)}{hint}; give "
                f"at least {len(self.absent) - count} more"
            )
        for vehicle, at in (("A", 0), ("B", 3)):
            own_velocities = {*VELOCITIES[at : at + 3], *FINAL_STATE[at : at + 3]} & {*self.names}
            if own_velocities <= {*self.absent}:
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
        """Return the reason if a coefficient's special value makes the set undetermined: the set is
        determined with an ordinary value in its place."""
        coefficients: dict[str, float] = {
            n: self.known[n].flat[0] for n in ("E", "EM") if n in self.known
        }
        if self.friction is not None:
            coefficients["MUP"] = self.friction.flat[0]
        for size in range(1, len(coefficients) + 1):
            for names in combinations(coefficients, size):
                if self._determines(self.wanted, **{n: ORDINARY_COEFFICIENTS[n] for n in names}):
                    return "; and ".join(
                        _explain_coefficient(n, float(coefficients[n])) for n in names
                    )
        return None

    def _coefficient_without_value(self) -> str | None:
        """Return the reason if a wanted coefficient is a quotient 0/0, although numerator and
        denominator are determined."""
        reasons = []
        for name in self.wanted:
            is_undetermined = name in COEFFICIENTS and not self._determines([name])
            if (
                is_undetermined
                and _solve_block(self._first_scene([name]).known, [name], self.point)["parts"].all()
            ):
                reasons.append(_NO_VALUE[name])
        return "; and ".join(reasons) or None


def coefficient_to_blame(known: Mapping[str, Any], wanted: Sequence[str]) -> str:
    """Return the reason if a coefficient's special value leaves ``wanted`` undetermined, else "".
    Raise UserError for values that `solve_for` does not take."""
    return _Problem(known, wanted)._coefficient_to_blame() or ""


class _Fit(NamedTuple):
    """The least-squares solutions of n scenes: scaled variables ``x`` (variables, n), their
    ``errors`` (variables, known velocities, n) when each known velocity errs by one unit, the
    projector on the null space (n, variables, variables), and the residuals (equations, n)."""

    x: Array
    errors: Array
    null_projector: Array
    misfit: Array


def _solve_block(known: Mapping[str, Any], wanted: Sequence[str], point: bool) -> dict[str, Array]:
    """Return everything that the equations of n scenes determine, n values each, NaN elsewhere.

    Quantities by name; the ``error of`` each wanted one (`Solution.amplification`); the ``sliding``
    before the impact, ``mismatch`` and ``gyration``; ``parts``: True where numerator and
    denominator of all wanted coefficients are determined.
    """
    # not split: steps of one solution, each of which needs what all above it found
    count, ignored = len(known["MA"]), (*SPINS, "EM", "PM") if point else ()
    system = System(
        {n: fixed_value(v) for n, v in known.items() if n not in ignored},
        adjusted=False,
        barrier=False,
    )
    velocities = [n for n in (*VELOCITIES, *FINAL_STATE) if n in system.nominal]
    sizes = np.max(
        [np.zeros(count), *(np.abs(known[n] / system.scale(n)) for n in velocities)], axis=0
    )
    offset_data = {
        name: known[name] + 1j * COMPLEX_STEP * system.scale(name) * unit[:, None]
        for name, unit in zip(velocities, np.eye(len(velocities)), strict=True)
    }
    fit = _fit(system, count, offset_data)

    names = [n for n in (*VELOCITIES, *FINAL_STATE, *IMPULSES) if n not in ignored]
    coefficients = [n for n in COEFFICIENTS if n not in known and n not in ignored]

    def scaled_quantities(state: State) -> Array:
        rows = [_with_known_after(state)[name] / system.scale(name) for name in names]
        for name in coefficients:
            unit = {"MUP": system.mass, "EM": 1 / system.gyration}.get(name, 1.0) * system.speed
            rows += [part / unit for part in state.quotient(name)]
        rows += [velocity / system.speed for velocity in state.relative_before[:2]]
        return np.stack(np.broadcast_arrays(*rows))

    rows, slopes = system.linearize(fit.x, scaled_quantities)
    null_parts = np.abs(np.einsum("qvn,nvw->qwn", slopes, fit.null_projector)).max(axis=1)
    is_determined = null_parts <= NULL_TOL * np.abs(slopes).max(axis=1)
    offset_state = system.state(fit.x[:, None] + 1j * COMPLEX_STEP * fit.errors, offset_data)
    row_errors = np.imag(scaled_quantities(offset_state)) / COMPLEX_STEP
    contact_speed = np.hypot(*rows[-2:])
    rows = np.where(is_determined, rows, np.nan)
    row_errors = np.where(is_determined[:, None], row_errors, np.nan)
    values = {n: row * system.scale(n) for n, row in zip(names, rows, strict=False)}
    errors = dict(zip(names, row_errors, strict=False))
    parts_determined = np.ones(count, bool)
    for i, name in enumerate(coefficients):
        # a coefficient is a quotient of two rows: numerator and denominator
        pair = slice(len(names) + 2 * i, len(names) + 2 * i + 2)
        (numerator, denominator), (d_numerator, d_denominator) = rows[pair], row_errors[pair]
        is_quotient = np.abs(denominator) > RANK_TOL * sizes
        value = np.where(is_quotient, numerator / denominator, np.nan)
        values[name] = value
        errors[name] = (d_numerator - value * d_denominator) / denominator * contact_speed
        parts_determined &= is_determined[pair].all(axis=0) | (name not in wanted)
    if point:  # nothing turns a point mass: no moment, and a spin passes through
        values["PM"] = np.zeros(count)
        for pair_names in (("WA", "WAF"), ("WB", "WBF")):
            spins = [known[name] for name in pair_names if name in known]
            values |= dict.fromkeys(pair_names, spins[0]) if spins else {}
    mismatch = np.sqrt((fit.misfit**2).sum(axis=0) / max(len(fit.misfit), 1))
    return {
        **values,
        **{n: known[n] for n in UNKNOWNS if n in known and not (point and n == "EM")},
        **{f"error of {name}": np.sqrt((errors[name] ** 2).sum(axis=0)) for name in wanted},
        "sliding": rows[-1] * system.speed,
        "mismatch": np.where(mismatch > NULL_TOL * sizes, mismatch * system.speed, 0.0),
        "gyration": np.broadcast_to(system.gyration, count),
        "parts": parts_determined,
    }


def _fit(system: System, count: int, offset_data: Mapping[str, Array]) -> _Fit:
    """Return the least-squares solutions of n scenes. The equations are linear, so that one
    Gauss-Newton step from 0 solves them. ``offset_data``: each known velocity with a complex step
    of one unit, (known velocities, n)."""

    def residuals(state: State) -> Array:
        law_state, momentum = copy(state), system.residuals(state, state.values)[len(system.laws) :]
        laws = system.residuals(_with_known_after(law_state), state.values)[: len(system.laws)]
        return np.concatenate([laws, momentum])

    residual, jacobian = system.linearize(np.zeros((len(system.variables), count)), residuals)
    # rows that are 0 are no equations, such as the momentum of a barrier
    is_equation = jacobian.any(axis=(1, 2)) | residual.any(axis=1)
    residual, jacobian = residual[is_equation], jacobian[is_equation]
    inverse, null_projector = _pseudo_inverse(jacobian.transpose(2, 0, 1))
    x = -np.einsum("nvr,rn->vn", inverse, residual)
    misfit = residual + np.einsum("rvn,vn->rn", jacobian, x)
    offset_state = system.state(x[:, None].astype(complex), offset_data)
    changes = np.imag(residuals(offset_state)) / COMPLEX_STEP
    errors = -np.einsum("nvr,rkn->vkn", inverse, changes[is_equation])
    return _Fit(x, errors, null_projector, misfit)


def _with_known_after(state: State) -> State:
    """Replace the velocities after the impact by those that are known, whatever residual their
    momentum equations have."""
    after = zip(FINAL_STATE, state.after, strict=True)
    state.after = [state.values.get(late, value) for late, value in after]
    return state


def _pseudo_inverse(matrix: Array) -> tuple[Array, Array]:
    """Return the Moore-Penrose inverse of each matrix, and a projector on its null space. For a
    matrix that is not finite (masses beyond the range of doubles) the projector is the identity:
    nothing is determined."""
    finite = np.asarray(np.isfinite(matrix).all(axis=(1, 2)))
    u, s, vt = np.linalg.svd(np.where(finite[:, None, None], matrix, 0.0), full_matrices=False)
    counts, v = s > RANK_TOL * s.max(axis=1, initial=0.0)[:, None], vt.swapaxes(1, 2)
    pseudo = (v * np.where(counts, 1 / s, 0.0)[:, None]) @ u.swapaxes(1, 2)
    return pseudo, np.eye(matrix.shape[2]) - (v * counts[:, None]) @ vt


_NO_VALUE = {
    "E": "the contact points do not approach (gn = 0), so E (Equation 15) has no value",
    "MUP": "there is no normal impulse (Pn = 0), so MU (Equation 16) has no value",
    "EM": "the spins neither differ after the impact nor is there a moment impulse, so EM "
    "(Equation 18) has no value",
}


def _explain_coefficient(name: str, value: float) -> str:
    """Return why a coefficient's value makes a set of unknowns undetermined."""
    reasons = {
        ("E", 0.0): "E = 0: Equation 15 then only says that the contact points stay together, so "
        "the final velocities do not determine how fast they approached",
        ("EM", 0.0): "EM = 0: Equation 18 then only says that the final spins are equal, and the "
        "moment impulse is not determined",
        ("MUP", PIVOT): "MU = -10 (pivot): its condition holds for final velocities only, and the "
        "tangential impulse is not determined",
    }
    label = "MU (signed)" if name == "MUP" else name
    default = f"{label} = {value:.6g}: at exactly this value the unknowns cannot be separated"
    return reasons.get((name, value), default)


COURSE_INPUTS = {"TA": "HA, or UX and UY", "TB": "HB, or VX and VY"}


def check_physical(values: Mapping[str, Any]) -> None:
    """Raise UserError where vehicles or geometry are missing, for M other than 6 or 4, values that
    are not finite, masses that are not positive, and for two infinite masses or inertias."""
    if missing_names := [name for name in ("MA", "MB") if name not in values]:
        raise UserError(f"{missing(missing_names)}: the vehicles' masses must be known")
    if "MU" in values and "MUP" in values:
        raise UserError("MU and MUP are both given; give MUP (signed Pt/Pn) or MU, not both")
    m, mu = values.get("M", 6.0), values.get("MUP", values.get("MU", 0.0))
    if not (np.all(m == 6) or np.all(m == 4)):
        raise UserError("M must be 6, or 4 for point masses, the same in all scenes")
    if np.any(mu == PIVOT) and not np.all(mu == PIVOT):
        raise UserError("MU is the pivot's -10 in some scenes only; solve pivots apart")
    for name, value in values.items():
        meaning = f"{quantity(name).meaning} [{quantity(name).unit}]"
        infinite_allowed = name in ("MA", "MB", "IA", "IB")
        if name in ("TA", "TB") and np.isnan(value).all():  # `state.COURSE`
            if np.all(m == 4):
                continue
            raise UserError(
                f'{name} = "course" needs the course before the impact, exactly: '
                f"{COURSE_INPUTS[name]}, unless M is 4"
            )
        if np.isnan(value).any() or (np.isinf(value).any() and not infinite_allowed):
            raise UserError(f"{name} is not finite; expected {meaning}")
        if infinite_allowed and not np.all(value > 0):
            raise UserError(f"{name} is not positive; expected {meaning}")
    for kind, names in (("mass", ("MA", "MB")), ("moment of inertia", ("IA", "IB"))):
        if all(name in values and np.isinf(values[name]).any() for name in names):
            raise UserError(f"{' and '.join(names)} are both infinite; expected one {kind} at most")
