"""Ink on paper: what is darker than its surroundings, and how its rows and columns run.

The geometry works on points (places of inked pixels), so it does not depend on the resolution.
"""

from collections.abc import Iterable
from itertools import product
from typing import NamedTuple

import numpy as np
import PIL.Image
from numpy.typing import NDArray
from scipy import ndimage

Floats = NDArray[np.float64]
Image = NDArray[np.float32]
Slope = tuple[float, float]

_BLOCK = 24
"""Pixels a side of the blocks whose brightness is the paper's; larger than any stroke."""
_MAX_TALL = 2.2  # pitches; connected ink of type is 1.7 tall at most
_MAX_WIDE = 15.0  # pitches; bad copies join the letters of a word
_MAX_POINTS = 150_000
"""Points of a page, drawn at random from more to save time: a page at 300 dots an inch has some
400,000."""


def resize(picture: Image, scale: float) -> Image:
    """Return a picture enlarged or reduced by ``scale``."""
    size = [max(1, round(length * scale)) for length in picture.shape[::-1]]
    small = PIL.Image.fromarray(picture).resize((size[0], size[1]), PIL.Image.Resampling.BILINEAR)
    return np.asarray(small, np.float32)


def ink_of(grey: Image) -> Image:
    """Return the ink of a picture, from 0 (paper) to about 1 (full ink).

    Ink is the darkness relative to the paper around, divided by the mean darkness above Otsu's
    threshold. ``grey``: 0 (black) to 255.
    """
    height, width = grey.shape
    padded = np.pad(grey, ((0, -height % _BLOCK), (0, -width % _BLOCK)), "edge")
    rows, columns = padded.shape[0] // _BLOCK, padded.shape[1] // _BLOCK
    blocks = padded.reshape(rows, _BLOCK, columns, _BLOCK).transpose(0, 2, 1, 3)
    light = np.percentile(blocks.reshape(rows, columns, -1), 85, axis=2)
    light = ndimage.grey_closing(light, size=(3, 3), mode="nearest")
    light = ndimage.gaussian_filter(light, 1.0, mode="nearest").astype(np.float32)
    paper = resize(light, _BLOCK)[:height, :width]
    ink: Image = np.clip(1 - grey / np.maximum(paper, 1), 0, 1).astype(np.float32)
    sample = ink[::3, ::3]
    sample = sample[sample > 0.08]
    if sample.size < 50:
        return ink
    # the threshold with the largest variance between grain and ink (Otsu 1979)
    counts, edges = np.histogram(sample, 64)
    below, total = np.cumsum(counts), np.cumsum(counts * (edges[:-1] + edges[1:]) / 2)
    with np.errstate(all="ignore"):
        between = (total / below - total[-1] / below[-1]) ** 2 * below / (below[-1] - below)
    best = int(np.argmax(np.nan_to_num(between[:-1])))
    level = float(np.mean(sample[sample >= (edges[best] + edges[best + 1]) / 2]))
    ink = np.clip(ink / max(level, 0.1), 0, 1.5)
    return ink


class Points(NamedTuple):
    """Places of inked pixels, x to the right and y down, in pixels from the picture's middle."""

    x: Floats
    y: Floats
    span: float

    def turn(self, turns: int) -> "Points":
        """Return the places after the picture was turned to the left by quarters."""
        x, y = self.x, self.y
        x, y = ((x, y), (y, -x), (-x, -y), (-y, x))[turns]
        return Points(x, y, self.span)


def points_of(ink: Image, fold: int = 1) -> Points:
    """Return the inked places of a picture without single specks.

    ``fold``: pixels a side that are averaged first, which removes the grain of bad paper.
    """
    height, width = ink.shape[0] // fold * fold, ink.shape[1] // fold * fold
    blocks = ink[:height, :width].reshape(height // fold, fold, width // fold, fold)
    coarse = blocks.mean(axis=(1, 3))
    around = ndimage.uniform_filter(coarse, 3)
    y, x = np.nonzero((coarse > 0.4) & (around > 0.2))
    # a fixed stride would fall into step with the rows, whole pixels with the pitch
    random = np.random.default_rng(1988)
    if len(x) > _MAX_POINTS:
        chosen = random.choice(len(x), _MAX_POINTS, replace=False)
        y, x = y[chosen], x[chosen]
    across, down = np.array([x, y]) + random.random((2, len(x)), np.float32)
    height, width = ink.shape
    return Points(fold * across - width / 2, fold * down - height / 2, float(max(ink.shape)))


def without_pen(ink: Image, pitch: float, turns: int) -> Image:
    """Return ink without connected parts taller than a line or wider than a word.

    These are strokes, rings and ruled lines. ``pitch``: width of a character in pixels; ``turns``:
    quarters by which the lines are turned.
    """
    labels, _ = ndimage.label(ink > 0.4, np.ones((3, 3)))
    plain = ink.copy()
    for number, box in enumerate(ndimage.find_objects(labels), 1):
        tall, wide = (part.stop - part.start for part in (box if turns % 2 == 0 else box[::-1]))
        if tall > _MAX_TALL * pitch or wide > _MAX_WIDE * pitch:
            window = tuple(slice(max(part.start - 2, 0), part.stop + 2) for part in box)
            is_near = ndimage.binary_dilation(labels[window] == number, iterations=2)
            plain[window][is_near] = 0
    return plain


def slopes(points: Points) -> Slope:
    """Return the slope and keystone of lines of text.

    y - x (slope + keystone y / span) is constant along each line. The two maximize the sharpness,
    which is the sum of squared differences between successive rows' ink: lines of text alternate
    with gaps. They are found on lattices that get finer.
    """
    x, y, span = points
    step = max(1.0, span / 1200)
    if len(x) > 40_000:
        x, y = x[:: len(x) // 20_000], y[:: len(y) // 20_000]

    def sharpest(tilts: Iterable[Slope], part: int, width: float) -> Slope:
        """Return the slope and keystone with the largest sharpness, at rows of ``width`` pixels."""

        def sharpness(tilt: Slope) -> float:
            level = (y - x * (tilt[0] + tilt[1] * y / span))[::part]
            counts = np.bincount(((level - level.min()) / width).astype(int)).astype(float)
            return float(np.sum(np.diff(counts) ** 2))

        return max(tilts, key=sharpness)

    stride = max(1, len(x) // 15_000)
    slope, key = sharpest(
        ((rise, 0.0) for rise in np.arange(-0.1, 0.1001, 0.004)), stride, 2 * step
    )
    keystones = product(np.arange(-0.12, 0.1201, 0.02), (-0.002, 0, 0.002))
    slope, key = sharpest(
        ((slope + turn, keystone) for keystone, turn in keystones), stride, 1.5 * step
    )
    for width in (0.002, 0.001, 0.0005):
        steps = product((-1, 0, 1), (-8, -4, 0, 4, 8))
        slope, key = sharpest([(slope + i * width, key + j * width) for i, j in steps], 1, step)
    return float(slope), float(key)
