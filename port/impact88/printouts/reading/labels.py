"""Text that the program prints beside its numbers, as differences: labels, marks, prompts' words.

A number stands where it stands by its place on the page; its label says so a second time, and the
two must agree. A label that reads as another of the program's, or as a word that is not this one,
contradicts. One that is damaged within the reach of the glyph table, or missing, leaves a doubt.

A mark that was not read is missing on the paper or was lost by the page's reader; where one was
read as a glyph that no reader was seen to take for it, something else was typed. Either is
reported, and then the page is not all that the program prints. On a page without a single equals
sign, of another form such as a table, missing marks leave no doubt. Asterisks are only counted: of
41 readings of given pages that are exact otherwise 24 lack some, and none lacks another mark.
"""

import re
from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache

from ..fields import ANGLES, FIELDS
from .alignment import (
    BEHIND,
    FIRST_STARS,
    HEADING,
    LABELLED_ANGLES,
    PROMPTS,
    STARS,
    STATES,
    TOKENS,
    WORDS,
    Token,
)
from .differences import Difference, Kind, difference_at
from .editpath import cheapest_path
from .glyphs import COSTS, Gap, Page, is_look_alike, label_cost, letters

_DIFFERENT = 35
"""Cost per letter from which a word is another label, not this one misread: that of two letters of
which one is read so less than once in 600."""
_MIN_ADVANTAGE = 25
"""Cost by which another label must be cheaper to be the one read; U for V, the likeliest, costs
29."""
_NO_WORD = frozenset("0123456789=.(),:")


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


def label_differences(
    page: Page, states: Mapping[int, int], slots: Mapping[str, tuple[int, int]]
) -> list[Difference]:
    """Return the words of labels that are not the program's, in the order of the page.

    Parameters
    ----------
    page : Page
    states : mapping of int to int
        State of each glyph of the printout.
    slots : mapping of str to (int, int)
        Range of glyphs of every number, by field.
    """
    differences: list[Difference] = []
    for token, start, stop, read in _words_read(page, states, slots):
        if read == token.text:
            continue
        kind, is_open = _compare_word(token, read)
        difference = difference_at(page, kind, token.name, token.text, (start, stop), read)
        before = differences[-1] if differences else None
        if before and before.kind is kind is Kind.MISSING and before.name == token.name:
            text = before.printed + token.text  # a label of two words
            differences[-1] = before._replace(printed=text)
        else:
            differences.append(difference._replace(bears=is_open))
    return differences


def weigh_labels(
    labels: Sequence[Difference], machine_read: bool, fragment: bool
) -> list[Difference]:
    """Return the labels with those that contradict, or leave a doubt, for who read the page.

    A person types no other label by reading it so. A machine does: of 15,300 labels of given scans
    373 read as other words, 7 of them on pages with few signs of a reader. But no two labels of a
    page read as each other: such labels were exchanged, whoever read the page. Labels of a fragment
    do not tell which numbers it holds.
    """
    pairs = {(label.printed, label.read) for label in labels}
    weighed = []
    for label in labels:
        is_misread = (machine_read or fragment) and (label.read, label.printed) not in pairs
        if label.kind is Kind.CONTRADICTS and is_misread:
            label = label._replace(kind=Kind.LOOK_ALIKE)
        is_typed = not machine_read and label.name in FIELDS and label.kind is Kind.LOOK_ALIKE
        weighed.append(
            label._replace(bears=label.bears or is_typed or label.kind is Kind.CONTRADICTS)
        )
    return weighed


def _words_read(
    page: Page, states: Mapping[int, int], slots: Mapping[str, tuple[int, int]]
) -> Iterator[tuple[Token, int, int, str]]:
    """Yield the words of labels of numbers that were read, and those of which letters were read.

    Each is the token, start and stop in the text, and the letters that were read.
    """

    def read(at: Iterable[int]) -> str:
        return letters(page.glyphs[index] for index in at)

    joined = words_before(page, slots)
    glyphs_of = {
        token: [index for index, state in states.items() if state in token.states]
        for token in WORDS
    }
    heading_at = [at for token in WORDS if token.line == HEADING for at in glyphs_of[token]]
    if heading_at:
        yield from _heading(page, min(heading_at), max(heading_at))
    is_labelled = any(glyphs_of[token] for token in WORDS if token.line == LABELLED_ANGLES)
    for token in WORDS:
        at: Sequence[int] = glyphs_of[token]
        if token.line == HEADING and (heading_at or is_labelled):
            continue
        if token.line == LABELLED_ANGLES and not at:
            continue
        word = range(*joined.get(token.name, (0, 0)))
        label = token.line, token.name
        known = [index for other in _LABELS[label] for index in glyphs_of[other]]
        if token is _LABELS[label][-1] and word and read(known[-len(word) :]) != read(word):
            at = [index for index in word if index in at or index not in known]
        if at:
            yield token, *page.span(at[0], at[-1] + 1), read(at)
        elif token.name in slots:
            begin = page.span(*slots[token.name])[0]
            yield token, begin, begin, ""


