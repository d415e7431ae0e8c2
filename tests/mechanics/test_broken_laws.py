"""An impossible impact breaks a law: beside a computation that shares no code with the verdict."""

from math import cos, hypot, radians, sin

import numpy as np
import pytest

import impact88
from impact88.mechanics.outcome import broken_laws, outcome
from impact88.mechanics.state import State
from impact88.status import IMPOSSIBLE, Status

NAMES = ("DA", "DB", "GA", "PA", "PB", "TA", "TB", "MA", "MB", "IA", "IB")
VELOCITIES = ("UX", "UY", "WA", "VX", "VY", "WB")


def laws(scene: dict[str, float], after: list[float]) -> int:
    """Bits of the laws broken, from velocities alone."""
    n = (cos(radians(scene["GA"])), sin(radians(scene["GA"])))

    def contact(ux, uy, wa, vx, vy, wb):
        a, b = radians(scene["TA"] + scene["PA"]), radians(scene["TB"] + scene["PB"])
        x = ux + wa * scene["DA"] * sin(a) - vx + wb * scene["DB"] * sin(b)
        y = uy - wa * scene["DA"] * cos(a) - vy - wb * scene["DB"] * cos(b)
        return x * n[0] + y * n[1]

    def energy(ux, uy, wa, vx, vy, wb):
        linear = scene["MA"] * hypot(ux, uy) ** 2 + scene["MB"] * hypot(vx, vy) ** 2
        return 0.5 * (linear + scene["IA"] * wa**2 + scene["IB"] * wb**2)

    before = [scene[name] for name in VELOCITIES]
    pushed = scene["MA"] * ((after[0] - before[0]) * n[0] + (after[1] - before[1]) * n[1])
    bits = 1 * (contact(*before) >= 0) + 2 * (pushed < 0)
    bits += 8 * (energy(*after) > energy(*before) * (1 + 1e-12))
    bits += 16 * (not 0 <= scene["E"] <= 1)
    return bits + 1024 * (not -1 <= scene["EM"] <= 0 and scene["EM"] != 1)


def random_scenes(count: int) -> list[dict[str, float]]:
    rng = np.random.default_rng(52)
    sample = impact88.sample(1).numbers()
    return [
        {
            **sample,
            **{name: sample[name] * rng.uniform(0.5, 2) for name in NAMES},
            **{name: float(x) for name, x in zip(VELOCITIES, rng.normal(0, 20, 6), strict=True)},
            "WA": float(rng.normal()),
            "WB": float(rng.normal()),
            "GA": float(rng.uniform(-180, 180)),
            "E": float(rng.uniform(-0.5, 1.5)),
            "EM": float(rng.choice([1, 0, -0.5, rng.uniform(-2, 2)])),
            "MU": float(rng.uniform(-2, 2)),
        }
        for _ in range(count)
    ]


def test_random_impacts_break_the_laws_that_their_velocities_show():
    seen = 0
    for scene in random_scenes(300):
        values = {**scene, **impact88.solve(scene)}
        after = [float(values[name]) for name in ("VAX", "VAY", "WAF", "VBX", "VBY", "WBF")]
        state = State.of_known({name: np.float64(x) for name, x in values.items()})
        expected = laws(scene, after)
        assert int(broken_laws(state)) == expected == int(outcome(values)["STATUS"]) & IMPOSSIBLE
        seen |= expected
    assert seen == IMPOSSIBLE


def test_arrays_break_what_their_elements_break():
    scenes = random_scenes(50)
    columns = {name: np.array([scene[name] for scene in scenes]) for name in scenes[0]}
    values = {**columns, **impact88.solve(columns)}
    together = broken_laws(State.of_known(values))
    one_by_one = [
        int(broken_laws(State.of_known({name: x[i] for name, x in values.items()})))
        for i in range(len(scenes))
    ]
    assert together.tolist() == one_by_one


@pytest.mark.parametrize(
    ("e", "broken"), [(1 + 1e-12, 0), (1 + 1e-6, 16), (-1e-12, 0), (-1e-6, 16)]
)
def test_rounding_of_a_coefficient_breaks_no_law(e, broken):
    scene = impact88.sample(1).numbers()
    values = {**scene, **impact88.solve({**scene, "E": 0.5}), "E": e}
    assert int(broken_laws(State.of_known(values))) == broken


def test_more_friction_than_ends_the_sliding_is_a_remark():
    """Six of the chapter's eleven staged collisions have it, with Table 2's own coefficients."""
    scene = impact88.sample(1).numbers()
    critical = float(abs(impact88.solve(scene, ["MUC"])["MUC"]))
    found = impact88.solve({**scene, "MU": 1.01 * critical}, ["STATUS"])["STATUS"]
    assert found & Status.FRICTION_ABOVE_CRITICAL
    assert not found & IMPOSSIBLE
