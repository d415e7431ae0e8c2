"""The answer: which impacts agree with what is known, in what order, and how sure they are.

The sum of squared misfits of r redundant values, each in standard deviations, follows the
chi-square distribution with r degrees of freedom if the tolerances are right. The value most at
odds with the others has the largest standardized residual (Baarda 1968).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from statistics import NormalDist
from typing import Any

import numpy as np

from ..cases.amounts import Amount
from ..errors import UserError
from ..mechanics.solve import evaluate
from ..names import SCENE
from .draws import MIN_FAMILIES, Sample, sample
from .fit import EXACT_TOL, TYPED_TOL, Fit, Search, expected_unseen
from .impacts import AFTER, BEFORE, COURSES, IMPULSES, SPEEDS, VEHICLES, Array
from .known import as_amounts
from .laws import MissedLaw, missed_laws
from .problem import ANGLES, ARMS, RANGES, WIDEST, Problem, signs_of_friction, unwrapped

CONTRADICTION = 1e-3  # probability of a misfit below which values contradict one another
LIKELY = 9.0  # sum of squares above the least, up to which an impact is shown
TIE = 1e-9  # differences in typical sizes that are rounding
SOFTENED = 0.01  # tolerance of exact values that contradict one another, in typical sizes
CHECKED = 0.02  # least part of a variance that counts
NAMED_RATIO = 0.9  # squared residual, relative to the largest, from which a value is named with it
MAX_NAMED = 3
INTERVAL = (0.05, 0.95)
STEP = 1e-6  # of difference quotients, in typical sizes; a smaller change is rounding
NARROWED = 0.1  # an interval that ends within this part of an assumed range reaches its end

OUTSIDE = "no impact within all limits was found: intervals are to first order"
ADVERSE = ("impossible", "contradictory")
BOUNDED = ("SA", "SB", "DVA", "DVB")
CORRELATED = ("UX", "UY", "VX", "VY", "SA", "SB", "DVA", "DVB", "PDOFA", "PDOFB", "E", "MUP", "EM")
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
EVERY = (
    *BEFORE,
    *AFTER,
    *"SA HA SB HB SAF HAF SBF HBF E MUP EM PN PT PM P DVA DVB DVAF DVAR DVBF DVBR".split(),
    *"PDOFA PDOFB VC VS KI KF EL LOSS DT MUC RR0 ELN ELT ELM EESA EESB".split(),
    *"XA YA XB YB XAF YAF XBF YBF CAX CAY CBX CBY".split(),
)
"""Results of an impact, in the order shown."""
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
        The value that the others alone give it.
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

    @property
    def move(self) -> float:
        """Distance to what the others give it, in its standard deviations."""
        return abs(self.by_others - self.measured) / self.sd


@dataclass(frozen=True)
class Evidence:
    """Agreement of the known values: sum of squared misfits, its degrees of freedom, and the
    probability of one as large or larger."""

    squares: float
    redundancy: int
    probability: float
    at_odds: tuple[str, ...] = ()


@dataclass(frozen=True)
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
    law : MissedLaw or None
        The law that known values violate most.
    tests : mapping of str to Test
        Measured values beside the others, the one most at odds first.
    solutions : int
        Number of impacts that agree with what is known.
    draws : mapping of str to ndarray
        Random draws by result; empty if there are none.
    deviations : mapping of str to float
        Standard deviations to first order.
    bounds : mapping of str to (float, float)
        Least and greatest values found within all limits.
    evidence : Evidence
        Agreement of the known values.
    laws : tuple of MissedLaw
        All laws that known values violate.
    broken : mapping of str to float
        Conditions of physics that the impact breaks or lies at, with the amount in typical sizes.
    drivers : mapping of str to mapping of str to float
        Result -> measured value -> share of the variance, largest first.
    correlations : mapping of (str, str) to float
        Correlations of results, to first order.
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
    intervals: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    assumed: Mapping[str, str] = field(default_factory=dict)
    verdict: str = "agrees"
    law: MissedLaw | None = None
    tests: Mapping[str, Test] = field(default_factory=dict)
    solutions: int = 1
    draws: Mapping[str, Array] = field(default_factory=dict)
    deviations: Mapping[str, float] = field(default_factory=dict)
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    evidence: Evidence = Evidence(0.0, 0, 1.0)
    laws: tuple[MissedLaw, ...] = ()
    broken: Mapping[str, float] = field(default_factory=dict)
    drivers: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    correlations: Mapping[tuple[str, str], float] = field(default_factory=dict)
    undetermined: tuple[str, ...] = ()
    advice: tuple[str, ...] = ()
    excluded: Mapping[str, str] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    search: tuple[int, int, float] = (0, 0, 0.0)
    known: Mapping[str, Amount] = field(default_factory=dict, repr=False)
    point: bool = False

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
        absent = [name for name in SCENE if name not in ("M", "MU") and name not in self.values]
        if self.point:
            absent = [name for name in absent if name not in ("EM", "WA", "WB")]
        if absent or "MUP" not in self.values:
            names = ", ".join(absent or ["MU"])
            raise UserError(f"the impact found leaves {names} open; expected a determined scene")
        scene = {name: self.values.get(name, 0.0) for name in SCENE if name not in ("M", "MU")}
        typed, _ = evaluate({**scene, "M": 6.0, "MUP": self.values["MUP"]}, ("MU",))
        scene["MU"] = float(typed["MU"])
        return {**scene, "M": 4.0 if self.point else 6.0}


def reconstruct(
    known: Mapping[str, Any],
    *,
    samples: int = 20_000,
    seed: int = 0,
    contact_time: float | None = None,
    progress: Callable[[float], object] | None = None,
) -> list[Reconstruction]:
    """Return every impact found that agrees with what is known, possible ones first.

    Parameters
    ----------
    known : mapping of str to float, str or Amount
        Known values by name, in one consistent set of units (see `KNOWABLE`). A number is exact; a
        text such as "41 +- 2" or an `Amount` is known within its tolerance. M is 6 by default.
    samples : int, default 20000
        Random draws of the impacts that physics allows; 0 for none.
    seed : int, default 0
        Random seed.
    contact_time : float, optional
        Duration of contact, for average and peak forces.
    progress : callable, optional
        Called with the fraction done.

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
    found = _find(problems, seed)
    results = [_describe(fit, verdict, contact_time) for fit, verdict in found.fits]
    laws = missed_laws(problems[0].known, problems[0].point)
    results = [
        replace(
            result,
            search=found.search,
            solutions=found.count,
            known={name: amount for name, amount in amounts.items() if name != "M"},
            laws=laws,
            law=laws[0] if laws else None,
        )
        for result in results
    ]
    if found.agreeing and results[0].verdict == "contradictory":
        best = min(found.agreeing, key=lambda fit: fit.squares)
        if best.probability < CONTRADICTION:
            near = _Neighbourhood(best)
            results[0] = replace(results[0], tests=_tests(near), evidence=_evidence(near))
        else:  # they agree with each other, but not with physics
            results[0] = replace(results[0], broken=best.broken())
    if samples and results[0].verdict in ("agrees", "at a limit"):
        results = _with_draws(results, found.fits, problems, samples, seed, progress)
    return results


