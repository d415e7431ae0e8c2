"""Reading a printout: text that was typed in or came from a scanner, into named fields.

The text is aligned with the program's page (`alignment`), which says what every glyph belongs to:
a number, a label, or neither. Here each printout's numbers get their names and places, the replies
at the prompts are parted, the row of angles is cut, and what belongs nowhere is kept as left over.
One file may hold several printouts, with anything between them.

Nothing here computes: what the numbers should be is for `recovery` and `judging` to say.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from .. import files
from ..applesoft.errorcodes import CODES
from ..errors import UserError
from ..fields import ANGLES, FIELDS, FINAL_SPINS, REPLIES, ZERO_DETERMINANT
from . import glyphs, numerals
from . import plaintext as pasted
from .alignment import Aligned, align
from .anglerow import cut_in_five
from .glyphs import Gap, Glyph, Page
from .margins import begun_within, cut_after, cut_before
from .numerals import Cut, Region
from .template import REPLY_A, REPLY_B, RESULTS, SPINS, STARS, template

LARGEST_FILE = 2_000_000
"""Bytes of the largest file that is read: some 2,500 printouts."""

FRAGMENT = 6
"""A piece with fewer numbers than this is a fragment."""


_SLOT_COMMAND = re.compile(r"PR# ?[0-9]")
"""What line 610 prints where no DOS takes it for a command."""
_PROMPT_LETTERS, _MOST_ANGLES = 25, 4
_NEXT_TO_NUMBERS = ("%", "(", ")", "=")
_CLOSINGS = {"LOSS": "%", "YAF": ")", "YBF": ")"}
"""Fields that a sign follows."""
_CLOSING_DIGITS = {"%": "479825", ")": "1379"}
"""The digits those signs are read as."""
_RESULTS = ("VAX", "VAY", "VBX", "VBY")


@dataclass(frozen=True)
class Reading:
    """One number as read.

    ``text``: what it is taken for, ``?`` for illegible glyphs; ``line``, ``column`` (from 1),
    ``start``, ``stop`` (offsets in the text): where it stands; ``region``: its glyphs;
    ``alternatives``: other numbers it may be; ``cut``: where the text ends right at it, so that
    more of it may have stood there; ``sign_free``: a minus before it may be the label's own sign,
    damaged; ``closing``: digits that the bracket or percent sign after it, not itself read, is read
    as."""

    text: str
    line: int
    column: int
    start: int
    stop: int
    region: Region
    alternatives: tuple[str, ...] = ()
    cut: Cut = Cut.NONE
    sign_free: bool = False
    closing: str = ""

    @property
    def clean(self) -> bool:
        """Whether it is a number beyond doubt, character for character."""
        return numerals.clean(self.region) is not None

    @property
    def legible(self) -> bool:
        """Whether every character was read."""
        return glyphs.ILLEGIBLE not in self.text


class Piece(NamedTuple):
    """Text that belongs to no field and no label: where it is (line and column from 1, offsets),
    and whether it stands on a line with a number."""

    text: str
    line: int
    column: int
    start: int
    stop: int
    beside: bool


class Remark(NamedTuple):
    """Something about the text worth telling: a field's name or "", what, and where."""

    name: str
    message: str
    line: int
    column: int

    def __str__(self) -> str:
        subject = f"{self.name}: " if self.name else ""
        return f"line {self.line}, column {self.column}: {subject}{self.message}"


