"""The printouts of a text: where each number is, which label owns it, and what it may be.

Labels read exactly are anchors (`labels`). Each owns the number that follows it; what lies between
two anchors is aligned with the cells between them.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain, groupby, pairwise

import numpy as np

from .align import Aligner
from .costs import ALIKE
from .glyphs import LINE_GAP, WIDE_GAP, Glyph, chars_of, glyphs_of, split_at_gaps
from .labels import LABELS, Anchor, Label, find_anchors, find_labels, is_note
from .numerals import PRINTED, as_printed, readings
from .page import (
    ANGLES,
    ASTERISKS,
    BLANKS,
    CELLS,
    HEADING,
    MANY,
    NAMES,
    PROMPTS,
    REPLIES,
    ROWS,
    SLOT_CELLS,
)

OWNED = re.compile(
    r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:E[-+]?[0-9]{1,2})?(?=$|[()%]|[A-Z]{1,4}[=:]|[A-Z]{5})"
)
"""A number in one piece after a label."""
CUT = re.compile(r"\.$")
"""The end of a number that nobody prints."""
CUT_NUMBER = re.compile(r"-?0[0-9]|.*\.$")
"""The beginning, or the end, of a number that lost digits."""
LEADING_ZERO = re.compile(r"(?<![0-9.])0(?=\.)")
"""A zero that people type before a point."""
NUMERAL = re.compile(r"[-+.,;E~]*[0-9][-+.,;E~0-9]*")
"""A number, perhaps damaged."""
PROMPT = re.compile("ENTERTHE|VELOCITY|COMPONENT|ALVELOC|VAX,VAY|VBX,VBY")
ENDING = re.compile(r"ZERODETERMINANT|\?[A-Z']{5,30}ERROR(?:IN[0-9]+)?")
_NO_NUMBER = re.compile("[^-0-9.E,+]")
MACHINE_READ = 3
"""Misread characters of labels and damaged numbers from which a machine read the page."""
MIN_NUMBERS = 3
"""Numbers after exact labels that make a text a printout."""
PAGE_STEP = 5
"""Rows up the page from which a line begins another printout."""
FIRST = Label("", "", -1, -1, 0)
LAST = Label("", "", len(ROWS), len(CELLS), len(CELLS))


@dataclass
class Slot:
    """Characters in the place of a number.

    Parameters
    ----------
    glyphs : list of Glyph
        Its characters.
    label : str
        The label that owns it: "exact", "damaged" or "" for none.
    is_torn : bool
        True if a blank, or a character of something else, is in it.
    is_bounded : bool
        True if it ends where the program ends a number: at a blank or the mark printed after it,
        before the next label of its row.
    """

    glyphs: list[Glyph]
    label: str
    is_torn: bool = False
    is_bounded: bool = True

    @property
    def text(self) -> str:
        """The characters, in capitals and without blanks."""
        return chars_of(self.glyphs)

    @property
    def is_clean(self) -> bool:
        """True for a number in one piece after an exact label."""
        is_number = PRINTED.fullmatch(as_printed(self.text)) and not CUT.search(self.text)
        return self.label == "exact" and not self.is_torn and bool(is_number)


@dataclass
class Reading:
    """Reading of one printout.

    Parameters
    ----------
    text : str
        The whole text; offsets of glyphs refer to it.
    slots : dict of str to Slot
        The text in the place of each number, and of the two replies.
    chars : dict of int to Glyph
        The glyph of each cell of a word.
    foreign : list of lists of Glyph
        What belongs to no cell.
    replies : dict of str to str
        The numbers typed at the prompts, by name.
    repeated : list of (name, Slot)
        Numbers that were read once more.
    disorder : list of (row, Glyph)
        Rows out of order or read once more, and where.
    ending : str
        The message that ended the program, without blanks.
    """

    text: str
    slots: dict[str, Slot] = field(default_factory=dict)
    chars: dict[int, Glyph] = field(default_factory=dict)
    foreign: list[list[Glyph]] = field(default_factory=list)
    replies: dict[str, str] = field(default_factory=dict)
    repeated: list[tuple[str, Slot]] = field(default_factory=list)
    disorder: list[tuple[int, Glyph]] = field(default_factory=list)
    ending: str = ""

    @property
    def is_printout(self) -> bool:
        """True if most texts in the places of numbers are numbers, some after exact labels."""
        if self.ending and "REPLY_A" in self.slots:
            return True
        numbers = [name for name, slot in self.slots.items() if NUMERAL.fullmatch(slot.text)]
        exact = sum(name in NAMES and self.slots[name].label == "exact" for name in numbers)
        return exact >= MIN_NUMBERS and 2 * len(numbers) >= len(self.slots)

    @cached_property
    def is_machine_read(self) -> bool:
        """True if labels and numbers were misread as a machine misreads them."""
        misread = [
            glyph
            for j, glyph in self.chars.items()
            if glyph.char != CELLS[j].char and glyph.char.isalnum()
        ]
        numbers = [slot.text for name, slot in self.slots.items() if name in NAMES]
        damaged = [*filter(_NO_NUMBER.search, numbers)]
        return len(damaged) + len(misread) >= MACHINE_READ

    def readings(self, name: str) -> dict[str, float]:
        """Return the printed texts that a number may be, with their costs."""
        if name not in self.slots:
            return {}
        slot = self.slots[name]
        return {text: cost + ALIKE * slot.is_torn for text, cost in readings(slot.text).items()}

    def places(self) -> dict[int, tuple[int, int]]:
        """Return the place of each cell of which something was read."""
        places = {j: (glyph.offset, glyph.offset + 1) for j, glyph in self.chars.items()}
        for name, slot in self.slots.items():
            start, stop = slot.glyphs[0].offset, slot.glyphs[-1].offset + 1
            first, last = places.get(SLOT_CELLS[name], (start, stop))
            places[SLOT_CELLS[name]] = min(start, first), max(stop, last)
        return places

    @cached_property
    def extra_blanks(self) -> dict[str, tuple[float, float]]:
        """Surplus of blanks before and after each number, for each blank that the program prints,
        over that of most numbers of the page; infinite at the edges of a line.

        Where there are more, the number may have lost its beginning, or its end."""
        chars = [*self.text, "\n"]
        for glyph in chain.from_iterable(self.foreign):  # beside a note is an edge
            chars[glyph.offset] = "\n"
        text = "".join(chars)
        extra = {}
        for name, slot in self.slots.items():
            before, after = text[: slot.glyphs[0].offset], text[slot.glyphs[-1].offset + 1 :]
            gaps = before[len(before.rstrip()) :], after[: len(after) - len(after.lstrip())]
            extra[name] = [
                math.inf if gap.strip(" \t") else (len(gap) - due) / max(1, due)
                for gap, due in zip(gaps, BLANKS[name], strict=True)
            ]
            if slot.glyphs[0].gap == LINE_GAP:  # also behind what precedes every line
                extra[name][0] = math.inf
        usual = np.maximum(0, np.median([*extra.values()], axis=0)).tolist()
        return {name: (front - usual[0], end - usual[1]) for name, (front, end) in extra.items()}

    def is_apart(self, name: str) -> bool:
        """Return True for a number with more blanks beside it, within its line."""
        return any(0 < extra < math.inf for extra in self.extra_blanks.get(name, ()))

    def is_cut(self, name: str, printed: str) -> bool:
        """Return True for a part of a printed number where the rest of it may have been lost."""
        read = LEADING_ZERO.sub("", self.slots[name].text)
        front, end = self.extra_blanks[name]
        is_part = bool(CUT_NUMBER.match(read))
        before, after = ".*" * (front > 0 or is_part), ".*" * (end > 0)
        part = re.escape(read.lstrip("-") if is_part else read)
        return bool(re.fullmatch(before + part + after, printed))

    def span(self) -> tuple[int, int]:
        """Return the offsets of the first and after the last character of the page's own."""
        places = self.places().values()
        return min(start for start, _ in places), max(stop for _, stop in places)


