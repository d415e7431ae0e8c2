"""The grid of a typed page: its lines, its pitch, and the cells that one character each stands in.

Fixed pitch is all that is assumed, no font. A line's ink has a gap between any two cells, so its
Fourier component at the pitch is strong; the phase of that component says where the cells begin.
Smooth polynomials carry both over the page, which takes in turned, keystoned and bent paper.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from .ink import Floats, Image, Points, resize, slopes

CELL_WIDTH = 16
"""Width of a resampled cell, pixels: the least at which 3 and 8 of a dot matrix are distinct."""
SLACK = 2
"""Pixels of picture kept on each side of a cell, for the shifts that are tried."""
_MIN_HEIGHT = 5  # pixels of a line of text; doubled, the verdicts of 5 pages stay
_MAX_LINES = 64  # lines of a page; doubled, the verdicts of 5 pages stay
_INKED = 0.25
"""Darkness, as a fraction of full ink, from which a cell is inked: of 2,405 blank cells one in a
thousand is darker than 0.27, of 7,648 others one in a thousand is lighter than 0.44."""
_PITCHES = (0.4, 1.15)
"""Smallest and largest pitch, in heights of a line from the top of its capitals to its deepest
comma: the given pages have 0.6 to 0.97."""
_MAX_COLUMNS = 200
"""Pitches across the page's longer side: two printouts side by side have 180."""
_STRETCH = 6 * CELL_WIDTH
"""Length of the piece of a line whose height is measured at once, resampled pixels."""
_GAP_STRETCH = 12
"""Length of the piece of a line whose gaps are summed to one phasor, pitches."""
_STRAIN = 0.02
"""Penalty on bending, in clarity (0 to 1) per pitch of keystone or bow: without it a page of broken
type, in which gaps stand within characters, is bent to fit them; twice as much leaves two of the
given photographs flat."""
_MIN_GUTTER = 6
"""Narrowest gap between printouts side by side, in 300ths of the page: some three characters of
160."""
_MIN_COLUMN = 0.25
"""Smallest fraction of the ink that makes a column: angles at the end of their line are none."""
_OVERLAP = 0.75
"""Lines whose middles are nearer than this, in heights of a line, are one: no leading is below
1."""
_CUT = 0.8
"""Largest height of a line that is cut through, relative to the usual: others have capitals."""
_MAX_COARSE = 80
"""Pieces of lines used in the coarse search for the bend: those with the clearest gaps."""
_CURVES_AT_ONCE = 64  # keystones and bows of the coarse search in one product of matrices
_REACHES = (0.35, 0.35, 0.3, 0.3, 0.25, 0.25, 0.2, 0.2)
"""Residual at which a piece of a line has 1/e of its weight, in pitches, by refinement step."""
_RIDGE = (1e-6, 1e-4, 1e-4, 3e-4, 3e-4, 1e-2)
"""Tikhonov weight of each coefficient of `_terms`, relative to the total weight."""


