"""Judgement of every number on the paper by the program's page for the recovered scene.

Each number is read exactly, doubtful (look-alikes, illegible or stray glyphs, but what the program
prints fits them), contradicted (cleanly read, and not what the program prints) or not read. The
verdict follows from these alone.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from itertools import groupby
from typing import Any, NamedTuple

from ...collision.fields import ANGLES, FIELDS, FINAL_SPINS, REPLIES
from ..reading.fieldlabels import LabelState
from ..reading.glyphs import Region
from ..reading.numerals import LONGEST, Doubt, Match, Spot, compare, cut_as, note_start
from ..reading.printout import Piece, Printout, Reading, reading_of
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


class Doubtful(NamedTuple):
    """One place where the paper was not read as the program prints it.

    Parameters
    ----------
    line, column, start : int
        Line and column from 1, and the offset in the text.
    read, printed : str
        What was read and what the program prints; either may be empty.
    how : str
        Kind of the difference (`numerals.Doubt`).
    """

    line: int
    column: int
    start: int
    read: str
    printed: str
    how: str


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
    doubts : list of Doubtful
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
    doubts: list[Doubtful] = field(default_factory=list)

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
            if doubt.how == Doubt.CONTRADICTS and doubt.read.isdigit() and doubt.printed.isdigit()
        ]


class Standing(StrEnum):
    """What a character of the page is: as the program prints it there, a reading of what it prints
    there, or nothing that it prints."""

    MATCHED = "matched"
    DOUBTFUL = "doubtful"
    LEFT_OVER = "left over"


Standings = dict[int, Standing]
"""Standing of characters, by their offset in the text."""


@dataclass
class Judged:
    """A printout compared with the page of the recovered scene: every number, the replies, the
    ending, and the verdict. ``notes``: text typed beside a number that was read exactly;
    ``standings``: of every character that the printout accounts for."""

    paper: Printout
    recovered: Recovered
    fields: list[FieldCheck]
    replies: list[FieldCheck]
    ending: FieldCheck
    verdict: Verdict
    notes: list[Piece] = field(default_factory=list)
    standings: Standings = field(default_factory=dict)

    def characters(self) -> dict[str, int]:
        """Return the numbers of characters by standing; markup is left over."""
        counts = Counter(self.standings.values())
        counts[Standing.LEFT_OVER] += self.paper.markup
        return {standing.name.lower(): counts[standing] for standing in Standing}

    @property
    def contradicted(self) -> list[FieldCheck]:
        """The numbers and the ending that are not what the program prints."""
        all_checks = [*self.fields, *self.replies, self.ending]
        return [check for check in all_checks if check.status == Status.CONTRADICTED]


def judge(paper: Printout, recovered: Recovered, others: Sequence[FieldCheck] = ()) -> Judged:
    """Compare a printout with the recovered scene's page. ``others``: replies compared
    elsewhere."""
    numbers: Standings = {}
    replies = [
        _reply(paper, recovered, name, reading, numbers) for name, reading in paper.replies.items()
    ]
    checks, notes = _fields(paper, recovered, numbers)
    if all(check.status != Status.CONTRADICTED for check in checks):
        _doubt_damaged_replies(paper, replies)
    ending = _ending(paper, recovered)
    standings = _account(paper, numbers)
    notes += _unlisted(paper, standings, {*numbers})
    judgement = Judged(
        paper, recovered, checks, [*replies, *others], ending, Verdict.IDENTICAL, notes, standings
    )
    judgement.verdict = _verdict(judgement)
    return judgement


def _verdict(found: Judged) -> Verdict:
    paper, missing = found.paper, found.recovered.missing
    if paper.mislabelled or paper.out_of_order:
        return Verdict.DIFFERS
    if found.contradicted:
        misread = paper.badly_read or (paper.machine_read and missing)
        return Verdict.INCOMPLETE if misread else Verdict.DIFFERS
    unread = any(check.status in (Status.NOT_READ, Status.NOT_COMPARED) for check in found.fields)
    if unread or found.ending.same is None or missing or paper.fragment_of_run or paper.unread:
        return Verdict.INCOMPLETE
    doubtful = any(check.status != Status.READ for check in [*found.fields, *found.replies])
    extra_text = any(piece.bears for piece in paper.left_over) or bool(found.notes or paper.remarks)
    if doubtful or extra_text or any(label.doubt for label in paper.labels):
        return Verdict.IDENTICAL_AS_READ
    return Verdict.IDENTICAL


def _account(paper: Printout, numbers: Standings) -> Standings:
    """Return the standing of every character that a printout accounts for. ``numbers``: of those in
    numbers that were compared; in others nothing is what the program prints."""
    standings: Standings = {}
    roles, glyphs = paper.roles(), paper.page.glyphs
    apart = [piece for piece in paper.left_over if piece.whole]
    outside = {at for piece in apart for at in range(piece.start, piece.stop)}
    for index in paper.own:
        offset, role = glyphs[index].offset, roles.get(index)
        standing = Standing.LEFT_OVER
        if offset in paper.echoed or (role == "exact" and offset not in outside):
            standing = Standing.MATCHED
        elif role == "letter" and offset not in outside:
            standing = Standing.DOUBTFUL
        standings[offset] = numbers.get(offset, standing)
    return standings


def _unlisted(paper: Printout, standings: Standings, listed: set[int]) -> Iterator[Piece]:
    """Yield what is left over in a number's place, such as a reply before the one that counts.
    ``listed``: offsets of characters that are listed with a number."""
    listed |= {at for piece in paper.left_over for at in range(piece.start, piece.stop)}
    loose = [
        index
        for index in paper.own
        if standings[offset := paper.page.glyphs[index].offset] is Standing.LEFT_OVER
        if offset not in listed
    ]
    for _, pairs in groupby(enumerate(loose), lambda pair: pair[1] - pair[0]):
        run = [index for _, index in pairs]
        yield _note(paper, paper.page.glyphs[run[0] : run[-1] + 1])


def _standings_of(region: Region, spots: Sequence[Spot]) -> Standings:
    """Return the standing of a number's glyphs, from their differences from the program's text."""
    standings = {glyph.offset: Standing.MATCHED for glyph in region}
    for spot in spots:
        standing = Standing.DOUBTFUL if spot.printed else Standing.LEFT_OVER
        for glyph in region[spot.at :][: len(spot.read)]:
            standings[glyph.offset] = standing
    return standings | {glyph.offset: Standing.LEFT_OVER for glyph in region[LONGEST:]}


# --- numbers -------------------------------------------------------------------------------------


def _fields(
    paper: Printout, recovered: Recovered, standings: Standings
) -> tuple[list[FieldCheck], list[Piece]]:
    """Return a check of every field that is printed or should be, in the order of the printout; and
    the notes typed beside numbers that were read. ``standings`` takes those of their glyphs."""
    checks, notes = [], []
    row = _angle_row(paper, recovered)
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
            note_at = note_start(reading.region)
            if note_at < len(reading.region) and reading.region[:note_at]:
                number_match = compare(reading.region[:note_at], text)
                if not number_match.contradicts:
                    notes.append(_note(paper, reading.region[note_at:]))
                    standings |= {g.offset: Standing.LEFT_OVER for g in reading.region[note_at:]}
                    check.stop = reading.region[note_at - 1].offset + 1
                    reading = replace(reading, region=reading.region[:note_at], stop=check.stop)
            match = compare(reading.region, text, reading.cut, reading.sign_free)
            standings |= _standings_of(reading.region, match.spots)
            if name in row and name != ANGLES[0] and not reading.region[0].gap:
                match = match._replace(spots=(Spot(0, "", "", Doubt.BLANK), *match.spots))
            check.status = _status(match, reading.region, text)
            check.doubts = _doubts(paper, reading, match.spots)
            if check.status is Status.READ:
                check.printed = text
            elif check.printed == text or (
                check.status is Status.CONTRADICTED and not reading.clean
            ):
                check.printed = _paper_text(paper, reading)
        else:
            if not recovered.missing:
                check.status = Status.CONTRADICTED
            standings |= {glyph.offset: Standing.DOUBTFUL for glyph in reading.region}
        checks.append(check)
    return checks, notes


MAX_SHOWN = 30  # characters shown of the text in a number's place


def _paper_text(paper: Printout, reading: Reading) -> str:
    """Return the text in a number's place, as it stands on the paper."""
    end = reading.region[-1].offset + 1
    text = " ".join(paper.page.text[reading.start : end].split())
    return text if len(text) <= MAX_SHOWN else text[: MAX_SHOWN - 3] + "..."


