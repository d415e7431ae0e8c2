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
from collections.abc import Mapping, Sequence
from html import escape
from typing import NamedTuple

import numpy as np

from ..cases import Case
from ..errors import UserError, library, printable
from ..names import LENGTH, MASS, missing
from .answers import Answer
from .labels import Label, leader, path_of, place, points_along, text_element
from .rounding import decimals_of, rounded

COLOURS = {"A": "#0068a3", "B": "#bd4f00", "P": "#99356f"}
"""Okabe and Ito's blue, vermilion and purple, darkened for thin lines and small texts."""
CLASSES = (
    (450.0, "a motorcycle", 2.2, 0.8),
    (2500.0, "a car", 4.6, 1.8),
    (4500.0, "a light truck", 5.7, 2.0),
    (16000.0, "a heavy truck", 9.0, 2.5),
    (math.inf, "a truck with a trailer", 19.0, 2.6),
)
"""Classes of vehicles: largest mass in kg, words, usual length and width in m."""
PROPORTION = 2.6  # length over width of a vehicle of unknown class
MAX_GYRATION = 1e12  # a longer square of length is that of an inertia which stands for no rotation
DISC_DIAMETER = 0.6  # of a point mass, as a fraction of the length of its class
WALL_RATIO = 1e4  # a body at rest so much heavier than the other is drawn as a barrier
LARGEST = 1e100  # the largest number drawn: products of some must be doubles

WIDTH = 480.0  # px of the picture
MARGIN = 46.0  # px around the shapes, for labels
TALLEST = 360.0  # px of the shapes
TITLE_HEIGHT = 24.0  # px
SPEED_REACH = 0.95  # length of the fastest velocity's arrow, as a fraction of the longest body
FORCE_REACH = 0.5  # length of the impulse's arrow, likewise
PLANE_REACH = 0.62  # half the contact plane, likewise
TINY_SPIN = 0.005  # of speed over length: a smaller spin is not drawn
SIDESTEP = 6.0  # px by which an arrow moves off one that it would cover
OUTLINE_STEP = (
    7.0  # px between the points of an outline: a label over it costs less than over lines
)
NOTE_WIDTH = 66  # characters
NOTE_ROW = 15.0  # px
FRONT_MARKS = (
    ((0.22, -0.38), (0.22, 0.38)),
    ((-0.3, -0.36), (-0.3, 0.36)),
    ((0.27, -0.2), (0.38, 0.0), (0.27, 0.2)),
)
"""Windscreen, rear window and arrowhead: fractions of length and width from the center."""
ARROWS = {
    "before": ("v", "S{}", 1.6, "5 3"),
    "after": ("V", "S{}F", 2.4, ""),
    "change": ("ΔV", "DV{}", 1.4, "1.5 2.5"),
}
"""Velocities: symbol, name of their size, width in px and dashes of their arrows."""
SPINS = (("ω", "W{}", 17.0, "5 3"), ("Ω", "W{}F", 24.0, ""))
"""Spins: symbol, name, radius in px and dashes of their arcs."""
LEGEND = """<g transform="translate(12 {top:.0f})" font-size="11" stroke="#000" fill="none">
<path d="M0 0h24" stroke-width="1.6" stroke-dasharray="5 3"/><path d="M0 17h23" stroke-width="2.4"/>
<path d="M0 34h24" stroke-width="1.4" stroke-dasharray="1.5 2.5"/>
<path d="M0 51h20" stroke-width="3.4" stroke="#99356f"/>
<path d="M232 0h34" stroke-width="1.2" stroke-dasharray="9 3 2 3"/>
<path d="M232 14v6m0-3h{length:.1f}m0-3v6M232 31v6m0-3h{speed:.1f}m0-3v6" stroke-width="1.2"/>
<path d="M{axes}" stroke="#595959"/>
<g fill="#000" stroke="none"><path d="M30 0l-7-3v6zM31 17l-9-4v8zM30 34l-7-3v6z"/>
<path d="M31 51l-11-5v10z" fill="#99356f"/>
<text x="40" y="4">v: velocity before{unit}</text><text x="40" y="21">V: velocity after{unit}</text>
<text x="40" y="38">ΔV: velocity change{unit}</text>
<text x="40" y="55">P: impulse on A{impulse}</text>
<text x="276" y="4">contact plane, Γ = {angle}°</text>
<text x="{length_end:.0f}" y="21">{length_text}</text>
<text x="{speed_end:.0f}" y="38">{speed_text}</text>
<g fill="#595959" font-size="10">{axes_texts}{notes}</g></g></g>"""
"""Legend of a drawing, below the scene."""
LEGEND_HEIGHT = 70.0  # px above the notes
AXES = {
    "up": ("14 106v-22m-3 6l3-6 3 6M14 106h22m-6-3l6 3-6 3", ((44, 109, "x"), (14, 80, "y"))),
    "down": ("14 80v22m-3-6l3 6 3-6M14 80h22m-6-3l6 3-6 3", ((44, 83, "x"), (14, 114, "y"))),
    "north": ("14 106v-22m-3 6l3-6 3 6M14 106h22m-6-3l6 3-6 3", ((44, 109, "y"), (14, 80, "x"))),
}
"""Axes of the case beside the notes: y up, y down (SAE), x up (SAE, north up)."""