class Grid(NamedTuple):
    """Cells of a page.

    Attributes
    ----------
    pictures : list of ndarray
        Resampled picture of each line: cell k begins at pixel SLACK + k CELL_WIDTH, with SLACK rows
        above and below.
    tops : ndarray
        Place of each line, in pitches down the page.
    corners : list of ndarray, shape (cells + 1, 2, 2)
        Cell edges of each line in the picture, pixels: left edge k; top or bottom; x and y.
    pitch : float
        Width of a cell in the picture, pixels.
    clarity : float
        How strictly the gaps between characters keep to the pitch, 0 to 1.
    size : tuple of int
        Height and width of the picture after the turns.
    turns : int
        Quarter turns to the left by which the picture was set upright.
    cut : frozenset of int
        Lines through which the upper or lower edge of the page runs: the first or last, if it is
        lower than type. A row of asterisks may be so, too.
    numbers : sequence of int
        Number of each line on the paper, from 1; empty where that is its place among the lines.
    """

    pictures: list[Image]
    tops: Floats
    corners: list[Floats]
    pitch: float
    clarity: float
    size: tuple[int, ...]
    turns: int
    cut: frozenset[int] = frozenset()
    numbers: Sequence[int] = ()

    def in_order(self, order: Sequence[int]) -> "Grid":
        """Return the grid with its lines in another order."""
        return self._replace(
            pictures=[self.pictures[line] for line in order],
            tops=self.tops[[*order]],
            corners=[self.corners[line] for line in order],
            cut=frozenset(at for at, line in enumerate(order) if line in self.cut),
            numbers=[self.number(line) for line in order],
        )

    def number(self, line: int) -> int:
        """Return the number of a line on the paper, from 1."""
        return self.numbers[line] if self.numbers else line + 1

    def around(self, line: int, cell: int) -> Floats:
        """Return the corners of a cell in the upright picture, clockwise: shape (4, 2)."""
        corners = self.corners[line]
        at = min(max(cell, 0), len(corners) - 2)
        around: Floats = corners[[at, at + 1, at + 1, at], [0, 0, 1, 1]]
        return around

    def shows(self, line: int, cell: int) -> bool:
        """Return True for a cell that lies on the picture, not beyond an edge that was cut off."""
        if not 0 <= cell < len(self.corners[line]) - 1:
            return False
        x, y = self.around(line, cell).T
        slack = 0.1 * self.pitch
        height, width = self.size
        return bool(x.min() > -slack and x.max() < width + slack and 0 <= y.mean() < height)

    def is_at_edge(self, line: int) -> bool:
        """Return True for a line whose cells reach over the upper or lower edge of the picture."""
        y = self.corners[line][..., 1]
        return bool(y.min() < 0 or y.max() > self.size[0])

    def odds(self) -> list[Floats]:
        """Return the log odds that each cell of each line is inked, clipped to -6 to 6.

        Ink is a dot of 3 by 3 pixels, or as much ink along 9 pixels of a row: a thin dash.
        """
        edge, width = SLACK + 1, CELL_WIDTH + 2 * SLACK
        odds = []
        for line in self.pictures:
            starts = range(0, line.shape[1] - width + 1, CELL_WIDTH)
            cells = np.stack([line[:, start : start + width] for start in starts])
            dots = ndimage.uniform_filter(cells, (1, 3, 3))[:, edge:-edge, edge + 1 : -edge - 1]
            hairs = ndimage.uniform_filter(cells, (1, 1, 9))[:, edge:-edge, edge + 4 : -edge - 4]
            darkest = np.maximum(dots.max(axis=(1, 2)), hairs.max(axis=(1, 2)))
            odds.append(np.clip(20 * (darkest.astype(float) - _INKED), -6, 6))
        return odds


def _lines(points: Points, level: Floats) -> list[tuple[float, float]]:
    """Return top and bottom of each line of text, in pixels of ``level``.

    ``level`` is the height of each point after the slope is taken out, constant along a line. A row
    belongs to a line where some stretch of it, a character or two wide, is as dense as type; a line
    with a single digit is found, too.
    """
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
    is_inked = dense > grain + 0.2 * (typical - grain)
    edges = np.flatnonzero(np.diff(np.r_[0, is_inked.astype(int), 0]))
    return [(low + top, low + bottom) for top, bottom in edges.reshape(-1, 2)]


