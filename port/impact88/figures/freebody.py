"""Free-body diagrams of the chapter: Figure 2 (direct colinear) and Figure 3 (planar impact).

The two vehicles are drawn pulled apart along the normal, so that each shows the impulses on it:
P_n, P_t and the moment impulse M on A, their opposites on B. Figure 3 may be drawn for any scene;
without one it takes the Appendix's.
"""

from __future__ import annotations

import math
from typing import Any

from . import drawing as d
from .drawing import Box, Drawing, Path, Point, Text
from .labels import Label, place
from .scenegeometry import Plan, Vehicle, plan
from .sceneview import COLOURS, IMPULSE, TINTS, draw_axes

_ANGLE = "#444444"
_MARGIN = 7.5
_TALLEST = 95.0


def colinear() -> Drawing:
    """Figure 2: direct colinear impact, no rotation."""
    drawing = Drawing(
        d.COLUMN,
        45.0,
        "Free bodies, direct colinear impact",
        "Two vehicles pulled apart, with the impulse components P_n and P_t on each, opposite "
        "in direction, and the normal and tangential axes.",
    )
    labels: list[Label] = []
    middle = (42.5, 20.0)
    for name, side in (("B", -1.0), ("A", 1.0)):
        center = (middle[0] + side * 24.5, middle[1])
        length, width = 22.0, 8.5
        face = (center[0] - side * length / 2, center[1])
        corners = tuple(
            (center[0] + i * length / 2, center[1] + j * width / 2)
            for i, j in ((1, 1), (1, -1), (-1, -1), (-1, 1))
        )
        drawing.items.append(Path(corners, COLOURS[name], 0.45, fill=TINTS[name], role=name))
        drawing.items.append(Path(d.circle(center, 0.7), COLOURS[name], 0.3, fill=d.WHITE))
        labels.append(Label(center, (0.0, 1.0), name, 10, COLOURS[name], True))
        low = name.lower()
        # impulses act on the face in contact: on A along n and t, on B against them
        for symbol, along in (("n", (side, 0.0)), ("t", (0.0, side))):
            size = 9.0 if symbol == "n" else 8.0
            outside = (face[0] - side * size, face[1]) if symbol == "n" else face
            end = (outside[0] + size * along[0], outside[1] + size * along[1])
            drawing.items += d.arrow(outside, end, IMPULSE, 0.8, head=2.6, role="impulse")
            tip = outside if symbol == "n" else end
            sign = "" if name == "A" else "−"
            towards = (0.0, -side) if symbol == "n" else along
            labels.append(
                Label(tip, towards, f"{sign}P_{symbol}", 8, IMPULSE, True, "impulse label")
            )
        # velocities stand below the vehicle: v before, V after
        base = (center[0], center[1] - width / 2 - 3.0)
        end = (base[0] - side * 8.0, base[1])
        drawing.items += d.arrow(base, end, COLOURS[name], 0.45, (1.3, 0.7), 2.2, "velocity")
        labels.append(Label(base, (side, 0.0), f"v_{{{low}n}}, v_{{{low}t}}", 8, COLOURS[name]))
    origin = (middle[0] - 4.0, 33.0)
    for unit, name in (((1.0, 0.0), "n"), ((0.0, 1.0), "t")):
        end = (origin[0] + 8 * unit[0], origin[1] + 8 * unit[1])
        drawing.items += d.arrow(origin, end, d.BLACK, 0.35, head=1.8, role=f"{name} axis")
        labels.append(Label(end, unit, name, 8))
    drawing.items.append(
        Text(
            drawing.width / 2,
            2.2,
            "m (V − v) = impulse, for each vehicle along n and t",
            6.5,
            "middle",
            d.GREY,
            role="note",
        )
    )
    place(drawing, labels, Box(0.8, 5.5, drawing.width - 0.8, drawing.height - 0.4))
    return drawing


