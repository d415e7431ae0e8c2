"""The answers of the Collision view: 1988 printout, exact results, warnings, bounds, figure.

A text that INPUT takes for a number goes into the program as it stands; of a range
(`uncertainty.uncertain`) the nominal value does, and the bounds have the rest. What computes is
imported on first use: the page is shown before numpy is there.
"""

from collections.abc import Mapping
from itertools import groupby
from typing import Any, NamedTuple

from ..doubles import double, doubles_of, is_number
from ..emulator.screen import shown_character
from ..errors import UserError
from ..names import FINAL_VELOCITIES, RESULTS, SCENE, quantity
from ..plaintable import number
from ..scene import (
    Scene,
    check_value,
    entries_of,
    in_base_units,
    is_share,
    sample,
    template,
    toml_texts,
)
from ..schemas import stamped
from ..uncertainty import uncertain
from ..units import System, system_of
from .forms import OUTLINES, entries, outline_lines, units_shown, without_rounding

DRAWS = 20_000
"""Random draws for the bounds' quantiles: half a second at most with every value a range."""
_NOMINAL_DIGITS, _DIGITS, _ANSWER_DIGITS = 9, 12, 4
"""Of a range's nominal value, as many as Applesoft prints; of an exact result, as many as double
precision is sure of; of the answer, more than the inputs of any collision are known to."""
_ROUNDING = 1e-14
"""Share of the largest value of its kind below which a result shows as 0: a hundred roundings."""
_ANSWER = (
    ("Velocity change ΔV", "DVA", "DVB"),
    ("forward, along the vehicle", "DVAF", "DVBF"),
    ("to its right", "DVAR", "DVBR"),
    ("Force from, clockwise from its front", "PDOFA", "PDOFB"),
    ("Speed before", "SA", "SB"),
    ("Speed after", "SAF", "SBF"),
    ("Course after, from the x axis", "HAF", "HBF"),
    ("Spin after", "WAF", "WBF"),
    ("Closing speed along the normal", "VC"),
    ("Kinetic energy lost", "LOSS"),
    ("Friction coefficient as printed (-10: pivot)", "MUP"),
    ("critical friction coefficient", "MUC"),
)
"""What is asked of a collision: words, and a name for each vehicle or one for both."""


class Form(NamedTuple):
    """The form as read: ``texts`` for the program, the ``entries`` they were made of, in base units
    of the system ``units``; the names given as ``ranges``; ``problems`` by name; the names still
    ``missing``; how entries were understood (``remarks``)."""

    texts: dict[str, str]
    entries: dict[str, str]
    units: str | None
    ranges: list[str]
    problems: dict[str, str]
    missing: list[str]
    remarks: list[str]

    @property
    def complete(self) -> bool:
        return not self.problems and not self.missing


def warm() -> None:
    answer(dict(sample(1)))
    figure(dict(sample(1)))


def read(values: Mapping[str, str], units: str = "") -> Form:
    """The form's texts; ``units``: the system of bare numbers, or nothing."""
    given = entries({name: values.get(name, "") for name in SCENE}, units)
    missing = [name for name in SCENE if name not in given.texts.keys() | given.problems.keys()]
    form = Form({}, given.texts, given.units, [], given.problems, missing, [])
    for name, text in given.texts.items():
        try:
            form.texts[name] = _number_text(name, text, form.ranges)
        except UserError as error:
            form.problems[name] = str(error)
    if form.complete and is_share(form.texts["MU"]):
        try:
            scene = Scene(form.texts)
        except UserError as error:
            form.problems["MU"] = str(error)
        else:
            form.texts["MU"] = scene["MU"]
            form.remarks.append(scene.entries.remarks["MU"])
    return form


def _number_text(name: str, text: str, ranges: list[str]) -> str:
    """The text the program is given for one value; a range's name is added to ``ranges``."""
    if not is_number(text):
        item = uncertain.read(text, name)
        if item.varies:
            ranges.append(name)
        if item.share:
            return f"{number(100 * item.nominal, _NOMINAL_DIGITS)} %"
        text = number(item.nominal, _NOMINAL_DIGITS)
    check_value(name, text, "")
    if name == "M" and double(text) not in (4, 6):
        raise UserError("expected 6, or 4 for point masses", "M")
    return text


