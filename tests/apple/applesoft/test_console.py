"""The keyboard and the screen: the monitor's GETLN, replies to INPUT, and the disk's commands."""

from __future__ import annotations

import pytest

from impact88.apple.applesoft import decimaltext, functions, real
from impact88.apple.applesoft.arrays import Array
from impact88.apple.applesoft.console import Console
from impact88.apple.applesoft.errorcodes import ApplesoftError
from impact88.apple.applesoft.operators import Real


def console(*lines: str) -> tuple[Console, list[str]]:
    screen_texts: list[str] = []
    keyboard = iter(lines)
    return Console(lambda: next(keyboard, None), screen_texts.append), screen_texts


@pytest.mark.parametrize(
    ("keys", "line", "screen"),
    [
        ("A", "A", "?A\n"),
        # BCKSPC $FD71: with nothing to delete GETLNZ begins a new line with the prompt
        ("\bA", "A", "?\b\n?A\n"),
        ("AB\b\b\bC", "C", "?AB\b\b\b\n?C\n"),
        # CANCEL $FD62: a backslash, then GETLNZ
        ("AB\x18CD", "CD", "?AB\x18\\\n?CD\n"),
    ],
)
def test_a_line_is_edited_as_the_monitor_does(keys: str, line: str, screen: str) -> None:
    c, screen_texts = console(keys)
    assert c.read_line("?") == line
    assert "".join(screen_texts) == screen


def test_a_full_line_is_abandoned() -> None:
    """$FD84: the 256th character cancels the line; the bell rings from the 249th on."""
    c, screen_texts = console("A" * 255 + "B")
    assert c.read_line("?") == ""
    assert "".join(screen_texts).endswith("B\a\\\n?\n")
    assert "".join(screen_texts).count("\a") == 8


@pytest.mark.parametrize(
    ("lines", "asked"),
    [(["1,2,3"], "?1,2,3\n"), (["1,2", "3"], "?1,2\n??3\n"), (["1", "2", "3"], "?1\n??2\n??3\n")],
)
def test_three_values_of_a_reply(lines: list[str], asked: str) -> None:
    c, screen_texts = console(*lines)
    (values,) = [[reply(None) for _ in range(3)] for reply in c.input(decimaltext.read)]
    assert values == [decimaltext.number(text) for text in "123"]
    assert "".join(screen_texts).replace("\0", "") == asked  # the monitor's own prompt


def test_control_d_speaks_to_the_disk() -> None:
    c, screen_texts = console()
    c.put("\x04PR#1\n")
    c.put("A\n")
    assert c.slot == 1
    assert screen_texts == ["A\n"]  # the printer's paper is the screen


def test_an_array_has_the_elements_that_DIM_names() -> None:
    array = Array([2, Real(decimaltext.number("3.9"))], lambda x: x, 0)
    assert array.sizes == [3, 4]
    array[2, 3] = 7
    assert array.data.index(7) == 2 + 3 * 3
    for place in ((3, 0), (0, 4)):
        with pytest.raises(ApplesoftError, match="BAD SUBSCRIPT"):
            array[place] = 1


def test_a_product_below_the_smallest_number_is_zero() -> None:
    half = 64, real.TOP, 0
    assert real.multiply((65, real.TOP, 0), (65, real.TOP, 0)) == (1, real.TOP, 0)
    assert real.multiply(half, (65, real.TOP, 0)) == real.ZERO


def test_random_numbers_lie_between_0_and_1() -> None:
    seed = decimaltext.number("-5")
    seed = functions.random(seed, real.ZERO)
    for _ in range(200):
        seed = functions.random(decimaltext.number("1"), seed)
        assert 0 < float(Real(seed)) < 1
    assert functions.random(real.ZERO, seed) == seed
