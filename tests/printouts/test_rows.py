"""Rows first: exchanged, printed twice, and out of a retyped page's order."""

from __future__ import annotations

import re

import dressedpages
import pytest
from longer import long_but

import impact88
import printouts
from impact88.printouts.reading.glyphs import Page
from impact88.printouts.reading.pagerows import find_rows
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


def once_more(page: str, at: int, row: str, below: int | None = None) -> list[Verification]:
    """The verdicts on a page with ``row`` printed again below row ``at``, or elsewhere."""
    rows = page.split("\n")
    where = at if below is None else below
    results = impact88.verify("\n".join([*rows[: where + 1], row, *rows[where + 1 :]]).encode())
    assert Verdict.IDENTICAL not in [result.verdict for result in results]
    return results


def altered(row: str, digit: int) -> str:
    """A row with one of its digits another."""
    places = [match.start() for match in re.finditer("[0-9]", row)]
    at = places[digit % len(places)]
    return row[:at] + str((int(row[at]) + 3) % 10) + row[at + 1 :]


@pytest.mark.parametrize("at", long_but([at for at, row in enumerate(PAGE.split("\n")) if row]))
def test_a_row_that_is_printed_twice_is_named(at: int) -> None:
    """Each of sample 1: the same digit by digit, and with a digit altered in the second or the
    first."""
    row = PAGE.split("\n")[at]
    (same,) = once_more(PAGE, at, row)
    assert same.verdict is Verdict.IDENTICAL_AS_READ
    if "*" not in row:
        named = f"line {at + 2}", f"line {at + 1} does not belong"  # a heading is the one above
        assert any(name in "\n".join(lines(same)) for name in named)
    if not re.search("[0-9]", row):
        return
    (other,) = once_more(PAGE, at, altered(row, at))
    said = "\n".join(lines(other))
    assert f"line {at + 2}" in said
    if re.search("[A-Z]", row):  # angles have no label
        assert other.verdict is Verdict.DIFFERS
        assert other.explanations[0].kind == "row printed twice"
        assert f"where line {at + 1} has" in said
    once_more(PAGE.replace(row, altered(row, at)), at, row)


@pytest.mark.parametrize("damaged", long_but([False, True], kept=()))
def test_a_row_of_the_page_below_it_is_no_printout(damaged: bool) -> None:
    """It is named, though an optical reader damaged its labels."""
    rows, at = rows_of(PAGE)
    for word in FIRST:
        row = rows[at[word] + (word == " PA")]
        for text in (row, altered(row, -1)) if word != "MA=" or not damaged else ():  # begins one
            text = text.replace("A=", "H=").replace("E=", "F=") if damaged else text
            (result,) = once_more(PAGE, at[word], text, len(rows) - 2)
            assert result.verdict is Verdict.IDENTICAL_AS_READ
            assert f"line {len(rows)}" in "\n".join(lines(result))


def test_another_value_within_the_page_contradicts_and_below_it_is_listed() -> None:
    rows, at = rows_of(PAGE)
    other = rows[at["VAX="]].replace("3.449", "3.941")
    (within,) = once_more(PAGE, at["VAX="], other, at["VBX="])
    assert within.verdict is Verdict.DIFFERS
    (below,) = once_more(PAGE, at["VAX="], other, len(rows) - 2)
    for result in (within, below):
        assert "a second time with VAY 3.941, where line" in lines_of_rows(result)


def lines_of_rows(result: Verification) -> str:
    return "\n".join(result.rows)


def test_a_retyped_page_has_an_order_of_its_own() -> None:
    """Without prompts and asterisks; its numbers are under their labels."""
    body = PAGE[PAGE.index("MA=", PAGE.rindex("?")) :].replace("*****", "")
    result = one(exchanged(body, "MA=", "DA="))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert "in each other's place" in "\n".join(lines(result))


SECOND = impact88.run(impact88.sample(2)).page
BODY = PAGE[PAGE.index("MA=", PAGE.rindex("?")) :]
CUT = PAGE[: PAGE.index("UX=")]


