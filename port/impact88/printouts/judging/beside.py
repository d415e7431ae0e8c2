"""Information beside a verdict, which never changes it: exact values, warnings, and errors that the
page could not reveal.

Exact means the mechanics of Equations 13 to 18 in double precision by the closed form, with exact
pi, for the recovered scene: the results without the program's rounding errors.

An input that nothing else printed depends on may be misread on a page that agrees with itself, so
no verdict covers it. With M = 4 that is a third of all inputs. Angles that enter only as a sum are
named together, and single digits that are too small to show, most often an inertia's last.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from decimal import Decimal
from itertools import compress, product
from typing import Any, NamedTuple

import numpy as np

from ... import status
from ...decimals import negated as opposite
from ...decimals import to_double as double
from ...mechanics.solve import solve
from ...names import RESULTS
from ..fields import ANGLES, FIELDS, INPUTS, doubles_of, scene_name
from ..reading.numerals import printable, value_of
from ..recovery.replays import run_columns
from ..recovery.typedtext import mu_turned
from .judgement import FieldCheck

EXACT_DIGITS = 12
"""Digits shown of an exact value: as many as are certain in double precision."""
_SUMS = (("PA", "TA"), ("PB", "TB"))
MAX_LAST_PLACES = 2.0
"""Units of the last place within which results agree: equal sums of angles may differ in last
bits."""
_ALONE = ": nothing else on the page depends on"
"""Words behind the names of inputs on which nothing else printed depends."""
_TURN = 360  # degrees
_MANY_TURNS = 1_000_000
"""Size in degrees from which 32 bits hold the angle in radians to 4e-6 or worse."""
_DEPENDENT = tuple(name for name in FIELDS if name not in INPUTS or name == "MUP")
"""Printed fields that may change with other inputs: the results, and MU, whose sign is chosen."""

Scene = Mapping[str, str]
Program = Callable[[Sequence[Scene], Sequence[str]], tuple[list[str], dict[str, Any]]]
"""A function that runs a program on scenes and returns what `run_columns` does."""


def add_exact_values(scene: Scene, checks: Sequence[FieldCheck]) -> None:
    """Set ``exact`` and ``difference`` (printed less exact) of every check of a result."""
    result_checks = [
        check for check in checks if check.name in RESULTS and check.name not in INPUTS
    ]
    values = solve(doubles_of(scene), [check.name for check in result_checks])
    for check in result_checks:
        if math.isnan(value := values[check.name]):
            continue
        check.exact = f"{value + 0.0:.{EXACT_DIGITS}g}"
        if (number := value_of(check.printed or "")) is not None:
            difference = number - Decimal(check.exact)
            check.difference = f"{difference:+.3g}" if difference else "0"


def warnings(scene: Scene) -> list[str]:
    """Return a sentence for each unphysical trait of a scene (a bit of STATUS) and for each known
    fault of the program that the scene triggers."""
    values: dict[str, Any] = dict(doubles_of(scene))
    values |= solve(values, ["STATUS", "MUC", "MUP", "PN", "PM"])
    bits = int(values["STATUS"])
    sentences = [f"{bit.name}: {status.WORDS[bit]}" for bit in status.Status if bits & bit]
    point, mu = values["M"] == 4, values["MU"]
    if point and (values["DA"] or values["DB"]):
        sentences.append(
            "M = 4 with DA or DB not zero: the XA, YA, XB, YB printed after the impact are "
            "nonsense (line 550 stores a sum where line 700 expects a spin)"
        )
    if point and (values["WA"] or values["WB"]):
        sentences.append("M = 4 with WA or WB not zero: the KE LOSS printed is wrong")
    if mu == 10:
        sentences.append("MU = 10 becomes -10 in line 400, which line 510 takes for a pivot")
    if mu < -10:
        sentences.append("MU below -10: line 510 zeroes a right-hand side that is not a pivot's")
    return [*sentences, *_whole_turns(scene)]


def _whole_turns(scene: Scene) -> Iterator[str]:
    """Yield a sentence for each angle of a turn or more: a digit added in front of an angle may
    add turns, and nothing else on the page changes."""
    for name in ANGLES:
        text = scene[name].strip()
        number = value_of(text)
        if number is None or abs(number) < _TURN:
            continue
        if abs(number) < _MANY_TURNS:
            same = f"{number % _TURN:f} points the same way, and prints the same but for rounding"
        else:
            same = "rounding has a part in where it points"
        yield f"{name} = {text}, a whole turn or more: {same}"


# --- errors that the page could not reveal ---


class _Trial(NamedTuple):
    """A scene with changed inputs, and their names. Where one digit was changed, ``place`` is its
    index, and ``near`` is True if it is the last digit, changed by one."""

    names: tuple[str, ...]
    scene: Scene
    place: int = 0
    near: bool = False


def unseen(scene: Scene, printed: Mapping[str, str], program: Program = run_columns) -> list[str]:
    """Return a sentence for each input, sum or digit on which no printed result depends.
    ``printed``: the program's fields for the scene, by name."""
    trials = [*_other_values(scene)]
    alike = zip(trials, _same(program, scene, trials), strict=True)
    shows = {trial.names for trial, same in alike if not same}
    alone = [name for name in INPUTS if (name,) not in shows]
    digits = [trial for trial in _other_digits(scene, printed) if trial.names in shows]
    if program is not run_columns:  # a copy is slow: only digits likely to be unseen are tried
        alike = zip(digits, _same(run_columns, scene, digits), strict=True)
        digits = [trial for trial, same in alike if same or trial.near]
    sentences = []
    if alone:
        names = ", ".join(map(scene_name, alone))
        sentences.append(
            f"{names}{_ALONE} {'it' if len(alone) == 1 else 'them'}, "
            "so a misreading there would not show"
        )
    sentences += [
        f"{a} and {b} enter only as their sum, so which of the two is misread would not show"
        for a, b in _SUMS
        if (a, b) not in shows and not {a, b} & set(alone)
    ]
    faint: dict[str, list[str]] = {}
    for trial in compress(digits, _same(program, scene, digits)):
        (name,), at = trial.names, trial.place
        text = printed[name]
        faint.setdefault(scene_name(name), [*text])[at] = f"({text[at]})"
    if faint:
        faint_texts = [f"{name} {''.join(text).replace(')(', '')}" for name, text in faint.items()]
        sentences.append(
            "any one digit in brackets may be another with all else on the page the same: "
            + ", ".join(faint_texts)
        )
    return sentences


