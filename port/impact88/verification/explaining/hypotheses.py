"""Named causes (``hypotheses.txt``): pages whose inputs or results stand there otherwise; and other
programs.

Each row means a scene that was computed with, or results that are shown otherwise. Those that fit
the page in double precision are replayed. A number shown in another unit was rounded there, so that
it may have been computed with several; they are searched for the nearest rows.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from itertools import combinations
from math import isfinite, log2
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.doubles import double, doubles_of
from ...collision.fields import FIELDS, INPUTS, scene_name
from ...comparison.equations.edits import (
    Edit,
    expand_lines,
    parse_assignments,
    readings,
    spelling_edits,
)
from ...comparison.equations.evaluation import Run, chunks, evaluate
from ...comparison.equations.spelling import LISTING, NEGATIVE, SHOWN, Expression, spellings
from ...files import packaged_text
from ..reading import numerals
from ..recovery import replays
from ..recovery.search import Column, in_doubles
from ..recovery.slips import BITS, DIGIT, Change
from ..recovery.typedtext import with_opposite_mu
from .causes import NOT_APPLESOFT, Cause, PageEvidence, Range, decimals_of, digits_of

_COMBINATIONS = 60_000
"""Numbers that may have been computed with, of all inputs together; doubled, no page changes."""
_BITS = {"a changed line of the listing": 24.0, "another program": 20.0}
"""Bits of an edit: one of some 5,000 lines (12) or 500 readings (9), and an office's copy in which
one is wrong at all (12, 11)."""
_CHANCE = 50.0
"""Bits that the explained numbers must have together: the digits of three of them, as two often
follow from one another (a center's velocity and its contact point's); doubled, no page changes."""
_ROUGH = 1e-6
"""Relative error of the Apple's arithmetic, and of a factor that is known to seven digits; doubled,
no page changes."""


class Row(NamedTuple):
    """A line of the table."""

    kind: str
    note: str
    bits: float
    inputs: Mapping[str, Expression]
    results: Mapping[str, Expression]


class Hypothesis(NamedTuple):
    """A row, the scene it means for a page, and ``within``: of what was converted its value and how
    far from it the number typed may be."""

    row: Row
    scene: dict[str, str]
    within: Mapping[str, tuple[float, float]] = {}


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
            for first, second in combinations(map(scene_name, names), 2):
                lines.append(line.replace("{one}", first).replace("{two}", second))
        else:
            lines.append(line)
    rows: dict[str, Row] = {}
    for line in expand_lines(lines):
        kind, note, bits, edits = (part.strip() for part in line.split("|"))
        inputs, _, results = edits.partition(";;")
        row = Row(
            kind,
            note,
            float(bits),
            dict(parse_assignments(inputs)),
            dict(parse_assignments(results)),
        )
        rows.setdefault(edits, row)
    return tuple(rows.values())


class Rows:
    """The rows as one page has them."""

    def __init__(self, page: PageEvidence) -> None:
        self._page = page
        self._scene, self._printed = page.recovered.scene, page.recovered.assumed
        self._values = doubles_of(self._scene)
        self._places = {name: decimals_of(text.strip()) for name, text in self._scene.items()}
        self._every = [
            case._replace(scene=scene)
            for row in table()
            if row.inputs
            for case in self._made(row)
            for scene in (case.scene, *with_opposite_mu(case.scene))
        ]
        self._found = self._in_doubles([case.scene for case in self._every], page.results)
        for index, case in enumerate(self._every):
            names = {name: self._found[name][index] for name in self._found if case.row.results}
            for name, made in case.row.results.items():
                if name in names:
                    self._found[name][index] = evaluate(made, {**names, "x": names[name]})

    def causes(self) -> Iterator[Cause]:
        """The rows of inputs that fit the page, and those of results that change what differs."""
        fits = self._page.fits(self._found, len(self._every), 1.05, _ROUGH)
        own = (case for case, fit in zip(self._every, fits, strict=True) if fit)
        results = (
            Hypothesis(row, self._scene)
            for row in table()
            if not row.inputs and len(self._page.base - {*row.results}) <= self._page.most_left
        )
        return self._tested([*own, *results])

    def exchanges(self) -> Iterator[tuple[Row, list[Change]]]:
        """Printed inputs in each other's place, where that is no rarer than two digits misread."""
        for row in table():
            names = row.inputs and all(isinstance(made, str) for made in row.inputs.values())
            for made in self._made(row) if names and row.bits < 2 * BITS[DIGIT] else ():
                changes = self._changes(made)
                if {change.field for change in changes} <= set(self._printed):
                    yield row, changes

    def searched(self) -> Iterator[Cause]:
        """The unit that comes nearest, with the numbers that explain the page best."""
        far = self._page.far(self._found, len(self._every))
        units = [
            (distance, index)
            for index, (case, distance) in enumerate(zip(self._every, far, strict=True))
            if case.within and not case.row.results and case.scene["M"] == "6"
        ]
        if units:
            unit = self._every[min(units)[1]]
            columns = list(self._columns(unit))
            search = self._page.recovered.search
            picks = search.promising(columns, _COMBINATIONS)
            best = min(search.replayed(columns, picks), key=lambda scored: scored.cost)
            yield from self._tested([unit._replace(scene=best.scene)])

    # --- the scene that a row means ---

    def _made(self, row: Row) -> Iterator[Hypothesis]:
        """A row's scene; numbers converted are the shortest that round so, or in full."""
        typed: dict[str, str] = {}
        in_full: dict[str, str] = {}
        within: dict[str, tuple[float, float]] = {}
        most = max(self._places[name] for name in row.inputs)
        for name, made in row.inputs.items():
            if isinstance(made, str) and made != "x":
                typed[name] = self._scene[made]
                continue
            x = self._values[name]
            found = float(evaluate(made, {**self._values, "x": x}))
            if not isfinite(found):
                return
            typed[name] = in_full[name] = _short(found)
            if x and isinstance(made, tuple) and made[0] not in ("+", "-", NEGATIVE):
                # a conversion; all were rounded to as many decimals, but what fills nine digits
                places = self._places[name] if digits_of(self._scene[name]) >= 9 else most
                within[name] = found, abs(found / x) * 0.5 * 10.0**-places
                typed[name] = _shortest(*within[name])
        for own in (typed, typed | in_full) if typed != typed | in_full else (typed,):
            if (scene := {**self._scene, **own}) != self._scene:
                yield Hypothesis(row, scene, within)

    def _changes(self, case: Hypothesis) -> list[Change]:
        """The inputs that it puts right, as they would be printed."""
        changes = []
        for name in INPUTS:
            own, text = self._scene[scene_name(name)], case.scene[scene_name(name)]
            made = case.row.inputs.get(scene_name(name))
            if made and text != own:
                printed = self._printed.get(name, own)
                other = self._printed.get("MUP" if made == "MU" else str(made), printed)
                right = other if other != printed else numerals.as_printed(text) or text
                changes.append(Change(case.row.kind, name, printed, right))
        return changes

    def _in_doubles(
        self, scenes: Sequence[Mapping[str, str]], names: Iterable[str]
    ) -> dict[str, Any]:
        columns = {name: np.full(len(scenes), x) for name, x in self._values.items()}
        for index, scene in enumerate(scenes):
            for name, text in scene.items():
                if text is not self._scene[name]:
                    columns[name][index] = double(text)
        return in_doubles(columns, list(names))

    def _columns(self, unit: Hypothesis) -> Iterator[Column]:
        """For the converted inputs every number that may have been computed with."""
        most = int(_COMBINATIONS ** (1 / max(3, len(unit.within))))
        for name in INPUTS:
            own = scene_name(name)
            same = unit.scene[own] == self._scene[own] and name in self._printed
            texts = [self._printed[name] if same else unit.scene[own]]
            if own in unit.within:
                texts = _near(*unit.within[own], most)
            yield Column((name,), [((text,), 0.0) for text in texts], not same)
        yield Column(("M",), [((unit.scene["M"],), 0.0)], True)

    # --- what it leaves unexplained ---

    def _tested(self, every: Sequence[Hypothesis]) -> Iterator[Cause]:
        scenes = [case.scene for case in every]
        names = [name for name in self._page.texts if name not in INPUTS]
        columns = self._in_doubles(scenes, names) if scenes else {}
        for index, (case, outcome) in enumerate(zip(every, replays.run_all(scenes), strict=True)):
            row, fields, changes = case.row, outcome.fields, self._changes(case)
            values = {name: float(column[index]) for name, column in columns.items()}
            otherwise: dict[str, Range] = {}
            for name, made in row.results.items():
                if not isinstance(made, str):  # in another unit, to the page's decimals
                    if name in fields and name in values:
                        found = float(evaluate(made, {**values, "x": values[name]}))
                        places = self._page.decimals(name)
                        unit = 10.0 ** -max(places, FIELDS[name].places or places)
                        slack = 1.001 * unit + _ROUGH * abs(found)
                        otherwise[name] = found - slack, found + slack
                elif made in fields:
                    text = fields[made]
                    otherwise[name] = float(text), float(text)
                    if fields.get(name, text) != text:
                        changes.append(Change(row.kind, name, text, fields[name]))
            given = case.scene, outcome, changes, otherwise, frozenset(row.inputs)
            yield Cause(row.kind, row.note, row.bits, self._page.left(*given), tuple(changes))


