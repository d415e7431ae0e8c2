"""An answer as the JSON object that `impact88 reconstruct --json` prints."""

from typing import Any

from ...collision.geometry import within_doubles
from ...collision.units import RULES, System, display_values
from ...messages.plaintable import plain
from ...names import UNKNOWNS, quantity
from ..uncertainty.boundstable import unbounded_sides
from .answer import QUANTILES, Answer, bounds_without_noise
from .answerremarks import remarks_on
from .derived import NOISE, ROUNDING, without_noise
from .unknowns import BADLY_CONDITIONED


@within_doubles
def json_of(answer: Answer, units: System = RULES) -> dict[str, Any]:
    """Return an answer as a JSON object; numbers that do not exist are null."""
    solution = answer.solution
    given = {  # given values are not rounded
        n: v
        for n, v in answer.values.items()
        if n in answer.known and not answer.known[n].varies and answer.known[n].nominal == v
    }
    clean = {**without_noise(answer.values, ROUNDING, answer.uncertainties), **given}
    values = {n: v for n, v in display_values(clean, units).items() if n != "STATUS"}
    amplification = solution.amplification
    record: dict[str, Any] = plain(
        {
            "known": [*answer.known],
            "solved_for": [n for n in UNKNOWNS if n in values and n not in answer.known],
            "values": values,
            "units": {n: units.label(quantity(n).unit) for n in values},
            "status": int(answer.values["STATUS"]) if "STATUS" in answer.values else None,
            "warnings": remarks_on(answer, units),
            "absent": {name: sorted(needs) for name, needs in answer.absent.items()},
            "undetermined": solution.undetermined,
            "helpful": solution.helpful if solution.undetermined else (),
            "adjusted": _adjusted_json(answer, units),
            "redundancy": solution.redundancy,
            "sum_of_squares": solution.squares,
            "evidence": answer.evidence.as_json(units, answer.given),
            "search": {**solution.search._asdict(), "text": solution.search.text()},
            "limited_by": list(solution.limited),
            "no_impact": answer.refusal(units),
            "equal_tolerances_assumed": solution.assumed,
            "amplification": amplification,
            "badly_conditioned": any(not x < BADLY_CONDITIONED for x in amplification.values()),
            "uncertainty": {name: _uncertainty_json(answer, name, units) for name in answer.names},
            "correlations": {"names": answer.names, "matrix": answer.signed_correlations(units)},
            "counted": answer.draws.counted if answer.draws else None,
            "effective_draws": answer.draws.effective if answer.draws else None,
            "beyond_strict_friction": answer.draws.beyond_friction if answer.draws else None,
            "not_searched": answer.not_searched,
        }
    )
    return record


def _adjusted_json(answer: Answer, units: System) -> list[dict[str, Any]]:
    """Return the measured values, as measured and as adjusted."""
    system, rows = answer.solution.system, []
    for item in answer.solution.adjusted:
        deviation = system.known[item.name].standard_deviation
        noise = max(ROUNDING * system.scale(item.name), NOISE * deviation)
        adjusted = 0.0 if abs(item.adjusted) < noise else float(item.adjusted)
        rows.append(
            {
                "name": item.name,
                "measured": units.display_unwrapped(item.name, float(item.measured)),
                "tolerance": units.factor(item.name) * item.tolerance,
                "adjusted": units.display_unwrapped(item.name, adjusted),
                "moved": item.normalized_residual,
            }
        )
    return rows


def _uncertainty_json(answer: Answer, name: str, units: System) -> dict[str, Any]:
    """Return the uncertainty of one result as JSON."""
    factor, first_order = units.factor(name), answer.first_order[name]
    record: dict[str, Any] = {
        "first_order": None if first_order is None else first_order * factor,
        "drivers": dict(answer.drivers[name]),
    }
    if answer.draws:
        spread, bound = answer.draws.spread(name, QUANTILES), answer.ranges[name]
        lower, upper = units.ends(name, *bounds_without_noise(bound))
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
