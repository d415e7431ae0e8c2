"""Geometry of the contact: lever arms and inverse inertias of two vehicles, over arrays.

The contact plane makes the angle Γ with the y axis; n = (cos Γ, sin Γ) is normal to it, t =
(-sin Γ, cos Γ) lies in it. The contact point is at (-d4, -d3) from A's center of gravity and at
(d2, d1) from B's, so A is on the +n side. The impulse (P_n, P_t) and moment impulse M act on A,
their opposites on B. Masses appear only as inverses, so a rigid barrier needs no special case.

DA PA and DB PB are the contact point's polar coordinates in each vehicle, from its front: B's
contact point lies at the angle θ_b + φ_b from its center of gravity, so B faces θ_b; A's lies at
θ_a + φ_a + 180°, so A faces θ_a + 180°. The one contact point
has four coordinates there, so moving it changes all four: varied independently they would describe
two different points.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import wraps
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..errors import BEYOND_DOUBLES, UserError
from .case import OWN_AXES
from .degrees import sin_cos
from .doubles import double

Array = NDArray[Any]
P = ParamSpec("P")
R = TypeVar("R")

GEOMETRY = ("DA", "DB", "GA", "PA", "PB", "TA", "TB", "MA", "MB", "IA", "IB")
"""The values of a scene that define its geometry; M (6 or 4) is optional."""
ARMS = ("DA", "PA", "TA", "IA", "DB", "PB", "TB", "IB")
"""Inputs that an impact needs beyond masses and GA for spins and moments; without one of them its
vehicles are point masses."""
_STAND_INS = dict.fromkeys(GEOMETRY, 0.0) | {"IA": 1.0, "IB": 1.0}
"""Numbers in place of what is not given. No result that is returned depends on them
(`mechanics.uses`)."""


def within_doubles(function: Callable[P, R]) -> Callable[P, R]:
    """Return ``function`` with numpy's warnings silenced and LinAlgError turned into UserError.

    Callers check results for values beyond the range of doubles; only a matrix that is not finite,
    and so has no decomposition, fails here."""

    @wraps(function)
    def call_within(*arguments: P.args, **options: P.kwargs) -> R:
        with np.errstate(all="ignore"):
            try:
                return function(*arguments, **options)
            except np.linalg.LinAlgError:
                raise UserError(BEYOND_DOUBLES) from None

    return call_within


def _numbers(value: Any) -> Array:
    """Return values as float64; complex ones, which carry a derivative, are kept (`adjustment`)."""
    array = np.asarray(value)
    return array if np.iscomplexobj(array) else array.astype(np.float64, copy=False)


def sin_cos_with_slopes(degrees: Any) -> tuple[Array, Array]:
    """Return sine and cosine of angles in degrees; of complex ones with their derivatives."""
    degrees = np.asarray(degrees)
    if not np.iscomplexobj(degrees):
        return sin_cos(degrees)
    sine, cosine = sin_cos(degrees.real)
    turn = 1j * np.radians(degrees.imag)
    return sine + turn * cosine, cosine - turn * sine


class Geometry:
    """Contact geometry of scenes, as arrays that broadcast.

    Parameters
    ----------
    columns : mapping of str to array_like
        Those values named in `GEOMETRY` that are given, MA and MB among them, angles in degrees,
        and M (default 6).

    Attributes
    ----------
    cosine, sine : ndarray
        Of Γ, the angle of the contact plane.
    d1, d2, d3, d4 : ndarray
        Lever arms along x and y, as in listing line 330.
    an, at, bn, bt : ndarray
        Coefficients of the spins of A and B in the normal and tangential velocity of A minus B at
        the contact point: v_n = ... + an ω_a + bn ω_b, v_t = ... + at ω_a + bt ω_b.
    inverse_ma, inverse_mb, inverse_ia, inverse_ib : ndarray
        1/m_a, 1/m_b, 1/I_a, 1/I_b.
    inverse_mass : ndarray
        R = 1/m_a + 1/m_b.
    inverse_spin_inertia : ndarray
        1/Ī = 1/I_a + 1/I_b.
    point : ndarray of bool
        True for point masses (M = 4, or a value of `ARMS` is not given), which have no lever arms
        and do not turn.
    absent : frozenset of str
        Names that are not given. Numbers stand in for them; see `mechanics.uses`.
    """

    def __init__(self, columns: Mapping[str, Any]) -> None:
        self.absent = frozenset(name for name in GEOMETRY if name not in columns)
        value = {name: _numbers(columns.get(name, _STAND_INS[name])) for name in GEOMETRY}
        self.point = np.asarray(columns.get("M", 6), np.float64) == 4
        if not self.absent.isdisjoint(ARMS):
            self.point = np.ones_like(self.point)
        for name in ("TA", "TB"):  # a point mass may face the way it travels, `state.COURSE`
            value[name] = np.where(self.point, 0.0, value[name])
        self.sine, self.cosine = sin_cos_with_slopes(value["GA"])
        sine_a, cosine_a = sin_cos_with_slopes(value["TA"] + value["PA"])
        sine_b, cosine_b = sin_cos_with_slopes(value["TB"] + value["PB"])
        da, db = (np.where(self.point, 0.0, value[name]) for name in ("DA", "DB"))
        self.d1, self.d2, self.d3, self.d4 = db * sine_b, db * cosine_b, da * sine_a, da * cosine_a
        self.inverse_ma, self.inverse_mb = 1 / value["MA"], 1 / value["MB"]
        self.inverse_ia, self.inverse_ib = 1 / value["IA"], 1 / value["IB"]
        self.inverse_mass = self.inverse_ma + self.inverse_mb
        self.inverse_spin_inertia = self.inverse_ia + self.inverse_ib
        self.an = self.d3 * self.cosine - self.d4 * self.sine
        self.at = -(self.d4 * self.cosine + self.d3 * self.sine)
        self.bn = self.d1 * self.cosine - self.d2 * self.sine
        self.bt = -(self.d2 * self.cosine + self.d1 * self.sine)

    def relative(self, velocities: Sequence[Any]) -> tuple[Array, Array, Array]:
        """Return normal, tangential and angular velocity of A minus B at the contact point.

        ``velocities``: UX UY WA VX VY WB, or the final ones in that order."""
        ux, uy, wa, vx, vy, wb = velocities
        dx, dy, c, s = ux - vx, uy - vy, self.cosine, self.sine
        normal = c * dx + s * dy + self.an * wa + self.bn * wb
        return normal, c * dy - s * dx + self.at * wa + self.bt * wb, wa - wb

    def changes(self, pn: Any, pt: Any, moment: Any) -> list[Array]:
        """Return the changes of the six velocities due to an impulse on A and its opposite on B:
        the transpose of the map in `relative`, times the inverse inertias."""
        x, y = self.cosine * pn - self.sine * pt, self.sine * pn + self.cosine * pt
        on_a, on_b = self.an * pn + self.at * pt + moment, self.bn * pn + self.bt * pt - moment
        a, b = self.inverse_ma, self.inverse_mb
        return [a * x, a * y, self.inverse_ia * on_a, -b * x, -b * y, self.inverse_ib * on_b]


# -- in a vehicle's own axes

MOVES = ("CX", "CY")
"""Displacements of the contact point along the scene's x and y."""


