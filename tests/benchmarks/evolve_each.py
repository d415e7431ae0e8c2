"""How far each result by itself can be off, in scenes evolved for it: a family at a time.

    python tests/benchmarks/evolve_each.py barrier --seconds 60 --seed 7 [--save worst.csv]

Errors against 50 digits are counted in units of what the result's own value and its `movements`
(rounding every number of the scene) are worth: 2**-53 times their sum; with ``--bound`` as parts of
`errorbound.result_bounds`. Lineages are shared out
among the results; children are made as `evolve` makes them. Prints the worst of each result.
"""

from __future__ import annotations

import argparse
import csv
import sys
import time

import numpy as np
from evolve import child

from impact88.mechanics.accuracy.errorbound import DOUBLE, movements, result_bounds
from impact88.mechanics.accuracy.populations import POPULATIONS, scenes
from impact88.mechanics.accuracy.reference import two_doubles
from impact88.mechanics.closedform.general import quantities
from impact88.mechanics.closedform.solve import solve
from impact88.names import PIVOT, RESULTS, SCENE

NOT_MEASURED = ("STATUS", "COND", "MUP")
NAMES = tuple(name for name in RESULTS if name not in NOT_MEASURED)
LINEAGES = 6
"""Of each result."""
DECIDED = 1e-6
"""Of the speeds, what slides at least: below it rounding may decide MU's sign."""
FAMILIES = {
    "friction": [*(set(POPULATIONS) - {"barriers", "pivots", "evolved"})],
    "pivot": [*(set(POPULATIONS) - {"barriers", "evolved"})],
    "gaining_pivot": [*(set(POPULATIONS) - {"barriers", "evolved"})],
    "barrier": ["barriers"],
    "barrier_pivot": ["barriers"],
    "point": ["casework", "heavy", "extreme", "units"],
}


def start(family, size, seed, wide):
    """Scenes of a family; ``wide``: with arms and inertias of other sizes, too."""
    names = sorted(FAMILIES[family])
    parts = [scenes(name, -(-size // len(names)), seed) for name in names]
    rng = np.random.default_rng(seed)
    g = {name: np.concatenate([part[name] for part in parts]) for name in SCENE}
    order = rng.permutation(len(g["MA"]))[:size]
    g = {name: values[order] for name, values in g.items()}
    for name in ("WA", "WB"):
        g[name] = np.where(np.isinf(g[f"I{name[1]}"]), 0.0, g[name] + rng.uniform(-2, 2, size))
    if wide:
        for name in ("DA", "DB", "IA", "IB"):
            g[name] = g[name] * np.where(
                rng.random(size) < 0.5, 10.0 ** rng.uniform(-5, 5, size), 1
            )
    pivots = family.endswith("pivot")
    g["MU"] = np.full(size, PIVOT) if pivots else np.where(g["MU"] == PIVOT, 0.5, g["MU"])
    if family == "gaining_pivot":
        g["EM"] = above_half(g["EM"])
    if family == "point":
        g["M"] = np.full(size, 4.0)
    return g


def above_half(em):
    """EM above 1/2, where 1 - 2 EM is negative and a pivot may gain energy."""
    return 0.5 + np.abs(em - 0.5)


def units(g, of_bound):
    """(scene, result) -> error in units, or as part of its bound; 0 where it says nothing."""
    with np.errstate(all="ignore"):
        hi, lo = two_doubles(g, NAMES)
        found = solve(g, NAMES)
        moved, bounds = ({}, result_bounds(g)) if of_bound else (movements(g, NAMES), {})
        slides = np.abs(quantities(g, ("gt",))["gt"])
    speeds = sum(np.abs(g[name]) for name in ("UX", "UY", "VX", "VY"))
    speeds = speeds + g["DA"] * np.abs(g["WA"]) + g["DB"] * np.abs(g["WB"])
    decided = (slides > DECIDED * speeds) | (g["MU"] == PIVOT)
    each = np.zeros(hi.shape)
    for j, name in enumerate(NAMES):
        with np.errstate(all="ignore"):
            error = np.abs((found[name] - hi[:, j]) - lo[:, j])
            size = bounds[name] if of_bound else DOUBLE * (moved[name] + np.abs(hi[:, j]))
            unit = np.where(error == 0, 0.0, error / size)
        each[:, j] = np.where(np.isfinite(unit) & decided, unit, 0.0)
    return each


def bred(g, rng, size, family):
    """Children that are still of the family: an infinite body stays, and stays at rest."""
    made = child(g, rng, size)
    for body, speeds in (("A", ("UX", "UY")), ("B", ("VX", "VY"))):
        for inertia, still in ((f"M{body}", speeds), (f"I{body}", (f"W{body}",))):
            fixed = np.isinf(g[inertia])
            made[inertia] = np.where(fixed, np.inf, made[inertia])
            for name in still:
                made[name] = np.where(fixed, 0.0, made[name])
    made["M"], slides = g["M"], g["MU"] != PIVOT
    made["MU"] = np.where(slides, np.where(made["MU"] == PIVOT, 0.5, made["MU"]), PIVOT)
    if family == "gaining_pivot":
        made["EM"] = above_half(made["EM"])
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("family", choices=FAMILIES)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--wide", action="store_true", help="arms and inertias of all sizes, too")
    parser.add_argument("--bound", action="store_true", help="as parts of `result_bounds`")
    parser.add_argument("--save", help="a CSV file for the worst scene of each result")
    options = parser.parse_args()
    size = LINEAGES * len(NAMES)
    rng = np.random.default_rng(options.seed)
    own = np.arange(size), np.repeat(np.arange(len(NAMES)), LINEAGES)
    best = start(options.family, size, options.seed, options.wide)
    fit = units(best, options.bound)[own]
    began, generations = time.process_time(), 0
    while time.process_time() - began < options.seconds:
        tried = bred(best, rng, size, options.family)
        new = units(tried, options.bound)[own]
        better = new > fit
        fit = np.where(better, new, fit)
        best = {name: np.where(better, tried[name], best[name]) for name in SCENE}
        generations += 1
    worst = fit.reshape(len(NAMES), LINEAGES)
    print(f"{options.family}: {generations} generations of {size}, seed {options.seed}")
    for name, row in sorted(zip(NAMES, worst, strict=True), key=lambda pair: -pair[1].max()):
        print(f"  {name:5} {row.max():10.3f}  median of lineages {np.median(row):8.3f}")
    if options.save:
        with open(options.save, "w", newline="") as file:
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow(["result", "units", *SCENE])
            for j, row in enumerate(worst):
                place = j * LINEAGES + int(row.argmax())
                values = [repr(float(best[name][place])) for name in SCENE]
                rows.writerow([NAMES[j], f"{fit[place]:.3g}", *values])
    sys.stdout.flush()


if __name__ == "__main__":
    main()
