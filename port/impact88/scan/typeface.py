"""The type a page is written in: the mean glyph of each character, made of the page's own cells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .grid import CELL_WIDTH, SLACK, Grid
from .ink import Floats
from .layout import Place

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


@dataclass
class Sample:
    """Cells of a page at every shift, shape (cells, shifts, pixels), with their squared norms."""

    vectors: Vectors
    norms: Vectors
    shape: tuple[int, int]

    def __len__(self) -> int:
        return len(self.vectors)

    def at(self, chosen: NDArray[np.intp]) -> Sample:
        """Some of the cells."""
        return Sample(self.vectors[chosen], self.norms[chosen], self.shape)


def sample_of(grid: Grid, places: Sequence[Place]) -> Sample:
    """The cells at ``places``; those off the grid are blank."""
    height, width = grid.pictures[0].shape[0] - 2 * SLACK, CELL_WIDTH
    whole = np.zeros((len(places), height + 2 * SLACK, width + 2 * SLACK), np.float32)
    for row, place in zip(whole, places, strict=True):
        picture = grid.pictures[place.line]
        start = place.cell * CELL_WIDTH
        piece = picture[:, max(start, 0) : max(start + row.shape[1], 0)]
        if start < 0:
            row[:, row.shape[1] - piece.shape[1] :] = piece
        else:
            row[:, : piece.shape[1]] = piece
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


@dataclass
class Typeface:
    """Mean glyphs: ``characters`` in order, ``means`` (characters, pixels), on how many cells each
    rests, and which shifted cells they were made of."""

    characters: list[str]
    means: Vectors
    counts: NDArray[np.intp]
    names: NDArray[np.intp]
    members: Vectors
    shape: tuple[int, int]

    def index(self, character: str) -> int:
        """The place of a character, -1 where the page has none."""
        return self.characters.index(character) if character in self.characters else -1

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
    characters = sorted(set(names) - {"", BLANK})
    index = np.array([characters.index(n) if n in characters else -1 for n in names])
    middle = len(_SHIFTS) // 2
    members = sample.vectors[:, middle]
    means = _means(members, index, len(characters))
    for _ in range(_ROUNDS):
        # each cell at the shift that fits the mean of its class
        own = means[np.maximum(index, 0)]
        inner = np.matmul(sample.vectors, own[:, :, None])[:, :, 0]
        best = np.argmin(sample.norms - 2 * inner, axis=1)
        members = sample.vectors[np.arange(len(sample)), best]
        means = _means(members, index, len(characters))
    counts = np.array([int(np.sum(index == k)) for k in range(len(characters))])
    return Typeface(characters, means, counts, index, members, sample.shape)


def _means(members: Vectors, index: NDArray[np.intp], count: int) -> Vectors:
    pick = (index[None] == np.arange(count)[:, None]).astype(np.float32)
    means: Vectors = (pick @ members) / np.maximum(pick.sum(axis=1, keepdims=True), 1)
    return means
