"""Aligning a text with the program's page, by dynamic programming.

The page is a row of states seen through noise: a glyph of a label, a number (any glyphs), what lies
between lines (any), and first what lies outside of pages. A glyph belongs to the state of the one
before it, or to another at the cost of all that is passed over. Costs are whole hundredths of one
wrong letter; of equal ways the one through the earlier states is taken.
"""

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...collision.fields import ANGLES
from .glyphs import (
    COSTS,
    GAP_COSTS,
    NUMERIC,
    Gap,
    Glyph,
    label_cost,
    letters,
    printed_for,
)

Costs = NDArray[np.int16]

LINES = (
    "ENTER THE INITIAL VELOCITY COMPONENTS OF MA :Vax,Vay,Wa ?{REPLY_A}",
    "ENTER THE INITIAL VELOCITY COMPONENTS OF MB :Vbx,Vby,Wb ?{REPLY_B}",
    "MA= {MA} MB= {MB} IA= {IA} IB= {IB}",
    "DA= {DA} DB= {DB}",
    " PA PB TA TB GA",
    " {PA}      {PB}      {TA}      {TB}      {GA}",
    "UX= {UX} UY= {UY} WA= {WA} XA= {XA} YA= {YA}",
    "VX= {VX} VY= {VY} WB= {WB} XB= {XB} YB= {YB}",
    " E= {E} MU= {MUP} EM= {EM}",
    "INITIAL KE= {KI} KE LOSS= {LOSS} %",
    "*****",
    "VAX= {VAX} VAY= {VAY} (XA={XAF} YA= {YAF})",
    "VBX= {VBX} VBY= {VBY} (XB={XBF} YB= {YBF})",
    " WA= {WAF} WB= {WBF}",
    "*****",
)
"""What lines 200 to 770 print, fields in braces."""
MAY_BE_MISSING = (0, 1, 10, 13, 14)
"""Lines that genuine pages lack: the prompts, rows of asterisks, the final spins where M = 4."""
_LABELLED = "PA={PA}PB={PB}TA={TA}TB={TB}GA={GA}"
"""The angles as some people retype them."""
_ROWS = [line.replace(" ", "").upper() for line in (*LINES[:6], _LABELLED, *LINES[6:])]
PROMPTS, HEADING, ANGLE_ROW, SPINS, STARS = 2, 4, 5, 14, 15
"""Lines of a page in which the angles may also stand retyped, the sixth; prompts come before."""
_OPTIONAL = (0, 1, HEADING, 6, 11, SPINS, STARS)
_LOOSE_WORDS = {"INITIALKE=": 7, "KELOSS=": 2}
"""Letters of labels that retyped pages leave out, as they do prompts."""
_MOST: int = np.iinfo(np.int16).max // 3


class State(NamedTuple):
    """A state: ``kind`` (outside, between, letter, loose, number), a letter of a label or a
    number's field, and the line of the page."""

    kind: str
    name: str
    line: int


def _page() -> tuple[list[State], list[tuple[str, list[int]]]]:
    states = [State("outside", "", -1)]
    labels = []
    for number, line in enumerate(_ROWS):
        states.append(State("between", "", number))
        for text, name in re.findall(r"([^{]*)(?:{(\w+)}|$)", line):
            loose = len(text) if number < PROMPTS else _LOOSE_WORDS.get(text, 0)
            named = ANGLES if number == HEADING and text else [name] if text and name else []
            own = [len(states) + at for at, letter in enumerate(text) if letter.isalpha()]
            size = len(own) // max(len(named), 1)
            labels += [(field, own[at * size :][:size]) for at, field in enumerate(named)]
            for place, letter in enumerate(text):
                states.append(State("loose" if place < loose else "letter", letter, number))
            if name:
                states.append(State("number", name, number))
    return states, labels


STATES, LABELS = _page()
"""The states, the first of which is the text outside any printout; of what names each number the
field (of a prompt, its reply's slot), and the states of the label's letters."""


def letter_of(state: int) -> str:
    """The letter of a label that a state is, "" for any other."""
    entry = STATES[state]
    return entry.name if entry.kind in ("letter", "loose") else ""


