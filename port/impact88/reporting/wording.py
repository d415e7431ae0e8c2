"""The words of verdicts, findings and doubts: said in one place, whoever shows them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ..errors import printable
from ..fields import ANGLES, INPUTS, scene_name
from ..judging.judgement import FieldCheck, Judged, Status, Verdict, misread_at_all, swapped_digits
from ..reading.fieldlabels import LabelCheck, LabelState
from ..reading.numerals import Doubt
from ..reading.printout import Piece, Printout
from ..recovery.recovered import Recovered
from ..recovery.typedtext import stored_and_printed

if TYPE_CHECKING:
    from ..explaining.explanations import Explanation
    from ..program.listingcopy import ListingCopy

TITLES = {
    Verdict.IDENTICAL: "IDENTICAL",
    Verdict.IDENTICAL_AS_READ: "IDENTICAL AS FAR AS READ",
    Verdict.DIFFERS: "DIFFERS",
    Verdict.INCOMPLETE: "INCOMPLETE",
}

MEANINGS = {
    Verdict.IDENTICAL: "every printed number is what the 1988 program prints, digit for digit",
    Verdict.IDENTICAL_AS_READ: "the 1988 program's page explains the paper; what was not read "
    "exactly is listed, and is to be looked at on the paper",
    Verdict.DIFFERS: "something on the paper contradicts every scene that its inputs allow",
    Verdict.INCOMPLETE: "numbers are missing or could not be read; what could be compared agrees",
}
"""What a verdict says."""


def counts(fields: Sequence[FieldCheck]) -> str:
    """How many numbers were read exactly, doubtful, contradicted, not read."""
    number = {status: sum(check.status == status for check in fields) for status in Status}
    read = number[Status.READ]
    parts = [f"{read} of {len(fields)} printed numbers read exactly and as the program prints them"]
    for status, words in (
        (Status.DOUBTFUL, "read doubtfully"),
        (Status.CONTRADICTED, "differ" if number[Status.CONTRADICTED] != 1 else "differs"),
        (Status.NOT_READ, "not read"),
        (Status.NOT_COMPARED, "not compared"),
    ):
        if number[status]:
            parts.append(f"{number[status]} {words}")
    return ", ".join(parts)


def place(line: int | None, column: int | None) -> str:
    """Where something stands."""
    return f"line {line}, column {column}"


def doubts(check: FieldCheck) -> list[str]:
    """What stands doubtfully in a number, place by place."""
    return [
        f"{place(one.line, one.column)}: {check.name} "
        + _doubt(check, one.read, one.printed, one.how)
        for one in check.doubts
        if one.how != Doubt.CONTRADICTS
    ] + [f"{where} ({check.name}: the program prints {check.recomputed})" for where in look(check)]


def _doubt(check: FieldCheck, read: str, printed: str, how: str) -> str:
    program = check.recomputed or ""
    if how == Doubt.LOOK_ALIKE:
        return f"read {read!r} where the program prints {printed!r} ({program})"
    if how == Doubt.ILLEGIBLE:
        what = f"read {read!r}" if read else "nothing read"
        return f"illegible, {what} where the program prints {printed!r} ({program})"
    if how == Doubt.BLANK:
        return f"a blank or a joint in it; the program prints {program}"
    if how == Doubt.RETYPED:
        return f"read {check.printed}; the program prints {program}, never this form"
    if how == Doubt.CUT:
        return f"cut off; the program prints {program}"
    return f"{read!r} left over beside {program}"


def look(check: FieldCheck) -> list[str]:
    """Where to look on the paper for a misread digit."""
    sentences = []
    for one in check.doubts:
        if one.how != Doubt.CONTRADICTS:
            continue
        where = place(one.line, one.column)
        if one.read and one.printed:
            sentences.append(f"{where}: is this {one.read} {_a(one.printed)} {one.printed}?")
        elif one.read:
            sentences.append(f"{where}: is this {one.read} part of the number?")
        else:
            sentences.append(f"{where}: is {_a(one.printed)} {one.printed} missing here?")
    return sentences


def _a(glyph: str) -> str:
    return "an" if glyph[:1] == "8" else "a"


def findings(page: Printout, fields: Sequence[FieldCheck], recovered: Recovered) -> list[str]:
    """What the page shows besides its numbers."""
    sentences = []
    retyped = [
        check.name for check in fields if any(one.how == Doubt.RETYPED for one in check.doubts)
    ]
    if retyped:
        sentences.append(
            f"{', '.join(retyped)} in a form Applesoft never prints (a zero before the point or at "
            "the end, a plus sign): retyped, or made by another program"
        )
    if commas(page):
        sentences.append("decimal commas throughout: retyped, or made by another program")
    if recovered.m_unknown and not recovered.missing:
        m = recovered.scene["M"]
        sentences.append(
            f"no line of final spins: read as M = {m}; with M = {'6' if m == '4' else '4'} the "
            "program prints the same numbers but for that line"
        )
    elif recovered.scene["M"] == "4" and "M" not in recovered.missing and not page.has_final_spins:
        sentences.append("no line of final spins: the results are those of M = 4, not of M = 6")
    return sentences


def looked_past(fields: Sequence[FieldCheck], replies: Sequence[FieldCheck]) -> list[str]:
    """That digits which were cleanly read as others are put down to the page's reader."""
    others = [
        f"{check.name} ({read} for {printed})"
        for check in [*fields, *replies]
        for printed, read in swapped_digits(check)
    ]
    if not others:
        return []
    misread = sum(map(misread_at_all, fields))
    return [
        f"read as another digit than the program prints: {', '.join(others)}; put down to the "
        f"reader of the page, who misread {misread} of {len(fields)} numbers: if the paper shows "
        "one of these digits as it was read, it differs from the program's page"
    ]


