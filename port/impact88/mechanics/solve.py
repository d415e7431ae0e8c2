"""`impact88.solve`, `prepared` and `evaluate`: the impact in double precision over any scenes."""

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..decimals import to_double
from ..errors import UserError, quoted
from ..names import RESULTS, SCENE, check_names, missing, split_names
from .kernel import Kernel, run_formulas
from .plan import QUANTITIES, plan

Array = NDArray[Any]
Names = tuple[str, ...]

_COLUMNS = frozenset(SCENE)
BODIES = 6.0  # M of bodies
POINT = 4.0  # M of point masses
UNUSED_BY_POINTS = ("DA", "DB", "PA", "PB", "TA", "TB", "IA", "IB", "EM")
"""Columns that the impact of a point mass does not use; NaN where not given."""
_UNUSED = {**dict.fromkeys(SCENE, 0.0), **dict.fromkeys(("MA", "MB", "IA", "IB"), 1.0)}
"""Usable numbers for columns that no wanted result needs."""


def solve(
    columns: Any,
    results: Sequence[str] | str | None = None,
    *,
    out: Mapping[str, Array] | None = None,
    threads: int | None = None,
) -> dict[str, Any]:
    """Solve the impact of every scene.

    Parameters
    ----------
    columns : mapping of str to float or array_like, or a data frame
        Scene name -> number or array (see `impact88.names.SCENE`); all broadcast together. Any
        mapping serves, and a frame of pandas, polars or pyarrow; what else it holds is ignored.
        Angles in degrees, spins in radians per unit of time. ``MU`` = -10 is the pivot; any other
        MU takes the sign that line 400 gives it: changed where the contact points slide along +t,
        kept on a tie. ``M`` is 6 (the default) or 4, point masses. Infinite MA and IA, or MB and
        IB, make a rigid barrier. Decimal texts are read as the 1988 program reads them.
    results : sequence of str, or str, optional
        The results wanted (see `impact88.names.RESULTS`), all of them by default. Only what they
        need is computed, and has to be given.
    out : mapping of str to ndarray, optional
        Result name -> array to write it into: of the broadcast shape, contiguous, float64 (STATUS:
        uint16), apart from all columns. Without ``results`` its names are the results wanted.
    threads : int, optional
        The number of threads; by default as many as there are processors and work.

    Returns
    -------
    dict of str to ndarray
        Arrays of the broadcast shape, float64 (STATUS: uint16), in the order asked; numbers where
        all columns are numbers.

    Raises
    ------
    UserError
        For unknown names, missing columns, values that are no numbers, shapes that do not
        broadcast, and arrays in ``out`` that cannot take the results.

    Notes
    -----
    Equations 13 to 18 of the chapter with the impulse as unknown (see `mechanics.formulas`).

    *Accuracy.* The six final velocities are backward stable: for cars and other ordinary scenes
    their error is at most 3 times what rounding each number of the scene to a double does to them
    (extreme masses, arms or pivots: 6). It is measured by the largest velocity, or spin, of the
    scene: a small velocity left of a light body is accurate to the largest velocity, not to its own
    last digit. Energies and works follow from the impulses, so a small loss keeps its digits.

    *Point masses* (M = 4) do not use DA, DB, PA, PB, TA, TB, IA, IB and EM, which need not be
    given; their spins pass through and stay out of the energies.

    *Unusable scenes* (a number that is missing, not finite or not allowed: M neither 4 nor 6,
    masses or inertias not above 0, two barriers, a barrier that moves) are NaN in every result and
    have NOT_FINITE alone in STATUS. A scene without a solution is NaN in what depends on it, and so
    are ratios of zeros. Every scene has the bits that it has alone. No zero is negative.

    *STATUS* never changes a number. SINGULAR means COND >= 2**26, ENERGY_GAINED more than 1e-12 of
    KI; `impact88.status` explains every bit.

    Examples
    --------
    >>> scene = impact88.sample(1).numbers()
    >>> impact88.solve({**scene, "MU": [0.5, 0.911, -10]}, ["LOSS"])["LOSS"].round(2)
    array([44.43, 57.47, 57.56])
    """
    if results is None:
        results = tuple(RESULTS if out is None else out)
    if threads is not None and not (isinstance(threads, int | np.integer) and threads > 0):
        raise UserError(f"threads is {quoted(threads)}; expected a whole number above 0, or None")
    wanted = _result_names(tuple(split_names(results)))
    shape, inputs, varying = _flatten(_read_columns(columns, wanted))
    kernel = _kernel(wanted, _COLUMNS, varying, True)
    return kernel.compute(*_select(inputs, kernel), shape, out, threads)


