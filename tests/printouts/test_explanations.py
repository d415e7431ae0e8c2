"""What is wrong with a page is named, class by class; and what nothing single explains is not.

The pages are made by `slippedpages` without the package's help. Set IMPACT88_SWEEP to n for n pages
of every class, and ``-s`` for the table.
"""

from __future__ import annotations

from collections import Counter

import pytest
import slippedpages
from longer import long_but

import printouts
from impact88.printouts.reading.printout import read_printouts
from impact88.printouts.reporting.examination import Verdict, Verification, verify

COUNT = printouts.SWEEP or 1
LEFT_TO_SWEEPS = (
    "two wrong digits in one input",
    "x and y in each other's place",
    "results in another unit",
    "rounded",
    "IEEE double",
    "A and B exchanged, and a wrong digit",
    "a wrong input and a wrong result",
    "two slips of two kinds",
    "more decimals",
    "fewer decimals",
    "IEEE double, all digits",
    "IEEE double, pi = 3.1416",
    "IEEE double, exact pi",
    "IEEE double, truncated",
    "single precision",
    "single precision, rounded",
    "two wrong inputs",
    "truncated",
    "decimal machines",
)
CLASSES = [name for name in slippedpages.CLASSES if printouts.SWEEP or name not in LEFT_TO_SWEEPS]
LEAST = 0.9
"""Of a class's pages so many are named first, or in a rank with what the page cannot tell apart."""
MOST_FALSE = 0.05


def rows() -> list[slippedpages.Row]:
    return slippedpages.ordinary(printouts.normal_ends())


def verified(text: str) -> Verification:
    (shown,) = read_printouts(text)
    return verify(shown)


def outcome_of(result: Verification, page: slippedpages.Slipped) -> str:
    """identical (the program prints just this page), first, alike (in the first rank), later,
    wrong (only others are named) or silent."""
    if result.verdict is Verdict.IDENTICAL:
        return "identical"
    ranks = [one.rank for one in result.explanations if page.named(one)]
    if not result.explanations:
        return "silent"
    if page.named(result.explanations[0]):
        return "first"
    return "alike" if 1 in ranks else "later" if ranks else "wrong"


@pytest.mark.captures
@pytest.mark.parametrize("name", long_but(CLASSES, kept=(1, 2)))
def test_a_cause_is_named_first(name: str) -> None:
    outcomes: Counter[str] = Counter()
    failures = []
    for _, page in slippedpages.made(slippedpages.CLASSES[name], rows(), COUNT, seed=17):
        outcome = outcome_of(verified(page.text), page)
        outcomes[outcome] += 1
        if outcome not in ("identical", "first", "alike"):
            failures.append(f"{outcome}: {page.cause}\n{page.text}")
    print(f"{name}: {dict(outcomes)}")
    told = sum(outcomes.values()) - outcomes["identical"]
    assert outcomes["first"] + outcomes["alike"] >= LEAST * told, "\n".join(failures)


@pytest.mark.captures
@pytest.mark.parametrize("name", list(slippedpages.UNEXPLAINED)[: None if printouts.SWEEP else 1])
def test_what_nothing_single_explains_is_not_explained(name: str) -> None:
    """Unless just what is wrong is put right, number by number."""
    false = []
    count = 0
    for row, text in slippedpages.made(slippedpages.UNEXPLAINED[name], rows(), COUNT, seed=18):
        count += 1
        result = verified(text)
        if result.verdict is Verdict.IDENTICAL:
            continue  # nothing printed depends on what was changed
        _, true = slippedpages.texts(row)
        for one in result.explanations[:1]:
            changed = [(change["field"], change["would_be"]) for change in one.changes]
            if not changed or any(true.get(field) != text for field, text in changed):
                false.append(f"{one.kind} {one.note} {changed}\n{text}")
    print(f"{name}: {len(false)} of {count} explained")
    assert len(false) <= MOST_FALSE * count, "\n".join(false)
