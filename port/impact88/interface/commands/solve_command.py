"""CASES is a table with a column for each of the scene's names (impact88 scene lists them; M is
optional, default 6). In JSON the scene may be an object inside (inputs); in a workbook the row
with most of the names has the headings. Names in small letters, semicolons and decimal commas are
understood, 1,234.5 too; an ambiguous comma (1,234) is rejected with a request to clarify. A unit
after a name (UX [mph], MA (lb)) or in a cell ("-25 mph") is converted, and results come in the same
system with headings that say so (DVA [mph]); --units is for columns without any. All the table's
columns are passed through, and the results follow. Rows are read and written in blocks: memory does
not grow with the file (except when reading a JSON array or writing .npz or .xlsx). A scene file
(.toml) is a table of one row, or with --sweep one row for each combination of the ranges
LOW:HIGH:COUNT.

Formats, by the ending of the file's name or by --from and --to:
{formats}

Results, all by default:
{results}

--arithmetic float64 is double precision with exact pi. --arithmetic applesoft is the 1988
program's own arithmetic, bit for bit, on the numbers as they are written; two more columns, ERROR
and LINE, say which error ended a scene and where.

A row that cannot be used is reported with its number, its column and the reason on stderr, or in
the file given with --errors; it is kept, with NaN for results, and all others are solved.

Conventions (axes, signs of angles and spins, units): impact88 schema conventions.

examples:
  impact88 solve cases.csv -o results.csv
  impact88 solve cases.csv -o results.jsonl --outputs VAX,VAY,STATUS
  impact88 solve cases.csv -o results.csv --set MU=-10 --errors bad-rows.csv
  impact88 solve cases.npz -o results.npz --results-only
  impact88 solve crash.toml --sweep MU=0:1:51 --outputs DVA,LOSS
  impact88 solve cases.csv -o results.csv --arithmetic applesoft

exit status: 0 all rows solved; 1 some could not be, or ended with an Applesoft error; 2 bad input
"""

from ...names import RESULTS
from ...tables.formats import FORMATS
from . import options

__doc__ = (__doc__ or "").format(
    formats="\n".join(
        f"  {row.name:<8} {row.summary} ({' '.join(row.endings)})" for row in FORMATS.values()
    ),
    results="\n".join(f"  {q.name:<6}  {q.meaning} [{q.unit}]" for q in RESULTS.values()),
)

ARGUMENTS = (
    options.reads("cases", "CASES", "the table of scenes (- is stdin)", nargs="?"),
    options.writes("-o --output", "RESULTS", "the table to write (default: stdout)", default="-"),
    options.names_option("--outputs", "the results wanted (default: all)"),
    options.choice(
        "--arithmetic",
        ("float64", "applesoft"),
        "the numbers to compute with (default: %(default)s)",
        default="float64",
    ),
    options.sample_option("the scene of a published run in place of CASES"),
    options.setting("a value for all rows, in place of a column"),
    options.SWEEP,
    *options.CONVENTION,
    options.flag("--results-only", "leave out the scene's own columns; others are passed through"),
    options.reads("--scene", "FILE.toml", "a scene file for the columns the table lacks"),
    options.ENCODING,
    options.writes("--errors", "FILE", "write the bad rows here (CSV)"),
    options.format_option("--from", "the format of CASES", dest="format"),
    options.format_option("--to", "the format of RESULTS"),
)


def main(args: options.Args) -> int:
    from .solving import solve_table

    return solve_table(args)