@dataclass
class Printout:
    """One printout as read.

    ``line``, ``column``, ``start``, ``stop``: where it stands in the text. ``fields``: name ->
    reading, for every number found; ``replies``: the velocities typed at the prompts, where the
    transcript shows them; ``angles``: ways to cut the row of five angles with what each costs, the
    likeliest first, where blanks alone do not tell, and ``angle_row`` its glyphs then; ``ending``:
    ``ZERO DETERMINANT`` or an Applesoft error as printed, with its line; ``ended``: whether
    anything of the last row of asterisks is there; ``left_over``: text that belongs nowhere;
    ``remarks``: what could not be read, and where; ``misread_letters``: how many letters of labels
    and asterisks were read as others; ``page``: the whole text as glyphs.
    """

    line: int
    column: int
    start: int = 0
    stop: int = 0
    fields: dict[str, Reading] = field(default_factory=dict)
    replies: dict[str, Reading] = field(default_factory=dict)
    angles: list[tuple[tuple[str, ...], float]] = field(default_factory=list)
    angle_row: Region = ()
    ending: str | None = None
    ended: bool = False
    spin_line: bool = False
    left_over: list[Piece] = field(default_factory=list)
    remarks: list[Remark] = field(default_factory=list)
    misread_letters: int = 0
    page: Page | None = field(default=None, repr=False)

    @property
    def has_final_spins(self) -> bool:
        """Whether any of the final WA, WB line is there, read or not: then M = N."""
        return self.spin_line or any(name in self.fields for name in FINAL_SPINS)

    def place(self, offset: int) -> tuple[int, int]:
        """Line and column, counted from 1, of an offset in the text."""
        return self.page.place(offset) if self.page else (self.line, self.column)

    @property
    def fragment(self) -> bool:
        """Whether it holds too few numbers to be called a printout."""
        return len(self.fields) < FRAGMENT

    @property
    def fragment_of_run(self) -> bool:
        """Whether nothing of the results is there, and no message that says why."""
        return self.ending is None and not any(name in self.fields for name in _RESULTS)

    def reading(self, region: Region) -> Reading | None:
        """A part of the row of angles as a number; None when it is none."""
        return _reading(self.page, region) if self.page and region else None

    def text(self, name: str) -> str | None:
        """The text of a field, None when it was not read."""
        reading = self.fields.get(name)
        return reading.text if reading else None


def read_file(path: str) -> list[Printout]:
    """The printouts in a file (``-``: standard input), in any usual encoding.

    Raises UserError when it is too large, is no text or holds no printout."""
    return read_bytes(files.read_bytes(path, LARGEST_FILE), files.called(path))


def read_bytes(data: bytes, where: str) -> list[Printout]:
    """The printouts in a file's bytes, whatever wrote it. Raises UserError (naming ``where``) for
    what is no text or holds no printout."""
    return read_printouts(pasted.decoded(data, where), where)


def read_printouts(text: str, where: str = "text") -> list[Printout]:
    """The printouts in a text, in order. Raises UserError (naming ``where``) if there is none."""
    page = Page(pasted.unwrapped(text))
    shown = [printout for part in _parts(page) for printout in part]
    if not shown:
        raise UserError(
            "no printout of the program in it; expected text with labels such as "
            "MA= ... MB= ... VAX= ... VAY= ...",
            where,
        )
    return shown


# --- where a run ended ---------------------------------------------------------------------------

_LOOSE = {"I": "[IL1|!]", "L": "[IL1|!]", "O": "[O0Q]", "S": "[S5]", "B": "[B8]", "Z": "[Z2]"}


def _loosely(words: str) -> str:
    """A pattern for printed words without their blanks, letters that look like digits either way"""
    return "".join(
        "['’`]?" if letter == "'" else _LOOSE.get(letter, re.escape(letter))
        for letter in words
        if letter != " "
    )


_ENDING = re.compile(
    rf"\??(?P<message>{'|'.join(map(_loosely, CODES))})"
    r"ERR[O0Q]R(?:[IL1|!]N(?P<at>[0-9OQIL|!]{1,5}))?"
    rf"|(?P<zero>{_loosely(ZERO_DETERMINANT)})"
)
_DIGITS = str.maketrans("OQIL|!", "001111")


def _ending(match: re.Match[str]) -> str:
    """An error message as Applesoft prints it, or ZERO DETERMINANT."""
    if match.group("zero"):
        return ZERO_DETERMINANT
    message = next(one for one in CODES if re.fullmatch(_loosely(one), match.group("message")))
    at = match.group("at")
    return f"?{message} ERROR" + (f" IN {at.translate(_DIGITS)}" if at else "")


# --- printouts -----------------------------------------------------------------------------------


def _parts(page: Page) -> Iterator[list[Printout]]:
    """The printouts of each stretch of text up to where a run ended early."""
    text = numerals.plain(page.glyphs)
    start = 0
    for match in [*_ENDING.finditer(text), None]:
        stop = match.start() if match else len(text)
        aligned = list(align(page.glyphs[start:stop]))
        shown = [
            printout
            for number, one in enumerate(aligned)
            if (
                printout := _Reader(
                    page, start, one, _following(aligned, number, stop - start)
                ).read()
            )
        ]
        if match:
            if not shown:
                continue
            shown[-1].ending = _ending(match)
            shown[-1].stop = page.span(match.start(), match.end())[1]
            shown[-1].left_over = [
                piece for piece in shown[-1].left_over if piece.start < shown[-1].stop
            ]
            start = match.end()
        yield shown


