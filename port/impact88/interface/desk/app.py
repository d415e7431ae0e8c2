"""The desk's addresses, all below the token.

The page is read once; its scripts then send JSON or a file's bytes, and receive JSON or a file.
Unusable input is status 400 with ``{"problem": ...}``, the sentence a command would print; a
question replaced by a newer one is 409.
"""

import json
import math
import re
import threading
from base64 import b64decode
from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import Any

import flask
from flask import Blueprint, Flask, Response, abort, request
from flask.json.provider import DefaultJSONProvider
from jinja2 import ChoiceLoader, PackageLoader
from markupsafe import Markup, escape
from werkzeug.exceptions import HTTPException

from ...collision.casescene import SAMPLES, sample
from ...collision.scenefile import CASES, SIGNS
from ...errors import UserError
from ...files import packaged_text
from ...mechanics.state import KNOWABLE
from ...messages.plaintable import number
from ...names import DEFAULT_M, SCENE, quantity
from ...version import __version__
from . import collision, reconstruction
from .formview import convert_values, digits, filled_in, to_fill_in
from .guard import HEADERS, LARGEST_BODY, TOO_LONG, refusal
from .workers import Bench, BrokenError, SupersededError

BENCHES = {
    "edit": "paper",
    "paper": "paper",
    "bounds": "collision",
    "reconstruction": "reconstruction",
    "report": "collision",
}
"""Kinds of slow work, and the module that does each, in a process of its own: an edited text
overtakes waiting papers, and a case report is not ended by newer ranges."""
_FORM = ("values", "units")

GROUPS = {
    "Vehicle A": "MA IA DA PA TA",
    "Vehicle B": "MB IB DB PB TB",
    "Before the impact, A": "UX UY WA",
    "Before the impact, B": "VX VY WB",
    "Contact and coefficients": "GA E MU EM M",
}
"""The form's parts: heading and quantities."""
KNOWN_GROUPS = {
    **dict(list(GROUPS.items())[:4]),
    "After the impact, A": "VAX VAY WAF",
    "After the impact, B": "VBX VBY WBF",
    "Contact": "GA M",
    "Coefficients": "E MU MUP EM",
}
MORE_GROUPS = {
    "Speed and course, A": "SA HA SAF HAF",
    "Speed and course, B": "SB HB SBF HBF",
    "Velocity change, A": "DVA DVAF DVAR",
    "Velocity change, B": "DVB DVBF DVBR",
    "Energy": "KI KF EL LOSS",
}
ALWAYS_KNOWN = frozenset("MA IA DA PA TA MB IB DB PB TB GA M".split())
"""Inputs that a reconstruction requires."""

SYSTEMS = {"us": "lb, mph, ft", "chapter": "slug, ft/s, ft"}
SYSTEMS |= {"metric": "kg, km/h, m", "si": "kg, m/s, m"}
"""The systems of units (`collision.units`), and what bare numbers are in them."""
REPORT_FIELDS = (("case", "Case"), ("examiner", "Examiner"), ("date", "Date"))
"""Entries about a case, and how they are called on the page."""
PUBLISHED = ("run1-as-printed.txt", "run2-as-printed.txt", "table3-as-printed.txt")
"""The published printouts, as they stand in the chapter."""


class Desk:
    """A bench for each kind of slow work."""

    def __init__(self) -> None:
        self.benches = {name: Bench(f"{__package__}.{module}") for name, module in BENCHES.items()}
        self._starts = [*(bench.warm for bench in self.benches.values()), collision.warm]

    def warm(self) -> None:
        """Start, once and in the background, what the first questions will need."""
        starts, self._starts = self._starts, []
        threading.Thread(target=lambda: [start() for start in starts], daemon=True).start()

    def close(self) -> None:
        for bench in self.benches.values():
            bench.close()


def symbol(text: str) -> Markup:
    """A symbol of the chapter as HTML: what follows ``_`` is a subscript."""
    return Markup(re.sub("_([A-Za-z0-9]+)", r"<sub>\1</sub>", str(escape(text))))


def unit(label: str) -> str:
    return {"1": "", "degree": "°", "deg": "°", "percent": "%"}.get(label, label)


def drivers(bound: Mapping[str, Any]) -> str:
    """Return the two inputs that change a result most, each with its swing."""
    swings = {n: (d["highest"] or 0) - (d["lowest"] or 0) for n, d in bound["drives"].items()}
    least = 1e-9 * abs((bound["upper"] or 0) - (bound["lower"] or 0))
    ranking = sorted(swings.items(), key=lambda entry: -entry[1])[:2]
    return ", ".join(f"{name} {number(swing, 3)}" for name, swing in ranking if swing > least)


class FiniteJSONProvider(DefaultJSONProvider):
    """JSON as browsers read it: a number that is none (a critical friction coefficient that is not
    defined) is null."""

    def dumps(self, obj: Any, **keywords: Any) -> str:
        """Return ``obj`` as JSON."""
        try:
            return super().dumps(obj, allow_nan=False, **keywords)
        except ValueError:
            return super().dumps(_without_nan(obj), allow_nan=False, **keywords)


