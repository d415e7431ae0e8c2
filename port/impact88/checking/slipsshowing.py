"""How a program may show its results otherwise: units, signs, parts, one for the other."""

# ruff: noqa: E501

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from .slip import Columns, Floats, Shows, Slip
from .slipsreading import SPINS, UNITS, VELOCITIES, changing, times

FINAL_SPINS = ("WAF", "WBF")
FINAL_SPEEDS = ("VAX", "VAY", "VBX", "VBY")
CONTACT = ("XAF", "YAF", "XBF", "YBF")
ALL_SPEEDS = (*FINAL_SPEEDS, *CONTACT, "XA", "YA", "XB", "YB", "DVA", "DVB")
ENERGIES = ("KI", "KF")
IMPULSES = ("PN", "PT", "PM")


def showing(names: Sequence[str], change: Callable[[Floats], Floats]) -> Shows:
    """Some of the results, changed alike."""
    return lambda found, scene: {name: change(found[name]) for name in names}


def scaled(names: Sequence[str], factor: float) -> Shows:
    """Some of the results, multiplied."""
    return showing(names, lambda x: x * factor)


def swapping(*pairs: tuple[str, str]) -> Shows:
    """Pairs of results, one for the other."""
    return lambda found, scene: {
        **{one: found[other] for one, other in pairs},
        **{other: found[one] for one, other in pairs},
    }


def _instead(names: Mapping[str, Callable[[Columns, Columns], Floats]]) -> Shows:
    return lambda found, scene: {name: make(found, scene) for name, make in names.items()}


def _result(name: str) -> Callable[[Columns, Columns], Floats]:
    return lambda r, g: r[name]


def _given(name: str) -> Callable[[Columns, Columns], Floats]:
    return lambda r, g: g[name]


def _change(after: str, before: str) -> Callable[[Columns, Columns], Floats]:
    return lambda r, g: r[after] - g[before]


_PAIRS = (("VAX", "UX"), ("VAY", "UY"), ("VBX", "VX"), ("VBY", "VY"), ("WAF", "WA"), ("WBF", "WB"))
_BODIES = (("VAX", "VBX"), ("VAY", "VBY"), ("WAF", "WBF"), ("XAF", "XBF"), ("YAF", "YBF"),
           ("DVA", "DVB"), ("XA", "XB"), ("YA", "YB"))  # fmt: skip
_AXES = (("VAX", "VAY"), ("VBX", "VBY"), ("XAF", "YAF"), ("XBF", "YBF"), ("XA", "YA"), ("XB", "YB"))


def _delta(part: Callable[[Floats, Floats], Floats]) -> Shows:
    return _instead(
        {
            "DVA": lambda r, g: part(r["VAX"] - g["UX"], r["VAY"] - g["UY"]),
            "DVB": lambda r, g: part(r["VBX"] - g["VX"], r["VBY"] - g["VY"]),
        }
    )


def _speed_change(r: Columns, after: Sequence[str], g: Columns, before: Sequence[str]) -> Floats:
    speeds = np.hypot(r[after[0]], r[after[1]]), np.hypot(g[before[0]], g[before[1]])
    return np.abs(speeds[0] - speeds[1])


def _translation(r: Columns, g: Columns, after: bool) -> Floats:
    a, b = (("VAX", "VAY"), ("VBX", "VBY")) if after else (("UX", "UY"), ("VX", "VY"))
    v = r if after else g
    squares = [v[x] ** 2 + v[y] ** 2 for x, y in (a, b)]
    return np.asarray((g["MA"] * squares[0] + g["MB"] * squares[1]) / 2)


def _without_rotation(r: Columns, g: Columns) -> Columns:
    before, after = _translation(r, g, False), _translation(r, g, True)
    return {"KI": before, "KF": after, "LOSS": 100 * (before - after) / before}


