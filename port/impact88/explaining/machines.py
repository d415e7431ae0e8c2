"""Other machines and other ways to print as causes: who printed a page.

The listing is run in another arithmetic, and its results are floored, rounded or cut. Single
precision leaves the last digits open: how a machine rounds, takes a sine or squares shows in them.
So it is run several times, each time with every stored number moved within its last bit, and a
number counts as explained within the range of these runs, which must be narrow.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator, Mapping
from copy import copy
from decimal import Decimal
from typing import Any

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
)

SOME_LINES = 14.2
"""Bits for an office's copy that rounds on some lines: more than for another arithmetic (14), less
than for a last place misread (18), which a rounded one looks like."""
_OWN = {"rounded": 13.0, "truncated": 13.0}
"""Bits for results cut otherwise by the program itself; a bit more by another machine."""
_DECIMALS = {"rounded": 14.0, "floored": 14.0, "own": 15.0}
_SHAKEN = 6
"""Runs in single precision; with twice as many the ranges grow by a tenth."""
_OPEN_UNITS, _OPEN = 12, 3e-4
"""A result is left open by single precision within so many units of its last printed place, or
within this part of it; where it is more, the page is no evidence."""
_NO_EVIDENCE = 4.0
"""Bits added where the kinetic energy has no more digits in double precision either."""
_LONG = 7
"""Angles of so many digits came back from radians a little off."""
_APPLESOFT_DIGITS, SINGLE_DIGITS = 9, 7


def _with_pi(arithmetic: Arithmetic, pi: Any) -> Arithmetic:
    made = copy(arithmetic)
    made._constants = {"3.14159265": pi}
    return made


_MACHINES: tuple[tuple[str, str, float, Callable[[], Arithmetic]], ...] = (
    ("IEEE double arithmetic", "", 14.0, lambda: FLOAT64),
    ("IEEE double arithmetic", " with exact pi", 14.5, lambda: _with_pi(FLOAT64, math.pi)),
    ("IEEE double arithmetic", " with pi = 3.1416", 15.0, lambda: _with_pi(FLOAT64, 3.1416)),
    *(
        (
            "another pi in line 300",
            f", {text}",
            14.3,
            lambda text=text: _with_pi(APPLESOFT, APPLESOFT.number(text)),
        )
        for text in ("3.1416", "3.14159", "3.1415927", "3.141592654", "3.14")
    ),
)  # fmt: skip


def causes(evidence: Evidence) -> Iterator[Cause]:
    """Every other machine and way to print, tried; of those of one kind the best."""
    known = all(reading.clean for reading in evidence.shown.fields.values())
    best: dict[str, Cause] = {}
    for one in _causes(evidence):
        kind = f"{one.kind} {one.note}" if one.bits == SOME_LINES else one.kind
        if kind not in best or len(one.wrong) < len(best[kind].wrong):
            best[kind] = one
    for one in best.values():
        accused = NOT_APPLESOFT if known else ""
        yield one._replace(note="; ".join(filter(None, [one.note, accused])))


def _causes(evidence: Evidence) -> Iterator[Cause]:
    for scene in _either_sign(evidence.recovered.scene):
        outcome, values = replays.run_whole(scene)
        page = _Page(evidence, scene, outcome, values)
        for how, bits in _OWN.items():
            yield page.cause(f"{how}, not floored", "", bits, page.cut(how))
            lines = page.lines(how)
            if lines:
                where = f"on line{'' if len(lines) == 1 else 's'} {', '.join(map(str, lines))}"
                yield page.cause(f"{how}, not floored", where, SOME_LINES, page.cut(how, lines))
        yield from _other_decimals(page)
    typed, spared = _as_typed(evidence)
    for scene in _either_sign(typed):
        for kind, variant, bits, machine in _MACHINES:
            page = _Page(evidence, scene, *replays.run_whole(scene, machine()), spared)
            so = "float64 prints so" if not variant else "double precision prints so"
            if kind.startswith("another"):
                yield page.cause(kind, variant.removeprefix(", "), bits, {})
                continue
            yield page.cause(f"{kind}{variant}", so, bits, {})
            for how in _OWN:
                so = f"double precision{variant} prints so"
                yield page.cause(f"{kind}, {how}, not floored", so, bits + 1, page.cut(how))
        if evidence.digits("KI") <= SINGLE_DIGITS and all(
            evidence.digits(name) <= SINGLE_DIGITS for name in INPUTS
        ):
            yield from _single_causes(evidence, scene, spared)


class _Page:
    """What one run of the listing prints: its fields, and its values before they are floored."""

    def __init__(
        self,
        evidence: Evidence,
        scene: dict[str, str],
        outcome: replays.Outcome,
        values: Mapping[str, float],
        spared: frozenset[str] = frozenset(),
    ) -> None:
        self.evidence, self.scene, self.outcome = evidence, scene, outcome
        self.values = {name: one for name, one in values.items() if name != "KI"}
        self.energy = values.get("KI", 0.0) if "KI" in evidence.texts else 0.0
        self._own = as_printed(outcome) | _energy(evidence, values)
        self._inputs = {n: text for n, text in outcome.fields.items() if n not in spared}

    def cause(self, kind: str, note: str, bits: float, other: Mapping[str, Range]) -> Cause:
        """What it leaves unexplained, some of its results otherwise."""
        wrong = self.evidence.differing({**self._own, **other}, self.outcome.ending, self._inputs)
        return Cause(kind, note, bits, self.scene, wrong)

    def cut(self, how: str, lines: list[int] | None = None) -> dict[str, Range]:
        """The results, or those of some lines, cut to the listing's decimals."""
        return {
            name: made
            for name, one in self.values.items()
            if (lines is None or FIELDS[name].line in lines)
            and (made := cut(one, places_of(name), how))
        }

    def lines(self, how: str) -> list[int]:
        """The lines whose results the page has so and not floored; none if all are or none is."""
        made, texts = self.cut(how), self.evidence.texts
        every: dict[int, list[str]] = {}
        for name in self.values:
            every.setdefault(FIELDS[name].line, []).append(name)
        some = [
            line
            for line, names in every.items()
            if all(name not in texts or self.prints(name, made) for name in names)
            and any(name in texts and not self.prints(name) for name in names)
        ]
        return some if len(some) < len(every) else []

    def prints(self, name: str, ranges: Mapping[str, Range] | None = None) -> bool:
        """Whether the page has just the number that is predicted."""
        predicted = (ranges or self._own).get(name)
        number = numerals.value_of(self.evidence.texts[name])
        return predicted is not None and number is not None and number == predicted[0]


