"""Aligning a text with the program's page, by dynamic programming.

The page is a template seen through noise: every glyph of a label is a state, every number is one
state that holds any number of glyphs, and before every line stands a state for what may lie between
lines. A text is read as the cheapest way through them: a glyph opens the next state or stays in
one, states and whole lines may be missing, and text outside costs little. Costs are in units of one
wrong letter. One forward pass over the text (numpy rows over the states), one trace back; long
texts are read in windows, so time grows as the text does.
"""

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..fields import ANGLES
from .glyphs import NUMERIC, UNSEEN, Glyph, label_cost, letters, printed_for

Floats = NDArray[np.float64]

REPLY_A, REPLY_B = "REPLY_A", "REPLY_B"
"""Slots of the replies to the two prompts."""

LINES = (
    "ENTERTHEINITIALVELOCITYCOMPONENTSOFMA:VAX,VAY,WA?{REPLY_A}",
    "ENTERTHEINITIALVELOCITYCOMPONENTSOFMB:VBX,VBY,WB?{REPLY_B}",
    "MA={MA}MB={MB}IA={IA}IB={IB}",
    "DA={DA}DB={DB}",
    "PAPBTATBGA",
    "{PA}{PB}{TA}{TB}{GA}",
    "PA={PA}PB={PB}TA={TA}TB={TB}GA={GA}",
    "UX={UX}UY={UY}WA={WA}XA={XA}YA={YA}",
    "VX={VX}VY={VY}WB={WB}XB={XB}YB={YB}",
    "E={E}MU={MUP}EM={EM}",
    "INITIALKE={KI}KELOSS={LOSS}%",
    "*****",
    "VAX={VAX}VAY={VAY}(XA={XAF}YA={YAF})",
    "VBX={VBX}VBY={VBY}(XB={XBF}YB={YBF})",
    "WA={WAF}WB={WBF}",
    "*****",
)
"""What lines 200 to 770 print, fields in braces; angles also as some people retype them."""
_ABSENT = tuple(0.3 if at in (0, 1, 4, 6, 11, 14, 15) else 2.0 for at in range(len(LINES)))
"""What it costs to miss a line whole: prompts, heading, retyped angles, asterisks and spins may be
missing. Doubled, none of 60 texts is read otherwise; all alike, 1 to 3 are."""
PROMPTS, HEADING, ANGLE_ROW, LABELLED_ANGLES, SPINS = 2, 4, 5, 6, 14
"""Places in `LINES`; the prompts are those before the first."""
STARS = (11, 15)
_LOOSE_WORDS = {"INITIALKE=": 7, "KELOSS=": 2}
"""Letters of labels that retyped pages leave out, as they do prompts."""

_RETYPED = 1.5
"""What it costs to begin it: the row of angles is what the program prints. Two columns of
names and numbers are read with up to 2.0, no longer with 2.5."""

_SIGN_LOST = 0.45
"""What it costs to miss an equals sign."""
_MARK_LOST = 0.25
"""Brackets and other marks, and words that retyped pages leave out (INITIAL, KE, prompts)."""
LETTER_LOST = 0.65
"""Of letters that nobody leaves out."""
_FIGURE = 0.4
"""What a figure costs more where a letter of a label is wrong, and between lines."""
_INSERTED = 1.0
_SLOT_ALIKE, _SLOT_LETTER, _SLOT_OTHER, _SLOT_EQUALS = 0.3, 0.55, 0.9, 1.6
"""What a glyph costs in a number that is no figure: one of its shape, a letter (more than between
lines, or prose is read into replies), any other, an equals sign."""
_BETWEEN, _OUTSIDE = 0.5, 0.45
"""What a glyph costs between lines, and outside of pages: as much as half a wrong letter."""
_BIG = 1e6
_NO_NUMBER = 0.9
_LOOSE_SIGN = 0.15
"""What an equals sign costs before which no letter of its label was read."""
_TORN = 1.6
"""What it costs to take a figure right after a figure for a letter of a label."""
_UNLABELLED = (0.1, 0.1, 0.0, 0.0, 1.6)
"""What a number costs before which no equals sign was read, by the gap before it: a number is not
to be taken to pieces."""

