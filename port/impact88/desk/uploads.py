"""Files that the page hands over to be read into a form."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from ..errors import UserError
from ..estimates import SIZES, WORD
from ..files import decode
from ..names import check_names
from ..scene import OWN_AXES, SOURCE, entries_of, toml_texts

LARGEST = 1_000_000
OUTLINES = tuple(name for pair in SIZES.values() for name in pair)
"""Lengths and widths, which a form keeps for its drawing and its file."""
_WHOSE_BASE = {"us": "chapter", "metric": "si"}
"""The system whose bare numbers are another's base units."""


def filled_in(data: bytes, name: str, allowed: Collection[str]) -> dict[str, Any]:
    """A flat TOML file as a form has it: ``values`` by the names ``allowed``, ``title``, ``units``,
    what stands beside the fields (``extra``), and how entries were understood (``remarks``).

    Texts stay as they are; where an inertia is estimated or the contact point is given in a
    vehicle's own axes, all values are worked out, in base units. Raises UserError naming file and
    line.
    """
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
        whole = {entry: text for entry, text in texts.items() if text}
        found = entries_of(whole, name, single=bool(own))
        if own or found.estimated:
            values = found.values
            read["units"] = _WHOSE_BASE.get(found.units or "", found.units or "")
            read["remarks"] = list(found.remarks.values())
    check_names(values, allowed, "name used here", name)
    return {**read, "values": values}


def outline_lines(values: Mapping[str, str]) -> str:
    """The lines of a file for the lengths and widths among some values."""
    return "".join(f'{name} = "{values[name]}"\n' for name in OUTLINES if values.get(name))
