"""The scene from above as an SVG picture: bodies, velocities, velocity changes, spins, impulse.

The contact point is the origin. It lies DA at TA + PA from A's center of gravity and DB at TB + PB
from B's (line 330 of the listing); A faces TA + 180 and B faces TB. Points in the plane are
complex, x + iy along the listing's axes; paper has y downwards. The picture is what one sees from
above whatever the axes of the case: of SAE axes y is shown to the right of x, and with compass
headings north is up. The values come from a case and its answer; nothing of the impact is computed.
"""

from __future__ import annotations

import cmath
import math
import textwrap
from collections.abc import Mapping, Sequence
from html import escape
from typing import NamedTuple

import numpy as np

from ..cases import Case
from ..errors import UserError, library, printable
from ..names import LENGTH, MASS, SPIN, VELOCITY, missing, quantity
from .answers import Answer
from .labels import Label, leader, place, sampled, text_element
from .rounding import decimals_of, rounded

COLOURS = {"A": "#0068a3", "B": "#bd4f00", "P": "#99356f"}
"""Okabe and Ito's blue, vermilion and purple, darkened for thin lines and small texts."""
GREY = "#595959"
CLASSES = (
    (450.0, "a motorcycle", 2.2, 0.8),
    (2500.0, "a car", 4.6, 1.8),
    (4500.0, "a light truck", 5.7, 2.0),
    (16000.0, "a heavy truck", 9.0, 2.5),
    (math.inf, "a truck with a trailer", 19.0, 2.6),
)
"""Classes of vehicles: largest mass in kg, words, usual length and width in m."""
PROPORTION = 2.6  # length over width of a vehicle of unknown class
MAX_GYRATION = 1e12  # beyond, an inertia that stands for "no rotation" says nothing of the size
DISC_DIAMETER = 0.6  # of a point mass, as a fraction of the length of its class
WALL_RATIO = 1e4  # a body at rest so much heavier than the other is drawn as a barrier
LARGEST = 1e100  # the largest number drawn: products of some must be doubles

WIDTH = 480.0  # px of the picture
MARGIN = 46.0  # px around the shapes, for labels
TALLEST = 360.0  # px of the shapes
ROW = 17.0  # px between rows of the legend
NOTE_CHARACTERS = 66  # in a line of notes
LEGEND = 11.0  # px, size of its type
SPEED_REACH = 0.95  # length of the fastest velocity's arrow, as a fraction of the longest body
FORCE_REACH = 0.5  # length of the impulse's arrow, likewise
TINY_SPIN = 0.005  # of speed over length: a smaller spin is not drawn
SIDESTEP = 6.0  # px by which an arrow moves off one that it would cover
FRONT_MARKS = (
    ((0.22, -0.38), (0.22, 0.38)),
    ((-0.3, -0.36), (-0.3, 0.36)),
    ((0.27, -0.2), (0.38, 0.0), (0.27, 0.2)),
)
"""Windscreen, rear window and arrowhead: fractions of length and width from the center."""
PLANE_DASH = "9 3 2 3"
ARROWS = {
    "before": ("v", "S{}", 1.6, "5 3"),
    "after": ("V", "S{}F", 2.4, ""),
    "change": ("ΔV", "DV{}", 1.4, "1.5 2.5"),
}
"""Velocities: symbol, name of their size, width in px and dashes of their arrows."""
SPINS = (("ω", "W{}", 17.0, "5 3"), ("Ω", "W{}F", 24.0, ""))
"""Spins: symbol, name, radius in px and dashes of their arcs."""


