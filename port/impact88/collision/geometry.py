"""Where and how two vehicles touch: lever arms and inverse inertias, over arrays.

The contact plane makes the angle Γ with the y axis; n = (cos Γ, sin Γ) is normal to it, t =
(-sin Γ, cos Γ) lies in it. The contact point is at (-d4, -d3) from A's center of gravity and at
(d2, d1) from B's, so A is on the +n side. The impulse (P_n, P_t) and moment impulse M act on A,
their opposites on B. Masses appear inverted only: a rigid barrier is nothing special.

DA PA and DB PB are the contact point's polar coordinates in each vehicle, from its front: B's
contact point lies at the angle θ_b + φ_b from its center of gravity, so B faces θ_b; A's lies at
θ_a + φ_a + 180°, so A faces θ_a + 180°. One point has four numbers there, so a move of it changes
all four together: varied apart they tear it in two.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import wraps
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..errors import BEYOND_DOUBLES, UserError
from .case import OWN_AXES
from .degrees import sin_cos as real_sin_cos
from .doubles import double

Array = NDArray[Any]
P = ParamSpec("P")
R = TypeVar("R")

GEOMETRY = ("DA", "DB", "GA", "PA", "PB", "TA", "TB", "MA", "MB", "IA", "IB")
"""The values of a scene that make its geometry; M (6 or 4) is optional."""
_POINT_MASS = dict.fromkeys(GEOMETRY[:2] + GEOMETRY[3:7], 0.0) | {"IA": 1.0, "IB": 1.0}
"""What a point mass does not look at, and may be left out where M is 4 throughout."""


def within_doubles(function: Callable[P, R]) -> Callable[P, R]:
    """``function`` without numpy's warnings: what lies beyond the range of doubles is said in words
    at the end. A matrix that is not finite, and so has no decomposition, is a UserError."""

    @wraps(function)
    def quiet(*arguments: P.args, **options: P.kwargs) -> R:
        with np.errstate(all="ignore"):
            try:
                return function(*arguments, **options)
            except np.linalg.LinAlgError:
                raise UserError(BEYOND_DOUBLES) from None

    return quiet


def _numbers(value: Any) -> Array:
    """Doubles; complex ones stay, whose imaginary part carries a derivative (`adjustment`)."""
    array = np.asarray(value)
    return array if np.iscomplexobj(array) else array.astype(np.float64, copy=False)


def sin_cos(degrees: Any) -> tuple[Array, Array]:
    """Sine and cosine of angles in degrees, derivatives too where they are complex."""
    degrees = np.asarray(degrees)
    if not np.iscomplexobj(degrees):
        return real_sin_cos(degrees)
    sine, cosine = real_sin_cos(degrees.real)
    turn = 1j * np.radians(degrees.imag)
    return sine + turn * cosine, cosine - turn * sine


def with_point_masses(columns: Mapping[str, Any]) -> dict[str, Any]:
    """``columns`` with what point masses may leave out, where they are (M = 4 throughout)."""
    m = np.asarray(columns.get("M", 6), np.float64)
    return {**(_POINT_MASS if m.size and (m == 4).all() else {}), **columns}


class Geometry:
    """Of scenes given by name (`GEOMETRY`, and M where not 6), angles in degrees, as arrays that
    broadcast: ``cosine`` and ``sine`` of Γ; ``d1`` ... ``d4`` as in listing line 330; ``an`` ``at``
    ``bn`` ``bt``: the spins' shares in the normal and tangential velocity of A minus B at the
    contact point; ``inverse_mass``: R = 1/m_a + 1/m_b, ``inverse_spin_inertia``: 1/Ī = 1/I_a +
    1/I_b; ``point``: point masses (M = 4: no lever arms, nothing turns them)."""

    def __init__(self, columns: Mapping[str, Any]) -> None:
        columns = with_point_masses(columns)
        value = {name: _numbers(columns[name]) for name in GEOMETRY}
        self.point = np.asarray(columns.get("M", 6), np.float64) == 4
        self.sine, self.cosine = sin_cos(value["GA"])
        sine_a, cosine_a = sin_cos(value["TA"] + value["PA"])
        sine_b, cosine_b = sin_cos(value["TB"] + value["PB"])
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
        """Relative normal, tangential and angular velocity, A minus B, at the contact point; of UX
        UY WA VX VY WB or the final velocities in that order."""
        ux, uy, wa, vx, vy, wb = velocities
        dx, dy, c, s = ux - vx, uy - vy, self.cosine, self.sine
        normal = c * dx + s * dy + self.an * wa + self.bn * wb
        return normal, c * dy - s * dx + self.at * wa + self.bt * wb, wa - wb

    def changes(self, pn: Any, pt: Any, moment: Any) -> list[Array]:
        """The changes of the six velocities an impulse makes: the transpose of `relative`'s map,
        times the inverse inertias."""
        x, y = self.cosine * pn - self.sine * pt, self.sine * pn + self.cosine * pt
        on_a, on_b = self.an * pn + self.at * pt + moment, self.bn * pn + self.bt * pt - moment
        a, b = self.inverse_ma, self.inverse_mb
        return [a * x, a * y, self.inverse_ia * on_a, -b * x, -b * y, self.inverse_ib * on_b]


# -- in a vehicle's own axes

MOVES = ("CX", "CY")
"""How far the contact point moves along the scene's x and y."""


