"""Labels: whether each number is named on the paper as the program names it.

A number stands where it stands by its place on the page; its label says so a second time, and the
two must agree. A label that reads as another of the program's, or as a word that is not this one,
contradicts. One that is damaged within the reach of the glyph table, or missing, leaves a doubt.
"""

from collections.abc import Iterator, Mapping, Sequence
from enum import StrEnum
from functools import lru_cache
from typing import Any, NamedTuple

from ..fields import ANGLES
from .alignment import LETTER_LOST, REPLY_A, REPLY_B, as_letter, template
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
    checks = list(_checks(page, start, states, slots))
    marks += sum(one.state is LabelState.DAMAGED for one in checks)
    pairs = {(one.printed, one.read) for one in checks}
    return [
        one._replace(state=LabelState.DAMAGED)
        if marks >= READERS
        and one.state is LabelState.CONTRADICTORY
        and (one.read, one.printed) not in pairs
        else one
        for one in checks
    ]


def _check(page: Page, name: str, printed: str, read: str, start: int, stop: int) -> LabelCheck:
    """A label by itself, whoever read it; what was read stands between two offsets."""
    state = _state(name, printed, read)
    doubt = state is not LabelState.EXACT and _doubtful(name, printed, read)
    return LabelCheck(name, printed, read, state, doubt, *page.place(start), start, stop)


def _checks(
    page: Page, start: int, states: Sequence[int], slots: Mapping[str, tuple[int, int]]
) -> Iterator[LabelCheck]:
    """What stands in the place of each label whose number was read, or of which letters were."""
    words = words_before(page, slots)
    places: dict[int, list[int]] = {}
    for index, state in enumerate(states, start):
        places.setdefault(state, []).append(index)
    found = {
        one: sorted(index for state in one.states for index in places.get(state, ()))
        for one in template().labels
    }
    of_angles = [one for one in found if one.name in ANGLES]
    heading, row = of_angles[: len(ANGLES)], of_angles[len(ANGLES) :]
    angled = any(places.get(one.states[0]) for one in row)
    headed = [index for one in heading for index in found[one]]
    if headed:
        yield from _heading(page, min(headed), max(headed))
    for one, at in found.items():
        if one in heading and (headed or angled or one.name not in slots):
            continue
        if one in row and (not angled or not at):
            continue
        word = words.get(one.name) if one.name not in PROMPTS else None
        if word and _letters(page, at)[word[0] - word[1] :] != _letters(page, range(*word)):
            at = [*range(*word)]
        if at:
            span = page.span(at[0], at[-1] + 1)
            yield _check(page, one.name, one.text, _letters(page, at), *span)
        elif one.name in slots and one.name not in PROMPTS:
            begin = page.span(*slots[one.name])[0]
            yield _check(page, one.name, one.text, "", begin, begin)


def _letters(page: Page, run: Sequence[int]) -> str:
    return "".join(page.glyphs[index].char for index in run)


def _heading(page: Page, first: int, last: int) -> Iterator[LabelCheck]:
    """The five of the heading: the words around what was taken for it, or its letters in pairs."""
    glyphs = page.glyphs
    while first and glyphs[first].gap is not Gap.LINE and glyphs[first - 1].char.isalpha():
        first -= 1
    end = last + 1
    while end < len(glyphs) and glyphs[end].gap is not Gap.LINE and glyphs[end].char.isalpha():
        end += 1
    starts = [at for at in range(first, end) if at == first or glyphs[at].gap]
    if len(starts) != len(ANGLES):
        starts = [*range(first, end, 2)]
    whole = len(starts) != len(ANGLES)
    exact = "".join(ANGLES) in _letters(page, range(first, end))
    parts = [(first, end)] * len(ANGLES) if whole else zip(starts, [*starts[1:], end], strict=True)
    for name, part in zip(ANGLES, parts, strict=True):
        read = (name if exact else "") if whole else _letters(page, range(*part))
        yield _check(page, name, name, read, *page.span(*part))


def _state(name: str, printed: str, read: str) -> LabelState:
    """How a label stands by itself, whoever read it."""
    if read == printed:
        return LabelState.EXACT
    if not any(map(str.isalnum, read)):
        return LabelState.MISSING
    own = _distance(printed, read)
    others = _others(name)
    other = min(_distance(text, read) for text in others if text != printed)
    if name in PROMPTS:
        return LabelState.CONTRADICTORY if other < own - UNSEEN else LabelState.DAMAGED
    if len(read + printed) <= _LETTERS or (_only_lost(printed, read) and read not in others):
        return LabelState.DAMAGED
    word = read.isascii() and read.isalpha()
    if other < own - _CLEARER or (word and own >= _REACH * len(printed) / 2):
        return LabelState.CONTRADICTORY
    return LabelState.DAMAGED


def _doubtful(name: str, printed: str, read: str) -> bool:
    """Whether the letters that were read as they are printed are those of another label, too."""
    if name in PROMPTS:
        return False
    kept = [own if own == char else None for own, char in zip(printed, read, strict=False)]
    if len(read) != len(printed) or not any(kept):
        return True
    return any(
        len(text) == len(kept)
        and all(letter in (None, own) for letter, own in zip(kept, text, strict=True))
        for text in _others(name) - {printed}
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
