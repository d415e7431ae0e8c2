"""Tables 1 and 2 of the chapter: eleven staged, instrumented collisions. Without options: Table 2
cell by cell beside its recomputation, the differences explained. Units: ft, s, slug.

  --fit       e, e_m and mu by least squares beside Table 2's
  --cells     each cell that is not as printed or is doubtful, with the evidence
  --measured  energy and momentum of the measured velocities, nothing fitted
  --claims    what the text says of its method, checked on the collisions
  --table N   table 1 or 2 itself, emended

FILE.toml is another staged collision, with the listing's names: vehicles and geometry, the
velocities before (UX UY WA VX VY WB) and after (VAX VAY WAF VBX VBY WBF), any consistent units. Its
e, e_m and mu are fitted as Section V's are; --spin-weight says what a squared spin counts against a
squared velocity (25 ft² for the chapter's; by default the square of the radius of gyration).
impact88 reconstruct fits the same with a tolerance for each velocity.

examples:
  impact88 chapter staged
  impact88 chapter staged mine.toml
  impact88 chapter staged --fit
  impact88 chapter staged --cells
  impact88 chapter staged --table 1
  impact88 chapter staged --json          all of it, for a program

exit status: 0 done; 1 a cell of Table 2 differs and nothing explains it
"""

from __future__ import annotations

import argparse
import json
from math import isfinite, sqrt
from typing import Any

from ..errors import BEYOND_DOUBLES, UserError
from ..names import FINAL_STATE, VELOCITIES, missing
from ..schemas import stamped
from .options import InputFile, add_json_argument, add_output_argument, known_values


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `impact88 chapter staged`."""
    parser.add_argument(
        "file", nargs="?", type=InputFile, metavar="FILE.toml", help="another collision"
    )
    parser.add_argument(
        "--spin-weight", type=float, metavar="W", help="weight of a squared spin (own collision)"
    )
    views = parser.add_mutually_exclusive_group()
    views.add_argument("--fit", action="store_true", help="least-squares fits beside Table 2")
    views.add_argument("--cells", action="store_true", help="emended and doubtful cells, evidence")
    views.add_argument(
        "--measured", action="store_true", help="energy and momentum as measured, beside Table 2"
    )
    views.add_argument("--claims", action="store_true", help="the chapter's claims, checked")
    views.add_argument("--table", type=int, choices=(1, 2), help="print a table, emended")
    add_json_argument(parser, "everything as one JSON object")
    add_output_argument(parser)


def main(args: argparse.Namespace) -> int:
    """Print the view asked for."""
    from ..chapter.staged import comparison

    if args.file is not None:
        return _own(args)
    if args.spin_weight is not None:
        raise UserError("--spin-weight is for a collision of one's own; expected FILE.toml")
    unexplained = [c for c in comparison() if not c.agrees and c.explanation == "not explained"]
    if args.json:
        from ..plaintable import plain

        print(json.dumps(stamped("staged", plain(_everything())), allow_nan=False))
    elif args.fit:
        print(_fits())
    elif args.measured:
        print(_measured())
    elif args.claims:
        print(_claims())
    elif args.cells:
        print(_cells())
    elif args.table:
        print(_table(args.table))
    else:
        print(_comparison())
    return 1 if unexplained else 0


def _own(args: argparse.Namespace) -> int:
    """Fit a collision of the user's."""
    from ..reconstruction.doublerange import within_doubles
    from ..reconstruction.geometry import NAMES

    if args.fit or args.cells or args.measured or args.claims or args.table:
        raise UserError("a collision of one's own is fitted; --fit and the like are the chapter's")
    if args.spin_weight is not None and not 0 <= args.spin_weight < float("inf"):
        raise UserError(f"--spin-weight {args.spin_weight:g}: expected a number from 0 on")
    known, _ = known_values(args.file, [], (*NAMES, *VELOCITIES, *FINAL_STATE))
    absent = [n for n in (*NAMES, *VELOCITIES, *FINAL_STATE) if n not in known]
    if absent:
        raise UserError(missing(absent), args.file)
    try:
        return within_doubles(_fitted)(known, args.spin_weight, args.json)
    except UserError as error:
        raise UserError(str(error), args.file) from None


