"""Which law exact values break, and by how much.

With exact geometry and coefficients Equations 13 to 18 are linear in the twelve velocities:
momentum along n and t, angular momentum about the contact point, restitution, friction and moment
(point masses have neither spins nor moment). A law of which nothing is unknown is tested by itself,
whatever else is not determined; so is a speed, a change of velocity or an energy whose velocities
are all known; else the fewest laws that cannot hold together are told.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..collision.geometry import GEOMETRY, Geometry, within_doubles
from ..collision.units import RULES, System
from ..mechanics.state import CHANGES, CONTACT, COURSES, ENERGIES, SPEEDS, State
from ..messages.plaintable import number
from ..names import FINAL_STATE, PIVOT, VELOCITIES, quantity

Floats = NDArray[np.float64]

ROUNDING = 1e-9
"""A law missed by no more, of the largest of its terms, holds."""
NAMES = {
    "n": "momentum along n",
    "t": "momentum along t",
    "angular": "angular momentum",
    "E": "restitution",
    "MUP": "friction",
    "EM": "the moment coefficient's law",
}
"""The laws, by what they are kept under."""
QUANTITIES = (*SPEEDS, *CHANGES, *CONTACT, *ENERGIES)
"""Known values that velocities alone make."""
_SPINS = ("WA", "WB", "WAF", "WBF")
_MEASURED_AS = {"n": "PN", "t": "PT", "angular": "PM", "E": "VC", "MUP": "PT", "EM": "WA"}
"""For each law a quantity of its unit."""


@dataclass(frozen=True)
class Missed:
    """One law that exact values miss: ``amount``, in the unit of the quantity ``like``;
    ``fraction`` of the largest of its terms; ``given`` and ``present``: the coefficient as known
    and as the velocities have it, nan where there is none; ``alone``: nothing in it is unknown,
    else it is missed where the others told with it hold."""

    law: str
    like: str
    amount: float
    fraction: float
    given: float = math.nan
    present: float = math.nan
    alone: bool = True

    @property
    def name(self) -> str:
        """The law, or the quantity, in words."""
        if self.law in NAMES:
            return NAMES[self.law]
        return f"{self.law} ({quantity(self.law).meaning})"

    def text(self, units: System = RULES) -> str:
        """Return the law and by how much it is missed."""
        unit = units.unit(self.like)
        amount = f"{number(self.amount * abs(units.factor(self.like)), 4)} {unit}".rstrip()
        text = f"{self.name} is missed by {amount}"
        if self.law not in NAMES:
            present, given = (
                number(units.display_unwrapped(self.law, x), 6) for x in (self.present, self.given)
            )
            return f"{text} ({present} by the velocities, {given} is given)"
        if not math.isnan(self.present):
            text += f" ({self.law} {number(self.present, 4)} where {number(self.given, 4)} is given"
            return text + ")"
        return f"{text} ({number(100 * self.fraction, 2)} % of its largest term)"

    def share(self) -> str:
        """Return the same without a unit."""
        share = number(100 * self.fraction, 2)
        return f"{self.name} is missed by {share} % of its largest term"


def told(missed: tuple[Missed, ...], units: System | None = None) -> str:
    """Return the laws missed in one phrase, "" for none; without ``units`` as percentages."""
    texts = [law.share() if units is None else law.text(units) for law in missed]
    if missed and not missed[0].alone:
        return " or ".join(texts) + ", where the others of these hold"
    return "; ".join(texts)


@within_doubles
def missed_laws(known: Mapping[str, float]) -> tuple[Missed, ...]:
    """Return the laws that exact values miss, those of which nothing is unknown before all others;
    none where no single law is to be named.

    ``known``: vehicles, geometry and exact values, friction as MUP.
    """
    if not {*GEOMETRY} <= {*known}:
        return ()
    values, model = _with_components(known), np.float64(known.get("M", 6.0))
    here = Geometry({n: np.float64(values[n]) for n in GEOMETRY} | {"M": model})
    if model == 4:
        values |= dict.fromkeys(_SPINS, 0.0)
    names = (*VELOCITIES, *FINAL_STATE)
    rows = _rows(values, here)
    if model == 4:
        rows = {law: row for law, row in rows.items() if law not in ("angular", "EM")}
    laws = [law for law, row in rows.items() if np.isfinite(row).all()]
    missed = _missed_quantities(known, values, here)
    if not laws:
        return missed
    matrix = np.array([rows[law] for law in laws])
    at = np.array([values.get(n, 0.0) for n in names], float)
    open_ones = np.array([n not in values for n in names])
    # a spin is as large as what it makes at the radius of gyration
    gyration = math.sqrt(float(here.inverse_mass / here.inverse_spin_inertia))
    unit = np.array([1 / gyration if n in _SPINS else 1.0 for n in names])
    speed = float(np.abs(at / unit).max(initial=0.0))
    sizes = np.abs(matrix * unit).max(axis=1) * speed
    left, loose = matrix @ at, matrix[:, open_ones] * unit[open_ones]
    alone = [*missed]
    for i, law in enumerate(laws):
        off = float(abs(left[i]))
        if sizes[i] and off > ROUNDING * sizes[i]:
            largest = float(np.abs(matrix[i] * at).max(initial=0.0))
            if np.abs(loose[i]).max(initial=0.0) <= 1e-12 * sizes[i] / speed:
                given, present = _coefficient(law, values, here, at)
                alone.append(Missed(law, _MEASURED_AS[law], off, off / largest, given, present))
    return tuple(alone) or _missed_together(laws, left, loose, sizes, speed)


def _missed_quantities(
    known: Mapping[str, float], values: Mapping[str, float], here: Any
) -> tuple[Missed, ...]:
    """Return the known values that are not what the velocities make them, where these are all
    known."""
    state = State.of_known({name: np.float64(x) for name, x in values.items()})
    state.here = here
    missed = []
    for name in QUANTITIES:
        if name not in known or {*SPEEDS.get(name, ())} & {*values} - {*known}:
            continue  # the components were made of it
        given, present = known[name], float(np.real(state[name]))
        # what is lost is the difference of two energies
        largest = float(np.real(state.initial_energy)) if name == "EL" else abs(present)
        largest = max(largest, abs(given), 1.0 if name == "LOSS" else 0.0)
        off = abs(present - given)
        if math.isfinite(off) and off > ROUNDING * largest:
            missed.append(Missed(name, name, off, off / largest, given, present))
    return tuple(missed)


def _missed_together(
    laws: list[str], left: Floats, loose: Floats, sizes: Floats, speed: float
) -> tuple[Missed, ...]:
    """Return the fewest laws that cannot hold together, each with what it is missed by where the
    others of them hold."""
    if not speed or not loose.shape[1]:
        return ()
    size = np.where(sizes > 0, sizes, 1.0)
    matrix, right = loose * speed / size[:, None], left / size

    def off(law: int, rest: list[int]) -> float:
        x = -np.linalg.pinv(matrix[rest], rcond=1e-10) @ right[rest]
        return abs(float(right[law] + matrix[law] @ x))

    for count in range(2, len(laws) + 1):
        for several in combinations(range(len(laws)), count):
            chosen = [*several]
            x = -np.linalg.pinv(matrix[chosen], rcond=1e-10) @ right[chosen]
            if np.abs(right[chosen] + matrix[chosen] @ x).max() > ROUNDING:
                # fewer of them agree: each is missed where the others of these hold
                return tuple(
                    Missed(laws[i], _MEASURED_AS[laws[i]], share * size[i], share, alone=False)
                    for i in chosen
                    for share in [off(i, [k for k in chosen if k != i])]
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
    for own, names in (("MA", VELOCITIES[:3]), ("MB", VELOCITIES[3:])):
        if math.isinf(values[own]):
            values |= dict.fromkeys(names, 0.0)
    return values


def _rows(values: Mapping[str, float], here: Any) -> dict[str, Floats]:
    """Return the coefficients of each law over the velocities before and after."""
    every = np.eye(12)
    before, after = every[:6], every[6:]
    changes = after - before
    cosine, sine = float(here.cosine), float(here.sine)

    def push(vehicle: str, first: int) -> tuple[Floats, Floats]:
        mass = values["M" + vehicle]
        x, y = changes[first], changes[first + 1]
        return mass * (x * cosine + y * sine), mass * (y * cosine - x * sine)

    (an, at), (bn, bt) = push("A", 0), push("B", 3)
    # what an impulse along n, or t, gives each vehicle of angular momentum
    units = [here.changes(*(np.float64(x) for x in row)) for row in np.eye(3)]
    arms = [(values["IA"] * float(unit[2]), values["IB"] * float(unit[5])) for unit in units]
    if math.isinf(values["MA"]):
        pn, pt = -bn, -bt
        moment = (values["IB"] * changes[5] + bn * arms[0][1] + bt * arms[1][1]) / arms[2][1]
    else:
        pn, pt = an, at
        moment = (values["IA"] * changes[2] - an * arms[0][0] - at * arms[1][0]) / arms[2][0]
    rows = {"n": an + bn, "t": at + bt}
    turned_a = values["IA"] * changes[2] - an * arms[0][0] - at * arms[1][0]
    turned_b = values["IB"] * changes[5] + bn * arms[0][1] + bt * arms[1][1]
    rows["angular"] = turned_a + turned_b
    early, late = here.relative([*before]), here.relative([*after])
    if "E" in values:
        rows["E"] = late[0] + values["E"] * early[0]
    if "MUP" in values:
        rows["MUP"] = late[1] if values["MUP"] == PIVOT else pt - values["MUP"] * pn
    if "EM" in values:
        below = late[2] + moment * float(here.inverse_spin_inertia)
        rows["EM"] = late[2] - values["EM"] * below
    return {law: np.asarray(row, np.float64) for law, row in rows.items()}


def _coefficient(
    law: str, values: Mapping[str, float], here: Any, at: Floats
) -> tuple[float, float]:
    """Return a coefficient as known and as all velocities have it; nan for other laws."""
    if law not in ("E", "MUP", "EM") or (law == "MUP" and values["MUP"] == PIVOT):
        return math.nan, math.nan
    zero, one = (float(_rows({**values, law: x}, here)[law] @ at) for x in (0.0, 1.0))
    return values[law], zero / (zero - one) if zero != one else math.nan