def evaluate(
    known: Mapping[str, ArrayLike], wanted: Sequence[str] | str
) -> tuple[dict[str, Array], dict[str, tuple[str, ...]]]:
    """Return the quantities of impacts that follow from what is known of them.

    Parameters
    ----------
    known : mapping of str to float or array_like
        Names of the scene, of results and of other quantities -> numbers or arrays, which
        broadcast together. A quantity that is known is not computed: of an impact whose velocities
        and impulses are known, before and after, the rest follows from these. M is 6 where it is
        not given.
    wanted : sequence of str, or str
        Results and other quantities: speeds and courses (SA, HAF ...), direction and size of the
        force (PDOFA, P), velocity changes along the vehicles (DVAF ...), EL, DT, the contact point
        (CAX ...), coefficients and impulses where they follow from velocities, and the quantities
        of `mechanics.formulas` by their names there (gn and gt: relative velocity of the contact
        points before; s, c, an, at, bn, bt: the geometry).

    Returns
    -------
    values : dict of str to ndarray
        The quantities that follow, in the order asked, as float64 (STATUS, too) of the broadcast
        shape. Nothing is checked: what is not finite stays as it is.
    missing : dict of str to tuple of str
        The quantities that do not follow -> the scene's names that they lack.

    Raises
    ------
    UserError
        For names in ``wanted`` that are no quantity, and for shapes that do not broadcast.

    Notes
    -----
    Plans are kept: a call with the same names and shapes costs some microseconds and the computing
    itself. `prepared` is for calls that leave most of a scene as it is.

    Examples
    --------
    >>> scene = impact88.sample(1).numbers()
    >>> values, missing = impact88.evaluate({"MA": 94, "UX": 60, "UY": 0, "E": 0.2}, "DVA VS KI")
    >>> missing["KI"]
    ('MB', 'IA', 'IB', 'WA', 'VX', 'VY', 'WB')
    >>> print(impact88.evaluate(scene, ["MUC"])[0]["MUC"].round(3))
    0.932
    """
    names = tuple(split_names(wanted))
    check_names(names, QUANTITIES, "quantity of an impact")
    values = {x: _as_doubles(x, value) for x, value in known.items() if x in QUANTITIES}
    _complete_points(values)
    shape, inputs, varying = _flatten(values)
    kernel = _kernel(names, frozenset(values), varying, False)
    values = {
        x: np.float64(value) if type(value) is float else value for x, value in values.items()
    }
    if kernel.results:
        values |= kernel.compute(*_select(inputs, kernel), shape)
    if kernel.following:
        run_formulas(kernel.following, values)
    results = {
        name: x if (x := values[name]).shape == shape else np.broadcast_to(x, shape)
        for name in names
        if name not in kernel.missing
    }
    return results, kernel.missing


