"""First names for the characters of numbers: small prototypes of a few styles of type, then the
page's own means. Labels need no reading: they are known text at known places."""

from functools import lru_cache
from importlib import resources

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import squareform

from .grid import CELL_WIDTH, Grid
from .ink import Floats
from .layout import Place, Sheet
from .scenes import Read
from .typeface import (
    BLANK,
    NUMERIC,
    READABLE,
    Sample,
    Typeface,
    Vectors,
    distances,
    sample_of,
    typeface_of,
)

_ROWS, _TOP, _BOTTOM = 24, 4, 20
"""Prototypes stand on this many rows, a capital's top and foot at these."""
_READINGS = 2
STYLES = 3
"""How many styles a page may mix: a printer's type lies between those that are known."""
_SPREAD = 1.6
"""How far apart the cells of a group may be, in units of what three quarters of the pairs of one
letter keep to. The widest pairs of 11 pages had 1.2 to 2.5, two digits mostly 2 to 4 and once 1.5;
labels laid out wrongly leave the three quarters alone."""
_AGAIN = 0.1
"""What a character's second group costs a cell, in units of `likeness`."""


@lru_cache
def prototypes() -> tuple[str, Vectors]:
    """The characters, and glyphs of shape (styles, characters, rows, columns)."""
    with resources.files("impact88.scan").joinpath("digits.npz").open("rb") as file:
        stored = np.load(file)
        characters = "".join(stored["characters"].tolist())
        glyphs = stored["glyphs"].astype(np.float32) / 255
    return characters, ndimage.gaussian_filter(glyphs, (0, 0, 0.8, 0.8))


def capitals(typeface: Typeface) -> tuple[float, float]:
    """Top and foot of the page's capitals, in rows of a cell."""
    height, width = typeface.shape
    chosen = [
        typeface.index(letter) for letter in "MABEIDTPUVXYKL" if letter in typeface.characters
    ]
    profile = typeface.means[chosen].reshape(-1, height, width).sum(axis=(0, 2))
    inked = np.flatnonzero(profile > 0.25 * profile.max())
    return float(inked[0]), float(inked[-1] + 1)


def _normal(sample: Sample, top: float, foot: float) -> Vectors:
    """Cells, the height of their capitals that of the prototypes': (cells, rows, columns)."""
    height, width = sample.shape
    middle = sample.vectors[:, sample.vectors.shape[1] // 2].reshape(-1, height, width)
    at = top + (np.arange(_ROWS) + 0.5 - _TOP) * (foot - top) / (_BOTTOM - _TOP) - 0.5
    low = np.floor(at).astype(int)
    part = (at - low).astype(np.float32)[None, :, None]
    padded = np.pad(middle, ((0, 0), (_ROWS, _ROWS), (0, 0)))
    normal: Vectors = padded[:, low + _ROWS] * (1 - part) + padded[:, low + _ROWS + 1] * part
    return normal


def likeness(sample: Sample, typeface: Typeface, styles: int | None = STYLES) -> Floats:
    """How unlike each cell is to each of `NUMERIC` in the ``styles`` that fit best, None for all:
    shape (cells, characters), 0 for the same picture, 1 for nothing in common."""
    characters, glyphs = prototypes()
    cells = ndimage.gaussian_filter(_normal(sample, *capitals(typeface)), (0, 0.5, 0.5))
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


def _apart(sample: Sample) -> Floats:
    """How far cells are from each other, a blot or the strength of the ribbon aside: shape
    (cells, cells)."""
    middle = sample.vectors.shape[1] // 2
    apart, _ = distances(sample, sample.vectors[:, middle])
    energy = sample.norms[:, middle] + 1e-6
    pairs: Floats = np.minimum(apart, apart.T) / np.sqrt(np.sqrt(np.outer(energy, energy)))
    np.fill_diagonal(pairs, 0)
    return pairs


def _widest(labels: Sample, names: NDArray[np.str_]) -> float:
    """How far apart two cells of one character are on this page, as its labels show."""
    same = np.triu(names[:, None] == names[None], 1)
    return _SPREAD * float(np.percentile(_apart(labels)[same], 75)) if same.any() else 0.0


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


def read_numbers(grid: Grid, sheets: list[Sheet]) -> list[Read]:
    """What each number's cells may be. All printouts of a page share its type."""
    if not sheets:
        return []
    places: list[Place] = []
    names: list[str] = []
    numbers: list[tuple[int, str, slice]] = []
    for which, sheet in enumerate(sheets):
        for pieces in sheet.pieces.values():
            for piece in pieces:
                if piece.name:
                    numbers.append(
                        (which, piece.name, slice(len(places), len(places) + len(piece.places)))
                    )
                places.extend(piece.places)
                known = len(piece.text) == len(piece.places)
                names.extend(piece.text if known else BLANK * len(piece.places))
    sample = sample_of(grid, places)
    chosen = np.concatenate([np.arange(part.start, part.stop) for _, _, part in numbers])
    of_numbers = sample.at(chosen)
    labels = np.array([k for k, name in enumerate(names) if name != BLANK])
    unlike = likeness(of_numbers, typeface_of(sample, names))
    first = _named(of_numbers, unlike, _widest(sample.at(labels), np.array(names)[labels]))
    for cell, k in zip(chosen, first, strict=True):
        names[cell] = NUMERIC[k]
    empty = sample.norms.min(axis=1)
    for _ in range(_READINGS):
        typeface = typeface_of(sample, names)
        costs = np.full((len(places), len(READABLE)), np.inf)
        columns = [typeface.index(character) for character in READABLE]
        apart, strength = distances(of_numbers, typeface.means)
        weak = np.take_along_axis(strength, apart.argmin(axis=1)[:, None], axis=1)[:, 0] ** 2
        for k, column in enumerate(columns):
            if column >= 0:
                costs[chosen, k] = apart[:, column]
        costs[chosen, -1] = empty[chosen]
        for cell in chosen:
            names[cell] = READABLE[int(costs[cell].argmin())]
    own = costs[chosen].min(axis=1)
    unit = max(float(np.median(own)) * 0.6, 1e-3)
    costs[chosen] = (costs[chosen] - own[:, None]) / (unit * weak[:, None])
    return [
        Read(sheet, {name: costs[part] for index, name, part in numbers if index == which})
        for which, sheet in enumerate(sheets)
    ]
