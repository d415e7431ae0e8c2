"""The scene from above: what is where, worked out once for every way of drawing it.

The contact point is the origin, axes and signs are the listing's (line 330): it lies at -DA
(cos, sin)(TA + PA) from A's center of gravity and at DB (cos, sin)(TB + PB) from B's; the normal
n = (cos GA, sin GA) points to A's side, the tangent is t = (-sin GA, cos GA), and the impulse acts
on A. So A's front looks along TA + 180 degrees, B's along TB, and on either vehicle the contact
point stands at the angle PA or PB from the front: all of Table 1 reads so.

A vehicle is drawn as measured (LA BA, LB BB), else in the size of its class by weight (`CLASSES`);
without units, where the weight is not known, as the uniform rectangle of its radius of gyration,
L² + W² = 12 I/m, at L/W = 2.6. It is lengthened or widened where the contact point would lie
outside. One 10,000 times as heavy as the other and at rest is a wall; point masses are discs, moved
apart along n until they touch. What reaches beyond the contact plane is crushed.
"""

import cmath
import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

from ...collision.casescene import numbers_of
from ...collision.doubles import double
from ...collision.units import RULES, System
from ...errors import UserError
from ...mechanics.closedform.omitted import COMPONENTS, plane_across
from ...mechanics.friction import status_sentences
from ...mechanics.state import pdof
from ...names import FINAL_VELOCITIES, SCENE, missing
from .drawing import check_drawable, degrees, unit

PROPORTION = 2.6  # length over width of a vehicle
CLASSES = (
    (450.0, "a motorcycle", 2.2, 0.8),
    (2500.0, "a car", 4.6, 1.8),
    (4500.0, "a light truck", 5.7, 2.0),
    (16000.0, "a heavy truck", 9.0, 2.5),
    (math.inf, "a truck with a trailer", 19.0, 2.6),
)
"""Classes of vehicles: up to which mass in kg, what it is, usual length and width in m."""
DISC = 0.3  # radius of a point mass over the length it would have
DISC_CORNERS = 36
WALL = 1e4  # ratio of masses from which on the heavier body is drawn as a wall


class Motion(NamedTuple):
    """Velocity of the center of gravity and spin."""

    velocity: complex
    spin: float

    @property
    def speed(self) -> float:
        return abs(self.velocity)


class Vehicle(NamedTuple):
    """One vehicle in plan, in the scene's units; points are x + iy. ``center``: of gravity;
    ``front``: unit vector; ``outline``: four corners, the front's two first, or a disc's rim;
    ``kept``: the outline on its own side of the contact plane; ``wall``: too heavy to be a vehicle;
    ``point``: a point mass; ``has_front``: which way it faces is given, not only drawn."""

    name: str
    center: complex
    front: complex
    length: float
    width: float
    outline: tuple[complex, ...]
    kept: tuple[complex, ...]
    wall: bool
    point: bool
    has_front: bool
    before: Motion
    after: Motion | None

    @property
    def change(self) -> complex | None:
        return self.after.velocity - self.before.velocity if self.after else None

    def pdof(self, impulse: complex) -> float:
        """Return the principal direction of force, in degrees clockwise from the front, of the
        impulse on A."""
        force = impulse if self.name == "A" else -impulse
        return float(pdof(degrees(self.front), force.real, force.imag))


class Plan(NamedTuple):
    """A scene in plan. ``normal`` and ``tangent`` are unit vectors; ``impulse`` acts on A;
    ``apart``: whether point masses were moved apart to be seen; ``sizes_from``: by vehicle what its
    size is from: "measured", "I/m" or a class by weight, "a car"."""

    vehicles: tuple[Vehicle, Vehicle]
    normal: complex
    tangent: complex
    impulse: complex | None
    apart: bool
    remarks: tuple[str, ...]
    numbers: dict[str, float]
    sizes_from: dict[str, str]

    @property
    def speed_of_centers(self) -> float:
        """The relative speed of the centers of gravity before the impact."""
        a, b = self.vehicles
        return abs(a.before.velocity - b.before.velocity)

    @property
    def bodies(self) -> list[Vehicle]:
        return [vehicle for vehicle in self.vehicles if not vehicle.wall]