def prepared(
    names: Sequence[str] | str,
    results: Sequence[str] | str | None = None,
    scene: Mapping[str, object] | None = None,
) -> "Prepared":
    """Return a function of some of a scene's numbers, for many short calls.

    Names are checked, the scene is read and the computation is planned once. A call then costs some
    microseconds and the computing itself: for root finders, samplers and optimizers.

    Parameters
    ----------
    names : sequence of str, or str
        The columns given at each call, in the order of their rows (`impact88.names.SCENE`).
    results : sequence of str, or str, optional
        Result names; all of them by default.
    scene : mapping of str to float, optional
        The columns that stay, one number each, as `solve` reads them. What it holds of ``names``
        is ignored. M is 6 where it is not given.

    Returns
    -------
    Prepared
        Called with an array whose rows are the columns, ``names`` by n: the results by name. It can
        be called by several threads at a time, and be sent to other processes.

    Raises
    ------
    UserError
        For unknown, repeated and missing names, and for values that are no numbers; when called,
        for rows that do not fit ``names``.

    Examples
    --------
    >>> loss = impact88.prepared(["MU"], ["LOSS"], impact88.sample(1))
    >>> print(loss([0.5])["LOSS"].round(2))
    44.43
    >>> loss([[0.5, 0.911, -10]])["LOSS"].round(2)
    array([44.43, 57.47, 57.56])
    """
    return Prepared(names, results, scene)


class Prepared:
    """Results of scenes that share all but some numbers: see `prepared`.

    Parameters
    ----------
    names : sequence of str, or str
        The columns given at each call, in the order of their rows.
    results : sequence of str, or str, optional
        Names of the results; all of them by default.
    scene : mapping of str to float, optional
        The columns that stay.

    Examples
    --------
    >>> loss = impact88.prepared(["MU", "E"], ["LOSS"], impact88.sample(1))
    >>> loss.names, loss.results
    (('MU', 'E'), ('LOSS',))
    """

    def __init__(
        self,
        names: Sequence[str] | str,
        results: Sequence[str] | str | None = None,
        scene: Mapping[str, object] | None = None,
    ) -> None:
        self.names = tuple(split_names(names))
        check_names(self.names, SCENE, "scene name")
        if not self.names:
            raise UserError(f"no scene name is given; expected some of {' '.join(SCENE)}")
        if len(set(self.names)) < len(self.names):
            raise UserError(f"a name appears twice in {' '.join(self.names)}; expected each once")
        self.results = _result_names(tuple(RESULTS if results is None else split_names(results)))
        stays = _read_columns({} if scene is None else scene, self.results, self.names)
        shape, self._scene, varying = _flatten(stays)
        if varying:
            raise UserError(f"{' '.join(varying)}: {shape} numbers; expected one that stays")
        self._kernel = _kernel(self.results, _COLUMNS, frozenset(self.names), True)
        self._numbers, _ = _select(self._scene, self._kernel)
        self._rows = [self.names.index(name) for name in self._kernel.changing]

    def __call__(self, values: ArrayLike, *surplus: object) -> dict[str, Any]:
        """Return the results of scenes.

        Parameters
        ----------
        values : array_like
            A row for each of ``names``: numbers, or arrays of one shape.

        Returns
        -------
        dict of str to ndarray
            Result name -> array of the rows' shape; numbers where the rows are numbers.

        Raises
        ------
        UserError
            For rows that do not fit ``names``.
        """
        try:
            block = np.asarray(values, np.float64)
            if surplus or block.shape[:1] != (len(self.names),):
                raise ValueError
        except (TypeError, ValueError):
            names = " ".join(self.names)
            raise UserError(f"expected one array with a row for each of {names}") from None
        if not block.flags.carray:
            block = block.copy()
        columns = [block[row].reshape(-1) for row in self._rows]
        return self._kernel.compute(self._numbers, columns, block.shape[1:])

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what another process makes an equal function of: no addresses."""
        return Prepared, (self.names, self.results, self._scene)


_kernel = lru_cache(maxsize=1024)(Kernel)


def _select(inputs: Mapping[str, Any], kernel: Kernel) -> tuple[Array, list[Array]]:
    """Return the numbers and the columns that a kernel takes."""
    numbers = np.array([inputs[name] for name in kernel.fixed], np.float64)
    return numbers, [inputs[name] for name in kernel.changing]


@lru_cache(maxsize=512)
def _result_names(results: Names) -> Names:
    """Return result names, each once. Raises UserError."""
    wanted = tuple(dict.fromkeys(results))
    check_names(wanted, RESULTS, "result")
    if not wanted:
        raise UserError(f"no result is asked for; expected some of {' '.join(RESULTS)}")
    return wanted


def _read_columns(columns: Any, wanted: Names, given: Names = ()) -> dict[str, Any]:
    """Return all columns as doubles, those of a mapping or frame; those ``given`` later, and what
    no wanted result needs, as usable numbers. Raises UserError."""
    names = columns
    if not isinstance(columns, Mapping):  # a frame: of pyarrow, or of pandas or polars
        names = None
        if not hasattr(columns, "collect"):  # a lazy frame
            names = getattr(columns, "column_names", getattr(columns, "columns", None))
        if names is None:
            kind = type(columns).__name__
            raise UserError(f"{kind} has no columns; expected a mapping or a data frame")
    numbers: dict[str, Any] = {name: _UNUSED[name] for name in given}
    for name in SCENE:
        if name in names and name not in numbers:
            numbers[name] = _as_doubles(name, columns[name])
    _complete_points(numbers)
    if len(numbers) < len(SCENE):
        if lacking := [name for name in plan(wanted).inputs if name not in numbers]:
            raise UserError(missing(lacking))
        numbers = {**_UNUSED, **numbers}
    return numbers


def _complete_points(numbers: dict[str, Any]) -> None:
    """Add M where it is not given, and NaN for what point masses do not use."""
    m = numbers.setdefault("M", BODIES)
    if m is not BODIES and np.all(m == POINT):
        for name in UNUSED_BY_POINTS:
            numbers.setdefault(name, math.nan)


def _as_doubles(name: str, value: Any) -> Any:
    """Return a column's numbers. Raises UserError for what is no number."""
    kind = type(value)
    if kind is float or (kind is np.ndarray and value.dtype == np.float64):
        return value
    if isinstance(value, np.ma.MaskedArray):
        value = np.ma.filled(value.astype(np.float64), np.nan)
    try:
        array = np.asarray(value)
    except ValueError:
        raise UserError(f"{name} is {quoted(value)}; expected a number or an array") from None
    if array.dtype.kind not in "fiub":
        cells = [_number(name, at, cell) for at, cell in enumerate(array.flat)]
        array = np.array(cells).reshape(array.shape)
    return array.astype(np.float64, copy=False)


