"""How accurate the closed form is, over every population, and what the listing's elimination does.

The bound is that of a backward stable method: the error of the final velocities is at most a small
multiple of the unit roundoff times what the same relative change of the scene's numbers would do
(`accuracy.errorbound`). The true values come from 50-digit arithmetic.
"""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from fiftydigits import exact, listing_elimination, relative_error, split
from longer import long_but
from worked_cases import RUN_1

from impact88 import solve
from impact88.apple.applesoft.operators import Real
from impact88.collision.casescene import Scene, sample
from impact88.collision.degrees import sin_cos
from impact88.collision.sinetable import STEP
from impact88.mechanics.accuracy import reference
from impact88.mechanics.accuracy.elimination import (
    LISTING_PI,
    changes,
    eliminate,
    fill,
    lapack,
)
from impact88.mechanics.accuracy.errorbound import movements, sensitivity
from impact88.mechanics.accuracy.populations import POPULATIONS, scenes
from impact88.mechanics.accuracy.reference import fifty_digits
from impact88.mechanics.closedform.columns import ANGLES
from impact88.names import FINAL_VELOCITIES, SCENE
from impact88.program.run import run
from impact88.status import Status

ROUNDOFF = 2.0**-53
BACKWARD_STABLE = 16
"""The small multiple; measured on 10,000 scenes of each population: 3 for cars, 5 where masses and
inertias are unrelated, 15 for pivots of such; 18 of 48 that were evolved for it."""


def scene_at(g, i):
    return {name: float(values[i]) for name, values in g.items()}


def errors(g, found):
    """The relative error of every scene's final velocities; NaN where none exist."""
    out = []
    for i in range(len(g["MA"])):
        true = exact(scene_at(g, i))
        mine = {name: float(found[name][i]) for name in FINAL_VELOCITIES}
        out.append(math.nan if true is None else relative_error(mine, true))
    return np.array(out)


def listing_in_double(A, b):
    """The listing's elimination on float64 rows."""
    rows = [[*map(float, A[k]), float(b[k])] for k in range(len(A))]
    return eliminate(rows, 1e-9)


@pytest.mark.parametrize("name", long_but(POPULATIONS, kept=(0, 1, 2, 3)))
def test_backward_stable(name):
    """On the machine at hand: test_native holds both to the same bits."""
    g = scenes(name, 80, 88)
    error = errors(g, solve(g, FINAL_VELOCITIES))
    assert np.isfinite(error).all()
    most = 2 * BACKWARD_STABLE if name == "evolved" else BACKWARD_STABLE
    assert np.max(error / sensitivity(g)) <= most * ROUNDOFF


def hard_pivots(count, seed):
    """Radii of gyration down to 1e-6 of the arms: casework with inertias as small as 1e-12 of a
    car's, masses as large as 1e6 of one, and spins."""
    rng = np.random.default_rng(seed)
    g = scenes("casework", count, seed)
    for name, low, high in (("IA", -12, 0), ("IB", -12, 0), ("MA", 0, 6), ("MB", 0, 6)):
        g[name] = g[name] * 10.0 ** rng.uniform(low, high, count)
    g["WA"], g["WB"] = rng.uniform(-2, 2, (2, count))
    g["EM"] = -(10.0 ** rng.uniform(-18, 0, count))
    return {**g, "MU": np.full(count, -10.0)}


def lorry_and_child(count, seed):
    """26 t against 54 kg (SI units), both spinning, EM from -1 to nearly nothing, E often 0."""
    rng = np.random.default_rng(seed)
    g = scenes("casework", count, seed)
    g["MA"], g["IA"] = np.full(count, 26e3), np.full(count, 300e3)
    g["MB"], g["IB"] = np.full(count, 54.0), np.full(count, 8.0)
    g["WA"], g["WB"] = rng.uniform(-2, 2, (2, count))
    g["EM"] = -(10.0 ** rng.uniform(-18, 0, count))
    g["E"] = np.where(rng.random(count) < 0.5, 0.0, g["E"])
    return g


def long_arms(count, seed):
    """Arms a thousand times as long as a car's, or as short, with spins; every second a pivot."""
    rng = np.random.default_rng(seed)
    g = scenes("casework", count, seed)
    for name in ("DA", "DB"):
        g[name] = g[name] * 10.0 ** rng.uniform(-3, 3, count)
    g["WA"], g["WB"] = rng.uniform(-2, 2, (2, count))
    g["MU"][::2] = -10.0
    return g


