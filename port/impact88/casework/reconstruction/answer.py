"""An answer: one impact that agrees with what is known, everything that follows from it, and the
uncertainty of results, to first order, from draws and as bounds."""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from operator import or_
from typing import Any

import numpy as np

from ...collision.geometry import within_doubles
from ...collision.uncertain import Uncertain
from ...collision.units import RULES, System
from ...errors import UserError
from ...mechanics.state import COURSES, SPEEDS
from ...messages.plaintable import number
from ...names import FINAL_STATE, VELOCITIES
from ...status import IMPOSSIBLE, Status, sentences
from . import adjustment
from .derived import NOISE, with_derived_values
from .drawsandbounds import MIN_GAIN, Draws, Range, draws, ranges
from .nearest import counts, refusal
from .solution import Reconstruction

_RESULTS = (
    *VELOCITIES,
    *FINAL_STATE,
    *SPEEDS,
    *COURSES,
    "DVA",
    "DVB",
    "PDOFA",
    "PDOFB",
    "VC",
    "VS",
    "LOSS",
    "E",
    "MUP",
    "EM",
)
_BEFORE = ("SA", "SB", "UX", "UY", "VX", "VY")  # an answer without any of these is none
_ANSWERS = ("SA", "SB", "DVA", "DVB")  # results of the answer, uncertain even where they are known
QUANTILES = (0.05, 0.5, 0.95)  # the median and the middle 90 % of the draws
FIRST_ORDER_RTOL = 1 / 3  # first-order deviations farther from the draws' are not shown
Progress = Callable[[int], object]


def _along_an_axis(solution: Reconstruction, name: str) -> bool:
    """Return True if a course is along an axis: it is implied by a velocity component that is 0."""
    components = SPEEDS[COURSES[name]] if name in COURSES else ()
    known = solution.system.known
    return any(n in known and known[n].nominal == 0 and not known[n].varies for n in components)


def bounds_without_noise(bound: Range) -> tuple[float, float]:
    """Return the bounds, 0 where they are below the resolution of the search."""
    width = bound.upper - bound.lower
    if not math.isfinite(width):
        return bound.lower, bound.upper
    lower, upper = (0.0 if abs(x) < MIN_GAIN * width else x for x in (bound.lower, bound.upper))
    return lower, upper


