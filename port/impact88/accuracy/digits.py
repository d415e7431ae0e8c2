"""Every result of a scene to 30 digits.

The impulse comes from Equations 15, 16 (or no slip) and 18, and everything else from the impulse,
so that none is a difference of numbers that have lost it already, and what is zero is written as 0.
For point masses (M = 4) the arms count as 0 and the spins stay out of the energies.
"""

from collections.abc import Mapping
from typing import Any

from . import reference
from .elimination import ORDER
from .reference import mpmath, total

DIGITS = 30
LONGEST_EXPONENT = 3
"""Digits of the largest exponents that are computed with."""


def thirty_digits(scene: Mapping[str, str]) -> dict[str, str]:
    """Result name -> 30 digits; empty when the equations are singular or make no sense. What is no
    number (LOSS where nothing moves, MUC where a pivot feels no impulse) is not in it."""
    exponents = (text.upper().replace(" ", "").partition("E")[2] for text in scene.values())
    if any(len(exponent.lstrip("+-0")) > LONGEST_EXPONENT for exponent in exponents):
        return {}  # a number of thousands of digits is no measurement
    try:
        values = fifty_digits(scene)
    except (ValueError, ZeroDivisionError):
        return {}
    with mpmath.workdps(reference.DIGITS):
        return {
            name: mpmath.nstr(value, DIGITS) if value else "0"
            for name, value in values.items()
            if mpmath.isfinite(value)
        }


def fifty_digits(scene: Mapping[str, str | float]) -> dict[str, Any]:
    """Result name -> mpf; empty when the equations are singular. ``scene``: decimal texts, or
    floats with their exact values."""
    texts = {
        name: value.replace(" ", "") or "0" if isinstance(value, str) else value
        for name, value in scene.items()
    }
    with reference.working(texts):
        t = reference.terms(texts)
        P = reference.impulse(t)
        if P is None:
            return {}
        after = reference.velocities(t, P)
        f = dict(zip(ORDER, after, strict=True))
        f |= _contact_velocities(t, t.before(), "") | _contact_velocities(t, after, "F")
        for name, suffix, sign in (("VC", "", -1), ("VS", "F", 1)):
            x, y = (total(f[f"{axis}A{suffix}"], -f[f"{axis}B{suffix}"]) for axis in "XY")
            f[name] = sign * total(t.c * x, t.s * y)
        f |= _energies(t, P, after)
        ma, mb, *_ = reference.inverses(t)
        size = mpmath.hypot(P.normal, P.tangential)
        f |= {"DVA": ma * size, "DVB": mb * size}
        f |= {"PN": P.normal, "PT": P.tangential, "PM": P.moment, "MUP": t.mu}
        if t.point:
            f |= {"WAF": t.g["WA"], "WBF": t.g["WB"]}
        pivot = reference.impulse(reference.terms({**texts, "MU": "-10"}))
        return f | ({"MUC": pivot.tangential / pivot.normal} if pivot and pivot.normal else {})


def _contact_velocities(t: Any, velocities: list[Any], suffix: str) -> dict[str, Any]:
    """Lines 340, 700 and 710."""
    ax, ay, bx, by, wa, wb = velocities
    return {
        f"XA{suffix}": total(ax, t.D3 * wa),
        f"YA{suffix}": total(ay, -t.D4 * wa),
        f"XB{suffix}": total(bx, -t.D1 * wb),
        f"YB{suffix}": total(by, t.D2 * wb),
    }


def _energies(t: Any, P: Any, after: list[Any]) -> dict[str, Any]:
    """Lines 320, 580, 590 and 690; the percentage by the work of the impulse at the mean of the
    relative velocities before and after."""
    g, before = t.g, t.before()
    bodies = ["MA", "MA", "MB", "MB", *([] if t.point else ["IA", "IB"])]

    def energy(velocities: list[Any]) -> Any:
        pairs = zip(bodies, velocities, strict=False)
        # an infinite body is at rest
        return mpmath.fsum(g[x] * v**2 for x, v in pairs if not mpmath.isinf(g[x])) / 2

    initial = energy(before)
    values = {"KI": initial, "KF": energy(after)}
    if initial:
        an, at, bn, bt = reference.arms(t)
        s, c = t.s, t.c
        ax, ay, bx, by, wa, wb = (u + v for u, v in zip(before, after, strict=True))
        if t.point:
            wa = wb = mpmath.mpf(0)
        normal = total(c * ax, s * ay, -c * bx, -s * by, an * wa, bn * wb)
        sliding = total(c * ay, -s * ax, -c * by, s * bx, at * wa, bt * wb)
        work = total(P.normal * normal, P.tangential * sliding, P.moment * total(wa, -wb))
        values["LOSS"] = -50 * work / initial
    return values
