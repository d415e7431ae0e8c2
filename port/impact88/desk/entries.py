"""A form's texts in base units, each judged alone so that one bad value hides nothing of others."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from ..errors import UserError
from ..names import CHAPTER, RESULTS, SCENE, quantity
from ..scene import in_base_units

UNITS = "units"
"""The problem that belongs to no value alone."""


class Entries(NamedTuple):
    """``texts``: the entries that are no blanks, in base units; ``units``: the system they were
    written in, or None; ``problems``: what is wrong, by name."""

    texts: dict[str, str]
    units: str | None
    problems: dict[str, str]


def entries(values: Mapping[str, str], units: str) -> Entries:
    """The entries of a form; ``units``: the system chosen for bare numbers, or nothing."""
    written = {name: text.strip() for name, text in values.items() if text.strip()}
    chosen = units or None
    try:
        texts, system = in_base_units(written, "", chosen)
    except UserError as error:
        alone, problems = _one_by_one(written, chosen)
        return Entries(alone, chosen, problems or {UNITS: str(error)})
    return Entries(texts, system, {})


def _one_by_one(
    written: Mapping[str, str], units: str | None
) -> tuple[dict[str, str], dict[str, str]]:
    texts: dict[str, str] = {}
    problems: dict[str, str] = {}
    for name, text in written.items():
        try:
            texts |= in_base_units({name: text}, "", units)[0]
        except UserError as error:
            problems[name] = str(error)
    return texts, problems


def told(units: str | None) -> dict[str, Any]:
    """What a form says of its units: the system's ``name``, its ``base`` in words, and the
    ``labels`` of bare numbers, by what they measure."""
    from ..units import base_of, system_of

    system = system_of(units)
    rules = {row.unit for table in (SCENE, RESULTS, CHAPTER) for row in table.values()}
    return {
        "name": units or "",
        "base": base_of(system),
        "labels": {rule: system.label(rule) for rule in sorted(rules)},
    }


def without_rounding(values: Mapping[str, float], share: float) -> dict[str, float]:
    """The values, 0 for those that are at most so small a share of the largest of their kind."""
    largest: dict[str, float] = {}
    for name, value in values.items():
        rule = quantity(name).unit
        if math.isfinite(value):
            largest[rule] = max(largest.get(rule, 0.0), abs(value))
    return {
        name: 0.0 if abs(value) <= share * largest.get(quantity(name).unit, 0.0) else value
        for name, value in values.items()
    }