class Body(NamedTuple):
    """One body in plan.

    Parameters
    ----------
    name : {"A", "B"}
        Its name.
    center, front : complex
        Center of gravity, and unit vector from there to its front.
    length, width : float
        Size of its outline.
    origin : str
        Where the size comes from, in words.
    kind : {"vehicle", "disc", "barrier"}
        Shape drawn.
    faces : bool
        True if its front is given.
    before, after : complex or None
        Velocities.
    spins : tuple of (float or None)
        Spins before and after.
    """

    name: str
    center: complex
    front: complex
    length: float
    width: float
    origin: str
    kind: str
    faces: bool
    before: complex
    after: complex | None
    spins: tuple[float | None, float | None]

    @property
    def outline(self) -> list[complex]:
        """Corners of its outline, the front's two first; a disc's rim."""
        if self.kind == "disc":
            return [self.center + cmath.rect(self.length / 2, k * math.tau / 36) for k in range(36)]
        corners = ((1, -1), (1, 1), (-1, 1), (-1, -1))
        return [self.at(i / 2, j / 2) for i, j in corners]

    def at(self, along: float, across: float) -> complex:
        """Return the point at fractions of the length ahead and of the width to the left."""
        return self.center + self.front * complex(along * self.length, across * self.width)

    def clock(self, force: complex) -> str:
        """Return the hour on the body's clock from which a force comes; 12 is its front."""
        degrees = math.degrees(cmath.phase(self.front / -force))
        return f"{round(degrees / 30) % 12 or 12} o'clock"


class Scene(NamedTuple):
    """What is drawn, in base units along the listing's axes."""

    values: dict[str, float]
    bodies: dict[str, Body]
    normal: complex
    impulse: complex | None
    moved_apart: bool

    def force_on(self, name: str) -> complex:
        """Return the impulse on a body."""
        impulse = self.impulse or 0j
        return impulse if name == "A" else -impulse


def draw(answer: Answer, *, titled: bool = False) -> str:
    """Return the scene from above as one SVG element.

    Parameters
    ----------
    answer : Answer
        The answer to a case.
    titled : bool, default False
        Write the title of the case above the scene.

    Returns
    -------
    str
        The element; it uses no styles, so that it may be part of any page.

    Raises
    ------
    UserError
        If a velocity before the impact or the contact plane is not known, or a value is too large.
    """
    scene, case = _scene(answer), answer.case
    numbers = _Numbers(answer, scene)
    sheet = _Sheet(scene, numbers)
    sheet.draw_bodies()
    sheet.draw_plane()
    sheet.draw_motion()
    sheet.draw_impulse()
    sheet.write_labels()
    bottom = sheet.draw_legend()
    top = 0.0
    title = printable(case.title) or "Scene from above"
    if titled and case.title:
        top = -24.0
        sheet.parts.append(text_element(WIDTH / 2 - 8j, title, "#000", 13, True))
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 {top:g} {WIDTH:g} {bottom - top:.0f}" '
        'role="img" font-family="DejaVu Sans, Verdana, Arial, sans-serif">'
    )
    return "\n".join([f"{head}<title>{escape(title)}</title>", *sheet.parts, "</svg>"])


def to_png(svg: str, width: int = 1440) -> bytes:
    """Return an SVG as PNG on white. Raises UserError if resvg-py is not installed."""
    resvg = library("resvg_py", "report", "a PNG picture")
    return bytes(resvg.svg_to_bytes(svg_string=svg, width=width, background="white"))


class _Numbers:
    """The texts of numbers: the answer's own, others rounded like its group of that unit."""

    def __init__(self, answer: Answer, scene: Scene) -> None:
        self.view, self._found = answer.case.view, answer.found
        bodies = scene.bodies.values()
        speeds = [abs(v) for b in bodies for v in (b.before, b.after) if v is not None]
        spins = [spin for body in bodies for spin in body.spins if spin is not None]
        self._decimals = {
            VELOCITY: decimals_of([self.view.shown("SA", max(speeds))]),
            SPIN: decimals_of([self.view.shown("WA", spin) for spin in spins]),
        }

    def text(self, name: str, value: float, with_unit: bool = False) -> str:
        """Return the text of a base value; ``name`` is of the quantity."""
        shown = self.view.shown(name, value)
        if name in self._found:
            text = self._found[name].text
        else:
            decimals = self._decimals.get(quantity(name).unit, decimals_of([shown]))
            text = rounded(shown, decimals)
        unit = self.view.unit(name) if with_unit else ""
        return f"{text} {unit}".rstrip()


def _unit(degrees: float) -> complex:
    return cmath.rect(1.0, math.radians(degrees))


