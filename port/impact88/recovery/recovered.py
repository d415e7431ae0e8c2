"""Recovering the scene of a printout: the one whose page explains the paper at the least cost.

A printed field says most of what an input may have been; a reply at the prompt bears it out, or
speaks where the field is lost. A clean number is not doubted here: its misreadings are `slips`'.
Inputs that nothing determines have stand-ins, and only what does not depend on them is kept for
comparison.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

from ..fields import ANGLES, INPUTS, scene_name
from ..names import SCENE
from ..reading.glyphs import ILLEGIBLE
from ..reading.numerals import candidates, value_of
from ..reading.printout import Printout, Reading
from ..scene import VALUE_LIMIT
from . import replays
from .search import Column, Scored, Search
from .typedtext import stored_and_printed

STAND_IN = "1.7"
"""Put in place of an input that nothing determines."""
_MOST, _ROWS = 40, 400
"""Texts of one input, and cuts of the row of angles, that are tried."""
_REPLY_DISAGREES = 1.0
_NO_FIELD = 0.8
"""What it costs that a printed number is not what the reply says, and that only a reply says it."""
_PROMPT_MARK = "7291?P"
"""What the prompt's question mark is read as."""
_STAND_INS = ("230", "-41000")
"""Values put in place of a missing input, besides the first: a field that prints the same with each
of them does not depend on it."""
_UNCONVINCING = 3
"""What had to be guessed, a row of angles or a number of which no character is legible, counts as
missing when more results than this differ."""


@dataclass
class Recovered:
    """The scene a printout shows. ``scene`` holds stand-ins for the values in ``missing``;
    ``assumed`` the printed texts it goes with, by field; ``outcome`` is what the replay prints,
    without fields that depend on missing values; ``wrong`` names what it leaves unexplained;
    ``m_unknown``: whether M = 4 explains the page as well as 6 does; ``row_in_doubt``: whether the
    row of angles was not read for certain and no way to read it explains the page."""

    scene: dict[str, str]
    assumed: dict[str, str]
    outcome: replays.Outcome
    missing: list[str]
    wrong: frozenset[str]
    search: Search
    m_unknown: bool = False
    row_in_doubt: bool = False

    @property
    def apart(self) -> list[str]:
        """The inputs, by field, that are neither the page's nor missing: they were given apart."""
        return [
            name
            for name in INPUTS
            if name not in self.assumed and scene_name(name) not in self.missing
        ]

    def scene_or_missing(self) -> dict[str, str | None]:
        """The scene in the table's order, None for what is missing."""
        return {name: None if name in self.missing else self.scene[name] for name in SCENE}


def recover(shown: Printout, given: Mapping[str, str] | None = None) -> Recovered:
    """The scene whose page explains the printout best. ``given``: inputs known from elsewhere."""
    choices = choices_of(shown, given)
    search = Search(shown, choices.typed)
    best = search.best(choices.columns)
    lost = set(choices.missing)
    unconvincing = len(best.wrong) > _UNCONVINCING
    if unconvincing:  # how many characters marks for the illegible stand for nobody knows
        lost |= {
            scene_name(name)
            for name in set(INPUTS) & set(shown.fields)
            if all(glyph.char == ILLEGIBLE for glyph in shown.fields[name].region)
        } - set(given or ())
    missing = [name for name in map(scene_name, INPUTS) if name in lost]
    outcome = _independent_of(missing, best.scene, best.outcome) if missing else best.outcome
    return Recovered(
        best.scene,
        best.assumed,
        outcome,
        missing,
        best.wrong,
        search,
        not missing and _other_m_explains(shown, best),
        bool(shown.angles) and unconvincing and not lost & set(ANGLES),
    )


def without_angles(recovered: Recovered) -> Recovered:
    """The same with the row of angles as missing."""
    missing = [*recovered.missing, *ANGLES]
    outcome = _independent_of(missing, recovered.scene, recovered.outcome)
    return replace(recovered, missing=missing, outcome=outcome, m_unknown=False, row_in_doubt=False)


def _other_m_explains(shown: Printout, best: Scored) -> bool:
    """Whether the other M would print the same but for the final spins."""
    if shown.has_final_spins or shown.ending:
        return False
    if not any(name in shown.fields for name in ("VAX", "VAY", "VBX", "VBY")):
        return True
    scene = {**best.scene, "M": "6" if best.scene["M"] == "4" else "4"}
    fields = replays.run_once(scene).fields
    return all(
        fields.get(name) == text
        for name, text in best.outcome.fields.items()
        if name in fields and not name.startswith(("WAF", "WBF"))
    )


