"""Named causes (``hypotheses.txt``): pages that show inputs or results in another form; and other
programs.

Each row implies the scene that was computed with, or another form of results. Rows that fit the
page in double precision are replayed. A number converted to another unit was rounded, so several
original values are possible; for the nearest row these are searched.
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
from ...equations.edits import (
    Edit,
    expand_lines,
    parse_assignments,
    readings,
    spelling_edits,
)
from ...equations.evaluation import Run, chunks, evaluate
from ...equations.spelling import LISTING, NEGATIVE, SHOWN, Expression, spellings
from ...files import packaged_text
from ..reading import numerals
from ..recovery import replays
from ..recovery.search import Column, printed_in_doubles
from ..recovery.slips import BITS, DIGIT, Change
from ..recovery.typedtext import with_opposite_mu
from .causes import NOT_APPLESOFT, Cause, PageEvidence, Range, decimals_of, digits_of

MAX_ORIGINALS = 60_000
"""Combinations of possible original values of converted inputs; doubled, no page changes."""
_BITS = {"a changed line of the listing": 24.0, "another program": 20.0}
"""Bits of an edit: one of some 5,000 lines (12) or 500 readings (9), and an office's copy in which
one is wrong at all (12, 11)."""
MIN_EXPLAINED_BITS = 50.0
"""Information, in bits, that the explained numbers must have together: the digits of three, as two
often follow from one another (a center's velocity and its contact point's); doubled, no page
changes."""
RTOL = 1e-6
"""Relative error of the Apple's arithmetic, and of a factor known to seven digits; doubled, no page
changes."""


class Row(NamedTuple):
    """A row of the table: kind, note, improbability in bits, and formulas of inputs and results."""

    kind: str
    note: str
    bits: float
    inputs: Mapping[str, Expression]
    results: Mapping[str, Expression]


class Hypothesis(NamedTuple):
    """A row and the scene that it implies for a page. ``within``: for each converted input, its
    value and the largest distance of the typed number from it."""

    row: Row
    scene: dict[str, str]
    within: Mapping[str, tuple[float, float]] = {}


@cache
def table() -> tuple[Row, ...]:
    """Return all rows of ``hypotheses.txt``, each cause once."""
    lines = []
    for line in packaged_text(__package__ or "", "hypotheses.txt").splitlines():
        if line.startswith("#") or not line.strip():
            continue
        if "{one}" in line:
            is_result_row = ";;" in line
            names = [n for n in FIELDS if n not in INPUTS] if is_result_row else list(INPUTS)
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
    """The rows of the table, applied to one page."""

    def __init__(self, page: PageEvidence) -> None:
        self._page = page
        self._scene, self._printed = page.recovered.scene, page.recovered.assumed
        self._values = doubles_of(self._scene)
        self._places = {name: decimals_of(text.strip()) for name, text in self._scene.items()}
        self._every = [
            case._replace(scene=scene)
            for row in table()
            if row.inputs
            for case in self._hypotheses(row)
            for scene in (case.scene, *with_opposite_mu(case.scene))
        ]
        self._found = self._in_doubles([case.scene for case in self._every], page.results)
        for index, case in enumerate(self._every):
            names = {name: self._found[name][index] for name in self._found if case.row.results}
            for name, made in case.row.results.items():
                if name in names:
                    self._found[name][index] = evaluate(made, {**names, "x": names[name]})

    def causes(self) -> Iterator[Cause]:
        """Return the rows of inputs that fit the page, and the rows of results that change the
        differing ones, as causes."""
        fits = self._page.fits(self._found, len(self._every), 1.05, RTOL)
        input_rows = (case for case, fit in zip(self._every, fits, strict=True) if fit)
        result_rows = (
            Hypothesis(row, self._scene)
            for row in table()
            if not row.inputs and len(self._page.base - {*row.results}) <= self._page.max_left
        )
        return self._test_hypotheses([*input_rows, *result_rows])

    def exchanges(self) -> Iterator[tuple[Row, list[Change]]]:
        """Yield rows that exchange printed inputs, unless rarer than two misread digits; and the
        changes."""
        for row in table():
            is_exchange = row.inputs and all(
                isinstance(hypothesis, str) for hypothesis in row.inputs.values()
            )
            for hypothesis in (
                self._hypotheses(row) if is_exchange and row.bits < 2 * BITS[DIGIT] else ()
            ):
                changes = self._changes(hypothesis)
                if {change.field for change in changes} <= set(self._printed):
                    yield row, changes

    def unit_causes(self) -> Iterator[Cause]:
        """Yield the unit conversion that comes nearest, with the original values that explain the
        page best."""
        distances = self._page.median_error(self._found, len(self._every))
        units = [
            (distance, index)
            for index, (case, distance) in enumerate(zip(self._every, distances, strict=True))
            if case.within and not case.row.results and case.scene["M"] == "6"
        ]
        if units:
            unit = self._every[min(units)[1]]
            columns = list(self._columns(unit))
            best = self._page.recovered.search.nearest(columns)[0][1]
            yield from self._test_hypotheses([unit._replace(scene=best.scene)])

    # --- the scene that a row implies ---

    def _hypotheses(self, row: Row) -> Iterator[Hypothesis]:
        """Yield the scenes that a row implies: converted numbers are the shortest that round to the
        page's, or are taken in full."""
        rounded_texts: dict[str, str] = {}
        in_full: dict[str, str] = {}
        within: dict[str, tuple[float, float]] = {}
        max_places = max(self._places[name] for name in row.inputs)
        for name, formula in row.inputs.items():
            if isinstance(formula, str) and formula != "x":
                rounded_texts[name] = self._scene[formula]
                continue
            x = self._values[name]
            value = float(evaluate(formula, {**self._values, "x": x}))
            if not isfinite(value):
                return
            rounded_texts[name] = in_full[name] = _short(value)
            if x and isinstance(formula, tuple) and formula[0] not in ("+", "-", NEGATIVE):
                # a conversion; all were rounded to as many decimals, but what fills nine digits
                places = self._places[name] if digits_of(self._scene[name]) >= 9 else max_places
                within[name] = value, abs(value / x) * 0.5 * 10.0**-places
                rounded_texts[name] = _shortest(*within[name])
        for texts in (
            (rounded_texts, rounded_texts | in_full)
            if rounded_texts != rounded_texts | in_full
            else (rounded_texts,)
        ):
            if (scene := {**self._scene, **texts}) != self._scene:
                yield Hypothesis(row, scene, within)

    def _changes(self, case: Hypothesis) -> list[Change]:
        """Return the inputs that a hypothesis corrects, as they would be printed."""
        changes = []
        for name in INPUTS:
            scene_text, text = self._scene[scene_name(name)], case.scene[scene_name(name)]
            formula = case.row.inputs.get(scene_name(name))
            if formula and text != scene_text:
                page_text = self._printed.get(name, scene_text)
                source_text = self._printed.get(
                    "MUP" if formula == "MU" else str(formula), page_text
                )
                right = (
                    source_text if source_text != page_text else numerals.as_printed(text) or text
                )
                changes.append(Change(case.row.kind, name, page_text, right))
        return changes

    def _in_doubles(
        self, scenes: Sequence[Mapping[str, str]], names: Iterable[str]
    ) -> dict[str, Any]:
        columns = {name: np.full(len(scenes), x) for name, x in self._values.items()}
        for index, scene in enumerate(scenes):
            for name, text in scene.items():
                if text is not self._scene[name]:
                    columns[name][index] = double(text)
        return printed_in_doubles(columns, list(names))

    def _columns(self, unit: Hypothesis) -> Iterator[Column]:
        """Yield the columns of a search: for converted inputs, every possible original value."""
        max_texts = int(MAX_ORIGINALS ** (1 / max(3, len(unit.within))))
        for name in INPUTS:
            scene_key = scene_name(name)
            same = unit.scene[scene_key] == self._scene[scene_key] and name in self._printed
            texts = [self._printed[name] if same else unit.scene[scene_key]]
            if scene_key in unit.within:
                texts = _near(*unit.within[scene_key], max_texts)
            yield Column((name,), [((text,), 0.0) for text in texts], not same)
        yield Column(("M",), [((unit.scene["M"],), 0.0)], True)

    # --- replay of the rows ---

    def _test_hypotheses(self, every: Sequence[Hypothesis]) -> Iterator[Cause]:
        """Replay hypotheses and yield them as causes, with the numbers they leave unexplained."""
        scenes = [case.scene for case in every]
        names = [name for name in self._page.texts if name not in INPUTS]
        columns = self._in_doubles(scenes, names) if scenes else {}
        for index, (case, outcome) in enumerate(zip(every, replays.run_all(scenes), strict=True)):
            row, fields, changes = case.row, outcome.fields, self._changes(case)
            values = {name: float(column[index]) for name, column in columns.items()}
            otherwise: dict[str, Range] = {}
            for name, formula in row.results.items():
                if not isinstance(formula, str):  # in another unit, to the page's decimals
                    if name in fields and name in values:
                        value = float(evaluate(formula, {**values, "x": values[name]}))
                        places = self._page.decimals(name)
                        unit = 10.0 ** -max(places, FIELDS[name].places or places)
                        slack = 1.001 * unit + RTOL * abs(value)
                        otherwise[name] = value - slack, value + slack
                elif formula in fields:
                    text = fields[formula]
                    otherwise[name] = float(text), float(text)
                    if fields.get(name, text) != text:
                        changes.append(Change(row.kind, name, text, fields[name]))
            arguments = case.scene, outcome, changes, otherwise, frozenset(row.inputs)
            yield Cause(row.kind, row.note, row.bits, self._page.left(*arguments), tuple(changes))


