"""The scene from above as an SVG picture: bodies, velocities, velocity changes, spins, impulse.

The contact point is the origin. It lies DA at TA + PA from A's center of gravity and DB at TB + PB
from B's (line 330 of the listing); A faces TA + 180 and B faces TB. Points are complex, x + iy
along the listing's axes. The picture is what one sees from above whatever the axes of the case: of
SAE axes y is shown to the right of x, and with compass headings north is up. How things look, and
the table of the answer's numbers below them, are in `templates/drawing.svg`.
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
from ..names import LENGTH, MASS
from .answers import DRAWN, Answer, numbers_of
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
CORNERS = np.array([0.5 - 0.5j, 0.5 + 0.5j, -0.5 + 0.5j, -0.5 - 0.5j, 0.5 - 0.5j])
VEHICLE = np.array([0.25 - 0.5j, 0.42, 0.25 + 0.5j, *CORNERS[[2, 3, 0, 1]], 0.25 + 0.5j])
"""Outlines that face x: fractions of length and i times width; a vehicle's front is marked."""

REACH = 150.0  # px from the contact point to the farthest point of a body
# lengths, as fractions of the reach
LONGEST_VELOCITY = 0.95
IMPULSE_LENGTH = 0.5
HALF_PLANE = 0.62
SIDE_STEP = 0.06  # between arrows that start from one center
SPINS = (("spin before", "W{}", 0.08), ("spin after", "W{}F", 0.13))
"""Kind of arrow, name of the spin, radius of its arc."""
SPIN_TURN = 2.2  # radians of a spin's arc on either side
LEAST_SPIN = 0.02  # rad/s of a spin that is drawn: 1 degree a second
LEAST_VELOCITY = 0.005  # of a velocity that is drawn, over the largest
STROKE = np.array([0, 1])  # start and end of an arrow
SPEEDS = ("SA", "SB", "SAF", "SBF")
VELOCITIES = {"A": "UX UY VAX VAY".split(), "B": "VX VY VBX VBY".split()}


class Body(NamedTuple):
    """One body in plan: class, center of gravity, outline whose fourth and fifth point are at the
    rear of a vehicle."""

    words: str
    center: complex
    points: Points


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
        If a velocity before the impact or the contact plane is not known, or jinja2 is not
        installed.
    """
    case, view = answer.case, answer.case.view
    values = answer.scene
    if absent := [name for name in "MA MB UX UY VX VY GA".split() if name not in values]:
        raise UserError(f"no impact that agrees with the values has {' '.join(absent)}")
    numbers = {name: values[name] for name in (*DRAWN, "WA", "WB") if name in values}
    bodies = {name: _body(name, values, case) for name in "AB"}
    outlines = [body.points for body in bodies.values()]
    reach = float(abs(np.concatenate(outlines)).max())
    arrows = list(_arrows(bodies, values, reach))
    if "GA" in case.entries:
        plane = HALF_PLANE * reach * _unit(values["GA"] + 90)
        arrows.append(Arrow("plane", "", plane * np.array([-1, 1])))
    # north, which is x of SAE axes, is up
    to_paper = REACH / reach * (1j if view.axes and view.headings else 1)
    ink = to_paper * np.concatenate([*outlines, *(arrow.points for arrow in arrows)])
    return render(
        "drawing.svg",
        answer=answer,
        case=case,
        bodies=bodies,
        arrows=arrows,
        to_paper=to_paper,
        ink=ink,
        rows={**numbers_of(case, numbers), **answer.found},
    )


def to_png(svg: str) -> bytes:
    """Return an SVG as PNG on white. Raises UserError if resvg-py is not installed."""
    resvg = library("resvg_py", "report", "a PNG picture")
    return bytes(resvg.svg_to_bytes(svg_string=svg, width=1440, background="white"))


def _unit(degrees: float) -> complex:
    """Return the unit vector of a direction."""
    return cmath.rect(1.0, math.radians(degrees))


def _arc(radius: float, start: float, stop: float) -> Points:
    """Return points of a circle around 0 from one angle in radians to another."""
    points: Points = radius * np.exp(1j * np.linspace(start, stop, 73))
    return points


def _shape(name: str, values: Mapping[str, float], case: Case) -> tuple[str, Points]:
    """Return class and outline of a body that faces x, by its weight.

    A case without named units is taken to be in the chapter's."""
    view = case.view if case.view.units else View.of(units="chapter")
    meter, kilogram = (float(view.base_size(rule)) for rule in (LENGTH, MASS))
    _, words, *sizes = next(row for row in CLASSES if values[f"M{name}"] * kilogram <= row[0])
    length, width = (size / meter for size in sizes)
    if values["M"] == 4:
        return DISC, _arc(width / 2, math.pi / 2, 2.5 * math.pi)
    shape = CORNERS if words == BARRIER else VEHICLE
    return words, shape.real * length + 1j * shape.imag * width


def _body(name: str, values: Mapping[str, float], case: Case) -> Body:
    """Return a body in its place."""
    side = 1 if name == "A" else -1
    words, shape = _shape(name, values, case)
    inward = side * _unit(values["GA"])  # from the contact plane to the body
    is_turned = words in (DISC, BARRIER) or f"T{name}" not in values  # towards the plane
    ahead = -inward if is_turned else -side * _unit(values[f"T{name}"])
    outline = shape * ahead
    center = -values.get(f"D{name}", 0.0) * ahead * _unit(values.get(f"P{name}", 0.0))
    if is_turned or not values.get(f"D{name}"):
        center = inward * float((outline / inward).real.max())  # moved to the contact plane
    return Body(words, center, center + outline)


def _arrows(
    bodies: Mapping[str, Body], values: Mapping[str, float], reach: float
) -> Iterator[Arrow]:
    """Yield the arrows but for the contact plane."""
    fastest = max(values.get(name, 0.0) for name in SPEEDS) or 1.0
    for name, body in bodies.items():
        components = np.array([values.get(n, math.nan) for n in VELOCITIES[name]])
        before, after = components.view(complex).tolist()
        change, aside = after - before, SIDE_STEP * reach * (1j if name == "A" else -1j)
        moves = ("before", before, 0.0), ("after", after, aside), ("change", change, -aside)
        for kind, velocity, step in moves:
            size = abs(velocity)
            if size > LEAST_VELOCITY * fastest:  # not of NaN
                run = LONGEST_VELOCITY * reach / fastest * velocity
                start = body.center + step * velocity / size - run * (kind == "before")
                yield Arrow(kind, name, start + run * STROKE)
        for kind, spin_name, radius in SPINS:
            spin = values.get(spin_name.format(name), 0.0)
            if abs(spin) > LEAST_SPIN:
                middle, half = cmath.phase(body.center), math.copysign(SPIN_TURN, spin)
                arc = _arc(radius * reach, middle - half, middle + half)
                yield Arrow(kind, name, body.center + arc)
        if name == "A" and values.get("P"):
            impulse = IMPULSE_LENGTH * reach / abs(change) * change
            yield Arrow("impulse", "P", impulse * STROKE)