# -- which impacts


@dataclass
class _Found:
    """Impacts with their verdicts, all fits that agree with exact values, and search facts."""

    fits: list[tuple[Fit, str]]
    agreeing: list[Fit]
    count: int
    search: tuple[int, int, float]


def _find(problems: Sequence[Problem], seed: int) -> _Found:
    """Return the impacts that agree with what is known, in order, or the nearest."""
    fits: list[Fit] = []
    ended = 0
    for problem in problems:
        minima, number = Search(problem).run(seed)
        fits += minima
        ended += number
    exact = sum(fit.missed < EXACT_TOL for fit in fits)
    search = (ended, exact, expected_unseen(exact, ended) if exact else 0.0)
    agreeing = [fit for fit in fits if fit.missed <= EXACT_TOL and _opposes_sliding(fit)]
    consistent = [fit for fit in agreeing if fit.probability >= CONTRADICTION]
    possible = [fit for fit in consistent if not fit.broken()]
    if possible:
        chosen = _ordered(possible)
        return _Found([(fit, "agrees") for fit in chosen], agreeing, len(chosen), search)
    broken = [(fit, "impossible") for fit in _ordered(consistent)]
    nearest, softened = _nearest(problems, fits, agreeing, seed)
    if nearest and nearest[0][1] == "agrees":
        chosen_fits = nearest
    elif broken and softened:  # exact values lead to an impossible impact: it first
        chosen_fits = broken[:1] + nearest
    else:
        chosen_fits = nearest + broken[:1]
    if not chosen_fits:
        raise UserError(
            "no impact comes near what is known; expected velocities and masses in one set of units"
        )
    return _Found(chosen_fits, agreeing, len(broken), search)


