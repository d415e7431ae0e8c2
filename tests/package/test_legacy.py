"""ERRATA.md accounts for every difference between the listing as printed and the one that runs.

The restored listing is derived here from the printed one by ERRATA's tables alone, so that neither
text, nor the account of them, can change without the others.
"""

from __future__ import annotations

import re
from importlib.resources import files
from typing import NamedTuple

import pytest

from impact88.apple.emulator.emulator import Applesoft
from impact88.program.run import run
from impact88.program.scene import sample

LEGACY = files("impact88.legacy")
RUNS = ("run1", "run2", "table3")


def text(name: str) -> str:
    return (LEGACY / name).read_bytes().decode("utf-8")


class Errata(NamedTuple):
    """The tables of ERRATA.md's first section."""

    numbers: list[tuple[int, str]]
    """Restored line number, and the number as printed, in the listing's order."""
    breaks: list[tuple[int, str, str]]
    """Restored line, what its first part ends with, what its second part begins with."""
    empty_after: list[int]
    """The restored lines that an empty line follows."""
    characters: list[tuple[int, str, str]]
    """Restored line, as printed, restored."""


def table_under(errata: str, first_columns: str) -> list[list[str]]:
    """The rows of the one table whose heading begins with these columns; code marks removed."""
    [start] = [m.end() for m in re.finditer(f"^{re.escape(first_columns)}.*\n", errata, re.M)]
    rows = []
    for line in errata[start:].split("\n")[1:]:
        if not line.startswith("| "):
            break
        cells = [cell.strip() for cell in line[1:-1].split(" | ")]
        rows.append([cell[1:-1] if cell.startswith("`") else cell for cell in cells])
    assert rows
    return rows


def tens(first: str, last: str) -> list[int]:
    return list(range(int(first), int(last) + 1, 10))


def read_errata(errata: str) -> Errata:
    numbers: list[tuple[int, str]] = []
    for first, last, printed_first, printed_last in table_under(errata, "| restored | to |"):
        restored = tens(first, last)
        if printed_first.strip():
            width = len(printed_first)
            pad = " " if printed_first.startswith(" ") else "0"
            printed = [
                str(n).rjust(width, pad)
                for n in tens(printed_first.lstrip(), printed_last.lstrip())
            ]
        else:
            printed = [""]
        numbers += zip(restored, printed, strict=True)
    return Errata(
        numbers,
        [(int(a), b, c) for a, b, c in table_under(errata, "| restored line | first part ends |")],
        [int(a) for a, _ in table_under(errata, "| after restored line |")],
        [
            (int(line), printed, restored)
            for line, printed, restored, _ in table_under(errata, "| restored line | as printed |")
        ],
    )


def restore(printed: str, errata: Errata) -> str:
    """The restored listing, from the printed one by the listed emendations and nothing else."""
    lines = printed.removesuffix("\n").split("\n")
    restored = []
    for number, as_printed in errata.numbers:
        line = lines.pop(0)
        fragment, space = (as_printed, " ") if as_printed else ("", "")
        assert line.startswith(fragment + space), f"{number} is printed {line!r}"
        line = line.removeprefix(fragment + space)
        for _, end, begin in [row for row in errata.breaks if row[0] == number]:
            rest = lines.pop(0)
            assert line.endswith(end)
            assert rest.startswith(begin)
            line += rest
        for _, wrong, right in [row for row in errata.characters if row[0] == number]:
            assert line.count(wrong) == 1, f"{wrong!r} is not the one place in {number}"
            line = line.replace(wrong, right)
        if number in errata.empty_after:
            assert lines.pop(0) == ""
        restored.append(f"{number} {line}\n")
    assert not lines, "lines of the printed listing are left over"
    return "".join(restored)


@pytest.fixture(scope="module")
def errata() -> Errata:
    return read_errata(text("ERRATA.md"))


@pytest.fixture(scope="module")
def listing() -> dict[int, str]:
    """impact.bas by line number."""
    numbered = [line.partition(" ") for line in text("impact.bas").splitlines()]
    return {int(number): statement for number, _, statement in numbered}


