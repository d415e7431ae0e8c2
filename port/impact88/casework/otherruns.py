"""Other causes than a misread number: another place, unit, M, program or arithmetic.

Each is a hypothesis about the whole page, replayed: scenes over arrays, other arithmetics through
the listing itself.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal, localcontext
from itertools import combinations
from typing import NamedTuple

from ..fields import ANGLES, FIELDS, INPUTS
from . import otherarithmetic, trial
from .numerals import as_printed, value_of
from .printout import Printout
from .recovery import Recovered
from .rereading import Change
from .search import AGREES, Expected, expected_results
from .ways import opposite, scene_name

SWAPPED = "two numbers in each other's place"
RESULTS_SWAPPED = "results in each other's place"
SIDES_SWAPPED = "A and B exchanged"
AXES_SWAPPED = "x and y exchanged"
RADIANS = "angle in radians"
AS_RADIANS = "degrees taken for radians"
UNITS = "another unit"
MU_SIGN = "sign of MU"
POINT_MASS = "M = 4 with DA, DB left"
OTHER_M = "M misjudged"
DOUBLE = "IEEE double arithmetic"
DOUBLE_PI = "IEEE double arithmetic with exact pi"
OTHER_PI = "IEEE double arithmetic with pi = 3.1416"
SINGLE = "single-precision arithmetic"
SINGLE_ROUNDED = "single-precision arithmetic, rounded, not floored"
DECIMAL = "decimal (BCD) arithmetic"
ROUNDED = "rounded, not floored"
TRUNCATED = "truncated, not floored"
DOUBLE_ROUNDED = "IEEE double arithmetic, rounded, not floored"
DOUBLE_TRUNCATED = "IEEE double arithmetic, truncated, not floored"
MORE_DECIMALS = "printed with other decimals"

_NATURAL, _ODD = 1.35, 2.4
_UNIT, _ARITHMETIC, _PROGRAM = 1.45, 1.4, 1.3
_NOT_APPLESOFT = "then this program on an Apple II did not print it"

_SIDES = (*((f"{x}A", f"{x}B") for x in "MIDPTW"), ("UX", "VX"), ("UY", "VY"))
_AXES = (("UX", "UY"), ("VX", "VY"))
_ALIKE = frozenset(
    frozenset(pair)
    for pair in (
        *_SIDES, *_AXES, ("PA", "TA"), ("PB", "TB"), ("MUP", "EM"), ("E", "EM"), ("E", "MUP"),
    )
)  # fmt: skip
_GROUPS = (_SIDES, _SIDES[5:], _SIDES[:2], _SIDES[3:5], _SIDES[6:], _AXES)
_SPEEDS = ("UX", "UY", "VX", "VY")
_GRAVITY = (1 / 32.174, 1 / 32.2, 1 / 9.81, 1 / 9.80665, 1 / 32)
_FACTORS: tuple[tuple[str, tuple[str, ...], tuple[float, ...]], ...] = (
    ("mph for ft/s", _SPEEDS, (22 / 15,)),
    ("km/h for m/s", _SPEEDS, (1 / 3.6,)),
    ("knots", _SPEEDS, (1.687810, 0.514444)),
    ("weights for masses", ("MA", "MB"), _GRAVITY),
    ("weights for masses and inertias", ("MA", "MB", "IA", "IB"), _GRAVITY),
    ("inertias by weight", ("IA", "IB"), _GRAVITY),
    ("inches for feet", ("DA", "DB"), (1 / 12,)),
    ("feet for meters", ("DA", "DB"), (0.3048,)),
    ("centimeters for meters", ("DA", "DB"), (0.01,)),
    ("spins in degrees", ("WA", "WB"), (math.pi / 180,)),
    ("spins in turns", ("WA", "WB"), (2 * math.pi,)),
    ("percent", ("E",), (0.01,)),
    ("percent", ("E", "MUP", "EM"), (0.01,)),
)  # fmt: skip


class Hypothesis(NamedTuple):
    """A cause: its kind, what to add, how much it asks to be believed, the printed numbers it puts
    right, the scene it means, and its outcome where that is no replay's."""

    kind: str
    note: str
    weight: float
    changes: tuple[Change, ...]
    scene: dict[str, str]
    outcome: trial.Outcome | None = None
    spared: frozenset[str] = frozenset()


class Tried(NamedTuple):
    """A hypothesis and the names in which the page still differs from it."""

    hypothesis: Hypothesis
    scene: dict[str, str]
    wrong: frozenset[str]


def hypotheses(shown: Printout, recovered: Recovered) -> list[Hypothesis]:
    """All there are for a printout."""
    base = _Base(shown, recovered)
    return [
        *base.exchanged(),
        *base.radians(),
        *base.units(),
        *base.other_runs(),
        *base.results_exchanged(),
    ]


