"""The report of a collision: forward from a scene, inverse from a reconstruction file."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..errors import UserError
from ..figures.canvas import svg
from ..figures.sceneview import scene_drawing
from ..names import DEFAULT_M, SCENE, check_names, quantity
from ..plaintable import fixed, number
from ..reconstruction.contact import MOVES, moved, placed
from ..reconstruction.impulse import clock
from ..reconstruction.knowable import KNOWABLE
from ..scene import Entries
from ..status import sentences
from ..units import RULES, System, base_of, system_of
from .frame import render

FIGURE_WIDTH = 150.0
"""Of the drawing, in mm: what both papers leave between their margins, less a little."""
DRIVERS = 3
"""Inputs named for each result: they fill a line."""
FORWARD = ("VAX", "VAY", "WAF", "VBX", "VBY", "WBF", "DVA", "DVB", "LOSS")
"""Results that a scene's ranges are followed to."""
INVERSE = (
    *("SA", "HA", "SB", "HB", "UX", "UY", "WA", "VX", "VY", "WB", "SAF", "SBF", "DVA", "DVB"),
    *("LOSS", "E", "MUP", "EM"),
)
"""Results of a reconstruction that the answer shows, where they were not known."""
_SPREAD: tuple[str, ...] = ("value", "sd", "5 %", "95 %", "lower bound", "upper bound")
_CAPTION = (
    "sd: standard deviation; 5 and 95 %: of the draws; bounds: attained within the limits of the "
    "inputs, not proven to be the farthest"
)
_CONSEQUENCES = (
    *("SA", "HA", "SAF", "HAF", "DVA", "DVAF", "DVAR", "PDOFA"),
    *("SB", "HB", "SBF", "HBF", "DVB", "DVBF", "DVBR", "PDOFB"),
    *("P", "E", "MUP", "MUC", "EM", "KI", "KF", "EL", "LOSS"),
)


class Table(NamedTuple):
    """One table of a report; columns in ``left`` start at the left; ``place``: before the figure
    ("answer") or after it ("content")."""

    title: str
    headings: Sequence[str]
    rows: Sequence[Sequence[str]]
    left: Sequence[int]
    place: str = "content"
    caption: str = ""


class Spread(NamedTuple):
    """How uncertain a result is, in base units; NaN for what is not known."""

    deviation: float = math.nan
    low: float = math.nan
    high: float = math.nan
    lower: float = math.nan
    upper: float = math.nan


class Findings(NamedTuple):
    """An impact's ``values`` with all that follows, the ``spreads`` of its ``main`` results, the
    ``drivers`` of each, ``remarks`` in sentences, and the ``scene`` that is drawn; ``inverse``:
    whether it was reconstructed."""

    inverse: bool
    values: Mapping[str, float]
    main: Sequence[str]
    spreads: Mapping[str, Spread]
    drivers: Mapping[str, Sequence[str]]
    remarks: Sequence[str]
    scene: Mapping[str, float]
    settings: str


class Report(NamedTuple):
    """The page, and its tables for other programs."""

    page: str
    tables: list[Table]


def report(
    entries: Entries,
    source: str,
    data: bytes,
    *,
    samples: int,
    seed: int,
    case: str = "",
    title: str = "",
    paper: str = "",
) -> Report:
    """The report of what a file (``source``, its bytes ``data``) says of a collision: forward for
    a whole scene with nothing after the impact, else reconstructed. Raises UserError."""
    units = system_of(entries.units)
    given = {n for n, text in entries.values.items() if text.strip()}
    scene = placed(SCENE, given)
    whole = set(scene) - {"M"} <= given <= {*scene, *MOVES, "correlations"}
    check_names(
        given - {"correlations"}, placed((*KNOWABLE, *MOVES), given), "name used here", source
    )
    find = _forward if whole else _inverse
    found = find(entries, source, samples, seed, units)
    case = case or entries.case or ""
    title = title or entries.title or "Planar impact of two vehicles"
    drawing = None
    if set(SCENE) <= set(found.scene):  # what is not determined cannot be drawn
        look = (FIGURE_WIDTH, "Scene from above", units, entries.outlines)
        drawing = scene_drawing(found.scene, found.values, *look)
    tables = [_answer(found, units), *_details(found, entries, units)]
    page = render(
        "collision.html",
        title=title,
        case=case,
        paper=paper or ("letter" if units.name in ("us", "chapter", "") else "a4"),
        files=[(source, data)],
        inverse=found.inverse,
        uncertain=bool(found.spreads),
        base=base_of(units),
        units="any consistent set" if units is RULES else f"those of the file ({units.name})",
        answer=_sentences(found, units),
        tables=tables,
        drawing=svg(drawing) if drawing else "",
        figure_caption=drawing.description if drawing else "",
        remarks=[*entries.remarks.values(), *found.remarks],
        doubtful=bool(found.remarks),
        settings=found.settings,
    )
    return Report(page, tables)


