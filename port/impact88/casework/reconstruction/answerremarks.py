"""Remarks on an answer, a sentence each, the weightiest first: what is wrong with the impact, how
far its numbers can be trusted, what was made of the problem, what was left out."""

from collections.abc import Iterator

import numpy as np

from ...collision.geometry import within_doubles
from ...collision.needs import needs_in_words
from ...collision.units import RULES, System
from ...mechanics.friction import status_sentences
from ...mechanics.outcome import broken_laws
from ...mechanics.state import FORCES, SPEEDS
from ...messages.plaintable import number
from ...names import FINAL_STATE, VELOCITIES
from ...status import IMPOSSIBLE
from .admissible import ENDS
from .answer import Answer
from .derived import from_the_axis
from .posterior import MAX_VELOCITY, MIN_SIZE
from .unknowns import BADLY_CONDITIONED

MAX_ENDS_NAMED = 4  # results whose interval ends at a condition
MAX_FOLDED_NAMED = 6  # results named where branches meet
MIN_SAID = 0.005  # fraction of draws above which a remark is made
ILL_POSED = 0.25  # standard deviation of a velocity, relative to the largest speed


@within_doubles
def remarks_on(answer: Answer, units: System = RULES) -> list[str]:
    """Return the remarks on an answer. What its first line says is not said twice."""
    status = int(answer.values.get("STATUS", 0))
    return [
        *_directions(answer),
        *status_sentences(status & ~IMPOSSIBLE, answer.values),
        *_limits(answer),
        *_misfit(answer, units),
        *_folds(answer, units),
        *_ill_posed(answer, units),
        *_draws(answer),
        *answer.remarks,
        *(sentence for _, sentence in needs_in_words(answer.absent)),
    ]


def _directions(answer: Answer) -> Iterator[str]:
    """Yield remarks on vehicles that drive backwards, and on a sign of MU that does not fit."""
    solution = answer.solution
    for name in solution.backwards:
        what = "is pushed away from" if name in FORCES else "drives backwards along"
        yield (
            f"{name[-1]} {what} its known {'PDOF' if name in FORCES else 'course'}: {name} = "
            f"{number(solution.system.nominal[name], 4)} was given, this impact has "
            f"{number(solution.values[name], 4)}; none was found that does not "
            f"({solution.search.text()})"
        )
    if solution.against_sign:
        yield (
            "neither sign of MU is the one that line 400 gives it: no friction that opposes the "
            "sliding before the impact is consistent with the known values"
        )


def _limits(answer: Answer) -> Iterator[str]:
    """Yield remarks on a fit at a border of what physics allows, and on what is left open."""
    if answer.solution.limited:
        ends = " and ".join(ENDS[name] for name in answer.solution.limited)
        yield f"the values fit best where {ends}: beyond, an impossible impact fits better"
    if answer.solution.explanation:
        yield answer.solution.explanation


def _misfit(answer: Answer, units: System) -> Iterator[str]:
    """Yield remarks on values that contradict one another."""
    solution = answer.solution
    if solution.assumed and answer.evidence.contradictory:
        unit = f" {units.label('length')}" if not units.is_bare else ""
        yield (
            "the known values contradict one another and none has a tolerance: all known "
            "velocities were given the same one (spins that divided by the radius of gyration, "
            f"{number(units.display_value('length', solution.system.gyration), 4)}{unit}); "
            "deviations are those of the misfit, and the numbers are a compromise that settles "
            "nothing until the contradiction is resolved"
        )
    elif answer.evidence.contradictory:
        yield (
            f"standard deviations are widened {number(answer.evidence.widening, 3)} times, by as "
            "much as the values contradict one another"
        )


def _folds(answer: Answer, units: System) -> Iterator[str]:
    """Yield a remark where two branches of impacts meet."""
    solution = answer.solution
    folded_names = [name for name in answer.names if name in solution.folded]
    texts = []
    for name in folded_names[:MAX_FOLDED_NAMED]:
        value, scale = solution.values[name], solution.system.scale(name)
        value = 0.0 if abs(value) < 1e-6 * scale else value
        value = from_the_axis(name, value)
        texts.append(f"{name} about {number(units.display_unwrapped(name, value), 4)}")
    if texts:
        both = ", and draws and bounds have both" if answer.draws else ""
        yield (
            f"two branches of impacts meet here ({', '.join(texts)}): to first order nothing "
            f"limits these, so no first-order deviation is given{both}"
        )


