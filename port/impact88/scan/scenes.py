"""From what was read in the cells to the scene: candidates of the text's recovery, and scenes that
differ in a character or two, weighed by how well the program's page fits all cells.

This is the one module that knows how text is recovered.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import NamedTuple

from ..applesoft.decimaltext import is_number
from ..errors import UserError
from ..fields import ANGLES, INPUTS, REPLIES, scene_name
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


def scene_of(read: Read, seeds: Sequence[dict[str, str]] = ()) -> Candidate | None:
    """The scene whose page fits the cells best, None where none can be run. ``seeds``: scenes that
    another reader found."""
    known: dict[tuple[tuple[str, str], ...], Candidate] = {}
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
    return best[0] if best else None


def _weighed(
    read: Read, scenes: list[dict[str, str]], known: dict[tuple[tuple[str, str], ...], Candidate]
) -> list[Candidate]:
    """The best of all scenes that are known, with some more."""
    keys = {tuple(sorted(scene.items())): scene for scene in scenes}
    new = {key: scene for key, scene in keys.items() if key not in known}
    for (key, scene), outcome in zip(new.items(), _outcomes([*new.values()]), strict=False):
        fields = outcome.fields
        cost = 2 * WORST * len(set(fields) - set(read.costs))
        for name in read.costs:
            if not name.startswith("REPLY"):
                cost += read.cost(name, fields.get(name))
        known[key] = Candidate(scene, outcome, cost)
    return sorted(known.values(), key=lambda candidate: candidate.cost)[:_KEPT]


def _outcomes(scenes: list[dict[str, str]]) -> list[Outcome]:
    """What the program prints for scenes, nothing where one of them cannot be run."""
    try:
        return run_all(scenes)
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


def borne_out(candidate: Candidate, shown: Mapping[str, str]) -> Candidate:
    """The scene with some inputs as the paper shows them, where the program's page is otherwise the
    same: results bear out neither an angle nor an arm that they do not depend on."""
    scene = candidate.scene | {scene_name(name): text for name, text in shown.items()}
    for outcome in _outcomes([scene]) if shown else ():
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
