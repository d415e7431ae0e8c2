"""The grid of a typed page: its lines, its pitch, and the cell of each character.

Only fixed pitch is assumed, no typeface. The gaps between characters repeat with the pitch; their
phase tells where cells begin, and a polynomial carries it over a page that is turned, keystoned or
bent.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from .picture import Floats, Image, Points, resize

CELL_WIDTH = 16  # pixels of a resampled cell: 3 and 8 of a dot matrix are distinct from there on
SLACK = 2  # pixels kept around a cell, for the shifts that are tried
MIN_LINES = 6  # lines of type of a page
WIDEST = 1.1  # widest pitch, in heights of a line; pages have 0.6 to 0.97
MAX_COLUMNS = 200  # pitches across a page: two printouts side by side have 180; bounds memory
CELL_HEIGHT = 1.7  # height of a cell, in heights of a line


@dataclass(frozen=True)
class Grid:
    """Cells of a page.

    Parameters
    ----------
    ink : ndarray of float32
        The page, reduced so that a cell is `CELL_WIDTH` pixels wide.
    scale : float
        Pixels of ``ink`` per pixel of the page.
    size : tuple of int
        Height and width of the page, pixels.
    bend : ndarray, shape (6,)
        Coefficients of `_terms` by which columns are moved, pixels.
    tilt : tuple of float
        Slope and keystone of the lines.
    rise : ndarray, shape (4,)
        Coefficients of `_bows` by which lines still rise, pixels.
    middles : ndarray, shape (lines,)
        Height of each line on the levelled page, pixels.
    origin : float
        Place of the first cell, pixels from the middle of the page.
    pitch, height : float
        Width of a cell and height of a line of type, pixels.
    count : int
        Cells of a line.
    clarity : float
        How strictly the gaps keep to the pitch, 0 to 1.
    own : ndarray, shape (lines, 4)
        Shift of each line: across, its growth a cell, down, its growth a cell; pixels.
    """

    ink: Image
    scale: float
    size: tuple[int, int]
    bend: Floats
    tilt: tuple[float, float]
    rise: Floats
    middles: Floats
    origin: float
    pitch: float
    height: float
    count: int
    clarity: float
    own: Floats

    def place(self, line: int, cells: Floats, down: Floats) -> tuple[Floats, Floats]:
        """Return x and y on the page of points of a line.

        Parameters
        ----------
        line : int
            Index of the line.
        cells, down : ndarray
            Cells along the line, and pixels below its middle.
        """
        span = float(max(self.size))
        across, more_across, lower, more_lower = self.own[line]
        u = self.origin + cells * self.pitch + across + more_across * cells
        v = self.middles[line] + down + lower + more_lower * cells
        slope, keystone = self.tilt
        x, y = u, v
        for _ in range(5):  # the bend is a function of x and y
            x = u - np.tensordot(self.bend, _terms(x, y, span), 1)
            y = v + x * (slope + keystone * y / span)
        y = y + np.tensordot(self.rise, _bows((u - self.origin) / span, v / span), 1)
        return x + self.size[1] / 2, y + self.size[0] / 2

    def strip(self, line: int) -> Image:
        """Return the picture of a line: cell k begins at pixel SLACK + k CELL_WIDTH."""
        tall = round(CELL_HEIGHT * self.height * self.scale)
        wide = self.count * CELL_WIDTH + 2 * SLACK
        cells = (np.arange(wide) - SLACK + 0.5) / CELL_WIDTH
        coarse = np.linspace(0, wide - 1, wide // 8)  # the map bends slowly
        ends = (np.array([0, tall + 2 * SLACK - 1]) - SLACK - tall / 2 + 0.5) / self.scale
        knots = np.interp(coarse, np.arange(wide), cells)
        coordinates = []
        for at in self.place(line, *np.meshgrid(knots, ends))[::-1]:
            top, foot = (np.interp(np.arange(wide), coarse, row) * self.scale - 0.5 for row in at)
            coordinates.append(np.linspace(top, foot, tall + 2 * SLACK))
        strip: Image = ndimage.map_coordinates(self.ink, coordinates, order=1, cval=0.0)
        return strip

    def corners(self, line: int, cell: int, stop: int | None = None) -> Floats:
        """Return the corners of cells of a line on the page, clockwise: shape (4, 2)."""
        last = cell + 1 if stop is None else stop
        half = 0.65 * self.height
        across = np.array([cell, last, last, cell], float)
        return np.stack(self.place(line, across, np.array([-half, -half, half, half])), axis=1)

    def move_lines(self, own: Floats) -> Grid:
        """Return the grid with lines moved by what is added to their own shifts."""
        return replace(self, own=self.own + own)


def _sharpest(
    points: Points, tilts: Sequence[tuple[float, float]], width: float
) -> tuple[float, float]:
    """Return the slope and keystone along which rows of ink and gaps alternate most.

    The measure is the sum of squared differences of the ink of successive rows, ``width`` pixels
    high.
    """
    x, y, span = points

    def sharpness(tilt: tuple[float, float]) -> float:
        level = y - x * (tilt[0] + tilt[1] * y / span)
        counts = np.bincount(((level - level.min()) / width).astype(int)).astype(float)
        return float(np.sum(np.diff(counts) ** 2))

    return max(tilts, key=sharpness)


def _tilt(points: Points) -> tuple[float, float]:
    """Return slope and keystone of the lines, found on finer and finer lattices; slopes to 0.25."""
    step = max(1.0, points.span / 1200)
    some = points.sample(20_000)
    slopes = [(float(slope), 0.0) for slope in np.arange(-0.25, 0.2501, 0.004)]
    first = _sharpest(some, slopes, points.span / 600)[0]
    keystones = np.arange(-0.12, 0.1201, 0.02).tolist()
    slope, key = _sharpest(
        some, [(first + d, k) for k in keystones for d in (-0.002, 0.0, 0.002)], 1.5 * step
    )
    for width in (0.002, 0.001, 0.0005):
        around = product((-1, 0, 1), (-8, -4, 0, 4, 8))
        slope, key = _sharpest(
            some, [(slope + i * width, key + j * width) for i, j in around], step
        )
    return slope, key


def _runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return first index and end of each run of True."""
    edges = np.flatnonzero(np.diff(np.r_[0, mask.astype(int), 0])).reshape(-1, 2)
    return [(int(start), int(stop)) for start, stop in edges]


