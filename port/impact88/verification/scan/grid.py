"""The grid of a typed page: its lines, its pitch, and the cells that one character each stands in.

Fixed pitch is all that is assumed, no font. A line's ink has a gap between any two cells, so its
Fourier component at the pitch is strong; the phase of that component says where the cells begin.
Smooth polynomials carry both over the page, which takes in turned, keystoned and bent paper.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from .ink import Floats, Image, Points, resized, slopes

CELL_WIDTH = 16
"""Pixels across a cell after sampling: the least at which 3 and 8 of a dot matrix stay apart."""
SLACK = 2
"""Pixels of picture kept on each side of a cell, for the shifts that are tried."""
_LEAST_HEIGHT, _MOST_LINES = 5, 64  # pixels, lines; doubled, the verdicts of 5 pages stay
_INKED = 0.25
"""Darkness, of full ink, from which a cell is inked: of 2,405 blank cells one in a thousand is
darker than 0.27, of 7,648 others one in a thousand is lighter than 0.44."""
_PITCHES = (0.4, 1.15)
"""The least and greatest pitch, in heights of a line from its capitals' top to its deepest comma:
those of the given pages have 0.6 to 0.97."""
_MOST_COLUMNS = 200
"""Pitches across the page's longer side: two printouts side by side have 180."""
_STRETCH = 6 * CELL_WIDTH
"""Pixels of a line whose height is measured at once."""
_STRAIN = 0.02
"""What a pitch of keystone or bow costs of the clarity (0 to 1) it gains: without it a page of
broken type, in which gaps stand within characters, is bent to fit them; twice as much leaves two of
the given photographs flat."""
_GUTTER, _COLUMN = 6, 0.25
"""The least gap between printouts side by side, in 300ths of the page, some three characters of
160, and the least part of the ink that is a column: angles at the end of their line are none."""
_OVERLAP = (
    0.75  # of their height: lines whose middles are nearer are one; no leading is less than 1
)
FEWEST_POINTS = 500  # a page has more ink
_COARSE = 80
"""Stretches of a dozen cells from which the starts are found, those with the clearest gaps."""


class Grid(NamedTuple):
    """Cells of a page. ``pictures``: of each line, cell k from pixel SLACK + k CELL_WIDTH on, with
    SLACK rows above and below; ``tops``: each line's place in pitches down the page; ``corners``:
    each line's cells in the picture, shape (cells + 1, 2, 2): left edge k, top or bottom, x and y;
    ``size``: height and width of the picture after the quarter ``turns`` to the left."""

    pictures: list[Image]
    tops: Floats
    corners: list[Floats]
    pitch: float
    clarity: float
    size: tuple[int, ...]
    turns: int

    def around(self, line: int, cell: int) -> Floats:
        """The corners of a cell in the upright picture, clockwise: shape (4, 2)."""
        corners = self.corners[line]
        at = min(max(cell, 0), len(corners) - 2)
        around: Floats = corners[[at, at + 1, at + 1, at], [0, 0, 1, 1]]
        return around

    def shows(self, line: int, cell: int) -> bool:
        """Whether a cell lies on the picture, and not beyond an edge that was cut off."""
        if not 0 <= cell < len(self.corners[line]) - 1:
            return False
        x, y = self.around(line, cell).T
        slack = 0.1 * self.pitch
        height, width = self.size
        return bool(x.min() > -slack and x.max() < width + slack and 0 <= y.mean() < height)

    def odds(self) -> list[Floats]:
        """The log odds that each cell of each line is inked, within 6 of even: by a dot, or by as
        much ink along a line, the hair of a thin dash."""
        edge, width = SLACK + 1, CELL_WIDTH + 2 * SLACK
        odds = []
        for line in self.pictures:
            starts = range(0, line.shape[1] - width + 1, CELL_WIDTH)
            cells = np.stack([line[:, start : start + width] for start in starts])
            dots = ndimage.uniform_filter(cells, (1, 3, 3))[:, edge:-edge, edge + 1 : -edge - 1]
            hairs = ndimage.uniform_filter(cells, (1, 1, 9))[:, edge:-edge, edge + 4 : -edge - 4]
            most = np.maximum(dots.max(axis=(1, 2)), hairs.max(axis=(1, 2)))
            odds.append(np.clip(20 * (most.astype(float) - _INKED), -6, 6))
        return odds