def test_impulses_with_long_arms():
    g = long_arms(60, 5)
    names = ("PN", "PT", "PM")
    found, moved = solve(g, names), movements(g, names)
    for i in range(60):
        true = fifty_digits({name: repr(value).upper() for name, value in scene_at(g, i).items()})
        for group in (names[:2], names[2:]):
            error = max(abs(float(found[name][i] - true[name])) for name in group)
            size = max(max(moved[name][i], abs(found[name][i])) for name in group)
            assert error <= BACKWARD_STABLE * ROUNDOFF * size


@pytest.mark.parametrize("make", [hard_pivots, lorry_and_child, long_arms])
def test_backward_stable_where_differences_would_lose_digits(make):
    g = make(80, 5)
    error = errors(g, solve(g, FINAL_VELOCITIES))
    assert np.max(error / sensitivity(g)) <= BACKWARD_STABLE * ROUNDOFF


def test_inertias_of_1e200():
    g = {**scenes("casework", 20, 7), "IA": np.full(20, 1e200), "IB": np.full(20, 1e200)}
    g["WA"] = np.linspace(-1, 1, 20)
    assert errors(g, solve(g, FINAL_VELOCITIES)).max() < 1e-13


def test_angles_of_many_turns():
    """Each is the angle within a turn that it stands for, which takes no rounding to find."""
    rng = np.random.default_rng(3)
    g = scenes("casework", 60, 7)
    for name in ("GA", "PA", "PB", "TA", "TB"):
        g[name] = g[name] + 360.0 * np.round(10.0 ** rng.uniform(0, 12, 60)) * rng.choice([-1, 1])
    within = {name: np.fmod(v, 360.0) if name in ANGLES else v for name, v in g.items()}
    far, near = solve(g, FINAL_VELOCITIES), solve(within, FINAL_VELOCITIES)
    error = errors(g, far)
    assert np.max(error / sensitivity(within)) <= BACKWARD_STABLE * ROUNDOFF
    beyond = np.all([np.abs(g[name]) > 720 for name in ANGLES], axis=0)
    assert beyond.sum() > 40
    for name in FINAL_VELOCITIES:
        np.testing.assert_array_equal(far[name][beyond], near[name][beyond])


def test_beside_lapack_and_the_listing():
    """Of cars no method is far from the last digit (which is worst depends on the seed); with a
    body far heavier the listing's unknowns lose it, whoever solves for them, its changes do not."""
    g = scenes("casework", 60, 1)
    A, b = fill(g)
    mine = errors(g, solve(g, FINAL_VELOCITIES))
    lapacks = errors(g, dict(zip(FINAL_VELOCITIES, lapack(A, b).T, strict=True)))
    assert np.median(mine) <= np.median(lapacks)
    g = scenes("heavy", 20, 1)
    A, b = fill(g)
    listing = np.array([listing_in_double(A[i], b[i]) for i in range(20)])
    mine = errors(g, solve(g, FINAL_VELOCITIES))
    listings = errors(g, dict(zip(FINAL_VELOCITIES, listing.T, strict=True)))
    lapacks = errors(g, dict(zip(FINAL_VELOCITIES, lapack(A, b).T, strict=True)))
    right, before = changes(g, A)
    changed = errors(g, dict(zip(FINAL_VELOCITIES, (before + lapack(A, right)).T, strict=True)))
    assert 1000 * mine.max() <= min(listings.max(), lapacks.max())
    assert 1000 * changed.max() <= lapacks.max()


def test_the_two_references_agree():
    """Six equations, and three in the impulse: independent ways to the same digits."""
    for name in ("casework", "extreme", "pivots"):
        g = scenes(name, 10, 5)
        for i in range(10):
            scene = scene_at(g, i)
            six = exact(scene)
            with reference.working(scene):
                t = reference.Exact(scene)
                found = reference.velocities(t, reference.impulse(t))
            three = dict(zip(FINAL_VELOCITIES, found, strict=True))
            assert relative_error(six, three) < 1e-38


def test_quarter_turns_are_exact():
    angles = 90.0 * np.arange(-12, 13)
    sine, cosine = sin_cos(angles)
    np.testing.assert_array_equal(sine, np.round(np.sin(np.radians(angles))))
    np.testing.assert_array_equal(cosine, np.round(np.cos(np.radians(angles))))
    # so a head-on impact along an axis stays on the axis
    square = {**RUN_1, "GA": np.array([90.0, 270.0, -90.0]), "UY": -20.0, "UX": 0.0, "MU": 0.0}
    found = solve({**square, "VX": 0.0})
    np.testing.assert_array_equal(found["VAX"], 0.0)


