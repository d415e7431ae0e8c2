"""Lines of a page aligned with rows of type: which row each line is, and what each cell holds.

A row is a chain of states, one a character; blanks and numbers last any number of cells. The best
path of each line through each row is found by dynamic programming (Viterbi), all at once.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .cells import BLANK, CHARACTERS, NUMERIC
from .picture import Floats

NUMBER = "#"  # a number's cells in a row
REPLY = "&"  # those of a reply: numbers with commas between
OPTIONAL = "_"  # a blank that may be absent, which has no index in its row
BESIDE = ""  # what is beside a row on its line
IRREGULAR_COST = 2.2  # of an inked cell beside a row, a missing blank, a row out of order
UNLIKE_COST = 8.0  # of complete unlikeness
NUMBER_COST = 0.3  # of a cell of a number, which may be any of its characters


class Alignment(NamedTuple):
    """The best row of each line.

    Parameters
    ----------
    gains : ndarray, shape (lines, rows)
        By how much a row explains a line better than nothing does.
    paths : ndarray, shape (lines, cells)
        For each line the state of its best path through the row of the largest gain.
    states : list of str
        What each state is: a character, `BLANK`, `NUMBER`, `REPLY` or `BESIDE`.
    rows : ndarray
        The row of each state.
    sources : ndarray
        The index in its row's text of each state, -1 beside it.
    """

    gains: Floats
    paths: NDArray[np.intp]
    states: list[str]
    rows: NDArray[np.intp]
    sources: NDArray[np.intp]


def costs_of(odds: Floats, unlike: Floats, numeric: str = NUMERIC) -> dict[str, Floats]:
    """Return what each character costs in each cell of a page.

    Parameters
    ----------
    odds : ndarray, shape (lines, cells)
        Log odds that a cell is inked.
    unlike : ndarray, shape (lines, cells, characters)
        How unlike it is to each of `CHARACTERS`, 0 to 1.
    numeric : str
        Characters of numbers.
    """
    is_blank = np.logaddexp(0, odds)
    is_inked = np.logaddexp(0, -odds)
    costs = {
        character: is_inked + UNLIKE_COST * np.minimum(unlike[:, :, k], 0.5)
        for k, character in enumerate(CHARACTERS)
    }
    costs[BLANK] = costs[OPTIONAL] = is_blank
    costs[BESIDE] = np.minimum(is_blank, IRREGULAR_COST)
    costs[NUMBER] = NUMBER_COST + np.min([costs[c] for c in numeric + "E+"], axis=0)
    costs[REPLY] = np.minimum(costs[NUMBER], np.minimum(NUMBER_COST + costs[","], is_blank))
    return costs


def align(costs: dict[str, Floats], rows: Sequence[str]) -> Alignment:
    """Return the best path of each line through each row.

    Parameters
    ----------
    costs : dict of str to ndarray, shape (lines, cells)
        What each state costs in each cell (`costs_of`).
    rows : sequence of str
        Texts; `NUMBER` and `REPLY` in them last any number of cells, runs of blanks, too.
    """
    states: list[str] = []
    row_of: list[int] = []
    source: list[int] = []
    for number, row in enumerate(rows):
        tokens = [*re.finditer(r"(?<=\S) +|\S", row)]
        starts = [
            -1 if match[0] == OPTIONAL else match.start() - row[: match.start()].count(OPTIONAL)
            for match in tokens
        ]
        states += [BESIDE, *(match[0][0] for match in tokens), BESIDE]
        row_of += [number] * (len(tokens) + 2)
        source += [-1, *starts, -1]
    rows_of_states = np.array(row_of)
    cost = np.stack([costs[state] for state in states])
    may_stay = np.array([state in (BESIDE, BLANK, OPTIONAL, NUMBER, REPLY) for state in states])
    is_first = np.r_[True, np.diff(rows_of_states) > 0]
    may_skip = np.r_[False, np.array([state in (BLANK, OPTIONAL, REPLY) for state in states[:-1]])]
    count, lines, cells = cost.shape
    stay = np.where(may_stay, 0.0, np.inf)[:, None]
    step = np.where(is_first, np.inf, 0.0)[:, None]
    skip = np.where(may_skip, np.array([*map(_skip_cost, ["", *states[:-1]])]), np.inf)[:, None]
    # a row may begin with the first cell, and end with the last
    total = np.where(is_first[:, None], 0.0, np.inf) + np.zeros((count, lines))
    total[np.flatnonzero(is_first) + 1] = 0.0
    total += cost[:, :, 0]
    moves = np.zeros((cells, count, lines), np.int8)
    for cell in range(1, cells):
        ways = np.stack(
            [total + stay, _shift_states(total, 1) + step, _shift_states(total, 2) + skip]
        )
        moves[cell] = ways.argmin(axis=0)
        total = ways.min(axis=0) + cost[:, :, cell]
    ends = np.r_[np.flatnonzero(is_first)[1:], count] - 1
    at_end = np.where(total[ends] <= total[ends - 1], ends[:, None], ends[:, None] - 1)
    least = np.minimum(total[ends], total[ends - 1])
    gains = (costs[BESIDE].sum(axis=1) - least).T
    best = gains.argmax(axis=1)
    paths = np.zeros((lines, cells), int)
    state = at_end[best, np.arange(lines)]
    for cell in range(cells - 1, -1, -1):
        paths[:, cell] = state
        state = state - moves[cell, state, np.arange(lines)]
    return Alignment(gains, paths, states, rows_of_states, np.array(source))


def _skip_cost(state: str) -> float:
    return IRREGULAR_COST if state == BLANK else 0.0


def _shift_states(total: Floats, by: int) -> Floats:
    return np.vstack([np.full((by, total.shape[1]), np.inf), total[:-by]])
