"""An answer as text. Its first lines are those of the command, the report and the desk: what was
asked, the verdict on the evidence, speeds before, changes of velocity, what drives them, what is
left open. Behind them, in full, the tables: velocities, coefficients, impulse, derived quantities,
measured and adjusted values, spreads and correlations."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from textwrap import wrap

from ...collision.geometry import clock, within_doubles
from ...collision.needs import join_words
from ...collision.units import RULES, SYSTEMS, System, display_values
from ...mechanics.state import CHANGES, COURSE_OF, COURSES, SPEEDS
from ...messages.plaintable import decimals_for, format_fixed, number, paragraph, table
from ...names import (
    COEFFICIENTS,
    FINAL_STATE,
    NUMBER,
    PIVOT,
    SPINS,
    UNKNOWNS,
    VELOCITIES,
    VELOCITY,
    quantity,
)
from .answer import QUANTILES, Answer, bounds_without_noise
from .answerremarks import remarks_on
from .derived import NOISE, absent_quantities, without_noise
from .evidence import AGREE, as_given
from .solution import SIGMAS, Adjusted

_ROAD = {"ft/s": SYSTEMS["us"], "m/s": SYSTEMS["metric"]}  # units of speeds on the road
_ALSO = (*COEFFICIENTS, *SPINS)  # sought, and in no line on motion
DRIVERS = 3  # values named as the causes of a result's uncertainty
_MIN_FRACTION = 0.05  # of a result's variance, for a value to be named
MAX_CORRELATION_COLUMNS = 7  # as many as 96 characters hold
_LABEL_WIDTH = 16  # characters
_WIDTH = 100
_ROWS = (
    ("x", "length/time", ("UX", "VAX", "VX", "VBX")),
    ("y", "length/time", ("UY", "VAY", "VY", "VBY")),
    ("spin", "rad/time", ("WA", "WAF", "WB", "WBF")),
    ("speed", "length/time", ("SA", "SAF", "SB", "SBF")),
    ("course", "degree", ("HA", "HAF", "HB", "HBF")),
    ("x at contact point", "length/time", ("XA", "XAF", "XB", "XBF")),
    ("y at contact point", "length/time", ("YA", "YAF", "YB", "YBF")),
)
_GROUPS: Sequence[Sequence[str]] = (
    ("E", "MUP", "EM", "RR0"),
    ("PN", "PT", "PM", "P", "PDOFA", "PDOFB"),
    ("TF", "FA", "FM2", "FM3"),
    (*CHANGES, "VC", "VS"),
    ("KI", "KF", "EL", "LOSS"),
    ("CAX", "CAY", "CBX", "CBY"),
)

# -- the first lines


@within_doubles
def first_lines(answer: Answer, units: System = RULES) -> list[tuple[str, str]]:
    """Return the first lines of an answer: labels and texts, a label for each line."""
    values = without_noise(answer.values, deviations=answer.uncertainties)
    barrier = math.isinf(answer.known["MB"].nominal)
    vehicles = "A" if barrier else "AB"
    lines = [*_verdicts(answer, units)]
    for vehicle in vehicles:
        lines.append(("BEFORE IMPACT", _motion(answer, vehicle, "", values, units)))
    sought = _sought(answer)
    for vehicle in vehicles:
        if {f"V{vehicle}X", f"V{vehicle}Y", f"S{vehicle}F", f"H{vehicle}F"} & {*sought}:
            lines.append(("AFTER IMPACT", _motion(answer, vehicle, "F", values, units)))
    coefficients = [
        _coefficient_text(answer, n, values, units) for n in sought if n in _ALSO and n in values
    ]
    if coefficients:
        lines.append(("FOUND", "; ".join(coefficients)))
    for vehicle in vehicles:
        origin = values.get(f"PDOF{vehicle}", math.nan)
        force = ""
        if not math.isnan(origin):
            force = f", force from {clock(origin)} ({number(round(origin), 3)} deg)"
        lines.append(("DELTA-V", _size(answer, vehicle, f"DV{vehicle}", values, units, force)))
    if any(f"{kind}{v}" in answer.ranges for kind in ("S", "DV") for v in vehicles):
        cut = any(item.kind == "normal" for item in answer.known.values())
        text = "90 %: middle of the draws; bounds: lowest and highest found within all limits"
        lines.append(("INTERVALS", text + f" (normal values: {SIGMAS:g} sd)" * cut))
    for vehicle in vehicles:
        drivers = answer.drivers.get(f"S{vehicle}", ())[:DRIVERS]
        causes = [
            f"{as_given(n, answer.given)} {100 * part:.0f} %"
            for n, part in drivers
            if part >= _MIN_FRACTION
        ]
        if causes:
            lines.append(("DEPENDS ON", f"{vehicle}'s speed: {', '.join(causes)}"))
    if missing := _missing(answer):
        lines.append(("NOT FOUND", missing))
    count = len(remarks_on(answer, units))
    return [*lines, ("REMARKS", f"{count}, below" if count else "none")]


def is_adverse(answer: Answer, label: str) -> bool:
    """Return True if the first line with this label tells an adverse result."""
    contradicts = label == "EVIDENCE" and answer.evidence.contradictory
    return contradicts or label in ("NO IMPACT", "IMPOSSIBLE")


def _verdicts(answer: Answer, units: System) -> Iterator[tuple[str, str]]:
    """Yield the lines on whether there is an answer, what was asked, and the evidence."""
    if answer.is_refused:
        yield "NO IMPACT", answer.refusal(units) or ""
    is_broken = bool(answer.impossible) and not answer.is_refused
    # an impact between values that contradict one another says little
    if is_broken and not answer.evidence.contradictory:
        yield "IMPOSSIBLE", answer.impossible
    yield "ASKED", _question(answer)
    verdict = answer.evidence.text(units, answer.given)
    if answer.impossible and answer.evidence.verdict == AGREE:
        verdict = f"in an impact that physics forbids, {verdict}"
    beyond = [_beyond(item, answer, units) for item in answer.solution.beyond_limits]
    if beyond and not (answer.solution.assumed or answer.evidence.contradictory):
        verdict += f". The best fit lies beyond limits: {join_words(beyond)}"
    yield "EVIDENCE", verdict
    if is_broken and answer.evidence.contradictory:
        yield "IMPOSSIBLE", answer.impossible
    if answer.impossible and answer.draws:
        yield "POSSIBLE", f"{_possible_speeds(answer, units)}; their draws are below"
    elif answer.impossible and answer.is_empty and not answer.is_refused:
        yield "POSSIBLE", "no impact that physics allows lies within all limits"


def _beyond(item: Adjusted, answer: Answer, units: System) -> str:
    """Return an adjusted value that lies beyond its limits, with them."""
    item_limits = answer.solution.system.known[item.name]
    low, high = sorted(units.display_unwrapped(item.name, x) for x in item_limits.limits(SIGMAS))
    value = number(units.display_unwrapped(item.name, item.adjusted), 4)
    unit = units.unit(item.name)
    return f"{item.name} {value}, not from {number(low, 4)} to {number(high, 4)} {unit}".rstrip()


def _sought(answer: Answer) -> list[str]:
    """Return what is sought: what an impact is solved for and is not given."""
    given = [n for n in answer.given if n != "M"]
    candidates = {*answer.values, *answer.undetermined} - {*answer.known, *answer.absent}
    sought = [n for n in UNKNOWNS if n in candidates]
    for speed, course in reversed(COURSE_OF.items()):  # one known, the other sought
        if speed in given or course in given:
            missing = [n for n in (speed, course) if n not in given]
            rest = [n for n in sought if n not in SPEEDS[speed]]
            sought = [*missing, *rest] if len(rest) < len(sought) else rest
    return sought


def _question(answer: Answer) -> str:
    """Return what was asked: what is sought, and from what."""
    given = [n for n in answer.given if n != "M" and _is_used(answer, n)]
    sought = _sought(answer)
    measured = [] if answer.solution.assumed else [n for n in given if _varies(answer, n)]
    exact = len(given) - len(measured)
    parts = [f"{join_words(measured)} within limits"] if measured else []
    parts += [f"{exact} exact value{'s' if exact > 1 else ''}"] if exact else []
    if not sought:
        return f"whether they agree: {' and '.join(parts)}"
    return f"{join_words(sought)}, from {' and '.join(parts)}"


def _is_used(answer: Answer, name: str) -> bool:
    """Return True if a given value has a part in the answer: under its name, as the components of
    a standing vehicle's speed, or as signed friction."""
    parts = SPEEDS.get(COURSES.get(name, name), ())
    friction = answer.known.get("MUP") if name == "MU" else None
    is_friction = friction is not None and (friction.nominal != 0 or friction.varies)
    stands = bool(parts) and {*parts} <= {*answer.known}
    return name in answer.known or stands or is_friction


