"""The listing's steps on other machines, written down here once more, and their pages.

A machine is what it does to a number: reads it, rounds a result, takes a sine, writes. It shares no
code with the package, so that a page made here is nobody's own hypothesis.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from decimal import Context, Decimal, localcontext
from typing import Any, NamedTuple

import numpy as np

INPUTS = (
    "MA MB IA IB DA DB PA PB TA TB GA UX UY WA VX VY WB E MU EM".split()
)  # fmt: skip
PLACES = {
    **dict.fromkeys(("XA", "YA", "XB", "YB", "LOSS", "XAF", "YAF", "XBF", "YBF"), 2),
    **dict.fromkeys(("VAX", "VAY", "VBX", "VBY"), 3),
    **dict.fromkeys(("WAF", "WBF"), 4),
}
"""Decimals of the results, by the listing."""
PI = "3.14159265"


class Machine(NamedTuple):
    """What a machine does with numbers; ``rounds`` is done to every result."""

    name: str
    reads: Callable[[str], Any]
    sine: Callable[[Any], Any]
    cosine: Callable[[Any], Any]
    rounds: Callable[[Any], Any] = lambda x: x
    digits: int = 9
    square: Callable[[Any], Any] | None = None
    pi: str = PI


class Stopped(Exception):
    """The machine stops with an error, or the page has no results."""


class _Number:
    """A number whose every operation is rounded by its machine."""

    def __init__(self, value: Any, machine: Machine) -> None:
        self.value, self.machine = value, machine

    def _made(self, value: Any) -> _Number:
        return _Number(self.machine.rounds(value), self.machine)

    def __add__(self, other: _Number) -> _Number:
        return self._made(self.value + other.value)

    def __sub__(self, other: _Number) -> _Number:
        return self._made(self.value - other.value)

    def __mul__(self, other: _Number) -> _Number:
        return self._made(self.value * other.value)

    def __truediv__(self, other: _Number) -> _Number:
        if other.value == 0:
            raise Stopped
        return self._made(self.value / other.value)

    def __neg__(self) -> _Number:
        return _Number(-self.value, self.machine)

    def squared(self) -> _Number:
        own = self.machine.square
        return self._made(own(self.value)) if own else self * self

    def size(self) -> Any:
        return abs(self.value)


def computed(scene: Mapping[str, str], machine: Machine) -> dict[str, Any]:
    """Inputs as they are printed and results not yet floored, KI and MU among them."""

    def of(text: str) -> _Number:
        return _Number(machine.rounds(machine.reads(text)), machine)

    def sin(x: _Number) -> _Number:
        return of_value(machine.sine(x.value))

    def cos(x: _Number) -> _Number:
        return of_value(machine.cosine(x.value))

    def of_value(x: Any) -> _Number:
        return _Number(machine.rounds(x), machine)

    g = {name: of(scene[name]) for name in INPUTS}
    one, two, half = of("1"), of("2"), of("2")
    ag = of(machine.pi) / of("180")
    radians = {name: g[name] * ag for name in ("GA", "PA", "PB", "TA", "TB")}
    ga, pa, pb, ta, tb = (radians[name] for name in ("GA", "PA", "PB", "TA", "TB"))
    ma, mb, ia, ib, da, db = (g[name] for name in ("MA", "MB", "IA", "IB", "DA", "DB"))
    ux, uy, wa, vx, vy, wb = (g[name] for name in ("UX", "UY", "WA", "VX", "VY", "WB"))
    e, mu, em = g["E"], g["MU"], g["EM"]
    ki = (
        ma * (ux.squared() + uy.squared())
        + mb * (vx.squared() + vy.squared())
        + ia * wa.squared()
        + ib * wb.squared()
    ) / half
    d1, d2 = db * sin(tb + pb), db * cos(tb + pb)
    d3, d4 = da * sin(ta + pa), da * cos(ta + pa)
    xa, ya, xb, yb = ux + d3 * wa, uy - d4 * wa, vx - d1 * wb, vy + d2 * wb
    pivot = float(scene["MU"]) == -10
    s, c = sin(ga), cos(ga)
    zero = of("0")
    m = int(scene["M"])
    if not pivot and (xa * s - ya * c).value < (xb * s - yb * c).value:
        mu = -mu
    if pivot:
        third = [s, -c, -s, c, da * cos(pa + ta - ga), db * cos(pb + tb - ga), zero]
    else:
        kx, ky = ma * (c - mu * s), mb * (s + mu * c)
        third = [zero, kx, ky, zero, zero, zero]
        if mu.value <= -10:
            third.append(zero)
        else:
            third.append(ma * (c - mu * s) * uy + mb * (s + mu * c) * vx)
    rows = [
        [ma, zero, mb, zero, zero, zero, ma * ux + mb * vx],
        [zero, ma, zero, mb, zero, zero, ma * uy + mb * vy],
        third,
        [
            c, s, -c, -s, d3 * c - d4 * s, d1 * c - d2 * s,
            -e * ((uy - d4 * wa - vy - d2 * wb) * s + (ux + d3 * wa - vx + d1 * wb) * c),
        ],
        [
            zero, ma * (d2 + d4), mb * (d1 + d3), zero, ia, ib,
            ma * (d2 + d4) * uy + mb * (d1 + d3) * vx + ia * wa + ib * wb,
        ],
        [
            -em * ma * d3 / ia, em * ma * d4 / ia, -em * mb * d1 / ib, em * mb * d2 / ib,
            two * em - one, one - two * em,
            em * (
                -ma * d3 * ux / ia + ma * d4 * uy / ia - mb * d1 * vx / ib + mb * d2 * vy / ib
                + wa - wb
            ),
        ],
    ]  # fmt: skip
    solution = _eliminated([row[:m] + row[6:] for row in rows[:m]])
    vax, vay, vbx, vby = solution[:4]
    # for point masses lines 700 and 710 read what was left in columns 5 and 6
    spins = solution[4:] if m == 6 else None
    kf = (ma * (vax.squared() + vay.squared()) + mb * (vbx.squared() + vby.squared())) / half
    if ki.value == 0:
        raise Stopped
    values = {
        "XA": xa,
        "YA": ya,
        "XB": xb,
        "YB": yb,
        "VAX": vax,
        "VAY": vay,
        "VBX": vbx,
        "VBY": vby,
    }
    if spins is None:
        raise Stopped
    kf = kf + (ia * spins[0].squared() + ib * spins[1].squared()) / half
    values |= {
        "LOSS": of("100") * (ki - kf) / ki,
        "XAF": vax + d3 * spins[0],
        "YAF": vay - d4 * spins[0],
        "XBF": vbx - d1 * spins[1],
        "YBF": vby + d2 * spins[1],
        "WAF": spins[0],
        "WBF": spins[1],
    }
    shown = {name: x.value for name, x in values.items()}
    shown |= {name: g[name].value for name in INPUTS if name not in radians}
    shown |= {name: (radians[name] / ag).value for name in radians}
    return {**shown, "MUP": mu.value, "KI": ki.value}


def _eliminated(a: list[list[_Number]]) -> list[_Number]:
    """Lines 1000 to 1160, as they look for the pivot."""
    m = len(a)
    for j in range(m):
        best = None
        for row in range(j, m):
            last = (row + 1) * (j + 1) >= m * m
            if best is None or last or not best.size() > a[row][j].size():
                best, place = a[row][j], row
        if best is None or best.size() < 1e-9:
            raise Stopped
        a[j], a[place] = a[place], a[j]
        a[j] = [*a[j][:j], *(x / best for x in a[j][j:])]
        for row in range(m):
            if row != j:
                factor = a[row][j]
                tail = zip(a[row][j:], a[j][j:], strict=True)
                a[row] = [*a[row][:j], *(x - y * factor for x, y in tail)]
    return [row[m] for row in a]


# --- machines ---


def _single(function: Callable[[float], float]) -> Callable[[Any], Any]:
    return lambda x: np.float32(function(float(x)))


def _cut_to_24_bits(x: float) -> float:
    """Cut, not rounded, as the older single precisions do."""
    mantissa, exponent = math.frexp(x)
    return math.ldexp(math.trunc(mantissa * 2**24), exponent - 24)


def _folded_sine(x: Any) -> Any:
    """A sine as small BASICs take it: in turns, folded, a short series, each step rounded."""
    one = np.float32
    turns = one(x) / one(2 * math.pi)
    turns = one(turns - np.floor(turns))
    if turns > one(0.75):
        turns = one(turns - one(1))
    elif turns > one(0.25):
        turns = one(one(0.5) - turns)
    angle = one(turns * one(2 * math.pi))
    square, total = one(angle * angle), one(0)
    for k in (11, 9, 7, 5, 3, 1):
        total = one(total * square + one((-1) ** (k // 2) / math.factorial(k)))
    return one(total * angle)


def _logarithmic_square(x: Any) -> Any:
    if x == 0:
        return np.float32(0)
    return np.float32(np.exp(np.float32(np.float32(2) * np.float32(np.log(np.abs(x))))))


SINGLES = {
    "IEEE single": Machine(
        "IEEE single", np.float32, _single(math.sin), _single(math.cos), np.float32, 7
    ),
    "folded sine": Machine(
        "folded sine", np.float32, _folded_sine,
        lambda x: _folded_sine(np.float32(x) + np.float32(math.pi / 2)), np.float32, 7,
    ),
    "logarithmic powers": Machine(
        "logarithmic powers", np.float32, _single(math.sin), _single(math.cos), np.float32, 7,
        _logarithmic_square,
    ),
    "cut to 24 bits": Machine(
        "cut to 24 bits", float, math.sin, math.cos, _cut_to_24_bits, 7
    ),
}  # fmt: skip
DOUBLE = Machine("double", float, math.sin, math.cos)
DOUBLE_PI = DOUBLE._replace(name="double, exact pi", pi=repr(math.pi))
ROUGH_PI = DOUBLE._replace(name="double, pi = 3.1416", pi="3.1416")


def decimal(digits: int, rounding: str = "ROUND_HALF_UP") -> Machine:
    """A decimal machine of so many digits."""
    context = Context(prec=digits, rounding=rounding)
    return Machine(
        f"{digits} decimal digits",
        lambda text: context.create_decimal(text),
        lambda x: context.create_decimal_from_float(math.sin(float(x))),
        lambda x: context.create_decimal_from_float(math.cos(float(x))),
        context.plus,
        min(digits, 12),
    )


# --- pages ---


def floored(value: Any, places: int) -> Decimal:
    """INT(10^p * x) / 10^p, the product in the machine's own numbers."""
    scaled = value * type(value)(10**places)
    return Decimal(math.floor(scaled)).scaleb(-places)


