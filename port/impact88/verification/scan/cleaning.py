"""A picture of a page turned into paper: dark type on white, seen from straight above.

What surrounds the page is left out, a page photographed askew is laid flat by its own four edges, a
negative is turned into a positive, coloured ink is set apart from black, and two pages on one
picture become two sheets. Each step says what it did.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import PIL.Image
from numpy.typing import NDArray
from scipy import ndimage

from .grid import FEWEST_POINTS
from .ink import Floats, Image, ink_of, points_of, resized
from .picture import Picture

Mask = NDArray[np.bool_]

_COARSE = 500  # pixels of the longer side at which page and surround are told apart
_TYPE = 0.04  # of that side: strokes and letters are narrower, and are closed over
_PAGE = 0.15  # the least part of the picture that a page takes
_WHOLE = 0.97  # a page that takes more has no surround
_CONTRAST = 45.0  # grey levels between page and surround at least
_SURROUND = 0.6  # brightness of a surround, of the page's, at most
_MARGIN = 0.008  # of a side, cut off within the page's edges: their shadows
_GUTTER_LOW, _GUTTER_HIGH = 0.25, 0.75  # of the width, where a gutter may run
_GUTTER_WIDTH = 0.12  # of the width, at most
_CHROMA = 0.2  # difference of a coloured ink's darkest and lightest channel at least
_COLOURED_TYPE = 0.5  # of the ink that is coloured: more, and the type itself is
_SMOOTH = 24  # pixels a side of the blocks whose brightness is the paper's
_HOLE_DARK = 0.7  # brightness of a hole, of the paper's, at most
_LEAST_HOLE, _LARGEST_HOLE = 0.008, 0.06  # of the width: half an inch apart, a fifth wide or less
_SOLID = 0.65  # of the square around a hole that is dark; a disc has .79, a ring of ink less
_FEWEST_HOLES = 4  # of a strip
_STRIP = 0.15  # of the width, from a side, where strips run
_ALONE = 1.5  # what is dark in a strip, of its holes, at most
_SKEW = 0.08  # slope from which a page is set straight: the grid's own search ends at 0.1
_STEEPEST = 0.25  # the greatest slope that is looked for
_SHARPER = 1.3  # how much more sharply lines and gaps are parted along a steep slope at least
_FINE = 1200  # pixels of the longer side at which slopes are tried
_CURL = 0.06  # of a side, by which an edge of a page may bend


@dataclass
class Paper:
    """One sheet: its picture in ``grey``, 0 black and 255 white; ink of another colour than the
    type's in ``coloured``, from 0 to 1; and what was done to get it."""

    grey: Image
    coloured: Image | None = None
    remarks: list[str] = field(default_factory=list)
    back: Callable[[Floats], Floats] | None = None

    def place(self, points: Floats) -> Floats:
        """Return where points of the sheet, shape (..., 2), are in the page's picture."""
        return self.back(points) if self.back else points


def papers_of(picture: Picture) -> Iterator[Paper]:
    """Yield the sheets of paper that a picture shows."""
    if min(picture.shape[:2]) < 3 * _SMOOTH:
        yield Paper(_luminance(picture))
        return
    grey, coloured = _parted(picture)
    remarks = []
    if coloured is not None:
        remarks.append("ink of another colour than the type's was set apart")
    if _negative(grey):
        grey = 255 - grey
        remarks.append("the picture is a negative: it was read as a positive")
    if (strips := _without_strips(grey)) is not None:
        grey = strips
        remarks.append("the strips with the holes of continuous paper were left out")
    pages = _pages(grey)
    if len(pages) > 1:
        remarks.append(f"the picture shows {len(pages)} pages side by side")
    for flat, remark in pages:
        said = [*remarks, *([remark] if remark else [])]
        if flat is None:
            yield _levelled(Paper(grey, coloured, said))
            continue
        own = None if coloured is None else flat.sampled(coloured, 0.0)
        yield _levelled(Paper(flat.sampled(grey, 255.0), own, said, flat.back))


def _luminance(picture: Picture) -> Image:
    if picture.ndim == 2:
        return picture.astype(np.float32)
    return np.asarray(PIL.Image.fromarray(picture).convert("L"), np.float32)


# --- colour and polarity --------------------------------------------------------------------------


