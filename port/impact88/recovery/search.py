"""Searching for the scene a printout comes from: choices for each input, tried by what they print.

Each input has a few printed texts its glyphs may have been, with what each costs to believe. A
combination is screened in double precision (kinetic energy first, which few inputs enter, then all
results), and the best of them are replayed in the Apple's own arithmetic. What a scene costs is
what its inputs cost to believe plus what every printed result then costs.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from math import prod
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..closedform import energy as closed_form
from ..closedform.solve import solve
from ..doubles import double
from ..fields import FIELDS, FINAL_SPINS, INPUTS
from ..names import VELOCITIES
from ..reading.numerals import candidates
from ..reading.printout import Printout, Reading
from . import replays
from .choices import Choice, Choices, other_bits

Floats = NDArray[np.float64]
Picks = NDArray[np.intp]
"""Combinations: a row each, the index of the choice taken in every column's list."""

MISMATCH = 3.0
"""What a printed result costs that the program does not print."""
AGREES = 1.5
"""Below this a result counts as explained."""
_UNREAD = 0.6
"""The same where hardly anything was read."""
_ABSENT = 0.7
"""What it costs that the program prints a result the page does not have."""
_SCREENED = 30_000
_REPLAYED = 160
_ENERGY_KEPT = 60
_FEW, _AT_ONCE = 500, 1_000_000
"""Combinations up to which they are sought one by one, and that are laid out at once at most."""
_VARIANTS = 3_000
_CLOSELY = 5_000
_TELLING = ("VAX", "VAY", "VBX", "VBY")
"""Of many combinations these results are looked at first, and so many looked at closely."""
_FEW_DIFFER = 8
KINETIC = frozenset(("MA", "MB", "IA", "IB", "UX", "UY", "WA", "VX", "VY", "WB"))
"""The inputs that enter the kinetic energy."""
_ROUGH = 4e-7
"""Relative error allowed to the Apple's arithmetic in screening."""
RESULTS = tuple(name for name in FIELDS if name not in INPUTS)


class Scored(NamedTuple):
    """A scene tried: what it and its results cost, the texts typed, the texts assumed printed, what
    it prints, and the names in which that is not what the page says."""

    cost: float
    scene: dict[str, str]
    assumed: dict[str, str]
    outcome: replays.Outcome
    wrong: frozenset[str]


@dataclass
class Expected:
    """A printed result as read: the texts it may be, with what each costs."""

    name: str
    texts: dict[str, float]
    default: float

    def cost(self, text: str) -> float:
        """What it costs that the program prints ``text`` here."""
        return self.texts.get(text, self.default)


def expected_results(shown: Printout) -> list[Expected]:
    """The results of a printout as read."""
    return [_expected(name, shown.fields[name]) for name in RESULTS if name in shown.fields]


def _expected(name: str, reading: Reading) -> Expected:
    if reading.clean:
        texts = {**dict(candidates(reading.region, 1)), reading.text: 0.0}
    else:
        texts = dict(candidates(reading.region, 60, reading.sign_free))
    if reading.closing and reading.region[-1].char in reading.closing:
        for text, cost in candidates(reading.region[:-1], 8):
            texts.setdefault(text, cost + 0.5)
    if reading.clean:
        return Expected(name, texts, MISMATCH)
    digits = sum(glyph.char.isdigit() for glyph in reading.region)
    return Expected(name, texts, MISMATCH if digits >= 2 else _UNREAD)


