"""`impact88.prepared`: the bits of `solve`, whatever is given at the call and whatever stays."""

from __future__ import annotations

import pickle
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from typing import Any

import numpy as np
import pytest
from longer import long_but
from mixedscenes import mixed_scenes, same

import impact88
from impact88.errors import UserError
from impact88.mechanics import native
from impact88.names import FINAL_VELOCITIES, RESULTS, SCENE
from impact88.status import Status

SCENE_NAMES = tuple(SCENE)
NUMBERS = impact88.sample(1).numbers()


def agree(given: dict[str, Any], expected: dict[str, Any]) -> None:
    assert list(given) == list(expected)
    for name, values in expected.items():
        assert given[name].dtype == values.dtype, name
        assert given[name].shape == values.shape, name
        assert np.all(same(given[name], values)), name


@pytest.fixture(params=["machine", "numpy"], autouse=True)
def path(request: pytest.FixtureRequest) -> Any:
    with native.switched_off() if request.param == "numpy" else nullcontext():
        yield request.param


@pytest.mark.parametrize("outputs", [None, FINAL_VELOCITIES, "STATUS", "LOSS,STATUS,DVA"])
def test_scenes_of_every_kind_have_the_bits_of_solve(outputs: Any) -> None:
    g = mixed_scenes(1500)
    rows = np.array([g[name] for name in SCENE_NAMES])
    call = impact88.prepared(SCENE_NAMES, outputs)
    for count in (1500, 129, 8, 1, 0):
        some = {name: values[:count] for name, values in g.items()}
        agree(call(rows[:, :count].copy()), impact88.solve(some, outputs))
    agree(
        call(rows.reshape(-1, 3, 500)[:, :, ::2]),
        impact88.solve(
            {name: values.reshape(3, 500)[:, ::2] for name, values in g.items()}, outputs
        ),
    )
    for i in range(0, 1500, 61):
        one = {name: values[i] for name, values in g.items()}
        for values in (rows[:, i].copy(), list(one.values()), rows[:, i].tolist()):
            agree(call(values), impact88.solve(one, outputs))


@pytest.mark.parametrize("seed", long_but(range(6)))
def test_what_stays_may_be_any_of_the_inputs(seed: int) -> None:
    rng = np.random.default_rng(seed)
    g = mixed_scenes(40, seed)
    for i in range(40):
        names = rng.permutation(SCENE_NAMES)[: rng.integers(1, len(SCENE_NAMES))].tolist()
        scene = {name: values[i] for name, values in g.items()}
        outputs = rng.permutation(list(RESULTS))[: rng.integers(1, 5)].tolist()
        call = impact88.prepared(names, outputs, scene)
        some = {name: g[name] for name in names}
        agree(call(list(some.values())), impact88.solve({**scene, **some}, outputs))


def test_results_of_earlier_calls_stay_what_they_are() -> None:
    call = impact88.prepared("MU", "LOSS,STATUS", NUMBERS)
    for count in (1, 5000, 70000):
        kept, values = [], np.linspace(0.1, 0.9, 3)
        for mu in values:
            kept.append(call(np.full((1, count), mu)))
        for mu, found in zip(values, kept, strict=True):
            agree(found, impact88.solve({**NUMBERS, "MU": np.full(count, mu)}, "LOSS,STATUS"))


@pytest.mark.parametrize("outputs", ["LOSS,STATUS,DVA", "VAX", "STATUS"])
@pytest.mark.parametrize("units", ["", "us"])
def test_bound_arrays_are_read_anew_and_written_over_by_each_call(outputs: str, units: str) -> None:
    scene = {**impact88.sample(1), **({"units": units} if units else {})}
    call = impact88.prepared(["MU", "UX"], outputs, scene)
    rng = np.random.default_rng(1)
    for shape in ((1500,), (3, 5), (), (0,), (70_000,)):
        values = np.empty((2, *shape))
        bound = call.bind(values)
        results = dict(bound.results)
        for _ in range(2):
            values[0], values[1] = rng.choice([0.3, -10.0, np.nan], shape), 19.8
            assert bound() is bound.results
            agree(bound.results, {name: np.asarray(x) for name, x in call(values).items()})
            assert all(bound.results[name] is array for name, array in results.items())


@pytest.mark.parametrize("name", ["LOSS", "STATUS"])
def test_bound_results_before_the_first_call_are_none(name: str) -> None:
    found = impact88.prepared("MU", name, NUMBERS).bind(np.zeros((1, 2))).results[name]
    assert np.all(np.isnan(found) if name == "LOSS" else found == int(Status.NOT_FINITE))


@pytest.mark.parametrize(
    "values",
    [[[0.1, 0.2]], np.zeros((1, 4))[:, ::2], np.zeros((1, 2), np.float32), np.zeros((2, 2)), 0.1],
)
def test_what_cannot_be_bound_is_refused(values: Any) -> None:
    call = impact88.prepared("MU", "LOSS", NUMBERS)
    with pytest.raises(UserError, match="expected"):
        call.bind(values)


