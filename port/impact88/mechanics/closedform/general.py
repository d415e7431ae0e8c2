"""Columns of any types and shapes that broadcast, solved block by block.

A block is computed by the compiled library where that is usable, else by numpy.

MU may be a share of the critical friction ("85 %"), of the one that just ends the sliding at
separation, MUC: it is solved for first.
"""

import math
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.doubles import double
from ...errors import UserError
from ...names import DEFAULT_M, PIVOT, SCENE
from ...status import Status
from .. import native
from ..native.processors import run_in_threads, workers
from . import compiledcalls
from .columns import Source, examine, part, sources
from .impactprograms import program_for
from .plan import Plan
from .results import address, allocate_results, results_into

Array = NDArray[Any]

TILE = 16384
"""Scenes per pass of numpy. Two arrays fit the second-level cache and all of them the third, and
numpy's cost of starting an operation (half a microsecond) is spread over enough scenes.
Measured: 4096 takes a fifth longer, 8192 and 32768 a few percent."""
SHARED_TILE = 4 * TILE
"""Scenes per pass with several threads. Each operation releases and re-acquires the GIL; when
operations are short the other thread has not woken up by then, and the threads take turns. Measured
on two cores: 1.6 times as fast as one thread with tiles this long, 1.1 times with `TILE`."""


def solve_arrays(
    columns: Mapping[str, object],
    wanted: tuple[str, ...],
    threads: int | None,
    sign: float | None = None,
    out: Mapping[str, Array] | None = None,
    shares: Array | None = None,
) -> dict[str, Array]:
    """Solve columns of any types and shapes. ``out``, ``threads``: as in `solve`; ``sign``: see
    `quantities`; ``shares``: of the critical friction, in place of MU where they are not NaN."""
    if shares is not None:
        numbers: Any = columns["MU"]
        mu = np.where(np.isnan(shares), numbers, share_typed(columns, shares))
        columns = {**columns, "MU": mu}
    inputs, shape = sources(columns)
    count = math.prod(shape)
    if out is None:
        arrays, _ = allocate_results(wanted, shape)
    else:
        input_arrays = [x.base if isinstance(x, np.flatiter) else x for x in inputs.values()]
        arrays, _ = results_into(out, wanted, shape, input_arrays)
    results: dict[str, Array] = {name: arrays[name].reshape(count) for name in wanted}
    if not wanted:
        return {}
    number = workers(count, threads, SHARED_TILE)
    tile = TILE if number == 1 else SHARED_TILE
    run_in_threads(partial(_solve_part, inputs, results, tile, sign), count, number)
    return {name: arrays[name] for name in wanted}


def quantities(
    columns: Mapping[str, object], names: Sequence[str], sign: float | None = None
) -> dict[str, Array]:
    """Return results and other quantities of `closedform.impact`, such as ``gt`` and
    ``determinant``, by their names there; otherwise as `solve`, on one thread.

    ``sign``: +1 keeps MU's sign in all scenes, -1 changes it; None applies line 400's rule.
    """
    return solve_arrays(columns, tuple(names), 1, sign)


def share_typed(columns: Mapping[str, Any], share: Any) -> Array:
    """Return the friction for a share of each scene's critical friction (MUC), a fraction of
    P_t/P_n, as line 280 would take it: line 400 turns its sign where gt > 0. NaN where no friction
    ends the sliding. The ``columns``' own MU is not looked at."""
    critical = quantities({**columns, "MU": PIVOT}, ("MUC", "PN", "gt"))
    with np.errstate(invalid="ignore"):
        mu = np.where(critical["PN"] > 0, np.asarray(share) * critical["MUC"], np.nan)
        return np.asarray(np.where(critical["gt"] > 0, -mu, mu) + 0.0)


def resolve_share(texts: Mapping[str, str], share: float, source: str) -> tuple[str, str]:
    """Return MU's number as text for a scene whose MU is a ``share``, and a remark that says so.
    Raises UserError."""
    numbers = {"M": double(DEFAULT_M)}
    numbers |= {name: double(texts[name]) for name in SCENE if name in texts and name != "MU"}
    mu = float(share_typed(numbers, share))
    if not math.isfinite(mu):
        raise UserError(
            f"MU = {texts['MU']}: no friction ends the sliding here; expected a number", source
        )
    number = repr(mu).removesuffix(".0").upper()
    return number, f"MU = {number} is {100 * share:g} % of the critical friction"


@np.errstate(all="ignore")
def _solve_part(
    inputs: Mapping[str, Source],
    results: Mapping[str, Array],
    tile: int,
    sign: float | None,
    start: int,
    stop: int,
) -> None:
    """Solve scenes ``start`` to ``stop``, block by block."""
    use_library = sign is None and native.library is not None
    for at in range(start, stop, 2 * tile):
        end = min(at + 2 * tile, stop)
        values = {name: part(source, at, end) for name, source in inputs.items()}
        targets = {name: array[at:end] for name, array in results.items()}
        if use_library:
            starts = [address(target) for target in targets.values()]
            columns, steps = [*map(address, values.values())], [len(x) > 1 for x in values.values()]
            compiledcalls.compute(columns, steps, tuple(results), starts, end - at, 1)
        else:
            _compute_by_numpy(values, targets, tile, sign)


def _compute_by_numpy(
    values: Mapping[str, Array], targets: Mapping[str, Array], tile: int, sign: float | None
) -> None:
    """Write the results of a block of scenes to the ``targets``."""
    block = examine(values)
    constants = {name: float(column[0]) for name, column in block.fixed.items()}
    program = program_for(block.kinds, tuple(targets), sign)
    columns = [block.varying[name] for name in program.columns]
    Plan(program).run(columns, targets, constants, tile)
    if block.refused is not None:
        for name, result in targets.items():
            result[block.refused] = Status.NOT_FINITE if name == "STATUS" else np.nan
