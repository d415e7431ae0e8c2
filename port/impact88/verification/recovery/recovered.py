"""Recovering the scene of a printout: the one whose page explains the paper at the least cost.

A printed field says most of what an input may have been; a reply at the prompt bears it out, or
speaks where the field is lost. A clean number is not doubted here: its misreadings are `slips`'.
Inputs that nothing determines have stand-ins, and only what does not depend on them is kept for
comparison.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ...collision.case import VALUE_LIMIT
from ...collision.fields import ANGLES, FINAL_SPINS, INPUTS, scene_name
from ...names import SCENE
from ..reading.glyphs import letters
from ..reading.numerals import candidates
from ..reading.printout import Printout, Reading
from . import replays
from .search import Column, Search, column_of
from .typedtext import stored_and_printed

_STAND_INS = ("1.7", "230", "-41000", "-.4")
"""Put in place of an input that nothing determines; a field that prints the same with each of them
does not depend on it. Large values of EM print nearly alike, so one is as EM is."""
_MOST = 40
"""Texts of one input that are tried."""
_REPLY_DISAGREES = 1.0
"""What it costs that a printed number is not what the reply says, or that only a reply says it."""
_PROMPT_MARK = "7291?P"
"""What the prompt's question mark is read as."""
_UNCONVINCING = 3
"""What had to be guessed, a row of angles or a number of which no character is legible, counts as
missing when more results than this differ."""


@dataclass
class Recovered:
    """The scene a printout shows. ``scene`` holds stand-ins for the values in ``missing``;
    ``assumed`` the printed texts it goes with, by field; ``outcome`` is what the replay prints,
    without fields that depend on missing values; ``wrong`` names what it leaves unexplained;
    ``m_unknown``: whether M = 4 explains the page as well as 6 does; ``row_in_doubt``: whether the
    row of angles was not read for certain and no way to read it explains the page; ``typed``: of
    inputs that a copy of the listing converts before it prints them, what was typed."""

    scene: dict[str, str]
    assumed: dict[str, str]
    outcome: replays.Outcome
    missing: list[str]
    wrong: frozenset[str]
    search: Search
    m_unknown: bool = False
    row_in_doubt: bool = False
    typed: dict[str, str] = field(default_factory=dict)

    @property
    def apart(self) -> list[str]:
        """The inputs, by field, that are neither the page's nor missing: they were given apart."""
        known = {*self.assumed, *self.missing}
        return [name for name in INPUTS if name not in known and scene_name(name) not in known]

    def scene_or_missing(self) -> dict[str, str | None]:
        """The scene in the table's order, None for what is missing."""
        return {name: None if name in self.missing else self.scene[name] for name in SCENE}


def recover(shown: Printout, given: Mapping[str, str] | None = None) -> Recovered:
    """The scene whose page explains the printout best. ``given``: inputs known from elsewhere."""
    given = given or {}
    columns, typed, lost = _choices(shown, given)
    search = Search(shown, typed)
    best = search.best(columns)
    unconvincing = len(best.wrong) > _UNCONVINCING
    if unconvincing:  # how many characters marks for the illegible stand for nobody knows
        marks = (
            name for name, field in shown.fields.items() if set(letters(field.region)) == {"?"}
        )
        lost |= {scene_name(name) for name in marks if name in INPUTS} - set(given)
    missing = [name for name in map(scene_name, INPUTS) if name in lost]
    outcome = _independent_of(missing, best.scene, best.outcome) if missing else best.outcome
    m_unknown = not (missing or shown.has_final_spins or shown.ending)
    if m_unknown and not shown.fragment_of_run:
        # whether the other M would print the same but for the final spins
        other = replays.run_once({**best.scene, "M": "6" if best.scene["M"] == "4" else "4"})
        m_unknown = all(
            other.fields.get(name) == text
            for name, text in best.outcome.fields.items()
            if name in other.fields and name not in FINAL_SPINS
        )
    in_doubt = bool(shown.angles) and unconvincing and not lost & set(ANGLES)
    return Recovered(
        best.scene, best.assumed, outcome, missing, best.wrong, search, m_unknown, in_doubt
    )


