"""Populations of scenes to measure on: seeded, named, each with what makes it hard.

Every number is given with six significant decimal digits, as a person would type it (a few that
must be exact to be hard have more), so that the same scene can be typed into the 1988 program:
`texts` gives the decimal texts.
"""

import csv
from collections.abc import Callable
from functools import cache
from importlib import resources
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..closedform.degrees import sin_cos

Floats = NDArray[np.float64]
Columns = dict[str, Floats]
Generator = np.random.Generator

_rounded_to_six = np.vectorize(lambda x: float(f"{x:.5e}"), otypes=[np.float64])


class Population(NamedTuple):
    """``level``: how hard, by the condition number of its equations: easy (below about 100),
    average (to about 1e6) or hard. ``listing``: whether the 1988 program can be given its scenes
    (no infinite body, numbers within Applesoft's range)."""

    name: str
    level: str
    meaning: str
    make: Callable[[Generator, int], Columns]
    listing: bool = True


def texts(columns: Columns) -> dict[str, list[str]]:
    """The decimal texts of the numbers, short enough to be typed."""
    return {
        name: [repr(x).removesuffix(".0").upper() for x in values.tolist()]
        for name, values in columns.items()
    }


def scenes(name: str, count: int, seed: int) -> Columns:
    """``count`` scenes of a population; the same for the same seed."""
    population = POPULATIONS[name]
    rng = np.random.default_rng([seed, *name.encode()])
    return population.make(rng, count)


def casework(rng: Generator, count: int) -> Columns:
    """Cars as in the chapter's Table 1, feet and slugs."""

    def spread(low: float, high: float) -> Floats:
        result: Floats = _rounded_to_six(rng.uniform(low, high, count))
        return result

    def spin() -> Floats:
        return np.where(rng.random(count) < 0.5, 0.0, spread(-2, 2))

    return {
        "E": spread(0, 0.4),
        "MU": spread(-1, 1),
        "EM": spread(-1, 0),
        "DA": spread(0.5, 9),
        "DB": spread(0.5, 9),
        "GA": spread(-90, 90),
        "PA": spread(-180, 180),
        "PB": spread(-180, 180),
        "TA": spread(-180, 180),
        "TB": spread(-180, 180),
        "MA": spread(60, 200),
        "MB": spread(60, 200),
        "IA": spread(900, 5000),
        "IB": spread(900, 5000),
        "UX": spread(-90, 90),
        "UY": spread(-90, 90),
        "WA": spin(),
        "VX": spread(-90, 90),
        "VY": spread(-90, 90),
        "WB": spin(),
        "M": np.full(count, 6.0),
    }


def _powers(rng: Generator, low: float, high: float, count: int) -> Floats:
    return 10 ** rng.uniform(low, high, count)


def heavy(rng: Generator, count: int) -> Columns:
    g = casework(rng, count)
    ratio = _powers(rng, 1, 12, count)
    return {**g, "MB": _rounded_to_six(g["MA"] * ratio), "IB": _rounded_to_six(g["IA"] * ratio)}


def near_singular(rng: Generator, count: int) -> Columns:
    """MU within 1e-1 to 1e-9 of -Knn/Knt, where friction has no solution."""
    g = casework(rng, 4 * count)
    s, c = sin_cos(g["GA"])
    arms = []
    for d, phi, theta in (("DA", "PA", "TA"), ("DB", "PB", "TB")):
        sine, cosine = sin_cos(g[theta] + g[phi] - g["GA"])
        arms.append((g[d] * sine, -g[d] * cosine))
    (an, at), (bn, bt) = arms
    IA, IB, em = g["IA"], g["IB"], g["EM"]
    L, reduced = -em / (1 - 2 * em), IA * IB / (IA + IB)
    kn, kt = an / IA - bn / IB, at / IA - bt / IB
    Knn = 1 / g["MA"] + 1 / g["MB"] + (an + bn) ** 2 / (IA + IB) + L * reduced * kn * kn
    Knt = (an + bn) * (at + bt) / (IA + IB) + L * reduced * kn * kt
    gt = c * (g["UY"] - g["VY"]) - s * (g["UX"] - g["VX"]) + at * g["WA"] + bt * g["WB"]
    critical = -Knn / Knt
    near = 1 + _powers(rng, -9, -1, 4 * count) * rng.choice([-1, 1], 4 * count)
    g["MU"] = np.where(gt > 0, -critical, critical) * near
    usable = np.flatnonzero(np.abs(critical) < 9)[:count]
    if len(usable) < count:  # pragma: no cover - a quarter of all scenes would have to be usable
        usable = np.resize(usable, count)
    return {name: values[usable] for name, values in g.items()}


def units(rng: Generator, count: int) -> Columns:
    """Casework in other units: lengths of 1e-6 to 1e6, masses of 1e-9 to 1e9, times of 1e±3."""
    g = casework(rng, count)
    length, mass = _powers(rng, -6, 6, count), _powers(rng, -9, 9, count)
    time = _powers(rng, -3, 3, count)
    by = {
        **dict.fromkeys(("DA", "DB"), length),
        **dict.fromkeys(("MA", "MB"), mass),
        **dict.fromkeys(("IA", "IB"), mass * length**2),
        **dict.fromkeys(("UX", "UY", "VX", "VY"), length / time),
        **dict.fromkeys(("WA", "WB"), 1 / time),
    }
    return {name: _rounded_to_six(v * by[name]) if name in by else v for name, v in g.items()}


