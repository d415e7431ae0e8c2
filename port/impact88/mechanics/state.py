"""An impact known from its vehicles, initial velocities and impulse: everything else follows.

Equations 13, 14 and 17 are "velocity after = velocity before + impulse / inertia" for each vehicle:
a `State` obeys them whatever its numbers are. Equations 15, 16 and 18 are its `law`s. All is made
of sums, products, roots and quotients, over numbers or arrays, real or complex (an imaginary part
carries a derivative).
"""

import math
from collections.abc import Collection, Iterable, Mapping
from functools import cached_property, lru_cache, reduce
from typing import Any, Self

import numpy as np

from .. import names
from ..collision.geometry import Geometry, facing, sin_cos_with_slopes
from ..names import COEFFICIENTS, FINAL_STATE, IMPULSES, PIVOT, VELOCITIES
from .closedform.energy import kinetic_energy

SPEEDS = {"SA": ("UX", "UY"), "SB": ("VX", "VY"), "SAF": ("VAX", "VAY"), "SBF": ("VBX", "VBY")}
"""Speeds, each with its velocity's components."""
COURSES = {"HA": "SA", "HB": "SB", "HAF": "SAF", "HBF": "SBF"}
"""The speed that belongs to each course, the direction of that velocity from the x axis."""
COURSE_OF = {speed: course for course, speed in COURSES.items()}
FORCES = {"PDOFA": "A", "PDOFB": "B"}
"""Directions the force on a vehicle comes from, in degrees clockwise from its front."""
DIRECTIONS = (*COURSES, *FORCES)
COURSE = math.nan
"""TA or TB of a vehicle that faces the way it travels: as its velocity before the impact does, or,
of a vehicle at rest, that after it."""
COURSE_AFTER = math.inf
"""The same of a vehicle that may have stood: as its velocity after the impact does."""
BARRIER_SPEEDS = {"EBSA": "ELA", "EBSB": "ELB"}
"""Equivalent barrier speeds, each with the energy it stands for."""
CRUSH = ("ELA", "ELB", *BARRIER_SPEEDS)
"""Energies lost in each vehicle, which sum to EL: given for both or for neither."""
CONTACT = ("VC", "VS")
CHANGES = ("DVA", "DVB", "DVAF", "DVAR", "DVBF", "DVBR")
ENERGIES = ("KI", "KF", "EL", "LOSS", "DT")
QUANTITIES = (
    *VELOCITIES,
    *FINAL_STATE,
    *COEFFICIENTS,
    *IMPULSES,
    *SPEEDS,
    *COURSES,
    *CHANGES,
    *ENERGIES,
    *CONTACT,
    *FORCES,
)
"""Names of the quantities of a `State`."""
OTHERS = (
    *(name for pair in zip(SPEEDS, COURSES, strict=True) for name in pair),
    *CHANGES,
    *ENERGIES,
    *CRUSH,
    *CONTACT,
    *FORCES,
)
"""Quantities that only `adjustment` takes as known, not `unknowns.solve_for`."""
KNOWABLE = (*names.SCENE, "MUP", *names.FINAL_VELOCITIES, *OTHERS)
"""Quantities that may be known of an impact."""


REST_TOLERANCE = 1e-9
"""A speed below this fraction of the largest is rounding, and printed as 0."""


NO_SLIDING = 1e-14
"""Sliding below this fraction of the largest velocity is rounding, and has no sign."""


def without_rounding(sliding: Any, velocities: Iterable[Any]) -> Any:
    """Return sliding velocities, 0 where they are rounding of the ``velocities`` they are of."""
    largest = reduce(np.maximum, map(np.abs, velocities))
    return np.where(np.abs(sliding) <= NO_SLIDING * largest, 0.0, sliding)


