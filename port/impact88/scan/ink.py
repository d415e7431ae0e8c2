"""Ink on paper: what is darker than its surroundings, and how its rows and columns run.

The geometry works on points (places of inked pixels), so it does not depend on the resolution.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

Floats = NDArray[np.float64]
Image = NDArray[np.float32]

_BLOCK = 24
"""Pixels a side of the blocks whose brightness is the paper's; larger than any stroke."""
_MOST_POINTS = 150_000
"""Chosen at random of more, for time: a page at 300 dots an inch has some 400,000."""


def ink_of(grey: Image) -> Image:
    """Ink from 0 (paper) to about 1 (full ink) of a grey picture of 0 (black) to 255."""
    height, width = grey.shape
    rows, columns = max(1, height // _BLOCK), max(1, width // _BLOCK)
    cut = grey[: rows * _BLOCK, : columns * _BLOCK]
    if cut.size == 0 or height < 2 * _BLOCK or width < 2 * _BLOCK:
        paper = np.full_like(grey, max(float(grey.max(initial=1)), 1.0))
    else:
        blocks = cut.reshape(rows, _BLOCK, columns, _BLOCK).transpose(0, 2, 1, 3)
        light = np.percentile(blocks.reshape(rows, columns, -1), 85, axis=2)
        light = ndimage.grey_closing(light, size=(3, 3), mode="nearest")
        light = ndimage.gaussian_filter(light, 1.0, mode="nearest")
        at_rows = np.clip((np.arange(height) + 0.5) / _BLOCK - 0.5, 0, rows - 1)
        at_columns = np.clip((np.arange(width) + 0.5) / _BLOCK - 0.5, 0, columns - 1)
        paper = _stretched(_stretched(light, at_rows).T, at_columns).T.astype(np.float32)
    ink = np.clip(1 - grey / np.maximum(paper, 1), 0, 1).astype(np.float32)
    inked = ink[::3, ::3]
    inked = inked[inked > 0.08]
    if inked.size < 50:
        return ink
    level = float(np.mean(inked[inked >= _otsu(inked)]))
    full: Image = np.clip(ink / max(level, 0.1), 0, 1.5).astype(np.float32)
    return full


def _stretched(values: Floats, at: Floats) -> Floats:
    """Rows of ``values`` at fractional places."""
    low = np.floor(at).astype(int)
    high = np.minimum(low + 1, len(values) - 1)
    part = (at - low)[:, None]
    stretched: Floats = values[low] * (1 - part) + values[high] * part
    return stretched


def _otsu(values: Image) -> float:
    """The threshold that parts values into two classes best (Otsu 1979)."""
    counts, edges = np.histogram(values, 64)
    middle = (edges[:-1] + edges[1:]) / 2
    below = np.cumsum(counts)
    total = np.cumsum(counts * middle)
    above = below[-1] - below
    with np.errstate(all="ignore"):
        between = below * above * (total / below - (total[-1] - total) / above) ** 2
    return float(middle[int(np.argmax(np.nan_to_num(between)))])


@dataclass
class Points:
    """Places of inked pixels, x to the right and y down, in pixels from the picture's middle."""

    x: Floats
    y: Floats
    span: float

    @property
    def few(self) -> bool:
        """Whether there is too little ink for a page."""
        return len(self.x) < 500


def points_of(ink: Image, fold: int = 1) -> Points:
    """The inked places of a picture, single specks left out; ``fold`` pixels a side are taken
    together, in which the grain of bad paper is lost."""
    height, width = ink.shape[0] // fold * fold, ink.shape[1] // fold * fold
    blocks = ink[:height, :width].reshape(height // fold, fold, width // fold, fold)
    coarse = blocks.mean(axis=(1, 3))
    near = ndimage.uniform_filter(coarse, 3)
    y, x = np.nonzero((coarse > 0.4) & (near > 0.2))
    # a fixed stride would fall into step with the rows, whole pixels with the pitch
    random = np.random.default_rng(1988)
    if len(x) > _MOST_POINTS:
        chosen = random.choice(len(x), _MOST_POINTS, replace=False)
        y, x = y[chosen], x[chosen]
    across, down = np.array([x, y]) + random.random((2, len(x)), np.float32)
    height, width = ink.shape
    return Points(fold * across - width / 2, fold * down - height / 2, float(max(ink.shape)))


def sharpness(values: Floats, step: float) -> float:
    """How sharply a projection is divided into lines and gaps."""
    counts = np.bincount(((values - values.min()) / step).astype(int)).astype(float)
    return float(np.sum(np.diff(counts) ** 2))


def slopes(points: Points) -> tuple[float, float]:
    """How lines of text run: y - x (slope + keystone y / span) is constant along each."""
    x, y, span = points.x, points.y, points.span
    step = max(1.0, span / 1200)
    if len(x) > 40_000:
        x, y = x[:: len(x) // 20_000], y[:: len(y) // 20_000]
    coarse = np.arange(-0.10, 0.1001, 0.004)
    few = slice(None, None, max(1, len(x) // 15_000))
    best = (max(coarse, key=lambda slope: sharpness((y - x * slope)[few], 2 * step)), 0.0)
    keystones = np.arange(-0.12, 0.1201, 0.02)
    best = max(
        ((best[0] + turn, key) for key in keystones for turn in (-0.002, 0, 0.002)),
        key=lambda one: sharpness((y - x * (one[0] + one[1] * y / span))[few], 1.5 * step),
    )
    for width in (0.002, 0.001, 0.0005):
        steps = product((-1, 0, 1), (-2, -1, 0, 1, 2))
        around = [(best[0] + i * width, best[1] + j * width * 4) for i, j in steps]
        best = max(around, key=lambda one: sharpness(y - x * (one[0] + one[1] * y / span), step))
    return float(best[0]), float(best[1])
