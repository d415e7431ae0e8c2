"""What a verification holds, for one printout and for one file; and what is said of it.

`sections` is all that is said in words, whatever the form: text, a page, the desk.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ...collision.fields import ANGLES, INPUTS, scene_name
from ...errors import one_line, printable
from ...files import display_name
from ...messages import notebook
from ...messages.plaintable import table
from ...messages.schemas import with_schema
from ..judging.judgement import FieldCheck, Judged, Status, Verdict
from ..reading.fieldlabels import LabelCheck, LabelState
from ..reading.numerals import Doubt, value_of
from ..reading.printout import Piece
from ..recovery.replays import run_once
from ..recovery.typedtext import stored_and_printed

if TYPE_CHECKING:
    from ...program.emulated import ListingCopy
    from ..explaining.causes import Cause

TITLES = {
    Verdict.IDENTICAL: "IDENTICAL",
    Verdict.IDENTICAL_AS_READ: "IDENTICAL AS FAR AS READ",
    Verdict.DIFFERS: "DIFFERS",
    Verdict.INCOMPLETE: "INCOMPLETE",
}

MEANINGS = {
    Verdict.IDENTICAL: "every number that was found on the page is what the 1988 program prints "
    "for the inputs on it, digit for digit, and nothing that was examined speaks against it",
    Verdict.IDENTICAL_AS_READ: "the 1988 program's page explains the paper; what was not read "
    "exactly, or is none of the program's, is listed, and is to be looked at on the paper",
    Verdict.DIFFERS: "something on the paper contradicts every scene that its inputs allow",
    Verdict.INCOMPLETE: "numbers are missing or could not be read; what could be compared agrees",
}
"""What a verdict says."""

DOUBTFUL, NOTES = "doubtful places", "notes on the reading"
MARKS = "on the page and not printed by the program"
EXPLAINED = "possible explanations, best first"


@dataclass(repr=False)
class Verification:
    """The result for one printout; `as_json` gives the documented object.

    Parameters
    ----------
    file : str
        The file.
    number : int
        Which printout of the file it is, from 1.
    line : int
        The line the printout begins in.
    verdict : Verdict
        IDENTICAL, AS_FAR_AS_READ, INCOMPLETE or DIFFERS.
    scene : dict of str to str or None
        The inputs recovered.
    fields : list of FieldCheck
        Each printed number beside the recomputed one.
    replies : list of FieldCheck
        What was typed for the velocities.
    ending : FieldCheck, optional
        How the printout ends.
    missing, guessed : list of str
        Inputs without a printed number, and those whose printed number was not read exactly.
    unseen : list of str
        Errors that this page could not reveal.
    explanations : list of Cause
        What would make a differing page agree.
    findings, warnings, remarks : list of str
        Other findings, warnings of the mechanics, and notes on how the page was read.
    left_over : list of Piece
        Text that belongs to no field and no label.
    labels : list of LabelCheck
        Labels that are not the program's.
    cells, marks : list of dict
        Of a picture, the cells of the printed characters, and all ink in and near the printout that
        the program does not print.
    basis : str
        Of a picture, how sure its margins are.
    exhibit : callable, optional
        Returns the pictures of the cells for the report.
    page : int, optional
        Of a picture, its page.
    start, stop : int
        Where the printout stands in the text.
    sha256 : str, optional
        Hash of the file.
    copy : dict, optional
        The listing it is held against, where that is not the restored one.
    converted : bool
        Whether that listing converts inputs before it prints them: the scene is as printed.
    text : str
        The text it was read from.

    Examples
    --------
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
    explanations: list[Cause] = field(default_factory=list)
    findings: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    left_over: list[Piece] = field(default_factory=list)
    labels: list[LabelCheck] = field(default_factory=list)
    cells: list[dict[str, Any]] = field(default_factory=list)
    marks: list[dict[str, Any]] = field(default_factory=list)
    basis: str = ""
    exhibit: Callable[[], dict[str, Any]] | None = field(default=None, repr=False)
    page: int | None = None
    start: int = 0
    stop: int = 0
    sha256: str | None = None
    copy: dict[str, Any] | None = None
    converted: bool = False
    text: str = field(default="", repr=False)

    @property
    def where(self) -> str:
        """Line, and page of a picture, at which the printout begins in its file."""
        return f"line {self.line}" if self.page is None else f"page {self.page}, line {self.line}"

    @property
    def differing(self) -> list[FieldCheck]:
        """Fields whose printed number differs from the recomputed one."""
        return [check for check in self.fields if check.same is False]

    @property
    def complete_scene(self) -> dict[str, str]:
        """The recovered scene, empty if any value of it was not recovered."""
        scene = {name: text for name, text in self.scene.items() if text is not None}
        return scene if len(scene) == len(self.scene) else {}

    @property
    def not_read(self) -> list[str]:
        """Names of the fields that the program prints and that were not read."""
        return [check.name for check in self.fields if check.status == Status.NOT_READ]

    def renumber(self, lines: Sequence[int]) -> None:
        """Renumber the lines of all places, from lines of the text to lines of the file.

        Parameters
        ----------
        lines : sequence of int
            Line number in the file of each line of the text, from the text's line 1.
        """
        for check in [*self.fields, *self.replies]:
            check.line = lines[check.line - 1] if check.line else None
            check.doubts = [doubt._replace(line=lines[doubt.line - 1]) for doubt in check.doubts]
        self.line = lines[self.line - 1]
        self.labels = [label._replace(line=lines[label.line - 1]) for label in self.labels]
        self.left_over = [piece._replace(line=lines[piece.line - 1]) for piece in self.left_over]

    def __repr__(self) -> str:
        exact = sum(check.same is True for check in self.fields)
        return (
            f"<Verification of printout {self.number} ({self.where}) of "
            f"{display_name(self.file)!r}: {self.verdict.name}, {exact} of {len(self.fields)} "
            "numbers read exactly so>"
        )

    def _repr_html_(self) -> str:
        return notebook.preformatted_html("\n".join(lines(self)))

    def as_json(self) -> dict[str, Any]:
        """Return the object that ``impact88 verify --json`` prints.

        Returns
        -------
        dict of str to object
            The verification as JSON types, in the form of ``impact88 schema verify``.
        """
        described = {"printout": self.number, "span": [self.start, self.stop]}
        described |= {name: _plain(getattr(self, name)) for name in _IN_JSON}
        if self.copy:
            described["listing"] = self.copy
        if self.cells:
            described |= {"cells": self.cells, "marks": self.marks, "basis": self.basis}
        return with_schema("verify", described)