def _following(aligned: Sequence[Aligned], number: int, stop: int) -> int:
    return aligned[number + 1].start if number + 1 < len(aligned) else stop


class _Reader:
    """Reads one printout from what its glyphs are taken for."""

    def __init__(self, page: Page, base: int, aligned: Aligned, following: int) -> None:
        self._page = page
        self._glyphs = page.glyphs
        self._start = base + aligned.start
        self._states = aligned.states
        self._following = base + following
        self._slots = {name: (base + i, base + j) for name, (i, j) in aligned.slots.items()}
        start, stop = page.span(self._start, base + aligned.stop)
        self._printout = Printout(*page.place(start), start, stop, page=page)
        self._lines = set(aligned.lines)
        self._begun_within = begun_within(page, self._start, self._states)

    def read(self) -> Printout | None:
        """The printout; None when there is nothing of one."""
        shown = self._printout
        for name, (start, stop) in self._slots.items():
            if name not in (REPLY_A, REPLY_B):
                self._read_number(name, start, stop)
        if not self._worth_telling():
            return None
        if self._letters(SPINS) < 2:
            for name in FINAL_SPINS:  # a footer, a page number
                shown.fields.pop(name, None)
                self._slots.pop(name, None)
        for name in (REPLY_A, REPLY_B):
            if name in self._slots:
                self._read_reply(name, self._slots[name][0])
        if any(name in self._slots for name in ANGLES):
            self._read_angles()
        self._cut_at_margins()
        shown.misread_letters = self._misread_letters()
        shown.ended = STARS[1] in self._lines
        shown.spin_line = self._letters(SPINS) >= 2
        self._keep_left_over()
        return shown

    def _letters(self, line: int | None = None) -> int:
        """How many letters of labels were read as they are printed, in one line or all."""
        page = template()
        return sum(
            self._glyphs[self._start + index].char == page.letters.get(state)
            for index, state in enumerate(self._states)
            if state and (line is None or page.line[state] == line)
        )

    def _misread_letters(self) -> int:
        """Letters of labels, and asterisks, read as other letters or figures; and lines whose first
        letters were not read, as where a margin is cut off."""
        page = template()
        count = sum(self._begun_within)
        before = 0
        for index, state in enumerate(self._states):
            letter = page.letters.get(state, "")
            glyph = self._glyphs[self._start + index]
            if state != before and (letter.isalpha() or letter == "*"):
                count += glyph.char != letter and glyph.char.isalnum()
            before = state
        return count

    def _worth_telling(self) -> bool:
        """Whether a label and its number, or a prompt, was read."""
        if self._letters(0) + self._letters(1) >= _PROMPT_LETTERS:
            return True
        shown = self._printout.fields
        numbers = {name for name, one in shown.items() if any(map(str.isdigit, one.text))}
        angles = numbers & set(ANGLES)
        if len(angles) < _MOST_ANGLES:
            numbers -= angles
        labelled = sum(self._label_letters(name) >= 1 for name in numbers)
        letters = self._letters()
        return (labelled >= 1 and letters >= 4) or (labelled >= 2 and letters >= 3)

    def _label_letters(self, name: str) -> int:
        """How many letters right before a number were read as its label's."""
        page = template()
        place = self._slots[name][0] - self._start - 1
        found = 0
        while place >= 0 and self._states[place] in page.letters:
            letter = page.letters[self._states[place]]
            found += letter.isalpha() and self._glyphs[self._start + place].char == letter
            place -= 1
        return found if name not in ANGLES else 1

    def _remark(self, name: str, message: str, index: int) -> None:
        place = self._page.place(self._page.span(index, index + 1)[0])
        self._printout.remarks.append(Remark(name, message, *place))

    def _cut_at_margins(self) -> None:
        """Numbers at an edge that cut lines off may have lost digits there."""
        page, fields = self._page, self._printout.fields
        before = cut_before(self._begun_within)
        after = cut_after(page, self._start, self._states)
        for name, reading in [*fields.items()] if before or after else []:
            cut = reading.cut
            following = self._slots[name][1]
            ends = following == len(self._glyphs) or self._glyphs[following].gap is Gap.LINE
            if before and reading.region[0].gap is Gap.LINE:
                cut |= Cut.BEFORE
            if after and ends and page.place(reading.stop - 1)[1] >= after:
                cut |= Cut.AFTER
            fields[name] = replace(reading, cut=cut)

    def _closing(self, name: str) -> str:
        """The digits that the glyph after a field is read as, where that glyph is lost although
        others of its kind were read."""
        mark = _CLOSINGS.get(name)
        if mark is None:
            return ""
        page = template()
        read = {page.slot_before.get(state) for state in self._states} & set(_CLOSINGS)
        return "" if name in read or not read else _CLOSING_DIGITS[mark]

    def _read_number(self, name: str, start: int, stop: int) -> None:
        before = start - 1 - self._start
        label = template().letters.get(self._states[before]) if before >= 0 else None
        unsigned = label != "=" or self._glyphs[start - 1].char != "="
        region = tuple(self._glyphs[start:stop])
        sign_free = unsigned and name not in ANGLES
        reading = _reading(self._page, region, sign_free, self._closing(name)) if region else None
        if reading is None:
            shown = self._page.shown(start, stop)
            self._remark(name, f"{_quoted(shown)}: expected a number", start)
        else:
            self._printout.fields[name] = reading

    def _read_angles(self) -> None:
        names = [name for name in ANGLES if name in self._slots]
        shown = self._printout
        plain = names == list(ANGLES) and all(
            name in shown.fields and shown.fields[name].clean for name in names
        )
        parted = all(self._glyphs[self._slots[name][0]].gap for name in names[1:])
        if plain and parted:
            return
        start = min(self._slots[name][0] for name in names)
        stop = max(self._slots[name][1] for name in names)
        shown.angle_row = tuple(self._glyphs[start:stop])
        shown.angles = cut_in_five(shown.angle_row)
        if not shown.angles and len(names) < len(ANGLES):
            what = _quoted(self._page.shown(start, stop))
            self._remark("PA", f"{what}: expected five angles, PA PB TA TB GA", start)

    def _read_reply(self, name: str, start: int) -> None:
        """The three numbers typed at a prompt, after any that INPUT refused."""
        stop = start
        page = template()
        line = page.line[self._states[start - self._start]]
        while stop - self._start < len(self._states):
            state = self._states[stop - self._start]
            if state == 0 or (state in page.letters and page.line[state] != line):
                break
            stop += 1
        names = REPLIES["A" if name == REPLY_A else "B"]
        parts = _reply_parts(list(self._glyphs[start:stop]))
        printed = [self._printout.text(field_name) for field_name in names]
        parts = _comma_for_point(self._glyphs[start:stop], parts, printed) or parts
        if len(parts) > len(names) and all(map(numerals.clean, parts[:3])):
            extra = "".join(map(numerals.plain, parts[3:]))
            self._remark("", f"reply: {_quoted(extra)} after the third number", start)
            parts = parts[: len(names)]
        if len(parts) != len(names):
            shown = _quoted(self._page.shown(start, stop))
            if parts != [()]:
                self._remark("", f"reply {shown} is not three numbers", start)
            return
        for field_name, region in zip(names, parts, strict=True):
            if not region:
                continue
            begin, end = region[0].offset, region[-1].offset + 1
            text = numerals.clean(region)
            ways = [way for way, _ in numerals.candidates(region, 6)]
            if text is None and not ways:
                continue
            text = text or ways.pop(0)
            self._printout.replies[field_name] = Reading(
                text, *self._page.place(begin), begin, end, region, tuple(ways)
            )

    def _keep_left_over(self) -> None:
        """Runs of glyphs between lines or put into labels, and after the printout's last line."""
        page = template()
        between = set(page.between.tolist()) | {0}
        numbered = set()
        for start, stop in self._slots.values():
            numbered |= {self._page.place(glyph.offset)[0] for glyph in self._glyphs[start:stop]}
        run: list[int] = []
        reach = self._start + len(self._states)
        for index in range(self._start, self._following + 1):
            loose = False
            if index < self._following:
                state = self._states[index - self._start] if index < reach else 0
                again = (
                    index > self._start
                    and index < reach
                    and (state == self._states[index - 1 - self._start])
                )
                letter = page.letters.get(state)
                digit = letter in _NEXT_TO_NUMBERS and self._glyphs[index].char.isdigit()
                again = again and not (page.line[state] < 2 and self._glyphs[index].char in "_{}")
                loose = state in between or (letter is not None and (again or digit))
                if (
                    index >= reach
                    and self._page.place(self._glyphs[index].offset)[0] not in numbered
                ):
                    loose = False
            parted = run and index < self._following and self._glyphs[index].gap is Gap.LINE
            if run and (not loose or parted):
                self._keep(run, numbered)
                run = []
            if loose:
                run.append(index)

    def _keep(self, run: list[int], numbered: set[int]) -> None:
        start, stop = self._page.span(run[0], run[-1] + 1)
        line, column = self._page.place(start)
        text = self._page.shown(run[0], run[-1] + 1)
        if _SLOT_COMMAND.fullmatch(text):
            return
        self._printout.left_over.append(Piece(text, line, column, start, stop, line in numbered))


