"""Collisions for tests: random possible impacts, and the files of the guide."""

from functools import cache

import numpy as np

from impact88.mechanics.inverse import complete
from impact88.mechanics.laws import margins
from impact88.mechanics.solve import evaluate
from impact88.names import FINAL_STATE, VELOCITIES
from impact88.reconstruction.answer import reconstruct

UNKNOWNS = (*VELOCITIES, *FINAL_STATE, "E", "MUP", "EM")
VEHICLES = ("MA", "MB", "IA", "IB", "DA", "DB", "PA", "PB", "TA", "TB", "GA")
SECTION_VII = {
    "MA": 96,
    "MB": 145,
    "IA": 1970,
    "IB": 3770,
    "DA": 4.5,
    "DB": 4,
    "GA": 0,
    "PA": 0,
    "PB": -40,
    "TA": 0,
    "TB": 90,
    "UY": 0,
    "VX": 0,
    "VAX": "-10 +- 2",
    "VAY": "20 +- 2",
    "VBX": "-20 +- 2",
    "VBY": "45 +- 2",
}
REAR_END = {"M": 4, "MA": 950, "MB": 770, "SA": 5.5, "HA": 0, "SB": 0, "E": 0.2}
RECORDER = {
    "M": 4,
    "MA": 950,
    "MB": 770,
    "SA": "5.5 +- .2",
    "HA": 0,
    "SB": 0,
    "DVA": "3.1 +- .3",
    "DVB": "3.5 +- .3",
}
INTERSECTION = {
    "M": 4,
    "MA": 1800,
    "MB": 1200,
    "HA": 0,
    "HB": -90,
    "SAF": 50,
    "HAF": -40,
    "SBF": 30,
    "HBF": -30,
}


@cache
def section_vii():
    """Return the reconstruction of Section VII with draws."""
    return reconstruct(SECTION_VII, samples=4000)[0]


def random_impact(rng):
    """Return the vehicles and all velocities and coefficients of an impact within physics."""
    while True:
        vehicles = _vehicles(rng)
        entries = {**vehicles, **_motion(rng, vehicles)}
        critical = float(evaluate(complete({**entries, "MUP": 0.0}).values, ("MUC",))[0]["MUC"])
        if not abs(critical) < 5:
            continue
        impact = complete({**entries, "MUP": critical * rng.uniform(0.1, 1.0)}).values
        if min(float(row) for rows in margins(impact).values() for row in rows) > 1e-3:
            return vehicles, {name: float(impact[name]) for name in UNKNOWNS}


def _vehicles(rng):
    while True:
        v = {name: rng.uniform(60, 180) for name in ("MA", "MB")}
        v |= {"I" + x: v["M" + x] * rng.uniform(15, 28) for x in "AB"}
        v |= {"DA": rng.uniform(2, 9), "DB": rng.uniform(2, 9)}
        v |= {"PA": rng.uniform(-40, 40), "PB": rng.uniform(-90, 90)}
        v |= {name: rng.uniform(-180, 180) for name in ("TA", "TB")}
        v["GA"] = v["TA"] + v["PA"] + rng.uniform(-50, 50)
        if np.cos(np.radians(v["TB"] + v["PB"] - v["GA"])) > 0.2:
            return v


def _motion(rng, vehicles):
    motion = {"E": rng.uniform(0.02, 0.5), "EM": rng.uniform(-0.95, -0.05)}
    for x, y, spin, course in (
        ("UX", "UY", "WA", vehicles["TA"] + 180),
        ("VX", "VY", "WB", vehicles["TB"]),
    ):
        speed, angle = rng.uniform(15, 80), np.radians(course + rng.uniform(-15, 15))
        motion |= {x: speed * np.cos(angle), y: speed * np.sin(angle)}
        motion[spin] = rng.choice([0.0, rng.normal(0, 0.5)])
    return motion
