"""A solved impact as tables to read and as JSON to process: the answer in a few lines, velocities,
coefficients, impulse, what follows, remarks. `Exact` is one of exact values (`unknowns`), one with
tolerances is `reconstruction.reconstructedtable.Measured`.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from textwrap import wrap
from typing import Any, Self

from ..collision.geometry import clock, within_doubles
from ..collision.units import RULES, VELOCITY, System, display_values
from ..errors import UserError
from ..mechanics.outcome import IMPOSSIBLE, forces, moment_ratio, outcome
from ..mechanics.state import CHANGES, COURSES, FORCES
from ..messages.plaintable import decimals_for, format_fixed, number, paragraph, plain, table
from ..names import CHAPTER, FINAL_STATE, PIVOT, RESULTS, SCENE, VELOCITIES, quantity
from ..status import sentences
from .unknowns import BADLY_CONDITIONED, Solution, solve_for

_ORDER = (*SCENE, *RESULTS, *CHAPTER)
_BARRIERS = (*(name for name in _ORDER if "B" in name), "VX", "VY")
"""What a rigid barrier does not have."""
_TURNING = (
    *("EM", "RR0", "PM", "WA", "WAF", "WB", "WBF", "IA", "IB", "DA", "DB", "PA", "PB"),
    *("XA", "YA", "XB", "YB", "XAF", "YAF", "XBF", "YBF", "CAX", "CAY", "CBX", "CBY"),
)
"""What point masses do not have, or twice."""
_ROAD = {"ft/s": ("mph", 3600 / 5280), "m/s": ("km/h", 3.6)}
"""The unit of speeds on the road."""
_SPINS = ("WA", "WB", "WAF", "WBF")
DRIVERS, _SHARE = 3, 0.05
"""Values named as making a result uncertain, at most, and a share of its variance too small to."""
_LEFT, _WIDTH = 16, 100
"""Characters of the answer's labels and lines."""
NOISE = 1e-9
"""Of the largest quantity of the same unit: less is rounding, and printed as 0; twice as much
prints the same of 100 solutions."""
ROUNDING = 1e-13  # of the same: what a program reads is 0 below this
_COEFFICIENT_NOISE = 1e-13  # a coefficient below this is rounding
_ROWS = (
    ("x", "length/time", ("UX", "VAX", "VX", "VBX")),
    ("y", "length/time", ("UY", "VAY", "VY", "VBY")),
    ("spin", "rad/time", ("WA", "WAF", "WB", "WBF")),
    ("speed", "length/time", ("SA", "SAF", "SB", "SBF")),
    ("course", "degree", ("HA", "HAF", "HB", "HBF")),
    ("x at contact point", "length/time", ("XA", "XAF", "XB", "XBF")),
    ("y at contact point", "length/time", ("YA", "YAF", "YB", "YBF")),
)


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