def _note(paper: Printout, region: Region) -> Piece:
    start, stop = region[0].offset, region[-1].offset + 1
    text = " ".join(paper.page.text[start:stop].split())
    return Piece(text, *paper.page.place(start), start, stop, beside=True)


def _check(name: str, reading: Reading | None, text: str | None) -> FieldCheck:
    check = FieldCheck(name, reading.text if reading else None, text)
    if reading:
        check.line, check.column = reading.line, reading.column
        check.start, check.stop = reading.start, reading.stop
    return check


def _status(match: Match, region: Region, text: str) -> Status:
    """Return the status of a number from the match of its glyphs with the program's text."""
    if not match.spots:
        return Status.READ
    if any(spot.doubt is Doubt.CUT for spot in match.spots) and not match.contradicts:
        return Status.NOT_READ
    foreign = any(not glyph.char.isdigit() and glyph.char not in "-.+" for glyph in region)
    if (foreign or not match.contradicts) and _hardly_read(match, text):
        return Status.NOT_READ
    return Status.CONTRADICTED if match.contradicts else Status.DOUBTFUL


def _hardly_read(match: Match, text: str) -> bool:
    if any(spot.doubt is Doubt.RETYPED for spot in match.spots):
        return False
    alike = sum(spot.doubt in (Doubt.LOOK_ALIKE, Doubt.BLANK) for spot in match.spots)
    if not match.exact and not alike:
        return True
    return len(text) > 2 and 2 * match.exact + alike < len(text)