@pytest.mark.parametrize(
    "text", long_but([PAGE + SECOND, BODY + BODY, PAGE + PAGE, SECOND + BODY], kept=(0, 1))
)
def test_two_printouts_are_two(text: str) -> None:
    """Of one scene, or of two."""
    results = impact88.verify(text.encode())
    assert [result.verdict for result in results] == [Verdict.IDENTICAL] * 2


@pytest.mark.parametrize(
    "text", long_but([CUT + BODY, PAGE[PAGE.index("VBX=") :] + PAGE, CUT + SECOND])
)
def test_a_printout_below_a_part_of_one_is_whole(text: str) -> None:
    *_, last = impact88.verify(text.encode())
    assert last.verdict in (Verdict.IDENTICAL, Verdict.IDENTICAL_AS_READ)
    assert not last.missing


@pytest.mark.parametrize("word", long_but(["UX=", "DA=", " E="]))
def test_a_printout_that_is_cut_at_its_top_is_another(word: str) -> None:
    first, below = impact88.verify((PAGE + SECOND[SECOND.index(word) :]).encode())
    assert first.verdict is Verdict.IDENTICAL
    assert below.verdict is Verdict.INCOMPLETE


def test_results_printed_twice_above_the_last_asterisks_are_one_page() -> None:
    results = PAGE[PAGE.index("VAX=") : PAGE.rindex("*****")]
    (result,) = impact88.verify(
        PAGE.replace(results, results + results.replace("-1.745", "-1.845")).encode()
    )
    assert result.verdict is Verdict.DIFFERS
    assert len(result.rows) == 3
    assert "with WAF -1.845, where line" in result.rows[-1]


def test_a_repeated_row_and_another_printout_are_told_apart() -> None:
    """By what follows them: the rest of the page, or the same rows once more."""
    masses = PAGE[PAGE.index("MA=", PAGE.rindex("?")) : PAGE.index("DA=")]
    (repeated,) = find_rows(Page(PAGE.replace(masses, masses + masses))).repeated
    assert "the row of MA, is printed a second time" in repeated.sentence
    results = PAGE[PAGE.index("VAX=") : PAGE.rindex("*****")]
    assert not find_rows(Page(PAGE[: PAGE.rindex("*****")] + results)).repeated


def test_a_row_printed_twice_above_another_printout_is_the_first_ones() -> None:
    rows, at = rows_of(PAGE)
    again = "\n".join(
        [*rows[: at[" WA="] + 1], altered(rows[at[" WA="]], 2), *rows[at[" WA="] + 1 :]]
    )
    first, second = impact88.verify((again + PAGE).encode())
    assert (first.verdict, second.verdict) == (Verdict.DIFFERS, Verdict.IDENTICAL)


def test_rows_of_fresh_pages_are_named() -> None:
    for page in dressedpages.fresh_pages(printouts.SWEEP or 2, seed=21):
        result = one(exchanged(page, "VAX=", "VBX="))
        assert [cause.kind for cause in result.explanations] == ["rows exchanged"]


NOTES = ("3 April 1989", "FAX 219-555-0142  P.02", "No. 4711", "$ 150.00", "- 12 -")


@pytest.mark.parametrize("below", long_but(FIRST[:-1], kept=(1, 2, 5)))
def test_a_line_of_figures_between_rows_is_no_part_of_a_number(below: str) -> None:
    note = NOTES[FIRST.index(below) % len(NOTES)]
    rows, at = rows_of(PAGE)
    rows.insert(at[below] + 1 + (below == " PA"), f"\n{note}")
    result = one("\n".join(rows))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert f"does not belong to the program's page: {' '.join(note.split())}" in "\n".join(
        lines(result)
    )


def test_an_altered_number_beside_a_line_of_figures_differs() -> None:
    page = PAGE.replace("DB= 3.44", "DB= 3.45\n\n3 April 1989")
    assert one(page).verdict is Verdict.DIFFERS


