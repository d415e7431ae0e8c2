"""The page the program prints, as a row of states that text is aligned with.

Every glyph of a label is a state, every number is one state that holds any number of glyphs, and
before every line stands a state for what may lie between lines. Costs are in units of one wrong
letter; they say how a glyph is read for another, and nothing about any one page.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..fields import ANGLES
from .channel import UNSEEN, label_cost, printed_for
from .glyphs import NUMERIC

Floats = NDArray[np.float64]

REPLY_A, REPLY_B = "REPLY_A", "REPLY_B"
"""Slots of the replies to the two prompts."""

_PROMPT = "ENTERTHEINITIALVELOCITYCOMPONENTSOFM{0}:VAX,VAY,WA?"


class Slot(NamedTuple):
    """Where a number stands: the field's name."""

    name: str


class Line(NamedTuple):
    """One printed line: labels (text) and slots in order, and what it costs to miss it whole."""

    items: tuple[str | Slot, ...]
    absent: float


def _line(text: str, absent: float = 2.0) -> Line:
    """A line written as labels and field names in braces."""
    items: list[str | Slot] = []
    for part in text.replace("{", "\0{").replace("}", "\0").split("\0"):
        if part.startswith("{"):
            items.append(Slot(part[1:]))
        elif part:
            items.append(part)
    return Line(tuple(items), absent)


LINES: tuple[Line, ...] = (
    _line("ENTERTHEINITIALVELOCITYCOMPONENTSOFMA:VAX,VAY,WA?{REPLY_A}", 0.3),
    _line("ENTERTHEINITIALVELOCITYCOMPONENTSOFMB:VBX,VBY,WB?{REPLY_B}", 0.3),
    _line("MA={MA}MB={MB}IA={IA}IB={IB}"),
    _line("DA={DA}DB={DB}"),
    _line("PAPBTATBGA", 1.2),
    _line("{PA}{PB}{TA}{TB}{GA}"),
    _line("PA={PA}PB={PB}TA={TA}TB={TB}GA={GA}", 0.0),
    _line("UX={UX}UY={UY}WA={WA}XA={XA}YA={YA}"),
    _line("VX={VX}VY={VY}WB={WB}XB={XB}YB={YB}"),
    _line("E={E}MU={MUP}EM={EM}"),
    _line("INITIALKE={KI}KELOSS={LOSS}%"),
    _line("*****", 0.3),
    _line("VAX={VAX}VAY={VAY}(XA={XAF}YA={YAF})"),
    _line("VBX={VBX}VBY={VBY}(XB={XBF}YB={YBF})"),
    _line("WA={WAF}WB={WBF}", 0.8),
    _line("*****", 0.3),
)
"""The lines in the order of listing lines 200 to 770; angles also as some people retype them."""

ANGLE_ROW = 5
"""The line of `LINES` that holds nothing but the five angles."""
LABELLED_ANGLES = 6
"""The line of the angles as some people retype them."""
_RETYPED = 1.5
"""What it costs to begin it: the row of angles is what the program prints. Two columns of
names and numbers are read with up to 2.0, no longer with 2.5."""
RESULTS = 12
"""The line of `LINES` that the results begin with."""
SPINS = 14
"""The line of the final spins."""
STARS = (11, 15)
"""The rows of asterisks."""