def read_printouts(text: str) -> list[Reading]:
    """Return the printouts in a text.

    A printout ends where a line has a label of a row much further up the page.

    Parameters
    ----------
    text : str
        Any text.

    Returns
    -------
    list of Reading
        What was read of each.
    """
    glyphs = glyphs_of(text)
    cuts = [*(k for k, glyph in enumerate(glyphs) if glyph.gap == LINE_GAP or not k), len(glyphs)]
    pages: list[list[int]] = []  # first line, last line, first row, furthest row
    for n, (a, b) in enumerate(pairwise(cuts)):
        if not (rows := _rows_of(glyphs[a:b])):
            continue
        if not pages or pages[-1][3] - max(rows) >= PAGE_STEP:
            pages.append([n, n, min(rows), min(rows)])
        pages[-1][1], pages[-1][3] = n, max(pages[-1][3], min(rows))
    printouts = []
    for k, page in enumerate(pages):
        above = pages[k - 1][1] + 1 if k else 0
        below = pages[k + 1][0] if k + 1 < len(pages) else len(cuts) - 1
        first = max(page[0] - 2 * page[2], above)
        last = min(page[1] + 2 * (len(ROWS) - page[3]), below - 1)
        printouts.append(_Reader(text, glyphs[cuts[first] : cuts[last + 1]]).read())
    return [reading for reading in printouts if reading.is_printout]


