"""Which inputs a result is made of: found from the formulas, so that no table can disagree.

An input is used if changing it changes the result. `inputs_of` asks that of the formulas for an
impact whose velocities are known, `State`, at ordinary numbers; `closedform.omitted` asks it of the
closed form, at the values that a scene has. An input that no wanted result uses need not be given;
a result whose input is not given is absent, and says which.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..collision.geometry import GEOMETRY
from ..collision.needs import ordinary
from ..names import FINAL_STATE, VELOCITIES
from .closedform.omitted import same_results
from .state import QUANTITIES, State

Floats = NDArray[np.float64]

TRIALS = 3  # ordinary impacts at which an input is changed; one could hide it by chance
_CONTACT_POINT = ("CAX", "CAY", "CBX", "CBY")


def inputs_of(result: str, point: bool) -> frozenset[str]:
    """Return the inputs that a result is computed from where velocities are known.

    Parameters
    ----------
    result : str
        Name of a quantity of an impact.
    point : bool
        True for point masses.

    Returns
    -------
    frozenset of str
        Names of the geometry and of velocities before and after; empty for a name that no formula
        of `State` has.

    Examples
    --------
    >>> sorted(inputs_of("DVAF", point=True))
    ['TA', 'UX', 'UY', 'VAX', 'VAY']
    """
    return _table(point).get(result, frozenset())


@lru_cache(maxsize=2)
def _table(point: bool) -> dict[str, frozenset[str]]:
    rng = np.random.default_rng(88)
    names = (*GEOMETRY, *VELOCITIES, *FINAL_STATE)
    base = {name: ordinary(name, rng, TRIALS) for name in names}
    base["M"] = np.full(TRIALS, 4.0 if point else 6.0)
    before = _consequences(base)
    uses: dict[str, set[str]] = {result: set() for result in before}
    for name in names:
        after = _consequences({**base, name: ordinary(name, rng, TRIALS)})
        for result, same in same_results(before, [after], [*before]).items():
            if not same.all():
                uses[result].add(name)
    if point:  # a spin passes a point mass by, and nothing turns it
        for result in ("WA", "WB", "WAF", "WBF", "PM", "EM"):
            uses[result] &= {*VELOCITIES, *FINAL_STATE}
    return {result: frozenset(inputs) for result, inputs in uses.items()}


def _consequences(values: Mapping[str, Floats]) -> dict[str, Any]:
    """Return all quantities of impacts whose velocities are known, the impulse from the change of
    momentum."""
    state = State.of_known(values)
    here, (x, y) = state.here, state.impulse_on_a
    pn, pt = x * here.cosine + y * here.sine, y * here.cosine - x * here.sine
    turned = values["IA"] * (values["WAF"] - values["WA"])
    moment = np.where(here.point, 0.0, turned - here.an * pn - here.at * pt)
    state.values = {**state.values, "PN": pn, "PT": pt, "PM": moment}
    result = {name: state[name] for name in QUANTITIES} | state.contact_velocities()
    arms = (-here.d4, -here.d3, here.d2, here.d1)
    return {**result, "P": np.hypot(x, y), **dict(zip(_CONTACT_POINT, arms, strict=True))}