def _forward(entries: Entries, source: str, samples: int, seed: int, units: System) -> Findings:
    from ..closedform.solve import share_typed, solve
    from ..reconstruction.solutiontable import completed
    from ..uncertainty.bounds import bounds
    from ..uncertainty.ranges import read_inputs

    inputs = read_inputs(entries.values, {}, "forward", source)
    nominal = moved({name: item.nominal for name, item in inputs.values.items()})
    if inputs.values["MU"].share:
        nominal["MU"] = share_typed(nominal, nominal["MU"])
    results = {name: float(value) for name, value in solve(nominal).items()}
    values = completed({**{n: float(v) for n, v in nominal.items()}, **results}, None)
    spreads: dict[str, Spread] = {}
    drivers: dict[str, list[str]] = {}
    remarks = sentences(int(results["STATUS"]), {**nominal, **results})
    settings = ""
    if any(item.varies for item in inputs.values.values()):
        drawn: dict[str, Any] = {"samples": samples, "seed": seed, "keep_draws": True}
        found = bounds(inputs.values, FORWARD, correlations=inputs.correlations, **drawn)
        for vehicle in "AB":
            speeds = np.hypot(found.draws[f"V{vehicle}X"], found.draws[f"V{vehicle}Y"])
            speeds = speeds[np.isfinite(speeds)]
            low, high = np.quantile(speeds, (0.05, 0.95)).tolist()
            spreads[f"S{vehicle}F"] = Spread(float(speeds.std(ddof=1)), low, high)
        for name, bound in found.bounds.items():
            spread = found.spreads[name]
            low, high = spread.quantiles[0.05], spread.quantiles[0.95]
            spreads[name] = Spread(spread.deviation, low, high, bound.lower, bound.upper)
            ranked = sorted(found.drives[name].items(), key=lambda entry: -entry[1].swing)
            drivers[name] = [
                f"{source} {number(drive.swing * units.factor(name), 3)} {units.unit(name)}".strip()
                for source, drive in ranked[:DRIVERS]
                if drive.swing > 0
            ]
        remarks += [
            f"{100 * share:.3g} % of the draws carry the warning {name}"
            for name, share in found.warnings.items()
        ]
        settings = f"{samples:,} random draws, seed {seed}."
    scene = {name: float(nominal[name]) for name in SCENE}
    main = ("SAF", "SBF", *FORWARD)
    return Findings(False, values, main, spreads, drivers, remarks, scene, settings)


def _inverse(entries: Entries, source: str, samples: int, seed: int, units: System) -> Findings:
    from ..reconstruction.adjustment import reconstruct
    from ..uncertainty.reconstructedtable import Measured
    from ..uncertainty.uncertain import read

    texts = {n: text for n, text in entries.values.items() if text.strip() and n in KNOWABLE}
    texts.setdefault("M", DEFAULT_M)
    try:
        found = reconstruct(
            {n: read(t, f"{source}: {n}", units=units.name or None) for n, t in texts.items()}
        )
    except UserError as error:
        text = str(error)
        raise UserError(text if text.startswith(source) else f"{source}: {text}") from None
    best = found[0]
    sought = [n for n in INVERSE if n not in best.system.known]
    whole = Measured.of(best, samples, seed, sought)
    values, spread = whole.values, whole.spread
    wanted = [n for n in sought if n in values]
    spreads, drivers = {}, {}
    for name in spread.names:
        low = high = lower = upper = math.nan
        if spread.draws:
            low, high = spread.draws.spread(name, (0.05, 0.95)).quantiles.values()
            lower, upper = spread.ranges[name].lower, spread.ranges[name].upper
        spreads[name] = Spread(float(spread.deviations[name]), low, high, lower, upper)
        drivers[name] = [
            f"{known} {100 * share:.0f} %"
            for known, share in spread.drivers[name][:DRIVERS]
            if share >= 0.005
        ]
    remarks = whole.warnings(units)
    if len(found) > 1:
        remarks.append(f"{len(found)} impacts agree with what is known; this is the first of them")
    scene = {n: values[n] for n in SCENE if n in values}
    scene.setdefault("M", float(DEFAULT_M))
    if scene["M"] == 4 or "EM" not in scene:
        scene["EM"] = 0.0  # which nothing drawn depends on
    settings = f"{samples:,} random draws, seed {seed}." if spread.draws else ""
    return Findings(True, values, wanted, spreads, drivers, remarks, scene, settings)


