"""Running error bound of the listing's arithmetic, scene by scene.

`Bounded` numbers carry, beside a double, how far the 1988 program's number may be from the exact
one: what its operands are off, and what the operation rounds, always at their worst. Lines 300 to
560 and 1000 to 1170 are done in them (`elimination`), so the bound knows what the listing's choice
of unknowns and its pivots without scaling do. It is of first order and supposes that the pivots
chosen are those a double finds. On 10^5 scenes of each of the benchmark's populations that can be
typed no error was above it; it is a thousand times the error of a usual scene.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from ...apple.applesoft.decimaltext import scan
from ...names import DEFAULT_M, FINAL_VELOCITIES, PIVOT
from .elimination import LISTING_PI, Terms, eliminate, listing_rows

UNIT = 2.0**-32
"""Unit roundoff of five-byte numbers: the largest relative change by rounding."""
PI_ERROR = abs(LISTING_PI / math.pi - 1)
SMALLEST_PIVOT = 1e-9
"""Line 1080's."""
WORST_DIVISOR = 0.25
"""Relative error of a divisor from which the first order says nothing; twice as much is unsafe."""
TWO_BYTES = 2.0**-16
"""A mantissa whose second and third byte are zero exceeds its top byte by less than this, in units
of that byte."""


class Uncertain(ArithmeticError):
    """A divisor, or the listing's test of it, is too uncertain for a bound."""


class Bounded:
    """A number ``v`` and how far the listing's may be off, ``e``."""

    __slots__ = ("e", "v")

    def __init__(self, v: float, e: float = 0.0) -> None:
        self.v = v
        self.e = e

    def __add__(self, other: Bounded) -> Bounded:
        v = self.v + other.v
        return Bounded(v, self.e + other.e + UNIT * (abs(self.v) + abs(v)))

    def __sub__(self, right: Bounded | int) -> Bounded:
        other = right if isinstance(right, Bounded) else Bounded(float(right))
        v = self.v - other.v
        return Bounded(v, self.e + other.e + UNIT * (abs(self.v) + abs(v)))

    def __mul__(self, other: Bounded) -> Bounded:
        v = self.v * other.v
        own = abs(self.v) * other.e + abs(other.v) * self.e + self.e * other.e
        defects = self.defect() + other.defect()
        return Bounded(v, own + (2 * UNIT + defects) * abs(v))

    def defect(self) -> float:
        """Return the relative loss of the ROM's multiplication when this number's
        second and third byte are zero: half of what the bytes below are worth."""
        if not self.v:
            return 0.0
        mantissa = math.frexp(self.v)[0]
        below = math.modf(abs(256 * mantissa))[0]
        unsure = 256 * self.e / abs(self.v)
        if below - unsure > TWO_BYTES:
            return 0.0
        return min(below + unsure, TWO_BYTES) / 256 / abs(mantissa)

    def __rmul__(self, other: int) -> Bounded:
        return Bounded(float(other)) * self

    def __rsub__(self, other: int) -> Bounded:
        return Bounded(float(other)) - self

    def __truediv__(self, other: Bounded) -> Bounded:
        if not other.e < WORST_DIVISOR * abs(other.v):
            raise Uncertain
        v = self.v / other.v
        e = (self.e + abs(v) * other.e) / (abs(other.v) - other.e)
        return Bounded(v, e + 3 * UNIT * abs(v))

    def __neg__(self) -> Bounded:
        return Bounded(-self.v, self.e)

    def __abs__(self) -> Bounded:
        return Bounded(abs(self.v), self.e)

    def __gt__(self, other: Bounded) -> bool:
        return self.v > other.v

    def __lt__(self, other: Bounded) -> bool:
        return self.v < other.v


class _Terms(Terms):
    """A scene's numbers. Raises `Uncertain` where the listing may take another line."""

    def __init__(self, scene: Mapping[str, str]) -> None:
        g = {name: _read(text) for name, text in scene.items()}
        point = g["M"].v == 4 if "M" in g else float(DEFAULT_M) == 4
        if point and any(g[d].v and g[w].v for d, w in (("DA", "WA"), ("DB", "WB"))):
            raise Uncertain  # line 340 turns point masses all the same
        super().__init__(g, point, g["MU"].v == PIVOT, Bounded(0.0))
        if not self.pivot and g["MU"].v and not self.gt.e < abs(self.gt.v):
            raise Uncertain  # line 400 may turn MU, or not
        if not self.pivot and min(g["MU"].v, self.mu.v) - self.mu.e <= PIVOT:
            raise Uncertain  # line 390 or 510 takes it for a pivot's

    def turn(self, *degrees: Bounded) -> tuple[Bounded, Bounded]:
        """Line 300 makes radians of each angle with a pi of nine digits; SIN takes its argument as
        a part of a turn, and is off by six units beside."""
        radian = LISTING_PI / 180
        angle = sum(x.v for x in degrees) * radian
        off = sum(x.e + (PI_ERROR + 5 * UNIT) * abs(x.v) for x in degrees) * radian
        off += 4 * UNIT * (abs(angle) + 2) + 6 * UNIT
        exact = math.radians(math.fmod(sum(x.v for x in degrees), 360.0))
        return Bounded(math.sin(exact), off), Bounded(math.cos(exact), off)


def _read(text: str) -> Bounded:
    """A value as the listing has it: each multiplication by ten, or division, rounds twice."""
    text = text.replace(" ", "") or "0"
    _, _, decimals, sign, digits, _ = scan(text.upper())
    steps = abs((int(sign + digits) if digits else 0) - len(decimals))
    return Bounded(float(text), (2 * steps + 2) * UNIT * abs(float(text)))


def listing_errors(
    scene: Mapping[str, str], solved: Mapping[str, float]
) -> dict[str, float] | None:
    """Return error bounds of the 1988 program's final velocities and spins, in the scene's units:
    rounding, its pi, and what its elimination gets wrong where a column is below 1E-9.

    ``scene``: texts, M among them; ``solved``: the final velocities and spins in double precision,
    by the closed form. None where nothing can be said: uncertain divisors, ZERO DETERMINANT.
    """
    try:
        t = _Terms(scene)
        solution = eliminate(listing_rows(t), Bounded(SMALLEST_PIVOT))
    except (Uncertain, ZeroDivisionError, OverflowError, ValueError):
        return None
    if solution is None:
        return None
    if t.point:
        solution = [*solution, t.g["WA"], t.g["WB"]]
    errors = {
        name: x.e + abs(x.v - solved[name])
        for name, x in zip(FINAL_VELOCITIES, solution, strict=True)
    }
    return errors if all(map(math.isfinite, errors.values())) else None
