"""Programs with one mistake each, for `compare` to find; the package has no part in them."""

from __future__ import annotations

import math
import struct
from typing import ClassVar

from otherprogram import FINALS, Numbers, Program

PAIRS = (
    ("DA", "DB"), ("PA", "PB"), ("TA", "TB"), ("MA", "MB"),
    ("IA", "IB"), ("UX", "VX"), ("UY", "VY"), ("WA", "WB"),
)  # fmt: skip
SPEEDS = ("VAX", "VAY", "VBX", "VBY", "XAF", "YAF", "XBF", "YBF", "DVA", "DVB")
OUT = (
    ("VAX", "VBX"),
    ("VAY", "VBY"),
    ("WAF", "WBF"),
    ("XAF", "XBF"),
    ("YAF", "YBF"),
    ("DVA", "DVB"),
)
AXES = (("VAX", "VAY"), ("VBX", "VBY"), ("XAF", "YAF"), ("XBF", "YBF"))


def swapped(values: Numbers, pairs: tuple[tuple[str, str], ...]) -> Numbers:
    other = dict(values)
    for a, b in pairs:
        other[a], other[b] = values[b], values[a]
    return other


def scaled(values: Numbers, names: tuple[str, ...], k: float) -> Numbers:
    return {name: x * k if name in names else x for name, x in values.items()}


class Swapping(Program):
    """What it exchanges in the scene, and in the results."""

    reads: ClassVar[tuple[tuple[str, str], ...]] = ()
    shows: ClassVar[tuple[tuple[str, str], ...]] = ()

    def read(self, g: Numbers) -> Numbers:
        return swapped(g, self.reads)

    def show(self, r: Numbers, g: Numbers) -> Numbers:
        return swapped(r, tuple(pair for pair in self.shows if pair[0] in r))


class Scaling(Program):
    """What it multiplies in the scene, and in the results."""

    reads: ClassVar[dict[str, float]] = {}
    shows: ClassVar[dict[str, float]] = {}

    def read(self, g: Numbers) -> Numbers:
        return {name: x * self.reads.get(name, 1.0) for name, x in g.items()}

    def show(self, r: Numbers, g: Numbers) -> Numbers:
        return {name: x * self.shows.get(name, 1.0) for name, x in r.items()}


def swapping(reads: tuple = (), shows: tuple = ()) -> Program:
    return type("Swaps", (Swapping,), {"reads": reads, "shows": shows})()


def scaling(reads: dict | None = None, shows: dict | None = None) -> Program:
    return type("Scales", (Scaling,), {"reads": reads or {}, "shows": shows or {}})()


class Radians(Program):
    def angle(self, degrees: float) -> float:
        return degrees


class Twice(Program):
    def angle(self, degrees: float) -> float:
        return degrees * (math.pi / 180) ** 2


class Pi314(Program):
    pi = 3.14


class Compass(Program):
    def read(self, g: Numbers) -> Numbers:
        return {**g, "TA": 90 - g["TA"], "TB": 90 - g["TB"]}


class NormalForSurface(Program):
    def read(self, g: Numbers) -> Numbers:
        return {**g, "GA": g["GA"] + 90}


class Squared(Program):
    def restitution(self, g: Numbers) -> float:
        return g["E"] ** 2


class SignLost(Program):
    def restitution(self, g: Numbers) -> float:
        return -g["E"]


class MomentSign(Program):
    def moment(self, g: Numbers) -> float:
        return 1.0 if g["M"] == 4 else -g["EM"]


class NoMoment(Program):
    def moment(self, g: Numbers) -> float:
        return 1.0


class NoSignRule(Program):
    def friction(self, g: Numbers, sliding: float) -> float | None:
        return None if g["MU"] == -10 else g["MU"]


class SignRuleInverted(Program):
    def friction(self, g: Numbers, sliding: float) -> float | None:
        return None if g["MU"] == -10 else (g["MU"] if sliding > 0 else -g["MU"])


class NoPivot(Program):
    def friction(self, g: Numbers, sliding: float) -> float | None:
        return -g["MU"] if sliding > 0 else g["MU"]


class AtCentres(Program):
    def restitution_arms(self, g: Numbers) -> tuple[float, float, float, float]:
        return 0.0, 0.0, 0.0, 0.0


class NothingBefore(Program):
    def momentum(self, g: Numbers) -> tuple[float, float]:
        return 0.0, 0.0


class Fraction(Program):
    def loss(self, before: float, after: float) -> float:
        return (before - after) / before


class NoHalf(Program):
    def energy(self, g: Numbers, v: Numbers) -> float:
        return 2 * super().energy(g, v)