def planar(scene: Any = None) -> Drawing:
    """Figure 3: planar impact; distances, angles and impulses of a scene's two vehicles.

    Raises UserError when a value of the scene is missing or no number.
    """
    if scene is None:
        from ..scene import sample

        scene = sample(1)
    shapes = plan(scene)
    drawing = Drawing(
        d.COLUMN,
        _TALLEST,
        "Free bodies, planar impact",
        "Both vehicles pulled apart along the normal, with heading angles, distance and angle of "
        "the contact point, axes n and t, impulses P_n and P_t and moment impulse M on each.",
    )
    point = shapes.apart or shapes.numbers["M"] == 4
    size = max(vehicle.length for vehicle in shapes.vehicles)
    shift = {v.name: (0.42 if v.name == "A" else -0.42) * size for v in shapes.vehicles}
    moved = {name: (by * shapes.normal[0], by * shapes.normal[1]) for name, by in shift.items()}
    points = [
        (x + moved[v.name][0], y + moved[v.name][1]) for v in shapes.vehicles for x, y in v.outline
    ]
    reach = 0.42 * size
    for vehicle in shapes.vehicles:
        contact = moved[vehicle.name]
        for unit in (shapes.normal, shapes.tangent):
            for sign in (1, -1):
                points.append(
                    (contact[0] + sign * reach * unit[0], contact[1] + sign * reach * unit[1])
                )
        center = (vehicle.center[0] + contact[0], vehicle.center[1] + contact[1])
        # the arm heading angles are measured from
        points.append((center[0] + 0.45 * size, center[1]))
    box = d.extent(points)
    scale = min(
        (drawing.width - 2 * _MARGIN) / (box.right - box.left),
        (_TALLEST - 2 * _MARGIN) / (box.top - box.bottom),
    )
    drawing.height = scale * (box.top - box.bottom) + 2 * _MARGIN
    origin = (
        (drawing.width - scale * (box.left + box.right)) / 2,
        _MARGIN - scale * box.bottom,
    )

    labels: list[Label] = []
    for vehicle in shapes.vehicles:
        offset = moved[vehicle.name]

        def at(point: Point, offset: Point = offset) -> Point:
            return (
                origin[0] + scale * (point[0] + offset[0]),
                origin[1] + scale * (point[1] + offset[1]),
            )

        _body(drawing, labels, shapes, vehicle, at, scale * size, point)
    _plane(drawing.items, labels, shapes, origin, scale * size)
    draw_axes(drawing, 0.0, drawing.height)
    place(drawing, labels, Box(0.6, 0.4, drawing.width - 0.6, drawing.height - 0.4))
    return drawing


def _body(
    drawing: Drawing,
    labels: list[Label],
    shapes: Plan,
    vehicle: Vehicle,
    project: Any,
    size: float,
    point: bool,
) -> None:
    """One body; of a point mass the impulse acts at its center, and nothing turns it."""
    items = drawing.items
    colour = COLOURS[vehicle.name]
    outline = tuple(project(point) for point in vehicle.outline)
    items.append(Path(outline, colour, 0.45, fill=TINTS[vehicle.name], role="body outline"))
    center = project(vehicle.center)
    contact = center if point else project((0.0, 0.0))
    labels.insert(0, Label(center, _back(vehicle), vehicle.name, 10, colour, True))
    if not point:
        _angles(items, labels, shapes, vehicle, center, contact, size)

    # impulses: on A along n and t, on B against them
    sense = 1.0 if vehicle.name == "A" else -1.0
    minus = "" if vehicle.name == "A" else "−"
    reach = 0.3 * size
    for unit, symbol in ((shapes.normal, "n"), (shapes.tangent, "t")):
        along = (sense * unit[0], sense * unit[1])
        end = (contact[0] + reach * along[0], contact[1] + reach * along[1])
        items += d.arrow(contact, end, IMPULSE, 0.8, head=2.6, role="impulse")
        labels.append(Label(end, along, f"{minus}P_{symbol}", 8, IMPULSE, True, "impulse label"))
    if not point:
        outward = math.degrees(math.atan2(-sense * shapes.normal[1], -sense * shapes.normal[0]))
        items += d.turning_arrow(
            contact, 3.4, vehicle.name == "A", IMPULSE, 0.6, (), outward + 180, 200, role="moment"
        )
        edge = (
            contact[0] + 3.4 * math.cos(math.radians(outward)),
            contact[1] + 3.4 * math.sin(math.radians(outward)),
        )
        labels.append(
            Label(
                edge,
                (edge[0] - contact[0], edge[1] - contact[1]),
                f"{minus}M",
                8,
                IMPULSE,
                True,
                "moment label",
            )
        )
    items.append(Path(d.circle(center, 0.7), colour, 0.3, fill=d.WHITE, role="center"))
    if not point:
        items.append(Path(d.circle(contact, 0.5), d.BLACK, 0.3, fill=d.WHITE, role="contact"))


