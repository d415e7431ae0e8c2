"""How a program may read a scene otherwise: angles, units, what is exchanged or left out."""

# ruff: noqa: E501

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from .otherprograms import used_friction
from .slip import Columns, Floats, Reads, Slip

ANGLES = ("GA", "PA", "PB", "TA", "TB")
VELOCITIES = ("UX", "UY", "VX", "VY")
SPINS = ("WA", "WB")
GRAVITY_FT, GRAVITY_M = 32.174, 9.80665


def changing(names: Sequence[str], change: Callable[[Floats], Floats]) -> Reads:
    """Some of the scene's columns, changed alike."""
    return lambda scene: {name: change(scene[name]) for name in names}


def times(names: Sequence[str], factor: float) -> Reads:
    """Some of the scene's columns, multiplied."""
    return changing(names, lambda x: x * factor)


def exchanged(*pairs: tuple[str, str]) -> Reads:
    """Pairs of columns, one for the other."""
    return lambda scene: {
        **{one: scene[other] for one, other in pairs},
        **{other: scene[one] for one, other in pairs},
    }


VEHICLES = (
    ("DA", "DB"), ("PA", "PB"), ("TA", "TB"), ("MA", "MB"),
    ("IA", "IB"), ("UX", "VX"), ("UY", "VY"), ("WA", "WB"),
)  # fmt: skip


def _mu_as_typed(scene: Columns) -> Columns:
    """Line 400 flips MU where MUP shows it; a program without it must be given the opposite."""
    kept = used_friction(scene) == scene["MU"]
    return {"MU": np.where(kept, scene["MU"], _opposite(scene["MU"]))}


def _opposite(mu: Floats) -> Floats:
    """MU with the other sign; what is no pivot stays none."""
    return np.where(mu == 10, np.nextafter(-10.0, -11.0), -mu)


def _mu_opposite(scene: Columns) -> Columns:
    return {"MU": np.where(scene["MU"] == -10, scene["MU"], _opposite(scene["MU"]))}


def _mu_against_sliding(scene: Columns) -> Columns:
    return {"MU": np.where(scene["MU"] == -10, scene["MU"], np.abs(scene["MU"]))}


def _no_pivot(scene: Columns) -> Columns:
    """-10 as a coefficient: the next number to it is no pivot."""
    return {"MU": np.where(scene["MU"] == -10, np.nextafter(-10.0, -11.0), scene["MU"])}


def _no_pivot_as_typed(scene: Columns) -> Columns:
    """The same in a program without line 400's rule."""
    changed = {**scene, **_no_pivot(scene)}
    return {"MU": np.where(scene["MU"] == -10, _mu_as_typed(changed)["MU"], scene["MU"])}


def _slides_at_centres(scene: Columns) -> Columns:
    """Line 400's rule with the spins left out."""
    centres = used_friction({**scene, "WA": 0 * scene["WA"], "WB": 0 * scene["WB"]})
    return {"MU": np.where(centres == used_friction(scene), scene["MU"], _opposite(scene["MU"]))}


def _tangent(mu: Floats, unit: float = 1.0) -> Floats:
    return np.where(mu == -10, mu, np.tan(mu * unit))


def _friction_limited(scene: Columns) -> Columns:
    """A pivot where the coefficient typed would reverse the sliding."""
    from ..closedform.solve import quantities

    with np.errstate(all="ignore"):
        slip = quantities(scene, ("gt", "Gt"))
        reversed_ = slip["gt"] * slip["Gt"] < 0
    return {"MU": np.where(reversed_, -10.0, scene["MU"])}


def _energy_ratio(scene: Columns) -> Columns:
    return {"E": np.sqrt(np.abs(scene["E"]))}


def constant_of(value: float) -> Callable[[Floats], Floats]:
    """A column with the same value in every row."""
    return lambda x: np.full_like(x, value)


def _compass(x: Floats) -> Floats:
    return 90 - x


