"""The report: verdicts on printouts as one self-contained page for a case file.

All files first, those that could not be read included; then every printout from a page of its own;
the method, provenance and room for a signature last.
"""

from collections.abc import Iterator, Sequence
from typing import Any

from ... import files
from ...collision.doubles import doubles_of
from ...collision.fields import FIELDS
from ...errors import UserError
from ...names import FINAL_VELOCITIES, quantity
from ...printouts.judging.judgement import Status, Verdict
from ...printouts.reading.differences import Kind
from ...printouts.reporting.verification import (
    MEANINGS,
    TITLES,
    Examined,
    Verification,
    counts,
    sections,
    summary,
)
from .frame import hashes, render


def report(
    examined: Sequence[Examined],
    date: str | None = None,
    case: str | None = None,
    examiner: str | None = None,
) -> str:
    """Return the page as HTML. ``date``, ``case``, ``examiner``: the user's own, shown as given.
    Raises UserError where jinja2 is not installed."""
    results = [result for file in examined for result in file.results]
    read: list[list[str]] = []
    for file in examined:
        file_name = files.display_name(file.file)
        read += [[file_name, "–", "NOT READ", file.error]] if file.error else []
        for result in file.results:
            printout, title = f"{result.number} ({result.where})", TITLES[result.verdict]
            read.append([file_name, printout, title, counts(result.fields)])
    digests = [(files.display_name(file.file), file.sha256 or "not read") for file in examined]
    return render(
        "verification.html",
        title=f"Verification of {len(results)} printout{'s' * (len(results) != 1)}",
        case=case or "",
        examiner=examiner,
        date=date,
        files_read=read,
        printouts=list(map(_printout, results)),
        titles=TITLES,
        meanings=MEANINGS,
        key=[(n, q.meaning, q.unit) for n in FIELDS for q in [quantity("MU" if n == "MUP" else n)]],
        provenance=[
            *digests,
            ("the listing", hashes()["listing"]),
            ("the captures of the ROM", hashes()["captures"]),
        ],
    )


def _printout(result: Verification) -> dict[str, Any]:
    inputs = [
        text
        for name, value in result.scene.items()
        for text in (name, (value or "missing") + " †" * (name in result.guessed))
    ]
    inputs += [""] * (-len(inputs) % 8)
    return {
        "result": result,
        "title": f"{files.display_name(result.file)}, printout {result.number} ({result.where})",
        "summary": summary(result),
        "sections": sections(result),
        "drawing": _drawing(result),
        "inputs": [inputs[at : at + 8] for at in range(0, len(inputs), 8)],
        "exhibit": result.exhibit() if result.exhibit else None,
        "text": list(_as_read(result)),
    }


def _drawing(result: Verification) -> str:
    """Return the drawing of the scene from above; empty for a scene that was partly guessed."""
    scene = result.complete_scene
    if not scene or result.guessed or result.verdict is Verdict.INCOMPLETE:
        return ""
    from ...mechanics.closedform.solve import solve
    from ..figures.sceneview import scene_svg

    try:
        return scene_svg(scene, solve(doubles_of(scene), [*FINAL_VELOCITIES, "STATUS"]))
    except (UserError, ValueError):
        return ""


def _as_read(result: Verification) -> Iterator[tuple[str, str]]:
    """Yield the text as it was read, in pieces: text, and the kind of mark on it."""
    place = result.start
    for start, stop, look in sorted(_marks(result)):
        if place <= start < result.stop:
            yield _visible(result.text[place:start]), ""
            yield _visible(result.text[start:stop]) or "_", look
            place = max(stop, start)
    if remainder := _visible(result.text[place : result.stop]):
        yield remainder, ""


def _visible(text: str) -> str:
    return "".join(c for c in text if c >= " " or c in "\n\t")


def _marks(result: Verification) -> Iterator[tuple[int, int, str]]:
    """Yield the marked places in the text: start, stop, kind of mark."""
    for check in [*result.fields, *result.replies]:
        if check.start is None or check.stop is None or check.status == Status.READ:
            continue
        if check.status == Status.CONTRADICTED:
            yield check.start, check.stop, "differs"
            continue
        places = [(doubt.start, doubt.read) for doubt in check.doubts]
        for start, read in places or [(check.start, "")]:
            yield start, start + max(1, len(read)), "doubtful"
    for label in result.labels:
        if label.bears:
            wrong = label.kind is Kind.CONTRADICTS
            yield label.start, label.stop, "differs" if wrong else "doubtful"
    yield from ((piece.start, piece.stop, "over") for piece in result.left_over if piece.bears)
