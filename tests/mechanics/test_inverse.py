"""Impacts from velocities before or after, what follows from them, and what is impossible."""

import itertools
from math import cos, hypot, radians, sin

import numpy as np
import pytest
from populations import scenes
from worked_cases import RUN_1

from impact88 import UserError, evaluate, solve
from impact88.mechanics.inverse import complete
from impact88.mechanics.laws import BROKEN, Scale, friction_range, margins
from impact88.names import COEFFICIENTS, FINAL_STATE, IMPULSES, RESULTS, VELOCITIES
from impact88.status import IMPOSSIBLE

PAIRS = list(zip(VELOCITIES, FINAL_STATE, strict=True))
LAW_PAIRS = list(zip(COEFFICIENTS, IMPULSES, strict=True))


def cars(count=40, seed=3):
    """Return cars, and all of their impacts; E and EM away from 0, where no inverse exists."""
    g = scenes("casework", count, seed)
    g["E"], g["EM"] = g["E"] + 0.05, 0.9 * g["EM"] - 0.1
    return g, {**g, **solve(g)}


def inputs_of(impacts, late, as_impulse):
    """Return what is known of impacts: velocities ``late`` or early, laws by impulse or not."""
    names = [b if z else a for (a, b), z in zip(PAIRS, late, strict=True)]
    names += [b if z else a for (a, b), z in zip(LAW_PAIRS, as_impulse, strict=True)]
    bodies = ("MA", "MB", "IA", "IB", "DA", "DB", "PA", "PB", "TA", "TB", "GA", "M")
    return {name: impacts[name] for name in (*bodies, *names)}


def test_every_mixture_gives_the_same_impact():
    _, impacts = cars()
    rng = np.random.default_rng(1)
    mixtures = [([True] * 6, [False] * 3), ([False] * 6, [False] * 3)]
    mixtures += [(rng.random(6) < 0.5, rng.random(3) < 0.5) for _ in range(40)]
    for late, as_impulse in mixtures:
        values = complete(inputs_of(impacts, late, as_impulse)).values
        for name in (*VELOCITIES, *FINAL_STATE, *COEFFICIENTS, *IMPULSES, "MU"):
            size = np.abs(impacts[name]).max()
            error = np.median(np.abs(values[name] - impacts[name]))
            assert error <= 1e-12 * size, (name, late, as_impulse)
    values, missing = evaluate(values, list(RESULTS))
    assert not missing
    for name in ("XAF", "VS", "KF", "LOSS", "MUC", "STATUS"):
        np.testing.assert_allclose(values[name], impacts[name], rtol=1e-7, atol=1e-7)


@pytest.mark.parametrize(("late", "as_impulse"), list(itertools.product((0, 1, 5), (0, 1, 2))))
def test_the_volume_is_the_determinant_of_differences(late, as_impulse):
    _, impacts = cars(1, 7)
    inputs = {
        name: float(np.squeeze(value))
        for name, value in inputs_of(
            impacts,
            [k < late for k in range(6)],
            [k < as_impulse for k in range(3)],
        ).items()
    }
    free = [b if k < late else a for k, (a, b) in enumerate(PAIRS)]
    free += [b if k < as_impulse else a for k, (a, b) in enumerate(LAW_PAIRS)]
    rows = []
    for name in free:
        step = 1e-6 * max(abs(inputs[name]), 1.0)
        upper = complete({**inputs, name: inputs[name] + step}).values
        lower = complete({**inputs, name: inputs[name] - step}).values
        row = [(upper[x] - lower[x]) / (2 * step) for x in (*VELOCITIES, *COEFFICIENTS)]
        rows.append([float(x) for x in row])
    volume = np.log(abs(np.linalg.det(np.array(rows))))
    assert float(complete(inputs).log_volume) == pytest.approx(volume, abs=1e-5)


