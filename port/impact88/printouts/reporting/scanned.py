"""Scans and photographs of printouts, verified from their pictures."""

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import takewhile
from typing import Any

import numpy as np

from ...errors import UserError
from ...files import display_name
from ...names import SCENE
from ..fields import FIELDS, REPLIES
from ..judging.copies import CopyPages, as_printed, converted_inputs
from ..judging.judgement import FieldCheck, Status, Verdict, status_of
from ..reading.differences import Difference, Kind
from ..reading.printout import read_printouts
from ..scan.cleaning import Paper, papers_of
from ..scan.exhibit import exhibit
from ..scan.grid import Grid
from ..scan.holding import Added, Cell, Objection, appearance, cells_text, state
from ..scan.ink import Floats
from ..scan.layout import Place
from ..scan.picture import Page, pages_of
from ..scan.residue import Mark
from ..scan.scenes import scenes_in
from ..scan.sheets import Leaf, read_page
from ..scan.typeface import BLANK
from .verification import Verification, name_of


def verify_pages(
    path: str, data: bytes, seed: str = "", copy: CopyPages | None = None
) -> Iterator[Verification]:
    """Yield the verification of each printout in a picture or PDF. ``seed``: a person's reading,
    whose scenes are tried without deciding anything; ``copy``: the listing that prints it, in place
    of the restored one. Raises UserError when no printout is found."""
    results: list[Verification] = []
    without, causes = list[int](), ""
    seeds = scenes_in(seed)
    for page in pages_of(data, path):
        page_results: list[Verification] = []
        unread = 0
        for paper in papers_of(page.picture):
            scenes = [*seeds, *scenes_in(page.text)]
            leaves, tried = read_page(paper, scenes, copy)
            unread += not leaves
            causes = causes or ("" if leaves else "; ".join([*paper.remarks, tried]))
            for leaf in leaves:
                number = len(results) + len(page_results) + 1
                result = _verification(path, number, page, paper, leaf, copy)
                result.exhibit = partial(exhibit, paper.grey, leaves, leaf)
                result.remarks += [f"page {page.number}: {remark}" for remark in paper.remarks]
                page_results.append(result)
        if page_results and unread:
            remark = f"no printout was found on {unread} of the sheets it shows"
            page_results[0].remarks.append(f"page {page.number}: {remark}")
        if page.text.strip():
            _compare_text_layer(page_results, page.text)
        if not page_results:
            without.append(page.number)
        results += page_results
    if not results:
        raise UserError(
            f"{display_name(path)}: no printout was found in the picture; expected lines of fixed "
            f"pitch, 10 pixels or more a character ({causes})"
        )
    if without:
        pages = ", ".join(map(str, without))
        results[0].remarks.append(f"no printout was found on page {pages} of the file")
    yield from results


def _compare_text_layer(results: list[Verification], text: str) -> None:
    """Compare a PDF's text layer with its picture: one that has another number is reported, and
    leaves the verdict open."""
    try:
        layer = [printout for printout in read_printouts(text) if not printout.fragment]
    except UserError:
        layer = []
    if len(layer) != len(results):
        for result in results:
            result.remarks.append(f"page {result.page}: no such printout is in its text layer")
        return
    for result, page in zip(results, layer, strict=True):
        disagreements = [
            f"{check.name} {page.text(check.name)} for {check.printed}"
            for check in result.fields
            if page.text(check.name) is not None and page.text(check.name) != check.printed
        ]
        if disagreements:
            result.remarks.append(
                f"page {result.page}: its text layer does not agree with its picture: "
                + ", ".join(disagreements)
            )
            result.verdict = Objection.DISAGREEING.overrule(result.verdict)


