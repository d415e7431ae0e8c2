"""The chapter's statements in numbers or comparisons, checked: `claims`, a row for every such
sentence of its Sections I to VII.

What is said of the method, and of the eleven staged collisions, is computed on these; the numbers
of Section VII are those of `chapter.example`; the rest names where it is checked, or why it cannot
be. What the chapter says of the program is in ``legacy/ERRATA.md``, section 5.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...collision.geometry import resolve_contact_point
from ...collision.units import GRAVITY, MPH
from ...mechanics.closedform.general import typed_friction
from ...mechanics.closedform.solve import solve
from ...mechanics.outcome import forces
from . import example
from .staged import Collision, collisions, forward, predict_delta_v

Array = NDArray[np.float64]

CONTACT_TIMES = (0.1, 0.2)
"""Seconds, Section III."""
NOT_CHECKED = "not to be checked here"


@dataclass(frozen=True)
class Claim:
    """A sentence of the text and a ``verdict`` on it.

    ``found``: what is computed or read from the tables, or where the sentence is checked. Where a
    value was ``varied``: the lowest and highest change that it makes of the front-to-side
    collisions (``sides``) and the ``others``, in ``unit``."""

    where: str
    claim: str
    verdict: str
    found: str = ""
    varied: str = ""
    sides: tuple[float, float] = (0.0, 0.0)
    others: tuple[float, float] = (0.0, 0.0)
    unit: str = ""


def _are_sides(collision: Collision) -> bool:
    return "SIDE" in collision.category


def _extent(rule: Callable[[Collision], Array], alike: list[Collision]) -> tuple[float, float]:
    values = np.concatenate([np.ravel(rule(collision)) for collision in alike])
    return float(values.min()), float(values.max())


@cache
def _varied_checks() -> tuple[Claim, ...]:
    """Return the claims that something hardly matters, each with what it does to the eleven
    collisions."""
    # not split: a table of claims, an entry each
    # not split, as `_of_tables`: a row for each claim

    def solve_changed(c: Collision, changes: Mapping[str, Any]) -> dict[str, Array]:
        """Solve with Table 2's coefficients and some values changed. Friction keeps the sign of
        Table 2, whatever the sliding does."""
        scene = resolve_contact_point({**c.scene, **changes})
        em = np.asarray(scene.pop("EM", c.coefficients["EM"]))
        mu = typed_friction(scene, c.coefficients["MUP"])
        return solve({**scene, "E": c.coefficients["E"], "EM": em, "MU": mu}, ("DVA", "LOSS"))

    def delta_v_change(c: Collision, changes: Mapping[str, Any]) -> Array:
        """Return the change of ΔV in percent. It is the same for both vehicles, whose ΔV are in the
        inverse ratio of their masses."""
        return 100 * (solve_changed(c, changes)["DVA"] / forward(c)["DVA"] - 1)

    def delta_v_turned(c: Collision, degrees: float, *names: str) -> Array:
        """Return the changes of ΔV, in percent, when each of the angles named is turned either way;
        a contact point stays where it is on its vehicle."""
        turns = np.array([-degrees, degrees])
        return np.concatenate([delta_v_change(c, {n: c.scene[n] + turns}) for n in names])

    sides = [c for c in collisions() if _are_sides(c)]
    remaining = [c for c in collisions() if not _are_sides(c)]
    around = np.radians(np.arange(0, 360, 5.0))
    contact = {"CX": np.cos(around), "CY": np.sin(around)}
    moments = np.linspace(-1, 0, 21)
    rows: tuple[tuple[str, str, str, Callable[[Collision], Array], str, str], ...] = (
        (
            "IV-A",
            "results not critically sensitive to Γ",
            "Γ by 10 degrees either way",
            lambda c: delta_v_turned(c, 10.0, "GA"),
            "% of ΔV",
            "false for the side impacts",
        ),
        (
            "IV-A",
            "nor to the location of point C",
            "C by 1 ft in any direction",
            lambda c: delta_v_change(c, contact),
            "% of ΔV",
            "true of a foot",
        ),
        (
            "V",
            "ΔV not very sensitive to e_m",
            "e_m over its whole range, -1 to 0",
            lambda c: delta_v_change(c, {"EM": moments}),
            "% of ΔV",
            "true",
        ),
        (
            "V",
            "nor is the energy loss",
            "e_m over its whole range, -1 to 0",
            lambda c: solve_changed(c, {"EM": moments})["LOSS"] - forward(c)["LOSS"],
            "points of loss",
            "true",
        ),
        (
            "IV-A",
            "turns during contact below 45 degrees matter little",
            "one vehicle's heading by 22.5 degrees, half the turn",
            lambda c: delta_v_turned(c, 22.5, "TA", "TB"),
            "% of ΔV",
            "they matter: up to a fifth of ΔV",
        ),
        (
            "III",
            "average force 5 to 10 times the weight",
            "contact time .1 to .2 s",
            _force_over_weight,
            "weights",
            "the middle of a wider range",
        ),
    )
    return tuple(
        Claim(
            place,
            text,
            verdict,
            varied=variations,
            sides=_extent(rule, sides),
            others=_extent(rule, remaining),
            unit=unit,
        )
        for place, text, variations, rule, unit, verdict in rows
    )


def _force_over_weight(c: Collision) -> Array:
    """Return the average contact force over each vehicle's weight, for both contact times."""
    results = forward(c)
    average = forces(np.hypot(results["PN"], results["PT"]), np.array(CONTACT_TIMES))["FA"]
    return np.asarray(average[:, None] / (GRAVITY * np.array([c.scene["MA"], c.scene["MB"]])))


