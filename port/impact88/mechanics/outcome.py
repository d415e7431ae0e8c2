"""Consequences of a solved impact, and initial velocities from final ones in closed form.

The consequences (contact point, ΔV, energy, critical friction, STATUS) are computed from the
velocities before and after and from the impulse, as far as these are known.

The inverse of Equations 13-18 (chapter, Section IV-C: "if the final velocities are known, these
equations are linear and can be solved for the initial velocities, as done in an accident
reconstruction"): with the relative contact velocities after impact Gn and the relative spin GW

    M  = (1 - e_m)/e_m · GW / (1/I_a + 1/I_b)                             Equation 18
    Pn = [(1 + 1/e) Gn - (a_n/I_a - b_n/I_b) M] / (R + S_nn + μ S_nt)      Equations 15 and 16
    Pt = μ Pn                                                              Equation 16
    v  = V - impulse / mass                                                Equations 13, 14 and 17

with S_nn = a_n²/I_a + b_n²/I_b and S_nt = a_n a_t/I_a + b_n b_t/I_b. There is no such solution at
e = 0, at e_m = 0 (which the chapter omits) and for the pivot, which has only five equations for
the six; errors of the final velocities grow as 1/e. `unknowns` solves any other set of
unknowns, more slowly, and says why a set cannot be solved.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..collision.geometry import Geometry
from ..errors import UserError
from ..names import FINAL_STATE, PIVOT, SCENE, VELOCITIES
from ..status import IMPOSSIBLE, Status
from .closedform.columns import UNUSED_BY_POINTS
from .closedform.general import quantities
from .closedform.solve import solve
from .closedform.statusbits import RANGES, UNKNOWN, Evidence, bits, findings, forward_friction
from .state import CHANGES, CONTACT, COURSES, FORCES, SPEEDS, State
from .uses import inputs_of

Array = NDArray[Any]

COEFFICIENT_TOLERANCE = 1e-9
"""E and EM this far outside their range are at its end: a coefficient that follows from velocities
has their rounding."""

Divided = tuple[dict[str, Array], list[Array]]
"""Results by name, and their divisors: where a divisor is zero, some results are infinite."""


@np.errstate(all="ignore")
def outcome(values: Mapping[str, Any]) -> dict[str, Array]:
    """Return the consequences of ``values`` (geometry, velocities, coefficients, PN and PT, by
    name): contact point, STATUS, direction of force, contact velocities, energies, velocity
    changes, speeds and courses, and MUC, each where the values it needs are known."""
    numbers = {name: np.asarray(value, np.float64) for name, value in values.items()}
    if (numbers.get("M", np.array(6.0)) == 4).all():
        numbers = {"WA": np.zeros(()), "WB": np.zeros(()), "EM": np.zeros(()), **numbers}
        numbers = {"WAF": numbers["WA"], "WBF": numbers["WB"], **numbers}
    state = State.of_known(numbers)
    here = state.here
    result = {"CAX": -here.d4, "CAY": -here.d3, "CBX": here.d2, "CBY": here.d1}
    names = (*CONTACT, *CHANGES, "KI", "KF", "LOSS", *SPEEDS, *COURSES, *FORCES)
    following = {name: state[name] for name in names} | state.contact_velocities()
    following["P"] = np.hypot(*state.impulse_on_a)
    result |= {name: value for name, value in following.items() if not np.isnan(value).all()}
    point = bool((numbers.get("M", np.array(6.0)) == 4).all())
    result = {n: x for n, x in result.items() if here.absent.isdisjoint(inputs_of(n, point))}
    condition: Any = 1.0
    if _is_complete(numbers):
        scene = {name: numbers[name] for name in SCENE if name in numbers}
        result["MUC"], condition = solve(scene, ("MUC", "COND")).values()
    result["STATUS"] = status(state, numbers, condition)
    shape = np.broadcast_shapes(*(np.shape(value) for value in numbers.values()))
    return {name: np.broadcast_to(value, shape) for name, value in result.items()}


def moment_ratio(em: Any) -> Any:
    """Return R/R0, the ratio of the relative spins after and before, by the moment impulse alone.

    Equation 18 as printed with P = 0: -em/(1 - 2 em). 1 at em = +1, no moment; 0 at 0, where the
    spins become equal; 1/3 at -1; infinite at em = 1/2."""
    em = np.asarray(em, np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        return -em / (1 - 2 * em)


@np.errstate(all="ignore")
def broken_laws(state: State) -> Array:
    """Return the laws that impacts break, as bits of STATUS (`impact88.status.IMPOSSIBLE`).

    An impact is impossible where its contact points do not approach, the normal impulse pulls,
    kinetic energy is gained, or E or EM is out of range. What cannot be decided for lack of a value
    is not broken.

    Parameters
    ----------
    state : State
        Impacts, numbers or arrays that broadcast. E and EM are those among its values, or else
        those that its velocities and impulses give.

    Returns
    -------
    ndarray of uint16
        The bits, 0 for a possible impact.

    Examples
    --------
    >>> scene = impact88.sample(1).numbers()
    >>> values = {**scene, **impact88.solve(scene), "E": [0.1, -0.1]}
    >>> broken_laws(State.of_known(values)).tolist()
    [0, 16]
    """
    e, em = (state.values[name] if name in state.values else state[name] for name in ("E", "EM"))
    normal_slip, pn = state.relative_before[0], state.values["PN"]
    forbidden: Any = 0
    if "GA" in state.here.absent:
        normal_slip = pn = e = np.array(np.nan)
        forbidden = _forbidden_for_every_normal(state)
    laws: dict[str, Any] = {
        "gn": np.real(normal_slip),
        "pn": np.real(pn),
        "twice_lost": np.real(2 * state.energy_lost),
        "initial": np.real(state.initial_energy),
        "e": _within_range("E", e),
        "em": np.where(state.here.point, 0.0, _within_range("EM", em)),
    }
    conditions = findings(Evidence(**laws))
    broken = bits({bit: conditions[bit] for bit in IMPOSSIBLE})
    return np.asarray(broken | forbidden, np.uint16)


def _forbidden_for_every_normal(state: State) -> Array:
    """Return the bits that an impact sets whatever its contact plane: PULLING where the impulse
    cannot push along any normal along which the vehicles approach, E_OUT_OF_RANGE where it can,
    and the restitution is outside 0 ... 1 along all of those.

    Each condition says that a vector has a component along the normal: the impulse, the approach,
    the separation, and what of the approach the separation leaves. They change where a normal is
    perpendicular to one of these, and are tested between all such normals."""
    contact = {name: np.real(value) for name, value in state.contact_velocities().items()}
    before = contact["XA"] - contact["XB"], contact["YA"] - contact["YB"]
    after = contact["XAF"] - contact["XBF"], contact["YAF"] - contact["YBF"]
    x, y = (np.real(part) for part in state.impulse_on_a)
    remainder = -before[0] - after[0], -before[1] - after[1]
    vectors = [(x, y), (-before[0], -before[1]), after, remainder]
    across = [np.arctan2(b, a) + side for a, b in vectors for side in (-np.pi / 2, np.pi / 2)]
    edges = np.sort(np.stack(np.broadcast_arrays(*across)) % (2 * np.pi), axis=0)
    normals = (edges + np.concatenate([edges[1:], edges[:1] + 2 * np.pi])) / 2
    speed = COEFFICIENT_TOLERANCE * np.hypot(*before)
    pushes, approaches, separates, loses = (
        a * np.cos(normals) + b * np.sin(normals) for a, b in vectors
    )
    possible = (pushes > 0) & (approaches > speed)
    restituting = possible & (separates >= -speed) & (loses >= -speed)
    pulls = ~possible.any(axis=0)
    is_known = np.isfinite(x + y + before[0] + before[1])
    result = np.where(is_known & pulls, int(Status.PULLING), 0)
    out_of_range = ~pulls & ~restituting.any(axis=0) & np.isfinite(after[0] + after[1])
    return result | np.where(is_known & out_of_range, int(Status.E_OUT_OF_RANGE), 0)


def _within_range(name: str, coefficient: Any) -> Array:
    """Return a coefficient without the rounding by which it lies outside its range."""
    value = np.real(np.asarray(coefficient))
    nearest = np.clip(value, *RANGES[name])
    return np.where(abs(value - nearest) <= COEFFICIENT_TOLERANCE, nearest, value)


def status(state: State, given: Mapping[str, Array], condition: Any = 1.0) -> Array:
    """Return STATUS of an impact; a bit that cannot be decided for lack of a value is clear.

    ``given``: the known velocities before and after and numbers of the scene; ``condition``: COND,
    where the forward equations can be set up.
    """
    here, value = state.here, state.values
    mu = value.get("MUP", np.array(np.nan))
    velocities = [given[name] for name in (*VELOCITIES, *FINAL_STATE) if name in given]
    # the same impact if the sliding ended at separation
    pivot = {name: given[name] for name in SCENE if name in given} | {"MU": np.array(PIVOT)}
    complete = _is_complete(pivot)
    names = ("PN", "PT")
    pivot_impulse = quantities(pivot, names) if complete else dict.fromkeys(names, np.nan)
    pivot_pt = np.asarray(pivot_impulse["PT"])
    friction_mu = np.where(mu == PIVOT, 0.0, mu)
    with np.errstate(all="ignore"):
        lost, initial = 2 * state.energy_lost, state.initial_energy
        normal_slip, slip, _ = state.relative_before
        turning, yielding = state.slip_changes
        conditions = findings(
            Evidence(
                gn=normal_slip,
                pn=value["PN"],
                arm_a=here.at if "GA" in given else np.array(np.nan),
                arm_b=here.bt if "GA" in given else np.array(np.nan),
                da=np.where(here.point, 0.0, value.get("DA", 0.0)),
                db=np.where(here.point, 0.0, value.get("DB", 0.0)),
                # an energy that is not known must not set NOT_FINITE
                twice_lost=np.where(np.isnan(lost), 0.0, lost),
                initial=np.where(np.isnan(initial), 1.0, initial),
                e=UNKNOWN,  # `broken_laws` judges the coefficients
                em=UNKNOWN,
                mu=friction_mu,
                forward=forward_friction(friction_mu, pivot_pt),
                pivot_pn=pivot_impulse["PN"],
                limit=abs(pivot_pt),
                gt=slip,
                turning=turning,
                yielding=yielding,
                condition=np.asarray(condition),
                sum_of_velocities=sum(velocities, np.zeros(())),
            )
        )
        remarks = {bit: x for bit, x in conditions.items() if not bit & IMPOSSIBLE}
        return np.asarray(bits(remarks), np.uint16) | broken_laws(state)


def _is_complete(values: Mapping[str, Any]) -> bool:
    """Return True if the forward equations can be set up."""
    point = bool((np.asarray(values.get("M", 6.0)) == 4).all())
    names_unused = ("M", *(UNUSED_BY_POINTS if point else ()))
    return all(name in values for name in SCENE if name not in names_unused)


def forces(impulse: Any, contact_time: Any) -> dict[str, Array]:
    """Return the average force FA = P/t_f of an impulse over a contact time, and FM2 and FM3, the
    range of the peak force: "typically two to three times the average" (chapter, Section III).
    Raises UserError unless every contact time is positive."""
    time = np.asarray(contact_time, np.float64)
    if not (time > 0).all() or not np.isfinite(time).all():
        raise UserError(f"contact time {contact_time} is not positive; expected a duration")
    average = np.abs(np.asarray(impulse, np.float64)) / time
    return {"FA": average, "FM2": 2.0 * average, "FM3": 3.0 * average}


def initial_impact(columns: Mapping[str, Any]) -> State:
    """Return the impact that has six final velocities: the velocities before, and PN PT PM.

    ``columns``: numbers or arrays that broadcast: the geometry, the coefficients E, EM and MUP (the
    *signed* P_t/P_n) and VAX VAY VBX VBY WAF WBF. Where there is no solution (e = 0, e_m = 0, the
    pivot's -10, singular friction) the values are NaN or infinite. Point masses keep their spins.
    """
    values = {name: np.asarray(value, np.float64) for name, value in columns.items()}
    geometry = Geometry(columns)
    e, em, mu = (values[name] for name in ("E", "EM", "MUP"))
    with np.errstate(all="ignore"):
        mu = np.where(mu == PIVOT, np.nan, mu)
        normal, _, spin = geometry.relative([values[name] for name in FINAL_STATE])
        a, b = geometry.inverse_ia, geometry.inverse_ib
        moment = np.where(geometry.point, 0.0, (1 - em) / em * spin / geometry.inverse_spin_inertia)
        from_moment = (geometry.an * a - geometry.bn * b) * moment
        pn = ((1 + 1 / e) * normal - from_moment) / _along_impulse(geometry, mu)
        impulse = {"PN": pn, "PT": mu * pn, "PM": moment}
        return State({**values, **impulse}, geometry, from_after=VELOCITIES)


def _along_impulse(geometry: Geometry, mu: Array) -> Array:
    """Return R + S_nn + μ S_nt: the change of Gn by a unit of Pn and the friction it causes."""
    a, b = geometry.inverse_ia, geometry.inverse_ib
    snn = geometry.an * geometry.an * a + geometry.bn * geometry.bn * b
    snt = geometry.an * geometry.at * a + geometry.bn * geometry.bt * b
    return np.asarray(geometry.inverse_mass + snn + mu * snt)


def forward_model(
    columns: Mapping[str, Any], outputs: Sequence[str], sign: float | None = None
) -> Divided:
    """Solve Equations 13-18 for the final velocities; ``sign``: see `quantities`."""
    names = ["determinant", "critical_denominator"] if "MUC" in outputs else ["determinant"]
    values = quantities(columns, (*outputs, *names), sign)
    return {name: values[name] for name in outputs}, [values[name] for name in names]


def reconstruction_model(
    columns: Mapping[str, Any], outputs: Sequence[str], sign: float | None = None
) -> Divided:
    """Solve Equations 13-18 for the initial velocities, and compute ``outputs`` and STATUS of that
    impact. ``sign`` is ignored: `forward_model` has the same parameters."""
    state = initial_impact(columns)
    before = dict(zip(VELOCITIES, state.before, strict=True))
    denominators = [state.values["E"], state.values["EM"]]
    denominators.append(_along_impulse(state.here, state.values["MUP"]))
    result = {n: state[n] for n in outputs if n not in ("MUC", "STATUS")}
    if "MUC" in outputs:
        # the critical friction depends on MU's sign as little as on MU
        values = {**state.values, **before, "MU": 0.0}
        scene = {name: values[name] for name in SCENE if name in values}
        result["MUC"], zero = quantities(scene, ("MUC", "critical_denominator")).values()
        denominators.append(zero)
    if "STATUS" in outputs:
        result["STATUS"] = status(state, {**state.values, **before})
    return result, denominators
