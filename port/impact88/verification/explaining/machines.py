"""Other machines and other ways to print as causes: who printed a page.

The listing is run in another arithmetic, and its results are floored, rounded or cut. Single
precision leaves the last digits open: how a machine rounds, takes a sine or squares shows in them.
So it is run several times, each time with every stored number moved within its last bit, and a
number counts as explained within the range of these runs, which must be narrow. What double
precision shows to be far from the page is not run.
"""

import math
import random
from collections.abc import Callable, Iterable, Iterator, Mapping
from copy import copy
from dataclasses import replace
from typing import Any

import numpy as np

from ...collision.doubles import double
from ...collision.fields import ANGLES, FIELDS, INPUTS
from ...program.arithmetics import APPLESOFT, FLOAT64, Arithmetic
from ..recovery import replays
from ..recovery.search import in_doubles
from .causes import NOT_APPLESOFT, Cause, PageEvidence, Range, as_printed, digits_of

_BITS = 14.0
"""Bits for another machine or way to print, about as for another unit (14.5); a tenth more for each
of its ranks, the commonest first, and a whole one for two of them together. All are less than two
results misread by one in their last places (36), which a rounded page looks like: doubled, two
such pages are not told."""
_SHAKEN = 6
"""Runs in single precision; with twice as many, or two, no page changes: ranges grow by a tenth."""
_OPEN_UNITS, _OPEN = 12, 3e-4
"""A result is left open by single precision within so many units of its last printed place, or
within this part of it; where it is more, the page is no evidence. Doubled, none
changes; without the units 15 of 28 pages of other machines do, without the part one."""
_APPLESOFT_DIGITS, _SINGLE_DIGITS = 9, 7
_PI = 3.14159265
"""That of line 300."""
_TIE = 2.0**-31
"""Part of a value by which the Apple's 32 bits may make a tie of it."""
CUTS: dict[str, Callable[[float], int]] = {
    "floored": math.floor,
    "rounded": lambda units: math.floor(units + 0.5),
    "truncated": math.trunc,
}
"""How programs bring a number to so many decimals; the listing floors."""
_DOUBLES = (("", 1, _PI), (" with exact pi", 4, math.pi), (" with pi = 3.1416", 5, 3.1416))
"""IEEE doubles: what is added, rank and pi."""
_PIS = ("3.1416", "3.14159", "3.1415927", "3.141592654", "3.14")
"""What offices' copies have in line 300."""


def causes(page: PageEvidence) -> Iterator[Cause]:
    """Every other machine and way to print, tried; of those of one kind the best."""
    known = all(reading.clean for reading in page.paper.fields.values())
    best: dict[str, Cause] = {}
    for cause in _causes(page):
        kind = f"{cause.kind} {cause.note}" if cause.note.startswith("on line") else cause.kind
        if kind not in best or len(cause.left) < len(best[kind].left):
            best[kind] = cause
    for cause in best.values():
        accused = NOT_APPLESOFT if known else ""
        yield replace(cause, note="; ".join(filter(None, [cause.note, accused])))


def _causes(page: PageEvidence) -> Iterator[Cause]:
    scene = page.recovered.scene
    # as another machine was given it: the printed numbers
    texts = {**page.recovered.assumed, **page.texts}
    typed = scene | {name: texts[name] for name in INPUTS if name in texts and name != "MUP"}
    numbers = (_PI, *(pi for _, _, pi in _DOUBLES), *map(float, _PIS))
    near = dict(zip(numbers, _near(page, typed, numbers), strict=True))
    if near[_PI]:
        run = _Run(page, scene, APPLESOFT)
        for how in ("rounded", "truncated"):
            yield run.cause(f"{how}, not floored", "", 0, run.cut(how))
            if lines := run.lines(how):
                where = f"on line{'s' * (len(lines) > 1)} {', '.join(map(str, lines))}"
                yield run.cause(f"{how}, not floored", where, 2, run.cut(how, lines))
        yield from _other_decimals(run)
        if all(digits_of(page.texts.get(name)) <= _SINGLE_DIGITS for name in (*INPUTS, "KI")):
            yield from _single_precision(page, typed)
    for variant, rank, pi in _DOUBLES:
        if near[pi]:
            run = _Run(page, typed, _with_pi(FLOAT64, pi))
            yield run.cause(f"IEEE double arithmetic{variant}", "", rank, {})
            for how in ("rounded", "truncated"):
                kind = f"IEEE double arithmetic, {how}, not floored"
                yield run.cause(kind, variant.strip(), rank + 10, run.cut(how))
    for text in _PIS:
        if near[float(text)]:
            run = _Run(page, typed, _with_pi(APPLESOFT, APPLESOFT.number(text)))
            yield run.cause("another pi in line 300", text, 3, {})


def _with_pi(arithmetic: Arithmetic, pi: Any) -> Arithmetic:
    made = copy(arithmetic)
    made._constants = {f"{_PI}": pi}
    return made


def _near(page: PageEvidence, scene: Mapping[str, str], pis: Iterable[float]) -> list[bool]:
    """Whether the page is near enough to the results with each pi, by double precision, that
    another arithmetic may explain it."""
    turned = np.array([*pis]) / math.pi
    columns = {n: np.full(len(turned), double(text)) for n, text in scene.items()}
    columns |= {name: columns[name] * turned for name in ANGLES}
    found = in_doubles(columns, list(page.results))
    return list(page.fits(found, len(turned), _OPEN_UNITS, _OPEN))


