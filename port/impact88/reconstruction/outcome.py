"""What a solved impact means: contact point, direction of force, ΔV, energy, critical friction.

For any solution, whatever its unknowns were: it is computed from the velocities before and after
and from the impulse, as far as they are known.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..closedform.solve import quantities, solve
from ..closedform.statusbits import bits, findings
from ..names import FINAL_STATE, PIVOT, SCENE, VELOCITIES
from .geometry import with_point_masses
from .state import CHANGES, CONTACT, COURSES, FORCES, SPEEDS, State

Array = NDArray[Any]

_FORWARD = ("MUC", "COND")
"""What only the forward solution can tell: it needs all initial velocities and coefficients."""
_TOLD = (*CONTACT, *CHANGES, "KI", "KF", "LOSS", *SPEEDS, *COURSES)


@np.errstate(all="ignore")
def outcome(values: Mapping[str, Any]) -> dict[str, Array]:
    """The consequences of ``values`` (geometry, velocities, coefficients, PN and PT, by name), as
    far as what they need is known: contact point, STATUS, direction of force, contact velocities,
    energies, velocity changes, speeds and courses, and MUC."""
    whole = with_point_masses(values)
    given = {name: np.asarray(value, np.float64) for name, value in whole.items()}
    if (given.get("M", np.array(6.0)) == 4).all():
        given = {"WA": np.zeros(()), "WB": np.zeros(()), "EM": np.zeros(()), **given}
        given = {"WAF": given["WA"], "WBF": given["WB"], **given}
    state = State.of_known(given)
    facing = {"TA", "TB"} & {*given}
    result = state.here.contact_point()
    told = {name: state[name] for name in _TOLD if facing or name not in CHANGES}
    told |= state.contact_velocities()
    result |= {name: value for name, value in told.items() if not np.isnan(value).all()}
    if "PN" in given and "PT" in given:
        result |= {name: state[name] for name in FORCES if facing}
        result["P"] = np.hypot(given["PN"], given["PT"])
    condition: Any = 1.0
    if all(name in given for name in SCENE if name != "M"):
        scene = {name: given[name] for name in SCENE if name in given}
        result["MUC"], condition = solve(scene, _FORWARD).values()
    result["STATUS"] = status(state, given, condition)
    shape = np.broadcast_shapes(*(np.shape(value) for value in given.values()))
    return {name: np.broadcast_to(value, shape) for name, value in result.items()}


def moment_ratio(em: Any) -> Any:
    """R/R0: the relative spin after the impact over that before, as far as the moment impulse alone
    makes it (Equation 18 as printed with P = 0): -em/(1 - 2 em). 1 at em = +1, no moment; 0 at 0,
    where the spins become equal; 1/3 at -1. Infinite at em = 1/2."""
    em = np.asarray(em, np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        return -em / (1 - 2 * em)


def _pivot_impulse(given: Mapping[str, Array]) -> tuple[Array, Array]:
    """PN and PT of the same impact if the sliding ended at separation."""
    scene = {name: given[name] for name in SCENE if name in given} | {"MU": np.array(PIVOT)}
    if not all(name in scene for name in SCENE if name != "M"):
        return np.array(np.nan), np.array(np.nan)
    solved = quantities(scene, ("PN", "PT"))
    return solved["PN"], solved["PT"]


def status(state: State, given: Mapping[str, Array], condition: Any = 1.0) -> Array:
    """STATUS of an impact; what cannot be decided for lack of a value is not remarked.

    ``given``: what is known of the velocities before and after, and of the scene; ``condition``:
    COND, where the forward equations are at hand.
    """
    here, value = state.here, state.values
    e, em, mu = (value.get(name, np.array(np.nan)) for name in ("E", "EM", "MUP"))
    known = [given[name] for name in (*VELOCITIES, *FINAL_STATE) if name in given]
    with np.errstate(all="ignore"):
        lost, initial = 2 * state.energy_lost, state.initial_energy
        operands = (
            state.relative_before[0],
            value["PN"],
            here.at,
            here.bt,
            np.where(here.point, 0.0, value["DA"]),
            np.where(here.point, 0.0, value["DB"]),
            # energies that are not known are not numbers that are not finite
            np.where(np.isnan(lost), 0.0, lost),
            np.where(np.isnan(initial), 1.0, initial),
            e,
            np.where(here.point, 0.0, em),
            np.where(mu == PIVOT, 0.0, mu),
            *_pivot_impulse(given),
            np.asarray(condition),
            sum(known, np.zeros(())),
        )
        return np.asarray(bits(findings(*operands)), np.uint16)
