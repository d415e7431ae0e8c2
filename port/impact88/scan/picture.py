"""Pictures of pages: PNG, JPEG and TIFF files and PDFs, as grey arrays."""

import io
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..errors import UserError
from ..files import called
from .ink import Image

_DOTS_PER_INCH = 300
_MOST_PIXELS = 60_000_000
_MOST_PAGES = 200


@dataclass
class Page:
    """One page: its number, its picture in grey, and the text layer of a PDF ("": none)."""

    number: int
    grey: Image
    text: str = ""


def pages_of(data: bytes, path: str) -> Iterator[Page]:
    """The pages of a file. Raises UserError when it cannot be read."""
    try:
        import PIL.Image
    except ImportError:
        raise UserError(_lacking(path, "pillow")) from None
    if data.startswith(b"%PDF-"):
        yield from _pdf(data, path)
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


def _grey(picture: object) -> Image:
    from PIL import Image as Pillow
    from PIL import ImageOps

    assert isinstance(picture, Pillow.Image)
    upright = ImageOps.exif_transpose(picture)
    if upright.mode in ("RGBA", "LA", "P", "PA"):  # what is transparent is paper
        upright = upright.convert("RGBA")
        paper = Pillow.new("RGBA", upright.size, "white")
        upright = Pillow.alpha_composite(paper, upright)
    if upright.mode.startswith(("I", "F")):
        values = np.asarray(upright, np.float32)
        return values * np.float32(255 / max(float(values.max(initial=1)), 1))
    return np.asarray(upright.convert("L"), np.float32)


def _pdf(data: bytes, path: str) -> Iterator[Page]:
    try:
        import pypdfium2
    except ImportError:
        raise UserError(_lacking(path, "pypdfium2")) from None
    try:
        document = pypdfium2.PdfDocument(data)
    except pypdfium2.PdfiumError:
        raise UserError(f"{called(path)}: is not a PDF that can be read") from None
    for number in range(min(len(document), _MOST_PAGES)):
        page = document[number]
        width, height = page.get_size()
        scale = min(_DOTS_PER_INCH / 72, (_MOST_PIXELS / max(width * height, 1)) ** 0.5)
        bitmap = page.render(scale=scale, grayscale=True)
        text = page.get_textpage().get_text_bounded()
        yield Page(number + 1, np.asarray(bitmap.to_numpy(), np.float32).squeeze(), text)


def _lacking(path: str, package: str) -> str:
    return (
        f"{called(path)}: pictures need {package}, which is not installed; "
        "pip install 'impact88[scan]'"
    )
