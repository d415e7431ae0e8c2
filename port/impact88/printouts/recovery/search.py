"""Searching for the scene a page comes from: texts for each input, tried by what they print.

Text and pictures are searched alike: whoever read the page gives its `Evidence`, the texts that
each printed result may be, and a `Column` of texts for each input, all with their costs.

Each input has a few texts that the page may show, with what each costs to believe. A scene's cost
is that of its inputs plus a penalty per printed result that differs. The combinations whose inputs
and kinetic energy cost least are tried first, two, then thousands; where there are more than may be
replayed in the Apple's own arithmetic, those are that cost least in double precision.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf
from operator import attrgetter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...decimals import negated as opposite
from ...decimals import to_double as double
from ...mechanics.solve import evaluate, solve
from ...names import PIVOT, VELOCITIES
from ..fields import ANGLES, FIELDS, FINAL_SPINS, INPUTS, scene_name
from . import replays
from .typedtext import mu_turned, texts_that_print

Floats = NDArray[np.float64]
Picks = NDArray[np.intp]
"""Combinations, one per row: the index of the option taken in every column."""

MISMATCH = 3.0
"""Penalty of a legible printed result that the program does not print."""
AGREES = 1.5
"""A result with a smaller penalty counts as explained."""
UNREAD = 0.6
"""Penalty of a result that is hardly legible, or that the page lacks."""
_UNSEEN_ZEROS = 0.02
"""Penalty, times the rank of the text, of a number typed with zeros that do not print."""
MAX_REPLAYED = 160  # combinations replayed in the Apple's arithmetic at a time
COUNTS = (2, 2_000, 60_000)
"""Combinations tried, each more only where another might still explain the page better."""
KINETIC = frozenset(("MA", "MB", "IA", "IB", "UX", "UY", "WA", "VX", "VY", "WB"))
"""The inputs that enter the kinetic energy."""
SCREENING_RTOL = 4e-7
"""Relative error allowed to the Apple's arithmetic in screening."""


@dataclass
class Column:
    """Candidate texts of one input, or of the row of angles: the field names, and for each option
    its texts and prior penalty, smallest penalty first. The texts are printed ones, or with
    ``typed`` those that were typed."""

    names: tuple[str, ...]
    options: list[tuple[tuple[str, ...], float]]
    typed: bool = False

    @cached_property
    def costs(self) -> Floats:
        """Prior penalty of each option."""
        return np.array([cost for _, cost in self.options])

    @cached_property
    def numbers(self) -> dict[str, Floats]:
        """The options as doubles, by the scene's names."""
        return {
            scene_name(name): np.array([_number(texts[at]) for texts, _ in self.options])
            for at, name in enumerate(self.names)
        }


def column_of(name: str, options: Iterable[tuple[str, float]], typed: bool = False) -> Column:
    """Return the column of one input: ``options`` are its texts with their prior penalties."""
    return Column((name,), [((text,), cost) for text, cost in options], typed)


Columns = Sequence[Column]


class Scored(NamedTuple):
    """A replayed scene: its cost, the texts typed, the texts assumed printed (by field), what it
    prints, and the names of the fields on which the page says otherwise."""

    cost: float
    scene: dict[str, str]
    assumed: dict[str, str]
    outcome: replays.Outcome
    wrong: frozenset[str]


class Expected(NamedTuple):
    """A printed result as read: its possible texts with their penalties, and the penalty of any
    other text (``default``)."""

    name: str
    texts: dict[str, float]
    default: float

    def mismatch(self, values: Floats) -> Floats:
        """Return the penalty of each value, as computed before the program floors it: that of the
        cheapest text it may be printed as."""
        places = FIELDS[self.name].places
        unit = 0.0 if places is None else 10.0**-places
        numbers = np.array([_number(text) for text in self.texts])
        slack = SCREENING_RTOL * np.abs(numbers) + max(0.05 * unit, 1e-9)
        first, end = numbers - slack, numbers + unit + slack
        edges = np.sort(np.concatenate([first, end]))
        fits = (first <= edges[:, None]) & (edges[:, None] < end)
        prices = np.where(fits, [*self.texts.values()], inf).min(axis=1, initial=self.default)
        prices = np.append(prices, self.default)  # of what is below the first edge
        found: Floats = prices[np.searchsorted(edges, values, side="right") - 1]
        return found


