"""The words of verdicts, findings and doubts: said in one place, whoever shows them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ..errors import printable
from ..fields import ANGLES, INPUTS, scene_name
from ..judging.judgement import FieldCheck, Judged, Status, Verdict
from ..reading.fieldlabels import LabelCheck, LabelState
from ..reading.numerals import Doubt
from ..reading.printout import Piece, Printout
from ..recovery.recovered import Recovered
from ..recovery.typedtext import stored_and_printed

if TYPE_CHECKING:
    from ..explaining.explanations import Explanation
    from ..program.emulated import ListingCopy

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

STATES = {
    Status.READ: "",
    Status.DOUBTFUL: "doubtful",
    Status.CONTRADICTED: "differs",
    Status.NOT_READ: "not read",
    Status.NOT_COMPARED: "not compared",
}
"""How a number is marked that was not read exactly."""


def counts(fields: Sequence[FieldCheck]) -> str:
    """How many numbers were read exactly, doubtful, contradicted, not read."""
    number = {status: sum(check.status == status for check in fields) for status in Status}
    read = f"{number.pop(Status.READ)} of {len(fields)} printed numbers read exactly"
    words = {**STATES, Status.DOUBTFUL: "read doubtfully"}
    if number[Status.CONTRADICTED] > 1:
        words[Status.CONTRADICTED] = "differ"
    others = [f"{count} {words[status]}" for status, count in number.items() if count]
    return ", ".join([f"{read} and as the program prints them", *others])


# --- numbers and labels --------------------------------------------------------------------------


def place(line: int | None, column: int | None) -> str:
    """Where something stands."""
    return f"line {line}, column {column}"


_DOUBTS: dict[str, str] = {
    Doubt.LOOK_ALIKE: "read {read!r} where the program prints {printed!r} ({program})",
    Doubt.ILLEGIBLE: "illegible (read {read!r}) where the program prints {printed!r} ({program})",
    Doubt.BLANK: "a blank or a joint in it; the program prints {program}",
    Doubt.RETYPED: "read {whole}; the program prints {program}, never this form",
    Doubt.CUT: "cut off; the program prints {program}",
    Doubt.LEFT_OVER: "{read!r} left over beside {program}",
    "picture": "nearly as much like {read!r} as {printed!r} ({program})",
}


def doubts(check: FieldCheck) -> list[str]:
    """What stands doubtfully in a number, place by place."""
    said = {"program": check.recomputed or "", "whole": check.printed}
    return [
        f"{place(one.line, one.column)}: {check.name} "
        + _DOUBTS[one.how].format(**one._asdict(), **said)
        for one in check.doubts
        if one.how in _DOUBTS
    ] + [f"{where} ({check.name}: the program prints {check.recomputed})" for where in look(check)]


def look(check: FieldCheck) -> list[str]:
    """Where to look on the paper for a misread digit."""
    sentences = []
    for one in check.doubts:
        printed = f"{'an' if one.printed[:1] == '8' else 'a'} {one.printed}"
        question = f"is {printed} missing here"
        if one.read:
            question = f"is this {one.read} {printed if one.printed else 'part of the number'}"
        if one.how == Doubt.CONTRADICTS:
            sentences.append(f"{place(one.line, one.column)}: {question}?")
    return sentences


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


_MOST_LINES = 12
"""Lines that do not belong to the program's page are shown up to this many."""


def left_over(pieces: Sequence[Piece]) -> list[str]:
    """What belongs to no number and no label: beside a number, or a whole line."""
    said = []
    for piece in pieces:
        if piece.beside and not piece.whole:
            text = piece.text if len(piece.text) <= 40 else piece.text[:37] + "..."
            said.append(f"{place(piece.line, piece.column)}: {text!r} left over beside a number")
    lines = [piece for piece in pieces if piece.whole]
    listed = sorted(lines, key=lambda piece: not piece.beside)[:_MOST_LINES]
    said += [
        f"line {piece.line} does not belong to the program's page: {printable(piece.text)}"
        for piece in sorted(listed, key=lambda piece: piece.line)
    ]
    if more := len(lines) - len(listed):
        said.append(f"and {more} more lines that do not belong to the program's page")
    return said


# --- findings ------------------------------------------------------------------------------------


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
    text = "".join(glyph.char for reading in page.fields.values() for glyph in reading.region[:-1])
    if text.count(",") >= 3 and "." not in text:
        sentences.append("decimal commas throughout: retyped, or made by another program")
    m = recovered.scene["M"]
    if recovered.m_unknown and not recovered.missing:
        sentences.append(
            f"no line of final spins: read as M = {m}; with M = {'6' if m == '4' else '4'} the "
            "program prints the same numbers but for that line"
        )
    elif m == "4" and "M" not in recovered.missing and not page.has_final_spins:
        sentences.append("no line of final spins: the results are those of M = 4, not of M = 6")
    return sentences


_MISREADINGS = (Doubt.LOOK_ALIKE, Doubt.ILLEGIBLE, Doubt.CONTRADICTS)


def looked_past(fields: Sequence[FieldCheck], replies: Sequence[FieldCheck]) -> list[str]:
    """That digits which were cleanly read as others are put down to the page's reader."""
    others = [
        f"{check.name} ({read} for {printed})"
        for check in [*fields, *replies]
        for printed, read in check.swapped()
    ]
    if not others:
        return []
    misread = sum(
        any(one.how in _MISREADINGS and one.read != one.printed for one in check.doubts)
        for check in fields
    )
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


def given_apart(
    given: Mapping[str, str], scene: Mapping[str, str | None], fields: Sequence[FieldCheck]
) -> list[str]:
    """Of inputs given separately: those that the page lacks, and how its results compare with them;
    and those that it has otherwise."""
    absent, otherwise = [], []
    shown = {scene_name(check.name): check for check in fields if check.name in INPUTS}
    for name, check in shown.items():
        text, by_page = given.get(name), scene[name]
        if text is None or by_page is None:
            continue
        if check.printed is None:
            absent.append(name)
            continue
        one, other = (stored_and_printed(each, name in ANGLES) for each in (text, by_page))
        if one is None or other is None or one[1] != other[1]:
            otherwise.append(f"{name} {text} (by the page {by_page})")
    sentences = []
    if absent:
        compared = [check.same for check in fields if check.same is not None]
        agree = f"all {len(compared)} numbers read are what the program prints for them"
        if not compared:
            agree = "no number was read to be compared"
        elif wrong := compared.count(False):
            agree = f"{wrong} of {len(compared)} numbers read are not what it prints for them"
        sentences.append(
            f"not on the page; taken from the scene given separately: {', '.join(absent)}; {agree}"
        )
    if otherwise:
        sentences.append(
            f"given separately and different from the page, which is used: {'; '.join(otherwise)}"
        )
    return sentences


# --- explanations --------------------------------------------------------------------------------


def cause(one: Explanation) -> str:
    """An explanation in one line."""
    from ..explaining.explanations import LABEL_WRONG, LABELS_EXCHANGED

    what = one.kind
    if one.kind == LABELS_EXCHANGED:
        pairs = (" and ".join(sorted((each["printed"], each["would_be"]))) for each in one.changes)
        what = f"labels {', '.join(dict.fromkeys(pairs))} exchanged"
    elif one.kind == LABEL_WRONG:
        what = "; ".join(f"{each['would_be']} labelled {each['printed']}" for each in one.changes)
    elif one.changes:
        what += ": " + "; ".join(
            f"{each['field']} {each['printed']}, would be {each['would_be']}"
            for each in one.changes[:6]
        )
    return what + (f" ({one.note})" if one.note else "")
