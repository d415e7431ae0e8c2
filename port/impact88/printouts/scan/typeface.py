"""The typeface of a page: the mean glyph of each character, made of the page's own cells.

Labels need no reading: they are known text at known places. The characters of numbers get their
first names from small prototypes of digits in a few typefaces ("styles").
"""

from collections.abc import Sequence
from functools import lru_cache
from importlib import resources
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import squareform

from .grid import CELL_WIDTH, SLACK, Grid
from .ink import Floats
from .layout import Place, Sheet

Vectors = NDArray[np.float32]
BLANK = " "
NUMERIC = "0123456789.-"
READABLE = f"{NUMERIC},E{BLANK}"
"""Characters of a number's cell: a reply has commas, a large number an exponent."""
STRENGTHS = (0.4, 1.3)
"""Smallest and largest strength of a cell's ink, relative to the page's."""
_ROUNDS = 2
"""Iterations of shifting cells onto the means that they form."""
_SHIFTS = [(y, x) for y in range(2 * SLACK + 1) for x in range(2 * SLACK + 1)]
CAPITALS = (4, 20)
"""Rows of a known digit's picture between which capitals stand; below is as much as above."""
_READINGS = 2
"""Iterations of reading the cells of numbers: the first names are figures alone, and a comma of a
reply is one of them."""
_STYLES = 3
"""Number of styles that a page may mix: a printer's type lies between those that are known."""
_MAX_SPREAD = 1.6
"""Largest mean distance within a group of cells, in units of the 75th percentile of the distances
between equal letters of the page's labels. The widest pairs of 11 pages had 1.2 to 2.5, two digits
mostly 2 to 4 and once 1.5; labels laid out wrongly hardly change the percentile."""
_MAX_UNLIKE = 0.13
"""Largest `unlikeness` of a cell to a digit of a known style that it is taken for: 16 digits drawn
in another font had 0.01 to 0.12; 60 with a blot, a stroke or a scratch 0.09 and more, one 0.05."""
_MIN_RATIO = 2.5
"""Smallest ratio of the `unlikeness` to the predicted digit and to the one that the cell is taken
for: digits in another font had 2.7 to 27; those with a blot, a stroke or a scratch 1 to 2.2."""
_REPEAT_PENALTY = 0.1
"""Penalty on a character's second group of cells, per cell, in units of `unlikeness`."""


class Sample(NamedTuple):
    """Cells of a page at every shift.

    Attributes
    ----------
    vectors : ndarray, shape (cells, shifts, pixels)
    norms : ndarray, shape (cells, shifts)
        Squared norms of the vectors.
    shape : tuple of int
        Height and width of a cell, pixels.
    """

    vectors: Vectors
    norms: Vectors
    shape: tuple[int, int]

    def at(self, chosen: NDArray[np.intp]) -> "Sample":
        """Return some of the cells, by index."""
        return Sample(self.vectors[chosen], self.norms[chosen], self.shape)


def sample_of(grid: Grid, places: Sequence[Place]) -> Sample:
    """Return the cells at ``places``; those off the grid are blank."""
    height, width = grid.pictures[0].shape[0] - 2 * SLACK, CELL_WIDTH
    windows = np.zeros((len(places), height + 2 * SLACK, width + 2 * SLACK), np.float32)
    for row, place in zip(windows, places, strict=True):
        picture = grid.pictures[place.line]
        columns = place.cell * CELL_WIDTH + np.arange(row.shape[1])
        is_on_grid = (columns >= 0) & (columns < picture.shape[1])
        row[:, is_on_grid] = picture[:, columns[is_on_grid]]
    vectors = np.stack(
        [windows[:, y : y + height, x : x + width].reshape(len(places), -1) for y, x in _SHIFTS], 1
    )
    return Sample(vectors, np.einsum("nsp,nsp->ns", vectors, vectors), (height, width))


