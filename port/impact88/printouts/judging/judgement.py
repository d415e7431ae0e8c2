"""Judgement of all that is on the paper by the program's page for the recovered scene.

Each number is read exactly, doubtful (look-alikes, illegible or stray glyphs, but what the program
prints fits them), contradicted (cleanly read, and not what the program prints) or not read. The
verdict follows from these; from the replies, the ending, the labels and marks, the order of rows
and the text left over; from what is missing of the page; and from how badly it was read.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from itertools import groupby
from typing import Any

from ..fields import ANGLES, FIELDS, FINAL_SPINS, REPLIES
from ..reading.alignment import BEHIND
from ..reading.differences import Difference, Kind, difference_at, differences_along
from ..reading.glyphs import ILLEGIBLE
from ..reading.numerals import SPECKS, compare
from ..reading.printout import Printout, Reading, reading_of
from ..recovery.recovered import Recovered, reply_candidates, without_mark
from ..recovery.typedtext import stored_and_printed


class Verdict(StrEnum):
    """Verdict on a printout.

    IDENTICAL: every number was read exactly, and is what the program prints. IDENTICAL_AS_READ: so
    are all numbers as far as they could be read. DIFFERS: a number is cleanly read and is not what
    the program prints. INCOMPLETE: too little could be read to decide.
    """

    IDENTICAL = "identical"
    IDENTICAL_AS_READ = "identical_as_read"
    DIFFERS = "differs"
    INCOMPLETE = "incomplete"


class Status(StrEnum):
    """Result of comparing one number."""

    READ = "read"
    DOUBTFUL = "doubtful"
    CONTRADICTED = "contradicted"
    NOT_READ = "not read"
    NOT_COMPARED = "not compared"


@dataclass
class FieldCheck:
    """One printed number compared with the program's.

    Parameters
    ----------
    name : str
        Name of the field.
    printed : str, optional
        The number as read, None if it was not read.
    recomputed : str, optional
        The number that the program prints, None if it prints none.
    status : Status
        READ, DOUBTFUL, CONTRADICTED, NOT_READ or NOT_COMPARED.
    exact, difference : str, optional
        The number in exact arithmetic, and the printed number less that.
    line, column, start, stop : int, optional
        Its place in the text: line and column from 1, and offsets.
    doubts : list of Difference
        The places at which it was not read as the program prints it.
    """

    name: str
    printed: str | None
    recomputed: str | None
    status: Status = Status.NOT_COMPARED
    exact: str | None = None
    difference: str | None = None
    line: int | None = None
    column: int | None = None
    start: int | None = None
    stop: int | None = None
    doubts: list[Difference] = field(default_factory=list)

    @property
    def same(self) -> bool | None:
        """True if read exactly, False if contradicted, None otherwise."""
        return {Status.READ: True, Status.CONTRADICTED: False}.get(self.status)

    @property
    def mark(self) -> str:
        """The word printed beside the number, empty if it was read exactly."""
        return {Status.READ: "", Status.CONTRADICTED: "differs"}.get(self.status, self.status)

    def as_json(self) -> dict[str, Any]:
        """Return the object that ``impact88 verify --json`` prints for a number.

        Returns
        -------
        dict of str to object
            The check as JSON types.
        """
        doubts = [doubt._asdict() for doubt in self.doubts]
        return {**vars(self), "same": self.same, "status": str(self.status), "doubts": doubts}

    def swapped(self) -> list[tuple[str, str]]:
        """Return the digits that were cleanly read as other digits.

        Returns
        -------
        list of tuple of str
            For each, the digit that the program prints and the digit read.
        """
        return [
            (doubt.printed, doubt.read)
            for doubt in self.doubts
            if doubt.kind is Kind.CONTRADICTS and doubt.read.isdigit() and doubt.printed.isdigit()
        ]


@dataclass
class Judged:
    """A printout compared with the page of the recovered scene: every number, the replies, the
    ending, and the verdict. ``notes``: text in a number's place that is not compared; ``account``:
    by the offset of every character that the printout accounts for, the difference that it belongs
    to, None for one that is as printed."""

    paper: Printout
    recovered: Recovered
    fields: list[FieldCheck]
    replies: list[FieldCheck]
    ending: FieldCheck
    verdict: Verdict
    notes: list[Difference] = field(default_factory=list)
    account: dict[int, Difference | None] = field(default_factory=dict)

    def characters(self) -> dict[str, int]:
        """Return the numbers of characters that are matched (as the program prints them there),
        doubtful (readings of what it prints there) and left over; markup is left over."""
        counts = {"matched": 0, "doubtful": 0, "left_over": self.paper.markup}
        for one in self.account.values():
            is_reading = one is not None and (one.printed or one.kind is Kind.ILLEGIBLE)
            counts["matched" if one is None else "doubtful" if is_reading else "left_over"] += 1
        return counts

    @property
    def contradicted(self) -> list[FieldCheck]:
        """The numbers and the ending that are not what the program prints."""
        all_checks = [*self.fields, *self.replies, self.ending]
        return [check for check in all_checks if check.status == Status.CONTRADICTED]


def judge(paper: Printout, recovered: Recovered, others: Sequence[FieldCheck] = ()) -> Judged:
    """Compare a printout with the recovered scene's page. ``others``: replies compared
    elsewhere."""
    replies = [_reply(paper, recovered, name, reading) for name, reading in paper.replies.items()]
    checks = _fields(paper, recovered)
    if all(check.status != Status.CONTRADICTED for check in checks):
        _doubt_damaged_replies(paper, replies)
    ending = _ending(paper, recovered)
    notes = [*_not_compared(paper, [*checks, *replies])]
    account = _account(paper, [*checks, *replies], notes)
    judgement = Judged(
        paper, recovered, checks, [*replies, *others], ending, Verdict.IDENTICAL, notes, account
    )
    judgement.verdict = _verdict(judgement)
    return judgement


def _verdict(found: Judged) -> Verdict:
    paper, missing = found.paper, found.recovered.missing
    if found.contradicted or paper.is_of_another_form:
        return Verdict.DIFFERS if is_alteration(found) else Verdict.INCOMPLETE
    unread = any(check.status in (Status.NOT_READ, Status.NOT_COMPARED) for check in found.fields)
    if unread or found.ending.same is None or missing or paper.fragment_of_run or paper.unread:
        return Verdict.INCOMPLETE
    doubtful = any(check.status != Status.READ for check in [*found.fields, *found.replies])
    extra_text = any(piece.bears for piece in paper.left_over) or bool(found.notes or paper.remarks)
    if doubtful or extra_text or any(label.bears for label in paper.labels):
        return Verdict.IDENTICAL_AS_READ
    return Verdict.IDENTICAL


MOST_ALTERED = 2
"""Changes up to which an explanation counts as an alteration, on a machine-read page: it holds for
28 of 28 readings of test pages with one altered digit; 10 of 17 genuine ones that differed have no
such explanation."""


def is_alteration(found: Judged, changes: Sequence[int] = (0,)) -> bool:
    """Return True if differences that are not attributed to the reader are the paper's own.

    They are on a page that no machine read, or whose form contradicts. On others they are unless
    too much was misread or is missing, or the likeliest explanation is more than a change or two.
    ``changes``: number of changes of each explanation, the likeliest first. Before there are any,
    the answer is provisional: DIFFERS has its differences explained, and is then asked again.
    """
    paper = found.paper
    if not paper.machine_read or paper.is_of_another_form:
        return True
    is_decided = not (paper.badly_read or found.recovered.missing)
    return is_decided and any(count <= MOST_ALTERED for count in changes[:1])


def _account(
    paper: Printout, checks: Sequence[FieldCheck], notes: Sequence[Difference]
) -> dict[int, Difference | None]:
    """Return the difference that each character of a printout belongs to, by its offset."""
    account: dict[int, Difference | None] = {
        paper.page.glyphs[index].offset: None for index in paper.own
    }
    differences = [*paper.misread(), *paper.left_over, *notes]
    for check in checks:
        if check.start is not None and check.stop is not None and check.same is not True:
            span, printed = (check.start, check.stop), check.recomputed or ""
            whole = difference_at(paper.page, Kind.ILLEGIBLE, check.name, printed, span)
            differences += check.doubts or [whole]
    for one in differences:
        for at in range(one.start, one.stop):
            if at in account and at not in paper.echoed:
                account[at] = one
    return account


def _not_compared(paper: Printout, checks: Sequence[FieldCheck]) -> Iterator[Difference]:
    """Yield what stands in a number's place and is in none of the numbers compared, such as a reply
    before the one that counts."""
    spans = [(check.start or 0, check.stop or 0) for check in checks]
    spans += [(one.start, one.stop) for one in paper.left_over]
    known = paper.echoed | {at for span in spans for at in range(*span)}
    roles, glyphs = paper.roles(), paper.page.glyphs
    loose = [
        index
        for index in paper.own
        if roles.get(index) == "number" and glyphs[index].offset not in known
    ]
    for _, pairs in groupby(enumerate(loose), lambda pair: pair[1] - pair[0]):
        run = [index for _, index in pairs]
        yield difference_at(
            paper.page, Kind.LEFT_OVER, "", "", paper.page.span(run[0], run[-1] + 1)
        )


# --- numbers -------------------------------------------------------------------------------------


def _fields(paper: Printout, recovered: Recovered) -> list[FieldCheck]:
    """Return a check of every field that is printed or should be, in the order of the printout."""
    checks = []
    angles = [text for name in ANGLES if (text := recovered.outcome.fields.get(name))]
    row = paper.angle_regions(angles) if len(angles) == len(ANGLES) else {}
    for name in FIELDS:
        text = recovered.outcome.fields.get(name)
        reading = reading_of(paper.page, row[name]) if name in row else paper.fields.get(name)
        if reading is None and text is None:
            depends_on_missing = recovered.missing and not paper.ending
            if not depends_on_missing or (name in FINAL_SPINS and recovered.scene["M"] != "6"):
                continue
        check = _check(name, reading, text)
        if reading is None:
            check.status = Status.NOT_READ
        elif text is not None:
            is_cut = reading.cut or _is_cut(paper, name, reading)
            path = compare(reading.region, text, is_cut, reading.sign_free).path
            check.doubts = [*differences_along(paper.page, name, reading.region, text, path)]
            if not paper.machine_read:
                check.doubts = _as_typed(check.doubts, reading)
            if name in row and name != ANGLES[0] and not reading.region[0].gap:
                joint = difference_at(paper.page, Kind.BLANK, name, "", (reading.start,) * 2, "")
                check.doubts.insert(0, joint)
            check.status = status_of(check.doubts, text)
            if check.status is Status.READ:
                check.printed = text
            elif check.printed == text or not reading.clean:
                check.printed = _paper_text(paper, reading)
        elif not recovered.missing:
            check.status = Status.CONTRADICTED
        checks.append(check)
    return checks


def _is_cut(paper: Printout, name: str, reading: Reading) -> bool:
    """Return True for a number at a line's end that lacks the mark that the program prints behind
    it, too."""
    ends_line = not paper.page.text[reading.region[-1].offset + 1 :].partition("\n")[0].strip()
    return ends_line and any(
        mark.name == name and mark.kind is Kind.MISSING and mark.printed in BEHIND
        for mark in paper.labels
    )


def _as_typed(differences: Sequence[Difference], reading: Reading) -> list[Difference]:
    """Return a number's differences as they count on a page that no machine read: a character of
    the keyboard that nobody takes for the printed one, or that stands within the number,
    contradicts. A look-alike and a speck remain doubts, and so does what stands beside the number,
    and all of one that has marks for what could not be read."""
    if any(difference.read == ILLEGIBLE for difference in differences):
        return [*differences]
    spans = [range(difference.start, difference.stop) for difference in differences]
    offsets = [glyph.offset for glyph in reading.region]
    as_printed = [at for at in offsets if not any(at in span for span in spans)] or [0]

    def is_typed(difference: Difference) -> bool:
        char = difference.read
        if not (char.isascii() and char.isprintable()) or char in SPECKS:
            return False
        is_within = as_printed[0] < difference.start < as_printed[-1]
        is_added = difference.kind is Kind.LEFT_OVER and is_within
        return is_added or difference.kind is Kind.ILLEGIBLE

    return [
        difference._replace(kind=Kind.CONTRADICTS) if is_typed(difference) else difference
        for difference in differences
    ]


MAX_SHOWN = 30  # characters shown of the text in a number's place


def _paper_text(paper: Printout, reading: Reading) -> str:
    """Return the text in a number's place, as it stands on the paper."""
    end = reading.region[-1].offset + 1
    text = " ".join(paper.page.text[reading.start : end].split())
    return text if len(text) <= MAX_SHOWN else text[: MAX_SHOWN - 3] + "..."


