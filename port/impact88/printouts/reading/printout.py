"""Printouts read from text, typed in or from an optical reader, into named fields.

The text is aligned with the program's page (`alignment`), which says what every glyph belongs to.
Here each printout's numbers get their names and places, the replies at the prompts are parted, the
row of angles is cut, and what belongs nowhere is kept as left over.
"""

import re
import unicodedata
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby, pairwise, zip_longest

from ...apple.applesoft.errorcodes import CODES
from ...errors import UserError, printable, quoted
from ..fields import ANGLES, FIELDS, FINAL_SPINS, REPLIES, ZERO_DETERMINANT
from . import numerals
from . import plaintext as pasted
from .alignment import (
    ANGLES_ROW,
    LINES,
    PROMPTS,
    SPINS,
    STARS,
    STATES,
    TOKEN_OF,
    WORDS,
    Budget,
    align,
    letter_of,
)
from .differences import Difference, Kind, difference_at
from .glyphs import Gap, Page, Region, letters, plain_glyphs
from .labels import (
    asterisk_note,
    form_note,
    has_gaps_only,
    label_differences,
    mark_differences,
    weigh_labels,
    words_before,
)
from .pagerows import find_rows, is_stars

LARGEST_FILE = 2_000_000
"""Bytes of the largest file that is read: some 2,500 printouts."""
MACHINE_READ = 3
"""Misread letters of labels and damaged numbers from which a machine read the page: people do not
type PE for PB."""
BADLY_READ = 17
"""Misread letters, asterisks and numbers from which a page is badly read: of the given scans that
differ 58 of 88 readings of genuine pages have as many, and 2 of 84 of pages with an altered
digit."""
_MIN_NUMBERS = 15
"""Numbers of a page; labels of a smaller piece do not tell which numbers it holds."""
_MIN_ROWS = 3
"""Rows of a printout that begins elsewhere than the program's page; fewer are a row or two that
stand below the page, or above it."""
_MIN_NOTE_LETTERS = 5
"""Letters of no label, four a number, from which a line is a note: ``BREAK IN 640``.
The program's labels have three letters a number at most but on the line of the energies."""
_PROMPT_LETTERS = 25
"""Letters of a prompt, half of all, from which it counts as read."""
_TYPED = frozenset("0123456789.,-+EOILQ?")
_REPLY_SLOTS = tuple(f"REPLY_{side}" for side in REPLIES)
_SLOT_COMMAND = re.compile(r"PR#[0-9]")
"""Output of line 610 where no DOS takes it for a command."""


@dataclass(frozen=True)
class Reading:
    """One number as read.

    Parameters
    ----------
    text : str
        The number, with ``?`` for illegible characters.
    line, column, start, stop : int
        Its place in the text: line and column from 1, and offsets.
    region : tuple of Glyph
        Its glyphs.
    cut : bool
        True if it stands at the end of the text, or of a line as wide as the page that does not go
        on below, so that more of it may be lost.
    sign_free : bool
        True if a minus before it may be the damaged equals sign of the label.
    """

    text: str
    line: int
    column: int
    start: int
    stop: int
    region: Region
    cut: bool = False
    sign_free: bool = False

    @property
    def clean(self) -> bool:
        """True if every character of it was read beyond doubt."""
        return numerals.clean(self.region) is not None

    def texts(self, most: int) -> dict[str, float]:
        """Return the texts that it may have been printed as.

        Parameters
        ----------
        most : int
            The largest number of texts.

        Returns
        -------
        dict of str to float
            Penalty of each text, the likeliest first; one text if the number was read cleanly.
        """
        ways = numerals.candidates(self.region, most, self.sign_free)
        if self.clean and (ways or numerals.value_of(self.text) is not None):
            return dict(ways[:1] or [(self.text, 0.0)])
        return dict(ways)