def _opposes_sliding(fit: Fit) -> bool:
    """Return True if the friction opposes the sliding (line 400), or its sign is given."""
    problem = fit.problem
    return not problem.sign or -problem.sign * fit.value("gt") >= -TIE * problem.speed


def _ordered(fits: Sequence[Fit]) -> list[Fit]:
    """Return fits by physics, misfit and energy, without those much worse than the best, and
    without vehicles that drive backwards along a known course unless all do."""
    forward = [fit for fit in fits if not driving_backwards(fit)] or list(fits)
    least = min((fit.squares for fit in forward), default=0.0)
    likely = [fit for fit in forward if fit.squares <= max(least + LIKELY, TIE)]
    return sorted(likely, key=_rank)


def _rank(fit: Fit) -> tuple[Any, ...]:
    """Return what impacts are ordered by: physics, misfit, friction, and for equal ones numbers
    that no choice of axes, units or names changes the order of."""
    numbers = [fit.value(name) for name in ("KI", "E", "EM", "DVA", "EL")]
    numbers = [x for x in numbers if math.isfinite(x)]
    numbers += [fit.value("SA" + x) + fit.value("SB" + x) for x in ("", "F")]
    numbers.append(abs(fit.value("MUP")))
    misfit = float(f"{max(fit.squares, TIE):.6e}")
    rounded = (float(f"{x:.5e}") if abs(x) > TIE else 0.0 for x in numbers)
    return (bool(fit.broken()), misfit, bool(fit.broken(friction=True)), *rounded)


def driving_backwards(fit: Fit) -> list[str]:
    """Return the speeds that are negative along a known course."""
    speeds = dict(zip(fit.names, fit.point, strict=True))
    return [name for name in SPEEDS if speeds.get(name, 0.0) < -1e-6 * fit.problem.speed]


def _nearest(
    problems: Sequence[Problem], fits: Sequence[Fit], agreeing: Sequence[Fit], seed: int
) -> tuple[list[tuple[Fit, str]], bool]:
    """Return the admissible impact nearest to what is known, and whether exact values had to be
    softened to one tolerance because no admissible impact has them all."""
    if problems[0].forbidden:
        return [], True
    for soften in (False, True) if agreeing else (True,):
        limited: list[Fit] = []
        for problem in problems:
            search = Search(problem.softened(SOFTENED) if soften else problem, limited=True)
            near = [fit for fit in fits if fit.problem is problem]
            first = [np.array([fit.value(name) for name in search.names]) for fit in near]
            limited += search.run(seed, [point for point in first if np.isfinite(point).all()])[0]
        limited = [fit for fit in limited if fit.missed <= 1e-5]
        if not limited:
            continue
        best = min(limited, key=lambda fit: fit.squares)
        if soften:
            rounding = min((fit.missed for fit in fits), default=1.0) < TYPED_TOL and not agreeing
            return [(best, "agrees" if rounding else "contradictory")], True
        if best.probability < CONTRADICTION:
            return [(best, "contradictory")], False
        fits_best = best.squares <= min(fit.squares for fit in agreeing) + 1e-6
        return [(best, "agrees" if fits_best else "at a limit")], False
    return [], True


# -- one impact