def _short(number: float) -> str:
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


# --- other programs ---


def other_programs(page: PageEvidence) -> Iterator[Cause]:
    """The edit of the listing that explains all that differs, of those that compute the same the
    likeliest: one node of one statement written otherwise, columns read or shown otherwise, other
    models; in double precision. Only where it explains far more than chance would."""
    numbers = {name: some[0] for name, some in page.results.items() if some and name in page.texts}
    differ = page.base & set(numbers)
    if sum(log2(1 + abs(numbers[n]) * 10.0 ** (FIELDS[n].places or 0)) for n in differ) < _CHANCE:
        return
    values = doubles_of(page.recovered.scene)
    run = Run(spellings()[LISTING], {name: np.array([value]) for name, value in values.items()})

    def wrong(names: Mapping[str, Any], count: int) -> NDArray[np.intp]:
        """How many of the numbers each of so many programs leaves unexplained."""
        found = np.zeros(count, np.intp)
        for name, number in numbers.items():
            column = names.get(SHOWN + name, run.names[SHOWN + name])
            places = FIELDS[name].places
            unit = 0.0 if places is None else 10.0 ** -max(places, page.decimals(name))
            slack = _ROUGH * abs(number) + 0.05 * unit
            ahead = np.broadcast_to(column, (count, 1))[:, 0] - number
            found += ~((ahead >= -slack) & (ahead <= unit + slack))
        return found

    if not wrong({}, 1)[0]:
        return  # what differs is the arithmetic
    edits = (*spelling_edits(LISTING), *readings())
    named: list[Edit] = []
    for part in chunks(len(edits), 1):
        names = run.run_edits([edit.sides for edit in edits[part]])
        alike = np.flatnonzero(wrong(names, len(edits[part])) == 0)
        named += [edits[part][k] for k in alike]
    if named:
        edit = min(named, key=lambda edit: (edit.rank, len(edit.text)))
        kind = "a changed line of the listing" if edit.title else "another program"
        yield Cause(kind, f"{edit.text}; {NOT_APPLESOFT}", _BITS[kind], frozenset())
