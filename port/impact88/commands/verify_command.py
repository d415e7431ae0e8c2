"""A printout is read as text, typed in or from a scanner: it is aligned with the program's page, so
that damaged labels, borders and notes cost little, and every character ends up in a number, a label
or left over. The scene is recovered, replayed in the Apple's arithmetic, and every digit compared.
What exact arithmetic gives and physical warnings stand beside the verdict and do not change it.
A scan or photograph (PNG, JPEG, TIFF, PDF; pip install 'impact88[scan]') is read cell by cell: each
is held against the mean glyph that the page itself has for the character the program prints.

verdicts:
  IDENTICAL                 every number was read, and is what the program prints
  IDENTICAL AS FAR AS READ  the program's page explains the paper; doubts are listed
  DIFFERS                   something contradicts every scene that the inputs allow
  INCOMPLETE                numbers are missing; what could be compared agrees

examples:
  impact88 verify printout.txt                      verdict, fields, explanations
  impact88 verify scan.png                          the same from the picture of a page
  impact88 verify --brief box7/*.txt                a few lines a printout
  impact88 verify --json printout.txt               one JSON object a printout
  impact88 verify results.txt --scene crash.toml    inputs from a file
  impact88 verify printout.txt --listing office.bas
  impact88 verify printout.txt --report case.html --case 17/88
  impact88 run --sample 1 | impact88 verify -       - is standard input

exit status: 0 identical; 1 any other verdict; 2 unreadable; of several files the highest
"""

from __future__ import annotations

import argparse
import json
import sys

from ..errors import UserError
from ..reporting.examination import Examined, Verdict, examine
from ..reporting.verification import lines
from ..schemas import stamped
from ..stderr import note
from .options import (
    InputFile,
    OutputFile,
    add_json_argument,
    add_output_argument,
    add_sample_argument,
    add_set_argument,
    one_scene,
)

_ON_REPORT = ("date", "case", "examiner")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `impact88 verify`."""
    parser.add_argument(
        "printouts", nargs="+", type=InputFile, metavar="PRINTOUT", help="text, picture or PDF"
    )
    add_json_argument(parser, "one JSON object a printout")
    add_output_argument(parser)
    parser.add_argument("--brief", action="store_true", help="only verdicts and what differs")
    parser.add_argument(
        "--scene",
        type=InputFile,
        metavar="FILE.toml",
        help="inputs apart, where the page has only results",
    )
    parser.add_argument(
        "--listing",
        type=InputFile,
        metavar="THEIRS.bas",
        help="hold the pages against another copy of the listing",
    )
    parser.add_argument(
        "--report", type=OutputFile, metavar="FILE.html", help="write a page for the case file"
    )
    add_sample_argument(parser, "inputs apart: those of a published run")
    add_set_argument(parser, "change a value of these inputs")
    parser.add_argument("--date", help="date to stand on the report, as given")
    parser.add_argument("--case", help="case to stand on the report, as given")
    parser.add_argument("--examiner", help="examiner to stand on the report, as given")


def main(args: argparse.Namespace) -> int:
    """Verify every printout of every file."""
    for option in _ON_REPORT:
        if getattr(args, option) and not args.report:
            raise UserError(f"--{option} is for the report; expected --report FILE.html with it")
    given = None
    if args.scene or args.sample or args.set:
        given = dict(one_scene(args))
    copy = None
    if args.listing:
        from ..program.listingcopy import ListingCopy

        copy = ListingCopy(args.listing)
    status = 0
    examined = []
    for path in args.printouts:
        one = examine(path, given, copy)
        examined.append(one)
        _tell(one, args)
        adverse = any(result.verdict is not Verdict.IDENTICAL for result in one.results)
        status = max(status, 2 if one.error else int(adverse))
    if args.report and any(one.results for one in examined):
        from ..reporting.casefile import write_report

        write_report(args.report, examined, args.date, args.case, args.examiner)
    return status


def _tell(one: Examined, args: argparse.Namespace) -> None:
    if one.error:
        note("verify", one.error)
    if args.json:
        for described in one.as_json():
            print(json.dumps(stamped("verify", described), ensure_ascii=False))
    else:
        for result in one.results:
            print("\n".join(lines(result, args.brief)))
    sys.stdout.flush()
