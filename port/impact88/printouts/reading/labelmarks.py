"""Checks of what the program prints beside its labels: signs, brackets, the words of the prompts.

A mark that was not read is missing on the paper or was lost by the page's reader; where one was
read as a glyph that no reader was seen to take for it, something else was typed. Either is
reported, and then the page is not all that the program prints. A page without a single equals sign
was retyped in another form, as a table for instance, and its marks leave no doubt. Asterisks are
only counted: of 41 readings of given pages that are exact otherwise 24 lack some, and none lacks
another mark.
"""

from collections.abc import Collection, Container, Iterator, Mapping, Sequence

from ...collision.fields import FIELDS
from .alignment import BEHIND, FIRST_STARS, PROMPTS, RETYPED_ANGLES, STARS, STATES, TOKENS, Token
from .fieldlabels import LabelCheck, LabelState
from .glyphs import Gap, Page, is_look_alike, letters

_MARKS = [
    token
    for token in TOKENS
    if token.name
    and not token.text.startswith("{")
    and (token.line < PROMPTS or not token.is_word)
    and token.line != RETYPED_ANGLES
]
"""The marks, and the words of the prompts, in the order of the page."""


def mark_checks(
    page: Page,
    states: Mapping[int, int],
    slots: Mapping[str, tuple[int, int]],
    labels: Sequence[LabelCheck],
    machine_read: bool,
) -> list[LabelCheck]:
    """Return the marks, asterisks and words of prompts that are not as the program prints them.

    Parameters
    ----------
    page : Page
    states : mapping of int to int
        State of each glyph of the printout.
    slots : mapping of str to (int, int)
        Range of glyphs of every number that was read, and of the replies.
    labels : sequence of LabelCheck
        The labels: an equals sign goes unreported where the whole label is missing, and a bracket
        where it counts as a letter of the label.
    machine_read : bool
        True for a page of an optical reader, which may take a mark for one that looks like it, lose
        asterisks, and put a mark on another line.
    """
    without_label = {check.name for check in labels if check.state is LabelState.MISSING}
    reported = {at for check in labels if check.doubt for at in range(check.start, check.stop)}
    places: dict[int, int] = {}
    for index in sorted(states):
        places.setdefault(states[index], index)
    checks: list[LabelCheck] = []
    end_of_last = 0  # of the states of the last token reported
    for token in _MARKS:
        name, text = token.name, token.text
        if name not in slots or (text == "=" and name in without_label):
            continue
        at = [places[state] for state in token.states if state in places]
        read = letters(page.glyphs[index] for index in at)
        state = _state(page, token, at, slots, machine_read)
        if state is LabelState.EXACT:
            continue
        if at and reported.issuperset(page.glyphs[index].offset for index in at):
            continue
        start = stop = _gap(page, token, places, slots)
        if at:
            start, stop = page.span(at[0], at[-1] + 1)
        if name not in FIELDS and end_of_last == token.states.start:  # words side by side
            before = checks.pop()
            text, read, start = f"{before.printed} {text}", before.read + read, before.start
            state = LabelState.DAMAGED if read else LabelState.MISSING
        if state is not LabelState.MOVED:
            end_of_last = token.states.stop
        checks.append(LabelCheck(name, text, read, state, True, *page.place(start), start, stop))
    if not machine_read:
        checks += _broken_asterisks(page, places, slots)
    signs = {page.glyphs[at].char for at, state in states.items() if STATES[state].name == "="}
    if "=" in signs:
        return checks
    return [  # retyped in another form, with colons for example
        check._replace(doubt=False)
        if check.name in FIELDS and (check.state is LabelState.MISSING or check.printed == "=")
        else check
        for check in checks
    ]


def _state(
    page: Page,
    token: Token,
    at: Sequence[int],
    slots: Mapping[str, tuple[int, int]],
    machine_read: bool,
) -> LabelState:
    """Return the state of a mark or a word, of which the glyphs ``at`` were read."""
    read = letters(page.glyphs[index] for index in at)
    if read == token.text:
        is_apart = token.text in (*BEHIND, "=") and page.glyphs[at[0]].gap is Gap.LINE
        return LabelState.MOVED if is_apart and not machine_read else LabelState.EXACT
    start, stop = slots[token.name]
    in_number = token.name in FIELDS and token.text in letters(page.glyphs[start - 1 : stop + 1])
    if in_number or (machine_read and _is_like(token.text, read)):
        return LabelState.EXACT
    return LabelState.DAMAGED if read else LabelState.MISSING


def _is_like(text: str, read: str) -> bool:
    return len(read) == len(text) and all(map(is_look_alike, text, read))


def _broken_asterisks(
    page: Page, places: Mapping[int, int], slots: Container[str]
) -> Iterator[LabelCheck]:
    """Yield a check of each row of asterisks of which some are not on the page, or another
    character stands among them."""
    for row, (field, _) in _STARS.items():
        own = _asterisks(row)
        at = [places[state] for state in own if state in places]
        read = letters(page.glyphs[index] for index in at)
        if field in slots and at and read != "*" * len(own):
            start, stop = page.span(at[0], at[-1] + 1)
            yield LabelCheck(
                field,
                "*" * len(own),
                read,
                LabelState.DAMAGED,
                True,
                *page.place(start),
                start,
                stop,
            )


def retyping_note(labels: Sequence[LabelCheck]) -> list[str]:
    """Return a note on the marks of a page that was retyped without equals signs, or none."""
    marks = [check for check in labels if check.is_mark and check.state is LabelState.MISSING]
    texts = dict.fromkeys(repr(check.printed) for check in marks if not check.doubt)
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
