"""Recovering the scene of a printout, and comparing the printout with its replay.

M comes from the presence of the final WA, WB line; MU's sign before line 400 from trying both; what
was typed from what was printed (`typedtext`); an illegible character from trying all it can be. The
scene whose replay agrees with most of the printout is taken.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from .. import names
from ..fields import ANGLES, FIELDS, FINAL_SPINS, INPUTS
from . import trial
from .glyphs import ILLEGIBLE
from .printout import Printout, Reading
from .typedtext import stored_and_printed, texts_that_print

MOST_CANDIDATES = 20_000
"""Scenes tried at most for one printout; more illegible characters than that allows count as a
missing value."""

_GUESS_MAY_DIFFER = 3
"""A row of angles that had to be cut without blanks counts as missing when no cut makes the
printout agree but for this many differences."""
_STAND_INS = ("1.7", "230", "-41000")
"""Values put in place of a missing input: a field that prints the same with each of them does not
depend on it."""


@dataclass
class Recovered:
    """The scene a printout shows. ``scene`` holds stand-ins for the values in ``missing``;
    ``assumed`` the printed texts it goes with, where there was a choice;
    ``outcome`` is what the replay prints, without fields that depend on them. ``fits`` lists, for
    each illegible input, the printed texts that agree best. ``differences`` counts fields, replies
    and ending that disagree."""

    scene: dict[str, str]
    assumed: dict[str, str]
    outcome: trial.Outcome
    missing: list[str]
    fits: dict[str, list[str]]
    m_unknown: bool
    differences: int

    def scene_or_missing(self) -> dict[str, str | None]:
        """The scene in the table's order, None for what is missing."""
        return {name: None if name in self.missing else self.scene[name] for name in names.SCENE}


def recover(shown: Printout) -> Recovered:
    """The scene whose replay agrees with most of the printout."""
    recovered = _recover(shown)
    if shown.angles_guessed and recovered.differences > _GUESS_MAY_DIFFER:
        without = {name: one for name, one in shown.fields.items() if name not in ANGLES}
        return _recover(replace(shown, fields=without, angles=[]))
    return recovered


def _recover(shown: Printout) -> Recovered:
    choices, missing = _choices(shown)
    scenes = list(_scenes(choices))
    outcomes = trial.run_all([scene for scene, _ in scenes])
    scores = [
        len(disagreeing(shown, scene, printed, outcome))
        for (scene, printed), outcome in zip(scenes, outcomes, strict=True)
    ]
    best = min(scores)
    equal = [index for index, score in enumerate(scores) if score == best]
    scene, printed = scenes[equal[0]]
    outcome = outcomes[equal[0]]
    fits: dict[str, list[str]] = {}
    for name, reading in shown.fields.items():
        if name in INPUTS and not reading.legible and _scene_name(name) not in missing:
            texts = [scenes[index][1].get(name, "") for index in equal]
            fits[name] = list(dict.fromkeys(texts))
    if missing:
        outcome = _independent_of(missing, scene, outcome)
    return Recovered(
        scene=scene,
        assumed=printed,
        outcome=outcome,
        missing=missing,
        fits=fits,
        m_unknown=len({scenes[index][0]["M"] for index in equal}) > 1,
        differences=best,
    )


def _scene_name(name: str) -> str:
    """The scene's value a printed input stands for."""
    return "MU" if name == "MUP" else name


Choice = tuple[dict[str, str], dict[str, str]]
"""Scene values by scene name, and the printed texts assumed, by field name."""


def _choices(shown: Printout) -> tuple[list[list[Choice]], list[str]]:
    """What each input (or the five angles together) may have been, likeliest first."""
    choices: list[list[Choice]] = []
    missing = []
    room = MOST_CANDIDATES // 4  # MU's sign and M may take four
    for name in INPUTS:
        if name in ANGLES[1:] and shown.angles:
            continue
        if name == ANGLES[0] and shown.angles:
            rows = [tuple(shown.fields[angle].text for angle in ANGLES), *shown.angles]
            choices.append([_angle_choice(row) for row in rows[: max(1, room)]])
            continue
        ways = _ways(name, shown, room)
        room //= max(1, len(ways))
        if not ways:
            missing.append(_scene_name(name))
            ways = [({_scene_name(name): _STAND_INS[0]}, {})]
        choices.append(ways)
    choices.append([({"M": text}, {}) for text in _ms(shown)])
    return choices, missing


