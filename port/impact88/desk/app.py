"""The desk's addresses, all below the token.

The page is read once; its scripts then send JSON or a file's bytes, and receive JSON or a file.
Unusable input is status 400 with ``{"problem": ...}``, the sentence a command would print; a
question replaced by a newer one is 409.
"""

import json
import threading
from base64 import b64decode
from typing import Any, TypeGuard

import flask
from flask import Blueprint, Flask, Response, abort, request
from jinja2 import ChoiceLoader, PackageLoader
from werkzeug.exceptions import HTTPException

from ..errors import UserError
from ..files import packaged_text
from ..names import SCENE
from ..reconstruction.knowable import KNOWABLE
from ..version import __version__
from . import collision, page, reconstruction
from .forms import filled_in
from .guard import HEADERS, LARGEST_BODY, refusal
from .workers import Bench, BrokenError, SupersededError

BENCHES = {
    **{"edit": "paper", "paper": "paper"},
    **{"bounds": "collision", "reconstruction": "reconstruction"},
}
"""What takes long, and the module that does it; the text being edited overtakes papers waiting."""


class Desk:
    """A bench for each kind of slow work."""

    def __init__(self) -> None:
        self.benches = {name: Bench(module) for name, module in BENCHES.items()}
        self._warm = False

    def warm(self) -> None:
        """Start, once and in the background, what the first questions will need."""
        if not self._warm:
            self._warm = True
            starts = [*(bench.warm for bench in self.benches.values()), collision.warm]
            threading.Thread(target=lambda: [start() for start in starts], daemon=True).start()

    def close(self) -> None:
        """End all processes."""
        for bench in self.benches.values():
            bench.close()


def application(desk: Desk, port: int, token: str) -> Flask:
    """The WSGI application that answers for ``desk`` at 127.0.0.1:``port``, below ``token``."""
    app = Flask(__name__, static_url_path=f"/{token}/static")
    app.config["MAX_CONTENT_LENGTH"] = LARGEST_BODY
    app.jinja_env.filters |= page.FILTERS
    packages = (__package__ or "", "impact88.report")
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
    """An error as JSON, in the words a command would use."""
    if isinstance(error, UserError):
        return {"problem": str(error)}, 400
    if isinstance(error, SupersededError):
        return {"superseded": True}, 409
    if isinstance(error, HTTPException):
        too_large = f"more than {LARGEST_BODY:,} bytes, the limit here"
        return {"problem": too_large if error.code == 413 else error.name}, error.code or 500
    detail = str(error) if isinstance(error, BrokenError) else f"{type(error).__name__}: {error}"
    return {"problem": f"a fault of impact88 {__version__}, not of your input: {detail}"}, 500