def _sliding(c: Collision) -> float:
    """Return the relative velocity along the crush surface before the impact, ft/s; no vehicle
    turns then."""
    angle = np.radians(c.scene["GA"])
    x, y = c.scene["UX"] - c.scene["VX"], c.scene["UY"] - c.scene["VY"]
    return float(-x * np.sin(angle) + y * np.cos(angle))


def _range(values: list[float], digits: int = 3) -> str:
    return f"{min(values):.{digits}f} to {max(values):.{digits}f}"


def _of_tables() -> tuple[Claim, ...]:
    """Return the claims of Section V and VI about the staged collisions' own numbers."""
    # not split: a table of claims, an entry each
    tests = collisions()
    sides = [c for c in tests if _are_sides(c)]
    remaining = [c for c in tests if not _are_sides(c)]
    e = [c.table2["e"] for c in tests]
    fastest = max(np.hypot(c.scene[x], c.scene[y]) for c in tests for x, y in _SPEEDS)
    em_sides = {c.number: c.table2["em"] for c in sides}
    em_others = [c.table2["em"] for c in remaining]
    smallest = max(em_sides, key=lambda number: em_sides[number])
    slid = [abs(_sliding(c)) for c in tests]
    friction = [abs(c.table2["mu"]) for c in tests]
    among_sides = np.corrcoef([abs(_sliding(c)) for c in sides], friction[: len(sides)])[0, 1]
    among_others = np.corrcoef([abs(_sliding(c)) for c in remaining], friction[len(sides) :])[0, 1]
    losses: dict[str, list[float]] = {}
    for c in tests:
        losses.setdefault(c.category.lower(), []).append(c.table2["loss"])
    misses = [
        float(predict_delta_v(c)[f"DV{v}"]) - c.table2[f"dV{v.lower()}_exp"]
        for c in tests
        for v in "AB"
    ]
    of_sides = misses[: 2 * len(sides)]
    of_others = misses[2 * len(sides) :]
    right_sided = losses["90° front to side"]
    return (
        Claim(
            "V",
            "the highest speed was only about 40 mph",
            "true",
            f"{fastest / MPH:.1f} mph",
        ),
        Claim(
            "V",
            "the largest e is 0.258; the smallest was zero",
            "true",
            f"{_range(e)}",
        ),
        Claim("V", "e typically is small", "true", f"the median is {np.median(e):.3f}"),
        Claim(
            "V",
            "the moment coefficient as defined must lie between -1 and 0",
            "true of Table 2; the equation also takes e_m up to 1, where there is no moment",
            f"{_range([c.table2['em'] for c in tests])}; ERRATA, section 5",
        ),
        Claim(
            "V",
            "front to front and front to rear, e_m remains consistently near -0.5",
            "true",
            _range(em_others),
        ),
        Claim(
            "V",
            "front to side its magnitude is greater",
            f"false of collision {smallest}",
            f"{_range(list(em_sides.values()))}: collision {smallest} has "
            f"{em_sides[smallest]:.3f}, "
            f"and 7 with {em_sides[7]:.3f} hardly more than the {min(em_others):.3f} of the others",
        ),
        Claim(
            "V",
            "and varies more",
            "true",
            f"standard deviation {np.std(list(em_sides.values()), ddof=1):.3f}, "
            f"others {np.std(em_others, ddof=1):.3f}",
        ),
        Claim(
            "V",
            "μ varies fairly consistently with the initial relative tangential velocity",
            "between the two groups; not within the front-to-side group",
            f"|μ| and |sliding|, correlation "
            f"{np.corrcoef(slid, friction)[0, 1]:.2f} over all, "
            f"{among_sides:.2f} within front to side, {among_others:.2f} within the others",
        ),
        Claim(
            "V",
            "the last five collisions are nearly direct, and μ is near zero",
            "true",
            _range([c.table2["mu"] for c in remaining]),
        ),
        Claim(
            "V",
            "in the first six μ ranges roughly between 0.5 and 1",
            "true",
            _range([c.table2["mu"] for c in sides]),
        ),
        Claim(
            "VI",
            "Equation 19 does an excellent job, an error of a few ft/s being permissible",
            "true with the factor 2/3 that it was computed with",
            f"off by {_range(misses, 1)} ft/s from the measured changes, "
            f"{sum(abs(miss) <= 5 for miss in misses)} of {len(misses)} within 5 ft/s",
        ),
        Claim(
            "VI",
            "it applies equally well to all of the collision conditions",
            "nearly",
            f"root mean square {np.sqrt(np.mean(np.square(of_sides))):.1f} ft/s front to side, "
            f"{np.sqrt(np.mean(np.square(of_others))):.1f} ft/s of the others",
        ),
        Claim(
            "VI",
            "within each category the energy loss appears relatively constant",
            "true within 10 points",
            "; ".join(f"{name} {_range(values, 1)} %" for name, values in losses.items()),
        ),
        Claim(
            "VII",
            "ΔT = 0.4 follows from Table 2 for this type of collision",
            "true",
            f"90° front to side {_range(right_sided, 1)} %",
        ),
    )


