"""Inputs removed one by one: a result is absent only if it uses the input, and then names it."""

import os

import numpy as np
import pytest
from longer import long_but

import impact88
from impact88.errors import UserError
from impact88.names import SCENE
from impact88.status import Status

PROBLEMS = int(os.environ.get("IMPACT88_EXAMPLES") or 4)  # .ci/run takes more
UNUSED_BY_POINTS = {"DA", "DB", "PA", "PB", "TA", "TB", "IA", "IB", "EM"}
KINDS = {
    "planar": {},
    "planar pivot": {"MU": -10.0},
    "point masses": {"M": 4.0},
    "locked": {"M": 4.0, "E": 0.0, "MU": -10.0},
    "smooth": {"MU": 0.0},
    "barrier": {"MB": np.inf, "IB": np.inf, "VX": 0.0, "VY": 0.0, "WB": 0.0},
    "no arms": {"DA": 0.0, "DB": 0.0},
}


def random_scene(rng: np.random.Generator, kind: str) -> dict[str, float]:
    scene = impact88.sample(1).numbers()
    for name in ("DA", "DB", "MA", "MB", "IA", "IB"):
        scene[name] *= rng.uniform(0.5, 2)
    for name in ("GA", "PA", "PB", "TA", "TB"):
        scene[name] = rng.uniform(-180, 180)
    for name, size in (("UX", 40), ("UY", 40), ("VX", 40), ("VY", 40), ("WA", 2), ("WB", 2)):
        scene[name] = rng.normal(0, size)
    scene |= {"E": rng.uniform(0, 0.5), "EM": rng.uniform(-1, 0), "MU": rng.uniform(0.1, 0.9)}
    return {name: float(value) for name, value in {**scene, **KINDS[kind]}.items()}


def uses(scene: dict[str, float], name: str, result: str, rng: np.random.Generator) -> bool:
    """Whether other values of an input give another result, however large or small."""
    spread = [-1e6, -30, -1, -0.1, 0.1, 1, 30, 1e6] if name[0] in "UVW" else [0.3, 0.7, 1.4, 3]
    if name in ("DA", "DB"):
        spread = [0.1, 1, 30, 1e4]
    if name in ("GA", "TA", "TB", "PA", "PB"):
        spread = list(rng.uniform(-180, 180, 8))
    if name in ("E", "MU"):
        spread = list(rng.uniform(0.05, 0.95, 8))
    if name == "EM":
        spread = list(rng.uniform(-0.95, -0.05, 8))
    if name[0] in "MI" and name not in ("MU", "M"):
        spread = [(scene[name] or 1.0) * x if np.isfinite(scene[name]) else 100 * x for x in spread]
    values = np.asarray(impact88.solve({**scene, name: spread}, [result])[result], float)
    sizes = np.abs(values).max()
    return bool(np.ptp(values) > 1e-7 * sizes) if np.isfinite(values).all() else True


@pytest.mark.parametrize("kind", long_but(KINDS, kept=(2,)))
def test_inputs_removed_one_by_one(kind):
    rng = np.random.default_rng(52)
    results = [name for name in impact88.names.RESULTS if name not in ("STATUS", "COND")]
    for number in range(PROBLEMS):
        scene = random_scene(rng, kind)
        whole = impact88.solve(scene, results)
        for name in SCENE:
            at_rest = kind == "barrier" and name in ("VX", "VY", "WB")  # as a barrier is
            if name == "M" or np.isinf(scene[name]) or at_rest:
                continue
            given = {other: value for other, value in scene.items() if other != name}
            found = impact88.solve(given, [*results, "STATUS", "KI", "MUP"])
            absent = getattr(found, "absent", {})
            assert {*found} | {*absent} == {*results, "STATUS"}
            for result in results:
                if result in found:
                    sizes = [abs(x) for x in whole.values() if np.isfinite(x)]
                    assert found[result] == pytest.approx(
                        whole[result], rel=1e-9, abs=1e-12 * max(sizes), nan_ok=True
                    ), (kind, name, result)
                else:
                    assert absent[result] == (name,)
                if number < 3:
                    assert (result in absent) == uses(scene, name, result, rng), (name, result)
        assert kind != "point masses" or UNUSED_BY_POINTS.isdisjoint(
            {name for needs in absent.values() for name in needs}
        )


