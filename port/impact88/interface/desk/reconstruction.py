"""The answers of the Reconstruction view: what `impact88 reconstruct` finds. What computes is
imported on first use: the page is shown before numpy is there."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ...collision import uncertain
from ...collision.case import Case, remark_lines
from ...collision.casescene import sample
from ...collision.scenefile import known_template
from ...collision.uncertain import Uncertain, skid_remarks
from ...collision.units import RULES, display_values
from ...errors import UserError
from ...mechanics.state import KNOWABLE
from ...messages.plaintable import number
from ...messages.schemas import with_schema
from ...names import FINAL_STATE, SCENE, VELOCITIES, check_names, quantity
from .formview import digits, entries, spoken_direction, units_shown

DRAWS = 20_000  # random draws for the quantiles, as for a collision's bounds
_DIGITS = 6  # digits shown of a value, as the command prints
_DIGITS_TO_GO_ON = 12  # digits of a value that enters another computation
_COLUMNS = {
    "sd": (3, "spread"),
    "5 %": (6, "0.05"),
    "95 %": (6, "0.95"),
    "lower": (6, "lower"),
    "upper": (6, "upper"),
    "error amplified": (3, "amplified"),
}
"""Columns of a table: the digits shown, and the key of the value."""
_ASKED = ("DVA", "DVB", "PDOFA", "PDOFB", "LOSS")
"""Shown first, and then what was solved for."""


def warm() -> None:
    answer(known_of_sample(1)["values"])


def answer(values: dict[str, str], units: str = "", draws: int = DRAWS) -> dict[str, Any]:
    """Return the solutions for the known values: ``problems`` by name; ``waiting``, why there is
    none; ``units`` as `units_shown`; ``object``, what `impact88 reconstruct --json` prints;
    ``solutions``, each with the command's text (``printed``), its first ``lines`` (labels, texts
    and True where they are adverse), ``rows`` and ``columns`` of a table, ``adjusted`` values,
    ``warnings`` and the ``scene`` (texts by name, or None)."""
    from ...casework.reconstruction.answer import answers
    from ...casework.reconstruction.answerjson import json_of
    from ...casework.reconstruction.answertable import first_lines, is_adverse, text_of
    from ...casework.reconstruction.derived import without_noise

    case, problems = entries(values, units)
    system = case.system if case else RULES
    known: dict[str, Uncertain] = {}
    for name, text in case.values.items() if case else ():
        try:
            known[name] = _read(name, text, system.name or None)
        except UserError as error:
            problems[name] = str(error)
    reply: dict[str, Any] = {"problems": problems, "units": units_shown(system)}
    reply |= {"waiting": "", "object": None, "solutions": []}
    reply["remarks"] = remark_lines(case.remarks) if case else []
    try:
        if problems or case is None:
            raise UserError(f"To be corrected: {' '.join(problems)}.")
        found = answers(known, draws, remarks=[*reply["remarks"], *skid_remarks(case.values)])
        solutions = [
            (
                json_of(answer, system),
                display_values(
                    without_noise(answer.values, deviations=answer.uncertainties), system
                ),
                text_of(answer, system),
                [(*line, is_adverse(answer, line[0])) for line in first_lines(answer, system)],
            )
            for answer in found
        ]
    except UserError as error:
        return {**reply, "waiting": str(error)}
    reply["object"] = with_schema(
        "reconstruct", {"solutions": [numbers for numbers, *_ in solutions]}
    )
    reply["solutions"] = [_solution(case, known, *solution) for solution in solutions]
    for solution in reply["solutions"]:  # what stands above all of them is not said twice
        solution["warnings"] = [w for w in solution["warnings"] if w not in reply["remarks"]]
    return reply


def _read(name: str, text: str, units: str | None) -> Uncertain:
    check_names((name,), KNOWABLE, "name used here", "")
    return uncertain.read(text, name, units=units)


def _solution(
    case: Case,
    known: Mapping[str, Uncertain],
    values: Mapping[str, Any],
    rounded: Mapping[str, float],
    printed: str,
    lines: Sequence[tuple[str, str, bool]],
) -> dict[str, Any]:
    system = case.system

    def what(name: str) -> dict[str, Any]:
        return {**quantity(name)._asdict(), "unit": system.label(quantity(name).unit)}

    found = values["values"]
    rows = []
    for name, value in found.items():
        spread = values["uncertainty"].get(name, {})
        amplified = values["amplification"].get(name)
        deviation = spread.get("first_order")
        if deviation is None:  # the draws contradict it
            deviation = spread.get("deviation")
        parts = {**spread, **spread.get("quantiles", {}), "amplified": amplified}
        parts["spread"] = deviation
        numbers = {head: parts.get(part) for head, (_, part) in _COLUMNS.items()}
        row = {**what(name), "value": value, "known": name in values["known"], "numbers": numbers}
        row["said"] = spoken_direction(name, value, system)
        row["text"] = digits(None if value is None else rounded[name], _DIGITS)
        row["solved"] = name in values["solved_for"] and not row["known"]
        row["columns"] = {head: digits(x, _COLUMNS[head][0]) for head, x in numbers.items()}
        rows.append(row)
    shown_digits = {"measured": _DIGITS, "tolerance": _COLUMNS["sd"][0], "adjusted": _DIGITS}
    adjusted = [
        {
            **what(row["name"]),
            **{part: digits(row[part], count) for part, count in shown_digits.items()},
            "moved": f"{round(row['moved'], 2) + 0.0:.2f}",
        }
        for row in values["adjusted"]
        if values["redundancy"]
    ]
    asked = [row for name in _ASKED for row in rows if row["name"] == name]
    return {
        "printed": printed,
        "rows": rows,
        "lines": lines,
        "first": asked + [row for row in rows if row["solved"] and row["name"] not in _ASKED],
        "columns": [head for head in _COLUMNS if any(row["columns"][head] for row in rows)],
        "adjusted": adjusted,
        "warnings": values["warnings"],
        "scene": _scene(case, known, {**found, **rounded}),
    }


def _scene(
    case: Case, known: Mapping[str, Uncertain], values: Mapping[str, float | None]
) -> dict[str, str] | None:
    """Return the impact found as the texts of a scene; what is known exactly as it was typed."""
    entries: dict[str, str] = {}
    for name in SCENE:
        value = values.get(name)
        if value is None or not math.isfinite(value):
            return None
        exact = name in case.given and name in known and not known[name].varies
        typed = exact and not known[name].share
        entries[name] = case.given[name] if typed else number(value, _DIGITS_TO_GO_ON)
    return entries


def known_file(values: Mapping[str, str], units: str = "") -> str:
    """Return what is known as the file that `impact88 reconstruct` reads. Raises UserError."""
    case, problems = entries(values, units)
    for problem in problems.values():
        raise UserError(problem)
    assert case is not None
    for name, text in case.values.items():
        _read(name, text, case.units)
    return known_template(KNOWABLE, case) + "\n"


def known_of_sample(which: int) -> dict[str, Any]:
    """A published run with its results known and its initial velocities not. Raises UserError."""
    from ...conformance.comparison.oracle import oracle

    scene = sample(which)
    results = oracle([scene], reference=False)[0]["results"]
    after = {
        name: number(results[name]["double"], _DIGITS_TO_GO_ON)
        for name in FINAL_STATE
        if results[name]["double"] is not None
    }
    values = {name: text for name, text in scene.items() if name not in (*VELOCITIES, "MU")}
    values["MUP"] = number(results["MUP"]["double"], _DIGITS_TO_GO_ON)
    return {"values": {**values, **after}, "title": scene.title or "", "units": scene.units}
