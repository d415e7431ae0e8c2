"""A solved impact as tables to read and as JSON to process: the answer in a few lines, velocities,
coefficients, impulse, derived quantities, remarks. `Exact` shows an impact of exact values
(`unknowns`), `reconstruction.reconstructedtable.Measured` one with tolerances."""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from textwrap import wrap
from typing import Any, Self

from ...collision.geometry import clock, within_doubles
from ...collision.needs import needs_in_words
from ...collision.units import RULES, System, display_values
from ...errors import UserError
from ...mechanics.outcome import forces, moment_ratio, outcome
from ...mechanics.posed import (
    absent_results,
    is_wrong_way,
    pose,
    turned,
    turned_sentence,
    with_headings,
)
from ...mechanics.state import CHANGES, COURSES, FORCES
from ...messages.plaintable import decimals_for, format_fixed, number, paragraph, plain, table
from ...names import CHAPTER, FINAL_STATE, PIVOT, RESULTS, SCENE, VELOCITIES, VELOCITY, quantity
from ...status import IMPOSSIBLE, sentences
from .unknowns import BADLY_CONDITIONED, Solution, solve_for

_ORDER = (*SCENE, *RESULTS, *CHAPTER)
# Quantities that a rigid barrier does not have
_NOT_OF_BARRIERS = (*(name for name in _ORDER if "B" in name), "VX", "VY")
# Quantities that point masses do not have, or that repeat others
_NOT_OF_POINT_MASSES = (
    "EM RR0 PM WA WAF WB WBF IA IB DA DB PA PB XA YA XB YB XAF YAF XBF YBF CAX CAY CBX CBY"
).split()
_ROAD = {"ft/s": ("mph", 3600 / 5280), "m/s": ("km/h", 3.6)}  # units of speeds on the road
_SPINS = ("WA", "WB", "WAF", "WBF")
DRIVERS = 3  # values named as the causes of a result's uncertainty
_MIN_FRACTION = 0.05  # of a result's variance, for a value to be named
_LABEL_WIDTH = 16  # characters
_WIDTH = 100
# A value smaller than this fraction of the largest of its unit is rounding, and printed as 0. Twice
# as much prints the same for 100 solutions.
NOISE = 1e-9
ROUNDING = 1e-13  # fraction below which a value is rounding, and 0, in JSON
_COEFFICIENT_NOISE = 1e-13  # a coefficient below is rounding
_ROWS = (
    ("x", "length/time", ("UX", "VAX", "VX", "VBX")),
    ("y", "length/time", ("UY", "VAY", "VY", "VBY")),
    ("spin", "rad/time", ("WA", "WAF", "WB", "WBF")),
    ("speed", "length/time", ("SA", "SAF", "SB", "SBF")),
    ("course", "degree", ("HA", "HAF", "HB", "HBF")),
    ("x at contact point", "length/time", ("XA", "XAF", "XB", "XBF")),
    ("y at contact point", "length/time", ("YA", "YAF", "YB", "YBF")),
)


def with_derived_values(values: dict[str, float], contact_time: float | None) -> dict[str, float]:
    """Return an impact's values and everything that follows from them, in the tables' order."""
    derived = {name: float(value) for name, value in outcome(values).items()}
    if contact_time is not None and "P" in derived:
        derived["TF"] = contact_time
        derived |= {n: float(v) for n, v in forces(derived["P"], contact_time).items()}
    values = with_headings(values | derived)
    if "EM" in values:
        values["RR0"] = float(moment_ratio(values["EM"]))
    absent = _absent_quantities(values)
    return {name: values[name] for name in _ORDER if name in values and name not in absent}


def _absent_quantities(values: Mapping[str, float]) -> tuple[str, ...]:
    """Return the quantities that this impact's vehicles do not have: a rigid barrier, point
    masses."""
    # a barrier's mass is left out of the values
    barrier = _NOT_OF_BARRIERS if math.isinf(values.get("MB", math.inf)) else ()
    return (*barrier, *_NOT_OF_POINT_MASSES) if values.get("M") == 4 else barrier


