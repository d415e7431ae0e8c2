"""One scene as plain numbers: the bits of the arrays, in every population, result and path."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from worked_cases import RUN_1

from impact88 import solve
from impact88.errors import UserError
from impact88.mechanics.accuracy.populations import POPULATIONS, scenes
from impact88.names import FINAL_VELOCITIES, RESULTS

pytestmark = pytest.mark.usefixtures("both_machines")


def as_arrays(columns: dict[str, Any]) -> dict[str, np.ndarray]:
    return solve({name: np.asarray(values) for name, values in columns.items()}, threads=1)


@pytest.mark.parametrize("name", POPULATIONS)
@pytest.mark.parametrize("change", [{}, {"MU": -10.0}, {"M": 4.0}, {"EM": 0.0, "WA": 0.0}])
def test_the_bits_of_the_arrays(name: str, change: dict[str, float]) -> None:
    g = scenes(name, 12, 14)
    g |= {key: np.full(12, value) for key, value in change.items()}
    together = as_arrays(g)
    for i in range(12):
        alone = solve({key: float(values[i]) for key, values in g.items()})
        for result in RESULTS:
            assert alone[result].tobytes() == together[result][i].tobytes(), (i, result)


def test_angles_of_many_turns_and_zeros() -> None:
    rng = np.random.default_rng(9)
    g = scenes("casework", 40, 15)
    for name in ("GA", "PA", "PB", "TA", "TB"):
        g[name] = g[name] * 10.0 ** rng.uniform(0, 9, 40)
    for name in ("UX", "WA", "WB", "DB", "MU", "VY", "E"):
        g[name] = np.where(rng.random(40) < 0.3, rng.choice([0.0, -0.0], 40), g[name])
    together = as_arrays(g)
    for i in range(40):
        alone = solve({key: float(values[i]) for key, values in g.items()})
        for result in RESULTS:
            assert alone[result].tobytes() == together[result][i].tobytes(), (i, result)


def test_a_selection_gives_the_same_bits() -> None:
    whole = solve(RUN_1)
    for name in RESULTS:
        assert solve(RUN_1, [name]) == {name: whole[name]}
    assert list(solve(RUN_1, "WBF,VAX")) == ["WBF", "VAX"]


def test_results_are_floats_from_any_plain_number() -> None:
    found = solve(RUN_1)
    assert all(isinstance(found[name], float) for name in RESULTS if name != "STATUS")
    for kind in (np.float64, np.array, np.float32):
        scene = {name: kind(value) for name, value in RUN_1.items()}
        assert solve(scene, "VAX")["VAX"].shape == ()
        assert isinstance(solve(scene, "VAX")["VAX"], float)
    whole = {**RUN_1, "MA": 144, "IA": 3728}
    assert solve(whole, "VAX") == solve({**whole, "MA": 144.0}, "VAX")
    assert solve({**RUN_1, "MA": [144.0]}, "VAX")["VAX"].shape == (1,)


@pytest.mark.parametrize(
    "change",
    [
        {"MA": 0.0},
        {"UX": float("nan")},
        {"M": 5},
        {"MB": float("inf"), "IB": float("inf"), "VX": 0.0, "VY": 0.0},
        {"UX": -1e160},
        dict.fromkeys(("UX", "UY", "WA", "VX", "VY", "WB"), 0.0),
        {"EM": 0.5, "DA": 0.0, "DB": 0.0},
        {"MA": 10**400},
    ],
    ids=str,
)
def test_what_is_out_of_the_ordinary(change: dict[str, float]) -> None:
    scene = {**RUN_1, **change}
    if change.get("MA") == 10**400:
        with pytest.raises((UserError, OverflowError)):
            solve(scene)
        return
    alone = solve(scene)
    together = as_arrays({name: [value] * 3 for name, value in scene.items()})
    for result in RESULTS:
        assert np.float64(alone[result]).tobytes() == np.float64(together[result][1]).tobytes()


def test_wrong_names_are_told_as_ever() -> None:
    with pytest.raises(UserError, match="'MX' is not a scene name"):
        solve({**RUN_1, "MX": 1.0})
    with pytest.raises(UserError, match="missing: UX"):
        solve({name: value for name, value in RUN_1.items() if name != "UX"}, ["VAX", "DVA"])
    with pytest.raises(UserError, match="'VX' is not a result name"):
        solve(RUN_1, ["VAX", "VX"])


class TestOut:
    def test_results_are_written_there(self) -> None:
        g = scenes("casework", 5000, 3)
        out = {name: np.full(5000, 7.0) for name in FINAL_VELOCITIES}
        found = solve(g, out=out)
        assert list(found) == list(FINAL_VELOCITIES)
        fresh = solve(g, FINAL_VELOCITIES)
        for name in FINAL_VELOCITIES:
            assert found[name] is out[name]
            np.testing.assert_array_equal(out[name], fresh[name])
        some = {"STATUS": np.empty((50, 100), np.uint16)}
        shaped = {name: values.reshape(50, 100) for name, values in g.items()}
        both = solve(shaped, ["VAX", "STATUS"], out=some)
        assert both["STATUS"] is some["STATUS"]
        np.testing.assert_array_equal(both["VAX"].ravel(), fresh["VAX"])

    @pytest.mark.parametrize(
        ("out", "says"),
        [
            ({"VAX": np.empty(3)}, r"out, VAX: is float64 \(3,\); expected an array of float64"),
            ({"VAX": np.empty(4, np.float32)}, "out, VAX: is float32"),
            ({"STATUS": np.empty(4)}, "out, STATUS: is float64"),
            ({"VAX": [0.0] * 4}, "out, VAX: is <class 'list'>"),
            ({"VAX": np.empty(8)[::2]}, "not contiguous"),
            ({"VAX": np.empty(33, np.uint8)[1:].view(np.float64)}, "not aligned"),
            ({"VBX": np.empty(4)}, "is not among the requested results"),
        ],
    )
    def test_refused(self, out: Any, says: str) -> None:
        wanted = ["VAX"] if "VBX" in out else None
        with pytest.raises(UserError, match=says):
            solve(scenes("casework", 4, 1), wanted, out=out)

    def test_a_column_is_not_written_over(self) -> None:
        g = scenes("casework", 4, 1)
        with pytest.raises(UserError, match="shares memory"):
            solve(g, out={"VAX": g["UX"]})
        room = np.empty(4)
        with pytest.raises(UserError, match="shares memory"):
            solve(g, out={"VAX": room, "VAY": room})
