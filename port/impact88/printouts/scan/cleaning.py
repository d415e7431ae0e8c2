"""Pictures of pages turned into sheets: dark type on white, seen from straight above.

The surround of the page is left out, a page photographed askew is laid flat by its own four edges,
a negative is inverted, coloured ink is separated from black, and two pages on one picture become
two sheets. Each step adds a remark on what it did.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import PIL.Image
from scipy import fft, ndimage

from .ink import (
    FEWEST_POINTS,
    MIN_SIDE,
    STEEP,
    Floats,
    Image,
    Mask,
    Spot,
    darkness,
    hole_columns,
    ink_of,
    paper_brightness,
    points_of,
    resize,
    skew,
    threshold,
)
from .picture import Picture

# A page and its surround, on a picture reduced to _COARSE pixels.
_COARSE = 500  # pixels of the longer side
_TYPE_WIDTH = 0.04  # fraction of that side; strokes and letters are narrower, and are closed over
_MIN_PAGE = 0.15  # fraction of the picture that a page takes
_MAX_PAGE = 0.97  # a page that takes more has no surround
_MAX_SURROUND = 0.8  # brightness of a surround, relative to the page's
_SHADOW_STEP = 0.04
"""Step of the logarithm of brightness between neighbouring pixels below which it is a shadow's: the
edge of a page on a grey desk has 0.1 and more, the hardest shadow drawn for a test 0.02."""
_MARGIN = 0.008  # fraction of a side cut off within the page's edges, for their shadows
_MAX_CURL = 0.06  # fraction of a side by which an edge of a page may bend
# The gutter between two pages, in fractions of the width.
_OFF_CENTRE = 0.25  # largest distance from the middle
_MAX_GUTTER = 0.12  # width
# Colour.
_MIN_CHROMA = 0.2  # difference between the darkest and lightest channel of a coloured ink
_COLOURED_TYPE = 0.5  # fraction of the ink that is coloured above which the type itself is
_HOLE_DARK = 0.7  # largest brightness of a hole, relative to the paper's
_STRIP = 0.15  # fraction of the width, from a side, within which strips with holes run
_MAX_OTHER = 1.5  # largest dark area in a strip, relative to that of its holes
_FINE = 1200  # pixels of the longer side at which polarity, holes and slopes are looked for


@dataclass
class Paper:
    """One sheet of paper.

    Attributes
    ----------
    grey : ndarray, shape (rows, columns)
        Its picture, 0 black to 255 white.
    coloured : ndarray, optional
        Ink of another colour than the type's, 0 to 1.
    remarks : list of str
        Remarks on what was done to get it.
    back : callable, optional
        Map from points of the sheet to points of the page's picture; None for the identity.
    is_on_side : bool
        True for a sheet whose lines run down it.
    """

    grey: Image
    coloured: Image | None = None
    remarks: list[str] = field(default_factory=list)
    back: Callable[[Floats], Floats] | None = None
    is_on_side: bool = False

    def place(self, points: Floats) -> Floats:
        """Return where points of the sheet, shape (..., 2), are in the page's picture."""
        return self.back(points) if self.back else points


def papers_of(picture: Picture) -> Iterator[Paper]:
    """Yield the sheets of paper that a picture shows."""
    if min(picture.shape[:2]) < MIN_SIDE:
        yield Paper(_luminance(picture))
        return
    remarks = []
    # polarity first: on a dark screen, coloured type is all the colour there is
    if _is_negative(_luminance(picture)):
        picture = 255 - picture
        remarks.append("the picture is a negative: it was read as a positive")
    grey, coloured_ink = _split_colours(picture)
    if coloured_ink is not None:
        remarks.append("ink of another colour than the type's was set apart")
    if (trimmed := _without_strips(grey)) is not None:
        grey = trimmed
        remarks.append("the strips with the holes of continuous paper were left out")
    pages = _find_pages(grey)
    if len(pages) > 1:
        remarks.append(f"the picture shows {len(pages)} pages side by side")
    for flat, remark in pages:
        page_remarks = [*remarks, *([remark] if remark else [])]
        if flat is None:
            yield _level(Paper(grey, coloured_ink, page_remarks))
            continue
        page_ink = None if coloured_ink is None else flat.resample(coloured_ink, 0.0)
        yield _level(Paper(flat.resample(grey, 255.0), page_ink, page_remarks, flat.to_picture))


