"""What a verification holds, for one printout and for one file; and what is said of it.

`sections` is all that is said in words, whatever the form: text, a page, the desk.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

from .. import notebook
from ..errors import shown
from ..files import called
from ..judging.judgement import FieldCheck, Status, Verdict
from ..plaintable import table
from ..reading.fieldlabels import LabelCheck, LabelState
from ..reading.printout import Piece
from ..schemas import stamped
from . import wording

if TYPE_CHECKING:
    from ..explaining.explanations import Explanation

NO_SINGLE_SLIP = "no single slip explains this"


@dataclass
class Verification:
    """The result for one printout; `as_json` gives the documented object.

    ``guessed``: inputs whose printed number was not read exactly, or not at all; ``unseen``: what
    the page cannot show; ``left_over``: text that belongs to no field and no label; ``copy``: the
    listing it is held against where that is not the restored one; ``page``: of a picture, its
    page, ``basis``: how sure its margins are, and ``exhibit``: what shows its cells in the report.

    >>> page = impact88.run(impact88.sample(1)).page.replace("-13.263", "-13.268")
    >>> (found,) = impact88.verify(page)
    >>> found.verdict.name
    'DIFFERS'
    """

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
    labels: list[LabelCheck] = field(default_factory=list)
    cells: list[dict[str, Any]] = field(default_factory=list)
    basis: str = ""
    exhibit: Callable[[], dict[str, Any]] | None = field(default=None, repr=False)
    page: int | None = None
    start: int = 0
    stop: int = 0
    sha256: str | None = None
    copy: dict[str, Any] | None = None
    text: str = field(default="", repr=False)

    @property
    def where(self) -> str:
        """Where the printout begins in its file."""
        return f"line {self.line}" if self.page is None else f"page {self.page}, line {self.line}"

    @property
    def differing(self) -> list[FieldCheck]:
        """The fields printed otherwise than recomputed."""
        return [check for check in self.fields if check.same is False]

    @property
    def doubtful(self) -> list[FieldCheck]:
        """The numbers, replies included, in which the program's text was not read exactly."""
        return [one for one in [*self.fields, *self.replies] if one.status == Status.DOUBTFUL]

    @property
    def mislabelled(self) -> list[LabelCheck]:
        """The labels that name another number than the one that stands there."""
        return [one for one in self.labels if one.state is LabelState.CONTRADICTORY]

    @property
    def disagreements(self) -> int:
        """How many fields, replies, labels and endings differ: what a cause has to explain."""
        others = [*self.replies, *([self.ending] if self.ending else [])]
        wrong = [check for check in others if check.same is False]
        return len(self.differing) + len(wrong) + len(self.mislabelled)

    @property
    def runnable(self) -> bool:
        """Whether every value of the scene was recovered."""
        return all(text is not None for text in self.scene.values())

    @property
    def not_read(self) -> list[str]:
        """The fields the program prints and that were not read."""
        return [check.name for check in self.fields if check.status == Status.NOT_READ]

    def renumber(self, lines: Sequence[int]) -> None:
        """Give every place the number that its line had in the file; none: they stand."""
        if not lines:
            return
        for check in [*self.fields, *self.replies]:
            check.line = lines[check.line - 1] if check.line else None
            check.doubts = [one._replace(line=lines[one.line - 1]) for one in check.doubts]
        self.line = lines[self.line - 1]
        self.labels = [one._replace(line=lines[one.line - 1]) for one in self.labels]
        self.left_over = [one._replace(line=lines[one.line - 1]) for one in self.left_over]

    def _repr_html_(self) -> str:
        """What the command prints, as a notebook shows it."""
        return notebook.preformatted("\n".join(lines(self)))

    def as_json(self) -> dict[str, Any]:
        """The object `impact88 verify --json` prints."""
        whole = {"printout": self.number, "span": [self.start, self.stop]}
        whole |= {name: _plain(getattr(self, name)) for name in _IN_JSON}
        if self.copy:
            whole["listing"] = self.copy
        if self.cells:
            whole |= {"cells": self.cells, "basis": self.basis}
        return stamped("verify", whole)


_IN_JSON = (
    *("file", "sha256", "line", "verdict", "scene", "guessed", "fields", "replies", "ending"),
    *("missing", "not_read", "labels", "left_over", "unseen", "explanations", "findings"),
    *("warnings", "remarks"),
)


def _plain(value: Any) -> Any:
    """A value as JSON takes it."""
    if isinstance(value, list):
        return list(map(_plain, value))
    if hasattr(value, "as_json"):
        return value.as_json()
    return value._asdict() if isinstance(value, Piece) else value


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


# --- in words -------------------------------------------------------------------------------------


class Section(NamedTuple):
    """A part of what is said of a printout, in any form: a heading and its lines; a line that
    begins with blanks belongs to the one above it."""

    heading: str
    lines: list[str]


