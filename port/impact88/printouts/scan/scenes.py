"""The scene of a printout, found from what was read in its cells.

Every cell gives a cost to each character, so that the numbers which the cells may be have costs, as
those read from a text do; and the scene is searched for as a text's is. This is the one module of
the room that knows how scenes are recovered.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

from ...apple.applesoft.decimaltext import is_number
from ...errors import UserError
from ..fields import ANGLES, FIELDS, INPUTS, REPLIES, scene_name
from ..reading.numerals import as_printed, printable, value_of
from ..reading.printout import read_printouts
from ..recovery.recovered import MAX_RESULT_TEXTS, MAX_TEXTS, recover
from ..recovery.replays import Outcome, run_all
from ..recovery.search import MISMATCH, Column, Evidence, Expected, Search, column_of
from ..recovery.slips import neighbours
from ..recovery.typedtext import stored_and_printed
from .ink import Floats
from .layout import Sheet
from .typeface import BLANK, READABLE

MAX_CELL_COST = 6.0
"""Largest cost of a cell, in units of `read_numbers`: a contradiction counts once."""
_CELL_UNIT = 0.45
"""Cost of a cell's unit in a search: a contradicted cell is a little cheaper than a result that the
program does not print (`MISMATCH`)."""
_SETTLED_COST = 1.0
"""Total cost of a page below which no further scenes are tried in an office's copy."""
_MORE_THAN_A_TURN = 0.3
"""Cost of an angle of a turn or more: of equal angles that the cells are as near to, the one within
a turn is taken."""
_TRIED_IN_COPY = 12
"""Scenes nearest by the restored listing that are run in an office's copy, 13 ms a run."""


@dataclass
class Read:
    """Numbers of a printout as read in its cells.

    Attributes
    ----------
    sheet : Sheet
        The printout on the grid.
    costs : dict of str to ndarray, shape (cells, characters)
        By name of the number the cost of each of `READABLE` in each cell, 0 for the likeliest.
    absent : set of str
        Numbers of rows that are on the paper but cannot be read: that they are missing costs
        nothing.
    """

    sheet: Sheet
    costs: dict[str, Floats]
    absent: set[str] = field(default_factory=set)
    _known: dict[tuple[str, str], float] = field(default_factory=dict)

    def text(self, name: str) -> str:
        """Return the likeliest text of a number, with 0 for a digit that is missing in it."""
        if name not in self.costs:
            return ""
        text = "".join(READABLE[k] for k in self.costs[name].argmin(axis=1)).strip()
        return text if name.startswith("REPLY") else text.replace(" ", "0")

    def texts(self, name: str, most: int) -> dict[str, float]:
        """Return the texts that a number may be printed as, with their costs in a search, the
        likeliest first; with 0 for a digit that is missing in it."""
        ways = {"": 0.0}
        for row in self.costs[name]:
            options = [(READABLE[k], float(row[k])) for k in (row < MAX_CELL_COST).nonzero()[0]]
            longer = [
                (text + char, cost + more) for text, cost in ways.items() for char, more in options
            ]
            ways = dict(sorted(longer, key=lambda way: way[1])[: 4 * most])
        costs: dict[str, float] = {}
        for text, cost in ways.items():
            text = text.strip().replace(" ", "0")
            if printable(text):
                costs.setdefault(text, _CELL_UNIT * cost)
        return dict([*costs.items()][:most])

    def cost(self, name: str, text: str | None) -> float:
        """Return the cost of taking a number's cells for a text, None for a number not printed."""
        if text is None:
            return 2 * MAX_CELL_COST
        if (name, text) not in self._known:
            self._known[name, text] = self._cost(self.costs[name], text)
        return self._known[name, text]

    def shift(self, name: str, text: str) -> int:
        """Return by how many cells a number's text begins after the first of its cells: a faint
        sign may have been taken for a blank before them, a speck for the first of them."""
        costs = self.costs[name]
        spare = len(costs) - len(text)
        if spare == -1 and self.cost(name, text[1:]) < self.cost(name, text[:-1]):
            return -1
        places = _placements(costs, text)
        return min(range(len(places)), key=places.__getitem__)

    def _cost(self, costs: Floats, text: str) -> float:
        """Return the cost of cells for a text, wherever it begins in them."""
        total = MAX_CELL_COST * max(0, len(text) - len(costs))
        if len(text) == len(costs) + 1 and text.startswith("-"):
            # a faint sign before an angle is taken for a blank
            return MAX_CELL_COST + min(self._cost(costs, text[1:]), self._cost(costs, text[:-1]))
        # a character added before a number moves none of its others
        return total + min(_placements(costs, text))

    def page(self, known: Mapping[str, str] | None = None) -> tuple[str, dict[str, int]]:
        """Return the printout as text, and where in it each number begins.

        ``known``: texts of numbers that are known otherwise than from the cells.
        """
        page, starts = "", {}
        for _, row in sorted(self.sheet.rows.items()):
            page += "\n" * bool(page)
            for name, text, _ in row.pieces:
                if name:
                    starts[name] = len(page)
                page += (known or {}).get(name) or self.text(name) if name else text
        return page, starts


