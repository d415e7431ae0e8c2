"""Where and how two vehicles touch: lever arms and inverse inertias, over arrays.

The contact plane makes the angle Γ with the y axis; n = (cos Γ, sin Γ) is normal to it, t =
(-sin Γ, cos Γ) lies in it. The contact point is at (-d4, -d3) from A's center of gravity and at
(d2, d1) from B's, so A is on the +n side. The impulse (P_n, P_t) and moment impulse M act on A,
their opposites on B. Masses appear inverted only: a rigid barrier is nothing special.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..closedform.degrees import sin_cos as real_sin_cos

Array = NDArray[Any]

NAMES = ("DA", "DB", "GA", "PA", "PB", "TA", "TB", "MA", "MB", "IA", "IB")
"""The values of a scene that make its geometry; M (6 or 4) is optional."""
_POINT_MASS = dict.fromkeys(NAMES[:2] + NAMES[3:7], 0.0) | {"IA": 1.0, "IB": 1.0}
"""What a point mass does not look at, and may be left out where M is 4 throughout."""


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


@dataclass(frozen=True)
class Geometry:
    """Of scenes, as arrays that broadcast: ``cosine`` and ``sine`` of Γ; ``d1`` ... ``d4`` as in
    listing line 330; ``point``: point masses (M = 4: no lever arms, nothing turns them)."""

    cosine: Array
    sine: Array
    d1: Array
    d2: Array
    d3: Array
    d4: Array
    inverse_ma: Array
    inverse_mb: Array
    inverse_ia: Array
    inverse_ib: Array
    point: NDArray[np.bool_]

    @classmethod
    def of(cls, columns: Mapping[str, Any]) -> Geometry:
        """Of scenes given by name (`NAMES`, and M where not 6), angles in degrees."""
        columns = with_point_masses(columns)
        value = {name: _numbers(columns[name]) for name in NAMES}
        point = np.asarray(columns.get("M", 6), np.float64) == 4
        sine, cosine = sin_cos(value["GA"])
        sine_a, cosine_a = sin_cos(value["TA"] + value["PA"])
        sine_b, cosine_b = sin_cos(value["TB"] + value["PB"])
        da, db = np.where(point, 0.0, value["DA"]), np.where(point, 0.0, value["DB"])
        with np.errstate(divide="ignore"):
            ma, mb, ia, ib = (1 / value[name] for name in ("MA", "MB", "IA", "IB"))
        d1, d2, d3, d4 = db * sine_b, db * cosine_b, da * sine_a, da * cosine_a
        return cls(cosine, sine, d1, d2, d3, d4, ma, mb, ia, ib, point)

    @cached_property
    def an(self) -> Any:
        """Normal lever arm of A: the spin's share in the contact point's normal velocity."""
        return self.d3 * self.cosine - self.d4 * self.sine

    @cached_property
    def at(self) -> Any:
        return -(self.d4 * self.cosine + self.d3 * self.sine)

    @cached_property
    def bn(self) -> Any:
        """Normal lever arm of B, with the sign it has in the *relative* velocity A minus B."""
        return self.d1 * self.cosine - self.d2 * self.sine

    @cached_property
    def bt(self) -> Any:
        return -(self.d2 * self.cosine + self.d1 * self.sine)

    @property
    def inverse_mass(self) -> Any:
        """R = 1/m_a + 1/m_b."""
        return self.inverse_ma + self.inverse_mb

    @property
    def inverse_spin_inertia(self) -> Any:
        """1/Ī = 1/I_a + 1/I_b."""
        return self.inverse_ia + self.inverse_ib

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

    def contact_point(self) -> dict[str, Array]:
        """The contact point from each center of gravity, along the scene's x and y."""
        return {"CAX": -self.d4, "CAY": -self.d3, "CBX": self.d2, "CBY": self.d1}
