"""The three published runs: what the program prints, against golden files and against 1988."""

from __future__ import annotations

import re
from collections.abc import Callable
from decimal import Decimal
from importlib.resources import as_file, files

import pytest

from impact88.apple.captured import session
from impact88.program.copies import ListingCopy
from impact88.program.run import run
from impact88.program.scene import sample

PUBLISHED = [(1, "run1"), (2, "run2"), (3, "table3")]


def published_text(name: str) -> str:
    return (files("impact88.legacy") / f"{name}-as-printed.txt").read_bytes().decode()


def results(printout: str) -> str:
    """A printout from ``MA=`` on, blanks, line ends and asterisks left out: ERRATA says why."""
    return re.sub(r"[\s*]", "", printout[printout.index("MA=") :])


def replies(printout: str) -> list[str]:
    """Return what was typed after each question mark, without blanks (and without INPUT's NUL)."""
    return [re.sub(r"[ \0]", "", reply) for reply in re.findall(r"\?(.*)", printout)]


@pytest.mark.parametrize(("number", "name"), PUBLISHED)
def test_printout_is_the_golden_file_to_the_character(
    number: int, name: str, golden_printout: Callable[[str, str], None]
) -> None:
    golden_printout(run(sample(number)).printout, name)


@pytest.mark.parametrize("number", [1, 2, 3])
def test_a_copy_of_the_listing_prints_the_page_of_its_port(number: int) -> None:
    """On an Apple with a disk system, which takes line 190's PR# for itself."""
    with as_file(files("impact88.legacy") / "impact.bas") as path:
        copy = ListingCopy(str(path))
    assert copy.run(sample(number)).page == run(sample(number)).page


def test_an_apple_printed_these_numbers_in_1980_and_no_double_does() -> None:
    """COMPUTE!, September/October 1980, page 36, Table 5: interval halving, twenty steps twice."""
    folder = files("impact88.golden") / "printouts"
    numbers = [Decimal(text) for text in (folder / "compute1980.txt").read_text("utf-8").split()]
    _, output = session((folder / "compute1980.bas").read_text("utf-8"))
    assert [Decimal(text) for text in output.split()] == numbers
    assert len(numbers) == 40
    doubles = []
    for a, b, root in ((0.3, 0.4, 0.35740292), (2, 2.2, 2.1532922)):
        for _ in range(20):
            middle = (a + b) / 2
            doubles.append(Decimal(f"{middle:.9g}"))
            a, b = (middle, b) if middle < root else (a, middle)
    assert sum(x == y for x, y in zip(doubles, numbers, strict=True)) == 32


@pytest.mark.parametrize(("number", "name"), PUBLISHED)
def test_every_published_character_is_printed(number: int, name: str) -> None:
    assert results(run(sample(number)).printout) == results(published_text(name))


@pytest.mark.parametrize(("number", "name"), PUBLISHED)
def test_replies_are_those_typed_in_1988(number: int, name: str) -> None:
    keys = replies(run(sample(number)).printout)
    assert keys == replies(published_text(name))
    assert len(keys) == 2


@pytest.mark.parametrize("number", [1, 2])
def test_double_precision_misses_two_published_digits(number: int) -> None:
    """XB= 14.51 and YB= 25.14 are the arithmetic's, not the statements'."""
    exact, double = run(sample(number)).printout, run(sample(number), "float64").printout
    assert "XB= 14.51 YB= 25.14\n" in exact
    assert double == exact.replace("XB= 14.51 YB= 25.14\n", "XB= 14.52 YB= 25.15\n")
