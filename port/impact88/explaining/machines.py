"""Other machines and other ways to print as causes: who printed a page.

The listing is run in another arithmetic, and its results are floored, rounded or cut. Single
precision leaves the last digits open: how a machine rounds, takes a sine or squares shows in them.
So it is run several times, each time with every stored number moved within its last bit, and a
number counts as explained within the range of these runs, which must be narrow.
"""

import math
import random
from collections.abc import Iterable, Iterator, Mapping
from copy import copy
from decimal import Decimal
from typing import Any

import numpy as np

from ..fields import ANGLES, FIELDS, INPUTS
from ..program.arithmetics import APPLESOFT, FLOAT64, Arithmetic
from ..reading import numerals
from ..recovery import replays
from ..recovery.typedtext import with_opposite_mu
from .predictions import (
    CUTS,
    NOT_APPLESOFT,
    Cause,
    Evidence,
    Range,
    around,
    as_printed,
    cut,
    digits_of,
    places_of,
    within,
)

_SOME_LINES = 14.2
"""Bits for an office's copy that rounds on some lines: more than for another arithmetic (14), less
than for a last place misread (18), which a rounded one looks like."""
_CUT = 13.0
"""Bits for results rounded or truncated by the program itself; one more by another machine."""
_DECIMALS = 14.5
"""Bits for results to other decimals: as for another unit."""
_SINGLE, _NO_EVIDENCE = 14.5, 4.0
"""Bits for single precision, and more where the kinetic energy has no more digits in double
precision either."""
_SHAKEN = 6
"""Runs in single precision; with twice as many the ranges grow by a tenth."""
_OPEN_UNITS, _OPEN = 12, 3e-4
"""A result is left open by single precision within so many units of its last printed place, or
within this part of it; where it is more, the page is no evidence."""
_LONG = 7
"""Angles of so many digits came back from radians a little off: 59.99999 was 60."""
_APPLESOFT_DIGITS, _SINGLE_DIGITS = 9, 7


def _with_pi(arithmetic: Arithmetic, pi: Any) -> Arithmetic:
    made = copy(arithmetic)
    made._constants = {"3.14159265": pi}
    return made


_DOUBLES: tuple[tuple[str, float, Arithmetic], ...] = (
    ("", 14.0, FLOAT64),
    (" with exact pi", 14.5, _with_pi(FLOAT64, math.pi)),
    (" with pi = 3.1416", 15.0, _with_pi(FLOAT64, 3.1416)),
)
_OTHER_PI = 14.3
_PIS = ("3.1416", "3.14159", "3.1415927", "3.141592654", "3.14")


def causes(evidence: Evidence) -> Iterator[Cause]:
    """Every other machine and way to print, tried; of those of one kind the best."""
    known = all(reading.clean for reading in evidence.shown.fields.values())
    best: dict[str, Cause] = {}
    for one in _causes(evidence):
        kind = f"{one.kind} {one.note}" if one.bits == _SOME_LINES else one.kind
        if kind not in best or len(one.wrong) < len(best[kind].wrong):
            best[kind] = one
    for one in best.values():
        accused = NOT_APPLESOFT if known else ""
        yield one._replace(note="; ".join(filter(None, [one.note, accused])))


def _causes(evidence: Evidence) -> Iterator[Cause]:
    found = evidence.recovered.scene
    for scene in (found, *with_opposite_mu(found)):
        page = _Page(evidence, scene, APPLESOFT)
        for how in ("rounded", "truncated"):
            yield page.cause(f"{how}, not floored", "", _CUT, page.cut(how))
            if lines := page.lines(how):
                where = f"on line{'s' * (len(lines) > 1)} {', '.join(map(str, lines))}"
                yield page.cause(f"{how}, not floored", where, _SOME_LINES, page.cut(how, lines))
        yield from _other_decimals(page)
    typed, spared = _as_typed(evidence)
    single = all(evidence.digits(name) <= _SINGLE_DIGITS for name in (*INPUTS, "KI"))
    for scene in (typed, *with_opposite_mu(typed)):
        for variant, bits, machine in _DOUBLES:
            page = _Page(evidence, scene, machine, spared)
            yield page.cause(f"IEEE double arithmetic{variant}", "", bits, {})
            for how in ("rounded", "truncated"):
                kind = f"IEEE double arithmetic, {how}, not floored"
                yield page.cause(kind, variant.strip(), bits + 1, page.cut(how))
        for pi in _PIS:
            page = _Page(evidence, scene, _with_pi(APPLESOFT, APPLESOFT.number(pi)), spared)
            yield page.cause("another pi in line 300", pi, _OTHER_PI, {})
        if single:
            yield from _single_precision(evidence, scene, spared)