def test_the_machine_may_be_switched_off_between_calls() -> None:
    values = np.full((1, 9), 0.4)
    bound = impact88.prepared("MU", "LOSS", NUMBERS).bind(values)
    first = bound()["LOSS"].copy()
    with native.switched_off():
        values[:] = 0.5
        second = bound()["LOSS"].copy()
    agree({"LOSS": bound()["LOSS"]}, {"LOSS": second})
    assert not np.any(first == second)


def test_threads_may_share_it() -> None:
    call = impact88.prepared(["MU", "E"], FINAL_VELOCITIES, NUMBERS)
    rng = np.random.default_rng(0)
    every = [rng.random((2, 700)) for _ in range(24)]
    with ThreadPoolExecutor(4) as pool:
        for values, found in zip(every, pool.map(call, every), strict=True):
            mu, e = values
            expected = impact88.solve({**NUMBERS, "MU": mu, "E": e}, FINAL_VELOCITIES)
            agree(found, expected)


def test_other_processes_can_have_it() -> None:
    call = impact88.prepared(["MU", "E"], "DVA", NUMBERS)
    call([0.5, 0.1])
    again = pickle.loads(pickle.dumps(call))
    assert (again.names, again.outputs) == (("MU", "E"), ("DVA",))
    agree(again([0.5, 0.1]), call([0.5, 0.1]))


def test_memory_that_cannot_be_read_in_place_is_copied() -> None:
    call = impact88.prepared(["MU", "E"], "DVA", NUMBERS)
    plain = np.array([[0.2, 0.5, 0.7], [0.1, 0.2, 0.3]])
    expected = call(plain)
    kept = plain.copy()
    kept.flags.writeable = False
    misaligned = np.frombuffer(b"\0" + plain.tobytes(), np.uint8)[1:].view(np.float64)
    for other in (
        kept,
        misaligned.reshape(2, 3),
        np.asfortranarray(plain),
        plain.astype(">f8"),
        plain.tolist(),
        [["0.2", ".5", ".7"], plain[1]],
        np.array(plain, object),
    ):
        agree(call(other), expected)


def test_units_and_texts_are_read_as_solve_reads_them() -> None:
    us = {"units": "us", **impact88.sample(1), "UX": "-19.8", "MA": "4616 lb", "VX": "9.9"}
    call = impact88.prepared(["UY", "E"], "DVA,LOSS", us)
    expected = impact88.solve({**us, "UY": np.array([3.0, -4.0]), "E": 0.2}, "DVA,LOSS")
    agree(call([[3.0, -4.0], [0.2, 0.2]]), expected)
    agree(call(np.array([[3.0, -4.0], [0.2, 0.2]])), expected)
    typed = impact88.prepared("E", "LOSS", impact88.sample(1))
    agree(typed([0.2]), impact88.solve({**impact88.sample(1), "E": 0.2}, "LOSS"))


@pytest.mark.parametrize(
    ("names", "outputs", "scene", "told"),
    [
        ([], None, NUMBERS, "no scene name"),
        (["MU"], [], NUMBERS, "no result name"),
        (["MUX"], None, NUMBERS, "'MUX' is not a scene name"),
        (["MU"], ["VA"], NUMBERS, "'VA' is not a result name"),
        (["MU", "MU"], None, NUMBERS, "stands twice"),
        (["MU"], None, {"UX": 3}, "missing: E EM DA"),
        (["E"], None, {**NUMBERS, "MU": [0.1, 0.2]}, "MU holds more than one number"),
        (["E"], None, {**NUMBERS, "MU": "85 %"}, "share of the critical friction"),
        (["E"], None, {**NUMBERS, "MU": ["85 %"]}, "share of the critical friction"),
        (["UX"], None, {**NUMBERS, "TA": "course"}, "TA = .course. follows from velocities"),
        (["E"], None, {**NUMBERS, "MU": "much"}, "much"),
        (["E"], None, {**NUMBERS, "speed": 3}, "'speed' is not a scene name"),
    ],
)
def test_unusable(names: Any, outputs: Any, scene: Any, told: str) -> None:
    with pytest.raises(UserError, match=told):
        impact88.prepared(names, outputs, scene)


@pytest.mark.parametrize(
    "values",
    [
        None,
        3.0,
        np.array(3.0),
        "0.5",
        {"MU": 1},
        [1],
        [1, 2, 3],
        np.ones((3, 5)),
        [[1, 2], [1, 2, 3]],
        [[1, [2]], 3],
        ["much", 1],
        [10**400, 1],
        [1j, 2],
    ],
    ids=str,
)
def test_unusable_values(values: Any) -> None:
    call = impact88.prepared(["MU", "E"], "DVA", NUMBERS)
    with pytest.raises(UserError):
        call(values)


def test_a_scene_without_what_point_masses_need_not() -> None:
    some = {n: NUMBERS[n] for n in ("GA", "MA", "MB", "UX", "UY", "VX", "VY", "WA", "WB", "MU")}
    call = impact88.prepared("E", "LOSS", {**some, "M": 4})
    agree(call([0.3]), impact88.solve({**some, "M": 4, "E": 0.3}, "LOSS"))