def distances(sample: Sample, means: Vectors) -> tuple[Floats, Floats]:
    """Return the squared distance of each cell from each mean glyph, and the strength of its ink.

    For a cell x[s] at shift s and a mean m the distance is the minimum over shifts s and strengths
    a within `STRENGTHS` of |x[s] - a m|²: ribbons run dry within a line.

    Returns
    -------
    distances, strengths : ndarray, shape (cells, means)
    """
    count, shifts, pixels = sample.vectors.shape
    inner_products = (sample.vectors.reshape(-1, pixels) @ means.T).reshape(
        count, shifts, len(means)
    )
    energy = np.maximum(np.einsum("mp,mp->m", means, means), 1e-6)
    strength = np.clip(inner_products / energy, *STRENGTHS)
    squares = sample.norms[:, :, None] - 2 * strength * inner_products + strength**2 * energy
    best = np.argmin(squares, axis=1)[:, None, :]
    least = np.take_along_axis(squares, best, axis=1)[:, 0].astype(float)
    return np.maximum(least, 0.0), np.take_along_axis(strength, best, axis=1)[:, 0].astype(float)


class Typeface(NamedTuple):
    """Mean glyphs of a page.

    Attributes
    ----------
    characters : str
        The characters in order.
    means : ndarray, shape (characters, pixels)
    counts : ndarray, shape (characters,)
        Number of cells of which each mean was made.
    names : ndarray, shape (cells,)
        Index of each cell's character, -1 for cells that belong to none.
    members : ndarray, shape (cells, pixels)
        The cells, shifted onto their means.
    shape : tuple of int
        Height and width of a glyph, pixels.
    """

    characters: str
    means: Vectors
    counts: NDArray[np.intp]
    names: NDArray[np.intp]
    members: Vectors
    shape: tuple[int, int]

    def between(self) -> Floats:
        """Return the squared distances of the means from each other and, last, from blank paper.

        Either mean may have the strength that fits best; the smaller distance counts.
        """
        glyphs = np.vstack([self.means, np.zeros_like(self.means[:1])])
        norms = np.einsum("mp,mp->m", glyphs, glyphs)
        to_means, _ = distances(Sample(glyphs[:, None], norms[:, None], (0, 0)), glyphs)
        least: Floats = np.minimum(to_means, to_means.T)
        return least

    def without(self, cell: int) -> Vectors | None:
        """Return the mean of a cell's own class, the cell left out; None if it is alone there."""
        name = self.names[cell]
        if name < 0 or self.counts[name] < 2:
            return None
        count = self.counts[name]
        mean: Vectors = (self.means[name] * count - self.members[cell]) / (count - 1)
        return mean


