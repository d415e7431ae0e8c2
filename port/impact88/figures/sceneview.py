"""The scene from above, drawn: vehicles, contact plane, velocities, spins, impulse, key and table.

Where everything is comes from `figures.scenegeometry`; here it is put on paper.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ..units import RULES, System, system_of
from . import drawing as d
from .drawing import Box, Drawing, Path, Point, Text
from .labels import Label, place
from .scenegeometry import Plan, Vehicle, dot, minus, plan, plus, scaled
from .svg import Svg, svg

COLOURS = {"A": d.BLUE, "B": d.VERMILION}
TINTS = {"A": "#d6e8f3", "B": "#fbe6d8"}
IMPULSE = "#a03c78"
"""A darker reddish purple than Okabe and Ito's: thin lines need it on white."""

_MARGIN = 6.0
TEXT = 6.5
ROW = 3.4
FIELD = 70.0
"""Largest height in mm of the drawing proper."""


def scene_drawing(
    scene: Any,
    result: Mapping[str, Any] | None = None,
    width: float = d.COLUMN,
    title: str = "Scene from above",
    units: System | None = None,
    outlines: Mapping[str, float] | None = None,
) -> Drawing:
    """The scene from above, with key and table, ``width`` mm wide. Arguments as `plan`.

    Velocities before the impact end at the center of gravity, those after it start there, in one
    scale; both vehicles' spins turn around their centers.
    """
    if outlines is None and hasattr(scene, "entries"):
        outlines = scene.entries.outlines
    shapes = plan(scene, result, outlines)
    if units is None:
        units = system_of(getattr(scene, "units", None))
    field = _Field(shapes, width)
    notes = notes_of(shapes, units, width - 4)
    footer = ROW * (4 + 3 + len(notes)) + 5.5
    head = _wrapped(title, (width - 4) / d.BOLD)
    height = field.height + footer + ROW * len(head)
    drawing = Drawing(width, height, title, description(shapes, units))
    for line, text in enumerate(head, 1):
        drawing.items.append(Text(2.0, height - ROW * line, text, 7, bold=True, role="title"))
    field.draw(drawing, footer)
    _legend(drawing, shapes, field, footer, notes, units)
    return drawing


def scene_svg(scene: Any, result: Mapping[str, Any] | None = None) -> Svg:
    """The scene as a self-contained SVG element, 85 mm wide, to stand in an HTML page or a file.

    ``scene``: an `impact88.Scene` or any mapping of the listing's names to texts or numbers;
    ``result``: VAX, VAY, VBX, VBY, WAF, WBF and, where known, STATUS (see `impact88.solve`);
    without it only what is before the impact is drawn. Units as the scene's. Raises UserError when
    a value of the scene is missing or not a finite number.

    >>> impact88.scene_svg(impact88.sample(1))[:4]
    '<svg'
    """
    from ..mappings import in_base

    return svg(scene_drawing(in_base(scene), result))


