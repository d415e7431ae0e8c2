"""Other machines than the Apple as hypotheses about who printed a page.

Double precision prints what it prints, and its runs are compared digit for digit. Single precision
leaves the last digits open: how a machine rounds, takes a sine or squares shows in them. So single
precision is run several times, each time with every stored number moved within its last bit, and a
printed number counts as explained when it lies in the range that leaves open, which must be narrow.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal

from ..fields import ANGLES, FIELDS, INPUTS
from ..reading.numerals import as_printed, value_of
from ..reading.printout import Printout
from ..recovery import replays
from ..recovery.choices import with_opposite_mu
from ..recovery.recovered import Recovered
from . import otherarithmetic
from .hypothesis import (
    ARITHMETIC,
    DECIMAL,
    DOUBLE,
    DOUBLE_PI,
    DOUBLE_ROUNDED,
    DOUBLE_TRUNCATED,
    NOT_APPLESOFT,
    OTHER_PI,
    SINGLE,
    SINGLE_ROUNDED,
    SINGLE_TRUNCATED,
    Hypothesis,
)
from .otherprints import Cut, energy, floored_text, is_rounding, rounded_text, truncated_text

_SHAKEN = 6
"""Runs in single precision, each with other last bits."""
_OPEN_UNITS, _OPEN = 12, 3e-4
"""A result is left open by single precision within so many units of its last printed place, or
within this part of it; where it is more, the page bears no witness."""
_NO_EVIDENCE = 0.45
"""Added where the kinetic energy has no more digits in double precision either."""
_DECIMAL_UNITS = 6
"""What a few sums to a decimal machine's last digit may leave open in it."""
_LONG = 7
"""Angles of so many digits came back from radians a little off."""


class Machines:
    """The hypotheses of one printout."""

    def __init__(self, shown: Printout, recovered: Recovered) -> None:
        self._shown = shown
        self._recovered = recovered
        self._texts = {
            name: reading.text
            for name, reading in shown.fields.items()
            if reading.clean and value_of(reading.text) is not None
        }
        known = all(reading.clean for reading in shown.fields.values())
        self._apart = f"; {NOT_APPLESOFT}" if known else ""
        self._spared = frozenset[str]()

    def all(self) -> Iterator[Hypothesis]:
        """Double precision and decimal machines, and single precision if the page may be its."""
        for scene in self._as_typed():
            yield from self._doubles(scene)
            yield from self._decimals(scene)
            if self._digits("KI") <= otherarithmetic.SINGLE_DIGITS and self._short_inputs():
                yield from self._singles(scene)

    def _made(
        self, kind: str, note: str, scene: dict[str, str], outcome: replays.Outcome, add: float
    ) -> Hypothesis:
        weight = ARITHMETIC + add
        note += self._apart
        return Hypothesis(kind, note, weight, (), scene, outcome, self._spared)

    def _as_typed(self) -> Iterator[dict[str, str]]:
        """The scene as another machine would have been given it: the printed numbers, with what
        the way into radians and back did to angles undone."""
        scene = dict(self._recovered.scene)
        spared = set()
        for name, text in {**self._recovered.assumed, **self._texts}.items():
            if name not in INPUTS or name == "MUP":
                continue
            scene[name] = _undone(text) if name in ANGLES else text
            if scene[name] != text:
                spared.add(name)
        self._spared = frozenset(spared)
        yield scene
        yield from with_opposite_mu(scene)

    def _digits(self, name: str) -> int:
        """How many digits a number has on the page."""
        value = value_of(self._texts.get(name, ""))
        return 0 if value is None else len(value.normalize().as_tuple().digits)

    def _short_inputs(self) -> bool:
        return all(self._digits(name) <= otherarithmetic.SINGLE_DIGITS for name in INPUTS)

    # --- double precision ---

    def _doubles(self, scene: dict[str, str]) -> Iterator[Hypothesis]:
        outcome, values = replays.run_whole(scene, "float64")
        outcome = self._longer_energy(scene, outcome)
        so = "float64 prints so"
        yield self._made(DOUBLE, so, scene, outcome, 0.0)
        for kind, way in ((DOUBLE_ROUNDED, rounded_text), (DOUBLE_TRUNCATED, truncated_text)):
            yield self._made(kind, so, scene, _cut(outcome, values, way), 0.1)
        for kind, pi, add in ((DOUBLE_PI, "exact", 0.05), (OTHER_PI, "3.1416", 0.1)):
            other = replays.run_on(scene, otherarithmetic.with_pi(pi))
            other = self._longer_energy(scene, other)
            yield self._made(kind, "double precision prints so", scene, other, add)

    def _longer_energy(
        self, scene: Mapping[str, str], outcome: replays.Outcome, units: int = 1
    ) -> replays.Outcome:
        """The outcome with KE as the page has it, if that is another way to write it: to more
        digits than nine (``units``: how far off the last of them may be), in full where Applesoft
        has an exponent, or the ninth digit rounded otherwise where it is halfway."""
        text = self._texts.get("KI")
        if text is None or "KI" not in outcome.fields:
            return outcome
        if self._digits("KI") > _APPLESOFT_DIGITS:
            same = is_rounding(text, energy(scene), units)
        else:
            same = value_of(text) == value_of(outcome.fields["KI"]) or _nine_digits(
                text, energy(scene)
            )
        return replays.Outcome({**outcome.fields, "KI": text}, outcome.ending) if same else outcome

    # --- decimal machines ---

    def _decimals(self, scene: dict[str, str]) -> Iterator[Hypothesis]:
        for context in otherarithmetic.DECIMAL_CONTEXTS:
            with otherarithmetic.localcontext(context):
                outcome = replays.run_on(scene, otherarithmetic.decimal())
            outcome = self._longer_energy(scene, outcome, _DECIMAL_UNITS)
            note = f"as machines with {context.prec} decimal digits compute"
            yield self._made(DECIMAL, note, scene, outcome, 0.1)

    # --- single precision ---

    def _singles(self, scene: dict[str, str]) -> Iterator[Hypothesis]:
        plain = replays.run_on(scene, otherarithmetic.single())
        runs = [replays.run_on(scene, otherarithmetic.shaken(seed)) for seed in range(_SHAKEN)]
        exact, values = replays.run_whole(scene, "float64")
        if plain.ending or exact.ending or any(run.ending for run in runs):
            return
        fields = dict(plain.fields)
        for name in fields:
            text = self._texts.get(name)
            every = [run.fields.get(name) for run in (plain, *runs)]
            if text is not None and name not in INPUTS and _left_open(name, text, every):
                fields[name] = text
        note = "as GW-BASIC and its like compute and print"
        evident = _digits_of(exact.fields.get("KI")) > otherarithmetic.SINGLE_DIGITS
        kind = self._cut_so(values)
        add = 0.05 if evident else _NO_EVIDENCE
        yield self._made(kind, note, scene, replays.Outcome(fields, plain.ending), add)

    def _cut_so(self, values: Mapping[str, float]) -> str:
        """Whether the page's results are floored, rounded or cut, by how many say so."""
        ways = ((SINGLE, floored_text), (SINGLE_ROUNDED, rounded_text))
        counts = {kind: 0 for kind, _ in ways}
        counts[SINGLE_TRUNCATED] = 0
        for kind, way in (*ways, (SINGLE_TRUNCATED, truncated_text)):
            for name, value in values.items():
                places = FIELDS[name].places or 0
                counts[kind] += self._texts.get(name) == way(value, places)
        return max(counts, key=lambda kind: counts[kind])


