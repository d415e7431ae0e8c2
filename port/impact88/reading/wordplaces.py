"""Words with their places, as optical readers save them (hOCR, ALTO), laid out as a text.

Words whose middles are level stand on one line; a gap between two becomes as many blanks as it is
wide, in widths of the page's own letters. Line and column then count in that text.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from html.parser import HTMLParser
from itertools import pairwise
from statistics import median
from typing import NamedTuple
from xml.etree import ElementTree

from ..errors import UserError

_BOX = re.compile(r"\bbbox +(-?[0-9]+) +(-?[0-9]+) +(-?[0-9]+) +(-?[0-9]+)")
_LEVEL = 0.5
"""Words are on one line while their middles differ by less than this part of their height; lines
of the given scans stand 1.6 heights apart and lean by .1."""
_WIDEST = 60
"""Blanks for a gap at most: a printer's line has 80 columns."""


class Word(NamedTuple):
    """A word and its box; x to the right, y downward."""

    text: str
    left: float
    top: float
    right: float
    bottom: float


def laid_out(text: str, where: str) -> str | None:
    """The text of an hOCR or ALTO document or of tesseract's TSV; None for what is none of them.
    Raises UserError for one that is damaged or holds no words."""
    head = text[:4000].lower()
    if "<alto" in head:
        pages = _alto(text, where)
    elif "ocr_page" in head or "ocrx_word" in head or "ocr-system" in head:
        pages = _hocr(text)
    elif head.startswith("level\tpage_num\t"):
        pages = _tsv(text, where)
    else:
        return None
    if not any(pages):
        raise UserError("holds no words with places; expected hOCR, ALTO or TSV of a page", where)
    return "\n\n".join(_page(words) for words in pages)


def _tsv(text: str, where: str) -> list[list[Word]]:
    """Words of tesseract's table, by page."""
    pages: dict[str, list[Word]] = {}
    for row in csv.DictReader(text.splitlines(), delimiter="\t", quoting=csv.QUOTE_NONE):
        try:
            if (row["text"] or "").strip():
                left, top = float(row["left"]), float(row["top"])
                box = (left, top, left + float(row["width"]), top + float(row["height"]))
                pages.setdefault(row["page_num"], []).append(Word(row["text"].strip(), *box))
        except (KeyError, TypeError, ValueError):
            raise UserError("a row of the TSV is damaged", where) from None
    return list(pages.values())


def _page(words: Sequence[Word]) -> str:
    lines: list[list[Word]] = []
    for word in sorted(words, key=lambda word: word.top + word.bottom):
        last = lines[-1][-1] if lines else None
        height = word.bottom - word.top
        if last and abs(word.top + word.bottom - last.top - last.bottom) < 2 * _LEVEL * height:
            lines[-1].append(word)
        else:
            lines.append([word])
    width = median((word.right - word.left) / len(word.text) for word in words) or 1.0
    return "\n".join(_line(sorted(line, key=lambda word: word.left), width) for line in lines)


def _line(words: Sequence[Word], width: float) -> str:
    text = words[0].text
    for before, word in pairwise(words):
        text += " " * min(max(1, round((word.left - before.right) / width)), _WIDEST) + word.text
    return text


def _alto(text: str, where: str) -> list[list[Word]]:
    try:
        root = ElementTree.fromstring(re.sub(r"^\s*<\?xml[^>]*\?>", "", text))
    except ElementTree.ParseError as error:
        raise UserError(f"is damaged ALTO: {error}", where) from None
    pages = [one for one in root.iter() if _tag(one) == "Page"]
    try:
        return [list(_strings(page)) for page in pages]
    except ValueError:
        raise UserError("is damaged ALTO: a word's place is not a number", where) from None


def _strings(page: ElementTree.Element) -> Iterator[Word]:
    for one in page.iter():
        if _tag(one) == "String" and one.get("CONTENT"):
            left, top, width, height = (
                float(one.get(name) or "0") for name in ("HPOS", "VPOS", "WIDTH", "HEIGHT")
            )
            yield Word(one.get("CONTENT") or "", left, top, left + width, top + height)


def _tag(element: ElementTree.Element) -> str:
    return element.tag.rpartition("}")[2]


def _hocr(text: str) -> list[list[Word]]:
    parser = _Hocr()
    parser.feed(text)
    return parser.pages


class _Hocr(HTMLParser):
    """The words of an hOCR document, page by page."""

    def __init__(self) -> None:
        super().__init__()
        self.pages: list[list[Word]] = [[]]
        self._box: tuple[float, ...] = ()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """A page begins, or a word."""
        given = dict(attrs)
        kind = given.get("class") or ""
        box = _BOX.search(given.get("title") or "")
        if kind == "ocr_page" and self.pages[-1]:
            self.pages.append([])
        if kind in ("ocrx_word", "ocr_word"):
            self._box = tuple(map(float, box.groups())) if box else ()

    def handle_data(self, data: str) -> None:
        """What a word says."""
        if self._box and data.strip():
            self.pages[-1].append(Word(data.strip(), *self._box))
            self._box = ()