class State:
    """``values``: vehicles and geometry, IMPULSES, and each of VELOCITIES or, where it stands in
    ``from_after``, the velocity after the impact instead; for laws the coefficients too."""

    def __init__(
        self,
        values: Mapping[str, Any],
        geometry: Geometry | None = None,
        from_after: Collection[str] = (),
    ) -> None:
        self.values = values
        self.here = Geometry(values) if geometry is None else geometry
        self.from_after = from_after

    @classmethod
    def of_known(cls, values: Mapping[str, Any]) -> Self:
        """Return the state with the known ones among velocities, before and after, and impulses;
        what does not follow from them is NaN."""
        early, late = ([values.get(n, np.nan) for n in six] for six in (VELOCITIES, FINAL_STATE))
        state = cls({**dict.fromkeys(IMPULSES, np.nan), **values})
        state.before, state.after = early, late
        state.changes = [after - before for before, after in zip(early, late, strict=True)]
        state.energy_lost = state.initial_energy - state._energy(late)
        return state

    @property
    def impulse_on_a(self) -> tuple[Any, Any]:
        """The impulse on A along x and y: as PN and PT give it, else by the change of momentum."""
        pn, pt, _ = self.impulse
        x = pn * self.here.cosine - pt * self.here.sine
        y = pn * self.here.sine + pt * self.here.cosine
        for vehicle, sign in (("A", 1.0), ("B", -1.0)):
            mass = sign * self.values["M" + vehicle]
            is_unknown = np.isnan(np.real(x + y))
            if is_unknown.any():
                change_x, change_y = self.change(vehicle)
                x = np.where(is_unknown, mass * change_x, x)
                y = np.where(is_unknown, mass * change_y, y)
        return x, y

    @property
    def impulse(self) -> list[Any]:
        return [self.values[name] for name in IMPULSES]

    @cached_property
    def changes(self) -> list[Any]:
        return self.here.changes(*self.impulse)

    @cached_property
    def before(self) -> list[Any]:
        return [
            self.values[late] - change if early in self.from_after else self.values[early]
            for early, late, change in zip(VELOCITIES, FINAL_STATE, self.changes, strict=True)
        ]

    @cached_property
    def after(self) -> list[Any]:
        return [
            self.values[late] if early in self.from_after else self.values[early] + change
            for early, late, change in zip(VELOCITIES, FINAL_STATE, self.changes, strict=True)
        ]

    @cached_property
    def relative_before(self) -> tuple[Any, Any, Any]:
        return self.here.relative(self.before)

    @property
    def sliding(self) -> Any:
        """Tangential relative velocity of the contact points before the impact, real numbers."""
        return without_rounding(np.real(self.relative_before[1]), map(np.real, self.before))

    @cached_property
    def relative_after(self) -> tuple[Any, Any, Any]:
        return self.here.relative(self.after)

    @property
    def slip_changes(self) -> tuple[Any, Any]:
        """Changes of the sliding velocity by the normal and the moment impulse, and by a unit of
        the tangential impulse."""
        here, (pn, _, moment) = self.here, self.impulse
        a, b = here.inverse_ia, here.inverse_ib
        by_normal = here.an * here.at * a + here.bn * here.bt * b
        by_moment = here.at * a - here.bt * b
        yielding = here.inverse_mass + here.at * here.at * a + here.bt * here.bt * b
        return by_normal * pn + by_moment * np.where(here.point, 0.0, moment), yielding

    def law(self, coefficient: str) -> Any:
        """Return the residual of Equation 15 (E), 16 (MUP) or 18 (EM): a velocity, an impulse or a
        spin, 0 where the equation holds. MUP = -10 is the pivot: the residual is the tangential
        relative velocity afterwards."""
        value = self.values[coefficient]
        if coefficient == "MUP" and np.all(value == PIVOT):
            return self.relative_after[1]
        above, below = self.quotient(coefficient)
        if coefficient == "MUP" and (critical := self.values.get("MUC")):
            value = value * self.critical_friction / critical
        return above - value * below

    @cached_property
    def critical_friction(self) -> Any:
        """P_t/P_n of the impact whose contact points end their sliding at separation, by Equations
        15 and 18 with the pivot's condition."""
        normal, tangential = self.pivot_impulse
        return tangential / normal

    @cached_property
    def pivot_impulse(self) -> tuple[Any, Any]:
        """P_n and P_t of that impact."""
        here = self.here
        e, em = (self.values.get(name) for name in ("E", "EM"))
        e = self["E"] if e is None else e
        em = self["EM"] if em is None else em
        normal, tangential, spin = self.relative_before
        # changes of the relative velocities by a unit of P_n, P_t and M
        units = [here.relative(here.changes(*row)) for row in np.eye(3)]
        moment = [(1 - em) * unit[2] for unit in units]
        moment[2] = moment[2] - em * here.inverse_spin_inertia
        last = np.where(here.point, 0.0, -(1 - em) * spin)
        moment = [np.where(here.point, float(i == 2), row) for i, row in enumerate(moment)]
        rows = [[unit[0] for unit in units], [unit[1] for unit in units], moment]
        right = [-(1 + e) * normal, -tangential, last]
        return _first_two_unknowns(rows, right)

    def __getitem__(self, name: str) -> Any:
        """Return a quantity by name; coefficients follow from velocities and impulse."""
        if name in VELOCITIES:
            return self.before[VELOCITIES.index(name)]
        if name in IMPULSES:
            return self.values[name]
        if name in FINAL_STATE:
            return self.after[FINAL_STATE.index(name)]
        if name in SPEEDS:
            return _size(*self._components(name))
        if name in COURSES:
            return self._course_of(COURSES[name])
        if name in COEFFICIENTS:
            above, below = self.quotient(name)
            return above / below
        if name in CHANGES:
            return self._change(name)
        if name in FORCES:
            return self._pdof(name)
        if name in CONTACT:
            return -self.relative_before[0] if name == "VC" else self.relative_after[0]
        lost, initial = self.energy_lost, self.initial_energy
        if name in ("LOSS", "DT"):
            return (100.0 if name == "LOSS" else 1.0) * lost / initial
        return {"KI": initial, "KF": initial - lost, "EL": lost}[name]

    def _course_of(self, speed: str) -> Any:
        """Return the course of a speed; NaN for a vehicle at rest: a zero has no direction, and
        neither has the rounding of velocities that cancel."""
        x, y = self._components(speed)
        sizes = [np.abs(np.real(v)) for v in (*self.before, *self.after)]
        del sizes[2::3]  # spins
        largest = reduce(np.fmax, sizes)
        at_rest = np.hypot(np.real(x), np.real(y)) <= REST_TOLERANCE * largest
        return np.where(at_rest, np.nan, course(x, y))

    def _components(self, speed: str) -> tuple[Any, Any]:
        x, y = SPEEDS[speed]
        return self[x], self[y]

    def along_and_across(self, direction: str, value: Any = None) -> tuple[Any, Any]:
        """Return the components of a velocity along and across its given course, or of the impulse
        along and across its given PDOF, or another ``value``; the second is 0 where the direction
        agrees."""
        (x, y), (cosine, sine) = self._vector(direction), self._unit_vector(direction, value)
        return x * cosine + y * sine, y * cosine - x * sine

    def _vector(self, direction: str) -> tuple[Any, Any]:
        if direction in COURSES:
            return self._components(COURSES[direction])
        x, y = self.impulse_on_a
        sign = 1.0 if direction == "PDOFA" else -1.0
        return sign * x, sign * y

    def _facing(self, vehicle: str) -> Any:
        """Return the direction of a vehicle's front; NaN where it is not known."""
        theta = self.values.get("T" + vehicle)
        if theta is None:
            return np.nan
        front = facing(vehicle, theta)
        travels = ~np.isfinite(np.real(front))  # `COURSE`, `COURSE_AFTER`
        if not travels.any():
            return front
        return np.where(travels, self._course(vehicle, np.isinf(np.real(front))), front)

    def _course(self, vehicle: str, stood: Any) -> Any:
        """Return the way a vehicle travels before the impact, after it if it ``stood`` or was at
        rest; NaN if it does not move."""
        early, late = (self._course_of(f"S{vehicle}{suffix}") for suffix in ("", "F"))
        stood = (stood & ~np.isnan(np.real(late))) | np.isnan(np.real(early))
        return np.where(stood, late, early)

    def _unit_vector(self, direction: str, value: Any = None) -> tuple[Any, Any]:
        """Return the unit vector of a given course or PDOF, or of another ``value``."""
        value = self.values[direction] if value is None else value
        if direction in FORCES:
            value = self._facing(FORCES[direction]) + 180 - value
        return _unit(value)

    def _pdof(self, name: str) -> Any:
        """Return a PDOF in degrees, above -180 and up to 180; NaN without impulse."""
        return pdof(self._facing(FORCES[name]), *self._vector(name))

    # -- quantities

    def quotient(self, coefficient: str) -> tuple[Any, Any]:
        """Return numerator and denominator of E, MUP or EM; a denominator of 0 means no value."""
        pn, pt, moment = self.impulse
        if coefficient == "E":
            return -self.relative_after[0], self.relative_before[0]
        if coefficient == "MUP":
            return pt, pn
        spin = self.relative_after[2]
        return spin, spin + moment * self.here.inverse_spin_inertia

    def crush_energy(self, vehicle: str) -> Any:
        """Return the energy lost in a vehicle, from the known one of ELA (ELB) and EBSA (EBSB)."""
        speed = self.values.get("EBS" + vehicle)
        if speed is None:
            return self.values["EL" + vehicle]
        return 0.5 * self.values["M" + vehicle] * speed * speed

    def contact_velocities(self) -> dict[str, Any]:
        """Return XA YA XB YB of the contact points, and XAF ... YBF (lines 340, 700 and 710)."""
        velocities, here = {}, self.here
        arms = (("A", 0, here.d3, -here.d4), ("B", 3, -here.d1, here.d2))
        for suffix, six in (("", self.before), ("F", self.after)):
            for vehicle, first, arm_x, arm_y in arms:
                x, y, spin = six[first : first + 3]
                spin = np.where(here.point, 0.0, spin)
                velocities[f"X{vehicle}{suffix}"] = x + arm_x * spin
                velocities[f"Y{vehicle}{suffix}"] = y + arm_y * spin
        return velocities

    def change(self, vehicle: str) -> tuple[Any, Any]:
        """Return a vehicle's change of velocity along x and y."""
        x, y = self.changes[:2] if vehicle == "A" else self.changes[3:5]
        return x, y

    def _change(self, name: str) -> Any:
        """Return a vehicle's change of velocity: its size, or its component forward (F) or to the
        right (R)."""
        vehicle, part = name[2], name[3:]
        x, y = self.change(vehicle)
        if not part:
            return _size(x, y)
        cosine, sine = _unit(self._facing(vehicle))
        return x * cosine + y * sine if part == "F" else x * sine - y * cosine

    def _energy(self, velocities: list[Any]) -> Any:
        inertias = [
            np.where(np.isinf(np.real(inertia)), 0, inertia)
            for inertia in (self.values.get(n, 1.0) for n in ("MA", "MB", "IA", "IB"))
        ]
        six = list(velocities)
        point = np.asarray(np.real(self.values.get("M", 6.0))) == 4
        six[2], six[5] = (np.where(point, 0.0, six[i]) for i in (2, 5))
        return kinetic_energy(inertias, six)

    @cached_property
    def initial_energy(self) -> Any:
        return self._energy(self.before)

    @cached_property
    def energy_lost(self) -> Any:
        """Work of the impulse at the mean relative velocities, negated: it does not lose digits as
        the difference of two energies would."""
        parts = zip(self.impulse, self.relative_before, self.relative_after, strict=True)
        return -0.5 * sum(part * (early + late) for part, early, late in parts)