def tried(shown: Printout, recovered: Recovered, every: Sequence[Hypothesis]) -> Iterator[Tried]:
    """What each leaves unexplained."""
    import numpy as np

    expected = expected_results(shown)
    replayed = [one for one in every if one.outcome is None]
    wrong: list[set[str]] = [set() for _ in replayed]
    if replayed:
        names = [one.name for one in expected]
        endings, columns = trial.run_columns([one.scene for one in replayed], [*names, "MUP"])
        for one in expected:
            texts, where = np.unique(columns[one.name], return_inverse=True)
            differs = np.array([one.cost(text) >= AGREES for text in texts.tolist()])[where]
            for index in np.flatnonzero(differs).tolist():
                wrong[index].add(one.name)
        for index, (hypothesis, ending, mu) in enumerate(
            zip(replayed, endings, columns["MUP"].tolist(), strict=True)
        ):
            if shown.ending is not None and ending != shown.ending:
                wrong[index].add("ENDING")
            printed = recovered.assumed.get("MUP")
            exchanged = any(change.field == "MUP" for change in hypothesis.changes)
            if printed is not None and not exchanged and mu != printed:
                wrong[index].add("MUP")
    for hypothesis, names_wrong in zip(replayed, wrong, strict=True):
        yield Tried(hypothesis, hypothesis.scene, frozenset(names_wrong))
    for hypothesis in every:
        if hypothesis.outcome is not None:
            yield Tried(hypothesis, hypothesis.scene, _differing(shown, expected, hypothesis))


def _differing(
    shown: Printout, expected: Sequence[Expected], hypothesis: Hypothesis
) -> frozenset[str]:
    assert hypothesis.outcome is not None
    fields = hypothesis.outcome.fields
    wrong = {
        one.name
        for one in expected
        if one.name not in hypothesis.spared and one.cost(fields.get(one.name, "")) >= AGREES
    }
    for name in INPUTS:
        reading = shown.fields.get(name)
        if reading is None or name in hypothesis.spared or not reading.clean:
            continue
        if fields.get(name) != reading.text and value_of(fields.get(name, "")) != value_of(
            reading.text
        ):
            wrong.add(name)
    if shown.ending is not None and shown.ending != hypothesis.outcome.ending:
        wrong.add("ENDING")
    return frozenset(wrong)