def tangential(rng: Generator, count: int) -> Columns:
    """Sideswipes: the approach is 1e-2 to 1e-9 of the sliding, along a surface at GA."""
    g = casework(rng, count)
    s, c = sin_cos(g["GA"])
    sliding = rng.uniform(20, 120, count) * rng.choice([-1, 1], count)
    approach = -np.abs(sliding) * _powers(rng, -9, -2, count)
    zero = np.zeros(count)
    return {
        **g,
        "WA": zero,
        "WB": zero,
        "UX": g["VX"] + c * approach - s * sliding,
        "UY": g["VY"] + s * approach + c * sliding,
    }


def cancelling(rng: Generator, count: int) -> Columns:
    """gn = 0 but for rounding and 1e-1 to 1e-15 of its largest part: spins undo the approach."""
    g = casework(rng, count)
    s, c = sin_cos(g["GA"])
    sine, _ = sin_cos(g["TA"] + g["PA"] - g["GA"])
    arm = g["DA"] * np.where(np.abs(sine) < 0.1, 0.1, sine)
    sine_b, _ = sin_cos(g["TB"] + g["PB"] - g["GA"])
    rest = c * (g["UX"] - g["VX"]) + s * (g["UY"] - g["VY"]) + g["DB"] * sine_b * g["WB"]
    return {**g, "WA": -rest / arm * (1 + _powers(rng, -15, -1, count))}


def em_half(rng: Generator, count: int) -> Columns:
    """EM within 1e-1 to 1e-16 of 1/2, and 1/2 itself."""
    g = casework(rng, count)
    away = _powers(rng, -16, -1, count) * rng.choice([-1, 0, 1], count)
    return {**g, "EM": 0.5 + away}


def extreme(rng: Generator, count: int) -> Columns:
    """Masses and inertias each anywhere from 1e-9 to 1e15, unrelated."""
    g = casework(rng, count)
    for name in ("MA", "MB", "IA", "IB"):
        g[name] = _rounded_to_six(_powers(rng, -9, 15, count))
    return g


def barriers(rng: Generator, count: int) -> Columns:
    """One body infinite: in mass and inertia, or in one of them, and at rest in it."""
    g = casework(rng, count)
    which = rng.integers(0, 3, count)
    is_b = rng.random(count) < 0.5
    bodies = {"A": ("MA", "IA", "UX", "UY", "WA"), "B": ("MB", "IB", "VX", "VY", "WB")}
    for name, (mass, inertia, vx, vy, spin) in bodies.items():
        body = is_b if name == "B" else ~is_b
        no_shift, no_turn = body & (which != 1), body & (which != 2)
        g[mass] = np.where(no_shift, np.inf, g[mass])
        g[inertia] = np.where(no_turn, np.inf, g[inertia])
        for velocity in (vx, vy):
            g[velocity] = np.where(no_shift, 0.0, g[velocity])
        g[spin] = np.where(no_turn, 0.0, g[spin])
    return g


def quarter_turns(rng: Generator, count: int) -> Columns:
    """All angles multiples of 90 degrees."""
    g = casework(rng, count)
    for name in ("GA", "PA", "PB", "TA", "TB"):
        g[name] = np.multiply(90.0, rng.integers(-8, 9, count), dtype=np.float64)
    return g


def pivots(rng: Generator, count: int) -> Columns:
    """Casework and extreme masses, all pivots."""
    g = casework(rng, count)
    other = extreme(rng, count)
    hard = rng.random(count) < 0.5
    for name in ("MA", "MB", "IA", "IB"):
        g[name] = np.where(hard, other[name], g[name])
    return {**g, "MU": np.full(count, -10.0)}


@cache
def _evolved() -> Columns:
    text = resources.files(__package__).joinpath("evolved.csv").read_text("ascii")
    names, *rows = csv.reader(text.splitlines())
    return dict(zip(names, np.array(rows, np.float64).T, strict=True))


def evolved(rng: Generator, count: int) -> Columns:
    """What tests/benchmarks/evolve.py found, in some order, again and again."""
    found = _evolved()
    order = np.resize(rng.permutation(len(found["M"])), count)
    return {name: values[order] for name, values in found.items()}


POPULATIONS: dict[str, Population] = {
    population.name: population
    for population in (
        Population("casework", "easy", "cars as in the chapter's Table 1", casework),
        Population("heavy", "easy", "a moving B, to 1e12 times heavier than A", heavy),
        Population("singular", "hard", "friction within 1e-1 to 1e-9 of singular", near_singular),
        Population("units", "average", "the same cars in tiny and huge units", units),
        Population("tangential", "easy", "approach 1e-2 to 1e-9 of the sliding", tangential),
        Population("cancelling", "easy", "gn nearly 0: spins undo the approach", cancelling),
        Population("em-half", "average", "EM within 1e-1 to 1e-16 of 1/2", em_half),
        Population(
            "extreme", "average", "masses, inertias 1e-9 to 1e15, unrelated", extreme, False
        ),
        Population("barriers", "easy", "one body infinite and at rest", barriers, False),
        Population("quarter-turns", "easy", "all angles multiples of 90 degrees", quarter_turns),
        Population("evolved", "easy", "evolved to have large errors", evolved, False),
        Population("pivots", "average", "pivots, half of them of extreme masses", pivots, False),
    )
}
"""Name -> population, the ones the benchmark uses by default first."""
BENCHMARK = ("casework", "heavy", "singular", "units", "tangential")
"""The populations of the benchmark's table."""
