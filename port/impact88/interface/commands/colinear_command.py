"""Two vehicles that do not turn, velocities along n (crush) and t (sliding). Given MA MB E MUP and
the velocities before (UN UT of A, VN VT of B), Equations 9-12 give those after; given those after
(VAN VAT VBN VBT), the same equations with 1/E give those before. MUP is the signed P_t/P_n of
Equation 8: no rule chooses its sign here. Without MUP, UT and VT (VAT and VBT) the motion is along
one line, and nothing acts across it; which way n points does not matter. Units: any consistent set.

examples:
  impact88 chapter colinear --template -o rear-end.toml    a file to fill in
  impact88 chapter colinear rear-end.toml --contact-time .12
  impact88 chapter colinear rear-end.toml --json

exit status: 0 solved; 2 bad input, or E = 0 in the inverse problem
"""

import math
from collections.abc import Iterator

from ...casework.chapter.colinear import colinear, colinear_inverse
from ...collision.units import display_values
from ...errors import UserError
from ...mechanics.friction import status_sentences
from ...mechanics.outcome import forces
from ...messages.plaintable import decimals_for, format_fixed, paragraph, quantities, table
from ...names import quantity
from . import options

COMMON = ("MA", "MB", "E", "MUP")
BEFORE = ("UN", "UT", "VN", "VT")
AFTER = ("VAN", "VAT", "VBN", "VBT")
KNOWABLE = (*COMMON, *BEFORE, *AFTER)

ARGUMENTS = options.SOLUTION


def main(args: options.Args) -> None:
    numbers, system = options.known_values(args, KNOWABLE)
    before, after = ([n for n in names if n in numbers] for names in (BEFORE, AFTER))
    if before and after:
        raise UserError(
            f"velocities before ({' '.join(before)}) and after ({' '.join(after)}) are both given; "
            "expected the four before or the four after",
            args.scene,
        )
    along = [name for name in ("MUP", "UT", "VT", "VAT", "VBT") if name in numbers]
    if not along:  # motion along one line: nothing acts across it
        numbers |= dict.fromkeys(("MUP", *(("VAT", "VBT") if after else ("UT", "VT"))), 0.0)
    missing = [name for name in (*COMMON, *(AFTER if after else BEFORE)) if name not in numbers]
    if missing:
        raise UserError(f"missing {' '.join(missing)}", args.scene)
    for name in ("MA", "MB"):
        if not numbers[name] > 0:
            raise UserError(f"{name} is not positive; expected a mass", args.scene)
    solve = colinear_inverse if after else colinear
    values = {name: float(value) for name, value in solve(numbers).items()}
    values = {"MA": numbers["MA"], "MB": numbers["MB"], "E": numbers["E"], **values}
    if args.contact_time is not None:
        values["P"] = math.hypot(values["PN"], values["PT"])
        values["TF"] = args.contact_time
        values |= {n: float(v) for n, v in forces(values["P"], args.contact_time).items()}
    warnings = status_sentences(int(values.pop("STATUS")), values)
    values = display_values(values, system)
    solved_for = BEFORE if after else AFTER
    units = {name: system.label(quantity(name).unit) for name in values}
    record = {"solved_for": solved_for, "values": values, "units": units, "warnings": warnings}

    def lines() -> Iterator[str]:
        decimals = decimals_for([values[name] for name in KNOWABLE[4:]])
        rows = []
        for label, names in (("n", ("UN", "VAN", "VN", "VBN")), ("t", ("UT", "VAT", "VT", "VBT"))):
            cells = [f"{format_fixed(values[n], decimals)}{' *'[n in solved_for]}" for n in names]
            rows.append([label, *cells, units["UN"]])
        heading = ["velocity", "A before ", "A after ", "B before ", "B after ", "unit"]
        yield from (*table(rows, heading, left=(0, 5)), "* solved for", "")
        results = {
            n: v for n, v in values.items() if n not in (*BEFORE, *AFTER) and math.isfinite(v)
        }
        yield from quantities(results, system.label, {"MUP": "signed P_t/P_n, as given"})
        for warning in warnings:
            yield from paragraph(f"! {warning}")

    options.show(args, "colinear", lambda: record, lines)