READ: tuple[Slip, ...] = (
    Slip("the 3.14159265 of line 300 for pi", times(ANGLES, 3.14159265 / math.pi)),
    Slip("3.14 for pi", times(ANGLES, 3.14 / math.pi)),
    Slip("3.1416 for pi", times(ANGLES, 3.1416 / math.pi)),
    Slip("22/7 for pi", times(ANGLES, 22 / 7 / math.pi)),
    Slip("angles in gradians", times(ANGLES, 0.9)),
    Slip("angles cut to whole degrees", changing(ANGLES, np.trunc), common=False),
    Slip("angles rounded to whole degrees", changing(ANGLES, np.round), common=False),
    Slip("degrees taken as radians: angles are not converted", changing(ANGLES, np.degrees)),
    Slip("angles converted to radians twice", changing(ANGLES, np.radians)),
    Slip("Γ is not converted to radians", changing(("GA",), np.degrees)),
    *(
        Slip(f"{name} is not converted to radians", changing((name,), np.degrees), common=False)
        for name in ANGLES[1:]
    ),
    Slip("Γ positive the other way round", changing(("GA",), np.negative)),
    Slip("Γ 90 degrees on: the normal's angle for the surface's", changing(("GA",), lambda x: x + 90)),
    Slip("Γ 90 degrees back", changing(("GA",), lambda x: x - 90)),
    Slip("Γ as a compass heading", changing(("GA",), _compass)),
    Slip("Γ left out", changing(("GA",), np.zeros_like)),
    Slip("all angles positive clockwise", changing(ANGLES, np.negative)),
    Slip("headings θ as compass headings, clockwise from north", changing(("TA", "TB"), _compass)),
    Slip("headings θ and Γ as compass headings", changing(("TA", "TB", "GA"), _compass)),
    Slip("θ positive the other way round", changing(("TA", "TB"), np.negative)),
    Slip("φ positive the other way round", changing(("PA", "PB"), np.negative)),
    Slip("φ left out", changing(("PA", "PB"), np.zeros_like)),
    Slip("θ left out: φ taken from the x axis", changing(("TA", "TB"), np.zeros_like)),
    Slip("TA and TB exchanged", exchanged(("TA", "TB"))),
    Slip("PA and PB exchanged", exchanged(("PA", "PB"))),
    Slip("A's angles and B's exchanged", exchanged(("TA", "TB"), ("PA", "PB"))),
    Slip("A's contact point on the wrong side of A", changing(("PA",), lambda x: x + 180)),
    Slip("B's contact point on the wrong side of B", changing(("PB",), lambda x: x + 180)),
    Slip(
        "sine and cosine of the arms exchanged",
        lambda g: {"PA": 90 - 2 * g["TA"] - g["PA"], "PB": 90 - 2 * g["TB"] - g["PB"]},
        common=False,
    ),
    Slip("arms exchanged: DA and DB", exchanged(("DA", "DB"))),
    Slip("arms exchanged: DA and DB, with their angles", exchanged(*VEHICLES[:3])),
    Slip("arms halved", times(("DA", "DB"), 0.5), common=False),
    Slip("arms doubled", times(("DA", "DB"), 2.0), common=False),
    Slip("arms 12 times too long: inches", times(("DA", "DB"), 12.0), common=False),
    Slip("arms 12 times too short: inches", times(("DA", "DB"), 1 / 12), common=False),
    Slip("arms left out", times(("DA", "DB"), 0.0)),
    Slip("point masses: M = 4 in every row", changing(("M",), constant_of(4.0))),
    Slip("M = 6 in every row: point masses not known", changing(("M",), constant_of(6.0))),
    Slip("masses exchanged", exchanged(("MA", "MB"))),
    Slip("masses and inertias exchanged", exchanged(("MA", "MB"), ("IA", "IB"))),
    Slip("inertias exchanged", exchanged(("IA", "IB"))),
    Slip("IA for both inertias", lambda g: {"IB": g["IA"]}, common=False),
    Slip("IB for both inertias", lambda g: {"IA": g["IB"]}, common=False),
    Slip("MA for both masses", lambda g: {"MB": g["MA"]}, common=False),
    Slip("MB for both masses", lambda g: {"MA": g["MB"]}, common=False),
    Slip("A and B exchanged in the scene", exchanged(*VEHICLES)),
    Slip("initial velocities of A and B exchanged", exchanged(*VEHICLES[5:])),
    Slip("x and y of the initial velocities exchanged", exchanged(("UX", "UY"), ("VX", "VY"))),
    Slip("initial y velocities with the opposite sign", changing(("UY", "VY"), np.negative)),
    Slip("initial x velocities with the opposite sign", changing(("UX", "VX"), np.negative)),
    Slip("initial spins in degrees per unit of time", changing(SPINS, np.radians)),
    Slip("initial spins in revolutions per minute", times(SPINS, math.pi / 30)),
    Slip("initial spins in revolutions per unit of time", times(SPINS, 2 * math.pi)),
    Slip("initial spins converted to degrees", changing(SPINS, np.degrees)),
    Slip("initial spins positive clockwise", changing(SPINS, np.negative)),
    Slip("initial spins left out", times(SPINS, 0.0)),
    Slip("initial spins exchanged", exchanged(("WA", "WB"))),
    Slip("e squared", changing(("E",), np.square)),
    Slip("the square root of e", _energy_ratio),
    Slip("e with its sign lost", changing(("E",), np.negative)),
    Slip("1 - e for e", changing(("E",), lambda x: 1 - x)),
    Slip("e left out: 0", changing(("E",), np.zeros_like)),
    Slip("e left out: 1", changing(("E",), np.ones_like)),
    Slip("e_m absent: no moment impulse, as in models with M = 0", changing(("EM",), np.ones_like)),
    Slip("e_m with the opposite sign", changing(("EM",), np.negative)),
    Slip("e_m taken as 0: final spins alike", changing(("EM",), np.zeros_like)),
    Slip("e_m counted from the other end: 1 + e_m", changing(("EM",), lambda x: 1 + x)),
    Slip("e_m counted from the other end: 1 - e_m", changing(("EM",), lambda x: 1 - x)),
    Slip("e_m squared", changing(("EM",), np.square), common=False),
    Slip("e_m for e, and e for e_m", exchanged(("E", "EM")), common=False),
    Slip("MU's sign as typed, without line 400's rule", _mu_as_typed, late=True),
    Slip("MU's sign rule inverted", _mu_opposite, late=True),
    Slip("MU always against the sliding, whatever sign is typed", _mu_against_sliding, late=True),
    Slip("sliding judged at the mass centres, not at the contact point", _slides_at_centres, late=True),
    Slip("MU as a friction angle in radians", changing(("MU",), _tangent)),
    Slip("MU as a friction angle in degrees", changing(("MU",), lambda x: _tangent(x, math.pi / 180))),
    Slip("friction left out", changing(("MU",), np.zeros_like)),
    Slip("the pivot for friction", changing(("MU",), constant_of(-10.0))),
    Slip("no pivot: MU = -10 taken as a coefficient", _no_pivot),
    Slip("no pivot: MU = -10 taken as a coefficient, as typed", _no_pivot_as_typed, late=True),
    Slip("friction limited where it would reverse the sliding", _friction_limited, late=True),
    Slip("e and MU exchanged", exchanged(("E", "MU")), common=False),
)  # fmt: skip

