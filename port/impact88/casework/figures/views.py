"""Figure 4 of the chapter, configurations, and Figures 2 and 3, free bodies pulled apart along the
normal: each shows the impulses on it."""

import math
from typing import Any

from ...collision.casescene import sample
from ...collision.units import SYSTEMS
from . import drawing as d
from . import sceneview as view
from .drawing import Box, Drawing, Label, Path, Text, View, place
from .scenegeometry import Plan, Vehicle, plan
from .sceneview import COLOURS, IMPULSE_COLOUR, PLANE, TINTS, draw_axes, name_label

# in mm
_PANEL_GAP = 4.0  # between panels
_TITLE = 5.0  # height of a panel's title
_PAD = 3.5  # within a panel
_MARGIN = 7.5  # beside a free body
_TALLEST = 95.0  # height of a free body
_MOMENT = 3.4  # radius of a moment's arrow
_ANGLE = "#444444"  # colour of angles


def configurations() -> Drawing:
    """One collision of each category as it stood at contact, velocities before, one scale."""
    from ..chapter.staged import collisions

    chosen: dict[str, Any] = {}
    for collision in collisions():
        chosen.setdefault(collision.category, collision)
    plans = [
        plan({**item.scene, "E": 0, "MU": 0, "EM": -1, "M": 6}, units=SYSTEMS["chapter"])
        for item in chosen.values()
    ]
    arrow = 0.8 * max(v.length for shapes in plans for v in shapes.vehicles)
    boxes = [
        d.extent(p for v in shapes.vehicles for p in (*v.outline, _tail(v, shapes, arrow)))
        for shapes in plans
    ]
    wide = (d.COLUMN - _PANEL_GAP) / 2
    # one scale for all four: real cars of comparable size
    scale = min((wide - 2 * _PAD) / box.width for box in boxes)
    description = "Staged collisions: " + "; ".join(category.lower() for category in chosen) + "."
    drawing = Drawing(d.COLUMN, "Experimental collision configurations", description)
    top = 0.0
    for count, (category, collision) in enumerate(chosen.items()):
        row, column = divmod(count, 2)
        box, left = boxes[count], column * (wide + _PANEL_GAP)
        tall = scale * max(other.height for other in boxes[2 * row : 2 * row + 2]) + 2 * _PAD
        title = f"{'abcd'[count]}. {category.lower()} (no. {collision.number})"
        drawing.add(Text(complex(left + 1, top - 3.6), title, 7, role="panel title"))
        middle = complex(left + wide / 2, top - _TITLE - tall / 2)
        at = View(middle - scale * complex(box.left + box.right, box.bottom + box.top) / 2, scale)
        bottom = top - _TITLE - tall
        frame = Box(left + 0.3, bottom + 0.3, left + wide - 0.3, top - _TITLE + 0.5)
        view.draw_bodies(drawing, plans[count].vehicles, at)
        for vehicle in plans[count].vehicles:
            colour, center = COLOURS[vehicle.name], at(vehicle.center)
            start = at(_tail(vehicle, plans[count], arrow))
            drawing.add(*view.velocity_arrow(vehicle, "before", start, center, head=2.0))
            drawing.add(Path(d.circle(center, 0.5), colour, 0.3, fill=d.WHITE))
            drawing.add(name_label(vehicle, center, 0.3 + 1j, 8))
        drawing.add(Path(d.circle(at(0), 0.5), d.BLACK, 0.3, fill=d.WHITE))
        place(drawing, frame)
        if column:
            top = bottom
    drawing.height = 1.0 - top
    return drawing


def _tail(vehicle: Vehicle, shapes: Plan, arrow: float) -> complex:
    """Return the start of the arrow of a vehicle's velocity, the longest of ``arrow``."""
    fastest = max(other.before.speed for other in shapes.vehicles)
    return vehicle.center - arrow / fastest * vehicle.before.velocity


def colinear() -> Drawing:
    """Figure 2: direct colinear impact, no rotation."""
    angles = dict.fromkeys(("GA", "TA", "TB", "PA", "PB", "UY", "VY"), "0")
    drawing = planar(sample(2).replaced({**angles, "VX": "10"}), velocities=True)
    drawing.title = "Free bodies, direct colinear impact"
    drawing.description = (
        "Two vehicles pulled apart, with the impulse components P_n and P_t on each, opposite "
        "in direction, and the normal and tangential axes."
    )
    note = "m (V − v) = impulse, for each vehicle along n and t"
    drawing.height += 3
    at = complex(drawing.width / 2, 1.5 - drawing.height)
    drawing.add(Text(at, note, anchor="middle", colour=d.GREY, role="note"))
    return drawing


