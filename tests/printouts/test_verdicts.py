"""Verdicts on printouts, through the public names."""

from __future__ import annotations

import random

import captures
import pytest

from impact88.printouts import Kind, Verdict, judge
from impact88.program.run import run
from impact88.program.scene import sample


@pytest.mark.captures
def test_captures_are_identical() -> None:
    rows = [row for row in captures.scenes() if "MA= " in row["printout"]]
    for row in random.Random(1).sample(rows, 60):
        (verification,) = judge(row["printout"])
        assert verification.verdict is Verdict.IDENTICAL, verification.findings


@pytest.mark.parametrize("number", [1, 2, 3])
def test_one_altered_digit_differs(number: int) -> None:
    page = run(sample(number)).page
    at = page.index("VBY= ") + 6
    altered = page[:at] + str((int(page[at]) + 5) % 10) + page[at + 1 :]
    (verification,) = judge(altered)
    assert verification.verdict is Verdict.DIFFERS
    (finding,) = verification.findings
    assert (finding.kind, finding.name) == (Kind.NUMBER, "VBY")
    assert finding.start <= at < finding.stop
