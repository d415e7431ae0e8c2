"""Ink on paper: what is darker than its surroundings, and how its rows and columns run.

The paper's brightness, the threshold between two shades, the skew of lines and the holes of
continuous paper are found here, once for all that ask. The geometry works on points (places of
inked pixels), so it does not depend on the resolution.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
import PIL.Image
from numpy.typing import NDArray
from scipy import ndimage

Floats = NDArray[np.float64]
Image = NDArray[np.float32]
Mask = NDArray[np.bool_]
Slope = tuple[float, float]

_BLOCK = 24
"""Pixels a side of the blocks whose brightness is the paper's; larger than any stroke."""
_MAX_TALL = 2.2  # pitches; connected ink of type is 1.7 tall at most
_MAX_WIDE = 15.0  # pitches; bad copies join the letters of a word
_MAX_POINTS = 150_000
"""Points of a page, drawn at random from more to save time: a page at 300 dots an inch has some
400,000."""
MIN_SIDE = 100
"""Pixels of the shorter side of a picture that is read: those of 13 lines of 5 pixels."""
FEWEST_POINTS = 500  # a page has more ink
STEEP = 0.08
"""Slope of lines from which a page is set straight: the grid's own search ends at 0.1."""
_MAX_SLOPE = 0.25  # of lines
_SHARPER = 1.3  # smallest ratio of the sharpness along a steep slope to the best along a level one
_MAX_SKEW_POINTS = 20_000  # points on which slopes are tried
_ROWS = 600  # rows of ink, across the page's longer side, on which they are tried
_COARSE_ROWS = 150  # the same, on which the lines' direction is found
# Holes of continuous paper: half an inch apart, a fifth of an inch wide or less.
_MIN_HOLE = 0.008  # width, as a fraction of the sheet's
_MAX_HOLE = 0.06  # the same
_SOLID = 0.65  # smallest dark fraction of the square around a hole: a disc has .79, a ring less
_MIN_HOLES = 4  # below one another
_UNEVEN = 0.3  # largest deviation of their distances from the usual, as a fraction of it


def resize(picture: Image, scale: float) -> Image:
    """Return a picture enlarged or reduced by ``scale``."""
    size = [max(1, round(length * scale)) for length in picture.shape[::-1]]
    small = PIL.Image.fromarray(picture).resize((size[0], size[1]), PIL.Image.Resampling.BILINEAR)
    return np.asarray(small, np.float32)


def paper_brightness(channel: Image) -> Image:
    """Return the brightness of the paper under the ink of a picture, or of one of its colours.

    It is the 85th percentile of blocks, closed over blocks full of ink.
    """
    height, width = channel.shape
    padded = np.pad(channel, ((0, -height % _BLOCK), (0, -width % _BLOCK)), "edge")
    rows, columns = padded.shape[0] // _BLOCK, padded.shape[1] // _BLOCK
    blocks = padded.reshape(rows, _BLOCK, columns, _BLOCK).transpose(0, 2, 1, 3)
    light = np.percentile(blocks.reshape(rows, columns, -1), 85, axis=2)
    light = ndimage.grey_closing(light, size=(3, 3), mode="nearest")
    light = ndimage.gaussian_filter(light, 1.0, mode="nearest").astype(np.float32)
    return resize(light, _BLOCK)[:height, :width]


def darkness(channel: Image, paper: Image) -> Image:
    """Return how much darker than the paper a picture is, 0 to 1."""
    return np.asarray(np.clip(1 - channel / np.maximum(paper, 1), 0, 1), np.float32)


def threshold(values: Image) -> float:
    """Return the level with the largest variance between what is below and above (Otsu 1979)."""
    counts, edges = np.histogram(values, 64)
    below, total = np.cumsum(counts), np.cumsum(counts * (edges[:-1] + edges[1:]) / 2)
    with np.errstate(all="ignore"):
        between = (total / below - total[-1] / below[-1]) ** 2 * below / (below[-1] - below)
    return float(edges[int(np.argmax(np.nan_to_num(between[:-1]))) + 1])


