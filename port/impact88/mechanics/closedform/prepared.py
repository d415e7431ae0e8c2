"""`impact88.prepared`: everything that calls of `solve` have in common, done once."""

import ctypes
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...collision.case import FACING_COURSE, check_mapping
from ...collision.mappings import common_shape, in_doubles, scene_columns
from ...collision.units import system_of
from ...errors import UserError, quoted
from ...messages.arguments import explains_arguments
from ...names import RESULTS, SCENE, split_names
from ...status import Status
from .. import native
from .columns import sources
from .compiledcalls import Call
from .impactprograms import ALL, COLUMNS
from .results import address
from .solve import PLAIN, solve

Array = NDArray[Any]

_FLOATS = np.dtype(np.float64)


@explains_arguments
def prepared(
    names: Sequence[str] | str,
    outputs: Sequence[str] | str | None = None,
    scene: Mapping[str, object] | None = None,
) -> "Prepared":
    """Return a function of some of a scene's numbers, for many short calls.

    Names are checked, the scene is read and the computation chosen once. What is left to a call is
    a few microseconds, whatever is computed: for root finders, samplers and optimizers.

    Parameters
    ----------
    names : sequence of str, or str
        The inputs given at each call, in the order of their rows (``impact88.names.SCENE``).
    outputs : sequence of str, or str, optional
        Result names; all of them by default.
    scene : mapping of str to float or str, optional
        The inputs that stay, one number each, as `impact88.solve` reads them. What it holds of
        ``names`` is not looked at. M is 6 where left out.

    Returns
    -------
    Prepared
        Called with an array whose rows are the inputs, ``names`` by n, or with a sequence of
        numbers or arrays, one for each name: the results by name, n each, and numbers where the
        inputs are numbers. It has attributes ``names`` and ``outputs``, may be called by several
        threads at a time, and be sent to other processes.

    Raises
    ------
    UserError
        For missing, unknown or repeated names, an MU that is a share of the critical friction, and
        whatever else `impact88.solve` refuses; when called, for rows that do not fit ``names``.

    Notes
    -----
    The results have the bits of `impact88.solve`, in fresh memory. An array of float64 in C order
    is read where it is; anything else is copied. Where ``scene`` names ``units``, a call's numbers
    are in that system, too.

    Examples
    --------
    >>> loss = impact88.prepared(["MU"], ["LOSS"], impact88.sample(1))
    >>> print(loss([0.5])["LOSS"].round(2))
    44.43
    >>> loss([[0.5, 0.911, -10]])["LOSS"].round(2)
    array([44.43, 57.47, 57.56])
    """
    inputs = split_names(names) if isinstance(names, str) else tuple(names)
    results = ALL if outputs is None else outputs
    results = split_names(results) if isinstance(results, str) else tuple(results)
    constants = {} if scene is None else scene
    check_mapping(constants)
    _check_names(inputs, SCENE, "scene")
    _check_names(results, RESULTS, "result")
    if len(set(inputs)) < len(inputs):
        raise UserError(f"a name stands twice in {' '.join(inputs)}; expected each once")
    return Prepared(tuple(inputs), tuple(dict.fromkeys(results)), constants)


def _check_names(names: Sequence[str], table: Iterable[str], what: str) -> None:
    """Raise UserError where no names are given, or one is not in the table."""
    if not names:
        raise UserError(f"no {what} name is given; expected some of {' '.join(table)}")
    for name in names:
        if name not in table:
            raise UserError(f"{name!r} is not a {what} name; expected some of {' '.join(table)}")


