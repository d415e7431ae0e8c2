"""Helpers for tests on scenes: the chapter's cases by the project's names, and single scenes."""

from __future__ import annotations

import json
from typing import Any

from captures import ROOT

FROM_CHAPTER = {
    "ma": "MA",
    "mb": "MB",
    "Ia": "IA",
    "Ib": "IB",
    "da": "DA",
    "db": "DB",
    "Ga": "GA",
    "pa": "PA",
    "pb": "PB",
    "ta": "TA",
    "tb": "TB",
    "e": "E",
    "mu": "MU",
    "em": "EM",
    "ux": "UX",
    "uy": "UY",
    "wa": "WA",
    "vx": "VX",
    "vy": "VY",
    "wb": "WB",
}
"""The names golden/reference-cases.json uses -> the scene's."""


def reference_cases() -> list[dict[str, Any]]:
    """All worked cases, inputs by scene name where they are a scene."""
    text = (ROOT / "golden" / "reference-cases.json").read_text(encoding="utf-8")
    cases: list[dict[str, Any]] = json.loads(text)["cases"]
    return cases


def scene_of(case: dict[str, Any]) -> dict[str, float]:
    """The scene of a forward case, as numbers."""
    scene = {FROM_CHAPTER[name]: float(text) for name, text in case["input"].items()}
    return {**scene, "M": 4.0} if "point-mass" in case["kind"] else {**scene, "M": 6.0}


RUN_1: dict[str, float] = scene_of(reference_cases()[0])
"""The Appendix's first sample run."""
