"""Hypotheses screened in double precision, and a unit's rounding undone.

A number shown in another unit was rounded there, so that several numbers may have been computed
with. All of them are tried: screened in double precision, the kinetic energy first, then replayed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import isfinite

import numpy as np

from ..closedform.solve import solve
from ..doubles import double
from ..fields import FIELDS, INPUTS
from ..names import PIVOT
from ..reading.numerals import as_printed
from ..recovery.choices import Choice, Choices, scene_name, with_opposite_mu
from ..recovery.recovered import Recovered
from ..recovery.search import Expected, Floats, Picks
from .hypothesis import Hypothesis

_SLACK = 1e-6
"""Relative error allowed to the Apple's arithmetic."""
_NEAR = 0.03
"""A unit is worth refining if half of the results come this near."""
_REFINED, _BY_ENERGY, _REPLAYED = 2, 300, 24
_CANDIDATES, _COMBINATIONS = 24, 60_000


def nearest(
    every: Sequence[Hypothesis], expected: Sequence[Expected], most: int
) -> list[Hypothesis]:
    """The hypotheses whose scenes come nearest to the page, ``most`` of them; all of them where
    double precision does not follow the program (M = 4, MU past the pivot's -10)."""
    if len(every) <= most or not all(_followed(one.scene) for one in every[:1]):
        return list(every)
    misses = np.zeros(len(every))
    for one, printed, values in _solved(every, expected):
        unit = 10.0 ** -(FIELDS[one.name].places or 0) if FIELDS[one.name].places else 0.0
        slack = 1.1 * unit + _SLACK * abs(printed)
        with np.errstate(invalid="ignore"):
            misses += ~(np.abs(values - printed) <= slack)
    order = np.argsort(misses, kind="stable")[:most]
    other = [one for one in every if one.scene["M"] != "6"]
    kept = [every[index] for index in sorted(order.tolist())]
    return kept + [one for one in other if one not in kept]


def _followed(scene: dict[str, str]) -> bool:
    mu = double(scene["MU"] or "0")
    return scene["M"] == "6" and (abs(mu) < -PIVOT or mu == PIVOT)


def _solved(
    every: Sequence[Hypothesis], expected: Sequence[Expected]
) -> Iterator[tuple[Expected, float, Floats]]:
    """Each printed result, what it is as a number, and what the scenes give for it."""
    columns = {
        name: np.array([double(one.scene[name] or "0") for one in every]) for name in every[0].scene
    }
    numbers = {one.name: min(one.texts, key=one.texts.__getitem__) for one in expected if one.texts}
    with np.errstate(all="ignore"):
        solved = solve(columns, list(numbers))
    for one in expected:
        if one.name in numbers:
            yield one, float(numbers[one.name]), solved[one.name]


def refined(recovered: Recovered, hypotheses: Sequence[Hypothesis]) -> Iterator[Hypothesis]:
    """The units that nearly explain the page, with the numbers that explain it best."""
    units = [one for one in hypotheses if one.within]
    search = recovered.search
    if not units or recovered.scene["M"] != "6":
        return
    rows = [
        np.abs(values - printed) / (abs(printed) + 0.1)
        for _, printed, values in _solved(units, search.expected)
    ]
    if not rows:
        return
    far = np.median(np.nan_to_num(np.array(rows), nan=np.inf), axis=0)
    for index in np.argsort(far, kind="stable")[:_REFINED].tolist():
        if far[index] <= _NEAR:
            yield from _refined(recovered, units[index])


def _refined(recovered: Recovered, unit: Hypothesis) -> Iterator[Hypothesis]:
    choices = _choices(recovered, unit)
    picks = _all(choices)
    search = recovered.search
    picks = search.by_energy(choices, picks, _BY_ENERGY)
    picks = search.screened(choices, picks, _REPLAYED)
    best = min(search.replayed(choices, picks), key=lambda one: one.cost)
    changes = tuple(
        change._replace(would_be=as_printed(text) or text)
        for change in unit.changes
        if (text := best.scene[scene_name(change.field)])
    )
    yield unit._replace(changes=changes, scene=best.scene, within=None)


def _choices(recovered: Recovered, unit: Hypothesis) -> Choices:
    """For the converted inputs every number that may have been computed with."""
    within = unit.within or {}
    most = int(_COMBINATIONS ** (1 / max(1, len(within))))
    choices: Choices = []
    for name in INPUTS:
        own = scene_name(name)
        if own in within and isfinite(double(unit.scene[own])):
            texts = _near(double(unit.scene[own]), within[own], min(_CANDIDATES, most))
            choices.append([Choice({own: text}, {}, 0.0) for text in texts])
            continue
        printed = {name: recovered.assumed[name]} if name in recovered.assumed else {}
        choices.append([Choice({own: unit.scene[own]}, printed, 0.0)])
        if own == "MU":
            for typed in with_opposite_mu({own: unit.scene[own]}):
                choices[-1].append(Choice(typed, printed, 0.0))
    choices.append([Choice({"M": unit.scene["M"]}, {}, 0.0)])
    return choices


def _near(value: float, within: float, most: int) -> list[str]:
    """Decimals no further than ``within`` from a value: as many places as give ``most``."""
    texts = [f"{value:.9G}"]
    for places in range(9):
        step = 10.0**-places
        first, last = np.ceil((value - within) / step), np.floor((value + within) / step)
        if last - first + 1 > most:
            break
        if last >= first:
            texts = [f"{round(k * step, places):.9G}" for k in range(int(first), int(last) + 1)]
    return texts


def _all(choices: Choices) -> Picks:
    """Every combination."""
    sizes = [len(options) for options in choices]
    return np.stack([axis.ravel() for axis in np.indices(sizes)], axis=1)


__all__ = ["nearest", "refined"]
