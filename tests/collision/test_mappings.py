"""The first calls people make in Python: a text means one thing everywhere, and whatever cannot be
used is a UserError."""

from __future__ import annotations

import doctest
import inspect
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import impact88
from impact88.conformance.comparison.compare import compare as compare_tables
from impact88.errors import UserError

SAMPLE = dict(impact88.sample(1))
NUMBERS = impact88.sample(1).numbers()
KNOWN = {name: text for name, text in SAMPLE.items() if name != "M"}
TWO = {"MA": 96, "MB": "145", "SA": 36, "SB": "58"}
COLINEAR = {"MA": "154.7", "MB": "99.1", "E": ".071", "UN": "-56.76"}
COLINEAR |= {"UT": "0", "VN": "0", "VT": "0"}
CAR = {name: SAMPLE[name] for name in "DA GA PA TA MA IA E EM UX UY WA".split()}

TEXTS: dict[str, float | None] = {
    ".5": 0.5,
    "1E": 1.0,
    ".": 0.0,
    "1 0": 10.0,
    " .2": 0.2,
    "1_0": None,
    "\u0663": None,
    "nan": None,
    "0x1": None,
    "": None,
}
"""A text, and the number that INPUT makes of it."""

DOORS: dict[str, Callable[[Any], Any]] = {
    "solve": lambda x: impact88.solve({**SAMPLE, "MU": x}, ["LOSS"]),
    "solve arrays": lambda x: impact88.solve({**NUMBERS, "MU": np.array([x])}, ["LOSS"]),
    "prepared": lambda x: impact88.prepared("E", "LOSS", {**SAMPLE, "MU": x})([0.1]),
    "solve_for": lambda x: impact88.solve_for({**KNOWN, "MU": x}),
    "bounds": lambda x: impact88.bounds({**SAMPLE, "E": "0 .. .1", "MU": x}, samples=10),
    "reconstruct": lambda x: impact88.reconstruct({**KNOWN, "MU": x}),
    "run": lambda x: impact88.run({**SAMPLE, "MU": x}),
    "Scene": lambda x: impact88.Scene({**SAMPLE, "MU": x}),
    "replay": lambda x: impact88.replay({**SAMPLE, "MU": x}),
    "oracle": lambda x: impact88.oracle({**SAMPLE, "MU": x}, reference=False),
    "scene_svg": lambda x: impact88.scene_svg({**SAMPLE, "MU": x}),
    "barrier": lambda x: impact88.barrier({**CAR, "MU": x}),
    "colinear": lambda x: impact88.colinear({**COLINEAR, "MUP": x}),
    "delta_v": lambda x: impact88.delta_v({**TWO, "LOSS": x}),
}


@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("door", DOORS)
def test_one_text_means_one_thing_everywhere(door: str, text: str) -> None:
    value = TEXTS[text]
    if value is None:
        with pytest.raises(UserError):
            DOORS[door](text)
        return
    found = DOORS[door](text)
    if door in ("solve", "barrier", "colinear", "delta_v", "solve arrays"):
        for name, same in DOORS[door](value).items():
            np.testing.assert_array_equal(found[name], same, name)


def test_a_frame_takes_the_same_texts_and_leaves_others_unsolved() -> None:
    for text, value in TEXTS.items():
        (row,) = impact88.solve_frame([{**NUMBERS, "MU": text}], "LOSS")
        same = math.nan if value is None else impact88.solve({**NUMBERS, "MU": value})["LOSS"]
        np.testing.assert_array_equal(row["LOSS"], same)


US = {"units": "us", **SAMPLE, "UX": "-19.8", "UY": "0 mph", "VX": "9.9", "VY": "25.15 ft/s"}
US |= {"MA": "4616 lb", "IA": "3728 slug ft2"}


@pytest.mark.parametrize("door", ["solve", "Scene", "bounds", "oracle", "scene_svg"])
def test_units_are_read_as_in_a_file(door: str) -> None:
    feet = impact88.Scene.from_mapping(US)
    assert feet["UX"] == "-29.04"
    if door == "solve":
        assert impact88.solve(US)["LOSS"] == impact88.solve(feet)["LOSS"]
        arrays = {**US, "UX": np.array([-19.8]), "WA": 0}
        np.testing.assert_allclose(impact88.solve(arrays)["LOSS"], impact88.solve(feet)["LOSS"])
    elif door == "bounds":
        ranges = impact88.bounds({**US, "UX": "-19.8 mph +- 2 mph"}, ["LOSS"], samples=10)
        assert ranges.inputs["UX"].nominal == pytest.approx(-29.04)
    elif door == "scene_svg":
        assert impact88.scene_svg(US).startswith("<svg")


def test_verify_takes_a_text_a_file_and_bytes(tmp_path: Path) -> None:
    page = impact88.run(impact88.sample(1)).page
    path = tmp_path / "page.txt"
    path.write_text(page, encoding="utf-8")
    for given in (page, str(path), path, page.encode()):
        assert [found.verdict.name for found in impact88.verify(given)] == ["IDENTICAL"]
    results = page[page.index(" E=") :]
    apart = {**NUMBERS, "UX": "-29.04"}
    assert [found.scene["MA"] for found in impact88.verify(results, apart)] == ["143.5"]