def _rows_of(line: Sequence[Glyph]) -> list[int]:
    """Return the rows that share most labels with a line; none for a note."""
    text = chars_of(line)
    if PROMPT.search(text):
        return [*PROMPTS]
    if ENDING.match(text):
        return [ASTERISKS[0]]
    if is_note(line):
        return []
    texts = {text for text, *_ in find_labels(line)}
    counts = Counter(label.row for label in LABELS if label.text in texts)
    return [row for row, count in counts.items() if count == max(counts.values())]


class _Reader:
    """Reading of one printout's glyphs."""

    def __init__(self, text: str, glyphs: Sequence[Glyph]) -> None:
        self.reading = Reading(text)
        self.glyphs = glyphs
        self.own: set[Glyph] = set()

    def read(self) -> Reading:
        """Return what was read."""
        reading = self.reading
        anchors = find_anchors(self.glyphs)
        if ending := ENDING.search(chars_of(self.glyphs)):
            reading.ending = ending[0]
            self.glyphs = self.glyphs[: ending.start()]
        absent = () if PROMPT.search(chars_of(self.glyphs)) else PROMPTS
        read = {j for anchor in anchors for j in range(anchor.label.start, anchor.label.stop)}
        read |= {SLOT_CELLS[anchor.label.name] for anchor in anchors if anchor.label.name}
        free = [j for j, cell in enumerate(CELLS) if j not in read and cell.row not in absent]
        before = Anchor(FIRST, "", 0, 0)
        for anchor in [*anchors, Anchor(LAST, "", len(self.glyphs), len(self.glyphs))]:
            cells = [j for j in free if before.label.stop <= j < anchor.label.start]
            if anchor.label.start <= before.label.start:
                row = before.label.row
                cells = [j for j in free if j >= before.label.stop and CELLS[j].row == row]
                reading.disorder.append((anchor.label.row, self.glyphs[anchor.start]))
            self._read_between(before, anchor.start, cells)
            places = range(anchor.label.start, anchor.label.stop)
            self._add_chars(places[::-1], self.glyphs[anchor.start : anchor.stop][::-1])
            before = anchor
        self._split_replies()
        reading.foreign = [*self._foreign()]
        return reading

    def _foreign(self) -> Iterator[list[Glyph]]:
        """Yield what belongs to no cell, from the page's first line to its last."""
        lines = [*split_at_gaps(self.glyphs, LINE_GAP)]
        own = [k for k, line in enumerate(lines) if not self.own.isdisjoint(line)]
        page = chain.from_iterable(lines[min(own, default=0) : max(own, default=-1) + 1])
        for is_own, run in groupby(page, self.own.__contains__):
            if not is_own:
                yield [*run]

    def _add_chars(self, cells: Sequence[int], glyphs: Sequence[Glyph]) -> None:
        """Add the characters of words."""
        self.reading.chars |= dict(zip(cells, glyphs, strict=False))
        self.own.update(glyphs[: len(cells)])

    def _read_between(self, before: Anchor, stop: int, cells: list[int]) -> None:
        """Read the text between two anchors: the number that the first owns, and the rest.

        A number without a label counts only if its line has as many numbers as places.
        """
        label, glyphs = before.label, [*self.glyphs[before.stop : stop]]
        owner = [SLOT_CELLS[label.name]] if label.name else []
        count = _count_owned(glyphs, label)
        cells = cells if count else owner + cells
        rows = [CELLS[j].row for j in cells if CELLS[j].kind == "slot"]
        is_last = label.row not in rows
        if count and is_last and label.name not in MANY:  # nothing else belongs there
            count += _count_torn(glyphs[count:])
        places = owner * count + Aligner((*cells,)).align(glyphs[count:])
        labels = {
            CELLS[j].name: "damaged"
            for j, glyph in zip(places, glyphs, strict=True)
            if CELLS[j].name in MANY or CELLS[j].char == glyph.char != "="
        }
        labels[label.name] = "exact" if before.read == label.text else "damaged"
        end = 0
        for j, group in groupby(places):
            start, end = end, end + len([*group])
            run, cell = glyphs[start:end], CELLS[j]
            if cell.kind == "word":
                self._add_chars([j], run)
            if cell.kind != "slot":
                continue
            is_whole = _is_whole(glyphs, start, start + len(run))
            places_left = rows.count(cell.row)
            if cell.name not in labels and (
                not is_whole or places_left != _count_numbers(glyphs[count:], run[0])
            ):
                continue
            slot = Slot(run, labels.get(cell.name, ""), not is_whole)
            slot.is_torn |= any(b.gap > 0 and a.char not in ",;" for a, b in pairwise(run))
            slot.is_torn |= chars_of(glyphs[:start]).endswith((".", "-"))
            if end == count:
                slot.is_torn |= is_last and _is_further(glyphs[end:])
                is_before_label = is_last or chars_of(glyphs[end:])[:1].isalpha()
                slot.is_bounded = is_before_label and self._is_end(
                    before.stop + end, CELLS[j + 1].char
                )
            self._add_slot(cell.name, slot)

    def _is_end(self, at: int, mark: str) -> bool:
        """Return True where a blank, or the mark printed there, follows a number."""
        return all(glyph.gap or glyph.char == mark != "(" for glyph in self.glyphs[at : at + 1])

    def _add_slot(self, name: str, slot: Slot) -> None:
        """Add the text in the place of a number, or a second one.

        The five angles are read only if there are five.
        """
        if name == "ANGLES":
            words = _angle_words(slot.glyphs)
            with_digits = [word for word in words if re.search("[0-9]", chars_of(word))]
            numbers = [word for word in words if readings(chars_of(word))]
            five = with_digits if len(with_digits) == len(ANGLES) else numbers
            if len(five) != len(ANGLES):
                self.own.update(slot.glyphs)
                return
            for angle, word in zip(ANGLES, five, strict=True):
                is_torn = any(glyph.gap for glyph in word[1:])
                self._add_slot(angle, Slot(word, slot.label, is_torn))
            return
        self.own.update(slot.glyphs)
        if name in self.reading.slots:
            self.reading.repeated.append((name, slot))
        else:
            self.reading.slots[name] = slot

    def _split_replies(self) -> None:
        """Split the replies into their numbers."""
        for reply, names in REPLIES.items():
            if slot := self.reading.slots.get(reply):
                texts = re.split("[,;]", slot.text)
                if len(texts) == len(names) and all(texts):
                    self.reading.replies |= dict(zip(names, texts, strict=True))


