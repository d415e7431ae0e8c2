"""Exact values: every impact found, in an order that no choice of axes, units or names changes."""

import json

import numpy as np
import pytest
from captures import ROOT
from collisions import UNKNOWNS, random_impact

from impact88.cases.case import Case
from impact88.reconstruction.answer import reconstruct

PUBLIC = json.loads((ROOT / "golden" / "published" / "public-collisions.json").read_text())


def _turn(angle):
    return (angle + 180) % 360 - 180


@pytest.mark.parametrize("item", PUBLIC, ids=[item["source"] for item in PUBLIC])
def test_public_collisions(item):
    case = Case.loads(item["scene"])
    best = reconstruct(case.entries, samples=0)[0]
    for name, reported in item["published"].items():
        off = case.view.shown(name, best.values[name]) - reported
        assert abs(_turn(off) if name[0] == "H" else off) <= item["tolerance"][name]
    for name, degrees in item["force_comes_from_clockwise_of_the_way_it_travels"].items():
        assert abs(_turn(best.values[name] - degrees)) < 0.1
    assert (best.verdict == "impossible") == item["impossible"]


@pytest.mark.parametrize("seed", range(6))
def test_nine_exact_values_determine_the_impact_they_come_from(seed):
    rng = np.random.default_rng([1, seed])
    vehicles, truth = random_impact(rng)
    names = rng.choice(UNKNOWNS, 9, replace=False).tolist()
    results = reconstruct({**vehicles, **{name: truth[name] for name in names}}, samples=0)
    if not set(results[0].undetermined) & set(UNKNOWNS):
        assert any(_is_close(result.values, truth) for result in results)
    assert results[0].search[2] < 0.05


def _is_close(values, truth):
    largest = max(map(abs, truth.values()))
    return all(abs(values[name] - truth[name]) < 1e-6 * largest for name in UNKNOWNS)