def _without_nan(part: Any) -> Any:
    if isinstance(part, Mapping):
        return {name: _without_nan(value) for name, value in part.items()}
    if isinstance(part, list | tuple):
        return [_without_nan(value) for value in part]
    return None if isinstance(part, float) and not math.isfinite(part) else part


FILTERS: dict[str, Callable[..., Any]]
FILTERS = {"quantity": quantity, "symbol": symbol, "unit": unit}
FILTERS |= {"digits": digits, "drivers": drivers}


def application(desk: Desk, port: int, token: str) -> Flask:
    """The WSGI application that answers for ``desk`` at 127.0.0.1:``port``, below ``token``."""
    app = Flask(__name__, static_url_path=f"/{token}/static")
    app.json = FiniteJSONProvider(app)
    app.config["MAX_CONTENT_LENGTH"] = LARGEST_BODY
    app.jinja_env.filters |= FILTERS
    packages = (__package__ or "", "impact88.casework.report")
    app.jinja_loader = ChoiceLoader([PackageLoader(name) for name in packages])

    @app.before_request
    def refuse() -> Response | None:
        headers = request.headers
        status = refusal(headers, request.method, request.path, port=port, token=token)
        return Response("", status) if status else None

    @app.after_request
    def protect(response: Response) -> Response:
        response.headers.update(HEADERS)
        return response

    app.register_error_handler(Exception, _problem)
    app.register_blueprint(_addresses(desk), url_prefix=f"/{token}")
    return app


def _problem(error: Exception) -> Any:
    """Return an error as JSON, in the words a command would use."""
    if isinstance(error, UserError):
        return {"problem": str(error)}, 400
    if isinstance(error, SupersededError):
        return {"superseded": True}, 409
    if isinstance(error, HTTPException):
        return {"problem": TOO_LONG if error.code == 413 else error.name}, error.code or 500
    detail = str(error) if isinstance(error, BrokenError) else f"{type(error).__name__}: {error}"
    return {"problem": f"internal error of impact88 {__version__}; please report it: {detail}"}, 500


def _addresses(desk: Desk) -> Blueprint:
    """Return all addresses: those of the page, of papers, of a collision, of a reconstruction, and
    of files."""
    routes = Blueprint("desk", __name__)
    ask = partial(_ask, desk)
    _add_page(routes, desk)
    _add_papers(routes, ask)
    _add_collision(routes, ask)
    _add_reconstruction(routes, ask)
    _add_files(routes, ask)
    return routes


Ask = Callable[..., Any]
"""Asks a bench for the value of a function of its module: see `_ask`."""


def _ask(desk: Desk, bench: str, function: str, **arguments: Any) -> Any:
    return desk.benches[bench].ask(*_sender(), function, **arguments)


def _sender() -> tuple[str, int]:
    """Return which page asks, and in which turn; of those that count none, all are the same."""
    turn = request.headers.get("X-Desk-Turn", "")
    is_count = turn.isascii() and turn.isdecimal() and len(turn) < 16
    return request.headers.get("X-Desk-Page", "")[:64], int(turn) if is_count else 0


def _table(macro: str, content: Any) -> str:
    return str(flask.get_template_attribute("answers.html", macro)(content))


def _add_page(routes: Blueprint, desk: Desk) -> None:
    @routes.get("/")
    def whole_page() -> str:
        desk.warm()  # while the page is sent
        signs = [re.split("   +", line)[-1] for line in SIGNS.splitlines() if line.strip()]
        return flask.render_template(
            "desk.html",
            version=__version__,
            groups=GROUPS,
            known_groups=KNOWN_GROUPS,
            more_groups=MORE_GROUPS,
            always_known=ALWAYS_KNOWN,
            report_fields=REPORT_FIELDS,
            about_fields=[("title", "Title"), *REPORT_FIELDS],
            published=PUBLISHED,
            systems=SYSTEMS.items(),
            default_m=DEFAULT_M,
            signs=signs,
            cases=CASES,
            samples=[(number, sample(number).title) for number in SAMPLES],
        )

    @routes.get("/signs.svg")
    def signs() -> Response:
        from ...casework.figures.canvas import svg
        from ...casework.figures.views import planar

        return Response(svg(planar()), content_type="image/svg+xml")

    @routes.post("/stop/<bench>")
    def stop(bench: str) -> Any:
        if bench not in desk.benches:
            abort(404)
        desk.benches[bench].stop(*_sender())
        return {}


