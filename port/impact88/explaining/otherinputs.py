"""Inputs that stand on the page otherwise than they were computed with: in another place or unit.

Each way is a scene to be replayed. A number shown in another unit was rounded when it was
converted, so the shortest number that rounds to it is taken for what was computed with.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations

from ..applesoft import decimaltext
from ..doubles import double
from ..fields import ANGLES, INPUTS
from ..reading.numerals import as_printed
from ..recovery.choices import scene_name, with_opposite_mu
from ..recovery.recovered import Recovered
from ..recovery.rereading import Change
from .hypothesis import (
    AS_RADIANS,
    AXES_SWAPPED,
    NATURAL,
    ODD,
    RADIANS,
    SIDES_SWAPPED,
    SWAPPED,
    UNIT,
    UNITS,
    Hypothesis,
)

_SIDES = (*((f"{x}A", f"{x}B") for x in "MIDPTW"), ("UX", "VX"), ("UY", "VY"))
_AXES = (("UX", "UY"), ("VX", "VY"))
_NONE = frozenset[str]()
_ALIKE = frozenset(
    frozenset(pair)
    for pair in (
        *_SIDES, *_AXES, ("PA", "TA"), ("PB", "TB"), ("MUP", "EM"), ("E", "EM"), ("E", "MUP"),
    )
)  # fmt: skip
_GROUPS = (_SIDES, _SIDES[5:], _SIDES[:2], _SIDES[3:5], _SIDES[6:], _AXES)

SPEEDS = ("UX", "UY", "VX", "VY")
SPINS = ("WA", "WB")
DEGREE, TURN_A_MINUTE = math.pi / 180, math.pi / 30
SPEED_UNITS = (
    ("mph for ft/s", 22 / 15),
    ("ft/s for mph", 15 / 22),
    ("km/h for m/s", 1 / 3.6),
    ("m/s for km/h", 3.6),
    ("mph for m/s", 0.44704),
    ("ft/s for m/s", 0.3048),
    ("m/s for ft/s", 1 / 0.3048),
    ("km/h for ft/s", 1 / 1.09728),
    ("km/h for mph", 1 / 1.609344),
    ("mph for km/h", 1.609344),
    ("knots for ft/s", 1.6878099),
    ("knots for m/s", 0.5144444),
)
"""What is shown for what is computed with, and what the shown number is to be multiplied by."""
SPIN_UNITS = (
    ("degrees for radians", DEGREE),
    ("turns for radians", 2 * math.pi),
    ("turns a minute for radians a second", TURN_A_MINUTE),
)
_GRAVITY = (32.174, 32.2, 32.17, 32.1740486, 32, 9.81, 9.80665, 9.8)
_MASSES, _INERTIAS = ("MA", "MB"), ("IA", "IB")
_FACTORS: tuple[tuple[str, tuple[str, ...], tuple[float, ...]], ...] = (
    *((note, SPEEDS, (factor,)) for note, factor in SPEED_UNITS),
    ("weights for masses", _MASSES, tuple(1 / g for g in _GRAVITY)),
    ("weights for masses and inertias", _MASSES + _INERTIAS, tuple(1 / g for g in _GRAVITY)),
    ("inertias by weight", _INERTIAS, tuple(1 / g for g in _GRAVITY)),
    ("pounds for kilograms", _MASSES, (0.45359237,)),
    ("kilograms for pounds", _MASSES, (2.20462262,)),
    ("kilograms for slugs", _MASSES, (1 / 14.5939029,)),
    ("inches for feet", ("DA", "DB"), (1 / 12,)),
    ("feet for meters", ("DA", "DB"), (0.3048,)),
    ("meters for feet", ("DA", "DB"), (1 / 0.3048,)),
    ("centimeters for meters", ("DA", "DB"), (0.01,)),
    *((note, SPINS, (factor,)) for note, factor in SPIN_UNITS),
    ("percent", ("E",), (0.01,)),
    ("percent", ("E", "MUP", "EM"), (0.01,)),
)  # fmt: skip


def other_inputs(recovered: Recovered) -> list[Hypothesis]:
    """All there are for a printout."""
    base = _Inputs(recovered)
    return [*base.exchanged(), *base.radians(), *base.units()]


class _Inputs:
    """The recovered scene, and its changes."""

    def __init__(self, recovered: Recovered) -> None:
        self._scene = recovered.scene
        self._printed = recovered.assumed

    def _made(
        self,
        kind: str,
        note: str,
        weight: float,
        typed: Mapping[str, str],
        assumed: dict[str, str] | None = None,
        within: dict[str, float] | None = None,
    ) -> Iterator[Hypothesis]:
        """The scene with some inputs otherwise, MU with either sign."""
        changes = tuple(
            Change(
                kind,
                name,
                self._printed.get(name, self._scene[scene_name(name)]),
                _shown(name, text, assumed),
            )
            for name in INPUTS
            if (text := typed.get(scene_name(name), self._scene[scene_name(name)]))
            != self._scene[scene_name(name)]
        )
        if not changes:
            return
        scene = {**self._scene, **typed}
        yield Hypothesis(kind, note, weight, changes, scene, None, _NONE, assumed, within)
        for flipped in with_opposite_mu(scene):
            yield Hypothesis(kind, note, weight, changes, flipped, None, _NONE, assumed, within)

    def exchanged(self) -> Iterator[Hypothesis]:
        """Two inputs in each other's place, or all of a side or an axis."""
        for pair in combinations(INPUTS, 2):
            kind = SWAPPED
            if pair in _AXES:
                kind = AXES_SWAPPED
            elif pair in _SIDES:
                kind = SIDES_SWAPPED
            weight = NATURAL if frozenset(pair) in _ALIKE else ODD
            yield from self._exchange(kind, weight, (pair,))
        for group in _GROUPS:
            kind = AXES_SWAPPED if group == _AXES else SIDES_SWAPPED
            yield from self._exchange(kind, NATURAL, group)

    def _exchange(
        self, kind: str, weight: float, pairs: Sequence[tuple[str, str]]
    ) -> Iterator[Hypothesis]:
        typed = {}
        assumed = dict(self._printed)
        for one, two in (*pairs, *((two, one) for one, two in pairs)):
            typed[scene_name(one)] = self._scene[scene_name(two)]
            if two in self._printed:
                assumed[one] = self._printed[two]
        note = ", ".join(f"{scene_name(one)} and {scene_name(two)}" for one, two in pairs)
        yield from self._made(kind, note, weight, typed, assumed)

    def radians(self) -> Iterator[Hypothesis]:
        """One angle or all of them in radians, or degrees that were taken for radians."""
        groups: list[tuple[str, ...]] = [*((name,) for name in ANGLES), tuple(ANGLES)]
        groups += [("PA", "PB"), ("TA", "TB"), ("PA", "PB", "TA", "TB")]
        for names in groups:
            if any(math.isinf(double(self._scene[name])) for name in names):
                continue
            seen = []
            for typed in self._converted(names, 180 / math.pi):
                if typed not in seen:
                    yield from self._made(RADIANS, ", ".join(names), UNIT, typed)
                seen.append(typed)
            back = {name: _short(double(self._scene[name]) * (math.pi / 180)) for name in names}
            yield from self._made(AS_RADIANS, ", ".join(names), UNIT + 0.2, back)

    def units(self) -> Iterator[Hypothesis]:
        """Some inputs in another unit: shown so, or computed with so."""
        for note, names, factors in _FACTORS:
            seen: list[dict[str, str]] = []
            for factor in factors:
                for way, scale in (("shown", factor), ("computed with", 1 / factor)):
                    within: dict[str, float] | None = self._within(names, scale)
                    for typed in self._converted(names, scale):
                        if typed in seen:
                            continue
                        seen.append(typed)
                        what = f"{note}, {way} so"
                        yield from self._made(UNITS, what, UNIT, typed, None, within)
                        within = None

    def _within(self, names: tuple[str, ...], scale: float) -> dict[str, float]:
        """How far the inputs times a factor may be off, by what they were rounded to."""
        decimals = max(_decimals(self._scene[scene_name(name)]) for name in names)
        half = 0.5 * 10.0**-decimals * abs(scale)
        return {
            scene_name(name): half for name in names if double(self._scene[scene_name(name)] or "0")
        }

    def _converted(self, names: tuple[str, ...], scale: float) -> Iterator[dict[str, str]]:
        """The inputs times a factor: to all their digits, to so many decimals, and the shortest
        that round to what is shown."""
        shown = {name: self._scene[scene_name(name)] for name in names}
        values = {name: double(text) * scale for name, text in shown.items()}
        if not all(map(math.isfinite, values.values())):
            return  # nobody types what doubles do not hold
        decimals = max(map(_decimals, shown.values()))
        half = 0.5 * 10.0**-decimals * abs(scale)
        ways: list[Callable[[float], str]] = [_short, lambda value: _shortest(value, half)]
        ways += [_to(places) for places in (0, 1, 2, 3, 4)]
        for way in ways:
            typed = {scene_name(name): way(value) for name, value in values.items()}
            if all(double(typed[scene_name(name)]) or not value for name, value in values.items()):
                yield typed


def _shown(name: str, typed: str, assumed: Mapping[str, str] | None) -> str:
    """What should be printed for an input that was typed so."""
    return (assumed or {}).get(name) or as_printed(typed) or typed


def _decimals(text: str) -> int:
    """Of a number as INPUT takes it; no more than doubles tell apart."""
    _, _, decimals, sign, exponent, _ = decimaltext.scan(text.upper())
    return min(max(0, len(decimals) - int(f"{sign}{exponent or 0}")), 400)


def _shortest(value: float, half: float) -> str:
    """The number of fewest decimals that is no further than ``half`` from a value."""
    for places in range(9):
        if abs(round(value, places) - value) <= half:
            return _short(round(value, places))
    return _short(value)


def _to(places: int) -> Callable[[float], str]:
    return lambda value: _short(round(value, places))


def _short(value: float) -> str:
    """A value as one would type it, nine digits at most."""
    text = f"{value:.9G}"
    return "0" if text == "-0" else text


__all__ = ["SPEEDS", "SPEED_UNITS", "SPINS", "SPIN_UNITS", "other_inputs"]
