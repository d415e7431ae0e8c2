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

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..closedform.solve import solve
from ..names import FINAL_STATE, SCENE, VELOCITIES
from ..status import Status
from .geometry import Geometry

Array = NDArray[np.float64]
Model = Callable[[Mapping[str, Any], Sequence[str]], dict[str, Array]]
"""Columns (arrays or numbers by name) and the outputs wanted -> arrays by name."""

FRICTION_DRIVES = 128
"""Beside STATUS's bits, for reconstructions alone: the signed MUP given pushes the sliding on
instead of opposing it. The forward problem's sign rule (line 400) does not let that happen."""


def initial_velocities(columns: Mapping[str, Any]) -> dict[str, Array]:
    """UX UY WA VX VY WB, and the impulses PN PT PM, from the six final velocities.

    ``columns``: numbers or arrays that broadcast: DA DB GA PA PB TA TB MA MB IA IB, M (6 where left
    out), the coefficients E, EM and MUP (the *signed* P_t/P_n, as printed; line 400's rule needs
    initial velocities) and VAX VAY VBX VBY WAF WBF. Units are the scene's, angles in degrees.
    Where there is no solution (e = 0, e_m = 0, the pivot's -10, singular friction) the values are
    NaN or infinite. Point masses (M = 4) keep their spins and need no e_m.
    """
    here = Geometry.of(columns)
    e, em, mu = (np.asarray(columns[name], np.float64) for name in ("E", "EM", "MUP"))
    final = [np.asarray(columns[name], np.float64) for name in FINAL_STATE]
    with np.errstate(all="ignore"):
        mu = np.where(mu == -10, np.nan, mu)
        normal, _, spin = here.relative(final)
        a, b = here.inverse_ia, here.inverse_ib
        snn = here.an * here.an * a + here.bn * here.bn * b
        snt = here.an * here.at * a + here.bn * here.bt * b
        moment = np.where(here.point, 0.0, (1 - em) / em * spin / here.inverse_spin_inertia)
        turned = (here.an * a - here.bn * b) * moment
        pn = ((1 + 1 / e) * normal - turned) / (here.inverse_mass + snn + mu * snt)
        pt = mu * pn
        changes = here.changes(pn, pt, moment)
        initial = [after - change for after, change in zip(final, changes, strict=True)]
    names = (*VELOCITIES, "PN", "PT", "PM")
    return dict(zip(names, (*initial, pn, pt, moment), strict=True))


def forward_model(columns: Mapping[str, Any], outputs: Sequence[str]) -> dict[str, Array]:
    """Equations 13-18 solved for the final velocities, by `impact88.solve`."""
    return dict(solve(columns, outputs))


def reconstruction_model(columns: Mapping[str, Any], outputs: Sequence[str]) -> dict[str, Array]:
    """Equations 13-18 solved for the initial velocities, by `initial_velocities`; STATUS is
    that of the impact found, with `FRICTION_DRIVES` for one whose friction pushes the sliding on.
    """
    found = {
        **{name: np.asarray(value, np.float64) for name, value in columns.items()},
        **initial_velocities(columns),
    }
    before = [found[name] for name in VELOCITIES]
    after = [found[name] for name in FINAL_STATE]
    found["SA"], found["SB"] = np.hypot(*before[:2]), np.hypot(*before[3:5])
    change = [late - early for late, early in zip(after, before, strict=True)]
    found["DVA"], found["DVB"] = np.hypot(*change[:2]), np.hypot(*change[3:5])
    if {"KI", "KF", "LOSS", "STATUS"}.intersection(outputs):
        found["KI"], found["KF"] = _energy(found, before), _energy(found, after)
        found["LOSS"] = 100 * (found["KI"] - found["KF"]) / found["KI"]
    if {"MUC", "STATUS"}.intersection(outputs):
        # the critical friction depends on MU's sign as little as on MU
        names = (*(name for name in SCENE if name in found), *VELOCITIES)
        scene = {name: found[name] for name in names} | {"MU": 0.0}
        found["MUC"] = forward_model(scene, ["MUC"])["MUC"]
    if "STATUS" in outputs:
        found["STATUS"] = _reconstruction_status(found, before)
    return {name: found[name] for name in outputs}


def _energy(found: Mapping[str, Array], velocities: Sequence[Array]) -> Array:
    """Kinetic energy; a point mass has none from its spin."""
    turning = np.where(found["M"] == 4, 0.0, 1.0)
    vax, vay, wa, vbx, vby, wb = velocities
    return (
        found["MA"] * (vax**2 + vay**2)
        + found["MB"] * (vbx**2 + vby**2)
        + turning * (found["IA"] * wa**2 + found["IB"] * wb**2)
    ) / 2


def _reconstruction_status(found: Mapping[str, Array], before: Sequence[Array]) -> Array:
    """STATUS as `impact88.status` defines it, of an impact known from both sides."""
    normal, tangential, _ = Geometry.of(found).relative(before)
    e, em, mu, pn = (found[name] for name in ("E", "EM", "MUP", "PN"))
    six = found["M"] != 4
    bits = {
        Status.SEPARATING: normal >= 0,
        Status.PULLING: pn < 0,
        Status.SLIDING_REVERSED: np.abs(mu) > np.abs(found["MUC"]),
        Status.ENERGY_GAINED: found["KF"] - found["KI"] > 1e-12 * found["KI"],
        Status.COEFFICIENT_OUT_OF_RANGE: (e < 0) | (e > 1) | six & ((em < -1) | (em > 0)),
        Status.NOT_FINITE: ~np.isfinite(found["KI"]),
        FRICTION_DRIVES: mu * tangential * np.sign(pn) > 0,
    }
    # the parts broadcast: what does not vary is a lone number
    flags: Any = np.int64(0)
    for bit, holds in bits.items():
        flags = flags + np.int64(bit) * holds
    return np.asarray(flags)
