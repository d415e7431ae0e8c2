"""The eleven staged collisions: Tables 1 and 2 (chapter, Section V), and their recomputation.

The tables are kept as printed (``legacy/table1.csv``, ``table2.csv``), with every emendation and
its evidence (``legacy/emendations.csv``). Loss and computed ΔV follow from the impact with Table
2's own e, e_m and μ; predicted ΔV from Equation 19 with the factor 2/3. Units: ft, s, slug.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from itertools import product
from typing import Any

import numpy as np

from ..files import packaged_text
from ..mechanics.inverse import complete
from ..mechanics.solve import evaluate
from .columns import Array
from .deltav import delta_v

HALF_COEFFICIENT = 0.0005  # half of the last digit of e, e_m and μ in Table 2
HALF_DIGIT = 0.05  # of loss and velocity changes
ROUNDING = 1e-9  # of the printed decimals themselves
COLUMNS_1 = ("category", "m", "I", "d", "phi", "theta", "Gamma", "vx", "vy", "Omega", "Vx", "Vy")
COLUMNS_2 = ("loss", "dVa_exp", "dVb_exp", "dVa_comp", "dVb_comp", "dVa_pred", "dVb_pred")
FIELDS = {
    "loss": "loss_percent",
    "mu": "mu_signed_Pt_over_Pn",
    "phi": "phi_deg",
    "theta": "theta_deg",
    "Gamma": "Gamma_deg",
}
"""Columns that have another heading in the files."""


@dataclass(frozen=True)
class Emendation:
    """One remark on a cell, or on a row (``column`` "*").

    ``kind``: emended, moved (by the scan), lost, doubtful (kept), or slip (of Table 2:
    recomputation gives ``emended``)."""

    table: int
    row: str
    column: str
    kind: str
    printed: str
    emended: str
    evidence: str


@dataclass(frozen=True)
class Collision:
    """One staged collision, emended.

    Parameters
    ----------
    number : int
        Its number in the tables.
    category : str
        Its configuration, as printed.
    scene : dict of str to float
        Vehicles and velocities before; spins before are 0 (Section V).
    measured : dict of str to float
        Final velocities and spins; NaN where lost.
    table2 : dict of str to float
        Table 2's row as printed.
    """

    number: int
    category: str
    scene: dict[str, float]
    measured: dict[str, float]
    table2: dict[str, float]

    @property
    def coefficients(self) -> dict[str, float]:
        """Table 2's E, EM and MUP (signed P_t/P_n)."""
        return {"E": self.table2["e"], "EM": self.table2["em"], "MUP": self.table2["mu"]}


@dataclass(frozen=True)
class Compared:
    """A cell of Table 2 beside its recomputation.

    ``low`` to ``high``: what the rounding of the printed inputs leaves open; ``agrees``: True if
    the printed digits lie within that, rounded; ``explanation``: the evidence if they do not."""

    collision: int
    column: str
    printed: float
    value: float
    low: float
    high: float
    agrees: bool
    explanation: str


def _rows(name: str) -> list[dict[str, str]]:
    return list(csv.DictReader(packaged_text("impact88.legacy", name).splitlines()))


@cache
def emendations() -> tuple[Emendation, ...]:
    """Return every remark on a cell of Tables 1 and 2, with its evidence."""
    return tuple(Emendation(table=int(row.pop("table")), **row) for row in _rows("emendations.csv"))


@cache
def collisions() -> tuple[Collision, ...]:
    """Return the eleven staged collisions in Table 1's order."""
    table1 = {row["row"]: _cells(row, COLUMNS_1) for row in _rows("table1.csv")}
    table2 = {row["collision"]: row for row in _rows("table2.csv")}
    numbers = dict.fromkeys(row.partition("/")[0] for row in table1)
    return tuple(_collision(number, table1, table2[number]) for number in numbers)


def _cells(row: Mapping[str, str], columns: tuple[str, ...]) -> dict[str, str]:
    return {column: row[FIELDS.get(column, column)] for column in columns}