def _energy(evidence: Evidence, values: Mapping[str, float]) -> dict[str, Range]:
    """The kinetic energy as the page may have it: to nine digits, halves either way, or to more,
    rounded or cut."""
    if "KI" not in values or "KI" not in evidence.texts or not math.isfinite(values["KI"]):
        return {}
    number = Decimal(values["KI"])
    if evidence.digits("KI") > _APPLESOFT_DIGITS:
        near = around(values["KI"], Decimal("1.001").scaleb(-evidence.decimals("KI")))
    else:
        unit = Decimal(1).scaleb(number.adjusted() - _APPLESOFT_DIGITS + 1)
        near = around(values["KI"], Decimal("0.5001") * unit)
    return {"KI": near} if near else {}


def _other_decimals(page: _Page) -> Iterator[Cause]:
    """To as many decimals as the page has, where those are not the listing's: as many for all
    results of a kind, or each number to its own."""
    evidence = page.evidence
    names = [name for name in page.values if name in evidence.texts]
    most: dict[int, int] = {}
    for name in names:
        most[places_of(name)] = max(most.get(places_of(name), 0), evidence.decimals(name))
    kind = "printed with other decimals"
    if any(listed != places for listed, places in most.items()):
        said = " or ".join(map(str, sorted(set(most.values()))))
        for how in ("rounded", "floored"):
            made = {n: cut(page.values[n], most[places_of(n)], how) for n in names}
            ranges = {name: one for name, one in made.items() if one}
            yield page.cause(kind, f"{how} to {said}", _DECIMALS[how], ranges)
    own, longer = {}, 0
    for name in [*names, *(["KI"] if page.energy else [])]:
        if page.prints(name):
            continue
        number = Decimal(evidence.texts[name])
        unit = Decimal(1).scaleb(int(number.as_tuple().exponent))
        single_digits = len(number.as_tuple().digits) == SINGLE_DIGITS
        error = abs(number) * Decimal("3E-6" if single_digits else "2E-9")
        slack = max(unit * Decimal("1.001"), error)
        near = around(page.energy if name == "KI" else page.values[name], slack)
        if near and unit < (abs(number) or 1):
            own[name] = near
            more = evidence.decimals(name) > places_of(name) or "E" in evidence.texts[name]
            longer += more and name != "KI"
    if longer >= 2:
        yield page.cause(kind, "each number to decimals of its own", _DECIMALS["own"], own)


