"""The type a page is written in: the mean glyph of each character, made of the page's own cells.

Labels need no reading: they are known text at known places. The characters of numbers have their
first names from small prototypes of a few styles of type.
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
"""What may stand in a number's cell: a reply has commas, a large number an exponent."""
STRENGTHS = (0.4, 1.3)
"""Between these the ink of a cell may be as strong as the page's."""
_ROUNDS = 2
"""Times that cells are shifted onto the means they form: the two of the method's description."""
_SHIFTS = [(y, x) for y in range(2 * SLACK + 1) for x in range(2 * SLACK + 1)]
_ROWS, _TOP, _BOTTOM = 24, 4, 20
"""Prototypes stand on this many rows, a capital's top and foot at these."""
_READINGS = 2
"""Times that the cells of numbers are read by the means of the names they had."""
_STYLES = 3
"""How many styles a page may mix: a printer's type lies between those that are known."""
_SPREAD = 1.6
"""How far apart the cells of a group may be, in units of what three quarters of the pairs of one
letter keep to. The widest pairs of 11 pages had 1.2 to 2.5, two digits mostly 2 to 4 and once 1.5;
labels laid out wrongly leave the three quarters alone."""
_CLEARLY = 0.13, 2.5
"""How unlike a digit of a known style a cell is at most that is taken for it, and how many times as
unlike the predicted: 16 digits drawn in another font came to 0.01 to 0.12 and 2.7 to 27 times; 60
with a blot, a stroke or a scratch to 0.09 and more and 1 to 2.2 times, one to 0.05."""
_AGAIN = 0.1
"""What a character's second group costs a cell, in units of `likeness`."""


class Sample(NamedTuple):
    """Cells of a page at every shift, shape (cells, shifts, pixels), with their squared norms."""

    vectors: Vectors
    norms: Vectors
    shape: tuple[int, int]

    def at(self, chosen: NDArray[np.intp]) -> "Sample":
        """Some of the cells."""
        return Sample(self.vectors[chosen], self.norms[chosen], self.shape)


def sample_of(grid: Grid, places: Sequence[Place]) -> Sample:
    """The cells at ``places``; those off the grid are blank."""
    height, width = grid.pictures[0].shape[0] - 2 * SLACK, CELL_WIDTH
    whole = np.zeros((len(places), height + 2 * SLACK, width + 2 * SLACK), np.float32)
    for row, place in zip(whole, places, strict=True):
        picture = grid.pictures[place.line]
        columns = place.cell * CELL_WIDTH + np.arange(row.shape[1])
        there = (columns >= 0) & (columns < picture.shape[1])
        row[:, there] = picture[:, columns[there]]
    vectors = np.stack(
        [whole[:, y : y + height, x : x + width].reshape(len(places), -1) for y, x in _SHIFTS], 1
    )
    return Sample(vectors, np.einsum("nsp,nsp->ns", vectors, vectors), (height, width))


def distances(sample: Sample, means: Vectors) -> tuple[Floats, Floats]:
    """Squared distance of each cell from each mean at the shift and the strength of ink that fit
    best, and that strength: shapes (cells, means). Ribbons run dry within a line."""
    count, shifts, pixels = sample.vectors.shape
    inner = (sample.vectors.reshape(-1, pixels) @ means.T).reshape(count, shifts, len(means))
    energy = np.maximum(np.einsum("mp,mp->m", means, means), 1e-6)
    strength = np.clip(inner / energy, *STRENGTHS)
    squared = sample.norms[:, :, None] - 2 * strength * inner + strength**2 * energy
    best = np.argmin(squared, axis=1)[:, None, :]
    least = np.take_along_axis(squared, best, axis=1)[:, 0].astype(float)
    return np.maximum(least, 0.0), np.take_along_axis(strength, best, axis=1)[:, 0].astype(float)


class Typeface(NamedTuple):
    """Mean glyphs: ``characters`` in order, ``means`` (characters, pixels), on how many cells each
    rests, and which shifted cells they were made of."""

    characters: str
    means: Vectors
    counts: NDArray[np.intp]
    names: NDArray[np.intp]
    members: Vectors
    shape: tuple[int, int]

    def between(self) -> Floats:
        """Squared distances of the means from each other, of whatever strength, and from blank
        paper: of the two directions the less."""
        whole = np.vstack([self.means, np.zeros_like(self.means[:1])])
        norms = np.einsum("mp,mp->m", whole, whole)
        apart, _ = distances(Sample(whole[:, None], norms[:, None], (0, 0)), whole)
        least: Floats = np.minimum(apart, apart.T)
        return least

    def without(self, cell: int) -> Vectors | None:
        """The mean of a cell's own class, the cell left out; None where it stands alone."""
        name = self.names[cell]
        if name < 0 or self.counts[name] < 2:
            return None
        count = self.counts[name]
        rest: Vectors = (self.means[name] * count - self.members[cell]) / (count - 1)
        return rest