class _Neighbourhood:
    """A fit with the impacts around it: values, and slopes along ``shifts`` of the coordinates."""

    def __init__(self, fit: Fit) -> None:
        self.fit, self.problem = fit, fit.problem
        self.impacts = fit.problem.impacts(fit.names, fit.point[None])
        self.open = fit.open_directions.shape[1]
        self._shifts = np.concatenate([fit.open_directions.T, fit.sensitivity.T])
        sizes = np.array([fit.problem.size(name) for name in fit.names])
        self._lengths = np.abs(self._shifts / sizes).max(1, initial=1e-300)[:, None]
        steps = STEP * self._shifts / self._lengths
        self._moved = fit.problem.impacts(fit.names, fit.point + np.concatenate([steps, -steps]))

    def value(self, name: str) -> float:
        """Return a result of the impact."""
        with np.errstate(all="ignore"):
            return float(np.ravel(self.problem.quantity(self.impacts, name))[0])

    def slopes(self, name: str) -> Array:
        """Return changes of a result: along open directions, then by a standard deviation of each
        measured value."""
        count = len(self._shifts)
        with np.errstate(all="ignore"):
            column = self.problem.quantity(self._moved, name)
        column = np.broadcast_to(column, 2 * count)
        change = column[:count] - column[count:]
        if name in ANGLES:
            change = (change + 180.0) % 360.0 - 180.0
        return np.asarray(change / (2 * STEP) * self._lengths[:, 0])

    def open_slopes(self, name: str) -> Array:
        """Return changes of a result along open directions, in typical sizes."""
        lengths = self._lengths[: self.open, 0]
        return np.asarray(self.slopes(name)[: self.open] / lengths / self.problem.size(name))

    def is_open(self, name: str) -> bool:
        """Return True for a result that the known values leave open."""
        return bool((np.abs(self.open_slopes(name)) > STEP).any())


def _describe(fit: Fit, verdict: str, contact_time: float | None) -> Reconstruction:
    """Return an impact with everything that is determined, and first-order deviations."""
    problem, near = fit.problem, _Neighbourhood(fit)
    names = [n for n in result_names(problem) if _exists(near, n)]
    undetermined = [name for name in names if near.is_open(name)]
    settled = [name for name in names if name not in undetermined]
    values = {n: _without_noise(n, near.value(n), problem.size(n)) for n in settled}
    slopes = {name: near.slopes(name)[near.open :] for name in settled}
    if contact_time is not None and "P" in values:
        values["TF"] = contact_time
        for name, times in (("FA", 1.0), ("FM2", 2.0), ("FM3", 3.0)):  # chapter, Section III
            values[name] = times * values["P"] / contact_time
            slopes[name] = times * slopes["P"] / contact_time
    deviations = {name: float(np.sqrt(np.square(s).sum())) for name, s in slopes.items()}
    is_adverse = verdict in ADVERSE  # its numbers settle nothing
    reach = NormalDist().inv_cdf(INTERVAL[1])
    remarks = [*problem.remarks]
    for name in driving_backwards(fit):
        remarks.append(
            f"{name[1]} drives backwards along its known course H{name[1:]}: no impact was found "
            "in which it does not"
        )
    return Reconstruction(
        values=values | _inputs(near),
        intervals={}
        if is_adverse
        else {
            name: (values[name] - reach * sd, values[name] + reach * sd)
            for name, sd in deviations.items()
            if sd > TIE * abs(values[name])
        },
        assumed=problem.assumed | _unlimited(problem, undetermined),
        verdict=verdict,
        tests=_tests(near),
        deviations=deviations,
        evidence=_evidence(near),
        broken=_broken(fit, verdict),
        drivers={}
        if is_adverse
        else {name: _drivers(fit, slope) for name, slope in slopes.items() if slope.any()},
        correlations=_correlations(slopes),
        undetermined=tuple(undetermined),
        advice=_advice(near, undetermined),
        excluded=problem.excluded,
        remarks=tuple(remarks),
        point=problem.point,
    )


def _unlimited(problem: Problem, undetermined: Sequence[str]) -> dict[str, str]:
    """Return the ranges of the motions that are left open."""
    return {
        item.name: f"up to {WIDEST:g} times the largest motion given"
        for item in problem.coordinates
        if item.name not in problem.known and {item.name} & {*undetermined} & {*BEFORE, *SPEEDS}
    }


