"""Verifying a printout: recover the scene it prints, replay it bit for bit, compare every digit.

The verdict rests on printed digits alone; what exact arithmetic gives and physical warnings stand
beside it and never change it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from time import process_time
from typing import TYPE_CHECKING

from .. import files
from ..errors import UserError
from ..judging import beside
from ..judging.judgement import Judged, Status, Verdict, judge
from ..judging.lookingpast import LookingPast
from ..judging.unseen import Program, unseen
from ..names import SCENE
from ..reading.plaintext import decoded
from ..reading.printout import LARGEST_FILE, Printout, read_printouts
from ..recovery.recovered import recover, without_angles
from ..recovery.replays import run_all, run_once
from . import provenance, wording
from .verification import Examined, Verification

if TYPE_CHECKING:
    from ..judging.copies import CopyPages
    from ..program.listingcopy import ListingCopy

PICTURE_STARTS = (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"II*\x00", b"MM\x00*", b"%PDF-")
"""How PNG, JPEG, TIFF (of either byte order) and PDF files begin."""
LARGEST_PICTURE = 100_000_000
"""Bytes of the largest picture or PDF that is read."""
BUDGET = 2.0
"""Seconds of processor time for a page; the slowest of 471 given scans takes 1.9."""

__all__ = ["Examined", "Verdict", "Verification", "examine", "verify"]


def examine(
    path: str,
    given: Mapping[str, str] | None = None,
    copy: ListingCopy | None = None,
    seed: str = "",
) -> Examined:
    """A file (``-``: standard input), every printout in it judged; what cannot be read is told.
    ``copy``: the listing it is held against, in place of the restored one; ``seed``: what another
    reader made of a picture."""
    try:
        data = files.read_bytes(path, LARGEST_PICTURE)
    except UserError as error:
        return Examined(path, None, error=str(error))
    return examine_bytes(path, data, given, copy, seed)


def examine_bytes(
    path: str,
    data: bytes,
    given: Mapping[str, str] | None = None,
    copy: ListingCopy | None = None,
    seed: str = "",
) -> Examined:
    """The same of a file's bytes; ``path`` is what it is called."""
    digest = provenance.sha256(data)
    try:
        results = list(_verified(path, data, digest, given, copy, seed))
    except UserError as error:
        return Examined(path, digest, error=str(error))
    return Examined(path, digest, results)


def _verified(
    path: str,
    data: bytes,
    digest: str,
    given: Mapping[str, str] | None,
    copy: ListingCopy | None = None,
    seed: str = "",
) -> Iterator[Verification]:
    if data.startswith(PICTURE_STARTS):
        if given or copy:
            other = "a scene apart" if given else "a copy of the listing"
            raise UserError(f"{files.called(path)}: {other} goes with text, not with a picture")
        try:
            from .scanned import verified
        except ImportError as error:
            raise UserError(
                f"{files.called(path)}: pictures need {error.name}, which is not installed; "
                "pip install 'impact88[scan]'"
            ) from None
        for result in verified(path, data, seed):
            result.sha256 = digest
            yield completed(result)
        return
    if len(data) > LARGEST_FILE:
        raise UserError(f"{files.called(path)}: is larger than {LARGEST_FILE:,} bytes of text")
    where = files.called(path)
    text = decoded(data, where)
    pages = None
    if copy:
        from ..judging.copies import CopyPages

        pages = CopyPages(copy)
    text, lines, besides = pages.prepared(text) if pages else (text, [], {})
    every = read_printouts(text, where)
    begun, read = process_time(), 1
    for number, shown in enumerate(every, 1):
        read += not shown.fragment
        if process_time() - begun > BUDGET * read:
            shown.unread = f"this and what follows was not judged: over {BUDGET:g} s a page"
            yield unjudged(shown, path, number, digest)
            return
        end = shown.place(shown.stop)[0] if number < len(every) else len(lines)
        own = {line: besides.pop(line) for line in sorted(besides) if line <= end}
        result = verify(shown, path, number, given, pages, own)
        result.renumber(lines)
        result.sha256 = digest
        yield result


def unjudged(shown: Printout, file: str, number: int, digest: str) -> Verification:
    """A printout for which no time was left."""
    scene: dict[str, str | None] = dict.fromkeys(SCENE)
    return Verification(
        file, number, shown.line, Verdict.INCOMPLETE, scene, [], missing=list(SCENE),
        remarks=[shown.unread], start=shown.start, stop=shown.stop, sha256=digest,
    )  # fmt: skip


