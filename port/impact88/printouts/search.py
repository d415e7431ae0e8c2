"""The scene that a page comes from: combinations of what its inputs may be, replayed bit for bit.

A scene costs what its inputs do, plus what it costs that each result it prints is the one that was
read: the more, the further off it is. The scene as read is tried first; where it leaves a result
unexplained, the cheapest combinations of readings; then slips in inputs read with doubt, while they
explain more. An input that was read cleanly is replaced only if another value of it alone explains
every result that differs.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .costs import ALIKE, CONTRADICTED, LOST, PASSED, RESPELLED
from .numerals import TYPED, opposite, readings, slips, stored_and_printed
from .page import ANGLES, INPUTS, NAMES, PARTNERS, RESULTS
from .programs import Listing, Outcomes
from .reader import Reading

MAX_CANDIDATES = 10_000
"""Combinations of readings that are replayed: four digits that nobody can read, .1 s."""
MAX_OPTIONS = 40
"""Texts that an input may be."""
MAX_ROUNDS = 4
"""Slips that a scene may have."""
STEPS = sorted(range(-20, 21), key=abs)
"""Units of a place by which a value is varied: two of the place before it."""
PLACES = range(3, -5, -1)
"""Places of a value that are varied, from its first digit's: a cut number has lost some."""
MIN_RESULTS = 2
"""Results that differ from which an input may explain them: one is rather altered itself."""
HALF_TURN = Decimal(180)
DEGREES = Decimal(10)
"""Largest unit by which an angle is varied: the results turn with it."""
TINY = 1e-38
"""Less than any number that the Apple prints."""
FINAL_SPINS = ("WAF", "WBF")

Texts = dict[str, str]


class Option(NamedTuple):
    """Possible text of an input: its printed and its typed text, and their cost."""

    printed: str
    typed: str
    cost: float


class Candidate(NamedTuple):
    """Printed and typed texts of a scene's inputs, M, their cost, and the input that was read
    cleanly as another."""

    printed: Texts
    typed: Texts
    M: str
    cost: float
    replaced: str = ""


@dataclass(frozen=True)
class Recovered:
    """A scene that was replayed.

    Parameters
    ----------
    candidate : Candidate
        Its inputs as believed.
    mismatch : float
        The cost of its results.
    scene : dict of str to str
        The scene as typed.
    fields : dict of str to str
        The numbers that the program prints.
    ending : str
        The message that ends the program, "" for a normal end.
    """

    candidate: Candidate
    mismatch: float
    scene: Texts
    fields: Texts
    ending: str

    @property
    def cost(self) -> float:
        """Cost of inputs and results."""
        return self.candidate.cost + self.mismatch


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
    search = _Search(reading, given, program)
    has_spins = all(name in reading.slots for name in FINAL_SPINS)  # M = 4 prints none
    ms = [("6", 0.0)] if has_spins else [("4", 0.0), ("6", ALIKE)]
    if "M" in given:
        ms = [(given["M"], 0.0)]
    first = {name: options[:1] for name, options in columns.items()}
    best = search.replay(_combinations(first, ms, len(ms)))[0]
    if best.mismatch >= CONTRADICTED:
        best = search.replay(_combinations(columns, ms, MAX_CANDIDATES))[0]
    is_exact = len(search.clean) == len(search.read)  # else what is in doubt is repaired first
    if is_exact and (scenes := search.replace(best)):
        return scenes, []
    repaired = best
    for _ in range(MAX_ROUNDS):
        edited = search.replay(search.edits(repaired.candidate))
        if repaired.mismatch < CONTRADICTED or not edited or edited[0].cost >= repaired.cost:
            break
        repaired = edited[0]
    # slips are believed only where they explain most of what differs
    if 2 * repaired.mismatch <= best.mismatch:
        best = repaired
    return search.replace(best) or [best], []


def _options(
    reading: Reading, name: str, given: Mapping[str, str], program: Listing
) -> list[Option]:
    """Return what an input may be, the cheapest first: as printed, and as typed at the prompt."""
    texts = dict(reading.readings(name))
    reply = reading.replies.get(name, "")
    entry = stored_and_printed(reply) if TYPED.fullmatch(reply) else None
    doubt = ALIKE + LOST * (name in reading.slots)
    for text in [entry[1]] if entry else readings(reply):
        texts[text] = min(texts.get(text, doubt), doubt)
    given_text = given.get(scene_name(name), "")
    if given_text and not texts and (entry := stored_and_printed(given_text, name in ANGLES)):
        reply = given_text
        texts[entry[1]] = 0.0
    options: list[Option] = []
    for text, cost in sorted(texts.items(), key=lambda item: item[1])[:MAX_OPTIONS]:
        is_typed = entry is not None and entry[1] == text
        for entry_text in (reply,) if is_typed else program.spellings(name, text)[:1]:
            options.append(Option(text, entry_text, cost))
    return options