def _heading(page: Page, first: int, last: int) -> Iterator[tuple[Token, int, int, str]]:
    """Yield the five labels of the heading, by its words outside brackets such as ``(DEG)`` or, if
    these are not five, in pairs of letters."""
    glyphs, end = page.glyphs, last + 1
    while first and glyphs[first].gap is not Gap.LINE and _is_of_heading(glyphs[first - 1].char):
        first -= 1
    while (
        end < len(glyphs) and glyphs[end].gap is not Gap.LINE and _is_of_heading(glyphs[end].char)
    ):
        end += 1
    text = letters(glyphs[first:end])
    inside = {at for match in re.finditer(r"\([^()]*\)?", text) for at in range(*match.span())}
    own = [at for at in range(first, end) if at - first not in inside]
    starts = [at for at in own if at == own[0] or glyphs[at].gap or at - 1 not in own]
    if len(starts) != len(ANGLES):
        starts = own[::2]
    exact = "".join(ANGLES) in text
    for number, token in enumerate(_HEADING):
        if len(starts) == len(ANGLES):
            start, stop = [*starts, end][number : number + 2]
            word = [at for at in own if start <= at < stop]
            read = letters(glyphs[at] for at in word)
            yield token, *page.span(start, word[-1] + 1), read
        else:
            yield token, *page.span(first, end), token.text if exact else ""


def _is_of_heading(char: str) -> bool:
    return char.isalpha() or char in "()"


def _compare_word(token: Token, read: str) -> tuple[Kind, bool]:
    """Return how a word of a label differs, and True if it leaves a doubt which number is meant.

    There is a doubt where the letters that were read as printed fit another word, too.
    """
    printed = token.text
    others = {word.text for word in WORDS if (word.name in ANGLES) == (token.name in ANGLES)} - {
        printed
    }
    cost = _distance(printed, read)
    cost_of_other = min(_distance(text, read) for text in others)
    matches = {(at, char) for at, char in enumerate(read) if printed[at : at + 1] == char}
    alike = (matches.issubset(enumerate(text)) for text in others if len(text) == len(printed))
    doubt = len(read) != len(printed) or not matches or any(alike)
    if not any(map(str.isalnum, read)):
        return Kind.MISSING, doubt
    is_part = len(_LABELS[token.line, token.name]) > 1
    # itself, with gaps: of two words, the other tells the label
    is_gapped = (is_part or read not in others) and has_gaps_only(printed, read)
    if len(read + printed) > len("EL") and not is_gapped:
        is_word = read.isascii() and read.isalpha() and cost >= _DIFFERENT * len(printed)
        is_strange = is_word and not (is_part and 2 * len(matches) >= len(printed))
        if cost_of_other < cost - _MIN_ADVANTAGE or is_strange:
            return Kind.CONTRADICTS, doubt
    return Kind.LOOK_ALIKE, doubt


def has_gaps_only(printed: str, read: str) -> bool:
    """Return True for a word of which letters are lost and none is misread."""
    remaining = iter(printed)
    return all(letter in remaining for letter in read)


_LABELS: dict[tuple[int, str], list[Token]] = {}
"""The words of each label, by its line and field."""
for _word in WORDS:
    _LABELS.setdefault((_word.line, _word.name), []).append(_word)
_LAST_TEXTS = {word.name: word.text for word in WORDS}
_HEADING = [word for word in WORDS if word.line == HEADING]


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


_MARKS = [
    token
    for token in TOKENS
    if token.name
    and not token.text.startswith("{")
    and (token.line < PROMPTS or not token.is_word)
    and token.line != LABELLED_ANGLES
]
"""The marks, and the words of the prompts, in the order of the page."""


def mark_differences(
    page: Page,
    states: Mapping[int, int],
    slots: Mapping[str, tuple[int, int]],
    labels: Sequence[Difference],
    machine_read: bool,
) -> list[Difference]:
    """Return the marks, asterisks and words of prompts that are not as the program prints them.

    Parameters
    ----------
    page : Page
    states : mapping of int to int
        State of each glyph of the printout.
    slots : mapping of str to (int, int)
        Range of glyphs of every number that was read, and of the replies.
    labels : sequence of Difference
        The labels: an equals sign goes unreported where the whole label is missing, and a bracket
        where it counts as a letter of the label.
    machine_read : bool
        True for a page of an optical reader, which may take a mark for one that looks like it, lose
        asterisks, and put a mark on another line.
    """
    without_label = {
        label.name
        for label in labels
        if label.kind is Kind.MISSING and label.printed.endswith(_LAST_TEXTS[label.name])
    }
    reported = {at for label in labels if label.bears for at in range(label.start, label.stop)}
    places: dict[int, int] = {}
    for index in sorted(states):
        places.setdefault(states[index], index)
    differences: list[Difference] = []
    end_of_last = 0  # of the states of the last token reported
    for token in _MARKS:
        name, text = token.name, token.text
        if name not in slots or (text == "=" and name in without_label):
            continue
        at = [places[state] for state in token.states if state in places]
        read = letters(page.glyphs[index] for index in at)
        kind = _compare_mark(page, token, at, slots, machine_read)
        if kind is None:
            continue
        if at and reported.issuperset(page.glyphs[index].offset for index in at):
            continue
        start = stop = _gap(page, token, places, slots)
        if at:
            start, stop = page.span(at[0], at[-1] + 1)
        if name not in FIELDS and end_of_last == token.states.start:  # words side by side
            before = differences.pop()
            text, read, start = f"{before.printed} {text}", before.read + read, before.start
            kind = Kind.LOOK_ALIKE if read else Kind.MISSING
        if kind is not Kind.MOVED:
            end_of_last = token.states.stop
        differences.append(difference_at(page, kind, name, text, (start, stop), read))
    if not machine_read:
        differences += _broken_asterisks(page, places, slots)
    signs = {page.glyphs[at].char for at, state in states.items() if STATES[state].name == "="}
    return [
        # of another form, with colons for example
        mark._replace(bears="=" in signs or not _is_of_form(mark))
        for mark in differences
    ]


