"""Ordinary and odd scenes for drawings and reports, and the texts of an SVG with their places."""

from __future__ import annotations

import re
from html import unescape
from typing import NamedTuple

from impact88.cases import Case

CHARACTER = 0.64  # of the size of type: an upper estimate of the mean width
ANCHORS = {"start": 0.0, "middle": 0.5, "end": 1.0}

SIDE = {
    "units": "us",
    "MA": "3091",
    "MB": "4669",
    "IA": "estimate",
    "IB": "estimate",
    "DA": "4.5",
    "PA": "0",
    "DB": "4",
    "PB": "-40",
    "GA": "0",
    "TA": "0",
    "TB": "90",
    "UX": "-25",
    "UY": "0",
    "WA": "0",
    "VX": "0",
    "VY": "40",
    "WB": "0",
    "E": "0.2",
    "MU": "0.5",
    "EM": "1",
}
"""A strikes the side of B."""
_METRIC = {"units": "metric", "MA": "1400", "MB": "1800", "DA": "1.4", "DB": "1.2"}
_HEAD_ON = {"UX": "-30", "VX": "35", "VY": "0", "TB": "0", "PB": "0", "DB": "7"}
SCENES = {
    "side": {},
    "rear end of points": {"M": "4", "UX": "-30", "VX": "-10", "VY": "0", "MU": "0", "TB": "180"},
    "head-on": _HEAD_ON,
    "offset": _HEAD_ON | {"PB": "15", "PA": "15", "WA": "1", "WB": "-2"},
    "motorcycle": {"MA": "500", "IA": "30", "DA": "3.5", "PB": "-60", "UX": "-40", "VY": "10"},
    "truck": {"MB": "60000", "IB": "400000", "DB": "20", "PB": "-10", "UX": "-50", "VY": "20"},
    "metric": _METRIC | {"UX": "-50", "VY": "60"},
    "sae": _METRIC | {"axes": "sae", "UX": "-50", "VY": "60", "WB": "1"},
    "compass": {"headings": "compass", "TA": "270", "TB": "0"},
    "sae compass": {"headings": "compass", "axes": "sae", "TA": "270", "TB": "0", "GA": "90"}
    | {"UX": "0", "UY": "-25", "VX": "40", "VY": "0"},
    "barrier": {"MB": "1e12", "IB": "1e12", "VY": "0", "PB": "0", "TB": "0", "UY": "8"},
    "points": {"M": "4", "UX": "-25", "UY": "10", "VX": "10", "VY": "30", "GA": "30", "MU": ".3"},
    "no units": {"units": "", "MA": "94", "MB": "144", "IA": "1490", "IB": "2940"},
    "oblique": {"GA": "35", "TA": "20", "TB": "110", "PA": "25", "PB": "-50", "UX": "-35"}
    | {"UY": "-12", "VX": "8", "VY": "30", "WA": "-1.5", "WB": ".7", "MU": "locked"},
    "sideswipe": {"GA": "88", "TB": "0", "PA": "30", "PB": "20", "DA": "6", "DB": "6"}
    | {"UX": "-50", "UY": "2", "VX": "45", "VY": "0", "E": ".1", "MU": ".3"},
    "standing": _HEAD_ON | {"UX": "0", "VX": "50", "PA": "180", "TA": "180", "E": ".3"},
    "no arms": {"DA": "0", "DB": "0"},
    "long arm": {"DA": "60"},
    "child": {"MB": "160", "IB": "4", "DB": ".5", "UX": "-30", "VY": "4"},
    "nearly equal velocities": _HEAD_ON | {"VX": "-29.9", "TB": "180"},
}
"""Scenes by name, as changes of `SIDE`."""


def case_of(name: str = "side", **changes: str) -> Case:
    """Return the case of a scene."""
    return Case.of(SIDE | SCENES[name] | changes)


class Placed(NamedTuple):
    """A text of an SVG and its box, in px."""

    text: str
    left: float
    top: float
    right: float
    bottom: float

    def overlaps(self, other: Placed) -> bool:
        """Return True if two boxes have a point in common."""
        beside = self.right <= other.left or other.right <= self.left
        return not beside and self.top < other.bottom and other.top < self.bottom

    def is_within(self, other: Placed) -> bool:
        """Return True if a box is within another."""
        is_beside = self.left < other.left or other.right < self.right
        return not (is_beside or self.top < other.top or other.bottom < self.bottom)


def texts_of(svg: str) -> list[Placed]:
    """Return the texts of a drawing."""
    pattern = r'<text x="(\S+)" y="(\S+)" font-size="(\S+)" text-anchor="(\w+)"[^>]*>(.*?)</text>'
    placed = []
    for x, y, size, anchor, content in re.findall(pattern, svg):
        text, height = unescape(content), float(size)
        width = height * (0.15 + CHARACTER * len(text))
        left, top = float(x) - ANCHORS[anchor] * width, float(y) - 0.78 * height
        placed.append(Placed(text, left, top, left + width, top + height))
    return placed
