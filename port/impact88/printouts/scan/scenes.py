"""The scene of a printout, found from what was read in its cells.

Candidates are the numbers as read, the scenes that the recovery of text finds, and scenes that
differ from the best in a character or two. Each is run, and costs what its page costs against all
cells. This is the one module of the room that knows how text is recovered.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from itertools import product
from typing import NamedTuple, Protocol

from ...apple.applesoft.decimaltext import is_number
from ...collision.fields import ANGLES, INPUTS, REPLIES, scene_name
from ...errors import UserError
from ..reading.numerals import value_of
from ..reading.printout import read_printouts
from ..recovery.recovered import recover
from ..recovery.replays import Outcome, run_all
from ..recovery.typedtext import opposite
from .ink import Floats
from .layout import Sheet
from .typeface import READABLE

MAX_CELL_COST = 6.0
"""Largest cost of a cell, in units of `read_numbers`: a contradiction counts once."""
_SETTLED_COST = 1.0
"""Total cost of a page below which no further scenes are tried."""
_TURN = 360  # degrees
_MAX_ANGLE = 1_000_000
"""Size in degrees up to which turns are taken off: beyond, rounding moves the angle."""
_ROUNDS = 2  # times that scenes next to the best are tried
_BEAM = 3  # best scenes whose neighbours are tried
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
    """

    sheet: Sheet
    costs: dict[str, Floats]
    _known: dict[tuple[str, str], float] = field(default_factory=dict)

    def text(self, name: str) -> str:
        """Return the likeliest text of a number, with 0 for a digit that is missing in it."""
        if name not in self.costs:
            return ""
        text = "".join(READABLE[k] for k in self.costs[name].argmin(axis=1)).strip()
        return text if name.startswith("REPLY") else text.replace(" ", "0")

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
        rightward, leftward = (
            _text_cost(costs, side) for side in (text.rjust(len(costs)), text.ljust(len(costs)))
        )
        return spare if spare > 0 and rightward < leftward else 0

    def _cost(self, costs: Floats, text: str) -> float:
        """Return the cost of cells for a text, flush left or flush right."""
        total = MAX_CELL_COST * max(0, len(text) - len(costs))
        if len(text) == len(costs) + 1 and text.startswith("-"):
            # a faint sign before an angle is taken for a blank
            return MAX_CELL_COST + min(self._cost(costs, text[1:]), self._cost(costs, text[:-1]))
        # a character added before a number moves none of its others
        sides = {text.ljust(len(costs)), text.rjust(len(costs))}
        return total + min(_text_cost(costs, side) for side in sides)

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


_Known = dict[tuple[tuple[str, str], ...], Candidate]


def scene_of(
    read: Read, seeds: Sequence[dict[str, str]] = (), copy: Copy | None = None
) -> Candidate | None:
    """Return the scene whose page fits the cells best, None if none can be run.

    Parameters
    ----------
    read : Read
    seeds : sequence of dict
        Scenes that another reader found.
    copy : Copy, optional
        The program that printed the page, if not the restored listing. The scene is then what was
        typed into it.
    """
    copy_candidates: _Known = {}
    best: list[Candidate] = []
    if copy:
        inputs = {name: read.text(name) for name in INPUTS}
        for scene in _scenes_as_read(read):
            best = _rank_in_copy(read, copy, scene, inputs, copy_candidates)
            if best and best[0].cost < _SETTLED_COST:
                return best[0]
    candidates: _Known = {}
    best = _search(read, seeds, candidates)
    if not copy:
        return _within_a_turn(read, best[0], candidates) if best else None
    nearest = sorted(candidates.values(), key=lambda candidate: candidate.cost)[:_TRIED_IN_COPY]
    best = []
    for candidate in nearest:
        printed = candidate.outcome.fields
        inputs = {name: printed[name] for name in INPUTS if name in printed}
        best = _rank_in_copy(read, copy, candidate.scene, inputs, copy_candidates)
        if best and best[0].cost < _SETTLED_COST:
            break
    return best[0] if best else None


def _rank_in_copy(
    read: Read, copy: Copy, scene: dict[str, str], inputs: Mapping[str, str], known: _Known
) -> list[Candidate]:
    """Return the best scenes in a copy, after what may have been typed for one more was run.

    ``scene``: that scene; ``inputs``: its inputs as the page prints them; ``known``: the scenes
    that were run in the copy, to which the new ones are added.
    """
    try:
        scenes = [*copy.typed_scenes(scene, inputs, _typed_velocities(read))]
    except (UserError, ValueError, OverflowError):
        scenes = []
    return _rank(read, scenes, known, copy.outcomes)


def _search(read: Read, seeds: Sequence[dict[str, str]], known: _Known) -> list[Candidate]:
    """Return the scenes that fit the cells best by the restored listing.

    All scenes that are run are added to ``known``.
    """
    best: list[Candidate] = []
    # the text's recovery is asked only where the numbers as read leave doubts
    for use_recovery in (False, True):
        for scene in (
            scenes_in(read.page()[0]) if use_recovery else [*_scenes_as_read(read), *seeds]
        ):
            best = _rank(read, [scene], known)
        for _ in range(_ROUNDS):
            if not best or best[0].cost < _SETTLED_COST:
                break
            before = best[0].cost
            for candidate in best:
                best = _rank(read, [*_neighbours(read, candidate)], known)
            if best[0].cost > before - 0.5:
                break
        if best and best[0].cost < _SETTLED_COST:
            break
    return best


