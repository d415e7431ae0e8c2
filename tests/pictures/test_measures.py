"""Thresholds of cells, on both sides, and the alignment of rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from impact88.pictures import transcript
from impact88.pictures.align import BESIDE, NUMBER, OPTIONAL, align, costs_of
from impact88.pictures.cells import CHARACTERS
from impact88.pictures.transcript import Cell

TEXT = "\n".join(f"{k * 'A'} MA= {7**k} MB= {13**k}" for k in range(8))
CELL = Cell(0, 0, "3", "VAX", "8", 1.0, 5.0, 9, 9)


@pytest.mark.parametrize(
    ("changes", "state"),
    [
        ({"margin": transcript.HOLDS - 0.01}, "holds"),
        ({"margin": transcript.HOLDS + 0.01}, "doubt"),
        ({"margin": transcript.DIFFERS - 0.01}, "doubt"),
        ({"margin": transcript.DIFFERS + 0.01}, "differs"),
        ({"distance": transcript.MIN_DISTANCE - 0.01}, "doubt"),
        ({"distance": transcript.MIN_DISTANCE + 0.01}, "differs"),
        ({"margin": -0.5, "distance": transcript.MAX_FOREIGN - 0.1}, "holds"),
        ({"margin": -0.5, "distance": transcript.MAX_FOREIGN + 0.1}, "doubt"),
        ({"other_members": transcript.MIN_MEMBERS - 1}, "doubt"),
        ({"other_members": transcript.MIN_MEMBERS}, "differs"),
        ({"other": " "}, "doubt"),
        ({"predicted": " ", "margin": transcript.DIFFERS - 0.01}, "holds"),
        ({"predicted": " ", "margin": transcript.DIFFERS + 0.01}, "differs"),
        ({"name": "", "members": transcript.MIN_MEMBERS - 1}, "doubt"),
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


def test_row_and_line_of_another_text() -> None:
    rows = align(costs("VX= 1 VY= 2"), ["INITIAL KE= # KE LOSS= # %"])
    assert rows.gains[0, 0] < transcript.MIN_GAIN * len("INITIALKE=KELOSS=%")


def test_grid_moves_its_lines() -> None:
    from typedpages import draw

    from impact88.pictures.grid import grids_of
    from impact88.pictures.picture import ink_of, points_of

    ink = ink_of(draw(TEXT, margin=120).astype(np.float32))
    (grid,) = grids_of(ink, points_of(ink))
    assert grid.pitch == pytest.approx(16, abs=0.3)
    assert len(grid.middles) == 8
    own = np.zeros_like(grid.own)
    own[2, 0] = 3.0
    moved = replace(grid).move_lines(own)
    assert moved.corners(2, 0)[0, 0] - grid.corners(2, 0)[0, 0] == pytest.approx(3, abs=0.1)
    assert moved.corners(3, 0)[0, 0] == grid.corners(3, 0)[0, 0]
