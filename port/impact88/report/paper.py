"""A sheet of paper: lines, and texts that cover nothing, as an SVG picture.

Points on paper are complex numbers, x + iy in pixels with y downwards. Presentation attributes
alone are used, for a web page that allows no styles in the page."""

from __future__ import annotations

import cmath
import math
import re
from html import escape
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

Points = NDArray[Any]  # complex

COLOURS = {"A": "#0068a3", "B": "#bd4f00", "P": "#99356f", "": "#000000"}
"""Okabe and Ito's blue, vermilion and purple, darkened for thin lines and small texts; black."""
LINE_POINTS = 200  # points that represent a line
CHARACTER_WIDTH = 0.64  # of the size of type: an upper estimate of the mean in DejaVu Sans
SINGLE_EXTRA = 0.15  # of the size of type: a single letter may be so much wider
REACHES = (3.0, 8.0, 14.0, 22.0, 32.0, 45.0, 60.0, 80.0, 100.0)  # px from a text to its point
TURNS = np.radians([0, 30, -30, 60, -60, 90, -90, 120, -120, 150, -150, 180])
"""Places of a text around its point, from the direction it should have."""
GAP = 3.0  # px around a label
TEXT_COST = 1000.0  # points of lines that are as bad to cover as a point of another text
BORDER = 8 + 8j  # px around everything
SUBSCRIPT = re.compile(r"^(Δ?\w)_(\w)(.*)")
SUBSCRIPT_ELEMENT = r'\1<tspan dy=".33em" font-size="75%">\2</tspan><tspan dy="-.25em">\3</tspan>'
HEAD = (
    '<marker id="tip{}" viewBox="0 -4 10 8" refX="8" markerWidth="12" markerHeight="9.6" '
    'markerUnits="userSpaceOnUse" orient="auto"><path d="M0-4L10 0L0 4Z" fill="{}"/></marker>'
)
"""Head of the arrows of a colour."""


def text_size(text: str, size: float) -> complex:
    """Return an upper estimate of a text's width, and i times its height, in px."""
    width = SINGLE_EXTRA + CHARACTER_WIDTH * len(text.replace("_", ""))
    return size * complex(width, 1.1)


def arc(radius: float, start: float = 0.0, stop: float = math.tau) -> Points:
    """Return points of a circle around 0 from one angle in radians to another."""
    points: Points = radius * np.exp(1j * np.linspace(start, stop, 37))
    return points


class Paper:
    """A drawing: parts of its SVG; points that they cover, and what covering one costs."""

    def __init__(self) -> None:
        self.parts: list[str] = []
        self.ink = np.zeros(0, complex)
        self.costs = np.zeros(0)

    def _add(self, part: str, points: Points, cost: float) -> None:
        """Add a part and the points that it covers."""
        self.parts.append(part)
        self.ink = np.append(self.ink, points)
        self.costs = np.append(self.costs, np.full(points.shape, cost))

    def line(
        self,
        points: Points,
        key: str = "",
        width: float = 1.2,
        dashes: str = "none",
        opacity: float = 0.0,
        head: str = "",
    ) -> None:
        """Draw a line in the colour of a key, filled with an opacity, with the head of an arrow."""
        path = "L".join(f"{point.real:.1f} {point.imag:.1f}" for point in points)
        part = (
            f'<path d="M{path}" fill="{COLOURS[key]}" fill-opacity="{opacity}" '
            f'stroke="{COLOURS[key]}" stroke-width="{width}" stroke-dasharray="{dashes}" '
            f'marker-end="{head}"/>'
        )
        numbers = np.arange(len(points))
        self._add(part, np.interp(np.linspace(0, numbers[-1], LINE_POINTS), numbers, points), 1.0)

    def text(self, at: complex, text: str, key: str = "", size: float = 10.0) -> None:
        """Write a text with a white edge; ``at`` is the middle of its left, ``V_a`` a subscript."""
        part = (
            f'<text x="{at.real:.1f}" y="{at.imag + 0.36 * size:.1f}" font-size="{size}" '
            f'fill="{COLOURS[key]}" stroke="#fff" stroke-width="2.5" paint-order="stroke">'
            f"{SUBSCRIPT.sub(SUBSCRIPT_ELEMENT, escape(text))}</text>"
        )
        box = text_size(text, size)
        rows = np.arange(-box.imag / 2, box.imag / 2)[:, None]
        self._add(part, at + np.arange(box.real + 1) + 1j * rows, TEXT_COST)

    def label(self, at: complex, ahead: complex, text: str, key: str, size: float = 12.0) -> None:
        """Write a text beside a point, where it covers nothing, else where it covers least."""
        half = text_size(text, size) / 2

        def cost(center: complex) -> float:
            gaps = self.ink - center
            is_near = (abs(gaps.real) < half.real + GAP) & (abs(gaps.imag) < half.imag + GAP)
            return float(self.costs[is_near].sum())

        rays = np.exp(1j * (cmath.phase(ahead) + TURNS))
        places = [
            at + complex((half.real + reach) * ray.real, (half.imag + reach) * ray.imag)
            for reach, ray in product(REACHES, rays)
        ]
        center = min(places, key=cost)  # the first of the best
        self.text(center - half.real, text, key, size)

    def corners(self) -> tuple[complex, complex]:
        """Return the upper left and the lower right corner of what is drawn."""
        x, y = self.ink.real, self.ink.imag
        return complex(x.min(), y.min()) - BORDER, complex(x.max(), y.max()) + BORDER

    def svg(self, title: str) -> str:
        """Return the drawing as one SVG element."""
        low, high = self.corners()
        size = high - low
        return "\n".join(
            [
                '<svg xmlns="http://www.w3.org/2000/svg" role="img" viewBox="'
                f'{low.real:.0f} {low.imag:.0f} {size.real:.0f} {size.imag:.0f}" '
                'font-family="DejaVu Sans, Verdana, Arial, sans-serif" stroke-linejoin="round">',
                f"<title>{escape(title)}</title>",
                *(HEAD.format(key, colour) for key, colour in COLOURS.items()),
                *self.parts,
                "</svg>",
            ]
        )
