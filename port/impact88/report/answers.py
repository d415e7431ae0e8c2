"""The answer to a case: the one record that terminal, JSON, report and web page print.

`ask` decides what a case asks for. Nothing that prints an answer computes, converts or rounds.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from .. import status
from ..cases.case import Case
from ..errors import UserError
from ..mechanics.solve import evaluate
from ..names import (
    ANGLE,
    FINAL_VELOCITIES,
    PERCENT,
    RESULTS,
    SCENE,
    VELOCITIES,
    missing,
    quantity,
)
from .rounding import decimals_in, round_number

if TYPE_CHECKING:
    from ..reconstruction.answer import Reconstruction

FORWARD = tuple("DVA PDOFA DVB PDOFB VAX VAY VBX VBY WAF WBF SAF HAF SBF HBF LOSS VC MUC".split())
"""Results of a forward question, the most asked first."""
BACKWARD = tuple(
    "SA HA SB HB SAF HAF SBF HBF DVA PDOFA DVB PDOFB E MUP EM WA WB WAF WBF LOSS".split()
)
"""Results of a reconstruction, the most asked first."""
COMPONENTS = "DVAF DVAR DVBF DVBR P RR0 EL DT CAX CAY CBX CBY".split()
ALL = (*dict.fromkeys((*FORWARD, *BACKWARD, *VELOCITIES, *RESULTS, *COMPONENTS)),)
"""Every result."""
DRAWN = (*FINAL_VELOCITIES, *"SA SB SAF SBF DVA DVB P PDOFA PDOFB".split())
"""Results that every drawing shows."""
POINTS = "CAF CAL CBF CBL".split()
UNUSABLE = (
    "no impact has these values; expected M = 6 for bodies or 4 for point masses, masses and "
    "inertias above 0, and at most one barrier (MB = inf, IB = inf), at rest"
)
CLOCK_HOUR = 30.0  # degrees
DRAWS = 20_000  # random draws: the standard error of a 5 % quantile is 2 % of the width
NOISE = 1e-9  # width of an interval over the value: so much is rounding
MIN_SHARE = 0.05  # of a result's variance, from which a value is named


@dataclass(frozen=True, slots=True)
class Row:
    """One number of an answer, in the unit in which it is shown.

    Parameters
    ----------
    name, meaning, unit : str
        Of the quantity (`impact88.names`); the unit is "" for ratios and without named units.
    text : str
        A result as every reader sees it, without its unit.
    note : str
        The same in other words, "10 o'clock".
    interval : str
        The 90 % interval as every reader sees it, "28.1 .. 31.5"; "" for an exact number.
    value : float
        A result, not rounded; NaN where only an interval is known.
    ends : tuple of float or None
        The ends of the interval, not rounded.
    """

    name: str
    meaning: str
    unit: str
    text: str
    note: str = ""
    interval: str = ""
    value: float = math.nan
    ends: tuple[float, float] | None = None


@dataclass(frozen=True)
class Answer:
    """The answer to a case, in the units, axes and headings of the case.

    Parameters
    ----------
    asked : {"forward", "bounds", "reconstruct"}
        The question that the case leaves open.
    question : str
        The same in words: "SA and SB, from 10 exact values".
    found : mapping of str to Row
        Results by name, the most asked first; empty where known values contradict one another.
    case : Case
        The case.
    evidence : str
        Agreement of what is known, in words; "" for a forward question.
    possible : bool
        False if no impact that physics allows agrees with what is known.
    sections : mapping of str to tuple of str
        Sentences by subject: ``checked``, values beside the others; ``depends``, what makes results
        uncertain; ``assumed`` ranges; ``helps``, values that would; ``rejected`` other impacts.
    remarks : tuple of str
        How entries were understood, estimates, results that lack an input.
    warnings : tuple of str
        Reasons to doubt the answer.
    scene : mapping of str to float
        Inputs and results in base units along the listing's axes, for drawings.
    alternatives : tuple of Answer
        Other possible impacts that agree with what is known, in the order of likelihood.
    """

    asked: str
    question: str
    found: Mapping[str, Row]
    case: Case
    evidence: str = ""
    possible: bool = True
    sections: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    scene: Mapping[str, float] = field(default_factory=dict)
    alternatives: tuple[Answer, ...] = ()

    @property
    def given(self) -> Mapping[str, str]:
        """The entries as written, units and sources among them, in the order of the file."""
        return self.case.written

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """The 90 % intervals of the results that have one."""
        return {name: row.ends for name, row in self.found.items() if row.ends}

    def as_json(self) -> dict[str, Any]:
        """Return the answer as an object for JSON, with a `Row` for each result."""
        names = "asked question evidence possible given remarks warnings".split()
        return {
            **{name: getattr(self, name) for name in names},
            **self.sections,
            "found": [*self.found.values()],
            "alternatives": [answer.as_json() for answer in self.alternatives],
        }


def ask(case: Case, wanted: Sequence[str] = ()) -> Answer:
    """Return the answer to a case: forward, bounds or reconstruction.

    Parameters
    ----------
    case : Case
        The case.
    wanted : sequence of str, optional
        The results wanted, such as `ALL`; by default those most asked.

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
    is_forward = {*case.entries} <= {*SCENE, *POINTS} and not evaluate(
        case.numbers, FINAL_VELOCITIES[:4]
    )[1]
    if case.correlations and not (is_forward and case.ranges):
        raise UserError(
            "correlations are those of a complete scene; expected two values within limits",
            case.places.get("correlations", case.source),
        )
    return (_forward if is_forward else _reconstruct)(case, wanted)


