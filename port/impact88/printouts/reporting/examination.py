"""Verification of a printout: recover the scene, replay it bit for bit, compare every digit.

The verdict rests on what is printed alone; exact values and physical warnings are reported beside
it and never change it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from hashlib import sha256
from operator import attrgetter
from typing import TYPE_CHECKING, Any, overload

from ... import files
from ...collision.fields import scene_name
from ...collision.mappings import texts
from ...errors import UserError, quoted
from ...messages.arguments import explains_arguments
from ..judging import beside
from ..judging.judgement import Judged, Status, Verdict, is_alteration, judge
from ..judging.reader import attribute_to_reader
from ..reading.plaintext import decode
from ..reading.printout import LARGEST_FILE, Printout, read_printouts
from ..recovery.recovered import recover, without_angles
from ..recovery.rereading import Rereading
from ..recovery.slips import DIGIT
from . import verification
from .verification import Examined, Verification, Verifications

if TYPE_CHECKING:
    from ...program.copies import ListingCopy
    from ..judging.copies import CopyPages

PICTURE_STARTS = (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"II*\x00", b"MM\x00*", b"%PDF-")
"""First bytes of PNG, JPEG, TIFF (of either byte order) and PDF files."""
LARGEST_PICTURE = 100_000_000  # bytes of a picture or PDF
__all__ = ["Examined", "Verdict", "Verification", "Verifications", "examine", "verify"]


def examine(
    path: str,
    given: Mapping[str, str] | None = None,
    copy: ListingCopy | None = None,
    seed: str = "",
    data: bytes | None = None,
) -> Examined:
    """Verify every printout in a file.

    Parameters
    ----------
    path : str
        Name of the file, ``-`` for standard input.
    given : mapping of str to str, optional
        Texts of inputs known from elsewhere, by scene name.
    copy : ListingCopy, optional
        Copy of the listing to compare with, in place of the restored one.
    seed : str
        A person's reading of a picture, whose scene is tried without deciding anything.
    data : bytes, optional
        The file's bytes, where they are known.

    Returns
    -------
    Examined
        The verifications, or the error that kept the file from being read.
    """
    examination = Examined(path, None)
    try:
        data = files.read_bytes(path, LARGEST_PICTURE) if data is None else data
        examination.sha256 = sha256(data).hexdigest()
        picture = data.startswith(PICTURE_STARTS)
        if picture and given:
            raise UserError(
                "a scene apart goes with text, not with a picture", files.display_name(path)
            )
        verifications = (
            _verify_picture(path, data, copy, seed)
            if picture
            else _verify_text(path, data, given, copy)
        )
        for result in verifications:
            result.sha256 = examination.sha256
            examination.results.append(result)
    except UserError as error:
        return Examined(path, examination.sha256, error=str(error))
    return examination


def _verify_picture(
    path: str, data: bytes, copy: ListingCopy | None, seed: str
) -> Iterator[Verification]:
    try:
        from .scanned import verify_pages
    except ImportError as error:
        problem = (
            f"pictures need {error.name}, which is not installed; pip install 'impact88[scan]'"
        )
        raise UserError(problem, files.display_name(path)) from None
    if not copy:
        return (add_information(_with_ties(result)) for result in verify_pages(path, data, seed))
    from ..judging.copies import pages_of

    pages = pages_of(copy)
    pages.check_layout()
    return (_add_copy(result, pages) for result in verify_pages(path, data, seed, pages))


def _with_ties(result: Verification) -> Verification:
    """Say of a picture which other digits would explain its page as well as the one that differs:
    its cells were compared with the page of one scene."""
    if result.verdict is not Verdict.DIFFERS or len(result.differing) != 1:
        return result
    from ..explaining.explanations import explain

    try:
        (paper,) = read_printouts(result.text)
    except (UserError, ValueError):
        return result
    scene = recover(paper)
    causes = explain(judge(paper, scene), Rereading(scene, apart=True))
    changes = [cause.right[0] for cause in causes if cause.rank == 1 and len(cause.right) == 1]
    (check,) = result.differing
    would_be = {f"{check.name} {check.printed}": [check.recomputed or ""]}
    for change in changes:
        if change.kind == DIGIT:
            texts = would_be.setdefault(f"{change.field} {change.printed}", [])
            texts += [change.would_be] * (change.would_be not in texts)
    if sum(map(len, would_be.values())) > 1:
        numbers = [
            f"{number} (would be {' or '.join(texts)})" for number, texts in would_be.items()
        ]
        listed = " or ".join(filter(None, [", ".join(numbers[:-1]), numbers[-1]]))
        sentence = f"the page does not show which number is altered: {listed}"
        result.findings.append(sentence)
        result.rows.append(sentence)
    return result


def _verify_text(
    path: str,
    data: bytes,
    given: Mapping[str, str] | None,
    copy: ListingCopy | None,
) -> Iterator[Verification]:
    file_name = files.display_name(path)
    files.check_text(data, file_name)
    if len(data) > LARGEST_FILE:
        raise UserError(f"is larger than {LARGEST_FILE:,} bytes of text", file_name)
    text = decode(data, file_name)
    if copy:
        from ..judging.copies import pages_of

        pages = pages_of(copy)
        text, lines, besides = pages.prepare(text)
    printouts = read_printouts(text, file_name)
    for number, paper in enumerate(printouts, 1):
        if copy:
            end = paper.page.place(paper.stop)[0] if number < len(printouts) else len(lines)
            copy_lines = {line: besides.pop(line) for line in sorted(besides) if line <= end}
            result = _verify_by_copy(pages, pages.judge(paper, recover(paper, given), copy_lines))
            result.renumber(lines)
        else:
            result = _verify_printout(paper, given)
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
    and every digit, label and mark is compared. Text that is none of the program's is listed, and
    bars `Verdict.IDENTICAL` where it stands between the first and the last line, or holds a label.

    Examples
    --------
    >>> import impact88
    >>> page = impact88.run(impact88.sample(1)).page
    >>> [found.verdict.name for found in impact88.verify(page)]
    ['IDENTICAL']
    """
    given_texts = None if given is None else texts(given)
    if isinstance(printout, Printout):
        return _verify_printout(printout, given_texts)
    if isinstance(printout, str) and "\n" in printout:
        printout = printout.encode("utf-8", files.ESCAPED)
    if isinstance(printout, bytes):
        examination = examine("text", given_texts, data=printout)
    elif isinstance(printout, str | os.PathLike):
        examination = examine(os.fspath(printout), given_texts)
    else:
        raise UserError(f"{quoted(printout)}: expected a printout's text, a file's name or bytes")
    if examination.error:
        raise UserError(examination.error)
    return Verifications(examination.results)


