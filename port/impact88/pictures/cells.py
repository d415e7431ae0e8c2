"""Cells of a page, and the page's own typeface: the mean of each character."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from importlib import resources
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import squareform

from .grid import CELL_WIDTH, SLACK, Grid
from .picture import Floats, Image

Vectors = NDArray[np.float32]
BLANK = " "
NUMERIC = "0123456789.-"
CHARACTERS = NUMERIC + "ABCDEFGHIKLMNOPRSTUVWXYabxy=()%*:,?+"
"""Characters of the printed page of which `known_glyphs` has pictures."""
STRENGTHS = (0.4, 1.3)  # smallest and largest strength of a cell's ink: ribbons run dry
INKED = 0.25  # darkness from which a cell is inked: of blank cells 1 in 1,000 is darker than 0.27
MIN_USUAL = 0.05  # usual distance of cells from their means, as a fraction of the mean's energy
MAX_SPREAD = 1.7  # mean distance in a group of equal digits, relative to that of equal letters
REPEAT_PENALTY = 0.1  # on a second group of cells with the same name, per cell


class Cells(NamedTuple):
    """Cells of a page at each shift.

    Parameters
    ----------
    vectors : ndarray, shape (cells, shifts, pixels)
    norms : ndarray, shape (cells, shifts)
        Squared norms of the vectors.
    odds : ndarray, shape (cells,)
        Log odds that the cell is inked, -6 to 6.
    shape : tuple of int
        Height and width of a cell, pixels.
    """

    vectors: Vectors
    norms: Vectors
    odds: Floats
    shape: tuple[int, int]

    def at(self, chosen: NDArray[np.intp]) -> Cells:
        """Return some of the cells, by index."""
        return self._replace(
            vectors=self.vectors[chosen], norms=self.norms[chosen], odds=self.odds[chosen]
        )

    def centred(self) -> Vectors:
        """Return the vectors of the cells where the grid has them."""
        return self.vectors[:, self.vectors.shape[1] // 2]


def cells_of(grid: Grid) -> Cells:
    """Return all cells of a grid, line by line."""
    width = CELL_WIDTH + 2 * SLACK
    windows = np.stack(
        [
            strip[:, cell * CELL_WIDTH : cell * CELL_WIDTH + width]
            for strip in map(grid.strip, range(len(grid.middles)))
            for cell in range(grid.count)
        ]
    )
    return _shifted_cells(windows)


def _shifted_cells(windows: Image) -> Cells:
    """Return the cells in the middle of windows that are wider by `SLACK` on each side."""
    count, tall, wide = windows.shape
    shape = tall - 2 * SLACK, wide - 2 * SLACK
    views = np.lib.stride_tricks.sliding_window_view(windows, shape, (1, 2))
    vectors = views.reshape(count, (2 * SLACK + 1) ** 2, -1)
    norms = np.einsum("nsp,nsp->ns", vectors, vectors)
    return Cells(vectors, norms, _odds(windows), shape)


def _odds(windows: Image) -> Floats:
    """Return the log odds that cells are inked: by a dot of 3 × 3 pixels, or as much ink along 9
    pixels of a row, a thin dash."""
    edge = SLACK + 1
    dots = ndimage.uniform_filter(windows, (1, 3, 3))[:, edge:-edge, edge + 1 : -edge - 1]
    hairs = ndimage.uniform_filter(windows, (1, 1, 9))[:, edge:-edge, edge + 4 : -edge - 4]
    darkest = np.maximum(dots.max(axis=(1, 2)), hairs.max(axis=(1, 2))).astype(float)
    return np.asarray(np.clip(20 * (darkest - INKED), -6, 6))


def distances(cells: Cells, means: Vectors) -> Floats:
    """Return the squared distance of each cell from each mean, shape (cells, means).

    It is the least of |x[s] - a m|² over shifts s of the cell x and strengths a of the mean m
    within `STRENGTHS`.
    """
    count, shifts, pixels = cells.vectors.shape
    inner = (cells.vectors.reshape(-1, pixels) @ means.T).reshape(count, shifts, len(means))
    return _least_squares(cells.norms, inner, np.einsum("mp,mp->m", means, means))


def _least_squares(norms: Vectors, inner: Vectors, energy: Vectors) -> Floats:
    """Return the least squared distances of cells from means with some inner products."""
    strength = np.clip(inner / np.maximum(energy, 1e-6), *STRENGTHS)
    squares = norms[:, :, None] + strength * (strength * energy - 2 * inner)
    least: Floats = np.maximum(squares.min(axis=1).astype(float), 0)
    return least


class Typeface(NamedTuple):
    """Means of a page's characters.

    Parameters
    ----------
    names : str
        The characters in order.
    means : ndarray, shape (names, pixels)
    counts : ndarray, shape (names,)
        Cells of which each mean was made.
    owners : ndarray, shape (cells,)
        Each cell's character, -1 for none.
    members : ndarray, shape (cells, pixels)
        The cells shifted onto their means.
    shifts : ndarray, shape (cells, 2)
        Those shifts, down and right, pixels of a cell.
    shape : tuple of int
        Height and width of a cell, pixels.
    """

    names: str
    means: Vectors
    counts: NDArray[np.intp]
    owners: NDArray[np.intp]
    members: Vectors
    shifts: NDArray[np.intp]
    shape: tuple[int, int]

    @property
    def energy(self) -> Floats:
        """Squared norm of each mean."""
        energy: Floats = np.einsum("mp,mp->m", self.means, self.means).astype(float)
        return np.maximum(energy, 1e-3)

    def distances(self, cells: Cells) -> Floats:
        """Return the distances of its cells from the means, shape (cells, names).

        A cell is left out of the mean of its own character, unless it is alone.
        """
        to = distances(cells, self.means)
        counts = self.counts.astype(np.float32)[self.owners][:, None]
        rests = (self.means[self.owners] * counts - self.members) / np.maximum(counts - 1, 1)
        inner = np.matmul(cells.vectors, rests[:, :, None])
        energy = np.einsum("np,np->n", rests, rests)[:, None, None]
        is_left_out = (self.owners >= 0) & (counts[:, 0] > 1)
        own = _least_squares(cells.norms, inner, energy)[is_left_out, 0]
        to[is_left_out, self.owners[is_left_out]] = own
        return to

    def usual_distance(self, to: Floats) -> float:
        """Return the median of some distances of its cells from their own means, relative to the
        energy of these."""
        chosen = np.flatnonzero((self.owners >= 0) & (self.counts[self.owners] > 1))
        own = self.owners[chosen]
        return max(float(np.median(to[chosen, own] / self.energy[own])), MIN_USUAL)

    def between(self) -> Floats:
        """Return the squared distance of each mean from each other, and from blank paper last."""
        glyphs = np.vstack([self.means, np.zeros_like(self.means[:1])])
        pictures = glyphs.reshape(-1, *self.shape)
        slack = (SLACK, SLACK)
        cells = _shifted_cells(np.pad(pictures, ((0, 0), slack, slack)))
        return np.maximum(distances(cells, glyphs), 1e-3)


def typeface_of(cells: Cells, names: Sequence[str]) -> Typeface:
    """Return the mean of each name; cells named "" or blank belong to none."""
    characters = "".join(sorted(set(names) - {"", BLANK}))
    index = np.array([characters.find(name) if name else -1 for name in names])
    membership = (index == np.arange(len(characters))[:, None]).astype(np.float32)
    counts = membership.sum(axis=1).astype(int)

    def mean(members: Vectors) -> Vectors:
        return np.asarray(membership @ members / np.maximum(counts[:, None], 1), np.float32)

    members = cells.centred()
    for _ in range(2):  # each cell at the shift that fits the mean of its character
        means = mean(members)[np.maximum(index, 0)]
        inner = np.matmul(cells.vectors, means[:, :, None])[:, :, 0]
        best = np.argmin(cells.norms - 2 * inner, axis=1)
        members = cells.vectors[np.arange(len(index)), best]
    shifts = np.stack(np.divmod(best, 2 * SLACK + 1), axis=1) - SLACK
    return Typeface(characters, mean(members), counts, index, members, shifts, cells.shape)


@lru_cache
def known_glyphs() -> tuple[str, Vectors]:
    """Return known glyphs: characters, and pictures (styles, characters, rows, columns).

    ``tests/support/typestyles.py`` draws them and names their fonts.
    """
    with resources.files("impact88.pictures").joinpath("digits.npz").open("rb") as file:
        archive = np.load(file)
        characters = "".join(archive["characters"].tolist())
        glyphs = archive["glyphs"].astype(np.float32) / 255
    return characters, ndimage.gaussian_filter(glyphs, (0, 0, 0.8, 0.8))


def unlikeness(cells: Cells) -> Floats:
    """Return how unlike inked cells are to each of `CHARACTERS` in the known style it is likest in.

    It is 1 - cos φ, with φ the angle between the two pictures as vectors, at the best shift: 0 for
    the same picture, 1 for nothing in common.

    Parameters
    ----------
    cells : Cells
        The inked cells of a page.

    Returns
    -------
    ndarray, shape (cells, characters)
    """
    _, glyphs = known_glyphs()
    styles, characters, tall, width = glyphs.shape
    flat = glyphs.reshape(styles * characters, -1)
    flat = flat / np.linalg.norm(flat, axis=1, keepdims=True)
    rows = _scaled_rows(cells, glyphs)
    padded = np.pad(rows, ((0, 0), (3, 3), (1, 1)))
    best = np.full((len(rows), len(flat)), -1, np.float32)
    for y, x in product(range(7), range(3)):
        shifted = padded[:, y : y + tall, x : x + width].reshape(len(rows), -1)
        norm = np.maximum(np.linalg.norm(shifted, axis=1, keepdims=True), 1e-3)
        np.maximum(best, shifted @ flat.T / norm, out=best)
    likeness = best.reshape(len(rows), styles, characters).max(axis=1)
    unlike: Floats = (1 - likeness).astype(float)
    return unlike


def _scaled_rows(cells: Cells, glyphs: Vectors) -> Vectors:
    """Return cells scaled to the height of known glyphs: shape (cells, rows, columns)."""
    height, width = cells.shape
    pictures = cells.centred().reshape(-1, height, width)
    top, foot = _inked_rows(pictures)
    known_top, known_foot = _inked_rows(glyphs)
    scale = (foot - top) / (known_foot - known_top)
    offset = top + (0.5 - known_top) * scale - 0.5
    rows: Vectors = ndimage.affine_transform(
        pictures,
        [1, scale, 1],
        [0, offset, 0],
        (len(pictures), *glyphs.shape[-2:]),
        order=1,
        mode="grid-constant",
    )
    smooth: Vectors = ndimage.gaussian_filter(rows, (0, 0.5, 0.5))
    return smooth


def _inked_rows(pictures: Vectors) -> tuple[int, int]:
    """Return the first row of capitals in pictures of cells, and the row below their foot."""
    profile = pictures.reshape(-1, *pictures.shape[-2:]).sum(axis=(0, 2))
    inked = np.flatnonzero(profile > 0.25 * profile.max())
    return int(inked[0]), int(inked[-1] + 1)


def pair_distances(cells: Cells) -> Floats:
    """Return the distances of cells from each other, relative to their energies.

    The smaller of the two directions counts: a blot, or the strength of the ribbon, does not.
    """
    to_cells = distances(cells, cells.centred())
    energy = cells.norms[:, cells.norms.shape[1] // 2] + 1e-6
    pairs: Floats = np.minimum(to_cells, to_cells.T) / np.sqrt(np.sqrt(np.outer(energy, energy)))
    np.fill_diagonal(pairs, 0)
    return pairs


def name_groups(cells: Cells, unlike: Floats, usual: float) -> list[str]:
    """Return a name of `NUMERIC` for each cell of numbers.

    Cells are clustered (average linkage); the clusters are assigned to characters with the least
    total unlikeness, each character once, or again at a price. So a 3 that is most like the 8 of
    every known typeface is a 3 where the page has another 8.

    Parameters
    ----------
    cells : Cells
        Cells of numbers.
    unlike : ndarray, shape (cells, characters of `NUMERIC`)
        Their `unlikeness`.
    usual : float
        Distance of equal letters of the page.
    """
    if len(cells.vectors) < 2:
        return [NUMERIC[k] for k in unlike.argmin(axis=1)]
    tree = linkage(squareform(pair_distances(cells), checks=False), "average")
    widest = min([MAX_SPREAD * usual, *tree[: 1 - len(NUMERIC), 2][-1:]])
    groups = fcluster(tree, widest, "distance") - 1
    members = (groups[None] == np.arange(groups.max() + 1)[:, None]).astype(float)
    sizes = members.sum(axis=1, keepdims=True)
    first = members @ unlike
    repeats = 1 + len(members) // len(NUMERIC)
    rows, columns = linear_sum_assignment(
        np.hstack([first, *[first + REPEAT_PENALTY * sizes] * repeats])
    )
    names = np.zeros(len(members), int)
    names[rows] = columns % len(NUMERIC)
    return [NUMERIC[k] for k in names[groups]]