def _independent_of(
    missing: list[str], scene: Mapping[str, str], outcome: replays.Outcome
) -> replays.Outcome:
    """The outcome's fields that are the same whatever the missing inputs are."""
    others = [{**scene, **dict.fromkeys(missing, value)} for value in _STAND_INS]
    fields = dict(outcome.fields)
    for other in replays.run_all(others):
        fields = {name: text for name, text in fields.items() if other.fields.get(name) == text}
    for name in missing:
        fields.pop("MUP" if name == "MU" else name, None)
    return replays.Outcome(fields, None)


# --- what each input may have been ---------------------------------------------------------------


class Choices(NamedTuple):
    """What each input may have been; ``typed``: by field, what was typed for a printed text, where
    a reply or a scene file says so; ``missing``: the scene's values that nothing determines."""

    columns: list[Column]
    typed: dict[str, dict[str, str]]
    missing: list[str]


def choices_of(shown: Printout, given: Mapping[str, str] | None = None) -> Choices:
    """What each input may have been. ``given``: texts of inputs known from elsewhere (a scene
    file)."""
    given = given or {}
    choices = Choices([], {}, [])
    joint = bool(shown.angles) and not any(name in given for name in ANGLES)
    if joint:
        choices.columns.append(Column(ANGLES, shown.angles[:_ROWS]))
    for name in INPUTS:
        if name in ANGLES and joint:
            continue
        scene = scene_name(name)
        ways, typed = _ways(name, shown)
        if scene in given:
            printed = (stored_and_printed(given[scene], name in ANGLES) or ("", ""))[1]
            if name in shown.fields and printed in ways:
                ways, typed = {printed: ways[printed]}, {printed: given[scene]}
            elif name not in shown.fields or not ways:
                ways, typed = {given[scene]: 0.0}, {given[scene]: given[scene]}
        if not ways:
            choices.missing.append(scene)
            ways = {STAND_IN: 0.0}
        options = sorted(ways.items(), key=lambda way: way[1])[:_MOST]
        choices.columns.append(Column((name,), [((text,), cost) for text, cost in options]))
        choices.typed[name] = typed
    if "M" in given:
        ms = {given["M"]: 0.0}
    else:
        ms = {"6": 0.0} if shown.has_final_spins else {"4": 0.0, "6": 0.5 if shown.ended else 0.1}
    choices.columns.append(Column(("M",), [((text,), cost) for text, cost in ms.items()], True))
    return choices


def _ways(name: str, shown: Printout) -> tuple[dict[str, float], dict[str, str]]:
    """The texts that may be printed for an input, with what each costs; and what was typed for
    those that its reply bears out."""
    reading, reply = shown.fields.get(name), shown.replies.get(name)
    answers = reply_ways(reply) if reply is not None else []
    ways = dict(candidates(reading.region, _MOST, reading.sign_free)) if reading else {}
    if reading and reading.clean:
        ways = dict([*ways.items()][:1])
        if not ways and value_of(reading.text) is not None:
            ways = {reading.text: 0.0}
    own = frozenset(ways)
    typed: dict[str, str] = {}
    for text in own if answers else ():
        ways[text] += _REPLY_DISAGREES
    for answer, printed, price in sorted(answers, key=lambda way: way[2]):
        if printed in typed:
            continue
        if printed in own:
            ways[printed] += 0.3 * price - _REPLY_DISAGREES
        elif reading is None or not reading.clean:
            ways[printed] = _NO_FIELD + price + (_REPLY_DISAGREES if own else 0.0)
        typed[printed] = answer
    return ways, typed


def without_mark(reply: Reading) -> Reading | None:
    """A reply without its first glyph, where that may be the prompt's own question mark."""
    if reply.region[0].char not in _PROMPT_MARK or len(reply.region) < 2:
        return None
    return Reading(
        reply.text[1:], reply.line, reply.column, reply.start, reply.stop, reply.region[1:]
    )


def reply_ways(reply: Reading) -> list[tuple[str, str, float]]:
    """What was typed at a prompt, what it then prints, and what it costs to believe. The prompt's
    own question mark may have been read as a digit before the number."""
    ways: dict[str, float] = {}
    for one, cost in ((reply, 0.0), (without_mark(reply), 0.5)):
        if one is not None:
            texts = {one.text: 0.0} if one.clean else dict(candidates(one.region, 8))
            for text, price in texts.items():
                ways.setdefault(text, cost + price)
    return [
        (text, seen[1], cost)
        for text, cost in ways.items()
        if len(text) <= VALUE_LIMIT and (seen := stored_and_printed(text)) is not None
    ]
