"""A reconstruction with its tolerances, as tables to read and as JSON to process: what was measured
and how it was adjusted, what follows, and how uncertain that is in three ways side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import notebook
from ..names import COEFFICIENTS, FINAL_STATE, VELOCITIES, quantity
from ..plaintable import number, paragraph, plain, table
from ..reconstruction import adjustment
from ..reconstruction.adjustment import Reconstruction, standard_deviation, typed_friction
from ..reconstruction.answertable import Open, Spread, answer
from ..reconstruction.doublerange import within_doubles
from ..reconstruction.solutiontable import (
    CHANGES,
    completed,
    named_table,
    velocities_table,
)
from ..reconstruction.state import COURSES, FORCES, SPEEDS
from ..status import sentences
from ..units import RULES, System, written
from .boundstable import unbounded
from .reconstructed import Draws, Range, draws, ranges
from .uncertain import Uncertain

_RESULTS = (*VELOCITIES, *FINAL_STATE, *SPEEDS, *COURSES, "DVA", "DVB")
_RESULTS = (*_RESULTS, "PDOFA", "PDOFB", "VC", "VS", "LOSS", *COEFFICIENTS)
_ANSWERS = ("SA", "SB", "DVA", "DVB")
"""What the answer holds, known within limits or not."""
QUANTILES = (0.05, 0.5, 0.95)
MOST_CORRELATED = 7
DRIVERS = 3
ILL_POSED = 0.25
"""From this share of the largest speed, a velocity's standard deviation is called ill-posed."""
TOO_FAR = 3.0
"""From so many tolerances on an adjustment is called a contradiction."""


@dataclass(frozen=True)
class Uncertainty:
    """First-order deviations, draws and bounds of some results of one reconstruction."""

    names: tuple[str, ...]
    deviations: dict[str, float]
    correlations: NDArray[np.float64]
    responses: NDArray[np.float64]
    draws: Draws | None
    ranges: dict[str, Range]


@within_doubles
def uncertainty(
    solution: Reconstruction,
    samples: int,
    seed: int = 0,
    wanted: Sequence[str] | None = None,
    progress: Callable[[int], object] = lambda draws: None,
) -> Uncertainty:
    """How uncertain a reconstruction's results are: ``wanted``, or those that were not known.

    Draws and bounds only for ``samples`` above 0 and tolerances that were given.
    """
    known = solution.system.known
    results = wanted or [
        n for n in _RESULTS if n not in known or (n in _ANSWERS and known[n].varies)
    ]
    names = [name for name in results if name in solution.values]
    if not wanted:
        names = [name for name in names if not _along_an_axis(solution, name)]
    deviations = solution.deviations(names)
    # what the exact values alone determine is not uncertain
    names = [n for n in names if deviations[n] > 1e-9 * solution.system.scale(n)]
    drawn, bounds = None, {}
    if samples and names and not solution.assumed:
        drawn = draws(solution, names, samples, seed, progress)
        bounds = ranges(solution, names, seed=seed, drawn=drawn, progress=progress)
    return Uncertainty(
        names=tuple(names),
        deviations=deviations,
        correlations=solution.correlations(names),
        responses=solution.responses(names),
        draws=drawn,
        ranges=bounds,
    )


def _along_an_axis(solution: Reconstruction, name: str) -> bool:
    """Whether a course says no more than the velocity's components do."""
    components = SPEEDS[COURSES[name]] if name in COURSES else ()
    known = solution.system.known
    return any(n in known and known[n].nominal == 0 and not known[n].varies for n in components)


@within_doubles
def completed_values(solution: Reconstruction, contact_time: float | None) -> dict[str, float]:
    """Everything that follows from a reconstruction, by name, in the tables' order."""
    values = dict(solution.values)
    if "MUP" in values and "UX" in values:
        values["MU"] = typed_friction(solution.system.state(solution.x), values["MUP"])
    return completed(values, contact_time)