@dataclass(repr=False)
class Printout:
    """One printout as read from a text, by `read_printouts`.

    Parameters
    ----------
    page : Page
        The text as glyphs.
    _states : mapping of int to int
        The character of the program's page that each glyph was aligned with.
    line, column : int
        Line and column of the text, from 1, at which the printout begins.
    start, stop : int
        Offsets in the text of its begin and end.
    fields : dict of str to Reading
        Every number found, by the field's name.
    replies : dict of str to Reading
        The velocities typed at the prompts, where the transcript shows them.
    angles : list of Row
        Where blanks alone do not tell the five angles of a row apart: the ways to read the row, the
        likeliest first.
    ending : str, optional
        ``ZERO DETERMINANT`` or an Applesoft error as printed, with its line.
    ended : bool
        True if anything of the last row of asterisks was found.
    has_final_spins : bool
        True if the line of the final WA and WB was found, read or not: then M = N.
    left_over : list of Difference
        Text that belongs to no field and no label.
    remarks : list of str
        What could not be read, and its place.
    labels : list of Difference
        Labels and marks that are not as the program prints them.
    notes : list of str
        What was normalised or passed over.
    unread : str
        Why the text was not read to its end, empty if it was.
    misread_letters : int
        Letters of labels and asterisks that were read as others.
    misread_prompts : set of str
        The first reply of each prompt whose question mark was read as another character.
    own : range
        The glyphs of the text that it accounts for: from its first (those above the first printout
        are the first's) to the next printout.
    markup : int
        Characters of markup that were passed over in the text of which it is the first printout.
    exchanged : list of str
        What is said of rows in another order than the program's.
    repeated, contradicting : list of str
        What is said of rows that are printed a second time; and of those among them that stand
        within the page with other numbers.
    echoed : set of int
        Offsets of what the Apple shows in the replies besides their numbers.

    Examples
    --------
    >>> (printout,) = impact88.read_printouts(impact88.run(impact88.sample(1)).page)
    >>> printout.fields["VAX"].text, printout.fields["VAX"].line
    ('-13.263', 25)
    """

    page: Page = field(repr=False)
    _states: Mapping[int, int] = field(repr=False)
    line: int = 0
    column: int = 0
    start: int = 0
    stop: int = 0
    fields: dict[str, Reading] = field(default_factory=dict)
    replies: dict[str, Reading] = field(default_factory=dict)
    angles: list[numerals.Row] = field(default_factory=list)
    ending: str | None = None
    ended: bool = False
    has_final_spins: bool = False
    left_over: list[Difference] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    labels: list[Difference] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    unread: str = ""
    misread_letters: int = 0
    misread_prompts: set[str] = field(default_factory=set)
    own: range = range(0)
    markup: int = 0
    exchanged: list[str] = field(default_factory=list)
    repeated: list[str] = field(default_factory=list)
    contradicting: list[str] = field(default_factory=list)
    echoed: set[int] = field(default_factory=set)

    def __post_init__(self) -> None:
        glyphs, states = self.page.glyphs, self._states
        self._slots: dict[str, tuple[int, int]] = {}  # of every number its glyphs
        for index, state in states.items():
            if STATES[state].kind == "number":
                name = STATES[state].name
                self._slots[name] = (self._slots.get(name, (index, 0))[0], index + 1)
        # a word that stands apart from the number before it, and is joined to the next by its
        # equals sign, is no part of either
        self._words: set[int] = set()
        for first, sign in words_before(self.page, self._slots).values():
            self._words.update(range(first, sign))
            for name, (start, stop) in self._slots.items():
                if start < first < stop and glyphs[first].gap:
                    self._slots[name] = (start, first)
                elif first <= start <= sign < stop - 1:
                    self._slots[name] = (sign + 1, stop)
        self._close_numbers()
        self._part_angles()
        for name, (start, stop) in self._slots.items():
            if name in FIELDS:
                end = start + numerals.note_start(glyphs[start:stop])
                self._slots[name] = (start, end)
        self._exact = {
            index: STATES[state].line
            for index, state in self._states.items()
            if letter_of(state) == glyphs[index].char
        }
        # without what was put in behind its last character
        offsets = [glyphs[index].offset for index in self.roles() or states]
        self.start, self.stop = min(offsets), max(offsets) + 1
        self.line, self.column = self.page.place(self.start)

    def _close_numbers(self) -> None:
        """End numbers at the mark that the program prints right behind them, ``)`` or ``%``."""
        glyphs = self.page.glyphs
        for place, state in enumerate(STATES[1:], 1):
            name = STATES[place - 1].name
            if state.name not in (")", "%") or name not in self._slots:
                continue
            start, stop = self._slots[name]
            for at in range(start + 1, stop - 1):
                if glyphs[at].char != state.name:
                    continue
                if numerals.clean(glyphs[start:at]):
                    self._slots[name] = (start, at)
                    later = [index for index, own in self._states.items() if own == place]
                    after = dict.fromkeys([*range(at + 1, stop), *later], 0)
                    self._states = {**self._states, **after, at: place}
                break

    def _part_angles(self) -> None:
        """Part the row of angles: at blanks, on its line or in all, where these leave five clean
        numbers between what holds no figure; else in the likeliest way. Four clean numbers are left
        together: nothing tells which of the five is lost."""
        if ANGLES_ROW not in self._slots:
            return
        glyphs = self.page.glyphs
        begin, stop = self._row = self._slots[ANGLES_ROW]
        starts = [at for at in range(begin, stop) if at == begin or glyphs[at].gap]
        parts = [*pairwise([*starts, stop])]
        figures = [any(map(str.isdigit, letters(glyphs[slice(*part)]))) for part in parts]
        while figures and not figures[-1]:  # a speck at the line's end
            figures.pop()
        parts = parts[figures.index(True) : len(figures)] if figures else []
        breaks = (at for at, (i, _) in enumerate(parts) if at and glyphs[i].gap is Gap.LINE)
        rows = [
            row
            for row in (parts[: next(breaks, None)], parts)
            if all(numerals.clean(glyphs[slice(*part)]) for part in row)
        ]
        parts = next((row for row in rows if len(row) == len(ANGLES)), [])
        one_is_lost = any(len(row) == len(starts) == len(ANGLES) - 1 for row in rows)
        if not parts and not one_is_lost:
            self.angles = numerals.rows(glyphs[begin:stop], len(ANGLES))
            parts = self._parts_of(self.angles[0]) if self.angles else []
        if parts:
            del self._slots[ANGLES_ROW]
            self._slots.update(zip(ANGLES, parts, strict=True))

    def _parts_of(self, row: numerals.Row) -> list[tuple[int, int]]:
        """Return the range of glyphs of each angle in a reading of their row."""
        begin, stop = self._row
        return [*pairwise([*(begin + start for start in row.starts), stop])]

    def angle_regions(self, texts: Sequence[str]) -> dict[str, Region]:
        """Return the glyphs of each angle, as the reading of their row nearest to a page parts it.

        Parameters
        ----------
        texts : sequence of str
            The five angles that the program prints.

        Returns
        -------
        dict of str to sequence
            Glyphs by name; empty where blanks alone divide the row.
        """
        if not self.angles:
            return {}
        nearest = max(self.angles, key=lambda row: sum(map(str.__eq__, row.texts, texts)))
        parts = zip(ANGLES, self._parts_of(nearest), strict=True)
        return {name: self.page.glyphs[start:stop] for name, (start, stop) in parts}

    def __repr__(self) -> str:
        return f"<Printout at line {self.line}: {len(self.fields)} numbers read>"

    @property
    def mislabelled(self) -> list[Difference]:
        """Labels that name another number than the one beside them."""
        return [label for label in self.labels if label.kind is Kind.CONTRADICTS]

    @property
    def out_of_order(self) -> bool:
        """True if rows of a page of the program's form are out of its order.

        A page without prompts and rows of asterisks is a list of numbers, in an order of its own.
        """
        return bool(self.exchanged) and (bool(self.replies) or self.ended)

    @property
    def rows_contradict(self) -> bool:
        """True if rows are out of order, or printed a second time with other numbers.

        Where a machine read the page, the other numbers may be its misreadings.
        """
        return self.out_of_order or (bool(self.contradicting) and not self.machine_read)

    @property
    def is_of_another_form(self) -> bool:
        """True if labels or rows contradict: no reader of the page did that."""
        return bool(self.mislabelled) or self.rows_contradict

    @property
    def number_starts(self) -> list[int]:
        """The first glyphs of its printed numbers; all its glyphs where it has none."""
        slots = [slot for name, slot in self._slots.items() if name not in _REPLY_SLOTS]
        return [start for start, _ in slots] or [*self._states]

    def is_piece(self, below: "Printout | None") -> bool:
        """Return True for what is no page of the program's, but a row or two.

        It does not begin as a page does, with the first prompt or a row of masses whose first label
        is read as printed; or the page that it begins goes on in the printout below it.

        Parameters
        ----------
        below : Printout or None
            The printout that follows, None for the last.

        Returns
        -------
        bool
            True for a piece.
        """
        masses = {self._letter(at) for at, line in self._exact.items() if line == PROMPTS}
        begins = self._has_first_prompt or masses.issuperset("MA")
        goes_on = below and len(below.fields) >= _MIN_NUMBERS and not below._has_first_prompt
        is_whole = begins and not (self._has_first_prompt and goes_on)
        rows = {STATES[self._states[at]].line for at in self.number_starts} - {*range(PROMPTS)}
        return not (self.ending or is_whole) and len(rows) < _MIN_ROWS

    @property
    def _has_first_prompt(self) -> bool:
        return any(self._line(at) == 0 for at in self._states)

    @property
    def signs_of_reader(self) -> int:
        """Number of signs of an optical reader.

        Counted are misread letters of labels, and labels that lack some; numbers that nobody would
        type so, in pieces or with more than O for 0 and l for 1; and specks beside numbers.
        """
        specks = (
            piece.kind is Kind.LEFT_OVER and bool(piece.name) and len(piece.read) <= 3
            for piece in self.left_over
        )
        return (
            self.misread_letters
            + sum(specks)
            + sum(
                any(glyph.gap for glyph in region[1:]) or not _TYPED.issuperset(letters(region))
                for region in (field.region for field in self.fields.values())
            )
        )

    @property
    def machine_read(self) -> bool:
        """True if the text shows signs of an optical reader: misread labels, damaged numbers."""
        return self.signs_of_reader >= MACHINE_READ

    @property
    def badly_read(self) -> bool:
        """True if too much was misread to tell an altered digit from a misread one."""
        return self.signs_of_reader >= BADLY_READ

    @property
    def fragment(self) -> bool:
        """True if it holds too few numbers, five at most, to be called a printout."""
        return len(self.fields) <= 5

    @property
    def fragment_of_run(self) -> bool:
        """True if it holds no final velocity of a center and no message that says why."""
        return self.ending is None and self.fields.keys().isdisjoint(("VAX", "VAY", "VBX", "VBY"))

    def text(self, name: str) -> str | None:
        """Return the text of a field.

        Parameters
        ----------
        name : str
            Name of the field.

        Returns
        -------
        str or None
            The number as read, None if the field was not read.
        """
        reading = self.fields.get(name)
        return reading.text if reading else None

    def _letter(self, index: int) -> str:
        return letter_of(self._states.get(index, 0))

    def _line(self, index: int) -> int:
        return STATES[self._states.get(index, 0)].line

    def read(self) -> bool:
        """Read the numbers.

        Returns
        -------
        bool
            True if there are enough numbers for a printout, or a prompt.
        """
        self._drop_cropped()
        for name, (start, stop) in self._slots.items():
            if name in FIELDS:
                has_sign = self._letter(start - 1) == "=" == self.page.glyphs[start - 1].char
                sign_free = not has_sign and name not in ANGLES
                reading = reading_of(self.page, self.page.glyphs[start:stop], sign_free)
                if reading:
                    self.fields[name] = reading
                else:
                    self._remark(name, start, ": expected a number", self.page.shown(start, stop))
        if not self._is_worth_reporting():
            return False
        self.has_final_spins = [*self._exact.values()].count(SPINS) >= 2
        for name in () if self.has_final_spins else FINAL_SPINS:  # a footer, a page number
            self.fields.pop(name, None)
            self._slots.pop(name, None)
        for side, names in REPLIES.items():
            if slot := self._slots.get(f"REPLY_{side}"):
                self._read_reply(names, slot[0])
        self._remark_on_prompts()
        if ANGLES_ROW in self._slots:
            start, stop = self._slots[ANGLES_ROW]
            row = self.page.shown(start, stop)
            self._remark("PA", start, ": expected five angles, PA PB TA TB GA", row)
        self.ended = any(self._line(index) == STARS for index in self._states)
        return True

    def end(self, message: re.Match[str], text: str) -> int:
        """End the printout with a message, such as an error of Applesoft.

        Parameters
        ----------
        message : re.Match
            The message in the text of the page's glyphs.
        text : str
            The text of the page's glyphs.

        Returns
        -------
        int
            Place of the glyph behind the message.
        """
        begin, stop = message.span()
        self.ending = _ENDINGS[message[1].replace("'", "")]
        if self.ending != ZERO_DETERMINANT and (line := _IN_LINE.match(text, stop)):
            self.ending += f" IN {line[1].translate(_DIGITS)}"
            stop = line.end()
        self.stop = self.page.span(begin, stop)[1]
        self._exact |= dict.fromkeys(range(begin, stop), -1)
        return stop

    def check_labels(self) -> None:
        """Set ``labels`` and ``misread_letters``: labels and marks that are not the program's."""
        read = {name: self._slots[name] for name in self.fields if name in self._slots}
        self.labels = label_differences(self.page, self._states, read)
        self.misread_letters = self._count_misread()
        is_piece = len(self.fields) < _MIN_NUMBERS
        self.labels = weigh_labels(self.labels, self.machine_read, is_piece)
        self.misread_letters = self._count_misread()
        replies = {name: slot for name, slot in self._slots.items() if name not in FIELDS}
        self.labels += mark_differences(
            self.page, self._states, read | replies, self.labels, self.machine_read
        )

    def misread(self) -> list[Difference]:
        """Return the characters of labels, marks and prompts that are read as others.

        Returns
        -------
        list of Difference
            One for each, in the order of the page.
        """
        return [
            difference_at(
                self.page, Kind.LOOK_ALIKE if self._letter(index) else Kind.ILLEGIBLE,
                TOKEN_OF[self._states[index]].name if self._letter(index) else "",
                self._letter(index), self.page.span(index, index + 1), self.page.glyphs[index].char,
            )
            for index, role in sorted(self.roles().items())
            if role == "letter"
        ]  # fmt: skip

    def read_otherwise(self) -> list[str]:
        """Return a note on misread letters of labels that leave no doubt which number is meant.

        Returns
        -------
        list of str
            One note with the letters by line, or none.
        """
        reported = {
            at for label in self.labels if label.bears for at in range(label.start, label.stop)
        }
        by_line: dict[int, list[str]] = {}
        for one in self.misread():
            if one.start not in reported and one.printed:
                by_line.setdefault(one.line, []).append(f"{one.read} for {one.printed}")
        said = [f"line {line}: {', '.join(marks)}" for line, marks in sorted(by_line.items())]
        return [f"letters and marks read as others: {'; '.join(said)}"] if said else []

    def _drop_cropped(self) -> None:
        """Drop numbers at the beginning of lines if the left margin is cut off.

        It is where most lines that begin with a label lack its first letter, three lines at least.
        """
        states_read = set(self._states.values())
        first = [index for index in self._states if self.page.glyphs[index].gap is Gap.LINE]
        before = [self._states[at] - 1 for at in first if self._letter(at) not in ("", "*")]
        lost = sum(bool(letter_of(state)) and state not in states_read for state in before)
        if lost > max(2, len(before) / 2):
            for name, (start, _) in [*self._slots.items()]:
                if start in first:
                    self._remark(name, start, "begins where the margin is cut off")
                    del self._slots[name]

    def _count_misread(self) -> int:
        """Return how many letters of labels were read as other letters or figures, and how many
        labels lack letters only; labels that contradict are left out."""
        wrong = {label.name for label in self.mislabelled}
        excluded = {state for word in WORDS if word.name in wrong for state in word.states}
        damaged = (label for label in self.labels if label.kind is Kind.LOOK_ALIKE)
        return sum(has_gaps_only(label.printed, label.read) for label in damaged) + sum(
            self.page.glyphs[index].char != letter and self.page.glyphs[index].char.isalnum()
            for index, state in self._states.items()
            if state not in excluded and state != self._states.get(index - 1)
            and ((letter := letter_of(state)) == "*" or letter.isalpha())
        )  # fmt: skip

    def _is_worth_reporting(self) -> bool:
        """Return True if a label and its number, or a prompt, was read."""
        if sum(line < PROMPTS for line in self._exact.values()) >= _PROMPT_LETTERS:
            return True
        numbers = {name for name, field in self.fields.items() if any(map(str.isdigit, field.text))}
        if self.angles or not numbers.issuperset(ANGLES[:-1]):
            numbers -= set(ANGLES)
        read = {self._states[index] for index in self._exact}
        labelled = {word.name for word in WORDS if not read.isdisjoint(word.states)} | {*ANGLES}
        count = len(numbers & labelled)
        return count >= 1 and count + len(self._exact) >= 5

    def _remark(self, name: str, index: int, message: str, read: str | None = None) -> None:
        """Add a remark on a glyph: its place, its field, what it reads, what is wrong."""
        line, column = self.page.place(self.page.glyphs[index].offset)
        quoted_text = "" if read is None else repr(read if len(read) <= 30 else read[:27] + "...")
        self.remarks.append(f"line {line}, column {column}: {name}: {quoted_text}{message}")

    def _remark_on_prompts(self) -> None:
        """Add a remark on a prompt that has no reply, and on one that is missing where the other is
        on the page."""
        letters_read = Counter(line for line in self._exact.values() if line in range(PROMPTS))
        for line, (side, names) in enumerate(REPLIES.items()):
            if letters_read[line] >= _PROMPT_LETTERS and names[0] not in self.replies:
                if f"REPLY_{side}" not in self._slots:
                    self.remarks.append(f"no reply at the prompt of M{side}")
            elif letters_read.total() >= _PROMPT_LETTERS and not letters_read[line]:
                self.remarks.append(f"the prompt of M{side} is missing")

    def _read_reply(self, names: Sequence[str], start: int) -> None:
        """Read the three numbers typed at a prompt, after any that INPUT refused."""
        stop, line, glyphs = start, self._line(start), self.page.glyphs
        other_starts = {begin for begin, _ in self._slots.values()} - {
            start
        }  # one may lack its label
        while (
            stop not in other_starts
            and (state := self._states.get(stop))
            and (not self._letter(stop) or self._line(stop) == line)
        ):
            # what the Apple answers begins with a question mark
            is_below = STATES[state].kind == "between" and glyphs[stop].gap is Gap.LINE
            if is_below and glyphs[stop].char != "?":
                break
            stop += 1
        parts, echoed = _reply_parts(glyphs[start:stop])
        # a prompt's end whose mark was not read, before what is printed below
        value = numerals.value_of(self.text(names[0]) or "")
        first = letters(parts[0])
        for at in range(1, min(len("Wa ?"), len(first))):
            if value is not None and numerals.value_of(first[at:]) == value:
                if glyphs[start - 1].char != "?":
                    self.misread_prompts.add(names[0])
                    self._remark("reply", start, " before the first number", first[:at])
                    parts[0] = parts[0][at:]
                break
        if len(parts) > len(names) and all(map(numerals.clean, parts[:3])):
            extra = "".join(map(letters, parts[3:]))
            self._remark("reply", start, " after the third number", extra)
            parts = parts[:3]
            used = {glyph.offset for part in parts for glyph in part}
            echoed = {offset for offset in echoed if offset < max(used)}
        readings = [reading_of(self.page, region) for region in parts]
        if len(parts) == len(names) and all(readings):
            for name, reading in zip(names, readings, strict=True):
                if reading is not None:
                    self.replies[name] = reading
            self.echoed |= echoed
        elif parts != [()]:
            self._remark("reply", start, " is not three numbers", self.page.shown(start, stop))

    def roles(self) -> dict[int, str]:
        """Return the role of each glyph that belongs to the program's page.

        Returns
        -------
        dict of int to str
            ``"number"``, ``"exact"`` (a letter of a label, as the program prints it) or
            ``"letter"`` (a misread one) by the glyph's place on the page. Glyphs between the lines
            or inserted into labels are left out.
        """
        roles = dict.fromkeys(self._exact, "exact")
        for index, state in self._states.items():
            letter, figure = letter_of(state), self.page.glyphs[index].char.isdigit()
            is_inserted = state == self._states.get(index - 1) or (letter in "%()=" and figure)
            if letter and is_inserted:
                roles.pop(index, None)
            elif letter:
                roles.setdefault(index, "letter")
        roles = dict.fromkeys(self._words, "letter") | roles
        for span in self._slots.values():
            roles |= dict.fromkeys(range(*span), "number")
        return roles


