"""impact88 report crash.toml -o case.html     a page for the case file: answer, drawing, inputs
impact88 report crash.toml -o scene.svg     the drawing alone; also .png
impact88 report --sample 1 -o run.html --paper letter

FILE.toml is any collision that impact88 solve answers. The page is one file, made to be printed on
two sheets: question, answer with intervals, drawing to scale, inputs with their sources, method,
and what is not judged. case = "24-117", title, examiner and date in the file head it, and
UX_source = "event data recorder" says where a value comes from. The same input and version give the
same bytes. Pages and .png need pip install 'impact88[report]'.

exit status: 0 written; 1 written, but no impact that physics allows agrees; 2 bad input"""

from __future__ import annotations

import os

from ..errors import UserError
from ..files import replacing
from . import options

ENDINGS = (".html", ".svg", ".png")


def declare(parser: options.Parser) -> None:
    """Add the arguments."""
    options.add_case(parser)
    parser.add_argument(
        "-o",
        "--output",
        dest="target",
        type=options.OutputPath,
        required=True,
        metavar="FILE",
        help="the file to write: .html, .svg or .png",
    )
    options.add_seed(parser)


def main(args: options.Args) -> int:
    """Write a page or a drawing."""
    ending = os.path.splitext(args.target)[1].lower()
    if ending not in ENDINGS:
        raise UserError(f"ends in {ending!r}; expected one of {' '.join(ENDINGS)}", args.target)
    from ..report import casepage, drawing
    from ..report.answers import ask

    case = options.case_of(args)
    answer = ask(case, full=True, seed=args.seed)
    if ending == ".html":
        data = casepage.page(answer).encode()
    elif ending == ".svg":
        data = drawing.draw(answer, titled=True).encode()
    else:
        data = drawing.to_png(drawing.draw(answer, titled=True))
    with replacing(args.target, "wb") as file:
        file.write(data)
    return int(not answer.possible)
