"""The answers of the Collision view: 1988 printout, exact results, warnings, bounds, figure.

A text that INPUT takes for a number goes into the program as it stands; of a range
(`collision.uncertain`) the nominal value does, and the bounds have the rest. What computes is
imported on first use: the page is shown before numpy is there.
"""

import math
from collections.abc import Collection, Mapping
from itertools import groupby
from typing import Any, NamedTuple

from ...apple.emulator.screen import shown_character
from ...collision import uncertain
from ...collision.case import FACING_COURSE, Case, check_value, remark_lines
from ...collision.casescene import Scene, sample
from ...collision.doubles import double_or_none, doubles_of, is_number
from ...collision.fields import FINAL_SPINS
from ...collision.geometry import coordinate_names
from ...collision.needs import needs_sentences
from ...collision.scenefile import template, toml_texts
from ...collision.units import RULES, System
from ...errors import UserError
from ...mechanics.closedform.columns import OPTIONAL_OF_POINTS
from ...messages.plaintable import number
from ...messages.schemas import with_schema
from ...names import FINAL_VELOCITIES, RESULTS, SCENE, quantity
from .formview import entries, spoken_direction, units_shown

DRAWS = 20_000
"""Random draws for the bounds' quantiles: half a second at most with every value a range."""
_DIGITS = 12  # of an exact result: as many as are certain in double precision
_ANSWER_DIGITS = 4  # of the answer: more than the inputs of any collision are known to
_ROUNDING = 1e-14
"""Fraction of the largest value of its kind below which a result shows as 0: a hundred
roundings."""
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
"""The questions of a collision: words, and a name for each vehicle or one for both."""


class Form(NamedTuple):
    """The form as read: its ``case``, and the ``scene`` of it where it is complete; the names given
    as ``ranges``; ``problems`` by name; the names still ``missing``; how entries were understood
    (``remarks``)."""

    case: Case | None
    scene: Scene | None
    ranges: list[str]
    problems: dict[str, str]
    missing: list[str]
    remarks: list[str]

    @property
    def system(self) -> System:
        return self.case.system if self.case else RULES


def warm() -> None:
    answer(dict(sample(1)))
    figure(dict(sample(1)))


def read(values: Mapping[str, str], units: str = "", title: str = "") -> Form:
    """Return the form as read; ``units``: the system of bare numbers, or nothing."""
    case, problems = entries(values, units, title)
    if case is None:
        empty = [name for name in SCENE if not values.get(name, "").strip()]
        return Form(None, None, [], problems, empty, [])
    ranges: list[str] = []
    for name, text in case.values.items():
        try:
            if _varies(name, text):
                ranges.append(name)
        except UserError as error:
            problems[name] = str(error)
    if double_or_none(case.values["M"]) not in (4, 6):
        problems["M"] = "M: expected 6, or 4 for point masses"
    # a form shows the M that it takes
    entries_given = {n for n in case.values if n != "M" or "M" in case.given}
    optional = OPTIONAL_OF_POINTS if case.of_points else ()
    missing = [
        name
        for name in coordinate_names(SCENE, entries_given)
        if name not in entries_given | problems.keys() and name not in optional
    ]
    scene = None
    if not problems and not missing:
        try:
            scene = Scene.of(case, optional)
        except UserError as error:
            problems["MU"] = str(error)
    remarks = scene.remarks if scene else case.remarks
    return Form(case, scene, ranges, problems, missing, remark_lines(remarks))


def _varies(name: str, text: str) -> bool:
    """Return whether a value is known within limits. Raises UserError for what is none."""
    if is_number(text):
        check_value(name, text, "")
        return False
    return uncertain.read(text, name).varies


def answer(values: Mapping[str, str], units: str = "") -> dict[str, Any]:
    """The answer for a form: ``problems``, ``missing``, ``ranges``, ``remarks`` as `Form`,
    ``units`` as `units_shown`; for a complete scene also ``answer`` (`_answer`), ``oracle``, what
    `impact88 oracle` answers, its ``page``, ``results`` and ``warnings``, and the ``screen`` from
    the emulator's memory."""
    from ...casework.reconstruction.derived import without_noise
    from ...conformance.comparison.oracle import oracle
    from ...printouts.judging import beside
    from ...program.copies import load_machine, run_machine
    from ...program.run import page

    form = read(values, units)
    parts = ("problems", "missing", "ranges", "remarks")
    document: dict[str, Any] = {part: getattr(form, part) for part in parts}
    document["units"] = units_shown(form.system)
    if form.scene:
        scene = form.scene
        answer_known = oracle([scene], reference=False)[0]
        results, system, machine = answer_known["results"], form.system, load_machine(scene)
        exact = {n: row["double"] for n, row in results.items() if row["double"] is not None}
        warnings = beside.warnings(scene)
        if scene.omitted:  # nothing is judged by a 0 that was typed for want of a value
            exact, warnings, lines = _without(scene, results)
            document["remarks"] += lines
        run_machine(machine)
        document |= {
            "oracle": with_schema("oracle", {"id": None, "scene": dict(scene), **answer_known}),
            "answer": _answer(scene, exact, system),
            "page": page(answer_known["printout"]),
            "screen": [screen_runs(row) for row in machine.screen_rows()],
            "results": _rows(results, without_noise(exact, _ROUNDING), system),
            "warnings": warnings,
        }
    return document