class OneComponent(Program):
    def delta_v(self, dx: float, dy: float) -> float:
        return abs(dx)


class Single(Program):
    def rounded(self, x: float) -> float:
        return struct.unpack("f", struct.pack("f", x))[0] if abs(x) < 3e38 else x

    def show(self, r: Numbers, g: Numbers) -> Numbers:
        return {name: self.rounded(x) for name, x in r.items()}


SPINS, DEGREES, RPM, MPH = ("WAF", "WBF"), 180 / math.pi, 30 / math.pi, 15 / 22
INITIAL = ("UX", "UY", "VX", "VY")


def each(names: tuple[str, ...], k: float) -> dict[str, float]:
    return dict.fromkeys(names, k)


MISTAKES: dict[str, tuple[Program, str]] = {
    "A and B exchanged in the input": (swapping(PAIRS), "A and B exchanged in the scene"),
    "A and B exchanged in the output": (swapping((), OUT), "A and B exchanged in the results"),
    "IA and IB": (swapping((("IA", "IB"),)), "inertias exchanged"),
    "MA and MB": (swapping((("MA", "MB"),)), "masses exchanged"),
    "DA and DB": (swapping((("DA", "DB"),)), "arms exchanged: DA and DB"),
    "PA and PB": (swapping((("PA", "PB"),)), "PA and PB exchanged"),
    "TA and TB": (swapping((("TA", "TB"),)), "TA and TB exchanged"),
    "all angles of A and B": (swapping(PAIRS[1:3]), "A's angles and B's exchanged"),
    "inertia halved": (scaling(each(("IA", "IB"), 0.5)), "inertias halved"),
    "inertia in lb": (scaling(each(("IA", "IB"), 32.174)), "inertias in weight: times 32.174"),
    "degrees": (Radians(), "degrees taken as radians: angles are not converted"),
    "converted twice": (Twice(), "angles converted to radians twice"),
    "compass": (Compass(), "headings θ as compass headings, clockwise from north"),
    "normal": (NormalForSurface(), "Γ 90 degrees on: the normal's angle for the surface's"),
    "clockwise spin": (
        scaling(each(("WA", "WB"), -1), each(SPINS, -1)),
        "spins, initial and final, positive clockwise "
        "(or both contact points on the wrong sides, which is the same)",
    ),
    "clockwise spin shown": (scaling({}, each(SPINS, -1)), "final spins with the opposite sign"),
    "deg/s": (
        scaling(each(("WA", "WB"), 1 / DEGREES), each(SPINS, DEGREES)),
        "spins, initial and final, in degrees per unit of time",
    ),
    "deg/s shown": (scaling({}, each(SPINS, DEGREES)), "final spins in degrees per unit of time"),
    "rpm": (
        scaling(each(("WA", "WB"), 1 / RPM), each(SPINS, RPM)),
        "spins, initial and final, in revolutions per minute",
    ),
    "rpm shown": (scaling({}, each(SPINS, RPM)), "final spins in revolutions per minute"),
    "mph read": (scaling(each(INITIAL, 1 / MPH)), "initial velocities converted, mph to ft/s"),
    "mph shown": (scaling({}, each(SPEEDS, MPH)), "final velocities converted, ft/s to mph"),
    "e squared": (Squared(), "e squared"),
    "e's sign": (SignLost(), "e with its sign lost"),
    "em's sign": (MomentSign(), "e_m with the opposite sign"),
    "em absent": (NoMoment(), "e_m absent: no moment impulse, as in models with M = 0"),
    "no sign rule": (NoSignRule(), "MU's sign as typed, without line 400's rule"),
    "sign rule inverted": (SignRuleInverted(), "MU's sign rule inverted"),
    "no pivot": (NoPivot(), "no pivot: MU = -10 taken as a coefficient"),
    "at the centres": (AtCentres(), "restitution at the mass centres, not at the contact point"),
    "spins left out": (scaling(each(("WA", "WB"), 0.0)), "initial spins left out"),
    "x and y shown": (swapping((), AXES), "x and y exchanged in the results"),
    "pi": (Pi314(), "3.14 for pi"),
    "LOSS a fraction": (Fraction(), "LOSS as a fraction, not in percent"),
    "no half": (NoHalf(), "energies without the half"),
    "one component": (OneComponent(), "delta-V: the x component only"),
    "single": (Single(), "rounding in single precision"),
    "momentum": (NothingBefore(), "momentum's right-hand sides 0 (Equations 13 and 14)"),
}
"""What is wrong -> the program, and what `compare` calls it."""

assert set(FINALS) < {*SPEEDS, *SPINS}