@within_doubles
def warnings(
    solution: Reconstruction,
    values: Mapping[str, float],
    spread: Uncertainty,
    units: System = RULES,
) -> list[str]:
    """What a reader must know, in sentences."""
    lines = []
    if solution.undetermined:
        lines.append(f"not determined by what is known: {' '.join(solution.undetermined)}")
    for name in solution.backwards:
        what = "is pushed away from" if name in FORCES else "drives backwards along"
        lines.append(
            f"{name[-1]} {what} its known {'PDOF' if name in FORCES else 'course'}: {name} = "
            f"{number(solution.system.nominal[name], 4)} was given, the only impact found has "
            f"{number(solution.values[name], 4)}"
        )
    if solution.against_sign:
        lines.append(
            "neither sign of MU is the one that line 400 gives it: no friction that opposes the "
            "sliding before the impact joins what is known"
        )
    if solution.assumed:
        lines.append(
            "the known values contradict one another and none has a tolerance: all known "
            "velocities were given the same one (spins that divided by the radius of gyration, "
            f"{number(units.shown('length', solution.system.gyration), 4)}"
            f"{' ' + units.label('length') if units is not RULES else ''}); "
            "deviations are those of the misfit"
        )
    else:
        far = [a for a in solution.adjusted if abs(a.moved) > TOO_FAR]
        if far:
            moved = ", ".join(f"{a.name} by {number(a.moved, 2)}" for a in far)
            lines.append(f"the measured values contradict one another: moved, tolerances: {moved}")
    lines += _ill_posed(solution, spread, units)
    missing = [name for name, bound in spread.ranges.items() if math.isnan(bound.lower)]
    if missing:
        lines.append(
            "no impact was found that lies within the limits of all known values at once: the "
            "draws are those of normal values with the same standard deviations"
        )
    unsearched = [name for name, bound in spread.ranges.items() if not bound.searched]
    if unsearched:
        lines.append(
            "the search for bounds ended before its time; not searched to the end, and perhaps "
            f"wider: {' '.join(unsearched)}"
        )
    if spread.draws and spread.draws.failed:
        lines.append(f"{100 * spread.draws.failed:.3g} % of the draws have no solution")
    return lines + sentences(int(values.get("STATUS", 0)), values)


def _ill_posed(solution: Reconstruction, spread: Uncertainty, units: System) -> list[str]:
    """Velocities that the known values hardly determine, with the number and what drives it."""
    system = solution.system
    lines = []
    for row, name in enumerate(spread.names):
        if name not in VELOCITIES and name not in FINAL_STATE:
            continue
        share = spread.deviations[name] / system.scale(name)
        if share > ILL_POSED:
            driver, part = _drivers(solution, spread, row)[0]
            deviation = number(spread.deviations[name] * units.factor(name), 3)
            deviation += f" {units.unit(name)}".rstrip()
            lines.append(
                f"ill-posed: {name} has a standard deviation of {deviation}, {100 * share:.0f} % "
                f"of the largest speed; {100 * part:.0f} % of its variance comes from {driver}"
            )
    e = solution.values.get("E")
    if lines and e and "E" in system.known and abs(e) < ILL_POSED:
        lines.append(f"E = {number(e, 3)} divides: errors after the impact grow 1/E = {1 / e:.3g}")
    return lines


def _drivers(solution: Reconstruction, spread: Uncertainty, row: int) -> list[tuple[str, float]]:
    """The known values that make a result uncertain, with their shares of its variance."""
    squares = spread.responses[row] ** 2
    total = squares.sum() or 1.0
    ranked = np.argsort(-squares, kind="stable")
    return [(solution.system.observations[i], float(squares[i] / total)) for i in ranked]


