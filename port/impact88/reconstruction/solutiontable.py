"""A solved impact as tables to read and as JSON to process: what solutions of exact values
(`unknowns`) and reconstructions with tolerances (`uncertainty.reconstructedtable`) share: the
answer in a few lines, then velocities, coefficients, impulse, what follows, remarks.
"""

from __future__ import annotations

import json
import math
from collections.abc import Collection, Mapping, Sequence
from textwrap import wrap
from typing import Any, NamedTuple

from ..errors import UserError
from ..names import CHAPTER, FINAL_STATE, PIVOT, RESULTS, SCENE, VELOCITIES, quantity
from ..plaintable import decimals_for, fixed, number, paragraph, plain, table
from ..schemas import stamped
from ..status import sentences
from ..units import RULES, VELOCITY, System, written
from .doublerange import within_doubles
from .impulse import clock, forces
from .outcome import moment_ratio, outcome
from .state import CHANGES, COURSES, FORCES
from .unknowns import BADLY_CONDITIONED, Solution, solve_for

_ORDER = (*SCENE, *RESULTS, *CHAPTER)
_BARRIERS = (
    *("MB", "IB", "DB", "PB", "TB", "VX", "VY", "WB", "VBX", "VBY", "WBF"),
    *("XB", "YB", "XBF", "YBF", "DVB", "DVBF", "DVBR", "CBX", "CBY", "PDOFB"),
    *("SB", "HB", "SBF", "HBF"),
)
"""What a rigid barrier does not have."""
_TURNING = (
    *("EM", "RR0", "PM", "WA", "WAF", "WB", "WBF", "IA", "IB", "DA", "DB", "PA", "PB"),
    *("XA", "YA", "XB", "YB", "XAF", "YAF", "XBF", "YBF", "CAX", "CAY", "CBX", "CBY"),
)
"""What point masses do not have, or twice."""
_ROAD = {"ft/s": ("mph", 3600 / 5280), "m/s": ("km/h", 3.6)}
"""The unit of speeds on the road."""
_SPINS = ("WA", "WB", "WAF", "WBF")
_SHARE = 0.05
"""Of a speed's variance: less is not named in the answer."""
_LEFT, _WIDTH = 16, 104
"""Characters of the answer's labels and lines."""
_NOISE = 1e-9
"""Of the largest quantity of the same unit: less is rounding, and printed as 0."""


class Spread(NamedTuple):
    """Standard deviation, attained bounds, and shares of the variance by known value."""

    deviation: float
    lower: float = math.nan
    upper: float = math.nan
    drivers: Sequence[tuple[str, float]] = ()


def completed(values: dict[str, float], contact_time: float | None) -> dict[str, float]:
    """An impact's values and what follows from them, in the tables' order."""
    following = {name: float(value) for name, value in outcome(values).items()}
    if contact_time is not None and "P" in following:
        following["TF"] = contact_time
        following |= {n: float(v) for n, v in forces(following["P"], contact_time).items()}
    values = values | following
    if "EM" in values:
        values["RR0"] = float(moment_ratio(values["EM"]))
    absent = _absent(values)
    return {name: values[name] for name in _ORDER if name in values and name not in absent}


def _absent(values: Mapping[str, float]) -> tuple[str, ...]:
    # a barrier's mass is left out of the values
    barrier = _BARRIERS if math.isinf(values.get("MB", math.inf)) else ()
    return (*barrier, *_TURNING) if values.get("M") == 4 else barrier