def reading_of(page: Page, region: Region, sign_free: bool = False) -> Reading | None:
    """Return a region of a page as a number, None if it holds nothing of one."""
    text = numerals.taken_for(region, sign_free)
    if text is None:
        return None
    begin, end = region[0].offset, region[-1].offset + 1
    cut = region[-1].offset == page.glyphs[-1].offset and end == len(page.text)
    goes_on = re.match(r"\n[^\n]*\S", page.text[end : end + 2 * page.width + 2])
    cut = cut or (page.place(end - 1)[1] == page.width and not goes_on)
    return Reading(text, *page.place(begin), begin, end, region, cut, sign_free)


def _reply_parts(region: Region) -> tuple[list[Region], set[int]]:
    """Return the glyphs of a reply, divided at its commas and where INPUT asked for more; and the
    offsets of what the Apple shows besides: the commas, question marks, and its answers to numbers
    that INPUT refused before it, or ignored behind it.
    """
    text = letters(region)
    match = re.search(r"(?:(.*)\?REENTER)?\?*(.*?)(?:\?EXTRAIGNORED|PR#|$)", text)
    if match is None:
        return [()], set()
    refused = (match[1] or "").rpartition("?")[2].split(",")
    is_echo = match[1] is None or not all(map(numerals.is_number, refused))
    echoed = {glyph.offset for glyph in region[: match.start(2)] if is_echo}
    if "?EXTRAIGNORED" in text[match.end(2) :]:
        echoed |= {glyph.offset for glyph in region[match.end(2) :][: len("?EXTRAIGNORED")]}
    region = region[slice(*match.span(2))]
    parts: list[Region] = [()]
    for place, glyph in enumerate(region):
        is_next = glyph.gap is Gap.LINE and letters(region[place : place + 2]) == "??"
        is_mark = glyph.char == "?" and place and region[place - 1].char == "?"
        if glyph.char in ",;" or is_next:
            parts.append(())
        elif not is_mark:
            parts[-1] += (glyph,)
        if glyph.char == "," or is_next or is_mark:
            echoed.add(glyph.offset)
    return parts, echoed


