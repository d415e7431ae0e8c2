"""The scene from above, drawn: vehicles, contact plane, velocities, spins, impulse, key and table.
Where everything is comes from `scenegeometry`."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ...collision.geometry import clock
from ...collision.units import RULES, System
from ...messages.arguments import explains_arguments
from ...names import IMPULSE, LENGTH, SPIN, VELOCITY
from . import drawing as d
from .canvas import Svg, svg
from .drawing import ROW, Box, Drawing, Label, Path, Text, View, fitting, place, short
from .scenegeometry import Plan, Vehicle, plan

COLOURS = {"A": d.BLUE, "B": d.VERMILION}
TINTS = {"A": "#d6e8f3", "B": "#fbe6d8"}
IMPULSE_COLOUR = "#a03c78"
"""A darker reddish purple than Okabe and Ito's: thin lines need it on white."""
PLANE = (2.4, 0.8, 0.4, 0.8)
"""Dashes of the contact plane."""
ARROWS: dict[str, tuple[str, tuple[float, tuple[float, ...]], float]] = {
    "before": ("v", (0.45, (1.3, 0.7)), 2.2),
    "after": ("V", (0.65, ()), 2.5),
    "change": ("ΔV", (0.3, (0.4, 0.5)), 1.8),
}
"""Velocities of a vehicle: symbol, width and dashes of the arrow, and its head."""
FIELD = 70.0  # largest height of the drawing proper, in mm
_MARGIN = 6.0  # room for labels beside it, in mm


def scene_drawing(
    scene: Any,
    result: Mapping[str, Any] | None = None,
    width: float = d.COLUMN,
    title: str = "Scene from above",
    units: System | None = None,
    outlines: Mapping[str, float] | None = None,
    tallest: float = 0.0,
) -> Drawing:
    """The scene from above, with key and table, ``width`` mm wide; arguments as `plan`. Velocities
    before the impact end at the center of gravity, those after it start there, in one scale.
    ``tallest``: height in mm of what is drawn, of a page that has the numbers and the remarks
    beside it, which the drawing then leaves out."""
    shapes, units = plan_with_units(scene, result, units, outlines)
    drawing = Drawing(width, title, description(shapes, units))
    if tallest:
        field = _Field(shapes, width - _SECOND, 0.0, tallest)
        field.draw(drawing, mirrored=units.is_turned("UY"))
        low = _key(drawing, field, -2 * ROW, units, width - _SECOND + 2.0)
        y = min(low, field.frame.bottom) - ROW
        for text in d.wrap_text(_notes(shapes, units)[0], width - 4):
            drawing.add(Text(complex(2, y - 0.9), text, colour=d.GREY, role="note"))
            y -= ROW
        drawing.height = 0.9 - y
        return drawing
    field = _Field(shapes, width, drawing.heading())
    field.draw(drawing, mirrored=units.is_turned("UY"))
    y = _key(drawing, field, field.frame.bottom - ROW, units) - 2.4
    drawing.add(Path((2 + 1j * y, width - 2 + 1j * y), d.GREY, 0.2))
    table_and_notes(drawing, shapes, y, units)
    return drawing


def plan_with_units(
    scene: Any,
    result: Mapping[str, Any] | None,
    units: System | None,
    outlines: Mapping[str, float] | None,
) -> tuple[Plan, System]:
    """A scene in plan, with outlines and units as it carries them unless they are given."""
    case = getattr(scene, "case", None)
    if outlines is None and case is not None:
        outlines = case.outlines
    units = units or (case.system if case else RULES)
    return plan(scene, result, outlines, units), units


