"""The scene from above as an SVG picture: bodies, velocities, velocity changes, spins, impulse.

The contact point is the origin. It lies DA at TA + PA from A's center of gravity and DB at TB + PB
from B's (line 330 of the listing); A faces TA + 180 and B faces TB. Points in the plane are
complex, x + iy along the listing's axes; paper has y downwards. The picture is what one sees from
above whatever the axes of the case: of SAE axes y is shown to the right of x, and with compass
headings north is up. The values come from an answer; nothing of the impact is computed.
"""

from __future__ import annotations

import cmath
import math
import textwrap
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from ..cases import Case, View
from ..errors import UserError, library, printable
from ..names import LENGTH, MASS, missing
from .answers import Answer, Number, numbers_of
from .paper import Label, Paper, Points, arc

COLOURS = {"A": "#0068a3", "B": "#bd4f00", "P": "#99356f"}
"""Okabe and Ito's blue, vermilion and purple, darkened for thin lines and small texts."""
BLACK = "#000"
CLASSES = (
    (450.0, "a motorcycle", 2.2, 0.8),
    (2500.0, "a car", 4.6, 1.8),
    (4500.0, "a light truck", 5.7, 2.0),
    (16000.0, "a heavy truck", 9.0, 2.5),
    (1e7, "a truck with a trailer", 19.0, 2.6),
    (math.inf, "a barrier", 0.7, 7.0),
)
"""Classes of bodies: largest mass in kg, words, usual length and width in m."""
BARRIER = "a barrier"
UNKNOWN_MASS = 1500.0  # kg: a body whose mass is not known is drawn as a car
LARGEST = 1e100  # the largest number drawn: products of some must be doubles

WIDTH = 480.0  # px of the picture
MARGIN = 46.0  # px around the shapes, for labels
TALLEST = 360.0  # px of the shapes
SPEED_REACH = 0.95  # length of the fastest velocity's arrow, as a fraction of the longest body
FORCE_REACH = 0.5  # length of the impulse's arrow, likewise
PLANE_REACH = 0.62  # half the contact plane, likewise
SPIN_RADII = (0.075, 0.11)  # radii of the arcs of spins before and after, likewise
TINY = 0.005  # of the largest velocity: a smaller one, or a slower spin, is not drawn
CORNERS = np.array([0.5 - 0.5j, 0.5 + 0.5j, -0.5 + 0.5j, -0.5 - 0.5j, 0.5 - 0.5j])
FRONT = np.array([0.25 - 0.3j, 0.4, 0.25 + 0.3j])
PLANS = {"disc": [arc(0.5)], "barrier": [CORNERS], "vehicle": [CORNERS, FRONT]}
"""Lines of each kind of body: fractions of length and i times width from the center."""


AXES = {
    (False, False): "Axes: x to the right, y up; spins positive counterclockwise.",
    (True, False): "Axes: x to the right, y down; spins positive clockwise.",
    (True, True): "Axes: x up, y to the right; spins positive clockwise.",
}
"""Directions of axes, by whether they are SAE's and x is north."""


class Look(NamedTuple):
    """Look of one kind of arrow: letter, name of its size, width in px, dashes; its meaning."""

    letter: str
    name: str
    width: float
    dashes: str
    meaning: str


BEFORE = Look("v", "S{}", 1.6, "5 3", "v: velocity before")
AFTER = Look("V", "S{}F", 2.4, "none", "V: velocity after")
CHANGE = Look("ΔV", "DV{}", 1.4, "1.5 2.5", "ΔV: velocity change")
SPIN_BEFORE = Look("ω", "W{}", 1.6, "5 3", "ω: spin before")
SPIN_AFTER = Look("Ω", "W{}F", 2.4, "none", "Ω: spin after")
IMPULSE = Look("P", "P", 3.4, "none", "P: impulse on A")
PLANE = Look("t", "", 1.2, "9 3 2 3", "t: contact plane")
LEGEND_ROWS = (BEFORE, AFTER, CHANGE, IMPULSE, PLANE, SPIN_BEFORE, SPIN_AFTER)