def test_printed_listing_and_errata_give_the_restored_listing(errata: Errata) -> None:
    assert restore(text("listing-as-printed.txt"), errata) == text("impact.bas")


def test_every_emendation_is_needed(errata: Errata) -> None:
    """No row of ERRATA says what is not so: without any one of them the texts part."""
    printed = text("listing-as-printed.txt")
    for field, rows in errata._asdict().items():
        for i in range(len(rows)):
            fewer_rows = {field: rows[:i] + rows[i + 1 :]}
            without = errata._replace(**fewer_rows)
            try:
                derived = restore(printed, without)
            except (AssertionError, IndexError):
                continue
            assert derived != text("impact.bas"), (field, rows[i])


def test_every_emendation_falls_on_a_line_of_the_listing(errata: Errata) -> None:
    lines = {number for number, _ in errata.numbers}
    assert {line for line, *_ in [*errata.breaks, *errata.characters]} <= lines
    assert set(errata.empty_after) <= lines


def test_printed_numbers_keep_the_last_two_digits_but_for_two(errata: Errata) -> None:
    cut = {
        restored for restored, printed in errata.numbers if printed[-2:] != f"{restored % 100:02}"
    }
    assert cut == {680, 690}


@pytest.mark.parametrize(
    ("line", "shown"),
    [
        (340, "UX= -29.04 UY= 0 WA= 0 XA= 0 YA= 0\n"),
        (700, "?SYNTAX ERROR\a IN 700"),
        (710, "?SYNTAX ERROR\a IN 710"),
        (730, "(XA=-8.78 YA= 15.91\n"),
        (740, "(XB=-8.09 YB= 17.35\n"),
    ],
)
def test_what_a_line_as_printed_does(line: int, shown: str, errata: Errata) -> None:
    """The evidence for the character emendations: what Applesoft makes of each line without it."""
    without = [row for row in errata.characters if row[0] != line]
    assert len(without) == len(errata.characters) - 1
    apple = Applesoft(dos=True)
    apple.load(restore(text("listing-as-printed.txt"), errata._replace(characters=without)))
    apple.feed("-29.04,0,0", "14.52,25.15,0")
    apple.run()
    assert shown in apple.take_output()
    assert shown not in run(sample(1)).printout


def jumps(statement: str) -> list[int]:
    code = re.sub(r'"[^"]*"|REM.*', "", statement)
    return [int(target) for target in re.findall(r"(?:THEN|GOTO|GOSUB) (\d+)", code)]


def test_every_jump_names_a_line_as_errata_says(errata: Errata, listing: dict[int, str]) -> None:
    targets = {target for statement in listing.values() for target in jumps(statement)}
    assert targets <= set(listing)
    sentence = re.search(r"^- Every jump then names [^:]*there: ([^.]*)\.", text("ERRATA.md"), re.M)
    assert sentence is not None
    assert {int(number) for number in re.findall(r"\d+", sentence[1])} == targets
    as_printed = {int(printed) for _, printed in errata.numbers if printed}
    assert {770, 1000} <= targets - as_printed


def test_statement_350_sets_m(listing: dict[int, str]) -> None:
    assert "M = 6" in listing[350]
    assert [number for number, statement in listing.items() if ":M =" in statement] == [350]


@pytest.mark.parametrize("run", RUNS)
def test_published_runs_close_the_parenthesis_that_the_printed_listing_leaves_open(
    run: str,
) -> None:
    published = text(f"{run}-as-printed.txt")
    assert len(re.findall(r"\(X[AB]=[-.\d]+ Y[AB]= [-.\d]+\)\n", published)) == 2


def test_published_runs_differ_among_themselves_as_errata_says() -> None:
    stars = {run: text(f"{run}-as-printed.txt").count("* * * * *\n") for run in RUNS}
    tabs = {run: "\t" in text(f"{run}-as-printed.txt") for run in RUNS}
    assert stars == {"run1": 0, "run2": 2, "table3": 0}
    assert tabs == {"run1": False, "run2": True, "table3": True}
