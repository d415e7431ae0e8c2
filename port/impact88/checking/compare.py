"""Comparing another implementation's results with this one's, and guessing why they differ.

A result *agrees to the double* when it is no farther off than rounding in double precision allows
(`errorbound`), *to the digits claimed* when it is the exact value rounded to the digits it is
written with, and otherwise not. For rows that disagree, likely causes (`CAUSES`) are tried: the
scene is solved again as a program with that convention or slip would, and a cause is named when it
makes every result of the row agree.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import doubles
from ..accuracy import errorbound
from ..closedform.solve import solve
from ..errors import UserError, quoted
from ..fields import ANGLES, FIELDS
from ..files import called
from ..names import DEFAULT_M, RESULTS, SCENE
from ..replay import replay
from ..tables.rows import BadCell, Rows, check_scene_columns, numbers
from ..tables.table import open_reader

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Columns = dict[str, Floats]

DOUBLE, DIGITS, NOT = "double", "digits", "no"
WORST = 20
"""Rows that disagree most, kept for the report."""
_NOT_COMPARED = ("STATUS", "COND")
_SPINS = ("WAF", "WBF")


class Theirs(NamedTuple):
    """One column of another program's results: values, and the unit of the last digit written."""

    values: Floats
    units: Floats


class Row(NamedTuple):
    """A row that disagrees: where it stands, its worst result, how far off, the likely cause."""

    row: int
    line: int
    id: str
    result: str
    theirs: str
    ours: float
    relative: float
    cause: str


@dataclass
class Tally:
    """For one result: how many agree in which way, and the largest relative difference."""

    compared: int = 0
    double: int = 0
    digits: int = 0
    differ: int = 0
    largest: float = 0.0


@dataclass
class Comparison:
    """The result of `compare_file`. ``causes``: likely cause -> rows it explains."""

    rows: int = 0
    agreeing: int = 0
    differing: int = 0
    tallies: dict[str, Tally] = field(default_factory=dict)
    causes: Counter[str] = field(default_factory=Counter)
    worst: list[Row] = field(default_factory=list)
    bad: list[BadCell] = field(default_factory=list)
    ignored: list[str] = field(default_factory=list)

    def as_json(self) -> dict[str, Any]:
        """The object `impact88 compare --json` prints."""
        return {
            "rows": self.rows,
            "agreeing": self.agreeing,
            "differing": self.differing,
            "results": {name: vars(tally) for name, tally in self.tallies.items()},
            "causes": dict(self.causes.most_common()),
            "worst": [one._asdict() for one in self.worst],
            "bad_rows": [str(bad) for bad in self.bad],
            "ignored_columns": self.ignored,
        }


# --- likely causes -------------------------------------------------------------------------------


class Cause(NamedTuple):
    """A convention or slip: how it changes the scene's columns, given our results for them, and
    then the results."""

    says: str
    scene: Callable[[Columns, Columns], Columns]
    results: Callable[[Columns], Columns] = lambda results: {}


def _nothing(scene: Columns, ours: Columns) -> Columns:
    return {}


def _angles(change: Callable[[Floats], Floats], names: Sequence[str] = ANGLES) -> Any:
    return lambda scene, ours: {name: change(scene[name]) for name in names}


def _mu_as_typed(scene: Columns, ours: Columns) -> Columns:
    """Line 400 flips MU where MUP shows it; a program without it must be given the opposite."""
    return {"MU": np.where(ours["MUP"] == scene["MU"], scene["MU"], -scene["MU"])}


def _mu_opposite(scene: Columns, ours: Columns) -> Columns:
    return {"MU": np.where(scene["MU"] == -10, scene["MU"], -scene["MU"])}