def typeface_of(sample: Sample, names: Sequence[str]) -> Typeface:
    """Return the mean glyph of each name; cells named "" belong to none.

    Cells are shifted onto their means, and the means made again, `_ROUNDS` times.
    """
    characters = "".join(sorted(set(names) - {"", BLANK}))
    index = np.array([characters.find(name or BLANK) for name in names])
    membership = (index == np.arange(len(characters))[:, None]).astype(np.float32)
    counts = membership.sum(axis=1).astype(int)

    def mean(members: Vectors) -> Vectors:
        return np.asarray(membership @ members / np.maximum(counts[:, None], 1), np.float32)

    members = sample.vectors[:, len(_SHIFTS) // 2]
    for _ in range(_ROUNDS):
        # each cell at the shift that fits the mean of its class
        means = mean(members)[np.maximum(index, 0)]
        inner = np.matmul(sample.vectors, means[:, :, None])[:, :, 0]
        best = np.argmin(sample.norms - 2 * inner, axis=1)
        members = sample.vectors[np.arange(len(index)), best]
    return Typeface(characters, mean(members), counts, index, members, sample.shape)


@lru_cache
def prototypes() -> tuple[str, Vectors]:
    """Return the known digits: characters, and glyphs (styles, characters, rows, columns).

    ``tests/support/digitstyles.py`` draws them and names their fonts.
    """
    with resources.files("impact88.printouts.scan").joinpath("digits.npz").open("rb") as file:
        archive = np.load(file)
        characters = "".join(archive["characters"].tolist())
        glyphs = archive["glyphs"].astype(np.float32) / 255
    return characters, ndimage.gaussian_filter(glyphs, (0, 0, 0.8, 0.8))


def _scaled_cells(sample: Sample, typeface: Typeface) -> Vectors:
    """Return cells scaled to the prototypes' height of capitals: shape (cells, rows, columns)."""
    height, width = sample.shape
    capitals = [typeface.characters.find(c) for c in "MABEIDTPUVXYKL" if c in typeface.characters]
    profile = typeface.means[capitals].reshape(-1, height, width).sum(axis=(0, 2))
    inked_rows = np.flatnonzero(profile > 0.25 * profile.max())
    top, foot = float(inked_rows[0]), float(inked_rows[-1] + 1)
    centred = sample.vectors[:, sample.vectors.shape[1] // 2].reshape(-1, height, width)
    first, last = CAPITALS
    scale = (foot - top) / (last - first)
    offset = top + (0.5 - first) * scale - 0.5
    normal: Vectors = ndimage.affine_transform(
        centred, [1, scale, 1], [0, offset, 0], (len(centred), first + last, width),
        order=1, mode="grid-constant",
    )  # fmt: skip
    return normal


def unlikeness(sample: Sample, typeface: Typeface, styles: int | None = _STYLES) -> Floats:
    """Return how unlike each cell is to each of `NUMERIC`, the best of the styles.

    Unlikeness is 1 - cos φ, with φ the angle between the two pictures as vectors, at the best
    shift: 0 for the same picture, 1 for nothing in common.

    Parameters
    ----------
    sample : Sample
    typeface : Typeface
        Gives the height of the page's capitals.
    styles : int or None
        Number of styles that are considered, those that fit the page best; None for all.

    Returns
    -------
    ndarray, shape (cells, characters)
    """
    characters, glyphs = prototypes()
    cells = ndimage.gaussian_filter(_scaled_cells(sample, typeface), (0, 0.5, 0.5))
    reach = 3
    padded = np.pad(cells, ((0, 0), (reach, reach), (reach, reach)))
    rows, width = glyphs.shape[2:]
    flat = glyphs.reshape(-1, rows * width)
    flat = flat / np.linalg.norm(flat, axis=1, keepdims=True)
    best = np.full((len(cells), len(flat)), -1.0)
    for y in range(0, 2 * reach + 1):
        for x in range(1, 2 * reach):
            shifted = padded[:, y : y + rows, x : x + width].reshape(len(cells), -1)
            norm = np.maximum(np.linalg.norm(shifted, axis=1, keepdims=True), 1e-3)
            best = np.maximum(best, shifted @ flat.T / norm)
    apart = 1 - best.reshape(len(cells), len(glyphs), len(characters))
    total = apart.min(axis=2).sum(axis=0)
    order = np.argsort(total)[:styles]
    unlike: Floats = apart[:, order].min(axis=1)
    return unlike


def foreign_digits(
    sample: Sample,
    typeface: Typeface,
    names: Sequence[str],
    is_alone: NDArray[np.bool_],
    is_far: NDArray[np.bool_],
) -> list[str]:
    """Return the digit other than the predicted that each cell is in a known style, or "".

    Parameters
    ----------
    sample : Sample
    typeface : Typeface
    names : sequence of str
        Predicted characters.
    is_alone : ndarray of bool
        Cells alone with their character: the most alike digit in the page's styles is returned.
    is_far : ndarray of bool
        Cells far from their mean: the digit must be alike in one of all styles, within
        `_MAX_UNLIKE`, and clearly more so than the predicted, by `_MIN_RATIO`.
    """
    digits = [""] * len(names)
    is_numeric = np.array([name in NUMERIC for name in names])
    for is_asked, styles, max_unlike, min_ratio in (
        (is_alone, _STYLES, 1.0, 1.0),
        (is_far, None, _MAX_UNLIKE, _MIN_RATIO),
    ):
        chosen = np.flatnonzero(is_asked & is_numeric)
        if len(chosen):
            unlike = unlikeness(sample.at(chosen), typeface, styles)
            for cell, row in zip(chosen.tolist(), unlike, strict=True):
                least = float(row.min())
                if least < max_unlike and least * min_ratio < row[NUMERIC.index(names[cell])]:
                    digits[cell] = NUMERIC[int(row.argmin())]
    return digits


def _pair_distances(sample: Sample) -> Floats:
    """Return the distances of cells from each other, relative to their energies: (cells, cells).

    The smaller of the two directions counts: a blot, or the strength of the ribbon, does not.
    """
    middle = sample.vectors.shape[1] // 2
    to_cells, _ = distances(sample, sample.vectors[:, middle])
    energy = sample.norms[:, middle] + 1e-6
    pairs: Floats = np.minimum(to_cells, to_cells.T) / np.sqrt(np.sqrt(np.outer(energy, energy)))
    np.fill_diagonal(pairs, 0)
    return pairs


def _name_clusters(sample: Sample, unlike: Floats, widest: float) -> NDArray[np.intp]:
    """Return a name for each cell, as an index of `NUMERIC`.

    Cells are clustered (average linkage, distances up to ``widest``); the clusters are assigned to
    characters with the least total `unlikeness`, each character once, or again with
    `_REPEAT_PENALTY`. So a 3 that is most like the 8 of every known style is a 3 where the page has
    another 8.
    """
    tree = linkage(squareform(_pair_distances(sample), checks=False), "average")
    widest = min([widest, *tree[: 1 - len(NUMERIC), 2][-1:]])  # a page has all digits, or nearly
    groups = fcluster(tree, widest, "distance") - 1
    members = (groups[None] == np.arange(groups.max() + 1)[:, None]).astype(float)
    sizes = members.sum(axis=1, keepdims=True)
    repeats = 1 + len(members) // len(NUMERIC)  # a name may be given again, at a price
    costs = [members @ unlike + repeat * _REPEAT_PENALTY * sizes for repeat in range(repeats + 1)]
    rows, columns = linear_sum_assignment(np.hstack(costs))
    names: NDArray[np.intp] = np.zeros(len(members), int)
    names[rows] = columns % len(NUMERIC)
    return np.asarray(names[groups])


def read_numbers(grid: Grid, sheets: Sequence[Sheet]) -> list[dict[str, Floats]]:
    """Return for each printout the cost of each of `READABLE` in each cell of its numbers.

    All printouts of a page share its typeface. Cells get first names by `_name_clusters`; the means
    of the named cells are then compared with all cells, `_READINGS` times.

    Returns
    -------
    list of dict of str to ndarray, shape (cells, characters)
        By name of the number: squared distance from the mean of the character less that from the
        nearest, in units of 0.6 of the page's usual distance; 0 for the likeliest character.
    """
    if not sheets:
        return []
    places: list[Place] = []
    names: list[str] = []
    chosen: list[int] = []
    numbers: list[tuple[int, str, slice]] = []
    for number, sheet in enumerate(sheets):
        for name, text, cells in (piece for row in sheet.rows.values() for piece in row.pieces):
            if name:
                start = len(chosen)
                chosen += range(len(places), len(places) + len(cells))
                numbers.append((number, name, slice(start, len(chosen))))
            places += cells
            names += text if len(text) == len(cells) else BLANK * len(cells)
    sample = sample_of(grid, places)
    of_numbers = sample.at(np.array(chosen))
    label_cells = np.array([k for k, name in enumerate(names) if name != BLANK])
    unlike = unlikeness(of_numbers, typeface_of(sample, names))
    # how far apart two cells of one character are on this page, as its labels show
    letters = np.array(names)[label_cells]
    is_same = np.triu(letters[:, None] == letters, 1)
    usual = (
        np.percentile(_pair_distances(sample.at(label_cells))[is_same], 75)
        if is_same.any()
        else 0.0
    )
    first = _name_clusters(of_numbers, unlike, _MAX_SPREAD * float(usual))
    for cell, k in zip(chosen, first, strict=True):
        names[cell] = NUMERIC[k]
    for _ in range(_READINGS):
        typeface = typeface_of(sample, names)
        to_means, strength = distances(of_numbers, typeface.means)
        weak = np.take_along_axis(strength, to_means.argmin(axis=1)[:, None], axis=1) ** 2
        costs = np.full((len(chosen), len(READABLE)), np.inf)
        for k, character in enumerate(READABLE):
            if (column := typeface.characters.find(character)) >= 0:
                costs[:, k] = to_means[:, column]
        costs[:, -1] = of_numbers.norms.min(axis=1)
        for cell, k in zip(chosen, costs.argmin(axis=1), strict=True):
            names[cell] = READABLE[k]
    least = costs.min(axis=1, keepdims=True)
    unit = max(float(np.median(least)) * 0.6, 1e-3)
    costs = (costs - least) / (unit * weak)
    return [
        {name: costs[part] for index, name, part in numbers if index == number}
        for number in range(len(sheets))
    ]
