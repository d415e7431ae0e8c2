"""The scene from above as an SVG picture: bodies, velocities, velocity changes, spins, impulse.

The contact point is the origin. It lies DA at TA + PA from A's center of gravity and DB at TB + PB
from B's (line 330 of the listing); A faces TA + 180 and B faces TB. Points are complex, x + iy:
along the listing's axes in the plane, in pixels with y downwards on paper. The picture is what one
sees from above whatever the axes of the case: of SAE axes y is shown to the right of x, and with
compass headings north is up. How things look, and the table of the answer's numbers below them, are
in `templates/drawing.svg`.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..cases import Case, View
from ..errors import UserError, library
from ..names import LENGTH, MASS, missing
from .answers import Answer, numbers_of
from .pages import render

Points = NDArray[Any]  # complex

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
CORNERS = np.array([0.5 - 0.5j, 0.5 + 0.5j, -0.5 + 0.5j, -0.5 - 0.5j, 0.5 - 0.5j])
VEHICLE = np.array([0.25 - 0.5j, 0.42, 0.25 + 0.5j, *CORNERS[[1, 0, 3, 2]], 0.25 + 0.5j])
"""Outlines that face x: fractions of length and i times width; a vehicle's front is marked."""

# lengths in px
REACH = 150.0  # from the contact point to the farthest point of a body
LONGEST_VELOCITY = 142.0
IMPULSE_LENGTH = 75.0
HALF_PLANE = 93.0
SIDE_STEP = 9.0  # between arrows that start from one center
LETTER_STEP = 14.0  # from the corner of a body to its letter
SHORTEST = 0.7  # a shorter velocity, or a spin that moves the farthest point less, is not drawn
SPIN_TURN = 2.2  # radians of a spin's arc on either side
SPINS = {"spin before": ("W{}", 12.0), "spin after": ("W{}F", 20.0)}
"""Kind of arrow -> name of the spin, and radius of its arc."""
NUMBERS = "SA SB SAF SBF DVA DVB P WA WAF WB WBF PDOFA PDOFB".split()
"""Results in the table."""
VELOCITIES = {"A": "UX UY VAX VAY".split(), "B": "VX VY VBX VBY".split()}


class Body(NamedTuple):
    """One body in plan: class, center of gravity, outline."""

    words: str
    center: complex
    outline: Points

    @property
    def letter_place(self) -> complex:
        """The place of the body's letter, beyond a corner away from the contact point, and off the
        line of an arrow from behind."""
        away = self.outline - 1j * self.center
        corner = int(abs(away).argmax())
        return complex(self.outline[corner] + LETTER_STEP * away[corner] / abs(away[corner]))