def rounded(value: Any, places: int) -> Decimal:
    """To the nearest, halves up."""
    return Decimal(math.floor(float(value) * 10**places + 0.5)).scaleb(-places)


def truncated(value: Any, places: int) -> Decimal:
    """Toward zero."""
    return Decimal(math.trunc(float(value) * 10**places)).scaleb(-places)


def in_full(digits: int, fixed_down_to: int = -2) -> Callable[[Any], str]:
    """How a BASIC writes a number: so many digits, zeros dropped, no zero before the point, an
    exponent outside of what it writes in full."""

    def write(value: Any) -> str:
        number = Decimal(repr(float(value))) if not isinstance(value, Decimal) else value
        if not number:
            return "0"
        with localcontext(Context(prec=digits, rounding="ROUND_HALF_UP")):
            number = +number
        number = number.normalize()
        exponent = number.adjusted()
        if fixed_down_to <= exponent < digits:
            text = f"{number:f}"
            sign = "-" if text.startswith("-") else ""
            text = text.removeprefix("-")
            return sign + (text.removeprefix("0") if text != "0" else text)
        mantissa = f"{number.scaleb(-exponent).normalize():f}"
        return f"{mantissa}E{'-' if exponent < 0 else '+'}{abs(exponent):02d}"

    return write


