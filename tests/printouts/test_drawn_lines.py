"""Lines of type drawn without a font: where they are found, and which lines of print they are."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from longer import long_but

from impact88.printouts.scan.cleaning import papers_of
from impact88.printouts.scan.grid import grids_of
from impact88.printouts.scan.ink import points_of
from impact88.printouts.scan.layout import WRAP, Sheet, layout_of
from impact88.program.run import run
from impact88.program.scene import sample

ROWS = [row for row in run(sample(1)).page.split("\n") if row.strip()]
(ANGLES,) = (number for number, row in enumerate(ROWS) if "-19.8" in row)


def laid_out(rows: list[str], faint: tuple[int, int] | None = None) -> list[Sheet]:
    """The printouts in rows of text, a cell for each character; ``faint``: a cell of little ink."""
    width = max(map(len, rows)) + 3
    odds = [
        np.array([-6.0] + [6.0 if char.strip() else -5.0 for char in row.ljust(width)])
        for row in rows
    ]
    if faint:
        odds[faint[0]][1 + faint[1]] = -3.0
    return layout_of(odds, 1.5 * np.arange(len(rows))).sheets


def numbers(sheet: Sheet, rows: list[str]) -> dict[str, str]:
    """The numbers of a printout by name, as its cells have them."""
    return {
        piece.name: "".join(rows[place.line].ljust(99)[place.cell - 1] for place in piece.places)
        for row in sheet.rows.values()
        for piece in row.pieces
        if piece.name
    }


@pytest.mark.parametrize(("gap", "is_read"), long_but([(15, False), (14, True), (1, True)]))
def test_angles_stand_apart_as_people_type_them(gap: int, is_read: bool) -> None:
    rows = [*ROWS]
    rows[ANGLES] = f" -19.8{' ' * gap}-38.7   0 60 -30"
    (sheet,) = laid_out(rows)
    assert (numbers(sheet, rows)["PB"] == "-38.7") is is_read


@pytest.mark.parametrize(("blanks", "is_read"), long_but([(2, False), (3, True)]))
def test_other_text_may_stand_behind_a_line_after_some_blanks(blanks: int, is_read: bool) -> None:
    rows = [row + " " * blanks + "VAX= 37.64" if " MU=" in row else row for row in ROWS]
    (sheet,) = laid_out(rows)
    assert sheet.whole
    assert (numbers(sheet, rows)["EM"] == "-.715") is is_read


@pytest.mark.parametrize(("count", "is_printout"), [(7, False), (8, True)])
def test_a_printout_has_twenty_numbers(count: int, is_printout: bool) -> None:
    sheets = laid_out(ROWS[:count])
    assert len(sheets) == is_printout
    assert not any(sheet.whole for sheet in sheets)


def test_lines_broken_at_forty_columns_are_put_together() -> None:
    rows = [row[at : at + WRAP] for row in ROWS for at in range(0, len(row), WRAP)]
    (sheet,) = laid_out(rows)
    assert sheet.whole
    assert {line for line, row in sheet.rows.items() if row.used == 2} == {
        line for line, row in enumerate(ROWS) if len(row) > WRAP
    }


UX = next(number for number, row in enumerate(ROWS) if row.startswith("UX"))


@pytest.mark.parametrize(
    ("rows", "places"),
    long_but(
        [
            (ROWS, [range(15)]),
            ([*ROWS[:UX], *ROWS[UX + 1 :]], [[*range(UX), None, *range(UX, 14)]]),
            (["R. M. BRACH", *ROWS], [range(1, 16)]),
            ([*ROWS[:UX], "CHECKED BY RMB", *ROWS[UX:]], [[*range(UX), *range(UX + 1, 16)]]),
            ([*ROWS, *ROWS], [range(15), range(15, 30)]),
        ],
        kept=(3,),
    ),
    ids=["alone", "a line lost", "below a letterhead", "with a line between", "twice"],
)
def test_each_line_of_print_is_found(rows: list[str], places: list[Any]) -> None:
    sheets = laid_out(rows)
    assert [[row.start for _, row in sorted(sheet.rows.items())] for sheet in sheets] == [
        [place for place in on_sheet if place is not None] for on_sheet in places
    ]
    assert [sheet.whole for sheet in sheets] == [None not in on_sheet for on_sheet in places]


@pytest.mark.parametrize("number", long_but(["100904.929", "57.47"]))
def test_a_number_whose_digit_is_faint_is_one_number(number: str) -> None:
    (line,) = (line for line, row in enumerate(ROWS) if number in row)
    (sheet,) = laid_out(ROWS, (line, ROWS[line].index(number) + 1))
    assert number in numbers(sheet, ROWS).values()


LINES, CELLS, PITCH, LEADING = 9, 40, 12, 22


def drawn(slope: float = 0.0, keystone: float = 0.0, bow: float = 0.0) -> Any:
    """Ink of lines of characters of three by four dots, some blank, on paper that is bent."""
    size = (320, 600)
    y, x = np.indices(size) - np.array(size)[:, None, None] / 2
    across = (x + bow * x * x / size[1] + slope * y) / PITCH + CELLS / 2
    down = (y - x * (slope + keystone * y / size[1])) / LEADING + LINES / 2
    random = np.random.default_rng(1988)
    dots = random.random((LINES, CELLS, 4, 3)) > 0.35
    dots &= random.random((LINES, CELLS, 1, 1)) > 0.2
    row, column = np.floor([(down % 1 - 0.15) / 0.15, (across % 1 - 0.12) / 0.25]).astype(int)
    line, cell = np.floor([down, across]).astype(int)
    sides = ((row, 4), (column, 3), (line, LINES), (cell, CELLS))
    is_on = np.all([(at >= 0) & (at < count) for at, count in sides], axis=0)
    row, column, line, cell = (np.clip(at, 0, count - 1) for at, count in sides)
    return (is_on & dots[line, cell, row, column]).astype(np.float32)


@pytest.mark.parametrize(
    "bend",
    long_but(
        [
            {"slope": -0.05, "keystone": -0.04, "bow": -0.03},
            {"slope": 0.09},
            {"keystone": 0.06, "slope": 0.02},
            {"bow": 0.05},
            {},
        ]
    ),
    ids=str,
)
def test_columns_of_a_bent_page_are_clear(bend: dict[str, float]) -> None:
    ink = drawn(**bend)
    (grid,) = grids_of(ink, points_of(ink), 0)
    assert grid.pitch == pytest.approx(PITCH, rel=0.02)
    assert grid.clarity > 0.95
    assert len(grid.pictures) == LINES
    assert sum((row > 0).sum() for row in grid.odds()) == pytest.approx(
        0.8 * LINES * CELLS, rel=0.06
    )


def laid(size: tuple[int, int], grey: float, at: tuple[int, int]) -> Any:
    """A picture in one grey with a page of lines on it, 400 by 500 pixels."""
    page = np.full((500, 400), 230, np.uint8)
    page[60:440:16, 40:360] = page[64:440:16, 40:360:9] = 60
    picture = np.full(size, grey, np.uint8)
    picture[at[0] : at[0] + 500, at[1] : at[1] + 400] = page
    return picture


@pytest.mark.parametrize(
    ("size", "desk", "light", "is_laid_flat"),
    long_but(
        [
            ((620, 520), 0.79, 0.2, True),  # however dim the light
            ((620, 520), 0.81, 1.0, False),  # paper on paper
            ((620, 520), 0.79, 1.0, True),
            ((1160, 1010), 0.3, 1.0, True),
            ((1310, 1160), 0.3, 1.0, False),  # a seventh of the picture
        ],
        kept=(0, 1),
    ),
)
def test_a_page_is_laid_flat_where_its_surround_is_dark(
    size: tuple[int, int], desk: float, light: float, is_laid_flat: bool
) -> None:
    picture = laid(size, 230 * desk, (60, 60)) * light
    (paper,) = papers_of(picture.astype(np.uint8))
    assert bool(paper.remarks) is is_laid_flat


@pytest.mark.parametrize(("place", "count"), long_but([(0.26, 2), (0.24, 1), (0.74, 2), (0.76, 1)]))
def test_a_gutter_runs_near_the_middle(place: float, count: int) -> None:
    picture = np.hstack([laid((500, 400), 230, (0, 0))] * 2)
    middle = round(place * 800)
    picture[:, middle - 20 : middle + 20] = 230
    picture[:, middle - 8 : middle + 8] = 40
    assert len([*papers_of(picture)]) == count