def _luminance(picture: Picture) -> Image:
    """Return a picture in grey."""
    if picture.ndim == 2:
        return picture.astype(np.float32)
    return np.asarray(PIL.Image.fromarray(picture).convert("L"), np.float32)


# --- colour and polarity --------------------------------------------------------------------------


def _split_colours(picture: Picture) -> tuple[Image, Image | None]:
    """Return the grey picture without coloured ink, and that ink; None if there is none.

    Nothing is separated where the type itself is coloured. Black ink is dark in each channel, so
    that the lightest channel, each relative to its own paper, shows it alone.
    """
    grey = _luminance(picture)
    if picture.ndim == 2 or not _has_colours(picture):
        return grey, None
    channels = [picture[:, :, k].astype(np.float32) for k in range(3)]
    paper_light = np.stack([paper_brightness(channel) for channel in channels], axis=-1)
    ink = darkness(np.stack(channels, axis=-1), paper_light)
    weakest, strongest = ink.min(axis=2), ink.max(axis=2)
    chroma = strongest - weakest
    coloured_ink = np.where(chroma > _MIN_CHROMA, strongest, 0).astype(np.float32)
    is_dark = strongest > 0.3
    if not is_dark.any() or float((coloured_ink > 0.3).sum()) > _COLOURED_TYPE * float(
        is_dark.sum()
    ):
        return grey, None
    black = np.clip(weakest - 0.6 * chroma, 0, 1)
    # where there is colour the paper stands in for it, elsewhere the picture is as it was
    is_near = ndimage.binary_dilation(chroma > 0.5 * _MIN_CHROMA, iterations=2)
    paper = paper_light.max(axis=2)
    return np.where(is_near, np.minimum(paper * (1 - black), 255), grey).astype(
        np.float32
    ), coloured_ink


def _has_colours(picture: Picture) -> bool:
    """Return True for a picture of which some is of another colour than most."""
    small = picture[::4, ::4].astype(np.int16)
    tint = small - np.median(small.reshape(-1, 3), axis=0).astype(np.int16)
    spread = tint.max(axis=2) - tint.min(axis=2)
    return bool((spread > 60).mean() > 2e-4)


