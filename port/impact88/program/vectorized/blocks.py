"""Many scenes: sorted into kinds, cut into blocks that stay in cache, and computed."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ...mechanics import native
from ...mechanics.native.processors import run_in_threads
from . import compiled, statements
from .blockerrors import NEVER, BlockErrors, Bools, Ints, stamp
from .realcolumns import Scenes
from .reals import Floats, compare, from_floats, select
from .result import OTHER_M, Replay

Computed = tuple[Mapping[str, Floats], Ints, Any]
"""Results by name, records of errors (`BlockErrors.first`), and the scenes still to be computed
(True)."""
BLOCK_SIZE = 8192
"""Scenes computed at a time, and by one thread. Smaller blocks pay more overhead for numpy's calls
and for passing the GIL between threads; larger ones fall out of the cache."""


def replay_scenes(scenes: Scenes, threads: int | None = None, block: int = BLOCK_SIZE) -> Replay:
    """Replay scenes and return their results.

    ``threads``: at most so many; None for as many as there are idle processors. ``block``: scenes
    per block, at most."""
    errors = BlockErrors(scenes.size)
    errors.first[...] = scenes.first
    M = scenes.values["M"]
    six = np.broadcast_to(M == 6, scenes.size)
    valid_m = np.broadcast_to((M == 4) | (M == 6), scenes.size)
    pivot = compare(from_floats(scenes.values["MU"], None, True), statements.MINUS_10) == 0
    pivot = np.broadcast_to(pivot, scenes.size)
    errors.at(350)
    errors.record_error(~valid_m, OTHER_M)
    values = {name: np.zeros(scenes.size) for name in statements.ASSIGNED}
    pending = np.array(valid_m)  # scenes not computed yet

    def compute(work: Callable[..., Computed]) -> None:
        """Compute the pending scenes, block by block."""

        def compute_jobs(start: int, stop: int) -> None:
            for rows, kind in jobs[start:stop]:
                columns = {name: v[rows] if v.size > 1 else v for name, v in scenes.values.items()}
                results, errors.first[rows], pending[rows] = work(columns, errors.first[rows], kind)
                for name, column in results.items():
                    values[name][rows] = column

        jobs = _blocks(pending, six, pivot, block)
        run_in_threads(compute_jobs, len(jobs), 1, threads)

    if native.library is not None:
        compute(_compute_compiled)
    compute(_compute_by_arrays)
    return Replay(scenes, six, errors, values)


def _blocks(
    pending: Bools, six: Bools, pivot: Bools, block: int
) -> list[tuple[Ints | slice, statements.Kind]]:
    """Return the pending scenes as blocks of one kind each: their rows (a slice if all scenes are
    of one kind) and the kind."""
    result: list[tuple[Ints | slice, statements.Kind]] = []
    for M in (6, 4):
        for is_pivot in (False, True):
            kind = statements.Kind(M, is_pivot)
            is_selected = pending & (six == (M == 6)) & (pivot == is_pivot)
            if is_selected.all():
                return [(slice(at, at + block), kind) for at in range(0, is_selected.size, block)]
            rows = np.flatnonzero(is_selected)
            result += [(rows[at : at + block], kind) for at in range(0, rows.size, block)]
    return result


def _compute_compiled(columns: dict[str, Floats], first: Ints, kind: statements.Kind) -> Computed:
    """Compute one block with the compiled kernel; the scenes it marks as `ODD` stay pending. What
    one value given for all scenes decides is computed once."""
    varying = frozenset(name for name in compiled.NAMES if columns[name].size > 1)
    program = compiled.program(kind, varying)
    results, odd = compiled.run_program(program, columns, first.size)
    return results, first, odd | (first != NEVER)


@np.errstate(all="ignore")
def _compute_by_arrays(columns: dict[str, Floats], first: Ints, kind: statements.Kind) -> Computed:
    """Compute one block with numpy arrays; no scene stays pending."""
    errors = BlockErrors(first.size)
    errors.first[...] = first
    scene = {name: from_floats(v, errors, True) for name, v in columns.items()}
    results = statements.run(errors, scene, kind)
    # a scene that ends before line 400 keeps the sign of MU; before line 590, KF without spins
    for name, place, before in (
        ("MUP", stamp(400), scene["MU"]),
        ("KF", stamp(590), results.pop("KF580")),
    ):
        early = ~errors.has_passed(place)
        if early.any():
            results[name] = select(early, before, results[name])
    return {name: x.v for name, x in results.items()}, errors.first, False
