"""A sheet of paper: lines, areas, arrows, and texts that cover nothing, as an SVG picture.

Points on paper are complex numbers, x + iy in pixels with y downwards. Presentation attributes
alone are used, for a web page that allows no styles in the page."""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Sequence
from html import escape
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Points = NDArray[Any]  # complex

INK_STEP = 2.0  # px between the points that represent a line
SIDESTEPS = (0.0, 6.0, -6.0, 12.0, -12.0, 18.0, -18.0)  # px that an arrow may move aside
COVERED_SHARE = 1 / 3  # of an arrow: so much of it along other lines hides it
COVERED_DISTANCE = 3.0  # px
CHARACTER_WIDTH = 0.64  # of the size of type: an upper estimate of the mean in DejaVu Sans
SINGLE_EXTRA = 0.15  # of the size of type: a single letter may be so much wider
DIRECTIONS = 24  # directions tried around a point
REACHES = (3.0, 7.0, 12.0, 18.0, 26.0, 36.0, 50.0, 70.0, 95.0)  # px: distances tried
REACH_UNIT = 6.0  # px of distance that cost as much as one point of covered ink
LEADER_FROM = 15.0  # px: from this distance on a thin line leads to the point
GAP = 1 + 1j  # px around a text
FORBIDDEN = 1e4  # cost of a place over another text or outside the paper
SUBSCRIPT = re.compile(r"^(Δ?\w)_(\w)(.*)")
SUBSCRIPT_ELEMENT = r'\1<tspan dy=".33em" font-size="75%">\2</tspan><tspan dy="-.25em">\3</tspan>'


class Label(NamedTuple):
    """A text for a point, preferably in a direction from it."""

    at: complex
    direction: complex
    text: str
    colour: str
    size: float = 12.0

    @property
    def half(self) -> complex:
        """Half the width and i times half the height of the text."""
        return complex(text_width(self.text, self.size), 1.1 * self.size) / 2


def text_width(text: str, size: float) -> float:
    """Return an upper estimate of a text's width in px, for the usual sans-serif typefaces."""
    return size * (SINGLE_EXTRA + CHARACTER_WIDTH * len(text.replace("_", "")))


def arc(radius: float, start: float = 0.0, stop: float = math.tau) -> Points:
    """Return points of a circle around 0 from one angle in radians to another."""
    points: Points = radius * np.exp(1j * np.linspace(start, stop, 37))
    return points


