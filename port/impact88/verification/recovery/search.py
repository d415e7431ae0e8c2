"""Searching for the scene a printout comes from: texts for each input, tried by what they print.

Each input has a few texts that the page may show, with what each costs to believe. Combinations are
screened in double precision (the kinetic energy first, which few inputs enter, then all results),
and the best of them are replayed in the Apple's own arithmetic. What a scene costs is what its
inputs cost to believe plus what every printed result then costs.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf
from operator import attrgetter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.doubles import double
from ...collision.fields import ANGLES, FIELDS, FINAL_SPINS, INPUTS, scene_name
from ...mechanics.closedform import energy as closed_form
from ...mechanics.closedform.solve import solve
from ...names import VELOCITIES
from ..reading.glyphs import letters
from ..reading.printout import Printout
from . import replays
from .typedtext import mu_turned, opposite, texts_that_print

Floats = NDArray[np.float64]
Picks = NDArray[np.intp]
"""Combinations: a row each, the index of the option taken in every column."""

MISMATCH = 3.0
"""What a printed result costs that the program does not print."""
AGREES = 1.5
"""Below this a result counts as explained."""
_UNREAD = 0.6
"""What a result costs of which hardly anything was read, or that the page does not have."""
_OTHER_BITS = 0.02
"""What it costs that a number was typed with zeros that do not show, by the rank of that text."""
_MOST = 160  # combinations that are replayed
_ROOM = 30_000
"""Combinations of the rest tried with the likeliest of masses and velocities."""
_CLOSELY = 5_000
"""Of more combinations, four results are looked at first; these are then looked at closely."""
KINETIC = frozenset(("MA", "MB", "IA", "IB", "UX", "UY", "WA", "VX", "VY", "WB"))
"""The inputs that enter the kinetic energy."""
_TELLING = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF", "XAF", "YAF", "XBF", "YBF", "LOSS")
_SPINS = (("IA", "WA"), ("IB", "WB"))
_ENERGIES = 60
"""Combinations of masses and velocities that are tried with the rest."""
_ROUGH = 4e-7
"""Relative error allowed to the Apple's arithmetic in screening."""


@dataclass
class Column:
    """What an input, or the row of angles, may be: the fields, and the texts that may be printed
    for them (``typed``: that may have been typed), each with what it costs, cheapest first."""

    names: tuple[str, ...]
    options: list[tuple[tuple[str, ...], float]]
    typed: bool = False

    @cached_property
    def costs(self) -> Floats:
        """What each option costs."""
        return np.array([cost for _, cost in self.options])

    @cached_property
    def numbers(self) -> dict[str, Floats]:
        """The options as doubles, by the scene's names."""
        return {
            scene_name(name): np.array([_number(texts[at]) for texts, _ in self.options])
            for at, name in enumerate(self.names)
        }


def column_of(name: str, ways: Iterable[tuple[str, float]], typed: bool = False) -> Column:
    """What one input may be."""
    return Column((name,), [((text,), cost) for text, cost in ways], typed)


Columns = Sequence[Column]
Names = Collection[str]


class Scored(NamedTuple):
    """A scene tried: what it and its results cost, the texts typed, the texts assumed printed, what
    it prints, and the names in which that is not what the page says."""

    cost: float
    scene: dict[str, str]
    assumed: dict[str, str]
    outcome: replays.Outcome
    wrong: frozenset[str]


class Expected(NamedTuple):
    """A printed result as read: the texts it may be, with what each costs."""

    name: str
    texts: dict[str, float]
    default: float

    def mismatch(self, values: Floats) -> Floats:
        """What each unfloored value costs."""
        costs: Floats = np.full(values.shape, self.default)
        places = FIELDS[self.name].places
        unit = 0.0 if places is None else 10.0**-places
        for text, cost in self.texts.items():
            number = _number(text)
            slack = _ROUGH * abs(number) + max(0.05 * unit, 1e-9)
            fits = (values >= number - slack) & (values < number + unit + slack)
            costs = np.where(fits, np.minimum(costs, cost), costs)
        return costs


_cost = attrgetter("cost")


