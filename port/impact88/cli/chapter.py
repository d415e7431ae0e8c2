"""impact88 chapter example                       Section VII, step by step
impact88 chapter colinear --set MA=155 --set MB=99 --set E=.07 --set UN=-57 --set VN=0
impact88 chapter barrier car.toml
impact88 chapter delta-v crash.toml --like 90-side
impact88 chapter staged --table 2              typical E, EM and MU

colinear   vehicles that do not turn: MA MB E, velocities along n before (UN VN) or after (VAN VBN);
           with sliding MUP (the signed P_t/P_n) and UT VT or VAT VBT along t (Equations 9 to 12)
barrier    vehicle A against a rigid barrier: DA PA TA MA IA GA E MU EM UX UY WA; a file that leaves
           some of them open, or gives VAX VAY WAF, is reconstructed
delta-v    Equation 19: MA MB, speeds SA SB and the loss (LOSS in percent, DT as a fraction, EL as
           energy, or --like) give DVA DVB; DVA or DVB give the loss
staged     Table 2 of the eleven staged collisions beside its recomputation
example    the reconstruction of Section VII beside the printed numbers

exit status: 0 done; 1 a printed number that nothing explains, or an impact that physics forbids;
2 bad input"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

from .. import status
from ..cases.case import Case
from ..errors import UserError
from ..layout import paragraph
from ..report.answers import ask, numbers_of
from . import options
from .answers import answer_lines, number_lines
from .output import print_json

CATEGORIES = {
    "60-side": "60° FRONT TO SIDE",
    "90-side": "90° FRONT TO SIDE",
    "front": "10° FRONT TO FRONT",
    "rear": "10° FRONT TO REAR",
}
"""Words of --like, and the categories of Table 2."""
BEFORE = ("UN", "UT", "VN", "VT")
AFTER = ("VAN", "VAT", "VBN", "VBT")
SPEEDS = {"SA": ("UX", "UY"), "SB": ("VX", "VY")}


def declare(parser: options.Parser) -> None:
    """Add the arguments."""
    parser.add_argument("problem", choices=tuple(PROBLEMS), help="the problem, see above")
    options.add_case(parser)
    view = parser.add_argument_group("delta-v and staged").add_mutually_exclusive_group()
    view.add_argument(
        "--like",
        choices=tuple(CATEGORIES),
        metavar="KIND",
        help=f"losses like {', '.join(CATEGORIES)}",
    )
    view.add_argument("--table", type=int, choices=(1, 2), help="a table as emended")
    view.add_argument("--cells", action="store_true", help="cells that were emended, with evidence")
    view.add_argument(
        "--validation", action="store_true", help="crash tests published since, recomputed"
    )
    parser.add_argument(
        "--as-printed", action="store_true", help="Equation 19 without the factor 2/3"
    )
    options.add_json(parser)
    options.add_output(parser)


def main(args: options.Args) -> int:
    """Solve a problem of the chapter."""
    return PROBLEMS[args.problem](args)


def _known(args: options.Args) -> tuple[Case, dict[str, float]]:
    """Return the case, and its values in base units."""
    case = options.case_of(args)
    return case, {name: amount.value for name, amount in case.entries.items()}


def _show(args: options.Args, case: Case, rows: list[dict[str, float]], remarks: list[str]) -> int:
    """Print results in the units of the case; each of ``rows`` is a set of them."""
    found = [numbers_of(case, row, {}, {}) for row in rows]
    if args.json:
        results = [[asdict(number) for number in row.values()] for row in found]
        print_json("chapter", {"problem": args.problem, "results": results, "remarks": remarks})
        return 0
    for row in found:
        print("\n".join([*number_lines(row.values()), ""]))
    print("\n".join(line for remark in remarks for line in paragraph(remark, "-", 2)))
    return 0


def _colinear(args: options.Args) -> int:
    from ..chapter.colinear import colinear, colinear_inverse

    case, known = _known(args)
    known.pop("M", None)
    before, after = ([n for n in names if n in known] for names in (BEFORE, AFTER))
    if bool(before) == bool(after):
        raise UserError(
            "expected the velocities before (UN VN) or those after (VAN VBN)", case.source
        )
    if "MUP" not in known:  # nothing acts along t
        known |= dict.fromkeys(("MUP", *(AFTER if after else BEFORE)[1::2]), 0.0) | known
    try:
        results = (colinear_inverse if after else colinear)(known)
    except UserError as error:
        raise UserError(str(error), case.source) from None
    values = {name: float(value) for name, value in results.items()}
    bits = int(values.pop("STATUS"))
    _show(args, case, [_finite(values)], [*case.remarks, *status.sentences(bits)])
    return int(bool(bits & status.IMPOSSIBLE))


def _finite(values: Mapping[str, float]) -> dict[str, float]:
    return {name: value for name, value in values.items() if math.isfinite(value)}


def _barrier(args: options.Args) -> int:
    from ..chapter.barrier import BARRIER

    case = options.case_of(args)
    wall = {"MB": "inf", "IB": "inf", "VX": "0", "VY": "0", "WB": "0"}
    wall |= {name: "0" for name in BARRIER if name not in wall}
    answer = ask(case.with_(wall, "barrier"))
    if args.json:
        print_json("answer", answer.as_json())
    else:
        print("\n".join(answer_lines(answer)))
    return int(not answer.possible)


def _delta_v(args: options.Args) -> int:
    from ..chapter import deltav

    case, known = _known(args)
    factor = deltav.AS_PRINTED if args.as_printed else deltav.AS_USED
    for speed, parts in SPEEDS.items():
        if speed not in known and {*parts} <= {*known}:
            known[speed] = math.hypot(*(known[name] for name in parts))
    remarks = [*case.remarks, deltav.describe(factor), DELTA_V_ERROR]
    try:
        losses, source = _losses(args, known, factor)
        rows = [
            {"LOSS": loss} | {n: float(x) for n, x in changes.items()}
            for loss in losses
            for changes in [deltav.delta_v({**known, "LOSS": loss}, factor)]
        ]
    except UserError as error:
        raise UserError(str(error), case.source) from None
    return _show(args, case, rows, [f"loss: {source}", *remarks])


DELTA_V_ERROR = (
    "an estimate: rms 3.8, largest 8.2 ft/s over the 22 velocity changes of Table 2; untested "
    "elsewhere (Section VI)"
)


def _losses(
    args: options.Args, known: Mapping[str, float], factor: float
) -> tuple[list[float], str]:
    """Return losses in percent, and where they come from."""
    from ..chapter import deltav, staged

    names = [name for name in ("LOSS", "DT", "EL", "DVA", "DVB") if name in known]
    if len(names) + bool(args.like) != 1:
        raise UserError("expected one of LOSS, DT, EL, DVA, DVB and --like")
    if args.like:
        category = CATEGORIES[args.like]
        alike = [c for c in staged.collisions() if c.category == category]
        losses = sorted(c.table2["loss"] for c in alike)
        numbers = ", ".join(str(c.number) for c in alike)
        return [losses[0], losses[-1]], f"Table 2, {category} (collisions {numbers})"
    name = names[0]
    value = known[name]
    if name == "EL":
        loss = deltav.loss_of_energy(known)
    elif name in ("DVA", "DVB"):
        loss = deltav.loss_of_change({**known, name: value}, factor)
    else:
        loss = value * (100.0 if name == "DT" else 1.0)
    if not 0 <= loss <= 100:
        raise UserError(f"{name} is a loss of {loss:.4g} percent; expected 0 to 100")
    return [loss], name


def _staged(args: options.Args) -> int:
    from ..chapter import staged, validation, words

    compared = staged.comparison()
    if args.json:
        record = {
            "problem": "staged",
            "emendations": [asdict(cell) for cell in staged.emendations()],
            "collisions": [asdict(c) for c in staged.collisions()],
            "comparison": [asdict(cell) for cell in compared],
            "validation": [check._asdict() for check in validation.checks()],
        }
        print_json("chapter", record)
    elif args.validation:
        print("\n".join(words.validation_lines()))
    elif args.cells:
        print("\n".join(words.cell_lines()))
    elif args.table:
        print("\n".join(words.table_lines(args.table)))
    else:
        print("\n".join(words.comparison_lines()))
    return int(any(cell.explanation == "not explained" for cell in compared))


def _example(args: options.Args) -> int:
    from ..chapter.example import steps
    from ..chapter.words import example_lines

    if args.json:
        print_json("chapter", {"problem": "example", "steps": [asdict(step) for step in steps()]})
    else:
        print("\n".join(example_lines()))
    return int(any(number.agrees is False for step in steps() for number in step.numbers))


PROBLEMS: dict[str, Callable[[Any], int]] = {
    "colinear": _colinear,
    "barrier": _barrier,
    "delta-v": _delta_v,
    "staged": _staged,
    "example": _example,
}
"""The problems."""