def _forward(case: Case, wanted: Sequence[str]) -> Answer:
    """Return the answer to a complete scene, with 90 % intervals where it has tolerances."""
    names = wanted or FORWARD
    values, lacking = evaluate(case.numbers, (*names, *DRAWN, "STATUS", "fit"))
    numbers = {name: float(x) for name, x in values.items() if not math.isnan(x)}
    if numbers.get("fit") == 0:
        raise UserError(UNUSABLE, case.source)
    results = {name: numbers[name] for name in names if name in numbers}
    answer = forward_answer(
        case,
        "velocities after the impact, from a complete scene",
        results,
        int(numbers["STATUS"]),
        _left_out(case, names, results, lacking),
    )
    answer = replace(answer, scene={**case.numbers, **numbers})
    return _with_bounds(answer, results) if case.ranges else answer


def forward_answer(
    case: Case,
    question: str,
    values: Mapping[str, float],
    bits: int = 0,
    remarks: Sequence[str] = (),
) -> Answer:
    """Return results in base units and their STATUS as the answer to a case."""
    return Answer(
        "forward",
        question,
        numbers_of(case, values),
        case,
        possible=not bits & status.IMPOSSIBLE,
        remarks=(*case.remarks, *remarks),
        warnings=tuple(status.sentences(bits)),
    )


def _left_out(
    case: Case,
    names: Sequence[str],
    results: Collection[str],
    lacking: Mapping[str, Sequence[str]],
) -> list[str]:
    """Return a remark on the results that cannot be given. Raises UserError if none can."""
    absent = [name for name in names if name not in results]
    if not absent:
        return []
    inputs = dict.fromkeys(name for n in absent for name in lacking.get(n, ()))
    reason = missing([*inputs]) if inputs else "not defined for this impact, or left open"
    remark = f"{' '.join(absent)} left out: {reason}"
    if results:
        return [remark]
    raise UserError(remark, case.source)


def _with_bounds(answer: Answer, values: Mapping[str, float]) -> Answer:
    """Return an answer with 90 % intervals of its results, and what they depend on."""
    from ..reconstruction import words
    from ..reconstruction.bounds import BOUNDED, bounds

    case = answer.case
    # random draws do not depend on the file's order; a TA that follows a course is a number
    sample = bounds(
        {
            name: case.numbers.get(name) if math.isnan(amount.value) else amount
            for name, amount in sorted(case.entries.items())
        },
        [name for name in values if name in BOUNDED],
        samples=DRAWS,
        correlations=case.correlations,
        limits=False,  # the answer has intervals only
    )
    intervals, variances = {}, {}
    for name, bound in sample.outputs.items():
        low, high = bound.interval
        if high - low > NOISE * abs(bound.nominal):
            intervals[name] = low, high
            variances[name] = {driver: effect**2 for driver, effect in bound.drivers.items()}
    warnings = [
        f"in {100 * fraction:.2g} % of the draws {text}"
        for name, fraction in sample.warnings.items()
        if (text := status.WORDS[status.Status[name]]) not in answer.warnings
    ]
    return replace(
        answer,
        asked="bounds",
        question=f"{answer.question} with limits of {', '.join(case.ranges)}",
        found=numbers_of(case, values, intervals),
        sections={"depends": _dependences(variances, intervals)},
        remarks=(*answer.remarks, words.precision(sample)),
        warnings=(*answer.warnings, *warnings),
    )


def _dependences(
    variances: Mapping[str, Mapping[str, float]], names: Iterable[str]
) -> tuple[str, ...]:
    """Return which inputs make results uncertain: "DVA DVB: UX 62 %, MU 20 %".

    Parameters
    ----------
    variances : mapping of str to mapping of str to float
        Parts of each result's variance by input, the largest first, in any unit.
    names : iterable of str
        The results.
    """
    results: dict[str, list[str]] = {}
    for result in names:
        parts = variances.get(result, {})
        total = sum(parts.values())
        if {*parts} - {result}:
            large = [name for name, part in parts.items() if part >= MIN_SHARE * total]
            text = ", ".join(f"{name} {100 * parts[name] / total:.0f} %" for name in large)
            results.setdefault(text, []).append(result)
    return tuple(f"{' '.join(group)}: {words}" for words, group in results.items())


