"""Rows of a page that are exchanged, printed twice or not the program's, before characters within
rows are read.

A line whose letters are those of a prompt or of one of the program's labelled rows is that row.
Where the rows of one page are the program's but for two in each other's place, or one elsewhere,
they are read in the program's order; a row that is printed a second time, with the same numbers or
others, is none of the page's. Another printout begins only as the program begins one, or where the
rows that follow are repeated, too. A line of figures without a label is the row of angles, or goes
on where a full line broke off, or is not the program's.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from typing import NamedTuple

from ..fields import ANGLES
from .alignment import ANGLE_ROW, EXPONENT, HEADING, LINES, PROMPTS, WORDS
from .glyphs import Page, label_cost, letters
from .numerals import is_number, value_of

_MIN_ROWS = 6
"""Rows of a page from which one that is out of order was exchanged, and a line of figures is none
of the program's; fewer are a fragment, what follows may be another printout, and the labels may
have been misread."""
_LIKE_STAR = 40  # cost below which a glyph may be a misread asterisk
_STARS = LINES.index("*****")  # the row of asterisks above the results
_LABELLED_NUMBER = re.compile("=(.*?)(?=[A-Z%()]|$)")


def _letters_of(text: str) -> str:
    return "".join(filter(str.isalpha, EXPONENT.sub("", text.upper())))


_ROWS = {
    _letters_of(re.sub("{.*?}", "", line)): number
    for number, line in enumerate(LINES)
    if number != ANGLE_ROW and "*" not in line
}
"""The prompts and labelled rows by their letters."""


class _Row(NamedTuple):
    """One of the program's rows on a page: its number in `LINES`, its line of the page's, and the
    lines that belong to it (the row of angles to its heading)."""

    number: int
    line: int
    lines: range

    @property
    def fields(self) -> Sequence[str]:
        """The fields of the row."""
        if self.number < PROMPTS:
            return ("the reply",)
        return ANGLES if self.number == HEADING else re.findall("{(.*?)}", LINES[self.number])

    @property
    def title(self) -> str:
        """What it is called."""
        if self.number < PROMPTS:
            return f"the prompt of {LINES[self.number].partition(' :')[0][-2:]}"
        return f"the row of {self.fields[0]}"


class Repeated(NamedTuple):
    """A row that is printed a second time.

    Attributes
    ----------
    offset : int
        Offset in the text of its first character.
    sentence : str
        What is said of it.
    other : str
        The same with the numbers that differ from those of the row's first print; "" for none.
    """

    offset: int
    sentence: str
    other: str


class Rows(NamedTuple):
    """Rows of a page that are not where the program prints them.

    Attributes
    ----------
    order : list of int
        The page's lines in the program's order.
    doubled : set of int
        Glyphs of rows that are printed a second time.
    foreign : set of int
        Glyphs of lines of figures that are no rows of the program's.
    repeated : list of Repeated
        Rows that are printed twice.
    exchanged : list of (int, str)
        What is said of rows out of order, with the offset in the text of one of their characters.
    """

    order: list[int]
    doubled: set[int]
    foreign: set[int]
    repeated: list[Repeated]
    exchanged: list[tuple[int, str]]


def find_rows(page: Page) -> Rows:
    """Return the rows of a page that are exchanged or printed twice."""
    doubled: set[int] = set()
    repeated: list[Repeated] = []
    exchanged: list[tuple[int, str]] = []

    def told(row: _Row) -> str:
        return f"line {page.place(start_of(row))[0]}, {row.title},"

    def start_of(row: _Row) -> int:
        return page.glyphs[page.lines[row.line].start].offset

    rows = [*_labelled_rows(page)]
    stars = [at for at, line in enumerate(page.lines) if {*_text(page, line)} == {"*"}]
    own = {line for row in rows for line in row.lines}.union(stars)
    groups: list[list[_Row]] = [[]]
    for at, row in enumerate(rows):
        group, below = groups[-1], rows[at + 1 :]
        earlier = next((one for one in group if one.number == row.number), None)
        if _begins(group, row, below):
            groups.append([row])
        elif earlier is None:
            group.append(row)
        elif _is_within(stars, group, row) or _is_repeated(page, own, group, earlier, row, below):
            # a heading without its angles is the one too many
            extra = earlier if len(earlier.lines) < len(row.lines) else row
            group[group.index(earlier)] = row if extra is earlier else earlier
            doubled |= {glyph for line in extra.lines for glyph in page.lines[line]}
            numbers, known = (
                dict(zip(one.fields, _numbers(page, one), strict=False)) for one in (row, earlier)
            )
            place, _ = page.place(start_of(earlier))
            repeated.append(
                Repeated(
                    start_of(row),
                    f"{told(row)} is printed a second time: line {place} has it already",
                    _told_otherwise(told(row), numbers, known, place),
                )
            )
        else:
            groups.append([row])
    order = [*range(len(page.lines))]
    for printed in groups:
        group = [row for row in printed if row.number >= PROMPTS]
        moved = _moved(group)
        if len(moved) == 2:
            first, second = moved
            sentence = f"{told(first)} and {told(second)} stand in each other's place"
            exchanged.append((start_of(first), sentence))
        elif moved:
            sentence = f"{told(moved[0])} stands elsewhere than the program prints it"
            exchanged.append((start_of(moved[0]), sentence))
        if moved:
            order = _reordered(order, group)
    foreign: set[int] = set()
    if len({row.number for row in rows}) >= _MIN_ROWS:
        foreign |= {at for line in _foreign_lines(page) for at in page.lines[line]}
    return Rows(order, doubled, foreign, repeated, exchanged)


_WORDS = {word.text for word in WORDS if len(word.text) > 1} | {*re.findall("[A-Z]{2,}", LINES[0])}
"""Words of labels and of prompts."""
_LABELS_AS_READ = _WORDS | {f"{word}S" for word in _WORDS}
"""Words of labels, and those whose equals sign was read as S."""
_REST_OF_ROW = re.compile("[-+0-9.,E?)%/:]+")
_REST = 6  # glyphs of a row that a narrow page may have put on a line of its own


def is_stars(page: Page, line: range) -> bool:
    """Return True for a line of glyphs that may be a row of asterisks."""
    return len(line) <= len("*****") + 2 and 2 * _stars(_text(page, line)) > len(line)


def _stars(text: str) -> int:
    """Return the number of glyphs that may be asterisks."""
    return sum(label_cost("*", char) < _LIKE_STAR for char in text)


def _foreign_lines(page: Page) -> Iterator[int]:
    """Yield the lines of figures without a label that are none of the program's.

    The angles are, and what INPUT asked again for; and what goes on where the line above is full or
    ends with an equals sign, or a few figures stand right below it.
    """
    lines = [line.rstrip() for line in page.text.upper().split("\n")]
    longest = max(map(len, lines))
    angles_left = 0  # angles that are still to come
    above, line_above = 0, ""
    for at, line in enumerate(page.lines):
        place, _ = page.place(page.glyphs[line.start].offset)
        text, line_text = _text(page, line), page.shown(line.start, line.stop).upper()
        words = {*re.findall("[A-Z]+", EXPONENT.sub("", line_text))}
        figures = [word for word in line_text.split() if any(map(str.isdigit, word))]
        goes_on = (
            text.startswith("?")
            or line_above.endswith("=")
            or (
                place == above + 1
                and (len(line_above) == longest or len(text) <= _REST)
                and _REST_OF_ROW.fullmatch(text) is not None
            )
        )
        if "=" in text or not words.isdisjoint(_LABELS_AS_READ):
            is_heading = len(words.intersection(ANGLES)) > 2
            angles_left = len(ANGLES) - len(figures) if is_heading else 0
        elif figures and not (
            angles_left > 0
            or len(figures) == len(ANGLES)
            or goes_on
            or 2 * _stars(text) > len(text)
        ):
            yield at
        else:
            angles_left -= len(figures)
        above, line_above = place, lines[place - 1]


def _labelled_rows(page: Page) -> Iterator[_Row]:
    texts = [_text(page, line) for line in page.lines]
    is_angles = [not _letters_of(text) and {*text} != {"*"} for text in texts]
    end_of_angles = -1  # line below the angles
    for number, text in enumerate(texts):
        row = _ROWS.get(_letters_of(text))
        if row is not None:
            stop = number + 1
            if row == HEADING and stop < len(texts):
                stop += is_angles[stop]
                end_of_angles = stop if is_angles[number + 1] else -1
            yield _Row(row, number, range(number, stop))
        elif number == end_of_angles and is_angles[number]:
            figures = page.shown(page.lines[number].start, page.lines[number].stop).split()
            if len(figures) == len(ANGLES) and all(map(is_number, figures)):
                yield _Row(HEADING, number, range(number, number + 1))  # the angles once more


def _told_otherwise(
    told: str, numbers: Mapping[str, str], known: Mapping[str, str], place: int
) -> str:
    """Return a sentence on a row that gives fields other numbers than the page has, "" where it
    gives none. ``told``: its line and name; ``place``: the line of the page's own."""
    differ = [
        name
        for name, text in numbers.items()
        if name in known and _value(text) != _value(known[name])
    ]
    if not differ:
        return ""
    here = ", ".join(f"{name} {numbers[name]}" for name in differ)
    there = ", ".join(known[name] for name in differ)
    return f"{told} is printed a second time with {here}, where line {place} has {there}"