CAUSES = (
    Cause("the 3.14159265 of line 300 for pi", _angles(lambda x: x * (3.14159265 / math.pi))),
    Cause("angles taken as radians", _angles(np.degrees)),
    Cause("angles converted to radians twice", _angles(np.radians)),
    Cause("MU's sign as typed, without line 400's rule", _mu_as_typed),
    Cause("MU with the opposite sign, or Γ 180 degrees off, which is the same", _mu_opposite),
    Cause(
        "no moment impulse: e_m absent, as in models with M = 0",
        lambda scene, ours: {"EM": np.ones_like(scene["EM"])},
    ),
    Cause("Γ positive the other way round", _angles(np.negative, ("GA",))),
    Cause(
        "Γ 90 degrees on: the normal's angle for the surface's", _angles(lambda x: x + 90, ("GA",))
    ),
    Cause("Γ 90 degrees back", _angles(lambda x: x - 90, ("GA",))),
    Cause("all angles positive clockwise", _angles(np.negative)),
    Cause("φ positive the other way round", _angles(np.negative, ("PA", "PB"))),
    Cause(
        "spins in degrees, results only",
        _nothing,
        lambda found: {name: np.degrees(found[name]) for name in _SPINS},
    ),
    Cause(
        "spins in degrees",
        lambda scene, ours: {name: np.radians(scene[name]) for name in ("WA", "WB")},
        lambda found: {name: np.degrees(found[name]) for name in _SPINS},
    ),
    Cause(
        "final spins with the opposite sign",
        _nothing,
        lambda found: {name: -found[name] for name in _SPINS},
    ),
    Cause(
        "point masses: DA and DB left out", lambda scene, ours: {"M": np.full_like(scene["M"], 4)}
    ),
    Cause("the pivot for friction", lambda scene, ours: {"MU": np.full_like(scene["MU"], -10)}),
)
"""Of those that fit equally well, the first is named."""

PRINTED = "digits of the 1988 printout, which floors"
FLOORED = "floored to the digits given, not rounded"
TRUNCATED = "cut off at the digits given, not rounded"
APPLESOFT = "rounding in 32 bits, as Applesoft's"
SINGLE = "rounding in single precision"
UNKNOWN = "unexplained"


# --- comparing -----------------------------------------------------------------------------------


def compare_file(path: str, form: str, given: Mapping[str, str] | None = None) -> Comparison:
    """Compare a table of scenes and results, block by block.

    ``given``: values for all rows of columns the table lacks. Raises UserError when the table has
    no result column or does not give a whole scene."""
    given = given or {}
    done = Comparison()
    with open_reader(path, form) as reader:
        wanted = [name for name in reader.names if name in RESULTS and name not in _NOT_COMPARED]
        where = called(path)
        if not wanted:
            raise UserError(
                f"no column of results; expected some of {' '.join(RESULTS)}, beside the scene's",
                where,
            )
        scene_names = [name for name in reader.names if name in SCENE]
        check_scene_columns(scene_names, list(given), ("M",))
        done.ignored = [n for n in reader.names if n not in SCENE and n not in wanted and n != "id"]
        done.tallies = {name: Tally() for name in wanted}
        for rows in reader:
            _compare_block(rows, given, wanted, done)
    if not any(tally.compared for tally in done.tallies.values()):
        raise UserError("no result could be compared", where)
    return done


