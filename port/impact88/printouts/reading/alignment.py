"""Aligning a text with the program's page, by dynamic programming.

The page is a hidden Markov chain of states: each letter of a label, each number (any glyphs), the
space between lines (any glyphs), and state 0, the text outside of pages. A glyph belongs to the
state of the one before it, or to another at the cost of all states that are passed over. With e the
cost of a glyph in a state and t that of a transition, the states s minimize

    sum over glyphs g of  e(s[g], g) + t(gap before g, s[g - 1], s[g])

(Viterbi's algorithm). Costs are whole hundredths of one wrong letter; of equally cheap sequences
the one through the earlier states is taken.
"""

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

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
"""Output of lines 200 to 770 of the program, fields in braces."""
MAY_BE_MISSING = (0, 1, 10, 13, 14)
"""Lines that genuine pages lack: the prompts, rows of asterisks, the final spins where M = 4."""
_LABELLED = "PA={PA}PB={PB}TA={TA}TB={TB}GA={GA}"
"""The angles with a label each, as some people type them."""
ANGLES_ROW = "ANGLES"
"""Name of the row of angles, which nothing but blanks divides: one stretch of glyphs."""
ROWS = (*LINES[:5], f"{{{ANGLES_ROW}}}", _LABELLED, *LINES[6:])
"""Lines that pages have: the program's, and angles with labels as line 6."""
# Indices of lines in `ROWS`.
PROMPTS = 2  # the lines before this one are prompts
HEADING = 4
ANGLE_ROW = 5
LABELLED_ANGLES = 6
FIRST_STARS = 11
SPINS = 14
STARS = 15
_OPTIONAL = (0, 1, HEADING, ANGLE_ROW, LABELLED_ANGLES, FIRST_STARS, SPINS, STARS)
_INFINITE: int = np.iinfo(np.int16).max // 3
"""Cost of what is impossible; three of them still fit into an int16."""


class State(NamedTuple):
    """A state of the page.

    Attributes
    ----------
    kind : str
        ``"outside"``, ``"between"``, ``"letter"``, ``"loose"`` (a letter that typed copies leave
        out) or ``"number"`` (the row of angles, too).
    name : str
        The letter of a label, or a number's field.
    line : int
        Line of `ROWS`, -1 outside.
    """

    kind: str
    name: str
    line: int


class Token(NamedTuple):
    """A word, a mark, or a number (its field in braces) that the program prints in a line of
    `ROWS`; the number that it belongs to, "" for asterisks; and the states of its characters."""

    text: str
    name: str
    line: int
    states: range

    @property
    def is_word(self) -> bool:
        """True for letters."""
        return self.text.isalpha()


BEHIND = (")", "%")
"""Marks that belong to the number before them; all others belong to the one behind them."""


def _page() -> tuple[list[State], list[Token]]:
    """Return `STATES` and `TOKENS`."""
    states = [State("outside", "", -1)]
    tokens = []
    for line, template in enumerate(ROWS):
        states.append(State("between", "", line))
        parts = re.findall(r"{\w+}|[A-Z]+|\S", template.upper())
        for at, part in enumerate(parts):
            start = len(states)
            around = parts[at::-1] if part in BEHIND else parts[at:]
            name = next((text[1:-1] for text in around if text.startswith("{")), "")
            if part.startswith("{"):
                states.append(State("number", name, line))
            else:
                # typed copies leave out the first words of a label, as they do prompts
                is_first = part.isalpha() and "".join(parts[at + 1 : at + 2]).isalpha()
                is_loose = line < PROMPTS or (is_first and line != HEADING)
                states += [State("loose" if is_loose else "letter", char, line) for char in part]
            tokens.append(
                Token(part, part if line == HEADING else name, line, range(start, len(states)))
            )
    return states, tokens


_PAGE = _page()
STATES = _PAGE[0]
"""The states, the first of which is the text outside any printout."""
TOKENS = _PAGE[1]
"""The tokens of the page."""
WORDS = [token for token in TOKENS if token.is_word and token.line >= PROMPTS]
"""The words of labels, with the field that each names, in the order of the page."""
TOKEN_OF = {state: token for token in TOKENS for state in token.states}