def read_printouts(text: str, where: str = "text") -> list[Printout]:
    """Return the printouts in a text, in order.

    Parameters
    ----------
    text : str
        A page, or several, as typed in or as an OCR engine read them.
    where : str, default "text"
        What messages call the text.

    Returns
    -------
    list of Printout
        Each with the numbers it holds, ``fields``, by the names of `impact88.names`.

    Raises
    ------
    UserError
        Where there is no printout in it.

    Examples
    --------
    >>> (printout,) = impact88.read_printouts(impact88.run(impact88.sample(1)).page)
    >>> printout.fields["MA"].text
    '143.5'
    """
    if not isinstance(text, str):
        raise UserError(f"{quoted(text)}: expected a text; impact88.verify takes files and bytes")
    text = text.replace("\r\n", " \n").replace("\r", "\n")
    unmarked = pasted.strip_markup(text)
    plain = pasted.plain_formulas(unmarked)
    stripped, prefix = pasted.strip_prefix(plain)
    columns = [_read_column(part) for part in pasted.columns(stripped)]
    if not all(found for found, _ in columns):
        columns = [_read_column(stripped)]
    found = [printout for printouts, _ in columns for printout in printouts]
    if not found:
        expected = "expected text with labels such as MA= ... MB= ... VAX= ... VAY= ..."
        raise UserError(f"no printout of the program in it; {columns[0][1] or expected}", where)
    found[0].notes += [*_left_out_note(text, plain), *_markup_note(text, plain)]
    if prefix:
        note = f"what stands before every line was passed over: the first is {printable(prefix)}"
        found[0].notes.append(note)
    found[0].markup = _count_shown(text) - _count_shown(stripped)
    for printout in found:
        printout.left_over += _markup_pieces(printout, text, unmarked)
    return found


