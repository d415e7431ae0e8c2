"""The answer: which impacts agree with what is known, in what order, and how sure they are.

The sum of squared misfits of r redundant values, each in standard deviations, follows the
chi-square distribution with r degrees of freedom if the tolerances are right. The value most at
odds with the others has the largest standardized residual (Baarda 1968).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from statistics import NormalDist
from typing import Any, NamedTuple

import numpy as np

from ..cases.amounts import Amount
from ..errors import UserError
from ..mechanics.solve import BODIES, POINT, evaluate
from ..names import SCENE
from .densities import sampling_error
from .draws import Sample, push_forward, sample
from .fit import EXACT_TOL, RESULT_STEP, STEP, TYPED_TOL, Fit, Search, expected_unseen
from .impacts import AFTER, BEFORE, COURSES, EVERY, IMPULSES, SPEEDS, VEHICLES, Array
from .known import WITHOUT_MOMENT, as_amounts
from .laws import MissedLaw, missed_laws
from .problem import ANGLES, RANGES, WIDEST, Problem, signs_of_friction, unwrap_angles

CONTRADICTION = 1e-3  # probability of a misfit below which values contradict one another
LIKELY = 9.0  # sum of squares above the least, up to which an impact is shown
TIE = 1e-9  # differences in typical sizes that are rounding
SOFTENED = 0.01  # tolerance of exact values that contradict one another, in typical sizes
CHECKED = 0.02  # least part of a variance that counts
NAMED_RATIO = 0.9  # squared residual, relative to the largest, from which a value is named with it
MAX_NAMED = 3
INTERVAL = (0.05, 0.95)
NARROWED = 0.1  # an interval that ends as near to an end of an assumed range of 1 reaches it

ANY_MOMENT = (
    "EM does not follow: the impact turns neither vehicle, so that every EM fits; give EM = 1"
)
NO_APPROACH = "the contact points do not approach before this impact (gn = 0): nothing collides"
OUTSIDE = (
    "too few random draws lie within all limits: intervals are to first order, and what is left "
    "open has none; wider limits or one more known value would help"
)
CONDITIONS = {
    "approach": "VC",
    "push": "PN",
    "energy": "EL",
    "friction": "MUP",
    "sign of MU": "MUP",
}
"""Conditions of physics with the result that they limit, if not their own."""
ADVERSE = ("impossible", "contradictory")
KNOWABLE = (
    *(name for name in SCENE if name != "M"),
    *AFTER,
    *SPEEDS,
    *COURSES,
    *IMPULSES,
    *"MUP DVA DVB DVAF DVAR DVBF DVBR PDOFA PDOFB VC VS KI KF EL ELA ELB EBSA EBSB LOSS DT".split(),
    *"CAF CAL CBF CBL CX CY".split(),
    "M",
)
"""Names of what may be known."""
WITHOUT_ARMS = (
    *"EM RR0 PM WA WAF WB WBF XA YA XB YB XAF YAF XBF YBF CAX CAY CBX CBY ELN ELT ELM".split(),
)
"""Results that point masses do not have, or that repeat others."""
ADVICE = (
    *"WAF WBF WA WB SAF HAF SBF HBF VAX VAY VBX VBY SA HA SB HB UX UY VX VY E EM".split(),
    *"MUP DVA DVB EL".split(),
)
"""Values that could be given, in the order in which they are suggested."""


@dataclass(frozen=True)
class Test:
    """A measured value beside the others (Baarda 1968).

    Parameters
    ----------
    measured, adjusted : float
        The value as measured, and in this impact.
    by_others : float
        The value that the others alone give it; NaN if they do not.
    sd : float
        Its standard deviation.
    residual : float
        Adjustment over the standard deviation of the adjustment; 0 for a value that no other
        checks.
    """

    measured: float
    adjusted: float
    by_others: float
    sd: float
    residual: float


@dataclass(frozen=True)
class Evidence:
    """Agreement of the known values: sum of squared misfits, its degrees of freedom, and the
    probability of one as large or larger."""

    squares: float
    redundancy: int
    probability: float
    at_odds: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Reconstruction:
    """One impact that agrees with what is known, or the nearest one.

    Parameters
    ----------
    values : mapping of str to float
        Every result that is determined, by name, in the units of what is known.
    intervals : mapping of str to (float, float)
        90 % intervals: of the draws, or to first order where there are none.
    assumed : mapping of str to str
        What was assumed of inputs that are not given.
    verdict : {"agrees", "at a limit", "impossible", "contradictory"}
        Agreement with what is known and with physics.
    tests : mapping of str to Test
        Measured values beside the others, the one most at odds first.
    solutions : int
        Number of impacts that agree with what is known.
    draws : mapping of str to ndarray
        Random draws by result; empty if there are none.
    sampling_error : float
        Largest Monte Carlo standard error of an interval's end, relative to the interval's width.
    evidence : Evidence
        Agreement of the known values.
    laws : tuple of MissedLaw
        All laws that known values violate.
    broken : mapping of str to float
        Conditions of physics that are broken without limits, or at which the impact lies, with the
        value of the result that they limit (`CONDITIONS`).
    drivers : mapping of str to mapping of str to float
        Result -> measured value -> share of the variance, largest first.
    undetermined : tuple of str
        Results that the known values leave open.
    advice : tuple of str
        Values that would determine them.
    excluded : mapping of str to str
        Results that need inputs that are not given.
    remarks : tuple of str
        What was made of the problem.
    search : tuple of int, int, float
        Starts that ended in an impact, impacts, expected number not seen.
    known : mapping of str to Amount
        What was known.
    point : bool
        True for point masses.

    Examples
    --------
    >>> known = {"M": 4, "MA": 950, "MB": 770, "SA": "5.5 +- .2", "HA": 0, "SB": 0, "E": 0.2}
    >>> found = impact88.reconstruct(known, samples=0)[0]
    >>> found.verdict, round(found.values["DVA"], 2), found.drivers["DVA"]
    ('agrees', 2.95, {'SA': 1.0})
    """

    values: Mapping[str, float]
    intervals: Mapping[str, tuple[float, float]]
    assumed: Mapping[str, str]
    verdict: str
    tests: Mapping[str, Test]
    solutions: int = 1
    draws: Mapping[str, Array] = field(default_factory=dict)
    sampling_error: float = 0.0
    evidence: Evidence
    laws: tuple[MissedLaw, ...] = ()
    broken: Mapping[str, float]
    drivers: Mapping[str, Mapping[str, float]]
    undetermined: tuple[str, ...]
    advice: tuple[str, ...]
    excluded: Mapping[str, str]
    remarks: tuple[str, ...]
    search: tuple[int, int, float] = (0, 0, 0.0)
    known: Mapping[str, Amount] = field(default_factory=dict, repr=False)
    point: bool

    @property
    def is_adverse(self) -> bool:
        """True if no impact that physics allows agrees with what is known."""
        return self.verdict in ADVERSE

    def scene(self) -> dict[str, float]:
        """Return the impact as a scene for the 1988 program.

        Returns
        -------
        dict of str to float
            The inputs by the listing's names; MU as typed, which line 400 gives its sign.

        Raises
        ------
        UserError
            If an input is not determined.
        """
        unused = ("EM", "WA", "WB") if self.point else ()
        values = {**dict.fromkeys(unused, 0.0), **self.values}
        inputs = ["MUP" if name == "MU" else name for name in SCENE if name != "M"]
        if open_names := [name for name in inputs if name not in values]:
            names = ", ".join(open_names).replace("MUP", "MU")
            raise UserError(f"the impact found leaves {names} open; expected a determined scene")
        scene = {name: values[name] for name in inputs}
        friction, _ = evaluate({**scene, "M": BODIES}, ("MU",))
        scene["MU"] = float(friction["MU"])
        del scene["MUP"]
        return {**scene, "M": POINT if self.point else BODIES}


def reconstruct(
    known: Mapping[str, Any],
    *,
    samples: int = 20_000,
    seed: int = 0,
    contact_time: float | None = None,
) -> list[Reconstruction]:
    """Return every impact found that agrees with what is known, possible ones first.

    Parameters
    ----------
    known : mapping of str to float, str or Amount
        Known values by name, in one consistent set of units: the scene's names, VAX VAY WAF VBX VBY
        WBF SA SB SAF SBF HA HB HAF HBF PN PT PM MUP DVA DVB DVAF DVAR DVBF DVBR PDOFA PDOFB VC VS
        KI KF EL ELA ELB EBSA EBSB LOSS DT CAF CAL CBF CBL CX CY. A number is exact; a text such as
        "41 +- 2" or an `Amount` is known within its tolerance. M is 6 by default.
    samples : int, default 20000
        Random draws of the impacts that physics allows; 0 for none.
    seed : int, default 0
        Random seed.
    contact_time : float, optional
        Duration of contact, for average and peak forces.

    Returns
    -------
    list of Reconstruction
        Where nothing agrees, the nearest impact that physics allows, with its verdict.

    Raises
    ------
    UserError
        For unknown names, values that cannot be used, and missing inputs.

    Notes
    -----
    Equations 13 to 18. Levenberg-Marquardt from random starts, sequential Monte Carlo, Baarda's
    test; see the guide, "How a reconstruction is computed".

    Examples
    --------
    >>> known = {"M": 4, "MA": 1800, "MB": 1200, "HA": 0, "HB": -90}
    >>> known |= {"SAF": 50, "HAF": -40, "SBF": 30, "HBF": -30}
    >>> round(impact88.reconstruct(known)[0].values["SA"], 2)
    55.62
    """
    amounts = as_amounts(known, KNOWABLE)
    if contact_time is not None and not 0 < contact_time < math.inf:
        raise UserError(f"contact time {contact_time} is not positive; expected a duration")
    problems = [Problem(amounts, sign) for sign in signs_of_friction(amounts)]
    choice = _choose(problems, seed)
    results = [
        replace(
            _describe(fit, verdict),
            search=choice.search,
            solutions=choice.number,
            known={name: amount for name, amount in amounts.items() if name != "M"},
            laws=missed_laws(problems[0].known, problems[0].point),
        )
        for fit, verdict in choice.fits
    ]
    if choice.best and results[0].verdict == "contradictory":
        if choice.best.probability < CONTRADICTION:
            evidence = _evidence(choice.best)
            results[0] = replace(results[0], tests=_tests(choice.best), evidence=evidence)
        else:  # they agree with each other, but not with physics
            results[0] = replace(results[0], broken=_broken(choice.best, choice.best.violations))
    if samples and not results[0].is_adverse:
        fits = [fit for fit, _ in choice.fits]
        results = _with_draws(results, fits, samples, seed)
    return [_with_forces(result, contact_time) for result in results] if contact_time else results


def _with_forces(result: Reconstruction, duration: float) -> Reconstruction:
    """Return a result with the average force over a duration of contact, and the largest of two
    courses of the force (chapter, Section III)."""
    if "P" not in result.values:
        return result
    size = result.values["P"]
    low, high = result.intervals.get("P", (size, size))
    values, intervals = {**result.values, "TF": duration}, {**result.intervals}
    for name, factor in (("FA", 1 / duration), ("FM2", 2 / duration), ("FM3", 3 / duration)):
        values[name] = factor * size
        if low < high:
            intervals[name] = factor * low, factor * high
    return replace(result, values=values, intervals=intervals)


# -- which impacts


class _Choice(NamedTuple):
    """Impacts with their verdicts, the number that agrees, facts of the search, and the ``best``
    impact without regard to physics."""

    fits: list[tuple[Fit, str]]
    number: int
    search: tuple[int, int, float]
    best: Fit | None


def _choose(problems: Sequence[Problem], seed: int) -> _Choice:
    """Return the impacts that agree with what is known, in order, or the nearest."""
    fits: list[Fit] = []
    ends = 0
    for problem in problems:
        minima, number = Search(problem).run(seed)
        fits += minima
        ends += number
    exact = sum(fit.misfit < EXACT_TOL for fit in fits)
    agreeing = [fit for fit in fits if fit.misfit <= EXACT_TOL and _opposes_sliding(fit)]
    agreeing = [fit for fit in agreeing if {*COURSES}.isdisjoint(fit.violations)] or agreeing
    search = (ends, len(agreeing), expected_unseen(exact, ends))
    best = min(agreeing, key=lambda fit: fit.squares, default=None)
    consistent = [fit for fit in agreeing if fit.probability >= CONTRADICTION]
    possible = _in_order([fit for fit in consistent if not fit.violations])
    if possible:
        return _Choice([(fit, "agrees") for fit in possible], len(possible), search, best)
    impossible = [(fit, "impossible") for fit in _in_order(consistent)]
    nearest, verdict, is_softened = _nearest(problems, fits, best, seed)
    choice = [(nearest, verdict)] if nearest else []
    if verdict != "agrees":  # exact values that lead to an impossible impact: it first
        choice = impossible[:1] + choice if is_softened else choice + impossible[:1]
    if not choice:
        raise UserError(
            "no impact comes near what is known; expected velocities and masses in one set of units"
        )
    return _Choice(choice, len(impossible), search, best)


def _opposes_sliding(fit: Fit) -> bool:
    """Return True if the friction opposes the sliding (line 400), or its sign is given."""
    problem = fit.problem
    return not problem.sign or -problem.sign * fit.value("gt") >= -TIE * problem.speed


def _in_order(fits: Sequence[Fit]) -> list[Fit]:
    """Return fits by physics, misfit and energy, without those much worse than the best."""
    least = min((fit.squares for fit in fits), default=0.0)
    likely = [fit for fit in fits if fit.squares <= max(least + LIKELY, TIE)]
    return sorted(likely, key=_rank)


def _rank(fit: Fit) -> tuple[Any, ...]:
    """Return what impacts are ordered by: physics, misfit, friction, and for equal ones numbers
    that no choice of axes, units or names changes the order of."""
    numbers = [fit.value(name) for name in ("KI", "E", "EM", "DVA", "EL")]
    misfit = float(f"{max(fit.squares, TIE):.6e}")
    ties = [float(f"{x:.5e}") if abs(x) > TIE else 0.0 for x in numbers]
    return (misfit, bool(fit.nearest_limits(-STEP)), *ties)


def _nearest(
    problems: Sequence[Problem], fits: Sequence[Fit], best: Fit | None, seed: int
) -> tuple[Fit | None, str, bool]:
    """Return the admissible impact nearest to what is known, its verdict, and whether exact values
    had to be softened to one tolerance because no admissible impact has them all."""
    fit = _best_within_limits(problems, fits, False, seed) if best else None
    if best and fit:
        if fit.probability < CONTRADICTION:
            return fit, "contradictory", False
        return fit, "agrees" if fit.squares <= best.squares + 1e-6 else "at a limit", False
    fit = _best_within_limits(problems, fits, True, seed)
    is_rounding = not best and min((fit.misfit for fit in fits), default=1.0) < TYPED_TOL
    agrees = fit and is_rounding and fit.probability >= CONTRADICTION
    return fit, "agrees" if agrees else "contradictory", True


def _best_within_limits(
    problems: Sequence[Problem], fits: Sequence[Fit], softens: bool, seed: int
) -> Fit | None:
    """Return the admissible impact with the least sum of squares, None if there is none."""
    nearest = [
        Search(problem.soften(SOFTENED) if softens else problem, limited=True).nearest(
            [fit for fit in fits if fit.problem is problem], seed
        )
        for problem in problems
    ]
    return min(filter(None, nearest), key=lambda fit: fit.squares, default=None)


# -- one impact


def _describe(fit: Fit, verdict: str) -> Reconstruction:
    """Return an impact with everything that is determined, and first-order intervals."""
    problem = fit.problem
    names = [name for name in result_names(problem) if _exists(fit, name)]
    open_names = [name for name in names if fit.is_open(name)]
    values = {
        name: _without_noise(name, fit.value(name), problem.size(name))
        for name in names
        if name not in open_names
    }
    count = fit.open_directions.shape[1]
    slopes = {name: fit.slopes(name)[count:] for name in values}
    intervals: dict[str, tuple[float, float]] = {}
    drivers: dict[str, dict[str, float]] = {}
    if verdict not in ADVERSE:  # the numbers of an adverse one settle nothing
        reach = NormalDist().inv_cdf(INTERVAL[1])
        for name, slope in slopes.items():
            sd = float(np.sqrt(np.square(slope).sum()))
            if sd > RESULT_STEP * problem.size(name):
                intervals[name] = (values[name] - reach * sd, values[name] + reach * sd)
        drivers = {name: _drivers(fit, slope) for name, slope in slopes.items() if slope.any()}
    remarks = [*problem.remarks]
    if abs(fit.value("gn")) <= TIE * problem.speed:
        remarks.append(NO_APPROACH)
    if "EM" in result_names(problem) and not _exists(fit, "EM"):
        remarks.append(ANY_MOMENT)
    vehicles = {n: value for n in VEHICLES if math.isfinite(value := fit.value(n))}
    return Reconstruction(
        values=values | vehicles,
        intervals=intervals,
        assumed=problem.assumed | _motion_ranges(problem, open_names),
        verdict=verdict,
        tests=_tests(fit),
        evidence=_evidence(fit),
        broken=_conditions(fit, verdict),
        drivers=drivers,
        undetermined=tuple(open_names),
        advice=_advice(fit, open_names),
        excluded=problem.excluded,
        remarks=tuple(remarks),
        point=problem.point,
    )


def _motion_ranges(problem: Problem, open_names: Sequence[str]) -> dict[str, str]:
    """Return the ranges of the motions that are left open."""
    names = {*open_names} & {*BEFORE, *SPEEDS} - problem.known.keys()
    return {
        item.name: f"up to {WIDEST:g} times the largest motion given"
        for item in problem.coordinates
        if item.name in names
    }


def result_names(problem: Problem) -> list[str]:
    """Return the results that the vehicles have and that need no input that is not given."""
    names = [name for name in EVERY if name not in problem.excluded]
    if problem.point:
        names = [name for name in names if name not in WITHOUT_ARMS]
    if not math.isfinite(problem.known["MB"].value):  # a barrier
        names = [name for name in names if "B" not in name and name not in ("VX", "VY")]
    return names


def _exists(fit: Fit, name: str) -> bool:
    """Return False for quotients of 0, for the course of a vehicle at rest, and for the EM of an
    impact in which no moment changes any spin."""
    value = fit.value(name)
    is_at_rest = name in COURSES and fit.value(COURSES[name]) < TIE * fit.problem.speed
    is_any_moment = (name, round(value, 9)) == ("EM", WITHOUT_MOMENT)
    return math.isfinite(value) and not (is_at_rest or is_any_moment)


def _without_noise(name: str, value: float, size: float) -> float:
    """Return a value without its rounding; the direction opposite to the axis is 180."""
    if name in ANGLES and value < -180.0 + TIE * size:
        return 180.0
    return value if abs(value) > TIE * size else 0.0


def _conditions(fit: Fit, verdict: str) -> dict[str, float]:
    """Return the conditions that an impossible impact violates, or at which a limited one lies."""
    if verdict == "impossible":
        return _broken(fit, fit.violations)
    if verdict == "at a limit":
        return _broken(fit, fit.nearest_limits(RESULT_STEP))
    return {}


def _broken(fit: Fit, conditions: Iterable[str]) -> dict[str, float]:
    """Return conditions with the values of the results that they limit."""
    return {name: fit.value(CONDITIONS.get(name, name)) for name in conditions}


# -- how far the known values agree


def _evidence(fit: Fit) -> Evidence:
    return Evidence(fit.squares, fit.redundancy, fit.probability, _at_odds(_tests(fit)))


def _tests(fit: Fit) -> dict[str, Test]:
    """Return the measured values beside the others, the one most at odds first."""
    tests = {}
    for item, leverage in zip(fit.search.measured, fit.leverage.tolist(), strict=True):
        measurement, sd = item.amount.value, item.sd
        misfit = float(np.ravel(fit.problem.misfit(fit.impacts, item))[0])
        visible = 1.0 - leverage  # part of an error that the adjustment shows
        by_others, residual = math.nan, 0.0
        if visible > CHECKED:
            by_others = measurement + misfit / visible
            residual = misfit / (sd * math.sqrt(visible))
        tests[item.name] = Test(measurement, measurement + misfit, by_others, sd, residual)
    return dict(sorted(tests.items(), key=lambda pair: -round(abs(pair[1].residual), 6)))


def _at_odds(tests: Mapping[str, Test]) -> tuple[str, ...]:
    """Return the values that are together most at odds with the others, first what would have to
    move least in its own standard deviations."""
    largest = max((test.residual**2 for test in tests.values()), default=0.0)
    if largest < 1.0:
        return ()
    moves = {
        name: abs(test.by_others - test.measured) / test.sd
        for name, test in tests.items()
        if test.residual**2 >= NAMED_RATIO * largest
    }
    return tuple(sorted(moves, key=moves.__getitem__)[:MAX_NAMED])


# -- what results depend on


def _drivers(fit: Fit, slope: Array) -> dict[str, float]:
    """Return the measured values' shares of the variance of a result, largest first."""
    squares = np.square(slope)
    pairs = zip(fit.search.measured, squares / squares.sum(), strict=True)
    large = {item.name: float(share) for item, share in pairs if share >= CHECKED}
    return dict(sorted(large.items(), key=lambda pair: -pair[1]))