def _short(number: float) -> str:
    return f"{number + 0.0:.9G}"


def _shortest(number: float, half: float) -> str:
    """Return the number of fewest decimals that is no further than ``half`` from a value."""
    for places in range(9):
        if abs(round(number, places) - number) <= half:
            return _short(round(number, places))
    return _short(number)


def _near(number: float, within: float, most: int) -> list[str]:
    """Return decimals no further than ``within`` from a value, to the most places that give at most
    ``most`` of them."""
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
    """Yield the likeliest edit of the listing that explains all that differs.

    Edits are one changed node of one statement, other columns read or shown, and other models; they
    are computed in double precision. An edit counts only where it explains far more than chance
    would (`MIN_EXPLAINED_BITS`).
    """
    numbers = {
        name: values_read[0]
        for name, values_read in page.results.items()
        if values_read and name in page.texts
    }
    differ = page.base & set(numbers)
    if (
        sum(log2(1 + abs(numbers[n]) * 10.0 ** (FIELDS[n].places or 0)) for n in differ)
        < MIN_EXPLAINED_BITS
    ):
        return
    values = doubles_of(page.recovered.scene)
    run = Run(spellings()[LISTING], {name: np.array([value]) for name, value in values.items()})

    def count_misfits(names: Mapping[str, Any], count: int) -> NDArray[np.intp]:
        """Return the number of unexplained numbers for each of ``count`` programs."""
        misfits = np.zeros(count, np.intp)
        for name, number in numbers.items():
            column = names.get(SHOWN + name, run.names[SHOWN + name])
            places = FIELDS[name].places
            unit = 0.0 if places is None else 10.0 ** -max(places, page.decimals(name))
            slack = RTOL * abs(number) + 0.05 * unit
            ahead = np.broadcast_to(column, (count, 1))[:, 0] - number
            misfits += ~((ahead >= -slack) & (ahead <= unit + slack))
        return misfits

    if not count_misfits({}, 1)[0]:
        return  # only the arithmetic differs
    edits = (*spelling_edits(LISTING), *readings())
    matching_edits: list[Edit] = []
    for part in chunks(len(edits), 1):
        names = run.run_edits([edit.sides for edit in edits[part]])
        alike = np.flatnonzero(count_misfits(names, len(edits[part])) == 0)
        matching_edits += [edits[part][k] for k in alike]
    if matching_edits:
        edit = min(matching_edits, key=lambda edit: (edit.rank, len(edit.text)))
        kind = "a changed line of the listing" if edit.title else "another program"
        yield Cause(kind, f"{edit.text}; {NOT_APPLESOFT}", _BITS[kind], frozenset())
