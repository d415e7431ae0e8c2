"""One scene, for root finders and notebooks: a few microseconds a call.

The compiled kernels compute all results of one scene in less time than the call takes. Without
them a Python function of the scene's values is compiled for each set of results and kind of scene
(`written`). Unusual scenes (values that are not plain numbers or not usable, infinite bodies, a
division by zero, a result that is not finite) are left to the general path of `solve`.
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
from .written import compile_function

_M = NAMES.index("M")
_MU = NAMES.index("MU")
_in_order = itemgetter(*NAMES)


def in_order(columns: Mapping[str, object]) -> tuple[Any, ...]:
    """Return the scene's values in the table's order; () where names are missing or unknown."""
    if "M" not in columns:
        columns = {**columns, "M": 6.0}
    try:
        return _in_order(columns) if len(columns) == len(NAMES) else ()
    except KeyError:
        return ()


def solve_one(values: tuple[Any, ...], wanted: tuple[str, ...]) -> dict[str, Any] | None:
    """Return the results ``wanted`` of one scene (values as from `in_order`) as numpy's float64,
    STATUS as uint16; None for a scene that is left to the general path."""
    if not PLAIN.issuperset(map(type, values)):
        return None
    try:
        M, MU = values[_M], values[_MU]
        if M != 6 and M != 4:
            return None
        if kernelcalls.usable():
            return _solve_compiled(values, wanted)
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
    """Reusable call of the compiled kernels for all results of one scene."""

    def __init__(self) -> None:
        self.values, self.status = np.zeros(len(NAMES)), np.zeros(1, np.uint16)
        self.results = np.zeros(len(ALL))
        self.into = self.results.ctypes.data + 8 * np.arange(len(ALL))
        self.into[ALL.index("STATUS")] = self.status.ctypes.data
        self.call = Call(ALL)
        self.call.columns[:] = self.values.ctypes.data + 8 * np.arange(len(NAMES))


_scenes: list[_Scene] = []
"""The calls that no thread is using."""


@lru_cache(maxsize=256)
def _places(wanted: tuple[str, ...]) -> tuple[tuple[str, ...], NDArray[np.int64]]:
    """Return the results wanted except STATUS, and their places among all results."""
    names = tuple(name for name in wanted if name != "STATUS")
    return names, np.array([ALL.index(name) for name in names], np.int64)


def _solve_compiled(values: tuple[Any, ...], wanted: tuple[str, ...]) -> dict[str, Any] | None:
    """Do `solve_one` by the compiled kernels."""
    scene = _scenes.pop() if _scenes else _Scene()
    scene.values[:] = values
    scene.call.run(scene.into, 1)
    names, places = _places(wanted)
    results, status = scene.results[places], scene.status[0]
    _scenes.append(scene)
    if not math.isfinite(sum(results.tolist())):
        return None
    by_name: dict[str, Any] = dict(zip(names, results, strict=True))
    if len(names) == len(wanted):
        return by_name
    return {name: status if name == "STATUS" else by_name[name] for name in wanted}


@lru_cache(maxsize=256)
def _function(
    wanted: tuple[str, ...], point: bool, pivot: bool
) -> Callable[..., tuple[float, ...]]:
    """Return a function of the scene's values, in the table's order, that returns the results."""
    names = [name for name in NAMES if not (point and name in UNUSED_BY_POINTS)]
    unusable = [f"not {name} > 0.0" for name in INERTIAS if name in names]
    unusable.append(f"not isfinite({' + '.join(names)})")
    return compile_function(
        program_for(varying("pivot" if pivot else "array", point), wanted), " or ".join(unusable)
    )