class Prepared:
    """Results of scenes that share all but some numbers: see `prepared`.

    Parameters
    ----------
    names : tuple of str
        The inputs given at each call, in the order of their rows.
    outputs : tuple of str
        Names of the results.
    scene : mapping of str to float or str
        The inputs that stay.

    Examples
    --------
    >>> loss = impact88.prepared(["MU", "E"], ["LOSS"], impact88.sample(1))
    >>> loss.names, loss.outputs
    (('MU', 'E'), ('LOSS',))
    """

    def __init__(
        self, names: tuple[str, ...], outputs: tuple[str, ...], scene: Mapping[str, object]
    ) -> None:
        self.names = names
        self.outputs = outputs
        self._scene = {name: value for name, value in scene.items() if name not in names}
        columns, shares = scene_columns(self._scene)
        if shares is not None:
            raise UserError(
                f"MU = {quoted(self._scene['MU'])} is a share of the critical friction, which each "
                "scene has for itself; expected a number"
            )
        for name in ("TA", "TB"):  # a course of velocities that are known is a number by now
            if isinstance(self._scene.get(name), str) and np.isnan(columns[name]):
                raise UserError(
                    f'{name} = "{FACING_COURSE}" follows from velocities that are given at each '
                    "call; expected degrees"
                )
        # a placeholder for the numbers of each call: 6 is a number that M may be, too
        inputs, shape = sources({**columns, **dict.fromkeys(names, 6.0)})
        if shape:
            arrays = [name for name, source in inputs.items() if len(source) != 1]
            raise UserError(
                f"{(arrays or ['scene'])[0]} holds more than one number; expected it among the "
                "names that are given at each call"
            )
        self._values = np.array([float(inputs[name][0]) for name in COLUMNS])
        self._call = Call(outputs, [COLUMNS.index(n) for n in names], (), self._values)
        self._expected = (len(names),)
        self._factors = None
        if "units" in self._scene:
            system = system_of(str(self._scene["units"]))
            self._factors = np.array([system.factor(name) for name in names])

    def __reduce__(self) -> tuple[Any, ...]:
        return Prepared, (self.names, self.outputs, self._scene)

    @explains_arguments
    def __call__(self, values: ArrayLike) -> dict[str, Array]:
        """Return the results by name of values, a row for each of ``names``. Raises UserError."""
        rows = self._rows_of(values)
        if self._factors is not None:
            rows = rows / self._factors.reshape(-1, *[1] * (rows.ndim - 1))
        if native.library is None:
            return self._solve_by_numpy(rows)
        return self._call.solve(rows, rows.shape[1:])

    @explains_arguments
    def bind(self, values: Array) -> "Bound":
        """Return a function of an array's current numbers, without arguments.

        Parameters
        ----------
        values : ndarray
            Numbers of float64 in C order, a row for each of ``names``, to be changed in place
            between the calls.

        Returns
        -------
        Bound
            Its calls write over one set of arrays, ``results``, and return it: nothing is
            left to a call but the computation. For one thread at a time.

        Raises
        ------
        UserError
            For another kind of array.

        Examples
        --------
        >>> values = np.full((1, 3), 0.5)
        >>> loss = impact88.prepared(["MU"], ["LOSS"], impact88.sample(1)).bind(values)
        >>> values[:] = 0.5, 0.911, -10
        >>> loss()["LOSS"].round(2)
        array([44.43, 57.47, 57.56])
        """
        if self._rows_of(values) is not values:
            raise UserError(
                f"values are not an array of float64 in C order, one row for each of "
                f"{' '.join(self.names)}; expected one, to be changed in place"
            )
        return Bound(self, values)

    def _rows_of(self, values: Any) -> Array:
        """Return the values themselves if they are contiguous float64, else a copy. Raises
        UserError."""
        if type(values) is np.ndarray and values.dtype == _FLOATS:
            flags = values.flags
            if flags.c_contiguous and flags.aligned and values.shape[:1] == self._expected:
                return values
        return self._read(values)

    def _solve_by_numpy(self, rows: Array) -> dict[str, Array]:
        """Return the results without the compiled library."""
        scene = dict(zip(COLUMNS, self._values.tolist(), strict=True))
        return solve({**scene, **dict(zip(self.names, rows, strict=True))}, self.outputs)

    def _read(self, values: Any) -> Array:
        """Return values of any accepted kind as an array of rows. Raises UserError."""
        expectation = f"one row for each of {' '.join(self.names)}"
        if isinstance(values, np.ndarray) and not values.ndim:
            raise UserError(f"values are one number; expected {expectation}")
        if isinstance(values, (str, bytes, Mapping)) or not hasattr(values, "__len__"):
            raise UserError(f"values are of type {type(values).__name__}; expected {expectation}")
        if len(values) != len(self.names):
            raise UserError(f"values have {len(values)} rows; expected {expectation}")
        if PLAIN.issuperset(map(type, values)):
            try:
                return np.array(values, np.float64)
            except OverflowError as error:
                raise UserError(f"a value is not a number: {error}") from None
        rows = {name: in_doubles(name, row) for name, row in zip(self.names, values, strict=True)}
        block = np.empty((len(rows), *common_shape("rows", rows)))
        for place, row in enumerate(rows.values()):
            block[place] = row
        return block


class Bound:
    """Function without arguments of the present numbers in one array: see `Prepared.bind`.

    Parameters
    ----------
    prepared_call : Prepared
        The function that is bound.
    values : ndarray
        The array.

    Attributes
    ----------
    values : ndarray
        The array.
    results : dict of str to ndarray
        The results of the last call by name, NaN before the first.
    """

    def __init__(self, prepared_call: Prepared, values: Array) -> None:
        self.values = values
        self._prepared = prepared_call
        call = prepared_call._call
        self._kept = results, bits = call.room(values.shape[1:])
        results.fill(np.nan)
        rows = iter(results[..., np.newaxis])
        if bits is not None:
            bits.fill(Status.NOT_FINITE)
        self.results: dict[str, Array] = {
            name: bits if bits is not None and name == "STATUS" else next(rows)[..., 0]
            for name in prepared_call.outputs
        }
        count = math.prod(values.shape[1:])
        self._run: Callable[[], object] | None = None
        self._machine = native.library
        if self._machine is not None and prepared_call._factors is None:
            places = [*values[..., np.newaxis], *self.results.values()]
            self._block = call.arguments([*map(address, places)])
            at = self._block.ctypes.data
            # numbers of C's own types are passed on as they are
            arguments = ctypes.c_void_p(at), ctypes.c_int64(0), ctypes.c_int64(count)
            self._run = partial(self._machine.solve_impacts, *arguments)

    def __call__(self) -> dict[str, Array]:
        """Return the results of what ``values`` hold, in the arrays of the call before."""
        if self._run is not None and native.library is self._machine:
            self._run()
        else:
            for name, result in self._prepared(self.values).items():
                self.results[name][...] = result
        return self.results