def facing(vehicle: str, theta: Any) -> Any:
    """The direction (degrees from the x axis) a vehicle's front points to."""
    return np.asarray(theta) + (180.0 if vehicle == "A" else 0.0)


def clock(pdof: float) -> str:
    """A PDOF as the nearest hour of the clock: 12 o'clock is the front, 3 o'clock the right."""
    return f"{round(pdof / 30) % 12 or 12} o'clock"


def placed(names: Iterable[str], given: Iterable[str]) -> tuple[str, ...]:
    """``names`` with CAF CAL in place of DA PA, CBF CBL of DB PB, where those are ``given``."""
    own: dict[str, str] = {}
    for vehicle, axes in OWN_AXES.items():
        if set(axes) & set(given):
            own |= dict(zip((f"D{vehicle}", f"P{vehicle}"), axes, strict=True))
    return tuple(own.get(name, name) for name in names)


@within_doubles
def moved(values: Mapping[str, Any]) -> dict[str, Any]:
    """``values`` (a scene's geometry, numbers or arrays, with CX and CY, or CAF CAL CBF CBL) with
    DA PA DB PB of the contact point as it is moved, or given, and without those."""
    kept = dict(values)
    for vehicle, axes in OWN_AXES.items():
        if axes[0] in kept:
            forward, left = (np.asarray(kept.pop(name), np.float64) for name in axes)
            kept[f"D{vehicle}"] = np.hypot(forward, left)
            kept[f"P{vehicle}"] = np.degrees(np.arctan2(left, forward))
    if not set(MOVES) & set(kept):
        return kept
    values, kept = kept, {name: value for name, value in kept.items() if name not in MOVES}
    dx, dy = (np.asarray(values.get(name, 0.0), np.float64) for name in MOVES)
    for vehicle, sign in (("A", -1.0), ("B", 1.0)):
        heading = np.asarray(values[f"T{vehicle}"], np.float64)
        distance = np.asarray(values[f"D{vehicle}"], np.float64)
        angle = np.radians(heading + values[f"P{vehicle}"])
        # A's polar coordinates point from the contact point to its center of gravity
        x = distance * np.cos(angle) + sign * dx
        y = distance * np.sin(angle) + sign * dy
        kept[f"D{vehicle}"] = np.hypot(x, y)
        kept[f"P{vehicle}"] = np.degrees(np.arctan2(y, x)) - heading
    return kept


def moved_texts(texts: Mapping[str, str], dx: float, dy: float) -> dict[str, str]:
    """What a move of the contact point changes in a scene's texts: DA PA DB PB. Raises UserError
    where a number of it lies beyond the range of doubles."""
    names = [kind + vehicle for vehicle in "AB" for kind in "DPT"]
    values = moved({**{name: double(texts[name]) for name in names}, "CX": dx, "CY": dy})
    changed = {name: float(values[name]) for name in ("DA", "PA", "DB", "PB")}
    for name, value in changed.items():
        if not math.isfinite(value):
            raise UserError(
                f"the contact point cannot be moved: {name} would be {value}; expected numbers "
                "within the range of doubles"
            )
    return {name: repr(value).upper() for name, value in changed.items()}