def _lines(points: Points, level: Floats) -> list[tuple[float, float]]:
    """Return top and bottom of each line of type, in pixels of ``level``, the height of each point
    on the levelled page.

    A row belongs to a line where a stretch of it, two characters wide, is as dense as type.
    """
    low = level.min()
    stretch = max(8.0, points.span / 80)
    rows = (level - low).astype(int)
    columns = ((points.x - points.x.min()) / stretch).astype(int)
    counts = np.zeros((rows.max() + 1, columns.max() + 2))
    np.add.at(counts, (rows, columns), 1.0)
    counts = ndimage.uniform_filter1d(counts, 3, axis=0)
    dense = (counts[:, :-1] + counts[:, 1:]).max(axis=1)
    usual = np.percentile(dense[dense > 0], 75)
    grain = np.percentile(dense, 30)
    return [(low + top, low + foot) for top, foot in _runs(dense > grain + 0.2 * (usual - grain))]


def grid_of(ink: Image, points: Points) -> Grid | None:
    """Return the grid of an upright page, None where no lines or no pitch are found.

    Parameters
    ----------
    ink : ndarray of float32, shape (rows, columns)
        The ink of the page.
    points : Points
        Its inked places.
    """
    if not len(points.x):
        return None
    tilt = _tilt(points)
    x, y, span = points
    level = y - x * (tilt[0] + tilt[1] * y / span)
    lines = _lines(points, level)
    height = _usual_height(level, lines)
    lines = [(top, foot) for top, foot in lines if foot - top > 0.3 * height]
    if len(lines) < MIN_LINES:
        return None
    members = [np.flatnonzero((level >= top) & (level < foot)) for top, foot in lines]
    xs, ys = [x[inked] for inked in members], [y[inked] for inked in members]
    pitch = _pitch(xs, height, span)
    if not pitch:
        return None
    bend, clarity = _fit_bend(_phasors(xs, ys, pitch, span), tilt[0], pitch, span)
    across = x + bend @ _terms(x, y, span)
    inked = across[np.concatenate(members)]
    origin = float((np.floor(inked.min() / pitch) - 1) * pitch)
    scale = CELL_WIDTH / pitch
    middles = np.array([(top + foot) / 2 for top, foot in lines])
    rise, drifts = _fit_rise(across - origin, level, middles, height, scale, span)
    middles = _distinct(middles + drifts, [len(inked) for inked in members], height)
    return Grid(
        ink=resize(ink, scale),
        scale=scale,
        size=(ink.shape[0], ink.shape[1]),
        bend=bend,
        tilt=tilt,
        rise=rise,
        middles=middles,
        origin=origin,
        pitch=pitch,
        height=height,
        count=round(np.ceil(inked.max() / pitch) + 1 - origin / pitch),
        clarity=clarity,
        own=np.zeros((len(middles), 4)),
    )


def _usual_height(level: Floats, lines: Sequence[tuple[float, float]]) -> float:
    """Return the height of lines of type: the median, weighted with their ink."""
    if not lines:
        return 0.0
    heights = np.array([foot - top for top, foot in lines])
    places = np.sort(level)
    inked = np.diff(np.searchsorted(places, np.array(lines)), axis=1)[:, 0]
    order = np.argsort(heights)
    cumulative = np.cumsum(inked[order])
    return float(heights[order][np.searchsorted(cumulative, cumulative[-1] / 2)])


