"""Programs run by numpy: one operation at a time over a *tile*, a run of scenes short enough that
its working arrays stay in the processor's cache."""

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.degrees import sine_and_cosine
from ..native.schedule import Schedule

Array = NDArray[Any]

CONDITIONS = ("EQUAL", "LESS", "LESS_OR_EQUAL", "EITHER", "BOTH", "NOT")
"""Operations whose value is a condition, kept as bytes in a working array."""


def _against(value: Array, slip: Array, out: Array) -> None:
    np.copyto(out, value)
    np.negative(value, out=out, where=slip > 0)


def _choose(where: Array, a: Array, b: Array, out: Array) -> None:
    np.copyto(out, b)
    np.copyto(out, a, where=where)


def _sine_and_cosine(angle: Array, sine: Array, cosine: Array) -> None:
    sine[...], cosine[...] = sine_and_cosine(angle)


def _result(value: Array, out: Array) -> None:
    np.add(value, 0.0, out=out)  # -0.0 becomes 0.0: a zero's sign depends on the path


def _minimum(a: Array, b: Array, out: Array) -> None:
    np.minimum(a, b, out=out)


OPERATIONS: dict[str, Callable[..., object]] = {
    "ADD": np.add,
    "SUBTRACT": np.subtract,
    "MULTIPLY": np.multiply,
    "DIVIDE": np.divide,
    "NEGATIVE": np.negative,
    "SQRT": np.sqrt,
    "ABSOLUTE": np.absolute,
    "MINIMUM": _minimum,
    "EQUAL": np.equal,
    "LESS": np.less,
    "LESS_OR_EQUAL": np.less_equal,
    "BOTH": np.logical_and,
    "EITHER": np.logical_or,
    "NOT": np.logical_not,
    "AGAINST": _against,
    "CHOOSE": _choose,
    "SINE_AND_COSINE": _sine_and_cosine,
    "RESULT": _result,
    "RESULT_OR_INFINITE": _result,
    "BITS": lambda number, out: np.copyto(out, number, casting="unsafe"),
}
"""Operation -> a function of its operands and outputs."""


@lru_cache(maxsize=1024)
class Plan:
    """The steps of a program as numpy runs them, in working arrays that are made once: arrays made
    step by step take up to 2.5 times as long, where their memory is given back between calls."""

    def __init__(self, program: Schedule) -> None:
        self.program = program
        self._views: dict[tuple[int, bool, bool], int] = {}
        """(place, is a condition, has one value for all scenes) -> index of the view."""
        conditions: set[int] = set()
        single = {program.moving + number for number in range(len(program.scalars))}

        def view_index(*view: Any) -> int:
            return self._views.setdefault(view, len(self._views))

        self._steps: list[tuple[Callable[..., object], tuple[int, ...]]] = []
        for number, (name, places) in enumerate(program.steps):
            once = number < program.once
            outputs = 2 if name == "SINE_AND_COSINE" else 1
            views = [view_index(p, p in conditions, p in single) for p in places[:-outputs]]
            for place in places[-outputs:]:
                (conditions.add if name in CONDITIONS else conditions.discard)(place)
                (single.add if once else single.discard)(place)
                views.append(view_index(place, place in conditions, once))
            self._steps.append((OPERATIONS[name], tuple(views)))

    def run(
        self,
        columns: Sequence[Array],
        results: Mapping[str, Array],
        fixed: Mapping[str, float],
        tile: int,
    ) -> None:
        """Compute the ``results`` of the varying ``columns`` (float64 arrays of one length, in the
        program's order); ``fixed``: values of the columns that do not vary."""
        length = len(next(iter(results.values())))
        for low in range(0, length, tile):
            high = min(low + tile, length)
            if not low or high - low < tile:
                room = np.empty((self.program.places, high - low))
                for place, scalar in enumerate(self.program.scalars, self.program.moving):
                    room[place, 0] = fixed[scalar] if isinstance(scalar, str) else scalar
                steps = self._steps
            rows = [*(column[low:high] for column in columns)]
            rows += [result[low:high] for result in results.values()]
            rows.extend(room[len(rows) :])
            places = [_view_of(rows[place], *how) for place, *how in self._views]
            for operation, views in steps:
                operation(*[places[view] for view in views])
            steps = self._steps[self.program.once :]
        for result, ending in zip(results.values(), self.program.endings, strict=True):
            if ending != "BITS" and not np.isfinite(result.sum()):
                # one bit pattern for all NaNs
                bad = ~np.isfinite(result) if ending == "RESULT" else np.isnan(result)
                result[bad] = np.nan


def _view_of(row: Array, conditions: bool, single: bool) -> Array:
    if conditions:
        row = row.view(np.bool_)[: len(row)]
    return row[:1] if single else row