def _placements(costs: Floats, text: str) -> list[float]:
    """Return the cost of cells for a text that begins in the first of them, the second ..., with
    blanks around: specks may be taken for characters on either side."""
    return [
        _text_cost(costs, (BLANK * start + text).ljust(len(costs)))
        for start in range(max(len(costs) - len(text), 0) + 1)
    ]


def _text_cost(costs: Floats, text: str) -> float:
    """Return the cost of cells for a text, character by character from the first cell."""
    total = 0.0
    for row, character in zip(costs, text, strict=False):
        column = READABLE.find(character)
        total += MAX_CELL_COST if column < 0 else min(float(row[column]), MAX_CELL_COST)
    return total


class Candidate(NamedTuple):
    """A scene, what the program prints for it, and the cost of that against the cells."""

    scene: dict[str, str]
    outcome: Outcome
    cost: float


class Copy(Protocol):
    """An office's copy of the listing, as `judging.copies.CopyPages` has it."""

    def outcomes(self, scenes: Sequence[Mapping[str, str]], /) -> list[Outcome]:
        """Return what it prints for each scene."""

    def typed_scenes(
        self,
        scene: Mapping[str, str],
        printed: Mapping[str, str],
        replies: Mapping[str, str],
        /,
    ) -> Iterator[dict[str, str]]:
        """Yield what may have been typed for it where a page shows a scene."""

    def prints(self, line: str, scene: Mapping[str, str], /) -> bool:
        """Return whether it prints a line for a scene that the restored listing does not."""


def scene_of(
    read: Read, seeds: Sequence[dict[str, str]] = (), copy: Copy | None = None
) -> Candidate | None:
    """Return the scene whose page fits the cells best, None if an input was not read.

    Parameters
    ----------
    read : Read
    seeds : sequence of dict
        Scenes that another reader found.
    copy : Copy, optional
        The program that printed the page, if not the restored listing. The scene is then what was
        typed into it.
    """
    columns = [*_columns(read, seeds)]
    if not all(column.options for column in columns):
        return None
    search = Search(_evidence(read))
    if not copy:
        best = search.best(columns)
        return _candidate(read, best.scene, best.outcome)
    likeliest, _ = search.cheapest(columns, 2)
    scores = search.replay(columns, likeliest) + [score for _, score in search.nearest(columns)]
    return _scene_in_copy(read, copy, [scored.scene for scored in scores])


def unread_inputs(read: Read) -> list[str]:
    """Return the inputs of which nothing that was read is a number: each is needed for a scene."""
    return [column.names[0] for column in _columns(read, []) if not column.options]


def _scene_in_copy(read: Read, copy: Copy, scenes: Sequence[dict[str, str]]) -> Candidate | None:
    """Return what was typed into a copy of the listing, from the scenes of the numbers as read and
    those that are the nearest by the restored one."""
    inputs = {name: read.text(name) for name in INPUTS}
    replies = _typed_velocities(read)
    best: Candidate | None = None
    for scene in scenes[:_TRIED_IN_COPY]:
        try:
            typed = [*copy.typed_scenes(scene, inputs, replies)]
            pairs = zip(typed, copy.outcomes(typed), strict=True)
            found = [_candidate(read, *pair) for pair in pairs]
        except (UserError, ValueError, OverflowError):
            continue
        best = min([*([best] if best else []), *found], key=lambda candidate: candidate.cost)
        if best.cost < _SETTLED_COST:
            break
    return best


