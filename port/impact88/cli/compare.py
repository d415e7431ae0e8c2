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

from .options import (
    JSON,
    OUTPUT,
    UNITS,
    Args,
    OutputPath,
    changes_of,
    input_file,
    option,
    printing_to,
    texts,
)
from .output import show

OPTIONS = (
    input_file("theirs", "TABLE", "their results"),
    texts("--set", "NAME=VALUE", "a value of all rows"),
    UNITS,
    option("--kit", metavar="ID", help="judge answers to this kit: 1988.1"),
    option("--junit", type=OutputPath, metavar="FILE", help="write a JUnit report"),
    JSON,
    OUTPUT,
)


def main(args: Args) -> bool:
    """Compare a table with the reference."""
    from ..comparison.compare import compare
    from ..comparison.words import as_json, as_junit, as_text

    comparison = compare(
        args.theirs,
        kit=args.kit,
        values=changes_of(args),
        units=args.units,
    )
    if args.junit:
        with printing_to(args.junit):
            print(as_junit(comparison, args.theirs), end="")
    show(args, "compare", as_json(comparison), [as_text(comparison)])
    return not comparison.passed
