"""Reconstruction: every impact that agrees with what is known, the likeliest first.

What is known of an impact is adjusted so that the laws and the exact values hold (`system.System`:
the conditions) and the sum of squared adjustments, each in units of its standard deviation, is
least. Here the problem is posed, each reading of it searched (`impactsearch`), and what was found
put in the order of physics."""

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import within_doubles
from ...collision.mappings import within_limits
from ...collision.uncertain import Uncertain, fixed_value
from ...errors import UserError
from ...mechanics.closedform.general import opposing, share_typed
from ...mechanics.closedform.solve import solve
from ...mechanics.friction import FAULTS
from ...mechanics.outcome import outcome
from ...mechanics.posed import is_meant_turned, is_wrong_way, pose, turned, turned_sentence
from ...mechanics.state import COURSE_OF, CRUSH, KNOWABLE, SPEEDS
from ...names import PIVOT, SCENE, SPINS, VELOCITIES, check_names
from ...status import Status
from .impactsearch import MAX_SQUARES_RATIO, Search
from .nearest import counts
from .solution import Reconstruction, Searched, invariants
from .unknowns import UnsolvableError, check_physical

Floats = NDArray[np.float64]
Progress = Callable[[int], object]

# Secant steps for friction given as a fraction of the critical one; six to ten are needed. Half or
# twice as many find the same in 60 problems.
MAX_SECANT_STEPS = 40
FRICTION_TOL = 1e-12  # change of P_t/P_n at convergence


@within_doubles
def reconstruct(
    known: Mapping[str, Uncertain | float | str], progress: Progress = lambda impacts: None
) -> list[Reconstruction]:
    """Return every impact found that agrees with what is ``known`` (`KNOWABLE` names; M is 6 by
    default).

    A number is exact, an `Uncertain` is known within its tolerance. MU is known in size only: each
    solution that agrees with the sign line 400 gives it is returned; MUP is signed. Where exact
    values contradict one another and none has a tolerance, all known velocities are given the same
    one (spins divided by the radius of gyration). ``progress`` is called with the number of impacts
    evaluated.

    Raise UserError for names and numbers that cannot be used and for exact values that
    contradict one another beside others with a tolerance, UnsolvableError where nothing unknown
    is determined."""
    values, friction = resolve_friction(_check_known(known))
    values, remarks = pose(values, fixed_value)
    remarks = [friction, *remarks] if friction else remarks
    point = values["M"].nominal == 4
    failure: UserError | None = None
    try:
        solutions = _impacts(values, progress)
    except UserError as error:
        solutions, failure = [], error
    status = int(outcome(solutions[0].values)["STATUS"]) if solutions else Status.SEPARATING
    if "GA" in values and is_wrong_way(status, point):
        plane = values["GA"]
        shift = turned(plane.nominal) - plane.nominal
        ends = {end: getattr(plane, end) + shift for end in ("nominal", "low", "high")}
        with suppress(UserError):
            others = _impacts({**values, "GA": replace(plane, **ends)}, progress)
            turned_status = int(outcome(others[0].values)["STATUS"])
            if is_meant_turned(status, turned_status, point):
                solutions = others
                if "GA" in known:
                    remarks.append(turned_sentence(plane.nominal))
    if not solutions:
        assert failure is not None
        raise failure
    return [replace(solution, remarks=tuple(remarks)) for solution in solutions]


def _impacts(values: dict[str, Uncertain], progress: Progress) -> list[Reconstruction]:
    """Return every impact found that agrees with the values as they are posed, best first."""
    values = dict(values)
    mu = values.pop("MU", None)
    readings = [values]
    if mu is not None:
        readings = [{**values, "MUP": mu}]
        if mu.varies or mu.nominal not in (0, PIVOT):
            opposite = replace(mu, nominal=-mu.nominal, low=-mu.high, high=-mu.low)
            readings.append({**values, "MUP": opposite})
    solutions: list[Reconstruction] = []
    failure: UserError | None = None
    searches: list[Search] = []
    for reading in readings:
        try:
            searches.append(Search(reading, progress))
        except UserError as error:
            failure = error
    # values that are contradictory for one sign of MU may agree for the other: fits are sought last
    for is_fit in (False, True):
        for search in [item for item in searches if item.assumed == is_fit]:
            try:
                solutions += search.run()
            except UserError as error:
                failure = error
                searches.remove(search)
        agreeing = [s for s in solutions if mu is None or _agrees(s, mu.nominal)]
        if agreeing:
            return _sort_solutions(agreeing, searches, mu)
    fits = [replace(s, against_sign=True) for s in solutions if s.redundancy]
    if fits:
        return _sort_solutions(fits, searches, None)
    raise failure or UnsolvableError(
        "neither sign of MU agrees with the sliding it leads to (line 400): no friction that "
        "opposes the sliding is consistent with the known values"
    )