class _Run:
    """What one run of the listing prints: its fields, and its values before they are floored."""

    def __init__(self, page: PageEvidence, scene: Mapping[str, str], machine: Arithmetic) -> None:
        self.page, self.scene = page, scene
        self.outcome, self.values = replays.run_whole(scene, machine)
        self.energy = self.values.pop("KI", 0.0)
        self._own = as_printed(self.outcome)
        if "KI" in page.texts and self.energy and math.isfinite(self.energy):
            # to nine digits, halves either way, or to more, rounded or cut
            slack = 1.001 * 10.0 ** -page.decimals("KI")
            if digits_of(page.texts["KI"]) <= _APPLESOFT_DIGITS:
                last = math.floor(math.log10(abs(self.energy))) - _APPLESOFT_DIGITS + 1
                slack = 0.5001 * 10.0**last
            self._own["KI"] = self.energy - slack, self.energy + slack

    def cause(self, kind: str, note: str, rank: int, other: Mapping[str, Range]) -> Cause:
        """What it leaves unexplained, some of its results otherwise."""
        left = self.page.left(self.scene, self.outcome, (), {**self._own, **other})
        return Cause(kind, note, _BITS + 0.1 * rank, left)

    def cut(self, how: str, lines: Iterable[int] | None = None) -> dict[str, Range]:
        """The results, or those of some lines, cut to the listing's decimals."""
        return {
            name: cut(value, (FIELDS[name].places or 0), how)
            for name, value in self.values.items()
            if lines is None or FIELDS[name].line in lines
        }

    def lines(self, how: str) -> list[int]:
        """The lines whose results the page has so and not floored; none if all are or none is."""
        made, read = self.cut(how), self.page.texts
        every = {FIELDS[name].line for name in self.values}
        some = []
        for line in sorted(every):
            names = [name for name in self.values if FIELDS[name].line == line and name in read]
            if all(self.prints(name, made) for name in names) and not all(map(self.prints, names)):
                some.append(line)
        return some if len(some) < len(every) else []

    def prints(self, name: str, ranges: Mapping[str, Range] | None = None) -> bool:
        """Whether the page has just the number that is predicted."""
        low, high = (ranges or self._own).get(name, (math.nan, math.nan))
        return low <= float(self.page.texts[name]) <= high


def _other_decimals(run: _Run) -> Iterator[Cause]:
    """To the decimals that the page has, where those are not the listing's: floored or rounded, or
    of seven digits."""
    page = run.page
    own: dict[str, Range] = {}
    decimals, others = set(), 0
    for name, value in {**run.values, "KI": run.energy}.items():
        if name not in page.texts or run.prints(name):
            continue
        text = page.texts[name]
        number, places = float(text), page.decimals(name)
        single = digits_of(text) == _SINGLE_DIGITS
        slack = max(1.001 * 10.0**-places, abs(number) * (3e-6 if single else 2e-9))
        ranges = {how: cut(value, places, how) for how in ("rounded", "floored")}
        if 10.0**-places < (abs(number) or 1) or any(a <= number <= b for a, b in ranges.values()):
            own[name] = value - slack, value + slack
            if name != "KI":
                decimals.add(places)
                others += places != (FIELDS[name].places or 0) or "E" in text
    if others >= 2:
        said = " to ".join(map(str, sorted({min(decimals), max(decimals)}))) + " decimals"
        yield run.cause("printed with other decimals", said, 4, own)


def cut(value: float, places: int, how: str) -> Range:
    """A value brought to so many decimals, either way where the Apple's 32 bits may make a tie of
    it; nothing where no program prints it."""
    units = value * 10.0**places
    if not math.isfinite(units):
        return math.nan, math.nan
    slack = abs(units) * _TIE
    return CUTS[how](units - slack) / 10**places, CUTS[how](units + slack) / 10**places


# --- single precision ---


def _single_precision(page: PageEvidence, scene: Mapping[str, str]) -> Iterator[Cause]:
    run, exact = _Run(page, scene, single(0)), _Run(page, scene, FLOAT64)
    outcomes = [replays.run_once(scene, single(seed)) for seed in range(1, _SHAKEN + 1)]
    outcomes.append(run.outcome)
    if exact.outcome.ending or any(outcome.ending for outcome in outcomes):
        return
    ranges = {
        name: near
        for name in run.outcome.fields.keys() & page.texts.keys() - set(INPUTS)
        if name == "KI" or page.decimals(name) <= (FIELDS[name].places or 0)
        if (near := _left_open(name, [float(outcome.fields[name]) for outcome in outcomes]))
    }
    read = exact.values.keys() & page.texts.keys()
    how = max(CUTS, key=lambda how: sum(exact.prints(name, exact.cut(how)) for name in read))
    kind = "single-precision arithmetic" + ("" if how == "floored" else f", {how}, not floored")
    yield run.cause(kind, "as in GW-BASIC and similar BASICs", 4, ranges)


def _left_open(name: str, numbers: list[float]) -> Range | None:
    """What the runs leave open of a result, if that is little."""
    size, spread = max(map(abs, numbers)), max(numbers) - min(numbers)
    places = FIELDS[name].places
    if places is None:
        places = _SINGLE_DIGITS - 1 - math.floor(math.log10(size)) if size else 0
    unit = 10.0**-places
    if spread > max(_OPEN_UNITS * unit, _OPEN * size):
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