def _angle_words(row: list[Glyph]) -> list[list[Glyph]]:
    """Return the words of the row of angles: a sign before a blank is the next word's."""
    cuts = [
        k
        for k, glyph in enumerate(row)
        if glyph.gap == LINE_GAP or not k or (glyph.gap and row[k - 1].char not in "-~")
    ]
    return [row[a:b] for a, b in pairwise([*cuts, len(row)])]


def _count_owned(glyphs: Sequence[Glyph], label: Label) -> int:
    """Return how many glyphs are the number, or the numbers, of the label before them."""
    if label.row == HEADING:
        return _end_of_line(glyphs, len(ANGLES))
    if label.row in PROMPTS:
        return _end_of_line(glyphs, 1)
    return _count_number(glyphs) if label.text.endswith("=") else 0


def _end_of_line(glyphs: Sequence[Glyph], words: int) -> int:
    """Return the end of the line that has the last of a number of words."""
    count = 0
    for at, glyph in enumerate(glyphs):
        if at and glyph.gap == LINE_GAP and count >= words:
            return at
        count += glyph.gap > 0 or not at
    return len(glyphs)


def _count_number(glyphs: Sequence[Glyph]) -> int:
    """Return how many glyphs are the number after a label: a clean one, or a damaged word."""
    word = next(split_at_gaps(glyphs), [])
    text = chars_of(word)
    if number := OWNED.match(text):
        return number.end()
    text = text.rstrip("()%")
    if word and word[0].gap == LINE_GAP:
        return 0
    return len(text) if re.search("[0-9]", text) and readings(text) else 0


def _count_torn(rest: Sequence[Glyph]) -> int:
    """Return how many glyphs of words with digits follow a number."""
    count = 0
    for word in split_at_gaps(rest):
        digits = len(chars_of(word).rstrip(")%"))
        if word[0].gap >= WIDE_GAP or not re.search("[0-9]", chars_of(word)):
            break
        count += digits
        if digits < len(word):
            break
    return count


def _is_further(rest: Sequence[Glyph]) -> bool:
    """Return True if another number follows on the line."""
    return bool(NUMERAL.match(chars_of(rest))) and rest[0].gap < LINE_GAP


def _count_numbers(glyphs: Sequence[Glyph], glyph: Glyph) -> int:
    """Return how many words with digits are on the line of a glyph."""
    line = next(line for line in split_at_gaps(glyphs, LINE_GAP) if glyph in line)
    return sum(bool(re.search("[0-9]", chars_of(word))) for word in split_at_gaps(line))


def _is_whole(glyphs: Sequence[Glyph], start: int, stop: int) -> bool:
    """Return True for glyphs that no other digit or point touches."""
    before, after = chars_of(glyphs[:start])[-1:], chars_of(glyphs[stop : stop + 1])
    is_start = not before or glyphs[start].gap > 0 or before not in "0123456789."
    return is_start and (not after.isdigit() or glyphs[stop].gap > 0)
