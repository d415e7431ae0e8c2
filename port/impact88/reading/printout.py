"""Reading a printout: text that was typed in or came from a scanner, into named fields.

The text is aligned with the program's page (`alignment`), which says what every glyph belongs to:
a number, a label, or neither. Here each printout's numbers get their names and places, the replies
at the prompts are parted, the row of angles is cut, and what belongs nowhere is kept as left over.
One file may hold several printouts, with anything between them.

Nothing here computes: what the numbers should be is for `recovery` and `judging` to say.
"""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from .. import files
from ..applesoft.errorcodes import CODES
from ..errors import UserError
from ..fields import ANGLES, FIELDS, FINAL_SPINS, REPLIES, ZERO_DETERMINANT, label
from . import glyphs, numerals
from . import plaintext as pasted
from .alignment import Aligned, Budget, align
from .anglerow import cut_in_five
from .fieldlabels import READERS, LabelCheck, LabelState, label_checks, words_before
from .glyphs import Gap, Glyph, Page
from .margins import begun_within, cut_after, cut_before
from .numerals import Cut, Region
from .template import REPLY_A, REPLY_B, RESULTS, SPINS, STARS, template

LARGEST_FILE = 2_000_000
"""Bytes of the largest file that is read: some 2,500 printouts."""

FRAGMENT = 6
"""A piece with fewer numbers than this is a fragment."""


BADLY_READ = 17
"""So many letters and numbers misread, asterisks included: of the given scans that differ 58 of 88
readings of genuine pages have as many, and 2 of 84 of pages with an altered digit."""
_PART = 15
"""A piece with fewer numbers is part of a page: its labels do not tell which numbers it holds."""
MACHINE_READ = 3
"""So many letters of labels misread, and a machine read the page: people do not type PE for PB."""
_TYPED = frozenset("0123456789.,-+EOILQ?")

_SLOT_COMMAND = re.compile(r"PR#[0-9]")
"""What line 610 prints where no DOS takes it for a command."""
_PROMPT_LETTERS, _MOST_ANGLES = 25, 4
_NEXT_TO_NUMBERS = ("%", "(", ")", "=")
_CLOSINGS = {"LOSS": "%", "YAF": ")", "YBF": ")"}
"""Fields that a sign follows."""
_CLOSING_DIGITS = {"%": "479825", ")": "1379"}
"""The digits those signs are read as."""
_OF_PROMPT = 4
"""Glyphs of ``Wa ?`` that are read into the reply at most."""
_MOST_STARS = 7
"""Glyphs that a row of five asterisks is read as at most."""
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
    whether it may bear on a number (it stands beside one, or holds a number or a label of its own),
    and whether it is a whole line."""

    text: str
    line: int
    column: int
    start: int
    stop: int
    beside: bool
    whole: bool = False


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
    labels: list[LabelCheck] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    unread: str = ""
    taken: frozenset[int] = field(default=frozenset(), repr=False)
    misread_letters: int = 0
    page: Page | None = field(default=None, repr=False)

    @property
    def mislabelled(self) -> list[LabelCheck]:
        """The labels that say another number than the one that stands there."""
        return [one for one in self.labels if one.state is LabelState.CONTRADICTORY]

    @property
    def marks(self) -> int:
        """How many marks of an optical reader its numbers bear: foreign glyphs and blanks within
        them, specks beside them."""
        damaged = sum(not _typed_so(reading) for reading in self.fields.values())
        return damaged + sum(
            piece.beside and not piece.whole and len(piece.text) <= 3 for piece in self.left_over
        )

    @property
    def machine_read(self) -> bool:
        """Whether the text bears the marks of an optical reader: letters of labels and asterisks
        that nobody would type so, or damaged numbers."""
        return self.misread_letters + self.marks >= MACHINE_READ

    @property
    def badly_read(self) -> bool:
        """Whether so much of it was misread that a digit altered on the paper and one misread
        cannot be told apart."""
        return self.misread_letters + self.marks >= BADLY_READ

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

    Raises UserError when it is too large, is not text or holds no printout."""
    return read_bytes(files.read_bytes(path, LARGEST_FILE), files.called(path))


def read_bytes(data: bytes, where: str) -> list[Printout]:
    """The printouts in a file's bytes, whatever wrote it. Raises UserError (naming ``where``) for
    what is not text or holds no printout."""
    return read_printouts(pasted.decoded(data, where), where)


def read_printouts(text: str, where: str = "text") -> list[Printout]:
    """The printouts in a text, in order. Raises UserError (naming ``where``) if there is none.

    >>> (printout,) = impact88.read_printouts(impact88.run(impact88.sample(1)).page)
    >>> printout.fields["MA"].text
    '143.5'
    """
    if "<" in text[:1000]:
        from .wordplaces import laid_out

        text = laid_out(text, where) or text
    page = Page(pasted.unwrapped(text))
    budget = Budget()
    shown = [printout for part in _parts(page, budget) for printout in part]
    if budget.stopped is not None:
        line, column = page.place(page.glyphs[budget.stopped].offset)
        reason = f"what follows line {line}, column {column} was not read: there is too much of it"
        if not shown:
            raise UserError(f"no printout of the program in what was read of it; {reason}", where)
        shown[-1].unread = reason
    if shown:
        _keep_other_lines(page, shown)
        shown[0].notes += _left_out(text, page.text)
    if not shown:
        raise UserError(
            "no printout of the program in it; expected text with labels such as "
            "MA= ... MB= ... VAX= ... VAY= ...",
            where,
        )
    return shown


