"""The answer to a case: the one record that terminal, JSON, report and web page print.

`ask` decides what a case asks for. Nothing that prints an answer computes, converts or rounds.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Any

from .. import status
from ..cases.amounts import Amount
from ..cases.case import Case
from ..cases.scenefile import INPUTS, SOURCE
from ..errors import UserError
from ..mechanics.solve import evaluate
from ..names import (
    ANGLE,
    FINAL_VELOCITIES,
    PERCENT,
    PIVOT,
    RESULTS,
    SCENE,
    VELOCITIES,
    check_names,
    missing,
    quantity,
)
from .rounding import OF_INTERVAL, decimals_of, decimals_with, own_decimals, rounded

if TYPE_CHECKING:
    from ..reconstruction.answer import Reconstruction
    from ..reconstruction.bounds import Bounds

SPEEDS = ("SA", "HA", "SB", "HB", "SAF", "HAF", "SBF", "HBF")
CHANGES = ("DVA", "PDOFA", "DVB", "PDOFB")
FORWARD = (*CHANGES, *FINAL_VELOCITIES, "SAF", "HAF", "SBF", "HBF", "LOSS", "VC", "MUC")
"""Results of a forward question, the most asked first."""
BACKWARD = (*SPEEDS, *CHANGES, "E", "MUP", "EM", "WA", "WB", "WAF", "WBF", "LOSS")
"""Results of a reconstruction, the most asked first."""
ALL = tuple(
    dict.fromkeys(
        (
            *(*FORWARD, *BACKWARD, *VELOCITIES, *RESULTS),
            *("DVAF", "DVAR", "DVBF", "DVBR", "P", "RR0", "EL", "DT", "CAX", "CAY", "CBX", "CBY"),
        )
    )
)
"""Every result."""
UNUSABLE = (
    "no impact has these values; expected M = 6 or 4, masses and inertias above 0, and at most one "
    "barrier (MB = inf, IB = inf), at rest"
)
CLOCK_HOUR = 30.0  # degrees
DRAWS = 20_000  # random draws: the standard error of a 5 % quantile is 2 % of the width
MAX_DRIVERS = 3  # values named as those that make a result uncertain
MIN_SHARE = 0.05  # of a result's variance, from which a value is named


@dataclass(frozen=True, slots=True)
class Number:
    """One number of an answer, in the unit in which it is shown.

    Parameters
    ----------
    name, meaning, unit : str
        Of the quantity (`impact88.names`); the unit is "" for ratios and without named units.
    value : float
        The number, not rounded.
    text : str
        The number as every reader sees it, without its unit.
    low, high : float or None
        Ends of its 90 % interval; None for an exact number.
    low_text, high_text : str
        The ends, rounded alike; "" for an exact number.
    note : str
        The same in other words: "10 o'clock".
    drivers : str
        What makes it uncertain, the largest first: "UX 62 %, MU 20 %".
    """

    name: str
    meaning: str
    unit: str
    value: float
    text: str
    low: float | None = None
    high: float | None = None
    low_text: str = ""
    high_text: str = ""
    note: str = ""
    drivers: str = ""

    @property
    def interval(self) -> str:
        """The 90 % interval as text: "28.1 .. 31.5"; "" for an exact number."""
        return f"{self.low_text} .. {self.high_text}" if self.low_text else ""


@dataclass(frozen=True, slots=True)
class Given:
    """One entry of the case.

    Parameters
    ----------
    name, meaning, unit : str
        Of the quantity.
    text : str
        The entry as written.
    source : str
        Where it comes from, as the case says.
    """

    name: str
    meaning: str
    unit: str
    text: str
    source: str = ""


@dataclass(frozen=True, slots=True)
class Check:
    """A value known with a tolerance, beside the others (Baarda 1968); texts, rounded.

    Parameters
    ----------
    name, unit : str
        Of the quantity.
    measured, adjusted, by_others : str
        As given, in the impact found, and as the other values alone would have it.
    residual : str
        Adjustment in its standard deviations.
    is_odd : bool
        True if it is most at odds with the others.
    """

    name: str
    unit: str
    measured: str
    adjusted: str
    by_others: str
    residual: str
    is_odd: bool = False


@dataclass(frozen=True)
class Answer:
    """The answer to a case, in the units, axes and headings of the case.

    Parameters
    ----------
    asked : {"forward", "bounds", "reconstruct"}
        The question that the case leaves open.
    question : str
        The same in words: "SA and SB, from 10 exact values".
    given : tuple of Given
        The entries, in the order of the file.
    found : mapping of str to Number
        Results by name, the most asked first.
    evidence : str
        Agreement of what is known, in words; "" for a forward question.
    possible : bool
        False if no impact that physics allows agrees with what is known.
    assumed : tuple of str
        Ranges assumed for what is not given.
    advice : tuple of str
        Values that would help if they were given.
    checks : tuple of Check
        Values known with tolerances, beside the others.
    remarks : tuple of str
        How entries were understood, estimates, results that lack an input.
    warnings : tuple of str
        Reasons to doubt the answer.
    scene : mapping of str to float
        Inputs and results in base units along the listing's axes, for drawings.
    alternatives : tuple of Answer
        Other impacts that agree with what is known, in the order of likelihood.
    case : Case
        The case.
    """

    asked: str
    question: str
    given: tuple[Given, ...]
    found: Mapping[str, Number]
    case: Case = field(repr=False)
    evidence: str = ""
    possible: bool = True
    assumed: tuple[str, ...] = ()
    advice: tuple[str, ...] = ()
    checks: tuple[Check, ...] = ()
    remarks: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    scene: Mapping[str, float] = field(default_factory=dict, repr=False)
    alternatives: tuple[Answer, ...] = ()

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """The 90 % intervals of the results that have one."""
        return {
            name: (number.low, number.high)
            for name, number in self.found.items()
            if number.low is not None and number.high is not None
        }

    def as_json(self) -> dict[str, Any]:
        """Return the answer as an object for JSON."""
        record = {
            "asked": self.asked,
            "question": self.question,
            "given": [asdict(entry) for entry in self.given],
            "found": [asdict(number) for number in self.found.values()],
            "evidence": self.evidence,
            "possible": self.possible,
        }
        for name in ("assumed", "advice", "remarks", "warnings"):
            record[name] = list(getattr(self, name))
        record["checks"] = [asdict(check) for check in self.checks]
        record["alternatives"] = [answer.as_json() for answer in self.alternatives]
        return record


def ask(case: Case, wanted: Sequence[str] = (), *, full: bool = False, seed: int = 0) -> Answer:
    """Return the answer to a case: forward, bounds or reconstruction.

    Parameters
    ----------
    case : Case
        The case.
    wanted : sequence of str, optional
        The results wanted; by default those most asked.
    full : bool, default False
        True for every result.
    seed : int, default 0
        Random seed.

    Returns
    -------
    Answer
        Forward where a complete scene is given and nothing else, with 90 % intervals where it has
        tolerances; else the impact that agrees best with what is known.

    Raises
    ------
    UserError
        For a case that gives too little, and for values that no impact has.
    """
    if is_forward(case):
        names = tuple(wanted) or (ALL if full else FORWARD)
        if math.isinf(case.numbers["MB"]):  # a barrier
            names = tuple(name for name in names if "B" not in name or name in wanted)
        return _forward(case, names, seed)
    exact = {name for name, amount in case.entries.items() if not amount.varies}
    names = tuple(wanted) or (ALL if full else tuple(n for n in BACKWARD if n not in exact))
    return _reconstructed(case, names, seed)


def is_forward(case: Case) -> bool:
    """Return True if a case gives a scene from which the final velocities follow, and no more."""
    if not set(case.entries) <= {*SCENE, "CAF", "CAL", "CBF", "CBL"}:
        return False
    lacking = evaluate(case.numbers, ("VAX", "VAY", "VBX", "VBY"))[1]
    return not lacking


def _forward(case: Case, names: tuple[str, ...], seed: int) -> Answer:
    """Return the answer to a complete scene, with intervals where it has tolerances."""
    values, lacking = evaluate(case.numbers, (*names, *FINAL_VELOCITIES, "STATUS", "fit"))
    numbers = {name: float(value) for name, value in values.items()}
    if numbers.pop("fit", 1.0) == 0:
        raise UserError(UNUSABLE, case.source)
    bits = int(numbers.pop("STATUS", 0.0))
    warnings = status.sentences(bits)
    remarks = [*case.remarks, *_lacking_remarks(lacking)]
    undefined = [name for name in names if math.isnan(numbers.get(name, 0.0))]
    if undefined:
        remarks.append(f"{' '.join(undefined)}: not defined for this impact")
    shown = {name: numbers[name] for name in names if name in numbers and name not in undefined}
    intervals: dict[str, tuple[float, float]] = {}
    drivers: dict[str, str] = {}
    question = "velocities after the impact, from a complete scene"
    if case.ranges:
        found = _bounds(case, shown, seed)
        intervals = {n: b.interval for n, b in found.outputs.items() if b.upper > b.lower}
        drivers = {name: _effects(bound.drivers) for name, bound in found.outputs.items()}
        warnings += _drawn_warnings(found.warnings, bits)
        question += f" in which {_listed(case.ranges)} {_verb(case.ranges)} known within limits"
    return Answer(
        "bounds" if case.ranges else "forward",
        question,
        given_of(case),
        numbers_of(case, shown, intervals, drivers),
        case,
        possible=not bits & status.IMPOSSIBLE,
        remarks=tuple(remarks),
        warnings=tuple(warnings),
        scene={**case.numbers, **numbers},
    )


def _bounds(case: Case, names: Iterable[str], seed: int) -> Bounds:
    """Return quantiles and drivers of the results of a scene within its limits."""
    from ..reconstruction.bounds import BOUNDED, bounds

    values = {
        name: case.numbers.get(name) if math.isnan(amount.value) else amount
        for name, amount in sorted(case.entries.items())  # random draws, whatever the file's order
    }
    wanted = [name for name in names if name in BOUNDED]
    return bounds(values, wanted, samples=DRAWS, seed=seed, correlations=case.correlations)


def _effects(drivers: Mapping[str, tuple[float, float]]) -> str:
    """Return the inputs that make a result uncertain, by squares of what each does alone."""
    squares = {name: effect * effect for name, (_, effect) in drivers.items()}
    total = sum(squares.values())
    return _shares({name: square / total for name, square in squares.items()} if total else {})


def _shares(shares: Mapping[str, float]) -> str:
    """Return the largest shares of a variance in words: "UX 62 %, MU 20 %"."""
    ranked = sorted(shares.items(), key=lambda pair: -pair[1])[:MAX_DRIVERS]
    return ", ".join(f"{name} {100 * share:.0f} %" for name, share in ranked if share >= MIN_SHARE)


def _drawn_warnings(fractions: Mapping[str, float], bits: int) -> list[str]:
    """Return a sentence for each warning that only some of the draws have."""
    return [
        f"in {100 * fraction:.2g} % of the draws {status.WORDS[status.Status[name]]}"
        for name, fraction in fractions.items()
        if not bits & status.Status[name]
    ]


def _listed(names: Sequence[str]) -> str:
    """Return names as "UX, VY and E"."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def _verb(names: Sequence[str]) -> str:
    return "is" if len(names) == 1 else "are"


