"""The scene that a page comes from: what its inputs may be, replayed bit for bit.

A scene costs what its inputs do, plus what it costs that each result it prints is the one that was
read: the more, the further off it is. From the scene as read, one input at a time is changed as
long as the cost falls: to another reading or spelling first, then, while results differ, to a slip
in an input read with doubt. An input that was read cleanly is replaced only if another value of it
alone explains every result that differs.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import compress
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..program.replay import FINAL_SPINS
from .costs import ALIKE, CONTRADICTED, SLIGHT, UNPAIRED, WRONG
from .numerals import MAX_DIGITS, opposite, readings, slips, stored_and_printed
from .page import ANGLES, INPUTS, NAMES, PARTNERS, RESULTS
from .programs import Listing, Outcomes
from .reader import Reading

STEPS = sorted(range(-18, 19), key=abs)
"""Units of a place by which a value is varied: those of ten degrees reach round the circle."""
MIN_RESULTS = 2
"""Results that differ from which an input may explain them: one is rather altered itself."""
TENS = 1
"""Place of ten degrees, from which angles are varied: the results turn with them."""
TINY = 1e-38
"""Less than any number that the Apple prints."""
TEXT = "S16"
CIRCLE = Decimal(360)

Texts = dict[str, str]


class Option(NamedTuple):
    """Possible text of an input (or M): its name, its printed and typed text, and their cost."""

    name: str
    printed: str
    typed: str
    cost: float


@dataclass(frozen=True)
class Recovered:
    """A scene that was replayed.

    Parameters
    ----------
    inputs : dict of str to Option
        What its inputs are believed to be.
    mismatch : float
        The cost of its results.
    fields : dict of str to str
        The numbers that the program prints.
    ending : str
        The message that ends the program, "" for a normal end.
    changed : str
        The input that was changed last.
    """

    inputs: dict[str, Option]
    mismatch: float
    fields: Texts
    ending: str
    changed: str

    @property
    def cost(self) -> float:
        """Cost of inputs and results."""
        return self.mismatch + sum(option.cost for option in self.inputs.values())

    @property
    def scene(self) -> Texts:
        """The scene as typed."""
        return {scene_name(name): option.typed for name, option in self.inputs.items()}


def scene_name(name: str) -> str:
    """Return the scene's name of an input on the page."""
    return "MU" if name == "MUP" else name


def find_scenes(
    reading: Reading, given: Mapping[str, str], program: Listing
) -> tuple[list[Recovered], list[str]]:
    """Return the scene that explains a page at the least cost, and those that do as well.

    Parameters
    ----------
    reading : Reading
        The page.
    given : mapping of str to str
        Inputs known from elsewhere, as typed, for those that the page lacks.
    program : Listing
        The program that may have printed the page.

    Returns
    -------
    tuple
        The scenes, none where inputs are missing; and the names of these.
    """
    columns = {name: _options(reading, name, given, program) for name in INPUTS}
    if missing := [name for name, options in columns.items() if not options]:
        return [], missing
    slots = reading.slots
    # M = 4 prints no final spins
    has_spins = all(name in slots and slots[name].label == "exact" for name in FINAL_SPINS)
    ms = [given["M"]] if "M" in given else ["6"] if has_spins else ["4", "6"]
    columns["M"] = [Option("M", m, m, ALIKE * k) for k, m in enumerate(ms)]
    search = _Search(reading, given, program)
    options = [option for options in columns.values() for option in options]
    first = {name: options[0] for name, options in columns.items()}
    best = search.improve(search.replay(first, [first["M"]])[0], options)
    repaired = search.improve(best, options + search.slips(best))
    # slips are believed only where they explain most of what differs
    if 2 * repaired.mismatch <= best.mismatch:
        best = repaired
    return search.replace(best) or [best], []


def _options(
    reading: Reading, name: str, given: Mapping[str, str], program: Listing
) -> list[Option]:
    """Return what an input may be, the cheapest first: as printed, and as typed at the prompt."""
    texts = dict(reading.readings(name))
    reply = reading.replies.get(name, "") or ("" if texts else given.get(scene_name(name), ""))
    entry = stored_and_printed(reply, name in ANGLES)
    for text in [entry[1]] if entry else readings(reply):
        texts[text] = min(texts.get(text, ALIKE), ALIKE)
    options: list[Option] = []
    for text, cost in sorted(texts.items(), key=lambda item: item[1]):
        entries = [reply] if entry and entry[1] == text else program.spellings(name, text)
        if name == "MUP" and entries:  # -10 printed of a typed 10 is no pivot
            entries = [*entries, opposite(entries[0])]
        options += [Option(name, text, typed, cost + SLIGHT * k) for k, typed in enumerate(entries)]
    return options