@explains_arguments
def scene_svg(scene: Any, result: Mapping[str, Any] | None = None) -> Svg:
    """Return the scene from above as an SVG element, 85 mm wide, for an HTML page or a file.

    Parameters
    ----------
    scene : Scene, or mapping of str to str or float
        The scene, by the listing's names.
    result : mapping of str to float, optional
        VAX, VAY, VBX, VBY, WAF, WBF and, where known, STATUS (see `impact88.solve`), in the scene's
        units; without it only what is before the impact is drawn.

    Returns
    -------
    Svg
        The SVG text, which a notebook shows as a picture.

    Raises
    ------
    UserError
        When a value of the scene is missing or not a finite number.

    Examples
    --------
    >>> impact88.scene_svg(impact88.sample(1))[:4]
    '<svg'
    """
    from ...collision.mappings import in_base

    return svg(scene_drawing(in_base(scene), result))


class _Field:
    """The drawing proper: vehicles and arrows, and where they are on paper below ``top``."""

    def __init__(self, shapes: Plan, width: float, top: float, tallest: float = 0.0) -> None:
        self.shapes = shapes
        motions = [m for v in shapes.vehicles for m in (v.before, v.after) if m]
        self.speed = max(motion.speed for motion in motions)
        self.size = max(vehicle.length for vehicle in shapes.bodies or shapes.vehicles)
        self.per_speed = 0.95 * self.size / self.speed if self.speed else 0.0
        self.half = 0.62 * self.size * shapes.tangent  # to the end of the contact plane
        self.force = 0j
        if shapes.impulse:
            self.force = 0.5 * self.size * shapes.impulse / abs(shapes.impulse)
        # the n axis stands at the plane's end
        points = [0j, self.half, -self.half, self.half + 0.3 * self.size * shapes.normal]
        for vehicle in shapes.vehicles:
            if vehicle.wall:
                points += self._face(vehicle)
            else:
                points += vehicle.outline
                points += [end for ends in self._arrows(vehicle).values() for end in ends]
        box = d.extent([*points, self.force, -self.force])
        tallest = tallest or FIELD + 0.3 * (width - d.COLUMN)
        scale = min((width - 2 * _MARGIN) / box.width, (tallest - 2 * _MARGIN) / box.height)
        bottom = top - scale * box.height - 2 * _MARGIN
        self.frame = Box(0.8, bottom, width - 0.8, top - 0.4)
        left = (width - scale * (box.left + box.right)) / 2
        self.at = View(complex(left, bottom + _MARGIN - scale * box.bottom), scale)

    def _face(self, vehicle: Vehicle) -> list[complex]:
        """Four corners of the strip a wall is drawn as."""
        depth = (0.12 if vehicle.name == "A" else -0.12) * self.size * self.shapes.normal
        return [-self.half, self.half, self.half + depth, depth - self.half]

    def _arrows(self, vehicle: Vehicle) -> dict[str, tuple[complex, complex]]:
        """Start and end of the velocities of a vehicle that moves, in the plan's units."""
        result = {}
        least, center = 1e-3 * self.speed, vehicle.center
        coming = self.per_speed * vehicle.before.velocity
        if vehicle.before.speed > least:
            result["before"] = (center - coming, center)
        if vehicle.after is None or vehicle.change is None:
            return result
        if vehicle.after.speed > least:
            run = self.per_speed * vehicle.after.velocity
            start = center
            direction = run * coming.conjugate()
            if "before" in result and direction.real < -0.97 * abs(direction):
                # coming and going on one line: the way back is drawn beside the way in
                start += 0.06j * self.size * coming / abs(coming)
            result["after"] = (start, start + run)
        # where one of the two is zero, the change lies on the other
        if min(vehicle.before.speed, vehicle.after.speed, abs(vehicle.change)) > least:
            result["change"] = (center, center + self.per_speed * vehicle.change)
        return result

    def draw(self, drawing: Drawing, mirrored: bool = False) -> None:
        at = self.at
        for vehicle in self.shapes.vehicles:
            if vehicle.wall:
                self._draw_wall(drawing, vehicle)
            else:
                drawing.add(name_label(vehicle, at(vehicle.center), -vehicle.front))
        draw_bodies(drawing, self.shapes.bodies, at)
        ends = at.all([-self.half, self.half])
        drawing.add(Path(ends, d.BLACK, 0.3, PLANE, role="contact plane"))
        corner = 0.72 * self.half
        normal = corner + 0.28 * self.size * self.shapes.normal
        for name, end in (("n", normal), ("t", self.half)):
            start, tip = at.all([corner, end])
            drawing.add(*d.arrow(start, tip, d.BLACK, 0.35, head=1.8, role=f"{name} axis"))
            drawing.add(Label(tip, tip - start, name, role=f"{name} label"))
        for vehicle in self.shapes.bodies:
            self._draw_motion(drawing, vehicle)
        for vehicle in self.shapes.bodies if self.shapes.impulse else ():
            # the force on a vehicle, and from where on its clock it comes
            force, symbol, role, width, head = (
                (self.force, "P", "impulse", 0.9, 2.8)
                if vehicle.name == "A"
                else (-self.force, "−P", "opposite impulse", 0.45, 2.2)
            )
            drawing.add(*d.arrow(at(0), at(force), IMPULSE_COLOUR, width, head=head, role=role))
            hour = f", {clock(vehicle.pdof(self.shapes.impulse or 0j))}" * vehicle.has_front
            text = f"{symbol}{hour}"
            bold = vehicle.name == "A"
            drawing.add(Label(at(force), force, text, 7.5, IMPULSE_COLOUR, bold, f"{role} label"))
        drawing.add(Path(d.circle(at(0), 0.75), d.BLACK, 0.3, fill=d.WHITE, role="contact"))
        drawing.add(Path(d.circle(at(0), 0.2), None, fill=d.BLACK))
        drawing.add(Label(at(0), -self.shapes.tangent, "C", role="contact label"))
        draw_axes(drawing, self.frame, mirrored)
        place(drawing, self.frame)

    def _draw_wall(self, drawing: Drawing, vehicle: Vehicle) -> None:
        first, second, third, fourth = self.at.all(self._face(vehicle))
        colour, role = COLOURS[vehicle.name], f"{vehicle.name} wall"
        drawing.add(Path((first, second, third, fourth), None, fill=TINTS[vehicle.name], role=role))
        drawing.add(Path((first, second), colour, 0.7, role=role))
        for step in range(12):
            low = first + (second - first) * (step + 0.5) / 12
            high = fourth + (third - fourth) * (step + 1) / 12
            drawing.add(Path((low, high), colour, 0.2, role=role))
        drawing.add(name_label(vehicle, (third + fourth) / 2, fourth - first))

    def _draw_motion(self, drawing: Drawing, vehicle: Vehicle) -> None:
        colour, name = COLOURS[vehicle.name], vehicle.name.lower()
        center = self.at(vehicle.center)
        for kind, ends in self._arrows(vehicle).items():
            start, end = self.at.all(ends)
            drawing.add(*velocity_arrow(vehicle, kind, start, end))
            text, at = f"{ARROWS[kind][0]}_{name}", start if kind == "before" else end
            towards = 2 * at - start - end
            drawing.add(Label(at, towards, text, colour=colour, role=f"{text} label"))
        turns = [("ω", vehicle.before, 2.9, (0.9, 0.6)), ("Ω", vehicle.after, 3.9, ())]
        for symbol, motion, radius, dash in turns:
            if motion is None or not abs(motion.spin) > 1e-4 * self.speed / self.size:
                continue
            turn = center, radius, 1 if motion.spin > 0 else -1, d.degrees(-vehicle.front)
            role = f"{vehicle.name} spin"
            drawing.add(*d.turning_arrow(*turn, colour, 0.4, dash, span=250, role=role))
            edge, text = center + radius * vehicle.front, f"{symbol}_{name}"
            drawing.add(Label(edge, vehicle.front, text, colour=colour, role=f"{text} label"))
        role = f"{vehicle.name} center"
        drawing.add(Path(d.circle(center, 0.7), colour, 0.3, fill=d.WHITE, role=role))