WITHIN = 4
"""The gap before a figure that stands right after a figure; below it the gaps of `glyphs.Gap`."""
GAPS = 5
KINDS, NOTE = 128, 0
"""Glyphs are told apart by this many codes; the last is for all others, and `NOTE` for those known
to be none of the program's."""


class Label(NamedTuple):
    """What names a number on the page: the field (of a prompt, its reply's slot), the label's
    letters, and the template's states of these letters."""

    name: str
    text: str
    states: tuple[int, ...]


def code(char: str) -> int:
    """The code of a glyph."""
    number = ord(char)
    if number < KINDS - 1:
        return number
    return ord("O") if char in "©®°Ø" else ord("Y") if char == "¥" else KINDS - 1


class Template(NamedTuple):
    """The states as arrays.

    By state: ``enter`` and ``stay`` (code by state): cost of a glyph that opens it, and of one more
    glyph in it; ``gap_enter``, ``gap_stay`` (gap by state): of the gap before the glyph;
    ``unlabelled`` (gap by state): of a number without its label's last glyph; ``miss``: of passing
    without a glyph. ``between``: the states before the lines; ``closes``: whether text may end
    after a state; ``line``: where a state belongs; ``slots``: state -> field name; ``letters``:
    state -> a label's letter; ``labels``: what names each number.
    """

    enter: Floats
    stay: Floats
    gap_enter: Floats
    gap_stay: Floats
    unlabelled: Floats
    miss: Floats
    between: NDArray[np.intp]
    closes: NDArray[np.bool_]
    line: list[int]
    slots: dict[int, str]
    letters: dict[int, str]
    labels: tuple[Label, ...]


_NOT_PRINTED = ("outside", "between")


@lru_cache(maxsize=1)
def template() -> Template:
    """The template's states, the first of which is the text outside any printout."""
    kinds = [("outside", "", -1)]
    labels = []
    for number, line in enumerate(LINES):
        kinds.append(("between", "", number))
        for text, name in re.findall(r"([^{]*)(?:{(\w+)}|$)", line):
            loose = len(text) if number < PROMPTS else _LOOSE_WORDS.get(text, 0)
            parts = [(text, name)] if name else []
            if number == HEADING:
                parts = [(angle, angle) for angle in ANGLES] if text else []
            for label, named in parts:
                at = len(kinds) + "".join(ANGLES).find(label) * (number == HEADING)
                states = [at + place for place, one in enumerate(label) if one.isalpha()]
                if states:
                    labels.append(Label(named, "".join(filter(str.isalpha, label)), tuple(states)))
            for place, letter in enumerate(text):
                kinds.append(("loose" if place < loose else "letter", letter, number))
            if name:
                kinds.append(("slot", name, number))
    size = len(kinds)
    enter, stay = np.zeros((KINDS, size)), np.zeros((KINDS, size))
    gap_enter, gap_stay, unlabelled = (np.zeros((GAPS, size)) for _ in range(3))
    miss = np.zeros(size)
    glyphs = [chr(number) for number in range(KINDS)]
    for state, (kind, name, number) in enumerate(kinds):
        if kind == "outside":
            stay[:, state] = enter[:, state] = _OUTSIDE
        elif kind == "between":
            enter[:, state] = stay[:, state] = [
                _BETWEEN + _FIGURE * glyph.isdigit() for glyph in glyphs
            ]
            gap_enter[WITHIN, state] = _TORN / 2
        elif kind == "slot":
            enter[:, state] = stay[:, state] = [_in_slot(glyph) for glyph in glyphs]
            gap_stay[:, state] = (0, 0.45, 0.8, 0.6, 0)
            miss[state] = _NO_NUMBER
            if kinds[state - 1][1] == "=":
                unlabelled[:, state] = _UNLABELLED
            if number < PROMPTS:
                for part in ",?;":
                    enter[ord(part), state] = stay[ord(part), state] = 0.05
                gap_stay[:, state] = (0, 0.02, 0.1, 0.5, 0)
                miss[state] = 0.2
            elif number == ANGLE_ROW:
                gap_stay[:, state] = (0, 0.9, 1.8, 0.8, 0)
                if name != ANGLES[0]:
                    gap_enter[[0, WITHIN], state] = 2.2
        else:
            enter[:, state] = [as_letter(name, glyph) for glyph in glyphs]
            gap_enter[WITHIN, state] = _TORN
            if name == "=":
                unlabelled[:, state] = _LOOSE_SIGN
            stay[:, state] = _INSERTED
            stay[ord("0") : ord("9") + 1, state] = _INSERTED + 0.5
            if number < PROMPTS:
                for part in "_{}":
                    stay[ord(part), state] = 0.05
            letter_lost = _MARK_LOST if kind == "loose" or not name.isalpha() else LETTER_LOST
            miss[state] = _SIGN_LOST if name == "=" and kind == "letter" else letter_lost
    retyped = kinds.index(("between", "", LABELLED_ANGLES)) + 1
    enter[:, retyped] += _RETYPED
    miss[retyped] += _RETYPED
    enter[NOTE] = stay[NOTE] = [0.0 if kind in _NOT_PRINTED else _BIG for kind, _, _ in kinds]
    miss[1] = 1000.0  # a printout begins at a price, not by missing what is outside
    closes = [kind in ("slot", "between") or name in (")", "%", "*") for kind, name, _ in kinds]
    return Template(
        enter,
        stay,
        gap_enter,
        gap_stay,
        unlabelled,
        miss,
        between=np.array([state for state, kind in enumerate(kinds) if kind[0] == "between"]),
        closes=np.array(closes),
        line=[number for _, _, number in kinds],
        slots={at: name for at, (kind, name, _) in enumerate(kinds) if kind == "slot"},
        letters={
            at: name for at, (kind, name, _) in enumerate(kinds) if kind in ("letter", "loose")
        },
        labels=tuple(labels),
    )