class Impact:
    """A solved impact, in base units.

    ``known``: the known values; ``values``: all values; ``undetermined``: what nothing determines,
    reported apart from the remarks; ``helpful``: further values that would determine it; ``note``:
    a remark on several solutions; ``remarks``: on what was made of the problem; ``absent``:
    results that need an input that is not given, and which; ``deviations``: standard deviations of
    the uncertain results; ``ranges``: their bounds; ``drivers``: for each the known values that
    cause its uncertainty,
    with their fractions of its variance."""

    undetermined: Sequence[str] = ()
    helpful: Sequence[str] = ()
    note = ""
    remarks: Sequence[str] = ()
    absent: Mapping[str, Collection[str]] = {}
    subject = "this impact"

    def __init__(self, known: Mapping[str, Any], values: dict[str, float]) -> None:
        self.known, self.values = known, values
        self.deviations: Mapping[str, float] = {}
        self.ranges: Mapping[str, Any] = {}
        self.drivers: Mapping[str, Sequence[tuple[str, float]]] = {}

    @property
    def uncertainties(self) -> Mapping[str, float]:
        """Standard deviations, of known values too. A value far below its own deviation is printed
        as 0."""
        return self.deviations

    def headline(self, units: System) -> Sequence[tuple[str, str]]:
        """Return labels and texts to print above the answer."""
        return [("IMPOSSIBLE", self.impossible)] if self.impossible else []

    @property
    def impossible(self) -> str:
        """A sentence that names the broken rules of physics; "" for a possible impact."""
        broken = int(self.values.get("STATUS", 0)) & IMPOSSIBLE
        reasons = "; ".join(sentences(broken))
        return f"{self.subject} breaks physics: {reasons}" if broken else ""

    def warnings(self, units: System = RULES) -> list[str]:
        """Return the warnings, a sentence each."""
        needs = [f"{sentence}" for _, sentence in needs_in_words(self.absent)]
        return [*sentences(int(self.values.get("STATUS", 0)), self.values), *self.remarks, *needs]

    def further_tables(self, units: System) -> list[list[str]]:
        """Return the tables of a subclass, as lines."""
        return []

    def json_items(self, units: System) -> dict[str, Any]:
        """Return the JSON items of a subclass."""
        return {}

    @within_doubles
    def as_text(self, units: System = RULES, full: bool = True) -> str:
        """Return the answer, tables and remarks as text; unless ``full``, the answer, the
        velocities and the remarks alone."""
        remarks = self.warnings(units)
        undetermined = [paragraph(f"! {remarks.pop(0)}")] if self.undetermined else []
        clean = without_noise(self.values, deviations=self.uncertainties)
        values = display_values(clean, units)
        groups: Sequence[Sequence[str]] = (
            ("E", "MUP", "EM", "RR0"),
            ("PN", "PT", "PM", "P", "PDOFA", "PDOFB"),
            ("TF", "FA", "FM2", "FM3"),
            (*CHANGES, "VC", "VS"),
            ("KI", "KF", "EL", "LOSS"),
        )
        blocks = [
            [*self._answer_lines(clean, len(remarks), units)],
            self._velocity_table(values, units),
            *(self._quantity_table(names, values, units) for names in groups if full),
            *(self.further_tables(units) if full else ()),
            *undetermined,
        ]
        lines = [line for block in blocks if block for line in (*block, "")]
        for remark in remarks:
            lines += paragraph(f"! {remark}")
        return "\n".join(lines).rstrip("\n")

    @within_doubles
    def as_json(self, units: System = RULES) -> dict[str, Any]:
        """Return everything as a JSON object; numbers that do not exist are null."""
        # given values are not rounded
        given = {n: v for n, v in self.values.items() if self.known.get(n) == v}
        clean = {**without_noise(self.values, ROUNDING, self.uncertainties), **given}
        values = {n: v for n, v in display_values(clean, units).items() if n != "STATUS"}
        record: dict[str, Any] = plain(
            {
                "known": [*self.known],
                "values": values,
                "units": {n: units.label(quantity(n).unit) for n in values},
                "status": int(self.values["STATUS"]) if "STATUS" in self.values else None,
                "warnings": self.warnings(units),
                "absent": {name: sorted(needs) for name, needs in self.absent.items()},
                **self.json_items(units),
            }
        )
        return record

    def _answer_lines(
        self, values: Mapping[str, float], remarks: int, units: System
    ) -> Iterator[str]:
        """Yield the lines of the answer: speeds, delta-v, and everything the reader must know
        first."""
        unit = units.label(VELOCITY)

        def size(vehicle: str, name: str) -> str:
            if name not in values:
                return f"{vehicle} unknown"
            speed = units.display_value(VELOCITY, values[name])
            text = f"{vehicle} {number(speed, 3)}"
            if not units.is_bare:
                road, factor = _ROAD.get(unit, ("", 0.0))
                text += f" {unit}" + (f" ({number(speed * factor, 3)} {road})" if road else "")
            if name in self.drivers and not self.impossible:  # no interval is about that
                bound = self.ranges.get(name)
                sizes = (self.deviations[name], *((bound.lower, bound.upper) if bound else ()))
                deviation, *ends = (
                    number(units.display_value(VELOCITY, size), 3) for size in sizes
                )
                text += f", sd {deviation}"
                text += f", between {ends[0]} and {ends[1]}" if ends and all(ends) else ""
            return text

        rows = [*self.headline(units)]
        vehicles = "A" if math.isinf(values.get("MB", math.inf)) else "AB"
        for vehicle in vehicles:
            text, course = size(vehicle, name := f"S{vehicle}"), f"H{vehicle}"
            if values.get(name) and course in values:
                text += f", heading {number(units.display(course, values[course]), 3)}".replace(
                    "-180", "180"
                )
            rows.append(("BEFORE IMPACT", text))
        for vehicle in vehicles:
            text, origin = size(vehicle, f"DV{vehicle}"), values.get(f"PDOF{vehicle}", math.nan)
            if not math.isnan(origin) and f"DV{vehicle}" in values:
                text += f", force from {clock(origin)} ({number(round(origin), 3)} deg)"
            rows.append(("DELTA-V", text))
        absent = (*values, *_absent_quantities(values))
        missing = self.undetermined or [n for n in (*VELOCITIES, *FINAL_STATE) if n not in absent]
        if missing:
            names = [name for name in missing if name not in _SPINS]
            text = ", ".join(["spins", *names] if {*_SPINS} <= {*missing} else missing)
            if self.helpful:
                leading = ", ".join(self.helpful[:-1])
                text += f": give {leading}{' and ' if leading else ''}{self.helpful[-1]}"
                if tuple(self.helpful) == ("UX", "UY") and {"VX", "VY"} <= {*missing}:
                    text += ", or HA and HB, courses that cross"
            rows.append(("NOT FOUND", text))
        for vehicle in vehicles:
            drivers = self.drivers.get(f"S{vehicle}", ())[:DRIVERS]
            causes = [
                f"{name} {100 * fraction:.0f} %"
                for name, fraction in drivers
                if fraction >= _MIN_FRACTION
            ]
            if causes:
                rows.append(("DEPENDS ON", f"{vehicle}'s speed: {', '.join(causes)}"))
        rows.append(("REMARKS", f"{remarks}, below" if remarks else "none"))
        previous_label = ""
        for label, text in rows:
            for part in wrap(text, _WIDTH - _LABEL_WIDTH):
                yield f"{'' if label == previous_label else label:{_LABEL_WIDTH}}{part}"
                previous_label = label

    def _velocity_table(self, values: Mapping[str, float], units: System) -> list[str]:
        """Return the table of velocities; solved ones have a *."""
        decimals: dict[str, int] = {}
        for _, unit, _ in _ROWS:
            names_alike = (n for _, own, row in _ROWS if own == unit for n in row if n in values)
            decimals[unit] = decimals_for([values[n] for n in names_alike])
        rows = []
        count = 4 if "VX" in values or "VBX" in values else 2
        for label, unit, names in _ROWS:
            if not any(name in values for name in names[:count]):
                continue
            cells = []
            for name in names[:count]:
                text = format_fixed(values[name], decimals[unit]) if name in values else "unknown"
                if name in COURSES and values.get(COURSES[name]) == 0:
                    text = "at rest"
                solved = name in values and name not in self.known and label in ("x", "y", "spin")
                cells.append(f"{text}{'*' if solved else ' '}")
            rows.append([label, *cells, units.label(unit)])
        heading = ["A before ", "A after ", "B before ", "B after "][:count]
        lines = table(rows, ["velocity", *heading, "unit"], left=(0, 1 + count))
        return [*lines, "* solved for"]

    def _quantity_table(
        self, names: Sequence[str], values: Mapping[str, float], units: System
    ) -> list[str]:
        """Return a table of the quantities ``names``: value, unit and meaning."""
        rows = []
        for name in names:
            if math.isnan(values.get(name, math.nan)):
                continue
            is_given = name in self.known or (name == "MUP" and "MU" in self.known)
            mark = "*" if name in ("E", "MUP", "EM") and not is_given else " "
            note = _friction_note(values) if name == "MUP" else quantity(name).meaning
            if name.startswith("PDOF"):
                note += f" ({clock(values[name])})"
            if name == "EM":
                note += f"; {number(-values[name])} with the sign the other way"
            unit = units.label(quantity(name).unit)
            rows.append([name, f"{number(values[name])}{mark}", unit, note])
        return table(rows, left=(0, 2, 3))