def _lacking_remarks(lacking: Mapping[str, tuple[str, ...]]) -> list[str]:
    """Return a sentence for the results that need an input that is not given."""
    by_inputs: dict[tuple[str, ...], list[str]] = {}
    for name, inputs in lacking.items():
        if name not in ("STATUS", "fit"):
            by_inputs.setdefault(inputs, []).append(name)
    return [f"{' '.join(names)} left out: {missing(inputs)}" for inputs, names in by_inputs.items()]


def given_of(case: Case) -> tuple[Given, ...]:
    """Return the entries of a case, in the order of its file."""
    rows = []
    for name, amount in {**case.entries, **case.sizes}.items():
        written = case.written.get(name, "")
        text = written if isinstance(written, str) and written else _amount_text(case, name, amount)
        has_unit = any(c.isalpha() or c == "%" for c in text)
        unit = "" if has_unit else unit_of(case, name)
        meaning = quantity(name).meaning
        rows.append(Given(name, meaning, unit, text, case.sources.get(name, "")))
    return tuple(rows)


def unit_of(case: Case, name: str) -> str:
    """Return the unit in which a case shows a quantity; "" for ratios and without named units."""
    return case.view.unit(name) or {PERCENT: "%", ANGLE: "deg"}.get(quantity(name).unit, "")