# --- what else stands on the page ---

_LABEL_WORDS = frozenset(
    word
    for text in (*map(label, FIELDS), "VAX VAY WA VBX VBY WB INITIAL")
    for word in text.replace("=", " ").split()
    if len(word) > 1
)


def _keep_other_lines(page: Page, printouts: Sequence[Printout]) -> None:
    """Every line that is none of the program's, whole: with the printout above it, or with the
    first. Where it holds a number, or one of the program's labels, it may bear on the page."""
    taken = {line for one in printouts for line in one.taken}
    place = 0
    for number, text in enumerate(page.text.split("\n"), 1):
        start, place = place, place + len(text) + 1
        words = text.split()
        if number in taken:
            _keep_ends(number, start, text, printouts)
            continue
        plain = glyphs.squeeze(text)
        if not plain or _SLOT_COMMAND.fullmatch(plain):
            continue
        bears = any(map(str.isdigit, text)) or any(
            part in _LABEL_WORDS or (len(part) > 2 and part.upper() in _LABEL_WORDS)
            for part in re.split(r"[^A-Za-z]+", text)
        )
        above = [one for one in printouts if one.line <= number]
        column = text.index(words[0]) + 1 if words else 1
        (above or printouts)[-1 if above else 0].left_over.append(
            Piece(" ".join(words), number, column, start, start + len(text), bears, True)
        )
    for one in printouts:
        one.left_over.sort(key=lambda piece: piece.start)
        one.notes += _normalised(page.text[one.start : one.stop])


def _keep_ends(number: int, start: int, text: str, printouts: Sequence[Printout]) -> None:
    """What stands on a line of the page before or after all that was taken for the page's."""
    stop = start + len(text)
    there = [one for one in printouts if one.start < stop and start < one.stop]
    if not there:
        return
    first, last = there[0], there[-1]
    for one, begin, end in ((first, start, first.start), (last, last.stop, stop)):
        piece = text[max(begin - start, 0) : max(end - start, 0)]
        plain = glyphs.squeeze(piece)
        if plain and not _SLOT_COMMAND.fullmatch(plain):
            begin += len(piece) - len(piece.lstrip())
            column = begin - start + 1
            one.left_over.append(
                Piece(" ".join(piece.split()), number, column, begin, begin + len(piece), True)
            )


def _normalised(text: str) -> list[str]:
    """That characters were taken for others of the same meaning, and how many of each kind."""
    count = Counter(
        unicodedata.name(char, f"U+{ord(char):04X}").lower().replace("u+0000", "NUL")
        for char in text
        if not char.isspace()
        and (char > "~" or char < " ")
        and glyphs.plain_glyphs(char) != char.upper()
    )
    kinds = ", ".join(f"{number} {name}" for name, number in sorted(count.items()))
    return [f"characters read as plain ones or passed over: {kinds}"] if kinds else []


def _left_out(text: str, unwrapped: str) -> list[str]:
    """That lines were left out as markup or as lines of a program."""
    pairs = zip(text.splitlines(), unwrapped.splitlines(), strict=False)
    lines = [
        number
        for number, (one, other) in enumerate(pairs, 1)
        if any(map(str.isalpha, one)) and not other.strip()
    ]
    if not lines:
        return []
    what = "1 line is" if len(lines) == 1 else f"{len(lines)} lines are"
    return [
        f"{what} markup or lines of a BASIC program, and not read: the first is line {lines[0]}"
    ]


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


def _parts(page: Page, budget: Budget) -> Iterator[list[Printout]]:
    """The printouts of each stretch of text up to where a run ended early."""
    text = numerals.plain(page.glyphs)
    start = 0
    for match in [*_ENDING.finditer(text), None]:
        if budget.spent:
            return
        stop = match.start() if match else len(text)
        aligned = list(align(page.glyphs[start:stop], budget))
        if budget.stopped is not None:
            budget.stopped += start
        shown = [printout for one in aligned if (printout := _Reader(page, start, one).read())]
        if match:
            if not shown:
                continue
            shown[-1].ending = _ending(match)
            begin, shown[-1].stop = page.span(match.start(), match.end())
            lines = {page.place(begin)[0], page.place(shown[-1].stop - 1)[0]}
            shown[-1].taken |= lines
            start = match.end()
        yield shown