@within_doubles
def as_text(
    solution: Reconstruction,
    values: Mapping[str, float],
    spread: Uncertainty,
    units: System = RULES,
) -> str:
    """The reconstruction as tables."""
    known = solution.system.nominal
    remarks = warnings(solution, values, spread, units)
    blocks = [
        answer(
            values,
            {name: _answered(solution, spread, name) for name in _ANSWERS if name in spread.names},
            Open(solution.undetermined, solution.helpful),
            len(remarks) - bool(solution.undetermined),
            units,
        ),
        velocities_table(known, values, units),
        named_table(("E", "MUP", "EM", "RR0"), known, values, units),
        named_table(("PN", "PT", "PM", "P", "PDOFA", "PDOFB"), known, values, units),
        named_table(("TF", "FA", "FM2", "FM3"), known, values, units),
        named_table((*CHANGES, "VC", "VS"), known, values, units),
        named_table(("KI", "KF", "EL", "LOSS"), known, values, units),
        _adjustments(solution, units),
        _spreads(spread, units),
        _correlations(spread),
        _driving(solution, spread),
    ]
    lines = [line for block in blocks if block for line in (*block, "")]
    for warning in remarks:
        lines += paragraph(f"! {warning}")
    return "\n".join(lines).rstrip("\n")


def _answered(solution: Reconstruction, spread: Uncertainty, name: str) -> Spread:
    bound = spread.ranges.get(name)
    lower, upper = (bound.lower, bound.upper) if bound else (math.nan, math.nan)
    drivers = _drivers(solution, spread, spread.names.index(name))[:DRIVERS]
    return Spread(spread.deviations[name], lower, upper, drivers)


def in_turn(texts: Sequence[str]) -> str:
    """The solutions one below the other, numbered where there are several."""
    if len(texts) == 1:
        return texts[0]
    total = len(texts)
    return "\n\n".join(f"SOLUTION {i} OF {total}\n\n{text}" for i, text in enumerate(texts, 1))


class Reconstructions(list[Reconstruction]):
    """The impacts that agree with what is known."""

    def _repr_html_(self) -> str:
        """What `impact88 reconstruct --samples 0` prints, as a notebook shows it."""
        each = ((one, completed_values(one, None), uncertainty(one, 0)) for one in self)
        return notebook.preformatted(in_turn([as_text(*one) for one in each]))


def reconstruct(known: Mapping[str, Uncertain | float | str]) -> Reconstructions:
    """`reconstruction.adjustment.reconstruct`, whose result a notebook can show.

    >>> known = {name: text for name, text in impact88.sample(1).items() if name != "MU"}
    >>> best, *others = impact88.reconstruct({**known, "VAX": "-13.3 +- 0.5"})
    >>> round(best.values["VAX"], 1)
    -13.3
    """
    return Reconstructions(adjustment.reconstruct(known))


def _adjustments(solution: Reconstruction, units: System) -> list[str]:
    if not solution.redundancy:
        return []
    rows = []
    for a in solution.adjusted:
        unit = quantity(a.name).unit
        item = solution.system.known[a.name]
        half = math.nan if item.kind == "normal" else a.tolerance
        sizes = [units.shown(unit, x) for x in (half, standard_deviation(item))]
        measured, adjusted = (number(units.shown(unit, x)) for x in (a.measured, a.adjusted))
        cells = [a.name, measured, *(number(size, 3) for size in sizes), adjusted]
        rows.append([*cells, f"{a.moved + 0.0:.2f}", units.label(unit)])
    heading = ["known", "measured", "half-width", "sd", "adjusted", "moved, tolerances", "unit"]
    lines = table(rows, heading, left=(0, 6))
    lines += ["A tolerance is the half-width of limits, or the sd of a normal value."]
    count = solution.redundancy
    lines += paragraph(
        "Adjusted by least squares so that Equations 13 to 18 hold exactly (adjustment of "
        f"observations with conditions): {count} value{'s' if count > 1 else ''} more than needed, "
        f"sum of squared adjustments {number(solution.squares, 3)} (in standard deviations; about "
        f"{count} where the tolerances are right)"
    )
    return lines


