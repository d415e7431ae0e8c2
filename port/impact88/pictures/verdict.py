"""The verdict on a page: that of its transcript as a text, gated by cells and marks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..errors import UserError
from ..printouts import VERDICTS, Kind, Verdict, Verification, judge
from ..printouts.page import REPLIES, RESULTS
from ..printouts.verdict import MAX_ALTERED
from .cells import BLANK
from .grid import grid_of
from .picture import Floats, Image, Page, ink_of, points_of, read_pages, resize
from .residue import marks_of
from .transcript import Cell, Transcript, altered_numbers, transcribe, unread_cells


@dataclass(frozen=True)
class PictureVerification:
    """A printout of a picture with its verdict.

    Parameters
    ----------
    page : int
        Number of the page in the file.
    verification : Verification
        The transcript's verification, with the verdict on the picture.
    boxes : tuple of ndarray, shape (4, 2)
        The place of each finding in the file's picture as it lies, pixels, clockwise.
    doubts : tuple of (Cell, ndarray)
        Cells in doubt, or that differ, with their places.
    marks : tuple of ndarray
        Places of ink that nothing explains.
    remarks : tuple of str
        Remarks on the page.
    grey : ndarray
        The page, reduced so that a cell is `grid.CELL_WIDTH` pixels wide.
    scale : float
        Pixels of the file per pixel of ``grey``.
    """

    page: int
    verification: Verification
    boxes: tuple[Floats, ...] = ()
    doubts: tuple[tuple[Cell, Floats], ...] = ()
    marks: tuple[Floats, ...] = ()
    remarks: tuple[str, ...] = ()
    grey: Image = field(default_factory=lambda: np.zeros((1, 1), np.float32), repr=False)
    scale: float = 1.0

    @property
    def verdict(self) -> Verdict:
        """The verdict on the picture."""
        return self.verification.verdict

    def places(self) -> dict[str, object]:
        """Return the page and the places of findings, cells in question and marks, for JSON."""
        return {
            "page": self.page,
            "boxes": [box.round(1).tolist() for box in self.boxes],
            "cells": [
                {**cell._asdict(), "box": box.round(1).tolist()} for cell, box in self.doubts
            ],
            "marks": [mark.round(1).tolist() for mark in self.marks],
        }


def verify_picture(
    source: bytes | str,
    name: str = "picture",
    pages: range | None = None,
    scene: Mapping[str, str] | None = None,
) -> list[PictureVerification]:
    """Verify the printouts in a picture or PDF.

    Parameters
    ----------
    source : bytes or str
        The file, or its path.
    name : str
        The file's name, for messages.
    pages : range, optional
        Numbers of the pages that are read, from 1; all by default.
    scene : mapping of str to str, optional
        Inputs known from elsewhere, for a page with results only.

    Returns
    -------
    list of PictureVerification
        One for each printout.

    Raises
    ------
    UserError
        If the file cannot be read, or no printout is found.
    """
    if isinstance(source, str):
        with open(source, "rb") as file:
            data = file.read()
        name = source
    else:
        data = source
    results: list[PictureVerification] = []
    for page in read_pages(data, name, pages):
        results += verify_page(page, scene)
    if not results:
        raise UserError(
            "no printout was found; expected lines of fixed pitch, 10 pixels a character", name
        )
    return results


def verify_page(
    page: Page, scene: Mapping[str, str] | None = None
) -> Iterator[PictureVerification]:
    """Yield the verification of each printout on a page."""
    layer = judge(page.text) if page.text.strip() else []
    transcribed = _transcribe_page(page, scene)
    if transcribed is None:
        return
    transcript, quarters = transcribed
    marks = marks_of(transcript.grid, transcript.filled_cells())
    for verification in _judge_transcript(transcript, marks, scene):
        result = _locate_findings(page, transcript, quarters, verification, marks)
        yield _compare_layer(result, layer.pop(0)) if layer else result


def _compare_layer(result: PictureVerification, layer: Verification) -> PictureVerification:
    """Return a verification, open where the text layer of a PDF has another number."""
    numbers = result.verification.numbers
    others = [
        f"{name} {number.read} for {numbers[name].printed}"
        for name, number in layer.numbers.items()
        if number.read and name in numbers and number.read != numbers[name].printed
    ]
    if not others:
        return result
    remark = "the text layer of the PDF does not agree with its picture: " + ", ".join(others)
    verdict = result.verdict if result.verdict is Verdict.DIFFERS else Verdict.INCOMPLETE
    verification = replace(result.verification, verdict=verdict)
    return replace(result, verification=verification, remarks=(*result.remarks, remark))


def _as_it_lies(points: Floats, quarters: int, size: tuple[int, int]) -> Floats:
    """Return where points of a page are before it was turned by quarters to the left.

    Parameters
    ----------
    points : ndarray, shape (points, 2)
        x and y on the turned page.
    quarters : int
        Quarter turns.
    size : tuple of int
        Height and width of the page as it lies.
    """
    x, y = points.T
    height, width = size
    turned = ((x, y), (width - y, x), (width - x, height - y), (y, height - x))[quarters]
    return np.stack(turned, axis=1)


def _transcribe_page(page: Page, scene: Mapping[str, str] | None) -> tuple[Transcript, int] | None:
    """Return the transcript of a page, and the quarter turn in which the program's rows fit best;
    None without lines of type."""
    ink = ink_of(page.grey)
    best: tuple[Transcript, int] | None = None
    for quarters in range(4):
        upright = np.ascontiguousarray(np.rot90(ink, quarters))
        grid = grid_of(upright, points_of(upright))
        if grid is None:
            continue
        transcript = transcribe(grid, scene)
        if best is None or transcript.gain > best[0].gain:
            best = transcript, quarters
        if transcript.sheets:
            break
    return best


def _judge_transcript(
    transcript: Transcript, marks: Sequence[Floats], scene: Mapping[str, str] | None
) -> Iterator[Verification]:
    """Yield the printouts of a transcript with the verdict on the picture."""
    text = transcript.text
    results = judge(text, scene)
    replies = [f for r in results for f in r.findings if f.name in REPLIES]
    if any(VERDICTS[reply.kind] is not Verdict.AS_READ for reply in replies):
        # a reply was typed by a person: it is not held against a page
        for reply in replies:
            text = _blank(text, reply.start, reply.stop)
        results = judge(text, scene)
    outside = transcript.text
    for result in results:
        outside = _blank(outside, *result.span)
    for result in results:
        verdict = _gate_verdict(result, transcript, marks)
        if verdict is Verdict.IDENTICAL and outside.strip():  # other text on the sheet
            verdict = Verdict.AS_READ
        yield replace(result, verdict=verdict)


def _blank(text: str, start: int, stop: int) -> str:
    """Return a text with a part blanked."""
    return text[:start] + BLANK * (stop - start) + text[stop:]


def _gate_verdict(result: Verification, transcript: Transcript, marks: Sequence[Floats]) -> Verdict:
    """Return the verdict on a picture: that of its text, held back by cells and marks.

    A page differs only if the numbers that differ have cells that do and no others have, no cell of
    an input is in doubt, and there are no more differences than an alteration has. It is identical
    only if the cells were measured against the numbers that the program prints. A row that is there
    twice was measured once; where labels are exchanged the program prints other numbers for the
    text than were measured, and cells of labels differ. Rows of a text may have been rearranged,
    those of a picture are as they were printed: one out of order differs if all else is exact.
    """
    first, last = (transcript.line_cell(offset)[0] for offset in result.span)
    cells = [cell for cell in transcript.cells if first <= cell.line <= last]
    doubts = [cell for cell in cells if cell.state == "doubt"]
    differing = [cell for cell in cells if cell.state == "differs"]
    in_doubt = unread_cells(cells)
    altered = altered_numbers(cells)
    printed = _printed_numbers(result)
    is_measured = any(_printed_numbers(sheet) == printed for sheet in transcript.sheets)
    verdict = result.verdict
    if {finding.kind for finding in result.findings} == {Kind.DISORDER}:
        verdict = Verdict.DIFFERS
    if verdict is Verdict.DIFFERS:
        adverse = {f.name for f in result.findings if VERDICTS[f.kind] is Verdict.DIFFERS}
        numbers = {f.name for f in result.findings if f.kind is Kind.NUMBER}
        is_twice = any(f.kind is Kind.ROW_TWICE for f in result.findings)
        is_odd = not altered <= adverse
        if is_measured:
            is_odd |= not numbers <= altered and not is_twice
        else:
            is_odd |= all(cell.name for cell in differing)
        is_odd |= any(cell.name not in RESULTS for cell in in_doubt)
        is_odd |= len({cell.name or cell for cell in differing}) > MAX_ALTERED
        return Verdict.INCOMPLETE if is_odd else verdict
    if verdict in (Verdict.IDENTICAL, Verdict.AS_READ):
        if in_doubt or altered or not is_measured:
            return Verdict.INCOMPLETE
        if doubts or differing or marks:
            return Verdict.AS_READ
    return verdict


def _printed_numbers(result: Verification) -> dict[str, str]:
    return {name: number.printed for name, number in result.numbers.items()}


def _remarks(
    transcript: Transcript, verification: Verification, marks: Sequence[Floats]
) -> Iterator[str]:
    """Yield sentences on cells in doubt and on marks."""
    names = {finding.name for finding in verification.findings}
    for cell in transcript.cells:
        if cell.state == "holds" or (cell.name and cell.name in names):
            continue
        like = "blank paper" if cell.other == BLANK else repr(cell.other)
        place = f"line {cell.line + 1}, column {cell.cell + 1}"
        yield f"{place}: {cell.name or 'a label'}, {cell.predicted!r} is more like {like}"
    first, stop = verification.span
    outside = transcript.text[:first] + transcript.text[stop:]
    if len(transcript.sheets) < 2 and outside.strip():
        yield f"other text on the sheet: {' '.join(outside.split())!r}"
    if marks:
        yield f"ink that the program does not print, at {len(marks)} places: pen, stamp or specks"


def _locate_findings(
    page: Page,
    transcript: Transcript,
    quarters: int,
    verification: Verification,
    marks: Sequence[Floats],
) -> PictureVerification:
    """Return a verification with the places of its findings in the file's picture."""
    grid = transcript.grid
    size = page.grey.shape[0], page.grey.shape[1]

    def corners(line: int, cell: int, stop: int) -> Floats:
        return page.scale * _as_it_lies(grid.corners(line, cell, stop), quarters, size)

    boxes = []
    for finding in verification.findings:
        line, cell = transcript.line_cell(finding.start)
        stop = max(cell + 1, min(cell + finding.stop - finding.start, grid.count))
        boxes.append(corners(min(line, len(grid.middles) - 1), cell, stop))
    doubts = [
        (cell, corners(cell.line, cell.cell, cell.cell + 1))
        for cell in transcript.cells
        if cell.state != "holds"
    ]
    return PictureVerification(
        page.number,
        verification,
        tuple(boxes),
        tuple(doubts),
        tuple(page.scale * _as_it_lies(mark, quarters, size) for mark in marks),
        tuple(_remarks(transcript, verification, marks)),
        resize(page.grey, grid.scale),
        page.scale / grid.scale,
    )
