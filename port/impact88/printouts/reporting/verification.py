"""Verifications of one printout and of one file, and their wording.

`sections` returns all sentences, whatever the form they are shown in: text, a page, the desk.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ...errors import one_line, printable
from ...files import display_name
from ...layout import table
from ..fields import ANGLES, FIELDS, INPUTS, scene_name
from ..judging.beside import not_verifiable
from ..judging.judgement import FieldCheck, Judged, Status, Verdict
from ..reading.differences import Difference, Kind
from ..reading.numerals import value_of
from ..recovery.replays import run_once
from ..recovery.typedtext import stored_and_printed

if TYPE_CHECKING:
    from ...program.copies import ListingCopy

TITLES = {
    Verdict.IDENTICAL: "IDENTICAL",
    Verdict.IDENTICAL_AS_READ: "IDENTICAL AS FAR AS READ",
    Verdict.DIFFERS: "DIFFERS",
    Verdict.INCOMPLETE: "INCOMPLETE",
}

MEANINGS = {
    Verdict.IDENTICAL: "every number, label and mark is what the 1988 program prints for the "
    "inputs on the page, digit for digit, and nothing else stands between its first and last line "
    "(in a picture: anywhere)",
    Verdict.IDENTICAL_AS_READ: "the numbers, as far as they were read, are the 1988 program's; "
    "every place that was not read exactly and all that the program does not print are listed, to "
    "be looked at there",
    Verdict.DIFFERS: "something on the page is not as the program prints it for the inputs on it",
    Verdict.INCOMPLETE: "numbers are missing or could not be read, and the others do not decide: "
    "what agrees is counted, and what contradicts is named",
}
"""Sentence that explains each verdict."""

DOUBTFUL = "doubtful places"
NOTES = "notes on the reading"
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
        IDENTICAL, IDENTICAL_AS_READ, INCOMPLETE or DIFFERS.
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
    explanations : list
        What would make a differing page agree.
    findings, warnings, remarks : list of str
        Other findings, warnings of the mechanics, and notes on how the page was read.
    left_over : list of Difference
        Text that belongs to no field and no label.
    labels : list of Difference
        Labels, marks and words of the prompts that are not as the program prints them.
    rows : list of str
        The findings and remarks that are said first: on whole rows, exchanged, printed twice, and
        of a picture in another typeface, cut through; and on which number is altered.
    cells, marks : list of dict
        Of a picture, the cells of the printed characters, and all ink in and near the printout that
        the program does not print.
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
    characters : dict of str to int
        Of a text, the numbers of its characters that are ``matched`` (read, and what the program
        prints), ``doubtful`` (stand where it prints a character, and are not read as that one) and
        ``left_over`` (nothing that it prints). Their sum is all that stands on the page but blanks.

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
    explanations: list[Any] = field(default_factory=list)
    findings: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    left_over: list[Difference] = field(default_factory=list)
    labels: list[Difference] = field(default_factory=list)
    rows: list[str] = field(default_factory=list)
    cells: list[dict[str, Any]] = field(default_factory=list)
    marks: list[dict[str, Any]] = field(default_factory=list)
    exhibit: Callable[[], dict[str, Any]] | None = field(default=None, repr=False)
    page: int | None = None
    start: int = 0
    stop: int = 0
    sha256: str | None = None
    copy: dict[str, Any] | None = None
    converted: bool = False
    text: str = field(default="", repr=False)
    characters: dict[str, int] = field(default_factory=dict)

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
        if self.characters:
            described["characters"] = self.characters
        if self.cells:
            described |= {"cells": self.cells, "marks": self.marks}
        return described


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


_IN_JSON = (
    "file",
    "sha256",
    "line",
    "verdict",
    "scene",
    "guessed",
    "fields",
    "replies",
    "ending",
    "missing",
    "not_read",
    "labels",
    "left_over",
    "unseen",
    "explanations",
    "findings",
    "warnings",
    "remarks",
)


def _plain(value: Any) -> Any:
    if isinstance(value, list):
        return list(map(_plain, value))
    if hasattr(value, "as_json"):
        return value.as_json()
    return value._asdict() if isinstance(value, Difference) else value


@dataclass
class Examined:
    """One file: its verifications, or the error that kept it from being read. ``sha256``: hash of
    its bytes."""

    file: str
    sha256: str | None
    results: list[Verification] = field(default_factory=list)
    error: str | None = None

    def as_json(self) -> list[dict[str, Any]]:
        """Return the objects that `impact88 verify --json` prints for the file."""
        if self.error is None:
            return [result.as_json() for result in self.results]
        refused = {"file": self.file, "sha256": self.sha256, "error": self.error}
        return [refused]


# --- in words -------------------------------------------------------------------------------------


def summary(result: Verification) -> list[str]:
    """Return the sentences that support a verdict: on whole rows, counts, and the names of missing
    inputs."""
    verdict, fields, missing = result.verdict, result.fields, result.missing
    sentences = [*_contradicting(result), counts(fields)]
    if verdict is Verdict.IDENTICAL:
        source = f"the copy {result.copy['file']}" if result.copy else "the program"
        sentences = [f"all {len(fields)} printed numbers are what {source} prints, digit for digit"]
    elif verdict is Verdict.DIFFERS:
        compared_count = sum(check.same is not None for check in fields)
        sentences = [*_of_another_copy(result)]
        differing = len(result.differing)
        verb = "differs" if differing == 1 else "differ"
        count = f"{compared_count} printed numbers compared, {differing} {verb}"
        left_out = [check.name for check in fields if check.same is None]
        if 0 < len(left_out) <= MAX_LEFT_OUT:
            count += f"; not compared: {', '.join(left_out)}"
        sentences.append(count)
        replies = sum(check.same is False for check in result.replies)
        if replies:
            noun = "reply at a prompt differs" if replies == 1 else "replies at prompts differ"
            sentences.append(f"{replies} {noun} from the velocities printed")
        if wrong := sum(label.kind is Kind.CONTRADICTS for label in result.labels):
            sentences.append("1 label contradicts" if wrong == 1 else f"{wrong} labels contradict")
        if lines := sum(bool(mark["contradicts"]) for mark in result.marks):
            verb = "1 typed line gives" if lines == 1 else f"{lines} typed lines give"
            sentences.append(f"{verb} numbers that are not the page's")
    elif verdict is Verdict.IDENTICAL_AS_READ:
        if replies := sum(check.same is None for check in result.replies):
            noun = "reply at a prompt is" if replies == 1 else "replies at prompts are"
            sentences.append(f"{replies} {noun} not read exactly")
        sentences.append(MEANINGS[verdict])
        sentences += _foreign_lines(result)
    if verdict in (Verdict.IDENTICAL, Verdict.IDENTICAL_AS_READ):
        if names := not_verifiable(result.unseen):
            sentences.insert(0, f"not verifiable on this page: {names}")
        if result.page is None:
            sentences.append(_extent(result))
    shown = {scene_name(check.name) for check in fields if check.printed}
    for absent, adjective in (
        ([name for name in missing if name not in shown], "missing"),
        ([name for name in missing if name in shown], "not certain as read"),
    ):
        if absent:
            verb, it = ("is", "it") if len(absent) == 1 else ("are", "them")
            sentences.append(
                f"{', '.join(absent)} {verb} {adjective}: what depends on {it} was not compared"
            )
    not_read = [name for name in result.not_read if name not in missing]
    if 0 < len(not_read) < len(fields) and verdict is not Verdict.IDENTICAL_AS_READ:
        sentences.append(f"not read: {', '.join(not_read)}")
    is_explained = missing or not_read or result.page or sentences[0] != counts(fields)
    if verdict is Verdict.INCOMPLETE and not is_explained:
        sentences.append("the results are missing, or the page ends before them")
    ending = result.ending
    if ending is not None and ending.same is not True and (ending.printed or ending.recomputed):
        page_text, program_text = (
            text or "no error" for text in (ending.printed, ending.recomputed)
        )
        recomputed = "nothing could be recomputed" if missing else f"recomputed: {program_text}"
        sentences.append(f"ends with {page_text}, {recomputed}")
    return [*result.rows, *sentences]


def _contradicting(result: Verification) -> Iterator[str]:
    """Yield sentences on the numbers of an incomplete page that show other digits than the program
    prints, and on replies that are not the velocities printed: no verdict is based on them, and
    none may hide them."""
    if result.verdict is not Verdict.INCOMPLETE:
        return
    named = [
        f"{check.name} {check.printed}, the program {check.recomputed}"
        for check in result.fields
        if check.status in (Status.CONTRADICTED, Status.NOT_COMPARED)
        if check.recomputed and check.printed and check.printed != check.recomputed
    ]
    if 0 < len(named) <= MAX_LEFT_OUT:
        verb = "1 number does" if len(named) == 1 else f"{len(named)} numbers do"
        yield f"{verb} not agree with the inputs as read: {'; '.join(named)}"
    yield from _wrong_replies(result)


def _wrong_replies(result: Verification) -> Iterator[str]:
    """Yield a sentence for each reply at a prompt that is not the velocity printed."""
    rows = {check.name: check for check in result.fields}
    for check in result.replies:
        if check.same is False:
            printed = (rows[check.name].printed if check.name in rows else None) or check.recomputed
            yield (
                f"{check.name}: the reply at the prompt is {check.printed}, and the row of "
                f"velocities has {printed}"
            )


def _foreign_lines(result: Verification) -> Iterator[str]:
    """Yield a sentence on the number of typed lines that the program does not print."""
    lines = {str(piece.line) for piece in _of_kind(result.left_over, Kind.FOREIGN_LINE)}
    lines |= {str(mark["line"] or mark["box"]) for mark in result.marks if mark["kind"] == "type"}
    if lines:
        count = (
            "1 line on the page is" if len(lines) == 1 else f"{len(lines)} lines on the page are"
        )
        yield f"{count} not the program's: see below"


def counts(fields: Sequence[FieldCheck]) -> str:
    """Return the numbers of fields read exactly, doubtful, contradicted and not read, in words."""
    number = Counter(check.status for check in fields)
    words = {
        Status.DOUBTFUL: "read doubtfully",
        Status.CONTRADICTED: "differs" if number[Status.CONTRADICTED] == 1 else "differ",
        Status.NOT_READ: "not read",
        Status.NOT_COMPARED: "not compared",
    }
    exact = f"{number[Status.READ]} of {len(fields)} printed numbers read exactly and as the "
    other_counts = [f"{number[status]} {word}" for status, word in words.items() if number[status]]
    return ", ".join([exact + "program prints them", *other_counts])


def sections(result: Verification) -> dict[str, list[str]]:
    """Return the headings below the verdict, in order, with their lines, for any form of output. A
    line that begins with blanks belongs to the one above it."""
    doubtful = [*_labels(result.labels), *_doubtful_cells(result.cells)]
    unread = [check for check in result.replies if check.status is Status.NOT_READ]
    for check in [*result.fields, *result.replies]:
        if check.status is Status.DOUBTFUL or check in unread:
            doubtful += _doubts(check)
            suffix = f" ({check.name}: the program prints {check.recomputed})"
            doubtful += [place + suffix for place in look(check)]
    notes = [*_wrong_replies(result)] if result.verdict is not Verdict.INCOMPLETE else []
    remarks = [remark for remark in result.remarks if remark not in result.rows]
    entries_by_heading = {
        DOUBTFUL: doubtful,
        MARKS: list(_marks(result.marks)),
        EXPLAINED: _explanation_lines(result),
        "Other findings": [entry for entry in result.findings if entry not in result.rows],
        "Errors this page could not reveal": result.unseen,
        "beside the verdict": result.warnings,
        NOTES: [*notes, *remarks, *_left_over(result.left_over)],
    }
    return {heading: entries for heading, entries in entries_by_heading.items() if entries}


def _doubtful_cells(cells: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """Yield a sentence for each cell of a picture that is in doubt."""
    for cell in cells:
        if cell["state"] == "doubtful":
            place = f"line {cell['line']}, column {cell['column']}"
            yield f"{place}: {name_of(cell['field'])} {cell['appearance']}"


def name_of(field: str | None) -> str:
    """Return the name of a picture's number, reply or label."""
    if field and field.startswith("REPLY"):
        return f"the reply for vehicle {field[-1]}"
    return field or "a label"