def join_texts(impacts: Sequence[Impact], units: System = RULES, full: bool = True) -> str:
    """Return the solutions one below the other, numbered where there are several."""
    texts = [impact.as_text(units, full) for impact in impacts]
    if len(texts) == 1:
        return texts[0]
    of = f"OF {len(texts)}{impacts[0].note}"
    return "\n\n".join(f"SOLUTION {i} {of}\n\n{text}" for i, text in enumerate(texts, 1))


def without_noise(
    values: Mapping[str, float],
    noise: float = NOISE,
    deviations: Mapping[str, float] | None = None,
) -> dict[str, float]:
    """Return ``values`` with rounding removed.

    Values below ``noise`` times the largest of their unit, and those far below their own standard
    deviation, are 0; directions of -180 are 180. A spin's size is also compared with velocities
    over the smaller radius of gyration."""
    largest: dict[str, float] = {}
    for name, value in values.items():
        if math.isfinite(value):
            unit = quantity(name).unit
            largest[unit] = max(abs(value), largest.get(unit, 0.0))
    largest["1"] = _COEFFICIENT_NOISE / noise  # pure numbers have no common size
    radii = [
        math.sqrt(values[inertia] / values[mass])
        for inertia, mass in (("IA", "MA"), ("IB", "MB"))
        if math.isfinite(values.get(inertia, math.inf) / values.get(mass, 1.0))
    ]
    if radii and min(radii) > 0:
        # where all spins are rounding, their size is that of velocities
        spin_size = largest.get(VELOCITY, 0.0) / min(radii) * ROUNDING / noise
        largest["rad/time"] = max(largest.get("rad/time", 0.0), spin_size)
    clean = {}
    for name, value in values.items():
        small = abs(value) < noise * largest.get(quantity(name).unit, 0.0)
        small |= abs(value) < NOISE * (deviations or {}).get(name, 0.0)
        opposite = name in (*COURSES, *FORCES) and value < -179.9995  # to three decimals
        clean[name] = 180.0 if opposite else 0.0 if small else value
    return clean


