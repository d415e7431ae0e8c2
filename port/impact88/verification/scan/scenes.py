"""From what was read in the cells to the scene: candidates of the text's recovery, and scenes that
differ in a character or two, weighed by how well the program's page fits all cells.

This is the one module that knows how text is recovered.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import NamedTuple, Protocol

from ...applesoft.decimaltext import is_number
from ...collision.fields import ANGLES, INPUTS, REPLIES, scene_name
from ...errors import UserError
from ..reading.printout import read_printouts
from ..recovery.recovered import recover
from ..recovery.replays import Outcome, run_all
from ..recovery.typedtext import opposite
from .ink import Floats
from .layout import Sheet
from .typeface import READABLE

WORST = 6.0
"""What a cell costs at most: a cell that contradicts says no more than that it does."""
_SETTLED = 1.0
"""A page whose cells cost less than this in all needs no search."""
_ROUNDS, _KEPT = 2, 3
"""Times that scenes next to the best are tried, and how many are the best."""
_TRIED_IN_COPY = 12
"""Scenes nearest by the restored listing that are run in an office's copy, 13 ms a run."""


@dataclass
class Read:
    """Numbers of a printout as cells: by name the cost of each of `READABLE` in each cell, shape
    (cells, characters), 0 for the likeliest."""

    sheet: Sheet
    costs: dict[str, Floats]
    _known: dict[tuple[str, str], float] = field(default_factory=dict)

    def text(self, name: str) -> str:
        """The likeliest text of a number; a blank within it is a digit that is missing."""
        if name not in self.costs:
            return ""
        text = "".join(READABLE[k] for k in self.costs[name].argmin(axis=1)).strip()
        return text if name.startswith("REPLY") else text.replace(" ", "0")

    def cost(self, name: str, text: str | None) -> float:
        """What it costs to take a number's cells for a text."""
        if text is None:
            return 2 * WORST
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
        right, left = (
            _summed(costs, side) for side in (text.rjust(len(costs)), text.ljust(len(costs)))
        )
        return spare if spare > 0 and right < left else 0

    def _cost(self, costs: Floats, text: str) -> float:
        total = WORST * max(0, len(text) - len(costs))
        if len(text) == len(costs) + 1 and text.startswith("-"):
            # a faint sign before an angle is taken for a blank
            return WORST + min(self._cost(costs, text[1:]), self._cost(costs, text[:-1]))
        # a character added before a number moves none of its others
        sides = {text.ljust(len(costs)), text.rjust(len(costs))}
        return total + min(_summed(costs, side) for side in sides)

    def page(self, known: Mapping[str, str] | None = None) -> tuple[str, dict[str, int]]:
        """The printout as text, as far as its lines were found, and where its numbers begin.
        ``known``: numbers of which more is known than was read."""
        page, starts = "", {}
        for _, row in sorted(self.sheet.rows.items()):
            page += "\n" * bool(page)
            for name, text, _ in row.pieces:
                if name:
                    starts[name] = len(page)
                page += (known or {}).get(name) or self.text(name) if name else text
        return page, starts


def _summed(costs: Floats, text: str) -> float:
    total = 0.0
    for row, character in zip(costs, text, strict=False):
        column = READABLE.find(character)
        total += WORST if column < 0 else min(float(row[column]), WORST)
    return total


class Candidate(NamedTuple):
    """A scene, what the program prints for it, and what that costs against the cells."""

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
    """The scene whose page fits the cells best, None where none can be run. ``seeds``: scenes that
    another reader found; ``copy``: what prints the page, in place of the restored listing; its
    scene is what was typed."""
    by_copy: _Known = {}
    best: list[Candidate] = []
    if copy:
        inputs = {name: read.text(name) for name in INPUTS}
        for scene in _direct(read):
            best = _weighed_in_copy(read, copy, scene, inputs, by_copy)
            if best and best[0].cost < _SETTLED:
                return best[0]
    known: _Known = {}
    best = _searched(read, seeds, known)
    if not copy:
        return best[0] if best else None
    nearest = sorted(known.values(), key=lambda candidate: candidate.cost)[:_TRIED_IN_COPY]
    best = []
    for candidate in nearest:
        printed = candidate.outcome.fields
        inputs = {name: printed[name] for name in INPUTS if name in printed}
        best = _weighed_in_copy(read, copy, candidate.scene, inputs, by_copy)
        if best and best[0].cost < _SETTLED:
            break
    return best[0] if best else None


def _weighed_in_copy(
    read: Read, copy: Copy, scene: dict[str, str], inputs: Mapping[str, str], known: _Known
) -> list[Candidate]:
    """The best of all scenes known of a copy, with what may have been typed where a page shows the
    inputs of one more."""
    try:
        typed = [*copy.typed_scenes(scene, inputs, _typed(read))]
    except (UserError, ValueError, OverflowError):
        typed = []
    return _weighed(read, typed, known, copy.outcomes)


