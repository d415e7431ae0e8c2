"""THEIRS is a table of another program's results, in any format that impact88 help solve lists: a
row per scene, with columns named as the scene's (impact88 scene lists them; M may be missing), in
any order, and any of the results: VAX VAY VBX VBY WAF WBF, contact velocities XA YA XB YB before
and XAF YAF XBF YBF after, VC VS KI KF LOSS ELN ELT ELM DVA DVB EESA EESB PN PT PM MUP MUC. Names
may be in small letters and have units (VAX [mph]); JSON may hold inputs and outputs in objects of
their own. A note on standard error says how the table was read. Each result agrees

  to the double       within the rounding errors of the best programs in double precision
  to digits claimed   to all digits it is written with
  as elimination      as closely as a correct but less careful program in double precision can in
                      that scene: by elimination, or by trial impulses beside large velocities

or it does not. For rows that disagree, compare tries some 50,000 small errors, in eleven ways of
writing the equations, conventions, other laws of friction and restitution, and constants, singly
and in pairs. It says in a sentence which of them predicts the numbers, those that agree as well,
and under which condition on the scene ("where the closing speed is below 10"). It finds causes in
400 rows that disagree and as many that agree, in about 15 seconds, then counts in all rows; and it
says what it did not look for.
What could not be compared is listed on standard error; rows that theirs refuses where there is
no result, or that are vectors of the class failure, are counted as refused.

With --kit DIR the table is judged as answers to the vectors of that kit (impact88 oracle --kit):
every id once, its inputs bit for bit, all final velocities, an answer where one is due and no
number where there is none. It prints a result per class and label and one line for a badge.

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
from collections import Counter
from collections.abc import Iterator

from ...conformance.comparison.agreement import EQUATIONS
from ...conformance.comparison.compare import HARMLESS, Comparison, compare
from ...errors import UserError, note, one_line
from ...files import display_name
from ...mechanics.accuracy.errorbound import DOUBLE
from ...tables.table import format_of
from . import options

TYPE_CHECKING = False
if TYPE_CHECKING:
    from ...conformance.comparison.conformance import Conformance
    from ...conformance.comparison.diagnosis import TableCause

MAX_BAD_ROWS_LISTED = 20  # one screenful
MAX_VECTORS_LISTED = 5  # for each reason why some do not pass

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
    result: Comparison | Conformance
    if args.kit is None:
        result = compare(
            args.theirs, format, values, args.rtol, args.encoding, args.units, not args.no_causes
        )
        schema, lines = "compare", _lines(result)
        is_adverse = bool(result.differing or result.bad or (args.strict and result.silent))
    else:
        from ...conformance.comparison.conformance import check_conformance  # its archives: 10 ms

        for option, value in (("--set", args.set), ("--units", args.units), ("--rtol", args.rtol)):
            if value:
                raise UserError(
                    f"{option}: a kit's inputs and tolerances are its own; expected none"
                )
        result = check_conformance(args.kit, args.theirs, format, args.encoding)
        schema, lines, is_adverse = "conformance", _conformance_lines(result), not result.conforms
    if args.junit:
        result.write_junit(args.junit, display_name(args.theirs), args.strict)
    options.show(args, schema, result.as_json, lambda: lines)
    for line in _notes(result):
        note("compare", line)
    return int(is_adverse)


def _conformance_lines(done: Conformance) -> Iterator[str]:
    from ...conformance.comparison.conformance import REASONS

    yield f"{'class':<30}  passed  failed"
    for name, count in done.counts("kind").items():
        yield f"{name:<30}  {count['passed']:>6}  {count['failed']:>6}"
    yield f"of those that pass, {done.refused} are refused, as they may be"
    if done.failures:
        yield f"\n{'label':<30}  passed  failed"
        for name, count in done.counts("label").items():
            if count["failed"]:
                yield f"{name:<30}  {count['passed']:>6}  {count['failed']:>6}"
    reasons = Counter(verdict.reason for verdict in done.failures)
    for reason, failures in reasons.most_common():
        yield f"\n{failures} vectors: {REASONS[reason]}"
        for verdict in [v for v in done.failures if v.reason == reason][:MAX_VECTORS_LISTED]:
            place = f"row {verdict.row}" if verdict.row else "no row"
            detail = f": {one_line(verdict.detail, 100)}" if verdict.detail else ""
            yield f"  {verdict.vector.id} ({verdict.vector.label}), {place}{detail}"
    if done.strays:
        yield f"\n{len(done.strays)} rows are no vector's"
        yield from (f"  {stray}" for stray in done.strays[:MAX_VECTORS_LISTED])
    if done.failures:
        yield "\nimpact88 compare without --kit looks for the cause"
    yield f"\n{done.badge}"


def _notes(judged: Comparison | Conformance) -> Iterator[str]:
    """Yield the notes for stderr: how the table was read, what could not be or was not compared."""
    yield from judged.remarks
    for name, suggestion in list(judged.unknown.items())[:MAX_BAD_ROWS_LISTED]:
        hint = f"; did you mean {suggestion}? (a unit stands in brackets: {suggestion} [mph])"
        yield f"column {name} is not recognised{hint * bool(suggestion)}"
    if len(judged.unknown) > MAX_BAD_ROWS_LISTED:
        yield f"and {len(judged.unknown) - MAX_BAD_ROWS_LISTED} more columns are not recognised"
    if isinstance(judged, Comparison):
        yield from _comparison_notes(judged)


def _comparison_notes(comparison: Comparison) -> Iterator[str]:
    yield from map(str, comparison.bad[:MAX_BAD_ROWS_LISTED])
    if len(comparison.bad) > MAX_BAD_ROWS_LISTED:
        yield f"and {len(comparison.bad) - MAX_BAD_ROWS_LISTED} more"
    for reason, count in comparison.not_compared.items():
        if reason not in HARMLESS:
            first = ", ".join(map(str, count.first[:5])) + (", ..." if count.rows > 5 else "")
            labels = f" (labels: {', '.join(count.labels)})" if any(count.labels) else ""
            yield f"{count.rows} rows not compared ({first}): {reason}{labels}"
    for name, tally in comparison.tallies.items():
        if tally.missing:
            yield f"{tally.missing} cells of {name} are empty where there is a result"


def _evidence_lines(cause: TableCause) -> Iterator[str]:
    """Yield what supports a cause."""
    yield f"\n{cause.says}"
    if cause.formula:
        yield f"  in the program: {cause.formula}"
    but = f", but for their {', '.join(cause.open)}" if cause.open else ""
    yield (
        f"  predicts {cause.explains} of {cause.disagreeing} rows that disagree{but}, "
        f"{cause.fits} of {cause.agreeing} examined that agree; {cause.score:.0f} bits"
    )
    if remaining := cause.disagreeing - cause.explains:
        yield f"  it does not explain the other {remaining} rows that disagree"
    for says, row in cause.parts.items():
        yield f"  row {row} shows: {says}"
    for equivalent in cause.equivalents:
        yield f"  or, the same in this table: {equivalent}"
    if cause.apart:
        yield f"  this row tells it from the first of those: {','.join(cause.apart)}"
        yield f"  {','.join(cause.apart.values())}"


def _lines(comparison: Comparison) -> Iterator[str]:
    yield f"{comparison.summary.partition('; ')[0]}\n"
    yield (
        "result  compared  to the double  to digits claimed  as elimination      not  "
        "largest difference"
    )
    for name, tally in comparison.tallies.items():
        yield (
            f"{name:<6}  {tally.compared:>8}  {tally.double:>13}  {tally.digits:>17}  "
            f"{tally.elimination:>14}  {tally.differ:>7}  {tally.largest:>18.2g}"
        )
    yield "(difference relative to the scene's largest velocity, spin or energy)"
    loose = comparison.elimination
    if loose.rows:
        lost = max(0, round(math.log10(max(loose.worst_relative, DOUBLE) / DOUBLE)))
        yield f"\n{loose.rows} rows agree only as a correct but less careful program's may there;"
        yield (
            f"the worst, row {loose.worst_row}, has lost {lost} of 16 digits (the best of programs "
            f"has condition {loose.worst_condition:.2g} there)"
        )
    if comparison.causes:
        yield "\nrows that disagree, by likely cause:"
        for cause, count in comparison.causes.most_common():
            yield f"  {count:>7}  {cause}"
        for evidence in comparison.evidence:
            yield from _evidence_lines(evidence)
        for what in comparison.skipped:
            yield f"\nnot looked for: {what}"
        if comparison.unexplained:
            yield "\nrows without a cause, of those that disagree, by kind of scene:"
            for name, kind in comparison.unexplained.items():
                laws = ", ".join(kind.violated)
                says = f"; Equations {laws} violated" if laws else ""
                yield f"  {name}: {kind.unexplained} of {kind.rows}{says}"
        broken = {number: tally for number, tally in comparison.equations.items() if tally[1]}
        if broken:
            yield "\nequations of the chapter that their final velocities violate:"
            for number, (row_count, violations) in broken.items():
                share = f"in {violations} of {row_count} rows that disagree"
                yield f"  Equation {number} ({EQUATIONS[number]}): {share}"
        elif comparison.equations:
            yield "\ntheir final velocities violate none of Equations 13 to 18"
    if comparison.differing:
        yield "\nworst first:"
        for cell in comparison.worst:
            place = f"row {cell.row}" + (f" (line {cell.line})" if cell.line else "")
            name = f", id {one_line(cell.id, 40)}" if cell.id else ""
            yield (
                f"  {place}{name}: {cell.result} {one_line(cell.theirs, 40)}, "
                f"here {cell.ours:.12g}, off by {cell.relative:.2g}; {cell.cause}"
            )
    for reason, skipped_count in comparison.not_compared.items():
        word = "refused" if reason in HARMLESS else "not compared"
        labels = (
            f" (labels: {', '.join(skipped_count.labels)})" if any(skipped_count.labels) else ""
        )
        yield f"\n{skipped_count.rows} rows {word}: {reason}{labels}"
