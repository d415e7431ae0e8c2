"""The eleven staged collisions: Tables 1 and 2 (chapter, Section V) as data, and what they say.

The tables are kept as printed (``legacy/table1.csv``, ``table2.csv``) with every emendation and
its evidence (``legacy/emendations.csv``). Two ways from Table 1 to Table 2:

- `forward`: the impact solved with Table 2's own e, e_m and μ: energy loss and computed ΔV;
- `predict_delta_v`: ΔV by Equation 19 (with the factor 2/3, see `chapter.deltav`).

`comparison` puts them beside Table 2, cell by cell.

Units: ft, s, slug (Table 1).
"""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...files import packaged_text
from ...mechanics.closedform.general import typed_friction
from ...mechanics.closedform.solve import solve
from ...mechanics.state import State
from .deltav import delta_v

Array = NDArray[np.float64]

# half of the last digit that Table 2 prints
_HALF_DIGIT_COEFFICIENT = 0.0005
_HALF_DIGIT = 0.05  # of loss and velocity changes

# -- the tables


@dataclass(frozen=True)
class Emendation:
    """One remark on a cell, or a row (``column`` ``*``): ``kind`` is emended, moved (by the scan),
    lost, doubtful (kept) or slip (of Table 2: recomputation gives ``emended``)."""

    table: int
    row: str
    column: str
    kind: str
    printed: str
    emended: str
    evidence: str


@dataclass(frozen=True)
class Cell:
    """A cell as printed (where it belongs, if the scan moved it) and as emended."""

    table: int
    row: str
    column: str
    printed: str
    emended: str
    remark: Emendation | None


COLUMNS_1 = ("category", "m", "I", "d", "phi", "theta", "Gamma", "vx", "vy", "Omega", "Vx", "Vy")
COLUMNS_2 = (
    "loss",
    "e",
    "em",
    "mu",
    "dVa_exp",
    "dVb_exp",
    "dVa_comp",
    "dVb_comp",
    "dVa_pred",
    "dVb_pred",
)


def _rows(name: str) -> list[dict[str, str]]:
    return list(csv.DictReader(packaged_text("impact88.legacy", name).splitlines()))


@cache
def emendations() -> tuple[Emendation, ...]:
    """Return every remark on a cell of Tables 1 and 2, with its evidence."""
    return tuple(Emendation(table=int(row.pop("table")), **row) for row in _rows("emendations.csv"))


@cache
def cells() -> tuple[Cell, ...]:
    """Return Tables 1 and 2, cell by cell: as printed, as emended, and the evidence."""
    keys = {"loss": "loss_percent", "mu": "mu_signed_Pt_over_Pn"}
    keys |= {column: f"{column}_deg" for column in ("phi", "theta", "Gamma")}
    result = []
    for table, columns in ((1, COLUMNS_1), (2, COLUMNS_2)):
        for row in _rows(f"table{table}.csv"):
            name = row["row" if table == 1 else "collision"]
            texts = {column: row[keys.get(column, column)] for column in columns}
            row_texts = _printed_1(row) if table == 1 else texts
            for column, text in texts.items():
                remark = _remark(table, name, column)
                text_read = remark.emended if remark and table == 2 else text
                result.append(Cell(table, name, column, row_texts[column], text_read, remark))
    return tuple(result)


def _remark(table: int, row: str, column: str) -> Emendation | None:
    """Return the remark on a cell, or else on its whole row; None if there is none."""
    remarks = {e.column: e for e in emendations() if (e.table, e.row) == (table, row)}
    return remarks.get(column) or remarks.get("*")


def _printed_1(row: Mapping[str, str]) -> dict[str, str]:
    """Return the printed cells by column; a row that the scan shifted is shifted back."""
    texts = [row[f"printed_cell_{number}"] for number in range(2, 12)]
    shift = _remark(1, row["row"], "*")
    if shift and shift.printed == "one cell right":
        texts = [*texts[1:], ""]
    elif shift:
        texts = ["", *texts[:-1]]
    *first, before, spin, after = (text.replace("- ", "-") for text in texts)
    values = (*first, *before.split("/"), spin, *(after.split("/") if after else ("", "")))
    return {name: value.strip() for name, value in zip(COLUMNS_1, values, strict=True)}


@dataclass(frozen=True)
class Collision:
    """One staged collision, emended: ``scene`` by the listing's names without coefficients (initial
    spins are 0, as Section V says); ``measured``: final velocities, NaN where lost; ``table2``:
    Table 2's row as printed, by column."""

    number: int
    category: str
    scene: dict[str, float]
    measured: dict[str, float]
    table2: dict[str, float]

    @property
    def coefficients(self) -> dict[str, float]:
        """Table 2's E, EM and MUP (signed P_t/P_n)."""
        return {"E": self.table2["e"], "EM": self.table2["em"], "MUP": self.table2["mu"]}


@cache
def collisions() -> tuple[Collision, ...]:
    """Return the eleven staged collisions in Table 1's order."""
    rows: dict[str, dict[str, str]] = {}
    for cell in cells():
        # Table 2 is compared as it is printed
        text = cell.emended if cell.table == 1 else cell.printed
        rows.setdefault(cell.row, {})[cell.column] = text
    result = []
    for number in (name for name in rows if name.isdigit()):
        scene = {"GA": float(rows[f"{number}/A"]["Gamma"]), "WA": 0.0, "WB": 0.0}
        measurements: dict[str, float] = {}
        for v, x, y in (("A", "UX", "UY"), ("B", "VX", "VY")):
            row = rows[f"{number}/{v}"]
            names = {"M": "m", "I": "I", "D": "d", "P": "phi", "T": "theta"}
            scene |= {f"{name}{v}": float(row[column]) for name, column in names.items()}
            scene |= {x: float(row["vx"]), y: float(row["vy"])}
            after = {f"V{v}X": row["Vx"], f"V{v}Y": row["Vy"], f"W{v}F": row["Omega"]}
            measurements |= {name: float(text or "nan") for name, text in after.items()}
        table2 = {column: float(text) for column, text in rows[number].items()}
        category = rows[f"{number}/A"]["category"]
        result.append(Collision(int(number), category, scene, measurements, table2))
    return tuple(result)