def _add_papers(routes: Blueprint, ask: Ask) -> None:
    @routes.post("/judge")
    def judge() -> Any:
        bench = "edit" if request.args.get("bench") == "edit" else "paper"
        query = {name: request.args.get(name, "") for name in ("name", "seed")}
        return ask(bench, "judge", data=request.get_data(), **query)

    @routes.post("/published/<name>")
    def published_printout(name: str) -> Response:
        if name not in PUBLISHED:
            abort(404)
        return _download(packaged_text("impact88.legacy", name), "text/plain", name)

    @routes.post("/report")
    def report() -> Response:
        parts = _parts("papers", "words")
        try:
            for paper in parts["papers"]:
                b64decode(paper.get("data", "?"), validate=True)
        except ValueError:
            raise UserError("'data' of a paper is not base 64") from None
        document = ask("edit", "report", **parts)
        return _download(document, "text/html", "report.html")


def _add_collision(routes: Blueprint, ask: Ask) -> None:
    routes.post("/solve/<int:which>")(collision.sample_scene)

    @routes.post("/collision")
    def collision_answer() -> Any:
        answer = collision.answer(**_parts(*_FORM))
        if "answer" in answer:
            answer["first"] = _table("first", answer["answer"])
            answer["all"] = _table("results", answer["results"])
        return answer

    @routes.post("/convert")
    def convert() -> Any:
        return {"values": convert_values(**_parts(*_FORM, "to"))}

    @routes.post("/figure")
    def figure() -> Response:
        drawing = collision.figure(**_parts(*_FORM, "title"))
        return Response(drawing, content_type="image/svg+xml")

    @routes.post("/bounds")
    def bounds() -> Any:
        document = ask("bounds", "bounds_answer", **_parts(*_FORM))
        return {"found": document, "table": _table("bounds", document)}


def _add_reconstruction(routes: Blueprint, ask: Ask) -> None:
    routes.post("/reconstruct/<int:which>")(reconstruction.known_of_sample)

    @routes.post("/reconstruct")
    def reconstruct() -> Any:
        answer = ask("reconstruction", "answer", **_parts(*_FORM))
        return {**answer, "tables": _table("solutions", answer["solutions"])}


def _add_files(routes: Blueprint, ask: Ask) -> None:
    """A form's file and case report; a file, or a kind of collision to fill in, into a form."""

    def file_of(view: str) -> tuple[str, str]:
        if view == "collision":
            return collision.scene_file(**_parts(*_FORM, "title")), "scene.toml"
        if view == "reconstruction":
            return reconstruction.known_file(**_parts(*_FORM)), "known.toml"
        abort(404)

    @routes.post("/file/<view>")
    def file(view: str) -> Response:
        text, name = file_of(view)
        return _download(text, "application/toml", name)

    @routes.post("/case-report/<view>")
    def case_report(view: str) -> Response:
        text, name = file_of(view)
        document = ask("report", "case_report", text=text, name=name)
        response = _download(document, "text/html", "case.html")
        response.headers["X-Case-File"] = name
        return response

    def file_read(names: Collection[str]) -> Any:
        return filled_in(request.get_data(), request.args.get("name", "the file")[:200], names)

    @routes.post("/template/<name>")
    def template(name: str) -> Any:
        if name not in CASES:
            abort(404)
        return to_fill_in(CASES[name])

    routes.post("/scene", endpoint="scene")(partial(file_read, SCENE))
    routes.post("/known", endpoint="known")(partial(file_read, KNOWABLE))


def _download(text: str, kind: str, name: str) -> Response:
    """Return a file that the browser saves under a name."""
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return Response(text.encode(), content_type=f"{kind}; charset=utf-8", headers=headers)


def _are_texts(value: object) -> bool:
    return isinstance(value, dict) and all(isinstance(text, str) for text in value.values())


def _are_papers(value: object) -> bool:
    return isinstance(value, list) and all(map(_are_texts, value))


_KINDS: dict[str, tuple[str, Callable[[Any], bool]]] = {
    **dict.fromkeys(("units", "title", "to"), ("text", lambda part: isinstance(part, str | None))),
    **dict.fromkeys(("values", "words"), ("an object of texts", _are_texts)),
    "papers": ("a list of objects of texts", _are_papers),
}


def _parts(*names: str) -> dict[str, Any]:
    """Parts of the request's JSON, a text that is missing empty. Raises UserError, also for a
    system of ``units`` there is not."""
    try:
        question = json.loads(request.get_data())
        json.dumps(question, ensure_ascii=False).encode()  # half a pair of surrogates is not text
    except (ValueError, RecursionError):
        raise UserError("the request is not JSON; expected an object") from None
    if not isinstance(question, dict):
        raise UserError("the request is not a JSON object")
    for name in names:
        kind, fits = _KINDS[name]
        if not fits(question.get(name)):
            raise UserError(f"{name!r} is not {kind}")
    for name in {"units", "to"}.intersection(names):
        if (units := question.get(name)) and units not in SYSTEMS:
            raise UserError(f"{units!r} is not a system of units; expected {', '.join(SYSTEMS)}")
    return {name: "" if question.get(name) is None else question[name] for name in names}
