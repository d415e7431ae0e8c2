"""Cells of pages that are drawn without a font: what stands in their blanks, and beside the type.

Digits are those of a known style, letters are blots: type is what recurs.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from longer import long_but
from scipy import ndimage

from impact88.printouts.scan.grid import CELL_WIDTH, SLACK, Grid
from impact88.printouts.scan.holding import (
    MAX_DIFFERING,
    MAX_SPECKS,
    Added,
    Cell,
    compare_cells,
    state,
)
from impact88.printouts.scan.layout import Piece, Place, Row, Sheet
from impact88.printouts.scan.residue import Explained, Kind, residue_of
from impact88.printouts.scan.scenes import Candidate, Read
from impact88.printouts.scan.typeface import READABLE, prototypes, read_numbers

HEIGHT, COLUMNS, LEADING = 24, 42, 30
NUMBERS = ["-29.04", "14.52", "25.15", "-13.263", "100904.929", "-.715", "143.5", "3728"]
ROWS = [
    [("ABCD"[line] + "XY"[k] + "=", NUMBERS[2 * line + k]) for k in (0, 1)] for line in range(4)
]
Ink = Mapping[Place, Any]
PLAIN: Ink = {}


@cache
def glyph(character: str, style: int = 0) -> Any:
    """A character's ink, 0 to 1, in a cell."""
    characters, known = prototypes()
    if character in characters:
        return known[style, characters.index(character)]
    if character == " ":
        return np.zeros((HEIGHT, CELL_WIDTH))
    if character == ",":
        return np.maximum(glyph("."), np.roll(glyph("."), (3, -1), (0, 1)))
    noise = np.random.default_rng(ord(character)).normal(0, 1, (HEIGHT, CELL_WIDTH))
    blot = ndimage.gaussian_filter(noise, 2) > 0.05
    return np.pad(1.0 * blot[4:20, 2:14], ((4, 4), (2, 2)))


def drawn_page(
    added: Ink = PLAIN, noise: float = 0.03, typed: str = "", rows_of: Any = ROWS
) -> tuple[Grid, Sheet]:
    """The grid of a page of some rows with some ink added, and the rows on it.

    ``typed``: a line below them that is no row.
    """
    random = np.random.default_rng(1988)
    pictures, rows = [], {}
    for line, parts in enumerate([*rows_of, []]):
        text, pieces = "  " + (typed if not parts else ""), []
        for label, number in parts:
            for name, part in (("", f"{label} "), (label[:2], number), ("", " ")):
                places = [Place(line, len(text) + k) for k in range(len(part))]
                pieces.append(Piece(name, part, places))
                text += part
        cells = [
            glyph(character) + added.get(Place(line, at), 0)
            for at, character in enumerate(text.ljust(COLUMNS))
        ]
        picture = np.pad(np.hstack(cells), SLACK)
        pictures.append((picture + random.normal(0, noise, picture.shape)).astype(np.float32))
        if parts:
            rows[6 + line] = Row(line, 1, 2, text[2:], pieces)
    edges = CELL_WIDTH * np.arange(COLUMNS + 1.0)
    corners = [
        np.stack([np.stack([edges, np.full_like(edges, top + y)], 1) for y in (0, HEIGHT)], 1)
        for top in LEADING * np.arange(len(pictures))
    ]
    size = (LEADING * len(pictures), CELL_WIDTH * COLUMNS)
    tops = LEADING / CELL_WIDTH * np.arange(len(pictures))
    grid = Grid(pictures, tops, corners, float(CELL_WIDTH), 1.0, size, 0)
    return grid, Sheet(rows)


def compared(*given: Any, **options: Any) -> tuple[Grid, dict[Place, Cell]]:
    """The grid of such a page and its cells by place, compared with what was printed."""
    grid, sheet = drawn_page(*given, **options)
    fields = {piece.name: piece.text for row in sheet.rows.values() for piece in row.pieces}
    candidate = Candidate({}, SimpleNamespace(fields=fields, ending=None), 0.0)  # type: ignore[arg-type]
    (cells,) = compare_cells(grid, [(Read(sheet, {}), candidate)])
    return grid, {cell.place: cell for cell in cells}


def test_commas_of_a_reply_are_told_from_points() -> None:
    """Clearly, though the first names are figures alone."""
    replies = [("A,B,C", "-29.04,0,0"), ("D,E,F", "14.52,25.15,0")]
    grid, sheet = drawn_page(noise=0.08, rows_of=[*ROWS, *([reply] for reply in replies)])
    (costs,) = read_numbers(grid, [sheet])
    for label, reply in replies:
        read = costs[label[:2]]
        assert "".join(READABLE[k] for k in read.argmin(axis=1)) == reply
        commas = [at for at, character in enumerate(reply) if character == ","]
        assert read[commas, READABLE.index(".")].min() > 2


