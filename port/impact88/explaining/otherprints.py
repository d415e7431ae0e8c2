"""Results that were computed as the program does and stand on the page otherwise: rounded or cut,
to other decimals, in another unit, or in each other's place.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from decimal import Decimal
from itertools import combinations

from ..doubles import doubles_of
from ..fields import FIELDS, INPUTS
from ..reading.numerals import as_printed, value_of
from ..reading.printout import Printout
from ..recovery import replays
from ..recovery.recovered import Recovered
from ..recovery.rereading import Change
from .hypothesis import (
    NATURAL,
    OTHER_DECIMALS,
    PROGRAM,
    RESULT_UNITS,
    RESULTS_SWAPPED,
    ROUNDED,
    TRUNCATED,
    UNIT,
    Hypothesis,
)
from .otherinputs import SPEED_UNITS, SPIN_UNITS

Cut = Callable[[float, int], str]
_FINAL_SPEEDS = ("VAX", "VAY", "XAF", "YAF", "VBX", "VBY", "XBF", "YBF")
_CONTACT_SPEEDS = ("XA", "YA", "XB", "YB")
_FINAL_SPINS = ("WAF", "WBF")
_ENERGY_UNITS = (
    ("foot-pounds for joules", 1.35581795),
    ("joules for foot-pounds", 1 / 1.35581795),
    ("kilojoules for joules", 1000.0),
)
_LINES = (("VAX", "VBX"), ("VAY", "VBY"), ("XAF", "XBF"), ("YAF", "YBF"), ("WAF", "WBF"))
_AXES = (("VAX", "VAY"), ("VBX", "VBY"), ("XAF", "YAF"), ("XBF", "YBF"))
_SINGLE, _SINGLE_ERROR = 7, 3e-6
"""Digits of single precision, and the relative error left to its results."""
SOME_LINES = 1.42
"""What it asks to believe that an office's copy rounds on some lines: more than other arithmetic
(1.4), and less than a last place misread (1.8), which a rounded one looks like."""
_MOST_PLACES = 22
"""Decimals of a program's number, at most; to here the powers of ten are exact."""
_SAME_TO = 1e-6
"""Relative error left to a factor that is known to seven digits."""


def exchanged(recovered: Recovered) -> Iterator[Hypothesis]:
    """Two results, the lines of A and B, or x and y in each other's place."""
    fields = recovered.outcome.fields
    singles = [(pair,) for pair in combinations([n for n in FIELDS if n not in INPUTS], 2)]
    groups = (_LINES[:4], _LINES, _LINES[:2], _LINES[2:4], _AXES, _AXES[:2], _AXES[2:], *singles)
    for group in groups:
        pairs = [pair for pair in group if pair[0] in fields and pair[1] in fields]
        swapped = dict(fields)
        for one, two in pairs:
            swapped[one], swapped[two] = fields[two], fields[one]
        changes = tuple(
            Change(RESULTS_SWAPPED, name, swapped[name], fields[name])
            for pair in pairs
            for name in pair
            if swapped[name] != fields[name]
        )
        note = ", ".join(f"{one} and {two}" for one, two in pairs)
        outcome = replays.Outcome(swapped, recovered.outcome.ending)
        if changes:
            yield Hypothesis(RESULTS_SWAPPED, note, NATURAL, changes, recovered.scene, outcome)