_MARK_WORDS = {
    "character": "{reads!r} typed where the program prints a blank",
    "type": "typed text that the program does not print: {reads!r}",
    "mark": "a mark like no character of the page",
    "stroke": "ink larger than a character: pen, stamp or stain",
    "coloured ink": "ink of another colour than the page's type",
}


def _marks(marks: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """Yield a sentence for each mark that the program does not print."""
    for mark in marks:
        x, y, _, _ = mark["box"]
        place = f"line {mark['line']}, column {mark['cell']}" if mark["line"] else ""
        place = place or f"{x:.0f} pixels from the left, {y:.0f} from the top"
        sentence = f"{place}: {_MARK_WORDS[mark['kind']].format(**mark)}"
        is_in_margin = mark["beside"] and not mark["line"] and not mark["touches"]
        sentence += ", in or beside a line of the printout" if is_in_margin else ""
        if mark["touches"] and mark["kind"] != "type":
            verb = "beside" if mark["kind"] == "character" else "touches"
            sentence += f"; {verb} {', '.join(map(name_of, mark['touches']))}"
        yield sentence


_DOUBTS = {
    Kind.LOOK_ALIKE: "read {read!r} where the program prints {printed!r} ({program})",
    Kind.ILLEGIBLE: "illegible (read {read!r}) where the program prints {printed!r} ({program})",
    Kind.BLANK: "a blank or a joint in it; the program prints {program}",
    Kind.OTHER_FORM: "read {whole}; the program prints {program}, never this form",
    Kind.CUT: "cut off; the program prints {program}",
    Kind.LEFT_OVER: "{read!r} left over beside {program}",
}


def _doubts(check: FieldCheck) -> Iterator[str]:
    for doubt in check.doubts:
        if doubt.kind in _DOUBTS:
            words = {**doubt._asdict(), "program": check.recomputed or "", "whole": check.printed}
            sentence = _DOUBTS[doubt.kind].format(**words)
            if doubt.kind is Kind.ILLEGIBLE and not doubt.read:
                sentence = "not read where the program prints {printed!r} ({program})".format(
                    **words
                )
            yield f"line {doubt.line}, column {doubt.column}: {check.name} {sentence}"


def look(check: FieldCheck) -> list[str]:
    """Return the places to look at on the paper for a misread digit."""
    return [doubt.question for doubt in _of_kind(check.doubts, Kind.CONTRADICTS)]


def _labels(differences: Sequence[Difference]) -> Iterator[str]:
    """Yield sentences on the labels and marks that are not the program's, contradictory labels
    first, and then marks after labels."""
    bearing = [one for one in differences if one.bears]
    labels = [one for one in bearing if not one.is_mark]
    marks = [one for one in bearing if one.is_mark]
    for kind, words in (
        (Kind.CONTRADICTS, "labelled {0.read} where the program prints {0.printed}"),
        (Kind.LOOK_ALIKE, "the label {0.printed} is read {0.read}"),
    ):
        for label in _of_kind(labels, kind):
            yield f"line {label.line}: {printable(words.format(label))}"
    for line, missing in _by_line(_of_kind(labels, Kind.MISSING)).items():
        nouns = "label before the number" if len(missing) == 1 else "labels before the numbers"
        names = ", ".join(label.printed for label in missing)
        yield f"line {line}: no {nouns} where the program prints {names}"
    if lost := _of_kind(marks, Kind.MISSING):
        by_line = [
            f"line {line}: no {', '.join(map(_of_number, missing))}"
            for line, missing in _by_line(lost).items()
        ]
        it = "it" if len(lost) == 1 else "them"
        yield f"{'; '.join(by_line)}, where the program prints {it}"
    if others := _of_kind(marks, Kind.LOOK_ALIKE):
        yield "; ".join(
            f"line {mark.line}: {mark.read!r} where the program prints {_of_number(mark)}"
            for mark in others
        )
    for mark in _of_kind(marks, Kind.MOVED):
        yield f"line {mark.line}: {_of_number(mark)} stands on another line than its number"


def _of_kind(differences: Sequence[Difference], kind: Kind) -> list[Difference]:
    return [one for one in differences if one.kind is kind]


def _by_line(differences: Sequence[Difference]) -> dict[int, list[Difference]]:
    by_line: dict[int, list[Difference]] = {}
    for one in differences:
        by_line.setdefault(one.line, []).append(one)
    return by_line


def _of_number(mark: Difference) -> str:
    if mark.printed.startswith("*"):
        return f"row of asterisks beside {mark.name}"
    return f"{mark.printed!r} of {mark.name if mark.name in FIELDS else 'the prompt'}"


MAX_LEFT_OUT = 6  # numbers that were not compared, named in one line
MAX_FOREIGN_LINES = 12  # lines listed that do not belong to the program's page


def _left_over(pieces: Sequence[Difference]) -> Iterator[str]:
    """Yield a sentence for each text that belongs to no number and no label, whole lines last."""
    for piece in _of_kind(pieces, Kind.LEFT_OVER):
        text = piece.read if len(piece.read) <= 40 else piece.read[:37] + "..."
        beside = " beside a number" * bool(piece.name)
        yield f"line {piece.line}, column {piece.column}: {text!r} left over{beside}"
    lines = sorted(_of_kind(pieces, Kind.FOREIGN_LINE), key=lambda piece: not piece.bears)
    for piece in sorted(lines[:MAX_FOREIGN_LINES], key=lambda piece: piece.line):
        yield f"line {piece.line} does not belong to the program's page: {printable(piece.read)}"
    if len(lines) > MAX_FOREIGN_LINES:
        count = len(lines) - MAX_FOREIGN_LINES
        yield f"and {count} more lines that do not belong to the program's page"


def _explanation_lines(result: Verification) -> list[str]:
    """Return the explanations, best first, and the places to look at on the paper; empty for a
    picture, whose cells show the differences."""
    if result.verdict is not Verdict.DIFFERS or result.page is not None:
        return []
    entries: list[str] = []
    last_rank = 0
    for cause in result.explanations:
        if cause.rank != last_rank:
            share = (
                "all that differs" if not cause.left else f"{cause.explains} of {cause.differing}"
            )
            entries.append(f"{cause.rank}. {cause}; explains {share}")
        else:
            entries.append(f"   or, equally well on this page: {cause}")
        last_rank = cause.rank
        entries += [f"   look at {place}" for place in cause.look[:4]]
    return entries or [*_typed_in(result)] or ["no single slip explains this"]


def _typed_in(result: Verification) -> Iterator[str]:
    """Yield a sentence for each number that has digits after a blank, or that is no number, if
    nothing else differs."""
    added = []
    for check in result.differing:
        number, blank, digits = (check.printed or "").partition(" ")
        if blank and number == check.recomputed and digits.isdigit():
            noun = f"a digit {digits} stands" if len(digits) == 1 else f"digits {digits} stand"
            added.append(f"{noun} after {check.name} {number}, behind a blank")
        elif check.printed and check.recomputed and value_of(check.printed) is None:
            program = f"the program prints {check.recomputed}"
            added.append(f"{check.name} {check.printed} is not a number: {program}")
        else:
            return
    yield from added


def _extent(result: Verification) -> str:
    """Return one sentence on the extent of the examination of a text."""
    replies = len(result.replies)
    examined = f"{len(result.fields)} numbers and their labels"
    if replies:
        examined += f", {replies} replies at the prompts"
    remainder = "nothing else stands on the page"
    if result.left_over or result.characters.get("left_over"):
        remainder = "what else stands on the page is listed below"
    elif result.characters.get("doubtful") or any(label.bears for label in result.labels):
        remainder = "what is not read as the program prints it is listed below"
    return f"examined: {examined}; {remainder}"


def _of_another_copy(result: Verification) -> Iterator[str]:
    """Yield sentences on another copy of the listing that may have printed a page on which every
    number agrees and only replies or labels are not the listing's."""
    if result.differing or result.copy or result.page is not None or not result.complete_scene:
        return
    wrong_replies = [check for check in result.replies if check.same is False]
    labels = [label for label in result.labels if label.kind is Kind.CONTRADICTS]
    if not wrong_replies and not labels:
        return
    finding = "the replies at the prompts do not agree with the rows of velocities"
    if len(wrong_replies) == 1:
        finding = "the reply at the prompt and the row of velocities do not agree"
    if not wrong_replies:
        finding = "its labels are not the listing's"
    ratios = [_ratio(check) for check in wrong_replies]
    if (
        len(wrong_replies) > 1
        and all(ratios)
        and max(ratios) - min(ratios) <= 1e-3 * abs(max(ratios))
    ):
        finding += f" (each velocity printed is {ratios[0]:.6g} times the reply)"
    yield f"the numbers agree with each other, but {finding}"
    yield (
        "another copy of the listing may have printed this page: if so, verify it with "
        "--listing COPY"
    )


def _ratio(check: FieldCheck) -> float:
    velocity, reply = value_of(check.recomputed or ""), value_of(check.printed or "")
    return float(velocity / reply) if velocity and reply else 0.0


# --- other findings -----------------------------------------------------------------------------


def findings(found: Judged) -> Iterator[str]:
    """Yield forms that the program never prints, and the M that a page without final spins is read
    as."""
    scene = found.recovered
    other_forms = [
        check.name
        for check in found.fields
        if any(doubt.kind is Kind.OTHER_FORM for doubt in check.doubts)
    ]
    if other_forms:
        yield (
            f"{', '.join(other_forms)} in a form Applesoft never prints (a zero before the "
            "point or at the end, a plus sign): retyped, or made by another program"
        )
    regions = [reading.region[:-1] for reading in found.paper.fields.values()]
    text = "".join(glyph.char for region in regions for glyph in region)
    if text.count(",") >= 3 and "." not in text:
        yield "decimal commas throughout: retyped, or made by another program"
    m = scene.scene["M"]
    if scene.outcome.ending or found.paper.ending or found.paper.fragment_of_run:
        return  # there are no results of one M or the other
    if scene.m_unknown and not scene.missing:
        yield (
            f"no line of final spins: read as M = {m}; with M = {'6' if m == '4' else '4'} the "
            "program prints the same numbers but for that line"
        )
    elif m == "4" and "M" not in scene.missing and not found.paper.has_final_spins:
        yield "no line of final spins: the results are those of M = 4, not of M = 6"


_MISREADINGS = (Kind.LOOK_ALIKE, Kind.ILLEGIBLE, Kind.CONTRADICTS)


def attributed_digits(found: Judged) -> Iterator[str]:
    """Report digits attributed to misreading by the page's reader."""
    misread_digits = [
        f"{check.name} ({read} for {program_digit})"
        for check in [*found.fields, *found.replies]
        for program_digit, read in check.swapped()
    ]
    misread_count = sum(
        any(doubt.kind in _MISREADINGS and doubt.read != doubt.printed for doubt in check.doubts)
        for check in found.fields
    )
    if misread_digits:
        yield (
            "read as another digit than the program prints: "
            f"{', '.join(misread_digits)}; attributed to the reader of the page, who misread "
            f"{misread_count} of {len(found.fields)} numbers: if the paper shows one of these "
            "digits as it was read, it differs from the program's page"
        )


def copy_findings(copy: ListingCopy, result: Verification) -> list[str]:
    """Return sentences on an office's copy of the listing: results that differ from the restored
    listing's, and the changed lines."""
    scene = result.complete_scene
    restored_fields = run_once(scene).fields if scene else {}
    agrees = result.verdict in (Verdict.IDENTICAL, Verdict.IDENTICAL_AS_READ)
    differences = ", ".join(
        f"{check.name} {restored_fields.get(check.name, 'nothing')}"
        for check in result.fields
        if check.recomputed != restored_fields.get(check.name)
    )
    comparison = (
        f"; the restored listing prints {differences or 'the same numbers'}" if scene else ""
    )
    negation = (
        "" if agrees else "not certainly " if result.verdict is Verdict.INCOMPLETE else "not "
    )
    return [
        f"this page is {negation}what the copy {copy.file} prints{comparison}",
        *(
            f"line {line.line}: the copy has {line.copy or 'nothing'} | "
            f"the restored listing {line.restored or 'nothing'}"
            for line in copy.changed_lines()
        ),
    ]


def given_findings(given: Mapping[str, str], result: Verification) -> Iterator[str]:
    """Yield findings on inputs given separately: those that the page lacks, with the agreement of
    its results; and those that differ from the page."""
    absent, otherwise = [], []
    for check in result.fields:
        name = scene_name(check.name)
        text, by_page = given.get(name), result.scene.get(name)
        if check.name not in INPUTS or text is None or by_page is None:
            continue
        if check.printed is None:
            absent.append(name)
            continue
        given_forms, page_forms = (
            stored_and_printed(value, name in ANGLES) for value in (text, by_page)
        )
        if given_forms is None or page_forms is None or given_forms[1] != page_forms[1]:
            otherwise.append(f"{name} {text} (by the page {by_page})")
    if absent:
        comparisons = [check.same for check in result.fields if check.same is not None]
        agree = f"all {len(comparisons)} numbers read are what the program prints for them"
        if not comparisons:
            agree = "no number was read to be compared"
        elif wrong := comparisons.count(False):
            agree = f"{wrong} of {len(comparisons)} numbers read are not what it prints for them"
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
    heading_line = (
        f"{one_line(display_name(result.file))}, printout {result.number} ({result.where})"
    )
    yield f"{heading_line}: {TITLES[result.verdict]}"
    parts = sections(result)
    doubtful, notes = parts.pop(DOUBTFUL, []), parts.pop(NOTES, [])
    yield from (f"  {line}" for line in [*summary(result), *_first_lines(doubtful, brief)])
    checks = result.differing if brief else result.fields
    if any(check.printed or check.recomputed for check in checks):
        yield ""
        yield from (f"  {line}" for line in _table(checks, exact=not brief))
    for heading, entries in parts.items():
        if not brief or entries is not result.warnings:
            yield from ("", f"  {heading}:")
            mark = "" if heading == EXPLAINED else "- "
            yield from (f"  {mark}{line}" for line in entries)
    yield from (f"  note: {line}" for line in _first_lines(notes, brief))
    if not brief:
        yield ""


def _first_lines(said: list[str], brief: bool) -> list[str]:
    if not brief or len(said) <= 4:
        return said
    return [*said[:3], f"and {len(said) - 3} more places"]


def _table(checks: Sequence[FieldCheck], exact: bool) -> list[str]:
    rows = [["", "printed", "recomputed", *["exact", "printed-exact"] * exact, ""]]
    for check in checks:
        exact_cells = [check.exact or "", check.difference or ""] * exact
        numbers = [check.printed or "-", check.recomputed or "-"]
        rows.append([check.name, *numbers, *exact_cells, check.mark])
    return table(rows, left=(0, len(rows[0]) - 1))
