"""What the Collision view is answered: 1988 printout, exact results, warnings, bounds, figure.

The form sends 21 texts. A text that INPUT takes for a number goes into the program as it stands;
one that says a range (`uncertainty.uncertain`) is kept for the bounds, and its nominal value goes
into the program.

What computes is imported on first use: the page is shown before numpy is there.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from ..doubles import double, is_number
from ..errors import UserError
from ..names import FINAL_VELOCITIES, RESULTS, SCENE, check_names
from ..plaintable import number
from ..scene import Scene, check_value, sample, template
from ..uncertainty import uncertain
from .files import small_toml

DRAWS = 20_000
"""Random draws for the bounds' quantiles: half a second at most with every value a range."""
_NOMINAL_DIGITS = 9
"""Digits of a range's nominal value, as many as Applesoft prints."""
_DIGITS = 12
"""Digits of an exact result, as many as double precision is sure of."""
_NOT_SHOWN = ("STATUS",)


class Form(NamedTuple):
    """The form as read: the ``texts`` for the program, the names given as ``ranges``, and what is
    wrong: ``problems`` by name, and the names still ``missing``."""

    texts: dict[str, str]
    ranges: list[str]
    problems: dict[str, str]
    missing: list[str]

    @property
    def whole(self) -> bool:
        """Whether there is a scene."""
        return not self.problems and not self.missing


def warm() -> None:
    """Load what the first answer needs."""
    answer(dict(sample(1)))
    figure(dict(sample(1)))


def read(values: Mapping[str, str]) -> Form:
    """The form's texts, each judged alone so that one bad number hides nothing of the others."""
    form = Form({}, [], {}, [])
    for name in SCENE:
        text = values.get(name, "").strip()
        if not text:
            form.missing.append(name)
            continue
        try:
            form.texts[name] = _number_text(name, text, form.ranges)
        except UserError as error:
            form.problems[name] = str(error)
    return form


def _number_text(name: str, text: str, ranges: list[str]) -> str:
    """The text the program is given for one value; a range's name is added to ``ranges``."""
    if not is_number(text):
        item = uncertain.read(text, name)
        if item.varies:
            ranges.append(name)
        text = number(item.nominal, _NOMINAL_DIGITS)
    check_value(name, text, "")
    if name == "M" and double(text) not in (4, 6):
        raise UserError("expected 6, or 4 for point masses", "M")
    return text


def answer(values: Mapping[str, str]) -> dict[str, Any]:
    """What is known of the form's collision.

    ``problems``, ``missing``, ``ranges``: see `Form`. Where there is a scene, ``oracle`` is what
    `impact88 oracle` answers for it, ``results`` the rows of a table and ``warnings`` sentences.
    """
    from ..casework import beside
    from ..checking.oracle import look_up

    form = read(values)
    told: dict[str, Any] = {
        "problems": form.problems,
        "missing": form.missing,
        "ranges": form.ranges,
    }
    if form.whole:
        scene = Scene(form.texts, source="the form")
        known = look_up([scene], reference=False)[0]
        told |= {
            "oracle": {"scene": dict(scene), **known},
            "page": _page(known["printout"]),
            "results": _rows(known["results"]),
            "warnings": beside.warnings(scene),
        }
    return told


def _page(printout: str) -> str:
    """The printout without the control characters that no screen shows."""
    return "".join(c for c in printout if c == "\n" or c >= " ").strip("\n") + "\n"


def _rows(results: Mapping[str, Mapping[str, Any]]) -> list[dict[str, str]]:
    """The results as a table's rows, the names and meanings from the one table."""
    return [
        {
            "name": name,
            "symbol": quantity.symbol,
            "meaning": quantity.meaning,
            "unit": quantity.unit,
            "printed": results[name]["printed"] or "",
            "exact": number(results[name]["double"], _DIGITS),
        }
        for name, quantity in RESULTS.items()
        if name in results and name not in _NOT_SHOWN and results[name]["double"] is not None
    ]


def figure(values: Mapping[str, str], title: str = "") -> str:
    """The scene from above as SVG, as `impact88 figure scene` draws it. Raises UserError."""
    from ..casework import beside
    from ..figures.sceneview import scene_drawing
    from ..figures.svg import svg

    form = read(values)
    if not form.whole:
        raise UserError("there is no whole scene to draw")
    scene = Scene(form.texts, source="the form")
    result = beside.solved(scene, [*FINAL_VELOCITIES, "STATUS"])
    return svg(scene_drawing(scene, result, title=title or "Scene from above"))


def bounds_answer(values: dict[str, str]) -> dict[str, Any]:
    """What `impact88 bounds --json` prints for the form's ranges, with fewer draws.

    Raises UserError for a form that has no ranges, and as `uncertainty.bounds.bounds` does.
    """
    from ..uncertainty.bounds import bounds
    from ..uncertainty.boundstable import as_json
    from ..uncertainty.ranges import read_inputs

    form = read(values)
    if not form.whole or not form.ranges:
        raise UserError("there are no ranges to explore")
    inputs = read_inputs(_entries(values), {}, source="the form")
    return as_json(bounds(inputs.values, correlations=inputs.correlations, samples=DRAWS))


def _entries(values: Mapping[str, str]) -> dict[str, str]:
    """The form's texts that are no blanks, the scene's names only."""
    return {name: values[name].strip() for name in SCENE if values.get(name, "").strip()}


def scene_file(values: Mapping[str, str], title: str) -> str:
    """The form as the scene file that the commands read. Raises UserError naming what is wrong."""
    form = read(values)
    for problem in form.problems.values():
        raise UserError(problem)
    entries = _entries(values)
    return template({name: entries.get(name, "") for name in SCENE}, title)


def read_scene_file(data: bytes, name: str) -> dict[str, Any]:
    """The ``values`` and the ``title`` of a scene file. Raises UserError naming file and line."""
    texts = small_toml(data, name)
    title = texts.pop("title", "")
    check_names(texts, SCENE, "value of a scene", name)
    return {"values": texts, "title": title}


def sample_scene(which: int) -> dict[str, Any]:
    """The same of a published run. Raises UserError."""
    scene = sample(which)
    return {"values": dict(scene), "title": scene.title or ""}