def _advice(fit: Fit, open_names: Sequence[str]) -> tuple[str, ...]:
    """Return values that would determine the results left open: each of them is independent, over
    the open directions, of those named before."""
    names: list[str] = []
    rows: list[Array] = []
    for name in ADVICE:
        if name in open_names and name not in fit.problem.known:
            table = np.stack([*rows, fit.open_slopes(name)])
            if np.linalg.matrix_rank(table, RESULT_STEP) > len(rows):
                rows.append(table[-1])
                names.append(name)
    return tuple(names)


# -- draws


def _with_draws(
    results: Sequence[Reconstruction], fits: Sequence[Fit], samples: int, seed: int
) -> list[Reconstruction]:
    """Return results with draws and their intervals, where anything varies."""
    draws: dict[Problem, Sample | None] = {}
    completed = []
    for result, fit in zip(results, fits, strict=True):
        if fit.open_directions.size or fit.redundancy:
            if fit.problem not in draws:
                draws[fit.problem] = sample(fit.problem, samples, seed)
            result = _with_sample(result, fit, draws[fit.problem])
        elif fit.sensitivity.any():
            result = _with_sample(result, fit, push_forward(fit, samples, seed))
        completed.append(result)
    return sorted(completed, key=lambda result: result.is_adverse)


def _with_sample(result: Reconstruction, fit: Fit, draws: Sample | None) -> Reconstruction:
    """Return a result with the intervals of draws; a contradiction if there are none
    and no impact has all values within their limits."""
    if draws is None:
        if not Search(fit.problem, limited=True, within=True).nearest([fit]):
            return replace(result, verdict="contradictory", intervals={}, drivers={})
        return replace(result, remarks=(*result.remarks, OUTSIDE))
    exact = {name for name, amount in fit.problem.known.items() if not amount.varies}
    columns, intervals, error = {}, dict(result.intervals), 0.0
    for name in result_names(fit.problem):
        if name not in result.values and name not in result.undetermined:
            continue
        column = unwrap_angles(name, draws[name], result.values.get(name))
        if np.isfinite(column).all():
            columns[name] = column
            if name not in exact and np.ptp(column) > RESULT_STEP * fit.problem.size(name):
                low, high = _interval(column, result.values.get(name, float(np.median(column))))
                is_reversed = name in ANGLES and high - low > 180.0 - RESULT_STEP
                intervals[name] = (-180.0, 180.0) if is_reversed else (low, high)
                if name in result.intervals or name in result.undetermined:
                    error = max(error, sampling_error(column, (low, high), draws.family))
    return replace(
        result,
        intervals=intervals,
        draws=columns,
        sampling_error=error,
        assumed=_with_ends(result.assumed, intervals),
    )


def _interval(column: Array, value: float) -> tuple[float, float]:
    """Return the 90 % interval of draws: between equal tails, or beginning or ending at the value
    if it would lie outside."""
    share = INTERVAL[1] - INTERVAL[0]
    rank = (column < value).mean()
    level = np.clip(INTERVAL[0], rank - share, rank)
    low, high = np.quantile(column, (level, min(level + share, 1.0))).tolist()
    return min(low, value), max(high, value)


def _with_ends(
    assumed: Mapping[str, str], intervals: Mapping[str, tuple[float, float]]
) -> dict[str, str]:
    """Return what was assumed, with the ends of ranges that intervals reach: these follow from the
    range, not from what is known."""
    words = dict(assumed)
    for name in {*RANGES} & {*assumed} & {*intervals}:
        pairs = zip(RANGES[name], intervals[name], strict=True)
        ends = [f"{end:g}" for end, x in pairs if abs(x - end) < NARROWED]
        if ends:
            words[name] += f" (the interval reaches {' and '.join(ends)})"
    return words
