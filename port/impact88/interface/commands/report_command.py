"""FILE.toml is a scene or a file for reconstruct (impact88 scene --help, impact88 reconstruct
--help). A whole scene gives the velocities after the impact; any other file is reconstructed.

The page stands in one file and is made to be printed. The first sheet is for a judge: what was
asked, what was found and how sure it is, the verdict on the evidence, up to four numbers, the
drawing to scale, remarks. Then each measured value beside its adjusted one, inputs as given with
tolerances and sources, what drives the result, method, validation, versions and hashes, a line to
sign.
In the file, case = "24-117" is the case's number, and UX_source = "event data recorder" (or UX =
{value = "-25 mph", source = "event data recorder"}) says where a value comes from.

Chromium and Safari print the case number and "page 2 of 4" in the margins. Firefox has no such
margins: leave its own header and footer on there, which number the pages, or print from another.

The same input, options and version give the same bytes.

examples:
  impact88 report crash.toml -o case.html
  impact88 report crash.toml -o case.html --case 24-117 --paper a4 --seed 7
  impact88 report after.toml -o case.html
  impact88 report crash.toml -o case.html --set MU=.5    a value changed

exit status: 0 written; 1 written, but NO IMPACT that physics allows agrees, known values contradict
one another, or no velocity before the impact was found; 2 bad input
"""

from ...collision.case import Case
from ...collision.casescene import sample
from ...collision.scenefile import MAX_TOML_BYTES, template, toml_texts
from ...errors import UserError
from ...files import decode, read_bytes, replacing
from . import options

ARGUMENTS = (
    *options.KNOWN,
    options.SAMPLE,
    options.writes("-o --output", "FILE.html", "the page", required=True),
    options.value("--case", "NUMBER", "the case number", default=""),
    options.value("--title", "TEXT", "the title of the page", default=""),
    options.value("--examiner", "NAME", "who made it, printed as given", default=""),
    options.value("--date", "TEXT", "the date, printed as given", default=""),
    options.choice(
        "--paper",
        ("letter", "a4"),
        "paper size (default: letter for us units, else a4)",
        default="",
    ),
    *options.draws(20_000),
)

_ON_PAGE = ("samples", "seed", "title", "paper", "examiner", "date")


def main(args: options.Args) -> int:
    from ...casework.report.findings import report
    from ...casework.report.frame import check_page_name

    check_page_name(args.output)
    source = options.source_of(args)
    if source is None or bool(args.scene) == bool(args.sample):
        raise UserError(options.ONE_EXPECTED)
    chosen = (args.units, args.axes, args.headings)
    if args.sample:
        case = sample(args.sample).case.shown_in(*chosen)
        data = template(case).encode()
    else:
        data = read_bytes(args.scene, MAX_TOML_BYTES)
        case = Case(toml_texts(decode(data, source), source), source, *chosen)
    changes = options.set_pairs(args.set)
    case = options.change_case(case, changes, "--set")
    case = case.with_sources({n: "changed with --set" for n in changes if n in case.given})
    options.note_remarks(case)
    keywords = {n: getattr(args, n) for n in _ON_PAGE}
    keywords["number"] = args.case
    page, adverse = report(case, source, data, **keywords)
    with replacing(args.output) as out:
        out.write(page)
    return int(adverse)