_MIN_MARKED = 5  # times that a piece of markup stands on a page of which it is the form


def _markup_pieces(printout: Printout, text: str, unmarked: str) -> list[Difference]:
    """Return the markup within a printout that stands there few times: it was typed there, or is
    shown to nobody, rather than the form of the text."""
    last, _ = printout.page.place(printout.stop - 1)
    first, start = printout.line - 1, printout.start - printout.column + 1
    pairs = zip(text.split("\n")[first:last], unmarked.split("\n")[first:last], strict=True)
    lines = [(line, _markup_runs(line, unmarked_line)) for line, unmarked_line in pairs]
    counts = Counter(kind for _, runs in lines for *_, kind in runs)
    pieces = []
    for number, (line, runs) in enumerate(lines, printout.line):
        within = range(printout.start - start, printout.stop - start)
        odd = [run for run in runs if counts[run[2]] < _MIN_MARKED and run[0] in within]
        if odd:
            begin, end = odd[0][0], odd[-1][1]
            place = (number, begin + 1, start + begin, start + end)
            pieces.append(Difference(Kind.LEFT_OVER, "", line[begin:end], "", *place))
        start += len(line) + 1
    return pieces


def _markup_runs(line: str, unmarked: str) -> list[tuple[int, int, str]]:
    """Return begin, end and kind of each run of characters that were stripped from a line.

    Its kind is its text; all names of characters are of one kind.
    """
    mask = "".join(
        " " if char.isspace() or char == after else "x"
        for char, after in zip(line, unmarked, strict=False)
    )
    return [
        (*match.span(), re.sub("(&[^;]{1,9};)+", "&", line[slice(*match.span())]))
        for match in re.finditer("x+", mask)
    ]


