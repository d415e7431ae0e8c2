"""A reconstruction with its tolerances, as tables to read and as JSON to process: measured and
adjusted values, results, and their uncertainty to first order, from draws and as bounds."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ...collision.geometry import within_doubles
from ...collision.uncertain import Uncertain
from ...collision.units import RULES, System, display_values
from ...mechanics.outcome import broken_laws
from ...mechanics.state import COURSES, FORCES, SPEEDS
from ...messages import notebook
from ...messages.arguments import explains_arguments
from ...messages.plaintable import format_fixed, number, paragraph, table
from ...names import COEFFICIENTS, FINAL_STATE, VELOCITIES, quantity
from ..uncertainty.boundstable import unbounded_sides
from . import adjustment
from .admissible import ENDS
from .evidence import AGREE
from .nearest import counts, refusal
from .posterior import MAX_VELOCITY, MIN_SIZE
from .reconstructed import MIN_GAIN, Draws, Range, draws, ranges
from .solution import Reconstruction, typed_friction
from .solutiontable import DRIVERS, NOISE, ROUNDING, Impact, join_texts, with_derived_values

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
    *COEFFICIENTS,
)
_ANSWERS = ("SA", "SB", "DVA", "DVB")  # results of the answer, uncertain even where they are known
QUANTILES = (0.05, 0.5, 0.95)  # the median and the middle 90 % of the draws
MAX_CORRELATION_COLUMNS = 7  # as many as 96 characters hold
FIRST_ORDER_RTOL = 1 / 3  # first-order deviations farther from the draws' are not shown
MAX_ENDS_NAMED = 4  # results whose interval ends at a condition
MAX_FOLDED_NAMED = 6  # results named where branches meet
MIN_SAID = 0.005  # fraction of draws above which a remark is made
ILL_POSED = 0.25  # standard deviation of a velocity, relative to the largest speed


def _along_an_axis(solution: Reconstruction, name: str) -> bool:
    """Return True if a course is along an axis: it is implied by a velocity component that is 0."""
    components = SPEEDS[COURSES[name]] if name in COURSES else ()
    known = solution.system.known
    return any(n in known and known[n].nominal == 0 and not known[n].varies for n in components)


def _bounds_without_noise(bound: Range) -> tuple[float, float]:
    """Return the bounds, 0 where they are below the resolution of the search."""
    width = bound.upper - bound.lower
    if not math.isfinite(width):
        return bound.lower, bound.upper
    lower, upper = (0.0 if abs(x) < MIN_GAIN * width else x for x in (bound.lower, bound.upper))
    return lower, upper


class Measured(Impact):
    """A reconstruction, everything that follows from it, and the uncertainty of results.

    ``wanted``: the results, by default those that were not known. First-order ``deviations`` and
    ``correlations``, the ``drivers`` of each result and, for ``samples`` above 0 and given
    tolerances, ``draws`` and bounds (``ranges``). ``like``: another impact of the same
    distribution, whose draws and bounds are used."""

    @within_doubles
    def __init__(
        self,
        solution: Reconstruction,
        samples: int,
        seed: int = 0,
        wanted: Sequence[str] | None = None,
        contact_time: float | None = None,
        progress: Callable[[int], object] = lambda draws: None,
        like: "Measured | None" = None,
    ) -> None:
        known, values = solution.system.known, dict(solution.values)
        if "MUP" in values and "UX" in values:
            values["MU"] = typed_friction(solution.system.state(solution.x), values["MUP"])
        super().__init__(known, with_derived_values(values, contact_time))
        self.solution, self.undetermined = solution, solution.undetermined
        self.subject = self._name_subject()
        self.helpful = solution.helpful if solution.undetermined else ()
        self.remarks, self.absent = solution.remarks, solution.absent
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
        if self.is_empty:
            self.not_drawn = solution.is_within_limits
            if not self.not_drawn:
                self.evidence = solution.weigh_evidence(inside=False)
        self.deviations = solution.deviations(self.names)
        self.first_order: dict[str, float | None] = {}
        self._judge_first_order()
        self.drivers = self._find_drivers()

    def _name_subject(self) -> str:
        """Return what a sentence on broken physics is about."""
        solution = self.solution
        has_alternatives = solution.search.impacts > 1 and not solution.search.possible
        if any(item.varies for item in solution.system.known.values()):
            # other impacts within the limits may be possible
            return (
                "each of the impacts that fit best"
                if has_alternatives
                else ("the impact that fits best")
            )
        return "every impact that agrees with what is known" if has_alternatives else self.subject

    def _uncertain_results(self, wanted: Sequence[str] | None) -> list[str]:
        """Return the results asked for, by default what was not known, without those that exact
        values determine."""
        solution, known = self.solution, self.solution.system.known
        results = wanted or [
            n
            for n in _RESULTS
            if (n not in known or (n in _ANSWERS and known[n].varies))
            and not _along_an_axis(solution, n)
        ]
        names = [name for name in results if name in solution.values]
        deviations = solution.deviations(names)
        return [n for n in names if deviations[n] > 1e-9 * solution.system.scale(n)]

    def _take_draws_of(self, other: "Measured") -> None:
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

    def _draw(self, samples: int, seed: int, progress: Callable[[int], object]) -> None:
        """Draw, and search for bounds; ``refused``: draws that do not suffice. Of values that
        contradict one another only whether any impact lies within their limits."""
        if self.evidence.contradictory:
            if not self.solution.assumed:
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
        """Standard deviations of results and of adjusted values."""
        known = self.solution.system.known
        measured = {a.name: known[a.name].standard_deviation for a in self.solution.adjusted}
        return {**measured, **self.deviations}

    def headline(self, units: System) -> list[tuple[str, str]]:
        """Return labels and texts to print above the answer: broken physics, the evidence, the
        search."""
        broken_rules = [*super().headline(units)]
        search, verdict = self.solution.search, self.evidence.text(units)
        if self.solution.impossible and self.evidence.verdict == AGREE:
            verdict = f"in an impact that physics forbids, {verdict}"
        evidence = ("EVIDENCE", verdict)
        rows = (
            [evidence, *broken_rules] if self.evidence.contradictory else [*broken_rules, evidence]
        )
        if not search.single:
            rows.append(("SEARCH", search.text()))
        if self.solution.impossible and self.draws:
            rows.append(("POSSIBLE", f"{self._possible_speeds(units)}; their draws are below"))
        elif self.solution.nearest is not None:
            row = ("NO IMPACT", self._refusal(units) or "")
            rows.insert(1 if self.evidence.contradictory else 0, row)
        elif self.solution.impossible and self.is_empty:
            rows.append(("POSSIBLE", "no impact that physics allows lies within all limits"))
        return rows

    def _refusal(self, units: System) -> str | None:
        """Return why no impact that physics allows agrees with what is known, None if one does."""
        if self.draws or self.solution.nearest is None:
            return None
        return refusal(self.solution, self.solution.nearest, units)

    def _possible_speeds(self, units: System) -> str:
        """Return the 90 % intervals of speeds and courses of the possible impacts."""
        assert self.draws is not None
        parts = []
        for name in ("SA", "HA", "SB", "HB"):
            if name in self.draws.values:
                ends = self.draws.spread(name, (QUANTILES[0], QUANTILES[-1])).quantiles.values()
                low, high = sorted(units.display_unwrapped(name, end) for end in ends)
                unit = units.unit(name)
                parts.append(f"{name} {number(low, 3)} to {number(high, 3)} {unit}".rstrip())
        intervals = f": 90 % have {', '.join(parts)}" if parts else ""
        return f"impacts that physics allows lie within all limits{intervals}"

    @within_doubles
    def warnings(self, units: System = RULES) -> list[str]:
        """Return the warnings, a sentence each."""
        solution, lines = self.solution, []
        if solution.limited:
            ends = " and ".join(ENDS[name] for name in solution.limited)
            lines.append(
                f"the values fit best where {ends}: beyond, an impossible impact fits better"
            )
        if solution.undetermined:
            lines.append(f"not determined by what is known: {' '.join(solution.undetermined)}")
        for name in solution.backwards:
            what = "is pushed away from" if name in FORCES else "drives backwards along"
            lines.append(
                f"{name[-1]} {what} its known {'PDOF' if name in FORCES else 'course'}: {name} = "
                f"{number(solution.system.nominal[name], 4)} was given, this impact has "
                f"{number(solution.values[name], 4)}; none was found that does not "
                f"({solution.search.text()})"
            )
        if solution.against_sign:
            lines.append(
                "neither sign of MU is the one that line 400 gives it: no friction that opposes "
                "the sliding before the impact is consistent with the known values"
            )
        if solution.assumed:
            unit = f" {units.label('length')}" if not units.is_bare else ""
            lines.append(
                "the known values contradict one another and none has a tolerance: all known "
                "velocities were given the same one (spins that divided by the radius of gyration, "
                f"{number(units.display_value('length', solution.system.gyration), 4)}{unit}); "
                "deviations are those of the misfit"
            )
        elif self.evidence.contradictory:
            lines.append(
                f"{self.evidence.text(units)}; standard deviations are widened "
                f"{number(self.evidence.widening, 3)} times"
            )
        if folded_names := [name for name in self.names if name in solution.folded]:
            texts = []
            for name in folded_names[:MAX_FOLDED_NAMED]:
                value, scale = solution.values[name], solution.system.scale(name)
                value = 0.0 if abs(value) < 1e-6 * scale else value
                # a direction opposite to the axis is 180, from either side
                opposite = name in (*COURSES, *FORCES) and value < -179.9995
                value = 180.0 if opposite else value
                texts.append(f"{name} about {number(units.display_unwrapped(name, value), 4)}")
            amounts = ", ".join(texts)
            both = ", and draws and bounds have both" if self.draws else ""
            lines.append(
                f"two branches of impacts meet here ({amounts}): to first order nothing limits "
                f"these, so no first-order deviation is given{both}"
            )
        lines += self._ill_posed_warnings(units)
        if self.not_drawn and not solution.impossible:
            lines.append(
                "this impact lies within the limits of all known values, but the search for draws "
                "and bounds found none there: there are neither"
            )
        if self.evidence.inside is False:
            lines.append(
                "no impact was found that lies within the limits of all known values at once: "
                "there are neither draws nor bounds"
            )
        lines += self._draws_warnings()
        if not_searched := self.not_searched:
            lines.append(
                "the search for bounds ended before its time; not searched to the end, and perhaps "
                f"wider: {' '.join(not_searched)}"
            )
        return lines + super().warnings()

    @property
    def not_searched(self) -> list[str]:
        """Results whose bounds may be wider: the search did not converge."""
        return [name for name, bound in self.ranges.items() if not bound.searched]

    def _draws_warnings(self) -> list[str]:
        """Return the warnings about the draws: too few, cut off, or beyond strict friction."""
        if self.refused is not None:
            return [
                f"the draws tell no more than {self.refused.effective:.0f} independent ones would "
                f"(expected {MIN_SIZE}): there are neither draws nor bounds; narrower limits help"
            ]
        if self.draws is None:
            return []
        lines: list[str] = []
        by_condition: dict[str, list[str]] = {}
        for name in self.names:
            for side, condition in zip(("below", "above"), self.draws.cut_by[name], strict=True):
                if condition:
                    by_condition.setdefault(condition, []).append(f"{name} {side}")
        for condition, ends in by_condition.items():
            more = f" and {len(ends) - MAX_ENDS_NAMED} more" if len(ends) > MAX_ENDS_NAMED else ""
            named = ", ".join(ends[:MAX_ENDS_NAMED]) + more
            lines.append(f"the interval ends where {ENDS[condition]}: {named}")
        if self.draws.beyond_friction > MIN_SAID:
            lines.append(
                f"{100 * self.draws.beyond_friction:.2g} % of the draws need more friction than "
                "what only ends the sliding, as some staged collisions do"
            )
        if self.draws.unlimited > MIN_SAID:
            lines.append(
                f"{100 * self.draws.unlimited:.2g} % of the draws are limited only by a largest "
                f"velocity of {MAX_VELOCITY:g} times the largest known speed: the known values "
                "leave velocities open"
            )
        return lines

    def _separate_values(self, name: str, deviation: float) -> list[float]:
        """Return the values of a result in all possible impacts found, sorted, if draws cover
        several of them and these are farther apart than the standard deviation; else none."""
        if not self.draws:
            return []
        values = sorted(
            float(np.ravel(state[name])[0])
            for state in (system.state(x) for system, x in self.solution.beside)
            if not broken_laws(state).any()
        )
        gaps = np.diff(values)
        return values if len(gaps) and gaps.max() > deviation else []

    def _ill_posed_warnings(self, units: System) -> list[str]:
        """Return a warning for each velocity that the known values hardly determine, with its
        deviation and the value that causes it."""
        system, lines = self.solution.system, []
        for name in self.names:
            deviation = self.deviations[name]
            fraction = deviation / system.scale(name)
            if name in (*VELOCITIES, *FINAL_STATE) and fraction > ILL_POSED:
                if alternatives := self._separate_values(name, deviation):
                    amounts = [
                        number(units.display_unwrapped(name, value), 3) for value in alternatives
                    ]
                    alternatives_text = " or ".join(dict.fromkeys(amounts))
                    lines.append(
                        f"{name} is about {alternatives_text} {units.unit(name)}".rstrip()
                        + ", in another impact each; draws and bounds have all of them"
                    )
                    continue
                driver, part = self.drivers[name][0]
                size = f"{number(deviation * units.factor(name), 3)} {units.unit(name)}".rstrip()
                lines.append(
                    f"poorly determined: {name} has a standard deviation of {size}, "
                    f"{100 * fraction:.0f} % of the largest speed; {100 * part:.0f} % "
                    f"of its variance comes from {driver}"
                )
        e = self.solution.values.get("E")
        ill_posed = any(line.startswith("poorly determined") for line in lines)
        if ill_posed and e and "E" in system.known and abs(e) < ILL_POSED:
            lines.append(
                f"E = {number(e, 3)} divides: errors after the impact grow 1/E = {1 / e:.3g} times"
            )
        return lines

    def further_tables(self, units: System) -> list[list[str]]:
        """Return the tables of adjusted values, spreads, correlations and drivers."""
        return [
            self._adjustment_table(units),
            self._spread_table(units),
            *self._correlation_tables(units),
        ]

    def _correlations(self, units: System) -> Any:
        """Return the correlations of results, with the signs of the system of units."""
        signs = np.array([-1.0 if units.is_turned(name) else 1.0 for name in self.names])
        return np.asarray(self.correlations) * np.outer(signs, signs) if len(signs) else []

    def _adjustment_table(self, units: System) -> list[str]:
        """Return the table of measured and adjusted values; empty without redundancy."""
        count = self.solution.redundancy
        if not count:
            return []
        rows = []
        for entry in self.solution.adjusted:
            item = self.solution.system.known[entry.name]
            half_width = math.nan if item.kind == "normal" else entry.tolerance
            rounding = abs(entry.adjusted) < NOISE * item.standard_deviation
            adjusted_value = 0.0 if rounding else entry.adjusted
            measured_value, shown_value = (
                units.display_unwrapped(entry.name, float(x))
                for x in (entry.measured, adjusted_value)
            )
            factor = units.factor(entry.name)
            sizes = [
                (measured_value, 6),
                (half_width * factor, 3),
                (item.standard_deviation * factor, 3),
            ]
            cells = [number(x, n) for x, n in (*sizes, (shown_value, 6))]
            rows.append(
                [
                    entry.name,
                    *cells,
                    format_fixed(entry.normalized_residual, 2),
                    units.label(quantity(entry.name).unit),
                ]
            )
        heading = ["known", "measured", "half-width", "sd", "adjusted", "moved, tolerances", "unit"]
        return [
            *table(rows, heading, left=(0, 6)),
            "A tolerance is the half-width of limits, or the sd of a normal value.",
            *paragraph(
                "Adjusted by least squares so that Equations 13 to 18 hold exactly (adjustment of "
                f"observations with conditions): {count} value{'s' if count > 1 else ''} more than "
                f"needed, sum of squared adjustments {self.evidence.sum_text} (in "
                f"standard deviations; about {count} where the tolerances are right)"
            ),
        ]

    def _spread_table(self, units: System) -> list[str]:
        """Return the table of results: first-order deviations, and deviations, quantiles and bounds
        from draws."""
        heading = ["result", "first order sd"]
        if self.draws:
            heading += ["draws sd", *(f"{100 * fraction:g} %" for fraction in QUANTILES)]
            heading += ["lower bound", "upper bound"]
        rows = []
        for name in self.names:
            factor = units.factor(name)
            first_order = self.first_order[name]
            cells = [name, "" if first_order is None else number(factor * first_order, 3)]
            if self.draws:
                spread, bound = self.draws.spread(name, QUANTILES), self.ranges[name]
                cells.append(number(factor * spread.deviation, 3))
                quantiles = [units.display_unwrapped(name, q) for q in spread.quantiles.values()]
                quantiles = quantiles[::-1] if units.is_turned(name) else quantiles
                limits = (*quantiles, *units.ends(name, *_bounds_without_noise(bound)))
                cells += [number(value, 5) for value in limits]
            rows.append([*cells, units.label(quantity(name).unit)])
        lines = table(rows, [*heading, "unit"], left=(0, len(heading))) if rows else []
        if self.draws and rows:
            lines += paragraph(
                f"Draws and bounds: {self.draws.counted}; flat, where nothing is known, over "
                f"velocities before, e, e_m and P_t/P_n; as much as {self.draws.effective:.0f} "
                "independent draws"
            )
            if any(self.first_order[n] is None for n in self.names):
                lines += paragraph(
                    "The first order is left out where it differs from the draws by more than a "
                    "third."
                )
        return lines

    def _correlation_tables(self, units: System) -> list[list[str]]:
        """Return the tables of correlations and of drivers."""
        names = self.names
        # courses and speeds follow from the components
        columns_shown = [i for i, n in enumerate(names) if n not in (*SPEEDS, *COURSES)][
            :MAX_CORRELATION_COLUMNS
        ]
        matrix = self._correlations(units)
        rows = [
            [names[i], *(f"{matrix[i, k]:.2f}" for k in columns_shown if k <= i)]
            for i in columns_shown
        ]
        correlations = table(rows, ["correlation", *(names[i] for i in columns_shown)])
        driving = [
            [
                name,
                *(
                    f"{n} {100 * fraction:.0f} %"
                    for n, fraction in drivers[:DRIVERS]
                    if fraction >= 5e-3
                ),
            ]
            for name, drivers in self.drivers.items()
        ]
        columns = table(driving, ["uncertain through", *[""] * DRIVERS], left=(0, 1, 2, 3))
        return [correlations if len(columns_shown) > 1 else [], columns if driving else []]

    def json_items(self, units: System) -> dict[str, Any]:
        """Return the JSON items of a reconstruction."""
        solution, adjusted_items = self.solution, []
        for item in solution.adjusted:
            deviation = solution.system.known[item.name].standard_deviation
            is_noise = abs(item.adjusted) < max(
                ROUNDING * solution.system.scale(item.name), NOISE * deviation
            )
            sizes = {
                "measured": units.display_unwrapped(item.name, float(item.measured)),
                "tolerance": units.factor(item.name) * item.tolerance,
                "adjusted": units.display_unwrapped(
                    item.name, 0.0 if is_noise else float(item.adjusted)
                ),
            }
            adjusted_items.append({"name": item.name, **sizes, "moved": item.normalized_residual})
        return {
            "undetermined": solution.undetermined,
            "adjusted": adjusted_items,
            "redundancy": solution.redundancy,
            "sum_of_squares": solution.squares,
            "evidence": self.evidence.as_json(units),
            "search": {**solution.search._asdict(), "text": solution.search.text()},
            "limited_by": list(solution.limited),
            "no_impact": self._refusal(units),
            "equal_tolerances_assumed": solution.assumed,
            "uncertainty": {name: self._uncertainty_json(name, units) for name in self.names},
            "correlations": {"names": self.names, "matrix": self._correlations(units)},
            "counted": self.draws.counted if self.draws else None,
            "effective_draws": self.draws.effective if self.draws else None,
            "beyond_strict_friction": self.draws.beyond_friction if self.draws else None,
            "not_searched": self.not_searched,
        }

    def _uncertainty_json(self, name: str, units: System) -> dict[str, Any]:
        """Return the uncertainty of one result as JSON."""
        factor, first_order = units.factor(name), self.first_order[name]
        record: dict[str, Any] = {
            "first_order": None if first_order is None else first_order * factor,
            "drivers": dict(self.drivers[name]),
        }
        if self.draws:
            spread, bound = self.draws.spread(name, QUANTILES), self.ranges[name]
            lower, upper = units.ends(name, *_bounds_without_noise(bound))
            points = (bound.at_lower, bound.at_upper)
            values = [units.display_unwrapped(name, value) for value in spread.quantiles.values()]
            if units.is_turned(name):  # quantiles stand in pairs about the half
                points, values = points[::-1], values[::-1]
            quantiles = dict(zip(spread.quantiles, values, strict=True))
            record |= {
                "mean": units.display_unwrapped(name, spread.mean),
                "deviation": spread.deviation * factor,
                "quantiles": {f"{q:g}": v for q, v in quantiles.items()},
                "lower": lower,
                "upper": upper,
                "unbounded": unbounded_sides(bound),
                "at_lower": display_values(points[0], units),
                "at_upper": display_values(points[1], units),
            }
        return record


class Reconstructions(list[Reconstruction]):
    """The impacts that agree with what is known, the likeliest first.

    A list, which a notebook shows as the command prints it.

    Parameters
    ----------
    iterable : iterable of Reconstruction, optional
        The impacts.

    Examples
    --------
    >>> known = {name: text for name, text in impact88.sample(1).items() if name != "MU"}
    >>> impacts = impact88.reconstruct({**known, "VAX": "-13.3 +- 0.5"})
    >>> [impact.redundancy for impact in impacts]
    [0]
    """

    def _repr_html_(self) -> str:
        """Return the output of `impact88 reconstruct --samples 0` as HTML for a notebook."""
        return notebook.preformatted_html(join_texts([Measured(impact, 0) for impact in self]))


@explains_arguments
def reconstruct(known: Mapping[str, Uncertain | float | str]) -> Reconstructions:
    """Return every impact that agrees with what is known of it.

    Equations 13 to 18 hold exactly, and so do exact values. Where more is known than needed, values
    with a tolerance are adjusted by least squares.

    Parameters
    ----------
    known : mapping of str to float, str or Uncertain
        What is known, by name (``UX`` ... ``WB``, ``VAX`` ... ``WBF``, ``E``, ``EM``, ``MU`` or
        ``MUP``, ``SA``, ``HA``, ``DVA``, ``PDOFA``, ``EL`` and so on), in one consistent set of
        units. The masses must be known. A number is exact; a text such as
        ``"41 +- 2"`` or an `Uncertain` is known within its tolerance. M is 6 where left out.

    Returns
    -------
    Reconstructions
        A list of `Reconstruction`: possible impacts before those that break physics, each group
        ordered by the sum of squared adjustments. Each has ``values``, ``adjusted``, ``evidence``
        (whether the measurements can all be true), ``deviations(names)`` and ``scene()``.

    Raises
    ------
    UserError
        For a name or a value that cannot be used, and for exact values that contradict one another
        beside others with a tolerance.
    UnsolvableError
        Where what is known determines nothing of what is not.

    Notes
    -----
    Equations 13 to 18 of the chapter; MU is the size of line 280, whose sign line 400 chooses.

    Examples
    --------
    >>> known = {name: text for name, text in impact88.sample(1).items() if name != "MU"}
    >>> best, *others = impact88.reconstruct({**known, "VAX": "-13.3 +- 0.5"})
    >>> round(best.values["VAX"], 1)
    -13.3
    """
    return Reconstructions(adjustment.reconstruct(known))
