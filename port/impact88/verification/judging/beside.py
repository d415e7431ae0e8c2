"""What stands beside a verdict and never changes it: exact values, warnings, and what the page
cannot show.

Exact means the mechanics of Equations 13 to 18 in double precision by the closed form, with exact
pi, for the recovered scene: what the program would print had its arithmetic cost nothing.

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
from ...collision.doubles import double, doubles_of
from ...collision.fields import ANGLES, FIELDS, INPUTS, scene_name
from ...mechanics.closedform.solve import solve
from ...names import RESULTS
from ..reading.numerals import printable, value_of
from ..recovery.replays import run_columns
from ..recovery.typedtext import mu_turned, opposite
from .judgement import FieldCheck

_DIGITS = 12
"""Digits an exact value is shown with: as many as double precision is sure of."""
_SUMS = (("PA", "TA"), ("PB", "TB"))
_LAST_PLACES = 2.0
"""Angles of the same sum may enter with other last bits: results agree within so many units."""
_TURN = 360
"""Degrees."""
_MANY_TURNS = 1_000_000
"""Degrees from which 32 bits hold the angle in radians to 4e-6 or worse."""
_DEPENDENT = tuple(name for name in FIELDS if name not in INPUTS or name == "MUP")
"""What is printed that other inputs than itself may change: MU's sign is chosen."""

Scene = Mapping[str, str]
Program = Callable[[Sequence[Scene], Sequence[str]], tuple[list[str], dict[str, Any]]]
"""What a program prints for some scenes, as `run_columns` has it."""


def add_exact_values(scene: Scene, checks: Sequence[FieldCheck]) -> None:
    """Set ``exact`` and ``difference`` (printed less exact) of every check of a result."""
    wanted = [check for check in checks if check.name in RESULTS and check.name not in INPUTS]
    values = solve(doubles_of(scene), [check.name for check in wanted])
    for check in wanted:
        if math.isnan(value := values[check.name]):
            continue
        check.exact = f"{value + 0.0:.{_DIGITS}g}"
        if (printed := value_of(check.printed or "")) is not None:
            difference = printed - Decimal(check.exact)
            check.difference = f"{difference:+.3g}" if difference else "0"


def warnings(scene: Scene) -> list[str]:
    """What is unphysical about a scene (the bits of STATUS), and which of the program's known traps
    it steps into, one sentence each."""
    values: dict[str, Any] = dict(doubles_of(scene))
    values |= solve(values, ["STATUS", "MUC", "MUP", "XA", "YA", "XB", "YB"])
    bits = int(values["STATUS"])
    sentences = [f"{bit.name}: {status.WORDS[bit]}" for bit in status.Status if bits & bit]
    sentences += status.admissible_friction(bits, values)
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


# --- what the page cannot show ---


class _Trial(NamedTuple):
    """A scene with other inputs, and their names; ``place``: of the one digit that is another;
    ``near``: whether it is the last, and another by one."""

    names: tuple[str, ...]
    scene: Scene
    place: int = 0
    near: bool = False


def unseen(scene: Scene, printed: Mapping[str, str], program: Program = run_columns) -> list[str]:
    """What the results that a program prints for a scene do not depend on, one sentence each.
    ``printed``: what it prints, by field."""
    trials = [*_other_values(scene)]
    alike = zip(trials, _same(program, scene, trials), strict=True)
    shows = {trial.names for trial, same in alike if not same}
    alone = [name for name in INPUTS if (name,) not in shows]
    digits = [trial for trial in _other_digits(scene, printed) if trial.names in shows]
    if program is not run_columns:  # those that the listing does not show, and the likeliest
        alike = zip(digits, _same(run_columns, scene, digits), strict=True)
        digits = [trial for trial, same in alike if same or trial.near]
    sentences = []
    if alone:
        names = ", ".join(map(scene_name, alone))
        sentences.append(
            f"{names}: nothing else on the page depends on {'it' if len(alone) == 1 else 'them'}, "
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
        marked = [f"{name} {''.join(text).replace(')(', '')}" for name, text in faint.items()]
        sentences.append(
            "any one digit in brackets may be another with all else on the page the same: "
            + ", ".join(marked)
        )
    return sentences


def _other_values(scene: Scene) -> Iterator[_Trial]:
    """Other values of each input, not near any symmetry, and other angles of the same sum."""
    for name in INPUTS:
        value = double(scene[scene_name(name)])
        others = [value * 1.37 + 0.53]
        if name in ANGLES:
            others = [value + 11, value - 23]
        elif name == "E":
            others = [value * 0.7 + 0.11]
        for other in others:
            yield _Trial((name,), {**scene, scene_name(name): _short(other)})
    for first, second in _SUMS:
        turned = (_short(double(scene[first]) + 7), _short(double(scene[second]) - 7))
        angles = dict(zip((first, second), turned, strict=True))
        yield _Trial((first, second), {**scene, **angles})


def _short(value: float) -> str:
    return f"{value if math.isfinite(value) else 1.0:.6G}"


def _other_digits(scene: Scene, printed: Mapping[str, str]) -> Iterator[_Trial]:
    """Inputs as printed, with one other digit."""
    for name in INPUTS:
        text, own = printed.get(name, ""), scene_name(name)
        turned = name == "MUP" and text and mu_turned(scene[own], text)
        places = [at for at, char in enumerate(text.partition("E")[0]) if char.isdigit()]
        for place, new in product(places, "0123456789"):
            other = text[:place] + new + text[place + 1 :]
            if other != text and printable(other):
                near = place == places[-1] and abs(int(new) - int(text[place])) == 1
                typed = opposite(other) if turned else other
                yield _Trial((name,), {**scene, own: typed}, place, near)


def _same(program: Program, scene: Scene, trials: Sequence[_Trial]) -> list[bool]:
    """Whether a program prints the same for each as for the scene, but for what was changed; nearly
    the same where that is a sum."""
    endings, columns = program([scene, *(trial.scene for trial in trials)], _DEPENDENT)
    differ = {name: texts != texts[0] for name, texts in columns.items()}
    count = sum(differ.values()) + (np.array(endings) != endings[0])
    alike = []
    for row, trial in enumerate(trials, 1):
        others = [name for name in _DEPENDENT if differ[name][row]] if len(trial.names) > 1 else []
        same = count[row] == len(others) + (trial.names[0] == "MUP" and differ["MUP"][row])
        for name in others:
            text, other = columns[name][0], columns[name][row]
            unit = 10.0 ** -(FIELDS[name].places or 0)
            near = _LAST_PLACES * unit + 1e-6 * abs(float(text or "nan"))
            same = same and abs(float(text or "nan") - float(other or "nan")) <= near
        alike.append(bool(same))
    return alike