class Body(NamedTuple):
    """One body in plan.

    Parameters
    ----------
    name : {"A", "B"}
        Its name.
    kind : {"vehicle", "disc", "barrier"}
        Shape drawn.
    center, front : complex
        Center of gravity, and unit vector from there to its front.
    length, width : float
        Size of its outline.
    origin : str
        Where the size comes from, in words.
    faces : bool
        True if its front is given.
    before, after : complex
        Velocities, NaN if not known.
    """

    name: str
    kind: str
    center: complex
    front: complex
    length: float
    width: float
    origin: str
    faces: bool
    before: complex
    after: complex

    def at(self, along: float, across: float) -> complex:
        """Return the point at fractions of the length ahead and of the width to the left."""
        return self.center + self.front * complex(along * self.length, across * self.width)

    @property
    def outline(self) -> list[complex]:
        """Corners of its outline; points of a disc's rim."""
        if self.kind == "disc":
            return [self.center + self.length / 2 * _unit(10.0 * k) for k in range(36)]
        return [self.at(i / 2, j / 2) for i, j in ((1, -1), (1, 1), (-1, 1), (-1, -1))]

    def hour(self, force: complex) -> str:
        """Return the hour of the body's clock from which a force comes; 12 is its front."""
        degrees = math.degrees(cmath.phase(self.front / -force))
        return f"{round(degrees / 30) % 12 or 12} o'clock"


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
    title = printable(answer.case.title) or "Scene from above"
    sheet = _Sheet(answer, _known_values(answer))
    sheet.draw_bodies()
    sheet.draw_plane()
    for body in sheet.bodies:
        sheet.draw_velocities(body)
        sheet.draw_spins(body)
    sheet.draw_impulse()
    sheet.write_labels()
    bottom = sheet.draw_legend()
    top = 0.0
    if titled and answer.case.title:
        top = -TITLE_HEIGHT
        sheet.parts.append(text_element(WIDTH / 2 - 8j, title.replace("_", " "), "#000", 13, True))
    return "\n".join(
        [
            '<svg xmlns="http://www.w3.org/2000/svg" role="img" '
            f'viewBox="0 {top:g} {WIDTH:g} {bottom - top:.0f}" '
            'font-family="DejaVu Sans, Verdana, Arial, sans-serif">',
            f"<title>{escape(title)}</title>",
            *sheet.parts,
            "</svg>",
        ]
    )


def to_png(svg: str, width: int = 1440) -> bytes:
    """Return an SVG as PNG on white. Raises UserError if resvg-py is not installed."""
    resvg = library("resvg_py", "report", "a PNG picture")
    return bytes(resvg.svg_to_bytes(svg_string=svg, width=width, background="white"))


def _unit(degrees: float) -> complex:
    """Return the unit vector of a direction."""
    return cmath.rect(1.0, math.radians(degrees))