def _amount_text(case: Case, name: str, amount: Amount) -> str:
    """Return an amount that no entry wrote, as text."""
    if math.isnan(amount.value):
        return amount.text
    low, high = case.view.shown_ends(name, *amount.limits())
    middle = case.view.shown_text(name, amount.value)
    return f"{low:.6g} .. {high:.6g}" if amount.varies else middle


def numbers_of(
    case: Case,
    values: Mapping[str, float],
    intervals: Mapping[str, tuple[float, float]],
    drivers: Mapping[str, str],
) -> dict[str, Number]:
    """Return values in base units as numbers of an answer.

    Parameters
    ----------
    case : Case
        The case, in whose units they are shown.
    values : mapping of str to float
        Values by name; NaN where only an interval is known.
    intervals : mapping of str to (float, float)
        90 % intervals of some of them, in base units.
    drivers : mapping of str to str
        What makes some of them uncertain.
    """
    shown = {name: float(case.view.shown(name, value)) for name, value in values.items()}
    groups: dict[str, list[float]] = {}
    for name, value in shown.items():
        if math.isfinite(value):
            groups.setdefault(quantity(name).unit, []).append(value)
    group_decimals = {rule: decimals_of(members) for rule, members in groups.items()}
    numbers = {}
    for name, value in shown.items():
        row = quantity(name)
        decimals = own_decimals(row.unit, value)
        decimals = group_decimals.get(row.unit, 0) if decimals is None else decimals
        note, driver = _note(name, value), drivers.get(name, "")
        ends: tuple[float | None, float | None, str, str] = (None, None, "", "")
        if name in intervals:
            low, high = (float(x) for x in case.view.shown_ends(name, *intervals[name]))
            if row.unit == ANGLE and math.isfinite(value):  # a heading is within one turn
                turns = 360.0 * round((value - (low + high) / 2) / 360.0)
                low, high = low + turns, high + turns
            decimals = decimals_with((low, high), decimals)
            ends = low, high, rounded(low, decimals), rounded(high, decimals)
        text = rounded(value, decimals)
        numbers[name] = Number(
            name, row.meaning, unit_of(case, name), value, text, *ends, note, driver
        )
    return numbers


