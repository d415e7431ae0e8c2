"""The scene that a page comes from: combinations of what its inputs may be, replayed bit for bit.

A scene costs what its inputs do, plus what it costs that each result it prints is the one that was
read. The scene as read is tried first; where it leaves a result unexplained, the cheapest
combinations of readings; then slips in single inputs of the best ones, while they explain more.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import NamedTuple

import numpy as np

from .costs import ALIKE, CONTRADICTED, LOST, PASSED, RESPELLED
from .numerals import TYPED, readings, slips, stored_and_printed
from .page import ANGLES, INPUTS, NAMES, RESULTS
from .programs import Listing, Outcomes
from .reader import Reading

MAX_CANDIDATES = 10_000
"""Combinations of readings that are replayed: four digits that nobody can read, .1 s."""
MAX_OPTIONS = 40
"""Texts that an input may be."""
BEST = 3
"""Scenes from which the search for slips goes on, and its rounds."""
FINAL_SPINS = ("WAF", "WBF")

Texts = dict[str, str]
Option = tuple[tuple[str, ...], tuple[str, ...], float]
"""Printed texts and typed texts of an input, or of the five angles, and their cost."""
Columns = dict[tuple[str, ...], list[Option]]


class Candidate(NamedTuple):
    """Printed and typed texts of a scene's inputs, M, and their cost."""

    printed: Texts
    typed: Texts
    M: str
    cost: float


@dataclass(frozen=True)
class Recovered:
    """A scene that was replayed.

    Parameters
    ----------
    candidate : Candidate
        Its inputs as believed.
    mismatch : float
        What its results cost.
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


def opposite(text: str) -> str:
    """Return a number's text with the other sign."""
    return text[1:] if text.startswith("-") else "-" + text.removeprefix("+")


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
    columns: Columns = {
        (name,): _options(reading, name, program) for name in INPUTS if name not in ANGLES
    }
    columns[ANGLES] = [
        (row, typed, cost)
        for row, cost in reading.angle_rows
        if all(typed := _typed_angles(row, program))
    ]
    for names, options in columns.items():
        texts = tuple(given.get(scene_name(name), "") for name in names)
        stored = [stored_and_printed(text, names is ANGLES) for text in texts if text]
        if not options and len(stored) == len(names):
            options.append((tuple(one[1] for one in stored if one), texts, 0.0))
    if missing := [name for names, options in columns.items() for name in names if not options]:
        return [], missing
    has_spins = any(name in reading.slots for name in FINAL_SPINS)
    ms = [("6", 0.0), ("4", CONTRADICTED)] if has_spins else [("4", 0.0), ("6", ALIKE)]
    if "M" in given:
        ms = [(given["M"], 0.0)]
    compared = RESULTS if type(program) is Listing else [n for n in NAMES if n != "MUP"]
    expected = {name: reading.readings(name) for name in compared}
    first = {names: options[:1] for names, options in columns.items()}
    best = replay_candidates([*_combinations(first, ms, len(ms))], expected, program)
    if best[0].mismatch >= CONTRADICTED:
        best = replay_candidates([*_combinations(columns, ms, MAX_CANDIDATES)], expected, program)
    as_read = best[0]
    clean = {
        name: slot.text for name, slot in reading.slots.items() if name in INPUTS and slot.is_clean
    }
    for _ in range(BEST):
        if best[0].mismatch < CONTRADICTED:
            break
        edits = [*_edits(best[0].candidate, clean, program)]
        more = replay_candidates(edits, expected, program)
        if more[0].cost >= best[0].cost:
            break
        best = sorted([*best, *more], key=lambda found: found.cost)[:BEST]
    # slips are believed only where they explain most of what differs
    if 2 * best[0].mismatch > as_read.mismatch:
        return [as_read], []
    limit = best[0].cost + RESPELLED
    return [scene for scene in best if scene.cost <= limit], []


def _typed_angles(row: Sequence[str], program: Listing) -> tuple[str, ...]:
    pairs = zip(ANGLES, row, strict=True)
    return tuple(next(iter(program.spellings(name, text)), "") for name, text in pairs)


def _options(reading: Reading, name: str, program: Listing) -> list[Option]:
    """Return what an input may be, the cheapest first: as printed, and as typed at the prompt."""
    texts = dict(reading.readings(name))
    reply = reading.replies.get(name, "")
    typed = stored_and_printed(reply) if TYPED.fullmatch(reply) else None
    more = ALIKE + LOST * bool(reading.slots.get(name))
    for text in [typed[1]] if typed else readings(reply):
        texts[text] = min(texts.get(text, more), more)
    options: list[Option] = []
    for text, cost in sorted(texts.items(), key=lambda item: item[1])[:MAX_OPTIONS]:
        if typed and typed[1] == text:
            options.append(((text,), (reply,), cost))
        elif spelled := program.spellings(name, text):
            options.append(((text,), (spelled[0],), cost))
    return options