@lru_cache(maxsize=1)
def _jumps() -> tuple[Costs, Costs, Costs]:
    """What it costs that a glyph belongs to another state than the one before it: ``(gap, from,
    to)``; that one more glyph of a number follows a gap, ``(gap, state)``; that the text ends after
    a state."""

    def then(first: NDArray[np.int32], second: NDArray[np.int32]) -> NDArray[np.int32]:
        least = np.full((len(first), second.shape[1]), _MOST, np.int32)
        for before, after in zip(first.T, second, strict=True):
            np.minimum(least, before[:, None] + after, out=least)
        return least

    missed = np.cumsum([_missing(state) for state in STATES], dtype=np.int32)
    size = len(STATES)
    between = [place for place, state in enumerate(STATES) if state.kind == "between"]
    passed = np.where(np.tri(size, k=-1), _MOST, missed[None] - missed[:, None])
    absent = [COSTS["line may be missing" if n in _OPTIONAL else "line"] for n in range(len(_ROWS))]
    skipped = np.where(np.eye(size), 0, _MOST).astype(np.int32)
    for number, start in enumerate(between):
        skipped[0, start] = COSTS["begins"]
        for stop in range(number, len(between)):
            skipped[start, between[stop]] = sum(absent[number:stop])
    ends = np.array([COSTS["ends"] if _closes(state) else _MOST for state in STATES])
    skips = then(passed[:, [0, *between]], skipped[[0, *between]][:, between])
    ways = np.minimum(passed, then(skips, passed[between]))
    ways = np.minimum(ways, ends[:, None] + ways[0])
    ways[:, 0] = np.minimum(ways[:, 0], ends)
    closing = [place for place, state in enumerate(STATES) if _closes(state) or not place]
    into = np.roll(ways, 1, axis=1)
    into[:, [0, *between]] = ways[:, [0, *between]]
    jumps = np.array([into] * len(Gap))
    numbers = np.flatnonzero([state.kind == "number" for state in STATES])
    for place, state in enumerate(STATES):
        if state.name == "=" or (state.kind == "letter" and state.name.isalpha()):
            before = [number for number in numbers if STATES[number].line == state.line]
            jumps[Gap.NONE, before, place] += COSTS["label without gap"]
    staying = np.zeros((len(Gap), size), np.int16)
    for place, state in enumerate(STATES):
        if place and STATES[place - 1].name == "=" and state.kind == "number":
            others = np.arange(size) != place - 1
            jumps[:, others, place] += np.array(GAP_COSTS["unlabelled"])[:, None]
        if state.kind == "number":
            reply, angle = state.line < PROMPTS, state.line == ANGLE_ROW
            staying[:, place] = GAP_COSTS["reply" if reply else "angle" if angle else "number"]
            if angle and state.name != ANGLES[0]:
                jumps[Gap.NONE, :, place] += COSTS["angle without gap"]
            elif not angle:
                before = numbers[numbers != place]
                jumps[Gap.NONE, before, place] += COSTS["number without gap"]
    ending = ways[:, closing].min(axis=1)
    return np.minimum(jumps, _MOST).astype(np.int16), staying, ending.astype(np.int16)


def _missing(state: State) -> int:
    """What it costs to pass over a state without a glyph."""
    if state.kind == "letter":
        lost = "letter" if state.name.isalpha() else "=" if state.name == "=" else "mark"
        return COSTS[f"{lost} lost"]
    if state.kind == "number":
        return COSTS["reply lost" if state.line < PROMPTS else "number lost"]
    return {"outside": _MOST, "loose": COSTS["mark lost"]}.get(state.kind, 0)


def _closes(state: State) -> bool:
    """Whether a text may end here."""
    return state.kind in ("number", "between") or state.name in (")", "%", "*")


@lru_cache(maxsize=1)
def _alike() -> list[tuple[State, bool, list[int]]]:
    """The states in which every glyph costs the same: one of them, whether it is a number behind
    its "=", and the places of all."""
    groups: dict[tuple[str, str, bool, bool], list[int]] = {}
    for place, state in enumerate(STATES):
        number = state.kind == "number"
        kind = "letter" if state.kind == "loose" else state.kind
        labelled = number and STATES[place - 1].name == "="
        key = kind, "" if number else state.name, number and state.line < PROMPTS, labelled
        groups.setdefault(key, []).append(place)
    return [(STATES[places[0]], key[-1], places) for key, places in groups.items()]


@lru_cache(maxsize=2000)
def _emitted(char: str, broken: bool = False) -> tuple[Costs, Costs]:
    """What a glyph costs by state: that opens it, and one more of it; "" is none of the page's.
    ``broken``: whether a line ends before it."""
    opened = COSTS["letter opens number on a new line"] * (broken and char.isalpha())
    more = COSTS["inserted figure" if char.isdigit() else "inserted"]
    enter, stay = np.empty((2, len(STATES)), np.int16)
    for state, labelled, places in _alike():
        if state.kind in ("outside", "between"):
            figure = COSTS["figure between"] * (char.isdigit() and state.kind == "between")
            first = further = (COSTS[state.kind] + figure) * bool(char)
        elif not char:
            first = further = _MOST
        elif state.kind == "number":
            further = _in_number(char, state.line < PROMPTS)
            first = further + opened * labelled
        else:
            first, further = label_cost(state.name, char), more
        enter[places], stay[places] = first, further
    return enter, stay


def _in_number(char: str, reply: bool) -> int:
    if char.isdigit():
        return 0
    if char in NUMERIC or char == "?" or (reply and char in ",;"):
        return COSTS["E in number" if char == "E" else "mark in number"]
    if char == "=" or not printed_for(char):
        return COSTS["= in number" if char == "=" else "other in number"]
    letter = char.isalpha() and char not in "OQLISBZ"
    return COSTS["letter in number" if letter else "look-alike in number"]


