"""impact88 report crash.toml -o case.html     a page for the case file: answer, drawing, inputs
impact88 report crash.toml -o scene.svg     the drawing alone; also .png
impact88 report --sample 1 -o run.html

FILE.toml is any collision that impact88 solve answers. The page is one file, made to be printed on
two sheets: question, answer with intervals, drawing to scale, inputs with their sources, method,
and what is not judged. case = "24-117", title, examiner and date in the file head it, and
UX_source = "event data recorder" says where a value comes from. The same input and version give the
same bytes. Needs pip install '.[report]' in the checkout.

exit status: 0 written; 1 written, but no impact that physics allows agrees; 2 bad input"""

from __future__ import annotations

from .options import CASE, OUTPUT, Args, case_of

OPTIONS = (*CASE, OUTPUT)
WRITES = True


def main(args: Args) -> bool:
    """Write a page or a drawing."""
    from ..report.answers import ask
    from ..report.casepage import write

    answer = ask(case_of(args))
    write(answer, args.output)
    return not answer.possible