def _spreads(spread: Uncertainty, units: System) -> list[str]:
    if not spread.names:
        return []
    heading = ["result", "first order sd"]
    if spread.draws:
        heading += ["draws sd", *(f"{100 * share:g} %" for share in QUANTILES)]
        heading += ["lower bound", "upper bound"]
    rows = []
    for name in spread.names:
        unit = quantity(name).unit
        factor = units.shown(unit, 1.0)
        cells = [name, number(factor * spread.deviations[name], 3)]
        if spread.draws:
            drawn = spread.draws.values[name]
            drawn = drawn[np.isfinite(drawn)]
            quantiles = np.quantile(drawn, QUANTILES) if len(drawn) else [math.nan] * 3
            cells.append(number(factor * drawn.std() if len(drawn) else math.nan, 3))
            bound = spread.ranges[name]
            limits = (*quantiles, bound.lower, bound.upper)
            cells += [number(factor * value, 5) for value in limits]
        rows.append([*cells, units.label(unit)])
    return table(rows, [*heading, "unit"], left=(0, len(heading)))


def _correlations(spread: Uncertainty) -> list[str]:
    # the unknowns themselves first, courses and speeds are made of them
    first = [n for n in spread.names if n not in SPEEDS and n not in COURSES]
    names = [n for n in spread.names if n in first[:MOST_CORRELATED]]
    places = [spread.names.index(name) for name in names]
    if len(names) < 2:
        return []
    rows = [
        [name, *(f"{spread.correlations[places[i], k]:.2f}" for k in places[: i + 1])]
        for i, name in enumerate(names)
    ]
    return table(rows, ["correlation", *names])


def _driving(solution: Reconstruction, spread: Uncertainty) -> list[str]:
    rows = []
    for row, name in enumerate(spread.names):
        shares = [(n, s) for n, s in _drivers(solution, spread, row)[:DRIVERS] if s >= 0.005]
        rows.append([name, *(f"{source} {100 * share:.0f} %" for source, share in shares)])
    return table(rows, ["uncertain through", *[""] * DRIVERS], left=(0, 1, 2, 3)) if rows else []


@within_doubles
def as_json(
    solution: Reconstruction,
    values: Mapping[str, float],
    spread: Uncertainty,
    units: System = RULES,
) -> dict[str, Any]:
    """The reconstruction for a program, in ``units``; numbers that do not exist are null."""
    drawn = spread.draws
    whole: dict[str, Any] = plain(
        {
            "known": list(solution.system.known),
            "values": {n: v for n, v in written(values, units).items() if n != "STATUS"},
            "units": {n: units.label(quantity(n).unit) for n in values if n != "STATUS"},
            "undetermined": list(solution.undetermined),
            "adjusted": [
                {
                    "name": a.name,
                    "measured": a.measured * units.factor(a.name),
                    "tolerance": a.tolerance * units.factor(a.name),
                    "adjusted": a.adjusted * units.factor(a.name),
                    "moved": a.moved,
                }
                for a in solution.adjusted
            ],
            "redundancy": solution.redundancy,
            "sum_of_squares": solution.squares,
            "equal_tolerances_assumed": solution.assumed,
            "uncertainty": {
                name: {
                    "first_order": spread.deviations[name] * units.factor(name),
                    "drivers": dict(_drivers(solution, spread, row)),
                    **(
                        _drawn(drawn.values[name], spread.ranges[name], units, name)
                        if drawn
                        else {}
                    ),
                }
                for row, name in enumerate(spread.names)
            },
            "correlations": {"names": list(spread.names), "matrix": spread.correlations},
            "draws_without_solution": drawn.failed if drawn else None,
            "status": int(values.get("STATUS", 0)),
            "warnings": warnings(solution, values, spread, units),
        }
    )
    return whole


def _drawn(values: NDArray[np.float64], bound: Range, units: System, name: str) -> dict[str, Any]:
    factor = units.factor(name)
    finite = values[np.isfinite(values)] * factor
    none = not len(finite)
    return {
        "mean": math.nan if none else float(finite.mean()),
        "deviation": math.nan if none else float(finite.std()),
        "quantiles": {
            f"{q:g}": math.nan if none else float(np.quantile(finite, q)) for q in QUANTILES
        },
        "lower": bound.lower * factor,
        "upper": bound.upper * factor,
        "unbounded": unbounded(bound),
        "at_lower": written(bound.at_lower, units),
        "at_upper": written(bound.at_upper, units),
    }
