"""THEIRS is a table of another program's results, in any format that impact88 help solve lists: a
row per scene, with columns named as the scene's (impact88 scene lists them; M may be missing), in
any order, and any of the results: VAX VAY VBX VBY WAF WBF, contact velocities XA YA XB YB before
and XAF YAF XBF YBF after, VC VS KI KF LOSS ELN ELT ELM DVA DVB EESA EESB PN PT PM MUP MUC. Names
may be in small letters and have units (VAX [mph]); JSON may hold inputs and outputs in objects of
their own. A note on standard error says how the table was read. Each result agrees

  to the double       within the rounding errors of the best programs in double precision
  to digits claimed   to all digits it is written with
  as elimination      within the rounding errors of a correct but less careful program in double
                      precision: by elimination, or by trial impulses beside large velocities

or it disagrees. For rows that disagree, compare tries some 50,000 small errors in eleven ways of
writing the equations, conventions, other laws of friction and restitution, and constants, singly
and in pairs. It names the one that predicts the numbers in the table, of rows that agree, too, and
the condition on the scene under which it holds ("where the closing speed is below 10"). It
searches 400 rows that disagree and as many that agree, in about 15 seconds, then counts in all
rows; and it says what it did not search for.
What could not be compared is listed on standard error. Rows without numbers count as refused where
there is no result, or where they are vectors of the class failure.

With --kit DIR the table is judged as answers to the vectors of that kit (impact88 oracle --kit),
whose scenes need not be in it: every id once, inputs that are given bit for bit, all final
velocities, every result where one is due and no number where there is none. It prints a result per
class and label, too, and one line for a badge.

Conventions (axes, signs, units, how close is close, vector classes): impact88 schema conventions.

examples:
  impact88 compare theirs.csv
  impact88 compare theirs.jsonl --json
  impact88 compare theirs.jsonl --strict --junit results.xml
  impact88 compare theirs.csv --set EM=1 --set M=6
  impact88 compare --kit kit theirs.csv --junit conformance.xml

exit status: 0 everything agrees; 1 something does not, or a row could not be read (with --strict:
or was not compared; with --kit: a vector does not pass); 2 bad input
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from ...conformance.comparison.agreement import EQUATIONS
from ...conformance.comparison.compare import Comparison, compare, describe
from ...errors import UserError, note, one_line
from ...files import display_name
from ...mechanics.accuracy.errorbound import DOUBLE
from ...tables.table import format_of
from . import options

TYPE_CHECKING = False
if TYPE_CHECKING:
    from ...conformance.comparison.answers import KitAnswers
    from ...conformance.comparison.diagnosis import TableCause

MAX_BAD_ROWS_LISTED = 20  # one screenful
MAX_VECTORS_LISTED = 5  # of a kit, for each reason why some do not pass

ARGUMENTS = (
    options.reads("theirs", "THEIRS", "the table (- is standard input, CSV)"),
    options.format_option("--from", "the format, if its name does not show it", dest="format"),
    options.setting("a value of the scene for all rows, where the table has no such column"),
    options.value(
        "--rtol",
        "SHARE",
        "relative tolerance, as a fraction of the scene's largest velocity, spin or energy "
        "(default: what rounding in double precision allows in that scene)",
        type=float,
    ),
    options.flag(
        "--strict",
        "rows, cells and columns that were not compared are failures, but for rows "
        "that theirs may refuse",
    ),
    options.flag("--no-causes", "judge only; look for no causes"),
    options.reads("--kit", "KIT", "judge as answers to the vectors of this kit, folder or .zip"),
    options.writes(
        "--junit",
        "FILE",
        "write a JUnit report: a test for each row "
        "that disagrees, one for all that agree, one per reason why rows were not compared (with "
        "--kit: one per vector)",
    ),
    options.UNITS,
    options.ENCODING,
    options.JSON,
    options.OUTPUT,
)


def main(args: options.Args) -> int:
    values = options.settings(args.set, units=args.units)
    if args.rtol is not None and not 0 <= args.rtol < 1:
        raise UserError(f"--rtol is {args.rtol}; expected a share such as 1e-9")
    format = format_of(args.theirs, args.format)
    comparison = compare(
        args.theirs,
        format,
        values,
        args.rtol,
        args.encoding,
        args.units,
        not args.no_causes,
        args.kit,
    )
    if args.junit:
        comparison.write_junit(args.junit, display_name(args.theirs), args.strict)
    options.show(args, "compare", comparison.as_json, lambda: _lines(comparison))
    for line in _notes(comparison):
        note("compare", line)
    return int(not comparison.passes(args.strict))


def _notes(comparison: Comparison) -> Iterator[str]:
    """Yield the notes for stderr: how the table was read, what could not be or was not compared."""
    yield from comparison.remarks
    yield from map(str, comparison.bad[:MAX_BAD_ROWS_LISTED])
    if len(comparison.bad) > MAX_BAD_ROWS_LISTED:
        yield f"and {len(comparison.bad) - MAX_BAD_ROWS_LISTED} more"
    yield from comparison.silent


def _evidence_lines(cause: TableCause) -> Iterator[str]:
    """Yield what supports a cause."""
    yield f"\n{cause.says}"
    if cause.formula:
        yield f"  in the program: {cause.formula}"
    but = f" (except their {', '.join(cause.open)})" if cause.open else ""
    yield (
        f"  predicts {cause.explains} of {cause.disagreeing} rows that disagree{but} and "
        f"{cause.fits} of {cause.agreeing} examined rows that agree; score {cause.score:.0f} bits"
    )
    if remaining := cause.disagreeing - cause.explains:
        yield f"  leaves {remaining} rows that disagree unexplained"
    for says, row in cause.parts.items():
        yield f"  row {row} shows: {says}"
    for equivalent in cause.equivalents:
        yield f"  gives the same results in this table: {equivalent}"
    if cause.apart:
        yield f"  this scene tells the two apart: {','.join(cause.apart)}"
        yield f"  {','.join(cause.apart.values())}"


def _lines(comparison: Comparison) -> Iterator[str]:
    yield f"{comparison.summary.partition('; ')[0]}\n"
    yield (
        "result  compared  to the double  to digits claimed  as elimination  disagree  "
        "largest difference"
    )
    for name, tally in comparison.tallies.items():
        yield (
            f"{name:<6}  {tally.compared:>8}  {tally.double:>13}  {tally.digits:>17}  "
            f"{tally.elimination:>14}  {tally.differ:>8}  {tally.largest:>18.2g}"
        )
    yield "(differences are relative to the scene's largest velocity, spin or energy)"
    loose = comparison.elimination
    if loose.rows:
        lost = max(0, round(math.log10(max(loose.worst_relative, DOUBLE) / DOUBLE)))
        yield (
            "\nrows that agree only within the rounding errors of a less careful program: "
            f"{loose.rows};\nin the worst, row {loose.worst_row}, {lost} of 16 digits are lost "
            f"(condition number {loose.worst_condition:.2g})"
        )
    if comparison.causes:
        yield "\nrows that disagree, by likely cause:"
        for cause, count in comparison.causes.most_common():
            yield f"  {count:>7}  {cause}"
        for evidence in comparison.evidence:
            yield from _evidence_lines(evidence)
        for what in comparison.skipped:
            yield f"\nnot searched for: {what}"
        if comparison.unexplained:
            yield "\nunexplained rows, of those that disagree, by kind of scene:"
            for name, kind in comparison.unexplained.items():
                laws = ", ".join(kind.violated)
                says = f"; Equations {laws} violated" if laws else ""
                yield f"  {name}: {kind.unexplained} of {kind.rows}{says}"
        broken = {number: tally for number, tally in comparison.equations.items() if tally[1]}
        if broken:
            yield "\nequations of the chapter violated by the final velocities in the table:"
            for number, (row_count, violations) in broken.items():
                share = f"in {violations} of {row_count} rows that disagree"
                yield f"  Equation {number} ({EQUATIONS[number]}): {share}"
        elif comparison.equations:
            yield "\nthe final velocities in the table violate none of Equations 13 to 18"
    if comparison.differing:
        yield "\nlargest differences first:"
        for cell in comparison.worst:
            place = f"row {cell.row}" + (f" (line {cell.line})" if cell.line else "")
            name = f", id {one_line(cell.id, 40)}" if cell.id else ""
            yield (f"  {place}{name}: {cell}; {cell.cause}")
    failures = comparison.kit.failures if comparison.kit is not None else []
    for reason, group in comparison.not_compared.items():
        yield f"\n{describe(reason, group)}"
        listed = [verdict for verdict in failures if verdict.reason == reason]
        yield from (f"  {verdict}" for verdict in listed[:MAX_VECTORS_LISTED])
    if comparison.kit is not None:
        yield from _kit_lines(comparison.kit)


def _kit_lines(answers: KitAnswers) -> Iterator[str]:
    for attribute, title in (("kind", "class"), ("label", "label")):
        yield f"\n{title:<30}  passed  failed"
        for name, count in answers.counts(attribute).items():
            if attribute == "kind" or count["failed"]:
                yield f"{name:<30}  {count['passed']:>6}  {count['failed']:>6}"
        if answers.conforms:
            break
    yield f"\n{answers.badge}"
