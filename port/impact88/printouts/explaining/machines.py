"""Other machines and other ways to print, as causes of a page.

The listing is run in another arithmetic, and its results are floored, rounded or cut. Single
precision leaves the last digits open: how a machine rounds, takes a sine or squares shows in them.
So it is run several times, each time with every stored number perturbed within its last bit, and a
number counts as explained within the range of these runs, which must be narrow. Machines that
double precision shows to be far from the page are not run.
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
from ..recovery.search import printed_in_doubles
from .causes import NOT_APPLESOFT, Cause, PageEvidence, Range, as_printed, digits_of

_BITS = 14.0
"""Bits of another machine or way to print, about as for another unit (14.5); a tenth is added for
each rank, the commonest first, and a whole bit for two of them together. All are less than two
results misread by one in their last places (36), which a rounded page resembles: doubled, two such
pages are not recognized."""
PERTURBED_RUNS = 6
"""Runs in single precision; with twice as many, or two, no page changes: ranges grow by a tenth."""
MAX_RANGE_UNITS = 12
"""Widest range of a result in single precision, in units of its last printed place. Doubled, no
page changes; without it, 15 of 28 pages of other machines do."""
MAX_RANGE_FRACTION = 3e-4
"""Widest range of a result in single precision, as a fraction of it: the larger limit counts, and a
result with a wider range is no evidence. Doubled, no page changes; without it, one does."""
_APPLESOFT_DIGITS = 9
_SINGLE_DIGITS = 7
_PI = 3.14159265  # as in line 300
TIE_RTOL = 2.0**-31
"""Relative error of the Apple's 32 bits, by which a value may become a tie."""
CUTS: dict[str, Callable[[float], int]] = {
    "floored": math.floor,
    "rounded": lambda units: math.floor(units + 0.5),
    "truncated": math.trunc,
}
"""Ways of programs to reduce a number to its printed decimals; the listing floors."""
_DOUBLES = (("", 1, _PI), (" with exact pi", 4, math.pi), (" with pi = 3.1416", 5, 3.1416))
"""IEEE doubles: words added to the kind, rank, and pi."""
_PIS = ("3.1416", "3.14159", "3.1415927", "3.141592654", "3.14")
"""Values of pi in line 300 of offices' copies."""


def causes(page: PageEvidence) -> Iterator[Cause]:
    """Try every other machine and way to print; yield the best of each kind."""
    all_clean = all(reading.clean for reading in page.paper.fields.values())
    best: dict[str, Cause] = {}
    for cause in _causes(page):
        kind = f"{cause.kind} {cause.note}" if cause.note.startswith("on line") else cause.kind
        if kind not in best or len(cause.left) < len(best[kind].left):
            best[kind] = cause
    for cause in best.values():
        accusation = NOT_APPLESOFT if all_clean else ""
        yield replace(cause, note="; ".join(filter(None, [cause.note, accusation])))


def _causes(page: PageEvidence) -> Iterator[Cause]:
    scene = page.recovered.scene
    # as another machine was given it: the printed numbers
    texts = {**page.recovered.assumed, **page.texts}
    typed_scene = scene | {name: texts[name] for name in INPUTS if name in texts and name != "MUP"}
    numbers = (_PI, *(pi for _, _, pi in _DOUBLES), *map(float, _PIS))
    is_near = dict(zip(numbers, _is_near(page, typed_scene, numbers), strict=True))
    if is_near[_PI]:
        run = _Run(page, scene, APPLESOFT)
        for how in ("rounded", "truncated"):
            yield run.cause(f"{how}, not floored", "", 0, run.cut(how))
            if lines := run.lines(how):
                line_list = f"on line{'s' * (len(lines) > 1)} {', '.join(map(str, lines))}"
                yield run.cause(f"{how}, not floored", line_list, 2, run.cut(how, lines))
        yield from _other_decimals(run)
        if all(digits_of(page.texts.get(name)) <= _SINGLE_DIGITS for name in (*INPUTS, "KI")):
            yield from _single_precision(page, typed_scene)
    for variant, rank, pi in _DOUBLES:
        if is_near[pi]:
            run = _Run(page, typed_scene, _with_pi(FLOAT64, pi))
            yield run.cause(f"IEEE double arithmetic{variant}", "", rank, {})
            for how in ("rounded", "truncated"):
                kind = f"IEEE double arithmetic, {how}, not floored"
                yield run.cause(kind, variant.strip(), rank + 10, run.cut(how))
    for text in _PIS:
        if is_near[float(text)]:
            run = _Run(page, typed_scene, _with_pi(APPLESOFT, APPLESOFT.number(text)))
            yield run.cause("another pi in line 300", text, 3, {})