def _number(name: str, at: int, cell: Any) -> float:
    """Return the number of a cell, NaN for one that is missing. Raises UserError."""
    try:
        if cell is None or type(cell).__name__ == "NAType":  # of pandas
            return math.nan
        if isinstance(cell, str):
            cell = str(cell)  # not numpy's
            return to_double(cell)
        if not np.iscomplexobj(cell):
            return float(cell)
    except (TypeError, ValueError):
        pass
    raise UserError(f"{name} = {quoted(cell)} at position {at} is no number; expected a number")


def _flatten(numbers: Mapping[str, Any]) -> tuple[tuple[int, ...], dict[str, Any], frozenset[str]]:
    """Return the shape that columns broadcast to, the columns flat, those of one number as a
    number, and the names of the others. Raises UserError where they do not broadcast."""
    arrays = {name: x for name, x in numbers.items() if type(x) is not float}
    shapes = {array.shape for array in arrays.values()} or {()}
    try:  # numpy takes 3 us
        (shape,) = shapes if len(shapes) == 1 else [np.broadcast_shapes(*shapes)]
    except ValueError:
        sizes = ", ".join(f"{n} {x.shape}" for n, x in arrays.items() if x.shape)
        raise UserError(f"columns do not broadcast together: {sizes}") from None
    flat = dict(numbers)
    varying = []
    for name, array in arrays.items():
        if array.size == 1:
            flat[name] = array.item()
            continue
        varying.append(name)
        if array.ndim != 1 or array.shape != shape or not array.flags.carray:
            flat[name] = np.require(np.broadcast_to(array, shape), None, ("C", "A")).reshape(-1)
    return shape, flat, frozenset(varying)
