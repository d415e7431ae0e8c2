"""What people type, paste and save: encodings and markup, made the text that stands in them.

Markup is blanked out, never shortened, so that every character keeps its line and column.
"""

from __future__ import annotations

import html
import re
from itertools import pairwise

from ..errors import UserError

_NO_TEXT = (
    (b"%PDF", "is a PDF; expected text: pdftotext -layout FILE.pdf makes it, or, of a scan, "
     "ocrmypdf --sidecar FILE.txt"),
    (b"\x89PNG", "is a picture; expected text: tesseract FILE out --psm 6 makes it"),
    (b"\xff\xd8\xff", "is a picture; expected text: tesseract FILE out --psm 6 makes it"),
    (b"II*\0", "is a picture; expected text: tesseract FILE out --psm 6 makes it"),
    (b"MM\0*", "is a picture; expected text: tesseract FILE out --psm 6 makes it"),
    (b"GIF8", "is a picture; expected text: tesseract FILE out --psm 6 makes it"),
    (b"BM", "is a picture; expected text: tesseract FILE out --psm 6 makes it"),
    (b"PK\x03\x04", "is a Word or other packed file; expected text: save it as plain text, or "
     "pandoc -t plain FILE"),
    (b"\xd0\xcf\x11\xe0", "is a Word file; expected text: save it as plain text, or antiword FILE"),
    (b"\x1f\x8b", "is packed; expected text: gunzip FILE"),
)  # fmt: skip
"""First bytes of files that are not text, and what makes text of them."""

_BINARY = 0.02
"""More control characters than this, and a file is not text."""
_MARKS = ("MA=", "MB=", "KE=", "VAX", "UX=", "ENTER", "LOSS", "PA PB", "ZERO DET", "MA ")


def decoded(data: bytes, where: str) -> str:
    """The text of a file, by the encoding that makes sense of it. Raises UserError for no text."""
    for start, message in _NO_TEXT:
        if data.startswith(start) and not (start == b"BM" and b"=" in data[:200]):
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
    """Text of an Apple II (high bits set), of Windows or of a Macintosh."""
    high = sum(byte >= 0x80 for byte in data)
    if high > 0.7 * len(data):
        text = bytes(byte & 0x7F for byte in data).decode("ascii")
        if _marks(text):
            return text
    for encoding in ("cp037", "cp500"):
        text = data.decode(encoding, "replace")
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


def unwrapped(text: str) -> str:
    """A text with markup blanked out: e-mail quotes, HTML, RTF, TeX, Markdown. Of equal length."""
    text = _unnumbered(_lines_kept(text))
    if re.search(r"(?m)^\s*>", text):
        text = re.sub(r"(?m)^(\s*>)+", _blank, text)
    if "<" in text and re.search(r"<(?:/?[a-zA-Z][^<>\n]{0,80}|!--.*?--)>", text):
        text = re.sub(r"<(?:/?[a-zA-Z][^<>\n]{0,80}|!--.*?--)>", _blank, text)
    text = re.sub(r"&(?:#[0-9]{1,6}|#[xX][0-9a-fA-F]{1,6}|[a-zA-Z]{2,8});", _entity, text)
    if text.lstrip().startswith("{\\rtf"):
        text = re.sub(r"\\[a-z]+-?[0-9]* ?|[{}]", _blank, text)
    text = _STATEMENT.sub(_blank, text)
    text = re.sub(r"\$(-|−)\$", r"  \1", text)
    text = re.sub(r"(?m)^[ \t]*(```|~~~).*$", _blank, text)
    text = re.sub(r"(?m)^[ \t]*[•*+‣◦-][ \t]+(?=[-A-Za-z(.0-9])", _bullet, text)
    if len(re.findall(r"(?m)^\s*\|.*\|\s*$", text)) >= 3:
        text = re.sub(r"(?m)^\s*\|[-:| \t]+\|\s*$", _blank, text)
        text = re.sub(r"(?m)^\s*\|.*\|\s*$", lambda row: row.group().replace("|", " "), text)
    return _POWER.sub(_exponent, _groups_joined(_table_parted(text)))


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
    rows = list(_ROW.finditer(text))
    if len(rows) < _ROWS:
        return text
    parts, place = [_HEADING.sub(_blank, text[: rows[0].start()])], rows[0].start()
    for row in rows:
        parts.append(text[place : row.start()])
        parts.append(re.sub(r"""["';\t]""", " ", row.group()[: row.start("number") - row.start()]))
        parts[-1] = parts[-1].replace(",", " ")
        parts.append(row.group("number") + " " * (row.end() - row.end("number")))
        place = row.end()
    return "".join([*parts, text[place:]])


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


_STATEMENT = re.compile(
    r"(?m)^[ \t]*[0-9]{1,5} +(?:(?:REM|PRINT|INPUT|IF|GOTO|GOSUB|FOR|NEXT|DIM|END|RETURN|DATA|ON)\b"
    r"|[A-Z][A-Z0-9]*[$%]?(?:\([^)\n]*\))? ?=[^=\n]*:).*$"
)
"""A line of a BASIC program, whose assignments are no printout."""


def _lines_kept(text: str) -> str:
    return text.replace("\r\n", " \n").replace("\r", "\n")


def _blank(match: re.Match[str]) -> str:
    return re.sub(r"[^\n]", " ", match.group())


def _bullet(match: re.Match[str]) -> str:
    """A list's mark; a lone minus before a number on a line of its own stays."""
    return _blank(match)


def _entity(match: re.Match[str]) -> str:
    character = html.unescape(match.group())
    if len(character) != 1:
        return match.group()
    return character.rjust(len(match.group()))