def _combinations(
    columns: Mapping[str, Sequence[Option]], ms: Sequence[tuple[str, float]], count: int
) -> list[Candidate]:
    """Return the cheapest combinations of options."""
    ways: list[tuple[float, str, list[Option]]] = [(cost, m, []) for m, cost in ms]
    for options in columns.values():
        longer = ((cost + o.cost, m, [*way, o]) for cost, m, way in ways for o in options)
        ways = sorted(longer, key=lambda way: way[0])[:count]
    return [
        Candidate(
            {name: option.printed for name, option in zip(columns, way, strict=True)},
            {name: option.typed for name, option in zip(columns, way, strict=True)},
            m,
            cost,
        )
        for cost, m, way in ways
    ]


class _Search:
    """Replay of candidates for the scene of a page.

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
        self.read = [n for n in INPUTS if n in reading.slots or scene_name(n) not in given]
        names = RESULTS if type(program) is Listing else [n for n in NAMES if n != "MUP"]
        self.expected = {name: reading.readings(name) for name in names}
        self.is_machine_read = reading.is_machine_read
        self.sure = [n for n in names if n in reading.slots and reading.slots[n].is_clean]
        self.read_texts = {
            name: reading.slots[name].text if name in reading.slots else "" for name in INPUTS
        }
        self.clean = [
            name
            for name in self.read
            if (reading.slots[name].is_clean if name in reading.slots else name in reading.replies)
        ]

    def edits(self, candidate: Candidate) -> list[Candidate]:
        """Return a scene with one input typed otherwise that prints alike, or with one slip in an
        input: in one read cleanly only where a machine read the page."""
        edits = []
        for name in self.read:
            text, entry = candidate.printed[name], candidate.typed[name]
            texts = [*self.program.spellings(name, text)]
            if name == "MUP":  # -10 printed of a typed 10 is no pivot
                texts.append(opposite(entry))
            for rank, spelling in enumerate(texts):
                cost = candidate.cost + PASSED * (1 + rank / 9)
                edits.append(
                    candidate._replace(typed={**candidate.typed, name: spelling}, cost=cost)
                )
            is_clean = name in self.clean
            if self.is_machine_read or not is_clean:
                for slip, cost in chain(slips(text), slips(self.read_texts[name])):
                    doubt = cost + CONTRADICTED * (is_clean and slip != self.read_texts[name])
                    edit = _with(candidate, name, slip)
                    edits.append(edit._replace(cost=candidate.cost + doubt, replaced=""))
        return edits

    def replace(self, scene: Recovered) -> list[Recovered]:
        """Return the scenes in which another value of one clean input explains all results.

        A single result that differs is not explained so. Each place of a value is found in turn,
        beginning before its first digit; of those that explain as much, the one with the fewest
        decimal places counts. Of two angles that enter only as a sum, either explains as much.
        """
        base = scene.candidate
        values = {name: Decimal(base.printed[name]) for name in self.clean}
        if not values or self._count_differing(scene) < MIN_RESULTS:
            return []
        edits: list[Candidate] = []
        for place in PLACES:
            edits = []
            for name, value in values.items():
                unit = Decimal(1).scaleb(Decimal(base.printed[name]).adjusted() + place)
                limit = unit * 10**9
                if name in ANGLES:
                    unit, limit = min(unit, DEGREES), max(HALF_TURN, abs(value))
                for origin in (value, Decimal(base.printed[name])):
                    for step in STEPS:
                        text = _text_of(max(-limit, min(limit, origin + step * unit)))
                        edits.append(_with(base, name, text))
            costs = self._run(edits)[1].reshape(len(values), -1)
            best = costs.argmin(axis=1) + np.arange(len(values)) * costs.shape[1]
            edits = [edits[k] for k in best.tolist()]
            values = {edit.replaced: Decimal(edit.printed[edit.replaced]) for edit in edits}
        for name, partner in PARTNERS.items():
            if {name, partner} <= values.keys():
                total = values[name] + Decimal(base.printed[partner])
                edit = _with(base, partner, _text_of(total - Decimal(base.printed[name])))
                edits.append(edit._replace(cost=base.cost))
        scenes = [s for s in self.replay(edits, len(edits)) if not self._count_differing(s)]
        scenes = [s for s in scenes if s.cost <= scenes[0].cost + RESPELLED]
        return [*{s.candidate.replaced: s for s in scenes[::-1]}.values()][::-1]

    def _count_differing(self, scene: Recovered) -> int:
        """Return the number of results read cleanly that a scene does not explain."""
        mup = scene.candidate.printed["MUP"]
        count = sum(scene.fields.get(name, "") not in self.expected[name] for name in self.sure)
        return count + (scene.fields.get("MUP", mup) != mup)

    def replay(self, candidates: list[Candidate], count: int = 1) -> list[Recovered]:
        """Return the best candidates, replayed, the cheapest first."""
        run, mismatch = self._run(candidates)
        total = mismatch + np.array([candidate.cost for candidate in candidates])
        return [
            _scene_of(candidates[k], float(mismatch[k]), run, k)
            for k in np.argsort(total, kind="stable")[:count].tolist()
        ]

    def _run(self, candidates: list[Candidate]) -> tuple[Outcomes, NDArray[np.float64]]:
        """Return what the program prints for candidates, and the cost of their results.

        Line 400 may turn the sign of MU: where another is printed than was read, it is typed
        the other way.
        """
        run = self.program.run(_columns(candidates))
        mup = run.printed("MUP")
        read = np.array([candidate.printed["MUP"] for candidate in candidates], mup.dtype)
        rows = np.flatnonzero((mup != read) & (read != b"0") & (mup != b"")).tolist()
        for k in rows:
            entries = candidates[k].typed
            entries = {**entries, "MUP": opposite(entries["MUP"])}
            candidates[k] = candidates[k]._replace(typed=entries)
        if rows:
            outcomes = self.program.run(_columns([candidates[k] for k in rows]))
            run.fields[rows], run.endings[rows] = outcomes
        mup = run.printed("MUP")
        mismatch = CONTRADICTED * ((mup != read) & (mup != b""))
        for name, costs in self.expected.items():
            mismatch += _result_costs(run.printed(name), costs)
        return run, mismatch


def _with(candidate: Candidate, name: str, text: str) -> Candidate:
    """Return a candidate with another text of an input."""
    change = {name: text}
    numbers, entries = candidate.printed | change, candidate.typed | change
    places = _count_places(text) - _count_places(candidate.printed[name])
    return Candidate(numbers, entries, candidate.M, candidate.cost + ALIKE * max(places, 0), name)


def _count_places(text: str) -> int:
    """Return the number of decimal places of a number."""
    return -int(Decimal(text).normalize().as_tuple().exponent)


def _text_of(value: Decimal) -> str:
    """Return a value as the program prints it."""
    entry = stored_and_printed(f"{value:f}")
    return entry[1] if entry else "0"


def _columns(candidates: Sequence[Candidate]) -> dict[str, list[str]]:
    """Return the scenes of candidates as columns."""
    columns = {
        scene_name(name): [candidate.typed[name] for candidate in candidates] for name in INPUTS
    }
    return {**columns, "M": [candidate.M for candidate in candidates]}


def _result_costs(printed: NDArray[np.bytes_], costs: Mapping[str, float]) -> NDArray[np.float64]:
    """Return the cost of each text that the program prints for a result, b"" for none.

    Another number than was read costs up to twice `CONTRADICTED`, in proportion to their distance.
    """
    if not costs:
        return np.where(printed == b"", 0.0, LOST)
    numbers = np.where(printed == b"", b"nan", printed).astype(float)
    read = float(next(iter(costs)))
    distances = np.abs(numbers - read) / (np.abs(numbers) + abs(read) + TINY)
    total: NDArray[np.float64] = CONTRADICTED * (1 + np.nan_to_num(distances, nan=1.0))
    for text, cost in costs.items():
        total[printed == text.encode()] = cost
    return total


def _scene_of(candidate: Candidate, mismatch: float, run: Outcomes, k: int) -> Recovered:
    """Return a candidate with what the program prints for it."""
    scene = {scene_name(name): text for name, text in candidate.typed.items()} | {"M": candidate.M}
    return Recovered(candidate, mismatch, scene, run.texts(k), str(run.endings[k]))


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
    names: list[str] = []
    scenes: list[Texts] = []
    for name in map(scene_name, INPUTS):
        text = recovered.scene[name]
        for k, char in enumerate(text.partition("E")[0]):
            if char.isdigit():
                other = text[:k] + str((int(char) + 1) % 10) + text[k + 1 :]
                names.append(name)
                scenes.append({**recovered.scene, name: other})
    run = program.run({name: [scene[name] for scene in scenes] for name in recovered.scene})
    same = np.all([run.printed(n) == recovered.fields.get(n, "").encode() for n in RESULTS], axis=0)
    return dict(Counter(name for name, is_same in zip(names, same, strict=True) if is_same))