def _rectangle(front: complex, length: float, width: float) -> list[complex]:
    corners = ((1, -1), (1, 1), (-1, 1), (-1, -1))
    return [front * complex(i * length, j * width) / 2 for i, j in corners]


def _disc(diameter: float) -> list[complex]:
    steps = range(DISC_CORNERS)
    return [cmath.rect(diameter / 2, math.tau * step / DISC_CORNERS) for step in steps]


def plan(
    scene: Any,
    result: Mapping[str, Any] | None = None,
    outlines: Mapping[str, float] | None = None,
    units: System = RULES,
    discs: bool = True,
) -> Plan:
    """Return the scene in plan.

    ``scene``: texts or numbers by the listing's names; ``result``: VAX, VAY, VBX, VBY, WAF and WBF
    unless of point masses, STATUS where known; without it, or where it is not finite, there is
    nothing after the impact; ``units``: whose base units the numbers are in; ``discs``: draw point
    masses as such. Raises UserError for a value that is not a finite number, or too large to
    draw."""
    values, outlines = numbers_of(_drawable(scene, result or {})), outlines or {}
    for name, value in values.items():
        check_drawable([value], name)
    normal = unit(values["GA"])
    before = {
        "A": Motion(complex(values["UX"], values["UY"]), values["WA"]),
        "B": Motion(complex(values["VX"], values["VY"]), values["WB"]),
    }
    finals = {name: (result or {}).get(name) for name in FINAL_VELOCITIES}
    numbers = {name: float(value) for name, value in finals.items() if value is not None}
    after: dict[str, Motion] = {}
    if all(math.isfinite(numbers.get(name, math.nan)) for name in FINAL_VELOCITIES[:4]):
        for v in "AB":
            after[v] = Motion(
                complex(numbers[f"V{v}X"], numbers[f"V{v}Y"]), numbers.get(f"W{v}F", 0.0)
            )
    reach = {
        "A": -values["DA"] * unit(values["TA"] + values["PA"]),
        "B": values["DB"] * unit(values["TB"] + values["PB"]),
    }
    front = {"A": -unit(values["TA"]), "B": unit(values["TB"])}
    apart = values["DA"] == 0 == values["DB"]
    contact = {name: 2 * reach[name] * front[name].conjugate() for name in "AB"}
    sizes, sizes_from = _sizes(values, contact, outlines, units)
    points = discs and values["M"] == 4
    vehicles = []
    for name, inward in (("A", normal), ("B", -normal)):
        length, width = sizes[name]
        center = -reach[name]
        if points:
            length = width = 2 * DISC * length
        if apart:
            direction = front[name] * normal.conjugate()
            half = (abs(direction.real) * length + abs(direction.imag) * width) / 2
            center = inward * (length / 2 if points else half)
        around = _disc(length) if points else _rectangle(front[name], length, width)
        outline = tuple(center + corner for corner in around)
        cut = not points and _depth(center, inward) > 0.15 * width
        outline_left = _clip_outline(outline, inward) if cut else outline
        heavy, light = (abs(values[f"M{which}"]) for which in (name, "B" if name == "A" else "A"))
        wall = heavy >= WALL * light and before[name] == (0, 0)
        motions = before[name], after.get(name)
        size = length, width, outline, outline_left
        kind = wall, points, f"T{name}" in getattr(scene, "given", scene)
        vehicles.append(Vehicle(name, center, front[name], *size, *kind, *motions))
    # momentum of the lighter vehicle: a wall's change of velocity has no digits left
    mover, sense = (vehicles[1], -1) if vehicles[0].wall else (vehicles[0], 1)
    impulse = None if mover.change is None else sense * values[f"M{mover.name}"] * mover.change
    all_values = {**values, **(result or {})}
    remarks = tuple(status_sentences(int(all_values.get("STATUS") or 0), all_values))
    pair = vehicles[0], vehicles[1]
    return Plan(pair, normal, 1j * normal, impulse, apart, remarks, values, sizes_from)