def velocity_arrow(
    vehicle: Vehicle, kind: str, start: complex, end: complex, head: float = 0.0, role: str = ""
) -> list[Path]:
    """A velocity of a vehicle on paper; ``head``, ``role``: where they are not the usual ones."""
    _, look, usual = ARROWS[kind]
    role, head = role or f"{vehicle.name} {kind}", head or usual
    return d.arrow(start, end, COLOURS[vehicle.name], *look, head=head, role=role)


def name_label(vehicle: Vehicle, at: complex, towards: complex, size: float = 10) -> Label:
    colour = COLOURS[vehicle.name]
    return Label(at, towards, vehicle.name, size, colour, True, f"{vehicle.name} label")


def draw_axes(drawing: Drawing, frame: Box, mirrored: bool = False) -> None:
    """The x and y axes, in the corner of ``frame`` with the fewest lines; ``mirrored``: y to the
    right of x, as the SAE's axes have it."""
    side = 9.0
    lefts, bottoms = (frame.left, frame.right - side), (frame.bottom + 0.5, frame.top - side)
    corners = [complex(x, y) for x in lefts for y in bottoms]
    boxes = [d.extent((corner, corner + side * (1 + 1j))) for corner in corners]
    ends = [path.points for path in drawing.paths() if path.stroke]
    crowd = [sum(box.overlaps(d.extent(points)) for points in ends) for box in boxes]
    origin = corners[crowd.index(min(crowd))] + 1 + 1j
    if mirrored:
        origin += 6j
    for along, name, shift in ((1, "x", 0.7 - 0.7j), (-1j if mirrored else 1j, "y", 0.6 - 0.2j)):
        end = origin + 5.5 * along
        drawing.add(*d.arrow(origin, end, d.GREY, 0.25, head=1.5, role=f"{name} axis"))
        drawing.add(Text(end + shift, name, 7, colour=d.GREY, role=f"{name} label"))