class Verifications(list[Verification]):
    """The verdicts on the printouts of one file, in their order.

    A list, which a notebook shows as the command prints it.

    Parameters
    ----------
    iterable : iterable of Verification, optional
        The verdicts.

    Examples
    --------
    >>> page = impact88.run(impact88.sample(1)).page
    >>> [result.verdict.name for result in impact88.verify(page)]
    ['IDENTICAL']
    """

    def _repr_html_(self) -> str:
        return notebook.preformatted_html("\n".join(line for one in self for line in lines(one)))


_IN_JSON = (
    *("file", "sha256", "line", "verdict", "scene", "guessed", "fields", "replies", "ending"),
    *("missing", "not_read", "labels", "left_over", "unseen", "explanations", "findings"),
    *("warnings", "remarks"),
)


def _plain(value: Any) -> Any:
    if isinstance(value, list):
        return list(map(_plain, value))
    if hasattr(value, "as_json"):
        return value.as_json()
    return value._asdict() if isinstance(value, Piece | LabelCheck) else value


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
        return [with_schema("verify", refused)]


# --- in words -------------------------------------------------------------------------------------


def summary(result: Verification) -> list[str]:
    """What a verdict rests on: counts, and by name what is missing."""
    verdict, fields, missing = result.verdict, result.fields, result.missing
    said = [counts(fields)]
    if verdict is Verdict.IDENTICAL:
        who = f"the copy {result.copy['file']}" if result.copy else "the program"
        said = [f"all {len(fields)} printed numbers are what {who} prints, digit for digit"]
    elif verdict is Verdict.DIFFERS:
        compared = sum(check.same is not None for check in fields)
        said = [*_of_another_copy(result)]
        said.append(f"{compared} printed numbers compared, {len(result.differing)} differ")
        replies = sum(check.same is False for check in result.replies)
        if replies:
            noun = "reply at a prompt differs" if replies == 1 else "replies at prompts differ"
            said.append(f"{replies} {noun} from the velocities printed")
        if wrong := sum(label.state is LabelState.CONTRADICTORY for label in result.labels):
            said.append("1 label contradicts" if wrong == 1 else f"{wrong} labels contradict")
        if lines := sum(bool(mark["contradicts"]) for mark in result.marks):
            verb = "1 typed line gives" if lines == 1 else f"{lines} typed lines give"
            said.append(f"{verb} numbers that are not the page's")
    elif verdict is Verdict.IDENTICAL_AS_READ:
        said.append(MEANINGS[verdict])
    if result.page is None and verdict in (Verdict.IDENTICAL, Verdict.IDENTICAL_AS_READ):
        said.append(_examined(result))
    if missing:
        verb, it = ("is", "it") if len(missing) == 1 else ("are", "them")
        said.append(f"{', '.join(missing)} {verb} missing: what depends on {it} was not compared")
    not_read = [name for name in result.not_read if name not in missing]
    if not_read and verdict is not Verdict.IDENTICAL_AS_READ:
        said.append(f"not read: {', '.join(not_read)}")
    known = missing or not_read or result.page or result.differing
    if verdict is Verdict.INCOMPLETE and not known:
        said.append("the results are missing, or the page ends before them")
    ending = result.ending
    if ending is not None and ending.same is not True and (ending.printed or ending.recomputed):
        printed, recomputed = (text or "no error" for text in (ending.printed, ending.recomputed))
        said.append(f"ends with {printed}, recomputed: {recomputed}")
    return said


