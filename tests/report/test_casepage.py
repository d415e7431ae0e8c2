"""Pages for a case file: what they hold, and that they are self-contained."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from drawnscenes import case_of

import impact88
from impact88 import UserError
from impact88.report.answers import ask
from impact88.report.casepage import case_page, verification_page, write
from impact88.report.exhibits import examine

pytest.importorskip("jinja2")
from impact88.pictures.verdict import PictureVerification

HEADINGS = {"case": "", "examiner": "J. Doe", "date": ""}
HOSTILE = '"><script>alert(1)</script>\x1b[2J'


def text_of(page: str) -> str:
    """Return the text of a page, with one blank for each tag."""
    body = page[page.index("<body>") :]
    return re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", body))


def test_the_order_of_entries_changes_no_number() -> None:
    case = case_of(UX="-25 +- 2", E="0.1 .. 0.3")
    reversed_case = type(case).of(dict(reversed(case.written.items())))
    assert ask(reversed_case).found == ask(case).found


def test_a_case_page_is_complete() -> None:
    case = case_of(
        "oblique",
        title="Oblique impact",
        case="26-117",
        examiner="J. Doe",
        date="2026-11-28",
        UX_source="event data recorder",
    )
    page = case_page(ask(case))
    text = text_of(page)
    for words in (
        "Oblique impact",
        "Case 26-117",
        "Examiner: J. Doe",
        "Velocities after the impact",
        "event data recorder",
        "Equations 13 to 18",
        "Not judged",
        "IA = 1978 lb-ft-s2 is estimated",
        "Signature",
        "SHA-256",
    ):
        assert words in text
    assert page.count("<svg ") == 1
    assert page == case_page(ask(case))


def test_a_page_loads_nothing_and_escapes_what_it_is_given() -> None:
    case = case_of(title=HOSTILE, case=HOSTILE, examiner=HOSTILE, date=HOSTILE, MA_source=HOSTILE)
    printout = impact88.run(impact88.sample(1)).page.replace("VAX=", f"{HOSTILE} VAX=")
    page = case_page(ask(case)) + verification_page(
        examine(HOSTILE, printout.encode()), dict.fromkeys(HEADINGS, HOSTILE)
    )
    assert "<script" not in page
    assert page.count("&lt;script") > 5
    assert "\x1b" not in page
    assert not re.search(r"(?:src|href)=(?!\"(?:data:|#))|url\((?!#tip)|@import", page)


def test_findings_are_marked_in_the_text() -> None:
    page = impact88.run(impact88.sample(1)).page.replace("-13.263", "-13.268")
    (exhibit,) = examine("paper.txt", page.replace("\n", "\r\n").encode())
    assert exhibit.result.verdict.name == "DIFFERS"
    assert "".join(text for text, _, _ in exhibit.pieces()) == exhibit.result.text.strip()
    html = verification_page([exhibit], HEADINGS)
    assert re.search(r'<mark class="differs" title="[^"]*-13.263[^"]*">-13.268</mark>', html)
    assert "paper.txt, printout 1" in html
    assert exhibit.digest in html
    assert "MA=143.5 MB=95.8" in html
    assert "\\r" not in html


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("MU= .911", "MU= .912", "MU &#39;.912&#39;: the program prints"),
        ("100904.929", "100904.920", "INITIAL KE &#39;100904.920&#39;: the program prints"),
        ("(XA=-8.78", "(XA=-8.79", "XA after the impact &#39;-8.79&#39;: the program prints"),
    ],
)
def test_a_page_has_the_names_of_the_printout(old: str, new: str, words: str) -> None:
    page = impact88.run(impact88.sample(1)).page.replace(old, new)
    assert words in verification_page(examine("paper.txt", page.encode()), HEADINGS)


def test_findings_are_marked_on_the_picture() -> None:
    pytest.importorskip("PIL")
    page = impact88.run(impact88.sample(1)).page.replace("-13.263", "-13.268")
    (exhibit,) = examine("paper.txt", page.encode())
    corners = np.array([[1, 1], [9, 1], [9, 9], [1, 9.0]])
    boxes = (corners,) * len(exhibit.result.findings)
    picture = PictureVerification(1, exhibit.result, boxes, grey=np.full((50, 100), 255.0))
    html = verification_page([replace(exhibit, page=picture)], HEADINGS)
    assert re.search(r'<image href="data:image/png;base64,[^"]+" width="100" height="50"/>', html)
    assert '<polygon class="differs" points="1,1 9,1 9,9 1,9 ">' in html
    assert "The text as read from the picture" in html


def test_what_is_no_printout_is_one_line() -> None:
    with pytest.raises(UserError, match=r"letter\.txt") as error:
        examine("letter.txt", b"Dear Sir,\n\nplease find enclosed\n")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("name", "start"), [("a.html", b"<!doctype"), ("a.svg", b"<svg "), ("a.png", b"\x89PNG")]
)
def test_the_ending_decides_what_is_written(name: str, start: bytes, tmp_path: Path) -> None:
    write(ask(case_of()), str(tmp_path / name))
    assert (tmp_path / name).read_bytes().startswith(start)


def test_nothing_is_written_of_what_cannot_be_drawn(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="expected -o FILE"):
        write(ask(case_of()), str(tmp_path / "a.pdf"))
    contradiction = ask(case_of("points", SAF="900", HAF="0"))
    assert "Not drawn: no impact that agrees with the values has MA" in case_page(contradiction)
    with pytest.raises(UserError, match="no impact that agrees with the values has MA"):
        write(contradiction, str(tmp_path / "a.svg"))
    assert list(tmp_path.iterdir()) == []
