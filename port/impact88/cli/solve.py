"""impact88 solve crash.toml                     the answer to a collision
impact88 solve crash.toml --set MU="+- .1"    a value changed, or known within limits
impact88 solve crash.toml --full              every result
impact88 solve cases.csv -o results.csv       each row of a table
impact88 solve crash.toml --sweep MU=0:1:51 --outputs DVA,LOSS
impact88 solve cases.xlsx -o results.parquet --scene common.toml --errors bad.csv

FILE.toml: a complete scene is solved forward, with 90 % intervals where it has tolerances; from
anything else the rest is reconstructed: speeds before, coefficients, delta-V, with what was assumed
and what would help.

TABLE (.csv .jsonl .parquet .xlsx; - is standard input, CSV): a column for each name of a scene,
units in the headings (UX [mph]). Results follow; a row that cannot be used is left empty and named
on stderr, or in the file of --errors. Parquet and Excel need pip install 'impact88[tables]'.

exit status: 0 done; 1 no impact that physics allows, values that contradict one another, or bad
rows; 2 bad input"""

from __future__ import annotations

from ..errors import UserError
from ..files import display_name
from ..names import RESULTS
from . import options
from .answers import answer_lines
from .output import print_json, progress, say

FORMATS = ("csv", "jsonl", "parquet", "xlsx")


def declare(parser: options.Parser) -> None:
    """Add the arguments."""
    options.add_case(parser, "FILE")
    options.add_names(parser, "--outputs", "the results wanted")
    parser.add_argument("--full", action="store_true", help="every result of FILE.toml")
    options.add_json(parser)
    parser.add_argument(
        "--write-scene",
        type=options.OutputPath,
        metavar="FILE",
        help="write the impact found as a complete FILE.toml",
    )
    options.add_seed(parser)
    options.add_target(parser)
    table = parser.add_argument_group("tables")
    table.add_argument(
        "--sweep",
        action="append",
        default=[],
        metavar="NAME=LOW:HIGH:COUNT",
        help="make a table of FILE.toml, in which a value runs through a range",
    )
    table.add_argument(
        "--arithmetic",
        choices=("float64", "applesoft"),
        help="double precision (default), or the 1988 program's",
    )
    table.add_argument(
        "--scene",
        type=options.InputPath,
        metavar="FILE.toml",
        help="values for the columns that the table lacks",
    )
    table.add_argument("--results-only", action="store_true", help="leave the scene's columns out")
    table.add_argument(
        "--errors", type=options.OutputPath, metavar="FILE", help="write all bad rows here (CSV)"
    )
    table.add_argument("--from", dest="source", choices=("toml", *FORMATS), help="format of FILE")
    table.add_argument("--to", choices=FORMATS, help="format of the table to write")
    table.add_argument("--encoding", metavar="NAME", help="of CSV that is not UTF-8: cp1252")


def main(args: options.Args) -> int:
    """Answer a collision, or solve a table."""
    is_case = args.sample or args.source == "toml" or (args.file or "").lower().endswith(".toml")
    if args.file and not is_case:
        return _solve_table(args)
    if args.sweep or args.arithmetic or (args.file and args.target.lower().endswith(TABLES)):
        return _solve_table(args)
    from ..report.answers import ALL, ask, scene_case

    case = options.case_of(args)
    names = options.names_of(args.outputs, ALL, "--outputs")
    answer = ask(case, names, full=args.full, seed=args.seed)
    with options.printing_to(args.target):
        if args.json:
            print_json("answer", answer.as_json())
        else:
            print("\n".join(answer_lines(answer)))
    if args.write_scene:
        with options.printing_to(args.write_scene):
            print(scene_case(answer).toml(), end="")
    return int(not answer.possible)


TABLES = (".csv", ".tsv", ".jsonl", ".ndjson", ".parquet", ".xlsx")
"""Endings of files that take a table."""


def _solve_table(args: options.Args) -> int:
    """Solve each row of a table, or of a case that is swept."""
    from ..cases.case import Case
    from ..cases.units import View
    from ..tables.solving import solve_table
    from ..tables.sweeping import sweep_table

    for name in ("json", "full"):
        if getattr(args, name):
            raise UserError(f"--{name} is for the answer to a FILE.toml; expected a table without")
    is_table = args.file and not (args.sample or args.file.lower().endswith(".toml"))
    view = View.of(**options.view_of(args))
    if is_table and args.sweep:
        raise UserError("--sweep is for a collision; expected a FILE.toml")
    if not is_table:
        case = options.case_of(args)
        source = sweep_table(case, options.pairs_of(args.sweep, "--sweep", "NAME=LOW:HIGH:COUNT"))
    else:
        source = args.file
        case = (
            Case.load(args.scene, **options.view_of(args)) if args.scene else Case.of({}, view=view)
        )
        case = options.changed(case, args)
    with progress("solve") as meter:
        solved = solve_table(
            source,
            args.target,
            options.names_of(args.outputs, RESULTS, "--outputs"),
            case=case,
            replaced=[*options.changes_of(args)] if is_table else (),
            view=view,
            arithmetic=args.arithmetic or "float64",
            results_only=args.results_only,
            source_format=args.source or "",
            target_format=args.to or "",
            encoding=args.encoding or "",
            errors=args.errors or "",
            progress=meter.update,
        )
    remarks = dict.fromkeys([*case.remarks, *solved.remarks])
    say("solve", [*remarks, *solved.messages(display_name(args.file or ""))])
    return int(bool(solved.bad or solved.ended))