def _along_the_plane(r: Columns, g: Columns) -> Columns:
    c, s = np.cos(np.radians(g["GA"])), np.sin(np.radians(g["GA"]))
    return {
        name: value
        for x, y in _AXES
        for name, value in ((x, c * r[x] + s * r[y]), (y, c * r[y] - s * r[x]))
    }


def _spin_sign_at_contact(r: Columns, g: Columns) -> Columns:
    centres = dict(zip(CONTACT, FINAL_SPEEDS, strict=True))
    return {name: 2 * r[centre] - r[name] for name, centre in centres.items()}


_SPINS_OUT = {
    "in degrees per unit of time": 180 / math.pi,
    "in revolutions per minute": 30 / math.pi,
    "in revolutions per unit of time": 1 / (2 * math.pi),
    "converted to radians once more": math.pi / 180,
    "with the opposite sign": -1.0,
}
_SPINS_BOTH = {
    "degrees per unit of time": 180 / math.pi,
    "revolutions per minute": 30 / math.pi,
    "revolutions per unit of time": 1 / (2 * math.pi),
    "positive clockwise (or both contact points on the wrong sides, which is the same)": -1.0,
}

SHOWN: tuple[Slip, ...] = (
    *(Slip(f"final spins {how}", results=scaled(FINAL_SPINS, k))
      for how, k in _SPINS_OUT.items()),
    *(Slip(f"spins, initial and final, in {how}" if k > 0 else f"spins, initial and final, {how}",
           times(SPINS, 1 / k), results=scaled(FINAL_SPINS, k))
      for how, k in _SPINS_BOTH.items()),
    *(Slip(f"final velocities converted, {how}", results=scaled(ALL_SPEEDS, k),
           common=how.startswith(("ft/s to mph", "mph to ft/s", "m/s to km/h", "km/h to m/s")))
      for how, k in UNITS.items()),
    *(Slip(f"velocities, initial and final, converted, {how}, and spins not", times(VELOCITIES, k),
           results=scaled(ALL_SPEEDS, 1 / k), common=False)
      for how, k in UNITS.items()),
    *(Slip(f"{name[1]}'s spin, initial and final, positive clockwise", changing((name,), np.negative),
           results=showing((f"{name}F",), np.negative), common=False)
      for name in SPINS),
    Slip("final velocities along n and t, not along x and y", results=_along_the_plane),
    Slip("A and B exchanged in the results", results=swapping(*_BODIES)),
    Slip("A and B exchanged in the results: velocities only", results=swapping(*_BODIES[:2]), common=False),
    Slip("final spins exchanged", results=swapping(("WAF", "WBF"))),
    Slip("x and y exchanged in the results", results=swapping(*_AXES)),
    Slip("x and y of the final velocities exchanged", results=swapping(*_AXES[:2]), common=False),
    Slip("x and y exchanged in A's results", results=swapping(("VAX", "VAY"), ("XAF", "YAF")), common=False),
    Slip("x and y exchanged in B's results", results=swapping(("VBX", "VBY"), ("XBF", "YBF")), common=False),
    Slip("final velocities with the opposite sign", results=showing(ALL_SPEEDS[:8], np.negative)),
    Slip("final y velocities with the opposite sign", results=showing(("VAY", "VBY", "YAF", "YBF"), np.negative)),
    Slip("final x velocities with the opposite sign", results=showing(("VAX", "VBX", "XAF", "XBF"), np.negative)),
    Slip("changes of velocity shown for final velocities",
         results=_instead({after: _change(after, before) for after, before in _PAIRS})),
    Slip("changes of velocity shown for final velocities, spins as they are",
         results=_instead({after: _change(after, before) for after, before in _PAIRS[:4]}), common=False),
    Slip("initial velocities shown for final ones",
         results=_instead({after: _given(before) for after, before in _PAIRS})),
    Slip("contact points' velocities shown for the mass centres'",
         results=_instead({c: _result(name) for name, c in zip(CONTACT, FINAL_SPEEDS, strict=True)})),
    Slip("mass centres' velocities shown for the contact points'",
         results=_instead({name: _result(c) for name, c in zip(CONTACT, FINAL_SPEEDS, strict=True)})),
    Slip("contact points' final velocities with the spins' sign reversed", results=_spin_sign_at_contact),
    Slip("contact points' velocities before the impact shown for those after it",
         results=_instead({name: _result(name[:2]) for name in CONTACT})),
    Slip("delta-V: the x component only", results=_delta(lambda x, y: np.abs(x))),
    Slip("delta-V: the y component only", results=_delta(lambda x, y: np.abs(y))),
    Slip("delta-V: the x component only, with its sign", results=_delta(lambda x, y: x)),
    Slip("delta-V: the y component only, with its sign", results=_delta(lambda x, y: y)),
    Slip("delta-V: the sum of the components' sizes", results=_delta(lambda x, y: np.abs(x) + np.abs(y))),
    Slip("delta-V squared", results=_delta(lambda x, y: x * x + y * y)),
    Slip("delta-V: the normal component only", results=_instead(
        {"DVA": lambda r, g: np.abs(r["PN"]) / g["MA"], "DVB": lambda r, g: np.abs(r["PN"]) / g["MB"]})),
    Slip("delta-V: the tangential component only", results=_instead(
        {"DVA": lambda r, g: np.abs(r["PT"]) / g["MA"], "DVB": lambda r, g: np.abs(r["PT"]) / g["MB"]})),
    Slip("delta-V: the change of speed", results=_instead(
        {"DVA": lambda r, g: _speed_change(r, ("VAX", "VAY"), g, ("UX", "UY")),
         "DVB": lambda r, g: _speed_change(r, ("VBX", "VBY"), g, ("VX", "VY"))})),
    Slip("delta-V of A and B exchanged", results=swapping(("DVA", "DVB"))),
    Slip("energies without the half", results=showing(ENERGIES, lambda x: 2 * x)),
    Slip("energies halved twice", results=showing(ENERGIES, lambda x: x / 2)),
    Slip("energies without rotation", results=_without_rotation),
    Slip("final energy without rotation", results=lambda r, g: {
        "KF": _translation(r, g, True), "LOSS": 100 * (r["KI"] - _translation(r, g, True)) / r["KI"]}),
    Slip("energies before and after exchanged", results=swapping(("KI", "KF"))),
    Slip("LOSS as a fraction, not in percent", results=showing(("LOSS",), lambda x: x / 100)),
    Slip("LOSS with the opposite sign", results=showing(("LOSS",), np.negative)),
    Slip("LOSS: what is left, not what is lost", results=showing(("LOSS",), lambda x: 100 - x)),
    Slip("LOSS: what is left, as a fraction", results=showing(("LOSS",), lambda x: 1 - x / 100)),
    Slip("LOSS in percent of the final energy", results=lambda r, g: {"LOSS": 100 * (r["KI"] - r["KF"]) / r["KF"]}),
    Slip("LOSS in percent of the initial energy without rotation", results=lambda r, g: {
        "LOSS": 100 * (r["KI"] - r["KF"]) / _translation(r, g, False)}),
    Slip("LOSS as an energy", results=lambda r, g: {"LOSS": r["KI"] - r["KF"]}),
    Slip("impulses with the opposite sign: on B, not on A", results=showing(IMPULSES, np.negative)),
    Slip("PT with the opposite sign", results=showing(("PT",), np.negative)),
    Slip("PN with the opposite sign", results=showing(("PN",), np.negative)),
    Slip("PN and PT exchanged", results=swapping(("PN", "PT"))),
    Slip("impulses along x and y, not along n and t", results=lambda r, g: {
        "PN": g["MA"] * (r["VAX"] - g["UX"]), "PT": g["MA"] * (r["VAY"] - g["UY"])}),
    Slip("MUP as typed, without the sign it is used with", results=lambda r, g: {"MUP": g["MU"]}),
    Slip("MUP without its sign", results=showing(("MUP",), np.abs)),
)  # fmt: skip