def _scene(answer: Answer) -> Scene:
    """Return what is to be drawn. Raises UserError."""
    case, values = answer.case, _base_values(answer)
    needed = ["UX", "UY", "VX", "VY", "GA"]
    if absent := [name for name in needed if name not in values]:
        raise UserError(f"{missing(absent)}; the drawing shows velocities and contact plane")
    if large := [n for n, x in values.items() if LARGEST < abs(x) < math.inf]:
        raise UserError(f"{large[0]} = {values[large[0]]:g} is too large to be drawn")
    normal = _unit(values["GA"])
    sizes = _sizes(values, case)
    # of point masses the arms say nothing
    moved_apart = values.get("M") == 4 or not (values.get("DA") or values.get("DB"))
    bodies = {}
    for name in "AB":
        bodies[name] = _body(name, values, case, sizes[name], moved_apart)
    return Scene(values, bodies, normal, _impulse(values, bodies), moved_apart)


def _base_values(answer: Answer) -> dict[str, float]:
    """Return what is known of the impact, given or computed, in base units."""
    case = answer.case
    values = {name: amount.value for name, amount in {**case.entries, **case.sizes}.items()}
    values |= {**case.numbers, **{name: float(x) for name, x in answer.scene.items()}}
    return {name: value for name, value in values.items() if not math.isnan(value)}


def _sizes(values: Mapping[str, float], case: Case) -> dict[str, tuple[float, float, str]]:
    """Return length and width of both bodies, and where they come from in words."""
    sizes = {name: _usual_size(name, values, case) for name in "AB"}
    usual = [size for size in sizes.values() if size] or [(1.0, 1 / PROPORTION, "in any size")]
    result = {}
    for name in "AB":
        length, width, origin = sizes[name] or usual[0]
        if f"L{name}" not in values:  # the contact point lies within the outline
            contact = values.get(f"D{name}", 0.0) * _unit(values.get(f"P{name}", 0.0))
            length = max(length, 2 * abs(contact.real))
            width = max(width, 2 * abs(contact.imag))
        result[name] = (length, width, origin)
    return result


def _kind(name: str, values: Mapping[str, float]) -> str:
    """Return the shape in which a body is drawn."""
    other, speeds = ("B", "UX UY WA") if name == "A" else ("A", "VX VY WB")
    is_heavy = values.get(f"M{name}", 1.0) >= WALL_RATIO * values.get(f"M{other}", 1.0)
    if is_heavy and not any(values.get(speed) for speed in speeds.split()):
        return "barrier"
    return "disc" if values.get("M") == 4 else "vehicle"


def _usual_size(
    name: str, values: Mapping[str, float], case: Case
) -> tuple[float, float, str] | None:
    """Return the size of a body as given, by its class of weight, or by its inertia."""
    if f"L{name}" in values and f"B{name}" in values:
        return values[f"L{name}"], values[f"B{name}"], "as measured"
    if _kind(name, values) == "barrier":
        return None
    mass, inertia = values.get(f"M{name}", math.nan), values.get(f"I{name}", math.nan)
    if case.view.units and 0 < mass < math.inf:
        kilograms = mass * float(case.view.base_size(MASS))
        meter = 1 / float(case.view.base_size(LENGTH))
        _, words, length, width = next(row for row in CLASSES if kilograms <= row[0])
        return length * meter, width * meter, f"as {words} of its weight"
    square = 12 * inertia / mass if mass else math.nan
    distance = values.get(f"D{name}", 0.0)
    if 0 < square < MAX_GYRATION * max(1.0, distance**2):
        length = math.sqrt(square / (1 + PROPORTION**-2))
        return length, length / PROPORTION, "by its inertia"
    return None


