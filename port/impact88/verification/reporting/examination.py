"""Verifying a printout: recover the scene it prints, replay it bit for bit, compare every digit.

The verdict rests on printed digits alone; what exact arithmetic gives and physical warnings stand
beside it and never change it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from hashlib import sha256
from operator import attrgetter
from time import process_time
from typing import TYPE_CHECKING, Any, overload

from ... import files
from ...collision.fields import scene_name
from ...collision.mappings import texts
from ...errors import UserError, quoted
from ...messages.arguments import explains_arguments
from ..judging import beside
from ..judging.judgement import Judged, Status, Verdict, judge, looked_past
from ..judging.readings import judged_together, matching
from ..reading.plaintext import decode
from ..reading.printout import LARGEST_FILE, Printout, read_printouts
from ..recovery.recovered import recover, without_angles
from ..recovery.slips import Rereading
from . import verification
from .verification import Examined, Verification, Verifications

if TYPE_CHECKING:
    from ...program.emulated import ListingCopy
    from ..judging.copies import CopyPages

PICTURE_STARTS = (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"II*\x00", b"MM\x00*", b"%PDF-")
"""How PNG, JPEG, TIFF (of either byte order) and PDF files begin."""
LARGEST_PICTURE = 100_000_000
"""Bytes of the largest picture or PDF that is read."""
MOST_ALTERED = 2
"""Changes that are an alteration, on a page that a machine read: 28 of 28 readings of given pages
with one altered digit are explained by so many, 10 of 17 genuine ones that differed by none."""
BUDGET = 2.0
"""Seconds of processor time after which no slower causes are tried; the slowest of 471 given scans
takes 1.9."""

__all__ = ["Examined", "Verdict", "Verification", "Verifications", "examine", "verify"]


def examine(
    path: str,
    given: Mapping[str, str] | None = None,
    copy: ListingCopy | None = None,
    seed: str | Sequence[str] = "",
    data: bytes | None = None,
) -> Examined:
    """A file (``-``: standard input), every printout in it judged; what cannot be read is told.
    ``given``: texts of inputs by scene name, known from elsewhere; ``copy``: the listing it is held
    against, in place of the restored one; ``seed``: what other readers made of it, of a picture or
    of the paper that a text is a reading of; ``data``: the file's bytes where they are known."""
    examined = Examined(path, None)
    try:
        data = files.read_bytes(path, LARGEST_PICTURE) if data is None else data
        examined.sha256 = sha256(data).hexdigest()
        picture = data.startswith(PICTURE_STARTS)
        if picture and given:
            raise UserError(
                "a scene apart goes with text, not with a picture", files.display_name(path)
            )
        seeds = [text for text in ([seed] if isinstance(seed, str) else seed) if text]
        if seeds and copy:
            raise UserError(
                "other readings go without a copy of the listing", files.display_name(path)
            )
        found = (
            _pictured(path, data, copy, seeds)
            if picture
            else _printed(path, data, given, copy, seeds)
        )
        for result in found:
            result.sha256 = examined.sha256
            examined.results.append(result)
    except UserError as error:
        return Examined(path, examined.sha256, error=str(error))
    return examined


def _pictured(
    path: str, data: bytes, copy: ListingCopy | None, seeds: Sequence[str]
) -> Iterator[Verification]:
    try:
        from .scanned import verified
    except ImportError as error:
        said = f"pictures need {error.name}, which is not installed; pip install 'impact88[scan]'"
        raise UserError(said, files.display_name(path)) from None
    if not copy:
        return map(completed, verified(path, data, seeds))
    from ..judging.copies import pages_of

    pages = pages_of(copy)
    pages.check_layout()
    return (_of_copy(result, pages) for result in verified(path, data, seeds, pages))