def summary(result: Verification) -> list[str]:
    """What a verdict rests on: counts, and by name what is missing."""
    verdict, fields, missing = result.verdict, result.fields, result.missing
    said = [wording.counts(fields)]
    if verdict is Verdict.IDENTICAL:
        who = f"the copy {result.copy['file']}" if result.copy else "the program"
        said = [f"all {len(fields)} printed numbers are what {who} prints, digit for digit"]
    elif verdict is Verdict.DIFFERS:
        compared = sum(check.same is not None for check in fields)
        said = [f"{compared} printed numbers compared, {len(result.differing)} differ"]
        if wrong := len(result.mislabelled):
            said.append("1 label contradicts" if wrong == 1 else f"{wrong} labels contradict")
    elif verdict is Verdict.IDENTICAL_AS_READ:
        said.append(wording.MEANINGS[verdict])
    if missing:
        verb, it = ("is", "it") if len(missing) == 1 else ("are", "them")
        said.append(f"{', '.join(missing)} {verb} missing: what depends on {it} was not compared")
    not_read = [name for name in result.not_read if name not in missing]
    if not_read and verdict is not Verdict.IDENTICAL_AS_READ:
        said.append(f"not read: {', '.join(not_read)}")
    if verdict is Verdict.INCOMPLETE and not (
        missing or not_read or result.page or result.differing
    ):
        said.append("the results are missing, or the page ends before them")
    ending = result.ending
    if ending is not None and ending.same is not True and (ending.printed or ending.recomputed):
        said.append(
            f"ends with {ending.printed or 'no error'}, "
            f"recomputed: {ending.recomputed or 'no error'}"
        )
    return said


DOUBTFUL, NOTES = "doubtful places", "notes on the reading"
EXPLAINED = "possible explanations, best first"


def sections(result: Verification) -> list[Section]:
    """Everything below the verdict and beside the table, in order; no empty ones."""
    doubtful = wording.labels(result.labels)
    doubtful += [line for check in result.doubtful for line in wording.doubts(check)]
    notes = [
        f"{check.name}: the reply {check.printed} is not the {check.recomputed} used"
        for check in result.replies
        if check.same is False
    ]
    notes += [*result.remarks, *wording.left_over(result.left_over)]
    every = (
        Section(DOUBTFUL, doubtful),
        Section(EXPLAINED, _explained(result) if result.verdict is Verdict.DIFFERS else []),
        Section("the page cannot show", result.unseen),
        Section("what the page shows besides", result.findings),
        Section("beside the verdict", result.warnings),
        Section(NOTES, notes),
    )
    return [one for one in every if one.lines]


def _explained(result: Verification) -> list[str]:
    """The explanations, best first, and where to look on the paper."""
    said: list[str] = []
    before = 0
    for one in result.explanations:
        cause = wording.cause(one)
        if one.rank != before:
            said.append(f"{one.rank}. {cause}; explains {one.explains} of {result.disagreements}")
        else:
            said.append(f"   or, equally well on this page: {cause}")
        before = one.rank
        said += [f"   look at {where}" for where in one.look[:4]]
    return said or [NO_SINGLE_SLIP]


# --- as text --------------------------------------------------------------------------------------


def lines(result: Verification, brief: bool = False) -> Iterator[str]:
    """What `impact88 verify` prints of one printout; ``brief``: only verdict and what differs."""
    where = f"{shown(called(result.file))}, printout {result.number} ({result.where})"
    yield f"{where}: {wording.TITLES[result.verdict]}"
    parts = {one.heading: one.lines for one in sections(result)}
    doubtful, notes = parts.pop(DOUBTFUL, []), parts.pop(NOTES, [])
    yield from (f"  {line}" for line in [*summary(result), *_some(doubtful, brief)])
    checks = result.differing if brief else result.fields
    if checks:
        yield ""
        yield from (f"  {line}" for line in _table(checks, exact=not brief))
    for heading, said in parts.items():
        if not brief or said is not result.warnings:
            yield ""
            yield f"  {heading}:"
            mark = "" if heading == EXPLAINED else "- "
            yield from (f"  {mark}{line}" for line in said)
    yield from (f"  note: {line}" for line in _some(notes, brief))
    if not brief:
        yield ""


def _some(said: list[str], brief: bool) -> list[str]:
    """All lines, or a few of them and how many more there are."""
    if not brief or len(said) <= 4:
        return said
    return [*said[:3], f"and {len(said) - 3} more places"]


def _table(checks: Sequence[FieldCheck], exact: bool) -> list[str]:
    """Rows of printed against recomputed, those that differ marked."""
    rows = [["", "printed", "recomputed", *["exact", "printed-exact"] * exact, ""]]
    for check in checks:
        beside = [check.exact or "", check.difference or ""] * exact
        mark = wording.STATES[check.status]
        rows.append([check.name, check.printed or "-", check.recomputed or "-", *beside, mark])
    return table(rows, left=(0, len(rows[0]) - 1))