def _check(name: str, reading: Reading | None, text: str | None) -> FieldCheck:
    check = FieldCheck(name, reading.text if reading else None, text)
    if reading:
        check.line, check.column = reading.line, reading.column
        check.start, check.stop = reading.start, reading.stop
    return check


def status_of(differences: Sequence[Difference], text: str | None = None) -> Status:
    """Return the status of a number from its differences from the text that the program prints;
    None for a picture's, each cell of which is decided by itself."""
    if not differences:
        return Status.READ
    kinds = {one.kind for one in differences}
    contradicts = Kind.CONTRADICTS in kinds
    if Kind.CUT in kinds and not contradicts:
        return Status.NOT_READ
    read = "".join(one.read for one in differences)
    foreign = any(not char.isdigit() and char not in "-.+" for char in read)
    if text is not None and (foreign or not contradicts) and _hardly_read(differences, text):
        return Status.NOT_READ
    return Status.CONTRADICTED if contradicts else Status.DOUBTFUL


LEAST_READ = 0.5
"""Share of a number's characters, look-alikes as halves, below which the number is not read."""


def _hardly_read(differences: Sequence[Difference], text: str) -> bool:
    """Return True if fewer than `LEAST_READ` of a number's characters were read."""
    if any(one.kind is Kind.OTHER_FORM for one in differences):
        return False
    exact = len(text) - sum(len(one.printed) for one in differences if one.kind is not Kind.BLANK)
    alike = sum(one.kind in (Kind.LOOK_ALIKE, Kind.BLANK) for one in differences)
    if not exact and not alike:
        return True
    return len(text) > 2 and exact + alike / 2 < LEAST_READ * len(text)