def _in_slot(char: str) -> float:
    """The cost of a glyph where a number stands."""
    if char.isdigit():
        return 0.0
    if char in NUMERIC or char == "?":
        return 0.2 if char == "E" else 0.08
    if char == "=":
        return _SLOT_EQUALS
    if printed_for(char):
        return _SLOT_LETTER if char.isalpha() and char not in "OQLISBZ" else _SLOT_ALIKE
    return _SLOT_OTHER


def as_letter(letter: str, char: str) -> float:
    """The cost of reading a letter of a label as a glyph."""
    if letter == "=" and char in "-~_":
        return _SIGN_LOST + 0.2  # rather the number's sign, the label's own glyph missing
    cost = label_cost(letter, char)
    if letter == "*" and not char.isdigit():
        return min(cost, 0.5)
    if not char.isdigit():
        return cost
    return cost + (1.25 if letter == "=" and cost < UNSEEN else _FIGURE * (cost == UNSEEN))


# --- texts ---------------------------------------------------------------------------------------

WINDOW = 9000
"""Glyphs aligned at a time: a dozen printouts."""
_BEGIN, _END = 2.2, 0.8
"""What it costs that a printout begins or ends."""
_WITHIN = 6.0
"""What it costs more that one begins with the angles, which numbers in a note look like."""
_FIGURES = frozenset("0123456789.")


@dataclass
class Budget:
    """How much text is read: ``left`` glyphs more, as many again for every page found;
    ``stopped``: the glyph at which it was spent, none where it was not."""

    left: int = 25_000
    stopped: int | None = None

    @property
    def spent(self) -> bool:
        """Whether reading stopped."""
        return self.stopped is not None

    def spend(self, count: int, found: bool) -> None:
        """Read so many glyphs more."""
        self.left = Budget.left if found else self.left - count


_WHOLE = 20
"""Numbers of a page for which the budget is filled again; labels without end are aligned as 14."""
_LABELS = re.compile("=|VAX|VAY|VBX|VBY|LOSS|M[AB]|[IDPTWXY][AB]|[UV][XY]")
_ASIDE = 1000
"""Glyphs that may stand between two parts of a page: half a page of text."""
_FEW_LABELS = 4
"""Fewer labels and equals signs in a window than these, and no printout is in it."""


