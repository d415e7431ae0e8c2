"""A constant that is wrong by any amount: one free factor, or offset, on one input, statement or
result, fitted to all rows and told as a number, with what it is near to."""

from collections.abc import Iterator
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..names import FINAL_VELOCITIES, SCENE
from .equations.edits import RARE_CONVENTION, Edit
from .equations.evaluation import Run
from .equations.spelling import IMPULSES, LISTING, SHOWN, TYPED, Expression, Sides, spellings
from .trials import BORNE_OUT, Judge, Program, run

Floats = NDArray[np.float64]

FACTOR, OFFSET = "*", "+"
_ITERATIONS = 12
_NEARLY = 10.0
"""Times what is allowed: a fit that is farther off is none; what is allowed is asked after it."""
_STEP = 1e-6
"""Relative step of the differences by which a constant is improved."""
_GROUPS = (
    ("GA", "PA", "PB", "TA", "TB"),
    ("PA", "PB"),
    ("TA", "TB"),
    ("DA", "DB"),
    ("MA", "MB"),
    ("IA", "IB"),
    ("UX", "UY", "VX", "VY"),
    ("UX", "VX"),
    ("UY", "VY"),
    ("UX", "UY"),
    ("VX", "VY"),
    ("WA", "WB"),
)
"""Inputs that have a constant in common."""
_SHOWN_GROUPS = (
    ("VAX", "VAY", "VBX", "VBY"),
    ("VAX", "VBX"),
    ("VAY", "VBY"),
    ("VAX", "VAY"),
    ("VBX", "VBY"),
    ("WAF", "WBF"),
    ("KI", "KF"),
    ("DVA", "DVB"),
    ("PN", "PT"),
)
"""Results that have."""
_BOTH = ((("UX", "UY", "VX", "VY"), _SHOWN_GROUPS[0]), (("WA", "WB"), ("WAF", "WBF")))
"""Inputs that are read with a factor, and results that are shown with its inverse."""
KNOWN = {
    "1.467 for 22/15": 1.467 * 15 / 22,
    "1.4667 for 22/15": 1.4667 * 15 / 22,
    "0.682 for 15/22": 0.682 * 22 / 15,
    "0.6818 for 15/22": 0.6818 * 22 / 15,
    "3.14 for pi": 3.14 / pi,
    "22/7 for pi": 22 / 7 / pi,
    "3.1416 for pi": 3.1416 / pi,
    "57.3 for 180/pi": 57.3 * pi / 180,
    "57.29 for 180/pi": 57.29 * pi / 180,
    "0.01745 for pi/180": 0.01745 * 180 / pi,
    "32.2 for 32.174": 32.2 / 32.174,
    "32 for 32.174": 32 / 32.174,
    "9.81 for 9.80665": 9.81 / 9.80665,
    "0.305 for 0.3048": 0.305 / 0.3048,
    "2.2 for 2.20462": 2.2 / 2.20462262,
    "ft/s to mph": 15 / 22,
    "ft/s to m/s": 0.3048,
    "ft/s to km/h": 1.09728,
    "m/s to km/h": 3.6,
    "mph to m/s": 0.44704,
    "mph to km/h": 1.609344,
    "lb to kg": 0.45359237,
    "slug to kg": 14.59390294,
    "the acceleration of gravity in ft/s2": 32.174,
    "the acceleration of gravity in m/s2": 9.80665,
    "degrees for radians": 180 / pi,
    "rpm for radians per second": 30 / pi,
    "12 inches": 12.0,
    "pi": pi,
    "2": 2.0,
    "3": 3.0,
    "4": 4.0,
    "10": 10.0,
    "100": 100.0,
    "1000": 1000.0,
    "the square root of 2": 2**0.5,
}
"""What a factor, or its inverse, may be near to."""
_NEAR = 1e-6


class _Target(NamedTuple):
    """What may have a constant: how it is called, the spelling's title, what is multiplied (or
    added to) by it, and by its inverse."""

    says: str
    title: str
    how: str
    by: dict[str, Expression]
    inverse: dict[str, Expression]

    def sides(self, constant: float) -> dict[str, Sides]:
        """The statements with a constant."""
        other = 1 / constant if self.how == FACTOR else -constant
        made: dict[str, Sides] = {}
        for key, side in self.by.items():
            made[key] = ((self.how, side, constant),)
        for key, side in self.inverse.items():
            made[key] = ((self.how, side, other),)
        return made