WINDOW = 9000
"""Glyphs aligned at a time: a dozen printouts."""
_WHOLE = 20
"""Numbers of a page for which the budget is filled again; labels without end are aligned as 14."""
_LABELS = re.compile("=|VAX|VAY|VBX|VBY|LOSS|M[AB]|[IDPTWXY][AB]|[UV][XY]")
_EXPONENT = re.compile("(?<=[0-9.])E(?=[-+][0-9])")
_ROW_PIECE = 10
"""Glyphs of a row of angles that may stand outside between its pieces: one number."""
_ASIDE = 1000
"""Glyphs that may stand between two parts of a page: half a page of text."""


@dataclass
class Budget:
    """How much text is read: ``left`` glyphs more, as many again for every page found;
    ``stopped``: the glyph at which it was spent, none where it was not."""

    left: int = 25_000
    stopped: int | None = None


def align(
    glyphs: Sequence[Glyph], start: int, stop: int, budget: Budget, notes: Collection[int]
) -> Iterator[dict[int, int]]:
    """The printouts in the glyphs from one place to another, in order: the state of each of its
    glyphs, by place; as many as the budget allows. ``notes``: glyphs known to be none of the
    program's."""
    while start < stop:
        window = glyphs[start : min(start + WINDOW, stop)]
        last = start + len(window) >= stop
        text = letters(window)
        if len(_LABELS.findall(text)) < 4:  # no printout is in it
            start += len(window)
            continue
        if budget.left <= 0:
            budget.stopped = start
            return
        chars = ["" if at in notes else glyph.char for at, glyph in enumerate(window, start)]
        for exponent in _EXPONENT.finditer(text):
            chars[exponent.start()] = "0"  # as good as a figure, and no label
        parts = _parts(start, _states(chars, [glyph.gap for glyph in window]))
        found = parts if last else parts[:-1] or parts[:1]
        numbers = [
            sum(STATES[place].kind == "number" for place in {*part.values()}) for part in found
        ]
        whole = max(numbers, default=0) >= _WHOLE
        budget.left = Budget.left if whole else budget.left - len(window)
        yield from found
        if last:
            return
        start = min(parts[-1]) if len(parts) > 1 else max(parts[0]) + 1 if parts else start + WINDOW


def _states(chars: Sequence[str], gaps: Sequence[int]) -> list[int]:
    """The state of every glyph on the cheapest way."""
    jumps, staying, ending = _jumps()
    costs = np.empty((len(chars) + 1, len(STATES)), np.int16)
    costs[0] = np.where(np.arange(len(STATES)), _MOST, 0)
    stays = np.empty(costs.shape, bool)
    moves = np.empty_like(jumps[0])
    for row, (char, gap) in enumerate(zip(chars, gaps, strict=True)):
        enter, more = _emitted(char, gap is Gap.LINE)
        np.add(costs[row][:, None], jumps[gap], out=moves)
        move = moves.min(axis=0) + enter
        stay = costs[row] + more + staying[gap]
        stays[row] = stay <= move
        best = np.minimum(stay, move)
        np.minimum(best - best.min(), _MOST, out=costs[row + 1])
    states = [int((costs[-1] + ending).argmin())]
    for row in range(len(chars) - 1, 0, -1):
        state = states[-1]
        before = costs[row] + jumps[gaps[row], :, state]
        states.append(state if stays[row, state] else int(before.argmin()))
    return states[::-1]


def _parts(start: int, states: Sequence[int]) -> list[dict[int, int]]:
    """The stretches of glyphs inside printouts. States only go forward, so one below the one before
    it begins another printout; a stretch that goes on where the one before left off is of the same,
    with something between."""
    parts: list[dict[int, int]] = []
    last = before = 0
    for index, state in enumerate(states, start):
        if state:
            further = STATES[before].line < STATES[state].line and index - last <= _ASIDE
            if not parts or not (state >= before if index == last + 1 else further):
                parts.append({})
            elif index > last + 1:
                parts[-1].update(dict.fromkeys(range(last + 1, index), 0))
            parts[-1][index] = state
            last, before = index, state
    return _rows_joined(parts)


def _rows_joined(parts: Sequence[dict[int, int]]) -> list[dict[int, int]]:
    """The same with a row of angles that blanks and line breaks cut into more than five pieces in
    one: the pieces beyond begin no printout, for nothing of a page stands between them."""
    row = [place for place, state in enumerate(STATES) if state.line == ANGLE_ROW]
    joined: list[dict[int, int]] = []
    for part in parts:
        begin, end = min(part), max(joined[-1]) if joined else 0
        if joined and joined[-1][end] in row and part[begin] in row and begin - end <= _ROW_PIECE:
            rest = [index for index, state in part.items() if state in row]
            joined[-1].update(part)
            joined[-1].update(dict.fromkeys(range(end + 1, max(rest) + 1), row[-1]))
        else:
            joined.append(part)
    return joined