def tables(
    values: Mapping[str, float],
    known: Collection[str],
    remarks: Sequence[str],
    further: Sequence[Sequence[str]],
    units: System,
    spreads: Mapping[str, Spread] | None = None,
    unknown: Sequence[str] | None = None,
    helpful: Sequence[str] = (),
) -> str:
    """The answer, tables, ``further`` tables and remarks; ``spreads`` of SA SB DVA DVB;
    ``unknown``: what is not determined (by default the velocities without a value), and
    ``helpful``: further values that would determine it."""
    values = _without_noise(values)
    if unknown is None:
        unknown = [n for n in (*VELOCITIES, *FINAL_STATE) if n not in (*values, *_absent(values))]
    named = (
        *(("E", "MUP", "EM", "RR0"), ("PN", "PT", "PM", "P", "PDOFA", "PDOFB")),
        *(("TF", "FA", "FM2", "FM3"), (*CHANGES, "VC", "VS"), ("KI", "KF", "EL", "LOSS")),
    )
    blocks = [
        _answer(values, spreads or {}, unknown, helpful, len(remarks), units),
        _velocities(known, values, units),
        *(_named(names, known, values, units) for names in named),
        *further,
    ]
    lines = [line for block in blocks if block for line in (*block, "")]
    for remark in remarks:
        lines += paragraph(f"! {remark}")
    return "\n".join(lines).rstrip("\n")


def numbers(
    values: Mapping[str, float], known: Collection[str], remarks: Sequence[str], units: System
) -> dict[str, Any]:
    """The same for a program."""
    plain_values = {n: v for n, v in written(values, units).items() if n != "STATUS"}
    return {
        "known": list(known),
        "values": plain_values,
        "units": {n: units.label(quantity(n).unit) for n in plain_values},
        "status": int(values["STATUS"]) if "STATUS" in values else None,
        "warnings": remarks,
    }


def in_turn(texts: Sequence[str], note: str = "") -> str:
    """The solutions one below the other, numbered where there are several."""
    if len(texts) == 1:
        return texts[0]
    total = len(texts)
    return "\n\n".join(f"SOLUTION {i} OF {total}{note}\n\n{t}" for i, t in enumerate(texts, 1))


def _without_noise(values: Mapping[str, float]) -> dict[str, float]:
    """Values below `_NOISE` of the largest of their unit are 0, directions above -180."""
    largest: dict[str, float] = {}
    for name, value in values.items():
        if math.isfinite(value):
            unit = quantity(name).unit
            largest[unit] = max(abs(value), largest.get(unit, 0.0))
    largest["1"] = 0.0  # numbers have no common size
    clean = {}
    for name, value in values.items():
        small = abs(value) < _NOISE * largest.get(quantity(name).unit, 0.0)
        opposite = name in (*COURSES, *FORCES) and value < -179.9995  # to three decimals
        clean[name] = 180.0 if opposite else 0.0 if small else value
    return clean


# -- the answer


def _answer(
    values: Mapping[str, float],
    spreads: Mapping[str, Spread],
    unknown: Sequence[str],
    helpful: Sequence[str],
    remarks: int,
    units: System,
) -> list[str]:
    vehicles = "A" if math.isinf(values.get("MB", math.inf)) else "AB"
    unit = units.label(VELOCITY)

    def size(vehicle: str, name: str) -> str:
        if name not in values:
            return f"{vehicle} unknown"
        shown = units.shown(VELOCITY, values[name])
        text = f"{vehicle} {number(shown, 3)}"
        if units is not RULES:
            road, factor = _ROAD.get(unit, ("", 0.0))
            text += f" {unit}" + (f" ({number(shown * factor, 3)} {road})" if road else "")
        if spread := spreads.get(name):
            deviation, lower, upper = (number(units.shown(VELOCITY, v), 3) for v in spread[:3])
            text += f", sd {deviation}"
            text += f", between {lower} and {upper}" if lower and upper else ""
        return text

    rows = []
    for vehicle in vehicles:
        text, course = size(vehicle, name := f"S{vehicle}"), f"H{vehicle}"
        if values.get(name) and course in values:
            text += f", heading {number(values[course], 3)}".replace("-180", "180")
        rows.append(("BEFORE IMPACT", text))
    for vehicle in vehicles:
        text, origin = size(vehicle, f"DV{vehicle}"), values.get(f"PDOF{vehicle}", math.nan)
        if not math.isnan(origin) and f"DV{vehicle}" in values:
            text += f", force from {clock(origin)} ({number(round(origin), 3)} deg)"
        rows.append(("DELTA-V", text))
    if unknown:
        names = [name for name in unknown if name not in _SPINS]
        text = ", ".join(["spins", *names] if {*_SPINS} <= {*unknown} else unknown)
        if helpful:
            text += ": give " + " and ".join(filter(None, (", ".join(helpful[:-1]), helpful[-1])))
        rows.append(("NOT FOUND", text))
    for vehicle in vehicles:
        drivers = spreads[f"S{vehicle}"].drivers if f"S{vehicle}" in spreads else ()
        named = [f"{name} {100 * share:.0f} %" for name, share in drivers if share >= _SHARE]
        if named:
            rows.append(("DEPENDS ON", f"{vehicle}'s speed: {', '.join(named)}"))
    rows.append(("REMARKS", f"{remarks}, below" if remarks else "none"))
    lines: list[str] = []
    before = ""
    for label, text in rows:
        for part in wrap(text, _WIDTH - _LEFT):
            lines.append(f"{'' if label == before else label:{_LEFT}}{part}")
            before = label
    return lines


