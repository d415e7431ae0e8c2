"""Which inputs a result is made of: found from the formulas, so that no table can disagree.

An input is used if changing it changes the result. `inputs_of` asks that of the formulas for an
impact whose velocities are known, `State`, at ordinary numbers; `forward_inputs` of the closed
form, at the values that a scene has. An input that no wanted result uses need not be given; a
result whose input is not given is absent, and says which.
"""

from collections.abc import Collection, Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..collision.geometry import GEOMETRY
from ..names import (
    FINAL_STATE,
    RESULTS,
    SCENE,
    VELOCITIES,
    quantity,
)
from .state import QUANTITIES, State

Floats = NDArray[np.float64]

MIN_CHANGE = 1e-9
"""Relative change of a result that is none: rounding."""
TRIALS = 3  # ordinary impacts at which an input is changed; one could hide it by chance
FORWARD_TRIALS = 8  # values of each input that is not given
_CONTACT_POINT = ("CAX", "CAY", "CBX", "CBY")
_CONTACT_VELOCITIES = ("XA", "YA", "XB", "YB", "XAF", "YAF", "XBF", "YBF")
SIZES: dict[str, tuple[float, float]] = {
    "degree": (-180.0, 180.0),
    "length": (1.0, 9.0),
    "mass": (50.0, 200.0),
    "mass·length²": (800.0, 4000.0),
    "length/time": (-60.0, 60.0),
    "rad/time": (-3.0, 3.0),
    "1": (0.1, 0.9),
}
"""Ordinary numbers, by the rule of their unit; no result depends on the unit."""


def _ordinary(name: str, rng: np.random.Generator, count: int) -> Floats:
    low, high = SIZES[quantity(name).unit]
    values = rng.uniform(low, high, count)
    return -values if name == "EM" else values


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
    base = {name: _ordinary(name, rng, TRIALS) for name in names}
    base["M"] = np.full(TRIALS, 4.0 if point else 6.0)
    before = _consequences(base)
    uses: dict[str, set[str]] = {result: set() for result in before}
    for name in names:
        after = _consequences({**base, name: _ordinary(name, rng, TRIALS)})
        for result, value in before.items():
            if _differs(value, after[result]).any():
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


def _differs(first: Any, second: Any) -> Any:
    first, second = (np.asarray(value, np.float64) for value in (first, second))
    with np.errstate(invalid="ignore"):
        apart = np.abs(first - second) > MIN_CHANGE * np.maximum(abs(first), abs(second))
    return apart | (np.isnan(first) != np.isnan(second))


def needed(needs: Mapping[str, Collection[str]]) -> list[tuple[list[str], str]]:
    """Return sentences on what results need, those with the same needs together.

    Parameters
    ----------
    needs : mapping of str to collection of str
        Results, each with the inputs it needs that are not given.

    Returns
    -------
    list of (list of str, str)
        Results and their sentence.

    Examples
    --------
    >>> for _, sentence in needed({"PDOFA": ["TA"], "E": ["GA"], "VC": ["GA"]}):
    ...     print(sentence)
    PDOFA needs TA, the way A faces; TA = "course" takes the way it travels
    E and VC need GA (angle of the impact surface from the y axis)
    """
    groups: dict[tuple[str, ...], list[str]] = {}
    for result, inputs in needs.items():
        ordered = tuple(name for name in (*SCENE, *RESULTS) if name in inputs)
        groups.setdefault(ordered, []).append(result)
    return [
        (results, f"{_listed(results)} {'needs' if len(results) == 1 else 'need'} {_meant(inputs)}")
        for inputs, results in groups.items()
    ]


def _listed(names: Sequence[str]) -> str:
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def _meant(inputs: Sequence[str]) -> str:
    if len(inputs) == 1 and inputs[0] in ("TA", "TB"):
        vehicle = inputs[0][1]
        return (
            f'{inputs[0]}, the way {vehicle} faces; {inputs[0]} = "course" takes the way it travels'
        )
    if len(inputs) == 1:
        return f"{inputs[0]} ({quantity(inputs[0]).meaning})"
    return _listed(inputs)
