"""Pages typed with the known glyphs, cell by cell: pictures whose text is known."""

from __future__ import annotations

import io

import numpy as np
import PIL.Image
from scipy import ndimage

from impact88.pictures.cells import known_glyphs

CELL = (24, 16)  # rows and columns of a known glyph
LEADING = 40  # rows from line to line


def draw(text: str, style: int = 0, margin: int = 60) -> np.ndarray:
    """Return a page as grey values: glyphs of a known typeface, with white pixels around."""
    characters, glyphs = known_glyphs()
    lines = text.split("\n")
    columns = max(map(len, lines))
    page = np.zeros((LEADING * len(lines), CELL[1] * columns), np.float32)
    for row, line in enumerate(lines):
        for column, char in enumerate(line):
            if char != " ":
                top, left = row * LEADING, column * CELL[1]
                glyph = glyphs[style, characters.index(char)]
                page[top : top + CELL[0], left : left + CELL[1]] += glyph
    return 255 * (1 - np.pad(np.clip(page, 0, 1), margin))


def scan(grey: np.ndarray, angle: float = 0.0, blur: float = 0.6, noise: float = 8.0) -> np.ndarray:
    """Return a page turned by some degrees, blurred, and with grain."""
    turned = ndimage.rotate(grey, angle, reshape=False, order=1, cval=255) if angle else grey
    grain = np.random.default_rng(4).normal(0, noise, grey.shape)
    return np.clip(ndimage.gaussian_filter(turned, blur) * 0.9 + grain, 0, 255)


def encode(grey: np.ndarray, form: str = "PNG", mode: str = "L") -> bytes:
    """Return a picture as a file."""
    file = io.BytesIO()
    PIL.Image.fromarray(grey.astype(np.uint8)).convert(mode).save(file, form, compress_level=1)
    return file.getvalue()
