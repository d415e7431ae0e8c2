"""Solving for inputs that were lost or misread from the results that were read.

A printout says the same thing several times over: fifteen results hang on twenty inputs, most of
which were read. So a few inputs at a time are taken as unknown, all single ones, pairs and triples
and those nothing was read of, and found by least squares in double precision. Results that were
misread themselves are told by leaving all others in agreement, and lose their weight. What comes
out is rounded to numbers that people type, and replayed in the Apple's own arithmetic. Nothing here
is a verdict: `judging` says what a scene that was found so explains.
"""

from __future__ import annotations

from bisect import insort
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, product
from math import prod
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..doubles import double
from ..fields import ANGLES, FIELDS, INPUTS
from ..reading.anglerow import cut_as
from ..reading.numerals import Habit, compare
from ..reading.printout import Printout, Reading
from .choices import printed_ways, reply_ways, scene_name, without
from .misprints import opposite
from .search import AGREES, MISMATCH, Scored, Search, in_doubles, mismatch
from .typedtext import stored_and_printed

Floats = NDArray[np.float64]

UNKNOWN = tuple(map(scene_name, INPUTS))
"""What may be solved for, by scene name."""
_AT_ONCE = 3
"""Inputs taken as unknown at a time, those that are missing apart; one fewer with other angles."""
_MOST_MISSING = 3
_STEPS, _LAST_STEPS = 9, 4
_COARSE = 1e-3
"""Relative error a result is allowed while the solution is still far off."""
_KEPT, _REPLAYED = 60, 80
_DECIMALS = range(5)
_COMBINED = 128
"""Roundings of all unknowns of a solution that are tried."""
_FULL_TURN, _TURNED = 360.0, 2.0
"""Beyond it nobody types an angle, and what it costs to believe that somebody did."""
_UNREAD, _MOST_COST = 0.6, 2 * MISMATCH
"""What an input costs of which nothing was read, by the digit: of two that explain the page the
shorter was typed; and what an input may cost at most."""
_TURNS = 12
_ROWS = 4
"""Ways to cut the row of angles that are taken for a start."""
_STARTS: dict[str, tuple[float, ...]] = {
    **dict.fromkeys(("MA", "MB"), (100.0,)),
    **dict.fromkeys(("IA", "IB"), (2500.0,)),
    **dict.fromkeys(("DA", "DB"), (4.0,)),
    **dict.fromkeys(ANGLES, (3.0, 93.0, -87.0, 177.0)),
    **dict.fromkeys(("UX", "UY", "VX", "VY"), (0.0, 30.0, -30.0)),
    **dict.fromkeys(("WA", "WB"), (0.0,)),
    "E": (0.1,),
    "MU": (0.4, -0.4),
    "EM": (-0.4,),
}
"""Where an input that nothing tells of is looked for first: values of cars like the chapter's."""
_STEP_LIMIT = {**dict.fromkeys(ANGLES, 40.0), **dict.fromkeys(("E", "MU", "EM"), 0.7)}


class _Target(NamedTuple):
    """A printed result: its value, half its last place above the printed digits, and that place."""

    name: str
    value: float
    unit: float


def scenes_found(
    shown: Printout, search: Search, scene: Mapping[str, str], missing: Sequence[str], most: int
) -> list[Scored]:
    """Scenes with a few inputs solved for, replayed: the ``most`` that explain most, those first.

    ``scene``: the scene as read, with anything for the ``missing`` inputs. What a scene costs is
    what its inputs cost as read on the paper plus what the results cost."""
    if len(missing) > _MOST_MISSING and not shown.angle_row:
        return []
    return _Inversion(shown, search).scenes(scene, missing, most)


