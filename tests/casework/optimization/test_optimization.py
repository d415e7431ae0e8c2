"""Extremes of functions over a box, against extremes that are known."""

from __future__ import annotations

import numpy as np
import pytest

from impact88.casework.optimization.ascent import climb
from impact88.casework.optimization.boxsearch import find_extremes, pool_of, spread
from impact88.casework.optimization.effort import THOROUGH
from impact88.casework.optimization.extremes import Piece

SEED = 7


def extremes_of(function, coordinates):
    count = function(np.full((1, coordinates), 0.5)).size
    piece = Piece(lambda u: function(u).reshape(len(u), -1), count)
    return piece.extremes(coordinates, np.random.default_rng(SEED))


def test_inside():
    top = np.array([0.3, 0.71, 0.5])
    extremes = extremes_of(lambda u: 4 - np.square(u - top).sum(axis=1), 3)
    assert extremes.bound[1, 0] == pytest.approx(4, abs=1e-8)
    assert extremes.at[1, 0] == pytest.approx(top, abs=1e-4)
    assert extremes.corner[1, 0] < 3.7
    assert extremes.bound[0, 0] == extremes.corner[0, 0] == 4 - (0.49 + 0.71**2 + 0.25)


def test_corner_among_more_than_are_tried():
    weights = np.linspace(-1, 1, 16)
    extremes = extremes_of(lambda u: u @ weights, 16)
    assert extremes.bound[1, 0] == pytest.approx(weights[weights > 0].sum(), abs=1e-12)
    assert extremes.bound[0, 0] == pytest.approx(weights[weights < 0].sum(), abs=1e-12)


def test_along_a_narrow_curved_ridge():
    # the banana: the top of its ridge is at (0.8, 0.64)
    extremes = extremes_of(
        lambda u: -(500 * (u[:, 1] - u[:, 0] ** 2) ** 2) - (u[:, 0] - 0.8) ** 2, 2
    )
    assert extremes.bound[1, 0] == pytest.approx(0, abs=5e-5)  # 1e-7 of its range


class Disc:
    """The plane x + .6 y over the unit disc, the outside of which is higher."""

    uphill = np.array([1.0, 0.6])
    evaluations = 0

    def evaluate(self, u, guess):
        self.evaluations += 1
        squares = np.square(u).sum(axis=1)
        return guess, (u @ self.uphill)[:, None], squares[:, None], np.ones(len(u), bool)

    def slopes(self, u, x):
        slope = np.broadcast_to(self.uphill, u.shape)
        return slope[:, None], 2 * u[:, None], np.zeros((len(u), 0, 2))


def test_a_climb_ends_on_a_curved_border():
    """The highest point is at distance 1 along (1, .6). Steps see the border as straight, and leave
    the disc, until the curvature is learnt; without it searches creep and do not converge."""
    disc, count = Disc(), 12
    starts = 0.5 * np.random.default_rng(SEED).random((count, 2))
    nowhere, index = np.empty((0, count)), np.zeros(count, int)
    _, _, heights, converged = climb(
        disc, starts, nowhere, index, np.ones(count), np.full(count, 1e-10)
    )
    assert converged.all()
    assert heights == pytest.approx(np.full((count, 1), np.hypot(1, 0.6)), abs=1e-8)
    assert disc.evaluations <= 15


class Bowl(Disc):
    """The height y, and far more for the distance from the center of the unit disc."""

    def evaluate(self, u, guess):
        guess, _, squares, usable = super().evaluate(u, guess)
        return guess, u[:, 1:] + 100 * squares, squares, usable

    def slopes(self, u, x):
        _, squares, states = super().slopes(u, x)
        return squares * 100 + np.array([0.0, 1.0]), squares, states


def test_a_climb_follows_a_curved_border():
    """Along the border straight steps leave the disc; where they are not brought back to it, only
    the shortest are better, and searches end far from the top."""
    bowl, begin = Bowl(), np.radians([[5.0], [20.0], [35.0]])
    starts = np.hstack([np.cos(begin), np.sin(begin)])
    count = len(starts)
    _, _, heights, converged = climb(
        bowl,
        starts,
        np.empty((0, count)),
        np.zeros(count, int),
        np.ones(count),
        np.full(count, 1e-10),
    )
    assert converged.all()
    assert heights == pytest.approx(np.full((count, 1), 101.0), abs=1e-6)


def test_jump_across_the_box():
    # the height falls off at an oblique edge: the best lies on it, at its upper end
    extremes = extremes_of(
        lambda u: np.where(u[:, 0] + 0.7 * u[:, 1] < 0.9, u[:, 0] + 0.9 * u[:, 1], -1), 2
    )
    assert extremes.bound[1, 0] == pytest.approx(0.2 + 0.9, abs=2e-3)


def test_points_without_value():
    extremes = extremes_of(lambda u: np.where(u[:, 0] > 0.5, np.nan, u[:, 0]), 2)
    assert extremes.bound[1, 0] == pytest.approx(0.5, abs=1e-6)
    assert extremes.bound[0, 0] == 0


def test_no_value_anywhere():
    extremes = extremes_of(lambda u: np.full(len(u), np.nan), 2)
    assert np.isnan(extremes.bound[1, 0])
    assert np.isnan(extremes.bound[0, 0])


def test_several_functions_at_once():
    extremes = extremes_of(lambda u: np.stack([u[:, 0], -u[:, 1], u[:, 0] * 0], axis=1), 2)
    assert extremes.bound[1].tolist() == [1, 0, 0]
    assert extremes.bound[0].tolist() == [0, -1, 0]


def test_nothing_varies():
    extremes = extremes_of(lambda u: np.full(len(u), 3.0), 0)
    assert (extremes.bound[0, 0], extremes.bound[1, 0]) == (3, 3)


class Needle:
    """A function of the unit square that is 0, but 1 at one point; every point is feasible."""

    def __init__(self, point):
        self.point = point

    def evaluate(self, u, states):
        values = (u == self.point).all(axis=1).astype(float)[:, None]
        return states, values, np.full((len(u), 1), 0.5), np.ones(len(u), bool)


def test_points_given_stay_where_they_are_while_others_are_spread():
    """Bounds take in every draw, the last as well: no search finds a needle again."""
    points = np.random.default_rng(SEED).random((3000, 2))
    given = points.copy()
    for row in (0, 2999):
        pool, _ = pool_of(Needle(points[row].copy()), points, np.zeros((1, 3000)))
        tail = pool.chosen(slice(-THOROUGH.spread_points, None))
        problem, rng = Needle(points[row].copy()), np.random.default_rng(SEED)
        widened = spread(problem, tail, rng)
        assert np.array_equal(points, given)
        assert pool.functions.sum() == 1
        assert (widened.u != tail.u).any()


def test_a_search_that_converged_is_done():
    weights = np.array([1.0, -2.0, 0.5])
    piece = Piece(lambda u: (u @ weights)[:, None], 1)
    points = np.random.default_rng(SEED).random((50, 3))
    pool, inside = pool_of(piece, points, np.empty((0, 50)))
    assert inside.all()
    found = find_extremes(piece, pool, [np.arange(50)], 2)
    assert found.done.all()
    assert found.values.ravel() == pytest.approx([-2.0, 1.5], abs=1e-9)
