"""Pages with a known text: genuine ones are never called different, altered ones never pass."""

from __future__ import annotations

import numpy as np
import pytest
from typedpages import CELL, LEADING, draw, encode, scan

import impact88
from impact88.pictures import PictureVerification, verify_picture
from impact88.pictures.exhibit import draw_page
from impact88.pictures.verdict import _compare_layer
from impact88.printouts import Verdict, judge

MARGIN = 60
PAGE = "\n".join(line for line in impact88.run(impact88.sample(1)).page.split("\n") if line.strip())
RESULTS = PAGE.split("\n")[-4:-2]
SETTLED = {Verdict.IDENTICAL, Verdict.AS_READ}


def read(grey: np.ndarray) -> PictureVerification:
    """Return the one printout of a page."""
    (result,) = verify_picture(encode(grey))
    return result


def place(text: str) -> tuple[int, int]:
    """Return the row and column of a text on the page."""
    before = PAGE[: PAGE.index(text)]
    return before.count("\n"), len(before) - before.rfind("\n") - 1


def corner(text: str) -> tuple[int, int]:
    """Return the top left pixel of a text on the drawn page."""
    row, column = place(text)
    return MARGIN + row * LEADING, MARGIN + column * CELL[1]


@pytest.fixture(scope="module")
def genuine() -> PictureVerification:
    """The page without alterations."""
    return read(scan(draw(PAGE, 3), 0.8))


def test_genuine_page_is_identical(genuine: PictureVerification) -> None:
    assert genuine.verdict is Verdict.IDENTICAL
    assert (
        impact88.run(dict(genuine.verification.scene)).page == impact88.run(impact88.sample(1)).page
    )
    assert not genuine.marks
    assert not genuine.remarks


@pytest.mark.parametrize(("typed", "is_open"), [("-13.2", False), ("-18.2", True)])
def test_text_layer_of_a_pdf(genuine: PictureVerification, typed: str, is_open: bool) -> None:
    (layer,) = judge(PAGE.replace("VAX= -13.2", f"VAX= {typed}"))
    result = _compare_layer(genuine, layer)
    assert result.verdict is (Verdict.INCOMPLETE if is_open else Verdict.IDENTICAL)
    assert ["does not agree" in remark for remark in result.remarks] == [True] * is_open


def test_altered_digit_differs_at_its_place() -> None:
    altered = PAGE.replace("VAX= -13.2", "VAX= -18.2")
    assert altered != PAGE
    result = read(scan(draw(altered, 0)))
    assert result.verdict is Verdict.DIFFERS
    (finding,) = result.verification.findings
    assert finding.name == "VAX"
    (box,) = result.boxes
    top, left = corner("-13.2")
    assert abs(box[0] - [left, top]).max() < 2 * CELL[1]
    page = draw_page(result)
    assert "differs" in {outline.look for outline in page.outlines}
    assert page.uri.startswith("data:image/png;base64,")


@pytest.mark.parametrize(
    ("old", "new", "verdict"),
    [
        ("15.91)", "15.918)", Verdict.INCOMPLETE),
        ("\n".join(RESULTS), "\n".join(RESULTS[::-1]), Verdict.DIFFERS),
        ("\nDA=", " 12345678 90\nDA=", Verdict.INCOMPLETE),
    ],
    ids=["digit before a bracket", "row out of order", "text beside a row"],
)
def test_verdict_on_another_page(old: str, new: str, verdict: Verdict) -> None:
    assert read(scan(draw(PAGE.replace(old, new), 0))).verdict is verdict


def test_erased_digit_is_open() -> None:
    top, left = corner("263 VAY")
    page = draw(PAGE, 0)
    page[top : top + CELL[0], left : left + CELL[1]] = 255
    assert read(scan(page)).verdict is Verdict.INCOMPLETE


@pytest.mark.parametrize(("side", "verdict"), [(4, Verdict.IDENTICAL), (7, Verdict.AS_READ)])
def test_mark_bars_identical_from_the_area_of_a_full_stop(side: int, verdict: Verdict) -> None:
    page = scan(draw(PAGE, 0), blur=0.3, noise=2)
    page[-30 : -30 + side, 700 : 700 + side] = 0
    result = read(page)
    assert result.verdict is verdict
    assert len(result.marks) == (verdict is Verdict.AS_READ)


def test_text_below_the_page_bars_identical() -> None:
    result = read(scan(draw(PAGE + "\nVAX IS 12.5", 0)))
    assert result.verdict is Verdict.AS_READ
    assert "other text" in result.remarks[-1]


def test_rows_broken_by_a_narrow_screen_on_their_side_and_head() -> None:
    rows = [line[k : k + 40] for line in PAGE.split("\n") for k in range(0, len(line), 40)]
    assert read(np.rot90(scan(draw("\n".join(rows), 11)), 3)).verdict in SETTLED