def _varies(answer: Answer, name: str) -> bool:
    return name in answer.known and answer.known[name].varies


def _motion(
    answer: Answer, vehicle: str, after: str, values: Mapping[str, float], units: System
) -> str:
    """Return a vehicle's speed and heading, with intervals."""
    speed, course = f"S{vehicle}{after}", f"H{vehicle}{after}"
    heading = ""
    if values.get(speed) and course in values:
        degrees = number(units.display(course, values[course]), 3).replace("-180", "180")
        heading = f", heading {degrees}"
    return _size(answer, vehicle, speed, values, units, heading)


def _size(
    answer: Answer,
    vehicle: str,
    name: str,
    values: Mapping[str, float],
    units: System,
    direction: str = "",
) -> str:
    """Return a speed or change of velocity with its direction, standard deviation and intervals."""
    if name not in values:
        return f"{vehicle} unknown"

    def shown(value: float) -> str:
        return number(units.display_value(VELOCITY, value), 3)

    text, unit = f"{vehicle} {shown(values[name])}", units.label(VELOCITY)
    if not units.is_bare:
        text += f" {unit}"
        if road := _ROAD.get(unit):
            speed = road.display_value(VELOCITY, units.display_value(VELOCITY, values[name]))
            text += f" ({number(speed, 3)} {road.label(VELOCITY)})"
    ends = [shown(x) for x in _interval(answer, name)]
    if ends:
        text += direction + f", 90 % {ends[0]} to {ends[1]}"
        return text + (f", bounds {ends[2]} to {ends[3]}" if all(ends) else "")
    return text + direction + _deviation(answer, name, shown)


