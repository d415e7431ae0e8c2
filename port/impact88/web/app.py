"""The pages: Printout, Collision, 1988.

Every page is HTML made here. htmx sends a form and puts the answer into the page; a form that is
sent without it gives the answer as a page of its own. Nothing of a request is kept.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flask import Flask, Response, abort, render_template, request
from jinja2 import ChoiceLoader, PackageLoader

from ..cases import TEMPLATES, Case, View
from ..cases.scenefile import ABOUT, INPUTS, read_toml
from ..errors import UserError, printable
from ..files import decode
from ..program.run import run
from ..program.scene import sample
from ..report.answers import ask
from ..report.casepage import case_page, drawing_of, verification_page
from ..report.exhibits import Exhibit, examine
from ..report.pages import environment
from .guard import HEADERS, MAX_BODY, PAGE_POLICY, REPORT_POLICY, is_foreign
from .questions import answer_in_time

DEFAULT_KIND = "planar"
HEADINGS = ("title", "case", "examiner", "date")
"""Entries for a report."""
SHOWN = (*HEADINGS, "units", "axes", "headings")
"""Entries about the whole case that have a field."""


def application(port: int, token: str) -> Flask:
    """Return the application that answers at 127.0.0.1:``port`` below ``token``."""
    app = Flask(__name__, static_url_path=f"/{token}/static")
    app.config.update(MAX_CONTENT_LENGTH=MAX_BODY, MAX_FORM_MEMORY_SIZE=MAX_BODY)
    reports = environment()
    loader = ChoiceLoader([PackageLoader(__package__), reports.loader])  # type: ignore[list-item]
    app.jinja_env = reports.overlay(loader=loader)  # type: ignore[assignment]
    context = {"root": f"/{token}", "kinds": TEMPLATES, "headings": HEADINGS}
    app.context_processor(lambda: context)

    @app.before_request
    def check() -> None:
        if is_foreign(request, port):
            abort(403)

    @app.after_request
    def protect(response: Response) -> Response:
        response.headers.setdefault("Content-Security-Policy", PAGE_POLICY)
        response.headers.update(HEADERS)
        return response

    app.register_error_handler(UserError, _problem)
    for path, page in {"": printout, "collision": collision, "1988": program}.items():
        app.get(f"/{token}/{path}")(page)
    for reply in (verify, verification, fields, answer, report, scene, printed):
        app.post(f"/{token}/{reply.__name__}")(reply)
    return app


def _problem(error: UserError) -> tuple[str, int]:
    """Return the message on bad input. Flask answers and logs errors of this program itself."""
    return _show("problem.html", message=str(error)), 422


def _show(part: str, **context: Any) -> str:
    """Return a part of a page to htmx, and else a page of that part alone."""
    name = part if "HX-Request" in request.headers else "layout.html"
    return render_template(name, part=part, **context)


def _report(page: str) -> Response:
    """Return a report, which has a policy of its own."""
    return Response(page, headers={"Content-Security-Policy": REPORT_POLICY})


def _upload() -> tuple[str, bytes] | None:
    """Return name and bytes of the file in a form, None without one."""
    file = request.files.get("file")
    return (printable(file.filename), file.read()) if file and file.filename else None


def printout() -> str:
    """Return the page for printouts."""
    return render_template("printout.html")


def _exhibits() -> list[Exhibit]:
    """Return the verified printouts of a form. Raises UserError."""
    text = request.form.get("text", "")
    name, data = _upload() or ("pasted text", text.encode())
    if not data.strip():
        raise UserError("nothing to verify; expected a file, or the text of a printout")
    return answer_in_time(lambda: examine(name, data))


def verify() -> str:
    """Return the verdicts on the printouts of a text, picture or PDF."""
    return _show("verdicts.html", exhibits=_exhibits())


def verification() -> Response:
    """Return the report on the printouts."""
    return _report(verification_page(_exhibits(), request.form))


def collision() -> str:
    """Return the page for collisions."""
    return render_template("collision.html", **_fields({"units": "us"}))


def _fields(texts: Mapping[str, str], kind: str = DEFAULT_KIND) -> dict[str, Any]:
    """Return what the fields of a kind show; entries without a field follow as text."""
    kind = kind if kind in TEMPLATES else DEFAULT_KIND
    names = TEMPLATES[kind].entries
    lines = [f"{n} = {x}" for n, x in texts.items() if n not in (*names, *SHOWN)]
    return {
        "kind": kind,
        "names": names,
        "values": names | dict(texts),
        "more": "\n".join(lines),
        "view": View.of(units=texts.get("units")),
    }


def _texts() -> dict[str, str]:
    """Return the entries of a form: of its fields, and of lines NAME = VALUE. Raises UserError."""
    form = request.form
    texts = {name: form[name] for name in (*ABOUT, *INPUTS) if form.get(name, "").strip()}
    for line in filter(str.strip, form.get("more", "").splitlines()):
        name, separator, text = line.partition("=")
        if not separator:
            raise UserError(f"{line!r}; expected NAME = VALUE", "more entries")
        texts[name.strip()] = text.strip(" \"'")
    return texts


def fields() -> str:
    """Return the fields: of a file that was opened, else of another kind or unit."""
    upload = _upload()
    if upload:
        source, data = upload
        texts, _ = read_toml(decode(data, source), source)
        entries = [entry for entry in texts.items() if entry[1] != "0"]
        # the kind that has most of its names, and of its entries but zeros
        kinds = {name: {*kind.entries, *kind.entries.items()} for name, kind in TEMPLATES.items()}
        kind = max(kinds, key=lambda name: len(kinds[name] & {*texts, *entries}))
    else:
        former = TEMPLATES.get(request.form.get("was", ""), TEMPLATES[DEFAULT_KIND]).entries
        texts = {n: text for n, text in _texts().items() if text != former.get(n)}
        kind = request.form.get("kind", "")
    return _show("fields.html", **_fields(texts, kind))


def _case() -> Case:
    """Return the case of a form. Raises UserError."""
    return Case.of(_texts(), "the form")


def answer() -> str:
    """Return the answer to a form, with its drawing."""
    case = _case()
    result = answer_in_time(lambda: ask(case))
    return _show("answer.html", answer=result, drawing=drawing_of(result))


def report() -> Response:
    """Return the report on a form's case."""
    case = _case()
    return _report(answer_in_time(lambda: case_page(ask(case))))


def scene() -> Response:
    """Return a form's case as a file."""
    headers = {"Content-Disposition": 'attachment; filename="case.toml"'}
    return Response(_case().toml(), headers=headers, content_type="application/toml")


def program() -> str:
    """Return the page of the 1988 program, with the replies of the book's first run."""
    return render_template("program.html", texts=sample(1))


def printed() -> str:
    """Return what the 1988 program prints for a form's case."""
    case = _case()
    page = run(case.texts).page
    return _show("printed.html", printed=page, case=case)
