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

Pictures (PNG, JPEG, TIFF, PDF) need pip install '.[pictures]' in the checkout.

exit status: 0 identical; 1 any other verdict; 2 a file that cannot be read"""

from __future__ import annotations

from collections.abc import Mapping
from glob import glob

from ..cases.case import Case
from ..errors import UserError, note
from ..files import display_name, read_bytes
from ..printouts import Verdict, words
from ..report.exhibits import Exhibit, examine
from .options import JSON, OUTPUT, Args, OutputPath, flag, input_file, option, printing_to
from .output import show

UNUSABLE = 2  # exit status
HEADINGS = ("case", "examiner", "date")
"""Headings of the report, as options."""
OPTIONS = (
    input_file("printouts", "FILE", "text, picture or PDF", nargs="+"),
    flag("--brief", "verdicts and findings alone"),
    input_file("--scene", "FILE.toml", "the inputs, for a page with results only"),
    input_file("--listing", "FILE.bas", "the office's own copy of the listing"),
    option("--report", type=OutputPath, metavar="FILE.html", help="write a page for the case"),
    *(option(f"--{name}", default="", help="heading of that page") for name in HEADINGS),
    JSON,
    OUTPUT,
)


def main(args: Args) -> int:
    """Verify printouts."""
    scene = Case.load(args.scene).texts if args.scene else None
    exhibits: list[Exhibit] = []
    is_unusable = False
    for path in (path for name in args.printouts for path in sorted(glob(name)) or [name]):
        try:
            exhibits += _verify_file(args, display_name(path), read_bytes(path), scene)
        except UserError as error:
            note("verify", str(error))
            is_unusable = True
    if is_unusable:
        return UNUSABLE
    if args.report:
        from ..report.casepage import verification_page

        with printing_to(args.report):
            print(verification_page(exhibits, vars(args)), end="")
    return any(item.result.verdict is not Verdict.IDENTICAL for item in exhibits)


def _verify_file(
    args: Args, name: str, data: bytes, scene: Mapping[str, str] | None
) -> list[Exhibit]:
    """Print and return the printouts of a file."""
    exhibits = examine(name, data, scene, args.listing or "")
    for exhibit in exhibits:
        lines = words.write(exhibit.result, name, exhibit.number, args.brief)
        record = words.record(exhibit.result, name, exhibit.number, exhibit.digest)
        if args.brief and exhibit.result.unseen:
            lines.append(f"  errors this page could not reveal: {' '.join(exhibit.result.unseen)}")
        if exhibit.page:
            lines += [f"  {remark}" for remark in exhibit.page.remarks]
            record |= exhibit.page.places()
        show(args, "verify", record, [*lines, ""])
    return exhibits