def test_columns_lack_what_their_scenes_lack():
    rng = np.random.default_rng(7)
    scenes = [random_scene(rng, "locked") for _ in range(20)]
    columns = {name: np.array([s[name] for s in scenes]) for name in SCENE if name != "GA"}
    found = impact88.solve(columns)
    assert {*found.absent} == {"VC", "ELN", "ELT", "PN", "PT", "MUC"}
    for i, scene in enumerate(scenes):
        del scene["GA"]
        alone = impact88.solve(scene)
        assert {*alone} == {*found}
        for name, value in alone.items():
            assert found[name][i] == pytest.approx(value, rel=1e-12, abs=1e-9)


@pytest.mark.long
def test_motion_along_one_line_needs_no_contact_plane():
    """Turned and exchanged: the same, by momentum and restitution along the line."""
    rng = np.random.default_rng(3)
    for _ in range(50):
        angle, u, v, e = rng.uniform(-180, 180), rng.normal(0, 30), rng.normal(0, 30), rng.uniform()
        x, y = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        ma, mb = rng.uniform(50, 200, 2)
        scene = {"M": 4, "MA": ma, "MB": mb, "E": e, "WA": 0, "WB": 0}
        scene |= {"UX": u * x, "UY": u * y, "VX": v * x, "VY": v * y}
        found = impact88.solve(scene)
        shared = (ma * u + mb * v) / (ma + mb)
        after = shared - e * mb * (u - v) / (ma + mb), shared + e * ma * (u - v) / (ma + mb)
        assert found["VAX"] == pytest.approx(after[0] * x, abs=1e-9)
        assert found["VAY"] == pytest.approx(after[0] * y, abs=1e-9)
        assert found["VBX"] == pytest.approx(after[1] * x, abs=1e-9)
        assert found["VC"] == pytest.approx(abs(u - v))
        assert found["PN"] > 0
        assert abs(found["PT"]) < 1e-9
        assert found["STATUS"] & ~np.uint16(Status.SINGULAR) == 0


def test_what_is_absent_says_what_it_needs():
    scene = impact88.sample(2).numbers()
    found = impact88.solve({name: value for name, value in scene.items() if name != "E"})
    with pytest.raises(KeyError, match=r"VAX needs E \(coefficient of restitution\)"):
        found["VAX"]
    with pytest.raises(KeyError, match="'NOTHING'"):
        found["NOTHING"]
    with pytest.raises(impact88.UserError, match="missing: UX; VAX and DVA need UX"):
        impact88.solve({n: v for n, v in scene.items() if n != "UX"}, ["VAX", "DVA"])


def test_an_impact_that_is_not_known_is_not_judged():
    scene = impact88.sample(1).numbers()
    found = impact88.solve({name: value for name, value in scene.items() if name != "MU"})
    assert found.absent["STATUS"] == ("MU",)


@pytest.mark.parametrize(("plane", "needs_friction"), [(30, False), (210, False), (-30, True)])
def test_a_plane_across_the_line_of_motion_needs_no_friction(plane, needs_friction):
    """Along 30 degrees: no friction acts where the normal is that line, whichever way it points."""
    x, y = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    scene = {"M": 4, "MA": 100, "MB": 80, "E": 0.2, "GA": plane}
    scene |= {"UX": -20 * x, "UY": -20 * y, "VX": 10 * x, "VY": 10 * y}
    if needs_friction:
        with pytest.raises(UserError, match="needs MU"):
            impact88.solve(scene, ["DVA"])
    else:  # m_b/(m_a + m_b) (1 + e) of the closing speed
        assert impact88.solve(scene, ["DVA"])["DVA"] == pytest.approx(80 / 180 * 1.2 * 30)