def answer(values: Mapping[str, str], units: str = "") -> dict[str, Any]:
    """The answer for a form: ``problems``, ``missing``, ``ranges``, ``remarks`` as `Form`,
    ``units`` as `units_shown`; for a complete scene also ``answer`` (`_answer`), ``oracle``, what
    `impact88 oracle` answers, its ``page``, ``results`` and ``warnings``, and the ``screen`` from
    the emulator's memory."""
    from ..checking.oracle import oracle
    from ..judging import beside
    from ..program.emulated import finished, loaded
    from ..program.run import page

    form = read(values, units)
    parts = ("problems", "missing", "ranges", "remarks")
    found: dict[str, Any] = {part: getattr(form, part) for part in parts}
    found["units"] = units_shown(form.units)
    if form.complete:
        scene = Scene(form.texts, source="the form")
        known = oracle([scene], reference=False)[0]
        results, system, machine = known["results"], system_of(form.units), loaded(scene)
        exact = {n: row["double"] for n, row in results.items() if row["double"] is not None}
        finished(machine)
        found |= {
            "oracle": stamped("oracle", {"id": None, "scene": dict(scene), **known}),
            "answer": _answer(scene, exact, system),
            "page": page(known["printout"]),
            "screen": [screen_runs(row) for row in machine.screen_rows()],
            "results": _rows(results, without_rounding(exact, _ROUNDING), system),
            "warnings": beside.warnings(scene),
        }
    return found


def _answer(scene: Scene, exact: Mapping[str, float], system: System) -> list[dict[str, Any]]:
    """Rows of ``words``, a ``unit``, and ``values``: name and text, one or one for each vehicle."""
    from ..reconstruction.solutiontable import completed

    given = {name: double(text) for name, text in scene.items()}
    values = without_rounding(completed({**given, **exact}, None), _ROUNDING)
    rows = []
    for words, *names in _ANSWER:
        if not values.keys() >= set(names):
            continue
        rule = quantity(names[0]).unit
        amounts = {name: system.shown(rule, values[name]) for name in names}
        texts = [
            {"name": name, "text": number(value, _ANSWER_DIGITS), "value": value}
            for name, value in amounts.items()
        ]
        rows.append({"words": words, "unit": system.label(rule), "values": texts})
    return rows


def screen_runs(row: bytes) -> list[tuple[str, str]]:
    """A row of screen memory as stretches of one kind, each with its text."""
    # what the two high bits of a byte on the screen say
    kinds = groupby(row, lambda code: ("inverse", "flashing", "normal")[min(code >> 6, 2)])
    return [(kind, "".join(map(shown_character, codes))) for kind, codes in kinds]


def _rows(
    results: Mapping[str, Mapping[str, Any]], doubles: Mapping[str, float], system: System
) -> list[dict[str, Any]]:
    """The results as a table's rows; ``shown``, and ``value`` with all its digits: in the units of
    the form, ``label``."""
    rows = []
    for name, exact in doubles.items():
        if name != "STATUS":
            value, label = exact * system.factor(name), system.unit(name)
            row = {**RESULTS[name]._asdict(), "printed": results[name]["printed"] or ""}
            row |= {"exact": number(exact, _DIGITS), "value": value, "label": label}
            rows.append({**row, "shown": f"{number(value)} {label}" if label else ""})
    return rows


def figure(values: Mapping[str, str], title: str = "", units: str = "") -> str:
    """The scene from above as SVG, as `impact88 figure scene` draws it. Raises UserError."""
    from ..closedform.solve import solve
    from ..figures.canvas import svg
    from ..figures.sceneview import scene_drawing

    form = read(values, units)
    if not form.complete:
        raise UserError("there is no complete scene to draw")
    scene = Scene(form.texts, source="the form")
    result = solve(doubles_of(scene), [*FINAL_VELOCITIES, "STATUS"])
    given = {name: values[name] for name in OUTLINES if values.get(name)}
    outlines = {n: double(t) for n, t in in_base_units(given, "", units or None)[0].items()}
    title, system = title or "Scene from above", system_of(form.units)
    return svg(scene_drawing(scene, result, title=title, units=system, outlines=outlines))


def bounds_answer(values: dict[str, str], units: str = "") -> dict[str, Any]:
    """What `impact88 bounds --json` prints for the form's ranges, with fewer draws. Raises
    UserError, also for a form without ranges."""
    from ..uncertainty.bounds import bounds
    from ..uncertainty.boundstable import as_json, in_units
    from ..uncertainty.ranges import read_inputs

    form = read(values, units)
    if not form.complete or not form.ranges:
        raise UserError("there are no ranges to explore")
    inputs = read_inputs(form.entries, {}, source="the form")
    answered = bounds(inputs.values, correlations=inputs.correlations, samples=DRAWS)
    return stamped("bounds", as_json(in_units(answered, form.units)))


def scene_file(values: Mapping[str, str], title: str, units: str = "") -> str:
    """The form as a scene file, its texts as they were typed. Raises UserError."""
    for problem in read(values, units).problems.values():
        raise UserError(problem)
    texts = {name: values.get(name, "").strip() for name in SCENE}
    return template(texts, title, units) + outline_lines(values)


def sample_scene(which: int) -> dict[str, Any]:
    """A published run as a file is read. Raises UserError."""
    scene = sample(which)
    return {"values": dict(scene), "title": scene.title or "", "units": ""}


def case_report(text: str, name: str) -> str:
    """The page that `impact88 report` writes for the text of a file. Raises UserError."""
    from ..report.findings import report

    entries = entries_of(toml_texts(text, name), name)
    return report(entries, name, text.encode(), samples=DRAWS, seed=0)[0]
