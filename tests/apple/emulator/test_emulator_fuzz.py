"""The emulator survives random bytes, tokens and edits; more cases with IMPACT88_FUZZ=N."""

from __future__ import annotations

import os

import pytest
from emulator_fuzz import Cases, survive

CASES = int(os.environ.get("IMPACT88_FUZZ", "0")) or 120


@pytest.mark.captures
def test_only_applesoft_errors_and_output():
    cases = Cases(seed=1988)
    kinds: set[str] = set()
    for _ in range(CASES):
        kinds |= survive(cases.case())
    # the cases must get past the first syntax error to be worth anything
    assert len(kinds) > 8