def result_names(problem: Problem) -> list[str]:
    """Return the results that the vehicles have and that need no input that is not given."""
    names = [name for name in EVERY if name not in problem.excluded]
    if problem.point:
        names = [name for name in names if name not in WITHOUT_ARMS]
    if not math.isfinite(problem.known["MB"].value):  # a barrier
        names = [name for name in names if "B" not in name and name not in ("VX", "VY")]
    return names


def _exists(near: _Neighbourhood, name: str) -> bool:
    """Return False for quotients of 0 and for the course of a vehicle at rest."""
    if not math.isfinite(near.value(name)):
        return False
    at_rest = name in COURSES and near.value(COURSES[name]) < TIE * near.problem.speed
    return not at_rest


def _without_noise(name: str, value: float, size: float) -> float:
    """Return a value without its rounding; the direction opposite to the axis is 180."""
    if name in ANGLES and value < -180.0 + TIE * size:
        return 180.0
    return value if abs(value) > TIE * size else 0.0


def _inputs(near: _Neighbourhood) -> dict[str, float]:
    """Return the vehicles of the impact, for a scene."""
    problem, inputs = near.problem, {}
    for name in VEHICLES:
        point_arm = problem.point and name in (*ARMS, "TA", "TB")
        if not point_arm or name in ("TA", "TB"):
            inputs[name] = near.value(name)
    inputs = {name: value for name, value in inputs.items() if math.isfinite(value)}
    if problem.point:
        inputs |= {"IA": 1.0, "IB": 1.0, "DA": 0.0, "DB": 0.0, "PA": 0.0, "PB": 0.0}
    return inputs


def _broken(fit: Fit, verdict: str) -> dict[str, float]:
    """Return the conditions that an impossible impact breaks, or at which a limited one lies."""
    if verdict == "impossible":
        return fit.broken()
    if verdict != "at a limit":
        return {}
    impacts = fit.problem.impacts(fit.names, fit.point[None])
    margins = fit.problem.margins(impacts)
    return {name: 0.0 for name, margin in margins if float(np.ravel(margin)[0]) < STEP}


# -- how far the known values agree


def _evidence(near: _Neighbourhood) -> Evidence:
    fit = near.fit
    return Evidence(fit.squares, fit.redundancy, fit.probability, _at_odds(_tests(near)))


def _tests(near: _Neighbourhood) -> dict[str, Test]:
    """Return the measured values beside the others, the one most at odds first."""
    fit, problem = near.fit, near.problem
    tests = {}
    for k, item in enumerate(fit.measured):
        sd = item.sd
        misfit = float(np.ravel(problem.misses(near.impacts, item))[0])
        checked = 1.0 - float(fit.leverage[k])  # part of an error that the adjustment shows
        if checked <= CHECKED:
            misfit_of_others, residual = 0.0, 0.0
        else:
            misfit_of_others = misfit / checked
            residual = misfit / (sd * math.sqrt(checked))
        measured = item.amount.value
        tests[item.name] = Test(
            measured, measured + misfit, measured + misfit_of_others, sd, residual
        )
    return dict(sorted(tests.items(), key=lambda pair: -abs(pair[1].residual)))


def _at_odds(tests: Mapping[str, Test]) -> tuple[str, ...]:
    """Return the values that are together most at odds with the others, first what would have to
    move least in its own standard deviations."""
    largest = max((test.residual**2 for test in tests.values()), default=0.0)
    if largest < 1.0:
        return ()
    together = [n for n, test in tests.items() if test.residual**2 >= NAMED_RATIO * largest]
    return tuple(sorted(together, key=lambda name: tests[name].move)[:MAX_NAMED])


# -- what results depend on


def _drivers(fit: Fit, slope: Array) -> dict[str, float]:
    """Return the measured values' shares of the variance of a result, largest first."""
    squares = np.square(slope)
    shares = zip((item.name for item in fit.measured), squares / squares.sum(), strict=True)
    large = {name: float(share) for name, share in shares if share >= CHECKED}
    return dict(sorted(large.items(), key=lambda pair: -pair[1]))