def _friction_note(values: Mapping[str, float]) -> str:
    """Return the note beside MUP."""
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


class Exact(Impact):
    """A solution of exact values, and everything that follows from it."""

    def __init__(
        self, known: Mapping[str, float], solution: Solution, contact_time: float | None
    ) -> None:
        values = {**known, **{name: float(value) for name, value in solution.values.items()}}
        super().__init__(known, with_derived_values(values, contact_time))
        self.absent = absent_results(known)
        self.solution, self.note = solution, ": MU is known in size, and both signs agree"
        if solution.contradictory:
            self.note += " (each a fit of values that contradict one another)"

    @classmethod
    @within_doubles
    def all_of(
        cls,
        known: Mapping[str, float],
        wanted: Sequence[str] | None = None,
        contact_time: float | None = None,
        source: str | None = None,
    ) -> list[Self]:
        """Return every solution of a single scene, possible impacts first. Raise UserError;
        ``source`` says where the known values come from."""
        given, remarks = pose(known, float)
        try:
            impacts = [cls(given, solution, contact_time) for solution in solve_for(given, wanted)]
            point = given.get("M") == 4
            if all(is_wrong_way(int(impact.values["STATUS"]), point) for impact in impacts):
                plane = given["GA"]
                given = {**given, "GA": turned(plane)}
                others = solve_for(given, wanted)
                impacts = [cls(given, solution, contact_time) for solution in others]
                if "GA" in known:
                    remarks.append(turned_sentence(plane))
        except UserError as error:
            raise UserError(str(error), source) from None
        for impact in impacts:
            impact.remarks = remarks
        return sorted(impacts, key=lambda impact: bool(int(impact.values["STATUS"]) & IMPOSSIBLE))

    def warnings(self, units: System = RULES) -> list[str]:
        lines = []
        if self.solution.contradictory:
            mismatch = units.display_value(VELOCITY, float(self.solution.mismatch))
            lines.append(
                "the known values contradict one another: the solution fits them by least squares, "
                f"root-mean-square mismatch {number(mismatch, 3)} [{units.label(VELOCITY)}]"
            )
        amplifications = self.solution.amplification.items()
        badly_amplified = [
            f"{n} {number(x, 3)} times" for n, x in amplifications if not x < BADLY_CONDITIONED
        ]
        if badly_amplified:
            lines.append(
                "badly conditioned: errors of the known velocities are amplified "
                f"({', '.join(badly_amplified)})"
            )
        return lines + super().warnings()

    def further_tables(self, units: System) -> list[list[str]]:
        errors = [f"{n} {number(value, 3)}" for n, value in self.solution.amplification.items()]
        conditions = paragraph(
            "Error amplification (error of the unknown when each known velocity errs independently "
            "by 1; spins times the radius of gyration "
            f"{number(self.solution.gyration, 4)}, coefficients times the closing speed): "
            f"{', '.join(errors)}"
        )
        values = display_values(self.values, units)
        return [self._quantity_table(("CAX", "CAY", "CBX", "CBY"), values, units), conditions]

    def json_items(self, units: System) -> dict[str, Any]:
        return {
            "known": [name for name in self.values if name in self.known],
            "solved_for": list(self.solution.unknown),
            "amplification": self.solution.amplification,
            "badly_conditioned": self.solution.badly_conditioned,
            "mismatch": self.solution.mismatch * units.display_value(VELOCITY, 1.0),
            "contradictory": self.solution.contradictory,
        }
