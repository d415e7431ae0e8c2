"""Everything that follows from an impact found, and values without their rounding."""

import math
from collections.abc import Mapping

from ...mechanics.outcome import forces, moment_ratio, outcome
from ...mechanics.posed import with_headings
from ...mechanics.state import COURSES, FORCES
from ...names import CHAPTER, RESULTS, SCENE, VELOCITY, quantity

# A value smaller than this fraction of the largest of its unit is rounding, and printed as 0. Twice
# as much prints the same for 100 solutions.
NOISE = 1e-9
ROUNDING = 1e-13  # a coefficient, or a fraction of a value in JSON, below is rounding, and 0
_ORDER = (*SCENE, *RESULTS, *CHAPTER)
# Quantities that a rigid barrier does not have
_NOT_OF_BARRIERS = (*(name for name in _ORDER if "B" in name), "VX", "VY")
# Quantities that point masses do not have, or that repeat others
_NOT_OF_POINT_MASSES = (
    "EM RR0 PM WA WAF WB WBF IA IB DA DB PA PB XA YA XB YB XAF YAF XBF YBF CAX CAY CBX CBY"
).split()


def with_derived_values(values: dict[str, float], contact_time: float | None) -> dict[str, float]:
    """Return an impact's values and everything that follows from them, in the tables' order."""
    derived = {name: float(value) for name, value in outcome(values).items()}
    if contact_time is not None and "P" in derived:
        derived["TF"] = contact_time
        derived |= {n: float(v) for n, v in forces(derived["P"], contact_time).items()}
    values = with_headings(values | derived)
    if "EM" in values:
        values["RR0"] = float(moment_ratio(values["EM"]))
    absent = absent_quantities(values)
    return {name: values[name] for name in _ORDER if name in values and name not in absent}


def absent_quantities(values: Mapping[str, float]) -> tuple[str, ...]:
    """Return the quantities that this impact's vehicles do not have: a rigid barrier, point
    masses."""
    # a barrier's mass is left out of the values
    barrier = _NOT_OF_BARRIERS if math.isinf(values.get("MB", math.inf)) else ()
    return (*barrier, *_NOT_OF_POINT_MASSES) if values.get("M") == 4 else barrier


def from_the_axis(name: str, value: float) -> float:
    """Return a value as it is shown: the direction opposite to the axis is 180, from either side,
    to three decimals."""
    return 180.0 if name in (*COURSES, *FORCES) and value < -179.9995 else value


def without_noise(
    values: Mapping[str, float],
    noise: float = NOISE,
    deviations: Mapping[str, float] | None = None,
) -> dict[str, float]:
    """Return ``values`` with rounding removed.

    Values below ``noise`` times the largest of their unit, and those far below their own standard
    deviation, are 0; directions of -180 are 180. A spin's size is also compared with velocities
    over the smaller radius of gyration."""
    largest: dict[str, float] = {}
    for name, value in values.items():
        if math.isfinite(value):
            unit = quantity(name).unit
            largest[unit] = max(abs(value), largest.get(unit, 0.0))
    largest["1"] = ROUNDING / noise  # pure numbers have no common size
    squared_radii = [
        values.get(inertia, math.inf) / values[mass]
        for inertia, mass in (("IA", "MA"), ("IB", "MB"))
        if values.get(mass, 0.0) > 0
    ]
    radii = [math.sqrt(square) for square in squared_radii if 0 <= square < math.inf]
    if radii and min(radii) > 0:
        # where all spins are rounding, their size is that of velocities
        spin_size = largest.get(VELOCITY, 0.0) / min(radii) * ROUNDING / noise
        largest["rad/time"] = max(largest.get("rad/time", 0.0), spin_size)
    clean = {}
    for name, value in values.items():
        small = abs(value) < noise * largest.get(quantity(name).unit, 0.0)
        small |= abs(value) < NOISE * (deviations or {}).get(name, 0.0)
        clean[name] = 0.0 if small else from_the_axis(name, value)
    return clean