def ink_of(grey: Image) -> Image:
    """Return the ink of a picture, from 0 (paper) to about 1 (full ink).

    Ink is the darkness relative to the paper around, divided by the mean darkness above the
    threshold between grain and ink. ``grey``: 0 (black) to 255.
    """
    ink = darkness(grey, paper_brightness(grey))
    sample = ink[::3, ::3]
    sample = sample[sample > 0.08]
    if sample.size < 50:
        return ink
    level = float(np.mean(sample[sample >= threshold(sample)]))
    return np.asarray(np.clip(ink / max(level, 0.1), 0, 1.5), np.float32)


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

    def some(self, count: int) -> "Points":
        """Return every n-th of the places, so that they are about ``count`` at most."""
        part = slice(None, None, max(1, len(self.x) // count))
        return Points(self.x[part], self.y[part], self.span)


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


def _sharpest(points: Points, tilts: Iterable[Slope], width: float) -> tuple[float, Slope]:
    """Return the largest sharpness of lines of text, and the slope and keystone that have it.

    y - x (slope + keystone y / span) is constant along each line. The sharpness is the sum of
    squared differences between the ink of successive rows of ``width`` pixels along the lines:
    lines of text alternate with gaps.
    """
    x, y, span = points

    def sharpness(tilt: Slope) -> float:
        level = y - x * (tilt[0] + tilt[1] * y / span)
        counts = np.bincount(((level - level.min()) / width).astype(int)).astype(float)
        return float(np.sum(np.diff(counts) ** 2))

    return max((sharpness(tilt), tilt) for tilt in tilts)


def line_slope(points: Points) -> float:
    """Return the slope of lines of text that run across.

    A slope of `STEEP` and more counts from `_SHARPER` times the sharpness of the best that is less.
    """
    points = points.some(_MAX_SKEW_POINTS)
    width = points.span / _ROWS
    lattice = np.arange(-_MAX_SLOPE, _MAX_SLOPE + 1e-9, 0.004)
    level, steep = (
        _sharpest(points, [(float(slope), 0.0) for slope in lattice[part]], width)
        for part in (np.abs(lattice) < STEEP, np.abs(lattice) >= STEEP)
    )
    _, (slope, _) = steep if steep[0] > _SHARPER * level[0] else level
    return slope


def skew(points: Points) -> tuple[float, bool]:
    """Return the slope of a page's lines, and True if they run down the page, which lies on its
    side."""
    turned = points.turn(1)
    across, down = line_slope(points), line_slope(turned)
    is_on_side = _contrast(turned, down) > _contrast(points, across)
    return (down if is_on_side else across), is_on_side


def _contrast(points: Points, slope: float) -> float:
    """Return how much the ink of rows along a slope differs from that of the next, relative to the
    mean of all.

    Rows are as wide as half a character, in which gaps between columns of type vanish; what has
    more ink than 95 in 100 of them is an edge of the paper and counts as those do.
    """
    x, y, span = points.some(_MAX_SKEW_POINTS)
    level = y - slope * x
    counts = np.bincount(((level - level.min()) / (span / _COARSE_ROWS)).astype(int))
    steps = np.diff(np.minimum(counts, np.percentile(counts, 95)))
    return float(np.mean(steps.astype(float) ** 2) / np.mean(counts) ** 2)


def slopes(points: Points) -> Slope:
    """Return the slope and keystone of lines of text that run across, found on finer lattices.

    They begin at `line_slope`: one as fine over all slopes and keystones has a thousand times as
    many places.
    """
    step = max(1.0, points.span / 1200)
    slope = line_slope(points)
    points = points.some(_MAX_SKEW_POINTS)
    keystones = product(np.arange(-0.12, 0.1201, 0.02), (-0.002, 0, 0.002))
    tilts: list[Slope] = [(slope + turn, float(keystone)) for keystone, turn in keystones]
    slope, key = _sharpest(points, tilts, 1.5 * step)[1]
    for width in (0.002, 0.001, 0.0005):
        steps = product((-1, 0, 1), (-8, -4, 0, 4, 8))
        slope, key = _sharpest(
            points, [(slope + i * width, key + j * width) for i, j in steps], step
        )[1]
    return slope, key


class Spot(NamedTuple):
    """A connected region of ink.

    Attributes
    ----------
    x, y : float
        Its middle.
    width, height : float
        Sides of the rectangle around it.
    filling : float
        Inked fraction of that rectangle.
    """

    x: float
    y: float
    width: float
    height: float
    filling: float


def hole_columns(spots: Sequence[Spot], sheet_width: float) -> Iterator[list[Spot]]:
    """Yield the columns of holes among the regions of a sheet, `_MIN_HOLES` or more in each.

    Holes are solid, round, of one size, one below the other, and evenly spaced.
    """
    left = [
        spot
        for spot in spots
        if 0.7 < spot.width / spot.height < 1.4
        and _MIN_HOLE < spot.width / sheet_width < _MAX_HOLE
        and spot.filling > _SOLID
    ]
    while left:
        first = left[0]
        alike = [spot for spot in left if abs(spot.x - first.x) < first.width]
        size = float(np.median([spot.width for spot in alike]))
        middle = float(np.median([spot.x for spot in alike]))
        left = [spot for spot in left if abs(spot.x - first.x) >= first.width]
        column = [
            spot
            for spot in alike
            if abs(spot.width - size) < 0.3 * size and abs(spot.x - middle) < size
        ]
        if len(column) < _MIN_HOLES:
            continue
        gaps = np.diff(sorted(spot.y for spot in column))
        if gaps.max() < (1 + _UNEVEN) * float(np.median(gaps)):
            yield column
