"""Searching for the scene a page comes from: texts for each input, tried by what they print.

Text and pictures are searched alike: whoever read the page gives its `Evidence`, the texts that
each printed result may be, and a `Column` of texts for each input, all with their costs.

Each input has a few texts that the page may show, with what each costs to believe. Combinations are
screened in double precision (the kinetic energy first, which few inputs enter, then all results),
and the best of them are replayed in the Apple's own arithmetic. A scene's cost is the prior penalty
of its inputs plus a mismatch penalty per printed result.
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
from . import replays
from .typedtext import mu_turned, opposite, texts_that_print

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
MAX_REPLAYED = 160  # combinations replayed in the Apple's arithmetic
MAX_COMBINATIONS = 30_000
"""Combinations of the other inputs tried with the likeliest masses and velocities."""
MAX_RESCORED = 5_000
"""Combinations left by a first screening on four results, which is done from four times as many."""
KINETIC = frozenset(("MA", "MB", "IA", "IB", "UX", "UY", "WA", "VX", "VY", "WB"))
"""The inputs that enter the kinetic energy."""
KEY_RESULTS = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF", "XAF", "YAF", "XBF", "YBF", "LOSS")
_SPINS = (("IA", "WA"), ("IB", "WB"))
MAX_ENERGIES = 60
"""Combinations of masses and velocities that are tried with the other inputs."""
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
Names = Collection[str]


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
        costs: Floats = np.full(values.shape, self.default)
        places = FIELDS[self.name].places
        unit = 0.0 if places is None else 10.0**-places
        for text, cost in self.texts.items():
            number = _number(text)
            slack = SCREENING_RTOL * abs(number) + max(0.05 * unit, 1e-9)
            fits = (values >= number - slack) & (values < number + unit + slack)
            costs = np.where(fits, np.minimum(costs, cost), costs)
        return costs


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
        """Return the scene of least cost among combinations of the columns' options.

        The two most plausible combinations are replayed first; only if neither explains the page
        does the search by kinetic energy follow.
        """
        best = min(self.likeliest(columns), key=_cost)
        if best.wrong or best.cost >= 0.05:
            best = min([best, *self.nearest(columns)], key=_cost)
        return self._other_spellings(best) if best.wrong else best

    def likeliest(self, columns: Columns) -> list[Scored]:
        """Return the scenes of the two combinations of least prior penalty, whatever they print."""
        return self.replay(columns, combinations(columns, 2))

    def nearest(self, columns: Columns) -> list[Scored]:
        """Return the scenes of least cost among combinations of the columns' options, the least
        first."""
        scores = self.replay(columns, self.find_candidates(columns, MAX_COMBINATIONS))
        return sorted(scores, key=_cost)

    def find_candidates(
        self,
        columns: Columns,
        max_combinations: int,
        count: int = MAX_REPLAYED,
        max_penalty: float = inf,
        wrong: Names = (),
    ) -> Picks:
        """Return the combinations that are worth replaying, best first.

        All combinations of all options are too many. The kinetic energy (line 320) depends on ten
        inputs only, so combinations of these are ranked by how well they explain the printed energy
        and the best ``MAX_ENERGIES`` are kept. Each is completed with the most plausible
        combinations of the other inputs: ``max_combinations`` for the first, a fourth of that for
        the second, a ninth for the third, two at least. `screen` then picks ``count`` of them by
        all results in double precision.

        ``max_penalty`` bounds the prior penalty of all inputs plus the energy's mismatch.
        ``wrong`` names results that the best scene so far does not explain: they are screened
        first.
        """
        kinetic = self._kinetic_columns(columns)
        others = [place for place in range(len(columns)) if place not in kinetic]
        picks, penalties = self._rank_energies(columns, kinetic, max_combinations, max_penalty)
        rest_columns = [columns[place] for place in others]
        rest_limit = max_penalty - penalties.min()
        rest = combinations(rest_columns, max_combinations, rest_limit)
        rest_penalties = _prior_penalty(rest_columns, rest)
        parts = []
        for rank, (pick, penalty) in enumerate(zip(picks, penalties, strict=True), 1):
            affordable = int(np.searchsorted(rest_penalties, max_penalty - penalty, side="right"))
            # 1 / rank^2 sums to 1.6 at most, so that the total stays near ``max_combinations``
            size = min(affordable, max(2, max_combinations // rank**2))
            part = np.zeros((size, len(columns)), np.intp, "F")
            part[:] = pick
            part[:, others] = rest[:size]
            parts.append(part)
        return self.screen(columns, np.concatenate(parts), count, wrong)

    def _kinetic_columns(self, columns: Columns) -> list[int]:
        """Return the places of the columns that enter the kinetic energy. The inertia of a vehicle
        that does not spin does not."""
        first = dict(
            pair
            for column in columns
            for pair in zip(column.names, column.options[0][0], strict=True)
        )
        moving = KINETIC - {inertia for inertia, spin in _SPINS if not _number(first[spin])}
        return [place for place, column in enumerate(columns) if moving & set(column.names)]

    def _rank_energies(
        self, columns: Columns, kinetic: Sequence[int], max_combinations: int, max_penalty: float
    ) -> tuple[Picks, Floats]:
        """Return combinations of the columns at ``kinetic``, the first option elsewhere, in the
        order of how well they explain the printed energy, and the penalty of each, its mismatch
        included. The most plausible combination stays first, in case the energy itself was
        misread."""
        some = combinations([columns[place] for place in kinetic], max_combinations, max_penalty)
        picks = np.zeros((len(some), len(columns)), np.intp, "F")
        picks[:, kinetic] = some
        mismatches = np.zeros(len(picks))
        for expected in self.expected:
            if expected.name == "KI":
                mismatches = expected.mismatch(kinetic_energy(_values(columns, picks)))
        # `combinations` puts the most plausible one first; -1, below every penalty, keeps it there
        keys = np.append(-1.0, mismatches[1:])
        order = np.argsort(keys, kind="stable")[:MAX_ENERGIES]
        return picks[order], (_prior_penalty(columns, picks) + mismatches)[order]

    def screen(self, columns: Columns, picks: Picks, count: int, wrong: Names = ()) -> Picks:
        """Return the ``count`` combinations of least cost in double precision.

        There are two passes: more than 4 `MAX_RESCORED` combinations are first reduced to
        `MAX_RESCORED` by four results only, those in ``wrong`` before others; the rest are then
        ranked by all results. ``count`` combinations or fewer are returned as they are."""
        key_names = sorted(KEY_RESULTS, key=lambda name: name not in wrong)[:4]
        key_results = [
            result
            for result in self.expected
            if result.default == MISMATCH and result.name in key_names
        ]
        rounds = (
            (MAX_RESCORED, 4 * MAX_RESCORED, key_results),
            (count, count, self.expected),
        )
        for size, threshold, expected in rounds:
            if len(picks) > threshold:
                value = _values(columns, picks)
                value["MU"] = self._typed_mu(value)
                costs = _prior_penalty(columns, picks)
                results = in_doubles(value, [result.name for result in expected])
                for result in expected:
                    cost = result.mismatch(results[result.name])
                    spun = result.name not in FINAL_SPINS or value["M"] == 6
                    costs = costs + np.where(spun, cost, MISMATCH)
                picks = picks[np.argsort(costs, kind="stable")[:size]]
        return picks

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
        return np.where(in_doubles(value, ["MUP"])["MUP"] == -mu, -mu, mu)

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
        picks = combinations(columns, MAX_RESCORED)
        extra = best.cost - self.replayed_scene(best.scene, best.assumed).cost
        scenes = []
        for pick, cost in zip(picks.tolist(), _prior_penalty(columns, picks), strict=True):
            taken = zip(columns, pick, strict=True)
            scene = {column.names[0]: column.options[index][0][0] for column, index in taken}
            scenes.append((scene, best.assumed, extra + float(cost)))
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


def combinations(columns: Columns, count: int, max_penalty: float = inf) -> Picks:
    """Return the ``count`` combinations of least prior penalty, smallest first, none of more than
    ``max_penalty``. Columns are joined one at a time, keeping the best ``count`` at each step."""
    steps = []
    costs: Floats = np.zeros(1)
    for column in columns:
        options = column.costs
        # both are sorted: with option j none but the first count / (j + 1) are among the cheapest
        counts = np.minimum(
            count // np.arange(1, len(options) + 1),
            np.searchsorted(costs, max_penalty - options, side="right"),
        )
        before = np.concatenate([np.arange(count) for count in counts])
        option = np.repeat(np.arange(len(counts)), counts)
        every = costs[before] + options[option]
        if len(every) > count:
            order = np.argpartition(every, count - 1)[:count]
            order = order[np.argsort(every[order], kind="stable")]
        else:
            order = np.argsort(every, kind="stable")
        costs = every[order]
        steps.append((before[order], option[order]))
    picks = np.empty((len(costs), len(columns)), np.intp, "F")
    at = np.arange(len(costs))
    for place in reversed(range(len(columns))):
        before, option = steps[place]
        picks[:, place], at = option[at], before[at]
    return picks


def one_each(columns: Columns) -> Picks:
    """Return the cheapest combination, and each that departs from it in one column."""
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
        energy: Floats = closed_form.kinetic_energy(
            [value[name] for name in ("MA", "MB", "IA", "IB")], [value[n] for n in VELOCITIES]
        )
    return energy


def in_doubles(value: Mapping[str, Floats], names: Sequence[str]) -> dict[str, Floats]:
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