# -- the tables

_ROWS = (
    ("x", "length/time", ("UX", "VAX", "VX", "VBX")),
    ("y", "length/time", ("UY", "VAY", "VY", "VBY")),
    ("spin", "rad/time", ("WA", "WAF", "WB", "WBF")),
    ("speed", "length/time", ("SA", "SAF", "SB", "SBF")),
    ("course", "degree", ("HA", "HAF", "HB", "HBF")),
    ("x at contact point", "length/time", ("XA", "XAF", "XB", "XBF")),
    ("y at contact point", "length/time", ("YA", "YAF", "YB", "YBF")),
)


def _velocities(known: Collection[str], values: Mapping[str, float], units: System) -> list[str]:
    values = written(values, units)
    decimals = {
        unit: decimals_for(
            [values[n] for _, own, row in _ROWS if own == unit for n in row if n in values]
        )
        for unit in ("length/time", "rad/time", "degree")
    }
    rows = []
    vehicles = 2 if "VX" in values or "VBX" in values else 1
    for label, unit, all_names in _ROWS:
        names = all_names[: 2 * vehicles]
        if not any(name in values for name in names):
            continue
        cells = []
        for name in names:
            text = fixed(values[name], decimals[unit]) if name in values else "unknown"
            given = name in known or label not in ("x", "y", "spin") or name not in values
            cells.append(f"{text}{' ' if given else '*'}")
        rows.append([label, *cells, units.label(unit)])
    heading = ["A before ", "A after ", "B before ", "B after "][: 2 * vehicles]
    lines = table(rows, ["velocity", *heading, "unit"], left=(0, 1 + 2 * vehicles))
    return [*lines, "* solved for"]


def _named(
    names: Sequence[str], known: Collection[str], values: Mapping[str, float], units: System
) -> list[str]:
    values = written(values, units)
    rows = []
    for name in names:
        if math.isnan(values.get(name, math.nan)):
            continue
        what = quantity(name)
        given = name in known or (name == "MUP" and "MU" in known)
        mark = "*" if name in ("E", "MUP", "EM") and not given else " "
        note = _friction(values) if name == "MUP" else what.meaning
        if name.startswith("PDOF"):
            note += f" ({clock(values[name])})"
        if name == "EM":
            note += f"; {number(-values[name])} with the sign the other way"
        rows.append([name, f"{number(values[name])}{mark}", units.label(what.unit), note])
    return table(rows, left=(0, 2, 3))


