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
from ...names import FINAL_STATE, PIVOT, VELOCITIES, quantity

Floats = NDArray[np.float64]

ROUNDING = 1e-9  # a law missed by less, relative to its largest term, holds
NAMES = {
    "n": "momentum along n",
    "t": "momentum along t",
    "x": "momentum along x",
    "y": "momentum along y",
    "angular": "angular momentum",
    "E": "restitution",
    "MUP": "friction",
    "EM": "the moment coefficient's law",
}
# Known values that follow from velocities alone
QUANTITIES = (*SPEEDS, *CHANGES, *CONTACT, *ENERGIES)
_SPINS = ("WA", "WB", "WAF", "WBF")
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
        verb = "balance" if self.law in ("n", "t", "x", "y", "angular") else "hold"
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
    if not {"MA", "MB"} <= {*known}:
        return ()
    values, mass_model = _with_components(known), np.float64(known.get("M", 6.0))
    dimensions = {n: np.float64(values[n]) for n in GEOMETRY if n in values}
    geometry = Geometry(dimensions | {"M": mass_model})
    values = {"IA": 1.0, "IB": 1.0, **values}
    if geometry.point:
        values |= dict.fromkeys(_SPINS, 0.0)
    names = (*VELOCITIES, *FINAL_STATE)
    rows = _rows(values, geometry)
    if geometry.point:
        rows = {law: row for law, row in rows.items() if law not in ("angular", "EM")}
    if "GA" not in values:  # n and t stand for x and y
        rows = {{"n": "x", "t": "y"}.get(law, law): row for law, row in rows.items()}
    laws = [law for law, row in rows.items() if np.isfinite(row).all()]
    missed = _missed_quantities(known, values, geometry)
    if not laws:
        return missed
    matrix = np.array([rows[law] for law in laws])
    velocities = np.array([values.get(n, 0.0) for n in names], float)
    is_unknown = np.array([n not in values for n in names])
    # spins are compared as velocities at the radius of gyration
    gyration = math.sqrt(float(geometry.inverse_mass / geometry.inverse_spin_inertia))
    units = np.array([1 / gyration if n in _SPINS else 1.0 for n in names])
    speed = float(np.abs(velocities / units).max(initial=0.0))
    law_sizes = np.abs(matrix * units).max(axis=1) * speed
    residuals, coefficients = matrix @ velocities, matrix[:, is_unknown] * units[is_unknown]
    alone = [*missed]
    for i, law in enumerate(laws):
        residual = float(abs(residuals[i]))
        if law_sizes[i] and residual > ROUNDING * law_sizes[i]:
            largest = float(np.abs(matrix[i] * velocities).max(initial=0.0))
            if np.abs(coefficients[i]).max(initial=0.0) <= 1e-12 * law_sizes[i] / speed:
                given, present = _coefficient(law, values, geometry, velocities)
                alone.append(
                    MissedLaw(law, _MEASURED_AS[law], residual, residual / largest, given, present)
                )
    return tuple(alone) or _missed_together(laws, residuals, coefficients, law_sizes, speed)


def _missed_quantities(
    known: Mapping[str, float], values: Mapping[str, float], geometry: Any
) -> tuple[MissedLaw, ...]:
    """Return the known values that contradict the velocities they follow from, where these are all
    known."""
    state = State.of_known({name: np.float64(x) for name, x in values.items()})
    state.here = geometry
    contradictions = []
    for name in QUANTITIES:
        if name not in known or {*SPEEDS.get(name, ())} & {*values} - {*known}:
            continue  # the components were computed from it
        given, present = known[name], float(np.real(state[name]))
        # the loss is a difference of two energies
        largest = float(np.real(state.initial_energy)) if name == "EL" else abs(present)
        largest = max(largest, abs(given), 1.0 if name == "LOSS" else 0.0)
        deviation = abs(present - given)
        if math.isfinite(deviation) and deviation > ROUNDING * largest:
            contradictions.append(
                MissedLaw(name, name, deviation, deviation / largest, given, present)
            )
    return tuple(contradictions)


def _missed_together(
    laws: list[str], residuals: Floats, coefficients: Floats, sizes: Floats, speed: float
) -> tuple[MissedLaw, ...]:
    """Return the smallest set of laws that cannot hold together, each with its residual where the
    others of the set hold."""
    if not speed or not coefficients.shape[1]:
        return ()
    units = np.where(sizes > 0, sizes, 1.0)
    matrix, right = coefficients * speed / units[:, None], residuals / units

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
