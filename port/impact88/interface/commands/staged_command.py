"""Tables 1 and 2 of the chapter: eleven staged, instrumented collisions. Without options: Table 2
cell by cell beside its recomputation, the differences explained. Units: ft, s, slug.

  --fit       e, e_m and mu by least squares beside Table 2's
  --cells     each cell that is not as printed or is doubtful, with the evidence
  --measured  energy and momentum of the measured velocities, nothing fitted
  --claims    what the text says of its method, checked on the collisions
  --table N   table 1 or 2 itself, emended
  --validation  25 crash tests published since, beside what is computed for them

FILE.toml is another staged collision, with the listing's names: vehicles and geometry, the
velocities before (UX UY WA VX VY WB) and after (VAX VAY WAF VBX VBY WBF), with or without units.
Its e, e_m and mu are fitted as Section V's are; --spin-weight says what a squared spin counts
against a squared velocity (25 ft² for the chapter's; by default the square of the radius of
gyration). impact88 reconstruct fits the same with a tolerance for each velocity.

examples:
  impact88 chapter staged
  impact88 chapter staged mine.toml
  impact88 chapter staged --fit
  impact88 chapter staged --cells
  impact88 chapter staged --table 1
  impact88 chapter staged --json          all of it, for a program

exit status: 0 done; 1 a cell of Table 2 differs and nothing explains it
"""

from collections.abc import Callable, Sequence
from dataclasses import asdict
from math import isfinite, sqrt
from typing import Any

from ...casework.chapter import staged, validation
from ...casework.reconstruction.unknowns import check_physical
from ...collision.geometry import GEOMETRY, Geometry, within_doubles
from ...collision.units import base_of
from ...errors import BEYOND_DOUBLES, UserError
from ...messages.plaintable import format_fixed, paragraph, table
from ...names import FINAL_STATE, VELOCITIES, missing
from . import options

ARGUMENTS = (
    *options.KNOWN,
    options.value("--spin-weight", "W", "weight of a squared spin (with FILE.toml)", type=float),
    [
        options.flag("--fit", "least-squares fits beside Table 2"),
        options.flag("--cells", "emended and doubtful cells, evidence"),
        options.flag("--measured", "energy and momentum as measured, beside Table 2"),
        options.flag("--claims", "the chapter's claims, checked"),
        options.flag("--validation", "crash tests published since, recomputed"),
        options.choice("--table", (1, 2), "print a table, emended", type=int),
    ],
    options.JSON,
    options.OUTPUT,
)


def main(args: options.Args) -> int:
    views: dict[str, Callable[[], list[str]]] = {
        "fit": _fits,
        "measured": _measured_lines,
        "claims": _claims,
        "cells": _cells,
        "validation": _validation,
        "table": lambda: _table(args.table),
    }
    view = next((name for name in views if getattr(args, name)), None)
    if args.scene is not None or args.set:
        if view:
            raise UserError(f"--{view} shows the chapter's collisions; expected no file beside it")
        return _fit_own(args)
    if args.spin_weight is not None:
        raise UserError("--spin-weight is for a collision in a file; expected FILE.toml")
    options.show(args, "staged", _everything, views[view] if view else _comparison)
    return int(any(not c.agrees and c.explanation == "not explained" for c in staged.comparison()))


def _fit_own(args: options.Args) -> int:
    """Fit the collision of a file."""
    if args.spin_weight is not None and not 0 <= args.spin_weight < float("inf"):
        raise UserError(f"--spin-weight {args.spin_weight:g}: expected a number, 0 or more")
    names = (*GEOMETRY, *VELOCITIES, *FINAL_STATE)
    values, units = options.known_values(args, names)
    if absent := [name for name in names if name not in values]:
        raise UserError(missing(absent), args.scene)
    try:
        record, lines = within_doubles(_fit_collision)(values, args.spin_weight, base_of(units))
    except UserError as error:
        raise UserError(str(error), args.scene) from None
    options.show(args, "staged", lambda: record, lambda: lines)
    return 0


def _fit_collision(
    known: dict[str, float], weight: float | None, units: str
) -> tuple[dict[str, Any], list[str]]:
    """The fit of one collision, as JSON and as lines."""
    check_physical(known)
    scene = {name: value for name, value in known.items() if name not in FINAL_STATE}
    here = Geometry(scene)
    if not here.relative([scene[name] for name in VELOCITIES])[0]:
        raise UserError("the contact points do not approach one another; no e can be fitted")
    if weight is None:
        weight = float(here.inverse_mass / here.inverse_spin_inertia)
    collision = staged.Collision(0, "own", scene, {name: known[name] for name in FINAL_STATE}, {})
    fit = staged.fit(collision, spin_weight=weight)
    if not isfinite(fit.sum_of_squares):
        raise UserError(BEYOND_DOUBLES)
    low, high = staged.undetermined_range(collision, spin_weight=weight)
    closure = staged.closure(collision)
    record = {
        "fit": asdict(fit),
        "closure": closure,
        "spin_weight": weight,
        "em_range": (low, high),
        "base_units": units,
    }
    rows = [
        ["E", format_fixed(fit.E, 4), "e" + (", at its bound" if "E" in fit.at_bound else "")],
        ["MUP", format_fixed(fit.MUP, 4), "mu, signed P_t/P_n"],
        ["EM", format_fixed(fit.EM, 4), f"e_m; about as good: {low:.2f} ... {high:.2f}"],
    ]
    text = (
        f"Least squares over the six velocities after, a squared spin weighing {weight:.4g}: sum "
        f"of squares {fit.sum_of_squares:.4g}. 0 <= e <= 1, -1 <= e_m <= 0. Squares and "
        f"momentum in base units: {units}."
    )
    return record, [*table(rows, left=(0, 2)), "", *paragraph(text), "", *_closures([closure])]