def _sort_solutions(
    solutions: list[Reconstruction], searches: "Sequence[Search]", mu: Uncertain | None
) -> list[Reconstruction]:
    """Return the likely solutions, sorted by physics.

    First impacts that count (`nearest.counts`), then possible ones, then those that break physics
    or drive backwards along a known course, then those that separate or pull; among these by the
    sum of squared adjustments, ties by `invariants`, the smaller first. Solutions that contradict
    the measurements are kept only where all do, those that drive backwards only where no others
    exist."""
    forward_solutions = [s for s in solutions if not s.backwards] or solutions
    # a solution that contradicts the measurements, such as standstill, is dropped if others agree
    agreeing = [s for s in forward_solutions if not s.evidence.contradictory]
    if not agreeing or any(solution.limited for solution in forward_solutions):
        agreeing = forward_solutions
    is_counted = {id(s): counts(s) for s in agreeing}
    # One that counts is compared with these only: another that fits better must not displace it.
    # Others have to compete with all.
    least_counted = min((s.squares for s in agreeing if is_counted[id(s)]), default=0.0)
    least_of_all = min((s.squares for s in agreeing), default=0.0)
    likely = []
    for solution in agreeing:
        least = least_counted if is_counted[id(solution)] else least_of_all
        if solution.squares <= max(MAX_SQUARES_RATIO * least, 1e-9):
            likely.append(solution)

    def order(solution: Reconstruction) -> tuple[float, ...]:
        squares = float(f"{max(solution.squares, 1e-9):.6e}")
        broken = solution.impossible
        no_impact = bool(broken & (Status.SEPARATING | Status.PULLING))
        friction = int(outcome(solution.values)["STATUS"]) & FAULTS
        ranks = invariants(solution.values)
        return (
            not is_counted[id(solution)],
            bool(broken),
            no_impact,
            squares,
            broken.bit_count(),
            bool(friction),
            *ranks,
        )

    search = Searched(
        sum(item.starts for item in searches),
        min((solution.reached for solution in likely if not solution.limited), default=0),
        all(item.single for item in searches),
        len(likely),
        sum(not solution.impossible for solution in likely),
    )
    paths = [item.paths for item in searches if item.paths]
    if len(paths) == len(searches):
        path_count = sum(item.total for item in paths)
        nonreal = sum(item.complex_ends + item.infinite_ends for item in paths)
        search = search._replace(solutions=path_count, nonreal=nonreal)
    alternatives = tuple((s.system, s.x) for s in forward_solutions)
    common: dict[str, Any] = {"search": search, "beside": alternatives}
    if mu is not None and (mu.varies or mu.nominal not in (0, PIVOT)):
        common["typed_mu"] = mu.nominal
    return [replace(s, **common) for s in sorted(likely, key=order)]


def _check_known(known: Mapping[str, Uncertain | float | str]) -> dict[str, Uncertain]:
    """Return what is ``known`` as uncertain values, those of point masses filled in. Raise
    UserError for values that cannot be used."""
    values = within_limits(known)
    check_names(values, KNOWABLE, "value of an impact")
    if values.setdefault("M", fixed_value(6.0)).nominal == 4:
        without_effect = (*SPINS, "EM", "DA", "DB", "PA", "PB", "IA", "IB")
        values = {name: item for name, item in values.items() if name not in without_effect}
    check_physical(
        {n: np.array([x.nominal if x.kind == "normal" else x.low]) for n, x in values.items()}
    )
    if values["M"].varies:
        raise UserError("M must be 6, or 4 for point masses")
    _check_crush(values)
    for name, item in values.items():
        if name in SPEEDS and item.nominal < 0:
            raise UserError(f"{name} is negative; expected a speed, its course beside it")
    return _with_standing_vehicles(values)


def _with_standing_vehicles(values: dict[str, Uncertain]) -> dict[str, Uncertain]:
    """Return the values with both components of an exact speed of 0 in its place: as a condition it
    has no slope there."""
    for speed, components in SPEEDS.items():
        item = values.get(speed)
        if item is not None and not item.varies and item.nominal == 0:
            values = {n: x for n, x in values.items() if n not in (speed, COURSE_OF[speed])}
            values = {n: fixed_value(0.0) for n in components} | values
    return values


