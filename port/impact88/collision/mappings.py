"""Values from Python callers: a mapping of the listing's names to texts, numbers or arrays.

Texts are those a file may hold: numbers as INPUT reads them (`doubles`), amounts with units, ranges
where a value may be uncertain, ``units``, ``CAF CAL``, ``"estimate"``. Every public function that
computes in double precision reads its values here, so that a text means the same everywhere.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from ..errors import UserError, quoted
from ..names import SCENE
from .case import FACING_COURSE, Case, case_of, check_mapping, share_of
from .doubles import digits, double

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .uncertain import Uncertain

    Array = NDArray[Any]


def in_base(values: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the values in base units; texts become texts of plain numbers or ranges.

    If there is an entry ``units``, numbers and arrays are in that system, too. Raises UserError."""
    return _in_base(values, _number_in_base)[0]


def _number_in_base(name: str, value: Any, factor: float) -> Array:
    return in_doubles(name, value) / factor


def _in_base(
    values: Mapping[str, Any], convert: Callable[[str, Any, float], Any]
) -> tuple[Mapping[str, Any], str | None]:
    """Return `in_base` and the name of the system of units, None without units. ``convert``: makes
    of a name, what it is in that system, and the factor between the two what is in base units."""
    check_mapping(values)
    texts = {name: value for name, value in values.items() if isinstance(value, str)}
    if case_of(values) or not texts:
        return values, None
    if "units" in texts or FACING_COURSE in texts.values():
        texts |= {n: repr(v).upper() for n, v in values.items() if type(v) in (int, float)}
    case = Case(texts, "values")
    numbers = {name: value for name, value in values.items() if name not in texts}
    if case.units:
        numbers = {n: convert(n, v, case.system.factor(n)) for n, v in numbers.items()}
    base_values = dict(case.values)
    if "M" not in texts:  # the default 6 is set where it is needed
        del base_values["M"]
    # a blank text is refused by the code that reads it
    base_values |= {n: text for n, text in texts.items() if not text.strip()}
    if case.correlations:
        base_values["correlations"] = case.correlations
    return {**numbers, **base_values}, case.units


def base_system(values: Mapping[str, Any]) -> str | None:
    """Return the system whose units are the base units of the values ("si" or "chapter"); None if
    they name no system."""
    from .units import system_of

    case = case_of(values)
    units = case.units if case else _in_base(values, lambda *_: None)[1]
    return None if units is None else system_of(units).base_name


def in_doubles(name: str, values: Any) -> Array:
    """Return a value or an array of any shape as an array of numbers, float64 if it held texts.

    Missing cells of an array are NaN. Raises UserError if it holds anything else."""
    import numpy as np

    if type(values) is str:
        return np.float64(_double(name, values))  # type: ignore[return-value]
    if hasattr(values, "mask") and isinstance(values, np.ma.MaskedArray):  # np.ma is a late import
        if values.dtype.kind not in "fiub":
            raise UserError(f"holds {values.dtype} values; expected numbers", f"column {name}")
        return np.ma.filled(values.astype(np.float64), np.nan)
    try:
        array = np.asarray(values)
    except ValueError as error:  # rows of several lengths
        raise UserError(f"{error}; expected numbers", f"column {name}") from None
    if array.dtype.kind in "fiub":
        return array
    if array.dtype.kind not in "USO":
        raise UserError(f"holds {array.dtype} values; expected numbers", f"column {name}")
    # a missing cell becomes NaN; whether its row needs it is checked later
    cells = [
        math.nan if cell is None and array.ndim else _double(name, cell)
        for cell in array.reshape(-1).tolist()
    ]
    return np.array(cells, np.float64).reshape(array.shape)


def _double(name: str, value: Any) -> float:
    """Return one cell as a double. Raises UserError naming its column."""
    if value == FACING_COURSE and name in ("TA", "TB"):
        return math.nan  # `state.COURSE`; a scene of two vehicles with arms refuses it
    try:
        if isinstance(value, bytes):
            value = value.decode("ascii")
        return double(value) if isinstance(value, str) else float(value)
    except (TypeError, ValueError, OverflowError):
        raise UserError(f"{quoted(value)} is not a number", f"column {name}") from None


