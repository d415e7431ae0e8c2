"""Explanations of printouts that differ."""

from __future__ import annotations

from typing import Any

import pytest

from impact88.casework import trial
from impact88.casework.explain import Explanation
from impact88.casework.misreading import misreadings, slip
from impact88.casework.otherprints import rounded_text
from impact88.casework.printout import FIELDS, read_printouts
from impact88.casework.verify import Verdict, verify
from impact88.program.run import run
from impact88.scene import Scene, sample
from test_printout import SAMPLE


def first(text: str) -> Explanation:
    (shown,) = read_printouts(text)
    return verify(shown).explanations[0]


@pytest.mark.parametrize(
    ("old", "new", "kind", "field"),
    [
        ("MA= 143.5", "MA= 148.5", "digit misread", "MA"),
        ("UX= -29.04", "UX= 29.04", "sign misread", "UX"),
        ("UX= -29.04", "UX= -92.04", "digits swapped", "UX"),
        ("MA= 143.5", "MA= 14.35", "decimal point misread", "MA"),
        ("MA= 143.5", "MA= 1435", "decimal point misread", "MA"),
        ("IA= 3728", "IA= 372", "digit lost or added", "IA"),
        ("60      -30", "60      30", "sign misread", "GA"),
        ("KE= 100904.929", "KE= 100904.929".replace("9.", "4."), "digits swapped", "KI"),
        ("VAX= -13.263", "VAX= -13.268", "digit misread", "VAX"),
        ("VAX= -13.263", "VAX= 13.263", "sign misread", "VAX"),
        ("MU= .911", "MU= -.911", "sign misread", "MUP"),
    ],
)
def test_each_slip_is_named(old: str, new: str, kind: str, field: str) -> None:
    if kind == "digits swapped" and field == "KI":
        new = "KE= 100094.929"
    found = first(SAMPLE.replace(old, new))
    assert (found.kind, found.field, found.remaining) == (kind, field, 0)
    assert f"{found.would_be}" in old


def test_the_sign_of_mu_typed() -> None:
    """A run whose MU print was taken with the wrong sign, where the scene can print either."""
    text = run(sample(1)).printout
    other = run(sample(1).replaced({"MU": "-.911"})).printout
    assert "MU= -.911" in other
    mixed = text.replace("MU= .911", "MU= -.911")
    (shown,) = read_printouts(mixed)
    (found, *_) = verify(shown).explanations
    assert (found.kind, found.field, found.would_be) == ("sign misread", "MUP", ".911")


def _printed(scene: Scene, fields: dict[str, Any]) -> str:
    """A printout of a scene with some of its numbers replaced."""
    import printouts

    text = run(scene).printout
    for place in reversed(printouts.places(text)):
        if place.name in fields:
            text = text[: place.start] + fields[place.name] + text[place.stop :]
    return text


def test_rounded_instead_of_floored() -> None:
    scene = sample(1)
    rounded = {
        name: rounded_text(value, FIELDS[name].places or 0)
        for name, value in trial.run_whole(scene)[1].items()
    }
    assert rounded["XB"] == "14.52"
    found = first(_printed(scene, rounded))
    assert (found.kind, found.remaining) == ("rounded, not floored", 0)


def test_point_mass_with_arms_left() -> None:
    scene = sample(1).replaced({"M": "4"})
    proper = trial.run_once(scene.replaced({"DA": "0", "DB": "0"})).fields
    fields = {name: text for name, text in proper.items() if name not in ("DA", "DB")}
    found = first(_printed(scene, fields))
    assert (found.kind, found.remaining) == ("M = 4 with DA, DB left", 0)


def test_another_m() -> None:
    """A point-mass printout whose results are those of the full solution."""
    full = trial.run_once(sample(1)).fields
    (shown,) = read_printouts(_printed(sample(1).replaced({"M": "4"}), full))
    result = verify(shown)
    assert result.verdict is Verdict.INCOMPLETE
    assert result.not_read == ["WAF", "WBF"]
    assert result.scene["M"] == "6"


def test_slips_are_symmetric_enough() -> None:
    for kind, other in misreadings("-14.52"):
        assert slip("-14.52", other) == kind
    assert slip("14.52", "25.15") is None


def test_rounding_text() -> None:
    assert rounded_text(-0.004, 2) == "0"
    assert rounded_text(-13.2626, 3) == "-13.263"
    assert rounded_text(0.5, 0) == "1"
    assert rounded_text(100.0, 2) == "100"
