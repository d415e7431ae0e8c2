"""The worked cases of golden/reference-cases.json, in this project's names."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from typing import Any

from captures import ROOT

_GIVEN = {
    **{"ma": "MA", "mb": "MB", "Ia": "IA", "Ib": "IB", "da": "DA", "db": "DB", "Ga": "GA"},
    **{"pa": "PA", "pb": "PB", "ta": "TA", "tb": "TB", "e": "E", "em": "EM", "mu": "MU"},
    **{"ux": "UX", "uy": "UY", "wa": "WA", "vx": "VX", "vy": "VY", "wb": "WB"},
    "mu_signed": "MUP",
}
VELOCITIES = {
    **{"vax": "UX", "vay": "UY", "wa": "WA", "vbx": "VX", "vby": "VY", "wb": "WB"},
    **{"Vax": "VAX", "Vay": "VAY", "Wa": "WAF", "Vbx": "VBX", "Vby": "VBY", "Wb": "WBF"},
}
FOUND = {**VELOCITIES, "e": "E", "em": "EM", "mu": "MUP"}


@dataclass(frozen=True)
class Case:
    """A case: what is given, by name; ``result`` as the file has it."""

    name: str
    kind: str
    given: dict[str, float]
    result: dict[str, Any]

    def __str__(self) -> str:
        return self.name

    @property
    def velocities(self) -> dict[str, float]:
        """The velocities (and coefficients, where they are what is sought) of the result."""
        values = {**self.result, **self.result.get("final", {})}
        return {FOUND[key]: float(value) for key, value in values.items() if key in FOUND}


@cache
def cases() -> tuple[Case, ...]:
    """Every case that has an input."""
    text = (ROOT / "golden" / "reference-cases.json").read_text(encoding="utf-8")
    found = []
    for case in json.loads(text)["cases"]:
        given = dict(case.get("input") or {})
        if not given:
            continue
        velocities = {**given.pop("finals", {}), **given.pop("known", {})}
        if "colinear" in case["kind"]:
            numbers = {key: float(value) for key, value in given.items()}
        else:
            numbers = {_GIVEN[key]: float(value) for key, value in given.items()}
            if "MUP" in numbers:
                numbers.pop("MU", None)
            if "point-mass" in case["kind"]:
                numbers["M"] = 4
        numbers |= {VELOCITIES[key]: float(value) for key, value in velocities.items()}
        found.append(Case(case["name"], case["kind"], numbers, case["result"]))
    return tuple(found)


def cases_of(*kinds: str) -> list[Case]:
    """The cases whose kind begins with one of ``kinds``; at least one of each."""
    found = [case for case in cases() if case.kind.startswith(kinds)]
    for kind in kinds:
        assert any(case.kind.startswith(kind) for case in found), kind
    return found
