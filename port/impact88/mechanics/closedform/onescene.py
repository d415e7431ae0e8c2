"""One scene, for root finders and notebooks: a few microseconds a call.

The compiled machine computes all results of one scene sooner than Python asks for them; without it
a Python function of the scene's values does (`written`), one for each selection of results and kind
of scene. Whatever is out of the ordinary (values that are no plain numbers or cannot be used,
infinite bodies, a division by zero, a result that is not finite) is left to the arrays.
"""

import math
from collections.abc import Callable, Mapping
from functools import lru_cache
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...names import PIVOT
from . import kernelcalls
from .columns import INERTIAS, UNUSED_BY_POINTS
from .impactprograms import ALL, program_for, varying
from .kernelcalls import Call
from .plain import NAMES, PLAIN
from .written import written

_M, _MU = NAMES.index("M"), NAMES.index("MU")
_in_order = itemgetter(*NAMES)


def in_order(columns: Mapping[str, object]) -> tuple[Any, ...]:
    """The scene's values in the table's order; none where names are missing or unknown."""
    if "M" not in columns:
        columns = {**columns, "M": 6.0}
    try:
        return _in_order(columns) if len(columns) == len(NAMES) else ()
    except KeyError:
        return ()


def solve_one(values: tuple[Any, ...], wanted: tuple[str, ...]) -> dict[str, Any] | None:
    """The results ``wanted`` of one scene (`in_order`), numpy's float64 (STATUS: uint16), which are
    floats; None where the arrays have to look at it."""
    if not PLAIN.issuperset(map(type, values)):
        return None
    try:
        M, MU = values[_M], values[_MU]
        if M != 6 and M != 4:
            return None
        if kernelcalls.usable():
            return by_machine(values, wanted)
        results = _function(wanted, M == 4, MU == PIVOT)(*map(float, values))
    except ArithmeticError:
        return None
    if not math.isfinite(sum(results)):
        return None
    by_name: dict[str, Any] = dict(zip(wanted, map(np.float64, results), strict=True))
    if "STATUS" in by_name:
        by_name["STATUS"] = np.uint16(by_name["STATUS"])
    return by_name


class _Scene:
    """A call of the machine for one scene, prepared once: all results."""

    def __init__(self) -> None:
        self.values, self.status = np.zeros(len(NAMES)), np.zeros(1, np.uint16)
        self.results = np.zeros(len(ALL))
        self.into = self.results.ctypes.data + 8 * np.arange(len(ALL))
        self.into[ALL.index("STATUS")] = self.status.ctypes.data
        self.call = Call(ALL)
        self.call.columns[:] = self.values.ctypes.data + 8 * np.arange(len(NAMES))


_scenes: list[_Scene] = []
"""Those that no thread uses."""


@lru_cache(maxsize=256)
def _places(wanted: tuple[str, ...]) -> tuple[tuple[str, ...], NDArray[np.int64]]:
    """The results wanted but STATUS, and where they are among all."""
    names = tuple(name for name in wanted if name != "STATUS")
    return names, np.array([ALL.index(name) for name in names], np.int64)


def by_machine(values: tuple[Any, ...], wanted: tuple[str, ...]) -> dict[str, Any] | None:
    """`solve_one`, by the compiled machine."""
    scene = _scenes.pop() if _scenes else _Scene()
    scene.values[:] = values
    scene.call.run(scene.into, 1)
    names, places = _places(wanted)
    found, status = scene.results[places], scene.status[0]
    _scenes.append(scene)
    if not math.isfinite(sum(found.tolist())):
        return None
    by_name: dict[str, Any] = dict(zip(names, found, strict=True))
    if len(names) == len(wanted):
        return by_name
    return {name: status if name == "STATUS" else by_name[name] for name in wanted}


@lru_cache(maxsize=256)
def _function(
    wanted: tuple[str, ...], point: bool, pivot: bool
) -> Callable[..., tuple[float, ...]]:
    """The function of the scene's values, in the table's order, that gives the results."""
    asked = [name for name in NAMES if not (point and name in UNUSED_BY_POINTS)]
    unusable = [f"not {name} > 0.0" for name in INERTIAS if name in asked]
    unusable.append(f"not isfinite({' + '.join(asked)})")
    return written(program_for(varying(pivot, point), wanted), " or ".join(unusable))