def _reading(
    page: Page, region: Region, sign_free: bool = False, closing: str = ""
) -> Reading | None:
    """A region of a page as a number, None when nothing of one is there."""
    begin, end = region[0].offset, region[-1].offset + 1
    text = numerals.clean(region)
    ways: list[str] = []
    if text is None:
        ways = [way for way, _ in numerals.candidates(region, 4, sign_free)]
        text = illegibly(region) if not ways or _foreign_inside(region) else ways[0]
    if text is None:
        return None
    last = end == len(page.text) and region[-1].offset == page.glyphs[-1].offset
    cut = Cut.AFTER if last else Cut.NONE
    line, column = page.place(begin)
    return Reading(text, line, column, begin, end, region, tuple(ways[1:]), cut, sign_free, closing)


def _foreign_inside(region: Region) -> bool:
    """Whether a glyph that looks like no figure stands within a number."""
    figures = [place for place, glyph in enumerate(region) if glyph.char.isdigit()]
    if not figures:
        return False
    return any(
        glyph.char not in glyphs.NUMERIC and glyph.char not in glyphs.LOOK_ALIKES and glyph.joined
        for glyph in region[figures[0] + 1 : figures[-1] + 1]
    )


def illegibly(region: Region) -> str | None:
    """A region in which nothing reads as a number, its foreign glyphs as illegible; None when
    there is nothing left."""
    text = "".join(
        glyph.char if glyph.char in glyphs.NUMERIC else glyphs.ILLEGIBLE
        for glyph in region[: numerals.LONGEST]
    )
    return text if any(map(str.isdigit, text)) or text in ("?", "??", "???") else None


