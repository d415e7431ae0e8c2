"""A solution of the impact equations as a table to read and as JSON to process."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .impulse import clock, forces
from .names import CHAPTER, RESULTS, SCENE, Quantity
from .outcome import outcome
from .plaintable import decimals_for, fixed, number, paragraph, plain, table
from .status import WORDS, Status
from .unknowns import BADLY_CONDITIONED, PIVOT, Solution

_AS_GIVEN = (*SCENE, *RESULTS, *CHAPTER)


def quantity(name: str) -> Quantity:
    """Symbol, meaning and unit of any name a solution has."""
    return SCENE.get(name) or RESULTS.get(name) or CHAPTER[name]


def complete(
    known: Mapping[str, float], solution: Solution, contact_time: float | None
) -> dict[str, float]:
    """Everything about one solution of a single scene, by name, in the tables' order: what was
    given, what was found, and what follows (`impact88.outcome`; forces for a contact time)."""
    values = {**known, **{name: float(value) for name, value in solution.values.items()}}
    following = {name: float(value) for name, value in outcome(values).items()}
    if contact_time is not None and "P" in following:
        following["TF"] = contact_time
        following |= {n: float(v) for n, v in forces(following["P"], contact_time).items()}
    values |= following
    return {name: values[name] for name in _AS_GIVEN if name in values}


def warnings(solution: Solution, values: Mapping[str, float]) -> list[str]:
    """What a reader must know about a solution of a single scene, in sentences."""
    found = []
    if solution.contradictory:
        found.append(
            "the known values contradict one another: the solution fits them by least squares, "
            f"root-mean-square mismatch {number(solution.mismatch, 3)} [length/time]"
        )
    worst = {name: float(value) for name, value in solution.amplification.items()}
    bad = {name: value for name, value in worst.items() if not value < BADLY_CONDITIONED}
    if bad:
        names = ", ".join(f"{name} {number(value, 2)} times" for name, value in bad.items())
        found.append(f"badly conditioned: errors of the known velocities are amplified ({names})")
    status = Status(int(values.get("STATUS", 0)))
    found += [words for bit, words in WORDS.items() if status & bit]
    return found


def as_text(solution: Solution, values: Mapping[str, float]) -> str:
    """The solution as tables: velocities, coefficients, impulse, consequences, warnings."""
    blocks = [
        _velocities(solution, values),
        _named(("E", "MUP", "EM"), solution, values),
        _named(("PN", "PT", "PM", "P", "PDOFA", "PDOFB"), solution, values),
        _named(("TF", "FA", "FM2", "FM3"), solution, values),
        _named(("DVA", "DVB", "KI", "KF", "LOSS"), solution, values),
        _named(("CAX", "CAY", "CBX", "CBY"), solution, values),
        _conditions(solution),
    ]
    lines = [line for block in blocks if block for line in (*block, "")]
    for warning in warnings(solution, values):
        lines += paragraph(f"! {warning}")
    return "\n".join(lines).rstrip("\n")


_ROWS = (
    ("x", "length/time", ("UX", "VAX", "VX", "VBX")),
    ("y", "length/time", ("UY", "VAY", "VY", "VBY")),
    ("spin", "rad/time", ("WA", "WAF", "WB", "WBF")),
    ("x at contact point", "length/time", ("XA", "XAF", "XB", "XBF")),
    ("y at contact point", "length/time", ("YA", "YAF", "YB", "YBF")),
)


def _velocities(solution: Solution, values: Mapping[str, float]) -> list[str]:
    decimals = {}
    for unit in ("length/time", "rad/time"):
        names = [name for _, row_unit, row in _ROWS if row_unit == unit for name in row]
        decimals[unit] = decimals_for([values[name] for name in names if name in values])
    rows = []
    for label, unit, names in _ROWS:
        if not any(name in values for name in names):
            continue
        cells = []
        for name in names:
            text = fixed(values[name], decimals[unit]) if name in values else "unknown"
            cells.append(f"{text}{'*' if name in solution.unknown else ' '}")
        rows.append([label, *cells, unit])
    heading = ["velocity", "A before ", "A after ", "B before ", "B after ", "unit"]
    return [*table(rows, heading, left=(0, 5)), "* solved for"]


def _named(names: tuple[str, ...], solution: Solution, values: Mapping[str, float]) -> list[str]:
    rows = []
    for name in names:
        if name not in values or values[name] != values[name]:
            continue
        what = quantity(name)
        mark = "*" if name in solution.unknown else " "
        note = what.meaning
        if name.startswith("PDOF"):
            note = f"{note} ({clock(values[name])})"
        if name == "MUP":
            note = _friction(values)
        rows.append([name, f"{number(values[name])}{mark}", what.unit, note])
    return table(rows, left=(0, 2, 3))


def _friction(values: Mapping[str, float]) -> str:
    if values["MUP"] == PIVOT:
        return "pivot: no tangential relative velocity at separation"
    text = "signed P_t/P_n"
    if "UX" in values and "MU" in values:
        text += f"; MU to type in line 280: {number(values['MU'])}"
    if "MUC" in values:
        text += f"; critical {number(values['MUC'])}"
    return text


def _conditions(solution: Solution) -> list[str]:
    """How errors of the known velocities come through."""
    cells = [f"{name} {number(value, 2)}" for name, value in solution.amplification.items()]
    return paragraph(
        "Error amplification (error of the unknown when each known velocity errs independently by "
        "1; spins times the radius of gyration "
        f"{number(solution.gyration, 4)}, coefficients times the closing speed): {', '.join(cells)}"
    )


def as_json(
    known: Mapping[str, float], solution: Solution, values: Mapping[str, float]
) -> dict[str, Any]:
    """The solution for a program; numbers that do not exist are null."""
    status = int(values.get("STATUS", 0))
    return plain(  # type: ignore[no-any-return]
        {
            "known": [name for name in values if name in known],
            "solved_for": list(solution.unknown),
            "values": {n: v for n, v in values.items() if n != "STATUS"},
            "units": {n: quantity(n).unit for n in values if n != "STATUS"},
            "amplification": solution.amplification,
            "badly_conditioned": solution.badly_conditioned,
            "mismatch": solution.mismatch,
            "contradictory": solution.contradictory,
            "status": status if "STATUS" in values else None,
            "warnings": warnings(solution, values),
        }
    )
