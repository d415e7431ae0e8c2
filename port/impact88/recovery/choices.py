"""What each input may have been: the texts its glyphs can be read as, and what was typed for them.

A printed field says most, a reply at the prompt bears it out or speaks where the field is lost.
What a clean number says is never doubted here; misreadings of clean digits are `explain`'s.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from ..doubles import double
from ..fields import ANGLES, INPUTS
from ..reading.numerals import candidates, value_of
from ..reading.printout import Printout, Reading
from ..scene import VALUE_LIMIT
from .misprints import opposite
from .typedtext import stored_and_printed, texts_that_print

STAND_IN = "1.7"
"""Put in place of an input nothing tells of."""
_MOST = 40
_ROWS = 400
_OTHER_BITS = 0.02
_FLIPPED = 0.001
_REPLY_DISAGREES = 1.0
_NO_FIELD = 0.8
_PROMPT_MARK = "7291?P"
"""What the prompt's question mark is read as."""


class Choice(NamedTuple):
    """One way to take an input (or the row of angles): the scene's texts, the printed texts assumed
    by field name, and what it costs to believe."""

    typed: dict[str, str]
    printed: dict[str, str]
    cost: float


Choices = list[list[Choice]]


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


def choices_of(
    shown: Printout, given: Mapping[str, str] | None = None
) -> tuple[Choices, list[str]]:
    """What each input may have been, cheapest first, and the inputs nothing tells of.

    ``given``: texts of inputs known from elsewhere (a scene file)."""
    given = given or {}
    choices: Choices = []
    missing: list[str] = []
    joint = bool(shown.angles) and not any(name in given for name in ANGLES)
    for name in INPUTS:
        scene = scene_name(name)
        if name in ANGLES and joint:
            if name == ANGLES[0]:
                rows = shown.angles[:_ROWS]
                choices.append([_row(texts, cost) for texts, cost in rows])
            continue
        if scene in given and name not in shown.fields:
            choices.append([Choice({scene: given[scene]}, {}, 0.0)])
            continue
        options = input_choices(name, shown)
        if scene in given:
            options = _given_first(options, scene, given[scene])
        if not options:
            missing.append(scene)
            options = [Choice({scene: STAND_IN}, {}, 0.0)]
        if scene == "MU":
            options = _either_sign(options)
        choices.append(options)
    choices.append([Choice({"M": text}, {}, cost) for text, cost in _ms(shown, given)])
    return choices, missing


def _given_first(options: list[Choice], name: str, text: str) -> list[Choice]:
    seen = stored_and_printed(text, name in ANGLES)
    for option in options:
        if seen and seen[1] in option.printed.values():
            return [Choice({name: text}, option.printed, option.cost)]
    return options or [Choice({name: text}, {}, 0.0)]


def _either_sign(options: list[Choice]) -> list[Choice]:
    """MU typed with either sign: line 400 may have changed it before it was printed."""
    both = []
    for option in options:
        both.append(option)
        if (other := flipped(option)) != option:
            both.append(other)
    return sorted(both, key=lambda choice: choice.cost)


def flipped(choice: Choice) -> Choice:
    """A choice of MU with the other sign typed; the same where it has none."""
    for typed in with_opposite_mu(choice.typed):
        return choice._replace(typed=typed, cost=choice.cost + _FLIPPED)
    return choice


def _ms(shown: Printout, given: Mapping[str, str]) -> list[tuple[str, float]]:
    """What M may have been: 6 where the final spins are printed, else what the results say."""
    if "M" in given:
        return [(given["M"], 0.0)]
    if shown.has_final_spins:
        return [("6", 0.0)]
    return [("4", 0.0), ("6", 0.5)] if shown.ended else [("4", 0.0), ("6", 0.1)]


def _row(texts: Sequence[str], cost: float) -> Choice:
    typed = {
        name: (texts_that_print(text, True) or (text,))[0]
        for name, text in zip(ANGLES, texts, strict=True)
    }
    return Choice(typed, dict(zip(ANGLES, texts, strict=True)), cost)


def printed_ways(reading: Reading) -> dict[str, float]:
    """The printed texts a reading may be, with what each costs."""
    if reading.clean:
        ways = dict(candidates(reading.region, 1, False))
        return ways or ({} if value_of(reading.text) is None else {reading.text: 0.0})
    return dict(candidates(reading.region, _MOST, reading.sign_free))


def input_choices(name: str, shown: Printout) -> list[Choice]:
    """What one input may have been, cheapest first; empty when nothing tells."""
    angle = name in ANGLES
    scene = scene_name(name)
    reading = shown.fields.get(name)
    reply = shown.replies.get(name)
    answers = reply_ways(reply) if reply is not None else []
    ways = printed_ways(reading) if reading is not None else {}
    choices: list[Choice] = []
    for text, cost in ways.items():
        same = [(typed, price) for typed, printed, price in answers if printed == text]
        if same:
            typed, price = min(same, key=lambda way: way[1])
            choices.append(Choice({scene: typed}, {name: text}, cost + 0.3 * price))
            continue
        texts = texts_that_print(text, angle)
        strange = 0.0 if texts else 0.7
        disagrees = _REPLY_DISAGREES if answers else 0.0
        typed = (texts or (text,))[0]
        choices.append(Choice({scene: typed}, {name: text}, cost + strange + disagrees))
    if reading is None or not reading.clean:
        known = {choice.printed.get(name) for choice in choices}
        for typed, printed, price in answers:
            if printed not in known:
                printed_too = {name: printed} if reading is not None else {}
                cost = _NO_FIELD + price + (_REPLY_DISAGREES if choices else 0.0)
                choices.append(Choice({scene: typed}, printed_too, cost))
    choices.sort(key=lambda choice: choice.cost)
    return choices[:_MOST]


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
    ways = {reply.text: 0.0} if reply.clean else dict(candidates(reply.region, 8))
    rest = without_mark(reply)
    if rest is not None:
        others = {rest.text: 0.0} if rest.clean else dict(candidates(rest.region, 8))
        for text, cost in others.items():
            ways.setdefault(text, cost + 0.5)
    readings = []
    for text, cost in ways.items():
        seen = stored_and_printed(text)
        if seen is not None and len(text) <= VALUE_LIMIT:
            readings.append((text, seen[1], cost))
    return readings


def other_bits(scene: Mapping[str, str], assumed: Mapping[str, str]) -> Choices:
    """For each input of a scene the texts that print the same and enter with other bits."""
    choices: Choices = []
    for name, typed in scene.items():
        texts = [typed]
        field = "MUP" if name == "MU" else name
        printed = assumed.get(field)
        if printed is not None and name != "M":
            others = list(texts_that_print(printed, name in ANGLES))
            if name == "MU" and mu_turned(typed, printed):
                others = [opposite(text) for text in others]
            seen = stored_and_printed(typed, name in ANGLES)
            for text in others:
                if seen and (stored_and_printed(text, name in ANGLES) or seen)[0] != seen[0]:
                    texts.append(text)
        choices.append(
            [Choice({name: text}, {}, _OTHER_BITS * rank) for rank, text in enumerate(texts)]
        )
    return choices