def columns(values: Mapping[str, Any]) -> dict[str, Array]:
    """Return all values in base units as arrays of numbers that broadcast. Raises UserError."""
    arrays = {name: in_doubles(name, value) for name, value in in_base(values).items()}
    common_shape("columns", arrays)
    return arrays


def scene_columns(values: Mapping[str, Any]) -> tuple[dict[str, Array], Array | None]:
    """Return a scene's values of any kinds as arrays of numbers in base units, in the table's
    order, and the shares of the critical friction among MU, which is 0 there (NaN elsewhere; None
    without any). Raises UserError for an unknown name and for what is no number."""
    import numpy as np

    base_values = in_base(values)
    unknown = [name for name in base_values if name not in SCENE]
    if unknown:
        raise UserError(
            f"{unknown[0]!r} is not a scene name; expected {' '.join(SCENE)} "
            "(impact88.solve_frame takes further columns)"
        )
    shares = _shares_in(base_values.get("MU"))
    if shares is not None:
        mu = np.where(np.isnan(shares), np.asarray(base_values["MU"], object), 0.0)
        base_values = {**base_values, "MU": mu}
    return {
        name: in_doubles(name, base_values[name]) for name in SCENE if name in base_values
    }, shares


def _shares_in(mu: Any) -> Array | None:
    """Return the fractions that cells of MU are of the critical friction, NaN for all others; None
    without any."""
    import numpy as np

    kind = getattr(getattr(mu, "dtype", None), "kind", "f")
    if not isinstance(mu, str | list | tuple) and kind not in "OUS":
        return None
    cells = np.asarray(mu, object)
    shares = np.array([share_of(cell) for cell in cells.ravel()], np.float64)
    return None if np.isnan(shares).all() else shares.reshape(cells.shape)


def common_shape(what: str, arrays: Mapping[str, Array]) -> tuple[int, ...]:
    """Return the shape that arrays broadcast to; ``what`` they are called. Raises UserError."""
    import numpy as np

    try:
        return np.broadcast_shapes(*{array.shape for array in arrays.values()})
    except ValueError:
        shapes = ", ".join(f"{name} {a.shape}" for name, a in arrays.items() if a.ndim)
        raise UserError(f"the {what}' shapes do not broadcast together: {shapes}") from None


def within_limits(values: Mapping[str, Any]) -> dict[str, Uncertain]:
    """Return every value as an `Uncertain`: from an `Uncertain`, a number, or the text of a number
    or range. Raises UserError."""
    import numpy as np

    from .uncertain import Uncertain, fixed_value, read

    def converted(name: str, value: Any, factor: float) -> Any:
        is_uncertain = isinstance(value, Uncertain)
        return value.over(factor) if is_uncertain else _number_in_base(name, value, factor)

    base_values, units = _in_base(values, converted)

    def to_uncertain(name: str, value: Any) -> Uncertain:
        if isinstance(value, Uncertain):
            return value
        if isinstance(value, str):
            return read(value, name, units=units)
        number = in_doubles(name, value)
        if np.ndim(number):
            raise UserError(f"{name} is an array; expected one number or range")
        return fixed_value(float(number))

    return {name: to_uncertain(name, value) for name, value in base_values.items()}


def texts(values: Mapping[str, Any]) -> dict[str, str]:
    """Return every value as a text in base units; numbers by their shortest text. Raises
    UserError."""
    check_mapping(values)
    as_texts = {n: v if isinstance(v, str) else shortest_text(n, v) for n, v in values.items()}
    return Case(as_texts, "values").values


def shortest_text(name: str, value: Any) -> str:
    """Return the shortest text that reads as a number. Raises UserError."""
    import numpy as np

    number = in_doubles(name, value)
    if np.ndim(number) or not np.isfinite(number):
        raise UserError(f"{name} is {quoted(value)}; expected one finite number")
    return digits(float(number))