def _first_two_unknowns(rows: list[list[Any]], right: list[Any]) -> tuple[Any, Any]:
    """Return the first two unknowns of three linear equations, by Cramer's rule."""

    def determinant(a: list[Any], b: list[Any], c: list[Any]) -> Any:
        return (
            a[0] * (b[1] * c[2] - b[2] * c[1])
            - b[0] * (a[1] * c[2] - a[2] * c[1])
            + c[0] * (a[1] * b[2] - a[2] * b[1])
        )

    columns = [[row[i] for row in rows] for i in range(3)]
    total = determinant(*columns)
    first = determinant(right, columns[1], columns[2])
    second = determinant(columns[0], right, columns[2])
    return first / total, second / total


def _size(x: Any, y: Any) -> Any:
    return np.sqrt(x * x + y * y)


def _unit(degrees: Any) -> tuple[Any, Any]:
    sine, cosine = (
        _of_number(degrees) if isinstance(degrees, float) else sin_cos_with_slopes(degrees)
    )
    return cosine, sine


_of_number = lru_cache(maxsize=64)(sin_cos_with_slopes)
"""`sin_cos_with_slopes` of numbers, cached: exactly known angles recur at every evaluation."""


def pdof(front: Any, x: Any, y: Any) -> Any:
    """Return where a force along (x, y) comes from, in degrees clockwise from the ``front`` (its
    direction in degrees), above -180 and up to 180; NaN without force."""
    clockwise = front + 180 - course(x, y)
    angle = clockwise - 360 * np.ceil((np.real(clockwise) - 180) / 360)
    return np.where((x == 0) & (y == 0), np.nan, angle)


def course(x: Any, y: Any) -> Any:
    """Return the direction of (x, y) in degrees; its imaginary part carries the derivative."""
    real = np.degrees(np.arctan2(np.real(y), np.real(x)))
    if not (np.iscomplexobj(x) or np.iscomplexobj(y)):
        return real
    square = np.square(np.real(x)) + np.square(np.real(y))
    turn = (np.real(x) * np.imag(y) - np.real(y) * np.imag(x)) / square
    return real + 1j * np.degrees(turn)