def _amount(name: str, value: float, units: System, like: float = math.nan) -> str:
    """A value as it is shown: two digits of its standard deviation, or five of itself."""
    shown = value * units.factor(name)
    if math.isnan(shown):
        return ""
    if math.isinf(shown):
        return "unbounded"
    if like > 0 and math.isfinite(like):
        return fixed(shown, max(0, 1 - math.floor(math.log10(like * units.factor(name)))))
    return f"{shown:,.0f}" if 1e4 <= abs(shown) < 1e12 else number(shown, 4)


def _sentences(found: Findings, units: System) -> list[str]:
    """The answer, in a sentence for each vehicle."""

    def said(name: str) -> str:
        if name not in found.values:
            return ""
        spread = found.spreads.get(name, Spread())
        text = _amount(name, found.values[name], units, spread.deviation)
        if math.isfinite(spread.deviation):
            text += f" ± {_amount(name, spread.deviation, units, spread.deviation)}"
        return f"{text} {units.unit(name)}".strip()

    lines = []
    for vehicle in "AB":
        asked = {"speed before": f"S{vehicle}", "after": f"S{vehicle}F", "ΔV": f"DV{vehicle}"}
        words = [f"{word} {said(name)}" for word, name in asked.items() if said(name)]
        pdof = found.values.get(f"PDOF{vehicle}", math.nan)
        if math.isfinite(pdof):
            words.append(f"force from {pdof:.0f}°, {clock(pdof)}")
        if words:
            lines.append(f"{vehicle}: {', '.join(words)}")
    return lines


def _unit(name: str, units: System) -> str:
    label = units.label(quantity(name).unit)
    return {"percent": "%", "1": ""}.get(label, label)


def _answer(found: Findings, units: System) -> Table:
    heads, caption = _SPREAD[:1], ""
    if found.spreads:
        heads, caption = _SPREAD, _CAPTION
        caption += "; none are sought for speeds after" if "SAF" in found.main[:1] else ""
    rows = []
    for name in found.main:
        if name in found.values:
            spread = found.spreads.get(name, Spread())
            shown = (found.values[name], *spread)[: len(heads)]
            cells = [_amount(name, x, units, spread.deviation) for x in shown]
            rows.append([name, quantity(name).meaning, *cells, _unit(name, units)])
    headings = ["", "result", *heads, "unit"]
    return Table("Answer", headings, rows, (0, 1, len(headings) - 1), "answer", caption)


def _details(found: Findings, entries: Entries, units: System) -> list[Table]:
    rows = []
    for name, text in entries.given.items():
        if name in ("title", "case", "units", "correlations") or not text.strip():
            continue
        bare = not any(map(str.isalpha, text.replace("e", "").replace("E", ""))) and "°" not in text
        unit = units.unit(name) if bare and "'" not in text else ""
        source = entries.sources.get(name, "")
        if name in entries.estimated:
            source = "; ".join(filter(None, [source, "estimate: " + entries.estimated[name]]))
        rows.append([name, quantity(name).meaning, text, unit, source])
    headings = ["", "input", "given", "unit", "source"]
    tables = [Table("Inputs as given", headings, rows, (0, 1, 3, 4))]
    if found.drivers:
        rows = [
            [name, quantity(name).meaning, ", ".join(ranked)]
            for name, ranked in found.drivers.items()
            if ranked
        ]
        caption = "how far the result goes while one input goes through its limits"
        caption = f"{'share of the variance' if found.inverse else caption}, largest first"
        headings = ["", "result", "driven by"]
        tables.append(Table("What drives the result", headings, rows, (0, 1, 2), caption=caption))
    rows = [
        [n, quantity(n).meaning, _amount(n, found.values[n], units), _unit(n, units)]
        for n in _CONSEQUENCES
        if math.isfinite(found.values.get(n, math.nan))
    ]
    tables.append(Table("The impact in full", ["", "quantity", "value", "unit"], rows, (0, 1, 3)))
    return tables
