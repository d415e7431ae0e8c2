"""The method's page says what the code does, within its length."""

import re

from captures import ROOT

from impact88.mechanics.laws import FRICTION_ALLOWANCE, FRICTION_OFFSET
from impact88.reconstruction.answer import CONTRADICTION
from impact88.reconstruction.draws import KEPT_PROPORTION, PARTICLES
from impact88.reconstruction.fit import MAX_UNSEEN
from impact88.reconstruction.problem import RANGES, WIDEST

PAGE = (ROOT / "port" / "docs" / "guide" / "reconstruct-method.md").read_text(encoding="utf-8")


def test_the_page_is_short_and_has_three_references():
    assert len(PAGE.split()) <= 900
    assert len(re.findall(r"^\d\. ", PAGE, re.MULTILINE)) == 3


def test_numbers_of_the_page_are_those_of_the_code():
    text = " ".join(PAGE.split())
    assert f"up to {WIDEST:g} times the largest known one" in text
    assert f"is below {MAX_UNSEEN}" in text
    assert f"{PARTICLES:,} impacts" in text
    assert f"probability below {CONTRADICTION}" in text
    assert (KEPT_PROPORTION, RANGES["E"], RANGES["EM"]) == (0.5, (0, 1), (-1, 0))
    assert (FRICTION_ALLOWANCE, FRICTION_OFFSET) == (0.2, 0.1)