def _count_shown(text: str) -> int:
    return sum(len(plain_glyphs(char)) for char in text if not char.isspace())


def _read_column(text: str) -> tuple[list[Printout], str]:
    """Return the printouts of a text that stands in one column, and why what follows them was not
    read where that is so."""
    page = Page(text)
    rows = find_rows(page)
    left_out = {page.glyphs[at].offset for at in rows.doubled | rows.foreign}
    page.reorder(rows.order)
    budget = Budget()
    none_of_it = {at for at, glyph in enumerate(page.glyphs) if glyph.offset in left_out}
    printouts, pieces = _printouts(page, budget, none_of_it)
    reason = ""
    if budget.stopped is not None:
        line, column = page.place(page.glyphs[budget.stopped].offset)
        reason = f"what follows line {line}, column {column} was not read: there is too much of it"
        printouts = [printout for printout in printouts if len(printout.fields) >= _MIN_NUMBERS]
    if not printouts:
        return [], reason
    printouts[-1].unread = reason
    apart = [page.glyphs[at].offset for piece in pieces for at in piece.number_starts]
    _keep_left_over(page, printouts, {page.place(offset)[0] for offset in apart})
    for offset, sentence in rows.exchanged:
        owner = _owner(printouts, offset)
        owner.remarks.append(sentence)
        owner.exchanged.append(sentence)
    for offset, sentence, other in rows.repeated:
        owner = _owner(printouts, offset)
        owner.remarks.append(other or sentence)
        owner.repeated.append(other or sentence)
        owner.contradicting += [other] * (bool(other) and owner.start <= offset < owner.stop)
    commands = _slot_commands(page)
    for printout in printouts:
        printout.echoed |= {page.glyphs[at].offset for at in commands.intersection(printout.own)}
        printout.check_labels()
        printout.notes += _character_notes(printout)
        printout.notes += printout.read_otherwise()
        printout.notes += form_note(printout.labels)
        printout.notes += asterisk_note({*printout._states.values()}, printout.fields)
    return printouts, reason