def _is_of_form(mark: Difference) -> bool:
    """Return True for a mark that a page without equals signs is not expected to have."""
    return mark.name in FIELDS and (mark.kind is Kind.MISSING or mark.printed == "=")


def _compare_mark(
    page: Page,
    token: Token,
    at: Sequence[int],
    slots: Mapping[str, tuple[int, int]],
    machine_read: bool,
) -> Kind | None:
    """Return how a mark or a word differs, of which the glyphs ``at`` were read; None if not."""
    read = letters(page.glyphs[index] for index in at)
    if read == token.text:
        is_apart = token.text in (*BEHIND, "=") and page.glyphs[at[0]].gap is Gap.LINE
        return Kind.MOVED if is_apart and not machine_read else None
    start, stop = slots[token.name]
    in_number = token.name in FIELDS and token.text in letters(page.glyphs[start - 1 : stop + 1])
    is_alike = len(read) == len(token.text) and all(map(is_look_alike, token.text, read))
    if in_number or (machine_read and is_alike):
        return None
    return Kind.LOOK_ALIKE if read else Kind.MISSING


def _broken_asterisks(
    page: Page, places: Mapping[int, int], slots: Mapping[str, tuple[int, int]]
) -> Iterator[Difference]:
    """Yield the rows of asterisks of which some are not on the page, or another character stands
    among them; and the row that is missing where the other is on the page."""
    read_at = {
        row: [places[state] for state in _asterisks(row) if state in places] for row in _STARS
    }
    for row, (field, _) in _STARS.items():
        asterisks = "*" * len(_asterisks(row))
        at = read_at[row]
        read = letters(page.glyphs[index] for index in at)
        if field not in slots or read == asterisks or not any(read_at.values()):
            continue
        place = page.span(*slots[field])[row == STARS]
        span = page.span(at[0], at[-1] + 1) if at else (place, place)
        kind = Kind.LOOK_ALIKE if at else Kind.MISSING
        yield difference_at(page, kind, field, asterisks, span, read)


def form_note(marks: Sequence[Difference]) -> list[str]:
    """Return a note on the marks of a page of another form, without equals signs, or none."""
    missing = [mark for mark in marks if mark.is_mark and mark.kind is Kind.MISSING]
    texts = dict.fromkeys(repr(mark.printed) for mark in missing if not mark.bears)
    return [f"retyped in another form: the page has no {', '.join(texts)}"] if texts else []


def _gap(
    page: Page, token: Token, places: Mapping[int, int], slots: Mapping[str, tuple[int, int]]
) -> int:
    """Return the offset in the text at which a missing mark or word would stand."""
    if token.text in BEHIND:
        return page.span(*slots[token.name])[1]
    before = [state for state in places if state < token.states.start]
    if STATES[token.states.start].line < PROMPTS and before:
        last = max(before)
        if STATES[last].line == STATES[token.states.start].line:
            return page.glyphs[places[last]].offset + 1
    return page.span(*slots[token.name])[0]


_STARS = {
    FIRST_STARS: ("VAX", "above the final velocities"),
    STARS: ("VBY", "below them"),
}
"""The rows of asterisks: a number beside each, and where it stands."""


def _asterisks(row: int) -> list[int]:
    """Return the states of a row of asterisks."""
    return [state for token in TOKENS if token.line == row for state in token.states]


def asterisk_note(states: Collection[int], fields: Container[str]) -> list[str]:
    """Return a note on asterisks that the program prints and that were not read, or none.

    ``states``: the states of the printout's glyphs; ``fields``: the numbers read.
    """
    counts = []
    for row, (field, where) in _STARS.items():
        own = _asterisks(row)
        count = sum(at in states for at in own)
        if count < len(own) and field in fields:
            counts.append(f"{count} of {len(own)} {where}")
    return [f"asterisks read: {', '.join(counts)}"] if counts else []