class Arrow(NamedTuple):
    """An arrow in the plane."""

    look: Look
    points: Points
    text: str
    colour: str


class Body(NamedTuple):
    """One body in plan.

    Parameters
    ----------
    name : {"A", "B"}
        Its name.
    words : str
        The class or size by which it is drawn.
    center : complex
        Center of gravity.
    length : float
        Length of its outline.
    lines : list of ndarray of complex
        Its outline; that of a vehicle, then the mark of its front.
    before, after : complex
        Velocities, NaN if not known.
    """

    name: str
    words: str
    center: complex
    length: float
    lines: list[Points]
    before: complex
    after: complex


def draw(answer: Answer) -> str:
    """Return the scene from above as one SVG element.

    Parameters
    ----------
    answer : Answer
        The answer to a case.

    Returns
    -------
    str
        The element; it uses no styles, so that it may be part of any page.

    Raises
    ------
    UserError
        If a velocity before the impact or the contact plane is not known, or a value is too large.
    """
    scene = _Scene(answer)
    scene.draw()
    scene.draw_legend()
    return scene.paper.svg(printable(answer.case.title) or "Scene from above")


def to_png(svg: str, width: int = 1440) -> bytes:
    """Return an SVG as PNG on white. Raises UserError if resvg-py is not installed."""
    resvg = library("resvg_py", "report", "a PNG picture")
    return bytes(resvg.svg_to_bytes(svg_string=svg, width=width, background="white"))


def _unit(degrees: float) -> complex:
    """Return the unit vector of a direction."""
    return cmath.rect(1.0, math.radians(degrees))


def _known_values(answer: Answer) -> dict[str, float]:
    """Return what is known of the impact in base units. Raises UserError."""
    values = {name: amount.value for name, amount in answer.case.sizes.items()}
    values |= {name: float(x) for name, x in answer.scene.items() if not math.isnan(x)}
    if absent := [name for name in ("UX", "UY", "VX", "VY", "GA") if name not in values]:
        raise UserError(f"{missing(absent)}; the drawing shows velocities and contact plane")
    for name, value in values.items():
        if LARGEST < abs(value) < math.inf:
            raise UserError(f"{name} = {value:g} is too large to be drawn")
    return values


def _size(name: str, values: Mapping[str, float], case: Case) -> tuple[float, float, str]:
    """Return length and width of a body, and words: as measured, or by its class of weight.

    A case without named units is taken to be in the chapter's."""
    view = case.view if case.view.units else View.of(units="chapter")
    meter, kilogram = (float(view.base_size(rule)) for rule in (LENGTH, MASS))
    mass = kilogram * values.get(f"M{name}", UNKNOWN_MASS / kilogram)
    _, words, *sizes = next(row for row in CLASSES if mass <= row[0])
    length, width = (size / meter for size in sizes)
    if f"L{name}" in values:
        length, width, words = values[f"L{name}"], values[f"B{name}"], "measured"
    ends = f"{view.shown('DA', length):.3g} by {view.shown('DA', width):.3g} {view.unit('DA')}"
    return length, width, f"as {words}, {ends}"


def _body(name: str, values: Mapping[str, float], case: Case) -> Body:
    """Return a body in plan."""
    side, letter = (1, "U") if name == "A" else (-1, "V")
    before = complex(values[f"{letter}X"], values[f"{letter}Y"])
    after = complex(values.get(f"V{name}X", math.nan), values.get(f"V{name}Y", math.nan))
    length, width, words = _size(name, values, case)
    kind = "barrier" if BARRIER in words else "vehicle"
    if values.get("M") == 4:
        kind, length, words = "disc", width, "as a disc (point mass)"
    inward = side * _unit(values["GA"])  # from the contact plane to the body
    theta = values.get(f"T{name}", 0.0)
    is_turned = f"T{name}" in values and kind != "barrier"
    front = -side * _unit(theta) if is_turned else before or -inward
    front /= abs(front)
    lines = [front * (p.real * length + 1j * p.imag * width) for p in PLANS[kind]]
    center = side * values.get(f"D{name}", 0.0) * _unit(theta + values.get(f"P{name}", 0.0))
    if kind != "vehicle" or not (values.get("DA") or values.get("DB")):
        center = inward * float((lines[0] / inward).real.max())
        words += ", moved to the contact plane"
    lines = [center + line for line in lines]
    return Body(name, words, center, length, lines, before, after)


