"""Scenes as hard for the closed form as evolution makes them:
port/impact88/mechanics/accuracy/evolved.csv.

    python tests/benchmarks/evolve.py [--lineages 48] [--generations 150] | head -25 > evolved.csv

Every lineage starts from a scene of some population. A child has some numbers changed: by a
factor, in the last digits, to a neighbour's, to a quarter turn. It takes its parent's place where
its largest error, relative to what rounding its numbers does, is larger. Scenes in which rounding
decides the sign of the sliding, and with it of MU, are none: there no error is bounded.
"""

from __future__ import annotations

import argparse
import csv
import sys

import numpy as np

from impact88.bench.methods import relative_errors
from impact88.mechanics.accuracy.errorbound import sensitivity
from impact88.mechanics.accuracy.populations import POPULATIONS, scenes
from impact88.mechanics.accuracy.reference import two_doubles
from impact88.mechanics.closedform.general import quantities
from impact88.mechanics.closedform.solve import solve
from impact88.names import FINAL_VELOCITIES, SCENE

ANGLES = ("GA", "PA", "PB", "TA", "TB")
POSITIVE = ("MA", "MB", "IA", "IB", "DA", "DB")


def fitness(columns):
    """The largest error of each scene, in roundings of all its numbers; 0 where there is none."""
    hi, lo = two_doubles(columns)
    found = solve(columns, FINAL_VELOCITIES)
    error = relative_errors(np.stack([found[name] for name in FINAL_VELOCITIES], axis=1), hi, lo)
    fit = error / (sensitivity(columns) * 2.0**-53)
    speeds = sum(np.abs(columns[name]) for name in ("UX", "UY", "VX", "VY"))
    speeds = speeds + columns["DA"] * np.abs(columns["WA"]) + columns["DB"] * np.abs(columns["WB"])
    slides = np.abs(quantities(columns, ("gt",))["gt"]) > 1e-6 * speeds
    decided = slides | (columns["MU"] == -10)
    return np.where(np.isfinite(fit) & decided, fit, 0.0)


def child(columns, rng, size):
    made = {}
    for name, values in columns.items():
        changed = rng.random(size) < 0.2
        kind = rng.integers(0, 4, size)
        by_factor = values * 10 ** rng.normal(0, 0.5, size)
        in_last = values * (1 + rng.normal(0, 1, size) * 10 ** rng.uniform(-15, -3, size))
        others = values[rng.permutation(size)]
        special = rng.integers(-4, 5, size) * 90.0 if name in ANGLES else np.round(values)
        new = np.choose(kind, [by_factor, in_last, others, special])
        if name == "M":
            new = values
        if name in POSITIVE:
            new = np.clip(np.abs(new), 1e-9, 1e15)
        made[name] = np.where(changed, new, values)
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--lineages", type=int, default=48)
    parser.add_argument("--generations", type=int, default=150)
    options = parser.parse_args()
    rng = np.random.default_rng(1988)
    size = options.lineages
    names = [name for name in POPULATIONS if name not in ("barriers", "evolved")]
    parts = [scenes(name, -(-size // len(names)), 1988) for name in names]
    best = {name: np.concatenate([part[name] for part in parts])[:size] for name in SCENE}
    fit = fitness(best)
    for generation in range(options.generations):
        tried = child(best, rng, size)
        new = fitness(tried)
        better = new > fit
        fit = np.where(better, new, fit)
        best = {name: np.where(better, tried[name], best[name]) for name in SCENE}
        if generation % 10 == 0:
            print(generation, np.median(fit).round(2), fit.max().round(2), file=sys.stderr)
    rows = csv.writer(sys.stdout, lineterminator="\n")
    rows.writerow(SCENE)
    for place in np.argsort(-fit):
        rows.writerow([repr(float(best[name][place])) for name in SCENE])


if __name__ == "__main__":
    main()