class Impact:
    """A solved impact: what is ``known`` and all ``values``, in base units; ``undetermined``: what
    is told apart from the remarks, ``helpful``: further values that would determine it; ``note``:
    what is said of several solutions; ``deviations``, bounds (``ranges``) and ``drivers``: of its
    uncertain results, the last the known values that make them so, with their shares of the
    variance."""

    undetermined: Sequence[str] = ()
    helpful: Sequence[str] = ()
    note = ""
    subject = "this impact"

    def __init__(self, known: Mapping[str, Any], values: dict[str, float]) -> None:
        self.known, self.values = known, values
        self.deviations: Mapping[str, float] = {}
        self.ranges: Mapping[str, Any] = {}
        self.drivers: Mapping[str, Sequence[tuple[str, float]]] = {}

    @property
    def uncertainties(self) -> Mapping[str, float]:
        """Standard deviations, of known values too: what is rounding beside them is 0."""
        return self.deviations

    def headline(self, units: System) -> Sequence[tuple[str, str]]:
        """Return what is said before the answer: label and text."""
        return [("IMPOSSIBLE", self.impossible)] if self.impossible else []

    @property
    def impossible(self) -> str:
        """What of physics it breaks, in a sentence; nothing for an impact that may have been."""
        broken = int(self.values.get("STATUS", 0)) & IMPOSSIBLE
        said = "; ".join(sentences(broken))
        return f"{self.subject} breaks physics: {said}" if broken else ""

    def warnings(self, units: System = RULES) -> list[str]:
        """What a reader must know, in sentences."""
        return sentences(int(self.values.get("STATUS", 0)), self.values)

    def further(self, units: System) -> list[list[str]]:
        return []

    def more(self, units: System) -> dict[str, Any]:
        return {}

    @within_doubles
    def as_text(self, units: System = RULES) -> str:
        """The answer, tables and remarks."""
        remarks = self.warnings(units)
        undetermined = [paragraph(f"! {remarks.pop(0)}")] if self.undetermined else []
        clean = without_noise(self.values, deviations=self.uncertainties)
        values = display_values(clean, units)
        named = (
            *(("E", "MUP", "EM", "RR0"), ("PN", "PT", "PM", "P", "PDOFA", "PDOFB")),
            *(("TF", "FA", "FM2", "FM3"), (*CHANGES, "VC", "VS"), ("KI", "KF", "EL", "LOSS")),
        )
        blocks = [
            [*self._answer(clean, len(remarks), units)],
            self._velocities(values, units),
            *(self._named(names, values, units) for names in named),
            *self.further(units),
            *undetermined,
        ]
        lines = [line for block in blocks if block for line in (*block, "")]
        for remark in remarks:
            lines += paragraph(f"! {remark}")
        return "\n".join(lines).rstrip("\n")

    @within_doubles
    def as_json(self, units: System = RULES) -> dict[str, Any]:
        """The same for a program; numbers that do not exist are null."""
        # what was given stands as it was given
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
                **self.more(units),
            }
        )
        return record

    def _answer(self, values: Mapping[str, float], remarks: int, units: System) -> Iterator[str]:
        unit = units.label(VELOCITY)

        def size(vehicle: str, name: str) -> str:
            if name not in values:
                return f"{vehicle} unknown"
            speed = units.display_value(VELOCITY, values[name])
            text = f"{vehicle} {number(speed, 3)}"
            if not units.is_bare:
                road, factor = _ROAD.get(unit, ("", 0.0))
                text += f" {unit}" + (f" ({number(speed * factor, 3)} {road})" if road else "")
            if name in self.drivers:
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
        absent = (*values, *_absent(values))
        unknown = self.undetermined or [n for n in (*VELOCITIES, *FINAL_STATE) if n not in absent]
        if unknown:
            names = [name for name in unknown if name not in _SPINS]
            text = ", ".join(["spins", *names] if {*_SPINS} <= {*unknown} else unknown)
            if self.helpful:
                first = ", ".join(self.helpful[:-1])
                text += f": give {first}{' and ' if first else ''}{self.helpful[-1]}"
            rows.append(("NOT FOUND", text))
        for vehicle in vehicles:
            drivers = self.drivers.get(f"S{vehicle}", ())[:DRIVERS]
            named = [f"{name} {100 * share:.0f} %" for name, share in drivers if share >= _SHARE]
            if named:
                rows.append(("DEPENDS ON", f"{vehicle}'s speed: {', '.join(named)}"))
        rows.append(("REMARKS", f"{remarks}, below" if remarks else "none"))
        before = ""
        for label, text in rows:
            for part in wrap(text, _WIDTH - _LEFT):
                yield f"{'' if label == before else label:{_LEFT}}{part}"
                before = label

    def _velocities(self, values: Mapping[str, float], units: System) -> list[str]:
        decimals: dict[str, int] = {}
        for _, unit, _ in _ROWS:
            alike = (n for _, own, row in _ROWS if own == unit for n in row if n in values)
            decimals[unit] = decimals_for([values[n] for n in alike])
        rows = []
        count = 4 if "VX" in values or "VBX" in values else 2
        for label, unit, names in _ROWS:
            if not any(name in values for name in names[:count]):
                continue
            cells = []
            for name in names[:count]:
                text = format_fixed(values[name], decimals[unit]) if name in values else "unknown"
                solved = name in values and name not in self.known and label in ("x", "y", "spin")
                cells.append(f"{text}{'*' if solved else ' '}")
            rows.append([label, *cells, units.label(unit)])
        heading = ["A before ", "A after ", "B before ", "B after "][:count]
        lines = table(rows, ["velocity", *heading, "unit"], left=(0, 1 + count))
        return [*lines, "* solved for"]

    def _named(self, names: Sequence[str], values: Mapping[str, float], units: System) -> list[str]:
        rows = []
        for name in names:
            if math.isnan(values.get(name, math.nan)):
                continue
            given = name in self.known or (name == "MUP" and "MU" in self.known)
            mark = "*" if name in ("E", "MUP", "EM") and not given else " "
            note = _friction(values) if name == "MUP" else quantity(name).meaning
            if name.startswith("PDOF"):
                note += f" ({clock(values[name])})"
            if name == "EM":
                note += f"; {number(-values[name])} with the sign the other way"
            unit = units.label(quantity(name).unit)
            rows.append([name, f"{number(values[name])}{mark}", unit, note])
        return table(rows, left=(0, 2, 3))


