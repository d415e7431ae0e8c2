"""The picture of a page with the places of its findings, for the report and the web page."""

from __future__ import annotations

import base64
import io
from typing import NamedTuple

import numpy as np
import PIL.Image

from ..printouts import VERDICTS, Kind, Verdict
from .picture import Floats
from .verdict import PictureVerification


class Outline(NamedTuple):
    """A marked place of the picture.

    Parameters
    ----------
    corners : ndarray, shape (4, 2)
        Its corners, pixels of the exhibit, clockwise.
    look : str
        ``differs``, ``doubt`` or ``foreign``.
    note : str
        What is there.
    """

    corners: Floats
    look: str
    note: str


class Exhibit(NamedTuple):
    """A page with its marked places.

    Parameters
    ----------
    uri : str
        The picture, as a data URI of a PNG.
    width, height : int
        Its size, pixels.
    outlines : tuple of Outline
        The marked places.
    """

    uri: str
    width: int
    height: int
    outlines: tuple[Outline, ...]


def draw_page(result: PictureVerification) -> Exhibit:
    """Return the picture of a printout's page with its findings outlined.

    Parameters
    ----------
    result : PictureVerification
        The printout.
    """
    height, width = result.grey.shape
    file = io.BytesIO()
    PIL.Image.fromarray(np.clip(result.grey, 0, 255).astype(np.uint8)).save(file, "PNG")
    uri = f"data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}"
    outlines = []
    for finding, box in zip(result.verification.findings, result.boxes, strict=True):
        is_adverse = VERDICTS[finding.kind] is Verdict.DIFFERS
        look = "differs" if is_adverse else "foreign" if finding.kind is Kind.FOREIGN else "doubt"
        note = " ".join(filter(None, [finding.kind.value, finding.name, finding.read]))
        outlines.append(Outline(box, look, note))
    for cell, box in result.doubts:
        note = f"{cell.name or 'label'}: {cell.predicted!r} printed, like {cell.other!r}"
        outlines.append(Outline(box, "doubt", note))
    outlines += [Outline(box, "foreign", "ink that nothing explains") for box in result.marks]
    return Exhibit(
        uri, width, height, tuple(o._replace(corners=o.corners / result.scale) for o in outlines)
    )