class _Page:
    """What one run of the listing prints: its fields, and its values before they are floored."""

    def __init__(
        self,
        evidence: Evidence,
        scene: dict[str, str],
        machine: Arithmetic,
        spared: frozenset[str] = frozenset(),
    ) -> None:
        self.evidence, self.scene = evidence, scene
        self.outcome, values = replays.run_whole(scene, machine)
        self.values = {name: one for name, one in values.items() if name != "KI"}
        self.energy = values.get("KI", 0.0) if "KI" in evidence.texts else 0.0
        self._own = as_printed(self.outcome) | self._energy()
        self._inputs = {n: text for n, text in self.outcome.fields.items() if n not in spared}

    def _energy(self) -> dict[str, Range]:
        """The kinetic energy as the page may have it: to nine digits, halves either way, or to
        more, rounded or cut."""
        if not self.energy or not math.isfinite(self.energy):
            return {}
        if self.evidence.digits("KI") > _APPLESOFT_DIGITS:
            slack = Decimal("1.001").scaleb(-self.evidence.decimals("KI"))
        else:
            last = Decimal(self.energy).adjusted() - _APPLESOFT_DIGITS + 1
            slack = Decimal("0.5001").scaleb(last)
        near = around(self.energy, slack)
        return {"KI": near} if near else {}

    def cause(self, kind: str, note: str, bits: float, other: Mapping[str, Range]) -> Cause:
        """What it leaves unexplained, some of its results otherwise."""
        wrong = self.evidence.differing({**self._own, **other}, self.outcome.ending, self._inputs)
        return Cause(kind, note, bits, self.scene, wrong)

    def cut(self, how: str, lines: Iterable[int] | None = None) -> dict[str, Range]:
        """The results, or those of some lines, cut to the listing's decimals."""
        return {
            name: made
            for name, one in self.values.items()
            if (lines is None or FIELDS[name].line in lines)
            and (made := cut(one, places_of(name), how))
        }

    def lines(self, how: str) -> list[int]:
        """The lines whose results the page has so and not floored; none if all are or none is."""
        made, read = self.cut(how), self.evidence.texts
        every = {FIELDS[name].line for name in self.values}
        some = []
        for line in sorted(every):
            names = [name for name in self.values if FIELDS[name].line == line and name in read]
            if all(self.prints(name, made) for name in names) and not all(map(self.prints, names)):
                some.append(line)
        return some if len(some) < len(every) else []

    def prints(self, name: str, ranges: Mapping[str, Range] | None = None) -> bool:
        """Whether the page has just the number that is predicted."""
        return within(Decimal(self.evidence.texts[name]), (ranges or self._own).get(name))


def _other_decimals(page: _Page) -> Iterator[Cause]:
    """To the decimals that the page has, where those are not the listing's: floored or rounded, or
    of seven digits."""
    evidence = page.evidence
    own: dict[str, Range] = {}
    decimals, others = set(), 0
    for name in [*page.values, "KI"]:
        value = page.energy if name == "KI" else page.values[name]
        if name not in evidence.texts or page.prints(name):
            continue
        number = Decimal(evidence.texts[name])
        unit = Decimal(1).scaleb(int(number.as_tuple().exponent))
        single = len(number.as_tuple().digits) == _SINGLE_DIGITS
        slack = max(unit * Decimal("1.001"), abs(number) * Decimal("3E-6" if single else "2E-9"))
        near = around(value, slack)
        cuts = [cut(value, evidence.decimals(name), how) for how in ("rounded", "floored")]
        if near and (unit < (abs(number) or 1) or any(within(number, made) for made in cuts)):
            own[name] = near
            if name != "KI":
                decimals.add(evidence.decimals(name))
                others += evidence.decimals(name) != places_of(name) or "E" in evidence.texts[name]
    if others >= 2:
        said = " to ".join(map(str, sorted({min(decimals), max(decimals)}))) + " decimals"
        yield page.cause("printed with other decimals", said, _DECIMALS, own)


