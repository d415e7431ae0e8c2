"""What a verification holds: the result for one printout, and for one file."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ..schemas import stamped
from .explain import Explanation
from .judging import FieldCheck, Status, Verdict
from .printout import Piece


@dataclass
class Verification:
    """The result for one printout; `as_json` gives the documented object.

    ``guessed``: inputs whose printed number was not read exactly, or not at all; ``unseen``: what
    the page cannot show; ``left_over``: text that belongs to no field and no label."""

    file: str
    number: int
    line: int
    verdict: Verdict
    scene: dict[str, str | None]
    fields: list[FieldCheck]
    replies: list[FieldCheck] = field(default_factory=list)
    ending: FieldCheck | None = None
    missing: list[str] = field(default_factory=list)
    guessed: list[str] = field(default_factory=list)
    unseen: list[str] = field(default_factory=list)
    explanations: list[Explanation] = field(default_factory=list)
    findings: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    left_over: list[Piece] = field(default_factory=list)
    start: int = 0
    stop: int = 0
    sha256: str | None = None
    text: str = field(default="", repr=False)

    @property
    def differing(self) -> list[FieldCheck]:
        """The fields printed otherwise than recomputed."""
        return [check for check in self.fields if check.same is False]

    @property
    def doubtful(self) -> list[FieldCheck]:
        """The numbers, replies included, in which the program's text was not read exactly."""
        return [one for one in [*self.fields, *self.replies] if one.status == Status.DOUBTFUL]

    @property
    def disagreements(self) -> int:
        """How many fields, replies and endings differ: what an explanation has to explain."""
        ending = [self.ending] if self.ending else []
        return sum(check.same is False for check in [*self.fields, *self.replies, *ending])

    @property
    def runnable(self) -> bool:
        """Whether every value of the scene was recovered."""
        return all(text is not None for text in self.scene.values())

    @property
    def not_read(self) -> list[str]:
        """The fields the program prints and that were not read."""
        return [check.name for check in self.fields if check.status == Status.NOT_READ]

    def as_json(self) -> dict[str, Any]:
        """The object `impact88 verify --json` prints."""
        whole = {
            "file": self.file,
            "sha256": self.sha256,
            "printout": self.number,
            "line": self.line,
            "span": [self.start, self.stop],
            "verdict": str(self.verdict),
            "scene": self.scene,
            "guessed": self.guessed,
            "fields": [check.as_json() for check in self.fields],
            "replies": [check.as_json() for check in self.replies],
            "ending": self.ending.as_json() if self.ending else None,
            "missing": self.missing,
            "not_read": self.not_read,
            "left_over": [piece._asdict() for piece in self.left_over],
            "unseen": self.unseen,
            "explanations": [one.as_json() for one in self.explanations],
            "findings": self.findings,
            "warnings": self.warnings,
            "remarks": self.remarks,
        }
        return stamped("verify", whole)


@dataclass
class Examined:
    """One file: what was found in it, or why it could not be read. ``sha256``: of its bytes."""

    file: str
    sha256: str | None
    results: list[Verification] = field(default_factory=list)
    error: str | None = None

    def as_json(self) -> list[dict[str, Any]]:
        """The objects `impact88 verify --json` prints for the file."""
        if self.error is None:
            return [result.as_json() for result in self.results]
        refused = {"file": self.file, "sha256": self.sha256, "error": self.error}
        return [stamped("verify", refused)]