def draw_bodies(drawing: Drawing, vehicles: Sequence[Vehicle], at: View) -> None:
    """Vehicles' outlines, what of them is crushed, and marks that show their fronts. All lines lie
    over all grounds: what of one vehicle is crushed lies in the other."""
    for vehicle in vehicles:
        drawing.add(Path(at.all(vehicle.kept), None, fill=TINTS[vehicle.name], role="body"))
    for vehicle in vehicles:
        name, outline, outline_kept = vehicle.name, vehicle.outline, vehicle.kept
        lines: list[tuple[tuple[complex, ...], float, tuple[float, ...], str]]
        lines = [((*outline_kept, outline_kept[0]), 0.45, (), f"{name} outline")]
        if outline_kept != outline:
            lines.insert(0, ((*outline, outline[0]), 0.25, (0.7, 0.5), f"{name} whole"))
        if vehicle.point:
            for points, width, dash, role in lines:
                drawing.add(Path(at.all(points), COLOURS[name], width, dash, role=role))
            continue
        # the front: windscreen, rear window and an arrowhead, as on a police sketch
        along, across = vehicle.front * vehicle.length, 1j * vehicle.front * vehicle.width
        for place_, half in ((0.22, 0.38), (-0.3, 0.36)):
            middle = vehicle.center + place_ * along
            lines.append(((middle - half * across, middle + half * across), 0.2, (), "glass"))
        nose, back = vehicle.center + 0.36 * along, vehicle.center + 0.25 * along
        lines.append(((back + 0.16 * across, nose, back - 0.16 * across), 0.3, (), "heading"))
        for points, width, dash, role in lines:
            drawing.add(Path(at.all(points), COLOURS[name], width, dash, role=role))


_SECOND = 44.0  # in mm: where the key's second column starts


def with_unit(value: float, rule: str, units: System) -> str:
    """An amount in the units shown, named where they have names."""
    label = "" if units.is_bare else units.label(rule)
    return f"{short(units.display_value(rule, value))} {label}".strip()