def _with_pi(arithmetic: Arithmetic, pi: Any) -> Arithmetic:
    variant = copy(arithmetic)
    variant._constants = {f"{_PI}": pi}
    return variant


def _is_near(page: PageEvidence, scene: Mapping[str, str], pis: Iterable[float]) -> list[bool]:
    """Return, for each pi, True if the results in double precision are so near the page that
    another arithmetic may explain it."""
    pi_ratios = np.array([*pis]) / math.pi
    columns = {n: np.full(len(pi_ratios), double(text)) for n, text in scene.items()}
    columns |= {name: columns[name] * pi_ratios for name in ANGLES}
    results = printed_in_doubles(columns, list(page.results))
    return list(page.fits(results, len(pi_ratios), MAX_RANGE_UNITS, MAX_RANGE_FRACTION))


class _Run:
    """One run of the listing: its printed fields, and its values before they are floored."""

    def __init__(self, page: PageEvidence, scene: Mapping[str, str], machine: Arithmetic) -> None:
        self.page, self.scene = page, scene
        self.outcome, self.values = replays.run_whole(scene, machine)
        self.energy = self.values.pop("KI", 0.0)
        self._own = as_printed(self.outcome)
        if "KI" in page.texts and self.energy and math.isfinite(self.energy):
            # nine digits are rounded, with halves either way; more may be rounded or cut
            slack = 1.001 * 10.0 ** -page.decimals("KI")
            if digits_of(page.texts["KI"]) <= _APPLESOFT_DIGITS:
                last = math.floor(math.log10(abs(self.energy))) - _APPLESOFT_DIGITS + 1
                slack = 0.5001 * 10.0**last
            self._own["KI"] = self.energy - slack, self.energy + slack

    def cause(self, kind: str, note: str, rank: int, other: Mapping[str, Range]) -> Cause:
        """Return the run as a cause; ``other``: ranges that replace those of some results."""
        unexplained = self.page.left(self.scene, self.outcome, (), {**self._own, **other})
        return Cause(kind, note, _BITS + 0.1 * rank, unexplained)

    def cut(self, how: str, lines: Iterable[int] | None = None) -> dict[str, Range]:
        """Return the results, or those of some lines, reduced to the listing's decimals."""
        return {
            name: cut(value, (FIELDS[name].places or 0), how)
            for name, value in self.values.items()
            if lines is None or FIELDS[name].line in lines
        }

    def lines(self, how: str) -> list[int]:
        """Return the lines whose results are on the page reduced in this way and not floored; empty
        if all lines are, or none."""
        cut_results, read = self.cut(how), self.page.texts
        all_lines = {FIELDS[name].line for name in self.values}
        matches = []
        for line in sorted(all_lines):
            names = [name for name in self.values if FIELDS[name].line == line and name in read]
            if all(self.prints(name, cut_results) for name in names) and not all(
                map(self.prints, names)
            ):
                matches.append(line)
        return matches if len(matches) < len(all_lines) else []

    def prints(self, name: str, ranges: Mapping[str, Range] | None = None) -> bool:
        """Return True if the page has the predicted number."""
        low, high = (ranges or self._own).get(name, (math.nan, math.nan))
        return low <= float(self.page.texts[name]) <= high


