"""What public functions say of an argument of another kind, and what their annotations admit."""

from __future__ import annotations

import contextlib
import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import product
from typing import Any, Literal

import numpy as np
import pytest

import impact88
from impact88.messages.argumentkinds import describe, fits
from impact88.messages.arguments import explains_arguments

SCENE = impact88.sample(1)
NUMBERS = SCENE.numbers()
KNOWN = {name: value for name, value in NUMBERS.items() if name != "MU"} | {"VAX": -13.263}
COLINEAR = {"MA": 154.7, "MB": 99.1, "E": 0.071, "MUP": 0, "UN": -56.76, "UT": 0, "VN": 0, "VT": 0}
CAR = {"DA": 7.59, "GA": -30, "PA": -19.8, "TA": 0, "MA": 143.5, "IA": 3728, "E": 0.1}
CAR |= {"MU": 0.4, "EM": -1, "UX": -29, "UY": 0, "WA": 0}
GOOD: dict[str, Any] = {
    "solve": NUMBERS,
    "run": SCENE,
    "bounds": {**NUMBERS, "MU": "0.7 .. 0.9"},
    "replay": {name: [text] for name, text in SCENE.items()},
    "oracle": SCENE,
    "verify": "x\n",
    "sample": 1,
    "solve_frame": [dict(NUMBERS)],
    "scene_svg": SCENE,
    "solve_for": KNOWN,
    "barrier": CAR,
    "colinear": COLINEAR,
    "delta_v": {"MA": 96, "MB": 145, "SA": 36.667, "SB": 58.667, "LOSS": 37.4},
}
THINGS = [None, 7, -1, 2.5, b"\xff", "x", ["x"], [1], {1: 2}, object(), np.zeros((2, 2)), 1j]
THINGS += [lambda *_: 0, lambda: 0, lambda a, b: 0]


def parameters(name: str) -> list[str]:
    function = getattr(impact88, name)
    return list(inspect.signature(function).parameters)


@pytest.mark.parametrize("name", GOOD)
def test_an_argument_of_another_kind_is_a_user_error(name: str) -> None:
    """Every parameter of every public function is given everything; it computes, or says what it
    expects, and nothing else comes out."""
    function = getattr(impact88, name)
    quick = {"samples": 10, "outputs": "LOSS"} if name == "bounds" else {}
    first, *_ = parameters(name)
    for parameter, thing in product(parameters(name), THINGS):
        arguments = {first: GOOD[name], **quick, parameter: thing}
        with contextlib.suppress(impact88.UserError):
            function(**arguments)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("gauss", 1, 0, 2), "kind is 'gauss'; expected one of fixed uniform triangular normal"),
        (("uniform", "1", 0, 2), "nominal is '1'; expected a number"),
        (("uniform", 1, 2, 0), "low is 2 and high 0; expected low <= high"),
        (("uniform", 1, 0, np.nan), "high nan"),
        (("normal", 1, 0, 2, -0.1), "deviation is -0.1; expected 0 or more"),
    ],
)
def test_a_range_that_is_none_is_a_user_error(arguments: tuple[Any, ...], words: str) -> None:
    with pytest.raises(impact88.UserError, match=words):
        impact88.Uncertain(*arguments)


def test_a_normal_without_a_deviation_is_exact() -> None:
    exact = impact88.Uncertain("normal", 0.5, 0.2, np.inf, 0)
    assert exact.quantile(0.9) == exact.draws(np.random.default_rng(1), 2)[1] == 0.5
    assert impact88.bounds({**NUMBERS, "MU": exact, "E": "0 .. 0.1"}, "LOSS", samples=10)


def test_an_error_that_no_argument_explains_stays_what_it_is() -> None:
    @explains_arguments
    def broken(number: int) -> int:
        raise KeyError(number)

    with pytest.raises(KeyError):
        broken(3)
    with pytest.raises(impact88.UserError, match="broken: number is 'x'; expected a whole number"):
        broken("x")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="missing"):
        broken()  # type: ignore[call-arg]


@pytest.mark.parametrize(
    ("hint", "good", "bad", "words"),
    [
        (int, [3, np.int64(3)], [3.0, True, "3", None], "a whole number"),
        (float, [3, 3.0, np.float32(3)], ["3", None, 1j, np.zeros(2)], "a number"),
        (bool, [True, np.bool_(False)], [1, None, np.zeros(2)], "True or False"),
        (str | None, ["", None], [b"", 3], "text or None"),
        (
            Sequence[str] | str,
            ["x", ["x"], ("x",)],
            [[1], {"x": 1}, 3],
            "a sequence of text or text",
        ),
        (
            Mapping[str, float],
            [{"x": 1}],
            [{1: 1}, {"x": "1"}, [1]],
            "a mapping of text to a number",
        ),
        (Callable[..., object], [len, int, lambda: None], [None, 3], "a function"),
        (
            Callable[[int], object],
            [len, int, print, lambda a, b=1: a],
            [None, 3, lambda: None, lambda a, b: a],
            "a function of 1 value",
        ),
        (Literal["a", "b"], ["a"], ["c", None], "'a' or 'b'"),
        (Iterable[str], [["x"], "x", iter([])], [3, None], "an iterable of text"),
        (
            tuple[str, int],
            [("a", 1)],
            [("a",), ("a", "b"), ["a", 1]],
            "a tuple of text or a whole number",
        ),
        (Any, [None, 3], [], "any value"),
    ],
)
def test_annotations(hint: Any, good: list[Any], bad: list[Any], words: str) -> None:
    assert [value for value in good if not fits(value, hint)] == []
    assert [value for value in bad if fits(value, hint)] == []
    assert describe(hint) == words


def test_a_seed_below_zero_and_a_callback_of_other_values_are_user_errors() -> None:
    known = GOOD["bounds"]
    with pytest.raises(impact88.UserError, match="seed is -1; expected a whole number, 0 or more"):
        impact88.bounds(known, samples=10, seed=-1)
    with pytest.raises(impact88.UserError, match=r"progress is .*; expected a function of 1 value"):
        impact88.bounds(known, samples=10, progress=lambda: None)  # type: ignore[misc, arg-type]