def _verification(
    path: str, number: int, page: Page, paper: Paper, leaf: Leaf, copy: CopyPages | None
) -> Verification:
    is_decided = leaf.judged.verdict is not Verdict.INCOMPLETE
    by_name = leaf.by_name
    texts = {name: cells_text(cells) for name, cells in by_name.items()} if is_decided else {}
    text, starts = leaf.read.page(texts)
    program_fields = leaf.found.outcome.fields if leaf.found else {}
    scene: dict[str, str | None] = dict.fromkeys(SCENE)
    is_converted = False
    if leaf.found and is_decided:
        scene |= {name: leaf.found.scene[name] for name in SCENE}
        if copy:
            scene |= as_printed(leaf.found.scene, program_fields)
            is_converted = bool(converted_inputs(leaf.found.scene, program_fields))
    fields = [
        _check(leaf, name, program_fields.get(name), by_name.get(name, []))
        for name in FIELDS
        if name in program_fields or name in leaf.read.costs
    ]
    line = min((leaf.grid.number(row.start) for row in leaf.read.sheet.rows.values()), default=1)
    result = Verification(path, number, line, leaf.judged.verdict, scene, fields)
    result.converted = is_converted
    result.replies, result.page = [*_replies(leaf)], page.number
    result.text, result.stop = text, len(text)
    for check in result.fields:
        if check.printed and check.name in starts:
            check.start = starts[check.name]
            check.stop = check.start + len(check.printed)
    result.cells = [
        _cell_as_json(cell, page, paper, leaf.grid)
        for cell in leaf.cells  # blanks and matching labels are left out
        if (cell.name and cell.predicted != BLANK) or state(cell) != "holds"
    ]
    result.marks = [_mark_as_json(mark, page, paper, leaf.grid) for mark in leaf.marks]
    result.remarks += [*filter(None, [leaf.judged.reason]), *leaf.hurt]
    result.findings += leaf.exchanged
    result.rows = [*leaf.exchanged, *leaf.hurt]
    result.findings += [
        f"{_where(cell.place, leaf.grid)}: {name_of(cell.name)} {appearance(cell)}"
        for cell in leaf.judged.differing
        if cell.added is not Added.CHARACTER  # a mark
    ]
    result.findings += [
        f"{_where(mark.place, leaf.grid)}: the typed text {mark.reads!r} gives "
        f"{claim.label} {claim.typed}, where the program prints {claim.printed}"
        for mark in leaf.marks
        for claim in mark.claims
    ]
    return result


def _where(place: Place | None, grid: Grid) -> str:
    assert place is not None
    return f"line {grid.number(place.line)}, column {place.cell + 1}"


def _check(leaf: Leaf, name: str, recomputed: str | None, cells: Sequence[Cell]) -> FieldCheck:
    kinds = {"doubtful": Kind.PICTURE, "differs": Kind.CONTRADICTS}
    differences = [
        Difference(
            kinds[state(cell)], name, cell.other, cell.predicted,
            leaf.grid.number(cell.place.line), cell.place.cell + 1, 0, 0,
        )
        for cell in cells
        if state(cell) in kinds
    ]  # fmt: skip
    status = status_of(differences)
    if leaf.judged.verdict is Verdict.INCOMPLETE and status is Status.CONTRADICTED:
        status = Status.NOT_COMPARED
    elif recomputed is None or not cells:
        status = Status.NOT_READ
    check = FieldCheck(name, cells_text(cells) or None, recomputed, status, doubts=differences)
    if cells:
        check.line, check.column = leaf.grid.number(cells[0].place.line), cells[0].place.cell + 1
    return check


def _replies(leaf: Leaf) -> Iterator[FieldCheck]:
    for side, names in REPLIES.items() if leaf.found else ():
        cells = iter(leaf.by_name.get(f"REPLY_{side}", []))
        for name in names:
            part = list(takewhile(lambda cell: cell.predicted != ",", cells))
            if part:
                yield _check(leaf, name, "".join(cell.predicted for cell in part), part)


def _box(corners: Floats, page: Page, paper: Paper, turns: int) -> list[float]:
    """Return left, top, right, bottom of a region of the upright sheet in the file's picture as it
    lies, in pixels."""
    x, y = corners.T
    height, width = paper.grey.shape
    x, y = ((x, y), (width - y, x), (width - x, height - y), (y, height - x))[turns]
    x, y = page.scale * paper.place(np.stack([x, y], axis=-1)).T
    return [round(float(v), 1) for v in (x.min(), y.min(), x.max(), y.max())]


def _mark_as_json(mark: Mark, page: Page, paper: Paper, grid: Grid) -> dict[str, Any]:
    """Return a mark as JSON; ``line`` and ``cell`` from 1, where it is on the grid."""
    return {
        "page": page.number,
        "box": _box(mark.corners, page, paper, grid.turns),
        "kind": str(mark.kind),
        "reads": mark.reads,
        "line": grid.number(mark.place.line) if mark.place else None,
        "cell": mark.place.cell + 1 if mark.place else None,
        "touches": mark.touches,
        "beside": mark.beside,
        "bears": mark.bears,
        "contradicts": [claim.label for claim in mark.claims],
    }


def _cell_as_json(cell: Cell, page: Page, paper: Paper, grid: Grid) -> dict[str, Any]:
    """Return a cell as JSON; ``box``: left, top, right, bottom in the picture as it lies, in
    pixels."""
    return {
        "page": page.number,
        "box": _box(grid.around(*cell.place), page, paper, grid.turns),
        "line": grid.number(cell.place.line),
        "column": cell.place.cell + 1,
        "field": cell.name or None,
        "predicted": cell.predicted,
        "state": state(cell),
        "appearance": "" if state(cell) == "holds" else appearance(cell),
        "margin": round(cell.margin, 3),
        "runner_up": cell.other,
        "distance": round(cell.distance, 2),
        "cells_of_predicted": cell.count,
        "cells_of_runner_up": cell.other_count,
    }