@pytest.mark.parametrize("width", [33, 40])
def test_figures_of_a_narrow_page_go_on_below(width: int) -> None:
    rows = (re.sub(f"(.{{{width}}})(?=.)", r"\1\n", row) for row in PAGE.split("\n"))
    assert one("\n".join(rows)).verdict is Verdict.IDENTICAL


@pytest.mark.parametrize("added", ["EA= 55", "\n\nVAX= -12.1 VAY= 4.2"])
def test_numbers_of_something_else_begin_no_other_printout(added: str) -> None:
    result = one(PAGE.replace("14.52,25.15,0", f"14.52,25.15,0 {added}"))
    assert result.verdict in (Verdict.IDENTICAL_AS_READ, Verdict.DIFFERS)


def test_a_page_cut_at_the_right_accuses_nothing() -> None:
    """The last angle is cut to -3, and the results that depend on it do not contradict."""
    angles = next(row for row in PAGE.split("\n") if row.endswith("-30"))
    cut = "\n".join(row[: len(angles) - 1] for row in PAGE.split("\n"))
    result = one(cut)
    assert result.verdict is Verdict.INCOMPLETE
    assert "GA" in result.missing


def test_a_last_digit_that_is_missing_on_one_line_differs() -> None:
    assert one(PAGE.replace("-30\n", "-3\n")).verdict is Verdict.DIFFERS
    assert one(PAGE.replace("15.91)", "15.9)")).verdict is Verdict.DIFFERS
    assert one(PAGE.replace("15.91)", "15.9")).verdict is Verdict.INCOMPLETE


@pytest.mark.parametrize(("second", "verdict"), [("60", "IDENTICAL_AS_READ"), ("61", "DIFFERS")])
def test_a_second_row_of_angles_is_told(second: str, verdict: str) -> None:
    angles = next(row for row in PAGE.split("\n") if row.endswith("-30"))
    result = one(PAGE.replace(angles, f"{angles}\n{angles.replace('60', second)}"))
    assert result.verdict.name == verdict
    assert "is printed a second time" in "\n".join(lines(result))


def test_figures_right_below_a_row_go_on_only_where_they_are_few() -> None:
    for row, parted in (("15.91)", "15.\n91)"), ("IB= 1961", "IB= 19\n61")):
        assert one(PAGE.replace(row, parted)).verdict is Verdict.IDENTICAL_AS_READ
    result = one(PAGE.replace("DB= 3.44", "DB= 3.44\n04.03.89"))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    assert any("04.03.89" in piece.read for piece in result.left_over)


@pytest.mark.parametrize("width", [31, 32, 33])
def test_a_label_that_is_cut_off_is_not_looked_for_in_the_next_row(width: int) -> None:
    result = one("\n".join(row[:width] for row in PAGE.split("\n")))
    assert result.verdict is Verdict.INCOMPLETE
    assert not any(label.read == "E" for label in result.labels)


def test_an_input_at_the_edge_of_a_narrow_page_is_whole() -> None:
    width = len("MA= 143.5 MB= 95.8 IA= 3728")
    page = PAGE[PAGE.index("MA= ") :].replace("-13.263", "-13.268")
    rows = (re.sub(f"(.{{{width}}})(?=.)", r"\1\n", row) for row in page.split("\n"))
    assert one("\n".join(rows)).verdict is Verdict.DIFFERS


@pytest.mark.parametrize("old", ["IB= 1961", "YA= 0\n", "15.91)"])
def test_a_named_number_below_a_row_is_no_part_of_its_last(old: str) -> None:
    assert PAGE.count(old) == 1
    result = one(PAGE.replace(old, f"{old}\n\n# VAX 12.3\n"))
    assert result.verdict is Verdict.IDENTICAL_AS_READ
    beside = one(PAGE.replace("VAX= -13.263", "VAX= -13.263 OR -14.263"))
    assert beside.verdict is Verdict.DIFFERS