def _known_numbers(scene: Scene) -> dict[str, float]:
    """Return what is given of a scene, `state.COURSE` for a heading that is the course."""
    facing = {n for n in ("TA", "TB") if scene.case.values.get(n) == FACING_COURSE}
    return {**doubles_of(scene.given), **dict.fromkeys(facing & {*scene.omitted}, math.nan)}


def _without(
    scene: Scene, results: Collection[str]
) -> tuple[dict[str, float], list[str], list[str]]:
    """Return the results of a scene that do not need what it lacks, warnings of what the impact
    breaks, and remarks: what the program is typed in its place, and what is needed for the rest."""
    from ...mechanics.closedform.solve import solve
    from ...mechanics.friction import status_sentences
    from ...mechanics.posed import absent_results

    columns = _known_numbers(scene)
    solved = solve(columns)
    needs = {**absent_results(columns), **getattr(solved, "absent", {})}
    unanswered = {name for _, *names in _ANSWER for name in names} - {*solved}
    unanswered -= {*FINAL_SPINS} if scene.case.of_points else set()
    omitted_names = [n if scene[n] == "0" else f"{n} (1: it divides)" for n in scene.omitted]
    lines = [f"the printout takes 0 for what is not given: {' '.join(omitted_names)}"]
    if "GA" in scene.omitted and "VC" in solved:
        lines.append(
            "the answer takes the contact plane across the motion, which is along one line"
        )
    warnings = status_sentences(int(solved.get("STATUS", 0)), {**columns, **solved})
    lines += needs_sentences({name: x for name, x in needs.items() if name in unanswered})
    return {name: float(x) for name, x in solved.items() if name in results}, warnings, lines


def _answer(scene: Scene, exact: Mapping[str, float], system: System) -> list[dict[str, Any]]:
    """Rows of ``words``, a ``unit``, and ``values``: name, text, and a direction as it is ``said``,
    one or one for each vehicle."""
    from ...casework.reconstruction.derived import with_derived_values, without_noise

    columns = _known_numbers(scene)
    values = without_noise(with_derived_values({**columns, **exact}, None), _ROUNDING)
    rows = []
    for words, *names in _ANSWER:
        if not values.keys() >= set(names):
            continue
        rule = quantity(names[0]).unit
        amounts = {name: system.display(name, values[name]) for name in names}
        texts = [
            {
                "name": name,
                "text": number(value, _ANSWER_DIGITS),
                "value": value,
                "said": spoken_direction(name, value, system),
            }
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
            value, label = system.display(name, float(exact)), system.unit(name)
            row = {**RESULTS[name]._asdict(), "printed": results[name]["printed"] or ""}
            row |= {"exact": number(exact, _DIGITS), "value": value, "label": label}
            rows.append({**row, "shown": f"{number(value)} {label}" if label else ""})
    return rows


def figure(values: Mapping[str, str], title: str = "", units: str = "") -> str:
    """The scene from above as SVG, as `impact88 figure scene` draws it. Raises UserError."""
    from ...casework.figures.canvas import svg
    from ...casework.figures.sceneview import scene_drawing
    from ...mechanics.closedform.solve import solve

    form = read(values, units)
    if not form.scene:
        raise UserError("there is no complete scene to draw")
    result = solve(doubles_of(form.scene.given), [*FINAL_VELOCITIES, "STATUS"])
    return svg(scene_drawing(form.scene, result, title=title or "Scene from above"))


def bounds_answer(values: dict[str, str], units: str = "", draws: int = DRAWS) -> dict[str, Any]:
    """Return the object that `impact88 bounds --json` prints for the form's ranges, with fewer
    draws. Raises UserError, also for a form without ranges."""
    from ...casework.uncertainty.bounds import bounds
    from ...casework.uncertainty.boundstable import as_json, in_units
    from ...casework.uncertainty.ranges import read_inputs

    form = read(values, units)
    if not form.case or not form.scene or not form.ranges:
        raise UserError("there are no ranges to explore")
    inputs = read_inputs(form.case)
    result = bounds(inputs.values, correlations=inputs.correlations, samples=draws)
    return with_schema("bounds", as_json(in_units(result, form.system)))


def scene_file(values: Mapping[str, str], title: str, units: str = "") -> str:
    """Return the form as a scene file, its texts as they were typed. Raises UserError."""
    form = read(values, units, title)
    for problem in form.problems.values():
        raise UserError(problem)
    return template(form.case)


def sample_scene(which: int) -> dict[str, Any]:
    """Return a published run in the form of a file that was read. Raises UserError."""
    scene = sample(which)
    return {"values": dict(scene), "title": scene.title or "", "units": scene.units}


def case_report(text: str, name: str) -> str:
    """Return the page that `impact88 report` writes for the text of a file. Raises UserError."""
    from ...casework.report.findings import report

    case = Case(toml_texts(text, name), name)
    return report(case, name, text.encode(), samples=DRAWS, seed=0)[0]