def facing(vehicle: str, theta: Any) -> Any:
    """Return the direction of a vehicle's front, in degrees from the x axis."""
    return np.asarray(theta) + (180.0 if vehicle == "A" else 0.0)


def clock(pdof: float) -> str:
    """Return a PDOF as the nearest clock hour: 12 o'clock is the front, 3 o'clock the right."""
    return f"{round(pdof / 30) % 12 or 12} o'clock"


def coordinate_names(names: Iterable[str], present: Iterable[str]) -> tuple[str, ...]:
    """Return ``names`` with CAF CAL in place of DA PA, CBF CBL of DB PB, where those are
    ``present``."""
    replacements: dict[str, str] = {}
    for vehicle, axes in OWN_AXES.items():
        if set(axes) & set(present):
            replacements |= dict(zip((f"D{vehicle}", f"P{vehicle}"), axes, strict=True))
    return tuple(replacements.get(name, name) for name in names)


@within_doubles
def resolve_contact_point(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return ``values`` with CAF CAL CBF CBL and CX CY replaced by the DA PA DB PB they give.

    ``values``: a scene's geometry, numbers or arrays. A vehicle's own coordinates (CAF forward, CAL
    to the left) become polar ones, then the point is moved by CX and CY along the scene's axes."""
    result = dict(values)
    for vehicle, axes in OWN_AXES.items():
        if axes[0] in result:
            forward, leftward = (np.asarray(result.pop(name), np.float64) for name in axes)
            result[f"D{vehicle}"] = np.hypot(forward, leftward)
            result[f"P{vehicle}"] = np.degrees(np.arctan2(leftward, forward))
    if not set(MOVES) & set(result):
        return result
    values, result = result, {name: value for name, value in result.items() if name not in MOVES}
    dx, dy = (np.asarray(values.get(name, 0.0), np.float64) for name in MOVES)
    for vehicle, sign in (("A", -1.0), ("B", 1.0)):
        heading = np.asarray(values[f"T{vehicle}"], np.float64)
        distance = np.asarray(values[f"D{vehicle}"], np.float64)
        sine, cosine = sin_cos(heading + values[f"P{vehicle}"])
        # A's polar coordinates point from the contact point to its center of gravity
        x, y = distance * cosine + sign * dx, distance * sine + sign * dy
        result[f"D{vehicle}"] = np.hypot(x, y)
        result[f"P{vehicle}"] = np.degrees(np.arctan2(y, x)) - heading
    return result


def moved_texts(texts: Mapping[str, str], dx: float, dy: float) -> dict[str, str]:
    """Return the texts of DA PA DB PB after moving the contact point by ``dx``, ``dy``. Raises
    UserError if one of them lies beyond the range of doubles."""
    names = [kind + vehicle for vehicle in "AB" for kind in "DPT"]
    values = resolve_contact_point(
        {**{name: double(texts[name]) for name in names}, "CX": dx, "CY": dy}
    )
    polar = {name: float(values[name]) for name in ("DA", "PA", "DB", "PB")}
    for name, value in polar.items():
        if not math.isfinite(value):
            raise UserError(
                f"the contact point cannot be moved: {name} would be {value}; expected numbers "
                "within the range of doubles"
            )
    return {name: repr(value).upper() for name, value in polar.items()}
