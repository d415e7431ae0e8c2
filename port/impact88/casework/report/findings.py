"""The report of a collision: forward from a scene, inverse from a reconstruction file."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...collision.case import ABOUT, Case, remark_lines
from ...collision.fields import FINAL_SPINS
from ...collision.geometry import MOVES, clock, coordinate_names, resolve_contact_point
from ...collision.needs import needs_sentences
from ...collision.units import System, base_of, gravity_in
from ...errors import UserError
from ...mechanics.closedform.columns import OPTIONAL_OF_POINTS
from ...mechanics.friction import status_sentences
from ...mechanics.state import COURSES, KNOWABLE
from ...messages.plaintable import format_fixed, number
from ...names import (
    DEFAULT_M,
    FINAL_STATE,
    LENGTH,
    MASS,
    SCENE,
    SPIN,
    VELOCITY,
    check_names,
    quantity,
)
from ...status import IMPOSSIBLE
from ..figures.canvas import svg
from ..figures.sceneview import scene_drawing
from ..reconstruction.derived import without_noise
from .frame import render

if TYPE_CHECKING:
    from ..reconstruction.answer import Answer
    from ..reconstruction.solution import Adjusted

DRIVERS = 3
"""Inputs named for each result: they fill a line."""
BOUNDED = (*FINAL_STATE, "DVA", "DVB", "LOSS")
"""Results of a scene that its ranges are followed to."""
FORWARD = ("SAF", "SBF", *BOUNDED)
"""Results of a scene that the answer shows."""
INVERSE = (
    "SA",
    "HA",
    "SB",
    "HB",
    "UX",
    "UY",
    "WA",
    "VX",
    "VY",
    "WB",
    "SAF",
    "SBF",
    "DVA",
    "DVB",
    "LOSS",
    "E",
    "MUP",
    "EM",
)
"""Results of a reconstruction that the answer shows, where they were not known exactly."""
_SPREAD: tuple[str, ...] = ("value", "sd", "5 %", "95 %", "lower bound", "upper bound")
_CAPTION = (
    "sd: standard deviation; 5 and 95 %: of the draws; bounds: attained within the limits of the "
    "inputs, not proven to be the farthest"
)
_CONSEQUENCES = (
    "SA",
    "HA",
    "SAF",
    "HAF",
    "DVA",
    "DVAF",
    "DVAR",
    "PDOFA",
    "SB",
    "HB",
    "SBF",
    "HBF",
    "DVB",
    "DVBF",
    "DVBR",
    "PDOFB",
    "P",
    "E",
    "MUP",
    "MUC",
    "EM",
    "KI",
    "KF",
    "EL",
    "LOSS",
)


class Table(NamedTuple):
    """One table of a report; columns in ``left`` start at the left."""

    title: str
    headings: Sequence[str]
    rows: Sequence[Sequence[str]]
    left: Sequence[int]
    caption: str = ""


class Spread(NamedTuple):
    """Uncertainty of a result: standard deviation, 5 and 95 % quantiles and bounds, in base units,
    NaN where unknown; and the inputs that drive it."""

    deviation: float = math.nan
    low: float = math.nan
    high: float = math.nan
    lower: float = math.nan
    upper: float = math.nan
    drivers: Sequence[str] = ()


class Findings(NamedTuple):
    """Findings on one impact.

    Parameters
    ----------
    inverse : bool
        True if it was reconstructed.
    values : mapping of str to float
        All results, in base units.
    main : sequence of str
        Names of the results that the answer shows.
    spreads : mapping of str to Spread
        Uncertainties of the main results.
    remarks : sequence of str
        Remarks, in sentences.
    scene : mapping of str to float
        The scene that is drawn.
    lines : sequence of (str, str, bool)
        The first lines of a reconstruction, or on an impact that physics forbids: label, text, and
        True where they are adverse.
    contradictory : bool
        True if the given values contradict one another.
    adjusted : sequence of Adjusted
        Each measured value beside its adjusted one.
    redundancy : int
        Number of values known beyond those needed: without any, none is adjusted.
    impossible : bool
        True if the impact breaks a law of physics.
    adverse : bool
        True if no impact agrees, or no velocity before it was found.
    """

    inverse: bool
    values: Mapping[str, float]
    main: Sequence[str]
    spreads: Mapping[str, Spread]
    remarks: Sequence[str]
    scene: Mapping[str, float]
    lines: Sequence[tuple[str, str, bool]] = ()
    contradictory: bool = False
    adjusted: Sequence[Adjusted] = ()
    redundancy: int = 0
    impossible: bool = False
    adverse: bool = False


def report(
    case: Case,
    source: str,
    data: bytes,
    *,
    samples: int,
    seed: int,
    number: str = "",
    title: str = "",
    paper: str = "",
    examiner: str = "",
    date: str = "",
) -> tuple[str, bool]:
    """Return the report page on a collision, and True where no impact agrees with what is known.

    ``source`` is the name of the case's file and ``data`` its bytes. A complete scene with nothing
    known after the impact is computed forward, any other reconstructed. Raises UserError.
    """
    # ten arguments, and not split: the options of `impact88 report`, and the parts of its page
    units = case.system
    names = {n for n, text in case.values.items() if text.strip()}
    scene = coordinate_names(SCENE, names)
    optional = ("M", *(OPTIONAL_OF_POINTS if case.of_points else ()))
    forward = set(scene) - {*optional} <= names <= {*scene, *MOVES}
    check_names(names, coordinate_names((*KNOWABLE, *MOVES), names), "name used here", source)
    if forward:
        from ...mechanics.approach import approaching

        case = approaching(case)
    findings = (_forward if forward else _inverse)(case, source, samples, seed, units)
    drawing = None
    tables = [_answer(findings, units), *_details(findings, case, units)]
    paper = paper or ("letter" if units.name in ("us", "chapter", "") else "a4")
    summary, answer = _summary(findings, case, units), _sentences(findings, units)
    look = (DRAWN, "", units, case.outlines)
    remarks, texts = findings.remarks, [text for _, text, _ in findings.lines]
    room = _room(paper, [*summary, *texts, *answer], remarks)
    undrawn = ""
    try:
        drawing = scene_drawing(findings.scene, findings.values, *look, tallest=room)
    except UserError as error:  # what is not determined cannot be drawn
        undrawn = str(error)
    page = render(
        "collision.html",
        title=title or case.title or "Planar impact of two vehicles",
        case=number or case.case or "",
        paper=paper,
        files=[(source, data)],
        found=findings,
        draws=f"{samples:,} random draws, seed {seed}."
        if any(spread.low == spread.low for spread in findings.spreads.values())
        else "",
        base=base_of(units),
        units=_units_text(units),
        summary=summary,
        figures=_figures(findings, units),
        answer=answer,
        validated=_validation_text(),
        unjudged=_unjudged(case),
        signed={
            "examiner": examiner or case.given.get("examiner", ""),
            "date": date or case.given.get("date", ""),
        },
        tables=tables,
        drawing=svg(drawing) if drawing else "",
        undrawn=undrawn,
        room=FIRST_PAGE[paper],
        remarks=remarks,
    )
    return page, findings.adverse


def _unjudged(case: Case) -> list[str]:
    """Return sentences on what the page takes as it was given, and on what it says nothing."""
    given = [entry for entry in case.entries.values() if entry.name in KNOWABLE]
    exact = [entry.name for entry in given if entry.kind == "value" and entry.name != "M"]
    unsourced = [entry.name for entry in given if not entry.source and entry.name != "M"]
    sentences = []
    if exact:
        sentences.append(f"Taken as exact, for no limits are given: {' '.join(exact)}.")
    if unsourced:
        sentences.append(f"The file names no source for {' '.join(unsourced)}.")
    skids = [n for n, text in case.given.items() if text.lstrip().startswith("skid")]
    if skids:
        gravity = f"{number(gravity_in(case.system), 5)} {case.system.label(LENGTH)}/s2"
        sentences.append(
            f"{' and '.join(skids)} from a skid to rest: v = sqrt(2 mu g d), on a level road of "
            f"one friction, g = {gravity}."
        )
    return [
        *sentences,
        f"Motion before and after the impact{' but for skids' * bool(skids)}, crush and injury: "
        "nothing of them is computed here.",
    ]


def _forward(case: Case, source: str, samples: int, seed: int, units: System) -> Findings:
    from ...mechanics.closedform.general import share_typed
    from ...mechanics.closedform.solve import solve
    from ...mechanics.posed import absent_results
    from ..reconstruction.derived import with_derived_values
    from ..uncertainty.ranges import read_inputs

    inputs = read_inputs(case)
    nominal = resolve_contact_point({name: item.nominal for name, item in inputs.values.items()})
    if "MU" in nominal and inputs.values["MU"].share:
        nominal["MU"] = share_typed(nominal, nominal["MU"])
    solved = solve(nominal)
    results = {name: float(value) for name, value in solved.items()}
    values = with_derived_values({**{n: float(v) for n, v in nominal.items()}, **results}, None)
    spreads: dict[str, Spread] = {}
    status = int(results.get("STATUS", 0))
    remarks = [*remark_lines(case.remarks), *status_sentences(status, {**nominal, **results})]
    needs = {**absent_results(nominal), **getattr(solved, "absent", {})}
    shown = {*FORWARD, *_CONSEQUENCES} - {*values, *(FINAL_SPINS if case.of_points else ())}
    remarks += needs_sentences({name: x for name, x in needs.items() if name in shown})
    if any(item.varies for item in inputs.values.values()):
        from ..uncertainty.bounds import bounds
        from ..uncertainty.boundstable import quantiles_of

        options: dict[str, Any] = {"samples": samples, "seed": seed, "keep_draws": True}
        wanted = [name for name in BOUNDED if name in results]
        bounded = bounds(inputs.values, wanted, correlations=inputs.correlations, **options)
        for vehicle in "AB" if {"VAX", "VAY", "VBX", "VBY"} <= {*wanted} else "":
            speeds = np.hypot(bounded.draws[f"V{vehicle}X"], bounded.draws[f"V{vehicle}Y"])
            speeds = speeds[np.isfinite(speeds)]
            low, high = quantiles_of(speeds, (0.05, 0.95))
            spreads[f"S{vehicle}F"] = Spread(float(speeds.std(ddof=1)), low, high)
        for name, bound in bounded.bounds.items():
            spread = bounded.spreads[name]
            limits = spread.quantiles[0.05], spread.quantiles[0.95], bound.lower, bound.upper
            ranking = sorted(bounded.drives[name].items(), key=lambda entry: -entry[1].swing)
            drivers = [
                f"{source} {number(drive.swing * units.factor(name), 3)} {units.unit(name)}".strip()
                for source, drive in ranking[:DRIVERS]
                if drive.swing > 0
            ]
            spreads[name] = Spread(spread.deviation, *limits, drivers)
        remarks += [
            f"{100 * share:.3g} % of the draws carry the warning {name}"
            for name, share in bounded.warnings.items()
        ]
    numbers = {name: float(nominal[name]) for name in SCENE if name in nominal}
    scene = {name: x for name, x in numbers.items() if not math.isnan(x)}  # `state.COURSE`
    found = Findings(False, values, FORWARD, spreads, remarks, scene)
    if not status & IMPOSSIBLE:
        return found
    answer = _answers(case, source, samples, seed, units)[0]
    lines = [line for line in _lines(answer, units) if line[0] in ("NO IMPACT", "IMPOSSIBLE")]
    is_impossible = bool(answer.impossible)
    return found._replace(lines=lines, impossible=is_impossible, adverse=answer.is_adverse)


def _answers(case: Case, source: str, samples: int, seed: int, units: System) -> list[Answer]:
    """Return every impact that agrees with the case, as ``reconstruct`` finds them."""
    from ...collision.uncertain import read, skid_remarks
    from ..reconstruction.answer import answers

    texts = {n: text for n, text in case.values.items() if text.strip() and n in KNOWABLE}
    texts.setdefault("M", DEFAULT_M)
    known = {n: read(t, f"{source}: {n}", units=units.name or None) for n, t in texts.items()}
    said = [*remark_lines(case.remarks), *skid_remarks(texts)]
    try:
        return answers(known, samples, seed, remarks=said)
    except UserError as error:
        raise UserError(str(error), source) from None


def _lines(answer: Answer, units: System) -> list[tuple[str, str, bool]]:
    """Return the first lines of an answer, and for each whether it is adverse."""
    from ..reconstruction.answertable import first_lines, is_adverse

    return [(*line, is_adverse(answer, line[0])) for line in first_lines(answer, units)]


def _inverse(case: Case, source: str, samples: int, seed: int, units: System) -> Findings:
    from ..reconstruction.answer import QUANTILES
    from ..reconstruction.answerremarks import remarks_on

    answer, *others = _answers(case, source, samples, seed, units)
    sought = [n for n in INVERSE if n not in answer.given or n in answer.names]
    values = without_noise(answer.values)
    spreads = {}
    for name in [n for n in answer.names if n in sought]:
        low = high = lower = upper = math.nan
        if answer.draws:
            low, _, high = answer.draws.spread(name, QUANTILES).quantiles.values()
            lower, upper = answer.ranges[name].lower, answer.ranges[name].upper
        drivers = [
            f"{known} {100 * share:.0f} %"
            for known, share in answer.drivers[name][:DRIVERS]
            if share >= 0.005
        ]
        deviation = float(answer.deviations[name])
        spreads[name] = Spread(deviation, low, high, lower, upper, drivers)
    remarks = remarks_on(answer, units)
    forbidden = sum(bool(one.impossible) for one in (answer, *others))
    possible = 1 + len(others) - forbidden
    if possible > 1:
        remarks.append(f"{possible} impacts agree with what is known; this is the first of them")
    if possible and forbidden:
        which = (
            "impact that physics forbids fits"
            if forbidden == 1
            else ("impacts that physics forbids fit")
        )
        remarks.append(f"{forbidden} {which} what is known besides")
    elif forbidden > 1:
        remarks.append(
            f"{forbidden} impacts fit what is known, and physics forbids each of them; this is the "
            "first of them"
        )
    scene = {n: values[n] for n in SCENE if n in values}
    scene.setdefault("M", float(DEFAULT_M))
    if scene["M"] == 4 or "EM" not in scene:
        scene["EM"] = 0.0  # which nothing drawn depends on
    return Findings(
        True,
        values,
        sought,
        spreads,
        remarks,
        scene,
        lines=_lines(answer, units),
        contradictory=answer.evidence.contradictory,
        adjusted=answer.solution.adjusted,
        redundancy=answer.solution.redundancy,
        impossible=bool(answer.impossible),
        adverse=answer.is_adverse,
    )


def _units_text(units: System) -> str:
    """Return the units in words."""
    if units.is_bare:
        return "any consistent set"
    rules = (LENGTH, MASS, VELOCITY, SPIN)
    return ", ".join([*(units.label(rule) for rule in rules), "angles in degrees"])


DRAWN = 150.0
"""Width of the drawing in mm, before the page enlarges it."""
_NOTE = 7.0  # in mm: height of the note below it
_BETWEEN = {"letter": 182.0, "a4": 176.0}  # in mm: between the margins
_LINE = 4.9  # in mm: height of a line of a paragraph
_SMALL = 3.9  # in mm: height of a line of a remark
_CHARACTERS = {"letter": (104, 118), "a4": (100, 114)}
"""Characters in a line of a paragraph and of a remark."""


def _room(paper: str, sentences: Sequence[str], remarks: Sequence[str]) -> float:
    """Return about the height in mm that the texts of the first page leave for what is drawn."""
    wide, small = _CHARACTERS[paper]

    def lines(texts: Sequence[str], most: int) -> int:
        return sum(-(-len(text) // most) for text in texts)

    height = _LINE * lines(sentences, wide)
    height += _SMALL * lines(remarks, small) + (8.0 if remarks else 0.0) + 30.0
    remaining = (FIRST_PAGE[paper] - height) * DRAWN / _BETWEEN[paper]
    return min(max(remaining - _NOTE, 42.0), 110.0)


def _amount(name: str, value: float, units: System, like: float = math.nan) -> str:
    """Return a value as it is shown: two digits of its standard deviation, or five of itself."""
    amount = float(units.display(name, float(value)))
    if math.isnan(amount):
        return ""
    if math.isinf(amount):
        return "unbounded"
    if like > 0 and math.isfinite(like):
        return format_fixed(amount, max(0, 1 - math.floor(math.log10(like * units.factor(name)))))
    return f"{amount:,.0f}" if 1e4 <= abs(amount) < 1e12 else number(amount, 4)


def _deviation(name: str, value: float, units: System) -> str:
    """Return a standard deviation as it is shown, which has no sign."""
    return _amount(name, value, units._replace(convention=None), value)


def _sentences(found: Findings, units: System) -> list[str]:
    """Return the answer of a scene, in a sentence for each vehicle; a reconstruction has lines."""
    lines = []
    for vehicle in "" if found.inverse else "AB":
        words = []
        for word, name in (("speed before", "S{}"), ("after", "S{}F"), ("ΔV", "DV{}")):
            name = name.format(vehicle)
            if math.isfinite(found.values.get(name, math.nan)):
                words.append(f"{word} {_spoken(found, name, units)}")
        pdof = found.values.get(f"PDOF{vehicle}", math.nan)
        if math.isfinite(pdof):
            words.append(f"force from {pdof:.0f}°, {clock(pdof)}")
        if words:
            lines.append(f"{vehicle}: {', '.join(words)}")
    return lines


FIRST_PAGE = {"letter": 208, "a4": 226}
"""Height in mm of what stands on the first page below its title: the drawing takes what is left."""
_FIGURES = 4  # both speeds and both changes of velocity
MAIN_FORWARD = ("DVA", "DVB", "LOSS")
"""The three numbers of the first page, of a scene."""
MAIN_INVERSE = ("SA", "SB", "DVA", "DVB", "LOSS")
"""Candidates for the numbers of the first page of a reconstruction: the first four not given."""


def _spoken(found: Findings, name: str, units: System) -> str:
    """Return a result as a sentence has it, with its standard deviation where it has one."""
    spread = found.spreads.get(name, Spread())
    like, value = spread.deviation, found.values[name]
    text = _amount(name, value, units, like)
    if _is_aside(found, name):  # as of a speed that fits best at standstill
        ends = [_amount(name, x, units, like) for x in (spread.low, spread.high)]
        text = f"{ends[0]} to {ends[1]}"
    deviation = _deviation(name, like, units) if math.isfinite(like) else ""
    aside = f" (sd {deviation})" if deviation and not _is_aside(found, name) else ""
    return f"{text} {_unit(name, units)}".strip() + aside


def _is_aside(found: Findings, name: str) -> bool:
    """Return True if the best fit lies outside 90 % of the draws: its deviation would mislead."""
    spread, value = found.spreads.get(name, Spread()), found.values[name]
    has_quantiles = math.isfinite(spread.low) and math.isfinite(spread.high)
    return has_quantiles and not spread.low <= value <= spread.high


def _chosen(found: Findings) -> list[str]:
    main = MAIN_INVERSE if found.inverse else MAIN_FORWARD
    names = [n for n in main if math.isfinite(found.values.get(n, math.nan))]
    if found.inverse:
        input_names = {item.name for item in found.adjusted}
        names = [n for n in names if n in found.main and n not in input_names]
        # what exact values settle by themselves is no finding beside what is uncertain
        open_ones = [n for n in names if math.isfinite(found.spreads.get(n, Spread()).deviation)]
        names = open_ones or names
    return names[:_FIGURES]


def _figures(found: Findings, units: System) -> list[tuple[str, str, str]]:
    """Return the numbers of the first page: meaning, amount, and standard deviation and limits."""
    figures = []
    for name in _chosen(found):
        spread = found.spreads.get(name, Spread())
        ends = [_amount(name, x, units, spread.deviation) for x in (spread.low, spread.high)]
        has_limits = all(ends) and not found.contradictory
        span = f"{ends[0]} to {ends[1]} {_unit(name, units)}".strip()
        if has_limits and _is_aside(found, name):
            limits = f"90 % of the draws; {_amount(name, found.values[name], units)} fits best"
            figures.append((quantity(name).meaning, _spoken(found, name, units), limits))
            continue
        parts = []
        if math.isfinite(spread.deviation):
            parts.append(f"sd {_deviation(name, spread.deviation, units)}")
        bounds = [_amount(name, x, units, spread.deviation) for x in (spread.lower, spread.upper)]
        if has_limits and all(bounds):
            parts.append(f"bounds {bounds[0]} to {bounds[1]}")
        if has_limits:
            parts.append(f"90 % within {span}")
        amount = _amount(name, found.values[name], units, spread.deviation)
        figures.append(
            (quantity(name).meaning, f"{amount} {_unit(name, units)}".strip(), ", ".join(parts))
        )
    return figures


def _summary(found: Findings, case: Case, units: System) -> list[str]:
    """Return the paragraphs of the first page: what was asked and found, where no lines say it, and
    how sure it is."""
    paragraphs, answer = [], ""
    if not found.inverse:
        given_names = [n for n, text in case.given.items() if text.strip() and n not in ABOUT]
        paragraphs.append(
            "Asked: how two vehicles moved after they struck one another, and what their "
            f"velocities changed by, from {len(given_names)} given values."
        )
        parts = [f"{quantity(n).meaning} {_spoken(found, n, units)}" for n in _chosen(found)]
        answer = f"Found: {'; '.join(parts) if parts else 'none of the results asked for'}. "
    if found.impossible and not found.contradictory:
        sure = (
            "This impact breaks physics, so these numbers settle nothing until what is known is "
            "corrected"
        )
    elif found.contradictory:
        sure = (
            "The values given contradict one another, so these numbers are a compromise between "
            "them and settle nothing until the contradiction is resolved"
        )
    elif any(math.isfinite(spread.deviation) for spread in found.spreads.values()):
        sure = (
            "What is called sd is one standard deviation, 90 % holds so many of the draws; both "
            "follow from the limits given with the inputs and cover no other error"
        )
    elif found.adjusted:
        sure = "The limits given leave these numbers no spread that could be computed"
    else:
        sure = "No limits were given with the inputs, so how sure this is was not computed"
    return [*paragraphs, f"{answer}{sure}."]


def _validation_text() -> str:
    """Return a sentence on the tests that the equations were validated against, and the
    differences."""
    from ..chapter.validation import IIHS, NHTSA, checks, medians

    rows = {(row[0], row[1]): row for row in medians(checks())}
    along, spin = rows[IIHS, "ΔV along the course"], rows[IIHS, "change of spin"]
    change = max(rows[NHTSA, f"ΔV, {vehicle}"][6] for vehicle in "AB")
    return (
        "Validated against four NHTSA oblique offset tests as a published planar impact model has "
        f"them (SAE 2006-01-0908; ΔV within {change:.2f} mph) and {along[4]} small overlap tests "
        f"as measured (joe-cormier/pycrash; median difference of ΔV along the course "
        f"{along[5]:.2f} ft/s, of the change of spin {spin[5]:.1f}°/s, largest {along[6]:.1f} ft/s "
        f"and {spin[6]:.0f}°/s): impact88 chapter staged --validation shows every number. How near "
        "this impact comes is not known from that."
    )


def _unit(name: str, units: System) -> str:
    label = units.label(quantity(name).unit)
    return {"percent": "%", "1": ""}.get(label, label)


def _exists(found: Findings, name: str) -> bool:
    """Return False for the course of a vehicle that stands."""
    return name not in COURSES or found.values.get(f"S{name[1:]}") != 0


def _answer(found: Findings, units: System) -> Table:
    has_draws = any(math.isfinite(spread.low) for spread in found.spreads.values())
    heads = _SPREAD if has_draws else _SPREAD[: 2 if found.spreads else 1]
    caption = (
        "sd: standard deviation"
        if not has_draws
        else _CAPTION + "; none are sought for speeds after" * (not found.inverse)
    )
    rows = []
    for name in found.main:
        if name in found.values and _exists(found, name):
            spread = found.spreads.get(name, Spread())
            if units.is_turned(name):
                spread = spread._replace(
                    low=spread.high, high=spread.low, lower=spread.upper, upper=spread.lower
                )
            numbers = (found.values[name], *spread[:5])[: len(heads)]
            cells = [_amount(name, x, units, spread.deviation) for x in numbers]
            if len(cells) > 1:
                cells[1] = _deviation(name, spread.deviation, units)
            rows.append([name, quantity(name).meaning, *cells, _unit(name, units)])
    headings = ["", "result", *heads, "unit"]
    left_columns = (0, 1, len(headings) - 1)
    return Table("Answer", headings, rows, left_columns, caption if found.spreads else "")


def _details(found: Findings, case: Case, units: System) -> list[Table]:
    rows = []
    for name, text in case.given.items():
        if name in ABOUT or not text.strip():
            continue
        bare = not any(map(str.isalpha, text.replace("e", "").replace("E", ""))) and "°" not in text
        unit = units.unit(name) if bare and "'" not in text else ""
        source = [case.sources.get(name, "")]
        source += ["estimate: " + case.estimated[name]] if name in case.estimated else []
        rows.append([name, quantity(name).meaning, text, unit, "; ".join(filter(None, source))])
    headings = ["", "input", "given", "unit", "source"]
    tables = []
    if found.redundancy:
        measured_rows = [
            [
                item.name,
                quantity(item.name).meaning,
                _amount(item.name, item.measured, units, item.tolerance),
                _amount(item.name, item.adjusted, units, item.tolerance),
                format_fixed(item.normalized_residual, 2),
                _unit(item.name, units),
            ]
            for item in found.adjusted
        ]
        heads = ["", "value", "measured", "adjusted", "moved, sd", "unit"]
        caption = "moved: adjusted less measured, in standard deviations of what was measured"
        tables.append(Table("Measured and adjusted", heads, measured_rows, (0, 1, 5), caption))
    tables.append(Table("Inputs as given", headings, rows, (0, 1, 3, 4)))
    rows = [
        [name, quantity(name).meaning, ", ".join(spread.drivers)]
        for name, spread in found.spreads.items()
        if spread.drivers
    ]
    if rows:
        caption = "how far the result goes while one input goes through its limits"
        caption = f"{'share of the variance' if found.inverse else caption}, largest first"
        headings = ["", "result", "driven by"]
        tables.append(Table("What drives the result", headings, rows, (0, 1, 2), caption=caption))
    rows = [
        [n, quantity(n).meaning, _amount(n, found.values[n], units), _unit(n, units)]
        for n in _CONSEQUENCES
        if math.isfinite(found.values.get(n, math.nan)) and _exists(found, n)
    ]
    tables.append(Table("The impact in full", ["", "quantity", "value", "unit"], rows, (0, 1, 3)))
    return tables