def verify(
    shown: Printout,
    file: str = "-",
    number: int = 1,
    given: Mapping[str, str] | None = None,
    pages: CopyPages | None = None,
    besides: Mapping[int, str] | None = None,
) -> Verification:
    """The verdict on one printout, with explanations where it differs.

    ``given``: texts of inputs by scene name, known from elsewhere than the printout. ``pages``:
    those of a copy of the listing, held against in place of the restored one's; ``besides``: lines
    that only the copy prints."""
    begun = process_time()

    def in_time() -> bool:
        return process_time() - begun < BUDGET

    recovered = recover(shown, given)
    if pages is not None:
        found = pages.judged(shown, recovered, besides or {})
        return completed(_against(pages, found, file, number), pages.outcomes)
    past = LookingPast(shown, recovered)
    better = None
    tried = recovered.row_in_doubt or bool(shown.mislabelled)
    if recovered.row_in_doubt:
        better = None if shown.mislabelled else past.judged()
        recovered = recovered if better else without_angles(recovered)
    found = judge(shown, recovered)
    late = []
    if found.verdict in (Verdict.DIFFERS, Verdict.INCOMPLETE) and not tried:
        if in_time():
            better = past.judged()
        elif shown.machine_read:
            found.verdict = Verdict.INCOMPLETE
            late = [f"what its reader misread was not sought: over {BUDGET:g} s"]
    result = _result(better or found, file, number)
    result.remarks += late
    if result.verdict is Verdict.DIFFERS:
        from ..explaining.explanations import explain

        # what was reread tries the page's inputs alone
        rereads = None if recovered.apart else past.rereads
        result.explanations = explain(found, rereads, in_time)
    if result.verdict is Verdict.INCOMPLETE and shown.badly_read and result.differing:
        result.remarks.append(
            f"{len(result.differing)} numbers are read otherwise than the program prints them, and "
            "the page is read too poorly to separate alterations from misreadings"
        )
    apart = [name for name in given or () if _not_printed(result, name)]
    result.findings = [
        *(wording.looked_past(result.fields, result.replies) if better else ()),
        *wording.findings(shown, result.fields, recovered),
        *wording.given_apart(apart, result.fields),
        *wording.given_otherwise(given or {}, result.scene, result.fields),
    ]
    return completed(result)


def _against(pages: CopyPages, found: Judged, file: str, number: int) -> Verification:
    """The verdict on a printout as a page of an office's copy of the listing."""
    result = _result(found, file, number)
    if result.verdict is Verdict.DIFFERS:
        from ..explaining.explanations import explain_copy

        result.explanations = explain_copy(found, pages.put_right)
    copy = pages.copy
    result.findings = wording.of_copy(copy, found, run_once(found.recovered.scene).fields)
    result.copy = {
        "file": copy.file,
        "sha256": copy.sha256,
        "lines": [line._asdict() for line in copy.changed_lines()],
    }
    return result


def _result(found: Judged, file: str, number: int) -> Verification:
    """What a judged printout's report says."""
    shown = found.shown
    scene = found.recovered.scene_or_missing()
    status = {check.name: check.status for check in found.fields}
    guessed = [
        name
        for name, text in scene.items()
        if text is not None
        and name != "M"
        and status.get("MUP" if name == "MU" else name) != Status.READ
    ]
    return Verification(
        file=file,
        number=number,
        line=shown.line,
        verdict=found.verdict,
        scene=scene,
        fields=found.fields,
        replies=found.replies,
        ending=found.ending,
        missing=found.recovered.missing,
        guessed=guessed,
        remarks=[*map(str, shown.remarks), *shown.notes, *filter(None, [shown.unread])],
        left_over=shown.left_over,
        labels=shown.labels,
        start=shown.start,
        stop=shown.stop,
        text=shown.page.text if shown.page else "",
    )


def completed(result: Verification, program: Program = run_all) -> Verification:
    """The same with what stands beside the verdict: what the page cannot show of what ``program``
    prints, exact values and warnings."""
    result.unseen = unseen(result.scene, result.missing, program)
    if result.runnable:
        scene = {name: text or "" for name, text in result.scene.items()}
        beside.add_exact_values(scene, result.fields)
        result.warnings = beside.warnings(scene)
    return result


def _not_printed(result: Verification, name: str) -> bool:
    """Whether an input was not read from the page; M is printed nowhere."""
    field = "MUP" if name == "MU" else name
    return any(check.name == field and check.printed is None for check in result.fields)
