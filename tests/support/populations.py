"""Populations of scenes to measure on: seeded, named, each with what makes it hard. Numbers have
six significant digits, as typed (a few that must be exact to be hard have more)."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from impact88.mechanics.solve import evaluate

Floats = NDArray[np.float64]
Columns = dict[str, Floats]
Generator = np.random.Generator
Maker = Callable[[Generator, int], Columns]

_rounded_to_six = np.vectorize(lambda x: float(f"{x:.5e}"), otypes=[np.float64])


class Population(NamedTuple):
    """``level``: how hard, by the condition number of its equations: easy (below about 100),
    average (to about 1e6) or hard. ``listing``: whether the 1988 program can be given its scenes
    (no infinite body, numbers within Applesoft's range)."""

    name: str
    level: str
    meaning: str
    make: Maker
    listing: bool


POPULATIONS: dict[str, Population] = {}
"""Name -> population."""
BENCHMARK = ("casework", "heavy", "singular", "units", "tangential")
"""The populations of the benchmark's table."""


def _population(level: str, meaning: str, listing: bool = True) -> Callable[[Maker], Maker]:
    def register(make: Maker) -> Maker:
        name = make.__name__.replace("_", "-")
        POPULATIONS[name] = Population(name, level, meaning, make, listing)
        return make

    return register


def texts(columns: Columns) -> dict[str, list[str]]:
    """Return the decimal texts of the numbers, short enough to be typed."""
    return {
        name: [repr(x).removesuffix(".0").upper() for x in values.tolist()]
        for name, values in columns.items()
    }


def scenes(name: str, count: int, seed: int) -> Columns:
    """Return ``count`` scenes of a population; the same for the same seed."""
    return POPULATIONS[name].make(np.random.default_rng([seed, *name.encode()]), count)


def repeat_scenes(columns: Columns, count: int) -> Columns:
    """Return ``count`` scenes: these, repeated."""
    return {name: np.resize(values, count) for name, values in columns.items()}


@_population("easy", "cars as in the chapter's Table 1")
def casework(rng: Generator, count: int) -> Columns:
    def spread(low: float, high: float) -> Floats:
        result: Floats = _rounded_to_six(rng.uniform(low, high, count))
        return result

    limits = {
        "E": (0, 0.4),
        "MU": (-1, 1),
        "EM": (-1, 0),
        "DA": (0.5, 9),
        "DB": (0.5, 9),
        "GA": (-90, 90),
        **dict.fromkeys(("PA", "PB", "TA", "TB"), (-180, 180)),
        "MA": (60, 200),
        "MB": (60, 200),
        "IA": (900, 5000),
        "IB": (900, 5000),
        "UX": (-90, 90),
        "UY": (-90, 90),
        "WA": (-2, 2),
        "VX": (-90, 90),
        "VY": (-90, 90),
        "WB": (-2, 2),
    }
    g = {}
    for name, ends in limits.items():
        still = rng.random(count) < 0.5 if name in ("WA", "WB") else False
        g[name] = np.where(still, 0.0, spread(*ends))
    return {**g, "M": np.full(count, 6.0)}


def _quantity(columns: Columns, name: str) -> Floats:
    """Return a quantity of `mechanics.formulas`."""
    return evaluate(columns, (name,))[0][name]


def _powers(rng: Generator, low: float, high: float, count: int) -> Floats:
    return 10 ** rng.uniform(low, high, count)


@_population("easy", "a moving B, to 1e12 times heavier than A")
def heavy(rng: Generator, count: int) -> Columns:
    g = casework(rng, count)
    ratio = _powers(rng, 1, 12, count)
    return {**g, "MB": _rounded_to_six(g["MA"] * ratio), "IB": _rounded_to_six(g["IA"] * ratio)}


@_population("hard", "friction within 1e-1 to 1e-9 of singular")
def singular(rng: Generator, count: int) -> Columns:
    g = casework(rng, 4 * count)
    # the determinant is linear in MU
    at_0, at_1 = (_quantity({**g, "MUP": np.full(4 * count, mu)}, "D_s") for mu in (0.0, 1.0))
    critical = at_0 / (at_0 - at_1)
    factor = 1 + _powers(rng, -9, -1, 4 * count) * rng.choice([-1, 1], 4 * count)
    g["MU"] = np.where(_quantity(g, "gt") > 0, -critical, critical) * factor
    usable = np.resize(np.flatnonzero(np.abs(critical) < 9), count)  # some three in four are
    return {name: values[usable] for name, values in g.items()}


@_population("average", "the same cars in tiny and huge units")
def units(rng: Generator, count: int) -> Columns:
    """Lengths of 1e-6 to 1e6, masses of 1e-9 to 1e9, times of 1e±3."""
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


@_population("easy", "approach 1e-2 to 1e-9 of the sliding")
def tangential(rng: Generator, count: int) -> Columns:
    g = casework(rng, count)
    s, c = _quantity(g, "s"), _quantity(g, "c")
    sliding = rng.uniform(20, 120, count) * rng.choice([-1, 1], count)
    approach = -np.abs(sliding) * _powers(rng, -9, -2, count)
    g["WA"] = g["WB"] = np.zeros(count)
    g["UX"] = g["VX"] + c * approach - s * sliding
    g["UY"] = g["VY"] + s * approach + c * sliding
    return g


@_population("easy", "gn nearly 0: spins undo the approach")
def cancelling(rng: Generator, count: int) -> Columns:
    """gn = 0 but for rounding and 1e-1 to 1e-15 of its largest part."""
    g = casework(rng, count)
    arm = _quantity(g, "an")
    arm = np.where(np.abs(arm) < 0.1 * g["DA"], 0.1 * g["DA"], arm)
    slip = _quantity({**g, "WA": np.zeros(count)}, "gn")
    return {**g, "WA": -slip / arm * (1 + _powers(rng, -15, -1, count))}


@_population("average", "EM within 1e-1 to 1e-16 of 1/2")
def em_half(rng: Generator, count: int) -> Columns:
    g = casework(rng, count)
    away = _powers(rng, -16, -1, count) * rng.choice([-1, 0, 1], count)
    return {**g, "EM": 0.5 + away}


@_population("average", "masses, inertias 1e-9 to 1e15, unrelated", listing=False)
def extreme(rng: Generator, count: int) -> Columns:
    g = casework(rng, count)
    for name in ("MA", "MB", "IA", "IB"):
        g[name] = _rounded_to_six(_powers(rng, -9, 15, count))
    return g


@_population("easy", "one body infinite and at rest", listing=False)
def barriers(rng: Generator, count: int) -> Columns:
    """Infinite in mass and inertia, or in one of them, and at rest in it."""
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


@_population("easy", "all angles multiples of 90 degrees")
def quarter_turns(rng: Generator, count: int) -> Columns:
    g = casework(rng, count)
    for name in ("GA", "PA", "PB", "TA", "TB"):
        g[name] = np.multiply(90.0, rng.integers(-8, 9, count), dtype=np.float64)
    return g


@_population("average", "pivots, half of them of extreme masses", listing=False)
def pivots(rng: Generator, count: int) -> Columns:
    g = casework(rng, count)
    scenes = extreme(rng, count)
    hard = rng.random(count) < 0.5
    for name in ("MA", "MB", "IA", "IB"):
        g[name] = np.where(hard, scenes[name], g[name])
    return {**g, "MU": np.full(count, -10.0)}