_SPEEDS = (("UX", "UY"), ("VX", "VY"))


def _of_forces() -> Claim:
    """Return the claim that contact forces outdo what tyres can."""
    weights = np.concatenate([_force_over_weight(c) for c in collisions()], axis=1)
    short, long = ((row >= 10).sum() for row in weights)
    return Claim(
        "I",
        "contact forces are ten or more times higher than ground friction",
        "of the average force, not of every collision",
        f"10 weights or more, of {weights.shape[1]} vehicles: {short} with a contact of .1 s, "
        f"{long} with .2 s; ten times a ground friction of .7 is 7 weights",
    )


def _of_example() -> tuple[Claim, ...]:
    """Return the numbers of Section VII, recomputed."""
    checks = []
    for step in example.steps():
        numbers = [number for number in step.numbers if number.printed is not None]
        if not numbers:
            continue
        texts = ", ".join(f"{n.name} {n.printed}" for n in numbers)
        agree = all(number.agrees for number in numbers)
        values = ", ".join(f"{n.value:.5g}" for n in numbers)
        words = step.remark.replace(" (below)", "") if "need the factor" in step.remark else ""
        checks.append(
            Claim(
                "VII",
                f"{step.title}: {texts}",
                _verdict_of_example(agree, bool(words)),
                f"{values}{'. ' + words if words else ''} (impact88 chapter example)",
            )
        )
    return tuple(checks)


def _verdict_of_example(agrees: bool, is_of_other_values: bool) -> str:
    if not agrees:
        return "false"
    return "true, but not of the 0.4 that the text states" if is_of_other_values else "true"


_ELSEWHERE = (
    Claim(
        "I",
        "the forces between a vehicle and the ground are of the order of its weight",
        NOT_CHECKED,
        "no force of the ground was recorded in the tables",
    ),
    Claim(
        "III",
        "contact time almost always is from 0.1 to 0.2 s",
        NOT_CHECKED,
        "no time was recorded in the tables",
    ),
    Claim(
        "III",
        "the maximum force is typically two to three times the average",
        NOT_CHECKED,
        "no force was recorded; a triangular pulse has 2, half a sine 1.57",
    ),
    Claim(
        "III",
        "with e = 0 the inverse solution cannot be obtained",
        "true, and at e_m = 0 it fails as well",
        "ERRATA, section 6",
    ),
    Claim(
        "IV",
        "with no spin and d_a = d_b = 0 the equations reduce to the direct colinear case",
        "true",
        "solved both ways (impact88 chapter colinear; run 2 is of point masses)",
    ),
    Claim(
        "IV",
        "results are not affected by changes of angle below 45 degrees, as tests seem to indicate",
        "see the turn of half of it below",
        "reference 11, which has not come down with the chapter",
    ),
)


@cache
def claims() -> tuple[Claim, ...]:
    """Return every sentence of the chapter that states a number or a comparison, with its check."""
    rows = (*_ELSEWHERE, _of_forces(), *_varied_checks(), *_of_tables(), *_of_example())
    sections = ("I", "III", "IV", "IV-A", "V", "VI", "VII")
    return tuple(sorted(rows, key=lambda claim: sections.index(claim.where)))
