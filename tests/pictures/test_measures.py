"""Thresholds of cells, on both sides, and the alignment of rows."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from typedpages import draw

import impact88
from impact88.pictures.align import BESIDE, NUMBER, OPTIONAL, align, costs_of
from impact88.pictures.cells import (
    CHARACTERS,
    NUMERIC,
    Cells,
    cells_of,
    distances,
    known_glyphs,
    name_groups,
    pair_distances,
)
from impact88.pictures.grid import CELL_WIDTH, SLACK, Grid, grid_of
from impact88.pictures.picture import ink_of, points_of
from impact88.pictures.transcript import Cell, Reader, Transcript
from impact88.pictures.verdict import _gate_verdict
from impact88.printouts import Verdict, judge

TEXT = "\n".join(f"{k * 'A'} MA= {7**k} MB= {13**k}" for k in range(8))
CELL = Cell(0, 0, "3", "VAX", "8", 1.0, 5.0, 9, 9)


@pytest.mark.parametrize(
    ("changes", "state"),
    [
        ({"margin": -0.15}, "holds"),
        ({"margin": -0.07}, "doubt"),
        ({"margin": 0.3}, "doubt"),
        ({"margin": 0.5}, "differs"),
        ({"margin": -0.5, "distance": 7.0}, "holds"),
        ({"margin": -0.5, "distance": 10.0}, "doubt"),
        ({"other_members": 2}, "doubt"),
        ({"other_members": 4}, "differs"),
        ({"other": " "}, "doubt"),
        ({"predicted": ")", "members": 2}, "doubt"),
        ({"predicted": ")", "members": 4}, "differs"),
        ({"predicted": "U", "members": 2, "name": ""}, "differs"),
        ({"predicted": "3", "members": 2}, "differs"),
        ({"predicted": " ", "margin": 0.3}, "holds"),
        ({"predicted": " ", "margin": 0.5}, "differs"),
    ],
)
def test_state_of_a_cell(changes: dict[str, object], state: str) -> None:
    assert CELL._replace(**changes).state == state


def costs(text: str) -> dict[str, np.ndarray]:
    """Return the costs of a line that shows a text."""
    odds = np.array([[-6.0 if char == " " else 6.0 for char in text]])
    unlike = np.ones((1, len(text), len(CHARACTERS)))
    for cell, char in enumerate(text):
        if char != " ":
            unlike[0, cell, CHARACTERS.index(char)] = 0.05
    return costs_of(odds, unlike)


def states(text: str, row: str) -> str:
    """Return the states of the best path of a text through a row."""
    rows = align(costs(text), [row])
    return "".join(rows.states[state] or "~" for state in rows.paths[0])


def test_numbers_last_any_number_of_cells() -> None:
    assert states("  MA= 12.5 MB= 7  ", f"MA= {NUMBER} MB= {NUMBER}") == "~~MA= #### MB= #~~"


def test_optional_blanks() -> None:
    row = f":{OPTIONAL}Vax,{OPTIONAL}Vay"
    assert states("  :Vax,Vay ", row) == "~~:Vax,Vay~"
    assert states("  :Vax, Vay ", row) == "~~:Vax,_Vay~"


def test_index_in_a_row_counts_no_optional_blanks() -> None:
    rows = align(costs(" :Vax, Vay"), [f":{OPTIONAL}Vax,{OPTIONAL}Vay"])
    sources = rows.sources[rows.paths[0]].tolist()
    assert sources == [-1, 0, 1, 2, 3, 4, -1, 5, 6, 7]
    assert rows.states[rows.paths[0, 0]] == BESIDE


def test_the_row_that_explains_most() -> None:
    rows = align(costs("DA= 1.5 DB= 2.5"), ["MA= # MB= #", "DA= # DB= #"])
    assert rows.gains[0].argmax() == 1


@pytest.mark.parametrize(("likeness", "is_row"), [(0.2, True), (0.35, False)])
def test_line_is_a_row_or_other_text(likeness: float, is_row: bool) -> None:
    odds = np.full((1, 3), 6.0)
    rows = align(costs_of(odds, np.full((1, 3, len(CHARACTERS)), likeness)), ["MA="])
    assert (rows.gains[0, 0] > 0) == is_row


@pytest.mark.parametrize(("likeness", "is_number"), [(0.22, True), (0.25, False)])
def test_cell_is_in_a_number_or_beside_it(likeness: float, is_number: bool) -> None:
    odds = np.full((1, 3), 6.0)
    rows = align(costs_of(odds, np.full((1, 3, len(CHARACTERS)), likeness)), [NUMBER])
    assert (rows.gains[0, 0] > 0) == is_number


def typed(text: str) -> Grid | None:
    """Return the grid of a drawn text."""
    ink = ink_of(draw(text, margin=120).astype(np.float32))
    return grid_of(ink, points_of(ink))


def test_fewest_lines_of_a_page() -> None:
    line = "MA= 1234 MB= 56789 IA= 12"
    assert typed("\n".join([line] * 5)) is None
    assert typed("\n".join([line] * 7)) is not None


def test_most_columns_of_a_page() -> None:
    for columns, is_grid in ((130, True), (290, False)):
        grid = typed("\n".join(["MA= 47 " * (columns // 7)] * 7))
        assert (grid is not None and abs(grid.pitch - CELL_WIDTH) < 1) == is_grid


def test_height_of_a_cell() -> None:
    grid = typed("\n".join(["MA= 1234 MB= 56789 IA= 12"] * 7))
    assert grid is not None
    ink = grid.strip(3).sum()
    page = grid.ink.sum() / 7
    assert ink == pytest.approx(page, rel=0.08)


def cells_at(strip: np.ndarray) -> Cells:
    """Return the cells of a page that is one strip."""
    count = strip.shape[1] // CELL_WIDTH
    grid = SimpleNamespace(strip=lambda line: strip, middles=[0], count=count)
    return cells_of(cast(Grid, grid))


@pytest.mark.parametrize(("ink", "is_inked"), [(0.2, False), (0.35, True)])
def test_ink_of_a_cell(ink: float, is_inked: bool) -> None:
    strip = np.zeros((27 + 2 * SLACK, CELL_WIDTH + 2 * SLACK), np.float32)
    strip[10:14, 8:12] = ink
    assert (cells_at(strip).odds[0] > 0) == is_inked


@pytest.mark.parametrize(("shift", "is_same"), [(2, True), (3, False)])
def test_shifts_that_are_tried(shift: int, is_same: bool) -> None:
    strip = np.zeros((27 + 2 * SLACK, CELL_WIDTH + 2 * SLACK), np.float32)
    strip[10:14, 8:12] = 1.0
    mean = cells_at(strip).centred()
    moved = cells_at(np.roll(strip, shift, axis=0))
    assert (distances(moved, mean)[0, 0] < 0.01) == is_same


@pytest.mark.parametrize(
    ("strength", "is_same"), [(0.3, False), (0.5, True), (1.2, True), (1.6, False)]
)
def test_strengths_of_a_ribbon(strength: float, is_same: bool) -> None:
    strip = np.zeros((27 + 2 * SLACK, CELL_WIDTH + 2 * SLACK), np.float32)
    strip[10:14, 8:12] = 1.0
    mean = cells_at(strip).centred()
    assert (distances(cells_at(strength * strip), mean)[0, 0] < 0.01) == is_same


def two_figures() -> Cells:
    """Return cells of two figures, three of each."""
    _, glyphs = known_glyphs()
    pair = [glyphs[0, CHARACTERS.index(figure)] for figure in "38"]
    page = np.hstack([pair[k % 2] for k in range(6)])
    return cells_at(np.pad(page, ((3 + SLACK, SLACK), (SLACK, SLACK))))


@pytest.mark.parametrize(("spread", "names"), [(1.2, 1), (2.5, 2)])
def test_cells_of_one_figure(spread: float, names: int) -> None:
    cells = two_figures()
    unlike = np.ones((6, len(NUMERIC)))
    unlike[:, 8] = 0.1
    unlike[:, 3] = 0.12
    usual = float(pair_distances(cells)[0, 1]) / spread
    assert len({*name_groups(cells, unlike, usual)}) == names


@pytest.mark.parametrize(("step", "names"), [(0.07, 2), (0.15, 1)])
def test_price_of_a_second_figure_with_the_same_name(step: float, names: int) -> None:
    unlike = np.ones((6, len(NUMERIC)))
    unlike[:, 8] = 0.1
    unlike[:, 3] = 0.1 + step
    assert len({*name_groups(two_figures(), unlike, 0.01)}) == names


@pytest.mark.parametrize(("labels", "verdict"), [(1, Verdict.DIFFERS), (2, Verdict.INCOMPLETE)])
def test_more_differences_than_an_alteration_has(labels: int, verdict: Verdict) -> None:
    (result,) = judge(impact88.run(impact88.sample(1)).page.replace("VAX= -13.", "VAX= -18."))
    cells = [CELL, CELL, *(CELL._replace(name="", cell=k) for k in range(labels))]
    sheet = SimpleNamespace(line_cell=lambda offset: (0, 0), cells=cells, sheets=[result])
    assert _gate_verdict(result, cast(Transcript, sheet), []) is verdict


def reader_of(cells: Cells) -> Reader:
    """Return the reader of a line of six cells."""
    return Reader(cast(Grid, SimpleNamespace(middles=[0], count=6)), cells)


@pytest.mark.parametrize(("likeness", "is_row"), [(0.15, True), (0.21, False)])
def test_line_of_other_text_is_no_row(likeness: float, is_row: bool) -> None:
    reader = reader_of(two_figures())
    reader.unlike[:] = likeness
    assert bool(reader.place_rows(["******"])) == is_row


@pytest.mark.parametrize(("blot", "state"), [(0.3, "holds"), (0.55, "doubt")])
def test_blot_on_a_page_without_grain(blot: float, state: str) -> None:
    """Where equal cells are the same, the usual distance is a twentieth of their energy."""
    _, glyphs = known_glyphs()
    three = glyphs[0, CHARACTERS.index("3")]
    page = np.hstack([three] * 6)
    ink = np.sqrt(blot * (three**2).sum() / 9)
    page[20:23, :3] += ink
    cells = cells_at(np.pad(page, ((3 + SLACK, SLACK), (SLACK, SLACK))))
    reader = reader_of(cells)
    reader.predicted[:] = "3"
    reader.fields[:] = "MA"
    assert [cell.state for cell in reader.measure()] == [state] + ["holds"] * 5


def test_number_that_was_not_measured_is_open() -> None:
    (result,) = judge(impact88.run(impact88.sample(1)).page.replace("VAX= -13.", "VAX= -18."))
    held = CELL._replace(name="VAY", margin=-1.0)
    sheet = SimpleNamespace(line_cell=lambda offset: (0, 0), cells=[held], sheets=[result])
    assert _gate_verdict(result, cast(Transcript, sheet), []) is Verdict.INCOMPLETE


def test_grid_moves_its_lines() -> None:
    grid = typed(TEXT)
    assert grid is not None
    assert grid.pitch == pytest.approx(16, abs=0.3)
    assert len(grid.middles) == 8
    own = np.zeros_like(grid.own)
    own[2, 0] = 3.0
    moved = replace(grid).move_lines(own)
    assert moved.corners(2, 0)[0, 0] - grid.corners(2, 0)[0, 0] == pytest.approx(3, abs=0.1)
    assert moved.corners(3, 0)[0, 0] == grid.corners(3, 0)[0, 0]
