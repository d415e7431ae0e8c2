"""What a page cannot show: inputs that nothing else printed on it depends on.

A misreading of such an input leaves a page that agrees with itself, so no verdict covers it. With
M = 4 that is a third of all inputs. Angles that enter only as a sum are named together, and single
digits that are too small to show, most often an inertia's last.
"""

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from ..doubles import double
from ..fields import ANGLES, FIELDS, INPUTS, scene_name
from ..reading.numerals import printable
from ..recovery import replays
from ..recovery.typedtext import mu_turned, opposite

_SUMS = (("PA", "TA"), ("PB", "TB"))
_LAST_PLACES = 2.0
"""Angles of the same sum may enter with other last bits: results agree within so many units."""
_DEPENDENT = tuple(name for name in FIELDS if name not in INPUTS or name == "MUP")
"""What is printed that other inputs than itself may change: MU's sign is chosen."""

Scene = Mapping[str, str]
Program = Callable[[Sequence[Scene]], list[replays.Outcome]]
"""What a program prints for some scenes."""


def unseen(base: Scene, program: Program = replays.run_all) -> list[str]:
    """What the results that a program prints for a scene do not depend on, one sentence each."""
    tried: list[tuple[str, Scene]] = [("", base)]
    for name in INPUTS:
        own = scene_name(name)
        tried += [(name, {**base, own: text}) for text in _others(base[own], name)]
    for one, two in _SUMS:
        turned = {**base, one: _plus(base[one], 7), two: _plus(base[two], -7)}
        tried.append((f"{one} + {two}", turned))
    first, *outcomes = program([one for _, one in tried])
    others = zip(tried[1:], outcomes, strict=True)
    shows = {name for (name, _), outcome in others if not _agree(first, outcome, name)}
    alone = [name for name in INPUTS if name not in shows]
    sentences = []
    if alone:
        names = ", ".join(map(scene_name, alone))
        sentences.append(
            f"{names}: nothing else on the page depends on {'it' if len(alone) == 1 else 'them'}, "
            "so a misreading there would not show"
        )
    for one, two in _SUMS:
        if f"{one} + {two}" not in shows and not {one, two} & set(alone):
            sentences.append(
                f"{one} and {two} enter only as their sum, so which of the two is misread would "
                "not show"
            )
    faint = _faint(base, first, alone, program)
    if faint:
        sentences.append(
            "any one digit in brackets may be another with all else on the page the same: "
            + ", ".join(faint)
        )
    return sentences


def _faint(
    base: Scene, first: replays.Outcome, alone: Sequence[str], program: Program
) -> list[str]:
    """The inputs, as printed, in which one digit can be another that changes nothing else on the
    page; each such digit in brackets. Of another program those are tried that the restored listing
    does not show, and the last digits' neighbours."""
    tried: list[tuple[str, int]] = []
    scenes = [base]
    near = []
    for name in INPUTS:
        printed, own = first.fields.get(name), scene_name(name)
        if printed is None or name in alone:
            continue
        turned = own == "MU" and mu_turned(base[own], printed)
        digits = [at for at, char in enumerate(printed.partition("E")[0]) if char.isdigit()]
        for place in digits:
            for new in "0123456789":
                text = printed[:place] + new + printed[place + 1 :]
                if text != printed and printable(text):
                    tried.append((name, place))
                    scenes.append({**base, own: opposite(text) if turned else text})
                    near.append(place == digits[-1] and abs(int(new) - int(printed[place])) == 1)
    if not tried:
        return []
    endings, columns = replays.run_columns(scenes, _DEPENDENT)
    differ = {name: texts != texts[0] for name, texts in columns.items()}
    shows = (np.array(endings) != endings[0]) + sum(differ.values())
    same = [
        shows[k] == (name in differ and differ[name][k]) for k, (name, _) in enumerate(tried, 1)
    ]
    if program is not replays.run_all:
        rows = [
            k for k, (alike, by_one) in enumerate(zip(same, near, strict=True)) if alike or by_one
        ]
        outcomes = program([scenes[k + 1] for k in rows])
        same = [False] * len(tried)
        for k, outcome in zip(rows, outcomes, strict=True):
            same[k] = _agree(first, outcome, tried[k][0])
    faint: dict[str, set[int]] = {}
    for (name, place), alike in zip(tried, same, strict=True):
        if alike:
            faint.setdefault(name, set()).add(place)
    return [f"{scene_name(name)} {_marked(first.fields[name], at)}" for name, at in faint.items()]


def _marked(text: str, places: set[int]) -> str:
    marked = "".join(f"({glyph})" if at in places else glyph for at, glyph in enumerate(text))
    return marked.replace(")(", "")


def _others(text: str, name: str) -> list[str]:
    """Other values of an input, not near any symmetry."""
    if name in ANGLES:
        return [_plus(text, 11), _plus(text, -23)]
    value = double(text)
    other = value * 0.7 + 0.11 if name == "E" else value * 1.37 + 0.53
    return [_short(other if math.isfinite(other) else 1.0)]


def _plus(text: str, step: int) -> str:
    turned = double(text) + step
    return _short(turned if math.isfinite(turned) else step)


def _short(value: float) -> str:
    return f"{value:.6g}".replace("e", "E")


def _agree(one: replays.Outcome, other: replays.Outcome, changed: str) -> bool:
    """Whether two outcomes print the same but for the input that was changed; nearly the same where
    that is a sum."""
    if one.ending != other.ending:
        return False
    for name in _DEPENDENT:
        text, second = one.fields.get(name), other.fields.get(name)
        if text == second or name == changed:
            continue
        if "+" not in changed or text is None or second is None:
            return False
        unit = 10.0 ** -(FIELDS[name].places or 0)
        if abs(float(text) - float(second)) > _LAST_PLACES * unit + 1e-6 * abs(float(text)):
            return False
    return True