def _printed(
    path: str,
    data: bytes,
    given: Mapping[str, str] | None,
    copy: ListingCopy | None,
    seeds: Sequence[str],
) -> Iterator[Verification]:
    where = files.display_name(path)
    if len(data) > LARGEST_FILE:
        raise UserError(f"is larger than {LARGEST_FILE:,} bytes of text", where)
    text = decode(data, where)
    if copy:
        from ..judging.copies import pages_of

        pages = pages_of(copy)
        text, lines, besides = pages.prepared(text)
    every = read_printouts(text, where)
    others = [_readings(other) for other in seeds]
    for number, paper in enumerate(every, 1):
        if copy:
            end = paper.page.place(paper.stop)[0] if number < len(every) else len(lines)
            own = {line: besides.pop(line) for line in sorted(besides) if line <= end}
            result = _against(pages, pages.judged(paper, recover(paper, given), own))
            result.renumber(lines)
        else:
            result = _verified(paper, given)
            if seeds and result.verdict is not Verdict.IDENTICAL:
                result = _by_all(result, [paper, *matching(paper, others)], given)
        result.file, result.number = path, number
        yield result


@overload
def verify(printout: Printout, given: Mapping[str, Any] | None = None) -> Verification: ...
@overload
def verify(
    printout: str | bytes | os.PathLike[str], given: Mapping[str, Any] | None = None
) -> Verifications: ...
@explains_arguments
def verify(
    printout: Printout | str | bytes | os.PathLike[str], given: Mapping[str, Any] | None = None
) -> Verification | Verifications:
    """Say of each printout whether it is what the 1988 program prints, and if not, why.

    Parameters
    ----------
    printout : str, bytes, os.PathLike or Printout
        A text (a str of more than one line), a file's name, or its bytes, with any number of
        printouts in it: text, or a picture or PDF of pages. Or one printout of
        `impact88.read_printouts`.
    given : mapping, optional
        Inputs known from elsewhere than the paper: texts or numbers by the scene's names, with
        units or without.

    Returns
    -------
    Verifications or Verification
        A list with the verdict on each printout, which a notebook shows whole; of one of
        `read_printouts` its verdict.

    Raises
    ------
    UserError
        For a file that cannot be read or holds no printout.

    Notes
    -----
    The inputs on the page are recovered, the listing is run with them in Applesoft's arithmetic,
    and every digit and label is compared. Text that is none of the program's is listed, and bars
    `Verdict.IDENTICAL` where it holds a figure or a label, or stands beside a number.

    Examples
    --------
    >>> import impact88
    >>> page = impact88.run(impact88.sample(1)).page
    >>> [found.verdict.name for found in impact88.verify(page)]
    ['IDENTICAL']
    """
    known = None if given is None else texts(given)
    if isinstance(printout, Printout):
        return _verified(printout, known)
    if isinstance(printout, str) and "\n" in printout:
        printout = printout.encode("utf-8", files.ESCAPED)
    if isinstance(printout, bytes):
        found = examine("text", known, data=printout)
    elif isinstance(printout, str | os.PathLike):
        found = examine(os.fspath(printout), known)
    else:
        raise UserError(f"{quoted(printout)}: expected a printout's text, a file's name or bytes")
    if found.error:
        raise UserError(found.error)
    return Verifications(found.results)