class Arrow(NamedTuple):
    """An arrow, and its colour ("A", "B", "P" or "")."""

    kind: str
    key: str
    points: Points


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
        If a velocity before the impact or the contact plane is not known, a value is too large, or
        jinja2 is not installed.
    """
    case, view = answer.case, answer.case.view
    values = {name: x for name, x in answer.scene.items() if not math.isnan(x)}
    if not values:
        raise UserError("the values contradict one another; no impact can be drawn")
    if absent := [name for name in "UX UY VX VY GA".split() if name not in values]:
        raise UserError(f"{missing(absent)}; the drawing shows velocities and contact plane")
    sizes = {name: values[name] for name in NUMBERS if name in values}
    if math.inf in sizes.values():
        raise UserError("a value is too large to be drawn")
    rows = {**numbers_of(case, sizes), **answer.found}
    turn = 1j if view.axes and view.headings else 1  # north, which is x of SAE axes, is up
    shapes = {name: _body(name, values, case, turn) for name in "AB"}
    scale = REACH / max(abs(outline).max() for _, _, outline in shapes.values())
    bodies = {n: Body(words, scale * at, scale * line) for n, (words, at, line) in shapes.items()}
    arrows = list(_arrows(bodies, values, turn, scale))
    if "GA" in case.entries:
        normal = (turn * _unit(values["GA"])).conjugate()
        arrows.append(Arrow("plane", "", HALF_PLANE * normal * np.array([1j, -1j])))
    lines = (*(body.outline for body in bodies.values()), *(arrow.points for arrow in arrows))
    ink = np.concatenate([*lines, [body.letter_place for body in bodies.values()]])
    unit = float(view.map("DA")[0])
    amount = float(f"{REACH / 4 / scale / unit:.0e}")  # one digit times a power of ten
    return render(
        "drawing.svg",
        answer=answer,
        case=case,
        bodies=bodies,
        arrows=arrows,
        low=complex(ink.real.min(), ink.imag.min()),
        high=complex(ink.real.max(), ink.imag.max()),
        scale=amount * unit * scale if bodies["A"].words != DISC else 0,  # a disc's size is none
        amount=f"{amount:g} {view.unit('DA')}",
        rows=rows,
    )


def to_png(svg: str, width: int = 1440) -> bytes:
    """Return an SVG as PNG on white. Raises UserError if resvg-py is not installed."""
    resvg = library("resvg_py", "report", "a PNG picture")
    return bytes(resvg.svg_to_bytes(svg_string=svg, width=width, background="white"))


def _unit(degrees: float) -> complex:
    """Return the unit vector of a direction."""
    return cmath.rect(1.0, math.radians(degrees))


def _arc(radius: float, start: float = 0.0, stop: float = math.tau) -> Points:
    """Return points of a circle around 0 from one angle in radians to another."""
    points: Points = radius * np.exp(1j * np.linspace(start, stop, 37))
    return points


def _shape(name: str, values: Mapping[str, float], case: Case) -> tuple[str, Points]:
    """Return class and outline of a body that faces x: as measured, or by its weight.

    A case without named units is taken to be in the chapter's."""
    view = case.view if case.view.units else View.of(units="chapter")
    meter, kilogram = (float(view.base_size(rule)) for rule in (LENGTH, MASS))
    mass = values.get(f"M{name}", UNKNOWN_MASS / kilogram)
    _, words, *sizes = next(row for row in CLASSES if mass * kilogram <= row[0])
    length, width = (size / meter for size in sizes)
    if values["M"] == 4:
        return DISC, _arc(width / 2)
    if f"L{name}" in case.sizes:
        words, (length, width) = "measured", (case.sizes[side + name].value for side in "LB")
    shape = CORNERS if words == BARRIER else VEHICLE
    return words, shape.real * length + 1j * shape.imag * width


def _body(name: str, values: Mapping[str, float], case: Case, turn: complex) -> Body:
    """Return a body on paper, in base units."""
    side = 1 if name == "A" else -1
    words, shape = _shape(name, values, case)
    inward = side * _unit(values["GA"])  # from the contact plane to the body
    faces_plane = words in (DISC, BARRIER) or f"T{name}" not in values
    ahead = -inward if faces_plane else -side * _unit(values[f"T{name}"])
    outline = shape * ahead
    center = -values.get(f"D{name}", 0.0) * ahead * _unit(values.get(f"P{name}", 0.0))
    if words in (DISC, BARRIER) or not (values.get("DA") or values.get("DB")):
        center = inward * float((outline / inward).real.max())  # moved to the contact plane
    return Body(words, (turn * center).conjugate(), np.conj(turn * (center + outline)))


def _arrows(
    bodies: Mapping[str, Body], values: Mapping[str, float], turn: complex, scale: float
) -> Iterator[Arrow]:
    """Yield the arrows on paper but for the contact plane."""
    fastest = max(x for name, x in values.items() if name in ("SA", "SB", "SAF", "SBF")) or 1.0
    for name, body in bodies.items():
        components = np.array([values.get(n, math.nan) for n in VELOCITIES[name]])
        before, after = np.conj(turn * components.view(complex)).tolist()
        step = SIDE_STEP * (-1j if name == "A" else 1j)
        moves = ("before", before, 0j), ("after", after, step), ("change", after - before, -step)
        for kind, velocity, aside in moves:
            run = LONGEST_VELOCITY / fastest * velocity
            if abs(run) > SHORTEST:  # not of NaN
                start = body.center + aside * run / abs(run) - run * (kind == "before")
                yield Arrow(kind, name, start + run * np.array([0, 1]))
        for kind, (spin_name, radius) in SPINS.items():
            spin = values.get(spin_name.format(name), 0.0)
            if abs(spin) * LONGEST_VELOCITY / fastest * REACH / scale > SHORTEST:
                middle, half = cmath.phase(body.center), math.copysign(SPIN_TURN, spin)
                yield Arrow(kind, name, body.center + _arc(radius, middle + half, middle - half))
        if name == "A" and values.get("P"):
            run = IMPULSE_LENGTH * values["MA"] / values["P"] * (after - before)
            yield Arrow("impulse", "P", run * np.array([0, 1]))
