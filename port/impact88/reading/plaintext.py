"""What people type, paste and save: encodings, markup, and words with places, made plain text.

Markup is blanked out, never shortened, so that every character keeps its line and column. Words
with their places, as optical readers save them (hOCR, ALTO, TSV), are laid out: those whose middles
are level stand on one line, and a gap between two becomes as many blanks as it is wide, in widths
of the page's own letters; line and column then count in that text.
"""

import csv
import html
import re
from collections.abc import Sequence
from html.parser import HTMLParser
from itertools import pairwise
from statistics import median
from typing import NamedTuple

from ..errors import UserError

_PICTURE = "is a picture; expected text: tesseract FILE out --psm 6 makes it"
_NO_TEXT = {
    b"%PDF": "is a PDF; expected text: pdftotext -layout FILE.pdf makes it, or, of a scan, "
    "ocrmypdf --sidecar FILE.txt",
    **dict.fromkeys((b"\x89PNG", b"\xff\xd8\xff", b"II*\0", b"MM\0*", b"GIF8"), _PICTURE),
    b"PK\x03\x04": "is a Word or other packed file; expected text: save it as plain text, or "
    "pandoc -t plain FILE",
    b"\xd0\xcf\x11\xe0": "is a Word file; expected text: save it as plain text, or antiword FILE",
    b"\x1f\x8b": "is packed; expected text: gunzip FILE",
}
"""First bytes of files that are not text, and what makes text of them."""

_BINARY = 0.02
"""More control characters than this, and a file is not text."""
_MARKS = ("MA=", "MB=", "KE=", "VAX", "UX=", "ENTER", "LOSS", "PA PB", "ZERO DET", "MA ")


