"""Values known within limits: their notation, and random draws from them.

Any value of a scene for ``impact88 bounds`` may be one of these texts:

    0.911                             known: a single value
    0.7 .. 0.9                        between two values, none preferred
    0.8 +- 0.1    143.5 +- 5%         the same, by middle and half width (± will do for +-)
    +- 0.1        +- 5%               the same, around the value in the scene file
    uniform 0.7 0.9                   the same as 0.7 .. 0.9
    triangular 0.7 0.75 0.9           lower limit, most likely value, upper limit
    normal 0.8 0.05                   mean and standard deviation
    normal 0.8 0.05 within 0.7 .. 1   the same, cut off at limits

Correlated values are drawn through a Gaussian copula: the correlation ρ is that of the underlying
normal variates (the rank correlation is then 6/π·asin(ρ/2)).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from numbers import Real
from typing import TYPE_CHECKING

from ..errors import UserError, quoted
from .case import FACING_COURSE
from .doubles import double, is_number
from .units import ACCEPTED, NO_SKID, SKID, gravity_in, parse, system_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

KINDS = ("fixed", "uniform", "triangular", "normal")


@dataclass(frozen=True, slots=True)
class Uncertain:
    """A value known within limits, in the unit of the quantity it stands for.

    Parameters
    ----------
    kind : {"fixed", "uniform", "triangular", "normal"}
        Its distribution.
    nominal : float
        The middle, mode or mean.
    low, high : float
        Its limits; infinite for a normal without limits.
    deviation : float, default 0
        The standard deviation of a normal.
    share : bool, default False
        True if the numbers are fractions of the critical friction (MU = "85 %").
    critical : float, default 0
        The critical friction at the nominal values that turned such fractions into numbers; the
        friction stays the same fraction of each impact's own critical friction.

    Raises
    ------
    UserError
        For another kind, what is no number, limits in the wrong order, or a deviation below 0.

    Examples
    --------
    >>> impact88.Uncertain("uniform", 0.8, 0.7, 0.9).varies
    True
    """

    kind: str
    nominal: float
    low: float
    high: float
    deviation: float = 0.0
    share: bool = False
    critical: float = 0.0

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise UserError(f"kind is {quoted(self.kind)}; expected one of {' '.join(KINDS)}")
        if self.kind == "fixed":
            return  # may be a column
        for name in ("nominal", "low", "high", "deviation"):
            if not isinstance(number := getattr(self, name), Real):
                raise UserError(f"{name} is {quoted(number)}; expected a number")
        if not self.low <= self.high:
            raise UserError(f"low is {self.low} and high {self.high}; expected low <= high")
        if not self.deviation >= 0:
            raise UserError(f"deviation is {self.deviation}; expected 0 or more")

    def over(self, factor: float) -> Uncertain:
        """Return the value in another unit.

        Parameters
        ----------
        factor : float
            The size of that unit in the present one; all numbers are divided by it.

        Returns
        -------
        Uncertain
            The value in that unit.
        """
        nominal, low, high = (value / factor for value in (self.nominal, self.low, self.high))
        return replace(self, nominal=nominal, low=low, high=high, deviation=self.deviation / factor)

    @property
    def varies(self) -> bool:
        """True unless it is a single value."""
        return self.kind != "fixed"

    @property
    def standard_deviation(self) -> float:
        """Standard deviation; for a normal with limits, that without its limits."""
        if self.kind == "triangular":
            a, c, b = self.low, self.nominal, self.high
            return math.sqrt((a * a + b * b + c * c - a * b - a * c - b * c) / 18)
        return (self.high - self.low) / math.sqrt(12) if self.kind == "uniform" else self.deviation

    @property
    def tolerance(self) -> float:
        """Half of the range, or a normal's standard deviation."""
        return self.deviation if self.kind == "normal" else (self.high - self.low) / 2

    def limits(self, sigmas: float) -> tuple[float, float]:
        """Return lower and upper limit.

        Parameters
        ----------
        sigmas : float
            Cut-off for a normal, in standard deviations.

        Returns
        -------
        tuple of float
            Lower and upper limit.
        """
        if self.kind != "normal":
            return self.low, self.high
        reach = sigmas * self.deviation
        return max(self.low, self.nominal - reach), min(self.high, self.nominal + reach)

    def around(self, nominal: float) -> Uncertain:
        """Return the range with another nominal value.

        Parameters
        ----------
        nominal : float
            The nominal value.

        Returns
        -------
        Uncertain
            The same range around it, unchanged if ``nominal`` lies outside or this is no range.
        """
        if self.kind != "uniform" or not self.low <= nominal <= self.high:
            return self
        return replace(self, nominal=nominal)

    def quantile(self, share: float) -> float:
        """Return a quantile.

        Parameters
        ----------
        share : float
            Probability, 0 to 1.

        Returns
        -------
        float
            The value that is not exceeded with that probability.
        """
        if self.kind == "fixed" or (self.kind == "normal" and not self.deviation):
            return self.nominal
        if self.kind == "uniform":
            return self.low + share * (self.high - self.low)
        if self.kind == "triangular":
            width, rise = self.high - self.low, self.nominal - self.low
            if share * width <= rise:
                return self.low + math.sqrt(share * width * rise)
            return self.high - math.sqrt((1 - share) * width * (width - rise))
        from statistics import NormalDist  # 3 ms, for a scene without a normal

        normal = NormalDist(self.nominal, self.deviation)
        below, above = normal.cdf(self.low), normal.cdf(self.high)
        target = below + share * (above - below)
        if target <= 0.0 or target >= 1.0:
            return self.low if target <= 0.0 else self.high
        return min(max(normal.inv_cdf(target), self.low), self.high)

    def draws(self, rng: np.random.Generator, count: int) -> NDArray[np.float64]:
        """Return independent random values.

        Parameters
        ----------
        rng : numpy.random.Generator
            Source of random numbers.
        count : int
            Number of values.

        Returns
        -------
        ndarray of float
            The values.
        """
        import numpy as np

        if self.kind == "fixed":
            return np.full(count, self.nominal)
        if self.kind == "uniform":
            return rng.uniform(self.low, self.high, count)
        if self.kind == "triangular":
            return rng.triangular(self.low, self.nominal, self.high, count)
        return self.from_normal(rng.standard_normal(count))

    def log_density(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the log density of a triangular or normal within its limits, up to a constant.

        Parameters
        ----------
        values : ndarray of float
            Values within the limits.

        Returns
        -------
        ndarray of float
            The log density at each value.
        """
        import numpy as np

        off = values - self.nominal
        if self.kind == "normal":
            return -0.5 * np.square(off / self.deviation)
        with np.errstate(divide="ignore", invalid="ignore"):
            side = np.where(off > 0, self.high - self.nominal, self.nominal - self.low)
            return np.asarray(np.log(np.clip(1 - np.abs(off) / np.where(off == 0, 1, side), 0, 1)))

    def from_normal(self, variates: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the values that standard normal variates map to, quantile to quantile.

        Parameters
        ----------
        variates : ndarray of float
            Standard normal variates.

        Returns
        -------
        ndarray of float
            The value at the same quantile as each variate.

        Notes
        -----
        Values are interpolated in a table: the error, below 1e-6 of the spread, is a thousandth of
        what a million samples resolve.
        """
        import numpy as np

        if self.kind == "normal" and math.isinf(self.low) and math.isinf(self.high):
            return self.nominal + self.deviation * variates
        return np.clip(np.interp(variates, *_quantile_table(self)), self.low, self.high)


def random_numbers(seed: int, stream: int) -> np.random.Generator:
    """Return the random generator of a seed and stream. Raises UserError for an invalid seed."""
    import numpy as np

    try:
        return np.random.default_rng([seed, stream])
    except (TypeError, ValueError):
        raise UserError(f"seed is {quoted(seed)}; expected a whole number, 0 or more") from None


@lru_cache(maxsize=64)
def _quantile_table(item: Uncertain) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return standard normal variates and the values at the same quantiles."""
    from statistics import NormalDist

    import numpy as np

    # normal variates beyond 8.3 standard deviations occur once in 1e16
    places = np.linspace(-8.3, 8.3, 8193)
    standard = NormalDist()
    return places, np.array([item.quantile(standard.cdf(place)) for place in places.tolist()])


def columns_of(
    limits: Mapping[str, tuple[float, float]], u: NDArray[np.float64]
) -> dict[str, NDArray[np.float64]]:
    """Return points of the unit cube, shape (n, k), as k columns of values, exact at the limits."""
    import numpy as np

    return {
        name: np.where(share < 1, low + share * (high - low), high)
        for share, (name, (low, high)) in zip(u.T, limits.items(), strict=True)
    }


def fixed_value(value: float) -> Uncertain:
    """Return a single value as an `Uncertain`."""
    return Uncertain("fixed", value, value, value)


def read(text: str, name: str, center: float | None = None, units: str | None = None) -> Uncertain:
    """Return the value that ``text`` gives the quantity ``name``, in the notation above.

    ``center``: the value around which ``+- D`` is taken, and a range's nominal value if it lies
    inside; ``units``: the system of the numbers, which a `skid` needs. Raises UserError for any
    other text, limits in the wrong order, or a number too large.
    """
    if text.strip() == FACING_COURSE and name.endswith(("TA", "TB")):
        return fixed_value(math.nan)
    if text.lstrip().startswith("skid") and name.endswith(("SAF", "SBF")):
        return skid(text, name, units)
    try:
        if is_number(text):
            text = text.replace(" ", "")  # INPUT reads "1 0" as 10
        kind, amounts, share, _ = parse(text)
        numbers = [double(a.sign + a.parts[0][0]) for a in amounts if a]
    except ValueError:
        raise UserError(f"{text!r} is not an amount; {ACCEPTED}", name) from None
    units_in_text = {unit for a in amounts if a for unit in a.units}
    shares = units_in_text == {"%"} and name.endswith("MU")
    if shares:
        numbers = [numbers[0] / 100, *(x if share else x / 100 for x in numbers[1:])]
    elif any(a and (a.units or len(a.parts) > 1) for a in amounts):
        raise UserError(f"{text!r} has a unit, and is not in base units", name)
    if not all(map(math.isfinite, numbers)):
        raise UserError(f"{text!r} has a number too large", name)
    if kind == "fixed":
        return replace(fixed_value(numbers[0]), share=shares)
    value = replace(_of_kind(kind, numbers, center, share, text, name), share=shares)
    return value if center is None or shares else value.around(center)


NEARLY_UNIFORM = 0.9
"""Part of a uniform's standard deviation from which a skid of two ranges is one: that is then too
large by 11 % at most, as a normal within the same limits would be too small by 14 %."""
GREATEST_DRAG = 1.2
"""Friction of tires on a dry road from which a skid is remarked upon: measured is .5 to 1."""


def skid(text: str, name: str, units: str | None) -> Uncertain:
    """Return the speed v = √(2 μ g d) at the start of a skid to rest, from a text "skid D at MU".

    D and MU may be ranges, which are independent: the speed of two is a normal within the limits of
    both, or uniform where one of them decides. ``units``: the system D is in. Raises UserError."""
    match, gravity = SKID.fullmatch(" ".join(text.split())), gravity_in(system_of(units))
    if match is None:
        raise UserError(f"{text!r} {NO_SKID}", name)
    if gravity is None:
        raise UserError(f"{text!r} needs units; expected such as 'skid 62 ft at 0.7'", name)
    parts = [read(part, name) for part in match.groups()]
    if not all(min(part.nominal, part.limits(3.0)[0]) > 0 for part in parts):
        raise UserError(f"{text!r}: distance and friction must be positive", name)

    def speed(values: Sequence[float]) -> float:
        return math.sqrt(2 * gravity * values[0] * values[1])

    nominal = speed([part.nominal for part in parts])
    varying = [part for part in parts if part.varies]
    if not varying:
        return fixed_value(nominal)
    low, high = (speed([part.limits(3.0)[end] for part in parts]) for end in (0, 1))
    if len(varying) == 1 and varying[0].kind != "normal":
        return Uncertain(varying[0].kind, nominal, low, high)
    shares = [part.standard_deviation / part.nominal for part in varying]
    deviation = nominal / 2 * math.hypot(*shares)
    uniform = Uncertain("uniform", nominal, low, high)
    if deviation > NEARLY_UNIFORM * uniform.standard_deviation:
        return uniform
    return Uncertain("normal", nominal, low, high, deviation)


def skid_remarks(texts: Mapping[str, str]) -> list[str]:
    """Return remarks on skids: one on friction that no road has, and one where two skids have a
    range of friction each: they are taken as independent."""
    matches = {n: SKID.fullmatch(" ".join(texts.get(n, "").split())) for n in ("SAF", "SBF")}
    friction = {name: read(match[2], "MU") for name, match in matches.items() if match}
    remarks = [
        f"{name}: a skid at {value.nominal:g} is from friction above {GREATEST_DRAG:g}; tires on a "
        "dry road have .5 to 1"
        for name, value in friction.items()
        if value.nominal > GREATEST_DRAG
    ]
    if len(friction) == 2 and all(value.varies for value in friction.values()):
        remarks.append(
            "the friction of the two skids (SAF, SBF) is taken as independent; on one road both "
            "err together, which the bounds hold and the 90 % do not"
        )
    return remarks


def _of_kind(
    kind: str, numbers: Sequence[float], center: float | None, share: bool, text: str, name: str
) -> Uncertain:
    """Return the value of a `parse`d text of ``kind``; ``text`` and ``name`` for messages."""
    deviation = 0.0
    if kind == "around":
        middle = numbers[0] if len(numbers) == 2 else center
        if middle is None:
            raise UserError(f"{text!r} has no middle: the scene gives {name} no single value", name)
        half = numbers[-1] * (abs(middle) / 100 if share else 1)
        if half < 0:
            raise UserError(f"{text!r} has a negative half width", name)
        kind, low, nominal, high = "uniform", middle - half, middle, middle + half
    elif kind == "triangular":
        low, nominal, high = numbers
    elif kind == "normal":
        nominal, deviation = numbers[:2]
        low, high = numbers[2:] or (-math.inf, math.inf)
        if deviation < 0:
            raise UserError(f"{text!r} has a negative standard deviation", name)
        if not low <= nominal <= high:
            raise UserError(f"{text!r} has its mean outside its limits", name)
        low, high = (low, high) if deviation else (nominal, nominal)
    else:
        kind, (low, high) = "uniform", numbers
        nominal = low + (high - low) / 2
    if kind != "normal" and not math.isfinite(high - low):
        raise UserError(f"{text!r} is wider than the range of doubles", name)
    if not low <= nominal <= high:
        raise UserError(f"{text!r} is out of order; expected the lower limit first", name)
    return Uncertain(kind, nominal, low, high, deviation) if low < high else fixed_value(nominal)


def correlation_root(
    pairs: Mapping[tuple[str, str], float], inputs: Mapping[str, Uncertain]
) -> tuple[list[str], NDArray[np.float64]]:
    """Return the n correlated names and an n by n root R of their correlation matrix.

    ``variates @ root`` correlates rows of independent standard normal variates (Rᵀ R = C). Raises
    UserError for a name that does not vary, a correlation outside -1 ... 1, two values for one
    pair, and contradicting correlations (C is not positive semidefinite)."""
    import numpy as np

    correlations: dict[frozenset[str], float] = {}
    for (first, second), value in pairs.items():
        place = f"correlation {first},{second}"
        for name in (first, second):
            if name not in inputs or not inputs[name].varies:
                varying = " ".join(key for key, item in inputs.items() if item.varies) or "none"
                raise UserError(f"{name} does not vary; those that do: {varying}", place)
        if first == second:
            raise UserError("a value's correlation with itself is 1 and cannot be given", place)
        if not -1 <= value <= 1:
            raise UserError(f"{value:g} is not a correlation; expected -1 ... 1", place)
        if correlations.setdefault(frozenset((first, second)), value) != value:
            raise UserError("is given twice, with different values", place)
    names = [name for name in inputs if any(name in pair for pair in correlations)]
    matrix = np.eye(len(names))
    for pair, value in correlations.items():
        row, column = (names.index(name) for name in pair)
        matrix[row, column] = matrix[column, row] = value
    eigenvalues, vectors = np.linalg.eigh(matrix)
    if len(names) and eigenvalues[0] < -1e-12 * len(names):
        raise UserError(
            f"the correlations of {', '.join(names)} contradict one another: their matrix is not "
            f"positive definite (smallest eigenvalue {eigenvalues[0]:.3g}); expected weaker ones"
        )
    return names, (vectors * np.sqrt(np.maximum(eigenvalues, 0.0))) @ vectors.T
