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
from collections.abc import Iterator, Mapping
from textwrap import wrap
from typing import NamedTuple

import numpy as np

from ..cases import Case, View
from ..errors import UserError, library, printable
from ..mechanics.solve import evaluate
from ..names import LENGTH, MASS, missing
from .answers import Answer, numbers_of
from .paper import BORDER, Paper, Points, arc

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
DISC = "a disc (point mass)"
UNKNOWN_MASS = 1500.0  # kg: a body whose mass is not known is drawn as a car

REACH = 150.0  # px from the contact point to the farthest point of a body
SPEED_REACH = 0.95  # length of the fastest velocity's arrow, as a fraction of that distance
FORCE_REACH = 0.5  # length of the impulse's arrow, likewise
PLANE_REACH = 0.62  # half the contact plane, likewise
ASIDE = 0.06j  # distance between arrows that start from one center, likewise
SPIN_TURN = 2.2  # radians of a spin's arc on either side
TINY = 0.005  # of the largest velocity: a smaller one, or a slower spin, is not drawn
CORNERS = np.array([0.5 - 0.5j, 0.5 + 0.5j, -0.5 + 0.5j, -0.5 - 0.5j, 0.5 - 0.5j])
VEHICLE = np.array([0.25 - 0.5j, 0.42, 0.25 + 0.5j, *CORNERS[[1, 0, 3, 2]], 0.25 + 0.5j])
"""Outlines that face x: fractions of length and i times width; a vehicle's front is marked."""
VELOCITIES = {"A": "UX UY VAX VAY".split(), "B": "VX VY VBX VBY".split()}
SIZES = "SA SB SAF SBF DVA DVB P WA WAF WB WBF PDOFA PDOFB".split()
"""Results beside arrows, and hours."""
NOTES_WIDTH = 76  # characters a line
HEADING_WIDTH = 50  # likewise
HEADING_SIZE = 14.0  # px
NEAREST = "NO IMPACT: nearest impact drawn"
FORBIDDEN = "NO IMPACT: physics forbids what is drawn"
"""Verdicts on what no impact is: of a reconstruction, and of a complete scene."""


class Look(NamedTuple):
    """Look of one kind of arrow: letter, meaning, name of its size, width in px, dashes."""

    letter: str
    meaning: str
    name: str
    width: float
    dashes: str = "none"


BEFORE = Look("v", "velocity before, dashed", "S{}", 1.6, "5 3")
AFTER = Look("V", "velocity after", "S{}F", 2.4)
CHANGE = Look("ΔV", "velocity change, dotted", "DV{}", 1.4, "1.5 2.5")
SPIN_BEFORE = Look("ω", "spin before, dashed", "W{}", 1.6, "5 3")
SPIN_AFTER = Look("Ω", "spin after", "W{}F", 2.4)
IMPULSE = Look("P", "impulse on A", "P", 3.0)
PLANE = Look("t", "contact plane", "", 1.2, "9 3 2 3")


class Body(NamedTuple):
    """One body in plan: class, center of gravity, outline; velocities, NaN if not known."""

    words: str
    center: complex
    outline: Points
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
    return _Scene(answer).svg(printable(answer.case.title) or "Scene from above")


def to_png(svg: str, width: int = 1440) -> bytes:
    """Return an SVG as PNG on white. Raises UserError if resvg-py is not installed."""
    resvg = library("resvg_py", "report", "a PNG picture")
    return bytes(resvg.svg_to_bytes(svg_string=svg, width=width, background="white"))


def _unit(degrees: float) -> complex:
    """Return the unit vector of a direction."""
    return cmath.rect(1.0, math.radians(degrees))


def _shape(name: str, values: Mapping[str, float], case: Case) -> tuple[str, Points]:
    """Return class and outline of a body that faces x: as measured, or by its weight.

    A case without named units is taken to be in the chapter's."""
    view = case.view if case.view.units else View.of(units="chapter")
    meter, kilogram = (float(view.base_size(rule)) for rule in (LENGTH, MASS))
    mass = values.get(f"M{name}", UNKNOWN_MASS / kilogram)
    _, words, *sizes = next(row for row in CLASSES if mass * kilogram <= row[0])
    length, width = (size / meter for size in sizes)
    if values["M"] == 4:
        return DISC, arc(width / 2)
    if f"L{name}" in case.sizes:
        words, (length, width) = "measured", (case.sizes[side + name].value for side in "LB")
    shape = CORNERS if words == BARRIER else VEHICLE
    return words, shape.real * length + 1j * shape.imag * width


def _body(name: str, values: Mapping[str, float], case: Case) -> Body:
    """Return a body in plan."""
    side = 1 if name == "A" else -1
    components = [values.get(velocity, math.nan) for velocity in VELOCITIES[name]]
    before, after = complex(*components[:2]), complex(*components[2:])
    words, shape = _shape(name, values, case)
    inward = side * _unit(values["GA"])  # from the contact plane to the body
    course = math.degrees(cmath.phase(-side * before))
    is_fixed = words in (DISC, BARRIER)
    ahead = -inward if is_fixed else -side * _unit(values.get(f"T{name}", course))
    outline = shape * ahead
    center = -values.get(f"D{name}", 0.0) * ahead * _unit(values.get(f"P{name}", 0.0))
    if is_fixed or not (values.get("DA") or values.get("DB")):  # moved to the contact plane
        center = inward * float((outline / inward).real.max())
    return Body(words, center, center + outline, before, after)