class _Search:
    """Replay of changes in the scene of a page.

    Parameters
    ----------
    reading : Reading
        The page.
    given : mapping of str to str
        Inputs known from elsewhere.
    program : Listing
        The program.
    """

    def __init__(self, reading: Reading, given: Mapping[str, str], program: Listing) -> None:
        self.program = program
        self.reading = reading
        slots = reading.slots
        names = RESULTS if type(program) is Listing else [n for n in NAMES if n != "MUP"]
        self.expected = {name: reading.readings(name) for name in names}
        self.sure = [name for name in names if name in slots and slots[name].is_clean]
        self.read = [n for n in INPUTS if n in slots or scene_name(n) not in given]
        self.clean = [name for name in self.read if name in slots and slots[name].is_clean]

    def slips(self, scene: Recovered) -> list[Option]:
        """Return the slips that a page may have: in an input read cleanly only where a machine
        read it."""
        options = []
        for name in self.read:
            is_clean = name in self.clean
            if self.reading.is_machine_read or not is_clean:
                options += self._edits(scene.inputs[name], CONTRADICTED * is_clean)
        return options

    def _edits(self, option: Option, doubt: float = 0.0) -> list[Option]:
        """Return the slips in an input as believed and as read, of angles those in the circle."""
        slot = self.reading.slots.get(option.name)
        limit = max(CIRCLE, abs(Decimal(option.printed))) if option.name in ANGLES else math.inf
        return [
            Option(option.name, text, text, WRONG + doubt)
            for read in dict.fromkeys((option.printed, slot.text if slot else ""))
            for text in slips(read)
            if abs(Decimal(text)) <= limit
        ]

    def improve(self, scene: Recovered, options: list[Option]) -> Recovered:
        """Return a scene after the changes of one input that make it cheapest, one by one."""
        while scene.mismatch >= CONTRADICTED and options:
            best = self.replay(scene.inputs, options)[0]
            if best.cost >= scene.cost:
                break
            scene = best
        return scene

    def replace(self, scene: Recovered) -> list[Recovered]:
        """Return the scenes in which another value of one clean input explains all results.

        A single result that differs is not explained so. A slip in what was read explains first,
        then a value that is not longer, then one from which what was read may have been cut.
        """
        if self._count_differing(scene) < MIN_RESULTS:
            return []
        read = {name: scene.inputs[name] for name in self.clean}
        edits = [edit for option in read.values() for edit in self._edits(option)]
        if scenes := self._explain(scene, edits):
            return scenes
        scaled = [
            _option(name, Decimal(option.printed).scaleb(k))
            for name, option in read.items()
            for k in range(self._lost_digits(name)[1] + 1)
        ]
        options = self._vary(scene, read, is_cut=False)
        options += self._vary(scene, self._find_least(scene, scaled), is_cut=True)
        is_typable = [
            len(option.printed) <= len(read[option.name].printed)
            or self.reading.is_cut(option.name, option.printed)
            for option in options
        ]
        return self._explain(scene, [*compress(options, is_typable)])

    def _lost_digits(self, name: str) -> list[int]:
        """Return how many digits a number may have lost before and after what was read."""
        return [MAX_DIGITS * (extra > 0) for extra in self.reading.extra_blanks.get(name, (0, 0))]

    def _vary(
        self, scene: Recovered, values: Mapping[str, Option], *, is_cut: bool
    ) -> list[Option]:
        """Return the values of some inputs by which the results cost least.

        Each place that was read is found in turn, from that of the first digit to that after the
        last; of a number that may have been cut, each place beyond.
        """
        places = {}
        for name, option in values.items():
            value = Decimal(option.printed)
            value = value.normalize() if is_cut else value
            first, last = value.adjusted(), int(value.as_tuple().exponent)
            front, end = self._lost_digits(name)
            beyond = {*range(first + 1, first + front + 1), *range(last - end, last)}
            places[name] = beyond if is_cut else {*range(last - 1, first + 1)}
        for place in range(MAX_DIGITS, -2 * MAX_DIGITS, -1):
            unit = Decimal(1).scaleb(place)
            changes = [
                _option(name, Decimal(option.printed) + step * unit)
                for name, option in values.items()
                if place in places[name] and (place <= TENS or name not in ANGLES)
                for step in STEPS
            ]
            values = {**values, **self._find_least(scene, changes)}
        return [*values.values()]

    def _find_least(self, scene: Recovered, changes: list[Option]) -> dict[str, Option]:
        """Return the change of each input by which the results cost least, the first of equals."""
        if not changes:
            return {}
        # the least last, which the dictionary keeps of each name
        order = np.argsort(self._run(scene.inputs, changes)[2], kind="stable")[::-1].tolist()
        return {changes[k].name: changes[k] for k in order}

    def _explain(self, scene: Recovered, options: list[Option]) -> list[Recovered]:
        """Return the scenes with one of some changes that explain all results, by input.

        Of two angles that enter only as a sum, either explains as much.
        """
        read = {name: Decimal(scene.inputs[name].printed) for name in self.clean}
        partners = [
            _option(partner, read[partner] + Decimal(option.printed) - read[option.name])
            for option in options
            if (partner := PARTNERS.get(option.name, "")) in read
        ]
        by_input: dict[str, Recovered] = {}
        for other in self.replay(scene.inputs, options + partners, len(NAMES)):
            least = next(iter(by_input.values()), other)
            if not self._count_differing(other) and other.cost <= least.cost + 2 * SLIGHT:
                by_input.setdefault(other.changed, other)
        return [*by_input.values()]

    def _count_differing(self, scene: Recovered) -> int:
        """Return the number of results read cleanly that a scene does not explain."""
        mup = scene.inputs["MUP"].printed
        count = sum(
            (text := scene.fields.get(name, "")) not in self.expected[name]
            and not self.reading.is_cut(name, text)
            for name in self.sure
        )
        return count + (scene.fields.get("MUP", mup) != mup)

    def replay(
        self, inputs: Mapping[str, Option], changes: list[Option], count: int = 1
    ) -> list[Recovered]:
        """Return the scenes that inputs have with each of some changes, the cheapest first."""
        scenes, run, mismatch = self._run(inputs, changes)
        costs = mismatch + [change.cost - inputs[change.name].cost for change in changes]
        return [
            Recovered(
                scenes[k], float(mismatch[k]), run.texts(k), str(run.endings[k]), changes[k].name
            )
            for k in np.argsort(costs, kind="stable")[:count].tolist()
        ]

    def _run(
        self, inputs: Mapping[str, Option], changes: list[Option]
    ) -> tuple[list[dict[str, Option]], Outcomes, NDArray[np.float64]]:
        """Return the scenes with each of some changes, what the program prints for them, and what
        their results cost.

        Line 400 may turn the sign of MU: where another is printed than was read, it is typed
        the other way.
        """
        scenes = [{**inputs, change.name: change} for change in changes]
        run = self._print(scenes)
        read = np.array([scene["MUP"].printed.encode() for scene in scenes], TEXT)
        mup = run.printed("MUP")
        rows = np.flatnonzero((mup != read) & (read != b"0") & (mup != b"")).tolist()
        for k in rows:
            option = scenes[k]["MUP"]
            scenes[k]["MUP"] = option._replace(typed=opposite(option.typed))
        if rows:
            run.fields[rows], run.endings[rows] = self._print([scenes[k] for k in rows])
            mup = run.printed("MUP")
        mismatch = CONTRADICTED * ((mup != read) & (mup != b""))
        for name, costs in self.expected.items():
            mismatch += _result_costs(run.printed(name), costs)
        return scenes, run, mismatch

    def _print(self, scenes: Sequence[Mapping[str, Option]]) -> Outcomes:
        """Return what the program prints for scenes."""
        columns = {name: [scene[name].typed for scene in scenes] for name in (*INPUTS, "M")}
        return self.program.run({scene_name(name): texts for name, texts in columns.items()})


