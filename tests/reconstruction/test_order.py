"""The first impact is the same whatever the axes, the units and the names of the vehicles."""

import numpy as np
import pytest
from collisions import UNKNOWNS, VEHICLES, random_impact

from impact88.reconstruction.answer import reconstruct

MIRRORED = ("UY", "WA", "VY", "WB", "VAY", "WAF", "VBY", "WBF", "MUP", "PA", "PB", "TA", "TB", "GA")
PAIRS = "UX VX, UY VY, WA WB, VAX VBX, VAY VBY, WAF WBF, MA MB, IA IB, DA DB, PA PB".split(", ")
OTHER = {a: b for pair in PAIRS for a, b in (pair.split(), pair.split()[::-1])}
FOOT = 0.3048
SLUG = 14.5939


def mirror(entries):
    return {name: -x if name in MIRRORED else x for name, x in entries.items()}


def exchange(entries):
    result = {OTHER.get(name, name): x for name, x in entries.items()}
    return result | {
        name: entries[second] + 180 for name, second in (("TA", "TB"), ("TB", "TA"), ("GA", "GA"))
        if second in entries
    }  # fmt: skip


def metric(entries):
    size = {"M": SLUG, "I": SLUG * FOOT**2, "D": FOOT, "U": FOOT, "V": FOOT}
    exact = ("MUP",)
    return {n: x if n in exact else x * size.get(n[0], 1) for n, x in entries.items()}


def rotate(entries):
    """Turn a problem whose velocities are known in pairs by 30 degrees."""
    result = {n: x + 30 if n in ("TA", "TB", "GA") else x for n, x in entries.items()}
    turn = np.exp(1j * np.radians(30))
    for x, y in (("UX", "UY"), ("VX", "VY"), ("VAX", "VAY"), ("VBX", "VBY")):
        if x in entries and y in entries:
            vector = (entries[x] + 1j * entries[y]) * turn
            result |= {x: vector.real, y: vector.imag}
    return result


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("change", [mirror, exchange, metric])
def test_changes_of_view(change, seed):
    rng = np.random.default_rng([5, seed])
    vehicles, truth = random_impact(rng)
    names = rng.choice(UNKNOWNS, 9, replace=False).tolist()
    entries = vehicles | {name: truth[name] for name in names}
    _compare(entries, change)


@pytest.mark.parametrize("seed", range(2))
def test_rotation(seed):
    rng = np.random.default_rng([6, seed])
    vehicles, truth = random_impact(rng)
    names = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF", "E", "EM", "MUP")
    _compare(vehicles | {name: truth[name] for name in names}, rotate)


def _compare(entries, change):
    first = reconstruct(entries, samples=0)[0]
    second = reconstruct(change(entries), samples=0, seed=1)[0]
    assert second.verdict == first.verdict
    state = {n: first.values[n] for n in UNKNOWNS if n in first.values}
    reference = change(entries | state)
    largest = max(abs(x) for n, x in reference.items() if n not in VEHICLES)
    for name in UNKNOWNS:
        if name in reference and name in second.values and name not in entries:
            assert abs(second.values[name] - reference[name]) < 1e-5 * largest


def test_both_signs_of_mu_are_tried():
    rng = np.random.default_rng(8)
    vehicles, truth = random_impact(rng)
    names = ("VAX", "VAY", "VBX", "VBY", "WAF", "WBF", "E", "EM")
    entries = vehicles | {name: truth[name] for name in names} | {"MU": abs(truth["MUP"])}
    answer = [result.values for result in reconstruct(entries, samples=0)]
    assert any(abs(values["UX"] - truth["UX"]) < 1e-6 * abs(truth["UX"]) for values in answer)
    assert all(abs(abs(values["MUP"]) - entries["MU"]) < 1e-9 for values in answer)