def _reply_parts(glyphs_: list[Glyph]) -> list[Region]:
    """The glyphs of a reply, parted at its commas."""
    text = numerals.plain(glyphs_)
    for word in ("REENTER", "EXTRAIGNORED"):
        place = text.rfind(word)
        if place >= 0 and word == "REENTER":
            glyphs_ = glyphs_[place + len(word) :]
        elif place >= 0:
            glyphs_ = glyphs_[: max(0, place - 1)]
        text = numerals.plain(glyphs_)
    place = text.find("PR#")
    if place >= 0:
        glyphs_ = glyphs_[:place]
    while glyphs_ and glyphs_[0].char == "?":
        glyphs_ = glyphs_[1:]
    parts: list[list[Glyph]] = [[]]
    index = 0
    while index < len(glyphs_):
        glyph = glyphs_[index]
        twice = glyph.char == "?" and glyphs_[index + 1 : index + 2]
        if twice and glyph.gap is Gap.LINE and glyphs_[index + 1].char == "?":
            parts.append([])
            index += 2
            continue
        if glyph.char in ",;":
            parts.append([])
        else:
            parts[-1].append(glyph)
        index += 1
    return [tuple(part) for part in parts]


def _comma_for_point(
    glyphs_: Sequence[Glyph], parts: Sequence[Region], printed: Sequence[str | None]
) -> list[Region]:
    """The parts of a reply with two of them as one number whose point was read as a comma, where
    all are then what is printed below; else none."""
    if len(parts) != len(printed) + 1 or not all(parts):
        return []
    for place in range(len(printed)):
        one, other = parts[place : place + 2]
        whole = tuple(
            glyph for glyph in glyphs_ if one[0].offset <= glyph.offset <= other[-1].offset
        )
        joined = [*parts[:place], whole, *parts[place + 2 :]]
        texts = [numerals.plain(part).replace(",", ".") for part in joined]
        if all(map(_reads_as, texts, printed)):
            return joined
    return []


def _reads_as(text: str, printed: str | None) -> bool:
    """Whether a part of a reply, the prompt's mark before it or not, is a printed number."""
    value = numerals.value_of(printed) if printed else None
    return value is not None and value in map(numerals.value_of, (text, text[1:]))


def _quoted(text: str) -> str:
    return repr(text if len(text) <= 30 else text[:27] + "...")


__all__ = [
    "FIELDS",
    "RESULTS",
    "Piece",
    "Printout",
    "Reading",
    "Remark",
    "read_file",
    "read_printouts",
]