def _angle_row(paper: Printout, recovered: Recovered) -> dict[str, Region]:
    """Return the regions of the angles in a row that blanks alone do not divide; empty where they
    do."""
    texts = tuple(recovered.outcome.fields.get(name, "") for name in ANGLES)
    cuts = cut_as(paper.angle_row, texts) if paper.angle_row and all(texts) else ()
    pairs = zip(ANGLES, cuts, strict=bool(cuts))
    return {name: paper.angle_row[start:stop] for name, (start, stop) in pairs}


def _doubts(paper: Printout, reading: Reading, spots: Sequence[Spot]) -> list[Doubtful]:
    starts = [*(glyph.offset for glyph in reading.region), reading.stop]
    doubts = []
    for spot in spots:
        start = starts[spot.at]
        _, read, printed, doubt = spot
        # glyphs are capitals; the page may have a small letter here
        typed = paper.page.text[start : start + len(read)]
        read = typed if typed.upper() == read else read
        doubts.append(Doubtful(*paper.page.place(start), start, read, printed, str(doubt)))
    return doubts


# --- replies, and the ending ---------------------------------------------------------------------


def _reply(
    paper: Printout, recovered: Recovered, name: str, reading: Reading, standings: Standings
) -> FieldCheck:
    """Compare a reply at a prompt with the scene's velocity, by value; then with its text as typed
    or as printed, with or without the first glyph, whichever matches best. ``standings`` takes
    those of its glyphs."""
    value = recovered.typed.get(name, recovered.scene[name])
    standings |= {glyph.offset: Standing.DOUBTFUL for glyph in reading.region}
    if name in recovered.missing:
        return _check(name, reading, None)
    check = _check(name, reading, value)
    if reading.clean and same_value(reading.text, value):
        check.status = Status.READ
        standings |= {glyph.offset: Standing.MATCHED for glyph in reading.region}
        return check
    stored = stored_and_printed(value)
    texts = sorted({value, stored[1]} if stored else {value})
    parts = filter(None, (reading, without_mark(reading)))
    matches = [(part, compare(part.region, text)) for part in parts for text in texts]
    part, match = min(matches, key=lambda pair: pair[1].cost)
    standings |= _standings_of(part.region, match.spots)
    check.status, how = Status.NOT_READ, Doubt.ILLEGIBLE
    if any(same_value(text, value) for text, _, _ in reply_candidates(reading)):
        check.status, how = Status.DOUBTFUL, Doubt.LOOK_ALIKE
    elif reading.clean or (match.contradicts and not _hardly_read(match, value)):
        check.status, check.doubts = Status.CONTRADICTED, _doubts(paper, part, match.spots)
        return check
    place = reading.line, reading.column, reading.start
    reply_text = reading.text if reading.text != value else _paper_text(paper, reading)
    check.doubts = [Doubtful(*place, reply_text, value, str(how))]
    return check


def _doubt_damaged_replies(paper: Printout, replies: Sequence[FieldCheck]) -> None:
    """Doubt the replies at a prompt that was itself misread, its letters or its question mark,
    where every printed number is the program's: the reader damaged that line."""
    misread = {label.name for label in paper.labels if label.state is LabelState.DAMAGED}
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
                place = check.line or 0, check.column or 0, check.start or 0
                reply_text, program_text = check.printed or "", check.recomputed or ""
                check.doubts = [Doubtful(*place, reply_text, program_text, str(Doubt.LOOK_ALIKE))]


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
