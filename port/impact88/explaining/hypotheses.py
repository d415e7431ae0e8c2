"""Named causes (``hypotheses.txt``): pages whose inputs or results stand there otherwise.

Each row means a scene that was computed with, or results that are shown otherwise. All are ranked
in double precision, the nearest replayed. A number shown in another unit was rounded there, so that
it may have been computed with several; they are searched for the nearest rows.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import combinations, islice
from math import isfinite
from typing import Any, NamedTuple

import numpy as np

from ..doubles import double, doubles_of
from ..equations.edits import assigned, written_out
from ..equations.evaluation import value
from ..equations.spelling import NEGATIVE, Expression
from ..fields import FIELDS, INPUTS, scene_name
from ..files import packaged_text
from ..names import PIVOT
from ..reading import numerals
from ..recovery import replays
from ..recovery.search import Column, in_doubles
from ..recovery.slips import Change
from ..recovery.typedtext import with_opposite_mu
from .predictions import Cause, Evidence, Range, around, as_printed, digits_of

_REPLAYED = 40
"""Rows that are replayed, the nearest of some 700."""
_NEAR = 0.03
"""How far a unit may be off on average to be searched: 88 for 88.4 is off by 0.005."""
_ANY_TWO = 20.0
"""Bits of any two numbers exchanged: then no slip is looked for besides."""
_SEARCHED, _LAST = 3, 24
"""Units that are searched, and combinations of each that are replayed."""
_CANDIDATES, _COMBINATIONS = 40, 60_000
"""Numbers that may have been computed with: of one input, and of all together."""
_FACTOR = 1e-6
"""Relative error of a factor that is known to seven digits."""


class Row(NamedTuple):
    """A line of the table."""

    kind: str
    note: str
    bits: float
    inputs: Mapping[str, Expression]
    results: Mapping[str, Expression]


class Hypothesis(NamedTuple):
    """A row, the scene it means for a page, the printed inputs it puts right, the texts it takes
    to have been printed in their place, and how far what was typed may be from what the scene
    has."""

    row: Row
    scene: dict[str, str]
    changes: tuple[Change, ...]
    assumed: Mapping[str, str]
    within: Mapping[str, float]


@cache
def table() -> tuple[Row, ...]:
    """All rows, each cause once."""
    lines = []
    for line in packaged_text(__package__ or "", "hypotheses.txt").splitlines():
        if line.startswith("#") or not line.strip():
            continue
        if "{one}" in line:
            of_results = ";;" in line
            names = [n for n in FIELDS if n not in INPUTS] if of_results else list(INPUTS)
            for one, two in combinations(map(scene_name, names), 2):
                lines.append(line.replace("{one}", one).replace("{two}", two))
        else:
            lines.append(line)
    rows: dict[str, Row] = {}
    for line in written_out(lines):
        kind, note, bits, edits = (part.strip() for part in line.split("|"))
        inputs, _, results = edits.partition(";;")
        row = Row(kind, note, float(bits), dict(assigned(inputs)), dict(assigned(results)))
        rows.setdefault(edits, row)
    return tuple(rows.values())


class Tables:
    """The rows as one page has them. ``nearest``: those to be replayed."""

    def __init__(self, evidence: Evidence) -> None:
        self._evidence = evidence
        self._scene, self._printed = evidence.recovered.scene, evidence.recovered.assumed
        self._values = doubles_of({name: text or "0" for name, text in self._scene.items()})
        every = [one for row in table() if row.inputs for one in self._either_sign(row)]
        far = self._far(every)
        # double precision does not follow line 510 where MU is past the pivot's -10
        past = abs(self._values["MU"]) >= -PIVOT != -self._values["MU"]
        order = np.lexsort(np.array([[one.row.bits for one in every], far]))
        order = order[: len(every) if past else _REPLAYED]
        scenes = self._scene, *with_opposite_mu(self._scene)
        results = [row for row in table() if not row.inputs]
        self.nearest = [every[index] for index in order]
        self.nearest += [Hypothesis(row, one, (), {}, {}) for row in results for one in scenes]
        self._close = [every[index] for index in order if far[index] <= _NEAR]

    def exchanges(self) -> Iterator[Hypothesis]:
        """The inputs in each other's place that are printed on the page."""
        for row in table():
            names = all(isinstance(made, str) for made in row.inputs.values())
            if row.inputs and names and row.bits < _ANY_TWO:
                made = self._made(row)
                if made and {change.field for change in made.changes} <= set(self._printed):
                    yield made

    def _either_sign(self, row: Row) -> Iterator[Hypothesis]:
        made = [self._made(row)]
        if made[0] and made[0].within:
            made.append(self._made(row, in_full=True))
        for one in filter(None, made):
            yield one
            for scene in with_opposite_mu(one.scene):
                yield one._replace(scene=scene)

    def _made(self, row: Row, in_full: bool = False) -> Hypothesis | None:
        """A row's scene; numbers converted are the shortest that round so, or ``in_full``."""
        typed: dict[str, str] = {}
        assumed = dict(self._printed)
        within: dict[str, float] = {}
        most = max(_decimals(self._scene[name]) for name in row.inputs)
        for name, made in row.inputs.items():
            if isinstance(made, str) and made != "x":
                typed[name] = self._scene[made]
                if (other := _field(made)) in self._printed:
                    assumed[_field(name)] = self._printed[other]
                continue
            x, own = self._values[name], self._scene[name]
            found = self._value(made, x)
            if not isfinite(found):
                return None
            slack = 0.0
            if x and isinstance(made, tuple) and made[0] not in ("+", "-", NEGATIVE):
                # a conversion; all were rounded to as many decimals, but what fills nine digits
                half = 0.5 * 10.0 ** -(_decimals(own) if digits_of(own) >= 9 else most)
                ends = self._value(made, x - half), self._value(made, x + half)
                slack = within[name] = abs(ends[1] - ends[0]) / 2
            typed[name] = _shortest(found, 0.0 if in_full else slack)
        changes = []
        for name in INPUTS:
            own, text = self._scene[scene_name(name)], typed.get(scene_name(name))
            if text and text != own:
                printed = self._printed.get(name, own)
                right = assumed.get(name, printed)
                if right == self._printed.get(name, right):
                    right = numerals.as_printed(text) or text
                changes.append(Change(row.kind, name, printed, right))
        if not changes and typed.get("M", self._scene["M"]) == self._scene["M"]:
            return None
        return Hypothesis(row, {**self._scene, **typed}, tuple(changes), assumed, within)

    def _value(self, made: Expression, x: float) -> float:
        """An expression of a row, ``x`` being the column itself."""
        return float(value(made, {**self._values, "x": x}))

    def _far(self, every: Sequence[Hypothesis]) -> Any:
        """How far off the results are, relatively and on average, by double precision."""
        columns = {
            name: np.array([double(one.scene[name] or "0") for one in every])
            for name in self._scene
        }
        found = in_doubles(columns, self._evidence.named(FIELDS))
        for index, one in enumerate(every):
            names = {name: found[name][index] for name in found if one.row.results}
            for name, made in one.row.results.items():
                if name in names:
                    found[name][index] = value(made, {**names, "x": names[name]})
        return self._evidence.far(found, len(every))

    # --- a unit's rounding undone ---

    def searched(self) -> Iterator[Hypothesis]:
        """The units that nearly explain the page, with the numbers that explain it best."""
        units: dict[tuple[str, str], Hypothesis] = {}
        for one in self._close if self._scene["M"] == "6" else ():
            if one.within and not one.row.results:
                units.setdefault((one.row.note, " ".join(one.row.inputs)), one)
        search = self._evidence.recovered.search
        for unit in islice(units.values(), _SEARCHED):
            columns = list(self._columns(unit))
            picks = search.promising(columns, _COMBINATIONS, _LAST)
            best = min(search.replayed(columns, picks), key=lambda one: one.cost).scene
            changes = tuple(
                change._replace(would_be=numerals.as_printed(text) or text)
                for change in unit.changes
                if (text := best[scene_name(change.field)])
            )
            yield unit._replace(changes=changes, scene=best, within={})

    def _columns(self, unit: Hypothesis) -> Iterator[Column]:
        """For the converted inputs every number that may have been computed with."""
        most = min(_CANDIDATES, int(_COMBINATIONS ** (1 / len(unit.within))))
        for name in INPUTS:
            own = scene_name(name)
            same = unit.scene[own] == self._scene[own] and name in self._printed
            texts = [self._printed[name] if same else unit.scene[own]]
            if own in unit.within:
                exact = self._value(unit.row.inputs[own], self._values[own])
                texts = _near(exact, unit.within[own], most)
            yield Column((name,), [((text,), 0.0) for text in texts], not same)
        yield Column(("M",), [((unit.scene["M"],), 0.0)], True)


