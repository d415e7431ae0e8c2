"""impact88 verify printout.txt                      verdict, findings, what explains them
impact88 verify scan.png                          the same of a picture or PDF
impact88 verify --brief box7/*.txt                verdicts and findings alone
impact88 verify results.txt --scene crash.toml    inputs of a page with results only
impact88 verify printout.txt --listing office.bas an office's copy of the listing printed it
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

from collections.abc import Iterator, Mapping
from glob import glob
from hashlib import sha256
from typing import TYPE_CHECKING

from ..errors import UserError, note
from ..files import display_name, read_bytes
from . import options
from .output import print_json

if TYPE_CHECKING:
    from ..report.exhibits import Exhibit

HEADINGS = {"number": "case", "examiner": "examiner", "date": "date"}
"""Headings of the page, and the options that give them."""


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
        help="an office's own copy of the listing, which printed the page",
    )
    parser.add_argument(
        "--report", type=options.OutputPath, metavar="FILE.html", help="write a page for the case"
    )
    for name in HEADINGS.values():
        parser.add_argument(f"--{name}", default="", help="heading of that page")
    options.add_json(parser)
    options.add_output(parser)


def main(args: options.Args) -> int:
    """Verify printouts."""
    given: Mapping[str, str] | None = None
    if args.file or args.sample or args.set:
        given = options.case_of(args).texts
    status, exhibits = 0, []
    for path in (path for name in args.printouts for path in sorted(glob(name)) or [name]):
        try:
            data = read_bytes(path)
            found = [*_verified(args, display_name(path), data, given)]
        except UserError as error:
            note("verify", str(error))
            status = 2
            continue
        exhibits += found
        adverse = any(exhibit.verdict != "IDENTICAL" for exhibit in found)
        status = max(status, int(adverse))
    if args.report and exhibits:
        from ..report.casepage import verification_page

        headings = {name: getattr(args, option) for name, option in HEADINGS.items()}
        with options.printing_to(args.report):
            print(verification_page(exhibits, **headings), end="")
    return status


def _verified(
    args: options.Args, name: str, data: bytes, given: Mapping[str, str] | None
) -> Iterator[Exhibit]:
    """Print and yield the printouts of a file."""
    from ..printouts import verify, words
    from ..report.exhibits import PICTURE_STARTS, of_picture, of_text, read_picture

    digest = sha256(data).hexdigest()
    if data.startswith(PICTURE_STARTS):
        if args.listing:
            raise UserError("--listing goes with texts, not with pictures", name)
        for number, page in enumerate(read_picture(name, data, given), 1):
            if args.json:
                record = words.record(page.verification, name, number, digest)
                print_json("verify", {**record, **page.places()})
            else:
                lines = words.write(page.verification, name, number, args.brief)
                print("\n".join([*lines, *(f"  {remark}" for remark in page.remarks), ""]))
            yield of_picture(page, f"{name}, printout {number}", digest)
        return
    try:
        results = verify(data, given, args.listing)
    except UserError as error:
        raise UserError(str(error).removeprefix("text: "), name) from None
    for number, result in enumerate(results, 1):
        if args.json:
            print_json("verify", words.record(result, name, number, digest))
        else:
            print("\n".join([*words.write(result, name, number, args.brief), ""]))
        yield of_text(result, f"{name}, printout {number}", digest)