def _verified(paper: Printout, given: Mapping[str, str] | None) -> Verification:
    """The verdict on one printout, with explanations where it differs."""
    begun, recovered = process_time(), recover(paper, given)
    in_doubt = recovered.row_in_doubt
    rereading = Rereading(recovered, apart=True)
    found, better = judge(paper, recovered), None
    wrong = in_doubt or found.verdict in (Verdict.DIFFERS, Verdict.INCOMPLETE)
    if wrong and not paper.mislabelled:
        better = looked_past(found, rereading)
    if in_doubt and not better:
        found = judge(paper, without_angles(recovered))
    result = _result(better or found)
    if result.verdict is Verdict.DIFFERS:
        from ..explaining.explanations import explain

        result.explanations = explain(found, rereading, lambda: process_time() - begun < BUDGET)
        altered = any(len(cause.changes) <= MOST_ALTERED for cause in result.explanations[:1])
        if paper.machine_read and not altered and not paper.mislabelled:
            result.verdict, result.explanations = Verdict.INCOMPLETE, []
    if result.verdict is Verdict.INCOMPLETE and paper.machine_read and result.differing:
        result.remarks.append(
            f"{len(result.differing)} numbers are read otherwise than the program prints them, and "
            "the page is read too poorly to separate alterations from misreadings"
        )
    result.findings = [
        *(verification.put_down(better) if better else ()),
        *verification.findings(better or found),
        *verification.given_apart(given or {}, result),
    ]
    return completed(result)


def _readings(text: str) -> list[Printout]:
    """The printouts in another reading; none where it holds none."""
    try:
        return read_printouts(text)
    except UserError:
        return []


def _by_all(
    result: Verification, papers: Sequence[Printout], given: Mapping[str, str] | None
) -> Verification:
    """The verdict on a printout by several readings of it. It is accused only where each accuses it
    by itself."""
    found = judged_together(papers, given)
    if found is None:
        if len(papers) < 2:
            result.remarks.append("no other reading given holds this printout")
        return result
    if found.verdict is Verdict.DIFFERS:
        alone = [result, *(_verified(paper, given) for paper in papers[1:])]
        if all(other.verdict is Verdict.DIFFERS for other in alone):
            return result
        found.verdict = Verdict.INCOMPLETE
    together = _result(found)
    together.findings = [
        f"read {len(papers)} times: what one reading supports, another does not contradict",
        *verification.findings(found),
        *verification.given_apart(given or {}, together),
    ]
    return completed(together)


def _against(pages: CopyPages, found: Judged) -> Verification:
    """The verdict on a printout as a page of an office's copy of the listing."""
    result = _result(found)
    if result.verdict is Verdict.DIFFERS:
        from ..explaining.explanations import explain_copy

        result.explanations = explain_copy(found, pages.put_right)
    result.converted = bool(found.recovered.typed)
    return _of_copy(result, pages)


def _of_copy(result: Verification, pages: CopyPages) -> Verification:
    """The same with what the copy is, and what stands beside the verdict."""
    copy = pages.copy
    result.findings += verification.of_copy(copy, result)
    changed = [line._asdict() for line in copy.changed_lines()]
    result.copy = {"file": copy.file, "sha256": copy.sha256, "lines": changed}
    if result.converted:  # the scene is as printed, and the copy asks for it as typed
        return completed(result)
    return completed(result, pages.run_columns)


def _result(found: Judged) -> Verification:
    paper, scene = found.paper, found.recovered.scene_or_missing()
    read = {scene_name(check.name) for check in found.fields if check.status == Status.READ}
    guessed = [
        name for name, text in scene.items() if text is not None and name not in {"M", *read}
    ]
    return Verification(
        "-", 1, paper.line, found.verdict, scene, found.fields, found.replies, found.ending,
        missing=found.recovered.missing, guessed=guessed,
        remarks=[*map(str, paper.remarks), *paper.notes, *filter(None, [paper.unread])],
        left_over=sorted([*paper.left_over, *found.notes], key=attrgetter("start")),
        labels=paper.labels, start=paper.start, stop=paper.stop,
        text=paper.page.text if paper.page else "",
    )  # fmt: skip


def completed(result: Verification, *program: beside.Program) -> Verification:
    """The same with what stands beside the verdict: what the page cannot show of what ``program``,
    by default the restored listing, prints, exact values and warnings."""
    if scene := result.complete_scene:
        printed = {check.name: check.recomputed or "" for check in result.fields}
        result.unseen = beside.unseen(scene, printed, *program)
        beside.add_exact_values(scene, result.fields)
        result.warnings = beside.warnings(scene)
    return result