APPLE = (
    "MA= {MA} MB= {MB} IA= {IA} IB= {IB}\n\nDA= {DA} DB= {DB}\n\n PA PB TA TB GA\n"
    " {PA}      {PB}      {TA}      {TB}      {GA}\n\n"
    "UX= {UX} UY= {UY} WA= {WA} XA= {XA} YA= {YA}\n\n"
    "VX= {VX} VY= {VY} WB= {WB} XB= {XB} YB= {YB}\n\n"
    " E= {E} MU= {MUP} EM= {EM}\n\nINITIAL KE= {KI} KE LOSS= {LOSS} %\n\n*****\n\n"
    "VAX= {VAX} VAY= {VAY} (XA={XAF} YA= {YAF})\n\n"
    "VBX= {VBX} VBY= {VBY} (XB={XBF} YB= {YBF})\n\n WA= {WAF} WB= {WBF}\n\n*****\n"
)
"""The program's page."""


def page(
    values: Mapping[str, Any],
    cut: Callable[[Any, int], Any] = floored,
    digits: int = 9,
    spaced: bool = False,
    more: int = 0,
    write: Callable[[Any], str] | None = None,
) -> str:
    """The page of computed values. ``cut``: what is done to results; ``spaced``: a blank for the
    plus sign and one after each number, as Microsoft's larger BASICs print; ``more``: decimals
    beyond the listing's."""
    write = write or in_full(digits)
    texts = {}
    for name, value in values.items():
        text = write(cut(value, PLACES[name] + more) if name in PLACES else value)
        texts[name] = (text if text.startswith("-") else " " + text) + " " if spaced else text
    return APPLE.format(**texts)