class Search:
    """The search for one printout's scene."""

    def __init__(self, shown: Printout) -> None:
        self.shown = shown
        self.expected = expected_results(shown)
        self._lost_inputs = set(INPUTS) - set(shown.fields)

    def best(self, choices: Choices) -> Scored:
        """The scene of least cost that the choices allow."""
        tried = self.replayed(choices, combinations(choices, 2))
        best = min(tried, key=_cost)
        if best.wrong or best.cost >= 0.05:
            tried += self.replayed(choices, self._screened(choices))
            best = min(tried, key=_cost)
        return self.other_bits(best)

    def other_bits(self, best: Scored) -> Scored:
        """The same printed inputs, typed in other ways that enter the equations with other bits."""
        if not 0 < len(best.wrong) <= _FEW_DIFFER:
            return best
        choices = other_bits(best.scene, best.assumed)
        picks = combinations(choices, _VARIANTS)
        if len(picks) < 2:
            return best
        extra = best.cost - sum(self._costs(best.outcome))
        tried = [
            one._replace(assumed=best.assumed, cost=one.cost + extra)
            for one in self.replayed(choices, picks)
        ]
        return min([best, *tried], key=_cost)

    def screened(
        self,
        choices: Choices,
        picks: Picks,
        most: int = _REPLAYED,
        telling: Sequence[str] = _TELLING,
    ) -> Picks:
        """The combinations that explain most, by double precision. ``telling``: the results that
        are looked at first where there are many."""
        if len(picks) <= most:
            return picks
        if len(picks) > 4 * _CLOSELY:
            few = [one for one in self.expected if one.name in telling and one.default == MISMATCH]
            costs = self._rough(choices, picks, few)
            picks = picks[np.argsort(costs, kind="stable")[:_CLOSELY]]
        costs = self._rough(choices, picks, self.expected)
        return picks[np.argsort(costs, kind="stable")[:most]]

    def _screened(self, choices: Choices) -> Picks:
        """The most promising combinations: those whose kinetic energy is the printed one first."""
        still = _without_spin(choices)
        entering = [place for place, some in enumerate(choices) if KINETIC & set(some[0].typed)]
        kinetic = [place for place in entering if not still & set(choices[place][0].typed)]
        others = [place for place in range(len(choices)) if place not in kinetic]
        own = [choices[place][: None if place in kinetic else 1] for place in entering]
        first = self.by_energy(own, combinations(own, _SCREENED), _ENERGY_KEPT)
        first = first[:, [entering.index(place) for place in kinetic]]
        room = max(2, _SCREENED // len(first))
        second = combinations([choices[place] for place in others], room)
        picks = np.zeros((len(first) * len(second), len(choices)), np.intp)
        picks[:, kinetic] = np.repeat(first, len(second), axis=0)
        picks[:, others] = np.tile(second, (len(first), 1))
        return self.screened(choices, picks)

    def by_energy(self, choices: Choices, picks: Picks, most: int = _ENERGY_KEPT) -> Picks:
        """The combinations of masses and velocities that give the printed KE, if any do."""
        if len(picks) <= most:
            return picks
        costs = _believing(choices, picks)
        expected = next((one for one in self.expected if one.name == "KI"), None)
        if expected is not None:
            costs = costs + mismatch(expected, kinetic_energy(columns(choices, picks)))
        return picks[np.argsort(costs, kind="stable")[:most]]

    def _rough(self, choices: Choices, picks: Picks, expected: Sequence[Expected]) -> Floats:
        """What each combination costs, some of its results in double precision."""
        value = columns(choices, picks)
        costs = _believing(choices, picks)
        results = in_doubles(value, [*(one.name for one in expected), "MUP"])
        mu = printed_mu(choices, picks)
        wrong_sign = np.abs(results["MUP"] - mu) > 1e-6 * np.abs(mu)
        costs = costs + np.where(wrong_sign, MISMATCH, 0.0)
        for one in expected:
            wrong = mismatch(one, results[one.name])
            if one.name in FINAL_SPINS:
                wrong = np.where(value["M"] == 6, wrong, MISMATCH)
            costs = costs + wrong
        return costs

    def replayed(self, choices: Choices, picks: Picks) -> list[Scored]:
        """Combinations, replayed in the Apple's arithmetic."""
        joined = []
        for pick in picks.tolist():
            scene: dict[str, str] = {}
            assumed: dict[str, str] = {}
            cost = 0.0
            for options, index in zip(choices, pick, strict=True):
                scene.update(options[index].typed)
                assumed.update(options[index].printed)
                cost += options[index].cost
            joined.append((scene, assumed, cost))
        outcomes = replays.run_all([scene for scene, _, _ in joined])
        return [self._scored(*one, outcome) for one, outcome in zip(joined, outcomes, strict=True)]

    def results_cost(self, scored: Scored) -> float:
        """What the results of a scene that was replayed cost, its inputs apart."""
        return self._scored(scored.scene, {}, 0.0, scored.outcome).cost

    def replayed_scene(self, scene: dict[str, str], assumed: dict[str, str]) -> Scored:
        """One scene, replayed."""
        return self._scored(scene, assumed, 0.0, replays.run_once(scene))

    def _scored(
        self, scene: dict[str, str], assumed: dict[str, str], cost: float, outcome: replays.Outcome
    ) -> Scored:
        names = [one.name for one in self.expected]
        costs = dict(zip(names, self._costs(outcome), strict=True))
        for name, text in assumed.items():
            if outcome.fields.get(name, text) != text:
                costs[name] = MISMATCH
        if self.shown.ending is not None and self.shown.ending != outcome.ending:
            costs["ENDING"] = MISMATCH
        if self.shown.has_final_spins and scene["M"] != "6":
            costs["M"] = MISMATCH
        absent = set(outcome.fields) - set(self.shown.fields) - self._lost_inputs
        wrong = frozenset(name for name, one in costs.items() if one >= AGREES)
        total = cost + sum(costs.values()) + _ABSENT * len(absent)
        return Scored(total, scene, assumed, outcome, wrong)

    def _costs(self, outcome: replays.Outcome) -> Iterator[float]:
        for one in self.expected:
            text = outcome.fields.get(one.name)
            yield MISMATCH if text is None else one.cost(text)


def _cost(scored: Scored) -> float:
    return scored.cost


def combinations(choices: Sequence[Sequence[Choice]], most: int) -> Picks:
    """The combinations of one choice each, cheapest first, up to ``most``."""
    sizes = [len(options) for options in choices]
    if most < _FEW or prod(sizes) > _AT_ONCE:
        return np.array(list(islice(_cheapest(choices), most)), np.intp)
    costs: Floats = np.zeros(())
    for options in choices:
        costs = np.add.outer(costs, [choice.cost for choice in options])
    best = np.argsort(costs, axis=None, kind="stable")[:most]
    return np.stack(np.unravel_index(best, sizes), axis=1).astype(np.intp)


def _cheapest(choices: Sequence[Sequence[Choice]]) -> Iterator[tuple[int, ...]]:
    costs = [[choice.cost for choice in options] for options in choices]
    start = (0,) * len(choices)
    heap = [(sum(some[0] for some in costs), start, 0)]
    while heap:
        cost, pick, last = heapq.heappop(heap)
        yield pick
        # each combination is reached once: only the last column that moved, or a later one, moves
        for place in range(last, len(choices)):
            index = pick[place] + 1
            if index < len(costs[place]):
                step = costs[place][index] - costs[place][index - 1]
                following = (*pick[:place], index, *pick[place + 1 :])
                heapq.heappush(heap, (cost + step, following, place))


def _without_spin(choices: Choices) -> frozenset[str]:
    """The inertias that do not spin, as first read: the energy says nothing of them."""
    first = {name: text for some in choices for name, text in some[0].typed.items()}
    spins = {"IA": "WA", "IB": "WB"}
    return frozenset(name for name, spin in spins.items() if not _number(first[spin]))


def _number(text: str) -> float:
    try:
        return double(text)
    except ValueError:
        return float("nan")


def _believing(choices: Choices, picks: Picks) -> Floats:
    """What the choices themselves cost."""
    costs: Floats = np.zeros(len(picks))
    for place, options in enumerate(choices):
        costs += np.array([choice.cost for choice in options])[picks[:, place]]
    return costs


def columns(choices: Choices, picks: Picks) -> dict[str, Floats]:
    """The typed values of combinations as columns of doubles."""
    columns_by_name: dict[str, Floats] = {}
    for place, options in enumerate(choices):
        for name in options[0].typed:
            columns_by_name[name] = np.array([_number(one.typed[name]) for one in options])[
                picks[:, place]
            ]
    return columns_by_name


def printed_mu(choices: Choices, picks: Picks) -> Floats:
    """The MU that each combination takes to be printed."""
    for place, options in enumerate(choices):
        if "MU" in options[0].typed:
            texts = [_number(one.printed.get("MUP", "")) for one in options]
            return np.array(texts)[picks[:, place]]
    return np.full(len(picks), np.nan)


def kinetic_energy(value: Mapping[str, Floats]) -> Floats:
    """Line 320 in double precision."""
    with np.errstate(all="ignore"):
        energy: Floats = closed_form.kinetic_energy(
            [value[name] for name in ("MA", "MB", "IA", "IB")], [value[n] for n in VELOCITIES]
        )
    return energy


def in_doubles(value: Mapping[str, Floats], names: Sequence[str]) -> dict[str, Floats]:
    """What the program prints, unfloored, in double precision.

    With M = 4 the closed form leaves the spins out of both energies; the listing counts the initial
    ones (line 320) and, having no final ones, none after (lines 580, 590)."""
    points = np.equal(value["M"], 4)
    energies = ("KI", "LOSS") if np.any(points) else ()
    with np.errstate(all="ignore"):
        results: dict[str, Floats] = dict(solve(value, list(dict.fromkeys([*names, *energies]))))
        if energies:
            whole = kinetic_energy(value)
            after = results["KI"] * (1 - results["LOSS"] / 100)
            loss = 100 * (whole - after) / whole
            results["KI"] = np.where(points, whole, results["KI"])
            results["LOSS"] = np.where(points, loss, results["LOSS"])
    return results


def mismatch(expected: Expected, values: Floats) -> Floats:
    """What each value costs where the program prints it to the places of its line."""
    costs: Floats = np.full(values.shape, expected.default)
    places = FIELDS[expected.name].places
    unit = 0.0 if places is None else 10.0**-places
    for text, cost in expected.texts.items():
        number = _number(text)
        slack = _ROUGH * abs(number) + 0.05 * unit
        if places is None:
            slack = max(slack, 1e-9)
        fits = (values >= number - slack) & (values < number + unit + slack)
        costs = np.where(fits & (cost < costs), cost, costs)
    return costs
