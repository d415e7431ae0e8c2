"""A printout is read as text, typed in or from a scanner: blanks and line breaks do not matter, O
is 0 and l is 1 where a number must stand, ? is an illegible character. The scene is recovered from
it, replayed in the Apple's arithmetic, and every printed digit compared. What exact arithmetic
gives and physical warnings stand beside the verdict and do not change it.

examples:
  impact88 verify printout.txt                      verdict, all fields, explanations
  impact88 verify --brief box7/*.txt                one line a printout, differing fields below it
  impact88 verify --json printout.txt               one JSON object a printout
  impact88 verify printout.txt --report case.html --date 2024-05-17
  impact88 run --sample 1 | impact88 verify -       - is standard input

exit status: 0 identical; 1 differs, or incomplete; 2 unreadable; of several files the highest
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator

from ..casework.verify import FieldCheck, Verdict, Verification, verify_file
from ..errors import UserError, shown
from ..files import called
from ..schemas import stamped
from .options import add_json_argument, add_output_argument


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `impact88 verify`."""
    parser.add_argument("printouts", nargs="+", metavar="PRINTOUT", help="a text file (- is stdin)")
    add_json_argument(parser, "one JSON object a printout")
    add_output_argument(parser)
    parser.add_argument("--brief", action="store_true", help="only verdicts and what differs")
    parser.add_argument("--report", metavar="FILE.html", help="write a page for the case file")
    parser.add_argument("--date", help="date to stand on the report, as given")


def main(args: argparse.Namespace) -> int:
    """Verify every printout of every file."""
    if args.date and not args.report:
        raise UserError("--date is for the report; expected --report FILE.html with it")
    status = 0
    results = []
    for path in args.printouts:
        try:
            for result in verify_file(path):
                if args.json:
                    print(json.dumps(stamped("verify", result.as_json()), ensure_ascii=False))
                else:
                    print("\n".join(_lines(result, args.brief)))
                sys.stdout.flush()
                status = max(status, result.verdict is not Verdict.IDENTICAL)
                if args.report:
                    results.append(result)
        except UserError as error:
            print(f"impact88 verify: {error}", file=sys.stderr)
            status = 2
    if args.report and results and status != 2:
        from ..casework.report import write_report

        write_report(args.report, results, args.date)
    return int(status)


def _lines(result: Verification, brief: bool) -> Iterator[str]:
    where = shown(called(result.file))
    compared = sum(check.same is not None for check in result.fields)
    yield f"{where}, printout {result.number} (line {result.line}): {str(result.verdict).upper()}"
    if result.verdict is Verdict.IDENTICAL:
        yield f"  all {compared} printed numbers are what the program prints, digit for digit"
    elif compared:
        yield f"  {compared} printed numbers compared, {len(result.differing)} differ"
    for name in result.missing:
        yield f"  {name} is missing: what depends on it was not compared"
    yield from (f"  {line}" for line in _ending(result))
    for row in result.illegible:
        fits = " or ".join(row["fits"]) or "nothing"
        yield f"  {row['name']} {row['printed']}: {fits} fits"
    checks = result.differing if brief else result.fields
    if checks:
        yield ""
        yield from (f"  {line}" for line in _table(checks, exact=not brief))
    for check in result.replies:
        if check.same is False:
            yield f"  the reply {check.printed} for {check.name} is not the {check.recomputed} used"
    if result.explanations:
        yield ""
        yield "  possible explanations, best first:"
        for place, one in enumerate(result.explanations, 1):
            what = one.kind
            if one.field:
                what += f": {one.field} {one.printed}, would be {one.would_be}"
            note = f" ({one.note})" if one.note else ""
            yield f"  {place}. {what}; explains {one.explains} of {result.disagreements}{note}"
    if result.warnings and not brief:
        yield ""
        yield "  beside the verdict:"
        yield from (f"  - {warning}" for warning in result.warnings)
    for remark in result.remarks:
        yield f"  note: {remark}"
    if not brief:
        yield ""


def _ending(result: Verification) -> Iterator[str]:
    check = result.ending
    if check is None or check.same is not False:
        return
    yield f"ends with {check.printed or 'no error'}, recomputed: {check.recomputed or 'no error'}"


def _table(checks: list[FieldCheck], exact: bool) -> Iterator[str]:
    """Rows of printed against recomputed, those that differ marked."""
    rows = [["", "printed", "recomputed"]]
    marks = {True: "", False: "differs", None: "not compared"}
    for check in checks:
        rows.append([check.name, check.printed or "-", check.recomputed or "-"])
    if exact:
        rows[0] += ["exact", "printed-exact"]
        for row, check in zip(rows[1:], checks, strict=True):
            row += [check.exact or "", check.difference or ""]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    notes = ["", *(marks[check.same] for check in checks)]
    for row, note in zip(rows, notes, strict=True):
        cells = [row[0].ljust(widths[0])]
        cells += [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
        yield "  ".join([*cells, note]).rstrip()