BLANK, LAST = Place(0, 12), Place(0, 11)
"""The blank after a number, -29.04, and its last digit."""


def strewn(count: int) -> Ink:
    """So many specks in blanks at the right, each as dark as a point's ink may be."""
    return {Place(1 + line, 40): 0.65 * glyph(".") for line in range(count)}


def blotted(digit: str, style: int, blot: float) -> Any:
    """A digit with a blot beside its ink."""
    shape = glyph(digit, style)
    return shape + blot * glyph("%") * (shape < 0.1)


@pytest.mark.parametrize(
    ("added", "expected"),
    long_but(
        [
            ({BLANK: 0.57 * glyph("7")}, Added.NOTHING),  # its ink is that squared
            ({BLANK: 0.62 * glyph("7")}, Added.CHARACTER),
            ({BLANK: 0.68 * glyph(".")}, Added.NOTHING),  # a point is as light as a speck
            ({BLANK: 0.74 * glyph(".")}, Added.CHARACTER),
            ({BLANK: blotted("7", 0, 1.2)}, Added.CHARACTER),
            ({BLANK: blotted("7", 0, 1.5)}, Added.MARK),  # hardly half of it is the digit's
            ({BLANK: glyph("."), **strewn(MAX_SPECKS - 1)}, Added.CHARACTER),
            ({BLANK: glyph("."), **strewn(MAX_SPECKS)}, Added.BESIDE),  # it may be one of them
            ({BLANK: glyph("7"), **strewn(MAX_SPECKS)}, Added.CHARACTER),
            ({Place(0, 22 + k): glyph("7") for k in range(MAX_DIFFERING)}, Added.CHARACTER),
            ({Place(0, 22 + k): glyph("7") for k in range(MAX_DIFFERING + 1)}, Added.BESIDE),
            ({Place(0, 24): glyph("7")}, Added.BESIDE),
        ],
        kept=(1, 5, 7),
    ),
)
def test_what_a_blank_holds(added: Ink, expected: Added) -> None:
    cells = compared(added)[1]
    cell = cells[next(iter(added))]
    assert cell.added is expected
    assert state(cell) == ("differs" if expected is Added.CHARACTER else "holds")
    assert all(state(other) == "holds" for place, other in cells.items() if place not in added)


@pytest.mark.parametrize(
    ("ink", "shown", "expected"),
    long_but(
        [
            (glyph("7", 2), "7", "differs"),
            (blotted("7", 2, 0.3), "7", "differs"),
            (blotted("7", 2, 0.4), "", "doubtful"),  # a blot may be anything
            (0.7 * glyph("7", 2) + 0.3 * glyph("4", 2), "7", "differs"),
            (0.6 * glyph("7", 2) + 0.4 * glyph("4", 2), "", "doubtful"),  # as like what is printed
            (np.roll(glyph("4"), SLACK, 1), "", "holds"),
            (np.roll(glyph("4"), SLACK + 2, 1), "", "doubtful"),
        ],
        kept=(2,),
    ),
)
def test_a_digit_in_another_typeface(ink: Any, shown: str, expected: str) -> None:
    cell = compared({LAST: ink - glyph("4")})[1][LAST]
    assert (cell.foreign_digit, state(cell)) == (shown, expected)


@pytest.mark.parametrize(
    ("strength", "is_near"), long_but([(0.3, False), (0.45, True), (1.4, True), (1.9, False)])
)
def test_the_strength_of_a_ribbon_is_no_distance(strength: float, is_near: bool) -> None:
    cell = compared({LAST: (strength - 1) * glyph("4")})[1][LAST]
    assert (cell.distance < 4) is is_near


@pytest.mark.parametrize(("strength", "is_lost"), long_but([(0.83, False), (0.77, True)]))
def test_a_digit_may_be_lost_where_others_are_pale(strength: float, is_lost: bool) -> None:
    """One in a hundred of them."""
    ink = {
        Place(line, 7 + at): (strength - 1) * glyph(digit)
        for line in (2, 6)
        for at, digit in enumerate("009")
    }
    cell = compared({**ink, LAST: -glyph("4")}, rows_of=2 * ROWS)[1][LAST]
    assert cell.other == " "
    assert state(cell) == ("doubtful" if is_lost else "differs")