def _within_a_turn(read: Read, best: Candidate, known: _Known) -> Candidate:
    """Return the scene with each angle of a turn or more replaced by the equal angle within a turn
    that the cells are nearest to, if its page fits the cells as well.

    A page that has such an angle keeps it, since no other fits the cells of its digits.
    """
    for name in ANGLES:
        number = value_of(best.outcome.fields.get(name, ""))
        if number is None or not _TURN <= abs(number) < _MAX_ANGLE:
            continue
        remainder = number % _TURN
        texts = [_angle_text(remainder), _angle_text(remainder - _TURN)]
        _rank(read, [{**best.scene, name: text} for text in texts], known)
        equals = [
            candidate
            for candidate in known.values()
            if candidate.cost <= best.cost + _SETTLED_COST
            and candidate.scene in [{**best.scene, name: text} for text in texts]
        ]
        best = min(equals, key=lambda candidate: candidate.cost, default=best)
    return best


def _angle_text(angle: Decimal) -> str:
    """Return an angle as the program prints it: without a nought before the point."""
    text = f"{abs(angle):f}"
    return "-" * (angle < 0) + (text.lstrip("0") if "." in text and angle else text)


_Program = Callable[[Sequence[Mapping[str, str]]], list[Outcome]]
"""A program that is run for scenes; it returns the outcome of each."""


def _rank(
    read: Read, scenes: list[dict[str, str]], known: _Known, program: _Program = run_all
) -> list[Candidate]:
    """Return the best of the scenes in ``known``, after some more were run and added to it."""
    keys = {tuple(sorted(scene.items())): scene for scene in scenes}
    new = {key: scene for key, scene in keys.items() if key not in known}
    for (key, scene), outcome in zip(
        new.items(), _outcomes([*new.values()], program), strict=False
    ):
        fields = outcome.fields
        cost = 2 * MAX_CELL_COST * len(set(fields) - set(read.costs))
        for name in read.costs:
            if not name.startswith("REPLY"):
                cost += read.cost(name, fields.get(name))
        known[key] = Candidate(scene, outcome, cost)
    return sorted(known.values(), key=lambda candidate: candidate.cost)[:_BEAM]


def _outcomes(scenes: list[dict[str, str]], program: _Program = run_all) -> list[Outcome]:
    """Return what the program prints for scenes, [] if one of them cannot be run."""
    try:
        return program(scenes)
    except (UserError, ValueError, OverflowError):
        return []


def _scenes_as_read(read: Read) -> Iterator[dict[str, str]]:
    """Yield the scenes of the numbers as read, with either sign of MU."""
    texts = {name: read.text(name) for name in read.costs}
    if all(is_number(texts.get(name, "")) for name in INPUTS):
        direct = {scene_name(name): texts[name] for name in INPUTS}
        # what was typed may have more figures than are printed, or fewer: 5.749 prints 5.74900001
        for velocities, spins in product((_typed_velocities(read), {}), ("6", "4")):
            for mu in (texts["MUP"], opposite(texts["MUP"])):
                yield {**direct, **velocities, "M": spins, "MU": mu}


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
    for outcome in _outcomes([scene], program) if on_paper else ():
        if outcome.fields == {**candidate.outcome.fields, **on_paper}:
            return Candidate(scene, outcome, candidate.cost)
    return candidate


def _neighbours(read: Read, candidate: Candidate) -> Iterator[dict[str, str]]:
    """Yield scenes that differ in one character of one input, and those of the reply's numbers."""
    for name in [name for name in INPUTS if name in read.costs]:
        symbol, as_read = scene_name(name), read.text(name)
        text = candidate.outcome.fields.get(name) or as_read
        is_turned = symbol == "MU" and candidate.scene["MU"].startswith("-") != text.startswith("-")
        # its last figure may have been altered to a nought, or erased
        texts = [as_read or "0"]
        for base in dict.fromkeys((text, as_read, as_read.ljust(len(read.costs[name]), "0"))):
            for at, character in enumerate(base):
                for digit in "0123456789" if character.isdigit() else "":
                    texts.append(base[:at] + digit + base[at + 1 :])
        if name in ANGLES:  # whose last figure, erased, leaves a wider gap
            texts += [as_read + last for last in "0123456789"]
        for variant in texts:
            yield {**candidate.scene, symbol: opposite(variant) if is_turned else variant}
        yield {**candidate.scene, symbol: opposite(text)}
    yield {**candidate.scene, "M": "4" if candidate.scene["M"] == "6" else "6"}
    yield {**candidate.scene, **_typed_velocities(read)}


def _typed_velocities(read: Read) -> dict[str, str]:
    """Return the velocities as typed, from replies that were read as three numbers."""
    velocities: dict[str, str] = {}
    for side, names in REPLIES.items():
        name = f"REPLY_{side}"
        texts = read.text(name).replace(" ", "").split(",") if name in read.costs else []
        if len(texts) == 3 and all(map(is_number, texts)):
            velocities |= zip(names, texts, strict=True)
    return velocities
