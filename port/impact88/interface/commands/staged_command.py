"""Tables 1 and 2 of the chapter: eleven staged, instrumented collisions. Without options: Table 2
cell by cell beside its recomputation, the differences explained. Units: ft, s, slug.

  --cells     each cell that is not as printed or is doubtful, with the evidence
  --claims    every sentence with a number or a comparison, checked
  --table N   table 1 or 2 itself, emended
  --validation  25 crash tests published since, beside what is computed for them

impact88 reconstruct fits E, EM and MUP to measured velocities, each with its tolerance.

examples:
  impact88 chapter staged
  impact88 chapter staged --cells
  impact88 chapter staged --table 1
  impact88 chapter staged --json          all of it, for a program

exit status: 0 done; 1 a cell of Table 2 differs and nothing explains it
"""

from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from ...casework.chapter import sentences, staged, validation
from ...messages.plaintable import format_fixed, paragraph, table
from . import options

ARGUMENTS = (
    [
        options.flag("--cells", "emended and doubtful cells, evidence"),
        options.flag("--claims", "the chapter's claims, checked"),
        options.flag("--validation", "crash tests published since, recomputed"),
        options.choice("--table", (1, 2), "print a table, emended", type=int),
    ],
    options.JSON,
    options.OUTPUT,
)


def main(args: options.Args) -> int:
    views: dict[str, Callable[[], list[str]]] = {
        "claims": _claims,
        "cells": _cells,
        "validation": _validation,
        "table": lambda: _table(args.table),
    }
    view = next((name for name in views if getattr(args, name)), None)
    options.show(args, "staged", _everything, views[view] if view else _comparison)
    return int(any(not c.agrees and c.explanation == "not explained" for c in staged.comparison()))


def _claims() -> list[str]:
    def extent(values: tuple[float, float]) -> str:
        return f"{values[0] + 0.0:.1f} ... {values[1]:.1f}"

    lines = ["What the chapter says in numbers or comparisons, checked", ""]
    for claim in sentences.claims():
        lines += paragraph(f"Section {claim.where}: {claim.claim}: {claim.verdict}")
        lines += paragraph(claim.found, "  ") if claim.found else []
        if claim.varied:
            rows = [[claim.varied, extent(claim.sides), extent(claim.others), claim.unit]]
            lines += ["", *table(rows, ["  varied", "front to side", "others", ""], left=(0, 3))]
        lines += [""]
    return lines[:-1]


def _validation() -> list[str]:
    checks = validation.checks()
    lines = ["Crash tests published since the chapter, and what is computed for them", ""]
    for source, words in validation.SOURCES.items():
        source_checks = [check for check in checks if check.source == source]
        quantities = list(dict.fromkeys((check.quantity, check.unit) for check in source_checks))
        rows: dict[str, list[str]] = {}
        for check in source_checks:
            digits = {"1": 3, "°/s": 0, "mph": 1, "ft/s": 1}[check.unit]
            pair = f"{format_fixed(check.reported, digits)} {format_fixed(check.computed, digits)}"
            rows.setdefault(check.test, [check.test]).append(pair)
        lines += [
            *paragraph(f"{words[0].upper()}{words[1:]}: {source_checks[0].kind}, computed"),
            "",
        ]
        names = [f"{name}" + (f", {unit}" if unit != "1" else "") for name, unit in quantities]
        lines += [*table(rows.values(), ["test", *names]), ""]
    rows_of_medians = [
        [source, quantity, "" if unit == "1" else unit, kind, str(count), *figures]
        for source, quantity, unit, kind, count, *sizes in validation.medians(checks)
        for figures in [[format_fixed(size, 3 if unit == "1" else 2) for size in sizes]]
    ]
    heading = ["sizes of the differences", "", "", "from", "numbers", "median", "largest"]
    return [
        *lines,
        *table(rows_of_medians, heading, left=(0, 1, 2, 3)),
        "",
        *paragraph(
            "NHTSA: a model with friction at its critical value and no moment impulse; the "
            "published numbers are rounded. 4364 comes out low by more than that; a speed of A of "
            "35.25 mph, which rounds to the 35 published, would give all five numbers. IIHS: e and "
            "friction as published, so that what remains against the measurement is that "
            "model's; a radius of gyration of "
            f"{validation.GYRATION**0.5:.2f} ft is taken for every car, none is published."
        ),
    ]


def _comparison() -> list[str]:
    columns = [c for c in staged.COLUMNS_2 if c not in ("e", "em", "mu")]
    comparisons = staged.comparison()
    rows: dict[int, list[str]] = {}
    for cell in comparisons:
        text = f"{cell.printed:.1f} {format_fixed(cell.value, 2) or 'lost':>5}{'! '[cell.agrees]}"
        rows.setdefault(cell.collision, [str(cell.collision)]).append(text)
    agree = sum(cell.agrees for cell in comparisons)
    lines = [
        "Table 2 beside its recomputation: printed value, recomputed value (! differs).",
        "loss in percent; velocity changes dV of vehicles a and b in ft/s:",
        "exp from Table 1's velocities; comp from Equations 13-18 with Table 2's e, e_m, mu;",
        "pred by Equation 19 with the factor 2/3 (not printed, but Table 2 was computed with it).",
        "",
        *table(rows.values(), ["no.", *(f"{column} " for column in columns)]),
        "",
        f"{agree} of {len(comparisons)} agree within what the rounding of the printed numbers "
        "allows.",
    ]
    for cell in comparisons:
        if not cell.agrees:
            lines += paragraph(f"! {cell.collision}, {cell.column}: {cell.explanation}")
    return lines


def _cells() -> list[str]:
    lines = ["What is emended, moved, lost or doubtful in Tables 1 and 2 as printed", ""]
    for e in staged.emendations():
        place = f"Table {e.table}, {e.row}, {'the row' if e.column == '*' else e.column}"
        change = e.printed if e.printed == e.emended else f"{e.printed or 'blank'} -> {e.emended}"
        if e.kind == "lost" and not e.emended:
            change = "no value"
        lines += [f"{place}: {e.kind}: {change}", *paragraph(e.evidence, "    ")]
    return lines


def _table(number: int) -> list[str]:
    columns = staged.COLUMNS_1[1:] if number == 1 else staged.COLUMNS_2  # the category is apart
    rows: dict[str, list[str]] = {}
    categories: dict[str, list[str]] = {}
    for cell in staged.cells():
        if cell.table != number:
            continue
        if cell.column == "category":
            categories.setdefault(cell.emended, []).append(cell.row)
        else:
            text = f"{cell.emended or 'lost'}{'*' if cell.remark else ' '}"
            rows.setdefault(cell.row, [cell.row]).append(text)
    units = {
        1: "m slug, I ft-lb-s², d ft, angles degrees, velocities ft/s, Omega (final) rad/s",
        2: "loss percent, dV ft/s; mu is the signed P_t/P_n",
    }
    return [
        f"Table {number}, emended ({units[number]})",
        "",
        *table(rows.values(), ["no.", *(f"{c} " for c in columns)]),
        "",
        *(f"{category}: {' '.join(numbers)}" for category, numbers in categories.items()),
        "* emended, moved, lost or doubtful: see --cells",
    ]


def _everything() -> dict[str, Any]:
    return {
        "units": {"length": "ft", "time": "s", "mass": "slug", "angles": "degree"},
        "cells": [asdict(cell) for cell in staged.cells()],
        "collisions": [{**asdict(c), "forward": staged.forward(c)} for c in staged.collisions()],
        "comparison": [asdict(c) for c in staged.comparison()],
        "validation": [check._asdict() for check in validation.checks()],
    }