_APPLESOFT_DIGITS = 9


def _nine_digits(text: str, value: float) -> bool:
    """Whether a text is a value to nine digits, halves up or down."""
    shown = value_of(text)
    if shown is None or not math.isfinite(value):
        return False
    unit = Decimal(1).scaleb(Decimal(value).adjusted() - _APPLESOFT_DIGITS + 1)
    return abs(Decimal(value) - shown) <= unit * Decimal("0.5001")


def _digits_of(text: str | None) -> int:
    value = value_of(text or "")
    return 0 if value is None else len(value.normalize().as_tuple().digits)


def _undone(text: str) -> str:
    """An angle without what is left of its way into radians and back: 59.99999 was 60."""
    value = value_of(text)
    digits = _digits_of(text)
    if value is None or digits < _LONG:
        return text
    near = Decimal(f"{value:.{digits - 3}E}").normalize()
    if len(near.as_tuple().digits) > digits - 3:
        return text
    return as_printed(f"{near:f}") or text


def _left_open(name: str, text: str, every: Sequence[str | None]) -> bool:
    """Whether a printed number lies within what the runs leave open, and that is little."""
    shown = value_of(text)
    places = FIELDS[name].places
    decimals = 0 if shown is None else -int(shown.normalize().as_tuple().exponent)
    if places is not None and decimals > places:
        return False  # to more decimals than the listing floors to
    numbers = [value for one in every if (value := value_of(one or "")) is not None]
    if shown is None or len(numbers) < len(every):
        return False
    size = max(map(abs, numbers))
    if places is None:
        unit = Decimal(1).scaleb(size.adjusted() - otherarithmetic.SINGLE_DIGITS + 1)
    else:
        unit = Decimal(1).scaleb(-places)
    low, high = min(numbers), max(numbers)
    spread = high - low
    if spread > max(_OPEN_UNITS * unit, Decimal(_OPEN) * size):
        return False
    return low - spread - unit <= shown <= high + spread + unit


def _cut(outcome: replays.Outcome, values: Mapping[str, float], way: Cut) -> replays.Outcome:
    """The outcome with the floored fields cut otherwise, to the same places."""
    other = {name: way(value, FIELDS[name].places or 0) for name, value in values.items()}
    return replays.Outcome({**outcome.fields, **other}, outcome.ending)


__all__ = ["Machines"]
