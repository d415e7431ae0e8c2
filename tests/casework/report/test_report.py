"""The page for the case file."""

from __future__ import annotations

import re
from hashlib import sha256
from html.parser import HTMLParser

from installed import impact88

from impact88.casework.report.casefile import report
from impact88.casework.report.frame import hashes
from impact88.printouts.reading.printout import read_printouts
from impact88.printouts.reporting.examination import Examined, examine, verify
from printouts import SAMPLE

VOID = {"meta", "br", "hr", "img", "link", "input"}


class Page(HTMLParser):
    """Collects what the tests ask; fails on tags that do not close."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str | None]] = []
        self.words: list[str] = []
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += attrs
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += attrs

    def handle_data(self, data: str) -> None:
        self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join("".join(self.words).split())


def page(text: str, date: str | None = None) -> Page:
    return Page(
        report([Examined("-", None, [verify(shown) for shown in read_printouts(text)])], date)
    )


def test_a_page_says_verdict_columns_and_provenance(tmp_path) -> None:
    path = tmp_path / "exhibit <7>.txt"
    path.write_text(SAMPLE.replace("143.5", "148.5"), encoding="utf-8")
    shown = Page(report([examine(str(path))], "17 May 2024"))
    assert "differs" in shown.text
    assert "exhibit <7>.txt" in shown.text
    assert "100904.929" in shown.text
    assert "103013.233" in shown.text
    assert "would be 143.5" in shown.text
    assert "17 May 2024 (as given)" in shown.text
    for digest in (sha256(path.read_bytes()).hexdigest(), *hashes().values()):
        assert digest in shown.text


def test_a_page_needs_nothing_from_elsewhere_and_repeats_no_id() -> None:
    """And it has page numbers, the case, the method, and the same bytes for the same input."""
    examined = [Examined("-", None, [verify(shown) for shown in read_printouts(SAMPLE * 2)])]
    text = report(examined, case="17/88", examiner="N. N.")
    shown = Page(text)
    assert {"script", "link", "img", "iframe", "object"}.isdisjoint(shown.tags)
    assert "svg" in shown.tags
    outside = [value for name, value in shown.attributes if name in ("src", "href", "xlink:href")]
    assert all(value and value.startswith("#") for value in outside)
    assert "@import" not in text
    assert not re.search(r"url\((?!#)", text)
    ids = [value for name, value in shown.attributes if name == "id"]
    assert len(ids) == len(set(ids))
    assert shown.tags.count("pre") == 2
    assert "counter(pages)" in text
    for words in ("Case 17/88.", "Examiner: N. N. (as given)", "Method", "does not prove"):
        assert words in shown.text
    assert report(examined, case="17/88", examiner="N. N.") == text


def test_what_was_read_cannot_inject_markup() -> None:
    shown = page(SAMPLE.replace("IA= 3728", "IA= <script>"), "<b>now</b>")
    assert "script" not in shown.tags
    assert "<b>now</b> (as given)" in shown.text


def test_an_incomplete_printout_has_a_page_too() -> None:
    shown = page(SAMPLE.replace("IA= 3728", ""))
    assert "IA is missing" in shown.text
    assert "svg" not in shown.tags


def test_command_writes_all_or_nothing(tmp_path) -> None:
    path, out = tmp_path / "a.txt", tmp_path / "case.html"
    path.write_text(SAMPLE, encoding="utf-8")
    done = impact88("verify", str(path), "--report", str(out), "--date", "2024-05-17")
    assert done.returncode == 0
    assert "2024-05-17" in Page(out.read_text(encoding="utf-8")).text
    assert [one.name for one in tmp_path.iterdir() if one.name.endswith(".part")] == []
    done = impact88("verify", str(path), "--report", str(tmp_path / "no" / "case.html"))
    assert done.returncode == 2
    assert "cannot be written" in done.stderr