def letter_of(state: int) -> str:
    """Return the letter of a label that a state stands for, "" for other states."""
    entry = STATES[state]
    return entry.name if entry.kind in ("letter", "loose") else ""


class _Transitions(NamedTuple):
    """Costs between the states of two successive glyphs.

    Attributes
    ----------
    jumps : ndarray, shape (gaps, states, states)
        Cost of going from a state to another, or into the same anew, over a gap.
    staying : ndarray, shape (gaps, states)
        Cost of one more glyph of the same state after a gap, in numbers.
    ending : ndarray, shape (states,)
        Cost of ending the text after a state.
    """

    jumps: Costs
    staying: Costs
    ending: Costs


def _min_plus(first: NDArray[np.int32], second: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the cheapest way from i over any k to j: min over k of first[i, k] + second[k, j]."""
    least = np.full((len(first), second.shape[1]), _INFINITE, np.int32)
    for before, after in zip(first.T, second, strict=True):
        np.minimum(least, before[:, None] + after, out=least)
    return least


def _passing_costs() -> Costs:
    """Return the cost of having passed state j after a glyph of state i: shape (states, states).

    It is the least of: passing over each state from i + 1 to j, which costs its `_skip_cost`; the
    same with whole lines skipped, from the space before one to the space before another; and ending
    the page at i to begin another. To be outside (j = 0), the page must end at i.
    """
    size = len(STATES)
    between = [place for place, state in enumerate(STATES) if state.kind == "between"]
    cumulative = np.cumsum([_skip_cost(state) for state in STATES], dtype=np.int32)
    one_by_one = cumulative[None] - cumulative[:, None]
    one_by_one[np.tri(size, k=-1, dtype=bool)] = _INFINITE
    line_costs = [
        COSTS["line may be missing" if line in _OPTIONAL else "line"] for line in range(len(ROWS))
    ]
    by_line = np.where(np.eye(size), 0, _INFINITE).astype(np.int32)
    for line, start in enumerate(between):
        by_line[0, start] = COSTS["begins"]
        for stop in range(line, len(between)):
            by_line[start, between[stop]] = sum(line_costs[line:stop])
    starts = [0, *between]
    to_line = _min_plus(one_by_one[:, starts], by_line[starts][:, between])
    passing: NDArray[np.int32] = np.minimum(one_by_one, _min_plus(to_line, one_by_one[between]))
    end_costs = [COSTS["ends"] if _may_end(state) else _INFINITE for state in STATES]
    ends = np.array(end_costs, np.int32)
    passing = np.minimum(passing, ends[:, None] + passing[0])
    passing[:, 0] = np.minimum(passing[:, 0], ends)
    return np.minimum(passing, _INFINITE).astype(np.int16)


@lru_cache(maxsize=1)
def _transitions() -> _Transitions:
    """Return the costs of transitions, made once."""
    passing = _passing_costs()
    # a glyph enters state j when all states up to j - 1 are passed; the states that hold any number
    # of glyphs, none included, are entered when they are passed themselves
    into = np.roll(passing, 1, axis=1)
    optional = [place for place, state in enumerate(STATES) if state.kind in ("outside", "between")]
    into[:, optional] = passing[:, optional]
    jumps = np.repeat(into[None], len(Gap), axis=0)
    staying = np.zeros((len(Gap), len(STATES)), np.int16)
    numbers = np.flatnonzero([state.kind == "number" for state in STATES])
    numbers_of: dict[int, list[int]] = {}
    labels_of: dict[int, list[int]] = {}
    for place, state in enumerate(STATES):
        if state.kind == "number":
            numbers_of.setdefault(state.line, []).append(place)
            _add_gap_costs(place, numbers, jumps, staying)
        elif state.name == "=" or (state.kind == "letter" and state.name.isalpha()):
            labels_of.setdefault(state.line, []).append(place)
    for line, places in labels_of.items():
        is_later = [place for place in places if STATES[place - 1].kind != "between"]
        jumps[Gap.LINE][:, is_later] += COSTS["label goes on a new line"]
        if line in numbers_of:
            jumps[Gap.NONE][np.ix_(numbers_of[line], places)] += COSTS["label without gap"]
    may_end = [place for place, state in enumerate(STATES) if _may_end(state) or not place]
    ending = passing[:, may_end].min(axis=1)
    return _Transitions(np.minimum(jumps, _INFINITE, out=jumps), staying, ending)


def _add_gap_costs(place: int, numbers: NDArray[np.intp], jumps: Costs, staying: Costs) -> None:
    """Add to a number's transitions what the gap before a glyph costs.

    ``place``: the number's state; ``numbers``: the states of all numbers.
    """
    state = STATES[place]
    if STATES[place - 1].name == "=":
        is_other = np.arange(len(STATES)) != place - 1
        jumps[:, is_other, place] += np.array(GAP_COSTS["unlabelled"])[:, None]
    holds_several = state.line < PROMPTS or state.name == ANGLES_ROW
    staying[:, place] = GAP_COSTS["numbers" if holds_several else "number"]
    jumps[Gap.NONE, numbers[numbers != place], place] += COSTS["number without gap"]


def _skip_cost(state: State) -> int:
    """Return the cost of passing over a state without a glyph."""
    if state.kind == "letter":
        lost = "letter" if state.name.isalpha() else "=" if state.name == "=" else "mark"
        return COSTS[f"{lost} lost"]
    if state.kind == "number" and state.name != ANGLES_ROW:
        return COSTS["reply lost" if state.line < PROMPTS else "number lost"]
    return {
        "outside": _INFINITE,
        "loose": COSTS["mark lost"],
        "number": COSTS["line may be missing"],  # where the angles have labels
    }.get(state.kind, 0)


def _may_end(state: State) -> bool:
    """Return True for a state after which a page may end."""
    return state.kind in ("number", "between") or state.name in (")", "%", "*")


@lru_cache(maxsize=1)
def _cost_classes() -> tuple[list[tuple[State, bool]], NDArray[np.intp]]:
    """Return the classes of states in which glyphs cost the same, and the class of each state.

    A class is one of its states, and True if they are numbers behind an ``=``.
    """
    classes: dict[tuple[str, str, bool, bool], tuple[State, bool]] = {}
    keys = []
    for place, state in enumerate(STATES):
        is_number = state.kind == "number"
        kind = "letter" if state.kind == "loose" else state.kind
        follows_sign = is_number and STATES[place - 1].name == "="
        is_reply = is_number and state.line < PROMPTS
        keys.append((kind, "" if is_number else state.name, is_reply, follows_sign))
        classes.setdefault(keys[-1], (state, follows_sign))
    numbers = {key: number for number, key in enumerate(classes)}
    return list(classes.values()), np.array([numbers[key] for key in keys])


@lru_cache(maxsize=2000)
def _glyph_costs(char: str, broken: bool = False) -> tuple[Costs, Costs]:
    """Return what a glyph costs in each state: as the first of the state, and as a further one.

    Parameters
    ----------
    char : str
        The glyph, "" for one that is known to be none of the program's.
    broken : bool
        True if a line ends before it.
    """
    at_line_start = COSTS["letter opens number on a new line"] * (broken and char.isalpha())
    inserted = COSTS["inserted figure" if char.isdigit() else "inserted"]
    classes, class_of = _cost_classes()
    firsts, furthers = [], []
    for state, follows_sign in classes:
        if state.kind in ("outside", "between"):
            figure = COSTS["figure between"] * (char.isdigit() and state.kind == "between")
            first = further = (COSTS[state.kind] + figure) * bool(char)
        elif not char:
            first = further = _INFINITE
        elif state.kind == "number":
            further = _in_number(char, state.line < PROMPTS)
            first = further + at_line_start * follows_sign
        else:
            first, further = label_cost(state.name, char), inserted
        firsts.append(first)
        furthers.append(further)
    return np.array(firsts, np.int16)[class_of], np.array(furthers, np.int16)[class_of]


def _in_number(char: str, reply: bool) -> int:
    """Return what a glyph costs in a number, or in a reply."""
    if char.isdigit():
        return 0
    if char in NUMERIC or char == "?" or (reply and char in ",;"):
        return COSTS["E in number" if char == "E" else "mark in number"]
    if char == "=" or not printed_for(char):
        return COSTS["= in number" if char == "=" else "other in number"]
    is_letter = char.isalpha() and char not in "OQLISBZ"
    return COSTS["letter in number" if is_letter else "look-alike in number"]


WINDOW = 9000
"""Glyphs aligned at a time: a dozen printouts."""
_MIN_NUMBERS = 16
"""Numbers, the row of angles as one, from which a page fills the budget again: half of all."""
_LABELS = re.compile("=|VAX|VAY|VBX|VBY|LOSS|M[AB]|[IDPTWXY][AB]|[UV][XY]")
EXPONENT = re.compile("(?<=[0-9.])E(?=[-+][0-9])")
_MAX_INTERRUPTION = 1000
"""Glyphs that may stand between two parts of a page: half a page of text."""


@dataclass
class Budget:
    """Glyphs that may still be aligned.

    Attributes
    ----------
    left : int
        Number of glyphs left; every whole page that is found fills it again.
    stopped : int, optional
        The glyph at which the budget was spent.
    """

    left: int = 25_000
    stopped: int | None = None


def align(
    glyphs: Sequence[Glyph], start: int, stop: int, budget: Budget, notes: Collection[int]
) -> Iterator[dict[int, int]]:
    """Yield the printouts among some glyphs, in order, as far as the budget allows.

    Parameters
    ----------
    glyphs : sequence of Glyph
    start, stop : int
        Range of the glyphs that are aligned.
    budget : Budget
    notes : collection of int
        Places of glyphs that are known to be none of the program's.

    Yields
    ------
    dict of int to int
        State of each glyph of a printout, by its place.
    """
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
        for exponent in EXPONENT.finditer(text):
            chars[exponent.start()] = "0"  # as good as a figure, and no label
        parts = _segments(start, _decode(chars, [glyph.gap for glyph in window]))
        # the last segment may go on behind the window: it is aligned again with what follows
        complete = parts if last else parts[:-1] or parts[:1]
        counts = [
            sum(STATES[place].kind == "number" for place in {*part.values()}) for part in complete
        ]
        has_page = max(counts, default=0) >= _MIN_NUMBERS
        budget.left = Budget.left if has_page else budget.left - len(window)
        yield from complete
        if last:
            return
        start = min(parts[-1]) if len(parts) > 1 else max(parts[0]) + 1 if parts else start + WINDOW


def _decode(chars: Sequence[str], gaps: Sequence[int]) -> list[int]:
    """Return the state of every glyph in the cheapest sequence of states."""
    jumps, staying, ending = _transitions()
    costs = np.empty((len(chars) + 1, len(STATES)), np.int16)
    costs[0] = np.where(np.arange(len(STATES)), _INFINITE, 0)
    stays = np.empty(costs.shape, bool)
    moves = np.empty_like(jumps[0])
    for row, (char, gap) in enumerate(zip(chars, gaps, strict=True)):
        first, further = _glyph_costs(char, gap is Gap.LINE)
        np.add(costs[row][:, None], jumps[gap], out=moves)
        move = moves.min(axis=0) + first
        stay = costs[row] + further + staying[gap]
        stays[row] = stay <= move
        best = np.minimum(stay, move)
        np.minimum(best - best.min(), _INFINITE, out=costs[row + 1])
    states = [int((costs[-1] + ending).argmin())]
    for row in range(len(chars) - 1, 0, -1):
        state = states[-1]
        before = costs[row] + jumps[gaps[row], :, state]
        states.append(state if stays[row, state] else int(before.argmin()))
    return states[::-1]


def _segments(start: int, states: Sequence[int]) -> list[dict[int, int]]:
    """Return the states of the glyphs of each printout, by the glyphs' places.

    States only go forward, so that one below the one before it begins another printout. A stretch
    that goes on where the one before left off belongs to the same printout, if no more than
    `_MAX_INTERRUPTION` glyphs stand between; these get state 0.
    """
    parts: list[dict[int, int]] = []
    last = before = 0
    for index, state in enumerate(states, start):
        if state:
            goes_on = STATES[before].line < STATES[state].line
            goes_on = goes_on and index - last <= _MAX_INTERRUPTION
            if not parts or not (state >= before if index == last + 1 else goes_on):
                parts.append({})
            elif index > last + 1:
                parts[-1].update(dict.fromkeys(range(last + 1, index), 0))
            parts[-1][index] = state
            last, before = index, state
    return parts
