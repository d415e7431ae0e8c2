"""Labels: whether each number is named on the paper as the program names it.

A number stands where it stands by its place on the page; its label says so a second time, and the
two must agree. A label that reads as another of the program's, or as a word that is not this one,
contradicts. One that is damaged within the reach of the glyph table, or missing, leaves a doubt.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import StrEnum
from functools import lru_cache
from typing import NamedTuple

from ...collision.fields import ANGLES, FIELDS
from .glyphs import COSTS, Gap, Page, label_cost, letters

_REACH = 35
"""From this cost a letter on, a label is none that a reader made of its own: one letter of two read
so less than once in 600."""
_CLEARER = 25
"""How much less another label costs that is read there; U for V, the likeliest, costs 29."""
READERS = 3
"""So many other marks of an optical reader, and a label that contradicts is the reader's doing: of
15,300 labels of given scans 373 read as other words, 7 of them on pages of fewer marks. No two of
one page read as each other: those are exchanged, whoever read the page."""


_NO_WORD = frozenset("0123456789=.(),:")


class LabelState(StrEnum):
    """How a label stands on the paper."""

    EXACT = "exact"
    DAMAGED = "damaged"
    CONTRADICTORY = "contradictory"
    MISSING = "missing"


class LabelCheck(NamedTuple):
    """One label compared with the program's.

    Parameters
    ----------
    name : str
        The field that the label names.
    printed, read : str
        The letters that the program prints, and those read.
    state : LabelState
        EXACT, DAMAGED, CONTRADICTORY or MISSING.
    doubt : bool
        True if the letters leave open which number is meant.
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


Found = Sequence[tuple[str, str, Sequence[int]]]
"""Of each label the field it names (of a prompt, its reply), its letters, the glyphs taken for
them."""


def words_before(page: Page, slots: Mapping[str, tuple[int, int]]) -> dict[str, tuple[int, int]]:
    """The word that an equals sign joins to each number: where its letters stand, as glyphs; for
    numbers that have such a sign before them."""
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
    """The labels of one printout, in the order of the page.

    ``slots``: the glyphs of every number, by field; ``marks``: how many an optical reader left in
    the numbers."""
    checks = []
    for name, printed, start, stop, read in _seen(page, found, slots):
        others = {text for label, text, _ in found if _kind(label) == _kind(name)} - {printed}
        state, doubt = _state(_kind(name), printed, read, others)
        checks.append(
            LabelCheck(name, printed, read, state, doubt, *page.place(start), start, stop)
        )
    marks += sum(check.state is LabelState.DAMAGED for check in checks)
    pairs = {(check.printed, check.read) for check in checks}
    for at, check in enumerate(checks if marks >= READERS else ()):
        if check.state is LabelState.CONTRADICTORY and (check.read, check.printed) not in pairs:
            checks[at] = check._replace(state=LabelState.DAMAGED)
    return checks


def _kind(name: str) -> str:
    """What a label may be taken for: prompts, angles, and all others."""
    return "prompt" if name not in FIELDS else "angle" if name in ANGLES else "number"


def _seen(
    page: Page, found: Found, slots: Mapping[str, tuple[int, int]]
) -> Iterator[tuple[str, str, int, int, str]]:
    """What stands in the place of each label whose number was read, or of which letters were: the
    field, what is printed, the offsets, what is read."""

    def read(at: Iterable[int]) -> str:
        return letters(page.glyphs[index] for index in at)

    words = words_before(page, slots)
    of_angles = [label for label in found if label[0] in ANGLES]
    heading, row = of_angles[: len(ANGLES)], of_angles[len(ANGLES) :]
    headed = [index for _, _, at in heading for index in at]
    if headed:
        yield from _heading(page, min(headed), max(headed))
    for label in found:
        name, printed, at = label
        retyped = bool(headed) or any(at for _, _, at in row)
        if (label in heading and (retyped or name not in slots)) or (label in row and not at):
            continue
        word = range(*words.get(name, (0, 0)))
        if word and read(at[-len(word) :]) != read(word):
            at = word
        if at:
            yield name, printed, *page.span(at[0], at[-1] + 1), read(at)
        elif name in slots:
            begin = page.span(*slots[name])[0]
            yield name, printed, begin, begin, ""


def _heading(page: Page, first: int, last: int) -> Iterator[tuple[str, str, int, int, str]]:
    """The five of the heading: the words around what was taken for it, or its letters in pairs."""
    glyphs, end = page.glyphs, last + 1
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


def _state(kind: str, printed: str, read: str, others: set[str]) -> tuple[LabelState, bool]:
    """How a label stands by itself, whoever read it, and whether it leaves a doubt: that is where
    the letters which were read as they are printed are those of another, too."""
    if read == printed:
        return LabelState.EXACT, False
    own = _distance(printed, read)
    other = min(_distance(text, read) for text in others)
    kept = {(at, char) for at, char in enumerate(read) if printed[at : at + 1] == char}
    alike = (kept.issubset(enumerate(text)) for text in others if len(text) == len(printed))
    doubt = len(read) != len(printed) or not kept or any(alike)
    if not any(map(str.isalnum, read)):
        return LabelState.MISSING, doubt
    if kind == "prompt":
        contradicts = other < own - COSTS["unseen"]
        return LabelState.CONTRADICTORY if contradicts else LabelState.DAMAGED, False
    left = iter(printed)
    lost = read not in others and all(letter in left for letter in read)  # itself, with gaps
    if len(read + printed) > len("EL") and not lost:
        word = read.isascii() and read.isalpha()
        strange = word and (own >= _REACH * len(printed) or _names_otherwise(printed, read))
        if other < own - _CLEARER or strange:
            return LabelState.CONTRADICTORY, doubt
    return LabelState.DAMAGED, doubt


_WORDS = {"INITIALKE": 7, "KELOSS": 2}
"""Labels of two words: the letters of the first."""


def _names_otherwise(printed: str, read: str) -> bool:
    """Whether one word of a label of two is read as a word that is not this one."""
    if printed not in _WORDS:
        return False
    words = printed[: _WORDS[printed]], printed[_WORDS[printed] :]
    splits = ((read[:at], read[at:]) for at in range(len(read) + 1))
    parts = min(splits, key=lambda parts: sum(map(_distance, words, parts)))
    for word, part in zip(words, parts, strict=True):
        left = iter(word)
        lost = all(letter in left for letter in part)
        kept = sum(letter == char for letter, char in zip(word, part, strict=False))
        if not lost and 2 * kept < len(word) and _distance(word, part) >= _REACH * len(word):
            return True
    return False


@lru_cache(maxsize=4096)
def _distance(printed: str, read: str) -> int:
    """What it costs that a label was read so, letter by letter."""
    lost = COSTS["letter lost"]
    row = [lost * count for count in range(len(read) + 1)]
    for letter in printed:
        before, row = row, [row[0] + lost]
        for place, char in enumerate(read):
            read_so = before[place] + label_cost(letter, char)
            row.append(min(read_so, before[place + 1] + lost, row[place] + lost))
    return row[-1]
