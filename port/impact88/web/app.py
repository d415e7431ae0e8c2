"""The pages: Printout, Collision, 1988.

Every page is HTML made here. htmx sends a form and puts the answer into the page; without scripts
the same forms give whole pages. Nothing of a request is kept.
"""

from __future__ import annotations

import io
import os
import traceback
from collections.abc import Callable, Mapping
from typing import Any

from flask import Flask, Request, Response, abort, redirect, render_template, request
from jinja2 import ChoiceLoader
from markupsafe import Markup
from werkzeug.exceptions import HTTPException

from ..cases import TEMPLATES, Case
from ..cases.scenefile import ABOUT, INPUTS, read_toml
from ..errors import UserError, printable
from ..files import decode
from ..names import SCENE
from ..program.run import run
from ..program.scene import sample
from ..report.answers import ask
from ..report.casepage import case_page, environment, verification_page
from ..report.drawing import draw
from ..report.exhibits import Exhibit, examine
from .guard import HEADERS, MAX_BODY, REPORT_POLICY, refusal
from .questions import answer_in_time

KINDS = {name: kind for name, kind in TEMPLATES.items() if kind.command == "solve"}
"""Kinds of collision that the page has fields for."""
GROUPS = (
    ("Vehicle A", "MA IA DA PA TA LA BA".split()),
    ("Vehicle B", "MB IB DB PB TB LB BB".split()),
    ("Before the impact", "SA HA UX UY WA SB HB VX VY WB".split()),
    ("After the impact", "SAF HAF VAX VAY WAF SBF HBF VBX VBY WBF".split()),
    ("Contact", "GA E MU EM M".split()),
)
"""Order of the fields."""
CHOICES = {
    "units": {"us": "mph, lb, ft", "metric": "km/h, kg, m", "chapter": "ft/s, slug, ft"}
    | {"si": "m/s, kg, m", "": "none"},
    "axes": {"": "the chapter's", "sae": "SAE"},
    "headings": {"": "from the x axis", "compass": "compass"},
}
"""Choices of how numbers are written, with their words."""
HEADINGS = ("title", "case", "examiner", "date")
"""Entries for the report."""
MORE = "more"
"""Field for entries in the notation of a file."""


class MemoryRequest(Request):
    """A request whose uploads stay in memory."""

    def _get_file_stream(self, *_: Any, **__: Any) -> io.BytesIO:
        return io.BytesIO()


def application(port: int, token: str, entry: str = "") -> Flask:
    """Return the application that answers at 127.0.0.1:``port`` below ``token``.

    ``entry``: a path that leads to the first page, once.
    """
    app = Flask(__name__, static_url_path=f"/{token}/static")
    app.request_class = MemoryRequest
    app.config["MAX_CONTENT_LENGTH"] = MAX_BODY
    app.config["MAX_FORM_MEMORY_SIZE"] = MAX_BODY
    reports = environment()
    app.jinja_options = {"trim_blocks": True, "lstrip_blocks": True}
    app.jinja_loader = ChoiceLoader([app.jinja_loader, reports.loader])  # type: ignore[list-item]
    app.jinja_env.filters.update(reports.filters)
    app.jinja_env.globals["root"] = f"/{token}"
    entries = {entry} - {""}

    @app.before_request
    def check() -> Response | None:
        place = request.path.removeprefix("/")
        is_entry = place in entries
        first = token if is_entry else request.path
        status = refusal(dict(request.headers), request.method, first, port=port, token=token)
        if status:
            abort(status)
        if is_entry:
            entries.discard(place)
            return redirect(f"/{token}/", 303)  # type: ignore[return-value]
        return None

    @app.after_request
    def protect(response: Response) -> Response:
        policy = response.headers.get("Content-Security-Policy")
        response.headers.update(HEADERS)
        if policy:
            response.headers["Content-Security-Policy"] = policy
        return response

    app.register_error_handler(UserError, _problem)
    app.register_error_handler(Exception, _internal_error)
    for rule, view in VIEWS.items():
        methods = ["GET"] if rule in PAGES else ["POST"]
        app.add_url_rule(f"/{token}/{rule}", rule or "printout", view, methods=methods)
    return app


def _problem(error: UserError) -> tuple[str, int]:
    """Return the message on unusable input."""
    return _page_or_part("problem.html", message=str(error)), 422


def _internal_error(error: Exception) -> Any:
    """Return the message on an error of this program, with its place; refusals as they are."""
    if isinstance(error, HTTPException):
        return error
    if os.environ.get("IMPACT88_DEBUG") == "1":
        traceback.print_exception(error)
    step = traceback.extract_tb(error.__traceback__)[-1]
    place = f"{os.path.basename(step.filename)}:{step.lineno}"
    message = f"internal error; please report it: {type(error).__name__}: {error} at {place}"
    return _page_or_part("problem.html", message=printable(message)), 500


def _page_or_part(part: str, page: str = "", **context: Any) -> str:
    """Return a part of a page to htmx, and a whole page to a browser without scripts."""
    if "HX-Request" in request.headers:
        return render_template(part, **context)
    return render_template("layout.html", part=part, page=page, **context)


def printout() -> str:
    """Return the page for printouts."""
    return render_template("printout.html", page="printout")


