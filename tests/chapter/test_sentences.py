"""The chapter's sentences with numbers, against its own tables: the rows of the guide's page."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from captures import ROOT

from impact88.chapter import staged

GUIDE = (ROOT / "port" / "docs" / "guide" / "chapter.md").read_text("utf-8")
COLLISIONS = staged.collisions()
MPH = 3600 / 5280  # of a ft/s
GRAVITY = 32.174  # ft/s2
VELOCITY_CHANGES = ("DVA", "DVB")


def value(results: dict, name: str) -> float:
    return float(np.squeeze(results[name]))


def highest_speed() -> str:
    scenes = [collision.scene for collision in COLLISIONS]
    speeds = [np.hypot(s[x], s[y]) for s in scenes for x, y in (("UX", "UY"), ("VX", "VY"))]
    return f"{max(speeds) * MPH:.1f} mph"


def coefficients(name: str, *, side: bool | None = None) -> str:
    """The range of a coefficient, of front-to-side collisions or of the others."""
    values = [
        collision.coefficients[name]
        for collision in COLLISIONS
        if side is None or side == collision.category.endswith("SIDE")
    ]
    return f"{min(values):.3f} to {max(values):.3f}"


def changes_with_em() -> str:
    """The largest change of loss and delta-V where EM is changed by .1, within its range."""
    changes: dict[str, list[float]] = {"LOSS": [], "DVA": [], "DVB": []}
    for collision in COLLISIONS:
        original = staged.forward(collision)
        for step in (-0.1, 0.1):
            em = np.clip(collision.coefficients["EM"] + step, -1, 0)
            changed_em = staged.forward(collision, {**collision.coefficients, "EM": em})
            for name, sizes in changes.items():
                sizes.append(abs(value(changed_em, name) - value(original, name)))
    loss, *speeds = map(max, changes.values())
    return f"{loss:.2f} percent of KI and {max(speeds):.2f} ft/s for a change of .1"


def losses() -> str:
    """The range of the loss in each kind of collision."""
    kinds: dict[str, list[float]] = {}
    for collision in COLLISIONS:
        loss = value(staged.forward(collision), "LOSS")
        kinds.setdefault(collision.category, []).append(loss)
    return ", ".join(f"{min(x):.0f} to {max(x):.0f}" for x in kinds.values()) + " percent"


def errors_of_equation_19() -> str:
    """Median and largest difference of Equation 19 from the original delta-V."""
    errors = [
        abs(value(staged.prediction(collision), name) - value(staged.forward(collision), name))
        for collision in COLLISIONS
        for name in VELOCITY_CHANGES
    ]
    return f"median {np.median(errors):.1f}, largest {max(errors):.1f} ft/s"


def forces() -> str:
    """The average force over the weight, for contacts of .1 and .2 s."""
    multiples = [
        value(staged.forward(collision), name) / GRAVITY / duration
        for collision in COLLISIONS
        for name in VELOCITY_CHANGES
        for duration in (0.1, 0.2)
    ]
    return f"{min(multiples):.1f} to {max(multiples):.1f}, median {np.median(multiples):.1f}"


SENTENCES: dict[str, Callable[[], str]] = {
    "the highest speed was only about 40 mph": highest_speed,
    "the largest coefficient of restitution e is 0.258; the smallest was zero": (
        lambda: coefficients("E")
    ),
    "front-to-front and front-to-rear: e_m remains consistently near -0.5": (
        lambda: coefficients("EM", side=False)
    ),
    "front-to-side: its magnitude is greater, and varies more": (
        lambda: coefficients("EM", side=True)
    ),
    "ΔV and the energy loss are not very sensitive to changes in e_m": changes_with_em,
    "the first 6: μ ranges roughly between 0.5 and 1": lambda: coefficients("MUP", side=True),
    "the last 5: μ is near zero": lambda: coefficients("MUP", side=False),
    "within each collision category, the energy loss appears relatively constant": losses,
    "Equation 19: an error of a few ft/s": errors_of_equation_19,
    "the average force is 5 to 10 times the weight of each vehicle": forces,
}


@pytest.mark.parametrize("sentence", SENTENCES)
def test_the_guide_has_what_the_tables_say_to_a_sentence(sentence: str) -> None:
    (row,) = (line for line in GUIDE.splitlines() if line.startswith(f"| {sentence} |"))
    assert row.split(" | ")[1] == SENTENCES[sentence]()