# --- single precision ---


def _single_causes(
    evidence: Evidence, scene: dict[str, str], spared: frozenset[str]
) -> Iterator[Cause]:
    runs = [replays.run_whole(scene, single(seed)) for seed in range(_SHAKEN + 1)]
    exact, values = replays.run_whole(scene, "float64")
    (plain, _), *_ = runs
    if exact.ending or any(outcome.ending for outcome, _ in runs):
        return
    page = _Page(evidence, scene, plain, {}, spared)
    ranges = {
        name: near
        for name in plain.fields
        if name not in INPUTS
        and (near := _left_open(name, [outcome.fields.get(name) for outcome, _ in runs]))
        and name in evidence.texts
        and (name == "KI" or evidence.decimals(name) <= places_of(name))
    }
    counts = {
        how: sum(
            evidence.texts.get(name) is not None
            and (made := cut(one, places_of(name), how)) is not None
            and made[0] == Decimal(evidence.texts[name])
            for name, one in values.items()
            if name != "KI"
        )
        for how in CUTS
    }
    how = max(counts, key=counts.__getitem__)
    kind = "single-precision arithmetic" + ("" if how == "floored" else f", {how}, not floored")
    evident = digits_of(exact.fields.get("KI")) > SINGLE_DIGITS
    note = "as GW-BASIC and its like compute and print"
    yield page.cause(kind, note, 14.5 + (0.0 if evident else _NO_EVIDENCE), ranges)


def _left_open(name: str, every: list[str | None]) -> Range | None:
    """What the runs leave open of a result, if that is little."""
    numbers = [number for text in every if (number := numerals.value_of(text or "")) is not None]
    if len(numbers) < len(every):
        return None
    size, spread = max(map(abs, numbers)), max(numbers) - min(numbers)
    places = FIELDS[name].places
    unit = Decimal(1).scaleb(size.adjusted() - SINGLE_DIGITS + 1 if places is None else -places)
    if spread > max(_OPEN_UNITS * unit, Decimal(_OPEN) * size):
        return None
    return min(numbers) - spread - unit, max(numbers) + spread + unit


def single(seed: int) -> Arithmetic:
    """Double precision of which every number that is read, stored or looked up keeps 24 bits, as
    the single-precision BASICs of other machines have them (GW-BASIC, BASICA); with a seed, moved
    by up to one unit of the last bit, whole numbers excepted."""
    import numpy as np

    rng = random.Random(seed)

    def store(x: float) -> float:
        moved = seed and not x.is_integer()
        return float(np.float32(x * (1 + rng.choice((-1, 0, 1)) * 2.0**-23) if moved else x))

    def read(text: str, start: int) -> tuple[float, int]:
        value, end = FLOAT64.read(text, start)
        return float(np.float32(value)), end

    def write(x: float) -> str:
        digits = "0" if x == 0 else f"{x:.{SINGLE_DIGITS - 1}E}"
        return FLOAT64.write(float(digits))

    made = copy(FLOAT64)
    made._constants = {}
    made.read, made.LET, made.write = read, store, write
    made.SIN, made.COS = (lambda x: store(math.sin(x))), (lambda x: store(math.cos(x)))
    return made


# --- the scene as another machine was given it ---


def _either_sign(scene: dict[str, str]) -> Iterator[dict[str, str]]:
    yield scene
    yield from with_opposite_mu(scene)


def _as_typed(evidence: Evidence) -> tuple[dict[str, str], frozenset[str]]:
    """The printed numbers, with what the way into radians and back did to angles undone, and the
    names of those angles."""
    scene = dict(evidence.recovered.scene)
    spared = set()
    for name, text in {**evidence.recovered.assumed, **evidence.texts}.items():
        if name not in INPUTS or name == "MUP":
            continue
        scene[name] = _undone(text) if name in ANGLES else text
        if scene[name] != text:
            spared.add(name)
    return scene, frozenset(spared)


def _undone(text: str) -> str:
    """An angle without what is left of its way into radians and back: 59.99999 was 60."""
    value, digits = numerals.value_of(text), digits_of(text)
    if value is None or digits < _LONG:
        return text
    near = Decimal(f"{value:.{digits - 3}E}").normalize()
    if digits_of(f"{near:f}") > digits - 3:
        return text
    return numerals.as_printed(f"{near:f}") or text
