"""Coordinates, observations and conditions of a reconstruction, from what is known.

A known input (velocity before, coefficient, dimension) is a coordinate of the impact: fixed where
it is exact, with its own density where it has a tolerance. Where a velocity after the impact is
known and the one before is not, it is the coordinate instead. All other known values are
observations. What is neither known nor follows is a coordinate within an assumed range.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from ..cases.amounts import Amount
from ..cases.motion import OWN_AXES, line_of_motion
from ..errors import UserError
from ..mechanics.formulas import E_MAX, E_MIN, EM_MAX, EM_MIN, ENERGY_TOLERANCE, NO_MOMENT
from ..mechanics.laws import Scale, margins
from ..mechanics.solve import BODIES, POINT, evaluate
from ..names import ENERGY, IMPULSE, LENGTH, PERCENT, SPIN, TURNING, VELOCITY, missing, quantity
from .impacts import (
    COEFFICIENTS,
    COURSES,
    FORCES,
    IMPULSES,
    PIVOT,
    SPEEDS,
    VEHICLES,
    Array,
    Impacts,
    components,
)

MOTION = (VELOCITY, SPIN, ENERGY, IMPULSE, TURNING, PERCENT)
ARMS = ("IA", "IB", "DA", "DB", "PA", "PB")
WITH_ARMS = ("WA", "WB", "WAF", "WBF", "E", "EM", "VC", "VS")  # what depends on the arms
ANGLES = (*COURSES, *FORCES, "PA", "PB", "TA", "TB", "GA")
ZERO = Amount.exactly(0.0)
CONTACT_POINT = (*OWN_AXES["A"], *OWN_AXES["B"], "CX", "CY")
VECTORS = {"A": ("UX", "UY", "SA", "HA"), "B": ("VX", "VY", "SB", "HB")}
RANGES = {"E": (E_MIN, E_MAX), "EM": (EM_MIN, EM_MAX)}
"""Ranges of coefficients that are not given (listing, lines 40 and 50)."""
FACING = {"A": 180.0, "B": 0.0}
"""Course of each vehicle less its heading TA or TB: A faces TA + 180."""
LOST = {"E": 0.0, "EM": 0.0, "MUP": PIVOT}  # coefficients that leave nothing of a velocity
FINAL = ("SAF", "HAF", "VAX", "VAY")
WIDEST = 20.0  # assumed largest velocity before the impact, over the largest known one
CRUSH = ("ELA", "EBSA", "ELB", "EBSB")
TOUCH = 1e-9  # least speed, closing speed and impulse that count, over typical ones


@dataclass(frozen=True)
class Known:
    """One known value; ``size`` is what counts as large for its kind."""

    name: str
    amount: Amount
    size: float

    @property
    def sd(self) -> float:
        """Standard deviation, 0 of an exact value."""
        return self.amount.standard_deviation


class Problem:
    """Coordinates, observations and conditions of one reconstruction.

    Parameters
    ----------
    known : mapping of str to Amount
        Known values by name, in one set of units.
    sign : int, default 0
        Sign of P_t where only the size of the friction is known (MU); 0 if it is not used.

    Raises
    ------
    UserError
        For missing masses and dimensions, and values that cannot be used.
    """

    def __init__(self, known: Mapping[str, Amount], sign: int = 0) -> None:
        self.remarks: list[str] = []
        self.assumed: dict[str, str] = {}
        self.excluded: dict[str, str] = {}  # result -> input that it needs
        self.without_plane = self.without_arms = False
        self.original = dict(known)
        self.known = known = dict(known)
        self.point = known.pop("M", Amount.exactly(BODIES)).value == POINT
        if absent := [name for name in ("MA", "MB") if name not in known]:
            raise UserError(missing(absent))
        self._add_crush(known)
        self._set_barrier(known)
        self._set_at_rest(known)
        if not self.point:
            self._complete_bodies(known)
        if self.point:
            self._complete_points(known)
        _check_coefficients(known)
        self._set_friction(known, sign)
        self._set_scales()
        self.facing = [v for v in "AB" if np.isnan(known["T" + v].value)]
        self.frames: dict[str, tuple[str, str]] = {}
        for vehicle in "AB":
            self.frames[vehicle] = self._frame(vehicle)
        self.coordinates: list[Known] = []
        self.fixed = {"M": POINT if self.point else BODIES}
        names = self._choose_coordinates()
        self.observed = [
            Known(name, amount, self.size(name))
            for name, amount in known.items()
            if name not in names
        ]
        self.lines = [n for n in COURSES if n in known and (n in names or not known[n].varies)]
        self.powers = self._powers_of_speeds(names)
        speeds = [COURSES[course] for course in self.lines]
        observed = (item.name for item in self.observed)
        self.needed = tuple(dict.fromkeys([*observed, *self.lines, *speeds, *self.powers]))

    # -- what is known, completed

    def _add_crush(self, known: dict[str, Amount]) -> None:
        """Replace the energies lost in each vehicle (ELA or EBSA, ELB or EBSB) by their sum EL."""
        names = [name for name in CRUSH if name in known]
        if not names:
            return
        if "EL" in known or [name[-1] for name in names] != ["A", "B"]:
            raise UserError(
                f"{', '.join(names)} given; expected ELA or EBSA together with ELB or EBSB, or EL "
                "alone"
            )
        parts = []
        for name in names:
            part = known.pop(name)
            parts.append(part if name[:2] == "EL" else _energy(part, known["M" + name[-1]].value))
        a, b = parts
        kind = a.kind if a.varies else b.kind
        known["EL"] = Amount(
            a.value + b.value,
            a.low + b.low,
            a.high + b.high,
            "normal" if "normal" in (a.kind, b.kind) else kind,
            math.hypot(a.standard_deviation, b.standard_deviation),
        )

    def _set_barrier(self, known: dict[str, Amount]) -> None:
        """Let a barrier, of infinite mass, rest unless its motion is given; it faces nothing."""
        if np.isinf(known["MB"].value):
            known.setdefault("IB", known["MB"])
            for name in ("SB", "WB", "TB", "DB", "PB"):
                known.setdefault(name, ZERO)

    def _set_at_rest(self, known: dict[str, Amount]) -> None:
        """Replace a speed of 0 by two velocities of 0."""
        for x, y, speed, course in VECTORS.values():
            if speed in known and _is_zero(known[speed]):
                del known[speed]
                known.pop(course, None)
                for axis in (x, y):
                    known.setdefault(axis, ZERO)

    def _complete_bodies(self, known: dict[str, Amount]) -> None:
        """Treat bodies of which only the momentum is used as points; refuse missing dimensions."""
        for vehicle, axes in OWN_AXES.items():
            if any(name in known for name in axes):
                known.setdefault("D" + vehicle, ZERO)
                known.setdefault("P" + vehicle, ZERO)
        absent = [name for name in VEHICLES if name not in known]
        if not absent:
            self._turn_plane(known)
            return
        turning = [name for name in WITH_ARMS if name in known]
        if turning and {*absent} & {*ARMS, "GA"}:
            raise UserError(f"{', '.join(turning)} cannot be used: {missing(absent)}")
        if arms := [name for name in absent if name in ARMS]:
            self.point = self.without_arms = True
            names = (*WITH_ARMS, "PM", "KI", "KF", "EL")
            self.excluded |= dict.fromkeys(names, ", ".join(arms))
        elif "GA" in absent:
            raise UserError(missing(["GA"]))
        for name in ("TA", "TB"):
            known.setdefault(name, Amount.exactly(np.nan))

    def _complete_points(self, known: dict[str, Amount]) -> None:
        """Set the dimensions and spins that point masses do not have, and their contact plane."""
        if "GA" not in known:
            self._take_plane_across(known)
        for name in (*CONTACT_POINT, "WAF", "WBF"):
            known.pop(name, None)
        known |= dict.fromkeys(("IA", "IB"), Amount.exactly(1.0))
        known |= dict.fromkeys(("DA", "DB", "PA", "PB", "WA", "WB", "EM"), ZERO)
        for vehicle in "AB":
            if "T" + vehicle not in known:
                known["T" + vehicle] = Amount.exactly(np.nan)
                self.assumed["T" + vehicle] = f"{vehicle} faces the way it travels"

    def _turn_plane(self, known: dict[str, Amount]) -> None:
        """Turn GA by 180 degrees where it puts each vehicle on the other's side."""
        names = (*VEHICLES, *CONTACT_POINT)
        values = {name: known[name].value for name in names if name in known}
        arms, _ = evaluate(with_arms(values), ("at", "bt"))
        a, b = (float(arm) for arm in arms.values())
        is_turned = min(a, b) >= -TOUCH * (abs(a) + abs(b)) and max(a, b) > 0.0
        if is_turned and not known["GA"].varies:
            angle = known["GA"].value
            opposite = math.remainder(angle + 180.0, 360.0)
            known["GA"] = Amount.exactly(opposite)
            self.remarks.append(
                f"GA = {angle:g} has each vehicle on the other's side of the contact plane (A is "
                f"on the side to which n points): taken as {opposite:g}"
            )

    def _take_plane_across(self, known: dict[str, Amount]) -> None:
        """Choose the contact plane of point masses: across the motion where all of it is along one
        line, else across the impulse, whose direction is open (GA)."""
        is_locked = "MU" in known and known["MU"].value == PIVOT
        is_locked &= known.keys().isdisjoint((*FORCES, "DVAR", "DVBR"))  # no direction given
        names: tuple[str, ...] = ("E", "MUP", "PN", "PT", "VC", "VS", "MUC")
        if is_locked and _is_zero(known.get("E", ZERO)):
            known["GA"] = ZERO  # equal velocities after: the plane has no effect
            known["E"] = ZERO
            self.without_plane = True
            names = names[1:]
        else:
            line = line_of_motion(known)
            if line is not None:
                known["GA"] = Amount.exactly(line)
                self.remarks.append(
                    "the motion is along one line: the contact plane is taken across it, and "
                    "nothing acts along the plane"
                )
                known.pop("MU", None)
                names = ()
            elif "MU" in known or "MUP" in known:
                raise UserError(f"MU cannot be used: {missing(['GA'])}")
            known["MUP"] = ZERO
        for name in names:
            self.excluded.setdefault(name, "GA")

    def _set_friction(self, known: dict[str, Amount], sign: int) -> None:
        """Replace MU by the signed MUP, unless it is a share of the critical friction."""
        if "MU" in known and "MUP" in known:
            raise UserError("MU and MUP are both given; expected one of them")
        self.share = "MU" in known and known["MU"].share
        self.sign = 0
        if "MU" in known and not self.share:
            known["MUP"] = known.pop("MU").mapped(Fraction(sign or 1))
            self.sign = sign

    def soften(self, tolerance: float) -> Problem:
        """Return the problem with one tolerance, in typical sizes, for all exact motions.

        Exact velocities, courses, spins, impulses and energies become normal; dimensions and
        coefficients stay."""
        known = dict(self.original)
        self._set_at_rest(known)
        if "GA" in self.known.keys() - known.keys() and not self.without_plane:
            known.pop("MU", None)  # the plane stays across the line of motion
            known |= {name: self.known[name] for name in ("GA", "MUP")}
        for name, amount in known.items():
            if not amount.varies and (quantity(name).unit in MOTION or name in (*COURSES, *FORCES)):
                sd = tolerance * self.size(name)
                known[name] = Amount(amount.value, -math.inf, math.inf, "normal", sd)
        return Problem(known, self.sign)

    # -- typical sizes

    def _set_scales(self) -> None:
        """Set the reduced mass, the radius of gyration and the largest velocity that is likely."""
        known = self.known
        masses = [known[name].value for name in ("MA", "MB")]
        if not 0 < min(masses) < math.inf:
            raise UserError("expected MA and MB above 0, and not both inf")
        self.mass = 1.0 / sum(1.0 / mass for mass in masses)
        ratios = [known["I" + v].value / known["M" + v].value for v in "AB"]
        finite = [ratio for ratio in ratios if np.isfinite(ratio)]
        self.gyration = 1.0 if self.point else float(np.sqrt(np.mean(finite)))
        moving = sum(mass for mass in masses if np.isfinite(mass))
        sizes = []
        for name, amount in known.items():
            value = abs(amount.value)
            as_speed = {
                VELOCITY: value,
                SPIN: value * self.gyration,
                IMPULSE: value / self.mass,
                ENERGY: float(np.sqrt(2.0 * value / moving)),
            }
            sizes.append(as_speed.get(quantity(name).unit, 0.0))
        self.speed = max(sizes)
        if not self.speed:
            raise UserError("no speed, spin or energy other than 0 is known; expected at least one")
        self.scale = Scale(self.speed, self.mass, self.gyration)

    def size(self, name: str) -> float:
        """Return what counts as large for a quantity."""
        v, m, rule = self.speed, self.mass, quantity(name).unit
        sizes = {
            VELOCITY: v,
            SPIN: v / self.gyration,
            ENERGY: m * v * v,
            IMPULSE: m * v,
            TURNING: m * v * self.gyration,
            LENGTH: self.gyration,
            PERCENT: 100.0,
            "1": 1.0,
            "degree": 57.3,
        }
        return sizes.get(rule) or abs(self.known[name].value)

    # -- coordinates

    def _frame(self, vehicle: str) -> tuple[str, str]:
        """Return the coordinates of a vehicle's velocity that use most of what is known."""
        x, y, speed, course = VECTORS[vehicle]
        x_after, y_after = f"V{vehicle}X", f"V{vehicle}Y"
        scores = {name: 2 + (not amount.varies) for name, amount in self.known.items()}
        before = [(x, y), (speed, course)]
        after = [
            (
                x_after if x not in self.known and x_after in self.known else x,
                y_after if y not in self.known and y_after in self.known else y,
            ),
            (speed, course),
            (f"S{vehicle}F", f"H{vehicle}F"),
        ]
        is_late = vehicle == "B" and any(name in FINAL for name in self.frames["A"])
        is_early = (vehicle in self.facing and not self.point) or (
            is_late and not self._leaves("E", "MUP")
        )
        # a course is smooth where the vehicle stops only as a coordinate
        is_early = is_early or (course in self.known and self.known[course].varies)
        frames = before if is_early else after
        return max(frames, key=lambda names: sum(scores.get(name, 0) for name in names))

    def _choose_coordinates(self) -> set[str]:
        """Set `coordinates` and `fixed`, and return the names that are used."""
        spins = [
            after
            if before not in self.known and after in self.known and self._leaves("EM")
            else before
            for before, after in (("WA", "WAF"), ("WB", "WBF"))
        ]
        names = [*self.frames["A"], *self.frames["B"], *spins]
        for coefficient, impulse in zip(COEFFICIENTS, IMPULSES, strict=True):
            if coefficient in self.known:
                names.append(coefficient)
            else:
                names.append(impulse)  # over impulses, what is known is linear
                self._note_range(coefficient, impulse)
        names += VEHICLES
        names += [name for name in CONTACT_POINT if name in self.known]
        for name in names:
            amount = self.known.get(name) or self._widest(name)
            if amount.varies:
                self.coordinates.append(Known(name, amount, self.size(name)))
            else:
                self.fixed[name] = amount.value
        self.names = [item.name for item in self.coordinates]
        turns = {*ANGLES} - self.known.keys()
        self.circular = [k for k, name in enumerate(self.names) if name in turns]
        self.ranges = [name for name in RANGES if name not in self.fixed]
        for vehicle in self.facing:
            self.fixed["T" + vehicle] = 0.0
        return set(names)

    def _widest(self, name: str) -> Amount:
        """Return the range of a coordinate of which nothing is known."""
        reach = 180.0 if name in ANGLES else WIDEST * self.size(name)
        if name in IMPULSES:
            reach = math.inf
        low = 0.0 if name in SPEEDS else -reach
        return Amount((low + reach) / 2, low, reach, "uniform")

    def _leaves(self, *coefficients: str) -> bool:
        """Return False if nothing is left of a relative velocity: no inverse leads back from it
        (E, EM = 0, or a pivot)."""
        amounts = [(name, self.known.get(name)) for name in coefficients]
        return not any(a and not a.varies and a.value == LOST[name] for name, a in amounts)

    def _note_range(self, coefficient: str, impulse: str) -> None:
        """Note the range of a coefficient that is not given."""
        if coefficient in self.excluded or impulse in self.known:
            return
        if coefficient in RANGES:
            self.assumed[coefficient] = "{:g} to {:g}".format(*RANGES[coefficient])
        elif not self.share:
            self.assumed[coefficient] = "friction up to what ends the sliding, with an allowance"

    # -- impacts

    def impacts(self, points: Array) -> Impacts:
        """Return impacts of points (rows) over the coordinates."""
        return self.complete(dict(zip(self.names, points.T, strict=True)))

    def complete(self, columns: Mapping[str, Array]) -> Impacts:
        """Return impacts of coordinates; coefficients may be in place of impulses."""
        values: dict[str, Any] = {**self.fixed, **columns}
        with np.errstate(all="ignore"):
            self._make_cartesian(values)
            impacts = Impacts(with_arms(values))
            impacts.compute([n for v in self.facing for n in ("S" + v, "H" + v, f"H{v}F")])
            for vehicle in self.facing:  # a vehicle that was at rest faces the way it leaves
                is_at_rest = impacts["S" + vehicle] < TOUCH * self.speed
                course = np.where(is_at_rest, impacts[f"H{vehicle}F"], impacts["H" + vehicle])
                impacts["T" + vehicle] = course + FACING[vehicle]
            impacts.compute(self.needed)
            if self.share:
                impacts["MU"] = impacts["MUP"] / impacts["MUC"]
        return impacts

    def _make_cartesian(self, values: dict[str, Any]) -> None:
        """Replace speeds and courses by velocities, and set headings that are courses."""
        for vehicle, frame in self.frames.items():
            if frame[0] in SPEEDS:
                x, y = SPEEDS[frame[0]]
                values[x], values[y] = components(values.pop(frame[0]), values.pop(frame[1]))
            if vehicle in self.facing and not self.point:
                x, y, _, _ = VECTORS[vehicle]
                _, course = _polar(values[x], values[y])
                values["T" + vehicle] = course + FACING[vehicle]

    def _powers_of_speeds(self, names: set[str]) -> dict[str, int]:
        """Return the powers of speeds in the flat density over the coordinates ``names``.

        It is flat over a speed and a course before the impact if one of them is known, else over
        components; of the coordinates' polar area and of misfits across a line come the others."""
        polar = {frame[0] for frame in self.frames.values()}
        powers = {
            speed: (speed in polar)
            + (course in self.lines and course not in names)
            - (course in ("HA", "HB") and not self.known.keys().isdisjoint((speed, course)))
            for course, speed in COURSES.items()
        }
        return {speed: power for speed, power in powers.items() if power}

    def log_density(self, impacts: Impacts) -> Any:
        """Return the log of the flat density of impacts, per unit of the coordinates."""
        total = impacts.log_volume
        for speed, power in self.powers.items():
            total = total + power * np.log(impacts[speed] + 1e-300)
        return total

    def misfit(self, impacts: Impacts, item: Known) -> Any:
        """Return observed quantities less what was measured: angles within half a turn, but the
        velocity across the line of an exact course, which is smooth where the vehicle stops."""
        off = impacts[item.name] - item.amount.value
        if item.name in self.lines and not item.sd:
            return item.size * np.sin(np.radians(off)) * impacts[COURSES[item.name]] / self.speed
        return (off + 180.0) % 360.0 - 180.0 if item.name in ANGLES else off

    # -- conditions

    @np.errstate(all="ignore")
    def margins(self, impacts: Impacts) -> list[tuple[str, Any]]:
        """Return how far impacts lie within what physics allows, by condition, in typical sizes.

        The vehicles travel along their courses, approach, push and gain no energy; e, e_m and
        friction that are not given lie in their ranges (`mechanics.laws`)."""
        rows: list[tuple[str, Any]] = []
        for course in self.lines:
            speed = COURSES[course]
            if speed not in self.known or self.known[speed].value > 0:
                along = np.cos(np.radians(impacts[course] - self.known[course].value))
                rows.append((course, impacts[speed] * along / self.speed + TOUCH))
        if self.without_arms:
            return rows
        inside = margins(impacts, self.scale)
        rows.append(("energy", inside["energy"][0] + ENERGY_TOLERANCE))
        if self.without_plane:
            return rows
        # the contact plane of points has no sides
        side = np.where(inside["approach"][0] < 0, -1.0, 1.0) if self.point else 1.0
        rows += [(name, side * inside[name][0] - TOUCH) for name in ("approach", "push")]
        rows += [(name, row) for name in self.ranges for row in inside[name]]
        if "MUP" not in self.known:
            rows += [("friction", side * row) for row in inside["friction"]]
        if self.sign:
            rows.append(("sign of MU", -self.sign * impacts["gt"] / self.speed))
        return rows


