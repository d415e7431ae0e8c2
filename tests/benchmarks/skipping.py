"""What every way of asking costs, relative to the six velocities of the plain scene.

    python tests/benchmarks/skipping.py [--scenes 16384] [--rounds 3] [--constants none,MU=0]
        [--save ratios.csv]

For constants of a scene, results asked for, shares of pivots and scenes that cannot be used: the
median of the rounds of processor time, each between two times of the six in the same run, all in
arrays given by ``out=``, warmed up, in an order drawn anew.
"""

from __future__ import annotations

import argparse
import csv
import time

import numpy as np

from impact88 import solve
from impact88.mechanics.accuracy.populations import scenes
from impact88.names import FINAL_VELOCITIES, PIVOT, RESULTS

BARS = (1.05, 1.25, 1.5)
CONSTANTS = {
    "none": {},
    **{f"{name}=0": {name: 0.0} for name in ("MU", "E", "EM", "GA", "WB", "DA", "DB")},
    **{f"{name}=1": {name: 1.0} for name in ("EM", "E")},
    **{"MU=.5": {"MU": 0.5}, "E=.1": {"E": 0.1}, "GA=30": {"GA": 30.0}, "M=4": {"M": 4.0}},
    **{"spins=0": {"WA": 0.0, "WB": 0.0}, "arms=0": {"DA": 0.0, "DB": 0.0}},
    **{"V=0": {"VX": 0.0, "VY": 0.0}, "pivot": {"MU": PIVOT}},
    "barrier": {"MB": np.inf, "IB": np.inf, "VX": 0.0, "VY": 0.0, "WB": 0.0},
    "inertias": {"MA": 100.0, "MB": 120.0, "IA": 2e3, "IB": 3e3},
    "angles": {"GA": 30.0, "PA": 10.0, "PB": 20.0, "TA": 0.0, "TB": 90.0},
}
SETS = {
    "six": tuple(FINAL_VELOCITIES),
    **{name: (name,) for name in RESULTS},
    "DVA,LOSS,STATUS": ("DVA", "LOSS", "STATUS"),
    "all": tuple(RESULTS),
}
PIVOTS, UNUSABLE = (0, 10, 50), (0, 1)
"""Percent; scenes."""


class Scenes:
    """A plain population, and what becomes of it."""

    def __init__(self, count):
        rng = np.random.default_rng(5)
        self.plain = {**scenes("casework", count, 3), "M": 6.0}
        for name in ("WA", "WB"):
            self.plain[name] = rng.uniform(-2, 2, count)
        drawn, mu = rng.random(count), self.plain["MU"]
        self._mu = {share: np.where(drawn < share / 100, PIVOT, mu) for share in PIVOTS}
        self._unusable = {}
        for name in ("UX", "UY"):
            self._unusable[name] = self.plain[name].copy()
            self._unusable[name][count // 3] = np.nan

    def of(self, constants, pivots, unusable):
        g = {**self.plain, "MU": self._mu[pivots], **CONSTANTS[constants]}
        if unusable:
            name = next(name for name in ("UX", "UY") if np.ndim(g[name]))
            g[name] = self._unusable[name]
        return g


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--scenes", type=int, default=16384)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--constants", default=",".join(CONSTANTS))
    parser.add_argument("--save", help="a CSV file for all ratios, those of the least times too")
    options = parser.parse_args()
    count, population = options.scenes, Scenes(options.scenes)
    room = {name: np.empty(count, np.uint16 if name == "STATUS" else float) for name in RESULTS}

    def seconds(g, names):
        out = {name: room[name] for name in names}
        solve(g, threads=1, out=out)
        began = time.process_time_ns()
        solve(g, threads=1, out=out)
        return (time.process_time_ns() - began) / count

    cases = [
        (constants, results, pivots, unusable)
        for constants in options.constants.split(",")
        for results in SETS
        for pivots in PIVOTS
        for unusable in UNUSABLE
    ]
    ratios = {case: [] for case in cases}
    least = dict.fromkeys(cases, np.inf)
    plain, order = [], np.random.default_rng(1)
    for _ in range(options.rounds):
        for place in order.permutation(len(cases)):
            constants, results, *kind = case = cases[place]
            before = seconds(population.plain, SETS["six"])
            mine = seconds(population.of(constants, *kind), SETS[results])
            after = seconds(population.plain, SETS["six"])
            ratios[case].append(2 * mine / (before + after))
            plain.append(before)
            least[case] = min(least[case], mine)
    print(f"six of the plain scene: {np.median(plain):.1f} ns, least {min(plain):.1f}")
    medians = {case: float(np.median(x)) for case, x in ratios.items()}
    if options.save:
        with open(options.save, "w", newline="") as file:
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow(["constants", "results", "pivots", "unusable", "ratio", "of_least"])
            rows.writerows(
                [*case, f"{x:.4f}", f"{least[case] / min(plain):.4f}"]
                for case, x in medians.items()
            )
    for pivots in PIVOTS:
        for unusable in UNUSABLE:
            some = {c: x for c, x in medians.items() if c[2:] == (pivots, unusable)}
            but_all = {c: x for c, x in some.items() if c[1] != "all"}
            above = ", ".join(
                f"{sum(x > bar for x in but_all.values())} above {bar}" for bar in BARS
            )
            worst = sorted(but_all.items(), key=lambda pair: -pair[1])[:6]
            print(f"pivots {pivots} %, unusable {unusable}: of {len(but_all)}, {above}")
            print("  worst:", ", ".join(f"{c[0]} {c[1]} {x:.2f}" for c, x in worst))
            by_set = {s: np.median([x for c, x in some.items() if c[1] == s]) for s in SETS}
            print("  medians:", ", ".join(f"{name} {x:.2f}" for name, x in by_set.items()))


if __name__ == "__main__":
    main()