def _columns(read: Read, seeds: Sequence[Mapping[str, str]]) -> Iterator[Column]:
    """Yield the texts of each input: what its cells may be, texts one slip away from the likeliest,
    and those of scenes that another reader found."""
    typed = _typed_velocities(read)
    for name in INPUTS:
        texts: dict[str, float] = {}
        if name in read.costs:
            texts = read.texts(name, MAX_TEXTS)
            others = dict.fromkeys((seed[scene_name(name)] for seed in seeds), MISMATCH)
            for text, cost in {**others, **_slips(read, name)}.items():
                printed = (stored_and_printed(text, name in ANGLES) or ("", ""))[1]
                if printed and printed not in texts:
                    texts[printed] = min(cost, _CELL_UNIT * read.cost(name, printed))
        elif name in typed and (seen := stored_and_printed(typed[name])):
            texts = {seen[1]: 0.0}
        if name in ANGLES:
            for text in texts:
                number = value_of(text)
                texts[text] += _MORE_THAN_A_TURN * (number is None or abs(number) >= 360)
        yield column_of(name, sorted(texts.items(), key=lambda option: option[1]))
    # a footer may be taken for the line of final spins: then both contradict, and M is 4
    yield column_of("M", [("4", 0.0), ("6", 0.1)], True)


def _slips(read: Read, name: str) -> dict[str, float]:
    """Return the texts one slip away from a number as read, with their prior penalties. Its last
    figure may have been erased, which leaves a wider gap."""
    as_read = read.text(name)
    text = as_printed(as_read) or as_read
    slips: dict[str, float] = {}
    for base in (as_read.ljust(len(read.costs[name]), "0"), text):
        slips |= neighbours(name, base) if is_number(base) else {}
    return slips


def _evidence(read: Read) -> Evidence:
    """Return the numbers in the cells as evidence."""
    results = [
        Expected(name, read.texts(name, MAX_RESULT_TEXTS), MISMATCH)
        for name in FIELDS
        if name in read.costs and name not in INPUTS
    ]
    typed: dict[str, dict[str, str]] = {}
    for name, text in _typed_velocities(read).items():
        if seen := stored_and_printed(text):
            typed[name] = {seen[1]: text}
    return Evidence(results, {*INPUTS} & {*read.costs}, typed)


def _candidate(read: Read, scene: dict[str, str], outcome: Outcome) -> Candidate:
    """Return a scene with the cost of its page against all cells."""
    fields = outcome.fields
    cost = 2 * MAX_CELL_COST * len(set(fields) - set(read.costs) - read.absent)
    for name in read.costs:
        if not name.startswith("REPLY"):
            cost += read.cost(name, fields.get(name))
    return Candidate(scene, outcome, cost)


def scenes_in(text: str) -> list[dict[str, str]]:
    """Return the scenes of the printouts in a text that can be recovered."""
    try:
        recoveries = [
            recover(printout) for printout in read_printouts(text) if not printout.fragment
        ]
    except UserError:
        return []
    return [recovery.scene for recovery in recoveries if not recovery.missing]


def confirm_inputs(
    candidate: Candidate, on_paper: Mapping[str, str], copy: Copy | None = None
) -> Candidate:
    """Return the scene with some inputs as the paper shows them, if its page is otherwise the same.

    No printed result depends on such an input (some angle or arm), so that the paper alone tells
    it. The candidate is returned unchanged if any result would differ.
    """
    scene = candidate.scene | {scene_name(name): text for name, text in on_paper.items()}
    program = copy.outcomes if copy else run_all
    try:
        outcomes = program([scene]) if on_paper else []
    except (UserError, ValueError, OverflowError):
        outcomes = []
    for outcome in outcomes:
        if outcome.fields == {**candidate.outcome.fields, **on_paper}:
            return Candidate(scene, outcome, candidate.cost)
    return candidate


def _typed_velocities(read: Read) -> dict[str, str]:
    """Return the velocities as typed, from replies that were read as three numbers."""
    velocities: dict[str, str] = {}
    for side, names in REPLIES.items():
        name = f"REPLY_{side}"
        texts = read.text(name).replace(" ", "").split(",") if name in read.costs else []
        if len(texts) == 3 and all(map(is_number, texts)):
            velocities |= zip(names, texts, strict=True)
    return velocities
