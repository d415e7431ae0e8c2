"""THEIRS is a CSV or JSON Lines table of another program's results: a row a scene, with columns
named as the scene's (impact88 scene lists them; M may be missing) and any of the results: VAX VAY
VBX VBY WAF WBF, contact velocities XA YA XB YB before and XAF YAF XBF YBF after, KI KF LOSS DVA DVB
PN PT PM MUP MUC. Each result agrees to the double, or to the digits it is written with, or not.
Rows that disagree are grouped by their likely cause: units of angle, signs, conventions, precision.

examples:
  impact88 compare theirs.csv
  impact88 compare theirs.jsonl --json
  impact88 compare theirs.csv --set EM=1 --set M=6

exit status: 0 everything agrees; 1 something does not, or a row could not be read; 2 bad input
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator

from ..checking.compare import Comparison, compare_file
from ..errors import shown
from ..tables.table import format_of
from .options import FORMATS, add_json_argument, add_output_argument, add_set_argument, settings

SHOWN = 20
"""Unreadable rows told on stderr."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `impact88 compare`."""
    parser.add_argument("theirs", metavar="THEIRS", help="the table (- is standard input, CSV)")
    parser.add_argument(
        "--from",
        dest="form",
        choices=FORMATS,
        help="the format, if its name does not tell",
    )
    add_set_argument(
        parser, "a value of the scene for all rows, where the table has no such column"
    )
    add_json_argument(parser)
    add_output_argument(parser)


def main(args: argparse.Namespace) -> int:
    """Compare a table."""
    given = settings(args.set)
    done = compare_file(args.theirs, format_of(args.theirs, args.form), given)
    if args.json:
        print(json.dumps(done.as_json(), ensure_ascii=False))
    else:
        print("\n".join(_lines(done)))
    for bad in done.bad[:SHOWN]:
        print(f"impact88 compare: {shown(str(bad))}", file=sys.stderr)
    if len(done.bad) > SHOWN:
        print(f"impact88 compare: and {len(done.bad) - SHOWN} more", file=sys.stderr)
    return int(done.differing > 0 or bool(done.bad))


def _lines(done: Comparison) -> Iterator[str]:
    yield f"{done.rows} rows: {done.agreeing} agree, {done.differing} disagree"
    yield ""
    yield "result  compared  to the double  to digits claimed      not  largest difference"
    for name, tally in done.tallies.items():
        yield (
            f"{name:<6}  {tally.compared:>8}  {tally.double:>13}  {tally.digits:>17}"
            f"  {tally.differ:>7}  {tally.largest:>18.2g}"
        )
    yield "(difference relative to the scene's largest velocity, spin or energy)"
    if done.causes:
        yield ""
        yield "rows that disagree, by likely cause:"
        for cause, count in done.causes.most_common():
            yield f"  {count:>7}  {cause}"
        yield ""
        yield "worst first:"
        for one in done.worst:
            place = f"row {one.row}" + (f" (line {one.line})" if one.line else "")
            name = f", id {shown(one.id, 40)}" if one.id else ""
            yield (
                f"  {place}{name}: {one.result} {shown(one.theirs, 40)}, here {one.ours:.12g}, "
                f"off by {one.relative:.2g}; {one.cause}"
            )
    if done.ignored:
        yield ""
        yield f"columns not looked at: {shown(' '.join(done.ignored))}"
