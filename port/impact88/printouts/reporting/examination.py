"""Verification of pictures: the scene is recovered, replayed bit for bit, and every cell compared.

The verdict rests on what is printed alone; exact values and physical warnings are reported beside
it and never change it.
"""

from __future__ import annotations

from hashlib import sha256

from ... import files
from ...errors import UserError
from ..judging import beside
from ..judging.judgement import Verdict
from .verification import Examined, Verification

PICTURE_STARTS = (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"II*\x00", b"MM\x00*", b"%PDF-")
"""First bytes of PNG, JPEG, TIFF (of either byte order) and PDF files."""
__all__ = ["Examined", "Verdict", "Verification", "examine"]


def examine(path: str, *, data: bytes | None = None, seed: str = "") -> Examined:
    """Verify every printout in a picture or PDF.

    Parameters
    ----------
    path : str
        Name of the file in messages.
    data : bytes, optional
        The file, where it is read already.
    seed : str
        A person's reading of a picture, whose scene is tried without deciding anything.

    Returns
    -------
    Examined
        The verifications, or the error that kept the file from being read.
    """
    try:
        data = files.read_bytes(path) if data is None else data
    except UserError as error:
        return Examined(path, None, error=str(error))
    examination = Examined(path, sha256(data).hexdigest())
    try:
        from .scanned import verify_pages
    except ImportError as error:
        problem = f"pictures need {error.name}; pip install 'impact88[pictures]'"
        return Examined(path, examination.sha256, error=f"{files.display_name(path)}: {problem}")
    try:
        for result in verify_pages(path, data, seed):
            result.sha256 = examination.sha256
            if result.verdict is Verdict.DIFFERS and len(result.differing) == 1:
                (check,) = result.differing
                sentence = (
                    f"{check.name} is where the page differs from the program's; another number "
                    "altered, or misread, may lead to the same"
                )
                result.findings.append(sentence)
                result.rows.append(sentence)
            examination.results.append(add_information(result))
    except UserError as error:
        return Examined(path, examination.sha256, error=str(error))
    return examination


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
