"""Labels: whether each number is named on the paper as the program names it.

A number stands where it stands by its place on the page; its label says so a second time, and the
two must agree. A label that reads as another of the program's, or as a word that is not this one,
contradicts. One that is damaged within the reach of the glyph table, or missing, leaves a doubt.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from enum import StrEnum
from functools import lru_cache
from typing import Any, NamedTuple

from ..fields import ANGLES
from .alignment import LETTER_LOST, REPLY_A, REPLY_B, Label, as_letter, template
from .glyphs import UNSEEN, Gap, Page

PROMPTS = (REPLY_A, REPLY_B)
_LETTERS = 2
"""One letter for one (E) is no word: on clean scans E is read L."""
_REACH = 0.7
"""From this cost on, for two letters, a label is none that a reader made of its own: one letter
read so less than once in 600."""
_CLEARER = 0.25
"""How much less another label costs that is read there; U for V, the likeliest, costs 0.29."""
_EXTRA = 0.68
"""What a letter too many costs."""
READERS = 3
"""So many other marks of an optical reader, and a label that contradicts is the reader's doing: of
15,300 labels of given scans 373 read as other words, 7 of them on pages of fewer marks. No two of
one page read as each other: those are exchanged, whoever read the page."""


class LabelState(StrEnum):
    """How a label stands on the paper."""

    EXACT = "exact"
    DAMAGED = "damaged"
    CONTRADICTORY = "contradictory"
    MISSING = "missing"


class LabelCheck(NamedTuple):
    """One label: the field it names, what the program prints there (letters), the letters read,
    its state, whether it leaves a doubt about which number it names, and where it stands (line and
    column from 1, offsets; of a missing one its number's)."""

    name: str
    printed: str
    read: str
    state: LabelState
    doubt: bool
    line: int
    column: int
    start: int
    stop: int

    def as_json(self) -> dict[str, Any]:
        """The object `impact88 verify --json` prints for a label."""
        return {**self._asdict(), "state": str(self.state)}


class _Read(NamedTuple):
    """What was read in a label's place; as `LabelCheck` without its state and line."""

    name: str
    printed: str
    read: str
    start: int
    stop: int


def words_before(page: Page, slots: Mapping[str, tuple[int, int]]) -> dict[str, tuple[int, int]]:
    """The word that an equals sign joins to each number: where its letters stand, as glyphs; for
    numbers that have such a sign before them."""
    glyphs = page.glyphs
    words = {}
    for name, (start, stop) in slots.items():
        signs = [place for place in range(max(start, 1), stop) if glyphs[place].char == "="]
        sign = signs[-1] if signs else start - 1
        first = sign
        while first > 0 and not glyphs[first].gap and _in_word(glyphs[first - 1].char):
            first -= 1
        if sign > 0 and glyphs[sign].char == "=" and first < sign:
            words[name] = (first, sign)
    return words


def _in_word(char: str) -> bool:
    return not char.isdigit() and char not in "=.(),:"


def label_checks(
    page: Page, start: int, states: Sequence[int], slots: Mapping[str, tuple[int, int]], marks: int
) -> list[LabelCheck]:
    """The labels of one printout, in the order of the page.

    ``states``: the template's state of each glyph from ``start`` on; ``slots``: the glyphs of every
    number, by field; ``marks``: how many an optical reader left in the numbers."""
    read = list(_read(page, start, states, slots))
    alone = [_state(one) for one in read]
    marks += sum(state is LabelState.DAMAGED for state in alone)
    pairs = {(one.printed, one.read) for one in read}
    checks = []
    for one, state in zip(read, alone, strict=True):
        exchanged = (one.read, one.printed) in pairs
        if state is LabelState.CONTRADICTORY and marks >= READERS and not exchanged:
            state = LabelState.DAMAGED
        doubt = state is not LabelState.EXACT and _doubtful(one)
        where = page.place(one.start)
        checks.append(LabelCheck(one.name, one.printed, one.read, state, doubt, *where, *one[3:]))
    return checks


def _read(
    page: Page, start: int, states: Sequence[int], slots: Mapping[str, tuple[int, int]]
) -> Iterator[_Read]:
    """What stands in the place of each label whose number was read, or of which letters were."""
    between = set(template().between.tolist())
    words = words_before(page, slots)
    places: dict[int, list[int]] = {}
    for index, state in enumerate(states):
        places.setdefault(state, []).append(index)
    heading, row = _of_angles()[: len(ANGLES)], _of_angles()[len(ANGLES) :]
    angled = {name for one in row for name in [one.name] if places.get(one.states[0])}
    headed = [index for one in heading for state in one.states for index in places.get(state, ())]
    if headed:
        yield from _heading(page, [start + index for index in headed])
    for one in template().labels:
        if one in heading and (headed or angled or one.name not in slots):
            continue
        at = sorted(index for state in one.states for index in places.get(state, ()))
        if one in row and (not angled or not at):
            continue
        if not at and one.name not in words:
            if one.name in slots and one.name not in PROMPTS:
                begin = page.span(*slots[one.name])[0]
                yield _Read(one.name, one.text, "", begin, begin)
            continue
        run: Sequence[int] = [start + index for index in at]
        if at and states[at[0] - 1] in between:
            first = run[0]
            while first > start and not page.glyphs[first].gap and states[first - start] in between:
                first -= 1
            run = [*range(first, run[0]), *run]
        word = words.get(one.name)
        letters = _letters(page, run)
        if (
            word
            and one.name not in PROMPTS
            and letters[-(word[1] - word[0]) :] != _letters(page, range(*word))
        ):
            run = range(*word)
            letters = _letters(page, run)
        yield _Read(one.name, one.text, letters, *page.span(run[0], run[-1] + 1))


def _letters(page: Page, run: Sequence[int]) -> str:
    return "".join(page.glyphs[index].char for index in run)


def _heading(page: Page, found: Sequence[int]) -> Iterator[_Read]:
    """The five of the heading: the words around what was taken for it, or its letters in pairs."""
    glyphs = page.glyphs
    first, last = min(found), max(found)
    while first and glyphs[first].gap is not Gap.LINE and glyphs[first - 1].char.isalpha():
        first -= 1
    while last + 1 < len(glyphs) and glyphs[last + 1].gap is not Gap.LINE:
        if not glyphs[last + 1].char.isalpha():
            break
        last += 1
    starts = [at for at in range(first, last + 1) if at == first or glyphs[at].gap]
    if len(starts) != len(ANGLES):
        starts = [*range(first, last + 1, 2)]
    if len(starts) != len(ANGLES):
        whole = "".join(ANGLES) in _letters(page, range(first, last + 1))
        for name in ANGLES:
            yield _Read(name, name, name if whole else "", *page.span(first, last + 1))
        return
    for name, begin, stop in zip(ANGLES, starts, [*starts[1:], last + 1], strict=True):
        yield _Read(name, name, _letters(page, range(begin, stop)), *page.span(begin, stop))


def _of_angles() -> list[Label]:
    """The five of the heading, and the five as some people retype them."""
    return [one for one in template().labels if one.name in ANGLES]


def _state(one: _Read) -> LabelState:
    """How a label stands by itself, whoever read it."""
    if one.read == one.printed:
        return LabelState.EXACT
    if not any(map(str.isalnum, one.read)):
        return LabelState.MISSING
    own = _distance(one.printed, one.read)
    others = _others(one.name)
    other = min(_distance(text, one.read) for text in others if text != one.printed)
    if one.name in PROMPTS:
        return LabelState.CONTRADICTORY if other < own - UNSEEN else LabelState.DAMAGED
    if len(one.read + one.printed) <= _LETTERS:
        return LabelState.DAMAGED
    if _only_lost(one.printed, one.read) and one.read not in others:
        return LabelState.DAMAGED
    word = one.read.isascii() and one.read.isalpha()
    if other < own - _CLEARER or (word and own >= _REACH * len(one.printed) / 2):
        return LabelState.CONTRADICTORY
    return LabelState.DAMAGED


def _doubtful(one: _Read) -> bool:
    """Whether the letters that were read as they are printed are those of another label, too."""
    if one.name in PROMPTS:
        return False
    kept = [
        letter if read == letter else None
        for letter, read in zip(one.printed, one.read, strict=False)
    ]
    if len(one.read) != len(one.printed) or not any(kept):
        return True
    return any(
        len(text) == len(kept)
        and all(letter in (None, own) for letter, own in zip(kept, text, strict=True))
        for text in _others(one.name) - {one.printed}
    )


@lru_cache(maxsize=64)
def _others(name: str) -> frozenset[str]:
    """The labels that one of a kind may be taken for: prompts, angles, and all others."""
    kinds = (PROMPTS, ANGLES)
    kind = next((some for some in kinds if name in some), None)
    return frozenset(
        one.text
        for one in template().labels
        if (one.name in kind if kind else not any(one.name in some for some in kinds))
    )


def _only_lost(printed: str, read: str) -> bool:
    """Whether a label was read as itself with letters lost."""
    letters = iter(printed)
    return all(letter in letters for letter in read)


@lru_cache(maxsize=4096)
def _distance(printed: str, read: str) -> float:
    """What it costs that a label was read so, letter by letter."""
    row = [_EXTRA * count for count in range(len(read) + 1)]
    for letter in printed:
        before, row = row, [row[0] + LETTER_LOST]
        for place, char in enumerate(read):
            row.append(
                min(
                    before[place] + as_letter(letter, char),
                    before[place + 1] + LETTER_LOST,
                    row[place] + _EXTRA,
                )
            )
    return row[-1]