_INERTIA = {
    "halved": 0.5,
    "doubled": 2.0,
    "in weight: times 32.174": GRAVITY_FT,
    "divided by 32.174": 1 / GRAVITY_FT,
    "in weight: times 32.2": 32.2,
    "divided by 32.2": 1 / 32.2,
    "in weight: times 9.80665": GRAVITY_M,
    "divided by 9.80665": 1 / GRAVITY_M,
    "in weight: times 9.81": 9.81,
    "divided by 9.81": 1 / 9.81,
    "times 12": 12.0,
    "divided by 12": 1 / 12,
    "times 144: square inches": 144.0,
    "divided by 144: square inches": 1 / 144,
}
INERTIAS = tuple(
    Slip(f"{which} {how}", times(names, factor), common=how in ("halved", "doubled"))
    for how, factor in _INERTIA.items()
    for which, names in (
        ("inertias", ("IA", "IB")),
        ("masses", ("MA", "MB")),
        ("masses and inertias", ("MA", "MB", "IA", "IB")),
        ("IA", ("IA",)),
        ("IB", ("IB",)),
        ("MA", ("MA",)),
        ("MB", ("MB",)),
    )
)

UNITS = {
    "ft/s to mph": 15 / 22,
    "mph to ft/s": 22 / 15,
    "m/s to km/h": 3.6,
    "km/h to m/s": 1 / 3.6,
    "ft/s to m/s": 0.3048,
    "m/s to ft/s": 1 / 0.3048,
    "mph to m/s": 0.44704,
    "m/s to mph": 1 / 0.44704,
    "mph to km/h": 1.609344,
    "km/h to mph": 1 / 1.609344,
    "ft/s to km/h": 1.09728,
    "km/h to ft/s": 1 / 1.09728,
    "knots to m/s": 1852 / 3600,
    "m/s to knots": 3600 / 1852,
}
"""Conversions of velocities by what they do."""
CONVERTED = tuple(
    Slip(f"initial velocities converted, {how}", times(VELOCITIES, factor), common=False)
    for how, factor in UNITS.items()
)
