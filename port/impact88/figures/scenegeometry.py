"""The scene from above: what is where, worked out once for every way of drawing it.

Axes and signs are the listing's (line 330 and `program.listing`): with D1 = DB sin(TB + PB),
D2 = DB cos(TB + PB), D3 = DA sin(TA + PA), D4 = DA cos(TA + PA) the contact point lies at
(-D4, -D3) from A's center of gravity and at (D2, D1) from B's; the normal n = (cos GA, sin GA)
points to A's side, the tangent is t = (-sin GA, cos GA), and the impulse drawn acts on A, its
opposite on B. The contact point is the origin.

So A's front looks along TA + 180 degrees and B's along TB, and on either vehicle the contact point
stands at the angle PA or PB from the front: all of Table 1 reads so (every A has TA = 0 and drives
in -x; the struck rears of collisions 3 to 5 have PB = 168 ... 171).

A vehicle is drawn as measured where its length and width are known (LA BA, LB BB), else as the
rectangle that has its radius of gyration when mass lies evenly on it, L² + W² = 12 I/m, at L/W =
2.6, a passenger car's; then lengthened or widened where the contact point would lie outside. A
vehicle 10,000 times as heavy as the other and at rest is drawn as a wall behind the contact plane;
point masses (both distances 0) are drawn moved apart along n until they touch. What reaches beyond
the contact plane is drawn as crushed, dashed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from ..scene import numbers_of
from ..status import sentences
from .drawing import Point, check_drawable

PROPORTION = 2.6
"""Length over width."""
WALL = 1e4
"""From this ratio of masses on the heavier one is a wall."""


class Motion(NamedTuple):
    """Velocity of the center of gravity and spin."""

    velocity: Point
    spin: float

    @property
    def speed(self) -> float:
        """The velocity's size."""
        return math.hypot(*self.velocity)


class Vehicle(NamedTuple):
    """One vehicle in plan, in the scene's units around the contact point.

    ``center``: center of gravity as drawn; ``front``: unit vector; ``outline``: four corners, the
    front's two first; ``kept``: the outline on its own side of the contact plane; ``wall``: too
    heavy to be a vehicle.
    """

    name: str
    center: Point
    front: Point
    length: float
    width: float
    outline: tuple[Point, ...]
    kept: tuple[Point, ...]
    wall: bool
    before: Motion
    after: Motion | None


class Plan(NamedTuple):
    """A scene in plan. ``normal`` and ``tangent`` are unit vectors; ``impulse`` acts on A;
    ``apart``: whether point masses were moved apart to be seen; ``measured``: the vehicles whose
    length and width are known."""

    vehicles: tuple[Vehicle, Vehicle]
    normal: Point
    tangent: Point
    impulse: Point | None
    apart: bool
    remarks: tuple[str, ...]
    numbers: dict[str, float]
    measured: tuple[str, ...]

    @property
    def closing(self) -> float:
        """How fast the centers of gravity move relative to each other before the impact."""
        a, b = (vehicle.before.velocity for vehicle in self.vehicles)
        return math.dist(a, b)


def plan(
    scene: Any,
    result: Mapping[str, Any] | None = None,
    outlines: Mapping[str, float] | None = None,
) -> Plan:
    """Where everything is. ``scene`` gives the listing's names as texts or numbers; ``result`` has
    VAX, VAY, VBX, VBY and, unless the scene has point masses, WAF and WBF; STATUS where known.

    Without a result, or where it is not finite, there is nothing after the impact to show.
    Raises UserError for a value that is no finite number, or too large to draw.
    """
    values = numbers_of(scene)
    for name, value in values.items():
        check_drawable([value], name)
    normal = direction(values["GA"])
    tangent = (-normal[1], normal[0])
    final = _finals(result)
    before = {
        "A": Motion((values["UX"], values["UY"]), values["WA"]),
        "B": Motion((values["VX"], values["VY"]), values["WB"]),
    }
    # the contact point is at -D4, -D3 from A and at D2, D1 from B
    reach = {
        "A": scaled(direction(values["TA"] + values["PA"]), -values["DA"]),
        "B": scaled(direction(values["TB"] + values["PB"]), values["DB"]),
    }
    front = {"A": scaled(direction(values["TA"]), -1.0), "B": direction(values["TB"])}
    apart = values["DA"] == 0 == values["DB"]
    sizes = _sizes(values, reach, front, outlines or {})
    vehicles = []
    for name, side in (("A", 1.0), ("B", -1.0)):
        length, width = sizes[name]
        center = scaled(reach[name], -1.0)
        if apart:
            along, across = dot(front[name], normal), dot(front[name], tangent)
            half = (abs(along) * length + abs(across) * width) / 2
            center = scaled(normal, side * half)
        outline = _rectangle(center, front[name], length, width)
        inward = scaled(normal, side)
        kept = outline
        if dot(center, inward) > 0.15 * width:
            kept = _clipped(outline, inward)
        other = "B" if name == "A" else "A"
        heavy, light = abs(values["M" + name]), abs(values["M" + other])
        vehicles.append(
            Vehicle(
                name,
                center,
                front[name],
                length,
                width,
                outline,
                kept,
                heavy >= WALL * light and before[name] == ((0.0, 0.0), 0.0),
                before[name],
                final.get(name),
            )
        )
    impulse = None
    if "A" in final:
        # momentum of the lighter vehicle: a wall's change of velocity has no digits left
        moved, sense = ("B", -1.0) if vehicles[0].wall else ("A", 1.0)
        change = minus(final[moved].velocity, before[moved].velocity)
        impulse = scaled(change, sense * values["M" + moved])
    remarks = _remarks(result, values)
    measured = tuple(name for name in "AB" if outlines and f"L{name}" in outlines)
    pair = (vehicles[0], vehicles[1])
    return Plan(pair, normal, tangent, impulse, apart, remarks, values, measured)


