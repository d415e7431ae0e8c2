"""The laws that exact values violate, and by how much.

With exact geometry and coefficients Equations 13 to 18 are linear in the twelve velocities:
momentum along n and t, angular momentum about the contact point, restitution, friction and moment
(point masses have neither spins nor moment). A law without unknowns is tested by itself, whatever
else is undetermined; so is a speed, a change of velocity or an energy whose velocities are all
known. If these hold, the smallest set of laws that cannot hold together is reported."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import GEOMETRY, Geometry, within_doubles
from ...collision.units import RULES, System
from ...mechanics.state import CHANGES, CONTACT, COURSES, ENERGIES, SPEEDS, State
from ...messages.plaintable import number
from ...names import FINAL_STATE, PIVOT, SPINS, VELOCITIES, quantity

Floats = NDArray[np.float64]

ROUNDING = 1e-9  # a law missed by less, relative to its largest term, holds
NAMED = 1e-3  # a law is named from this fraction of the one missed most
NAMES = {
    "n": "momentum along n",
    "t": "momentum along t",
    "x": "momentum along x",
    "y": "momentum along y",
    "angular": "angular momentum",
    "E": "restitution",
    "MUP": "friction",
    "EM": "the moment coefficient's law",
    "changes": "momentum (MA DVA = MB DVB)",
}
# Known values that follow from velocities alone
QUANTITIES = (*SPEEDS, *CHANGES, *CONTACT, *ENERGIES)
_MOTION = (*VELOCITIES, *FINAL_STATE)
# For each law a quantity of the same unit
_MEASURED_AS = {
    "n": "PN",
    "t": "PT",
    "x": "PN",
    "y": "PT",
    "angular": "PM",
    "E": "VC",
    "MUP": "PT",
    "EM": "WA",
}


@dataclass(frozen=True)
class MissedLaw:
    """One law that exact values violate.

    ``amount``: the residual, in the unit of the quantity ``like``; ``fraction``: the same over the
    largest term. ``given`` and ``present``: the coefficient as known and as the velocities give it,
    nan where there is none. ``alone``: True if the law has no unknowns; else it is violated where
    the others reported with it hold."""

    law: str
    like: str
    amount: float
    fraction: float
    given: float = math.nan
    present: float = math.nan
    alone: bool = True

    @property
    def name(self) -> str:
        """Name of the law, or of the quantity."""
        if self.law in NAMES:
            return NAMES[self.law]
        return f"{self.law} ({quantity(self.law).meaning})"

    @property
    def _failure(self) -> str:
        """The law and that it fails; the amount follows."""
        verb = "hold" if self.law in ("E", "MUP", "EM") else "balance"
        return f"{self.name} does not {verb}: the error is"

    def text(self, units: System = RULES) -> str:
        """Return the law and by how much it is missed."""
        unit = units.unit(self.like)
        amount = f"{number(self.amount * abs(units.factor(self.like)), 4)} {unit}".rstrip()
        text = f"{self._failure} {amount}"
        if self.law not in NAMES:
            text = f"{self.name} is missed by {amount}"
            present, given = (
                number(units.display_unwrapped(self.law, x), 6) for x in (self.present, self.given)
            )
            return f"{text} ({present} by the velocities, {given} is given)"
        if not math.isnan(self.present):
            text += f" ({self.law} {number(self.present, 4)} where {number(self.given, 4)} is given"
            return text + ")"
        return f"{text} ({number(100 * self.fraction, 2)} % of its largest term)"

    def relative_text(self) -> str:
        """Return the law and by how much it is missed, in percent of its largest term."""
        percent = number(100 * self.fraction, 2)
        return f"{self._failure} {percent} % of its largest term"


def describe_laws(missed: tuple[MissedLaw, ...], units: System | None = None) -> str:
    """Return the violated laws as one phrase, "" for none; without ``units`` as percentages."""
    texts = [law.relative_text() if units is None else law.text(units) for law in missed]
    if missed and not missed[0].alone:
        return " or ".join(texts) + ", where the others of these hold"
    return "; ".join(texts)


@within_doubles
def missed_laws(known: Mapping[str, float]) -> tuple[MissedLaw, ...]:
    """Return the laws that exact values violate: those without unknowns if any, else the smallest
    set that cannot hold together; empty where no law can be named.

    ``known``: vehicles, geometry and exact values, friction as MUP."""
    laws = _KnownLaws.of(known)
    if laws is None:
        return ()
    violations = [*_missed_quantities(known, laws.values, laws), *laws.missed_alone()]
    if not violations:
        violations = [*_missed_together(laws)]
    if not violations:
        violations = [*_missed_quantities(known, laws.with_determined_velocities(), laws)]
    largest = max((law.fraction for law in violations), default=0.0)
    return tuple(law for law in violations if law.fraction >= NAMED * largest)


@within_doubles
def tested_laws(known: Mapping[str, float]) -> tuple[str, ...]:
    """Return names of the laws and quantities by which exact values test one another: those
    without unknowns, of which not all terms are 0; one nameless one for each that several laws
    together test."""
    laws = _KnownLaws.of(known)
    if laws is None:
        return ()
    is_open, is_trivial = laws.is_open, laws.largest_terms <= ROUNDING * laws.sizes
    alone = [NAMES[laws.names[i]] for i in np.flatnonzero(~is_open & ~is_trivial)]
    quantities = [name for name, *_ in _tested_quantities(known, laws.values, laws)]
    rows = laws.coefficients[is_open] / laws.sizes[is_open, None]
    rows = rows[np.isfinite(rows).all(axis=1)]
    rank = int(np.linalg.matrix_rank(rows, tol=1e-10)) if rows.size else 0
    return (*alone, *quantities, *[""] * (len(rows) - rank))


@dataclass(frozen=True)
class _KnownLaws:
    """The linear laws over the twelve velocities (``matrix``: a row each), with the known ones."""

    names: list[str]
    values: dict[str, float]
    geometry: Any
    matrix: Floats
    velocities: Floats
    is_unknown: NDArray[np.bool_]
    units: Floats
    speed: float

    @classmethod
    def of(cls, known: Mapping[str, float]) -> "_KnownLaws | None":
        """Return the laws, None without masses."""
        if not {"MA", "MB"} <= {*known}:
            return None
        values, mass_model = _with_components(known), np.float64(known.get("M", 6.0))
        dimensions = {n: np.float64(values[n]) for n in GEOMETRY if n in values}
        geometry = Geometry(dimensions | {"M": mass_model})
        values = {"IA": 1.0, "IB": 1.0, **values}
        if geometry.point:
            values |= dict.fromkeys(SPINS, 0.0)
        rows = _rows(values, geometry)
        if geometry.point:
            rows = {law: row for law, row in rows.items() if law not in ("angular", "EM")}
        if "GA" not in values:  # n and t stand for x and y
            rows = {{"n": "x", "t": "y"}.get(law, law): row for law, row in rows.items()}
        laws = [law for law, row in rows.items() if np.isfinite(row).all()]
        velocities = np.array([values.get(n, 0.0) for n in _MOTION], float)
        # spins are compared as velocities at the radius of gyration
        gyration = math.sqrt(float(geometry.inverse_mass / geometry.inverse_spin_inertia))
        units = np.array([1 / gyration if n in SPINS else 1.0 for n in _MOTION])
        return cls(
            laws,
            values,
            geometry,
            np.array([rows[law] for law in laws]).reshape(len(laws), len(_MOTION)),
            velocities,
            np.array([n not in values for n in _MOTION]),
            units,
            float(np.abs(velocities / units).max(initial=0.0)),
        )

    @property
    def sizes(self) -> Floats:
        """The contribution of an ordinary velocity to each law."""
        return np.asarray(np.abs(self.matrix * self.units).max(axis=1, initial=0.0) * self.speed)

    @property
    def residuals(self) -> Floats:
        """The remainder that the known velocities leave of each law."""
        return np.asarray(self.matrix @ self.velocities)

    @property
    def largest_terms(self) -> Floats:
        """The largest term of each law among known velocities."""
        return np.asarray(np.abs(self.matrix * self.velocities).max(axis=1, initial=0.0))

    @property
    def coefficients(self) -> Floats:
        """The coefficients of unknown velocities."""
        return np.asarray(self.matrix[:, self.is_unknown] * self.units[self.is_unknown])

    @property
    def is_open(self) -> "NDArray[np.bool_]":
        """True for laws that contain unknown velocities."""
        least = 1e-12 * self.sizes / (self.speed or 1.0)
        return np.asarray(np.abs(self.coefficients).max(axis=1, initial=0.0) > least)

    def missed_alone(self) -> list[MissedLaw]:
        """Return the violated laws without unknowns."""
        violations, residuals = [], np.abs(self.residuals)
        is_missed = ~self.is_open & (self.sizes > 0) & (residuals > ROUNDING * self.sizes)
        for i in np.flatnonzero(is_missed):
            law, residual = self.names[i], float(residuals[i])
            fraction = residual / float(self.largest_terms[i])
            numbers = _coefficient(law, self.values, self.geometry, self.velocities)
            violations.append(MissedLaw(law, _MEASURED_AS[law], residual, fraction, *numbers))
        return violations

    def with_determined_velocities(self) -> dict[str, float]:
        """Return the values with those velocities that the laws determine."""
        if not self.is_unknown.any() or not self.speed:
            return self.values
        sizes = np.where(self.sizes > 0, self.sizes, 1.0)
        matrix = self.coefficients * self.speed / sizes[:, None]
        inverse = np.linalg.pinv(matrix, rcond=1e-10)
        velocities = -inverse @ (self.residuals / sizes) * self.speed * self.units[self.is_unknown]
        is_determined = np.abs(inverse @ matrix - np.eye(matrix.shape[1])).max(axis=1) < 1e-9
        names = [n for n, is_unknown in zip(_MOTION, self.is_unknown, strict=True) if is_unknown]
        rows = zip(names, velocities, is_determined, strict=True)
        return self.values | {name: float(x) for name, x, known in rows if known}


def _tested_quantities(
    known: Mapping[str, float], values: Mapping[str, float], laws: _KnownLaws
) -> list[tuple[str, float, float, float]]:
    """Return the known quantities whose velocities are all among ``values``, as they are given and
    as the velocities give them, and the largest term."""
    state = State.of_known({name: np.float64(x) for name, x in values.items()})
    state.here = laws.geometry
    rows = []
    for name in QUANTITIES:
        if name not in known or {*SPEEDS.get(name, ())} & {*laws.values} - {*known}:
            continue  # the components were computed from it
        present = float(np.real(state[name]))
        if math.isfinite(present):
            # the loss is a difference of two energies
            largest = float(np.real(state.initial_energy)) if name == "EL" else abs(present)
            largest = max(largest, abs(known[name]), 1.0 if name == "LOSS" else 0.0)
            rows.append((name, known[name], present, largest))
    return rows


def _missed_quantities(
    known: Mapping[str, float], values: Mapping[str, float], laws: _KnownLaws
) -> list[MissedLaw]:
    """Return the known quantities that contradict the velocities ``values``, and changes of
    velocity that contradict momentum."""
    violations = []
    for name, given, present, largest in _tested_quantities(known, values, laws):
        deviation = abs(present - given)
        if deviation > ROUNDING * largest:
            violations.append(MissedLaw(name, name, deviation, deviation / largest, given, present))
    if {"DVA", "DVB"} <= {*known}:
        impulses = [known["M" + vehicle] * known["DV" + vehicle] for vehicle in "AB"]
        deviation, largest = abs(impulses[0] - impulses[1]), max(impulses)
        if math.isfinite(largest) and deviation > ROUNDING * largest:
            violations.append(MissedLaw("changes", "PN", deviation, deviation / largest))
    return violations


def _missed_together(known: _KnownLaws) -> tuple[MissedLaw, ...]:
    """Return the smallest set of laws that cannot hold together, each with its residual where the
    others of the set hold."""
    if not known.speed or not known.is_unknown.any():
        return ()
    laws = known.names
    units = np.where(known.sizes > 0, known.sizes, 1.0)
    matrix, right = known.coefficients * known.speed / units[:, None], known.residuals / units

    def residual_given(law: int, rest: list[int]) -> float:
        x = -np.linalg.pinv(matrix[rest], rcond=1e-10) @ right[rest]
        return abs(float(right[law] + matrix[law] @ x))

    for count in range(2, len(laws) + 1):
        for subset in combinations(range(len(laws)), count):
            chosen = [*subset]
            x = -np.linalg.pinv(matrix[chosen], rcond=1e-10) @ right[chosen]
            if np.abs(right[chosen] + matrix[chosen] @ x).max() > ROUNDING:
                # fewer of them agree: each is missed where the others of these hold
                return tuple(
                    MissedLaw(
                        laws[i],
                        _MEASURED_AS[laws[i]],
                        relative_text * units[i],
                        relative_text,
                        alone=False,
                    )
                    for i in chosen
                    for relative_text in [residual_given(i, [k for k in chosen if k != i])]
                )
    return ()


def _with_components(known: Mapping[str, float]) -> dict[str, float]:
    """Return ``known`` with the components of velocities whose speed and course are known."""
    values = dict(known)
    for course, speed in COURSES.items():
        if course in values and speed in values:
            angle = math.radians(values[course])
            for name, part in zip(SPEEDS[speed], (math.cos(angle), math.sin(angle)), strict=True):
                values.setdefault(name, values[speed] * part)
    for mass_name, names in (("MA", VELOCITIES[:3]), ("MB", VELOCITIES[3:])):
        if math.isinf(values[mass_name]):
            values |= dict.fromkeys(names, 0.0)
    return values


def _rows(values: Mapping[str, float], geometry: Any) -> dict[str, Floats]:
    """Return the coefficients of each law over the velocities before and after."""
    unit_vectors = np.eye(12)
    before, after = unit_vectors[:6], unit_vectors[6:]
    changes = after - before
    cosine, sine = float(geometry.cosine), float(geometry.sine)

    def push(vehicle: str, first: int) -> tuple[Floats, Floats]:
        mass = values["M" + vehicle]
        x, y = changes[first], changes[first + 1]
        return mass * (x * cosine + y * sine), mass * (y * cosine - x * sine)

    (an, at), (bn, bt) = push("A", 0), push("B", 3)
    # what an impulse along n, or t, gives each vehicle of angular momentum
    units = [geometry.changes(*(np.float64(x) for x in row)) for row in np.eye(3)]
    arms = [(values["IA"] * float(unit[2]), values["IB"] * float(unit[5])) for unit in units]
    if math.isinf(values["MA"]):
        pn, pt = -bn, -bt
        moment = (values["IB"] * changes[5] + bn * arms[0][1] + bt * arms[1][1]) / arms[2][1]
    else:
        pn, pt = an, at
        moment = (values["IA"] * changes[2] - an * arms[0][0] - at * arms[1][0]) / arms[2][0]
    rows = {"n": an + bn, "t": at + bt}
    turning_a = values["IA"] * changes[2] - an * arms[0][0] - at * arms[1][0]
    turning_b = values["IB"] * changes[5] + bn * arms[0][1] + bt * arms[1][1]
    rows["angular"] = turning_a + turning_b
    early, late = geometry.relative([*before]), geometry.relative([*after])
    if "E" in values:
        rows["E"] = late[0] + values["E"] * early[0]
    if "MUP" in values:
        rows["MUP"] = late[1] if values["MUP"] == PIVOT else pt - values["MUP"] * pn
    if "EM" in values:
        denominator = late[2] + moment * float(geometry.inverse_spin_inertia)
        rows["EM"] = late[2] - values["EM"] * denominator
    return {law: np.asarray(row, np.float64) for law, row in rows.items()}


def _coefficient(
    law: str, values: Mapping[str, float], geometry: Any, velocities: Floats
) -> tuple[float, float]:
    """Return a coefficient as known and as the velocities give it; nan for other laws."""
    if law not in ("E", "MUP", "EM") or (law == "MUP" and values["MUP"] == PIVOT):
        return math.nan, math.nan
    zero, one = (float(_rows({**values, law: x}, geometry)[law] @ velocities) for x in (0.0, 1.0))
    return values[law], zero / (zero - one) if zero != one else math.nan
