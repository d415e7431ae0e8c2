"""Plain text from what people type, paste and save: encodings and markup.

Markup is blanked out, never shortened, so that every character keeps its line and column.
"""

import re
from binascii import a2b_qp
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import pairwise

from ...errors import UserError
from ...files import check_text
from .glyphs import is_plain

_LINE_END = re.compile("\r\n?|[\v\x85\u2028\u2029]")
_ENCODINGS = (
    "utf-16", "utf-16-le", "utf-16-be", "utf-32", "cp1252", "mac_roman", "latin-1", "cp037",
)  # fmt: skip
"""Encodings of texts that are not UTF-8."""
_APPLE_TEXT = dict.fromkeys(range(0x21, 0x80), "\ufffd") | {
    byte: chr(byte & 0x7F) for byte in range(0x80, 0x100)
}
"""Characters of an Apple II's text, by byte; the high bit of each is set."""
_QUOTED_PRINTABLE = re.compile(rb"(?:[^=]|=[0-9A-F]{2}|=\r?\n)*")


def decode(data: bytes, where: str) -> str:
    """Return the text of a file, in the encoding that leaves the fewest foreign characters.

    Raises UserError for a file that is no text.
    """
    check_text(data, where)
    if b"=3D" in data and _QUOTED_PRINTABLE.fullmatch(data):
        data = a2b_qp(data)
    text = min(_readings(data), key=_foreign_share).rstrip("\x1a\0")  # padding of a CP/M file
    odd = sum(char < " " and char not in "\t\n\r\f\v\a\b\0\x04\x1b" for char in text)
    if odd > 4 + len(text) / 50:
        raise UserError("is not UTF-8 text, nor any other this reads; expected plain text", where)
    return _LINE_END.sub("\n", text)


def _readings(data: bytes) -> Iterator[str]:
    """Yield bytes as UTF-8, and where that is not what they are, in other encodings."""
    text = data.decode("utf-8-sig", "replace")
    yield text
    with suppress(UnicodeError):  # UTF-8 that was taken for the encoding of Windows
        yield text.encode("cp1252").decode()
    if "\0" in text or "\ufffd" in text:
        yield from (data.decode(encoding, "replace") for encoding in _ENCODINGS)
        yield data.decode("latin-1").translate(_APPLE_TEXT)


def _foreign_share(text: str) -> float:
    """Return the share of a text's characters that stand on no printout; what is no character of
    the encoding counts twice."""
    counts = Counter(text)
    known = sum(counts[char] for char in counts if char.isspace() or is_plain(char))
    return 1 - (known - counts["\ufffd"]) / len(text) if text else 0.0


_ELEMENTS = (
    "a|abbr|address|article|b|big|blockquote|body|br|caption|center|cite|code|col|colgroup|dd|div|"
    "dl|dt|em|font|footer|form|h[1-6]|head|header|hr|html|i|img|kbd|li|link|main|meta|nav|ol|p|"
    "pre|s|samp|section|small|span|strike|strong|style|sub|sup|table|tbody|td|tfoot|th|thead|"
    "title|tr|tt|u|ul|var|[a-z]{1,3}:[a-z]+"
)
"""Elements of HTML; what else stands in angle brackets was typed."""
_MARKUP = re.compile(
    rf"""(?mx) ^(?:\s*>)+                                   # quotes of a mail
    | <(?:/?(?i:{_ELEMENTS})(?![\w:])[^<>\n]{{0,80}}|!--.*?--|[!?][a-zA-Z][^<>\n]{{0,80}})>
    | ^[ \t]*(?:```|~~~).*$                                # fences of Markdown
    | \x1b\[(?:(?!8[;m])[0-9]{{1,3}}(?:;|(?=m)))*m          # colours of a terminal, none hidden
    | ^[ \t]*[0-9]{{1,5}}[ ]+(?:                           # lines of a BASIC program
      (?:REM|PRINT|INPUT|IF|GOTO|GOSUB|FOR|NEXT|DIM|END|RETURN|DATA|ON)\b
      |[A-Z][A-Z0-9]*[$%]?(?:\([^)\n]*\))?[ ]?=[^=\n]*:).*$"""
)
_RTF = re.compile(r"\\[a-z]+-?[0-9]* ?|[{}]")
_ENTITY = re.compile(r"&(?:#[0-9]{1,6}|#[xX][0-9a-fA-F]{1,6}|[a-zA-Z]{2,8});")
_ROW_OF_TABLE = re.compile(r"(?m)^\s*\|.*\|\s*$")
_SMALL = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻−–", "0123456789---")
_POWER = re.compile(
    r"(?<=[0-9])[ ]?[×xX·*][ ]?10(?:\^[{(]?([-−–]?[0-9])[)}]?|([-⁻−–][0-9]|[⁻−–]?[⁰¹²³⁴⁵⁶⁷⁸⁹]))"
    r"(?![0-9⁰¹²³⁴⁵⁶⁷⁸⁹.])"
)
"""A power of ten written out."""
_ROW = re.compile(
    r"""(?mx) ^[ \t]* (?P<quote>["']?) (?P<name>[A-Za-z]{1,9}(?:[ ][A-Za-z]{2,4})?)
    (?P=quote) [ \t]* [,;\t] [ \t]*
    (?P<other>["']?) (?P<number>[-+−–.,0-9Ee]+) (?P=other) [ \t]*$"""
)
"""A row of a table of two columns: a name, a comma, semicolon or tabulator, and a number."""
_HEADING = re.compile(
    r"""(?m)^[ \t]*["']?[A-Za-z]+["']?[ \t]*[,;\t][ \t]*["']?[A-Za-z]+["']?[ \t]*$"""
)
_GROUPED = re.compile(r"(?<![0-9.,])[0-9]{1,3}(?:[.][0-9]{3})+(?=,[0-9]|(?![0-9.,]))")
_MIN_LINES = 6
"""Lines from which what stands before all of them is none of theirs, and rows of names and numbers
are a table."""
_PAGE_LINE = re.compile(r"(?i)ENTER +THE|[A-Z] *=|\*{3}")
"""A line that the program prints, or one like it."""
_LONGEST_PREFIX = 80  # characters
_AROUND_NUMBERS = re.compile(r"[-+.,0 ]+")


