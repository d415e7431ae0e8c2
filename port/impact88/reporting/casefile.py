"""The report: verdicts on printouts as one self-contained page for a case file.

All files first, those that could not be read included; then every printout from a page of its own;
the method, provenance and room for a signature last. The frame is that of `report.frame`.
"""

from collections.abc import Iterator, Sequence
from typing import Any

from .. import files
from ..errors import UserError
from ..fields import FIELDS
from ..judging import beside
from ..judging.judgement import Status, Verdict
from ..names import FINAL_VELOCITIES, quantity
from ..reading.fieldlabels import LabelState
from ..report.frame import render
from . import provenance
from .verification import (
    MEANINGS,
    STATES,
    TITLES,
    Examined,
    Verification,
    counts,
    sections,
    summary,
)

_LOOKS = {
    Verdict.IDENTICAL: "good",
    Verdict.IDENTICAL_AS_READ: "doubt",
    Verdict.DIFFERS: "bad",
    Verdict.INCOMPLETE: "doubt",
}
_SIGNS = {Status.READ: "✓", Status.DOUBTFUL: "?", Status.CONTRADICTED: "≠"}
"""What stands before the state of a number; a dash where it was not read."""
_HEADINGS = ("number", "printed", "recomputed", "state", "exact", "printed − exact")
_METHOD = (
    "The inputs printed on a page are recovered, and the 1988 listing is run with them, bit for "
    "bit in Applesoft's 40-bit arithmetic as checked against captures of a real Apple II Plus ROM. "
    "Each printed number and label is held against what the program prints in its place.",
    "Possible explanations are edits (digits misread, numbers exchanged, other units, another "
    "arithmetic, other lines of the listing), each tested by computing the page anew and ranked by "
    "how much it asks to be believed and how many numbers it leaves unexplained.",
    "Exact: Equations 13 to 18 of R. M. Brach, Vehicle Collision Analysis (1988), in double "
    "precision. These values do not bear on the verdict.",
)
_LIMITS = (
    "That a page is what the program prints does not prove that its inputs are those of the "
    "collision, nor that the mechanics apply to it.",
    "Inputs, or digits of them, on which nothing else printed depends cannot be verified by the "
    "page; they are listed for each printout.",
    "An explanation is a possibility that agrees with the page, not a finding of what happened.",
)


def write_report(path: str, examined: Sequence[Examined], **given: str | None) -> None:
    """Write the page for ``examined`` to ``path``, whole or not at all; ``given`` as for `report`.
    Raises UserError."""
    page = report(examined, **given)
    with files.replacing(path) as file:
        file.write(page)


def report(
    examined: Sequence[Examined],
    date: str | None = None,
    case: str | None = None,
    examiner: str | None = None,
) -> str:
    """The page as HTML. ``date``, ``case``, ``examiner``: the user's own, shown as given. Raises
    UserError where jinja2 is not installed."""
    results = [result for one in examined for result in one.results]
    read: list[list[str]] = []
    for one in examined:
        where = files.called(one.file)
        read += [[where, "–", "NOT READ", one.error]] if one.error else []
        for result in one.results:
            what, title = f"{result.number} ({result.where})", TITLES[result.verdict]
            read.append([where, what, title, counts(result.fields)])
    digests = [(files.called(one.file), one.sha256 or "not read") for one in examined]
    return render(
        "verification.html",
        package=__package__,
        title=f"Verification of {len(results)} printout{'s' * (len(results) != 1)}",
        case=case or "",
        examiner=examiner,
        date=date,
        files_read=read,
        printouts=list(map(_printout, results)),
        headings=_HEADINGS,
        meanings=[(TITLES[one], MEANINGS[one]) for one in Verdict],
        key=[(n, q.meaning, q.unit) for n in FIELDS for q in [quantity("MU" if n == "MUP" else n)]],
        method=_METHOD,
        limits=_LIMITS,
        provenance=[
            *digests,
            ("the listing", provenance.listing_hash()),
            ("the captures of the ROM", provenance.captures_hash()),
        ],
    )


def _printout(result: Verification) -> dict[str, Any]:
    """What the template shows of a printout."""
    inputs = [
        text
        for name, value in result.scene.items()
        for text in (name, (value or "missing") + " †" * (name in result.guessed))
    ]
    inputs += [""] * (-len(inputs) % 8)
    return {
        "title": f"{files.called(result.file)}, printout {result.number} ({result.where})",
        "look": _LOOKS[result.verdict],
        "verdict": TITLES[result.verdict],
        "says": MEANINGS[result.verdict],
        "summary": [f"{line[:1].upper()}{line[1:]}." for line in summary(result)],
        "rows": [
            {
                "look": STATES[check.status],
                "cells": [
                    check.name, check.printed or "–", check.recomputed or "–",
                    f"{_SIGNS.get(check.status, '–')} {STATES[check.status] or 'exact'}",
                    check.exact or "", (check.difference or "").replace("-", "−"),
                ],
            }
            for check in result.fields
        ],
        "sections": sections(result),
        "drawing": _drawing(result),
        "inputs": [inputs[at : at + 8] for at in range(0, len(inputs), 8)],
        "guessed": "; † not read exactly on the paper" if result.guessed else "",
        "exhibit": result.exhibit() if result.exhibit else None,
        "text": list(_as_read(result)),
    }  # fmt: skip


def _drawing(result: Verification) -> str:
    """The scene from above; none of a scene that was guessed at."""
    if not result.runnable or result.guessed or result.verdict is Verdict.INCOMPLETE:
        return ""
    from ..figures.sceneview import scene_svg

    scene = {name: text for name, text in result.scene.items() if text is not None}
    try:
        return scene_svg(scene, beside.solved(scene, [*FINAL_VELOCITIES, "STATUS"]))
    except (UserError, ValueError):
        return ""


def _as_read(result: Verification) -> Iterator[tuple[str, str]]:
    """The text as it was read, in pieces: text, and how it is marked."""
    place = result.start
    for start, stop, look in sorted(_marks(result)):
        if place <= start < result.stop:
            yield _visible(result.text[place:start]), ""
            yield _visible(result.text[start:stop]) or "_", look
            place = max(stop, start)
    if rest := _visible(result.text[place : result.stop]):
        yield rest, ""


def _visible(text: str) -> str:
    return "".join(c for c in text if c >= " " or c in "\n\t")


def _marks(result: Verification) -> Iterator[tuple[int, int, str]]:
    """Where the text is marked, and as what."""
    for check in [*result.fields, *result.replies]:
        if check.start is None or check.stop is None or check.status == Status.READ:
            continue
        if check.status == Status.CONTRADICTED:
            yield check.start, check.stop, "differs"
            continue
        for start, read in [(one.start, one.read) for one in check.doubts] or [(check.start, "")]:
            yield start, start + max(1, len(read)), "doubtful"
    for label in result.labels:
        wrong = label.state is LabelState.CONTRADICTORY
        if wrong or label.doubt:
            yield label.start, label.stop, "differs" if wrong else "doubtful"
    yield from ((piece.start, piece.stop, "over") for piece in result.left_over if piece.beside)
