"""What each input may have been: the texts its glyphs can be read as, and what was typed for them.

A printed field says most, a reply at the prompt bears it out or speaks where the field is lost.
What a clean number says is not doubted here; misreadings of clean digits are `rereading`'s.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from ..doubles import double
from ..fields import ANGLES, INPUTS
from ..reading.numerals import candidates, value_of
from ..reading.printout import Printout, Reading
from ..scene import VALUE_LIMIT
from .misprints import opposite
from .typedtext import stored_and_printed

STAND_IN = "1.7"
"""Put in place of an input nothing tells of."""
_MOST, _ROWS = 40, 400
"""Texts of one input, and cuts of the row of angles, that are tried."""
_REPLY_DISAGREES = 1.0
_NO_FIELD = 0.8
"""What it costs that a printed number is not what the reply says, and that only a reply says it."""
_PROMPT_MARK = "7291?P"
"""What the prompt's question mark is read as."""


class Column(NamedTuple):
    """What an input, or the row of angles, may be: the fields, and the texts that may be printed
    for them (``typed``: that may have been typed), each with what it costs, cheapest first."""

    names: tuple[str, ...]
    options: list[tuple[tuple[str, ...], float]]
    typed: bool = False


class Choices(NamedTuple):
    """What each input may have been; ``typed``: by field, what was typed for a printed text, where
    a reply or a scene file says so; ``missing``: the scene's values nothing tells of."""

    columns: list[Column]
    typed: dict[str, dict[str, str]]
    missing: list[str]


def scene_name(name: str) -> str:
    """The scene's value a printed input stands for."""
    return "MU" if name == "MUP" else name


def with_opposite_mu(scene: Mapping[str, str]) -> Iterator[dict[str, str]]:
    """The scene with MU typed with the other sign; none where MU has no sign."""
    if double(scene["MU"] or "0"):
        yield {**scene, "MU": opposite(scene["MU"])}


def mu_turned(typed: str, printed: str) -> bool:
    """Whether line 400 gave MU the other sign than it was typed with."""
    return (double(typed) < 0) != printed.startswith("-")


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