class Paper:
    """The drawing on a sheet of a width and height in px, and labels still to be placed."""

    def __init__(self, size: complex) -> None:
        self.size = size
        self.parts: list[str] = []
        self.ink = np.zeros(0, complex)
        self.arrows = np.zeros(0, complex)
        self.labels: list[Label] = []

    def line(self, points: Points, colour: str, width: float, dashes: str = "none") -> None:
        """Draw a line."""
        self.ink = np.append(self.ink, _points_along(points))
        self.parts.append(
            f'<path d="{_path(points)}" fill="none" stroke="{colour}" stroke-width="{width}" '
            f'stroke-dasharray="{dashes}"/>'
        )

    def area(self, points: Points, colour: str, opacity: float = 1.0) -> None:
        """Fill an area."""
        self.parts.append(f'<path d="{_path(points)}Z" fill="{colour}" fill-opacity="{opacity}"/>')

    def arrow(self, points: Points, colour: str, width: float, dashes: str = "none") -> Points:
        """Draw an arrow along a line, moved aside if others cover it; return its points."""
        run = points[-1] - points[0]
        sidesteps = SIDESTEPS if len(points) == 2 else SIDESTEPS[:1]  # an arc stays
        steps = 1j * run / abs(run) * np.array(sidesteps)
        points = points + min(steps, key=lambda step: self._is_covered(points + step))
        self.arrows = np.append(self.arrows, _points_along(points))
        along = points[-1] - points[-2]
        head = min(4.0 + 2.2 * width, 0.6 * abs(run)) * along / abs(along)
        self.line(np.append(points[:-1], points[-1] - 0.8 * head), colour, width, dashes)
        self.area(points[-1] - head * np.array([0, 1 - 0.38j, 1 + 0.38j]), colour)
        return points

    def _is_covered(self, points: Points) -> bool:
        """Return True if much of a line lies along arrows."""
        distances = np.abs(_points_along(points)[:, None] - self.arrows)
        is_near = distances.min(axis=1, initial=math.inf) < COVERED_DISTANCE
        return bool(is_near.mean() > COVERED_SHARE)

    def text(self, at: complex, text: str, colour: str, size: float, anchor: str = "start") -> None:
        """Write a text with a white edge at its baseline; ``V_a`` has a subscript."""
        self.parts.append(
            f'<text x="{at.real:.1f}" y="{at.imag:.1f}" text-anchor="{anchor}" '
            f'font-size="{size}" fill="{colour}" stroke="#fff" stroke-width="2.5" '
            f'paint-order="stroke">{SUBSCRIPT.sub(SUBSCRIPT_ELEMENT, escape(text))}</text>'
        )

    def write_labels(self) -> None:
        """Write each label where it covers no other one and the fewest lines."""
        boxes: list[tuple[complex, complex]] = []
        for label in self.labels:
            tip, center = _place(label, boxes, self.ink, self.size)
            boxes.append((center, label.half))
            if abs(tip - label.at) > LEADER_FROM:
                self.line(np.array([label.at, tip]), label.colour, 0.6)
        for label, (center, _) in zip(self.labels, boxes, strict=True):
            base = center + 0.36j * label.size
            self.text(base, label.text, label.colour, label.size, "middle")

    def svg(self, title: str) -> str:
        """Return the drawing as one SVG element."""
        head = (
            '<svg xmlns="http://www.w3.org/2000/svg" role="img" '
            f'viewBox="0 0 {self.size.real:.0f} {self.size.imag:.0f}" '
            'font-family="DejaVu Sans, Verdana, Arial, sans-serif" stroke-linejoin="round">'
        )
        return "\n".join([head, f"<title>{escape(title)}</title>", *self.parts, "</svg>"])


def _path(points: Points) -> str:
    """Return a line through points as the path of an SVG."""
    return "M" + "L".join(f"{p.real:.1f} {p.imag:.1f}" for p in points)


def _points_along(points: Points) -> Points:
    """Return points along a line, at most a step apart."""
    return np.concatenate(
        [np.linspace(a, b, int(abs(b - a) / INK_STEP) + 2) for a, b in pairwise(points)]
    )


def _place(
    label: Label, boxes: Sequence[tuple[complex, complex]], ink: Points, paper: complex
) -> tuple[complex, complex]:
    """Return the cheapest place of a label on paper, beside boxes: nearest point, and center."""
    half = label.half + GAP
    turns = np.arange(DIRECTIONS) * math.tau / DIRECTIONS
    rays = np.exp(1j * (turns + cmath.phase(label.direction)))
    reaches = np.array(REACHES)[:, None]
    tips = label.at + reaches * rays
    sides = rays / np.maximum(np.abs(rays.real), np.abs(rays.imag))
    places = tips + half.real * sides.real + 1j * half.imag * sides.imag
    cost = reaches / REACH_UNIT + 1 - np.cos(turns)
    cost += _overlaps(places[..., None], ink, half).sum(axis=-1)
    cost += FORBIDDEN * ~_overlaps(places, paper / 2, paper / 2 - half)
    for center, box in boxes:
        cost += FORBIDDEN * _overlaps(places, center, half + box)
    best = np.argmin(cost)
    return complex(tips.flat[best]), complex(places.flat[best])


def _overlaps(centers: Points, points: Points | complex, half: complex) -> Points:
    """Return True for each point in the box around a center."""
    offsets = centers - points
    overlaps: Points = (np.abs(offsets.real) < half.real) & (np.abs(offsets.imag) < half.imag)
    return overlaps