def _interval(answer: Answer, name: str) -> tuple[float, ...]:
    """Return the middle 90 % of the draws of a result and its bounds; nothing where there are
    none, or the impact is impossible: no interval is about that."""
    if name not in answer.ranges or answer.impossible:
        return ()
    assert answer.draws is not None
    quantiles = answer.draws.spread(name, (QUANTILES[0], QUANTILES[-1])).quantiles
    return (*quantiles.values(), *bounds_without_noise(answer.ranges[name]))


def _deviation(answer: Answer, name: str, shown: Callable[[float], str]) -> str:
    """Return a result's standard deviation in words, "" where there is none."""
    if name not in answer.drivers or answer.impossible:
        return ""
    deviation = shown(answer.deviations[name])
    return f", sd {deviation}" if deviation else ""


def _coefficient_text(answer: Answer, name: str, values: Mapping[str, float], units: System) -> str:
    """Return a spin or coefficient that was sought, with its unit and interval."""

    def shown(deviation: float) -> str:
        return number(abs(units.factor(name)) * deviation, 3)

    unit, value = units.unit(name), units.display_unwrapped(name, values[name])
    text = f"{name} {number(value, 3)} {unit}".rstrip()
    if ends := sorted(units.display_unwrapped(name, x) for x in _interval(answer, name)[:2]):
        return f"{text}, 90 % {number(ends[0], 3)} to {number(ends[1], 3)}"
    return text + _deviation(answer, name, shown)


def _missing(answer: Answer) -> str:
    """Return what is not determined, and what would determine it; "" for nothing."""
    present = (*answer.values, *absent_quantities(answer.values), *answer.absent)
    missing = [n for n in (*VELOCITIES, *FINAL_STATE) if n not in present]
    missing = [*(answer.undetermined or missing)]
    if not missing:
        return ""
    names = [name for name in missing if name not in SPINS]
    text = ", ".join(["spins", *names] if {*SPINS} <= {*missing} else missing)
    helpful = answer.solution.helpful if answer.undetermined else ()
    if helpful:
        *others, last = *helpful, *answer.solution.alternatives
        is_choice = bool(answer.solution.alternatives)
        text += ": give " + (f"{', '.join(others)} or {last}" if is_choice else join_words(helpful))
        if tuple(helpful) == ("UX", "UY") and {"VX", "VY"} <= {*missing}:
            text += ", or HA and HB, courses that cross"
    return text