class Answer:
    """A reconstruction, everything that follows from it, and the uncertainty of results. Exact
    values are measurements of no tolerance: nothing is then uncertain.

    ``wanted``: the results, by default those that were not known. First-order ``deviations`` and
    ``correlations``, the ``drivers`` of each result and, for ``samples`` above 0 and given
    tolerances, ``draws`` and bounds (``ranges``). ``like``: another impact of the same
    distribution, whose draws and bounds are used. ``given``: what the user knows, by name."""

    @within_doubles
    def __init__(
        self,
        solution: Reconstruction,
        samples: int,
        seed: int = 0,
        wanted: Sequence[str] | None = None,
        contact_time: float | None = None,
        progress: Progress = lambda draws: None,
        like: "Answer | None" = None,
    ) -> None:
        self.solution, self.known = solution, solution.system.known
        values = dict(solution.values)
        if "MUP" in values and "UX" in values:
            values["MU"] = solution.typed_friction
        self.values = with_derived_values(values, contact_time)
        self.undetermined, self.absent = solution.undetermined, solution.absent
        self.remarks: Sequence[str] = solution.remarks
        self.given: Mapping[str, Any] = self.known
        self.names = self._uncertain_results(wanted)
        self.correlations = solution.correlations(self.names)
        self.evidence = solution.evidence
        self.draws: Draws | None = None
        self.ranges: dict[str, Range] = {}
        self.refused: Draws | None = None
        self.is_empty = self.not_drawn = False
        if like is not None:
            self._take_draws_of(like)
        elif samples and self.names:
            self._draw(samples, seed, progress)
        elif samples and not solution.assumed:
            self.is_empty = bool(solution.beyond_limits)  # nothing else can move
        if self.is_empty:
            self.not_drawn = solution.is_within_limits
            if not self.not_drawn:
                self.evidence = solution.weigh_evidence(inside=False)
        self.deviations = solution.deviations(self.names)
        self.first_order: dict[str, float | None] = {}
        self._judge_first_order()
        self.drivers = self._find_drivers()

    def _uncertain_results(self, wanted: Sequence[str] | None) -> list[str]:
        """Return the results asked for, by default what was not known, without those that exact
        values determine."""
        solution, known = self.solution, self.known
        results = wanted or [
            n
            for n in _RESULTS
            if (n not in known or (n in _ANSWERS and known[n].varies))
            and not _along_an_axis(solution, n)
        ]
        names = [name for name in results if name in solution.values]
        deviations = solution.deviations(names)
        return [n for n in names if deviations[n] > 1e-9 * solution.system.scale(n)]

    def _take_draws_of(self, other: "Answer") -> None:
        """Take draws and bounds from another impact of the same distribution; one that does not
        count has no part in it."""
        self.refused = other.refused
        if other.draws and {*self.names} <= {*other.draws.values} and counts(self.solution):
            self.draws, self.ranges = other.draws, {n: other.ranges[n] for n in self.names}

    def _judge_first_order(self) -> None:
        """Widen first-order deviations by the misfit, and leave out those that the draws
        contradict, or that mean nothing where branches meet."""
        if not self.solution.assumed:
            widening = max(self.evidence.widening, 1.0)
            self.deviations = {n: x * widening for n, x in self.deviations.items()}
        deviations = dict(self.deviations)
        self.first_order = {**deviations}
        for name in self.names if self.draws else ():
            assert self.draws is not None
            drawn = float(np.nanstd(self.draws.values[name], ddof=1))
            if not abs(deviations[name] - drawn) <= FIRST_ORDER_RTOL * drawn:
                self.first_order[name], deviations[name] = None, drawn
        for name in {*self.names} & {*self.solution.folded}:
            self.first_order[name] = None
            if not self.draws:
                deviations[name] = math.nan
        self.deviations = deviations

    def _find_drivers(self) -> dict[str, list[tuple[str, float]]]:
        """Return for each result the known values that cause its uncertainty, with their fractions
        of its variance, the largest first."""
        drivers = {}
        responses = self.solution.responses(self.names)
        for name, row in zip(self.names, responses, strict=True):
            fractions = row**2 / (np.square(row).sum() or 1.0)
            order = np.argsort(-fractions, kind="stable")
            observations = self.solution.system.observations
            drivers[name] = [(observations[i], fractions[i]) for i in order]
        return drivers

    def _draw(self, samples: int, seed: int, progress: Progress) -> None:
        """Draw, and search for bounds; ``refused``: draws that do not suffice. Of values that
        contradict one another only whether any impact lies within their limits."""
        if self.solution.assumed:
            return
        if self.evidence.contradictory:
            name = self.names[0]
            bound = ranges(self.solution, [name], seed, None, progress)[name]
            self.is_empty = math.isnan(bound.lower)
            return
        drawn = draws(self.solution, self.names, samples, seed, progress)
        self.is_empty = drawn is None
        if drawn is None:
            return
        if not drawn.suffice:
            self.refused = drawn
            return
        self.draws = drawn
        self.ranges = ranges(self.solution, self.names, seed, drawn, progress)

    @property
    def uncertainties(self) -> Mapping[str, float]:
        """Standard deviations of results and of adjusted values. A value far below its own is
        printed as 0."""
        measured = {
            item.name: self.known[item.name].standard_deviation for item in self.solution.adjusted
        }
        return {**measured, **self.deviations}

    @property
    def has_tolerances(self) -> bool:
        """True if anything is known within a tolerance."""
        return any(item.varies for item in self.known.values())

    @property
    def is_refused(self) -> bool:
        """True if no impact that physics allows agrees with what is known."""
        solution = self.solution
        if self.draws:
            return False
        if solution.nearest is not None:
            return True
        is_settled = self.is_empty or not self.has_tolerances
        return bool(self._broken) and not solution.search.possible and is_settled

    @property
    def _broken(self) -> Status:
        """Rules of physics that the impact breaks. Coefficients given outside their ranges are the
        user's."""
        given = {"E": Status.E_OUT_OF_RANGE, "EM": Status.EM_OUT_OF_RANGE}
        allowed = [bit for name, bit in given.items() if name in self.known]
        return self.solution.impossible & ~reduce(or_, allowed, Status(0))

    @property
    def is_adverse(self) -> bool:
        """True if no impact agrees, values contradict one another, or no velocity before the impact
        was found."""
        least = NOISE * float(self.solution.system.speed)  # 0 across a line is no answer
        is_moving = any(abs(self.values.get(name, 0.0)) > least for name in _BEFORE)
        is_missing = bool({*self.undetermined} & {*VELOCITIES}) and not is_moving
        is_impossible = bool(self._broken) and not self.draws
        return self.is_refused or self.evidence.contradictory or is_impossible or is_missing

    @property
    def impossible(self) -> str:
        """A sentence that names the broken rules of physics; "" for a possible impact."""
        broken = int(self.values.get("STATUS", 0)) & IMPOSSIBLE
        return f"{self._subject} breaks physics: {'; '.join(sentences(broken))}" if broken else ""

    @property
    def _subject(self) -> str:
        search = self.solution.search
        has_alternatives = search.impacts > 1 and not search.possible
        if self.has_tolerances:
            # other impacts within the limits may be possible
            each = "each of the impacts that fit best"
            return each if has_alternatives else "the impact that fits best"
        return "every impact that agrees with what is known" if has_alternatives else "this impact"

    def refusal(self, units: System = RULES) -> str | None:
        """Return why no impact that physics allows agrees with what is known, None if one does."""
        if not self.is_refused:
            return None
        text, given = refusal(self.solution, units), self.known.get("E")
        if given is not None and not given.varies and given.nominal > 1:
            text += f". E = {number(given.nominal, 4)} was given; 1 is the most"
        return text

    @property
    def not_searched(self) -> list[str]:
        """Results whose bounds may be wider: the search did not converge."""
        return [name for name, bound in self.ranges.items() if not bound.searched]

    def signed_correlations(self, units: System) -> Any:
        """Return the correlations of results, with the signs of the system of units."""
        signs = np.array([-1.0 if units.is_turned(name) else 1.0 for name in self.names])
        return np.asarray(self.correlations) * np.outer(signs, signs) if len(signs) else []


def answers(
    known: Mapping[str, Uncertain | float | str],
    samples: int,
    seed: int = 0,
    wanted: Sequence[str] | None = None,
    contact_time: float | None = None,
    progress: Progress = lambda impacts: None,
    remarks: Sequence[str] = (),
) -> list[Answer]:
    """Return every answer to a problem, the likeliest first. ``remarks``: on what was read. Raise
    UserError, for a result of ``wanted`` that is not determined, too."""
    solutions = adjustment.reconstruct(known, progress)
    for name in wanted or ():
        if any(name not in solution.values for solution in solutions):
            reason = solutions[0].explanation
            text = f"{name} is not determined by what is known{': ' * bool(reason)}{reason}"
            raise UserError(text)
    found: list[Answer] = []
    for solution in solutions:
        like = found[0] if found else None
        found.append(Answer(solution, samples, seed, wanted, contact_time, progress, like))
        found[-1].given = known
        found[-1].remarks = [*remarks, *solution.remarks]
    return found