def _parted(picture: Picture) -> tuple[Image, Image | None]:
    """Return grey, and the ink that has a colour, where the page's type is black.

    Black ink is dark in each channel, so the lightest channel, each against its own paper, shows
    it alone.
    """
    grey = _luminance(picture)
    if picture.ndim == 2 or not _colourful(picture):
        return grey, None
    light = np.stack([_paper(picture[:, :, k].astype(np.float32)) for k in range(3)], axis=-1)
    ink = 1 - np.clip(picture / np.maximum(light, 1), 0, 1).astype(np.float32)
    least, most = ink.min(axis=2), ink.max(axis=2)
    chroma = most - least
    coloured = np.where(chroma > _CHROMA, most, 0).astype(np.float32)
    dark = most > 0.3
    if not dark.any() or float((coloured > 0.3).sum()) > _COLOURED_TYPE * float(dark.sum()):
        return grey, None
    black = np.clip(least - 0.6 * chroma, 0, 1)
    # where there is colour the paper stands in for it, elsewhere the picture is as it was
    near = ndimage.binary_dilation(chroma > 0.5 * _CHROMA, iterations=2)
    paper = light.max(axis=2)
    return np.where(near, np.minimum(paper * (1 - black), 255), grey).astype(np.float32), coloured


def _colourful(picture: Picture) -> bool:
    """Whether some of a picture is of another colour than most of it."""
    small = picture[::4, ::4].astype(np.int16)
    tint = small - np.median(small.reshape(-1, 3), axis=0).astype(np.int16)
    spread = tint.max(axis=2) - tint.min(axis=2)
    return bool((spread > 60).mean() > 2e-4)


def _paper(channel: Image) -> Image:
    """The brightness of the paper under the ink of a channel."""
    height, width = channel.shape
    rows, columns = height // _SMOOTH, width // _SMOOTH
    blocks = channel[: rows * _SMOOTH, : columns * _SMOOTH]
    blocks = blocks.reshape(rows, _SMOOTH, columns, _SMOOTH).transpose(0, 2, 1, 3)
    light = np.percentile(blocks.reshape(rows, columns, -1), 85, axis=2)
    light = ndimage.grey_closing(light, size=(5, 5), mode="nearest")
    light = ndimage.gaussian_filter(light, 1.0, mode="nearest").astype(np.float32)
    whole = PIL.Image.fromarray(light).resize((width, height), PIL.Image.Resampling.BILINEAR)
    return np.asarray(whole, np.float32)


