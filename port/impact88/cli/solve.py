"""impact88 solve crash.toml                     the answer to a collision
impact88 solve crash.toml --set MU="+- .1"    with a tolerance
impact88 solve crash.toml --full              every result
impact88 solve cases.csv -o results.csv       each row of a table
impact88 solve crash.toml --sweep MU=0:1:51 --outputs DVA,LOSS
impact88 solve cases.xlsx -o results.parquet --scene common.toml --errors bad.csv

FILE.toml: a complete scene is solved forward, with 90 % intervals where it has tolerances; from
anything else the rest is reconstructed: speeds before, coefficients, delta-V, with what was assumed
and what would help.

TABLE (.csv .csv.gz .jsonl .parquet .xlsx; - is standard input): a column for each name of a scene,
units in the headings (UX [mph]); results follow, NaN in rows that cannot be used, which are named
on stderr or in the file of --errors. Parquet and Excel need pip install 'impact88[tables]'.

exit status: 0 done; 1 no impact that physics allows, values that contradict one another, or bad
rows; 2 bad input"""

from __future__ import annotations

from . import options
from .answers import answer_lines
from .output import print_json

TABLE_OPTIONS = ("sweep", "scene", "errors", "results_only", "source", "to", "encoding")
"""Options that only a table has."""


def declare(parser: options.Parser) -> None:
    """Add the arguments."""
    options.add_case(parser, "FILE")
    options.add_names(parser, "--outputs", "the results wanted")
    options.add_json(parser)
    parser.add_argument("--full", action="store_true", help="every result of FILE.toml")
    options.add_seed(parser)
    parser.add_argument(
        "-o",
        "--output",
        dest="target",
        type=options.OutputPath,
        default=options.OutputPath("-"),
        metavar="FILE",
        help="write here (default: stdout)",
    )


def main(args: options.Args) -> int:
    """Answer a collision, or solve a table."""
    from ..report.answers import ALL, ask

    case = options.case_of(args)
    names = options.names_of(args.outputs, ALL, "--outputs")
    answer = ask(case, names, full=args.full, seed=args.seed)
    if args.json:
        print_json("answer", answer.as_json())
    else:
        print("\n".join(answer_lines(answer)))
    return int(not answer.possible)