def _is_negative(grey: Image) -> bool:
    """Return True for a picture whose strokes are lighter than their surround."""
    small = grey[:: max(1, grey.shape[0] // _FINE), :: max(1, grey.shape[1] // _FINE)]
    surround = ndimage.uniform_filter(small, 25)
    lighter = float(((small - surround > 40) & (surround < 110)).sum())
    darker = float(((surround - small > 40) & (surround >= 110)).sum())
    return lighter > 2 * darker and float(np.median(small)) < 110


# --- continuous paper -----------------------------------------------------------------------------


def _without_strips(grey: Image) -> Image | None:
    """Return a picture without the strips of holes at its sides, None where it has none.

    Their columns run near a side, and nothing else is between the holes.
    """
    scale = min(1.0, _FINE / max(grey.shape))
    small = resize(grey, scale)
    paper = float(np.percentile(small, 75))
    is_dark = small < _HOLE_DARK * paper
    width = is_dark.shape[1]
    labels, _ = ndimage.label(is_dark)
    spots = []
    for number, box in enumerate(ndimage.find_objects(labels), 1):
        down, across = (part.stop - part.start for part in box)
        filling = float((labels[box] == number).mean())
        spots.append(
            Spot(box[1].start + across / 2, box[0].start + down / 2, across, down, filling)
        )
    trimmed = None
    for holes in hole_columns(spots, width):
        middle, size = (float(np.median(row)) for row in np.array(holes).T[[0, 2]])
        on_left = middle < width / 2
        start, stop = (max(round(middle + side * 0.7 * size), 0) for side in (-1, 1))
        hole_area = len(holes) * np.pi / 4 * size**2
        is_clear = is_dark[:, start:stop].sum() < _MAX_OTHER * hole_area
        if is_clear and min(middle, width - middle) < _STRIP * width:
            trimmed = grey.copy() if trimmed is None else trimmed
            if on_left:
                trimmed[:, : round(stop / scale)] = paper
            else:
                trimmed[:, round(start / scale) :] = paper
    return trimmed


# --- skew -----------------------------------------------------------------------------------------


def _level(paper: Paper) -> Paper:
    """Return a sheet turned so that its lines run level.

    A sheet whose lines rise or fall by less than `STEEP` is returned as it is.
    """
    points = points_of(ink_of(resize(paper.grey, min(1.0, _FINE / max(paper.grey.shape)))))
    slope, is_on_side = skew(points) if len(points.x) >= FEWEST_POINTS else (0.0, False)
    paper.is_on_side = is_on_side
    if abs(slope) < STEEP:
        return paper
    height, width = paper.grey.shape
    along = 1 / math.hypot(1, slope)
    turn = along * np.array([[1, -slope], [slope, 1]])
    size = np.ceil(np.abs(turn) @ [width, height]).astype(int)
    earlier = paper.back

    def to_picture(points: Floats) -> Floats:
        place = (points - size / 2) @ turn.T + [width / 2, height / 2]
        return earlier(place) if earlier else place

    first = np.array([width, height]) / 2 - turn @ (size / 2)
    table = (*turn[0], first[0], *turn[1], first[1])

    def turn_picture(picture: Image, beyond: float) -> Image:
        picture_turned = PIL.Image.fromarray(picture).transform(
            (int(size[0]), int(size[1])),
            PIL.Image.Transform.AFFINE,
            tuple(map(float, table)),
            PIL.Image.Resampling.BICUBIC,
            fillcolor=beyond,
        )
        return np.asarray(picture_turned, np.float32)

    grey = np.clip(turn_picture(paper.grey, float(np.median(paper.grey))), 0, 255)
    coloured_ink = None if paper.coloured is None else turn_picture(paper.coloured, 0.0)
    degrees = math.degrees(math.atan(abs(slope)))
    remark = f"the page is askew by {degrees:.1f} degrees: it was set straight"
    return Paper(grey, coloured_ink, [*paper.remarks, remark], to_picture, is_on_side)


# --- pages and what surrounds them ----------------------------------------------------------------


class Flat(NamedTuple):
    """The map that lays a page flat.

    Attributes
    ----------
    frame : ndarray, shape (3, 3)
        Projective map from the unit square to the picture, the page's corners to its corners.
    edges : ndarray, shape (4, 3)
        Deviations of the left, right, upper and lower edge from the square's, as parabolas.
    size : tuple of int
        Width and height of the sheet, pixels.
    """

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

    def to_picture(self, points: Floats) -> Floats:
        """Return where points of the sheet, shape (..., 2), are in the picture."""
        u = np.clip(points[..., 0] / self.size[0], -0.05, 1.05)
        v = np.clip(points[..., 1] / self.size[1], -0.05, 1.05)
        u, v = (_MARGIN + (1 - 2 * _MARGIN) * part for part in (u, v))
        left_bend, right_bend, upper_bend, lower_bend = (
            np.polyval(edge, at) for edge, at in zip(self.edges, (v, v, u, u), strict=True)
        )
        x = u + (1 - u) * left_bend + u * right_bend
        y = v + (1 - v) * upper_bend + v * lower_bend
        place = np.stack([x, y, np.ones_like(x)], axis=-1) @ self.frame.T
        return np.asarray(place[..., :2] / place[..., 2:])

    def resample(self, picture: Image, beyond: float) -> Image:
        """Return the sheet resampled from a picture, ``beyond`` outside of it."""
        width, height = self.size
        sheet = np.empty((height, width), np.float32)
        for top in range(0, height, 256):  # in strips, for memory
            rows = np.arange(top, min(top + 256, height))
            points = np.stack(np.meshgrid(np.arange(width) + 0.5, rows + 0.5), axis=-1)
            place = self.to_picture(points) - 0.5
            sheet[rows] = ndimage.map_coordinates(
                picture, [place[..., 1], place[..., 0]], order=1, cval=beyond
            )
        return sheet


def _find_pages(grey: Image) -> list[tuple[Flat | None, str]]:
    """Return the pages that a picture shows, from left to right, each with a remark or "".

    None stands for a page that fills the picture.
    """
    scale = min(1.0, _COARSE / max(grey.shape))
    small = resize(grey, scale)
    pages: list[tuple[Flat | None, str]] = []
    for start, stop in _page_columns(small):
        mask = _page_mask(small[:, start:stop])
        flat = None
        if mask is not None:
            on_picture = np.zeros(small.shape, bool)
            on_picture[:, start:stop] = mask
            flat = _flatten(on_picture, scale)
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


def _page_columns(small: Image) -> list[tuple[int, int]]:
    """Return the columns left and right of a dark band that runs down a picture, or all of them."""
    height, width = small.shape
    is_dark = small < 0.8 * ndimage.maximum_filter1d(ndimage.uniform_filter(small, 3), 61, axis=1)
    labels, _ = ndimage.label(is_dark, np.ones((3, 3)))
    for at, box in enumerate(ndimage.find_objects(labels), 1):
        down, across = box[0].stop - box[0].start, box[1].stop - box[1].start
        middle = (box[1].start + box[1].stop) / 2 / width
        filling = (labels[box] == at).any(axis=1).mean()
        is_central = abs(middle - 0.5) < _OFF_CENTRE
        if is_central and down * filling > 0.9 * height and across < _MAX_GUTTER * width:
            return [(0, max(box[1].start - 1, 1)), (min(box[1].stop + 1, width - 1), width)]
    return [(0, width)]


def _page_mask(small: Image) -> Mask | None:
    """Return a mask of the page, None if nothing surrounds it.

    Page and surround are separated by the threshold between two shades, after type was closed over
    and soft shadows were taken away.
    """
    size = max(3, round(_TYPE_WIDTH * max(small.shape)))
    plain = _without_shadows(ndimage.grey_closing(small, size=(size, size), mode="nearest"))
    is_bright = plain > threshold(plain)
    if is_bright.all() or not is_bright.any():
        return None
    page, surround = float(np.median(plain[is_bright])), float(np.median(plain[~is_bright]))
    if surround > _MAX_SURROUND * page:
        return None
    labels, count = ndimage.label(ndimage.binary_opening(is_bright, iterations=2))
    if not count:
        return None
    areas = ndimage.sum_labels(is_bright, labels, range(1, count + 1))
    mask = ndimage.binary_fill_holes(labels == int(np.argmax(areas)) + 1)
    return mask if _MIN_PAGE < mask.mean() < _MAX_PAGE else None


def _without_shadows(plain: Image) -> Image:
    """Return a picture as it would look in even light: only its sharp edges are kept (retinex, Horn
    1974).

    The logarithm's differences between neighbouring pixels that are smaller than `_SHADOW_STEP` are
    the light's; what has the others alone, in the least-squares sense, solves Poisson's equation.
    """
    light = np.log(np.maximum(plain, 1.0)).astype(float)
    divergence = np.zeros_like(light)
    for axis in (0, 1):
        along, target = np.moveaxis(light, axis, 0), np.moveaxis(divergence, axis, 0)
        steps = np.diff(along, axis=0)
        steps[np.abs(steps) < _SHADOW_STEP] = 0.0
        target[:-1] += steps
        target[1:] -= steps
    waves = [2 * np.cos(np.pi * np.arange(length) / length) - 2 for length in light.shape]
    curvature = waves[0][:, None] + waves[1][None, :]
    curvature[0, 0] = 1.0
    even = fft.idctn(fft.dctn(divergence) / curvature)
    brightest = float(np.percentile(plain, 95))
    return np.asarray(brightest * np.exp(even - np.percentile(even, 95)), np.float32)


def _flatten(mask: Mask, scale: float) -> Flat | None:
    """Return the map that lays a page flat by its edges, None if they are not those of a sheet."""
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
    for side, (across, down) in enumerate(sides):
        points = np.stack([across / scale, down / scale, np.ones(len(across))], axis=-1)
        place = points @ inverse.T
        place = place[:, :2] / place[:, 2:]
        offsets, along = place[:, side // 2] - side % 2, place[:, 1 - side // 2]
        is_near = (np.abs(offsets) < _MAX_CURL) & (along > 0.02) & (along < 0.98)
        if is_near.sum() < 0.5 * len(is_near):
            return None
        for _ in range(3):
            edge = np.polyfit(along[is_near], offsets[is_near], 2)
            residuals = np.abs(np.polyval(edge, along) - offsets)
            is_near &= residuals < max(0.003, 3 * float(np.median(residuals[is_near])))
        edges.append(edge)
    return flat._replace(edges=np.array(edges))