def of_copy(copy: ListingCopy, held: Judged, restored: Mapping[str, str]) -> list[str]:
    """What an office's copy of the listing prints, and in which lines it is another program;
    ``restored``: what the restored listing prints for the scene."""
    agrees = held.verdict in (Verdict.IDENTICAL, Verdict.IDENTICAL_AS_READ)
    others = ", ".join(
        f"{check.name} {restored.get(check.name, 'nothing')}"
        for check in held.fields
        if check.recomputed != restored.get(check.name)
    )
    return [
        f"this page is {'' if agrees else 'not '}what the copy {copy.file} prints; the restored "
        f"listing prints {others or 'the same numbers'}",
        *(
            f"line {line.line}: the copy has {line.copy or 'nothing'} | "
            f"the restored listing {line.restored or 'nothing'}"
            for line in copy.changed_lines()
        ),
    ]


def given_apart(names: Sequence[str], fields: Sequence[FieldCheck]) -> list[str]:
    """That inputs are not the page's own, and how its results compare with them."""
    if not names:
        return []
    compared = [check for check in fields if check.same is not None]
    differing = sum(check.same is False for check in compared)
    agree = f"all {len(compared)} numbers read are what the program prints for them"
    if not compared:
        agree = "no number was read to be compared"
    elif differing:
        agree = f"{differing} of {len(compared)} numbers read are not what it prints for them"
    return [f"not on the page, and taken from the scene given apart: {', '.join(names)}; {agree}"]


def given_otherwise(
    given: Mapping[str, str], scene: Mapping[str, str | None], fields: Sequence[FieldCheck]
) -> list[str]:
    """That inputs were given apart which the page has, and which in its ``scene`` are others."""
    otherwise = []
    for check in fields:
        name = scene_name(check.name)
        by_page = scene[name] if check.name in INPUTS else None
        if by_page is None or check.printed is None or name not in given:
            continue
        one, other = (stored_and_printed(text, name in ANGLES) for text in (given[name], by_page))
        if one is None or other is None or one[1] != other[1]:
            otherwise.append(f"{name} {given[name]} (by the page {by_page})")
    if not otherwise:
        return []
    return [f"given apart and different from the page, which is used: {'; '.join(otherwise)}"]


def commas(page: Printout) -> bool:
    """Whether every decimal point is a comma."""
    text = "".join(glyph.char for reading in page.fields.values() for glyph in reading.region[:-1])
    return text.count(",") >= 3 and "." not in text


def cause(one: Explanation) -> str:
    """An explanation in one line."""
    from ..explaining.explanations import LABEL_WRONG, LABELS_EXCHANGED

    what = one.kind
    said = [f"{each['printed']}, would be {each['would_be']}" for each in one.changes]
    if one.kind == LABELS_EXCHANGED:
        pairs = (" and ".join(sorted((one["printed"], one["would_be"]))) for one in one.changes)
        what = f"labels {', '.join(dict.fromkeys(pairs))} exchanged"
    elif one.kind == LABEL_WRONG:
        what = "; ".join(f"{each['would_be']} labelled {each['printed']}" for each in one.changes)
    elif one.changes:
        named = [f"{each['field']} {text}" for each, text in zip(one.changes, said, strict=True)]
        what += ": " + "; ".join(named[:6])
    return what + (f" ({one.note})" if one.note else "")


_MOST_LINES = 12
"""Lines that do not belong to the program's page are shown up to this many."""


def left_over(pieces: Sequence[Piece]) -> list[str]:
    """What belongs to no number and no label: beside a number, or a whole line."""
    beside = [
        f"{place(piece.line, piece.column)}: {_quoted(piece.text)} left over beside a number"
        for piece in pieces
        if piece.beside and not piece.whole
    ]
    lines = [piece for piece in pieces if piece.whole]
    bearing = [piece for piece in lines if piece.beside]
    listed = (bearing + [one for one in lines if not one.beside])[:_MOST_LINES]
    whole = [
        f"line {piece.line} does not belong to the program's page: {printable(piece.text)}"
        for piece in sorted(listed, key=lambda piece: piece.line)
    ]
    if len(lines) > len(listed):
        whole.append(
            f"and {len(lines) - len(listed)} more lines that do not belong to the program's page"
        )
    return beside + whole


def labels(checks: Sequence[LabelCheck]) -> list[str]:
    """The labels that are not the program's, those that contradict first."""
    words = {
        LabelState.CONTRADICTORY: "labelled {read} where the program prints {printed}",
        LabelState.DAMAGED: "the label {printed} is read {read}",
        LabelState.MISSING: "no label before the number where the program prints {printed}",
    }
    return [
        f"line {one.line}: " + text.format(read=printable(one.read), printed=one.printed)
        for state, text in words.items()
        for one in checks
        if one.state is state and (state is LabelState.CONTRADICTORY or one.doubt)
    ]


def _quoted(text: str) -> str:
    return repr(text if len(text) <= 40 else text[:37] + "...")
