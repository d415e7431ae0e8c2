"""A printout is read as text, typed in or from a scanner, and aligned with the program's page:
damaged labels, borders and notes do little harm, and every character is assigned to a number or
label, or reported as unassigned. The scene is recovered, replayed in the Apple's arithmetic, and
every digit compared. The values of exact arithmetic and physical warnings are shown with the
verdict and do not change it. A scan or photograph (PNG, JPEG, TIFF, PDF; pip install
'impact88[scan]') is read cell by cell: each character is compared with the page's own average image
of the expected character.

verdicts:
  IDENTICAL                 every number, label and mark is what the program prints, and nothing
                            else stands between its first and last line (in a picture: anywhere)
  IDENTICAL AS FAR AS READ  the numbers, as far as they were read, are the program's; doubts, and
                            whatever the program does not print, are listed
  DIFFERS                   something on the page is not as the program prints it for its inputs
  INCOMPLETE                numbers are missing or were not read, the rest decides nothing

examples:
  impact88 verify printout.txt                      verdict, fields, explanations
  impact88 verify scan.png                          the same from the picture of a page
  impact88 verify --brief box7/*.txt                a few lines per printout
  impact88 verify --json printout.txt               one JSON object per printout
  impact88 verify results.txt --scene crash.toml    inputs from a file
  impact88 verify printout.txt --listing office.bas
  impact88 verify printout.txt --report case.html --case 17/88
  impact88 run --sample 1 | impact88 verify -       - is standard input

exit status: 0 identical; 1 any other verdict; 2 unreadable; of several files the highest
"""

from __future__ import annotations

import sys

from ... import files
from ...errors import UserError, note
from . import options

TYPE_CHECKING = False
if TYPE_CHECKING:
    from ...printouts.reporting.examination import Examined

_ON_REPORT = ("date", "case", "examiner")

ARGUMENTS = (
    options.reads("printouts", "PRINTOUT", "text, picture or PDF", nargs="+"),
    options.flag("--json", "print one JSON object per printout"),
    options.OUTPUT,
    options.flag("--brief", "only verdicts and what differs"),
    options.reads("--scene", "FILE.toml", "the inputs, for a page that has only results"),
    options.reads("--listing", "THEIRS.bas", "compare pages with another copy of the listing"),
    options.writes("--report", "FILE.html", "write a page for the case file"),
    options.sample_option("the inputs are those of a published run"),
    options.setting("change a value of these inputs"),
    options.UNITS,
    *(
        options.value(f"--{name}", None, f"{name} printed on the report, as given")
        for name in _ON_REPORT
    ),
)


def main(args: options.Args) -> int:
    for option in _ON_REPORT:
        if getattr(args, option) and not args.report:
            raise UserError(f"--{option} is for the report; expected --report FILE.html with it")
    if args.report:
        from ...casework.report.frame import check_page_name

        check_page_name(args.report)
    from ...printouts.reporting.examination import Verdict, examine

    has_inputs = args.scene or args.sample or args.set
    inputs = dict(options.one_scene(args)) if has_inputs else None
    copy = None
    if args.listing:
        from ...program.copies import ListingCopy

        copy = ListingCopy(args.listing)
    status = 0
    files_examined = []
    for path in args.printouts:
        file = examine(path, inputs, copy)
        files_examined.append(file)
        _show(file, args)
        adverse = any(result.verdict is not Verdict.IDENTICAL for result in file.results)
        status = max(status, 2 if file.error else int(adverse))
    if args.report and any(file.results for file in files_examined):
        from ...casework.report.casefile import report

        page = report(files_examined, **{name: getattr(args, name) for name in _ON_REPORT})
        with files.replacing(args.report) as out:
            out.write(page)
    return status


def _show(file: Examined, args: options.Args) -> None:
    if file.error:
        note("verify", file.error)
    if args.json:
        for record in file.as_json():
            options.print_json("verify", record)
    else:
        from ...printouts.reporting.verification import lines

        for result in file.results:
            print("\n".join(lines(result, args.brief)))
    sys.stdout.flush()
