"""A form's texts: in base units, and filled in from a file."""

import math
from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

from ...collision.case import ABOUT, OWN_AXES, SOURCE, Case, in_base_units
from ...collision.estimates import SIZES
from ...collision.geometry import clock
from ...collision.scenefile import SIGNS, CaseTemplate, toml_texts
from ...collision.units import System, base_of, units_in
from ...errors import UserError
from ...files import decode
from ...mechanics.state import COURSES, FORCES
from ...messages.plaintable import number
from ...names import CHAPTER, DEFAULT_M, RESULTS, SCENE, check_names

UNITS = "units"
"""The problem that belongs to no single value."""
LARGEST = 1_000_000
"""Bytes of a file that is filled in; the template of all that may be known has 3,500."""
OUTLINES = tuple(name for pair in SIZES.values() for name in pair)
"""Lengths and widths, which a form keeps for its drawing and its file."""


class Form(NamedTuple):
    """The ``case`` that a form's texts make, None where they make none, and ``problems`` by
    name."""

    case: Case | None
    problems: dict[str, str]


def entries(values: Mapping[str, str], units: str, title: str = "") -> Form:
    """Return the case of a form; ``units``: the system chosen for bare numbers, or nothing."""
    texts = {name: text.strip() for name, text in values.items() if text.strip()}
    texts = {n: t for n, t in texts.items() if n.removesuffix(SOURCE) in texts}
    about = {"title": title, "units": units}
    texts |= {name: text for name, text in about.items() if text}
    try:
        return Form(Case(texts, ""), {})
    except UserError as error:
        together = str(error)
    problems: dict[str, str] = {}
    for name, text in texts.items():
        if name not in ABOUT and not name.endswith(SOURCE):
            try:
                in_base_units({name: text}, "", units or None)
            except UserError as error:
                problems[name] = str(error)
    return Form(None, problems or {UNITS: together})


def convert_values(values: Mapping[str, str], units: str, to: str) -> dict[str, str]:
    """Return the texts of a form in another system: numbers are converted, and a range keeps the
    unit it was in. Raises UserError."""
    case, problems = entries(values, units)
    for problem in problems.values():
        raise UserError(problem)
    assert case is not None
    texts = dict(case.texts)
    for name, entry in case.entries.items():
        if entry.kind in ("range", "tolerance") and entry.unit and not units_in(name, entry.text):
            texts[name] = f"{entry.text} {entry.unit}"
    converted_texts = Case(texts, "").shown_in(to).texts
    return {name: text for name, text in converted_texts.items() if name != UNITS}


def units_shown(system: System) -> dict[str, Any]:
    """The system's ``name``, its ``base`` in words, ``labels`` of bare numbers by what they
    measure."""
    rules = {row.unit for table in (SCENE, RESULTS, CHAPTER) for row in table.values()}
    labels = {rule: system.label(rule) for rule in sorted(rules)}
    return {"name": system.name, "base": base_of(system), "labels": labels}


def filled_in(data: bytes, name: str, allowed: Collection[str]) -> dict[str, Any]:
    """Return a flat TOML file as a form has it.

    Returns
    -------
    dict
        ``values`` by the names ``allowed``, as they stand in the file; ``title`` and ``units``;
        ``extra``: what stands beside the fields and is computed with and saved again, such as
        sources, the case's number, lengths and widths, the contact point in a vehicle's own axes.

    Raises
    ------
    UserError
        For a file that is no case, naming file and line.
    """
    if len(data) > LARGEST:
        raise UserError(f"is larger than {LARGEST:,} bytes, the limit here", name)
    texts = toml_texts(decode(data, name), name)
    axis_names = tuple(axis for axes in OWN_AXES.values() for axis in axes)
    entries = [entry for entry in texts if entry not in ABOUT and not entry.endswith(SOURCE)]
    check_names(entries, (*allowed, *axis_names, *OUTLINES), "name used here", name)
    values = {entry: text for entry, text in texts.items() if entry in allowed}
    if "M" in allowed:
        values.setdefault("M", DEFAULT_M)
    entries_shown = ("title", "units")
    read: dict[str, Any] = {part: texts.get(part, "") for part in entries_shown}
    read["units"] = read["units"].lower()
    extra = {n: t for n, t in texts.items() if n not in values and n not in entries_shown}
    if extra:
        read["extra"] = extra
    return {**read, "values": values}


def to_fill_in(case: CaseTemplate) -> dict[str, Any]:
    """Return a kind of collision as a form has it: ``values``, "" where one is to be filled in,
    ``units``, and a ``hint``; sides and signs are drawn beside it."""
    lines = [line for line in case.remarks if line not in SIGNS]
    return {"values": dict(case.entries), "units": "us", "hint": " ".join(lines)}


POINTS = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")
"""The points of the compass in turn."""


def spoken_direction(name: str, shown: float | None, system: System) -> str:
    """Return a course, or where a force comes from, as it is said beside the number ``shown``;
    nothing of other values."""
    if shown is None or not math.isfinite(shown) or name not in (*COURSES, *FORCES):
        return ""
    if name in FORCES:
        return clock(shown)
    convention = system.convention
    if convention and convention.headings:
        return POINTS[round(shown / 45) % len(POINTS)]
    left = (shown + 180) % 360 - 180  # of x, turning from x to y
    if abs(left) < 0.5:
        return "along x"
    if abs(left) > 179.5:
        return "against x"
    other_axes = convention is not None and bool(convention.axes)
    side = "left" if (left > 0) != other_axes else "right"
    return f"to the {side} of x"


def digits(value: float | None, count: int) -> str:
    return "" if value is None else number(value, count)