class _Scene(Paper):
    """The scene of an answer on paper. Raises UserError for what cannot be drawn."""

    def __init__(self, answer: Answer) -> None:
        super().__init__()
        values = {name: float(x) for name, x in answer.scene.items() if not math.isnan(x)}
        if absent := [name for name in "UX UY VX VY GA".split() if name not in values]:
            raise UserError(f"{missing(absent)}; the drawing shows velocities and contact plane")
        sizes, _ = evaluate(values, SIZES)
        self.sizes = {name: float(x) for name, x in sizes.items() if not math.isnan(x)}
        if math.inf in self.sizes.values():
            raise UserError("a value is too large to be drawn")
        self.view = answer.case.view
        self.rows = {**numbers_of(answer.case, self.sizes), **answer.found}
        self.bodies = {name: _body(name, values, answer.case) for name in "AB"}
        self.reach = max(abs(body.outline).max() for body in self.bodies.values())
        self.speed = max(x for name, x in self.sizes.items() if name[0] == "S") or 1.0
        # north, which is x of SAE axes, is up
        self.turn = 1j if self.view.axes and self.view.headings else 1 + 0j
        self.labels: list[tuple[Points, str, str]] = []
        self.legend: dict[Look, str] = {}  # in the order drawn
        for name, body in self.bodies.items():
            self._draw_body(name, body)
        plane = 1j * PLANE_REACH * self.reach * _unit(values["GA"])
        if "GA" in answer.case.entries:
            self._draw_arrow(PLANE, "", plane * np.array([-1, 1]))
        self._draw_dot(0j, "")
        first = self.bodies["A"]
        if size := self.sizes.get("P"):
            run = FORCE_REACH * self.reach * values["MA"] / size * (first.after - first.before)
            self._draw_arrow(IMPULSE, "P", run * np.array([0, 1]))
        for ends, text, key in self.labels:
            start, end = self._at(ends)
            self.label(end, end - start, text, key, 18.0 if text in self.bodies else 12.0)
        self._draw_legend(answer)

    def _at(self, points: Points) -> Points:
        """Return points of the plane on paper."""
        places: Points = np.conj(points * self.turn) * (REACH / self.reach)
        return places

    def _draw_body(self, name: str, body: Body) -> None:
        """Draw a body, its velocities, and its spins as arcs away from the contact."""
        center, change = body.center, body.after - body.before
        self.line(self._at(body.outline), name, opacity=0.14)
        self._draw_dot(center, name)
        self.labels.append((np.array([0, center]), name, name))
        aside = ASIDE if name == "A" else -ASIDE
        arrows = (BEFORE, body.before, 0j), (AFTER, body.after, aside), (CHANGE, change, -aside)
        for look, velocity, shift in arrows:
            number = look.name.format(name)
            if self.sizes.get(number, 0.0) > TINY * self.speed:
                run = SPEED_REACH * self.reach / self.speed * velocity
                start = center - run * (look is BEFORE) + shift * self.reach * run / abs(run)
                self._draw_arrow(look, name, start + run * np.array([0, 1]))
        for look, radius in (SPIN_BEFORE, 0.075), (SPIN_AFTER, 0.11):
            spin = self.sizes.get(look.name.format(name), 0.0)
            if abs(spin) * self.reach > TINY * self.speed:
                middle, turn = cmath.phase(center), math.copysign(SPIN_TURN, spin)
                points = arc(radius * self.reach, middle - turn, middle + turn)
                self._draw_arrow(look, name, center + points)

    def _draw_dot(self, point: complex, key: str) -> None:
        """Draw a dot."""
        self.line(self._at(point + arc(0.006 * self.reach)), key, 4.0)

    def _draw_arrow(self, look: Look, key: str, points: Points) -> None:
        """Draw an arrow and keep its label: at its tip, of a velocity before at its tail."""
        self.line(self._at(points), key, look.width, look.dashes, head=f"url(#tip{key})")
        letter = look.letter + f"_{key.lower()}" * (key in self.bodies)
        text, meaning = letter, look.meaning
        if row := self.rows.get(look.name.format(key)):
            text += f" {row.text}"
            meaning += f" [{row.unit or 'consistent units'}]"
        self.legend[look] = f"{look.letter}: {meaning}."
        ends = points[1::-1] if look is BEFORE else points[-2:]
        self.labels.append((ends, text, key))

    def _draw_legend(self, answer: Answer) -> None:
        """Draw title and verdict above the scene; scale, legend and notes below."""
        low, high = self.corners()
        heading = wrap(printable(answer.case.title), HEADING_WIDTH)
        if not answer.possible:
            heading.append(NEAREST if answer.asked == "reconstruct" else FORBIDDEN)
        for k, line in enumerate(reversed(heading)):
            self.text(low + BORDER.conjugate() - 20j * k, line, size=HEADING_SIZE)
        corner = complex(low.real, high.imag) + BORDER
        if self.bodies["A"].words != DISC:  # whose size means nothing
            # the scale has one digit times a power of ten, in the unit shown
            unit = float(self.view.map("DA")[0])
            amount = float(f"{self.reach / 4 / unit:.0e}")
            end = corner + amount * unit * REACH / self.reach
            self.line(np.array([corner, end]), width=3.0)
            self.text(end + 8, f"{amount:g} {self.view.unit('DA')}")
        notes = " ".join([*self.legend.values(), *self._notes()])
        for k, line in enumerate(wrap(notes, NOTES_WIDTH), 1):
            self.text(corner + 15j * k, line)

    def _notes(self) -> Iterator[str]:
        """Yield the notes of the legend."""
        yield "North is up." if self.view.headings else "The x axis points to the right."
        if {SPIN_BEFORE, SPIN_AFTER} & {*self.legend}:
            yield f"Spins are positive {'' if self.view.axes else 'counter'}clockwise."
        for name, body in self.bodies.items():
            row = self.rows.get(f"PDOF{name}")
            hour = f"; struck from {row.note}" if row and row.note else ""
            yield f"{name} is drawn as {body.words}{hour}."
