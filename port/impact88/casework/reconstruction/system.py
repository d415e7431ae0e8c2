"""Known values of impacts as equations, in scaled variables (rows) of n impacts (columns).

Equations 13, 14 and 17 hold by the way an impact is written (`State`). Equations 15, 16 and 18 and
the exact values are conditions, values with a tolerance are observations. All residuals are divided
by a typical velocity (impulses by the reduced mass times it, spins by it over the radius of
gyration). With exact values alone all conditions are linear, except speeds, directions, changes of
velocity and energies."""

from collections.abc import Callable, Mapping, Sequence
from copy import copy
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import GEOMETRY, Geometry
from ...collision.uncertain import Uncertain
from ...mechanics.state import (
    CHANGES,
    CONTACT,
    COURSE_OF,
    COURSES,
    CRUSH,
    DIRECTIONS,
    ENERGIES,
    FORCES,
    QUANTITIES,
    SPEEDS,
    State,
)
from ...names import COEFFICIENTS, FINAL_STATE, IMPULSES, PIVOT, SPINS, VELOCITIES, quantity

Array = NDArray[Any]
Floats = NDArray[np.float64]

# Known values that enter the conditions; all others are quantities computed from a state
PARAMETERS = (*GEOMETRY, *COEFFICIENTS, *SPEEDS, *DIRECTIONS, *CRUSH)
MEASURABLE = (*VELOCITIES, *FINAL_STATE, *CHANGES, *ENERGIES, *CONTACT)
COMPLEX_STEP = 1e-30  # imaginary step of derivatives: without subtraction there is no rounding
# Quantities whose conditions are not linear: several impacts may have the same
_NONLINEAR = ("SA", "SB", "SAF", "SBF", *CHANGES, *ENERGIES, *CRUSH)


