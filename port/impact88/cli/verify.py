"""impact88 verify printout.txt                      verdict, findings, what explains them
impact88 verify scan.png                          the same of a picture or PDF
impact88 verify --brief box7/*.txt                verdicts and findings alone
impact88 verify results.txt --scene crash.toml    inputs of a page with results only
impact88 verify printout.txt --report page.html   a page for the case file
impact88 run --sample 1 | impact88 verify -       - is standard input

Reads a printout, recovers its inputs, runs the 1988 program on them and compares every character.

  IDENTICAL                 every label and number is what the program prints
  IDENTICAL AS FAR AS READ  what was read is the program's; doubts are listed
  INCOMPLETE                numbers are missing or were not read, and the others do not decide
  DIFFERS                   the page is not what the program prints for its inputs

Pictures (PNG, JPEG, TIFF, PDF) need pip install 'impact88[pictures]'.

exit status: 0 identical; 1 any other verdict; 2 a file that cannot be read"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from glob import glob
from typing import TYPE_CHECKING

from ..errors import UserError, note
from ..files import display_name, read_bytes
from ..layout import paragraph
from . import options
from .output import print_json

if TYPE_CHECKING:
    from ..report.exhibits import Exhibit

IDENTICAL = "IDENTICAL"


def declare(parser: options.Parser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "printouts", nargs="+", type=options.InputPath, metavar="FILE", help="text, picture or PDF"
    )
    parser.add_argument("--brief", action="store_true", help="verdicts and findings alone")
    parser.add_argument(
        "--scene",
        dest="file",
        type=options.InputPath,
        metavar="FILE.toml",
        help="the inputs, for a page with results only",
    )
    options.add_sample(parser)
    options.add_set(parser)
    options.add_view(parser)
    parser.add_argument(
        "--listing",
        type=options.InputPath,
        metavar="FILE.bas",
        help="the copy of the listing that printed the pages",
    )
    parser.add_argument(
        "--report", type=options.OutputPath, metavar="FILE.html", help="write a page for the case"
    )
    for name in ("case", "examiner", "date"):
        parser.add_argument(f"--{name}", default="", help="heading of that page")
    options.add_json(parser)
    options.add_output(parser)


def main(args: options.Args) -> int:
    """Verify printouts."""
    given = None
    if args.file or args.sample or args.set:
        given = options.case_of(args).texts
    status, exhibits = 0, []
    for path in _paths(args.printouts):
        try:
            found = examine(display_name(path), read_bytes(path), given, args.listing)
        except UserError as error:
            note("verify", str(error))
            status = 2
            continue
        exhibits += found
        for exhibit in found:
            status = max(status, int(exhibit.verdict != IDENTICAL))
            if args.json:
                print_json("verify", _record(exhibit))
            else:
                print("\n".join(_lines(exhibit, args.brief)))
    if args.report and exhibits:
        from ..report.casepage import verification_page

        headings = {"number": args.case, "examiner": args.examiner, "date": args.date}
        with options.printing_to(args.report):
            print(verification_page(exhibits, **headings), end="")
    return status


def _paths(names: list[str]) -> list[str]:
    """Return the files that names stand for; patterns are for shells that do not expand them."""
    return [path for name in names for path in sorted(glob(name)) or [name]]


def _record(exhibit: Exhibit) -> dict[str, object]:
    """Return an exhibit as an object for JSON, without its picture."""
    record = asdict(exhibit)
    record.pop("picture")
    return record


def _lines(exhibit: Exhibit, is_brief: bool) -> Iterator[str]:
    """Yield the lines of an exhibit."""
    yield f"{exhibit.source}: {exhibit.verdict}"
    if not is_brief:
        yield from paragraph(exhibit.meaning, "", 2)
    for heading, sentences in exhibit.sections.items():
        if sentences and heading and not is_brief:
            yield f"  {heading}"
        for sentence in sentences:
            yield from paragraph(sentence, "", 4 if heading else 2)
    yield ""