def _verify_printout(paper: Printout, given: Mapping[str, str] | None) -> Verification:
    """Return the verification of one printout, with explanations where it differs."""
    scene = recover(paper, given)
    in_doubt = scene.row_in_doubt
    rereading = Rereading(scene, apart=True)
    judgement, attributed = judge(paper, scene), None
    is_open = in_doubt or judgement.verdict in (Verdict.DIFFERS, Verdict.INCOMPLETE)
    if is_open and not paper.is_of_another_form:
        attributed = attribute_to_reader(judgement, rereading)
    if in_doubt and not attributed:
        judgement = judge(paper, without_angles(scene))
    result = _result(attributed or judgement)
    if result.verdict is Verdict.DIFFERS:
        from ..explaining.explanations import explain

        result.explanations = explain(judgement, rereading)
        if not is_alteration(judgement, [len(cause.changes) for cause in result.explanations]):
            result.verdict, result.explanations = Verdict.INCOMPLETE, []
    if result.verdict is Verdict.INCOMPLETE and paper.machine_read and result.differing:
        verb = (
            "1 number is" if len(result.differing) == 1 else f"{len(result.differing)} numbers are"
        )
        result.remarks.append(
            f"{verb} read otherwise than the program prints for the inputs as read, and the page "
            "is read too poorly to separate alterations from misreadings"
        )
    result.findings = [
        *(verification.attributed_digits(attributed) if attributed else ()),
        *verification.findings(attributed or judgement),
        *verification.given_findings(given or {}, result),
    ]
    return add_information(result)


def _verify_by_copy(pages: CopyPages, found: Judged) -> Verification:
    """Return the verification of a printout as a page of an office's copy of the listing."""
    result = _result(found)
    if result.verdict is Verdict.DIFFERS:
        from ..explaining.explanations import explain_copy

        result.explanations = explain_copy(found, pages.rejudge)
    result.converted = bool(found.recovered.typed)
    return _add_copy(result, pages)


def _add_copy(result: Verification, pages: CopyPages) -> Verification:
    """Add the copy of the listing, and the information beside the verdict."""
    copy = pages.copy
    result.findings += verification.copy_findings(copy, result)
    changed_lines = [line._asdict() for line in copy.changed_lines()]
    result.copy = {"file": copy.file, "sha256": copy.sha256, "lines": changed_lines}
    if result.converted:  # the scene is as printed, and the copy asks for it as typed
        return add_information(result)
    return add_information(result, pages.run_columns)


def _result(found: Judged) -> Verification:
    paper, scene = found.paper, found.recovered.scene_or_missing()
    read_names = {scene_name(check.name) for check in found.fields if check.status == Status.READ}
    guessed_names = [
        name for name, text in scene.items() if text is not None and name not in {"M", *read_names}
    ]
    return Verification(
        "-", 1, paper.line, found.verdict, scene, found.fields, found.replies, found.ending,
        missing=found.recovered.missing, guessed=guessed_names,
        remarks=[*map(str, paper.remarks), *paper.notes, *filter(None, [paper.unread])],
        left_over=sorted([*paper.left_over, *found.notes], key=attrgetter("start")),
        labels=paper.labels, start=paper.start, stop=paper.stop, text=paper.page.text,
        rows=[*paper.exchanged, *paper.repeated], characters=found.characters(),
    )  # fmt: skip


def add_information(result: Verification, *program: beside.Program) -> Verification:
    """Add the information beside the verdict: errors that the page could not reveal, exact values
    and warnings. ``program``: the program that printed it, by default the restored listing."""
    if scene := result.complete_scene:
        # a digit that is repeated at a prompt would show there
        replied = {check.name for check in result.replies if check.same is not None}
        program_fields = {
            check.name: check.recomputed or ""
            for check in result.fields
            if check.name not in replied
        }
        result.unseen = beside.unseen(scene, program_fields, *program)
        beside.add_exact_values(scene, result.fields)
        result.warnings = beside.warnings(scene)
    return result