@dataclass
class Aligned:
    """One printout's part of the text: ``slots``, field -> glyphs ``(start, stop)`` in its place;
    ``states``, the template's state of every glyph from ``start`` on."""

    start: int
    stop: int
    states: list[int]
    slots: dict[str, tuple[int, int]]


def align(
    glyphs: Sequence[Glyph], budget: Budget, notes: Collection[int] = ()
) -> Iterator[Aligned]:
    """The printouts in a row of glyphs, in order, each with what its glyphs are taken for; as many
    as the budget allows. ``notes``: glyphs known to be none of the program's."""
    start = 0
    while start < len(glyphs):
        window = glyphs[start : start + WINDOW]
        last = start + len(window) >= len(glyphs)
        if len(_LABELS.findall(letters(window))) < _FEW_LABELS:
            start += len(window)
            continue
        if budget.left <= 0:
            budget.stopped = start
            return
        parts = _merged(
            _parts(_states(window, [place in notes for place in range(start, start + len(window))]))
        )
        taken = parts if last else parts[:-1] or parts[:1]
        found = [_described(*part, start) for part in taken]
        budget.spend(len(window), any(len(one.slots) >= _WHOLE for one in found))
        yield from found
        if last:
            return
        if not parts:
            start += len(window)
        elif len(parts) == 1:
            start += max(parts[0][1], 1)
        else:
            start += parts[-1][0]


def _described(start: int, stop: int, states: list[int], offset: int) -> Aligned:
    """A part of the states as one printout's."""
    page = template()
    slots: dict[str, tuple[int, int]] = {}
    for index, state in enumerate(states, offset + start):
        if (name := page.slots.get(state)) is not None:
            slots[name] = (slots.get(name, (index, 0))[0], index + 1)
    return Aligned(offset + start, offset + stop, states, slots)


def _parts(states: Sequence[int]) -> list[tuple[int, int, list[int]]]:
    """The stretches of glyphs inside printouts: start, stop, states. The template only goes
    forward, so a state below the one before it begins another printout."""
    parts: list[tuple[int, int, list[int]]] = []
    start = -1
    for index, state in enumerate([*states, 0]):
        inside = state > 0
        if start >= 0 and (not inside or state < states[index - 1]):
            parts.append((start, index, list(states[start:index])))
            start = -1
        if inside and start < 0:
            start = index
    return parts


def _merged(parts: list[tuple[int, int, list[int]]]) -> list[tuple[int, int, list[int]]]:
    """Parts that go on where the one before left off are one printout, with something between."""
    line = template().line
    merged: list[tuple[int, int, list[int]]] = []
    for start, stop, states in parts:
        if merged:
            first, end, before = merged[-1]
            if line[before[-1]] < line[states[0]] and start - end < _ASIDE:
                merged[-1] = first, stop, [*before, *[0] * (start - end), *states]
                continue
        merged.append((start, stop, states))
    return merged


def _gaps(glyphs: Sequence[Glyph]) -> list[int]:
    """The gap before every glyph, and whether it stands within figures."""
    gaps = []
    before = ""
    for place, glyph in enumerate(glyphs):
        gap = int(glyph.gap)
        figures = glyph.char in _FIGURES or _exponent(glyphs[place : place + 3])
        gaps.append(WITHIN if figures and before in _FIGURES and not gap else gap)
        before = glyph.char
    return gaps


def _exponent(glyphs: Sequence[Glyph]) -> bool:
    """Whether glyphs are the E of an exponent, its sign and a digit, in one piece."""
    mark, *rest = glyphs
    if mark.char != "E" or len(rest) < 2 or any(glyph.gap for glyph in rest):
        return False
    return rest[0].char in "+-" and rest[1].char.isdigit()