class System:
    """The equations of one reading of what is known.

    ``known``: values by name, friction as MUP; nominal values may be arrays where nothing is
    adjusted. ``adjusted``: True to adjust values with a tolerance (each a variable or a quantity
    with an observation), False to take their nominal values as exact (all are conditions).
    ``progress`` is called with the number of impacts evaluated. ``barrier``: True if a vehicle of
    infinite mass is at rest."""

    def __init__(
        self,
        known: Mapping[str, Uncertain],
        adjusted: bool,
        progress: Callable[[int], object] = lambda n: None,
        barrier: bool = True,
    ) -> None:
        self.progress = progress
        self.known, self.adjusted = dict(known), adjusted
        self.nominal: dict[str, Any] = {name: item.nominal for name, item in known.items()}
        geometry = Geometry(self.nominal)
        self.point = bool(np.all(geometry.point))
        self._set_sizes(geometry)
        fixed: tuple[str, ...] = ("WA", "WB", "PM") if self.point else ()
        for mass_name, names in (("MA", VELOCITIES[:3]), ("MB", VELOCITIES[3:])):
            if barrier and np.all(np.isinf(self.nominal[mass_name])):
                fixed += names
        uncertain = {n for n, item in known.items() if adjusted and item.varies}
        self._set_variables(fixed, uncertain)
        self._set_conditions(fixed, uncertain)
        self.observations = tuple(n for n in known if n in uncertain and n not in fixed)
        has_fixed_geometry = uncertain.isdisjoint(GEOMETRY)
        self.geometry = geometry if has_fixed_geometry else None
        self.linear = (
            not adjusted
            and "MUC" not in self.constants
            and not any(n in _NONLINEAR and COURSE_OF.get(n) not in known for n in known)
        )

    def _set_sizes(self, geometry: Geometry) -> None:
        """Set the sizes of ordinary quantities, by unit."""
        # numpy's numbers: beyond the range of doubles they are infinite, where Python's raise
        self.mass: Any = np.float64(1) / geometry.inverse_mass
        self.gyration: Any = np.float64(1.0)
        if not self.point:
            self.gyration = np.sqrt(geometry.inverse_mass / geometry.inverse_spin_inertia)
        self.speed: Any = self._typical_speed()
        speed, mass, length = self.speed, self.mass, self.gyration
        self.sizes: dict[str, Any] = {
            "1": 1.0,
            "percent": 100.0,
            "degree": np.degrees(1.0),
            "length": length,
            "length/time": speed,
            "rad/time": speed / length,
            "mass·length/time": mass * speed,
            "mass·length²/time": mass * speed * length,
            "mass·length²/time²": mass * speed**2,
        }

    def _set_variables(self, fixed: tuple[str, ...], uncertain: set[str]) -> None:
        """Set the variables, and the values that are not."""
        known, after = self.known, dict(zip(VELOCITIES, FINAL_STATE, strict=True))
        parameters = [n for n in known if n in PARAMETERS and n in uncertain]
        unknown = [n for n in VELOCITIES if n not in fixed and (n not in known or n in uncertain)]
        self.from_after: tuple[str, ...] = ()
        if not self.adjusted:
            self.from_after = tuple(n for n in unknown if after[n] in known)
            unknown = [n for n in unknown if n not in self.from_after]
        impulses = [n for n in IMPULSES if n not in fixed]
        self.variables = (*unknown, *impulses, *parameters)
        self.scales = np.array([*np.broadcast_arrays(*map(self.scale, self.variables))])
        self.constants = {**dict.fromkeys(fixed, 0.0), **self.nominal}
        if (friction := known.get("MUP")) is not None and friction.critical:
            self.constants["MUC"] = friction.critical  # a fraction of each impact's own

    def _set_conditions(self, fixed: tuple[str, ...], uncertain: set[str]) -> None:
        """Set the laws and exact values that hold."""
        known, after = self.known, dict(zip(VELOCITIES, FINAL_STATE, strict=True))
        self.laws = [n for n in COEFFICIENTS if n in known and not (self.point and n == "EM")]
        implied = {after[n] for n in (*fixed, *self.from_after) if n in after}
        self.exact = [
            n
            for n in known
            if (n in MEASURABLE and n not in (*uncertain, *VELOCITIES, *implied))
            or n in (*SPEEDS, *DIRECTIONS, "ELA", "EBSA")
        ]
        self.conditions = (*self.laws, *self.exact)
        self.limits: tuple[Callable[[State], Any], ...] = ()

    def limited_by(self, limits: Sequence[Callable[[State], Any]]) -> "System":
        """Return the same equations with further conditions: residuals of impacts, real or
        complex."""
        limited = copy(self)
        limited.limits = tuple(limits)
        return limited

    def with_equal_tolerances(self) -> "System":
        """Return the equations of exact values with a standard deviation of one unit on each known
        velocity. That of a spin is one unit over the radius of gyration; that of an energy, what
        one unit adds to it at the typical speed; that of a course, the angle by which one unit
        across turns its vehicle's velocity."""
        turning = np.degrees(1.0)
        deviations = {
            "length/time": 1.0,
            "rad/time": float(1 / self.gyration),
            quantity("EL").unit: float(self.sizes[quantity("EL").unit] / self.speed),
            quantity("LOSS").unit: float(self.sizes[quantity("LOSS").unit] / self.speed),
        }
        known = dict(self.known)
        for name, item in self.known.items():
            deviation = deviations.get(quantity(name).unit)
            if name in DIRECTIONS:
                speed = self.nominal.get(COURSES.get(name, ""), self.speed)
                deviation = float(turning / speed) if speed else None
            if deviation is not None:
                known[name] = Uncertain("normal", item.nominal, -np.inf, np.inf, deviation)
        return System(known, adjusted=True, progress=self.progress)

    def random_starts(self, rng: np.random.Generator, count: int) -> Floats:
        """Return ``count`` random starts: scaled variables, a column each, known ones at their
        nominal values."""
        starts = rng.standard_normal((count, len(self.variables))).T
        for i, name in enumerate(self.variables):
            if name in self.nominal:
                starts[i] = self.nominal[name] / self.scales[i]
        return starts

    def starts_at(self, other: "System", x: Array, rng: np.random.Generator) -> Floats:
        """Return starts with the velocities and impulses of the impacts ``x`` of other equations of
        the same problem."""
        starts, state = self.random_starts(rng, x.shape[1]), other.state(x)
        for row, name in enumerate(self.variables):
            if name in VELOCITIES or name in IMPULSES:
                starts[row] = state[name] / self.scales[row]
        return starts

    @property
    def condition_count(self) -> int:
        """The number of conditions, limits too."""
        return len(self.conditions) + len(self.limits)

    def _typical_speed(self) -> Any:
        """Return the largest known velocity: spins times the radius of gyration, energies as the
        velocity they give the reduced mass; 1 if all are 0."""
        sizes: list[Any] = [np.float64(0.0)]
        for name, value in self.nominal.items():
            rule, size = quantity(name).unit, np.abs(value)
            if rule == "length/time" or name in SPINS:
                sizes.append(size * self.gyration if name in SPINS else size)
            elif rule == quantity("EL").unit:
                sizes.append(np.sqrt(2 * size / self.mass))
        largest = reduce(np.maximum, sizes)
        return np.where(largest == 0, 1.0, largest)[()]

    def scale(self, name: str) -> Any:
        """Return the size of an ordinary quantity ``name``, in the problem's units."""
        is_inertia = name in ("MA", "MB", "IA", "IB")
        return abs(self.nominal[name]) if is_inertia else self.sizes[quantity(name).unit]

    def state(
        self, x: Array, data: Mapping[str, Array] | None = None, geometry: Geometry | None = None
    ) -> State:
        """Return the impact with these variables. ``data`` replaces known values (when nothing is
        adjusted); ``geometry`` is computed from them where it is not given."""
        variables = {
            n: row * scale for n, row, scale in zip(self.variables, x, self.scales, strict=True)
        }
        if geometry is None and not (data and set(data) & set(GEOMETRY)):
            geometry = self.geometry
        return State({**self.constants, **(data or {}), **variables}, geometry, self.from_after)

    def residuals(self, state: State, targets: Mapping[str, Any] | None = None) -> Array:
        """Return the scaled residuals of conditions, then of observations: rows, one column an
        impact. ``targets`` replaces known values."""
        targets = {**self.nominal, **(targets or {})}
        rows = [state.law(n) / self.law_scale(n) for n in self.laws]
        rows += [self.exact_residual(state, n, targets) for n in self.exact]
        rows += [limit(state) for limit in self.limits]
        for name in self.observations:
            deviation = self.observed_value(state, name) - targets[name]
            rows.append(deviation / self.known[name].standard_deviation)
        # with the impulse, for the shape where there are none
        return np.stack(np.broadcast_arrays(state.values["PN"], *rows))[1:]

    def observed_value(self, state: State, name: str) -> Any:
        """Return the value that an observation is compared with: a variable, or a quantity of the
        state."""
        return state.values[name] if name in self.variables else state[name]

    def law_scale(self, coefficient: str) -> Any:
        """Return the scale of a law's residual: a velocity, a spin for EM, an impulse for MUP (but
        for the pivot's condition, which is on a velocity)."""
        if coefficient == "MUP" and not np.all(self.nominal["MUP"] == PIVOT):
            return self.mass * self.speed
        return self.speed / (self.gyration if coefficient == "EM" else 1.0)

    def exact_residual(self, state: State, name: str, targets: Mapping[str, Any]) -> Any:
        """Return the scaled residual of one exact value. A direction's is the component across
        it."""
        if name in DIRECTIONS:
            return state.along_and_across(name)[1] / (
                self.speed * (self.mass if name in FORCES else 1.0)
            )
        if name in CRUSH:
            parts = state.crush_energy("A") + state.crush_energy("B")
            return (state["EL"] - parts) / self.scale("EL")
        if name in SPEEDS:
            course = COURSE_OF[name]
            size = state.along_and_across(course)[0] if course in self.known else state[name]
            value = state.values[name] if name in self.variables else targets[name]
            return (size - value) / self.speed
        return (state[name] - targets[name]) / self.scale(name)

    def linearize(self, x: Array, rows: Callable[[State], Any]) -> tuple[Floats, Floats]:
        """Return ``rows(state)`` (rows, impacts) and its derivatives over the scaled variables
        (rows, variables, impacts), by complex steps."""
        size, count = len(self.variables), x.shape[1]
        self.progress(count)
        offset_points = x[:, None] + 1j * COMPLEX_STEP * np.eye(size)[:, :, None]
        values = rows(self.state(offset_points))
        values = np.broadcast_to(values, (len(values), size, count))
        return np.real(values[:, 0]), np.imag(values) / COMPLEX_STEP

    def jacobian(self, x: Array) -> Floats:
        """Return the derivatives of the residuals over the scaled variables (rows, variables), of
        one impact."""
        return self.linearize(x, self.residuals)[1][:, :, 0]

    def gradients(self, x: Array, names: Sequence[str]) -> Floats:
        """Return the derivatives of quantities, or of known values that are adjusted (rows), over
        the scaled variables."""
        adjusted = {*self.variables} - {*QUANTITIES}

        def rows(state: State) -> Array:
            values = (state.values[n] if n in adjusted else state[n] for n in names)
            # with the impulse, for the shape where there are none
            return np.stack(np.broadcast_arrays(state.values["PN"], *values))[1:]

        return self.linearize(x, rows)[1][:, :, 0]
