"""Judging: every number on the paper against the program's page for the recovered scene.

Each number is read exactly, doubtful (look-alikes, illegible or stray glyphs, but what the program
prints fits them), contradicted (cleanly read, and not what the program prints) or not read. The
verdict follows from these alone.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

from ..fields import ANGLES, FIELDS, FINAL_SPINS
from ..reading.numerals import Doubt, Match, Region, Spot, compare, cut_as
from ..reading.printout import Printout, Reading
from ..recovery.recovered import Recovered, reply_ways, without_mark
from ..recovery.typedtext import stored_and_printed


class Verdict(StrEnum):
    """What a printout is found to be."""

    IDENTICAL = "identical"
    IDENTICAL_AS_READ = "identical_as_read"
    DIFFERS = "differs"
    INCOMPLETE = "incomplete"


class Status(StrEnum):
    """What became of one number."""

    READ = "read"
    DOUBTFUL = "doubtful"
    CONTRADICTED = "contradicted"
    NOT_READ = "not read"
    NOT_COMPARED = "not compared"


@dataclass
class Doubtful:
    """One place where the paper was not read as the program prints it: line and column (from 1),
    offset in the text, what was read and what the program prints (either may be empty), and how
    they differ (`numerals.Doubt`)."""

    line: int
    column: int
    start: int
    read: str
    printed: str
    how: str


@dataclass
class FieldCheck:
    """One printed number against the replay.

    ``printed``: what was read; ``recomputed``: what the program prints; ``same``: True when read
    exactly so, False when contradicted, None when doubtful, not read or not to be compared;
    ``exact``: what exact arithmetic gives, ``difference``: printed less exact; ``status``: one of
    `Status`; ``line``, ``column`` (from 1), ``start``, ``stop`` (offsets): its place in the text;
    ``doubts``: where reading and printout part."""

    name: str
    printed: str | None
    recomputed: str | None
    same: bool | None
    exact: str | None = None
    difference: str | None = None
    status: str = Status.NOT_COMPARED
    line: int | None = None
    column: int | None = None
    start: int | None = None
    stop: int | None = None
    doubts: list[Doubtful] = field(default_factory=list)

    def as_json(self) -> dict[str, Any]:
        """The object `impact88 verify --json` prints for a number."""
        return {
            **vars(self),
            "status": str(self.status),
            "doubts": [vars(one) for one in self.doubts],
        }


_SAME = {Status.READ: True, Status.CONTRADICTED: False}


def field_checks(shown: Printout, recovered: Recovered) -> list[FieldCheck]:
    """Every field that is printed or should be, in the order of the printout."""
    outcome = recovered.outcome
    checks = []
    row = _angle_row(shown, recovered)
    for name in FIELDS:
        reading = shown.fields.get(name)
        text = outcome.fields.get(name)
        if name in row:
            reading = shown.reading(row[name][0])
        if reading is None and text is None:
            expected = recovered.missing and not shown.ending
            if not expected or (name in FINAL_SPINS and recovered.scene["M"] != "6"):
                continue
        check = FieldCheck(name, reading.text if reading else None, text, None)
        if reading is not None:
            _locate(check, reading)
        if reading is None:
            check.status = Status.NOT_READ
        elif text is not None:
            if name in row:
                _, check.status, spots = row[name]
            else:
                match = explained(reading, text)
                check.status, spots = status_of(match, reading.region, text), match.spots
            check.doubts = _doubts(shown, reading, spots)
            if check.status is Status.READ:
                check.printed = text
        elif not recovered.missing:
            check.status = Status.CONTRADICTED
        check.same = _SAME.get(Status(check.status))
        checks.append(check)
    return checks


def explained(reading: Reading, text: str) -> Match:
    """How a reading is explained by what the program prints."""
    return compare(reading.region, text, reading.cut, reading.sign_free)


def _locate(check: FieldCheck, reading: Reading) -> None:
    check.line, check.column = reading.line, reading.column
    check.start, check.stop = reading.start, reading.stop


def status_of(match: Match, region: Region, text: str) -> Status:
    """What a number is, by how its glyphs are explained by what the program prints."""
    if not match.spots:
        return Status.READ
    if any(spot.doubt is Doubt.CUT for spot in match.spots) and not match.contradicts:
        return Status.NOT_READ
    damaged = any(not glyph.char.isdigit() and glyph.char not in "-.+" for glyph in region)
    if damaged and _hardly_read(match, region, text):
        return Status.NOT_READ
    if match.contradicts:
        return Status.CONTRADICTED
    return Status.NOT_READ if _hardly_read(match, region, text) else Status.DOUBTFUL


def _hardly_read(match: Match, region: Region, text: str) -> bool:
    """Whether more is guessed than read."""
    if any(spot.doubt is Doubt.RETYPED for spot in match.spots):
        return False
    alike = sum(spot.doubt in (Doubt.LOOK_ALIKE, Doubt.BLANK) for spot in match.spots)
    if not match.exact and not alike:
        return True
    if len(text) <= 2:
        return len(region) > len(text) + 2 and match.exact + alike == 0
    return 2 * match.exact + alike < len(text)


def _angle_row(
    shown: Printout, recovered: Recovered
) -> dict[str, tuple[Region, Status, tuple[Spot, ...]]]:
    """Where the angles stand in a row that blanks alone do not cut, and what became of each; none
    where the row is plain."""
    texts = tuple(recovered.outcome.fields.get(name) for name in ANGLES)
    if not shown.angle_row or None in texts:
        return {}
    row: dict[str, tuple[Region, Status, tuple[Spot, ...]]] = {}
    cuts = cut_as(shown.angle_row, tuple(map(str, texts)))
    for name, text, (start, stop) in zip(ANGLES, texts, cuts, strict=bool(cuts)):
        region = shown.angle_row[start:stop]
        match = compare(region, str(text))
        status, spots = status_of(match, region, str(text)), match.spots
        if not region:
            status = Status.NOT_READ
        elif start and not region[0].gap:
            spots = (Spot(0, "", "", Doubt.BLANK), *spots)
            status = Status.DOUBTFUL if status is Status.READ else status
        row[name] = region, status, spots
    return row


def _doubts(shown: Printout, reading: Reading, spots: Sequence[Spot]) -> list[Doubtful]:
    doubts = []
    for spot in spots:
        inside = spot.at < len(reading.region)
        start = reading.region[spot.at].offset if inside else reading.stop
        line, column = shown.place(start)
        doubts.append(Doubtful(line, column, start, spot.read, spot.printed, str(spot.doubt)))
    return doubts


def reply_checks(shown: Printout, recovered: Recovered) -> list[FieldCheck]:
    """The replies shown at the prompts against the velocities of the scene, as numbers."""
    checks = []
    for name, reading in shown.replies.items():
        value = None if name in recovered.missing else recovered.scene.get(name)
        check = FieldCheck(name, reading.text, value, None)
        _locate(check, reading)
        if value is not None:
            check.status, check.doubts = _reply_status(shown, reading, value)
        check.same = _SAME.get(Status(check.status))
        checks.append(check)
    return checks


def _reply_status(shown: Printout, reading: Reading, value: str) -> tuple[Status, list[Doubtful]]:
    if reading.clean and same_value(reading.text, value):
        return Status.READ, []
    mark = Doubtful(
        reading.line, reading.column, reading.start, reading.text, value, str(Doubt.LOOK_ALIKE)
    )
    ways = reply_ways(reading)
    if any(same_value(text, value) for text, _, _ in ways):
        return Status.DOUBTFUL, [mark]
    part, match = _likest(reading, value)
    if match.contradicts and (reading.clean or not _hardly_read(match, part.region, value)):
        return Status.CONTRADICTED, _doubts(shown, part, match.spots)
    if reading.clean:
        mark.how = str(Doubt.CONTRADICTS)
        return Status.CONTRADICTED, [mark]
    mark.how = str(Doubt.ILLEGIBLE)
    return Status.NOT_READ, [mark]


def _likest(reading: Reading, value: str) -> tuple[Reading, Match]:
    """A reply, with or without its first glyph, laid beside a value as typed or as printed: the way
    that explains it best."""
    seen = stored_and_printed(value)
    texts = {value, seen[1]} if seen else {value}
    parts = [reading, without_mark(reading)]
    ways = [(part, compare(part.region, text)) for part in parts if part for text in sorted(texts)]
    return min(ways, key=lambda way: way[1].cost)


def same_value(one: str, other: str) -> bool:
    """Whether two typed texts are the same real."""
    seen, expected = stored_and_printed(one), stored_and_printed(other)
    return seen is not None and expected is not None and seen[0] == expected[0]


def ending_check(shown: Printout, recovered: Recovered) -> FieldCheck:
    """How the printout ends against how the replay does."""
    recomputed = recovered.outcome.ending
    same: bool | None = shown.ending == recomputed
    if recovered.missing:
        same = None if shown.ending else True
    elif shown.ending is None and recomputed is not None:
        # cut off before the message, unless the printout goes on past it: then fields differ
        same = None
    status = {True: Status.READ, False: Status.CONTRADICTED, None: Status.NOT_COMPARED}[same]
    return FieldCheck("ENDING", shown.ending, recomputed, same, status=status)


# --- the verdict ---------------------------------------------------------------------------------


@dataclass
class Judged:
    """A printout held against the page of the scene that was recovered: every number, the replies,
    the ending, and the verdict."""

    shown: Printout
    recovered: Recovered
    fields: list[FieldCheck]
    replies: list[FieldCheck]
    ending: FieldCheck
    verdict: Verdict

    @property
    def contradicted(self) -> list[FieldCheck]:
        """The numbers and the ending that are not what the program prints."""
        every = [*self.fields, *self.replies, self.ending]
        return [check for check in every if check.status == Status.CONTRADICTED]


def judge(shown: Printout, recovered: Recovered, others: Sequence[FieldCheck] = ()) -> Judged:
    """The printout, judged. ``others``: replies that were compared elsewhere."""
    fields = field_checks(shown, recovered)
    replies = [*reply_checks(shown, recovered), *others]
    ending = ending_check(shown, recovered)
    verdict = verdict_of(shown, recovered, fields, replies, ending)
    return Judged(shown, recovered, fields, replies, ending, verdict)


def verdict_of(
    shown: Printout,
    recovered: Recovered,
    fields: Sequence[FieldCheck],
    replies: Sequence[FieldCheck],
    ending: FieldCheck,
) -> Verdict:
    """The verdict that the numbers amount to."""
    every = [*fields, *replies, ending]
    if shown.mislabelled:
        return Verdict.DIFFERS
    if any(check.status == Status.CONTRADICTED for check in every):
        misread = shown.badly_read or (shown.machine_read and recovered.missing)
        return Verdict.INCOMPLETE if misread else Verdict.DIFFERS
    unread = any(check.status in (Status.NOT_READ, Status.NOT_COMPARED) for check in fields)
    if unread or ending.same is None or recovered.missing or shown.fragment_of_run or shown.unread:
        return Verdict.INCOMPLETE
    if any(check.status != Status.READ for check in [*fields, *replies]) or beside(shown):
        return Verdict.IDENTICAL_AS_READ
    return Verdict.IDENTICAL


def beside(shown: Printout) -> bool:
    """Whether anything is left over that may bear on a number, a reply could not be read, or a
    label leaves a doubt about which number it names."""
    return (
        any(piece.beside for piece in shown.left_over)
        or any(one.doubt for one in shown.labels)
        or bool(shown.remarks)
    )


_READ_WELL = 0.6


def settled(shown: Printout, checks: Sequence[FieldCheck], replies: Sequence[FieldCheck]) -> bool:
    """Whether all that a machine-read page contradicts is its reader's doing.

    A reader loses and adds signs and points, and a digit of a number here and there, and where it
    takes one digit for another it does so in more places than one. A digit altered on the paper
    stands alone: a digit cleanly read as another is not looked past unless the page shows the
    same mistake again (`_readers_own`).
    """
    every = [*checks, *replies]
    wrong = [check for check in every if check.status == Status.CONTRADICTED]
    if any(check.status in (Status.NOT_READ, Status.NOT_COMPARED) for check in checks):
        return False
    read = sum(check.status in (Status.READ, Status.DOUBTFUL) for check in every)
    if not shown.machine_read or read < _READ_WELL * len(every):
        return False
    if not _readers_own(checks, replies):
        return False
    if any(_digits_lost_or_added(check) > 1 for check in wrong):
        return False
    lost = sum(not any(True for _ in swapped_digits(check)) for check in wrong)
    return lost <= LOST_AND_ADDED


LOST_AND_ADDED = 3
"""So many numbers with a glyph lost or added may be put down to a reader."""


def _readers_own(checks: Sequence[FieldCheck], replies: Sequence[FieldCheck]) -> bool:
    """Whether every digit cleanly read as another is one of its reader's mistakes: whether the page
    shows the same digit taken for the same other one again. A letter read for a digit licenses no
    digit read for a digit, and a digit that stands alone is never looked past."""
    swapped = Counter(pair for check in [*checks, *replies] for pair in swapped_digits(check))
    return all(count > 1 for count in swapped.values())


_MISREADINGS = frozenset((Doubt.LOOK_ALIKE, Doubt.ILLEGIBLE, Doubt.CONTRADICTS))


def misread_at_all(check: FieldCheck) -> bool:
    """Whether glyphs of a number were read as others, lost or added."""
    return any(doubt.how in _MISREADINGS and doubt.read != doubt.printed for doubt in check.doubts)


def _digits_lost_or_added(check: FieldCheck) -> int:
    """How many digits of a number were not read, or read where none is printed; all that is lost
    behind a point is lost in one piece, for the program ends no number so."""
    wrong = [doubt for doubt in check.doubts if doubt.how == Doubt.CONTRADICTS]
    if check.printed and check.printed.endswith(".") and not any(doubt.read for doubt in wrong):
        return 1
    return sum(
        doubt.read.isdigit() != doubt.printed.isdigit() and not (doubt.read and doubt.printed)
        for doubt in wrong
    )


def swapped_digits(check: FieldCheck) -> Iterator[tuple[str, str]]:
    """The digits of a number cleanly read as other digits: (printed by the program, read)."""
    for doubt in check.doubts:
        if doubt.how == Doubt.CONTRADICTS and doubt.read.isdigit() and doubt.printed.isdigit():
            yield doubt.printed, doubt.read
