"""impact88 chapter example                       Section VII, step by step
impact88 chapter colinear --set MA=155 --set MB=99 --set E=.07 --set UN=-57 --set VN=0
impact88 chapter barrier car.toml
impact88 chapter delta-v crash.toml --like 90-side
impact88 chapter staged --table 2              typical E, EM and MU

colinear   vehicles that do not turn: MA MB E, velocities along n before (UN VN) or after (VAN VBN);
           with sliding MUP (the signed P_t/P_n) and UT VT or VAT VBT along t (Equations 9 to 12)
barrier    vehicle A against a rigid barrier: DA PA TA MA IA GA E MU EM UX UY WA; a file that leaves
           some of them open, or gives VAX VAY WAF, is reconstructed
delta-v    Equation 19: MA MB, speeds SA SB and the loss (LOSS in percent, EL as energy, or --like)
           give DVA DVB
staged     Table 2 of the eleven staged collisions beside its recomputation
example    the reconstruction of Section VII beside the printed numbers

exit status: 0 done; 1 a printed number that nothing explains, or an impact that physics forbids;
2 bad input"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from math import isfinite
from typing import Any

from .. import status
from ..cases.case import Case
from ..chapter.staged import collisions
from ..errors import UserError
from ..report.answers import Answer, ask, given_of, numbers_of
from . import options
from .answers import show_answer
from .options import choice, flag, option
from .output import show

CATEGORIES = {
    "60-side": "60° FRONT TO SIDE",
    "90-side": "90° FRONT TO SIDE",
    "front": "10° FRONT TO FRONT",
    "rear": "10° FRONT TO REAR",
}
"""Words of --like, and the categories of Table 2."""
EQUATION_19 = (
    "Equation 19 with the factor 2/3 (it is not printed, but Table 2 has it)",
    "an estimate: rms 3.8, largest 8.2 ft/s over the 22 velocity changes of Table 2; untested "
    "elsewhere (Section VI)",
)


Values = Mapping[str, Any]
"""Values in base units by name."""


def _answer(case: Case, question: str, results: Values, *remarks: str) -> Answer:
    """Return results in base units as the answer to a case."""
    values = {name: float(value) for name, value in results.items()}
    bits = int(values.pop("STATUS", 0))
    finite = {name: value for name, value in values.items() if isfinite(value)}
    return Answer(
        "forward",
        question,
        given_of(case),
        numbers_of(case, finite),
        case,
        possible=not bits & status.IMPOSSIBLE,
        remarks=(*case.remarks, *remarks),
        warnings=tuple(status.sentences(bits)),
    )


def _colinear(case: Case, known: Values, like: str) -> Answer:
    """Return the impact of vehicles that do not turn, forward or backward."""
    from ..chapter.colinear import FINAL, INITIAL, colinear, colinear_inverse

    if ("UN" in known) == ("VAN" in known):
        raise UserError("expected the velocities before (UN VN) or those after (VAN VBN)")
    solve, names = (colinear, INITIAL) if "UN" in known else (colinear_inverse, FINAL)
    if "MUP" not in known:  # nothing acts along t
        known = {**dict.fromkeys(("MUP", *names[1::2]), 0.0), **known}
    return _answer(case, "a colinear impact, Equations 9 to 12", solve(known))


def _barrier(case: Case, known: Values, like: str) -> Answer:
    """Return the impact of vehicle A on a barrier."""
    from ..chapter.barrier import BARRIER

    return ask(case.with_({name: f"{value:g}" for name, value in BARRIER.items()}, "barrier"))


def _delta_v(case: Case, known: Values, like: str) -> Answer:
    """Return velocity changes by Equation 19, for one loss or for the range of a category."""
    from ..chapter.deltav import delta_v, loss_of_energy

    question = "velocity changes from the energy lost"
    if like:
        alike = [c for c in collisions() if c.category == CATEGORIES[like]]
        losses = sorted(c.table2["loss"] for c in alike)[:: len(alike) - 1]
        numbers = ", ".join(str(c.number) for c in alike)
        question += f", least and most of collisions {numbers} ({CATEGORIES[like]})"
    elif "EL" in known:
        losses = [loss_of_energy(known)]
    else:
        losses = [known.get("LOSS", -1.0)]
    if not 0 <= losses[0] <= 100:
        raise UserError("expected LOSS from 0 to 100 percent, EL as energy, or --like")
    first, *others = [
        _answer(case, question, {"LOSS": x, **delta_v({**known, "LOSS": x})}, *EQUATION_19)
        for x in losses
    ]
    return replace(first, alternatives=tuple(others))


def _staged(args: options.Args) -> int:
    """Print tables of the staged collisions."""
    from ..chapter import staged, validation, words

    compared = staged.comparison()
    record = {
        "problem": "staged",
        "emendations": staged.emendations(),
        "collisions": collisions(),
        "comparison": compared,
        "validation": [check._asdict() for check in validation.checks()],
    }
    lines: Iterable[str] = words.comparison_lines()
    if args.table or args.validation:
        lines = words.table_lines(int(args.table)) if args.table else words.validation_lines()
    show(args.json, "chapter", record, lines)
    return int(any(cell.explanation == "not explained" for cell in compared))


def _example(args: options.Args) -> int:
    """Print the example of Section VII."""
    from ..chapter.example import steps
    from ..chapter.words import example_lines

    show(args.json, "chapter", {"problem": "example", "steps": steps()}, example_lines())
    return int(any(number.agrees is False for step in steps() for number in step.numbers))


IMPACTS = {"colinear": _colinear, "barrier": _barrier, "delta-v": _delta_v}
"""Problems that are posed by a case."""
TABLES = {"staged": _staged, "example": _example}
OPTIONS = (
    option("problem", choices=(*IMPACTS, *TABLES), help="the problem, see above"),
    *options.CASE,
    choice("--like", (*CATEGORIES,), "delta-v: losses of staged collisions of this kind"),
    choice("--table", ("1", "2"), "staged: a table as emended"),
    flag("--validation", "staged: crash tests published since, recomputed"),
    options.JSON,
    options.OUTPUT,
)


def main(args: options.Args) -> int:
    """Solve a problem of the chapter."""
    if args.problem in TABLES:
        return TABLES[args.problem](args)
    case = options.case_of(args)
    known = {name: amount.value for name, amount in case.entries.items()}
    return show_answer(IMPACTS[args.problem](case, known, args.like), args.json)
