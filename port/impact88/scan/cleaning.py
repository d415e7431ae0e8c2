"""A picture of a page turned into paper: dark type on white, seen from straight above."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
import PIL.Image

from .ink import Floats, Image
from .picture import Picture


@dataclass
class Paper:
    """One sheet: its picture in ``grey``, 0 black and 255 white; ink of
    another colour than the type's in ``coloured``, from 0 to 1; and what was done to get it."""

    grey: Image
    coloured: Image | None = None
    remarks: list[str] = field(default_factory=list)

    def place(self, points: Floats) -> Floats:
        """Return where points of the sheet, shape (..., 2), are in the page's picture."""
        return points


def papers_of(picture: Picture) -> Iterator[Paper]:
    """Yield the sheets of paper that a picture shows."""
    yield Paper(_grey(picture))


def _grey(picture: Picture) -> Image:
    if picture.ndim == 2:
        return picture.astype(np.float32)
    return np.asarray(PIL.Image.fromarray(picture).convert("L"), np.float32)