def unexplained(evidence: Evidence, every: Sequence[Hypothesis]) -> Iterator[Cause]:
    """Each replayed, with what it leaves unexplained."""
    keys = [tuple(one.scene.values()) for one in every]
    scenes = dict(zip(keys, (one.scene for one in every), strict=True))
    outcomes = dict(zip(scenes, replays.run_all(list(scenes.values())), strict=True))
    values = cache(lambda key: replays.run_whole(scenes[key])[1])
    for one, key in zip(every, keys, strict=True):
        outcome = outcomes[key]
        row, changes, fields = one.row, list(one.changes), outcome.fields
        predicted = as_printed(outcome)
        if row.results:
            predicted |= _shown_otherwise(evidence, row, outcome, values(key))
        for name, made in row.results.items():
            other = fields.get(made) if isinstance(made, str) else None
            if other and name in fields and other != fields[name]:
                changes.append(Change(row.kind, name, other, fields[name]))
        turned = any(change.field == "MUP" for change in changes)
        inputs = {} if turned or "MUP" not in fields else {"MUP": fields["MUP"]}
        wrong = evidence.differing(predicted, outcome.ending, inputs)
        yield Cause(row.kind, row.note, row.bits, one.scene, wrong, tuple(changes))


def _shown_otherwise(
    evidence: Evidence, row: Row, outcome: replays.Outcome, values: Mapping[str, float]
) -> dict[str, Range]:
    """The results that a row shows otherwise: another number's, or to the page's decimals."""
    ranges: dict[str, Range] = {}
    printed = as_printed(outcome)
    for name, made in row.results.items():
        if isinstance(made, str):
            if made in printed:
                ranges[name] = printed[made]
        elif name in values and name in evidence.texts:
            found = float(value(made, {**values, "x": values[name]}))
            places = evidence.decimals(name)
            unit = 10.0 ** -max(places, FIELDS[name].places or places)
            near = around(found, 1.001 * unit + _FACTOR * abs(found))
            if near:
                ranges[name] = near
    return ranges


def _field(name: str) -> str:
    return "MUP" if name == "MU" else name


def _decimals(text: str) -> int:
    number = numerals.value_of(text.replace(" ", "").upper())
    return 0 if number is None else max(0, -int(number.as_tuple().exponent))


def _short(number: float) -> str:
    """A value as one would type it, nine digits at most."""
    return f"{number + 0.0:.9G}"


def _shortest(number: float, half: float) -> str:
    """The number of fewest decimals that is no further than ``half`` from a value."""
    for places in range(9):
        if abs(round(number, places) - number) <= half:
            return _short(round(number, places))
    return _short(number)


def _near(number: float, within: float, most: int) -> list[str]:
    """Decimals no further than ``within`` from a value: as many places as give ``most``."""
    texts = [_short(number)]
    for places in range(9):
        step = 10.0**-places
        first, last = np.ceil((number - within) / step), np.floor((number + within) / step)
        if last - first + 1 > most:
            break
        if last >= first:
            texts = [_short(round(k * step, places)) for k in range(int(first), int(last) + 1)]
    return texts