@np.errstate(all="ignore")
def _compare_block(
    rows: Rows, given: Mapping[str, str], wanted: Sequence[str], done: Comparison
) -> None:
    values = {"M": DEFAULT_M, **given}
    columns = {name: np.full(rows.count, float(values[name])) for name in values if name in SCENE}
    columns |= numbers(rows)
    columns = {name: columns[name] for name in SCENE}
    ours = _solved(columns)
    theirs = {name: _theirs(rows, name) for name in wanted}
    bad = {one.row for one in rows.bad}
    usable = np.array([rows.first + index not in bad for index in range(rows.count)])
    bounds = errorbound.relative_bounds(ours["COND"])
    sizes = errorbound.scales(columns, ours)
    agree = np.ones(rows.count, bool)
    worst = np.zeros(rows.count)
    worst_name = np.full(rows.count, "", dtype=object)
    compared = np.zeros(rows.count, bool)
    for name in wanted:
        there = usable & np.isfinite(theirs[name].values) & np.isfinite(ours[name])
        double, digits = _agreement(theirs[name], ours[name], bounds * sizes[name])
        off = np.abs(theirs[name].values - ours[name])
        relative = np.where(sizes[name] > 0, off / sizes[name], np.where(off > 0, np.inf, 0.0))
        tally = done.tallies[name]
        differ = there & ~double & ~digits
        tally.compared += int(there.sum())
        tally.double += int((there & double).sum())
        tally.digits += int((there & digits & ~double).sum())
        tally.differ += int(differ.sum())
        if there.any():
            tally.largest = max(tally.largest, float(relative[there].max()))
        agree &= ~differ
        compared |= there
        larger = differ & (relative >= worst)
        worst[larger] = relative[larger]
        worst_name[larger] = name
    done.rows += rows.count
    done.bad += rows.bad
    done.agreeing += int((agree & compared).sum())
    wrong = np.flatnonzero(~agree & compared)
    done.differing += wrong.size
    if not wrong.size:
        return
    fits = _fits(columns, ours, theirs, _texts(rows, given))
    causes = _likeliest(fits, wrong, agree & compared)
    for place, index in enumerate(wrong.tolist()):
        if causes[place] == UNKNOWN:
            causes[place] = _by_size(float(worst[index]))
    done.causes.update(causes)
    ids = rows.others.get("id")
    for index, cause in zip(wrong.tolist(), causes, strict=True):
        name = worst_name[index]
        done.worst.append(
            Row(
                rows.first + index,
                rows.lines[index] if rows.lines else 0,
                str(ids[index]) if ids is not None else "",
                name,
                str(rows.others[name][index]),
                float(ours[name][index]),
                float(worst[index]),
                cause,
            )
        )
    done.worst.sort(key=lambda one: -one.relative)
    del done.worst[WORST:]


def _solved(columns: Columns) -> Columns:
    with np.errstate(all="ignore"):
        return {name: column.astype(float) for name, column in solve(columns).items()}


_WRITTEN = re.compile(r"[+-]?[0-9]*(?:\.([0-9]*))?(?:[eE]([+-]?[0-9]+))?")


def _theirs(rows: Rows, name: str) -> Theirs:
    """A column of results; what is no number is NaN and counts as not given."""
    column = rows.others[name]
    if isinstance(column, np.ndarray) and column.dtype.kind in "fiu":
        return Theirs(column.astype(float), np.zeros(rows.count))
    values, units = np.full(rows.count, np.nan), np.zeros(rows.count)
    for index, cell in enumerate(column):
        text = str(cell).strip() if cell is not None else ""
        try:
            values[index] = doubles.double(text)
        except ValueError:
            if text:
                rows.bad.append(rows.cell(index, name, f"{quoted(text)} is no number"))
            continue
        written = _WRITTEN.fullmatch(text)
        if written:
            decimals, exponent = written.groups(default="")
            power = float(exponent or 0) - len(decimals)
            units[index] = 10.0 ** min(300.0, max(power, -400.0))
    return Theirs(values, units)


def _agreement(theirs: Theirs, ours: Floats, bound: Floats) -> tuple[Bools, Bools]:
    """Which agree to the double, and which to the digits claimed."""
    off = np.abs(theirs.values - ours)
    slack = bound + 2 * np.spacing(np.abs(ours))
    return off <= slack, off <= theirs.units * (0.5 + 1e-9) + slack


def _texts(rows: Rows, given: Mapping[str, str]) -> dict[str, list[str]]:
    """The scenes as decimal text."""
    texts = {}
    for name in SCENE:
        if name in rows.columns:
            texts[name] = list(map(str, rows.columns[name]))
        else:
            texts[name] = [given.get(name, DEFAULT_M)] * rows.count
    return texts