def _pitch(xs: list[Floats], height: float, span: float) -> float:
    """Return the period of the gaps between characters in pixels, 0 where there is none.

    The period maximizes the summed power spectrum of the lines' gaps. The ink itself has other
    periods: most digits have a stroke at each side of their cell.
    """
    size, low = 1 << 15, min(float(x.min()) for x in xs)
    gaps = [np.bincount((2 * (_gaps(x, height) - low)).astype(int), minlength=2) for x in xs]
    power = sum(np.abs(np.fft.rfft(gap, size)) ** 2 / gap.sum() for gap in gaps)
    first, last = (int(2 * height * part) for part in _PITCHES)
    first = max(first, int(2 * span / _MAX_COLUMNS))
    chosen = np.arange(size // last, size // max(first, 2) + 1)
    return float(size / chosen[np.argmax(np.asarray(power)[chosen])] / 2) if len(chosen) else 0.0


def _terms(x: Floats, y: Floats, span: float) -> Floats:
    """Return the terms 1, x, y, xy, x², y² of the bend of the columns: shape (6, points).

    x and y in units of ``span``, the picture's longer side.
    """
    x, y = x / span, y / span
    return np.stack([np.ones_like(x), x, y, x * y, x * x, y * y])


def _gaps(x: Floats, pitch: float) -> Floats:
    """Return the places along a line, in pixels, that no ink crosses: the gaps between characters.

    Gaps as wide as a blank are left out: they do not show where cells begin.
    """
    step = max(pitch / 24, 0.5)
    low = x.min()
    counts = np.bincount(((x - low) / step).astype(int)).astype(float)
    empty = counts < 0.12 * np.percentile(counts[counts > 0], 80)
    edges = np.flatnonzero(np.diff(np.r_[0, empty.astype(int), 0])).reshape(-1, 2)
    gaps = [np.arange(start, stop) for start, stop in edges if stop - start < 0.75 * pitch / step]
    return low + (np.concatenate(gaps) + 0.5) * step if gaps else np.array([low])


class _Phasors(NamedTuple):
    """Gaps of a page's lines, one complex number per piece of a line of `_GAP_STRETCH` pitches.

    ``sums`` are Σ exp(2πi x / pitch) over the piece's gaps x: the argument says where the gaps lie
    within a pitch, the modulus how many there are. ``terms``, shape (6, pieces): `_terms` there.
    """

    sums: NDArray[np.complex128]
    terms: Floats

    def shift(self, bend: Floats, pitch: float) -> NDArray[np.complex128]:
        """Return the sums after the columns were moved by a bend."""
        sums: NDArray[np.complex128] = self.sums * np.exp(2j * np.pi / pitch * bend @ self.terms)
        return sums


def _gap_phasors(xs: list[Floats], ys: list[Floats], pitch: float, span: float) -> _Phasors:
    """Return the phasors of the gaps in lines of text with inked points ``xs``, ``ys``."""
    sums, places = [], []
    width = _GAP_STRETCH * pitch
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


def _fit_bend(phasors: _Phasors, pitch: float, span: float) -> tuple[Floats, float]:
    """Return the bend that brings the cells' edges to whole pitches, and the clarity then.

    The bend holds the coefficients b of `_terms` in pixels: a point x moves to x + b · terms. It
    maximizes the clarity |Σ z exp(2πi b · terms / pitch)| / Σ |z| over the phasors z, which is 1
    where every gap lies at the same place of its cell. The function has many local maxima, one a
    pitch or so, hence a search on a lattice before the refinement.
    """
    bend = _refine_bend(_search_bend(phasors, pitch, span), phasors, pitch)
    total = phasors.shift(bend, pitch).sum()
    bend[0] -= float(np.angle(total)) / (2 * np.pi) * pitch
    return bend, float(np.abs(total) / np.abs(phasors.sums).sum())


def _search_bend(phasors: _Phasors, pitch: float, span: float) -> Floats:
    """Return the clearest bend on a lattice of slant, stretch, keystone and bow.

    The four are searched together: with any of them wrong by a few pitches, no value of the others
    gives clear columns. Keystone and bow are penalized with `_STRAIN`.
    """
    turn = 2j * np.pi / pitch
    step = 0.3 * pitch
    slants, stretches, keystones, bows = (
        np.arange(-reach * span, reach * span, width)
        for reach, width in ((0.1, step), (0.04, step), (0.15, 2 * step), (0.06, 4 * step))
    )
    curves = np.array([(keystone, bow) for keystone in keystones for bow in bows - bows.mean()])
    chosen = np.argsort(-np.abs(phasors.sums))[:_MAX_COARSE]
    sums, terms = phasors.sums[chosen], phasors.terms[:, chosen]
    # in single precision, for speed: it only starts the refinement
    by_slant = np.exp(turn * np.outer(slants, terms[2])).astype(np.complex64)
    by_stretch = np.exp(turn * np.outer(stretches, terms[1])).T.astype(np.complex64)
    by_curve = (sums * np.exp(turn * curves @ terms[3:5])).astype(np.complex64)
    # some curves at once: threads cost more than products of small matrices
    chunks = np.split(by_curve, range(_CURVES_AT_ONCE, len(by_curve), _CURVES_AT_ONCE))
    clarity = np.concatenate(
        [
            np.abs((rows[:, None] * by_slant).reshape(-1, len(chosen)) @ by_stretch).reshape(
                len(rows), len(slants), len(stretches)
            )
            for rows in chunks
        ]
    )
    clarity /= np.abs(sums).sum()
    clarity -= _STRAIN * np.abs(curves).sum(axis=1)[:, None, None] / pitch
    curve, slant, stretch = np.unravel_index(int(np.argmax(clarity)), clarity.shape)
    return np.array([0, stretches[stretch], slants[slant], *curves[curve], 0])


def _refine_bend(bend: Floats, phasors: _Phasors, pitch: float) -> Floats:
    """Return a bend improved by reweighted least squares.

    The residual of a piece is the phase of its phasor against their sum, in pixels. Weights fall
    off as exp(-(residual / reach)²), so that a piece that is off by a good part of a pitch hardly
    counts; `_RIDGE` keeps coefficients that the page does not determine at their values.
    """
    terms, weights = phasors.terms, np.abs(phasors.sums)
    for reach in _REACHES:
        moved = phasors.shift(bend, pitch)
        off = np.angle(moved * np.conj(moved.sum())) / (2 * np.pi) * pitch
        sure = weights * np.exp(-((off / (reach * pitch)) ** 2))
        ridge = np.diag(_RIDGE) * sure.sum()
        bend = bend - np.linalg.solve((terms * sure) @ terms.T + ridge, (terms * sure) @ off)
    return bend


def grids_of(ink: Image, points: Points, turns: int) -> list[Grid]:
    """Return the grids of a page turned to the left: one, or one for each column of printouts.

    Parameters
    ----------
    ink : ndarray
        Ink of the page as it lies, 0 to 1.
    points : Points
        Inked places of the page as it lies.
    turns : int
        Quarter turns to the left that set the page upright.
    """
    ink = np.ascontiguousarray(np.rot90(ink, turns))
    points = points.turn(turns)
    slope, keystone = slopes(points)
    grids = [_grid(ink, part, slope, keystone, turns) for part in _columns(points, slope)]
    return [grid for grid in grids if grid]


def _columns(points: Points, slope: float) -> list[Points]:
    """Return the ink left and right of a gap that runs down the page, or all in one.

    Either side of the widest such gap has at least `_MIN_COLUMN` of the ink.
    """
    across = points.x + slope * points.y
    step = points.span / 300
    counts = np.bincount(((across - across.min()) / step).astype(int)).astype(float)
    is_empty = counts < 0.05 * np.mean(counts)  # specks fall into gaps, too
    runs = np.flatnonzero(np.diff(np.r_[0, is_empty.astype(int), 0])).reshape(-1, 2)
    cumulative = np.cumsum(counts) / len(across)
    inner = [run for run in runs if _MIN_COLUMN < cumulative[run[0]] < 1 - _MIN_COLUMN]
    start, stop = max(inner, key=lambda run: float(run[1] - run[0]), default=(0, 0))
    if stop - start < _MIN_GUTTER:
        return [points]
    is_left = across < across.min() + step * (start + stop) / 2
    return [Points(points.x[side], points.y[side], points.span) for side in (is_left, ~is_left)]


def _grid(ink: Image, points: Points, slope: float, keystone: float, turns: int) -> Grid | None:
    """Return the grid of one column of text, None where no lines or no pitch are found.

    u and v are the levelled page's coordinates: x plus the bend of the columns, and y less the
    slope of the lines, in pixels of the picture.
    """
    x, y, span = points.x, points.y, points.span
    level = y - x * (slope + keystone * y / span)
    lines = _lines(points, level)
    height = float(np.median([bottom - top for top, bottom in lines])) if lines else 0.0
    lines = [(top, bottom) for top, bottom in lines if bottom - top > 0.25 * height]  # no specks
    if not 6 <= len(lines) <= _MAX_LINES or height < _MIN_HEIGHT:
        return None
    members = [np.flatnonzero((level >= top) & (level < bottom)) for top, bottom in lines]
    xs, ys = [x[inked] for inked in members], [y[inked] for inked in members]
    pitch = _pitch(xs, height, span)
    if not pitch:
        return None
    bend, clarity = _fit_bend(_gap_phasors(xs, ys, pitch, span), pitch, span)
    across = x + bend @ _terms(x, y, span)
    inked = across[np.concatenate(members)]
    origin = (np.floor(inked.min() / pitch) - 1) * pitch
    count = round(np.ceil(inked.max() / pitch) + 1 - origin / pitch)
    scale = CELL_WIDTH / pitch
    middles = np.array([(top + bottom) / 2 for top, bottom in lines])
    rise, drifts = _fit_rise(across - origin, level, middles, height, scale)
    middles = _distinct(middles + drifts, [len(inked) for inked in members], height)
    small = resize(ink, scale)
    tall = round(1.7 * height * scale)

    def place(u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return x and y in the picture of points u, v of the levelled page.

        The bend is a function of x and y, so x is found by fixed-point iteration.
        """
        x, y = u, v
        for _ in range(5):
            x = u - np.tensordot(bend, _terms(x, y, span), 1)
            y = v + x * (slope + keystone * y / span)
        t = (u - origin) * scale / _STRETCH
        y = y + np.tensordot(rise, _bows(t, v * scale / _STRETCH), 1)
        return x + ink.shape[1] / 2, y + ink.shape[0] / 2

    u = origin + (np.arange(count * CELL_WIDTH + 2 * SLACK) - SLACK + 0.5) / scale
    v = (np.arange(tall + 2 * SLACK) - SLACK - tall / 2 + 0.5) / scale
    pictures = [_resample(small, u, middle + v, place, scale) for middle in middles]
    edges, ends = origin + np.arange(count + 1) * pitch, np.array([-0.65, 0.65]) * height
    corners = [np.stack(place(*np.meshgrid(edges, middle + ends))).T for middle in middles]
    outermost = {0: lines[0], len(middles) - 1: lines[-1]}
    cut = frozenset(
        line for line, (top, bottom) in outermost.items() if bottom - top < _CUT * height
    )
    return Grid(pictures, middles / pitch, corners, pitch, clarity, ink.shape, turns, cut)


def _resample(
    small: Image,
    u: Floats,
    v: Floats,
    place: Callable[[Floats, Floats], tuple[Floats, Floats]],
    scale: float,
) -> Image:
    """Return the picture of a line at points u, v of the levelled page.

    ``place`` maps them to the picture, of which ``small`` is reduced by ``scale``. The map bends
    slowly: it is worked out at every eighth point.
    """
    coarse = np.linspace(0, len(u) - 1, len(u) // 8)
    across, down = place(*np.meshgrid(u[0] + coarse / scale, v[[0, -1]]))
    fine, coordinates = np.arange(len(u)), []
    for at in (down, across):
        top, foot = (np.interp(fine, coarse, row) * scale - 0.5 for row in at)
        coordinates.append(np.linspace(top, foot, len(v)))
    picture: Image = ndimage.map_coordinates(small, coordinates, order=1, cval=0.0)
    return picture


def _distinct(middles: Floats, weights: Sequence[int], height: float) -> Floats:
    """Return the middles of lines without those that overlap another with more ink.

    An underline, or the edge of a shaded band, overlaps the line that it belongs to.
    """
    distinct: list[float] = []
    for line in np.argsort(-np.array(weights), kind="stable").tolist():
        middle = float(middles[line])
        if all(abs(middle - accepted) > _OVERLAP * height for accepted in distinct):
            distinct.append(middle)
    return np.array(sorted(distinct))


def _bows(u: Floats, v: Floats) -> Floats:
    """Return the terms u, uv, u², u²v (a tenth of each) of the rise of lines: shape (4, ...)."""
    return np.stack([u, u * v, u * u, u * u * v]) / 10


def _fit_rise(
    across: Floats, level: Floats, middles: Floats, height: float, scale: float
) -> tuple[Floats, Floats]:
    """Return how the lines still rise and fall after levelling, in pixels.

    Each line is cut into stretches of `_STRETCH` resampled pixels. The vertical ink profile of a
    stretch is aligned with the mean profile of all; the shifts are then fitted by reweighted least
    squares with the smooth terms of `_bows`, common to all lines, and a constant for each line.

    Parameters
    ----------
    across, level : ndarray
        Place of each inked point along its line and down the levelled page, pixels.
    middles : ndarray
        Middle of each line, pixels of ``level``.
    height, scale : float
        Height of a line in pixels, and resampled pixels per pixel.

    Returns
    -------
    rise : ndarray, shape (4,)
        Coefficients of `_bows`.
    drifts : ndarray, shape (lines,)
        Constant of each line.
    """
    reach = 9  # largest shift tried, resampled pixels
    half = int(0.85 * height * scale) + reach
    stretches = np.maximum((across * scale / _STRETCH).astype(int), 0)
    profiles, places = [], []
    for line, middle in enumerate(middles):
        down = np.floor((level - middle) * scale).astype(int) + half
        is_near = (down >= 0) & (down < 2 * half)
        counts = np.zeros((stretches.max() + 1, 2 * half))
        np.add.at(counts, (stretches[is_near], down[is_near]), 1.0)
        counts = ndimage.uniform_filter1d(counts, 3, axis=1)
        for stretch in np.flatnonzero(counts[:, reach:-reach].sum(axis=1) > 40):
            profiles.append(counts[stretch] / np.linalg.norm(counts[stretch]))
            places.append((line, stretch + 0.5, middle * scale / _STRETCH))
    if not profiles:
        return np.zeros(4), np.zeros(len(middles))
    all_profiles, at = np.array(profiles), np.array(places)
    size = 2 * half - 2 * reach
    moves = np.zeros(len(all_profiles), int)
    for _ in range(3):
        mean = np.mean(
            [row[reach + m : reach + m + size] for row, m in zip(all_profiles, moves, strict=True)],
            0,
        )
        fits = np.stack(
            [all_profiles[:, k : k + size] @ mean for k in range(2 * reach + 1)], axis=1
        )
        moves = np.argmax(fits, axis=1) - reach
    offsets = moves - np.median(moves)
    terms = np.vstack([_bows(at[:, 1], at[:, 2]), np.eye(len(middles))[:, at[:, 0].astype(int)]])
    weights = np.ones(len(offsets))
    for _ in range(6):  # what is far off counts less
        normal = (terms * weights) @ terms.T + 1e-3 * np.eye(len(terms))
        rise = np.linalg.solve(normal, (terms * weights) @ offsets)
        weights = 1 / (1 + ((offsets - rise @ terms) / 1.5) ** 2)
    return rise[:4] / scale, rise[4:] / scale