def _option(name: str, value: Decimal) -> Option:
    """Return a value of an input as the program prints it."""
    entry = stored_and_printed(f"{value.normalize():f}")
    text = entry[1] if entry else "0"
    return Option(name, text, text, WRONG)


def _result_costs(printed: NDArray[np.bytes_], costs: Mapping[str, float]) -> NDArray[np.float64]:
    """Return the cost of each text that the program prints for a result, b"" for none.

    Another number than was read costs up to twice `CONTRADICTED`, in proportion to their distance.
    """
    if not costs:
        return np.where(printed == b"", 0.0, UNPAIRED)
    numbers = np.where(printed == b"", b"nan", printed).astype(float)
    read = float(next(iter(costs)))
    distances = np.abs(numbers - read) / (np.abs(numbers) + abs(read) + TINY)
    total: NDArray[np.float64] = CONTRADICTED * (1 + np.nan_to_num(distances, nan=1.0))
    for text, cost in costs.items():
        total[printed == text.encode()] = cost
    return total


def printed_fields(scene: Mapping[str, str]) -> Texts:
    """Return the numbers that the program prints for a scene, by name."""
    return Listing().run({name: [text] for name, text in scene.items()}).texts(0)


def unseen_digits(recovered: Recovered, program: Listing) -> dict[str, int]:
    """Return the number of digits of each input that nothing else on the page confirms.

    Parameters
    ----------
    recovered : Recovered
        The scene of the page.
    program : Listing
        The program.

    Returns
    -------
    dict of str to int
        Digits of which another one leaves all results as they are, by input; none are left out.
    """
    changes = [
        (name, text[:k] + str((int(text[k]) + 1) % 10) + text[k + 1 :])
        for name, text in recovered.scene.items()
        for k in range(len(text.partition("E")[0]))
        if name != "M" and text[k].isdigit()
    ]
    scenes = [{**recovered.scene, name: text} for name, text in changes]
    run = program.run({name: [scene[name] for scene in scenes] for name in recovered.scene})
    same = np.all([run.printed(n) == recovered.fields.get(n, "").encode() for n in RESULTS], axis=0)
    return dict(Counter(name for (name, _), is_same in zip(changes, same, strict=True) if is_same))