@dataclass(frozen=True)
class Evidence:
    """A page as evidence of a scene, read from a text or from a picture.

    Attributes
    ----------
    results : sequence of Expected
        The printed results that were found.
    inputs : set of str
        Fields of the inputs that were found.
    typed : mapping of str to mapping of str to str
        By field, the text typed for a printed text, where the page or a scene file says so.
    ending : str, optional
        The message that ended the run.
    has_final_spins : bool
        True if the line of the final WA and WB was found, read or not: then M = N.
    """

    results: Sequence[Expected]
    inputs: Collection[str]
    typed: Mapping[str, Mapping[str, str]]
    ending: str | None = None
    has_final_spins: bool = False


_cost = attrgetter("cost")


class Search:
    """Search for the scene of one page."""

    def __init__(self, evidence: Evidence) -> None:
        self.evidence = evidence
        self.expected = evidence.results
        self._found = {result.name for result in evidence.results} | {*INPUTS}

    def best(self, columns: Columns) -> Scored:
        """Return the scene of least cost among combinations of the columns' options."""
        best = self.nearest(columns)[0][1]
        return self._other_spellings(best) if best.wrong else best

    def nearest(
        self, columns: Columns, limit: float = inf, most: int = MAX_REPLAYED
    ) -> list[tuple[list[int], Scored]]:
        """Return the scenes of least cost among combinations of the columns' options, the least
        first, each with its combination.

        Combinations are taken in the order of what they cost by their inputs and the energy, more
        and more of them. The search ends when no other can cost less than a scene that was
        replayed, and after the last of `COUNTS`. ``limit``: largest cost of that kind;
        ``most``: number of scenes that are replayed at a time.
        """
        scores: list[tuple[list[int], Scored]] = []
        for count in COUNTS:
            picks, costs = self.cheapest(columns, count, limit)
            picks = self.screen(columns, picks, most)
            scored = zip(picks.tolist(), self.replay(columns, picks), strict=True)
            scores = sorted(scored, key=lambda pair: pair[1].cost)
            if len(costs) < count or costs[-1] >= scores[0][1].cost:
                break
        return scores

    def cheapest(self, columns: Columns, count: int, limit: float = inf) -> tuple[Picks, Floats]:
        """Return the ``count`` combinations that cost least by their inputs and the kinetic energy
        (line 320), into which ten of them enter; and these costs, smallest first, none above
        ``limit``."""
        kinetic = [at for at, column in enumerate(columns) if not KINETIC.isdisjoint(column.names)]
        others = [at for at in range(len(columns)) if at not in kinetic]
        moving = [columns[at] for at in kinetic]
        some, costs = combinations([column.costs for column in moving], count, limit)
        for expected in self.expected:
            if expected.name == "KI":
                costs = costs + expected.mismatch(kinetic_energy(_values(moving, some)))
        order = np.argsort(costs, kind="stable")
        rest = [columns[at].costs for at in others]
        joined, costs = combinations([costs[order], *rest], count, limit)
        picks = np.empty((len(costs), len(columns)), np.intp, "F")
        picks[:, kinetic] = some[order[joined[:, 0]]]
        picks[:, others] = joined[:, 1:]
        return picks, costs

    def screen(self, columns: Columns, picks: Picks, most: int) -> Picks:
        """Return the ``most`` combinations of least cost in double precision, if there are more."""
        if len(picks) <= most:
            return picks
        value = _values(columns, picks)
        value["MU"] = self._typed_mu(value)
        costs = _prior_penalty(columns, picks)
        results = printed_in_doubles(value, [result.name for result in self.expected])
        for result in self.expected:
            cost = result.mismatch(results[result.name])
            spun = result.name not in FINAL_SPINS or value["M"] == 6
            costs = costs + np.where(spun, cost, MISMATCH)
        return picks[np.argsort(costs, kind="stable")[:most]]

    def replay(self, columns: Columns, picks: Picks) -> list[Scored]:
        """Replay combinations in the Apple's arithmetic; return their scores in the same order."""
        value = _values(columns, picks)
        mu_signs = self._typed_mu(value) != value["MU"]
        scenes: list[tuple[dict[str, str], dict[str, str], float]] = []
        for pick, turn in zip(picks.tolist(), mu_signs.tolist(), strict=True):
            scene: dict[str, str] = {}
            assumed: dict[str, str] = {}
            cost = 0.0
            for column, index in zip(columns, pick, strict=True):
                texts, price = column.options[index]
                cost += price
                for name, text in zip(column.names, texts, strict=True):
                    scene[scene_name(name)] = text
                    if not column.typed:
                        reply = self.evidence.typed.get(name, {}).get(text)
                        shortest = next(iter(texts_that_print(text, name in ANGLES)), text)
                        scene[scene_name(name)] = reply or shortest
                        if name in self.evidence.inputs:
                            assumed[name] = text
            if turn:
                scene["MU"] = opposite(scene["MU"])
            scenes.append((scene, assumed, cost))
        scores = [*self._score(scenes)]
        # where double precision does not tell which way the contact slides
        for row, (scene, assumed, cost) in enumerate(scenes):
            if "MUP" in scores[row].wrong:
                turned = [({**scene, "MU": opposite(scene["MU"])}, assumed, cost)]
                scores[row] = min(scores[row], *self._score(turned), key=_cost)
        return scores

    def _typed_mu(self, value: Mapping[str, Floats]) -> Floats:
        """Return the MU that was typed, given the printed one: undo the sign change of line 400,
        where it made one."""
        mu = value["MU"]
        if "MUP" not in self.evidence.inputs:
            return mu
        sliding = evaluate({"E": 0.0, "EM": 0.0, **value}, ("gt",))[0]["gt"]
        typed: Floats = np.where((sliding > 0.0) & (mu != PIVOT), -mu, mu)
        return typed

    def _other_spellings(self, best: Scored) -> Scored:
        """Return the best scene over other spellings of the same printed inputs: typed zeros that
        do not print may change a value's last bit (see `typedtext`)."""
        columns = []
        for name, typed in best.scene.items():
            printed = best.assumed.get("MUP" if name == "MU" else name, "")
            texts = texts_that_print(printed, name in ANGLES)
            if name == "MU" and texts and mu_turned(typed, printed):
                texts = tuple(map(opposite, texts))
            ranks = enumerate(dict.fromkeys((typed, *texts)))
            columns.append(column_of(name, [(text, _UNSEEN_ZEROS * rank) for rank, text in ranks]))
        picks, prices = combinations([column.costs for column in columns], MAX_REPLAYED)
        extra = best.cost - self.replayed_scene(best.scene, best.assumed).cost
        scenes = []
        for pick, cost in zip(picks.tolist(), prices.tolist(), strict=True):
            taken = zip(columns, pick, strict=True)
            scene = {column.names[0]: column.options[index][0][0] for column, index in taken}
            scenes.append((scene, best.assumed, extra + cost))
        return min([best, *self._score(scenes)], key=_cost)

    def replayed_scene(self, scene: dict[str, str], assumed: dict[str, str]) -> Scored:
        """Replay one scene; the prior penalty of its inputs is not counted."""
        return next(self._score([(scene, assumed, 0.0)]))

    def _score(
        self, scenes: Sequence[tuple[dict[str, str], dict[str, str], float]]
    ) -> Iterator[Scored]:
        """Replay scenes, each given with the texts assumed printed and its prior penalty, and yield
        their scores."""
        outcomes = replays.run_all([scene for scene, _, _ in scenes])
        for (scene, assumed, cost), outcome in zip(scenes, outcomes, strict=True):
            costs = dict.fromkeys((result.name for result in self.expected), MISMATCH)
            for result in self.expected:
                if text := outcome.fields.get(result.name):
                    costs[result.name] = result.texts.get(text, result.default)
            wrong = {
                name for name, text in assumed.items() if outcome.fields.get(name, text) != text
            }
            if self.evidence.ending is not None and self.evidence.ending != outcome.ending:
                wrong.add("ENDING")
            if self.evidence.has_final_spins and scene["M"] != "6":
                wrong.add("M")
            costs.update(dict.fromkeys(wrong, MISMATCH))
            absent = set(outcome.fields) - self._found
            total = cost + sum(costs.values()) + UNREAD * len(absent)
            differing = frozenset(name for name, price in costs.items() if price >= AGREES)
            yield Scored(total, scene, assumed, outcome, differing)