# --- single precision ---


def _single_precision(
    evidence: Evidence, scene: dict[str, str], spared: frozenset[str]
) -> Iterator[Cause]:
    outcomes = [replays.run_once(scene, single(seed)) for seed in range(_SHAKEN + 1)]
    exact, values = replays.run_whole(scene, FLOAT64)
    if exact.ending or any(outcome.ending for outcome in outcomes):
        return
    page = _Page(evidence, scene, single(0), spared)
    ranges = {
        name: near
        for name in outcomes[0].fields
        if name not in INPUTS
        and (near := _left_open(name, [outcome.fields.get(name) for outcome in outcomes]))
        and name in evidence.texts
        and (name == "KI" or evidence.decimals(name) <= places_of(name))
    }
    fits = {
        how: sum(
            within(Decimal(text), cut(values[name], places_of(name), how))
            for name, text in evidence.texts.items()
            if name in values and name != "KI"
        )
        for how in CUTS
    }
    how = max(fits, key=fits.__getitem__)
    kind = "single-precision arithmetic" + ("" if how == "floored" else f", {how}, not floored")
    evident = digits_of(exact.fields.get("KI")) > _SINGLE_DIGITS
    note = "as in GW-BASIC and similar BASICs"
    yield page.cause(kind, note, _SINGLE + (0.0 if evident else _NO_EVIDENCE), ranges)


def _left_open(name: str, every: list[str | None]) -> Range | None:
    """What the runs leave open of a result, if that is little."""
    numbers = [number for text in every if (number := numerals.value_of(text or "")) is not None]
    if len(numbers) < len(every):
        return None
    size, spread = max(map(abs, numbers)), max(numbers) - min(numbers)
    places = FIELDS[name].places
    unit = Decimal(1).scaleb(size.adjusted() - _SINGLE_DIGITS + 1 if places is None else -places)
    if spread > max(_OPEN_UNITS * unit, Decimal(_OPEN) * size):
        return None
    return min(numbers) - spread - unit, max(numbers) + spread + unit


def single(seed: int) -> Arithmetic:
    """Double precision of which every number that is read, stored or looked up keeps 24 bits, as
    the single-precision BASICs of other machines have them (GW-BASIC, BASICA); with a seed, moved
    by up to one unit of the last bit, whole numbers excepted."""
    rng = random.Random(seed)

    def store(x: float) -> float:
        moved = seed and not x.is_integer()
        return float(np.float32(x * (1 + rng.choice((-1, 0, 1)) * 2.0**-23) if moved else x))

    def read(text: str, start: int) -> tuple[float, int]:
        value, end = FLOAT64.read(text, start)
        return float(np.float32(value)), end

    made = copy(FLOAT64)
    made._constants = {}
    made.read, made.LET = read, store
    made.write = lambda x: FLOAT64.write(float(f"{x or 0.0:.{_SINGLE_DIGITS - 1}E}"))
    made.SIN, made.COS = (lambda x: store(math.sin(x))), (lambda x: store(math.cos(x)))
    return made


# --- the scene as another machine was given it ---


def _as_typed(evidence: Evidence) -> tuple[dict[str, str], frozenset[str]]:
    """The printed numbers, and the names of angles that came back from radians a little off."""
    scene = dict(evidence.recovered.scene)
    scene |= {
        name: text
        for name, text in {**evidence.recovered.assumed, **evidence.texts}.items()
        if name in INPUTS and name != "MUP"
    }
    return scene, frozenset(name for name in ANGLES if digits_of(scene[name]) >= _LONG)