def _note(name: str, shown: float) -> str:
    """Return a number in other words: the hour of a direction of force, what -10 stands for."""
    if name in ("PDOFA", "PDOFB") and math.isfinite(shown):
        return clock(shown)
    return "pivot" if name == "MUP" and shown == PIVOT else ""


def clock(degrees: float) -> str:
    """Return a direction clockwise from a vehicle's front as an hour.

    Examples
    --------
    >>> clock(0.0), clock(-62.0), clock(174.9)
    ("12 o'clock", "10 o'clock", "6 o'clock")
    """
    hour = math.floor(degrees / CLOCK_HOUR + 0.5) % 12
    return f"{hour or 12} o'clock"


def _reconstructed(case: Case, names: tuple[str, ...], seed: int) -> Answer:
    """Return the impact that agrees best with what is known; others are its alternatives."""
    from ..reconstruction.answer import KNOWABLE, reconstruct

    # random draws do not depend on the file's order
    known = {name: amount for name, amount in sorted(case.entries.items()) if name != "TF"}
    check_names(known, KNOWABLE, "value that a reconstruction can use", case.source)
    duration = case.entries["TF"].value if "TF" in case.entries else None
    try:
        impacts = reconstruct(known, samples=DRAWS, seed=seed, contact_time=duration)
    except UserError as error:
        raise UserError(str(error), case.source) from None
    first, *others = [_impact(case, impact, names) for impact in impacts]
    return replace(first, alternatives=tuple(others))