# --- replies, and the ending ---------------------------------------------------------------------


def _reply(paper: Printout, recovered: Recovered, name: str, reading: Reading) -> FieldCheck:
    """Compare a reply at a prompt with the scene's velocity, by value; then with its text as typed
    or as printed, with or without the first glyph, whichever matches best."""
    value = recovered.typed.get(name, recovered.scene[name])
    if name in recovered.missing:
        return _check(name, reading, None)
    check = _check(name, reading, value)
    if reading.clean and same_value(reading.text, value):
        check.status = Status.READ
        return check
    stored = stored_and_printed(value)
    texts = sorted({value, stored[1]} if stored else {value})
    parts = filter(None, (reading, without_mark(reading)))
    matches = [(part, text, compare(part.region, text)) for part in parts for text in texts]
    part, text, match = min(matches, key=lambda found: found[2].cost)
    differences = [*differences_along(paper.page, name, part.region, text, match.path)]
    if not paper.machine_read:
        differences = _as_typed(differences, part)
    check.status, kind = Status.NOT_READ, Kind.ILLEGIBLE
    if any(same_value(text, value) for text, _, _ in reply_candidates(reading)):
        check.status, kind = Status.DOUBTFUL, Kind.LOOK_ALIKE
    elif reading.clean or status_of(differences, text) is Status.CONTRADICTED:
        check.status, check.doubts = Status.CONTRADICTED, differences
        return check
    span = reading.start, reading.stop
    read = reading.text if reading.text != value else _paper_text(paper, reading)
    check.doubts = [difference_at(paper.page, kind, name, value, span, read)]
    return check