def combinations(columns: Sequence[Floats], count: int, limit: float = inf) -> tuple[Picks, Floats]:
    """Return the ``count`` combinations of least cost, and their costs, smallest first, none above
    ``limit``. ``columns``: the costs of each column's options, smallest first. Columns are joined
    one at a time, keeping the best ``count`` at each step."""
    steps = []
    costs: Floats = np.zeros(1)
    for options in columns:
        # both are sorted: with option j none but the first count / (j + 1) are among the cheapest
        counts = np.minimum(
            count // np.arange(1, len(options) + 1),
            np.searchsorted(costs, limit - options, side="right"),
        )
        before = np.concatenate([np.arange(count) for count in counts])
        option = np.repeat(np.arange(len(counts)), counts)
        every = costs[before] + options[option]
        enough = np.partition(every, count - 1)[count - 1] if len(every) > count else inf
        kept = np.flatnonzero(every <= enough)  # of equal ones those of the first columns
        order = kept[np.argsort(every[kept], kind="stable")][:count]
        costs = every[order]
        steps.append((before[order], option[order]))
    picks = np.empty((len(costs), len(columns)), np.intp, "F")
    at = np.arange(len(costs))
    for place in reversed(range(len(columns))):
        before, option = steps[place]
        picks[:, place], at = option[at], before[at]
    return picks, costs