def _combinations(
    columns: Columns, ms: Sequence[tuple[str, float]], count: int
) -> Iterator[Candidate]:
    """Yield the cheapest combinations of options."""
    costs = np.array([cost for _, cost in ms])
    ways = np.arange(len(ms))[:, None]
    for options in columns.values():
        sums = np.add.outer(costs, [cost for *_, cost in options]).ravel()
        order = sums.argsort(kind="stable")[:count]
        costs = sums[order]
        ways = np.column_stack([ways[order // len(options)], order % len(options)])
    for cost, (m, *way) in zip(costs.tolist(), ways.tolist(), strict=True):
        printed: Texts = {}
        typed: Texts = {}
        for (names, options), k in zip(columns.items(), way, strict=True):
            printed |= dict(zip(names, options[k][0], strict=True))
            typed |= dict(zip(names, options[k][1], strict=True))
        yield Candidate(printed, typed, ms[m][0], cost)


def _edits(candidate: Candidate, clean: Mapping[str, str], program: Listing) -> Iterator[Candidate]:
    """Yield a scene with one input typed otherwise that prints alike, or with one slip in it.

    A number that was read cleanly is contradicted by a slip in it.
    """
    printed, typed, m, cost = candidate
    for name, text in printed.items():
        texts = [*program.spellings(name, text)]
        if name == "MUP":  # line 400 turns its sign, and -10 printed of a typed 10 is no pivot
            texts.append(opposite(typed[name]))
        for rank, other in enumerate(texts):
            yield Candidate(printed, {**typed, name: other}, m, cost + PASSED * (1 + rank / 9))
        read = clean.get(name, text)
        for other, more in chain([(read, 0.0)], slips(text), slips(read)):
            total = cost + more + CONTRADICTED * (name in clean and other != read)
            yield Candidate({**printed, name: other}, {**typed, name: other}, m, total)


def replay_candidates(
    candidates: Sequence[Candidate],
    expected: Mapping[str, Mapping[str, float]],
    program: Listing,
) -> list[Recovered]:
    """Return the best candidates, replayed, the cheapest first.

    Parameters
    ----------
    candidates : sequence of Candidate
        Scenes.
    expected : mapping of str to mapping of str to float
        What each result may be, and the cost of each; an empty one for a result not read.
    program : Listing
        The program.
    """
    columns = {
        name: [candidate.typed[name] for candidate in candidates]
        for name in INPUTS
        if name != "MUP"
    }
    columns["M"] = [candidate.M for candidate in candidates]
    mu = np.array([candidate.typed["MUP"] for candidate in candidates], dtype="U40")
    wanted = np.array([candidate.printed["MUP"] for candidate in candidates])
    run = program.run({**columns, "MU": mu.tolist()})
    turned = (run.printed("MUP") != wanted) & (wanted != "0") & (run.printed("MUP") != "")
    if turned.any():
        mu[turned] = [opposite(text) for text in mu[turned].tolist()]
        run = program.run({**columns, "MU": mu.tolist()})
    mismatch = CONTRADICTED * ((run.printed("MUP") != wanted) & (run.printed("MUP") != ""))
    for name, costs in expected.items():
        texts, back = np.unique(run.printed(name), return_inverse=True)
        mismatch += np.array([_result_cost(text, costs) for text in texts.tolist()])[back]
    total = mismatch + np.array([candidate.cost for candidate in candidates])
    return [
        _recovered(candidates[k], float(mismatch[k]), str(mu[k]), run, k)
        for k in np.argsort(total, kind="stable")[:BEST].tolist()
    ]


def _result_cost(text: str, costs: Mapping[str, float]) -> float:
    """Return what it costs that the program prints a result, "" for none."""
    if costs:
        return costs.get(text, CONTRADICTED)
    return LOST if text else 0.0


def _recovered(
    candidate: Candidate, mismatch: float, mu: str, outcomes: Outcomes, k: int
) -> Recovered:
    texts = zip(NAMES, outcomes.fields[k].tolist(), strict=True)
    fields = {name: text for name, text in texts if text}
    scene = {name: candidate.typed[name] for name in INPUTS if name != "MUP"}
    scene |= {"MU": mu, "M": candidate.M}
    return Recovered(candidate, mismatch, scene, fields, outcomes.endings[k])


def printed_fields(scene: Mapping[str, str]) -> Texts:
    """Return the numbers that the program prints for a scene, by name."""
    texts = Listing().run({name: [text] for name, text in scene.items()}).fields[0].tolist()
    return {name: text for name, text in zip(NAMES, texts, strict=True) if text}


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
    same = np.all([run.printed(n) == recovered.fields.get(n, "") for n in RESULTS], axis=0)
    return dict(Counter(name for name, is_same in zip(names, same, strict=True) if is_same))