def test_sine_and_cosine_of_degrees():
    """Below 3 units in the last place, everywhere, against 40 digits; the largest errors are close
    to quarter turns, between half a step of the table and one and a half."""
    rng = np.random.default_rng(8)
    near = 90.0 * rng.integers(-8, 9, 500) + rng.uniform(-1e-3, 1e-3, 500)
    beside = 90.0 * rng.integers(-8, 9, 1000) + STEP * rng.uniform(-2, 2, 1000)
    angles = np.concatenate(
        [rng.uniform(-720, 720, 1500), near, beside, 10 ** rng.uniform(-300, 9, 200)]
    )
    found = sin_cos(angles)
    with mpmath.workdps(60):
        for values, function in zip(found, (mpmath.sin, mpmath.cos), strict=True):
            for angle, value in zip(angles.tolist(), values.tolist(), strict=True):
                true = function(mpmath.radians(mpmath.mpf(angle)))
                assert abs(mpmath.mpf(value) - true) <= 3 * np.spacing(abs(float(true)))


def test_em_of_one_half_exactly():
    g = scenes("em-half", 40, 3)
    g["EM"] = np.full(40, 0.5)
    assert errors(g, solve(g, FINAL_VELOCITIES)).max() < 1e-11
    g["MU"] = np.full(40, -10.0)
    assert errors(g, solve(g, FINAL_VELOCITIES)).max() < 1e-11


def test_loss_keeps_its_digits_when_little_is_lost():
    """KI - KF would have lost nine of them here."""
    rolling = {**RUN_1, "UX": 100.0, "VX": 100.0 + 1e-3, "UY": 0.0, "VY": 0.0}
    true = exact(rolling)
    with mpmath.workdps(50):
        initial = final = mpmath.mpf(0)
        for names, weights in (
            (("UX", "UY", "VX", "VY", "WA", "WB"), ("MA", "MA", "MB", "MB", "IA", "IB")),
        ):
            for name, weight, after in zip(names, weights, FINAL_VELOCITIES, strict=True):
                initial += mpmath.mpf(rolling[weight]) * mpmath.mpf(rolling[name]) ** 2
                final += mpmath.mpf(rolling[weight]) * true[after] ** 2
        loss = float(100 * (initial - final) / initial)
    assert 0 < loss < 1e-7
    found = solve(rolling)
    assert found["LOSS"] == pytest.approx(loss, rel=1e-10)
    assert abs(100 * (1 - found["KF"] / found["KI"]) / loss - 1) > 1e-8


def best_scaled_condition(A):
    """The smallest condition number any scaling of rows and columns gives (Bauer): the spectral
    radius of |A^-1||A|."""
    A = np.array(A)
    for _ in range(20):
        for axis in (1, 2):
            A /= np.sqrt(np.abs(A).max(axis=axis, keepdims=True))
    product = np.abs(np.linalg.inv(A)) @ np.abs(A)
    return np.abs(np.linalg.eigvals(product)).max(axis=1)


def test_what_a_light_body_keeps_beside_a_heavy_one():
    """Central, without rebound: both end with the common velocity, here all but a hundred
    thousandth of A's lost; its change alone would have rounding errors of 1e5 of them."""
    g = dict.fromkeys(SCENE, 0.0) | {"M": 6.0, "MU": -10.0, "EM": -0.3, "GA": 20.0}
    g |= {"MA": 91.7, "IA": 1701.3, "MB": 3.1e13, "IB": 7.7e14, "UX": -80.7, "VX": 1.3e-3}
    g |= {"UY": 33.3, "VY": -7.1e-4}
    found = solve(g, FINAL_VELOCITIES)
    mass_a, mass_b = Fraction(g["MA"]), Fraction(g["MB"])
    for u, v, after in (("UX", "VX", ("VAX", "VBX")), ("UY", "VY", ("VAY", "VBY"))):
        common = (mass_a * Fraction(g[u]) + mass_b * Fraction(g[v])) / (mass_a + mass_b)
        assert [found[name] for name in after] == pytest.approx([float(common)] * 2, rel=4e-16)


@pytest.mark.parametrize("name", ["casework", "heavy", "singular", "units", "em-half", "pivots"])
def test_cond_estimates_the_best_scaled_condition(name):
    g = scenes(name, 400, 2)
    ratio = solve(g, "COND")["COND"] / best_scaled_condition(fill(g)[0])
    assert np.mean((ratio > 0.1) & (ratio < 10)) >= 0.95
    assert ratio.min() > 0.01
    assert ratio.max() < 100