class _Base:
    """The hypotheses of one printout, all changes of its recovered scene."""

    def __init__(self, shown: Printout, recovered: Recovered) -> None:
        self._shown = shown
        self._recovered = recovered
        self._scene = recovered.scene
        self._printed = recovered.assumed
        self._known = all(reading.clean for reading in shown.fields.values())

    def _made(
        self, kind: str, note: str, weight: float, typed: Mapping[str, str]
    ) -> Iterator[Hypothesis]:
        """The scene with some inputs otherwise, MU with either sign."""
        changes = tuple(
            Change(kind, name, self._printed.get(name, ""), typed[scene_name(name)])
            for name in INPUTS
            if scene_name(name) in typed
            and typed[scene_name(name)] != self._scene[scene_name(name)]
        )
        if not changes:
            return
        scene = {**self._scene, **typed}
        yield Hypothesis(kind, note, weight, changes, scene)
        if float(scene["MU"] or 0):
            flipped = {**scene, "MU": opposite(scene["MU"])}
            yield Hypothesis(kind, note, weight, changes, flipped)

    def exchanged(self) -> Iterator[Hypothesis]:
        """Two inputs in each other's place, or all of a side or an axis."""
        for pair in combinations(INPUTS, 2):
            one, two = map(scene_name, pair)
            typed = {one: self._scene[two], two: self._scene[one]}
            kind = SWAPPED
            if pair in _AXES:
                kind = AXES_SWAPPED
            elif pair in _SIDES:
                kind = SIDES_SWAPPED
            weight = _NATURAL if frozenset(pair) in _ALIKE else _ODD
            yield from self._made(kind, f"{one} and {two}", weight, typed)
        for group in _GROUPS:
            typed = {}
            for one, two in group:
                typed |= {one: self._scene[two], two: self._scene[one]}
            kind = AXES_SWAPPED if group == _AXES else SIDES_SWAPPED
            note = ", ".join(f"{one} and {two}" for one, two in group)
            yield from self._made(kind, note, _NATURAL, typed)

    def radians(self) -> Iterator[Hypothesis]:
        """One angle or all of them in radians, or degrees that were taken for radians."""
        groups: list[tuple[str, ...]] = [*((name,) for name in ANGLES), tuple(ANGLES)]
        groups += [("PA", "PB"), ("TA", "TB"), ("PA", "PB", "TA", "TB")]
        for names in groups:
            value = {name: float(self._scene[name]) * 180 / math.pi for name in names}
            for places in (0, 1, 2, 3, 6):
                typed = {name: _short(round(value[name], places)) for name in names}
                kind = AS_RADIANS if places == 6 else RADIANS
                yield from self._made(kind, ", ".join(names), _UNIT, typed)
            back = {name: _short(float(self._scene[name]) * math.pi / 180) for name in names}
            yield from self._made(AS_RADIANS, ", ".join(names), _UNIT + 0.2, back)

    def units(self) -> Iterator[Hypothesis]:
        """Some inputs in another unit, printed so or computed so."""
        for note, names, factors in _FACTORS:
            for factor in factors:
                for scale, way in ((factor, "printed"), (1 / factor, "computed")):
                    own = {
                        scene_name(name): float(self._scene[scene_name(name)]) * scale
                        for name in names
                    }
                    for places in (None, 0, 1, 2, 3, 4):
                        typed = {
                            name: _short(value if places is None else round(value, places))
                            for name, value in own.items()
                        }
                        yield from self._made(UNITS, f"{note}, as {way}", _UNIT, typed)

    def results_exchanged(self) -> Iterator[Hypothesis]:
        """Two results, or the lines of A and B, in each other's place."""
        fields = self._recovered.outcome.fields
        pairs = (("VAX", "VBX"), ("VAY", "VBY"), ("XAF", "XBF"), ("YAF", "YBF"), ("WAF", "WBF"))
        singles = [(pair,) for pair in combinations([n for n in FIELDS if n not in INPUTS], 2)]
        for group in (pairs[:4], pairs, *singles):
            if not all(name in fields for pair in group for name in pair):
                continue
            swapped = dict(fields)
            for one, two in group:
                swapped[one], swapped[two] = fields[two], fields[one]
            changes = tuple(
                Change(RESULTS_SWAPPED, name, swapped[name], fields[name])
                for pair in group
                for name in pair
                if swapped[name] != fields[name]
            )
            note = ", ".join(f"{one} and {two}" for one, two in group)
            outcome = trial.Outcome(swapped, self._recovered.outcome.ending)
            if changes:
                yield Hypothesis(RESULTS_SWAPPED, note, _NATURAL, changes, self._scene, outcome)

    def other_runs(self) -> Iterator[Hypothesis]:
        """Other values of M, another arithmetic, other ways to print."""
        scene = self._scene
        other = "4" if scene["M"] == "6" else "6"
        change = (Change(OTHER_M, "M", scene["M"], other),)
        yield Hypothesis(OTHER_M, "", _PROGRAM, change, {**scene, "M": other})
        if float(scene["MU"] or 0):
            flipped = {**scene, "MU": opposite(scene["MU"])}
            yield Hypothesis(MU_SIGN, "typed with the other sign", 1.2, (), flipped)
        if any(float(scene[name] or 0) for name in ("DA", "DB")):
            run = {**scene, "M": "4", "DA": "0", "DB": "0"}
            note = "as if computed with DA = DB = 0, though the printout shows others"
            yield Hypothesis(POINT_MASS, note, _PROGRAM, (), run)
        yield from self._arithmetics()

    def _arithmetics(self) -> Iterator[Hypothesis]:
        apart = f"; {_NOT_APPLESOFT}" if self._known else ""
        for scene in self._as_typed():
            outcome, values = trial.run_whole(scene, "float64")
            outcome = self._longer_energy(outcome)

            def made(kind: str, note: str, outcome: trial.Outcome, add: float = 0.0) -> Hypothesis:
                return Hypothesis(kind, note + apart, _ARITHMETIC + add, (), scene, outcome)  # noqa: B023

            yield made(DOUBLE, "float64 prints so", outcome)
            yield made(DOUBLE_ROUNDED, "float64 prints so", _cut(outcome, values, False), 0.1)
            yield made(DOUBLE_TRUNCATED, "float64 prints so", _cut(outcome, values, True), 0.1)
            exact = trial.run_on(scene, otherarithmetic.with_pi("exact"))
            yield made(DOUBLE_PI, "double precision prints so", exact, 0.05)
            rough = trial.run_on(scene, otherarithmetic.with_pi("3.1416"))
            yield made(OTHER_PI, "double precision prints so", rough, 0.1)
            short = trial.run_on(scene, otherarithmetic.single())
            yield made(SINGLE, "as GW-BASIC and its like compute and print", short, 0.05)
            rounded = _cut(outcome, values, False).fields
            whole = {name: text for name, text in short.fields.items() if name not in values}
            both = trial.Outcome({**rounded, **whole}, short.ending)
            yield made(SINGLE_ROUNDED, "as GW-BASIC and its like compute and print", both, 0.15)
            with localcontext(otherarithmetic.DECIMAL_CONTEXT):
                decimal = trial.run_on(scene, otherarithmetic.decimal())
            yield made(DECIMAL, "as machines with decimal arithmetic compute", decimal, 0.1)
            other = self._other_decimals(outcome, values)
            if other is not None:
                yield made(MORE_DECIMALS, "each number to decimals of its own", other, 0.1)
        outcome, values = trial.run_whole(self._scene)
        yield Hypothesis(
            ROUNDED, _NOT_APPLESOFT if self._known else "", _PROGRAM, (), self._scene,
            _cut(outcome, values, False),
        )  # fmt: skip
        yield Hypothesis(
            TRUNCATED, _NOT_APPLESOFT if self._known else "", _PROGRAM, (), self._scene,
            _cut(outcome, values, True),
        )  # fmt: skip

    def _as_typed(self) -> Iterator[dict[str, str]]:
        """The scene as another arithmetic would have been given it: the printed numbers."""
        texts = {name: text for name, text in self._printed.items() if name in INPUTS}
        texts.pop("MUP", None)
        scene = {**self._scene, **texts}
        yield scene
        if float(scene["MU"] or 0):
            yield {**scene, "MU": opposite(scene["MU"])}

    def _longer_energy(self, outcome: trial.Outcome) -> trial.Outcome:
        """Double precision prints KE to more digits than nine."""
        reading = self._shown.fields.get("KI")
        if reading is None or not reading.clean or "KI" not in outcome.fields:
            return outcome
        digits = sum(map(str.isdigit, reading.text))
        if digits > 9 and _is_rounding(reading.text, _energy(self._scene)):
            return trial.Outcome({**outcome.fields, "KI": reading.text}, outcome.ending)
        return outcome

    def _other_decimals(
        self, outcome: trial.Outcome, values: Mapping[str, float]
    ) -> trial.Outcome | None:
        """The exact values as they would be with as many decimals as each number has, where those
        are not the program's."""
        fields = dict(outcome.fields)
        more = 0
        exact = dict(values)
        for name in ("KI",):
            if name in fields:
                exact[name] = _energy(self._scene)
        for name, value in exact.items():
            reading = self._shown.fields.get(name)
            if reading is None or not reading.clean or name not in fields:
                continue
            printed = reading.text
            if _is_rounding(printed, value):
                places = FIELDS[name].places
                decimals = len(printed.partition(".")[2].partition("E")[0])
                more += places is not None and (decimals > places or "E" in printed)
                fields[name] = as_printed(printed) or printed
        for name in INPUTS:
            reading = self._shown.fields.get(name)
            if reading is not None and name in fields:
                fields[name] = reading.text
        return trial.Outcome(fields, outcome.ending) if more >= 2 else None