def test_there_is_no_inverse_without_rebound_moment_or_sliding():
    _, impacts = cars(3)
    for change in ({"E": np.zeros(3)}, {"EM": np.zeros(3)}, {"MUP": np.full(3, -10.0)}):
        inputs = {**inputs_of(impacts, [True] * 6, [False] * 3), **change}
        values = complete(inputs).values
        sizes = np.abs([values[name] for name in VELOCITIES])
        assert np.all(~np.isfinite(sizes).all(axis=0) | (sizes.max(axis=0) > 1e9))


def test_points_and_what_is_missing():
    point = {"M": 4.0, "MA": 90.0, "MB": 120.0, "GA": 10.0, "WA": 1.0, "WB": 0.0}
    point |= {"UX": -40.0, "UY": 3.0, "VX": 10.0, "VY": 0.0, "E": 0.3, "MU": 0.1}
    results = {**point, **solve(point)}
    names = ("M", "MA", "MB", "GA", "VAX", "VAY", "VBX", "VBY", "WA", "WBF", "E", "MUP")
    values = complete({name: results[name] for name in names}).values
    for name in ("UX", "UY", "VX", "VY", "WAF", "WB"):
        assert values[name] == pytest.approx(results[name], rel=1e-12)
    with pytest.raises(UserError, match="missing UX or VAX, EM or PM"):
        complete({n: x for n, x in {**RUN_1, "MUP": 0.1}.items() if n not in ("UX", "EM")})


def test_consequences_by_plain_trigonometry():
    _, impacts = cars(200, 5)
    names = "SA HA SAF HBF DVAF DVAR DVBF DVBR PDOFA PDOFB P EL DT CAX CAY CBX CBY RR0".split()
    values, missing = evaluate(impacts, names)
    assert not missing
    x, y = impacts["VAX"] - impacts["UX"], impacts["VAY"] - impacts["UY"]
    front = np.radians(impacts["TA"]) + np.pi
    forward, right = x * np.cos(front) + y * np.sin(front), x * np.sin(front) - y * np.cos(front)
    np.testing.assert_allclose(values["DVAF"], forward, atol=1e-9)
    np.testing.assert_allclose(values["DVAR"], right, atol=1e-9)
    # a force from straight ahead pushes backward, one from the right to the left
    clockwise = np.degrees(np.arctan2(-right, -forward))
    turns = (values["PDOFA"] - clockwise) / 360
    np.testing.assert_allclose(turns, np.round(turns), atol=1e-9)
    assert np.all((values["PDOFA"] > -180) & (values["PDOFA"] <= 180))
    np.testing.assert_allclose(np.hypot(values["DVBF"], values["DVBR"]), impacts["DVB"])
    np.testing.assert_allclose(values["SAF"], np.hypot(impacts["VAX"], impacts["VAY"]))
    np.testing.assert_allclose(np.tan(np.radians(values["HA"])), impacts["UY"] / impacts["UX"])
    np.testing.assert_allclose(values["EL"], impacts["KI"] - impacts["KF"], atol=1e-6)
    # both vehicles have the contact point where their velocities differ by spin alone
    spin_x = impacts["XA"] - impacts["UX"]
    np.testing.assert_allclose(-values["CAY"] * impacts["WA"], spin_x, atol=1e-9)
    assert np.isnan(evaluate({"UX": 0.0, "UY": 0.0}, "HA")[0]["HA"])


def test_velocities_alone_give_what_needs_no_geometry():
    _, impacts = cars(20)
    inputs = {n: impacts[n] for n in ("MA", "MB", "IA", "IB", *VELOCITIES, *FINAL_STATE, "GA")}
    names = ("DVA", "DVB", "KI", "KF", "LOSS", "PN", "PT", "MUP", "VC")
    values, missing = evaluate(inputs, names)
    assert missing == {"VC": ("DA", "DB", "PA", "PB", "TA", "TB")}
    for name in values:
        np.testing.assert_allclose(values[name], impacts[name], rtol=1e-6, err_msg=name)