def _impact(case: Case, impact: Reconstruction, names: Iterable[str]) -> Answer:
    """Return one impact as an answer."""
    from ..reconstruction import words

    results = [n for n in names if n in impact.values or n in impact.intervals]
    values = {name: impact.values.get(name, math.nan) for name in results}
    drivers = {
        name: _shares(shares)
        for name in results
        if (shares := impact.drivers.get(name, {})) and [*shares] != [name]
    }
    intervals = {n: ends for n, ends in impact.intervals.items() if n in values}
    scene = {**case.numbers, **impact.values}
    warnings = words.warnings(impact, case.view)
    with suppress(UserError):  # an impact that leaves inputs open has no scene
        determined = impact.scene()
        scene |= determined
        if not impact.is_adverse:
            bits = int(evaluate(determined, ("STATUS",))[0]["STATUS"])
            warnings += status.sentences(bits & ~status.IMPOSSIBLE)
    return Answer(
        "reconstruct",
        words.question(impact),
        given_of(case),
        numbers_of(case, values, intervals, drivers),
        case,
        evidence=words.evidence(impact, case.view),
        possible=not impact.is_adverse,
        assumed=words.assumptions(impact),
        advice=words.advice(impact),
        checks=_checks(case, impact),
        remarks=(*case.remarks, *words.remarks(impact)),
        warnings=tuple(warnings),
        scene=scene,
    )


def _checks(case: Case, impact: Reconstruction) -> tuple[Check, ...]:
    """Return the values known with tolerances beside the others."""
    if not impact.evidence.redundancy:
        return ()
    checks = []
    for name, test in impact.tests.items():
        shown = [
            float(case.view.shown(name, x)) for x in (test.measured, test.adjusted, test.by_others)
        ]
        deviation = test.sd / abs(float(case.view.map(name)[0]))
        decimals = decimals_of([deviation], OF_INTERVAL)
        measured, adjusted, by_others = (rounded(x, decimals) for x in shown)
        residual, is_odd = rounded(test.residual, 1), name in impact.evidence.at_odds
        checks.append(
            Check(name, unit_of(case, name), measured, adjusted, by_others, residual, is_odd)
        )
    return tuple(checks)


def scene_case(answer: Answer) -> Case:
    """Return the impact of an answer as a complete scene; exact entries stay as written.

    Raises
    ------
    UserError
        If the answer leaves an input open."""
    case, scene = answer.case, answer.scene
    if absent := [name for name in SCENE if name not in scene]:
        raise UserError(f"the impact found leaves inputs open: {missing(absent)}", case.source)
    ranges = case.ranges
    kept = {
        name: value
        for name, value in case.written.items()
        if name.removesuffix(SOURCE) not in INPUTS or (name in SCENE and name not in ranges)
    }
    texts = {name: case.view.shown_text(name, scene[name]) for name in SCENE if name not in kept}
    return Case.of({**kept, **texts}, case.source, case.view)