def counts(fields: Sequence[FieldCheck]) -> str:
    """How many numbers were read exactly, doubtful, contradicted, not read."""
    number = Counter(check.status for check in fields)
    words = {
        Status.DOUBTFUL: "read doubtfully",
        Status.CONTRADICTED: "differs" if number[Status.CONTRADICTED] == 1 else "differ",
        Status.NOT_READ: "not read",
        Status.NOT_COMPARED: "not compared",
    }
    exact = f"{number[Status.READ]} of {len(fields)} printed numbers read exactly and as the "
    others = [f"{number[status]} {word}" for status, word in words.items() if number[status]]
    return ", ".join([exact + "program prints them", *others])


def sections(result: Verification) -> dict[str, list[str]]:
    """All that is said below the verdict and beside the table, in any form: headings, in order, and
    the lines of each; a line that begins with blanks belongs to the one above it."""
    doubtful = _labels(result.labels)
    for check in [*result.fields, *result.replies]:
        if check.status == Status.DOUBTFUL:
            doubtful += _doubts(check)
            suffix = f" ({check.name}: the program prints {check.recomputed})"
            doubtful += [where + suffix for where in look(check)]
    notes = [
        f"{check.name}: the reply {check.printed} is not the {check.recomputed} used"
        for check in result.replies
        if check.same is False
    ]
    every = {
        DOUBTFUL: doubtful,
        MARKS: list(_marks(result.marks)),
        EXPLAINED: _explained(result),
        "the page cannot show": result.unseen,
        "what the page shows besides": result.findings,
        "beside the verdict": result.warnings,
        NOTES: [*notes, *result.remarks, *_left_over(result.left_over)],
    }
    return {heading: said for heading, said in every.items() if said}


_MARK_WORDS = {
    "character": "{reads!r} typed where the program prints a blank",
    "type": "typed text that the program does not print: {reads!r}",
    "mark": "a mark like no character of the page",
    "stroke": "ink larger than a character: pen, stamp or stain",
    "coloured ink": "ink of another colour than the page's type",
    "straight line": "a straight line",
    "hole": "a hole",
    "edge of the sheet": "a dark edge of the sheet",
}
_COUNTED = {"straight line": "lines", "hole": "holes", "edge of the sheet": "dark edges"}


