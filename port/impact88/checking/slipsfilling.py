"""What may stand otherwise in a program's equations.

The listing's matrix has the rows of Equations 13, 14, 16, 15, 17, 18 and the columns VAX VAY VBX
VBY WAF WBF.
"""

# ruff: noqa: E501

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import Any

import numpy as np

from ..accuracy.elimination import ORDER as UNKNOWNS
from ..reconstruction.geometry import Geometry
from .otherprograms import matrices, used_friction
from .slip import Columns, Fills, Floats, Reads, Slip

INITIAL = ("UX", "UY", "VX", "VY", "WA", "WB")
"""The initial velocities in the order of the unknowns."""
EQUATIONS = {
    "13": "momentum along x",
    "14": "momentum along y",
    "16": "friction",
    "15": "restitution",
    "17": "angular momentum",
    "18": "moment",
}
"""Number and subject, in the order of the matrix's rows."""


def _row(number: str) -> int:
    return list(EQUATIONS).index(number)


def _restitution_at_centres(matrix: Floats, right: Floats, g: Columns) -> None:
    row = _row("15")
    matrix[:, row, 4:] = 0
    _closing_of_centres(matrix, right, g)


def _closing_of_centres(matrix: Floats, right: Floats, g: Columns) -> None:
    c, s = np.cos(np.radians(g["GA"])), np.sin(np.radians(g["GA"]))
    closing = c * (g["UX"] - g["VX"]) + s * (g["UY"] - g["VY"])
    right[:, _row("15")] = -g["E"] * closing


def _no_arms_after(matrix: Floats, right: Floats, g: Columns) -> None:
    matrix[:, _row("15"), 4:] = 0


def _spins_conserved(matrix: Floats, right: Floats, g: Columns) -> None:
    row = _row("17")
    matrix[:, row, :4] = 0
    right[:, row] = matrix[:, row, 4] * g["WA"] + matrix[:, row, 5] * g["WB"]


def friction_on_a(matrix: Floats, right: Floats, g: Columns) -> None:
    """Equation 16 with the impulse on A alone, as many write it, where the listing takes A's y and
    B's x: the same as long as Equations 13 and 14 are right."""
    geometry = Geometry.of(g)
    mu = used_friction(g)
    sliding = mu != -10
    along = [
        g["MA"] * (-geometry.sine - mu * geometry.cosine),
        g["MA"] * (geometry.cosine - mu * geometry.sine),
    ]
    _on_a(matrix, right, g, "16", along, (0.0, 0.0), where=sliding)


def angular_momentum_on_a(matrix: Floats, right: Floats, g: Columns) -> None:
    """Equation 17, likewise."""
    geometry = Geometry.of(g)
    turning = [-g["MA"] * (geometry.d1 + geometry.d3), g["MA"] * (geometry.d2 + geometry.d4)]
    row = _row("17")
    _on_a(matrix, right, g, "17", turning, (matrix[:, row, 4], matrix[:, row, 5]))


def moment_on_a(matrix: Floats, right: Floats, g: Columns) -> None:
    """Equation 18 with the moment on A alone, where the listing takes both vehicles' spins."""
    geometry = Geometry.of(g)
    point = geometry.point
    em = np.where(point, 1.0, g["EM"])
    ia, ib = (np.where(point, 1.0, g[name]) for name in ("IA", "IB"))
    both = em * (1 / ia + 1 / ib)
    arms = [-both * g["MA"] * geometry.d3, both * g["MA"] * geometry.d4]
    row = _row("18")
    for column, value in enumerate((*arms, 0.0, 0.0, both * ia - (1 - em), 1 - em)):
        matrix[:, row, column] = value
    right[:, row] = arms[0] * g["UX"] + arms[1] * g["UY"] + both * ia * g["WA"]


def _on_a(
    matrix: Floats,
    right: Floats,
    g: Columns,
    number: str,
    along: Sequence[Floats],
    spins: Sequence[Any],
    where: Any = True,
) -> None:
    """An equation in the changes of A's velocity, and the spins."""
    row = _row(number)
    terms = (*along, 0.0, 0.0, *spins)
    for column, value in enumerate(terms):
        matrix[:, row, column] = np.where(where, value, matrix[:, row, column])
    before = (g["UX"], g["UY"], 0.0, 0.0, g["WA"], g["WB"])
    change = sum(term * velocity for term, velocity in zip(terms, before, strict=True))
    right[:, row] = np.where(where, change, right[:, row])


ON_A: tuple[Fills, ...] = (friction_on_a, angular_momentum_on_a, moment_on_a)


def _nothing_right(numbers: Sequence[str], forms: Sequence[Fills] = ()) -> Fills:
    """Right-hand sides 0, some equations written with the impulse on A alone."""

    def change(matrix: Floats, right: Floats, g: Columns) -> None:
        for form in forms:
            form(matrix, right, g)
        for number in numbers:
            right[:, _row(number)] = 0

    return change


def _nothing(says: str, *numbers: str, common: bool = False) -> Iterator[Slip]:
    """Right-hand sides 0, whichever way the equations besides are written."""
    for count in range(len(ON_A) + 1):
        for forms in combinations(ON_A, count):
            yield Slip(
                f"{says} ({_listed(numbers)})",
                equations=_nothing_right(numbers, forms),
                common=common and not forms,
            )