_MISS = {"=": 0.45, "(": 0.25, ")": 0.25, "%": 0.3, "*": 0.25, ":": 0.2, ",": 0.2, "?": 0.3}
"""What it costs to miss a glyph of a label; other letters `LETTER_LOST`."""
LETTER_LOST = 0.65
"""Of letters that nobody leaves out."""
_LOOSE = 0.25
"""The same for words that retyped pages leave out (INITIAL, KE before LOSS, the prompts)."""
_FIGURE = 0.3
"""What a figure costs more where a letter of a label is wrong."""
INSERTED = 1.0
_SLOT_ALIKE, _SLOT_LETTER, _SLOT_OTHER, _SLOT_EQUALS = 0.3, 0.55, 0.9, 1.6
_BETWEEN, _BETWEEN_DIGIT, _BETWEEN_SIGN = 0.5, 0.9, 0.4
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
KINDS = 128
"""Glyphs are told apart by this many codes; the last is for all others."""


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
    without a glyph. ``between``: the states before the lines; ``absent``: of missing each line;
    ``closes``: whether text may end after a state. ``line``: where a state belongs; ``slots``:
    state -> field name; ``letters``: state -> a label's letter; ``labels``: what names each number.
    """

    enter: Floats
    stay: Floats
    gap_enter: Floats
    gap_stay: Floats
    unlabelled: Floats
    miss: Floats
    between: NDArray[np.intp]
    absent: Floats
    closes: NDArray[np.bool_]
    line: list[int]
    slots: dict[int, str]
    letters: dict[int, str]
    labels: tuple[Label, ...]


@lru_cache(maxsize=1)
def template() -> Template:
    """The template's states, the first of which is the text outside any printout."""
    kinds: list[tuple[str, str, int]] = [("outside", "", -1)]
    for number, line in enumerate(LINES):
        kinds.append(("between", "", number))
        for item in line.items:
            if isinstance(item, Slot):
                kinds.append(("slot", item.name, number))
            else:
                loose = 7 if item == "INITIALKE=" else 2 if item == "KELOSS=" else 0
                for place, letter in enumerate(item):
                    kind = "loose" if place < loose or number < 2 else "letter"
                    kinds.append((kind, letter, number))
    size = len(kinds)
    enter = np.zeros((KINDS, size))
    stay = np.zeros((KINDS, size))
    gap_enter = np.zeros((GAPS, size))
    gap_stay = np.zeros((GAPS, size))
    unlabelled = np.zeros((GAPS, size))
    miss = np.zeros(size)
    slot_costs = np.array([_in_slot(chr(number)) for number in range(KINDS)])
    between_costs = np.array([_between(chr(number)) for number in range(KINDS)])
    for state, (kind, name, number) in enumerate(kinds):
        if kind == "outside":
            stay[:, state] = _BETWEEN * 0.9
            enter[:, state] = _BETWEEN * 0.9
        elif kind == "between":
            enter[:, state] = stay[:, state] = between_costs
            gap_enter[WITHIN, state] = _TORN / 2
        elif kind == "slot":
            enter[:, state] = stay[:, state] = slot_costs
            gap_stay[:, state] = (0, 0.45, 0.8, 0.6, 0)
            miss[state] = _NO_NUMBER
            if kinds[state - 1][1] == "=":
                unlabelled[:, state] = _UNLABELLED
            if name in (REPLY_A, REPLY_B):
                for part in ",?;":
                    enter[ord(part), state] = stay[ord(part), state] = 0.05
                gap_stay[:, state] = (0, 0.02, 0.1, 0.5, 0)
                miss[state] = 0.2
            elif number == ANGLE_ROW and name in ANGLES:
                gap_stay[:, state] = (0, 0.9, 1.8, 0.8, 0)
                if name != ANGLES[0]:
                    gap_enter[[0, WITHIN], state] = 2.2
        else:
            for number_ in range(KINDS):
                enter[number_, state] = as_letter(name, chr(number_))
            gap_enter[WITHIN, state] = _TORN
            if name == "=":
                unlabelled[:, state] = _LOOSE_SIGN
            stay[:, state] = INSERTED
            stay[ord("0") : ord("9") + 1, state] = INSERTED + 0.5
            if number < 2:
                for part in "_{}":
                    stay[ord(part), state] = 0.05
            miss[state] = _LOOSE if kind == "loose" else _MISS.get(name, LETTER_LOST)
    retyped = kinds.index(("between", "", LABELLED_ANGLES)) + 1
    enter[:, retyped] += _RETYPED
    miss[retyped] += _RETYPED
    miss[1] = 1000.0  # a printout begins at a price, not by missing what is outside
    between = np.array([state for state, kind in enumerate(kinds) if kind[0] == "between"])
    closes = np.array([kind[0] == "slot" or kind[1] in ")%*" for kind in kinds])
    closes[0] = False
    return Template(
        enter,
        stay,
        gap_enter,
        gap_stay,
        unlabelled,
        miss,
        between,
        np.array([line.absent for line in LINES]),
        closes,
        [number for _, _, number in kinds],
        {state: name for state, (kind, name, _) in enumerate(kinds) if kind == "slot"},
        {state: name for state, (kind, name, _) in enumerate(kinds) if kind in ("letter", "loose")},
        tuple(_labels()),
    )


def _labels() -> Iterator[Label]:
    """The labels in the order of the page; the heading of line 640 names an angle a pair."""
    state = 0
    for number, line in enumerate(LINES):
        state += 1
        for place, item in enumerate(line.items):
            if isinstance(item, Slot):
                state += 1
                continue
            following = [one.name for one in line.items[place + 1 :] if isinstance(one, Slot)]
            parts = [(item, following[0])] if following else []
            if number == ANGLE_ROW - 1:
                parts = [(name, name) for name in ANGLES]
            at = state
            for text, name in parts:
                states = [at + 1 + place for place, one in enumerate(text) if one.isalpha()]
                yield Label(name, "".join(filter(str.isalpha, text)), tuple(states))
                at += len(text)
            state += len(item)


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


def _between(char: str) -> float:
    """The cost of a glyph between lines or outside."""
    if char.isdigit():
        return _BETWEEN_DIGIT
    return _BETWEEN_SIGN if char in "|.,-_~:;'`" else _BETWEEN


def as_letter(letter: str, char: str) -> float:
    """The cost of reading a letter of a label as a glyph."""
    if letter == "=" and char in "-~_":
        return _MISS["="] + 0.2  # rather the number's sign, the label's own glyph missing
    cost = label_cost(letter, char)
    if letter == "*" and not char.isdigit():
        return min(cost, 0.5)
    if not char.isdigit():
        return cost
    return cost + (1.25 if letter == "=" and cost < UNSEEN else _FIGURE * (cost == UNSEEN))
