"""Pictures of pages: PNG, JPEG and TIFF files and PDFs, as grey arrays."""

import io
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import PIL.Image
from PIL import ImageOps

from ..errors import UserError
from ..files import called
from .ink import Image

_DOTS_PER_INCH = 300
"""Of a PDF's page: a character of 10 or 12 an inch is 25 to 30 pixels wide."""
_MOST_PIXELS = 60_000_000
"""Of a page: more than A3 at 500 dots an inch."""
_MOST_PAGES = 200
"""Of a file, at a second or two each."""


class Page(NamedTuple):
    """One page: its number, its picture in grey, and the text layer of a PDF ("": none)."""

    number: int
    grey: Image
    text: str = ""


def pages_of(data: bytes, path: str) -> Iterator[Page]:
    """The pages of a file. Raises UserError when it cannot be read."""
    if data.startswith(b"%PDF-"):
        yield from _pdf(data, called(path))
        return
    try:
        with PIL.Image.open(io.BytesIO(data)) as picture:
            for number in range(min(getattr(picture, "n_frames", 1), _MOST_PAGES)):
                picture.seek(number)
                if picture.width * picture.height > _MOST_PIXELS:
                    size = f"{picture.width} x {picture.height}"
                    raise UserError(
                        f"{called(path)}: page {number + 1}: {size} pixels; expected at most "
                        f"{_MOST_PIXELS:,}"
                    )
                yield Page(number + 1, _grey(picture))
    except (OSError, SyntaxError, ValueError, PIL.Image.DecompressionBombError) as error:
        message = str(error).splitlines()[0] if str(error) else "damaged"
        raise UserError(f"{called(path)}: is not a picture that can be read: {message}") from None


def _grey(picture: PIL.Image.Image) -> Image:
    upright = ImageOps.exif_transpose(picture)
    if upright.mode in ("RGBA", "LA", "P", "PA"):  # what is transparent is paper
        upright = upright.convert("RGBA")
        paper = PIL.Image.new("RGBA", upright.size, "white")
        upright = PIL.Image.alpha_composite(paper, upright)
    if upright.mode.startswith(("I", "F")):
        values = np.asarray(upright, np.float32)
        return values * np.float32(255 / max(float(values.max(initial=1)), 1))
    return np.asarray(upright.convert("L"), np.float32)


def _pdf(data: bytes, where: str) -> Iterator[Page]:
    try:
        import pypdfium2

        document = pypdfium2.PdfDocument(data)
    except ImportError:
        missing = "PDFs need pypdfium2, which is not installed; pip install 'impact88[scan]'"
        raise UserError(f"{where}: {missing}") from None
    except pypdfium2.PdfiumError:
        raise UserError(f"{where}: is not a PDF that can be read") from None
    for number in range(min(len(document), _MOST_PAGES)):
        page = document[number]
        width, height = page.get_size()
        scale = min(_DOTS_PER_INCH / 72, (_MOST_PIXELS / max(width * height, 1)) ** 0.5)
        bitmap = page.render(scale=scale, grayscale=True)
        text = page.get_textpage().get_text_bounded()
        yield Page(number + 1, np.asarray(bitmap.to_numpy(), np.float32).squeeze(), text)
