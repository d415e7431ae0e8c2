"""impact88 compare theirs.csv                      where another program disagrees, and why
impact88 compare theirs.csv --set MU=.5          a value that the table lacks
impact88 compare theirs.csv --units us           in mph, lb and ft
impact88 compare --kit 1988.1 theirs.csv --junit results.xml
impact88 compare theirs.csv --json -o comparison.json

The table (as for `solve`; - is CSV on standard input) has the columns of a scene and the results
of the other program, with headings such as VAX or VAX [mph]. A result agrees if it lies within what
rounding allows in its row. Where results disagree, edits of the reference are tried; the one that
reproduces them is the likely mistake. With --kit the table holds answers to the vectors of
`impact88 oracle --kit`.

exit status: 0 every result agrees; 1 something disagrees or was not compared; 2 bad input"""

from __future__ import annotations

from . import options
from .options import option
from .output import show

OPTIONS = (
    option("theirs", type=options.InputPath, metavar="TABLE", help="their results"),
    options.texts("--set", "NAME=VALUE", "a value of all rows"),
    options.UNITS,
    option("--kit", metavar="ID", help="judge answers to this kit: 1988.1"),
    option("--junit", type=options.OutputPath, metavar="FILE", help="write a JUnit report"),
    options.JSON,
    options.OUTPUT,
)


def main(args: options.Args) -> int:
    """Compare a table with the reference."""
    from ..comparison.compare import compare
    from ..comparison.words import as_json, as_junit, as_text

    comparison = compare(
        args.theirs,
        kit=args.kit,
        values=options.changes_of(args),
        units=args.units,
    )
    if args.junit:
        with options.printing_to(args.junit):
            print(as_junit(comparison, args.theirs), end="")
    show(args.json, "compare", as_json(comparison), [as_text(comparison)])
    return int(not comparison.passed)