def strip_markup(text: str) -> str:
    """Return a text with markup blanked out, of equal length.

    Markup is e-mail quotes, HTML, RTF, Markdown, colours, and separators of tables.
    """
    if text.lstrip().startswith("{\\rtf"):
        text = _RTF.sub(_blank, text)
    text = _ENTITY.sub(_entity, _MARKUP.sub(_blank, text))
    if len(_ROW_OF_TABLE.findall(text)) >= 3:
        text = re.sub(r"(?m)^\s*\|[-:| \t]+\|\s*$", _blank, text)
        text = _ROW_OF_TABLE.sub(lambda row: row.group().replace("|", " "), text)
    if len(_ROW.findall(text)) >= _MIN_LINES:
        text = _ROW.sub(_split_row, _HEADING.sub(_blank, text))
    return text


def plain_formulas(text: str) -> str:
    """Return a text, of equal length, without TeX's marks of minus signs and subscripts, with
    powers of ten as exponents and thousands not parted."""
    text = re.sub(r"\$(-|−)\$", r"  \1", text)
    text = re.sub(r"(?<=[VW])_\{?|(?<=[VW]_\{[abxy])\}|(?<=[VW]_\{[ab][xy])\}", _blank, text)
    return _POWER.sub(_exponent, _join_groups(text))


def strip_prefix(text: str) -> tuple[str, str]:
    """Return a text with what stands before all lines of a page blanked out; and the first of it.

    It has one shape on all of them, blanks and digits apart, and ends with a blank or a mark:
    numbers of lines, time stamps, a file's name, the mark of a list. Its numbers never fall but to
    begin again with 1; a number alone always rises.
    """
    lines = text.split("\n")
    labelled = [at for at, line in enumerate(lines) if _PAGE_LINE.search(line)] or [0]
    page = [line for line in lines[labelled[0] : labelled[-1] + 1] if line.strip()]
    if len(page) < _MIN_LINES:
        return text, ""
    starts = [" ".join(line[:_LONGEST_PREFIX].split()) + " " for line in page]
    shapes = sorted(re.sub("[0-9]+", "0", start) for start in starts)
    # what the first and the last of sorted texts begin with begins all
    pairs = zip(shapes[0], shapes[-1], strict=False)
    length = next((at for at, (one, other) in enumerate(pairs) if one != other), len(shapes[0]))
    common = shapes[0][:length]
    shape = common[: 1 + max(map(common.rfind, "] :|)>"))]
    marks = {"0": "[0-9]+", " ": r"(?:\s+|$)"}
    prefix = re.compile(r"^\s*" + "".join(marks.get(char) or re.escape(char) for char in shape))
    found = [
        match.group()
        for line in lines[labelled[0] :]
        if (match := prefix.match(line[:_LONGEST_PREFIX]))
    ]
    numbers = [[*map(int, re.findall("[0-9]+", before))] for before in found]
    is_bare = "0" in shape and _AROUND_NUMBERS.fullmatch(shape) is not None
    falls = any(
        second < [*first, *[0] * is_bare] and (is_bare or second[-1] != 1)
        for first, second in pairwise(numbers)
    )
    if falls or not shape.strip():
        return text, ""
    return "\n".join(prefix.sub(_blank, line, count=1) for line in lines), found[0].strip()


