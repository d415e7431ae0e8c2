"""Verifying a printout: recover the scene it prints, replay it bit for bit, compare every digit.

The verdict rests on printed digits alone; what exact arithmetic gives and physical warnings stand
beside it and never change it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

from . import beside
from .explain import Explanation, explain
from .printout import Printout, read_file
from .recovery import FieldCheck, ending_check, field_checks, illegible, recover, reply_checks


class Verdict(StrEnum):
    """What a printout is found to be."""

    IDENTICAL = "identical"
    DIFFERS = "differs"
    INCOMPLETE = "incomplete"


@dataclass
class Verification:
    """The result for one printout; `as_json` gives the documented object."""

    file: str
    number: int
    line: int
    verdict: Verdict
    scene: dict[str, str | None]
    fields: list[FieldCheck]
    replies: list[FieldCheck] = field(default_factory=list)
    ending: FieldCheck | None = None
    illegible: list[dict[str, Any]] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    explanations: list[Explanation] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)

    @property
    def differing(self) -> list[FieldCheck]:
        """The fields printed otherwise than recomputed."""
        return [check for check in self.fields if check.same is False]

    @property
    def disagreements(self) -> int:
        """How many fields, replies and endings differ: what an explanation has to explain."""
        ending = [self.ending] if self.ending else []
        return sum(check.same is False for check in [*self.fields, *self.replies, *ending])

    @property
    def runnable(self) -> bool:
        """Whether every value of the scene was recovered."""
        return all(text is not None for text in self.scene.values())

    def as_json(self) -> dict[str, Any]:
        """The object `impact88 verify --json` prints."""
        return {
            "file": self.file,
            "printout": self.number,
            "line": self.line,
            "verdict": str(self.verdict),
            "scene": self.scene,
            "fields": [vars(check) for check in self.fields],
            "replies": [vars(check) for check in self.replies],
            "ending": vars(self.ending) if self.ending else None,
            "missing": self.missing,
            "illegible": self.illegible,
            "explanations": [
                {
                    "kind": one.kind,
                    "field": one.field,
                    "printed": one.printed,
                    "would_be": one.would_be,
                    "explains": one.explains,
                    "remaining": one.remaining,
                    "note": one.note,
                }
                for one in self.explanations
            ],
            "warnings": self.warnings,
            "remarks": self.remarks,
        }


def verify_file(path: str) -> Iterator[Verification]:
    """Each printout in a file (``-``: standard input). Raises UserError if it cannot be read."""
    for number, shown in enumerate(read_file(path), 1):
        yield verify(shown, path, number)


def verify(shown: Printout, file: str = "-", number: int = 1) -> Verification:
    """The verdict on one printout, with explanations where it differs."""
    recovered = recover(shown)
    checks = field_checks(shown, recovered)
    replies = reply_checks(shown, recovered)
    ending = ending_check(shown, recovered)
    result = Verification(
        file=file,
        number=number,
        line=shown.line,
        verdict=Verdict.IDENTICAL,
        scene=recovered.scene_or_missing(),
        fields=checks,
        replies=replies,
        ending=ending,
        illegible=illegible(shown, recovered),
        missing=recovered.missing,
        remarks=[str(remark) for remark in shown.remarks],
    )
    every = [*checks, *replies, ending]
    if any(check.same is False for check in every):
        result.verdict = Verdict.DIFFERS
    elif any(check.same is None for check in every) or recovered.missing:
        result.verdict = Verdict.INCOMPLETE
    if recovered.m_unknown:
        result.remarks.append("whether M was 6 or 4 does not show in this printout")
    if result.verdict is Verdict.DIFFERS:
        result.explanations = explain(shown, recovered, checks, replies, ending)
    if result.runnable:
        beside.add_exact_values(recovered.scene, checks)
        result.warnings = beside.warnings(recovered.scene)
    return result