def _value(text: str) -> Decimal | str:
    value = value_of(text)
    return text if value is None else value


def _text(page: Page, line: range) -> str:
    return letters(page.glyphs[line.start : line.stop])


def _numbers(page: Page, row: _Row) -> list[str]:
    """Return the texts of a row's numbers."""
    if row.number == HEADING:
        return [
            text
            for at in row.lines
            if not _letters_of(_text(page, page.lines[at]))
            for text in page.shown(page.lines[at].start, page.lines[at].stop).split()
        ]
    text = _text(page, page.lines[row.line])
    if row.number < PROMPTS:
        return [text.rpartition("?")[2]]
    return [
        number.replace("\0", "E") for number in _LABELLED_NUMBER.findall(EXPONENT.sub("\0", text))
    ]


def _begins(group: Sequence[_Row], row: _Row, below: Sequence[_Row]) -> bool:
    """Return True for a row with which the program begins another page.

    It is the first prompt below labelled rows, or the row of masses where all rows above it come
    again below it.
    """
    rows = {other_row.number for other_row in group if other_row.number >= PROMPTS}
    if row.number == 0:
        return bool(rows)
    numbers_below = {other_row.number for other_row in below[: _until_masses(below)]}
    return (
        row.number == PROMPTS
        and len(rows) > (PROMPTS in rows)
        and rows - {PROMPTS} <= numbers_below
    )