def _ill_posed(answer: Answer, units: System) -> Iterator[str]:
    """Yield a remark for each velocity that the known values hardly determine, with its deviation
    and the value that causes it, and for exact values whose errors are amplified."""
    system, is_poor = answer.solution.system, False
    speeds = (answer.values.get(name, 0.0) for name in SPEEDS)
    relative_speed = max(1.0, *(speed / system.speed for speed in speeds))
    for name in answer.names:
        deviation = answer.deviations[name]
        fraction = deviation / (relative_speed * system.scale(name))
        if name not in (*VELOCITIES, *FINAL_STATE) or not fraction > ILL_POSED:
            continue
        if alternatives := _separate_values(answer, name, deviation):
            amounts = [number(units.display_unwrapped(name, value), 3) for value in alternatives]
            alternatives_text = " or ".join(dict.fromkeys(amounts))
            yield (
                f"{name} is about {alternatives_text} {units.unit(name)}".rstrip()
                + ", in another impact each; draws and bounds have all of them"
            )
            continue
        is_poor = True
        driver, part = answer.drivers[name][0]
        size = f"{number(deviation * units.factor(name), 3)} {units.unit(name)}".rstrip()
        yield (
            f"poorly determined: {name} has a standard deviation of {size}, "
            f"{100 * fraction:.0f} % of the largest speed; {100 * part:.0f} % of its variance "
            f"comes from {driver}"
        )
    e = answer.values.get("E")
    if is_poor and e and "E" in system.known and abs(e) < ILL_POSED:
        yield f"E = {number(e, 3)} divides: errors after the impact grow 1/E = {1 / e:.3g} times"
    amplified = [
        f"{name} {number(x, 3)} times"
        for name, x in answer.solution.amplification.items()
        if not x < BADLY_CONDITIONED
    ]
    if amplified:
        yield (
            "badly conditioned: errors of the known velocities are amplified "
            f"({', '.join(amplified)})"
        )


def _separate_values(answer: Answer, name: str, deviation: float) -> list[float]:
    """Return the values of a result in all possible impacts found, sorted, if draws cover several
    of them and these are farther apart than the standard deviation; else none."""
    if not answer.draws:
        return []
    values = sorted(
        float(np.ravel(state[name])[0])
        for state in (system.state(x) for system, x in answer.solution.beside)
        if not broken_laws(state).any()
    )
    gaps = np.diff(values)
    return values if len(gaps) and gaps.max() > deviation else []


def _draws(answer: Answer) -> Iterator[str]:
    """Yield remarks on draws and bounds: none, too few, cut off, or not searched to the end."""
    if answer.not_drawn and not answer.solution.impossible:
        yield (
            "this impact lies within the limits of all known values, but the search for draws and "
            "bounds found none there: there are neither"
        )
    if answer.evidence.inside is False:
        yield (
            "no impact was found that lies within the limits of all known values at once: there "
            "are neither draws nor bounds"
        )
    if answer.refused is not None:
        yield (
            f"the draws tell no more than {answer.refused.effective:.0f} independent ones would "
            f"(expected {MIN_SIZE}): there are neither draws nor bounds; narrower limits help"
        )
    if answer.draws is None or answer.refused is not None:
        return
    by_condition: dict[str, list[str]] = {}
    for name in answer.names:
        for side, condition in zip(("below", "above"), answer.draws.cut_by[name], strict=True):
            if condition:
                by_condition.setdefault(condition, []).append(f"{name} {side}")
    for condition, ends in by_condition.items():
        more = f" and {len(ends) - MAX_ENDS_NAMED} more" if len(ends) > MAX_ENDS_NAMED else ""
        named = ", ".join(ends[:MAX_ENDS_NAMED]) + more
        yield f"the interval ends where {ENDS[condition]}: {named}"
    if answer.draws.beyond_friction > MIN_SAID:
        yield (
            f"{100 * answer.draws.beyond_friction:.2g} % of the draws need more friction than what "
            "only ends the sliding, as some staged collisions do"
        )
    if answer.draws.unlimited > MIN_SAID:
        yield (
            f"{100 * answer.draws.unlimited:.2g} % of the draws are limited only by a largest "
            f"velocity of {MAX_VELOCITY:g} times the largest known speed: the known values leave "
            "velocities open"
        )
    if answer.not_searched:
        yield (
            "the search for bounds ended before its time; not searched to the end, and perhaps "
            f"wider: {' '.join(answer.not_searched)}"
        )