def _negative(grey: Image) -> bool:
    """Whether strokes are lighter than what surrounds them."""
    small = grey[:: max(1, grey.shape[0] // 1200), :: max(1, grey.shape[1] // 1200)]
    near = ndimage.uniform_filter(small, 25)
    lighter = float(((small - near > 40) & (near < 110)).sum())
    darker = float(((near - small > 40) & (near >= 110)).sum())
    return lighter > 2 * darker and float(np.median(small)) < 110


# --- continuous paper -----------------------------------------------------------------------------


def _without_strips(grey: Image) -> Image | None:
    """Return a picture without the strips of holes at its sides, None where it has none.

    Holes are solid, round, of one size, one below the other near a side, and nothing else is
    between them.
    """
    scale = min(1.0, _FINE / max(grey.shape))
    small = resized(grey, scale)
    paper = float(np.percentile(small, 75))
    dark = small < _HOLE_DARK * paper
    width = dark.shape[1]
    labels, _ = ndimage.label(dark)
    rounds = []
    for which, box in enumerate(ndimage.find_objects(labels), 1):
        down, across = (part.stop - part.start for part in box)
        round_ = 0.7 < across / down < 1.4 and _LEAST_HOLE < across / width < _LARGEST_HOLE
        if round_ and (labels[box] == which).mean() > _SOLID:
            rounds.append((box[1].start + across / 2, box[0].start + down / 2, across))
    result = None
    for left in (True, False):
        near = [hole for hole in rounds if (hole[0] < width / 2) is left]
        size = float(np.median([hole[2] for hole in near])) if near else 0.0
        middle = float(np.median([hole[0] for hole in near])) if near else 0.0
        alike = [h for h in near if abs(h[2] - size) < 0.3 * size and abs(h[0] - middle) < size]
        inset = middle if left else width - middle
        if len(alike) < _FEWEST_HOLES or inset > _STRIP * width:
            continue
        start, stop = (max(round(middle + side * 0.7 * size), 0) for side in (-1, 1))
        gaps = np.diff(sorted(hole[1] for hole in alike))
        holes = len(alike) * np.pi / 4 * size**2
        even = bool(gaps.max() < 1.3 * float(np.median(gaps)))
        if even and dark[:, start:stop].sum() < _ALONE * holes:
            result = grey.copy() if result is None else result
            if left:
                result[:, : round(stop / scale)] = paper
            else:
                result[:, round(start / scale) :] = paper
    return result


# --- skew -----------------------------------------------------------------------------------------


def _levelled(paper: Paper) -> Paper:
    """Return a sheet turned so that its lines run level, where they rise or fall more than the
    grid's own search reaches."""
    slope = _skew(paper.grey)
    if abs(slope) < _SKEW:
        return paper
    height, width = paper.grey.shape
    along = 1 / math.hypot(1, slope)
    turn = along * np.array([[1, -slope], [slope, 1]])
    size = np.ceil(np.abs(turn) @ [width, height]).astype(int)
    before = paper.back

    def back(points: Floats) -> Floats:
        place = (points - size / 2) @ turn.T + [width / 2, height / 2]
        return before(place) if before else place

    first = np.array([width, height]) / 2 - turn @ (size / 2)
    table = (*turn[0], first[0], *turn[1], first[1])

    def turned(picture: Image, beyond: float) -> Image:
        whole = PIL.Image.fromarray(picture).transform(
            (int(size[0]), int(size[1])),
            PIL.Image.Transform.AFFINE,
            tuple(map(float, table)),
            PIL.Image.Resampling.BICUBIC,
            fillcolor=beyond,
        )
        return np.asarray(whole, np.float32)

    grey = np.clip(turned(paper.grey, float(np.median(paper.grey))), 0, 255)
    coloured = None if paper.coloured is None else turned(paper.coloured, 0.0)
    degrees = math.degrees(math.atan(abs(slope)))
    said = f"the page is askew by {degrees:.1f} degrees: it was set straight"
    return Paper(grey, coloured, [*paper.remarks, said], back)


def _skew(grey: Image) -> float:
    """Return the slope of a page's lines, which run across or, of a page on its side, down; 0 where
    no steep slope parts lines and gaps more sharply than those that the grid tries."""
    small = resized(grey, min(1.0, _FINE / max(grey.shape)))
    points = points_of(ink_of(small))
    if len(points.x) < FEWEST_POINTS:
        return 0.0
    few = slice(None, None, max(1, len(points.x) // 5000))
    x, y = points.x[few], points.y[few]
    slopes = np.arange(-_STEEPEST, _STEEPEST + 1e-9, 0.004)
    sharpness = np.zeros((2, len(slopes)))
    for which, (across, down) in enumerate(((x, y), (-y, x))):
        for at, slope in enumerate(slopes):
            level = (down - slope * across) / 2
            counts = np.bincount((level - level.min()).astype(int)).astype(float)
            sharpness[which, at] = np.sum(np.diff(counts) ** 2)
    best = sharpness[int(sharpness.max(axis=1).argmax())]
    level_most = best[np.abs(slopes) < _SKEW].max()
    return float(slopes[best.argmax()]) if best.max() > _SHARPER * level_most else 0.0


# --- pages and what surrounds them ----------------------------------------------------------------


class Flat(NamedTuple):
    """A page laid flat: ``edges``, its left, right, upper and lower edge as parabolas in the frame
    of its corners, ``frame`` from there to the picture, ``size`` of the sheet in pixels."""

    frame: Floats
    edges: Floats
    size: tuple[int, int]

    @classmethod
    def of(cls, corners: Floats) -> "Flat":
        """Return the page with some corners, clockwise from the upper left one."""
        rows = []
        for (x, y), (u, v) in zip(corners, ((0, 0), (1, 0), (1, 1), (0, 1)), strict=True):
            rows.append([u, v, 1, 0, 0, 0, -u * x, -v * x])
            rows.append([0, 0, 0, u, v, 1, -u * y, -v * y])
        frame = np.append(np.linalg.solve(np.array(rows, float), corners.ravel()), 1.0)
        upper, right, lower, left = (
            float(np.hypot(*(corners[at] - corners[(at + 1) % 4]))) for at in range(4)
        )
        size = max(1, round((upper + lower) / 2)), max(1, round((left + right) / 2))
        return cls(frame.reshape(3, 3), np.zeros((4, 3)), size)

    def back(self, points: Floats) -> Floats:
        """Return where points of the sheet, shape (..., 2), are in the picture."""
        u = np.clip(points[..., 0] / self.size[0], -0.05, 1.05)
        v = np.clip(points[..., 1] / self.size[1], -0.05, 1.05)
        u, v = (_MARGIN + (1 - 2 * _MARGIN) * part for part in (u, v))
        left, right, upper, lower = (
            np.polyval(edge, at) for edge, at in zip(self.edges, (v, v, u, u), strict=True)
        )
        x = u + (1 - u) * left + u * right
        y = v + (1 - v) * upper + v * lower
        place = np.stack([x, y, np.ones_like(x)], axis=-1) @ self.frame.T
        return np.asarray(place[..., :2] / place[..., 2:])

    def sampled(self, picture: Image, beyond: float) -> Image:
        """Return what a picture shows of the page."""
        width, height = self.size
        sheet = np.empty((height, width), np.float32)
        for top in range(0, height, 256):  # in strips, for memory
            rows = np.arange(top, min(top + 256, height))
            points = np.stack(np.meshgrid(np.arange(width) + 0.5, rows + 0.5), axis=-1)
            place = self.back(points) - 0.5
            sheet[rows] = ndimage.map_coordinates(
                picture, [place[..., 1], place[..., 0]], order=1, cval=beyond
            )
        return sheet


def _pages(grey: Image) -> list[tuple[Flat | None, str]]:
    """The pages that a picture shows, from left to right, and what is said of each; None for one
    that fills the picture."""
    scale = min(1.0, _COARSE / max(grey.shape))
    small = resized(grey, scale)
    pages: list[tuple[Flat | None, str]] = []
    for start, stop in _halves(small):
        mask = _page(small[:, start:stop])
        flat = None
        if mask is not None:
            whole = np.zeros(small.shape, bool)
            whole[:, start:stop] = mask
            flat = _flattened(whole, scale)
        if flat:
            pages.append(
                (flat, "the picture is dark around the page: it was laid flat by its edges")
            )
        elif (start, stop) == (0, small.shape[1]):
            pages.append((None, ""))
        else:
            corners = np.array([[start, 0], [stop, 0], [stop, len(small)], [start, len(small)]])
            pages.append((Flat.of(corners / scale), ""))
    return pages


def _halves(small: Image) -> list[tuple[int, int]]:
    """The columns of a picture left and right of a dark line or band that runs down it."""
    height, width = small.shape
    dark = small < 0.8 * ndimage.maximum_filter1d(ndimage.uniform_filter(small, 3), 61, axis=1)
    labels, _ = ndimage.label(dark, np.ones((3, 3)))
    for at, box in enumerate(ndimage.find_objects(labels), 1):
        down, across = box[0].stop - box[0].start, box[1].stop - box[1].start
        middle = (box[1].start + box[1].stop) / 2 / width
        filled = (labels[box] == at).any(axis=1).mean()
        centred = _GUTTER_LOW < middle < _GUTTER_HIGH
        if centred and down * filled > 0.9 * height and across < _GUTTER_WIDTH * width:
            return [(0, max(box[1].start - 1, 1)), (min(box[1].stop + 1, width - 1), width)]
    return [(0, width)]


def _page(small: Image) -> Mask | None:
    """Where the page is, None where nothing surrounds it."""
    size = max(3, round(_TYPE * max(small.shape)))
    plain = ndimage.grey_closing(small, size=(size, size), mode="nearest")
    counts, edges = np.histogram(plain, 64)
    below, total = np.cumsum(counts), np.cumsum(counts * (edges[:-1] + edges[1:]) / 2)
    with np.errstate(all="ignore"):
        between = (total / below - total[-1] / below[-1]) ** 2 * below / (below[-1] - below)
    level = edges[int(np.argmax(np.nan_to_num(between[:-1]))) + 1]
    bright = plain > level
    if bright.all() or not bright.any():
        return None
    page, rest = float(np.median(plain[bright])), float(np.median(plain[~bright]))
    if page - rest < _CONTRAST or rest > _SURROUND * page:
        return None
    labels, count = ndimage.label(ndimage.binary_opening(bright, iterations=2))
    if not count:
        return None
    areas = ndimage.sum_labels(bright, labels, range(1, count + 1))
    mask = ndimage.binary_fill_holes(labels == int(np.argmax(areas)) + 1)
    return mask if _PAGE < mask.mean() < _WHOLE else None


def _flattened(mask: Mask, scale: float) -> Flat | None:
    """A page laid flat by its edges, None where they are not those of a sheet."""
    y, x = np.nonzero(mask)
    ends = [
        int(np.argmin(x + y)),
        int(np.argmax(x - y)),
        int(np.argmax(x + y)),
        int(np.argmin(x - y)),
    ]
    corners = np.stack([x[ends], y[ends]], axis=-1) + np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    flat = Flat.of(corners / scale)
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    sides = (
        (np.argmax(mask[rows], axis=1), rows),
        (mask.shape[1] - np.argmax(mask[rows, ::-1], axis=1), rows),
        (columns, np.argmax(mask[:, columns], axis=0)),
        (columns, len(mask) - np.argmax(mask[::-1, columns], axis=0)),
    )
    inverse, edges = np.linalg.inv(flat.frame), []
    for which, (across, down) in enumerate(sides):
        points = np.stack([across / scale, down / scale, np.ones(len(across))], axis=-1)
        place = points @ inverse.T
        place = place[:, :2] / place[:, 2:]
        off, along = place[:, which // 2] - which % 2, place[:, 1 - which // 2]
        near = (np.abs(off) < _CURL) & (along > 0.02) & (along < 0.98)
        if near.sum() < 0.5 * len(near):
            return None
        for _ in range(3):
            edge = np.polyfit(along[near], off[near], 2)
            apart = np.abs(np.polyval(edge, along) - off)
            near &= apart < max(0.003, 3 * float(np.median(apart[near])))
        edges.append(edge)
    return flat._replace(edges=np.array(edges))
