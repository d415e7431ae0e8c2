"""A solution of the impact equations as a table to read and as JSON to process."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

from ..errors import UserError
from ..names import CHAPTER, FINAL_STATE, PIVOT, RESULTS, SCENE, VELOCITIES, quantity
from ..plaintable import decimals_for, fixed, number, paragraph, plain, table
from ..schemas import stamped
from ..status import sentences
from ..units import RULES, System, written
from .answertable import Open, answer
from .doublerange import within_doubles
from .impulse import clock, forces
from .outcome import moment_ratio, outcome
from .state import CHANGES
from .unknowns import BADLY_CONDITIONED, Solution, solve_for

_ORDER = (*SCENE, *RESULTS, *CHAPTER)
_BARRIERS = (
    *("MB", "IB", "DB", "PB", "TB", "VX", "VY", "WB", "VBX", "VBY", "WBF"),
    *("XB", "YB", "XBF", "YBF", "DVB", "DVBF", "DVBR", "CBX", "CBY", "PDOFB"),
    *("SB", "HB", "SBF", "HBF"),
)
"""What is not worth telling of B when it is a rigid barrier."""
_TURNING = (
    *("EM", "RR0", "PM", "WA", "WAF", "WB", "WBF", "IA", "IB", "DA", "DB", "PA", "PB"),
    *("XA", "YA", "XB", "YB", "XAF", "YAF", "XBF", "YBF", "CAX", "CAY", "CBX", "CBY"),
)
"""What point masses have not, or have twice."""


def complete(
    known: Mapping[str, float], solution: Solution, contact_time: float | None
) -> dict[str, float]:
    """Everything about one solution of a single scene, by name, in the tables' order: what was
    given, what was found, and what follows (`outcome`; forces for a contact time)."""
    values = {**known, **{name: float(value) for name, value in solution.values.items()}}
    return completed(values, contact_time)


def completed(values: dict[str, float], contact_time: float | None) -> dict[str, float]:
    """One impact's values and what follows from them, in the tables' order."""
    following = {name: float(value) for name, value in outcome(values).items()}
    if contact_time is not None and "P" in following:
        following["TF"] = contact_time
        following |= {n: float(v) for n, v in forces(following["P"], contact_time).items()}
    values = values | following
    if "EM" in values:
        values["RR0"] = float(moment_ratio(values["EM"]))
    untold = _BARRIERS if math.isinf(values.get("MB", 0.0)) else ()
    untold = (*untold, *_TURNING) if values.get("M") == 4 else untold
    return {name: values[name] for name in _ORDER if name in values and name not in untold}


def warnings(solution: Solution, values: Mapping[str, float], units: System = RULES) -> list[str]:
    """What a reader must know about a solution of a single scene, in sentences."""
    lines = []
    mismatch = float(solution.mismatch)
    if solution.contradictory:
        lines.append(
            "the known values contradict one another: the solution fits them by least squares, "
            f"root-mean-square mismatch {number(units.shown('length/time', mismatch), 3)} "
            f"[{units.label('length/time')}]"
        )
    worst = {name: float(value) for name, value in solution.amplification.items()}
    bad = {name: value for name, value in worst.items() if not value < BADLY_CONDITIONED}
    if bad:
        names = ", ".join(f"{name} {number(value, 3)} times" for name, value in bad.items())
        lines.append(f"badly conditioned: errors of the known velocities are amplified ({names})")
    return lines + sentences(int(values.get("STATUS", 0)), values)


def as_text(
    known: Mapping[str, float],
    solution: Solution,
    values: Mapping[str, float],
    units: System = RULES,
) -> str:
    """The solution as tables: velocities, coefficients, impulse, consequences, warnings."""
    remarks = warnings(solution, values, units)
    velocities = (*VELOCITIES, *FINAL_STATE)
    missing = [
        n for n in velocities if n not in values and not (n in _TURNING and values.get("M") == 4)
    ]
    if math.isinf(values.get("MB", 0.0)):
        missing = [name for name in missing if name not in _BARRIERS]
    blocks: list[list[str]] = [
        answer(values, {}, Open(missing), len(remarks), units),
        velocities_table(known, values, units),
        named_table(("E", "MUP", "EM", "RR0"), known, values, units),
        named_table(("PN", "PT", "PM", "P", "PDOFA", "PDOFB"), known, values, units),
        named_table(("TF", "FA", "FM2", "FM3"), known, values, units),
        named_table((*CHANGES, "VC", "VS"), known, values, units),
        named_table(("KI", "KF", "LOSS"), known, values, units),
        named_table(("CAX", "CAY", "CBX", "CBY"), known, values, units),
        _conditions(solution),
    ]
    lines = [line for block in blocks if block for line in (*block, "")]
    for warning in remarks:
        lines += paragraph(f"! {warning}")
    return "\n".join(lines).rstrip("\n")


_ROWS = (
    ("x", "length/time", ("UX", "VAX", "VX", "VBX")),
    ("y", "length/time", ("UY", "VAY", "VY", "VBY")),
    ("spin", "rad/time", ("WA", "WAF", "WB", "WBF")),
    ("speed", "length/time", ("SA", "SAF", "SB", "SBF")),
    ("course", "degree", ("HA", "HAF", "HB", "HBF")),
    ("x at contact point", "length/time", ("XA", "XAF", "XB", "XBF")),
    ("y at contact point", "length/time", ("YA", "YAF", "YB", "YBF")),
)


def velocities_table(
    known: Mapping[str, float], values: Mapping[str, float], units: System = RULES
) -> list[str]:
    """Velocities before and after of both vehicles, in components, sizes and directions."""
    values = written(values, units)
    decimals = {}
    for unit in ("length/time", "rad/time", "degree"):
        alike = [name for _, row_unit, row in _ROWS if row_unit == unit for name in row]
        decimals[unit] = decimals_for([values[name] for name in alike if name in values])
    rows = []
    vehicles = 2 if "VX" in values or "VBX" in values else 1
    for label, unit, all_names in _ROWS:
        names = all_names[: 2 * vehicles]
        if not any(name in values for name in names):
            continue
        cells = []
        for name in names:
            text = fixed(values[name], decimals[unit]) if name in values else "unknown"
            given = name in known or label not in ("x", "y", "spin") or name not in values
            cells.append(f"{text}{' ' if given else '*'}")
        rows.append([label, *cells, units.label(unit)])
    heading = ["A before ", "A after ", "B before ", "B after "][: 2 * vehicles]
    lines = table(rows, ["velocity", *heading, "unit"], left=(0, 1 + 2 * vehicles))
    return [*lines, "* solved for"]


def named_table(
    names: tuple[str, ...],
    known: Mapping[str, float],
    values: Mapping[str, float],
    units: System = RULES,
) -> list[str]:
    """Values by name, each with unit and meaning."""
    values = written(values, units)
    rows = []
    for name in names:
        if name not in values or values[name] != values[name]:
            continue
        what = quantity(name)
        given = name in known or (name == "MUP" and "MU" in known)
        mark = "*" if name in ("E", "MUP", "EM") and not given else " "
        note = what.meaning
        if name.startswith("PDOF"):
            note = f"{note} ({clock(values[name])})"
        if name == "MUP":
            note = _friction(values)
        if name == "EM":
            note = f"{note}; {number(-values[name])} with the sign the other way"
        rows.append([name, f"{number(values[name])}{mark}", units.label(what.unit), note])
    return table(rows, left=(0, 2, 3))


def _friction(values: Mapping[str, float]) -> str:
    if values["MUP"] == PIVOT:
        text = "pivot: no sliding at separation"
        if values.get("PN"):
            text += f"; P_t/P_n = {number(values['PT'] / values['PN'])} ends it"
        return text
    text = "signed P_t/P_n"
    if "UX" in values and "MU" in values:
        text += f"; MU to type in line 280: {number(values['MU'])}"
    if "MUC" in values:
        text += f"; critical {number(values['MUC'])}"
    return text


def _conditions(solution: Solution) -> list[str]:
    """How errors of the known velocities come through."""
    cells = [f"{name} {number(value, 3)}" for name, value in solution.amplification.items()]
    return paragraph(
        "Error amplification (error of the unknown when each known velocity errs independently by "
        "1; spins times the radius of gyration "
        f"{number(solution.gyration, 4)}, coefficients times the closing speed): {', '.join(cells)}"
    )


def as_json(
    known: Mapping[str, float],
    solution: Solution,
    values: Mapping[str, float],
    units: System = RULES,
) -> dict[str, Any]:
    """The solution for a program; numbers that do not exist are null."""
    status = int(values.get("STATUS", 0))
    whole: dict[str, Any] = plain(
        {
            "known": [name for name in values if name in known],
            "solved_for": list(solution.unknown),
            "values": {n: v for n, v in written(values, units).items() if n != "STATUS"},
            "units": {n: units.label(quantity(n).unit) for n in values if n != "STATUS"},
            "amplification": solution.amplification,
            "badly_conditioned": solution.badly_conditioned,
            "mismatch": solution.mismatch * units.shown("length/time", 1.0),
            "contradictory": solution.contradictory,
            "status": status if "STATUS" in values else None,
            "warnings": warnings(solution, values, units),
        }
    )
    return whole


@within_doubles
def show(
    known: Mapping[str, float],
    wanted: list[str] | None,
    source: str | None,
    contact_time: float | None,
    as_object: bool,
    units: System = RULES,
) -> None:
    """Print the solutions of one problem, as tables or as one JSON object; ``source`` names where
    the known values come from in errors, ``units`` how values are written."""
    try:
        solutions = solve_for(known, wanted)
        tables = [(s, complete(known, s, contact_time)) for s in solutions]
    except UserError as error:
        raise UserError(str(error), source) from None
    if as_object:
        solved = [as_json(known, s, v, units) for s, v in tables]
        print(json.dumps(stamped("reconstruct", {"solutions": solved}), allow_nan=False))
        return
    for at, (solution, values) in enumerate(tables):
        if len(tables) > 1:
            head = f"SOLUTION {at + 1} OF {len(tables)}: MU is known in size, and both signs agree"
            fit = " (each a fit of values that contradict one another)"
            print(f"{chr(10) if at else ''}{head}{fit if solution.contradictory else ''}\n")
        print(as_text(known, solution, values, units))