class TestWhatTheListingDoes:
    """Its failures, in 50 digits, in double and in the 1988 arithmetic, and explained."""

    STALE = {  # noqa: RUF012
        **{"MA": ".004", "IA": "4E-8", "DA": ".005", "PA": "90", "MB": "2E-11", "IB": "1E-20"},
        **{"DB": "0", "PB": "0", "GA": "-30", "TA": "0", "TB": "0"},
        **{"E": ".5", "MU": ".5", "EM": "-1"},
        **{"UX": "-2", "UY": "0", "WA": "0", "VX": "0", "VY": "1", "WB": "0"},
    }
    """A speck against a steel ball: a whole column is below 1E-9, and RX keeps its last value."""

    BALLS = {  # noqa: RUF012
        **{"MA": "2.6E-4", "IA": "4.2E-10", "DA": ".002", "PA": "0", "TA": "180"},
        **{"MB": "2.6E-4", "IB": "4.2E-10", "DB": ".002", "PB": "0", "TB": "0"},
        **{"GA": "0", "E": ".9", "MU": ".1", "EM": "-.5"},
        **{"UX": "-1", "UY": ".5", "WA": "0", "VX": "0", "VY": "0", "WB": "0"},
    }
    """Two 4 mm steel balls in SI units."""

    def numbers(self, texts):
        return {name: float(text) for name, text in texts.items()}

    def applesoft(self, texts):
        return run(Scene.from_mapping({**texts, "M": "6"}), dos=False)

    def velocities(self, result):
        """The solution is the last column of A, stored with the first subscript fastest."""
        rows = result.A["dims"][0]
        stored = result.A["data"][-rows:][1:]
        return dict(
            zip(FINAL_VELOCITIES, (float(Real.from_stored(x)) for x in stored), strict=True)
        )

    def test_zero_determinant_for_a_solvable_scene(self):
        """Tiny units: pivots of 1e-10 are judged by an absolute 1E-9, in any arithmetic."""
        true = exact(self.BALLS)
        assert true is not None
        assert listing_elimination(self.BALLS) is None
        A, b = fill({name: np.array([x]) for name, x in self.numbers(self.BALLS).items()})
        assert listing_in_double(A[0], b[0]) is None
        assert "ZERO DETERMINANT" in self.applesoft(self.BALLS).printout
        found = solve(self.numbers(self.BALLS))
        assert found["COND"] < 100  # nothing is wrong with the scene
        assert relative_error({n: float(found[n]) for n in FINAL_VELOCITIES}, true) < 1e-14
        assert not found["STATUS"] & Status.SINGULAR

    def test_huge_masses_are_zero_determinant_too(self):
        """Run 1 with masses in 1e12 slug: not independent of units after all."""
        scene = {name: str(text) for name, text in sample(1).items() if name != "title"}
        tiny = {name: f"{float(scene[name]) * 1e-12:.9g}" for name in ("MA", "MB", "IA", "IB")}
        tiny = {**scene, **{name: text.upper() for name, text in tiny.items()}}
        assert "ZERO DETERMINANT" in self.applesoft(tiny).printout
        assert listing_elimination(tiny) is None
        found, usual = solve(self.numbers(tiny)), solve(RUN_1)
        assert found["VAX"] == pytest.approx(float(usual["VAX"]), rel=1e-9)

    def test_stale_row_gives_a_wrong_answer_without_a_message(self):
        true = exact(self.STALE)
        assert true is not None
        wrong = listing_elimination(self.STALE)
        assert wrong is not None  # and no ZERO DETERMINANT
        assert relative_error(wrong, true) > 1.7
        result = self.applesoft(self.STALE)
        assert result.error is None
        assert "VBY= 4.696 " in result.printout  # 1.124 is true
        assert relative_error(self.velocities(result), true) > 1.7
        A, b = fill({name: np.array([x]) for name, x in self.numbers(self.STALE).items()})
        in_double = listing_in_double(A[0], b[0])
        assert relative_error(in_double, true) > 1.7
        # the elimination's doing, not rounding's (B's spin aside, which is 0 but for rounding)
        for name, value in list(zip(FINAL_VELOCITIES, in_double, strict=True))[:4]:
            assert value == pytest.approx(float(wrong[name]), rel=1e-6, abs=1e-12)
        assert relative_error(lapack(A, b)[0].tolist(), true) < 1e-6
        found = solve(self.numbers(self.STALE))
        assert relative_error({n: float(found[n]) for n in FINAL_VELOCITIES}, true) < 1e-14

    def test_true_singularity_passes_unnoticed(self):
        """Run 1 with MU = 3.19214397: velocities of 1e10 ft/s, percents wrong, and no message."""
        singular = sample(1).replaced({"MU": "3.19214397"})
        result = run(singular, dos=False)
        assert result.error is None
        assert "ZERO DETERMINANT" not in result.printout
        scene = {name: text for name, text in singular.items() if name != "title"}
        true = exact(scene)
        found = solve(self.numbers(scene))
        assert found["STATUS"] & Status.SINGULAR
        assert found["COND"] > 1e9
        assert relative_error({n: float(found[n]) for n in FINAL_VELOCITIES}, true) < 1e-5
        assert 0.01 < relative_error(self.velocities(result), true) < 1
        assert max(abs(v) for v in true.values()) > 1e6  # no velocities anybody believes

    def test_split_names_the_cause(self):
        """Casework: pi costs what one unit of nine digits costs, the elimination nothing, and the
        rest is rounding to 32 bits."""
        scene = {name: text for name, text in sample(1).items() if name != "title"}
        A, b = fill({name: np.array([x]) for name, x in self.numbers(scene).items()}, pi=LISTING_PI)
        parts = split(
            scene, dict(zip(FINAL_VELOCITIES, listing_in_double(A[0], b[0]), strict=True))
        )
        assert parts.elimination < 1e-45
        assert parts.arithmetic < 1e-14
        assert 1e-11 < parts.pi < 1e-8
        assert parts.total == pytest.approx(parts.pi, rel=1e-4)
        stale = split(self.STALE, listing_elimination(self.STALE))
        assert stale.elimination > 0.5
        assert stale.arithmetic == 0
        assert math.isnan(split(self.BALLS, exact(self.BALLS)).elimination)