class _Scene:
    """The scene of an answer, and the paper on which it is drawn to scale."""

    def __init__(self, answer: Answer) -> None:
        self.answer, self.view = answer, answer.case.view
        self.values = _known_values(answer)
        self.bodies = [_body(name, self.values, answer.case) for name in "AB"]
        self.size = max(body.length for body in self.bodies)
        self.speed = max(abs(v) for b in self.bodies for v in (b.before, b.after) if v == v) or 1.0
        first = self.bodies[0]
        impulse = self.values.get("MA", math.nan) * (first.after - first.before)
        self.impulse = impulse if cmath.isfinite(impulse) else 0j
        self.arrows = [*self._contact(), *self._velocities(), *self._spins()]
        self.is_sae = self.view.axes == "sae"
        # north, which is x of SAE axes, is up
        self.turn = 1j if self.is_sae and self.view.headings else 1 + 0j
        lines = [line for body in self.bodies for line in body.lines]
        lines += [arrow.points for arrow in self.arrows]
        plan = np.conj(np.concatenate(lines) * self.turn)
        low = complex(plan.real.min(), plan.imag.min())
        extent = complex(np.ptp(plan.real), np.ptp(plan.imag))
        self.scale = min((WIDTH - 2 * MARGIN) / extent.real, TALLEST / extent.imag)
        self.paper = Paper(complex(WIDTH, self.scale * extent.imag + 2 * MARGIN))
        self.origin = self.paper.size / 2 - self.scale * (low + extent / 2)

    def at(self, points: Points) -> Points:
        """Return points of the plane on paper."""
        places: Points = self.origin + self.scale * np.conj(points * self.turn)
        return places

    def number(self, name: str) -> Number:
        """Return the number of a value: the answer's own, or rounded alike."""
        if name in self.answer.found:
            return self.answer.found[name]
        return numbers_of(self.answer.case, {name: self.values[name]}, {}, {})[name]

    def _hour(self, body: Body) -> str:
        """Return the hour from which a vehicle is struck, as "11 o'clock"; "" if not known."""
        name = f"PDOF{body.name}"
        return self.number(name).note if name in self.values and len(body.lines) > 1 else ""

    def _velocities(self) -> Iterator[Arrow]:
        """Yield velocities: before the impact up to the center of a body, else from it."""
        for body in self.bodies:
            change = body.after - body.before
            for look, velocity in ((BEFORE, body.before), (AFTER, body.after), (CHANGE, change)):
                if abs(velocity) > TINY * self.speed:
                    run = SPEED_REACH * self.size / self.speed * velocity
                    start = body.center - run * (look is BEFORE)
                    ends = np.array([start, start + run])
                    self.values[look.name.format(body.name)] = abs(velocity)
                    yield self._arrow(look, body, ends)

    def _spins(self) -> Iterator[Arrow]:
        """Yield the spins of vehicles as arcs around their centers, away from the contact."""
        for body in self.bodies:
            for look, radius in zip((SPIN_BEFORE, SPIN_AFTER), SPIN_RADII, strict=True):
                spin = self.values.get(look.name.format(body.name), 0.0)
                if abs(spin) * self.size > TINY * self.speed and len(body.lines) > 1:
                    middle, turn = cmath.phase(body.center or 1), math.copysign(2.2, spin)
                    points = arc(radius * self.size, middle - turn, middle + turn)
                    yield self._arrow(look, body, body.center + points)

    def _arrow(self, look: Look, body: Body, points: Points) -> Arrow:
        """Return the arrow of a body's velocity or spin."""
        size = self.number(look.name.format(body.name)).text
        return Arrow(look, points, f"{look.letter}_{body.name.lower()} {size}", COLOURS[body.name])

    def _contact(self) -> Iterator[Arrow]:
        """Yield contact plane and impulse on A."""
        plane = np.array([-1j, 1j]) * PLANE_REACH * self.size * _unit(self.values["GA"])
        yield Arrow(PLANE, plane, "t", BLACK)
        if self.impulse:
            run = FORCE_REACH * self.size * self.impulse / abs(self.impulse)
            self.values["P"] = abs(self.impulse)
            text = f"P {self.number('P').text}, {self._hour(self.bodies[0])}".removesuffix(", ")
            yield Arrow(IMPULSE, np.array([0, run]), text, COLOURS["P"])

    def draw(self) -> None:
        """Draw bodies, arrows and contact point, and label them."""
        for body in self.bodies:
            colour = COLOURS[body.name]
            self.paper.area(self.at(body.lines[0]), colour, 0.14)
            for line in body.lines:
                self.paper.line(self.at(line), colour, 1.2)
            self._dot(body.center, 2 * body.center or 1, body.name, colour, 18)
        # shorter arrows over longer ones, which do not move aside
        for look, points, text, colour in sorted(self.arrows, key=_length, reverse=True):
            ends = self.paper.arrow(self.at(points), colour, look.width, look.dashes)
            ends = ends[::-1] if look is BEFORE else ends
            self.paper.labels.append(Label(ends[-1], ends[-1] - ends[-2], text, colour))
        self._dot(0j, -1j, "C", BLACK, 12)
        self.paper.write_labels()

    def _dot(self, point: complex, towards: complex, text: str, colour: str, size: float) -> None:
        """Draw a dot with its label."""
        center, end = self.at(np.array([point, towards]))
        self.paper.area(center + arc(3.5), colour)
        self.paper.labels.append(Label(center, end - center, text, colour, size))

    def draw_legend(self) -> None:
        """Draw legend, scale and notes below the scene."""
        corner = complex(14, self.paper.size.imag + 6)
        notes = textwrap.wrap(" ".join(self._notes()), 72)
        self.paper.size += 1j * (84 + 14 * len(notes))
        places = [corner + 240 * (k // 4) + 17j * (k % 4) for k in range(8)]
        for look, start in zip(LEGEND_ROWS, places, strict=False):
            colour = COLOURS.get(look.letter, BLACK)
            self.paper.arrow(np.array([start, start + 26]), colour, look.width, look.dashes)
            self.paper.text(start + 36 + 4j, look.meaning, BLACK, 11)
        # the scale has one digit times a power of ten, in the unit shown
        unit = float(self.view.map("DA")[0])
        amount = float(f"{self.size / 4 / unit:.0e}")
        start, end = places[7], places[7] + amount * unit * self.scale
        self.paper.line(np.array([start, end]), BLACK, 3.0)
        self.paper.text(end + 10 + 4j, f"{amount:g} {self.view.unit('DA')}", BLACK, 11)
        for k, line in enumerate(notes):
            self.paper.text(corner + 78j + 14j * k, line, BLACK, 10)

    def _notes(self) -> Iterator[str]:
        """Yield the notes of the legend."""
        speed, impulse, spin = (self.view.unit(name) for name in ("SA", "P", "WA"))
        if speed:
            yield f"Velocities in {speed}, impulse in {impulse}, spins in {spin}."
        if self.view.headings:
            yield "North is up."
        yield AXES[self.is_sae, self.turn == 1j]
        for body in self.bodies:
            if hour := self._hour(body):
                yield f"{body.name} is struck from {hour}."
            yield f"{body.name} drawn {body.words}."


def _length(arrow: Arrow) -> float:
    """Return the distance between the ends of an arrow."""
    return float(abs(arrow.points[-1] - arrow.points[0]))
