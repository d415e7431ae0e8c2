"""What a page cannot show: inputs that nothing else printed on it depends on.

A misreading of such an input leaves a page that agrees with itself, so no verdict covers it. With
M = 4 that is a third of all inputs. Angles that enter only as a sum are told together, and single
digits that are too small to show, most often an inertia's last.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from ..doubles import double
from ..fields import ANGLES, FIELDS, INPUTS
from ..reading.numerals import printable
from ..recovery import replays
from ..recovery.choices import mu_turned, scene_name
from ..recovery.misprints import opposite

_SUMS = (("PA", "TA"), ("PB", "TB"))
_STEP = 7
_ANGLE_STEPS = ("11", "-23")
_LAST_PLACES = 2.0
_DEPENDENT = tuple(name for name in FIELDS if name not in INPUTS or name == "MUP")
"""What is printed that other inputs than itself may change: MU's sign is chosen."""


def unseen(scene: Mapping[str, str | None], missing: list[str]) -> list[str]:
    """What the results printed for a scene do not depend on, one sentence each; nothing when the
    scene is not complete."""
    if missing or any(text is None for text in scene.values()):
        return []
    base = {name: text or "0" for name, text in scene.items()}
    tried: list[tuple[str, dict[str, str]]] = []
    for name in INPUTS:
        own = scene_name(name)
        for text in _others(base[own], name):
            tried.append((name, {**base, own: text}))
    for one, two in _SUMS:
        tried.append(
            (
                f"{one} + {two}",
                {**base, one: _plus(base[one], _STEP), two: _plus(base[two], -_STEP)},
            )
        )
    first, *outcomes = replays.run_all([base, *(other for _, other in tried)])
    same: dict[str, bool] = {}
    for (name, _), outcome in zip(tried, outcomes, strict=True):
        exact = "+" not in name
        same[name] = same.get(name, True) and _agree(first, outcome, {name}, exact)
    alone = [name for name in INPUTS if same[name]]
    sentences = []
    if alone:
        names = ", ".join(scene_name(name) for name in alone)
        sentences.append(
            f"{names}: nothing else on the page depends on {'it' if len(alone) == 1 else 'them'}, "
            "so a misreading there would not show"
        )
    for one, two in _SUMS:
        if same[f"{one} + {two}"] and not {one, two} & set(alone):
            sentences.append(
                f"{one} and {two} enter only as their sum, so which of the two is misread would "
                "not show"
            )
    faint = _faint(base, first, set(alone))
    if faint:
        sentences.append(
            "any one digit in brackets may be another with all else on the page the same: "
            + ", ".join(faint)
        )
    return sentences


def _faint(base: Mapping[str, str], first: replays.Outcome, alone: set[str]) -> list[str]:
    """The inputs, as printed, in which one digit can be another that changes nothing else on the
    page; each such digit in brackets."""
    tried: list[tuple[str, int]] = []
    scenes: list[Mapping[str, str]] = [base]
    for name in INPUTS:
        printed, own = first.fields.get(name), scene_name(name)
        if printed is None or name in alone:
            continue
        turned = own == "MU" and mu_turned(base[own], printed)
        for place, text in _other_digits(printed):
            tried.append((name, place))
            scenes.append({**base, own: opposite(text) if turned else text})
    if not tried:
        return []
    endings, columns = replays.run_columns(scenes, _DEPENDENT)
    differ = {name: texts != texts[0] for name, texts in columns.items()}
    shows = (np.array(endings) != endings[0]) + sum(differ.values())
    faint: dict[str, set[int]] = {}
    for row, (name, place) in enumerate(tried, 1):
        if shows[row] == (name in differ and differ[name][row]):
            faint.setdefault(name, set()).add(place)
    return [f"{scene_name(name)} {_marked(first.fields[name], at)}" for name, at in faint.items()]


def _other_digits(printed: str) -> Iterator[tuple[int, str]]:
    """The numbers that differ in one digit from one, and where; exponents apart."""
    for place, old in enumerate(printed.partition("E")[0]):
        for new in "0123456789" if old.isdigit() else "":
            text = printed[:place] + new + printed[place + 1 :]
            if new != old and printable(text):
                yield place, text


def _marked(text: str, places: set[int]) -> str:
    """A number with some of its digits in brackets."""
    marked = "".join(f"({glyph})" if at in places else glyph for at, glyph in enumerate(text))
    return marked.replace(")(", "")


def _others(text: str, name: str) -> list[str]:
    """Other values of an input, not near any symmetry."""
    if name in ANGLES:
        return [_plus(text, int(step)) for step in _ANGLE_STEPS]
    value = double(text)
    if name == "E":
        return [_short(value * 0.7 + 0.11)]
    other = value * 1.37 + 0.53
    return [_short(other if math.isfinite(other) else 1.0)]


def _plus(text: str, step: int) -> str:
    turned = double(text) + step
    return _short(turned if math.isfinite(turned) else step)


def _short(value: float) -> str:
    return f"{value:.6g}".replace("e", "E")


def _agree(one: replays.Outcome, other: replays.Outcome, names: set[str], exact: bool) -> bool:
    """Whether two outcomes print the same results, to the digit or nearly so."""
    if one.ending != other.ending:
        return False
    for name, field in FIELDS.items():
        if name not in _DEPENDENT or name in names:
            continue
        text, second = one.fields.get(name), other.fields.get(name)
        if text == second:
            continue
        if exact or text is None or second is None:
            return False
        unit = 10.0 ** -(field.places or 0)
        if abs(float(text) - float(second)) > _LAST_PLACES * unit + 1e-6 * abs(float(text)):
            return False
    return True