def _friction(values: Mapping[str, float]) -> str:
    if values["MUP"] == PIVOT:
        text = "pivot: no sliding at separation"
        if values.get("PN"):
            text += f"; P_t/P_n = {number(values['PT'] / values['PN'])} ends it"
        return text
    text = "signed P_t/P_n"
    if "UX" in values and "MU" in values:
        text += f"; MU to type in line 280: {number(values['MU'])}"
    if "MUC" in values:
        text += f"; critical {number(values['MUC'])}"
    return text


# -- solutions of exact values


class Exact(NamedTuple):
    """A solution of exact values, and everything that follows from it."""

    known: Mapping[str, float]
    solution: Solution
    values: dict[str, float]

    @classmethod
    def all_of(
        cls,
        known: Mapping[str, float],
        wanted: Sequence[str] | None = None,
        contact_time: float | None = None,
    ) -> list[Exact]:
        """Every solution of a single scene. Raises UserError."""
        found = []
        for solution in solve_for(known, wanted):
            values = {**known, **{name: float(value) for name, value in solution.values.items()}}
            found.append(cls(known, solution, completed(values, contact_time)))
        return found

    def warnings(self, units: System = RULES) -> list[str]:
        """What a reader must know, in sentences."""
        lines = []
        if self.solution.contradictory:
            mismatch = units.shown("length/time", float(self.solution.mismatch))
            lines.append(
                "the known values contradict one another: the solution fits them by least squares, "
                f"root-mean-square mismatch {number(mismatch, 3)} [{units.label('length/time')}]"
            )
        bad = [
            f"{name} {number(value, 3)} times"
            for name, value in self.solution.amplification.items()
            if not value < BADLY_CONDITIONED
        ]
        if bad:
            lines.append(
                "badly conditioned: errors of the known velocities are amplified "
                f"({', '.join(bad)})"
            )
        return lines + sentences(int(self.values.get("STATUS", 0)), self.values)

    def as_text(self, units: System = RULES) -> str:
        """The solution as tables."""
        errors = [f"{n} {number(value, 3)}" for n, value in self.solution.amplification.items()]
        conditions = paragraph(
            "Error amplification (error of the unknown when each known velocity errs independently "
            "by 1; spins times the radius of gyration "
            f"{number(self.solution.gyration, 4)}, coefficients times the closing speed): "
            f"{', '.join(errors)}"
        )
        contact = _named(("CAX", "CAY", "CBX", "CBY"), self.known, self.values, units)
        remarks = self.warnings(units)
        return tables(self.values, self.known, remarks, [contact, conditions], units)

    def as_json(self, units: System = RULES) -> dict[str, Any]:
        """The solution for a program; numbers that do not exist are null."""
        known = [name for name in self.values if name in self.known]
        whole: dict[str, Any] = plain(
            {
                **numbers(self.values, known, self.warnings(units), units),
                "solved_for": list(self.solution.unknown),
                "amplification": self.solution.amplification,
                "badly_conditioned": self.solution.badly_conditioned,
                "mismatch": self.solution.mismatch * units.shown("length/time", 1.0),
                "contradictory": self.solution.contradictory,
            }
        )
        return whole


@within_doubles
def show(
    known: Mapping[str, float],
    wanted: Sequence[str] | None,
    source: str | None,
    contact_time: float | None,
    as_object: bool,
    units: System = RULES,
) -> None:
    """Print the solutions of one problem, as tables or as one JSON object; ``source`` names where
    the known values come from in errors, ``units`` how values are written."""
    try:
        solutions = Exact.all_of(known, wanted, contact_time)
    except UserError as error:
        raise UserError(str(error), source) from None
    if as_object:
        solved = [one.as_json(units) for one in solutions]
        print(json.dumps(stamped("reconstruct", {"solutions": solved}), allow_nan=False))
        return
    fit = " (each a fit of values that contradict one another)"
    note = ": MU is known in size, and both signs agree"
    note += fit if solutions[0].solution.contradictory else ""
    print(in_turn([one.as_text(units) for one in solutions], note))