def _listed(numbers: Sequence[str]) -> str:
    return f"Equation{'s' if len(numbers) > 1 else ''} {' and '.join(numbers)}"


def _term(row: int, column: int, *, factor: float = -1.0) -> Fills:
    def change(matrix: Floats, right: Floats, g: Columns) -> None:
        matrix[:, row, column] *= factor

    return change


def _term_throughout(row: int, column: int, factor: float, *, left: bool = True) -> Fills:
    """The same, with its share of the right-hand side, which holds the initial velocity there;
    ``left``: False for that share alone."""

    def change(matrix: Floats, right: Floats, g: Columns) -> None:
        term = matrix[:, row, column].copy()
        before = term * g[INITIAL[column]]
        if row == _row("15"):
            before = -g["E"] * before
        elif row == _row("18") and column >= 4:
            before = np.sign(column - 4.5) * -g["EM"] * g[INITIAL[column]]
        held = np.where((row == _row("16")) & (g["MU"] == -10), 0.0, before)
        if left:
            matrix[:, row, column] *= factor
        right[:, row] += (factor - 1) * held

    return change


def _one_inertia(number: int) -> Fills:
    """Equation 18 with the moment's effect on one vehicle only."""
    inertia = ("IA", "IB")[number]

    def change(matrix: Floats, right: Floats, g: Columns) -> None:
        moment_on_a(matrix, right, g)
        row, em = _row("18"), g["EM"]
        both, one = 1 / g["IA"] + 1 / g["IB"], 1 / g[inertia]
        share = np.where(g["M"] == 4, 1.0, one / both)
        spin = np.where(g["M"] == 4, 0.0, -(1 - em))
        matrix[:, row, 4] = (matrix[:, row, 4] - spin) * share + spin
        matrix[:, row, :4] *= share[:, None]
        right[:, row] *= share

    return change


def _right_side(row: int) -> Fills:
    def change(matrix: Floats, right: Floats, g: Columns) -> None:
        right[:, row] *= -1

    return change


def _in_form(forms: Sequence[Fills], change: Fills) -> Fills:
    """A change of the equations after some have been written otherwise."""

    def both(matrix: Floats, right: Floats, g: Columns) -> None:
        for form in forms:
            form(matrix, right, g)
        change(matrix, right, g)

    return both


_FORMS: dict[str, tuple[tuple[Fills, ...], ...]] = {
    "13": ((), ON_A),
    "14": ((), ON_A),
    "16": ((), (friction_on_a,)),
    "17": ((), (moment_on_a,)),
    "18": ((), (moment_on_a,)),
}
"""An equation -> the ways to write it and the others, which are no longer the same once it is
wrong."""


def _terms() -> Iterator[Slip]:
    """One term of one equation with the wrong sign, or left out."""
    for row, (number, subject) in enumerate(EQUATIONS.items()):
        where = f"Equation {number} ({subject})"
        changes = {f"{where}: right-hand side with the wrong sign": _right_side(row)}
        for column, unknown in enumerate(UNKNOWNS):
            both = f"{where}: terms of {unknown} and {INITIAL[column]}"
            for how, factor in (("with the wrong sign", -1.0), ("left out", 0.0)):
                changes[f"{where}: term of {unknown} {how}"] = _term(row, column, factor=factor)
                changes[f"{both} {how}"] = _term_throughout(row, column, factor)
                changes[f"{where}: term of {INITIAL[column]} {how}"] = _term_throughout(
                    row, column, factor, left=False
                )
        for says, change in changes.items():
            for forms in _FORMS.get(number, ((),)):
                yield Slip(says, equations=_in_form(forms, change), common=False)


FILLED: tuple[Slip, ...] = (
    Slip("restitution at the mass centres, not at the contact point", equations=_restitution_at_centres),
    Slip("restitution: closing velocity of the mass centres", equations=_closing_of_centres),
    Slip("restitution: spins left out after the impact", equations=_no_arms_after),
    *_nothing("momentum's right-hand sides 0", "13", "14", common=True),
    *_nothing("angular momentum's right-hand side 0", "17", common=True),
    Slip("angular momentum without the arms: spins conserved", equations=_spins_conserved),
    *_nothing("momentum's right-hand side along x 0", "13"),
    *_nothing("momentum's right-hand side along y 0", "14"),
    *_nothing("friction's right-hand side 0", "16"),
    *_nothing("the moment's right-hand side 0", "18"),
    Slip("Equation 18: the moment's effect on A only", equations=_one_inertia(0)),
    Slip("Equation 18: the moment's effect on B only", equations=_one_inertia(1)),
)  # fmt: skip
TERMS = tuple(_terms())


def in_one_equation(number: str, slips: Sequence[Slip]) -> Iterator[Slip]:
    """Ways of reading the scene, in one equation only."""
    row = _row(number)
    for slip in slips:

        def change(matrix: Floats, right: Floats, g: Columns, read: Reads = slip.scene) -> None:
            other, other_right = matrices({**g, **read(g)})
            matrix[:, row], right[:, row] = other[:, row], other_right[:, row]

        says = f"Equation {number} ({EQUATIONS[number]}): {slip.says}"
        yield Slip(says, equations=change, common=False)
