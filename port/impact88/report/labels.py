"""Texts beside what they name: each label goes where it covers no other and the fewest lines.

Points on paper are complex numbers, x + iy in pixels with y downwards."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from html import escape
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.complex128]

DIRECTIONS = 24  # directions tried around a point
REACHES = (3.0, 7.0, 12.0, 18.0, 26.0, 36.0, 50.0, 70.0, 95.0)  # distances tried, in px
LEADER_FROM = 15.0  # px; from this distance on a thin line leads to the point
INK_STEP = 2.0  # px between the points that stand for a line
EDGE = 2.0  # px between a text and the edge of the paper
GAP = 2.0  # px between two texts
# cost of a label's place, in units of 6 px of distance
COVERED_INK = 1.0
TURNED_AWAY = 1.0
FORBIDDEN = 1e4  # over another label, or outside the paper
SUBSCRIPT_SIZE = 0.75  # as fractions of the size of type
SUBSCRIPT_DROP = 0.25
NARROW = frozenset("il.,:;'|!() t°")
WIDE = frozenset("mwMWΩω−→")


class Label(NamedTuple):
    """A text for a point, preferably in the direction ``towards`` from it.

    ``_`` makes a subscript of the next letter."""

    at: complex
    towards: complex
    text: str
    colour: str
    size: float = 12.0
    bold: bool = False


class Box(NamedTuple):
    """A rectangle: its center and half its sides."""

    center: complex
    half_width: float
    half_height: float


def text_width(text: str, size: float, bold: bool = False) -> float:
    """Return an upper estimate of a text's width in px, for the usual sans-serif typefaces."""
    widths = [_character_width(c) for c in text.replace("_", "")]
    return size * sum(widths) * (1.1 if bold else 1.0)


def _character_width(character: str) -> float:
    """Return an upper estimate of a character's width, as a fraction of the size of type."""
    if character in NARROW:
        return 0.4
    if character in WIDE:
        return 0.95
    return 0.72 if character.isupper() else 0.64


def path_of(points: Iterable[complex]) -> str:
    """Return a line through points as the path of an SVG."""
    return "M" + "L".join(f"{p.real:.1f} {p.imag:.1f}" for p in points)


def points_along(points: Sequence[complex], step: float = INK_STEP) -> Points:
    """Return points along a line, at most a step apart."""
    pieces = [
        np.linspace(start, end, int(abs(end - start) / step) + 2) for start, end in pairwise(points)
    ]
    return np.concatenate(pieces)


def place(
    labels: Iterable[Label], ink: Points, width: float, height: float
) -> list[tuple[Label, Box]]:
    """Return each label with its place.

    Parameters
    ----------
    labels : iterable of Label
        The first one has the first choice.
    ink : ndarray of complex
        Points of all lines.
    width, height : float
        Size of the paper, in px.
    """
    places: list[tuple[Label, Box]] = []
    for label in labels:
        boxes = [box for _, box in places]
        places.append((label, _best_place(label, boxes, ink, width, height)))
    return places


def _best_place(
    label: Label, boxes: Sequence[Box], ink: Points, width: float, height: float
) -> Box:
    """Return the cheapest place of a label among `REACHES` times `DIRECTIONS`."""
    half_width = text_width(label.text, label.size, label.bold) / 2
    half_height = 0.55 * label.size
    turns = np.arange(DIRECTIONS) * math.tau / DIRECTIONS
    toward = math.atan2(label.towards.imag, label.towards.real)
    rays = np.exp(1j * (turns + toward))
    # from the point to the center of a box whose edge is ``reach`` away
    support = np.minimum(
        half_width / np.maximum(np.abs(rays.real), 1e-9),
        half_height / np.maximum(np.abs(rays.imag), 1e-9),
    )
    reaches = np.array(REACHES)[:, None]
    centers = (label.at + (reaches + support) * rays).ravel()
    cost = (reaches / 6 + TURNED_AWAY * (1 - np.cos(turns))).ravel()
    cost += COVERED_INK * _overlap(centers, ink, half_width + 1, half_height + 1).sum(axis=1)
    from_middle = centers - complex(width, height) / 2
    cost += FORBIDDEN * (np.abs(from_middle.real) > width / 2 - EDGE - half_width)
    cost += FORBIDDEN * (np.abs(from_middle.imag) > height / 2 - EDGE - half_height)
    for box in boxes:
        spread = half_width + box.half_width + GAP, half_height + box.half_height + GAP
        cost += FORBIDDEN * _overlap(centers, np.array([box.center]), *spread)[:, 0]
    return Box(complex(centers[np.argmin(cost)]), half_width, half_height)


def _overlap(centers: Points, points: Points, width: float, height: float) -> NDArray[np.bool_]:
    """Return for each center and point whether the point is within a width and height of it."""
    across = np.abs(centers.real[:, None] - points.real) < width
    return across & (np.abs(centers.imag[:, None] - points.imag) < height)


def leader(label: Label, box: Box) -> tuple[complex, complex] | None:
    """Return the line from a label's point to its text; None for a text near its point."""
    offset = label.at - box.center
    edge = box.center + complex(
        min(max(offset.real, -box.half_width), box.half_width),
        min(max(offset.imag, -box.half_height), box.half_height),
    )
    return (label.at, edge) if abs(label.at - edge) > LEADER_FROM else None


def text_element(
    at: complex, text: str, colour: str, size: float, bold: bool = False, anchor: str = "middle"
) -> str:
    """Return a text as SVG, at its baseline, with a white edge.

    Presentation attributes alone are used, for a web page that allows no styles in the page."""
    runs, drop = [], 0.0
    for piece in re.findall(r"_\w|[^_]+|_", text):
        is_subscript = len(piece) == 2 and piece[0] == "_"
        level = SUBSCRIPT_DROP * size if is_subscript else 0.0
        look = f' font-size="{SUBSCRIPT_SIZE * size:g}"' if is_subscript else ""
        shift = f' dy="{level - drop:g}"' if level != drop else ""
        runs.append(f"<tspan{shift}{look}>{escape(piece[is_subscript:])}</tspan>")
        drop = level
    weight = ' font-weight="bold"' if bold else ""
    return (
        f'<text x="{at.real:.1f}" y="{at.imag:.1f}" text-anchor="{anchor}" font-size="{size:g}"'
        f'{weight} fill="{colour}" stroke="#fff" stroke-width="2.5" stroke-linejoin="round" '
        f'paint-order="stroke">{"".join(runs)}</text>'
    )