def _until_masses(below: Sequence[_Row]) -> int:
    return next((at for at, row in enumerate(below) if row.number == PROMPTS), len(below))


def _is_within(stars: Sequence[int], group: Sequence[_Row], row: _Row) -> bool:
    """Return True for a row of results between the page's two rows of asterisks."""
    above = sum(group[0].line < line < row.line for line in stars)
    return row.number > _STARS and above == 1 and any(line > row.line for line in stars)


def _is_repeated(
    page: Page,
    own: set[int],
    group: Sequence[_Row],
    earlier: _Row,
    row: _Row,
    below: Sequence[_Row],
) -> bool:
    """Return True for a row that is printed twice on one page, rather than first on another.

    What follows it is not repeated, or is another printout with such a row; and it is the same to
    the letter, or nothing but rows of the page (``own``) stands between.
    """
    following = below[0].number if below else None
    if following in {other_row.number for other_row in group}:
        rest = below[_until_masses(below) + 1 :]
        is_last = following in (0, PROMPTS) and any(
            other_row.number == row.number for other_row in rest
        )
        if not is_last:
            return False
    texts = [
        "".join(_text(page, page.lines[at]) for at in other_row.lines)
        for other_row in (earlier, row)
    ]
    return texts[0] == texts[1] or own.issuperset(range(earlier.line, row.line))


def _moved(group: Sequence[_Row]) -> list[_Row]:
    """Return the two rows of a page that are in each other's place, or the one that is elsewhere;
    none for a page whose rows are in order, or in another altogether."""
    in_order = sorted(group)
    if len(group) < _MIN_ROWS or [*group] == in_order:
        return []
    numbers = [row.number for row in in_order]
    if numbers != [*filter({*_ROWS.values()}.__contains__, range(numbers[0], numbers[-1] + 1))]:
        return []
    apart = [at for at, row in enumerate(group) if row is not in_order[at]]
    if len(apart) == 2:
        return [group[at] for at in apart]
    for at, row in enumerate(group):
        rest = [*group[:at], *group[at + 1 :]]
        if rest == sorted(rest):
            return [row]
    return []


def _reordered(order: Sequence[int], group: Sequence[_Row]) -> list[int]:
    """Return the lines with those of a page's rows in the program's order."""
    by_line = {row.line: row for row in group}
    taken = {line for row in group for line in row.lines}
    sorted_rows = iter(sorted(group))
    lines: list[int] = []
    for line in order:
        if line in by_line:
            lines += next(sorted_rows).lines
        elif line not in taken:
            lines.append(line)
    return lines