def _possible_speeds(answer: Answer, units: System) -> str:
    """Return the 90 % intervals of speeds and courses of the possible impacts."""
    assert answer.draws is not None
    parts = []
    for name in ("SA", "HA", "SB", "HB"):
        if name in answer.draws.values:
            ends = answer.draws.spread(name, (QUANTILES[0], QUANTILES[-1])).quantiles.values()
            low, high = sorted(units.display_unwrapped(name, end) for end in ends)
            unit = units.unit(name)
            parts.append(f"{name} {number(low, 3)} to {number(high, 3)} {unit}".rstrip())
    intervals = f": 90 % have {', '.join(parts)}" if parts else ""
    return f"impacts that physics allows lie within all limits{intervals}"


# -- the text


@within_doubles
def text_of(answer: Answer, units: System = RULES, full: bool = True) -> str:
    """Return the first lines, tables and remarks as text; unless ``full``, without tables."""
    lines, previous_label = [], ""
    rows = first_lines(answer, units)
    if full and not answer.solution.search.single:
        rows.insert(-1, ("SEARCH", answer.solution.search.text()))
    for label, text in rows:
        for part in wrap(text, _WIDTH - _LABEL_WIDTH):
            lines.append(f"{'' if label == previous_label else label:{_LABEL_WIDTH}}{part}")
            previous_label = label
    blocks = [lines, *(_tables(answer, units) if full else ())]
    lines = [line for block in blocks if block for line in (*block, "")]
    for remark in remarks_on(answer, units):
        lines += paragraph(f"! {remark}")
    return "\n".join(lines).rstrip("\n")


def join_texts(answers: Sequence[Answer], units: System = RULES, full: bool = True) -> str:
    """Return the answers one below the other, numbered where there are several."""
    texts = [text_of(answer, units, full) for answer in answers]
    if len(texts) == 1:
        return texts[0]
    of = f"OF {len(texts)}"
    signs = {math.copysign(1, a.solution.system.nominal.get("MUP", 0.0)) for a in answers}
    if answers[0].solution.typed_mu is not None and len(signs) > 1:
        of += ": MU is known in size, and both signs agree"
    return "\n\n".join(f"SOLUTION {i} {of}\n\n{text}" for i, text in enumerate(texts, 1))


def _tables(answer: Answer, units: System) -> list[list[str]]:
    """Return the tables, as lines."""
    clean = without_noise(answer.values, deviations=answer.uncertainties)
    values = display_values(clean, units)
    return [
        _velocity_table(answer, values, units),
        *(_quantity_table(answer, names, values, units) for names in _GROUPS),
        _amplifications(answer),
        _adjustment_table(answer, units),
        _spread_table(answer, units),
        *_correlation_tables(answer, units),
    ]


def _velocity_table(answer: Answer, values: Mapping[str, float], units: System) -> list[str]:
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
            solved = name in values and name not in answer.known and label in ("x", "y", "spin")
            cells.append(f"{text}{'*' if solved else ' '}")
        rows.append([label, *cells, units.label(unit)])
    heading = ["A before ", "A after ", "B before ", "B after "][:count]
    lines = table(rows, ["velocity", *heading, "unit"], left=(0, 1 + count))
    return [*lines, "* solved for"]


def _quantity_table(
    answer: Answer, names: Sequence[str], values: Mapping[str, float], units: System
) -> list[str]:
    """Return a table of the quantities ``names``: value, unit and meaning."""
    rows = []
    for name in names:
        if math.isnan(values.get(name, math.nan)):
            continue
        mark = "*" if name in ("E", "MUP", "EM") and name not in answer.known else " "
        note = _friction_note(values) if name == "MUP" else quantity(name).meaning
        if name.startswith("PDOF"):
            note += f" ({clock(values[name])})"
        if name == "EM":
            note += f"; {number(-values[name])} with the sign the other way"
        rows.append([name, f"{number(values[name])}{mark}", _unit_label(name, units), note])
    return table(rows, left=(0, 2, 3))


def _unit_label(name: str, units: System) -> str:
    """Return the unit of a quantity as a table has it, "" for a pure number."""
    label = units.label(quantity(name).unit)
    return "" if label == NUMBER else label


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


def _amplifications(answer: Answer) -> list[str]:
    """Return what errors of exact values would do to the unknowns."""
    errors = [f"{n} {number(size, 3)}" for n, size in answer.solution.amplification.items()]
    if not errors:
        return []
    gyration = number(answer.solution.system.gyration, 4)
    return paragraph(
        "Error amplification (error of the unknown when each known velocity errs independently by "
        f"1; spins times the radius of gyration {gyration}, coefficients times the relative speed "
        f"at C): {', '.join(errors)}"
    )


