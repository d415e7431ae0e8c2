"""The evidence for a picture's verdict, for the report's template.

It is the page with every number's cells outlined, the cells in doubt beside the glyphs that they
were compared with, and a histogram of all margins.
"""

import base64
import io
from collections.abc import Sequence
from typing import Any

import numpy as np
from PIL import Image as Pillow

from .holding import DIFFERS, FOREIGN, HOLDS, Cell, state
from .ink import Floats, Image
from .residue import Explained
from .sheets import Leaf
from .typeface import BLANK

_MAX_WIDTH = 1400  # pixels across the page in the report; a digit of 80 columns has 17 of them
_MAX_STRIPS = 24  # three pages; a printout that got a verdict has at most eight such cells


def exhibit(grey: Image, leaves: Sequence[Leaf], leaf: Leaf) -> dict[str, Any]:
    """Return the evidence on one of a page's printouts.

    Parameters
    ----------
    grey : ndarray, shape (rows, columns)
        The page as it lies.
    leaves : sequence of Leaf
        All printouts of the page.
    leaf : Leaf
        The printout.

    Returns
    -------
    dict
        ``page``, ``width`` and ``height`` of the picture; ``cells`` and ``marks``, each with its
        corners on it; ``strips``, the cells in doubt, and the number of ``more``; ``bars``, the
        histogram of the margins in 60 steps from -``reach`` to ``reach``.
    """
    upright = np.rot90(grey, leaf.grid.turns)
    height, width = upright.shape
    scale = min(1.0, _MAX_WIDTH / width)
    size = (max(1, round(width * scale)), max(1, round(height * scale)))
    kinds = [(cell, state(cell), leaf.grid.around(*cell.place)) for cell in leaf.cells]
    questioned = [box for box in kinds if box[1] != "holds"]
    margins = [cell.margin for cell in leaf.cells if cell.name and cell.predicted != BLANK]
    reach = 1.5 * FOREIGN
    clipped = np.clip(margins, -reach, 0.999 * reach)
    counts, _ = np.histogram(clipped, bins=60, range=(-reach, reach))
    return {
        "page": _uri(upright, size),
        "width": size[0],
        "height": size[1],
        "cells": [
            {
                "name": cell.name or "label",
                "predicted": cell.predicted,
                "other": character_name(cell.other),
                "state": kind,
                "corners": (scale * around).tolist(),
            }
            for cell, kind, around in kinds
            if kind != "holds" or (cell.name and cell.predicted != BLANK)
        ],
        "marks": [
            {
                "kind": str(mark.kind),
                "reads": mark.reads,
                "bears": mark.bears,
                "corners": (scale * mark.corners).tolist(),
            }
            for mark in leaf.marks
        ],
        "strips": _strips(upright, leaves, questioned[:_MAX_STRIPS], leaf),
        "more": max(0, len(questioned) - _MAX_STRIPS),
        "bars": (counts / max(counts.max(initial=1), 1)).tolist(),
        "margins": len(margins),
        "limits": (HOLDS, DIFFERS),
        "reach": reach,
    }


def _uri(picture: Image, size: tuple[int, int] | None = None) -> str:
    """Return a picture as a data URI of a PNG, resized if ``size`` is given."""
    grey = np.ascontiguousarray(np.clip(picture, 0, 255).astype(np.uint8))
    image, file = Pillow.fromarray(grey), io.BytesIO()
    (image.resize(size) if size else image).save(file, "PNG")
    return f"data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}"


def _strips(
    upright: Image,
    leaves: Sequence[Leaf],
    questioned: Sequence[tuple[Cell, str, Floats]],
    leaf: Leaf,
) -> list[dict[str, Any]]:
    """Return the cells in doubt with their paper and the two glyphs they were compared with."""
    if not questioned:
        return []
    # the printouts on a grid share their mean characters
    all_cells = [
        cell for neighbour in leaves if neighbour.grid is leaf.grid for cell in neighbour.cells
    ]
    typeface = Explained(leaf.grid, all_cells, set(), set()).typeface

    def glyph(character: str, count: int) -> dict[str, Any]:
        """Return a mean glyph and the number of cells it was made of."""
        at, picture = typeface.characters.find(character), ""
        if at >= 0:
            mean = typeface.means[at].reshape(typeface.shape)
            picture = _uri(255 - 220 * np.clip(mean, 0, 1))
        return {"name": character_name(character), "picture": picture, "count": count}

    strips = []
    for cell, kind, around in questioned:
        margin = np.array([1.0, 0.2]) * np.ptp(around, axis=0)
        x0, y0 = np.maximum(around.min(axis=0) - margin, 0).astype(int)
        x1, y1 = np.maximum(around.max(axis=0) + margin, 1).astype(int)
        crop, (line, at) = upright[y0:y1, x0:x1], cell.place
        strips.append(
            {
                "place": f"{cell.name or 'label'}, line {leaf.grid.number(line)}, column {at + 1}",
                "paper": _uri(crop) if crop.size else "",
                "glyphs": [glyph(cell.predicted, cell.count), glyph(cell.other, cell.other_count)],
                "margin": f"{cell.margin:+.1f}",
                "state": kind,
            }
        )
    return strips


def character_name(character: str) -> str:
    """Return the name of a character in the report."""
    return "blank" if character == BLANK else character