class _Field:
    """The drawing proper: where a point of the plan is on paper."""

    def __init__(self, shapes: Plan, width: float, margin: float = _MARGIN) -> None:
        self.shapes = shapes
        self.speed = max(
            [v.before.speed for v in shapes.vehicles]
            + [v.after.speed for v in shapes.vehicles if v.after]
        )
        vehicles = [vehicle for vehicle in shapes.vehicles if not vehicle.wall]
        self.size = max(vehicle.length for vehicle in vehicles or shapes.vehicles)
        self.per_speed = 0.95 * self.size / self.speed if self.speed else 0.0
        box = d.extent(self._points())
        room = width - 2 * margin
        self.scale = min(
            room / (box.right - box.left),
            (FIELD + 0.3 * (width - d.COLUMN) - 2 * margin) / (box.top - box.bottom),
        )
        self.height = self.scale * (box.top - box.bottom) + 2 * margin
        self.origin = (
            (width - self.scale * (box.left + box.right)) / 2,
            margin - self.scale * box.bottom,
        )

    def _points(self) -> list[Point]:
        points: list[Point] = [(0.0, 0.0)]
        for vehicle in self.shapes.vehicles:
            if vehicle.wall:
                points += self.wall_face(vehicle)
            else:
                points += vehicle.outline
                for start, end in self.arrows(vehicle).values():
                    points += [start, end]
        half = self.plane_half()
        points += [scaled(self.shapes.tangent, half), scaled(self.shapes.tangent, -half)]
        # the n axis stands at the plane's end
        points.append(
            plus(scaled(self.shapes.tangent, half), scaled(self.shapes.normal, 0.3 * self.size))
        )
        if tip := self.impulse_end():
            points += [tip, scaled(tip, -1.0)]
        return points

    def plane_half(self) -> float:
        """How far the contact plane is drawn to either side."""
        return 0.62 * self.size

    def wall_face(self, vehicle: Vehicle) -> list[Point]:
        """Four corners of the strip a wall is drawn as."""
        inward = scaled(self.shapes.normal, 1.0 if vehicle.name == "A" else -1.0)
        half = scaled(self.shapes.tangent, self.plane_half())
        depth = scaled(inward, 0.12 * self.size)
        return [
            scaled(half, -1.0),
            half,
            plus(half, depth),
            minus(depth, half),
        ]

    def arrows(self, vehicle: Vehicle) -> dict[str, tuple[Point, Point]]:
        """Start and end of the velocities of a vehicle that moves, in the plan's units."""
        result = {}
        least = 1e-3 * self.speed
        if vehicle.before.speed > least:
            run = scaled(vehicle.before.velocity, self.per_speed)
            result["before"] = (minus(vehicle.center, run), vehicle.center)
        if vehicle.after and vehicle.after.speed > least:
            run = scaled(vehicle.after.velocity, self.per_speed)
            start = vehicle.center
            if "before" in result:
                # coming and going on one line: the way back is drawn beside the way in
                back = vehicle.before.velocity
                cosine = dot(back, run) / (math.hypot(*back) * math.hypot(*run))
                if cosine < -0.97:
                    unit = scaled(back, 1 / math.hypot(*back))
                    start = plus(start, scaled((-unit[1], unit[0]), 0.06 * self.size))
            result["after"] = (start, plus(start, run))
        if vehicle.after:
            change = minus(vehicle.after.velocity, vehicle.before.velocity)
            # where one of the two is zero, the change lies on the other
            if min(vehicle.before.speed, vehicle.after.speed, math.hypot(*change)) > least:
                end = plus(vehicle.center, scaled(change, self.per_speed))
                result["change"] = (vehicle.center, end)
        return result

    def impulse_end(self) -> Point | None:
        """Where the impulse's arrow from the contact point ends; None when there is none."""
        impulse = self.shapes.impulse
        if impulse is None or math.hypot(*impulse) == 0:
            return None
        return scaled(impulse, 0.5 * self.size / math.hypot(*impulse))

    def _draw_impulse(self, items: list[Path | Text], labels: list[Label], at: Any) -> None:
        """The force on each vehicle, and from where on its clock it comes."""
        if not (end := self.impulse_end()):
            return
        for vehicle, sense, sign in zip(self.shapes.vehicles, (1.0, -1.0), "P−", strict=True):
            if vehicle.wall:
                continue
            tip = scaled(end, sense)
            role = "impulse" if sign == "P" else "opposite impulse"
            width, head = (0.9, 2.8) if sign == "P" else (0.45, 2.2)
            items += d.arrow(at((0.0, 0.0)), at(tip), IMPULSE, width, head=head, role=role)
            text = f"{sign.strip('P')}P, {clock_of(vehicle, self.shapes.impulse)}"
            labels.append(Label(at(tip), tip, text, 7.5, IMPULSE, sign == "P", f"{role} label"))

    def paper(self, point: Point, footer: float = 0.0) -> Point:
        """A point of the plan on paper."""
        return (
            self.origin[0] + self.scale * point[0],
            footer + self.origin[1] + self.scale * point[1],
        )

    def draw(self, drawing: Drawing, footer: float) -> None:
        """Everything above the legend, then the labels."""

        def at(point: Point) -> Point:
            return self.paper(point, footer)

        def ats(points: Sequence[Point]) -> tuple[Point, ...]:
            return tuple(at(point) for point in points)

        items = drawing.items
        labels: list[Label] = []
        bodies = [vehicle for vehicle in self.shapes.vehicles if not vehicle.wall]
        for vehicle in self.shapes.vehicles:
            if vehicle.wall:
                self._draw_wall(items, vehicle, ats)
        draw_bodies(items, bodies, ats)
        self._draw_plane(items, labels, at)
        for vehicle in self.shapes.vehicles:
            if not vehicle.wall:
                self._draw_motion(items, labels, vehicle, at)
        self._draw_impulse(items, labels, at)
        contact = at((0.0, 0.0))
        items.append(Path(d.circle(contact, 0.75), d.BLACK, 0.3, fill=d.WHITE, role="contact"))
        items.append(Path(d.circle(contact, 0.2), None, fill=d.BLACK))
        away = scaled(self.shapes.tangent, -1.0)
        labels.append(Label(contact, away, "C", 8.0, d.BLACK, False, "contact label"))
        for vehicle in self.shapes.vehicles:
            colour = COLOURS[vehicle.name]
            where, towards = at(vehicle.center), scaled(vehicle.front, -1.0)
            if vehicle.wall:
                face = self.wall_face(vehicle)
                where = at(scaled(plus(face[2], face[3]), 0.5))
                towards = minus(face[3], face[0])
            labels.insert(
                0, Label(where, towards, vehicle.name, 10, colour, True, f"{vehicle.name} label")
            )
        draw_axes(drawing, footer, footer + self.height)
        frame = Box(0.8, footer, drawing.width - 0.8, footer + self.height - 0.4)
        place(drawing, labels, frame)

    def _draw_wall(self, items: list[Path | Text], vehicle: Vehicle, ats: Any) -> None:
        face = self.wall_face(vehicle)
        role = f"{vehicle.name} wall"
        items.append(Path(ats(face), None, fill=TINTS[vehicle.name], role=role))
        items.append(Path(ats(face[:2]), COLOURS[vehicle.name], 0.7, role=role))
        for step in range(12):
            low = plus(face[0], scaled(minus(face[1], face[0]), (step + 0.5) / 12))
            high = plus(face[3], scaled(minus(face[2], face[3]), (step + 1) / 12))
            items.append(Path(ats([low, high]), COLOURS[vehicle.name], 0.2, role=role))

    def _draw_plane(self, items: list[Path | Text], labels: list[Label], project: Any) -> None:
        half = scaled(self.shapes.tangent, self.plane_half())
        plane = (project(scaled(half, -1.0)), project(half))
        items.append(Path(plane, d.BLACK, 0.3, (2.4, 0.8, 0.4, 0.8), role="contact plane"))
        corner = scaled(half, 0.72)
        for unit, name in ((self.shapes.normal, "n"), (self.shapes.tangent, "t")):
            end = plus(corner, scaled(unit, 0.28 * self.size))
            if name == "t":
                end = scaled(half, 1.0)
            items += d.arrow(
                project(corner), project(end), d.BLACK, 0.35, head=1.8, role=f"{name} axis"
            )
            labels.append(Label(project(end), unit, name, 8, d.BLACK, False, f"{name} label"))

    def _draw_motion(
        self, items: list[Path | Text], labels: list[Label], vehicle: Vehicle, project: Any
    ) -> None:
        colour, name = COLOURS[vehicle.name], vehicle.name.lower()
        center = project(vehicle.center)
        for kind, (start, end) in self.arrows(vehicle).items():
            symbol, width, dash, head = ARROWS[kind]
            role = f"{vehicle.name} {kind}"
            items += d.arrow(project(start), project(end), colour, width, dash, head, role)
            at, back = (start, end) if kind == "before" else (end, start)
            text = f"{symbol}_{name}"
            labels.append(
                Label(project(at), minus(at, back), text, 8, colour, False, f"{text} label")
            )
        least = 1e-4 * self.speed / self.size
        turns: list[tuple[str, float, float, tuple[float, ...]]]
        turns = [("ω", vehicle.before.spin, 2.9, (0.9, 0.6))]
        if vehicle.after:
            turns.append(("Ω", vehicle.after.spin, 3.9, ()))
        opening = math.degrees(math.atan2(vehicle.front[1], vehicle.front[0])) + 180
        for symbol, spin, radius, dash in turns:
            if not abs(spin) > least:
                continue
            role = f"{vehicle.name} spin"
            items += d.turning_arrow(
                center, radius, spin > 0, colour, 0.4, dash, opening, role=role
            )
            edge = plus(center, scaled(vehicle.front, radius))
            text = f"{symbol}_{name}"
            labels.append(Label(edge, minus(edge, center), text, 8, colour, False, f"{text} label"))
        items.append(
            Path(d.circle(center, 0.7), colour, 0.3, fill=d.WHITE, role=f"{vehicle.name} center")
        )