def _fitted(known: dict[str, float], weight: float | None, as_json: bool) -> int:
    from dataclasses import asdict

    import numpy as np

    from ..chapter.staged import Collision, closure, fit, undetermined_range
    from ..plaintable import fixed, paragraph, plain, table
    from ..reconstruction.geometry import Geometry
    from ..reconstruction.unknowns import check_physical

    check_physical({name: np.asarray(value) for name, value in known.items()})
    scene = {name: value for name, value in known.items() if name not in FINAL_STATE}
    measured = {name: known[name] for name in FINAL_STATE}
    here = Geometry.of(scene)
    if not here.relative([scene[name] for name in VELOCITIES])[0]:
        raise UserError("the contact points do not approach one another; no e can be fitted")
    if weight is None:
        weight = float(here.inverse_mass / here.inverse_spin_inertia)
    own = Collision(0, "own", scene, measured, {})
    found = fit(own, spin_weight=weight)
    if not isfinite(found.sum_of_squares):
        raise UserError(BEYOND_DOUBLES)
    low_high = undetermined_range(own, spin_weight=weight)
    as_measured = closure(own)
    if as_json:
        whole: dict[str, Any] = {
            "fit": asdict(found),
            "closure": asdict(as_measured),
            "spin_weight": weight,
        }
        print(
            json.dumps(stamped("staged", plain({**whole, "em_range": low_high})), allow_nan=False)
        )
        return 0
    rows = [
        ["E", fixed(found.E, 4), "e" + (", at its bound" if "E" in found.at_bound else "")],
        ["MUP", fixed(found.MUP, 4), "mu, signed P_t/P_n"],
        ["EM", fixed(found.EM, 4), f"e_m; about as good: {low_high[0]:.2f} ... {low_high[1]:.2f}"],
    ]
    print("\n".join(table(rows, left=(0, 2))))
    text = (
        f"Least squares over the six velocities after, a squared spin weighing {weight:.4g}: sum "
        f"of squares {found.sum_of_squares:.4g}. 0 <= e <= 1, -1 <= e_m <= 0."
    )
    print("\n".join(["", *paragraph(text), "", *_closures([as_measured])]))
    return 0


def _measured() -> str:
    from ..chapter.staged import closure, collisions, forward
    from ..plaintable import paragraph

    calculated = {c.number: float(forward(c)["LOSS"]) for c in collisions()}
    lines = ["Energy and momentum of the measured velocities (Table 1), nothing fitted", ""]
    lines += _closures([closure(c) for c in collisions()], calculated)
    return "\n".join(
        [
            *lines,
            "",
            *paragraph(
                "Momentum: what A gains and what B loses, equal where the measured velocities "
                "conserve it; M: the moment impulse that either vehicle's spin calls for about "
                "the contact point. Their differences are the measurement's."
            ),
        ]
    )


def _claims() -> str:
    from ..chapter.claims import claims
    from ..plaintable import paragraph, table

    def extent(values: tuple[float, float]) -> str:
        return f"{values[0] + 0.0:.1f} ... {values[1]:.1f}"

    lines = ["What the chapter says of its method, on the eleven staged collisions", ""]
    for claim in claims():
        lines += paragraph(f"Section {claim.where}: {claim.claim}: {claim.verdict}")
        rows = [[claim.varied, extent(claim.sides), extent(claim.others), claim.unit]]
        lines += ["", *table(rows, ["  varied", "front to side", "others", ""], left=(0, 3)), ""]
    return "\n".join(lines[:-1])


def _closures(closures: list[Any], calculated: dict[int, float] | None = None) -> list[str]:
    from ..plaintable import fixed, table

    rows = []
    for c in closures:
        pairs = ((c.x_of_a, c.x_of_b), (c.y_of_a, c.y_of_b), (c.spin_of_a, c.spin_of_b))
        row = [str(c.number)] if calculated else []
        row.append(fixed(c.loss, 1) or "lost")
        if calculated:
            row.append(fixed(calculated[c.number], 1))
        rows.append([*row, *(fixed(x, 0) or "lost" for pair in pairs for x in pair)])
    heading = ["no.", "loss %, measured", "calculated"] if calculated else ["loss %, measured"]
    sides = [f"{what}, {vehicle}" for what in ("x", "y", "M") for vehicle in "AB"]
    return table(rows, [*heading, *sides], left=())


def _comparison() -> str:
    from ..chapter.staged import COLUMNS_2, collisions, comparison
    from ..plaintable import fixed, paragraph, table

    columns = [c for c in COLUMNS_2 if c not in ("e", "em", "mu")]
    by_place = {(c.collision, c.column): c for c in comparison()}
    rows: list[list[str]] = []
    remarks = []
    for collision in collisions():
        row = [str(collision.number)]
        for column in columns:
            cell = by_place[collision.number, column]
            mark = " " if cell.agrees else "!"
            row.append(f"{cell.printed:.1f} {fixed(cell.value, 2) or 'lost':>5}{mark}")
            if not cell.agrees:
                remarks.append((cell, f"{collision.number}, {column}: {cell.explanation}"))
        rows.append(row)
    heading = ["no.", *(f"{column} " for column in columns)]
    lines = [
        "Table 2 beside its recomputation: printed value, recomputed value (! differs).",
        "loss in percent; velocity changes dV of vehicles a and b in ft/s:",
        "exp from Table 1's velocities; comp from Equations 13-18 with Table 2's e, e_m, mu;",
        "pred by Equation 19 with the factor 2/3 (not printed, but all of Table 2 has it).",
        "",
        *table(rows, heading),
        "",
    ]
    agree = sum(cell.agrees for cell in by_place.values())
    lines.append(
        f"{agree} of {len(by_place)} agree within what the rounding of the printed numbers allows."
    )
    for _, remark in remarks:
        lines += paragraph(f"! {remark}")
    return "\n".join(lines)