def _angle_choice(row: Sequence[str]) -> Choice:
    texts = {
        name: (texts_that_print(text, True) or (text,))[0]
        for name, text in zip(ANGLES, row, strict=True)
    }
    return texts, dict(zip(ANGLES, row, strict=True))


def _ms(shown: Printout) -> list[str]:
    if shown.has_final_spins:
        return ["6"]
    return ["4"] if shown.ended else ["6", "4"]


def _ways(name: str, shown: Printout, room: int) -> list[Choice]:
    """What one input may have been; empty when nothing tells."""
    angle = name in ANGLES
    ways: list[Choice] = []
    reading = shown.fields.get(name)
    reply = shown.replies.get(name)
    printed: list[str] = []
    if reading is not None:
        printed = [reading.text, *reading.alternatives] if reading.legible else []
        if not reading.legible and any(map(str.isdigit, reading.text)):
            printed = illegible_texts(reading.text, room, angle)
    if reply is not None and reply.legible:
        seen = stored_and_printed(reply.text)
        agrees = seen is not None and seen[1] in printed
        ways.append(({name: reply.text}, {name: seen[1]} if seen and agrees else {}))
        if agrees or reading is None:
            return ways
    for text in printed:
        for typed in typed_texts(name, text):
            ways.append(({_scene_name(name): typed}, {name: text}))
    return ways[: max(1, room)]


def typed_texts(name: str, printed: str) -> list[str]:
    """What may have been typed where a field prints ``printed``; for MU either sign."""
    texts = list(texts_that_print(printed, name in ANGLES) or (printed,))
    if name == "MUP":
        texts += [opposite(text) for text in texts if text != "0"]
    return texts


def opposite(text: str) -> str:
    """A number with the other sign."""
    return text[1:] if text.startswith("-") else "-" + text


def illegible_texts(text: str, most: int, angle: bool) -> list[str]:
    """The printable texts that ``text`` may be, each ``?`` a digit, a point or (first) a sign;
    empty when there are more than ``most``."""
    places = [index for index, glyph in enumerate(text) if glyph == ILLEGIBLE]
    if 10 ** len(places) > 2 * most:
        return []
    options = [
        "0123456789" + ("-" if place == 0 else "") + ("" if "." in text else ".")
        for place in places
    ]
    found = []
    for glyphs in itertools.product(*options):
        letters = list(text)
        for place, glyph in zip(places, glyphs, strict=True):
            letters[place] = glyph
        candidate = "".join(letters)
        if printable(candidate) and texts_that_print(candidate, angle):
            found.append(candidate)
    return found if len(found) <= most else []


_PRINTABLE = re.compile(r"-?(?:0|[1-9][0-9]*|(?=[.]))(?:[.][0-9]*[1-9])?(?:E[+-][0-9]{2})?")


def printable(text: str) -> bool:
    """Whether Applesoft could have written ``text``, by its form."""
    return _PRINTABLE.fullmatch(text) is not None and text not in ("", "-", "-0")


def _scenes(choices: list[list[Choice]]) -> Iterator[Choice]:
    """Every combination, those of the likeliest choices first, up to the limit."""
    combinations = sorted(
        itertools.islice(
            itertools.product(*(range(len(ways)) for ways in choices)), MOST_CANDIDATES
        ),
        key=sum,
    )
    for picks in combinations:
        scene: dict[str, str] = {}
        printed: dict[str, str] = {}
        for ways, pick in zip(choices, picks, strict=True):
            scene.update(ways[pick][0])
            printed.update(ways[pick][1])
        yield scene, printed


def _independent_of(
    missing: list[str], scene: Mapping[str, str], outcome: trial.Outcome
) -> trial.Outcome:
    """The outcome's fields that are the same whatever the missing inputs are."""
    others = [{**scene, **dict.fromkeys(missing, value)} for value in _STAND_INS[1:]]
    fields = dict(outcome.fields)
    for other in trial.run_all(others):
        fields = {name: text for name, text in fields.items() if other.fields.get(name) == text}
    for name in missing:
        fields.pop("MUP" if name == "MU" else name, None)
    return trial.Outcome(fields, None)


# --- comparing -----------------------------------------------------------------------------------


@dataclass
class FieldCheck:
    """One printed field against the replay. ``same`` is None where there is nothing to compare:
    not read, not fully legible, or dependent on a missing input. ``exact`` is what exact
    arithmetic gives, ``difference`` printed less exact, in full precision."""

    name: str
    printed: str | None
    recomputed: str | None
    same: bool | None
    exact: str | None = None
    difference: str | None = None


