"""Steps that compute expressions, in the order of the formulas, each value in a numbered place.

An expression has an ``operation``, ``operands``, and says whether it ``varies`` from scene to
scene; a column or constant has a ``value``. Each operation becomes a step, with its rounding.
numpy runs them (`closedform.plan`), and those of the replay a compiled machine.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

PROJECTIONS = ("sine", "cosine")
"""The two values of a sine_and_cosine step."""
_APART = ("against", "choose", "sine_and_cosine", "real_multiply")
"""Operations that must not write over an operand."""


def in_order(results: Sequence[Any]) -> list[Any]:
    """Return all expressions the results depend on, each after its operands."""
    order: dict[Any, None] = {}
    stack = list(reversed(results))
    while stack:
        e = stack[-1]
        waiting = () if e in order else [x for x in reversed(e.operands) if x not in order]
        if waiting:
            stack += waiting
        else:
            order[stack.pop()] = None
    return list(order)


class Schedule:
    """The steps that compute ``results`` (name -> expression), each finished by an operation in
    ``endings``, such as RESULT; BITS makes whole numbers of 16 bits.

    Places: first the varying ``columns``, then the results (up to ``moving``), ``scalars``
    (constants, and the names of columns that do not vary), then values in between. ``steps``: the
    operation, and the places of its operands and of its value; the first ``once`` compute values
    that do not vary.
    """

    def __init__(self, results: Mapping[str, Any], endings: Sequence[str]) -> None:
        order = in_order(list(results.values()))
        self.results, self.endings = list(results), list(endings)
        columns = [e for e in order if e.operation == "column" and e.varies]
        leaves = [e for e in order if e.operation in ("column", "constant") and not e.varies]
        self.columns = [str(e.value) for e in columns]
        self.scalars: list[float | str] = [e.value for e in leaves]
        self.moving = len(columns) + len(results)
        self._place = {e: number for number, e in enumerate(columns)}
        self._place |= {e: number for number, e in enumerate(leaves, self.moving)}
        self.places = self.moving + len(leaves)
        self._free: list[int] = []
        self.steps: list[tuple[str, tuple[int, ...]]] = []
        work = [e for e in order if e.operation not in ("column", "constant")]
        often = [e for e in work if e.varies]
        self._write(
            [e for e in work if not e.varies],
            [*results.values(), *(x for e in often for x in e.operands)],
        )
        self.once = len(self.steps)
        self._write(often, list(results.values()))
        for to, (e, ending) in enumerate(zip(results.values(), endings, strict=True), len(columns)):
            self.steps.append((ending, (self._place[e], to)))

    def _write(self, work: Sequence[Any], kept: Sequence[Any]) -> None:
        """Append the steps for the expressions ``work``. The place of a value is used again after
        its last use, except for the expressions ``kept``."""
        steps = [e for e in work if e.operation not in PROJECTIONS]
        last = {operand: e for e in steps for operand in e.operands}
        permanent = set(kept)
        reusable: dict[Any, int] = {}

        def release(values: Iterable[Any], after: Any) -> None:
            for value in dict.fromkeys(values):
                mine = last.get(value, after) is after and value in reusable
                if mine and value not in permanent:
                    self._free.append(reusable.pop(value))

        for e in steps:
            places = [self._place[operand] for operand in e.operands]
            values = [e]
            if e.operation == "sine_and_cosine":
                values = [e.table.combine(half, e) for half in PROJECTIONS]
            elif e.operation not in _APART:
                release(e.operands, e)
            for value in values:
                place = self._free.pop() if self._free else self.places
                self.places = max(self.places, place + 1)
                self._place[value] = reusable[value] = place
                places.append(place)
            self.steps.append((e.operation.upper(), tuple(places)))
            if e.operation in _APART:
                release([*e.operands, *(v for v in values if v not in last)], e)
