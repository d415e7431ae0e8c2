"""Errors of the results against 50 digits, in roundings of the scene's numbers."""

import csv
from pathlib import Path

import mpmath
import numpy as np
import pytest
from populations import POPULATIONS, scenes
from roundings import ROUNDINGS, error_bounds

from impact88 import UserError, sample, solve
from impact88.mechanics.formulas import sine_and_cosine
from impact88.mechanics.reference import results, thirty_digits
from impact88.names import FINAL_VELOCITIES, RESULTS

NAMES = [name for name in RESULTS if name not in ("COND", "STATUS")]
EXTREME = ("extreme", "pivots")
MOST = {**dict.fromkeys(EXTREME, 6.0), "evolved": 10.0}  # roundings; 3 of the others
EVOLVED = Path(__file__).with_name("evolved.csv")


def evolution_scenes():
    """Return 24 scenes that an evolution strategy bred for large errors."""
    names, *rows = csv.reader(EVOLVED.read_text("ascii").splitlines())
    return dict(zip(names, np.array(rows, np.float64).T.copy(), strict=True))


def scene_at(g, i):
    return {name: float(column[i]) for name, column in g.items()}


def errors(g):
    """Return each result's largest error, as a fraction of its bound."""
    values, bounds = solve(g, NAMES), error_bounds(g, NAMES)
    worst = dict.fromkeys(NAMES, 0.0)
    for i in range(len(g["MA"])):
        exact = results(scene_at(g, i))
        for name in NAMES:
            value = float(values[name][i])
            if name in exact and np.isfinite(value):
                error = float(abs(exact[name] - value))
                worst[name] = max(worst[name], error / bounds[name][i] if error else 0.0)
    return worst


@pytest.mark.parametrize("name", [*POPULATIONS, "evolved"])
def test_errors_in_roundings_of_the_scene(name):
    g = evolution_scenes() if name == "evolved" else scenes(name, 25, 88)
    worst = errors(g)
    assert max(worst[v] for v in FINAL_VELOCITIES) * ROUNDINGS <= MOST.get(name, 3.0)
    assert max(worst.values()) * ROUNDINGS <= 12.0  # a fifth of the bound that is reported


def test_the_bound_where_nothing_is_left_of_a_velocity():
    """A car before a wall without rebound: what is not 0 is rounding of the velocity before."""
    g = {**scenes("casework", 1000, 5), "M": np.full(1000, 4.0), "MB": np.full(1000, np.inf)}
    g |= {name: np.zeros(1000) for name in ("E", "MU", "GA", "UY", "VX", "VY", "WA", "WB")}
    remainder = np.abs(solve(g, "VAX")["VAX"])
    assert 0 < remainder.max() <= 1e-13
    assert np.all(remainder <= error_bounds(g)["VAX"])


def test_a_wrong_digit_is_beyond_the_bound():
    g = scenes("casework", 50, 4)
    values, bounds = solve(g, NAMES), error_bounds(g, NAMES)
    for name in NAMES:
        moves = np.abs(values[name]) > 1e-3 * np.abs(values[name]).max()
        assert np.all(bounds[name][moves] < 1e-8 * np.abs(values[name][moves])), name


def test_sine_and_cosine():
    degrees = np.concatenate([np.linspace(-720, 720, 2881), [1e-300, 1e6 + 0.5, -1e11 - 0.25]])
    sine, cosine = sine_and_cosine(degrees)
    with mpmath.workdps(40):
        for x, s, c in zip(degrees, sine, cosine, strict=True):
            assert abs(mpmath.sinpi(mpmath.mpf(float(x)) / 180) - float(s)) < 2.3e-16
            assert abs(mpmath.cospi(mpmath.mpf(float(x)) / 180) - float(c)) < 2.3e-16
    sine, cosine = sine_and_cosine(np.arange(-4, 5) * 90.0)
    np.testing.assert_array_equal(sine, [0, 1, 0, -1, 0, 1, 0, -1, 0])
    np.testing.assert_array_equal(cosine, [1, 0, -1, 0, 1, 0, -1, 0, 1])


def test_the_reference_solves_equations_13_to_18():
    """In 50 digits, from its velocities and impulses alone."""
    g = scene_at(scenes("casework", 1, 6), 0)
    f = results(g)
    with mpmath.workdps(60):
        c, s = mpmath.cospi(mpmath.mpf(g["GA"]) / 180), mpmath.sinpi(mpmath.mpf(g["GA"]) / 180)
        after = c * (f["XAF"] - f["XBF"]) + s * (f["YAF"] - f["YBF"])
        before = c * (f["XA"] - f["XB"]) + s * (f["YA"] - f["YB"])
        spin = f["WAF"] - f["WBF"]
        moment = f["PM"] * (1 / mpmath.mpf(g["IA"]) + 1 / mpmath.mpf(g["IB"]))
        px, py = c * f["PN"] - s * f["PT"], s * f["PN"] + c * f["PT"]
        for residual in (
            g["MA"] * (f["VAX"] - g["UX"]) - px,
            g["MB"] * (f["VBY"] - g["VY"]) + py,
            after + g["E"] * before,
            f["PT"] - f["MUP"] * f["PN"],
            (1 - mpmath.mpf(g["EM"])) * spin - g["EM"] * moment,
        ):
            assert abs(residual) < 1e-44


def test_thirty_digits():
    digits = thirty_digits(sample(1))
    assert digits["UX"] if "UX" in digits else digits["VC"]
    assert digits["WAF"].startswith(f"{solve(sample(1), 'WAF')['WAF']:.12f}"[:10])
    zeros = {**sample(1).numbers(), "UX": 0.0, "UY": 0.0, "VX": 0.0, "VY": 0.0}
    assert thirty_digits(zeros)["VAX"] == "0"
    assert "LOSS" not in thirty_digits(zeros)
    assert thirty_digits({**zeros, "EM": 0.5, "DA": 0.0, "DB": 0.0}) == {}
    assert thirty_digits({**zeros, "MA": 0.0}) == {}
    with pytest.raises(UserError, match="expected a number"):
        thirty_digits({**sample(1), "MA": "heavy"})
