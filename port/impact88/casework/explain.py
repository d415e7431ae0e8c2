"""Explaining a printout that differs: causes, each tested by replay, best first.

A cause is a change of one printed number (`misreading`), of MU's sign or of M, another arithmetic,
or rounding where the program floors. A misread input is put right, the scene replayed, and the
whole printout compared anew: what counts is how many of the differing fields then agree, and that
no other stops agreeing. A misread output explains the one field it is in.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_FLOOR, Decimal
from typing import Any, NamedTuple

from ..fields import ANGLES, FIELDS, INPUTS
from . import misreading, trial
from .printout import Printout
from .recovery import FieldCheck, Recovered, disagreeing, fits, opposite, printable, same_value
from .typedtext import stored_and_printed, texts_that_print

MOST = 8
"""Explanations given at most."""

_BY_CHANCE = 4
"""An explanation of this many times fewer fields than the best is left out."""

MU_SIGN = "sign of MU"
POINT_MASS = "M = 4 with DA, DB left"
OTHER_M = "M misjudged"
DOUBLE = "IEEE double arithmetic"
ROUNDED = "rounded, not floored"
DOUBLE_ROUNDED = "IEEE double arithmetic, rounded, not floored"

_RANK = (
    misreading.DIGIT,
    misreading.SIGN,
    MU_SIGN,
    misreading.POINT,
    misreading.SWAP,
    OTHER_M,
    POINT_MASS,
    DOUBLE,
    ROUNDED,
    DOUBLE_ROUNDED,
    misreading.COUNT,
)
_NOT_APPLESOFT = "then this program on an Apple II did not print it"
_FLOAT64 = f"float64 prints so; {_NOT_APPLESOFT}"


@dataclass
class Explanation:
    """A cause that would make printed and recomputed agree in ``explains`` of the differing fields
    and leaves ``remaining`` differences; ``field`` and the two texts where one field is to blame.
    ``alone``: the field explains itself, nothing else changes.
    """

    kind: str
    field: str | None
    printed: str | None
    would_be: str | None
    explains: int
    remaining: int
    note: str = ""
    alone: bool = False


class _Trial(NamedTuple):
    """A cause to be tested: the scene it means, and the printed text it assumes for its field."""

    kind: str
    field: str
    printed: str
    would_be: str
    scene: dict[str, str]


def explain(
    shown: Printout,
    recovered: Recovered,
    checks: Sequence[FieldCheck],
    replies: Sequence[FieldCheck],
    ending: FieldCheck,
) -> list[Explanation]:
    """Causes that make more of a differing printout agree, those that explain most first."""
    differing = [check for check in checks if check.same is False]
    differing_replies = [check for check in replies if check.same is False]
    base = {check.name for check in differing}
    base |= {f"reply {check.name}" for check in differing_replies}
    if ending.same is False:
        base.add(ending.name)
    found = list(_misread_alone(differing, differing_replies))
    if not recovered.missing:
        found += _misread_inputs(shown, recovered, base)
        found += _other_runs(shown, recovered, base)
    for one in found:
        if one.remaining < 0:
            one.remaining = len(base) - one.explains
    found = [one for one in found if one.explains > 0 and one.remaining < len(base)]
    found.sort(key=_rank)
    # among thousands of trials some hit a field by chance: far less than the best is no cause
    least = found[0].explains / _BY_CHANCE if found else 0
    found = [one for one in found if one.explains >= least]
    # a field that explains itself is found again among the misread inputs
    once = {(one.kind, one.field, one.would_be): one for one in reversed(found)}
    return [one for one in found if once[one.kind, one.field, one.would_be] is one][:MOST]


def _rank(one: Explanation) -> tuple[int, ...]:
    """What leaves least unexplained first. Of equals, a cause that fixes every digit of the page at
    once (another arithmetic) before a slip that could have gone many ways."""
    alike = misreading.likeness(one.printed, one.would_be) if one.printed and one.would_be else 4
    order = 0 if one.field is None else 1 if one.alone else 2
    return one.remaining, order, _RANK.index(one.kind), alike


def _misread_alone(
    differing: Sequence[FieldCheck], replies: Sequence[FieldCheck]
) -> Iterator[Explanation]:
    """Fields that are one slip away from what they should be: each explains itself."""
    checks = [(check, "") for check in differing]
    checks += [(check, "in the typed reply") for check in replies]
    for check, note in checks:
        if check.printed is None or check.recomputed is None:
            continue
        kind = misreading.slip(check.printed, check.recomputed)
        if kind:
            yield Explanation(kind, check.name, check.printed, check.recomputed, 1, -1, note, True)


def _misread_inputs(shown: Printout, recovered: Recovered, base: set[str]) -> list[Explanation]:
    """Every slip in every input, put right and replayed."""
    printed = {
        name: recovered.assumed.get(name, reading.text)
        for name, reading in shown.fields.items()
        if name in INPUTS
    }
    trials = [one for name, text in printed.items() for one in _trials(name, text, recovered.scene)]
    if not trials:
        return []
    found, typed_mu = _tested(shown, base, trials)
    # line 400 flips MU by the geometry, so another input may mean that MU was typed the other way
    mu = opposite(printed.get("MUP", ""))
    flipped = [
        one._replace(scene={**one.scene, "MU": opposite(one.scene["MU"])})
        for one, text in zip(trials, typed_mu, strict=True)
        if text == mu and one.field != "MUP"
    ]
    if flipped:
        found += _tested(shown, base, flipped)[0]
    return found


def _tested(
    shown: Printout, base: set[str], trials: Sequence[_Trial]
) -> tuple[list[Explanation], list[str]]:
    """The trials, each with what it explains and what it leaves; and the MU each prints.

    An input prints as it is assumed to, or the trial had not been made; so only what is computed is
    compared, and of the inputs those that did not print back as shown."""
    import numpy as np

    names = [name for name in shown.fields if name not in INPUTS or name == "MUP"]
    endings, columns = trial.run_columns([one.scene for one in trials], [*names, "MUP"])
    would_be = {name: [one.field == name for one in trials] for name in base & {*INPUTS}}
    left = np.zeros(len(trials), int)
    explained = np.zeros(len(trials), int)

    def count(name: str, agrees: Any) -> None:
        nonlocal left, explained
        left += ~agrees
        if name in base:
            explained += agrees

    for name in names:
        reading = shown.fields[name]
        if name == "MUP":
            assumed = [one.would_be if one.field == name else reading.text for one in trials]
            agrees = columns[name] == np.array(assumed)
        elif reading.legible and not reading.alternatives and not reading.cut:
            agrees = columns[name] == reading.text
        else:
            agrees = np.array([fits(reading, text) for text in columns[name].tolist()])
        count(name, agrees)
    for name, itself in would_be.items():
        if name != "MUP":
            count(name, np.array(itself))
    for name, reading in shown.replies.items():
        same = [same_value(reading.text, one.scene[name]) for one in trials]
        count(f"reply {name}", np.array(same))
    if shown.ending is not None:
        count("ENDING", np.array(endings) == shown.ending)
    found = [
        Explanation(one.kind, one.field, one.printed, one.would_be, explains, remains)
        for one, explains, remains in zip(trials, explained.tolist(), left.tolist(), strict=True)
        if explains
    ]
    return found, columns["MUP"].tolist()


def _trials(name: str, text: str, scene: Mapping[str, str]) -> Iterator[_Trial]:
    """The scenes that one slip in an input would mean."""
    for kind, other in misreading.misreadings(text):
        if not printable(other):
            continue
        if name == "MUP":
            kind = MU_SIGN if kind == misreading.SIGN else kind
            for typed in (other, opposite(other)):
                yield _Trial(kind, name, text, other, {**scene, "MU": typed})
            continue
        text_typed = _typed(other, name in ANGLES)
        if text_typed is not None:
            yield _Trial(kind, name, text, other, {**scene, name: text_typed})


def _typed(printed: str, angle: bool) -> str | None:
    """What was typed where this is printed; None when nothing prints so."""
    if len(printed.lstrip("-").replace(".", "")) < 7 and not angle:
        seen = stored_and_printed(printed)
        if seen is not None and seen[1] == printed:
            return printed
    texts = texts_that_print(printed, angle)
    return texts[0] if texts else None


def _other_runs(shown: Printout, recovered: Recovered, base: set[str]) -> Iterator[Explanation]:
    """Other values of M, another arithmetic, rounding."""
    scene = recovered.scene

    def tested(
        kind: str, run: Mapping[str, str], outcome: trial.Outcome, note: str = "", m: str = ""
    ) -> Explanation:
        left = disagreeing(shown, run, recovered.assumed, outcome)
        explains = len(base.difference(left))
        if m:
            return Explanation(kind, "M", scene["M"], m, explains, len(left), note)
        return Explanation(kind, None, None, None, explains, len(left), note)

    other = "4" if scene["M"] == "6" else "6"
    run = {**scene, "M": other}
    yield tested(OTHER_M, run, trial.run_once(run), m=other)
    if any(float(scene[name] or 0) for name in ("DA", "DB")):
        run = {**scene, "M": "4", "DA": "0", "DB": "0"}
        outcome = trial.run_once(run)
        for name in ("DA", "DB"):
            if name in outcome.fields and name in shown.fields:
                outcome.fields[name] = shown.fields[name].text
        note = "as if computed with DA = DB = 0, though the printout shows others"
        yield tested(POINT_MASS, run, outcome, note)
    for run in _as_typed(shown, recovered):
        outcome, values = trial.run_whole(run, "float64")
        yield tested(DOUBLE, run, outcome, _FLOAT64)
        yield tested(DOUBLE_ROUNDED, run, _rounded(outcome, values), _FLOAT64)
    outcome, values = trial.run_whole(scene)
    yield tested(ROUNDED, scene, _rounded(outcome, values), _NOT_APPLESOFT)


def _as_typed(shown: Printout, recovered: Recovered) -> Iterator[dict[str, str]]:
    """The scene as another arithmetic would have been given it: the printed numbers themselves."""
    texts = {
        name: recovered.assumed.get(name, reading.text)
        for name, reading in shown.fields.items()
        if name in INPUTS and reading.legible
    }
    mu = texts.pop("MUP", None)
    scene = {**recovered.scene, **texts}
    yield scene
    if mu is not None and mu != "0":
        yield {**scene, "MU": opposite(scene["MU"])}


def _rounded(outcome: trial.Outcome, values: Mapping[str, float]) -> trial.Outcome:
    """The outcome with the floored fields as rounding to the same places would print them."""
    rounded = {
        name: rounded_text(value, FIELDS[name].places or 0) for name, value in values.items()
    }
    return trial.Outcome({**outcome.fields, **rounded}, outcome.ending)


def rounded_text(value: float, places: int) -> str:
    """A value rounded to so many decimals, halves upward, as Applesoft writes numbers."""
    half = Decimal(5).scaleb(-places - 1)
    quantum = Decimal(1).scaleb(-places)
    text = f"{(Decimal(value) + half).quantize(quantum, rounding=ROUND_FLOOR):f}"
    sign = "-" if text.startswith("-") and text.strip("-0.") else ""
    text = text.lstrip("-")
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return sign + (text.removeprefix("0") or "0")