def numbers_of(
    case: Case,
    values: Mapping[str, float],
    intervals: Mapping[str, tuple[float, float]] = {},
) -> dict[str, Row]:
    """Return values as rows of an answer.

    Parameters
    ----------
    case : Case
        The case, in whose units they are shown.
    values : mapping of str to float
        Values by name in base units; NaN where only an interval is known.
    intervals : mapping of str to (float, float), optional
        90 % intervals of some of them, in base units.
    """
    rows = {}
    numbers = {name: case.view.shown(name, value) for name, value in values.items()}
    rules = {name: quantity(name).unit for name in numbers}
    for name, value in numbers.items():
        rule = rules[name]
        ends = tuple(sorted(case.view.shown(name, x, False) for x in intervals.get(name, ())))
        if ends and rule == ANGLE and math.isfinite(value):  # a heading is within one turn
            turns = 360.0 * round((value - sum(ends) / 2) / 360.0)
            ends = ends[0] + turns, ends[1] + turns
        group = [x for n, x in numbers.items() if rules[n] == rule]
        decimals = decimals_in(rule, group, ends[1] - ends[0] if ends else 0.0)
        text = round_number(value, decimals)
        rows[name] = Row(
            name,
            case.view.meaning(name),
            case.view.unit(name) or {PERCENT: "%", ANGLE: "deg"}.get(rule, ""),
            text,
            clock(value) if text and "PDOF" in name else "",
            " .. ".join(round_number(end, decimals) for end in ends),
            value,
            ends or None,
        )
    return rows


def clock(degrees: float) -> str:
    """Return a direction clockwise from a vehicle's front as an hour.

    Examples
    --------
    >>> clock(0.0), clock(-62.0), clock(174.9)
    ("12 o'clock", "10 o'clock", "6 o'clock")
    """
    hour = math.floor(degrees / CLOCK_HOUR + 0.5) % 12
    return f"{hour or 12} o'clock"


def _reconstruct(case: Case, wanted: Sequence[str]) -> Answer:
    """Return the impact that agrees best with what is known, with its alternatives."""
    from ..reconstruction.answer import reconstruct

    # random draws do not depend on the file's order
    try:
        impacts = reconstruct(dict(sorted(case.entries.items())))
    except (UserError, OverflowError) as error:  # a value is too large
        raise UserError(str(error), case.source) from None
    first, *alternatives = [_impact(case, impact, wanted) for impact in impacts]
    return replace(
        first,
        sections={
            **first.sections,
            "rejected": tuple(
                "another impact that agrees with the values, rejected: "
                + answer.warnings[0].partition(": ")[2]
                for answer in alternatives
                if first.possible > answer.possible
            ),
        },
        alternatives=tuple(answer for answer in alternatives if answer.possible),
    )


def _impact(case: Case, impact: Reconstruction, wanted: Sequence[str]) -> Answer:
    """Return one impact as an answer; of values that contradict one another without numbers."""
    from ..reconstruction import words

    view, values = case.view, impact.values
    scene, warnings = case.numbers, words.warnings(impact, view)
    with suppress(UserError):  # an impact that leaves inputs open has no scene
        scene = impact.scene()
        more, _ = evaluate(scene, (*wanted, "STATUS"))
        values = {**{n: float(x) for n, x in more.items() if not math.isnan(x)}, **values}
        said = status.WRONG_SIDES if impact.is_adverse else ~status.IMPOSSIBLE
        warnings += status.sentences(int(more["STATUS"]) & said)
    is_exact = {*case.entries} - {*case.ranges}
    names = wanted or [name for name in BACKWARD if name not in is_exact]
    results = [n for n in names if n in values or n in impact.intervals]
    remarks = list(words.remarks(impact))
    if impact.verdict == "contradictory":  # the nearest impact would be taken for an answer
        scene, results = {}, []
    else:
        remarks += _left_out(case, wanted, results, {})
    return Answer(
        "reconstruct",
        words.question(impact, case.derived),
        numbers_of(case, {n: values.get(n, math.nan) for n in results}, impact.intervals),
        case,
        evidence=words.evidence(impact, view),
        possible=not impact.is_adverse,
        sections={
            "depends": _dependences(impact.drivers, results),
            "checked": words.checks(impact, view),
            "assumed": words.assumptions(impact),
            "helps": words.advice(impact),
        },
        remarks=(*case.remarks, *remarks),
        warnings=tuple(warnings),
        scene={**scene, **values} if scene else {},
    )