def decoded(data: bytes, where: str) -> str:
    """The text of a file, by the encoding that makes sense of it. Raises UserError for no text."""
    for start, message in _NO_TEXT.items():
        if data.startswith(start):
            raise UserError(message, where)
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return _lines(data.decode("utf-16", "replace"))
    if len(data) > 8:
        # UTF-16 whose byte-order mark was lost: every other byte of such a text is zero
        for encoding, zeros in (("utf-16-le", data[1::2]), ("utf-16-be", data[0::2])):
            if zeros.count(0) > 0.9 * len(zeros):
                return _lines(data[: len(data) // 2 * 2].decode(encoding, "replace"))
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = _of_other_machines(data, where)
    if _looks_binary(text):
        raise UserError("is not UTF-8 text, nor any other this reads; expected plain text", where)
    return _lines(text)


def _lines(text: str) -> str:
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _looks_binary(text: str) -> bool:
    odd = sum(c < " " and c not in "\t\n\r\f\a\b\0\x04\x1b" for c in text)
    return odd > 4 + _BINARY * len(text)


def _of_other_machines(data: bytes, where: str) -> str:
    """Text of an Apple II (high bits set), a mainframe, Windows or a Macintosh."""
    high = sum(byte >= 0x80 for byte in data)
    if high > 0.7 * len(data):
        text = bytes(byte & 0x7F for byte in data).decode("ascii")
        if _marks(text):
            return text
    text = data.decode("cp037", "replace")
    if high > 0.3 * len(data) and _marks(text) >= 3:
        return text.replace("\x85", "\n")
    if high > 0.2 * len(data):
        raise UserError("is not UTF-8 text, nor any other this reads; expected plain text", where)
    ways = [data.decode(encoding, "replace") for encoding in ("cp1252", "mac_roman", "latin-1")]
    return max(ways, key=_minus_signs)


def _marks(text: str) -> int:
    return sum(mark in text.upper() for mark in _MARKS)


def _minus_signs(text: str) -> int:
    """How often a dash stands right before a number."""
    return len(re.findall(r"[–—−\u00ad-]\s?[.0-9]", text)) - 5 * text.count("�")


# --- markup --------------------------------------------------------------------------------------

_MARKUP = re.compile(
    r"""(?mx) ^(?:\s*>)+                                   # quotes of a mail
    | <(?:/?[a-zA-Z][^<>\n]{0,80}|!--.*?--)>               # HTML
    | ^[ \t]*(?:```|~~~).*$                                # fences of Markdown, its list marks
    | ^[ \t]*(?:[•*‣◦][ \t]+(?=[-A-Za-z(.0-9])|[-+][ \t]+(?=[-A-Za-z(]))
    | ^[ \t]*[0-9]{1,5}[ ]+(?:                             # lines of a BASIC program
      (?:REM|PRINT|INPUT|IF|GOTO|GOSUB|FOR|NEXT|DIM|END|RETURN|DATA|ON)\b
      |[A-Z][A-Z0-9]*[$%]?(?:\([^)\n]*\))?[ ]?=[^=\n]*:).*$"""
)
_RTF = re.compile(r"\\[a-z]+-?[0-9]* ?|[{}]")
_ENTITY = re.compile(r"&(?:#[0-9]{1,6}|#[xX][0-9a-fA-F]{1,6}|[a-zA-Z]{2,8});")
_ROW_OF_TABLE = re.compile(r"(?m)^\s*\|.*\|\s*$")


def unwrapped(text: str) -> str:
    """A text with markup blanked out: e-mail quotes, HTML, RTF, TeX, Markdown. Of equal length."""
    text = _unnumbered(text.replace("\r\n", " \n").replace("\r", "\n"))
    if text.lstrip().startswith("{\\rtf"):
        text = _RTF.sub(_blank, text)
    text = _ENTITY.sub(_entity, _MARKUP.sub(_blank, text))
    text = re.sub(r"\$(-|−)\$", r"  \1", text)
    if len(_ROW_OF_TABLE.findall(text)) >= 3:
        text = re.sub(r"(?m)^\s*\|[-:| \t]+\|\s*$", _blank, text)
        text = _ROW_OF_TABLE.sub(lambda row: row.group().replace("|", " "), text)
    return _POWER.sub(_exponent, _groups_joined(_table_parted(text)))


def _blank(match: re.Match[str]) -> str:
    return re.sub(r"[^\n]", " ", match.group())


def _entity(match: re.Match[str]) -> str:
    character = html.unescape(match.group())
    return character.rjust(len(match.group())) if len(character) == 1 else match.group()


_NUMBERED = re.compile(r"(?m)^[ \t]*[\[(]?([0-9]{1,5})[\])]?[:.|]?(?=[ \t]|$)")
_NUMBERED_LINES = 6
"""So many lines, and all of them, numbered upward: an editor or a listing did it."""


def _unnumbered(text: str) -> str:
    """A text whose every line begins with its number, those blanked out."""
    lines = [line for line in text.split("\n") if line.strip()]
    if len(lines) < _NUMBERED_LINES or not all(map(_NUMBERED.match, lines)):
        return text
    numbers = [int(number) for number in _NUMBERED.findall(text)]
    upward = all(before < after for before, after in pairwise(numbers))
    return _NUMBERED.sub(_blank, text) if upward else text


_SMALL = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻−–", "0123456789---")
_POWER = re.compile(
    r"(?<=[0-9])[ ]?[×xX·*][ ]?10(?:\^[{(]?([-−–]?[0-9])[)}]?|([-⁻−–][0-9]|[⁻−–]?[⁰¹²³⁴⁵⁶⁷⁸⁹]))"
    r"(?![0-9⁰¹²³⁴⁵⁶⁷⁸⁹.])"
)
"""A power of ten written out."""


def _exponent(match: re.Match[str]) -> str:
    """It as an exponent, of one digit: so the program never prints it, and the verdict tells."""
    power = (match.group(1) or match.group(2)).translate(_SMALL)
    return f"E{power if power.startswith('-') else '+' + power}".ljust(len(match.group()))


_ROW = re.compile(
    r"""(?mx) ^[ \t]* (?P<quote>["']?) (?P<name>[A-Za-z]{1,9}(?:[ ][A-Za-z]{2,4})?)
    (?P=quote) [ \t]* [,;\t] [ \t]*
    (?P<other>["']?) (?P<number>[-+−–.,0-9Ee]+) (?P=other) [ \t]*$"""
)
"""A row of a table of two columns: a name, a comma, semicolon or tabulator, and a number."""
_HEADING = re.compile(
    r"""(?m)^[ \t]*["']?[A-Za-z]+["']?[ \t]*[,;\t][ \t]*["']?[A-Za-z]+["']?[ \t]*$"""
)
_ROWS = 10
"""So many rows make a table."""


def _table_parted(text: str) -> str:
    """A table of names and numbers with its quotes and separators blanked out."""
    if len(_ROW.findall(text)) < _ROWS:
        return text
    return _ROW.sub(_row_parted, _HEADING.sub(_blank, text))


def _row_parted(row: re.Match[str]) -> str:
    name = row.group()[: row.start("number") - row.start()]
    return re.sub(r"""["';,\t]""", " ", name) + row["number"].ljust(len(row.group()) - len(name))


_GROUPED = re.compile(r"(?<![0-9.,])[0-9]{1,3}(?:[.][0-9]{3})+(?=,[0-9]|(?![0-9.,]))")


def _groups_joined(text: str) -> str:
    """The points that part thousands where commas part decimals (``100.904,929``) as blanks. Only a
    labelled number says so: replies at a prompt are parted by commas (``-86.903,0,0``)."""
    grouped = len(_GROUPED.findall(text))
    points = len(re.findall(r"[0-9][.][0-9]|(?<![0-9])[.][0-9]", text))
    both = re.search(r"[=:]\s*-?[0-9]{1,3}(?:[.][0-9]{3})+,[0-9]", text)
    if not both or grouped < points - grouped:
        return text
    return _GROUPED.sub(lambda number: number.group().replace(".", "\u2009"), text)


# --- words with places ---------------------------------------------------------------------------

_BOX = re.compile(r"\bbbox +(-?[0-9]+) +(-?[0-9]+) +(-?[0-9]+) +(-?[0-9]+)")
_LEVEL = 0.5
"""Words are on one line while their middles differ by less than this part of their height; lines
of the given scans stand 1.6 heights apart and lean by .1."""
_WIDEST = 60
"""Blanks for a gap at most: a printer's line has 80 columns."""


class _Word(NamedTuple):
    """A word and its box; x to the right, y downward."""

    text: str
    left: float
    top: float
    right: float
    bottom: float


def laid_out(text: str, where: str) -> str:
    """The text of an hOCR or ALTO document or of tesseract's TSV; any other text as it is. Raises
    UserError for a document that is damaged or holds no words."""
    head = text[:4000].lower()
    table = head.startswith("level\tpage_num\t")
    if not table and not re.search("<alto|ocr_page|ocrx_word|ocr-system", head):
        return text
    document = _Document()
    try:
        if table:
            for row in csv.DictReader(text.splitlines(), delimiter="\t", quoting=csv.QUOTE_NONE):
                document.turn_to(row["page_num"])
                document.put(row["text"] or "", *(float(row[name]) for name in _TSV_PLACE))
        else:
            document.feed(text)
    except (KeyError, TypeError, ValueError):
        raise UserError("is damaged: the place of a word is not a number", where) from None
    if not any(document.pages.values()):
        raise UserError("holds no words with places; expected hOCR, ALTO or TSV of a page", where)
    return "\n\n".join(_lines_of(words) for words in document.pages.values() if words)


_TSV_PLACE = ("left", "top", "width", "height")
_ALTO_PLACE = ("hpos", "vpos", "width", "height")


class _Document(HTMLParser):
    """The words of hOCR, ALTO or TSV, by page."""

    def __init__(self) -> None:
        super().__init__()
        self.pages: dict[str, list[_Word]] = {"": []}
        self._box: tuple[str, ...] = ()

    def turn_to(self, page: str) -> None:
        """What follows is on this page."""
        self.pages[page] = self.pages.pop(page, [])

    def put(self, text: str, left: float, top: float, width: float, height: float) -> None:
        """A word and its place."""
        if text.strip():
            word = _Word(text.strip(), left, top, left + width, top + height)
            next(reversed(self.pages.values())).append(word)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """A page begins, or a word."""
        given = {name: value or "" for name, value in attrs}
        kind = given.get("class", "")
        element = tag.rpartition(":")[2]
        if kind == "ocr_page" or element == "page":
            self.turn_to(str(len(self.pages)))
        elif kind in ("ocrx_word", "ocr_word"):
            box = _BOX.search(given.get("title", ""))
            self._box = box.groups() if box else ()
        elif element == "string" and "content" in given:
            self.put(given["content"], *(float(given.get(name, "0")) for name in _ALTO_PLACE))

    def handle_data(self, data: str) -> None:
        """What a word says."""
        if self._box and data.strip():
            left, top, right, bottom = map(float, self._box)
            self.put(data, left, top, right - left, bottom - top)
            self._box = ()


def _lines_of(words: Sequence[_Word]) -> str:
    """A page's words in lines."""
    lines: list[list[_Word]] = []
    for word in sorted(words, key=lambda word: word.top + word.bottom):
        last = lines[-1][-1] if lines else None
        height = word.bottom - word.top
        if last and abs(word.top + word.bottom - last.top - last.bottom) < 2 * _LEVEL * height:
            lines[-1].append(word)
        else:
            lines.append([word])
    width = median((word.right - word.left) / len(word.text) for word in words) or 1.0
    return "\n".join(_line(sorted(line, key=lambda word: word.left), width) for line in lines)


def _line(words: Sequence[_Word], width: float) -> str:
    text = words[0].text
    for before, word in pairwise(words):
        text += " " * min(max(1, round((word.left - before.right) / width)), _WIDEST) + word.text
    return text
