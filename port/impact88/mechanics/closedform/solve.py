"""`impact88.solve`: the impact in double precision over any number of scenes.

Same physics as the 1988 listing (Equations 13 to 18, its sign rule of line 400, its pivot and its
point masses) with exact pi, by the closed form of `closedform.impact`. Float64 arrays of one shape
and numbers are read where they are: `bounds` and root finders make many short calls.
"""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.mappings import scene_columns
from ...errors import UserError
from ...messages.arguments import explains_arguments
from ...names import RESULTS, split_names
from .. import native
from .columns import source_of
from .compiledcalls import TILE, call_of
from .general import solve_arrays, solve_sources
from .impactprograms import ALL, COLUMNS
from .omitted import not_given, solve_without
from .results import address, allocate_results, results_into

Array = NDArray[Any]

PLAIN = {float, int, np.float64}
_FLOATS = np.dtype(np.float64)
_in_order = itemgetter(*COLUMNS)


@explains_arguments
def solve(
    columns: Mapping[str, object],
    outputs: Sequence[str] | str | None = None,
    *,
    threads: int | None = None,
    out: Mapping[str, Array] | None = None,
) -> dict[str, Array]:
    """Solve the impact of every scene.

    Parameters
    ----------
    columns : mapping of str to float or array_like
        Scene name -> number or array (see `impact88.names.SCENE`); all broadcast together. Angles
        in degrees, spins in radians per unit of time. ``MU`` = -10 is the pivot; any other MU takes
        the sign line 400 gives it (changed where gt > 0, kept on a tie), or, as a text such as "85
        %", that share of the critical friction. ``M`` is 6 (the default) or 4. Infinite MA, IA, MB
        or IB make a rigid barrier.
    outputs : sequence of str, or str, optional
        The result names wanted (`impact88.names.RESULTS`), all of them by default. Only what they
        need is computed.
    threads : int, optional
        How many to use; by default as many as there are idle processors and work.
    out : mapping of str to ndarray, optional
        Result name -> array to write it into, of the broadcast shape, contiguous, aligned, float64
        (STATUS: uint16), apart from all columns; given again and again it spares the paging in of
        fresh memory. Where ``outputs`` is left out, its names are the results wanted.

    Returns
    -------
    dict of str to ndarray
        Arrays of the broadcast shape, float64 (STATUS: uint16), in the order asked; of one scene,
        given as plain numbers, numbers (numpy's float64, which is a float), the same bits. Where
        scenes lack inputs, the results that use none of them; the attribute ``absent`` names the
        others, each with the inputs it needs.

    Raises
    ------
    UserError
        For unknown names, missing inputs that every wanted result needs, columns that hold no
        numbers or do not broadcast, and arrays in ``out`` that cannot take the results.

    Notes
    -----
    Equations 13 to 18, each final velocity in closed form.

    M = 4 is the point-mass impact: DA and DB count as 0; EM, angles other than GA and inertias are
    not looked at, spins pass through and stay out of the energies. An infinite body must be at
    rest and adds no energy; not both bodies may be infinite (mass or inertia).

    An input that no wanted result uses need not be given: point masses that are locked together (E
    = 0 beside MU = -10) need no GA, and those that move along one line have their contact plane
    across it, and nothing acts along the plane. STATUS then has what holds for every value of what
    is missing (`closedform.omitted`).

    A scene with a number that cannot be used (not finite, M neither 4 nor 6, a mass or inertia
    that is not positive, a barrier that moves, two barriers) is NaN in every result and has
    NOT_FINITE alone in STATUS; a scene without solution is NaN in what depends on it, and so are
    ratios of zeros (LOSS and MUC where nothing moves) and what overflows; NOT_FINITE says so of all
    but MUC. Every scene gets the bits it would get alone, unless something overflows on the way
    (where numbers reach 1e±150): a term that is known to be 0 is left out, and beside scenes where
    it is not, 0 times infinity is NaN. A zero is +0.0 always.

    Where the listing does not solve its own equations (line 510 zeroes a right-hand side), the
    equations are solved: an MU below -10, or MU = 10 that the sign rule makes -10, is taken as the
    friction coefficient it is, with MU_OUT_OF_RANGE in STATUS.

    SINGULAR in STATUS means COND >= 2**26 (half of a double's digits may be lost), ENERGY_GAINED
    more than 1e-12 of KI, the FRICTION bits that P_t/P_n is not one that friction can make
    (`closedform.statusbits.friction_faults`); `impact88.status` says all in words.

    Examples
    --------
    >>> scene = impact88.sample(1).numbers()
    >>> impact88.solve({**scene, "MU": [0.5, 0.911, -10]}, ["LOSS"])["LOSS"].round(2)
    array([44.43, 57.47, 57.56])
    """
    if outputs is None:
        outputs = ALL if out is None else tuple(out)
    elif isinstance(outputs, str):
        outputs = split_names(outputs)
    wanted = _check_results(tuple(outputs))
    # plain numbers and float64 arrays need no reading
    if isinstance(columns, dict) and wanted and native.library is not None:
        results = _solve_plain(columns, wanted, threads, out)
        if results is not None:
            return results
    # texts, units, lists, frames' columns, scenes that lack inputs do
    scene, shares = scene_columns(columns)
    if out is None and (lacking := not_given(scene)):
        return solve_without(scene, shares, lacking, wanted, threads)
    arrays = solve_arrays(scene, wanted, threads, out=out, shares=shares)
    # one scene gives numbers, not arrays without dimensions
    return {
        name: array[()] if array.ndim == 0 and out is None else array
        for name, array in arrays.items()
    }