def _owner(printouts: Sequence[Printout], offset: int) -> Printout:
    """Return the printout that begins above a place of the text, or the first."""
    above = [printout for printout in printouts if printout.start <= offset]
    return (above or printouts[:1])[-1]


_ALIKE = str.maketrans("0QL1|!582’`", "OOIIIISBZ''")
_DIGITS = str.maketrans("OQIL|!", "001111")
_MESSAGES = {f"{code}ERROR": f"?{code} ERROR" for code in CODES} | {
    ZERO_DETERMINANT: ZERO_DETERMINANT
}
_ENDINGS = {re.sub("[ ']", "", said).translate(_ALIKE): shown for said, shown in _MESSAGES.items()}
_ENDING = re.compile(r"\??(" + "|".join(map("'?".join, _ENDINGS)) + ")")
_IN_LINE = re.compile("[I1L|!]N([0-9OQIL|!]{1,5})")


def _slot_commands(page: Page) -> set[int]:
    """Return the glyphs of line 610's commands, printed where no DOS takes them."""
    matches = _SLOT_COMMAND.finditer(letters(page.glyphs))
    return {at for match in matches for at in range(*match.span())}


def _printouts(
    page: Page, budget: Budget, none_of_it: set[int]
) -> tuple[list[Printout], list[Printout]]:
    """Return the printouts of a page, and pieces that are none (`Printout.is_piece`) beside them; a
    message that ended a run ends its printout. ``none_of_it``: glyphs that are known to be none of
    the program's."""
    text = letters(page.glyphs)
    commands = _slot_commands(page) | none_of_it
    found: list[Printout] = []
    pieces: list[Printout] = []
    start = 0
    for message in [*_ENDING.finditer(text.translate(_ALIKE)), None]:
        stop = message.start() if message else len(text)
        parts = [*align(page.glyphs, start, stop, budget, commands)]
        if notes := _note_glyphs(page, start, stop, parts):
            parts = [*align(page.glyphs, start, stop, budget, notes | commands)]
        readable = [printout for part in parts if (printout := Printout(page, part)).read()]
        pairs = zip_longest(readable, readable[1:])
        apart = [printout for printout, below in pairs if printout.is_piece(below)]
        if apart and len(apart) < len(readable):
            pieces += apart
            taken = page.lines_of(at for piece in apart for at in piece.number_starts)
            parts = [*align(page.glyphs, start, stop, budget, notes | commands | taken)]
            readable = [printout for part in parts if (printout := Printout(page, part)).read()]
        if message and readable:
            start = readable[-1].end(message, text)
        found += readable
        if budget.stopped is not None:
            break
    return found, pieces


def _note_glyphs(page: Page, start: int, stop: int, found: Sequence[Mapping[int, int]]) -> set[int]:
    """Return the glyphs of lines that are notes, though a number on them was taken for the page's.

    More than half of the letters of a note, `_MIN_NOTE_LETTERS` at least and four a number, belong
    to no label.
    """
    read = {at: state for states in found for at, state in states.items()}
    notes: set[int] = set()
    for line_range in page.lines:
        line = [at for at in line_range if start <= at < stop]
        states_on_line = (STATES[read.get(at, 0)] for at in line)
        if any(state.kind == "number" and state.name in FIELDS for state in states_on_line):
            words = [at for at in line if page.glyphs[at].char.isalpha()]
            strange = sum(letter_of(read.get(at, 0)) != page.glyphs[at].char for at in words)
            text = "".join(" "[: page.glyphs[at].gap] + page.glyphs[at].char for at in line)
            if strange >= max(
                _MIN_NOTE_LETTERS, 4 * len(re.findall(r"[0-9.]+", text)), len(words) / 2
            ):
                notes.update(line)
    return notes