ARROWS: dict[str, tuple[str, float, tuple[float, ...], float]] = {
    "before": ("v", 0.45, (1.3, 0.7), 2.2),
    "after": ("V", 0.65, (), 2.5),
    "change": ("ΔV", 0.3, (0.4, 0.5), 1.8),
}
"""Velocities of a vehicle: symbol, width, dashes and head of the arrow."""


def draw_axes(drawing: Drawing, bottom: float, top: float) -> None:
    """The x and y axes, in the corner between ``bottom`` and ``top`` with the fewest lines."""
    segments = list(drawing.segments())
    side = 9.0
    boxes = [
        Box(left, low, left + side, low + side)
        for left in (1.0, drawing.width - side - 1.0)
        for low in (bottom + 0.5, top - side - 0.5)
    ]
    box = min(boxes, key=lambda box: sum(box.crosses(*segment) for segment in segments))
    origin = (box.left + 1.0, box.bottom + 1.0)
    for unit, name in (((1.0, 0.0), "x"), ((0.0, 1.0), "y")):
        end = plus(origin, scaled(unit, 5.5))
        drawing.items += d.arrow(origin, end, d.GREY, 0.25, head=1.5, role=f"{name} axis")
        shift = (0.7, -0.7) if name == "x" else (0.6, -0.2)
        drawing.items.append(
            Text(
                *plus(end, shift),
                name,
                7,
                colour=d.GREY,
                role=f"{name} label",
            )
        )