def without_angles(recovered: Recovered) -> Recovered:
    """The same with the row of angles as missing."""
    missing = [*recovered.missing, *ANGLES]
    outcome = _independent_of(missing, recovered.scene, recovered.outcome)
    return replace(recovered, missing=missing, outcome=outcome, m_unknown=False, row_in_doubt=False)


def _independent_of(
    lost: list[str], scene: Mapping[str, str], outcome: replays.Outcome
) -> replays.Outcome:
    """The outcome's fields that are the same whatever the missing inputs are."""
    others = [{**scene, **dict.fromkeys(lost, value)} for value in _STAND_INS[1:]]
    fields = {name: text for name, text in outcome.fields.items() if scene_name(name) not in lost}
    for other in replays.run_all(others):
        fields = {name: text for name, text in fields.items() if other.fields.get(name) == text}
    return replays.Outcome(fields, None)


def _choices(
    shown: Printout, given: Mapping[str, str]
) -> tuple[list[Column], dict[str, dict[str, str]], set[str]]:
    """What each input may have been; by field, what was typed for a printed text, where a reply or
    a scene file says so; and the scene's values that nothing determines."""
    columns, typed, missing = [], {}, set()
    alone = list(INPUTS)
    if shown.angles and given.keys().isdisjoint(ANGLES):
        columns.append(Column(ANGLES, shown.angles))
        alone = [name for name in INPUTS if name not in ANGLES]
    for name in alone:
        scene = scene_name(name)
        ways, typed[name] = _ways(name, shown)
        if scene in given:
            printed = (stored_and_printed(given[scene], name in ANGLES) or ("", ""))[1]
            if name in shown.fields and printed in ways:
                ways, typed[name] = {printed: ways[printed]}, {printed: given[scene]}
            elif name not in shown.fields or not ways:
                ways, typed[name] = {given[scene]: 0.0}, {given[scene]: given[scene]}
        if not ways:
            missing.add(scene)
            ways = {_STAND_INS[0]: 0.0}
        columns.append(column_of(name, sorted(ways.items(), key=lambda way: way[1])[:_MOST]))
    ms = [("4", 0.0), ("6", 0.5 if shown.ended else 0.1)]
    if "M" in given or shown.has_final_spins:
        ms = [(given.get("M", "6"), 0.0)]
    return [*columns, column_of("M", ms, True)], typed, missing


def _ways(name: str, shown: Printout) -> tuple[dict[str, float], dict[str, str]]:
    """The texts that may be printed for an input, with what each costs; and what was typed for
    those that its reply bears out."""
    reading, reply = shown.fields.get(name), shown.replies.get(name)
    own = reading.texts(_MOST) if reading else {}
    answers = reply_ways(reply) if reply else []
    disagrees = _REPLY_DISAGREES if own and answers else 0.0
    ways = {text: cost + disagrees for text, cost in own.items()}
    typed: dict[str, str] = {}
    for answer, printed, price in sorted(answers, key=lambda way: way[2]):
        if printed not in typed:
            typed[printed] = answer
            if printed in own:
                ways[printed] += 0.3 * price - disagrees
            elif reading is None or not reading.clean:
                ways[printed] = _REPLY_DISAGREES + price + disagrees
    return ways, typed


def without_mark(reply: Reading) -> Reading | None:
    """A reply without its first glyph, where that may be the prompt's own question mark."""
    if reply.region[0].char not in _PROMPT_MARK or len(reply.region) < 2:
        return None
    return replace(reply, text=reply.text[1:], region=reply.region[1:])


def reply_ways(reply: Reading) -> list[tuple[str, str, float]]:
    """What was typed at a prompt, what it then prints, and what it costs to believe. The prompt's
    own question mark may have been read as a digit before the number."""
    ways: dict[str, float] = {}
    for way, cost in ((reply, 0.0), (without_mark(reply), 0.5)):
        if way is not None:
            texts = {way.text: 0.0} if way.clean else dict(candidates(way.region, 8))
            ways = {text: cost + price for text, price in texts.items()} | ways
    return [
        (text, seen[1], cost)
        for text, cost in ways.items()
        if len(text) <= VALUE_LIMIT and (seen := stored_and_printed(text)) is not None
    ]