def single_spin_errors(g):
    """The largest error of either spin alone, in roundings of the scene's numbers: no spin lends
    the other its size."""
    names = ("WAF", "WBF")
    found, moved = solve(g, names), movements(g, names)
    worst = 0.0
    for i in range(len(g["MA"])):
        true = fifty_digits(scene_at(g, i))
        for name in names:
            error = abs(float(found[name][i] - true[name]))
            worst = max(worst, error / (moved[name][i] + abs(found[name][i])) / ROUNDOFF)
    return worst


@pytest.mark.parametrize("pivot", long_but([False, True]))
@pytest.mark.parametrize("scales", [("DA", "DB"), ("DA", "DB", "MA", "MB", "IA", "IB")])
def test_each_spin_keeps_its_own_digits(pivot, scales):
    """Mean and difference, each right to the last digit, left 2e3 to 2e4 roundings in a spin."""
    rng = np.random.default_rng(38)
    g = scenes("casework", 120, 38) | {"M": np.full(120, 6.0)}
    for name in scales:
        g[name] = g[name] * 10.0 ** rng.uniform(-6, 6, 120)
    g["WA"], g["WB"] = rng.uniform(-2, 2, (2, 120))
    if pivot:
        g["MU"] = np.full(120, -10.0)
    assert single_spin_errors(g) <= BACKWARD_STABLE


@pytest.mark.parametrize("name", long_but(["casework", "heavy", "extreme", "cancelling"]))
def test_a_pivot_that_gains_energy_is_as_accurate(name):
    """EM > 1/2: both sums that the form of the final velocities is chosen by are negative."""
    count, rng = 200, np.random.default_rng(38)
    g = scenes(name, count, 38) | {"MU": np.full(count, -10.0)}
    g["EM"] = rng.uniform(0.5, 3.0, count)
    g |= {"VX": np.zeros(count), "VY": np.zeros(count)}  # which long arms leave all but unchanged
    g |= {name: g[name] * 10.0 ** rng.uniform(0, 4, count) for name in ("DA", "DB")}
    found, moved = solve(g, FINAL_VELOCITIES), movements(g, FINAL_VELOCITIES)
    true = [exact(scene_at(g, i)) for i in range(count)]
    for result in ("VAX", "VAY", "VBX", "VBY"):
        error = [abs(float(found[result][i] - row[result])) for i, row in enumerate(true)]
        size = [abs(float(row[result])) for row in true]
        assert (np.array(error) <= BACKWARD_STABLE * ROUNDOFF * (moved[result] + size)).all()