def _correlations(slopes: Mapping[str, Array]) -> dict[tuple[str, str], float]:
    """Return correlations of the results that are not determined by exact values alone."""
    varied = [name for name in CORRELATED if name in slopes and slopes[name].any()]
    unit = {name: slopes[name] / np.sqrt(np.square(slopes[name]).sum()) for name in varied}
    return {
        (first, second): float((unit[first] * unit[second]).sum())
        for k, first in enumerate(varied)
        for second in varied[:k]
    }


def _advice(near: _Neighbourhood, undetermined: Sequence[str]) -> tuple[str, ...]:
    """Return values that would determine the results left open: each of them is independent, over
    the open directions, of those named before."""
    names: list[str] = []
    rows = np.empty((0, near.open))
    relevant = [near.open_slopes(name) for name in undetermined]
    needed = np.linalg.matrix_rank(np.stack(relevant), STEP) if relevant else 0
    for name in ADVICE:
        if name in near.problem.known or name not in undetermined or len(names) == needed:
            continue
        more = np.concatenate([rows, near.open_slopes(name)[None]])
        if np.linalg.matrix_rank(more, STEP) > len(rows):
            rows = more
            names.append(name)
    return tuple(names)


# -- draws


def _with_draws(
    results: Sequence[Reconstruction],
    fits: Sequence[tuple[Fit, str]],
    problems: Sequence[Problem],
    samples: int,
    seed: int,
    progress: Callable[[float], object] | None,
) -> list[Reconstruction]:
    """Return results with draws, intervals and bounds, where anything varies."""
    if not any(fit.sensitivity.any() or fit.open_directions.size for fit, _ in fits):
        return list(results)
    drawn: dict[int, Sample | None] = {}
    extended = []
    for result, (fit, _) in zip(results, fits, strict=True):
        key = id(fit.problem)
        if key not in drawn and fit.problem.coordinates:
            drawn[key] = sample(fit.problem, samples, seed, progress=progress)
        extended.append(_with_sample(result, drawn.get(key), seed))
    return extended


def _with_sample(result: Reconstruction, drawn: Sample | None, seed: int) -> Reconstruction:
    """Return a result with the intervals and bounds of draws."""
    if drawn is None:
        return replace(result, remarks=(*result.remarks, OUTSIDE))
    if drawn.families < MIN_FAMILIES:
        remark = (
            f"the draws tell no more than {drawn.families:.0f} independent ones would: intervals "
            "are to first order; narrower tolerances help"
        )
        return replace(result, remarks=(*result.remarks, remark))
    names = [
        n for n in result_names(drawn.problem) if n in result.values or n in result.undetermined
    ]
    columns = {name: unwrapped(name, drawn[name], result.values.get(name)) for name in names}
    columns = {name: x for name, x in columns.items() if np.isfinite(x).all()}
    intervals = dict(result.intervals)
    for name, column in columns.items():
        if name in result.undetermined or name in intervals:
            low, high = np.quantile(column, INTERVAL).tolist()
            intervals[name] = (low, high)
    bounded = [name for name in BOUNDED if name in intervals and name in result.values]
    return replace(
        result,
        intervals=intervals,
        draws=columns,
        bounds=drawn.bounds(bounded, seed) if bounded else {},
        assumed=_reached(result.assumed, columns),
    )


def _reached(assumed: Mapping[str, str], columns: Mapping[str, Array]) -> dict[str, str]:
    """Return what was assumed, with the ends of ranges that intervals reach: these follow from the
    range, not from what is known."""
    words = dict(assumed)
    for name in ("E", "EM"):
        if name not in assumed or name not in columns:
            continue
        low, high = RANGES[name]
        first, last = np.quantile(columns[name], INTERVAL).tolist()
        margin = NARROWED * (high - low)
        ends = [
            f"{end:g}" for end, near in ((low, first - low), (high, high - last)) if near < margin
        ]
        if ends:
            words[name] += f" (the interval reaches {' and '.join(ends)})"
    return words