def _adjustment_table(answer: Answer, units: System) -> list[str]:
    """Return the table of measured and adjusted values; empty without redundancy."""
    count = answer.solution.redundancy
    if not count:
        return []
    rows = []
    for entry in answer.solution.adjusted:
        item = answer.solution.system.known[entry.name]
        half_width = math.nan if item.kind == "normal" else entry.tolerance
        rounding = abs(entry.adjusted) < NOISE * item.standard_deviation
        adjusted_value = 0.0 if rounding else entry.adjusted
        measured_value, shown_value = (
            units.display_unwrapped(entry.name, float(x)) for x in (entry.measured, adjusted_value)
        )
        factor = units.factor(entry.name)
        sizes = [
            (measured_value, 6),
            (half_width * factor, 3),
            (item.standard_deviation * factor, 3),
        ]
        cells = [number(x, n) for x, n in (*sizes, (shown_value, 6))]
        rows.append(
            [
                entry.name,
                *cells,
                format_fixed(entry.normalized_residual, 2),
                _unit_label(entry.name, units),
            ]
        )
    heading = ["known", "measured", "half-width", "sd", "adjusted", "moved, tolerances", "unit"]
    return [
        *table(rows, heading, left=(0, 6)),
        "A tolerance is the half-width of limits, or the sd of a normal value.",
        *paragraph(
            "Adjusted by least squares so that Equations 13 to 18 hold exactly (adjustment of "
            f"observations with conditions): {count} value{'s' if count > 1 else ''} more than "
            f"needed, sum of squared adjustments {answer.evidence.sum_text} (in "
            f"standard deviations; about {count} where the tolerances are right)"
        ),
    ]


def _spread_table(answer: Answer, units: System) -> list[str]:
    """Return the table of results: first-order deviations, and deviations, quantiles and bounds
    from draws."""
    heading = ["result", "first order sd"]
    if answer.draws:
        heading += ["draws sd", *(f"{100 * fraction:g} %" for fraction in QUANTILES)]
        heading += ["lower bound", "upper bound"]
    rows = []
    for name in answer.names:
        factor = units.factor(name)
        first_order = answer.first_order[name]
        cells = [name, "" if first_order is None else number(factor * first_order, 3)]
        if answer.draws:
            spread, bound = answer.draws.spread(name, QUANTILES), answer.ranges[name]
            cells.append(number(factor * spread.deviation, 3))
            quantiles = [units.display_unwrapped(name, q) for q in spread.quantiles.values()]
            quantiles = quantiles[::-1] if units.is_turned(name) else quantiles
            limits = (*quantiles, *units.ends(name, *bounds_without_noise(bound)))
            cells += [number(value, 5) for value in limits]
        rows.append([*cells, _unit_label(name, units)])
    lines = table(rows, [*heading, "unit"], left=(0, len(heading))) if rows else []
    if answer.draws and rows:
        lines += paragraph(
            f"Draws and bounds: {answer.draws.counted}; flat, where nothing is known, over "
            f"velocities before, e, e_m and P_t/P_n; as much as {answer.draws.effective:.0f} "
            "independent draws"
        )
        if any(answer.first_order[n] is None for n in answer.names):
            lines += paragraph(
                "The first order is left out where it differs from the draws by more than a third."
            )
    return lines


def _correlation_tables(answer: Answer, units: System) -> list[list[str]]:
    """Return the tables of correlations and of drivers."""
    names = answer.names
    # courses and speeds follow from the components
    columns_shown = [i for i, n in enumerate(names) if n not in (*SPEEDS, *COURSES)][
        :MAX_CORRELATION_COLUMNS
    ]
    matrix = answer.signed_correlations(units)
    rows = [
        [names[i], *(f"{matrix[i, k]:.2f}" for k in columns_shown if k <= i)] for i in columns_shown
    ]
    correlations = table(rows, ["correlation", *(names[i] for i in columns_shown)])
    driving = [
        [
            name,
            *(
                f"{n} {100 * fraction:.0f} %"
                for n, fraction in drivers[:DRIVERS]
                if fraction >= 5e-3
            ),
        ]
        for name, drivers in answer.drivers.items()
    ]
    columns = table(driving, ["uncertain through", *[""] * DRIVERS], left=(0, 1, 2, 3))
    return [correlations if len(columns_shown) > 1 else [], columns if driving else []]