def with_arms(values: dict[str, Any]) -> dict[str, Any]:
    """Return values with the contact point of CAF CAL CBF CBL, moved by CX and CY, as DA PA DB
    PB."""
    shift_x, shift_y = (values.get(name, 0.0) for name in ("CX", "CY"))
    for vehicle, side in (("A", -1.0), ("B", 1.0)):  # A faces TA + 180
        distance, angle, axes = "D" + vehicle, "P" + vehicle, OWN_AXES[vehicle]
        if any(name in values for name in axes):
            values[distance], values[angle] = _polar(*(values.get(name, 0.0) for name in axes))
        if "CX" in values or "CY" in values:
            heading = values["T" + vehicle]
            x, y = components(values[distance], heading + values[angle])
            values[distance], direction = _polar(x + side * shift_x, y + side * shift_y)
            values[angle] = direction - heading
    return values


def _polar(x: Any, y: Any) -> tuple[Any, Any]:
    """Return size and direction in degrees of a vector."""
    return np.hypot(x, y), np.degrees(np.arctan2(y, x))


def _energy(speed: Amount, mass: float) -> Amount:
    """Return the kinetic energy at a speed."""
    low, value, high = (mass / 2 * (x * abs(x)) for x in (speed.low, speed.value, speed.high))
    return Amount(value, low, high, speed.kind, mass * speed.value * speed.sd)


