"""A collision as bare numbers of any system of units."""

from __future__ import annotations

from collections.abc import Mapping

from impact88.collision.casescene import sample
from impact88.collision.units import SYSTEMS, shown_text
from impact88.names import quantity

METRES = {"MA": "1500", "MB": "1100", "IA": "2500", "IB": "1500", "DA": "1.9", "DB": "1.4"}
SPEEDS = {"UX": "-12", "UY": "1", "WA": "0.2", "VX": "6", "VY": "9", "WB": "-0.1"}
SCENE = {**sample(1), **METRES, **SPEEDS, "GA": "-20", "MU": ".4"}


def texts(system: str, values: Mapping[str, str] = SCENE) -> dict[str, str]:
    """The values as bare numbers of a system."""
    shown = SYSTEMS[system]
    result = {}
    for name, text in values.items():
        base = float(text) / float(shown.scale(quantity(name).unit))
        plain = quantity(name).unit in ("1", "degree")
        result[name] = text if plain else shown_text(name, repr(base), shown)
    return result
