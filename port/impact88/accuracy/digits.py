"""Every result of a scene to 30 digits (needs mpmath, extra ``bench``).

The six final velocities come from `accuracy.reference`; contact velocities, energies and impulses
follow from them by their definitions (lines 320 to 340, 580 to 590, 700 to 710; Equations 13 to
17), in 50 digits throughout. For point masses (M = 4) the arms count as 0 and the spins stay out of
the energies.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from . import reference
from .reference import mpmath

DIGITS = 30


def thirty_digits(scene: Mapping[str, str]) -> dict[str, str]:
    """Result name -> 30 digits; empty when the equations are singular or make no sense."""
    try:
        values = fifty_digits(scene)
    except (ValueError, ZeroDivisionError):
        return {}
    with mpmath.workdps(reference.DIGITS):
        return {
            name: mpmath.nstr(value, DIGITS)
            for name, value in values.items()
            if mpmath.isfinite(value)
        }


def fifty_digits(scene: Mapping[str, str]) -> dict[str, Any]:
    """Result name -> mpf; empty when the equations are singular."""
    texts = {name: text.replace(" ", "") or "0" for name, text in scene.items()}
    final = reference.exact(texts)
    if final is None:
        return {}
    with mpmath.workdps(reference.DIGITS + reference.GUARD):
        g = {name: reference.number(text) for name, text in texts.items()}
        point = g["M"] == 4
        ag = mpmath.pi / 180
        zero = mpmath.mpf(0)
        a, b = (g["TA"] + g["PA"]) * ag, (g["TB"] + g["PB"]) * ag
        da, db = (zero, zero) if point else (g["DA"], g["DB"])
        D1, D2, D3, D4 = (
            db * mpmath.sin(b),
            db * mpmath.cos(b),
            da * mpmath.sin(a),
            da * mpmath.cos(a),
        )
        f = dict(final)
        before = (g["UX"], g["UY"], g["VX"], g["VY"], g["WA"], g["WB"])
        after = tuple(f[name] for name in ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF"))
        for suffix, (ax, ay, bx, by, wa, wb) in (("", before), ("F", after)):
            f[f"XA{suffix}"], f[f"YA{suffix}"] = ax + D3 * wa, ay - D4 * wa
            f[f"XB{suffix}"], f[f"YB{suffix}"] = bx - D1 * wb, by + D2 * wb
            energy = (g["MA"] * (ax**2 + ay**2) + g["MB"] * (bx**2 + by**2)) / 2
            if not point:
                energy += (g["IA"] * wa**2 + g["IB"] * wb**2) / 2
            f["KF" if suffix else "KI"] = energy
        if f["KI"]:
            f["LOSS"] = 100 * (f["KI"] - f["KF"]) / f["KI"]
        dax, day = f["VAX"] - g["UX"], f["VAY"] - g["UY"]
        f["DVA"] = mpmath.hypot(dax, day)
        f["DVB"] = mpmath.hypot(f["VBX"] - g["VX"], f["VBY"] - g["VY"])
        s, c = mpmath.sin(g["GA"] * ag), mpmath.cos(g["GA"] * ag)
        f["PN"] = g["MA"] * (c * dax + s * day)
        f["PT"] = g["MA"] * (c * day - s * dax)
        if not point:
            an, at = D3 * c - D4 * s, -(D4 * c + D3 * s)
            f["PM"] = g["IA"] * (f["WAF"] - g["WA"]) - an * f["PN"] - at * f["PT"]
        gt = c * (f["YA"] - f["YB"]) - s * (f["XA"] - f["XB"])
        f["MUP"] = -g["MU"] if gt > 0 and g["MU"] != -10 else g["MU"]
        f |= _critical_friction(texts, s, c)
        return f


def _critical_friction(texts: Mapping[str, str], s: Any, c: Any) -> dict[str, Any]:
    """MUC, the ratio of tangential to normal impulse when the contact point is a pivot."""
    pivot = reference.exact({**texts, "MU": "-10"})
    if pivot is None:
        return {}
    dx, dy = (pivot[v] - reference.number(texts[u]) for v, u in (("VAX", "UX"), ("VAY", "UY")))
    normal = c * dx + s * dy
    return {"MUC": (c * dy - s * dx) / normal} if normal else {}