def _doubt_damaged_replies(paper: Printout, replies: Sequence[FieldCheck]) -> None:
    """Doubt the replies at a prompt that was itself misread, its letters or its question mark,
    where every printed number is the program's: the reader damaged that line."""
    misread = {
        one.name for one in [*paper.labels, *paper.misread()] if any(map(str.isalpha, one.printed))
    }
    by_name = {check.name: check for check in replies}
    for side, names in REPLIES.items():
        side_checks = [by_name[name] for name in names if name in by_name]
        mark = (
            side_checks
            and side_checks[0].name == names[0]
            and side_checks[0].status is Status.DOUBTFUL
        )
        mark = mark or names[0] in paper.misread_prompts
        for check in side_checks if mark or f"REPLY_{side}" in misread else ():
            if check.status is Status.CONTRADICTED:
                check.status = Status.DOUBTFUL
                span = check.start or 0, check.stop or 0
                texts = check.recomputed or "", span, check.printed or ""
                check.doubts = [difference_at(paper.page, Kind.LOOK_ALIKE, check.name, *texts)]


def same_value(text: str, other: str) -> bool:
    """Return True if two typed texts are stored as the same number."""
    first, second = stored_and_printed(text), stored_and_printed(other)
    return first is not None and second is not None and first[0] == second[0]


def _ending(paper: Printout, recovered: Recovered) -> FieldCheck:
    """Compare the printout's ending with the replay's; one that is cut off shows no message."""
    recomputed = recovered.outcome.ending
    unsure = recovered.missing or paper.ending is None
    status = Status.NOT_COMPARED if unsure else Status.CONTRADICTED
    status = Status.READ if paper.ending == recomputed else status
    return FieldCheck("ENDING", paper.ending, recomputed, status)