def _exhibits() -> list[Exhibit]:
    """Return the verified printouts of the request. Raises UserError."""
    file = request.files.get("file")
    text = request.form.get("text", "")
    if file and file.filename:
        name, data = printable(file.filename), file.read()
    elif text.strip():
        name, data = "pasted text", text.encode()
    else:
        raise UserError("nothing to verify; expected a file, or the text of a printout")
    return answer_in_time(lambda: examine(name, data))


def verify() -> str:
    """Return the verdicts on the printouts of a text, picture or PDF."""
    return _page_or_part("verdicts.html", "printout", exhibits=_exhibits())


def verification() -> Response:
    """Return the report on the printouts."""
    headings = {"number" if n == "case" else n: request.form.get(n, "") for n in HEADINGS[1:]}
    return _report(verification_page(_exhibits(), **headings))


def _report(page: str) -> Response:
    """Return a report, which has a policy of its own."""
    return Response(page, headers={"Content-Security-Policy": REPORT_POLICY})


def collision() -> str:
    """Return the page for collisions."""
    return render_template("collision.html", page="collision", **_fields({"units": "us"}, "planar"))


def _fields(texts: Mapping[str, str], kind: str) -> dict[str, Any]:
    """Return what the fields of a kind show; entries without a field follow as text."""
    kind = kind if kind in KINDS else "planar"
    values = KINDS[kind].entries | dict(texts)
    names = [n for n in KINDS[kind].entries if n in INPUTS]
    groups = [(title, [n for n in members if n in names]) for title, members in GROUPS]
    shown = {*names, *HEADINGS, *CHOICES}
    more = "\n".join(f"{n} = {text}" for n, text in texts.items() if n not in shown)
    view = Case.of({n: values[n] for n in CHOICES if values.get(n)}).view
    return {
        "kind": kind,
        "kinds": KINDS,
        "choices": CHOICES,
        "groups": [(title, members) for title, members in groups if members],
        "values": values,
        "more": more,
        "meanings": {n: INPUTS[n].meaning for n in names},
        "units": {n: view.unit(n) for n in names},
        "headings": HEADINGS,
    }


def _texts() -> dict[str, str]:
    """Return the entries of the form. Raises UserError for a line without a name and a value."""
    form = request.form
    texts = {n: form[n].strip() for n in (*ABOUT, *INPUTS) if form.get(n, "").strip()}
    for number, line in enumerate(form.get(MORE, "").splitlines(), 1):
        name, separator, text = (part.strip() for part in line.partition("="))
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        if not separator or not name:
            raise UserError(f"{line.strip()!r}; expected NAME = VALUE", f"more, line {number}")
        texts[name] = text.strip("\"'")
    return texts


def _case() -> Case:
    """Return the case of the form. Raises UserError."""
    return Case.of(_texts(), "the form")


def fields() -> str:
    """Return the fields: of a file that was opened, else of another kind or unit."""
    file = request.files.get("file")
    if file and file.filename:
        source = printable(file.filename)
        texts, _ = read_toml(decode(file.read(), source), source)
        Case.of(texts, source)
        kind = _kind_of(texts)
    else:
        former = KINDS.get(request.form.get("was", ""), KINDS["planar"]).entries
        texts = {n: text for n, text in _texts().items() if text != former.get(n)}
        kind = request.form.get("kind", "planar")
    context = _fields(texts, kind)
    if "HX-Request" in request.headers:
        return render_template("fields.html", **context)
    return render_template("collision.html", page="collision", **context)


def _kind_of(texts: Mapping[str, str]) -> str:
    """Return the kind of collision whose fields take the most entries of a file, and no more."""
    return max(KINDS, key=lambda k: (len(texts.keys() & KINDS[k].entries), -len(KINDS[k].entries)))


def answer() -> str:
    """Return the answer to the form, with its drawing."""
    case = _case()
    result = answer_in_time(lambda: ask(case))
    drawing, undrawn = Markup(), ""
    try:
        drawing = Markup(draw(result))
    except UserError as error:
        undrawn = str(error)
    return _page_or_part(
        "answer.html", "collision", answer=result, drawing=drawing, undrawn=undrawn
    )


def report() -> Response:
    """Return the report on the form's case."""
    case = _case()
    return _report(case_page(answer_in_time(lambda: ask(case))))


def scene() -> Response:
    """Return the form's case as a file."""
    headers = {"Content-Disposition": 'attachment; filename="case.toml"'}
    return Response(_case().toml(), headers=headers, content_type="application/toml")


def program() -> str:
    """Return the page of the 1988 program."""
    number = request.args.get("sample", "")
    texts = dict(sample(int(number))) if number in ("1", "2", "3") else {}
    return render_template("program.html", page="1988", texts=texts, **_program_context())


def _program_context() -> dict[str, Any]:
    """Return the inputs of the program in its order, with their meanings."""
    return {"inputs": {n: INPUTS[n].meaning for n in SCENE}}


def printed() -> str:
    """Return what the 1988 program prints for the form's case."""
    case = _case()
    texts = case.texts
    page = answer_in_time(lambda: run(texts).page)
    if "HX-Request" in request.headers:
        return render_template("printed.html", printed=page, case=case)
    return render_template(
        "program.html", page="1988", texts=texts, printed=page, case=case, **_program_context()
    )


PAGES = {"": printout, "collision": collision, "1988": program}
VIEWS: dict[str, Callable[[], Any]] = PAGES | {
    "verify": verify,
    "verification": verification,
    "fields": fields,
    "answer": answer,
    "report": report,
    "scene": scene,
    "printed": printed,
}
"""Views by their paths below the token."""