def _energy(scene: Mapping[str, str]) -> float:
    from .search import kinetic_energy

    return float(kinetic_energy({name: float(scene[name]) for name in scene}))  # type: ignore[misc]


def _is_rounding(printed: str, value: float) -> bool:
    """Whether a text is a value to its own last place, rounded or cut."""
    shown = value_of(printed)
    if shown is None or not math.isfinite(value):
        return False
    unit: Decimal = Decimal(1).scaleb(int(shown.as_tuple().exponent))
    return abs(Decimal(value) - shown) <= unit * Decimal("1.001") and unit < (abs(shown) or 1)


def _short(value: float) -> str:
    """A value as one would type it, nine digits at most."""
    text = f"{value:.9G}"
    return "0" if text == "-0" else text


def _cut(outcome: trial.Outcome, values: Mapping[str, float], truncated: bool) -> trial.Outcome:
    """The outcome with the floored fields rounded, or cut toward zero, to the same places."""
    way = truncated_text if truncated else rounded_text
    other = {name: way(value, FIELDS[name].places or 0) for name, value in values.items()}
    return trial.Outcome({**outcome.fields, **other}, outcome.ending)


def rounded_text(value: float, places: int) -> str:
    """A value rounded to so many decimals, halves upward, as a program rounds and writes it."""
    return _written(math.floor(value * 10**places + 0.5), places)


def truncated_text(value: float, places: int) -> str:
    """A value cut toward zero to so many decimals, as a program cuts and writes it."""
    return _written(math.trunc(value * 10**places), places)


def _written(units: int, places: int) -> str:
    text = f"{Decimal(units).scaleb(-places):f}"
    return as_printed(text) or text


__all__ = ["Hypothesis", "Tried", "hypotheses", "tried"]