# -- forward, experimental, predict_delta_v


def forward(
    collision: Collision, coefficients: Mapping[str, Any] | None = None
) -> dict[str, Array]:
    """Return all results of `impact88.solve` for a collision.

    ``coefficients``: E, EM and MUP; by default Table 2's.
    """
    values = dict(collision.coefficients if coefficients is None else coefficients)
    mu = typed_friction(collision.scene, values.pop("MUP"))
    return solve({**collision.scene, **values, "MU": mu})


def experimental(collision: Collision) -> dict[str, float]:
    """Return DVA and DVB from Table 1's measured velocities."""
    state = State.of_known(collision.scene | collision.measured)
    return {name: float(state[name]) for name in ("DVA", "DVB")}


def predict_delta_v(collision: Collision, loss: Any = None) -> dict[str, Array]:
    """Return DVA and DVB by Equation 19 from the energy loss in percent, by default Table 2's."""
    scene = collision.scene
    speeds = {"SA": np.hypot(scene["UX"], scene["UY"]), "SB": np.hypot(scene["VX"], scene["VY"])}
    loss = collision.table2["loss"] if loss is None else loss
    return delta_v({**scene, **speeds, "LOSS": loss})


def closure(collision: Collision) -> dict[str, float]:
    """Equations 13, 14 and 17 and the energy of the velocities as measured, nothing fitted: the
    ``number``, the energy ``loss`` in percent, the change of A's momentum along x and y and of the
    angular momentum about the origin of Equation 17, and minus B's: equal where momentum is
    conserved; slug·ft/s and slug·ft²/s, NaN where a velocity is lost."""
    values = {name: np.asarray(v) for name, v in (collision.scene | collision.measured).items()}
    state = State.of_known(values)
    here, (ax, ay, wa, bx, by, wb) = state.here, map(float, state.changes)
    ma, mb, ia, ib = (float(values[name]) for name in ("MA", "MB", "IA", "IB"))
    return {
        "number": collision.number,
        "loss": float(state["LOSS"]),
        "x_of_a": ma * ax,
        "x_of_b": -mb * bx,
        "y_of_a": ma * ay,
        "y_of_b": -mb * by,
        # the impulse acts at (-d4, -d3) from A's center: M = I ΔΩ - r x m ΔV, and on B the opposite
        "spin_of_a": float(ia * wa - ma * (-here.d4 * ay + here.d3 * ax)),
        "spin_of_b": float(-ib * wb + mb * (here.d2 * by - here.d1 * bx)),
    }


# -- against Table 2


@dataclass(frozen=True)
class Compared:
    """A cell of Table 2 beside its recomputation. ``low`` ... ``high``: what the rounding of the
    printed inputs (coefficients, for the predicted values the loss) leaves open; ``agrees``:
    whether the printed digits lie within that, rounded; ``explanation``: why not."""

    collision: int
    column: str
    printed: float
    value: float
    low: float
    high: float
    agrees: bool
    explanation: str


def comparison(printed: Sequence[Collision] | None = None) -> list[Compared]:
    """Compare loss and the three pairs of ΔV of Table 2, or of what is said to be ``printed``, with
    their recomputation."""
    half, rows = _HALF_DIGIT_COEFFICIENT, []
    offsets = np.array([*product((-half, 0, half), repeat=3)]).T
    for collision in collisions() if printed is None else printed:
        coefficients = {
            n: x + o for (n, x), o in zip(collision.coefficients.items(), offsets, strict=True)
        }
        centre, spread = forward(collision), forward(collision, coefficients)
        measurements = experimental(collision)
        rounded_loss = collision.table2["loss"] + np.array([0, -_HALF_DIGIT, _HALF_DIGIT])
        equation_19 = predict_delta_v(collision, rounded_loss)
        values: dict[str, tuple[float, Any]] = {"loss": (float(centre["LOSS"]), spread["LOSS"])}
        for vehicle, name in (("a", "DVA"), ("b", "DVB")):
            values[f"dV{vehicle}_exp"] = (measurements[name], measurements[name])
            values[f"dV{vehicle}_comp"] = (float(centre[name]), spread[name])
            values[f"dV{vehicle}_pred"] = (float(equation_19[name][0]), equation_19[name])
        for column in filter(values.__contains__, COLUMNS_2):
            value, around = values[column]
            cell = collision.table2[column]
            low, high = float(np.min(around)), float(np.max(around))
            # a printed last digit stands for half a unit either way; 1e-9: its own rounding
            agrees = low - _HALF_DIGIT - 1e-9 <= cell <= high + _HALF_DIGIT + 1e-9
            remark = _remark(2, str(collision.number), column)
            why = "" if agrees else remark.evidence if remark else "not explained"
            rows.append(
                Compared(
                    collision=collision.number,
                    column=column,
                    printed=cell,
                    value=value,
                    low=low,
                    high=high,
                    agrees=bool(agrees),
                    explanation=why,
                )
            )
    return rows