def _check_crush(values: dict[str, Uncertain]) -> None:
    """Raise UserError unless the crush of both vehicles is known, or of none. Fill in a rigid
    barrier's: it absorbs no energy."""
    for vehicle in "AB":
        names = [n for n in CRUSH if n in values and n.endswith(vehicle)]
        if len(names) == 2:
            raise UserError(f"{' and '.join(names)} are both given; expected one of them")
        other_vehicle = "AB".replace(vehicle, "")
        if any(n in values for n in CRUSH if n.endswith(other_vehicle)) and not names:
            if not math.isinf(values["M" + vehicle].nominal):
                raise UserError("ELA and ELB (or EBSA and EBSB) sum to EL; expected both, or EL")
            values["EL" + vehicle] = fixed_value(0.0)
        for name in names:
            if values[name].nominal < 0:
                raise UserError(f"{name} is negative; expected what was lost in {vehicle}")


def _agrees(solution: Reconstruction, mu: float) -> bool:
    """Return True if line 400 gives ``mu`` the sign this solution has, as far as velocities are
    determined."""
    signed = solution.system.nominal["MUP"]
    is_determined = not set(VELOCITIES) & set(solution.undetermined)
    return not is_determined or opposing(signed, solution.system.state(solution.x).sliding) == mu


# -- friction given as a fraction of the critical one


def resolve_friction(known: Mapping[str, Uncertain]) -> tuple[dict[str, Uncertain], str | None]:
    """Return ``known`` with MU, given as a fraction of the critical friction, replaced by a number
    or limits, and a sentence that says so; ``known`` and None where MU is no fraction.

    The critical friction MUC follows from the whole scene. Where that is known, so is MU; where
    part of it is solved for, MUP = fraction · MUC is one more equation, solved by the secant
    method. Raise UserError where no friction satisfies it."""
    item = known.get("MU")
    if item is None or not item.share:
        return dict(known), None
    other_values = {name: value for name, value in known.items() if name != "MU"}
    scene = {"M": 6.0} | {n: x.nominal for n, x in other_values.items() if n in SCENE}
    if len(scene) == len(SCENE) - 1:
        name, value = "MU", float(share_typed(scene, item.nominal))
    else:
        name, value = "MUP", _solve_friction(other_values, item.nominal)
    if value != value:
        raise UserError("no friction ends the sliding here; expected a number", "MU")
    text = f"MU is {100 * item.nominal:g} % of the critical friction: {name} = {value:.9g}"
    varies = item.varies or any(x.varies for x in other_values.values())
    if name == "MU" and varies:
        signed = item.nominal * float(solve({**scene, "MU": 0.0}, ("MUC",))["MUC"])
        name, value = "MUP", signed
    scale = value / item.nominal if item.nominal else 0.0
    low, high = sorted((item.low * scale, item.high * scale))
    friction = fixed_value(value)
    if item.varies:
        spread = abs(item.deviation * scale)
        friction = replace(item, nominal=value, low=low, high=high, deviation=spread, share=False)
    # Where anything varies, so does MUC: each impact then has the condition P_t = fraction MUC P_n,
    # with its own MUC. ``critical`` is the nominal one, to turn ``friction`` into the fraction.
    if varies and scale:
        friction = replace(friction, critical=scale)
    return {**other_values, name: friction}, text


def _solve_friction(other_values: Mapping[str, Uncertain], fraction: float) -> float:
    """Return the P_t/P_n that is the given fraction of MUC in the impact that follows from it and
    the other values, by the secant method."""

    def excess(mu: float) -> float:
        scene = reconstruct({**other_values, "MUP": fixed_value(mu)})[0].scene()
        scene = {name: value for name, value in scene.items() if name in SCENE}
        return mu - fraction * float(solve({**scene, "MU": 0.0}, ("MUC",))["MUC"])

    failure = UserError("no friction is found that is this share of the critical friction", "MU")
    for start in (0.3, -0.3):
        try:
            previous, current = 0.0, start
            previous_excess, excess_now = excess(previous), excess(current)
            for _ in range(MAX_SECANT_STEPS):
                if abs(excess_now) <= FRICTION_TOL or previous_excess == excess_now:
                    break
                previous, previous_excess, current = (
                    current,
                    excess_now,
                    current - excess_now * (current - previous) / (excess_now - previous_excess),
                )
                excess_now = excess(current)
            if abs(excess_now) <= 1e3 * FRICTION_TOL:
                return current
        except UserError as error:
            failure = error
    raise failure