def _collision(
    number: str, table1: Mapping[str, Mapping[str, str]], row: Mapping[str, str]
) -> Collision:
    scene = {"GA": float(table1[f"{number}/A"]["Gamma"]), "WA": 0.0, "WB": 0.0}
    final: dict[str, float] = {}
    for v, x, y in (("A", "UX", "UY"), ("B", "VX", "VY")):
        cells = table1[f"{number}/{v}"]
        names = {"M": "m", "I": "I", "D": "d", "P": "phi", "T": "theta"}
        scene |= {f"{name}{v}": float(cells[column]) for name, column in names.items()}
        scene |= {x: float(cells["vx"]), y: float(cells["vy"])}
        after = {f"V{v}X": "Vx", f"V{v}Y": "Vy", f"W{v}F": "Omega"}
        final |= {name: float(cells[column] or "nan") for name, column in after.items()}
    texts = _cells(row, ("e", "em", "mu", *COLUMNS_2))
    slips = {e.column: e.printed for e in emendations() if (e.table, e.row) == (2, number)}
    numbers = {name: float(slips.get(name) or text) for name, text in texts.items()}
    category = table1[f"{number}/A"]["category"]
    return Collision(int(number), category, scene, final, numbers)


def forward(collision: Collision, coefficients: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Return the impact of a collision with given E, EM and MUP, by default Table 2's.

    Parameters
    ----------
    collision : Collision
        The collision.
    coefficients : mapping of str to float or array_like, optional
        E, EM and MUP.
    """
    impacts = complete({**collision.scene, **(coefficients or collision.coefficients)}).values
    return impacts | evaluate(impacts, ("LOSS", "DVA", "DVB", "KI", "KF", "MUC"))[0]


def experimental(collision: Collision) -> dict[str, float]:
    """Return DVA and DVB from Table 1's measured velocities."""
    changes, _ = evaluate(collision.scene | collision.measured, ("DVA", "DVB"))
    return {name: float(value) for name, value in changes.items()}


def prediction(collision: Collision, loss: Any = None) -> dict[str, Array]:
    """Return DVA and DVB by Equation 19 from the energy loss in percent, by default Table 2's."""
    speeds, _ = evaluate(collision.scene, ("SA", "SB"))
    loss = collision.table2["loss"] if loss is None else loss
    return delta_v({**collision.scene, **speeds, "LOSS": loss})


def comparison() -> list[Compared]:
    """Return loss and the three pairs of ΔV of Table 2 beside their recomputation."""
    rows = []
    half = HALF_COEFFICIENT
    offsets = np.array([*product((0.0, -half, half), repeat=3)]).T
    for collision in collisions():
        pairs = zip(collision.coefficients.items(), offsets, strict=True)
        around = forward(collision, {name: x + offset for (name, x), offset in pairs})
        changes = experimental(collision)
        losses = collision.table2["loss"] + np.array([0.0, -HALF_DIGIT, HALF_DIGIT])
        equation_19 = prediction(collision, losses)
        values = {"loss": around["LOSS"]}
        for vehicle, name in (("a", "DVA"), ("b", "DVB")):
            values[f"dV{vehicle}_exp"] = np.array([changes[name]])
            values[f"dV{vehicle}_comp"] = around[name]
            values[f"dV{vehicle}_pred"] = equation_19[name]
        rows += [_recomputation(collision, column, values[column]) for column in COLUMNS_2]
    return rows


def _recomputation(collision: Collision, column: str, values: Array) -> Compared:
    """Return one cell beside ``values``: at the printed inputs first, then around them."""
    cell = collision.table2[column]
    low, high = float(np.min(values)), float(np.max(values))
    tolerance = HALF_DIGIT + ROUNDING
    agrees = low - tolerance <= cell <= high + tolerance
    key = (2, str(collision.number), column)
    evidence = {(e.table, e.row, e.column): e.evidence for e in emendations()}.get(key)
    explanation = "" if agrees else evidence or "not explained"
    return Compared(
        collision.number, column, cell, float(values[0]), low, high, bool(agrees), explanation
    )