def _states(glyphs: Sequence[Glyph], noted: Sequence[bool]) -> list[int]:
    """The state of every glyph on the cheapest way."""
    page = template()
    size = page.miss.size
    count = len(glyphs)
    codes = [NOTE if note else code(one.char) for one, note in zip(glyphs, noted, strict=True)]
    gaps = _gaps(glyphs)
    enter = {
        key: page.enter[key[0]] + page.gap_enter[key[1]]
        for key in set(zip(codes, gaps, strict=True))
    }
    stay = {key: page.stay[key[0]] + page.gap_stay[key[1]] for key in enter}
    missed = np.cumsum(page.miss)
    missed_line = np.concatenate([[0], np.cumsum(_ABSENT[:-1])])
    between = page.between
    index = np.arange(size, dtype=np.int16)
    lines = np.arange(between.size, dtype=np.int16)
    exits = np.flatnonzero(page.closes)
    labelled = page.unlabelled[0, 1:] > 0
    numbered = np.zeros(size, bool)
    numbered[list(page.slots)] = True
    begin = np.full(between.size, _BEGIN)
    begin[ANGLE_ROW - 1 : ANGLE_ROW + 1] += _WITHIN
    # what is needed to find the way back
    moved = np.empty((count, size), bool)
    straight = np.zeros((count, size), bool)
    first = np.empty((count, size), np.int16)
    second = np.empty((count, size), np.int16)
    ended = np.empty(count, np.int16)
    begun = np.empty((count, between.size), bool)
    skipped = np.empty((count, between.size), np.int16)

    def passed(costs: np.ndarray, sources: np.ndarray) -> np.ndarray:
        """States may be missed: the least cost to be after each, and from which state."""
        relative = costs - missed
        least = np.minimum.accumulate(relative)
        np.maximum.accumulate(np.where(relative == least, index, 0), out=sources)
        return least + missed

    def opened(costs: np.ndarray, row: int | None) -> np.ndarray:
        """A printout may begin before any line, and lines may be missing."""
        waiting = costs[between]
        start = costs[0] + begin
        begins = start < waiting
        waiting = np.where(begins, start, waiting)
        relative = waiting - missed_line
        least = np.minimum.accumulate(relative)
        if row is not None:
            begun[row] = begins
            np.maximum.accumulate(np.where(relative == least, lines, 0), out=skipped[row])
        costs = costs.copy()
        costs[between] = least + missed_line
        return costs

    costs = np.full(size, _BIG)
    costs[0] = 0
    scratch = np.empty(size, np.int16)
    emitted = np.full(size, _BIG)
    origin = passed(opened(costs, None), scratch)
    for row in range(count):
        key = codes[row], gaps[row]
        advance = np.empty_like(origin)
        advance[0] = _BIG
        advance[1:] = origin[:-1]
        advance += page.unlabelled[gaps[row]]
        # a number right after the glyph of its label costs nothing more
        advance[1:][labelled] = np.minimum(advance[1:], emitted[:-1])[labelled]
        straight[row, 1:] = labelled & (advance[1:] == emitted[:-1])
        advance[1] = _BIG  # a printout begins at a price: `opened`
        advance += enter[key]
        remain = np.where(numbered, emitted, origin) + stay[key]
        np.less(advance, remain, out=moved[row])
        costs = np.where(moved[row], advance, remain)
        emitted = costs.copy()
        closing = exits[np.argmin(costs[exits])]
        end = costs[closing] + _END
        ended[row] = closing if end < costs[0] else 0
        if end < costs[0]:
            costs[0] = end
        costs = passed(costs, first[row])
        costs = opened(costs, row)
        origin = passed(costs, second[row])
        least = origin.min()
        origin -= least
        emitted -= least
    states = [0] * count
    line_of = {int(state): number for number, state in enumerate(between)}
    state = int(np.argmin(np.where(page.closes | (index == 0), origin, _BIG)))
    direct = False
    for row in range(count - 1, -1, -1):
        if not direct:
            state = int(second[row, state])
            number = line_of.get(state)
            if number is not None:
                number = int(skipped[row, number])
                state = 0 if begun[row, number] else int(between[number])
            state = int(first[row, state]) if state else 0
            if state == 0 and ended[row]:
                state = int(ended[row])
        states[row] = state
        # one more glyph of a number follows a glyph of it, not a place passed over
        direct = bool(straight[row, state]) if moved[row, state] else bool(numbered[state])
        if moved[row, state]:
            state -= 1
    return states