_NAMED_NUMBER = re.compile(r"[A-Za-z] ?= ?[-+.]?[0-9]")
_LABEL_WORDS = {*re.findall("[A-Z]{2,}", re.sub("{.*?}", "", " ".join(LINES[PROMPTS:])))}


def _keep_left_over(page: Page, found: Sequence[Printout], apart: set[int]) -> None:
    """Add text that belongs to no printout to ``left_over`` of the one above it, or of the first,
    and set the glyphs that each accounts for.

    A line belongs to a page if a number stands on it, half of its glyphs are letters as printed, or
    it is a row of asterisks; of such lines the rest is left over, of others all. What stands within
    a page bears on it; so does outside of it a line that holds a label, or one of the lines
    ``apart``.
    """
    starts = [0, *(min(printout._states) for printout in found[1:]), len(page.glyphs)]
    for printout, start, stop in zip(found, starts, starts[1:], strict=False):
        printout.own = range(start, stop)
    spans = [(printout.line, page.place(printout.stop - 1)[0]) for printout in found]
    roles = {index: role for printout in found for index, role in printout.roles().items()}
    fields = {
        index: ANGLES[0] if name == ANGLES_ROW else name
        for printout in found
        for name, span in printout._slots.items()
        for index in range(*span)
    }
    for line in page.lines:
        kinds = [roles.get(index) for index in line]
        numbers = [index for index in line if index in fields]
        stars = is_stars(page, line)
        is_whole = not (numbers or stars or 2 * kinds.count("exact") >= len(kinds))
        loose = [at for at in line if is_whole or at not in roles]
        for _, pairs in groupby(enumerate(loose), lambda pair: pair[1] - pair[0]):
            run = [index for _, index in pairs]
            start, stop = run[0], run[-1] + 1
            if not _SLOT_COMMAND.fullmatch(letters(page.glyphs[start:stop])):
                kind = Kind.FOREIGN_LINE if is_whole else Kind.LEFT_OVER
                near = min(numbers, key=lambda at: abs(at - start), default=-1)
                piece = difference_at(page, kind, fields.get(near, ""), "", page.span(start, stop))
                words = re.split(r"[^A-Za-z]+", piece.read) if is_whole else ()
                label_words = {
                    word.upper() if len(word) > 2 else word for word in words
                } & _LABEL_WORDS
                is_word = not (is_whole or stars) and re.search("[A-Za-z]{2}", piece.read)
                is_named = is_whole and _NAMED_NUMBER.search(piece.read)
                is_beside = bool(numbers or label_words or is_word or is_named)
                is_within = any(first <= piece.line <= last for first, last in spans)
                is_within = is_within or piece.line in apart
                owner = next(printout for printout in found if start in printout.own)
                owner.left_over.append(piece._replace(bears=is_beside or is_within))


def _character_notes(printout: Printout) -> list[str]:
    """Return a note on characters that were read as plain ones, with their number by kind."""
    page = printout.page
    places = [at for at in sorted(page.converted) if printout.start <= at < printout.stop]
    count = Counter(_name_of(page.converted[at]) for at in places)
    kinds = ", ".join(f"{number} {name}" for name, number in sorted(count.items()))
    return [
        f"characters read as plain ones or passed over: {kinds}; the first at line "
        f"{line}, column {column}"
        for line, column in map(page.place, places[:1])
    ]


def _name_of(character: str) -> str:
    """Return what a character is called."""
    code = f"U+{ord(character):04X}"
    return {"\0": "NUL", "\b": "backspace"}.get(character) or unicodedata.name(
        character, code
    ).lower()


_MAX_MARKUP = 6
"""Number of kinds of markup that are named."""


def _markup_note(text: str, stripped: str) -> list[str]:
    """Return a note on the markup that was passed over in lines that were read."""
    runs: Counter[str] = Counter()
    for line, stripped_line in zip(text.split("\n"), stripped.split("\n"), strict=False):
        if not stripped_line.strip() and any(map(str.isalpha, line)):
            continue  # told whole
        markup = "".join(
            char if after.isspace() else " "
            for char, after in zip(line, stripped_line, strict=False)
        )
        runs.update(markup.split())
    kinds = [f"{count} {printable(run)}" for run, count in runs.most_common(_MAX_MARKUP)]
    and_more = f" and {len(runs) - len(kinds)} more kinds" if len(runs) > len(kinds) else ""
    return [f"markup passed over: {', '.join(kinds)}{and_more}"] if runs else []


def _left_out_note(text: str, stripped: str) -> list[str]:
    """Return a note on lines that were left out as markup or as lines of a program."""
    lines = text.split("\n")
    pairs = zip(lines, stripped.split("\n"), strict=False)
    is_left_out = [
        any(map(str.isalpha, line)) and not stripped_line.strip() for line, stripped_line in pairs
    ]
    if not any(is_left_out):
        return []
    count = "1 line is" if sum(is_left_out) == 1 else f"{sum(is_left_out)} lines are"
    first = printable(lines[is_left_out.index(True)].strip())
    return [
        f"{count} markup or lines of a BASIC program, and not read: the first is line "
        f"{is_left_out.index(True) + 1}: {first}"
    ]
