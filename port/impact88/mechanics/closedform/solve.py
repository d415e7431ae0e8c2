"""`impact88.solve`: the impact in double precision over any number of scenes.

Same physics as the 1988 listing (Equations 13 to 18, its sign rule of line 400, its pivot and its
point masses) with exact pi, by the closed form of `closedform.impact`.
"""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

from numpy.typing import NDArray

from ...collision.mappings import scene_columns
from ...errors import UserError
from ...messages.arguments import explains_arguments
from ...names import RESULTS, split_names
from .. import native
from .general import solve_arrays
from .impactprograms import ALL
from .omitted import not_given, solve_without
from .plain import solve_plain

Array = NDArray[Any]


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
        results = solve_plain(columns, wanted, threads, out)
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
