"""Rows first: exchanged, printed twice, and out of a retyped page's order."""

from __future__ import annotations

import dressedpages
import pytest
from longer import long_but

import impact88
import printouts
from impact88.printouts.reporting.examination import Verdict, Verification
from impact88.printouts.reporting.verification import lines

pytestmark = pytest.mark.usefixtures("verdicts_alone")
PAGE = impact88.run(impact88.sample(1)).page
FIRST = ("MA=", "DA=", " PA", "UX=", "VX=", " E=", "INITIAL", "VAX=", "VBX=", " WA=")


def rows_of(page: str) -> tuple[list[str], dict[str, int]]:
    """The lines of a page, and the place of each of the program's rows among them."""
    rows = page.split("\n")
    return rows, {
        word: next(at for at, row in enumerate(rows) if row.startswith(word)) for word in FIRST
    }


def one(text: str) -> Verification:
    (result,) = impact88.verify(text.encode())
    assert sum(result.characters.values()) == len("".join(text.split()))
    return result


def exchanged(page: str, first: str, second: str) -> str:
    rows, at = rows_of(page)
    a, b = at[first], at[second]
    rows[a], rows[b] = rows[b], rows[a]
    return "\n".join(rows)


@pytest.mark.parametrize(
    ("first", "second"),
    long_but(
        [("VAX=", "VBX="), ("UX=", "VX="), (" E=", "INITIAL"), ("DA=", "UX="), ("MA=", " WA=")],
        kept=(0, 2),
    ),
)
def test_exchanged_rows_are_named_in_one_sentence(first: str, second: str) -> None:
    result = one(exchanged(PAGE, first, second))
    assert result.verdict is Verdict.DIFFERS
    assert not result.differing
    (cause,) = result.explanations
    assert cause.kind == "rows exchanged"
    said = "\n".join(lines(result))
    assert "in each other's place" in said
    assert said.count("in each other's place") == 2  # as the cause, and as a note


def test_a_digit_altered_on_an_exchanged_row_is_named_too() -> None:
    result = one(exchanged(PAGE, "VAX=", "VBX=").replace("-13.263", "-13.268"))
    assert result.verdict is Verdict.DIFFERS
    assert [check.name for check in result.differing] == ["VAX"]


@pytest.mark.parametrize("word", long_but(FIRST, kept=(0, 3, 7)))
def test_a_row_that_is_printed_twice_is_named(word: str) -> None:
    rows, at = rows_of(PAGE)
    unit = 2 if word == " PA" else 1
    again = rows[at[word] : at[word] + unit]
    result = one("\n".join([*rows[: at[word] + unit], *again, *rows[at[word] + unit :]]))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert "is printed a second time" in "\n".join(lines(result))


def test_a_retyped_page_has_an_order_of_its_own() -> None:
    """Without prompts and asterisks; its numbers are under their labels."""
    body = PAGE[PAGE.index("MA=", PAGE.rindex("?")) :].replace("*****", "")
    result = one(exchanged(body, "MA=", "DA="))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert "in each other's place" in "\n".join(lines(result))


def test_two_printouts_are_two() -> None:
    """Of one scene, and the second without what stands above its results."""
    results = impact88.verify((PAGE + PAGE).encode())
    assert [result.verdict for result in results] == [Verdict.IDENTICAL] * 2
    results_alone = PAGE[PAGE.index("VAX=") :]
    first, *_ = impact88.verify((PAGE + results_alone).encode())
    assert first.verdict is Verdict.IDENTICAL


def test_rows_of_fresh_pages_are_named() -> None:
    for page in dressedpages.fresh_pages(printouts.SWEEP or 2, seed=21):
        result = one(exchanged(page, "VAX=", "VBX="))
        assert [cause.kind for cause in result.explanations] == ["rows exchanged"]