def draw_bodies(items: list[Path | Text], vehicles: Sequence[Vehicle], ats: Any) -> None:
    """Vehicles' outlines, what of them is crushed, and marks that show their fronts; ``ats`` maps
    points of the plan to paper. All lines lie over all grounds: what of one vehicle is crushed lies
    in the other."""
    for vehicle in vehicles:
        items.append(Path(ats(vehicle.kept), None, fill=TINTS[vehicle.name], role="body"))
    for vehicle in vehicles:
        _draw_lines(items, vehicle, ats)


def _draw_lines(items: list[Path | Text], vehicle: Vehicle, ats: Any) -> None:
    colour = COLOURS[vehicle.name]
    outline = (*vehicle.outline, vehicle.outline[0])
    if vehicle.kept != vehicle.outline:
        items.append(Path(ats(outline), colour, 0.25, (0.7, 0.5), role=f"{vehicle.name} whole"))
    items.append(
        Path(
            ats((*vehicle.kept, vehicle.kept[0])),
            colour,
            0.45,
            role=f"{vehicle.name} outline",
        )
    )
    # the front: a windscreen's line and an arrowhead, as on a police sketch
    left = (-vehicle.front[1], vehicle.front[0])
    for along, across in ((0.22, 0.38), (-0.3, 0.36)):
        middle = plus(vehicle.center, scaled(vehicle.front, along * vehicle.length))
        half = scaled(left, across * vehicle.width)
        items.append(
            Path(ats([minus(middle, half), plus(middle, half)]), colour, 0.2, role="glass")
        )
    nose = plus(vehicle.center, scaled(vehicle.front, 0.36 * vehicle.length))
    back = plus(vehicle.center, scaled(vehicle.front, 0.25 * vehicle.length))
    half = scaled(left, 0.16 * vehicle.width)
    tip = [plus(back, half), nose, minus(back, half)]
    items.append(Path(ats(tip), colour, 0.3, role="heading"))


def short(value: float) -> str:
    """A number to four digits (three and an exponent where very large or small), with a true minus
    sign."""
    text = f"{value:.4g}"
    return (f"{value:.3g}" if "e" in text else text).replace("-", "−")