def _angles(
    items: list[Path | Text],
    labels: list[Label],
    shapes: Plan,
    vehicle: Vehicle,
    center: Point,
    contact: Point,
    size: float,
) -> None:
    """Heading angle, and distance and angle of the contact point."""
    low = vehicle.name.lower()
    # heading: TB of the front of B, TA of the rear of A (see figures.plan)
    sign = -1.0 if vehicle.name == "A" else 1.0
    axis = (sign * vehicle.front[0], sign * vehicle.front[1])
    heading = math.degrees(math.atan2(axis[1], axis[0]))
    arm = 0.34 * size
    _ray(items, center, axis, 0.5 * size)
    _ray(items, center, vehicle.front, 0.5 * size)
    _ray(items, center, (1.0, 0.0), arm)
    if abs(heading) > 3:
        labels.append(_arc(items, center, 0.0, heading, 0.28 * size, f"θ_{low}"))
    else:
        edge = (center[0] + arm, center[1])
        labels.append(Label(edge, (1.0, 0.3), f"θ_{low} = {heading:.3g}°", 7.5, _ANGLE))

    # distance and angle of the contact point from the front
    if math.dist(center, contact) > 0.02 * size:
        items.append(Path((center, contact), d.BLACK, 0.3, (1.0, 0.6), role="distance"))
        half = ((center[0] + contact[0]) / 2, (center[1] + contact[1]) / 2)
        across = (center[1] - contact[1], contact[0] - center[0])
        labels.append(Label(half, across, f"d_{low}", 8))
        front = math.degrees(math.atan2(vehicle.front[1], vehicle.front[0]))
        angle = shapes.numbers["P" + vehicle.name]
        if abs(angle) > 3:
            radius = min(0.16 * size, 0.6 * math.dist(center, contact))
            labels.append(_arc(items, center, front, angle, radius, f"φ_{low}"))


def _plane(
    items: list[Path | Text], labels: list[Label], shapes: Plan, contact: Point, size: float
) -> None:
    """The contact plane halfway between the bodies, its axes, and its angle from the y axis."""
    n, t = shapes.normal, shapes.tangent
    half = 0.36 * size
    ends = (
        (contact[0] - half * t[0], contact[1] - half * t[1]),
        (contact[0] + half * t[0], contact[1] + half * t[1]),
    )
    items.append(Path(ends, d.BLACK, 0.3, (2.4, 0.8, 0.4, 0.8), role="contact plane"))
    head = (contact[0] + 0.999 * half * t[0], contact[1] + 0.999 * half * t[1])
    items += d.arrow((head[0] - 2 * t[0], head[1] - 2 * t[1]), ends[1], d.BLACK, 0.35, head=1.8)
    labels.append(Label(ends[1], t, "t", 8))
    end = (contact[0] + 0.14 * size * n[0], contact[1] + 0.14 * size * n[1])
    items += d.arrow(contact, end, d.BLACK, 0.35, head=1.8, role="n axis")
    labels.append(Label(end, n, "n", 8))
    angle = shapes.numbers["GA"]
    if abs(angle) > 3:
        _ray(items, contact, (0.0, 1.0), 0.32 * size)
        labels.append(_arc(items, contact, 90.0, angle, 0.25 * size, "Γ"))


def _back(vehicle: Vehicle) -> Point:
    return (-vehicle.front[0], -vehicle.front[1])


def _ray(items: list[Path | Text], start: Point, unit: Point, length: float) -> None:
    end = (start[0] + length * unit[0], start[1] + length * unit[1])
    items.append(Path((start, end), _ANGLE, 0.18, (1.6, 0.6), role="ray"))


def _arc(
    items: list[Path | Text], center: Point, first: float, turn: float, radius: float, text: str
) -> Label:
    """An angle of ``turn`` degrees from the direction ``first``, and the label that names it."""
    turn = math.remainder(turn, 360)
    steps = max(6, int(abs(turn) / 4))
    points = tuple(
        (
            center[0] + radius * math.cos(math.radians(first + turn * step / steps)),
            center[1] + radius * math.sin(math.radians(first + turn * step / steps)),
        )
        for step in range(steps + 1)
    )
    items.append(Path(points, _ANGLE, 0.25, role="angle"))
    middle = points[steps // 2]
    towards = (middle[0] - center[0], middle[1] - center[1])
    return Label(middle, towards, text, 8, _ANGLE, False, "angle label")
