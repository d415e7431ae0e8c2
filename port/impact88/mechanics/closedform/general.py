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
from ..native.processors import run_in_threads
from .columns import BLOCK, Source, examine, part, sources
from .compiledcalls import Call, call_of
from .impactprograms import program_for
from .plan import Plan
from .results import address, allocate_results, results_into

Array = NDArray[Any]


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
    return solve_sources(inputs, shape, wanted, threads, out, sign) if wanted else {}


def solve_sources(
    inputs: Mapping[str, Source],
    shape: tuple[int, ...],
    wanted: tuple[str, ...],
    threads: int | None,
    out: Mapping[str, Array] | None = None,
    sign: float | None = None,
) -> dict[str, Array]:
    """Solve columns of one ``shape``, in the table's order; otherwise as `solve_arrays`."""
    if out is None:
        arrays, starts = allocate_results(wanted, shape)
    else:
        input_arrays = [x.base if isinstance(x, np.flatiter) else x for x in inputs.values()]
        arrays, starts = results_into(out, wanted, shape, input_arrays)
    count = math.prod(shape)
    if sign is None and native.library is not None:
        every = [*inputs.values()]
        columns = [at for at, source in enumerate(every) if len(source) > 1]
        numbers = [at for at, source in enumerate(every) if len(source) == 1]
        call = call_of(wanted, tuple(columns))
        sizes = [array.itemsize for array in arrays.values()]
        targets = [*zip(starts, sizes, strict=True)]
        work = partial(_compute_by_library, [every[at] for at in columns + numbers], call, targets)
        run_in_threads(work, count, BLOCK, threads)
    else:  # numpy's short operations hold the interpreter's lock: threads would take turns
        _compute_by_numpy(inputs, {n: array.reshape(count) for n, array in arrays.items()}, sign)
    return arrays


def quantities(
    columns: Mapping[str, object], names: Sequence[str], sign: float | None = None
) -> dict[str, Array]:
    """Return results and other quantities of `closedform.impact`, such as ``gt`` and
    ``determinant``, by their names there; otherwise as `solve`, on one thread.

    ``sign``: +1 keeps MU's sign in all scenes, -1 changes it; None applies line 400's rule.
    """
    return solve_arrays(columns, tuple(names), 1, sign)


def opposing(mu: Any, slip: Any) -> Array:
    """Return ``mu`` with the sign that line 400 gives it, changed where the slip gt > 0, so that
    friction opposes the sliding; of the signed P_t/P_n the MU to type in line 280. The pivot stays,
    and so does the sign where the slip is NaN."""
    mu = np.asarray(mu)
    return np.asarray(np.where((slip > 0) & (mu != PIVOT), -mu, mu) + 0.0)


def typed_friction(columns: Mapping[str, Any], signed: Any) -> Array:
    """Return the MU to type for a ``signed`` P_t/P_n of scenes, or that of a MU typed.

    ``columns`` need no E, EM and MU, which the sliding before the impact does not depend on."""
    scene = {"E": 0.0, "EM": 0.0, **columns, "MU": PIVOT}
    return opposing(signed, quantities(scene, ("gt",))["gt"])


def share_typed(columns: Mapping[str, Any], share: Any) -> Array:
    """Return the friction for a share of each scene's critical friction (MUC), a fraction of
    P_t/P_n, as line 280 would take it: line 400 turns its sign where gt > 0. NaN where no friction
    ends the sliding. The ``columns``' own MU is not looked at."""
    critical = quantities({**columns, "MU": PIVOT}, ("MUC", "PN", "gt"))
    with np.errstate(invalid="ignore"):
        mu = np.where(critical["PN"] > 0, np.asarray(share) * critical["MUC"], np.nan)
        return opposing(mu, critical["gt"])


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


def _compute_by_library(
    inputs: Sequence[Source], call: Call, targets: Sequence[tuple[int, int]], begin: int, end: int
) -> None:
    """Solve scenes ``begin`` to ``end`` by the library, a block of columns converted at a time.
    ``targets``: address and item size of each result."""
    for at in range(begin, end, BLOCK):
        stop = min(at + BLOCK, end)
        values = [part(source, at, stop) for source in inputs]
        results = [start + size * at for start, size in targets]
        call.compute([*map(address, values), *results], stop - at, 1)


@np.errstate(all="ignore")
def _compute_by_numpy(
    inputs: Mapping[str, Source], results: Mapping[str, Array], sign: float | None
) -> None:
    """Solve all scenes by numpy, block by block."""
    count = len(next(iter(results.values())))
    for at in range(0, count, BLOCK):
        block = examine({name: part(source, at, at + BLOCK) for name, source in inputs.items()})
        targets = {name: array[at : at + BLOCK] for name, array in results.items()}
        constants = {name: float(column[0]) for name, column in block.fixed.items()}
        program = program_for(block.kinds, tuple(targets), sign)
        columns = [block.varying[name] for name in program.columns]
        Plan(program).run(columns, targets, constants, BLOCK)
        if block.refused is not None:
            for name, result in targets.items():
                result[block.refused] = Status.NOT_FINITE if name == "STATUS" else np.nan