def _check_coefficients(known: Mapping[str, Amount]) -> None:
    """Raise UserError for E and EM outside of their ranges."""
    for name, (low, high) in RANGES.items():
        amount = known.get(name, Amount.exactly(low))
        if (amount.high < low or amount.low > high) and amount.value != NO_MOMENT:
            end = ", or 1 for no moment" if name == "EM" else ""
            raise UserError(f"{name} is {amount.value:g}; expected {low:g} to {high:g}{end}")


def _is_zero(amount: Amount) -> bool:
    return not amount.varies and amount.value == 0


def unwrap_angles(name: str, column: Array, middle: float | None) -> Array:
    """Return directions about a value, so that no interval crosses the half turn."""
    if name not in ANGLES:
        return column
    if middle is None:
        middle = float(np.angle(np.exp(1j * np.radians(column)).mean(), deg=True))
    return np.asarray(middle + (column - middle + 180.0) % 360.0 - 180.0)


def signs_of_friction(known: Mapping[str, Amount]) -> tuple[int, ...]:
    """Return the signs of P_t that MU leaves open (line 400 decides by the sliding)."""
    friction = known.get("MU", ZERO)
    is_exact = not friction.varies and friction.value in (0.0, PIVOT)
    return (0,) if friction.share or is_exact else (1, -1)