def _finals(result: Mapping[str, Any] | None) -> dict[str, Motion]:
    def number(name: str, default: float = math.nan) -> float:
        value = default if result is None else result.get(name, default)
        return default if value is None else float(value)

    finals = {
        "A": Motion((number("VAX"), number("VAY")), number("WAF", 0.0)),
        "B": Motion((number("VBX"), number("VBY")), number("WBF", 0.0)),
    }
    finite = all(map(math.isfinite, (x for m in finals.values() for x in m.velocity)))
    return finals if finite else {}


def _remarks(result: Mapping[str, Any] | None, values: Mapping[str, Any]) -> tuple[str, ...]:
    whole = {**values, **(result or {})}
    return tuple(sentences(int(whole.get("STATUS") or 0), whole))


def direction(degrees: float) -> Point:
    return (math.cos(math.radians(degrees)), math.sin(math.radians(degrees)))


def scaled(vector: Point, factor: float) -> Point:
    return (factor * vector[0], factor * vector[1])


def plus(first: Point, second: Point) -> Point:
    return (first[0] + second[0], first[1] + second[1])


def minus(first: Point, second: Point) -> Point:
    return (first[0] - second[0], first[1] - second[1])


def dot(first: Point, second: Point) -> float:
    return first[0] * second[0] + first[1] * second[1]


def _sizes(
    values: Mapping[str, float],
    reach: Mapping[str, Point],
    front: Mapping[str, Point],
    outlines: Mapping[str, float],
) -> dict[str, tuple[float, float]]:
    """Length and width of both vehicles, see the module's text."""
    lengths: dict[str, float] = {}
    for name in "AB":
        mass, inertia, distance = (values[kind + name] for kind in "MID")
        square = 12 * inertia / mass if mass else math.nan
        if 0 < square < 1e12 * max(1.0, distance**2):
            lengths[name] = math.sqrt(square / (1 + PROPORTION**-2))
        elif distance:
            lengths[name] = 2.4 * abs(distance)
    usual = max(lengths.values(), default=1.0)
    sizes = {}
    for name in "AB":
        if f"L{name}" in outlines:
            sizes[name] = (outlines[f"L{name}"], outlines[f"B{name}"])
            continue
        length = lengths.get(name, usual)
        x = dot(reach[name], front[name])
        y = dot(reach[name], (-front[name][1], front[name][0]))
        sizes[name] = (max(length, 2 * abs(x)), max(length / PROPORTION, 2 * abs(y)))
    return sizes


def _rectangle(center: Point, front: Point, length: float, width: float) -> tuple[Point, ...]:
    left = (-front[1], front[0])
    return tuple(
        plus(center, plus(scaled(front, i * length / 2), scaled(left, j * width / 2)))
        for i, j in ((1, -1), (1, 1), (-1, 1), (-1, -1))
    )


def _clipped(outline: Sequence[Point], inward: Point) -> tuple[Point, ...]:
    """What of a convex outline lies on the ``inward`` side of the line through the origin."""
    result: list[Point] = []
    for start, end in zip(outline, (*outline[1:], outline[0]), strict=True):
        first, second = dot(start, inward), dot(end, inward)
        if first >= 0:
            result.append(start)
        if first * second < 0:
            result.append(plus(start, scaled(minus(end, start), first / (first - second))))
    return tuple(result)
