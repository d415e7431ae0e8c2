"""Draws of the sampler against a density that is known in closed form."""

import numpy as np
import pytest

from impact88.casework.reconstruction.sampler import Proposal, sample

MEANS = np.array([[0.0, 0.0], [1.0, -2.0]])
DEVIATIONS = np.array([1.0, 2.0])


class TwoNormals:
    """A quarter of it is on branch 0, about (0, 0), the rest on branch 1, about (1, -2)."""

    def logarithms(self, points, branches):
        square = np.square((points - MEANS[branches].T) / DEVIATIONS[:, None]).sum(axis=0)
        return np.where(branches, np.log(3), 0.0) - square / 2, np.zeros(len(branches))

    def proposals(self):
        return [Proposal(np.array([0.5, -1.0]), branch, 3 * np.eye(2), 0.5) for branch in (0, 1)]

    other = "the hyperbolic sine of the first"

    def turned(self, points, branches, back=False):
        x, y = points
        z = np.arcsinh(x) if back else np.sinh(x)
        volume = np.log(np.cosh(z if back else x))
        return np.array([z, y]), branches, -volume if back else volume


def test_draws_are_of_the_density_on_every_branch():
    parts = [sample(TwoNormals(), 8000, np.random.default_rng(seed)) for seed in range(4)]
    points = np.concatenate([part.points for part in parts], axis=1)
    branches = np.concatenate([part.branches for part in parts])
    assert branches.mean() == pytest.approx(0.75, abs=0.015)
    scaled = (points - MEANS[branches].T) / DEVIATIONS[:, None]
    for branch in (0, 1):
        own = scaled[:, branches == branch]
        assert np.abs(own.mean(axis=1)).max() < 0.05
        assert own.std(axis=1) == pytest.approx([1.0, 1.0], abs=0.025)


class Bow:
    """A thin bow of normal x above -1, y about its square; and a spot on branch 1, of .0232 of
    all: .02 of a whole normal distribution beside the .8413 that the bow is of one."""

    other = None

    def logarithms(self, points, branches):
        x, y = points
        bow = np.square(x) + np.square((y - x * x) / 0.1)
        spot = np.square(x - 3) + np.square((y + 5) / 0.1)
        log = np.where(branches, np.log(0.02) - spot / 2, -bow / 2)
        return log, np.square(np.maximum(-1 - x, 0.0))

    def proposals(self):
        return [Proposal(np.zeros(2), branch, 6 * np.eye(2), 0.5) for branch in (0, 1)]


@pytest.mark.long
def test_a_rare_branch_has_its_share_and_a_thin_one_enough_draws():
    parts = [sample(Bow(), 2000, np.random.default_rng(seed)) for seed in range(40)]
    # of 40 samples the standard error is .0006
    assert np.mean([part.branches for part in parts]) == pytest.approx(0.0232, abs=0.0018)
    sizes = [part.effective_size(part.points[0]) for part in parts]
    assert np.mean(sizes) > 1200
