"""The record of a hearing: what was compared with what, counts, differences, hashes, versions."""

from __future__ import annotations

from collections import Counter
from importlib import metadata
from typing import Any

from ..reporting import provenance
from .hearing import Heard
from .image import Image

TOLD = 100
"""Cases with differences that a record holds in full."""


def record(image: Image, heard: list[Heard], seconds: float) -> dict[str, Any]:
    """The object `impact88 witness --json` prints."""
    cases, comparisons, failing = Counter[str](), Counter[str](), Counter[str]()
    for one in heard:
        cases[one.kind] += 1
        comparisons.update(f"{one.kind}, {who}" for who in one.compared)
        failing.update({f"{one.kind}, {difference.who}" for difference in one.differences})
    wrong = [one for one in heard if one.differences]
    return {
        "passed": bool(heard) and not wrong,
        "versions": {**provenance.versions(), "py65": metadata.version("py65")},
        "hashes": {
            "rom_sha1": image.sha1,
            "listing": provenance.listing_hash(),
            "captures": provenance.captures_hash(),
        },
        "rom": "Apple II Plus" if image.known else "unknown",
        "cases": dict(cases),
        "comparisons": {
            name: {"total": total, "right": total - failing[name]}
            for name, total in comparisons.items()
        },
        "differing_cases": len(wrong),
        "differences": [
            {
                "kind": one.kind,
                "name": one.name,
                "differences": [difference._asdict() for difference in one.differences],
            }
            for one in wrong[:TOLD]
        ],
        "seconds": round(seconds, 1),
    }
