"""The grid of a typed page: its lines, its pitch, and the cells that one character each stands in.

Fixed pitch is all that is assumed, no font. A line's ink has a gap between any two cells, so its
Fourier component at the pitch is strong; the phase of that component says where the cells begin.
Smooth polynomials carry both over the page, which takes in turned, keystoned and bent paper.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from .ink import Floats, Image, Points, points_of, slopes

CELL_WIDTH = 16
"""Pixels across a cell after sampling: the least at which 3 and 8 of a dot matrix stay apart."""
SLACK = 2
"""Pixels of picture kept on each side of a cell, for the shifts that are tried."""
_LEAST_HEIGHT = 5


@dataclass
class Grid:
    """Cells of a page. ``pictures``: for each line the ink sampled so that cell k begins at pixel
    SLACK + k CELL_WIDTH, with SLACK rows above and below; ``tops``: each line's place down the page
    in units of the pitch; ``corners``: for each line the cells' corners in the picture, shape
    (cells + 1, 2, 2): left edge k, top or bottom, x and y."""

    pictures: list[Image]
    tops: Floats
    corners: list[Floats]
    pitch: float
    clarity: float

    def cells(self, line: int) -> Image:
        """The cells of a line with their slack, shape (cells, height, width)."""
        picture = self.pictures[line]
        count = (picture.shape[1] - 2 * SLACK) // CELL_WIDTH
        width = CELL_WIDTH + 2 * SLACK
        starts = range(0, count * CELL_WIDTH, CELL_WIDTH)
        return np.stack([picture[:, start : start + width] for start in starts])

    def odds(self) -> list[Floats]:
        """The log odds that each cell of each line is inked, within 6 of even."""
        return [self._odds(self.cells(line)) for line in range(len(self.pictures))]

    @staticmethod
    def _odds(cells: Image) -> Floats:
        strokes = ndimage.uniform_filter(cells, (1, 3, 3))
        edge = SLACK + 1
        darkest = strokes[:, edge:-edge, edge + 1 : -edge - 1].max(axis=(1, 2)).astype(float)
        odds: Floats = np.clip(14 * (darkest - 0.35), -6, 6)
        return odds


def _lines(points: Points, level: Floats) -> list[tuple[float, float]]:
    """Top and bottom of each line of text along ``level``, the height that is constant on it.

    A row belongs to a line where some stretch of it holds ink as densely as type does: a line of
    five asterisks counts as much as one of eighty letters."""
    low = level.min()
    rows = (level - low).astype(int)
    stretch = max(8.0, points.span / 40)
    columns = ((points.x - points.x.min()) / stretch).astype(int)
    counts = np.zeros((rows.max() + 1, columns.max() + 2))
    np.add.at(counts, (rows, columns), 1.0)
    counts = ndimage.uniform_filter1d(counts, 3, axis=0) + 0.0
    pairs = counts[:, :-1] + counts[:, 1:]
    dense = np.sort(pairs, axis=1)[:, -1]
    typical = np.percentile(dense[dense > 0], 75) if np.any(dense > 0) else 1.0
    inked = dense > 0.16 * typical
    edges = np.flatnonzero(np.diff(np.r_[0, inked.astype(int), 0]))
    return [(low + top, low + bottom) for top, bottom in edges.reshape(-1, 2)]


def _pitch(xs: list[Floats], height: float) -> float:
    """The pitch: the shortest period at which the lines' ink leaves a gap between any two cells."""
    periods = height * np.exp(np.arange(np.log(0.38), np.log(1.45), 0.0025))
    xs = [x[:: len(x) // 1500 + 1] for x in xs]
    power = np.zeros(len(periods))
    for x in xs:
        power += np.abs(np.exp(2j * np.pi * np.outer(1 / periods, x)).sum(axis=1)) ** 2 / len(x)
    peaks = np.flatnonzero((power >= np.roll(power, 1)) & (power >= np.roll(power, -1)))
    peaks = peaks[np.argsort(-power[peaks])[:10]]
    gaps = {float(periods[peak]): _gap(xs, float(periods[peak])) for peak in peaks}
    least = min(gaps.values())
    return min(period for period, gap in gaps.items() if gap <= least * 1.4 + 0.06)


def _gap(xs: list[Floats], period: float) -> float:
    """How much ink stands where the folded lines have least, relative to an even spread."""
    bins = 24
    total, least = 0.0, 0.0
    for x in xs:
        folded = np.bincount((x / period % 1 * bins).astype(int), minlength=bins)[:bins]
        smooth = folded + np.roll(folded, 1) + np.roll(folded, -1)
        least += float(smooth.min())
        total += len(x) * 3 / bins
    return least / total


def _terms(x: Floats, y: Floats, span: float) -> Floats:
    """The polynomial that bends the columns: shape (6, points)."""
    x, y = x / span, y / span
    return np.stack([np.ones_like(x), x, y, x * y, x * x, y * y])


def _gaps(x: Floats, pitch: float) -> Floats:
    """Places in a line where no ink stands above another, in the gaps between characters; gaps as
    wide as a blank say nothing of where cells begin."""
    step = pitch / 24
    low = x.min()
    counts = np.bincount(((x - low) / step).astype(int)).astype(float)
    counts = ndimage.uniform_filter1d(counts, 3)
    empty = counts < 0.12 * np.percentile(counts[counts > 0], 80)
    edges = np.flatnonzero(np.diff(np.r_[0, empty.astype(int), 0])).reshape(-1, 2)
    gaps = [np.arange(start, stop) for start, stop in edges if stop - start < 0.75 * 24]
    return low + (np.concatenate(gaps) + 0.5) * step if gaps else np.array([low])


def _bend(xs: list[Floats], ys: list[Floats], pitch: float, span: float) -> tuple[Floats, float]:
    """Coefficients of `_terms` that bring the edges of the cells to whole pitches, and how clear
    the columns are then.

    Sums over stretches of a dozen cells stand for their gaps: a change of the polynomial only turns
    their phases."""
    sums, places = [], []
    for x, y in zip(xs, ys, strict=True):
        gaps = _gaps(x, pitch)
        stretch = np.floor(gaps / (12 * pitch)).astype(int)
        for one in np.unique(stretch):
            inside = gaps[stretch == one]
            near = np.abs(x - inside.mean()) < 12 * pitch
            sums.append(np.exp(2j * np.pi * inside / pitch).sum())
            places.append((inside.mean(), y[near].mean() if near.any() else y.mean()))
    total = np.array(sums)
    terms = _terms(np.array(places)[:, 0], np.array(places)[:, 1], span)
    turn = 2j * np.pi / pitch
    step = 0.12 * pitch
    wide = np.arange(-0.09 * span, 0.09 * span, step)
    narrow = np.arange(-4, 5) * step
    best = np.zeros(6)
    # slant and keystone together, then the pitch itself
    for first, second, one, other in ((2, 1, wide, narrow), (3, 2, wide, narrow)):
        turned = total * np.exp(turn * best @ terms)
        left = np.exp(turn * np.outer(one, terms[first]))
        right = np.exp(turn * np.outer(other, terms[second]))
        clear = np.abs((left * turned) @ right.T)
        at = np.unravel_index(int(np.argmax(clear)), clear.shape)
        best[first] += one[at[0]]
        best[second] += other[at[1]]
    weights = np.abs(total)
    for _ in range(6):
        turned = total * np.exp(turn * best @ terms)
        off = np.angle(turned * np.conj(turned.sum())) / (2 * np.pi) * pitch
        sure = weights * np.exp(-((off / (0.25 * pitch)) ** 2))
        ridge = np.diag([1e-6, 1e-3, 1e-3, 1e-2, 1e-2, 1e-2]) * sure.sum()
        fit = np.linalg.solve((terms * sure) @ terms.T + ridge, (terms * sure) @ off)
        best -= fit
    turned = total * np.exp(turn * best @ terms)
    best[0] -= float(np.angle(turned.sum())) / (2 * np.pi) * pitch
    return best, float(np.abs(turned.sum()) / weights.sum())


def grid_of(ink: Image) -> Grid | None:
    """The grid of a page that stands upright, None where none is found."""
    points = points_of(ink)
    if points.few:
        return None
    slope, keystone = slopes(points)
    x, y, span = points.x, points.y, points.span
    level = y - x * (slope + keystone * y / span)
    lines = _lines(points, level)
    height = float(np.median([bottom - top for top, bottom in lines])) if lines else 0.0
    lines = _mended(lines, height)
    if len(lines) < 6 or height < _LEAST_HEIGHT:
        return None
    members = [np.flatnonzero((level >= top) & (level < bottom)) for top, bottom in lines]
    xs, ys = [x[inside] for inside in members], [y[inside] for inside in members]
    pitch = _pitch(xs, height)
    bend, clarity = _bend(xs, ys, pitch, span)
    upright = [
        line + bend @ _terms(line, across, span) for line, across in zip(xs, ys, strict=True)
    ]
    everything = np.concatenate(upright)
    first = np.floor(np.percentile(everything, 0.2) / pitch) - 1
    last = np.ceil(np.percentile(everything, 99.8) / pitch) + 1
    left = first * pitch
    count = int(last - first)
    scale = CELL_WIDTH / pitch
    small = _resized(ink, scale)
    tall = round(1.7 * height * scale)

    rise = np.zeros(6)

    def place(u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Where in the picture the point ``u`` across and ``v`` down the levelled page is."""
        x, y = u, v
        for _ in range(5):
            x = u - np.tensordot(bend, _terms(x, y, span), 1)
            y = v + x * (slope + keystone * y / span)
        y = y + np.tensordot(rise, _terms(u, v, span), 1)
        return x + ink.shape[1] / 2, y + ink.shape[0] / 2

    def sampled(middle: float) -> Image:
        u = left + (np.arange(count * CELL_WIDTH + 2 * SLACK) - SLACK + 0.5) / scale
        v = middle + (np.arange(tall + 2 * SLACK) - SLACK - tall / 2 + 0.5) / scale
        # the map bends slowly: it is worked out at every eighth point
        coarse = np.linspace(0, len(u) - 1, len(u) // 8)
        across, down = place(*np.meshgrid(u[0] + coarse / scale, v[[0, -1]]))
        t = np.linspace(0, 1, len(v))[:, None]
        at_x = np.stack([np.interp(np.arange(len(u)), coarse, row) for row in across])
        at_y = np.stack([np.interp(np.arange(len(u)), coarse, row) for row in down])
        at_x, at_y = (at[0] * (1 - t) + at[1] * t for at in (at_x, at_y))
        where = np.stack([at_y * scale - 0.5, at_x * scale - 0.5])
        picture: Image = ndimage.map_coordinates(small, where, order=1, cval=0.0)
        return picture

    middles = np.array([(top + bottom) / 2 for top, bottom in lines])
    pictures = [sampled(middle) for middle in middles]
    rise, shifts = _risen(pictures, left, middles, scale, span)
    middles = middles + shifts
    pictures = [sampled(middle) for middle in middles]
    corners = []
    for middle in middles:
        u, v = np.meshgrid(
            left + np.arange(count + 1) * pitch, middle + np.array([-0.5, 0.5]) * 1.3 * height
        )
        corners.append(np.stack(place(u, v), axis=-1).transpose(1, 0, 2))
    return Grid(pictures, middles / pitch, corners, pitch, clarity)


def _risen(
    pictures: list[Image], left: float, middles: Floats, scale: float, span: float
) -> tuple[Floats, Floats]:
    """What the lines still rise and fall: coefficients of `_terms`, and each line's own shift, in
    pixels of the picture. Stretches of ten cells are laid on the mean of all."""
    reach, width = 9, 10 * CELL_WIDTH
    profiles, places, lines = [], [], []
    for line, picture in enumerate(pictures):
        for start in range(0, picture.shape[1] - width // 2, width):
            profile = picture[:, start : start + width].sum(axis=1).astype(float)
            if profile.sum() > 2 * CELL_WIDTH:
                profiles.append(np.pad(profile / np.linalg.norm(profile), reach))
                places.append((left + (start + width / 2) / scale, middles[line]))
                lines.append(line)
    size = len(profiles[0]) - 2 * reach
    every = np.array(profiles)
    moves = np.zeros(len(every), int)
    steps = np.arange(2 * reach + 1)
    for _ in range(3):
        mean = np.mean(
            [one[reach + m : reach + m + size] for one, m in zip(every, moves, strict=True)], 0
        )
        fits = np.stack([every[:, step : step + size] @ mean for step in steps], axis=1)
        moves = np.argmax(fits, axis=1) - reach
    off = moves - np.median(moves)
    terms = _terms(np.array(places)[:, 0], np.array(places)[:, 1], span)
    sure = np.ones(len(off))
    rise = np.zeros(6)
    for _ in range(5):
        ridge = np.diag([1e-6, 1e-4, 1e-4, 1e-3, 1e-3, 1e-3]) * sure.sum()
        rise = np.linalg.solve((terms * sure) @ terms.T + ridge, (terms * sure) @ off)
        sure = 1 / (1 + ((off - rise @ terms) / 1.5) ** 2)
    rest = off - rise @ terms
    own = np.array(
        [
            np.average(rest[where], weights=sure[where])
            if np.any(where := np.array(lines) == line)
            else 0.0
            for line in range(len(pictures))
        ]
    )
    return rise / scale, own / scale


def _resized(ink: Image, scale: float) -> Image:
    from PIL import Image as Pillow

    height, width = ink.shape
    size = (max(1, round(width * scale)), max(1, round(height * scale)))
    return np.asarray(Pillow.fromarray(ink).resize(size, Pillow.Resampling.BILINEAR), np.float32)


def _mended(lines: list[tuple[float, float]], height: float) -> list[tuple[float, float]]:
    """Lines in whose place a stroke stands above (a broken row) joined, specks left out."""
    kept: list[tuple[float, float]] = []
    for top, bottom in lines:
        if kept and top - kept[-1][1] < 0.15 * height and bottom - kept[-1][0] < 1.6 * height:
            kept[-1] = (kept[-1][0], bottom)
        else:
            kept.append((top, bottom))
    return [(top, bottom) for top, bottom in kept if bottom - top > 0.25 * height]
