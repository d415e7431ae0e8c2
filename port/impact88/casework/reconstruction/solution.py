"""One impact that agrees with what is known: its values, what determines them, and their
first-order uncertainty."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import GEOMETRY, within_doubles
from ...collision.needs import join_words
from ...errors import UserError
from ...mechanics.closedform.general import opposing
from ...mechanics.outcome import outcome
from ...mechanics.posed import absent_results, with_headings
from ...mechanics.state import COURSES, DIRECTIONS, FORCES, QUANTITIES, SPEEDS, State
from ...names import COEFFICIENTS, SPINS, UNKNOWNS, VELOCITIES
from ...status import IMPOSSIBLE, Status
from .evidence import Evidence, weigh
from .laws import missed_laws, tested_laws
from .leastsquares import polish, pseudo_inverse
from .system import System
from .unknowns import UnsolvableError, coefficient_to_blame

Floats = NDArray[np.float64]

RESIDUAL_TOL = 1e-10  # largest scaled residual of conditions that hold
NULL_TOL = 1e-7  # relative part of a gradient in the null space that counts as zero
DIRECTION_TOL = 1e-9  # degrees
# Cut-off of normal values without limits, in standard deviations, for draws, bounds and agreement
SIGMAS = 3.0
FOLD_OFFSET = 1e-2  # scaled distance at which a fold is distinguished from a continuum
FOLD_MISFIT = 1e-9  # a sum of squares that is larger by less is as good
FOLD_TOL = 1e-4  # relative singular value below which two branches nearly meet
FOLD_GRADIENT_TOL = 1e-3  # relative part of a gradient along the fold that counts as zero
# Unknowns that can be determined best by other evidence
PREFERRED_MEASUREMENTS = ("WAF", "WBF", "WA", "WB", "E", "MUP", "EM")


class Adjusted(NamedTuple):
    """One known value as measured and as adjusted.

    Parameters
    ----------
    name : str
        Name of the quantity.
    measured, tolerance, adjusted : float
        Measured value, its tolerance, and the adjusted value.
    """

    name: str
    measured: float
    tolerance: float
    adjusted: float

    @property
    def normalized_residual(self) -> float:
        """Adjustment in tolerances."""
        return (self.adjusted - self.measured) / self.tolerance


class Searched(NamedTuple):
    """Record of the search for impacts.

    Parameters
    ----------
    starts : int
        Starts of iterations, random ones and impacts of fewer measurements.
    reached : int
        The number of these that led to the impact found least often.
    single : bool
        True if the equations are linear or leave something open, so that no search is needed or
        possible.
    impacts, possible : int
        Impacts that agree with what is known, and those of them that physics allows.
    solutions : int
        Solutions of the quadratic equations of exact values, all of which were found; 0 if they
        were not solved.
    nonreal : int
        Those that are complex or at infinity.
    """

    starts: int = 0
    reached: int = 0
    single: bool = False
    impacts: int = 1
    possible: int = 1
    solutions: int = 0
    nonreal: int = 0

    def text(self) -> str:
        """Return a statement of the search.

        Returns
        -------
        str
            One sentence without its full stop.
        """
        impacts = "1 impact" if self.impacts == 1 else f"{self.impacts} impacts"
        if self.possible < self.impacts:
            impacts += f", {self.possible or 'none'} of which physics allows"
        if self.single:
            return impacts
        if self.solutions:
            return f"{impacts}; the equations have no other"
        which = "it" if self.impacts == 1 else "the rarest"
        return f"{impacts}; of {self.starts} starts {self.reached} led to {which}"


NOT_SEARCHED = Searched()


SHOWN = ("SA", "SB", "DVA", "DVB", "LOSS")
"""Results shown in the repr of a `Reconstruction`."""


@dataclass(frozen=True)
class Reconstruction:
    """One impact that agrees with what is known.

    Parameters
    ----------
    system : System
        The equations, with what is known of the impact.
    x : ndarray
        The adjusted state.
    values : dict of str to float
        Every quantity determined (`state.QUANTITIES`), and the scene's values, adjusted.
    undetermined : tuple of str
        Velocities and coefficients that nothing known determines.
    adjusted : tuple of Adjusted
        What was known within a tolerance: measured and adjusted value.
    redundancy : int
        Measured values more than needed: what only exact values say tests no measurement.
    squares : float
        Sum of squared adjustments in standard deviations, about the redundancy when tolerances are
        right.
    assumed : bool
        True where the tolerances were taken equal for all known velocities.
    against_sign : bool
        True where friction drives the sliding that MU's sign was chosen to oppose.
    search : Searched
        How impacts were searched for.
    typed_mu : float, optional
        MU, where it is known in size only.
    beside : tuple
        Every impact found, this one too, possible or not.
    remarks : tuple of str
        Sentences on what was made of the problem: values that are not used, a contact plane that
        follows from the motion.
    reached : int
        Starts of the search that led here.
    limited : tuple of str
        Conditions of the admissible set (`admissible`) at whose border the adjusted values lie:
        beyond, an impact that does not count fits better.
    nearest : Reconstruction, optional
        The nearest admissible impact, where none agrees with what is known.

    Examples
    --------
    >>> known = {name: text for name, text in impact88.sample(1).items() if name != "MU"}
    >>> best, *others = impact88.reconstruct({**known, "VAX": "-13.3 +- 0.5"})
    >>> round(best.values["MUP"], 2)
    0.91
    """

    system: System
    x: Floats
    values: dict[str, float]
    undetermined: tuple[str, ...]
    adjusted: tuple[Adjusted, ...]
    redundancy: int
    squares: float
    assumed: bool = False
    against_sign: bool = False
    search: Searched = NOT_SEARCHED
    typed_mu: float | None = None
    beside: tuple[tuple[System, Floats], ...] = field(default=(), repr=False, compare=False)
    remarks: tuple[str, ...] = ()
    reached: int = 0
    limited: tuple[str, ...] = ()
    nearest: "Reconstruction | None" = field(default=None, repr=False, compare=False)

    def __repr__(self) -> str:
        shown = ", ".join(
            f"{name} {self.values[name]:.4g}" for name in SHOWN if name in self.values
        )
        adjusted = f", {len(self.adjusted)} values adjusted" if self.redundancy else ""
        return f"<Reconstruction: {shown or 'nothing determined'}{adjusted}>"

    @property
    def absent(self) -> dict[str, frozenset[str]]:
        """Quantities that need an input that is not given, and which."""
        return absent_results(self.system.known)

    @cached_property
    def impossible(self) -> Status:
        """Bits of STATUS that no real impact has, 0 if the impact is possible."""
        return Status(int(outcome(self.values)["STATUS"])) & IMPOSSIBLE

    @property
    def is_within_limits(self) -> bool:
        """True if the adjusted values lie within all limits, normal ones within `SIGMAS`."""
        return not self.beyond_limits

    @property
    def beyond_limits(self) -> tuple[Adjusted, ...]:
        """The adjusted values that lie beyond their limits, normal ones beyond `SIGMAS`."""
        beyond = []
        for item in self.adjusted:
            low, high = self.system.known[item.name].limits(SIGMAS)
            room = RESIDUAL_TOL * item.tolerance
            if not low - room <= item.adjusted <= high + room:
                beyond.append(item)
        return tuple(beyond)

    @cached_property
    def backwards(self) -> tuple[str, ...]:
        """Known courses along which a vehicle drives backwards, and PDOFs that pull."""
        state, system = self.system.state(self.x), self.system
        return tuple(
            name
            for name in DIRECTIONS
            if name in system.known
            and (COURSES.get(name) or "PN") in self.values
            and state.along_and_across(name)[0]
            < -RESIDUAL_TOL * system.scale("PN" if name in FORCES else "UX")
        )

    @cached_property
    def folded(self) -> tuple[str, ...]:
        """Quantities whose first-order deviations mean nothing near a fold.

        Two branches of impacts nearly meet there. The Jacobian then has weak directions w, of
        singular values near 0, along which the residuals r change only to second order. With a
        distance h, x + h w and x - h w give

            even = r(x + h w) + r(x - h w) - 2 r(x),    about h^2 w^T r'' w,
            odd  = r(x + h w) - r(x - h w),             about 2 h r' w.

        A direction with even > odd is a fold. With odd > even the residuals change to first order:
        the direction is only poorly determined. Quantities are named whose gradient has a part
        along a fold.
        """
        rows = self.system.jacobian(self.x)
        sizes = np.abs(rows).max(axis=1, initial=0.0)
        rows = rows[sizes > 0] / sizes[sizes > 0, None]
        if self.undetermined or not (len(rows) and np.isfinite(rows).all()):
            return ()
        _, singular, vt = np.linalg.svd(rows)
        weak = vt[(singular > FOLD_TOL * singular[0]).sum() :].T
        if not weak.shape[1]:
            return ()
        ahead, center, behind = (
            self.system.residuals(self.system.state(self.x + side * weak))
            for side in (FOLD_OFFSET, 0, -FOLD_OFFSET)
        )
        even, odd = np.abs(ahead + behind - 2 * center), np.abs(ahead - behind)
        weak = weak[:, even.max(axis=0) > odd.max(axis=0)]
        gradients = self.system.gradients(self.x, QUANTITIES)
        largest = np.abs(gradients).max(axis=1, initial=0.0)
        along = np.abs(gradients @ weak).max(axis=1, initial=0.0)
        return tuple(
            name
            for name, part, size in zip(QUANTITIES, along, largest, strict=True)
            if name in self.values and name not in self.system.known
            if part > FOLD_GRADIENT_TOL * size
        )

    @cached_property
    def helpful(self) -> tuple[str, ...]:
        """Further values that would determine everything undetermined, empty if none would."""
        _, null = pseudo_inverse(self.system.jacobian(self.x))
        rows, names = np.zeros((0, null.shape[1])), []
        known = self.system.known
        courses = [c for c, speed in COURSES.items() if speed in known and c not in known]
        wanted = [*dict.fromkeys((*courses, *PREFERRED_MEASUREMENTS, *self.undetermined))]
        for name, row in self._changes_along(null, wanted):
            if name in (*courses, *self.undetermined):
                candidate_rows = np.vstack([rows, row])
                if np.linalg.matrix_rank(candidate_rows, tol=NULL_TOL) > len(rows):
                    rows = candidate_rows
                    names.append(name)
        return tuple(names) if len(rows) == null.shape[1] else ()

    @cached_property
    def alternatives(self) -> tuple[str, ...]:
        """Speeds, each of which would do as well as the only helpful value."""
        if len(self.helpful) != 1:
            return ()
        _, null = pseudo_inverse(self.system.jacobian(self.x))
        unknown = [name for name in SPEEDS if name not in self.system.known]
        return tuple(n for n, row in self._changes_along(null, unknown) if abs(row[0]) > NULL_TOL)

    def _changes_along(self, null: Floats, names: Sequence[str]) -> Iterator[tuple[str, Floats]]:
        """Yield how each quantity changes along the columns of a null space, by its gradient."""
        for name, gradient in zip(names, self.system.gradients(self.x, names), strict=True):
            if np.isfinite(gradient).all():
                yield name, gradient @ null / np.abs(gradient).max(initial=1e-300)

    @cached_property
    def _unit_responses(self) -> tuple[Floats, Floats]:
        """Response of the scaled variables (rows) to an error of one standard deviation in each
        observation, and each observation's redundancy number: the part of such an error that its
        own adjustment shows."""
        jacobian = self.system.jacobian(self.x)
        count = self.system.condition_count
        _, feasible = pseudo_inverse(jacobian[:count])
        projected_inverse, _ = pseudo_inverse(jacobian[count:] @ feasible)
        responses = np.asarray(feasible @ projected_inverse)
        return responses, 1 - np.einsum("ij,ji->i", jacobian[count:], responses)

    @property
    def _responses(self) -> Floats:
        # assumed tolerances are scaled by the misfit
        return np.asarray(self._unit_responses[0] * (self.evidence.widening if self.assumed else 1))

    @cached_property
    def amplification(self) -> dict[str, float]:
        """Error of each unknown velocity and coefficient when each known velocity errs by one unit.

        The errors are independent. A spin's unit is one of velocity over the radius of gyration; a
        coefficient's error is multiplied by the relative speed at C. Empty unless all values are
        exact.
        """
        exact = self.system
        names = [n for n in UNKNOWNS if n in self.values and n not in exact.known]
        system = exact.with_equal_tolerances()
        if exact.observations or not (names and system.observations):
            return {}
        x = system.starts_at(exact, self.x, np.random.default_rng(0))
        measured = replace(self, system=system, x=x)
        responses = system.gradients(x, names) @ measured._unit_responses[0]
        contact_speed = float(
            np.hypot(*np.real(exact.state(self.x).relative_before[:2])).ravel()[0]
        )
        units = {n: float(exact.gyration) if n in SPINS else 1.0 for n in names}
        units |= dict.fromkeys(COEFFICIENTS, contact_speed)
        sizes = np.sqrt(np.square(responses).sum(axis=1))
        sizes[sizes < RESIDUAL_TOL * sizes.max()] = 0.0  # rounding
        return {n: float(size * units[n]) for n, size in zip(names, sizes, strict=True)}

    @cached_property
    def explanation(self) -> str:
        """Reason why an exact coefficient leaves something undetermined, "" where none does."""
        if not self.undetermined or (self.system.observations and not self.assumed):
            return ""
        numbers = {name: item.nominal for name, item in self.system.known.items()}
        try:
            return coefficient_to_blame(numbers, self.undetermined)
        except UserError:  # values that it does not take
            return ""

    @cached_property
    def evidence(self) -> Evidence:
        """Verdict on the evidence: whether the measured values can all be true."""
        return self.weigh_evidence()

    @within_doubles
    def weigh_evidence(self, inside: bool | None = None) -> Evidence:
        """Return the verdict on the evidence, in the light of a search for feasible impacts.

        Parameters
        ----------
        inside : bool, optional
            True if some impact lies within the limits of all known values at once, False if none
            does, None if that was not searched for.

        Returns
        -------
        Evidence
            Whether the measured values can all be true, and those most at odds.
        """
        redundancy_numbers = dict(
            zip(self.system.observations, self._unit_responses[1].tolist(), strict=True)
        )
        known = self.system.known
        values = {
            item.name: (
                item.measured,
                item.adjusted,
                (item.adjusted - item.measured) / known[item.name].standard_deviation,
                redundancy_numbers[item.name],
            )
            for item in self.adjusted
        }
        nominal = self.system.nominal
        laws = missed_laws(nominal) if self.assumed else ()
        holding = () if values else tested_laws(nominal)
        speed = float(self.system.speed)
        return weigh(
            self.squares, self.redundancy, values, inside, self.assumed, laws, holding, speed
        )

    @within_doubles
    def responses(self, names: Sequence[str]) -> Floats:
        """Return the first-order change of quantities per standard deviation of each known value.

        Parameters
        ----------
        names : sequence of str
            Names of m quantities.

        Returns
        -------
        ndarray, shape (m, k)
            A row for each quantity, a column for each of the k adjusted values, in the order of
            ``adjusted``.
        """
        return np.asarray(self.system.gradients(self.x, names) @ self._responses)

    @within_doubles
    def deviations(self, names: Sequence[str]) -> dict[str, float]:
        """Return first-order standard deviations of quantities, as the tolerances make them.

        Parameters
        ----------
        names : sequence of str
            Names of quantities.

        Returns
        -------
        dict of str to float
            Standard deviation of each quantity, in its own unit.

        Notes
        -----
        Where the known values contradict one another, the deviations mean nothing until they are
        multiplied by ``evidence.widening``.
        """
        sizes = np.sqrt(np.square(self.responses(names)).sum(axis=1))
        return dict(zip(names, sizes.tolist(), strict=True))

    @within_doubles
    def correlations(self, names: Sequence[str]) -> Floats:
        """Return first-order correlations of quantities.

        Parameters
        ----------
        names : sequence of str
            Names of m quantities.

        Returns
        -------
        ndarray, shape (m, m)
            Correlation coefficients, nan where a quantity does not vary.
        """
        responses = self.responses(names)
        units = responses / np.sqrt(np.square(responses).sum(axis=1, keepdims=True))
        return np.asarray(units @ units.T)

    @within_doubles
    def scene(self) -> dict[str, float]:
        """Return the impact as a scene, with MU as line 280 of the listing would hold it.

        Returns
        -------
        dict of str to float
            All 21 values of a scene by name, M too.

        Raises
        ------
        UnsolvableError
            When a value of the scene is not determined; the message names it.
        """
        names = [n for n in ("E", "EM", *VELOCITIES) if not (self.system.point and n == "EM")]
        missing = [n for n in (*names, "MUP") if n not in self.values]
        if missing:
            raise UnsolvableError(f"no scene: {' '.join(missing)} not determined")
        values = {n: self.values[n] for n in (*GEOMETRY, *names) if n in self.values}
        values["MU"] = self.typed_friction
        return {"M": 4.0 if self.system.point else 6.0, "EM": 0.0, **values}

    @property
    def typed_friction(self) -> float:
        """The MU that line 400 of the listing turns into this impact's P_t/P_n."""
        slip = np.real(self.system.state(self.x).relative_before[1])
        return float(opposing(self.values["MUP"], slip).item())