def _lines(points: Points, level: Floats) -> list[tuple[float, float]]:
    """Top and bottom of each line of text along ``level``, the height that is constant on it: rows
    of which a character or two hold ink as densely as type does, were it the only digit."""
    low = level.min()
    rows = (level - low).astype(int)
    stretch = max(8.0, points.span / 80)
    columns = ((points.x - points.x.min()) / stretch).astype(int)
    counts = np.zeros((rows.max() + 1, columns.max() + 2))
    np.add.at(counts, (rows, columns), 1.0)
    counts = ndimage.uniform_filter1d(counts, 3, axis=0) + 0.0
    dense = (counts[:, :-1] + counts[:, 1:]).max(axis=1)
    typical = np.percentile(dense[dense > 0], 75) if np.any(dense > 0) else 1.0
    grain = np.percentile(dense, 30)  # fewer rows than that are between lines on no page
    inked = dense > grain + 0.2 * (typical - grain)
    edges = np.flatnonzero(np.diff(np.r_[0, inked.astype(int), 0]))
    return [(low + top, low + bottom) for top, bottom in edges.reshape(-1, 2)]


def _pitch(xs: list[Floats], height: float, span: float) -> float:
    """The period of the gaps between characters, 0 for none. (The ink has others: most digits have
    a stroke at each side of their cell.)"""
    size, low = 1 << 15, min(float(x.min()) for x in xs)
    gaps = [np.bincount((2 * (_gaps(x, height) - low)).astype(int), minlength=2) for x in xs]
    power = sum(np.abs(np.fft.rfft(gap, size)) ** 2 / gap.sum() for gap in gaps)
    first, last = (int(2 * height * part) for part in _PITCHES)
    first = max(first, int(2 * span / _MOST_COLUMNS))
    chosen = np.arange(size // last, size // max(first, 2) + 1)
    return float(size / chosen[np.argmax(np.asarray(power)[chosen])] / 2) if len(chosen) else 0.0


def _terms(x: Floats, y: Floats, span: float) -> Floats:
    """The polynomial that bends the columns: shape (6, points)."""
    x, y = x / span, y / span
    return np.stack([np.ones_like(x), x, y, x * y, x * x, y * y])


def _gaps(x: Floats, pitch: float) -> Floats:
    """Places in a line where no ink stands above another, in the gaps between characters; gaps as
    wide as a blank say nothing of where cells begin."""
    step = max(pitch / 24, 0.5)
    low = x.min()
    counts = np.bincount(((x - low) / step).astype(int)).astype(float)
    empty = counts < 0.12 * np.percentile(counts[counts > 0], 80)
    edges = np.flatnonzero(np.diff(np.r_[0, empty.astype(int), 0])).reshape(-1, 2)
    gaps = [np.arange(start, stop) for start, stop in edges if stop - start < 0.75 * pitch / step]
    return low + (np.concatenate(gaps) + 0.5) * step if gaps else np.array([low])


def _bend(xs: list[Floats], ys: list[Floats], pitch: float, span: float) -> tuple[Floats, float]:
    """Coefficients of `_terms` that bring the edges of the cells to whole pitches, and how clear
    the columns are then. Sums over stretches of a dozen cells stand for their gaps."""
    sums, places = [], []
    for x, y in zip(xs, ys, strict=True):
        gaps = _gaps(x, pitch)
        stretch = np.floor(gaps / (12 * pitch)).astype(int)
        for part in np.unique(stretch):
            inside = gaps[stretch == part]
            near = np.abs(x - inside.mean()) < 12 * pitch
            sums.append(np.exp(2j * np.pi * inside / pitch).sum())
            places.append((inside.mean(), y[near].mean() if near.any() else y.mean()))
    total, at = np.array(sums), np.array(places)
    terms = _terms(at[:, 0], at[:, 1], span)
    turn = 2j * np.pi / pitch
    # slant, keystone and the pitch itself together: each alone leaves nothing to see of the others
    step = 0.3 * pitch
    slants, stretches, keystones, bows = (
        np.arange(-reach * span, reach * span, width)
        for reach, width in ((0.1, step), (0.04, step), (0.15, 2 * step), (0.06, 4 * step))
    )
    curves = np.array([(keystone, bow) for keystone in keystones for bow in bows - bows.mean()])
    few = np.argsort(-np.abs(total))[:_COARSE]
    strong, sited = total[few], terms[:, few]
    wide = np.exp(turn * np.outer(slants, sited[2]))
    narrow = np.exp(turn * np.outer(stretches, sited[1])).T
    curved = strong * np.exp(turn * curves @ sited[3:5])
    clear = np.stack([np.abs((wide * sums) @ narrow) for sums in curved]) / np.abs(strong).sum()
    clear -= _STRAIN * np.abs(curves).sum(axis=1)[:, None, None] / pitch
    spot = np.unravel_index(int(np.argmax(clear)), clear.shape)
    best = np.array([0, stretches[spot[2]], slants[spot[1]], *curves[spot[0]], 0])
    weights = np.abs(total)
    for reach in (0.35, 0.35, 0.3, 0.3, 0.25, 0.25, 0.2, 0.2):
        # what is off by a good part of a pitch counts less
        turned = total * np.exp(turn * best @ terms)
        off = np.angle(turned * np.conj(turned.sum())) / (2 * np.pi) * pitch
        sure = weights * np.exp(-((off / (reach * pitch)) ** 2))
        ridge = np.diag([1e-6, 1e-4, 1e-4, 3e-4, 3e-4, 1e-2]) * sure.sum()
        best = best - np.linalg.solve((terms * sure) @ terms.T + ridge, (terms * sure) @ off)
    turned = total * np.exp(turn * best @ terms)
    best[0] -= float(np.angle(turned.sum())) / (2 * np.pi) * pitch
    return best, float(np.abs(turned.sum()) / weights.sum())


def grids_of(ink: Image, points: Points, turns: int) -> list[Grid]:
    """The grids of a page turned by quarters to the left: one, or those of columns side by side.
    ``points``: of the ink as it lies."""
    ink = np.ascontiguousarray(np.rot90(ink, turns))
    points = points.turned(turns)
    slope, keystone = slopes(points)
    grids = [_grid(ink, part, slope, keystone, turns) for part in _columns(points, slope)]
    return [grid for grid in grids if grid]


def _columns(points: Points, slope: float) -> list[Points]:
    """The ink left and right of a gap that runs down the page with much ink on both sides."""
    across = points.x + slope * points.y
    step = points.span / 300
    counts = np.bincount(((across - across.min()) / step).astype(int)).astype(float)
    empty = counts < 0.05 * np.mean(counts)  # specks fall into gaps, too
    runs = np.flatnonzero(np.diff(np.r_[0, empty.astype(int), 0])).reshape(-1, 2)
    behind = np.cumsum(counts) / len(across)
    inner = [run for run in runs if _COLUMN < behind[run[0]] < 1 - _COLUMN]
    start, stop = max(inner, key=lambda run: float(run[1] - run[0]), default=(0, 0))
    if stop - start < _GUTTER:
        return [points]
    left = across < across.min() + step * (start + stop) / 2
    return [Points(points.x[side], points.y[side], points.span) for side in (left, ~left)]


def _grid(ink: Image, points: Points, slope: float, keystone: float, turns: int) -> Grid | None:
    x, y, span = points.x, points.y, points.span
    level = y - x * (slope + keystone * y / span)
    lines = _lines(points, level)
    height = float(np.median([bottom - top for top, bottom in lines])) if lines else 0.0
    lines = [(top, bottom) for top, bottom in lines if bottom - top > 0.25 * height]  # no specks
    if not 6 <= len(lines) <= _MOST_LINES or height < _LEAST_HEIGHT:
        return None
    members = [np.flatnonzero((level >= top) & (level < bottom)) for top, bottom in lines]
    xs, ys = [x[inside] for inside in members], [y[inside] for inside in members]
    pitch = _pitch(xs, height, span)
    if not pitch:
        return None
    bend, clarity = _bend(xs, ys, pitch, span)
    across = x + bend @ _terms(x, y, span)
    inside = across[np.concatenate(members)]
    left = (np.floor(inside.min() / pitch) - 1) * pitch
    count = round(np.ceil(inside.max() / pitch) + 1 - left / pitch)
    scale = CELL_WIDTH / pitch
    middles = np.array([(top + bottom) / 2 for top, bottom in lines])
    rise, drifts = _risen(across - left, level, middles, height, scale)
    middles = _distinct(middles + drifts, [len(inside) for inside in members], height)
    small = resized(ink, scale)
    tall = round(1.7 * height * scale)

    def place(u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Where in the picture the point ``u`` across and ``v`` down the levelled page is."""
        x, y = u, v
        for _ in range(5):
            x = u - np.tensordot(bend, _terms(x, y, span), 1)
            y = v + x * (slope + keystone * y / span)
        t = (u - left) * scale / _STRETCH
        y = y + np.tensordot(rise, _bows(t, v * scale / _STRETCH), 1)
        return x + ink.shape[1] / 2, y + ink.shape[0] / 2

    def sampled(line: int) -> Image:
        u = left + (np.arange(count * CELL_WIDTH + 2 * SLACK) - SLACK + 0.5) / scale
        v = middles[line] + (np.arange(tall + 2 * SLACK) - SLACK - tall / 2 + 0.5) / scale
        # the map bends slowly: it is worked out at every eighth point
        coarse = np.linspace(0, len(u) - 1, len(u) // 8)
        across, down = place(*np.meshgrid(u[0] + coarse / scale, v[[0, -1]]))
        fine, where = np.arange(len(u)), []
        for at in (down, across):
            top, foot = (np.interp(fine, coarse, row) * scale - 0.5 for row in at)
            where.append(np.linspace(top, foot, len(v)))
        picture: Image = ndimage.map_coordinates(small, where, order=1, cval=0.0)
        return picture

    pictures = [sampled(line) for line in range(len(middles))]
    edges, ends = left + np.arange(count + 1) * pitch, np.array([-0.65, 0.65]) * height
    corners = [np.stack(place(*np.meshgrid(edges, middle + ends))).T for middle in middles]
    return Grid(pictures, middles / pitch, corners, pitch, clarity, ink.shape, turns)


def _distinct(middles: Floats, weights: Sequence[int], height: float) -> Floats:
    """Return the middles of lines without those that overlap another with more ink: an underline,
    or the edge of a shaded band, comes to lie on the line that it belongs to."""
    kept: list[float] = []
    for which in np.argsort(-np.array(weights), kind="stable").tolist():
        middle = float(middles[which])
        if all(abs(middle - other) > _OVERLAP * height for other in kept):
            kept.append(middle)
    return np.array(sorted(kept))


def _bows(u: Floats, v: Floats) -> Floats:
    """What lines of a bent page have in common: shape (4, ...)."""
    return np.stack([u, u * v, u * u, u * u * v]) / 10


def _risen(
    across: Floats, level: Floats, middles: Floats, height: float, scale: float
) -> tuple[Floats, Floats]:
    """How the lines still rise and fall, in pixels: coefficients of `_bows`, and how far each line
    is off. The ink of each stretch is laid on the mean of all."""
    reach = 9
    half = int(0.85 * height * scale) + reach
    stretches = np.maximum((across * scale / _STRETCH).astype(int), 0)
    profiles, places = [], []
    for line, middle in enumerate(middles):
        down = np.floor((level - middle) * scale).astype(int) + half
        near = (down >= 0) & (down < 2 * half)
        counts = np.zeros((stretches.max() + 1, 2 * half))
        np.add.at(counts, (stretches[near], down[near]), 1.0)
        counts = ndimage.uniform_filter1d(counts, 3, axis=1)
        for stretch in np.flatnonzero(counts[:, reach:-reach].sum(axis=1) > 40):
            profiles.append(counts[stretch] / np.linalg.norm(counts[stretch]))
            places.append((line, stretch + 0.5, middle * scale / _STRETCH))
    if not profiles:
        return np.zeros(4), np.zeros(len(middles))
    every, at = np.array(profiles), np.array(places)
    size = 2 * half - 2 * reach
    moves = np.zeros(len(every), int)
    for _ in range(3):
        mean = np.mean(
            [row[reach + m : reach + m + size] for row, m in zip(every, moves, strict=True)], 0
        )
        fits = np.stack([every[:, k : k + size] @ mean for k in range(2 * reach + 1)], axis=1)
        moves = np.argmax(fits, axis=1) - reach
    off = moves - np.median(moves)
    common = np.vstack([_bows(at[:, 1], at[:, 2]), np.eye(len(middles))[:, at[:, 0].astype(int)]])
    sure = np.ones(len(off))
    for _ in range(6):  # what is far off counts less
        normal = (common * sure) @ common.T + 1e-3 * np.eye(len(common))
        rise = np.linalg.solve(normal, (common * sure) @ off)
        sure = 1 / (1 + ((off - rise @ common) / 1.5) ** 2)
    return rise[:4] / scale, rise[4:] / scale