def notes_of(shapes: Plan, units: System, room: float) -> list[str]:
    """What a reader must know of a drawing, in lines of that many mm."""
    notes = []
    for vehicle in shapes.vehicles:
        if vehicle.name in shapes.measured:
            size = (short(units.shown(_LENGTH, x)) for x in (vehicle.length, vehicle.width))
            unit = "" if units is RULES else " " + units.label(_LENGTH)
            notes.append(f"{vehicle.name} drawn as measured, {' by '.join(size)}{unit}.")
    assumed = [v.name for v in shapes.vehicles if v.name not in shapes.measured]
    if assumed:
        whose = "Outlines" if len(assumed) == 2 else f"Outline of {assumed[0]}"
        notes.append(f"{whose} from I/m, L/W = 2.6: not measured.")
    if not any(vehicle.wall for vehicle in shapes.vehicles):
        speed = short(units.shown(_SPEED, shapes.closing))
        notes.append(f"Closing speed {speed}{'' if units is RULES else ' ' + units.label(_SPEED)}.")
    if units is not RULES:
        notes.append(f"Speeds in {units.label(_SPEED)}, spins in {units.label(_SPIN)}.")
    notes = [" ".join(notes)]
    if shapes.apart:
        notes.append("Point masses: drawn moved apart along n.")
    if any(vehicle.wall for vehicle in shapes.vehicles):
        notes.append("The hatched vehicle's mass makes it a rigid barrier.")
    notes += [f"Remark: {remark}." for remark in shapes.remarks]
    return [line for note in notes for line in _wrapped(note, room)]


def clock_of(vehicle: Vehicle, impulse: Point | None) -> str:
    """The hour from which the force on a vehicle comes; ``impulse`` acts on A."""
    return f"{round(pdof(vehicle, impulse) / 30) % 12 or 12} o'clock" if impulse else ""


def pdof(vehicle: Vehicle, impulse: Point) -> float:
    """Where the force on a vehicle comes from, in degrees clockwise from its front."""
    source = scaled(impulse, -1.0 if vehicle.name == "A" else 1.0)
    across = vehicle.front[0] * source[1] - vehicle.front[1] * source[0]
    return -math.degrees(math.atan2(across, dot(vehicle.front, source)))


def _wrapped(text: str, room: float) -> list[str]:
    lines = [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}".strip()
        if d.text_width(longer, TEXT) > room and lines[-1]:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


def _round_below(value: float) -> float:
    """The largest 1, 2 or 5 times a power of ten that is not above ``value``."""
    if not value > 0:
        return 0.0
    power = 10.0 ** math.floor(math.log10(value))
    return max(step * power for step in (1, 2, 5) if step * power <= value * (1 + 1e-12))


def _legend(
    drawing: Drawing,
    shapes: Plan,
    field: _Field,
    footer: float,
    notes: Sequence[str],
    units: System,
) -> None:
    """Key, scales, table and notes below the drawing."""
    items = drawing.items
    left, middle = 2.0, 44.0
    y = footer - ROW
    sample = 8.0

    def entry(x: float, y: float, paths: list[Path], text: str) -> None:
        items.extend(paths)
        items.append(Text(x + sample + 1.5, y - 0.8, text, TEXT, role="legend"))

    def velocity(y: float, kind: str, text: str) -> None:
        _, width, dash, head = ARROWS[kind]
        entry(left, y, d.arrow((left, y), (left + sample, y), d.BLACK, width, dash, head), text)

    velocity(y, "before", "velocity before")
    plane = [Path(((middle, y), (middle + sample, y)), d.BLACK, 0.3, (2.4, 0.8, 0.4, 0.8))]
    entry(middle, y, plane, "contact plane, Γ = " + short(shapes.numbers["GA"]) + "°")
    y -= ROW
    velocity(y, "after", "velocity after")
    if field.speed:
        per_unit = field.scale * field.per_speed / units.shown(_SPEED, 1.0)
        _scale(items, middle, y, units.shown(_SPEED, field.speed), per_unit, _SPEED, units)
    y -= ROW
    if shapes.impulse is not None:
        velocity(y, "change", "velocity change ΔV")
    per_unit = field.scale / units.shown(_LENGTH, 1.0)
    _scale(items, middle, y, units.shown(_LENGTH, field.size), per_unit, _LENGTH, units)
    y -= ROW
    if shapes.impulse is not None:
        size = short(math.hypot(*shapes.impulse) * units.shown("mass·length/time", 1.0))
        unit = "" if units is RULES else " " + units.label("mass·length/time")
        force = d.arrow((left, y), (left + sample, y), IMPULSE, 0.9, (), 2.8)
        entry(left, y, force, f"impulse P on A, {size}{unit}")
    if any(v.kept != v.outline and not v.wall for v in shapes.vehicles):
        entry(
            middle,
            y,
            [Path(((middle, y), (middle + sample, y)), d.GREY, 0.25, (0.7, 0.5))],
            "crushed",
        )
    y -= 2.4
    items.append(Path(((left, y), (drawing.width - left, y)), d.GREY, 0.2))
    y = draw_table(drawing, shapes, y, units)
    items.append(Path(((left, y + 2.0), (drawing.width - left, y + 2.0)), d.GREY, 0.2))
    for note in notes:
        items.append(Text(left, y - 0.9, note, TEXT, colour=d.GREY, role="note"))
        y -= ROW