def _addresses(desk: Desk) -> Blueprint:
    routes = Blueprint("desk", __name__)

    def sender() -> str:
        return request.headers.get("X-Desk-Page", "")[:64]

    def asked(bench: str, function: str, **arguments: Any) -> Any:
        return desk.benches[bench].ask(sender(), function, **arguments)

    def table(macro: str, content: Any) -> str:
        return str(flask.get_template_attribute("answers.html", macro)(content))

    routes.post("/sample/<int:which>")(collision.sample_scene)
    routes.post("/known/<int:which>")(reconstruction.known_of_sample)

    @routes.get("/")
    def whole_page() -> str:
        desk.warm()  # while the page is sent
        return flask.render_template("desk.html", **page.contents())

    @routes.get("/signs.svg")
    def signs() -> Response:
        return Response(collision.sign_diagram(), content_type="image/svg+xml")

    @routes.post("/judge")
    def judge() -> Any:
        bench = "edit" if request.args.get("bench") == "edit" else "paper"
        given = {name: request.args.get(name, "") for name in ("name", "seed")}
        return asked(bench, "judged", data=request.get_data(), **given)

    @routes.post("/published/<name>")
    def published(name: str) -> Response:
        if name not in page.PUBLISHED:
            abort(404)
        return _saved(packaged_text("impact88.legacy", name), "text/plain", name)

    @routes.post("/report")
    def report() -> Response:
        written = asked("edit", "report", papers=_papers(), words=_texts("words"))
        return _saved(written, "text/html", "report.html")

    @routes.post("/collision")
    def collision_answer() -> Any:
        answer = collision.answer(**_form())
        if "answer" in answer:
            answer["first"] = table("first", answer["answer"])
            answer["all"] = table("results", answer["results"])
        return answer

    @routes.post("/figure")
    def figure() -> Response:
        drawn = collision.figure(**_form(), title=_text("title"))
        return Response(drawn, content_type="image/svg+xml")

    @routes.post("/bounds")
    def bounds() -> Any:
        found = asked("bounds", "bounds_answer", **_form())
        return {"found": found, "table": table("bounds", found)}

    def file_of(view: str) -> tuple[str, str]:
        if view == "collision":
            return collision.scene_file(**_form(), title=_text("title")), "scene.toml"
        if view == "reconstruction":
            return reconstruction.known_file(**_form()), "known.toml"
        abort(404)

    @routes.post("/file/<view>")
    def file(view: str) -> Response:
        text, name = file_of(view)
        return _saved(text, "application/toml", name)

    @routes.post("/case-report/<view>")
    def case_report(view: str) -> Response:
        text, name = file_of(view)
        written = asked("bounds", "case_report", text=text, name=name)
        return _saved(written, "text/html", "case.html")

    @routes.post("/scene")
    def scene() -> Any:
        return filled_in(request.get_data(), _name(), SCENE)

    @routes.post("/reconstruct")
    def reconstruct() -> Any:
        answer = asked("reconstruction", "answer", **_form())
        return {**answer, "tables": table("solutions", answer["solutions"])}

    @routes.post("/known")
    def known() -> Any:
        return filled_in(request.get_data(), _name(), KNOWABLE)

    @routes.post("/stop/<bench>")
    def stop(bench: str) -> Any:
        if bench not in desk.benches:
            abort(404)
        desk.benches[bench].stop(sender())
        return {}

    return routes


def _saved(text: str, kind: str, name: str) -> Response:
    """A file to be saved by the browser under a name."""
    return Response(
        text.encode(),
        content_type=f"{kind}; charset=utf-8",
        headers={"Content-Disposition": f'attachment; filename="{name}"'},
    )


def _object() -> dict[str, Any]:
    try:
        whole = json.loads(request.get_data())
        json.dumps(whole, ensure_ascii=False).encode()  # half a pair of surrogates is not text
    except (ValueError, RecursionError):
        raise UserError("the request is not JSON; expected an object") from None
    if not isinstance(whole, dict):
        raise UserError("the request is not a JSON object")
    return whole


def _name() -> str:
    return request.args.get("name", "the file")[:200]


def _form() -> dict[str, Any]:
    """A form's ``values``, texts by name, and its system of ``units``, empty for any consistent
    ones. Raises UserError."""
    units = _text("units")
    known = dict(page.SYSTEMS)
    if units and units not in known:
        raise UserError(f"{units!r} is not a system of units; expected {', '.join(known)}")
    return {"values": _texts("values"), "units": units}


def _text(name: str) -> str:
    text = _object().get(name)
    if not isinstance(text, str | None):
        raise UserError(f"{name!r} is not text")
    return text or ""


def _is_texts(value: object) -> TypeGuard[dict[str, str]]:
    return isinstance(value, dict) and all(isinstance(one, str) for one in value.values())


def _texts(name: str) -> dict[str, str]:
    values = _object().get(name)
    if not _is_texts(values):
        raise UserError(f"{name!r} is not an object of texts")
    return values


def _papers() -> list[dict[str, str]]:
    papers = _object().get("papers")
    if not isinstance(papers, list) or not all(map(_is_texts, papers)):
        raise UserError("'papers' is not a list of objects of texts")
    for paper in papers:
        try:
            b64decode(paper.get("data", "?"), validate=True)
        except ValueError:
            raise UserError("'data' of a paper is not base 64") from None
    return [{"name": "", **paper} for paper in papers]