def fits(reading: Reading, text: str) -> bool:
    """Whether a reading, legible or in part, can be ``text``."""
    if reading.cut and text.startswith(reading.text):
        return True
    if reading.legible:
        return text == reading.text or text in reading.alternatives
    pattern = "".join("." if glyph == ILLEGIBLE else re.escape(glyph) for glyph in reading.text)
    return re.fullmatch(pattern, text) is not None


def disagreeing(
    shown: Printout,
    scene: Mapping[str, str],
    assumed: Mapping[str, str],
    outcome: trial.Outcome,
) -> list[str]:
    """The fields, replies (``reply UX``) and ``ENDING`` in which printout and outcome disagree.

    A field in ``assumed`` counts as having that text."""
    found = []
    for name, reading in shown.fields.items():
        text = outcome.fields.get(name)
        if name in assumed:
            if text != assumed[name]:
                found.append(name)
        elif text is None or not fits(reading, text):
            found.append(name)
    found += [
        f"reply {name}"
        for name, reading in shown.replies.items()
        if not same_value(reading.text, scene[name])
    ]
    if shown.ending is not None and shown.ending != outcome.ending:
        found.append("ENDING")
    return found


def same_value(one: str, other: str) -> bool:
    """Whether two typed texts are the same real."""
    seen, expected = stored_and_printed(one), stored_and_printed(other)
    return seen is not None and expected is not None and seen[0] == expected[0]


def field_checks(shown: Printout, recovered: Recovered) -> list[FieldCheck]:
    """Every field that is printed or should be, in the order of the printout."""
    outcome = recovered.outcome
    checks = []
    for name in FIELDS:
        reading = shown.fields.get(name)
        text = outcome.fields.get(name)
        if reading is None and text is None:
            expected = recovered.missing and not shown.ending
            if not expected or (name in FINAL_SPINS and recovered.scene["M"] != "6"):
                continue
        same: bool | None = None
        if reading is not None and text is not None:
            same = fits(reading, text)
            if same and not (reading.legible and text in (reading.text, *reading.alternatives)):
                same = None
        elif reading is not None and not recovered.missing:
            same = False
        printed = reading.text if reading else None
        if reading is not None and text in reading.alternatives:
            printed = text
        checks.append(FieldCheck(name, printed, text, same))
    if shown.angles and ANGLES[0] not in recovered.missing:
        for check in checks:
            if check.name in ANGLES:
                check.printed, check.same = _angle_as_cut(shown, recovered, check)
    return checks


def _angle_as_cut(
    shown: Printout, recovered: Recovered, check: FieldCheck
) -> tuple[str | None, bool | None]:
    """The printed text of an angle under the cut of the row that was taken."""
    rows = [tuple(shown.fields[angle].text for angle in ANGLES), *shown.angles]
    column = ANGLES.index(check.name)
    taken = tuple(recovered.outcome.fields.get(angle) for angle in ANGLES)
    row = taken if taken in rows else rows[0]
    return row[column], row[column] == check.recomputed


def reply_checks(shown: Printout, recovered: Recovered) -> list[FieldCheck]:
    """The replies shown at the prompts against the velocities of the scene, as numbers."""
    checks = []
    for name, reading in shown.replies.items():
        value = recovered.scene.get(name)
        same = None
        if reading.legible and value is not None:
            same = same_value(reading.text, value)
        checks.append(FieldCheck(name, reading.text, value, same))
    return checks


def ending_check(shown: Printout, recovered: Recovered) -> FieldCheck:
    """How the printout ends against how the replay does."""
    recomputed = recovered.outcome.ending
    same: bool | None = shown.ending == recomputed
    if recovered.missing:
        same = None if shown.ending else True
    elif shown.ending is None and recomputed is not None:
        # cut off before the message, unless the printout goes on past it: then fields differ
        same = None
    return FieldCheck("ENDING", shown.ending, recomputed, same)


def illegible(shown: Printout, recovered: Recovered) -> list[dict[str, Any]]:
    """For each field with illegible characters the texts that fit."""
    found = []
    for name, reading in shown.fields.items():
        if reading.legible:
            continue
        texts = recovered.fits.get(name)
        if texts is None:
            text = recovered.outcome.fields.get(name)
            texts = [text] if text is not None and fits(reading, text) else []
        found.append({"name": name, "printed": reading.text, "fits": texts})
    return found