def _other_decimals(run: _Run) -> Iterator[Cause]:
    """Yield the run with the page's decimals where these are not the listing's: floored or rounded,
    or to seven digits."""
    page = run.page
    ranges_by_name: dict[str, Range] = {}
    decimals, unusual_count = set(), 0
    for name, value in {**run.values, "KI": run.energy}.items():
        if name not in page.texts or run.prints(name):
            continue
        text = page.texts[name]
        number, places = float(text), page.decimals(name)
        single = digits_of(text) == _SINGLE_DIGITS
        slack = max(1.001 * 10.0**-places, abs(number) * (3e-6 if single else 2e-9))
        ranges = {how: cut(value, places, how) for how in ("rounded", "floored")}
        if 10.0**-places < (abs(number) or 1) or any(a <= number <= b for a, b in ranges.values()):
            ranges_by_name[name] = value - slack, value + slack
            if name != "KI":
                decimals.add(places)
                unusual_count += places != (FIELDS[name].places or 0) or "E" in text
    if unusual_count >= 2:
        places_text = " to ".join(map(str, sorted({min(decimals), max(decimals)}))) + " decimals"
        yield run.cause("printed with other decimals", places_text, 4, ranges_by_name)


def cut(value: float, places: int, how: str) -> Range:
    """Return a value reduced to ``places`` decimals as a range: its ends differ where the Apple's
    32 bits may make a tie of it. NaNs for a value that no program prints."""
    units = value * 10.0**places
    if not math.isfinite(units):
        return math.nan, math.nan
    slack = abs(units) * TIE_RTOL
    return CUTS[how](units - slack) / 10**places, CUTS[how](units + slack) / 10**places


# --- single precision ---


def _single_precision(page: PageEvidence, scene: Mapping[str, str]) -> Iterator[Cause]:
    run, exact = _Run(page, scene, single_precision(0)), _Run(page, scene, FLOAT64)
    outcomes = [
        replays.run_once(scene, single_precision(seed)) for seed in range(1, PERTURBED_RUNS + 1)
    ]
    outcomes.append(run.outcome)
    if exact.outcome.ending or any(outcome.ending for outcome in outcomes):
        return
    ranges = {
        name: interval
        for name in run.outcome.fields.keys() & page.texts.keys() - set(INPUTS)
        if name == "KI" or page.decimals(name) <= (FIELDS[name].places or 0)
        if (interval := _narrow_range(name, [float(outcome.fields[name]) for outcome in outcomes]))
    }
    read = exact.values.keys() & page.texts.keys()
    how = max(CUTS, key=lambda how: sum(exact.prints(name, exact.cut(how)) for name in read))
    kind = "single-precision arithmetic" + ("" if how == "floored" else f", {how}, not floored")
    yield run.cause(kind, "as in GW-BASIC and similar BASICs", 4, ranges)


def _narrow_range(name: str, numbers: list[float]) -> Range | None:
    """Return the range of a result over the runs; None if it is too wide to be evidence."""
    size, spread = max(map(abs, numbers)), max(numbers) - min(numbers)
    places = FIELDS[name].places
    if places is None:
        places = _SINGLE_DIGITS - 1 - math.floor(math.log10(size)) if size else 0
    unit = 10.0**-places
    if spread > max(MAX_RANGE_UNITS * unit, MAX_RANGE_FRACTION * size):
        return None
    return min(numbers) - spread - unit, max(numbers) + spread + unit


def single_precision(seed: int) -> Arithmetic:
    """Return an arithmetic that keeps 24 bits of every number read, stored or looked up, as the
    single-precision BASICs of other machines do (GW-BASIC, BASICA). With a ``seed`` other than 0,
    stored numbers are perturbed by up to one unit of the last bit, whole numbers excepted."""
    rng = random.Random(seed)

    def store(x: float) -> float:
        is_jittered = seed and not x.is_integer()
        return float(np.float32(x * (1 + rng.choice((-1, 0, 1)) * 2.0**-23) if is_jittered else x))

    def read(text: str, start: int) -> tuple[float, int]:
        value, end = FLOAT64.read(text, start)
        return float(np.float32(value)), end

    arithmetic = copy(FLOAT64)
    arithmetic._constants = {}
    arithmetic.read, arithmetic.LET = read, store
    arithmetic.write = lambda x: FLOAT64.write(float(f"{x or 0.0:.{_SINGLE_DIGITS - 1}E}"))
    arithmetic.SIN, arithmetic.COS = (lambda x: store(math.sin(x))), (lambda x: store(math.cos(x)))
    return arithmetic
