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
CAPITALS = (4, 20)  # rows of a known glyph between which capitals are
SHIFTS = [(y, x) for y in range(2 * SLACK + 1) for x in range(2 * SLACK + 1)]
STRENGTHS = (0.4, 1.3)  # smallest and largest strength of a cell's ink: ribbons run dry
INKED = 0.25  # darkness from which a cell is inked: of blank cells 1 in 1,000 is darker than 0.27
STYLES = 3  # known typefaces that a page may mix: its own lies between those
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
    tall = windows.shape[1] - 2 * SLACK
    vectors = np.stack(
        [windows[:, y : y + tall, x : x + CELL_WIDTH].reshape(len(windows), -1) for y, x in SHIFTS],
        axis=1,
    )
    norms = np.einsum("nsp,nsp->ns", vectors, vectors)
    return Cells(vectors, norms, _odds(windows), (tall, CELL_WIDTH))


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
    energy = np.maximum(np.einsum("mp,mp->m", means, means), 1e-6)
    strength = np.clip(inner / energy, *STRENGTHS)
    squares = cells.norms[:, :, None] - 2 * strength * inner + strength**2 * energy
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

    def without(self, cell: int) -> Vectors | None:
        """Return the mean of a cell's character without the cell, None if it is alone."""
        name = self.owners[cell]
        if name < 0 or self.counts[name] < 2:
            return None
        count = self.counts[name]
        mean: Vectors = (self.means[name] * count - self.members[cell]) / (count - 1)
        return mean

    def between(self) -> Floats:
        """Return the squared distance of each mean from each other, and from blank paper last."""
        glyphs = np.vstack([self.means, np.zeros_like(self.means[:1])])
        height, width = self.shape
        pictures = glyphs.reshape(-1, height, width)
        padded = np.pad(pictures, ((0, 0), (SLACK, SLACK), (SLACK, SLACK)))
        vectors = np.stack(
            [padded[:, y : y + height, x : x + width].reshape(len(glyphs), -1) for y, x in SHIFTS],
            axis=1,
        )
        norms = np.einsum("nsp,nsp->ns", vectors, vectors)
        cells = Cells(vectors, norms, np.zeros(len(glyphs)), self.shape)
        return np.maximum(distances(cells, glyphs), 1e-3)


def typeface_of(cells: Cells, names: Sequence[str]) -> Typeface:
    """Return the mean of each name; cells named "" or blank belong to none."""
    characters = "".join(sorted(set(names) - {"", BLANK}))
    index = np.array([characters.find(name) if name else -1 for name in names])
    membership = (index == np.arange(len(characters))[:, None]).astype(np.float32)
    counts = membership.sum(axis=1).astype(int)

    def mean(members: Vectors) -> Vectors:
        return np.asarray(membership @ members / np.maximum(counts[:, None], 1), np.float32)

    best = np.full(len(index), len(SHIFTS) // 2)
    members = cells.vectors[:, len(SHIFTS) // 2]
    for _ in range(2):  # each cell at the shift that fits the mean of its character
        means = mean(members)[np.maximum(index, 0)]
        inner = np.matmul(cells.vectors, means[:, :, None])[:, :, 0]
        best = np.argmin(cells.norms - 2 * inner, axis=1)
        members = cells.vectors[np.arange(len(index)), best]
    shifts = np.array(SHIFTS)[best] - SLACK
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
    """Return how unlike inked cells are to each of `CHARACTERS` in the known styles.

    It is 1 - cos φ, with φ the angle between the two pictures as vectors, at the best shift, in the
    likeliest of the `STYLES` styles that fit the page best: 0 for the same picture, 1 for nothing
    in common.

    Parameters
    ----------
    cells : Cells
        The inked cells of a page.

    Returns
    -------
    ndarray, shape (cells, characters)
    """
    _, glyphs = known_glyphs()
    rows = _scaled_rows(cells)
    flat = glyphs.reshape(len(glyphs), glyphs.shape[1], -1)
    flat = flat / np.linalg.norm(flat, axis=2, keepdims=True)
    sample = rows[:: max(1, len(rows) // 40)]
    fits = _style_distances(sample, flat).min(axis=2).sum(axis=0)
    least: Floats = (
        _style_distances(rows, flat[np.argsort(fits)[:STYLES]]).min(axis=1).astype(float)
    )
    return least


def _style_distances(rows: Vectors, styles: Vectors) -> Vectors:
    """Return 1 - cos φ of each cell, style and glyph at the best shift."""
    tall, width = sum(CAPITALS), CELL_WIDTH
    glyphs = styles.reshape(-1, tall * width).T
    padded = np.pad(rows, ((0, 0), (3, 3), (1, 1)))
    best = np.full((len(rows), glyphs.shape[1]), -1, np.float32)
    for y, x in product(range(7), range(3)):
        shifted = padded[:, y : y + tall, x : x + width].reshape(len(rows), -1)
        norm = np.maximum(np.linalg.norm(shifted, axis=1, keepdims=True), 1e-3)
        np.maximum(best, shifted @ glyphs / norm, out=best)
    return 1 - best.reshape(len(rows), len(styles), -1)


def _scaled_rows(cells: Cells) -> Vectors:
    """Return cells scaled to the height of the known capitals: shape (cells, rows, columns)."""
    height, width = cells.shape
    pictures = cells.vectors[:, len(SHIFTS) // 2].reshape(-1, height, width)
    profile = pictures.sum(axis=(0, 2))
    inked = np.flatnonzero(profile > 0.25 * profile.max())
    top, foot = float(inked[0]), float(inked[-1] + 1)
    scale = (foot - top) / (CAPITALS[1] - CAPITALS[0])
    offset = top + (0.5 - CAPITALS[0]) * scale - 0.5
    rows: Vectors = ndimage.affine_transform(
        pictures,
        [1, scale, 1],
        [0, offset, 0],
        (len(pictures), sum(CAPITALS), width),
        order=1,
        mode="grid-constant",
    )
    smooth: Vectors = ndimage.gaussian_filter(rows, (0, 0.5, 0.5))
    return smooth


def pair_distances(cells: Cells) -> Floats:
    """Return the distances of cells from each other, relative to their energies.

    The smaller of the two directions counts: a blot, or the strength of the ribbon, does not.
    """
    middle = len(SHIFTS) // 2
    to_cells = distances(cells, cells.vectors[:, middle])
    energy = cells.norms[:, middle] + 1e-6
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
