"""Ink that the transcript does not explain: marks of a pen, stamps, large specks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from .grid import CELL_WIDTH, SLACK, Grid
from .picture import DARK, Floats

MIN_AREA = 0.12  # of a mark, in squares of a cell's width: a full stop has as much


def marks_of(grid: Grid, filled: NDArray[np.bool_]) -> list[Floats]:
    """Return the marks outside the cells that a transcript fills.

    Parameters
    ----------
    grid : Grid
        The page.
    filled : ndarray of bool, shape (lines, cells)
        The cells of which the transcript explains the ink.

    Returns
    -------
    list of ndarray, shape (4, 2)
        Corners of each mark on the page, pixels, clockwise.
    """
    border = 2 * SLACK  # type may leave its cell
    is_free = np.ones(grid.ink.shape, bool)
    for line, cell in np.argwhere(filled).tolist():
        corners = grid.corners(line, cell) * grid.scale
        left, top = np.maximum(corners.min(axis=0) - border, 0).astype(int)
        right, foot = np.ceil(corners.max(axis=0) + border).astype(int)
        is_free[top:foot, left:right] = False
    dark = (grid.ink > DARK) & is_free
    labels, _ = ndimage.label(ndimage.binary_closing(dark, np.ones((3, 3), bool)))
    areas = np.bincount(labels[dark], minlength=labels.max() + 1)
    marks = []
    for number, box in enumerate(ndimage.find_objects(labels), 1):
        if areas[number] > MIN_AREA * CELL_WIDTH**2:
            top, foot = box[0].start / grid.scale, box[0].stop / grid.scale
            left, right = box[1].start / grid.scale, box[1].stop / grid.scale
            marks.append(np.array([[left, top], [right, top], [right, foot], [left, foot]]))
    return marks