def _number(text: str) -> float:
    try:
        return double(text)
    except ValueError:
        return float("nan")


def _prior_penalty(columns: Columns, picks: Picks) -> Floats:
    """Return the prior penalty of each combination, the sum over its options."""
    costs: Floats = np.zeros(len(picks))
    for column, pick in zip(columns, picks.T, strict=True):
        costs += column.costs[pick]
    return costs


def _values(columns: Columns, picks: Picks) -> dict[str, Floats]:
    """Return the inputs of combinations as columns of doubles, by name; MU as printed."""
    return {
        name: numbers[pick]
        for column, pick in zip(columns, picks.T, strict=True)
        for name, numbers in column.numbers.items()
    }


def kinetic_energy(value: Mapping[str, Floats]) -> Floats:
    """Return the kinetic energy (line 320) in double precision."""
    with np.errstate(all="ignore"):
        ax, ay, wa, bx, by, wb = (value[name] for name in VELOCITIES)
        moving = value["MA"] * (ax * ax + ay * ay) + value["MB"] * (bx * bx + by * by)
        energy: Floats = 0.5 * (moving + value["IA"] * (wa * wa) + value["IB"] * (wb * wb))
    return energy


def printed_in_doubles(value: Mapping[str, Floats], names: Sequence[str]) -> dict[str, Floats]:
    """Return the results that the program prints, in double precision, before it floors them.

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