def _known_values(answer: Answer) -> dict[str, float]:
    """Return what is known of the impact in base units. Raises UserError."""
    case = answer.case
    values = {name: amount.value for name, amount in {**case.entries, **case.sizes}.items()}
    values |= {**case.numbers, **{name: float(x) for name, x in answer.scene.items()}}
    values = {name: value for name, value in values.items() if not math.isnan(value)}
    if absent := [name for name in ("UX", "UY", "VX", "VY", "GA") if name not in values]:
        raise UserError(f"{missing(absent)}; the drawing shows velocities and contact plane")
    for name, value in values.items():
        if LARGEST < abs(value) < math.inf:
            raise UserError(f"{name} = {value:g} is too large to be drawn")
    return values


def _kind(name: str, values: Mapping[str, float]) -> str:
    """Return the shape in which a body is drawn."""
    other, speeds = ("B", "UX UY WA") if name == "A" else ("A", "VX VY WB")
    is_heavy = values.get(f"M{name}", 1.0) >= WALL_RATIO * values.get(f"M{other}", 1.0)
    if is_heavy and not any(values.get(speed) for speed in speeds.split()):
        return "barrier"
    return "disc" if values.get("M") == 4 else "vehicle"


def _size(name: str, values: Mapping[str, float], case: Case) -> tuple[float, float, str] | None:
    """Return the size of a vehicle as measured, by its class of weight, or by its inertia; where it
    comes from; None if it is not known."""
    if f"L{name}" in values:
        return values[f"L{name}"], values[f"B{name}"], "as measured"
    mass, inertia = values.get(f"M{name}", math.nan), values.get(f"I{name}", math.nan)
    if case.view.units and mass < math.inf:
        meter, kilogram = (float(case.view.base_size(rule)) for rule in (LENGTH, MASS))
        _, words, *size = next(row for row in CLASSES if mass * kilogram <= row[0])
        return size[0] / meter, size[1] / meter, f"as {words} of its weight"
    square = 12 * inertia / mass if mass else math.nan
    if 0 < square < MAX_GYRATION:
        length = math.sqrt(square / (1 + PROPORTION**-2))
        return length, length / PROPORTION, "by its inertia"
    return None


def _bodies(values: Mapping[str, float], case: Case) -> list[Body]:
    """Return both bodies in plan."""
    kinds = {name: _kind(name, values) for name in "AB"}
    sizes = {n: _size(n, values, case) for n, kind in kinds.items() if kind != "barrier"}
    usual = next(filter(None, sizes.values()), (1.0, 1 / PROPORTION, "in any size"))
    bodies = []
    for name, side in (("A", 1), ("B", -1)):
        kind, inward = kinds[name], side * _unit(values["GA"])
        names = ("UX", "UY") if name == "A" else ("VX", "VY")
        before = complex(*(values[n] for n in names))
        after = complex(*(values.get(f"V{name}{axis}", math.nan) for axis in "XY"))
        course = before or (0j if cmath.isnan(after) else after) or -inward
        theta = values.get(f"T{name}")
        front = course / abs(course) if theta is None else -side * _unit(theta)
        length, width, origin = sizes.get(name) or usual
        if kind == "disc":
            length = width = DISC_DIAMETER * length
        if kind == "barrier":
            front, length, width = inward, 0.15 * length, 1.5 * length
        angle = values.get(f"T{name}", 0.0) + values.get(f"P{name}", 0.0)
        center = side * values.get(f"D{name}", 0.0) * _unit(angle)
        if kind != "vehicle" or _is_armless(values):  # they touch at the contact plane
            direction = front / inward
            depth = abs(direction.real) * length + abs(direction.imag) * width
            center = inward * (length if kind == "disc" else depth) / 2
        faces = theta is not None and f"T{name}" not in case.omitted and kind != "barrier"
        plan = center, front, length, width, origin
        bodies.append(Body(name, kind, *plan, faces, before, after))
    return bodies


def _is_armless(values: Mapping[str, float]) -> bool:
    """Return True if no distance to the contact point is given."""
    return not (values.get("DA") or values.get("DB"))