def _fits(
    columns: Columns, ours: Columns, theirs: Mapping[str, Theirs], texts: dict[str, list[str]]
) -> dict[str, Bools]:
    """For every cause the rows it makes agree in all their results."""
    fits = {PRINTED: _as_printed(theirs, texts)}
    for says, cut in ((FLOORED, np.floor), (TRUNCATED, np.trunc)):

        def is_cut(name: str, cut: Callable[[Floats], Floats] = cut) -> Bools:
            return _is_cut(theirs[name], ours[name], cut)

        fits[says] = _all_fit(theirs, ours, is_cut)
    for cause in CAUSES:
        changed = {**columns, **cause.scene(columns, ours)}
        results = _solved(changed)
        results |= cause.results(results)
        fits[cause.says] = _agree_within(theirs, changed, results, errorbound.DOUBLE)
    for unit, says in ((errorbound.APPLESOFT, APPLESOFT), (2.0**-24, SINGLE)):
        fits[says] = _agree_within(theirs, columns, ours, unit)
    return fits


def _agree_within(
    theirs: Mapping[str, Theirs], columns: Columns, results: Columns, unit: float
) -> Bools:
    """The rows whose every result agrees, to the digits claimed, in arithmetic of this roundoff."""
    bounds = errorbound.relative_bounds(results["COND"], unit)
    sizes = errorbound.scales(columns, results)
    return _all_fit(
        theirs,
        results,
        lambda name: _agreement(theirs[name], results[name], bounds * sizes[name])[1],
    )


def _likeliest(fits: Mapping[str, Bools], wrong: NDArray[np.intp], right: Bools) -> list[str]:
    """The cause of each row that is wrong: the one that fits most of them first, then the one that
    fits most of those left. Of equals, the one that the rows that agree do not contradict."""
    found = dict.fromkeys(wrong.tolist(), UNKNOWN)
    left = np.zeros(right.size, bool)
    left[wrong] = True
    while left.any():
        merit = {
            says: (int((fit & left).sum()), int((fit & right).sum())) for says, fit in fits.items()
        }
        says = max(merit, key=lambda one: merit[one])
        if not merit[says][0]:
            break
        for index in np.flatnonzero(fits[says] & left).tolist():
            found[index] = says
        left &= ~fits[says]
    return list(found.values())


def _all_fit(theirs: Mapping[str, Theirs], results: Columns, fits: Callable[[str], Bools]) -> Bools:
    """The rows whose every result fits; results not given or not finite on their side fit."""
    rows = np.ones(next(iter(results.values())).size, bool)
    with np.errstate(all="ignore"):
        for name, column in theirs.items():
            rows &= ~np.isfinite(column.values) | fits(name)
    return rows


def _is_cut(theirs: Theirs, ours: Floats, cut: Callable[[Floats], Floats]) -> Bools:
    """Whether a result is ours cut at the last digit written (a hair of rounding allowed)."""
    unit = np.where(theirs.units > 0, theirs.units, np.nan)
    steps, near = theirs.values / unit, ours / unit
    hair = 1e-9 * np.maximum(np.abs(near), 1.0)
    low, high = cut(near - hair), cut(near + hair)
    return (np.abs(steps - low) < 1e-6) | (np.abs(steps - high) < 1e-6)


def _as_printed(theirs: Mapping[str, Theirs], texts: dict[str, list[str]]) -> Bools:
    """Rows that are the 1988 program's own digits."""
    count = len(texts["MA"])
    if not all(name in FIELDS for name in theirs):
        return np.zeros(count, bool)
    try:
        replayed = replay(texts)
    except UserError:
        return np.zeros(count, bool)
    rows = np.ones(count, bool)
    for name, column in theirs.items():
        printed = replayed.printed(name).tolist()
        values = np.array([float(text) if text else np.nan for text in printed])
        rows &= ~np.isfinite(column.values) | (values == column.values)
    return rows


def _by_size(worst: float) -> str:
    """Unexplained, but how far off."""
    if not 0 < worst < 1e-2:
        return UNKNOWN
    return f"{UNKNOWN}, but agrees to about {int(-math.log10(worst))} digits"