def test_compare_knows_the_form_by_the_name_and_oracle_one_scene(tmp_path: Path) -> None:
    row = {**NUMBERS, "LOSS": float(impact88.solve(NUMBERS)["LOSS"])}
    path = tmp_path / "theirs.jsonl"
    path.write_text(json.dumps(row))
    assert compare_tables(path).agreeing == compare_tables(str(path)).agreeing == 1
    del row["MA"]
    path.write_text(json.dumps(row))
    assert compare_tables(path, values={"MA": 143.5}).agreeing == 1
    (answer,) = impact88.oracle([impact88.sample(1)], reference=False)
    assert impact88.oracle(SAMPLE, reference=False) == [answer]
    assert impact88.oracle(NUMBERS, reference=False)[0]["results"] == answer["results"]


UNUSABLE: list[Callable[[], Any]] = [
    lambda: impact88.verify("none.txt"),
    lambda: impact88.verify(3),  # type: ignore[call-overload]
    lambda: impact88.run("crash.toml"),  # type: ignore[arg-type]
    lambda: impact88.solve("crash.toml"),  # type: ignore[arg-type]
    lambda: impact88.solve({**NUMBERS, "MU": [[1], [1, 2]]}),
    lambda: impact88.solve({**NUMBERS, "MU": None}),
    lambda: impact88.bounds({"MU": "0.7 .. 0.9"}),
    lambda: impact88.bounds({**NUMBERS, "MU": [0.7, 0.9]}),  # type: ignore[dict-item]
    lambda: impact88.bounds(3),  # type: ignore[arg-type]
    lambda: impact88.reconstruct({**KNOWN, "UX": object()}),  # type: ignore[dict-item]
    lambda: impact88.oracle([{**NUMBERS, "M": 5}]),
    lambda: impact88.oracle({**NUMBERS, "MU": math.nan}),
    lambda: impact88.oracle(["scene"]),  # type: ignore[list-item]
    lambda: compare_tables("none.csv"),
    lambda: compare_tables("none.what"),
    lambda: impact88.colinear({**COLINEAR, "MUP": "much"}),
    lambda: impact88.delta_v("a.toml"),  # type: ignore[arg-type]
    lambda: impact88.scene_svg("a.toml"),
    lambda: impact88.replay("a.toml"),  # type: ignore[arg-type]
    lambda: impact88.Scene("a.toml"),  # type: ignore[arg-type]
    lambda: impact88.solve_frame(3, "LOSS"),
]
THINGS: list[Any] = [None, 7, b"\xff", [], [1], {}, {1: 2}, {"MA": []}, object(), np.zeros((2, 2))]
FUNCTIONS = (
    "solve run bounds reconstruct oracle replay compare verify sample solve_frame solve_for "
)
FUNCTIONS += "scene_svg barrier colinear colinear_inverse delta_v Scene prepared"


@pytest.mark.parametrize("call", UNUSABLE, ids=range(len(UNUSABLE)))
def test_whatever_cannot_be_used_is_a_user_error(call: Callable[[], Any]) -> None:
    with pytest.raises(UserError):
        call()


@pytest.mark.parametrize("name", FUNCTIONS.split())
def test_a_thing_of_another_kind_is_a_user_error(name: str) -> None:
    for thing in THINGS:
        if isinstance(thing, list) and not thing and name in ("oracle", "solve_frame"):
            continue  # of no scenes, nothing
        with pytest.raises(UserError):
            getattr(impact88, name)(thing)


def test_a_frame_s_columns_may_have_numbers_for_names() -> None:
    (row,) = impact88.solve_frame([{**NUMBERS, 7: "note"}], "LOSS")
    assert row[7] == "note"
    assert row["LOSS"] == impact88.solve(NUMBERS)["LOSS"]


def test_results_wanted_may_stand_in_one_text() -> None:
    for names in (["DVA", "LOSS"], "DVA,LOSS", "DVA LOSS"):
        assert list(impact88.solve(NUMBERS, names)) == ["DVA", "LOSS"]
        found = impact88.bounds({**NUMBERS, "GA": "-30 +- 5"}, names, samples=10)
        assert list(found.bounds) == ["DVA", "LOSS"]


EXAMPLES = set(impact88.__all__) - {"__version__", "accelerated"}


@pytest.mark.parametrize("name", sorted(EXAMPLES))
def test_every_public_name_has_an_example_that_works(name: str) -> None:
    text = inspect.getdoc(getattr(impact88, name)) or ""
    test = doctest.DocTestParser().get_doctest(text, {"impact88": impact88}, name, None, 0)
    assert test.examples
    report: list[str] = []
    assert doctest.DocTestRunner().run(test, out=report.append).failed == 0, "".join(report)
