"""impact88 solve crash.toml                     the answer to a collision
impact88 solve crash.toml --set MU="+- .1"    a value changed, or known within limits
impact88 solve crash.toml --full              every result
impact88 solve cases.csv -o results.csv       each row of a table
impact88 solve crash.toml --sweep MU=0:1:51 --results DVA,LOSS
impact88 solve cases.xlsx -o results.parquet --scene common.toml

FILE.toml: a complete scene is solved forward, with 90 % intervals where it has tolerances; from
anything else the rest is reconstructed: speeds before, coefficients, delta-V, with what was assumed
and what would help.

TABLE (.csv .jsonl .parquet .xlsx; - is standard input, CSV): a column for each name of a scene,
units in the headings (UX [mph]). Results follow; a row that cannot be used is left empty and named
on stderr. Parquet and Excel need pip install '.[tables]' in the checkout.

exit status: 0 done; 1 no impact that physics allows, values that contradict one another, or bad
rows; 2 bad input"""

from __future__ import annotations

from ..errors import UserError, note
from ..names import RESULTS
from .options import (
    CASE,
    JSON,
    OUTPUT,
    Args,
    case_of,
    changes_of,
    choice,
    flag,
    input_file,
    pairs_of,
    printing_to,
    results_of,
    texts,
)
from .output import say, show_progress

WRITES = True
TABLES = (".csv", ".tsv", ".jsonl", ".ndjson", ".parquet", ".xlsx")
"""Endings of files that take a table."""
OPTIONS = (
    *CASE,
    texts("--results", "NAMES", "the results wanted: A,B,..."),
    flag("--full", "every result of FILE.toml"),
    JSON,
    OUTPUT,
    texts("--sweep", "NAME=LOW:HIGH:COUNT", "a table of FILE.toml in which a value changes"),
    choice("--arithmetic", ("float64", "applesoft"), "of a table; applesoft: the 1988 program's"),
    input_file("--scene", "FILE.toml", "values for the columns that a table lacks"),
    flag("--results-only", "leave the scene's columns out"),
)


def main(args: Args) -> bool:
    """Answer a collision, or solve a table."""
    is_table = bool(args.file) and not args.file.lower().endswith(".toml")
    if is_table or args.sweep or args.arithmetic or args.output.lower().endswith(TABLES):
        return _solve_table(args, is_table)
    from ..report.answers import ALL, ask
    from .answers import show_answer

    names = results_of(args, ALL)
    answer = ask(case_of(args), ALL if args.full else names)
    with printing_to(args.output):
        return show_answer(answer, args)


def _solve_table(args: Args, is_table: bool) -> bool:
    """Solve each row of a table, or of a case that is swept."""
    from ..tables.solving import Solver
    from ..tables.sweeping import sweep_table

    if args.json or args.full or (is_table and args.sweep):
        raise UserError("--json, --full and --sweep are for a FILE.toml, not for a table")
    table = args.file
    if is_table:
        args.file = args.scene
    case = case_of(args, not is_table)
    if args.sweep and case.ranges:
        note("solve", f"a sweep takes the middle of {', '.join(case.ranges)}, not their limits")
    ranges = pairs_of(args.sweep, "--sweep", "NAME=LOW:HIGH:COUNT")
    solver = Solver(
        table if is_table else sweep_table(case, ranges),
        case,
        results_of(args, RESULTS),
        replaced=changes_of(args) if is_table else (),
        arithmetic=args.arithmetic or "float64",
        results_only=args.results_only,
    )
    solver.write(args.output, show_progress)
    remarks = dict.fromkeys([*case.remarks, *solver.remarks()])
    say("solve", [*remarks, *solver.listed])
    return bool(solver.bad or solver.ended)