class _Inversion:
    """The search for one printout."""

    def __init__(self, shown: Printout, search: Search) -> None:
        self._shown = shown
        self._search = search
        self._targets = list(_targets(search))
        self._names = [target.name for target in self._targets]
        self._values = np.array([target.value for target in self._targets])
        self._units = np.array([target.unit for target in self._targets])
        self._prices: dict[tuple[str, str], float] = {}

    def scenes(self, scene: Mapping[str, str], missing: Sequence[str], most: int) -> list[Scored]:
        if len(self._targets) < 4:
            return []
        texts: list[dict[str, str]] = []
        for number, (base, unknown) in enumerate(self._bases(scene, missing)):
            at_once = _AT_ONCE if not number else _AT_ONCE - 1
            texts += self._typed(base, *self._solved(base, unknown, at_once))
        texts = list({tuple(sorted(one.items())): one for one in texts}.values())
        if not texts:
            return []
        costs = self._rough_costs(texts)
        best = np.argsort(costs, kind="stable")[:_REPLAYED]
        replayed = self._search.replayed_scenes([texts[index] for index in best.tolist()])
        return self._cheapest(replayed, most)

    def _cheapest(self, replayed: Sequence[Scored], most: int) -> list[Scored]:
        """The scenes of least `paper_cost`; the row is costed only where it may matter."""
        least = [_without_row(self._shown, self._search, one) for one in replayed]
        best: list[tuple[float, int]] = []
        for index in np.argsort(least, kind="stable").tolist():
            if len(best) >= most and least[index] >= best[most - 1][0]:
                break
            insort(best, (least[index] + _row_cost(self._shown, replayed[index]), index))
        return [replayed[index] for _, index in best[:most]]

    # --- where to begin ---

    def _bases(
        self, scene: Mapping[str, str], missing: Sequence[str]
    ) -> Iterator[tuple[dict[str, str], tuple[str, ...]]]:
        """Scenes to begin with, and what is unknown in each beside what may be misread."""
        rows = [dict(zip(ANGLES, row, strict=True)) for row, _ in self._shown.angles[:_ROWS]]
        lost = [name for name in missing if name not in ANGLES or not self._shown.angle_row]
        if len(lost) > _MOST_MISSING:
            return
        for row in rows or [{}]:
            for start in product(*(_STARTS[name] for name in lost)):
                values = dict(zip(lost, map(_typed, start), strict=True))
                yield {**scene, **row, **values}, tuple(lost)

    # --- least squares ---

    def _solved(
        self, base: Mapping[str, str], lost: tuple[str, ...], most: int
    ) -> tuple[list[tuple[str, ...]], Floats]:
        """The unknowns that explain the results best, and their values (a row each)."""
        others = [name for name in UNKNOWN if name not in lost]
        start = np.array([double(base[name]) for name in UNKNOWN])
        found: list[tuple[int, tuple[str, ...], Floats]] = []
        for count in range(most + 1):
            if not count and not lost:
                continue
            sets = [(*lost, *some) for some in combinations(others, count)]
            starts = [np.tile(start, (len(sets), 1))]
            starts += [_begun(start, sets, some) for some in range(_TURNS if count == 1 else 1)]
            values = self._least_squares(base, np.concatenate(starts), sets * len(starts))
            agree = self._agreeing(base, values)
            order = np.argsort(-agree, kind="stable")[: _KEPT // (1 + count)]
            for i in order.tolist():
                found.append((int(agree[i]) - 2 * count, sets[i % len(sets)], values[i]))
        found.sort(key=lambda one: -one[0])
        found = found[:_KEPT]
        return [names for _, names, _ in found], np.array([values for _, _, values in found])

    @np.errstate(all="ignore")  # a set that leads beyond doubles explains nothing
    def _least_squares(
        self, base: Mapping[str, str], start: Floats, sets: Sequence[tuple[str, ...]]
    ) -> Floats:
        """Gauss-Newton for every set of unknowns at once; ``start`` and the result hold all inputs
        in a row each."""
        count, width = len(sets), len(sets[0])
        where = np.array([[UNKNOWN.index(name) for name in names] for names in sets])
        values = start.copy()
        rows = np.arange(count)
        limits = np.array([_STEP_LIMIT.get(name, 0.0) for name in UNKNOWN])[where]
        coarse = np.maximum(self._units, _COARSE * np.maximum(1.0, abs(self._values)))
        fine = np.maximum(self._units, 2e-8 * abs(self._values))
        for step in range(_STEPS + _LAST_STEPS):
            late = step >= _STEPS
            scale = fine if late else coarse
            moved = np.repeat(values[None], width + 1, axis=0)
            steps = np.empty((width, count))
            for place in range(width):
                own = values[rows, where[:, place]]
                steps[place] = 1e-6 * np.maximum(1.0, abs(own))
                moved[place + 1, rows, where[:, place]] += steps[place]
            residuals = self._residuals(base, moved.reshape(-1, len(UNKNOWN)))
            residuals = residuals.reshape(width + 1, count, -1)
            error = residuals[0] / scale
            slopes = (residuals[1:] - residuals[0]) / steps[:, :, None] / scale
            slopes, error = np.nan_to_num(slopes), np.nan_to_num(error, nan=1e6)
            spread = 3.0 if late else np.maximum(1.0, np.median(abs(error), axis=1))[:, None]
            weight = 1 / (1 + (error / spread) ** 2)
            size = np.maximum(abs(values[rows[:, None], where]), 1.0)
            slopes = np.moveaxis(slopes, 0, 2) * size[:, None, :]
            weighted = slopes * weight[:, :, None]
            normal = np.einsum("nrj,nrk->njk", weighted, slopes)
            trace = np.einsum("njj->n", normal)[:, None, None]
            normal += (1e-9 * trace + 1e-12) * np.eye(width)
            normal[~np.isfinite(normal).all(axis=(1, 2))] = np.eye(width)
            right = np.einsum("nrj,nr->nj", weighted, error)
            change = -np.linalg.solve(normal, right[:, :, None])[:, :, 0] * size
            limit = np.where(limits > 0, limits, 0.8 * size + 5)
            values[rows[:, None], where] += np.clip(np.nan_to_num(change), -limit, limit)
        return values

    def _residuals(self, base: Mapping[str, str], values: Floats) -> Floats:
        """What each result exceeds its printed value by, for rows of inputs."""
        columns = {name: values[:, place] for place, name in enumerate(UNKNOWN)}
        columns["M"] = np.full(len(values), double(base["M"]))
        results = in_doubles(columns, self._names)
        return np.stack([results[name] for name in self._names], axis=1) - self._values

    @np.errstate(all="ignore")
    def _agreeing(self, base: Mapping[str, str], values: Floats) -> NDArray[np.intp]:
        """How many results agree."""
        slack = 0.75 * self._units + 4e-7 * abs(self._values)
        near = abs(self._residuals(base, values)) <= slack
        count: NDArray[np.intp] = near.sum(axis=1)
        return count

    # --- what people type ---

    def _typed(
        self, base: Mapping[str, str], sets: Sequence[tuple[str, ...]], values: Floats
    ) -> Iterator[dict[str, str]]:
        """The scenes with what was found rounded to fewer or more decimals."""
        for names, row in zip(sets, values, strict=True):
            options = []
            for name in names:
                value = float(row[UNKNOWN.index(name)])
                if name in ANGLES:
                    value = _within_a_turn(value, double(base[name]))
                options.append(_roundings(value) if abs(value) < 1e8 else [])
            for texts in _alike_decimals(options):
                yield {**base, **dict(zip(names, texts, strict=True))}

    @np.errstate(all="ignore")
    def _rough_costs(self, scenes: Sequence[Mapping[str, str]]) -> Floats:
        """What scenes cost, their results in double precision."""
        columns = {
            name: np.array([double(scene[name]) for scene in scenes]) for name in (*UNKNOWN, "M")
        }
        results = in_doubles(columns, [one.name for one in self._search.expected])
        costs: Floats = np.zeros(len(scenes))
        for one in self._search.expected:
            costs = costs + mismatch(one, results[one.name])
        row = bool(self._shown.angle_row)
        for name in INPUTS:
            if row and name in ANGLES:
                continue
            own = scene_name(name)
            costs += np.array([self._price(name, scene[own]) for scene in scenes])
        return costs

    def _price(self, name: str, text: str) -> float:
        """What it costs that an input is this, by what was read of it."""
        key = (name, text)
        if key not in self._prices:
            reading = self._shown.fields.get(name)
            seen = stored_and_printed(text, name in ANGLES)
            printed = seen[1] if seen else text
            price = _read_cost(reading, printed)
            if name == "MUP" and text.strip("-0."):
                price = min(price, _read_cost(reading, opposite(printed)))
            self._prices[key] = price
        return self._prices[key]


def paper_cost(shown: Printout, search: Search, scored: Scored) -> float:
    """What a replayed scene costs as the explanation of all that was read: inputs, replies and
    results alike, however the scene was come by. What its reader's habit made of a digit costs
    little where ``search`` knows of one."""
    return _without_row(shown, search, scored) + _row_cost(shown, scored)


def _row_cost(shown: Printout, scored: Scored) -> float:
    """What the row of angles costs, where blanks alone do not cut it."""
    if not _in_one_row(shown, scored):
        return 0.0
    row, texts = shown.angle_row, tuple(scored.outcome.fields[name] for name in ANGLES)
    pieces = zip(texts, cut_as(row, texts), strict=False)
    return sum(
        min(compare(row[start:stop], text).cost, _MOST_COST) for text, (start, stop) in pieces
    )


def _in_one_row(shown: Printout, scored: Scored) -> bool:
    """Whether the angles stand in a row that blanks alone do not cut."""
    return bool(shown.angle_row) and all(name in scored.outcome.fields for name in ANGLES)


def _without_row(shown: Printout, search: Search, scored: Scored) -> float:
    """What all the rest costs."""
    fields = scored.outcome.fields
    row = _in_one_row(shown, scored)
    cost = search.results_cost(scored)
    for name in INPUTS:
        reading = shown.fields.get(name)
        if name in fields and not (row and name in ANGLES):
            cost += _read_cost(reading, fields[name], search.habit)
    cost += sum(_TURNED for name in ANGLES if abs(double(scored.scene[name])) > _FULL_TURN)
    for name, reply in shown.replies.items():
        ways = reply_ways(reply)
        prices = [price for text, _, price in ways if double(text) == double(scored.scene[name])]
        cost += min(prices, default=MISMATCH)
    return cost


def _read_cost(reading: Reading | None, printed: str, habit: Habit | None = None) -> float:
    if reading is None:
        return _UNREAD * len(printed)
    match = compare(reading.region, printed, reading.cut, reading.sign_free, reading.closing)
    cost = min(match.cost, _MOST_COST)
    if habit:
        cost = min(cost, without(printed_ways(reading), habit).get(printed, cost))
    return cost


def _begun(start: Floats, sets: Sequence[tuple[str, ...]], turn: int) -> Floats:
    """Where else the unknowns of every set are looked for: what has a sign at its opposite, angles
    further round by so many turns of a dozen, what has none where it is usual."""
    values = np.tile(start, (len(sets), 1))
    for row, names in enumerate(sets):
        for name in names:
            place = UNKNOWN.index(name)
            usual = _STARTS[name][0]
            signed = name in ANGLES or min(_STARTS[name]) <= 0
            values[row, place] = -start[place] if signed else usual
            if name in ANGLES:
                values[row, place] += turn * 360 / _TURNS
    return values


def _targets(search: Search) -> Iterator[_Target]:
    """The results that were read, each at its likeliest."""
    for one in search.expected:
        if not one.texts or one.default < AGREES:
            continue
        text, cost = min(one.texts.items(), key=lambda way: way[1])
        if cost >= AGREES:
            continue
        value = float(text)
        places = FIELDS[one.name].places
        if places is None:
            unit = 10.0 ** (np.floor(np.log10(abs(value))) - 8) if value else 1e-9
            yield _Target(one.name, value, float(unit))
        else:
            yield _Target(one.name, value + 0.5 * 10.0**-places, 10.0**-places)


def _roundings(value: float) -> list[str]:
    """The numbers with few decimals nearest to a value, shortest first."""
    texts = [_typed(round(value, decimals)) for decimals in _DECIMALS]
    return list(dict.fromkeys(texts))


def _alike_decimals(options: Sequence[Sequence[str]]) -> Iterator[tuple[str, ...]]:
    """A text of each; of very many combinations those with as few decimals."""
    most = max(map(len, options), default=0)
    while most > 2 and prod(min(len(some), most) for some in options) > _COMBINED:
        most -= 1
    yield from product(*(some[:most] for some in options))


def _within_a_turn(angle: float, like: float) -> float:
    """An angle as people type it, from -180 to 180 degrees, or up to 360 where it was read so."""
    within = (angle + 180) % 360 - 180
    if 180 < abs(like) <= _FULL_TURN and within * like < 0:
        within += 360 if like > 0 else -360
    return within


def _typed(value: float) -> str:
    """A number as one types it."""
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    sign = "-" if text.startswith("-") and text.strip("-0.") else ""
    size = text.lstrip("-")
    return sign + (size[1:] if size.startswith("0.") and len(size) > 2 else size)
