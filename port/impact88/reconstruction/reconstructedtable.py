"""A reconstruction with its tolerances, as tables to read and as JSON to process: what was measured
and how it was adjusted, what follows, and how uncertain that is in three ways side by side."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ..collision.geometry import within_doubles
from ..collision.uncertain import Uncertain
from ..collision.units import RULES, System, display_values
from ..mechanics.state import COURSES, FORCES, SPEEDS
from ..messages import notebook
from ..messages.arguments import explains_arguments
from ..messages.plaintable import format_fixed, number, paragraph, table
from ..names import COEFFICIENTS, FINAL_STATE, VELOCITIES, quantity
from ..uncertainty.boundstable import unbounded
from . import adjustment
from .adjustment import Reconstruction, typed_friction
from .posterior import SIGMAS
from .reconstructed import MIN_GAIN, Draws, Range, draws, ranges
from .solutiontable import DRIVERS, NOISE, ROUNDING, Impact, completed, in_turn

_RESULTS = (*VELOCITIES, *FINAL_STATE, *SPEEDS, *COURSES, "DVA", "DVB")
_RESULTS = (*_RESULTS, "PDOFA", "PDOFB", "VC", "VS", "LOSS", *COEFFICIENTS)
_ANSWERS = ("SA", "SB", "DVA", "DVB")
"""What the answer holds, known within limits or not."""
QUANTILES = (0.05, 0.5, 0.95)
"""The median and the middle 90 % of the draws."""
MOST_CORRELATED = 7
"""Columns of correlations: what 96 characters hold."""
MOST_APART = 1 / 3
"""First-order deviations that differ from the draws' by more, as a fraction, are not shown."""
MOST_FOLDED = 6  # results that are named where branches meet
MOST_SEPARATING = 0.005  # draws that do not approach, as a fraction, that nothing is said of
ILL_POSED = 0.25
"""From this share of the largest speed, a velocity's standard deviation is called ill-posed."""


def _along_an_axis(solution: Reconstruction, name: str) -> bool:
    """Whether a course says no more than the velocity's components do."""
    components = SPEEDS[COURSES[name]] if name in COURSES else ()
    known = solution.system.known
    return any(n in known and known[n].nominal == 0 and not known[n].varies for n in components)


def _is_within_limits(solution: Reconstruction) -> bool:
    """Return whether an impact meets all limits of what is known, normal values `SIGMAS` wide."""
    known = solution.system.known
    limits = [(item.adjusted, *known[item.name].limits(SIGMAS)) for item in solution.adjusted]
    return all(low <= value <= high for value, low, high in limits)


def _ends(bound: Range) -> tuple[float, float]:
    """Return the bounds, 0 where the search for them does not tell one from 0."""
    width = bound.upper - bound.lower
    if not math.isfinite(width):
        return bound.lower, bound.upper
    lower, upper = (0.0 if abs(x) < MIN_GAIN * width else x for x in (bound.lower, bound.upper))
    return lower, upper