def in_turn(found: Sequence[Impact], units: System = RULES) -> str:
    """The solutions one below the other, numbered where there are several."""
    texts = [impact.as_text(units) for impact in found]
    if len(texts) == 1:
        return texts[0]
    of = f"OF {len(texts)}{found[0].note}"
    return "\n\n".join(f"SOLUTION {i} {of}\n\n{text}" for i, text in enumerate(texts, 1))


def without_noise(
    values: Mapping[str, float],
    noise: float = NOISE,
    deviations: Mapping[str, float] | None = None,
) -> dict[str, float]:
    """Return ``values``, those below ``noise`` of the largest of their unit 0, and those that are
    rounding beside their own standard deviations, and directions above -180. A spin's unit is that
    of velocities, too: over the smaller radius of gyration."""
    largest: dict[str, float] = {}
    for name, value in values.items():
        if math.isfinite(value):
            unit = quantity(name).unit
            largest[unit] = max(abs(value), largest.get(unit, 0.0))
    largest["1"] = _COEFFICIENT_NOISE / noise  # numbers have no common size
    radii = [
        math.sqrt(values[inertia] / values[mass])
        for inertia, mass in (("IA", "MA"), ("IB", "MB"))
        if math.isfinite(values.get(inertia, math.inf) / values.get(mass, 1.0))
    ]
    if radii and min(radii) > 0:
        # spins that are all rounding have no size of their own
        turning = largest.get(VELOCITY, 0.0) / min(radii) * ROUNDING / noise
        largest["rad/time"] = max(largest.get("rad/time", 0.0), turning)
    clean = {}
    for name, value in values.items():
        small = abs(value) < noise * largest.get(quantity(name).unit, 0.0)
        small |= abs(value) < NOISE * (deviations or {}).get(name, 0.0)
        opposite = name in (*COURSES, *FORCES) and value < -179.9995  # to three decimals
        clean[name] = 180.0 if opposite else 0.0 if small else value
    return clean


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


class Exact(Impact):
    """A solution of exact values, and everything that follows from it."""

    def __init__(
        self, known: Mapping[str, float], solution: Solution, contact_time: float | None
    ) -> None:
        values = {**known, **{name: float(value) for name, value in solution.values.items()}}
        super().__init__(known, completed(values, contact_time))
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
        """Every solution of a single scene. Raises UserError; ``source`` names where the known
        values come from."""
        try:
            found = [cls(known, solution, contact_time) for solution in solve_for(known, wanted)]
        except UserError as error:
            raise UserError(str(error), source) from None
        return sorted(found, key=lambda impact: bool(int(impact.values["STATUS"]) & IMPOSSIBLE))

    def warnings(self, units: System = RULES) -> list[str]:
        lines = []
        if self.solution.contradictory:
            mismatch = units.display_value(VELOCITY, float(self.solution.mismatch))
            lines.append(
                "the known values contradict one another: the solution fits them by least squares, "
                f"root-mean-square mismatch {number(mismatch, 3)} [{units.label(VELOCITY)}]"
            )
        amplified = self.solution.amplification.items()
        bad = [f"{n} {number(x, 3)} times" for n, x in amplified if not x < BADLY_CONDITIONED]
        if bad:
            lines.append(
                "badly conditioned: errors of the known velocities are amplified "
                f"({', '.join(bad)})"
            )
        return lines + super().warnings()

    def further(self, units: System) -> list[list[str]]:
        errors = [f"{n} {number(value, 3)}" for n, value in self.solution.amplification.items()]
        conditions = paragraph(
            "Error amplification (error of the unknown when each known velocity errs independently "
            "by 1; spins times the radius of gyration "
            f"{number(self.solution.gyration, 4)}, coefficients times the closing speed): "
            f"{', '.join(errors)}"
        )
        values = display_values(self.values, units)
        return [self._named(("CAX", "CAY", "CBX", "CBY"), values, units), conditions]

    def more(self, units: System) -> dict[str, Any]:
        return {
            "known": [name for name in self.values if name in self.known],
            "solved_for": list(self.solution.unknown),
            "amplification": self.solution.amplification,
            "badly_conditioned": self.solution.badly_conditioned,
            "mismatch": self.solution.mismatch * units.display_value(VELOCITY, 1.0),
            "contradictory": self.solution.contradictory,
        }