@lru_cache(maxsize=256)
def _check_results(names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names, each once. Raises UserError for one that is not a result."""
    for name in names:
        if name not in RESULTS:
            raise UserError(f"{name!r} is not a result name; expected some of {' '.join(RESULTS)}")
    return tuple(dict.fromkeys(names))


@lru_cache(maxsize=256)
def _places(types: tuple[type, ...]) -> tuple[tuple[int, ...], list[int]] | None:
    """Return the places of the arrays and of the numbers among values of these types; None unless
    all are arrays or plain numbers."""
    if not all(kind is np.ndarray or kind in PLAIN for kind in types):
        return None
    columns = tuple(i for i, kind in enumerate(types) if kind is np.ndarray)
    return columns, [i for i in range(len(types)) if i not in columns]


def _solve_plain(
    columns: Mapping[str, Any],
    wanted: tuple[str, ...],
    threads: int | None,
    out: Mapping[str, Array] | None,
) -> dict[str, Any] | None:
    """Return the results ``wanted`` of plain columns of one shape and numbers, or of one scene of
    plain numbers, which gives numbers (numpy's float64, STATUS uint16); None where the columns have
    to be read first. The compiled library is there.

    ``threads``, ``out``: as in `solve`.
    """
    if "M" not in columns:
        columns = {**columns, "M": 6.0}
    try:
        values = _in_order(columns)
    except KeyError:
        return None
    places = _places(tuple(map(type, values))) if len(columns) == len(COLUMNS) else None
    if places is None:
        return None
    try:
        if places[0]:
            return _solve_columns(*places, values, wanted, threads, out)
        return None if out is not None else call_of(wanted, ()).solve(np.array(values, float), ())
    except (TypeError, OverflowError):  # not numbers
        return None


def _solve_columns(
    columns: tuple[int, ...],
    numbers: Sequence[int],
    values: tuple[Any, ...],
    wanted: tuple[str, ...],
    threads: int | None,
    out: Mapping[str, Array] | None,
) -> dict[str, Any] | None:
    """Return the results of values of which those at the places ``columns`` are arrays. Raises
    TypeError and OverflowError for those that are no numbers."""
    arrays, constants = [values[i] for i in columns], [values[i] for i in numbers]
    shape, count = arrays[0].shape, arrays[0].size
    if not all(array.shape == shape for array in arrays):
        return None
    call = call_of(wanted, columns)
    if count <= TILE and out is None:  # the copy that the library would make
        rows = np.concatenate([*arrays, constants], None, dtype=np.float64, casting="same_kind")
        return call.solve(rows, shape)
    if (starts := _starts(arrays)) is None:
        if not all(array.dtype.kind in "fiub" for array in arrays):
            return None
        sources = {n: source_of(np.asarray(x), shape) for n, x in zip(COLUMNS, values, strict=True)}
        return solve_sources(sources, shape, wanted, threads, out)
    number_row = np.array(constants, np.float64)
    first = address(number_row)
    if out is None:
        by_name, results = allocate_results(wanted, shape)
    else:
        by_name, results = results_into(out, wanted, shape, arrays, starts)
    number_starts = range(first, first + number_row.nbytes, 8)
    call.compute([*starts, *number_starts, *results], count, threads)
    return by_name


def _starts(arrays: Sequence[Array]) -> list[int] | None:
    """Return the addresses of float64 arrays; None unless all are such, contiguous and aligned."""
    for array in arrays:
        if array.dtype != _FLOATS or not (array.flags.c_contiguous and array.flags.aligned):
            return None
    return [*map(address, arrays)]
