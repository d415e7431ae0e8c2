"""Pictures of pages from PNG, JPEG and TIFF files and PDFs, in the resolution that is read."""

import io
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import PIL.Image
from numpy.typing import NDArray
from PIL import ImageOps

from ...errors import UserError
from ...files import display_name
from .pdfpages import MAX_PAGES, PdfError, render_pages

Picture = NDArray[np.uint8]
"""Grey, shape (rows, columns), or red, green and blue, shape (rows, columns, 3)."""

MAX_PIXELS = 60_000_000  # of a page in its file: more than A3 at 500 dots an inch
MAX_SIDE = 4000
"""Pixels of the longer side of a page as it is read. The widest page, 200 columns of two printouts
side by side, then has 20 pixels a character, of which 16 are read. The longest of 400 pages has
3,888."""


class Page(NamedTuple):
    """One page of a file.

    Attributes
    ----------
    number : int
        Number of the page, from 1.
    picture : ndarray
        Its picture.
    text : str
        Text layer of a PDF, "" if there is none.
    scale : float
        Pixels of the file, on its longer side, per pixel of the picture.
    """

    number: int
    picture: Picture
    text: str = ""
    scale: float = 1.0


def pages_of(data: bytes, path: str) -> Iterator[Page]:
    """Yield the pages of a file. Raises UserError when it cannot be read."""
    if data.startswith(b"%PDF-"):
        yield from _pdf(data, display_name(path))
        return
    name, number = display_name(path), 1
    try:
        with PIL.Image.open(io.BytesIO(data)) as file:
            count = getattr(file, "n_frames", 1)
            if count > MAX_PAGES:
                raise UserError(f"has {count:,} pages; expected at most {MAX_PAGES}", name)
            for number in range(1, count + 1):
                file.seek(number - 1)
                if file.width * file.height > MAX_PIXELS:
                    size = f"{file.width} x {file.height}"
                    limit = f"expected at most {MAX_PIXELS:,}"
                    raise UserError(f"{name}: page {number}: {size} pixels; {limit}")
                longer = max(file.size)
                if count == 1:  # a JPEG is made smaller while it is decoded
                    file.draft(None, (MAX_SIDE, MAX_SIDE))
                picture = _upright(file)
                yield Page(number, picture, "", longer / max(picture.shape[:2]))
    except UserError:
        raise
    except Exception as error:  # a library's, of whatever kind, on a file that is damaged
        message = str(error).splitlines()[0] if str(error) else "damaged"
        if "<_io." in message:  # Pillow names the stream, which is nothing to the user
            message = "unknown format, or damaged"
        raise UserError(f"{name}: is not a picture that can be read: {message}") from None


def _upright(file: PIL.Image.Image) -> Picture:
    """Return a picture turned as its file says, no longer than `MAX_SIDE`."""
    upright = ImageOps.exif_transpose(file)
    if upright.mode in ("RGBA", "LA", "P", "PA"):  # what is transparent is paper
        upright = upright.convert("RGBA")
        paper = PIL.Image.new("RGBA", upright.size, "white")
        upright = PIL.Image.alpha_composite(paper, upright).convert("RGB")
    elif upright.mode.startswith(("I", "F")):
        values = np.asarray(upright, np.float32)
        values = np.nan_to_num(values * np.float32(255 / max(float(values.max(initial=1)), 1)))
        upright = PIL.Image.fromarray(np.clip(values, 0, 255).astype(np.uint8))
    elif upright.mode in ("1", "L"):
        upright = upright.convert("L")
    else:
        upright = upright.convert("RGB")
    if max(upright.size) > MAX_SIDE:
        part = MAX_SIDE / max(upright.size)
        size = (max(1, round(upright.width * part)), max(1, round(upright.height * part)))
        upright = upright.resize(size, PIL.Image.Resampling.BOX)
    return np.asarray(upright, np.uint8)


def _pdf(data: bytes, where: str) -> Iterator[Page]:
    """Yield the pages of a PDF; ``where``: its name in messages."""
    try:
        for number, page in enumerate(render_pages(data, MAX_SIDE), 1):
            pixels = np.frombuffer(page.pixels, np.uint8)
            picture = pixels.reshape(page.height, page.width, 3)[:, :, ::-1]
            yield Page(number, picture, page.text)
    except PdfError as error:
        raise UserError(f"{where}: {error}") from None
