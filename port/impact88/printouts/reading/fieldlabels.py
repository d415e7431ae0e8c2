"""Checks that each number is named on the paper as the program names it.

A number stands where it stands by its place on the page; its label says so a second time, and the
two must agree. A label that reads as another of the program's, or as a word that is not this one,
contradicts. One that is damaged within the reach of the glyph table, or missing, leaves a doubt.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import StrEnum
from functools import lru_cache
from typing import NamedTuple

from ...collision.fields import ANGLES, FIELDS
from .editpath import cheapest_path
from .glyphs import COSTS, Gap, Page, label_cost, letters

_DIFFERENT = 35
"""Cost per letter from which a word is another label, not this one misread: that of two letters of
which one is read so less than once in 600."""
_MIN_ADVANTAGE = 25
"""Cost by which another label must be cheaper to be the one read; U for V, the likeliest, costs
29."""
MACHINE_READ = 3
"""Misread letters of labels and damaged numbers from which a machine read the page: people do not
type PE for PB. From as many other signs a contradictory label is attributed to the machine: of
15,300 labels of given scans 373 read as other words, 7 of them on pages with fewer signs. No two
labels of a page read as each other: such labels were exchanged, whoever read the page."""


_NO_WORD = frozenset("0123456789=.(),:")


class LabelState(StrEnum):
    """States of a label on the paper."""

    EXACT = "exact"
    DAMAGED = "damaged"
    CONTRADICTORY = "contradictory"
    MISSING = "missing"
    MOVED = "moved"


class LabelCheck(NamedTuple):
    """One label, or a mark beside it, compared with the program's.

    Parameters
    ----------
    name : str
        The field that the label names, or that the mark belongs to.
    printed, read : str
        The letters or the mark that the program prints, and what was read.
    state : LabelState
        EXACT, DAMAGED, CONTRADICTORY, MISSING or MOVED (a mark, to another line).
    doubt : bool
        True if the letters leave open which number is meant, or if they are not the program's on a
        page that no machine read.
    line, column, start, stop : int
        Its place in the text: line and column from 1, and offsets; for a missing label, its
        number's.
    """

    name: str
    printed: str
    read: str
    state: LabelState
    doubt: bool
    line: int
    column: int
    start: int
    stop: int

    @property
    def is_mark(self) -> bool:
        """True for a mark beside a label, and for a word of a prompt (`labelmarks`)."""
        return not self.printed.isalpha() or self.name not in FIELDS


Found = Sequence[tuple[str, str, Sequence[int]]]
"""For each label the field that it names (a prompt: its reply), its letters, and the glyphs aligned
with them."""


def words_before(page: Page, slots: Mapping[str, tuple[int, int]]) -> dict[str, tuple[int, int]]:
    """Return the range of glyphs of the word that an equals sign joins to each number.

    Numbers without such a sign before them are left out.
    """
    glyphs = page.glyphs
    words = {}
    for name, (start, stop) in slots.items():
        signs = (place for place in range(max(start, 1), stop) if glyphs[place].char == "=")
        first = sign = max(signs, default=start - 1)
        while first > 0 and not glyphs[first].gap and glyphs[first - 1].char not in _NO_WORD:
            first -= 1
        if glyphs[sign].char == "=" and first < sign:
            words[name] = (first, sign)
    return words


def label_checks(
    page: Page, found: Found, slots: Mapping[str, tuple[int, int]], marks: int
) -> list[LabelCheck]:
    """Return the labels of one printout, in the order of the page.

    Parameters
    ----------
    page : Page
    found : sequence of (str, str, list of int)
        For each label its field, its letters, and the glyphs that were aligned with them.
    slots : mapping of str to (int, int)
        Range of glyphs of every number, by field.
    marks : int
        Number of signs of an optical reader in the numbers.
    """
    checks = []
    for name, letters_printed, start, stop, read in _labels_read(page, found, slots):
        other_labels = {text for label, text, _ in found if _kind(label) == _kind(name)} - {
            letters_printed
        }
        state, doubt = _state(_kind(name), letters_printed, read, other_labels)
        checks.append(
            LabelCheck(name, letters_printed, read, state, doubt, *page.place(start), start, stop)
        )
    marks += sum(check.state is LabelState.DAMAGED for check in checks)
    pairs = {(check.printed, check.read) for check in checks}
    for at, check in enumerate(checks if marks >= MACHINE_READ else ()):
        if check.state is LabelState.CONTRADICTORY and (check.read, check.printed) not in pairs:
            checks[at] = check._replace(state=LabelState.DAMAGED)
    return checks


def _kind(name: str) -> str:
    """Return the kind of a label: it may be mistaken for others of its kind only."""
    return "prompt" if name not in FIELDS else "angle" if name in ANGLES else "number"


def _labels_read(
    page: Page, found: Found, slots: Mapping[str, tuple[int, int]]
) -> Iterator[tuple[str, str, int, int, str]]:
    """Yield the labels of numbers that were read, and those of which letters were read.

    Each is the field, the letters that the program prints, start and stop in the text, and the
    letters that were read.
    """

    def read(at: Iterable[int]) -> str:
        return letters(page.glyphs[index] for index in at)

    words = words_before(page, slots)
    of_angles = [place for place, (name, _, _) in enumerate(found) if name in ANGLES]
    heading, row = of_angles[: len(ANGLES)], of_angles[len(ANGLES) :]
    heading_at = [index for place in heading for index in found[place][2]]
    if heading_at:
        yield from _heading(page, min(heading_at), max(heading_at))
    is_named = bool(heading_at) or any(found[place][2] for place in row)
    for place, (name, letters_printed, at) in enumerate(found):
        if (place in heading and is_named) or (place in row and not at):
            continue
        word = range(*words.get(name, (0, 0)))
        if word and read(at[-len(word) :]) != read(word):
            at = word
        if at:
            yield name, letters_printed, *page.span(at[0], at[-1] + 1), read(at)
        elif name in slots:
            begin = page.span(*slots[name])[0]
            yield name, letters_printed, begin, begin, ""


def _heading(page: Page, first: int, last: int) -> Iterator[tuple[str, str, int, int, str]]:
    """Yield the five labels of the heading, by its words or, if these are not five, in pairs."""
    glyphs, end = page.glyphs, last + 1
    outside = _outside_brackets(page, last)
    starts = [at for at in outside if at == outside[0] or glyphs[at].gap or at - 1 not in outside]
    if len(starts) == len(ANGLES):
        for name, start, stop in zip(ANGLES, starts, [*starts[1:], outside[-1] + 1], strict=True):
            word = [at for at in outside if start <= at < stop]
            yield name, name, *page.span(start, word[-1] + 1), letters(glyphs[at] for at in word)
        return
    while first and glyphs[first].gap is not Gap.LINE and glyphs[first - 1].char.isalpha():
        first -= 1
    while end < len(glyphs) and glyphs[end].gap is not Gap.LINE and glyphs[end].char.isalpha():
        end += 1
    starts = [at for at in range(first, end) if at == first or glyphs[at].gap]
    if len(starts) != len(ANGLES):
        starts = [*range(first, end, 2)]
    exact = "".join(ANGLES) in letters(glyphs[first:end])
    for number, name in enumerate(ANGLES):
        if len(starts) == len(ANGLES):
            start, stop = [*starts, end][number : number + 2]
            yield name, name, *page.span(start, stop), letters(glyphs[start:stop])
        else:
            yield name, name, *page.span(first, end), name if exact else ""


def _outside_brackets(page: Page, last: int) -> list[int]:
    """Return the glyphs of a line that stand outside brackets such as ``(DEG)``; none if it has no
    brackets."""
    line = next(line for line in page.lines if last in line)
    text = letters(page.glyphs[line.start : line.stop])
    inside = {at for match in re.finditer(r"\([^()]*\)", text) for at in range(*match.span())}
    return [at for at in line if at - line.start not in inside] if inside else []


def _state(kind: str, printed: str, read: str, others: set[str]) -> tuple[LabelState, bool]:
    """Return the state of a label, and True if it leaves a doubt which number is meant.

    There is a doubt where the letters that were read as printed fit another label, too.
    """
    if read == printed:
        return LabelState.EXACT, False
    cost = _distance(printed, read)
    cost_of_other = min(_distance(text, read) for text in others)
    matches = {(at, char) for at, char in enumerate(read) if printed[at : at + 1] == char}
    alike = (matches.issubset(enumerate(text)) for text in others if len(text) == len(printed))
    doubt = len(read) != len(printed) or not matches or any(alike)
    if not any(map(str.isalnum, read)):
        return LabelState.MISSING, doubt
    if kind == "prompt":
        contradicts = cost_of_other < cost - COSTS["unseen"]
        return LabelState.CONTRADICTORY if contradicts else LabelState.DAMAGED, False
    remaining = iter(printed)
    is_gapped = read not in others and all(
        letter in remaining for letter in read
    )  # itself, with gaps
    if len(read + printed) > len("EL") and not is_gapped:
        is_word = read.isascii() and read.isalpha()
        is_strange = is_word and (
            cost >= _DIFFERENT * len(printed) or _has_other_word(printed, read)
        )
        if cost_of_other < cost - _MIN_ADVANTAGE or is_strange:
            return LabelState.CONTRADICTORY, doubt
    return LabelState.DAMAGED, doubt


_WORDS = {"INITIALKE": 7, "KELOSS": 2}
"""Labels of two words: the letters of the first."""


def _has_other_word(printed: str, read: str) -> bool:
    """Return True for a label of two words, one of which is read as a different word."""
    if printed not in _WORDS:
        return False
    words = printed[: _WORDS[printed]], printed[_WORDS[printed] :]
    splits = ((read[:at], read[at:]) for at in range(len(read) + 1))
    parts = min(splits, key=lambda parts: sum(map(_distance, words, parts)))
    for word, part in zip(words, parts, strict=True):
        remaining = iter(word)
        is_gapped = all(letter in remaining for letter in part)
        matches = sum(letter == char for letter, char in zip(word, part, strict=False))
        if (
            not is_gapped
            and 2 * matches < len(word)
            and _distance(word, part) >= _DIFFERENT * len(word)
        ):
            return True
    return False


@lru_cache(maxsize=4096)
def _distance(printed: str, read: str) -> int:
    """Return the cost of reading a label so."""
    lost = COSTS["letter lost"]
    cost, _ = cheapest_path(
        len(read),
        len(printed),
        lambda i, j: (label_cost(printed[j], read[i]), None),
        lambda i, j: (lost, None),
        lambda i, j: (lost, None),
    )
    return int(cost)
