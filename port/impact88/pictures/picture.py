"""A file's pages as ink: 0 for paper, about 1 for type, upright as the file says."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import PIL.Image
from numpy.typing import NDArray
from PIL import ImageOps
from scipy import ndimage

from ..errors import UserError
from .pdfpages import MAX_PAGES, render_pages

Floats = NDArray[np.float64]
Image = NDArray[np.float32]

MAX_PIXELS = 60_000_000  # of a page in its file: A3 at 500 dots an inch has 48 million
MAX_SIDE = 4000  # pixels of a page as it is read: 20 for each of 200 columns
SHADOW = 0.3  # brightness of the darkest shadow on paper, relative to the lightest paper
PAPER = 80  # percentile of the darkness that is still paper: type covers a tenth of a page
DARK = 0.4  # ink from which a place is inked
MAX_SIZE = 0.3  # longer side of connected ink of type, as a fraction of the page's
TYPE_SIZE = 45  # the paper is closed over dark parts narrower than the page divided by this


class Page(NamedTuple):
    """A page of a file.

    Parameters
    ----------
    number : int
        Its number in the file, from 1.
    grey : ndarray of float32, shape (rows, columns)
        The picture, 0 (black) to 255.
    scale : float
        Pixels of the file per pixel of the picture.
    text : str
        The text layer of a PDF, "" for other files.
    """

    number: int
    grey: Image
    scale: float = 1.0
    text: str = ""


def read_pages(data: bytes, name: str, pages: range | None = None) -> Iterator[Page]:
    """Yield the pages of a picture or PDF.

    Parameters
    ----------
    data : bytes
        The file.
    name : str
        Its name, for messages.
    pages : range, optional
        The numbers of the pages that are read, from 1; all by default.

    Yields
    ------
    Page

    Raises
    ------
    UserError
        If the file is damaged, too large, or of another kind.
    """
    if data.startswith(b"%PDF-"):
        yield from _pdf_pages(data, name, pages)
        return
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of large pictures, which are refused below
            yield from _picture_pages(data, name, pages)
    except UserError:
        raise
    except Exception as error:  # of a decoder, of any kind, on a damaged file
        reason = str(error).split("\n")[0]
        if not reason or "<_io." in reason:  # Pillow names its stream
            reason = "unknown format, or damaged"
        raise UserError(f"is not a picture that can be read: {reason}", name) from None


def _picture_pages(data: bytes, name: str, pages: range | None) -> Iterator[Page]:
    with PIL.Image.open(io.BytesIO(data)) as file:
        _check_size(file, name, 1)
        count = int(getattr(file, "n_frames", 1))
        if count > MAX_PAGES:
            raise UserError(f"has {count:,} pages; expected at most {MAX_PAGES}", name)
        for number in pages or range(1, count + 1):
            if not 1 <= number <= count:
                raise UserError(f"page {number}: the file has {count}", name)
            file.seek(number - 1)
            _check_size(file, name, number)
            longer = max(file.size)
            if count == 1:  # a JPEG is made smaller while it is decoded
                file.draft("L", (MAX_SIDE, MAX_SIDE))
            grey = _grey(file)
            yield Page(number, grey, longer / max(grey.shape))


def _check_size(file: PIL.Image.Image, name: str, number: int) -> None:
    """Raise UserError for a picture that is larger than any page."""
    if file.width * file.height > MAX_PIXELS:
        size = f"page {number}: {file.width} x {file.height} pixels"
        raise UserError(f"{size}; expected at most {MAX_PIXELS:,}", name)


def _grey(file: PIL.Image.Image) -> Image:
    """Return a picture in grey, turned as its file says, no longer than `MAX_SIDE`."""
    picture = ImageOps.exif_transpose(file)
    if picture.mode.startswith(("I", "F")):  # 16 bits and more
        values = np.nan_to_num(np.asarray(picture, np.float32))
        values *= 255 / max(float(values.max()), 1.0)
        picture = PIL.Image.fromarray(np.clip(values, 0, 255).astype(np.uint8))
    elif picture.mode in ("RGBA", "LA", "P", "PA"):  # what is transparent is paper
        picture = picture.convert("RGBA")
        paper = PIL.Image.new("RGBA", picture.size, "white")
        picture = PIL.Image.alpha_composite(paper, picture)
    picture = picture.convert("L")
    if max(picture.size) > MAX_SIDE:
        picture.thumbnail((MAX_SIDE, MAX_SIDE), PIL.Image.Resampling.BOX)
    return np.asarray(picture, np.float32)


def _pdf_pages(data: bytes, name: str, pages: range | None) -> Iterator[Page]:
    for number, rendered in enumerate(render_pages(data, name, MAX_SIDE), 1):
        if pages is None or number in pages:
            pixels = np.frombuffer(rendered.pixels, np.uint8)
            grey = pixels.reshape(rendered.height, rendered.width).astype(np.float32)
            yield Page(number, grey, 1.0, rendered.text)


def resize(picture: Image, scale: float) -> Image:
    """Return a picture enlarged or reduced by a factor."""
    width, height = (max(1, round(length * scale)) for length in picture.shape[::-1])
    small = PIL.Image.fromarray(picture).resize((width, height), PIL.Image.Resampling.BILINEAR)
    return np.asarray(small, np.float32)


def ink_of(grey: Image) -> Image:
    """Return the ink of a page: how much darker it is than the paper around, 1 for full ink.

    Parameters
    ----------
    grey : ndarray of float32, shape (rows, columns)
        The page, 0 (black) to 255; a negative is inverted.

    Returns
    -------
    ndarray of float32, shape (rows, columns)
        0 for paper and for what surrounds the page, at most 1.5.

    Notes
    -----
    The paper is the picture closed over dark parts (the black-hat transform). Full ink is the mean
    darkness, weighted with its cube: grain of the paper has no weight then.
    """
    size = 10  # of the closing, pixels of a smaller picture
    small = resize(grey, min(1.0, size * TYPE_SIZE / max(grey.shape)))
    # type is a small part of a page: it draws the distribution to its own side of the paper
    if np.mean((small - ndimage.uniform_filter(small, size)) ** 3) > 0:
        grey, small = 255 - grey, 255 - small
    paper = ndimage.grey_closing(small, (size, size), mode="nearest")
    paper = ndimage.grey_erosion(paper, (3, 3), mode="nearest")  # no ink along the edge of a page
    rows, columns = grey.shape
    around = np.asarray(
        PIL.Image.fromarray(paper).resize((columns, rows), PIL.Image.Resampling.BILINEAR)
    )
    darkest = SHADOW * paper.max()
    ink: Image = grey / np.maximum(around, darkest)
    np.clip(1 - ink, 0, None, out=ink)
    ink[around < darkest] = 0
    # the paper was closed over its own grain, and is found too light
    ink -= np.percentile(ink, PAPER)
    np.clip(ink, 0, None, out=ink)
    cubes = ink**3
    ink *= cubes.sum() / max(np.vdot(cubes, ink), 1e-9)
    del cubes  # pages are large
    np.clip(ink, 0, 1.5, out=ink)
    return ink


class Points(NamedTuple):
    """Inked places of a page, x to the right and y down, in pixels from its middle."""

    x: Floats
    y: Floats
    span: float

    def sample(self, count: int) -> Points:
        """Return about ``count`` of the places."""
        part = slice(None, None, max(1, len(self.x) // count))
        return Points(self.x[part], self.y[part], self.span)


def points_of(ink: Image) -> Points:
    """Return the inked places of a page without single specks, 150,000 at most.

    Connected ink that is too large for type is left out: edges of the paper, bands, ruled lines.
    """
    around = ndimage.uniform_filter(ink, 3)
    dark = (ink > DARK) & (around > DARK / 2)
    del around
    labels, _ = ndimage.label(dark[::2, ::2], np.ones((3, 3)))
    rows, columns = (length / 2 for length in ink.shape)
    for number, box in enumerate(ndimage.find_objects(labels), 1):
        tall, wide = (part.stop - part.start for part in box)
        if tall > MAX_SIZE * rows or wide > MAX_SIZE * columns:
            part = np.kron(labels[box] == number, np.ones((2, 2), bool))
            top, left = 2 * box[0].start, 2 * box[1].start
            window = dark[top : top + part.shape[0], left : left + part.shape[1]]
            window &= ~part[: window.shape[0], : window.shape[1]]
    places = np.flatnonzero(dark)
    # a fixed stride would fall into step with the rows, whole pixels with the pitch
    random = np.random.default_rng(1988)
    if len(places) > 150_000:
        places = random.choice(places, 150_000, replace=False)
    height, width = ink.shape
    down, across = np.divmod(places, width) + random.random((2, len(places)))[::-1]
    return Points(across - width / 2, down - height / 2, float(max(ink.shape)))