def invariants(values: Mapping[str, float]) -> list[float]:
    """Return what does not depend on axes, names of vehicles or units, to six digits: the
    fraction of the initial kinetic energy that is in spins, e and that energy first, then
    everything else in which impacts differ."""
    pairs = [("A", "B"), ("AF", "BF")]
    spin_energies = [
        sum(
            # a product of huge spins is infinite, a power of them an error
            values.get(spin, 0.0) * values.get(spin, 0.0) * values[inertia] / 2
            for spin, inertia in (("WA" + after, "IA"), ("WB" + after, "IB"))
            if math.isfinite(values.get(inertia, math.inf))
        )
        for after in ("", "F")
    ]
    energy = values.get("KI", 0.0)
    fractions = [x / energy if energy else 0.0 for x in spin_energies]
    speeds = [sum(values.get("S" + x, 0.0) for x in pair) for pair in pairs]
    sizes = [abs(values.get(name, 0.0)) for name in ("E", "VC", "PN", "PT", "PM", "MUP", "EM")]
    sums = [values.get("DVA", 0.0) + values.get("DVB", 0.0), values.get("EL", 0.0)]
    ranks = [fractions[0], sizes[0], energy, fractions[1], *speeds, *sums, *sizes[1:]]
    return [float(f"{x:.5e}") if abs(x) > 1e-9 else 0.0 for x in ranks]