def _key(drawing: Drawing, field: _Field, y: float, units: System, left_edge: float = 0.0) -> float:
    """Draw the key: the meaning of the lines and their scales, in two columns, or in one from
    ``left_edge`` on; return the last line's place."""
    shapes, sample = field.shapes, 8.0

    def velocity(kind: str) -> list[Path]:
        _, look, head = ARROWS[kind]
        return d.arrow(0, sample, d.BLACK, *look, head=head)

    def scale(word: str, size: float, per_unit: float, rule: str) -> tuple[list[Path], str]:
        """A bar of 1, 2 or 5 times a power of ten, at most half of ``size``, and what it means."""
        half = units.display_value(rule, size) * 0.5
        power = 10.0 ** math.floor(math.log10(half))
        amount = max(step * power for step in (1, 2, 5) if step * power <= half * (1 + 1e-12))
        end = per_unit / units.display_value(rule, 1.0) * amount
        bar = [Path((0, end), d.BLACK, 0.4, role=f"{word} scale")]
        bar += [Path((x - 0.7j, x + 0.7j), d.BLACK, 0.4) for x in (0, end)]
        unit = f" {units.label(rule)}"
        return bar, f"{word} {short(amount)}" if units.is_bare else short(amount) + unit

    left = [(velocity("before"), "velocity before"), (velocity("after"), "velocity after")]
    plane = [Path((0, sample), d.BLACK, 0.3, PLANE)]
    middle = [(plane, f"contact plane, Γ = {short(shapes.numbers['GA'])}°")]
    if field.speed:
        per_speed = field.at.scale * field.per_speed
        middle.append(scale("speed", field.speed, per_speed, VELOCITY))
    middle.append(scale("length", field.size, field.at.scale, LENGTH))
    if shapes.impulse is not None:
        left.append((velocity("change"), "velocity change ΔV"))
        force = d.arrow(0, sample, IMPULSE_COLOUR, 0.9, head=2.8)
        size = with_unit(abs(shapes.impulse), IMPULSE, units)
        room = _SECOND - 1.2 - (2.0 + sample + 1.5)
        texts = [f"impulse P on A, {size}", f"impulse P, {size}"]
        left.append((force, texts[d.text_width(texts[0], d.TEXT) > room]))
    if any(v.kept != v.outline for v in shapes.bodies):
        middle.append(([Path((0, sample), d.GREY, 0.3, (0.7, 0.5))], "crushed"))
    columns = [(2.0, left), (_SECOND, middle)]
    if left_edge:
        columns = [(left_edge, left + middle)]
    for x, column in columns:
        for row, (paths, text) in enumerate(column):
            start = complex(x, y - ROW * row)
            shifted_paths = [
                p._replace(points=tuple(start + point for point in p.points)) for p in paths
            ]
            drawing.items += shifted_paths
            end = max(sample, d.extent(paths[0].points).right) + 1.5 - 0.8j
            drawing.add(Text(start + end, text, role="legend"))
    return y - ROW * (max(len(column) for _, column in columns) - 1)


_COLUMNS = {
    "speed before": 17.2,
    "after": 28.8,
    "ΔV": 40.4,
    "force from": 53.4,
    "spin before": 68.0,
    "spin after": 83.0,
}
"""The table's headings and where its columns end, in mm of a drawing one column wide."""


def table_and_notes(drawing: Drawing, shapes: Plan, y: float, units: System) -> float:
    """Speeds, changes, directions and spins below ``y``, then the notes; ends the page there."""
    y -= ROW - 0.3
    columns = [end * drawing.width / d.COLUMN for end in _COLUMNS.values()]
    rows = {"": [head.replace("spin after", "after") for head in _COLUMNS]}
    widest = columns[1] - columns[0] - 1.2
    rows |= {vehicle.name: _cells(vehicle, shapes, units, widest) for vehicle in shapes.vehicles}
    for name, cells in rows.items():
        if name:
            drawing.add(Text(complex(2, y), name, colour=COLOURS[name], bold=True, role="table"))
        for x, cell in zip(columns, cells, strict=True):
            drawing.add(Text(complex(x, y), cell, anchor="end", role="table"))
        y -= ROW
    line = 1j * (y + 2.0)
    drawing.add(Path((2 + line, drawing.width - 2 + line), d.GREY, 0.2))
    for note in _notes(shapes, units):
        for text in d.wrap_text(note, drawing.width - 4):
            drawing.add(Text(complex(2, y - 0.9), text, colour=d.GREY, role="note"))
            y -= ROW
    drawing.height = 0.9 - y
    return y