_OF_NO_EFFECT = dict.fromkeys(
    ("DA", "DB", "PA", "PB", "WA", "WB", "IA", "IB", "E", "MU", "EM"), 0.0
)
"""Values that a drawing of point masses does not show, where they are not given."""


def _drawable(scene: Any, result: Mapping[str, Any]) -> dict[str, Any]:
    """Return a scene of point masses with what its drawing needs beyond what is given: vehicles
    face the way they travel, and the contact plane lies across motion along one line. Raises
    UserError where the plane is not known."""
    values: dict[str, Any] = dict(getattr(scene, "given", scene))
    if double(str(values.get("M", 6))) != 4 or {*SCENE} <= {*values}:
        return values
    values = {**_OF_NO_EFFECT, **values}
    for vehicle, (x, y) in {"A": ("UX", "UY"), "B": ("VX", "VY")}.items():
        after = (float(result.get(f"V{vehicle}{axis}", math.nan)) for axis in "XY")
        before = tuple(_number(values.get(name)) for name in (x, y))
        if math.isnan(sum(before)):
            raise UserError(f"{missing([x, y])}; the drawing shows the velocities before")
        course = next((v for v in (complex(*before), complex(*after)) if abs(v) > 0), 0j)
        theta = math.degrees(cmath.phase(course)) + (180.0 if vehicle == "A" else 0.0)
        values.setdefault(f"T{vehicle}", theta)
    if "GA" not in values:
        values["GA"] = float(plane_across({n: _number(values[n]) for n in COMPONENTS}))
        if math.isnan(values["GA"]):
            raise UserError(f"{missing(['GA'])}; the drawing shows the contact plane")
    return values


def _number(value: Any) -> float:
    """Return a value as a double, NaN where it is not known."""
    if value is None or isinstance(value, float):
        return math.nan if value is None else value
    return double(str(value))


def _depth(point: complex, inward: complex) -> float:
    """Return the distance of a point to the ``inward`` side of the contact plane."""
    return (point * inward.conjugate()).real


def _sizes(
    values: Mapping[str, float],
    contact: Mapping[str, complex],
    outlines: Mapping[str, float],
    units: System,
) -> tuple[dict[str, tuple[float, float]], dict[str, str]]:
    """Length and width of both vehicles, and what each size is from; ``contact``: twice the contact
    point from each's axes."""
    usual: dict[str, tuple[float, float]] = {}
    sizes_from: dict[str, str] = {}
    for name in "AB":
        mass, inertia, distance = (values[kind + name] for kind in "MID")
        square = 12 * inertia / mass if mass else math.nan
        if not units.is_bare and 0 < mass < math.inf:
            weight = mass * float(units.scale("mass"))
            _, kind, *size = next(row for row in CLASSES if weight <= row[0])
            length, width = (metres / float(units.scale("length")) for metres in size)
            usual[name], sizes_from[name] = (length, width), kind
        elif 0 < square < 1e12 * max(1.0, distance**2):
            length = math.sqrt(square / (1 + PROPORTION**-2))
            usual[name], sizes_from[name] = (length, length / PROPORTION), "I/m"
        elif distance:
            length = 2.4 * abs(distance)
            usual[name], sizes_from[name] = (length, length / PROPORTION), "the contact point"
    sizes = {}
    longest = max(usual.values(), default=(1.0, 1.0 / PROPORTION))
    for name in "AB":
        length, width = usual.get(name, longest)
        sizes_from.setdefault(name, "the other vehicle")
        along, across = abs(contact[name].real), abs(contact[name].imag)
        sizes[name] = max(length, along), max(width, across)
        if f"L{name}" in outlines:
            sizes[name] = (outlines[f"L{name}"], outlines[f"B{name}"])
            sizes_from[name] = "measured"
    return sizes, sizes_from


def _clip_outline(outline: Sequence[complex], inward: complex) -> tuple[complex, ...]:
    """Return the part of a convex outline on the ``inward`` side of the line through the origin."""
    result: list[complex] = []
    for start, end in pairwise((*outline, outline[0])):
        first, second = _depth(start, inward), _depth(end, inward)
        if first >= 0:
            result.append(start)
        if first * second < 0:
            result.append(start + (end - start) * first / (first - second))
    return tuple(result)