_SPEED, _LENGTH, _SPIN = "length/time", "length", "rad/time"


def _scale(
    items: list[Path | Text],
    x: float,
    y: float,
    size: float,
    per_unit: float,
    rule: str,
    units: System,
) -> None:
    """A bar of a round amount, about half of ``size``, and what it stands for."""
    amount = _round_below(size * 0.5)
    end = x + per_unit * amount
    word = {_SPEED: "speed", _LENGTH: "length"}[rule]
    items.append(Path(((x, y), (end, y)), d.BLACK, 0.4, role=f"{word} scale"))
    for tick in (x, end):
        items.append(Path(((tick, y - 0.7), (tick, y + 0.7)), d.BLACK, 0.4))
    text = f"{word} {short(amount)}" if units is RULES else f"{short(amount)} {units.label(rule)}"
    items.append(Text(end + 1.5, y - 0.8, text, TEXT, role="legend"))


_COLUMNS = {
    **{"speed before": 17.2, "after": 28.8, "ΔV": 40.4},
    **{"force from": 53.4, "spin before": 68.0, "spin after": 83.0},
}
"""The table's headings and where its columns end, in mm of a drawing one column wide."""


def draw_table(drawing: Drawing, shapes: Plan, y: float, units: System) -> float:
    """Speeds, changes, directions and spins below ``y``; returns where what follows goes on."""
    y -= ROW - 0.3
    columns = [end * drawing.width / d.COLUMN for end in _COLUMNS.values()]
    drawing.items += [
        Text(x, y, head.replace("spin after", "after"), TEXT, "end", role="table")
        for x, head in zip(columns, _COLUMNS, strict=True)
    ]
    for vehicle in shapes.vehicles:
        y -= ROW
        before, after = vehicle.before, vehicle.after
        point, wall = shapes.numbers["M"] == 4, vehicle.wall
        force = shapes.impulse if after and not wall else None
        cells = [
            short(units.shown(_SPEED, before.speed)),
            short(units.shown(_SPEED, after.speed)) if after and not wall else "–",
            short(units.shown(_SPEED, _change(vehicle))) if after and not wall else "–",
            f"{pdof(vehicle, force):.0f}°".replace("-", "−") if force and any(force) else "–",
            short(before.spin) if not point else "–",
            short(after.spin) if after and not wall and not point else "–",
        ]
        colour = COLOURS[vehicle.name]
        drawing.items.append(Text(2.0, y, vehicle.name, TEXT, "start", colour, True, "table"))
        drawing.items += [
            Text(x, y, cell, TEXT, "end", role="table")
            for x, cell in zip(columns, cells, strict=True)
        ]
    return y - ROW


def _change(vehicle: Vehicle) -> float:
    """The size of a vehicle's change of velocity."""
    assert vehicle.after is not None
    return math.dist(vehicle.after.velocity, vehicle.before.velocity)


def description(shapes: Plan, units: System) -> str:
    """What a drawing shows, in words."""

    def speed(value: float) -> str:
        unit = "" if units is RULES else " " + units.label(_SPEED)
        return short(units.shown(_SPEED, value)) + unit

    parts = []
    for vehicle in shapes.vehicles:
        text = f"Vehicle {vehicle.name}: speed {speed(vehicle.before.speed)} before"
        if vehicle.after:
            change = speed(_change(vehicle))
            text += f", {speed(vehicle.after.speed)} after, change of velocity {change}"
        if vehicle.after and shapes.impulse and any(shapes.impulse) and not vehicle.wall:
            text += f", force from {clock_of(vehicle, shapes.impulse)}"
        parts.append(text + ".")
    return " ".join(parts)