class _Reader:
    """Reads one printout from what its glyphs are taken for."""

    def __init__(self, page: Page, base: int, aligned: Aligned) -> None:
        self._page = page
        self._glyphs = page.glyphs
        self._start = base + aligned.start
        self._states = aligned.states
        self._slots = {name: (base + i, base + j) for name, (i, j) in aligned.slots.items()}
        self._part_labels()
        start, stop = page.span(self._start, base + aligned.stop)
        self._printout = Printout(*page.place(start), start, stop, page=page)
        self._lines = set(aligned.lines)
        self._begun_within = begun_within(page, self._start, self._states)

    def _part_labels(self) -> None:
        """A word that stands apart from the number before it, and is joined to the next by its
        equals sign, is no part of either."""
        self._worded: set[int] = set()
        for first, sign in words_before(self._page, self._slots).values():
            self._worded.update(range(first, sign))
            for name, (start, stop) in self._slots.items():
                if start < first < stop and self._glyphs[first].gap:
                    self._slots[name] = (start, first)
                elif first <= start <= sign < stop - 1:
                    self._slots[name] = (sign + 1, stop)

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
        shown.ended = STARS[1] in self._lines
        shown.spin_line = self._letters(SPINS) >= 2
        self._keep_left_over()
        read = {name: self._slots[name] for name in shown.fields if name in self._slots}
        marks = shown.marks if len(shown.fields) >= _PART else READERS
        shown.labels = label_checks(self._page, self._start, self._states, read, marks)
        shown.misread_letters = self._misread_letters()
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
        wrong = {one.name for one in self._printout.mislabelled}
        others = {state for one in page.labels if one.name in wrong for state in one.states}
        before = 0
        for index, state in enumerate(self._states):
            letter = "" if state in others else page.letters.get(state, "")
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
        sign = template().letters.get(self._states[before]) if before >= 0 else None
        unsigned = sign != "=" or self._glyphs[start - 1].char != "="
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
        before = self._glyphs[start - 1].char != "?" and _before_reply(parts, printed)
        if before:
            what = _quoted(numerals.plain(parts[0][:before]))
            self._remark("", f"reply: {what} before the first number", start)
            parts = [parts[0][before:], *parts[1:]]
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
        """Runs of glyphs between lines or put into labels, on the lines of the page; and which
        glyphs those lines have (`_keep_other_lines` keeps the others)."""
        page = template()
        between = set(page.between.tolist()) | {0}
        lines: dict[int, list[int]] = {}
        for index in range(self._start, self._start + len(self._states)):
            lines.setdefault(self._page.place(self._glyphs[index].offset)[0], []).append(index)
        numbers = {index for span in self._slots.values() for index in range(*span)}
        numbered = {number for number, line in lines.items() if numbers & set(line)}
        taken: set[int] = set()
        for number, line in lines.items():
            if number not in numbered and not self._is_of_the_page(line):
                continue
            taken.add(number)
            run: list[int] = []
            for index in line:
                state = self._states[index - self._start]
                again = index > self._start and state == self._states[index - 1 - self._start]
                letter = page.letters.get(state)
                digit = letter in _NEXT_TO_NUMBERS and self._glyphs[index].char.isdigit()
                again = again and not (page.line[state] < 2 and self._glyphs[index].char in "_{}")
                loose = state in between or (letter is not None and (again or digit))
                if loose and index not in self._worded:
                    run.append(index)
                elif run:
                    self._keep(run, numbered)
                    run = []
            if run:
                self._keep(run, numbered)
        self._printout.taken = frozenset(taken)

    def _is_of_the_page(self, line: Sequence[int]) -> bool:
        """Whether a line on which no number stands is one of the program's: half of it are letters
        as it prints them, or it is a row of asterisks, however they were read."""
        letters, lines = template().letters, template().line
        states = [self._states[index - self._start] for index in line]
        chars = [self._glyphs[index].char for index in line]
        exact = sum(letters.get(state) == char for state, char in zip(states, chars, strict=True))
        stars = all(lines[state] in STARS for state in states)
        count = self._page.glyphs_on(line[0])
        return 2 * exact >= count or (stars and count <= _MOST_STARS)

    def _keep(self, run: list[int], numbered: set[int]) -> None:
        start, stop = self._page.span(run[0], run[-1] + 1)
        line, column = self._page.place(start)
        text = self._page.shown(run[0], run[-1] + 1)
        if _SLOT_COMMAND.fullmatch(glyphs.squeeze(text)):
            return
        self._printout.left_over.append(Piece(text, line, column, start, stop, line in numbered))


def _typed_so(reading: Reading) -> bool:
    """Whether a person may have typed a number so: in one piece, with O for 0 and l for 1 at
    worst."""
    whole = all(glyph.joined for glyph in reading.region[1:])
    return whole and all(glyph.char in _TYPED for glyph in reading.region)


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


def _before_reply(parts: Sequence[Region], printed: Sequence[str | None]) -> int:
    """How many glyphs of a prompt whose mark was not read stand before the first number of a reply,
    where that is then what is printed below; a reply never outranks a printed number."""
    first = parts[0]
    places = range(1, min(_OF_PROMPT, len(first) - 1) + 1)
    whole = numerals.plain(first)
    return next((at for at in places if printed[0] and _same(whole[at:], printed[0])), 0)


def _same(text: str, printed: str) -> bool:
    return (value := numerals.value_of(printed)) is not None and value == numerals.value_of(text)


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