class Search:
    """The search for one printout's scene. ``typed``: by field what was typed for a printed text,
    where the page or a scene file says so."""

    def __init__(self, shown: Printout, typed: Mapping[str, Mapping[str, str]]) -> None:
        self.shown = shown
        self.expected: list[Expected] = []
        for name in FIELDS:
            if name not in INPUTS and (reading := shown.fields.get(name)):
                legible = reading.clean or sum(map(str.isdigit, letters(reading.region))) >= 2
                default = MISMATCH if legible else _UNREAD
                self.expected.append(Expected(name, reading.texts(60), default))
        self._typed = typed
        on_row = ANGLES if shown.angles else ()
        self._on_page = {name for name in INPUTS if name in shown.fields or name in on_row}
        self._lost_inputs = set(INPUTS) - set(shown.fields)

    def best(self, columns: Columns) -> Scored:
        """The scene of least cost that the columns allow."""
        best = min(self.replayed(columns, combinations(columns, 2)), key=_cost)
        if best.wrong or best.cost >= 0.05:
            tried = self.replayed(columns, self.promising(columns, _ROOM))
            best = min([best, *tried], key=_cost)
        return self._other_bits(best) if best.wrong else best

    def promising(
        self, columns: Columns, room: int, most: int = _MOST, limit: float = inf, wrong: Names = ()
    ) -> Picks:
        """The most promising combinations: those whose kinetic energy is the printed one first, the
        better they are with the more of the rest, ``room`` for the best. ``limit``: what all inputs
        may cost to believe, and the energy; ``wrong``: results that tell most."""
        first = dict(
            pair
            for column in columns
            for pair in zip(column.names, column.options[0][0], strict=True)
        )
        # the energy says nothing of the inertia of what does not spin
        moving = KINETIC - {inertia for inertia, spin in _SPINS if not _number(first[spin])}
        kinetic = [place for place, column in enumerate(columns) if moving & set(column.names)]
        others = [place for place in range(len(columns)) if place not in kinetic]
        some = combinations([columns[place] for place in kinetic], room, limit)
        picks = np.zeros((len(some), len(columns)), np.intp, "F")
        picks[:, kinetic] = some
        costs = np.zeros(len(picks))
        for expected in self.expected:
            if expected.name == "KI":
                costs = expected.mismatch(kinetic_energy(_values(columns, picks)))
        order = np.argsort(np.append(-1.0, costs[1:]), kind="stable")[:_ENERGIES]
        spent = (_believing(columns, picks) + costs)[order]
        rest = combinations([columns[place] for place in others], room, limit - spent.min())
        beliefs = _believing([columns[place] for place in others], rest)
        parts = []
        for rank, (pick, before) in enumerate(zip(picks[order], spent, strict=True), 1):
            count = int(np.searchsorted(beliefs, limit - before, side="right"))
            part = np.zeros((min(count, max(2, room // rank**2)), len(columns)), np.intp, "F")
            part[:] = pick
            part[:, others] = rest[: len(part)]
            parts.append(part)
        return self.screened(columns, np.concatenate(parts), most, wrong)

    def screened(self, columns: Columns, picks: Picks, most: int, wrong: Names = ()) -> Picks:
        """The ``most`` combinations that explain most, by double precision."""
        telling = sorted(_TELLING, key=lambda name: name not in wrong)[:4]
        few = [
            result
            for result in self.expected
            if result.default == MISMATCH and result.name in telling
        ]
        for count, enough, expected in ((_CLOSELY, 4 * _CLOSELY, few), (most, most, self.expected)):
            if len(picks) > enough:
                value = _values(columns, picks)
                value["MU"] = self._typed_mu(value)
                costs = _believing(columns, picks)
                results = in_doubles(value, [result.name for result in expected])
                for result in expected:
                    cost = result.mismatch(results[result.name])
                    spun = result.name not in FINAL_SPINS or value["M"] == 6
                    costs = costs + np.where(spun, cost, MISMATCH)
                picks = picks[np.argsort(costs, kind="stable")[:count]]
        return picks

    def replayed(self, columns: Columns, picks: Picks) -> list[Scored]:
        """Combinations, replayed in the Apple's arithmetic, in their order."""
        value = _values(columns, picks)
        turned = self._typed_mu(value) != value["MU"]
        scenes: list[tuple[dict[str, str], dict[str, str], float]] = []
        for pick, turn in zip(picks.tolist(), turned.tolist(), strict=True):
            scene: dict[str, str] = {}
            assumed: dict[str, str] = {}
            cost = 0.0
            for column, index in zip(columns, pick, strict=True):
                texts, price = column.options[index]
                cost += price
                for name, text in zip(column.names, texts, strict=True):
                    scene[scene_name(name)] = text
                    if not column.typed:
                        known = self._typed.get(name, {}).get(text)
                        first = next(iter(texts_that_print(text, name in ANGLES)), text)
                        scene[scene_name(name)] = known or first
                        if name in self._on_page:
                            assumed[name] = text
            if turn:
                scene["MU"] = opposite(scene["MU"])
            scenes.append((scene, assumed, cost))
        found = [*self._scored(scenes)]
        # where double precision does not tell which way the contact slides
        for row, (scene, assumed, cost) in enumerate(scenes):
            if "MUP" in found[row].wrong:
                again = [({**scene, "MU": opposite(scene["MU"])}, assumed, cost)]
                found[row] = min(found[row], *self._scored(again), key=_cost)
        return found

    def _typed_mu(self, value: Mapping[str, Floats]) -> Floats:
        """What was typed where MU is printed so: line 400 turns its sign or not, whatever it is."""
        mu = value["MU"]
        if "MUP" not in self._on_page:
            return mu
        return np.where(in_doubles(value, ["MUP"])["MUP"] == -mu, -mu, mu)

    def _other_bits(self, best: Scored) -> Scored:
        """The same printed inputs, typed in other ways that enter the equations with other bits."""
        columns = []
        for name, typed in best.scene.items():
            printed = best.assumed.get("MUP" if name == "MU" else name, "")
            texts = texts_that_print(printed, name in ANGLES)
            if name == "MU" and texts and mu_turned(typed, printed):
                texts = tuple(map(opposite, texts))
            ways = enumerate(dict.fromkeys((typed, *texts)))
            columns.append(column_of(name, [(text, _OTHER_BITS * rank) for rank, text in ways]))
        picks = combinations(columns, _CLOSELY)
        extra = best.cost - self.replayed_scene(best.scene, best.assumed).cost
        scenes = []
        for pick, cost in zip(picks.tolist(), _believing(columns, picks), strict=True):
            taken = zip(columns, pick, strict=True)
            scene = {column.names[0]: column.options[index][0][0] for column, index in taken}
            scenes.append((scene, best.assumed, extra + float(cost)))
        return min([best, *self._scored(scenes)], key=_cost)

    def replayed_scene(self, scene: dict[str, str], assumed: dict[str, str]) -> Scored:
        """One scene, replayed."""
        return next(self._scored([(scene, assumed, 0.0)]))

    def _scored(
        self, scenes: Sequence[tuple[dict[str, str], dict[str, str], float]]
    ) -> Iterator[Scored]:
        """Scenes, each with the texts assumed printed and what it costs to believe, replayed."""
        outcomes = replays.run_all([scene for scene, _, _ in scenes])
        for (scene, assumed, cost), outcome in zip(scenes, outcomes, strict=True):
            costs = dict.fromkeys((result.name for result in self.expected), MISMATCH)
            for result in self.expected:
                if text := outcome.fields.get(result.name):
                    costs[result.name] = result.texts.get(text, result.default)
            wrong = {
                name for name, text in assumed.items() if outcome.fields.get(name, text) != text
            }
            if self.shown.ending is not None and self.shown.ending != outcome.ending:
                wrong.add("ENDING")
            if self.shown.has_final_spins and scene["M"] != "6":
                wrong.add("M")
            costs.update(dict.fromkeys(wrong, MISMATCH))
            absent = set(outcome.fields) - set(self.shown.fields) - self._lost_inputs
            total = cost + sum(costs.values()) + _UNREAD * len(absent)
            differing = frozenset(name for name, price in costs.items() if price >= AGREES)
            yield Scored(total, scene, assumed, outcome, differing)


def combinations(columns: Columns, most: int, limit: float = inf) -> Picks:
    """The combinations of one option each, cheapest first, up to ``most`` and up to a cost."""
    steps = []
    costs: Floats = np.zeros(1)
    for column in columns:
        options = column.costs
        # both are sorted: with option j none but the first most / (j + 1) are among the cheapest
        counts = np.minimum(
            most // np.arange(1, len(options) + 1),
            np.searchsorted(costs, limit - options, side="right"),
        )
        before = np.concatenate([np.arange(count) for count in counts])
        option = np.repeat(np.arange(len(counts)), counts)
        every = costs[before] + options[option]
        if len(every) > most:
            kept = np.argpartition(every, most - 1)[:most]
            kept = kept[np.argsort(every[kept], kind="stable")]
        else:
            kept = np.argsort(every, kind="stable")
        costs = every[kept]
        steps.append((before[kept], option[kept]))
    picks = np.empty((len(costs), len(columns)), np.intp, "F")
    at = np.arange(len(costs))
    for place in reversed(range(len(columns))):
        before, option = steps[place]
        picks[:, place], at = option[at], before[at]
    return picks


def one_each(columns: Columns) -> Picks:
    """The cheapest combination, and every one that departs from it in one column."""
    picks = [np.zeros((1, len(columns)), np.intp)]
    for place, column in enumerate(columns):
        some = np.zeros((len(column.options) - 1, len(columns)), np.intp)
        some[:, place] = np.arange(1, len(column.options))
        picks.append(some)
    return np.concatenate(picks)


def _number(text: str) -> float:
    try:
        return double(text)
    except ValueError:
        return float("nan")


def _believing(columns: Columns, picks: Picks) -> Floats:
    """What the options themselves cost."""
    costs: Floats = np.zeros(len(picks))
    for column, pick in zip(columns, picks.T, strict=True):
        costs += column.costs[pick]
    return costs


def _values(columns: Columns, picks: Picks) -> dict[str, Floats]:
    """The values of combinations as columns of doubles; of MU the printed one."""
    return {
        name: numbers[pick]
        for column, pick in zip(columns, picks.T, strict=True)
        for name, numbers in column.numbers.items()
    }


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