def laws_by_hand(scene, after):
    """Return the bits of broken laws, from velocities alone."""
    n = cos(radians(scene["GA"])), sin(radians(scene["GA"]))
    before = [scene[name] for name in VELOCITIES]

    def contact(ux, uy, wa, vx, vy, wb):
        a, b = radians(scene["TA"] + scene["PA"]), radians(scene["TB"] + scene["PB"])
        x = ux + wa * scene["DA"] * sin(a) - vx + wb * scene["DB"] * sin(b)
        y = uy - wa * scene["DA"] * cos(a) - vy - wb * scene["DB"] * cos(b)
        return x * n[0] + y * n[1]

    def energy(ux, uy, wa, vx, vy, wb):
        linear = scene["MA"] * hypot(ux, uy) ** 2 + scene["MB"] * hypot(vx, vy) ** 2
        return 0.5 * (linear + scene["IA"] * wa**2 + scene["IB"] * wb**2)

    push = scene["MA"] * ((after[0] - before[0]) * n[0] + (after[1] - before[1]) * n[1])
    bits = 1 * (contact(*before) >= 0) + 2 * (push < 0)
    bits += 8 * (energy(*after) > energy(*before) * (1 + 1e-12))
    bits += 16 * (not 0 <= scene["E"] <= 1)
    return bits + 1024 * (not -1 <= scene["EM"] <= 0 and scene["EM"] != 1)


def test_random_impacts_break_the_laws_that_their_velocities_show():
    rng = np.random.default_rng(52)
    union = 0
    for _ in range(200):
        scene = {name: value * rng.uniform(0.5, 2) for name, value in RUN_1.items()}
        scene |= dict(zip(VELOCITIES, rng.normal(0, (20, 20, 1, 20, 20, 1)).tolist(), strict=True))
        scene |= {"M": 6.0, "GA": rng.uniform(-180, 180), "E": rng.uniform(-0.5, 1.5)}
        scene |= {"EM": rng.choice([1, 0, -0.5, rng.uniform(-2, 2)]), "MU": rng.uniform(-2, 2)}
        results = solve(scene)
        bits = laws_by_hand(scene, [float(results[name]) for name in FINAL_STATE])
        assert bits == int(results["STATUS"]) & IMPOSSIBLE
        parts = margins({**scene, **results})
        assert parts.keys() == BROKEN.keys()
        for name, bit in (("approach", 1), ("push", 2), ("energy", 8), ("E", 16), ("EM", 1024)):
            assert (min(map(float, parts[name])) < 0) >= bool(bits & bit), name
        union |= bits
    assert union == IMPOSSIBLE


def test_margins_are_pure_numbers_with_both_ends():
    g, impacts = cars(50)
    plain = margins(impacts)
    speed, mass = 3.0, 7.0
    in_units = margins(impacts, Scale(speed, mass, 2.0))
    np.testing.assert_allclose(in_units["push"][0], plain["push"][0] / (speed * mass))
    np.testing.assert_allclose(in_units["energy"][0], plain["energy"][0] / (mass * speed**2))
    for name, value in (("E", g["E"]), ("EM", g["EM"] + 1)):
        low, high = plain[name]
        # the two ends divide the range as the coefficient does
        np.testing.assert_allclose(low / (low + high), value, rtol=1e-9)
    low, high = friction_range(impacts["MUC"])
    inside = (impacts["MUP"] >= low) & (impacts["MUP"] <= high)
    pushes = impacts["PN"] > 0
    np.testing.assert_array_equal((np.min(plain["friction"], axis=0) >= 0)[pushes], inside[pushes])
    points = margins({**impacts, **solve({**g, "M": 4.0}), "M": 4.0})
    assert not np.any(points["EM"])  # without a moment, on the ends


@pytest.mark.parametrize(("critical", "low", "high"), [(0.5, -0.2, 0.7), (-1.0, -1.3, 0.3)])
def test_the_allowance_of_friction(critical, low, high):
    assert friction_range(critical) == (pytest.approx(low), pytest.approx(high))
    assert friction_range(np.nan)[1] == 10.0