def planar(scene: Any = None, velocities: bool = False) -> Drawing:
    """Figure 3: planar impact; distances, angles and impulses of a scene's vehicles (the
    Appendix's without one), with the ``velocities`` before or without. Raises UserError."""
    shapes = plan(scene or sample(1), discs=False)
    drawing = Drawing(
        d.COLUMN,
        "Free bodies, planar impact",
        "Both vehicles pulled apart along the normal, with heading angles, distance and angle of "
        "the contact point, axes n and t, impulses P_n and P_t and moment impulse M on each.",
    )
    size = max(vehicle.length for vehicle in shapes.vehicles)
    apart = {"A": 0.42 * size * shapes.normal, "B": -0.42 * size * shapes.normal}
    points = []
    for vehicle in shapes.vehicles:
        shift = apart[vehicle.name]
        around = [0.42 * size * 1j**turn * shapes.normal for turn in range(4)]
        # the last is the arm heading angles are measured from
        ends = (*vehicle.outline, *around, vehicle.center + 0.45 * size)
        points += [shift + end for end in ends]
    box = d.extent(points)
    room = (drawing.width - 2 * _MARGIN, _TALLEST - 2 * _MARGIN)
    scale = min(room[0] / box.width, room[1] / box.height)
    drawing.height = scale * box.height + 2 * _MARGIN
    left = (drawing.width - scale * (box.left + box.right)) / 2
    at = View(complex(left, -_MARGIN - scale * box.top), scale)
    for vehicle in shapes.vehicles:
        placed_view = View(at(apart[vehicle.name]), scale)
        _body(drawing, shapes, vehicle, placed_view, scale * size)
        if velocities:
            low, colour = vehicle.name.lower(), COLOURS[vehicle.name]
            side = -0.9j if vehicle.name == "A" else 0.9j  # where P_t is not
            base = placed_view(vehicle.center + side * vehicle.width)
            end = base + 8 * vehicle.before.velocity / vehicle.before.speed
            drawing.add(*view.velocity_arrow(vehicle, "before", base, end, role="velocity"))
            drawing.add(Label(base, base - end, f"v_{{{low}n}}, v_{{{low}t}}", colour=colour))
    # the contact plane halfway between the bodies, its axes, and its angle from the y axis
    contact, size = at.origin, scale * size
    half = 0.36 * size * shapes.tangent
    drawing.add(Path((contact - half, contact + half), d.BLACK, 0.3, PLANE, role="contact plane"))
    normal = 0.14 * size * shapes.normal
    for start, end, name in ((half - 2 * shapes.tangent, half, "t"), (0, normal, "n")):
        drawing.add(*d.arrow(contact + start, contact + end, role=f"{name} axis", head=1.8))
        drawing.add(Label(contact + end, end, name))
    angle = shapes.numbers["GA"]
    if abs(angle) > 3:
        _ray(drawing, contact, contact + 0.32j * size)
        _angle(drawing, contact, 90.0, angle, 0.25 * size, "Γ")
    page = Box(0.6, 0.4 - drawing.height, drawing.width - 0.6, -0.4)
    draw_axes(drawing, page)
    place(drawing, page)
    return drawing


def _body(drawing: Drawing, shapes: Plan, vehicle: Vehicle, at: View, size: float) -> None:
    """One body; of a point mass the impulse acts at its center, and nothing turns it."""
    point = shapes.apart or shapes.numbers["M"] == 4
    colour = COLOURS[vehicle.name]
    body = at.all(vehicle.outline)
    drawing.add(Path(body, colour, 0.45, fill=TINTS[vehicle.name], role="body outline"))
    center = at(vehicle.center)
    contact = center if point else at(0)
    drawing.labels.insert(0, name_label(vehicle, center, -vehicle.front))
    if not point:
        low, arm = vehicle.name.lower(), 0.34 * size
        # heading: TB of the front of B, TA of the rear of A (see figures.scenegeometry)
        heading = d.degrees(-vehicle.front if vehicle.name == "A" else vehicle.front)
        for end in (-0.5 * size * vehicle.front, 0.5 * size * vehicle.front, arm):
            _ray(drawing, center, center + end)
        if abs(heading) > 3:
            _angle(drawing, center, 0.0, heading, 0.28 * size, f"θ_{low}")
        else:
            text = f"θ_{low} = {heading:.3g}°"
            drawing.add(Label(center + arm, 1 + 0.3j, text, 7.5, _ANGLE))
        # distance and angle of the contact point from the front
        reach, angle = contact - center, shapes.numbers["P" + vehicle.name]
        if abs(reach) > 0.02 * size:
            drawing.add(Path((center, contact), d.BLACK, 0.3, (1.0, 0.6), role="distance"))
            drawing.add(Label((center + contact) / 2, 1j * reach, f"d_{low}"))
            if abs(angle) > 3:
                radius, front = min(0.16 * size, 0.6 * abs(reach)), d.degrees(vehicle.front)
                _angle(drawing, center, front, angle, radius, f"φ_{low}")

    # impulses: on A along n and t, on B against them
    sense, minus = (1, "") if vehicle.name == "A" else (-1, "−")
    for along, symbol in ((shapes.normal, "n"), (shapes.tangent, "t")):
        end = contact + 0.3 * size * sense * along
        drawing.add(*d.arrow(contact, end, IMPULSE_COLOUR, 0.8, head=2.6, role="impulse"))
        text, role = f"{minus}P_{symbol}", "impulse label"
        drawing.add(Label(end, sense * along, text, 8, IMPULSE_COLOUR, True, role))
    if not point:
        outward = -sense * shapes.normal
        turn = contact, _MOMENT, sense, d.degrees(outward) + 180
        drawing.add(*d.turning_arrow(*turn, IMPULSE_COLOUR, 0.6, span=200, role="moment"))
        edge = contact + _MOMENT * outward
        drawing.add(Label(edge, outward, f"{minus}M", 8, IMPULSE_COLOUR, True, "moment label"))
    drawing.add(Path(d.circle(center, 0.7), colour, 0.3, fill=d.WHITE, role="center"))
    if not point:
        drawing.add(Path(d.circle(contact, 0.5), d.BLACK, 0.3, fill=d.WHITE, role="contact"))


def _ray(drawing: Drawing, start: complex, end: complex) -> None:
    drawing.add(Path((start, end), _ANGLE, 0.18, (1.6, 0.6), role="ray"))


def _angle(
    drawing: Drawing, center: complex, first: float, turn: float, radius: float, text: str
) -> None:
    """An angle of ``turn`` degrees from the direction ``first``, with its label."""
    points = d.arc(center, first, math.remainder(turn, 360), radius)
    drawing.add(Path(points, _ANGLE, 0.25, role="angle"))
    middle = points[len(points) // 2]
    drawing.add(Label(middle, middle - center, text, 8, _ANGLE, False, "angle label"))