def _body(
    name: str,
    values: Mapping[str, float],
    case: Case,
    size: tuple[float, float, str],
    moved_apart: bool,
) -> Body:
    """Return one body in plan."""
    side = 1 if name == "A" else -1
    x, y = ("UX", "UY") if name == "A" else ("VX", "VY")
    before = complex(values[x], values[y])
    after = complex(values.get(f"V{name}X", math.nan), values.get(f"V{name}Y", math.nan))
    theta, inward = values.get(f"T{name}"), side * _unit(values["GA"])
    if theta is None:
        course = before or (0j if cmath.isnan(after) else after) or -inward
        front = course / abs(course)
    else:
        front = -side * _unit(theta)
    length, width, origin = size
    kind = _kind(name, values)
    if kind == "disc":
        length = width = DISC_DIAMETER * length
    if kind == "barrier":
        front, length, width = inward, 0.15 * length, 1.5 * length
    if moved_apart or kind == "barrier":
        turned = front / inward
        half = abs(turned.real) * length + abs(turned.imag) * width
        center = inward * (length if kind == "disc" else half) / 2
    else:
        angle = values.get(f"T{name}", 0.0) + values.get(f"P{name}", 0.0)
        center = side * values.get(f"D{name}", 0.0) * _unit(angle)
    faces = theta is not None and f"T{name}" not in case.omitted and kind != "barrier"
    spins = (values.get(f"W{name}"), values.get(f"W{name}F"))
    if kind != "vehicle":
        spins = (None, None)
    return Body(
        name,
        center,
        front,
        length,
        width,
        origin,
        kind,
        faces,
        before,
        after if cmath.isfinite(after) else None,
        spins,
    )


def _impulse(values: Mapping[str, float], bodies: Mapping[str, Body]) -> complex | None:
    """Return the impulse on A, which is the momentum that a body gains; None without one."""
    name, sense = ("B", -1) if bodies["A"].kind == "barrier" else ("A", 1)
    body = bodies[name]
    if body.after is None:
        return None
    return sense * values.get(f"M{name}", 1.0) * (body.after - body.before) or None