def _median(values: Sequence[float]) -> float:
    """Return the median; that of `statistics` takes 5 ms to import."""
    sorted_values, middle = sorted(values), len(values) // 2
    return (
        sorted_values[middle]
        if len(values) % 2
        else (sorted_values[middle - 1] + sorted_values[middle]) / 2
    )


def _blank(match: re.Match[str]) -> str:
    """Return blanks for all of a match but its line ends."""
    return re.sub(r"[^\n]", " ", match.group())


def _entity(match: re.Match[str]) -> str:
    from html import unescape

    character = unescape(match.group())
    return character.rjust(len(match.group())) if len(character) == 1 else match.group()


def _split_row(row: re.Match[str]) -> str:
    """Return a table's row with its quotes and separators blanked out."""
    name = row.group()[: row.start("number") - row.start()]
    return re.sub(r"""["';,\t]""", " ", name) + row["number"].ljust(len(row.group()) - len(name))


def _exponent(match: re.Match[str]) -> str:
    """Return a power of ten as an exponent of one digit.

    The program never prints one: the number is in another form (`differences.Kind.OTHER_FORM`).
    """
    power = (match.group(1) or match.group(2)).translate(_SMALL)
    return f"E{power if power.startswith('-') else '+' + power}".ljust(len(match.group()))


def _join_groups(text: str) -> str:
    """Return a text with points between thousands as blanks, if commas are its decimal points.

    Only a labelled number (``100.904,929``) shows that: the numbers of a reply are separated by
    commas (``-86.903,0,0``).
    """
    group_count = len(_GROUPED.findall(text))
    points = len(re.findall(r"[0-9][.][0-9]|(?<![0-9])[.][0-9]", text))
    has_both = re.search(r"[=:]\s*-?[0-9]{1,3}(?:[.][0-9]{3})+,[0-9]", text)
    if not has_both or group_count < points - group_count:
        return text
    return _GROUPED.sub(lambda number: number.group().replace(".", "\u2009"), text)


_FIRST_WORDS = re.compile(
    r"(?i)(?<![A-Za-z])(?:ENTER +THE|MA *=|DA *=|PA\s+PB\s+TA|UX *=|VX *=|E *=|INITIAL +KE|"
    r"VAX *=|VBX *=)"
)
"""Beginnings of a printout's lines."""
_MIN_COMMON = 4
"""Smallest number of kinds of lines that stand in both of two columns."""
_MIN_WIDTH = 30
"""Smallest width of the left one of two columns, characters."""
_MAX_OFFSET = 10
"""Largest distance of a line of the right column from where most begin, characters."""
_MAX_RAGGED = 4
"""Largest distance for lines without labels, characters."""


def columns(text: str) -> list[str]:
    """Return the texts of printouts that stand side by side, the left one first.

    Each is the whole text with the other columns blanked out, so that every character keeps its
    line and column. A text in one column is returned as it is.
    """
    lines = text.split("\n")
    left_words: list[re.Match[str]] = []
    right_words: list[re.Match[str]] = []
    cuts: list[int | None] = []
    margin = min((len(line) - len(line.lstrip()) for line in lines if line.strip()), default=0)
    for line in lines:
        words = [*_FIRST_WORDS.finditer(line)]
        first = words[0].start() - margin if words else 0
        beyond = words if first >= _MIN_WIDTH else words[1:]
        left_words += words[: len(words) - len(beyond)]
        right_words += beyond[:1]
        cuts.append(beyond[0].start() if beyond else None)
    gutter = round(_median([word.start() for word in right_words] or [0]))
    level = sum(abs(word.start() - gutter) <= _MAX_OFFSET for word in right_words)
    common_words = {*map(_plain_word, left_words)} & {*map(_plain_word, right_words)}
    if len(common_words) < _MIN_COMMON or 4 * level < 3 * len(right_words):
        return [text]
    left_lines, right_lines = [], []
    for line, cut in zip(lines, cuts, strict=True):
        at = _gutter_of(line, gutter) if cut is None else cut
        left_lines.append(line[:at].ljust(len(line)))
        right_lines.append(" " * len(line[:at]) + line[at:])
    return ["\n".join(left_lines), *columns("\n".join(right_lines))]


def _plain_word(match: re.Match[str]) -> str:
    return "".join(match.group().upper().split())


def _gutter_of(line: str, gutter: int) -> int:
    """Return where the right column begins in a line without labels: behind the gap that ends
    nearest to the gutter; the line's length where all of it is the left column's."""
    gaps = [gap.end() for gap in re.finditer(r"^\s*|\s{2,}|\t", line) if gap.end() < len(line)]
    nearest = min(gaps, key=lambda end: abs(end - gutter), default=len(line))
    return nearest if abs(nearest - gutter) <= _MAX_RAGGED else len(line)