class _Sheet:
    """The paper: its scale, what is drawn on it, and labels still to be placed."""

    def __init__(self, answer: Answer, values: dict[str, float]) -> None:
        self.answer, self.values, self.view = answer, values, answer.case.view
        self.bodies = _bodies(values, answer.case)
        self.parts: list[str] = []
        self.labels: list[Label] = []
        self.ink: list[np.ndarray] = []
        self.arrows: list[np.ndarray] = []
        self.normal = _unit(values["GA"])
        lengths = [body.length for body in self.bodies if body.kind != "barrier"]
        self.size = max(lengths, default=1.0)
        speeds = [abs(v) for b in self.bodies for v in (b.before, b.after) if not cmath.isnan(v)]
        self.speed = max(speeds)
        self.speed_decimals = decimals_of([self.view.shown("SA", self.speed)])
        self.per_speed = SPEED_REACH * self.size / self.speed if self.speed else 0.0
        self.impulse = self._impulse()
        self.is_sae = self.view.axes == "sae"
        # north, which is x of SAE axes, is up
        self.turn = 1j if self.is_sae and self.view.headings else 1 + 0j
        self._fit()

    def _impulse(self) -> complex:
        """Return the impulse on A, which is the momentum that a body gains; 0 if not known."""
        body, sense = self.bodies[0], 1
        if body.kind == "barrier":
            body, sense = self.bodies[1], -1
        change = sense * self.values.get(f"M{body.name}", 1.0) * (body.after - body.before)
        return 0j if cmath.isnan(change) else change

    def _fit(self) -> None:
        """Choose scale and origin so that all that is drawn is on the paper."""
        plane = 1j * PLANE_REACH * self.size * self.normal
        points = [plane, -plane, self._force()]
        for body in self.bodies:
            points += body.outline
            points += [end for ends in self._velocities(body).values() for end in ends]
        drawn = np.array(points) * self.turn
        left, right = float(drawn.real.min()), float(drawn.real.max())
        bottom, top = float(drawn.imag.min()), float(drawn.imag.max())
        self.scale = min((WIDTH - 2 * MARGIN) / (right - left), TALLEST / (top - bottom))
        self.height = self.scale * (top - bottom) + 2 * MARGIN
        middle = complex(left + right, -bottom - top) / 2
        self.origin = complex(WIDTH, self.height) / 2 - self.scale * middle

    def _force(self) -> complex:
        """Return the end of the impulse's arrow in the plane."""
        return FORCE_REACH * self.size * self.impulse / (abs(self.impulse) or 1.0)

    def at(self, point: complex) -> complex:
        """Return a point of the plane on paper."""
        return self.origin + self.scale * (point * self.turn).conjugate()

    def text(self, name: str, value: float) -> str:
        """Return the text of a base value: the answer's own, or rounded alike."""
        if name in self.answer.found:
            return self.answer.found[name].text
        number = self.view.shown(name, value)
        is_speed = name[0] in "SD"
        return rounded(number, self.speed_decimals if is_speed else decimals_of([number]))

    def line(
        self,
        points: Sequence[complex],
        colour: str,
        width: float,
        dash: str = "",
        *,
        is_outline: bool = False,
    ) -> None:
        """Draw a line through points on paper, or a filled outline."""
        look = f'fill="{colour}" fill-opacity=".14"' if is_outline else 'fill="none"'
        look += f' stroke="{colour}" stroke-width="{width:g}" stroke-linejoin="round"'
        look += f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<path d="{path_of(points)}{"Z" * is_outline}" {look}/>')
        closed = [*points, points[0]] if is_outline else points
        self.ink.append(points_along(closed, OUTLINE_STEP) if is_outline else points_along(closed))

    def head(self, tip: complex, direction: complex, colour: str, size: float) -> None:
        """Draw the head of an arrow."""
        back = size * direction / abs(direction)
        corners = [tip, tip - back * (1 + 0.38j), tip - back * (1 - 0.38j)]
        self.parts.append(f'<path d="{path_of(corners)}Z" fill="{colour}"/>')

    def ring(self, center: complex, radius: float, colour: str) -> None:
        """Draw a small circle."""
        self.parts.append(
            f'<circle cx="{center.real:.1f}" cy="{center.imag:.1f}" r="{radius:g}" fill="#fff" '
            f'stroke="{colour}" stroke-width="1.4"/>'
        )
        self.ink.append(center + radius * np.exp(1j * np.arange(0, math.tau, 0.5)))

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
            points = points_along([start + aside, end + aside])
            if not any(_covers(points, arrow) for arrow in self.arrows):
                break
        self.arrows.append(points)
        start, end = start + aside, end + aside
        self.line([start, end - 0.8 * size * run / abs(run)], colour, width, dash)
        self.head(end, run, colour, size)
        return start, end

    def draw_bodies(self) -> None:
        """Draw the outlines and the marks that show the fronts."""
        for body in self.bodies:
            colour, center = COLOURS[body.name], self.at(body.center)
            self.line([self.at(p) for p in body.outline], colour, 1.5, is_outline=True)
            for mark in FRONT_MARKS if body.kind == "vehicle" else ():
                self.line([self.at(body.at(*place)) for place in mark], colour, 1.0)
            away = self.at(2 * body.center or body.front) - center
            self.labels.append(Label(center, away, body.name, colour, 17, True))

    def draw_plane(self) -> None:
        """Draw the contact plane with its axes, and the contact point."""
        plane = 1j * PLANE_REACH * self.size * self.normal
        top, bottom, contact = self.at(plane), self.at(-plane), self.at(0j)
        self.line([top, bottom], "#000", 1.2, "9 3 2 3")
        corner = self.at(0.78 * plane)
        normal = self.at(self.normal) - contact
        for name, end in (("n", corner + 22 * normal / abs(normal)), ("t", top)):
            self.line([corner, end], "#000", 1.2)
            self.head(end, end - corner, "#000", 6)
            self.labels.append(Label(end, end - corner, name, "#000", 11))
        self.labels.append(Label(contact, bottom - contact, "C", "#000", 11))

    def _velocities(self, body: Body) -> dict[str, tuple[complex, complex]]:
        """Return the ends of a body's arrows: before the impact up to its center, else from it."""
        center, reach = body.center, self.per_speed
        arrows = {"before": (center - reach * body.before, center)}
        if not cmath.isnan(body.after):
            arrows["after"] = (center, center + reach * body.after)
            arrows["change"] = (center, center + reach * (body.after - body.before))
        return arrows

    def draw_velocities(self, body: Body) -> None:
        """Draw a body's velocities and its center."""
        colour = COLOURS[body.name]
        for kind, (tail, tip) in self._velocities(body).items():
            symbol, name, width, dash = ARROWS[kind]
            ends = self.arrow(self.at(tail), self.at(tip), colour, width, dash)
            if ends:
                size = self.text(name.format(body.name), abs(tip - tail) / self.per_speed)
                at, origin = ends if kind == "before" else ends[::-1]
                text = f"{symbol}_{body.name.lower()} {size}"
                self.labels.append(Label(at, at - origin, text, colour))
        self.ring(self.at(body.center), 3.0, colour)

    def draw_spins(self, body: Body) -> None:
        """Draw a body's spins as arcs around its center, behind it as seen from the contact."""
        center, colour = self.at(body.center), COLOURS[body.name]
        behind = self.at(2 * body.center or -body.front) - center
        for symbol, name, radius, dash in SPINS if body.kind == "vehicle" else ():
            spin = self.values.get(name.format(body.name), 0.0)
            if abs(spin) * self.size <= TINY_SPIN * self.speed:
                continue
            sense = -1j if spin > 0 else 1j  # counterclockwise on paper, whose y is downwards
            middle = radius * behind / abs(behind)
            arc = [middle * cmath.exp(sense * math.radians(k)) for k in range(-125, 126, 10)]
            self.line([center + point for point in arc], colour, 1.6, dash)
            along = sense * arc[-1]
            self.head(center + arc[-1] + 2 * along / radius, along, colour, 7)
            text = f"{symbol}_{body.name.lower()} {self.text(name.format(body.name), spin)}"
            self.labels.append(Label(center + middle, middle, text, colour))

    def draw_impulse(self) -> None:
        """Draw the impulse on A, and the contact point."""
        contact, body = self.at(0j), self.bodies[0]
        ends = self.arrow(contact, self.at(self._force()), COLOURS["P"], 3.4)
        if ends:
            text = f"P {body.hour(self.impulse)}" if body.faces else "P"
            self.labels.append(Label(ends[1], ends[1] - ends[0], text, COLOURS["P"]))
        self.ring(contact, 3.4, "#000")

    def write_labels(self) -> None:
        """Place the labels and write them."""
        order = sorted(self.labels, key=lambda label: label.size, reverse=True)
        places = place(order, np.concatenate(self.ink), WIDTH, self.height)
        for label, box in places:
            if ends := leader(label, box):
                self.line(ends, label.colour, 0.6)
        for label, box in places:
            base = box.center + 0.36j * label.size
            self.parts.append(text_element(base, label.text, label.colour, label.size, label.bold))

    def draw_legend(self) -> float:
        """Draw the legend below; return its lower edge."""
        view, top = self.view, self.height + 6
        length, length_text = self._scale("DA", self.size, self.scale)
        speed, speed_text = self._scale("SA", self.speed, self.scale * self.per_speed)
        axes, letters = AXES["north" if self.turn == 1j else "down" if self.is_sae else "up"]
        unit = view.unit("SA")
        impulse = f"{self.text('P', abs(self.impulse))} {view.unit('P')}".rstrip()
        notes = textwrap.wrap(self._notes(), NOTE_WIDTH)
        self.parts.append(
            LEGEND.format(
                top=top,
                axes=axes,
                axes_texts="".join(
                    f'<text x="{x}" y="{y}" text-anchor="middle">{c}</text>' for x, y, c in letters
                ),
                unit=f", {unit}" if unit else "",
                impulse=f", {impulse}" if self.impulse else "",
                angle=f"{view.shown('GA', self.values['GA']):.4g}",
                length=length,
                length_end=max(276.0, 240 + length),
                length_text=length_text,
                speed=speed,
                speed_end=max(276.0, 240 + speed),
                speed_text=speed_text,
                notes="".join(
                    f'<text x="72" y="{84 + k * NOTE_ROW:g}">{text}</text>'
                    for k, text in enumerate(notes)
                ),
            )
        )
        return top + LEGEND_HEIGHT + max(50.0, 20 + len(notes) * NOTE_ROW)

    def _scale(self, name: str, extent: float, px_per_base: float) -> tuple[float, str]:
        """Return a scale in px, and its text: 1, 2 or 5 times a power of ten in units shown."""
        if not extent:
            return 0.0, ""
        per_shown = float(self.view.map(name)[0])
        half = 0.5 * extent / per_shown
        power = 10.0 ** math.floor(math.log10(half))
        amount = max(step * power for step in (1, 2, 5) if step * power <= half * (1 + 1e-12))
        text = f"{amount:g} {self.view.unit(name)}".rstrip()
        words = "length" if name == "DA" else "speed"
        return amount * per_shown * px_per_base, f"{text} ({words})"

    def _notes(self) -> str:
        """Return the notes of the legend."""
        view, sense = self.view, "clockwise" if self.is_sae else "counterclockwise"
        words = []
        if any(body.kind == "vehicle" for body in self.bodies):
            words.append(f"Spins in {view.unit('WA') or 'radians per time'}, positive {sense}.")
        words += ["North is up."] if view.headings else []
        if self.impulse and self.bodies[1].faces:
            words.append(f"B is struck from {self.bodies[1].hour(-self.impulse)}.")
        looks: dict[str, list[str]] = {}
        for body in self.bodies:
            length, width = (f"{view.shown('DA', x):.3g}" for x in (body.length, body.width))
            size = f"{body.origin}, {length} by {width} {view.unit('DA')}".rstrip()
            look = {"disc": "as disc (point mass)", "barrier": "as a barrier"}.get(body.kind, size)
            looks.setdefault(look, []).append(body.name)
        words += [f"{' and '.join(names)} drawn {look}." for look, names in looks.items()]
        if self.values.get("M") == 4 or _is_armless(self.values):
            words.append("Moved apart along n to be seen.")
        return " ".join(words)


def _covers(first: np.ndarray, second: np.ndarray) -> bool:
    """Return True if a third of the shorter of two lines lies along the other."""
    distances = np.abs(first[:, None] - second)
    limit = min(len(first), len(second)) / 3
    return bool((distances.min(axis=1) < SIDESTEP / 2).sum() > limit)