def _distinct(middles: Floats, weights: Sequence[int], height: float) -> Floats:
    """Return the middles of lines without those that overlap another with more ink."""
    distinct: list[float] = []
    for line in np.argsort(-np.array(weights), kind="stable").tolist():
        middle = float(middles[line])
        if all(abs(middle - accepted) > 0.75 * height for accepted in distinct):
            distinct.append(middle)
    return np.array(sorted(distinct))


# --- pitch and bend -------------------------------------------------------------------------------


def _gaps(x: Floats, pitch: float) -> Floats:
    """Return the places along a line that no ink crosses; gaps as wide as a blank are left out."""
    step = max(pitch / 24, 0.5)
    low = x.min()
    counts = np.bincount(((x - low) / step).astype(int)).astype(float)
    runs = _runs(counts < 0.12 * np.percentile(counts[counts > 0], 80))
    gaps = [np.arange(start, stop) for start, stop in runs if stop - start < 0.75 * pitch / step]
    return np.asarray(low + (np.concatenate(gaps) + 0.5) * step if gaps else [low])


def _pitch(xs: list[Floats], height: float, span: float) -> float:
    """Return the period of the gaps in pixels, 0 where there is none: the largest of the summed
    power spectrum."""
    size, low = 1 << 15, min(float(x.min()) for x in xs)
    gaps = [np.bincount((2 * (_gaps(x, height) - low)).astype(int), minlength=2) for x in xs]
    power = np.zeros(size // 2 + 1)
    for gap in gaps:
        power += np.abs(np.fft.rfft(gap, size)) ** 2 / gap.sum()
    last = int(2 * WIDEST * height)
    first = max(last // 2, int(2 * span / MAX_COLUMNS), 2)  # an octave, so that it is no harmonic
    chosen = np.arange(size // last, size // first + 1)
    return float(size / chosen[np.argmax(power[chosen])] / 2) if len(chosen) else 0.0


def _terms(x: Floats, y: Floats, span: float) -> Floats:
    """Return the terms 1, x, y, xy, x², y² of the bend, x and y in units of ``span``."""
    x, y = x / span, y / span
    return np.stack([np.ones_like(x), x, y, x * y, x * x, y * y])


class _Phasors(NamedTuple):
    """Σ exp(2πi x / pitch) over the gaps x of each piece of a line, and `_terms` of the piece."""

    sums: NDArray[np.complex128]
    terms: Floats

    def shift(self, bend: Floats, pitch: float) -> NDArray[np.complex128]:
        """Return the sums after the columns were moved by a bend."""
        sums: NDArray[np.complex128] = self.sums * np.exp(2j * np.pi / pitch * bend @ self.terms)
        return sums


def _phasors(xs: list[Floats], ys: list[Floats], pitch: float, span: float) -> _Phasors:
    """Return the phasors of the gaps in lines with inked places ``xs``, ``ys``."""
    sums, places = [], []
    width = span / 8  # of pieces: half as wide or twice give the same bend
    for x, y in zip(xs, ys, strict=True):
        gaps = _gaps(x, pitch)
        piece = np.floor(gaps / width).astype(int)
        for number in np.unique(piece):
            inside = gaps[piece == number]
            is_near = np.abs(x - inside.mean()) < width
            sums.append(np.exp(2j * np.pi * inside / pitch).sum())
            places.append((inside.mean(), y[is_near].mean() if is_near.any() else y.mean()))
    at = np.array(places)
    return _Phasors(np.array(sums), _terms(at[:, 0], at[:, 1], span))


def _fit_bend(phasors: _Phasors, slope: float, pitch: float, span: float) -> tuple[Floats, float]:
    """Return the bend that brings the edges of cells to whole pitches, and the clarity then.

    The bend b maximizes the clarity |Σ z exp(2πi b · terms / pitch)| / Σ |z| over the phasors z.
    It has many local maxima, one a pitch or so: a search on a lattice precedes the refinement.
    """
    bend = _search_bend(phasors, slope, pitch, span)
    weights = np.abs(phasors.sums)
    turn = pitch / (2 * np.pi)
    for _ in range(8):  # reweighted least squares on the phase of each piece
        moved = phasors.shift(bend, pitch)
        phase = np.angle(moved * np.conj(moved.sum()))
        sure = weights * np.maximum(np.cos(phase), 0)  # what a piece adds to the clarity
        normal = (phasors.terms * sure) @ phasors.terms.T + 1e-4 * sure.sum() * np.eye(len(bend))
        bend = bend - np.linalg.solve(normal, (phasors.terms * sure) @ phase) * turn
    total = phasors.shift(bend, pitch).sum()
    bend[0] -= float(np.angle(total)) * turn
    return bend, float(np.abs(total) / weights.sum())


def _search_bend(phasors: _Phasors, slope: float, pitch: float, span: float) -> Floats:
    """Return the clearest bend on a lattice of slant, stretch, keystone and bow.

    They are searched together: with one of them wrong by some pitches, no value of the others gives
    clear columns.
    """
    turn = 2j * np.pi / pitch
    step = 0.3 * pitch
    slants, stretches, keystones, bows = (
        np.arange(-reach * span, reach * span, width)
        for reach, width in ((0.1, step), (0.04, step), (0.15, 2 * step), (0.06, 4 * step))
    )
    slants += slope * span  # columns are perpendicular to lines, nearly
    curves = np.array([*product(keystones, bows - bows.mean())])
    chosen = np.argsort(-np.abs(phasors.sums))[:80]
    sums, terms = phasors.sums[chosen], phasors.terms[:, chosen]
    # in single precision, for speed: it only starts the refinement
    by_slant = np.exp(turn * np.outer(slants, terms[2])).astype(np.complex64)
    by_stretch = np.exp(turn * np.outer(stretches, terms[1])).T.astype(np.complex64)
    by_curve = (sums * np.exp(turn * curves @ terms[3:5])).astype(np.complex64)
    best, bend = -np.inf, np.zeros(6)
    for start in range(0, len(curves), 64):  # threads cost more than products of small matrices
        rows = by_curve[start : start + 64]
        clarity = np.abs((rows[:, None] * by_slant).reshape(-1, len(chosen)) @ by_stretch)
        clarity = clarity.reshape(len(rows), len(slants), len(stretches)) / np.abs(sums).sum()
        curve, slant, stretch = np.unravel_index(int(clarity.argmax()), clarity.shape)
        if clarity[curve, slant, stretch] > best:
            best = float(clarity[curve, slant, stretch])
            keystone, bow = curves[start + curve]
            bend = np.array([0, stretches[stretch], slants[slant], keystone, bow, 0])
    return bend


# --- heights of lines -----------------------------------------------------------------------------


def _bows(u: Floats, v: Floats) -> Floats:
    """Return the terms u, uv, u², u²v of the rise of lines, u and v in units of the span."""
    return np.stack([u, u * v, u * u, u * u * v])


def _fit_rise(
    across: Floats, level: Floats, middles: Floats, height: float, scale: float, span: float
) -> tuple[Floats, Floats]:
    """Return how lines still rise after levelling, in pixels: the coefficients of `_bows`, and a
    constant for each line.

    The vertical profile of each stretch of a line is aligned with the mean of all; the shifts are
    fitted by reweighted least squares.
    """
    reach = 9  # largest shift tried, resampled pixels
    half = int(0.85 * height * scale) + reach
    count = 8  # stretches across the page
    stretches = np.clip((across / span * count).astype(int), 0, count)
    profiles, places = [], []
    for line, middle in enumerate(middles):
        down = np.floor((level - middle) * scale).astype(int) + half
        is_near = (down >= 0) & (down < 2 * half)
        counts = np.zeros((count + 1, 2 * half))
        np.add.at(counts, (stretches[is_near], down[is_near]), 1.0)
        counts = ndimage.uniform_filter1d(counts, 3, axis=1)
        for stretch in np.flatnonzero(counts[:, reach:-reach].sum(axis=1) > 40):
            profiles.append(counts[stretch] / np.linalg.norm(counts[stretch]))
            places.append((line, (stretch + 0.5) / count, middle / span))
    if not profiles:
        return np.zeros(4), np.zeros(len(middles))
    rows, at = np.array(profiles), np.array(places)
    size = 2 * half - 2 * reach
    starts = np.full(len(rows), reach)
    for _ in range(3):
        mean = np.mean([row[k : k + size] for row, k in zip(rows, starts, strict=True)], axis=0)
        fits = np.stack([rows[:, k : k + size] @ mean for k in range(2 * reach + 1)], axis=1)
        starts = np.argmax(fits, axis=1)
    offsets = starts - np.median(starts)
    terms = np.vstack([_bows(at[:, 1], at[:, 2]), np.eye(len(middles))[:, at[:, 0].astype(int)]])
    weights = np.ones(len(offsets))
    rise = np.zeros(len(terms))
    for _ in range(6):
        normal = (terms * weights) @ terms.T + 1e-3 * np.eye(len(terms))
        rise = np.linalg.solve(normal, (terms * weights) @ offsets)
        weights = 1 / (1 + ((offsets - rise @ terms) / 1.5) ** 2)
    return rise[:4] / scale, rise[4:] / scale