def typeface_of(sample: Sample, names: Sequence[str]) -> Typeface:
    """The mean glyph of each name; cells named "" belong to none. Cells are shifted onto their
    mean as it forms."""
    characters = "".join(sorted(set(names) - {"", BLANK}))
    index = np.array([characters.find(name or BLANK) for name in names])
    pick = (index == np.arange(len(characters))[:, None]).astype(np.float32)
    counts = pick.sum(axis=1).astype(int)

    def mean(members: Vectors) -> Vectors:
        return np.asarray(pick @ members / np.maximum(counts[:, None], 1), np.float32)

    members = sample.vectors[:, len(_SHIFTS) // 2]
    for _ in range(_ROUNDS):
        # each cell at the shift that fits the mean of its class
        own = mean(members)[np.maximum(index, 0)]
        inner = np.matmul(sample.vectors, own[:, :, None])[:, :, 0]
        best = np.argmin(sample.norms - 2 * inner, axis=1)
        members = sample.vectors[np.arange(len(index)), best]
    return Typeface(characters, mean(members), counts, index, members, sample.shape)


@lru_cache
def prototypes() -> tuple[str, Vectors]:
    """The characters, and glyphs of shape (styles, characters, rows, columns)."""
    with resources.files("impact88.verification.scan").joinpath("digits.npz").open("rb") as file:
        stored = np.load(file)
        characters = "".join(stored["characters"].tolist())
        glyphs = stored["glyphs"].astype(np.float32) / 255
    return characters, ndimage.gaussian_filter(glyphs, (0, 0, 0.8, 0.8))


def _normal(sample: Sample, typeface: Typeface) -> Vectors:
    """Cells, the height of the page's capitals that of the prototypes': (cells, rows, columns)."""
    height, width = sample.shape
    capitals = [typeface.characters.find(c) for c in "MABEIDTPUVXYKL" if c in typeface.characters]
    profile = typeface.means[capitals].reshape(-1, height, width).sum(axis=(0, 2))
    inked = np.flatnonzero(profile > 0.25 * profile.max())
    top, foot = float(inked[0]), float(inked[-1] + 1)
    middle = sample.vectors[:, sample.vectors.shape[1] // 2].reshape(-1, height, width)
    scale = (foot - top) / (_BOTTOM - _TOP)
    offset = top + (0.5 - _TOP) * scale - 0.5
    normal: Vectors = ndimage.affine_transform(
        middle, [1, scale, 1], [0, offset, 0], (len(middle), _ROWS, width),
        order=1, mode="grid-constant",
    )  # fmt: skip
    return normal


def likeness(sample: Sample, typeface: Typeface, styles: int | None = _STYLES) -> Floats:
    """How unlike each cell is to each of `NUMERIC` in the ``styles`` that fit best, None for all:
    shape (cells, characters), 0 for the same picture, 1 for nothing in common."""
    characters, glyphs = prototypes()
    cells = ndimage.gaussian_filter(_normal(sample, typeface), (0, 0.5, 0.5))
    reach = 3
    padded = np.pad(cells, ((0, 0), (reach, reach), (reach, reach)))
    flat = glyphs.reshape(-1, _ROWS * CELL_WIDTH)
    flat = flat / np.linalg.norm(flat, axis=1, keepdims=True)
    best = np.full((len(cells), len(flat)), -1.0)
    for y in range(0, 2 * reach + 1):
        for x in range(1, 2 * reach):
            moved = padded[:, y : y + _ROWS, x : x + CELL_WIDTH].reshape(len(cells), -1)
            norm = np.maximum(np.linalg.norm(moved, axis=1, keepdims=True), 1e-3)
            best = np.maximum(best, moved @ flat.T / norm)
    apart = 1 - best.reshape(len(cells), len(glyphs), len(characters))
    total = apart.min(axis=2).sum(axis=0)
    order = np.argsort(total)[:styles]
    unlike: Floats = apart[:, order].min(axis=1)
    return unlike


def foreign_digits(
    sample: Sample,
    typeface: Typeface,
    names: Sequence[str],
    alone: NDArray[np.bool_],
    far: NDArray[np.bool_],
) -> list[str]:
    """The digit that a cell is in a known style of type, where it is not the predicted: of cells
    alone with their character the nearest in the page's styles, of those that are far from their
    mean what they clearly are in any."""
    hands = [""] * len(names)
    known = np.array([name in NUMERIC for name in names])
    for asked, styles, most, clearly in ((alone, _STYLES, 1.0, 1.0), (far, None, *_CLEARLY)):
        chosen = np.flatnonzero(asked & known)
        if len(chosen):
            apart = likeness(sample.at(chosen), typeface, styles)
            for cell, row in zip(chosen.tolist(), apart, strict=True):
                least = float(row.min())
                if least < most and least * clearly < row[NUMERIC.index(names[cell])]:
                    hands[cell] = NUMERIC[int(row.argmin())]
    return hands


def _apart(sample: Sample) -> Floats:
    """How far cells are from each other, a blot or the strength of the ribbon aside: shape
    (cells, cells)."""
    middle = sample.vectors.shape[1] // 2
    apart, _ = distances(sample, sample.vectors[:, middle])
    energy = sample.norms[:, middle] + 1e-6
    pairs: Floats = np.minimum(apart, apart.T) / np.sqrt(np.sqrt(np.outer(energy, energy)))
    np.fill_diagonal(pairs, 0)
    return pairs


def _named(sample: Sample, unlike: Floats, widest: float) -> NDArray[np.intp]:
    """A name for each cell, as an index of `NUMERIC`: cells that are alike have one name, cells
    that are not have two where that costs little. So a 3 that is most like the 8 of every known
    style is a 3 where the page has another 8."""
    tree = linkage(squareform(_apart(sample), checks=False), "average")
    widest = min([widest, *tree[: 1 - len(NUMERIC), 2][-1:]])  # a page has all digits, or nearly
    group = fcluster(tree, widest, "distance") - 1
    members = (group[None] == np.arange(group.max() + 1)[:, None]).astype(float)
    sizes = members.sum(axis=1, keepdims=True)
    times = 1 + len(members) // len(NUMERIC)  # a name may be given again, at a price
    costs = [members @ unlike + again * _AGAIN * sizes for again in range(times + 1)]
    rows, columns = linear_sum_assignment(np.hstack(costs))
    names: NDArray[np.intp] = np.zeros(len(members), int)
    names[rows] = columns % len(NUMERIC)
    return np.asarray(names[group])


def read_numbers(grid: Grid, sheets: Sequence[Sheet]) -> list[dict[str, Floats]]:
    """By name of each printout's numbers the cost of each of `READABLE` in each cell, 0 for the
    likeliest. All printouts of a page share its type."""
    if not sheets:
        return []
    places: list[Place] = []
    names: list[str] = []
    chosen: list[int] = []
    numbers: list[tuple[int, str, slice]] = []
    for which, sheet in enumerate(sheets):
        for name, text, held in (piece for row in sheet.rows.values() for piece in row.pieces):
            if name:
                begin = len(chosen)
                chosen += range(len(places), len(places) + len(held))
                numbers.append((which, name, slice(begin, len(chosen))))
            places += held
            names += text if len(text) == len(held) else BLANK * len(held)
    sample = sample_of(grid, places)
    of_numbers = sample.at(np.array(chosen))
    labels = np.array([k for k, name in enumerate(names) if name != BLANK])
    unlike = likeness(of_numbers, typeface_of(sample, names))
    # how far apart two cells of one character are on this page, as its labels show
    letters = np.array(names)[labels]
    same = np.triu(letters[:, None] == letters, 1)
    usual = np.percentile(_apart(sample.at(labels))[same], 75) if same.any() else 0.0
    first = _named(of_numbers, unlike, _SPREAD * float(usual))
    for cell, k in zip(chosen, first, strict=True):
        names[cell] = NUMERIC[k]
    costs = np.full((len(chosen), len(READABLE)), np.inf)
    for _ in range(_READINGS):
        typeface = typeface_of(sample, names)
        apart, strength = distances(of_numbers, typeface.means)
        weak = np.take_along_axis(strength, apart.argmin(axis=1)[:, None], axis=1) ** 2
        costs[:] = np.inf
        for k, character in enumerate(READABLE):
            if (column := typeface.characters.find(character)) >= 0:
                costs[:, k] = apart[:, column]
        costs[:, -1] = of_numbers.norms.min(axis=1)
        for cell, k in zip(chosen, costs.argmin(axis=1), strict=True):
            names[cell] = READABLE[k]
    own = costs.min(axis=1, keepdims=True)
    unit = max(float(np.median(own)) * 0.6, 1e-3)
    costs = (costs - own) / (unit * weak)
    return [
        {name: costs[part] for index, name, part in numbers if index == which}
        for which in range(len(sheets))
    ]
