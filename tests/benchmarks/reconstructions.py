"""Draws, bounds and processor time of forty reconstructions, against an independent sampler.

    PYTHONPATH=tests/support python tests/benchmarks/reconstructions.py [--time] [--to FILE]

Eight fresh problems of each kind of given (`impactsampler.problem`), seeds fixed: a true impact
that physics allows, measured with noise. For UX, UY, VX, VY, DVA and LOSS the draws that
`impact88 reconstruct` takes are compared with importance sampling that shares no code with them:
90 % widths as a ratio, medians in standard deviations. Every draw, and every impact at which a
bound lies, is judged by the independent rules; a bound that a weighted impact of the judge exceeds
is told. Processor time is that of the whole reconstruction. ``--time``: without the judge.
``--to``: write what was found as JSON, to be compared with another day's.
"""

from __future__ import annotations

import argparse
import json
import sys
import time

import numpy as np
from impactsampler import BEFORE, KINDS, problem, quantiles

from impact88.casework.reconstruction import drawsandbounds
from impact88.casework.reconstruction.adjustment import reconstruct
from impact88.casework.reconstruction.answer import Answer
from impact88.casework.reconstruction.posterior import Posterior
from impact88.collision.uncertain import read

SEEDS = range(101, 109)
DRAWS = 20_000  # those of `impact88 reconstruct`
JUDGED = ("UX", "UY", "VX", "VY", "DVA", "LOSS")
NINE = (*BEFORE, "E", "EM", "MUP")
MOST_WIDTH = (0.9, 1.1)
MOST_MEDIAN = 0.15  # standard deviations
LEAST_JUDGE = 1500.0  # effective impacts of the judge
NEIGHBOURS = 10  # draws beside a bound
INWARDS = (1e-6, 1e-4)  # of the distance to them
AT_LIMIT = 1e-6  # of a limit's half-width, by rounding


ENDS = []
"""Points and branches at which the bounds of the last reconstruction lie."""


def find_extremes(region, *given):
    """`search.find_extremes`, which keeps where the extremes lie."""
    found = SEARCH(region, *given)
    u = found.at.reshape(-1, found.at.shape[-1])
    ENDS[:] = region.points(u), found.states[0].ravel().astype(np.int64)
    return found


SEARCH, drawsandbounds.find_extremes = drawsandbounds.find_extremes, find_extremes


def found(given):
    """The reconstruction as the command makes it, and its processor time."""
    known = {n: read(v.text(), n) for n, v in given.known.items()} | {"M": read("6", "M")}
    started = time.process_time()
    first, *more = reconstruct(known)
    best = Answer(first, DRAWS)
    for other in more:
        Answer(other, DRAWS, like=best)
    return best, time.process_time() - started


def outside(given, points):
    """How many impacts (nine numbers by name) the independent rules do not admit."""
    theta = np.array([points[n] for n in given.open])
    _, _, beyond, ok = given.terms(theta)
    return int((~(ok & (np.sqrt(beyond) < AT_LIMIT))).sum())


def ends_outside(given, ends, draws):
    """How many impacts at which bounds lie (nine numbers, n) are not admitted: they meet all
    limits, and beside them, towards one of the nearest draws, is an impact that physics allows."""

    def terms(points):
        named = dict(zip(NINE, points, strict=True))
        return given.terms(np.array([named[n] for n in given.open]))

    scale = draws.std(axis=1)[:, None, None] + 1e-12
    distance = np.square((ends[:, :, None] - draws[:, None]) / scale).sum(axis=0)
    _, _, beyond, is_admitted = terms(ends)
    for neighbour in np.argsort(distance, axis=1)[:, :NEIGHBOURS].T:
        for part in INWARDS:
            is_admitted = is_admitted | terms(ends + part * (draws[:, neighbour] - ends))[3]
    return int((~(is_admitted & (np.sqrt(beyond) < AT_LIMIT))).sum())


def compared(given, best):
    """The worst width ratio, the worst distance of medians, draws outside, bounds exceeded."""
    own, weights, effective = given.sample(60_000, np.random.default_rng(3))
    posterior = Posterior(best.solution)
    sample = best.draws.sample
    values = posterior.values(sample.points, sample.branches, NINE)
    report = {"judge": effective, "outside": outside(given, dict(zip(NINE, values, strict=True)))}
    # at a closing speed of 0 the nine numbers are quotients of rounding
    closing = posterior.values(*ENDS, ["VC"])[0] > AT_LIMIT * best.solution.system.speed
    ends = posterior.values(*ENDS, NINE)[:, closing]
    report["outside"] += ends_outside(given, ends, values[:, ::10])
    ratios, medians, exceeded = {}, {}, {}
    drawn = posterior.values(sample.points, sample.branches, JUDGED)
    for name, row in zip(JUDGED, drawn, strict=True):
        low, middle, high = quantiles(own[name], weights, (0.05, 0.5, 0.95))
        mean = np.average(own[name], weights=weights)
        deviation = np.average(np.square(own[name] - mean), weights=weights) ** 0.5
        ours = np.quantile(row, (0.05, 0.5, 0.95))
        ratios[name] = float((ours[2] - ours[0]) / (high - low))
        medians[name] = float((ours[1] - middle) / deviation)
        if name not in best.ranges:
            continue
        bound, met = best.ranges[name], own[name][weights > 0]
        width = bound.upper - bound.lower
        beyond = max(bound.lower - met.min(), met.max() - bound.upper, 0.0) / width
        if beyond > AT_LIMIT:
            exceeded[name] = float(beyond)
    return report | {"ratios": ratios, "medians": medians, "exceeded": exceeded}


def is_met(row):
    low, high = MOST_WIDTH
    return (
        all(low <= x <= high for x in row["ratios"].values())
        and all(abs(x) <= MOST_MEDIAN for x in row["medians"].values())
        and not row["outside"]
        and not row["exceeded"]
    )


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--time", action="store_true")
    parser.add_argument("--to")
    args = parser.parse_args()
    rows, times, missed, undecided = [], [], 0, 0
    for kind in KINDS:
        for seed in SEEDS:
            given = problem(kind, seed)
            best, seconds = found(given)
            times.append(seconds)
            row = {"kind": kind, "seed": seed, "seconds": seconds, "single": best.draws is not None}
            row["ranges"] = {n: (r.lower, r.upper, r.searched) for n, r in best.ranges.items()}
            if best.draws is not None:
                row["effective"] = best.draws.effective
            text = ""
            if not args.time and best.draws is not None:
                row |= compared(given, best)
                widths, medians = row["ratios"].values(), row["medians"].values()
                text = (
                    f"widths {min(widths):.3f} to {max(widths):.3f}, medians within "
                    f"{max(map(abs, medians)):.3f}, judge {row['judge']:.0f}, "
                    f"outside {row['outside']}, exceeded {row['exceeded']}"
                )
                if row["judge"] < LEAST_JUDGE:
                    undecided += 1
                elif not is_met(row):
                    missed, text = missed + 1, f"{text} MISSED"
            effective = row.get("effective", float("nan"))
            print(
                f"{kind:7} {seed} {seconds:6.2f} s  effective {effective:6.0f}  {text}", flush=True
            )
            rows.append(row)
    print(f"processor time: median {np.median(times):.2f} s, longest {max(times):.2f} s")
    print(f"without draws {sum(not r['single'] for r in rows)} of {len(rows)}")
    if not args.time:
        print(f"missed {missed}; {undecided} undecided: the judge's impacts were too few")
    if args.to:
        with open(args.to, "w", encoding="utf-8") as file:
            json.dump(rows, file)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