def _searched(read: Read, seeds: Sequence[dict[str, str]], known: _Known) -> list[Candidate]:
    """The scenes that fit the cells best by the restored listing; all that were tried become
    known."""
    best: list[Candidate] = []
    # the text's recovery is asked only where the numbers as read leave doubts
    for recovered in (False, True):
        for scene in scenes_in(read.page()[0]) if recovered else [*_direct(read), *seeds]:
            best = _weighed(read, [scene], known)
        for _ in range(_ROUNDS):
            if not best or best[0].cost < _SETTLED:
                break
            before = best[0].cost
            for candidate in best:
                best = _weighed(read, [*_neighbours(read, candidate)], known)
            if best[0].cost > before - 0.5:
                break
        if best and best[0].cost < _SETTLED:
            break
    return best


_Program = Callable[[Sequence[Mapping[str, str]]], list[Outcome]]
"""What prints pages: the outcome of each scene."""


def _weighed(
    read: Read, scenes: list[dict[str, str]], known: _Known, program: _Program = run_all
) -> list[Candidate]:
    """The best of all scenes that are known, with some more."""
    keys = {tuple(sorted(scene.items())): scene for scene in scenes}
    new = {key: scene for key, scene in keys.items() if key not in known}
    for (key, scene), outcome in zip(
        new.items(), _outcomes([*new.values()], program), strict=False
    ):
        fields = outcome.fields
        cost = 2 * WORST * len(set(fields) - set(read.costs))
        for name in read.costs:
            if not name.startswith("REPLY"):
                cost += read.cost(name, fields.get(name))
        known[key] = Candidate(scene, outcome, cost)
    return sorted(known.values(), key=lambda candidate: candidate.cost)[:_KEPT]


def _outcomes(scenes: list[dict[str, str]], program: _Program = run_all) -> list[Outcome]:
    """What the program prints for scenes, nothing where one of them cannot be run."""
    try:
        return program(scenes)
    except (UserError, ValueError, OverflowError):
        return []


def _direct(read: Read) -> Iterator[dict[str, str]]:
    """The scene of the numbers as read, of either sign of MU."""
    texts = {name: read.text(name) for name in read.costs}
    if all(is_number(texts.get(name, "")) for name in INPUTS):
        direct = {scene_name(name): texts[name] for name in INPUTS}
        # what was typed may have more figures than are printed, or fewer: 5.749 prints 5.74900001
        for typed, spins in product((_typed(read), {}), ("6", "4")):
            for mu in (texts["MUP"], opposite(texts["MUP"])):
                yield {**direct, **typed, "M": spins, "MU": mu}


def scenes_in(text: str) -> list[dict[str, str]]:
    """The scenes of the printouts in a text, as far as they are recovered."""
    try:
        recovered = [
            recover(printout) for printout in read_printouts(text) if not printout.fragment
        ]
    except UserError:
        return []
    return [found.scene for found in recovered if not found.missing]


def borne_out(
    candidate: Candidate, shown: Mapping[str, str], copy: Copy | None = None
) -> Candidate:
    """The scene with some inputs as the paper shows them, where the program's page is otherwise the
    same: results bear out neither an angle nor an arm that they do not depend on."""
    scene = candidate.scene | {scene_name(name): text for name, text in shown.items()}
    program = copy.outcomes if copy else run_all
    for outcome in _outcomes([scene], program) if shown else ():
        if outcome.fields == {**candidate.outcome.fields, **shown}:
            return Candidate(scene, outcome, candidate.cost)
    return candidate


def _neighbours(read: Read, candidate: Candidate) -> Iterator[dict[str, str]]:
    """Scenes that differ in one character of one input, and those of the reply's numbers."""
    for name in [name for name in INPUTS if name in read.costs]:
        typed, seen = scene_name(name), read.text(name)
        text = candidate.outcome.fields.get(name) or seen
        turned = typed == "MU" and candidate.scene["MU"].startswith("-") != text.startswith("-")
        # its last figure may have been altered to a nought, or erased
        texts = [seen or "0"]
        for shown in dict.fromkeys((text, seen, seen.ljust(len(read.costs[name]), "0"))):
            for at, character in enumerate(shown):
                for other in "0123456789" if character.isdigit() else "":
                    texts.append(shown[:at] + other + shown[at + 1 :])
        if name in ANGLES:  # whose last figure, erased, leaves a wider gap
            texts += [seen + last for last in "0123456789"]
        for changed in texts:
            yield {**candidate.scene, typed: opposite(changed) if turned else changed}
        yield {**candidate.scene, typed: opposite(text)}
    yield {**candidate.scene, "M": "4" if candidate.scene["M"] == "6" else "6"}
    yield {**candidate.scene, **_typed(read)}


def _typed(read: Read) -> dict[str, str]:
    """The velocities as they were typed, of replies that were read as three numbers."""
    velocities: dict[str, str] = {}
    for side, names in REPLIES.items():
        name = f"REPLY_{side}"
        texts = read.text(name).replace(" ", "").split(",") if name in read.costs else []
        if len(texts) == 3 and all(map(is_number, texts)):
            velocities |= zip(names, texts, strict=True)
    return velocities
