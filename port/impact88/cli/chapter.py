"""impact88 chapter example                       Section VII, step by step
impact88 chapter colinear --set MA=155 --set MB=99 --set E=.07 --set UN=-57 --set VN=0
impact88 chapter delta-v crash.toml
impact88 chapter staged --table 2              typical E, EM and MU

colinear   vehicles that do not turn: MA MB E, velocities along n before (UN VN) or after (VAN VBN);
           with sliding MUP (the signed P_t/P_n) and UT VT or VAT VBT along t (Equations 9 to 12)
delta-v    Equation 19: MA MB, speeds SA SB and the loss (LOSS in percent, or EL as energy) give
           DVA DVB
staged     Table 2 of the eleven staged collisions beside its recomputation
example    the reconstruction of Section VII beside the printed numbers

exit status: 0 done; 1 a printed number that nothing explains, or an impact that physics forbids;
2 bad input"""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import Any

from ..cases.case import Case
from ..errors import UserError
from ..report.answers import Answer, forward_answer
from .answers import show_answer
from .options import CASE, JSON, OUTPUT, Args, case_of, choice, flag, option
from .output import show

EQUATION_19 = (
    "Equation 19 with the factor 2/3 (it is not printed, but Table 2 has it)",
    "an estimate: rms 3.8, largest 8.2 ft/s over the 22 velocity changes of Table 2; untested "
    "elsewhere (Section VI)",
)


Values = Mapping[str, Any]
"""Values in base units by name."""


def _colinear(case: Case, values: Values) -> Answer:
    """Return the impact of vehicles that do not turn, forward or backward."""
    from ..chapter.colinear import FINAL, INITIAL, colinear, colinear_inverse

    if ("UN" in values) == ("VAN" in values):
        raise UserError("expected the velocities before (UN VN) or those after (VAN VBN)")
    solve, names = (colinear, INITIAL) if "UN" in values else (colinear_inverse, FINAL)
    if "MUP" not in values:  # nothing acts along t
        values = {**dict.fromkeys(("MUP", *names[1::2]), 0.0), **values}
    results = {name: float(x) for name, x in solve(values).items() if isfinite(x)}
    bits = int(results.pop("STATUS"))
    return forward_answer(case, "a colinear impact, Equations 9 to 12", results, bits)


def _delta_v(case: Case, values: Values) -> Answer:
    """Return the velocity changes that follow from a loss of energy, by Equation 19."""
    from ..chapter.deltav import delta_v, loss_of_energy

    loss = values["LOSS"] if "LOSS" in values else loss_of_energy(values)
    if not 0 <= loss <= 100:
        raise UserError(f"a loss of {loss:.4g} percent; expected 0 to 100")
    changes = delta_v({**values, "LOSS": loss})
    results = {name: float(x) for name, x in {"LOSS": loss, **changes}.items()}
    return forward_answer(
        case, "velocity changes from the energy lost", results, remarks=EQUATION_19
    )


def _collision_tables(args: Args) -> bool:
    """Print tables of the staged collisions, and return whether a number is not explained."""
    from ..chapter import staged, validation, words

    cells = staged.comparison()
    record = {
        "problem": "staged",
        "emendations": staged.emendations(),
        "collisions": staged.collisions(),
        "comparison": cells,
        "validation": [check._asdict() for check in validation.checks()],
    }
    lines = words.validation_lines() if args.validation else words.comparison_lines()
    show(args, "chapter", record, words.table_lines(int(args.table)) if args.table else lines)
    return any(cell.explanation == "not explained" for cell in cells)


def _example(args: Args) -> bool:
    """Print the example of Section VII, and return whether a number disagrees."""
    from ..chapter.example import steps
    from ..chapter.words import example_lines

    show(args, "chapter", {"problem": "example", "steps": steps()}, example_lines())
    return any(number.agrees is False for step in steps() for number in step.numbers)


IMPACTS = {"colinear": _colinear, "delta-v": _delta_v}
"""Problems that are posed by a case."""
TABLES = {"staged": _collision_tables, "example": _example}
OPTIONS = (
    option("problem", choices=(*IMPACTS, *TABLES), help="the problem, see above"),
    *CASE,
    choice("--table", ("1", "2"), "staged: a table as emended"),
    flag("--validation", "staged: crash tests published since, recomputed"),
    JSON,
    OUTPUT,
)


def main(args: Args) -> bool:
    """Solve a problem of the chapter."""
    if args.problem in TABLES:
        return TABLES[args.problem](args)
    case = case_of(args)
    values = {name: amount.value for name, amount in case.entries.items()}
    return show_answer(IMPACTS[args.problem](case, values), args)