def _targets(title: str, names: Any) -> Iterator[_Target]:
    """Yield all that may have a constant in a spelling."""
    spelling = spellings()[title]
    if title == LISTING:
        inputs = [(name,) for name in SCENE if name != "M"]
        for how in (FACTOR, OFFSET):
            for group in (*_GROUPS, *inputs):
                if how == FACTOR or len(group) == 1:
                    by: dict[str, Expression] = {name: f"{TYPED}{name}" for name in group}
                    yield _Target(", ".join(group), "", how, by, {})
            shown = [(name,) for name in names]
            for group in (*_SHOWN_GROUPS, *shown):
                if set(group) <= set(names):
                    yield _Target(
                        f"{', '.join(group)} as shown",
                        "",
                        how,
                        {f"{SHOWN}{name}": name for name in group},
                        {},
                    )
        for group, results in _BOTH:
            if set(results) <= set(names):
                yield _Target(
                    f"{', '.join(group)}, and the results by its inverse",
                    "",
                    FACTOR,
                    {name: f"{TYPED}{name}" for name in group},
                    {f"{SHOWN}{name}": name for name in results},
                )
    for index, line in enumerate(spelling.statements):
        usable = line.target and line.target not in SCENE and not line.target.startswith(SHOWN)
        is_truth = line.target in ("point", "pivot", "stick")
        if usable and not is_truth and (index >= spelling.own or title == LISTING):
            for how in (FACTOR, OFFSET):
                place = f"{line.place}, {line.target} ({line.subject})"
                yield _Target(place, title, how, {line.target: line.sides[0]}, {})


@np.errstate(all="ignore")
def fitted(judge: Judge) -> list[Program]:
    """Return programs with one free constant that explain nearly all rows of a small judge, those
    with a known constant first."""
    found: list[tuple[bool, bool, int, Program]] = []
    for title in (LISTING, IMPULSES):
        whole = Run(spellings()[title], judge.scene)
        shown = [name for name in judge.theirs if SHOWN + name in whole.names]
        if not shown:  # nothing that this spelling computes
            continue
        targets = list(_targets(title, shown))
        constants = np.array([1.0 if target.how == FACTOR else 0.0 for target in targets])
        for _ in range(_ITERATIONS):
            constants = _improved(whole, targets, constants, judge)
        # a program with each is run only where the fit comes near in as many rows
        off = _off(whole, targets, constants, judge).reshape(len(targets), -1, judge.wrong.size)
        near = (~(np.abs(off) > _NEARLY)).all(1) & judge.wrong
        fits = near.sum(1) >= BORNE_OUT * judge.wrong.sum()
        for target, constant, fit in zip(targets, constants.tolist(), fits, strict=True):
            moved = constant != (1.0 if target.how == FACTOR else 0.0)
            if fit and moved and np.isfinite(constant):
                program = Program((_edit(target, constant),))
                trial = run(program, judge)
                if trial.stands and trial.explains >= BORNE_OUT * judge.wrong.sum():
                    found.append((not _near(constant), target.how != FACTOR, len(found), program))
    return [program for *_, program in sorted(found, key=lambda x: x[:3])]


def _improved(whole: Run, targets: list[_Target], constants: Floats, judge: Judge) -> Floats:
    """Return the constants after a step of Gauss and Newton, each by itself."""
    steps = _STEP * np.maximum(np.abs(constants), 1e-3)
    here = _off(whole, targets, constants, judge)
    there = _off(whole, targets, constants + steps, judge)
    slopes = (there - here) / steps[:, None]
    usable = np.isfinite(slopes) & np.isfinite(here)
    slopes, here = np.where(usable, slopes, 0.0), np.where(usable, here, 0.0)
    # rows far off the rest, where the constant turns a branch, count less
    size = np.abs(here)
    weights = 1 / np.maximum(size, np.median(size, 1, keepdims=True) + 1e-300)
    change = (weights * slopes * here).sum(1) / (weights * slopes * slopes).sum(1)
    made = constants - change
    return np.where(np.isfinite(made) & (change != 0), made, constants)


def _off(whole: Run, targets: list[_Target], constants: Floats, judge: Judge) -> Floats:
    """Return how far results are off, by their limits, (targets, results times rows)."""
    several = [
        target.sides(constant) for target, constant in zip(targets, constants.tolist(), strict=True)
    ]
    made = {**whole.names, **whole.edited(several)}
    shape = (len(targets), judge.wrong.size)
    parts = [
        np.broadcast_to((made[SHOWN + name] - theirs) / judge.limit[name], shape)
        for name, theirs in judge.theirs.items()
        if SHOWN + name in made
    ]
    return np.concatenate(parts, 1)


def _near(constant: float) -> str:
    """What a factor is near to; "" if nothing known."""
    for says, value in KNOWN.items():
        for factor, how in ((value, says), (1 / value, f"the inverse of {says}")):
            if abs(constant / factor - 1) < _NEAR:
                return how
    return ""


def _edit(target: _Target, constant: float) -> Edit:
    sign = "×" if target.how == FACTOR else "+"
    near = _near(constant) if target.how == FACTOR else ""
    says = f"{target.says} {sign} {constant:.7g}" + (f": {near}" if near else "")
    return Edit(target.title, target.sides(constant), RARE_CONVENTION, says)


assert set(_BOTH[1][1]) < set(FINAL_VELOCITIES)