def _cells(vehicle: Vehicle, shapes: Plan, units: System, widest: float) -> list[str]:
    def speed(value: float) -> str:
        return fitting(units.display_value(VELOCITY, value), widest)

    cells = [speed(vehicle.before.speed), "–", "–", "–"]
    turn = -1.0 if units.is_turned("WA") else 1.0
    after = None if vehicle.wall else vehicle.after
    spins = [fitting(turn * vehicle.before.spin, widest), "–"]
    if after and vehicle.change is not None:
        cells[1:3] = speed(after.speed), speed(abs(vehicle.change))
        if shapes.impulse:
            cells[3] = f"{round(vehicle.pdof(shapes.impulse)) + 0:d}°".replace("-", "−")
        spins[1] = fitting(turn * after.spin, widest)
    return cells + (["–", "–"] if shapes.numbers["M"] == 4 else spins)


def _sizes_words(shapes: Plan, units: System) -> str:
    """Return what the drawn sizes are from: "A as measured, 16 by 6 ft; B as a car, ..."."""
    texts = []
    for vehicle in shapes.bodies:
        origin = shapes.sizes_from[vehicle.name]
        size = " by ".join(
            short(amount) if origin == "measured" else f"{amount:.1f}".removesuffix(".0")
            for amount in (units.display_value(LENGTH, x) for x in (vehicle.length, vehicle.width))
        )
        size = f"{size} {'' if units.is_bare else units.label(LENGTH)}".rstrip()
        words = {
            "measured": f"as measured, {size}",
            "I/m": "from I/m, L/W = 2.6",
        }.get(origin, f"as {origin} of its weight, {size}")
        texts.append((vehicle.name, f"from {origin}" if origin.startswith("the ") else words))
    if len({words for _, words in texts}) == 1 and len(texts) == 2:
        return (
            f"Outlines {texts[0][1]}: not measured."
            if "I/m" in texts[0][1]
            else (f"A and B each drawn {texts[0][1]}.")
        )
    return " ".join(f"{name} drawn {words}." for name, words in texts)


def _notes(shapes: Plan, units: System) -> list[str]:
    first = [_sizes_words(shapes, units)] if shapes.numbers["M"] != 4 else []
    barrier = len(shapes.bodies) < 2
    if not barrier:
        first.append(
            f"Relative speed of the centers {with_unit(shapes.speed_of_centers, VELOCITY, units)}."
        )
    if not units.is_bare:
        first.append(f"Speeds in {units.label(VELOCITY)}, spins in {units.label(SPIN)}.")
    notes = [" ".join(filter(None, first))]
    if shapes.numbers["M"] == 4:
        apart = ", moved apart along n" if shapes.apart else ""
        notes.append(f"Point masses: drawn as discs{apart}.")
    if barrier:
        notes.append("The hatched vehicle's mass makes it a rigid barrier.")
    return notes + [f"Remark: {remark}." for remark in shapes.remarks]


def description(shapes: Plan, units: System) -> str:
    parts = []
    for vehicle in shapes.vehicles:
        speed = with_unit(vehicle.before.speed, VELOCITY, units)
        text = f"Vehicle {vehicle.name}: speed {speed} before"
        if vehicle.after and vehicle.change is not None:
            text += (
                f", {with_unit(vehicle.after.speed, VELOCITY, units)} after, change of velocity "
            )
            text += with_unit(abs(vehicle.change), VELOCITY, units)
            if shapes.impulse and vehicle.has_front and not vehicle.wall:
                text += f", force from {clock(vehicle.pdof(shapes.impulse))}"
        parts.append(text + ".")
    return " ".join(parts)