def _measured_lines() -> list[str]:
    losses = {c.number: float(staged.forward(c)["LOSS"]) for c in staged.collisions()}
    return [
        "Energy and momentum of the measured velocities (Table 1), nothing fitted",
        "",
        *_closures([staged.closure(c) for c in staged.collisions()], losses),
        "",
        *paragraph(
            "Momentum: what A gains and what B loses, equal where the measured velocities "
            "conserve it; M: the moment impulse that either vehicle's spin calls for about "
            "the contact point. Their differences are the measurement's."
        ),
    ]


def _claims() -> list[str]:
    def extent(values: tuple[float, float]) -> str:
        return f"{values[0] + 0.0:.1f} ... {values[1]:.1f}"

    lines = ["What the chapter says of its method, on the eleven staged collisions", ""]
    for claim in staged.claims():
        lines += paragraph(f"Section {claim.where}: {claim.claim}: {claim.verdict}")
        rows = [[claim.varied, extent(claim.sides), extent(claim.others), claim.unit]]
        lines += ["", *table(rows, ["  varied", "front to side", "others", ""], left=(0, 3)), ""]
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


def _closures(
    closures: Sequence[dict[str, float]], calculated: dict[int, float] | None = None
) -> list[str]:
    rows = []
    for number, loss, *changes in (closure.values() for closure in closures):
        row = [format_fixed(loss, 1)]
        if calculated:
            row = [str(number), row[0] or "lost", format_fixed(calculated[int(number)], 1)]
        rows.append([*row, *(format_fixed(x, 0) or "lost" for x in changes)])
    heading = ["no.", "loss %, measured", "calculated"] if calculated else ["loss %, measured"]
    sides = [f"{axis}, {vehicle}" for axis in ("x", "y", "M") for vehicle in "AB"]
    return table(rows, [*heading, *sides], left=())


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


def _fits() -> list[str]:
    rows, sums, errors = [], [], []
    rows_by_label = [(str(c.number), c) for c in staged.collisions()]
    rows_by_label.append(("8*", staged.with_8a_reconstructed()))
    for label, collision in rows_by_label:
        table2 = collision.table2
        held_fit, free_fit = staged.fit(collision, table2["em"]), staged.fit(collision)
        low, high = staged.undetermined_range(collision)
        if collision.number != 8:
            errors.append((held_fit.E - table2["e"], held_fit.MUP - table2["mu"]))
        values = (table2["e"], table2["em"], table2["mu"], held_fit.E, held_fit.MUP)
        cells = [
            format_fixed(value, 3) for value in (*values, free_fit.E, free_fit.EM, free_fit.MUP)
        ]
        rows.append([label, *cells, " ".join(free_fit.at_bound), f"{low:.2f} ... {high:.2f}"])
        sums.append(
            [label, *(format_fixed(f.sum_of_squares, 1) for f in staged.profile(collision))]
        )
    heading = ["no.", "e", "e_m", "mu", "e", "mu", "e", "e_m", "mu", "at bound", "e_m +0.1 ft/s"]
    rms_e, rms_mu = (sqrt(sum(x * x for x in xs) / len(xs)) for xs in zip(*errors, strict=True))
    return [
        "Least squares: e, e_m, mu from the measured velocities, beside Table 2's",
        "",
        "     Table 2                e_m held      all free",
        *table(rows, heading, left=(0, 9)),
        "",
        *paragraph(
            "Minimised: sum of (V - measured)² + 25 ft² (Omega - measured)² over both vehicles; "
            "0 <= e <= 1, -1 <= e_m <= 0, mu free. The chapter does not state its weights; 25 ft² "
            "comes closest. e_m +0.1 ft/s: the e_m whose best fit is worse by no more than 0.1 "
            "ft/s root mean square."
        ),
        *paragraph(
            f"With e_m held at Table 2's value, the fits differ from Table 2 by {rms_e:.4f} in e "
            f"and {rms_mu:.4f} in mu (root mean square, without 8): what the unstated weights and "
            "bounds (here e stops at 0 where Table 2 has .003 to .008) and the rounded velocities "
            "leave."
        ),
        *paragraph(
            "8: V of vehicle A is lost and left out of the sum. 8*: with -10.2/10.6 put in its "
            "place, a reconstruction from Table 2 itself, not data."
        ),
        "",
        "Smallest sum of squares (ft²/s²) with e_m held at",
        *table(sums, ["no.", *(f"{x / 10 - 1:.1f}" for x in range(11))]),
    ]


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
    def fits(collision: staged.Collision) -> dict[str, Any]:
        return {
            "em_held": asdict(staged.fit(collision, collision.table2["em"])),
            "all_free": asdict(staged.fit(collision)),
            "profile_in_em": [asdict(f) for f in staged.profile(collision, 21)],
            "em_within_0.1_ft_per_s": staged.undetermined_range(collision),
        }

    return {
        "units": {"length": "ft", "time": "s", "mass": "slug", "angles": "degree"},
        "spin_weight_ft2": staged.SPIN_WEIGHT,
        "cells": [asdict(cell) for cell in staged.cells()],
        "collisions": [
            {**asdict(c), "forward": staged.forward(c), "fit": fits(c)} for c in staged.collisions()
        ],
        "fit_of_8_with_reconstructed_velocity_of_A": fits(staged.with_8a_reconstructed()),
        "comparison": [asdict(c) for c in staged.comparison()],
        "validation": [check._asdict() for check in validation.checks()],
    }
