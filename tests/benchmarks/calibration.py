"""Calibration of the draws of reconstructions by simulation.

    PYTHONPATH=tests/support python tests/benchmarks/calibration.py [TRUTHS] [KIND ...] [--controls]

For each kind of given, with friction given and not: true impacts are drawn from a proper prior that
the sampler is given, measured with the stated noise, and reconstructed. The rank of the truth among
the draws is uniform if the draws are those of the posterior (Talts et al. 2018), that of the joint
log-likelihood, too, which alone sees a missing likelihood (Modrák et al. 2023). The distance of the
ranks from uniform ones is the largest over the distribution function, in pointwise standard
deviations; its probability is that of as many uniform ranks.

The controls break the sampler on purpose, and must fail: the approach dropped (and with it the
push, from which it follows where E lies from 0 to 1), the Jacobian dropped, the likelihood dropped.
Seeds are fixed below; results are printed as they are. The status is 1 where the sampler fails as
it is, or a control does not.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
import warnings
from functools import cache

import numpy as np
from impactsampler import Known, Problem, exact, impact, possible

from impact88.casework.optimization.effort import Effort, granting
from impact88.casework.reconstruction.admissible import APPROACH, PUSH
from impact88.casework.reconstruction.coordinates import Coordinates
from impact88.casework.reconstruction.posterior import Posterior
from impact88.casework.reconstruction.solution import Reconstruction
from impact88.casework.reconstruction.system import System
from impact88.collision.uncertain import read

SEED = 20_261_127
TRUTHS = 200
DRAWS = 99
PARTICLES = 600
TRIALS = 100_000  # uniform ranks: of 70 tests, .001 over all is one with 1.4e-5
RANKED = ("UX", "UY", "VX", "VY", "DVA", "VC", "log-likelihood")
KINDS = {
    "after": (("SAF", 1.5), ("HAF", 4.0), ("SBF", 1.5), ("HBF", 4.0)),
    "skid": (("SAF", 3.0), ("SBF", 3.0), ("HAF", 8.0), ("HBF", 8.0)),
    "change": (("DVA", 1.5), ("DVB", 1.5)),
    "energy": (("EL", 4000.0), ("KI", 8000.0)),
    "spins": (("WAF", 0.4), ("WBF", 0.4), ("VAX", 2.0)),
}
CONTROLS = ("approach", "jacobian", "likelihood")
# A may drive either way: of each impact there is then one in which the vehicles separate and pull,
# and whoever does not ask whether they approach draws it as often
BEFORE = (("UX", 0.0, 40.0), ("UY", 0.0, 4.0), ("VX", 0.0, 10.0), ("VY", 25.0, 8.0))


def vehicles(rng):
    """Vehicles, and B from the side."""
    own = {"DA": rng.uniform(4, 7), "DB": rng.uniform(3, 6), "MA": rng.uniform(70, 150)}
    own |= {"MB": rng.uniform(70, 150), "TA": 0.0, "PA": 180.0 + rng.uniform(-20, 20)}
    own |= {"IA": own["MA"] * rng.uniform(16, 30), "IB": own["MB"] * rng.uniform(16, 30)}
    return own | {"TB": 90.0, "PB": rng.uniform(-120, -60), "GA": 180.0 + rng.uniform(-30, 30)}


def true_impact(known, rng):
    """A draw from the prior: the product of the known densities over the admissible set."""
    count = 2_000
    while True:
        values = {n: np.full(count, v.first) for n, v in known.items() if v.kind == "exact"}
        values |= {n: v.drawn(rng, count) for n, v in known.items() if v.kind != "exact"}
        for name, ends in (("E", (0, 1)), ("EM", (-1, 0)), ("MUP", (-10, 10))):
            if name not in values:
                values[name] = rng.uniform(*ends, count)
        mu = values.pop("MUP")
        own = impact(values, mu)
        good = possible(own, [n for n in ("E", "EM", "MUP") if n in known])
        if good.any():
            first = int(good.argmax())
            return {n: float(np.broadcast_to(v, count)[first]) for n, v in own.items()}


def reconstruction(problem):
    """The truth as a `Reconstruction`, which the proposals begin from."""
    known = {n: read(v.text(), n) for n, v in problem.known.items()}
    known["M"] = read("6", "M")
    system = System(known, adjusted=True)
    scaled = [problem.truth[n] for n in system.variables] / system.scales
    return Reconstruction(system, scaled[:, None], dict(problem.truth), (), (), 0, 0.0)


def log_likelihood(own, measured):
    total = 0.0
    for name, item in measured.items():
        off = own[name] - item.first
        if name.startswith("H"):
            off = off - 360 * np.round(off / 360)
        total = total - 0.5 * np.square(off / item.second)
    return total


class WithoutJacobian(Coordinates):
    def coefficient_volume(self, state, points):
        return np.zeros(points.shape[1])


def ranks(kind, number, friction, control, rng):
    """The ranks of one truth, and the effective size of its draws."""
    known = {n: exact(v) for n, v in vehicles(rng).items()} | {"WA": exact(0.0), "WB": exact(0.0)}
    known |= {n: Known("normal", mean, deviation) for n, mean, deviation in BEFORE}
    if friction:
        known["MUP"] = Known("uniform", 0.0, 0.6)
    if number % 2:
        known |= {"E": Known("uniform", 0.0, 0.3), "EM": Known("uniform", -0.9, -0.1)}
    truth = true_impact(known, rng)
    measured = {}
    for name, deviation in KINDS[kind]:
        noise = Known("normal", 0.0, deviation).drawn(rng, 1)[0]
        measured[name] = Known("normal", float(truth[name] + noise), deviation)
    problem = Problem({**known, **measured}, truth)
    posterior = Posterior(reconstruction(problem))
    assert posterior.whole
    if control == "approach":
        dropped = (APPROACH, PUSH)
        posterior.admissible.limit_to([n for n in posterior.admissible.rows if n not in dropped])
    if control == "jacobian":
        posterior.coordinates.__class__ = WithoutJacobian
    if control == "likelihood":
        posterior.items = {n: v for n, v in posterior.items.items() if n not in measured}
    with granting(Effort(particles=PARTICLES)):
        drawn = posterior.sample(PARTICLES, rng)
    if drawn is None:
        return None, 0.0
    names = [*RANKED[:-1], *measured]
    values = posterior.values(drawn.points, drawn.branches, names)
    chosen = rng.choice(values.shape[1], DRAWS, replace=False)
    own = dict(zip(names, values[:, chosen], strict=True))
    own["log-likelihood"] = log_likelihood(own, measured)
    true = {**truth, "log-likelihood": log_likelihood(truth, measured)}
    effective = min(map(drawn.effective_size, values))
    return [int((own[n] < true[n]).sum()) for n in RANKED], effective


def distance(numbers):
    """The largest distance of ranks from uniform ones, in pointwise standard deviations."""
    places = (np.arange(DRAWS) + 1) / (DRAWS + 1)
    below = (numbers[..., None] <= np.arange(DRAWS)).mean(axis=-2)
    spread = np.sqrt(places * (1 - places) / numbers.shape[-1])
    return np.abs((below - places) / spread).max(axis=-1)


@cache
def distances_of_uniform(count):
    """Distances of uniform ranks of so many truths."""
    rng = np.random.default_rng(1)
    return np.array([distance(rng.integers(0, DRAWS + 1, count)) for _ in range(TRIALS)])


def probability(numbers):
    """The probability of uniform ranks at least as far from uniform."""
    return float((distances_of_uniform(len(numbers)) >= distance(numbers)).mean() + 0.5 / TRIALS)


LEAST_PROBABILITY = 0.001  # over all tests; with less the sampler fails


def judged(control, kinds, truths):
    """Print the probabilities of each kind of given, and return that over all."""
    smallest, tests = 1.0, 0
    for kind in kinds:
        for friction in (False, True):
            started, rows, failed, sizes = time.process_time(), [], 0, []
            for number in range(truths):
                seeds = [SEED, [*KINDS].index(kind), int(friction), number]
                row, size = ranks(kind, number, friction, control, np.random.default_rng(seeds))
                if row is None:
                    failed += 1
                else:
                    rows.append(row)
                    sizes.append(size)
            table = np.array(rows)
            p = [probability(table[:, i]) for i in range(len(RANKED))]
            smallest, tests = min(smallest, *p), tests + len(p)
            print(
                control or "as it is",
                kind,
                "friction given" if friction else "friction not given",
                " ".join(f"{n} {x:.4f}" for n, x in zip(RANKED, p, strict=True)),
                f"without draws {failed}; least, median effective size {min(sizes):.0f}, "
                f"{np.median(sizes):.0f}; {time.process_time() - started:.0f} s",
                flush=True,
            )
    over_all = -math.expm1(tests * math.log1p(-min(smallest, 1 - 1e-12)))
    print(f"{control or 'as it is'}: least p {smallest:.5f} of {tests}; over all {over_all:.4f}")
    return over_all


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("truths", nargs="?", type=int, default=TRUTHS)
    parser.add_argument("kinds", nargs="*")
    parser.add_argument("--controls", action="store_true")
    args = parser.parse_args()
    warnings.filterwarnings("ignore")
    kinds = args.kinds or [*KINDS]
    if args.controls:
        found = [judged(control, kinds, args.truths) for control in CONTROLS]
        return int(max(found) >= LEAST_PROBABILITY)
    return int(judged("", kinds, args.truths) < LEAST_PROBABILITY)


if __name__ == "__main__":
    sys.exit(main())