def _is_fold(system: System, x: Floats, null: Floats) -> bool:
    """Return True if the impact is isolated although first order leaves something undetermined: two
    branches meet there. Beside a point of a continuum, where one component is held, there is a
    minimum that is as good; beside a fold there is none."""
    least = _misfit(system, x)
    for direction in (*null.T, *-null.T):
        place = direction @ x[:, 0] + FOLD_OFFSET

        def distance(state: State, direction: Floats = direction, place: float = place) -> Any:
            rows = zip(system.variables, system.scales, direction, strict=True)
            return sum(part * state.values[n] / scale for n, scale, part in rows) - place

        beside = polish(
            system.limited_by([*system.limits, distance]), x + FOLD_OFFSET * direction[:, None]
        )
        if beside is not None and _misfit(system, beside) < least + FOLD_MISFIT:
            return False
    return True


def _misfit(system: System, x: Floats) -> float:
    """Return the sum of squared adjustments, infinite where conditions do not hold."""
    residual, count = system.residuals(system.state(x))[:, 0], system.condition_count
    holds = np.abs(residual[:count]).max(initial=0.0) <= RESIDUAL_TOL
    return float(np.square(residual[count:]).sum()) if holds else np.inf


def describe(system: System, x: Floats, assumed: bool) -> Reconstruction:
    """Return the solution at ``x``: every quantity that is determined there, and the adjustments.
    Raise UnsolvableError, with what to give, where exact values determine nothing."""
    state, rows, count = system.state(x), system.jacobian(x), system.condition_count
    values, undetermined = _determined_values(system, x, pseudo_inverse(rows)[1])
    _, feasible = pseudo_inverse(rows[:count])
    _, left_open = pseudo_inverse(rows[count:] @ feasible)
    adjusted = []
    for name in system.observations:
        item, value = system.known[name], float(np.ravel(system.observed_value(state, name))[0])
        adjusted.append(Adjusted(name, item.nominal, item.tolerance, value))
    adjustments = system.residuals(state)[count:, 0]
    solution = Reconstruction(
        system=system,
        x=x,
        values=with_headings(values),
        undetermined=tuple(undetermined),
        adjusted=tuple(adjusted),
        redundancy=len(adjusted) - (feasible.shape[1] - left_open.shape[1]),
        squares=float(adjustments @ adjustments),
        assumed=assumed,
    )
    is_found = any(name in values for name in UNKNOWNS if name not in system.known)
    if undetermined and not is_found and not system.observations:
        reason = f": {solution.explanation}" if solution.explanation else ""
        needed = join_words(solution.helpful) if solution.helpful else "more of it"
        raise UnsolvableError(
            f"nothing of {' '.join(undetermined)} is determined by what is known{reason}; "
            f"give {needed}"
        )
    return solution


