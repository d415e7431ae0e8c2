"""All solutions of quadratic equations by their paths, against equations made of linear ones, and
against many random starts."""

from itertools import product

import numpy as np
import pytest

from impact88.casework.reconstruction.adjustment import reconstruct
from impact88.casework.reconstruction.leastsquares import descend
from impact88.casework.reconstruction.quadrics import Quadrics, follow_paths, quadratic_equations
from impact88.casework.reconstruction.system import System
from impact88.collision.casescene import sample
from impact88.collision.uncertain import fixed_value
from impact88.mechanics.closedform.solve import solve
from impact88.mechanics.state import State


def pairs_of_planes(size, rng, parallel=0):
    """Return forms, each the product of two linear ones, and their solutions: a plane of each pair
    goes through each. The first ``parallel`` pairs of planes never meet."""
    planes = rng.standard_normal((size, 2, size + 1))
    planes[:parallel, 1, 1:] = planes[:parallel, 0, 1:]
    first, second = planes[:, 0, :, None], planes[:, 1, None, :]
    forms = first * second
    ends = []
    for choice in product((0, 1), repeat=size):
        rows = planes[range(size), choice]
        ends.append(np.linalg.solve(rows[:, 1:], -rows[:, 0]))
    return (forms + forms.transpose(0, 2, 1)) / 2, np.array(ends)


@pytest.mark.parametrize("size", [1, 2, 3, 4, 5])
@pytest.mark.parametrize("seed", [1, 2])
def test_paths_lead_to_every_solution(size, seed):
    forms, ends = pairs_of_planes(size, np.random.default_rng([size, seed]))
    equations = Quadrics(forms, np.zeros(size), np.eye(size))
    paths = follow_paths(equations, np.random.default_rng(seed))
    assert (paths.complex_ends, paths.infinite_ends, paths.lost) == (0, 0, 0)
    assert paths.real.shape == (size, 2**size)
    for end in ends:
        nearest = np.abs(paths.real - end[:, None]).max(axis=0).min()
        assert nearest < 1e-6 * (1 + np.abs(end).max())


def test_complex_solutions_and_those_at_infinity_are_counted():
    # x² + 1 = 0; (x - y)(x - y - 1) = 0 and x - y + x² - y² - 3 = 0: two meet at infinity only
    square = np.array([[[1.0, 0.0], [0.0, 1.0]]])
    paths = follow_paths(Quadrics(square, np.zeros(1), np.eye(1)), np.random.default_rng(3))
    assert paths.real.shape[1] == 0
    assert (paths.complex_ends, paths.infinite_ends, paths.lost) == (2, 0, 0)
    first = np.array([[0.0, -0.5, 0.5], [-0.5, 1.0, -1.0], [0.5, -1.0, 1.0]])
    second = np.array([[-3.0, 0.5, -0.5], [0.5, 1.0, 0.0], [-0.5, 0.0, -1.0]])
    both = Quadrics(np.array([first, second]), np.zeros(2), np.eye(2))
    paths = follow_paths(both, np.random.default_rng(3))
    assert (paths.complex_ends, paths.lost) == (0, 0)
    assert paths.infinite_ends == 3
    # x - y = 1 leaves x + y = 2
    assert paths.real[:, 0] == pytest.approx([1.5, 0.5])


def test_random_starts_find_nothing_that_the_paths_do_not():
    values = {name: float(text) for name, text in sample(1).items()}
    state = State({**values, **{name: float(x) for name, x in solve(values).items()}})
    known = {n: x for n, x in values.items() if n not in ("UX", "UY", "VX", "VY", "MU")}
    known |= {name: float(state[name]) for name in ("SA", "SB", "DVA", "SBF", "MUP")}
    exact = System({n: fixed_value(v) for n, v in known.items()}, adjusted=False)
    equations = quadratic_equations(exact)
    assert equations is not None
    assert equations.size == 4
    paths = follow_paths(equations, np.random.default_rng(1))
    assert paths.lost == 0
    starts = np.random.default_rng(2).standard_normal((len(exact.variables), 1000))
    ends, own = descend(exact, starts), descend(exact, paths.real)
    met = ends[:, np.abs(exact.residuals(exact.state(ends))).max(axis=0) < 1e-10]
    assert np.abs(exact.residuals(exact.state(own))).max() < 1e-10
    assert met.shape[1]
    for end in met.T:
        assert np.abs(own - end[:, None]).max(axis=0).min() < 1e-6
    for end in own.T:
        assert np.abs(met - end[:, None]).max(axis=0).min() < 1e-6
    search = reconstruct(known)[0].search
    assert search.solutions == 16
    assert search.starts == 0