def _marks(marks: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """What the program does not print: what bears on the verdict each by itself."""
    for mark in marks:
        if mark["bears"] or mark["kind"] not in _COUNTED:
            x, y, _, _ = mark["box"]
            place = f"line {mark['line']}, cell {mark['cell']}" if mark["line"] else ""
            place = place or f"{x:.0f} pixels from the left, {y:.0f} from the top"
            said = f"page {mark['page']}, {place}: {_MARK_WORDS[mark['kind']].format(**mark)}"
            beside = mark["beside"] and not mark["line"] and not mark["touches"]
            said += ", in or beside a line of the printout" if beside else ""
            touches = ", ".join(mark["touches"])
            yield said + (f"; touches {touches}" if touches and mark["kind"] not in _TYPED else "")
    for kind, words in _COUNTED.items():
        if count := sum(mark["kind"] == kind and not mark["bears"] for mark in marks):
            yield f"{count} {words if count > 1 else kind}, away from the printed lines"


_TYPED = ("character", "type")

_DOUBTS: dict[str, str] = {
    Doubt.LOOK_ALIKE: "read {read!r} where the program prints {printed!r} ({program})",
    Doubt.ILLEGIBLE: "illegible (read {read!r}) where the program prints {printed!r} ({program})",
    Doubt.BLANK: "a blank or a joint in it; the program prints {program}",
    Doubt.RETYPED: "read {whole}; the program prints {program}, never this form",
    Doubt.CUT: "cut off; the program prints {program}",
    Doubt.LEFT_OVER: "{read!r} left over beside {program}",
    "another reading": "read {read!r} by another reader where the program prints {program}",
    "picture": "nearly as much like {read!r} as {printed!r} ({program})",
}


def _doubts(check: FieldCheck) -> Iterator[str]:
    for doubt in check.doubts:
        if doubt.how in _DOUBTS:
            words = {**doubt._asdict(), "program": check.recomputed or "", "whole": check.printed}
            said = _DOUBTS[doubt.how].format(**words)
            yield f"line {doubt.line}, column {doubt.column}: {check.name} {said}"


def look(check: FieldCheck) -> Iterator[str]:
    """Where to look on the paper for a misread digit."""
    for doubt in check.doubts:
        if doubt.how == Doubt.CONTRADICTS:
            printed = f"{'an' if doubt.printed[:1] == '8' else 'a'} {doubt.printed}"
            question = f"is {printed} missing here"
            if doubt.read:
                part = printed if doubt.printed else "part of the number"
                question = f"is this {doubt.read} {part}"
            yield f"line {doubt.line}, column {doubt.column}: {question}?"


_LABELS = {
    LabelState.CONTRADICTORY: "labelled {read} where the program prints {printed}",
    LabelState.DAMAGED: "the label {printed} is read {read}",
    LabelState.MISSING: "no label before the number where the program prints {printed}",
}


def _labels(checks: Sequence[LabelCheck]) -> list[str]:
    """The labels that are not the program's, those that contradict first."""
    return [
        f"line {label.line}: " + text.format(read=printable(label.read), printed=label.printed)
        for state, text in _LABELS.items()
        for label in checks
        if label.state is state and (state is LabelState.CONTRADICTORY or label.doubt)
    ]


_MOST_LINES = 12
"""Lines that do not belong to the program's page are shown up to this many."""


def _left_over(pieces: Sequence[Piece]) -> Iterator[str]:
    """What belongs to no number and no label: beside a number, or a whole line."""
    for piece in pieces:
        if not piece.whole:
            text = piece.text if len(piece.text) <= 40 else piece.text[:37] + "..."
            where = f"line {piece.line}, column {piece.column}"
            yield f"{where}: {text!r} left over{' beside a number' * piece.beside}"
    lines = sorted((piece for piece in pieces if piece.whole), key=lambda piece: not piece.beside)
    for piece in sorted(lines[:_MOST_LINES], key=lambda piece: piece.line):
        yield f"line {piece.line} does not belong to the program's page: {printable(piece.text)}"
    if len(lines) > _MOST_LINES:
        yield f"and {len(lines) - _MOST_LINES} more lines that do not belong to the program's page"


def _explained(result: Verification) -> list[str]:
    """The explanations, best first, and where to look on the paper; of a picture its cells say what
    differs."""
    if result.verdict is not Verdict.DIFFERS or result.page is not None:
        return []
    said: list[str] = []
    before = 0
    for cause in result.explanations:
        if cause.rank != before:
            said.append(f"{cause.rank}. {cause}; explains {cause.explains} of {cause.differing}")
        else:
            said.append(f"   or, equally well on this page: {cause}")
        before = cause.rank
        said += [f"   look at {where}" for where in cause.look[:4]]
    return said or ["no single slip explains this"]


def _examined(result: Verification) -> str:
    """Return what of a text was examined, in one sentence."""
    replies = len(result.replies)
    what = f"{len(result.fields)} numbers and their labels"
    if replies:
        what += f", {replies} replies at the prompts"
    rest = "nothing else stands on the page"
    if result.left_over:
        rest = "what else stands on the page is listed below"
    return f"examined: {what}; {rest}"


def _of_another_copy(result: Verification) -> Iterator[str]:
    """In words, where every number agrees and only replies or labels are not the listing's: what
    may have printed such a page."""
    if result.differing or result.copy or result.page is not None or not result.complete_scene:
        return
    wrong = [check for check in result.replies if check.same is False]
    labels = [label for label in result.labels if label.state is LabelState.CONTRADICTORY]
    if not wrong and not labels:
        return
    what = "what was typed at the prompts is not what it computed with"
    if not wrong:
        what = "its labels are not the listing's"
    ratios = [_ratio(check) for check in wrong]
    if len(wrong) > 1 and all(ratios) and max(ratios) - min(ratios) <= 1e-3 * abs(max(ratios)):
        what += f" (each velocity printed is {ratios[0]:.6g} times the reply)"
    yield f"the numbers agree, but {what}"
    yield (
        "another copy of the listing may have printed this page: if so, verify it with "
        "--listing COPY"
    )


def _ratio(check: FieldCheck) -> float:
    printed, typed = value_of(check.recomputed or ""), value_of(check.printed or "")
    return float(printed / typed) if printed and typed else 0.0


# --- what a page shows besides its numbers -------------------------------------------------------


def findings(found: Judged) -> Iterator[str]:
    """Forms the program never prints, and which M a page without final spins is read as."""
    recovered = found.recovered
    retyped = [
        check.name
        for check in found.fields
        if any(doubt.how == Doubt.RETYPED for doubt in check.doubts)
    ]
    if retyped:
        yield (
            f"{', '.join(retyped)} in a form Applesoft never prints (a zero before the point or at "
            "the end, a plus sign): retyped, or made by another program"
        )
    regions = [reading.region[:-1] for reading in found.paper.fields.values()]
    text = "".join(glyph.char for region in regions for glyph in region)
    if text.count(",") >= 3 and "." not in text:
        yield "decimal commas throughout: retyped, or made by another program"
    m = recovered.scene["M"]
    if recovered.m_unknown and not recovered.missing:
        yield (
            f"no line of final spins: read as M = {m}; with M = {'6' if m == '4' else '4'} the "
            "program prints the same numbers but for that line"
        )
    elif m == "4" and "M" not in recovered.missing and not found.paper.has_final_spins:
        yield "no line of final spins: the results are those of M = 4, not of M = 6"


_MISREADINGS = (Doubt.LOOK_ALIKE, Doubt.ILLEGIBLE, Doubt.CONTRADICTS)


def put_down(found: Judged) -> Iterator[str]:
    """That digits which were cleanly read as others are put down to the page's reader."""
    others = [
        f"{check.name} ({read} for {printed})"
        for check in [*found.fields, *found.replies]
        for printed, read in check.swapped()
    ]
    misread = sum(
        any(doubt.how in _MISREADINGS and doubt.read != doubt.printed for doubt in check.doubts)
        for check in found.fields
    )
    if others:
        yield (
            f"read as another digit than the program prints: {', '.join(others)}; put down to the "
            f"reader of the page, who misread {misread} of {len(found.fields)} numbers: if the "
            "paper shows one of these digits as it was read, it differs from the program's page"
        )


def of_copy(copy: ListingCopy, result: Verification) -> list[str]:
    """What an office's copy of the listing prints, and in which lines it is another program."""
    scene = result.complete_scene
    restored = run_once(scene).fields if scene else {}
    agrees = result.verdict in (Verdict.IDENTICAL, Verdict.IDENTICAL_AS_READ)
    others = ", ".join(
        f"{check.name} {restored.get(check.name, 'nothing')}"
        for check in result.fields
        if check.recomputed != restored.get(check.name)
    )
    beside = f"; the restored listing prints {others or 'the same numbers'}" if scene else ""
    said = "" if agrees else "not certainly " if result.verdict is Verdict.INCOMPLETE else "not "
    return [
        f"this page is {said}what the copy {copy.file} prints{beside}",
        *(
            f"line {line.line}: the copy has {line.copy or 'nothing'} | "
            f"the restored listing {line.restored or 'nothing'}"
            for line in copy.changed_lines()
        ),
    ]


def given_apart(given: Mapping[str, str], result: Verification) -> Iterator[str]:
    """Of inputs given separately: those that the page lacks, and how its results compare with them;
    and those that it has otherwise."""
    absent, otherwise = [], []
    for check in result.fields:
        name = scene_name(check.name)
        text, by_page = given.get(name), result.scene.get(name)
        if check.name not in INPUTS or text is None or by_page is None:
            continue
        if check.printed is None:
            absent.append(name)
            continue
        typed, own = (stored_and_printed(each, name in ANGLES) for each in (text, by_page))
        if typed is None or own is None or typed[1] != own[1]:
            otherwise.append(f"{name} {text} (by the page {by_page})")
    if absent:
        compared = [check.same for check in result.fields if check.same is not None]
        agree = f"all {len(compared)} numbers read are what the program prints for them"
        if not compared:
            agree = "no number was read to be compared"
        elif wrong := compared.count(False):
            agree = f"{wrong} of {len(compared)} numbers read are not what it prints for them"
        names = ", ".join(absent)
        yield f"not on the page; taken from the scene given separately: {names}; {agree}"
    if otherwise:
        names = "; ".join(otherwise)
        yield f"given separately and different from the page, which is used: {names}"


# --- as text --------------------------------------------------------------------------------------


def lines(result: Verification, brief: bool = False) -> Iterator[str]:
    """Return the lines that `impact88 verify` prints of one printout, without any character of the
    page that a terminal would obey; ``brief``: only verdict and what differs."""
    return map(printable, _lines(result, brief))


def _lines(result: Verification, brief: bool) -> Iterator[str]:
    where = f"{one_line(display_name(result.file))}, printout {result.number} ({result.where})"
    yield f"{where}: {TITLES[result.verdict]}"
    parts = sections(result)
    doubtful, notes = parts.pop(DOUBTFUL, []), parts.pop(NOTES, [])
    yield from (f"  {line}" for line in [*summary(result), *_some(doubtful, brief)])
    if checks := result.differing if brief else result.fields:
        yield ""
        yield from (f"  {line}" for line in _table(checks, exact=not brief))
    for heading, said in parts.items():
        if not brief or said is not result.warnings:
            yield from ("", f"  {heading}:")
            mark = "" if heading == EXPLAINED else "- "
            yield from (f"  {mark}{line}" for line in said)
    yield from (f"  note: {line}" for line in _some(notes, brief))
    if not brief:
        yield ""


def _some(said: list[str], brief: bool) -> list[str]:
    if not brief or len(said) <= 4:
        return said
    return [*said[:3], f"and {len(said) - 3} more places"]


def _table(checks: Sequence[FieldCheck], exact: bool) -> list[str]:
    rows = [["", "printed", "recomputed", *["exact", "printed-exact"] * exact, ""]]
    for check in checks:
        beside = [check.exact or "", check.difference or ""] * exact
        numbers = [check.printed or "-", check.recomputed or "-"]
        rows.append([check.name, *numbers, *beside, check.mark])
    return table(rows, left=(0, len(rows[0]) - 1))
