"""What a picture's verdict rests on, as the report's template shows it: the page with every
number's cells outlined, the cells in doubt beside the glyphs they were compared with, all margins.
"""

import base64
import io
from collections.abc import Sequence
from typing import Any

import numpy as np
from PIL import Image as Pillow

from .holding import DIFFERS, HOLDS, Cell, state
from .ink import Floats, Image
from .rates import HEADINGS, sentences, table
from .sheets import Leaf
from .typeface import BLANK, sample_of, typeface_of

_WIDEST = 1400
"""Pixels across the page as the report shows it; a digit of 80 columns has 17 of them."""
_MOST_STRIPS = 24
"""Three pages of the report; a printout that got a verdict has at most eight such cells."""


def exhibit(grey: Image, leaves: Sequence[Leaf], leaf: Leaf) -> dict[str, Any]:
    """One of a page's printouts: ``page``, ``width`` and ``height`` of its picture; ``cells``, each
    with its corners on it; ``marks``, what the program does not print, in the same way;
    ``strips``, the cells in doubt, and how many ``more`` there are; ``bars``, margins in 60 steps
    from -1.5 to 1.5; ``basis`` and ``rates``, how pages with known truth fared."""
    upright = np.rot90(grey, leaf.grid.turns)
    height, width = upright.shape
    scale = min(1.0, _WIDEST / width)
    size = (max(1, round(width * scale)), max(1, round(height * scale)))
    kinds = [(cell, state(cell), leaf.grid.around(*cell.place)) for cell in leaf.cells]
    doubted = [box for box in kinds if box[1] != "holds"]
    margins = [cell.margin for cell in leaf.cells if cell.name and cell.predicted != BLANK]
    counts, _ = np.histogram(np.clip(margins, -1.5, 1.499), bins=60, range=(-1.5, 1.5))
    return {
        "page": _uri(upright, size),
        "width": size[0],
        "height": size[1],
        "cells": [
            {
                "name": cell.name or "label",
                "predicted": cell.predicted,
                "other": shown(cell.other),
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
        "strips": _strips(upright, leaves, doubted[:_MOST_STRIPS], leaf),
        "more": max(0, len(doubted) - _MOST_STRIPS),
        "bars": (counts / max(counts.max(initial=1), 1)).tolist(),
        "margins": len(margins),
        "limits": (HOLDS, DIFFERS),
        "basis": sentences(),
        "rates": {"headings": HEADINGS, "rows": [*table()]},
    }


def _uri(picture: Image, size: tuple[int, int] | None = None) -> str:
    grey = np.ascontiguousarray(np.clip(picture, 0, 255).astype(np.uint8))
    shown, file = Pillow.fromarray(grey), io.BytesIO()
    (shown.resize(size) if size else shown).save(file, "PNG")
    return f"data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}"


def _strips(
    upright: Image, leaves: Sequence[Leaf], doubted: Sequence[tuple[Cell, str, Floats]], leaf: Leaf
) -> list[dict[str, Any]]:
    if not doubted:
        return []
    # the printouts on a grid share their mean characters
    everything = [cell for other in leaves if other.grid is leaf.grid for cell in other.cells]
    sample = sample_of(leaf.grid, [cell.place for cell in everything])
    typeface = typeface_of(sample, ["" if cell.cut else cell.predicted for cell in everything])

    def glyph(character: str, count: int) -> dict[str, Any]:
        at, picture = typeface.characters.find(character), ""
        if at >= 0:
            mean = typeface.means[at].reshape(typeface.shape)
            picture = _uri(255 - 220 * np.clip(mean, 0, 1))
        return {"name": shown(character), "picture": picture, "count": count}

    strips = []
    for cell, kind, around in doubted:
        beside = np.array([1.0, 0.2]) * np.ptp(around, axis=0)
        left, top = np.maximum(around.min(axis=0) - beside, 0).astype(int)
        right, bottom = np.maximum(around.max(axis=0) + beside, 1).astype(int)
        crop, (line, at) = upright[top:bottom, left:right], cell.place
        strips.append(
            {
                "place": f"{cell.name or 'label'}, line {line + 1}, cell {at + 1}",
                "paper": _uri(crop) if crop.size else "",
                "glyphs": [glyph(cell.predicted, cell.count), glyph(cell.other, cell.other_count)],
                "margin": f"{cell.margin:+.2f}",
                "state": kind,
            }
        )
    return strips


def shown(character: str) -> str:
    """A character as the report names it."""
    return "blank" if character == BLANK else character
