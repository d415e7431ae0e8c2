"""impact88 compare theirs.csv                      where another program disagrees, and why
impact88 compare theirs.jsonl --set MU=.5        a value that the table lacks
impact88 compare theirs.csv --units us           in mph, lb and ft
impact88 compare --kit 1988.1 theirs.csv --junit results.xml
impact88 compare theirs.csv --json -o comparison.json

The table (.csv, .jsonl; - is standard input, CSV) has the columns of a scene and the results of the
other program, by the listing's names. A result agrees if it lies within what rounding allows in its
row. Where results disagree, edits of the reference are tried; the one that reproduces them is the
likely mistake. With --kit the table holds answers to the vectors of `impact88 oracle --kit`.

exit status: 0 every result agrees; 1 something disagrees or was not compared; 2 bad input"""

from __future__ import annotations

from ..files import display_name
from ..names import RESULTS, SCENE
from . import options
from .output import print_json


def declare(parser: options.Parser) -> None:
    """Add the arguments."""
    parser.add_argument("theirs", type=options.InputPath, metavar="TABLE", help="their results")
    options.add_set(parser, "a value of all rows")
    parser.add_argument("--units", choices=options.SYSTEMS, help="units of the table")
    parser.add_argument("--no-causes", action="store_true", help="look for no mistakes")
    parser.add_argument("--kit", metavar="ID or FOLDER", help="judge answers to this kit")
    parser.add_argument(
        "--junit", type=options.OutputPath, metavar="FILE", help="write a JUnit report"
    )
    options.add_json(parser)
    options.add_output(parser)


def main(args: options.Args) -> int:
    """Compare a table with the reference."""
    from ..cases.case import Case
    from ..cases.units import View
    from ..comparison.compare import compare
    from ..comparison.words import as_json, as_junit, as_text

    view = View.of(units=args.units)
    case = Case.of(options.changes_of(args), "--set", view)
    names = (*SCENE, *RESULTS) if args.units else ()
    comparison = compare(
        args.theirs,
        kit=args.kit,
        values={name: case.numbers[name] for name in options.changes_of(args)},
        factors={name: float(view.map(name)[0]) for name in names if name != "STATUS"},
        causes=not args.no_causes,
    )
    if args.junit:
        with options.printing_to(args.junit):
            print(as_junit(comparison, display_name(args.theirs)), end="")
    if args.json:
        print_json("compare", as_json(comparison))
    else:
        print(as_text(comparison))
    return int(not comparison.passed)