class Measured(Impact):
    """A reconstruction, everything that follows from it (`solutiontable.completed`), and how
    uncertain the results ``wanted`` are, or those that were not known: first-order ``deviations``
    and ``correlations``, the ``drivers`` of each and, for ``samples`` above 0 and tolerances that
    were given, ``draws`` and bounds, ``ranges``."""

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
        super().__init__(known, completed(values, contact_time))
        self.solution, self.undetermined = solution, solution.undetermined
        several = solution.search.impacts > 1 and not solution.search.possible
        if any(item.varies for item in known.values()):
            # within the limits there are others, of which physics may allow some
            self.subject = "the impact that fits best"
            if several:
                self.subject = "each of the impacts that fit best"
        elif several:
            self.subject = "every impact that agrees with what is known"
        self.helpful = solution.helpful if solution.undetermined else ()
        results = wanted or [
            n
            for n in _RESULTS
            if (n not in known or (n in _ANSWERS and known[n].varies))
            and not _along_an_axis(solution, n)
        ]
        names = [name for name in results if name in solution.values]
        self.deviations = solution.deviations(names)
        # what the exact values alone determine is not uncertain
        names = [n for n in names if self.deviations[n] > 1e-9 * solution.system.scale(n)]
        self.names, self.correlations = names, solution.correlations(names)
        self.draws: Draws | None = None
        self.ranges: dict[str, Range] = {}
        self.evidence = solution.evidence
        infeasible = False
        if like is not None and like.draws and {*names} <= {*like.draws.values}:
            # the distribution is one, whichever impact it is begun about
            self.draws, self.ranges = like.draws, {n: like.ranges[n] for n in names}
        elif samples and names and not self.evidence.contradictory:
            self.draws = draws(solution, names, samples, seed, progress)
            self.ranges = ranges(solution, names, seed, self.draws, progress)
            infeasible = any(math.isnan(bound.lower) for bound in self.ranges.values())
        elif samples and names and not solution.assumed:
            bound = ranges(solution, names[:1], seed, None, progress)[names[0]]
            infeasible = math.isnan(bound.lower)
        self.not_drawn = infeasible and _is_within_limits(solution)
        if infeasible:
            self.draws, self.ranges = None, {}
            if not self.not_drawn:
                self.evidence = solution.weigh_evidence(inside=False)
        if not solution.assumed:
            widening = max(self.evidence.widening, 1.0)
            self.deviations = {n: x * widening for n, x in self.deviations.items()}
        self.first_order: dict[str, float | None] = {**self.deviations}
        for name in names if self.draws else ():
            drawn = float(np.nanstd(self.draws.values[name], ddof=1)) if self.draws else math.nan
            if not abs(self.deviations[name] - drawn) <= MOST_APART * drawn:
                self.first_order[name], self.deviations[name] = None, drawn
        for name in {*names} & {*solution.folded}:
            self.first_order[name] = None
            if not self.draws:
                self.deviations[name] = math.nan
        self.drivers: dict[str, list[tuple[str, float]]] = {}
        for name, responses in zip(names, solution.responses(names), strict=True):
            shares = responses**2 / (np.square(responses).sum() or 1.0)
            ranked = np.argsort(-shares, kind="stable")
            self.drivers[name] = [(solution.system.observations[i], shares[i]) for i in ranked]

    @property
    def uncertainties(self) -> Mapping[str, float]:
        known = self.solution.system.known
        measured = {a.name: known[a.name].standard_deviation for a in self.solution.adjusted}
        return {**measured, **self.deviations}

    def headline(self, units: System) -> list[tuple[str, str]]:
        broken = [*super().headline(units)]
        search, evidence = self.solution.search, ("EVIDENCE", self.evidence.text(units))
        rows = [evidence, *broken] if self.evidence.contradictory else [*broken, evidence]
        if not search.single:
            rows.append(("SEARCH", search.text()))
        return rows

    @within_doubles
    def warnings(self, units: System = RULES) -> list[str]:
        solution, lines = self.solution, []
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
                "the sliding before the impact joins what is known"
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
        if folded := [name for name in self.names if name in solution.folded]:
            texts = []
            for name in folded[:MOST_FOLDED]:
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
        lines += self._ill_posed(units)
        if self.not_drawn:
            lines.append(
                "this impact lies within the limits of all known values, but the search for draws "
                "and bounds found none there: there are neither"
            )
        if self.evidence.inside is False:
            lines.append(
                "no impact was found that lies within the limits of all known values at once: "
                "there are neither draws nor bounds"
            )
        if apart := self.separating:
            lines.append(
                f"{100 * apart:.2g} % of the draws separate already before the impact, which meets "
                "all known values and is no impact; a course or a closing speed would exclude them"
            )
        if self.draws and self.draws.signs is None and len(solution.beside) > 1:
            lines.append(
                f"draws and bounds are about this impact only, one of {len(solution.beside)} that "
                "were found; they may be too narrow"
            )
        if unsearched := self.not_searched:
            lines.append(
                "the search for bounds ended before its time; not searched to the end, and perhaps "
                f"wider: {' '.join(unsearched)}"
            )
        if self.draws and self.draws.failed:
            lines.append(f"{100 * self.draws.failed:.3g} % of the draws have no solution")
        return lines + super().warnings()

    @property
    def not_searched(self) -> list[str]:
        """The results whose bounds may be wider: the search took all it may."""
        return [name for name, bound in self.ranges.items() if not bound.searched]

    @property
    def separating(self) -> float:
        """The fraction of draws whose contact points do not approach, if it is more than a few."""
        if self.draws is None or "VC" not in self.draws.values:
            return 0.0
        share = float((self.draws.values["VC"] < 0).mean())
        return share if share > MOST_SEPARATING else 0.0

    def _apart(self, name: str, deviation: float) -> list[float]:
        """Return the values of a result in the impacts found, the least first, where its draws are
        of several, farther apart than their standard deviation; else none."""
        if not (self.draws and self.draws.signs is not None):
            return []
        values = sorted(
            float(np.ravel(system.state(x)[name])[0]) for system, x in self.solution.beside
        )
        gaps = np.diff(values)
        return values if len(gaps) and gaps.max() > deviation else []

    def _ill_posed(self, units: System) -> list[str]:
        """Velocities that the known values hardly determine, with the number and what drives it."""
        system, lines = self.solution.system, []
        for name in self.names:
            deviation = self.deviations[name]
            share = deviation / system.scale(name)
            if name in (*VELOCITIES, *FINAL_STATE) and share > ILL_POSED:
                if apart := self._apart(name, deviation):
                    amounts = [number(units.display_unwrapped(name, value), 3) for value in apart]
                    listed = " or ".join(dict.fromkeys(amounts))
                    lines.append(
                        f"{name} is about {listed} {units.unit(name)}".rstrip()
                        + ", in another impact each; draws and bounds have all of them"
                    )
                    continue
                driver, part = self.drivers[name][0]
                size = f"{number(deviation * units.factor(name), 3)} {units.unit(name)}".rstrip()
                lines.append(
                    f"ill-posed: {name} has a standard deviation of {size}, {100 * share:.0f} % of "
                    f"the largest speed; {100 * part:.0f} % of its variance comes from {driver}"
                )
        e = self.solution.values.get("E")
        ill_posed = any(line.startswith("ill-posed") for line in lines)
        if ill_posed and e and "E" in system.known and abs(e) < ILL_POSED:
            lines.append(
                f"E = {number(e, 3)} divides: errors after the impact grow 1/E = {1 / e:.3g} times"
            )
        return lines

    def further(self, units: System) -> list[list[str]]:
        return [self._adjustments(units), self._spreads(units), *self._connections(units)]

    def _correlations(self, units: System) -> Any:
        """Return the correlations of results as they are shown."""
        signs = np.array([-1.0 if units.is_turned(name) else 1.0 for name in self.names])
        return np.asarray(self.correlations) * np.outer(signs, signs) if len(signs) else []

    def _adjustments(self, units: System) -> list[str]:
        count = self.solution.redundancy
        if not count:
            return []
        rows = []
        for a in self.solution.adjusted:
            item = self.solution.system.known[a.name]
            half = math.nan if item.kind == "normal" else a.tolerance
            rounding = abs(a.adjusted) < NOISE * item.standard_deviation
            adjusted = 0.0 if rounding else a.adjusted
            measured, now = (
                units.display_unwrapped(a.name, float(x)) for x in (a.measured, adjusted)
            )
            factor = units.factor(a.name)
            sizes = [(measured, 6), (half * factor, 3), (item.standard_deviation * factor, 3)]
            cells = [number(x, n) for x, n in (*sizes, (now, 6))]
            rows.append(
                [
                    a.name,
                    *cells,
                    format_fixed(a.normalized_residual, 2),
                    units.label(quantity(a.name).unit),
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

    def _spreads(self, units: System) -> list[str]:
        heading = ["result", "first order sd"]
        if self.draws:
            heading += ["draws sd", *(f"{100 * share:g} %" for share in QUANTILES)]
            heading += ["lower bound", "upper bound"]
        rows = []
        for name in self.names:
            factor = units.factor(name)
            plain = self.first_order[name]
            cells = [name, "" if plain is None else number(factor * plain, 3)]
            if self.draws:
                drawn, bound = self.draws.spread(name, QUANTILES), self.ranges[name]
                cells.append(number(factor * drawn.deviation, 3))
                quantiles = [units.display_unwrapped(name, q) for q in drawn.quantiles.values()]
                quantiles = quantiles[::-1] if units.is_turned(name) else quantiles
                limits = (*quantiles, *units.ends(name, *_ends(bound)))
                cells += [number(value, 5) for value in limits]
            rows.append([*cells, units.label(quantity(name).unit)])
        lines = table(rows, [*heading, "unit"], left=(0, len(heading))) if rows else []
        if self.draws and self.draws.signs is not None and rows:
            lines += paragraph(
                "Draws and bounds: over every impact that meets all known values, of all branches; "
                "flat, where nothing is known, over velocities before, e, e_m and P_t/P_n"
            )
            if any(self.first_order[n] is None for n in self.names):
                lines += paragraph(
                    "The first order is left out where it differs from the draws by more than a "
                    "third."
                )
        return lines

    def _connections(self, units: System) -> list[list[str]]:
        names = self.names
        # the unknowns themselves: courses and speeds are made of them
        at = [i for i, n in enumerate(names) if n not in (*SPEEDS, *COURSES)][:MOST_CORRELATED]
        matrix = self._correlations(units)
        rows = [[names[i], *(f"{matrix[i, k]:.2f}" for k in at if k <= i)] for i in at]
        correlations = table(rows, ["correlation", *(names[i] for i in at)])
        driving = [
            [name, *(f"{n} {100 * share:.0f} %" for n, share in drivers[:DRIVERS] if share >= 5e-3)]
            for name, drivers in self.drivers.items()
        ]
        columns = table(driving, ["uncertain through", *[""] * DRIVERS], left=(0, 1, 2, 3))
        return [correlations if len(at) > 1 else [], columns if driving else []]

    def more(self, units: System) -> dict[str, Any]:
        solution, adjusted = self.solution, []
        for a in solution.adjusted:
            deviation = solution.system.known[a.name].standard_deviation
            small = abs(a.adjusted) < max(
                ROUNDING * solution.system.scale(a.name), NOISE * deviation
            )
            sizes = {
                "measured": units.display_unwrapped(a.name, float(a.measured)),
                "tolerance": units.factor(a.name) * a.tolerance,
                "adjusted": units.display_unwrapped(a.name, 0.0 if small else float(a.adjusted)),
            }
            adjusted.append({"name": a.name, **sizes, "moved": a.normalized_residual})
        return {
            "undetermined": solution.undetermined,
            "adjusted": adjusted,
            "redundancy": solution.redundancy,
            "sum_of_squares": solution.squares,
            "evidence": self.evidence.as_json(units),
            "search": {**solution.search._asdict(), "text": solution.search.text()},
            "equal_tolerances_assumed": solution.assumed,
            "uncertainty": {name: self._uncertain(name, units) for name in self.names},
            "correlations": {"names": self.names, "matrix": self._correlations(units)},
            "draws_without_solution": self.draws.failed if self.draws else None,
            "not_searched": self.not_searched,
        }

    def _uncertain(self, name: str, units: System) -> dict[str, Any]:
        factor, plain = units.factor(name), self.first_order[name]
        record: dict[str, Any] = {
            "first_order": None if plain is None else plain * factor,
            "drivers": dict(self.drivers[name]),
        }
        if self.draws:
            drawn, bound = self.draws.spread(name, QUANTILES), self.ranges[name]
            lower, upper = units.ends(name, *_ends(bound))
            at = (bound.at_lower, bound.at_upper)
            values = [units.display_unwrapped(name, value) for value in drawn.quantiles.values()]
            if units.is_turned(name):  # quantiles stand in pairs about the half
                at, values = at[::-1], values[::-1]
            quantiles = dict(zip(drawn.quantiles, values, strict=True))
            record |= {
                "mean": units.display_unwrapped(name, drawn.mean),
                "deviation": drawn.deviation * factor,
                "quantiles": {f"{q:g}": v for q, v in quantiles.items()},
                "lower": lower,
                "upper": upper,
                "unbounded": unbounded(bound),
                "at_lower": display_values(at[0], units),
                "at_upper": display_values(at[1], units),
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
        """What `impact88 reconstruct --samples 0` prints, as a notebook shows it."""
        return notebook.preformatted_html(in_turn([Measured(impact, 0) for impact in self]))


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
        units. The vehicles and their geometry must be known. A number is exact; a text such as
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