def _determined_values(
    system: System, x: Floats, null: Floats
) -> tuple[dict[str, float], list[str]]:
    """Return every quantity that is determined, and the velocities and coefficients that are not.

    A quantity is undetermined where its gradient has a component in the null space of the
    Jacobian, unless the impact is isolated (`_is_fold`). Two kinds need more than their gradient:

    - A course does not change with the speed along it, so that its gradient may be zero; where a
      component of the velocity is undetermined, the vehicle could also drive the other way, 180°
      off.
    - The direction of the impulse is undetermined where P_n is."""
    state, absent = system.state(x), absent_results(system.known)

    def to_float(array: Any) -> float:
        return float(np.ravel(array)[0])

    values = {n: to_float(state.values[n]) for n in ("M", *GEOMETRY) if n in system.known}
    undetermined: list[str] = []
    is_fold = bool(null.shape[1]) and _is_fold(system, x, null)
    for name, gradient in zip(QUANTITIES, system.gradients(x, QUANTITIES), strict=True):
        if name in absent or (system.point and name in (*SPINS, "PM", "EM")):
            continue
        is_known = name in COEFFICIENTS and name in system.known
        if name == "MUP" and "MUC" in system.constants:
            # MUP is then known as a fraction of MUC only, which differs from impact to impact
            is_known = False
        amount = to_float(state.values[name] if is_known else state[name])
        largest = np.abs(gradient).max(initial=0.0)
        is_open = not is_fold and np.abs(gradient @ null).max(initial=0.0) > NULL_TOL * largest
        if name in COURSES:
            along_open = bool({*undetermined} & {*SPEEDS[COURSES[name]]})
            if along_open and name in system.known and not system.known[name].varies:
                values[name] = system.known[name].nominal  # the vehicle might drive either way
                continue
            is_open |= along_open and name not in system.known
        if name in FORCES and name not in system.known:
            is_open |= "PN" not in values
        if is_known or (np.isfinite(amount) and np.isfinite(largest) and not is_open):
            # the direction opposite to the axis is 180, whatever rounding makes of it
            is_opposite = name in (*COURSES, *FORCES) and amount < -180 + DIRECTION_TOL
            values[name] = amount + 360 if is_opposite else amount
        elif name in UNKNOWNS:
            undetermined.append(name)
    return values, undetermined