def _fits() -> str:
    from ..chapter.staged import collisions, fit, profile, undetermined_range, with_8a_reconstructed
    from ..plaintable import fixed, paragraph, table

    rows: list[list[str]] = []
    sums = []
    errors = []
    for collision in (*collisions(), with_8a_reconstructed()):
        label = str(collision.number)
        if len(rows) == len(collisions()):
            label = "8*"
        held, free = fit(collision, collision.table2["em"]), fit(collision)
        low, high = undetermined_range(collision)
        printed = collision.table2
        if collision.number != 8:
            errors.append((held.E - printed["e"], held.MUP - printed["mu"]))
        rows.append(
            [
                label,
                *(fixed(printed[name], 3) for name in ("e", "em", "mu")),
                *(fixed(value, 3) for value in (held.E, held.MUP, free.E, free.EM, free.MUP)),
                " ".join(free.at_bound),
                f"{low:.2f} ... {high:.2f}",
            ]
        )
        sums.append([label, *(fixed(f.sum_of_squares, 1) for f in profile(collision))])
    heading = ["no.", "e", "e_m", "mu", "e", "mu", "e", "e_m", "mu", "at bound", "e_m +0.1 ft/s"]
    over = "     Table 2                e_m held      all free"
    rms_e, rms_mu = (sqrt(sum(x * x for x in xs) / len(xs)) for xs in zip(*errors, strict=True))
    ems = [f"{x / 10 - 1:.1f}" for x in range(11)]
    lines = [
        "Least squares: e, e_m, mu from the measured velocities, beside Table 2's",
        "",
        over,
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
        *table(sums, ["no.", *ems]),
    ]
    return "\n".join(lines)


def _cells() -> str:
    from ..chapter.staged import emendations
    from ..plaintable import paragraph

    lines = ["What is emended, moved, lost or doubtful in Tables 1 and 2 as printed", ""]
    for e in emendations():
        where = f"Table {e.table}, {e.row}, {'the row' if e.column == '*' else e.column}"
        change = e.printed if e.printed == e.emended else f"{e.printed or 'blank'} -> {e.emended}"
        if e.kind == "lost" and not e.emended:
            change = "no value"
        lines.append(f"{where}: {e.kind}: {change}")
        lines += paragraph(e.evidence, "    ")
    return "\n".join(lines)


def _table(number: int) -> str:
    from ..chapter.staged import COLUMNS_1, COLUMNS_2, cells
    from ..plaintable import table

    columns = [c for c in (COLUMNS_1 if number == 1 else COLUMNS_2) if c != "category"]
    rows: dict[str, list[str]] = {}
    categories: dict[str, list[str]] = {}
    for cell in cells():
        if cell.table != number:
            continue
        text = f"{cell.emended or 'lost'}{'*' if cell.remark else ' '}"
        if cell.column == "category":
            categories.setdefault(cell.emended, []).append(cell.row)
        else:
            rows.setdefault(cell.row, [cell.row]).append(text)
    units = {
        1: "m slug, I ft-lb-s², d ft, angles degrees, velocities ft/s, Omega (final) rad/s",
        2: "loss percent, dV ft/s; mu is the signed P_t/P_n",
    }
    lines = [f"Table {number}, emended ({units[number]})", ""]
    lines += [*table(rows.values(), ["no.", *(f"{c} " for c in columns)]), ""]
    lines += [f"{category}: {' '.join(numbers)}" for category, numbers in categories.items()]
    return "\n".join([*lines, "* emended, moved, lost or doubtful: see --cells"])


def _everything() -> dict[str, Any]:
    from dataclasses import asdict

    from ..chapter.staged import (
        SPIN_WEIGHT,
        cells,
        collisions,
        comparison,
        fit,
        forward,
        profile,
        undetermined_range,
        with_8a_reconstructed,
    )

    def fits(collision: Any) -> dict[str, Any]:
        return {
            "em_held": asdict(fit(collision, collision.table2["em"])),
            "all_free": asdict(fit(collision)),
            "profile_in_em": [asdict(f) for f in profile(collision, 21)],
            "em_within_0.1_ft_per_s": undetermined_range(collision),
        }

    return {
        "units": {"length": "ft", "time": "s", "mass": "slug", "angles": "degree"},
        "spin_weight_ft2": SPIN_WEIGHT,
        "cells": [asdict(cell) for cell in cells()],
        "collisions": [
            {
                "number": c.number,
                "category": c.category,
                "scene": c.scene,
                "measured": c.measured,
                "table2": c.table2,
                "forward": forward(c),
                "fit": fits(c),
            }
            for c in collisions()
        ],
        "fit_of_8_with_reconstructed_velocity_of_A": fits(with_8a_reconstructed()),
        "comparison": [asdict(c) for c in comparison()],
    }