def not_verifiable(sentences: Sequence[str]) -> str:
    """Return the names of the inputs that no other number of the page depends on, from what
    `unseen` gave; empty if there is none."""
    return next((text.partition(_ALONE)[0] for text in sentences if _ALONE in text), "")


def _other_values(scene: Scene) -> Iterator[_Trial]:
    """Yield scenes with another value of each input, away from any symmetry, and with other angles
    of the same sum."""
    for name in INPUTS:
        value = double(scene[scene_name(name)])
        replacements = [value * 1.37 + 0.53]
        if name in ANGLES:
            replacements = [value + 11, value - 23]
        elif name == "E":
            replacements = [value * 0.7 + 0.11]
        for replacement in replacements:
            yield _Trial((name,), {**scene, scene_name(name): _short(replacement)})
    for first, second in _SUMS:
        angle_texts = (_short(double(scene[first]) + 7), _short(double(scene[second]) - 7))
        angles = dict(zip((first, second), angle_texts, strict=True))
        yield _Trial((first, second), {**scene, **angles})


def _short(value: float) -> str:
    return f"{value if math.isfinite(value) else 1.0:.6G}"


def _other_digits(scene: Scene, printed: Mapping[str, str]) -> Iterator[_Trial]:
    """Yield scenes in which one digit of one printed input is changed."""
    for name in INPUTS:
        text, scene_key = printed.get(name, ""), scene_name(name)
        mu_reversed = name == "MUP" and text and mu_turned(scene[scene_key], text)
        places = [at for at, char in enumerate(text.partition("E")[0]) if char.isdigit()]
        for place, new in product(places, "0123456789"):
            variant = text[:place] + new + text[place + 1 :]
            if variant != text and printable(variant):
                is_nearest = place == places[-1] and abs(int(new) - int(text[place])) == 1
                typed_text = opposite(variant) if mu_reversed else variant
                yield _Trial((name,), {**scene, scene_key: typed_text}, place, is_nearest)


def _same(program: Program, scene: Scene, trials: Sequence[_Trial]) -> list[bool]:
    """Return, for each trial, True if the program prints the same as for the scene, apart from the
    changed input; for angles of the same sum, nearly the same."""
    endings, columns = program([scene, *(trial.scene for trial in trials)], _DEPENDENT)
    differ = {name: texts != texts[0] for name, texts in columns.items()}
    count = sum(differ.values()) + (np.array(endings) != endings[0])
    alike = []
    for row, trial in enumerate(trials, 1):
        rounding_names = (
            [name for name in _DEPENDENT if differ[name][row]] if len(trial.names) > 1 else []
        )
        same = count[row] == len(rounding_names) + (trial.names[0] == "MUP" and differ["MUP"][row])
        for name in rounding_names:
            text, variant = columns[name][0], columns[name][row]
            unit = 10.0 ** -(FIELDS[name].places or 0)
            tolerance = MAX_LAST_PLACES * unit + 1e-6 * abs(float(text or "nan"))
            same = same and abs(float(text or "nan") - float(variant or "nan")) <= tolerance
        alike.append(bool(same))
    return alike