class _Sheet:
    """The paper: its scale, what is drawn on it, and labels still to be placed."""

    def __init__(self, scene: Scene, numbers: _Numbers) -> None:
        self.scene, self.numbers, self.view = scene, numbers, numbers.view
        self.parts: list[str] = []
        self.labels: list[Label] = []
        self.arrows: list[np.ndarray] = []
        self._ink: list[np.ndarray] = []
        self._weights: list[np.ndarray] = []
        # north, which is x of SAE axes, is up
        north_is_x = self.view.headings == "compass" and self.view.axes == "sae"
        self.turn = 1j if north_is_x else 1 + 0j
        self.bodies = list(scene.bodies.values())
        self.size = max(body.length for body in self.bodies)
        speeds = [
            abs(v) for body in self.bodies for v in (body.before, body.after) if v is not None
        ]
        self.speed = max(speeds)
        self.per_speed = SPEED_REACH * self.size / self.speed if self.speed else 0.0
        self.half_plane = 0.62 * self.size * 1j * scene.normal
        self._fit()

    def _fit(self) -> None:
        """Choose scale and origin so that all that is drawn is on the paper."""
        points = [self.half_plane, -self.half_plane]
        if self.scene.impulse:
            force = FORCE_REACH * self.size * self.scene.impulse / abs(self.scene.impulse)
            points += [force, -force]
        for body in self.bodies:
            points += body.outline
            points += [end for ends in self._velocities(body).values() for end in ends]
        turned = [point * self.turn for point in points]
        xs, ys = [p.real for p in turned], [p.imag for p in turned]
        width, height = max(xs) - min(xs), max(ys) - min(ys)
        self.scale = min((WIDTH - 2 * MARGIN) / width, TALLEST / height)
        self.height = self.scale * height + 2 * MARGIN
        middle = complex((max(xs) + min(xs)) / 2, (max(ys) + min(ys)) / 2)
        self.origin = complex(WIDTH, self.height) / 2 - self.scale * middle.conjugate()

    def at(self, point: complex) -> complex:
        """Return a point of the plane on paper."""
        return self.origin + self.scale * (point * self.turn).conjugate()

    def along(self, vector: complex) -> complex:
        """Return a vector of the plane on paper."""
        return self.at(vector) - self.at(0j)

    def line(
        self,
        points: Sequence[complex],
        colour: str,
        width: float,
        *,
        dash: str = "",
        fill: str = "",
        closed: bool = False,
        weight: float = 1.0,
    ) -> None:
        """Draw a line through points on paper; ``weight`` is the cost of a label over it."""
        path = "L".join(f"{p.real:.1f} {p.imag:.1f}" for p in points) + "Z" * closed
        look = f'fill="{fill}" fill-opacity=".14"' if fill else 'fill="none"'
        look += f' stroke="{colour}" stroke-width="{width:g}" stroke-linejoin="round"'
        look += f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<path d="M{path}" {look}/>')
        ink = sampled([*points, points[0]] if closed else points)
        self._ink.append(ink)
        self._weights.append(np.full(len(ink), weight))

    def head(self, tip: complex, direction: complex, colour: str, size: float) -> None:
        """Draw the head of an arrow."""
        back = size * direction / abs(direction)
        corners = [tip, tip - back * (1 + 0.38j), tip - back * (1 - 0.38j)]
        path = "L".join(f"{p.real:.1f} {p.imag:.1f}" for p in corners)
        self.parts.append(f'<path d="M{path}Z" fill="{colour}"/>')

    def arrow(
        self, start: complex, end: complex, colour: str, width: float, dash: str = ""
    ) -> tuple[complex, complex] | None:
        """Draw an arrow beside those that it would cover; return its ends, None if too short."""
        run = end - start
        if abs(run) < 1.0:
            return None
        size = min(4.0 + 2.2 * width, 0.6 * abs(run))
        for step in (0, 1, -1, 2, -2, 3, -3):
            aside = step * SIDESTEP * 1j * run / abs(run)
            points = sampled([start + aside, end + aside])
            if not any(_covers(points, other) for other in self.arrows):
                break
        self.arrows.append(points)
        start, end = start + aside, end + aside
        self.line([start, end - 0.8 * size * run / abs(run)], colour, width, dash=dash)
        self.head(end, run, colour, size)
        return start, end

    def draw_bodies(self) -> None:
        """Draw the outlines and the marks that show the fronts."""
        for body in self.bodies:
            colour = COLOURS[body.name]
            outline = [self.at(point) for point in body.outline]
            self.line(outline, colour, 1.5, fill=colour, closed=True, weight=0.3)
            if body.kind == "vehicle":
                for mark in FRONT_MARKS:
                    points = [self.at(body.at(*place)) for place in mark]
                    self.line(points, colour, 1.0, weight=0.3)
            away = body.center or body.front
            self.labels.append(
                Label(self.at(body.center), self.along(away), body.name, colour, 17, True)
            )

    def draw_plane(self) -> None:
        """Draw the contact plane, its normal and the contact point."""
        ends = [self.at(self.half_plane), self.at(-self.half_plane)]
        self.line(ends, "#000", 1.2, dash=PLANE_DASH, weight=0.6)
        corner = self.at(0.78 * self.half_plane)
        normal = self.along(self.scene.normal)
        tip = corner + 22 * normal / abs(normal)
        for name, end in (("n", tip), ("t", ends[0])):
            self.line([corner, end], "#000", 1.2)
            self.head(end, end - corner, "#000", 6)
            self.labels.append(Label(end, end - corner, name, "#000", 11))

    def _velocities(self, body: Body) -> dict[str, tuple[complex, complex]]:
        """Return the ends of a body's arrows: before the impact up to its center, else from it."""
        reach = self.per_speed
        arrows = {"before": (body.center - reach * body.before, body.center)}
        if body.after is not None:
            arrows["after"] = (body.center, body.center + reach * body.after)
            change = reach * (body.after - body.before)
            arrows["change"] = (body.center, body.center + change)
        return arrows

    def draw_motion(self) -> None:
        """Draw velocities and spins."""
        for body in self.bodies:
            colour = COLOURS[body.name]
            for kind, plane_ends in self._velocities(body).items():
                symbol, name, width, dash = ARROWS[kind]
                start, end = (self.at(point) for point in plane_ends)
                ends = self.arrow(start, end, colour, width, dash)
                if ends:
                    value = abs(plane_ends[1] - plane_ends[0]) / self.per_speed
                    size = self.numbers.text(name.format(body.name), value)
                    text = f"{symbol}_{body.name.lower()} {size}"
                    at = ends[0] if kind == "before" else ends[1]
                    self.labels.append(Label(at, 2 * at - sum(ends), text, colour))
            self._draw_spins(body, colour)
            self._ring(self.at(body.center), 3.0, colour)

    def _draw_spins(self, body: Body, colour: str) -> None:
        """Draw a body's spins as arcs around its center, behind it as seen from the contact."""
        center = self.at(body.center)
        behind = self.along(body.center or -body.front)
        for spin, (symbol, name, radius, dash) in zip(body.spins, SPINS, strict=True):
            if spin is None or abs(spin) * self.size <= TINY_SPIN * self.speed:
                continue
            sense = -1j if spin > 0 else 1j  # counterclockwise on paper, whose y is downwards
            middle = radius * behind / abs(behind)
            arc = [middle * cmath.exp(sense * math.radians(k)) for k in range(-125, 126, 10)]
            points = [center + p for p in arc]
            self.line(points, colour, 1.6, dash=dash)
            self.head(points[-1] + 2 * sense * arc[-1] / radius, sense * arc[-1], colour, 7)
            size = self.numbers.text(name.format(body.name), spin)
            text = f"{symbol}_{body.name.lower()} {size}"
            self.labels.append(Label(center + middle, middle, text, colour))

    def _ring(self, center: complex, radius: float, colour: str) -> None:
        """Draw a small circle."""
        self.parts.append(
            f'<circle cx="{center.real:.1f}" cy="{center.imag:.1f}" r="{radius:g}" fill="#fff" '
            f'stroke="{colour}" stroke-width="1.4"/>'
        )
        ink = center + radius * np.exp(1j * np.arange(0, math.tau, 0.5))
        self._ink.append(ink)
        self._weights.append(np.ones(len(ink)))

    def draw_impulse(self) -> None:
        """Draw the impulse on each body, and the contact point."""
        contact = self.at(0j)
        for body in self.bodies if self.scene.impulse else ():
            force = self.scene.force_on(body.name)
            symbol, width = ("P", 3.4) if body.name == "A" else ("−P", 1.8)
            end = contact + self.along(FORCE_REACH * self.size * force / abs(force))
            ends = self.arrow(contact, end, COLOURS["P"], width)
            if ends:
                hour = f" {body.clock(force)}" if body.faces else ""
                self.labels.append(
                    Label(ends[1], ends[1] - ends[0], f"{symbol}{hour}", COLOURS["P"])
                )
        self._ring(contact, 3.4, "#000")
        self.labels.append(Label(contact, self.along(-1j * self.scene.normal), "C", "#000", 11))

    def write_labels(self) -> None:
        """Place the labels and write them."""
        ink, weights = np.concatenate(self._ink), np.concatenate(self._weights)
        order = sorted(self.labels, key=lambda label: label.size, reverse=True)
        texts = []
        for label, box in place(order, ink, weights, (2, 2, WIDTH - 2, self.height - 2)):
            if ends := leader(label, box):
                self.line(ends, label.colour, 0.6)
            base = box.center + 0.36j * label.size
            texts.append(text_element(base, label.text, label.colour, label.size, label.bold))
        self.parts += texts

    def draw_legend(self) -> float:
        """Draw the legend below; return its lower edge."""
        entries = self._legend()
        top = self.height + 6
        rows = (len(entries) + 1) // 2
        for k, (width, dash, colour, size, text) in enumerate(entries):
            start = complex(12 + (k // rows) * 232, top + (k % rows) * ROW)
            end = start + (size or 30.0)
            if size:  # a scale
                self.line([start, end], "#000", 1.2)
                for tick in (start, end):
                    self.line([tick - 3j, tick + 3j], "#000", 1.2)
            else:
                self.line([start, end - 4 * (dash != PLANE_DASH)], colour, width, dash=dash)
                if dash != PLANE_DASH:
                    self.head(end, 1, colour, 4 + 2.2 * width)
            base = complex(max(end.real, start.real + 30) + 8, start.imag + 4)
            self.parts.append(text_element(base, text, "#000", LEGEND, anchor="start"))
        y = self._draw_axes(top + rows * ROW + 4)
        return y + 8

    def _legend(self) -> list[tuple[float, str, str, float, str]]:
        """Return the rows of the legend: width, dashes, colour, length of a scale, text."""
        scene, unit = self.scene, self.view.unit("SA")
        speed = f", {unit}" if unit else ""
        entries = [(1.6, "5 3", "#000", 0.0, f"v: velocity before{speed}")]
        if any(body.after is not None for body in self.bodies):
            entries.append((2.4, "", "#000", 0.0, f"V: velocity after{speed}"))
            entries.append((1.4, "1.5 2.5", "#000", 0.0, f"ΔV: velocity change{speed}"))
        if scene.impulse:
            size = self.numbers.text("P", abs(scene.impulse), True)
            entries.append((3.4, "", COLOURS["P"], 0.0, f"P: impulse, {size} on A"))
        angle = f"{self.view.shown('GA', scene.values['GA']):.4g}".replace("-", "−")
        entries.append((1.2, PLANE_DASH, "#000", 0.0, f"contact plane, Γ = {angle}°"))
        entries.append(self._scale("DA", self.size, self.scale))
        if self.speed:
            entries.append(self._scale("SA", self.speed, self.scale * self.per_speed))
        return entries

    def _scale(
        self, name: str, extent: float, px_per_base: float
    ) -> tuple[float, str, str, float, str]:
        """Return the legend's row of a scale: 1, 2 or 5 times a power of ten, in units shown."""
        per_shown = float(self.view.map(name)[0])
        half = 0.5 * extent / per_shown
        power = 10.0 ** math.floor(math.log10(half))
        amount = max(step * power for step in (1, 2, 5) if step * power <= half * (1 + 1e-12))
        words = "length" if name == "DA" else "speed"
        text = f"{amount:g} {self.view.unit(name)}".rstrip()
        return 1.2, "", "#000", amount * per_shown * px_per_base, f"{text} ({words})"

    def _draw_axes(self, top: float) -> float:
        """Draw the axes of the case and write the notes beside them; return the lower edge."""
        is_sae = self.view.axes == "sae"
        y_is_down = is_sae and self.turn == 1
        corner = complex(26, top + (6 if y_is_down else 36))
        for name, axis in (("x", self.turn), ("y", self.turn * (-1j if is_sae else 1j))):
            along = axis.conjugate()
            self.line([corner, corner + 22 * along], GREY, 1.0)
            self.head(corner + 24 * along, along, GREY, 5)
            self.parts.append(text_element(corner + 32 * along + 3j, name, GREY, LEGEND))
        notes = textwrap.wrap(self._notes(is_sae), NOTE_CHARACTERS)
        for k, text in enumerate(notes):
            at = complex(84, top + 8 + k * (ROW - 2))
            self.parts.append(text_element(at, text, GREY, LEGEND - 1, anchor="start"))
        return top + max(44, 8 + len(notes) * (ROW - 2))

    def _notes(self, is_sae: bool) -> str:
        """Return the notes of the legend."""
        view, sense = self.view, "clockwise" if is_sae else "counterclockwise"
        words = [f"Spins in {view.unit('WA') or 'radians per time'}, positive {sense}."]
        if view.headings == "compass":
            words.append("North is up.")
        sizes: dict[str, list[str]] = {}
        for body in self.bodies:
            length, width = (f"{view.shown('DA', x):.3g}" for x in (body.length, body.width))
            look = f"{body.origin}, {length} by {width} {view.unit('DA')}".rstrip()
            look = {"disc": "as point mass", "barrier": "as a barrier"}.get(body.kind, look)
            sizes.setdefault(look, []).append(body.name)
        words += [f"{' and '.join(names)} drawn {look}." for look, names in sizes.items()]
        if self.scene.moved_apart:
            words.append("Moved apart along n to be seen.")
        return " ".join(words)


def _covers(points: np.ndarray, other: np.ndarray) -> bool:
    """Return True if a third of the shorter of two lines lies along the other."""
    distances = np.abs(points[:, None] - other)
    near = min(len(points), len(other)) / 3
    return bool((distances.min(axis=1) < SIDESTEP / 2).sum() > near)
