"""The six initial velocities from the six final ones, in closed form, over arrays.

The inverse of Equations 13-18 (chapter, Section IV-C: "if the final velocities are known, these
equations are linear and can be solved for the initial velocities, as done in an accident
reconstruction"). With the relative contact velocities after impact Gn and the relative spin GW:

    M  = (1 - e_m)/e_m · GW / (1/I_a + 1/I_b)                             Equation 18
    Pn = [(1 + 1/e) Gn - (a_n/I_a - b_n/I_b) M] / (R + S_nn + μ S_nt)      Equations 15 and 16
    Pt = μ Pn                                                              Equation 16
    v  = V - impulse / mass                                                Equations 13, 14 and 17

with S_nn = a_n²/I_a + b_n²/I_b and S_nt = a_n a_t/I_a + b_n b_t/I_b. There is no such solution at
e = 0, at e_m = 0 (which the chapter omits) and for the pivot, which has only five equations for
the six; errors of the final velocities grow as 1/e. `unknowns` solves any other set of
unknowns, more slowly, and says why a set cannot be solved.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..closedform.solve import quantities
from ..names import FINAL_STATE, PIVOT, SCENE, VELOCITIES
from .geometry import Geometry
from .outcome import status
from .state import State

Array = NDArray[Any]
Divided = tuple[dict[str, Array], list[Array]]
"""Arrays by name, and what divides them: where one of these is zero, some of them are infinite."""
Model = Callable[[Mapping[str, Any], Sequence[str], float | None], Divided]
"""Columns (arrays or numbers by name), the outputs wanted, and MU's sign as
`closedform.solve.quantities` has it."""


def initial_impact(columns: Mapping[str, Any]) -> State:
    """The impact of six final velocities, with the velocities before and the impulses PN PT PM.

    ``columns``: numbers or arrays that broadcast: the geometry, the coefficients E, EM and MUP (the
    *signed* P_t/P_n) and VAX VAY VBX VBY WAF WBF. Where there is no solution (e = 0, e_m = 0, the
    pivot's -10, singular friction) the values are NaN or infinite. Point masses keep their spins.
    """
    values = {name: np.asarray(value, np.float64) for name, value in columns.items()}
    geometry = Geometry.of(columns)
    e, em, mu = (values[name] for name in ("E", "EM", "MUP"))
    with np.errstate(all="ignore"):
        mu = np.where(mu == PIVOT, np.nan, mu)
        normal, _, spin = geometry.relative([values[name] for name in FINAL_STATE])
        a, b = geometry.inverse_ia, geometry.inverse_ib
        moment = np.where(geometry.point, 0.0, (1 - em) / em * spin / geometry.inverse_spin_inertia)
        turned = (geometry.an * a - geometry.bn * b) * moment
        pn = ((1 + 1 / e) * normal - turned) / _along_impulse(geometry, mu)
        impulse = {"PN": pn, "PT": mu * pn, "PM": moment}
        return State({**values, **impulse}, geometry, from_after=VELOCITIES)


def _along_impulse(geometry: Geometry, mu: Array) -> Array:
    """R + S_nn + μ S_nt: what a unit of Pn, with the friction that goes with it, changes of Gn."""
    a, b = geometry.inverse_ia, geometry.inverse_ib
    snn = geometry.an * geometry.an * a + geometry.bn * geometry.bn * b
    snt = geometry.an * geometry.at * a + geometry.bn * geometry.bt * b
    return np.asarray(geometry.inverse_mass + snn + mu * snt)


def forward_model(
    columns: Mapping[str, Any], outputs: Sequence[str], sign: float | None = None
) -> Divided:
    """Equations 13-18 solved for the final velocities."""
    names = ["determinant", "critical_denominator"] if "MUC" in outputs else ["determinant"]
    values = quantities(columns, (*outputs, *names), sign)
    return {name: values[name] for name in outputs}, [values[name] for name in names]


def reconstruction_model(
    columns: Mapping[str, Any], outputs: Sequence[str], sign: float | None = None
) -> Divided:
    """Equations 13-18 solved for the initial velocities, and what follows; STATUS is that of the
    impact found, ``sign`` counts for nothing."""
    state = initial_impact(columns)
    before = dict(zip(VELOCITIES, state.before, strict=True))
    denominators = [state.values["E"], state.values["EM"]]
    denominators.append(_along_impulse(state.here, state.values["MUP"]))
    result = {n: state[n] for n in outputs if n not in ("MUC", "STATUS")}
    if "MUC" in outputs:
        # the critical friction depends on MU's sign as little as on MU
        whole = {**state.values, **before, "MU": 0.0}
        scene = {name: whole[name] for name in SCENE if name in whole}
        result["MUC"], zero = quantities(scene, ("MUC", "critical_denominator")).values()
        denominators.append(zero)
    if "STATUS" in outputs:
        result["STATUS"] = status(state, {**state.values, **before})
    return result, denominators