def test_on_a_page_without_noise_the_usual_distance_is_that_of_an_excellent_scan() -> None:
    """There a trace of ink would be a thousand times as far as is usual."""
    trace = {LAST: 0.2 * glyph("%") * (glyph("4") < 0.1)}
    for noise in (1e-3, 1e-2):
        assert compared(trace, noise)[1][LAST].distance == pytest.approx(1.1, rel=0.4)


def left_over(drawn: Any, added: Ink = PLAIN, typed: str = "") -> list[Any]:
    """The marks of a sheet on which something is drawn, ink from 0 to 1, below a page's rows."""
    grid, cells = compared(added, typed=typed)
    ink = np.zeros((2 * grid.size[0], grid.size[1]), np.float32)
    for line, picture in enumerate(grid.pictures):
        ink[LEADING * line :][:HEIGHT] = picture[SLACK:-SLACK, SLACK:-SLACK]
    ink[-len(drawn) :, : drawn.shape[1]] += drawn
    explained = Explained(grid, [*cells.values()], set(range(len(ROWS))), set())
    return residue_of(ink, None, [explained])


WIDTH = COLUMNS * CELL_WIDTH


def boxes(*sides: tuple[int, int, int], ink: float = 1.0) -> Any:
    """Rectangles 20 pixels below the sheet's last row: left edge, width, height; and their ink."""
    drawn = np.zeros((150, WIDTH), np.float32)
    for left, width, height in sides:
        drawn[20 : 20 + height, left : left + width] = ink
    return drawn


@pytest.mark.parametrize(
    ("drawn", "expected"),
    long_but(
        [
            (boxes((60, 5, 5)), []),  # a speck
            (boxes((60, 6, 6)), [Kind.MARK]),
            (boxes((60, 31, 31)), [Kind.MARK]),
            (boxes((60, 32, 32)), [Kind.STROKE]),  # two cells wide
            (boxes((60, 20, 20), ink=0.28), []),
            (boxes((60, 20, 20), ink=0.32), [Kind.MARK]),
            (boxes((60, 20, 20), (90, 20, 20)), [Kind.STROKE]),  # its parts are ten pixels apart
            (boxes((60, 20, 20), (91, 20, 20)), [Kind.MARK, Kind.MARK]),
            (boxes((60, int(0.39 * WIDTH), 4)), [Kind.STROKE]),
            (boxes((60, int(0.41 * WIDTH), 4)), []),  # a rule of the paper
        ],
        kept=(1, 7),
    ),
)
def test_what_is_left_of_a_sheet(drawn: Any, expected: list[Kind]) -> None:
    marks = left_over(drawn)
    assert [mark.kind for mark in marks] == expected
    assert not any(mark.bears for mark in marks)


@pytest.mark.parametrize(("height", "count"), long_but([(4, 0), (6, 1)]))
def test_a_glyph_reaches_a_little_over_the_edge_of_its_cell(height: int, count: int) -> None:
    foot = (len(ROWS) - 1) * LEADING + HEIGHT
    drawn = np.zeros((2 * LEADING * (len(ROWS) + 1), WIDTH), np.float32)
    drawn[foot : foot + height, 6 * CELL_WIDTH : 8 * CELL_WIDTH] = 1.0
    assert len(left_over(drawn)) == count


def test_a_dot_of_a_pen_in_the_blank_after_a_number_bears() -> None:
    """As large as one that is a speck elsewhere."""
    dot = np.pad(np.ones((5, 5)), ((10, HEIGHT - 15), (5, CELL_WIDTH - 10)))
    (mark,) = left_over(boxes((60, 5, 5)), {BLANK: dot})
    assert (mark.kind, mark.place, mark.bears) == (Kind.MARK, BLANK, True)


@pytest.mark.parametrize(
    ("typed", "expected"),
    long_but(
        [("72", ""), ("725", "725"), ("725%%%", "725???"), ("725%%%%", ""), ("7 2 5", "7 2 5")],
        kept=(3,),
    ),
)
def test_a_typed_line_is_half_of_characters_of_the_page(typed: str, expected: str) -> None:
    marks = [mark for mark in left_over(boxes(), typed=typed) if mark.kind is Kind.TYPE]
    assert [mark.reads for mark in marks] == [expected] * bool(expected)


@pytest.mark.parametrize(("part", "expected"), long_but([(0.6, "7?25"), (0.7, "7325")]))
def test_a_typed_character_is_certain_where_no_other_is_as_near(part: float, expected: str) -> None:
    ink = part * glyph("3") + (1 - part) * glyph("2")
    (mark,) = left_over(boxes(), {Place(4, 3): ink}, typed="7 25")
    assert (mark.reads, mark.sure) == ("7325", expected)