class Prints:
    """How the results of one run may stand on the page: what it prints, its values unfloored."""

    def __init__(
        self,
        shown: Printout,
        scene: dict[str, str],
        outcome: replays.Outcome,
        values: Mapping[str, float],
        note: str = "",
    ) -> None:
        self._shown = shown
        self._scene = scene
        self._outcome = outcome
        self._values = values
        self._note = note

    def all(self) -> Iterator[Hypothesis]:
        """Every way that is not the program's own."""
        yield from self.cut()
        yield from self.other_decimals()
        yield from self.other_units()

    def _made(self, kind: str, note: str, weight: float, fields: Mapping[str, str]) -> Hypothesis:
        outcome = replays.Outcome({**self._outcome.fields, **fields}, self._outcome.ending)
        said = "; ".join(part for part in (note, self._note) if part)
        return Hypothesis(kind, said, weight, (), self._scene, outcome)

    def cut(self) -> Iterator[Hypothesis]:
        """Rounded, or cut toward zero, to the listing's decimals."""
        for kind, way in ((ROUNDED, rounded_text), (TRUNCATED, truncated_text)):
            fields = {
                name: way(value, FIELDS[name].places or 0) for name, value in self._values.items()
            }
            yield self._made(kind, "", PROGRAM, fields)
            yield from self._cut_on_some_lines(kind, fields)

    def _cut_on_some_lines(self, kind: str, fields: Mapping[str, str]) -> Iterator[Hypothesis]:
        """So on the lines of the listing whose numbers the page has so, and floored elsewhere."""
        lines: dict[int, list[str]] = {}
        for name in fields:
            lines.setdefault(FIELDS[name].line, []).append(name)
        floored = self._outcome.fields
        some = [
            line
            for line, names in lines.items()
            if all(self._text(name) in (None, fields[name]) for name in names)
            and any(self._text(name) not in (None, floored.get(name)) for name in names)
        ]
        if some and len(some) < len(lines):
            own = {name: fields[name] for line in some for name in lines[line]}
            where = f"on line{'' if len(some) == 1 else 's'} {', '.join(map(str, some))}"
            yield self._made(kind, where, SOME_LINES, own)

    def other_decimals(self) -> Iterator[Hypothesis]:
        """To as many decimals as the page has, where those are not the listing's."""
        decimals = self._decimals()
        own = [FIELDS[name].places or 0 for name in decimals]
        if list(decimals.values()) != own:
            for what, way in (("rounded", rounded_text), ("floored", floored_text)):
                fields = {
                    name: way(self._values[name], places) for name, places in decimals.items()
                }
                places = " or ".join(map(str, sorted(set(decimals.values()))))
                yield self._made(OTHER_DECIMALS, f"{what} to {places}", PROGRAM + 0.1, fields)
        longer = self._longer()
        if longer:
            yield self._made(
                OTHER_DECIMALS, "each number to decimals of its own", PROGRAM + 0.2, longer
            )

    def _decimals(self) -> dict[str, int]:
        """For each result the most decimals that it, or one of the same kind, has on the page."""
        most: dict[int, int] = {}
        names = [name for name in self._values if self._text(name) is not None]
        for name in names:
            places = FIELDS[name].places or 0
            most[places] = max(most.get(places, 0), _decimals(self._text(name) or ""))
        return {name: most[FIELDS[name].places or 0] for name in names}

    def _text(self, name: str) -> str | None:
        reading = self._shown.fields.get(name)
        return reading.text if reading is not None and reading.clean else None

    def _longer(self) -> dict[str, str]:
        """Results that are the values to their own last decimals, if two of them have more than
        the listing's or an exponent; and the kinetic energy with them."""
        fields, more = {}, 0
        values = {**self._values, "KI": energy(self._scene)}
        for name, value in values.items():
            printed = self._text(name)
            own = value_of(printed or "") == value_of(self._outcome.fields.get(name, "?"))
            if printed is None or not (
                own or is_rounding(printed, value) or _in_single(printed, value)
            ):
                continue
            places = FIELDS[name].places
            longer = places is not None and (_decimals(printed) > places or "E" in printed)
            more += longer and not own
            fields[name] = printed
        return fields if more >= 2 else {}

    def other_units(self) -> Iterator[Hypothesis]:
        """Some results times a factor, to the page's decimals."""
        every = (
            *((note, _FINAL_SPEEDS, 1 / factor) for note, factor in SPEED_UNITS),
            *((note, _FINAL_SPEEDS + _CONTACT_SPEEDS, 1 / factor) for note, factor in SPEED_UNITS),
            *((note, _FINAL_SPINS, 1 / factor) for note, factor in SPIN_UNITS),
            *((note, ("KI",), 1 / factor) for note, factor in _ENERGY_UNITS),
            ("a fraction for percent", ("LOSS",), 0.01),
        )
        values = {**self._values, "KI": energy(self._scene)}
        for note, names, factor in every:
            fields = {}
            for name in names:
                printed = self._text(name)
                if name not in values or printed is None:
                    continue
                if _is_near(printed, values[name] * factor, FIELDS[name].places):
                    fields[name] = printed
                else:
                    fields[name] = rounded_text(values[name] * factor, FIELDS[name].places or 0)
            if fields:
                yield self._made(RESULT_UNITS, note, UNIT, fields)


def energy(scene: Mapping[str, str]) -> float:
    """Line 320 in double precision."""
    import numpy as np

    from ..recovery.search import kinetic_energy

    return float(
        kinetic_energy({name: np.array(value) for name, value in doubles_of(scene).items()})
    )


def _decimals(printed: str) -> int:
    return len(printed.partition("E")[0].partition(".")[2])


def is_rounding(printed: str, value: float, units: int = 1) -> bool:
    """Whether a text is a value to its own last place, rounded or cut, or off by so many of its
    units."""
    shown = value_of(printed)
    if shown is None or not math.isfinite(value):
        return False
    unit: Decimal = Decimal(1).scaleb(int(shown.as_tuple().exponent))
    return abs(Decimal(value) - shown) <= unit * units * Decimal("1.001") and unit < (
        abs(shown) or 1
    )


def _in_single(printed: str, value: float) -> bool:
    """Whether a text of seven digits is a value as single precision leaves it."""
    shown = value_of(printed)
    if shown is None or not math.isfinite(value) or len(shown.as_tuple().digits) > _SINGLE:
        return False
    return len(shown.as_tuple().digits) == _SINGLE and math.isclose(
        shown, value, rel_tol=_SINGLE_ERROR
    )


def _is_near(printed: str, value: float, places: int | None) -> bool:
    """Whether a text is a value to the listing's decimals or its own, if those are more."""
    shown = value_of(printed)
    if shown is None or not math.isfinite(value):
        return False
    if places is None:
        return is_rounding(printed, value)
    unit = 10.0 ** -max(places, _decimals(printed))
    return abs(float(shown) - value) <= 1.001 * unit + _SAME_TO * abs(value)


def rounded_text(value: float, places: int) -> str:
    """A value rounded to so many decimals, halves upward, as a program rounds and writes it."""
    return _written(lambda units: math.floor(units + 0.5), value, places)


def truncated_text(value: float, places: int) -> str:
    """A value cut toward zero to so many decimals, as a program cuts and writes it."""
    return _written(math.trunc, value, places)


def floored_text(value: float, places: int) -> str:
    """A value floored to so many decimals, as a program floors and writes it."""
    return _written(math.floor, value, places)


def _written(whole: Callable[[float], int], value: float, places: int) -> str:
    """Empty where no program's number has as many decimals, or is as large."""
    units = value * 10.0**places if places <= _MOST_PLACES else math.inf
    if not math.isfinite(units):
        return ""
    text = f"{Decimal(whole(units)).scaleb(-places):f}"
    return as_printed(text) or text


__all__ = [
    "Prints", "energy", "exchanged", "floored_text", "is_rounding", "rounded_text",
    "truncated_text",
]  # fmt: skip
