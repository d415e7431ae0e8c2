"""A form's texts: in base units, and filled in from a file."""

import math
from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

from ..errors import UserError
from ..estimates import SIZES, WORD
from ..files import decode
from ..names import CHAPTER, RESULTS, SCENE, check_names, quantity
from ..plaintable import number
from ..scene import OWN_AXES, SOURCE, entries_of, in_base_units, toml_texts
from ..units import base_of, system_of

UNITS = "units"
"""The problem that belongs to no single value."""
LARGEST = 1_000_000
"""Bytes of a file that is filled in; the template of all that may be known has 3,500."""
OUTLINES = tuple(name for pair in SIZES.values() for name in pair)
"""Lengths and widths, which a form keeps for its drawing and its file."""
_WHOSE_BASE = {"us": "chapter", "metric": "si"}
"""The system whose bare numbers are the base units of another."""


class Entries(NamedTuple):
    """``texts`` in base units, without blank ones; ``units``: the system they were written in, or
    None; ``problems`` by name."""

    texts: dict[str, str]
    units: str | None
    problems: dict[str, str]


def entries(values: Mapping[str, str], units: str) -> Entries:
    """The entries of a form; ``units``: the system chosen for bare numbers, or nothing."""
    written = {name: text.strip() for name, text in values.items() if text.strip()}
    chosen = units or None
    try:
        return Entries(*in_base_units(written, "", chosen), {})
    except UserError as error:
        together = str(error)
    texts: dict[str, str] = {}
    problems: dict[str, str] = {}
    for name, text in written.items():
        try:
            texts |= in_base_units({name: text}, "", chosen)[0]
        except UserError as error:
            problems[name] = str(error)
    return Entries(texts, chosen, problems or {UNITS: together})


def units_shown(units: str | None) -> dict[str, Any]:
    """The system's ``name``, its ``base`` in words, ``labels`` of bare numbers by what they
    measure."""
    system = system_of(units)
    rules = {row.unit for table in (SCENE, RESULTS, CHAPTER) for row in table.values()}
    labels = {rule: system.label(rule) for rule in sorted(rules)}
    return {"name": units or "", "base": base_of(system), "labels": labels}


def without_rounding(values: Mapping[str, float], share: float) -> dict[str, float]:
    """The values, with 0 for those at or below a share of the largest of their kind."""
    largest: dict[str, float] = {}
    for name, value in values.items():
        rule = quantity(name).unit
        if math.isfinite(value):
            largest[rule] = max(largest.get(rule, 0.0), abs(value))
    return {
        name: 0.0 if abs(value) <= share * largest.get(quantity(name).unit, 0.0) else value
        for name, value in values.items()
    }


def filled_in(data: bytes, name: str, allowed: Collection[str]) -> dict[str, Any]:
    """A flat TOML file as a form has it: ``values`` by the names ``allowed``, ``title``, ``units``,
    what stands beside the fields (``extra``), and how entries were understood (``remarks``). Texts
    stay as they are unless an inertia is estimated or the contact point is given in a vehicle's own
    axes: then all are worked out, in base units. Raises UserError naming file and line."""
    if len(data) > LARGEST:
        raise UserError(f"is larger than {LARGEST:,} bytes, the limit here", name)
    texts = toml_texts(decode(data, name), name)
    title, units = texts.get("title", ""), texts.get("units", "").lower()
    values = {
        entry: text
        for entry, text in texts.items()
        if entry not in ("case", "title", "units") and not entry.endswith(SOURCE)
    }
    read: dict[str, Any] = {"title": title, "units": units}
    extra = {entry: values.pop(entry) for entry in OUTLINES if entry in values}
    if extra:
        read["extra"] = extra
    own = {axis for axes in OWN_AXES.values() for axis in axes}.intersection(texts)
    if own or extra or WORD in " ".join(values.values()):
        written = {entry: text for entry, text in texts.items() if text}
        found = entries_of(written, name, single=bool(own))
        if own or found.estimated:
            values = found.values
            read["units"] = _WHOSE_BASE.get(found.units or "", found.units or "")
            read["remarks"] = list(found.remarks.values())
    check_names(values, allowed, "name used here", name)
    return {**read, "values": values}


def outline_lines(values: Mapping[str, str]) -> str:
    """The lines of a file for the lengths and widths among some values."""
    return "".join(f'{name} = "{values[name]}"\n' for name in OUTLINES if values.get(name))


def digits(value: float | None, count: int) -> str:
    return "" if value is None else number(value, count)
